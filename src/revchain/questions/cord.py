# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of a whirling chain without links, at any inclination."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Wrapped, WrappedList
from ..systems.numbers import (
    STANDARD_GRAVITY,
    Floats,
    floats,
    height_of,
    integer,
    numbers,
    one_positive,
    real,
    refuse_where,
    shown,
)
from ..systems.numbers import count as checked_count

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class ContinuousPlace(NamedTuple):
    """What there is at places of a whirling chain.

    Attributes
    ----------
    offset : float or ndarray
        From the axis.
    height : float or ndarray
        Above the support: negative where the chain hangs.
    inclination : float or ndarray
        To the vertical, rad; positive where the chain leads towards the axis going up, as it does at the free end.
    tension : float or ndarray
        In the unit of line density times length.
    """

    offset: Any
    height: Any
    inclination: Any
    tension: Any


class ContinuousShape(Wrapped[_core.ContinuousShape, _core.LineDensity | None]):
    """One steady shape of a chain without links, in the units of the chain.

    Returned by `continuous_shapes`. Call it for the place at an arc length; the arrays are dense where the
    chain turns sharply.
    """

    __slots__ = ()  # the compiled shape points to the density given

    @property
    def arc_length(self) -> Floats:
        """From the free end, 0 to the length, shape (n,)."""
        return self._compiled.arc_length

    @property
    def offset(self) -> Floats:
        """From the axis, shape (n,): the free end's first, the support's 0 last."""
        return self._compiled.offset

    @property
    def height(self) -> Floats:
        """Above the support, shape (n,)."""
        return self._compiled.height

    @property
    def inclination(self) -> Floats:
        """To the vertical, rad, shape (n,); at the free end its tangent is offset over conical height."""
        return self._compiled.inclination

    @property
    def tension(self) -> Floats:
        """In the unit of line density times length, shape (n,)."""
        return self._compiled.tension

    @property
    def half_waves(self) -> int:
        """Crossings of the axis, the support among them."""
        return self._compiled.half_waves

    @property
    def length(self) -> float:
        """Of the chain."""
        return self._compiled.length

    @property
    def conical_height(self) -> float:
        """Of the speed."""
        return self._compiled.conical_height

    @property
    def residual(self) -> float:
        """Of the first integral of a uniform chain at the support, over its tension there.

        With a line density: of the tension's own series against pull and weight, over the largest tension.
        """
        return self._compiled.residual

    @property
    def error_bound(self) -> float:
        """Of every inclination, rad, and of every offset and height over the length: an estimate."""
        return self._compiled.error_bound

    @property
    def condition(self) -> float:
        """Largest change of an inclination, rad, per relative change of the length: great near a critical height."""
        return self._compiled.condition

    def __call__(self, arc_length: ArrayLike) -> ContinuousPlace:
        """Return the places at distances from the free end along the chain.

        Parameters
        ----------
        arc_length : array_like
            From 0 to `length`.

        Returns
        -------
        ContinuousPlace
            `offset`, `height`, `inclination`, `tension`, of the shape of `arc_length`; as accurate as
            the arrays. Cost: 1 microsecond each, 10 with a line density.

        Raises
        ------
        ValueError
            If a number lies outside the chain.

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.continuous_shapes(1.0, conical_height=0.1)[0]
        >>> round(float(shape(0.5).offset), 6)
        0.493314
        """
        place = "revchain.ContinuousShape"
        arc = floats(place, "arc_length", arc_length)
        refuse_where(~((arc >= 0) & (arc <= self.length)), arc, f"{place}: arc_length must lie between 0 and length")
        return ContinuousPlace(*numbers(self._compiled.at(arc)))

    def plot(self, ax: Axes | None = None, *, length_unit: str = "m") -> Axes:
        """Draw the shape, true to scale.

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
        >>> ax = rc.continuous_shapes(1.0, conical_height=0.1)[1].plot()
        >>> ax.get_ylabel()
        'above the support (m)'
        """
        from ..plots.style import plot_shapes

        return plot_shapes([self], ax, linked=False, length_unit=length_unit)

    def __repr__(self) -> str:
        tip = np.degrees(self.inclination[0])
        return f"ContinuousShape: half_waves {self.half_waves}, free end at {tip:.6g} degrees"


class ContinuousShapes(WrappedList[ContinuousShape]):
    """Steady shapes of a chain without links at one speed, by half waves, then offset of the free end."""

    __slots__ = ("_complete",)
    _complete: bool

    @classmethod
    def _wrap(cls, compiled: _core.ContinuousShapes, density: _core.LineDensity | None) -> ContinuousShapes:
        result = object.__new__(cls)
        result._complete = compiled.complete
        result._items = tuple(ContinuousShape._wrap(shape, density) for shape in compiled.shapes)
        return result

    @property
    def complete(self) -> bool:
        """Whether a theorem says that none is missing."""
        return self._complete

    def plot(self, ax: Axes | None = None, *, length_unit: str = "m") -> Axes:
        """Draw all shapes over one another, true to scale, coloured by half waves.

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
        >>> rc.continuous_shapes(1.0, conical_height=0.02).plot().get_title()
        '4 shapes, all there are'
        """
        from ..plots.style import plot_shapes

        axes = plot_shapes(self, ax, linked=False, length_unit=length_unit)
        number = f"{len(self)} shape{'s' * (len(self) != 1)}"
        axes.set_title(f"{number}, all there are" if self.complete else f"{number}; there may be more")
        return axes

    def __repr__(self) -> str:
        return f"ContinuousShapes: {len(self)}, {'all there are' if self.complete else 'there may be more'}"


def _checked(
    place: str, length: float, tip_weight: float, line_density: Callable[[float], float] | None
) -> tuple[float, float, _core.LineDensity | None]:
    """Length, tip weight and line density as the compiled module takes them."""
    long = one_positive(place, "length", length)
    tip = real(place, "tip_weight", tip_weight)
    if not 0 <= tip < np.inf:
        raise ValueError(f"{place}: tip_weight must be finite and not negative, got {tip:g}")
    if line_density is None:
        return long, tip, None
    if not callable(line_density):
        raise TypeError(
            f"{place}: line_density must be a function of the distance from the free end, got {shown(line_density)}"
        )

    def checked(s: float) -> float:
        return real(place, f"line_density({s:g})", line_density(s))

    return long, tip, _core.LineDensity(checked, long)


def continuous_shapes(
    length: float,
    *,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    tip_weight: float = 0.0,
    line_density: Callable[[float], float] | None = None,
    scanned: int = 200,
) -> ContinuousShapes:
    """Find the shapes in which a chain without links whirls steadily at a given speed, at any inclination.

    Parameters
    ----------
    length : float
        Of the chain, positive, up to a million conical heights.
    conical_height : float
        Of the speed, in the unit of `length`, positive.
    angular_speed : float
        Instead of `conical_height`: the speed in rad/s, positive.
    gravity : float, optional
        For `angular_speed`; standard gravity, in metres, if left out.
    tip_weight : float, optional
        Weight at the free end, in units of line density times length: without `line_density` the length of
        chain that weighs as much.
    line_density : callable, optional
        Weight per length as a function of the distance from the free end, positive inside the chain; a
        uniform chain if left out. Jumps and corners are welcome; at the free end it may vanish or grow like
        a power.
    scanned : int, optional
        With a tip weight or a line density: how many offsets of the free end to look at for shapes.

    Returns
    -------
    ContinuousShapes
        A sequence of `ContinuousShape`, the straight chain left out, of two mirror images that with the
        free end at a positive offset; by half waves. ``complete`` is true where a theorem counts them: for
        the uniform chain without tip weight (Kolodner, 1955: one shape for every critical height above
        the height given), and where no more than one critical height is above it. Elsewhere further shapes
        may exist, as heavy beads on a light thread show, and one that comes and goes between two scanned
        offsets is missed. False too within rounding of a critical height. Empty and complete where the
        height is not less than the first critical one.

    Raises
    ------
    ValueError
        If not exactly one of `conical_height` and `angular_speed` is given, or a number is out of range.
    TypeError
        If `line_density` is not a function.

    Notes
    -----
    Greenhill (1908) section 4 without its small angles. Power series along the chain in a variable that makes
    the equations polynomials and goes through sharp corners in a few steps; Newton's method on the place
    where the chain crosses the axis. Inclinations, and offsets over the length, within ``error_bound``, an
    estimate; errors measured reach 0.6 of it. Cost: 2 milliseconds for all fourteen shapes at
    length / conical_height = 500; up to 0.2 s with a line density.

    Examples
    --------
    >>> import revchain as rc
    >>> shapes = rc.continuous_shapes(500.0, conical_height=1.0)
    >>> shapes
    ContinuousShapes: 14, all there are
    >>> round(float(shapes[13].offset[0]), 9)
    2.705556715
    """
    place = "revchain.continuous_shapes"
    height = height_of(place, conical_height, angular_speed, gravity)
    looks = integer(place, "scanned", scanned)
    if not 1 <= looks <= 10**6:
        raise ValueError(f"{place}: scanned must be from 1 to 1000000, got {looks}")
    long, tip, density = _checked(place, length, tip_weight, line_density)
    return ContinuousShapes._wrap(_core.continuous_shapes(long, tip, density, height, looks), density)


def continuous_critical_heights(
    length: float,
    *,
    count: int,
    tip_weight: float = 0.0,
    line_density: Callable[[float], float] | None = None,
) -> Floats:
    """Return the conical heights below which a chain without links has another shape than the straight one.

    Parameters
    ----------
    length : float
        Of the chain, positive.
    count : int
        How many, at least 1 and at most 100000.
    tip_weight : float, optional
        As for `continuous_shapes`.
    line_density : callable, optional
        As for `continuous_shapes`.

    Returns
    -------
    ndarray, shape (count,)
        Descending, in the unit of `length`: those of small amplitude, within 4e-15 relative.

    Raises
    ------
    ValueError
        If a number is out of range, or a line density too rough or a tip too heavy to be followed that far.
    TypeError
        If `line_density` is not a function.

    Notes
    -----
    By the power series of `continuous_shapes` with the tension of the straight chain; for uniform chains
    and powers, `revchain.heavy_chain`, `tip_mass` and `tapered_chain` have them in closed form.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.continuous_critical_heights(1.0, count=3, line_density=lambda s: 1 + s).round(6)
    array([0.658339, 0.143271, 0.059425])
    """
    place = "revchain.continuous_critical_heights"
    number = checked_count(place, "count", count, each=8)
    if number > 100_000:
        raise ValueError(f"{place}: count must be at most 100000, got {number}")
    long, tip, density = _checked(place, length, tip_weight, line_density)
    return _core.continuous_critical_heights(long, tip, density, number)
