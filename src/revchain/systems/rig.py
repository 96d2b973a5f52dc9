# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain and what it is rigged with: a support that yields or is carried round, standing links, flywheels, a fluid."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from .chain import Chain, compiled
from .numbers import (
    STANDARD_GRAVITY,
    Floats,
    array_of,
    floats,
    numbers,
    positive,
    read_only,
    real,
    refuse_where,
    shown,
    together,
    word,
)
from .unchangeable import Unchangeable

_PER_LINK = (
    "momentum",
    "axial_moment",
    "displaced_weight",
    "displaced_centroid",
    "displaced_radius_of_gyration",
    "added_weight",
)
_FLUIDS = ("still", "turning")


class Rig(Unchangeable):
    """A chain and what it is rigged with.

    What is left out is not there, and costs nothing. Quantities of the links are given as one number
    for every link or as an array with one for each, lowest first.

    Parameters
    ----------
    chain : Chain
        The chain of N links. Its weights, lengths and inertia are those of the links with whatever
        wheels they carry, in vacuum.
    stiffness : float
        Of a spring that holds the support sideways, force over length; infinite: a firm support.
    carriage_weight : float
        Of what moves sideways with a support that yields.
    support_radius : float
        Radius of the circle in which the support (the place of rest of its spring) is carried round;
        0 on the axis.
    standing : array_like of bool, shape (N,) or scalar
        Links that stand on their upper pin (counted along the chain) rather than hang from it, in
        the straight chain that small oscillations are about.
    momentum : array_like, shape (N,) or scalar
        Angular momentum that each link carries along its own axis and keeps, from the lower to the
        upper pin: positive where a hanging link's wheel turns in the sense of a positive speed.
        Force times length times time; see `free_flywheel`.
    axial_moment : array_like, shape (N,) or scalar
        Of what turns with each link about its own axis, weight times length squared, not negative; see
        `driven_flywheel`.
    displaced_weight : array_like, shape (N,) or scalar
        Of the fluid that each link displaces, not negative.
    displaced_centroid, displaced_radius_of_gyration : array_like, shape (N,) or scalar, optional
        Centre of gravity of that fluid, from the upper pin, and its radius of gyration about there; those
        of the link if left out.
    added_weight : array_like, shape (N,) or scalar
        Of still fluid that has to move with each link, spread as the fluid displaced; none where it turns.
    fluid : {"still", "turning"}
        Fluid at rest bears; fluid that turns with the chain also lessens what whirls.

    Raises
    ------
    ValueError
        For numbers that are not finite (`stiffness` may be infinite) or out of the range given above, and
        for arrays that have not one number for each link; the message names the link.
    TypeError
        If `chain` is not a `Chain`.

    Notes
    -----
    With `momentum` H and `axial_moment` C a link carries the angular momentum ``H + C n cos(inclination) / g`` along
    its axis, `n` the speed. Cost O(N), once.

    References
    ----------
    Greenhill (1908), sections 1 (9), 2 (7)-(8), 6 (11)-(12) and 8.

    Examples
    --------
    Two plummets under a hook that gives way by 5 cm to a force of 1 N:

    >>> import revchain as rc
    >>> rc.Rig(rc.Chain(weight=[1.0, 3.0], length=0.5), stiffness=20.0)
    Rig of a chain of 2 links: support of stiffness 20

    A chain of bicycle wheels, the lowest two spinning:

    >>> wheels = rc.Chain(weight=15.0, length=[0.1] * 4, centroid=0.05, radius_of_gyration=0.2)
    >>> spin = rc.free_flywheel(weight=15.0, radius_of_gyration=0.29, spin=[40.0, 40.0, 0.0, 0.0])
    >>> rc.Rig(wheels, **spin)
    Rig of a chain of 4 links: 2 links with momentum
    """

    __slots__ = ("_chain", "_compiled", "_given")
    _chain: Chain
    _compiled: _core.Rig
    _given: dict[str, Any]

    def __init__(
        self,
        chain: Chain,
        *,
        stiffness: float = math.inf,
        carriage_weight: float = 0.0,
        support_radius: float = 0.0,
        standing: ArrayLike = False,
        momentum: ArrayLike = 0.0,
        axial_moment: ArrayLike = 0.0,
        displaced_weight: ArrayLike = 0.0,
        displaced_centroid: ArrayLike | None = None,
        displaced_radius_of_gyration: ArrayLike | None = None,
        added_weight: ArrayLike = 0.0,
        fluid: str = "still",
    ) -> None:
        place = "revchain.Rig"
        core = compiled(place, chain)
        word(place, "fluid", fluid, _FLUIDS)
        support = {
            "stiffness": real(place, "stiffness", stiffness),
            "carriage_weight": real(place, "carriage_weight", carriage_weight),
            "support_radius": real(place, "support_radius", support_radius),
        }
        columns: dict[str, Any] = {"standing": _flags(place, standing, chain.size)}
        for name, value in zip(
            _PER_LINK,
            (
                momentum,
                axial_moment,
                displaced_weight,
                displaced_centroid,
                displaced_radius_of_gyration,
                added_weight,
            ),
            strict=True,
        ):
            columns[name] = _column(place, name, value, chain.size)
        given = {**support, **columns}
        object.__setattr__(self, "_chain", chain)
        object.__setattr__(self, "_given", {**given, "fluid": fluid})
        object.__setattr__(self, "_compiled", _core.Rig(core, **given, turning_fluid=fluid == "turning"))
        _check_fluid(place, columns, fluid)

    @property
    def chain(self) -> Chain:
        """The chain by itself."""
        return self._chain

    @property
    def size(self) -> int:
        """Number of links."""
        return self._chain.size

    @property
    def stiffness(self) -> float:
        """Of the spring at the support, force over length; infinite where it is firm."""
        return float(self._given["stiffness"])

    @property
    def carriage_weight(self) -> float:
        """Of what moves sideways with the support."""
        return float(self._given["carriage_weight"])

    @property
    def support_radius(self) -> float:
        """Of the circle in which the support is carried round."""
        return float(self._given["support_radius"])

    @property
    def fluid(self) -> str:
        """``"still"`` or ``"turning"``."""
        return str(self._given["fluid"])

    @property
    def standing(self) -> NDArray[np.bool_]:
        """Which links stand, shape (N,), lowest first; read-only."""
        flags = self._given["standing"]
        return np.broadcast_to(np.False_, self.size) if flags is None else flags

    @property
    def momentum(self) -> Floats:
        """Angular momentum that each link keeps along its axis, shape (N,); read-only."""
        return self._column("momentum", 0.0)

    @property
    def axial_moment(self) -> Floats:
        """Of what turns with each link about its axis, weight times length squared, shape (N,); read-only."""
        return self._column("axial_moment", 0.0)

    @property
    def displaced_weight(self) -> Floats:
        """Of the fluid that each link displaces, shape (N,); read-only."""
        return self._column("displaced_weight", 0.0)

    @property
    def displaced_centroid(self) -> Floats:
        """Of that fluid, from the upper pin, shape (N,); read-only."""
        return self._column("displaced_centroid", self._chain.centroid)

    @property
    def displaced_radius_of_gyration(self) -> Floats:
        """Of that fluid, shape (N,); read-only."""
        return self._column("displaced_radius_of_gyration", self._chain.radius_of_gyration)

    @property
    def added_weight(self) -> Floats:
        """Of still fluid that moves with each link, shape (N,); read-only."""
        return self._column("added_weight", 0.0)

    def _column(self, name: str, otherwise: float | Floats) -> Floats:
        given = self._given[name]
        return np.broadcast_to(np.asarray(otherwise), self.size) if given is None else given

    def __len__(self) -> int:
        return self.size

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Rig):
            return NotImplemented
        return (
            self._chain == other._chain
            and all(getattr(self, name) == getattr(other, name) for name in _NUMBERS)
            and all(np.array_equal(getattr(self, name), getattr(other, name)) for name in ("standing", *_PER_LINK))
        )

    def __hash__(self) -> int:
        return hash((self._chain, *(getattr(self, name) for name in _NUMBERS)))

    def __repr__(self) -> str:
        links = "1 link" if self.size == 1 else f"{self.size:,} links"
        with_what = []
        if math.isfinite(self.stiffness):
            with_what.append(f"support of stiffness {self.stiffness:.6g}")
        if self.carriage_weight:
            with_what.append(f"carriage of weight {self.carriage_weight:.6g}")
        if self.support_radius:
            with_what.append(f"carried round at radius {self.support_radius:.6g}")
        for count, what in (
            (np.count_nonzero(self.standing), "standing"),
            (np.count_nonzero(self.momentum), "with momentum"),
            (np.count_nonzero(self.displaced_weight), f"in {self.fluid} fluid"),
        ):
            if count:
                with_what.append(f"{count:,} link{'s' if count > 1 else ''} {what}")
        return f"Rig of a chain of {links}: {', '.join(with_what) or 'nothing added'}"

    def __reduce__(self) -> tuple[Any, ...]:
        return Rig._from_state, (self._state(),)

    def _state(self) -> tuple[Any, ...]:
        """All it is made of."""
        return self._chain, {name: value for name, value in self._given.items() if value is not None}

    @classmethod
    def _from_state(cls, state: tuple[Any, ...]) -> Rig:
        chain, given = state
        return cls(chain, **given)


_NUMBERS = ("stiffness", "carriage_weight", "support_radius", "fluid")


def free_flywheel(
    *, weight: ArrayLike, radius_of_gyration: ArrayLike, spin: ArrayLike, gravity: float = STANDARD_GRAVITY
) -> dict[str, Floats]:
    """What a wheel on free bearings brings to a `Rig`: the angular momentum it keeps.

    Parameters
    ----------
    weight, radius_of_gyration : array_like
        Of the wheel, the latter about its axis, along the link; not negative.
    spin : array_like
        In rad/s about the link's axis as seen from outside, not from the link; positive where a hanging
        link's wheel turns in the sense of a positive speed.
    gravity : float
        What `weight` is under; standard gravity, in m/s^2, if left out.

    Returns
    -------
    dict
        ``momentum``, broadcast: ``rc.Rig(chain, **rc.free_flywheel(...))``. The wheel's weight, and its
        inertia across its axis, belong to the link's own numbers.

    Raises
    ------
    ValueError
        For numbers that are not finite or negative where they must not be.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.free_flywheel(weight=9.80665, radius_of_gyration=0.3, spin=100.0)["momentum"])
    9.0
    """
    return {"momentum": _wheel("revchain.free_flywheel", weight, radius_of_gyration, spin, gravity)[0]}


def driven_flywheel(
    *, weight: ArrayLike, radius_of_gyration: ArrayLike, spin: ArrayLike, gravity: float = STANDARD_GRAVITY
) -> dict[str, Floats]:
    """What a wheel turned by a motor brings to a `Rig`: its spin is relative to a link that turns with the whole.

    Parameters
    ----------
    weight, radius_of_gyration, spin, gravity
        As for `free_flywheel`, but for `spin`, which is seen from the link.

    Returns
    -------
    dict
        ``momentum`` and ``axial_moment``, broadcast.

    Raises
    ------
    ValueError
        As `free_flywheel`.

    Examples
    --------
    >>> import revchain as rc
    >>> {name: float(x) for name, x in rc.driven_flywheel(weight=9.80665, radius_of_gyration=0.3, spin=100.0).items()}
    {'momentum': 9.0, 'axial_moment': 0.8825985}
    """
    momentum, moment = _wheel("revchain.driven_flywheel", weight, radius_of_gyration, spin, gravity)
    return {"momentum": momentum, "axial_moment": moment}


def _wheel(place: str, weight: ArrayLike, radius: ArrayLike, spin: ArrayLike, gravity: float) -> list[Floats]:
    """Angular momentum and axial moment."""
    given = {"weight": weight, "radius_of_gyration": radius, "spin": spin}
    arrays = {name: floats(place, name, value) for name, value in given.items()}
    for name, array in arrays.items():
        refuse_where(~np.isfinite(array), array, f"{place}: {name} must be finite")
        if name != "spin":
            refuse_where(array < 0, array, f"{place}: {name} must not be negative")
    w, k, turns, g = together(place, **arrays, gravity=positive(place, "gravity", gravity))
    with np.errstate(over="ignore", invalid="ignore"):
        moment = np.asarray(w * k * k)
        momentum = np.asarray(moment / g * turns)
    refuse_where(
        ~(np.isfinite(moment) & np.isfinite(momentum)),
        k,
        f"{place}: weight * radius_of_gyration**2 * spin / gravity must be finite, give a smaller radius_of_gyration",
    )
    return list(numbers([momentum, moment]))


def _flags(place: str, value: ArrayLike, size: int) -> NDArray[np.bool_] | None:
    flags = array_of(value)
    if flags.dtype != np.bool_ or flags.ndim > 1 or (flags.ndim == 1 and flags.size != size):
        raise ValueError(
            f"{place}: standing must be True, False or an array of them, one for each of the {size} links, "
            f"got {shown(value)}"
        )
    return read_only(np.ascontiguousarray(np.broadcast_to(flags, size))) if flags.any() else None


def _column(place: str, name: str, value: ArrayLike | None, size: int) -> Floats | None:
    if value is None:
        return None
    column = floats(place, name, value)
    if column.ndim > 1 or (column.ndim == 1 and column.size != size):
        raise ValueError(
            f"{place}: {name} must be a number or an array with one for each of the {size} links, "
            f"got shape {column.shape}"
        )
    if not column.any() and name not in ("displaced_centroid", "displaced_radius_of_gyration"):
        return None
    return read_only(np.ascontiguousarray(np.broadcast_to(column, size)))


def _check_fluid(place: str, columns: dict[str, Any], fluid: str) -> None:
    """Refuse what is not looked at further on: places of fluid where there is none, still fluid in fluid that turns."""
    middle, radius, added = (columns[name] for name in _PER_LINK[3:])
    if middle is not None:
        _refuse_link(place, ~np.isfinite(middle), middle, "displaced_centroid must be finite")
    if radius is not None:
        wrong = ~(np.isfinite(radius) & (radius >= 0))
        _refuse_link(place, wrong, radius, "displaced_radius_of_gyration must be finite and not negative")
    if added is not None and fluid == "turning":
        _refuse_link(place, added > 0, added, "fluid that turns with the chain has no added_weight")


def _refuse_link(place: str, wrong: NDArray[np.bool_], column: Floats, sentence: str) -> None:
    if wrong.any():
        link = int(np.argmax(wrong))
        raise ValueError(f"{place}: link {link + 1}: {sentence}, got {column[link]:g}")


def base_chain(hung: Chain | Rig) -> Chain:
    """The chain by itself."""
    return hung.chain if isinstance(hung, Rig) else hung
