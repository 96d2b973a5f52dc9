# SPDX-License-Identifier: GPL-3.0-or-later
"""What the pictures by matplotlib share. Plots take the style of the caller; `STYLE` is that of the documentation."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING, Any

import numpy as np

from ..systems.extras import require
from ..systems.numbers import Numbers, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

PALETTE = ("0072B2", "D55E00", "009E73", "CC79A7", "E69F00", "56B4E9", "000000")
"""Colours that can be told apart without seeing red or green (Okabe and Ito 2008)."""

STYLE: dict[Any, Any] = {
    "axes.titlesize": "medium",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": f"cycler(color={list(PALETTE)})",
    "legend.frameon": False,
    "savefig.dpi": 200,
    "svg.hashsalt": "revchain",
}
"""For `matplotlib.rcParams.update`: letters of 10 points, the smallest of 8.3, and the colours of `PALETTE`."""

WIDEST = 8.0  # inches, of a new figure
MOST_PINS_AS_DOTS = 40
MOST_POINTS = 2000  # per curve: about the pixels of a large picture


def new_figure(width: float, height: float) -> Figure:
    """A figure: pyplot's where the caller uses pyplot, so that it shows; else a free one."""
    free = require("matplotlib.figure", "plot", "plotting").Figure
    pyplot = sys.modules.get("matplotlib.pyplot")
    figure: Figure = (pyplot.figure if pyplot is not None else free)(figsize=(width, height), layout="constrained")
    return figure


def axes_or_new(ax: Axes | None, width: float, height: float) -> Axes:
    """The axes of the caller, or new ones on a figure of their own."""
    axes: Axes = new_figure(width, height).add_subplot() if ax is None else checked_axes(ax)
    return axes


def checked_axes(ax: Axes) -> Axes:
    """`ax`; a TypeError unless it is axes of matplotlib."""
    kind: type[Axes] = require("matplotlib.axes", "plot", "plotting").Axes
    if not isinstance(ax, kind):
        raise TypeError(f"plot: ax must be axes of matplotlib, got {shown(ax)}")
    return ax


def legend_outside(ax: Axes, **more: Any) -> None:
    """A legend to the right of the frame, where it covers no curve."""
    ax.legend(**{"loc": "upper left", "bbox_to_anchor": (1.02, 1.0), "borderaxespad": 0.0, "frameon": False, **more})


def plain(text: str) -> str:
    """`text` as matplotlib draws it letter by letter: what stands between two $ would be mathematics."""
    return text.replace("$", r"\$")


def thinned(curve: Numbers) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Indices of the points worth drawing: the ends, and the extremes of every stretch."""
    if curve.size <= MOST_POINTS:
        return np.arange(curve.size)
    edges = np.linspace(0, curve.size, MOST_POINTS // 2 + 1).astype(np.intp)
    kept = {0, curve.size - 1}
    for begin, end in zip(edges[:-1], edges[1:], strict=True):
        stretch = curve[begin:end]
        kept.update((int(begin + stretch.argmin()), int(begin + stretch.argmax())))
    return np.array(sorted(kept), dtype=np.intp)


def keep_room(ax: Axes, share: float = 0.35) -> None:
    """Widen a drawing in true proportions, all but flat or all but straight down, until it can be read."""
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    wide, tall = right - left, high - low
    if tall < share * wide:
        ax.set_ylim((low + high - share * wide) / 2, (low + high + share * wide) / 2)
    elif wide < share * tall:
        ax.set_xlim((left + right - share * tall) / 2, (left + right + share * tall) / 2)


def half_waves_style(waves: int, named: set[int]) -> tuple[str, str | None]:
    """Colour of a curve with so many half waves, and its label if none is in `named` yet, which grows by it."""
    label = None if waves in named else f"{waves} half wave{'s' * (waves != 1)}"
    named.add(waves)
    return f"C{(waves - 1) % 10}", label
