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

from . import _core
from ._arguments import Floats
from ._batch import conical_heights
from ._scene_error import SceneError
from ._study_axes import Axis, Values, shape_of, values_at
from ._study_batch import gravity_at, links_at
from ._study_find import NOT_MET, REFUSED, Arrays, Block, found_at, put
from ._study_paths import with_value
from .scene import Scene

MOST_SENTENCES = 20  # kept of the points that are refused, of each stretch
FORMAT = 1
_NOWHERE = SceneError("study", "vary", "")


@dataclass(frozen=True)
class Stretch:
    """The points start <= k < stop: what was found, a status for each, sentences for those refused, seconds taken."""

    start: int
    stop: int
    arrays: Arrays
    status: NDArray[np.uint8]
    refused: dict[int, str]
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
        return values_at(self.axes, self.samples, self.seed, start, stop)

    def scene_data(self, values: list[Any]) -> dict[str, Any]:
        """The scene with these numbers, as plain data."""
        data = self.base
        for axis, value in zip(self.axes, values, strict=True):
            data = with_value(data, axis.path, value, _NOWHERE)
        return data

    def fingerprint(self) -> str:
        """Of everything that the numbers depend on."""
        from . import __version__

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

    def empty(self, points: int) -> Arrays:
        """Arrays for so many points, nothing found in them."""
        return {block.name: block.empty(points) for block in self.stored}

    @property
    def stored(self) -> tuple[Block, ...]:
        """The blocks that are computed; speeds of batches follow from the heights."""
        return tuple(block for block in self.blocks if not (self.batched and block.name == "angular_speed"))

    def speeds(self, heights: Floats) -> Floats:
        """Whirl speeds of batches, of all points."""
        gravity = np.asarray(gravity_at(self._scene, self._at(0, self.points)))
        speeds = np.full_like(heights, np.nan)
        rows = np.isfinite(heights)
        each = np.broadcast_to(gravity[..., np.newaxis], heights.shape)
        speeds[rows] = _core.conical_pendulum_angular_speed(heights[rows], each[rows])
        return speeds

    def found(self, start: int, stop: int, stopped: Callable[[], bool] | None = None) -> Stretch:
        """The points of a stretch; whatever the stretch, the same numbers at each."""
        began = time.perf_counter()
        arrays, status, refused = self.empty(stop - start), np.zeros(stop - start, np.uint8), {}
        if self.batched:
            self._heights(start, stop, start, arrays["conical_height"], status, refused)
        else:
            columns = [column.tolist() for column in self.values(start, stop)]
            for row, values in enumerate(zip(*columns, strict=True)):
                if stopped is not None and stopped():
                    raise KeyboardInterrupt
                self._one(start + row, row, list(values), arrays, status, refused)
        return Stretch(start, stop, arrays, status, refused, time.perf_counter() - began)

    def _one(
        self, point: int, row: int, values: list[Any], arrays: Arrays, status: NDArray[np.uint8], refused: dict[int, str]
    ) -> None:
        try:
            found, good = found_at(Scene.from_dict(self.scene_data(values), "scene"), self.find)
        except (ValueError, OverflowError) as error:
            status[row] = REFUSED
            if len(refused) < MOST_SENTENCES:
                refused[point] = str(error).removeprefix("scene: ")
            return
        put(arrays, self.stored, row, found)
        status[row] = 0 if good else NOT_MET

    def _heights(
        self,
        start: int,
        stop: int,
        origin: int,
        heights: Floats,
        status: NDArray[np.uint8],
        refused: dict[int, str],
    ) -> None:
        """Heights of plain chains; where a batch is refused its halves, down to the chain that is to blame."""
        (block,) = self.stored
        try:
            found = conical_heights(**links_at(self._scene, self._at(start, stop)), count=block.labels[-1])
        except ValueError:
            if stop - start > 1:
                middle = (start + stop) // 2
                self._heights(start, middle, origin, heights, status, refused)
                self._heights(middle, stop, origin, heights, status, refused)
            else:
                values = [column.tolist()[0] for column in self.values(start, stop)]
                self._one(start, start - origin, values, {block.name: heights}, status, refused)
            return
        heights[start - origin : stop - origin] = found[..., block.labels[0] - 1 :]

    def _at(self, start: int, stop: int) -> dict[Any, Floats]:
        values = self.values(start, stop)
        return {axis.path: np.asarray(column, float) for axis, column in zip(self.axes, values, strict=True)}

    @property
    def _scene(self) -> Scene:
        """The base scene; a dict is shared by threads, at worst two of them make it."""
        if "scene" not in self._kept:
            self._kept["scene"] = Scene.from_dict(self.base)
        return self._kept["scene"]  # type: ignore[no-any-return]
