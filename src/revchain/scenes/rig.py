# SPDX-License-Identifier: GPL-3.0-or-later
"""The rig from the tables of a scene."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType

from ..systems import rig as systems
from ..systems.chain import Chain
from .chain import Links, Numbers, of_file
from .tables import Displaced, Flywheel, Link, Support


def is_rigged(links: list[Link], support: Support | UnsetType) -> bool:
    """Whether these tables describe more than a chain that hangs from a firm point on the axis."""
    return support is not UNSET or any(
        link.standing or link.flywheel is not UNSET or link.displaced is not UNSET for link in links
    )


def rig_of(
    chain: Chain | None, links: Links, support: Support | UnsetType, fluid: str, numbers: Numbers
) -> systems.Rig | None:
    """The rig; `links` are the tables of the links of `chain`, or none.

    If the chain was refused (None), the errors of the other tables are noted, too.
    """
    repeats = [link.repeat for _, link in links]
    firsts = np.cumsum([0, *repeats])[:-1]
    held = None if support is UNSET else support_numbers(support, numbers.of("support"))
    wheels, fluids = [], []
    for first, (index, link) in zip(firsts, links, strict=True):
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

    given: dict[str, Any] = {"inverted": np.repeat([link.standing for _, link in links], repeats)} if links else {}
    try:
        if held is not None:
            given["support"] = systems.Support(**held)
        if any(link.flywheel is not UNSET for _, link in links):
            names: tuple[str, ...] = (numbers.heavy, "radius_of_gyration", "spin", "driven")
            given["flywheels"] = systems.Flywheel(**columns(names, wheels))
        if any(link.displaced is not UNSET for _, link in links):
            names = (numbers.heavy, f"added_{numbers.heavy}", "centroid", "radius_of_gyration")
            displaced = columns(names, fluids)
            if all(link.displaced is UNSET or link.displaced.radius_of_gyration is UNSET for _, link in links):
                del displaced["radius_of_gyration"]  # that of the links, with all stored digits
            given["displaced"] = systems.Displaced(**displaced)
        return systems.Rig(chain, **given, fluid=fluid)
    except ValueError as error:
        raise of_file(error, numbers.source, "links" if links else "support", links) from None


def support_numbers(table: Support, numbers: Numbers, radii: str = "not negative") -> dict[str, float]:
    """The arguments of a `Support`."""
    stiffness, radius = math.inf, 0.0
    if table.stiffness is not UNSET:
        stiffness = numbers.value("stiffness", table.stiffness, "stiffness", "positive")
    if table.radius is not UNSET:
        radius = numbers.value("radius", table.radius, "length", radii)
    carriage = numbers.weight_if_given(table)
    if carriage > 0 and table.stiffness is UNSET:
        numbers.refuse("stiffness", "is missing: what moves sideways needs a support that yields")
        carriage = 0.0
    given = {"stiffness": stiffness, "radius": radius}
    return given | {numbers.heavy: carriage} if carriage else given


def _flywheel(table: Flywheel | UnsetType, numbers: Numbers) -> tuple[float, float, float, bool]:
    """Mass or weight, radius of gyration, spin, and whether it is driven."""
    if table is UNSET:
        return 0.0, 0.0, 0.0, False
    heavy = numbers.weight(table, "not negative")
    radius = numbers.value("radius_of_gyration", table.radius_of_gyration, "length", "not negative")
    spin = numbers.value("spin", table.spin, "spin", "any")
    if math.isinf(heavy * radius * radius * spin):
        numbers.refuse("spin", f"gives too large an angular momentum, got {table.spin}")
    return heavy, radius, spin, table.driven


def _displaced(
    table: Displaced | UnsetType, own: tuple[float, float], numbers: Numbers
) -> tuple[float, float, float, float]:
    """Mass or weight displaced, and added, centroid, radius of gyration."""
    if table is UNSET:
        return 0.0, 0.0, *own
    heavy, added = numbers.weight(table, "not negative"), numbers.weight_if_given(table, "added_")
    centroid, radius = own
    if table.centroid is not UNSET:
        centroid = numbers.value("centroid", table.centroid, "length", "any")
    if table.radius_of_gyration is not UNSET:
        radius = numbers.value("radius_of_gyration", table.radius_of_gyration, "length", "not negative")
    return heavy, added, centroid, radius
