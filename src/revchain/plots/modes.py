# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of systems at rest, and beside them the shapes in which they whirl."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Iterable
from functools import cached_property, partial
from itertools import repeat
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..closed_forms.table import described
from ..results.motions import Response
from ..results.sheet import digits
from ..systems.numbers import integer, listed, shown
from .forms import WIDEST_FORM, colour_of, draw_form, extent_of, form_of, forms, start_of, unit_of
from .style import (
    AXIS, GREEN, HOUSE, MOST_PINS_AS_DOTS, MOST_POINTS, TIMED_UNITS, WIDEST, SpeedUnit, apart, axes_or_new, figure_of, moved_by,
    new_figure, plain, thinned, with_speeds,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..results.modes import Modes
    from ..systems.numbers import Floats, Whole
    from ..systems.rig import Support
    from ..systems.system import System

FORWARD, BACKWARD, LINK, FLUID = colour_of("", False), colour_of("", True), "0.35", "#e4f1f9"
CARRIED = GREEN
ARM: dict[str, Any] = {"color": "black", "linewidth": 2.5, "zorder": 3, "clip_on": False}
SUPPORT: dict[str, Any] = {"color": "black", "markersize": 7.0, "zorder": 4, "clip_on": False}
ROD: dict[str, Any] = {"color": "0.62", "linewidth": 6.0, "zorder": 2.5}
JOINT: dict[str, Any] = {"color": "0.1", "ls": "none", "marker": "o", "mec": "white", "mew": 0.7, "ms": 5.5, "zorder": 2.7}
RING = JOINT | {"color": "white", "mec": "black", "mew": 1.0, "ms": 7.0, "zorder": 3, "gid": "nodes"}
STRETCH = 5.0  # of the offsets of a system that turns back, whose links would cover each other
FOLD = 0.3  # sideways, between the links that hang and those that stand on them, at rest
MOST_SHAPES = 6  # unless the caller chooses them: more are not legible side by side
SPACING = 2.6  # between the axes of neighbouring shapes, each of which reaches from -1 to 1
MOST_NAMES = 12
NAME_WIDTHS = (12, 20, 40)  # letters in a line of a name: the least with which there is room for all
MOST_LINES = 18  # of all names
COLUMN = 1.25  # inches between the axes of neighbouring shapes
PLOT_HEIGHT = 4.0  # inches of the frame of a new figure
LETTER, LETTER_OF_LABEL, LINE_HEIGHT = 0.07, 0.088, 0.145  # inches
WHEEL = 0.6  # half the length of the bar of a flywheel


class Straight:
    """A system that hangs straight: the levels of its pins along the axis, and the drawing of its parts."""

    def __init__(self, system: System) -> None:
        self.system, self.base = system, system._base
        base, self.inverted = self.base, system._stands
        self.upwards = system._is_held or bool(self.inverted.all())
        if system._is_cord:
            level = np.linspace(base.length, 0.0, 201)
        else:
            steps = base.length * np.where(self.inverted, -1.0, 1.0) * (-1.0 if self.inverted.all() else 1.0)
            level = np.concatenate([np.cumsum(steps[::-1])[::-1], [0.0]])
        self.level: Floats = level[0] - level if system._is_held else level
        self.along: Floats = np.sign(self.level[:-1] - self.level[1:])  # levels grow (1) or fall (-1) down each link
        self.few = not system._is_cord and base.size <= MOST_PINS_AS_DOTS

    @property
    def said(self) -> str:
        """The text under the system at rest: the fluid, and an arm that is not drawn to scale."""
        fluid = f"\nin {self.system._fluid} fluid" if self.system._fluid else ""
        arm = "\narm not\nto scale" if self.system._support is not None and self.system._support.radius else ""
        return f"at rest{fluid}{arm}" if fluid or arm else "at rest\n"  # one line alone has another base line

    def names(self) -> list[str]:
        """Return the names of the links, in short lines; none if there are many links."""
        names = getattr(self.base, "names", None)
        if names is None or len(names) > MOST_NAMES or not self.few:
            return []
        for width in NAME_WIDTHS:
            folded = [textwrap.fill(name, width) for name in names]
            if sum(map(str.count, folded, repeat("\n"))) + len(folded) <= MOST_LINES:
                break
        return [plain(name) for name in folded]

    def beside(self) -> float:
        """Return how far bodies and flywheels reach sideways, in units of the axis."""
        reach = [extent_of(form)[0] * unit * metre for form, unit, metre in self._forms.values()]
        has_wheels = self.system._support is not None and bool(self.system._wheels.any())  # only rigs have a support
        return max([*reach, WHEEL * has_wheels])

    def room(self, narrow: float = 1.0) -> tuple[float, float]:
        """Return the room left of the axis for parts and right of it for names, in data units."""
        far, longest = self.beside(), max((len(line) + 2 for name in self.names() for line in name.split("\n")), default=0)
        left = max(SPACING / 2, far + 0.2 + 0.9 * (self.system._support is not None))
        return left, max(SPACING / 2, far + narrow * longest * LETTER * SPACING / COLUMN)

    @property
    def height(self) -> Floats:
        """Height of each pin or point of a cord above the support, or above the lower end of a held system."""
        return self.level if self.upwards else -self.level

    def _ends(self) -> tuple[float, float]:
        """Return the lowest and the highest level of the picture."""
        low, high = float(self.level.min()), float(self.level.max())
        if self.few:
            middle, half = self._middles(), rods_of(self.base)
            ends = [middle - half, middle + half]
            for k, (form, unit, _) in self._forms.items():
                ends.append(self._levels(k, np.multiply(extent_of(form)[1:], unit)))
            low, high = min(low, *map(np.min, ends)), max(high, *map(np.max, ends))
        margin = 0.04 * (high - low)
        return low - margin, high + margin

    @cached_property
    def _forms(self) -> dict[int, tuple[str, float, float]]:
        """Return, for each link whose name has a form, the form, its unit in metres, and units of the axis for a metre."""
        base, names = self.base, getattr(self.base, "names", None)
        tall, found = float(np.ptp(self.level)), {}
        for k, name in enumerate(names or () if self.few else ()):
            if form := form_of(name):
                unit = unit_of(forms()["bodies"][form], tall, float(base.length[k]), float(base.radius_of_gyration[k]))
                most = WIDEST_FORM / (extent_of(form)[0] * unit)
                found[k] = form, unit, min(most, SPACING / COLUMN * PLOT_HEIGHT / tall)
        return found

    def _levels(self, link: int, along: Floats) -> Floats:
        """Return the levels of distances along the body of a link that has a form."""
        form, unit, _ = self._forms[link]
        start = start_of(forms()["bodies"][form], self.base.centroid[link], unit)
        return np.asarray(self.level[link + 1] + self.along[link] * (start + along))

    def finish(self, ax: Axes) -> None:
        ends = self._ends()
        ax.set_ylim(*(ends if self.upwards else ends[::-1]))
        what = "height above the " + ("lower end" if self.system._is_held else "support")
        ax.set_ylabel(f"{what if self.upwards else 'depth below the support'} (m)")
        for side in ("top", "right"):
            ax.spines[side].set_visible(False)

    def axis(self, ax: Axes, at: float) -> None:
        ax.plot([at, at], [self.level.max(), self.level.min()], **AXIS)

    def supports(self, ax: Axes, at: float) -> None:
        ax.plot(at, self.level[-1], marker="^" if self.inverted.all() else "v", **SUPPORT)
        if self.system._is_held:
            ax.plot(at, self.level[0], marker="^", **SUPPORT)

    def links(self, ax: Axes, across: Floats, colour: str, label: str | None = None) -> None:
        """Draw the links at these distances from the vertical, inverted ones stout."""
        drawn = thinned(across) if across.size > MOST_POINTS else slice(None)
        marker = "o" if self.few else ""
        line: dict[str, Any] = {"color": colour, "linewidth": 1.6, "marker": marker, "markersize": 4.0, "zorder": 2}
        ax.plot(across[drawn], self.level[drawn], label=label, **line)
        if self.system._is_cord:
            self._particles(ax, across, colour, 4.0)
        above: Floats = (rods_of(self.base) - self.base.centroid) / self.base.length if self.few else np.zeros(0)
        for k in np.flatnonzero(above > 1e-9):  # rods that go on above their pins
            ends = [[at[k + 1], at[k + 1] + above[k] * (at[k + 1] - at[k])] for at in (across, self.level)]
            ax.plot(*ends, **line | {"marker": ""})
        stout = np.flatnonzero(self.inverted)
        stout = stout[:: 1 + stout.size // MOST_POINTS]
        if stout.size:
            none = np.full(stout.size, np.nan)
            x, z = (np.stack([at[stout], at[stout + 1], none], 1).ravel() for at in (across, self.level))
            ax.plot(x, z, color=colour, linewidth=4.0, alpha=0.45, zorder=2)

    def _particles(self, ax: Axes, across: Floats, colour: str, size: float) -> None:
        """Draw dots for the point masses on a cord at these distances from the vertical."""
        places = np.array(list(self.base._particles))
        if places.size:
            x, z = (np.interp(places, self.level[0] - self.level, at) for at in (across, self.level))
            ax.plot(x, z, "o", color=colour, markersize=size, zorder=2)

    def at_rest(self, ax: Axes) -> None:
        """Draw the straight system and its support."""
        if self.system._is_cord:
            density = self.base.density
            where = (self.level[0] - self.level) if not self.system._is_held else self.level
            thick = np.ones(201)
            if isinstance(density, float) and density:
                thick = np.maximum(where / self.base.length, 1e-9) ** density
            elif callable(density):
                thick = np.array([density(float(s)) for s in np.clip(where, 1e-9 * self.base.length, None)])
            thick = 0.02 + 0.06 * np.minimum(thick / np.median(thick), 4.0)
            ax.fill_betweenx(self.level, -thick, thick, color=LINK, linewidth=0.0)
            if self.base._compiled.tip_weight:
                ax.plot(0.0, self.level[0], marker="o", color=LINK, markersize=9.0)
            self._particles(ax, np.zeros(201), LINK, 7.0)
            self.supports(ax, 0.0)
            return
        across = self._folded(ax)
        if self.few:
            self._bodies(ax, across)
        elif self.system.has_momentum:
            ax.axvspan(-0.5, 0.5, color=FORWARD, alpha=0.12)
        if self.system._support is not None:
            _draw_support(self.system._support, ax, self, float(across[-1]))
        else:
            self.supports(ax, 0.0)

    def _folded(self, ax: Axes) -> Floats:
        """Draw the bars of the links, beside each other where the chain turns back; return how far aside each link is."""
        stands, level, bodies = self.inverted, self.level, forms()["bodies"]
        run = np.concatenate([[0], np.cumsum(stands[1:] != stands[:-1])])
        bare = [k for k, (form, *_) in self._forms.items() if bodies[form].get("bare")]
        aside: Floats = min(FOLD, 1.0 / (run[-1] + 1)) * (run[-1] - run) * (len(bare) < run.size)
        first = np.arange(run.size) if self.few else np.flatnonzero(np.diff(run, prepend=-1))
        lower, upper = level[first].astype(float), level[[*first[1:], run.size]]
        lower[bare] = np.nan
        for k in (k for k, (form, *_) in self._forms.items() if "hangs" in bodies[form]):
            lower[k] = self._middles()[k] - self.along[k] * bodies[self._forms[k][0]]["hangs"] * np.ptp(level)
        ax.vlines(aside[first], lower, upper, color=LINK, linewidth=np.where(stands[first], 4.0, 1.6))
        turns = np.flatnonzero(np.diff(run)) + 1
        ax.hlines(level[turns], aside[turns], aside[turns - 1], color=LINK, linewidth=1.6)
        return aside

    def _middles(self) -> Floats:
        """Return the level of the centre of gravity of each link."""
        middle: Floats = self.level[1:] + self.along * self.base.centroid
        return middle

    def _bodies(self, ax: Axes, across: Floats) -> None:
        chain, level, system = self.base, self.level, self.system
        weight = np.broadcast_to(chain._compiled.weight, chain.size)
        middle, half = self._middles(), rods_of(chain)
        heavy, floats, backward = weight > 0, floating(system), system._momentum(1.0) < 0
        named = np.isin(np.arange(chain.size), [*self._forms])
        long = heavy & (half > 0) & ~named
        ax.vlines(across[long], (middle - half)[long], (middle + half)[long], **ROD)
        face = np.where(floats, "white", LINK)
        size = 20 + 60 * np.sqrt(weight / weight.max())
        for k, (form, unit, most) in self._forms.items():
            draw_form(ax, form, across[k], most, partial(self._levels, k), unit, bool(backward[k]))
        dots = heavy & ~named & ~long
        ax.scatter(across[dots], middle[dots], s=size[dots], c=face[dots], edgecolors=LINK, zorder=3)
        ax.plot(across[:-1], level[1:-1], **JOINT)
        for wheel in np.flatnonzero(system._wheels & ~named).tolist():
            ends = across[wheel] - WHEEL, across[wheel] + WHEEL
            ax.hlines(middle[wheel], *ends, color=BACKWARD if backward[wheel] else FORWARD, linewidth=4.0, zorder=3)
        if names := self.names():
            for side in (-1, 1):  # to the left where links stand on the right
                self._write(ax, side, np.flatnonzero((across < across.max()) == (side < 0)), across, names)

    def _write(self, ax: Axes, side: int, links: Whole, across: Floats, names: list[str]) -> None:
        """Write the names of some links beside their bodies, apart from each other, with a line where one had to move."""
        low, high = self._ends()
        line = (high - low) * LINE_HEIGHT / (0.8 * float(figure_of(ax).get_size_inches()[1]))
        middle, far = self._middles()[links], self.beside()
        lines = np.array([1 + names[link].count("\n") for link in links])
        beside: dict[str, Any] = {"ha": "left" if side > 0 else "right", "va": "center", "fontsize": "small"}
        for link, level, place in zip(links, middle, apart(middle, line * (lines + 0.3), low, high), strict=True):
            x, moved = float(across[link] + side * far), abs(place - level) > line
            leader = {"arrowstyle": "-", "color": "0.6", "linewidth": 0.6, "shrinkA": 0.0, "shrinkB": 1.0} if moved else None
            away = moved_by(ax, side * (22 if moved else 9))
            ax.annotate(names[link], (x, level), (x, place), textcoords=away, arrowprops=leader, **beside)


def rods_of(base: Any) -> Floats:
    """Return half the length of each body that is a uniform rod down to its lower pin, and 0 for the others."""
    half = math.sqrt(3) * base.radius_of_gyration
    return np.where(np.isclose(base.centroid + half, base.length, rtol=1e-9, atol=0.0), half, 0.0)


def floating(system: System) -> NDArray[np.bool_]:
    """Return, for each link, whether the fluid that it displaces weighs more than the link."""
    base, displaced = system._base, getattr(system, "displaced", None)
    if displaced is None:
        return np.zeros(base.size, bool)
    fluid, weight = next(iter(displaced._given.values())), base._compiled.weight
    return np.broadcast_to(fluid, base.size) > np.broadcast_to(weight, base.size)


@described(bound=True)
def plot_system(system: System, ax: Axes | None = None) -> Axes:
    """Draw the system at rest, true to scale along the axis.

    returns: The drawing: joints (small dots), bodies (larger dots are heavier), rods as bars, and names of up to 12 links.
        Inverted links are thick, wheels are seen edge-on, bodies that float are hollow, and a cord is thicker where it is
        heavier. Links with names such as ``bell`` or ``man`` are drawn as such.

    >>> rc.Chain(mass=[1.0, 2.0], length=[0.5, 0.3]).plot().get_ylabel()
    'depth below the support (m)'
    """
    straight = Straight(system)
    left, right = straight.room()
    ax = axes_or_new(ax, max(4.2, 0.9 + 1.25 * COLUMN * (left + right) / SPACING), 6.0)
    straight.at_rest(ax)
    straight.finish(ax)
    ax.set_xlim(-left, right)
    if straight.few:
        said = "large dots: bodies (larger = heavier);\nsmall dots: joints; bars: rods"
        ax.set_xlabel(said, fontsize="small")
    ax.set_xticks([])
    if system._fluid:
        ax.set_facecolor(FLUID)
        ax.set_title(f"in {system._fluid} fluid", fontsize="small")
    return ax


def beside_at_rest(system: System | None, ax: Axes | None, width: float, height: float, across: float | None = None) -> Axes:
    """Return the axes of the caller, or new axes, beside the system at rest if its links are few.

    Both have the same levels if `across` is given, the metres across of a drawing in true proportions or 0 of another.
    """
    bent = getattr(system, "span", None) is not None  # it cannot hang straight
    if ax is not None or system is None or bent or not (straight := Straight(system)).few:
        return axes_or_new(ax, width, height)
    own = 1.1 + 0.27 * sum(straight.room())
    part = 1.1 * (across or 0.0) / float(np.ptp(straight._ends()))
    share = across is not None and part < 2.0  # a very flat drawing has levels of its own
    if across and share:  # 1.3 inches of the width are for labels
        height = float(np.clip((WIDEST - own - 1.3) / part, 3.0, 5.2))
        width = max(1.3 + height * part, 2.5)
    figure = new_figure(min(width + own, 1.2 * WIDEST if share else WIDEST), height)
    if straight.names() and (engine := figure.get_layout_engine()) is not None:
        engine.set(w_pad=0.1)  # type: ignore[call-arg]
    left, right = figure.subplots(1, 2, width_ratios=[own, width], sharey=share)
    plot_system(system, left).set_xlabel(straight.said)
    right.tick_params(labelleft=True)
    axes: Axes = right
    return axes


def rows_of(caller: str, modes: Modes, which: Iterable[int] | None) -> Whole:
    """Return the rows of the modes to draw: the first six, or those of the numbers, of a rig in both directions."""
    available = modes.number
    if available.size == 0:
        raise ValueError(f"{caller}: there are no modes")
    if which is None:
        return np.arange(min(len(modes), MOST_SHAPES))
    numbers = [integer(caller, "modes", mode) for mode in listed(caller, "modes", which)]
    for mode in numbers:
        if not available.min() <= mode <= available.max():
            raise ValueError(f"{caller}: mode must be from {available.min()} to {available.max()}, got {mode}")
        if mode not in available:
            raise ValueError(f"{caller}: mode {mode} is not in this result")
    if not numbers:
        raise ValueError(f"{caller}: modes names no mode")
    return np.concatenate([np.flatnonzero(available == number) for number in numbers])


@described(bound=True)
def plot_modes(
    found: Modes, ax: Axes | None = None, modes: Iterable[int] | None = None, *, carried: Response | None = None,
    speed: str | None = None,
) -> Axes:
    """Draw the system at rest and, beside it, the mode shapes, each along its own axis; rings mark the nodes.

    Forward modes of a rig with flywheels are blue, backward ones red; inverted links are thick.

    modes: Numbers of the modes to draw (for a rig, of both directions); the first six of this result if left out.
    carried: Response of the same system at one speed with all pins, drawn first.
    speed: Unit of the speeds: ``"rad/s"``, ``"rpm"``, ``"Hz"`` (turns per second) or ``"s"`` (the period). If left out,
        that of the question, or rpm and the period.
    raises: If `modes` has a number that is not in this result, or `carried` is not such a response.

    >>> ax = rc.modes(rc.Chain.uniform_rods(120, length=0.36), 4).plot()
    >>> ax.get_ylabel()
    'depth below the support (m)'
    """
    caller, system = "revchain.Modes.plot", found.system
    units = TIMED_UNITS if speed is None and found._speed_unit is None else [SpeedUnit(caller, speed, found)]
    if carried is not None and not isinstance(carried, Response):
        raise TypeError(f"{caller}: carried must be a revchain.Response, got {shown(carried)}")
    if carried is not None and (carried.system != system or carried.offset.shape != (system.size + 1,)):
        raise ValueError(f"{caller}: carried must be the response of the same rig at one speed, of every pin")
    no_motion = not len(found) and modes is None
    rows = np.arange(0) if no_motion else rows_of(caller, found, modes)
    straight = Straight(system)
    names, rates = ([], []) if carried is None else (["carried round"], [carried.angular_speed.item()])
    before = 1 + len(names)
    for row in rows:
        rates.append(float(found.angular_speed[row]))
        way = ("\nforward" if rates[-1] > 0 else "\nbackward") if found.has_momentum else ""
        names.append(f"mode {found.number[row]}{way}")
    labels = [straight.said, *with_speeds(names, rates, units)]
    wide = STRETCH if len({*straight.inverted.tolist()}) > 1 else 1.0
    shapes = [wide * shape / np.abs(shape).max() for shape in np.real(found.shape[rows])]  # that of a cord is largest anywhere
    reach = [(min(-1, shape.min()) - 0.3, max(1, shape.max()) + 0.3) for shape in shapes]
    narrow, wider = 0.0, 1.0
    while wider > 1.05 * narrow and narrow < 2.5:  # names need more room where the columns are narrow
        narrow = wider
        left, right = straight.room(narrow)
        aside = max(0.0, right + 1.1 - SPACING)  # so that the names do not reach the first shape
        room = [(-left, SPACING / 2), *[(-SPACING / 2, SPACING / 2)] * (before - 1), *reach]
        ends = aside + np.cumsum([high - low for low, high in room]) - left
        columns = (ends[-1] + left) / SPACING
        width = _width(labels, columns)
        wider = max(narrow, COLUMN * columns / (width - 1.2)) if right > SPACING / 2 else narrow
    ticks = [0.0, *(end - high for end, (_, high) in zip(ends[1:], room[1:], strict=True))]
    height = PLOT_HEIGHT + 1.2 if len(labels) > 1 else 0.75 * PLOT_HEIGHT  # of one column the picture would be a tower
    ax = axes_or_new(ax, width, height)
    straight.at_rest(ax)
    if carried is not None:
        most = np.abs(carried.offset).max()  # nothing is drawn of a resonance: NaN
        straight.axis(ax, ticks[1])
        straight.links(ax, ticks[1] + carried.offset / most, CARRIED)
        ax.plot([ticks[1], ticks[1] + carried.support_radius / most], [0.0, 0.0], **ARM)
    nodes = found.nodes
    for row, shape, at in zip(rows, shapes, ticks[before:], strict=True):
        _draw_mode(ax, found, straight, int(row), shape, nodes[row], at)
    ax.set_xticks(ticks, labels)
    ax.set_xlim(-left, ends[-1])
    straight.finish(ax)
    hangs_aside = system._support is not None and system._support.radius and carried is None
    place = "where it hangs" if hangs_aside else "the axis"
    said = [f"offset from {place}, each to its own scale"] * (len(ticks) > 1)
    said += ["rings: nodes"] * any(line.get_gid() == "nodes" for line in ax.lines)
    if not len(rows):
        rate = 0.0 if found._beyond_window else float(found.other.growth_rate.max(initial=0.0)) / math.log(2)
        none = "no mode in this window" if found._beyond_window else "no steady motion"
        said.append(f"unstable: a small push\ndoubles every {digits(1 / rate, 2)} s" if rate else none)
    ax.set_xlabel(("; " if len(ticks) > 4 else "\n").join(said))
    if system._fluid:
        ax.set_facecolor(FLUID)
    return ax


def _width(labels: list[str], columns: float) -> float:
    """Return the inches of a figure whose labels do not meet: at most `WIDEST` if they are short."""
    longest = max([len(line) for label in labels for line in label.splitlines()])
    return max(min(1.2 + COLUMN * columns, WIDEST), 0.9 + LETTER_OF_LABEL * (longest + 1) * columns)


def _draw_mode(ax: Axes, modes: Modes, straight: Straight, row: int, shape: Floats, nodes: Floats, axis: float) -> None:
    system, colour = straight.system, HOUSE[(int(modes.number[row]) - 1) % len(HOUSE)]
    if modes.has_momentum:
        colour = FORWARD if modes.angular_speed[row] > 0 else BACKWARD
    straight.axis(ax, axis)
    straight.links(ax, axis + shape, colour, f"mode {modes.number[row]}")
    if 0 < nodes.size <= MOST_PINS_AS_DOTS:
        along = np.concatenate([[0.0], np.cumsum(np.abs(np.diff(straight.level)))])
        ax.plot(np.full(nodes.size, axis), np.interp(nodes, along, straight.level), **RING)
    if system._support is not None and system._support._yields:
        ax.plot([axis, axis + shape[-1]], [0.0, 0.0], color="0.3", linewidth=1.0, zorder=3)
        ax.plot(axis + shape[-1], 0.0, marker="s", **{**SUPPORT, "markersize": 6.0})
    else:
        straight.supports(ax, axis)


def plot_carried(found: Response, ax: Axes | None, pins: list[int], unit: SpeedUnit) -> Axes:
    """Draw the response at one speed as a shape; with dashpots at the moment when its lowest pin is farthest."""
    straight = Straight(found.system)
    across = np.full(straight.level.size, np.nan)
    available = np.atleast_1d(found.pins)
    drawn = np.isin(available, pins)
    offset = found.offset.reshape(-1)
    when = np.exp(-1j * np.angle(offset[0])) if np.iscomplexobj(offset) else 1.0
    across[available[drawn]] = (offset * when).real[drawn]
    ax = beside_at_rest(found.system, ax, 5.0, 6.0, across=0.0)
    straight.axis(ax, 0.0)
    if len(pins) == across.size:
        straight.links(ax, across, CARRIED)
    else:
        ax.plot(across, straight.level, "o", color=CARRIED)
    if found.support_radius is not None:
        ax.plot([0.0, found.support_radius * np.real(when)], [0.0, 0.0], **ARM)
    straight.finish(ax)
    ax.set_xlabel(f"offset from the axis (m) at {unit.text(found.angular_speed.item())}")
    ax.locator_params(axis="x", nbins=5)
    return ax


def draw_spring(ax: Axes, start: float, end: float, tall: float) -> None:
    """Draw a spring at the level 0 of a picture of so tall a system."""
    x = end + (start - end) * np.concatenate([[1.0, 0.85], np.linspace(0.8, 0.3, 9), [0.25, 0.0]])
    zigzag = np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], 5)[:9], [0.0, 0.0]])
    ax.plot(x, 0.015 * tall * zigzag, color=LINK, linewidth=1.0, clip_on=False)


def _draw_support(support: Support, ax: Axes, straight: Straight, across: float) -> None:
    """Draw the support of the uppermost pin: a firm point, a spring, an arm."""
    level = straight.level
    yields = support._yields
    wall = -0.65 if support.radius and yields else -1.0 - straight.beside()  # the spring starts where the arm ends
    if support.radius:
        ax.plot([-1.0, -1.0], [level.max(), level.min()], **AXIS)
        ax.plot([-1.0, wall if yields else across], [0.0, 0.0], **ARM)
    if yields:
        tall = float(np.ptp(level))
        if support.stiffness == 0:  # it rolls on a rail
            ax.plot([-0.35, 0.35], [0.025 * tall] * 2, color=LINK, linewidth=1.5, clip_on=False)
        else:
            draw_spring(ax, wall, 0.0, tall)
            ax.plot([wall, wall], [-0.03 * tall, 0.03 * tall], color="black", linewidth=2.5, zorder=4, clip_on=False)
        ax.plot(0.0, 0.0, marker="s", **{**SUPPORT, "markersize": 8.0 if support.carriage else 4.0})
    else:
        ax.plot(across, 0.0, marker="^" if straight.inverted.all() else "v", **SUPPORT)
