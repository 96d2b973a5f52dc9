# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a study."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..systems.numbers import word
from ..systems.units import SI
from .style import WIDEST, axes_or_new, legend_outside, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..studies.axes import Axis
    from ..studies.plan import Plan
    from ..studies.points import Block
    from ..studies.result import SweepResult

MAX_CURVES = 10
UNITS = {"speed": "rad/s", "height": "m", "inclination": "rad", "offset": "m", "tension": "N", "force": "N"}
BANDS = ((5, 95, 0.15), (25, 75, 0.3))  # percentiles, and how dark


def why_not_drawn(plan: Plan) -> str:
    """A sentence where a study has no picture; known before anything is computed."""
    grids = [axis for axis in plan.axes if axis.values is not None]
    if len(grids) > 2:
        return f"draws at most two grids, and there are {len(grids)}: {', '.join(axis.name for axis in grids)}"
    words = [axis.name for axis in grids if axis.values is not None and axis.values.dtype.kind not in "fi"]
    return f"draws numbers, not words, and {words[0]} is one" if words else ""


def plot_sweep(result: SweepResult, name: str | None, ax: Axes | None) -> Axes:
    """Curves over one grid, a map over two, with bands or medians of random numbers; histograms of these alone."""
    place, plan = "revchain.SweepResult.plot", result._plan
    blocks = {block.name: block for block in plan.blocks}
    name = next(iter(blocks)) if name is None else name
    word(place, "name", name, blocks)
    if reason := why_not_drawn(plan):
        raise ValueError(f"{place}: {reason}")
    block = blocks[name]
    grids = [axis for axis in plan.axes if axis.values is not None]
    random = len(grids) < len(plan.axes)
    values = result[name].astype(float).reshape(*plan.shape, -1)[..., :MAX_CURVES]
    ax = axes_or_new(ax, WIDEST, 4.8)
    if not grids:
        return _histograms(values, block, ax)
    ax.set_xlabel(_label_of_axis(grids[0]))
    if _is_log(grids[0]):
        ax.set_xscale("log")
    if len(grids) == 1:
        return _curves(grids[0], values, block, random, ax)
    ax.set_ylabel(_label_of_axis(grids[1]))
    if _is_log(grids[1]):
        ax.set_yscale("log")
    shown = np.median(values[..., 0], axis=-1) if random else values[..., 0]
    drawn = ax.pcolormesh(_numbers(grids[0]), _numbers(grids[1]), shown.T, shading="nearest")
    first = f", {block.along} {block.labels[0]}" if block.along else ""
    ax.figure.colorbar(drawn, ax=ax, label=f"{'median of ' if random else ''}{_label(block)}{first}")
    return ax


def _curves(axis: Axis, values: np.ndarray[Any, Any], block: Block, random: bool, ax: Axes) -> Axes:
    """A curve for each mode, or the median of random numbers with bands of percentiles."""
    at = _numbers(axis)
    for k, label in enumerate(_labels(block)):
        colour = f"C{k}"
        if random:
            for low, high, alpha in BANDS:
                ends = np.nanpercentile(values[..., k], [low, high], axis=1)
                ax.fill_between(at, *ends, color=colour, alpha=alpha, linewidth=0)
            ax.plot(at, np.nanmedian(values[..., k], axis=1), color=colour, label=label)
        else:
            ax.plot(at, values[:, k], color=colour, label=label)
    ax.set_ylabel(_label(block))
    if random:
        legend_outside(ax, title="median; 25 to 75 % and\n5 to 95 % of the points")
    elif values.shape[-1] > 1:
        legend_outside(ax)
    return ax


def _histograms(values: np.ndarray[Any, Any], block: Block, ax: Axes) -> Axes:
    """How each column scatters about its median."""
    for k, label in enumerate(_labels(block)):
        found = values[:, k][np.isfinite(values[:, k])]
        if found.size and (median := np.median(found)):
            low, high = np.percentile(found, [5, 95])
            text = f"{label}: median {median:.4g}\n5 to 95 %: {low:.4g} to {high:.4g}"
            bins = min(max(found.size // 100, 10), 50)
            ax.hist(100 * (found / median - 1), bins, density=True, histtype="step", color=f"C{k}", label=text)
    ax.set(xlabel=f"{_label(block)}, % above its median", ylabel="fraction of points per %")
    if ax.has_data():
        legend_outside(ax)
    return ax


def _labels(block: Block) -> list[str]:
    """Of the curves that are drawn of it."""
    return [f"{block.along} {label}" for label in block.labels[:MAX_CURVES]] if block.along else [block.name]


def _label(block: Block) -> str:
    """Name and unit."""
    unit = UNITS.get(block.name.rpartition("_")[2], "")
    return block.name.replace("_", " ") + (f" ({unit})" if unit else "")


def _label_of_axis(axis: Axis) -> str:
    """Name and unit of what varied."""
    unit = SI[axis.quantity][0] if axis.is_number and axis.path[-1] != "exponent" else ""
    return plain(axis.name) + (f" ({unit})" if unit else "")


def _numbers(axis: Axis) -> np.ndarray[Any, Any]:
    """Values of a grid."""
    assert axis.values is not None
    return axis.values


def _is_log(axis: Axis) -> bool:
    """Whether a grid goes in equal ratios."""
    values = _numbers(axis)
    if values.size < 3 or not (values > 0).all():
        return False
    ratios = values[1:] / values[:-1]
    return bool(ratios[0] != 1 and np.allclose(ratios, ratios[0], rtol=1e-6))
