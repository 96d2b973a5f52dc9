# SPDX-License-Identifier: GPL-3.0-or-later
"""The chain as users hold it: an immutable value around the compiled one."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from typing import Any, Literal, Never

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .numbers import Floats, floats, integer, link_arrays, mass_or_weight, real, refuse_beyond_memory, shown, without_function, word
from .numbers import count as checked_count
from .system import System

Order = Literal["free end first", "support first"]
_FREE_END: Literal["free end first"] = "free end first"
_ORDERS = (_FREE_END, "support first")
_GROUPS = 6  # of equal links that are described in words


class Chain(System):
    """A chain of rigid links that hangs from a support, listed from the free end up.

    Give each quantity as one number, or as an array with one number for each link. Without an array the chain has one
    link. With only mass and length a link is a point mass on a massless thread (plummet). With `centroid` and an inertia
    it is a rigid body. Numbers are in SI units. Text with a unit (``"39 inch"``) and pint quantities are converted.

    Parameters
    ----------
    mass : array_like, shape (N,) or scalar
        Mass of each link, kg, not negative. A link of mass 0 is a massless thread; the lowest link must have mass.
    weight : array_like, shape (N,) or scalar
        Weight of each link, instead of `mass`. Forces in results are in its unit; with `mass` they are in newtons.
    length : array_like, shape (N,) or scalar
        Distance between the pins of each link, m, positive.
    centroid : array_like, shape (N,) or scalar, optional
        Distance of the centre of gravity below the *upper* pin, m; negative if it lies above the pin.
    pendulum_length : array_like, shape (N,) or scalar, optional
        Length of the equivalent simple pendulum about the upper pin, m.
    radius_of_gyration : array_like, shape (N,) or scalar, optional
        Radius of gyration about the centre of gravity, m, instead of `pendulum_length`.
    order : {"free end first", "support first"}
        Order of the links in the arrays you give. Indices in paths (``links[0].mass``) and tables count in this order.
        Arrays of results, and of flywheels and other fittings, begin at the free end.
    names : sequence of str, optional
        A name for each link, in the order given, for paths, reports and pictures.

    Raises
    ------
    TypeError
        If a quantity is given without its name, or no length is given.
    ValueError
        If a number is out of its range, a link would be inverted, arrays differ in length, or the arguments do not go
        together.

    Notes
    -----
    Cost: O(N), when the chain is made.

    References
    ----------
    Greenhill (1908), section 8 (1)-(5).

    Examples
    --------
    A bell (upper link) and its clapper (lower link):

    >>> import revchain as rc
    >>> rc.Chain(mass=[180, 5000], length=[0.7, 0.15], centroid=[0.55, 0.05],
    ...          radius_of_gyration=[0.2, 0.36])
    Chain of 2 links, length 0.85, mass 5180
    >>> rc.Chain(mass=[1.0, 2.0], length=["30 cm", "1 ft"], order="support first").length
    array([0.3048, 0.3   ])
    """

    __slots__ = {
        "_compiled": None,
        "_names": None,
        "by_mass": "Whether the chain was given by mass, not by weight.",
        "order": "Order in which the links were listed: ``'free end first'`` or ``'support first'``.",
    }
    _compiled: _core.Chain
    _names: tuple[str, ...] | None
    by_mass: bool
    order: Order

    def __init__(
        self,
        *unnamed: Never,
        mass: ArrayLike | None = None,
        weight: ArrayLike | None = None,
        length: ArrayLike | None = None,
        centroid: ArrayLike | None = None,
        pendulum_length: ArrayLike | None = None,
        radius_of_gyration: ArrayLike | None = None,
        order: Order = "free end first",
        names: Sequence[str] | None = None,
    ) -> None:
        caller = "revchain.Chain"
        if unnamed or length is None:
            found = ", ".join(map(shown, unnamed))
            wrong = f"numbers without a name: {found}" if unnamed else "no length"
            raise TypeError(f"{caller}: give quantities by name, such as Chain(mass=[1, 3], length=[0.5, 0.5]), got {wrong}")
        by_mass, _ = mass_or_weight(caller, mass, weight)
        columns = link_arrays(
            caller,
            mass=mass,
            weight=weight,
            length=length,
            centroid=centroid,
            pendulum_length=pendulum_length,
            radius_of_gyration=radius_of_gyration,
        )
        _check_shapes(columns)
        if order is not _FREE_END and word(caller, "order", order, _ORDERS) == "support first":
            columns = {name: column[::-1] if column.ndim else column for name, column in columns.items()}
        if by_mass:
            columns["weight"] = columns.pop("mass")
        try:
            _set(self, "_compiled", checked(caller, by_mass, _core.Chain, **columns))
        except ValueError as error:
            last = max(column.size for column in columns.values()) - 1
            if order == _FREE_END:
                raise
            raise ValueError(re.sub(r"(?<=links\[)\d+", lambda k: str(last - int(k[0])), str(error))) from None
        _set(self, "by_mass", by_mass)
        _set(self, "order", order)
        _set(self, "_names", None if names is None else _checked_names(caller, names, self.size, order))

    @classmethod
    def _wrap(
        cls,
        compiled: _core.Chain,
        by_mass: bool = False,
        names: tuple[str, ...] | None = None,
        order: Order = _FREE_END,
    ) -> Chain:
        chain = cls.__new__(cls)
        _set(chain, "_compiled", compiled)
        _set(chain, "by_mass", by_mass)
        _set(chain, "_names", names)
        _set(chain, "order", order)
        return chain

    @classmethod
    def uniform_plummets(
        cls, count: int, length: float = 1.0, weight: float | None = None, *, mass: float | None = None
    ) -> Chain:
        """Make a chain of `count` equal plummets on equal threads.

        Parameters
        ----------
        count : int
            Number of links, at least 1.
        length : float
            Length of the WHOLE chain, m, positive.
        weight, mass : float, optional
            Weight of the WHOLE chain or its mass in kg, positive; the weight is 1 if both are left out.

        Returns
        -------
        Chain

        Raises
        ------
        ValueError
            If a number is out of its range, or both mass and weight are given.

        Notes
        -----
        The values ``length / (count * conical_height)`` are the zeros of the Laguerre polynomial of degree `count`.
        Memory: O(1). Source: Greenhill (1908), sections 2 and 3.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain.uniform_plummets(2, length=2.0)).conical_height.round(6)
        array([1.707107, 0.292893])
        """
        caller = "revchain.Chain.uniform_plummets"
        by_mass, whole = _whole(caller, mass, weight)
        number, long = checked_count(caller, "count", count), real(caller, "length", length)
        return cls._wrap(checked(caller, by_mass, _core.Chain.uniform_plummets, number, long, whole), by_mass)

    @classmethod
    def uniform_rods(
        cls, count: int, length: float = 1.0, weight: float | None = None, *, mass: float | None = None
    ) -> Chain:
        """Make a chain of `count` equal uniform rods.

        Parameters
        ----------
        count : int
            Number of links, at least 1.
        length : float
            Length of the WHOLE chain, m, positive.
        weight, mass : float, optional
            Weight of the WHOLE chain or its mass in kg, positive; the weight is 1 if both are left out.

        Returns
        -------
        Chain

        Raises
        ------
        ValueError
            If a number is out of its range, or both mass and weight are given.

        Notes
        -----
        The conical heights tend to those of a uniform `Cord` with an error proportional to 1 / count**2. Memory: O(1).
        Source: Greenhill (1908), section 8 (21).

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain.uniform_rods(1, length=1.5)).conical_height
        array([1.])
        """
        caller = "revchain.Chain.uniform_rods"
        by_mass, whole = _whole(caller, mass, weight)
        number, long = checked_count(caller, "count", count), real(caller, "length", length)
        return cls._wrap(checked(caller, by_mass, _core.Chain.uniform_rods, number, long, whole), by_mass)

    @classmethod
    def tapered(
        cls, count: int, length: float = 1.0, weight: float | None = None, *, mass: float | None = None, exponent: float
    ) -> Chain:
        """Cut a cord that tapers by a power law into `count` straight links of equal length.

        Parameters
        ----------
        count : int
            Number of links, at least 1.
        length : float
            Length of the WHOLE chain, m, positive.
        weight, mass : float, optional
            Weight of the WHOLE chain or its mass in kg, positive; the weight is 1 if both are left out.
        exponent : float
            The line density is proportional to the distance from the free end to this power, above -1 and at most 1000.
            With 0 the links are uniform rods; with 1 the cord thickens upwards.

        Returns
        -------
        Chain

        Raises
        ------
        ValueError
            If a number is out of its range, the lowest link is too light, or both mass and weight are given.

        Notes
        -----
        The conical heights tend to those of the `Cord` with an error proportional to 1 / count**2. Accuracy: weights
        within 0.51 ulp; centroids too, for the stored length of a link. Cost: 0.6 microseconds a link. Source: Greenhill
        (1908), section 4.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Chain.tapered(3, exponent=1.0).weight.round(6)
        array([0.111111, 0.333333, 0.555556])
        """
        caller = "revchain.Chain.tapered"
        by_mass, whole = _whole(caller, mass, weight)
        number, long = checked_count(caller, "count", count, each=32), real(caller, "length", length)
        power = real(caller, "exponent", exponent)
        return cls._wrap(checked(caller, by_mass, _core.Chain.tapered, number, long, power, whole), by_mass)

    @property
    def taper(self) -> float | None:
        """Exponent of the line density if `tapered` made the chain, else None."""
        return self._compiled.taper

    @property
    def size(self) -> int:
        """Number of links."""
        return self._compiled.size

    @property
    def mode_count(self) -> int:
        """Number of modes: `size`, minus one for each independent motion without inertia."""
        return self._compiled.mode_count

    @property
    def total_length(self) -> float:
        """Length of the straight chain from the support to the free end, m."""
        return self._compiled.total_length

    @property
    def total_mass(self) -> float:
        """Total mass of the links, kg; an AttributeError if the chain was given by weight."""
        return self._measured("total_mass", True) and self._compiled.total_weight

    @property
    def total_weight(self) -> float:
        """Total weight of the links; an AttributeError if the chain was given by mass."""
        return self._measured("total_weight", False) and self._compiled.total_weight

    @property
    def mass(self) -> Floats:
        """Mass of each link, kg, shape (N,), lowest first; an AttributeError if the chain was given by weight."""
        self._measured("mass", True)
        return self._column(self._compiled.weight)

    @property
    def weight(self) -> Floats:
        """Weight of each link, shape (N,), lowest first; an AttributeError if the chain was given by mass."""
        self._measured("weight", False)
        return self._column(self._compiled.weight)

    @property
    def names(self) -> tuple[str, ...] | None:
        """Names of the links, lowest first; None if no names were given."""
        return self._names

    @property
    def length(self) -> Floats:
        """Distance between the pins of each link, m, shape (N,), lowest first; read-only."""
        return self._column(self._compiled.length)

    @property
    def centroid(self) -> Floats:
        """Distance of each centre of gravity below the upper pin, m, shape (N,); read-only."""
        return self._column(self._compiled.centroid)

    @property
    def pendulum_length(self) -> Floats:
        """Length of the equivalent simple pendulum of each link, m, shape (N,); read-only."""
        return self._column(self._compiled.pendulum_length)

    @property
    def radius_of_gyration(self) -> Floats:
        """Radius of gyration of each link about its centre of gravity, m, shape (N,); read-only."""
        return self._column(self._compiled.radius_of_gyration)

    def with_body(
        self, *, mass: float | None = None, weight: float | None = None, pin: int = 0, radius_of_gyration: float = 0.0
    ) -> Chain:
        """Return the chain with a body fixed at one of its pins.

        Parameters
        ----------
        mass, weight : float
            Mass in kg if the chain was given by mass, else the weight; positive.
        pin : int
            Number of links below the pin, from 0 (the free end) to N - 1.
        radius_of_gyration : float
            Radius of gyration of the body about its centre of gravity, m; 0 for a point mass. The centre of gravity
            lies in the pin, and the body turns with the link above.

        Returns
        -------
        Chain
            A chain in which the link above the pin includes the body. Conical heights are within 3 ulp of the exact
            body's if no centre of gravity lies above its pin.

        Raises
        ------
        ValueError
            If a number is out of its range, or mass and weight are not given as for the chain.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Chain.uniform_plummets(2, length=2.0).with_body(weight=1.5).weight
        array([2. , 0.5])
        """
        caller = "revchain.Chain.with_body"
        heavy = like(caller, self, mass, weight)
        body = real(caller, "mass" if self.by_mass else "weight", heavy)
        at, radius = integer(caller, "pin", pin), real(caller, "radius_of_gyration", radius_of_gyration)
        try:
            made = checked(caller, self.by_mass, _core.with_weight, compiled(caller, self), body, at, radius)
        except ValueError as error:
            if radius or "radius of gyration" not in str(error):
                raise
            name = "mass" if self.by_mass else "weight"
            raise ValueError(f"{caller}: {name} is too far from that of the link above pin {at}, got {body:g}") from None
        return self._wrap(made, self.by_mass, self._names, self.order)

    def with_thread(self, length: float, pin: int) -> Chain:
        """Return the chain with a massless thread inserted at one of its pins.

        Parameters
        ----------
        length : float
            Length of the thread, m, positive.
        pin : int
            Number of links below the thread, 1 to N. With N the thread hangs from the support.

        Returns
        -------
        Chain
            The chain, with N + 1 links.

        Raises
        ------
        ValueError
            If a number is out of its range.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=1.0, length=1.0).with_thread(0.5, pin=1)).conical_height
        array([1.5])
        """
        caller = "revchain.Chain.with_thread"
        core, at = compiled(caller, self), integer(caller, "pin", pin)
        made = checked(caller, self.by_mass, _core.with_thread, core, real(caller, "length", length), at)
        names = self._names and (*self._names[:at], "thread", *self._names[at:])
        return self._wrap(made, self.by_mass, names, self.order)

    def clamped(self, link: int) -> Chain:
        """Return the chain with two neighbouring links locked in line as one rigid link.

        Parameters
        ----------
        link : int
            Index of the lower of the two, from 0 for the lowest link.

        Returns
        -------
        Chain
            The chain, with N - 1 links.

        Raises
        ------
        ValueError
            If `link` is not from 0 to N - 2.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Chain.uniform_rods(3, length=3.0).clamped(0).length
        array([2., 1.])
        """
        caller = "revchain.Chain.clamped"
        at = integer(caller, "link", link)
        made = checked(caller, self.by_mass, _core.clamped, compiled(caller, self), at)
        names = self._names and (*self._names[:at], " and ".join(self._names[at : at + 2]), *self._names[at + 2 :])
        return self._wrap(made, self.by_mass, names, self.order)

    def _words(self) -> list[str]:
        return ["support: firm", *self._link_words()]

    def _link_words(self) -> list[str]:
        """Descriptions of the links from the support down: equal neighbours together, the middle left out if long."""
        starts = self._groups()
        ends = [*starts[1:], self.size]
        groups = list(zip(starts, ends, strict=True))[::-1]
        if len(groups) <= _GROUPS:
            return [self._group(*group) for group in groups]
        upper, lower = ([self._group(*group) for group in some] for some in (groups[:3], groups[-2:]))
        return [*upper, f"{ends[-4] - starts[2]:,} more links", *lower]

    def _groups(self) -> list[int]:
        """Index of the first link of each run of equal links, from the free end up."""
        numbers = (self._compiled.weight, self._compiled.length, self._compiled.centroid, self._compiled.radius_of_gyration)
        columns = [np.asarray(numbers_of) for numbers_of in numbers if numbers_of.ndim]
        if not columns and self._names is None:
            return [0]
        unlike = np.zeros(self.size, bool)
        unlike[0] = True
        for column in columns:
            unlike[1:] |= np.diff(column) != 0
        if self._names is not None:
            unlike[:] = True
        return [int(k) for k in np.flatnonzero(unlike)]

    def _group(self, first: int, end: int) -> str:
        """Description of equal links, from the index `first` to before `end`."""
        core = self._compiled
        numbers = (core.weight, core.length, core.centroid, core.radius_of_gyration)
        heavy, long, centroid, radius = [float(x[first] if x.ndim else x) for x in numbers]
        if heavy == 0:
            what = f"thread, {long:.6g} m"
        elif centroid == long and radius == 0:
            what = f"{heavy:.6g} {self._unit} on {long:.6g} m"
        elif are_rods(long, centroid, radius):
            what = f"rod, {heavy:.6g} {self._unit}, {long:.6g} m"
        else:
            what = f"body, {heavy:.6g} {self._unit}, {long:.6g} m"
        named = f"{self._names[first]}: {what}" if self._names is not None else what
        return f"{end - first:,} times {named}" if end - first > 1 else named

    @property
    def _unit(self) -> str:
        return "kg" if self.by_mass else "N"

    def _measured(self, name: str, by_mass: bool) -> bool:
        """True if the chain was given by the quantity of that name, mass or weight; an AttributeError if not."""
        if self.by_mass != by_mass:
            given, other = ("mass", "weight") if self.by_mass else ("weight", "mass")
            raise AttributeError(
                f"this chain was given by {given}: it has no {name} without gravity; use {name.replace(other, given)}"
            )
        return True

    def _column(self, stored: Floats) -> Floats:
        if stored.ndim:
            return stored
        refuse_beyond_memory("revchain.Chain", "the number of links", self.size, 8)
        return np.broadcast_to(stored, (self.size,))

    def __len__(self) -> int:
        return self.size

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Chain):
            return NotImplemented
        alike = self.by_mass == other.by_mass and self._names == other._names
        return alike and bool(self._compiled == other._compiled)

    def __hash__(self) -> int:
        return hash((self.size, self.total_length, self._compiled.total_weight))

    def __repr__(self) -> str:
        links = "1 link" if self.size == 1 else f"{self.size:,} links"
        heavy = f"{'mass' if self.by_mass else 'weight'} {self._compiled.total_weight:.6g}"
        return f"Chain of {links}, length {self.total_length:.6g}, {heavy}"

    _kind = "chain"

    def _under(self, gravity: float) -> _core.Chain:
        return self._compiled

    @property
    def _whole_length(self) -> float:
        """Length of the whole system, m."""
        return self.total_length

    @property
    def _total(self) -> float:
        """Mass or weight of the whole chain, as given."""
        return self._compiled.total_weight

    def _state(self) -> tuple[Any, ...]:
        """The numbers and arrays that make up the chain."""
        return self._compiled.__getstate__(), self.by_mass, self._names, self.order

    @classmethod
    def _from_state(cls, state: Any) -> Chain:
        """The chain from its state, for every pickle protocol (the compiled class knows only some)."""
        parts, by_mass, names, order = state
        compiled = _core.Chain.__new__(_core.Chain)
        compiled.__setstate__(tuple(parts))
        return cls._wrap(compiled, by_mass, names, order)

    def _data(self) -> dict[str, Any]:
        core = self._compiled
        size, _, _, _, high, low, *_ = core.__getstate__()
        columns = {
            "mass" if self.by_mass else "weight": core.weight,
            "length": core.length,
            "centroid": core.centroid,
            "gyration_ratio": high,
            "gyration_ratio_low": low,
        }
        way = slice(None, None, 1 if self.order == _FREE_END else -1)
        data: dict[str, Any] = {"links": size}
        data |= {name: (column[way] if column.ndim else column).tolist() for name, column in columns.items()}
        order = None if self.order == _FREE_END else self.order
        more = {"names": self._names and list(self._names[way]), "taper": self.taper, "order": order}
        return data | {name: value for name, value in more.items() if value is not None}

    @classmethod
    def _from_data(cls, data: dict[str, Any]) -> Chain:
        by_mass = "mass" in data
        if "gyration_ratio" not in data:
            return cls(**data)
        known = {"links", "mass" if by_mass else "weight", "length", "centroid", "gyration_ratio", "gyration_ratio_low"}
        if unknown := sorted(data.keys() - known - {"names", "taper", "order"}):
            raise TypeError(f"there is no {unknown[0]}")
        taper = (real("revchain.Chain.from_dict", "taper", data["taper"]),) if "taper" in data else ()
        caller = "revchain.Chain.from_dict"
        order: Any = word(caller, "order", data.get("order", _FREE_END), _ORDERS)
        way = slice(None, None, 1 if order == _FREE_END else -1)
        names_of = ("mass" if by_mass else "weight", "length", "centroid", "gyration_ratio", "gyration_ratio_low")
        arrays = [floats(caller, name, data[name]) for name in names_of]
        arrays = [np.ascontiguousarray(array[way]) if array.ndim else array for array in arrays]
        size, names = integer(caller, "links", data["links"]), data.get("names")
        names = None if names is None else _checked_names(caller, names, size, order)
        return cls._from_state(((size, *arrays, 2, *taper), by_mass, names, order))


def are_rods(length: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return, for each link, whether it is a uniform rod, to rounding."""
    half, spread = np.multiply(length, 0.5), np.divide(length, math.sqrt(12))
    return np.isclose(centroid, half, rtol=1e-12, atol=0.0) & np.isclose(radius_of_gyration, spread, rtol=1e-12, atol=0.0)


def like(caller: str, chain: Chain, mass: Any, weight: Any, of: str = "") -> Any:
    """The mass if the chain was given by mass, else the weight; a ValueError if the wrong one was given."""
    by_mass, heavy = mass_or_weight(caller, mass, weight, of)
    if by_mass != chain.by_mass:
        given, other = ("mass", "weight") if chain.by_mass else ("weight", "mass")
        raise ValueError(f"{caller}: the chain was given by {given}: give {of}{given}, not {of}{other}, got {shown(heavy)}")
    return heavy


def _whole(caller: str, mass: float | None, weight: float | None) -> tuple[bool, float]:
    """Return whether the mass of a whole chain is given, and its mass or weight; the weight is 1 if neither is given."""
    if mass is None and weight is None:
        return False, 1.0
    by_mass, heavy = mass_or_weight(caller, mass, weight)
    return by_mass, real(caller, "mass" if by_mass else "weight", heavy)


def _checked_names(caller: str, names: Sequence[str], size: int, order: str) -> tuple[str, ...]:
    if not isinstance(names, list | tuple) or not all(isinstance(name, str) for name in names):
        raise ValueError(f"{caller}: names must be a list of text, got {shown(names)}")
    if len(names) != size:
        raise ValueError(f"{caller}: names must have one name for each of the {size} links, got {len(names)}")
    return tuple(names) if order == "free end first" else tuple(names)[::-1]


def _check_shapes(columns: dict[str, Floats]) -> None:
    shapes = {column.shape for column in columns.values()}
    if len(shapes) == 1 and len(next(iter(shapes))) < 2:
        return
    sizes = {}
    for name, column in columns.items():
        if column.ndim > 1:
            raise ValueError(
                f"revchain.Chain: {name} must be a number or an array of one dimension, got shape {column.shape}"
            )
        if column.ndim == 1:
            sizes[name] = column.size
    if len(set(sizes.values())) > 1:
        found = ", ".join(f"{name} has {size}" for name, size in sizes.items())
        raise ValueError(f"revchain.Chain: arrays must have one number for each link, but {found}")


def checked(caller: str, by_mass: bool, make: Callable[..., Any], *given: Any, **named: Any) -> Any:
    """The result of `make`. Its errors name `caller`, and say "mass" if masses were given."""
    try:
        return make(*given, **named)
    except ValueError as error:
        text = without_function(error)
        raise ValueError(f"{caller}: {text.replace('weights', 'masses').replace('weight', 'mass') if by_mass else text}") from None


def compiled(caller: str, chain: Chain, link_by_link: bool = True) -> _core.Chain:
    """The compiled chain; a TypeError if `chain` is not a Chain, a ValueError if it has too many links."""
    if not isinstance(chain, Chain):
        raise TypeError(f"{caller}: chain must be a revchain.Chain, got {shown(chain)}")
    if link_by_link:
        refuse_beyond_memory(caller, "the number of links", chain.size, 8)
    return chain._compiled


_set = object.__setattr__
