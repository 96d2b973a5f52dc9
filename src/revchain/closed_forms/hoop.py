# SPDX-License-Identifier: GPL-3.0-or-later
"""An endless chain that runs round in a circle, the rim of a wheel, a tyre; the nearly straight whirling string.

Tensions are given as the length of chain that weighs as much; `gravity` is in that unit per s^2, and the standard
gravity in m/s^2 if left out. All functions broadcast; single numbers give a single number. A number that is not
positive and finite raises a ValueError. Source: Greenhill (1908), section 5; its equations in brackets.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, as_length, numbers, positives

__all__ = ["WaveSpeeds", "speed", "string_revolutions_per_second", "tension", "wave_speeds"]


class WaveSpeeds(NamedTuple):
    """Speeds in space of the waves against the rim, 0: they are seen standing; and with it: twice its speed."""

    standing: Any
    running: Any


def tension(speed: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the tension of a rim, ``speed**2 / gravity``, whatever the circle (6).

    Parameters
    ----------
    speed, gravity : array_like
        Positive; the speed along the rim.

    Returns
    -------
    float or ndarray
        A length, broadcast shape, within 3 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.hoop.tension(20.0, gravity=10.0))
    40.0
    """
    return _core.hoop_tension(*positives("revchain.hoop.tension", speed=speed, gravity=gravity))


def speed(tension: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the speed of a rim under a tension, ``sqrt(gravity * tension)`` (3), (6).

    Parameters
    ----------
    tension, gravity : array_like
        Positive; the breaking length gives the speed at which the rim bursts.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 3 ulp. Also the speed of transverse waves on a string under that tension, and that of a
        fall through half the length `tension`.

    Examples
    --------
    A tyre of steel wire with a breaking length of 27 km:

    >>> import revchain as rc
    >>> round(float(rc.hoop.speed(27e3)))
    515
    """
    place = "revchain.hoop.speed"
    return _core.hoop_speed(*positives(place, tension=as_length(place, "tension", tension), gravity=gravity))


def wave_speeds(speed: ArrayLike) -> WaveSpeeds:
    """Return the speeds in space of transverse waves on a rim that runs round; relative to it both have its own (6).

    Parameters
    ----------
    speed : array_like
        Of the rim, positive.

    Returns
    -------
    WaveSpeeds
        Each of the shape of `speed`, exact.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.hoop.wave_speeds(20.0).running)
    40.0
    """
    return WaveSpeeds(*numbers(_core.hoop_wave_speeds(*positives("revchain.hoop.wave_speeds", speed=speed))))


def string_revolutions_per_second(span: ArrayLike, tension: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the turns per second of a nearly straight string whirling in one half wave (3).

    Parameters
    ----------
    span, tension, gravity : array_like
        Positive; `span` is the distance of the ends, twice the paper's ``a``.

    Returns
    -------
    float or ndarray
        ``sqrt(gravity * tension) / (2 * span)``, broadcast shape, within 3 ulp; the frequency of planar vibrations too.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.hoop.string_revolutions_per_second(2.0, tension=10.0, gravity=10.0)), 6)
    2.5
    """
    place = "revchain.hoop.string_revolutions_per_second"
    given = positives(place, span=span, tension=as_length(place, "tension", tension), gravity=gravity)
    return _core.hoop_string_revolutions_per_second(*given)
