# SPDX-License-Identifier: GPL-3.0-or-later
"""The film of each kind of result that moves: what is drawn, how large, how fast."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import singledispatch
from typing import Any

import numpy as np

from ..plots.modes import MOST_SHAPES, Straight, floating, rods_of, rows_of
from ..plots.branches import words_of
from ..plots.forms import form_of
from ..plots.style import CAPTION_UNITS, MOST_PINS_AS_DOTS, thinned, with_speeds
from ..results.base import Listed
from ..results.branches import Branch, Branches
from ..results.modes import Modes
from ..results.motions import Response, Swing
from ..results.shapes import SteadyShape, SteadyShapes
from ..results.sheet import digits
from ..systems.chain import are_rods
from ..systems.numbers import Floats, listed, one_positive, place_of
from .film import Bodies, Chart, Complex, Figure, Film

TURN = 2 * math.pi
CORD_POINTS = 101
LONGEST, FOR_A_SWEEP = 10.0, 12.0  # seconds of film, unless the caller chooses
SLOWEST_TURN, FASTEST_TURN = 4.0, 0.8  # seconds of film
MOST_FRAMES = 20_000
FEWEST_RINGS = 8
MOST_STAGES = 150  # points of a branch whose shapes are computed
Turning = tuple[str, Any, Floats, float, float]  # label, offsets, heights, speed, and what offsets are multiplied by


@dataclass(frozen=True)
class Choices:
    """The choices of the caller for a film."""

    caller: str
    frames_per_second: float = 25.0
    figures: Iterable[int] | None = None
    time_scale: float | None = None
    duration: float | None = None

    def __post_init__(self) -> None:
        for name in ("time_scale", "duration"):
            if (value := getattr(self, name)) is not None:
                object.__setattr__(self, name, one_positive(self.caller, name, value))

    def only_one(self) -> None:
        if self.figures is not None:
            raise ValueError(f"{self.caller}: figures is for several modes, shapes or branches; leave it out here")

    def among(self, found: Any, what: str, first: int = 0) -> list[tuple[str, Any]]:
        """The chosen items of a list, each with a label that counts from `first`."""
        if not isinstance(found, Listed):
            self.only_one()
            return [("", found)]
        count = len(found)
        if not count:
            raise ValueError(f"{self.caller}: there is no {what} to draw")
        if self.figures is None:
            chosen = list(range(min(count, MOST_SHAPES)))
        else:
            numbers = listed(self.caller, "figures", self.figures)
            chosen = [place_of(self.caller, "figures", each, count) for each in numbers]
        if not chosen:
            raise ValueError(f"{self.caller}: figures names no {what}")
        return [(f"{what} {k + first}", found[k]) for k in chosen]

    def frames(self, seconds: float) -> int:
        """Return the number of frames in a film of so many seconds; refuse too many."""
        if seconds * self.frames_per_second > MOST_FRAMES:
            raise ValueError(
                f"{self.caller}: duration times frames_per_second must be at most {MOST_FRAMES}, "
                f"got {seconds:g} s at {self.frames_per_second:g}"
            )
        return max(2, round(seconds * self.frames_per_second))


@singledispatch
def staged(result: Any, choices: Choices) -> Film:
    """Return the film of a result."""
    raise TypeError(f"{choices.caller}: a {type(result).__name__} does not move")


# ---- what turns at a constant speed


@staged.register
def _(modes: Modes, choices: Choices) -> Film:
    rows = rows_of(choices.caller, modes, choices.figures)
    straight = Straight(modes.system)
    height = np.asarray(straight.height, float)
    largest = _reach_of_small(height, len(rows))
    both = bool(getattr(modes, "has_momentum", False))
    named: list[Turning] = []
    for row in rows:
        shape = np.asarray(np.real(modes.shape[row]), float)
        way = (" forward" if modes.angular_speed[row] > 0 else " backward") * both
        scale = largest / np.abs(shape).max()
        named.append((f"mode {modes.number[row]}{way}", shape, height, float(modes.angular_speed[row]), scale))
    return replace(_turning(modes, named, choices), note="offsets exaggerated")


@staged.register
def _(found: SteadyShape | SteadyShapes, choices: Choices) -> Film:
    named: list[Turning] = []
    for label, shape in choices.among(found, "shape", first=1):
        offset, height = _bent(shape)
        speed = shape.angular_speed * shape.direction
        named.append((f"{label}\n{shape._waves}".strip(), offset, height, speed, 1.0))
    return _turning(found, named, choices)


def _bent(shape: Any) -> tuple[Floats, Floats]:
    """Offsets and heights of the pins, or of points of a cord equally far apart."""
    if not hasattr(shape, "arc_length"):
        return shape.offset, shape.height
    points = shape.along(np.linspace(0.0, shape.system.length, CORD_POINTS))
    return points.offset, points.height


def _turning(result: Any, named: list[Turning], choices: Choices) -> Film:
    """Return the film of figures that keep their shape and turn at constant speeds."""
    period = np.array([TURN / abs(speed) for *_, speed, _ in named if speed])
    slow, fast = (float(period.max()), float(period.min())) if period.size else (SLOWEST_TURN, SLOWEST_TURN)
    scale = choices.time_scale or min(slow / SLOWEST_TURN, fast / FASTEST_TURN)
    seconds = min(slow / scale, LONGEST) if choices.duration is None else choices.duration
    frames = choices.frames(seconds)
    turns = math.floor(seconds * scale / slow * (1 + 1e-9))
    if choices.time_scale is None and turns:
        scale = turns * slow * choices.frames_per_second / frames  # the slowest ends where it began
    time = scale * np.arange(frames) / choices.frames_per_second
    figures = []
    for label, offset, height, speed, larger in named:
        scales, phase = np.array([larger]), np.asarray(speed * time)
        captions = with_speeds([label], [speed], CAPTION_UNITS)
        drawn = larger * offset[None] + 0j
        figures.append(Figure(label, drawn, height[None], scales, phase, np.array([speed]), tuple(captions)))
    return _film(result, figures, choices, scale)


# ---- what changes along a branch, or with the speed


@staged.register
def _(found: Branch | Branches, choices: Choices) -> Film:
    chosen = choices.among(found, "branch")
    first = chosen[0][1]
    quantity = "tip_radius" if hasattr(first, "tip_radius") else "largest_offset"
    stages = []
    curves = []
    for _, branch in chosen:
        points = _stages(len(branch), branch.folds)
        rows = [_bent(shape) if (shape := _shape_or_none(branch, k)) is not None else None for k in points.tolist()]
        straight = Straight(branch.system).height if None in rows else np.empty(0)
        if None in rows and branch.system._is_cord:
            straight = np.linspace(straight[0], straight[-1], CORD_POINTS)
        rows = [(np.zeros_like(straight), straight) if row is None else row for row in rows]
        offset, height = (np.array(part) for part in zip(*rows, strict=True))
        speed = branch.angular_speed[points]
        moved = np.hypot(np.diff(offset, axis=0), np.diff(height, axis=0)).max(axis=1) / np.ptp(height, axis=1).max()
        steps = moved + np.abs(np.diff(speed)) / speed.max()
        way = np.concatenate([[0.0], np.cumsum(steps)])
        stages.append(_Stages(way, offset + 0j, height, speed * branch.direction, np.ones(speed.size)))
        curves.append(getattr(branch, quantity)[points])
    labels = [label for label, _ in chosen]
    return _swept(found, labels, stages, choices, words_of(quantity, first.system.by_mass), curves, "Along branch")


def _stages(count: int, folds: Any) -> Any:
    """Indices of the points of a branch that are drawn, with its folds."""
    even = np.linspace(0, count - 1, min(count, MOST_STAGES)).round().astype(int)
    return np.unique(np.concatenate([even, np.asarray(folds, int)]))


def _shape_or_none(branch: Any, point: int) -> Any:
    try:
        return branch.shape(point)
    except ValueError:
        return None


@staged.register
def _(found: Response, choices: Choices) -> Film:
    choices.only_one()
    if found.pins.shape != (found.system.size + 1,) or not np.array_equal(found.pins, np.arange(found.pins.size)):
        raise ValueError(f"{choices.caller}: every pin is needed; compute the response without pins=")
    height = Straight(found.system).height
    speed, offset = found.angular_speed.reshape(-1), found.offset.reshape(-1, found.pins.size)
    known = np.isfinite(offset).all(axis=1)
    if not known.any():
        raise ValueError(f"{choices.caller}: there is no speed to draw that is not a resonance")
    order = np.argsort(speed[known])
    speed, offset = speed[known][order], offset[known][order]
    largest, most = _reach_of_small(height, 1), np.abs(offset).max(axis=1)
    scale = np.minimum(largest / np.quantile(most, 0.75), largest / most)
    if speed.size == 1:
        label = "carried round" if found.force is None else "pushed"
        film = _turning(found, [(label, offset[0], height, float(speed[0]), float(scale[0]))], choices)
        captions = tuple(each + _larger(float(scale[0])) for each in film.figures[0].captions)
        return replace(film, figures=(replace(film.figures[0], captions=captions),))
    rows = np.broadcast_to(height, offset.shape)
    stages = _Stages(np.arange(speed.size, dtype=float), offset * scale[:, None] + 0j, rows, speed, scale)
    return _swept(found, ["carried round" if found.force is None else "pushed"], [stages], choices, "largest distance from axis (m)", [most], "Speed")


@dataclass(frozen=True)
class _Stages:
    """Shapes through which a figure goes, as drawn, each with its distance along the way."""

    way: Floats
    offset: Complex
    height: Floats
    speed: Floats
    scale: Floats


def _swept(
    result: Any,
    labels: list[str],
    stages: list[_Stages],
    choices: Choices,
    quantity: str,
    curves: list[Floats],
    progress: str,
) -> Film:
    """Figures that go through stages, turning as fast as each stage does."""
    frames = choices.frames(FOR_A_SWEEP if choices.duration is None else choices.duration)
    fastest = max(float(np.abs(each.speed).max()) for each in stages)
    time_scale = choices.time_scale or TURN / fastest / FASTEST_TURN
    figures, x, y, lines = [], [], [], []
    for label, each, curve in zip(labels, stages, curves, strict=True):
        at = np.linspace(0.0, each.way[-1], frames)
        speed, scale = (np.interp(at, each.way, values) for values in (each.speed, each.scale))
        turned = np.cumsum((speed[1:] + speed[:-1]) / 2) * time_scale / choices.frames_per_second
        captions = [text.strip() for text in with_speeds([label] * frames, speed.tolist(), CAPTION_UNITS)]
        if (each.scale != 1).any():
            captions = list(map(str.__add__, captions, map(_larger, scale.tolist())))
        offset = _between(at, each.way, each.offset)
        height = _between(at, each.way, each.height)
        figures.append(Figure(label, offset, height, scale, np.concatenate([[0.0], turned]), speed, tuple(captions)))
        drawn = thinned(curve)
        way = -1.0 if (each.speed <= 0).all() else 1.0  # a branch of backward rotation is drawn as one of forward
        lines.append((way * each.speed[drawn], curve[drawn]))
        x.append(way * speed)
        y.append(np.interp(at, each.way, curve))
    said = [f"{progress}es: {percent:.0f} %" for percent in np.linspace(0.0, 100.0, frames)]
    if len(figures) == 1:
        said = [f"{progress}: {digits(now, 3)} rad/s" for now in x[0].tolist()]
    chart = Chart("speed (rad/s)", quantity, tuple(lines), tuple(x), tuple(y))
    return _film(result, figures, choices, time_scale, chart, said)


def _larger(by: float) -> str:
    """The line of a caption that says how much larger than the links offsets are drawn."""
    return f"\noffsets {by:.3g}:1"


def _between(at: Floats, way: Floats, rows: Any) -> Any:
    """Interpolate the rows of the stages linearly at these distances along the way."""
    after = np.clip(np.searchsorted(way, at, side="right"), 1, max(way.size - 1, 1))
    if way.size == 1:
        return np.repeat(rows, at.size, axis=0)
    gap = way[after] - way[after - 1]
    part = np.divide(at - way[after - 1], gap, out=np.zeros_like(at), where=gap > 0)[:, None]
    return rows[after - 1] * (1 - part) + rows[after] * part


# ---- what swings


@staged.register
def _(found: Swing, choices: Choices) -> Film:
    def at(time: Floats) -> Complex:
        if found.exponent is not None:
            return _between_moments(found, time)
        whole = (np.exp(1j * np.outer(time, found.angular_frequency)) * found.amplitude) @ found.shape
        return np.asarray(whole if found.offset.dtype.kind == "c" else whole.real, np.complex128)

    cord = found.arc_length is not None
    height = found.arc_length - found.system.length if cord else Straight(found.system).height
    choices.only_one()
    first, last = float(found.time.min(initial=np.inf)), float(found.time.max(initial=-np.inf))
    if not first < last:
        raise ValueError(f"{choices.caller}: the swing needs two times or more, the first and the last of the film")
    seconds = choices.duration or min(
        (last - first) / (choices.time_scale or 1.0), LONGEST if choices.time_scale is None else np.inf
    )
    frames = choices.frames(seconds)
    time_scale = choices.time_scale or (last - first) / seconds
    time = np.minimum(first + np.arange(frames) / choices.frames_per_second * time_scale, last)
    offset = at(time)
    most, deep = float(np.abs(offset).max()), float(np.ptp(height))
    scale = 1.0 if 0.1 * deep <= most <= 0.35 * deep or not most else _reach_of_small(height, 1) / most
    captions = ("true to scale" if scale == 1 else f"offsets {scale:.3g}:1",)
    still = np.zeros(frames)
    figure = Figure("swing", scale * offset, height[None], np.full(frames, scale), still, np.zeros(1), captions)
    return _film(found, [figure], choices, time_scale, progress=[f"Time: {now:.3f} s" for now in time.tolist()])


def _between_moments(found: Swing, time: Floats) -> Complex:
    """Offsets between the times of a swing, by Hermite's cubics."""
    when, first = np.unique(found.time, return_index=True)
    offset, velocity = found.offset[first], found.velocity[first]
    after = np.clip(np.searchsorted(when, time, side="right"), 1, when.size - 1)
    gap = (when[after] - when[after - 1])[:, None]
    u = (time - when[after - 1])[:, None] / gap
    start, end = offset[after - 1], offset[after]
    rise, slope = end - start, velocity[after - 1] * gap
    bend = velocity[after] * gap + slope - 2 * rise
    return np.asarray(start + u * (slope + u * (rise - slope - (1 - u) * bend)), np.complex128)


# ---- what all films have


def _reach_of_small(height: Floats, count: int) -> float:
    """The distance from the axis at which offsets of small amplitude are drawn."""
    return float(np.ptp(height)) * min(0.25, 0.9 / (count + 1))


def _film(
    result: Any,
    figures: list[Figure],
    choices: Choices,
    time_scale: float,
    chart: Chart | None = None,
    progress: Sequence[str] = (),
) -> Film:
    system = result.system
    base = system._base
    few = not system._is_cord and base.size <= MOST_PINS_AS_DOTS
    names: tuple[str, ...] = ()
    if not system._is_cord:
        names = tuple(f"links[{k}]" for k in system._link_numbers)
        if base.names is not None:
            names = tuple(f"{number} {name}" for number, name in zip(names, base.names, strict=True))
    gravity = 0.0 if system._is_held and system.weightless else float(result.gravity)
    return Film(
        system=repr(system),
        gravity=gravity,
        figures=tuple(figures),
        bodies=_bodies(system, base) if few or system._is_cord else Bodies(),
        frames_per_second=choices.frames_per_second,
        time_scale=time_scale,
        names=names,
        stout=np.broadcast_to(system._stands, figures[0].offset.shape[1] - 1),
        rings=np.broadcast_to(_rings(system, base), figures[0].offset.shape[1] - 1),
        shows_pins=few,
        is_held=system._is_held,
        chart=chart,
        progress=tuple(progress),
    )


def _bodies(system: Any, base: Any) -> Bodies:
    if system._is_cord:
        if not base._compiled.tip_weight:
            return Bodies()
        one, none = np.ones(1), np.zeros(1)
        return Bodies(np.zeros(1, int), one, one, none, none, np.zeros(1, bool), none, ("",))
    weight = np.broadcast_to(base._compiled.weight, base.size)
    wheels = system._wheels
    link = np.flatnonzero((weight > 0) | wheels)
    arrays = {
        "along": base.centroid / base.length,
        "size": np.cbrt(weight / weight.max()),
        "rod": rods_of(base) / base.length,
        "wheel": np.where(system._momentum(1.0) < 0, -1.0, wheels),
        "floats": floating(system),
        "gyration": base.radius_of_gyration,
    }
    names = base.names or ("",) * base.size
    form = tuple(form_of(names[k]) or ("wheel" if wheels[k] else "") for k in link.tolist())
    return Bodies(link, **{name: np.asarray(array)[link] for name, array in arrays.items()}, form=form)


def _rings(system: Any, base: Any) -> Any:
    """Whether each link is one of many uniform rods, which are drawn as rings."""
    if system._is_cord:
        return False
    rod = are_rods(base.length, base.centroid, base.radius_of_gyration)
    return rod & (np.count_nonzero(rod) >= FEWEST_RINGS) & ~system._stands & ~system._wheels
