# SPDX-License-Identifier: GPL-3.0-or-later
"""The film of each kind of result: what is drawn, how large, how fast."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from functools import singledispatch
from typing import Any

import numpy as np

from ..plots.modes import MOST_SHAPES, Straight, floating, rows_of
from ..plots.shapes import words_of
from ..plots.style import MOST_PINS_AS_DOTS, thinned
from ..results.branches import Branch, Branches
from ..results.modes import Modes
from ..results.motions import Response, Swing
from ..results.shapes import SteadyShape, SteadyShapes
from ..results.sheet import digits
from ..systems.numbers import Floats, listed, place_of
from .film import Bodies, Chart, Complex, Figure, Film

TURN = 2 * math.pi
PLACES = 101  # of a cord
LONGEST, FOR_A_SWEEP = 10.0, 12.0  # seconds of film, unless asked
SLOWEST_TURN, FASTEST_TURN = 4.0, 0.8  # seconds of film
MOST_FRAMES = 20_000
MOST_STAGES = 150  # of a branch that are asked for
Turning = tuple[str, Any, Floats, float, float]  # label, offsets, heights, speed, and what offsets are multiplied by


@dataclass(frozen=True)
class Asked:
    """The caller's choices for a film."""

    place: str
    figures: Iterable[int] | None
    time_scale: float | None
    duration: float | None
    frames_per_second: float

    def only_one(self) -> None:
        """Refuse a choice of figures where the result is a single one."""
        if self.figures is not None:
            raise ValueError(f"{self.place}: figures is for several modes, shapes or branches; leave it out here")

    def among(self, count: int, what: str) -> list[int]:
        """Indices of the chosen items of a list."""
        if not count:
            raise ValueError(f"{self.place}: there is no {what} to draw")
        if self.figures is None:
            return list(range(min(count, MOST_SHAPES)))
        chosen = [place_of(self.place, "figures", each, count) for each in listed(self.place, "figures", self.figures)]
        if not chosen:
            raise ValueError(f"{self.place}: figures names no {what}")
        return chosen

    def frames(self, seconds: float) -> int:
        """The number of frames in a film of this length."""
        if seconds * self.frames_per_second > MOST_FRAMES:
            raise ValueError(
                f"{self.place}: duration times frames_per_second must be at most {MOST_FRAMES}, "
                f"got {seconds:g} s at {self.frames_per_second:g}"
            )
        return max(2, round(seconds * self.frames_per_second))


@singledispatch
def staged(result: Any, asked: Asked) -> Film:
    """The film of a result."""
    raise TypeError(f"{asked.place}: a {type(result).__name__} does not move")


# ---- what turns at a constant speed


@staged.register
def _(modes: Modes, asked: Asked) -> Film:
    rows = rows_of(asked.place, modes, asked.figures)
    straight = Straight(modes.system)
    height = np.asarray(straight.height, float)
    largest = _reach_of_small(height, len(rows))
    both = bool(getattr(modes, "has_momentum", False))
    named: list[Turning] = []
    for row in rows:
        shape = np.asarray(modes.shape[row], float)
        way = (" forward" if modes.angular_speed[row] > 0 else " backward") * both
        scale = largest / np.abs(shape).max()
        named.append((f"mode {modes.number[row]}{way}", shape, height, float(modes.angular_speed[row]), scale))
    return replace(_turning(modes, named, asked), note="offsets exaggerated")


@staged.register
def _(shape: SteadyShape, asked: Asked) -> Film:
    asked.only_one()
    return _of_shapes([shape], shape, [""], asked)


@staged.register
def _(shapes: SteadyShapes, asked: Asked) -> Film:
    places = asked.among(len(shapes), "shape")
    return _of_shapes([shapes[k] for k in places], shapes, [f"shape {k + 1}" for k in places], asked)


def _of_shapes(shapes: Sequence[Any], of: Any, labels: list[str], asked: Asked) -> Film:
    named: list[Turning] = []
    for shape, label in zip(shapes, labels, strict=True):
        waves = f"{shape.half_waves} half wave{'s' * (shape.half_waves != 1)}"
        offset, height = _bent(shape)
        speed = shape.angular_speed * shape.direction
        named.append((f"{label}\n{waves}".strip(), offset, height, speed, 1.0))
    return _turning(of, named, asked)


def _bent(shape: Any) -> tuple[Floats, Floats]:
    """Offsets and heights of pins, or of places of a cord equally far apart."""
    if not hasattr(shape, "arc_length"):
        return shape.offset, shape.height
    places = shape.along(np.linspace(0.0, shape.system.length, PLACES))
    return places.offset, places.height


def _turning(result: Any, named: list[Turning], asked: Asked) -> Film:
    """The film of figures that only turn."""
    period = np.array([TURN / abs(speed) for *_, speed, _ in named if speed])
    slow, fast = (float(period.max()), float(period.min())) if period.size else (SLOWEST_TURN, SLOWEST_TURN)
    scale = asked.time_scale or min(slow / SLOWEST_TURN, fast / FASTEST_TURN)
    seconds = min(slow / scale, LONGEST) if asked.duration is None else asked.duration
    frames = asked.frames(seconds)
    turns = math.floor(seconds * scale / slow * (1 + 1e-9))
    if asked.time_scale is None and turns:
        scale = turns * slow * asked.frames_per_second / frames  # the slowest ends where it began
    time = scale * np.arange(frames) / asked.frames_per_second
    figures = [
        Figure(
            label,
            larger * offset[None] + 0j,
            height[None],
            np.array([larger]),
            np.asarray(speed * time),
            np.array([speed]),
            (f"{label}\n{speed_words(speed)}",),
        )
        for label, offset, height, speed, larger in named
    ]
    return _film(result, figures, asked, scale)


def speed_words(speed: float) -> str:
    """A speed in rad/s and in rpm."""
    return f"{digits(speed, 4)} rad/s\n{digits(speed * 30 / np.pi, 4)} rpm"


# ---- what changes along a branch, or with the speed


@staged.register
def _(branch: Branch, asked: Asked) -> Film:
    asked.only_one()
    return _of_branches([branch], branch, [""], asked)


@staged.register
def _(branches: Branches, asked: Asked) -> Film:
    places = asked.among(len(branches), "branch")
    return _of_branches([branches[k] for k in places], branches, [f"branch {k}" for k in places], asked)


def _of_branches(branches: Sequence[Any], of: Any, labels: list[str], asked: Asked) -> Film:
    quantity = "tip_radius" if hasattr(branches[0], "tip_radius") else "largest_offset"
    stages = []
    curves = []
    for branch in branches:
        kept = _stages(len(branch), branch.folds)
        rows = [_bent(shape) if (shape := _shape_or_none(branch, k)) is not None else None for k in kept.tolist()]
        straight = Straight(branch.system).height if None in rows else np.empty(0)
        if None in rows and branch.system._is_cord:
            straight = np.linspace(straight[0], straight[-1], PLACES)
        rows = [(np.zeros_like(straight), straight) if row is None else row for row in rows]
        offset, height = (np.array(part) for part in zip(*rows, strict=True))
        speed = branch.angular_speed[kept]
        moved = np.hypot(np.diff(offset, axis=0), np.diff(height, axis=0)).max(axis=1) / np.ptp(height, axis=1).max()
        steps = moved + np.abs(np.diff(speed)) / speed.max()
        way = np.concatenate([[0.0], np.cumsum(steps)])
        stages.append(_Stages(way, offset + 0j, height, speed * branch.direction, np.ones(speed.size)))
        curves.append(getattr(branch, quantity)[kept])
    words = words_of(quantity, branches[0].system.by_mass)
    return _swept(of, labels, stages, asked, words, curves, "Along branch")


def _stages(count: int, folds: Any) -> Any:
    """Indices of the points of a branch that are drawn: its ends, its folds, and others evenly spaced."""
    even = np.linspace(0, count - 1, min(count, MOST_STAGES)).round().astype(int)
    return np.unique(np.concatenate([even, np.asarray(folds, int)]))


def _shape_or_none(branch: Any, point: int) -> Any:
    """The shape at a point of a branch, or None where the chain is straight."""
    try:
        return branch.shape(point)
    except ValueError:
        return None


@staged.register
def _(found: Response, asked: Asked) -> Film:
    asked.only_one()
    if found.pins.shape != (found.system.size + 1,) or not np.array_equal(found.pins, np.arange(found.pins.size)):
        raise ValueError(f"{asked.place}: every pin is needed; compute the response without pins=")
    height = Straight(found.system).height
    speed, offset = found.angular_speed.reshape(-1), found.offset.reshape(-1, found.pins.size)
    known = np.isfinite(offset).all(axis=1)
    if not known.any():
        raise ValueError(f"{asked.place}: there is no speed to draw that is not a resonance")
    order = np.argsort(speed[known])
    speed, offset = speed[known][order], offset[known][order]
    largest, most = _reach_of_small(height, 1), np.abs(offset).max(axis=1)
    scale = np.minimum(largest / np.quantile(most, 0.75), largest / most)
    if speed.size == 1:
        label = "carried round"
        return _turning(found, [(label, offset[0], height, float(speed[0]), float(scale[0]))], asked)
    rows = np.broadcast_to(height, offset.shape)
    stages = _Stages(np.arange(speed.size, dtype=float), offset * scale[:, None] + 0j, rows, speed, scale)
    return _swept(found, ["carried round"], [stages], asked, "largest distance from axis (m)", [most], "Speed")


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
    asked: Asked,
    quantity: str,
    curves: list[Floats],
    progress: str,
) -> Film:
    """Figures that go through stages, all from their first to their last, turning as fast as each stage does."""
    frames = asked.frames(FOR_A_SWEEP if asked.duration is None else asked.duration)
    fastest = max(float(np.abs(each.speed).max()) for each in stages)
    time_scale = asked.time_scale or TURN / fastest / FASTEST_TURN
    figures, x, y, lines = [], [], [], []
    for label, each, curve in zip(labels, stages, curves, strict=True):
        at = np.linspace(0.0, each.way[-1], frames)
        speed, scale = (np.interp(at, each.way, values) for values in (each.speed, each.scale))
        turned = np.cumsum((speed[1:] + speed[:-1]) / 2) * time_scale / asked.frames_per_second
        captions = [f"{label}\n{speed_words(now)}".strip() for now in speed.tolist()]
        if np.ptp(each.scale):
            captions = [
                f"{text}\noffsets {larger:.3g}:1" for text, larger in zip(captions, scale.tolist(), strict=True)
            ]
        offset = _between(at, each.way, each.offset)
        height = _between(at, each.way, each.height)
        figures.append(Figure(label, offset, height, scale, np.concatenate([[0.0], turned]), speed, tuple(captions)))
        kept = thinned(curve)
        way = -1.0 if (each.speed <= 0).all() else 1.0  # a branch of backward rotation is drawn as one of forward
        lines.append((way * each.speed[kept], curve[kept]))
        x.append(way * speed)
        y.append(np.interp(at, each.way, curve))
    said = [f"{progress}es: {percent:.0f} %" for percent in np.linspace(0.0, 100.0, frames)]
    if len(figures) == 1:
        said = [f"{progress}: {digits(now, 3)} rad/s" for now in x[0].tolist()]
    chart = Chart("speed (rad/s)", quantity, tuple(lines), tuple(x), tuple(y))
    return _film(result, figures, asked, time_scale, chart, said)


def _between(at: Floats, way: Floats, rows: Any) -> Any:
    """Rows interpolated between those of the stages."""
    after = np.clip(np.searchsorted(way, at, side="right"), 1, max(way.size - 1, 1))
    if way.size == 1:
        return np.repeat(rows, at.size, axis=0)
    gap = way[after] - way[after - 1]
    part = np.divide(at - way[after - 1], gap, out=np.zeros_like(at), where=gap > 0)[:, None]
    return rows[after - 1] * (1 - part) + rows[after] * part


# ---- what swings


@staged.register
def _(found: Swing, asked: Asked) -> Film:
    def at(time: Floats) -> Complex:
        whole = (np.exp(1j * np.outer(time, found.angular_frequency)) * found.amplitude) @ found.shape
        return np.asarray(whole if found.offset.dtype.kind == "c" else whole.real, np.complex128)

    cord = found.arc_length is not None
    height = found.arc_length - found.system.length if cord else Straight(found.system).height
    return _swung(found, asked, at, height)


def _swung(found: Any, asked: Asked, at: Callable[[Floats], Complex], height: Floats) -> Film:
    """The film from the first to the last time of a swing, as the sum of its modes."""
    asked.only_one()
    first, last = float(found.time.min(initial=np.inf)), float(found.time.max(initial=-np.inf))
    if not first < last:
        raise ValueError(f"{asked.place}: the swing needs two times or more, the first and the last of the film")
    seconds = asked.duration or min(
        (last - first) / (asked.time_scale or 1.0), LONGEST if asked.time_scale is None else np.inf
    )
    frames = asked.frames(seconds)
    time_scale = asked.time_scale or (last - first) / seconds
    time = first + np.arange(frames) / asked.frames_per_second * time_scale
    offset = at(time)
    most, deep = float(np.abs(offset).max()), float(np.ptp(height))
    scale = 1.0 if 0.1 * deep <= most <= 0.35 * deep or not most else _reach_of_small(height, 1) / most
    captions = ("true to scale" if scale == 1 else f"offsets {scale:.3g}:1",)
    still = np.zeros(frames)
    figure = Figure("swing", scale * offset, height[None], np.full(frames, scale), still, np.zeros(1), captions)
    return _film(found, [figure], asked, time_scale, progress=[f"Time: {now:.3f} s" for now in time.tolist()])


# ---- what all films have


def _reach_of_small(height: Floats, count: int) -> float:
    """The distance from the axis at which offsets of small amplitude are drawn, for so many figures side by side."""
    return float(np.ptp(height)) * min(0.25, 0.9 / (count + 1))


def _film(
    result: Any,
    figures: list[Figure],
    asked: Asked,
    time_scale: float,
    chart: Chart | None = None,
    progress: Sequence[str] = (),
) -> Film:
    system = result.system
    base = system._base
    few = not system._is_cord and base.size <= MOST_PINS_AS_DOTS
    names: tuple[str, ...] = ()
    if not system._is_cord:
        names = tuple(f"links[{k}]" for k in range(base.size))
        if base.names is not None:
            names = tuple(f"{number} {name}" for number, name in zip(names, base.names, strict=True))
    gravity = 0.0 if system._is_held and system.weightless else float(result.gravity)
    return Film(
        system=repr(system),
        gravity=gravity,
        figures=tuple(figures),
        bodies=_bodies(system, base) if few or system._is_cord else Bodies(),
        frames_per_second=asked.frames_per_second,
        time_scale=time_scale,
        names=names,
        stout=np.broadcast_to(system._stands, figures[0].offset.shape[1] - 1),
        shows_pins=few,
        is_held=system._is_held,
        chart=chart,
        progress=tuple(progress),
    )


def _bodies(system: Any, base: Any) -> Bodies:
    if system._is_cord:
        if not base._compiled.tip_weight:
            return Bodies()
        one = np.ones(1)
        return Bodies(np.zeros(1, int), one, one, np.zeros(1), np.zeros(1), np.zeros(1, bool))
    weight = np.broadcast_to(base._compiled.weight, base.size)
    momentum = system._momentum(1.0)
    link = np.flatnonzero((weight > 0) | (momentum != 0))
    rod = math.sqrt(3) * base.radius_of_gyration / base.length
    arrays = {
        "along": base.centroid / base.length,
        "size": np.cbrt(weight / weight.max()),
        "rod": np.where(rod < 1, rod, 0.0),  # what is longer is no rod
        "wheel": np.sign(momentum),
        "floats": floating(system),
    }
    return Bodies(link, **{name: np.asarray(array)[link] for name, array in arrays.items()})
