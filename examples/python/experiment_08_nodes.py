# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment VIII: nodes of a whirling chain
==========================================

Where a whirling chain crosses its axis, and where it hangs vertically.

Checked: ``tests/python/test_cord_modes.py``, against mpmath and the numbers of the paper.
"""

import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, panels, save, side_view

LENGTH = 1.0  # m

links = rc.modes(rc.Chain.uniform_rods(400, length=LENGTH), count=4)
cord = rc.modes(rc.Cord(LENGTH), count=4)
print("chain of 1 m, distances from the free end in mm")
for k in range(2, 5):
    print(f"mode {k}, {cord.frequency[k - 1]:.4f} turns a second")
    print("  nodes               ", *(1000 * cord.nodes[k - 1]).round(1))
    print("  nodes of 400 links  ", *(1000 * links.nodes[k - 1]).round(1))
    print("  vertical there      ", *(1000 * cord.vertical_points[k - 1]).round(1))

height = cord.conical_height[3]
print("in conical heights, the same in every mode: nodes", *(cord.nodes[3] / height).round(4))
print("                                vertical points", *(cord.vertical_points[3] / height).round(4))

figure, axes = panels(4)
x = np.linspace(0, LENGTH, 400)
for k, panel in enumerate(axes):
    nodes, vertical = cord.nodes[k], cord.vertical_points[k]
    hang(panel, 0.15 * cord.offset(x)[k], LENGTH - x, color=COLOURS[k])
    panel.plot(0 * nodes, LENGTH - nodes, "o", color="black", markersize=4)
    panel.plot(0.15 * cord.offset(vertical)[k], LENGTH - vertical, "|", color="black", markersize=16)
    for node in nodes:
        panel.annotate(f"{1000 * node:.0f}", (0, LENGTH - node), xytext=(7, -3), textcoords="offset points")
    side_view(panel, f"mode {k + 1}\n{cord.frequency[k]:.2f} turns/s", bottom=1.04, top=0.04, half_width=0.2)
axes[0].set_ylabel("depth below the support (m)")
figure.suptitle("dots: nodes, mm from the free end; bars: the chain is vertical", fontsize=10)
save(figure, "experiment_08_nodes")
