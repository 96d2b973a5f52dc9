# SPDX-License-Identifier: GPL-3.0-or-later
"""A film: where every pin is drawn in every frame. Every format is written from one."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..systems.numbers import Floats, Whole

Complex = NDArray[np.complex128]
GAP = 1.15  # room of a figure over its width


@dataclass(frozen=True)
class Figure:
    """One system that moves. Arrays have one row for each of the F frames, or a single row for all."""

    label: str
    offset: Complex  # shape (1 or F, n), x + i y as drawn, m, in a frame that turns with the figure; free end first
    height: Floats  # shape (1 or F, n), upwards, m
    scale: Floats  # shape (1 or F,), offsets drawn over those of the result
    phase: Floats  # shape (F,), angle by which that frame has turned, rad
    speed: Floats  # shape (1 or F,), angular speed of that frame, rad/s
    captions: tuple[str, ...]  # 1 or F
    tension: Floats | None = None  # of shapes of chains: of each link, held at both ends at each pin

    @property
    def is_rigid(self) -> bool:
        """Whether it only turns, at a constant speed."""
        return len(self.offset) == 1

    def in_space(self, frame: int) -> Complex:
        """Offsets as seen from outside."""
        row: Complex = self.offset[0 if self.is_rigid else frame]
        turned: Complex = row * np.exp(1j * self.phase[frame])
        return turned

    def heights(self, frame: int) -> Floats:
        """Heights of the pins in one frame, in metres."""
        row: Floats = self.height[0 if len(self.height) == 1 else frame]
        return row

    def caption(self, frame: int) -> str:
        """The text above the picture in one frame."""
        return self.captions[0 if len(self.captions) == 1 else frame]


@dataclass(frozen=True)
class Bodies:
    """Bodies, rods and wheels of the links; arrays have one number for each body."""

    link: Whole = field(default_factory=lambda: np.zeros(0, int))
    along: Floats = field(default_factory=lambda: np.zeros(0))  # from the upper pin, over the length of the link
    size: Floats = field(default_factory=lambda: np.zeros(0))  # 0 to 1, by the cube root of the mass
    rod: Floats = field(default_factory=lambda: np.zeros(0))  # half a uniform rod of that inertia, over the link; or 0
    wheel: Floats = field(default_factory=lambda: np.zeros(0))  # 1 or -1 where a flywheel has momentum
    floats: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))


@dataclass(frozen=True)
class Chart:
    """A curve for each figure, and the place on it in each frame."""

    x_label: str
    y_label: str
    lines: tuple[tuple[Floats, Floats], ...]  # of each figure
    x: tuple[Floats, ...]  # of each figure, shape (F,)
    y: tuple[Floats, ...]

    @property
    def is_logarithmic(self) -> bool:
        """Whether peaks would hide the rest."""
        every = np.concatenate([y for _, y in self.lines])
        return bool((every > 0).all() and every.max() > 20 * np.median(every))


@dataclass(frozen=True)
class Film:
    """Figures side by side, each about its own axis."""

    system: str
    gravity: float
    figures: tuple[Figure, ...]
    bodies: Bodies
    frames_per_second: float
    time_scale: float  # seconds of motion in one second of film
    names: tuple[str, ...]  # of links
    stout: NDArray[np.bool_]  # links that stand
    shows_pins: bool = False
    is_held: bool = False  # at both ends
    chart: Chart | None = None
    clock: tuple[str, ...] = ("",)  # 1 or F
    note: str = ""

    @property
    def frames(self) -> int:
        """How many."""
        return int(self.figures[0].phase.size)

    @property
    def is_rigid(self) -> bool:
        """Whether all figures only turn."""
        return all(figure.is_rigid for figure in self.figures)

    @property
    def seconds(self) -> float:
        """How long it runs."""
        return self.frames / self.frames_per_second

    @property
    def reach(self) -> float:
        """Largest distance from the axis."""
        return max(float(np.abs(figure.offset).max()) for figure in self.figures)

    @property
    def low_and_high(self) -> tuple[float, float]:
        """Least and greatest height."""
        heights = [figure.height for figure in self.figures]
        return min(float(each.min()) for each in heights), max(float(each.max()) for each in heights)

    def widths(self, least: float = 0.0) -> Floats:
        """Room for each figure, m; for none less than `least`."""
        low, high = self.low_and_high
        reach = np.array([float(np.abs(figure.offset).max()) for figure in self.figures])
        return np.asarray(np.maximum(2 * GAP * np.maximum(reach, 0.1 * (high - low)), least))

    @property
    def colours(self) -> tuple[int, ...]:
        """Of each figure, its number in the cycle of ten; by the direction where there are both."""
        ways = [float(np.sign(figure.speed[0])) for figure in self.figures]
        return tuple((0 if way > 0 else 3) if len(set(ways)) > 1 else nth % 10 for nth, way in enumerate(ways))

    @property
    def words(self) -> str:
        """Gravity, and how much slower or faster than the motion the film is."""
        pull = f"gravity {self.gravity:.6g} m/s²" if self.gravity else "without gravity"
        return f"{pull}; {pace(self.time_scale)}" + f"; {self.note}" * bool(self.note)

    def thinned(self, frames: int, pins: int) -> Film:
        """At most so many frames and pins, the ends kept; bodies go with the pins of their links."""
        rows = spread(self.frames, frames)  # all but equally far apart
        kept = spread(self.figures[0].offset.shape[1], pins)
        if rows.size == self.frames and kept.size == self.figures[0].offset.shape[1]:
            return self

        def few(values: Any) -> Any:
            return values if len(values) == 1 else values[rows]

        figures = tuple(
            replace(
                each,
                offset=few(each.offset)[:, kept],
                height=few(each.height)[:, kept],
                scale=few(each.scale),
                phase=each.phase[rows],
                speed=few(each.speed),
                captions=_few(each.captions, rows),
                tension=None,
            )
            for each in self.figures
        )
        chart = self.chart
        if chart is not None:
            chart = replace(chart, x=tuple(x[rows] for x in chart.x), y=tuple(y[rows] for y in chart.y))
        same = kept.size == self.figures[0].offset.shape[1]
        return replace(
            self,
            figures=figures,
            chart=chart,
            clock=_few(self.clock, rows),
            bodies=self.bodies if same else Bodies(),
            shows_pins=self.shows_pins and same,
            names=self.names if same else (),
            stout=self.stout[kept[:-1]],
            frames_per_second=(rows.size - 1) / (self.frames - 1) * self.frames_per_second,
        )


def side_by_side(widths: Floats) -> Floats:
    """Where the axes are, the first at 0."""
    middles = np.cumsum(widths) - widths / 2
    return np.asarray(middles - middles[0])


def _few(texts: tuple[str, ...], rows: Whole) -> tuple[str, ...]:
    return texts if len(texts) == 1 else tuple(texts[row] for row in rows)


def spread(count: int, most: int) -> Whole:
    """Places from first to last, at most so many."""
    return np.arange(count) if count <= most else np.linspace(0, count - 1, most).round().astype(int)


def pace(time_scale: float) -> str:
    """The time scale in words."""
    if time_scale == 1:
        return "in real time"
    slower = time_scale < 1
    return f"{1 / time_scale if slower else time_scale:.3g} times {'slower' if slower else 'faster'} than real time"
