# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of forced responses and of small oscillations."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from ..closed_forms.table import described
from ..systems.extras import require
from ..systems.numbers import Whole, boolean, word
from .modes import Straight, beside_at_rest, plot_carried
from .style import AXIS, MOST_PINS_AS_DOTS, SpeedUnit, house, legend_outside, pin_name, pins_among, thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..results.campbell import Campbell
    from ..results.motions import Response, Swing

MOST_CURVES = 4  # of pins, unless the caller chooses them
MOST_MOMENTS = 5  # in a picture of shapes


@described(bound=True)
def plot_response(
    found: Response, ax: Axes | None = None, pins: Iterable[int] | None = None, *, resonances: bool = True,
    speed: str | None = None,
) -> Axes:
    """Draw the distances of pins from the axis against the speed, on a logarithmic scale.

    A line is dashed where the pin is opposite to the support or the force. A response at one speed is drawn as a shape:
    the offsets of the pins against their depths.

    pins: Numbers of the pins to draw. If left out: the lowest and up to three others; all at a single speed.
    resonances: Whether to mark the whirl speeds of a chain in the range of the plot, if there are at most 60.
    raises: If `pins` has a pin that is not in this result, or the result has no speed.

    >>> import numpy as np
    >>> chain = rc.Chain.uniform_rods(20, length=0.36)
    >>> ax = rc.response(chain, angular_speed=np.linspace(1.0, 30.0, 400)).plot(speed="Hz")
    >>> ax.get_xlabel()
    'frequency (Hz)'
    """
    caller = "revchain.Response.plot"
    unit, rate = SpeedUnit(caller, speed, found), found.angular_speed.reshape(-1)
    available = np.atleast_1d(found.pins).tolist()
    if rate.size == 0:
        raise ValueError(f"{caller}: the response has no speed to draw; it needs at least one")
    if rate.size == 1:
        return plot_carried(found, ax, available if pins is None else pins_among(caller, pins, available), unit)
    chosen = _spread(available, found.system.size) if pins is None else pins_among(caller, pins, available)
    order = np.argsort(rate)
    rate, offset = rate[order], found.offset.reshape(rate.size, -1)[order]
    drive = -1 if found.acceleration is not None else 1  # which side the support is on
    support = np.full(rate.size, np.nan)  # of a force
    if found.force is None:
        support = np.broadcast_to(found._support_amplitude, found.angular_speed.shape).reshape(-1)[order]
    if unit.unit == "s" and rate[0] < 0 < rate[-1]:  # the curves break at rest, the period of which is infinite
        rest = np.searchsorted(rate, 0.0)
        rate, offset = np.insert(rate, rest, 0.0), np.insert(offset, rest, np.nan, axis=0)
        support = np.insert(support, rest, np.nan)
    ax = beside_at_rest(found.system, ax, 7.0, 4.5)
    for number, pin in enumerate(chosen):
        y = offset[:, available.index(pin)]
        for side, style in ((1, "-"), (-1, "--")):
            size = np.where(_with_neighbours(np.sign(drive * y.real) == side), np.abs(y), np.nan)
            label = pin_name(found.system, pin) if side == 1 else None
            ax.plot(unit.of(rate), size, style, color=house(number), linewidth=1.4, label=label)
    label = "support" if found.force is None and found.system.size not in chosen else None
    ax.plot(unit.of(rate), support, color="0.6", linewidth=0.8, zorder=0, label=label)
    for at in found.whirl_speeds if boolean(caller, "resonances", resonances) else ():
        ax.axvline(unit.of(at), **{**AXIS, "zorder": 0})
    ax.set_yscale("log")
    finite = np.abs(offset[np.isfinite(offset) & (offset != 0)])
    if finite.size:
        top = finite.max()
        ax.set_ylim(max(finite.min(), 1e-6 * np.nanmin([top, *support])) / 2, 2 * top)
    ax.set(xlabel=unit.label, ylabel="distance from axis (m)")
    opposite = "support" if found.force is None else "force"
    ax.plot([], [], "--", color="0.3", linewidth=1.4, label=f"opposite to\nthe {opposite}")
    legend_outside(ax)
    return ax


def _with_neighbours(yes: np.ndarray[tuple[int], np.dtype[np.bool_]]) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return `yes` with each next point added: curves then meet where a pin crosses the axis, and at resonances."""
    wide = yes.copy()
    wide[1:] |= yes[:-1]
    return wide


def _spread(available: list[int], links: int) -> list[int]:
    """Return the lowest of the pins, and some others evenly up the chain."""
    free = [pin for pin in sorted(set(available)) if pin < links] or available
    return [free[k] for k in np.linspace(0, len(free), min(MOST_CURVES, len(free)), endpoint=False).astype(int)]


@described(bound=True)
def plot_swing(
    found: Swing, ax: Axes | None = None, *, kind: str | None = None, pins: Iterable[int] = (0,)
) -> Axes:
    """Draw the system at the given times, the offsets of pins against time, or their paths seen from above.

    kind: ``"shapes"``: up to five shapes from dark (early) to light (late), with enlarged offsets; not with momentum.
        ``"time"``: offsets against time, with momentum those along y dashed. ``"path"``: paths seen from above; with
        momentum only. If left out, ``"path"`` with momentum, ``"time"`` if the support is moved, else ``"shapes"``.
    pins: For ``"time"`` and ``"path"``: numbers of the pins, 0 for the free end; for a cord, indices in `arc_length`.
    raises: If `kind` is another word, or there is no such pin.

    >>> import numpy as np
    >>> chain = rc.Chain.uniform_plummets(10, length=1.0)
    >>> plucked = np.interp(np.arange(11), [0, 5, 10], [0.0, 0.05, 0.0])
    >>> ax = rc.swing(chain, np.linspace(0, 4, 300), offset=plucked).plot(kind="time", pins=[0, 5])
    >>> ax.get_xlabel()
    'time (s)'
    """
    caller, turns = "revchain.Swing.plot", found.offset.dtype.kind == "c"
    kinds = ("path", "time") if turns else ("shapes", "time")
    usual = "time" if found.motion_end and not turns else kinds[0]
    kind = word(caller, "kind", usual if kind is None else kind, kinds)
    chosen, order = pins_among(caller, pins, range(found.offset.shape[1])), np.argsort(found.time)
    size = {"time": (7.0, 4.0), "path": (5.0, 5.0), "shapes": (5.0, 6.0)}[kind]
    ax = beside_at_rest(found.system, ax, *size, across=0.0 if kind == "shapes" else None)
    if kind == "shapes":
        return _draw_moments(found, ax, order)
    arc, time = found.arc_length, found.time[order]
    if kind == "time" and found.support_offset is not None:
        ax.plot(time, found.support_offset[order], color="0.55", linewidth=1.2, label="support")
    for number, pin in enumerate(chosen):
        at, colour = found.offset[order, pin], house(number)
        label = pin_name(found.system, pin)
        drawn = thinned(np.abs(at) if turns else at)
        x, y = (at.real, at.imag) if kind == "path" else (time, at.real)
        ax.plot(x[drawn], y[drawn], color=colour, linewidth=1.2, label=label)
        if turns and kind == "time":
            ax.plot(time[drawn], at.imag[drawn], "--", color=colour, linewidth=1.2)
    if kind == "path":
        ax.plot(0.0, 0.0, marker="+", color="0.4", zorder=0)
        ax.set(xlabel="x (m)", ylabel="y (m)", aspect="equal")
    elif turns:
        ax.set(xlabel="time (s)", ylabel="offset (m): x solid, y dashed")
    else:
        ax.axhline(0.0, **{**AXIS, "zorder": 0})
        ax.set(xlabel="time (s)", ylabel="distance from axis (m)")
    if chosen:
        legend_outside(ax)
    return ax


@described(bound=True)
def plot_campbell(found: Campbell, ax: Axes | None = None, *, speed: str | None = None) -> Axes:
    """Draw the frequencies against the speed, its multiples and their crossings; orange where the shape is unstable.

    speed: Unit of speeds and frequencies: ``"rpm"``, ``"rad/s"``, ``"Hz"``, or ``"s"`` for periods. If left out, that of
        the question, or rpm.

    >>> import numpy as np
    >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=3.0))
    >>> rc.campbell(carousel, np.linspace(0.3, 1.5, 25)).plot().get_ylabel()
    'frequency (per minute)'
    """
    unit = SpeedUnit("revchain.Campbell.plot", speed, found, "rpm")
    ax = beside_at_rest(found.system, ax, 7.0, 4.5)
    x, y = unit.of(found.angular_speed), unit.of(found.frequency)
    periods = unit.unit == "s"
    for j in range(y.shape[1]):
        ax.plot(x, y[:, j], color=house(0), linewidth=1.4)
        ax.plot(x, np.where(found.stable, np.nan, y[:, j]), color=house(1), linewidth=1.4)
    far = x.max()
    heights = {order: far / order if periods else far * order for order in found.orders}
    top = 1.15 * max(heights.values())
    for order, height in heights.items():
        ax.plot([0, far], [0, height], color="0.6", linewidth=0.9, zorder=0)
        ax.annotate(f"{order}n", (far, height), (3, 0), textcoords="offset points", va="center", color="0.4")
    for one in found.crossings:
        at = unit.of(one.angular_speed)
        height = at / one.order if periods else one.order * at
        ax.plot(at, height, "o", color="black", markersize=4)
        box = {"facecolor": "white", "edgecolor": "none", "alpha": 0.7, "pad": 0.5}
        ax.annotate(f"{at:.3g}", (at, height), (5, -5), textcoords="offset points", va="top", bbox=box)
    per = {"rpm": "frequency (per minute)", "s": "period of the motion (s)"}.get(unit.unit, f"frequency ({unit.unit})")
    ax.set(xlabel=unit.label, ylabel=per, ylim=(0, top), xlim=(0, 1.06 * far))
    return ax


def _draw_moments(found: Swing, ax: Axes, order: Whole) -> Axes:
    """Draw the shapes of a swing in a plane at some of its times."""
    arc, straight = found.arc_length, Straight(found.system)
    level = straight.level if arc is None else np.interp(arc, [0.0, found.system.length], straight.level[[0, -1]])
    colours = require("matplotlib", "plot", "plotting").colormaps["viridis"]
    marker = "o" if arc is None and level.size <= MOST_PINS_AS_DOTS else ""
    ax.axvline(0.0, **AXIS)
    straight.finish(ax)
    ends = np.array(ax.get_ylim())
    free = int(np.abs(ends - level[0]).argmin())  # 0: the free end is at the bottom, 1: at the top
    ends[free] += 0.12 * (level[0] - level[-1])
    ax.set_ylim(*ends)
    moments = order[np.unique(np.linspace(0, order.size - 1, min(MOST_MOMENTS, order.size)).round().astype(int))]
    for shade, row in zip(np.linspace(0.0, 0.65, moments.size), moments, strict=True):
        drawn, line = thinned(found.offset[row]), {"color": colours(shade), "linewidth": 1.2, "marker": marker}
        ax.plot(found.offset[row][drawn], level[drawn], markersize=2.5, **line)
        far = 10 + 12 * (np.sum(found.offset[moments, 0] < found.offset[row, 0]) % 2)  # neighbours are not on one line
        said = {"ha": "center", "va": "center", "textcoords": "offset points", "color": colours(shade)}
        ax.annotate(f"{found.time[row]:.4g} s", (found.offset[row, 0], level[0]), (0, (2 * free - 1) * far), **said)
    straight.supports(ax, 0.0)
    ax.margins(x=0.1)
    ax.set_xlabel("distance from axis (m), not to scale")
    return ax
