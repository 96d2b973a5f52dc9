# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment X: a stick on a string
=================================

A stick is whirled round at the end of a string, near the vertical and at any inclination.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, legend_below, picture, side_view, whirling

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
# Above, every shape with the hand at rest. Below, the inclinations against the speed, with the hand
# at rest and on a circle.

figure = plt.figure(figsize=(8, 7), layout="constrained")
axes = figure.subplot_mosaic([["side", "side"], ["curve", "hand"]], height_ratios=[1, 1.2])
side, curve, hand = (axes[name] for name in ("side", "curve", "hand"))
for turns in (0.6, 0.8, 1.5, 3.0):
    for shape in figures(turns):
        stick, string = shape.inclination
        joint, deep = shape.offset[1], STRING * np.cos(string)
        colour = COLOURS[shape.half_waves - 1]
        hang(side, [joint, 0], [deep, 0], color="0.4", linewidth=1)
        end = [joint + STICK * np.sin(stick), joint], [deep + STICK * np.cos(stick), deep]
        hang(side, *end, color=colour, linewidth=3)
        side.annotate(f"{turns} turns/s", (end[0][0], end[1][0]), xytext=(5, -4), textcoords="offset points")
side_view(side, "hand at rest: every shape with a bent string", bottom=1.05, half_width=1)
side.set(ylabel="depth below the hand (m)", xlim=(-0.35, 1.4))

speeds = np.linspace(0.4, 4, 700)
for half_waves in (1, 2):
    for number, style in [(0, "-"), (1, "--")]:
        lean = [[s.inclination[number] for s in figures(n) if s.half_waves == half_waves] for n in speeds]
        degrees = [np.degrees(x[0]) if x else np.nan for x in lean]
        name = f"{['stick', 'string'][number]}, {half_waves} half wave{'s' * (half_waves > 1)}"
        curve.plot(speeds, degrees, style, color=COLOURS[half_waves - 1], label=name)
for k, line in enumerate(rc.branches(carried, max_angular_speed=2 * np.pi * 4)):
    label = "branch from rest" if line.birth == "rest" else f"isolated branch {k}"
    hand.plot(line.angular_speed / (2 * np.pi), np.degrees(line.lowest_inclination), color=COLOURS[k], label=label)
for panel, title in [(curve, "hand at rest"), (hand, f"hand on a circle of {HAND} m: the stick")]:
    panel.axhline(0, color="black", linewidth=0.6)
    panel.set(xlabel="speed (turns/s)", ylabel="inclination (°)", title=title)
    panel.set(yticks=range(-90, 91, 30), ylim=(-95, 95))
legend_below(curve)
legend_below(hand)
plt.show()

# %%
# To try next: a longer string, ``STRING = 0.8``: both speeds fall.
#
# Checked: ``tests/python/test_closed_forms.py`` (hand at rest), ``tests/python/test_response.py``
# and ``tests/python/test_rig_shapes.py`` (hand on a circle).
