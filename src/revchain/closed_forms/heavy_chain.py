# SPDX-License-Identifier: GPL-3.0-or-later
"""The uniform continuous chain at small amplitude: the limit of many small links, in Bessel functions.

A perfectly flexible chain whirls in mode `k`, counted from 1, at the conical height ``4 * length / z**2``, `z` the
`k`-th zero of J0, in the shape ``J0(2 sqrt(x / height))``, `x` from 0 at the free end to `length`. Its tension, as the
length of chain that weighs as much, is `x`. With a point mass at the free end: `revchain.tip_mass`; of varying density:
`revchain.tapered_chain`. Array arguments broadcast; numbers out of their range raise a ValueError. Source: Greenhill
(1908), section 4; its equations in brackets.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, Floats, beside, counts, one_positive, places, positive, together
from ..systems.numbers import count as checked_count

__all__ = ["conical_heights", "kinetic_energy", "nodes", "revolutions_per_second", "shape", "slope", "vertical_points"]


def conical_heights(count: int, length: ArrayLike = 1.0) -> Floats:
    """Return the conical heights of the slowest modes (10), (12).

    Parameters
    ----------
    count : int
        How many, at least 1.
    length : array_like, optional
        Positive, any shape.

    Returns
    -------
    ndarray, shape (..., count)
        Descending, in the unit of `length`, within 3 ulp. Cost O(count).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.conical_heights(3).round(6)
    array([0.69166 , 0.131271, 0.053414])
    """
    place = "revchain.heavy_chain.conical_heights"
    number = checked_count(place, "count", count, each=8)
    return _core.heavy_chain_conical_heights(number, positive(place, "length", length))


def revolutions_per_second(count: int, length: ArrayLike = 1.0, gravity: ArrayLike = STANDARD_GRAVITY) -> Floats:
    """Return the turns per second of the slowest modes, ``sqrt(gravity / height) / (2 pi)`` (11).

    Parameters
    ----------
    count : int
        How many, at least 1.
    length, gravity : array_like, optional
        Positive, gravity in the unit of `length` per s^2; standard gravity in m/s^2 if left out.

    Returns
    -------
    ndarray, shape (..., count)
        In 1/s, ascending, within 4 ulp. Cost O(count).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.revolutions_per_second(3, length=0.36).round(4)
    array([0.9988, 2.2927, 3.5942])
    """
    place = "revchain.heavy_chain.revolutions_per_second"
    given = {"length": positive(place, "length", length), "gravity": positive(place, "gravity", gravity)}
    long, g = together(place, **given)
    heights = _core.heavy_chain_conical_heights(checked_count(place, "count", count, each=8), long)
    return _core.conical_pendulum_revolutions_per_second(heights, g[..., np.newaxis])


def shape(x: ArrayLike, mode: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return the offset of the chain from its axis, 1 at the free end: ``J0(z sqrt(x / length))`` (9).

    Parameters
    ----------
    x : array_like
        Distance from the free end, 0 to `length`.
    mode : array_like of int
        From 1.
    length : array_like, optional
        Positive.

    Returns
    -------
    float or ndarray
        Broadcast shape; absolute error below 1e-15 times the mode. Cost O(1) a number.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.shape([0.0, 0.5, 1.0], mode=1).round(4) + 0.0
    array([1.    , 0.3977, 0.    ])
    """
    place = "revchain.heavy_chain.shape"
    return _core.heavy_chain_shape(*places(place, x, mode, length=positive(place, "length", length)))


def slope(x: ArrayLike, mode: ArrayLike, length: ArrayLike = 1.0) -> Any:
    """Return ``d offset / dx`` of `shape`: ``-J1(z) / sqrt(x height)``, ``z = 2 sqrt(x / height)`` (9).

    Parameters
    ----------
    x, mode, length : array_like
        As in `shape`.

    Returns
    -------
    float or ndarray
        Broadcast shape, ``-1 / height`` at the free end; absolute error below 1e-15 times the mode, over the height.
        Cost O(1) a number.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.slope([0.0, 0.5, 1.0], mode=1).round(4)
    array([-1.4458, -0.9825, -0.6242])
    """
    place = "revchain.heavy_chain.slope"
    return _core.heavy_chain_slope(*places(place, x, mode, length=positive(place, "length", length)))


def kinetic_energy(mode: ArrayLike, amplitude: ArrayLike = 1.0) -> Any:
    """Return the kinetic energy of the steady whirl, equal to the potential energy, over the weight per length.

    Parameters
    ----------
    mode : array_like of int
        From 1.
    amplitude : array_like, optional
        Offset of the free end, positive.

    Returns
    -------
    float or ndarray
        To the second order in the offsets ``(amplitude z J1(z))**2 / 8``, `z` the zero of J0, whatever the length:
        half the integral of ``offset**2 dx / height``, and half that of ``x slope**2 dx``, the gain of potential energy.
        Follows from (9); the paper does not give it. Within 1e-15 of it, times 1 + mode.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.kinetic_energy([1, 2, 3], amplitude=0.1).round(6)
    array([0.001948, 0.00441 , 0.006898])
    """
    place = "revchain.heavy_chain.kinetic_energy"
    given = {"mode": counts(place, "mode", mode), "amplitude": positive(place, "amplitude", amplitude)}
    return _core.heavy_chain_energy(*beside(place, **given))


def nodes(mode: int, length: float = 1.0) -> Floats:
    """Return where a mode crosses the axis (12).

    Parameters
    ----------
    mode : int
        From 1.
    length : float, optional
        Positive.

    Returns
    -------
    ndarray, shape (mode - 1,)
        Distances from the free end, ascending, without the support, within 5 ulp. Cost O(mode).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.nodes(3).round(4)
    array([0.0772, 0.4069])
    """
    place = "revchain.heavy_chain.nodes"
    return _core.heavy_chain_nodes(checked_count(place, "mode", mode, each=8), one_positive(place, "length", length))


def vertical_points(mode: int, length: float = 1.0) -> Floats:
    """Return where a mode runs vertically: there the chain below has its centre of gravity on the axis (13), (14).

    Parameters
    ----------
    mode : int
        From 1.
    length : float, optional
        Positive.

    Returns
    -------
    ndarray, shape (mode - 1,)
        Distances from the free end, ascending, within 5 ulp: zeros of J1. Cost O(mode).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.heavy_chain.vertical_points(3).round(4)
    array([0.1961, 0.6572])
    """
    place = "revchain.heavy_chain.vertical_points"
    number = checked_count(place, "mode", mode, each=8)
    return _core.heavy_chain_vertical_points(number, one_positive(place, "length", length))
