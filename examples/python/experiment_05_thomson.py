# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment V: Thomson's four cases
==================================

Two weights on one thread, the second at different places: Thomson's four cases of Greenhill's Fig. 4.

Checked: ``tests/python/test_closed_forms.py``, with mpmath.
"""

import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, legend_below, panels, save, side_view

THREAD = 1.0  # m, the whole of it
A = THREAD / 2  # the paper's a; x is how far the upper weight sits above the middle

print("upper/lower weight  upper weight at, m  conical heights/a  turns a second  ratio of periods")
for heavier, at in [(2, 0.25), (2, 0.75), (2, 0.5), (3, 0.5)]:
    heights = rc.two_links.two_plummets_from_the_middle(A, A - at, weight_ratio=1 / heavier)
    turns = rc.conical_pendulum.revolutions_per_second(heights)
    numbers = "{:.6f} {:.6f}   {:.4f} {:.4f}".format(*heights / A, *turns)
    print(f"{heavier:18}  {at:18.2f}  {numbers}  {turns[1] / turns[0]:16.4f}")

figure, axes = panels(5, [1, 1, 1, 1, 2.4], height=5.0)
for number, panel in enumerate(axes[:4]):
    at, k = [(0.25, 0), (0.25, 1), (0.75, 0), (0.75, 1)][number]
    result = rc.modes(rc.Chain(weight=[1, 2], length=[THREAD - at, at]))
    shape = result.shape[k] * 0.12 / np.max(np.abs(result.shape[k]))
    level = THREAD - result.conical_height[k]  # of C1, a conical height above the lowest weight
    hang(panel, shape, [THREAD, at, 0], weights=[30, 60], color=COLOURS[k])
    panel.plot([shape[0], 0], [THREAD, level], "--", color="0.5", linewidth=1, zorder=1)
    panel.plot(0, level, "x", color="black")
    panel.annotate("C₁", (0, level), xytext=(5, -2), textcoords="offset points")
    title = f"x = {(A - at) / A:+.1f}a\n{result.frequency[k]:.2f} turns/s"
    side_view(panel, title, bottom=1.06, half_width=0.16)
    panel.set(xlabel="distance\nfrom axis (m)", xticks=[-0.1, 0.1])
axes[0].set_ylabel("depth below the support (m)")

x = np.linspace(-0.98, 0.98, 197)
for heavier, style in [(2, "-"), (3, "--"), (20, ":")]:
    heights = rc.two_links.two_plummets_from_the_middle(1.0, x, weight_ratio=1 / heavier)
    for k in range(2):
        axes[4].plot(x, heights[:, k], style, color=COLOURS[k])
    axes[4].plot([], [], style, color="black", label=f"W₂ = {heavier} W₁")
axes[4].plot([-0.5, -0.5, 0.5, 0.5], 2 * [1 + 0.5**0.5, 1 - 0.5**0.5], "o", color="black", markersize=4)
axes[4].set(xlabel="place x/a of the upper weight", ylabel="conical height/a", title="W₂ anywhere", ylim=(0, 2))
legend_below(axes[4], ncols=1)
save(figure, "experiment_05_thomson")
