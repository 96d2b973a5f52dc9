# SPDX-License-Identifier: GPL-3.0-or-later
"""The tables of a scene file, and the system that they describe."""

import math
import re
from typing import Annotated, Any, Literal

import numpy as np
from msgspec import UNSET, UnsetType, json

from ..systems import rig
from ..systems.chain import Chain
from ..systems.cord import Cord as CordSystem
from ..systems.held import Held as HeldSystem
from ..systems.numbers import STANDARD_GRAVITY
from ..systems.rig import Rig
from .ask import Ask
from .chain import Links, Numbers, chain_of_links, of_file, whole, without_place
from .error import SceneError
from .tables import (
    SYSTEMS,
    Cord,
    Displaced,
    Flywheel,
    Held,
    Link,
    Positive,
    Support,
    Table,
    TaperedChain,
    UniformChain,
    says,
)

System = Chain | Rig | CordSystem | HeldSystem


class Tables(Table, frozen=True):
    """The keys of a scene file."""

    schema_version: Annotated[Literal[2], says("Version of this format.")] = 2
    title: Annotated[str, says("Title in one line.")] = ""
    description: Annotated[str, says("Description of any length.")] = ""
    gravity: Annotated[Positive, says("Acceleration of gravity (m/s^2).")] = STANDARD_GRAVITY
    order: Annotated[Literal["free end first", "support first"], says("Order of the links.")] = "free end first"
    links: Annotated[list[Link] | UnsetType, says("The links, in the given order.")] = UNSET
    uniform_chain: Annotated[UniformChain | UnsetType, says("Equal links, instead of links.")] = UNSET
    tapered_chain: Annotated[
        TaperedChain | UnsetType, says("Links cut from a tapering cord, instead of links.")
    ] = UNSET
    cord: Annotated[Cord | UnsetType, says("A flexible cord, instead of links.")] = UNSET
    support: Annotated[Support | UnsetType, says("Support of the chain; a firm point on the axis if left out.")] = UNSET
    fluid: Annotated[Literal["still", "turning"], says("Motion of the fluid: at rest, or turning with the chain.")] = "still"
    held: Annotated[Held | UnsetType, says("Data of a chain or cord that is held at both ends.")] = UNSET
    ask: Annotated[Ask, says("Questions to answer.")] = Ask()

    def _links(self) -> Links:
        """The tables of the links, lowest first, with their numbers in the file."""
        links = [] if isinstance(self.links, UnsetType) else list(enumerate(self.links))
        return links[::-1] if self.order == "support first" else links

    def _bodies(self) -> Links:
        """The tables that are links of the system; a clamped one is part of the link above."""
        return [(index, link) for index, link in self._links() if not link.clamped]

    @property
    def is_rigged(self) -> bool:
        """Whether the scene has more than a chain that hangs from a firm point on the axis."""
        links = [] if isinstance(self.links, UnsetType) else self.links
        unlike = [link.standing or link.flywheel is not UNSET or link.displaced is not UNSET for link in links]
        return self.support is not UNSET or any(unlike)

    @property
    def is_held(self) -> bool:
        """Whether the lower end is also held."""
        return self.held is not UNSET


def is_by_mass(scene: Tables) -> bool:
    """Whether masses stay masses: the scene has no weight, or no gravity."""
    if isinstance(scene.held, Held) and scene.held.weightless:
        return True
    return re.search(rb'weight":', json.encode(scene)) is None  # a key: quotes inside text have a backslash


def system_of(scene: Tables, source: str) -> tuple[System | None, float]:
    """The system of a scene and its gravity; None for the system if all its problems are known already.

    All other problems are raised as one error.
    """
    numbers = Numbers(source, by_mass=is_by_mass(scene))
    given = [name for name in SYSTEMS if getattr(scene, name) is not UNSET]
    if len(given) != 1:
        tables = "[[links]], [uniform_chain], [tapered_chain] or [cord]"
        raise SceneError(source, "", f"give one of {tables}, got {' and '.join(given) or 'none of them'}")
    numbers.gravity = numbers.value("gravity", scene.gravity, "gravity", "positive")
    if scene.links == []:
        raise SceneError(source, "links", "is an empty list: give at least one link")
    made: Chain | CordSystem | None = None
    try:
        if links := scene._links():
            made = chain_of_links(links, numbers)
        else:
            made = whole(given[0], getattr(scene, given[0]), numbers)
    except SceneError as error:
        numbers.problems[:] = error.problems
    ends: HeldSystem | None = None
    if scene.is_rigged and (scene.held is not UNSET or scene.cord is not UNSET):
        name = "cord" if scene.held is UNSET else "held"
        numbers.refuse(name, "does not go with a support, standing links, flywheels or a fluid")
    elif scene.is_rigged:
        assert not isinstance(made, CordSystem)
        return _rig(made, scene, numbers), numbers.gravity
    elif not isinstance(scene.held, UnsetType):
        ends = _held(scene.held, made, numbers.of("held"))
    numbers.done()
    return ends or made, numbers.gravity


def _rig(chain: Chain | None, scene: Tables, numbers: Numbers) -> Rig | None:
    """The rig of a chain. If the chain was refused (None), the errors of the other tables are noted, too."""
    links = scene._bodies()
    repeats = [link.repeat for _, link in links]
    firsts = np.cumsum([0, *repeats])
    given: dict[str, Any] = {"fluid": scene.fluid}
    if not isinstance(scene.support, UnsetType):
        given["support"] = _support(scene.support, numbers.of("support"))
    wheels, fluids = [], []
    for (index, link), first in zip(links, firsts, strict=False):
        place = numbers.of(f"links[{index}]")
        own = (0.0, 0.0) if chain is None else (float(chain.centroid[first]), float(chain.radius_of_gyration[first]))
        wheels.append(_flywheel(link.flywheel, place.of("flywheel")))
        fluids.append(_displaced(link.displaced, own, place.of("displaced")))
        if scene.fluid == "turning" and fluids[-1][1] > 0:
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
        return Rig(chain, **given)
    except ValueError as error:
        raise of_file(error, numbers.source, "links" if links else "support", links) from None


def _support(table: Support, numbers: Numbers) -> dict[str, float]:
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
    """Mass or weight displaced, and added, centroid, radius of gyration; `own` are the last two of the link."""
    if isinstance(table, UnsetType):
        return 0.0, 0.0, *own
    found = {"centroid": own[0], "radius_of_gyration": own[1], **numbers.read(table)}
    return found["heavy"], found["added_heavy"], found["centroid"], found["radius_of_gyration"]


def _held(table: Held, system: Chain | CordSystem | None, numbers: Numbers) -> HeldSystem | None:
    """The chain or cord held at both ends; None if it was refused, which is noted already."""
    if (table.span is UNSET) == (table.tension is UNSET):
        numbers.refuse("", "give either span or tension")
        return None
    given: dict[str, Any] = {**numbers.read(table), "weightless": table.weightless}
    tables = {end: getattr(table, end) for end in ("lower", "upper") if getattr(table, end) is not UNSET}
    ends = {end: _support(support, numbers.of(end)) for end, support in tables.items()}
    numbers.done()
    if system is None:
        return None
    try:
        given |= {end: rig.Support(**support) for end, support in ends.items()}
        return HeldSystem(system, **given)
    except ValueError as error:
        reason = without_place(error)
        key = next(filter(reason.startswith, ends), "span" if table.tension is UNSET else "tension")
        raise SceneError(numbers.source, f"held.{key}", reason.removeprefix(f"{key} ")) from None
