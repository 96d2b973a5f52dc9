# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment I: a whirling chain seen from the side
=================================================

A chain that whirls, seen from the side, seems to swing: two weights on a thread, and a watch chain.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, panels, picture, side_view, whirling

THREAD = 0.5  # m, each of two, with equal weights
CHAIN = 0.36  # m

weights = rc.modes(rc.Chain.uniform_plummets(2, length=2 * THREAD))
links = rc.modes(rc.Chain.uniform_rods(120, length=CHAIN), count=2)

figure, axes = picture()
whirling(axes, 0.15 * weights.shape[1], [2 * THREAD, THREAD, 0], marker="o", markersize=12)
axes.set(xlabel="distance from axis (m)", ylabel="depth (m)", ylim=(1.1, -0.05))
plt.show()

# %%
# Two weights on a thread of 1 m turn about the vertical. The picture is a view from the side at
# seven moments of half a turn: the second mode, in which the weights are on opposite sides of the
# axis.
#
# The table has the speeds, as a stopwatch gives them, and the ratio of the two offsets.

print("                      mode  turns a second  10 turns, s  lower/upper offset")
for k in range(2):
    turns = weights.frequency[k]
    ratio = weights.shape[k, 0] / weights.shape[k, 1]
    print(f"two weights, 2 x 0.5 m   {k + 1}          {turns:.4f}        {10 / turns:5.2f}             {ratio:+.4f}")
for k, turns in enumerate(links.frequency):
    print(f"watch chain, 0.36 m      {k + 1}          {turns:.4f}        {10 / turns:5.2f}")

# %%
# Both modes of the two weights and the two slowest modes of the chain, each with its axis
# dash-dotted. The offsets are small in the experiment and drawn larger here.

figure, axes = panels(4)
views = np.cos(np.linspace(0, np.pi, 7))  # the same figure, seen from the side, at seven moments of half a turn
for number, (name, result, height) in enumerate([("two weights", weights, 2 * THREAD), ("chain", links, CHAIN)]):
    depth = height - np.concatenate([[0], np.cumsum(result.system.length)])
    dots = [40, 40] if name == "two weights" else []
    for k in range(2):
        panel = axes[2 * number + k]
        tip = 0.15 * height
        for view in views:
            shape = tip * view * result.shape[k]
            hang(panel, shape, depth, weights=dots, color=COLOURS[k], alpha=1 if view == 1 else 0.3)
        turns = result.frequency[k]
        title = f"{name}, mode {k + 1}\n{turns:.2f} turns/s"
        side_view(panel, title, bottom=1.06 * height, top=0.05 * height, half_width=0.22 * height)
        panel.locator_params(axis="x", nbins=3)
axes[0].set_ylabel("depth below the support (m)")
figure.suptitle("Whirling chains seen from the side at seven moments of half a turn", fontsize=10)
plt.show()

# %%
# To try next: unequal weights, ``rc.Chain(mass=[1, 2], length=[0.5, 0.5])``.
#
# Checked: ``tests/python/test_modes.py``, against heights in 50 digits.
