# SPDX-License-Identifier: GPL-3.0-or-later
"""The conical pendulum: height, speed, period and gravity from one another.

The conical height is ``gravity / angular_speed**2``: the depth of the circling weight below its support, for a thread of
any greater length. All functions broadcast; single numbers give a single number. Cost: O(1) for each number. A number
that is not positive and finite raises a ValueError. `gravity` is in the unit of length of the heights per s^2; standard
gravity in m/s^2 if left out. Source: Greenhill (1908), section 1; numbers in brackets are its equations.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, positives

__all__ = [
    "angular_speed", "gravity", "height", "height_from_period", "height_from_seconds_pendulum", "period",
    "revolutions_per_second",
]


def angular_speed(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the speed at a conical height, ``sqrt(gravity / height)`` (1).

    Parameters
    ----------
    height, gravity : array_like
        Positive.

    Returns
    -------
    float or ndarray
        In rad/s, broadcast shape, within 2.1 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.conical_pendulum.angular_speed(2.4525, gravity=9.81))
    2.0
    """
    return _core.conical_pendulum_angular_speed(*positives("revchain.conical_pendulum.angular_speed", **locals()))


def period(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the time of one turn at a conical height, ``2 pi sqrt(height / gravity)`` (2).

    Parameters
    ----------
    height, gravity : array_like
        Positive.

    Returns
    -------
    float or ndarray
        In seconds, broadcast shape, within 2.1 ulp.

    Examples
    --------
    The pendulum that beats seconds, in inches:

    >>> import revchain as rc
    >>> round(float(rc.conical_pendulum.period(39.1396, gravity=386.29237)), 6)
    2.0
    """
    return _core.conical_pendulum_period(*positives("revchain.conical_pendulum.period", height=height, gravity=gravity))


def revolutions_per_second(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the turns per second at a conical height, ``sqrt(gravity / height) / (2 pi)`` (2).

    Parameters
    ----------
    height, gravity : array_like
        Positive.

    Returns
    -------
    float or ndarray
        In 1/s, broadcast shape, within 2.1 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.conical_pendulum.revolutions_per_second([1.0, 0.25]).round(4)
    array([0.4984, 0.9968])
    """
    place = "revchain.conical_pendulum.revolutions_per_second"
    return _core.conical_pendulum_revolutions_per_second(*positives(place, height=height, gravity=gravity))


def height(angular_speed: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the conical height of a speed, ``gravity / angular_speed**2`` (1).

    Parameters
    ----------
    angular_speed, gravity : array_like
        Positive; the speed in rad/s, or a text such as "30 rpm" or "0.5 Hz".

    Returns
    -------
    float or ndarray
        In the unit of length of `gravity`, broadcast shape, within 2.1 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.conical_pendulum.height(2.0, gravity=9.81))
    2.4525
    """
    return _core.conical_pendulum_height(*positives("revchain.conical_pendulum.height", **locals()))


def height_from_period(period: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the conical height of a period, ``gravity * period**2 / (4 pi**2)`` (1), (7).

    Parameters
    ----------
    period, gravity : array_like
        Positive; the time of one turn in seconds.

    Returns
    -------
    float or ndarray
        In the unit of length of `gravity`, broadcast shape, within 2.1 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.conical_pendulum.height_from_period(2.0, gravity=386.29237)), 4)
    39.1396
    """
    place = "revchain.conical_pendulum.height_from_period"
    return _core.conical_pendulum_height_from_period(*positives(place, period=period, gravity=gravity))


def height_from_seconds_pendulum(seconds_pendulum: ArrayLike, period: ArrayLike) -> Any:
    """Return the conical height of a period from the seconds pendulum, ``seconds_pendulum * period**2 / 4`` (7).

    Parameters
    ----------
    seconds_pendulum, period : array_like
        Length of the simple pendulum that beats seconds at the place, and time of one turn in seconds; positive.

    Returns
    -------
    float or ndarray
        In the unit of `seconds_pendulum`, broadcast shape, within 2.1 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.conical_pendulum.height_from_seconds_pendulum(39.1396, period=2.0)
    39.1396
    """
    place = "revchain.conical_pendulum.height_from_seconds_pendulum"
    given = positives(place, seconds_pendulum=seconds_pendulum, period=period)
    return _core.conical_pendulum_height_from_seconds_pendulum(*given)


def gravity(length: ArrayLike, period: ArrayLike = 2.0) -> Any:
    """Return the gravity that gives a simple pendulum its period, ``4 pi**2 length / period**2`` (4)-(6).

    Parameters
    ----------
    length, period : array_like
        Length of the pendulum, and period of small swings (there and back) in seconds; positive. The period is 2 s if
        left out: such a pendulum beats seconds, and the paper gives its length in London as 39.1396 inches.

    Returns
    -------
    float or ndarray
        In the unit of `length` per s^2, broadcast shape, within 2.1 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.conical_pendulum.gravity([0.99396, 39.1396]).round(4)
    array([  9.81  , 386.2924])
    """
    return _core.conical_pendulum_gravity(*positives("revchain.conical_pendulum.gravity", length=length, period=period))
