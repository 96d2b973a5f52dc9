# SPDX-License-Identifier: GPL-3.0-or-later
"""The chain as users hold it: an immutable value around the compiled one."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .numbers import Floats, integer, link_arrays, real, refuse_beyond_memory, shown
from .numbers import count as checked_count
from .unchangeable import Unchangeable

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Chain(Unchangeable):
    """A chain of links hanging from a support, listed lowest first.

    Give each quantity as one number for every link, or as an array with one number for each link;
    at least one array unless the chain has a single link. Use any consistent units: weights enter
    only by their ratios, and every result is in the unit of the lengths.

    Parameters
    ----------
    weight : array_like, shape (N,) or scalar
        Weight of each link, not negative; the lowest must be positive, 0 is a massless thread.
    length : array_like, shape (N,) or scalar
        Distance between the pins of each link, positive.
    centroid : array_like, shape (N,) or scalar, optional
        Distance of the centre of gravity from the *upper* pin, positive downwards, of any sign.
        Left out: plummets, with all the weight at the lower pin.
    pendulum_length : array_like, shape (N,) or scalar, optional
        Length of the equivalent simple pendulum about the upper pin.
    radius_of_gyration : array_like, shape (N,) or scalar, optional
        Radius of gyration about the centre of gravity, not negative. With `centroid` give either
        this or `pendulum_length`.

    Raises
    ------
    ValueError
        For anything but real finite numbers, arrays of more than one dimension or of different
        lengths, no links, a length that is not positive, a negative weight, a massless lowest link,
        weights whose sum overflows, an imaginary radius of gyration, a link that would stand rather
        than hang, or a `centroid` without exactly one of the two arguments that go with it.

    Notes
    -----
    One number given for all links stays one number inside. Cost O(N), once.

    References
    ----------
    Greenhill (1908), section 8 (1)-(5).

    Examples
    --------
    A bell (upper link) and its clapper (lower link):

    >>> import revchain as rc
    >>> rc.Chain(weight=[180, 5000], length=[0.7, 0.15], centroid=[0.55, 0.05],
    ...          radius_of_gyration=[0.2, 0.36])
    Chain of 2 links, length 0.85, weight 5180
    """

    __slots__ = ("_compiled",)
    _compiled: _core.Chain

    def __init__(
        self,
        *,
        weight: ArrayLike,
        length: ArrayLike,
        centroid: ArrayLike | None = None,
        pendulum_length: ArrayLike | None = None,
        radius_of_gyration: ArrayLike | None = None,
    ) -> None:
        columns = link_arrays(
            "revchain.Chain",
            weight=weight,
            length=length,
            centroid=centroid,
            pendulum_length=pendulum_length,
            radius_of_gyration=radius_of_gyration,
        )
        _check_shapes(columns)
        object.__setattr__(self, "_compiled", _core.Chain(**columns))

    @classmethod
    def _wrap(cls, compiled: _core.Chain) -> Chain:
        chain = cls.__new__(cls)
        object.__setattr__(chain, "_compiled", compiled)
        return chain

    @classmethod
    def uniform_plummets(cls, count: int, length: float = 1.0, weight: float = 1.0) -> Chain:
        """Make a chain of `count` equal plummets on equal threads.

        Parameters
        ----------
        count : int
            Number of links, at least 1.
        length, weight : float
            Length and weight of the WHOLE chain, positive.

        Returns
        -------
        Chain

        Raises
        ------
        ValueError
            If `count` is below 1, or `length` or `weight` is not positive and finite.

        Notes
        -----
        ``length / (count * conical_height)`` are the zeros of the Laguerre polynomial of degree
        `count`. Greenhill (1908) sections 2 and 3. Memory O(1).

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain.uniform_plummets(2, length=2.0)).conical_height.round(6)
        array([1.707107, 0.292893])
        """
        place = "revchain.Chain.uniform_plummets"
        return cls._wrap(
            _core.Chain.uniform_plummets(
                checked_count(place, "count", count), real(place, "length", length), real(place, "weight", weight)
            )
        )

    @classmethod
    def uniform_rods(cls, count: int, length: float = 1.0, weight: float = 1.0) -> Chain:
        """Make a chain of `count` equal uniform rods.

        Parameters
        ----------
        count : int
            Number of links, at least 1.
        length, weight : float
            Length and weight of the WHOLE chain, positive.

        Returns
        -------
        Chain

        Raises
        ------
        ValueError
            If `count` is below 1, or `length` or `weight` is not positive and finite.

        Notes
        -----
        Greenhill (1908) section 8 (17). The conical heights tend to those of the continuous chain
        (`revchain.heavy_chain`) as 1 / count**2. Memory O(1).

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain.uniform_rods(1, length=1.5)).conical_height
        array([1.])
        """
        place = "revchain.Chain.uniform_rods"
        return cls._wrap(
            _core.Chain.uniform_rods(
                checked_count(place, "count", count), real(place, "length", length), real(place, "weight", weight)
            )
        )

    @classmethod
    def tapered(cls, count: int, length: float = 1.0, weight: float = 1.0, *, exponent: float) -> Chain:
        """Cut a cord that tapers by a power law into `count` straight links of equal length.

        Parameters
        ----------
        count : int
            Number of links, at least 1.
        length, weight : float
            Length and weight of the WHOLE chain, positive.
        exponent : float
            Of the line density, which is as the distance from the free end to this power; above -1 and at most
            1000. 0: uniform rods; 1: a cord that thickens upwards; towards -1 the weight gathers at the free end.

        Returns
        -------
        Chain
            It remembers the exponent, `taper`.

        Raises
        ------
        ValueError
            If `count` is below 1, `length` or `weight` is not positive and finite, the exponent is out of range, or
            leaves the lowest link with less weight than 1e-292.

        Notes
        -----
        Greenhill (1908) section 4. The conical heights tend to those of the cord (`revchain.tapered_chain`) as
        1 / count**2, and `revchain.solve` knows how. Weights within 0.51 ulp, and centroids for the
        length of a link as it is stored. Cost: 0.5 to 2 microseconds a link.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Chain.tapered(3, exponent=1.0).weight.round(6)
        array([0.111111, 0.333333, 0.555556])
        """
        place = "revchain.Chain.tapered"
        return cls._wrap(
            _core.Chain.tapered(
                checked_count(place, "count", count, each=8),
                real(place, "length", length),
                real(place, "exponent", exponent),
                real(place, "weight", weight),
            )
        )

    @property
    def taper(self) -> float | None:
        """Exponent of the line density of a chain that `tapered` made; None of others, and of what is made of one."""
        return self._compiled.taper

    @property
    def size(self) -> int:
        """Number of links."""
        return self._compiled.size

    @property
    def mode_count(self) -> int:
        """Number of modes: `size`, less one for every massless link that takes a motion away."""
        return self._compiled.mode_count

    @property
    def total_length(self) -> float:
        """Length of the straight chain, from the support to the free end."""
        return self._compiled.total_length

    @property
    def total_weight(self) -> float:
        """Weight of all links together."""
        return self._compiled.total_weight

    @property
    def weight(self) -> Floats:
        """Weight of each link, shape (N,), lowest first; read-only."""
        return self._column(self._compiled.weight)

    @property
    def length(self) -> Floats:
        """Distance between the pins of each link, shape (N,), lowest first; read-only."""
        return self._column(self._compiled.length)

    @property
    def centroid(self) -> Floats:
        """Distance of each centre of gravity below the upper pin, shape (N,); read-only."""
        return self._column(self._compiled.centroid)

    @property
    def pendulum_length(self) -> Floats:
        """Length of the equivalent simple pendulum of each link, shape (N,); infinite where the
        centre of gravity lies in the upper pin; read-only."""
        return self._column(self._compiled.pendulum_length)

    @property
    def radius_of_gyration(self) -> Floats:
        """Radius of gyration of each link about its centre of gravity, shape (N,); read-only."""
        return self._column(self._compiled.radius_of_gyration)

    def with_weight(self, weight: float, pin: int = 0, *, radius_of_gyration: float = 0.0) -> Chain:
        """Return the chain with a weight fixed at one of its pins.

        Parameters
        ----------
        weight : float
            Positive.
        pin : int
            0 for the free end, else the number of links below the pin, less than N.
        radius_of_gyration : float
            Of a body, about its centre of gravity, which lies in the pin; it turns with the link above. A
            point weight has none.

        Returns
        -------
        Chain
            The link above the pin and the weight are one body in it: weight and centroid rounded once, the
            radius of gyration kept in two words. Heights within 3 ulp of the exact body's.

        Raises
        ------
        ValueError
            If there is no such pin, or a number is out of range.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Chain.uniform_plummets(2, length=2.0).with_weight(1.5).weight
        array([2. , 0.5])
        """
        place = "revchain.Chain.with_weight"
        return self._wrap(
            _core.with_weight(
                compiled(place, self),
                real(place, "weight", weight),
                integer(place, "pin", pin),
                real(place, "radius_of_gyration", radius_of_gyration),
            )
        )

    def with_thread(self, length: float, pin: int) -> Chain:
        """Return the chain with a massless thread put in.

        Parameters
        ----------
        length : float
            Positive.
        pin : int
            Where: the number of links below it, 1 to N; N is the support, which the thread then hangs from.

        Returns
        -------
        Chain
            Of N + 1 links.

        Raises
        ------
        ValueError
            If there is no such pin, or the length is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=1.0, length=1.0).with_thread(0.5, pin=1)).conical_height
        array([1.5])
        """
        place = "revchain.Chain.with_thread"
        core = compiled(place, self)
        return self._wrap(_core.with_thread(core, real(place, "length", length), integer(place, "pin", pin)))

    def clamped(self, link: int) -> Chain:
        """Return the chain with two neighbouring links locked in line, as one rigid link.

        Parameters
        ----------
        link : int
            Number of the lower of the two, from 1 for the lowest link.

        Returns
        -------
        Chain
            Of N - 1 links. Its conical heights lie between those of this chain.

        Raises
        ------
        ValueError
            If `link` is not from 1 to N - 1.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Chain.uniform_rods(3, length=3.0).clamped(1).length
        array([2., 1.])
        """
        place = "revchain.Chain.clamped"
        return self._wrap(_core.clamped(compiled(place, self), integer(place, "link", link)))

    def plot(self, ax: Axes | None = None, *, length_unit: str = "m", weight_unit: str = "N") -> Axes:
        """Draw the chain at rest: pins, centres of gravity and weights.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        length_unit, weight_unit : str
            What to write on the axes.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.Chain(weight=[1.0, 2.0], length=[0.5, 0.3]).plot()
        >>> ax.get_ylabel()
        'depth below the support (m)'
        """
        from ..plots.style import plot_chain

        return plot_chain(self, ax, length_unit=length_unit, weight_unit=weight_unit)

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
        return bool(self._compiled == other._compiled)

    def __hash__(self) -> int:
        return hash((self.size, self.total_length, self.total_weight))

    def __repr__(self) -> str:
        links = "1 link" if self.size == 1 else f"{self.size:,} links"
        return f"Chain of {links}, length {self.total_length:.6g}, weight {self.total_weight:.6g}"

    def __reduce__(self) -> tuple[Any, ...]:
        return Chain._from_state, (self._state(),)

    def _state(self) -> tuple[Any, ...]:
        """All it is made of: numbers and arrays."""
        return self._compiled.__getstate__()

    @classmethod
    def _from_state(cls, state: tuple[Any, ...]) -> Chain:
        """For every pickle protocol, which the compiled one is not."""
        compiled = _core.Chain.__new__(_core.Chain)
        compiled.__setstate__(tuple(state))
        return cls._wrap(compiled)


def _check_shapes(columns: dict[str, Floats]) -> None:
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


def compiled(place: str, chain: Chain, link_by_link: bool = True) -> _core.Chain:
    """What the compiled module takes; a TypeError for anything but a chain, a ValueError for too many links."""
    if not isinstance(chain, Chain):
        raise TypeError(f"{place}: chain must be a revchain.Chain, got {shown(chain)}")
    if link_by_link:
        refuse_beyond_memory(place, "the number of links", chain.size, 8)
    return chain._compiled
