# SPDX-License-Identifier: GPL-3.0-or-later
"""From the tables of a scene to what its chain is rigged with."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType

from ..systems.chain import Chain
from ..systems.rig import Rig
from .chain import Numbers
from .error import SceneError
from .tables import Displaced, Flywheel, Link, Support


def is_rigged(links: Iterable[Link], support: Support | UnsetType) -> bool:
    """Whether anything in these tables goes beyond a chain that hangs from a firm point on the axis."""
    return support is not UNSET or any(
        link.standing or link.flywheel is not UNSET or link.displaced is not UNSET for link in links
    )


def rig_of(
    chain: Chain, links: list[Link], support: Support | UnsetType, fluid: str, gravity: float, source: str
) -> Rig:
    """The rig; `links` are the tables that `chain` was made of, or none."""
    tables = [(i, link) for i, link in enumerate(links) if not link.clamped]  # those are part of the link above
    links = [link for _, link in tables]
    given: dict[str, Any] = {} if support is UNSET else _support(support, gravity, Numbers(source, "support"))
    if links:
        repeats = [link.repeat for link in links]
        wheels = [_flywheel(link.flywheel, gravity, Numbers(source, f"links[{i}].flywheel")) for i, link in tables]
        given["standing"] = np.repeat([link.standing for link in links], repeats)
        given["momentum"], given["axial_moment"] = (np.repeat(column, repeats) for column in zip(*wheels, strict=True))
        if any(link.displaced is not UNSET for link in links):
            firsts = np.cumsum([0, *repeats[:-1]])
            fluids = [
                _displaced(
                    link.displaced,
                    (chain.centroid[first], chain.radius_of_gyration[first]),
                    gravity,
                    Numbers(source, f"links[{i}].displaced"),
                )
                for (i, link), first in zip(tables, firsts, strict=True)
            ]
            names = ("displaced_weight", "added_weight", "displaced_centroid", "displaced_radius_of_gyration")
            given |= {
                name: np.repeat(column, repeats) for name, column in zip(names, zip(*fluids, strict=True), strict=True)
            }
            if all(link.displaced is UNSET or link.displaced.radius_of_gyration is UNSET for link in links):
                del given["displaced_radius_of_gyration"]  # the links' own, to all the digits kept of it
    try:
        return Rig(chain, **given, fluid=fluid)
    except ValueError as error:
        raise SceneError(source, "", str(error)) from None


def radius_of(support: Support | UnsetType, source: str) -> float:
    """Of the circle in which the support is carried round."""
    if isinstance(support, UnsetType) or support.radius is UNSET:
        return 0.0
    return Numbers(source, "support").value("radius", support.radius, "length", "not negative")


def _support(table: Support, gravity: float, numbers: Numbers) -> dict[str, float]:
    stiffness = math.inf
    if table.stiffness is not UNSET:
        stiffness = numbers.value("stiffness", table.stiffness, "stiffness", "positive")
    carriage = numbers.weight_if_given(table, gravity)
    if carriage and table.stiffness is UNSET:
        raise numbers.refuse("stiffness", "is missing: what moves sideways needs a support that yields")
    radius = radius_of(table, numbers.source)
    return {"stiffness": stiffness, "carriage_weight": carriage, "support_radius": radius}


def _flywheel(table: Flywheel | UnsetType, gravity: float, numbers: Numbers) -> tuple[float, float]:
    """Momentum and axial moment."""
    if table is UNSET:
        return 0.0, 0.0
    weight = numbers.weight(table, gravity, "not negative")
    radius = numbers.value("radius_of_gyration", table.radius_of_gyration, "length", "not negative")
    moment = weight * radius * radius
    momentum = moment / gravity * numbers.value("spin", table.spin, "spin", "any")
    if not math.isfinite(momentum):
        raise numbers.refuse("spin", f"gives too large an angular momentum, got {table.spin}")
    return momentum, moment if table.driven else 0.0


def _displaced(
    table: Displaced | UnsetType, own: tuple[float, float], gravity: float, numbers: Numbers
) -> tuple[float, float, float, float]:
    """Weight displaced, weight added, centroid, radius of gyration."""
    if table is UNSET:
        return 0.0, 0.0, *own
    weight = numbers.weight(table, gravity, "not negative")
    added = numbers.weight_if_given(table, gravity, "added_")
    centroid, radius = own
    if table.centroid is not UNSET:
        centroid = numbers.value("centroid", table.centroid, "length", "any")
    if table.radius_of_gyration is not UNSET:
        radius = numbers.value("radius_of_gyration", table.radius_of_gyration, "length", "not negative")
    return weight, added, centroid, radius
