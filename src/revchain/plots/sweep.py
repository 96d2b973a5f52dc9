# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of a study."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..systems.numbers import word
from .style import axes_or_new, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..studies.find import Block
    from ..studies.plan import Plan
    from ..studies.result import SweepResult

MOST_CURVES = 10


def why_not_drawn(plan: Plan) -> str:
    """A sentence where a study has no picture; known before anything is computed."""
    names = [axis.name for axis in plan.axes]
    if len(names) > 2 and plan.shape != (plan.samples,):
        return f"draws one or two numbers, or random ones only, and {len(names)} vary: {', '.join(names)}"
    words = [axis.name for axis in plan.axes if axis.values is not None and axis.values.dtype.kind not in "fi"]
    return f"draws numbers, not words, and {words[0]} is one" if words else ""


def plot_sweep(result: SweepResult, name: str | None, ax: Axes | None) -> Axes:
    """Curves over one number, dots over a random one, a map over two grids, a histogram of more random ones."""
    place = "revchain.SweepResult.plot"
    blocks = {block.name: block for block in result._plan.blocks}
    name = next(iter(blocks)) if name is None else name
    word(place, "name", name, blocks)
    axes = result._plan.axes
    if reason := why_not_drawn(result._plan):
        raise ValueError(f"{place}: {reason}")
    values = result[name].reshape(len(result), -1).astype(float)
    ax = axes_or_new(ax, 6.4, 4.8)
    if len(axes) > 2:
        return _histogram(values, _labels(blocks[name]), name, ax)
    one = axes[0]
    ax.set_xlabel(plain(one.name))
    if _log(one.values):
        ax.set_xscale("log")
    if len(axes) == 1:
        mark = "." if one.values is None else "-"
        for k, label in enumerate(_labels(blocks[name])):
            ax.plot(result[one.name], values[:, k], mark, label=label)
        ax.set_ylabel(name.replace("_", " "))
        if values.shape[1] > 1:
            ax.legend()
        return ax
    two = axes[1]
    ax.set_ylabel(plain(two.name))
    if _log(two.values):
        ax.set_yscale("log")
    drawn: Any
    if one.values is not None and two.values is not None:
        drawn = ax.pcolormesh(one.values, two.values, values[:, 0].reshape(result.shape).T, shading="nearest")
    else:
        drawn = ax.scatter(result[one.name], result[two.name], c=values[:, 0], s=6)
    first = f"{name.replace('_', ' ')}, {_labels(blocks[name])[0]}" if blocks[name].along else name
    ax.figure.colorbar(drawn, ax=ax, label=first)
    return ax


def _labels(block: Block) -> list[str]:
    """Of the curves that are drawn of it."""
    return [f"{block.along} {label}" for label in block.labels[:MOST_CURVES]] if block.along else [block.name]


def _histogram(values: np.ndarray, labels: list[str], name: str, ax: Axes) -> Axes:
    """How each column scatters about its mean."""
    for column, label in zip(values.T, labels, strict=False):
        found = column[np.isfinite(column)]
        if found.size and (mean := found.mean()):
            deviation = 100 * (found / mean - 1)
            bins = min(max(found.size // 100, 10), 120)
            ax.hist(deviation, bins, density=True, histtype="step", label=f"{label}, mean {mean:.4g}")
    ax.set(xlabel=f"{name.replace('_', ' ')}, % from its mean", ylabel="share of the points, 1/%")
    if ax.has_data():
        ax.legend()
    return ax


def _log(values: np.ndarray | None) -> bool:
    """Whether a grid goes in equal ratios."""
    if values is None or values.size < 3 or not (values > 0).all():
        return False
    ratios = values[1:] / values[:-1]
    return bool(ratios[0] != 1 and np.allclose(ratios, ratios[0], rtol=1e-6))
