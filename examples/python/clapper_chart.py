# SPDX-License-Identifier: GPL-3.0-or-later
"""When the clapper strikes: a design chart
========================================

A design chart for church bells rung full circle: when does the clapper strike?

If the bell is much heavier than its clapper, only two ratios matter (Woodhouse et al. 2012, doi:10.1155/2012/681787): the
distance from the axle to the clapper's pin, and the pendulum length of the bell, both divided by the pendulum length of the
clapper. Each point of the chart is one motion of bell and clapper, from the balance to the first blow. On the dashed line
bell and clapper swing as one piece while the clapper is in the middle of the bell (Greenhill 1908, section 8 (16)). Needs
SciPy.

Checked: ``tests/python/test_bell.py`` integrates the same motion in other coordinates, with a side of the bell like a stiff
spring.
"""

import matplotlib
import numpy as np

import revchain as rc
from revchain.plots.programs import legend_below, panels, save

CLEARANCE = "27 deg"
CLAPPER = 0.6  # pendulum length, m: angles do not depend on it


def first_blow(joint, bell):
    """The first blow, for a joint and a bell's pendulum length over the pendulum length of the clapper."""
    half = bell * CLAPPER / 2  # centroid and radius of gyration alike make the pendulum length twice that
    links = {"mass": [1.0, 1e6], "length": [CLAPPER, joint * CLAPPER], "centroid": [CLAPPER, half]}
    return rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.0, half])).first_strike(CLEARANCE)


joints, bells = np.linspace(0.02, 0.6, 30), np.linspace(0.8, 2.4, 41)
angle = np.full((bells.size, joints.size), np.nan)  # of the bell beyond its lowest place
leading = np.zeros(angle.shape)
for i, bell in enumerate(bells):
    for j, joint in enumerate(joints):
        blow = first_blow(joint, bell)
        if blow.strikes:
            angle[i, j], leading[i, j] = np.degrees(blow.bell_angle), 1.0 if blow.side == "leading" else -1.0

figure, (axes,) = panels(1, height=5.0)
drawn = axes.pcolormesh(joints, bells, angle, cmap=matplotlib.colormaps["viridis"], shading="nearest", rasterized=True)
figure.colorbar(drawn, ax=axes, label="bell beyond its lowest place at the first blow (°)")
axes.contour(joints, bells, leading, levels=[0.0], colors="white", linewidths=1.5)
axes.plot([], [], color="white", linewidth=1.5, label="inside: strikes the trailing side")
axes.plot(joints, 1 + joints, color="white", linestyle="--", label="one piece when in the middle")
axes.set(
    title=f"First blow of a bell falling from the balance, clearance {CLEARANCE}",
    xlabel="axle to the clapper's pin / pendulum length of the clapper",
    ylabel="pendulum length: bell / clapper",
    ylim=(bells[0], bells[-1]),
)
legend_below(axes, frameon=True, facecolor="0.3", labelcolor="white")
print("axle to pin  bell  side      bell (deg)   (pendulum length of the clapper = 1)")
for joint, bell in ((0.1, 1.2), (0.1, 2.2), (0.5, 1.2), (0.5, 2.1)):
    blow = first_blow(joint, bell)
    print(f"{joint:11.1f}  {bell:4.1f}  {blow.side:8}  {np.degrees(blow.bell_angle):10.1f}")
save(figure, "clapper_chart")
