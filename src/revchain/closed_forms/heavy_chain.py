# SPDX-License-Identifier: GPL-3.0-or-later
"""The continuous chain: the limit of many small links, in Bessel functions.

A uniform, perfectly flexible chain of a given length whirls in mode `k` at the conical height
``4 * length / z**2``, `z` the `k`-th zero of J0, in the shape ``J0(2 sqrt(x / height))``, `x`
measured from the free end. Source: Greenhill (1908), section 4. Modes are counted from 1.
With a particle at the free end: `revchain.tip_mass`; of varying density: `revchain.tapered_chain`.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, Floats, counts, one_positive, places, positive, together
from ..systems.numbers import count as checked_count

__all__ = [
    "conical_heights",
    "kinetic_energy",
    "nodes",
    "potential_energy",
    "revolutions_per_second",
    "shape",
    "slope",
    "tension",
    "vertical_points",
]


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
        Descending, in the unit of `length`, within 3 ulp. Cost O(count).

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
    number = checked_count(place, "count", count, each=8)
    return _core.heavy_chain_conical_heights(number, positive(place, "length", length))


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
    return _core.heavy_chain_shape(*places(place, x, mode, length=positive(place, "length", length)))


def slope(x: ArrayLike, mode: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return ``d offset / dx`` of the chain whose offset is 1 at the free end.

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
        ``-J1(z) / sqrt(x height)``, ``z = 2 sqrt(x / height)``; at the free end ``-1 / height``.
        Broadcast shape; absolute error below 1e-15 times the mode, over the height. Cost O(1) a number.

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
    >>> rc.heavy_chain.slope([0.0, 0.5, 1.0], mode=1).round(4)
    array([-1.4458, -0.9825, -0.6242])
    """
    place = "revchain.heavy_chain.slope"
    return _core.heavy_chain_slope(*places(place, x, mode, length=positive(place, "length", length)))


def tension(x: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return the tension, as the length of chain that weighs as much, to the first order in the offsets.

    Parameters
    ----------
    x : array_like
        Distance from the free end, from 0 to `length`.
    length : array_like, optional
        Length of the chain, positive.

    Returns
    -------
    float or ndarray
        `x` itself, in the broadcast shape: what hangs below.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Greenhill (1908) section 4 (1).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.tension([0.0, 0.25], length=0.5)
    array([0.  , 0.25])
    """
    place = "revchain.heavy_chain.tension"
    return places(place, x, 1, length=positive(place, "length", length))[0].copy()[()]


def _energy(place: str, mode: ArrayLike, amplitude: ArrayLike) -> Any:
    number = counts(place, "mode", mode)
    return _core.heavy_chain_energy(
        *together(place, mode=number, amplitude=positive(place, "amplitude", amplitude))
    )


def kinetic_energy(mode: ArrayLike, amplitude: ArrayLike = 1.0) -> Any:
    """Return the kinetic energy of the steady whirl, over the weight per length, to the second order.

    Parameters
    ----------
    mode : array_like of int
        Mode, counted from 1.
    amplitude : array_like, optional
        Offset of the free end, positive.

    Returns
    -------
    float or ndarray
        ``(1 / (2 height))`` times the integral of ``offset**2 dx``, which is ``(amplitude z J1(z))**2 / 8``,
        `z` the zero of J0, whatever the length. Within 1e-15 of it, times 1 + mode.

    Raises
    ------
    ValueError
        If `mode` is below 1 or not whole, or `amplitude` not positive and finite.

    Notes
    -----
    Follows from Greenhill (1908) section 4 (9); the paper does not give it.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.kinetic_energy([1, 2, 3], amplitude=0.1).round(6)
    array([0.001948, 0.00441 , 0.006898])
    """
    return _energy("revchain.heavy_chain.kinetic_energy", mode, amplitude)


def potential_energy(mode: ArrayLike, amplitude: ArrayLike = 1.0) -> Any:
    """Return the potential energy of the steady whirl over the hanging chain's, over the weight per length.

    Parameters
    ----------
    mode : array_like of int
        Mode, counted from 1.
    amplitude : array_like, optional
        Offset of the free end, positive.

    Returns
    -------
    float or ndarray
        Half the integral of ``x slope**2 dx``: to the second order the same number as `kinetic_energy`.

    Raises
    ------
    ValueError
        If `mode` is below 1 or not whole, or `amplitude` not positive and finite.

    Notes
    -----
    Follows from Greenhill (1908) section 4 (9); the paper does not give it.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.potential_energy(1) == rc.heavy_chain.kinetic_energy(1)
    True
    """
    return _energy("revchain.heavy_chain.potential_energy", mode, amplitude)


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
    return _core.heavy_chain_nodes(checked_count(place, "mode", mode, each=8), one_positive(place, "length", length))


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
    number = checked_count(place, "mode", mode, each=8)
    return _core.heavy_chain_vertical_points(number, one_positive(place, "length", length))


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
        whose height is the length of the chain, within 4 ulp; `gravity` and `length`
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
    heights = _core.heavy_chain_conical_heights(checked_count(place, "count", count, each=8), long)
    return _core.conical_pendulum_revolutions_per_second(heights, g[..., np.newaxis])
