# SPDX-License-Identifier: GPL-3.0-or-later
"""Helpers with which the example programs draw. They may change.

Importing this module gives all pictures the style of the documentation.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.transforms import ScaledTranslation

from .style import STYLE

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..results.branches import Branch
    from ..results.shapes import SteadyShape

matplotlib.rcParams.update(STYLE)
COLOURS: list[str] = matplotlib.rcParams["axes.prop_cycle"].by_key()["color"]


def panels(count: int, widths: Sequence[float] | None = None, height: float = 4.5) -> tuple[Figure, Any]:
    """A figure of pyplot with `count` panels side by side, 8 inches wide."""
    figure = plt.figure(figsize=(8, height), layout="constrained")
    return figure, figure.subplots(1, count, width_ratios=widths, squeeze=False)[0]


def hang(axes: Axes, offset: Any, depth: Any, *, weights: Iterable[float] = (), **line: Any) -> None:
    """Draw a chain given by offsets from the axis and depths below the support; `weights` are the sizes of dots."""
    (drawn,) = axes.plot(offset, depth, **line)
    for y, z, size in zip(offset, depth, weights, strict=False):
        axes.scatter(y, z, s=size, color=drawn.get_color(), alpha=drawn.get_alpha(), linewidth=0, zorder=3)


def whirling(axes: Axes, offset: Any, depth: Any, **line: Any) -> None:
    """Draw a chain that whirls, seen from the side at seven moments of half a turn."""
    for view in np.cos(np.linspace(np.pi, 0, 7)):
        axes.plot(view * np.asarray(offset), depth, **{"color": "C0", "linewidth": 2.5, "alpha": 1.0 if view == 1 else 0.2, **line})


def picture() -> tuple[Figure, Axes]:
    """Return a small figure of pyplot, and its axes, for a drawing of one object."""
    return plt.subplots(figsize=(4.8, 3.4), layout="constrained")


def side_view(axes: Axes, title: str, *, bottom: float, top: float = 0.05, half_width: float) -> None:
    """True proportions, the vertical axis dash-dotted, metres below the support."""
    axes.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
    axes.set(title=title, xlabel="distance from axis (m)", xlim=(-half_width, half_width), ylim=(bottom, -top))
    axes.set_aspect("equal")


def branch_of(shape: SteadyShape, branches: Iterable[Branch]) -> int:
    """Number of the branch with the point nearest to a shape."""
    apart = [
        np.hypot(branch.angular_speed / shape.angular_speed - 1, branch.lowest_inclination - shape.inclination[0]).min()
        for branch in branches
    ]
    return int(np.argmin(apart))


def legend_below(axes: Axes, **more: Any) -> None:
    """A legend under the frame and the label."""
    down = axes.transAxes + ScaledTranslation(0, -0.55, axes.figure.dpi_scale_trans)  # inches
    axes.legend(**{"loc": "upper center", "bbox_to_anchor": (0.5, 0), "bbox_transform": down, "ncols": 2, **more})


def save(figure: Figure, name: str) -> None:
    """Write the picture as an .svg file into the current folder."""
    figure.savefig(f"{name}.svg", metadata={"Date": None})  # the same picture gives the same file
    print(f"wrote {name}.svg")
