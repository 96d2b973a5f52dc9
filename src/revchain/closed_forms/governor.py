# SPDX-License-Identifier: GPL-3.0-or-later
"""The governor: a compound link hinged on an axis that is made to turn, in its turning plane.

``theta'' = n**2 sin(theta) cos(theta) - (g/l) sin(theta)`` in closed form, from any start. Source:
Greenhill (1908), section 7. Angles are in radians, from the downward vertical.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, floats, numbers, real

if TYPE_CHECKING:
    from matplotlib.axes import Axes

__all__ = ["GovernorMotion", "GovernorState"]


class GovernorState(NamedTuple):
    """Angle and its rate at one time or many.

    Attributes
    ----------
    angle : float or ndarray
    angle_rate : float or ndarray
    """

    angle: Any
    angle_rate: Any


class GovernorMotion:
    """The motion of a link hinged on a turning axis.

    Parameters
    ----------
    angular_speed : float
        Of the axis; 0 is the plain pendulum.
    pendulum_length : float
        Length of the equivalent simple pendulum about the hinge, positive.
    angle, angle_rate : float
        Where the link is and how fast it moves at time 0.
    gravity : float
        Negative: the axis upside down.
    axial_inertia : float
        Moment of inertia about the link's own line over that about the hinge across it, 0 to 1.

    Raises
    ------
    ValueError
        If a number is not finite, `pendulum_length` not positive, or `axial_inertia` outside 0 to 1; if numbers are
        so far apart (a factor of 1e150) that the motion has no digits.

    Notes
    -----
    Accuracy, measured against integration in quadruple precision: of angles 1e-13 of the greatest and of
    ``t`` times the greatest rate, of rates 1e-13 of the greatest and of ``t`` times the greatest
    acceleration: after 1e13 periods no digit of them is known; next to the motions that take for ever as far as the start, rounded to double, says
    which side they are on. Cost: 2 microseconds, and 0.2 for each time.

    References
    ----------
    Greenhill (1908), section 7 (1)-(13).

    Examples
    --------
    >>> import revchain as rc
    >>> swing = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)
    >>> swing.regime
    'aside'
    >>> round(swing.period, 4), round(swing.least_angle, 4)
    (1.442, 0.7759)
    """

    __slots__ = ("_compiled",)
    _compiled: _core.GovernorMotion

    def __init__(
        self,
        *,
        angular_speed: float,
        pendulum_length: float,
        angle: float,
        angle_rate: float = 0.0,
        gravity: float = STANDARD_GRAVITY,
        axial_inertia: float = 0.0,
    ) -> None:
        place = "revchain.GovernorMotion"
        self._compiled = _core.GovernorMotion(
            real(place, "angular_speed", angular_speed),
            real(place, "pendulum_length", pendulum_length),
            real(place, "gravity", gravity),
            real(place, "angle", angle),
            real(place, "angle_rate", angle_rate),
            real(place, "axial_inertia", axial_inertia),
        )

    @property
    def regime(self) -> str:
        """``rest``, ``aside`` (dn), ``asymptotic`` (sech, sinh), ``through`` (cn) or ``revolutions`` (tn)."""
        return self._compiled.regime

    @property
    def period(self) -> float:
        """Of the motion, of one turn where it revolves; infinite where it never returns, 0 at rest."""
        return self._compiled.period

    @property
    def least_angle(self) -> float:
        """Turning angle; minus infinity where it revolves."""
        return self._compiled.least_angle

    @property
    def greatest_angle(self) -> float:
        """Turning angle; infinity where it revolves."""
        return self._compiled.greatest_angle

    @property
    def modulus(self) -> float:
        """Of the elliptic functions."""
        return self._compiled.modulus

    @property
    def complementary_modulus(self) -> float:
        """Its complement, which says more next to the motions that never return."""
        return self._compiled.complementary_modulus

    def angle(self, time: ArrayLike) -> Any:
        """Return the angle, counting whole turns.

        Parameters
        ----------
        time : array_like
            Any shape.

        Returns
        -------
        float or ndarray
            In rad, of the shape of `time`.

        Raises
        ------
        ValueError
            If a time is not finite.

        Examples
        --------
        >>> import revchain as rc
        >>> swing = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)
        >>> round(float(swing.angle(swing.period / 2)), 4)
        0.7759
        """
        return self.state(time).angle

    def angle_rate(self, time: ArrayLike) -> Any:
        """Return the rate of the angle.

        Parameters
        ----------
        time : array_like
            Any shape.

        Returns
        -------
        float or ndarray
            In rad/s, of the shape of `time`.

        Raises
        ------
        ValueError
            If a time is not finite.

        Examples
        --------
        >>> import revchain as rc
        >>> swing = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)
        >>> round(float(swing.angle_rate(0.3)), 4)
        -1.5995
        """
        return self.state(time).angle_rate

    def state(self, time: ArrayLike) -> GovernorState:
        """Return the angle and its rate.

        Parameters
        ----------
        time : array_like
            Any shape.

        Returns
        -------
        GovernorState
            Each of the shape of `time`. Cost 0.2 microseconds a number.

        Raises
        ------
        ValueError
            If a time is not finite.

        Examples
        --------
        >>> import revchain as rc
        >>> swing = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)
        >>> swing.state([0.0, 0.3]).angle.round(4)
        array([1.5   , 1.2026])
        """
        values = self._compiled.state(floats("revchain.GovernorMotion.state", "time", time))
        return GovernorState(*numbers(values))

    def plot(self, ax: Axes | None = None, *, duration: float | None = None) -> Axes:
        """Draw the angle against time, and the turning angles.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        duration : float, optional
            In seconds; two periods if left out.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If the motion never returns and no `duration` is given, or it is not positive and finite.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5).plot()
        >>> ax.get_ylabel()
        'angle (degrees)'
        """
        from ..plots.style import plot_governor

        return plot_governor(self, ax, duration)

    def __repr__(self) -> str:
        return f"GovernorMotion: {self.regime}, period {self.period:g}"
