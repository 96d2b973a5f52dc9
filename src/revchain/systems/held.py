# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and cords whose two ends are held on the axis: troposkien blades, skipping ropes, strings of weights."""

from __future__ import annotations

from typing import Any

from .. import _core
from .chain import Chain
from .cord import Cord
from .numbers import boolean, one_positive, shown
from .system import System, from_data


class Held(System):
    """A chain or a cord whose two ends are held on the axis: troposkien blade, skipping rope, string of weights.

    Parameters
    ----------
    system : Chain or Cord
        Its free end is the lower end, held too. A cord must be uniform and without a tip.
    span : float
        Distance of the two ends along the axis, m, positive, less than the length.
    tension : float
        Instead of `span`: the tension at the upper end, in N (for a system given by weight in the unit of the
        weights), positive.
    weightless : bool
        Without gravity. A system given by weight is then taken to have those numbers as masses.

    Raises
    ------
    ValueError
        Unless exactly one of `span` and `tension` is given, for numbers out of their range, a span that is not less
        than the length, a cord that is not uniform.
    TypeError
        If `system` is neither a `Chain` nor a `Cord`.

    Notes
    -----
    A span is the question of `steady_shapes`: the chain is bent at every speed. Under a tension that exceeds its weight
    it can also hang straight, with the speeds of `modes`; without gravity under any tension.

    Examples
    --------
    A blade of 40 rods, 10 m long, on a mast of 8 m:

    >>> import revchain as rc
    >>> blade = rc.Held(rc.Chain.uniform_rods(40, length=10.0, mass=60.0), span=8.0)
    >>> shape = rc.steady_shapes(blade, angular_speed=12.0)[0]
    >>> round(float(shape.offset.max()), 4)
    2.7383
    """

    __slots__ = ("span", "system", "tension", "weightless")
    system: Chain | Cord
    span: float | None
    tension: float | None
    weightless: bool

    def __init__(
        self,
        system: Chain | Cord,
        *,
        span: float | None = None,
        tension: float | None = None,
        weightless: bool = False,
    ) -> None:
        place = "revchain.Held"
        if not isinstance(system, Chain | Cord):
            raise TypeError(f"{place}: system must be a revchain.Chain or Cord, got {shown(system)}")
        if (span is None) == (tension is None):
            raise ValueError(f"{place}: give exactly one of span and tension")
        _set(self, "system", system)
        _set(self, "span", None if span is None else one_positive(place, "span", span))
        _set(self, "tension", None if tension is None else one_positive(place, "tension", tension))
        _set(self, "weightless", boolean(place, "weightless", weightless))
        if self.span is not None and not self.span < self.length:
            raise ValueError(f"{place}: span must be less than the length {self.length:.6g}, got {self.span:g}")
        if isinstance(system, Cord) and (system.density != 0.0 or system._compiled.tip_weight):
            raise ValueError(
                f"{place}: a held cord must be uniform and without a tip; for another cut it into links: cord.chain(100)"
            )

    @property
    def length(self) -> float:
        """Of the chain or cord, m."""
        return self.system.length if isinstance(self.system, Cord) else self.system.total_length

    @property
    def size(self) -> int:
        """Number of links; 0 of a cord."""
        return self.system.size if isinstance(self.system, Chain) else 0

    @property
    def mode_count(self) -> int | None:
        """Number of modes of the straight chain: N - 1 of N links, less one for each free pin without mass; None of a cord."""
        return max(self.system.mode_count - 1, 0) if isinstance(self.system, Chain) else None

    @property
    def by_mass(self) -> bool:  # type: ignore[override]
        """Whether masses were given, not weights."""
        return self.system.by_mass

    @property
    def _total(self) -> float:
        """All that weighs, as it was given."""
        return self.system._compiled.weight if isinstance(self.system, Cord) else self.system._compiled.total_weight

    def _force(self, gravity: float) -> float:
        return 1.0 if self.weightless else self.system._force(gravity)

    def _pull(self, gravity: float) -> float | None:
        """The tension for the compiled system."""
        return None if self.tension is None else self.tension / self._force(gravity)

    def _under(self, gravity: float) -> _core.Held | _core.HeldCord:
        made: Any = _core.Held if isinstance(self.system, Chain) else _core.HeldCord
        held: _core.Held | _core.HeldCord = made(self.system._compiled, self.span, self._pull(gravity), self.weightless)
        return held

    def _words(self) -> list[str]:
        how = f"{self.span:.6g} m apart" if self.span is not None else f"under a tension of {self.tension:.6g} N"
        words = self.system._link_words() if isinstance(self.system, Chain) else self.system._words()[1:]
        return [f"both ends held on the axis, {how}{', without gravity' if self.weightless else ''}", *words]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Held):
            return NotImplemented
        return self._state() == other._state()

    def __hash__(self) -> int:
        return hash(self._state())

    def __repr__(self) -> str:
        system = repr(self.system)
        how = f"span {self.span:.6g}" if self.span is not None else f"tension {self.tension:.6g}"
        return f"Held {system[0].lower()}{system[1:]}: {how}{', weightless' if self.weightless else ''}"

    def _state(self) -> tuple[Any, ...]:
        return self.system, self.span, self.tension, self.weightless

    @classmethod
    def _from_state(cls, state: Any) -> Held:
        system, span, tension, weightless = state
        return cls(system, span=span, tension=tension, weightless=weightless)

    def _data(self) -> dict[str, Any]:
        by = {"span": self.span} if self.span is not None else {"tension": self.tension}
        return {"of": self.system.to_dict(), **by, "weightless": self.weightless}

    @classmethod
    def _from_data(cls, data: dict[str, Any]) -> Held:
        of = from_data(data["of"])
        return cls(of, **{name: value for name, value in data.items() if name != "of"})  # type: ignore[arg-type]


_set = object.__setattr__
