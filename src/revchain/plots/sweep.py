# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the results of a sweep: curves, maps and histograms."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..systems.numbers import Floats, word
from .style import WIDEST, SpeedUnit, axes_or_new, house, legend_outside, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from xarray import DataArray, Dataset

    from ..studies.plan import Plan

MAX_CURVES = 10
BANDS = ((5, 95, 0.15), (25, 75, 0.3))  # percentiles, and how dark


def why_not_drawn(plan: Plan) -> str:
    """A sentence if a study has no picture; known before anything is computed."""
    grids = [axis for axis in plan.axes if axis.values is not None]
    return _reason({axis.name: axis.values.dtype.kind for axis in grids if axis.values is not None})


def _reason(kinds: dict[str, str]) -> str:
    """The reason why grids of these names and kinds of values are not drawn."""
    if len(kinds) > 2:
        return f"draws at most two grids, and there are {len(kinds)}: {', '.join(kinds)}"
    words = [name for name, kind in kinds.items() if kind not in "fi"]
    return f"draws numbers, not words, and {words[0]} is one" if words else ""


def plot_sweep(found: Dataset, name: str | None = None, ax: Axes | None = None, *, speed: str | None = None) -> Axes:
    """Draw a result of `revchain.sweep` against the varied numbers.

    One grid gives curves, two grids give a map of the first mode, and random numbers give histograms. With random numbers
    one grid gives percentile bands, and two grids give a map of medians.

    Parameters
    ----------
    found : xarray.Dataset
        The results.
    name : str, optional
        Name of the result; the first one if left out.
    ax : matplotlib.axes.Axes, optional
        Axes to draw in; a new figure if left out.
    speed : {"rad/s", "rpm", "Hz", "s"}, optional
        Unit of speeds on the axes; ``"s"`` draws periods. If left out, that of the scene, or rad/s.

    Returns
    -------
    matplotlib.axes.Axes
        The drawing.

    Raises
    ------
    ValueError
        If there are more than two grids, words are varied, `name` is not that of a result, or `speed` is another unit.

    Examples
    --------
    >>> import revchain as rc
    >>> from revchain.plots.sweep import plot_sweep
    >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
    >>> found = rc.sweep({"scene": scene, "vary": {"links[0].length": {"from": 1, "to": 2, "steps": 5}}})
    >>> plot_sweep(found).get_xlabel()
    'links[0].length (m)'
    """
    found = in_speed_unit(found, found.attrs.get("speed_unit") if speed is None else SpeedUnit("revchain.plot_sweep", speed).unit)
    points = found["status"].dims
    results = [
        str(key)
        for key, array in found.data_vars.items()
        if "path" not in array.attrs and key != "status" and set(points) <= set(array.dims)
    ]
    name = word("revchain.plot_sweep", "name", results[0] if name is None else name, results)
    grids = [found[key] for key in points if key in found.coords]
    if reason := _reason({str(grid.name): grid.dtype.kind for grid in grids}):
        raise ValueError(f"revchain.plot_sweep: {reason}")
    random, result = len(grids) < len(points), found[name]
    values = result.to_numpy().astype(float).reshape(*(found.sizes[key] for key in points), -1)[..., :MAX_CURVES]
    ax = axes_or_new(ax, WIDEST, 4.8)
    if not grids:
        speed = name.removeprefix("forward_")  # the proved ends of a speed, or of a period, are named after it
        ends = [f"lowest_{speed}", f"highest_{speed}"]
        proved = [found[end].to_numpy() for end in ends if {*ends} <= {*found.data_vars}]
        return _histograms(values, result, ax, proved)
    ax.set_xlabel(_label(grids[0]))
    if _is_log(grids[0]):
        ax.set_xscale("log")
    if len(grids) == 1:
        return _curves(grids[0], values, result, random, ax)
    ax.set_ylabel(_label(grids[1]))
    if _is_log(grids[1]):
        ax.set_yscale("log")
    shown = np.median(values[..., 0], axis=-1) if random else values[..., 0]
    drawn = ax.pcolormesh(grids[0].to_numpy(), grids[1].to_numpy(), shown.T, shading="nearest")
    first = "" if len(result.dims) == len(points) else f", {_curve_labels(result)[0]}"
    ax.figure.colorbar(drawn, ax=ax, label=f"{'median of ' if random else ''}{_label(result)}{first}")
    return ax


def in_speed_unit(found: Dataset, unit: str | None) -> Dataset:
    """The results with their speeds in a unit of `units.SPEED_UNITS`; unchanged for None and rad/s."""
    if unit in (None, "rad/s"):
        return found
    speeds = [key for key, array in found.variables.items() if array.attrs.get("units") == "rad/s"]
    said, changed = SpeedUnit("revchain.plot_sweep", unit), {}
    for key in speeds:
        array = found[key]
        changed[key] = array.copy(data=said.of(array.to_numpy())).assign_attrs(units=unit)
    return found.assign({key: array for key, array in changed.items() if key not in found.coords}).assign_coords(
        {key: (array.dims, array.to_numpy(), array.attrs) for key, array in changed.items() if key in found.coords}
    )


def _curves(grid: DataArray, values: Floats, result: DataArray, random: bool, ax: Axes) -> Axes:
    """A curve for each mode, or the median of random numbers with bands of percentiles."""
    at = grid.to_numpy()
    for k, label in enumerate(_curve_labels(result)):
        colour = house(k)
        if random:
            for low, high, alpha in BANDS:
                ends = np.nanpercentile(values[..., k], [low, high], axis=1)
                ax.fill_between(at, *ends, color=colour, alpha=alpha, linewidth=0)
            ax.plot(at, np.nanmedian(values[..., k], axis=1), color=colour, label=label)
        else:
            ax.plot(at, values[:, k], color=colour, label=label)
    ax.set_ylabel(_label(result))
    if random:
        legend_outside(ax, title="median; 25 to 75 % and\n5 to 95 % of the points")
    elif values.shape[-1] > 1:
        legend_outside(ax)
    return ax


def _histograms(values: Floats, result: DataArray, ax: Axes, ends: Sequence[Floats] = ()) -> Axes:
    """How each column scatters about its median; dotted lines at its proved ends."""
    for k, label in enumerate(_curve_labels(result)):
        found = values[:, k][np.isfinite(values[:, k])]
        if found.size and (median := np.median(found)):
            low, high = np.percentile(found, [5, 95])
            text = f"{label}: median {median:.4g}\n5 to 95 %: {low:.4g} to {high:.4g}"
            bins = min(max(found.size // 100, 10), 50)
            ax.hist(100 * (found / median - 1), bins, density=True, histtype="step", color=house(k), label=text)
            for end in ends:
                ax.axvline(100 * (end[k] / median - 1), color=house(k), linestyle=":")
    if ends:
        ax.plot([], [], ":", color="0.3", label="guaranteed worst case")
    ax.set(xlabel=f"{_label(result)}, % above its median", ylabel="fraction of points per %")
    if ax.has_data():
        legend_outside(ax)
    return ax


def _curve_labels(result: DataArray) -> list[str]:
    """The labels of the curves of a result, such as ``mode 1``."""
    along = next((key for key in result.dims if key in result.coords and "path" not in result[key].attrs), None)
    if along is None:
        return [str(result.name)]
    words = str(along).replace("_", " ")
    return [f"{words} {label}" for label in result[along].to_numpy()[:MAX_CURVES]]


def _label(array: DataArray) -> str:
    """The name and the unit of a result or of a varied number."""
    name = plain(str(array.name)) if "path" in array.attrs else str(array.name).replace("_", " ")
    if array.attrs.get("units") == "s":
        name = name.replace("angular speed", "period").replace("angular_speed", "period")
    return name + (f" ({array.attrs['units']})" if "units" in array.attrs else "")


def _is_log(grid: DataArray) -> bool:
    """Return whether the values of a grid have equal ratios."""
    values = grid.to_numpy()
    if values.size < 3 or not (values > 0).all():
        return False
    ratios = values[1:] / values[:-1]
    return bool(ratios[0] != 1 and np.allclose(ratios, ratios[0], rtol=1e-6))
