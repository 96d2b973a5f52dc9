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
from ..systems.units import SI

BLOCK = 65536  # points in a block of random numbers; each block has its own stream
MAX_STEPS = 10**7
MAX_POINTS = 10**12
LAWS = ("uniform", "normal", "log_uniform")

Path = tuple[str | int, ...]
NumberOrText = float | str
Samples = Annotated[int, Meta(ge=1, le=MAX_POINTS)]
Listed = Annotated[list[bool | float | str], Meta(min_length=1)]
TwoNumbers = Annotated[list[NumberOrText], Meta(min_length=2, max_length=2)]

_PATH = re.compile(r"[a-z_]+(\[\d{1,9}\])?(\.[a-z_]+(\[\d{1,9}\])?)*")
_SPEED = r"\.(angular_speed|conical_height)"
_ASKED = re.compile(rf"ask\.(shapes{_SPEED}|response{_SPEED}(\[\d+\]|\.from|\.to)?)")
_PERCENT = re.compile(r"[^%]*%\s*")


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
    values: NDArray[Any] | None  # of a grid; None if the numbers are random
    law: str = ""  # "normal", "uniform" or "log_uniform"
    law_numbers: tuple[float, float] = (0.0, 0.0)  # mean and deviation, or low and high end

    @property
    def is_number(self) -> bool:
        """Whether the values are real numbers; whole numbers and words may change the structure of the scene."""
        return self.values is None or self.values.dtype.kind == "f"

    @property
    def unit(self) -> str:
        """The SI unit of the values; empty for words, whole numbers and exponents."""
        return SI[quantity_of(self.path)][0] if self.is_number and self.path[-1] != "exponent" else ""

    def examples(self) -> list[Any]:
        """Values to check: the ends of a grid, all its words, or the middle of random numbers."""
        if self.values is None:
            one, two = self.law_numbers
            return [one if self.law == "normal" else one + (two - one) / 2]
        if self.values.dtype.kind in "fi":
            return [self.values.min().item(), self.values.max().item()]
        return np.unique(self.values).tolist()  # type: ignore[no-any-return]

    def drawn(self, seed: int, start: int, stop: int) -> Floats:
        """The random numbers of the points start <= k < stop; each depends only on seed, path and k."""
        blocks = range(start // BLOCK, -(-stop // BLOCK))
        return np.concatenate([self._drawn(seed, block, min(stop - block * BLOCK, BLOCK)) for block in blocks])[
            start % BLOCK :
        ]

    def _drawn(self, seed: int, block: int, count: int) -> Floats:
        key = zlib.crc32(self.key.encode()), block
        stream = np.random.Generator(np.random.SFC64(np.random.SeedSequence(seed, spawn_key=key)))
        one, two = map(math.log, self.law_numbers) if self.law == "log_uniform" else self.law_numbers
        numbers = stream.standard_normal(count) if self.law == "normal" else stream.random(count)
        numbers *= two if self.law == "normal" else two - one
        numbers += one
        return np.exp(numbers, out=numbers) if self.law == "log_uniform" else numbers


def quantity_of(path: Path) -> str:
    """The quantity of the number at a path, a key of `systems.units.SI`; a length if the name is not one."""
    return next((step for step in reversed(path) if isinstance(step, str) and step in SI), "length")


def with_value(data: Any, path: Path, value: Any) -> Any:
    """A copy of `data` with the value at the path, sharing other tables; a ValueError if there is no such path."""
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


def _path_of(text: str, numbers: Numbers) -> Path:
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


def axis_of(key: str, table: Vary, kind: type, numbers: Numbers) -> Axis | None:
    """The axis of an entry of [vary]; None if it is wrong, which is noted. `kind` is the class of scenes."""
    known, path = len(numbers.problems), _path_of(key, numbers)
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
    values, law, ends = None, "", (0.0, 0.0)
    if given[0] in LAWS and (whole or not (annotation is None or float in parts)):
        numbers.refuse("", "takes no random numbers; give values")
    elif given[0] in LAWS:
        law, ends = given[0], _law(given[0], getattr(table, given[0]), quantity, numbers)
    elif given[0] == "from":
        values = _grid(table, quantity, whole, numbers)
    else:
        values = _listed(table, parts, quantity, whole, numbers)
    return Axis(key, name, path, values, law, ends) if len(numbers.problems) == known else None


def _number(key: str, given: Any, quantity: str, whole: bool, numbers: Numbers) -> float:
    found = numbers.value(key, given, quantity, "any")
    if whole and math.isfinite(found) and found != round(found):
        numbers.refuse(key, f"must be a whole number, got {parse.written(given)}")
    return found


def _grid(table: Vary, quantity: str, whole: bool, numbers: Numbers) -> NDArray[Any] | None:
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


def _listed(table: Vary, parts: list[Any], quantity: str, whole: bool, numbers: Numbers) -> NDArray[Any]:
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
    """Mean and deviation, or low and high end, of random numbers."""
    one = numbers.value(f"{law}[0]", given[0], quantity, "any")
    if isinstance(given[1], str) and _PERCENT.fullmatch(given[1]):
        part = numbers.value(f"{law}[1]", given[1], "rtol", "positive")
        spread = abs(one) * part
        one, two = {
            "normal": (one, spread),
            "uniform": (one - spread, one + spread),
            "log_uniform": (one / (1 + part), one * (1 + part)),
        }[law]
    else:
        two = numbers.value(f"{law}[1]", given[1], quantity, "any")
    if law == "normal" and two < 0:
        numbers.refuse(law, f"its deviation must not be negative, got {given[1]}")
    elif law == "log_uniform" and one <= 0:
        numbers.refuse(law, f"must be positive, got {given[0]}")
    elif law != "normal" and one >= two:
        numbers.refuse(law, f"its low end must lie below its high end, got {parse.written(given)}")
    return one, two
