# SPDX-License-Identifier: GPL-3.0-or-later
"""Centrifugal governors with a sleeve: Watt's, Porter's, Hartnell's. Units are SI.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..results.base import Field, Listed, Result, asked_in
from ..results.sheet import Column, Sheet, speed_text
from ..systems.numbers import STANDARD_GRAVITY, Floats, floats, numbers, one_positive, real
from ..systems.units import speed_unit
from .solved import Solved
from .table import FloatOrArray, described

__all__ = ["GovernorEffort", "GovernorEquilibria", "GovernorPoints", "SleeveGovernor"]
_STOPS = ("lowest_inclination", "highest_inclination")
_ROWS = 9  # of the table
_IN_WORDS = {
    "pivot_offset": "pivots {:g} m off the axis",
    "lower_arm": "lower links of {:g} m",
    "sleeve_arm": "sleeve arms of {:g} m",
    "sleeve_mass": "sleeve of {:g} kg",
    "spring_stiffness": "spring of {:g} N/m",
    "spring_force": "spring force {:g} N",
    "friction": "friction {:g} N",
    "shaft_inertia": "free shaft of {:g} kg m^2",
}


class GovernorPoints(NamedTuple):
    """A governor at one or more inclinations of its arms.

    `inclination`: of the arms, rad, outwards from the downward vertical (Hartnell's: upward). `angular_speed`: of
    equilibrium, rad/s; NaN or infinite if there is none. `low_speed`, `high_speed`: between these friction holds the
    sleeve. `ball_radius`: distance of the balls from the axis, m. `height`: from the balls up (Hartnell's: down) to where
    their arms meet the axis, m. `lift`: of the sleeve, from inclination 0, m. `stable`: whether the arms return when
    disturbed at constant speed. `period`: of small oscillations, s; NaN if they grow.
    """

    inclination: FloatOrArray
    angular_speed: FloatOrArray
    low_speed: FloatOrArray
    high_speed: FloatOrArray
    ball_radius: FloatOrArray
    height: FloatOrArray
    lift: FloatOrArray
    stable: bool | NDArray[np.bool_]
    period: FloatOrArray


class GovernorEffort(NamedTuple):
    """The effort and power of a governor at a change of speed.

    `effort`: mean force at the sleeve, N. `lift`: of the sleeve to its new position, m; NaN if there is none. `power`:
    effort times lift, J.
    """

    effort: float
    lift: float
    power: float


_STABLE = "stable: the arms return when disturbed at constant speed"


class GovernorEquilibria(Result, Listed[GovernorPoints], row="point", title="{summary}", notes=(_STABLE,)):
    """All equilibria of a governor at one speed: a sequence of `GovernorPoints`; returned by `SleeveGovernor.equilibria`.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.SleeveGovernor(ball_mass=4.0, arm=1.4, lower_arm=1.4, sleeve_mass=3.0, gravity=12.0).equilibria(5.0)
    2 equilibria at 5.00000 rad/s (47.75 rpm), proved complete
    inclination (°)  lift (m)  balls off axis (m)  stable  period (s)
             0.0000    0.0000              0.0000      no         nan
             53.130    1.1200              1.1200     yes      2.1991
    stable: the arms return when disturbed at constant speed
    """

    __slots__ = ()
    governor: Field[SleeveGovernor] = Field("The governor.")
    angular_speed: Field[float] = Field("Speed of the shaft, rad/s.", fact=True)
    inclination: Field[Floats] = Field(
        "Inclinations of the arms, rad, shape (E,).", heading="inclination", unit="rad", digits=5
    )
    lift: Field[Floats] = Field("Lift of the sleeve from inclination 0, m, shape (E,).", heading="lift", unit="m", digits=5)
    ball_radius: Field[Floats] = Field(
        "Distance of the balls from the axis, m, shape (E,).", heading="balls off axis", unit="m", digits=5
    )
    stable: Field[NDArray[np.bool_]] = Field(
        "Whether the arms return when disturbed at constant speed, shape (E,).", heading="stable"
    )
    period: Field[Floats] = Field(
        "Period of small oscillations, s, shape (E,); NaN if they grow.", heading="period", unit="s", digits=5
    )
    height: Field[Floats] = Field(
        "Distance from the balls up (Hartnell's: down) to where their arms meet the axis, m, shape (E,).", axes=(), unit="m"
    )
    low_speed: Field[Floats] = Field(
        "Lowest speed at which friction holds the sleeve there, rad/s, shape (E,); 0 if also at rest.", axes=(), unit="rad/s"
    )
    high_speed: Field[Floats] = Field(
        "Highest speed at which friction holds the sleeve there, rad/s, shape (E,).", axes=(), unit="rad/s"
    )
    summary: Field[str] = Field("What was found, in words.", lambda e: e._words())

    def _sheet(self, brief: bool = False) -> Sheet:
        sheet = super()._sheet(brief)
        return sheet if brief else replace(sheet, facts={**sheet.facts, "governor": self.governor._facts()})

    @property
    def _items(self) -> tuple[GovernorPoints, ...]:
        columns = [np.broadcast_to(getattr(self, name), self.inclination.shape).tolist() for name in GovernorPoints._fields]
        return tuple([GovernorPoints(*row) for row in zip(*columns, strict=True)])

    def _words(self) -> str:
        count, speed = self.inclination.size, self.angular_speed
        what = f"{count} equilibri{'um' if count == 1 else 'a'}"
        at = f"{speed:#.6g} rad/s ({speed * 30 / math.pi:.2f} rpm)"
        if speed and self._speed_unit in ("rpm", "Hz", "s"):
            at = speed_text(speed, self._speed_unit)
        return f"{what} at {at}, proved complete"


def _speed(name: str) -> Any:
    return lambda governor: float(governor._at_stops[name])


@described(cost="0.1 microseconds for each point, 0.2 ms for the equilibria at a speed", source="section 7")
class SleeveGovernor(Solved, row="point"):
    """A governor whose balls lift a sleeve on a turning shaft.

    With only balls and arms it is a conical pendulum.

    ball_mass: Mass of each ball, kg
    arm: Distance from the pivot of an arm to its ball, m
    balls: Number of balls
    pivot_offset: Distance of the pivots from the axis, m; negative if the arms cross
    lower_arm: Length of the links that carry the sleeve, m
    joint: Distance from the pivot to the joint of the lower link, m; 0: at the ball
    sleeve_offset: Distance of the lower links' pivots from the axis, m
    sleeve_arm: Hartnell: levers with the ball on one arm and the sleeve at the other, of this length, at right angles;
        instead of `lower_arm`. Inclination 0 is then the ball's arm upright
    sleeve_mass: Mass of the sleeve, kg
    spring_stiffness: Stiffness of a spring that presses the sleeve down, N/m
    spring_force: Force of that spring at inclination 0, N
    friction: Force with which the sleeve resists, either way, N
    shaft_inertia: Moment of inertia of a shaft that turns freely, kg m^2; infinite: its speed is constant
    lowest_inclination: Inclination at the lower stop, rad, or a text such as "25 deg"
    highest_inclination: Inclination at the upper stop
    raises: If a number is out of its range, the parts do not fit together, the arms do not reach a stop, or only one stop
        is given.
    notes: Accuracy, measured against the forces in the links on 10,000 random governors: 1e-12 of the square of the speed.

    >>> import math
    >>> watt = rc.SleeveGovernor(ball_mass=4.0, arm=1.4, lower_arm=1.4, sleeve_mass=3.0, gravity=12.0)
    >>> hanging, open = watt.equilibria(5.0)
    >>> round(math.cos(open.inclination), 12), round(open.period / math.pi, 12), open.stable
    (0.6, 0.7, True)
    """

    __slots__ = ()
    _solver = _core.SleeveGovernor
    _optional = _STOPS
    lowest_speed: Field[float] = Field("Speed of equilibrium at the lower stop, rad/s; NaN without stops.", _speed("lowest_speed"))
    highest_speed: Field[float] = Field("Speed of equilibrium at the upper stop, rad/s; NaN without stops.", _speed("highest_speed"))
    lift: Field[float] = Field("Lift of the sleeve between the stops, m; NaN without stops.", _speed("lift"))
    sensitiveness: Field[float] = Field(
        "Difference of the speeds at the stops over their mean: small in a sensitive governor, 0 in an isochronous one; NaN "
        "without stops.",
        lambda g: 2 * (g.highest_speed - g.lowest_speed) / (g.highest_speed + g.lowest_speed),
    )
    insensitiveness: Field[float] = Field(
        "Width of the band of speeds in which friction holds the sleeve, over the speed of equilibrium, at the middle "
        "between the stops; NaN without stops.",
        _speed("insensitiveness"),
    )

    def __init__(
        self, *, ball_mass: float, arm: float, balls: int = 2, pivot_offset: float = 0.0, lower_arm: float = 0.0,
        joint: float = 0.0, sleeve_offset: float = 0.0, sleeve_arm: float = 0.0, sleeve_mass: float = 0.0,
        spring_stiffness: float = 0.0, spring_force: float = 0.0, friction: float = 0.0, shaft_inertia: float = math.inf,
        lowest_inclination: float | None = None, highest_inclination: float | None = None,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        self._solve(locals())
        low, high = (self._given[name] for name in _STOPS)
        if (low is None) != (high is None):
            raise ValueError("revchain.SleeveGovernor: give both lowest_inclination and highest_inclination, or neither")
        if low is not None:
            if not low < high:
                raise ValueError(f"revchain.SleeveGovernor: lowest_inclination must be below highest_inclination, got {low:g} and {high:g}")
            self.at([low, high])

    def _from_parts(self) -> Any:
        given = {name: value for name, value in self._given.items() if name not in _STOPS}
        balls = given.pop("balls")
        if not (1 <= balls <= 1000 and balls == int(balls)):
            raise ValueError(f"revchain.SleeveGovernor: balls must be a whole number from 1 to 1000, got {balls:g}")
        return self._solver(balls=int(balls), **given)

    @property
    def _at_stops(self) -> dict[str, float]:
        low, high = (self._given[name] for name in _STOPS)
        if low is None:
            return dict.fromkeys(("lowest_speed", "highest_speed", "lift", "insensitiveness"), math.nan)
        at = self.at([low, (low + high) / 2, high])
        speed, slow, fast, lift = (np.asarray(x) for x in (at.angular_speed, at.low_speed, at.high_speed, at.lift))
        return {
            "lowest_speed": speed[0], "highest_speed": speed[2], "lift": lift[2] - lift[0],
            "insensitiveness": (fast[1] - slow[1]) / speed[1],
        }  # fmt: skip

    @described()
    def at(self, inclination: ArrayLike) -> GovernorPoints:
        """Return speeds, positions and periods at given inclinations.

        inclination: Inclinations of the arms, rad, or texts such as "30 deg", any shape
        raises: If the arms cannot reach an inclination.

        >>> porter = rc.SleeveGovernor(ball_mass=2.3, arm=0.33, lower_arm=0.33, sleeve_mass=9.5122, gravity=9.81)
        >>> round(float(porter.at("27 deg").angular_speed) * 30 / 3.141592653589793, 4)
        125.0
        """
        given = floats("revchain.SleeveGovernor.at", "inclination", inclination)
        columns = self._found().at(given)
        points = GovernorPoints(*numbers(columns))
        return points._replace(stable=np.asarray(points.stable) > 0 if given.ndim else bool(points.stable))

    @described()
    def equilibria(self, angular_speed: float) -> GovernorEquilibria:
        """Return all equilibria at a speed in the order of inclination, also beyond the stops.

        Inclinations are below a right angle with the balls on their own side of the axis. The list is proved complete.

        angular_speed: Speed of the shaft in rad/s, or a text such as "300 rpm"; not negative.
        returns: A sequence of `GovernorPoints`.
        raises: If the speed is out of its range, or the list cannot be proved complete.

        >>> pendulum = rc.SleeveGovernor(ball_mass=1.0, arm=1.0, gravity=9.81)
        >>> [(round(float(at.inclination), 4), at.stable) for at in pendulum.equilibria(4.0)]
        [(0.0, False), (0.9108, True)]
        """
        caller = "revchain.SleeveGovernor.equilibria"
        speed = real(caller, "angular_speed", angular_speed)
        found, complete = self._found().equilibria(speed)
        if not complete:
            raise ValueError(f"{caller}: cannot prove that no equilibrium is missed at angular_speed {angular_speed}")
        columns = dict(zip(GovernorPoints._fields, found.reshape(-1, len(GovernorPoints._fields)).T, strict=True))
        given = {"angular_speed": speed, "stable": columns["stable"] > 0}
        return asked_in(speed_unit(angular_speed), GovernorEquilibria._made(governor=self, **columns | given))

    def describe(self) -> str:
        """Return a description of the governor in words.

        Returns
        -------
        str
            The description, in kilograms, metres and newtons.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.SleeveGovernor(ball_mass=4.0, arm=1.4, lower_arm=1.4, sleeve_mass=3.0).describe()
        'governor: 2 balls of 4 kg on arms of 1.4 m; lower links of 1.4 m; sleeve of 3 kg'
        """
        given = self._given
        said = [f"governor: {given['balls']:g} ball{'s' * (given['balls'] > 1)} of {given['ball_mass']:g} kg on arms of {given['arm']:g} m"]
        for name, words in _IN_WORDS.items():
            if given[name] and given[name] < math.inf:
                said.append(words.format(given[name]))
        return "; ".join(said)

    @described()
    def effort(self, inclination: float, change: float = 0.01) -> GovernorEffort:
        """Return the effort and the power for a speed that rises from the equilibrium at an inclination.

        inclination: Inclination of the arms, rad
        change: Fraction by which the speed rises
        raises: If the governor has no sleeve, or no equilibrium at the inclination, or `change` is not positive.

        >>> porter = rc.SleeveGovernor(ball_mass=2.3, arm=0.33, lower_arm=0.33, sleeve_mass=9.5122, gravity=9.81)
        >>> answer = porter.effort("27 deg")
        >>> round(answer.effort, 3), round(answer.lift, 5), round(answer.power, 5)
        (1.165, 0.01159, 0.01349)
        """
        caller = "revchain.SleeveGovernor.effort"
        angle, rise = real(caller, "inclination", inclination), one_positive(caller, "change", change)
        if not (self._given["lower_arm"] or self._given["sleeve_arm"]):
            raise ValueError(f"{caller}: needs a sleeve: give the governor lower_arm or sleeve_arm")
        speed = float(self.at(angle).angular_speed)
        if not 0 < speed < math.inf:
            must = "inclination must have an equilibrium at a speed above 0"
            raise ValueError(f"{caller}: {must}, got {angle:g} with speed {speed:g}")
        return GovernorEffort(*self._found().effort(angle, rise))

    def _sheet(self, brief: bool = False) -> Sheet:
        low, high = (self._given[name] for name in _STOPS)
        if low is None:
            low, high = 0.0, math.nan
            for end in np.radians(np.arange(85.0, 0.0, -5.0)):
                try:
                    self.at(end)
                except ValueError:
                    continue
                high = float(end)
                break
        at = self.at(np.linspace(low, high, _ROWS))
        rpm = 30 / math.pi
        columns = [
            Column("inclination", at.inclination, "inclination (°)", 5, shown=np.degrees(at.inclination), unit="rad"),
            Column("angular_speed", at.angular_speed, "speed (rad/s)", 6, unit="rad/s"),
            Column("rpm", np.asarray(at.angular_speed) * rpm, "speed (rpm)", 6),
            Column("lift", at.lift, "lift (m)", 5, unit="m"),
            Column("ball_radius", at.ball_radius, "balls off axis (m)", 5, unit="m"),
            Column("stable", at.stable, "stable"),
            Column("period", at.period, "period (s)", 5, unit="s"),
            Column("low_speed", at.low_speed, "", unit="rad/s"),
            Column("high_speed", at.high_speed, "", unit="rad/s"),
        ]
        if self._given["friction"]:
            columns[3:3] = [
                Column("low_rpm", np.asarray(at.low_speed) * rpm, "falls at (rpm)", 6),
                Column("high_rpm", np.asarray(at.high_speed) * rpm, "rises at (rpm)", 6),
            ]
        facts = self._facts()
        heading = "SleeveGovernor"
        if self._given["lowest_inclination"] is not None:
            heading += f": lift {self.lift:.4g} m, sensitiveness {100 * self.sensitiveness:.3g} %"
            facts |= {name: getattr(self, name) for name in ("lowest_speed", "highest_speed", "lift", "sensitiveness")}
        return Sheet("point", heading, columns, facts)
