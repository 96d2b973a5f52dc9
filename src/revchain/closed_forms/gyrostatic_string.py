# SPDX-License-Identifier: GPL-3.0-or-later
"""Thomson's gyrostatic string: a row of spinning links under a pull, in which the plane of vibration turns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, Floats, count, floats, numbers, one_positive, real, refuse_where
from ..systems.unchangeable import Unchangeable

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_LINKS_SEEN = 12  # of which the plane is drawn end on


class WaveSpeeds(NamedTuple):
    """Speeds of the two circular waves with one phase from link to link.

    Attributes
    ----------
    forward : float or ndarray
        In the sense of a positive momentum, rad/s.
    backward : float or ndarray
        Against it, negative.
    """

    forward: Any
    backward: Any


class GyrostaticString(Unchangeable):
    """Equal links jointed in a row under one pull, each with a flywheel about its own axis.

    In a circular wave every pin runs round the line with speed n, each a phase behind its neighbour:
    ``(T/a + n H/a^2) 4 sin^2(phase/2) = (n^2/g) (W - 4 X sin^2(phase/2))``, where ``X`` is
    ``W (h (a - h) - rho^2)/a^2``. The spin makes the string stiffer one way round and softer the other: of a vibration
    to and fro, which is two circular waves, the plane turns along the string, as that of light does in a magnetised
    body.

    Parameters
    ----------
    weight, length : float
        Of a link with its wheel, and between its pins; positive.
    tension : float
        Positive.
    momentum : float
        Angular momentum that each wheel keeps, force times length times time; see `revchain.free_flywheel`.
    centroid : float, optional
        Of a link, from a pin; the middle if left out.
    radius_of_gyration : float
        Of a link, across the line, about its centre of gravity; not negative.
    gravity : float
        What `weight` is under; standard gravity, in m/s^2, if left out.

    Raises
    ------
    ValueError
        For numbers out of their range or not finite.

    Notes
    -----
    Small offsets; the links' weight tells in their inertia alone. Accuracy, where the terms of
    the balance do not cancel: speeds 4 ulp, phases 4 ulp and rotations 8 ulp over the cosine of half the phase, however
    small the momentum.

    References
    ----------
    Greenhill (1908), section 8, and Thomson (Lord Kelvin), whose string it is.

    Examples
    --------
    >>> import revchain as rc
    >>> spin = rc.free_flywheel(weight=15.0, radius_of_gyration=0.29, spin=40.0)
    >>> wheels = rc.GyrostaticString(weight=15.0, length=0.1, tension=2000.0, radius_of_gyration=0.2, **spin)
    >>> float(wheels.plane_rotation(20.0).round(6))
    0.070144
    """

    __slots__ = ("_given",)
    _given: dict[str, float]

    def __init__(
        self,
        *,
        weight: float,
        length: float,
        tension: float,
        momentum: float,
        centroid: float | None = None,
        radius_of_gyration: float = 0.0,
        gravity: float = STANDARD_GRAVITY,
    ) -> None:
        place = "revchain.GyrostaticString"
        given = {name: one_positive(place, name, value) for name, value in (("weight", weight), ("length", length))}
        given["tension"] = one_positive(place, "tension", tension)
        given["momentum"] = real(place, "momentum", momentum)
        given["centroid"] = given["length"] / 2 if centroid is None else real(place, "centroid", centroid)
        given["radius_of_gyration"] = real(place, "radius_of_gyration", radius_of_gyration)
        given["gravity"] = one_positive(place, "gravity", gravity)
        object.__setattr__(self, "_given", given)
        self.phase(0.0)  # what else is wrong with them

    @property
    def weight(self) -> float:
        """Of a link with its wheel."""
        return self._given["weight"]

    @property
    def length(self) -> float:
        """Of a link, from pin to pin."""
        return self._given["length"]

    @property
    def tension(self) -> float:
        """Of the string."""
        return self._given["tension"]

    @property
    def momentum(self) -> float:
        """Of each wheel."""
        return self._given["momentum"]

    def phase(self, angular_speed: ArrayLike) -> Any:
        """Return by how much each pin of a circular wave is behind its neighbour.

        Parameters
        ----------
        angular_speed : array_like
            rad/s, of either sign.

        Returns
        -------
        float or ndarray
            rad, 0 to pi.

        Raises
        ------
        ValueError
            If a speed is not finite.

        Examples
        --------
        >>> import revchain as rc
        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=0.0, centroid=1.0)
        >>> float(string.phase(20.0).round(6))
        3.141593
        """
        return self._at("phase", angular_speed, _core.gyrostatic_string_phase)[0]

    def attenuation(self, angular_speed: ArrayLike) -> Any:
        """Return by how much the logarithm of a circular wave falls from link to link.

        Parameters
        ----------
        angular_speed : array_like
            rad/s, of either sign.

        Returns
        -------
        float or ndarray
            0 where the wave passes.

        Raises
        ------
        ValueError
            If a speed is not finite.

        Examples
        --------
        >>> import revchain as rc
        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=0.0, centroid=1.0)
        >>> string.attenuation([10.0, 40.0]).round(6)
        array([0.      , 2.633916])
        """
        return self._at("attenuation", angular_speed, _core.gyrostatic_string_phase)[1]

    def angular_speeds(self, phase: ArrayLike) -> WaveSpeeds:
        """Return the speeds of the two circular waves with a phase from link to link.

        Parameters
        ----------
        phase : array_like
            rad, above 0, not above pi.

        Returns
        -------
        WaveSpeeds

        Raises
        ------
        ValueError
            If a phase lies elsewhere.

        Examples
        --------
        >>> import revchain as rc
        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0, centroid=1.0)
        >>> waves = string.angular_speeds([0.5, 1.0])
        >>> waves.forward.round(4), waves.backward.round(4)
        (array([ 5.072 , 10.0592]), array([-4.8272, -9.1398]))
        """
        return WaveSpeeds(*self._at("angular_speeds", phase, _core.gyrostatic_string_speeds, "phase"))

    def plane_rotation(self, angular_speed: ArrayLike) -> Any:
        """Return by how much the plane of a vibration to and fro turns from link to link.

        Parameters
        ----------
        angular_speed : array_like
            Of the vibration, ``2 pi`` times its frequency; positive.

        Returns
        -------
        float or ndarray
            rad, in the sense of a positive momentum; the same for waves that run either way. NaN where one of
            the two circular waves does not pass.

        Raises
        ------
        ValueError
            If a speed is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1e-9, centroid=1.0)
        >>> bool(string.plane_rotation(10.0) > 0)
        True
        """
        place = "revchain.GyrostaticString.plane_rotation"
        speed = floats(place, "angular_speed", angular_speed)
        refuse_where(~(speed > 0), speed, f"{place}: angular_speed must be positive")
        return self._at("plane_rotation", speed, _core.gyrostatic_string_rotation)[0]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the speeds of circular waves over their phase, both senses.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.

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
        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0)
        >>> string.plot().get_xlabel()
        'phase from link to link (degrees)'
        """
        from ..plots.style import axes_or_new

        ax = axes_or_new(ax, 5.0, 4.0)
        phase = np.linspace(0.0, np.pi, 200)[1:]
        speeds = self.angular_speeds(phase)
        degrees = np.degrees(phase)
        ax.plot(
            degrees, speeds.forward, color="C0", label="with the spin" if self.momentum >= 0 else "against the spin"
        )
        ax.plot(
            degrees, -speeds.backward, color="C3", label="against the spin" if self.momentum >= 0 else "with the spin"
        )
        ax.set(xlabel="phase from link to link (degrees)", ylabel="speed (rad/s)", xlim=(0, 180))
        both = np.concatenate([speeds.forward, -speeds.backward])
        usual = 2 * np.nanmedian(both)  # a wave of bodies without inertia across themselves has no bound at 180 degrees
        ax.set_ylim(0, usual if np.nanmax(both) > 3 * usual else None)
        ax.legend()
        return ax

    def plot_vibration(self, angular_speed: float, links: int = 60, ax: Axes | None = None) -> Axes:
        """Draw how the plane of a vibration turns along the string: seen from the side and, for some links, end on.

        Parameters
        ----------
        angular_speed : float
            Of the vibration, positive.
        links : int
            How many.
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If one of the two circular waves does not pass at that speed.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0)
        >>> string.plot_vibration(8.0).get_xlabel()
        'link'
        """
        from ..plots.style import axes_or_new

        place = "revchain.GyrostaticString.plot_vibration"
        speed = one_positive(place, "angular_speed", angular_speed)
        size = count(place, "links", links, each=64)
        turn = float(self.plane_rotation(speed))
        if np.isnan(turn):
            raise ValueError(f"{place}: a circular wave does not pass at angular_speed, got {speed:g}")
        mean = float(self.phase(speed) + self.phase(-speed)) / 2
        ax = axes_or_new(ax, 8.0, 4.0)
        pin = np.arange(size + 1)
        wave, angle = np.cos(mean * pin), turn * pin
        ax.plot(pin, wave * np.cos(angle), color="C0", linewidth=1.2, label="in the plane it starts in")
        ax.plot(pin, wave * np.sin(angle), color="C3", linewidth=1.2, label="across it")
        for at in np.unique(np.linspace(0, size, min(MOST_LINKS_SEEN, size) + 1).astype(int)):
            across, along = 0.45 * np.sin(turn * at), 0.22 * np.cos(turn * at)
            scale = size / 30
            ax.plot(
                [at - across * scale, at + across * scale], [1.5 - along, 1.5 + along], color="black", linewidth=1.4
            )
        ax.annotate("plane of vibration, end on", (0.0, 1.85), fontsize="small")
        ax.set(xlabel="link", ylabel="offset over the amplitude", ylim=(-1.7, 2.1), yticks=[-1, 0, 1])
        ax.legend(loc="lower center", ncols=2, fontsize="small")
        return ax

    def _at(self, name: str, value: ArrayLike, function: Any, what: str = "angular_speed") -> tuple[Any, ...]:
        array: Floats = floats(f"revchain.GyrostaticString.{name}", what, value)
        return tuple(numbers(function(array, **self._given)))

    def __repr__(self) -> str:
        return "GyrostaticString(" + ", ".join(f"{name}={value:g}" for name, value in self._given.items()) + ")"

    def __eq__(self, other: object) -> bool:
        return self._given == other._given if isinstance(other, GyrostaticString) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self._given.values()))

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self._given,)


def _restored(given: dict[str, float]) -> GyrostaticString:
    """A string from its pickled state."""
    return GyrostaticString(**given)
