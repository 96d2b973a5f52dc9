# SPDX-License-Identifier: GPL-3.0-or-later
"""The rope that whirls round an axis, gravity left out: plane, or winding round it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, count, floats, numbers, one_positive, real

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["RopePoints", "SkippingRope", "TortuousPoints", "TortuousRope"]


class RopePoints(NamedTuple):
    """What there is at places of a skipping rope.

    Attributes
    ----------
    x : float or ndarray
        Distance from an end along the axis.
    arc : float or ndarray
        Distance from that end along the rope.
    offset : float or ndarray
        From the axis, of either sign.
    slope : float or ndarray
        ``d offset / dx``.
    tension_ratio : float or ndarray
        Of the tension to that in the middle of a half wave.
    """

    x: Any
    arc: Any
    offset: Any
    slope: Any
    tension_ratio: Any


class TortuousPoints(NamedTuple):
    """What there is at places of a tortuous rope.

    Attributes
    ----------
    x : float or ndarray
        Along the axis, from where the rope is nearest to it.
    arc : float or ndarray
        Along the rope.
    radius : float or ndarray
        Distance from the axis.
    angle : float or ndarray
        Round the axis, rad; of the plane rope -pi/2 and pi/2 on either side of ``x = 0``.
    radius_slope : float or ndarray
        ``d radius / dx``.
    angle_slope : float or ndarray
        ``d angle / dx``.
    tension_ratio : float or ndarray
        Of the tension to its part along the axis.
    """

    x: Any
    arc: Any
    radius: Any
    angle: Any
    radius_slope: Any
    angle_slope: Any
    tension_ratio: Any


class SkippingRope:
    """A rope that whirls between two points of its axis, gravity left out: ``offset = sag sn(K x/a)``.

    Parameters
    ----------
    span, length : float, optional
        Of the whole rope, positive.
    slack : float, optional
        ``length - span``, positive, where the two nearly agree.
    sag : float, optional
        The largest offset, positive.
    angular_speed : float, optional
        In rad/s, positive.
    tension : float, optional
        In the middle of a half wave, as a length of rope that weighs as much; positive.
    half_waves : int, optional
        How many times the rope leaves the axis.
    gravity : float, optional
        Relates weight to mass, nothing else; standard gravity in m/s^2 if left out.

    Give two of `span`, `length`, `slack`, `sag`, and `tension` together with `angular_speed`; one of these
    last two may be added to two of the others.

    Raises
    ------
    ValueError
        If a number is not positive and finite, too few or too many are given, or no rope does what
        they say: a length not above the span, a sag not below half the length, a rope too slow
        or too tight to bend.

    Notes
    -----
    Accuracy: 1e-14 relative in what the two given determine well. Cost: 20 microseconds; a place 0.2,
    by its arc 10. Greenhill (1908) section 5 (1), (2).

    Examples
    --------
    >>> import revchain as rc
    >>> rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
    >>> round(rope.sag, 6), round(rope.tension_in_the_middle, 6)
    (1.031409, 7.397524)
    >>> rope.drawn_to(2.5).angular_speed > rope.angular_speed
    True
    """

    __slots__ = ("_compiled",)
    _compiled: _core.SkippingRope

    def __init__(
        self,
        *,
        span: float | None = None,
        length: float | None = None,
        slack: float | None = None,
        sag: float | None = None,
        angular_speed: float | None = None,
        tension: float | None = None,
        half_waves: int = 1,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        place = "revchain.SkippingRope"

        def known(name: str, value: float | None) -> float | None:
            return None if value is None else real(place, name, value)

        self._compiled = _core.SkippingRope(
            known("span", span),
            known("length", length),
            known("slack", slack),
            known("sag", sag),
            known("angular_speed", angular_speed),
            known("tension", tension),
            count(place, "half_waves", half_waves),
            real(place, "gravity", gravity),
        )

    @property
    def half_waves(self) -> int:
        """How many times the rope leaves the axis."""
        return self._compiled.half_waves

    @property
    def modulus(self) -> float:
        """``sag / sqrt(4 height_times_tension + sag**2)``."""
        return self._compiled.modulus

    @property
    def complementary_modulus(self) -> float:
        """Its complement, which says more of a rope that is mostly radial."""
        return self._compiled.complementary_modulus

    @property
    def span(self) -> float:
        """Distance of the ends."""
        return self._compiled.span

    @property
    def length(self) -> float:
        """Of the rope."""
        return self._compiled.length

    @property
    def slack(self) -> float:
        """``length - span``, to its own last digits."""
        return self._compiled.slack

    @property
    def sag(self) -> float:
        """The largest offset."""
        return self._compiled.sag

    @property
    def slope_at_ends(self) -> float:
        """Tangent of the angle with the axis, at every node."""
        return self._compiled.slope_at_ends

    @property
    def tension_ratio_at_ends(self) -> float:
        """Tension at a node over that in the middle of a half wave."""
        return self._compiled.tension_ratio_at_ends

    @property
    def height_times_tension(self) -> float:
        """Conical height times tension in the middle, on which the form depends alone."""
        return self._compiled.height_times_tension

    @property
    def moment_of_inertia(self) -> float:
        """About the axis, over the mass per length."""
        return self._compiled.moment_of_inertia

    @property
    def has_speed(self) -> bool:
        """Whether angular speed or tension was given, so that both are known."""
        return self._compiled.has_speed

    @property
    def conical_height(self) -> float:
        """Of the speed; a ValueError if neither speed nor tension was given."""
        return self._compiled.conical_height

    @property
    def angular_speed(self) -> float:
        """In rad/s; a ValueError if neither speed nor tension was given."""
        return self._compiled.angular_speed

    @property
    def tension_in_the_middle(self) -> float:
        """Of a half wave, as a length; a ValueError if neither speed nor tension was given."""
        return self._compiled.tension_in_the_middle

    @property
    def tension_at_ends(self) -> float:
        """At every node, as a length; a ValueError if neither speed nor tension was given."""
        return self._compiled.tension_at_ends

    def at(self, x: ArrayLike) -> RopePoints:
        """Return what there is at distances along the axis.

        Parameters
        ----------
        x : array_like
            From an end, 0 to `span`, any shape.

        Returns
        -------
        RopePoints
            Each of the shape of `x`. Cost 0.2 microseconds a number.

        Raises
        ------
        ValueError
            If a number is out of its range.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.SkippingRope(span=2.0, sag=0.5)
        >>> rope.at([0.0, 0.5, 1.0]).offset.round(6)
        array([0.      , 0.359451, 0.5     ])
        """
        return RopePoints(*numbers(self._compiled.at(floats("revchain.SkippingRope.at", "x", x))))

    def at_arc(self, arc: ArrayLike) -> RopePoints:
        """Return what there is at distances along the rope.

        Parameters
        ----------
        arc : array_like
            From an end, 0 to `length`, any shape.

        Returns
        -------
        RopePoints
            Each of the shape of `arc`. Cost 10 microseconds a number.

        Raises
        ------
        ValueError
            If a number is out of its range.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.SkippingRope(span=2.0, length=3.0)
        >>> round(float(rope.at_arc(1.5).offset - rope.sag), 12)
        0.0
        """
        return RopePoints(*numbers(self._compiled.at_arc(floats("revchain.SkippingRope.at_arc", "arc", arc))))

    def drawn_to(self, span: float) -> SkippingRope:
        """Return the rope with its ends at another distance, its length and angular momentum kept.

        Parameters
        ----------
        span : float
            The new distance, positive, less than the length.

        Returns
        -------
        SkippingRope
            Work done on it is the gain in ``moment_of_inertia * angular_speed**2 / 2``.

        Raises
        ------
        ValueError
            If `span` is out of its range, or the rope has no speed.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
        >>> round(rope.drawn_to(2.5).angular_speed, 4)
        20.9459
        """
        drawn = object.__new__(SkippingRope)
        drawn._compiled = self._compiled.drawn_to(real("revchain.SkippingRope.drawn_to", "span", span))
        return drawn

    def plot(self, ax: Axes | None = None, *, length_unit: str = "m") -> Axes:
        """Draw the rope seen from the side.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        length_unit : str
            What to write on the axes.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.SkippingRope(span=2.0, length=3.0).plot()
        >>> ax.get_xlabel()
        'along the axis (m)'
        """
        from ..plots.style import plot_skipping_rope

        return plot_skipping_rope(self, ax, length_unit=length_unit)

    def __repr__(self) -> str:
        speed = f", angular speed {self.angular_speed:g}" if self.has_speed else ""
        return f"SkippingRope: span {self.span:g}, length {self.length:g}, sag {self.sag:g}{speed}"


class TortuousRope:
    """A rope that whirls and winds round its axis, its ends off the axis, gravity left out.

    Parameters
    ----------
    least_radius, greatest_radius : float
        Between which its distance from the axis varies, the greater positive. A least radius of 0 is
        the plane rope, two equal ones a helix.
    angular_speed : float
        In rad/s, positive.
    tension : float
        What pulls along the axis, as a length of rope that weighs as much; positive.
    gravity : float, optional
        Relates weight to mass, nothing else; standard gravity in m/s^2 if left out.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Accuracy: 1e-14 relative, of the angle 1e-14 of it and 1. Cost: 2 microseconds, a place 1. The angle is an
    elliptic integral of the third kind. Greenhill (1908) section 5, text after (6).

    Examples
    --------
    >>> import revchain as rc
    >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
    >>> round(rope.half_wave, 6), round(rope.half_wave_angle, 6)
    (2.494443, 3.335154)
    """

    __slots__ = ("_compiled",)
    _compiled: _core.TortuousRope

    def __init__(
        self,
        *,
        least_radius: float,
        greatest_radius: float,
        angular_speed: float,
        tension: float,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        place = "revchain.TortuousRope"
        self._compiled = _core.TortuousRope(
            real(place, "least_radius", least_radius),
            real(place, "greatest_radius", greatest_radius),
            real(place, "angular_speed", angular_speed),
            real(place, "tension", tension),
            real(place, "gravity", gravity),
        )

    @property
    def least_radius(self) -> float:
        """Where it is nearest to the axis."""
        return self._compiled.least_radius

    @property
    def greatest_radius(self) -> float:
        """Where it is farthest from the axis."""
        return self._compiled.greatest_radius

    @property
    def conical_height(self) -> float:
        """Of the speed."""
        return self._compiled.conical_height

    @property
    def height_times_tension(self) -> float:
        """Conical height times tension, on which the form depends alone."""
        return self._compiled.height_times_tension

    @property
    def modulus(self) -> float:
        """Of the elliptic functions."""
        return self._compiled.modulus

    @property
    def complementary_modulus(self) -> float:
        """Its complement."""
        return self._compiled.complementary_modulus

    @property
    def half_wave(self) -> float:
        """Distance along the axis from one place nearest to it to the next."""
        return self._compiled.half_wave

    @property
    def half_wave_length(self) -> float:
        """The same along the rope."""
        return self._compiled.half_wave_length

    @property
    def half_wave_slack(self) -> float:
        """``half_wave_length - half_wave``, to its own last digits."""
        return self._compiled.half_wave_slack

    @property
    def half_wave_angle(self) -> float:
        """The angle round the axis meanwhile, pi for the plane rope."""
        return self._compiled.half_wave_angle

    def at(self, x: ArrayLike) -> TortuousPoints:
        """Return what there is at distances along the axis.

        Parameters
        ----------
        x : array_like
            From where the rope is nearest to the axis, of either sign, any shape.

        Returns
        -------
        TortuousPoints
            Each of the shape of `x`. Cost 1 microsecond a number.

        Raises
        ------
        ValueError
            If a number is not finite.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
        >>> rope.at([0.0, rope.half_wave / 2]).radius.round(12)
        array([0.5, 1. ])
        """
        return TortuousPoints(*numbers(self._compiled.at(floats("revchain.TortuousRope.at", "x", x))))

    def plot(self, ax: Axes | None = None, *, half_waves: float = 4.0, length_unit: str = "m") -> Axes:
        """Draw the rope seen along its axis, and the two circles between which it stays.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        half_waves : float
            How much of it, from a place nearest to the axis on.
        length_unit : str
            What to write on the axes.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If `half_waves` is not positive and finite.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
        >>> ax = rope.plot()
        >>> ax.get_xlabel()
        'across (m)'
        """
        from ..plots.style import plot_tortuous_rope

        long = one_positive("revchain.TortuousRope.plot", "half_waves", half_waves)
        return plot_tortuous_rope(self, ax, long, length_unit=length_unit)

    def __repr__(self) -> str:
        return (
            f"TortuousRope: radius {self.least_radius:g} to {self.greatest_radius:g}, "
            f"{self.half_wave_angle:g} rad in {self.half_wave:g}"
        )
