# SPDX-License-Identifier: GPL-3.0-or-later
"""Force diagrams and funicular polygons, as data and as pictures."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Wrapped
from ..systems.numbers import STANDARD_GRAVITY, Floats, floats, one_positive, positive, read_only, real
from . import conical_pendulum

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class TransverseModes(NamedTuple):
    """Small transverse oscillations, slowest first.

    Attributes
    ----------
    conical_height : ndarray, shape (n,)
        Of the pendulum that keeps time with it.
    error_bound : ndarray, shape (n,)
        Relative.
    shape : ndarray, shape (n, n + 2)
        Of both supports and the weights; the largest is 1, the first weight to the positive side.
    """

    conical_height: Floats
    error_bound: Floats
    shape: Floats

    def period(self, gravity: float = STANDARD_GRAVITY) -> Floats:
        """Return the seconds of one oscillation to and fro.

        Parameters
        ----------
        gravity : float, optional
            In the unit of length per s^2, positive; standard gravity in m/s^2 if left out.

        Returns
        -------
        ndarray, shape (n,)

        Raises
        ------
        ValueError
            If `gravity` is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.transverse_modes([2.0], [0.0, 1.0, 2.0], tension=8.0).period().round(4)
        array([0.7094])
        """
        g = one_positive("revchain.TransverseModes.period", "gravity", gravity)
        seconds: Floats = conical_pendulum.period(self.conical_height, g)
        return seconds


class FunicularPolygon(Wrapped[_core.FunicularPolygon, Floats]):
    """Weights on a thread between two supports, at rest in a vertical plane.

    Returned by `funicular_polygon`; from the first support to the last.
    """

    __slots__ = ()

    @property
    def weight(self) -> Floats:
        """The weights, shape (n,)."""
        return self._given

    @property
    def place(self) -> Floats:
        """Of supports and weights along the horizontal, shape (n + 2,)."""
        return self._compiled.place

    @property
    def height(self) -> Floats:
        """Of supports and weights, shape (n + 2,)."""
        return self._compiled.height

    @property
    def rise(self) -> Floats:
        """Vertical component of each side's tension, shape (n + 1,).

        The ray from the pole to the line of load ends at ``(horizontal_tension, rise)``.
        """
        return self._compiled.rise

    @property
    def tension(self) -> Floats:
        """Of each side, shape (n + 1,)."""
        return self._compiled.tension

    @property
    def horizontal_tension(self) -> float:
        """Horizontal component, the same in all sides: the pole's distance from the line of load."""
        return self._compiled.horizontal_tension

    def transverse_modes(self) -> TransverseModes:
        """Return the small oscillations of the weights perpendicular to the polygon's plane.

        Returns
        -------
        TransverseModes
            Those of the string of weights: `transverse_modes` of weights, places and horizontal tension.

        Notes
        -----
        Greenhill (1908) section 3: the weights are transferred vertically to one horizontal line and held
        there on a thread of uniform tension. Exact for small oscillations: a side of length a and tension T
        resists with T/a, which is the horizontal tension over the horizontal length.

        Examples
        --------
        >>> import revchain as rc
        >>> line = rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5)
        >>> line.transverse_modes().conical_height.round(6)
        array([2.      , 0.666667])
        """
        return transverse_modes(self.weight, self.place, self.horizontal_tension)

    def plot(
        self, axes: tuple[Axes, Axes] | None = None, *, length_unit: str = "m", weight_unit: str = "N"
    ) -> tuple[Axes, Axes]:
        """Draw the polygon and its diagram of force side by side, sides and rays in the same colours.

        Parameters
        ----------
        axes : pair of matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        length_unit, weight_unit : str
            What to write on the axes.

        Returns
        -------
        pair of matplotlib.axes.Axes
            Of the polygon, with its weights transferred to a horizontal line, and of the forces.

        Raises
        ------
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> line = rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5)
        >>> polygon, forces = line.plot()
        >>> polygon.get_title()
        'funicular polygon'
        """
        from ..plots.statics import plot_funicular_polygon

        return plot_funicular_polygon(self, axes, length_unit=length_unit, weight_unit=weight_unit)

    def __repr__(self) -> str:
        return f"FunicularPolygon: {len(self.weight)} weights, horizontal tension {self.horizontal_tension:.6g}"


def funicular_polygon(
    weight: ArrayLike,
    place: ArrayLike,
    horizontal_tension: float,
    *,
    first_height: float = 0.0,
    last_height: float = 0.0,
) -> FunicularPolygon:
    """Return the polygon in which weights hang on a thread between two supports.

    Parameters
    ----------
    weight : array_like, shape (n,)
        Positive.
    place : array_like, shape (n + 2,)
        Of the first support, the weights and the last support along the horizontal, increasing.
    horizontal_tension : float
        Horizontal component of the tension, in the unit of the weights, positive.
    first_height, last_height : float
        Of the supports.

    Returns
    -------
    FunicularPolygon
        Heights within half an ulp, and 1e-28 of the drop below the chord.

    Raises
    ------
    ValueError
        If a number is out of its range, or there are not two more places than weights.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5).height
    array([ 0., -2., -2.,  0.])
    """
    name = "revchain.funicular_polygon"
    weights, at = _string(name, weight, place)
    compiled = _core.funicular_polygon(
        weights,
        at,
        real(name, "horizontal_tension", horizontal_tension),
        real(name, "first_height", first_height),
        real(name, "last_height", last_height),
    )
    return FunicularPolygon._wrap(compiled, read_only(weights.copy()))


def transverse_modes(weight: ArrayLike, place: ArrayLike, tension: float) -> TransverseModes:
    """Return the small oscillations of a string of weights, held at both ends, across itself.

    Parameters
    ----------
    weight : array_like, shape (n,)
        Positive.
    place : array_like, shape (n + 2,)
        Of the first support, the weights and the last support along the string, increasing.
    tension : float
        Uniform, in the unit of the weights, positive.

    Returns
    -------
    TransverseModes
        All n; heights to 2 ulp.

    Raises
    ------
    ValueError
        If a number is out of its range, or there are not two more places than weights.

    Notes
    -----
    By `modes` of a chain with the same weights and spacings, hung up and stretched by a weight so great
    that it does not move.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.transverse_modes([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], tension=0.5).shape.round(6)
    array([[ 0.,  1.,  1.,  0.],
           [ 0.,  1., -1.,  0.]])
    """
    name = "revchain.transverse_modes"
    weights, at = _string(name, weight, place)
    return TransverseModes(*_core.transverse_modes(weights, at, real(name, "tension", tension)))


def _string(name: str, weight: ArrayLike, place: ArrayLike) -> tuple[Floats, Floats]:
    """Weights, positive, and places, both of one axis; how many there are is left to the compiled module."""
    weights, at = positive(name, "weight", weight), floats(name, "place", place)
    for given, array in (("weight", weights), ("place", at)):
        if array.ndim != 1:
            raise ValueError(f"{name}: {given} must be a list of numbers, got an array of shape {array.shape}")
    return weights, at
