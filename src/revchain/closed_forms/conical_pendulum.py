# SPDX-License-Identifier: GPL-3.0-or-later
"""The conical pendulum: height, speed, period and gravity, each from the others.

Every height here is ``gravity / angular_speed**2``, the vertical distance of the circling weight
below the point of support, whatever the length of the thread. Source: Greenhill (1908), section 1.
All functions broadcast; numbers in give a number out.
"""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, positive, positives

__all__ = [
    "angular_speed",
    "gravity",
    "gravity_from_seconds_pendulum",
    "height",
    "height_from_period",
    "height_from_revolutions_per_second",
    "height_from_seconds_pendulum",
    "period",
    "revolutions_per_second",
]


def angular_speed(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the speed that goes with a height, ``sqrt(gravity / height)``.

    Parameters
    ----------
    height : array_like
        Conical height, positive.
    gravity : array_like, optional
        In the same unit of length per s^2, positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    float or ndarray
        In rad/s, broadcast shape, within 2.1 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (1).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.conical_pendulum.angular_speed(2.4525, gravity=9.81))
    2.0
    """
    place = "revchain.conical_pendulum.angular_speed"
    return _core.conical_pendulum_angular_speed(*positives(place, height=height, gravity=gravity))


def period(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the time of one turn, ``2 pi sqrt(height / gravity)``.

    Parameters
    ----------
    height : array_like
        Conical height, positive.
    gravity : array_like, optional
        In the same unit of length per s^2, positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    float or ndarray
        In seconds, broadcast shape, within 2.1 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (2).

    Examples
    --------
    The pendulum that beats seconds, in inches:

    >>> import revchain as rc
    >>> round(float(rc.conical_pendulum.period(39.1396, gravity=386.29237)), 6)
    2.0
    """
    place = "revchain.conical_pendulum.period"
    return _core.conical_pendulum_period(*positives(place, height=height, gravity=gravity))


def revolutions_per_second(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the turns in a second, ``sqrt(gravity / height) / (2 pi)``.

    Parameters
    ----------
    height : array_like
        Conical height, positive.
    gravity : array_like, optional
        In the same unit of length per s^2, positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    float or ndarray
        In 1/s, broadcast shape, within 2.1 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (2).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.conical_pendulum.revolutions_per_second([1.0, 0.25]).round(4)
    array([0.4984, 0.9968])
    """
    place = "revchain.conical_pendulum.revolutions_per_second"
    return _core.conical_pendulum_revolutions_per_second(*positives(place, height=height, gravity=gravity))


def height(angular_speed: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the height that goes with a speed, ``gravity / angular_speed**2``.

    Parameters
    ----------
    angular_speed : array_like
        In rad/s, positive.
    gravity : array_like, optional
        Positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    float or ndarray
        In the unit of length of `gravity`, broadcast shape, within 2.1 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (1).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.conical_pendulum.height(2.0, gravity=9.81))
    2.4525
    """
    place = "revchain.conical_pendulum.height"
    return _core.conical_pendulum_height(*positives(place, angular_speed=angular_speed, gravity=gravity))


def height_from_period(period: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the height that goes with a period, ``gravity * period**2 / (4 pi**2)``.

    Parameters
    ----------
    period : array_like
        Time of one turn in seconds, positive.
    gravity : array_like, optional
        Positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    float or ndarray
        In the unit of length of `gravity`, broadcast shape, within 2.1 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (1), (7).

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.conical_pendulum.height_from_period(2.0, gravity=386.29237)), 4)
    39.1396
    """
    place = "revchain.conical_pendulum.height_from_period"
    return _core.conical_pendulum_height_from_period(*positives(place, period=period, gravity=gravity))


def height_from_seconds_pendulum(seconds_pendulum: ArrayLike, period: ArrayLike) -> Any:
    """Return the height that goes with a period, in seconds pendulums: the form that needs no gravity.

    Parameters
    ----------
    seconds_pendulum : array_like
        Length of the simple pendulum that beats seconds at the place, positive.
    period : array_like
        Time of one turn in seconds, positive.

    Returns
    -------
    float or ndarray
        ``seconds_pendulum * period**2 / 4``, broadcast shape, within 2.1 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (7).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.conical_pendulum.height_from_seconds_pendulum(39.1396, period=2.0)
    39.1396
    """
    place = "revchain.conical_pendulum.height_from_seconds_pendulum"
    return _core.conical_pendulum_height_from_seconds_pendulum(
        *positives(place, seconds_pendulum=seconds_pendulum, period=period)
    )


def height_from_revolutions_per_second(
    revolutions_per_second: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY
) -> Any:
    """Return the height that goes with so many turns in a second.

    Parameters
    ----------
    revolutions_per_second : array_like
        In 1/s, positive.
    gravity : array_like, optional
        In the same unit of length per s^2 as the height, positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    float or ndarray
        ``gravity / (2 pi revolutions_per_second)**2``, broadcast shape, within 3 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (1).

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.conical_pendulum.height_from_revolutions_per_second(1.0)), 6)
    0.248405
    """
    place = "revchain.conical_pendulum.height_from_revolutions_per_second"
    return _core.conical_pendulum_height_from_revolutions_per_second(
        *positives(place, revolutions_per_second=revolutions_per_second, gravity=gravity)
    )


def gravity(length: ArrayLike, period: ArrayLike) -> Any:
    """Return the gravity under which a pendulum has a period, ``4 pi**2 length / period**2``.

    Parameters
    ----------
    length : array_like
        Length of the simple pendulum, positive.
    period : array_like
        Time of a small double swing in seconds, positive.

    Returns
    -------
    float or ndarray
        In the unit of `length` per s^2, broadcast shape, within 2.1 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (4).

    Examples
    --------
    >>> import revchain as rc
    >>> round(rc.conical_pendulum.gravity(0.99396, period=2.0), 4)
    9.81
    """
    return _core.conical_pendulum_gravity(*positives("revchain.conical_pendulum.gravity", length=length, period=period))


def gravity_from_seconds_pendulum(length: ArrayLike) -> Any:
    """Return the gravity under which a pendulum of this length beats seconds, ``pi**2 * length``.

    Parameters
    ----------
    length : array_like
        Length of the simple pendulum whose half period is one second, positive.

    Returns
    -------
    float or ndarray
        In the unit of `length` per s^2, within 2.1 ulp. Cost O(1) a number.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 1 (5), (6): 39.1396 inches at London.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.conical_pendulum.gravity_from_seconds_pendulum(39.1396)), 4)
    386.2924
    """
    place = "revchain.conical_pendulum.gravity_from_seconds_pendulum"
    return _core.conical_pendulum_gravity_from_seconds_pendulum(positive(place, "length", length))
