# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="empty-body"
# The decorator of table.py gives each function its body, a call of the compiled formula, and completes its docstring.
"""An endless chain that runs in a circle (the rim of a wheel, a tyre), and the nearly straight whirling string.

Source: Greenhill (1908), section 5; numbers in brackets are its equations.
"""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY
from .table import FloatOrArray, closed_form

__all__ = ["WaveSpeeds", "speed", "string_revolutions_per_second", "tension", "wave_speeds"]


class WaveSpeeds(NamedTuple):
    """Speeds in space of the two waves on a rim: `standing`, against the rim, is 0; `running` is twice its speed.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.hoop.wave_speeds(20.0).standing)
    0.0
    """

    standing: FloatOrArray
    running: FloatOrArray


@closed_form(_core.hoop_tension, "3 ulp", "section 5 (6)")
def tension(speed: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> FloatOrArray:
    """Return the tension of a rim as a length, ``speed**2 / gravity``, for a circle of any radius.

    >>> float(rc.hoop.tension(20.0, gravity=10.0))
    40.0
    """


@closed_form(_core.hoop_speed, "3 ulp", "section 5 (3), (6)")
def speed(tension: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY) -> FloatOrArray:
    """Return the speed that gives a rim a tension, ``sqrt(gravity * tension)``.

    The breaking length gives the speed at which the rim bursts. Transverse waves on a string under that tension have the
    same speed.

    A tyre of steel wire with a breaking length of 27 km:

    >>> round(float(rc.hoop.speed(27e3)))
    515
    """


@closed_form(_core.hoop_wave_speeds, "exact", "section 5 (6)")
def wave_speeds(speed: ArrayLike) -> WaveSpeeds:
    """Return the speeds in space of both transverse waves on a rim.

    >>> float(rc.hoop.wave_speeds(20.0).running)
    40.0
    """


@closed_form(_core.hoop_string_revolutions_per_second, "3 ulp", "section 5 (3)")
def string_revolutions_per_second(
    span: ArrayLike, tension: ArrayLike, gravity: ArrayLike = STANDARD_GRAVITY
) -> FloatOrArray:
    """Return the turns per second of a nearly straight string that whirls in one half wave.

    span: Distance between the ends (twice the paper's ``a``)
    returns: ``sqrt(gravity * tension) / (2 * span)``.

    >>> round(float(rc.hoop.string_revolutions_per_second(2.0, tension=10.0, gravity=10.0)), 6)
    2.5
    """
