# SPDX-License-Identifier: GPL-3.0-or-later
"""Funicular polygons: weights at rest on a thread between two supports, and their small transverse oscillations."""

from __future__ import annotations


import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Field, Result
from ..results.sheet import Column, Sheet, speed_columns
from ..systems.numbers import STANDARD_GRAVITY, Floats, floats, one_positive, positive, real, reals
from . import conical_pendulum
from .table import described


class TransverseModes(Result):
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
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.")
    angular_speed: Field[Floats] = Field(
        "Natural angular frequency, rad/s, shape (n,).",
        lambda m: conical_pendulum.angular_speed(m.conical_height, m.gravity),
    )
    frequency: Field[Floats] = Field(
        "Natural frequency, Hz, shape (n,).",
        lambda m: conical_pendulum.revolutions_per_second(m.conical_height, m.gravity),
    )
    period: Field[Floats] = Field(
        "Period of one oscillation, s, shape (n,).",
        lambda m: conical_pendulum.period(m.conical_height, m.gravity),
    )
    conical_height: Field[Floats] = Field("Conical height of a pendulum of that period, m, shape (n,).")
    error_bound: Field[Floats] = Field("Bound of the relative error of each conical height, shape (n,).")
    shape: Field[Floats] = Field(
        "Offsets of the first support, the weights and the last support, shape (n, n + 2). The largest is 1; the offset "
        "of the first weight is positive.",
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        size = len(self.conical_height)
        columns = [
            Column("mode", np.arange(1, size + 1), "mode"),
            *speed_columns(self.angular_speed),
            Column("conical_height", self.conical_height, "height (m)"),
            Column("error_bound", self.error_bound, "error bound"),
            Column("shape", self.shape, axes=("point",)),
        ]
        return Sheet("mode", f"TransverseModes: {size} mode{'s' * (size != 1)}", columns, {"gravity": self.gravity})


class FunicularPolygon(Result):
    """Weights on a thread between two supports, at rest in a vertical plane; returned by `funicular_polygon`.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5)
    FunicularPolygon: 2 weights, horizontal tension 0.5
    point    place    height   weight  tension in next segment
        0  0.00000   0.00000      nan                  1.11803
        1  1.00000  -2.00000  1.00000                 0.500000
        2  2.00000  -2.00000  1.00000                  1.11803
        3  3.00000   0.00000      nan                      nan
    """

    __slots__ = ()
    weight: Field[Floats] = Field("The weights from the first support to the last, shape (n,).")
    place: Field[Floats] = Field("Places of supports and weights along the horizontal, shape (n + 2,).")
    height: Field[Floats] = Field("Heights of supports and weights, shape (n + 2,).")
    rise: Field[Floats] = Field(
        "Vertical component of the tension of each side, shape (n + 1,). In the force diagram the ray of a side runs "
        "from the pole to ``(horizontal_tension, rise)`` on the load line.",
    )
    tension: Field[Floats] = Field("Tension of each side, shape (n + 1,).")
    horizontal_tension: Field[float] = Field(
        "Horizontal component of the tension, equal in all sides: the distance of the pole from the load line.",
    )

    @described()
    def transverse_modes(self, *, gravity: float = STANDARD_GRAVITY) -> TransverseModes:
        """Return the small oscillations of the weights perpendicular to the plane of the polygon.

        returns: Result of `transverse_modes` for the weights, positions and horizontal tension of the polygon.
        notes: The weights are moved vertically to a horizontal thread of uniform tension, Greenhill (1908), section
            3. This is exact for small oscillations: a side of length a and tension T has the transverse stiffness
            T/a, which equals the horizontal tension divided by the horizontal length.

        >>> line = rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5)
        >>> line.transverse_modes().conical_height.round(6)
        array([2.      , 0.666667])
        """
        return transverse_modes(self.weight, self.place, self.horizontal_tension, gravity=gravity)

    def _sheet(self, brief: bool = False) -> Sheet:
        gap = [np.nan]
        columns = [
            Column("point", np.arange(len(self.place)), "point"),
            Column("place", self.place, "place"),
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
    "O(n); 40 microseconds for 1000 weights",
)
def funicular_polygon(
    weight: ArrayLike, place: ArrayLike, horizontal_tension: float, *, first_height: float = 0.0,
    last_height: float = 0.0,
) -> FunicularPolygon:
    """Return the funicular polygon of weights on a thread between two supports.

    weight: The n weights from the first support to the last
    place: The n + 2 horizontal positions of the first support, the weights and the last support, increasing.
    horizontal_tension: Horizontal component of the tension, in the unit of the weights, positive.
    returns: Heights and tensions of the thread.
    raises: If a number is out of its range, or there are not two more positions than weights.

    >>> rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5).height
    array([ 0., -2., -2.,  0.])
    """
    name = "revchain.funicular_polygon"
    weights, at = _string(name, weight, place)
    given = reals(name, horizontal_tension=horizontal_tension, first_height=first_height, last_height=last_height)
    return FunicularPolygon._made(_core.funicular_polygon(weights, at, **given), weight=weights.copy())


@described("2 ulp of the conical heights", "section 3", "O(n**2); 14 ms for 1000 weights")
def transverse_modes(
    weight: ArrayLike, place: ArrayLike, tension: float, *, gravity: float = STANDARD_GRAVITY
) -> TransverseModes:
    """Return the small transverse oscillations of a string of weights held at both ends.

    weight: The n weights from the first support to the last
    place: The n + 2 positions of the first support, the weights and the last support along the string, increasing.
    tension: Tension of the string, uniform, in the unit of the weights
    gravity: Acceleration of gravity, which relates weights to masses (standard gravity in m/s^2 if left out)
    returns: All n modes.
    raises: If a number is out of its range, or there are not two more positions than weights.
    notes: Method: the modes of a hanging chain with these weights and spacings, stretched by a very great weight.

    >>> rc.transverse_modes([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], tension=5.0).shape.round(6)
    array([[ 0.,  1.,  1.,  0.],
           [ 0.,  1., -1.,  0.]])
    """
    name = "revchain.transverse_modes"
    weights, at = _string(name, weight, place)
    height, bound, shape = _core.transverse_modes(weights, at, real(name, "tension", tension))
    g = one_positive(name, "gravity", gravity)
    return TransverseModes._made(None, gravity=g, conical_height=height, error_bound=bound, shape=shape)


def _string(name: str, weight: ArrayLike, place: ArrayLike) -> tuple[Floats, Floats]:
    """Positive weights and places, each with one axis; the compiled module checks how many there are."""
    weights, at = positive(name, "weight", weight), floats(name, "place", place)
    for given, array in (("weight", weights), ("place", at)):
        if array.ndim != 1:
            raise ValueError(f"{name}: {given} must be a list of numbers, got an array of shape {array.shape}")
    return weights, at
