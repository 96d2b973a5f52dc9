# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of all systems, and their stability."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..systems.chain import Chain
from ..systems.numbers import Floats, Whole, floats, numbers, refuse_where, shown
from .base import Field, Result, Results, UnavailableError, not_there
from .diagrams import ForceDiagram
from .held_sensitivity import held_shape_sensitivity
from .moving import Moving
from .sensitivity import Sensitivity
from .shape_sensitivity import shape_sensitivity
from .sheet import Column, Sheet, speed_text


TURN = 2 * math.pi
FORCES = ("tension", "effective_energy", "lower_pull", "upper_pull")


def is_driven(caller: str, frame: str) -> bool:
    """Return whether `frame` is ``driven``; a ValueError unless it is ``driven`` or ``free``."""
    if not isinstance(frame, str) or frame not in ("free", "driven"):
        raise ValueError(f"{caller}: frame must be 'free' or 'driven', got {shown(frame)}")
    return frame == "driven"


class Stability(
    Result,
    row="exponent",
    title="Stability ({frame}): {verdict}, growth rate {_growth_rate} n",
    notes=("without damping but that of dashpots; last two columns: growth rate added by a unit of damping, 1/s",),
):
    """Linear stability of a steady shape; times are in units of 1/n, with n the turning speed.

    Notes
    -----
    Exponents and verdict are without damping, except for dashpots at the pins of a rig. A minimum stays stable with friction
    at the pins. A ``spectrally stable`` shape is held by gyroscopic forces; friction at the pins can make it unstable.
    `internal_damping` and `external_damping` give the effect on each motion, to first order.

    References
    ----------
    Merkin, Introduction to the Theory of Stability (1997), chapter 6 (Kelvin, Tait and Chetaev). Kirillov,
    Nonconservative Stability Problems of Modern Physics (2013).

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.1)[1]
    >>> shape.stability().verdict, round(shape.stability().growth_rate, 4)
    ('unstable', 0.1091)

    A shape that is stable without friction and unstable with it:

    >>> pair = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0, mass=1.0), conical_height=0.2)[1].stability()
    >>> pair.verdict, bool(pair.internal_damping.max() > 0)
    ('spectrally stable', True)
    """

    __slots__ = ()
    number: Field[Whole] = Field(
        "Numbers of the exponents, from 1.",
        lambda s: np.arange(1, len(s.exponents) + 1),
        heading="exponent",
        column="exponent",
    )
    frame: Field[str] = Field("Frame of the analysis: ``'free'`` or ``'driven'``.", fact=True)
    verdict: Field[str] = Field("``'minimum'``, ``'spectrally stable'``, ``'unstable'`` or ``'undecided'``.", fact=True)
    exponents: Field[NDArray[np.complex128]] = Field(
        "The ``s`` of ``exp(s n t)``, ordered by imaginary part, without those of the rotation itself: ``4 N - 2`` for N "
        "links in the free frame, ``2 N`` in the driven frame; for N links held at both ends ``4 N - 8`` and ``2 N - 4``. "
        "Ends that yield or are carried round add to the number, pins without mass reduce it. For a cord the slowest ones, "
        "up to the first on which two discretisations do not agree to 1e-6.",
        heading="growth (n)",
        column="value",
        shown=lambda s: s.exponents.real,
    )
    frequency: Field[Floats] = Field(
        "Imaginary parts of the exponents, in units of the turning speed.",
        lambda s: s.exponents.imag,
        heading="frequency (n)",
    )
    exponent_error: Field[Floats] = Field(
        "Estimated error of each exponent, from rounding and for a cord from discretisation. It is large where two "
        "exponents meet, or one is near 0.",
        heading="error (n)",
        digits=2,
    )
    internal_damping: Field[Floats] = Field(
        "Effect of friction at the pins on each exponent, in 1/(kg m^2): this number times a small damping c is added to "
        "the growth rate (1/s). The damping c, N m s, is the moment at a pin over the relative angular speed of its links "
        "in the turning frame. NaN if two exponents coincide, and for a cord.",
        heading="with friction at pins",
    )
    external_damping: Field[Floats] = Field(
        "Effect of drag in still air on each exponent, in m/kg: this number times a small drag c is added to the growth "
        "rate. The drag c, N s/m^2, is the force per metre of link over its velocity in space. NaN if two exponents "
        "coincide.",
        heading="with drag in air",
    )
    growth_rate: Field[float] = Field(
        "Largest real part of the exponents, at least 0, in units of the turning speed; without exponents 0 for a minimum, "
        "else NaN.",
        fact=True,
    )
    margin: Field[float] = Field("Largest `exponent_error`; of a cord, the error estimate of `growth_rate`.", fact=True)
    negative_directions: Field[int] = Field(
        "Number of negative directions of the energy in the turning frame, at constant angular momentum in the free "
        "frame.",
        fact=True,
    )

    @property
    def _growth_rate(self) -> str:
        return f"{self.growth_rate:.3g}"


class Place(NamedTuple):
    """Position, inclination and tension at places of a cord.

    Attributes
    ----------
    offset : float or ndarray
        Offset from the axis, m.
    height : float or ndarray
        Height above the support (of a held cord: above its lower end), m.
    inclination : float or ndarray
        Inclination to the vertical, rad; positive if the offset decreases towards the upper end.
    tension : float or ndarray
        Tension, N or in the unit of the weights.

    Examples
    --------
    >>> import revchain as rc
    >>> place = rc.steady_shapes(rc.Cord(1.0), conical_height=0.1)[0].along(0.5)
    >>> round(float(place.offset), 6), round(float(place.height), 6)
    (0.493314, -0.080949)
    """

    offset: Any
    height: Any
    inclination: Any
    tension: Any


def forced(name: str) -> Callable[[Any], Any]:
    """A function that returns a force or energy of the compiled result, times `_per` of the result."""

    def compute(result: Any) -> Any:
        found, per = result._found(), result._per
        if not hasattr(found, name):
            raise UnavailableError(not_there(result, name))
        value = getattr(found, name)
        return value if per == 1.0 else per * np.asarray(value) if isinstance(value, list) else per * value

    return compute


def in_space(x: ArrayLike = 0.0, y: ArrayLike = 0.0, z: ArrayLike = 0.0) -> Floats:
    return np.stack(np.broadcast_arrays(*(np.asarray(each, np.float64) for each in (x, y, z))), axis=-1)


def _sensitivity(shape: SteadyShape) -> Sensitivity:
    if hasattr(shape, "arc_length"):
        raise UnavailableError(
            "revchain.SteadyShape.sensitivity: is for shapes of links; cut the cord into links: cord.chain(100), got "
            "a cord"
        )
    return held_shape_sensitivity(shape) if hasattr(shape, "lower_pull") else shape_sensitivity(shape)


class SteadyShape(
    Result,
    Moving,
    row="link",
    title="Steady shape of {_waves}{_at_speed}",
    notes=("{_order}", "{_in_compression}"),
):
    """One steady shape (relative equilibrium) of a system at one speed.

    `steady_shapes`, `steady_shape` and the branches return it. Arrays start at the free end, of a held system at the lower
    end: N links and their N + 1 pins, or n places of a cord.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), angular_speed=5.0)[0]
    >>> shape.inclination.round(4)
    array([1.3719, 1.3076])
    >>> shape.half_waves, shape.error_bound < 3e-16
    (1, True)
    >>> rope = rc.Held(rc.Chain.uniform_rods(10, length=1.0), span=0.5)
    >>> shape = rc.steady_shapes(rope, angular_speed=10.0)[0]
    >>> round(float(shape.offset.max()), 6), shape.proved
    (0.383428, True)
    """

    __slots__ = ()
    system: Field[Any] = Field("The chain, rig, cord, or held chain or cord.")
    angular_speed: Field[float] = Field(
        "The turning speed, rad/s.", lambda s: _speed(s.conical_height, s.gravity), fact=True
    )
    frequency: Field[float] = Field("Revolutions per second, Hz.", lambda s: s.angular_speed / TURN, fact=True)
    rpm: Field[float] = Field("Revolutions per minute.", lambda s: s.angular_speed * (60 / TURN), fact=True)
    period: Field[float] = Field("Time of one revolution, s.", lambda s: TURN / s.angular_speed)
    conical_height: Field[float] = Field("Conical height of the speed, m; 0 without gravity.", fact=True)
    half_waves: Field[int] = Field(
        "Sign changes of the offsets, plus one; for a held system about the line between the ends (with springs: between "
        "their rest positions).",
        fact=True,
    )
    error_bound: Field[float] = Field(
        "Bound of the error of each inclination, rad; for a cord also of each offset and height over the length. An "
        "estimate unless `proved`.",
        fact=True,
    )
    proved: Field[bool] = Field(
        "Whether `error_bound` is proved. It is an estimate for cords, at folds of branches, and where no proof was asked "
        "for or found.",
        fact=True,
    )
    residual: Field[float] = Field(
        "Unbalanced moment about a pin over total weight times total length; for cords and held systems an unbalanced "
        "force over the tension, or a gap at an end over the length.",
        fact=True,
    )
    condition: Field[float] = Field(
        "Largest change of an inclination, rad, over the relative change of the forces that causes it (for cords and held "
        "systems: of length, span or conical height). It is large near a critical height.",
        fact=True,
    )
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2; 0 without gravity.", fact=True)
    direction: Field[int] = Field(
        "Direction of rotation, 1 or -1; the shapes of rigs with flywheels depend on it.",
        fact=True,
    )
    moment_of_inertia: Field[float] = Field(
        "Moment of inertia about the axis, with the masses on springs at its ends, kg m^2, or weight times length squared. "
        "Still fluid adds its added mass, turning fluid subtracts the mass displaced. Not for hanging cords.",
        fact=True,
    )
    effective_energy: Field[float] = Field(
        "Potential energy (with that of springs) minus half the moment of inertia times the speed squared, J; it is "
        "stationary at a steady shape. Not for cords.",
        forced("effective_energy"),
        part=True,
        fact=True,
    )
    angular_momentum: Field[float] = Field(
        "Angular momentum about the axis, of a `Rig` with that of its flywheels, kg m^2/s, or with the unit of the "
        "weights. Not for hanging cords.",
        lambda s: s._angular_momentum(),
        fact=True,
    )
    span: Field[float] = Field("Distance between the two ends of a held system along the axis, m.", fact=True)
    support_offset: Field[float] = Field(
        "Offset of the upper end from the axis, m; 0 for a firm end on the axis.",
        lambda s: float(s.offset[-1]),
        fact=True,
    )
    inclination: Field[Floats] = Field(
        "Inclination of each link or place to the vertical, rad, within (-pi, pi]: to the downward vertical for "
        "hanging systems, to the upward one for held systems; positive if the offset decreases towards the upper end.",
    )
    offset: Field[Floats] = Field("Signed distance of each pin or place from the axis, m.")
    height: Field[Floats] = Field("Height of each pin or place above the support, m; for a held system above its lower end.")
    tension: Field[Floats] = Field(
        "Magnitude of the reaction at the upper pin of each link, shape (N,), N or in the unit of the weights; a push is "
        "positive, too. For a held chain at each pin, shape (N + 1,); for a cord at each place.",
        forced("tension"),
        part=True,
    )
    reaction_inclination: Field[Floats] = Field(
        "Inclination of the (upward) force whose magnitude is `tension` to the vertical, rad. Not for cords."
    )
    joint_angle: Field[Floats] = Field(
        "Inclination of the link below each pin minus that of the link above it, rad, for pins with a `tension`; beyond an "
        "end the inclination counts as 0. Not for cords.",
        lambda s: -np.diff(s.inclination, prepend=[0.0] * (s.reaction_inclination.size - s.inclination.size), append=0),
    )
    arc_length: Field[Floats] = Field("Distance of each place of a cord from the free or lower end along the cord, m.")
    position: Field[Floats] = Field(
        "Coordinates x, y, z of each pin or place, m, shape (n, 3), while the shape is in the plane y = 0: x is the "
        "offset, z the height.",
        lambda s: in_space(x=s.offset, z=s.height),
    )
    velocity: Field[Floats] = Field(
        "Velocity of each pin or place at that moment, m/s, shape (n, 3): it is along y.",
        lambda s: in_space(y=s.direction * s.angular_speed * s.offset),
    )
    reaction: Field[Floats] = Field(
        "Force at each pin with a `tension` on what is below it, x, y, z in the axes of `position`, N or in the unit "
        "of the weights; at the lower end of a held chain the force on the bearing. Not for cords.",
        lambda s: in_space(x=-s.tension * np.sin(s.reaction_inclination), z=s.tension * np.cos(s.reaction_inclination)),
    )
    lower_pull: Field[Floats] = Field(
        "Pull of a held system on its lower bearing, shape (2,): outwards (to the side of positive offsets) and upwards.",
        forced("lower_pull"),
        part=True,
    )
    upper_pull: Field[Floats] = Field(
        "Pull of a held system on its upper bearing, shape (2,): outwards and upwards.", forced("upper_pull"), part=True
    )
    sensitivity: Field[Sensitivity] = Field(
        "Derivatives of inclinations, offsets and tensions with respect to the speed and each datum; see "
        "`Sensitivity`. Not for cords.",
        _sensitivity,
    )
    _ends: Field[Floats] = Field("Stiffness, weight, radius of both held ends.", lambda s: s._found().ends, part=True)
    _path: Field[Floats] = Field("The path that `along` interpolates.", lambda s: s._found().path.ravel(), part=True)

    def along(self, arc_length: ArrayLike) -> Place:
        """Return offset, height, inclination and tension at distances along a cord.

        Parameters
        ----------
        arc_length : array_like
            Distances from the free end, of a held cord from the lower end, along the cord, m, 0 to the length, any
            shape.

        Returns
        -------
        Place
            Arrays with the shape of `arc_length`, as accurate as those of the shape. Cost: 1 microsecond for each
            place, 2 with a density function.

        Raises
        ------
        ValueError
            If a number lies outside the cord, or the shape is one of links.

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Cord(1.0), conical_height=0.1)[0]
        >>> round(float(shape.along(0.5).offset), 6)
        0.493314
        >>> cord = rc.Held(rc.Cord(1.0), span=0.5)
        >>> round(float(rc.steady_shapes(cord, conical_height=0.1)[0].along(0.5).offset), 6)
        0.380421
        """
        caller, found = "revchain.SteadyShape.along", self._found()
        if not hasattr(found, "along"):
            what = "is for cords; the pins of links are in offset and height"
            raise ValueError(f"{caller}: {what}, got {shown(self.system)}")
        length = self.system.length
        arc = floats(caller, "arc_length", arc_length)
        what = f"{caller}: arc_length must lie between 0 and the length {length:g}"
        refuse_where(~((arc >= 0) & (arc <= length)), arc, what)
        *where, tension = found.along(arc)
        return Place(*numbers([*where, self._per * tension]))

    def stability(self, *, frame: str = "free") -> Stability:
        """Return the linear stability of the shape: the growth or decay of small disturbances.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            ``free``: the links have ball joints and no torque acts about the axis; a support that is carried round keeps its
            speed. ``driven``: the links have hinges; they, and an end that yields, move in a plane that is driven at
            constant speed.

        Returns
        -------
        Stability
            The stability. Accuracy: 1e-13 of the largest exponent for simple ones; with masses up to 1e16 apart 2e-13, on
            arms and springs 5e-9. A verdict that the errors leave open is ``undecided``. Cost: O(N^3): 0.4 milliseconds for
            twenty links, 20 for a hundred; longer where twice the digits are needed. Cost for cords: 6 milliseconds for a
            shape without nodes, 0.1 s for one of three half waves.

        Raises
        ------
        ValueError
            If `frame` is another word, or the model does not cover the system, such as a support that rolls freely.

        Notes
        -----
        Links have no inertia about their own axes, apart from wheels; in the free frame a link keeps the angular momentum of
        its wheel. Still fluid acts by its buoyancy and its added mass. In a turning fluid there are no exponents: a shape of
        least energy at constant speed is a minimum, any other undecided.

        Method for cords: Galerkin's, with polynomials on panels. The exponents of ``cord.chain(N)`` approach these as
        ``1/N**2``.

        Examples
        --------
        >>> import revchain as rc
        >>> pair = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.1)
        >>> [shape.stability().verdict for shape in pair]
        ['minimum', 'unstable']

        A chair of a carousel outwards and in two shapes inwards; friction makes the last one unstable:

        >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0))
        >>> chair = [shape.stability() for shape in rc.steady_shapes(carousel, angular_speed=3.0)]
        >>> [found.verdict for found in chair]
        ['minimum', 'unstable', 'spectrally stable']
        >>> bool(chair[2].internal_damping.max() > 0)
        True
        >>> rubbing = rc.Rig(carousel.chain, support=carousel.support, pins=rc.Pin(damping=20.0))
        >>> [shape.stability().verdict for shape in rc.steady_shapes(rubbing, angular_speed=3.0)]
        ['minimum', 'unstable', 'unstable']

        Cords, hanging and held:

        >>> shapes = rc.steady_shapes(rc.Cord(1.0), conical_height=0.05)
        >>> [shape.stability().verdict for shape in shapes], round(shapes[1].stability().growth_rate, 6)
        (['minimum', 'unstable', 'spectrally stable'], 0.009808)
        >>> rope = rc.Held(rc.Cord(1.0), span=0.5)
        >>> [shape.stability().verdict for shape in rc.steady_shapes(rope, conical_height=0.01, max_half_waves=2)]
        ['minimum', 'spectrally stable']
        """
        driven = is_driven("revchain.SteadyShape.stability", frame)
        system = self.system._under(self.gravity)
        found: Any = _core.stability(system, self._found(), driven, self.direction, self.gravity)
        per = 1.0 if self.system.by_mass or self.gravity == 0 else self.gravity  # the core's unit of mass over kg
        damping = {name: per * getattr(found, name) for name in ("internal_damping", "external_damping")}
        return Stability._made(found, frame=frame, **damping)

    def force_diagram(self) -> ForceDiagram:
        """Return the graphical construction of the shape: force diagram and funicular polygon.

        Returns
        -------
        ForceDiagram
            The diagram. Its rays are parallel to the links, which is an independent check of the shape.

        Raises
        ------
        ValueError
            If the shape is not that of a `Chain`.

        Notes
        -----
        Source: Greenhill (1908), section 3, figures 3 and 5.

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
        found = _core.force_diagram(self._chain("force_diagram"), self._found())
        forces = {name: self._per * getattr(found, name) for name in ("load", "ray", "reaction")}
        return ForceDiagram._made(found, **forces)

    def transferred_to_axis(self) -> Chain:
        """Return the straight chain whose weights hang on the axis at the heights that they have in the shape.

        Returns
        -------
        Chain
            The chain; each link has the length of its vertical projection. One of its modes has the conical height and the
            offsets of the shape; for point masses it is mode ``half_waves``.

        Raises
        ------
        ValueError
            If the shape is not that of a `Chain`, or has an inverted link.

        Notes
        -----
        Source: Greenhill (1908), section 8 (21).

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.5)[0]
        >>> rc.modes(shape.transferred_to_axis()).conical_height.round(12)
        array([0.5       , 0.08366581])
        """
        chain = self._chain("transferred_to_axis")
        what = "is for shapes without inverted links: inclination must lie between -pi/2 and pi/2"
        inverted = np.cos(self.inclination) <= 0
        refuse_where(inverted, self.inclination, f"revchain.SteadyShape.transferred_to_axis: {what}")
        made = _core.transferred_to_axis(chain, self._found())
        return Chain._wrap(made, self.system.by_mass, self.system.names, self.system.order)

    @property
    def _per(self) -> float:
        """Factor from the forces of the compiled shape to those of the result."""
        return float(self.system._force_in_shape(self.gravity, self.conical_height, self.angular_speed))

    def _chain(self, method: str) -> _core.Chain:
        if not isinstance(self.system, Chain):
            raise ValueError(f"revchain.SteadyShape.{method}: is for shapes of a Chain alone, got {shown(self.system)}")
        return self.system._compiled

    def _from_parts(self) -> Any:
        """The compiled shape with these numbers; nothing is solved."""
        made: Any = _core.blank_shape(self.system._under(self.gravity))
        known, per = self.__dict__, self._per
        for name, field in self._fields.items():
            if field.part and name in known and hasattr(made, name.strip("_")):
                setattr(made, name.strip("_"), known[name] / per if name in FORCES else known[name])
        return made

    def _angular_momentum(self) -> float:
        by_mass = self.system.by_mass or self.gravity == 0
        turning = self.moment_of_inertia * self.angular_speed / (1.0 if by_mass else self.gravity)
        wheels: float = self.system._momentum_of_wheels(self.gravity, self.inclination)
        return self.direction * turning + wheels

    @property
    def _waves(self) -> str:
        return f"{self.half_waves} half wave{'s' * (self.half_waves != 1)}"

    @property
    def _at_speed(self) -> str:
        return at_speed(self.angular_speed, self._speed_unit)

    @property
    def _compressed(self) -> list[str]:
        """Names of the links that are pushed at their upper pins."""
        if self.system._is_cord:
            return []
        count = len(self.inclination)
        along = np.cos(self.reaction_inclination[-count:] - self.inclination)
        pushed = np.flatnonzero((along < -1e-9) & (self.tension[-count:] > 0))
        return [self.system._link_name(int(link)) for link in pushed]

    @property
    def _in_compression(self) -> str:
        return compression("", self._compressed)

    @property
    def _order(self) -> str:
        if hasattr(self, "span"):
            return "heights above the lower end"
        if hasattr(self, "arc_length"):
            return "arc lengths from the free end, heights above the support"
        return "links from the free end up; inclinations to the downward vertical"

    def _sheet(self, brief: bool = False) -> Sheet:
        sheet = super()._sheet(brief)
        held, along = hasattr(self, "span"), getattr(self, "arc_length", None)
        unit = " (N)" * self.system.by_mass
        headings = {"offset": "from axis (m)", "height": "height (m)", "tension": f"tension{unit}"}
        if along is not None:
            rows = Column("arc_length", along, "arc length (m)", unit="m")
        elif held:
            rows = Column("pin", np.arange(len(self.offset)), "pin")
        else:  # a row for each link with its lower pin; the support is a fact
            rows = Column("link", self.system._link_numbers, "link", shown=getattr(self.system, "names", None))
            headings |= {"inclination": "inclination (°)", "offset": "lower pin: from axis (m)"}
            headings |= {"height": "above support (m)"}
        columns = [rows]
        for name in _BY_PIN:
            values = getattr(self, name, None)
            if values is None or len(values) < len(rows.values) or (brief and name not in headings):
                continue
            values = values[: len(rows.values)]
            shown = np.degrees(values) if name == "inclination" else None
            axes = ("component",) * (values.ndim - 1)
            columns.append(Column(name, values, headings.get(name, ""), axes=axes, shown=shown, unit=_BY_PIN[name]))
        row = "link" if along is None and not held else "place"
        return Sheet(row, sheet.heading, columns, sheet.facts, sheet.notes, spread=along is not None or held)


_BY_PIN = {"inclination": "rad", "offset": "m", "height": "m", "tension": "", "reaction_inclination": "rad"}
_BY_PIN |= {"joint_angle": "rad", "position": "m", "velocity": "m/s", "reaction": ""}


def _of_each(doc: str, of: Callable[[SteadyShape], Any], **column: Any) -> Field[Any]:
    """A number or array of each shape of a list."""
    return Field(doc, lambda shapes: stacked([of(shape) for shape in shapes]), **column)


def _free_end(shape: SteadyShape, along: Floats) -> float:
    if hasattr(shape, "span"):
        raise UnavailableError("revchain.SteadyShapes: a held system has no free end")
    return float(along[0])


def stacked(rows: list[Any]) -> Any:
    """Numbers, or arrays of one length, as one array; arrays of different lengths unchanged."""
    return np.array(rows) if len({np.shape(row) for row in rows}) < 2 else tuple(rows)


def _arrays_of_each(name: str, given: tuple[str, ...] = ()) -> Field[Any]:
    """An array of each shape of a list."""

    def axes(shapes: Any) -> tuple[str, ...]:
        if not len(shapes):
            return ()
        if given or hasattr(shapes[0], "arc_length"):
            return given or ("place",)
        return ("link" if len(getattr(shapes[0], name)) == len(shapes[0].inclination) else "pin",)

    unit = "force" if name in ("tension", "lower_pull", "upper_pull") else "rad" if name.endswith("inclination") else "m"
    return _of_each(f"`SteadyShape.{name}` of each shape.", lambda shape: getattr(shape, name), axes=axes, unit=unit)


class SteadyShapes(Results[SteadyShape], Moving, row="shape", title="{_heading}", notes=("{_note}", "{_out_of_plane}")):
    """The steady shapes of a system, ordered by half waves, then inclination of the lowest link.

    Its fields `half_waves`, `lowest_inclination` and so on have one number or array for each shape.

    Examples
    --------
    >>> import revchain as rc
    >>> shapes = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.1)
    >>> shapes.half_waves, shapes.complete
    (array([1, 2]), True)
    """

    __slots__ = ()
    system: Field[Any] = Field("The chain, rig, cord, or held chain or cord.")
    number: Field[Whole] = Field(
        "Numbers of the rows of the table, from 1.", lambda s: np.arange(1, len(s) + 1), heading="shape", column="shape"
    )
    half_waves: Field[Whole] = Field(
        "Half waves of each shape.", lambda s: np.array([shape.half_waves for shape in s], int), heading="half waves"
    )
    speed: Field[Floats | None] = Field(
        "Speed of each shape, rad/s, if they have different speeds; else None.",
        lambda s: np.array([shape.angular_speed for shape in s]) if s.angular_speed is None else None,
        heading="speed", unit="rad/s",
    )
    lowest_inclination = _of_each(
        "Inclination of the lowest link or of the lower end of each shape, rad.", lambda x: x.inclination[0],
        heading=lambda s: "lowest link" if s._of_hanging_links else "lower end", unit="rad", digits=5,
    )
    top_inclination = _of_each(
        "Inclination of the top link or of the upper end of each shape, rad.", lambda x: x.inclination[-1],
        heading=lambda s: "top link" if s._of_hanging_links else "", unit="rad", digits=5,
    )
    free_end_offset = _of_each(
        "Offset of the free end of each shape, m; not for held systems.", lambda x: _free_end(x, x.offset),
        heading=lambda s: "free end: from axis" if s._of_hanging_links else "", unit="m", digits=5,
    )
    free_end_height = _of_each(
        "Height of the free end of each shape above the support, m; not for held systems.",
        lambda x: _free_end(x, x.height),
        heading=lambda s: "above support" if s._of_hanging_links else "", unit="m", digits=5,
    )
    largest_offset = _of_each(
        "Largest distance of a pin or place of each shape from the axis, m.", lambda x: float(np.abs(x.offset).max()),
        heading=lambda s: "" if s._of_hanging_links else "largest distance from axis", unit="m", digits=5,
    )
    top_tension = _of_each(
        "Size of the force at the upper end of each shape, N or in the unit of the weights.", lambda x: x.tension[-1],
        heading="top tension", unit="force", digits=5,
    )
    span = _of_each("Span of each shape of a held system, m.", lambda x: x.span, heading="span", unit="m", digits=5)
    error_bound = _of_each(
        "`SteadyShape.error_bound` of each shape, rad.", lambda x: x.error_bound, heading="error (rad)"
    )
    inclination, offset, height = (_arrays_of_each(name) for name in ("inclination", "offset", "height"))
    tension, reaction_inclination = (_arrays_of_each(name) for name in ("tension", "reaction_inclination"))
    lower_pull, upper_pull = (_arrays_of_each(name, ("axis",)) for name in ("lower_pull", "upper_pull"))
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2; 0 without gravity.", fact=True)
    angular_speed: Field[float | None] = Field(
        "The turning speed, rad/s; None if the shapes were selected by an inclination, tip radius or tension.", fact=True
    )
    conical_height: Field[float | None] = Field(
        "Conical height of the speed, m; 0 without gravity; None where `angular_speed` is.",
        fact=True,
    )
    complete: Field[bool] = Field(
        "Whether it is proved that no shape of the kind searched for is missing: for a chain or rig in its own posture, or "
        "with ``hanging_only=False`` in any; for a held system with up to `max_half_waves` half waves, in the plane of the "
        "axis and the ends. False where shapes may leave the plane of the axis, and if only the branch of a `mode` was "
        "searched.",
        fact=True,
    )
    hanging_only: Field[bool] = Field(
        "Whether shapes in other postures than that of the chain or rig were left out; false for cords and held systems.",
        fact=True,
    )
    undecided: Field[Floats] = Field(
        "Ranges of the inclination of the lowest link in which there may be more shapes, rad, shape (k, 2).",
        fact=True,
    )
    missing: Field[tuple[int, ...]] = Field(
        "Numbers of half waves, up to `max_half_waves`, with which no shape of a held system was found.", fact=True
    )
    mode: Field[int | None] = Field("Number of the mode whose branch was searched; None if all shapes were.", fact=True)
    cells: Field[int] = Field("Number of parts of the range that were examined.")

    def _how_many(self, at: str = "") -> str:
        shapes = f"shape{'s' * (len(self) != 1)}"
        if self.mode is not None:
            return f"{len(self)} {shapes} of the branch of mode {self.mode}{at}"
        kind = {"": shapes, "hanging": f"hanging {shapes}", "given": f"{shapes} in the rig's posture"}[self._posture()]
        number = f"{len(self)} {kind}{at}"
        if self.missing:
            waves = f"{', '.join(map(str, self.missing))} half wave{'s' * (list(self.missing) != [1])}"
            number = f"{number}; none {'found ' * (not self.complete)}with {waves}"
        if self._links_lean:
            return f"{number}, proved complete in a plane"
        return f"{number}, proved complete" if self.complete else f"{number}; there may be more"

    @property
    def _links_lean(self) -> bool:
        """Whether all shapes in a plane with the axis are known, and a link could lean out of it."""
        hangs = not (self.system._is_cord or self.system._is_held) and self.mode is None
        return hangs and not self.complete and not len(self.undecided)

    def _posture(self) -> str:
        """The posture of the shapes in the list, ``hanging`` or as ``given``; empty if the list is of all postures.

        One link alone cannot stand, and below the first critical speed a chain has no shape in any posture.
        """
        inverted = getattr(self.system, "inverted", None)  # of a rig
        if not self.hanging_only or (inverted is None and self.complete and (len(self.system) == 1 or not len(self))):
            return ""
        return "hanging" if inverted is None or not np.any(inverted) else "given"

    @property
    def _of_hanging_links(self) -> bool:
        return not (hasattr(self.system, "span") or (len(self) and hasattr(self[0], "arc_length")))

    @property
    def _heading(self) -> str:
        words = self._how_many("" if self.angular_speed is None else at_speed(self.angular_speed, self._speed_unit))
        if not self._posture():
            return words
        others = "with links above their pins" if self._posture() == "hanging" else "in other postures"
        return f"{words}; {others} there may be more" if self.complete or self._links_lean else f"{words}, also {others}"

    @property
    def _note(self) -> str:
        if not len(self):
            straight = self.complete and not self.missing
            return "it hangs straight: the speed is below the first critical speed" if straight else ""
        way = "upward" if hasattr(self[0], "span") else "downward"
        proved = {bool(shape.proved) for shape in self}
        error = "proved bound on every inclination" if proved == {True} else "estimated"
        return f"inclinations: from the {way} vertical; error: {error}"

    @property
    def _out_of_plane(self) -> str:
        pushed = [compression(f"shape {k}: ", shape._compressed) for k, shape in enumerate(self, 1)]
        return "\n".join(note for note in [self._leaves_plane, *pushed] if note)

    @property
    def _leaves_plane(self) -> str:
        if self._links_lean:
            return "a link could lean to any side under no load: shapes that leave the plane are not searched for"
        if getattr(self.system, "is_planar", True):
            return ""
        return "both ends are off the axis: shapes that leave the plane of the ends are not searched for"

    def _is_good(self) -> bool:
        return self.complete or self._links_lean or self.mode is not None or hasattr(self.system, "span")


MOST_NAMED = 4  # links in a note


def compression(where: str, links: list[str]) -> str:
    """Return a note about links in compression; empty if there are none."""
    if not links:
        return ""
    more = f" and {len(links) - MOST_NAMED} more" if len(links) > MOST_NAMED else ""
    names = "; ".join(links[:MOST_NAMED]) + more
    return f"{where}in compression, which only rods can carry: {names} (tension is the size of the force)"


def at_speed(speed: float, unit: str | None = None) -> str:
    return f" at {speed_text(speed, unit)}"


def _speed(height: float, gravity: float) -> float:
    return float(_core.conical_pendulum_angular_speed(np.asarray(height), np.asarray(gravity)))


def shape_made(found: Any, system: Any, gravity: float, direction: int = 1, **given: Any) -> SteadyShape:
    given = {"proved": getattr(found, "proved", not hasattr(found, "arc_length")), **given}
    return SteadyShape._made(found, system=system, gravity=gravity, direction=direction, **given)


def shapes_made(found: Any, system: Any, gravity: float, direction: int, **given: Any) -> SteadyShapes:
    speed = {"angular_speed": given["angular_speed"]} if hasattr(system, "span") else {}
    items = tuple(shape_made(shape, system, gravity, direction, **speed) for shape in found.shapes)
    return SteadyShapes._made(found, _items=items, system=system, gravity=gravity, **{"mode": None, **given})
