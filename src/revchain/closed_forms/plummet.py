# SPDX-License-Identifier: GPL-3.0-or-later
"""One plummet: swinging round at any inclination, held by a second thread, carried round by its support.

Heights are conical heights ``gravity / angular_speed**2`` and, like all lengths, in one unit of the
user's; tensions are over the plummet's weight. Source: Greenhill (1908), section 1. All functions
broadcast; numbers in give numbers out.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import Floats, numbers, positives

__all__ = [
    "HeldPlummet",
    "InclinedPendulum",
    "air_resistance",
    "carried_inclinations",
    "carried_response",
    "held_plummet",
    "inclined_pendulum",
    "whirling_thread",
]


class InclinedPendulum(NamedTuple):
    """Where a plummet swings round, and how its thread pulls.

    Attributes
    ----------
    inclination : float or ndarray
        To the vertical, rad, 0 to pi/2.
    radius : float or ndarray
        Of the circle.
    depth : float or ndarray
        Below the point of support.
    tension : float or ndarray
        Over the weight.
    """

    inclination: Any
    radius: Any
    depth: Any
    tension: Any


class HeldPlummet(NamedTuple):
    """A plummet on two threads tied to the axis.

    Attributes
    ----------
    radius : float or ndarray
        Distance from the axis.
    depth : float or ndarray
        Below the upper point.
    upper_tension : float or ndarray
        Over the weight.
    lower_tension : float or ndarray
        Over the weight.
    upper_taut : float or ndarray
        Whether the tension is not negative: else that thread is slack, and the plummet swings on the other.
    lower_taut : float or ndarray
        Likewise.
    """

    radius: Any
    depth: Any
    upper_tension: Any
    lower_tension: Any
    upper_taut: Any
    lower_taut: Any


def inclined_pendulum(length: ArrayLike, height: ArrayLike) -> InclinedPendulum:
    """Return how a plummet on a thread swings round at a given speed.

    It leaves the vertical where `height` is less than `length`; it then hangs at that depth.

    Parameters
    ----------
    length : array_like
        Of the thread, positive.
    height : array_like
        Conical height of the speed, positive.

    Returns
    -------
    InclinedPendulum
        Of the broadcast shape, within 3 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (1), section 6 (1).

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
    """Return how a plummet hangs that a second thread holds from flying out.

    Parameters
    ----------
    upper_thread, lower_thread : array_like
        Their lengths, positive.
    distance : array_like
        By how much the point of the axis that the lower one is tied to lies below the other, positive.
    height : array_like
        Conical height of the speed, positive.

    Returns
    -------
    HeldPlummet
        Of the broadcast shape, within 3 ulp; where a depth or a tension nearly vanishes, within 1e-29 of
        the larger of the two terms whose difference it is. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite, or the three lengths make no triangle.

    Notes
    -----
    Greenhill (1908) section 1, the polygon of forces. The lower thread is taut where the plummet,
    free of it, would fly out farther: ``depth >= height``.

    Examples
    --------
    >>> import revchain as rc
    >>> held = rc.plummet.held_plummet(1.0, 1.0, distance=1.2, height=0.3)
    >>> round(float(held.radius), 6), bool(held.lower_taut)
    (0.8, True)
    """
    place = "revchain.plummet.held_plummet"
    given = positives(
        place, upper_thread=upper_thread, lower_thread=lower_thread, distance=distance, height=height
    )
    radius, depth, upper, lower = numbers(_core.held_plummet(*given))
    return HeldPlummet(radius, depth, upper, lower, np.greater_equal(upper, 0), np.greater_equal(lower, 0))


def air_resistance(arm: ArrayLike, height: ArrayLike) -> Any:
    """Return the air's resistance to a plummet of the whirling machine over its weight.

    Parameters
    ----------
    arm : array_like
        Length of the arm from which the thread hangs, at right angles to the plane through axis and
        plummet; positive.
    height : array_like
        Conical height of the speed, positive.

    Returns
    -------
    float or ndarray
        ``arm / height``, broadcast shape, within 0.5 ulp.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (8).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.plummet.air_resistance(arm=0.1, height=0.5))
    0.2
    """
    return _core.air_resistance(*positives("revchain.plummet.air_resistance", arm=arm, height=height))


def whirling_thread(arm: ArrayLike, height: ArrayLike, radius: ArrayLike) -> Any:
    """Return the thread for which the arm of a whirling machine stands square to the plummet's plane.

    Parameters
    ----------
    arm, height : array_like
        As in `air_resistance`.
    radius : array_like
        Of the plummet's circle, positive.

    Returns
    -------
    float or ndarray
        ``sqrt(arm**2 + height**2 + radius**2)``, broadcast shape, within 2 ulp.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1, text after (8).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.plummet.whirling_thread(arm=1.0, height=2.0, radius=2.0))
    3.0
    """
    place = "revchain.plummet.whirling_thread"
    return _core.whirling_thread(*positives(place, arm=arm, height=height, radius=radius))


def carried_response(length: ArrayLike, height: ArrayLike) -> Any:
    """Return the plummet's offset over that of a support carried round or to and fro, nearly vertical.

    Parameters
    ----------
    length : array_like
        Of the thread, positive.
    height : array_like
        Conical height of the motion of the support, positive.

    Returns
    -------
    float or ndarray
        ``height / (height - length)``, broadcast shape, within 1.1 ulp: with the support above the
        resonance ``height = length``, where it is infinite, against it below.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (9).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.plummet.carried_response(1.0, [3.0, 1.5, 0.5])
    array([ 1.5,  3. , -1. ])
    """
    return _core.carried_response(*positives("revchain.plummet.carried_response", length=length, height=height))


def carried_inclinations(length: ArrayLike, height: ArrayLike, radius: ArrayLike) -> Floats | list[Floats]:
    """Return all steady inclinations of a plummet whose support is carried round a circle.

    Parameters
    ----------
    length : array_like
        Of the thread, positive.
    height : array_like
        Conical height of the speed, positive.
    radius : array_like
        Of the support's circle, positive.

    Returns
    -------
    ndarray, or list of ndarray
        Of numbers an array of the inclinations, of arrays a list with one for each element of the broadcast shape, in
        C order. Inclinations lie between -pi/2 and pi/2 rad, outwards positive, and ascend: one, or three where
        ``radius**(2/3) <= length**(2/3) - height**(2/3)``. Within 4 ulp, times
        ``1 / (1 - (cos at which two meet / cos of the root)**3)`` next to where two meet. Cost 1 microsecond a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    The roots of ``height tan d = radius + length sin d``; Greenhill (1908) section 1 (9) is their
    limit near the vertical.

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
