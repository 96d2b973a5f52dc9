# SPDX-License-Identifier: GPL-3.0-or-later
"""From the table [vary] of a study to the numbers of each point: grids and random numbers."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Literal, get_origin

import numpy as np
from msgspec import UNSET
from numpy.typing import NDArray

from ..scenes import parse
from ..scenes.error import SceneError
from ..systems.units import si_value
from .paths import Path, path_of, quantity_of
from .tables import Vary

BLOCK = 65536  # random numbers are drawn in blocks of so many points, each from a stream of its own
MOST_STEPS = 10**7

Values = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Axis:
    """One number of the scene, and what it is at each point.

    Attributes
    ----------
    key, name : str
        The path as the study writes it, and what its column is called.
    path : tuple
        Its steps.
    values : ndarray or None
        Of a grid; None where the numbers are random.
    law, law_numbers : str, tuple of float
        The distribution of random ones, and its two numbers.
    """

    key: str
    name: str
    path: Path
    values: Values | None
    law: str = ""
    law_numbers: tuple[float, float] = (0.0, 0.0)


def axis_of(key: str, table: Vary, kind: type, source: str) -> Axis:
    """The axis that an entry of [vary] means; `kind` is the class of scenes."""
    refuse = SceneError(source, f'vary."{key}"', "")
    path = path_of(key, refuse)
    name = key if table.name is UNSET else str(table.name)
    if not name.strip() or "/" in name or not name.isprintable():
        raise SceneError(source, f"{refuse.key}.name", f'must be a printable name without "/", got {name!r}')
    given = [law for law in ("values", "uniform", "normal", "log_uniform") if getattr(table, law) is not UNSET]
    if table.first is not UNSET or table.last is not UNSET or table.steps is not UNSET:
        given.insert(0, "from")
    if len(given) != 1:
        choice = "give from, to and steps, or one of values, uniform, normal, log_uniform"
        raise SceneError(source, refuse.key, choice + (f"; got {' and '.join(given)}" if given else ""))
    if table.log and given[0] != "from":
        raise SceneError(source, f"{refuse.key}.log", "goes with from, to and steps")
    annotation = parse._annotation_at(kind, key.rpartition("[")[0] if key.endswith("]") else key)
    parts = list(parse._parts_of(annotation))
    whole = int in parts and float not in parts
    numbers = _Numbers(refuse, path, whole)
    if given[0] in ("from", "values"):
        values = numbers.grid(table) if given[0] == "from" else numbers.listed(table, parts)
        return Axis(key, name, path, values)
    if whole or not (annotation is None or float in parts):
        raise SceneError(source, refuse.key, "takes no random numbers; give values")
    law = given[0]
    return Axis(key, name, path, None, law, numbers.law(law, getattr(table, law)))


class _Numbers:
    """Numbers of one entry, in SI units, and errors with the key."""

    def __init__(self, refuse: SceneError, path: Path, whole: bool) -> None:
        self.refuse = refuse
        self.quantity = quantity_of(path)
        self.whole = whole

    def error(self, key: str, reason: str) -> SceneError:
        return SceneError(self.refuse.source, f"{self.refuse.key}.{key}", reason)

    def number(self, key: str, given: Any) -> float:
        try:
            found = si_value(given, self.quantity) if isinstance(given, str) else float(given)
        except ValueError as error:
            raise self.error(key, str(error)) from None
        if not math.isfinite(found):
            raise self.error(key, f"must be finite, got {given}")
        if self.whole and found != round(found):
            raise self.error(key, f"must be a whole number, got {given}")
        return found

    def grid(self, table: Vary) -> Values:
        for key, value in (("from", table.first), ("to", table.last), ("steps", table.steps)):
            if value is UNSET:
                raise self.error(key, "is missing")
        assert isinstance(table.steps, int)
        low, high = self.number("from", table.first), self.number("to", table.last)
        if table.steps > MOST_STEPS:
            raise self.error("steps", f"must be at most {MOST_STEPS:,}, got {table.steps:,}")
        if table.log and not (low > 0 and high > 0):
            raise self.error("log", "needs from and to that are positive")
        values = np.geomspace(low, high, table.steps) if table.log else np.linspace(low, high, table.steps)
        if self.whole:
            if np.any(values != np.round(values)):
                raise self.error("steps", f"makes numbers that are not whole, such as {values[1]:g}")
            return values.astype(np.int64)
        return values

    def listed(self, table: Vary, parts: list[Any]) -> Values:
        assert isinstance(table.values, list)
        words = any(get_origin(part) is Literal or part is bool for part in parts)
        if words:
            kinds = {type(value) for value in table.values}
            if len(kinds) != 1:
                raise self.error("values", "must be all of one kind")
            return np.array(table.values)
        for k, value in enumerate(table.values):
            if isinstance(value, bool):
                raise self.error(f"values[{k}]", f"must be a number, got {value}")
        values = np.array([self.number(f"values[{k}]", value) for k, value in enumerate(table.values)])
        return values.astype(np.int64) if self.whole else values

    def law(self, law: str, given: Sequence[Any]) -> tuple[float, float]:
        one, two = (self.number(f"{law}[{k}]", value) for k, value in enumerate(given))
        if law == "normal" and not two >= 0:
            raise self.error(law, f"its deviation must not be negative, got {given[1]}")
        if law != "normal" and not one < two:
            raise self.error(law, f"its low end must lie below its high end, got {list(given)}")
        if law == "log_uniform" and not one > 0:
            raise self.error(law, f"must be positive, got {given[0]}")
        return one, two


def shape_of(axes: Sequence[Axis], samples: int) -> tuple[int, ...]:
    """How many values of each grid, and samples if there are random numbers: the last counts fastest."""
    grid = [axis.values.size for axis in axes if axis.values is not None]
    return (*grid, samples) if any(axis.values is None for axis in axes) else tuple(grid)


class Reader:
    """The numbers of the axes at one stretch of points after another; quickest if each begins where the last ended."""

    def __init__(self, axes: Sequence[Axis], samples: int, seed: int) -> None:
        shape = shape_of(axes, samples)
        strides = iter([math.prod(shape[k + 1 :]) for k in range(len(shape))])
        self._grids = [(axis.values, next(strides)) if axis.values is not None else None for axis in axes]
        self._draws = [_Draws(axis, seed) if axis.values is None else None for axis in axes]

    def at(self, start: int, stop: int) -> list[Values]:
        """Of each axis, its numbers at the points start <= k < stop; not to be written to."""
        return [
            _repeated(*grid, start, stop) if grid is not None else draws.at(start, stop)  # type: ignore[union-attr]
            for grid, draws in zip(self._grids, self._draws, strict=True)
        ]


def _repeated(values: Values, stride: int, start: int, stop: int) -> Values:
    """values[k // stride % size] at start <= k < stop, without a division at each k."""
    first, last = start // stride, (stop - 1) // stride
    runs, size = last - first + 1, values.size
    at = first % size
    if at + runs <= size:
        of_runs = values[at : at + runs]
    elif runs <= size:
        of_runs = np.concatenate([values[at:], values[: at + runs - size]])
    else:
        of_runs = np.tile(values, -(-(at + runs) // size))[at : at + runs]
    if stride == 1:
        return of_runs
    lengths = np.full(runs, stride)
    lengths[0] -= start - first * stride
    lengths[-1] -= (last + 1) * stride - stop
    return np.repeat(of_runs, lengths)


class _Draws:
    """Random numbers by their points alone: whoever draws them, in whatever pieces, finds the same.

    Each block of points has a stream of its own, which is kept as far as it has been drawn.
    """

    def __init__(self, axis: Axis, seed: int) -> None:
        self._law = axis.law
        self._one, self._two = axis.law_numbers
        if self._law == "log_uniform":
            self._one, self._two = math.log(self._one), math.log(self._two)
        self._seed, self._key = seed, zlib.crc32(axis.key.encode())
        self._place = -1  # of the point whose number comes next
        self._stream: np.random.Generator

    def at(self, start: int, stop: int) -> Values:
        numbers = np.empty(stop - start)
        first = start
        while first < stop:
            last = min(first - first % BLOCK + BLOCK, stop)
            self._go_to(first)
            self._draw(numbers[first - start : last - start])
            self._place = first = last
        return numbers

    def _go_to(self, point: int) -> None:
        behind = self._place // BLOCK == point // BLOCK and self._place <= point
        if not behind or self._place % BLOCK == 0:
            block = point // BLOCK
            sequence = np.random.SeedSequence(self._seed, spawn_key=(self._key, block))
            self._stream, self._place = np.random.Generator(np.random.SFC64(sequence)), block * BLOCK
        if self._place < point:
            self._draw(np.empty(point - self._place))

    def _draw(self, numbers: Values) -> None:
        if self._law == "normal":
            self._stream.standard_normal(out=numbers)
            numbers *= self._two
        else:
            self._stream.random(out=numbers)
            numbers *= self._two - self._one
        numbers += self._one
        if self._law == "log_uniform":
            np.exp(numbers, out=numbers)
