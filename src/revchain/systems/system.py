# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of the systems: immutable values that can be compared, pickled, described and written as data."""

from __future__ import annotations

from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray

from .drawing import Plot
from .unchangeable import Unchangeable


class System(Unchangeable):
    """The base of `Chain`, `Rig`, `Cord` and `Held`."""

    __slots__ = ()
    plot = Plot()
    by_mass: bool
    _is_held = False  # whether both ends are held
    _is_cord = False  # whether there are no links
    _support: Any = None  # the support of a rig
    _fluid: str | None = None  # the kind of fluid if something floats in it
    has_momentum: bool = False  # whether a flywheel has angular momentum of its own
    _kind: str  # "chain", "rig", "cord", "held chain" or "held cord": questions choose their method by it
    _kinds: ClassVar[dict[str, type[System]]] = {}

    def __init_subclass__(cls, **given: Any) -> None:
        super().__init_subclass__(**given)
        if cls.__module__.startswith("revchain."):
            System._kinds[cls.__name__] = cls

    @property
    def _base(self) -> Any:
        """The chain or cord in the system, which is the system itself for a plain one."""
        return self

    @property
    def _listed(self) -> slice:
        """The slice that turns arrays by link into the caller's order, and back."""
        return slice(None, None, -1 if getattr(self._base, "order", "") == "support first" else 1)

    @property
    def _link_numbers(self) -> NDArray[np.int64]:
        """Index of each link, lowest first, in the caller's order."""
        return np.arange(self._base.size)[self._listed]

    @property
    def _listed_names(self) -> tuple[str, ...]:
        """Names of the links in the caller's order; empty if they have none."""
        names: tuple[str, ...] | None = getattr(self._base, "names", None)
        return names[self._listed] if names else ()

    @property
    def _stands(self) -> NDArray[np.bool_]:
        """Whether each link is inverted; one False for a cord."""
        return np.zeros(max(self._base.size, 1), bool)

    def _momentum(self, gravity: float) -> Any:
        """Constant angular momentum of each link, divided by gravity for a system given by mass."""
        return np.zeros(self._base.size)

    @property
    def _wheels(self) -> NDArray[np.bool_]:
        """Whether each link has a flywheel, which may be at rest."""
        return np.zeros(self._base.size, bool)

    @property
    def size(self) -> int:
        """Number of links; 0 for a cord."""
        raise NotImplementedError

    @property
    def mode_count(self) -> int | None:
        """Number of modes; None for a cord and for a rig."""
        raise NotImplementedError

    def _under(self, gravity: float) -> Any:
        """The compiled system. If given by mass, it takes masses as weights, and forces divided by gravity."""
        raise NotImplementedError

    def _force(self, gravity: float) -> float:
        """Factor that turns a force of the compiled system into a force of the results."""
        return gravity if self.by_mass else 1.0

    @property
    def _fixes_gravity(self) -> str | None:
        """Words for the system if the heights of its modes depend on gravity, else None."""
        return None

    def _force_in_shape(self, gravity: float, conical_height: float, angular_speed: float) -> float:
        """Factor that turns a force of a compiled steady shape into a force of the results."""
        return self._force(gravity)

    def _momentum_of_wheels(self, gravity: float, inclination: Any) -> float:
        """Angular momentum of flywheels about the axis while the links are inclined."""
        return 0.0

    def _state(self) -> tuple[Any, ...]:
        """The numbers, words, arrays and systems that make up the system."""
        raise NotImplementedError

    @classmethod
    def _from_state(cls, state: Any) -> Self:
        raise NotImplementedError

    def _pin_name(self, pin: int) -> str:
        """Name of a pin for legends and tables; of an inner pin with the name of the link whose lower end it is."""
        last = self.size
        if self._is_held and pin in (0, last) and last:
            return "lower end" if pin == 0 else "upper end"
        if not last:  # a cord
            return f"point {pin}" if pin else "lower end" if self._is_held else "free end"
        if pin == last:
            return "support"
        names = self._base.names
        name = names[pin] if names is not None else ""
        if pin == 0:
            return f"free end of {name}" if name else "free end"
        return f"pin {pin}, {'above' if not self._is_held and self._stands[pin] else 'below'} {name}" if name else f"pin {pin}"

    def _link_name(self, link: int) -> str:
        """Name of a link for legends and tables, with its number in the caller's order."""
        names = getattr(self._base, "names", None) or ()
        name = names[link] if link < len(names) else ""
        number = self._link_numbers[link]
        return f"link {number}, {name}" if name else f"link {number}"

    def describe(self) -> str:
        """Return a description of the system in words, from the support down.

        Returns
        -------
        str
            The description, in kilograms or, for a system given by weight, in newtons.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Chain(mass=[2500.0, 400.0], length=[6.0, 24.0], names=["load", "hook block"]).describe()
        'support: firm; hook block: 400 kg on 24 m; load: 2500 kg on 6 m'
        """
        return "; ".join(self._words())

    def _words(self) -> list[str]:
        raise NotImplementedError

    def to_dict(self) -> dict[str, Any]:
        """Return the system as plain Python data, which `from_dict` reads.

        Returns
        -------
        dict
            The data, which can be written as JSON.

        Examples
        --------
        >>> import revchain as rc
        >>> chain = rc.Chain(mass=[1.0, 3.0], length=1.0)
        >>> rc.Chain.from_dict(chain.to_dict()) == chain
        True
        """
        return {"system": type(self).__name__, **self._data()}

    @classmethod
    def from_dict(cls, data: dict[str, Any]) -> Self:
        """Return the system from the data that `to_dict` returned.

        Parameters
        ----------
        data : dict
            Data that `to_dict` returned.

        Returns
        -------
        Chain, Rig, Cord or Held
            The system.

        Raises
        ------
        ValueError
            If the data do not describe a system of that class.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Cord.from_dict({"system": "Cord", "length": 2.0, "mass": 0.5})
        Cord of length 2, mass 0.5
        """
        caller = f"revchain.{cls.__name__}.from_dict"
        name = data.get("system") if isinstance(data, dict) else None
        if name != cls.__name__:
            raise ValueError(f'{caller}: data must have "system": "{cls.__name__}", got {name!r}')
        try:
            return cls._from_data({key: value for key, value in data.items() if key != "system"})
        except (KeyError, TypeError) as error:
            raise ValueError(f"{caller}: these are not data of a {cls.__name__}: {error}") from None

    def _data(self) -> dict[str, Any]:
        raise NotImplementedError

    @classmethod
    def _from_data(cls, data: dict[str, Any]) -> Self:
        return cls(**data)

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (type(self).__name__, self._state())

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def _repr_html_(self) -> str:
        from html import escape

        rows = "".join(f"<tr><td>{escape(part)}</td></tr>" for part in self._words())
        return f"<table><caption>{escape(repr(self))}</caption><tbody>{rows}</tbody></table>"


def restored(kind: str, state: Any) -> System:
    """Return a system from the name of its class and its state, as a pickle stores them."""
    return System._kinds[kind]._from_state(state)


def from_data(caller: str, data: dict[str, Any]) -> System:
    """A system of any kind from the data that `to_dict` returned."""
    kind = System._kinds.get(data.get("system", "")) if isinstance(data, dict) else None
    if kind is None:
        raise ValueError(f'{caller} must have "system": one of {", ".join(System._kinds)}')
    return kind.from_dict(data)


def plain(value: Any) -> Any:
    """`value` in plain Python: arrays as lists, numpy's numbers as Python's."""
    return value.tolist() if hasattr(value, "tolist") else value


_set = object.__setattr__
