# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment XI: a balanced broomstick
====================================

A broomstick stands upright on a hand that moves to and fro. One point of it stays at rest: which one?

Checked: ``tests/python/test_closed_forms.py`` and ``tests/python/test_rig_shapes.py``.

Usage: ``python experiment_11_broomstick.py [FOLDER]``
"""

import numpy as np
from _picture import COLOURS, hang, panels, save, side_view

import revchain as rc

STICK = 1.2  # m, the paper's 2h
LIKE = dict(centroid=STICK / 2, radius_of_gyration=STICK / 12**0.5)

on_the_hand = rc.Rig(rc.Chain.uniform_rods(1, length=STICK), inverted=True)
length = rc.two_links.pendulum_length(**LIKE)  # the paper's l
print(f"its pendulum length is {length:.3f} m; its top stays at rest at", end=" ")
print(f"{rc.conical_pendulum.revolutions_per_second(STICK - length):.4f} swings a second")
print("swings a second  at rest above the hand, m  top over hand  pendulum that can carry it, m  it alone")
for swings in (0.6, 0.788, 1.0, 1.5, 2.0):
    height = rc.conical_pendulum.height(2 * np.pi * swings)
    rest = length + height
    thread = rc.two_links.thread_of_standing_link(height, **LIKE)
    top = rc.response(on_the_hand, conical_height=height, pins=0).offset
    back = rc.conical_pendulum.revolutions_per_second(rc.two_links.standing_link(thread, **LIKE))
    alone = rc.conical_pendulum.revolutions_per_second(thread)
    print(f"{back:15.3f}  {rest:24.3f}  {round(float(top), 3) + 0.0:+13.3f}  {thread:29.3f}  {alone:8.3f}")

figure, axes = panels(4, [1, 1, 1, 1.8])
for panel, swings, colour in zip(axes, (0.6, 0.788, 1.5), COLOURS, strict=False):
    height = rc.conical_pendulum.height(2 * np.pi * swings)
    rest = length + height
    for hand in (-0.1, 0.1):
        hang(panel, [hand, hand * (1 - STICK / rest)], [0, -STICK], color=colour, linewidth=2.5, alpha=0.8)
        panel.plot([hand * (1 - STICK / rest), 0], [-STICK, -rest], ":", color="0.5")
    panel.plot([-0.1, 0.1], [0, 0], "|-", color="black", markersize=8)
    panel.plot(0, -rest, "x", color="black", zorder=4)
    panel.annotate("C", (0, -rest), xytext=(8, -3), textcoords="offset points")
    side_view(panel, f"{swings} swings/s\nC {rest:.2f} m above", bottom=0.05, top=1.7, half_width=0.35)
    panel.set_yticks([0, -0.5, -1, -1.5], ["0.0", "0.5", "1.0", "1.5"])
    panel.set_xlabel("m")
axes[0].set_ylabel("above the hand (m)")

swings = np.linspace(0.45, 2.5, 200)
thread = rc.two_links.thread_of_standing_link(rc.conical_pendulum.height(2 * np.pi * swings), **LIKE)
axes[3].plot(swings, thread, color="black", label="with the broomstick")
axes[3].plot(swings, rc.conical_pendulum.height(2 * np.pi * swings), "--", color="0.5", label="with a plummet")
axes[3].set(xlabel="swings a second", ylabel="length of the pendulum (m)", title="what swings so often", ylim=(0, 2.2))
axes[3].legend()
save(figure)
