# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment VI: a balanced cue
=============================

Sticks balanced on a hand that moves in a circle lean inwards, and an inverted pendulum stands on a swinging one.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, panels, picture, side_view, whirling

HAND = 0.05  # m, radius of its circle
TURNS = 1.0  # a second
SPEED = 2 * np.pi * TURNS


def on_the_hand(length, sticks=1):
    """Equal sticks hinged end to end, upright."""
    return rc.Rig(rc.Chain.uniform_rods(sticks, length=length), inverted=True, support=rc.Support(radius=HAND))


def leaning(rig):
    """The one way in which they go round with the hand, and how far each leans inwards, degrees, the topmost first."""
    (shape,) = rc.steady_shapes(rig, angular_speed=SPEED)
    return shape, 180 + np.degrees(shape.inclination)


shape, _ = leaning(on_the_hand(1.2))
figure, axes = picture()
whirling(axes, shape.offset, shape.height, linewidth=5)
axes.plot([-HAND, HAND], [0, 0], color="black", linewidth=8)
axes.set(xlabel="distance from axis (m)", ylabel="height above the hand (m)", xlim=(-0.15, 0.15))
plt.show()

# %%
# A broomstick of 1.2 m goes round with the hand, whose circle has a radius of 5 cm. It leans
# inwards. Seen from the side at seven moments of half a turn, its lines cross at one point above
# the hand. The horizontal scale is larger than the vertical one.
#
# The motion is steady and unstable: the table says how fast each stick falls, in how many seconds
# its lean grows by the factor e. Longer sticks fall more slowly.

print(f"sticks on a hand that goes round a circle of radius {100 * HAND:.0f} cm, {TURNS:.0f} turn a second:")
print("stick       length, m  pendulum length, m  e-folding time of a fall, s  leans inwards, degrees")
sticks = {"pencil": 0.18, "ruler": 0.5, "broomstick": 1.2, "cue": 1.45}
for name, length in sticks.items():
    rig = on_the_hand(length)
    fall = rc.modes(rig).other  # no whirl speed, but a conical height below 0
    like, grows, (lean,) = -fall.conical_height[0].real, 1 / fall.growth_rate[0], leaning(rig)[1]
    print(f"{name:10}  {length:9.2f}  {like:18.3f}  {grows:27.3f}  {lean:22.2f}")

# %%
# The same length hinged in one or two places falls faster.

print("0.9 m of sticks hinged end to end, on the same hand:")
print("sticks  top over hand  e-folding times, s       each leans inwards, degrees, topmost first")
columns = [on_the_hand(0.9, count) for count in (1, 2, 3)]
for rig in columns:
    top = rc.response(rig, angular_speed=SPEED, pins=0).amplification
    grows = " ".join(f"{x:.3f}" for x in 1 / rc.modes(rig).other.growth_rate)
    print(f"{rig.size:6}  {top:+13.3f}  {grows:23} ", *(f"{x:.2f}" for x in leaning(rig)[1]))

# %%
# Two bodies, of which each can hang or stand.

pair = rc.Chain(mass=[0.05, 0.5], length=[0.3, 1.0])
print("50 g on 0.3 m of wire, on a rod of 1 m with 500 g at its end, near the vertical:")
print("wire    rod     turns a second  e-folding times of a fall, s")
for inverted in ([False, False], [True, False], [False, True], [True, True]):
    found = rc.modes(rc.Rig(pair, inverted=inverted))
    turns = " ".join(f"{turns:.4f}" for turns in found.frequency)
    grows = " ".join(f"{x:.3f}" for x in 1 / found.other.growth_rate)
    wire, rod = ("stands" if stands else "hangs" for stands in inverted)
    print(f"{wire:6}  {rod:6}  {turns or 'none':14}  {grows or 'none'}")
faster = 0.55
(upright,) = rc.steady_shapes(rc.Rig(pair, inverted=[True, False]), angular_speed=2 * np.pi * faster)
wire, rod = np.degrees(np.abs(upright.inclination))
print(f"wire standing, at {faster} turns a second: the wire leans by {180 - wire:.2f} degrees, the rod by {rod:.2f}")

# %%
# On the left, the sticks as they lean. On the right, a wire that stands on the end of a swinging
# rod.

figure, (stand, hung) = panels(2, [1.7, 1])
shown = {**{name: on_the_hand(length) for name, length in sticks.items()}, "3 sticks": columns[2]}
APART = 0.42  # m, between the axes of neighbouring sticks
places = APART * np.arange(len(shown))
for at, rig in zip(places, shown.values(), strict=True):
    shape, _ = leaning(rig)
    dots = "." if rig.size > 1 else ""
    hang(stand, at + shape.offset, -shape.height, color=COLOURS[0], linewidth=2, marker=dots, clip_on=False)
    stand.plot([at - HAND, at + HAND], [0, 0], "|-", color="black", markersize=8, clip_on=False)
    stand.plot([at, at], [0, -1.5], color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
side_view(stand, "sticks on a hand on a circle of radius 0.05 m, 1 turn/s", bottom=0.04, top=1.5, half_width=1)
stand.lines[-1].remove()  # there are five axes
names = [f"{name}\n{leaning(rig)[1][0]:.1f}°" for name, rig in shown.items()]
stand.set_xticks(places, names)
stand.set(xlim=(places[0] - 0.2, places[-1] + 0.2), xlabel="inclination of the topmost stick below its name")
stand.set_yticks([0, -0.5, -1, -1.5], ["0.0", "0.5", "1.0", "1.5"])
stand.set_ylabel("height above the hand (m)")
hang(hung, upright.offset, -upright.height, weights=[20, 90], color=COLOURS[1])
hung.annotate("50 g", (upright.offset[0], -upright.height[0]), xytext=(7, 2), textcoords="offset points")
rod_end = (upright.offset[1], -upright.height[1])
hung.annotate("500 g", rod_end, xytext=(-8, -12), textcoords="offset points", ha="right")
side_view(hung, f"50 g standing on 500 g,\n{faster} turns/s", bottom=1.05, half_width=0.5)
hung.set(ylabel="depth below the support (m)", xlim=(-0.15, 0.75))
plt.show()

# %%
# To try next: a circle of 10 cm, ``HAND = 0.1``.
#
# Checked: ``tests/python/test_rig_shapes.py``, inclinations and motions of broomsticks and columns.
