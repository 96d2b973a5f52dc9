# SPDX-License-Identifier: GPL-3.0-or-later
"""The rig, or the system held at both ends, from the tables of a scene."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType

from ..systems import held, rig
from ..systems.chain import Chain
from ..systems.cord import Cord
from .chain import Links, Numbers, of_file, without_place
from .error import SceneError
from .tables import Displaced, Flywheel, Held, Link, Support


def is_rigged(links: list[Link], support: Support | UnsetType) -> bool:
    """Whether these tables describe more than a chain that hangs from a firm point on the axis."""
    return support is not UNSET or any(
        [link.standing or link.flywheel is not UNSET or link.displaced is not UNSET for link in links]
    )


def rig_of(
    chain: Chain | None, links: Links, support: Support | UnsetType, fluid: str, numbers: Numbers
) -> rig.Rig | None:
    """The rig; `links` are the tables of the links of `chain`, or none.

    If the chain was refused (None), the errors of the other tables are noted, too.
    """
    repeats = [link.repeat for _, link in links]
    firsts = np.cumsum([0, *repeats])
    given: dict[str, Any] = {"fluid": fluid}
    if not isinstance(support, UnsetType):
        given["support"] = support_numbers(support, numbers.of("support"))
    wheels, fluids = [], []
    for (index, link), first in zip(links, firsts, strict=False):
        place = numbers.of(f"links[{index}]")
        own = (0.0, 0.0) if chain is None else (float(chain.centroid[first]), float(chain.radius_of_gyration[first]))
        wheels.append(_flywheel(link.flywheel, place.of("flywheel")))
        fluids.append(_displaced(link.displaced, own, place.of("displaced")))
        if fluid == "turning" and fluids[-1][1] > 0:
            place.refuse("displaced", f"must have no added_{numbers.heavy} in a fluid that turns with the chain")
    numbers.done()
    if chain is None:
        return None

    def columns(names: tuple[str, ...], rows: list[tuple[Any, ...]]) -> dict[str, Any]:
        return {name: np.repeat(column, repeats) for name, column in zip(names, zip(*rows, strict=True), strict=True)}

    if links:
        given["inverted"] = np.repeat([link.standing for _, link in links], repeats)
    try:
        if "support" in given:
            given["support"] = rig.Support(**given["support"])
        if any(link.flywheel is not UNSET for _, link in links):
            names: tuple[str, ...] = (numbers.heavy, "radius_of_gyration", "spin", "driven")
            given["flywheels"] = rig.Flywheel(**columns(names, wheels))
        if any(link.displaced is not UNSET for _, link in links):
            names = (numbers.heavy, f"added_{numbers.heavy}", "centroid", "radius_of_gyration")
            displaced = columns(names, fluids)
            if all(link.displaced is UNSET or link.displaced.radius_of_gyration is UNSET for _, link in links):
                del displaced["radius_of_gyration"]  # that of the links, with all stored digits
            given["displaced"] = rig.Displaced(**displaced)
        return rig.Rig(chain, **given)
    except ValueError as error:
        raise of_file(error, numbers.source, "links" if links else "support", links) from None


def support_numbers(table: Support, numbers: Numbers) -> dict[str, float]:
    """The arguments of a `Support`."""
    found = numbers.read(table)
    if found["heavy"] > 0 and table.stiffness is UNSET:
        numbers.refuse("stiffness", "is missing: what moves sideways needs a support that yields")
    given = {"stiffness": found.get("stiffness", math.inf), "radius": found.get("radius", 0.0)}
    return given | {numbers.heavy: found["heavy"]} if found["heavy"] else given


def _flywheel(table: Flywheel | UnsetType, numbers: Numbers) -> tuple[float, float, float, bool]:
    """Mass or weight, radius of gyration, spin, and whether it is driven."""
    if isinstance(table, UnsetType):
        return 0.0, 0.0, 0.0, False
    found = numbers.read(table)
    heavy, radius, spin = (found[name] for name in ("heavy", "radius_of_gyration", "spin"))
    if math.isinf(heavy * radius * radius * spin):
        numbers.refuse("spin", f"gives too large an angular momentum, got {table.spin}")
    return heavy, radius, spin, table.driven


def _displaced(
    table: Displaced | UnsetType, own: tuple[float, float], numbers: Numbers
) -> tuple[float, float, float, float]:
    """Mass or weight displaced, and added, centroid, radius of gyration; the last two are those of the link if left out."""
    if isinstance(table, UnsetType):
        return 0.0, 0.0, *own
    found = {"centroid": own[0], "radius_of_gyration": own[1], **numbers.read(table)}
    return found["heavy"], found["added_heavy"], found["centroid"], found["radius_of_gyration"]


def held_of(table: Held, system: Chain | Cord | None, numbers: Numbers) -> held.Held | None:
    """The chain or cord held at both ends; None if it was refused, which is noted already."""
    if (table.span is UNSET) == (table.tension is UNSET):
        numbers.refuse("", "give either span or tension")
        return None
    given: dict[str, Any] = {**numbers.read(table), "weightless": table.weightless}
    tables = {end: getattr(table, end) for end in ("lower", "upper") if getattr(table, end) is not UNSET}
    ends = {end: support_numbers(support, numbers.of(end)) for end, support in tables.items()}
    numbers.done()
    if system is None:
        return None
    try:
        given |= {end: rig.Support(**support) for end, support in ends.items()}
        return held.Held(system, **given)
    except ValueError as error:
        reason = without_place(error)
        key = next(filter(reason.startswith, ends), "span" if table.tension is UNSET else "tension")
        raise SceneError(numbers.source, f"held.{key}", reason.removeprefix(f"{key} ")) from None
