# SPDX-License-Identifier: GPL-3.0-or-later
"""Thomson's gyrostatic string: a row of links with flywheels under tension, in which the plane of vibration turns."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..systems.drawing import Plot
from ..systems.numbers import STANDARD_GRAVITY, floats, numbers, one_positive, real, refuse_where
from .table import FloatOrArray, described


class WaveSpeeds(NamedTuple):
    """Speeds of the two circular waves in rad/s: `forward`, in the direction of a positive momentum, and `backward`.

    The backward speed is negative.

    Examples
    --------
    >>> import revchain as rc
    >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0, centroid=1.0)
    >>> float(string.angular_speeds(0.5).backward.round(4))
    -4.8272
    """

    forward: FloatOrArray
    backward: FloatOrArray


@described(
    "speeds 4 ulp; phases 4 ulp and rotations 8 ulp, divided by the cosine of half the phase, for any momentum, if the "
    "terms of the balance do not cancel",
    "section 8, after Thomson (Lord Kelvin)",
    "O(1) for each number",
)
@dataclass(frozen=True, slots=True, kw_only=True)
class GyrostaticString:
    """Equal links jointed in a row under tension, each with a flywheel about its own axis.

    In a circular wave every pin circles about the line with speed n, and each lags its neighbour by a phase:
    ``(T/a + n H/a^2) 4 sin^2(phase/2) = (n^2/g) (W - 4 X sin^2(phase/2))``, where ``X`` is
    ``W (h (a - h) - rho^2)/a^2``. The spin makes the string stiffer in one direction of rotation and softer in the
    other. A planar vibration is the sum of two circular waves. Its plane therefore turns along the string, as the plane
    of polarized light does in a magnetized body.

    weight: Weight of a link with its wheel
    length: Distance between the pins of a link
    tension: Tension of the string, a force
    centroid: Distance of the centre of gravity of a link from a pin; the middle if left out.
    radius_of_gyration: Radius of gyration of a link about an axis across the line through its centre of gravity
    gravity: Acceleration of gravity, which relates `weight` to mass (standard gravity in m/s^2 if left out)
    raises: If a number is out of its range or not finite.
    notes: The model is for small offsets; the weight of the links acts only as inertia.

    >>> momentum = 15.0 / 9.80665 * 0.29**2 * 40.0
    >>> wheels = rc.GyrostaticString(weight=15.0, length=0.1, tension=2000.0, radius_of_gyration=0.2, momentum=momentum)
    >>> float(wheels.plane_rotation(20.0).round(6))
    0.070144
    """

    plot = Plot()
    plot_vibration = Plot("vibration")

    weight: float
    length: float
    tension: float
    momentum: float
    centroid: float | None = None
    radius_of_gyration: float = 0.0
    gravity: float = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        for name, value in asdict(self).items():
            checked = one_positive if name in ("weight", "length", "tension", "gravity") else real
            given = self.length / 2 if name == "centroid" and value is None else value
            object.__setattr__(self, name, checked("revchain.GyrostaticString", name, given))
        self.phase(0.0)  # the compiled function checks the rest

    @described()
    def phase(self, angular_speed: ArrayLike) -> FloatOrArray:
        """Return the phase by which each pin of a circular wave lags its neighbour.

        angular_speed: Speeds in rad/s, finite, positive or negative.
        returns: Phase in rad, from 0 to pi.

        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=0.0, centroid=1.0)
        >>> float(string.phase(20.0).round(6))
        3.141593
        """
        return self._at("phase", "angular_speed", angular_speed, _core.gyrostatic_string_phase)[0]

    @described()
    def attenuation(self, angular_speed: ArrayLike) -> FloatOrArray:
        """Return the logarithmic decrease of the amplitude of a circular wave from link to link.

        angular_speed: Speeds in rad/s, finite, positive or negative.
        returns: Decrease; 0 if the wave passes without loss.

        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=0.0, centroid=1.0)
        >>> string.attenuation([10.0, 40.0]).round(6)
        array([0.      , 2.633916])
        """
        return self._at("attenuation", "angular_speed", angular_speed, _core.gyrostatic_string_phase)[1]

    @described()
    def angular_speeds(self, phase: ArrayLike) -> WaveSpeeds:
        """Return the speeds of the two circular waves with a given phase from link to link.

        phase: Phase in rad, above 0 and at most pi; other values raise a ValueError.

        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0, centroid=1.0)
        >>> waves = string.angular_speeds([0.5, 1.0])
        >>> waves.forward.round(4), waves.backward.round(4)
        (array([ 5.072 , 10.0592]), array([-4.8272, -9.1398]))
        """
        return WaveSpeeds(*self._at("angular_speeds", "phase", phase, _core.gyrostatic_string_speeds))

    @described()
    def plane_rotation(self, angular_speed: ArrayLike) -> FloatOrArray:
        """Return the angle by which the plane of a planar vibration turns from link to link.

        angular_speed: Angular frequency of the vibration, rad/s, positive and finite; other values raise a ValueError.
        returns: Angle in rad, in the direction of a positive momentum. It is equal for waves that run either way, and
            NaN if one of the two circular waves does not pass.

        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1e-9, centroid=1.0)
        >>> bool(string.plane_rotation(10.0) > 0)
        True
        """
        place = "revchain.GyrostaticString.plane_rotation"
        speed = floats(place, "angular_speed", angular_speed)
        refuse_where(~(speed > 0), speed, f"{place}: angular_speed must be positive")
        return self._at("plane_rotation", "angular_speed", speed, _core.gyrostatic_string_rotation)[0]

    def _at(self, method: str, name: str, value: ArrayLike, function: Any) -> tuple[FloatOrArray, ...]:
        return tuple(numbers(function(floats(f"revchain.GyrostaticString.{method}", name, value), **asdict(self))))
