# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and cords whose two ends are held on the axis: the troposkien, the skipping rope with gravity."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.base import WrappedList
from ..results.shapes import Stability, is_driven
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, Floats, boolean, floats, numbers, positive, real
from ..systems.numbers import count as counted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..systems.numbers import Numbers

MOST_HALF_WAVES = 1000


class _Held:
    """What shapes of chains and of cords have in common."""

    __slots__ = ("_compiled", "_per")
    _compiled: Any
    _per: float  # force over height_times_tension

    @property
    def inclination(self) -> Floats:
        """To the upward vertical, rad, within (-pi, pi]: positive where it leads to the axis going up."""
        return self._compiled.inclination  # type: ignore[no-any-return]

    @property
    def offset(self) -> Floats:
        """From the axis: of each pin, shape (N + 1,), or of each place of a cord; both ends 0."""
        return self._compiled.offset  # type: ignore[no-any-return]

    @property
    def height(self) -> Floats:
        """Above the lower end, of pins or places; the last is the span."""
        return self._compiled.height  # type: ignore[no-any-return]

    @property
    def tension(self) -> Floats:
        """Of each pin or place: in the unit of the weights; without gravity of masses, mass * length / s**2."""
        return self._per * self._compiled.height_times_tension  # type: ignore[no-any-return]

    @property
    def lower_pull(self) -> Floats:
        """The pull on the lower bearing, shape (2,): to the side of the second pin, and up."""
        return self._per * np.array(self._compiled.lower_pull)

    @property
    def upper_pull(self) -> Floats:
        """The pull on the upper bearing, shape (2,): to the side of the lowest free pin, and up."""
        return self._per * np.array(self._compiled.upper_pull)

    @property
    def half_waves(self) -> int:
        """Sign changes of the offsets, and one."""
        return self._compiled.half_waves  # type: ignore[no-any-return]

    @property
    def span(self) -> float:
        """Distance of the two ends."""
        return self._compiled.span  # type: ignore[no-any-return]

    @property
    def conical_height(self) -> float:
        """Of the speed; 0 without gravity."""
        return self._compiled.conical_height  # type: ignore[no-any-return]

    @property
    def residual(self) -> float:
        """Largest of what the balance leaves over of a tension, and of the gaps at the ends over the length."""
        return self._compiled.residual  # type: ignore[no-any-return]

    @property
    def error_bound(self) -> float:
        """Of every inclination, rad."""
        return self._compiled.error_bound  # type: ignore[no-any-return]

    @property
    def condition(self) -> float:
        """Largest change of an inclination, rad, over the relative change of span or conical height that makes it."""
        return self._compiled.condition  # type: ignore[no-any-return]

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
        """
        from ..plots.style import plot_held_shapes

        return plot_held_shapes([self], ax, length_unit=length_unit)

    def __repr__(self) -> str:
        sag = float(np.abs(self.offset).max())
        return f"{type(self).__name__}: half_waves {self.half_waves}, span {self.span:.6g}, sag {sag:.6g}"


class HeldShape(_Held):
    """One steady shape of a chain with both ends on the axis: links lowest first, pins from the lower end up.

    Returned by `held_shapes`.
    """

    __slots__ = ("_chain",)
    _chain: _core.Chain

    @classmethod
    def _wrap(cls, shape: _core.HeldShape, per: float, chain: _core.Chain) -> HeldShape:
        result = object.__new__(cls)
        result._compiled, result._per, result._chain = shape, per, chain
        return result

    @property
    def force_inclination(self) -> Floats:
        """Of the force at each pin (`tension`), as it pulls upwards, to the vertical, rad, shape (N + 1,)."""
        return self._compiled.force_inclination  # type: ignore[no-any-return]

    @property
    def proved(self) -> bool:
        """Whether `error_bound` is proved; else it is an estimate."""
        return self._compiled.proved  # type: ignore[no-any-return]

    @property
    def moment_of_inertia(self) -> float:
        """About the axis, weight times length squared: divide by gravity for mass."""
        return self._compiled.moment_of_inertia  # type: ignore[no-any-return]

    @property
    def effective_energy(self) -> float:
        """Potential energy less that of the centrifugal forces: stationary among figures of the same span."""
        return self._per * self._compiled.height_times_energy  # type: ignore[no-any-return]

    def stability(self, *, frame: str = "free") -> Stability:
        """Say what becomes of a small disturbance, both ends staying where they are.

        Parameters
        ----------
        frame : {"free", "driven"}
            ``free``: ball joints and no torque about the axis. ``driven``: axles at right angles to a plane
            that is made to turn, so that links move in that plane alone.

        Returns
        -------
        Stability
            Of N links ``4 N - 8`` exponents in the free frame, ``2 N - 4`` in the driven one, to about 1e-13
            of the largest where they are simple. Cost ``(4 N)**3``.

        Raises
        ------
        ValueError
            If `frame` is neither, or a pin has no mass.

        Examples
        --------
        >>> import revchain as rc
        >>> chain = rc.Chain.uniform_rods(10, length=1.0)
        >>> rope = rc.held_shapes(chain, span=0.5, conical_height=0.01, most_half_waves=2)
        >>> [shape.stability().verdict for shape in rope]
        ['minimum', 'spectrally stable']
        """
        driven = is_driven("revchain.HeldShape.stability", frame)
        return Stability._made(_core.held_stability(self._chain, self._compiled, driven), frame=frame)


class HeldCordPlaces(NamedTuple):
    """Places of a cord, each of the shape of the arcs asked for; names as in `HeldCordShape`."""

    offset: Numbers
    height: Numbers
    inclination: Numbers
    tension: Numbers


class HeldCordShape(_Held):
    """One steady shape of a uniform cord with both ends on the axis; places from the lower end up.

    Returned by `held_cord_shapes`. Error bounds are estimates.
    """

    __slots__ = ()

    @classmethod
    def _wrap(cls, shape: _core.HeldCordShape, per: float) -> HeldCordShape:
        result = object.__new__(cls)
        result._compiled, result._per = shape, per
        return result

    @property
    def arc_length(self) -> Floats:
        """Of the places, from the lower end; dense where the cord turns sharply."""
        return self._compiled.arc_length  # type: ignore[no-any-return]

    @property
    def length(self) -> float:
        """Of the cord."""
        return self._compiled.length  # type: ignore[no-any-return]

    def at_arc(self, arc: ArrayLike) -> HeldCordPlaces:
        """Return what there is at distances along the cord.

        Parameters
        ----------
        arc : array_like
            From the lower end, 0 to `length`, any shape.

        Returns
        -------
        HeldCordPlaces
            Each of the shape of `arc`.

        Raises
        ------
        ValueError
            If a number is out of its range.

        Examples
        --------
        >>> import revchain as rc
        >>> cord = rc.held_cord_shapes(1.0, span=0.5, conical_height=0.1)[0]
        >>> round(float(cord.at_arc(0.5).offset), 6)
        0.380421
        """
        place = "revchain.HeldCordShape.at_arc"
        offset, height, inclination, tension = self._compiled.at_arc(floats(place, "arc", arc))
        return HeldCordPlaces(*numbers([offset, height, inclination, self._per * tension]))


Shape = TypeVar("Shape", bound=_Held)


class HeldShapes(WrappedList[Shape]):
    """Steady shapes between two points of the axis, by half waves: those reached from the straight chain."""

    __slots__ = ("_missing",)
    _missing: tuple[int, ...]

    @classmethod
    def _wrap(cls, shapes: Sequence[Shape], missing: Sequence[int]) -> HeldShapes[Shape]:
        result = object.__new__(cls)
        result._items, result._missing = tuple(shapes), tuple(missing)
        return result

    @property
    def missing(self) -> tuple[int, ...]:
        """Half waves, of those asked for, with which nothing was found."""
        return self._missing

    @property
    def complete(self) -> bool:
        """Always false: that there are no others is not shown."""
        return False

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
        >>> ax = rc.held_cord_shapes(1.0, span=0.5, conical_height=0.05, most_half_waves=2).plot()
        >>> ax.get_xlabel()
        'from the axis (m)'
        """
        from ..plots.style import plot_held_shapes

        return plot_held_shapes(self, ax, length_unit=length_unit)

    def __repr__(self) -> str:
        rest = f"; nothing with {', '.join(map(str, self._missing))} half waves" if self._missing else ""
        return f"HeldShapes: {len(self)}{rest}"


class _Speed(NamedTuple):
    """Conical height, 0 without gravity; what turns height times tension into tension; speed and gravity if given."""

    height: float
    per: float
    given: tuple[float, float] | None


LEAST, MOST = 1e-150, 1e150
"""Conical heights, and squared speeds without gravity, whose products with tensions stay in the range of doubles."""


def _speed(place: str, conical_height: float | None, angular_speed: float | None, gravity: float) -> _Speed:
    if (conical_height is None) == (angular_speed is None):
        raise ValueError(f"{place}: give exactly one of conical_height and angular_speed")
    g = real(place, "gravity", gravity)
    if conical_height is not None:
        height = float(positive(place, "conical_height", real(place, "conical_height", conical_height)))
        if g == 0:
            raise ValueError(f"{place}: without gravity there is no conical height, give angular_speed; got {height:g}")
        positive(place, "gravity", g)
        return _Speed(_in_range(place, "conical_height", height, height), 1 / height, None)
    speed = float(positive(place, "angular_speed", real(place, "angular_speed", angular_speed)))
    if g == 0:
        return _Speed(0.0, _in_range(place, "angular_speed", speed * speed, speed), (speed, 0.0))
    g = float(positive(place, "gravity", g))
    height = _in_range(place, "angular_speed", g / speed / speed, speed)
    return _Speed(height, 1 / height, (speed, g))


def _in_range(place: str, name: str, height: float, given: float) -> float:
    if not LEAST <= height <= MOST:
        raise ValueError(
            f"{place}: {name} must give a conical height (without gravity a squared speed) "
            f"from {LEAST:g} to {MOST:g}, got {given:g}"
        )
    return height


def _half_waves(place: str, most_half_waves: int) -> int:
    most = counted(place, "most_half_waves", most_half_waves)
    if most > MOST_HALF_WAVES:
        raise ValueError(f"{place}: most_half_waves must be at most {MOST_HALF_WAVES}, got {most}")
    return most


def _between(place: str, span: float | None, top_tension: float | None) -> tuple[float | None, float | None]:
    if (span is None) == (top_tension is None):
        raise ValueError(f"{place}: give exactly one of span and top_tension")
    apart = None if span is None else float(positive(place, "span", real(place, "span", span)))
    pull = (
        None if top_tension is None else float(positive(place, "top_tension", real(place, "top_tension", top_tension)))
    )
    return apart, pull


def held_shapes(
    chain: Chain,
    *,
    span: float | None = None,
    top_tension: float | None = None,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    most_half_waves: int = 1,
    prove: bool = True,
) -> HeldShapes[HeldShape]:
    """Find shapes in which a chain whirls between two points of the axis, at any inclination.

    The blade of a Darrieus turbine (troposkien), the skipping rope turned about a vertical axis or, without
    gravity, any.

    Parameters
    ----------
    chain : Chain
        The chain of N links; its free end is held too.
    span : float
        Distance of the two ends along the axis, positive, less than the length.
    top_tension : float
        Instead of `span`: the tension at the upper end, positive.
    conical_height : float
        Conical height of the speed, in the unit of the chain's lengths, positive.
    angular_speed : float
        Instead of `conical_height`: the speed in rad/s, positive.
    gravity : float, optional
        Along the axis, for `angular_speed`; standard gravity, in metres, if left out. With 0 the shape does not
        depend on the speed, weights stand for masses, and tensions are mass times length per s^2.
    most_half_waves : int, optional
        Shapes of 1 to so many half waves are looked for.
    prove : bool, optional
        Whether error bounds are proved; else they are estimates.

    Returns
    -------
    HeldShapes
        A sequence of `HeldShape`: for each number of half waves the shape that is reached from the nearly
        straight chain without gravity, by drawing its ends together and then letting gravity grow; for
        `top_tension` every one on that branch. All links are in tension, as threads must be; of two mirror
        images the one whose lowest free pin is at a positive offset. ``missing`` tells the half waves for which
        none was found: too slow a speed folds the chain along the axis, or a thread goes slack; just before it folds
        a shape may be missed. That there are no others is not shown.

    Raises
    ------
    ValueError
        If not exactly one of `span` and `top_tension`, and of `conical_height` and `angular_speed`, is given, a
        number is not positive and finite, or `span` is not less than the length.

    Notes
    -----
    Greenhill (1908) section 5, with links, and section 8 (21) with a force at the lower end. Inclinations are
    rounded once where ``error_bound`` is proved. Cost: some 100 sweeps of 0.1 microseconds a link.

    Examples
    --------
    >>> import revchain as rc
    >>> blade = rc.Chain.uniform_rods(40, length=1.0)
    >>> held = rc.held_shapes(blade, span=0.5, conical_height=0.1, most_half_waves=2)
    >>> held[0]
    HeldShape: half_waves 1, span 0.5, sag 0.391003
    >>> rope = rc.SkippingRope(span=0.5, length=1.0)
    >>> light = rc.held_shapes(blade, span=0.5, angular_speed=20.0, gravity=0.0)[0]
    >>> round(float(light.offset.max() / rope.sag), 3)
    1.001
    """
    place = "revchain.held_shapes"
    core = compiled(place, chain)
    apart, pull = _between(place, span, top_tension)
    speed = _speed(place, conical_height, angular_speed, gravity)
    most = _half_waves(place, most_half_waves)
    sure = boolean(place, "prove", prove)
    if pull is not None:
        found = _core.held_shapes_under_tension(core, pull / speed.per, speed.height, most, sure)
    elif speed.given is not None:
        found = _core.held_shapes_at_speed(core, apart or 0.0, *speed.given, most, sure)
    else:
        found = _core.held_shapes(core, apart or 0.0, speed.height, most, sure)
    return HeldShapes._wrap([HeldShape._wrap(shape, speed.per, core) for shape in found.shapes], found.missing)


def held_cord_shapes(
    length: float,
    *,
    span: float | None = None,
    top_tension: float | None = None,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    weight: float = 1.0,
    most_half_waves: int = 1,
) -> HeldShapes[HeldCordShape]:
    """Find shapes in which a uniform cord whirls between two points of the axis: `held_shapes` of endless links.

    Parameters
    ----------
    length : float
        Of the cord, positive.
    span, top_tension, conical_height, angular_speed, gravity, most_half_waves
        As in `held_shapes`.
    weight : float, optional
        Of the whole cord (its mass if `gravity` is 0), positive.

    Returns
    -------
    HeldShapes
        A sequence of `HeldCordShape`, as in `held_shapes`.

    Raises
    ------
    ValueError
        As in `held_shapes`.

    Notes
    -----
    Without gravity this is ``SkippingRope``, Greenhill (1908) section 5. Power series and exact derivatives;
    places within 1e-13 of the length.

    Examples
    --------
    >>> import revchain as rc
    >>> cord = rc.held_cord_shapes(1.0, span=0.5, angular_speed=20.0, gravity=0.0)[0]
    >>> rope = rc.SkippingRope(span=0.5, length=1.0)
    >>> abs(float(cord.at_arc(0.5).offset) - rope.sag) < 1e-14
    True
    """
    place = "revchain.held_cord_shapes"
    whole = float(positive(place, "length", real(place, "length", length)))
    heavy = float(positive(place, "weight", real(place, "weight", weight)))
    apart, pull = _between(place, span, top_tension)
    speed = _speed(place, conical_height, angular_speed, gravity)
    most = _half_waves(place, most_half_waves)
    if pull is not None:
        found = _core.held_cord_shapes_under_tension(whole, pull / speed.per, speed.height, heavy, most)
    else:
        found = _core.held_cord_shapes(whole, apart or 0.0, speed.height, heavy, most)
    return HeldShapes._wrap([HeldCordShape._wrap(shape, speed.per) for shape in found.shapes], found.missing)


class TautModes:
    """Whirl speeds of a straight chain held at both ends. Returned by `taut_modes`."""

    __slots__ = ("_compiled", "_length")
    _compiled: _core.TautModes
    _length: Floats  # of the links

    @classmethod
    def _wrap(cls, modes: _core.TautModes, length: Floats) -> TautModes:
        result = object.__new__(cls)
        result._compiled, result._length = modes, length
        return result

    @property
    def tension(self) -> float:
        """At the lower end."""
        return self._compiled.tension

    @property
    def conical_height(self) -> Floats:
        """Of the modes, descending: mode k has k half waves."""
        return self._compiled.conical_height

    @property
    def error_bound(self) -> Floats:
        """Of the heights, relative."""
        return self._compiled.error_bound

    @property
    def shape(self) -> Floats:
        """Offsets of the pins, (modes, N + 1), lower end first; the largest 1, that of the lowest free pin positive."""
        return self._compiled.shape

    def angular_speed(self, gravity: float = STANDARD_GRAVITY) -> Floats:
        """Return the whirl speeds.

        Parameters
        ----------
        gravity : float, optional
            In the unit of length of the chain per s^2, positive.

        Returns
        -------
        numpy.ndarray
            rad/s.

        Raises
        ------
        ValueError
            If `gravity` is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.taut_modes(rc.Chain.uniform_rods(50, length=1.0), tension=10.0, count=2).angular_speed().round(2)
        array([31.87, 63.78])
        """
        g = positive("revchain.TautModes.angular_speed", "gravity", gravity)
        return np.sqrt(g / self.conical_height)

    def plot(self, ax: Axes | None = None, *, most: int = 6, length_unit: str = "m") -> Axes:
        """Draw the shapes side by side along the straight chain.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        most : int
            How many modes, slowest first.
        length_unit : str
            What to write on the axis of height.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If `most` is below 1.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.taut_modes(rc.Chain.uniform_rods(50, length=1.0), tension=10.0, count=3).plot().get_ylabel()
        'above the lower end (m)'
        """
        from ..plots.style import MOST_PINS_AS_DOTS, SPACING, axes_or_new

        shown = min(counted("revchain.TautModes.plot", "most", most), self.conical_height.size)
        axes = axes_or_new(ax, 1.5 + 1.1 * shown, 4.8)
        height = np.concatenate([[0.0], np.cumsum(self._length)])
        for k, shape in enumerate(self.shape[:shown]):
            axes.axvline(k * SPACING, color="0.8", linewidth=0.8, zorder=0)
            marker = "o" if self._length.size <= MOST_PINS_AS_DOTS else ""
            axes.plot(k * SPACING + shape, height, marker=marker, markersize=3.5, color="C0")
        axes.set_xticks([k * SPACING for k in range(shown)], [str(k + 1) for k in range(shown)])
        axes.set(xlabel="mode; offset, the largest 1", ylabel=f"above the lower end ({length_unit})")
        return axes

    def __repr__(self) -> str:
        return f"TautModes: {self.conical_height.size}"


def taut_modes(chain: Chain, *, tension: float, count: int = 1) -> TautModes:
    """Return the speeds at which a chain held straight between two points of the axis begins to whirl.

    Parameters
    ----------
    chain : Chain
        The chain of N links; its free end is held too.
    tension : float
        At the lower end, in the unit of the weights, positive.
    count : int, optional
        How many modes, slowest first; fewer are returned where there are fewer.

    Returns
    -------
    TautModes
        Conical heights within an ulp.

    Raises
    ------
    ValueError
        If `tension` is not positive and finite, or `count` is below 1.

    Notes
    -----
    From these speeds `held_shapes` leave: at such a speed and tension, a little shorter in span.

    Examples
    --------
    >>> import revchain as rc
    >>> modes = rc.taut_modes(rc.Chain.uniform_rods(4, length=1.0), tension=1e6, count=5)
    >>> (1e-6 / modes.conical_height).round(3)
    array([ 10.387,  48.   , 126.756])
    """
    place = "revchain.taut_modes"
    pull = float(positive(place, "tension", real(place, "tension", tension)))
    most = counted(place, "count", count)
    return TautModes._wrap(_core.taut_modes(compiled(place, chain), pull, most), np.asarray(chain.length))
