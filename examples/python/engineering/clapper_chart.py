# SPDX-License-Identifier: GPL-3.0-or-later
"""Church bell rung full circle: when the clapper strikes
======================================================

A design chart: at which angle of a bell that falls from its balance does the clapper strike, and on which side?
"""

import functools

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

CLEARANCE = "27 deg"
CLAPPER = 0.6  # pendulum length, m: angles do not depend on it


def first_blow(joint, bell):
    """The first blow, for a joint and a bell's pendulum length over the pendulum length of the clapper."""
    half = bell * CLAPPER / 2  # centroid and radius of gyration alike make the pendulum length twice that
    links = {"mass": [1.0, 1e6], "length": [CLAPPER, joint * CLAPPER], "centroid": [CLAPPER, half]}
    return rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.0, half])).first_strike(CLEARANCE)


@functools.cache
def angle(joint, bell):
    """Angle of the bell in degrees at the first blow. If that is on the trailing side, 360 less the angle."""
    blow = first_blow(joint, bell)
    return np.degrees(blow.bell_angle if blow.side == "leading" else 2 * np.pi - blow.bell_angle)


def jump(joint):
    """Two ratios of the bell, close together, between which the angle jumps."""
    bells = np.linspace(1.75, 2.4, 14)
    while bells[-1] - bells[0] > 2e-3:
        steps = np.abs(np.diff([angle(joint, bell) for bell in bells]))
        bells = np.linspace(bells[steps.argmax()], bells[steps.argmax() + 1], 3)
    return bells[0], bells[-1]


joints = np.linspace(0.02, 0.6, 18)
late, early = np.array([jump(joint) for joint in joints]).T
steep, least, most = (np.full(joints.size, bell) for bell in (1.79, 0.8, 2.4))  # above 1.79 the angle changes fast
parts = (
    (steep, least, [100, 120, 140], [(0.08, 1.2), (0.2, 1.3), (0.45, 1.2)]),
    (steep, late, [160, 200], [(0.35, 1.88), (0.5, 2.1)]),
    (early, most, [30, 60, 90], [(0.25, 2.25), (0.22, 2.02), (0.12, 1.86)]),
)
figure, axes = plt.subplots(figsize=(6, 4.6), layout="constrained")
axes.set_facecolor("#cfe4f4")
axes.fill_between(joints, early, most, color="#fbf3d0")
for start, end, levels, places in parts:
    bells = start + (end - start) * np.linspace(0, 1, 16)[:, np.newaxis] ** 2  # rows, closest at the start
    angles = [[angle(joint, bell) for joint, bell in zip(joints, row)] for row in bells]
    chart = np.broadcast_to(joints, bells.shape), bells, angles
    axes.contourf(*chart, levels=[180, 360], colors="#f7c59a")
    lines = axes.contour(*chart, levels=levels, colors="0.4", linewidths=0.7)
    axes.clabel(lines, fmt=lambda a: f"{min(a, 360 - a):.0f}°", manual=places)
axes.plot(joints, early, color="black", linewidth=2)
axes.plot(joints, 1 + joints, color="0.2", linestyle="--", linewidth=1)
axes.text(0.24, 1.12, "swing as one piece", rotation=15)
axes.text(0.165, 1.7, "thick line: it just misses")
for words, *at in (("leading side,\nearly", 0.04, 2.25), ("leading side, late", 0.2, 1.55), ("trailing side", 0.42, 1.98)):
    axes.text(*at, words, size="large", weight="bold")
axes.set_title("First blow of the clapper: side, and angle of the bell past its lowest position")
axes.set(xlabel="axle to clapper pin / clapper pendulum length", xlim=(0.02, 0.6))
axes.set(ylabel="bell pendulum length / clapper pendulum length", ylim=(0.8, 2.4))
plt.show()

# %%
# If the bell is much heavier than its clapper, only two ratios matter (Woodhouse et al. 2012,
# doi:10.1155/2012/681787): the distance from the axle to the clapper's pin, and the pendulum length
# of the bell, both divided by the pendulum length of the clapper. Each point of the chart is one
# motion of bell and clapper, from the balance, mouth up, to the first blow.
#
# The lines have the angle of the bell at that blow, in degrees beyond its lowest position. At the
# thick line the angle jumps: below it the clapper comes close to the leading side, misses it, and
# strikes later. On the dashed line bell and clapper swing as one piece while the clapper is in the
# middle of the bell (Greenhill 1908, section 8 (16)).

print("axle to pin  bell  side      bell (deg)   (pendulum length of the clapper = 1)")
for joint, bell in ((0.1, 1.2), (0.1, 2.2), (0.5, 1.2), (0.5, 2.1)):
    blow = first_blow(joint, bell)
    print(f"{joint:11.1f}  {bell:4.1f}  {blow.side:8}  {np.degrees(blow.bell_angle):10.1f}")

# %%
# To try next: ``first_blow`` with the ratios of a bell of your own. The limits and labels of the
# chart are for this clearance.
#
# Checked: ``tests/python/test_bell.py`` integrates the same motion in other coordinates, with a
# side of the bell like a stiff spring, and ``tests/cpp/bell.cpp`` Hamilton's equations of 10,000 bells.
