# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain or rig as a multibody engine builds it, and its states of steady motion, in kg, m, s and rad.

The support turns about the vertical; each link has two hinges at its upper pin, one that inclines it in the turning plane
and one that moves it out of it. A link without a wheel has no moment of inertia about its own axis. Springs and dashpots at
a pin act on both of its hinges.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Context, Decimal
from typing import Any

import numpy as np

from ..results.shapes import SteadyShape, SteadyShapes
from ..systems.chain import Chain
from ..systems.numbers import STANDARD_GRAVITY, Floats, one_positive, shown
from ..systems.rig import Rig
from ..systems.system import System

HELD = 1e12
"""Moment of inertia of a support that holds its speed, divided by that of the chain stretched out."""
MOST = 490
"""The largest number of links: MuJoCo nests bodies no deeper than some 500."""
PARTS = ("world", "turntable", "carriage", "free_end")
_LEAST_OF_WHEEL = 4e-15  # link and wheel have half of it each, and MuJoCo takes no less than 1e-15
_DIGITS = Context(prec=40)
_NOT_IN_XML = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
_BENT = "only a Chain or a Rig is a serial chain of links; cut a cord into links first: cord.chain(100)"


@dataclass(frozen=True, slots=True)
class Mechanism:
    """A chain or rig as bodies; arrays over links begin at the free end.

    Attributes
    ----------
    names : tuple of str
        Names of the links; no two are equal.
    mass, length, centroid, moment, radius_of_gyration : array, shape (N,)
        The moment of inertia is that across the link, about its centre of gravity.
    ratio : array, shape (2, N)
        (radius of gyration / length) squared in two words, as the chain holds it.
    wheeled : array of bool, shape (N,)
        Whether a link has a wheel that carries an angular momentum along it.
    pin_stiffness, pin_damping, rest : array, shape (N,)
        Springs and dashpots at the upper pins, and the angles of the hinges at which the springs are relaxed.
    radius, stiffness, damping, carriage : float
        Radius, stiffness and damping of the support, and the mass that moves with it.
    turning : float
        Moment of inertia of the support about the axis.
    gravity : float
    """

    names: tuple[str, ...]
    mass: Floats
    length: Floats
    centroid: Floats
    moment: Floats
    radius_of_gyration: Floats
    ratio: Floats
    wheeled: Any
    pin_stiffness: Floats
    pin_damping: Floats
    rest: Floats
    radius: float
    stiffness: float
    damping: float
    carriage: float
    turning: float
    gravity: float

    @property
    def size(self) -> int:
        """The number of links in the chain."""
        return len(self.names)

    @property
    def yields(self) -> bool:
        """Whether the support is a carriage: on a spring, or a trolley."""
        return math.isfinite(self.stiffness)

    @property
    def reach(self) -> float:
        """The length of the chain plus the radius of the support, in metres."""
        return float(self.length.sum()) + self.radius

    def part(self, k: int, what: str) -> str:
        """The name of a body that belongs to link k; no link has it."""
        name = f"{self.names[k]}_{what}"
        while name in self.names:
            name += "_"
        return name

    def across(self, k: int, least: float) -> float:
        """Moment of inertia of link k with that of a small ball, `least`.

        The forces of steady motion depend on the moment across a link less that along it, which the ball does not change.
        """
        up = down = float(self.moment[k]) + least
        mass, radius = float(self.mass[k]), float(self.radius_of_gyration[k])
        for _ in range(4):
            for near in (up, down):
                if radius_of_gyration(near, mass, least) == radius:
                    return near
            up, down = math.nextafter(up, math.inf), math.nextafter(down, 0.0)
        return float(self.moment[k]) + least


@dataclass(frozen=True, slots=True)
class State:
    """A steady motion: speed, joint angles, how far the spring gives way, rates of wheels relative to links, tensions."""

    name: str
    speed: float
    joint_angle: Floats
    give: float
    wheel_rate: Floats
    tension: Floats


def mechanism(function: str, given: Any, gravity: float | None, several: bool = True) -> tuple[Mechanism, list[State]]:
    """The bodies of a system, or of that of shapes (one, if not `several`), and its states: at rest, or the shapes."""
    shapes = [given] if isinstance(given, SteadyShape) else list(given) if isinstance(given, SteadyShapes) else None
    system = given if shapes is None else given.system
    if not isinstance(system, Chain | Rig):
        if isinstance(system, System):
            raise ValueError(f"{function}: {_BENT}; got {shown(system)}")
        wanted = "revchain.Chain, Rig, SteadyShape or SteadyShapes" if several else "revchain.Chain, Rig or SteadyShape"
        raise TypeError(f"{function}: system must be a {wanted}, got {shown(given)}")
    if shapes is None:
        gravity = one_positive(function, "gravity", STANDARD_GRAVITY if gravity is None else gravity)
    elif gravity is not None:
        its = f"a shape has its gravity, {given.gravity:g}"
        raise ValueError(f"{function}: {its}; leave gravity out, got {shown(gravity)}")
    elif not shapes:
        instead = "give the system instead: shapes.system"
        raise ValueError(f"{function}: the list of shapes is empty; {instead}, got {shown(system)}")
    else:
        gravity = given.gravity
    rig = system if isinstance(system, Rig) else Rig(system)
    if rig._floats:
        instead = "give the rig without displaced"
        raise ValueError(f"{function}: a fluid has no counterpart in the engine; {instead}, got {rig!r}")
    if rig.drag is not None:
        raise ValueError(f"{function}: linear drag has no counterpart in the engine; give the rig without drag, got {rig!r}")
    made, momentum, axial = _bodies(function, rig, gravity)
    if shapes is None:
        return made, [_at_rest(rig, made, momentum)]
    names = ["steady shape"] if len(shapes) == 1 else [f"shape {k}" for k in range(1, len(shapes) + 1)]
    return made, [_steady(name, shape, made, momentum, axial) for name, shape in zip(names, shapes, strict=True)]


def _bodies(function: str, rig: Rig, gravity: float) -> tuple[Mechanism, Floats, Floats]:
    """The bodies, the constant angular momentum of each link along its axis, and the axial moments of inertia."""
    chain = rig.chain
    if chain.mode_count < chain.size:
        raise ValueError(
            f"{function}: links that meet at a pin without mass stay in line, and no engine can move them one by one; "
            f"make them one: chain.clamped(k) with the lower of the two, got {chain.describe()}"
        )
    if chain.size > MOST:
        raise ValueError(
            f"{function}: MuJoCo takes at most {MOST} links, one below another, got {chain.size}; use fewer and longer ones"
        )
    per = 1.0 if chain.by_mass else gravity
    mass, size = (chain.mass if chain.by_mass else chain.weight) / per, chain.size
    momentum, axial = rig._own_momentum(gravity), rig._turning(gravity)[1] / per
    radius = chain.radius_of_gyration
    moment = mass * radius * radius
    wheeled = (momentum != 0) | (axial != 0)
    if (wrong := np.flatnonzero(wheeled & ~(moment > _LEAST_OF_WHEEL))).size:
        raise ValueError(
            f"{function}: flywheels[{wrong[0]}] needs a link with a moment of inertia across its axis, above "
            f"{_LEAST_OF_WHEEL:g} kg m^2; give links[{wrong[0]}] a radius_of_gyration, got {radius[wrong[0]]:g}"
        )
    support = rig.support
    stretched = float(mass.sum()) * (chain.total_length + support.radius) ** 2
    inclination = np.where(rig.inverted, math.pi, 0.0)
    made = Mechanism(
        names=_names(chain),
        mass=mass,
        length=chain.length,
        centroid=chain.centroid,
        moment=moment,
        radius_of_gyration=radius,
        ratio=np.stack([np.broadcast_to(word, size) for word in chain._compiled.__getstate__()[4:6]]),
        wheeled=wheeled,
        pin_stiffness=rig._pin("stiffness"),
        pin_damping=rig._pin("damping"),
        rest=inclination - np.append(inclination[1:], 0.0),
        radius=support.radius,
        stiffness=support.stiffness,
        damping=support.damping,
        carriage=support.carriage / per,
        turning=stretched * (HELD if support.radius or rig.is_damped else 1.0),
        gravity=gravity,
    )
    return made, momentum, axial


def radius_of_gyration(moment: float, mass: float, added: float = 0.0) -> float:
    """The root of moment less what was added to it, over mass, rounded once; 0 where there is nothing."""
    own = _DIGITS.subtract(Decimal(moment), Decimal(added))
    return float(_DIGITS.sqrt(_DIGITS.divide(own, Decimal(mass)))) if own > 0 and mass > 0 else 0.0


def _names(chain: Chain) -> tuple[str, ...]:
    """Names of the links: all different, and none that of a part of the support. Later links of a name get a number.

    A character that XML cannot have becomes "_".
    """
    names: list[str] = []
    given = [_NOT_IN_XML.sub("_", name) for name in chain.names or [f"link_{k}" for k in range(chain.size)]]
    taken = {*PARTS, ""}
    for k, name in enumerate(given):
        if name in taken:
            name = f"{name or 'link'}_{k}"
            while name in taken or name in given:
                name += "_"
        names.append(name)
        taken.add(name)
    return tuple(names)


def _at_rest(rig: Rig, made: Mechanism, momentum: Floats) -> State:
    inclination = np.where(rig.inverted, math.pi, 0.0)
    hung = np.cumsum(made.mass) * made.gravity
    return State("rest", 0.0, made.rest, 0.0, _rates(made, momentum, 0.0, inclination), hung)


def _steady(name: str, shape: SteadyShape, made: Mechanism, momentum: Floats, axial: Floats) -> State:
    speed = shape.direction * shape.angular_speed
    momentum = momentum + axial * speed * np.cos(shape.inclination)
    give = float(shape.offset[-1]) - made.radius
    rates = _rates(made, momentum, speed, shape.inclination)
    return State(name, speed, shape.joint_angle, give, rates, shape.tension)


def _rates(made: Mechanism, momentum: Floats, speed: float, inclination: Floats) -> Floats:
    """Speeds of the wheels relative to their links. A wheel has the moment of inertia of its link."""
    with np.errstate(invalid="ignore", divide="ignore"):
        return np.where(made.wheeled, momentum / made.moment - speed * np.cos(inclination), 0.0)
