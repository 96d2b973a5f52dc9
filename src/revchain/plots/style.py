# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts that pictures share: colours, frames and units."""

from __future__ import annotations

import sys
import textwrap
from collections.abc import Collection, Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..systems.extras import require
from ..systems.numbers import Floats, Numbers, integer, listed, shown, word
from ..systems.units import SPEED_UNITS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

    from ..systems.system import System

PALETTE = ("0072B2", "D55E00", "009E73", "CC79A7", "B01F3C", "6B6B00", "000000")
"""Colours that can be told apart without seeing red or green: four of Okabe and Ito (2008), and darker ones."""

HOUSE = tuple(f"#{colour}" for colour in PALETTE)
BLUE, ORANGE, GREEN, *_ = HOUSE

STYLE: dict[Any, Any] = {
    "axes.titlesize": "medium",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.prop_cycle": f"cycler(color={list(PALETTE)})",
    "legend.frameon": False,
    "savefig.dpi": 200,
    "svg.hashsalt": "revchain",
}
"""For `matplotlib.rcParams.update`: what else a program sets to draw like the pictures of the package."""

AXIS: dict[str, Any] = {"color": "0.6", "linestyle": "-.", "linewidth": 0.9, "zorder": 1}
"""The line of the axis about which a system turns."""

WIDEST = 8.0  # inches, of a new figure
LABEL_WIDTH = 20  # letters in a line of a legend
MINUS = "\N{MINUS SIGN}"
MOST_PINS_AS_DOTS = 40
MOST_POINTS = 2000  # per curve: about the pixels of a large picture


def house(number: int) -> str:
    """Return a colour of the palette, which begins again after its last."""
    return HOUSE[number % len(HOUSE)]


class SpeedUnit:
    """The unit in which a picture shows speeds: that of the caller, of the question, or the usual one."""

    def __init__(self, caller: str, unit: str | None, found: Any = None, usual: str = "rad/s") -> None:
        chosen = getattr(found, "_speed_unit", None) or usual if unit is None else unit
        self.unit = word(caller, "speed", chosen, SPEED_UNITS)
        self.quantity, self.per_radian = SPEED_UNITS[chosen]

    @property
    def label(self) -> str:
        """The label of an axis of speeds, such as ``speed (rpm)``."""
        return f"{self.quantity} ({self.unit})"

    def of(self, speed: Any) -> Any:
        """Speeds, given in rad/s, in this unit."""
        if self.unit != "s":
            return self.per_radian * speed
        with np.errstate(divide="ignore"):
            return np.divide(self.per_radian, speed)

    def text(self, speed: float) -> str:
        """A speed with its unit, such as ``36.99 rpm``; a period without the sign of its rotation."""
        number = self.of(speed)
        sign = MINUS if number < 0 and self.unit != "s" else ""
        return sign + f"{abs(number):#.4g}".removesuffix(".") + f" {self.unit}"


CAPTION_UNITS = [SpeedUnit("captions", unit) for unit in ("rad/s", "rpm")]
TIMED_UNITS = [SpeedUnit("captions", unit) for unit in ("rpm", "s")]


def with_speeds(names: Iterable[str], speeds: Iterable[float], units: list[SpeedUnit]) -> list[str]:
    """Return labels with a name and, on lines of their own, a speed in each unit."""
    return ["\n".join([name, *[unit.text(at) for unit in units]]) for name, at in zip(names, speeds, strict=True)]


def pins_among(caller: str, pins: Iterable[int], available: Collection[int]) -> list[int]:
    """The numbers of the pins to draw; a ValueError if one of them is not available."""
    numbers = [integer(caller, "pins", pin) for pin in listed(caller, "pins", pins)]
    for number in numbers:
        if number not in available:
            known = f"numbers from {min(available)} to {max(available)}"
            if len(available) <= max(available) - min(available):
                some = ", ".join(map(str, list(available)[:9])) + ", ..." * (len(available) > 9)
                known = f"{some}, those of this result"
            raise ValueError(f"{caller}: pins must be {known}, got {number}")
    return numbers


def pin_name(system: System, pin: int) -> str:
    """Return the label of a pin's curve in short lines, with the name of a link that ends there."""
    return plain(textwrap.fill(system._pin_name(pin), LABEL_WIDTH))


def new_figure(width: float, height: float) -> Figure:
    """Return a new figure: one of pyplot if the caller uses pyplot, which then shows it; else a free one."""
    free = require("matplotlib.figure", "plot", "plotting").Figure
    pyplot = sys.modules.get("matplotlib.pyplot")
    figure: Figure = (pyplot.figure if pyplot is not None else free)(figsize=(width, height), layout="constrained")
    return figure


def axes_or_new(ax: Axes | None, width: float, height: float) -> Axes:
    """Return the axes of the caller, or new axes."""
    if ax is not None:
        return checked_axes(ax)
    axes: Axes = new_figure(width, height).add_subplot()
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    return axes


def checked_axes(ax: Axes) -> Axes:
    """Return `ax`; raise a TypeError unless they are axes of matplotlib."""
    kind: type[Axes] = require("matplotlib.axes", "plot", "plotting").Axes
    if not isinstance(ax, kind):
        raise TypeError(f"plot: ax must be axes of matplotlib, got {shown(ax)}")
    return ax


def legend_outside(ax: Axes, **more: Any) -> None:
    """Write the legend to the right of the frame."""
    ax.legend(**{"loc": "upper left", "bbox_to_anchor": (1.02, 1.0), "borderaxespad": 0.0, "frameon": False, **more})


def plain(text: str) -> str:
    """Return `text` for matplotlib, which would read what is between two $ as mathematics."""
    return text.replace("$", r"\$")


def save_picture(axes: Any, title: str, path: Path) -> None:
    """Write a picture with its title."""
    axes.set_title(plain(title), wrap=True)
    axes.figure.savefig(path, dpi=200)


def thinned(curve: Numbers) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Return indices of the points that a picture needs: the ends and the extremes of its stretches."""
    if curve.size <= MOST_POINTS:
        return np.arange(curve.size)
    edges = np.linspace(0, curve.size, MOST_POINTS // 2 + 1).astype(np.intp)
    chosen = {0, curve.size - 1}
    for begin, end in zip(edges[:-1], edges[1:], strict=True):
        stretch = curve[begin:end]
        chosen.update((int(begin + stretch.argmin()), int(begin + stretch.argmax())))
    return np.array(sorted(chosen), dtype=np.intp)


def figure_of(ax: Axes) -> Figure:
    """Return the figure on which axes lie."""
    figure = ax.get_figure(root=True)
    assert figure is not None
    return figure


def moved_by(ax: Axes, x: float = 0.0, y: float = 0.0) -> Any:
    """Return the coordinates of the data, moved by so many points."""
    return require("matplotlib.transforms", "plot", "plotting").offset_copy(ax.transData, figure_of(ax), x, y, units="points")


def apart(places: Any, size: Any, low: float = -np.inf, high: float = np.inf) -> Floats:
    """Return the places of texts of these sizes, moved as little as possible until none overlap, in their order."""
    at = np.asarray(places, float)
    order = np.argsort(at, kind="stable")
    sizes = np.broadcast_to(np.asarray(size, float), at.shape)[order]
    shift = np.concatenate([[0.0], np.cumsum((sizes[1:] + sizes[:-1]) / 2)])[: at.size]
    groups: list[tuple[float, int]] = []  # mean and number of places that move together
    for place in (at[order] - shift).tolist():
        groups.append((place, 1))
        while len(groups) > 1 and groups[-2][0] > groups[-1][0]:
            (one, some), (other, more) = groups[-2:]
            groups[-2:] = [((one * some + other * more) / (some + more), some + more)]
    moved = np.empty_like(at)
    begin = np.array([mean for mean, count in groups for _ in range(count)])
    if at.size:
        most = high - sizes[-1] / 2 - shift[-1]
        begin = np.clip(begin, min(low + sizes[0] / 2, most), most)
    moved[order] = begin + shift
    return moved


def keep_room(ax: Axes, share: float = 0.35) -> None:
    """Widen a drawing in true proportions that is almost flat or almost vertical."""
    (left, right), (low, high) = ax.get_xlim(), ax.get_ylim()
    wide, tall = right - left, high - low
    if tall < share * wide:
        ax.set_ylim((low + high - share * wide) / 2, (low + high + share * wide) / 2)
    elif wide < share * tall:
        ax.set_xlim((left + right - share * tall) / 2, (left + right + share * tall) / 2)


def half_waves_style(waves: int, named: set[int]) -> tuple[str, str | None]:
    """Return the colour of a curve, and a label unless `named`, which gets this number of half waves, has it."""
    label = None if waves in named else f"{waves} half wave{'s' * (waves != 1)}"
    named.add(waves)
    return house(waves - 1), label
