# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and cords held at both ends, on the axis, on arms or on springs: troposkien blades, skipping ropes."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from .. import _core
from .chain import Chain, like
from .cord import Cord
from .numbers import STANDARD_GRAVITY, boolean, one_positive, shown
from .rig import Support
from .system import System, from_data, plain


class Held(System):
    """A chain or a cord whose two ends are held: troposkien blade, skipping rope, string of weights.

    Parameters
    ----------
    system : Chain or Cord
        The chain or cord; its free end becomes the lower end. A cord must be uniform, without tip and point masses.
    span : float
        Distance between the two ends along the axis, m, positive, less than the length.
    tension : float
        Tension at the upper end, instead of `span`; positive, in N or, for a system given by weight, in its unit.
    weightless : bool
        True to leave gravity out. The weights of a system given by weight then count as masses.
    lower, upper : Support, optional
        Support of an end of a chain; a firm point on the axis if left out. Its spring acts across the axis. Both radii lie
        in one plane with the axis; a negative one is on the other side. With a tension both radii must be 0.

    Raises
    ------
    ValueError
        If a number is out of its range, the ends are too far apart, or the arguments do not go together.
    TypeError
        If `system`, `lower`, `upper` or `weightless` is of another class.

    Notes
    -----
    With a span use `steady_shapes`. With a tension `modes` returns the critical speeds of the straight chain. Cost: O(1).
    Source: Greenhill (1908), section 3 for weights on a taut string, section 5 for the cord, section 8 (21) for links.

    Examples
    --------
    A blade of 40 rods, 10 m long, on a mast of 8 m:

    >>> import revchain as rc
    >>> blade = rc.Held(rc.Chain.uniform_rods(40, length=10.0, mass=60.0), span=8.0)
    >>> shape = rc.steady_shapes(blade, angular_speed=12.0)[0]
    >>> round(float(shape.offset.max()), 4)
    2.7383

    The same blade on arms of 0.5 m and 1 m; it can bow outwards or inwards:

    >>> arms = {"lower": rc.Support(radius=0.5), "upper": rc.Support(radius=1.0)}
    >>> shapes = rc.steady_shapes(rc.Held(blade.system, span=8.0, **arms), angular_speed=12.0, budget=0)
    >>> [round(float(shape.offset[20]), 4) for shape in shapes]
    [3.4513, -1.9888]
    """

    __slots__ = {
        "lower": "Support of the lower end.",
        "span": "Distance between the two ends along the axis, m; None if the tension was given.",
        "system": "The chain or cord.",
        "tension": "Tension at the upper end; None if the span was given.",
        "upper": "Support of the upper end.",
        "weightless": "Whether gravity is left out.",
    }
    system: Chain | Cord
    span: float | None
    tension: float | None
    weightless: bool
    lower: Support
    upper: Support

    def __init__(
        self,
        system: Chain | Cord,
        *,
        span: float | None = None,
        tension: float | None = None,
        weightless: bool = False,
        lower: Support | None = None,
        upper: Support | None = None,
    ) -> None:
        caller = "revchain.Held"
        if not isinstance(system, Chain | Cord):
            raise TypeError(f"{caller}: system must be a revchain.Chain or Cord, got {shown(system)}")
        if (span is None) == (tension is None):
            raise ValueError(f"{caller}: give exactly one of span and tension")
        _set(self, "system", system)
        _set(self, "span", None if span is None else one_positive(caller, "span", span))
        _set(self, "tension", None if tension is None else one_positive(caller, "tension", tension))
        _set(self, "weightless", boolean(caller, "weightless", weightless))
        if self.span is not None and not self.span < self.length:
            raise ValueError(f"{caller}: span must be less than the length {self.length:.6g}, got {self.span:g}")
        for name, end in (("lower", lower), ("upper", upper)):
            _set(self, name, Support() if end is None else _checked(f"{caller}: {name}", end, self))
        apart = math.hypot(self.span or 0.0, self.upper.radius - self.lower.radius)
        if self.is_firm and not apart < self.length:
            raise ValueError(
                f"{caller}: the ends must be nearer to each other than the length {self.length:.6g}, got {apart:g}: bring "
                "their radii or the span closer"
            )
        if isinstance(system, Cord) and (system.density != 0.0 or system._compiled.tip_weight or system._particles):
            raise ValueError(
                f"{caller}: a held cord must be uniform, without tip and masses; for another cut it into links: cord.chain(100)"
            )

    @property
    def is_plain(self) -> bool:
        """Whether both ends are firm points on the axis."""
        return self.lower == Support() == self.upper

    @property
    def is_on_axis(self) -> bool:
        """Whether both ends (with springs: their rest positions) are on the axis."""
        return self.lower.radius == self.upper.radius == 0.0

    @property
    def is_planar(self) -> bool:
        """Whether the radius of at least one end is 0."""
        return self.lower.radius == 0.0 or self.upper.radius == 0.0

    @property
    def is_firm(self) -> bool:
        """Whether both ends are firm: neither is on a spring."""
        return math.isinf(self.lower.stiffness) and math.isinf(self.upper.stiffness)

    @property
    def length(self) -> float:
        """Length of the chain or cord, m."""
        return self.system._whole_length

    @property
    def size(self) -> int:
        """Number of links; 0 for a cord."""
        return self.system.size

    @property
    def mode_count(self) -> int | None:
        """Number of modes of the straight chain; None for a cord."""
        if self._is_cord:
            return None
        core: Any = self.system._compiled
        force = 2.0 * core.total_weight  # the number is the same for every tension
        ends = self._ends(STANDARD_GRAVITY) if self.tension is not None else (_FIRM, _FIRM)
        taut = _core.Held(core, None, (force, 1.0), False, *ends)
        return int(_core.count_held_modes(taut, np.asarray(5e-324), STANDARD_GRAVITY))

    @property
    def by_mass(self) -> bool:  # type: ignore[override]
        """Whether masses were given, not weights."""
        return self.system.by_mass

    @property
    def _total(self) -> float:
        """Mass or weight of the whole system, as given."""
        return self.system._total

    def _force(self, gravity: float) -> float:
        return 1.0 if self.weightless else self.system._force(gravity)

    def _force_in_shape(self, gravity: float, conical_height: float, angular_speed: float) -> float:
        """Factor that turns a force of a compiled shape, times the conical height, into a force of the results."""
        return angular_speed**2 if self.weightless else self._force(gravity) / conical_height

    def _pull(self, gravity: float) -> tuple[float, float] | None:
        """Tension, and its unit over that of the compiled system's forces."""
        return None if self.tension is None else (self.tension, self._force(gravity))

    @property
    def _kind(self) -> str:  # type: ignore[override]
        return f"held {self.system._kind}"

    _is_held = True

    @property
    def _is_cord(self) -> bool:  # type: ignore[override]
        return self.system._is_cord

    @property
    def _base(self) -> Chain | Cord:
        return self.system

    @property
    def _fixes_gravity(self) -> str | None:
        return "a system held by a tension in newtons" if self.by_mass or self.weightless else None

    def _under(self, gravity: float) -> _core.Held | _core.HeldCord:
        if isinstance(self.system, Cord):
            return _core.HeldCord(self.system._compiled, self.span, self._pull(gravity), self.weightless)
        return _core.Held(self.system._compiled, self.span, self._pull(gravity), self.weightless, *self._ends(gravity))

    def _between_its_ends(self, system: Chain | Cord, span: float | None, tension: float | None) -> Held:
        """The same ends with another chain or cord, span or tension."""
        ends = {} if system._is_cord else {"lower": self.lower, "upper": self.upper}
        return Held(system, span=span, tension=tension, weightless=self.weightless, **ends)

    def _ends(self, gravity: float) -> tuple[_End, _End]:
        """Stiffness, its unit of force over that of the compiled system, weight and radius of each end."""
        force = self._force(gravity)
        lower, upper = ((end.stiffness, force, end.carriage, end.radius) for end in (self.lower, self.upper))
        return lower, upper

    def _words(self) -> list[str]:
        how = f"{self.span:.6g} m apart" if self.span is not None else f"under a tension of {self.tension:.6g} N"
        if not isinstance(self.system, Chain):
            words = self.system._words()[1:]
        elif self.is_plain:
            words = self.system._link_words()
        else:
            upper, lower = (end._words(self.system._unit) for end in (self.upper, self.lower))
            words = [f"upper end: {upper}", *self.system._link_words(), f"lower end: {lower}"]
        where = " on the axis" if self.is_plain else ""
        return [f"both ends held{where}, {how}{', without gravity' if self.weightless else ''}", *words]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Held):
            return NotImplemented
        return self._parts() == other._parts()

    def __hash__(self) -> int:
        return hash(self._parts())

    def __repr__(self) -> str:
        system = repr(self.system)
        how = f"span {self.span:.6g}" if self.span is not None else f"tension {self.tension:.6g}"
        how += ", weightless" if self.weightless else ""
        ends = (f", {name} {end}" for name, end in (("lower", self.lower), ("upper", self.upper)) if end != Support())
        return f"Held {system[0].lower()}{system[1:]}: {how}{''.join(ends)}"

    def _parts(self) -> tuple[Any, ...]:
        return self.system, self.span, self.tension, self.weightless, self.lower, self.upper

    def _state(self) -> tuple[Any, ...]:
        *rest, lower, upper = self._parts()
        return *rest, dict(lower._given), dict(upper._given)

    @classmethod
    def _from_state(cls, state: Any) -> Held:
        system, span, tension, weightless, lower, upper = state
        ends = {"lower": Support(**lower), "upper": Support(**upper)}
        return cls(system, span=span, tension=tension, weightless=weightless, **ends)

    def _data(self) -> dict[str, Any]:
        by: dict[str, Any] = {"span": self.span} if self.span is not None else {"tension": self.tension}
        for name, end in (("lower", self.lower), ("upper", self.upper)):
            if end != Support():
                by[name] = {key: plain(value) for key, value in end._given.items()}
        return {"of": self.system.to_dict(), **by, "weightless": self.weightless}

    @classmethod
    def _from_data(cls, data: dict[str, Any]) -> Held:
        given = {name: Support(**value) if name in ("lower", "upper") else value for name, value in data.items()}
        return cls(from_data("revchain.Held.from_dict: of", given.pop("of")), **given)  # type: ignore[arg-type]


_End = tuple[float, float, float, float]
_FIRM = (math.inf, 1.0, 0.0, 0.0)


def _checked(caller: str, end: Support, held: Held) -> Support:
    if not isinstance(end, Support):
        raise TypeError(f"{caller} must be a revchain.Support, got {shown(end)}")
    if end == Support():
        return end
    if held._is_cord:
        raise ValueError(
            f"{caller} end of a cord is a firm point on the axis; cut it into links: Held(cord.chain(100), ...), got {end}"
        )
    if held.tension is not None and end.radius:
        raise ValueError(f"{caller} end must be on the axis under a tension; give the span, got radius {end.radius:g}")
    if end.stiffness == 0 or end.damping:
        raise ValueError(f"{caller} end must be firm or on a spring, without a dashpot; give a stiffness, got {end}")
    if end.carriage:
        chain: Any = held.system
        like(caller, chain, end._given.get("mass"), end._given.get("weight"))
    return end


_set = object.__setattr__
