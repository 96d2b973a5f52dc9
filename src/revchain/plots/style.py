# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures by matplotlib. No backend is chosen, no style changed."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..results.sheet import digits
from ..systems.extras import require
from ..systems.numbers import Numbers, Whole, integer, listed, one_positive, refuse_beyond_memory, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..closed_forms.governor import GovernorMotion
    from ..closed_forms.rope import SkippingRope, TortuousRope
    from ..questions.cord import ContinuousShape
    from ..questions.held import _Held
    from ..results.modes import Modes
    from ..results.shapes import SteadyShape
    from ..systems.chain import Chain

BYTES = 64  # of a point of a curve
MOST_SHAPES = 6  # drawn unless asked: more do not stay legible side by side
MOST_PINS_AS_DOTS = 40
MOST_POINTS = 2000  # per curve: about the pixels of a large picture
SPACING = 2.6  # between the axes of neighbouring shapes, each of which reaches from -1 to 1
WIDEST_RATIO = 1e3  # of weights on a linear scale


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


def plain(text: str) -> str:
    """`text` as matplotlib draws it letter by letter: what stands between two $ would be mathematics."""
    return text.replace("$", r"\$")


def plot_modes(modes: Modes, ax: Axes | None, which: Iterable[int] | None, *, length_unit: str) -> Axes:
    """See `Modes.plot`."""
    place = "revchain.Modes.plot"
    chosen = _chosen(place, modes.number, which)
    first = int(modes.number[0])
    ax = axes_or_new(ax, max(4.0, 1.6 + 1.25 * len(chosen)), 6.0)
    lengths = modes.system.length
    depth = np.concatenate([np.cumsum(lengths[::-1])[::-1], [0.0]])  # of the pins, free end first
    speeds, turns = modes.angular_speed, modes.rpm
    marker = "o" if depth.size <= MOST_PINS_AS_DOTS else ""
    for nth, mode in enumerate(chosen):
        axis = SPACING * nth
        colour = f"C{nth % 10}"
        shape = modes.shape[mode - first]
        kept = thinned(shape)
        ax.plot([axis, axis], [depth[0], 0.0], color="0.6", linestyle="--", linewidth=0.9, zorder=1)
        ax.plot(
            axis + shape[kept],
            depth[kept],
            color=colour,
            linewidth=1.6,
            marker=marker,
            markersize=4.0,
            zorder=2,
            label=f"mode {mode}",
        )
        nodes = depth[0] - modes.nodes[mode - first]
        if nodes.size <= MOST_PINS_AS_DOTS:
            ax.plot(
                np.full(nodes.size, axis),
                nodes,
                linestyle="none",
                marker="o",
                markersize=7.0,
                markerfacecolor="white",
                markeredgecolor="black",
                zorder=3,
            )
        ax.plot(axis, 0.0, marker="v", color="black", markersize=7.0, zorder=4, clip_on=False)
    ax.set_xlim(-SPACING / 2, SPACING * (len(chosen) - 0.5))
    ax.set_xticks(
        [SPACING * nth for nth in range(len(chosen))],
        [
            f"mode {mode}\n{digits(speeds[mode - first], 4)} rad/s\n{digits(turns[mode - first], 4)} rev/min"
            for mode in chosen
        ],
        fontsize="small",
    )
    ax.set_ylim(1.03 * depth[0], -0.03 * depth[0])
    ax.set_ylabel(f"depth below the support ({length_unit})")
    ax.set_xlabel("offset from the axis, own scale each;\nrings mark the nodes", fontsize="small")
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    return ax


def plot_chain(chain: Chain, ax: Axes | None, *, length_unit: str, weight_unit: str) -> Axes:
    """See `Chain.plot`."""
    ax = axes_or_new(ax, 5.0, 6.0)
    length = chain.length
    weight = chain.weight
    upper_pin = np.cumsum(length[::-1])[::-1] - length
    centroid = upper_pin + chain.centroid
    total = chain.total_length
    heavy = weight > 0
    few = chain.size <= MOST_PINS_AS_DOTS
    pins = np.concatenate([upper_pin + length, [0.0]])
    least = float(weight[heavy].min())
    most = float(weight.max())
    logarithmic = most > WIDEST_RATIO * least
    start = least / 10 if logarithmic else 0.0
    if few:
        ax.hlines(centroid[heavy], start, weight[heavy], color="C0", linewidth=1.2, zorder=1)
        ax.plot(weight[heavy], centroid[heavy], linestyle="none", marker="o", markersize=5.0, color="C0", zorder=3)
    else:
        kept = np.flatnonzero(heavy)
        kept = kept[thinned(weight[kept])]
        ax.fill_betweenx(centroid[kept], start, weight[kept], color="C0", alpha=0.2, linewidth=0.0)
        ax.plot(weight[kept], centroid[kept], color="C0", linewidth=1.2, zorder=3)
    ax.plot([start, start], [0.0, total], color="0.3", linewidth=2.0, zorder=2, clip_on=False)
    if few:
        ax.plot(
            np.full(pins.size, start),
            pins,
            linestyle="none",
            marker="o",
            markersize=6.0,
            markerfacecolor="white",
            markeredgecolor="0.3",
            zorder=4,
            clip_on=False,
        )
    ax.plot(start, 0.0, marker="v", color="black", markersize=9.0, zorder=5, clip_on=False, linestyle="none")
    if logarithmic:
        ax.set_xscale("log")
        ax.set_xlim(start, 3 * most)
    else:
        ax.set_xlim(0.0, 1.1 * most)
    lowest = max(total, float(centroid[heavy].max()))
    highest = min(0.0, float(centroid[heavy].min()))
    margin = 0.03 * (lowest - highest)
    ax.set_ylim(lowest + margin, highest - margin)
    rings = "\nrings mark the pins" if few else ""
    ax.set_xlabel(f"weight of each link, at its centre of gravity ({weight_unit}){rings}", fontsize="small")
    ax.set_ylabel(f"depth below the support ({length_unit})")
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    return ax


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


def _chosen(place: str, available: Whole, which: Iterable[int] | None) -> list[int]:
    """Numbers of the modes to draw."""
    if available.size == 0:
        raise ValueError(f"{place}: there are no modes")
    if which is None:
        return [int(number) for number in available[:MOST_SHAPES]]
    chosen = [integer(place, "modes", mode) for mode in listed(place, "modes", which)]
    for mode in chosen:
        if not available[0] <= mode <= available[-1]:
            raise ValueError(f"{place}: mode must be from {available[0]} to {available[-1]}, got {mode}")
    if not chosen:
        raise ValueError(f"{place}: modes names no mode")
    return chosen


def plot_skipping_rope(rope: SkippingRope, ax: Axes | None, *, length_unit: str) -> Axes:
    """See `SkippingRope.plot`."""
    refuse_beyond_memory("revchain.SkippingRope.plot", "half_waves", rope.half_waves, 200 * BYTES)
    ax = axes_or_new(ax, 6.4, 4.0)
    places = rope.at_arc(np.linspace(0.0, rope.length, 200 * rope.half_waves + 1))
    ax.axhline(0.0, color="0.6", linestyle="-.", linewidth=0.9, zorder=1)
    label = f"{rope.angular_speed:.4g} rad/s" if rope.has_speed else f"length {rope.length:.4g}"
    ax.plot(places.x, places.offset, linewidth=1.6, label=label)
    ax.set(xlabel=f"along the axis ({length_unit})", ylabel=f"from the axis ({length_unit})", aspect="equal")
    ax.legend()
    return ax


def plot_tortuous_rope(rope: TortuousRope, ax: Axes | None, half_waves: float, *, length_unit: str) -> Axes:
    """See `TortuousRope.plot`."""
    refuse_beyond_memory("revchain.TortuousRope.plot", "half_waves", int(half_waves), 200 * BYTES)
    ax = axes_or_new(ax, 5.0, 5.0)
    places = rope.at(np.linspace(0.0, half_waves * rope.half_wave, 1 + int(200 * max(half_waves, 1.0))))
    round_ = np.linspace(0.0, 2 * np.pi, 200)
    for radius in {rope.least_radius, rope.greatest_radius} - {0.0}:
        ax.plot(radius * np.cos(round_), radius * np.sin(round_), color="0.7", linestyle="--", linewidth=0.9)
    ax.plot(places.radius * np.cos(places.angle), places.radius * np.sin(places.angle), linewidth=1.6)
    ax.plot(0.0, 0.0, marker="+", color="0.4")
    ax.set(
        xlabel=f"across ({length_unit})",
        ylabel=f"across ({length_unit})",
        title=f"seen along the axis: {rope.half_wave_angle:.3g} rad in {rope.half_wave:.3g} {length_unit}",
        aspect="equal",
    )
    return ax


def plot_governor(motion: GovernorMotion, ax: Axes | None, duration: float | None) -> Axes:
    """See `GovernorMotion.plot`."""
    place = "revchain.GovernorMotion.plot"
    if duration is None:
        if motion.regime == "asymptotic":
            raise ValueError(f"{place}: give duration: the motion never returns")
        duration = 2 * motion.period if motion.period > 0 else 1.0
    time = np.linspace(0.0, one_positive(place, "duration", duration), 801)
    ax = axes_or_new(ax, 6.4, 4.0)
    for angle in (motion.least_angle, motion.greatest_angle):
        if np.isfinite(angle):
            ax.axhline(np.degrees(angle), color="0.6", linestyle=":", linewidth=0.9, zorder=1)
    ax.plot(time, np.degrees(motion.angle(time)), linewidth=1.6)
    period = f", period {motion.period:.4g} s" if 0 < motion.period < np.inf else ""
    ax.set(xlabel="time (s)", ylabel="angle (degrees)", title=f"{motion.regime}{period}")
    return ax


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


def plot_shapes(
    shapes: Iterable[SteadyShape | ContinuousShape], ax: Axes | None, *, linked: bool, length_unit: str
) -> Axes:
    """See `SteadyShapes.plot` and `ContinuousShapes.plot`; dots mark the pins of linked shapes, else the free end."""
    ax = axes_or_new(ax, 5.0, 6.0)
    ax.axvline(0.0, color="0.6", linestyle="-.", linewidth=0.9, zorder=1)
    named: set[int] = set()
    for shape in shapes:
        x, z = shape.offset, shape.height
        colour, label = half_waves_style(shape.half_waves, named)
        marker = "o" if linked and x.size <= MOST_PINS_AS_DOTS else ""
        kept = thinned(x) if linked else slice(None)
        ax.plot(x[kept], z[kept], color=colour, linewidth=1.4, marker=marker, markersize=3.0, label=label)
        if not linked:
            ax.plot(x[0], z[0], color=colour, marker="o", markersize=3.5)
    for top in sorted({float(shape.offset[-1]) for shape in shapes} or {0.0}):
        if top:
            ax.plot([0.0, top], [0.0, 0.0], color="0.3", linewidth=1.0, zorder=1)
        ax.plot(top, 0.0, marker="v", color="black", markersize=7.0, clip_on=False)
    ax.set(xlabel=f"from the axis ({length_unit})", ylabel=f"above the support ({length_unit})", aspect="equal")
    keep_room(ax)
    if named:
        ax.legend(fontsize=None if linked else "small")
    return ax


def plot_held_shapes(shapes: Sequence[_Held], ax: Axes | None, *, length_unit: str) -> Axes:
    """See `HeldShapes.plot`."""
    ax = axes_or_new(ax, 5.0, 6.0)
    ax.axvline(0.0, color="0.6", linestyle="-.", linewidth=0.9, zorder=1)
    named = set()
    for shape in shapes:
        marker = "o" if shape.offset.size <= MOST_PINS_AS_DOTS else ""
        waves = shape.half_waves
        label = None if waves in named else f"{waves} half wave{'s' * (waves != 1)}"
        named.add(waves)
        kept = thinned(shape.offset)
        ax.plot(
            shape.offset[kept],
            shape.height[kept],
            color=f"C{(waves - 1) % 10}",
            linewidth=1.4,
            marker=marker,
            markersize=3.0,
            label=label,
        )
        ax.plot([0.0, 0.0], [0.0, shape.span], color="black", marker="o", linestyle="none", markersize=6.0)
    ax.set(xlabel=f"from the axis ({length_unit})", ylabel=f"above the lower end ({length_unit})", aspect="equal")
    keep_room(ax)
    if named:
        ax.legend()
    return ax
