# SPDX-License-Identifier: GPL-3.0-or-later
"""The chain or cord from the tables of a scene: units, masses to weights, repeats; each error has its key."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
from msgspec import UNSET

from ..systems.chain import Chain
from ..systems.cord import Cord
from ..systems.numbers import Floats
from ..systems.units import si_value
from .error import Problem, SceneError
from .parse import without_consequences, written
from .tables import MOST_LINKS, Link, Support, Table, TaperedChain, UniformChain, number_fields
from .tables import Cord as CordTable

Links = list[tuple[int, Link]]  # lowest first, each with its number in the file
Given = dict[str, float]


class Numbers:
    """Numbers of one table: text with units converted, ranges checked, errors noted with the key path.

    A wrong number is NaN; `done` raises one error for all of them. If the whole scene is given by mass, masses stay
    masses, else they are multiplied by gravity.
    """

    def __init__(self, source: str, table: str = "", *, gravity: float = 1.0, by_mass: bool = True) -> None:
        self.source = source
        self.table = table
        self.problems: list[Problem] = []
        self.gravity = gravity
        self.by_mass = by_mass

    def of(self, table: str) -> Numbers:
        """The numbers of a table inside this one; errors are noted together."""
        inside = Numbers(self.source, f"{self.table}.{table}".lstrip("."), gravity=self.gravity, by_mass=self.by_mass)
        inside.problems = self.problems
        return inside

    @property
    def heavy(self) -> str:
        """The key of a weight: ``mass`` or ``weight``."""
        return "mass" if self.by_mass else "weight"

    def refuse(self, key: str, reason: str) -> None:
        """Note an error of a key of this table."""
        self.problems.append(Problem(0, 0, f"{self.table}.{key}".strip("."), reason))

    def done(self) -> None:
        """Raise a SceneError if an error was noted."""
        if self.problems:
            raise SceneError(self.source, problems=without_consequences(self.problems))

    def value(self, key: str, given: object, quantity: str, sign: str, finite: bool = True) -> float:
        """A number or text with a unit in the SI unit of the quantity."""
        if given is UNSET:  # missing or of a wrong kind; the error is noted already
            return math.nan
        assert isinstance(given, float | int | str)
        try:
            number = si_value(given, quantity) if isinstance(given, str) else float(given)
        except ValueError as error:
            self.refuse(key, str(error))
            return math.nan
        if math.isnan(number) or (finite and math.isinf(number)):
            must = "be finite" if finite else "be a number"
        elif sign == "positive" and not number > 0:
            must = "be positive"
        elif sign == "not negative" and not number >= 0:
            must = "not be negative"
        else:
            return number
        self.refuse(key, f"must {must}, got {written(given)}")
        return math.nan

    def read(self, table: Table) -> Given:
        """All numbers given in the table, by key; masses or weights are under the keys `heavy`, `tip_heavy` and `added_heavy`."""
        found: Given = {}
        for name, sign, required in number_fields(type(table)):
            given = getattr(table, name)
            if given is not UNSET or required:
                found[name] = self.value(name, given, name, sign)
        for prefix in ("", "tip_", "added_"):
            if hasattr(table, f"{prefix}mass"):
                self._weigh(table, prefix, found)
        return found

    def _weigh(self, table: Table, prefix: str, found: Given) -> None:
        """Add the mass or weight from the keys `mass` and `weight` with a prefix; 0 where it may be left out."""
        given = [f"{prefix}{name}" for name in ("weight", "mass") if f"{prefix}{name}" in found]
        heavy = 0.0 if prefix or isinstance(table, Support) else math.nan
        if len(given) == 2:
            self.refuse(given[0], f"is given beside {given[1]}: give one of them, not both")
            heavy = math.nan
        elif given:
            factor = 1.0 if given[0].endswith(self.heavy) else 1 / self.gravity if self.by_mass else self.gravity
            heavy = found[given[0]] * factor
            if math.isinf(heavy):
                self.refuse(given[0], f"is too large, got {written(getattr(table, given[0]))}")
        elif math.isnan(heavy):
            self.refuse("", "mass (kg) or weight (N) is missing")
        found[f"{prefix}heavy"] = heavy


def whole(name: str, table: UniformChain | TaperedChain | CordTable, numbers: Numbers) -> Chain | Cord | None:
    """The chain or cord of the table of that name; None if parsing has already reported a wrong value."""
    numbers = numbers.of(name)
    found = numbers.read(table)
    numbers.done()
    if math.isnan(sum(found.values())):
        return None
    given, tip = {"length": found["length"], numbers.heavy: found["heavy"]}, found["tip_heavy"]
    try:
        if isinstance(table, CordTable):
            return Cord(**given, density=table.density, **({f"tip_{numbers.heavy}": tip} if tip else {}))
        if isinstance(table, TaperedChain):
            chain = Chain.tapered(table.count, **given, exponent=table.exponent)
        else:
            chain = (Chain.uniform_rods if table.kind == "rods" else Chain.uniform_plummets)(table.count, **given)
        fixed: dict[str, Any] = {numbers.heavy: tip}
        return chain.with_body(**fixed) if tip else chain
    except ValueError as error:
        raise of_file(error, numbers.source, numbers.table) from None


def chain_of_links(links: Links, numbers: Numbers) -> Chain | None:
    """The chain of the links, lowest first, each with its number in the file; None as for `whole`."""
    repeats = [link.repeat for _, link in links]
    if (count := sum(repeats)) > MOST_LINKS:
        more = "use fewer and longer links, or [cord]"
        reason = f"must be at most {MOST_LINKS:,} together with their repeats, got {count:,}; {more}"
        raise SceneError(numbers.source, "links", reason)
    bodies, tips = [], []
    for nth, (index, link) in enumerate(links):
        place = numbers.of(f"links[{index}]")
        found = place.read(link)
        bodies.append(_body(link, found, place))
        tips.append(found["tip_heavy"])
        _check_joints(link, tips[-1], [above for _, above in links[nth + 1 : nth + 2]], place)
    numbers.done()
    if math.isnan(sum(map(sum, bodies)) + sum(tips)):
        return None
    columns: list[Floats] = [np.repeat(np.array(column, dtype=float), repeats) for column in zip(*bodies, strict=True)]
    heavy, length, centroid, radius = columns
    given: dict[str, Any] = {numbers.heavy: heavy, "length": length}
    if radius.any() or not np.array_equal(centroid, length):
        given |= {"centroid": centroid, "radius_of_gyration": radius}
    firsts = np.cumsum([0, *repeats]).tolist()
    if any(link.name for _, link in links):
        given["names"] = [
            link.name or f"links[{k}]"
            for first, (_, link) in zip(firsts, links, strict=False)
            for k in range(first, first + link.repeat)
        ]
    try:
        chain = Chain(**given)
        for first, tip, (_, link) in list(zip(firsts, tips, links, strict=False))[::-1]:  # so that pins keep numbers
            if tip:
                chain = chain.with_body(**{numbers.heavy: tip}, pin=first)
            if link.clamped:
                chain = chain.clamped(first)
        return chain
    except ValueError as error:
        raise of_file(error, numbers.source, "links", links) from None


def _check_joints(link: Link, tip: float, above: list[Link], numbers: Numbers) -> None:
    """Note errors of a link with a weight at its lower pin, or clamped to the link above."""
    if tip and link.repeat > 1:
        numbers.refuse("repeat", f"must be 1 where a weight is fixed to the lower pin, got {link.repeat}")
    if not link.clamped:
        return
    if not above:
        numbers.refuse("clamped", "there is no link above")
    for name in ("standing", "flywheel", "displaced"):
        if getattr(link, name) not in (False, UNSET):
            numbers.refuse(name, "must be given for the link above, to which this one is clamped")
    if max(link.repeat, *(each.repeat for each in above), 1) > 1:
        numbers.refuse("clamped", "needs repeat = 1, here and in the link above")


def _body(link: Link, given: Given, numbers: Numbers) -> tuple[float, float, float, float]:
    """Mass or weight, length, centroid and radius of gyration of a link."""
    heavy, length = given["heavy"], given["length"]
    if link.kind is not UNSET or link.centroid is UNSET:
        for key in ("centroid", "pendulum_length", "radius_of_gyration"):
            if key in given:
                reason = "needs centroid beside it" if link.kind is UNSET else f'does not go with kind = "{link.kind}"'
                numbers.refuse(key, reason)
        return (heavy, length, length / 2, length / math.sqrt(12)) if link.kind == "rod" else (heavy, length, length, 0)
    centroid, radius = given["centroid"], given.get("radius_of_gyration", math.nan)
    if ("pendulum_length" in given) == ("radius_of_gyration" in given):
        numbers.refuse("centroid", "needs either pendulum_length or radius_of_gyration beside it")
    elif "pendulum_length" in given:
        squared = centroid * (given["pendulum_length"] - centroid)
        if centroid == 0:
            reason = "does not determine the inertia if centroid is 0; give radius_of_gyration"
            numbers.refuse("pendulum_length", reason)
        elif 0 <= squared < math.inf:
            radius = math.sqrt(squared)
        elif not math.isnan(squared):
            product = f"centroid (pendulum_length - centroid) is {squared:g}"
            numbers.refuse("pendulum_length", f"makes the radius of gyration imaginary: {product}")
    return heavy, length, centroid, radius


def without_place(error: object) -> str:
    """The sentence of an error without the name of a function."""
    return re.sub(r"^revchain(::|\.)[\w:.]+?: ", "", str(error))


def in_file(sentence: str, links: Links) -> str:
    """A sentence of the core with the link numbers of the file; the core counts links from the free end with repeats."""
    ends = np.cumsum([link.repeat for _, link in links])

    def there(found: re.Match[str]) -> str:
        index, link = links[int(np.searchsorted(ends, int(found[1]), side="right"))]
        return f"links[{index}]" + (f' ("{link.name}")' if link.name else "")

    return re.sub(r"links\[(\d+)\]", there, sentence) if links else sentence


def of_file(error: ValueError, source: str, key: str, links: Links | None = None) -> SceneError:
    """An error of the core as an error of the file, with the key of the link that it names, or else with `key`."""
    sentence = in_file(without_place(error), links or [])
    if links and sentence.startswith("links[") and ": " in sentence:
        key, _, sentence = sentence.partition(": ")
    return SceneError(source, key, sentence)
