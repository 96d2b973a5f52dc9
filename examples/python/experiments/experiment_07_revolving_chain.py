# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment VII: the revolving chain at any inclination
======================================================

A chain of 1 m whirled by the hand at any inclination, and two weights in its place.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, legend_below, picture, side_view, whirling
from revchain.plots.style import legend_outside

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
# Two weights in the place of the two halves of the chain behave alike, up to their two shapes.


def figures(turns):
    return rc.two_links.two_plummets_shapes(**PAIR, height=rc.conical_pendulum.height(2 * np.pi * turns))


print("two weights instead, inclinations in degrees:")
print("turns a second  figure  lower thread  upper")
for turns in (0.7, 1.0, 2.0, 3.0):
    for shape in figures(turns):
        lower, upper = np.degrees(shape.inclination)
        print(f"{turns:14.1f}  {shape.half_waves:6}  {lower:12.2f}  {upper:5.2f}")

# %%
# On the left, the shapes of the chain at 3 turns a second, and of the two weights at three speeds.
# On the right, the free end against the speed.

figure = plt.figure(figsize=(8, 6), layout="constrained")
axes = figure.subplot_mosaic([["chain", "curve"], ["pair", "curve"]], width_ratios=[1.3, 1])
for shape in rc.steady_shapes(cord, angular_speed=2 * np.pi * 3.0):
    label, colour = f"{shape.half_waves}", COLOURS[shape.half_waves - 1]
    hang(axes["chain"], shape.offset, -shape.height, color=colour, label=label)
side_view(axes["chain"], "chain at 3 turns/s", bottom=1.03, half_width=1)
axes["chain"].set_xlim(-0.4, 1.05)
axes["chain"].set_ylabel("depth below the support (m)")
legend_outside(axes["chain"], title="half waves")

for turns, style in [(0.7, ":"), (1.0, "--"), (2.0, "-")]:
    for shape in figures(turns):
        depth = np.cumsum(np.cos(shape.inclination[::-1]) * [PAIR["upper_thread"], PAIR["lower_thread"]])
        colour = COLOURS[shape.half_waves - 1]
        hang(axes["pair"], [*shape.offset, 0], [*depth[::-1], 0], weights=[30, 30], color=colour, linestyle=style)
    axes["pair"].plot([], [], style, color="black", label=f"{turns:.1f}")
side_view(axes["pair"], "two weights instead", bottom=0.9, half_width=1)
axes["pair"].set_xlim(-0.4, 1.05)
axes["pair"].set_ylabel("depth below the support (m)")
legend_outside(axes["pair"], title="turns/s")

curve = axes["curve"]
turns = np.linspace(0.4, 3.5, 800)
for half_waves in (1, 2):
    tips = [[shape.offset[0] for shape in figures(n) if shape.half_waves == half_waves] for n in turns]
    curve.plot(turns, [max(tip, default=0) for tip in tips], color=COLOURS[half_waves - 1])
for half_waves in (1, 2, 3):
    critical = continuous.frequency[half_waves - 1]
    faster = turns[turns > critical]
    shapes = [rc.steady_shapes(cord, angular_speed=2 * np.pi * n)[half_waves - 1] for n in faster]
    tips = [0.0, *(s.offset[0] for s in shapes)]
    curve.plot([critical, *faster], tips, ":", color=COLOURS[half_waves - 1])
curve.plot([], [], color="black", label="two weights")
curve.plot([], [], ":", color="black", label="chain")
curve.set(xlabel="speed (turns/s)", ylabel="distance of the free end from axis (m)", ylim=(-0.02, 1.02))
curve.set_title("the free end; colours: half waves")
legend_below(curve)
plt.show()

# %%
# To try next: ``rc.steady_shapes(cord, angular_speed=60.0)``, with a dozen half waves.
#
# Checked: ``tests/cpp/finite/cord/continuous_chain.cpp`` (cord),
# ``tests/python/test_steady_shapes.py`` (links) and ``tests/python/test_closed_forms.py`` (two
# weights).
