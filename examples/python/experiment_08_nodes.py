# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment VIII: where a whirling chain crosses its axis, and where it hangs vertically.

python experiment_08_nodes.py [FOLDER]
"""

import numpy as np
from _picture import COLOURS, hang, panels, save, side_view

import revchain as rc

LENGTH = 1.0  # m

links = rc.modes(rc.Chain.uniform_rods(400, length=LENGTH), count=4)
turns = rc.heavy_chain.revolutions_per_second(4, LENGTH)
print("chain of 1 m, distances from the free end in mm")
for k in range(2, 5):
    print(f"mode {k}, {turns[k - 1]:.4f} turns a second")
    print("  nodes               ", *(1000 * rc.heavy_chain.nodes(k, LENGTH)).round(1))
    print("  nodes of 400 links  ", *(1000 * links.nodes[k - 1]).round(1))
    print("  vertical there      ", *(1000 * rc.heavy_chain.vertical_points(k, LENGTH)).round(1))

heights = rc.heavy_chain.conical_heights(4, LENGTH)
nodes, vertical = rc.heavy_chain.nodes(4, LENGTH), rc.heavy_chain.vertical_points(4, LENGTH)
print("in conical heights, the same in every mode: nodes", *(nodes / heights[3]).round(4))
print("                                vertical points", *(vertical / heights[3]).round(4))

figure, axes = panels(4)
x = np.linspace(0, LENGTH, 400)
for k, panel in enumerate(axes, start=1):
    hang(panel, 0.15 * rc.heavy_chain.shape(x, k, LENGTH), LENGTH - x, color=COLOURS[k - 1])
    nodes, vertical = rc.heavy_chain.nodes(k, LENGTH), rc.heavy_chain.vertical_points(k, LENGTH)
    panel.plot(0 * nodes, LENGTH - nodes, "o", color="black", markersize=4)
    at = 0.15 * rc.heavy_chain.shape(vertical, k, LENGTH)
    panel.plot(at, LENGTH - vertical, "|", color="black", markersize=16)
    for node in nodes:
        panel.annotate(f"{1000 * node:.0f}", (0, LENGTH - node), xytext=(7, -3), textcoords="offset points")
    side_view(panel, f"mode {k}\n{turns[k - 1]:.2f} turns/s", bottom=1.04, top=0.04, half_width=0.2)
axes[0].set_ylabel("below the support, m")
figure.suptitle("dots: nodes, mm from the free end; bars: the chain is vertical", fontsize=10)
save(figure)
