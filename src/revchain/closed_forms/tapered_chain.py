# SPDX-License-Identifier: GPL-3.0-or-later
"""The chain whose line density is a power of the distance from its free end, at small amplitude.

`exponent`, `p` for short, is that power, above -1 and at most 1e4: 0 is the uniform chain of `revchain.heavy_chain`,
greater numbers thicken it upwards, smaller ones gather its mass at the free end. The chain of Greenhill (1908) section
4 with another density: offset ``gamma(p + 1) (z/2)**-p Jp(z)``, ``z = 2 sqrt((p + 1) x / height)``, `x` from 0 at the
free end to `length`; modes are counted from 1. Array arguments broadcast; numbers out of their range raise a
ValueError.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import Floats, floats, places, positive, real, refuse_where, together
from ..systems.numbers import count as checked_count

__all__ = ["conical_heights", "nodes", "shape", "slope"]


def _chain(place: str, exponent: ArrayLike, length: ArrayLike) -> dict[str, Floats]:
    power = floats(place, "exponent", exponent)
    refuse_where(~((power > -1) & (power <= 1e4)), power, f"{place}: exponent must be above -1 and at most 1e4")
    return {"length": positive(place, "length", length), "exponent": power}


def conical_heights(count: int, *, exponent: ArrayLike, length: ArrayLike = 1.0) -> Floats:
    """Return the conical heights of the slowest modes, ``4 (p + 1) length / z**2``, `z` the zeros of Jp.

    Parameters
    ----------
    count : int
        How many, at least 1.
    exponent : array_like
        Power of the density.
    length : array_like, optional
        Positive.

    Returns
    -------
    ndarray, shape (..., count)
        Descending, in the unit of `length`, within 3 ulp for exponents from -0.99 to 100. Cost O(count), 0.02 to 10
        microseconds each.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tapered_chain.conical_heights(3, exponent=[0.0, 1.0]).round(6)
    array([[0.69166 , 0.131271, 0.053414],
           [0.544886, 0.162541, 0.077295]])
    """
    place = "revchain.tapered_chain.conical_heights"
    number = checked_count(place, "count", count, each=8)
    return _core.tapered_chain_conical_heights(number, *together(place, **_chain(place, exponent, length)))


def shape(x: ArrayLike, mode: ArrayLike, *, exponent: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return the offset of the chain from its axis, 1 at the free end.

    Parameters
    ----------
    x : array_like
        Distance from the free end, 0 to `length`.
    mode : array_like of int
        From 1.
    exponent, length : array_like
        As in `conical_heights`.

    Returns
    -------
    float or ndarray
        Broadcast shape; absolute error below 1e-15 times 1 + z, of the largest offset, which exceeds 1 for
        exponents below -1/2. Cost O(1) a number, and that of the height where the chain or mode changes.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tapered_chain.shape([0.0, 0.5, 1.0], mode=1, exponent=1.0).round(4) + 0.0
    array([1.    , 0.3238, 0.    ])
    """
    place = "revchain.tapered_chain.shape"
    return _core.tapered_chain_shape(*places(place, x, mode, **_chain(place, exponent, length)))[()]


def slope(x: ArrayLike, mode: ArrayLike, *, exponent: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return ``d offset / dx`` of `shape`, ``-1 / height`` at the free end.

    Parameters
    ----------
    x, mode, exponent, length : array_like
        As in `shape`.

    Returns
    -------
    float or ndarray
        Broadcast shape. Accuracy and cost are those of `shape`, of the largest slope.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tapered_chain.slope([0.0, 0.5, 1.0], mode=1, exponent=1.0).round(4)
    array([-1.8352, -0.9409, -0.4028])
    """
    place = "revchain.tapered_chain.slope"
    return _core.tapered_chain_slope(*places(place, x, mode, **_chain(place, exponent, length)))[()]


def nodes(mode: int, *, exponent: float, length: float = 1.0) -> Floats:
    """Return where a mode crosses the axis.

    Parameters
    ----------
    mode : int
        From 1.
    exponent, length : float
        As in `conical_heights`.

    Returns
    -------
    ndarray, shape (mode - 1,)
        Distances from the free end, ascending, without the support, within 3 ulp. Cost O(mode).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tapered_chain.nodes(3, exponent=1.0).round(4)
    array([0.1419, 0.4755])
    """
    place = "revchain.tapered_chain.nodes"
    chain = _chain(place, real(place, "exponent", exponent), real(place, "length", length))
    return _core.tapered_chain_nodes(checked_count(place, "mode", mode, each=8), *map(float, chain.values()))
