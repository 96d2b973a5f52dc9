# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment V: Thomson's four cases of two weights on a thread
=============================================================

Two weights on one thread, the upper one at different places: Thomson's four cases of Greenhill's Fig. 4.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, panels, picture, whirling

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
# Both conical heights for every place of the upper weight. In the middle of the thread they are
# closest. A heavier upper weight brings them closer still. Dots are Thomson's four cases.

figure, (axes,) = panels(1, height=4)
at = np.linspace(0.01, 0.99, 197) * THREAD
for k, outwards in enumerate([1, -1]):  # above and below 1, the mean of both heights
    for heavier, strength, side in [(2, 1.0, outwards), (3, 0.6, -outwards), (20, 0.35, -outwards)]:
        heights = rc.two_links.two_plummets_from_the_middle(A, A - at, weight_ratio=1 / heavier)[:, k] / A
        axes.plot(at, heights, color=COLOURS[k], alpha=strength, linewidth=2.5)
        text = f"{heavier} times as heavy"
        axes.text(A, heights[98] + 0.08 * side, text, color=COLOURS[k], ha="center", va="center")
    axes.plot([0.25, 0.75], 2 * [1 + outwards * 0.5**0.5], "o", color="black", markersize=7, zorder=3)
    axes.text(0.01, 1 + 0.5 * outwards, ["slower mode", "faster mode"][k], color=COLOURS[k], va="center")
axes.set(xlabel="depth of the upper weight below the support (m)", ylabel="conical height / half the thread")
axes.set(ylim=(0, 2), title="the upper weight 2, 3 and 20 times as heavy as the lower one")
plt.show()

# %%
# Thomson's four cases. C₁ is on the axis, where the line of the lower thread meets it: one
# conical height above the lowest weight. Two threads that whirl at the same speed have it at the
# same depth.

figure, axes = panels(2)
for k, panel in enumerate(axes):
    for axis, at in [(0, 0.25), (1, 0.75)]:
        result = rc.modes(rc.Chain(weight=[1, 2], length=[THREAD - at, at]))
        shape = axis + 0.35 * result.shape[k] / np.abs(result.shape[k]).max()
        level = THREAD - result.conical_height[k]
        panel.axvline(axis, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
        panel.plot([shape[0], axis], [THREAD, level], "--", color="0.5", zorder=1)
        hang(panel, shape, [THREAD, at, 0], weights=[120, 240], color=COLOURS[k], linewidth=2.5)
        panel.plot(axis, level, "o", color="black", markersize=6, zorder=4)
    panel.axhline(level, color="black", linewidth=0.8, linestyle=":")
    panel.text(0.5, level - 0.01, ["C₁: extended\nlower thread\nmeets the axis", "C₁"][k], ha="center", va="bottom")
    name = ["slower", "faster"][k]
    panel.set(title=f"{name} mode: {result.frequency[k]:.2f} turns/s", xlim=(-0.5, 1.5), ylim=(1.06, -0.03))
    panel.set_xticks([0, 1], ["double weight\na quarter down", "double weight\nthree quarters down"])
axes[0].set_ylabel("depth below the support (m)")
axes[0].text(0.62, 0.5, "dashed:\nextension", color="0.4", ha="center")
plt.show()

# %%
# To try next: weights in the ratio 100. In the middle of the thread the two heights come close to
# each other.
#
# Checked: ``tests/python/test_closed_forms.py``, with mpmath.
