# SPDX-License-Identifier: GPL-3.0-or-later
"""One point mass (the paper's plummet) on threads: circling at any inclination, held by a second thread, carried round.

`height` is the conical height ``gravity / angular_speed**2`` of the motion. All lengths are in one unit; tensions are
divided by the weight; angles are in radians. All functions broadcast; single numbers give single numbers; cost O(1) a
number. A number that is not positive and finite raises a ValueError. Source: Greenhill (1908), section 1; its equations
in brackets.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import Floats, numbers, positives

__all__ = [
    "HeldPlummet", "InclinedPendulum", "air_resistance", "carried_inclinations", "carried_response", "held_plummet",
    "inclined_pendulum", "whirling_thread",
]


class InclinedPendulum(NamedTuple):
    """A circling point mass: inclination to the vertical (0 to pi/2), radius, depth below the support, tension."""

    inclination: Any
    radius: Any
    depth: Any
    tension: Any


class HeldPlummet(NamedTuple):
    """A point mass on two threads tied to the axis: distance from it, depth below the upper point, tensions.

    Where a thread is slack its tension is 0, and the mass circles on the other one.
    """

    radius: Any
    depth: Any
    upper_tension: Any
    lower_tension: Any
    upper_taut: Any
    lower_taut: Any


def inclined_pendulum(length: ArrayLike, height: ArrayLike) -> InclinedPendulum:
    """Return how a point mass on a thread circles at a given speed (1).

    Parameters
    ----------
    length, height : array_like
        Length of the thread and conical height, positive.

    Returns
    -------
    InclinedPendulum
        Broadcast shape, within 3 ulp. The thread is inclined where `height` is less than `length`, and `height` is then
        the depth; elsewhere it hangs vertically.

    Examples
    --------
    >>> import revchain as rc
    >>> swing = rc.plummet.inclined_pendulum(length=2.0, height=1.0)
    >>> round(float(swing.inclination), 6), float(swing.tension)
    (1.047198, 2.0)
    """
    place = "revchain.plummet.inclined_pendulum"
    return InclinedPendulum(*numbers(_core.inclined_pendulum(*positives(place, length=length, height=height))))


def held_plummet(
    upper_thread: ArrayLike, lower_thread: ArrayLike, distance: ArrayLike, height: ArrayLike
) -> HeldPlummet:
    """Return how a point mass circles that a second thread keeps from flying out farther (the polygon of forces).

    Parameters
    ----------
    upper_thread, lower_thread : array_like
        Their lengths, positive.
    distance : array_like
        How far the lower thread is tied to the axis below the upper one, positive.
    height : array_like
        Conical height, positive.

    Returns
    -------
    HeldPlummet
        Broadcast shape, within 3 ulp; where a depth or a tension nearly vanishes, within 1e-29 of the larger of the two
        terms whose difference it is. With D the depth where both threads are straight, the lower one is slack from
        ``height = D`` on, and the upper one up to ``height = D - distance``.

    Raises
    ------
    ValueError
        Also if the three lengths make no triangle.

    Examples
    --------
    >>> import revchain as rc
    >>> held = rc.plummet.held_plummet(1.0, 1.0, distance=1.2, height=0.3)
    >>> round(float(held.radius), 6), bool(held.lower_taut)
    (0.8, True)
    >>> slow = rc.plummet.held_plummet(1.0, 1.0, distance=1.2, height=0.8)  # the lower thread hangs in a bow
    >>> round(float(slow.radius), 6), float(slow.upper_tension), bool(slow.lower_taut)
    (0.6, 1.25, False)
    """
    place = "revchain.plummet.held_plummet"
    given = positives(place, upper_thread=upper_thread, lower_thread=lower_thread, distance=distance, height=height)
    radius, depth, upper, lower = numbers(_core.held_plummet(*given))
    return HeldPlummet(radius, depth, upper, lower, np.greater(upper, 0), np.greater(lower, 0))


def air_resistance(arm: ArrayLike, height: ArrayLike) -> Any:
    """Return the air resistance of the point mass of a whirling machine over its weight, ``arm / height`` (8).

    Parameters
    ----------
    arm, height : array_like
        Positive: the arm that carries the thread, perpendicular to the plane of axis and mass, and the conical height.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 0.5 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.plummet.air_resistance(arm=0.1, height=0.5))
    0.2
    """
    return _core.air_resistance(*positives("revchain.plummet.air_resistance", arm=arm, height=height))


def whirling_thread(arm: ArrayLike, height: ArrayLike, radius: ArrayLike) -> Any:
    """Return the thread for which the arm of a whirling machine is perpendicular to the plane of the mass, after (8).

    Parameters
    ----------
    arm, height, radius : array_like
        Positive: as in `air_resistance`, and the radius of the circle of the mass.

    Returns
    -------
    float or ndarray
        ``sqrt(arm**2 + height**2 + radius**2)``, broadcast shape, within 2 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.plummet.whirling_thread(arm=1.0, height=2.0, radius=2.0))
    3.0
    """
    return _core.whirling_thread(*positives("revchain.plummet.whirling_thread", **locals()))


def carried_response(length: ArrayLike, height: ArrayLike) -> Any:
    """Return the offset of the mass over that of its support, carried round or to and fro (base excitation) (9).

    Parameters
    ----------
    length, height : array_like
        Length of the thread and conical height of the motion of the support, positive.

    Returns
    -------
    float or ndarray
        ``height / (height - length)`` for small inclinations, broadcast shape, within 1.1 ulp: infinite at resonance,
        negative (in antiphase) above the resonant speed.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.plummet.carried_response(1.0, [3.0, 1.5, 0.5])
    array([ 1.5,  3. , -1. ])
    """
    return _core.carried_response(*positives("revchain.plummet.carried_response", length=length, height=height))


def carried_inclinations(length: ArrayLike, height: ArrayLike, radius: ArrayLike) -> Floats | list[Floats]:
    """Return all steady inclinations of a point mass whose support is carried round a circle.

    Parameters
    ----------
    length, height, radius : array_like
        Length of the thread, conical height, radius of the circle of the support; positive.

    Returns
    -------
    ndarray, or list of ndarray
        For numbers an array; for arrays a list with one array for each element of the broadcast shape, in C order. The
        roots of ``height tan d = radius + length sin d``, rad, ascending from -pi/2 to pi/2, outwards positive: one, or
        three where ``radius**(2/3) <= length**(2/3) - height**(2/3)``. Within 4 ulp, times
        ``1 / (1 - (cos at which two meet / cos of the root)**3)`` next to where two meet. Cost 1 microsecond a number.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.plummet.carried_inclinations(1.0, height=0.25, radius=0.1).round(4)
    array([-1.288 , -0.1341,  1.3421])
    """
    place = "revchain.plummet.carried_inclinations"
    given = positives(place, length=length, height=height, radius=radius)
    padded = np.stack(_core.carried_inclinations(*given), axis=-1)
    found = [row[~np.isnan(row)] for row in padded.reshape(-1, 3)]
    return found if padded.ndim > 1 else found[0]
