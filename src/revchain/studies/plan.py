# SPDX-License-Identifier: GPL-3.0-or-later
"""The plan of a study: its axes, the results of each point, and the computation of a stretch of points."""

from __future__ import annotations

import hashlib
import json
import time
from dataclasses import dataclass, field
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..questions.batch import conical_heights
from ..scenes import parse
from ..scenes.scene import Scene
from ..systems.numbers import Floats
from .axes import Axis, Reader, Values, shape_of, with_value
from .points import (
    NOT_MET,
    REFUSED,
    SUCCESS,
    Arrays,
    Block,
    Columns,
    one_by_one,
    refused_by_chains,
    solve_compiled,
)

FORMAT = 3  # version of the chunks on disk
_LARGEST, _SMALLEST = 32768, 1024  # chains of a batch: few enough that their numbers stay in the cache
_WORK = 2**20  # links times modes of a batch: enough that Python takes a small part of the time
_FEW = 3  # so few points are as fast by the methods of their scenes
_MOST_PATTERNS = 100  # largest number of stored scenes


@dataclass(frozen=True)
class Stretch:
    """The points start <= k < stop: their results, a status for each, and the time in seconds."""

    start: int
    stop: int
    arrays: Arrays
    status: NDArray[np.uint8]
    seconds: float = 0.0


@dataclass(frozen=True, eq=False)
class Plan:
    """The data that a worker needs; they can be sent to another process."""

    base: dict[str, Any]  # the scene as plain data
    axes: tuple[Axis, ...]
    samples: int  # random numbers at each point of the grids
    seed: int
    find: tuple[str, ...]  # "modes", "shapes", "response"
    blocks: tuple[Block, ...]  # the results
    batched: bool  # whether heights come from `revchain.conical_heights`
    derived: bool  # whether speeds follow from the heights and are not stored
    _kept: dict[str, Any] = field(default_factory=dict, repr=False)
    _patterns: dict[tuple[Any, ...], Scene] = field(default_factory=dict, repr=False)

    def __reduce__(self) -> tuple[Any, ...]:
        given = (self.base, self.axes, self.samples, self.seed, self.find, self.blocks, self.batched, self.derived)
        return Plan, given

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each grid, then samples."""
        return shape_of(self.axes, self.samples)

    @property
    def points(self) -> int:
        """Number of points."""
        return prod(self.shape)

    def values(self, start: int, stop: int) -> list[Values]:
        """The numbers of each axis at a stretch of points."""
        return self.reader().at(start, stop)

    def reader(self) -> Reader:
        """A reader of the numbers of successive stretches, for one thread."""
        return Reader(self.axes, self.samples, self.seed)

    def scene_data(self, values: list[Any]) -> dict[str, Any]:
        """The scene with these numbers, as plain data."""
        data = self.base
        for axis, value in zip(self.axes, values, strict=True):
            data = with_value(data, axis.path, value)
        return data

    def fingerprint(self) -> str:
        """A hash of all data on which the results depend."""
        from .. import __version__

        axes = [
            [axis.key, None if axis.values is None else hashlib.sha256(repr(axis.values.tolist()).encode()).hexdigest()]
            + [axis.law, *axis.law_numbers]
            for axis in self.axes
        ]
        base = {key: value for key, value in self.base.items() if key not in ("title", "description")}
        blocks = [[block.name, block.kind, block.along, block.labels] for block in self.blocks]
        random = [self.samples, self.seed, np.__version__] if any(axis.law for axis in self.axes) else []
        everything = [FORMAT, __version__, base, axes, random, self.find, blocks, self.batched]
        return hashlib.sha256(json.dumps(everything, sort_keys=True).encode()).hexdigest()

    @property
    def stored(self) -> tuple[Block, ...]:
        """The blocks that are computed and stored."""
        return tuple(block for block in self.blocks if not (self.derived and block.name == "angular_speed"))

    @property
    def numbers(self) -> int:
        """Number of stored numbers of each point."""
        return sum(prod(block.each) for block in self.stored)

    @property
    def batch(self) -> int:
        """Number of chains that go to `revchain.conical_heights` together."""
        if "batch" not in self._kept:
            chain: Any = self._scene.system()
            most = _WORK // (chain.size * self.stored[0].labels[-1])
            self._kept["batch"] = min(max(1 << max(most.bit_length() - 1, 0), _SMALLEST), _LARGEST)
        return int(self._kept["batch"])

    def speeds(self, heights: Floats, values: list[Values]) -> Floats:
        """Whirl speeds at points with these heights and these numbers of the axes."""
        varied = {axis.path: k for k, axis in enumerate(self.axes)}
        where = varied.get(("gravity",))
        gravity = np.asarray(self._scene.gravity_value() if where is None else values[where], float)
        with np.errstate(invalid="ignore"):  # the height of a refused point is NaN
            speeds: Floats = np.sqrt(heights)
            np.divide(np.sqrt(gravity)[..., np.newaxis], speeds, out=speeds)
        return speeds

    def found(
        self, start: int, stop: int, progress: _core.Progress | None = None, arrays: Arrays | None = None
    ) -> Stretch:
        """The points of a stretch, put into `arrays` if given; the numbers do not depend on the stretch."""
        began = time.perf_counter()
        progress = _core.Progress() if progress is None else progress
        status = np.full(stop - start, SUCCESS, np.uint8)
        if self.batched:
            heights = self.stored[0].memory(stop - start) if arrays is None else arrays["conical_height"]
            columns, reader = Columns(self._scene, min(self.batch, stop - start)), self.reader()
            for first in range(start, stop, self.batch):
                last = min(first + self.batch, stop)
                rows = slice(first - start, last - start)
                self._heights(rows, reader.at(first, last), columns, heights, status, progress)
            return Stretch(start, stop, {"conical_height": heights}, status, time.perf_counter() - began)
        if arrays is None:
            arrays = {block.name: block.memory(stop - start) for block in self.stored}
        for block in self.stored:
            arrays[block.name][...] = block.nothing
        values = self.values(start, stop)
        for rows in self._alike(values, stop - start):
            self._solve(rows, [column[rows] for column in values], arrays, status, progress)
        return Stretch(start, stop, arrays, status, time.perf_counter() - began)

    def refusal(self, point: int) -> str:
        """The reason why the scene of a point is refused; empty if it is not."""
        values = [column.tolist()[0] for column in self.values(point, point + 1)]
        try:
            one_by_one(self._scene_of(values), self.find)
        except (ValueError, OverflowError) as error:
            return str(error).removeprefix("scene: ")
        return ""

    def _scene_of(self, values: list[Any]) -> Scene:
        """The scene of a point, which its methods check later."""
        return parse.convert(self.scene_data(values), Scene, "scene")

    def _alike(self, values: list[Values], count: int) -> list[Any]:
        """Groups of rows with equal words and whole numbers, so that the points of a group differ only in numbers."""
        words = [column for axis, column in zip(self.axes, values, strict=True) if not axis.is_number]
        if not words:
            return [slice(None)]
        codes = np.stack([np.unique(column, return_inverse=True)[1] for column in words])
        _, groups = np.unique(codes, axis=1, return_inverse=True)
        return [np.flatnonzero(groups == group) for group in range(groups.max() + 1)]

    def _solve(self, rows: Any, values: list[Values], arrays: Arrays, status: NDArray[np.uint8], progress: Any) -> None:
        """Solve points that differ only in numbers, one by one."""
        count = len(values[0])
        if (solved := self._compiled(values, count, progress)) is not None:
            for name, found in solved[0].items():
                arrays[name][rows] = found
            status[rows] = solved[1]
            return
        places = range(count) if isinstance(rows, slice) else rows.tolist()
        for row, *each in zip(places, *(column.tolist() for column in values), strict=True):
            if progress.cancelled:
                raise _core.Cancelled("revchain: cancelled")
            self._one(row, each, arrays, status)

    def _compiled(self, values: list[Values], count: int, progress: Any) -> tuple[Arrays, NDArray[np.uint8]] | None:
        """The results of `solve_compiled` for these points; None if it does not apply, or if they are too few."""
        if count < _FEW:
            return None
        points = {axis.path: column for axis, column in zip(self.axes, values, strict=True) if axis.is_number}
        columns = zip(self.axes, values, strict=True)
        words = tuple(column[:1].tolist()[0] for axis, column in columns if not axis.is_number)
        try:
            pattern = self._pattern(words)
            return solve_compiled(pattern, self.find, self.stored, points, count, progress)
        except (ValueError, OverflowError):
            return None

    def _pattern(self, words: tuple[Any, ...]) -> Scene:
        """A scene with these words and whole numbers; its other numbers have no effect."""
        pattern = self._patterns.get(words)
        if pattern is None:
            given = iter(words)
            sample = [axis.examples()[0] if axis.is_number else next(given) for axis in self.axes]
            if len(self._patterns) >= _MOST_PATTERNS:
                self._patterns.clear()
            pattern = self._patterns[words] = Scene.from_dict(self.scene_data(sample))
        return pattern

    def _one(self, row: int, values: list[Any], arrays: Arrays, status: NDArray[np.uint8]) -> None:
        """Solve a point by the methods of its scene."""
        try:
            found, good = one_by_one(self._scene_of(values), self.find)
        except (ValueError, OverflowError):
            status[row] = REFUSED
            return
        status[row] = SUCCESS if good else NOT_MET
        for block in self.stored:
            numbers = np.atleast_1d(found[block.name])
            if block.along:
                count = min(len(block.labels), len(numbers))
                arrays[block.name][row, :count] = numbers[:count]
            else:
                arrays[block.name][row] = numbers[0]

    def _heights(
        self,
        rows: Any,
        values: list[Values],
        columns: Columns,
        heights: Floats,
        status: NDArray[np.uint8],
        progress: Any,
    ) -> None:
        """Heights of plain chains. The wrong chains of a refused batch are left out; a single chain is solved."""
        (block,) = self.stored
        links = columns.bodies({axis.path: column for axis, column in zip(self.axes, values, strict=True)})
        count = len(values[0])
        wrong = np.broadcast_to(columns.wrong, count)
        if not wrong.any():
            try:
                found = conical_heights(**links, count=block.labels[-1])  # type: ignore[arg-type]
                heights[rows] = found[..., block.labels[0] - 1 :]
                return
            except ValueError:
                wrong = refused_by_chains(links, count)
        places = np.arange(rows.start, rows.stop) if isinstance(rows, slice) else rows
        heights[places[wrong]], status[places[wrong]] = np.nan, REFUSED
        right = np.flatnonzero(~wrong)
        if right.size == count == 1:  # no error was seen in it
            heights[places] = np.nan
            self._solve(places, values, {block.name: heights}, status, progress)
        else:
            for part in np.array_split(right, 2) if right.size == count else [right]:
                if part.size:
                    self._heights(places[part], [column[part] for column in values], columns, heights, status, progress)

    @property
    def _scene(self) -> Scene:
        """The base scene; a dict is shared by threads, at worst two of them make it."""
        if "scene" not in self._kept:
            self._kept["scene"] = Scene.from_dict(self.base)
        return self._kept["scene"]  # type: ignore[no-any-return]
