# SPDX-License-Identifier: GPL-3.0-or-later
"""Church bell rung full circle: when the clapper strikes
======================================================

A design chart: at which angle of a bell that falls from its balance does the clapper strike, and on which side?
"""

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


joints, bells = np.linspace(0.02, 0.6, 21), np.linspace(0.8, 2.4, 27)
blows = [[first_blow(joint, bell) for joint in joints] for bell in bells]
angle = np.degrees([[blow.bell_angle if blow.strikes else np.nan for blow in row] for row in blows])
trailing = [[blow.strikes and blow.side == "trailing" for blow in row] for row in blows]

figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
drawn = axes.pcolormesh(joints, bells, angle, shading="nearest", rasterized=True)
figure.colorbar(drawn, label="bell beyond its lowest position (°)")
axes.contour(joints, bells, trailing, levels=[0.5], colors="white", linewidths=2)
axes.plot(joints, 1 + joints, color="white", linestyle="--")
axes.set(xlabel="axle to pin / clapper", ylabel="bell / clapper", ylim=(0.8, 2.4))
plt.show()

# %%
# If the bell is much heavier than its clapper, only two ratios matter (Woodhouse et al. 2012,
# doi:10.1155/2012/681787): the distance from the axle to the clapper's pin, and the pendulum length
# of the bell, both divided by the pendulum length of the clapper. Each point of the chart is one
# motion of bell and clapper, from the balance, mouth up, to the first blow.
#
# The colour is the angle of the bell at that blow. Inside the white line the clapper strikes the
# trailing side of the bell, elsewhere the leading side. On the dashed line bell and clapper swing
# as one piece while the clapper is in the middle of the bell (Greenhill 1908, section 8 (16)).

print("axle to pin  bell  side      bell (deg)   (pendulum length of the clapper = 1)")
for joint, bell in ((0.1, 1.2), (0.1, 2.2), (0.5, 1.2), (0.5, 2.1)):
    blow = first_blow(joint, bell)
    print(f"{joint:11.1f}  {bell:4.1f}  {blow.side:8}  {np.degrees(blow.bell_angle):10.1f}")

# %%
# To try next: a wider bell, ``CLEARANCE = "35 deg"``. Needs SciPy.
#
# Checked: ``tests/python/test_bell.py`` integrates the same motion in other coordinates, with a
# side of the bell like a stiff spring.
