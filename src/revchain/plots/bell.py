# SPDX-License-Identifier: GPL-3.0-or-later
"""A bell, its clapper and its headstock at rest, by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..closed_forms.table import described
from .style import axes_or_new, legend_outside

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..closed_forms.bell import BellAndClapper


@described(bound=True)
def plot_bell(bell: BellAndClapper, ax: Axes | None = None) -> Axes:
    """Draw bell, clapper and headstock at rest, true to scale.

    returns: The drawing: the axle, the pin of the clapper, both centres of gravity, and the pendulum lengths beside
        them. The outline of the bell is only an illustration: the data do not define it.

    >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.05]}
    >>> rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.36])).plot().get_ylabel()
    'depth below axle (m)'
    """
    data = bell.present
    pin, h1, h2 = data["joint"], data["clapper_centroid"], data["bell_centroid"]
    l1, l2 = (h + data[f"{name}_radius_of_gyration"] ** 2 / h if h else np.inf for name, h in (("clapper", h1), ("bell", h2)))
    ball = float(bell.system.length[0])  # from the pin of the clapper to its ball
    lip = pin + 1.12 * ball
    crown = max(0.0, pin - 0.12 * ball)
    ax = axes_or_new(ax, 8.5, 5.0)

    down = np.linspace(0.0, 1.0, 60)
    wide = 0.62 * (lip - crown) * (np.minimum(1.0, (down / 0.12) ** 0.4) * (0.5 + 0.14 * down) + 0.36 * down**6)
    depth = crown + (lip - crown) * down
    ax.plot(np.concatenate([-wide[::-1], wide]), np.concatenate([depth[::-1], depth]), color="0.45", linewidth=2.5)
    half, top = 0.32 * (lip - crown), min(-0.06 * ball, crown - 0.18 * ball)
    ax.fill([-half, half, half, -half], [crown, crown, top, top], color="0.88", edgecolor="0.45", zorder=1)
    ax.text(1.1 * half, (crown + top) / 2, "headstock", color="0.35", va="center", fontsize="small")
    ax.plot([0.0, 0.0], [pin, pin + 1.08 * ball], color="C3", linewidth=2.2, zorder=3)
    ax.plot(0.0, pin + ball, marker="o", markersize=13.0, color="C3", zorder=3)
    marks = [
        (0.0, "axle", "^", "black"),
        (pin, "pin of the clapper", "o", "C3"),
        (h2, "centroid of the bell", "x", "0.3"),
        (pin + h1, "centroid of the clapper", "x", "C3"),
    ]
    for at, name, marker, colour in marks:
        ax.plot(0.0, at, marker=marker, linestyle="none", color=colour, markersize=8.0, label=name, zorder=4)
    side = -1.25 * wide[-1]
    for x, start, length, name, colour in (
        (side, 0.0, l2, "bell: $l_2$", "0.3"),
        (0.82 * side, pin, l1, "clapper: $l_1$", "C3"),
    ):
        if abs(length) > 3 * lip:  # too far to be drawn
            ax.plot([], [], color=colour, linewidth=1.2, label=f"pendulum length, {name} = {length:.4g} m")
            continue
        ax.plot([x, x], [start, start + length], color=colour, linewidth=1.2, marker="_", markersize=12.0)
        ax.annotate(name.split()[1], (x, start + length / 2), xytext=(5, 0), textcoords="offset points", color=colour)
    ax.set(xlabel="distance from axle (m)", ylabel="depth below axle (m)", title=f"Clapper / bell in the slower mode: {bell.inclination_ratio[0]:.3g}")
    ax.set_aspect("equal")
    ax.margins(0.1)
    if not ax.yaxis_inverted():
        ax.invert_yaxis()
    legend_outside(ax)
    return ax
