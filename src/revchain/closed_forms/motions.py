# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions of carriages at a buffer stop, of a governor, and of ropes that whirl.

Angles are in radians. Lengths of ropes are in the unit of length of `gravity`. Source: Greenhill (1908): carriages
section 2, ropes section 5, the governor section 7.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Field
from ..results.sheet import Column, Sheet
from ..systems.numbers import STANDARD_GRAVITY, real
from .solved import Solved
from .table import FloatOrArray, described

__all__ = [
    "Blow", "BufferImpact", "CarriageState", "GovernorMotion", "GovernorState", "RopePoints", "SkippingRope",
    "TortuousPoints", "TortuousRope",
]


class Blow(NamedTuple):
    """One contact with the buffer: start, end, and the momentum that the buffer absorbs."""

    start: float
    end: float
    impulse: float


class CarriageState(NamedTuple):
    """Displacements of both carriages towards the buffer since time 0, their speeds, and the buffer force."""

    front: FloatOrArray
    rear: FloatOrArray
    front_speed: FloatOrArray
    rear_speed: FloatOrArray
    buffer_force: FloatOrArray


@described(source="section 2, text after (7)")
class BufferImpact(Solved):
    """The motion of two carriages that run against a buffer stop.

    The buffer pushes but does not pull. Units: any consistent set.

    speed: Speed of both carriages towards the buffer at time 0, when the front one touches it
    raises: If a number is out of its range, or there are more than 100,000 blows.
    notes: Accuracy for up to 30 blows, measured against integration, if none only grazes the buffer: positions to 1e-13
        of speed times time, speeds to 1e-13 of the speed and of acceleration times time, times to 1e-13 of the last time.
        Errors grow with the number of blows. Cost: 10 microseconds, 1 more for each blow, and 0.05 for each state.

    >>> rc.BufferImpact(front_mass=1, rear_mass=1, buffer_stiffness=4, coupling_stiffness=0.5, speed=1)
    BufferImpact: 2 blows
    blow    start      end  impulse
       0  0.00000  1.69374  2.13365
       1  3.23975  4.85806  1.83769
    """

    __slots__ = ()
    _solver = _core.BufferImpact

    def __init__(
        self, *, front_mass: float, rear_mass: float, buffer_stiffness: float, coupling_stiffness: float, speed: float
    ) -> None:
        self._solve(locals())

    @property
    def blows(self) -> list[Blow]:
        """Start, end and impulse of each contact with the buffer."""
        return [Blow(*row) for row in self._found().blows.tolist()]

    @described()
    def state(self, time: ArrayLike) -> CarriageState:
        """Return the positions and speeds of the carriages, and the force of the buffer.

        time: Times, finite and not negative, any shape

        >>> impact = rc.BufferImpact(front_mass=1, rear_mass=1, buffer_stiffness=4, coupling_stiffness=0.5, speed=1)
        >>> round(float(impact.state(1.0).buffer_force), 6)
        1.87221
        """
        return CarriageState(*self._at("state", "time", time))

    def _sheet(self, brief: bool = False) -> Sheet:
        blows = self._found().blows
        columns = [Column("blow", np.arange(len(blows)), "blow")]
        columns += [Column(name, blows[:, k], name) for k, name in enumerate(Blow._fields)]
        heading = f"BufferImpact: {len(blows)} blow{'s' * (len(blows) != 1)}"
        return Sheet("blow", heading, columns, self._facts())


class GovernorState(NamedTuple):
    """Angle in rad (whole turns included) and its rate in rad/s."""

    angle: FloatOrArray
    angle_rate: FloatOrArray


@described(cost="5 microseconds, and 0.1 for each time", source="section 7 (1)-(13)")
class GovernorMotion(Solved, row="motion", title="GovernorMotion: {self.regime}"):
    """The motion of a link hinged on a turning axis.

    angular_speed: Speed of the axis, rad/s; 0 for a plane pendulum.
    pendulum_length: Length of the equivalent simple pendulum about the hinge
    gravity: Acceleration of gravity; negative for an inverted axis.
    raises: If a number is out of its range, or the numbers are too far apart for the motion to be computed.
    notes: Accuracy, measured against integration in quadruple precision: angles to 1e-13 of the greatest angle and of
        ``t`` times the greatest rate; rates to 1e-13 of the greatest rate and of ``t`` times the greatest
        acceleration. Close to a motion that never returns, the rounding of the start to double limits the accuracy.

    >>> swing = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)
    >>> swing.regime, round(swing.period, 4), round(swing.least_angle, 4)
    ('aside', 1.442, 0.7759)
    """

    __slots__ = ()
    regime: Field[str] = Field(
        "``'rest'``, ``'aside'`` (dn), ``'asymptotic'`` (sech, sinh, exp), ``'through'`` (cn) or ``'revolutions'`` (tn).",
        heading="",
    )
    period: Field[float] = Field(
        "Period of the motion (of one turn if it revolves), s; infinite if it does not return, 0 at rest.",
        heading="period",
        unit="s",
    )
    least_angle: Field[float] = Field(
        "Smallest angle of the motion, rad; minus infinity if it revolves.", heading="least angle", unit="rad"
    )
    greatest_angle: Field[float] = Field(
        "Largest angle of the motion, rad; infinity if it revolves.", heading="greatest angle", unit="rad"
    )
    modulus: Field[float] = Field("Modulus of the elliptic functions.", heading="modulus")
    complementary_modulus: Field[float] = Field(
        "Complementary modulus of the elliptic functions.", heading=""
    )
    _solver = _core.GovernorMotion

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


class RopePoints(NamedTuple):
    """Points of a skipping rope.

    `x`, `arc`: distances from an end along the axis and along the rope. `offset`: signed distance from the axis.
    `slope`: ``d offset / dx``. `tension_ratio`: tension divided by that in the middle of a half wave.
    """

    x: FloatOrArray
    arc: FloatOrArray
    offset: FloatOrArray
    slope: FloatOrArray
    tension_ratio: FloatOrArray


class TortuousPoints(NamedTuple):
    """Points of a tortuous rope.

    `x`, `arc`: distances along the axis and along the rope from the point nearest to the axis. `radius`: distance from
    the axis. `angle`: angle round the axis, 0 at ``x = 0``. `radius_slope`, `angle_slope`: ``d radius / dx``,
    ``d angle / dx``. `tension_ratio`: tension divided by its component along the axis.
    """

    x: FloatOrArray
    arc: FloatOrArray
    radius: FloatOrArray
    angle: FloatOrArray
    radius_slope: FloatOrArray
    angle_slope: FloatOrArray
    tension_ratio: FloatOrArray


@described("1e-14 relative for what the two given data determine well", "section 5 (1), (2)")
class SkippingRope(Solved, row="rope", title="SkippingRope: {self._waves}"):
    """A rope that whirls between two points of the axis without gravity: ``offset = sag sn(K x/a)``.

    Give two of `span`, `length`, `slack` and `sag`, with or without one of `tension` and `angular_speed`; or give one of
    the four with both `tension` and `angular_speed`.

    length: Length of the whole rope
    tension: Tension in the middle of a half wave, as the length of rope of equal weight
    gravity: Acceleration of gravity, which only relates weight to mass (standard gravity in m/s^2 if left out)
    raises: If a number is not positive and finite, too few or too many are given, or no rope has them.
    notes: Cost: 10 microseconds, and for each point 0.07 by `at` or 0.5 by `at_arc`.

    >>> rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
    >>> round(rope.sag, 6), round(rope.tension_in_the_middle, 6)
    (1.031409, 7.397524)
    >>> rope.drawn_to(2.5).angular_speed > rope.angular_speed
    True
    """

    __slots__ = ()
    has_speed: Field[bool] = Field("Whether angular speed or tension was given.")
    angular_speed: Field[float] = Field(
        "Speed, rad/s; a ValueError unless `has_speed`.", heading="speed", unit="rad/s"
    )
    conical_height: Field[float] = Field(
        "Conical height of the speed; a ValueError unless `has_speed`.", heading=""
    )
    tension_in_the_middle: Field[float] = Field(
        "Tension in the middle of a half wave; a ValueError unless `has_speed`.", heading="tension: middle"
    )
    tension_at_ends: Field[float] = Field(
        "Tension at the nodes; a ValueError unless `has_speed`.", heading="at ends"
    )
    half_waves: Field[int] = Field("Number of half waves between the ends.")
    span: Field[float] = Field("Distance between the ends.", heading="span")
    length: Field[float] = Field("Length of the rope.", heading="length")
    slack: Field[float] = Field("``length - span``, without cancellation.", heading="")
    sag: Field[float] = Field("The largest offset.", heading="sag")
    slope_at_ends: Field[float] = Field("Tangent of the angle between rope and axis at the nodes.", heading="")
    tension_ratio_at_ends: Field[float] = Field(
        "Tension at a node divided by that in the middle of a half wave.", heading=""
    )
    height_times_tension: Field[float] = Field(
        "Conical height times tension in the middle.", heading=""
    )
    moment_of_inertia: Field[float] = Field(
        "Moment of inertia about the axis, divided by the mass per length.", heading=""
    )
    modulus: Field[float] = Field("``sag / sqrt(4 height_times_tension + sag**2)``.", heading="")
    complementary_modulus: Field[float] = Field(
        "Complementary modulus of the elliptic functions.", heading=""
    )
    _solver = _core.SkippingRope
    _optional = ("span", "length", "slack", "sag", "angular_speed", "tension")

    def __init__(
        self, *, span: float | None = None, length: float | None = None, slack: float | None = None,
        sag: float | None = None, angular_speed: float | None = None, tension: float | None = None,
        half_waves: int = 1, gravity: float = STANDARD_GRAVITY,
    ) -> None:
        self._solve(locals())

    @described()
    def at(self, x: ArrayLike) -> RopePoints:
        """Return points of the rope by their distance along the axis.

        x: Distances from an end along the axis, 0 to `span`, any shape

        >>> rope = rc.SkippingRope(span=2.0, sag=0.5)
        >>> rope.at([0.0, 0.5, 1.0]).offset.round(6)
        array([0.      , 0.359451, 0.5     ])
        """
        return RopePoints(*self._at("at", "x", x))

    @described()
    def at_arc(self, arc: ArrayLike) -> RopePoints:
        """Return points of the rope by their distance along the rope.

        arc: Distances from an end along the rope, 0 to `length`, any shape.

        >>> rope = rc.SkippingRope(span=2.0, sag=0.5)
        >>> round(float(rope.at_arc(rope.length / 2).offset), 12)
        0.5
        """
        return RopePoints(*self._at("at_arc", "arc", arc))

    @described()
    def drawn_to(self, span: float) -> SkippingRope:
        """Return the rope with another span but equal length and angular momentum.

        span: The new span, positive, less than the length.
        returns: The new rope.
        raises: If the rope has no speed, or the span is out of its range.

        >>> rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
        >>> round(rope.drawn_to(2.5).angular_speed, 4)
        20.9459
        """
        momentum = self.moment_of_inertia * self.angular_speed
        data: Any = {"length": self.length, "half_waves": self.half_waves, "gravity": self._given["gravity"]}
        data["span"] = real("revchain.SkippingRope.drawn_to", "span", span)
        return SkippingRope(**data, angular_speed=momentum / SkippingRope(**data).moment_of_inertia)

    def _left_out(self) -> tuple[str, ...]:
        speeds = ("angular_speed", "conical_height", "tension_in_the_middle", "tension_at_ends")
        return () if self.has_speed else speeds

    @property
    def _waves(self) -> str:
        return f"{self.half_waves} half wave{'s' * (self.half_waves != 1)}"


@described(
    "1e-14 relative for what data and x determine well; for the angle, 1e-14 of its size plus 1",
    "section 5, text after (6)",
    "7 microseconds, and 0.25 for each point",
)
class TortuousRope(
    Solved, row="rope", title="TortuousRope: {self._given[angular_speed]:g} rad/s, tension {self._given[tension]:g}"
):
    """A rope that whirls and winds round the axis without gravity.

    least_radius: Smallest distance of the rope from the axis; 0 gives the plane rope, `greatest_radius` a helix.
    tension: Component of the tension along the axis, as the length of rope of equal weight
    gravity: Acceleration of gravity, which only relates weight to mass (standard gravity in m/s^2 if left out)
    raises: If a number is out of its range.

    >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
    >>> round(rope.half_wave, 6), round(rope.half_wave_angle, 6)
    (2.494443, 3.335154)
    """

    __slots__ = ()
    least_radius: Field[float] = Field("Least distance from the axis.", heading="least radius")
    greatest_radius: Field[float] = Field("Greatest distance from the axis.", heading="greatest radius")
    half_wave: Field[float] = Field(
        "Distance along the axis between successive points nearest to the axis.", heading="half wave"
    )
    half_wave_length: Field[float] = Field(
        "Length of the rope in a half wave.", heading="its length"
    )
    half_wave_slack: Field[float] = Field(
        "``half_wave_length - half_wave``, without cancellation.", heading=""
    )
    half_wave_angle: Field[float] = Field(
        "Angle round the axis in a half wave, rad; pi for the plane rope.", heading="its angle", unit="rad"
    )
    conical_height: Field[float] = Field("Conical height of the speed.", heading="")
    height_times_tension: Field[float] = Field(
        "Conical height times tension.", heading=""
    )
    modulus: Field[float] = Field("Modulus of the elliptic functions.", heading="")
    complementary_modulus: Field[float] = Field("Complementary modulus of the elliptic functions.", heading="")
    _solver = _core.TortuousRope

    def __init__(
        self, *, least_radius: float, greatest_radius: float, angular_speed: float, tension: float,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        self._solve(locals())

    @described()
    def at(self, x: ArrayLike) -> TortuousPoints:
        """Return points of the rope by their distance along the axis.

        x: Distances along the axis from a point nearest to the axis, finite, any shape

        >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
        >>> rope.at([0.0, rope.half_wave / 2]).radius.round(12)
        array([0.5, 1. ])
        """
        return TortuousPoints(*self._at("at", "x", x))
