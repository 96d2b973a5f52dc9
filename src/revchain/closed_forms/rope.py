# SPDX-License-Identifier: GPL-3.0-or-later
"""A rope that whirls about an axis without gravity, in a plane or wound round the axis.

A tension is given as the length of rope of equal weight. All lengths are in one unit, angles in radians. Source:
Greenhill (1908), section 5.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Field
from ..systems.numbers import STANDARD_GRAVITY, real
from .solved import Solved
from .table import FloatOrArray, described


__all__ = ["RopePoints", "SkippingRope", "TortuousPoints", "TortuousRope"]


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

    `x`, `arc`: distances along the axis and along the rope from the point nearest to the axis. `radius`: distance
    from the axis. `angle`: angle round the axis; for the plane rope -pi/2 and pi/2 on either side of ``x = 0``.
    `radius_slope`, `angle_slope`: ``d radius / dx``, ``d angle / dx``. `tension_ratio`: tension divided by its
    component along the axis.
    """

    x: FloatOrArray
    arc: FloatOrArray
    radius: FloatOrArray
    angle: FloatOrArray
    radius_slope: FloatOrArray
    angle_slope: FloatOrArray
    tension_ratio: FloatOrArray


@described("1e-14 relative for what the two given data determine well", "section 5 (1), (2)")
class SkippingRope(Solved):
    """A rope that whirls between two points of the axis without gravity: ``offset = sag sn(K x/a)``.

    Give two of five data: `span`, `length`, `slack`, `sag`, and the pair of `tension` and `angular_speed`. To two of
    the first four you may add one of `tension` and `angular_speed`.

    length: Length of the whole rope
    tension: Tension in the middle of a half wave, as the length of rope of equal weight
    gravity: Acceleration of gravity, which only relates weight to mass (standard gravity in m/s^2 if left out)
    raises: If a number is not positive and finite, if too few or too many are given, or if no rope has them: the length
        does not exceed the span, the sag is not below half the length, or the rope is too slow or too tight to bend.
    notes: Cost: 20 microseconds, and for each point 0.2 by `at` or 10 by `at_arc`.

    >>> rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
    >>> round(rope.sag, 6), round(rope.tension_in_the_middle, 6)
    (1.031409, 7.397524)
    >>> rope.drawn_to(2.5).angular_speed > rope.angular_speed
    True
    """

    __slots__ = ()
    has_speed: Field[bool] = Field("Whether angular speed or tension was given; both are then known.")
    angular_speed: Field[float] = Field("Turning speed, rad/s; a ValueError if neither speed nor tension was given.")
    conical_height: Field[float] = Field("Conical height of the speed; a ValueError if the speed raises one.")
    tension_in_the_middle: Field[float] = Field(
        "Tension in the middle of a half wave; a ValueError if the speed raises one."
    )
    tension_at_ends: Field[float] = Field("Tension at every node; a ValueError if the speed raises one.")
    half_waves: Field[int] = Field("Number of half waves between the ends.")
    span: Field[float] = Field("Distance between the ends.")
    length: Field[float] = Field("Length of the rope.")
    slack: Field[float] = Field("``length - span``, computed without that difference.")
    sag: Field[float] = Field("The largest offset.")
    slope_at_ends: Field[float] = Field("Tangent of the angle between rope and axis at every node.")
    tension_ratio_at_ends: Field[float] = Field("Tension at a node divided by that in the middle of a half wave.")
    height_times_tension: Field[float] = Field("Conical height times tension in the middle; it determines the shape.")
    moment_of_inertia: Field[float] = Field("Moment of inertia about the axis, divided by the mass per length.")
    modulus: Field[float] = Field("``sag / sqrt(4 height_times_tension + sag**2)``.")
    complementary_modulus: Field[float] = Field(
        "Complementary modulus; it is more accurate than the modulus if the rope is mostly radial."
    )
    _solver = _core.SkippingRope
    _optional = ("span", "length", "slack", "sag", "angular_speed", "tension")
    _row = "rope"

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

        span: The new span, positive, less than the length. The rope must have a speed (`has_speed`).
        returns: The new rope. The work of drawing it there is the gain in ``moment_of_inertia * angular_speed**2 / 2``.

        >>> rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
        >>> round(rope.drawn_to(2.5).angular_speed, 4)
        20.9459
        """
        momentum = self.moment_of_inertia * self.angular_speed
        kept: Any = {"length": self.length, "half_waves": self.half_waves, "gravity": self._given["gravity"]}
        kept["span"] = real("revchain.SkippingRope.drawn_to", "span", span)
        return SkippingRope(**kept, angular_speed=momentum / SkippingRope(**kept).moment_of_inertia)

    def _table(self) -> dict[str, str]:
        pulls = {"tension_in_the_middle": "tension: middle", "tension_at_ends": "at ends"}
        known = {"angular_speed": "speed (rad/s)", **pulls, "conical_height": ""} if self.has_speed else {}
        ends = ("slack", "slope_at_ends", "tension_ratio_at_ends")
        whole = ("height_times_tension", "moment_of_inertia", "modulus", "complementary_modulus")
        return {**known, "span": "span", "length": "length", "sag": "sag", **dict.fromkeys(ends + whole, "")}

    def _heading(self) -> str:
        return f"{self.half_waves} half wave{'s' * (self.half_waves != 1)}"


@described(
    "1e-14 relative; for the angle, 1e-14 of its size plus 1", "section 5, text after (6)",
    "2 microseconds, and 1 for each point",
)
class TortuousRope(Solved):
    """A rope that whirls and winds round the axis without gravity; its ends are off the axis.

    The angle is an elliptic integral of the third kind.

    least_radius: Smallest distance of the rope from the axis; 0 gives the plane rope, `greatest_radius` a helix.
    tension: Component of the tension along the axis, as the length of rope of equal weight
    gravity: Acceleration of gravity, which only relates weight to mass (standard gravity in m/s^2 if left out)
    raises: If a number is out of its range.

    >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
    >>> round(rope.half_wave, 6), round(rope.half_wave_angle, 6)
    (2.494443, 3.335154)
    """

    __slots__ = ()
    least_radius: Field[float] = Field("Least distance from the axis.")
    greatest_radius: Field[float] = Field("Greatest distance from the axis.")
    half_wave: Field[float] = Field("Distance along the axis between two successive points nearest to the axis.")
    half_wave_length: Field[float] = Field("Length of the rope between two successive points nearest to the axis.")
    half_wave_slack: Field[float] = Field("``half_wave_length - half_wave``, computed without that difference.")
    half_wave_angle: Field[float] = Field("Angle round the axis in a half wave, rad; pi for the plane rope.")
    conical_height: Field[float] = Field("Conical height of the speed.")
    height_times_tension: Field[float] = Field("Conical height times tension; it determines the shape.")
    modulus: Field[float] = Field("Modulus of the elliptic functions.")
    complementary_modulus: Field[float] = Field("Complementary modulus of the elliptic functions.")
    _solver = _core.TortuousRope
    _row = "rope"

    def __init__(
        self, *, least_radius: float, greatest_radius: float, angular_speed: float, tension: float,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        self._solve(locals())

    @described()
    def at(self, x: ArrayLike) -> TortuousPoints:
        """Return points of the rope by their distance along the axis.

        x: Distances along the axis from a point nearest to the axis, positive or negative, finite, any shape

        >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
        >>> rope.at([0.0, rope.half_wave / 2]).radius.round(12)
        array([0.5, 1. ])
        """
        return TortuousPoints(*self._at("at", "x", x))

    def _heading(self) -> str:
        return f"{self._given['angular_speed']:g} rad/s, tension {self._given['tension']:g}"

    def _table(self) -> dict[str, str]:
        radii = {"least_radius": "least radius", "greatest_radius": "greatest radius"}
        wave = {"half_wave": "half wave", "half_wave_length": "its length", "half_wave_angle": "its angle (°)"}
        unshown = ("half_wave_slack", "conical_height", "height_times_tension", "modulus", "complementary_modulus")
        return {**radii, **wave, **dict.fromkeys(unshown, "")}
