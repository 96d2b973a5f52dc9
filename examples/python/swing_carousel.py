# SPDX-License-Identifier: GPL-3.0-or-later
"""Swing carousel with two chairs on each arm
==========================================

A swing carousel with two chairs, one below the other, on an arm: how they fly out, and all other steady shapes.

Checked: ``tests/python/test_rig_shapes.py``, every shape by brute force and by the balance of moments in 50 digits.
"""

import numpy as np
from matplotlib import colormaps
from matplotlib.figure import Figure

import revchain as rc
from revchain.plots.programs import COLOURS, branch_of, save
from revchain.plots.style import legend_outside

ARM = 0.5  # m
SPEED = 6.0  # rad/s, for the picture of all shapes
FASTEST = 12.0  # rad/s, of the branches
chairs = rc.Rig(rc.Chain(mass=90.0, length=[2.0, 2.0]), support=rc.Support(radius=ARM))


branches = rc.branches(chairs, max_angular_speed=FASTEST)


figure = Figure(figsize=(8, 6), layout="constrained")
axes = figure.subplot_mosaic([["out", "all"], ["speeds", "speeds"]], width_ratios=[6, 9], height_ratios=[1, 1.2])

for number, turns in enumerate((4, 8, 12, 16, 30)):
    shapes = rc.steady_shapes(chairs, angular_speed=turns * 2 * np.pi / 60)
    outwards = max(shapes, key=lambda shape: shape.inclination[0])
    shade = colormaps["viridis"](number / 5)
    axes["out"].plot(outwards.offset, outwards.height, "o-", markersize=4, color=shade, label=f"{turns} rpm")
    lower, upper = np.degrees(outwards.inclination)
    print(f"{turns:2} rpm: upper chair at {upper:4.1f} degrees, lower at {lower:4.1f}")
axes["out"].set_title("flying out")
legend_outside(axes["out"])

shapes = rc.steady_shapes(chairs, angular_speed=SPEED)
print(f"at {SPEED:g} rad/s: {len(shapes)} shapes, proved complete: {shapes.complete}; every inclination within {max(s.error_bound for s in shapes):.1e} rad")
for shape in shapes:
    axes["all"].plot(shape.offset, shape.height, "o-", markersize=4, color=COLOURS[branch_of(shape, branches)])
    print(f"  {shape.half_waves} half waves, chairs at {np.degrees(shape.inclination).round(1)} degrees, lowest first")
axes["all"].set(title=f"all {len(shapes)} shapes at {SPEED:g} rad/s")
for name in ("out", "all"):
    axes[name].axvline(0.0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
    axes[name].plot([0.0, ARM], [0.0, 0.0], color="0.3", linewidth=2, zorder=0)
    axes[name].set(xlabel="distance from axis (m)", ylabel="height (m)")
    axes[name].set(aspect="equal", xlim=(-4 if name == "all" else -1, 5), ylim=(-4.3, 0.6))

for k, line in enumerate(branches):
    label = "branch from rest" if line.birth == "rest" else f"isolated branch {k}"
    axes["speeds"].plot(line.angular_speed, np.degrees(line.tip_inclination), color=COLOURS[k], label=label)
axes["speeds"].axvline(SPEED, color="0.6", linewidth=0.8, linestyle=":", label=f"{SPEED:g} rad/s")
legend_outside(axes["speeds"])
axes["speeds"].set(
    xlabel="speed (rad/s)",
    ylabel="inclination of the lower chair (°)",
    title="all branches",
    xlim=(0, FASTEST),
    ylim=(-92, 92),
    yticks=range(-90, 91, 30),
)
save(figure, "swing_carousel")

# %%
# The shapes turning. Drag the picture to turn the view.

shapes.show(height=420)
