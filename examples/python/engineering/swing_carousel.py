# SPDX-License-Identifier: GPL-3.0-or-later
"""Swing carousel: how far the chairs fly out
==========================================

Two chairs, one below the other, hang from the arm of a swing carousel: how far out do they fly at each speed?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

ARM = 0.5  # m
chairs = rc.Rig(rc.Chain(mass=90.0, length=[2.0, 2.0]), support=rc.Support(radius=ARM))

figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
(shape,) = rc.steady_shapes(chairs, angular_speed="16 rpm")
for side in (-1, 1):
    axes.plot(side * shape.offset, shape.height, color="C0", linewidth=2)
    axes.plot(side * shape.offset[:2], shape.height[:2], "o", color="C0", markersize=12)
axes.plot([-ARM, ARM], [0, 0], color="0.3", linewidth=5)
axes.plot([0, 0], [-4, 0.4], color="0.3", linewidth=5)
axes.set(xlabel="distance from axis (m)", ylabel="height (m)", aspect="equal")
plt.show()

# %%
# The picture shows the chairs at 16 rpm. The lower chair hangs at a larger angle than the upper
# one. Below about 12 rpm the chairs hardly leave the vertical; then they fly out quickly.

for turns in (4, 8, 12, 16, 30):
    shapes = rc.steady_shapes(chairs, angular_speed=f"{turns} rpm")
    outwards = max(shapes, key=lambda shape: shape.inclination[0])
    lower, upper = np.degrees(outwards.inclination)
    print(f"{turns:2} rpm: upper chair at {upper:4.1f} degrees, lower at {lower:4.1f}")

# %%
# Fast enough, the chairs have other steady shapes too: one chair on the far side of the axis, or
# both. At 6 rad/s there are five shapes, and the list is proved complete.

SPEED = 6.0  # rad/s
shapes = rc.steady_shapes(chairs, angular_speed=SPEED)
worst = max(shape.error_bound for shape in shapes)
print(f"at {SPEED:g} rad/s: {len(shapes)} shapes, proved complete: {shapes.complete}; ", end="")
print(f"every inclination within {worst:.1e} rad")
for shape in shapes:
    print(f"  {shape.half_waves} half waves, chairs at {np.degrees(shape.inclination).round(1)} degrees, lowest first")

# %%
# The shapes turning, as solids. Drag the picture to turn the view.

shapes.show(height=520)

# %%
# Every shape belongs to a branch: the shape as a function of the speed. One branch starts at rest.
# The others are isolated: they appear in pairs at a least speed, a fold, and the carousel does not
# reach them from rest. Lines are solid where the shape is a minimum of the energy, dash-dotted where
# only gyroscopic forces keep it, dashed where it is unstable.

branches = rc.branches(chairs, max_angular_speed=12.0)
figure = plt.figure(figsize=(8, 6.4), layout="constrained")
axes = figure.subplot_mosaic([["out", "all"], ["speeds", "speeds"]], height_ratios=[1, 1.2])
for turns in (4, 8, 12, 16, 30):
    outwards = max(rc.steady_shapes(chairs, angular_speed=f"{turns} rpm"), key=lambda shape: shape.inclination[0])
    axes["out"].plot(outwards.offset, outwards.height, "o-", markersize=4, label=f"{turns} rpm")
axes["out"].set(title="flying out", xlabel="distance from axis (m)", ylabel="height (m)", aspect="equal")
axes["out"].legend(loc="upper left", bbox_to_anchor=(1, 1))
shapes.plot(axes["all"])
axes["all"].set_title(f"all {len(shapes)} shapes at {SPEED:g} rad/s")
branches.plot(axes["speeds"])
plt.show()

# %%
# To try next: ``shape.stability()`` says which of these shapes a carousel can keep.
#
# Checked: ``tests/python/test_rig_shapes.py``, every shape by brute force and by the balance of
# moments in 50 digits.
