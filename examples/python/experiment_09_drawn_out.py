# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment IX: a whirling chain whose ends are drawn apart keeps its angular momentum and turns faster.

python experiment_09_drawn_out.py [FOLDER]
"""

import numpy as np
from _picture import COLOURS, panels, save

import revchain as rc

LENGTH, SPAN, TURNS = 2.0, 1.0, 3.0  # m of chain, m between the hands, turns a second at first
MASS = 0.05  # kg/m, a light chain

start = rc.SkippingRope(span=SPAN, length=LENGTH, angular_speed=2 * np.pi * TURNS)
ropes = [start, *(start.drawn_to(span) for span in (1.3, 1.5, 1.7, 1.8))]
print("span, m  sag, m  turns a second  moment of inertia, kg m^2  pull along the axis, N  work done, J")
for rope in ropes:
    turns = rope.angular_speed / (2 * np.pi)
    energy, first = (MASS * r.moment_of_inertia * r.angular_speed**2 / 2 for r in (rope, start))
    pull = rope.tension_in_the_middle * MASS * 9.80665
    numbers = (rope.span, rope.sag, turns, MASS * rope.moment_of_inertia, pull, energy - first)
    print("{:7.2f}  {:6.3f}  {:14.3f}  {:24.5f}  {:22.1f}  {:12.2f}".format(*numbers))
print(f"at first the middle is flung outwards with {start.sag * start.angular_speed**2 / 9.80665:.1f} times its weight")

figure, (side, curve) = panels(2, [1.5, 1])
for rope, colour in zip(ropes, COLOURS, strict=False):
    places = rope.at_arc(np.linspace(0, LENGTH, 200))
    label = f"{rope.angular_speed / (2 * np.pi):.2f} turns/s"
    side.plot(places.x - rope.span / 2, places.offset, color=colour, label=label)
side.axhline(0, color="0.6", linewidth=0.8, linestyle="-.")
side.set(xlabel="along the axis, m", ylabel="from the axis, m", title="2 m of chain, ends drawn apart")
side.set_ylim(-0.05, 1.25)
side.set_aspect("equal")
side.legend(loc="upper center", ncols=2)

span = np.linspace(0.9, 1.9, 120)
curve.plot(span, [start.drawn_to(s).angular_speed / (2 * np.pi) for s in span], color="black")
for rope, colour in zip(ropes, COLOURS, strict=False):
    curve.plot(rope.span, rope.angular_speed / (2 * np.pi), "o", color=colour)
curve.set(xlabel="distance of the ends, m", ylabel="turns a second", title="angular momentum kept", ylim=(0, None))
save(figure)
