# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain and its fittings: a support, flywheels, a fluid, springs and dashpots, linear drag, inverted links."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .chain import Chain, compiled, like
from .numbers import (
    STANDARD_GRAVITY,
    Floats,
    array_of,
    floats,
    mass_or_weight,
    read_only,
    real,
    refuse_where,
    shown,
    word,
)
from .system import System, plain
from .unchangeable import Unchangeable

FLUIDS = ("still", "turning")


class _Fitting(Unchangeable):
    """The base of what is fitted to the links of a rig: their numbers by name."""

    __slots__ = ("_given",)
    _given: dict[str, Any]

    def __getattr__(self, name: str) -> Any:
        if name == "_given" or name.startswith("__"):
            raise AttributeError(name)
        if name in type(self).__init__.__annotations__:
            return self._given.get(name)
        raise AttributeError(f"a {type(self).__name__} has no {name}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *type(self).__init__.__annotations__} - {"return"})

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return self._given.keys() == other._given.keys() and all(
            _alike(value, other._given[name]) for name, value in self._given.items()
        )

    def __hash__(self) -> int:
        return hash((type(self), tuple(sorted(self._given))))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={plain(value)}' for name, value in self._given.items())})"

    def __reduce__(self) -> tuple[Any, ...]:
        return _fitting, (type(self), self._given)


def check_columns(caller: str, columns: Mapping[str, Floats], signed: tuple[str, ...] = ()) -> None:
    """Raise a ValueError for a number that is not finite or, but for the `signed` columns, is negative."""
    for name, column in columns.items():
        refuse_where(~np.isfinite(column), column, f"{caller}: {name} must be finite")
        if name not in signed:
            refuse_where(column < 0, column, f"{caller}: {name} must not be negative")


def refuse_empty(caller: str, name: str, column: Floats) -> None:
    """Raise a ValueError for an array without a number."""
    if not column.size:
        raise ValueError(f"{caller}: {name} must have a number for each link, got none")


def _alike(one: Any, other: Any) -> bool:
    """Return whether two values are equal; a number equals an array that repeats it."""
    shapes = {np.shape(one), np.shape(other)} - {()}
    return len(shapes) < 2 and bool(np.all(np.equal(one, other)))


def _fitting(kind: type[_Fitting], given: dict[str, Any]) -> _Fitting:
    return kind(**given)


class Support(_Fitting):
    """The support of the uppermost pin: firm, on a horizontal spring, a free trolley, or moving in a circle.

    The ends of a `Held` chain have such supports, too.

    Parameters
    ----------
    stiffness : float
        Horizontal stiffness of the spring, N/m; infinite for a firm support, 0 for a trolley that rolls freely. With a
        positive mass or weight and no stiffness the support is such a trolley.
    damping : float
        Damping of a dashpot between the pin and the ground, N s/m.
    mass, weight : float, optional
        Mass (kg) or weight (N) that moves horizontally with the pin, in the same quantity as the chain.
    radius : float
        Radius of the circle in which the support is carried round, m; 0 on the axis. With a spring it is the radius of
        its rest position.

    Raises
    ------
    ValueError
        If a number is out of its range, or the arguments do not go together.

    References
    ----------
    Greenhill (1908), sections 1 (9) and 2 (7). Free trolley: J. R. Taylor, Classical Mechanics (2005), problem 11.28.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.Support(stiffness="2 kN/m", mass=20.0)
    Support(stiffness=2000.0, mass=20.0)

    A trolley of 1 t that rolls freely under a crane:

    >>> load = rc.Chain(mass=4000.0, length=10.0)
    >>> rc.modes(rc.Rig(load, support=rc.Support(mass=1000.0)), gravity=9.81).angular_speed.round(4)
    array([2.2147])
    """

    __slots__ = ()

    def __init__(
        self,
        *,
        stiffness: float | None = None,
        damping: float = 0.0,
        mass: float | None = None,
        weight: float | None = None,
        radius: float = 0.0,
    ) -> None:
        caller = "revchain.Support"
        if mass is not None and weight is not None:
            raise ValueError(f"{caller}: give either mass or weight, got both")
        numbers = {"stiffness": stiffness, "damping": damping, "mass": mass, "weight": weight, "radius": radius}
        given = {name: real(caller, name, value) for name, value in numbers.items() if value is not None}
        for name, value in given.items():
            if name == "stiffness" and not value >= 0:
                raise ValueError(f"{caller}: stiffness must not be negative, got {value:g}")
            if name == "radius" and not math.isfinite(value):
                raise ValueError(f"{caller}: radius must be finite, got {value:g}")
            if name in ("damping", "mass", "weight") and not 0 <= value < math.inf:
                raise ValueError(f"{caller}: {name} must be finite and not negative, got {value:g}")
        moving = [name for name in ("mass", "weight", "damping") if given.get(name)]
        if moving and math.isinf(given.get("stiffness", math.inf if moving == ["damping"] else 0.0)):
            raise ValueError(
                f"{caller}: {moving[0]} does not go with a firm support: give a stiffness (0 for a trolley that rolls "
                f"freely), got {moving[0]} {given[moving[0]]:g}"
            )
        free = bool(moving) and "stiffness" not in given or given.get("stiffness") == 0
        if free and given.get("radius"):
            raise ValueError(f"{caller}: a trolley that rolls freely has no radius, got radius {given['radius']:g}")
        left_out = {"stiffness": math.inf}
        kept = {name: value for name, value in given.items() if value != left_out.get(name, 0.0)}
        if free and not {"mass", "weight"} & kept.keys():
            kept["stiffness"] = 0.0
        _set(self, "_given", kept)

    @property
    def stiffness(self) -> float:
        """Stiffness of the spring, N/m; infinite for a firm support."""
        return float(self._given.get("stiffness", 0.0 if {"mass", "weight"} & self._given.keys() else math.inf))

    @property
    def damping(self) -> float:
        """Damping of the dashpot to the ground, N s/m."""
        return float(self._given.get("damping", 0.0))

    @property
    def _yields(self) -> bool:
        return math.isfinite(self.stiffness)

    @property
    def radius(self) -> float:
        """Radius of the circle in which the support is carried round, m."""
        return float(self._given.get("radius", 0.0))

    @property
    def carriage(self) -> float:
        """The mass or weight that moves with the pin of the support."""
        return float(self._given.get("mass", self._given.get("weight", 0.0)))

    def _words(self, unit: str) -> str:
        held = "firm" if math.isinf(self.stiffness) else f"on a spring of {self.stiffness:.6g} N/m"
        if self.stiffness == 0:
            held = "a trolley that rolls freely"
        held += f" with {self.carriage:.6g} {unit}" if self.carriage else ""
        held += f", damped by {self.damping:.6g} N s/m" if self.damping else ""
        return held + (f", carried round at {self.radius:.6g} m" if self.radius else "")


class Pin(_Fitting):
    """Torsion springs and dashpots at the pins: bending stiffness of a cable, friction of hinges.

    Each acts between the two links at a pin; at the uppermost pin between the link and the vertical. Give each quantity as
    one number, or as an array with one number for the upper pin of each link, lowest first.

    Parameters
    ----------
    stiffness : array_like, shape (N,) or scalar
        Torque over the angle between the links, N m/rad; the straight chain is relaxed. For a chain given by weight in the
        unit of its weights times m.
    damping : array_like
        Torque over the rate of that angle, N m s/rad; for a chain given by weight in the unit of its weights times m s.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    A cable of bending stiffness EI in links of length a has springs EI/a at its pins, and 2 EI/a at a clamp. Cost: O(N),
    when the rig is made. Source: docs/theory/damping.

    Examples
    --------
    >>> import revchain as rc
    >>> pendulum = rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=0.2))
    >>> m = rc.modes(pendulum, gravity=9.81)
    >>> m.exponent.round(4), m.damping_ratio.round(4), m.decay_time
    (array([-0.1+3.1305j]), array([0.0319]), array([10.]))
    """

    __slots__ = ()

    def __init__(self, *, stiffness: ArrayLike = 0.0, damping: ArrayLike = 0.0) -> None:
        caller = "revchain.Pin"
        given = {"stiffness": stiffness, "damping": damping}
        columns = {name: floats(caller, name, value, f"pin_{name}") for name, value in given.items()}
        check_columns(caller, columns)
        for name, column in columns.items():
            refuse_empty(caller, name, column)
        _set(self, "_given", {name: read_only(column) for name, column in columns.items() if column.any()})


class Flywheel(_Fitting):
    """Wheels that spin about the axes of links.

    Give each quantity as one number, or as an array with one number for each link, lowest first.

    Parameters
    ----------
    mass, weight : array_like, shape (N,) or scalar
        Mass (kg) or weight (N) of each wheel, in the same quantity as the chain; 0 if a link has no wheel.
    radius_of_gyration : array_like
        Radius of gyration of each wheel about its axis, m. The axis is that of the link.
    spin : array_like
        Spin of each wheel, rad/s; positive if the wheel of a hanging link turns in the direction of a positive speed.
        A wheel on free bearings keeps its spin relative to the ground, a driven wheel relative to its link.
    driven : array_like of bool
        Whether a motor drives the wheel.
    momentum : array_like
        Constant angular momentum of each wheel along the axis of its link, instead of the four quantities above, kg
        m^2/s; for a chain given by weight, in weight times length times time.
    axial_moment : array_like, optional
        With `momentum`: moment of inertia of the turning parts of each link about its axis, kg m^2; for a chain given
        by weight, in weight times length squared.

    Raises
    ------
    ValueError
        If a number is out of its range, or the arguments do not go together.

    Notes
    -----
    A link with momentum H and axial moment C has the angular momentum ``H + C n cos(inclination)`` along its axis at
    the speed `n`. The data of the link include the wheel's mass and its inertia across the axis. Cost: O(N), when the
    rig is made. Source: Greenhill (1908), section 8.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.Flywheel(mass=1.5, radius_of_gyration=0.29, spin="400 rpm").spin.round(3)
    np.float64(41.888)
    """

    __slots__ = ()

    def __init__(
        self,
        *,
        mass: ArrayLike | None = None,
        weight: ArrayLike | None = None,
        radius_of_gyration: ArrayLike | None = None,
        spin: ArrayLike | None = None,
        driven: ArrayLike = False,
        momentum: ArrayLike | None = None,
        axial_moment: ArrayLike | None = None,
    ) -> None:
        caller = "revchain.Flywheel"
        wheel = {"radius_of_gyration": radius_of_gyration, "spin": spin}
        if momentum is None and axial_moment is None:
            by_mass, heavy = mass_or_weight(caller, mass, weight)
            for name, value in wheel.items():
                if value is None:
                    raise ValueError(f"{caller}: {name} is missing")
            given = {"mass" if by_mass else "weight": heavy, **wheel}
        elif any(value is not None for value in (mass, weight, *wheel.values())):
            raise ValueError(f"{caller}: give mass, radius_of_gyration and spin, or momentum instead of them, not both")
        else:
            given = {"momentum": 0.0 if momentum is None else momentum, "axial_moment": axial_moment}
        columns = {name: floats(caller, name, value) for name, value in given.items() if value is not None}
        check_columns(caller, columns, signed=("spin", "momentum"))
        if "axial_moment" in columns and not columns["axial_moment"].any():
            del columns["axial_moment"]
        _set(self, "_given", {name: read_only(column) for name, column in columns.items()})
        if driven is False:
            return
        flags = array_of(driven)
        if flags.dtype != np.bool_:
            raise ValueError(f"{caller}: driven must be True, False or an array of them, got {shown(driven)}")
        if not flags.any():
            return
        if "spin" not in columns:
            raise ValueError(f"{caller}: driven goes with mass, radius_of_gyration and spin; with momentum give axial_moment")
        self._given["driven"] = read_only(flags)

    @property
    def _inertia(self) -> Floats:
        """Moment of inertia of each wheel about its axis; 0 where the momentum was given instead."""
        given = self._given
        if "spin" not in given:
            return _NOTHING
        radius = given["radius_of_gyration"]
        with np.errstate(over="ignore", invalid="ignore"):
            return np.asarray(given.get("mass", given.get("weight")) * radius * radius)

    def _columns(self, gravity: float) -> dict[str, Floats]:
        """The numbers of the wheels by their names in the compiled rig, which multiplies them in double words."""
        given = self._given
        if "momentum" in given:
            return dict(given)
        with np.errstate(over="ignore", invalid="ignore"):
            moment = self._inertia
            wrong = ~(np.isfinite(moment) & np.isfinite(moment * given["spin"] / gravity))
        radius = np.broadcast_to(given["radius_of_gyration"], wrong.shape)
        refuse_where(wrong, radius, "revchain.Flywheel: gives too large a momentum with radius_of_gyration")
        return {_COLUMN_OF_WHEEL.get(name, name): value for name, value in given.items()}


class Displaced(_Fitting):
    """The fluid that links displace, and its added mass.

    Give each quantity as one number, or as an array with one number for each link, lowest first.

    Parameters
    ----------
    mass, weight : array_like, shape (N,) or scalar
        Mass (kg) or weight (N) of the fluid that each link displaces, in the same quantity as the chain.
    centroid, radius_of_gyration : array_like, optional
        Distance of the centre of gravity of that fluid below the upper pin, and its radius of gyration about that
        point, m; those of the link if left out.
    added_mass, added_weight : array_like, optional
        Added mass (kg) or weight (N) of the still fluid that moves with each link, distributed as the displaced fluid.
        Fluid that turns with the chain has none.

    Raises
    ------
    ValueError
        If a number is out of its range, or the arguments do not go together.

    Notes
    -----
    Cost: O(N), when the rig is made. Source: Greenhill (1908), section 2 (6), for Stokes's float.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.Displaced(mass=0.3, added_mass=0.15)
    Displaced(mass=0.3, added_mass=0.15)
    """

    __slots__ = ()

    def __init__(
        self,
        *,
        mass: ArrayLike | None = None,
        weight: ArrayLike | None = None,
        centroid: ArrayLike | None = None,
        radius_of_gyration: ArrayLike | None = None,
        added_mass: ArrayLike | None = None,
        added_weight: ArrayLike | None = None,
    ) -> None:
        caller = "revchain.Displaced"
        by_mass, heavy = mass_or_weight(caller, mass, weight)
        wrong, other = ("added_weight", added_weight) if by_mass else ("added_mass", added_mass)
        if other is not None:
            raise ValueError(f"{caller}: {wrong} does not go with {'mass' if by_mass else 'weight'}, got {shown(other)}")
        given = {
            "mass" if by_mass else "weight": heavy,
            "centroid": centroid,
            "radius_of_gyration": radius_of_gyration,
            "added_mass": added_mass,
            "added_weight": added_weight,
        }
        columns = {name: floats(caller, name, value) for name, value in given.items() if value is not None}
        check_columns(caller, columns, signed=("centroid",))
        _set(self, "_given", {name: read_only(column) for name, column in columns.items()})

    @property
    def _bears(self) -> bool:
        """Whether any fluid is displaced or moves with a link."""
        return any(value.any() for name, value in self._given.items() if name in _HEAVY)


class Rig(System):
    """A chain with a support, flywheels, a fluid, springs and dashpots, linear drag or inverted links.

    Parameters
    ----------
    chain : Chain
        The chain of N links in vacuum.
    support : Support, optional
        Support of the uppermost pin; a firm point on the axis if left out.
    flywheels : Flywheel, optional
        Wheels that spin about the axes of links.
    displaced : Displaced, optional
        Fluid that the links displace.
    fluid : {"still", "turning"}
        Motion of the fluid. Still fluid reduces the weight of a link by its buoyancy. Fluid that turns with the chain
        also reduces the mass that whirls.
    pins : Pin, optional
        Springs and dashpots at the pins.
    drag : array_like, shape (N,) or scalar, optional
        Linear drag of each link in still air, N s/m, spread evenly along it; for a chain given by weight in the unit of its
        weights, times time over length. It damps small motion. For steady shapes in air see `drag_shape`.
    inverted : array_like of bool, shape (N,) or scalar
        Links that stand on their upper pin (counted along the chain), instead of hanging from it.

    Raises
    ------
    ValueError
        If a number is out of its range, an array does not have one number for each link, or the arguments do not go
        together.
    TypeError
        If `chain`, `support`, `flywheels`, `displaced` or `pins` is of another class.

    Notes
    -----
    Cost: O(N), when the rig is made.

    References
    ----------
    Greenhill (1908), sections 1 (9), 2 (7)-(8), 6 (11)-(12) and 8.

    Examples
    --------
    Two point masses under a hook that gives way by 5 cm to a force of 1 N:

    >>> import revchain as rc
    >>> rc.Rig(rc.Chain(weight=[1.0, 3.0], length=0.5), support=rc.Support(stiffness=20.0))
    Rig of a chain of 2 links: support of stiffness 20

    A chain of bicycle wheels, the lowest two spinning:

    >>> wheels = rc.Chain(mass=1.5, length=[0.1] * 4, centroid=0.05, radius_of_gyration=0.2)
    >>> spinning = rc.Flywheel(mass=1.5, radius_of_gyration=0.29, spin=[40.0, 40.0, 0.0, 0.0])
    >>> rc.Rig(wheels, flywheels=spinning)
    Rig of a chain of 4 links: 2 links with momentum
    """

    __slots__ = {
        "_at": None,
        "_inverted": None,
        "chain": "The chain of links, in vacuum.",
        "drag": "Linear drag of each link, N s/m, shape () or (N,); None if there is none.",
        "displaced": "Fluid that the links displace; None if there is none.",
        "flywheels": "Wheels that spin about the axes of links; None if there are none.",
        "fluid": "Motion of the fluid: ``'still'`` or ``'turning'`` (with the chain).",
        "pins": "Springs and dashpots at the pins; None if there are none.",
        "support": "Support of the uppermost pin.",
    }
    chain: Chain
    support: Support
    flywheels: Flywheel | None
    displaced: Displaced | None
    pins: Pin | None
    drag: Floats | None
    fluid: str
    _inverted: NDArray[np.bool_] | None
    _at: tuple[float, _core.Rig]

    def __init__(
        self,
        chain: Chain,
        *,
        support: Support | None = None,
        flywheels: Flywheel | None = None,
        displaced: Displaced | None = None,
        fluid: str = "still",
        inverted: ArrayLike = False,
        pins: Pin | None = None,
        drag: ArrayLike | None = None,
    ) -> None:
        caller = "revchain.Rig"
        compiled(caller, chain)
        word(caller, "fluid", fluid, FLUIDS)
        fittings: tuple[tuple[str, _Fitting | None, type[_Fitting]], ...] = (
            ("support", support, Support),
            ("flywheels", flywheels, Flywheel),
            ("displaced", displaced, Displaced),
            ("pins", pins, Pin),
        )
        for name, fitting, kind in fittings:
            if fitting is not None and not isinstance(fitting, kind):
                raise TypeError(f"{caller}: {name} must be a revchain.{kind.__name__}, got {shown(fitting)}")
            if fitting is not None and ("mass" in fitting._given or "weight" in fitting._given):
                like(f"{caller}: {name}", chain, fitting._given.get("mass"), fitting._given.get("weight"))
        if support is not None and support.radius < 0:
            raise ValueError(f"{caller}: support radius must not be negative, got {support.radius:g}")
        if displaced is not None:
            for name, column in displaced._given.items():
                _column(caller, f"displaced {name}", column, chain.size)
        if displaced is not None and not (displaced._bears or displaced._given.keys() & {"centroid", "radius_of_gyration"}):
            displaced = None
        if fluid == "turning" and displaced is not None:
            added = displaced._given.get("added_mass", displaced._given.get("added_weight", np.zeros(())))
            refuse_where(added > 0, added, f"{caller}: fluid that turns with the chain has no added mass")
        _set(self, "chain", chain)
        _set(self, "support", Support() if support is None else support)
        _set(self, "flywheels", flywheels)
        _set(self, "displaced", displaced)
        _set(self, "pins", pins if pins is not None and pins._given else None)
        dragged = None if drag is None else floats(caller, "drag", drag)
        if dragged is not None:
            check_columns(caller, {"drag": dragged})
            dragged = _column(caller, "drag", dragged, chain.size)
            dragged = read_only(dragged) if dragged.any() else None
        _set(self, "drag", dragged)
        _set(self, "fluid", fluid)
        _set(self, "_inverted", _flags(caller, inverted, chain.size))
        _set(self, "_at", (STANDARD_GRAVITY, self._made(STANDARD_GRAVITY)))  # what is wrong is said now

    @property
    def size(self) -> int:
        """Number of links."""
        return self.chain.size

    @property
    def by_mass(self) -> bool:  # type: ignore[override]
        """Whether masses were given, not weights."""
        return self.chain.by_mass

    @property
    def inverted(self) -> NDArray[np.bool_]:
        """Whether each link is inverted (stands on its upper pin), shape (N,), lowest first; read-only."""
        return np.broadcast_to(np.False_, self.size) if self._inverted is None else self._inverted

    @property
    def _floats(self) -> bool:
        """Whether a link displaces fluid or moves some."""
        return self.displaced is not None and self.displaced._bears

    def _momentum(self, gravity: float) -> Floats:
        """Constant angular momentum of each link in the compiled rig's unit of force, shape (N,)."""
        return self._turning(gravity)[0]

    def _turning(self, gravity: float) -> tuple[Floats, Floats]:
        """Momentum and axial moment of each link in the compiled rig's unit of force, shape (N,)."""
        under = self._under(gravity)
        return under.momentum, under.axial_moment

    def _own_momentum(self, gravity: float) -> Floats:
        """Constant angular momentum of each link in the unit of `Flywheel`, as given if it was, shape (N,)."""
        if self.flywheels is not None and "momentum" in self.flywheels._given:
            return np.broadcast_to(self.flywheels.momentum, self.size)
        return self._force(gravity) * self._momentum(gravity)

    @property
    def _wheels(self) -> NDArray[np.bool_]:
        inertia = _NOTHING if self.flywheels is None else self.flywheels._inertia
        return np.asarray(np.broadcast_to(inertia > 0, self.size) | (self._momentum(1.0) != 0))

    @property
    def has_momentum(self) -> bool:  # type: ignore[override]
        """Whether a wheel has angular momentum while the chain is at rest."""
        return self.flywheels is not None and bool(self._momentum(STANDARD_GRAVITY).any())

    @property
    def is_damped(self) -> bool:
        """Whether the support or a pin has a dashpot, or a link linear drag."""
        return self.support.damping > 0 or self.drag is not None or (self.pins is not None and "damping" in self.pins._given)

    @property
    def _has_pins(self) -> bool:
        """Whether a pin has a spring, or anything damps motions."""
        return self.pins is not None or self.is_damped

    _kind = "rig"
    _fixes_gravity = "a rig"

    @property
    def _base(self) -> Chain:
        return self.chain

    @property
    def _stands(self) -> NDArray[np.bool_]:
        return self.inverted

    @property
    def _support(self) -> Support:
        return self.support

    @property
    def _fluid(self) -> str | None:  # type: ignore[override]
        return self.fluid if self._floats else None

    @property
    def mode_count(self) -> None:
        """Number of modes: None, as it is known only when they are found."""
        return None

    def _momentum_of_wheels(self, gravity: float, inclination: Any) -> float:
        return self._force(gravity) * float(np.sum(self._momentum(gravity) * np.cos(inclination)))

    def _under(self, gravity: float) -> _core.Rig:
        at = self._at  # of two threads each sees one pair
        if at[0] == gravity or not self._needs_gravity():
            return at[1]
        made = self._made(gravity)
        _set(self, "_at", (gravity, made))
        return made

    def _needs_gravity(self) -> bool:
        wheels = self.flywheels is not None and (self.by_mass or "spin" in self.flywheels._given)
        springs = 0 < self.support.stiffness < math.inf or self._has_pins
        return wheels or (self.by_mass and springs)

    def _made(self, gravity: float) -> _core.Rig:
        caller, size = "revchain.Rig", self.size
        columns: dict[str, Floats] = {}
        if self.flywheels is not None:
            for name, value in self.flywheels._columns(gravity).items():
                columns[name] = _column(caller, name, np.asarray(value, float), size)
        if self.displaced is not None:
            for name, value in self.displaced._given.items():
                columns[_COLUMN_OF[name]] = _column(caller, f"displaced {name}", value, size)
        if self.pins is not None:
            for name, value in self.pins._given.items():
                columns[f"pin_{name}"] = _column(caller, f"pins {name}", value, size)
        if self.drag is not None:
            columns["drag"] = self.drag
        return _core.Rig(
            self.chain._compiled,
            stiffness=self.support.stiffness,
            carriage_weight=self.support.carriage,
            support_radius=self.support.radius,
            support_damping=self.support.damping,
            standing=self._inverted,
            turning_fluid=self.fluid == "turning",
            force=self._force(gravity),
            gravity=gravity,
            **columns,
        )

    def _pin(self, name: str) -> Floats:
        """Stiffness or damping at the upper pin of each link, shape (N,)."""
        given = {} if self.pins is None else self.pins._given
        return np.broadcast_to(given.get(name, _NOTHING), self.size)

    def _words(self) -> list[str]:
        return [f"support: {self.support._words(self.chain._unit)}", *self.chain._link_words(), *self._extras()]

    def _extras(self) -> list[str]:
        """Descriptions of the inverted links, the wheels, the fluid and the pins."""
        borne = self.displaced is not None and np.broadcast_to(next(iter(self.displaced._given.values())), self.size)
        counts = (
            (np.count_nonzero(self.inverted), "inverted"),
            (np.count_nonzero(self._momentum(STANDARD_GRAVITY)), "with momentum"),
            (np.count_nonzero(borne), f"in {self.fluid} fluid"),
            (0 if self.drag is None else np.count_nonzero(np.broadcast_to(self.drag, self.size)), "with linear drag"),
        )
        words = [f"{count:,} link{'s' if count > 1 else ''} {what}" for count, what in counts if count]
        at_pins = {what: int(np.count_nonzero(self._pin(name))) for name, what in _AT_PINS.items()}
        return words + [f"{what}s at {count:,} pin{'s' * (count > 1)}" for what, count in at_pins.items() if count]

    def __len__(self) -> int:
        return self.size

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Rig):
            return NotImplemented
        by_spin = [rig.flywheels is not None and "spin" in rig.flywheels._given and not rig.by_mass for rig in (self, other)]
        same = self.chain == other.chain and by_spin[0] == by_spin[1]
        return same and bool(self._under(STANDARD_GRAVITY) == other._under(STANDARD_GRAVITY))

    def __hash__(self) -> int:
        return hash((self.chain, self.fluid))

    def __repr__(self) -> str:
        links = "1 link" if self.size == 1 else f"{self.size:,} links"
        support, with_what = self.support, []
        if 0 < support.stiffness < math.inf:
            with_what.append(f"support of stiffness {support.stiffness:.6g}")
        if support.stiffness == 0:
            with_what.append(f"trolley of {'mass' if self.by_mass else 'weight'} {support.carriage:.6g} that rolls freely")
        elif support.carriage:
            with_what.append(f"carriage of {'mass' if self.by_mass else 'weight'} {support.carriage:.6g}")
        if support.damping:
            with_what.append(f"support of damping {support.damping:.6g}")
        if support.radius:
            with_what.append(f"carried round at radius {support.radius:.6g}")
        return f"Rig of a chain of {links}: {', '.join(with_what + self._extras()) or 'nothing added'}"

    def _state(self) -> tuple[Any, ...]:
        """The parts that make up the rig."""
        fittings = (self.support, self.flywheels, self.displaced, self.pins)
        given = tuple(None if fitting is None else dict(fitting._given) for fitting in fittings)
        return self.chain, *given, self.fluid, self._inverted, self.drag

    @classmethod
    def _from_state(cls, state: Any) -> Rig:
        chain, support, flywheels, displaced, pins, fluid, inverted, drag = state
        return cls(
            chain,
            support=Support(**support),
            flywheels=None if flywheels is None else Flywheel(**flywheels),
            displaced=None if displaced is None else Displaced(**displaced),
            pins=None if pins is None else Pin(**pins),
            fluid=fluid,
            inverted=False if inverted is None else inverted,
            drag=drag,
        )

    def _data(self) -> dict[str, Any]:
        _, *given, fluid, inverted, drag = self._state()
        names = ("support", "flywheels", "displaced", "pins")
        fittings = {
            name: {key: plain(value) for key, value in fitting.items()}
            for name, fitting in zip(names, given, strict=True)
            if fitting
        }
        more = {name: plain(value) for name, value in (("inverted", inverted), ("drag", drag)) if value is not None}
        return {"chain": self.chain.to_dict(), **fittings, "fluid": fluid, **more}

    @classmethod
    def _from_data(cls, data: dict[str, Any]) -> Rig:
        kinds = {"support": Support, "flywheels": Flywheel, "displaced": Displaced, "pins": Pin}
        if unknown := sorted(data.keys() - kinds.keys() - {"chain", "fluid", "inverted", "drag"}):
            raise TypeError(f"there is no {unknown[0]}")
        fittings: dict[str, Any] = {name: kind(**data[name]) for name, kind in kinds.items() if name in data}
        chain = Chain.from_dict(data["chain"])
        return cls(chain, **fittings, fluid=data["fluid"], inverted=data.get("inverted", False), drag=data.get("drag"))


_HEAVY = ("mass", "weight", "added_mass", "added_weight")
_COLUMN_OF_WHEEL = {"mass": "wheel_weight", "weight": "wheel_weight", "radius_of_gyration": "wheel_radius_of_gyration"}
_COLUMN_OF = {
    "mass": "displaced_weight",
    "weight": "displaced_weight",
    "centroid": "displaced_centroid",
    "radius_of_gyration": "displaced_radius_of_gyration",
    "added_mass": "added_weight",
    "added_weight": "added_weight",
}
_AT_PINS = {"stiffness": "spring", "damping": "dashpot"}
_NOTHING = np.zeros(())


def _flags(caller: str, value: ArrayLike, size: int) -> NDArray[np.bool_] | None:
    if value is False:
        return None
    flags = array_of(value)
    if flags.dtype != np.bool_ or flags.ndim > 1 or (flags.ndim == 1 and flags.size != size):
        raise ValueError(
            f"{caller}: inverted must be True, False or an array of them, one for each of the {size} links, "
            f"got {shown(value)}"
        )
    return read_only(np.ascontiguousarray(np.broadcast_to(flags, size))) if flags.any() else None


def _column(caller: str, name: str, column: Floats, size: int) -> Floats:
    """The column; a ValueError unless it is a number or has one for each link."""
    if column.ndim > 1 or (column.ndim == 1 and column.size != size):
        raise ValueError(
            f"{caller}: {name} must be a number or an array with one for each of the {size} links, "
            f"got shape {column.shape}"
        )
    return column


_set = object.__setattr__
