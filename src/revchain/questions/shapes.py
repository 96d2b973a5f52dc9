# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of a whirling chain at any inclination: all of them, proved complete."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..closed_forms import conical_pendulum
from ..closed_forms.statics import ForceDiagram
from ..results.base import Results, Wrapped
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, Floats, boolean, exactly_one, integer, limit, one_positive, shown
from ..systems.rig import Rig

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def is_driven(place: str, frame: str) -> bool:
    """Whether `frame` is the driven one; a ValueError unless it is that or the free one."""
    if not isinstance(frame, str) or frame not in ("free", "driven"):
        raise ValueError(f"{place}: frame must be 'free' or 'driven', got {shown(frame)}")
    return frame == "driven"


class Stability(Wrapped[_core.Stability, str]):
    """What becomes of a small disturbance of a steady shape; times in units of 1/n, the turning speed.

    Returned by `SteadyShape.stability`.
    """

    __slots__ = ()

    @property
    def frame(self) -> str:
        """``free`` or ``driven``."""
        return self._given

    @property
    def verdict(self) -> str:
        """``minimum``, ``spectrally stable``, ``unstable`` or ``undecided``."""
        return self._compiled.verdict

    @property
    def exponents(self) -> NDArray[np.complex128]:
        """All ``s`` of ``exp(s n t)``, by imaginary part; without those of the rotation itself.

        ``4 N - 2`` of N links in the free frame, ``2 N`` in the driven one; links are rods without inertia about
        their own axes. Of links without weight there are fewer: where a pin carries no mass, the two links
        that meet there stay in line.
        """
        return self._compiled.exponents

    @property
    def growth_rate(self) -> float:
        """The largest real part, over the turning speed."""
        return self._compiled.growth_rate

    @property
    def margin(self) -> float:
        """What of the growth rate rounding may explain where exponents meet."""
        return self._compiled.margin

    @property
    def negative_directions(self) -> int:
        """Of the energy in the turning frame, at constant angular momentum if free."""
        return self._compiled.negative_directions

    def __repr__(self) -> str:
        return f"Stability ({self.frame}): {self.verdict}, growth rate {self.growth_rate:.3g} n"


class TurnedRig(NamedTuple):
    """A rig and the sense in which it turns."""

    rig: Rig
    sense: int


class SteadyShape(Wrapped[_core.SteadyShape, _core.Chain | TurnedRig]):
    """One steady shape: links lowest first, pins free end first, in the units of the chain.

    Returned by `steady_shapes`.
    """

    __slots__ = ()

    @property
    def inclination(self) -> Floats:
        """Of each link to the downward vertical, rad, shape (N,): within (-pi, pi]."""
        return self._compiled.inclination

    @property
    def offset(self) -> Floats:
        """Of each pin from the axis, shape (N + 1,); the support's last, 0 but for a `Rig` that moves it."""
        return self._compiled.offset

    @property
    def height(self) -> Floats:
        """Of each pin above the support, shape (N + 1,): negative where it hangs."""
        return self._compiled.height

    @property
    def tension(self) -> Floats:
        """Size of the reaction at each link's upper pin, shape (N,), in the unit of the weights."""
        return self._compiled.tension

    @property
    def reaction_inclination(self) -> Floats:
        """Of the reaction at each link's upper pin (`tension`) to the vertical, rad, shape (N,)."""
        return self._compiled.reaction_inclination

    @property
    def half_waves(self) -> int:
        """Sign changes of the offsets, and one."""
        return self._compiled.half_waves

    @property
    def conical_height(self) -> float:
        """Of the speed."""
        return self._compiled.conical_height

    @property
    def residual(self) -> float:
        """Largest moment about a pin of all that hangs there, over total weight times total length."""
        return self._compiled.residual

    @property
    def error_bound(self) -> float:
        """Of every inclination, rad: proved, but at a fold of a branch, where it is an estimate."""
        return self._compiled.error_bound

    @property
    def condition(self) -> float:
        """Largest change of an inclination, rad, over the relative change of the forces that makes it.

        Forces are weights and centrifugal forces, each changed by the same share of itself, whatever the
        signs (moments of them in a list with links that stand or have several inclinations; on a branch, where
        something else than the height is given, a few patterns of signs are tried, and what is given is
        changed, too). Rounding in double could not leave less than 1e-16 of it; here two doubles are used.
        """
        return self._compiled.condition

    @property
    def moment_of_inertia(self) -> float:
        """About the axis, weight times length squared: divide by gravity for mass."""
        return self._compiled.moment_of_inertia

    @property
    def effective_energy(self) -> float:
        """Potential energy less half of ``moment_of_inertia / conical_height``: stationary at a steady shape."""
        return self._compiled.effective_energy

    def angular_momentum(self, gravity: float = STANDARD_GRAVITY) -> float:
        """Return the angular momentum about the axis.

        Parameters
        ----------
        gravity : float, optional
            In the unit of length of the chain per s^2, positive; standard gravity in m/s^2 if left out.

        Returns
        -------
        float
            In weight times length times s; of a `Rig` with what its flywheels keep, negative where all that
            turns the other way.

        Raises
        ------
        ValueError
            If `gravity` is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(1, length=1.0), conical_height=0.5)[0]
        >>> round(shape.angular_momentum(), 6)
        0.338701
        """
        place = "revchain.SteadyShape.angular_momentum"
        g = one_positive(place, "gravity", gravity)
        turning = self.moment_of_inertia / g * float(conical_pendulum.angular_speed(self.conical_height, g))
        if not isinstance(self._given, TurnedRig):
            return turning
        rig, sense = self._given
        return sense * turning + float(np.sum(rig.momentum * np.cos(self.inclination)))

    def stability(self, *, frame: str = "free") -> Stability:
        """Say what becomes of a small disturbance.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            ``free``: ball joints and no torque about the axis. ``driven``: axles at right angles to a plane
            that is made to turn, so that links move in that plane alone.

        Returns
        -------
        Stability
            Exponents to about 1e-13 of the largest where they are simple. Cost ``(4 N)**3``: a millisecond
            for ten links, a second for a hundred.

        Raises
        ------
        ValueError
            If `frame` is neither.
        TypeError
            If the shape is that of a `Rig`.

        Examples
        --------
        >>> import revchain as rc
        >>> pair = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.1)
        >>> [shape.stability().verdict for shape in pair]
        ['minimum', 'unstable']
        """
        driven = is_driven("revchain.SteadyShape.stability", frame)
        return Stability._wrap(_core.stability(self._chain("stability"), self._compiled, driven), frame)

    def force_diagram(self) -> ForceDiagram:
        """Return the graphical construction of the shape: force diagram and funicular polygon.

        Returns
        -------
        ForceDiagram
            Rays are sums of weights and centrifugal forces from below: that they are parallel to the
            links proves the shape anew.

        Raises
        ------
        TypeError
            If the shape is that of a `Rig`.

        Notes
        -----
        Greenhill (1908) section 3, figures 3 and 5.

        Examples
        --------
        >>> import numpy as np
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.5)[0]
        >>> diagram = shape.force_diagram()
        >>> side = diagram.pin[1:] - diagram.pin[:-1]
        >>> bool(np.allclose(side[:, 0] / side[:, 1], diagram.ray[:, 0] / diagram.ray[:, 1], rtol=1e-14))
        True
        """
        return ForceDiagram._wrap(_core.force_diagram(self._chain("force_diagram"), self._compiled), None)

    def transferred_to_axis(self) -> Chain:
        """Return the straight chain whose weights hang on the axis, level with where they are in the shape.

        Returns
        -------
        Chain
            Each link as long only as it reaches down. One of its conical heights is the shape's, and that
            mode the shape's offsets, for links of any kind; of plummets it is mode ``half_waves``.

        Raises
        ------
        TypeError
            If the shape is that of a `Rig`.

        Notes
        -----
        Greenhill (1908) section 8 (21): inclinations enter through ``conical_height / cos(inclination)``
        alone. Perpendicular to the turning plane the shape is as stiff as this chain.

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.5)[0]
        >>> rc.modes(shape.transferred_to_axis()).conical_height.round(12)
        array([0.5       , 0.08366581])
        """
        return Chain._wrap(_core.transferred_to_axis(self._chain("transferred_to_axis"), self._compiled))

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
        >>> ax = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=1.0), conical_height=0.05)[0].plot()
        >>> ax.get_xlabel()
        'from the axis (m)'
        """
        from ..plots.style import plot_shapes

        return plot_shapes([self], ax, linked=True, length_unit=length_unit)

    def _chain(self, method: str) -> _core.Chain:
        if isinstance(self._given, TurnedRig):
            raise TypeError(f"revchain.SteadyShape.{method}: shapes of a Chain have it, those of a Rig do not")
        return self._given

    def __repr__(self) -> str:
        tip = np.degrees(self.inclination[0])
        return f"SteadyShape: half_waves {self.half_waves}, lowest link at {tip:.6g} degrees"


class SteadyShapes(Results[SteadyShape]):
    """All steady shapes of a chain at one speed, by half waves, then inclination of the lowest link."""

    __slots__ = ("_compiled",)
    _compiled: _core.SteadyShapes

    @classmethod
    def _wrap(cls, compiled: _core.SteadyShapes, given: _core.Chain | TurnedRig) -> SteadyShapes:
        result = object.__new__(cls)
        result._compiled = compiled
        result._items = tuple(SteadyShape._wrap(shape, given) for shape in compiled.shapes)
        return result

    @property
    def complete(self) -> bool:
        """Whether it is proved that none is missing."""
        return self._compiled.complete

    @property
    def undecided(self) -> Floats:
        """Ranges of the lowest link's inclination in which there may be more, rad, shape (k, 2)."""
        return self._compiled.undecided

    @property
    def cells(self) -> int:
        """How many parts of the range had to be looked at."""
        return self._compiled.cells

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
        >>> ax = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=1.0), conical_height=0.02).plot()
        >>> ax.get_title()
        '5 shapes, proved complete'
        """
        from ..plots.style import plot_shapes

        axes = plot_shapes(self, ax, linked=True, length_unit=length_unit)
        count = f"{len(self)} shape{'s' * (len(self) != 1)}"
        axes.set_title(f"{count}, proved complete" if self.complete else f"{count}; there may be more")
        return axes

    def __repr__(self) -> str:
        return f"SteadyShapes: {len(self)}, {'proved complete' if self.complete else 'there may be more'}"


def steady_shapes(
    chain: Chain | Rig,
    *,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    budget: int = 3_000_000,
    hanging_only: bool = True,
    sense: int = 1,
) -> SteadyShapes:
    """Find all shapes in which a chain, or a rig, whirls steadily at a given speed, at any inclination.

    Parameters
    ----------
    chain : Chain or Rig
        The chain of N links, or what it is rigged with: a support on a spring or carried round, flywheels, a fluid.
    conical_height : float
        Of the speed, in the unit of the chain's lengths, positive.
    angular_speed : float
        Instead of `conical_height`: the speed in rad/s, positive.
    gravity : float, optional
        For `angular_speed`, and for a rig's flywheels; standard gravity, in metres, if left out.
    budget : int, optional
        How many links to look at, at the most, while parts of the range of the lowest link's inclination are
        split: half a microsecond each, or two where ``l < a``; the default takes some 2 to 10 seconds. With 0
        and less nothing is looked at, and the list is empty and not complete.
    hanging_only : bool, optional
        Whether to leave out shapes with links that stand: more than a right angle from the downward
        vertical. Of a rig: shapes with links that do not stand or hang as the rig has them.
    sense : {1, -1}, optional
        Of the rotation. It matters to a rig with flywheels.

    Returns
    -------
    SteadyShapes
        A sequence of `SteadyShape`: every hanging shape (all links within a right angle of the
        downward vertical) or, if `hanging_only` is false, every shape; straight ones left out, of two
        mirror images that with the free end at a positive offset (if it is on the axis, the lowest
        inclined link); by half waves, then inclination of the lowest link. ``complete`` is true where it
        is proved that none is missing. Inclinations within ``error_bound``, proved, mostly 2.2e-16.
        Empty and complete where the height is greater than the first of `modes`, in any posture.
        Of a rig whose support is carried round: every shape, outwards positive, those inwards too.

    Raises
    ------
    ValueError
        If not exactly one of `conical_height` and `angular_speed` is given, a number is not positive
        and finite, `sense` is neither 1 nor -1, or a link of a rig has no effective tension (tension and
        speed times momentum over length) at the speed.
    TypeError
        If `chain` is neither a `Chain` nor a `Rig`, or `hanging_only` is not a bool.

    Notes
    -----
    Interval arithmetic with first and second derivatives of the upward sweep, Greenhill (1908) section
    8 (4), (12); Newton's method on all pins in two words. A link that stands, or is so heavy off its
    pins (``pendulum_length > length``) that it hangs at three inclinations under one load, is followed
    along every one of them. Not complete: at exactly a critical speed or where two shapes are born, and
    where the budget ends. At heights below some 2e-15 of the longest link the list is empty and not
    complete: two words of double precision no longer hold the offsets that give the tensions. Cost: 15 milliseconds for 84 hanging shapes of eight plummets, about 30 for
    all 64 shapes of four; shapes, and time, about double with each link, and grow fourfold if links may
    stand.

    Examples
    --------
    >>> import numpy as np
    >>> import revchain as rc
    >>> shapes = rc.steady_shapes(rc.Chain.uniform_plummets(8, length=8.0), conical_height=1 / 35.4025)
    >>> shapes
    SteadyShapes: 84, proved complete
    >>> rods = rc.Chain.uniform_rods(3, length=3.0)
    >>> [len(rc.steady_shapes(rods, conical_height=0.05, hanging_only=only)) for only in (True, False)]
    [3, 14]

    A chair on a chain of 4 m, on an arm of 1 m, at twelve turns a minute; and at 3 rad/s, where it could also
    hang inwards in two ways:

    >>> carousel = rc.Rig(rc.Chain(weight=800.0, length=4.0), support_radius=1.0)
    >>> rc.steady_shapes(carousel, angular_speed=1.2566)
    SteadyShapes: 1, proved complete
    >>> [round(float(np.degrees(s.inclination[0])), 1) for s in rc.steady_shapes(carousel, angular_speed=3.0)]
    [77.5, -68.1, -20.7]
    """
    place = "revchain.steady_shapes"
    name, value = exactly_one(place, conical_height=conical_height, angular_speed=angular_speed)
    most = limit(place, "budget", budget)
    hanging = boolean(place, "hanging_only", hanging_only)
    if integer(place, "sense", sense) not in (1, -1):
        raise ValueError(f"{place}: sense must be 1 or -1, got {shown(sense)}")
    if isinstance(chain, Rig):
        rig, turned, g = chain._compiled, TurnedRig(chain, int(sense)), one_positive(place, "gravity", gravity)
        if name == "conical_height":
            return SteadyShapes._wrap(_core.steady_shapes_of_rig(rig, value, most, hanging, turned.sense, g), turned)
        speed = turned.sense * value
        return SteadyShapes._wrap(_core.steady_shapes_of_rig_at_speed(rig, speed, most, hanging, g), turned)
    core = compiled(place, chain)
    if name == "conical_height":
        return SteadyShapes._wrap(_core.steady_shapes(core, value, most, hanging), core)
    g = one_positive(place, "gravity", gravity)
    return SteadyShapes._wrap(_core.steady_shapes_at_speed(core, value, g, most, hanging), core)
