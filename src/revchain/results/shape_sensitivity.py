# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensitivity of a steady shape to the speed and to the data of its chain or rig."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..systems.numbers import Floats, refuse_beyond_memory
from ..systems.rig import Rig
from .sensitivity import Sensitivity

if TYPE_CHECKING:
    from ..systems.chain import Chain
    from .shapes import SteadyShape

PARTS = ("inclination", "offset", "tension")
OF_SUPPORT = ("stiffness", "support_mass")


@dataclass(frozen=True, slots=True)
class Balance:
    """The equations of balance of a shape: moments about the N pins, and the force on the support,

        (kappa + n H) sin d - turning cos d / lambda = 0,    E (y - b) - (sum of moves times out + carriage y) / lambda = 0,

    or y = b for a firm support, with y the offset of the uppermost pin. The bodies are the links and, after them, the fluid
    that each displaces. `bears` are their net weights, `moves` the weights of their inertia (masses if those were given).
    A body is at out = y + reach sin d from the axis. kappa and turning are the moments of `bears` and of `moves`.
    """

    link: NDArray[np.intp]
    bears: Floats
    moves: Floats
    gyration: Floats
    reach: Floats
    momentum: Floats
    axial: Floats
    stiffness: float
    carriage: float
    height: float
    speed: float
    radius: float
    top: float
    sine: Floats
    cosine: Floats

    @property
    def size(self) -> int:
        return len(self.sine)

    @property
    def yields(self) -> bool:
        return math.isfinite(self.stiffness)

    @property
    def out(self) -> Floats:
        return self.top + self.reach @ self.sine

    @property
    def kappa(self) -> Floats:
        return self.bears @ self.reach

    @property
    def own(self) -> Floats:
        """Moments of inertia of the bodies of each link about their centres of gravity, less the axial one of its wheel."""
        of_bodies = np.bincount(self.link, weights=self.moves * self.gyration**2, minlength=self.size)
        return of_bodies - self.axial

    @property
    def turning(self) -> Floats:
        return self.reach.T @ (self.moves * self.out) + self.own * self.sine

    @property
    def carried(self) -> NDArray[np.bool_]:
        """Whether a body hangs from the upper pin of a link, shape (N, bodies)."""
        return self.link <= np.arange(self.size)[:, None]

    def slope(self) -> Floats:
        """Derivatives of the equations by the inclinations and the offset of the uppermost pin, shape (N + 1, N + 1)."""
        moved = self.reach.T @ (self.moves[:, None] * self.reach) + np.diag(self.own)
        beside = self.cosine * (self.moves @ self.reach) / self.height
        pull = (self.kappa + self.speed * self.momentum) * self.cosine + self.sine * self.turning / self.height
        links = np.diag(pull) - np.outer(self.cosine, self.cosine) * moved / self.height
        last = np.append(np.zeros(self.size), 1.0)
        if self.yields:
            last = np.append(-beside, self.stiffness - (self.moves.sum() + self.carriage) / self.height)
        return np.vstack([np.column_stack([links, -beside]), last])


@dataclass(frozen=True, slots=True)
class Change:
    """Changes by data at constant shape, a column for each: kappa and turning; the force on a support that yields; lambda
    times the sideways pull on the upper pins; the weight there; the offsets of the pins."""

    kappa: Any = 0.0
    turning: Any = 0.0
    force: Any = 0.0
    sideways: Any = 0.0
    hung: Any = 0.0
    pins: Any = 0.0


def _balance(shape: SteadyShape) -> Balance:
    rig = shape.system if shape.system._kind == "rig" else None
    chain = rig.chain if rig is not None else shape.system
    n = chain.size

    def column(value: Any) -> Floats:
        return np.broadcast_to(np.asarray(value, float), n)

    weight = column(chain.mass if chain.by_mass else chain.weight)
    centroid, gyration = column(chain.centroid), column(chain.radius_of_gyration)
    pins = np.arange(n)
    link, bears, moves = pins, weight, weight
    momentum, axial, stiffness, carriage, radius = column(0.0), column(0.0), math.inf, 0.0, 0.0
    if rig is not None:
        given = {} if rig.displaced is None else rig.displaced._given
        borne = column(given.get("mass", given.get("weight", 0.0)))
        carried = -borne if rig.fluid == "turning" else column(given.get("added_mass", given.get("added_weight", 0.0)))
        link = np.concatenate([link, link])
        bears, moves = np.concatenate([weight, -borne]), np.concatenate([weight, carried])
        centroid = np.concatenate([centroid, column(given.get("centroid", centroid))])
        gyration = np.concatenate([gyration, column(given.get("radius_of_gyration", gyration))])
        momentum, axial = rig._turning(shape.gravity)
        support = rig.support
        stiffness, carriage, radius = support.stiffness / shape._per, support.carriage, support.radius
    reach = np.where(link[:, None] < pins, column(chain.length), 0.0)
    reach += np.where(link[:, None] == pins, centroid[:, None], 0.0)
    return Balance(
        link=link,
        bears=bears,
        moves=moves,
        gyration=gyration,
        reach=reach,
        momentum=momentum,
        axial=axial,
        stiffness=stiffness,
        carriage=carriage,
        height=shape.conical_height,
        speed=shape.direction * shape.angular_speed,
        radius=radius,
        top=float(shape.offset[-1]),
        sine=np.sin(shape.inclination),
        cosine=np.cos(shape.inclination),
    )


def by_weight(at: Balance, bodies: slice, bears: float, moves: float) -> Change:
    """The change by the weights of bodies, one for each link, with the given parts in net weight and in inertia."""
    reach, out = at.reach[bodies], at.out[bodies]
    above = np.tril(np.ones((at.size, at.size)))
    return Change(
        kappa=bears * reach.T,
        turning=moves * (reach.T * out + np.diag(at.gyration[bodies] ** 2 * at.sine)),
        force=-moves * out / at.height,
        sideways=moves * above * out,
        hung=bears * above,
    )


def changes_of(at: Balance) -> dict[str, Change]:
    """The changes by the data of each link of a chain, by the speed and by the radius of the support."""
    n, sine, solid = at.size, at.sine, slice(0, at.size)
    above, lower = np.tril(np.ones((n, n))), at.link[:, None] < np.arange(n)
    drawn, moves = at.moves[:, None] * lower * sine, at.moves[solid]
    carried, turning = at.moves * at.out, at.turning
    return {
        "mass": by_weight(at, solid, 1.0, 1.0),
        "length": Change(
            kappa=np.diag(at.bears @ lower),
            turning=np.diag(carried @ lower) + at.reach.T @ drawn,
            force=-drawn.sum(axis=0) / at.height,
            sideways=at.carried @ drawn,
            pins=np.vstack([above.T * sine, np.zeros(n)]),
        ),
        "centroid": Change(
            kappa=np.diag(at.bears[solid]),
            turning=np.diag(carried[solid]) + at.reach[solid].T * (moves * sine),
            force=-moves * sine / at.height,
            sideways=above * (moves * sine),
        ),
        "radius_of_gyration": Change(turning=np.diag(2 * moves * at.gyration[solid] * sine)),
        # 1/height falls: it acts as a smaller inertia of all bodies
        "angular_speed": Change(
            kappa=np.copysign(1.0, at.speed) * at.momentum[:, None],
            turning=(2 / abs(at.speed) * turning)[:, None],
            force=-2 / abs(at.speed) / at.height * (carried.sum() + at.carriage * at.top),
            sideways=(2 / abs(at.speed) * (at.carried @ carried))[:, None],
        ),
        "support_radius": Change(kappa=np.zeros((n, 1)), force=-at.stiffness),
    }


def _rigged(at: Balance, rig: Rig) -> dict[str, Change]:
    fluid, turns, none = slice(at.size, None), rig.fluid == "turning", np.zeros((at.size, 1))
    return {
        "momentum": Change(kappa=at.speed * np.eye(at.size)),
        "axial_moment": Change(turning=-np.diag(at.sine)),
        "displaced_mass": by_weight(at, fluid, -1.0, -1.0 if turns else 0.0),
        "added_mass": by_weight(at, fluid, 0.0, 0.0 if turns else 1.0),
        "stiffness": Change(kappa=none, force=at.top - at.radius),
        "support_mass": Change(kappa=none, force=-at.top / at.height),
    }


def loads_of(at: Balance, changes: dict[str, Change]) -> dict[str, Floats]:
    """The changes of the moments and of the force at the upper end by each datum at constant shape, (N + 1, data)."""
    loads = {}
    for name, change in changes.items():
        moments = at.sine[:, None] * change.kappa - at.cosine[:, None] * change.turning / at.height
        last = change.force if at.yields else -float(name == "support_radius")
        loads[name] = np.vstack([moments, np.broadcast_to(last, (1, moments.shape[1]))])
    return loads


def solved(slope: Floats, loads: dict[str, Floats]) -> dict[str, Floats]:
    """For each datum, how the shape must change to stay in balance."""
    ends = np.cumsum([load.shape[1] for load in loads.values()])[:-1]
    moved = np.split(-np.linalg.solve(slope, np.concatenate([*loads.values()], axis=1)), ends, axis=1)
    return dict(zip(loads, moved, strict=True))


def reach_of_pins(length: Floats, n: int) -> Floats:
    """Matrix (N + 1, N) that turns sines of inclinations into offsets of the pins from that of the uppermost pin."""
    return np.vstack([np.triu(np.broadcast_to(length, (n, n))), np.zeros(n)])


def named(given: dict[str, Floats], chain: Chain, single: tuple[str, ...]) -> None:
    """Add the derivatives by a length in proportion; make those by `single` data one-dimensional."""
    turned = given["centroid"] * chain.centroid + given["radius_of_gyration"] * chain.radius_of_gyration
    given["length_in_proportion"] = given["length"] + turned / chain.length
    for name in single:
        if name in given:
            given[name] = given[name][:, 0]


def shape_sensitivity(shape: SteadyShape) -> Sensitivity:
    """Return the derivatives of a hanging shape; described by `SteadyShape.sensitivity`."""
    rig = shape.system if shape.system._kind == "rig" else None
    chain = rig.chain if rig is not None else shape.system
    n = chain.size
    refuse_beyond_memory("revchain.SteadyShape.sensitivity", "the number of links", n, (80 if rig is None else 160) * n)
    at = _balance(shape)
    changes = changes_of(at) | (_rigged(at, rig) if rig is not None else {})
    cosine = at.cosine[:, None]
    moved = solved(at.slope(), loads_of(at, changes))

    reach = reach_of_pins(chain.length, n)
    pull, hung = (at.carried @ (at.moves * at.out) / at.height)[:, None], (at.carried @ at.bears)[:, None]
    tension = np.hypot(pull, hung)
    found: list[dict[str, Floats]] = [{}, {}, {}]
    for name, change in changes.items():
        each = moved[name]
        swung, far = cosine * each[:n], each[n:]
        rise = (at.carried @ (at.moves[:, None] * (at.reach @ swung + far)) + change.sideways) / at.height
        found[0][name] = each[:n]
        found[1][name] = reach @ swung + far + change.pins
        found[2][name] = shape._per * (pull * rise + hung * change.hung) / tension
    return of_shape(n, [_named(shape, given) for given in found])


def of_shape(links: int, found: list[dict[str, Floats]]) -> Sensitivity:
    parts = {}
    for of, value in zip(PARTS, found, strict=True):
        rows = len(value["angular_speed"])
        parts[of] = _made(of, "link" if rows == links else "pin", rows, value)
    return _made("a steady shape", "link", links, parts)


def _made(of: str, row: str, rows: int, value: dict[str, Any]) -> Sensitivity:
    given: dict[str, Any] = {"direction": None, "error_bound": None, "relative": None}
    return Sensitivity._made(None, of=of, row=row, number=np.arange(rows), value=value, **given)


def _named(shape: SteadyShape, given: dict[str, Floats]) -> dict[str, Floats]:
    """The derivatives by data in their own units, with those that follow from others."""
    rig = shape.system if shape.system._kind == "rig" else None
    chain = rig.chain if rig is not None else shape.system
    named(given, chain, ("angular_speed", "support_radius", *OF_SUPPORT))
    if rig is None:
        return given
    inertia = 0.0 if rig.flywheels is None else rig.flywheels._inertia
    given["spin"] = given["momentum"] * np.broadcast_to(inertia, chain.size) / shape.gravity
    for name in ("stiffness", "momentum"):
        given[name] = given[name] / shape._per
    return given
