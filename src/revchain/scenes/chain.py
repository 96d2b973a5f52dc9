# SPDX-License-Identifier: GPL-3.0-or-later
"""The chain from the tables of a scene: units, masses to weights, repeats; each error has its key."""

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
from .tables import MOST_LINKS, Displaced, Flywheel, Link, Support, TaperedChain, UniformChain, Whole
from .tables import Cord as CordTable

Weighed = Link | Whole | Flywheel | Displaced | Support
Links = list[tuple[int, Link]]  # lowest first, each with its number in the file


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
        self.problems.append(Problem(0, 0, f"{self.table}.{key}".strip("."), reason))

    def done(self) -> None:
        """Raise a SceneError if an error was noted."""
        if self.problems:
            raise SceneError(self.source, problems=without_consequences(self.problems))

    def value(self, key: str, given: object, quantity: str, sign: str, finite: bool = True) -> float:
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

    def weight(self, table: Weighed, sign: str, prefix: str = "") -> float:
        """Mass or weight from the keys `weight` and `mass`, or from these keys with a prefix (`added_`, `tip_`)."""
        weight, mass = (getattr(table, prefix + name) for name in ("weight", "mass"))
        if (weight is UNSET) == (mass is UNSET):
            if weight is UNSET:
                self.refuse("", f"{prefix}mass (kg) or {prefix}weight (N) is missing")
            else:
                self.refuse(f"{prefix}weight", f"is given beside {prefix}mass: give one of them, not both")
            return math.nan
        name, given, factor = ("mass", mass, 1.0 if self.by_mass else self.gravity)
        if mass is UNSET:
            name, given, factor = ("weight", weight, 1 / self.gravity if self.by_mass else 1.0)
        found = self.value(prefix + name, given, name, sign)
        if math.isfinite(found) and math.isfinite(factor) and not math.isfinite(found * factor):
            self.refuse(prefix + name, f"is too large, got {written(given)}")
        return found * factor

    def weight_if_given(self, table: Weighed, prefix: str = "") -> float:
        """Mass or weight as of `weight`; 0 if it is left out."""
        given = any(getattr(table, prefix + name) is not UNSET for name in ("weight", "mass"))
        return self.weight(table, "not negative", prefix) if given else 0.0


def whole(table: UniformChain | TaperedChain | CordTable, numbers: Numbers) -> Chain | Cord | None:
    """The chain or cord; None if something is missing or of a wrong kind, which is noted already."""
    length = numbers.value("length", table.length, "length", "positive")
    given = {"length": length, numbers.heavy: numbers.weight(table, "positive")}
    tip = numbers.weight_if_given(table, "tip_")
    numbers.done()
    if math.isnan(sum(given.values()) + tip):
        return None
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
    if (count := sum(link.repeat for _, link in links)) > MOST_LINKS:
        more = "use fewer and longer links, or [cord]"
        reason = f"must be at most {MOST_LINKS:,} together with their repeats, got {count:,}; {more}"
        raise SceneError(numbers.source, "links", reason)
    places = [numbers.of(f"links[{index}]") for index, _ in links]
    bodies = [_body(link, place) for place, (_, link) in zip(places, links, strict=True)]
    tips = [place.weight_if_given(link, "tip_") for place, (_, link) in zip(places, links, strict=True)]
    for nth, (place, (_, link)) in enumerate(zip(places, links, strict=True)):
        _check_joints(link, tips[nth], [each for _, each in links[nth + 1 : nth + 2]], place)
    numbers.done()
    if math.isnan(sum(map(sum, bodies)) + sum(tips)):
        return None
    repeats = [link.repeat for _, link in links]
    columns: list[Floats] = [np.repeat(np.array(column, dtype=float), repeats) for column in zip(*bodies, strict=True)]
    heavy, length, centroid, radius = columns or [np.empty(0)] * 4
    given: dict[str, Any] = {numbers.heavy: heavy, "length": length}
    if radius.any() or not np.array_equal(centroid, length):
        given |= {"centroid": centroid, "radius_of_gyration": radius}
    if any(link.name for _, link in links):
        first = 0
        given["names"] = []
        for _, link in links:
            given["names"] += [link.name or f"links[{k}]" for k in range(first, first + link.repeat)]
            first += link.repeat
    try:
        chain = Chain(**given)
        firsts = np.cumsum([0, *repeats])
        for nth in reversed(range(len(links))):  # from the top, so that the numbers of pins hold
            if tips[nth]:
                chain = chain.with_body(**{numbers.heavy: tips[nth]}, pin=int(firsts[nth]))
            if links[nth][1].clamped:
                chain = chain.clamped(int(firsts[nth]))
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


def _body(link: Link, numbers: Numbers) -> tuple[float, float, float, float]:
    """Weight, length, centroid and radius of gyration of a link."""
    length = numbers.value("length", link.length, "length", "positive")
    weight = numbers.weight(link, "not negative")
    if link.kind is not UNSET or link.centroid is UNSET:
        for key in ("centroid", "pendulum_length", "radius_of_gyration"):
            if getattr(link, key) is not UNSET:
                reason = "needs centroid beside it" if link.kind is UNSET else f'does not go with kind = "{link.kind}"'
                numbers.refuse(key, reason)
        rod = link.kind == "rod"
        return (weight, length, length / 2, length / math.sqrt(12)) if rod else (weight, length, length, 0)
    centroid = numbers.value("centroid", link.centroid, "length", "any")
    if (link.pendulum_length is UNSET) == (link.radius_of_gyration is UNSET):
        numbers.refuse("centroid", "needs either pendulum_length or radius_of_gyration beside it")
        return weight, length, centroid, math.nan
    if link.radius_of_gyration is not UNSET:
        radius = numbers.value("radius_of_gyration", link.radius_of_gyration, "length", "not negative")
        return weight, length, centroid, radius
    pendulum = numbers.value("pendulum_length", link.pendulum_length, "length", "any")
    squared = centroid * (pendulum - centroid)
    if centroid == 0:
        numbers.refuse("pendulum_length", "does not determine the inertia if centroid is 0; give radius_of_gyration")
    elif not math.isnan(squared) and not 0 <= squared < math.inf:
        product = f"centroid (pendulum_length - centroid) is {squared:g}"
        numbers.refuse("pendulum_length", f"makes the radius of gyration imaginary: {product}")
    return weight, length, centroid, math.sqrt(squared) if 0 <= squared < math.inf else math.nan


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
