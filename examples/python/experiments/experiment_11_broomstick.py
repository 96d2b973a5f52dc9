# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment XI: a balanced broomstick
====================================

A broomstick stands upright on a hand that moves to and fro, and one point of it, or above it, stays at rest: which?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, legend_below, panels, picture, side_view

STICK = 1.2  # m, the paper's 2h
LIKE = dict(centroid=STICK / 2, radius_of_gyration=STICK / 12**0.5)

on_the_hand = rc.Rig(rc.Chain.uniform_rods(1, length=STICK), inverted=True)
length = rc.two_links.pendulum_length(**LIKE)  # the paper's l

rest = length + rc.conical_pendulum.height("1.5 Hz")
figure, axes = picture()
for view in np.cos(np.linspace(np.pi, 0, 7)):
    ends = [0.1 * view, 0.1 * view * (1 - STICK / rest)]
    axes.plot(ends, [0, STICK], color=COLOURS[0], linewidth=5, alpha=1.0 if view == 1 else 0.2)
axes.plot([-0.1, 0.1], [0, 0], color="black", linewidth=8)
axes.plot(0, rest, "o", color="black", markersize=9)
axes.annotate("C", (0, rest), xytext=(9, -4), textcoords="offset points", fontsize="large")
axes.set(xlabel="to and fro (m)", ylabel="height above the hand (m)", xlim=(-0.3, 0.3))
plt.show()

# %%
# The hand moves by 0.1 m to each side, 1.5 times a second. The point C of the stick stays at rest.
# The horizontal scale is larger than the vertical one. The slower the hand, the higher C; below
# 0.788 swings a second it is above the top of the stick.

print(f"its pendulum length is {length:.3f} m; its top stays at rest at", end=" ")
print(f"{rc.conical_pendulum.revolutions_per_second(STICK - length):.4f} swings a second")

# %%
# A pendulum of the right length, standing on its head in the hand, carries the stick at each
# frequency.

print("swings a second  at rest above the hand, m  top over hand  pendulum that can carry it, m  it alone")
for swings in (0.6, 0.788, 1.0, 1.5, 2.0):
    height = rc.conical_pendulum.height(2 * np.pi * swings)
    rest = length + height
    thread = rc.two_links.thread_of_standing_link(height, **LIKE)
    top = rc.response(on_the_hand, conical_height=height, pins=0).offset
    back = rc.conical_pendulum.revolutions_per_second(rc.two_links.standing_link(thread, **LIKE))
    alone = rc.conical_pendulum.revolutions_per_second(thread)
    print(f"{back:15.3f}  {rest:24.3f}  {round(float(top), 3) + 0.0:+13.3f}  {thread:29.3f}  {alone:8.3f}")

# %%
# On the left, three frequencies. On the right, the length of that pendulum with the broomstick, and
# with a plummet.

figure, (stand, curve) = panels(2, [1.5, 1], height=5.0)
APART, HAND = 0.5, 0.1  # m, between neighbouring axes; how far the hand goes to each side
names = []
for number, swings in enumerate((0.6, 0.788, 1.5)):
    rest, at = length + rc.conical_pendulum.height(2 * np.pi * swings), APART * number
    for hand in (-HAND, HAND):
        top = at + hand * (1 - STICK / rest)
        hang(stand, [at + hand, top], [0, -STICK], color=COLOURS[number], linewidth=2.5, alpha=0.8)
        stand.plot([top, at], [-STICK, -rest], ":", color="0.5")
    stand.plot([at - HAND, at + HAND], [0, 0], "|-", color="black", markersize=8, clip_on=False)
    stand.plot([at, at], [0, -1.6], color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
    stand.plot(at, -rest, "x", color="black", zorder=4)
    stand.annotate("C", (at, -rest), xytext=(8, -3), textcoords="offset points")
    names.append(f"{swings}\nswings/s\nC at {rest:.2f} m")
side_view(stand, "a broomstick on a hand that goes to and fro", bottom=0.05, top=1.7, half_width=1)
stand.lines[-1].remove()  # there are three axes
stand.set_xticks(APART * np.arange(3), names)
stand.set(xlim=(-0.25, 2 * APART + 0.25), xlabel="C stays at rest", ylabel="height above the hand (m)")
stand.set_yticks([0, -0.5, -1, -1.5], ["0.0", "0.5", "1.0", "1.5"])

swings = np.linspace(0.45, 2.5, 200)
thread = rc.two_links.thread_of_standing_link(rc.conical_pendulum.height(2 * np.pi * swings), **LIKE)
curve.plot(swings, thread, color="black", label="with the broomstick")
curve.plot(swings, rc.conical_pendulum.height(2 * np.pi * swings), "--", color="0.5", label="with a plummet")
curve.set(xlabel="frequency (swings/s)", ylabel="length of the pendulum (m)", ylim=(0, 2.0))
curve.set_title("a pendulum of that frequency")
legend_below(curve, ncols=1)
plt.show()

# %%
# To try next: a cue, ``STICK = 1.45``.
#
# Checked: ``tests/python/test_closed_forms.py`` and ``tests/python/test_rig_shapes.py``.
