# SPDX-License-Identifier: GPL-3.0-or-later
"""The continuous chain: the limit of many small links, in Bessel functions.

A uniform, perfectly flexible chain of a given length whirls in mode `k` at the conical height
``4 * length / z**2``, `z` the `k`-th zero of J0, in the shape ``J0(2 sqrt(x / height))``, `x`
measured from the free end. Source: Greenhill (1908), section 4. Modes are counted from 1.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._arguments import STANDARD_GRAVITY, Floats, floats, positive, real, shown, together
from ._arguments import count as checked_count

__all__ = ["conical_heights", "nodes", "revolutions_per_second", "shape", "vertical_points"]


def conical_heights(count: int, length: ArrayLike = 1.0) -> Floats:
    """Return the conical heights of the slowest modes.

    Parameters
    ----------
    count : int
        How many, at least 1.
    length : array_like, optional
        Length of the chain, positive, any shape.

    Returns
    -------
    ndarray, shape (..., count)
        Descending, in the unit of `length`, within 4 ulp. Cost O(count).

    Raises
    ------
    ValueError
        If `count` is below 1 or `length` not positive and finite.

    Notes
    -----
    Greenhill (1908) section 4 (10), (12).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.conical_heights(3).round(6)
    array([0.69166 , 0.131271, 0.053414])
    """
    place = "revchain.heavy_chain.conical_heights"
    return _core.heavy_chain_conical_heights(checked_count(place, "count", count), positive(place, "length", length))


def shape(x: ArrayLike, mode: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return the offset of the chain from its axis, 1 at the free end.

    Parameters
    ----------
    x : array_like
        Distance from the free end, from 0 to `length`.
    mode : array_like of int
        Mode, counted from 1.
    length : array_like, optional
        Length of the chain, positive.

    Returns
    -------
    float or ndarray
        ``J0(z sqrt(x / length))``, broadcast shape; absolute error below 1e-15 times the mode.
        Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is out of its range or `mode` not whole.

    Notes
    -----
    Greenhill (1908) section 4 (9).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.shape([0.0, 0.5, 1.0], mode=1).round(4) + 0.0
    array([1.    , 0.3977, 0.    ])
    """
    place = "revchain.heavy_chain.shape"
    at = floats(place, "x", x)
    whole = np.asarray(mode)
    if whole.dtype.kind not in "iu":
        raise ValueError(f"{place}: mode must be a whole number, got {shown(mode)}")
    if whole.size and whole.min() < 1:
        raise ValueError(f"{place}: mode must be at least 1, got {whole.min()}")
    long = positive(place, "length", length)
    at, whole, long = together(place, x=at, mode=whole.astype(np.int64), length=long)
    wrong = ~((at >= 0) & (at <= long))
    if wrong.any():
        raise ValueError(f"{place}: x must lie between 0 and length, got {at[wrong][0]:g}")
    return _core.heavy_chain_shape(at, whole, long)


def nodes(mode: int, length: float = 1.0) -> Floats:
    """Return where a mode crosses the axis.

    Parameters
    ----------
    mode : int
        Mode, counted from 1.
    length : float, optional
        Length of the chain, positive.

    Returns
    -------
    ndarray, shape (mode - 1,)
        Distances from the free end, ascending, the support left out, within 5 ulp. Cost O(mode).

    Raises
    ------
    ValueError
        If `mode` is below 1 or `length` not positive and finite.

    Notes
    -----
    Greenhill (1908) section 4 (12).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.nodes(3).round(4)
    array([0.0772, 0.4069])
    """
    place = "revchain.heavy_chain.nodes"
    return _core.heavy_chain_nodes(
        checked_count(place, "mode", mode), float(positive(place, "length", real(place, "length", length)))
    )


def vertical_points(mode: int, length: float = 1.0) -> Floats:
    """Return where a mode runs vertically: there the chain below has its centre of gravity on the axis.

    Parameters
    ----------
    mode : int
        Mode, counted from 1.
    length : float, optional
        Length of the chain, positive.

    Returns
    -------
    ndarray, shape (mode - 1,)
        Distances from the free end, ascending, within 5 ulp. Cost O(mode).

    Raises
    ------
    ValueError
        If `mode` is below 1 or `length` not positive and finite.

    Notes
    -----
    Greenhill (1908) section 4 (13), (14): zeros of J1.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.vertical_points(3).round(4)
    array([0.1961, 0.6572])
    """
    place = "revchain.heavy_chain.vertical_points"
    return _core.heavy_chain_vertical_points(
        checked_count(place, "mode", mode), float(positive(place, "length", real(place, "length", length)))
    )


def revolutions_per_second(count: int, length: ArrayLike = 1.0, gravity: ArrayLike = STANDARD_GRAVITY) -> Floats:
    """Return the turns in a second of the slowest modes.

    Parameters
    ----------
    count : int
        How many, at least 1.
    length : array_like, optional
        Length of the chain, positive.
    gravity : array_like, optional
        In the same unit of length per s^2, positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    ndarray, shape (..., count)
        In 1/s, ascending: ``R = N z / 2`` with `N` the turns in a second of the conical pendulum
        whose height is the length of the chain, within 6 ulp; `gravity` and `length`
        broadcast. Cost O(count).

    Raises
    ------
    ValueError
        If `count` is below 1, or a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 4 (11).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.revolutions_per_second(3, length=0.36).round(4)
    array([0.9988, 2.2927, 3.5942])
    """
    place = "revchain.heavy_chain.revolutions_per_second"
    g = positive(place, "gravity", gravity)
    long, g = together(place, length=positive(place, "length", length), gravity=g)
    heights = _core.heavy_chain_conical_heights(checked_count(place, "count", count), long)
    return _core.conical_pendulum_revolutions_per_second(heights, g[..., np.newaxis])
