# SPDX-License-Identifier: GPL-3.0-or-later
"""The rope that whirls round an axis, gravity left out: in a plane, or winding round the axis.

Tensions are given as the length of rope that weighs as much; all lengths are in one unit, angles in radians. Source:
Greenhill (1908), section 5.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Field
from ..systems.numbers import STANDARD_GRAVITY, as_length, count, floats, numbers, one_positive, real, reals
from .solved import Solved

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["RopePoints", "SkippingRope", "TortuousPoints", "TortuousRope"]


class RopePoints(NamedTuple):
    """Points of a skipping rope.

    Distances from an end along the axis and along the rope, offset from the axis (of either sign), ``d offset / dx``,
    tension over that in the middle of a half wave.
    """

    x: Any
    arc: Any
    offset: Any
    slope: Any
    tension_ratio: Any


class TortuousPoints(NamedTuple):
    """Points of a tortuous rope.

    Distances along the axis and along the rope from where it is nearest to the axis, distance from the axis, angle
    round it (of the plane rope -pi/2 and pi/2 on either side of ``x = 0``), ``d radius / dx``, ``d angle / dx``,
    tension over its part along the axis.
    """

    x: Any
    arc: Any
    radius: Any
    angle: Any
    radius_slope: Any
    angle_slope: Any
    tension_ratio: Any


class SkippingRope(Solved):
    """A rope that whirls between two points of its axis, gravity left out: ``offset = sag sn(K x/a)``.

    Give two of `span`, `length`, `slack`, `sag`, and `tension` together with `angular_speed`; one of these last two may
    be added to two of the others.

    Parameters
    ----------
    span, length : float, optional
        Distance of the ends, and length of the whole rope, positive.
    slack : float, optional
        ``length - span``, positive, where the two nearly agree.
    sag : float, optional
        The largest offset, positive.
    angular_speed : float, optional
        In rad/s, positive.
    tension : float, optional
        In the middle of a half wave, positive.
    half_waves : int, optional
        How many times the rope leaves the axis.
    gravity : float, optional
        Relates weight to mass, nothing else; standard gravity in m/s^2 if left out.

    Raises
    ------
    ValueError
        If a number is not positive and finite, too few or too many are given, or no rope has them: a length not above
        the span, a sag not below half the length, a rope too slow or too tight to bend.

    Notes
    -----
    Accuracy: 1e-14 relative in what the two given determine well. Cost: 20 microseconds; a place 0.2, by its arc 10.
    Greenhill (1908) section 5 (1), (2).

    Examples
    --------
    >>> import revchain as rc
    >>> rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
    >>> round(rope.sag, 6), round(rope.tension_in_the_middle, 6)
    (1.031409, 7.397524)
    >>> rope.drawn_to(2.5).angular_speed > rope.angular_speed
    True
    """

    __slots__ = ()
    has_speed: Field[bool] = Field("Whether angular speed or tension was given, so that both are known.")
    angular_speed: Field[float] = Field("Turning speed, rad/s; a ValueError if neither speed nor tension was given.")
    conical_height: Field[float] = Field("Conical height of the speed; a ValueError as for the speed.")
    tension_in_the_middle: Field[float] = Field("Tension in the middle of a half wave; a ValueError as for the speed.")
    tension_at_ends: Field[float] = Field("Tension at every node; a ValueError as for the speed.")
    half_waves: Field[int] = Field("How many times the rope leaves the axis.")
    span: Field[float] = Field("Distance of the ends.")
    length: Field[float] = Field("Length of the rope.")
    slack: Field[float] = Field("``length - span``, computed without the difference.")
    sag: Field[float] = Field("The largest offset.")
    slope_at_ends: Field[float] = Field("Tangent of the angle with the axis, at every node.")
    tension_ratio_at_ends: Field[float] = Field("Tension at a node over that in the middle of a half wave.")
    height_times_tension: Field[float] = Field("Conical height times tension in the middle; it decides the shape.")
    moment_of_inertia: Field[float] = Field("About the axis, over the mass per length.")
    modulus: Field[float] = Field("``sag / sqrt(4 height_times_tension + sag**2)``.")
    complementary_modulus: Field[float] = Field("Its complement, more exact for a rope that is mostly radial.")
    _solver = _core.SkippingRope
    _row = "rope"

    def __init__(
        self, *, span: float | None = None, length: float | None = None, slack: float | None = None,
        sag: float | None = None, angular_speed: float | None = None, tension: float | None = None,
        half_waves: int = 1, gravity: float = STANDARD_GRAVITY,
    ) -> None:
        place = "revchain.SkippingRope"
        lengths = {"span": span, "length": length, "slack": slack, "sag": sag}
        given = lengths | {"angular_speed": angular_speed, "tension": as_length(place, "tension", tension)}
        checked = {name: None if value is None else real(place, name, value) for name, value in given.items()}
        waves = count(place, "half_waves", half_waves)
        self._solve({**checked, "half_waves": waves, "gravity": real(place, "gravity", gravity)})

    def at(self, x: ArrayLike) -> RopePoints:
        """Return points of the rope by their distance along the axis.

        Parameters
        ----------
        x : array_like
            From an end, 0 to `span`, any shape.

        Returns
        -------
        RopePoints
            Each of the shape of `x`.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.SkippingRope(span=2.0, sag=0.5)
        >>> rope.at([0.0, 0.5, 1.0]).offset.round(6)
        array([0.      , 0.359451, 0.5     ])
        """
        return RopePoints(*numbers(self._found().at(floats("revchain.SkippingRope.at", "x", x))))

    def at_arc(self, arc: ArrayLike) -> RopePoints:
        """Return points of the rope by their distance along it.

        Parameters
        ----------
        arc : array_like
            From an end, 0 to `length`, any shape.

        Returns
        -------
        RopePoints
            Each of the shape of `arc`.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.SkippingRope(span=2.0, sag=0.5)
        >>> round(float(rope.at_arc(rope.length / 2).offset), 12)
        0.5
        """
        return RopePoints(*numbers(self._found().at_arc(floats("revchain.SkippingRope.at_arc", "arc", arc))))

    def drawn_to(self, span: float) -> SkippingRope:
        """Return the rope with its ends at another distance, its length and angular momentum kept.

        Parameters
        ----------
        span : float
            The new distance, positive, less than the length; the rope must have a speed.

        Returns
        -------
        SkippingRope
            Work done on it is the gain in ``moment_of_inertia * angular_speed**2 / 2``.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
        >>> round(rope.drawn_to(2.5).angular_speed, 4)
        20.9459
        """
        momentum = self.moment_of_inertia * self.angular_speed
        kept: Any = {"length": self.length, "half_waves": self.half_waves, "gravity": self._given["gravity"]}
        kept["span"] = real("revchain.SkippingRope.drawn_to", "span", span)
        return SkippingRope(**kept, angular_speed=momentum / SkippingRope(**kept).moment_of_inertia)

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the rope seen from the side; needs matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.

        Returns
        -------
        matplotlib.axes.Axes

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.SkippingRope(span=2.0, length=3.0).plot()
        >>> ax.get_xlabel()
        'along the axis (m)'
        """
        from ..plots.closed_forms import plot_skipping_rope

        return plot_skipping_rope(self, ax)

    def _table(self) -> dict[str, str]:
        pulls = {"tension_in_the_middle": "tension: middle", "tension_at_ends": "at ends"}
        known = {"angular_speed": "speed (rad/s)", **pulls, "conical_height": ""} if self.has_speed else {}
        ends = ("slack", "slope_at_ends", "tension_ratio_at_ends")
        whole = ("height_times_tension", "moment_of_inertia", "modulus", "complementary_modulus")
        return {**known, "span": "span", "length": "length", "sag": "sag", **dict.fromkeys(ends + whole, "")}

    def _heading(self) -> str:
        return f"{self.half_waves} half wave{'s' * (self.half_waves != 1)}"


class TortuousRope(Solved):
    """A rope that whirls and winds round its axis, its ends off the axis, gravity left out.

    Parameters
    ----------
    least_radius, greatest_radius : float
        Between which its distance from the axis varies, the greater positive. A least radius of 0 is the plane rope,
        two equal ones a helix.
    angular_speed : float
        In rad/s, positive.
    tension : float
        Its part along the axis, positive.
    gravity : float, optional
        Relates weight to mass, nothing else; standard gravity in m/s^2 if left out.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Accuracy: 1e-14 relative, of the angle 1e-14 of it and 1. Cost: 2 microseconds, a place 1. The angle is an elliptic
    integral of the third kind. Greenhill (1908) section 5, text after (6).

    Examples
    --------
    >>> import revchain as rc
    >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
    >>> round(rope.half_wave, 6), round(rope.half_wave_angle, 6)
    (2.494443, 3.335154)
    """

    __slots__ = ()
    least_radius: Field[float] = Field("Least distance from the axis.")
    greatest_radius: Field[float] = Field("Greatest distance from the axis.")
    half_wave: Field[float] = Field("Distance along the axis from one point nearest to it to the next.")
    half_wave_length: Field[float] = Field("That distance along the rope.")
    half_wave_slack: Field[float] = Field("``half_wave_length - half_wave``, computed without the difference.")
    half_wave_angle: Field[float] = Field("Angle round the axis in a half wave, rad; pi for the plane rope.")
    conical_height: Field[float] = Field("Conical height of the speed.")
    height_times_tension: Field[float] = Field("Conical height times tension; it decides the shape.")
    modulus: Field[float] = Field("Modulus of the elliptic functions.")
    complementary_modulus: Field[float] = Field("Its complement.")
    _solver = _core.TortuousRope
    _row = "rope"

    def __init__(
        self, *, least_radius: float, greatest_radius: float, angular_speed: float, tension: float,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        radii = {"least_radius": least_radius, "greatest_radius": greatest_radius}
        place = "revchain.TortuousRope"
        pull = as_length(place, "tension", tension)
        self._solve(reals(place, **radii, angular_speed=angular_speed, tension=pull, gravity=gravity))

    def at(self, x: ArrayLike) -> TortuousPoints:
        """Return points of the rope by their distance along the axis.

        Parameters
        ----------
        x : array_like
            From where the rope is nearest to the axis, of either sign, finite, any shape.

        Returns
        -------
        TortuousPoints
            Each of the shape of `x`.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
        >>> rope.at([0.0, rope.half_wave / 2]).radius.round(12)
        array([0.5, 1. ])
        """
        return TortuousPoints(*numbers(self._found().at(floats("revchain.TortuousRope.at", "x", x))))

    def plot(self, ax: Axes | None = None, *, half_waves: float = 4.0) -> Axes:
        """Draw the rope seen along its axis, and the two circles between which it stays; needs matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        half_waves : float
            How much of it, from a point nearest to the axis on; positive and finite.

        Returns
        -------
        matplotlib.axes.Axes

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
        >>> ax = rope.plot()
        >>> ax.get_xlabel()
        'x (m)'
        """
        from ..plots.closed_forms import plot_tortuous_rope

        long = one_positive("revchain.TortuousRope.plot", "half_waves", half_waves)
        return plot_tortuous_rope(self, ax, long)

    def _heading(self) -> str:
        return f"{self._given['angular_speed']:g} rad/s, tension {self._given['tension']:g}"

    def _table(self) -> dict[str, str]:
        radii = {"least_radius": "least radius", "greatest_radius": "greatest radius"}
        wave = {"half_wave": "half wave", "half_wave_length": "its length", "half_wave_angle": "its angle (°)"}
        unshown = ("half_wave_slack", "conical_height", "height_times_tension", "modulus", "complementary_modulus")
        return {**radii, **wave, **dict.fromkeys(unshown, "")}
