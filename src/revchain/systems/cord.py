# SPDX-License-Identifier: GPL-3.0-or-later
"""The continuous limit: a perfectly flexible cord."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .chain import Chain
from .numbers import Floats, floats, mass_or_weight, one_positive, positive, real, shown
from .system import System

Density = float | Callable[[float], float]
Measured = TypeVar("Measured")
_MOST_LENGTHS = 1e5  # of the cord, for the size of a bob: the nodes of larger ones are lost in rounding


class CordData(NamedTuple):
    """The data of a cord; masses or weights."""

    length: float
    weight: float
    tip: float
    density: Any  # the exponent, or the state of a function
    by_mass: bool
    particles: tuple[tuple[float, float], ...]  # places, from the free end, and masses
    tip_centroid: float
    tip_radius_of_gyration: float


class Cord(System):
    """A perfectly flexible cord hung from one end: the limit of a chain of many short links.

    Parameters
    ----------
    length : float
        Length of the cord, m, positive.
    mass, weight : float, optional
        Mass (kg) or weight (N) of the cord without tip and point masses. If left out, it is the integral of a `density`
        given as a function, else 1.
    density : float or callable
        Distribution of the mass over the distance s from the free end. A number p above -1, at most 1e4, means ``s**p``
        (0: uniform, 1: thicker towards the support). A function of s must be positive inside the cord; it may have jumps and
        corners, and vanish or grow as a power at the free end. If `mass` or `weight` is given, the function is scaled to
        it; else it is the mass per length, kg/m (with `tip_weight` or `weights`, the weight per length).
    tip_mass, tip_weight : float, optional
        Mass (kg) or weight (N) of a point mass or bob at the free end, in the same quantity as the cord.
    masses, weights : mapping of float to float, optional
        Point masses on the cord, such as clasps, kg, or their weights, N: ``{s: mass}`` with s the distance from the free
        end, m, or ``{"50 cm": "20 g"}``. Not part of `mass`.
    breaks : array_like, shape (B,), optional
        Distances from the free end, m, at which a density function jumps or has a corner; for a narrow part, its ends.
    tip_centroid, tip_radius_of_gyration : float, optional
        For a bob that turns about the end of the cord: distance of its centre of gravity below that end, m, and its radius
        of gyration about its centre of gravity, m. `modes` and `count_modes` take such a cord; for shapes use `chain`.

    Raises
    ------
    ValueError
        If a number is out of its range, the arguments do not go together, or a density function is not positive inside
        the cord or cannot be resolved.

    Notes
    -----
    A function is stored as piecewise polynomials, to 1e-14 of its largest value on each piece, with an estimate of the
    error of its integral, which the error bounds of the results include. Cost: 15 microseconds; with a smooth function
    0.2 ms. Source: Greenhill (1908), section 4; a bob: J. S. Deschaine and B. H. Suits, Eur. J. Phys. 29, 1211 (2008).

    Examples
    --------
    >>> import revchain as rc
    >>> cord = rc.Cord(0.36, mass=0.2)
    >>> rc.modes(cord, 3).angular_speed.round(4)
    array([ 6.2757, 14.4054, 22.583 ])
    >>> rc.Cord(2.0, mass=0.5, density=1.0, tip_mass=3.0)
    Cord of length 2, mass 0.5, density as s^1, tip 3

    A clasp of 0.3 kg on a cord, and a bob of finite size at the end of another:

    >>> rc.modes(rc.Cord(1.8, mass=0.018, masses={1.2: 0.3}, tip_mass=0.05), 2).angular_speed.round(4)
    array([2.7332, 4.6992])
    >>> bob = rc.Cord(1.5, mass=0.05, tip_mass=0.2, tip_centroid=0.02, tip_radius_of_gyration=0.03)
    >>> rc.modes(bob, 3, gravity=9.81).angular_speed.round(6)
    array([ 2.587687, 14.325582, 17.928121])
    """

    __slots__ = {
        "_compiled": None,
        "_function": None,
        "_bob": None,
        "_particles": None,
        "by_mass": "Whether the cord was given by mass, not by weight.",
    }
    _compiled: _core.Cord
    _function: _core.LineDensity | float
    _particles: dict[float, float]
    _bob: tuple[float, float]
    by_mass: bool

    def __init__(
        self,
        length: float,
        *,
        mass: float | None = None,
        weight: float | None = None,
        density: Density = 0.0,
        tip_mass: float | None = None,
        tip_weight: float | None = None,
        masses: Mapping[float, float] | None = None,
        weights: Mapping[float, float] | None = None,
        breaks: ArrayLike | None = None,
        tip_centroid: float = 0.0,
        tip_radius_of_gyration: float = 0.0,
    ) -> None:
        caller = "revchain.Cord"
        long = one_positive(caller, "length", length)
        by_mass = weight is None and tip_weight is None and weights is None
        if mass is not None or weight is not None:
            by_mass, heavy = mass_or_weight(caller, mass, weight)
            total = one_positive(caller, "mass" if by_mass else "weight", heavy)
        else:
            total = None
        other = {"tip_weight": tip_weight, "weights": weights} if by_mass else {"tip_mass": tip_mass, "masses": masses}
        for name, value in other.items():
            if value is not None:
                wanted = name.replace(*(("weight", "mass") if by_mass else ("mass", "weight")))
                wanted = {"weights": "masses", "masses": "weights"}.get(name, wanted)
                raise ValueError(f"{caller}: give {wanted} for a cord given by {'mass' if by_mass else 'weight'}")
        tip = tip_mass if by_mass else tip_weight
        hung = 0.0 if tip is None else _not_negative(caller, "tip_mass" if by_mass else "tip_weight", tip)
        particles = _particles(caller, "masses" if by_mass else "weights", masses if by_mass else weights, long)
        bob = (
            _not_negative(caller, "tip_centroid", tip_centroid),
            _not_negative(caller, "tip_radius_of_gyration", tip_radius_of_gyration),
        )
        for name, size in zip(("tip_centroid", "tip_radius_of_gyration"), bob, strict=True):
            if size > _MOST_LENGTHS * long:
                why = f"must be at most {_MOST_LENGTHS:g} lengths of the cord (use a Chain)"
                raise ValueError(f"{caller}: {name} {why}, got {size:g}")
        if bob[1] and not bob[0]:
            raise ValueError(
                f"{caller}: tip_radius_of_gyration needs a tip_centroid above 0 beside it (a bob hung at its centre of gravity "
                f"has nothing that turns it back), got {bob[1]:g}"
            )
        if bob[0] and not hung:
            raise ValueError(f"{caller}: tip_centroid needs a tip_{'mass' if by_mass else 'weight'} above 0 beside it")
        function: _core.LineDensity | float
        if breaks is not None and not callable(density):
            raise ValueError(
                f"{caller}: breaks are for a density that is a function; leave them out, got {shown(breaks)} beside density {density}"
            )
        if isinstance(density, _core.LineDensity):
            function = density
        elif callable(density):
            function = _core.LineDensity(_checked(caller, density), long, _breaks(caller, breaks, long))
        else:
            function = real(caller, "density (the exponent, or a function of the distance from the free end)", density)
        self._set(long, total, hung, function, by_mass, particles, bob)

    def _set(
        self,
        length: float,
        total: float | None,
        tip: float,
        density: _core.LineDensity | float,
        by_mass: bool,
        particles: dict[float, float],
        bob: tuple[float, float],
    ) -> None:
        _set(self, "_compiled", _core.Cord(length, total, density, tip, dict[Any, Any](particles), *bob))
        _set(self, "_function", density)
        _set(self, "_particles", particles)
        _set(self, "_bob", bob)
        _set(self, "by_mass", by_mass)

    @property
    def length(self) -> float:
        """The length of the cord, m."""
        return self._compiled.length

    @property
    def mass(self) -> float:
        """Mass of the cord without tip and point masses, kg; an AttributeError if the cord was given by weight."""
        return self._measured("mass", self._compiled.weight)

    @property
    def weight(self) -> float:
        """Weight of the cord without tip and point masses; an AttributeError if the cord was given by mass."""
        return self._measured("weight", self._compiled.weight)

    @property
    def tip_mass(self) -> float:
        """Mass of the point mass at the free end, kg; an AttributeError if the cord was given by weight."""
        return self._measured("tip_mass", self._compiled.tip_weight)

    @property
    def tip_weight(self) -> float:
        """Weight of the point mass at the free end; an AttributeError if the cord was given by mass."""
        return self._measured("tip_weight", self._compiled.tip_weight)

    @property
    def masses(self) -> dict[float, float]:
        """Point masses on the cord, kg, by their distances from the free end; an AttributeError if given by weight."""
        return dict(self._measured("masses", self._particles))

    @property
    def weights(self) -> dict[float, float]:
        """Weights of the point masses on the cord by distance from the free end; an AttributeError if given by mass."""
        return dict(self._measured("weights", self._particles))

    @property
    def tip_centroid(self) -> float:
        """Distance of the bob's centre of gravity below the end of the cord, m; 0 for a point mass."""
        return self._bob[0]

    @property
    def tip_radius_of_gyration(self) -> float:
        """Radius of gyration of the bob about its centre of gravity, m; 0 for a point mass."""
        return self._bob[1]

    @property
    def density(self) -> Density:
        """Exponent of the density, or the function as stored (piecewise polynomials)."""
        return self._function

    def chain(self, count: int) -> Chain:
        """Return the cord as a chain of straight links of equal length; its density must be a power.

        Parameters
        ----------
        count : int
            Number of links, at least 1.

        Returns
        -------
        Chain
            A chain with tip and point masses fixed to its links. A bob is one link more, the lowest, with its centre of
            gravity at half its length.

        Raises
        ------
        ValueError
            If `count` is out of its range, or the density was given as a function.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Cord(2.0, mass=1.0).chain(4).length
        array([0.5, 0.5, 0.5, 0.5])
        """
        if not isinstance(self._function, float):
            raise ValueError("revchain.Cord.chain: the density must be a power, got a function")
        name = "mass" if self.by_mass else "weight"
        whole: dict[str, Any] = {"length": self.length, name: self._compiled.weight}
        if self._function == 0:
            made = Chain.uniform_rods(count, **whole)
        else:
            made = Chain.tapered(count, **whole, exponent=self._function)
        if self._particles:
            made = _carrying(made, name, self._particles, self.length)
        if self._bob[0]:
            return _with_bob(made, name, self._compiled.tip_weight, *self._bob)
        return made.with_body(**_named(name, self._compiled.tip_weight)) if self._compiled.tip_weight else made

    def _measured(self, name: str, number: Measured) -> Measured:
        if ("mass" in name) != self.by_mass:
            raise AttributeError(f"this cord was given by {'mass' if self.by_mass else 'weight'}: it has no {name}")
        return number

    def _words(self) -> list[str]:
        unit = "kg" if self.by_mass else "N"
        tip = [f"tip: {self._compiled.tip_weight:.6g} {unit}"] if self._compiled.tip_weight else []
        if self._bob[0]:
            tip = [
                f"bob: {self._compiled.tip_weight:.6g} {unit}, {self._bob[0]:.6g} m below the end, "
                f"radius of gyration {self._bob[1]:.6g} m"
            ]
        carried = [f"at {s:.6g} m: {x:.6g} {unit}" for s, x in reversed(self._particles.items())]
        whole = f"{self._spread()} cord: {self._compiled.weight:.6g} {unit}, {self.length:.6g} m"
        return ["support: firm", whole, *carried, *tip]

    def _spread(self) -> str:
        if not isinstance(self._function, float):
            return "uneven"
        return f"tapered (s^{self._function:g})" if self._function else "uniform"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Cord):
            return NotImplemented
        return self.by_mass == other.by_mass and _alike(self._state(), other._state())

    def __hash__(self) -> int:
        return hash((self.length, self._compiled.weight, self._compiled.tip_weight, *self._particles.items(), *self._bob))

    def __repr__(self) -> str:
        heavy = f"{'mass' if self.by_mass else 'weight'} {self._compiled.weight:.6g}"
        spread = "density as a function" if not isinstance(self._function, float) else f"density as s^{self._function:g}"
        tip = f", {'bob' if self._bob[0] else 'tip'} {self._compiled.tip_weight:.6g}" if self._compiled.tip_weight else ""
        if self._particles:
            places = "place" if len(self._particles) == 1 else "places"
            tip = f", carrying {sum(self._particles.values()):.6g} at {len(self._particles)} {places}{tip}"
        return f"Cord of length {self.length:.6g}, {heavy}{', ' + spread if self._function != 0.0 else ''}{tip}"

    _kind = "cord"
    _is_cord = True

    @property
    def size(self) -> int:
        """Number of links: 0 for a cord."""
        return 0

    @property
    def mode_count(self) -> None:
        """Number of modes: None, as a cord has infinitely many."""
        return None

    def _under(self, gravity: float) -> _core.Cord:
        return self._compiled

    @property
    def _whole_length(self) -> float:
        """Length of the whole system, m."""
        return self.length

    @property
    def _total(self) -> float:
        """Mass or weight of cord, tip and point masses, as given."""
        return self._compiled.weight + self._compiled.tip_weight + sum(self._particles.values())

    def _state(self) -> CordData:
        kept = self._function if isinstance(self._function, float) else self._function.__getstate__()
        return CordData(
            self.length,
            self._compiled.weight,
            self._compiled.tip_weight,
            kept,
            self.by_mass,
            tuple(self._particles.items()),
            *self._bob,
        )

    @classmethod
    def _from_state(cls, state: Any) -> Cord:
        data = CordData(*state)
        density = data.density
        if not isinstance(density, float):
            density = _density_of(tuple(data.density))
        cord = cls.__new__(cls)
        bob = data.tip_centroid, data.tip_radius_of_gyration
        cord._set(data.length, data.weight, data.tip, density, data.by_mass, dict(data.particles), bob)
        return cord

    def _data(self) -> dict[str, Any]:
        data = self._state()
        density = data.density if isinstance(data.density, float) else [data.density[0], data.density[1].tolist()]
        heavy, hung, many = _NAMES[data.by_mass]
        found = {"length": data.length, heavy: data.weight, hung: data.tip, "density": density}
        if data.particles:
            found[many] = [list(pair) for pair in data.particles]
        if data.tip_centroid:
            found |= {"tip_centroid": data.tip_centroid, "tip_radius_of_gyration": data.tip_radius_of_gyration}
        return found

    @classmethod
    def _from_data(cls, data: dict[str, Any]) -> Cord:
        caller, (heavy, _, many) = "revchain.Cord.from_dict", _NAMES["mass" in data]
        given = dict(data)
        if many in data:
            pairs = floats(caller, many, data[many])
            if pairs.ndim != 2 or pairs.shape[1] != 2:
                wanted = f"pairs of a distance from the free end and a {heavy}"
                raise ValueError(f"{caller}: {many} must be {wanted}, got {shown(data[many])}")
            given[many] = dict(pairs.tolist())
        if isinstance(density := data.get("density"), list):
            if len(density) != 2:
                wanted = "a number, or the length and the pieces that to_dict writes for a function"
                raise ValueError(f"{caller}: density must be {wanted}, got {shown(density)}")
            state = real(caller, "density[0]", density[0]), floats(caller, "density[1]", density[1])
            try:
                given["density"] = _density_of(state)
            except ValueError as error:
                raise ValueError(f"{caller}: density: {str(error).partition(': ')[2]}") from None
        return cls(**given)


_NAMES = {True: ("mass", "tip_mass", "masses"), False: ("weight", "tip_weight", "weights")}


def _density_of(state: tuple[Any, ...]) -> _core.LineDensity:
    """The density function with a state that a pickle or `to_dict` stored."""
    density = _core.LineDensity.__new__(_core.LineDensity)
    density.__setstate__(state)
    return density


def _not_negative(caller: str, name: str, value: object) -> float:
    number = real(caller, name, value)
    if not 0 <= number < math.inf:
        raise ValueError(f"{caller}: {name} must be finite and not negative, got {number:g}")
    return number


def _one(caller: str, name: str, value: object, quantity: str) -> float:
    """One number, in the SI unit of the quantity."""
    return real(caller, name, floats(caller, name, value, quantity))  # type: ignore[arg-type]


def _inside(caller: str, name: str, place: float, length: float) -> float:
    if not _core.LineDensity.least_place * length <= place < length * (1 - 2.0**-40):
        raise ValueError(
            f"{caller}: {name} must lie between the free end and the support, at distances from the free end above 0 and "
            f"below the length, {length:g} (what is at the free end is the tip), got {place:g}"
        )
    return place


def _particles(caller: str, name: str, given: Mapping[float, float] | None, length: float) -> dict[float, float]:
    if given is None:
        return {}
    if not isinstance(given, Mapping):
        why = f"{name} must map distances from the free end to {name}, such as {{0.5: 0.1}}"
        raise ValueError(f"{caller}: {why}, got {shown(given)}")
    found: dict[float, float] = {}
    for at, heavy in given.items():
        place = _inside(caller, f"places of {name}", _one(caller, f"places of {name}", at, "arc_length"), length)
        mass = _one(caller, f"{name}[{place:g}]", heavy, "mass" if name == "masses" else "weight")
        found[place] = found.get(place, 0.0) + _not_negative(caller, f"{name}[{place:g}]", mass)
    return {s: x for s, x in sorted(found.items()) if x}


def _breaks(caller: str, breaks: ArrayLike | None, length: float) -> list[float]:
    if breaks is None:
        return []
    places = np.atleast_1d(positive(caller, "breaks", floats(caller, "breaks", breaks, "arc_length")))
    if places.ndim != 1:
        raise ValueError(f"{caller}: breaks must be a list of distances from the free end, got shape {places.shape}")
    return [_inside(caller, "breaks", float(s), length) for s in places]


def _carrying(chain: Chain, name: str, particles: Mapping[float, float], length: float) -> Chain:
    """The chain of equal links with particles fixed to them."""
    long, count = length / chain.size, chain.size
    heavy: Floats = np.array(np.broadcast_to(getattr(chain, name), count), np.float64)
    centroid = np.array(np.broadcast_to(chain.centroid, count))
    second = heavy * (np.broadcast_to(chain.radius_of_gyration, count) ** 2 + centroid**2)  # about the upper pins
    first = heavy * centroid
    for s, x in particles.items():
        link = min(int(s / long), count - 1)
        below = (link + 1) * long - s
        heavy[link] += x
        first[link] += x * below
        second[link] += x * below**2
    centroid = first / heavy
    gyration = np.sqrt(np.maximum(second / heavy - centroid**2, 0.0))
    return Chain(**_named(name, heavy), length=np.full(count, long), centroid=centroid, radius_of_gyration=gyration)


def _with_bob(chain: Chain, name: str, heavy: float, centroid: float, gyration: float) -> Chain:
    """The chain with a body hung from its lower end."""
    count = chain.size
    columns = {name: heavy, "length": 2 * centroid, "centroid": centroid, "radius_of_gyration": gyration}
    return Chain(
        **{key: np.append(x, np.broadcast_to(getattr(chain, key), count)) for key, x in columns.items()}  # type: ignore[arg-type]
    )


def _named(name: str, value: Any) -> dict[str, Any]:
    return {name: value}


def _checked(caller: str, density: Callable[[float], float]) -> Callable[[float], float]:
    def checked(s: float) -> float:
        value = density(s)
        return value if type(value) is float else real(caller, f"density({s:g})", value)

    return checked


def _alike(one: Any, other: Any) -> bool:
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(_alike, one, other))
    return bool((one == other).all()) if hasattr(one, "all") and hasattr(other, "all") else bool(one == other)


_set = object.__setattr__
