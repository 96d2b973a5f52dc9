# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment II: when a conical pendulum leaves the vertical
==========================================================

A plummet on a thread leaves the vertical only at speeds whose conical height is less than the thread.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, legend_below, panels, picture, side_view, whirling

LONG, SHORT = 0.5, 0.3  # m, two threads

one = rc.plummet.inclined_pendulum(LONG, rc.conical_pendulum.height("54 rpm"))
figure, axes = picture()
whirling(axes, [one.radius, 0], [one.depth, 0], marker="o", markersize=14, markevery=[0])
axes.set(xlabel="distance from axis (m)", ylabel="depth (m)", ylim=(0.45, -0.02), aspect="equal")
plt.show()

# %%
# The picture shows a thread of 0.5 m at 0.9 turns a second, seen from the side. The depth of the
# plummet below the support is the conical height g/ω²: it depends on the speed alone. Where it
# would be more than the thread, the thread hangs down.

leaves = {thread: rc.conical_pendulum.revolutions_per_second(thread) for thread in (LONG, SHORT)}
for thread, turns in leaves.items():
    print(f"thread {thread} m: leaves the vertical at {turns:.4f} turns a second")

print("turns a second  conical height, m  inclination, degrees  radius, m  tension/weight   (thread 0.5 m)")
table = np.array([0.6, 0.75, 0.9, 1.2, 2.0])
height = rc.conical_pendulum.height(2 * np.pi * table)
swing = rc.plummet.inclined_pendulum(LONG, height)
for row in zip(table, height, np.degrees(swing.inclination), swing.radius, swing.tension, strict=True):
    print("{:14.2f}  {:17.4f}  {:20.2f}  {:9.4f}  {:14.3f}".format(*row))

# %%
# On the left, two threads at four speeds: both plummets are at one level where both have left the
# vertical. On the right, the inclination against the speed. It starts at 0, at the speed at which the pendulum
# leaves the vertical, and rises steeply.

figure, (side, curve) = panels(2, [1.3, 1], height=4.0)
for turns, colour in zip(table[1:], COLOURS, strict=False):
    level = rc.conical_pendulum.height(2 * np.pi * turns)
    side.plot([-0.52, 0.52], [level, level], color=colour, linewidth=0.6, linestyle=":")
    for thread, style in [(LONG, "-"), (SHORT, "--")]:
        swung = rc.plummet.inclined_pendulum(thread, level)
        sign = 1 if thread == LONG else -1
        hang(side, [sign * swung.radius, 0], [swung.depth, 0], weights=[40], color=colour, linestyle=style)
    side.plot([], [], color=colour, label=f"{turns:.2f} turns/s")
side_view(side, "right: thread 0.5 m; left: 0.3 m", bottom=0.56, half_width=0.6)
legend_below(side)
side.set_ylabel("depth below the support (m)")

turns = np.linspace(0.4, 3, 600)
for thread, style in [(LONG, "-"), (SHORT, "--")]:
    swung = rc.plummet.inclined_pendulum(thread, rc.conical_pendulum.height(2 * np.pi * turns))
    curve.plot(turns, np.degrees(swung.inclination), style, color="black", label=f"thread {thread} m")
curve.set(xlabel="speed (turns/s)", ylabel="inclination (°)", title="leaves the vertical at a certain speed")
legend_below(curve, ncols=1)
plt.show()

# %%
# To try next: a heavier plummet. The weight does not matter.
#
# Checked: ``tests/cpp/conical_pendulum.cpp``, and ``tests/python/test_closed_forms.py`` with
# mpmath.
