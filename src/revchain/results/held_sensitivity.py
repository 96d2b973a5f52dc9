# SPDX-License-Identifier: GPL-3.0-or-later
"""How a steady shape of a chain held at both ends changes with the speed and with its data."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from ..systems.numbers import Floats, refuse_beyond_memory
from .base import Field
from .sensitivity import DATA
from .shape_sensitivity import PARTS, DerivativesByLink, ShapeSensitivity

if TYPE_CHECKING:
    from .bent import HeldShape

OF_ENDS = tuple(f"{end}_{name}" for end in ("lower", "upper") for name in ("radius", "stiffness", "mass"))


class HeldShapeDerivatives(DerivativesByLink):
    """Derivatives of some numbers of a shape held at both ends, one row for each; see `ShapeSensitivity`.

    The ends keep what they were given: their distance along the axis (`span`), or the tension at the upper one. With
    respect to the other of the two the derivatives are NaN.
    """

    __slots__ = ()
    span: Field[Floats] = Field("With respect to the distance of the ends along the axis, per m, shape (M,).", part=True)
    tension: Field[Floats] = Field("With respect to the tension given, per N, (M,).", part=True)
    lower_radius: Field[Floats] = Field("With respect to the radius of the lower end, (M,).", part=True)
    lower_stiffness: Field[Floats] = Field("With respect to its stiffness, per N/m, (M,); 0 where it is firm.", part=True)
    lower_mass: Field[Floats] = Field("With respect to what moves with it, (M,); 0 where it is firm.", part=True)
    upper_radius: Field[Floats] = Field("With respect to the radius of the upper end, (M,).", part=True)
    upper_stiffness: Field[Floats] = Field("With respect to its stiffness, per N/m, (M,); 0 where it is firm.", part=True)
    upper_mass: Field[Floats] = Field("With respect to what moves with it, (M,); 0 where it is firm.", part=True)

    def _names(self) -> tuple[str, ...]:
        return ("angular_speed", "span", "tension", *OF_ENDS, *DATA)


class _Chain:
    """A chain held at both ends, in masses (by weight: weights) and lengths; forces are divided by gravity.

    Unknown are the inclinations d, the offset y of the upper end, and what the lower bearing does to the chain: X across
    the axis and Z upwards. With reach = a below a pin and h at a link's own body, out = y + reach sin d:

        bears reach sin d - (moves out reach + own sin d) cos d / lambda - a (X cos d + Z sin d) = 0      of each link
        E (y - b) - (sum of moves out + carriage y) / lambda - X = 0,    or y = b                         upper end
        X + E (y_0 - b) - carriage y_0 / lambda = 0,    or y_0 = b,    y_0 = y + sum of a sin d           lower end
        sum of a cos d = span
    """

    def __init__(self, shape: HeldShape) -> None:
        held = shape.system
        chain = held.system
        n = chain.size
        self.size = n
        column = [np.broadcast_to(np.asarray(x, float), n) for x in (chain.length, chain.centroid, chain.radius_of_gyration)]
        self.length, self.centroid, self.gyration = column
        self.mass = np.broadcast_to(np.asarray(chain.mass if held.by_mass else chain.weight, float), n)
        self.speed = float(shape.angular_speed)
        self.per = 1.0 if held.weightless else held._force(shape.gravity)
        self.rate = self.speed**2 / (1.0 if held.weightless else shape.gravity)  # 1 / lambda
        self.bears = np.zeros(n) if held.weightless else self.mass
        self.sine, self.cosine = np.sin(shape.inclination), np.cos(shape.inclination)
        self.ends = held.lower, held.upper
        self.offset = float(shape.offset[0]), float(shape.offset[-1])
        self.across, self.up = -np.asarray(shape.lower_pull) / self.per
        pins = np.arange(n)
        self.below = (pins[:, None] < pins).astype(float)  # whether body r hangs below link m
        self.reach = self.below * self.length + np.diag(self.centroid)
        self.out = self.offset[1] + self.reach @ self.sine
        self.turning = self.reach.T @ (self.mass * self.out) + self.mass * self.gyration**2 * self.sine

    def matrix(self) -> Floats:
        """Derivatives of the N + 3 equations by the N + 3 unknowns."""
        n, s, c, a, rate = self.size, self.sine, self.cosine, self.length, self.rate
        moved = self.reach.T @ (self.mass[:, None] * self.reach) + np.diag(self.mass * self.gyration**2)
        pull = (self.bears @ self.reach) * c + s * self.turning * rate + a * (self.across * s - self.up * c)
        beside = c * (self.mass @ self.reach) * rate
        found = np.zeros((n + 3, n + 3))
        found[:n, :n] = np.diag(pull) - np.outer(c, c) * moved * rate
        found[:n, n], found[:n, n + 1], found[:n, n + 2] = -beside, -a * c, -a * s
        lower, upper = self.ends
        found[n, n] = 1.0
        if math.isfinite(upper.stiffness):
            found[n, :n], found[n, n + 1] = -beside, -1.0
            found[n, n] = upper.stiffness / self.per - (self.mass.sum() + upper.carriage) * rate
        found[n + 1, :n], found[n + 1, n] = a * c, 1.0
        if math.isfinite(lower.stiffness):
            found[n + 1] *= lower.stiffness / self.per - lower.carriage * rate
            found[n + 1, n + 1] = 1.0
        found[n + 2, :n] = -a * s
        return found

    def loads(self) -> dict[str, Floats]:
        """Derivatives of the equations by each datum, while the unknowns stay."""
        n, s, c, rate = self.size, self.sine, self.cosine, self.rate
        lower, upper = self.ends
        springs = [math.isfinite(end.stiffness) for end in self.ends]
        follows = lower.stiffness / self.per - lower.carriage * rate if springs[0] else 1.0
        mass, own, bears = self.mass, self.gyration**2 * s, self.bears / self.mass if self.bears.any() else np.zeros(n)

        def columns(kappa: Floats | float, turning: Floats, across: Floats | float, count: int) -> Floats:
            """By what changes of the moments of what bears and of what moves, and of the sum of moves out."""
            load = np.zeros((n + 3, count))
            load[:n] = s[:, None] * kappa - c[:, None] * turning * rate
            if springs[1]:
                load[n] = -np.asarray(across) * rate
            return load

        drawn = mass[:, None] * self.below * s
        found = {"mass": columns(bears * self.reach.T, self.reach.T * self.out + np.diag(own), self.out, n)}
        carried = mass * self.out
        length = columns(
            np.diag(self.bears @ self.below), np.diag(carried @ self.below) + self.reach.T @ drawn, drawn.sum(axis=0), n
        )
        length[:n] -= np.diag(self.across * c + self.up * s)
        length[n + 1], length[n + 2] = follows * s, c
        found["length"] = length
        found["centroid"] = columns(
            np.diag(self.bears), np.diag(carried) + self.reach.T * (mass * s), mass * s, n
        )
        found["radius_of_gyration"] = columns(0.0, np.diag(2 * mass * self.gyration * s), 0.0, n)
        faster = columns(0.0, self.turning[:, None], carried.sum() + upper.carriage * self.offset[1], 1)
        if springs[0]:
            faster[n + 1] = -lower.carriage * self.offset[0] * rate
        found["angular_speed"] = faster * (2 / self.speed)
        found["span"] = _at(n, n + 2, -1.0)
        for name, row, end, y, spring in zip(("lower", "upper"), (n + 1, n), self.ends, self.offset, springs, strict=True):
            found[f"{name}_radius"] = _at(n, row, -end.stiffness / self.per if spring else -1.0)
            found[f"{name}_stiffness"] = _at(n, row, (y - end.radius) / self.per if spring else 0.0)
            found[f"{name}_mass"] = _at(n, row, -y * rate if spring else 0.0)
        return found


def _at(n: int, row: int, value: float) -> Floats:
    load = np.zeros((n + 3, 1))
    load[row] = value
    return load


def held_shape_sensitivity(shape: HeldShape) -> ShapeSensitivity:
    """See `HeldShape.sensitivity`."""
    at = _Chain(shape)
    n, s, c = at.size, at.sine[:, None], at.cosine[:, None]
    refuse_beyond_memory("revchain.HeldShape.sensitivity", "the number of links", n, 120 * n)
    loads = at.loads()
    solved = -np.linalg.solve(at.matrix(), np.concatenate(list(loads.values()), axis=1))
    ends = np.cumsum([load.shape[1] for load in loads.values()])[:-1]
    moved = dict(zip(loads, np.split(solved, ends, axis=1), strict=True))

    pins = np.vstack([np.triu(np.broadcast_to(at.length, (n, n))), np.zeros(n)])  # offsets: y + pins sin d
    below = np.vstack([np.zeros(n), np.tril(np.ones((n, n)))])  # the bodies below each pin
    pull, hung = below @ (at.mass * at.out) * at.rate + at.across, below @ at.bears - at.up
    size = np.hypot(pull, hung)[:, None]
    explicit = _explicit(at, below)
    found: dict[str, dict[str, Floats]] = {part: {} for part in PARTS}
    for name, each in moved.items():
        swung, top, across, up = c * each[:n], each[n], each[n + 1], each[n + 2]
        moves, hangs, drawn = explicit.get(name, (0.0, 0.0, 0.0))
        rise = at.rate * (below @ (at.mass[:, None] * (at.reach @ swung + top)) + moves) + across
        found["inclination"][name] = each[:n]
        found["offset"][name] = pins @ swung + top + drawn
        found["tension"][name] = at.per * (pull[:, None] * rise + hung[:, None] * (hangs - up)) / size
    _hold(shape, found)
    return ShapeSensitivity._made(None, **{part: _named(shape, found[part]) for part in PARTS})


def _explicit(at: _Chain, below: Floats) -> dict[str, tuple[Floats, Floats | float, Floats | float]]:
    """By each datum, while nothing moves: the sum of moves out below each pin, what hangs there, the offsets of the pins."""
    n, s = at.size, at.sine
    raised = np.vstack([np.triu(np.ones((n, n))) * s, np.zeros(n)])
    bears = below if at.bears.any() else 0.0
    out = (below @ (at.mass * at.out))[:, None]
    return {
        "mass": (below * at.out, bears, 0.0),
        "length": (below @ (at.mass[:, None] * at.below * s), 0.0, raised),
        "centroid": (below * (at.mass * s), 0.0, 0.0),
        "angular_speed": (2 / at.speed * out, 0.0, 0.0),
    }


def _hold(shape: HeldShape, found: dict[str, dict[str, Floats]]) -> None:
    """At a given tension the span gives way; else nothing is known of a tension that was not given."""
    if shape.system.tension is None:
        for by in found.values():
            by["tension"] = np.full_like(by["span"], math.nan)
        return
    slope = found["tension"]["span"][-1, 0]
    top = {name: change[-1:].copy() for name, change in found["tension"].items()}
    for by in found.values():
        per_span = by["span"] / slope
        for name in by:
            if name != "span":
                by[name] = by[name] - per_span * top[name]
        by["tension"], by["span"] = per_span, np.full_like(per_span, math.nan)


def _named(shape: HeldShape, given: dict[str, Floats]) -> HeldShapeDerivatives:
    chain = shape.system.system
    turned = given["centroid"] * chain.centroid + given["radius_of_gyration"] * chain.radius_of_gyration
    given["length_in_proportion"] = given["length"] + turned / chain.length
    for name in ("angular_speed", "span", "tension", *OF_ENDS):
        given[name] = given[name][:, 0]
    return HeldShapeDerivatives._made(None, **given)
