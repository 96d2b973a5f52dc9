# SPDX-License-Identifier: GPL-3.0-or-later
"""The chain whose line density is a power of the distance from its free end, at small amplitude.

`exponent` is that power, above -1: 0 leaves the chain of `revchain.heavy_chain`, greater numbers thicken it upwards,
lesser ones gather its mass at the free end. `x` is measured from the free end, modes are counted from 1.
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
    """Return the conical heights of the slowest modes.

    Parameters
    ----------
    count : int
        How many, at least 1.
    exponent : array_like
        Power of the density, above -1 and at most 1e4.
    length : array_like, optional
        Length of the chain, positive; the two broadcast.

    Returns
    -------
    ndarray, shape (..., count)
        Descending, in the unit of `length`, within 3 ulp for exponents from -0.99 to 100: ``4 (exponent + 1)
        length / z**2``, `z` the zeros of the Bessel function of that order. Cost O(count), 0.02 to 10 microseconds
        each.

    Raises
    ------
    ValueError
        If `count` is below 1 or another number out of its range.

    Notes
    -----
    The chain of Greenhill (1908) section 4 with another density: offset ``gamma(p + 1) (z/2)**-p Jp(z)``,
    ``z = 2 sqrt((p + 1) x / height)``, `p` the exponent.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tapered_chain.conical_heights(3, exponent=[0.0, 1.0]).round(6)
    array([[0.69166 , 0.131271, 0.053414],
           [0.544886, 0.162541, 0.077295]])
    """
    place = "revchain.tapered_chain.conical_heights"
    number = checked_count(place, "count", count, each=8)
    long, other = together(place, **_chain(place, exponent, length))
    return _core.tapered_chain_conical_heights(number, long, other)


def shape(x: ArrayLike, mode: ArrayLike, *, exponent: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return the offset of the chain from its axis, 1 at the free end.

    Parameters
    ----------
    x : array_like
        Distance from the free end, from 0 to `length`.
    mode : array_like of int
        Mode, counted from 1.
    exponent : array_like
        Power of the density, above -1 and at most 1e4.
    length : array_like, optional
        Length of the chain, positive.

    Returns
    -------
    float or ndarray
        Broadcast shape; absolute error below 1e-15 times 1 + z, of the largest offset, which exceeds 1 for
        exponents below -1/2. Cost O(1) a number, and the height's where the chain or mode changes.

    Raises
    ------
    ValueError
        If a number is out of its range or `mode` not whole.

    Notes
    -----
    The chain of Greenhill (1908) section 4 with another density: offset ``gamma(p + 1) (z/2)**-p Jp(z)``,
    ``z = 2 sqrt((p + 1) x / height)``, `p` the exponent.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tapered_chain.shape([0.0, 0.5, 1.0], mode=1, exponent=1.0).round(4) + 0.0
    array([1.    , 0.3238, 0.    ])
    """
    place = "revchain.tapered_chain.shape"
    return _core.tapered_chain_shape(*places(place, x, mode, **_chain(place, exponent, length)))[()]


def slope(x: ArrayLike, mode: ArrayLike, *, exponent: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return ``d offset / dx`` of the chain whose offset is 1 at the free end.

    Parameters
    ----------
    x : array_like
        Distance from the free end, from 0 to `length`.
    mode : array_like of int
        Mode, counted from 1.
    exponent : array_like
        Power of the density, above -1 and at most 1e4.
    length : array_like, optional
        Length of the chain, positive.

    Returns
    -------
    float or ndarray
        Broadcast shape, ``-1 / height`` at the free end. Accuracy that of `shape`, of the largest slope.

    Raises
    ------
    ValueError
        If a number is out of its range or `mode` not whole.

    Notes
    -----
    The chain of Greenhill (1908) section 4 with another density: offset ``gamma(p + 1) (z/2)**-p Jp(z)``,
    ``z = 2 sqrt((p + 1) x / height)``, `p` the exponent.

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
        Mode, counted from 1.
    exponent : float
        Power of the density, above -1 and at most 1e4.
    length : float, optional
        Length of the chain, positive.

    Returns
    -------
    ndarray, shape (mode - 1,)
        Distances from the free end, ascending, the support left out, within 3 ulp. Cost O(mode).

    Raises
    ------
    ValueError
        If `mode` is below 1 or another number out of its range.

    Notes
    -----
    The chain of Greenhill (1908) section 4 with another density: offset ``gamma(p + 1) (z/2)**-p Jp(z)``,
    ``z = 2 sqrt((p + 1) x / height)``, `p` the exponent.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.tapered_chain.nodes(3, exponent=1.0).round(4)
    array([0.1419, 0.4755])
    """
    place = "revchain.tapered_chain.nodes"
    chain = _chain(place, real(place, "exponent", exponent), real(place, "length", length))
    number = checked_count(place, "mode", mode, each=8)
    return _core.tapered_chain_nodes(number, float(chain["length"]), float(chain["exponent"]))
