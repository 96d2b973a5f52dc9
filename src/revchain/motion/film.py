# SPDX-License-Identifier: GPL-3.0-or-later
"""A film: the position of every pin in every frame."""

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
    scale: Floats  # shape (1 or F,), drawn offset divided by the offset of the result
    phase: Floats  # shape (F,), angle by which the figure has turned in each frame of the film, rad
    speed: Floats  # shape (1 or F,), angular speed of the figure, rad/s
    captions: tuple[str, ...]  # 1 or F

    @property
    def is_rigid(self) -> bool:
        """Whether the figure only turns, at a constant speed."""
        return len(self.offset) == 1

    def in_space(self, frame: int) -> Complex:
        """Offsets of the pins in one frame, in a frame of reference that does not turn."""
        row: Complex = self.offset[0 if self.is_rigid else frame]
        turned: Complex = row * np.exp(1j * self.phase[frame])
        return turned

    def heights(self, frame: int) -> Floats:
        row: Floats = self.height[0 if len(self.height) == 1 else frame]
        return row

    def caption(self, frame: int) -> str:
        return self.captions[0 if len(self.captions) == 1 else frame]


@dataclass(frozen=True)
class Bodies:
    """Bodies, rods and wheels of the links; arrays have one number for each body."""

    link: Whole = field(default_factory=lambda: np.zeros(0, int))
    along: Floats = field(default_factory=lambda: np.zeros(0))  # from the upper pin, over the length of the link
    size: Floats = field(default_factory=lambda: np.zeros(0))  # 0 to 1, by the cube root of the mass
    rod: Floats = field(default_factory=lambda: np.zeros(0))  # half the length of a uniform rod, over the link; 0: it is no rod
    wheel: Floats = field(default_factory=lambda: np.zeros(0))  # where there is a flywheel 1, or -1 if its momentum is negative
    floats: NDArray[np.bool_] = field(default_factory=lambda: np.zeros(0, bool))
    gyration: Floats = field(default_factory=lambda: np.zeros(0))  # radius, m
    form: tuple[str, ...] = ()  # a key of the table of forms, or empty


@dataclass(frozen=True)
class Chart:
    """A curve for each figure, and the point on it in each frame."""

    x_label: str
    y_label: str
    lines: tuple[tuple[Floats, Floats], ...]  # of each figure
    x: tuple[Floats, ...]  # of each figure, shape (F,)
    y: tuple[Floats, ...]

    @property
    def is_logarithmic(self) -> bool:
        """Whether peaks would hide the rest of the curve on a linear axis."""
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
    stout: NDArray[np.bool_]  # whether each link is inverted, which is drawn thick
    rings: NDArray[np.bool_]  # whether each link is drawn as a ring, as one of many equal rods
    shows_pins: bool = False
    is_held: bool = False  # at both ends
    chart: Chart | None = None
    progress: tuple[str, ...] = ()  # the time, or how far along the branch, in each frame; empty if all only turn
    note: str = ""

    @property
    def frames(self) -> int:
        return int(self.figures[0].phase.size)

    @property
    def is_rigid(self) -> bool:
        """Whether every figure only turns, at a constant speed."""
        return all(figure.is_rigid for figure in self.figures)

    @property
    def seconds(self) -> float:
        return self.frames / self.frames_per_second

    @property
    def reach(self) -> float:
        """Largest distance of a pin from the axis, in metres."""
        return max(float(np.abs(figure.offset).max()) for figure in self.figures)

    @property
    def low_and_high(self) -> tuple[float, float]:
        """Least and greatest height of a pin, in metres."""
        heights = [figure.height for figure in self.figures]
        return min(float(each.min()) for each in heights), max(float(each.max()) for each in heights)

    def widths(self, least: float = 0.0) -> Floats:
        """Width of the space for each figure, in metres and at least `least`."""
        low, high = self.low_and_high
        reach = np.array([float(np.abs(figure.offset).max()) for figure in self.figures])
        return np.asarray(np.maximum(2 * GAP * np.maximum(reach, 0.1 * (high - low)), least))

    @property
    def colours(self) -> tuple[int, ...]:
        """The number of each figure's colour in the palette; by direction of rotation if there are both."""
        ways = [float(np.sign(figure.speed[0])) for figure in self.figures]
        both = {1.0, -1.0} <= set(ways)
        return tuple((0 if way > 0 else 1) if both else nth for nth, way in enumerate(ways))

    @property
    def words(self) -> str:
        """Gravity, and how much slower or faster than the motion the film runs."""
        pull = f"gravity {self.gravity:.6g} m/s²" if self.gravity else "without gravity"
        return f"{pull}; {pace(self.time_scale)}" + f"; {self.note}" * bool(self.note)

    def thinned(self, frames: int, pins: int) -> Film:
        """Return the film with at most `frames` frames and `pins` pins, evenly spaced, the first and the last included.

        If pins are left out, the bodies are left out, too.
        """
        rows = _spread(self.frames, frames)
        pin = _spread(self.figures[0].offset.shape[1], pins)
        has_all_pins = pin.size == self.figures[0].offset.shape[1]
        if rows.size == self.frames and has_all_pins:
            return self

        def few(values: Any) -> Any:
            if len(values) <= 1:
                return values
            return tuple(values[row] for row in rows) if isinstance(values, tuple) else values[rows]

        of_frames = ("offset", "height", "scale", "phase", "speed", "captions")
        cut = [replace(each, **{name: few(getattr(each, name)) for name in of_frames}) for each in self.figures]
        figures = tuple(replace(each, offset=each.offset[:, pin], height=each.height[:, pin]) for each in cut)
        chart = self.chart
        if chart is not None:
            chart = replace(chart, x=tuple(x[rows] for x in chart.x), y=tuple(y[rows] for y in chart.y))
        return replace(
            self,
            figures=figures,
            chart=chart,
            progress=few(self.progress),
            bodies=self.bodies if has_all_pins else Bodies(),
            shows_pins=self.shows_pins and has_all_pins,
            names=self.names if has_all_pins else (),
            stout=self.stout[pin[:-1]],
            rings=self.rings[pin[:-1]],
            frames_per_second=(rows.size - 1) / (self.frames - 1) * self.frames_per_second,
        )


def side_by_side(widths: Floats) -> Floats:
    """Return the positions of the axes of figures of these widths, the first at 0."""
    middles = np.cumsum(widths) - widths / 2
    return np.asarray(middles - middles[0])


def _spread(count: int, most: int) -> Whole:
    """At most so many evenly spaced indices, from the first to the last of `count`."""
    return np.arange(count) if count <= most else np.linspace(0, count - 1, most).round().astype(int)


def pace(time_scale: float) -> str:
    """How much slower or faster than real time a film runs, in words."""
    if time_scale == 1:
        return "in real time"
    slower = time_scale < 1
    return f"{1 / time_scale if slower else time_scale:.3g} times {'slower' if slower else 'faster'} than real time"
