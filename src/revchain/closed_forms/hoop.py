# SPDX-License-Identifier: GPL-3.0-or-later
"""An endless chain that runs round in a circle, the rim of a wheel, a tyre; the nearly straight string.

Tensions are given as the length of chain that weighs as much. Source: Greenhill (1908), section 5.
All functions broadcast; numbers in give a number out.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, numbers, positives

__all__ = ["WaveSpeeds", "speed", "string_revolutions_per_second", "tension", "wave_speeds"]


class WaveSpeeds(NamedTuple):
    """In space, of transverse waves on a rim that runs round.

    Attributes
    ----------
    standing : float or ndarray
        Of those that run against the rim: 0, so that they are seen.
    running : float or ndarray
        Of those that run with it: twice its speed.
    """

    standing: Any
    running: Any


def tension(speed: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the tension of a rim, ``speed**2 / gravity``, whatever the circle.

    Parameters
    ----------
    speed : array_like
        Along the rim, positive.
    gravity : array_like, optional
        In the same unit of length per s^2, positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    float or ndarray
        A length, broadcast shape, within 3 ulp.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 5 (6).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.hoop.tension(20.0, gravity=10.0))
    40.0
    """
    place = "revchain.hoop.tension"
    return _core.hoop_tension(*positives(place, speed=speed, gravity=gravity))


def speed(tension: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the speed of a rim under a tension, ``sqrt(gravity * tension)``.

    Parameters
    ----------
    tension : array_like
        A length, positive; the breaking length gives the speed at which the rim bursts.
    gravity : array_like, optional
        As in `tension`.

    Returns
    -------
    float or ndarray
        Also the speed of transverse waves along a string so stretched; broadcast shape, within 3 ulp.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 5 (3), (6): the speed of a fall through half the tension-length.

    Examples
    --------
    A tyre of steel wire, 27 km of which hang by themselves:

    >>> import revchain as rc
    >>> round(float(rc.hoop.speed(27e3)))
    515
    """
    place = "revchain.hoop.speed"
    return _core.hoop_speed(*positives(place, tension=tension, gravity=gravity))


def wave_speeds(speed: ArrayLike) -> WaveSpeeds:
    """Return how fast transverse waves run in space along a rim that runs round.

    Parameters
    ----------
    speed : array_like
        Of the rim, positive.

    Returns
    -------
    WaveSpeeds
        Each of the shape of `speed`, exact.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 5, after (6): relative to the rim both run with its own speed.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.hoop.wave_speeds(20.0).running)
    40.0
    """
    return WaveSpeeds(*numbers(_core.hoop_wave_speeds(*positives("revchain.hoop.wave_speeds", speed=speed))))


def string_revolutions_per_second(span: ArrayLike, tension: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the turns in a second of a nearly straight string whirling in one half wave.

    Parameters
    ----------
    span : array_like
        Distance of its ends, positive.
    tension : array_like
        As a length of string, positive.
    gravity : array_like, optional
        As in `tension`.

    Returns
    -------
    float or ndarray
        ``sqrt(gravity * tension) / (2 * span)``, also of its vibrations to and fro; broadcast
        shape, within 3 ulp.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 5 (3), whose ``a`` is half the span.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.hoop.string_revolutions_per_second(2.0, tension=10.0, gravity=10.0)), 6)
    2.5
    """
    place = "revchain.hoop.string_revolutions_per_second"
    return _core.hoop_string_revolutions_per_second(*positives(place, span=span, tension=tension, gravity=gravity))
