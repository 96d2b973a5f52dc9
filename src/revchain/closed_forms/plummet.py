# SPDX-License-Identifier: GPL-3.0-or-later
"""One point mass (the paper's plummet) on threads: circling at any inclination, held by a second thread, carried round.

`height` is the conical height ``gravity / angular_speed**2`` of the motion. All lengths are in one unit; tensions are
divided by the weight; angles are in radians. All functions broadcast; single numbers give single numbers. Cost: O(1) for
each number. A number that is not positive and finite raises a ValueError. Source: Greenhill (1908), section 1; numbers
in brackets are its equations.
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
    """A circling point mass: inclination to the vertical (0 to pi/2), radius, depth below the support, tension.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.plummet.inclined_pendulum(length=2.0, height=1.0).depth)
    1.0
    """

    inclination: Any
    radius: Any
    depth: Any
    tension: Any


class HeldPlummet(NamedTuple):
    """A point mass on two threads tied to the axis: radius, depth below the upper tie, tensions, and which are taut.

    A slack thread has tension 0; the mass then circles on the other thread.

    Examples
    --------
    >>> import revchain as rc
    >>> held = rc.plummet.held_plummet(1.0, 1.0, distance=1.2, height=0.3)
    >>> round(float(held.depth), 6), round(float(held.upper_tension), 6), round(float(held.lower_tension), 6)
    (0.6, 2.5, 0.833333)
    """

    radius: Any
    depth: Any
    upper_tension: Any
    lower_tension: Any
    upper_taut: Any
    lower_taut: Any


def inclined_pendulum(length: ArrayLike, height: ArrayLike) -> InclinedPendulum:
    """Return the steady motion of a point mass on a thread at a given speed (1).

    Parameters
    ----------
    length, height : array_like
        Length of the thread and conical height, positive.

    Returns
    -------
    InclinedPendulum
        Broadcast shape, within 3 ulp. If `height` is less than `length`, the thread is inclined and `height` is the
        depth; else the thread hangs vertically.

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
    """Return the steady motion of a point mass on two threads: the lower one limits the radius (polygon of forces).

    Parameters
    ----------
    upper_thread, lower_thread : array_like
        Lengths of the threads, positive.
    distance : array_like
        Distance along the axis from the tie of the upper thread down to that of the lower one, positive.
    height : array_like
        Conical height, positive.

    Returns
    -------
    HeldPlummet
        Broadcast shape, within 3 ulp; a depth or a tension that nearly vanishes is within 1e-29 of the larger of the two
        terms that it is the difference of. With D the depth at which both threads are straight, the lower thread is slack
        if ``height >= D``, and the upper one if ``height <= D - distance``.

    Raises
    ------
    ValueError
        If the three lengths do not form a triangle.

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
    """Return the air resistance of the mass of a whirling machine divided by its weight, ``arm / height`` (8).

    Parameters
    ----------
    arm, height : array_like
        Length of the arm that carries the thread, perpendicular to the plane of axis and mass, and conical height;
        positive.

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
    """Return the thread of a whirling machine whose arm is perpendicular to the plane of axis and mass (after (8)).

    Parameters
    ----------
    arm, height, radius : array_like
        Arm and conical height as in `air_resistance`, and radius of the circle of the mass; positive.

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
    """Return the offset of a point mass divided by that of its moving support (base excitation) (9).

    Parameters
    ----------
    length, height : array_like
        Length of the thread and conical height of the motion of the support, positive. The support moves in a circle or
        to and fro.

    Returns
    -------
    float or ndarray
        ``height / (height - length)`` for small inclinations, broadcast shape, within 1.1 ulp. It is infinite at
        resonance and negative (in antiphase) above the resonant speed.

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
        inclinations are the roots of ``height tan d = radius + length sin d``, rad, ascending from -pi/2 to pi/2, outwards
        positive. There is one, or three if ``radius**(2/3) <= length**(2/3) - height**(2/3)``. Accuracy: 4 ulp; where two
        roots nearly meet, times ``1 / (1 - (cos at which two meet / cos of the root)**3)``. Cost: 1 microsecond for each.

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
