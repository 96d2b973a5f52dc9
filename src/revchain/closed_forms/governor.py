# SPDX-License-Identifier: GPL-3.0-or-later
"""The governor: a rigid link hinged on a driven axis, free to swing in the plane that turns with the axis.

The closed form solves ``theta'' = n**2 sin(theta) cos(theta) - (g/l) sin(theta)`` from any start. Angles are in radians
from the downward vertical. Source: Greenhill (1908), section 7.
"""

from __future__ import annotations

from typing import NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Field
from ..systems.numbers import STANDARD_GRAVITY
from .solved import Solved
from .table import FloatOrArray, described


__all__ = ["GovernorMotion", "GovernorState"]


class GovernorState(NamedTuple):
    """Angle in rad (whole turns included) and its rate in rad/s."""

    angle: FloatOrArray
    angle_rate: FloatOrArray


@described(cost="2 microseconds, and 0.2 for each time", source="section 7 (1)-(13)")
class GovernorMotion(Solved):
    """The motion of a link hinged on a turning axis.

    angular_speed: Speed of the axis, rad/s; 0 for a pendulum that does not turn.
    pendulum_length: Length of the equivalent simple pendulum about the hinge
    gravity: Acceleration of gravity; negative for an inverted axis.
    raises: If a number is not finite, `pendulum_length` is not positive, or `axial_inertia` is not from 0 to 1; if
        numbers differ by a factor of 1e150 or more, so that no digit of the motion is correct.
    notes: Accuracy, measured against integration in quadruple precision: angles to 1e-13 of the greatest angle and of
        ``t`` times the greatest rate; rates to 1e-13 of the greatest rate and of ``t`` times the greatest
        acceleration. After 1e13 periods no digit is correct. Close to a motion that never returns, the rounding of
        the start to double limits the accuracy.

    >>> swing = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)
    >>> swing.regime, round(swing.period, 4), round(swing.least_angle, 4)
    ('aside', 1.442, 0.7759)
    """

    __slots__ = ()
    regime: Field[str] = Field(
        "``'rest'``, ``'aside'`` (dn), ``'asymptotic'`` (sech, sinh), ``'through'`` (cn) or ``'revolutions'`` (tn)."
    )
    period: Field[float] = Field(
        "Period of the motion (of one turn if it revolves), s; infinite if it never returns, 0 at rest."
    )
    least_angle: Field[float] = Field("Smallest angle of the motion, rad; minus infinity if it revolves.")
    greatest_angle: Field[float] = Field("Largest angle of the motion, rad; infinity if it revolves.")
    modulus: Field[float] = Field("Modulus of the elliptic functions.")
    complementary_modulus: Field[float] = Field(
        "Complementary modulus; it is more accurate than the modulus near motions that never return."
    )
    _solver = _core.GovernorMotion
    _row = "motion"

    def __init__(
        self, *, angular_speed: float, pendulum_length: float, angle: float, angle_rate: float = 0.0,
        gravity: float = STANDARD_GRAVITY, axial_inertia: float = 0.0,
    ) -> None:
        self._solve(locals())

    @described()
    def state(self, time: ArrayLike) -> GovernorState:
        """Return the angle and its rate.

        >>> swing = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)
        >>> swing.state([0.0, 0.3]).angle.round(4)
        array([1.5   , 1.2026])
        """
        return GovernorState(*self._at("state", "time", time))

    def _heading(self) -> str:
        return self.regime

    def _table(self) -> dict[str, str]:
        angles = {"least_angle": "least angle (°)", "greatest_angle": "greatest angle (°)"}
        return {"period": "period (s)", **angles, "modulus": "modulus", "complementary_modulus": "", "regime": ""}
