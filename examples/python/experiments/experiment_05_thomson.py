# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment V: Thomson's four cases of two weights on a thread
=============================================================

Two weights on one thread, the upper one at different places: Thomson's four cases of Greenhill's Fig. 4.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, legend_below, panels, picture, side_view, whirling

THREAD = 1.0  # m, the whole of it
A = THREAD / 2  # the paper's a; x is how far the upper weight sits above the middle

slow = rc.modes(rc.Chain(weight=[1, 2], length=[0.75, 0.25]))
figure, axes = picture()
whirling(axes, 0.15 * slow.shape[0] / slow.shape[0].max(), [1, 0.25, 0])
axes.scatter(0.15 * slow.shape[0, :2] / slow.shape[0].max(), [1, 0.25], s=[120, 240], color=COLOURS[0], zorder=3)
axes.set(xlabel="distance from axis (m)", ylabel="depth (m)", ylim=(1.08, -0.05), xlim=(-0.35, 0.35))
plt.show()

# %%
# The upper weight is twice the lower one and sits a quarter of the way down. The picture shows the
# slower mode.
#
# The table has both conical heights in parts of half the thread, and the speeds.

print("upper/lower weight  upper weight at, m  conical heights/a  turns a second  ratio of periods")
for heavier, at in [(2, 0.25), (2, 0.75), (2, 0.5), (3, 0.5)]:
    heights = rc.two_links.two_plummets_from_the_middle(A, A - at, weight_ratio=1 / heavier)
    turns = rc.conical_pendulum.revolutions_per_second(heights)
    numbers = "{:.6f} {:.6f}   {:.4f} {:.4f}".format(*heights / A, *turns)
    print(f"{heavier:18}  {at:18.2f}  {numbers}  {turns[1] / turns[0]:16.4f}")

# %%
# On the left, four modes. C₁ is on the axis, where the line of the lower thread meets it: one
# conical height above the lowest weight. On the right, both conical heights for every place of the
# upper weight; dots are the four modes.

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
plt.show()

# %%
# To try next: weights in the ratio 100. In the middle of the thread the two heights come close to
# each other.
#
# Checked: ``tests/python/test_closed_forms.py``, with mpmath.
