# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment VIII: nodes of a whirling chain
==========================================

Where does a whirling chain cross its axis, and where does it hang vertically?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, panels, picture, side_view, whirling

LENGTH = 1.0  # m

links = rc.modes(rc.Chain.uniform_rods(400, length=LENGTH), count=4)
cord = rc.modes(rc.Cord(LENGTH), count=4)
x = np.linspace(0, LENGTH, 400)
figure, axes = picture()
whirling(axes, cord.along(x)[2], LENGTH - x, color=COLOURS[2])
axes.plot(0 * cord.nodes[2], LENGTH - cord.nodes[2], "o", color="black", markersize=9)
axes.set(xlabel="offset, that of the free end = 1", ylabel="depth (m)", ylim=(1.04, -0.03))
plt.show()

# %%
# The third mode, seen from the side at seven moments of half a turn. Dots are the nodes: points of
# the chain that stay on the axis. If you touch the whirling chain there, it keeps whirling.
#
# The table compares a continuous chain with 400 links.

print("chain of 1 m, distances from the free end in mm")
for k in range(2, 5):
    print(f"mode {k}, {cord.frequency[k - 1]:.4f} turns a second")
    print("  nodes               ", *(1000 * cord.nodes[k - 1]).round(1))
    print("  nodes of 400 links  ", *(1000 * links.nodes[k - 1]).round(1))
    print("  vertical there      ", *(1000 * cord.vertical_points[k - 1]).round(1))

height = cord.conical_height[3]
print("in conical heights, the same in every mode: nodes", *(cord.nodes[3] / height).round(4))
print("                                vertical points", *(cord.vertical_points[3] / height).round(4))

# %%
# Four modes with their nodes.

figure, axes = panels(4)
for k, panel in enumerate(axes):
    nodes, vertical = cord.nodes[k], cord.vertical_points[k]
    hang(panel, 0.15 * cord.along(x)[k], LENGTH - x, color=COLOURS[k])
    panel.plot(0 * nodes, LENGTH - nodes, "o", color="black", markersize=4)
    panel.plot(0.15 * cord.along(vertical)[k], LENGTH - vertical, "|", color="black", markersize=16)
    for node in nodes:
        panel.annotate(f"{1000 * node:.0f}", (0, LENGTH - node), xytext=(7, -3), textcoords="offset points")
    side_view(panel, f"mode {k + 1}\n{cord.frequency[k]:.2f} turns/s", bottom=1.04, top=0.04, half_width=0.2)
axes[0].set_ylabel("depth below the support (m)")
figure.suptitle("dots: nodes, mm from the free end; bars: the chain is vertical", fontsize=10)
plt.show()

# %%
# To try next: a weight at the free end, ``rc.Cord(1.0, mass=1.0, tip_mass=1.0)``, which moves the
# lowest node towards it.
#
# Checked: ``tests/python/test_cord_modes.py``, against mpmath and the numbers of the paper.
