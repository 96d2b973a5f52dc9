# SPDX-License-Identifier: GPL-3.0-or-later
"""The continuous limit: a perfectly flexible cord."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

from .. import _core
from .chain import Chain
from .numbers import mass_or_weight, one_positive, real
from .system import System

Density = float | Callable[[float], float]


class Cord(System):
    """A perfectly flexible cord hung from one end: the limit of a chain of many short links.

    Parameters
    ----------
    length : float
        Length of the cord, m, positive.
    mass, weight : float, optional
        Mass (kg) or weight (N) of the whole cord without its tip. If both are left out, it is the integral of a
        `density` given as a function, else 1 in the unit of the tip.
    density : float or callable
        Distribution of the mass over the distance s from the free end. A number p above -1 means ``s**p`` (0: uniform,
        1: thicker towards the support). A function of s must be positive inside the cord; it may have jumps and
        corners, and at the free end it may vanish or grow as a power. A clasp or another narrow part is found if it is
        at least a thousandth of the length wide; narrower ones may lie between the places where the function is called.
        If `mass` or `weight` is given, the function is scaled to it; else it is the mass per length, kg/m (with
        `tip_weight`, the weight per length).
    tip_mass, tip_weight : float, optional
        Mass (kg) or weight (N) of a point mass at the free end, in the same quantity as the cord.

    Raises
    ------
    ValueError
        If a number is out of its range, masses are mixed with weights, or a density function is not positive inside the
        cord, has too many jumps and corners, or has an integral that cannot be resolved to 1e-6. The last two messages
        name the place; use a `Chain` of many short links for such a cord.

    Notes
    -----
    A power is stored as its exponent. A function is stored as piecewise polynomials, to 1e-14 of its largest value on
    each piece, with an estimate of the error of its integral, which the error bounds of the results include. Cost: 4
    microseconds; with a function 1200 calls of it, and 1500 more for each corner or jump: 0.4 to 2 ms.
    Source: Greenhill (1908), section 4.

    Examples
    --------
    >>> import revchain as rc
    >>> cord = rc.Cord(0.36, mass=0.2)
    >>> rc.modes(cord, 3).angular_speed.round(4)
    array([ 6.2757, 14.4054, 22.583 ])
    >>> rc.Cord(2.0, mass=0.5, density=1.0, tip_mass=3.0)
    Cord of length 2, mass 0.5, density as s^1, tip 3
    """

    __slots__ = {"_compiled": None, "_function": None, "by_mass": "Whether the cord was given by mass, not by weight."}
    _compiled: _core.Cord
    _function: _core.LineDensity | float
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
    ) -> None:
        caller = "revchain.Cord"
        long = one_positive(caller, "length", length)
        by_mass = weight is None and tip_weight is None
        if mass is not None or weight is not None:
            by_mass, heavy = mass_or_weight(caller, mass, weight)
            total = one_positive(caller, "mass" if by_mass else "weight", heavy)
        else:
            total = None
        name, tip = ("tip_mass", tip_mass) if by_mass else ("tip_weight", tip_weight)
        if (tip_weight if by_mass else tip_mass) is not None:
            raise ValueError(f"{caller}: give {name} for a cord given by {'mass' if by_mass else 'weight'}")
        hung = 0.0 if tip is None else real(caller, name, tip)
        if not 0 <= hung < math.inf:
            raise ValueError(f"{caller}: {name} must be finite and not negative, got {hung:g}")
        function: _core.LineDensity | float
        if isinstance(density, _core.LineDensity):
            function = density
        elif callable(density):
            function = _core.LineDensity(_checked(caller, density), long)
        else:
            function = real(caller, "density (the exponent, or a function of the distance from the free end)", density)
        self._set(_core.Cord(long, total, function, hung), function, by_mass)

    def _set(self, compiled: _core.Cord, density: _core.LineDensity | float, by_mass: bool) -> None:
        _set(self, "_compiled", compiled)
        _set(self, "_function", density)
        _set(self, "by_mass", by_mass)

    @property
    def length(self) -> float:
        """The length of the cord, m."""
        return self._compiled.length

    @property
    def mass(self) -> float:
        """Mass without the tip, kg; an AttributeError if the cord was given by weight."""
        return self._measured("mass", self._compiled.weight)

    @property
    def weight(self) -> float:
        """Weight without the tip; an AttributeError if the cord was given by mass."""
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
            A chain with the tip fixed to its free end.

        Raises
        ------
        ValueError
            If `count` is below 1, or the density was given as a function.

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
        return made.with_body(**_named(name, self._compiled.tip_weight)) if self._compiled.tip_weight else made

    def _measured(self, name: str, number: float) -> float:
        if ("mass" in name) != self.by_mass:
            raise AttributeError(f"this cord was given by {'mass' if self.by_mass else 'weight'}: it has no {name}")
        return number

    def _words(self) -> list[str]:
        unit = "kg" if self.by_mass else "N"
        tip = [f"tip: {self._compiled.tip_weight:.6g} {unit}"] if self._compiled.tip_weight else []
        return ["support: firm", f"{self._spread()} cord: {self._compiled.weight:.6g} {unit}, {self.length:.6g} m", *tip]

    def _spread(self) -> str:
        if not isinstance(self._function, float):
            return "uneven"
        return f"tapered (s^{self._function:g})" if self._function else "uniform"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Cord):
            return NotImplemented
        return self.by_mass == other.by_mass and _alike(self._state(), other._state())

    def __hash__(self) -> int:
        return hash((self.length, self._compiled.weight, self._compiled.tip_weight))

    def __repr__(self) -> str:
        heavy = f"{'mass' if self.by_mass else 'weight'} {self._compiled.weight:.6g}"
        spread = "density as a function" if not isinstance(self._function, float) else f"density as s^{self._function:g}"
        tip = f", tip {self._compiled.tip_weight:.6g}" if self._compiled.tip_weight else ""
        return f"Cord of length {self.length:.6g}, {heavy}{', ' + spread if self._function != 0.0 else ''}{tip}"

    _kind = "cord"
    _is_cord = True

    @property
    def size(self) -> int:
        """The number of links, which is 0 for a cord."""
        return 0

    @property
    def mode_count(self) -> None:
        """The number of modes, which is None because a cord has infinitely many."""
        return None

    def _under(self, gravity: float) -> _core.Cord:
        return self._compiled

    @property
    def _whole_length(self) -> float:
        """Length of the whole system, m."""
        return self.length

    @property
    def _total(self) -> float:
        """Mass or weight of cord and tip, as given."""
        return self._compiled.weight + self._compiled.tip_weight

    def _state(self) -> tuple[Any, ...]:
        kept = self._function if isinstance(self._function, float) else self._function.__getstate__()
        return self.length, self._compiled.weight, self._compiled.tip_weight, kept, self.by_mass

    @classmethod
    def _from_state(cls, state: Any) -> Cord:
        length, weight, tip, kept, by_mass = state
        density = kept
        if not isinstance(kept, float):
            density = _core.LineDensity.__new__(_core.LineDensity)
            density.__setstate__(tuple(kept))
        cord = cls.__new__(cls)
        cord._set(_core.Cord(length, weight, density, tip), density, by_mass)
        return cord

    def _data(self) -> dict[str, Any]:
        length, weight, tip, kept, by_mass = self._state()
        density = kept if isinstance(kept, float) else [kept[0], kept[1].tolist()]
        heavy, hung = ("mass", "tip_mass") if by_mass else ("weight", "tip_weight")
        return {"length": length, heavy: weight, hung: tip, "density": density}

    @classmethod
    def _from_data(cls, data: dict[str, Any]) -> Cord:
        if not isinstance(data.get("density"), list):
            return cls(**data)
        by_mass = "mass" in data
        heavy, hung = ("mass", "tip_mass") if by_mass else ("weight", "tip_weight")
        return cls._from_state((data["length"], data[heavy], data.get(hung, 0.0), data["density"], by_mass))


def _named(name: str, value: float) -> dict[str, Any]:
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
