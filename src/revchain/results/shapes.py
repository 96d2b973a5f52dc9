# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of chains and rigs, their stability and their diagrams."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..systems.chain import Chain
from ..systems.held import Held
from ..systems.numbers import Floats, shown
from ..systems.rig import Rig
from .base import Field, Result, Results
from .diagrams import ForceDiagram
from .moving import Moving
from .sensitivity import Sensitivity
from .shape_sensitivity import shape_sensitivity
from .sheet import Column, Sheet, digits

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TURN = 2 * math.pi


def is_driven(place: str, frame: str) -> bool:
    """Whether `frame` is ``driven``; a ValueError unless it is ``driven`` or ``free``."""
    if not isinstance(frame, str) or frame not in ("free", "driven"):
        raise ValueError(f"{place}: frame must be 'free' or 'driven', got {shown(frame)}")
    return frame == "driven"


class Stability(Result):
    """Linear stability of a steady shape; times are in units of 1/n, with n the turning speed.

    Notes
    -----
    Exponents and verdict are without damping. A minimum stays stable with friction at the pins. A shape that is only
    ``spectrally stable`` is stabilized by gyroscopic forces: any friction at the pins makes its motions of negative energy
    grow. `internal_damping` and `external_damping` give the effect on each motion, to first order.

    References
    ----------
    Merkin, Introduction to the Theory of Stability (1997), chapter 6 (Kelvin, Tait and Chetaev). Kirillov, Nonconservative
    Stability Problems of Modern Physics (2013).

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
    frame: Field[str] = Field("Frame of the analysis: ``'free'`` or ``'driven'``.")
    verdict: Field[str] = Field("``'minimum'``, ``'spectrally stable'``, ``'unstable'`` or ``'undecided'``.")
    exponents: Field[NDArray[np.complex128]] = Field(
        "All ``s`` of ``exp(s n t)``, ordered by imaginary part, without those of the rotation itself: ``4 N - 2`` for N links "
        "in the free frame, ``2 N`` in the driven frame. The links are rods without inertia about their own axes. A pin "
        "without mass reduces the number: the two links that meet there stay in line. A support that yields adds 4 in the "
        "free frame, 2 in the driven frame. A support carried round adds 2 in the free frame, because no rotation is left "
        "out.",
    )
    exponent_error: Field[Floats] = Field(
        "Estimate of the error of each exponent due to rounding in the shape, its tensions and all later steps (for a "
        "cord, at least the difference of two discretisations). It is large where two exponents meet, or one is near "
        "0.",
    )
    internal_damping: Field[Floats] = Field(
        "Effect of friction at the pins on each exponent, in 1/(kg m^2): this number times a small damping c is added to the "
        "growth rate (1/s). The damping c, N m s, is the moment at each pin divided by the relative angular speed of its "
        "links in the turning frame. NaN if two exponents coincide.",
    )
    external_damping: Field[Floats] = Field(
        "Effect of drag in still air on each exponent, in m/kg: this number times a small drag c is added to the growth rate. "
        "The drag c, N s/m^2, is the force per metre of link divided by its velocity in space. Without flywheels, a drag "
        "proportional to mass lowers each growth rate by half the ratio of drag to mass.",
    )
    growth_rate: Field[float] = Field(
        "Largest real part of the exponents, in units of the turning speed; NaN in a rotating fluid, where it is "
        "unknown.",
    )
    margin: Field[float] = Field("The largest `exponent_error`: errors cause no growth rate above it.")
    negative_directions: Field[int] = Field(
        "Number of negative directions of the energy in the turning frame, at constant angular momentum in the free frame.",
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        count = len(self.exponents)
        columns = [
            Column("exponent", np.arange(1, count + 1), "exponent"),
            Column("value", self.exponents, "growth (n)", shown=self.exponents.real),
            Column("frequency", self.exponents.imag, "frequency (n)"),
            Column("exponent_error", self.exponent_error, "error (n)", 2),
            Column("internal_damping", self.internal_damping, "with friction at pins"),
            Column("external_damping", self.external_damping, "with drag in air"),
        ]
        facts = {name: getattr(self, name) for name in ("frame", "verdict", "growth_rate", "margin")}
        heading = f"Stability ({self.frame}): {self.verdict}, growth rate {self.growth_rate:.3g} n"
        notes = ["without damping; last two columns: growth rate added by a unit of damping, 1/s"]
        return Sheet("exponent", heading, columns, facts | {"negative_directions": self.negative_directions}, notes)


def judged(found: _core.Stability, frame: str, shape: Shape) -> Stability:
    """The stability of a shape from the compiled one; the effects of damping are converted to masses."""
    per = 1.0 if shape.system.by_mass or shape.gravity == 0 else shape.gravity
    damping = {name: per * getattr(found, name) for name in ("internal_damping", "external_damping")}
    return Stability._made(found, frame=frame, **damping)


def forced(name: str) -> Any:
    """A function that returns a force of the compiled shape, times gravity if masses were given."""

    def compute(shape: Any) -> Any:
        value, per = getattr(shape._found(), name), shape._per
        return value if per == 1.0 else per * value

    return compute


def in_space(x: ArrayLike = 0.0, y: ArrayLike = 0.0, z: ArrayLike = 0.0) -> Floats:
    """Vectors from their components."""
    return np.stack(np.broadcast_arrays(*(np.asarray(each, np.float64) for each in (x, y, z))), axis=-1)


def force_above(size: Floats, inclination: Floats) -> Floats:
    """Forces of the links above pins on what hangs below, from their sizes and their inclinations to the vertical."""
    return in_space(x=-size * np.sin(inclination), z=size * np.cos(inclination))


class Shape(Result, Moving):
    """One steady shape (relative equilibrium) of a system at one speed; arrays start at the free or lower end."""

    __slots__ = ()
    system: Field[Any] = Field("The chain, rig, cord, or held chain or cord.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2; 0 without gravity.")
    angular_speed: Field[float] = Field("The turning speed, rad/s.", lambda s: _speed(s.conical_height, s.gravity))
    frequency: Field[float] = Field("Revolutions per second, Hz.", lambda s: s.angular_speed / TURN)
    rpm: Field[float] = Field("Revolutions per minute.", lambda s: s.angular_speed * (60 / TURN))
    period: Field[float] = Field("Time of one revolution, s.", lambda s: TURN / s.angular_speed)
    conical_height: Field[float] = Field("Conical height of the speed, m; 0 without gravity.")
    half_waves: Field[int] = Field("Sign changes of the offsets, plus one.")
    position: Field[Floats] = Field(
        "Coordinates x, y, z of each pin or place, m, shape (n, 3), while the shape is in the plane y = 0: x is the offset, "
        "z the height.",
        lambda s: in_space(x=s.offset, z=s.height),
    )
    velocity: Field[Floats] = Field(
        "Velocity of each pin or place at that moment, m/s, shape (n, 3): it is along y.",
        lambda s: in_space(y=getattr(s, "direction", 1) * s.angular_speed * s.offset),
    )

    @property
    def _per(self) -> float:
        """Factor from the forces of the compiled shape to those of the result."""
        return self.system._force(self.gravity)  # type: ignore[no-any-return]

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the shape, true to scale.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing.

        Raises
        ------
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=1.0), conical_height=0.05)[0].plot()
        >>> ax.get_xlabel()
        'distance from axis (m)'
        """
        from ..plots.shapes import plot_shapes

        return plot_shapes([self], ax)

    @classmethod
    def _columns(cls, shapes: Sequence[Any]) -> list[Column]:
        """Columns of the table of a list of shapes."""
        raise NotImplementedError


class SteadyShape(Shape):
    """One steady shape (relative equilibrium) of a chain or rig: links lowest first, pins free end first.

    `steady_shapes`, `steady_shape` and the branches return it.

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
    direction: Field[int] = Field("Direction of rotation, 1 or -1; only a rig with flywheels depends on it.")
    inclination: Field[Floats] = Field(
        "Inclination of each link to the downward vertical, rad, shape (N,), within (-pi, pi]."
    )
    offset: Field[Floats] = Field(
        "Signed distance of each pin from the axis, m, shape (N + 1,). The last is that of the support; it is 0 unless a `Rig` "
        "moves it.",
    )
    height: Field[Floats] = Field("Height of each pin above the support, m, shape (N + 1,).")
    tension: Field[Floats] = Field(
        "Magnitude of the reaction at the upper pin of each link, shape (N,), N or in the unit of the weights.",
        forced("tension"),
        part=True,
    )
    reaction_inclination: Field[Floats] = Field(
        "Inclination of the reaction at the upper pin of each link to the vertical, rad, shape (N,)."
    )
    joint_angle: Field[Floats] = Field(
        "Inclination of each link minus that of the link above it, rad, shape (N,); for the top link, its own "
        "inclination.",
        lambda s: s.inclination - np.append(s.inclination[1:], 0.0),
    )
    reaction: Field[Floats] = Field(
        "Force on each link at its upper pin, x, y, z in the axes of `position`, shape (N, 3), N or in the unit of the "
        "weights.",
        lambda s: force_above(s.tension, s.reaction_inclination),
    )
    residual: Field[float] = Field(
        "Largest moment about a pin of the chain below it, divided by total weight times total length."
    )
    error_bound: Field[float] = Field(
        "Bound of the error of each inclination, rad. It is proved, except at a fold of a branch, where it is an estimate.",
    )
    condition: Field[float] = Field(
        "Largest change of an inclination, rad, divided by the relative change of the forces that causes it. Each "
        "weight and each centrifugal force changes by up to this fraction, with any sign.",
    )
    moment_of_inertia: Field[float] = Field(
        "Moment of inertia about the axis, kg m^2; for a chain given by weight, in weight times length squared."
    )
    effective_energy: Field[float] = Field(
        "Potential energy minus half the moment of inertia times the speed squared, J; it is stationary at a steady "
        "shape.",
        forced("effective_energy"),
        part=True,
    )
    sensitivity: Field[Sensitivity] = Field(
        "Derivatives of inclinations, offsets and tensions with respect to the speed and each datum; see "
        "`Sensitivity`.",
        shape_sensitivity,
    )
    angular_momentum: Field[float] = Field(
        "Angular momentum about the axis, kg m^2/s, or with the unit of the weights. For a `Rig` it includes that of the "
        "flywheels, and is negative if the total is opposite to a positive speed.",
        lambda s: s._angular_momentum(),
    )

    def stability(self, *, frame: str = "free") -> Stability:
        """Return the linear stability of the shape: the growth or decay of small disturbances.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            ``free``: the links have ball joints and no torque acts about the axis, so that the angular momentum is constant;
            a support that is carried round keeps its speed instead. ``driven``: the links have hinges; they, and a support
            that yields, move in a plane that is driven at constant speed.

        Returns
        -------
        Stability
            The stability. Accuracy: 1e-13 of the largest exponent for simple ones; with masses up to 1e16 apart 2e-13, on arms
            and springs 5e-9. `exponent_error` estimates the error of each, and a verdict within it is ``undecided``. The exponents are without damping;
            `Stability.internal_damping` and `Stability.external_damping` give the effect of a little of it. Cost:
            ``(4 N)**3 / 2`` operations: half a millisecond for twenty links, a tenth of a second for a hundred. Where double
            precision loses digits, twice the digits are used, up to 25 links in the free frame: a hundred times as long.

        Raises
        ------
        ValueError
            If `frame` is another word; if a motion of a `Rig` moves no mass, or a flywheel acts on a support that yields and
            has no mass.

        Notes
        -----
        In the free frame each link of a `Rig` keeps its angular momentum about its own axis (with its wheel, free or
        driven), because ball joints transmit no torque along a link. Still fluid acts only by its added mass. The motion of
        a turning fluid around a disturbed link is not modelled, so there are no exponents. A shape of least energy at
        constant speed (except for a rotation) is then a minimum and stable in any such fluid; any other is undecided.

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
        """
        driven = is_driven("revchain.SteadyShape.stability", frame)
        if isinstance(self.system, Rig):
            rig = self.system._under(self.gravity)
            found = _core.stability_of_rig(rig, self._found(), driven, self.direction, self.gravity)
        else:
            found = _core.stability(self._chain("stability"), self._found(), driven)
        return judged(found, frame, self)

    def force_diagram(self) -> ForceDiagram:
        """Return the graphical construction of the shape: force diagram and funicular polygon.

        Returns
        -------
        ForceDiagram
            The diagram. Its rays are sums of weights and centrifugal forces from below; they are parallel to the links,
            which is an independent check of the shape.

        Raises
        ------
        ValueError
            If the shape is that of a `Rig`.

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
        if self._per == 1.0:
            return ForceDiagram._made(found)
        forces = {name: self._per * getattr(found, name) for name in ("load", "ray", "reaction")}
        return ForceDiagram._made(found, **forces)

    def transferred_to_axis(self) -> Chain:
        """Return the straight chain whose weights hang on the axis at the heights that they have in the shape.

        Returns
        -------
        Chain
            The chain; each link has the length of its vertical projection. One of its modes has the conical height and
            the offsets of the shape, for links of any kind; for point masses it is mode ``half_waves``.

        Raises
        ------
        ValueError
            If the shape is that of a `Rig`.

        Notes
        -----
        Inclinations enter relation (21) only through ``conical_height / cos(inclination)``. Perpendicular to the turning
        plane the shape is as stiff as this chain. Source: Greenhill (1908), section 8 (21).

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.5)[0]
        >>> rc.modes(shape.transferred_to_axis()).conical_height.round(12)
        array([0.5       , 0.08366581])
        """
        made = _core.transferred_to_axis(self._chain("transferred_to_axis"), self._found())
        return Chain._wrap(made, self.system.by_mass, self.system.names)

    def _chain(self, method: str) -> _core.Chain:
        if isinstance(self.system, Rig):
            raise ValueError(
                f"revchain.SteadyShape.{method}: is for shapes of a Chain; for a Rig ask modes, or the shape of its chain"
            )
        core: _core.Chain = self.system._compiled
        return core

    def _from_parts(self) -> Any:
        per = {"tension": self._per, "effective_energy": self._per}
        return _core.SteadyShape(**{name: getattr(self, name) / per.get(name, 1) for name in _CORE})

    def _angular_momentum(self) -> float:
        turning = self.moment_of_inertia / self.gravity * self.angular_speed
        if isinstance(self.system, Rig):
            kept = float(np.sum(self.system._momentum(self.gravity) * np.cos(self.inclination)))
            turning = self.direction * turning + kept
        return self._per * turning

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("link", np.arange(len(self.inclination)), "link", shown=getattr(self.system, "names", None)),
            Column("inclination", self.inclination, "inclination (°)", shown=np.degrees(self.inclination)),
            Column("offset", self.offset[:-1], "lower pin: from axis (m)"),
            Column("height", self.height[:-1], "above support (m)"),
            Column("tension", self.tension, "tension" + " (N)" * self.system.by_mass),
            Column("reaction_inclination", self.reaction_inclination),
            Column("joint_angle", self.joint_angle),
            Column("position", self.position[:-1], axes=("component",)),
            Column("velocity", self.velocity[:-1], axes=("component",)),
            Column("reaction", self.reaction, axes=("component",)),
        ]
        names: tuple[str, ...] = ("angular_speed", "conical_height", "half_waves", "error_bound", "residual", "condition")
        names += ("gravity", "direction", "moment_of_inertia", "effective_energy", "angular_momentum")
        heading = f"Steady shape of {self.half_waves} half wave{'s' * (self.half_waves != 1)}{at_speed(self.angular_speed)}"
        notes = ["links from the free end up; inclinations to the downward vertical"]
        facts = {name: getattr(self, name) for name in names} | {"support_offset": float(self.offset[-1])}
        return Sheet("link", heading, columns, facts, notes)


    _note: ClassVar[str] = "inclinations: from the downward vertical; error: proved bound on every inclination"

    @classmethod
    def _columns(cls, shapes: Sequence[Any]) -> list[Column]:
        angles = [shape.inclination for shape in shapes]
        unit = " (N)" if shapes[0].system.by_mass else ""
        lowest, top = [x[0] for x in angles], [x[-1] for x in angles]
        columns = [
            Column("lowest_inclination", lowest, "lowest link (°)", 5, shown=np.degrees(lowest)),
            Column("top_inclination", top, "top link (°)", 5, shown=np.degrees(top)),
            Column("free_end_offset", [x.offset[0] for x in shapes], "free end: from axis (m)", 5),
            Column("free_end_height", [x.height[0] for x in shapes], "above support (m)", 5),
            Column("top_tension", [x.tension[-1] for x in shapes], f"top tension{unit}", 5),
            Column("error_bound", [x.error_bound for x in shapes], "error (rad)"),
        ]
        names = ("inclination", "offset", "height", "tension", "reaction_inclination")
        axes = {"offset": "pin", "height": "pin"}
        return columns + [
            Column(name, table([getattr(x, name) for x in shapes]), axes=(axes.get(name, "link"),)) for name in names
        ]


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


class SteadyShapes(Results[Any], Moving):
    """The steady shapes of a system at one speed, ordered by half waves, then inclination of the lowest link.

    Examples
    --------
    >>> import revchain as rc
    >>> shapes = rc.steady_shapes(rc.Chain.uniform_plummets(2, length=2.0), conical_height=0.1)
    >>> [shape.half_waves for shape in shapes], shapes.complete
    ([1, 2], True)
    """

    __slots__ = ()
    system: Field[Any] = Field("The chain, rig, cord, or held chain or cord.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2; 0 without gravity.")
    conical_height: Field[float] = Field("Conical height of the speed, m; 0 without gravity.")
    angular_speed: Field[float] = Field("The turning speed, rad/s.")
    complete: Field[bool] = Field(
        "Whether it is proved that no shape is missing: for a chain or rig no hanging shape, or with "
        "``hanging_only=False`` no shape at all; for a held system no shape with up to `max_half_waves` half waves. "
        "False if both ends of a held chain are off the axis: shapes may then leave their plane, and such shapes are "
        "not searched for.",
    )
    undecided: Field[Floats] = Field(
        "Ranges of the inclination of the lowest link in which there may be more shapes, rad, shape (k, 2). For a held chain: "
        "shapes in the plane of the axis and the ends.",
    )
    cells: Field[int] = Field("Number of parts of the range that were examined.")
    hanging_only: Field[bool] = Field(
        "Whether shapes with a link above its upper pin were left out (of a rig: with other links inverted than those of the "
        "rig); false for cords and held systems.",
        lambda s: isinstance(s.system, Chain | Rig),
        part=True,
    )
    missing: Field[tuple[int, ...]] = Field(
        "For a held system: numbers of half waves without a shape, up to `max_half_waves`."
    )

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw all shapes in one picture, true to scale, coloured by half waves.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing.

        Raises
        ------
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=1.0), conical_height=0.02).plot()
        >>> ax.get_title()
        '5 hanging shapes, proved complete'
        """
        from ..plots.shapes import plot_shapes

        axes = plot_shapes(self, ax)
        axes.set_title(self._how_many())
        return axes

    def _how_many(self, at: str = "") -> str:
        shapes = f"shape{'s' * (len(self) != 1)}"
        kind = {"": shapes, "hanging": f"hanging {shapes}", "given": f"{shapes} in the rig's posture"}[self._posture()]
        number = f"{len(self)} {kind}{at}"
        if self.missing:
            waves = f"{', '.join(map(str, self.missing))} half wave{'s' * (list(self.missing) != [1])}"
            number = f"{number}; none {'found ' * (not self.complete)}with {waves}"
        return f"{number}, proved complete" if self.complete else f"{number}; there may be more"

    def _posture(self) -> str:
        """The posture of the shapes in the list, ``hanging`` or as ``given``; empty if the list is of all postures.

        One link alone cannot stand, and below the first critical speed a chain has no shape in any posture.
        """
        chain = isinstance(self.system, Chain)
        if not self.hanging_only or (chain and self.complete and (len(self.system) == 1 or not len(self))):
            return ""
        return "hanging" if chain or not np.any(self.system.inverted) else "given"

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("shape", np.arange(1, len(self) + 1), "shape"),
            Column("half_waves", np.array([shape.half_waves for shape in self], int), "half waves"),
        ]
        notes = []
        if not len(self) and self.complete and not isinstance(self.system, Held):
            notes = ["it hangs straight: the speed is below the first critical speed"]
        if len(self):
            kind = type(self[0])
            columns += kind._columns(self)
            notes = [kind._note]
        if isinstance(self.system, Held) and not self.system.is_planar:
            notes.append("both ends are off the axis: shapes that leave the plane of the ends are not searched for")
        if self._posture():
            other = "with links above their pins" if self._posture() == "hanging" else "in other postures"
            notes.append(f"hanging_only=False also looks for shapes {other}")
        names = ("gravity", "angular_speed", "conical_height", "complete", "hanging_only", "undecided", "missing")
        heading = self._how_many(at_speed(self.angular_speed))
        facts = {name: getattr(self, name) for name in names}
        return Sheet("shape", heading, columns, facts, notes, self.complete or isinstance(self.system, Held))


def at_speed(speed: float) -> str:
    """In headings."""
    return f" at {digits(speed, 6)} rad/s ({digits(speed * 30 / math.pi, 4)} rpm)"


def _speed(height: float, gravity: float) -> float:
    return float(_core.conical_pendulum_angular_speed(np.asarray(height), np.asarray(gravity)))


def table(rows: list[Floats]) -> Floats:
    """Arrays of one length as rows of an array; unchanged if the lengths differ."""
    return np.array(rows) if rows else np.empty((0, 0))


def shapes_made(
    found: _core.SteadyShapes,
    system: Chain | Rig,
    height: float,
    speed: float,
    gravity: float,
    direction: int,
    hanging_only: bool,
) -> SteadyShapes:
    """The list of the compiled shapes of a chain or rig."""
    given: dict[str, Any] = {"system": system, "gravity": gravity}
    items = tuple(SteadyShape._made(shape, direction=direction, **given) for shape in found.shapes)
    given |= {"conical_height": height, "angular_speed": speed, "hanging_only": hanging_only, "missing": ()}
    return SteadyShapes._made(found, _items=items, **given)
