# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment IV: a chain twirled by the hand
==========================================

The hand moves the upper end round a small circle: at higher speeds the tip changes to the other side of the axis.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, branch_of, hang, panels, picture, side_view, whirling

LENGTH = 0.36  # m, of the chain, and of the thread of a plummet
HAND = 0.005  # m, radius of the circle
LINKS = 100

chain = rc.Chain.uniform_rods(LINKS, length=LENGTH)
carried = rc.Rig(chain, support=rc.Support(radius=HAND))

_, shape, *_ = sorted(rc.steady_shapes(carried, angular_speed=2 * np.pi * 3.0), key=lambda shape: shape.height[0])
figure, axes = picture()
whirling(axes, shape.offset, -shape.height)
axes.plot([-HAND, HAND], [0, 0], color="black", linewidth=4)
axes.set(xlabel="distance from axis (m)", ylabel="depth below the hand (m)", ylim=(0.3, -0.02), aspect="equal")
plt.show()

# %%
# A chain of 0.36 m, twirled on a circle of 5 mm at 3 turns a second, seen from the side at seven
# moments of half a turn. It crosses the axis once. Nothing is exaggerated.
#
# First, the chain near the vertical, beside a plummet on a thread of the same length and a
# continuous chain. Where the sign of the response changes, the tip goes to the other side.

eighth = rc.modes(rc.Cord(1.0), 1, first=8)


def near_the_vertical(turns):
    """Offset of the tip over that of the hand."""
    return rc.response(chain, angular_speed=2 * np.pi * turns, pins=0).offset


def continuous(turns):
    """The same without links: the lowest part of a longer chain that whirls freely."""
    longer = rc.conical_pendulum.height(2 * np.pi * turns) / eighth.conical_height[0]
    return 1 / eighth.along(LENGTH / longer)[0]


def at_any_inclination(turns):
    shapes = rc.steady_shapes(carried, angular_speed=2 * np.pi * turns)
    assert shapes.complete
    return shapes


def more_from(low, high):
    """The speed at which shapes are added, between two: turns a second."""
    before = len(at_any_inclination(low))
    while high - low > 1e-5:
        middle = (low + high) / 2
        low, high = (middle, high) if len(at_any_inclination(middle)) == before else (low, middle)
    return high


reversals = rc.modes(chain, count=3).frequency
alone = rc.conical_pendulum.revolutions_per_second(LENGTH)
print(f"the tip changes sides: plummet at {alone:.4f} turns a second,", end=" ")
print("chain at", *reversals.round(4))
print(f"tip over hand, small amplitude, chain of {LINKS} links and continuous chain:")
print("turns a second  plummet    chain  continuous")
for turns in (0.4, 0.7, 0.9, 1.1, 1.5, 2.0, 2.5):
    plummet = rc.plummet.carried_response(LENGTH, rc.conical_pendulum.height(2 * np.pi * turns))
    print(f"{turns:14.2f}  {plummet:+7.3f}  {near_the_vertical(turns):+7.3f}  {continuous(turns):+10.3f}")

# %%
# At any inclination there are several steady shapes at one speed. Two more appear above each of
# the first three speeds at which the tip changes sides.

print("plummet on 0.36 m, hand on a circle of radius 5 mm, all steady inclinations, degrees:")
for turns in (0.7, 0.83, 0.9, 1.0):
    found = rc.plummet.carried_inclinations(LENGTH, rc.conical_pendulum.height(2 * np.pi * turns), HAND)
    print(f"{turns:14.2f}  ", *(f"{x:8.2f}" for x in np.degrees(found)))
print(f"chain of {LINKS} links on the same circle, tip from the axis in every steady shape, mm:")
for turns in (0.7, 0.9, 1.0, 1.1, 1.5, 2.0, 2.5, 3.0):
    print(f"{turns:14.2f}  ", *(f"{1000 * x:8.2f}" for x in sorted(s.offset[0] for s in at_any_inclination(turns))))
born = [more_from(low, high) for low, high in zip(reversals, [*reversals[1:], 5.0], strict=True)]
print("two more shapes appear at", *np.round(born, 4), "turns a second")

# %%
# Each colour is a branch, whose shapes change continuously with the speed. Its label gives the
# speed at which it starts. On the left, the tip against the speed. On the right, the five shapes at
# 3 turns a second, numbered like the dots.

branches = rc.branches(carried, max_angular_speed=2 * np.pi * 3.2)
figure, (curve, side) = panels(2, [1, 1.8], height=4)
for k, (line, place) in enumerate(zip(branches, [(1.3, 0.25), (1.3, -0.2), (1.35, 0.08)], strict=True)):
    curve.plot(line.angular_speed / (2 * np.pi), line.tip_radius, color=COLOURS[k], linewidth=2.5)
    curve.text(*place, f"from {born[k - 1]:.2f}\nturns/s" if k else "from rest", color=COLOURS[k])
for number, shape in enumerate(sorted(at_any_inclination(3.0), key=lambda shape: shape.offset[0]), 1):
    colour = COLOURS[branch_of(shape, branches)]
    curve.plot(3.0, shape.offset[0], "o", color=colour)
    curve.text(3.0, shape.offset[0] + 0.015, number, color=colour, ha="center")
    hang(side, shape.offset, -shape.height, color=colour, linewidth=2.5)
    side.text(shape.offset[0], 0.01 - shape.height[0], number, color=colour, ha="center", va="top")
curve.axhline(0, color="black", linewidth=0.6)
curve.set(xlabel="speed (turns/s)", ylabel="offset of the tip (m)", title="every steady shape")
side_view(side, "the five shapes at 3 turns/s", bottom=0.4, top=0.02, half_width=0.4)
side.set_ylabel("depth below the hand (m)")
plt.show()

# %%
# Near the vertical again. On the left, the chain at three speeds, with distances from the axis
# enlarged. On the right, its tip against the speed, with dots at the same speeds. At each whirl
# speed the tip changes to the other side of the axis. The plummet (grey) changes sides once.

figure, (side, curve) = panels(2, [1, 1.4])
edges = [0.2, *reversals]
for k, speed in enumerate((0.7, 1.5, 2.6)):
    one = rc.response(carried, angular_speed=2 * np.pi * speed)
    hang(side, 1000 * one.offset, np.linspace(LENGTH, 0, LINKS + 1), color=COLOURS[k], linewidth=2.5)
    side.text(1000 * one.offset[0], LENGTH + 0.005, speed, color=COLOURS[k], ha="center", va="top")
    turns = np.linspace(edges[k], edges[k + 1], 400)[1:-1]
    curve.plot(turns, near_the_vertical(turns), color=COLOURS[k], linewidth=2.5)
    curve.plot(speed, one.offset[0] / HAND, "o", color=COLOURS[k], markersize=8)
    curve.text(speed, one.offset[0] / HAND - 1, speed, color=COLOURS[k], ha="center", va="top")
for turns in (np.linspace(0.2, alone, 200)[:-1], np.linspace(alone, 2.8, 400)[1:]):
    plummet = rc.plummet.carried_response(LENGTH, rc.conical_pendulum.height(2 * np.pi * turns))
    curve.plot(turns, plummet, color="0.6")
curve.text(2.8, -0.5, "plummet", color="0.45", ha="right", va="top")
curve.text(1.65, 9, "tip on the side\nof the hand", ha="center")
curve.text(1.62, -10, "tip on the\nother side", ha="center")
curve.axhline(0, color="black", linewidth=0.6)
curve.set(xlabel="speed (turns/s)", ylabel="offset of the tip / of the hand", xlim=(0.2, 2.8), ylim=(-12, 12))
curve.set_title("the tip, near the vertical")
side.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
side.plot(1000 * HAND, 0, "o", color="black", markersize=8)
side.text(1000 * HAND, 0, "   hand", va="center")
side.set(xlabel="distance from axis (mm)", ylabel="depth below the hand (m)", xlim=(-30, 30), ylim=(0.39, -0.02))
side.set_title("at 0.7, 1.5 and 2.6 turns/s")
plt.show()

# %%
# To try next: a larger circle, ``HAND = 0.02``.
#
# Checked: ``tests/python/test_closed_forms.py`` (plummet), ``tests/python/test_response.py`` (small
# amplitude) and ``tests/python/test_rig_shapes.py`` (every shape of a driven chain).
