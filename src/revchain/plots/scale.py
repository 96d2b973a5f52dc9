# SPDX-License-Identifier: GPL-3.0-or-later
"""Scale drawings of systems at rest, with their dimensions, masses and the names of their links."""

from __future__ import annotations

import math
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from ..systems.numbers import Floats
from .forms import draw_form, extent_of
from .forms import forms as table
from .modes import BACKWARD, FLUID, FORWARD, JOINT, LINK, ROD, Straight, draw_spring, floating, rods_of
from .style import AXIS, apart, moved_by, new_figure, plain

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TALL, WIDE = 4.4, 5.2  # inches of the drawing at most, without its texts
LETTERS = 8.5  # points
FOLD = 0.09  # of the drawing: between links that hang and links that stand on them
FEW = 8  # links that have a dimension each; equal ones of more share one
MOST_TEXTS = 12  # dimensions that are written
WHEEL = 0.05  # of the drawing: half a flywheel
BAR: dict[str, Any] = {"color": "black", "linewidth": 2.5, "solid_capstyle": "butt", "zorder": 3}
DIMENSION: dict[str, Any] = {"arrowstyle": "<|-|>,head_length=0.35,head_width=0.12", "color": "0.3", "linewidth": 0.7}
GROUND: dict[str, Any] = {"color": "black", "markersize": 7.0, "zorder": 4}
WIDE_NAME = 26  # letters in a line


def plot_to_scale(system: Any) -> Axes:
    """Return a drawing of a system at rest, true to scale.

    Lengths and masses are written at up to 8 links, or 12 groups of equal links. Symbols of small bodies are not to scale.
    A system whose ends are held a span apart is drawn as an arc of its length; a governor with its arms half-way between
    its stops, or without stops at 30 degrees.

    Examples
    --------
    >>> import revchain as rc
    >>> from revchain.plots.scale import plot_to_scale
    >>> ax = plot_to_scale(rc.Chain(mass=[2500, 400], length=[6, 24], names=["load", "hook block"]))
    >>> [text.get_text() for text in ax.texts if "kg" in text.get_text()]
    ['load, 2500 kg', 'hook block, 400 kg']
    """
    if not hasattr(system, "_base"):
        return _governor(system)
    if getattr(system, "span", None) is not None:
        return _bent(system)
    return _Drawing(system).drawn()


class _Page:
    """Axes in true proportions without a frame, whose texts keep their distance from the drawing in points."""

    def __init__(self, left: float, right: float, low: float, high: float) -> None:
        wide, tall = max(right - left, 1e-12), max(high - low, 1e-12)
        self.inch = max(tall / TALL, wide / WIDE)  # metres on an inch of paper
        figure = new_figure(max(wide / self.inch, 0.6), max(tall / self.inch, 0.6))
        figure.set_layout_engine("none")
        self.ax = figure.add_axes((0.0, 0.0, 1.0, 1.0))
        self.ax.set_axis_off()
        extra = max(0.6 * self.inch - wide, 0.0) / 2, max(0.6 * self.inch - tall, 0.0) / 2
        self.ax.set(xlim=(left - extra[0], right + extra[0]), ylim=(low - extra[1], high + extra[1]))

    def dimension(self, begin: tuple[float, float], end: tuple[float, float], text: str, away: float, at: float | None = None) -> None:
        """Draw a dimension line between two points, moved away (upright ones to the left), with its text at a level."""
        upright = begin[0] == end[0]
        moved = moved_by(self.ax, -away, 0.0) if upright else moved_by(self.ax, 0.0, away)
        near = moved_by(self.ax, -away - 3, 0.0) if upright else moved_by(self.ax, 0.0, away + 3)
        arrow = DIMENSION | {"shrinkA": 0.0, "shrinkB": 0.0}
        self.ax.annotate("", end, begin, xycoords=moved, textcoords=moved, arrowprops=arrow, annotation_clip=False)
        for point in (begin, end):  # extension lines
            self.ax.annotate(
                "", point, point, xycoords=near, textcoords=moved_by(self.ax, -4, 0) if upright else moved_by(self.ax, 0, 4),
                arrowprops={"arrowstyle": "-", "color": "0.6", "linewidth": 0.5, "shrinkA": 0.0, "shrinkB": 0.0}, annotation_clip=False,
            )  # fmt: skip
        middle = ((begin[0] + end[0]) / 2, (begin[1] + end[1]) / 2 if at is None else at)
        place = moved_by(self.ax, -away - 5, 0.0) if upright else moved_by(self.ax, 0.0, away + 4)
        align: dict[str, Any] = {"ha": "right", "va": "center"} if upright else {"ha": "center", "va": "bottom"}
        box = {"facecolor": "white", "edgecolor": "none", "pad": 0.5}
        self.ax.annotate(text, middle, xycoords=place, fontsize=LETTERS, color="0.15", bbox=box, annotation_clip=False, **align)

    def names(self, x: float, levels: Any, texts: list[str]) -> None:
        """Write texts beside points at a distance x from the axis, apart from each other, each with a line to its point."""
        import textwrap

        folded = [textwrap.fill(text, WIDE_NAME) for text in texts]
        lines = max((text.count("\n") + 1 for text in folded), default=1)
        gap = 1.35 * lines * LETTERS / 72 * self.inch
        for level, place, text in zip(levels, apart(levels, gap), folded, strict=True):
            moved = abs(place - level) > 0.2 * gap
            self.ax.annotate(
                plain(text), (x, level), (x, place), xycoords=moved_by(self.ax, 7, 0), textcoords=moved_by(self.ax, 20 if moved else 10, 0),
                fontsize=LETTERS, va="center", ha="left", annotation_clip=False,
                arrowprops={"arrowstyle": "-", "color": "0.6", "linewidth": 0.5, "shrinkA": 1.0, "shrinkB": 0.0} if moved else None,
            )  # fmt: skip


class _Drawing:
    """A chain, rig or cord, or one that is held straight."""

    def __init__(self, system: Any) -> None:
        self.system, self.base, self.straight = system, system._base, Straight(system)
        self.level: Floats = self.straight.height
        self.support = system._support
        self.radius = float(self.support.radius) if self.support is not None else 0.0
        low, high = float(self.level.min()), float(self.level.max())
        self.size = max(high - low, abs(self.radius))
        stands = system._stands
        run = np.concatenate([[0], np.cumsum(stands[1:] != stands[:-1])])
        self.posture = run  # of each link, the number of its run of links that all hang or all stand
        self.across: Floats = self.radius + FOLD * self.size * (run[-1] - run)  # of each link
        self.reach = np.zeros(self.base.size)  # of each body to either side
        if self.straight.few:
            self.reach[self._wheels()] = WHEEL * self.size
            for k, (form, unit, _) in self.straight._forms.items():
                self.reach[k] = extent_of(form)[0] * unit
        self.runs = [] if system._is_cord else self._runs()

    def _runs(self) -> list[tuple[int, int]]:
        """The first and the last number of each run of equal links; of each link if they are few, none if they are many."""
        base, size = self.base, self.base.size
        if size <= FEW:
            return [(k, k) for k in range(size)]
        columns = [np.broadcast_to(column, size) for column in (base._compiled.weight, base.length, base.centroid, self.posture)]
        new = np.any([column[1:] != column[:-1] for column in columns], axis=0)
        if base.names is not None:
            new |= np.array(base.names[1:]) != np.array(base.names[:-1])
        first = np.concatenate([[0], np.flatnonzero(new) + 1, [size]])
        return [(int(a), int(b) - 1) for a, b in zip(first[:-1], first[1:], strict=True)] if first.size <= MOST_TEXTS + 1 else []

    def _wheels(self) -> Any:
        """Return whether each link has a flywheel with momentum, drawn as a bar."""
        return (self.system._momentum(1.0) != 0) & ~np.isin(np.arange(self.base.size), [*self.straight._forms])

    def drawn(self) -> Axes:
        low, high = float(self.level.min()), float(self.level.max())
        if self.straight.few:
            middle, half = self._middles(), rods_of(self.base)
            low, high = min(low, float((middle - half).min())), max(high, float((middle + half).max()))
        left, right = (float(np.max(side, initial=0.0)) for side in (self.reach - self.across, self.reach + self.across))
        page = _Page(min(-left, self.radius), max(right, self.radius), low, high)
        ax = page.ax
        ax.plot([0.0, 0.0], [high + 0.03 * self.size, low - 0.03 * self.size], clip_on=False, **AXIS)
        if self.system._fluid:
            ax.axhspan(low - 0.05 * self.size, high + 0.05 * self.size, color=FLUID, zorder=0)
        if self.system._is_cord:
            self._cord(page)
        else:
            self._links(page)
        self._supports(page)
        self._dimensions(page)
        return ax

    def _middles(self) -> Floats:
        along = np.sign(self.level[:-1] - self.level[1:])
        return np.asarray(self.level[1:] + along * self.base.centroid)

    def _links(self, page: _Page) -> None:
        """Draw links and bodies, with names and masses to their right."""
        ax, straight, level, across = page.ax, self.straight, self.level, self.across
        middle, weight = self._middles(), np.broadcast_to(self.base._compiled.weight, self.base.size)
        said = np.where(weight > 0, middle, (level[:-1] + level[1:]) / 2)  # threads have no body
        beside = float((across + self.reach).max())
        page.names(
            beside, [float(np.mean(said[first : last + 1])) for first, last in self.runs],
            [self._said(first, last - first + 1) for first, last in self.runs],
        )  # fmt: skip
        if not straight.few:
            ax.plot([self.radius] * 2, level[[0, -1]], color=LINK, linewidth=2.0, clip_on=False)
            return
        stands, forms, backward = self.system._stands, straight._forms, self.system._momentum(1.0) < 0
        bare = ~np.isin(np.arange(self.base.size), [*forms])
        drawn = [k for k in range(self.base.size) if k not in forms or not table()["bodies"][forms[k][0]].get("bare")]
        ax.vlines(
            across[drawn], level[:-1][drawn], level[1:][drawn], color=LINK, linewidth=np.where(stands, 3.0, 1.3)[drawn], clip_on=False
        )
        turns = np.flatnonzero(np.diff(across)) + 1
        ax.hlines(level[turns], across[turns], across[turns - 1], color=LINK, linewidth=1.3)
        half = rods_of(self.base)
        long = (weight > 0) & (half > 0) & bare
        ax.vlines(across[long], (middle - half)[long], (middle + half)[long], clip_on=False, **ROD)
        for k, (form, unit, _) in forms.items():
            draw_form(ax, form, across[k], math.inf, partial(self._levels, k), unit, bool(backward[k]))
        for patch in ax.patches:
            patch.set_clip_on(False)
        dots = (weight > 0) & bare & ~long
        sizes = 20 + 60 * np.sqrt(weight / max(float(weight.max()), 1e-300))
        face = np.where(floating(self.system), "white", LINK)
        ax.scatter(across[dots], middle[dots], s=sizes[dots], c=face[dots], edgecolors=LINK, zorder=3, clip_on=False)
        ax.plot(across[:-1], level[1:-1], clip_on=False, **JOINT)
        for wheel in np.flatnonzero(self._wheels()).tolist():
            ends = across[wheel] - WHEEL * self.size, across[wheel] + WHEEL * self.size
            ax.hlines(middle[wheel], *ends, color=BACKWARD if backward[wheel] else FORWARD, linewidth=3.5, zorder=3)

    def _levels(self, link: int, along: Floats) -> Floats:
        """Heights of distances along the body of a link; the pictures of modes count depths."""
        level = self.straight._levels(link, along)
        return level if self.straight.upwards else -level

    def _said(self, link: int, count: int) -> str:
        """The name and the mass of a link, or of so many equal ones."""
        names, base = self.base.names, self.base
        amount = float(np.broadcast_to(base.mass if self.system.by_mass else base.weight, base.size)[link])
        mass = f"{amount:.4g}{' kg' if self.system.by_mass else ' N'}" if amount else "no mass"
        name = names[link] if names is not None and names[link] else ""
        return (f"{count} × " if count > 1 else "") + (f"{name}, {mass}" if name else mass)

    def _cord(self, page: _Page) -> None:
        """Draw a cord, its bob and its point masses."""
        ax, cord, level = page.ax, self.base, self.level
        ax.plot([self.radius] * 2, level[[0, -1]], color=LINK, linewidth=2.2, clip_on=False)
        unit = "kg" if cord.by_mass else "N"
        places = np.array([*cord._particles], float)
        heights = np.interp(places, np.linspace(0, cord.length, level.size), level)
        texts = [f"{mass:.4g} {unit}" for mass in cord._particles.values()]
        ax.scatter(np.full(places.size, self.radius), heights, s=36, c=LINK, zorder=3, clip_on=False)
        tip = cord.tip_mass if cord.by_mass else cord.tip_weight
        if tip:
            ax.scatter([self.radius], level[:1], s=60, c=LINK, zorder=3, clip_on=False)
            heights, texts = np.append(heights, level[0]), [*texts, f"bob, {tip:.4g} {unit}"]
        weight = cord.mass if cord.by_mass else cord.weight
        heights, texts = np.append(heights, level.mean()), [*texts, f"cord, {weight:.4g} {unit}"]
        page.names(self.radius, heights, texts)

    def _supports(self, page: _Page) -> None:
        ax, support, top = page.ax, self.support, float(self.level[-1])
        at = float(self.across[-1]) if self.across.size else self.radius
        stands = bool(self.system._stands.all()) and not self.system._is_held
        if self.system._is_held:
            for level in self.level[[0, -1]]:
                ax.plot(0.0, level, marker="o", clip_on=False, **GROUND)
            return
        yields = support is not None and support._yields
        wall = at - 0.14 * self.size * (1.0 if at >= 0 else -1.0)
        if self.radius:
            ax.plot([0.0, wall if yields else at], [top, top], clip_on=False, **BAR)
            ax.plot(0.0, top, marker="o", color="black", markersize=4.0, zorder=4, clip_on=False)
        if not yields:
            ax.plot(at, top, marker="^" if stands else "v", clip_on=False, **GROUND)
            return
        if support.stiffness == 0:
            ax.hlines(top + 0.02 * self.size, at - 0.1 * self.size, at + 0.1 * self.size, color=LINK, linewidth=1.5, clip_on=False)
        else:
            draw_spring(ax, wall, at, self.size)
            if not self.radius:
                ax.vlines(wall, top - 0.03 * self.size, top + 0.03 * self.size, color="black", linewidth=2.5, clip_on=False)
        ax.plot(at, top, marker="s", color="black", markersize=7.0, zorder=4, clip_on=False)

    def _dimensions(self, page: _Page) -> None:
        """Draw the length of each link or run of links, and of the whole, and the radius of an arm."""
        level, size = self.level, self.base.size
        left = float(np.max(self.reach - self.across + self.radius, initial=0.0))
        away = 16.0 + left / page.inch * 72
        if self.support is not None and self.support._yields and not self.radius:
            away = max(away, 20.0 + 0.14 * self.size / page.inch * 72)
        x = self.radius
        lengths, turned = np.broadcast_to(self.base.length, max(size, 1)), len({*self.posture.tolist()}) > 1
        for posture in sorted({*self.posture.tolist()}, reverse=True) if self.runs else ():
            runs = [run for run in self.runs if self.posture[run[0]] == posture]
            gap = 1.35 * LETTERS / 72 * page.inch
            places = apart([(level[first] + level[last + 1]) / 2 for first, last in runs], gap)
            longest = 0
            for (first, last), at in zip(runs, places, strict=True):
                count = last - first + 1
                text = (f"{count} × " if count > 1 else "") + f"{lengths[first]:.4g} m"
                longest = max(longest, len(text))
                page.dimension((x, float(level[last + 1])), (x, float(level[first])), text, away, float(at))
            away += 14 + 0.62 * LETTERS * longest
        if len(self.runs) != 1 and not turned or (self.runs and self.runs[0][1] > 0 and not turned):
            page.dimension((x, float(level[-1])), (x, float(level[0])), f"{float(np.sum(lengths)):.4g} m", away)
        if self.radius:
            page.dimension((0.0, float(level[-1])), (self.radius, float(level[-1])), f"{abs(self.radius):.4g} m", 14.0)


def _bent(system: Any) -> Axes:
    """A chain or cord between two ends, as an arc of its length."""
    base, ends = system._base, [float(end.radius) for end in (system.lower, system.upper)]
    chord = math.hypot(system.span, ends[1] - ends[0])
    length = max(float(np.sum(np.broadcast_to(base.length, max(base.size, 1)))), chord * (1 + 1e-9))
    low, high = 1e-6, math.pi
    for _ in range(80):  # half the angle of the arc
        middle = (low + high) / 2
        low, high = (middle, high) if math.sin(middle) / middle > chord / length else (low, middle)
    angle = np.linspace(-low, low, 181)
    radius = length / (2 * low)
    along, out = radius * np.sin(angle) / chord, radius * (np.cos(angle) - math.cos(low)) / chord
    run, rise = ends[1] - ends[0], system.span
    x, y = ends[0] + along * run + out * rise + 0.5 * run, along * rise - out * run + 0.5 * rise
    page = _Page(min(0.0, float(x.min())), float(x.max()), float(y.min()), float(y.max()))
    ax = page.ax
    ax.plot([0.0, 0.0], [float(y.min()) - 0.03 * rise, float(y.max()) + 0.03 * rise], clip_on=False, **AXIS)
    ax.plot(x, y, color=LINK, linewidth=2.0, clip_on=False)
    if 1 < base.size <= 60:
        pins = np.linspace(0, 180, base.size + 1).round().astype(int)
        ax.plot(x[pins[1:-1]], y[pins[1:-1]], clip_on=False, **JOINT)
    for end, level in zip(ends, (0.0, rise), strict=True):
        ax.plot(end, level, marker="o", clip_on=False, **GROUND)
        if end:
            ax.plot([0.0, end], [level, level], clip_on=False, **BAR)
            page.dimension((0.0, level), (end, level), f"{abs(end):.4g} m", 10.0)
    heavy = float(np.sum(np.broadcast_to(base.mass if base.by_mass else base.weight, max(base.size, 1))))
    links = f"{base.size} links, " if base.size else ""
    page.names(float(x.max()), [rise / 2], [f"{links}{length:.4g} m long, {heavy:.4g} {'kg' if base.by_mass else 'N'}"])
    page.dimension((min(0.0, float(x.min())), 0.0), (min(0.0, float(x.min())), rise), f"{rise:.4g} m", 16.0)
    return ax


def _governor(governor: Any) -> Axes:
    """A governor with its arms half-way between its stops, or at 30 degrees."""
    given = governor._given
    stops = given["lowest_inclination"], given["highest_inclination"]
    angle = math.radians(30) if None in stops else sum(stops) / 2
    arm, pivot, lower, crank = given["arm"], given["pivot_offset"], given["lower_arm"], given["sleeve_arm"]
    up = 1.0 if crank else -1.0
    ball = pivot + arm * math.sin(angle), up * arm * math.cos(angle)
    sleeve = joint = end = None
    if lower:
        part = given["joint"] or arm
        joint = pivot + part * math.sin(angle), -part * math.cos(angle)
        aside = joint[0] - given["sleeve_offset"]
        if abs(aside) < lower:
            end = given["sleeve_offset"], joint[1] - math.sqrt(lower * lower - aside * aside)
    elif crank:
        joint, end = (pivot, 0.0), (pivot - crank * math.cos(angle), crank * math.sin(angle))
    lowest = min(0.0, ball[1], end[1] if end else 0.0)
    highest = max(0.0, ball[1], end[1] if end else 0.0)
    tall = highest - lowest
    reach = ball[0] + 0.05 * tall
    page = _Page(-reach, reach, lowest - 0.06 * tall, highest + 0.06 * tall)
    ax = page.ax
    ax.vlines(0.0, lowest - 0.12 * tall, highest + 0.06 * tall, color="0.75", linewidth=4.0, zorder=0.5)
    ax.plot([0.0, 0.0], [lowest - 0.14 * tall, highest + 0.1 * tall], clip_on=False, **AXIS)
    for side in (-1, 1):
        ax.plot([0.0, side * pivot], [0.0, 0.0], **BAR)
        ax.plot([side * pivot, side * ball[0]], [0.0, ball[1]], color=LINK, linewidth=2.0)
        if joint and end:
            ax.plot([side * joint[0], side * end[0]], [joint[1], end[1]], color=LINK, linewidth=2.0)
            ax.plot(side * joint[0], joint[1], clip_on=False, **JOINT)
        ax.plot(side * ball[0], ball[1], "o", color=LINK, markersize=13, clip_on=False, zorder=3)
    texts = [(ball[1], f"ball, {given['ball_mass']:.4g} kg"), (ball[1] / 2, f"arm, {arm:.4g} m, drawn at {math.degrees(angle):.4g}°")]
    if end:
        sleeve = end[1]
        wide, deep = max(abs(end[0]), 0.07 * tall), 0.05 * tall
        ax.fill_between([-wide, wide], sleeve - deep, sleeve + deep / 3, color="0.45", zorder=2)
        length = f"link, {lower:.4g} m" if lower else f"lever to the sleeve, {crank:.4g} m"
        texts += [(((joint or end)[1] + sleeve) / 2, length), (sleeve - deep / 2, f"sleeve, {given['sleeve_mass']:.4g} kg")]
    page.names(ball[0] + 0.04 * tall, [level for level, _ in texts], [text for _, text in texts])
    if pivot:
        page.dimension((0.0, 0.0), (pivot, 0.0), f"{pivot:.4g} m", 8.0)
    return ax
