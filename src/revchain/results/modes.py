# SPDX-License-Identifier: GPL-3.0-or-later
"""`Modes`, the result of `revchain.modes`, with its proof and the other solutions of a rig."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from typing import TYPE_CHECKING, Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..systems.numbers import Floats, Numbers, Whole, boolean, floats, one_positive, place_of, refuse_beyond_memory, refuse_where
from .base import Field, Result, Row, UnavailableError, asked_in
from .moving import Moving
from .sheet import in_unit

if TYPE_CHECKING:
    from .sensitivity import Sensitivity, Uncertainty

Complex = NDArray[np.complex128]
TURN = 8 * np.arctan(np.longdouble(1))
MOST_OFFSETS = 100_000  # largest number of offsets to compute for the nodes of a table
SPEED_ROUNDING = 2.1 * 2.0**-52  # rounding of a speed computed from a height


class Certificate(Result, row="mode", title="Certificate: intervals proved to hold the conical heights"):
    """Intervals that are proved to contain the conical heights, and the counts that prove it.

    ``above_lower[i]`` conical heights of the system exceed ``lower[i]``, and ``above_upper[i]`` exceed ``upper[i]``; with
    flywheels, of the direction of the mode. Because ``above_upper[i] < number[i] <= above_lower[i]``, the height with that
    number lies in the interval: ``lower < height <= upper``.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[1.0, 3.0], length=1.0)
    >>> proof = rc.modes(chain, certify=True).certificate
    >>> proof.above_lower, proof.above_upper
    (array([1, 2]), array([0, 1]))
    >>> rc.count_modes(chain, conical_height=proof.lower)
    array([1, 2])
    """

    __slots__ = ()
    number: Field[Whole] = Field("Mode numbers, shape (k,).", heading="mode", column="mode")
    lower: Field[Numbers] = Field(
        "Lower end of each interval, m, shape (k,); 0 if nothing could be proved.", heading="height above", unit="m", digits=17
    )
    upper: Field[Numbers] = Field(
        "Upper end of each interval, m, shape (k,); infinite if nothing could be proved.",
        heading="height at most",
        unit="m",
        digits=17,
    )
    above_lower: Field[Whole] = Field(
        "Proved count of the heights above each lower end, shape (k,).", heading="heights > lower"
    )
    above_upper: Field[Whole] = Field(
        "Proved count of the heights above each upper end, shape (k,).", heading="heights > upper"
    )
    lower_low: Field[Floats | None] = Field(
        "Second double of each lower end with ``precision='double-double'``, else None.", otherwise=lambda c: None
    )
    upper_low: Field[Floats | None] = Field(
        "Second double of each upper end with ``precision='double-double'``, else None.", otherwise=lambda c: None
    )
    _lower_rest: Field[Floats | None] = Field(
        "What a double leaves out of each lower end.", lambda c: rest(c.lower, c.lower_low), axes=(), column="lower_low", unit="m"
    )
    _upper_rest: Field[Floats | None] = Field(
        "What a double leaves out of each upper end.", lambda c: rest(c.upper, c.upper_low), axes=(), column="upper_low", unit="m"
    )


class OtherModes(Result, row="number", title="{summary}"):
    """The m solutions of a rig that are not steady motions: with negative, complex or infinite heights, or complex speeds.

    Examples
    --------
    >>> import revchain as rc
    >>> stick = rc.Rig(rc.Chain(mass=1.0, length=1.0), inverted=True)
    >>> rc.modes(stick).other.growth_rate.round(4)
    array([3.1316])
    """

    __slots__ = ()
    number: Field[Whole] = Field("Numbers of the solutions, from 1.", lambda o: np.arange(1, len(o) + 1), axes=())
    conical_height: Field[Complex] = Field(
        "Conical heights, m, shape (m,).", heading="height", unit="m", shown=lambda o: [_complex(h) for h in o.conical_height]
    )
    angular_speed: Field[Complex] = Field(
        "Speeds ``n`` with ``n**2 * conical_height = gravity``, rad/s, shape (m,). Offsets vary as ``exp(1j * n * t)``.",
        axes=(),
        unit="rad/s",
    )
    growth_rate: Field[Floats] = Field(
        "Size of the imaginary part of each speed, 1/s. Small offsets grow as ``exp(growth_rate * t)``.",
        heading="growth rate",
        unit="1/s",
    )
    error_bound: Field[Floats] = Field(
        "Proved bound of the error of each height, relative to its size.", heading="error bound"
    )
    summary: Field[str] = Field(
        "The number of solutions in words.",
        lambda o: "1 solution that is not a steady motion" if len(o) == 1 else f"{len(o)} solutions that are not steady motions",
    )

    def __len__(self) -> int:
        return int(self.conical_height.size)


def _complex(height: complex) -> str:
    return f"{height.real:.9g}" if height.imag == 0 else f"{height.real:.6g} {height.imag:+.6g}i"


def _of_height(name: str, of_speed: Callable[[Any], Any]) -> Callable[[Modes], Numbers]:
    """A function of modes: `_core.conical_pendulum_NAME` of heights; for rigs and longdouble `of_speed` of speeds."""
    compiled: Callable[[Floats, Any], Floats] = getattr(_core, f"conical_pendulum_{name}")

    def compute(modes: Modes) -> Numbers:
        if modes.system._kind == "rig":
            return of_speed(modes.angular_speed)  # type: ignore[no-any-return]
        height = modes.conical_height
        if modes.precision == "extended":
            with np.errstate(invalid="ignore", divide="ignore"):
                return of_speed(np.sqrt(np.longdouble(modes.gravity)) / np.sqrt(height))  # type: ignore[no-any-return]
        if not height.size or height[-1] > 0:  # the last is the least
            return compiled(height, modes.gravity)
        # By rounding, the dense reference methods may return heights that are not positive.
        return np.where(height > 0, compiled(np.where(height > 0, height, 1.0), modes.gravity), np.nan)

    return compute


def _nodes(modes: Modes, name: str = "nodes") -> Any:
    """The nodes or vertical points of each mode."""
    if modes._is_damped:  # what crosses the axis moves
        return tuple(np.empty(0) for _ in modes.number)
    if modes.number.size and modes.system._kind.endswith("cord"):
        refuse_beyond_memory(f"revchain.Modes.{name}", "the number of the last mode", int(modes.number[-1]), 8)
    return getattr(modes._found(), name)


def _vertical_points(modes: Modes) -> Any:
    modes._require_cord("vertical_points")
    return _nodes(modes, "vertical_points")


def _bob_slope(modes: Modes) -> Any:
    if not (modes.system._kind == "cord" and modes.system._compiled.has_bob):
        raise UnavailableError("revchain.Modes.bob_slope: is for a Cord with a bob: Cord(..., tip_centroid=)")
    return modes._found().bob_slope


def _signed_turn(speed: Any) -> Any:
    return TURN if speed.dtype == np.longdouble else float(TURN)


class Modes(Result, Moving, row="mode", title="{summary}", notes=("{_remarks}",), good="status"):
    """The modes of a system, slowest first: speeds, shapes, nodes and error bounds of k modes.

    Shapes, nodes, residuals and sensitivities are computed when they are first read. Arrays are read-only. ``modes[0]`` is
    a row: one number or array of each field. For a system held straight at both ends, distances start at its lower end.
    Fields treat linear drag like dashpots.

    Notes
    -----
    Heights of a cord follow from zeros of Bessel functions, Greenhill (1908), section 4: of ``J0`` for a uniform cord,
    of ``Jp`` for a density s^p, of a cross product of ``J`` and ``Y`` for a uniform cord with a tip or held at both
    ends. Those of a weightless cord are those of a string; others are computed by power series. Accuracy
    (``error_bound``): 3 ulp, 2 ulp with a tip or held, 4e-15 by power series, more with point masses, a bob or jumps of
    density. Nodes and vertical points: 5 ulp (uniform), 3 ulp (a power), else 1e-15 of the length. Cost: 0.1 to 5
    microseconds for a height in closed form, 0.4 to 3 milliseconds for each mode up to the last by power series.

    Examples
    --------
    >>> import revchain as rc
    >>> m = rc.modes(rc.Chain.uniform_plummets(2, length=2.0))
    >>> m
    2 of 2 modes of a chain of 2 links, length 2, weight 1: by aberth, success
    mode  speed (rad/s)  speed (rpm)  period (s)   height (m)  error bound  nodes (m from the free end)
       1        2.39679      22.8877     2.62150   1.70710678      1.1e-16                            0
       2        5.78636      55.2557     1.08586  0.292893219      1.1e-16                     1: 0.293
    gravity 9.80665 m/s^2; error bound: relative, of the conical height
    >>> m.shape.round(4)
    array([[ 1.    ,  0.4142,  0.    ],
           [ 0.4142, -1.    ,  0.    ]])
    >>> [mode.nodes.round(4).tolist() for mode in m]
    [[], [0.2929]]

    A gyrostat on a link, ``A n^2 - H n - W h = 0``:

    >>> top = rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=1.5))
    >>> rc.modes(top).angular_speed.round(4)
    array([-2.4701,  3.9701])

    A cord, with shapes at any point:

    >>> m = rc.modes(rc.Cord(0.36), 3)
    >>> m.angular_speed.round(4)
    array([ 6.2757, 14.4054, 22.583 ])
    >>> m.along([0.0, 0.18])[1].round(4)
    array([ 1.    , -0.4017])
    >>> m.nodes[2].round(4), m.vertical_points[2].round(4)
    (array([0.0278, 0.1465]), array([0.0706, 0.2366]))
    """

    __slots__ = ()
    _unused = ("exponent", "damping_ratio", "decay_time", "error_estimate")  # without dashpots
    _is_damped: bool = False
    system: Field[Any] = Field("The system.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    number: Field[Whole] = Field(
        "Mode numbers, shape (k,), 1 for the slowest. For a rig with flywheels the number among those of its direction. "
        "With dashpots the numbers are by the size of `exponent`, of both directions together.",
        otherwise=lambda m: np.arange(m._found().first, m._found().first + len(m)),
        heading="mode",
        column="mode",
    )
    direction: Field[Whole] = Field(
        "Direction of each mode, shape (k,): 1 forward, -1 backward; all 1 without momentum.",
        otherwise=lambda m: np.ones(len(m), np.int64),
        axes=(),
    )
    angular_speed: Field[Numbers] = Field(
        "Whirl speed of each mode, ``sqrt(gravity / conical_height)``, rad/s, shape (k,), negative for backward modes. "
        "With dashpots it is the imaginary part of `exponent`. longdouble with ``precision='extended'``.",
        otherwise=_of_height("angular_speed", lambda speed: speed),
        heading="speed",
        unit="rad/s",
    )
    frequency: Field[Numbers] = Field(
        "Revolutions per second, Hz, shape (k,), with the sign of the speed.",
        _of_height("revolutions_per_second", lambda speed: speed / _signed_turn(speed)),
        axes=(),
        unit="Hz",
    )
    rpm: Field[Numbers] = Field(
        "Revolutions per minute, shape (k,).", lambda m: 60 * m.frequency, heading="speed", unit="rpm"
    )
    period: Field[Numbers] = Field(
        "Time of one revolution, s, shape (k,).",
        _of_height("period", lambda speed: _over(_signed_turn(speed), np.abs(speed))),
        heading="period",
        unit="s",
    )
    speed_error_bound: Field[Floats] = Field(
        "Bound of the relative error of each angular speed, shape (k,), for the given gravity, proved if `error_bound` is; "
        "also of frequency and period, which for a rig have up to 4.5e-16 more.",
        otherwise=lambda m: _speed_bound(m.error_bound.astype(np.float64)),
        axes=(),
    )
    conical_height: Field[Numbers] = Field(
        "Conical height ``gravity / angular_speed**2`` of each mode, m, shape (k,), descending. Not with dashpots.",
        heading="height",
        unit="m",
        digits=9,
    )
    error_bound: Field[Numbers] = Field(
        "Bound of the relative error of each conical height (with dashpots: of each exponent), shape (k,), for the data as "
        "stored. It is proved; for cords, and for formulas that `rtol` allows, it is checked by measurement.",
        heading="error bound",
    )
    nodes: Field[tuple[Numbers, ...]] = Field(
        "For each mode, the distances from the free end at which it crosses the axis, without supports; with dashpots none.",
        _nodes,
        axes=("node",),
        unit="m",
        heading=lambda m: f"nodes (m from the {'lower' if m.system._kind.startswith('held') else 'free'} end)",
        shown=lambda m: _texts(m.nodes),
    )
    exponent: Field[Complex] = Field(
        "Exponents s of the motions ``shape * exp(s * t)``, 1/s, shape (k,). The imaginary part is the angular speed. With "
        "dashpots the real part is negative for a motion that decays; else it is 0.",
        lambda m: 1j * m.angular_speed.astype(float),
        axes=(),
        unit="1/s",
    )
    damping_ratio: Field[Floats] = Field(
        "Damping ratio of each mode, ``-exponent.real / abs(exponent)``, shape (k,): 0 without dashpots, 1 for a motion that "
        "only decays, negative for one that grows.",
        lambda m: -m.exponent.real / np.abs(m.exponent),
        heading="damping ratio",
        shown=lambda m: _ratios(m),
    )
    decay_time: Field[Floats] = Field(
        "Time in which each motion decays to 1/e, s, shape (k,): infinite without dashpots and drag, negative if it grows.",
        lambda m: _over(-1.0, m.exponent.real),
        heading="decay time",
        unit="s",
    )
    error_estimate: Field[Floats] = Field(
        "With dashpots: estimate of the relative error of each exponent, shape (k,), also where `error_bound` is infinite.",
        otherwise=lambda m: m.speed_error_bound,
        axes=(),
    )
    rigid: Field[int] = Field(
        "1 if a trolley rolls freely: the system can then also move as a whole, at speed 0, which is no mode. Else 0.",
        otherwise=lambda m: 0,
    )
    residual: Field[Numbers | None] = Field(
        "Residual of each shape, shape (k,): largest unbalanced force at a pin divided by the largest sum of the "
        "magnitudes of the forces at a pin. None with dashpots, and for cords.",
        otherwise=lambda m: None,
        axes=(),
    )
    arc_length: Field[Floats] = Field(
        "For a cord: distances from the free end of the places of `shape`, m, shape (201,), evenly spaced.",
        lambda m: np.linspace(0.0, m._require_cord("arc_length").length, 201),
    )
    shape: Field[Numbers] = Field(
        "Offsets of the pins, shape (k, N + 1), free or lower end first. The largest magnitude of each mode is 1, and the "
        "free end (of a held chain the lowest pin that can move) is positive. With dashpots they are complex, and the "
        "largest is 1. For a cord: offsets of the places `arc_length`, shape (k, 201), 1 at the free end; of a cord held at "
        "both ends, 1 at the lowest vertical point.",
        otherwise=lambda m: m.along(m.arc_length),
        axes=("pin",),
    )
    vertical_points: Field[tuple[Numbers, ...]] = Field(
        "For a cord: for each mode the distances from the free end at which the cord is vertical, or turns back at a point "
        "mass; section 4 (13), (14) of the paper.",
        _vertical_points,
    )
    bob_slope: Field[Floats] = Field(
        "For a cord with a bob: the slope ``d offset / d arc_length`` along the bob where the offset of the cord's end is "
        "1, shape (k,).",
        lambda m: _bob_slope(m),
    )
    conical_height_low: Field[Floats | None] = Field(
        "Second double of each height with ``precision='double-double'``, to be added to `conical_height`; `error_bound` then "
        "bounds the error of the sum. Else None.",
        otherwise=lambda m: None,
    )
    _rest: Field[Floats | None] = Field(
        "What a double leaves out of each height.",
        lambda m: rest(m.conical_height, m.conical_height_low),
        axes=(),
        column="conical_height_low",
        unit="m",
    )
    certificate: Field[Certificate | None] = Field(
        "The proof of the error bounds with ``certify=True``, else None.",
        lambda m: _certificate(m),
        part=True,
        joined=True,
    )
    method: Field[str] = Field("The method that found the heights.", fact=True)
    status: Field[str] = Field("``'success'`` or ``'tolerance_not_met'``.", fact=True)
    precision: Field[str] = Field("Arithmetic of the result, see `revchain.modes`.", lambda m: "double", part=True, fact=True)
    rtol: Field[float | None] = Field("Requested relative tolerance; None for full accuracy.")
    complete: Field[bool] = Field(
        "Whether these modes, and for a rig the other solutions, are known to be all that were asked for; false if `rtol` "
        "was not met.",
        otherwise=lambda m: m.status == "success",
        fact=True,
    )
    available: Field[tuple[int | None, int]] = Field(
        "Number of existing modes, forward and backward; None for the infinitely many of a cord. With dashpots all are "
        "counted in the first.",
        otherwise=lambda m: (m.system.mode_count, 0),
    )
    has_momentum: Field[bool] = Field(
        "Whether a flywheel has momentum at rest, so that the two directions differ.",
        otherwise=lambda m: False,
    )
    other_available: Field[int] = Field(
        "Number of solutions that are not steady motions.",
        otherwise=lambda m: 0,
    )
    other: Field[OtherModes] = Field(
        "The solutions that are not steady motions; none with dashpots. Cost: 0.6 microseconds per solution and link.",
        lambda m: _others(m),
        fact=True,
    )
    slack_link: Field[Whole] = Field(
        "Indices of the links of a rig (0 is the lowest) whose effective tension, ``tension + n * momentum / length``, vanishes "
        "between 0 and the fastest computed speed of its direction.",
        otherwise=lambda m: np.empty(0, np.int64),
        fact=True,
    )
    slack_speed: Field[Floats] = Field(
        "Speeds at which the effective tension of these links vanishes, rad/s, signed, slowest first.",
        otherwise=lambda m: np.empty(0),
        fact=True,
    )
    sensitivity: Field[Sensitivity] = Field(
        "Derivatives with respect to each datum. Not for held chains, cords with a bob, and rigs with springs at pins, "
        "dashpots or linear drag. Cost: 0.6 microseconds per link and mode.",
        lambda m: _sensitivity(m),
    )
    description: Field[str] = Field("The system in words.", lambda m: m.system.describe(), fact=True)
    summary: Field[str] = Field("What was found, in words.", lambda m: _summary(m))

    def __len__(self) -> int:
        return int((self.exponent if self._is_damped else self.conical_height).size)

    def __getitem__(self, index: int) -> Row:
        try:
            return Row(self, place_of("revchain.Modes", "index", index, len(self)))
        except ValueError as error:
            raise IndexError(str(error)) from None

    def __iter__(self) -> Iterator[Row]:
        return (Row(self, index) for index in range(len(self)))

    def with_gravity(self, gravity: float) -> Self:
        """Return the modes at another acceleration of gravity.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity, m/s^2, positive.

        Returns
        -------
        Modes
            The modes with other speeds, and the same conical heights, shapes and nodes.

        Raises
        ------
        ValueError
            If gravity is not positive and finite, or if the system is a rig, or is held by a tension in newtons.

        Examples
        --------
        >>> import revchain as rc
        >>> m = rc.modes(rc.Chain(weight=1.0, length=2.4525))
        >>> m.with_gravity(9.81).angular_speed
        array([2.])
        """
        if (fixed := self.system._fixes_gravity) is not None:
            raise ValueError(
                f"revchain.Modes.with_gravity: {fixed} has other modes at another gravity; call revchain.modes again"
            )
        speeds = ("angular_speed", "frequency", "rpm", "period", "exponent", "decay_time", "summary")
        known = {name: value for name, value in dict(self.__dict__).items() if name not in ("_core", *speeds)}
        known["gravity"] = one_positive("revchain.Modes.with_gravity", "gravity", gravity)
        return type(self)._made(self._core, **known)

    def uncertainty(
        self,
        data: Mapping[str, float | str] | None = None,
        *,
        mass: ArrayLike | None = None,
        weight: ArrayLike | None = None,
        length: ArrayLike | None = None,
        centroid: ArrayLike | None = None,
        radius_of_gyration: ArrayLike | None = None,
        length_in_proportion: ArrayLike | None = None,
        momentum: ArrayLike | None = None,
        spin: ArrayLike | None = None,
        displaced_mass: ArrayLike | None = None,
        added_mass: ArrayLike | None = None,
        stiffness: float | str | None = None,
        support_mass: float | str | None = None,
        tip_mass: float | str | None = None,
        tip_weight: float | str | None = None,
        exponent: float | str | None = None,
        tension: float | str | None = None,
        worst: bool = False,
    ) -> Uncertainty:
        """Return the standard deviations of conical heights and speeds for given standard deviations of the data.

        Parameters
        ----------
        data : dict, optional
            Standard deviations by the path of the datum, as in `tune` and `fit`:
            ``{"links[load].mass": "5 %", "support.stiffness": "1 kN/m"}``; a number, or text with a unit or in percent. The
            path ``links[k].length`` of a point mass at its lower pin or of a uniform rod is its ``length_in_proportion``.
        mass, weight, length, centroid, radius_of_gyration, length_in_proportion : array_like, optional
            Standard deviation of the quantity of the links: a number for all links, or shape (N,). Shape (N, N) is a
            covariance of the links, with variances on its diagonal. Text such as ``"5 %"`` is relative to each link's datum,
            and ``"+- 2 cm"`` or ``"38 m +- 2 cm"`` is the number after the sign. A quantity that is left out is exact.
            Deviations of different quantities are independent, and so are those of different links without a covariance.
            For a cord: one number for the mass or the length of the whole cord.
        momentum, spin : array_like, optional
            Those of the flywheels of a rig, in the same forms; `spin` if they were given by spin.
        displaced_mass, added_mass : array_like, optional
            Those of the fluid, in the same forms; weights for a rig given by weight.
        stiffness, support_mass : float or str, optional
            Standard deviation of the datum of a rig's support.
        tip_mass, tip_weight, exponent, tension : float or str, optional
            Those of a cord: of its tip, of the exponent of its density, of the tension that holds it.
        worst : bool, optional
            Whether to bound the speeds of all systems within the tolerances as well, in ``.worst``. The given numbers are
            then half-widths: each datum lies anywhere between its value minus and plus that much.

        Returns
        -------
        Uncertainty
            The standard deviations, and the part of each datum in them.

        Raises
        ------
        ValueError
            If a deviation is negative or not finite, has another shape, or a covariance is not symmetric; if the system
            has no such datum, or no `sensitivity`. With ``worst=True`` also for a covariance, the exponent of a cord, data
            that could be 0, flywheels, a fluid, inverted links, point masses on a cord or more than 100 links.

        Notes
        -----
        Standard deviations are to first order. See `Sensitivity` for the data that are constant while one changes. Cost:
        that of the sensitivities, 0.6 microseconds for each link and mode.

        The bounds of ``worst=True`` are to all orders, rounding included, and proved except for cords. They may be wider
        than the speeds reached: see `WorstCase.gap`. Cost for each mode: 10 milliseconds for ten links, 0.6 seconds for a
        hundred; more where the box must be divided. Method: Loewner bounds of the two quadratic forms, and Courant and
        Fischer's theorem at a corner of the box.

        Examples
        --------
        A thread known to 1 percent gives the conical height to 1 percent, and the speed to half a percent:

        >>> import revchain as rc
        >>> rc.modes(rc.Chain(mass=1.0, length=2.0)).uncertainty(length_in_proportion="1 %").relative
        array([0.01])
        >>> rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), support=rc.Support(stiffness=30.0))
        >>> rc.modes(rig, 1).uncertainty(stiffness="10 %").angular_speed.round(4)
        array([0.0335])

        The highest and lowest speed if the stiffness is 27 to 33 N/m:

        >>> worst = rc.modes(rig, 1).uncertainty(stiffness="10 %", worst=True).worst
        >>> worst.lowest_angular_speed.round(4), worst.highest_angular_speed.round(4)
        (array([2.6821]), array([2.7496]))

        Deviations given by path:

        >>> crane = rc.Chain(mass=[2500, 400], length=[6, 24], names=["load", "hook block"])
        >>> rc.modes(crane).uncertainty({"links[load].mass": "5 %", "links[hook block].length": "0.5 m"}).largest
        ('links[hook block].length', 'links[load].mass')
        """
        from .sensitivity import uncertainty_of_modes

        _refuse_pins(self, "uncertainty")
        with_worst = boolean("revchain.Modes.uncertainty", "worst", worst)
        given = {name: value for name, value in locals().items() if name in _DEVIATIONS and value is not None}
        found: Uncertainty = uncertainty_of_modes(self, given, {} if data is None else data, with_worst)
        unit = None if self._speed_unit == "s" else self._speed_unit  # deviations of periods are there, and are no periods
        if found.worst is not None:
            asked_in(unit, found.worst)
        return asked_in(unit, found)

    def along(self, arc_length: ArrayLike) -> Floats:
        """Return the offsets of all modes of a cord at places of the cord.

        Parameters
        ----------
        arc_length : array_like
            Distances from the free or lower end, m, 0 to the length, one number or one axis.

        Returns
        -------
        ndarray, shape (k,) or (k, places)
            Offsets divided by that of the free end; for a cord held at both ends, by the largest. Accuracy, relative to the
            largest offset of each mode: 1e-15 times the mode number, twice that with a tip; for a density s^p 1e-15 times
            ``1 + 2 sqrt((p + 1) length / conical_height)``; 1e-14 by power series, 1e-11 with masses or a bob. Cost: 0.2 to
            10 microseconds for each mode and place.

        Raises
        ------
        ValueError
            If a number lies outside the cord.
        AttributeError
            If the system is not a cord.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Cord(1.0), 2).along(0.5).round(6)
        array([ 0.397714, -0.401734])
        """
        return self._places("along", "offset", arc_length)

    def slope(self, arc_length: ArrayLike) -> Floats:
        """Return the slopes ``d offset / d arc_length`` of all modes of a cord at places of the cord.

        Parameters
        ----------
        arc_length : array_like
            Distances from the free or lower end, as in `along`.

        Returns
        -------
        ndarray, shape (k,) or (k, places)
            Slopes in 1/m of the offsets that `along` returns; ``-1 / conical_height`` at a free end without a bob. Accuracy
            (relative to the largest slope) and cost are those of `along`.

        Raises
        ------
        ValueError
            If a number lies outside the cord.
        AttributeError
            If the system is not a cord.

        Notes
        -----
        A whirling cord of weight `W` and length `L` whose free end has the offset `b` has the kinetic energy
        ``W * L * (b * slope(L))**2 / 2`` to second order in `b`, and as much potential energy, if its density is a power
        and it has neither tip nor point masses.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Cord(1.0), 1).slope([0.0, 0.5, 1.0]).round(4)
        array([[-1.4458, -0.9825, -0.6242]])
        """
        return self._places("slope", "slope", arc_length)

    def _places(self, method: str, name: str, arc_length: ArrayLike) -> Floats:
        cord, caller = self._require_cord(method), f"revchain.Modes.{method}"
        arc = floats(caller, "arc_length", arc_length)
        if arc.ndim > 1:
            raise ValueError(f"{caller}: arc_length must be a number or have one axis, got shape {arc.shape}")
        refuse_where(~((arc >= 0) & (arc <= cord.length)), arc, f"{caller}: arc_length must lie between 0 and the length")
        found: Floats = getattr(self._found(), name)(np.atleast_1d(arc))
        return found.reshape((len(self), *arc.shape))

    def _require_cord(self, name: str) -> Any:
        if not self.system._kind.endswith("cord"):
            raise UnavailableError(f"revchain.Modes.{name}: is for a Cord; the pins of links have `shape` and `nodes`")
        return self.system

    def _from_parts(self) -> Any:
        if "_make" in self.__dict__:
            return self.__dict__["_make"]()
        if self.system._kind.endswith("cord"):
            first = int(self.number[0]) if len(self) else 1
            return _core.CordModes(self.system._under(self.gravity), first, self.conical_height)
        if self._is_damped:  # all is stored
            return None
        return super()._from_parts()

    def _state(self) -> dict[str, Any]:
        if self._is_damped:
            return {**super()._state(), "_unused": self._unused, "_is_damped": True}
        if not self.system._kind.endswith("cord"):
            _ = self.nodes  # of a cord they follow from its heights, as shapes do
        return super()._state()

    def _left_out(self) -> Collection[str]:
        if self._is_damped:
            return self._unused
        slow = "nodes" not in self.__dict__ and self.system.size * self.conical_height.size > MOST_OFFSETS
        return (*self._unused, "nodes") if slow else self._unused

    @property
    def _beyond_window(self) -> bool:
        """Whether the system has modes, and the window that was asked for has none."""
        return not len(self) and any(each is None or each > 0 for each in self.available)

    @property
    def _remarks(self) -> str:
        of_what = "exponent" if self._is_damped else "conical height"
        lines = [f"gravity {self.gravity:.6g} m/s^2; error bound: relative, of the {of_what}"]
        if self.system._kind != "rig":
            return lines[0]
        if self._is_damped and not self.angular_speed.all():
            grows = bool((self.exponent.real > 0).any())
            lines.append(f"speed 0: the motion only decays{', or grows where the decay time is negative' if grows else ''}")
        if self._is_damped:
            lines.append("modes are numbered by the size of their exponents, smallest first")
        if self.rigid:
            lines.append("the trolley rolls freely: the system also moves as a whole, at speed 0, which is no mode of the list")
        if self.has_momentum:
            lines.append("negative speeds: backward, against wheels whose momentum is positive")
        links = self.system._link_numbers[self.slack_link] if len(self.slack_link) else ()
        unit = self._speed_unit or "rad/s"
        at = in_unit(self.slack_speed, unit)
        of = "a period of " if unit == "s" else ""
        slack = [f"links[{k}] goes slack at {of}{each:.6g} {unit}" for k, each in zip(links, at, strict=True)]
        lines += slack if len(slack) <= 5 else [*slack[:4], f"{len(slack) - 4} more go slack: slack_link, slack_speed"]
        if others := self.other_available:
            lines.append(f"{others:,} solution{' is not a steady motion' if others == 1 else 's are not steady motions'}: other")
        return "\n".join(lines)


_DEVIATIONS = frozenset(Modes.uncertainty.__kwdefaults__ or ()) - {"worst"}


def _summary(modes: Modes) -> str:
    """The number of modes out of all, or their numbers; the system, method and status."""
    forward, backward = modes.available
    count = None if forward is None else forward + backward
    total = "infinitely many" if count is None else f"{count:,}"
    size = modes.number.size
    if size == 0 or modes.number[0] == 1 or modes.system._kind == "rig":
        which = f"{size:,} of {total} mode{'s' * (count != 1)}"
    elif size == 1:
        which = f"mode {modes.number[0]:,} of {total}"
    else:
        which = f"modes {modes.number[0]:,} to {modes.number[-1]:,} of {total}"
    system = repr(modes.system)
    return f"{which} of a {system[0].lower()}{system[1:]}: by {modes.method}, {modes.status.replace('_', ' ')}"


def _texts(nodes: Iterable[Numbers]) -> list[str]:
    """The number of nodes of each mode as text, with the first and the last."""
    found = []
    for places in nodes:
        shown = [f"{caller:.3g}" if caller < 1000 else f"{caller:.0f}" for caller in places[[0, -1]]] if places.size else []
        if places.size <= 1:
            found.append(": ".join([str(places.size), *shown[:1]]))
        else:
            found.append(f"{places.size}: {shown[0]} {'… ' if places.size > 2 else ''}{shown[1]}")
    return found


def _ratios(modes: Modes) -> list[str]:
    """Damping ratios; ``1 - x`` for a motion that oscillates although its ratio would be printed as 1."""
    found = []
    for ratio, s in zip(modes.damping_ratio.tolist(), modes.exponent.tolist(), strict=True):
        text = f"{ratio:#.6g}"
        if s.imag and abs(float(text)) == 1:
            apart = (s.imag / abs(s)) ** 2 / (1 + abs(ratio))  # 1 - ratio without cancellation
            text = f"1 - {apart:.1e}" if ratio > 0 else f"-1 + {apart:.1e}"
        found.append(text)
    return found


def _speed_bound(error: Floats) -> Floats:
    """Bound for the speed of a height with this error: ``(1 - error)**-0.5 - 1`` plus rounding; infinite from 1 on."""
    with np.errstate(divide="ignore", invalid="ignore"):
        bound = np.expm1(-0.5 * np.log1p(-np.minimum(error, 1.0)))
    return np.asarray(bound * (1 + 1e-9) + SPEED_ROUNDING)


def speed_bound_of_exponents(exponent: Complex, error: Floats, turns: bool) -> Floats:
    """Bound of the relative error of the imaginary parts of exponents whose relative error is at most `error`.

    An exponent on the real axis that is proved apart from all others is exactly real, because its conjugate is an exponent
    too; not with wheels (`turns`), where it is none.
    """
    speed = np.abs(exponent.imag)
    with np.errstate(divide="ignore", invalid="ignore"):
        off = error * np.abs(exponent) / (1 - error) * (1 + 4e-15)  # whichever exponent, computed or exact, error relates to
        bound = np.where((error < 1) & (off < speed), off / (speed - off) * (1 + 1e-15), np.inf)
    return np.where((speed == 0) & np.isfinite(error) & (not turns), 0.0, bound)


def rest(values: Numbers, second: Floats | None) -> Floats | None:
    """The second doubles if given; else what doubles leave of longdouble numbers."""
    if second is not None or values.dtype != np.longdouble:
        return second
    with np.errstate(invalid="ignore"):
        left: Floats = np.nan_to_num(values - values.astype(np.float64)).astype(np.float64)
    return left


def _over(number: Any, values: Any) -> Any:
    """The quotient; infinite where the value is 0, of either sign."""
    with np.errstate(divide="ignore"):
        return np.where(values == 0, np.inf, number / values)


def _certificate(modes: Modes) -> Certificate | None:
    found = getattr(modes._found(), "certificate", None)
    if found is None:
        return None
    names = ("lower", "upper", "above_lower", "above_upper", "lower_low", "upper_low")
    return Certificate._made(None, number=modes.number, **dict(zip(names, found, strict=True)))


def _others(modes: Modes) -> OtherModes:
    names = ("conical_height", "angular_speed", "growth_rate", "error_bound")
    if modes.system._kind != "rig" or modes._is_damped:
        none = np.empty(0)
        return OtherModes._made(None, **dict(zip(names, (none + 0j, none + 0j, none, none), strict=True)))
    known = modes._core if isinstance(modes._core, _core.RigModes) else None
    found = _core.other_rig_modes(modes.system._under(modes.gravity), modes.gravity, known)
    return OtherModes._made(None, **dict(zip(names, found, strict=True)))


def _refuse_pins(modes: Modes, name: str) -> None:
    if modes.system._kind == "rig" and modes.system._has_pins:
        raise UnavailableError(
            f"revchain.Modes.{name}: cannot be found for a rig with springs at pins, dashpots or linear drag; "
            "call revchain.modes with another datum"
        )


def _sensitivity(modes: Modes) -> Sensitivity:
    from .sensitivity import sensitivity_of_modes

    _refuse_pins(modes, "sensitivity")
    found: Sensitivity = sensitivity_of_modes(modes)
    return found
