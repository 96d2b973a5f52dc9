# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment X: a stick on a string
=================================

A stick is whirled round at the end of a string, near the vertical and at any inclination.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, branch_of, hang, panels, picture, side_view, whirling

STRING, STICK = 0.4, 0.6  # m
GYRATION = STICK / 12**0.5  # about the middle of the stick
HAND = 0.02  # m, radius of the circle in which the upper end of the string is carried

shape = rc.two_links.link_on_thread_shapes(STRING, STICK / 2, GYRATION, rc.conical_pendulum.height("48 rpm"))[0]
stick, string = shape.inclination
joint = STRING * np.sin(string), STRING * np.cos(string)
end = joint[0] + STICK * np.sin(stick), joint[1] + STICK * np.cos(stick)
figure, axes = picture()
whirling(axes, [joint[0], 0], [joint[1], 0], color="0.4")
whirling(axes, [end[0], joint[0]], [end[1], joint[1]], linewidth=7)
axes.set(xlabel="distance from axis (m)", ylabel="depth below the hand (m)", ylim=(0.8, -0.05), aspect="equal")
plt.show()

# %%
# A stick of 0.6 m on a string of 0.4 m at 0.8 turns a second, seen from the side at seven moments
# of half a turn.
#
# Where the string is tied changes the two speeds at which stick and string leave the vertical.

print("string tied  turns a second at which it leaves the vertical")
for tied in (0, 0.1, 0.2):
    heights = rc.two_links.link_on_thread(STRING, centroid=STICK / 2 - tied, radius_of_gyration=GYRATION)
    turns = rc.conical_pendulum.revolutions_per_second(heights)
    print(f"{100 * tied:3.0f} cm from its end  {turns[0]:.4f} {turns[1]:.4f}")


def figures(turns):
    height = rc.conical_pendulum.height(2 * np.pi * turns)
    return rc.two_links.link_on_thread_shapes(STRING, STICK / 2, GYRATION, height)


# %%
# Above these speeds, each shape is at an inclination of its own.

print("tied to its end, inclinations in degrees:")
print("turns a second  figure    stick   string  pull/weight")
for turns in (0.6, 0.8, 1.5, 3.0):
    for shape in figures(turns):
        stick, string = np.degrees(shape.inclination)
        print(f"{turns:14.1f}  {shape.half_waves:6}  {stick:7.2f}  {string:7.2f}  {shape.tension[1]:11.3f}")

# %%
# The hand goes round a small circle itself. At the third speed of the table the joint stays on the
# axis: that is the speed of the stick alone.

chain = rc.Chain(weight=[1, 0], length=[STICK, STRING], centroid=[STICK / 2, 0], radius_of_gyration=[GYRATION, 0])
carried = rc.Rig(chain, support=rc.Support(radius=HAND))
print("hand on a small circle, small amplitude, offsets over that of the hand:")
print("turns a second  end of the stick    joint")
alone = rc.conical_pendulum.revolutions_per_second(rc.two_links.pendulum_length(STICK / 2, GYRATION))
for turns in (0.4, 0.6, alone, 1.5, 2.0, 2.5):
    end, joint, _ = rc.response(carried, angular_speed=2 * np.pi * turns).amplification
    print(f"{turns:14.3f}  {end:+16.3f}  {round(joint, 3) + 0.0:+7.3f}")
print(f"on a circle of {100 * HAND:.0f} cm, every steady shape, inclinations of stick and string in degrees:")


def driven(turns):
    shapes = rc.steady_shapes(carried, angular_speed=2 * np.pi * turns)
    assert shapes.complete
    return shapes


for turns in (0.4, 0.6, 0.8, 1.5, 2.5):
    pairs = [np.degrees(shape.inclination) for shape in driven(turns)]
    print(f"{turns:14.1f}   ", "   ".join(f"{stick:6.2f} {string:6.2f}" for stick, string in pairs))

# %%
# The hand on its circle. Each colour is a branch, whose shapes change continuously with the speed.
# Its label gives the speed at which it starts. On the left, the inclination of the stick. On the
# right, the five shapes at 2.5 turns a second, numbered like the dots.


def draw(axes, hand, shape, colour, text):
    """Stick and string from the side, and a text at the lower end of the stick."""
    stick, string = shape.inclination
    joint = hand + STRING * np.sin(string), STRING * np.cos(string)
    end = joint[0] + STICK * np.sin(stick), joint[1] + STICK * np.cos(stick)
    hang(axes, [joint[0], hand], [joint[1], 0], color=colour, linewidth=1.5)
    hang(axes, [end[0], joint[0]], [end[1], joint[1]], color=colour, linewidth=6, solid_capstyle="butt")
    axes.text(*end, f"  {text}  ", color=colour, va="center", ha="left" if end[0] > 0 else "right")


figure, (curve, side) = panels(2, [1, 1.8], height=4)
branches = rc.branches(carried, max_angular_speed=2 * np.pi * 4)
hues = [COLOURS[0], COLOURS[2], COLOURS[1]]
for line, colour, place in zip(branches, hues, [(0.9, 55), (0.9, -52), (2.75, 8)], strict=True):
    speeds = line.angular_speed / (2 * np.pi)
    curve.plot(speeds, np.degrees(line.lowest_inclination), color=colour, linewidth=2.5)
    curve.text(*place, "from rest" if line.birth == "rest" else f"from {min(speeds):.2f}\nturns/s", color=colour)
for number, shape in enumerate(sorted(driven(2.5), key=lambda shape: shape.inclination[0]), 1):
    colour = hues[branch_of(shape, branches)]
    draw(side, HAND, shape, colour, number)
    curve.plot(2.5, np.degrees(shape.inclination[0]), "o", color=colour)
    curve.text(2.5, np.degrees(shape.inclination[0]) + 4, number, color=colour, ha="right" if number == 4 else "left")
curve.axhline(0, color="black", linewidth=0.6)
curve.set(xlabel="speed (turns/s)", ylabel="inclination of the stick (°)", yticks=range(-90, 91, 30))
curve.set_title("hand on a circle of 2 cm")
side_view(side, "the five shapes at 2.5 turns/s", bottom=1.05, half_width=1.15)
side.set_ylabel("depth below the hand (m)")
plt.show()

# %%
# The hand at rest. On the left, the shapes of the second table, with their turns a second: blue
# with one half wave, orange with two. On the right, the inclinations of stick (broad) and string.

figure, (side, curve) = panels(2, [1.5, 1])
for turns in (0.6, 0.8, 1.5, 3.0):
    for shape in figures(turns):
        colour = COLOURS[shape.half_waves - 1]
        draw(side, 0, shape, colour, turns)
        curve.plot(turns, np.degrees(shape.inclination[0]), "o", color=colour, markersize=7)
for k, slowest in enumerate(rc.modes(chain).frequency):
    speeds = slowest + (4 - slowest) * np.linspace(0, 1, 100) ** 2
    lean = np.degrees([[0, 0], *(figures(n)[k].inclination for n in speeds[1:])])
    curve.plot(speeds, lean[:, 0], color=COLOURS[k], linewidth=4)
    curve.plot(speeds, lean[:, 1], color=COLOURS[k], linewidth=1.5)
for x, y, text, k in [(1.2, 50, "stick (string\nnearly\nthe same)", 0), (3, 50, "stick", 1), (3, -40, "string", 1)]:
    curve.text(x, y, text, color=COLOURS[k])
curve.axhline(0, color="black", linewidth=0.6)
curve.set(xlabel="speed (turns/s)", ylabel="inclination (°)", yticks=range(-60, 91, 30), ylim=(-65, 95))
side_view(side, "hand at rest: 0.6, 0.8, 1.5 and 3 turns/s", bottom=1.0, half_width=1)
side.set(ylabel="depth below the hand (m)", xlim=(-0.35, 1.2))
plt.show()

# %%
# To try next: a longer string, ``STRING = 0.8``: both speeds fall.
#
# Checked: ``tests/python/test_closed_forms.py`` (hand at rest), ``tests/python/test_response.py``
# and ``tests/python/test_rig_shapes.py`` (hand on a circle).
