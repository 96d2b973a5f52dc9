# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="empty-body"
# The decorator of table.py gives each function its body, a call of the compiled formula, and completes its docstring.
"""The conical pendulum: height, speed, period and gravity from one another.

The conical height is ``gravity / angular_speed**2``, the depth of the circling weight below its support.
Source: Greenhill (1908), section 1; numbers in brackets are its equations.
"""

from __future__ import annotations

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY
from .table import FloatOrArray, closed_form

__all__ = [
    "angular_speed", "gravity", "height", "height_from_period", "height_from_seconds_pendulum", "period",
    "revolutions_per_second",
]


@closed_form(_core.conical_pendulum_angular_speed, "2.1 ulp", "section 1 (1)")
def angular_speed(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> FloatOrArray:
    """Return the speed in rad/s at a conical height, ``sqrt(gravity / height)``.

    >>> float(rc.conical_pendulum.angular_speed(2.4525, gravity=9.81))
    2.0
    """


@closed_form(_core.conical_pendulum_period, "2.1 ulp", "section 1 (2)")
def period(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> FloatOrArray:
    """Return the time of one turn in s at a conical height, ``2 pi sqrt(height / gravity)``.

    The pendulum that beats seconds, in inches:

    >>> round(float(rc.conical_pendulum.period(39.1396, gravity=386.29237)), 6)
    2.0
    """


@closed_form(_core.conical_pendulum_revolutions_per_second, "2.1 ulp", "section 1 (2)")
def revolutions_per_second(height: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> FloatOrArray:
    """Return the turns per second at a conical height, ``sqrt(gravity / height) / (2 pi)``.

    >>> rc.conical_pendulum.revolutions_per_second([1.0, 0.25]).round(4)
    array([0.4984, 0.9968])
    """


@closed_form(_core.conical_pendulum_height, "2.1 ulp", "section 1 (1)")
def height(angular_speed: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> FloatOrArray:
    """Return the conical height of a speed, ``gravity / angular_speed**2``, in the unit of length of `gravity`.

    >>> float(rc.conical_pendulum.height(2.0, gravity=9.81))
    2.4525
    """


@closed_form(_core.conical_pendulum_height_from_period, "2.1 ulp", "section 1 (1), (7)")
def height_from_period(period: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> FloatOrArray:
    """Return the conical height of a period, ``gravity * period**2 / (4 pi**2)``, in the unit of length of `gravity`.

    >>> round(float(rc.conical_pendulum.height_from_period(2.0, gravity=386.29237)), 4)
    39.1396
    """


@closed_form(_core.conical_pendulum_height_from_seconds_pendulum, "2.1 ulp", "section 1 (7)")
def height_from_seconds_pendulum(seconds_pendulum: ArrayLike, period: ArrayLike) -> FloatOrArray:
    """Return the conical height of a period from the seconds pendulum, ``seconds_pendulum * period**2 / 4``.

    >>> rc.conical_pendulum.height_from_seconds_pendulum(39.1396, period=2.0)
    39.1396
    """


@closed_form(_core.conical_pendulum_gravity, "2.1 ulp", "section 1 (4)-(6)")
def gravity(length: ArrayLike, period: ArrayLike = 2.0) -> FloatOrArray:
    """Return the gravity that gives a simple pendulum its period, ``4 pi**2 length / period**2``.

    length: Length of the pendulum
    period: Period of small swings (there and back) in s, positive; 2 s if left out, for a pendulum that beats seconds.
    returns: Gravity in the unit of `length` per s^2.

    >>> rc.conical_pendulum.gravity([0.99396, 39.1396]).round(4)
    array([  9.81  , 386.2924])
    """
