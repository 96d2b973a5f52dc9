# SPDX-License-Identifier: GPL-3.0-or-later
"""A study made ready: its axes, what each point gives, and the points of a stretch computed."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Callable
from dataclasses import dataclass, field
from math import prod
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..questions.batch import conical_heights
from ..scenes import parse
from ..scenes.error import SceneError
from ..scenes.scene import Scene
from ..systems.numbers import Floats
from .axes import Axis, Reader, Values, shape_of
from .batch import LinkColumns, wrong_chains
from .find import NOT_MET, REFUSED, SUCCESS, Arrays, Block, found_at, put
from .paths import with_value

FORMAT = 2
_LARGEST, _SMALLEST = 32768, 1024  # chains of a batch: few enough that their numbers stay in the cache,
_WORK = 2**20  # links times modes of a batch: and so many that Python's share of the time is small
_NOWHERE = SceneError("study", "vary", "")


@dataclass(frozen=True)
class Stretch:
    """The points start <= k < stop: what was found, a status for each, seconds taken."""

    start: int
    stop: int
    arrays: Arrays
    status: NDArray[np.uint8]
    seconds: float = 0.0


@dataclass(frozen=True, eq=False)
class Plan:
    """All that a worker needs; it can be sent to another process.

    Attributes
    ----------
    base : dict
        The scene as plain data.
    axes : tuple of Axis
    samples, seed : int
        Of the random numbers.
    find : tuple of str
        What is computed: ``modes``, ``shapes``, ``response``.
    blocks : tuple of Block
        Its results.
    batched : bool
        Whether heights come from `revchain.conical_heights`.
    """

    base: dict[str, Any]
    axes: tuple[Axis, ...]
    samples: int
    seed: int
    find: tuple[str, ...]
    blocks: tuple[Block, ...]
    batched: bool
    _kept: dict[str, Any] = field(default_factory=dict, repr=False)

    def __reduce__(self) -> tuple[Any, ...]:
        return Plan, (self.base, self.axes, self.samples, self.seed, self.find, self.blocks, self.batched)

    @property
    def shape(self) -> tuple[int, ...]:
        """How many values of each grid, then samples."""
        return shape_of(self.axes, self.samples)

    @property
    def points(self) -> int:
        """How many."""
        return prod(self.shape)

    def values(self, start: int, stop: int) -> list[Values]:
        """Of each axis, its numbers at a stretch of points."""
        return self.reader().at(start, stop)

    def reader(self) -> Reader:
        """What gives the numbers of one stretch after another; one thread's own."""
        return Reader(self.axes, self.samples, self.seed)

    def scene_data(self, values: list[Any]) -> dict[str, Any]:
        """The scene with these numbers, as plain data."""
        data = self.base
        for axis, value in zip(self.axes, values, strict=True):
            data = with_value(data, axis.path, value, _NOWHERE)
        return data

    def fingerprint(self) -> str:
        """Of everything that the numbers depend on."""
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
        """The blocks that are computed; speeds of batches follow from the heights."""
        return tuple(block for block in self.blocks if not (self.batched and block.name == "angular_speed"))

    @property
    def numbers(self) -> int:
        """How many numbers are stored of each point."""
        return sum(prod(block.each) for block in self.stored)

    @property
    def batch(self) -> int:
        """How many chains go to `revchain.conical_heights` together."""
        if "batch" not in self._kept:
            most = _WORK // (self._scene.chain().size * self.stored[0].labels[-1])
            self._kept["batch"] = min(max(1 << max(most.bit_length() - 1, 0), _SMALLEST), _LARGEST)
        return int(self._kept["batch"])

    def speeds(self, heights: Floats, values: list[Values]) -> Floats:
        """Whirl speeds of batches, at points with these heights where the axes have these numbers."""
        varied = {axis.path: k for k, axis in enumerate(self.axes)}
        where = varied.get(("gravity",))
        gravity = np.asarray(self._scene.gravity_value() if where is None else values[where], float)
        with np.errstate(invalid="ignore"):  # where a point is refused the height is no number
            speeds: Floats = np.sqrt(heights)
            np.divide(np.sqrt(gravity)[..., np.newaxis], speeds, out=speeds)
        return speeds

    def found(
        self,
        start: int,
        stop: int,
        stopped: Callable[[], bool] | None = None,
        arrays: Arrays | None = None,
    ) -> Stretch:
        """The points of a stretch, put into `arrays` if given; whatever the stretch, the same numbers at each."""
        began = time.perf_counter()
        arrays = {block.name: block.memory(stop - start) for block in self.stored} if arrays is None else arrays
        status = np.full(stop - start, SUCCESS, np.uint8)
        if self.batched:
            columns = LinkColumns(self._scene, min(self.batch, stop - start))
            reader = self.reader()
            for first in range(start, stop, self.batch):
                last = min(first + self.batch, stop)
                rows = slice(first - start, last - start)
                self._heights(rows, reader.at(first, last), columns, arrays["conical_height"], status)
        else:
            for array in arrays.values():
                array[...] = np.nan if array.dtype.kind == "f" else 0
            each = [column.tolist() for column in self.values(start, stop)]
            for row, values in enumerate(zip(*each, strict=True)):
                if stopped is not None and stopped():
                    raise KeyboardInterrupt
                self._one(row, list(values), arrays, status)
        return Stretch(start, stop, arrays, status, time.perf_counter() - began)

    def _scene_of(self, values: list[Any]) -> Scene:
        """The scene of a point; what its methods refuse they say themselves, so that it is not checked twice."""
        return parse.convert(self.scene_data(values), Scene, "scene")

    def refusal(self, point: int) -> str:
        """The sentence with which the scene of a point is refused; empty if it is not."""
        values = [column.tolist()[0] for column in self.values(point, point + 1)]
        try:
            found_at(self._scene_of(values), self.find)
        except (ValueError, OverflowError) as error:
            return str(error).removeprefix("scene: ")
        return ""

    def _one(self, row: int, values: list[Any], arrays: Arrays, status: NDArray[np.uint8]) -> None:
        try:
            found, good = found_at(self._scene_of(values), self.find)
        except (ValueError, OverflowError):
            status[row] = REFUSED
            return
        put(arrays, self.stored, row, found)
        status[row] = SUCCESS if good else NOT_MET

    def _heights(
        self,
        rows: slice | NDArray[np.int64],
        values: list[Values],
        columns: LinkColumns,
        heights: Floats,
        status: NDArray[np.uint8],
    ) -> None:
        """Heights of plain chains; where a batch is refused, of those that look right, and of the others each alone."""
        (block,) = self.stored
        try:
            points = {axis.path: column for axis, column in zip(self.axes, values, strict=True)}
            links: dict[str, Any] = dict(columns.at(points))
            found = conical_heights(**links, count=block.labels[-1])
        except ValueError:
            each = np.arange(rows.start, rows.stop) if isinstance(rows, slice) else rows
            if each.size == 1:
                heights[each] = np.nan
                only = [column.tolist()[0] for column in values]
                self._one(int(each[0]), only, {block.name: heights}, status)
                return
            wrong = wrong_chains(links, each.size)
            parts = [*np.flatnonzero(wrong)[:, np.newaxis], np.flatnonzero(~wrong)]
            if len(parts) == 1:  # what is wrong is not seen from here: halves, down to it
                parts = np.array_split(parts[0], 2)
            for part in parts:
                if part.size:
                    self._heights(each[part], [column[part] for column in values], columns, heights, status)
            return
        heights[rows] = found[..., block.labels[0] - 1 :]

    @property
    def _scene(self) -> Scene:
        """The base scene; a dict is shared by threads, at worst two of them make it."""
        if "scene" not in self._kept:
            self._kept["scene"] = Scene.from_dict(self.base)
        return self._kept["scene"]  # type: ignore[no-any-return]
