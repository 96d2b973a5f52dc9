# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers at each point from the table [vary] of a study: grids and random numbers."""

from __future__ import annotations

import math
import re
import zlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal, get_origin

import numpy as np
from msgspec import UNSET, Meta, UnsetType
from numpy.typing import NDArray

from ..scenes import parse
from ..scenes.chain import Numbers
from ..scenes.tables import Link, Table, fields_of, says
from ..systems.units import SI

BLOCK = 65536  # points in a block of random numbers; each block has its own stream
MAX_STEPS = 10**7
MAX_POINTS = 10**12

Values = NDArray[Any]
Path = tuple[str | int, ...]
NumberOrText = float | str
Samples = Annotated[int, Meta(ge=1, le=MAX_POINTS)]
Listed = Annotated[list[bool | float | str], Meta(min_length=1)]
TwoNumbers = Annotated[list[NumberOrText], Meta(min_length=2, max_length=2)]

_PATH = re.compile(r"[a-z_]+(\[\d{1,9}\])?(\.[a-z_]+(\[\d{1,9}\])?)*")
_SPEED = r"\.(angular_speed|conical_height)"
_ASKED = re.compile(rf"ask\.(shapes{_SPEED}|response{_SPEED}(\[\d+\]|\.from|\.to)?)")
_PERCENT = re.compile(r"[^%]*%\s*")
LAWS = ("uniform", "normal", "log_uniform")


class Vary(Table, frozen=True, rename={"first": "from", "last": "to"}):
    """The values of one number of the scene. Numbers are SI or text with a unit, as in the scene."""

    first: Annotated[NumberOrText | UnsetType, says("First value of a grid.")] = UNSET
    last: Annotated[NumberOrText | UnsetType, says("Last value of a grid.")] = UNSET
    steps: Annotated[Samples | UnsetType, says("Number of values of a grid, both ends included.")] = UNSET
    log: Annotated[bool, says("Whether the values have equal ratios instead of equal differences.")] = False
    values: Annotated[Listed | UnsetType, says("Values of a grid, instead of from, to and steps.")] = UNSET
    uniform: Annotated[
        TwoNumbers | UnsetType, says('Random numbers with a uniform distribution, [low, high] or [middle, "5 %"].')
    ] = UNSET
    normal: Annotated[
        TwoNumbers | UnsetType, says('Random numbers with a normal distribution, [mean, deviation] or [mean, "5 %"].')
    ] = UNSET
    log_uniform: Annotated[
        TwoNumbers | UnsetType, says('Random numbers with a uniform logarithm, [low, high] or [middle, "5 %"].')
    ] = UNSET
    name: Annotated[str | UnsetType, says("Name of the column; the path if left out.")] = UNSET


@dataclass(frozen=True, eq=False)
class Axis:
    """One number of the scene, and its values at the points."""

    key: str  # the path as the study writes it
    name: str  # of the column
    path: Path
    values: Values | None  # of a grid; None where the numbers are random
    law: str = ""  # "normal", "uniform" or "log_uniform"
    law_numbers: tuple[float, float] = (0.0, 0.0)  # mean and deviation, or low and high end

    @property
    def quantity(self) -> str:
        """The quantity of the number, a key of `systems.units.SI`."""
        return quantity_of(self.path)

    @property
    def is_number(self) -> bool:
        """Whether the values are real numbers; others (whole numbers, words) may change the structure of the scene."""
        return self.values is None or self.values.dtype.kind == "f"

    def examples(self) -> list[Any]:
        """Values to check: the ends of a grid, all its words, or a number in the middle of random ones."""
        if self.values is None:
            one, two = self.law_numbers
            return [one if self.law == "normal" else one + (two - one) / 2]
        if self.values.dtype.kind in "fi":
            return [self.values.min().item(), self.values.max().item()]
        return np.unique(self.values).tolist()  # type: ignore[no-any-return]


def path_of(text: str, numbers: Numbers) -> Path:
    """The steps of a path; empty for a wrong path, which is noted."""
    right = re.sub(r"^link\[", "links[", text.removeprefix("scene."))
    if (link := re.fullmatch(r"(links\.)?(\w+)", right)) and link[2] in [field.name for field in fields_of(Link)]:
        right = f"links[0].{link[2]}"
    if _PATH.fullmatch(text) is None:
        numbers.refuse("", "is no path into a scene such as links[0].mass")
    elif right != text:
        numbers.refuse("", f'is no path into a scene: write "{right}"')
    elif text in ("title", "description", "schema_version", "held") or text.endswith(".name"):
        numbers.refuse("", "cannot be varied")
    elif text.startswith("ask") and _ASKED.fullmatch(text) is None:
        numbers.refuse("", "cannot be varied: of [ask] only the speeds of ask.shapes and ask.response can")
    else:
        return tuple(int(index) if index else name for name, index in re.findall(r"([a-z_]+)|\[(\d+)\]", text))
    return ()


def quantity_of(path: Path) -> str:
    """The quantity of the number at a path, a key of `systems.units.SI`; a length if the name is not one."""
    return next((step for step in reversed(path) if isinstance(step, str) and step in SI), "length")


def with_value(data: Any, path: Path, value: Any) -> Any:
    """A copy of `data` with the value at the path; tables off the path are shared. A ValueError if there is no such place."""
    if not path:
        return value
    step, rest = path[0], path[1:]
    if isinstance(step, str):
        table = data if isinstance(data, dict) else {}
        return {**table, step: with_value(table.get(step), rest, value)}
    if not isinstance(data, list) or step >= len(data):
        count = len(data) if isinstance(data, list) else 0
        there = f"there are {count}, counted from 0" if count else "there is no such list"
        raise ValueError(f"the scene has nothing at [{step}]: {there}")
    return [*data[:step], with_value(data[step], rest, value), *data[step + 1 :]]


def axis_of(key: str, table: Vary, kind: type, numbers: Numbers) -> Axis | None:
    """The axis of an entry of [vary]; None if it is wrong, which is noted. `kind` is the class of scenes."""
    known, path = len(numbers.problems), path_of(key, numbers)
    name = key if isinstance(table.name, UnsetType) else table.name
    if not name.strip() or "/" in name or name == "." or not name.isprintable():
        numbers.refuse("name", f'must be a printable name without "/", got {parse.written(name)}')
    given = [law for law in ("values", *LAWS) if getattr(table, law) is not UNSET]
    if table.first is not UNSET or table.last is not UNSET or table.steps is not UNSET:
        given.insert(0, "from")
    if len(given) != 1:
        choice = "give from, to and steps, or one of values, uniform, normal, log_uniform"
        numbers.refuse("", choice + (f"; got {' and '.join(given)}" if given else ""))
    elif table.log and given[0] != "from":
        numbers.refuse("log", "goes with from, to and steps")
    if not path or len(given) != 1:
        return None
    annotation = parse._annotation_at(kind, key.rpartition("[")[0] if key.endswith("]") else key)
    parts, quantity = list(parse._parts_of(annotation)), quantity_of(path)
    whole = int in parts and float not in parts
    if given[0] in LAWS:
        if whole or not (annotation is None or float in parts):
            numbers.refuse("", "takes no random numbers; give values")
            return None
        axis = Axis(key, name, path, None, given[0], _law(given[0], getattr(table, given[0]), quantity, numbers))
    elif given[0] == "from":
        axis = Axis(key, name, path, _grid(table, quantity, whole, numbers))
    else:
        axis = Axis(key, name, path, _listed(table, parts, quantity, whole, numbers))
    return axis if len(numbers.problems) == known else None


def _number(key: str, given: Any, quantity: str, whole: bool, numbers: Numbers) -> float:
    found = numbers.value(key, given, quantity, "any")
    if whole and math.isfinite(found) and found != round(found):
        numbers.refuse(key, f"must be a whole number, got {parse.written(given)}")
    return found


def _grid(table: Vary, quantity: str, whole: bool, numbers: Numbers) -> Values | None:
    for key, value in (("from", table.first), ("to", table.last), ("steps", table.steps)):
        if value is UNSET:
            numbers.refuse(key, "is missing")
    low = _number("from", table.first, quantity, whole, numbers)
    high = _number("to", table.last, quantity, whole, numbers)
    if isinstance(table.steps, UnsetType) or math.isnan(low + high):
        return None
    if table.steps > MAX_STEPS:
        numbers.refuse("steps", f"must be at most {MAX_STEPS:,}, got {table.steps:,}")
        return None
    if table.log and not (low > 0 and high > 0):
        numbers.refuse("log", "needs from and to that are positive")
        return None
    values = np.geomspace(low, high, table.steps) if table.log else np.linspace(low, high, table.steps)
    if whole and np.any(values != np.round(values)):
        numbers.refuse("steps", f"makes numbers that are not whole, such as {values[1]:g}")
    return values.astype(np.int64) if whole else values


def _listed(table: Vary, parts: list[Any], quantity: str, whole: bool, numbers: Numbers) -> Values:
    assert isinstance(table.values, list)
    if any(get_origin(part) is Literal or part is bool for part in parts):
        if len({type(value) for value in table.values}) != 1:
            numbers.refuse("values", "must be all of one kind")
        return np.array(table.values)
    for k, value in enumerate(table.values):
        if isinstance(value, bool):
            numbers.refuse(f"values[{k}]", f"must be a number, got {parse.written(value)}")
    values = np.array([_number(f"values[{k}]", x, quantity, whole, numbers) for k, x in enumerate(table.values)])
    return values.astype(np.int64) if whole and np.isfinite(values).all() else values


def _law(law: str, given: Sequence[Any], quantity: str, numbers: Numbers) -> tuple[float, float]:
    one = numbers.value(f"{law}[0]", given[0], quantity, "any")
    percent = _PERCENT.fullmatch(given[1]) if isinstance(given[1], str) else None
    if percent is None:
        two = numbers.value(f"{law}[1]", given[1], quantity, "any")
    else:
        part = numbers.value(f"{law}[1]", given[1], "rtol", "positive")
        spread = abs(one) * part
        one, two = {
            "normal": (one, spread),
            "uniform": (one - spread, one + spread),
            "log_uniform": (one / (1 + part), one * (1 + part)),
        }[law]
    if law == "normal" and two < 0:
        numbers.refuse(law, f"its deviation must not be negative, got {given[1]}")
    elif law == "log_uniform" and one <= 0:
        numbers.refuse(law, f"must be positive, got {given[0]}")
    elif law != "normal" and one >= two:
        numbers.refuse(law, f"its low end must lie below its high end, got {parse.written(given)}")
    return one, two


def shape_of(axes: Sequence[Axis], samples: int) -> tuple[int, ...]:
    """Number of values of each grid, then samples if there are random numbers; the last one varies fastest."""
    grid = [axis.values.size for axis in axes if axis.values is not None]
    return (*grid, samples) if any(axis.values is None for axis in axes) else tuple(grid)


class Reader:
    """The numbers of the axes at stretches of points; fastest if each stretch starts where the last one ended."""

    def __init__(self, axes: Sequence[Axis], samples: int, seed: int) -> None:
        shape = shape_of(axes, samples)
        strides = iter([math.prod(shape[k + 1 :]) for k in range(len(shape))])
        self._grids = [(axis.values, next(strides)) if axis.values is not None else None for axis in axes]
        self._draws = [_Draws(axis, seed) if axis.values is None else None for axis in axes]

    def at(self, start: int, stop: int) -> list[Values]:
        """The numbers of each axis at the points start <= k < stop, as arrays that must not be changed."""
        return [
            _repeated(*grid, start, stop) if grid is not None else draws.at(start, stop)  # type: ignore[union-attr]
            for grid, draws in zip(self._grids, self._draws, strict=True)
        ]


def _repeated(values: Values, stride: int, start: int, stop: int) -> Values:
    """values[k // stride % size] at start <= k < stop, without a division at each k."""
    first, last = start // stride, (stop - 1) // stride
    runs, at = last - first + 1, start // stride % values.size
    of_runs = values[at : at + runs]
    if of_runs.size < runs:
        of_runs = np.tile(values, -(-(at + runs) // values.size))[at : at + runs]
    if stride == 1:
        return of_runs
    lengths = np.full(runs, stride)
    lengths[0] -= start - first * stride
    lengths[-1] -= (last + 1) * stride - stop
    return np.repeat(of_runs, lengths)


class _Draws:
    """Random numbers that depend only on their point, not on the pieces in which they are drawn.

    Each block of points has its own stream; the last one stays open where drawing stopped.
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
