# SPDX-License-Identifier: GPL-3.0-or-later
"""From the table [vary] of a study to the numbers of each point: grids and random numbers."""

from __future__ import annotations

import math
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, Literal, get_origin

import numpy as np
from msgspec import UNSET
from numpy.typing import NDArray

from . import _scene_file
from ._arguments import read_only
from ._scene_error import SceneError
from ._study_paths import Path, path_of, quantity_of
from ._study_tables import Vary
from ._units import si_value

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
    annotation = _scene_file._annotation_at(kind, key.rpartition("[")[0] if key.endswith("]") else key)
    parts = list(_scene_file._parts_of(annotation))
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


def values_at(axes: Sequence[Axis], samples: int, seed: int, start: int, stop: int) -> list[Values]:
    """Of each axis, its number at the points start <= k < stop; not to be written to."""
    shape = shape_of(axes, samples)
    strides = iter([math.prod(shape[k + 1 :]) for k in range(len(shape))])
    return [
        _drawn(axis, seed, start, stop) if axis.values is None else _repeated(axis.values, next(strides), start, stop)
        for axis in axes
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


def _drawn(axis: Axis, seed: int, start: int, stop: int) -> Values:
    """Random numbers by their points alone: whoever draws them, in whatever pieces, finds the same."""
    stream = zlib.crc32(axis.key.encode())
    blocks = range(start // BLOCK, (stop - 1) // BLOCK + 1)
    parts = []
    for block in blocks:
        first = block * BLOCK
        numbers = _block(axis.law, *axis.law_numbers, seed, stream, block)
        parts.append(numbers[max(start - first, 0) : stop - first])
    return parts[0] if len(parts) == 1 else np.concatenate(parts)


@lru_cache(maxsize=64)
def _block(law: str, one: float, two: float, seed: int, stream: int, block: int) -> Values:
    random = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=(stream, block))))
    if law == "normal":
        return read_only(random.normal(one, two, BLOCK))
    low, high = (math.log(one), math.log(two)) if law == "log_uniform" else (one, two)
    numbers = random.random(BLOCK)
    numbers *= high - low
    numbers += low
    return read_only(np.exp(numbers) if law == "log_uniform" else numbers)
