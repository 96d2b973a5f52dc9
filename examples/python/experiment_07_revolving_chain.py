# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment VII: a chain of 1 m whirled in the hand; two weights in its place at any inclination.

python experiment_07_revolving_chain.py [FOLDER]
"""

import numpy as np
from _picture import COLOURS, hang, panels, save, side_view

import revchain as rc

LENGTH = 1.0  # m
PAIR = dict(lower_weight=1, lower_thread=0.5, upper_weight=1, upper_thread=0.25)  # each in the middle of half a chain

chain = rc.Chain.uniform_rods(200, length=LENGTH)
result = rc.modes(chain, count=3)
pair_speeds = rc.conical_pendulum.revolutions_per_second(rc.two_links.two_plummets(**PAIR))
print("turns a second at which another figure leaves the vertical:")
print("  chain of 200 links ", *result.revolutions_per_second().round(4))
print("  continuous chain   ", *rc.heavy_chain.revolutions_per_second(3, LENGTH).round(4))
print("  two weights instead", *pair_speeds.round(4))
for turns in (0.5, 1, 2, 3):
    below = rc.count_modes(chain, angular_speed=2 * np.pi * turns)
    print(f"at {turns} turns a second the chain has {below} of them below")


def figures(turns):
    return rc.two_links.two_plummets_shapes(**PAIR, height=rc.conical_pendulum.height(2 * np.pi * turns))


print("two weights instead, inclinations in degrees:")
print("turns a second  figure  lower thread  upper")
for turns in (0.7, 1.0, 2.0, 3.0):
    for shape in figures(turns):
        lower, upper = np.degrees(shape.inclination)
        print(f"{turns:14.1f}  {shape.half_waves:6}  {lower:12.2f}  {upper:5.2f}")

figure, axes = panels(3, [1, 1.5, 1.5])
x = np.linspace(0, LENGTH, 200)
for k in range(3):
    turns = result.revolutions_per_second()[k]
    offset = 0.12 * rc.heavy_chain.shape(x, k + 1, LENGTH)
    hang(axes[0], offset, LENGTH - x, color=COLOURS[k], label=f"{turns:.2f}")
side_view(axes[0], "chain, near the vertical", bottom=1.06, half_width=0.25)
axes[0].set_ylabel("below the support, m")
axes[0].legend(title="turns/s", loc="upper right", fontsize=8, frameon=False, handlelength=1)

for turns, style in [(0.7, ":"), (1.0, "--"), (2.0, "-")]:
    for shape in figures(turns):
        depth = np.cumsum(np.cos(shape.inclination[::-1]) * [PAIR["upper_thread"], PAIR["lower_thread"]])
        colour = COLOURS[shape.half_waves - 1]
        hang(axes[1], [*shape.offset, 0], [*depth[::-1], 0], weights=[30, 30], color=colour, linestyle=style)
    axes[1].plot([], [], style, color="black", label=f"{turns:.1f}")
side_view(axes[1], "two weights instead", bottom=0.9, half_width=0.85)
axes[1].set_xlim(-0.4, 0.85)
axes[1].legend(title="turns/s", loc="lower left", fontsize=8, frameon=False)

turns = np.linspace(0.4, 3.5, 800)
for half_waves in (1, 2):
    tips = [[shape.offset[0] for shape in figures(n) if shape.half_waves == half_waves] for n in turns]
    axes[2].plot(turns, [max(tip, default=0) for tip in tips], color=COLOURS[half_waves - 1])
for k, speed in enumerate(result.revolutions_per_second()):
    axes[2].axvline(speed, color=COLOURS[k], linestyle=":", linewidth=1)
axes[2].set(xlabel="turns a second", ylabel="lower weight from the axis, m", ylim=(-0.02, 0.8))
axes[2].set_title("two weights (dotted: the chain)")
save(figure)
