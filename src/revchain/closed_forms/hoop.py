# SPDX-License-Identifier: GPL-3.0-or-later
"""An endless chain that runs in a circle (the rim of a wheel, a tyre), and the nearly straight whirling string.

A tension is given as the length of chain of equal weight. `gravity` is in that unit of length per s^2; standard gravity
in m/s^2 if left out. All functions broadcast; single numbers give a single number. Cost: O(1) for each number. A number
that is not positive and finite raises a ValueError. Source: Greenhill (1908), section 5; numbers in brackets are its
equations.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, as_length, numbers, positives

__all__ = ["WaveSpeeds", "speed", "string_revolutions_per_second", "tension", "wave_speeds"]


class WaveSpeeds(NamedTuple):
    """Speeds in space of the two waves on a rim: `standing`, against the rim, is 0; `running`, with it, is twice its speed.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.hoop.wave_speeds(20.0).standing)
    0.0
    """

    standing: Any
    running: Any


def tension(speed: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the tension of a rim, ``speed**2 / gravity``, for a circle of any radius (6).

    Parameters
    ----------
    speed, gravity : array_like
        Speed along the rim, and gravity; positive.

    Returns
    -------
    float or ndarray
        Tension as a length, broadcast shape, within 3 ulp.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.hoop.tension(20.0, gravity=10.0))
    40.0
    """
    return _core.hoop_tension(*positives("revchain.hoop.tension", speed=speed, gravity=gravity))


def speed(tension: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the speed that gives a rim a tension, ``sqrt(gravity * tension)`` (3), (6).

    Parameters
    ----------
    tension, gravity : array_like
        Tension as a length, and gravity; positive. The breaking length gives the speed at which the rim bursts.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 3 ulp. It is also the speed of transverse waves on a string under that tension, and the
        speed after a fall through half the length `tension`.

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
    """Return the speeds in space of both transverse waves on a rim; relative to the rim both have its speed (6).

    Parameters
    ----------
    speed : array_like
        Speed of the rim, positive.

    Returns
    -------
    WaveSpeeds
        Arrays with the shape of `speed`, exact.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.hoop.wave_speeds(20.0).running)
    40.0
    """
    return WaveSpeeds(*numbers(_core.hoop_wave_speeds(*positives("revchain.hoop.wave_speeds", speed=speed))))


def string_revolutions_per_second(span: ArrayLike, tension: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> Any:
    """Return the turns per second of a nearly straight string that whirls in one half wave (3).

    Parameters
    ----------
    span, tension, gravity : array_like
        Distance between the ends (twice the paper's ``a``), tension as a length, and gravity; positive.

    Returns
    -------
    float or ndarray
        ``sqrt(gravity * tension) / (2 * span)``, broadcast shape, within 3 ulp. Planar vibrations have the same
        frequency.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.hoop.string_revolutions_per_second(2.0, tension=10.0, gravity=10.0)), 6)
    2.5
    """
    place = "revchain.hoop.string_revolutions_per_second"
    given = positives(place, span=span, tension=as_length(place, "tension", tension), gravity=gravity)
    return _core.hoop_string_revolutions_per_second(*given)
