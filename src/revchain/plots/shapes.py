# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of steady shapes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..closed_forms.table import described
from .modes import beside_at_rest
from .style import MOST_PINS_AS_DOTS, half_waves_style, keep_room, legend_outside, thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..results.shapes import SteadyShape, SteadyShapes


def _fitting_height(shapes: Sequence[SteadyShape]) -> float:
    """Inches of a figure for curves of these proportions, some 5 inches wide at most."""
    wide = max((np.ptp([0.0, *shape.offset]) for shape in shapes), default=0.0)
    tall = max((np.ptp([0.0, *shape.height]) for shape in shapes), default=1.0)
    return float(np.clip(1.2 + 5.0 * tall / wide, 3.4, 6.0)) if wide else 6.0


@described(bound=True)
def plot_shape(shape: SteadyShape, ax: Axes | None = None) -> Axes:
    """Draw the shape, true to scale.

    >>> ax = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=1.0), conical_height=0.05)[0].plot()
    >>> ax.get_xlabel()
    'distance from axis (m)'
    """
    return _curves([shape], ax)


@described(bound=True)
def plot_shapes(shapes: SteadyShapes, ax: Axes | None = None) -> Axes:
    """Draw all shapes in one picture, true to scale, coloured by half waves.

    >>> ax = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=1.0), conical_height=0.02).plot()
    >>> ax.get_title()
    '5 hanging shapes, proved complete'
    """
    ax = _curves(shapes, ax)
    ax.set_title(shapes._how_many())
    return ax


def _curves(shapes: Sequence[SteadyShape], ax: Axes | None) -> Axes:
    """A curve for each shape; dots mark the pins of links, of cords the free end."""
    ax = beside_at_rest(shapes[0].system if len(shapes) else None, ax, 6.2, _fitting_height(shapes))
    ax.axvline(0.0, color="0.6", linestyle="-.", linewidth=0.9, zorder=1)
    named: set[int] = set()
    origin = "support"
    for shape in shapes:
        x, z = shape.offset, shape.height
        colour, label = half_waves_style(shape.half_waves, named)
        linked = not hasattr(shape, "arc_length")
        marker = "o" if linked and x.size <= MOST_PINS_AS_DOTS else ""
        kept = thinned(x) if linked else slice(None)
        ax.plot(x[kept], z[kept], color=colour, linewidth=1.4, marker=marker, markersize=3.0, label=label)
        if hasattr(shape, "span"):
            origin = "lower end"
            ax.plot(x[[0, -1]], [0.0, shape.span], color="black", marker="o", linestyle="none", markersize=6.0)
        elif not linked:
            ax.plot(x[0], z[0], color=colour, marker="o", markersize=3.5)
    if origin == "support":
        for top in sorted({float(shape.offset[-1]) for shape in shapes} or {0.0}):
            if top:
                ax.plot([0.0, top], [0.0, 0.0], color="0.3", linewidth=1.0, zorder=1)
            ax.plot(top, 0.0, marker="v", color="black", markersize=7.0, clip_on=False)
    ax.set(xlabel="distance from axis (m)", ylabel=f"height above the {origin} (m)", aspect="equal")
    keep_room(ax)
    if named:
        legend_outside(ax)
    return ax
