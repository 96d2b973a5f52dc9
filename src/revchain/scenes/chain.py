# SPDX-License-Identifier: GPL-3.0-or-later
"""From the tables of a scene to a chain: units, masses to weights, repeats, and errors with the key."""

from __future__ import annotations

import math
import re

import numpy as np
from msgspec import UNSET

from ..systems.chain import Chain
from ..systems.numbers import Floats
from ..systems.units import si_value
from .error import SceneError
from .tables import MOST_LINKS, Displaced, Flywheel, Link, Support, TaperedChain, UniformChain

Weighed = Link | UniformChain | TaperedChain | Flywheel | Displaced | Support


class Numbers:
    """Numbers of one table: text with units converted, ranges checked, errors with the key path."""

    def __init__(self, source: str, table: str) -> None:
        self.source = source
        self.table = table

    def refuse(self, key: str, reason: str) -> SceneError:
        return SceneError(self.source, ".".join(part for part in (self.table, key) if part), reason)

    def value(self, key: str, given: float | str, quantity: str, sign: str, finite: bool = True) -> float:
        try:
            number = si_value(given, quantity) if isinstance(given, str) else float(given)
        except ValueError as error:
            raise self.refuse(key, str(error)) from None
        shown = f'"{given}"' if isinstance(given, str) else f"{given}"
        if math.isnan(number) or (finite and math.isinf(number)):
            raise self.refuse(key, f"must be {'finite' if finite else 'a number'}, got {shown}")
        if sign == "positive" and not number > 0:
            raise self.refuse(key, f"must be positive, got {shown}")
        if sign == "not negative" and not number >= 0:
            raise self.refuse(key, f"must not be negative, got {shown}")
        return number

    def weight(self, table: Weighed, gravity: float, sign: str, prefix: str = "") -> float:
        """Of the keys `weight` and `mass`, or with a prefix (`added_`, `tip_`), the one that is given."""
        weight, mass = (getattr(table, prefix + name) for name in ("weight", "mass"))
        if (weight is UNSET) == (mass is UNSET):
            raise self.refuse("", f"give either {prefix}weight or {prefix}mass")
        if weight is not UNSET:
            return self.value(f"{prefix}weight", weight, "weight", sign)
        found = self.value(f"{prefix}mass", mass, "mass", sign) * gravity
        if not math.isfinite(found):
            raise self.refuse(f"{prefix}mass", f"is too large, got {mass}")
        return found

    def weight_if_given(self, table: Weighed, gravity: float, prefix: str = "") -> float:
        """The same of what may be left out, 0 then."""
        given = [name for name in ("weight", "mass") if getattr(table, prefix + name) is not UNSET]
        return self.weight(table, gravity, "not negative", prefix) if given else 0.0


def uniform_chain(table: UniformChain, gravity: float, source: str) -> Chain:
    numbers = Numbers(source, "uniform_chain")
    make = Chain.uniform_rods if table.kind == "rods" else Chain.uniform_plummets
    length = numbers.value("length", table.length, "length", "positive")
    weight = numbers.weight(table, gravity, "positive")
    tip = numbers.weight_if_given(table, gravity, "tip_")
    try:
        chain = make(table.count, length, weight)
        return chain.with_weight(tip) if tip else chain
    except ValueError as error:
        raise numbers.refuse("", _without_place(str(error))) from None


def tapered_chain(table: TaperedChain, gravity: float, source: str) -> Chain:
    numbers = Numbers(source, "tapered_chain")
    length = numbers.value("length", table.length, "length", "positive")
    weight = numbers.weight(table, gravity, "positive")
    tip = numbers.weight_if_given(table, gravity, "tip_")
    try:
        chain = Chain.tapered(table.count, length, weight, exponent=table.exponent)
        return chain.with_weight(tip) if tip else chain
    except ValueError as error:
        raise numbers.refuse("", _without_place(str(error))) from None


def chain_of_links(links: list[Link], gravity: float, source: str) -> Chain:
    if sum(link.repeat for link in links) > MOST_LINKS:
        raise SceneError(source, "links", f"must be at most {MOST_LINKS:,} together with their repeats")
    bodies = [_body(link, gravity, Numbers(source, f"links[{index}]")) for index, link in enumerate(links)]
    repeats = [link.repeat for link in links]
    columns: list[Floats] = [np.repeat(np.array(column, dtype=float), repeats) for column in zip(*bodies, strict=True)]
    weight, length, centroid, radius = columns or [np.empty(0)] * 4
    tips = [_tip(link, gravity, Numbers(source, f"links[{index}]")) for index, link in enumerate(links)]
    try:
        if np.array_equal(centroid, length) and not radius.any():
            chain = Chain(weight=weight, length=length)
        else:
            chain = Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=radius)
        return _joined(chain, links, tips, source)
    except SceneError:
        raise
    except ValueError as error:
        reason = _without_place(str(error))
        found = re.match(r"link (\d+): ", reason)
        if found is None:
            raise SceneError(source, "links", reason) from None
        index = int(np.searchsorted(np.cumsum(repeats), int(found[1])))
        raise SceneError(source, f"links[{index}]", reason[found.end() :]) from None


def _tip(link: Link, gravity: float, numbers: Numbers) -> float:
    """Weight fixed to the lower pin."""
    tip = numbers.weight_if_given(link, gravity, "tip_")
    if tip and link.repeat > 1:
        raise numbers.refuse("repeat", f"must be 1 where a weight is fixed to the lower pin, got {link.repeat}")
    return tip


def _joined(chain: Chain, links: list[Link], tips: list[float], source: str) -> Chain:
    """The chain with weights fixed to pins, and links locked to those above; from the top, so that numbers hold."""
    first = np.cumsum([0, *(link.repeat for link in links)])
    for index in reversed(range(len(links))):
        link = links[index]
        if tips[index]:
            chain = chain.with_weight(tips[index], pin=int(first[index]))
        if not link.clamped:
            continue
        numbers = Numbers(source, f"links[{index}]")
        if index + 1 == len(links):
            raise numbers.refuse("clamped", "there is no link above")
        for name in ("standing", "flywheel", "displaced"):
            if getattr(link, name) not in (False, UNSET):
                raise numbers.refuse(name, "is said by the link above, with which this one is clamped")
        for number in (index, index + 1):
            if links[number].repeat > 1:
                place = Numbers(source, f"links[{number}]")
                raise place.refuse("repeat", f"must be 1 where links are clamped, got {links[number].repeat}")
        chain = chain.clamped(int(first[index]) + 1)
    return chain


def _body(link: Link, gravity: float, numbers: Numbers) -> tuple[float, float, float, float]:
    """Weight, length, centroid and radius of gyration of a link."""
    length = numbers.value("length", link.length, "length", "positive")
    weight = numbers.weight(link, gravity, "not negative")
    others = (link.pendulum_length, link.radius_of_gyration)
    if link.kind is not UNSET or link.centroid is UNSET:
        for key in ("centroid", "pendulum_length", "radius_of_gyration"):
            if getattr(link, key) is not UNSET:
                reason = "needs centroid beside it" if link.kind is UNSET else f'does not go with kind = "{link.kind}"'
                raise numbers.refuse(key, reason)
        return (
            (weight, length, length / 2, length / math.sqrt(12)) if link.kind == "rod" else (weight, length, length, 0)
        )
    centroid = numbers.value("centroid", link.centroid, "length", "any")
    if (others[0] is UNSET) == (others[1] is UNSET):
        raise numbers.refuse("centroid", "needs either pendulum_length or radius_of_gyration beside it")
    if link.radius_of_gyration is not UNSET:
        radius = numbers.value("radius_of_gyration", link.radius_of_gyration, "length", "not negative")
        return weight, length, centroid, radius
    assert link.pendulum_length is not UNSET
    pendulum = numbers.value("pendulum_length", link.pendulum_length, "length", "any")
    squared = centroid * (pendulum - centroid)
    if not 0 <= squared < math.inf or centroid == 0:
        reason = f"makes the radius of gyration imaginary: centroid (pendulum_length - centroid) is {squared:g}"
        if centroid == 0:
            reason = "says nothing where centroid is 0; give radius_of_gyration"
        raise numbers.refuse("pendulum_length", reason)
    return weight, length, centroid, math.sqrt(squared)


def _without_place(message: str) -> str:
    return re.sub(r"^revchain(::|\.)[\w:.]+?: ", "", message)
