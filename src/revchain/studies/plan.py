# SPDX-License-Identifier: GPL-3.0-or-later
"""The plan of a study: its axes, the results of each point, and their computation; a worker needs nothing else."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType, convert
from numpy.typing import NDArray

from ..scenes.ask import DEFAULT_MODES, AskModes, Spread
from ..scenes.chain import Numbers
from ..scenes.scene import Scene
from .axes import Axis, with_value
from .batch import Links

SUCCESS, NOT_MET, REFUSED = 1, 2, 3  # the status of a point; 0 if it has not been computed
Values = list[NDArray[Any]]  # the numbers of each axis, one for each point
Rows = dict[str, NDArray[Any]]  # arrays by name, with a row for each point
STATUS = ("success", "tolerance_not_met", "refused")
_SPEED = ("angular_speed", "conical_height", "error_bound", "speed_error_bound")
_SHAPE = ("lowest_inclination", "top_inclination", "free_end_offset", "top_tension")
_RESPONSE = ("response_angular_speed", "response_free_end_offset", "response_largest_offset", "support_force")
_UNITS = {"speed": "rad/s", "height": "m", "inclination": "rad", "offset": "m", "tension": "N", "force": "N"}


@dataclass(frozen=True)
class Block:
    """A result of each point: one number, or one for each mode, shape or speed."""

    name: str
    kind: str  # "f8", "i8" or "?"; NaN, 0 or False stands for a missing result
    along: str = ""  # "mode", "shape", "speed", or empty for one number
    labels: tuple[int, ...] = ()  # numbers of the modes, shapes or speeds

    @property
    def each(self) -> tuple[int, ...]:
        """The shape of the results of one point."""
        return (len(self.labels),) if self.along else ()

    @property
    def columns(self) -> list[str]:
        """Names of its columns in a table."""
        return [f"{self.name}_{label}" for label in self.labels] if self.along else [self.name]

    @property
    def attributes(self) -> dict[str, str]:
        """The SI unit under the key `units`; empty for a number without one."""
        word = self.name.rpartition("_")[2]
        return {"units": _UNITS[word]} if word in _UNITS else {}


@dataclass(frozen=True, eq=False)
class Plan:
    """The data that a worker needs; they can be sent to another process."""

    base: dict[str, Any]  # the scene as plain data
    axes: tuple[Axis, ...]
    shape: tuple[int, ...]  # number of values of each grid, then of samples; the last one varies fastest
    seed: int
    find: tuple[str, ...]  # "modes", "shapes", "response"
    blocks: tuple[Block, ...]  # the results
    links: Links | None  # how links follow the varied numbers, if heights come from `revchain.conical_heights`

    @property
    def points(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    @property
    def is_random(self) -> bool:
        """Whether random numbers are varied."""
        return any(axis.values is None for axis in self.axes)

    def rows(self, points: int | None = None) -> Rows:
        """Arrays for the results and the status of this number of points; all points if left out."""
        points = self.points if points is None else points
        results = {block.name: np.zeros((points, *block.each), block.kind) for block in self.blocks}
        return {**results, "status": np.zeros(points, np.int8)}

    def values(self) -> Values:
        """The numbers of each axis at all points."""
        grids = [axis.values for axis in self.axes if axis.values is not None]
        samples, meshes = self.points // math.prod(map(len, grids)), iter(np.meshgrid(*grids, indexing="ij"))
        return [
            axis.drawn(self.seed, self.points) if axis.values is None else np.repeat(next(meshes), samples)
            for axis in self.axes
        ]

    def scene(self, values: Sequence[Any]) -> dict[str, Any]:
        """The data of the scene with these numbers."""
        data = self.base
        for axis, value in zip(self.axes, values, strict=True):
            data = with_value(data, axis.path, value)
        return data

    def solve(self, values: Values, rows: Rows) -> None:
        """Put the results at points with these numbers into `rows`; they do not depend on the other points."""
        if self.links is not None:
            self.links.solve(values, self.blocks[0].labels[0], rows)
        left = np.flatnonzero(rows["status"] == 0)
        for block in self.blocks if left.size else ():
            rows[block.name][left] = math.nan if block.kind == "f8" else 0
        for k, *numbers in zip(left.tolist(), *(column[left].tolist() for column in values), strict=True):
            try:
                found, proved = answers(convert(self.scene(numbers), Scene), self.find)  # the questions check the scene
            except (ValueError, OverflowError):
                rows["status"][k] = REFUSED
                continue
            rows["status"][k] = SUCCESS if proved else NOT_MET
            for block in self.blocks:
                row = rows[block.name][k : k + 1].reshape(-1)
                there = np.ravel(found[block.name])[: row.size]
                row[: there.size] = there


def answers(scene: Scene, find: Sequence[str]) -> tuple[dict[str, Any], bool]:
    """The results of one scene, by the names of the blocks, and whether all are complete and within their tolerance."""
    found: dict[str, Any] = {}
    proved = True
    if "modes" in find:
        modes: Any = scene.modes()
        if scene.is_rigged:
            for turn, which in (("forward", modes.direction > 0), ("backward", modes.direction < 0)):
                found |= {f"{turn}_{name}": np.abs(getattr(modes, name)[which]) for name in _SPEED}
            found |= {"other_modes": modes.other_available, "modes_complete": modes.complete}
        else:
            found |= {name: getattr(modes, name) for name in _SPEED[:3]}
        proved = modes.status == "success"
    if "shapes" in find:
        shapes: Any = scene.steady_shapes()
        found |= {"shapes": len(shapes), "shapes_complete": shapes.complete}
        found["half_waves"] = [s.half_waves for s in shapes]
        for name, field in zip(_SHAPE, ("inclination", "inclination", "offset", "tension"), strict=True):
            found[name] = [getattr(s, field)[-1 if name.startswith("top") else 0] for s in shapes]
        found["shape_error_bound"] = [s.error_bound for s in shapes]
        proved = proved and bool(shapes.complete)
    if "response" in find:
        moved = scene.response()
        offset = np.atleast_2d(moved.offset)
        numbers = [moved.angular_speed, offset[:, 0], np.abs(offset).max(axis=1), moved.support_force]
        found |= dict(zip(_RESPONSE, numbers, strict=True)) | {"response_error_bound": moved.error_bound}
        proved = proved and bool(np.isfinite(moved.error_bound).all())
    return found, proved


def asked_of(scene: Scene, wanted: Sequence[str] | UnsetType, numbers: Numbers) -> tuple[str, ...]:
    """The questions in the order of the columns: `wanted`, or those of the scene. Errors are noted."""
    asked: list[str] = [name for name in ("modes", "shapes", "response") if name in scene.asks] or ["modes"]
    if isinstance(wanted, UnsetType):
        for name in set(scene.asks) - {"modes", "shapes", "response"}:
            numbers.refuse(f"scene.ask.{name}", 'is not for studies; say what is: find = ["modes"]')
    else:
        for k, name in enumerate(wanted):
            if name not in ("modes", *asked):
                numbers.refuse(f"find[{k}]", f"the scene does not say at which speed: [ask.{name}]")
        asked = [name for name in ("modes", "shapes", "response") if name in wanted]
    for name in ("conical_height", "angular_speed"):
        if "modes" in asked and getattr(scene.ask.modes, name, UNSET) is not UNSET:
            numbers.refuse(f"scene.ask.modes.{name}", "gives each point another number of modes; give count and first")
    if "response" in asked and (scene.is_held or scene.cord is not UNSET):
        numbers.refuse("scene.ask.response", f"does not go with {'held' if scene.is_held else 'cord'}")
    if "modes" in asked and not isinstance(scene.held, UnsetType) and scene.held.span is not UNSET:
        numbers.refuse("scene.held.span", 'makes the chain bent, without modes: write find = ["shapes"]')
    return tuple(asked)


def blocks_of(scene: Scene, largest: Scene, find: tuple[str, ...], max_shapes: int, bounds: bool) -> tuple[Block, ...]:
    """The results of each point; `largest` is the scene of the point with the most modes."""
    blocks: list[Block] = []
    system = scene.system()
    if "modes" in find:
        labels = _modes_of(scene, largest)
        names = list(_SPEED[: (4 if scene.is_rigged else 3) if bounds else 2])
        turns = ["forward_", "backward_"] if system.has_momentum else ["forward_"]
        for turn in turns if scene.is_rigged else [""]:
            blocks += [Block(turn + name, "f8", "mode", labels) for name in names]
        if scene.is_rigged:
            blocks += [Block("other_modes", "i8"), Block("modes_complete", "?")]
    if "shapes" in find:
        labels = tuple(range(1, max_shapes + 1))
        blocks += [Block("shapes", "i8"), Block("shapes_complete", "?"), Block("half_waves", "i8", "shape", labels)]
        blocks += [Block(name, "f8", "shape", labels) for name in (*_SHAPE, *["shape_error_bound"] * bounds)]
    if "response" in find:
        count = _speeds_of(scene.ask.response)
        names = [*_RESPONSE, *["response_error_bound"] * bounds]
        labels = tuple(range(1, count + 1))
        blocks += [Block(name, "f8", "" if count == 1 else "speed", labels) for name in names]
    return tuple(blocks)


def _modes_of(scene: Scene, largest: Scene) -> tuple[int, ...]:
    """Numbers of the modes with columns: those asked for, at most those of the point with the most modes."""
    ask, system = scene.ask.modes, largest.system()
    ask = AskModes() if isinstance(ask, UnsetType) else ask
    first = 1 if isinstance(ask.first, UnsetType) else ask.first
    if system._kind == "rig":
        there = 2 * (system.size + 1)  # in each direction
    else:
        there = system.size if system._kind == "chain" else system.mode_count or DEFAULT_MODES
    there = max(there - first + 1, 1)
    count = ask.count if isinstance(ask.count, int) else there if ask.count == "all" else min(DEFAULT_MODES, there)
    return tuple(range(first, first + count))


def _speeds_of(ask: Any) -> int:
    """Number of speeds of [ask.response]."""
    given = ask.conical_height if ask.angular_speed is UNSET else ask.angular_speed
    return given.steps if isinstance(given, Spread) else len(given) if isinstance(given, list) else 1
