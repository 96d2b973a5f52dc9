# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment IV: a chain twirled by the hand
==========================================

The hand moves the upper end round a small circle: at higher speeds the tip changes to the other side of the axis.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, branch_of, hang, picture, side_view, whirling
from revchain.plots.style import legend_outside

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
# At any inclination there are several steady shapes at one speed. Two more appear a little above
# each speed at which the tip changes sides.

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
# Above, the response near the vertical, and the shapes at three speeds. Below, every steady shape:
# the tip against the speed, and all shapes at 3 turns a second in the colours of their branches.

figure = plt.figure(figsize=(8, 7.5), layout="constrained")
axes = figure.subplot_mosaic([["near", "side"], ["all", "shapes"]], height_ratios=[1.3, 1])
turns = np.linspace(0.2, 2.8, 1301)
plummet = rc.plummet.carried_response(LENGTH, rc.conical_pendulum.height(2 * np.pi * turns))
curves = [("plummet", plummet, "0.45", (2, 0.4)), ("chain", near_the_vertical(turns), COLOURS[0], (1.4, -2))]
for name, tip, colour, place in curves:
    axes["near"].plot(turns, np.where(np.abs(tip) < 12, tip, np.nan), color=colour)
    axes["near"].annotate(name, place, color=colour)
axes["near"].axhline(0, color="black", linewidth=0.6)
axes["near"].set(xlabel="speed (turns/s)", ylabel="offset of the tip / of the hand", ylim=(-12, 12))
axes["near"].set_title("near the vertical")

depth = np.linspace(LENGTH, 0, LINKS + 1)
for speed, colour in zip((0.7, 1.5, 2.6), ("black", "0.4", "0.65"), strict=True):
    one = rc.response(carried, angular_speed=2 * np.pi * speed)
    hang(axes["side"], one.offset, depth, color=colour, label=f"{speed} turns/s")
axes["side"].axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
axes["side"].plot(HAND, 0, "o", color="black", markersize=4)
axes["side"].annotate("hand", (HAND, 0), xytext=(4, 0), textcoords="offset points")
axes["side"].set(xlabel="distance from axis (m)", ylabel="depth below the hand (m)")
axes["side"].set(ylim=(0.37, -0.01), xlim=(-0.04, 0.04))
axes["side"].set_title("at three speeds")
legend_outside(axes["side"])

branches = rc.branches(carried, max_angular_speed=2 * np.pi * 3.2)
for k, line in enumerate(branches):
    label = "branch from rest" if line.birth == "rest" else f"isolated branch {k}"
    axes["all"].plot(line.angular_speed / (2 * np.pi), line.tip_radius, color=COLOURS[k], label=label)
axes["all"].axhline(0, color="black", linewidth=0.6)
axes["all"].set(xlabel="speed (turns/s)", ylabel="offset of the tip (m)", title="every steady shape")
for shape in at_any_inclination(3.0):
    hang(axes["shapes"], shape.offset, -shape.height, color=COLOURS[branch_of(shape, branches)])
figure.legend(*axes["all"].get_legend_handles_labels(), loc="outside lower center", ncols=3)
side_view(axes["shapes"], "every one at 3 turns a second", bottom=0.38, half_width=0.4)
axes["shapes"].set_ylabel("depth below the hand (m)")
plt.show()

# %%
# To try next: a larger circle, ``HAND = 0.02``.
#
# Checked: ``tests/python/test_closed_forms.py`` (plummet), ``tests/python/test_response.py`` (small
# amplitude) and ``tests/python/test_rig_shapes.py`` (every shape of a driven chain).
