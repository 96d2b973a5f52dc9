# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment IX: a whirling chain drawn out (skipping rope)
=========================================================

When the ends of a whirling chain are drawn apart, it keeps its angular momentum and turns faster.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, legend_below, panels, picture, whirling

LENGTH, SPAN, TURNS = 2.0, 1.0, 3.0  # m of chain, m between the hands, turns a second at first
MASS = 0.05  # kg/m, a light chain
LINKS = 100

start = rc.SkippingRope(span=SPAN, length=LENGTH, angular_speed=2 * np.pi * TURNS)
ropes = [start, *(start.drawn_to(span) for span in (1.3, 1.5, 1.7, 1.8))]
places = np.linspace(0, LENGTH, 2001)
at = start.at_arc(places)
figure, axes = picture()
for view in np.cos(np.linspace(np.pi, 0, 7)):
    axes.plot(at.x, view * at.offset, color=COLOURS[0], linewidth=2.5, alpha=1.0 if view == 1 else 0.2)
axes.plot([0, SPAN], [0, 0], "o", color="black", markersize=12)
axes.set(xlabel="along the axis (m)", ylabel="distance from axis (m)", aspect="equal")
plt.show()

# %%
# Two metres of chain between two hands 1 m apart, like a skipping rope, seen from the side at seven
# moments of half a turn. The dots are the hands.
#
# The hands draw the ends apart. The moment of inertia falls and the speed rises; the hands do work.

print("span, m  sag, m  turns a second  moment of inertia, kg m^2  pull along the axis, N  work done, J")
for rope in ropes:
    turns = rope.angular_speed / (2 * np.pi)
    energy, first = (MASS * r.moment_of_inertia * r.angular_speed**2 / 2 for r in (rope, start))
    pull = rope.tension_in_the_middle * MASS * 9.80665
    numbers = (rope.span, rope.sag, turns, MASS * rope.moment_of_inertia, pull, energy - first)
    print("{:7.2f}  {:6.3f}  {:14.3f}  {:24.5f}  {:22.1f}  {:12.2f}".format(*numbers))
force = start.sag * start.angular_speed**2 / 9.80665
print(f"at first the centrifugal force on the middle is {force:.1f} times its weight")

# %%
# With gravity, one end above the other, the widest point is below the middle. The slower the chain,
# the lower that point.

held = rc.Held(rc.Cord(LENGTH, mass=MASS * LENGTH), span=SPAN)
linked = rc.Held(rc.Chain.uniform_rods(LINKS, length=LENGTH, mass=MASS * LENGTH), span=SPAN)
print(f"with gravity, one end {SPAN:.0f} m above the other: rope, and {LINKS} links instead of it:")
print("turns a second  sag, m  of links  widest below the middle, m  pull along the axis, N: above  below")
upright = {}
for turns in (5.0, 3.0, 2.0, 1.0, 0.6):
    (cord,) = rc.steady_shapes(held, angular_speed=2 * np.pi * turns)
    (links,) = rc.steady_shapes(linked, angular_speed=2 * np.pi * turns)
    widest = cord.along(np.interp(0, cord.along(places).inclination, places))  # where it is parallel to the axis
    numbers = (turns, widest.offset, links.offset.max(), SPAN / 2 - widest.height)
    pulls = (-cord.upper_pull[1], cord.lower_pull[1])  # what the hands feel, outwards
    print("{:14.1f}  {:6.4f}  {:8.4f}  {:26.4f}  {:29.2f}  {:5.2f}".format(*numbers, *pulls))
    upright[turns] = cord.along(places)
longer = (LENGTH + SPAN) / 2  # of the two parts of a rope that hangs down, the upper hand's
(folded,) = rc.modes(rc.Cord(longer), 1).frequency
assert not rc.steady_shapes(held, angular_speed=2 * np.pi * folded)
print(f"up to {folded:.4f} turns a second, the first whirl speed of a chain of {longer} m,", end=" ")
print("it hangs folded along the axis")

# %%
# On the left, the chain drawn out. In the middle, the speed against the span. On the right, the
# chain with gravity.

figure, (side, curve, vertical) = panels(3, [1.7, 1, 1])
for rope, colour in zip(ropes, COLOURS, strict=False):
    at = rope.at_arc(places)
    label = f"{rope.angular_speed / (2 * np.pi):.2f} turns/s"
    side.plot(at.x - rope.span / 2, at.offset, color=colour, label=label)
side.axhline(0, color="0.6", linewidth=0.8, linestyle="-.")
side.set(xlabel="along the axis (m)", ylabel="distance from axis (m)", title="2 m of chain, ends drawn apart")
side.set_ylim(-0.05, 0.9)
side.set_aspect("equal")
legend_below(side)

span = np.linspace(0.9, 1.9, 120)
curve.plot(span, [start.drawn_to(s).angular_speed / (2 * np.pi) for s in span], color="black")
for rope, colour in zip(ropes, COLOURS, strict=False):
    curve.plot(rope.span, rope.angular_speed / (2 * np.pi), "o", color=colour)
curve.set(xlabel="span of the ends (m)", ylabel="speed (turns/s)", title="same angular momentum", ylim=(0, None))
for (turns, at), colour in zip(upright.items(), ["black", "0.35", "0.5", "0.65", "0.8"], strict=True):
    vertical.plot(at.offset, at.height, color=colour, label=f"{turns:.1f}")
vertical.plot([0, 0], [0, SPAN], "o", color="black", markersize=4)
vertical.axvline(0, color="0.6", linewidth=0.8, linestyle="-.")
vertical.set(xlabel="distance from axis (m)", ylabel="height above the lower hand (m)", title="with gravity")
vertical.set_aspect("equal")
legend_below(vertical, ncols=3, title="turns/s", handlelength=1, columnspacing=1)
plt.show()

# %%
# To try next: another first speed, ``TURNS = 6.0``: the shapes without gravity are the same.
#
# Checked: ``tests/python/test_closed_motions.py`` (without gravity) and
# ``tests/python/test_held.py`` (with gravity).
