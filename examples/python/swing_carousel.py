# SPDX-License-Identifier: GPL-3.0-or-later
"""A swing carousel, two chairs below one another on an arm: how they fly out, and every other way they could whirl.

python swing_carousel.py [FOLDER]
"""

import numpy as np
from _picture import COLOURS, panels, save

import revchain as rc

ARM = 3.0  # m
chairs = rc.Rig(rc.Chain(weight=[900.0, 900.0], length=[2.0, 2.0]), support_radius=ARM)

figure, axes = panels(3, [4, 4, 3])

ax = axes[0]
for turns, colour in zip((4, 8, 10, 12, 16), COLOURS, strict=False):
    outwards = max(rc.steady_shapes(chairs, angular_speed=turns * 2 * np.pi / 60), key=lambda shape: shape.inclination[0])
    ax.plot(outwards.offset, outwards.height, "o-", color=colour, label=f"{turns} a minute")
    degrees = np.degrees(outwards.inclination)
    print(f"{turns:2} turns a minute: upper chair at {degrees[1]:4.1f} degrees, lower at {degrees[0]:4.1f}")
ax.set_title("flying out")

SPEED = 5.0  # rad/s
shapes = rc.steady_shapes(chairs, angular_speed=SPEED)
print(f"at {SPEED:g} rad/s: {shapes}, every inclination within {max(s.error_bound for s in shapes):.1e} rad")
ax = axes[1]
for shape in shapes:
    ax.plot(shape.offset, shape.height, "o-", color=COLOURS[(shape.half_waves - 1) % len(COLOURS)])
ax.set_title(f"all {len(shapes)} shapes at {SPEED:g} rad/s")

for ax in axes[:2]:
    ax.axvline(0.0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
    ax.plot([0.0, ARM], [0.0, 0.0], color="0.3", linewidth=2, zorder=0)
    ax.set(xlabel="from the axis, m", aspect="equal", xlim=(-2.5, 7.5), ylim=(-4.3, 0.6))
axes[0].set_ylabel("above the arm, m")
axes[0].legend(loc="upper left", frameon=False, fontsize=8)

ax = axes[2]
for speed in np.linspace(0.05, 6.0, 240):
    found = rc.steady_shapes(chairs, angular_speed=speed)
    lowest = np.degrees([shape.inclination[0] for shape in found])
    waves = [COLOURS[(shape.half_waves - 1) % len(COLOURS)] for shape in found]
    ax.scatter(np.full(len(found), speed), lowest, s=3, c=waves, linewidth=0)
ax.axvline(SPEED, color="0.6", linewidth=0.8, linestyle=":")
ax.set(xlabel="speed, rad/s", ylabel="inclination of the lower chair, degrees", ylim=(-90, 90), yticks=range(-90, 91, 30))
ax.set_title("all shapes")
save(figure)
