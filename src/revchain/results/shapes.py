# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of chains and rigs, their stability and their diagrams."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..systems.chain import Chain
from ..systems.numbers import Floats, shown
from ..systems.rig import Rig
from .base import Field, Result, Results
from .diagrams import ForceDiagram
from .sheet import Column, Sheet, digits

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def is_driven(place: str, frame: str) -> bool:
    """Whether `frame` is the driven one; a ValueError unless it is that or the free one."""
    if not isinstance(frame, str) or frame not in ("free", "driven"):
        raise ValueError(f"{place}: frame must be 'free' or 'driven', got {shown(frame)}")
    return frame == "driven"


class Stability(Result):
    """Linear stability of a steady shape; times in units of 1/n, n the turning speed.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.1)[1]
    >>> shape.stability().verdict, round(shape.stability().growth_rate, 4)
    ('unstable', 0.1091)
    """

    __slots__ = ()
    frame: Field[str] = Field("``'free'`` or ``'driven'``.", part=True)
    verdict: Field[str] = Field("``'minimum'``, ``'spectrally stable'``, ``'unstable'`` or ``'undecided'``.", part=True)
    exponents: Field[NDArray[np.complex128]] = Field(
        "All ``s`` of ``exp(s n t)``, by imaginary part, without those of the rotation itself: ``4 N - 2`` for N links in "
        "the free frame, ``2 N`` in the driven one; links are rods without inertia about their own axes. There are fewer "
        "where a pin carries no mass: the two links that meet there stay in line.",
        part=True,
    )
    growth_rate: Field[float] = Field("The largest real part, over the turning speed.", part=True)
    margin: Field[float] = Field("What rounding may explain of the growth rate where exponents meet.", part=True)
    negative_directions: Field[int] = Field(
        "Of the energy in the turning frame, at constant angular momentum if free.", part=True
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        count = len(self.exponents)
        columns = [
            Column("exponent", np.arange(1, count + 1), "exponent"),
            Column("value", self.exponents, "growth (n)", shown=self.exponents.real),
            Column("frequency", self.exponents.imag, "frequency (n)"),
        ]
        facts = {name: getattr(self, name) for name in ("frame", "verdict", "growth_rate", "margin")}
        heading = f"Stability ({self.frame}): {self.verdict}, growth rate {self.growth_rate:.3g} n"
        return Sheet("exponent", heading, columns, facts | {"negative_directions": self.negative_directions})


class SteadyShape(Result):
    """One steady shape (relative equilibrium) of a chain or rig: links lowest first, pins free end first.

    Returned by `steady_shapes`, `steady_shape` and branches.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), angular_speed=5.0)[0]
    >>> shape.inclination.round(4)
    array([1.3719, 1.3076])
    >>> shape.half_waves, shape.error_bound < 3e-16
    (1, True)
    """

    __slots__ = ()
    system: Field[Any] = Field("The chain or rig.", part=True)
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", part=True)
    direction: Field[int] = Field("1 or -1: of the rotation; it matters to flywheels.", part=True)
    angular_speed: Field[float] = Field(
        "The turning speed, rad/s.", lambda s: _speed(s.conical_height, s.gravity)
    )
    conical_height: Field[float] = Field("Height of the equivalent conical pendulum, m.", part=True)
    inclination: Field[Floats] = Field(
        "Inclination of each link to the downward vertical, rad, shape (N,), within (-pi, pi].", part=True
    )
    offset: Field[Floats] = Field(
        "Distance of each pin from the axis, m, shape (N + 1,); the last is the support's, 0 but for a `Rig` that moves "
        "it.",
        part=True,
    )
    height: Field[Floats] = Field("Height of each pin above the support, m, shape (N + 1,).", part=True)
    tension: Field[Floats] = Field(
        "Size of the reaction at the upper pin of each link, shape (N,), in the unit of the weights.", part=True
    )
    reaction_inclination: Field[Floats] = Field(
        "Inclination of that reaction to the vertical, rad, shape (N,).", part=True
    )
    half_waves: Field[int] = Field("Sign changes of the offsets, plus one.", part=True)
    residual: Field[float] = Field(
        "Largest moment about a pin of all that hangs there, over total weight times total length.", part=True
    )
    error_bound: Field[float] = Field(
        "Bound of the error of every inclination, rad. Proved; at a fold of a branch only an estimate.", part=True
    )
    condition: Field[float] = Field(
        "Largest change of an inclination, rad, over the relative change of the forces that causes it. Forces are weights "
        "and centrifugal forces, each changed by the same share of itself, whatever the signs.",
        part=True,
    )
    moment_of_inertia: Field[float] = Field("About the axis, weight times length squared; over gravity: mass.", part=True)
    effective_energy: Field[float] = Field(
        "Potential energy less half of ``moment_of_inertia / conical_height``: stationary at a steady shape.", part=True
    )
    angular_momentum: Field[float] = Field(
        "About the axis, weight times length times s; for a `Rig` with what its flywheels keep, negative where all that "
        "turns the other way.",
        lambda s: s._angular_momentum(),
    )

    def stability(self, *, frame: str = "free") -> Stability:
        """Say what becomes of a small disturbance.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            ``free``: ball joints and no torque about the axis. ``driven``: axles at right angles to a plane that is made
            to turn, so that links move in that plane alone.

        Returns
        -------
        Stability
            Exponents to about 1e-13 of the largest where they are simple. Cost ``(4 N)**3``: a millisecond for ten
            links, a second for a hundred.

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
        return Stability._made(_core.stability(self._chain("stability"), self._found(), driven), frame=frame)

    def force_diagram(self) -> ForceDiagram:
        """Return the graphical construction of the shape: force diagram and funicular polygon.

        Returns
        -------
        ForceDiagram
            Rays are sums of weights and centrifugal forces from below: that they are parallel to the links proves the
            shape anew.

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
        return ForceDiagram._made(_core.force_diagram(self._chain("force_diagram"), self._found()))

    def transferred_to_axis(self) -> Chain:
        """Return the straight chain whose weights hang on the axis, level with where they are in the shape.

        Returns
        -------
        Chain
            Each link is as long as it reaches down. One of its conical heights is the shape's, and that mode has the
            shape's offsets, for links of any kind; for point masses it is mode ``half_waves``.

        Raises
        ------
        TypeError
            If the shape is that of a `Rig`.

        Notes
        -----
        Greenhill (1908) section 8 (21): inclinations enter through ``conical_height / cos(inclination)`` alone.
        Perpendicular to the turning plane the shape is as stiff as this chain.

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.5)[0]
        >>> rc.modes(shape.transferred_to_axis()).conical_height.round(12)
        array([0.5       , 0.08366581])
        """
        return Chain._wrap(_core.transferred_to_axis(self._chain("transferred_to_axis"), self._found()))

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
        if isinstance(self.system, Rig):
            raise TypeError(f"revchain.SteadyShape.{method}: shapes of a Chain have it, those of a Rig do not")
        core: _core.Chain = self.system._compiled
        return core

    def _again(self) -> Any:
        return _core.SteadyShape(**{name: getattr(self, name) for name in _CORE})

    def _angular_momentum(self) -> float:
        turning = self.moment_of_inertia / self.gravity * self.angular_speed
        if not isinstance(self.system, Rig):
            return turning
        return self.direction * turning + float(np.sum(self.system.momentum * np.cos(self.inclination)))

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("link", np.arange(len(self.inclination)), "link"),
            Column("inclination", self.inclination, "inclination (°)", shown=np.degrees(self.inclination)),
            Column("offset", self.offset[:-1], "lower pin: from axis (m)"),
            Column("height", self.height[:-1], "above support (m)"),
            Column("tension", self.tension, "tension"),
            Column("reaction_inclination", self.reaction_inclination),
        ]
        names: tuple[str, ...] = ("angular_speed", "conical_height", "half_waves", "error_bound", "residual", "condition")
        names += ("gravity", "direction", "moment_of_inertia", "effective_energy", "angular_momentum")
        heading = f"Steady shape of {self.half_waves} half wave{'s' * (self.half_waves != 1)} at {self.angular_speed:.6g} rad/s"
        notes = ["links from the free end up; inclinations to the downward vertical"]
        facts = {name: getattr(self, name) for name in names} | {"support_offset": float(self.offset[-1])}
        return Sheet("link", heading, columns, facts, notes)


_CORE = (
    "inclination",
    "offset",
    "height",
    "tension",
    "reaction_inclination",
    "half_waves",
    "conical_height",
    "residual",
    "error_bound",
    "condition",
    "moment_of_inertia",
    "effective_energy",
)


class SteadyShapes(Results[SteadyShape]):
    """All steady shapes of a chain or rig at one speed, by half waves, then inclination of the lowest link."""

    __slots__ = ()
    system: Field[Any] = Field("The chain or rig.", part=True)
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", part=True)
    conical_height: Field[float] = Field("Conical height of the speed, m.", part=True)
    angular_speed: Field[float] = Field("The turning speed, rad/s.", part=True)
    complete: Field[bool] = Field("Whether it is proved that none is missing.", part=True)
    undecided: Field[Floats] = Field(
        "Ranges of the lowest link's inclination in which there may be more, rad, shape (k, 2).", part=True
    )
    cells: Field[int] = Field("How many parts of the range had to be looked at.", part=True)

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


    def _sheet(self, brief: bool = False) -> Sheet:
        def of(name: str) -> list[Any]:
            return [getattr(shape, name) for shape in self]

        angles = of("inclination")
        columns = [
            Column("shape", np.arange(1, len(self) + 1), "shape"),
            Column("half_waves", np.array(of("half_waves"), int), "half waves"),
            Column("lowest_inclination", [x[0] for x in angles], "lowest link (°)", 5, shown=[np.degrees(x[0]) for x in angles]),
            Column("top_inclination", [x[-1] for x in angles], "top link (°)", 5, shown=[np.degrees(x[-1]) for x in angles]),
            Column("free_end_offset", [x[0] for x in of("offset")], "free end: off axis (m)", 5),
            Column("free_end_height", [x[0] for x in of("height")], "height (m)", 5),
            Column("top_tension", [x[-1] for x in of("tension")], "top tension", 5),
            Column("error_bound", of("error_bound"), "error (rad)"),
        ]
        names = ("inclination", "offset", "height", "tension", "reaction_inclination")
        axes = {"offset": "pin", "height": "pin"}
        columns += [Column(name, _table(of(name)), axes=(axes.get(name, "link"),)) for name in names]
        notes = ["inclinations: to the downward vertical; error: proved bound of every inclination"]
        names = ("gravity", "angular_speed", "conical_height", "complete", "undecided")
        heading = f"{len(self)} shape{'s' * (len(self) != 1)} at {digits(self.angular_speed, 6)} rad/s"
        heading += ", proved complete" if self.complete else "; there may be more"
        facts = {name: getattr(self, name) for name in names}
        return Sheet("shape", heading, columns, facts, notes if len(self) else [], self.complete)


def _speed(height: float, gravity: float) -> float:
    return float(_core.conical_pendulum_angular_speed(np.asarray(height), np.asarray(gravity)))


def _table(rows: list[Floats]) -> Floats:
    return np.array(rows) if rows else np.empty((0, 0))


def shapes_made(
    found: _core.SteadyShapes, system: Chain | Rig, height: float, speed: float, gravity: float, direction: int
) -> SteadyShapes:
    """A list around compiled shapes."""
    given: dict[str, Any] = {"system": system, "gravity": gravity}
    items = tuple(SteadyShape._made(shape, direction=direction, **given) for shape in found.shapes)
    return SteadyShapes._made(found, _items=items, conical_height=height, angular_speed=speed, **given)
