# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment VII: the revolving chain at any inclination
======================================================

A chain of 1 m whirled by the hand at any inclination, and two weights in its place.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, panels, picture, side_view, whirling

LENGTH = 1.0  # m
PAIR = dict(lower_weight=1, lower_thread=0.5, upper_weight=1, upper_thread=0.25)  # each in the middle of half a chain

chain, cord = rc.Chain.uniform_rods(200, length=LENGTH), rc.Cord(LENGTH)
shape = rc.steady_shapes(cord, angular_speed=2 * np.pi * 3.0)[1]
figure, axes = picture()
whirling(axes, shape.offset, -shape.height, color=COLOURS[1])
axes.set(xlabel="distance from axis (m)", ylabel="depth (m)", ylim=(0.45, -0.03), aspect="equal")
plt.show()

# %%
# The chain at 3 turns a second in two half waves, seen from the side at seven moments of half a
# turn. Nothing is exaggerated.
#
# A shape with one more half wave leaves the vertical at each of these speeds.

result, continuous = rc.modes(chain, count=3), rc.modes(cord, count=3)
pair_speeds = rc.conical_pendulum.revolutions_per_second(rc.two_links.two_plummets(**PAIR))
print("turns a second at which another figure leaves the vertical:")
print("  chain of 200 links ", *result.frequency.round(4))
print("  continuous chain   ", *continuous.frequency.round(4))
print("  two weights instead", *pair_speeds.round(4))
for turns in (0.5, 1, 2, 3):
    below = rc.count_modes(chain, angular_speed=2 * np.pi * turns)
    print(f"speeds of the chain below {turns} turns a second: {below}")

# %%
# How far out is the free end in each shape? The number of half waves names the shape (the column
# ``figure``).

print("every figure of the chain: distance of its free end from the axis, m:")
print("turns a second  figure  continuous  200 links")
for turns in (0.7, 1.0, 2.0, 3.0):
    links = rc.steady_shapes(chain, angular_speed=2 * np.pi * turns)
    assert links.complete
    for shape, linked in zip(rc.steady_shapes(cord, angular_speed=2 * np.pi * turns), links, strict=True):
        print(f"{turns:14.1f}  {shape.half_waves:6}  {shape.offset[0]:10.5f}  {linked.offset[0]:9.5f}")

# %%
# Two weights in the place of the two halves of the chain behave alike, up to their two shapes. The
# picture has them at 2 turns a second, with the chain as a broad line.


def figures(turns):
    return rc.two_links.two_plummets_shapes(**PAIR, height=rc.conical_pendulum.height(2 * np.pi * turns))


print("two weights instead, inclinations in degrees:")
print("turns a second  figure  lower thread  upper")
for turns in (0.7, 1.0, 2.0, 3.0):
    for shape in figures(turns):
        lower, upper = np.degrees(shape.inclination)
        print(f"{turns:14.1f}  {shape.half_waves:6}  {lower:12.2f}  {upper:5.2f}")

figure, (side,) = panels(1)
for shape in rc.steady_shapes(cord, angular_speed=2 * np.pi * 2.0):
    hang(side, shape.offset, -shape.height, color=COLOURS[shape.half_waves - 1], linewidth=8, alpha=0.25)
for shape in figures(2.0):
    depth = np.cumsum(np.cos(shape.inclination[::-1]) * [PAIR["upper_thread"], PAIR["lower_thread"]])
    colour = COLOURS[shape.half_waves - 1]
    hang(side, [*shape.offset, 0], [*depth[::-1], 0], weights=[150, 150], color=colour, linewidth=2)
side.text(0.5, 0.14, "1 half wave", color=COLOURS[0])
side.text(0.06, 0.56, "two weights", color=COLOURS[1])
side.text(0.3, 0.67, "chain: 2 half waves", color=COLOURS[1])
side_view(side, "two weights instead of the chain, at 2 turns/s", bottom=0.7, half_width=1)
side.set(xlim=(-0.35, 1.05), ylabel="depth below the support (m)")
plt.show()

# %%
# On the left, the shapes of the chain at 3 turns a second. On the right, how far out its free end
# is: a curve begins at each whirl speed. Dots are the shapes on the left.

figure, (side, curve) = panels(2, [1.6, 1])
for k, line in enumerate(rc.branches(cord, max_angular_speed=2 * np.pi * 3.5)):
    curve.plot(line.angular_speed / (2 * np.pi), np.abs(line.tip_radius), color=COLOURS[k], linewidth=2.5)
places = [(0.55, -0.01), (0.34, 0.4), (0.17, 0.76), (0.05, 1.0)]
for shape, place in zip(rc.steady_shapes(cord, angular_speed=2 * np.pi * 3.0), places, strict=True):
    waves, colour = shape.half_waves, COLOURS[shape.half_waves - 1]
    hang(side, shape.offset, -shape.height, color=colour, linewidth=2.5)
    side.text(*place, f"{waves} half wave{'s' * (waves > 1)}", color=colour)
    curve.plot(3.0, shape.offset[0], "o", color=colour, markersize=8)
    curve.text(3.0, shape.offset[0] + 0.03, waves, color=colour, ha="center")
side_view(side, "the chain at 3 turns/s", bottom=1.03, half_width=1)
side.set(xlim=(-0.35, 1.05), ylabel="depth below the support (m)")
curve.set(xlabel="speed (turns/s)", ylabel="distance of the free end from axis (m)")
curve.set(xlim=(0, 3.6), ylim=(-0.02, 1.08), title="one more shape at each whirl speed")
plt.show()

# %%
# To try next: ``rc.steady_shapes(cord, angular_speed=60.0)``, with a dozen half waves.
#
# Checked: ``tests/cpp/finite/cord/continuous_chain.cpp`` (cord),
# ``tests/python/test_steady_shapes.py`` (links) and ``tests/python/test_closed_forms.py`` (two
# weights).
