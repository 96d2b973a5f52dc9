# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of cords, and of chains and cords held at both ends."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any, ClassVar, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.chain import Chain
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import Floats, floats, numbers, refuse_where
from .base import Field, UnavailableError
from .held_sensitivity import held_shape_sensitivity
from .sensitivity import Sensitivity
from .shapes import Shape, Stability, SteadyShapes, at_speed, force_above, forced, is_driven, judged
from .sheet import Column, Sheet


class Place(NamedTuple):
    """Position, inclination and tension at places of a cord.

    Attributes
    ----------
    offset : float or ndarray
        Offset from the axis, m.
    height : float or ndarray
        Height above the support (of a held cord: above its lower end), m; negative if the cord hangs.
    inclination : float or ndarray
        Inclination to the vertical, rad; positive if the cord approaches the axis going up.
    tension : float or ndarray
        Tension, N or in the unit of the weights.

    Examples
    --------
    >>> import revchain as rc
    >>> place = rc.steady_shapes(rc.Cord(1.0), conical_height=0.1)[0].at(0.5)
    >>> round(float(place.offset), 6), round(float(place.height), 6)
    (0.493314, -0.080949)
    """

    offset: Any
    height: Any
    inclination: Any
    tension: Any


class _Bent(Shape):
    """The base of shapes of cords and of held chains. Each can be computed again from its index in the list."""

    __slots__ = ()
    inclination: Field[Floats] = Field(
        "Inclination of each link or place to the vertical, rad, within (-pi, pi]; positive if it approaches the axis going "
        "up.",
    )
    offset: Field[Floats] = Field("Distance of each pin or place from the axis, m.")
    height: Field[Floats] = Field(
        "Height of each pin or place above the support, m; for a held system above its lower end."
    )
    tension: Field[Floats] = Field(
        "Tension at each pin or place, N or in the unit of the weights.", forced("tension"), part=True
    )
    condition: Field[float] = Field(
        "Largest change of an inclination, rad, divided by the relative change of length, span or conical height that "
        "causes it. It is large near a critical height.",
    )
    _asked: Field[tuple[Any, ...]] = Field("Data to repeat the question, and the index in the list.")

    @property
    def _reach(self) -> float:
        return float(np.abs(self.offset).max())

    def _places(self) -> list[Column]:
        cord: Any = self  # chains have pins
        return [Column("arc_length", cord.arc_length, "arc length (m)")]

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            *self._places(),
            Column("offset", self.offset, "from axis (m)"),
            Column("height", self.height, "height (m)"),
            Column("tension", self.tension, "tension" + " (N)" * self.system.by_mass),
            Column("position", self.position, axes=("component",)),
            Column("velocity", self.velocity, axes=("component",)),
        ]
        names = [name for name in self._fields if name not in ("system", "period", "sensitivity") and not name.startswith("_")]
        facts = {name: getattr(self, name) for name in names}
        facts = {name: value for name, value in facts.items() if np.ndim(value) == 0}
        heading = f"Steady shape of {self.half_waves} half wave{'s' * (self.half_waves != 1)}{at_speed(self.angular_speed)}"
        return Sheet("place", heading, columns, facts, [self._place_note], spread=True)

    _note: ClassVar[str]
    _place_note: ClassVar[str]

    @classmethod
    def _columns(cls, shapes: Sequence[Any]) -> list[Column]:
        lowest = [x.inclination[0] for x in shapes]
        return [
            Column("lowest_inclination", lowest, "lower end (°)", 5, shown=np.degrees(lowest)),
            Column("largest_offset", [x._reach for x in shapes], "largest distance from axis (m)", 5),
            Column("free_end_offset", [x.offset[0] for x in shapes]),
            Column("top_tension", [x.tension[-1] for x in shapes], f"top tension{' (N)' if shapes[0].system.by_mass else ''}", 5),
            *cls._ends(shapes),
            Column(cls._accuracy, [getattr(x, cls._accuracy) for x in shapes], "error (rad)"),
            Column("inclination", [x.inclination for x in shapes], axes=(cls._axes[0],)),
            *(Column(name, [getattr(x, name) for x in shapes], axes=(cls._axes[1],)) for name in ("offset", "height", "tension")),
        ]

    _accuracy: ClassVar[str] = "error_estimate"
    _axes: ClassVar[tuple[str, str]] = ("place", "place")

    @classmethod
    def _ends(cls, shapes: Sequence[Any]) -> list[Column]:
        return []


def _no_sensitivity(shape: Any) -> Sensitivity:
    raise UnavailableError(
        f"revchain.{type(shape).__name__}.sensitivity: is for shapes of links; cut the cord into links: cord.chain(100), got a cord"
    )


class CordShape(_Bent):
    """One steady shape of a cord hung from one end. The points of its arrays are closest where the cord bends sharply.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shapes(rc.Cord(1.0), conical_height=0.1)[0]
    >>> round(float(shape.at(0.5).offset), 6)
    0.493314
    """

    __slots__ = ()
    arc_length: Field[Floats] = Field("Distance of each place from the free end along the cord, m, shape (n,).")
    residual: Field[float] = Field(
        "Unbalanced horizontal force of the whole cord at the support, divided by its tension there. For a density "
        "function: difference between the series of the tension and the tension from pull and weight, likewise divided.",
    )
    error_estimate: Field[float] = Field(
        "Estimate of the error of each inclination, rad, and of each offset and height divided by the length. Measured "
        "errors reach 0.6 of it.",
        lambda s: s._found().error_bound,
        part=True,
    )
    sensitivity: Field[Sensitivity] = Field("Not available: raises an AttributeError.", _no_sensitivity)
    _note: ClassVar[str] = "lower end: inclination there from the downward vertical; error: estimated"
    _place_note: ClassVar[str] = "arc lengths from the free end, heights above the support"

    def at(self, arc_length: ArrayLike) -> Place:
        """Return offset, height, inclination and tension at distances along the cord.

        Parameters
        ----------
        arc_length : array_like
            Distances from the free end along the cord, m, 0 to the length, any shape.

        Returns
        -------
        Place
            Arrays with the shape of `arc_length`, as accurate as those of the shape. Cost: 1 microsecond for each place,
            10 with a density function.

        Raises
        ------
        ValueError
            If a number lies outside the cord.

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Cord(1.0), conical_height=0.1)[0]
        >>> round(float(shape.at(0.0).offset), 6)
        0.989943
        """
        arc = _on_cord("revchain.CordShape.at", arc_length, self.system.length)
        offset, height, inclination, tension = self._found().at(arc)
        return Place(*numbers([offset, height, inclination, self._per * tension]))

    def stability(self, *, frame: str = "free") -> Stability:
        """Return the linear stability of the shape: the growth or decay of small disturbances.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            ``free``: no torque acts about the axis, so that the angular momentum is constant. ``driven``: the cord moves
            in a plane that is driven at constant speed.

        Returns
        -------
        Stability
            ``exponents`` are the slowest of infinitely many, up to the first on which two discretisations do not agree to
            1e-6; most are correct to 1e-9. None is left out between them. ``margin`` covers their difference in the growth rate; if they differ in more, the verdict is
            ``'undecided'``. ``internal_damping`` is NaN, because a flexible cord has no bending stiffness.

        Raises
        ------
        ValueError
            If `frame` is another word.

        Notes
        -----
        Method: Galerkin's method with polynomials on panels along the cord. The exponents of chains of N links differ from
        these by an amount proportional to ``1 / N**2``. Cost: 15 milliseconds for a shape without nodes, 0.3 s for one of
        three half waves.

        Examples
        --------
        >>> import revchain as rc
        >>> shapes = rc.steady_shapes(rc.Cord(1.0), conical_height=0.05)
        >>> [shape.stability().verdict for shape in shapes]
        ['minimum', 'unstable', 'spectrally stable']
        >>> round(shapes[1].stability().growth_rate, 6)
        0.009808
        """
        driven = is_driven("revchain.CordShape.stability", frame)
        return judged(_core.cord_stability(self.system._compiled, self._found(), driven), frame, self)

    def _from_parts(self) -> Any:
        core = self.system._compiled
        if len(self._asked) == 4:
            return _core.cord_shape_near(core, *self._asked)
        height, scanned, place = self._asked
        return _core.cord_shapes(core, height, scanned).shapes[place]


class _HeldShape(_Bent):
    """The base of shapes of chains and cords held at both ends."""

    __slots__ = ()
    tension: Field[Floats] = Field(
        "Magnitude of the force at each pin or place, N or in the unit of the weights.",
        forced("height_times_tension"),
        part=True,
    )
    lower_pull: Field[Floats] = Field(
        "Pull of the chain on the lower bearing, shape (2,): outwards (to the side of positive offsets) and upwards.",
        lambda s: s._per * np.array(s._found().lower_pull),
        part=True,
    )
    upper_pull: Field[Floats] = Field(
        "Pull of the chain on the upper bearing, shape (2,): outwards and upwards.",
        lambda s: s._per * np.array(s._found().upper_pull),
        part=True,
    )
    span: Field[float] = Field("Distance between the two ends along the axis, m.")
    residual: Field[float] = Field(
        "Largest unbalanced force divided by the tension, or largest gap at an end divided by the length."
    )
    _note: ClassVar[str] = "lower end: inclination there from the upward vertical"
    _place_note: ClassVar[str] = "heights above the lower end"

    @property
    def _per(self) -> float:
        if self.system.weightless:
            return float(self.angular_speed) ** 2
        return float(self.system._force(self.gravity) / self.conical_height)

    @classmethod
    def _ends(cls, shapes: Sequence[Any]) -> list[Column]:
        return [
            Column("span", [x.span for x in shapes], "span (m)", 5),
            Column("lower_pull", np.array([x.lower_pull for x in shapes]), axes=("axis",)),
            Column("upper_pull", np.array([x.upper_pull for x in shapes]), axes=("axis",)),
        ]

    def _from_parts(self) -> Any:
        *asked, place = self._asked
        held = self.system
        if asked and asked[0] == "branch":
            from .held_branches import branch_again

            return branch_again(held, tuple(asked[1:])).shapes[place]
        if asked and asked[0] == "mode":
            mode, name, value = asked[1:]
            lower, upper = held._ends(self.gravity)
            return _core.held_shape(held.system._compiled, held.span, lower, upper, mode, name, value, place)
        by = (held.span, held._pull(self.gravity), held.weightless, *held._ends(self.gravity))
        return _core.held_shapes(held.system._compiled, *by, *asked).shapes[place]


class HeldShape(_HeldShape):
    """One steady shape of a chain held at both ends: links lowest first, pins from the lower end up.

    Examples
    --------
    >>> import revchain as rc
    >>> rope = rc.Held(rc.Chain.uniform_rods(10, length=1.0), span=0.5)
    >>> shape = rc.steady_shapes(rope, angular_speed=10.0)[0]
    >>> round(float(shape.offset.max()), 6), shape.proved
    (0.383428, True)
    """

    __slots__ = ()
    force_inclination: Field[Floats] = Field(
        "Inclination of the upward force at each pin (`tension`) to the vertical, rad, shape (N + 1,)."
    )
    joint_angle: Field[Floats] = Field(
        "Inclination of the link below each pin minus that of the link above it, rad, shape (N + 1,); 0 beyond the "
        "ends.",
        lambda s: -np.diff(s.inclination, prepend=0.0, append=0.0),
    )
    reaction: Field[Floats] = Field(
        "Force at each pin on what is below it, x, y, z in the axes of `position`, shape (N + 1, 3), N or in the unit of the "
        "weights; at the lower end the force on the bearing.",
        lambda s: force_above(s.tension, s.force_inclination),
    )
    error_bound: Field[float] = Field("Bound of the error of each inclination, rad; an estimate unless `proved`.")
    proved: Field[bool] = Field("Whether `error_bound` is proved; else it is an estimate.")
    sensitivity: Field[Sensitivity] = Field(
        "Derivatives of inclinations, offsets and tensions at the pins with respect to the speed, the data of each link, the "
        "span or the tension, and the supports of the ends.",
        held_shape_sensitivity,
    )
    moment_of_inertia: Field[float] = Field(
        "Moment of inertia about the axis, with the masses on springs, kg m^2; for a chain given by weight, in weight times "
        "length squared.",
    )
    effective_energy: Field[float] = Field(
        "Potential energy (with that of the springs) less that of the centrifugal forces, J. It is stationary among figures "
        "of equal span.",
        forced("height_times_energy"),
        part=True,
    )
    _accuracy: ClassVar[str] = "error_bound"
    _axes: ClassVar[tuple[str, str]] = ("link", "pin")

    def stability(self, *, frame: str = "free") -> Stability:
        """Return the linear stability of the shape; firm ends are fixed, ends on springs move across the axis.

        Parameters
        ----------
        frame : {"free", "driven"}
            ``free``: the links have ball joints, and no torque acts about the axis. ``driven``: the links have hinges and
            move in a plane that is driven at constant speed.

        Returns
        -------
        Stability
            For N links there are ``4 N - 8`` exponents in the free frame, ``2 N - 4`` in the driven frame; each end on a
            spring adds 4 or 2. Arms off the axis turn at a constant speed and add 2 in the free frame. Accuracy: about
            1e-13 of the largest exponent for simple ones. Cost: ``(4 N)**3 / 2`` operations. The exponents are without
            damping; `Stability.internal_damping` and `Stability.external_damping` give the effect of a little of it.

        Raises
        ------
        ValueError
            If `frame` is another word, or a movable pin has no mass (an upper end on a spring may have none).

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.Held(rc.Chain.uniform_rods(10, length=1.0), span=0.5)
        >>> [shape.stability().verdict for shape in rc.steady_shapes(rope, conical_height=0.01, max_half_waves=2)]
        ['minimum', 'spectrally stable']
        """
        driven = is_driven("revchain.HeldShape.stability", frame)
        return judged(_core.held_stability(self.system.system._compiled, self._found(), driven), frame, self)

    def _places(self) -> list[Column]:
        return [Column("pin", np.arange(len(self.offset)), "pin")]

    def _sheet(self, brief: bool = False) -> Sheet:
        sheet = super()._sheet(brief)
        joints = [Column("joint_angle", self.joint_angle), Column("reaction", self.reaction, axes=("component",))]
        return replace(sheet, columns=[*sheet.columns, *joints])


class HeldCordShape(_HeldShape):
    """One steady shape of a uniform cord with both ends on the axis; places are listed from the lower end up.

    Examples
    --------
    >>> import revchain as rc
    >>> cord = rc.Held(rc.Cord(1.0), span=0.5)
    >>> round(float(rc.steady_shapes(cord, conical_height=0.1)[0].at(0.5).offset), 6)
    0.380421
    """

    __slots__ = ()
    arc_length: Field[Floats] = Field("Distance of each place from the lower end along the cord, m, shape (n,).")
    error_estimate: Field[float] = Field(
        "Estimate of the error of each inclination, rad, and of each offset and height divided by the length.",
        lambda s: s._found().error_bound,
        part=True,
    )
    moment_of_inertia: Field[float] = Field(
        "Moment of inertia about the axis, kg m^2; for a cord given by weight, in weight times length squared."
    )

    def stability(self, *, frame: str = "free") -> Stability:
        """Return the linear stability of the shape with both ends fixed.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            ``free``: no torque acts about the axis, so that the angular momentum is constant. ``driven``: the cord moves
            in a plane that is driven at constant speed.

        Returns
        -------
        Stability
            The stability, with the accuracy and the limits of `CordShape.stability`.

        Raises
        ------
        ValueError
            If `frame` is another word.

        Examples
        --------
        >>> import revchain as rc
        >>> rope = rc.Held(rc.Cord(1.0), span=0.5)
        >>> [shape.stability().verdict for shape in rc.steady_shapes(rope, conical_height=0.01, max_half_waves=2)]
        ['minimum', 'spectrally stable']
        """
        driven = is_driven("revchain.HeldCordShape.stability", frame)
        return judged(_core.held_stability(self.system.system._compiled, self._found(), driven), frame, self)
    sensitivity: Field[Sensitivity] = Field("Not available: raises an AttributeError.", _no_sensitivity)

    def at(self, arc_length: ArrayLike) -> Place:
        """Return offset, height, inclination and tension at distances along the cord.

        Parameters
        ----------
        arc_length : array_like
            Distances from the lower end along the cord, m, 0 to the length, any shape.

        Returns
        -------
        Place
            Arrays with the shape of `arc_length`.

        Raises
        ------
        ValueError
            If a number lies outside the cord.

        Examples
        --------
        >>> import revchain as rc
        >>> cord = rc.Held(rc.Cord(1.0), span=0.5)
        >>> round(float(rc.steady_shapes(cord, conical_height=0.1)[0].at(0.5).offset), 6)
        0.380421
        """
        arc = _on_cord("revchain.HeldCordShape.at", arc_length, self.system.length)
        offset, height, inclination, tension = self._found().at_arc(arc)
        return Place(*numbers([offset, height, inclination, self._per * tension]))


def _on_cord(place: str, arc_length: ArrayLike, length: float) -> Floats:
    arc = floats(place, "arc_length", arc_length)
    refuse_where(~((arc >= 0) & (arc <= length)), arc, f"{place}: arc_length must lie between 0 and the length {length:g}")
    return arc


_NONE: dict[str, Any] = {"undecided": np.empty((0, 2)), "cells": 0}


def held_shapes_made(
    found: Any, system: Held, height: float, speed: float, gravity: float, asked: tuple[Any, ...]
) -> SteadyShapes:
    """The list of the compiled shapes of a held system."""
    kind = HeldCordShape if isinstance(system.system, Cord) else HeldShape
    given: dict[str, Any] = {"system": system, "gravity": gravity, "conical_height": height, "angular_speed": speed}
    items = tuple(kind._made(shape, _asked=(*asked, k), **given) for k, shape in enumerate(found.shapes))
    looked = {"undecided": found.undecided, "cells": found.cells} if isinstance(system.system, Chain) else _NONE
    return SteadyShapes._made(None, _items=items, complete=found.complete, missing=tuple(found.missing), **given, **looked)


def branch_shape(found: _core.CordShape, system: Cord, gravity: float, at_fold: bool = False) -> CordShape:
    """The shape of a cord from a compiled shape on its branch."""
    asked = (found.conical_height, found.half_waves, float(found.offset[0]), at_fold)
    return CordShape._made(found, system=system, gravity=gravity, _asked=asked)


def cord_shapes_made(
    found: Any, system: Cord, height: float, speed: float, gravity: float, scanned: int
) -> SteadyShapes:
    """The list of the compiled shapes of a cord."""
    given: dict[str, Any] = {"system": system, "gravity": gravity, "conical_height": height, "angular_speed": speed}
    items = tuple(CordShape._made(shape, _asked=(height, scanned, k), **given) for k, shape in enumerate(found.shapes))
    return SteadyShapes._made(None, _items=items, complete=found.complete, missing=(), **given, **_NONE)
