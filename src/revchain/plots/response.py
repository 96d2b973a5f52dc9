# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of forced responses and of small oscillations."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..closed_forms.table import described
from ..systems.numbers import Floats, boolean, integer, listed, word
from .modes import Straight, beside_at_rest, plot_carried
from .style import MOST_PINS_AS_DOTS, legend_outside, thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..results.motions import Response, Swing

MOST_CURVES = 4  # of pins, unless asked
MOST_MOMENTS = 9  # in a picture of shapes


@described(bound=True)
def plot_response(
    found: Response, ax: Axes | None = None, pins: Iterable[int] | None = None, *, resonances: bool = True
) -> Axes:
    """Draw the distances of pins from the axis against the speed, on a logarithmic scale.

    A line is dashed if the pin is on the side opposite to the support; vertical lines mark the resonances.
    A response at one speed is drawn as a shape: the offsets of the pins against their depths.

    pins: Numbers of the pins to draw. If left out: the lowest and up to three others, evenly spaced; all at a
        single speed.
    resonances: Whether to mark the whirl speeds in the range of the plot; a `Rig` has no marks.
    raises: If `pins` has a pin that is not in this result, or the result has no speed.

    >>> import numpy as np
    >>> chain = rc.Chain.uniform_rods(20, length=0.36)
    >>> ax = rc.response(chain, angular_speed=np.linspace(1.0, 30.0, 400)).plot()
    >>> ax.get_xlabel()
    'angular speed (rad/s)'
    """
    speed = found.angular_speed.reshape(-1)
    available = np.atleast_1d(found.pins).tolist()
    if speed.size == 0:
        raise ValueError("Response.plot: the response has no speed to draw; it needs at least one")
    if speed.size == 1:
        return plot_carried(found, ax, available if pins is None else _known(pins, available))
    order = np.argsort(speed)
    speed = speed[order]
    offset = found.offset.reshape(speed.size, -1)[order]
    chosen = _spread(available, found.system.size) if pins is None else _known(pins, available)
    ax = beside_at_rest(found.system, ax, 7.0, 4.5)
    for number, pin in enumerate(chosen):
        y = offset[:, available.index(pin)]
        name = "free end" if pin == 0 else f"pin {pin}"
        size = np.abs(y)
        for side, style in ((1, "-"), (-1, "--")):
            ax.plot(
                speed,
                np.where(_with_neighbours(np.sign(y) == side), size, np.nan),
                style,
                color=f"C{number % 10}",
                linewidth=1.4,
                label=name if side == 1 else None,
            )
    ax.axhline(found.support_radius, color="0.6", linewidth=0.8, zorder=0)
    for at in found.whirl_speeds if boolean("Response.plot", "resonances", resonances) else ():
        ax.axvline(at, color="0.6", linestyle="-.", linewidth=0.9, zorder=0)
    ax.set_yscale("log")
    finite = np.abs(offset[np.isfinite(offset) & (offset != 0)])
    if finite.size:
        top = finite.max()
        ax.set_ylim(max(finite.min(), 1e-6 * min(top, found.support_radius)) / 2, 2 * top)
    ax.set(xlabel="angular speed (rad/s)", ylabel="distance from axis (m); grey: support")
    ax.plot([], [], "--", color="0.3", linewidth=1.4, label="opposite to\nthe support")
    legend_outside(ax)
    return ax


def _with_neighbours(yes: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Also the next place: curves then meet where a pin crosses the axis or the chain a resonance."""
    wide = yes.copy()
    wide[1:] |= yes[:-1]
    return wide


def _spread(available: list[int], links: int) -> list[int]:
    """The lowest pins, and some more evenly up the chain; not the support."""
    free = [pin for pin in sorted(set(available)) if pin < links] or available
    places = np.linspace(0, len(free), min(MOST_CURVES, len(free)), endpoint=False).astype(int)
    return [free[place] for place in places]


def _known(pins: Iterable[int], available: list[int]) -> list[int]:
    numbers = [integer("Response.plot", "pins", pin) for pin in listed("Response.plot", "pins", pins)]
    for number in numbers:
        if number not in available:
            raise ValueError(f"Response.plot: pins must be among those of this result, got {number}")
    return numbers


@described(bound=True)
def plot_swing(
    found: Swing, ax: Axes | None = None, *, kind: str | None = None, pins: Iterable[int] = (0,)
) -> Axes:
    """Draw the system at the given times, the offsets of pins against time, or their paths seen from above.

    kind: ``"shapes"``: shapes from dark (early) to light (late), with enlarged offsets, at most nine; the usual one
        of a swing in a plane. ``"time"``: offsets against time, with momentum those along y dashed. ``"path"``:
        paths seen from above; the usual one, and only, with momentum.
    pins: For ``"time"`` and ``"path"``: numbers of the pins, 0 for the free end; for a cord, indices in
        `arc_length`.
    raises: If `kind` is another word, or there is no such pin.

    >>> import numpy as np
    >>> chain = rc.Chain.uniform_plummets(10, length=1.0)
    >>> plucked = np.interp(np.arange(11), [0, 5, 10], [0.0, 0.05, 0.0])
    >>> ax = rc.swing(chain, np.linspace(0, 4, 300), offset=plucked).plot(kind="time", pins=[0, 5])
    >>> ax.get_xlabel()
    'time (s)'
    """
    place, system, cord = "Swing.plot", found.system, found.arc_length is not None
    if found.offset.dtype.kind == "c":
        word(place, "kind", "path" if kind is None else kind, ("path", "time"))
        return _plot_turning(found, ax, "path" if kind is None else kind, _pins_of(place, "pins", pins, found.offset.shape[1]))
    word(place, "kind", "shapes" if kind is None else kind, ("shapes", "time"))
    depth = system.length - found.arc_length if cord else Straight(system).level
    chosen = _pins_of(place, "pins", pins, depth.size)
    return _plot_plane(found, ax, "shapes" if kind is None else kind, chosen, depth)


def _plot_turning(found: Swing, ax: Axes | None, kind: str, chosen: list[int]) -> Axes:
    """Paths of pins seen from above, or their offsets against time."""
    ax = beside_at_rest(found.system, ax, *((7.0, 4.0) if kind == "time" else (5.0, 5.0)))
    order = np.argsort(found.time)
    for number, column in enumerate(chosen):
        at = found.offset[order, column]
        kept = thinned(np.abs(at))
        style: dict[str, Any] = {"color": f"C{number % 10}", "linewidth": 1.2}
        name = "free end" if column == 0 else f"pin {column}"
        if kind == "path":
            ax.plot(at.real[kept], at.imag[kept], label=name, **style)
        else:
            ax.plot(found.time[order][kept], at.real[kept], label=name, **style)
            ax.plot(found.time[order][kept], at.imag[kept], linestyle="--", **style)
    if kind == "path":
        ax.set_aspect("equal")
        ax.plot(0.0, 0.0, marker="+", color="0.4", zorder=0)
        ax.set(xlabel="x (m)", ylabel="y (m)")
    else:
        ax.set(xlabel="time (s)", ylabel="offset (m): x solid, y dashed")
    if chosen:
        legend_outside(ax)
    return ax


def _pins_of(place: str, what: str, which: Iterable[int], count: int) -> list[int]:
    chosen = [integer(place, what, number) for number in listed(place, what, which)]
    for number in chosen:
        if not 0 <= number < count:
            raise ValueError(f"{place}: {what} must be numbers from 0 to {count - 1}, got {number}")
    return chosen


def _plot_plane(found: Swing, ax: Axes | None, kind: str, chosen: list[int], depth: Floats) -> Axes:
    """Offsets of pins or places, at these depths, at the times asked or against time."""
    what = "pin" if found.arc_length is None else "place"
    ax = beside_at_rest(found.system, ax, *((7.0, 4.0) if kind == "time" else (5.0, 6.0)))
    order = np.argsort(found.time)
    if kind == "time":
        for number, column in enumerate(chosen):
            y = found.offset[order, column]
            kept = thinned(y)
            name = "free end" if column == 0 and depth[0] == depth.max() else f"{what} {column}"
            ax.plot(found.time[order][kept], y[kept], color=f"C{number % 10}", linewidth=1.2, label=name)
        ax.axhline(0.0, color="0.6", linestyle="-.", linewidth=0.9, zorder=0)
        ax.set(xlabel="time (s)", ylabel="distance from axis (m)")
        if chosen:
            legend_outside(ax)
        return ax
    from ..systems.extras import require

    colours = require("matplotlib", "plot", "plotting").colormaps["viridis"]
    marker = "o" if what == "pin" and depth.size <= MOST_PINS_AS_DOTS else ""
    ax.axvline(0.0, color="0.6", linestyle="-.", linewidth=0.9, zorder=1)
    drawn = order[np.unique(np.linspace(0, order.size - 1, min(MOST_MOMENTS, order.size)).round().astype(int))]
    for rank, row in enumerate(drawn):
        kept = thinned(found.offset[row])
        ax.plot(
            found.offset[row][kept],
            depth[kept],
            color=colours(0.9 * rank / max(1, drawn.size - 1)),
            linewidth=1.2,
            marker=marker,
            markersize=2.5,
            label=f"{found.time[row]:.4g} s",
        )
    ax.plot(0.0, 0.0, marker="v", color="black", markersize=7.0, zorder=4, clip_on=False)
    ax.set_ylim(1.03 * depth.max(), -0.03 * depth.max())
    ax.set(xlabel="distance from axis (m), not to scale", ylabel="depth below the support (m)")
    if drawn.size:
        legend_outside(ax, title=f"{drawn.size} of {order.size} times" if drawn.size < order.size else None)
    return ax
