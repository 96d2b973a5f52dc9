# SPDX-License-Identifier: GPL-3.0-or-later
"""The uniform chain with a point mass at its free end, at small amplitude.

`tip` is the length of chain that weighs as much as the mass, from 0 (the chain of `revchain.heavy_chain`) to 1e250
lengths: a heavy tip leaves nearly a pendulum, whose conical height is the length, and a string that vibrates between
two fixed ends. The chain of Greenhill (1908) section 4: heights are the zeros of ``Y2(a) J0(b) - J2(a) Y0(b)``,
``a = 2 sqrt(tip / height)``, ``b = 2 sqrt((tip + length) / height)``. `x` is measured from the free end, modes are
counted from 1. Array arguments broadcast; numbers out of their range raise a ValueError.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import Floats, floats, places, positive, real, refuse_where, together
from ..systems.numbers import count as checked_count

__all__ = ["conical_heights", "nodes", "shape", "slope"]


def _chain(place: str, tip: ArrayLike, length: ArrayLike) -> dict[str, Floats]:
    long, mass = positive(place, "length", length), floats(place, "tip", tip)
    refuse_where(~(mass >= 0), mass, f"{place}: tip must not be negative")
    long, mass = together(place, length=long, tip=mass)
    refuse_where(~(mass / 1e250 <= long), mass, f"{place}: tip must be at most 1e250 lengths")
    return {"length": long, "tip": mass}


def conical_heights(count: int, *, tip: ArrayLike, length: ArrayLike = 1.0) -> Floats:
    """Return the conical heights of the slowest modes.

    Parameters
    ----------
    count : int
        How many, at least 1.
    tip : array_like
        Length of chain that weighs as much as the mass, not negative.
    length : array_like, optional
        Positive.

    Returns
    -------
    ndarray, shape (..., count)
        Descending, in the unit of `length`, within 2 ulp. Cost O(count), 0.2 to 15 microseconds each.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tip_mass.conical_heights(3, tip=[0.0, 1.0, 1000.0]).round(6)
    array([[6.91660e-01, 1.31271e-01, 5.34140e-02],
           [8.96035e-01, 6.00230e-02, 1.67030e-02],
           [9.99833e-01, 1.01000e-04, 2.50000e-05]])
    """
    place = "revchain.tip_mass.conical_heights"
    return _core.tip_mass_conical_heights(
        checked_count(place, "count", count, each=8), **_chain(place, tip, length)
    )


def shape(x: ArrayLike, mode: ArrayLike, *, tip: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return the offset of the chain from its axis, 1 at the free end.

    Parameters
    ----------
    x : array_like
        Distance from the free end, 0 to `length`.
    mode : array_like of int
        From 1.
    tip, length : array_like
        As in `conical_heights`.

    Returns
    -------
    float or ndarray
        Broadcast shape; absolute error below 2e-15 times the mode, of the largest offset, which for modes above 1 can
        reach ``sqrt(1 + tip / height)``. Cost O(1) a number, and that of the height where the chain or mode changes.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tip_mass.shape([0.0, 0.5, 1.0], mode=1, tip=1.0).round(4) + 0.0
    array([1.    , 0.4608, 0.    ])
    """
    place = "revchain.tip_mass.shape"
    return _core.tip_mass_shape(*places(place, x, mode, **_chain(place, tip, length)))[()]


def slope(x: ArrayLike, mode: ArrayLike, *, tip: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return ``d offset / dx`` of `shape`, ``-1 / height`` at the free end.

    Parameters
    ----------
    x, mode, tip, length : array_like
        As in `shape`.

    Returns
    -------
    float or ndarray
        Broadcast shape. Accuracy and cost are those of `shape`, of the largest slope.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tip_mass.slope([0.0, 0.5, 1.0], mode=1, tip=1.0).round(4)
    array([-1.116 , -1.0141, -0.8226])
    """
    place = "revchain.tip_mass.slope"
    return _core.tip_mass_slope(*places(place, x, mode, **_chain(place, tip, length)))[()]


def nodes(mode: int, *, tip: float, length: float = 1.0) -> Floats:
    """Return where a mode crosses the axis.

    Parameters
    ----------
    mode : int
        From 1.
    tip, length : float
        As in `conical_heights`.

    Returns
    -------
    ndarray, shape (mode - 1,)
        Distances from the free end, ascending, without the support, within 1e-15 of `length`. Cost O(mode).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tip_mass.nodes(3, tip=1.0).round(4)
    array([0.0167, 0.4672])
    """
    place = "revchain.tip_mass.nodes"
    chain = _chain(place, real(place, "tip", tip), real(place, "length", length))
    return _core.tip_mass_nodes(checked_count(place, "mode", mode, each=8), *map(float, chain.values()))
