# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of a steady shape of a chain held at both ends."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..systems.numbers import Floats, refuse_beyond_memory
from .sensitivity import Sensitivity
from .shape_sensitivity import PARTS, Balance, Change, by_weight, changes_of, loads_of, named, of_shape, reach_of_pins, solved

if TYPE_CHECKING:
    from .shapes import SteadyShape

OF_ENDS = tuple(f"{end}_{name}" for end in ("lower", "upper") for name in ("radius", "stiffness", "mass"))


class _HeldChain:
    """The balance of a chain held at both ends, as a chain that hangs from its upper end (`Balance`).

    Its lower end is pulled by X across the axis and by Z upwards, in units of masses (weights) times gravity. For each link

        -a (X cos d + Z sin d)

    is added to the moment, and -X to the force on an upper end that yields. The lower end and the span add the equations

        X + E (y_0 - b) - carriage y_0 / lambda = 0,    or y_0 = b,    y_0 = y + sum of a sin d
        sum of a cos d = span

    The unknowns are the inclinations d, the offset y of the upper end, X and Z. Here a is the length of a link, y_0 the
    offset of the lower end, lambda the conical height; E, b and carriage are the stiffness of an end, its distance from
    the axis and the mass that moves with it, in the same units.
    """

    def __init__(self, shape: SteadyShape) -> None:
        held = shape.system
        chain = held.system
        n = chain.size
        self.length, centroid, gyration, mass = (
            np.broadcast_to(np.asarray(x, float), n)
            for x in (chain.length, chain.centroid, chain.radius_of_gyration, chain.mass if held.by_mass else chain.weight)
        )
        pins, upper = np.arange(n), held.upper
        self.weightless, self.lower = held.weightless, held.lower
        self.per = 1.0 if held.weightless else held._force(shape.gravity)
        self.hanging = Balance(
            link=pins,
            bears=np.zeros(n) if held.weightless else mass,
            moves=mass,
            gyration=gyration,
            reach=np.where(pins[:, None] < pins, self.length, 0.0) + np.diag(centroid),
            momentum=np.zeros(n),
            axial=np.zeros(n),
            stiffness=upper.stiffness / self.per,
            carriage=upper.carriage,
            height=(1.0 if held.weightless else shape.gravity) / float(shape.angular_speed) ** 2,
            speed=float(shape.angular_speed),
            radius=upper.radius,
            top=float(shape.offset[-1]),
            sine=np.sin(shape.inclination),
            cosine=np.cos(shape.inclination),
        )
        self.bottom = float(shape.offset[0])
        self.across, self.up = -np.asarray(shape.lower_pull) / self.per

    @property
    def lower_yields(self) -> bool:
        return math.isfinite(self.lower.stiffness)

    @property
    def lower_rate(self) -> float:
        """Derivative of the force at the lower end with respect to its offset."""
        return self.lower.stiffness / self.per - self.lower.carriage / self.hanging.height if self.lower_yields else 1.0

    def slope(self) -> Floats:
        """Derivatives of the N + 3 equations with respect to the N + 3 unknowns."""
        at, n, a = self.hanging, self.hanging.size, self.length
        found = np.zeros((n + 3, n + 3))
        found[: n + 1, : n + 1] = at.slope()
        found[:n, :n] += np.diag(a * (self.across * at.sine - self.up * at.cosine))
        found[:n, n + 1], found[:n, n + 2] = -a * at.cosine, -a * at.sine
        found[n, n + 1] = -float(at.yields)
        found[n + 1, :n], found[n + 1, n] = self.lower_rate * a * at.cosine, self.lower_rate
        found[n + 1, n + 1] = float(self.lower_yields)
        found[n + 2, :n] = -a * at.sine
        return found

    def changes(self) -> dict[str, Change]:
        """Return the change of the balance of the hanging chain by each datum of the chain and of the upper end."""
        at, none = self.hanging, np.zeros((self.hanging.size, 1))
        found = changes_of(at)
        if self.weightless:
            found["mass"] = by_weight(at, slice(0, at.size), 0.0, 1.0)
        found["upper_stiffness"] = Change(kappa=none, force=(at.top - at.radius) / self.per)
        found["upper_mass"] = Change(kappa=none, force=-at.top / at.height)
        return found

    def loads(self, changes: dict[str, Change]) -> dict[str, Floats]:
        """Derivatives of the equations with respect to each datum, at constant unknowns."""
        at, n = self.hanging, self.hanging.size
        loads = {name: np.vstack([load, np.zeros((2, load.shape[1]))]) for name, load in loads_of(at, changes).items()}
        loads["upper_radius"] = loads.pop("support_radius")
        loads["length"][:n] -= np.diag(self.across * at.cosine + self.up * at.sine)
        loads["length"][n + 1], loads["length"][n + 2] = self.lower_rate * at.sine, at.cosine
        lower, yields = self.lower, self.lower_yields
        if yields:
            loads["angular_speed"][n + 1] = -2 / at.speed / at.height * lower.carriage * self.bottom

        def alone(row: int, value: float) -> Floats:
            load = np.zeros((n + 3, 1))
            load[row] = value
            return load

        loads["span"] = alone(n + 2, -1.0)
        loads["lower_radius"] = alone(n + 1, -lower.stiffness / self.per if yields else -1.0)
        loads["lower_stiffness"] = alone(n + 1, (self.bottom - lower.radius) / self.per if yields else 0.0)
        loads["lower_mass"] = alone(n + 1, -self.bottom / at.height if yields else 0.0)
        return loads


def held_shape_sensitivity(shape: SteadyShape) -> Sensitivity:
    """Return the derivatives of a held shape; described by `SteadyShape.sensitivity`."""
    chain = _HeldChain(shape)
    at, n = chain.hanging, chain.hanging.size
    refuse_beyond_memory("revchain.SteadyShape.sensitivity", "the number of links", n, 120 * n)
    changes = chain.changes()
    moved = solved(chain.slope(), chain.loads(changes))

    pins, cosine = reach_of_pins(chain.length, n), at.cosine[:, None]
    below = np.vstack([np.zeros(n), at.carried])  # the bodies below each pin
    pull, hung = below @ (at.moves * at.out) / at.height + chain.across, below @ at.bears - chain.up
    size = np.hypot(pull, hung)[:, None]

    def with_lower_end(part: Floats | float) -> Floats | float:
        return np.vstack([np.zeros(part.shape[1]), part]) if isinstance(part, np.ndarray) else part

    found: dict[str, dict[str, Floats]] = {part: {} for part in PARTS}
    for name, each in moved.items():
        change = changes.get(name, Change())
        swung, top, across, up = cosine * each[:n], each[n], each[n + 1], each[n + 2]
        moves = below @ (at.moves[:, None] * (at.reach @ swung + top)) + with_lower_end(change.sideways)
        hangs = with_lower_end(change.hung) - up
        found["inclination"][name] = each[:n]
        found["offset"][name] = pins @ swung + top + change.pins
        found["tension"][name] = chain.per * (pull[:, None] * (moves / at.height + across) + hung[:, None] * hangs) / size
    _at_given_end(shape, found)
    for by in found.values():
        named(by, shape.system.system, ("angular_speed", "span", "tension", *OF_ENDS))
    return of_shape(n, [found[part] for part in PARTS])


def _at_given_end(shape: SteadyShape, found: dict[str, dict[str, Floats]]) -> None:
    """Convert the derivatives to constant tension if the tension was given; those by the datum not given become NaN."""
    if shape.system.tension is None:
        for by in found.values():
            by["tension"] = np.full_like(by["span"], math.nan)
        return
    top = {name: change[-1:].copy() for name, change in found["tension"].items()}
    for by in found.values():
        per_span = by["span"] / top["span"][0, 0]
        for name in by:
            if name != "span":
                by[name] = by[name] - per_span * top[name]
        by["tension"], by["span"] = per_span, np.full_like(per_span, math.nan)
