# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers at each point, from the table [vary] of a study: grids and random numbers."""

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
from ..scenes.system import Numbers
from ..scenes.tables import Link, Table, fields_of, says
from ..systems.numbers import Floats
from ..systems.paths import Path, numbered, steps
from ..systems.units import SI, speed_unit, with_tolerance

MAX_STEPS = 10**7
MAX_POINTS = 10**12
LAWS = ("uniform", "normal", "log_uniform")

NumberOrText = float | str
Samples = Annotated[int, Meta(ge=1, le=MAX_POINTS)]
Listed = Annotated[list[bool | float | str], Meta(min_length=1)]
TwoNumbers = Annotated[list[NumberOrText], Meta(min_length=2, max_length=2)]

_SPEED = r"\.(angular_speed|conical_height)"
_ASKED = re.compile(rf"ask\.(shapes{_SPEED}|response{_SPEED}(\[\d+\]|\.from|\.to)?|drag\.air_density|(drag|equilibria)\.angular_speed)")
_PERCENT = re.compile(r"[^%]*%\s*")


class Vary(Table, frozen=True, rename={"first": "from", "last": "to"}):
    """The values of one number of the scene. Numbers are SI or text with a unit, as in the scene."""

    first: Annotated[NumberOrText | UnsetType, says("First value of a grid.")] = UNSET
    last: Annotated[NumberOrText | UnsetType, says("Last value of a grid.")] = UNSET
    steps: Annotated[
        Samples | UnsetType, says("Number of values of a grid, both ends included; 1 gives only the first.")
    ] = UNSET
    log: Annotated[bool, says("Whether the values have equal ratios instead of equal differences.")] = False
    values: Annotated[Listed | UnsetType, says("Values of a grid, instead of from, to and steps.")] = UNSET
    uniform: Annotated[
        TwoNumbers | str | UnsetType,
        says('Random numbers with a uniform distribution, [low, high], [middle, "5 %"] or "38 m +- 0.5 m".'),
    ] = UNSET
    normal: Annotated[
        TwoNumbers | str | UnsetType, says('Random numbers with a normal distribution, [mean, deviation], [mean, "5 %"] or "38 m +- 0.5 m".')
    ] = UNSET
    log_uniform: Annotated[
        TwoNumbers | str | UnsetType, says('Random numbers with a uniform logarithm, [low, high] or [middle, "5 %"].')
    ] = UNSET
    name: Annotated[str | UnsetType, says("Name of the column; the path if left out.")] = UNSET


@dataclass(frozen=True, eq=False)
class Axis:
    """One number of the scene, and its values at the points."""

    key: str  # the path as the study writes it
    name: str  # of the column
    path: Path
    values: NDArray[Any] | None  # of a grid; None if the numbers are random
    law: str  # the key that gives the values: "from", "values", or a law of random numbers
    law_numbers: tuple[float, float]  # mean and deviation, or low and high end; zeros of a grid

    @property
    def is_number(self) -> bool:
        """Whether the values are real numbers."""
        return self.values is None or self.values.dtype.kind == "f"

    @property
    def unit(self) -> str:
        """The SI unit of the values; empty for words, whole numbers and exponents."""
        return SI[quantity_of(self.path)][0] if self.is_number else ""

    def examples(self) -> list[Any]:
        """Values to check: the ends of a grid, all its words, or the middle of random numbers."""
        if self.values is None:
            one, two = self.law_numbers
            return [one if self.law == "normal" else one + (two - one) / 2]
        if self.values.dtype.kind in "fi":
            return [self.values.min().item(), self.values.max().item()]
        return np.unique(self.values).tolist()  # type: ignore[no-any-return]

    def drawn(self, seed: int, count: int) -> Floats:
        """Random numbers of the first `count` points; each depends on law, seed, path and number of its point."""
        indexed = re.sub(r"\.(?=\[)", "", ".".join(f"[{step}]" if isinstance(step, int) else step for step in self.path))
        key = zlib.crc32(indexed.encode()), 0
        stream = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=key)))
        one, two = map(math.log, self.law_numbers) if self.law == "log_uniform" else self.law_numbers
        numbers = stream.normal(one, two, count) if self.law == "normal" else stream.uniform(one, two, count)
        return np.exp(numbers, out=numbers) if self.law == "log_uniform" else numbers


def with_value(data: Any, path: Path, value: Any) -> Any:
    """A copy of `data` with the value at the path, sharing other tables.

    Tables that are missing are made. An item of a list that is missing is a ValueError.
    """
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


def axis_of(key: str, table: Vary, kind: type, names: Sequence[str], numbers: Numbers) -> Axis | None:
    """The axis of an entry of [vary]; None if it is wrong, which is noted.

    `kind` is the class of scenes; `names` has the names of the links in the order of the file.
    """
    known = len(numbers.problems)
    try:
        at = numbered(key, names)
        path = steps(at)
        reason = _why_not_varied(at, path)
    except ValueError as error:
        path, reason = (), str(error)
    if reason:
        numbers.refuse("", reason)
    name = key if isinstance(table.name, UnsetType) else table.name
    if not name.strip() or "/" in name or name == "." or not name.isprintable():
        numbers.refuse("name", f'must be a printable name without "/", got {parse.written(name)}')
    is_grid = any(given is not UNSET for given in (table.first, table.last, table.steps))
    laws = ["from"] * is_grid + [law for law in ("values", *LAWS) if getattr(table, law) is not UNSET]
    if len(laws) != 1:
        choice = "give from, to and steps, or one of values, uniform, normal, log_uniform"
        numbers.refuse("", choice + (f"; got {' and '.join(laws)}" if laws else ""))
    elif table.log and not is_grid:
        numbers.refuse("log", "goes with from, to and steps")
    if reason or len(laws) != 1:
        return None
    annotation = parse._annotation_at(kind, at.rpartition("[")[0] if at.endswith("]") else at)
    parts, values, ends = list(parse._parts_of(annotation)), None, (0.0, 0.0)
    is_whole = int in parts and float not in parts
    if laws[0] in LAWS and (is_whole or not (annotation is None or float in parts)):
        numbers.refuse("", "takes no random numbers; give values")
    elif laws[0] in LAWS:
        ends = _law(laws[0], getattr(table, laws[0]), quantity_of(path), numbers)
    elif is_grid:
        values = _grid(table, quantity_of(path), numbers)
    else:
        values = _listed(table.values, parts, quantity_of(path), numbers)
    if is_whole and values is not None and np.isfinite(values).all():
        whole = np.round(values)
        values = np.where(np.abs(values - whole) <= 1e-9 * np.maximum(np.abs(values), 1), whole, values)
        for k in np.flatnonzero(values != np.round(values))[:1].tolist():
            such = "makes numbers that are not whole, such as" if is_grid else "must be a whole number, got"
            numbers.refuse("steps" if is_grid else f"values[{k}]", f"{such} {values[k]:g}")
        values = values.astype(np.int64)
    return Axis(key, name, path, values, laws[0], ends) if len(numbers.problems) == known else None


def _why_not_varied(text: str, path: Path) -> str:
    """The reason why the value at a path cannot be varied; empty if it can."""
    right = re.sub(r"^link\[", "links[", text.removeprefix("scene."))
    if (last := right.removeprefix("links.")) in [field.name for field in fields_of(Link)]:
        right = f"links[0].{last}"
    if not path:
        return "is no path into a scene such as links[0].mass or links[load].mass"
    if right != text:
        return f'is no path into a scene: write "{right}"'
    if text in ("title", "description", "schema_version", "held") or path[-1] == "name":
        return "cannot be varied"
    if path[0] == "ask" and _ASKED.fullmatch(text) is None:
        some = "the speeds of ask.shapes, ask.response, ask.drag and ask.equilibria, and ask.drag.air_density"
        return f"cannot be varied: of [ask] only {some} can"
    return ""


def quantity_of(path: Path) -> str:
    """The quantity of the number at a path, a key of `systems.units.SI`; a length if the name is not one."""
    if path == ("cord", "density"):
        return "exponent"
    if len(path) > 1 and path[-2] == "pin":
        return f"pin_{path[-1]}"
    return next((step for step in reversed(path) if isinstance(step, str) and step in SI), "length")


def _grid(table: Vary, quantity: str, numbers: Numbers) -> Floats | None:
    for key, value in (("from", table.first), ("to", table.last), ("steps", table.steps)):
        if value is UNSET:
            numbers.refuse(key, "is missing")
    low, high = (numbers.value(key, end, quantity, "any") for key, end in (("from", table.first), ("to", table.last)))
    if isinstance(table.steps, UnsetType) or math.isnan(low + high):
        return None
    if table.steps > MAX_STEPS:
        numbers.refuse("steps", f"must be at most {MAX_STEPS:,}, got {table.steps:,}")
    elif table.log and min(low, high) <= 0:
        numbers.refuse("log", "needs from and to that are positive")
    elif SI[quantity][1] == "an angular speed" and not table.log and speed_unit(table.first) == speed_unit(table.last) == "s":
        return 1 / np.linspace(1 / low, 1 / high, table.steps)  # even steps of the period
    else:
        return (np.geomspace if table.log else np.linspace)(low, high, table.steps)
    return None


def _listed(given: Any, parts: list[Any], quantity: str, numbers: Numbers) -> NDArray[Any]:
    if any(get_origin(part) is Literal or part is bool for part in parts):
        if len({type(value) for value in given}) != 1:
            numbers.refuse("values", "must be all of one kind")
        return np.array(given)
    for k, value in enumerate(given):
        if isinstance(value, bool):
            numbers.refuse(f"values[{k}]", f"must be a number, got {parse.written(value)}")
    return np.array([numbers.value(f"values[{k}]", value, quantity, "any") for k, value in enumerate(given)])


def _law(law: str, given: Any, quantity: str, numbers: Numbers) -> tuple[float, float]:
    spread: Any = None
    if isinstance(given, str):
        parts = with_tolerance(given)
        if parts is None or not parts[0]:
            form = "[mean, deviation]" if law == "normal" else "[low, high]"
            numbers.refuse(law, f'must be two numbers {form}, or text such as "38 m +- 0.5 m", got "{given}"')
            return math.nan, math.nan
        given = parts
        spread = None if parts[1].endswith("%") else parts[1]
    elif isinstance(given[1], str) and (parts := with_tolerance(given[1])) is not None and not parts[0]:
        given, spread = (given[0], parts[1]), None if parts[1].endswith("%") else parts[1]
    if spread is not None and SI[quantity][1] == "an angular speed" and speed_unit(spread) == "s":
        numbers.refuse(law, f"must be a speed with a tolerance in the same unit, not a period, got {parse.written(list(given))}")
        return math.nan, math.nan
    one = numbers.value(f"{law}[0]", given[0], quantity, "any")
    if isinstance(given[1], str) and _PERCENT.fullmatch(given[1]):
        part = numbers.value(f"{law}[1]", given[1], "rtol", "positive")
        spread = abs(one) * part
        one, two = {
            "normal": (one, spread),
            "uniform": (one - spread, one + spread),
            "log_uniform": (one / (1 + part), one * (1 + part)),
        }[law]
    elif spread is not None and law != "normal":
        half = numbers.value(f"{law}[1]", spread, quantity, "positive")
        one, two = one - half, one + half
    else:
        two = numbers.value(f"{law}[1]", given[1], quantity, "any")
    if law != "normal" and one > two and SI[quantity][1] == "an angular speed" and speed_unit(list(given)) == "s":
        one, two = two, one  # a long period is a low speed
    if law == "normal" and two < 0:
        numbers.refuse(law, f"its deviation must not be negative, got {given[1]}")
    elif law == "log_uniform" and one <= 0:
        numbers.refuse(law, f"must be positive, got {given[0]}")
    elif law != "normal" and one >= two:
        numbers.refuse(law, f"its low end must lie below its high end, got {parse.written(given)}")
    return one, two
