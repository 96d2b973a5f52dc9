# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment VI: a cue balanced on a hand that moves in a circle; a pendulum that stands on a swinging one.

python experiment_06_balanced_cue.py [FOLDER]
"""

import numpy as np
from _picture import COLOURS, hang, panels, save, side_view

import revchain as rc

HAND = 0.05  # m, radius of its circle
TURNS = 1.0  # a second


def balanced(length, radius, turns):
    """How a uniform stick stands on a hand that goes round: the thread that takes the hand's place is sought."""
    height = rc.conical_pendulum.height(2 * np.pi * turns)
    stick = dict(centroid=length / 2, radius_of_gyration=length / 12**0.5)
    low = rc.two_links.thread_of_standing_link(height, **stick)  # upright, and the hand at rest
    high = 10 * (low + radius)
    for _ in range(60):
        middle = (low + high) / 2
        figure = rc.two_links.standing_link_shape(middle, **stick, height=height)
        low, high = (middle, high) if figure is None or figure.offset[1] < radius else (low, middle)
    return figure


print(f"sticks on a hand that goes round a circle of radius {100 * HAND:.0f} cm, {TURNS:.0f} turn a second:")
print("stick       length, m  swings like, m  a lean grows e-fold in, s  leans inwards, degrees")
sticks = [("pencil", 0.18), ("ruler", 0.5), ("broomstick", 1.2), ("cue", 1.45)]
for name, length in sticks:
    like = rc.two_links.pendulum_length(length / 2, length / 12**0.5)
    grows = rc.conical_pendulum.period(like) / (2 * np.pi)
    lean = np.degrees(balanced(length, HAND, TURNS).inclination[0])
    print(f"{name:10}  {length:9.2f}  {like:14.3f}  {grows:25.3f}  {lean:22.2f}")

pair = dict(standing_weight=0.05, rod=0.3, hung_weight=0.5, thread=1.0)
upright = rc.two_links.standing_plummet(**pair)
upright, alone = rc.conical_pendulum.revolutions_per_second([upright, pair["thread"]])
print(f"50 g standing on 0.3 m of wire above 500 g on 1 m: {upright:.4f} turns a second, 500 g alone {alone:.4f}")
faster = 0.55
figure_of_pair = rc.two_links.standing_plummet_shape(**pair, height=rc.conical_pendulum.height(2 * np.pi * faster))
print(f"at {faster} turns a second: wire and thread lean", *np.degrees(figure_of_pair.inclination).round(2), "degrees")

figure, axes = panels(5, [1, 1, 1, 1, 1.8])
for (name, length), panel in zip(sticks, axes[:4], strict=True):
    lean = balanced(length, HAND, TURNS).inclination[0]
    hang(panel, [HAND, HAND - length * np.sin(lean)], [0, -length * np.cos(lean)], color=COLOURS[0], linewidth=2)
    panel.plot([-HAND, HAND], [0, 0], "|-", color="black", markersize=8)
    side_view(panel, f"{name}\n{np.degrees(lean):.1f}°", bottom=0.05, top=1.5, half_width=0.16)
    panel.set_yticks([0, -0.5, -1, -1.5], ["0.0", "0.5", "1.0", "1.5"])
    panel.set(xlabel="m", xticks=[-0.1, 0.1])
axes[0].set_ylabel("above the hand, m")
top, joint = figure_of_pair.offset
wire, thread = figure_of_pair.inclination
deep = pair["thread"] * np.cos(thread)
hang(axes[4], [top, joint, 0], [deep - pair["rod"] * np.cos(wire), deep, 0], weights=[20, 90], color=COLOURS[1])
side_view(axes[4], f"50 g above 500 g\n{faster} turns/s", bottom=1.05, half_width=0.5)
axes[4].set(ylabel="below the support, m", xlim=(-0.2, 0.65))
figure.suptitle("Sticks on a hand on a circle of radius 5 cm, 1 turn/s; a pendulum standing on a pendulum", fontsize=10)
save(figure)
