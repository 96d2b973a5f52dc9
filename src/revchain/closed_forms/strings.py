# SPDX-License-Identifier: GPL-3.0-or-later
"""Weights and links in a row under tension: the funicular polygon, its small oscillations, Thomson's gyrostatic string.

Source: Greenhill (1908), sections 3 and 8.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Field, Result
from ..results.sheet import Column, Sheet
from ..systems.chain import checked
from ..systems.drawing import Plot
from ..systems.numbers import (
    STANDARD_GRAVITY, Floats, Whole, floats, numbers, one_positive, positive, real, reals, refuse_where,
)
from . import conical_pendulum
from .table import FloatOrArray, described


class TransverseModes(Result, row="mode", title="TransverseModes: {_many}"):
    """Small transverse oscillations of a string of n weights, slowest first; returned by `transverse_modes`.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.transverse_modes([2.0], [0.0, 1.0, 2.0], tension=8.0)
    TransverseModes: 1 mode
    mode  speed (rad/s)  speed (rpm)  height (m)  error bound
       1        8.85738      84.5818    0.125000      7.8e-16
    """

    __slots__ = ()
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    mode: Field[Whole] = Field(
        "Numbers of the modes, the slowest first.", lambda m: np.arange(1, 1 + len(m.conical_height)), heading="mode"
    )
    angular_speed: Field[Floats] = Field(
        "Natural angular frequency, rad/s, shape (n,).",
        lambda m: conical_pendulum.angular_speed(m.conical_height, m.gravity),
        heading="speed",
        unit="rad/s",
    )
    rpm: Field[Floats] = Field(
        "Oscillations per minute, shape (n,).", lambda m: 60 * m.frequency, heading="speed", unit="rpm"
    )
    frequency: Field[Floats] = Field(
        "Natural frequency, Hz, shape (n,).",
        lambda m: conical_pendulum.revolutions_per_second(m.conical_height, m.gravity),
    )
    period: Field[Floats] = Field(
        "Period of one oscillation, s, shape (n,).",
        lambda m: conical_pendulum.period(m.conical_height, m.gravity),
    )
    conical_height: Field[Floats] = Field(
        "Conical height of a pendulum of that period, m, shape (n,).", heading="height", unit="m"
    )
    error_bound: Field[Floats] = Field(
        "Proved bound of the relative error of each conical height, shape (n,).", heading="error bound"
    )
    shape: Field[Floats] = Field(
        "Offsets of the first support, the weights and the last support, shape (n, n + 2); the largest size is 1.",
        axes=("point",),
    )

    @property
    def _many(self) -> str:
        return f"{len(self.mode)} mode{'s' * (len(self.mode) != 1)}"


class FunicularPolygon(Result):
    """Weights on a thread between two supports, at rest in a vertical plane; returned by `funicular_polygon`.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5)
    FunicularPolygon: 2 weights, horizontal tension 0.5
    point  position    height   weight  tension in next segment
        0   0.00000   0.00000      nan                  1.11803
        1   1.00000  -2.00000  1.00000                 0.500000
        2   2.00000  -2.00000  1.00000                  1.11803
        3   3.00000   0.00000      nan                      nan
    """

    __slots__ = ()
    weight: Field[Floats] = Field("The weights from the first support to the last, shape (n,).")
    position: Field[Floats] = Field("Positions of supports and weights along the horizontal, shape (n + 2,).")
    height: Field[Floats] = Field("Heights of supports and weights, shape (n + 2,).")
    rise: Field[Floats] = Field(
        "Vertical component of the tension of each side, shape (n + 1,).",
    )
    tension: Field[Floats] = Field("Tension of each side, shape (n + 1,).")
    horizontal_tension: Field[float] = Field(
        "Horizontal component of the tension, equal in all sides.",
    )

    @described()
    def transverse_modes(self, *, gravity: float = STANDARD_GRAVITY) -> TransverseModes:
        """Return the small oscillations of the weights perpendicular to the plane of the polygon.

        returns: Result of `transverse_modes` for the weights, positions and horizontal tension of the polygon.
        notes: The weights are moved vertically to a horizontal thread of uniform tension, Greenhill (1908), section 3. A
            side of length a and tension T has the transverse stiffness T/a, the horizontal tension over the horizontal
            length.

        >>> line = rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5)
        >>> line.transverse_modes().conical_height.round(6)
        array([2.      , 0.666667])
        """
        return transverse_modes(self.weight, self.position, self.horizontal_tension, gravity=gravity)

    def _sheet(self, brief: bool = False) -> Sheet:
        gap = [np.nan]
        columns = [
            Column("point", np.arange(len(self.position)), "point"),
            Column("position", self.position, "position"),
            Column("height", self.height, "height"),
            Column("weight", np.concatenate([gap, self.weight, gap]), "weight"),
            Column("tension", np.concatenate([self.tension, gap]), "tension in next segment"),
            Column("rise", np.concatenate([self.rise, gap])),
        ]
        size, pull = len(self.weight), self.horizontal_tension
        heading = f"FunicularPolygon: {size} weight{'s' * (size != 1)}, horizontal tension {pull:.6g}"
        return Sheet("point", heading, columns, {"horizontal_tension": pull})


@described(
    "half an ulp of the heights, plus 1e-28 of the drop below the chord", "section 3",
    "O(n)",
)
def funicular_polygon(
    weight: ArrayLike, position: ArrayLike, horizontal_tension: float, *, first_height: float = 0.0,
    last_height: float = 0.0,
) -> FunicularPolygon:
    """Return the funicular polygon of weights on a thread between two supports.

    weight: The n weights from the first support to the last
    position: The n + 2 horizontal positions of the first support, the weights and the last support, increasing.
    horizontal_tension: Horizontal component of the tension, in the unit of the weights, positive.
    returns: Heights and tensions of the thread.
    raises: If a number is out of its range, or there are not two more positions than weights.

    >>> rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5).height
    array([ 0., -2., -2.,  0.])
    """
    name = "revchain.funicular_polygon"
    weights, at = _string(name, weight, position)
    given = reals(name, horizontal_tension=horizontal_tension, first_height=first_height, last_height=last_height)
    return FunicularPolygon._made(_core.funicular_polygon(weights, at, **given), weight=weights.copy())


@described("2 ulp of the conical heights", "section 3", "O(n**2); 20 ms for 1000 weights")
def transverse_modes(
    weight: ArrayLike, position: ArrayLike, tension: float, *, gravity: float = STANDARD_GRAVITY
) -> TransverseModes:
    """Return the small transverse oscillations of a string of weights held at both ends.

    weight: The n weights from the first support to the last
    position: The n + 2 positions of the first support, the weights and the last support along the string, increasing.
    tension: Tension of the string, uniform, in the unit of the weights
    gravity: Acceleration of gravity, which relates weights to masses (standard gravity in m/s^2 if left out)
    returns: All n modes.
    raises: If a number is out of its range, or there are not two more positions than weights.

    >>> rc.transverse_modes([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], tension=5.0).shape.round(6)
    array([[ 0.,  1.,  1.,  0.],
           [ 0.,  1., -1.,  0.]])
    """
    name = "revchain.transverse_modes"
    weights, at = _string(name, weight, position)
    height, bound, shape = _core.transverse_modes(weights, at, real(name, "tension", tension))
    g = one_positive(name, "gravity", gravity)
    return TransverseModes._made(None, gravity=g, conical_height=height, error_bound=bound, shape=shape)


def _string(name: str, weight: ArrayLike, position: ArrayLike) -> tuple[Floats, Floats]:
    """Return positive weights and their positions, each with one axis; the compiled module checks their numbers."""
    weights, at = positive(name, "weight", weight), floats(name, "position", position)
    for given, array in (("weight", weights), ("position", at)):
        if array.ndim != 1:
            raise ValueError(f"{name}: {given} must be a list of numbers, got an array of shape {array.shape}")
    return weights, at


class WaveSpeeds(NamedTuple):
    """Speeds of two circular waves in rad/s: `forward`, in the direction of a positive momentum, `backward`, negative.

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

    In a circular wave the pins circle about the line with speed n, and each lags its neighbour by a phase:
    ``(T/a + n H/a^2) 4 sin^2(phase/2) = (n^2/g) (W - 4 X sin^2(phase/2))``, where ``X`` is
    ``W (h (a - h) - rho^2)/a^2``. A planar vibration is the sum of two circular waves; the spin turns its plane along
    the string.

    weight: Weight of a link with its wheel
    length: Distance between the pins of a link
    tension: Tension of the string, a force
    centroid: Distance of the centre of gravity of a link from a pin; the middle if left out.
    radius_of_gyration: Radius of gyration of a link about an axis across the line through its centre of gravity
    gravity: Acceleration of gravity, which relates `weight` to mass (standard gravity in m/s^2 if left out)
    raises: If a number is out of its range.
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
            read = one_positive if name in ("weight", "length", "tension", "gravity") else real
            given = self.length / 2 if name == "centroid" and value is None else value
            object.__setattr__(self, name, read("revchain.GyrostaticString", name, given))
        self.phase(0.0)  # the compiled function checks the rest

    @described()
    def phase(self, angular_speed: ArrayLike) -> FloatOrArray:
        """Return the phase by which each pin of a circular wave lags its neighbour.

        angular_speed: Speeds in rad/s, positive or negative.
        returns: Phase in rad, from 0 to pi.

        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=0.0, centroid=1.0)
        >>> float(string.phase(20.0).round(6))
        3.141593
        """
        return self._at("phase", "angular_speed", angular_speed, _core.gyrostatic_string_phase)[0]

    @described()
    def attenuation(self, angular_speed: ArrayLike) -> FloatOrArray:
        """Return the logarithmic decrease of the amplitude of a circular wave from link to link.

        angular_speed: Speeds in rad/s, positive or negative.
        returns: Decrease; 0 if the wave passes.

        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=0.0, centroid=1.0)
        >>> string.attenuation([10.0, 40.0]).round(6)
        array([0.      , 2.633916])
        """
        return self._at("attenuation", "angular_speed", angular_speed, _core.gyrostatic_string_phase)[1]

    @described()
    def angular_speeds(self, phase: ArrayLike) -> WaveSpeeds:
        """Return the speeds of the two circular waves with a given phase from link to link.

        phase: Phase in rad, above 0, not above pi
        raises: If a phase is out of its range.

        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0, centroid=1.0)
        >>> waves = string.angular_speeds([0.5, 1.0])
        >>> waves.forward.round(4), waves.backward.round(4)
        (array([ 5.072 , 10.0592]), array([-4.8272, -9.1398]))
        """
        return WaveSpeeds(*self._at("angular_speeds", "phase", phase, _core.gyrostatic_string_speeds))

    @described()
    def plane_rotation(self, angular_speed: ArrayLike) -> FloatOrArray:
        """Return the angle by which the plane of a planar vibration turns from link to link.

        angular_speed: Angular frequency of the vibration, rad/s
        returns: Angle in rad, in the direction of a positive momentum; NaN if one of the circular waves does not pass.
        raises: If a frequency is out of its range.

        >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1e-9, centroid=1.0)
        >>> bool(string.plane_rotation(10.0) > 0)
        True
        """
        caller = "revchain.GyrostaticString.plane_rotation"
        speed = floats(caller, "angular_speed", angular_speed)
        refuse_where(~(speed > 0), speed, f"{caller}: angular_speed must be positive")
        return self._at("plane_rotation", "angular_speed", speed, _core.gyrostatic_string_rotation)[0]

    def _at(self, method: str, name: str, value: ArrayLike, function: Any) -> tuple[FloatOrArray, ...]:
        caller = f"revchain.GyrostaticString.{method}"
        return tuple(numbers(checked(caller, False, function, floats(caller, name, value), **asdict(self))))
