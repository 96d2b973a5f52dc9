# SPDX-License-Identifier: GPL-3.0-or-later
"""From the table [vary] of a study to the numbers at each point: grids and random numbers."""

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
from ..scenes.error import SceneError
from ..scenes.tables import Table
from ..systems.units import SI, si_value

BLOCK = 65536  # random numbers are drawn in blocks of so many points, each from a stream of its own
MAX_STEPS = 10**7
MAX_POINTS = 10**12

Values = NDArray[Any]
Path = tuple[str | int, ...]
NumberOrText = float | str
Samples = Annotated[int, Meta(ge=1, le=MAX_POINTS)]
TwoNumbers = Annotated[list[NumberOrText], Meta(min_length=2, max_length=2)]

_PATH = re.compile(r"[a-z_]+(\[\d{1,9}\])?(\.[a-z_]+(\[\d{1,9}\])?)*")
_SPEED = r"\.(angular_speed|conical_height)"
_ASKED = re.compile(rf"ask\.(shapes{_SPEED}|response{_SPEED}(\[\d+\]|\.from|\.to)?)")
_PERCENT = re.compile(r"\s*([0-9.eE+-]+)\s*%\s*")


class Vary(Table, frozen=True, rename={"first": "from", "last": "to"}):
    """The values of one number of the scene. Numbers are SI or text with a unit, as in the scene.

    Attributes
    ----------
    first, last : float or str
        Keys ``from`` and ``to``: a grid from one to the other, both included.
    steps : int
        Number of values of this grid.
    log : bool
        Whether the grid has equal ratios instead of equal differences.
    values : list of float, str or bool
        Instead: a grid of these values.
    uniform : [low, high]
        Instead: random numbers with low <= number < high. ``[middle, "5 %"]`` is middle plus or minus 5 %.
    normal : [mean, deviation]
        Instead: random numbers of the normal distribution. ``[mean, "5 %"]``: the deviation is 5 % of the mean.
    log_uniform : [low, high]
        Instead: random numbers whose logarithm is uniform. ``[middle, "5 %"]`` is middle / 1.05 to middle * 1.05.
    name : str, optional
        Name of the column; the path if left out.
    """

    first: Annotated[NumberOrText | UnsetType, Meta(description="The first value of a grid.")] = UNSET
    last: Annotated[NumberOrText | UnsetType, Meta(description="Its last value.")] = UNSET
    steps: Annotated[Samples | UnsetType, Meta(description="Number of values, both ends included.")] = UNSET
    log: Annotated[bool, Meta(description="Whether in equal ratios instead of equal differences.")] = False
    values: Annotated[
        Annotated[list[bool | float | str], Meta(min_length=1)] | UnsetType,
        Meta(description="Instead: a grid of these values."),
    ] = UNSET
    uniform: Annotated[
        TwoNumbers | UnsetType, Meta(description='Instead: random, [low, high] or [middle, "5 %"].')
    ] = UNSET
    normal: Annotated[
        TwoNumbers | UnsetType, Meta(description='Instead: random, [mean, deviation] or [mean, "5 %"].')
    ] = UNSET
    log_uniform: Annotated[
        TwoNumbers | UnsetType,
        Meta(description='Instead: random with a uniform logarithm, [low, high] or [middle, "5 %"].'),
    ] = UNSET
    name: Annotated[str | UnsetType, Meta(description="Name of the column; the path if left out.")] = UNSET


@dataclass(frozen=True, eq=False)
class Axis:
    """One number of the scene, and its values at the points.

    Attributes
    ----------
    key, name : str
        The path as the study writes it, and the name of the column.
    path : tuple
        Its steps.
    values : ndarray or None
        Values of a grid; None where the numbers are random.
    law, law_numbers : str, tuple of float
        The distribution of random numbers: normal (mean, deviation), uniform or log_uniform (low, high).
    """

    key: str
    name: str
    path: Path
    values: Values | None
    law: str = ""
    law_numbers: tuple[float, float] = (0.0, 0.0)

    @property
    def quantity(self) -> str:
        """The quantity of the number, a key of `systems.units.SI`."""
        return quantity_of(self.path)

    @property
    def is_number(self) -> bool:
        """Whether the values are real numbers; others (whole numbers, words) may change what the scene consists of."""
        return self.values is None or self.values.dtype.kind == "f"

    def examples(self) -> list[Any]:
        """The ends of a grid, all its words, or a number in the middle of random ones."""
        if self.values is None:
            one, two = self.law_numbers
            return [one if self.law == "normal" else one + (two - one) / 2]
        if self.values.dtype.kind in "fi":
            return [self.values.min().item(), self.values.max().item()]
        return np.unique(self.values).tolist()  # type: ignore[no-any-return]


def path_of(text: str, refuse: SceneError) -> Path:
    """The steps of a path; `refuse` is raised with a reason where it is none."""
    if _PATH.fullmatch(text) is None:
        raise SceneError(refuse.source, refuse.key, "is no path into a scene such as links[0].mass")
    if text in ("title", "description", "schema_version", "held"):
        raise SceneError(refuse.source, refuse.key, "cannot be varied")
    if text.startswith("ask") and _ASKED.fullmatch(text) is None:
        reason = "cannot be varied: of [ask] only the speeds of ask.shapes and ask.response can"
        raise SceneError(refuse.source, refuse.key, reason)
    return tuple(int(index) if index else name for name, index in re.findall(r"([a-z_]+)|\[(\d+)\]", text))


def quantity_of(path: Path) -> str:
    """The quantity of the number there, a key of `systems.units.SI`; a length where the name is none."""
    return next((step for step in reversed(path) if isinstance(step, str) and step in SI), "length")


def with_value(data: Any, path: Path, value: Any, refuse: SceneError) -> Any:
    """A copy of `data` with the value there; tables that are not on the path are shared."""
    if not path:
        return value
    step, rest = path[0], path[1:]
    if isinstance(step, str):
        table = data if isinstance(data, dict) else {}
        return {**table, step: with_value(table.get(step), rest, value, refuse)}
    if not isinstance(data, list) or step >= len(data):
        count = len(data) if isinstance(data, list) else 0
        there = f"there are {count}, counted from 0" if count else "there is no such list"
        raise SceneError(refuse.source, refuse.key, f"the scene has nothing at [{step}]: {there}")
    return [*data[:step], with_value(data[step], rest, value, refuse), *data[step + 1 :]]


def axis_of(key: str, table: Vary, kind: type, source: str) -> Axis:
    """The axis that an entry of [vary] describes; `kind` is the class of scenes."""
    refuse = SceneError(source, f'vary."{key}"', "")
    path = path_of(key, refuse)
    name = key if table.name is UNSET else str(table.name)
    if not name.strip() or "/" in name or name == "." or not name.isprintable():
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
        return Axis(key, name, path, numbers.grid(table) if given[0] == "from" else numbers.listed(table, parts))
    if whole or not (annotation is None or float in parts):
        raise SceneError(source, refuse.key, "takes no random numbers; give values")
    return Axis(key, name, path, None, given[0], numbers.law(given[0], getattr(table, given[0])))


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
        if table.steps > MAX_STEPS:
            raise self.error("steps", f"must be at most {MAX_STEPS:,}, got {table.steps:,}")
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
        if any(get_origin(part) is Literal or part is bool for part in parts):
            if len({type(value) for value in table.values}) != 1:
                raise self.error("values", "must be all of one kind")
            return np.array(table.values)
        for k, value in enumerate(table.values):
            if isinstance(value, bool):
                raise self.error(f"values[{k}]", f"must be a number, got {value}")
        values = np.array([self.number(f"values[{k}]", value) for k, value in enumerate(table.values)])
        return values.astype(np.int64) if self.whole else values

    def law(self, law: str, given: Sequence[Any]) -> tuple[float, float]:
        one = self.number(f"{law}[0]", given[0])
        percent = _PERCENT.fullmatch(given[1]) if isinstance(given[1], str) else None
        if percent is None:
            two = self.number(f"{law}[1]", given[1])
        else:
            try:
                part = float(percent[1]) / 100
            except ValueError:
                reason = f'must be a number or a percentage such as "5 %", got "{given[1]}"'
                raise self.error(f"{law}[1]", reason) from None
            if not 0 < part < math.inf:
                raise self.error(f"{law}[1]", f'a percentage must be positive, got "{given[1]}"')
            spread = abs(one) * part
            one, two = {
                "normal": (one, spread),
                "uniform": (one - spread, one + spread),
                "log_uniform": (one / (1 + part), one * (1 + part)),
            }[law]
        if law == "normal" and not two >= 0:
            raise self.error(law, f"its deviation must not be negative, got {given[1]}")
        if law == "log_uniform" and not one > 0:
            raise self.error(law, f"must be positive, got {given[0]}")
        if law != "normal" and not one < two:
            raise self.error(law, f"its low end must lie below its high end, got {list(given)}")
        return one, two


def shape_of(axes: Sequence[Axis], samples: int) -> tuple[int, ...]:
    """Number of values of each grid, then samples if there are random numbers; the last counts fastest."""
    grid = [axis.values.size for axis in axes if axis.values is not None]
    return (*grid, samples) if any(axis.values is None for axis in axes) else tuple(grid)


class Reader:
    """The numbers of the axes at stretches of points; fastest if each begins where the last ended."""

    def __init__(self, axes: Sequence[Axis], samples: int, seed: int) -> None:
        shape = shape_of(axes, samples)
        strides = iter([math.prod(shape[k + 1 :]) for k in range(len(shape))])
        self._grids = [(axis.values, next(strides)) if axis.values is not None else None for axis in axes]
        self._draws = [_Draws(axis, seed) if axis.values is None else None for axis in axes]

    def at(self, start: int, stop: int) -> list[Values]:
        """For each axis its numbers at the points start <= k < stop; not to be written to."""
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
    """Random numbers that depend on their point alone, in whatever pieces they are drawn.

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
