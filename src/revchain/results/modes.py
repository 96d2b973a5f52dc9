# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of `revchain.modes`."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Self, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..systems.chain import Chain
from ..systems.held import Held
from ..systems.numbers import Floats, Numbers, Whole, floats, one_positive, refuse_beyond_memory, refuse_where
from ..systems.rig import Rig
from .base import Field, Result, UnavailableError
from .moving import Moving
from .sheet import Column, Sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from .motions import Response
    from .cord_sensitivity import CordSensitivity, CordUncertainty
    from .sensitivity import RigSensitivity, RigUncertainty, Sensitivity, Uncertainty

Complex = NDArray[np.complex128]
TURN = 8 * np.arctan(np.longdouble(1))
MOST_OFFSETS = 100_000  # largest number of offsets to compute for the nodes of a table
TURN64 = 2 * np.pi
SPEED_ROUNDING = 2.1 * 2.0**-52  # rounding of a speed computed from a height


class Certificate(Result, row="mode", title="Certificate: intervals proved to hold the conical heights"):
    """Intervals that are proved to contain the conical heights, and the counts that prove it.

    Exactly ``above_lower[i]`` conical heights of the chain exceed ``lower[i]``, and ``above_upper[i]`` exceed
    ``upper[i]``. Because ``above_upper[i] < number[i] <= above_lower[i]``, the height with that number lies in the
    interval: ``lower < height <= upper``.

    Notes
    -----
    For results in double precision `revchain.count_modes` returns the same counts at these numbers. The heights are those
    of the stored data.

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
        "What a double leaves out of each lower end: with ``precision='double-double'`` its second double, with "
        "``'extended'`` the rest; else None.",
        lambda c: rest(c.lower),
        part=True,
        axes=(),
        unit="m",
    )
    upper_low: Field[Floats | None] = Field(
        "What a double leaves out of each upper end, see `lower_low`.", lambda c: rest(c.upper), part=True, axes=(), unit="m"
    )


def _speeds(compiled: Callable[[Floats, Floats], Floats], extended: Callable[[Any], Any]) -> Callable[[Modes], Numbers]:
    """A function of each mode: `compiled` computes it from height and gravity, `extended` from a longdouble speed."""

    def compute(modes: Modes) -> Numbers:
        if modes.precision == "extended":
            with np.errstate(invalid="ignore", divide="ignore"):
                found: Numbers = extended(np.sqrt(np.longdouble(modes.gravity)) / np.sqrt(modes.conical_height))
            return found
        height = modes.conical_height
        good = height > 0  # the dense references may return others by rounding
        numbers = compiled(np.where(good, height, 1.0), np.asarray(modes.gravity))
        return numbers if good.all() else np.where(good, numbers, np.nan)

    return compute


class Modes(Result, Moving):
    """The modes of a system, slowest first: speeds, shapes, nodes and error bounds of k modes of N links.

    Heights and bounds are computed at once. Shapes, nodes, residuals and sensitivities are computed when they are first
    read, then kept. Arrays are read-only. A window may contain no modes (k = 0).

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
    >>> [nodes.round(4).tolist() for nodes in m.nodes]
    [[], [0.2929]]
    """

    __slots__ = ()
    system: Field[Any] = Field("The system.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.")
    number: Field[Whole] = Field("Mode numbers, shape (k,): the slowest of all modes has number 1.")
    angular_speed: Field[Numbers] = Field(
        "Whirl speed of each mode, ``sqrt(gravity / conical_height)``, rad/s, shape (k,). For a hanging chain it is also the "
        "natural angular frequency of its swing in a plane. longdouble with ``precision='extended'``, else float64.",
        _speeds(_core.conical_pendulum_angular_speed, lambda speed: speed),
    )
    frequency: Field[Numbers] = Field(
        "Revolutions per second, Hz, shape (k,).",
        _speeds(_core.conical_pendulum_revolutions_per_second, lambda speed: speed / TURN),
    )
    rpm: Field[Numbers] = Field("Revolutions per minute, shape (k,).", lambda m: 60 * m.frequency)
    period: Field[Numbers] = Field(
        "Time of one revolution, s, shape (k,).",
        _speeds(_core.conical_pendulum_period, lambda speed: TURN / speed),
    )
    speed_error_bound: Field[Floats] = Field(
        "Bound of the relative error of each angular speed, frequency and period, shape (k,), for the given gravity.",
        lambda m: _speed_bound(m.error_bound.astype(np.float64)),
    )
    conical_height: Field[Numbers] = Field(
        "Conical height ``gravity / angular_speed**2`` of each mode, m, shape (k,), descending.",
    )
    error_bound: Field[Numbers] = Field(
        "Bound of the relative error of each conical height, shape (k,), for the data exactly as stored. It is proved; for "
        "cords it is checked by measurement.",
    )
    conical_height_low: Field[Floats | None] = Field(
        "Second double of each height with ``precision='double-double'``, to be added to `conical_height`; `error_bound` then "
        "bounds the error of the sum. Else None.",
    )
    shape: Field[Numbers] = Field(
        "Offsets of the pins from the axis, shape (k, N + 1), free end first, support last. The largest magnitude of "
        "each mode is 1, and the free end is positive.",
        part=False,
    )
    residual: Field[Numbers] = Field(
        "Residual of each shape, shape (k,): largest unbalanced force at a pin divided by the largest sum of the "
        "magnitudes of the forces at a pin.",
        part=False,
    )
    nodes: Field[tuple[Numbers, ...]] = Field(
        "For each mode, the distances from the free end along the chain at which it crosses the axis, excluding the "
        "support.",
        part=False,
    )
    certificate: Field[Certificate | None] = Field(
        "The proof of the error bounds with ``certify=True``, else None.",
        lambda m: _certificate(m.number, m._found().certificate),
        part=True,
    )
    method: Field[str] = Field("The method that found the heights.")
    status: Field[str] = Field("``'success'`` or ``'tolerance_not_met'``.")
    precision: Field[str] = Field("Arithmetic of the result, see `revchain.modes`.")
    rtol: Field[float | None] = Field("Requested relative tolerance; None for full accuracy.")
    sensitivity: Field[Sensitivity | RigSensitivity] = Field(
        "Derivatives with respect to each datum of each link. Cost: 2 microseconds per link and mode.",
        lambda m: _sensitivity(m),
    )

    def __len__(self) -> int:
        return int(self.conical_height.size)

    def at(self, gravity: float) -> Self:
        """Return the modes at another acceleration of gravity.

        Parameters
        ----------
        gravity : float
            Acceleration of gravity, m/s^2, positive.

        Returns
        -------
        Modes
            The modes with other speeds. Conical heights, shapes and nodes of chains and cords do not depend on gravity.

        Raises
        ------
        ValueError
            If gravity is not positive and finite; if the system is a rig, or is held by a tension and given by mass or
            weightless, because springs, flywheels and tensions in newtons do not scale with gravity.

        Examples
        --------
        >>> import revchain as rc
        >>> m = rc.modes(rc.Chain(weight=1.0, length=2.4525))
        >>> m.at(gravity=9.81).angular_speed
        array([2.])
        """
        held = isinstance(self.system, Held) and (self.system.by_mass or self.system.weightless)
        if isinstance(self.system, Rig) or held:
            what = "a system held by a tension in newtons" if held else "a rig"
            raise ValueError(
                f"revchain.{type(self).__name__}.at: {what} has other modes at another gravity; call revchain.modes again"
            )
        speeds = ("angular_speed", "frequency", "rpm", "period")
        kept = {name: value for name, value in dict(self.__dict__).items() if name not in speeds}
        kept["gravity"] = one_positive("revchain.Modes.at", "gravity", gravity)
        return type(self)._made(self._core, **kept)

    def uncertainty(
        self,
        *,
        mass: ArrayLike | None = None,
        weight: ArrayLike | None = None,
        length: ArrayLike | None = None,
        centroid: ArrayLike | None = None,
        radius_of_gyration: ArrayLike | None = None,
        length_in_proportion: ArrayLike | None = None,
    ) -> Uncertainty:
        """Return the standard deviations of conical heights and speeds for given standard deviations of the data.

        Parameters
        ----------
        mass, weight, length, centroid, radius_of_gyration, length_in_proportion : array_like, optional
            Standard deviation of the quantity: a number for all links, or shape (N,). Shape (N, N) is a covariance of the
            links, with variances on its diagonal. Text such as ``"5 %"`` is relative to each link's datum; ``["5 %", 0]`` is
            for the lowest of two links only. A quantity that is left out is exact. Deviations of different quantities are
            independent, and so are those of different links without a covariance. See `Sensitivity` for the data that are
            constant while one changes.

        Returns
        -------
        Uncertainty
            The standard deviations, and the part of each datum in them.

        Raises
        ------
        ValueError
            If a deviation is negative or not finite, has another shape, or a covariance is not symmetric; if the chain is
            held at both ends.

        Notes
        -----
        The result is to first order: heights are linear in the data. If a derivative is nearly 0, or a deviation is large
        compared with its datum, sample instead. Cost: that of the sensitivities, 2 microseconds for each link and mode.

        Examples
        --------
        A thread known to 1 percent gives the conical height to 1 percent, and the speed to half a percent:

        >>> import revchain as rc
        >>> rc.modes(rc.Chain(mass=1.0, length=2.0)).uncertainty(length_in_proportion="1 %").relative
        array([0.01])
        """
        from .sensitivity import uncertainty

        if not isinstance(self.system, Chain):
            raise ValueError(
                "revchain.Modes.uncertainty: is for a Chain, a Rig or a Cord, got a chain held at both ends; change the "
                "datum and call modes again"
            )
        given = {
            "mass": mass,
            "weight": weight,
            "length": length,
            "centroid": centroid,
            "radius_of_gyration": radius_of_gyration,
            "length_in_proportion": length_in_proportion,
        }
        return uncertainty(self, given)

    def plot(
        self, ax: Axes | None = None, modes: Iterable[int] | None = None, *, carried: Response | None = None
    ) -> Axes:
        """Draw the system at rest and, beside it, the mode shapes, each along its own axis; rings mark the nodes.

        Forward modes of a rig with flywheels are blue, backward ones red; inverted links are thick.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.
        modes : iterable of int, optional
            Numbers of the modes to draw (for a rig, of both directions); the six slowest of this result if left out.
        carried : Response, optional
            Response of the same system at one speed with all pins, drawn first, with its support on its circle.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing.

        Raises
        ------
        ValueError
            If `modes` has a number that is not in this result, the result is empty, or `carried` is not such a response.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.modes(rc.Chain.uniform_rods(120, length=0.36), 4).plot()
        >>> ax.get_ylabel()
        'depth below the support (m)'
        """
        from ..plots.modes import plot_modes

        return plot_modes(self, ax, modes, carried)

    def _from_parts(self) -> Any:
        if not len(self):
            none = np.empty((0, self.system.size + 1), self.conical_height.dtype)
            return SimpleNamespace(shape=none, residual=none[:, 0], nodes=())
        first, certified = int(self.number[0]), self.certificate is not None
        if isinstance(self.system, Held):
            held = cast("_core.Held", self.system._under(self.gravity))
            return _core.held_modes(held, first, len(self), None, None, self.rtol, certified, None, self.gravity)
        method = self.method if self.method in _core.METHODS else "auto"
        return _core.modes(
            self.system._compiled, first, len(self), None, None, self.rtol, certified, self.precision, method
        )

    def _which(self) -> str:
        """Text with the number of modes out of all, or with their numbers if they are not the slowest."""
        count = getattr(self.system, "mode_count", None)
        total = "infinitely many" if count is None else f"{count:,}"
        if len(self) == 0 or self.number[0] == 1:
            return f"{len(self):,} of {total} mode{'s' * (count != 1)}"
        if len(self) == 1:
            return f"mode {self.number[0]:,} of {total}"
        return f"modes {self.number[0]:,} to {self.number[-1]:,} of {total}"

    def _speed_columns(self) -> list[Column]:
        return [
            Column("angular_speed", self.angular_speed, "speed (rad/s)"),
            Column("frequency", self.frequency),
            Column("rpm", self.rpm, "speed (rpm)"),
            Column("period", self.period, "period (s)"),
            Column("speed_error_bound", self.speed_error_bound),
            Column("conical_height", self.conical_height, "height (m)", 9),
            Column("error_bound", self.error_bound, "error bound"),
        ]

    def _shape_columns(self, brief: bool) -> list[Column]:
        """Columns of the shapes; with `brief`, nodes only if they are known or cheap."""
        if brief and "nodes" not in self.__dict__ and self.system.size * len(self) > MOST_OFFSETS:
            return []
        nodes = self._node_column()
        return [nodes] if brief else [nodes, Column("residual", self.residual), Column("shape", self.shape, axes=("pin",))]

    def _node_column(self) -> Column:
        end = "lower" if isinstance(self.system, Held) else "free"
        return Column("nodes", self.nodes, f"nodes (m from the {end} end)", axes=("node",), shown=_texts(self.nodes))

    def _heading(self, which: str) -> str:
        system = repr(self.system)
        return f"{which} of a {system[0].lower()}{system[1:]}: by {self.method}, {self.status.replace('_', ' ')}"

    def _note(self) -> str:
        return f"gravity {self.gravity:.6g} m/s^2; error bound: relative, of the conical height"

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [Column("mode", self.number, "mode"), *self._speed_columns(), *self._shape_columns(brief)]
        low = rest(self.conical_height) if self.conical_height_low is None else self.conical_height_low
        columns += [] if low is None else [Column("conical_height_low", low)]
        if self.certificate is not None:
            for column in self.certificate._sheet().columns[1:]:
                columns.append(Column(f"certificate_{column.name}", column.values))
        return Sheet(
            "mode",
            self._heading(self._which()),
            columns,
            {name: getattr(self, name) for name in ("gravity", "method", "status", "precision")} | _facts(self.system),
            [self._note()],
            self.status == "success",
        )


class OtherModes(Result):
    """The m solutions of a rig that are not steady motions: negative or complex conical heights, or complex speeds.

    An infinite height (speed 0) belongs to a link without net weight in the fluid, which is at rest in any position.

    Examples
    --------
    >>> import revchain as rc
    >>> stick = rc.Rig(rc.Chain(mass=1.0, length=1.0), inverted=True)
    >>> rc.modes(stick).other.growth_rate.round(4)
    array([3.1316])
    """

    __slots__ = ()
    conical_height: Field[Complex] = Field("Conical heights, m, shape (m,).")
    angular_speed: Field[Complex] = Field(
        "Speeds ``n`` with ``n**2 * conical_height = gravity``, rad/s, shape (m,). Offsets vary as ``exp(1j * n * t)``.",
    )
    growth_rate: Field[Floats] = Field(
        "Size of the imaginary part of each speed, 1/s. Small offsets grow as ``exp(growth_rate * t)``."
    )
    error_bound: Field[Floats] = Field("Proved bound of the error of each height, relative to its size.")

    def __len__(self) -> int:
        return int(self.conical_height.size)

    def _sheet(self, brief: bool = False) -> Sheet:
        shown = [f"{h.real:.9g}" if h.imag == 0 else f"{h.real:.6g} {h.imag:+.6g}i" for h in self.conical_height]
        columns = [
            Column("number", np.arange(1, len(self) + 1), ""),
            Column("conical_height", self.conical_height, "height (m)", shown=shown),
            Column("angular_speed", self.angular_speed),
            Column("growth_rate", self.growth_rate, "growth rate (1/s)"),
            Column("error_bound", self.error_bound, "error bound"),
        ]
        what = "1 solution that is not a steady motion" if len(self) == 1 else f"{len(self)} solutions that are not steady motions"
        return Sheet("number", what, columns)


class RigModes(Modes):
    """The modes of a rig, slowest first, of both directions of rotation.

    Examples
    --------
    A gyrostat on a link, ``A n^2 - H n - W h = 0``:

    >>> import revchain as rc
    >>> top = rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=1.5))
    >>> rc.modes(top).angular_speed.round(4)
    array([-2.4701,  3.9701])
    """

    __slots__ = ()
    number: Field[Whole] = Field("Number of each mode among those of its direction, shape (k,), from 1.")
    direction: Field[Whole] = Field(
        "Direction of each mode, shape (k,): 1 forward, -1 backward. Without momentum the directions do not differ, "
        "and all are 1.",
    )
    angular_speed: Field[Numbers] = Field(
        "Whirl speed of each mode, rad/s, shape (k,), negative for backward modes."
    )
    frequency: Field[Numbers] = Field("Revolutions per second, Hz, shape (k,), signed.", lambda m: m.angular_speed / TURN64)
    period: Field[Numbers] = Field("Time of one revolution, s, shape (k,).", lambda m: TURN64 / np.abs(m.angular_speed))
    speed_error_bound: Field[Floats] = Field("Proved bound of the relative error of each speed, shape (k,).")
    conical_height_low: Field[Floats | None] = Field("Always None: heights are doubles.", lambda m: None)
    certificate: Field[Certificate | None] = Field(
        "The proof of the error bounds with ``certify=True``, else None. Its counts are for the direction of each "
        "mode.",
        lambda m: _certificate(m.number, m._found().certificate),
        part=True,
    )
    precision: Field[str] = Field("Always ``'double'``.", lambda m: "double")
    rtol: Field[float | None] = Field(
        "Requested relative tolerance; None if left out. Rigs have full accuracy."
    )
    available: Field[tuple[int, int]] = Field("Number of existing modes, forward and backward.")
    has_momentum: Field[bool] = Field(
        "Whether a flywheel has constant momentum, so that the two directions differ."
    )
    other_available: Field[int] = Field("Number of solutions that are not steady motions, found by counting.")
    other: Field[OtherModes] = Field(
        "The solutions that are not steady motions, computed when first read. Cost: 1 microsecond per solution and "
        "link.",
        lambda m: m._others(),
    )
    slack_link: Field[Whole] = Field(
        "Indices of links (0 is the lowest) whose effective tension, ``tension + n * momentum / length``, vanishes between 0 "
        "and the fastest computed speed of its direction.",
    )
    slack_speed: Field[Floats] = Field(
        "Speeds at which the effective tension of these links vanishes, rad/s, signed, slowest first."
    )
    complete: Field[bool] = Field(
        "Whether the modes and the other solutions are proved to be all solutions."
    )

    def uncertainty(
        self,
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
        stiffness: float | None = None,
        support_mass: float | None = None,
    ) -> RigUncertainty:
        """Return the standard deviations of conical heights and speeds for given standard deviations of the data.

        Parameters
        ----------
        mass, weight, length, centroid, radius_of_gyration, length_in_proportion : array_like, optional
            Standard deviations or a covariance of the links, as in `Modes.uncertainty`.
        momentum, spin : array_like, optional
            Those of the flywheels, in the same forms. Give only one: `spin` if the flywheels were given by spin.
        displaced_mass, added_mass : array_like, optional
            Those of the fluid, in the same forms; weights for a rig given by weight.
        stiffness, support_mass : float, optional
            Standard deviation of the datum of the support, or text such as ``"5 %"``.

        Returns
        -------
        RigUncertainty
            The standard deviations, and the part of each datum in them.

        Raises
        ------
        ValueError
            If a deviation is negative or not finite, has another shape, or a covariance is not symmetric; if `spin` is
            given for flywheels that were given by momentum.

        Notes
        -----
        The result is to first order. See `RigSensitivity` for the data that are constant while one changes. The radius of
        a support has no effect on the speeds of small oscillations.

        Examples
        --------
        >>> import revchain as rc
        >>> rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), support=rc.Support(stiffness=30.0))
        >>> rc.modes(rig, 1).uncertainty(stiffness="10 %").angular_speed.round(4)
        array([0.0335])
        """
        from .sensitivity import rig_uncertainty

        given = {
            "mass": mass,
            "weight": weight,
            "length": length,
            "centroid": centroid,
            "radius_of_gyration": radius_of_gyration,
            "length_in_proportion": length_in_proportion,
            "momentum": momentum,
            "spin": spin,
            "displaced_mass": displaced_mass,
            "added_mass": added_mass,
            "stiffness": stiffness,
            "support_mass": support_mass,
        }
        return rig_uncertainty(self, given)

    def _from_parts(self) -> Any:
        if not len(self):
            return super()._from_parts()
        first, last = int(self.number.min()), int(self.number.max())
        each = [self.number[self.direction == way] for way in (1, -1)]
        kept = [int(n) for numbers in each for n in (numbers.min(initial=last + 1), numbers.size)]
        rig, certified = self.system._under(self.gravity), self.certificate is not None
        return _core.rig_modes(
            rig, first, last - first + 1, None, None, self.rtol, certified, self.gravity, kept=(kept[0], kept[1], kept[2], kept[3])
        )

    def _others(self) -> OtherModes:
        known = self._core if isinstance(self._core, _core.RigModes) else None
        names = ("conical_height", "angular_speed", "growth_rate", "error_bound")
        found = _core.other_rig_modes(self.system._under(self.gravity), self.gravity, known)
        return OtherModes._made(None, **dict(zip(names, found, strict=True)))

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("mode", self.number, "mode"),
            Column("direction", self.direction),
            *self._speed_columns(),
            *self._shape_columns(brief),
        ]
        notes = [self._note()]
        if self.has_momentum:
            notes.append("negative speeds: backward, against wheels whose momentum is positive")
        slack = [f"links[{k}] goes slack at {at:.6g} rad/s" for k, at in zip(self.slack_link, self.slack_speed, strict=True)]
        notes += slack if len(slack) <= 5 else [*slack[:4], f"{len(slack) - 4} more go slack: slack_link, slack_speed"]
        others = self.other_available
        if others:
            notes.append(f"{others:,} solution{' is not a steady motion' if others == 1 else 's are not steady motions'}: other")
        if self.certificate is not None:
            for column in self.certificate._sheet().columns[1:]:
                columns.append(Column(f"certificate_{column.name}", column.values))
        total = sum(self.available)
        return Sheet(
            "mode",
            self._heading(f"{len(self):,} of {total:,} mode{'s' * (total != 1)}"),
            columns,
            {
                **{name: getattr(self, name) for name in ("gravity", "method", "status", "complete")},
                "other": [] if brief else self.other.to_dict()["numbers"],
                "slack": [
                    {"link": int(link), "angular_speed": float(at)}
                    for link, at in zip(self.slack_link, self.slack_speed, strict=True)
                ],
                **_facts(self.system),
            },
            notes,
            self.status == "success",
        )


class CordModes(Modes):
    """The k modes of a cord, slowest first, with shapes at any point.

    For a cord held straight at both ends, distances start at its lower end.

    Notes
    -----
    Heights are zeros of Bessel functions, Greenhill (1908), section 4: of ``J0`` for a uniform cord, of ``Jp`` for a density
    s^p, of a cross product of ``J`` and ``Y`` for a uniform cord with a tip or held at both ends. All others are computed by
    power series. Accuracy (``error_bound``): 3 ulp, 2 ulp with a tip, 4e-15 by power series. Nodes and vertical points: 5
    ulp (uniform), 3 ulp (a power), else 1e-15 of the length. Cost: 0.01 to 15 microseconds for a height in closed form, 1
    millisecond for each mode up to the last by power series; that of its height for a node; that of ten slopes for a
    vertical point with a tip or by power series. Heights are proportional to the length.

    Examples
    --------
    >>> import revchain as rc
    >>> m = rc.modes(rc.Cord(0.36), 3)
    >>> m.angular_speed.round(4)
    array([ 6.2757, 14.4054, 22.583 ])
    >>> m.offset([0.0, 0.18])[1].round(4)
    array([ 1.    , -0.4017])
    >>> m.nodes[2].round(4), m.vertical_points[2].round(4)
    (array([0.0278, 0.1465]), array([0.0706, 0.2366]))
    """

    __slots__ = ()
    number: Field[Whole] = Field(
        "Mode numbers, shape (k,): the slowest of all modes has number 1.",
        lambda m: np.arange(m._found().first, m._found().first + len(m._found().conical_height)),
        part=True,
    )
    arc_length: Field[Floats] = Field(
        "Distances from the free end of the places of `shape`, m, shape (201,), evenly spaced.",
        lambda m: np.linspace(0.0, m.system.length, 201),
    )
    shape: Field[Numbers] = Field(
        "Offsets of the places `arc_length` from the axis, shape (k, 201); that of the free end is 1. For a cord held at both "
        "ends the largest, at the lowest vertical point, is 1.",
        lambda m: m.offset(m.arc_length),
    )
    vertical_points: Field[tuple[Numbers, ...]] = Field(
        "For each mode the distances from the free end at which the cord is vertical, one above each node: the part below "
        "has its centre of gravity on the axis, section 4 (13), (14) of the paper. For a cord held at both ends: one below "
        "each node, and one below the upper end.",
        lambda m: m._points("vertical_points"),
    )
    nodes: Field[tuple[Numbers, ...]] = Field(
        "For each mode the distances from the free end at which it crosses the axis, without the held ends.",
        lambda m: m._points("nodes"),
    )
    residual: Field[Any] = Field("Always None: shapes are closed forms or power series.", lambda m: None)
    conical_height_low: Field[Floats | None] = Field("Always None: heights are doubles.", lambda m: None)
    certificate: Field[Certificate | None] = Field("Always None: only chains and rigs have one.", lambda m: None)
    precision: Field[str] = Field("Always ``'double'``.", lambda m: "double")
    sensitivity: Field[CordSensitivity] = Field(  # type: ignore[assignment]
        "Derivatives with respect to length, mass, tip, exponent of the density and tension.", lambda m: _sensitivity(m)
    )

    def uncertainty(  # type: ignore[override]
        self,
        *,
        mass: float | str | None = None,
        weight: float | str | None = None,
        length: float | str | None = None,
        tip_mass: float | str | None = None,
        tip_weight: float | str | None = None,
        exponent: float | None = None,
        tension: float | str | None = None,
    ) -> CordUncertainty:
        """Return the standard deviations of conical heights and speeds for given standard deviations of the data.

        Parameters
        ----------
        mass, weight, length, tip_mass, tip_weight, tension : float or str, optional
            Standard deviation of the datum, or text such as ``"5 %"``, which is relative to the datum. A datum that is left
            out is exact. Deviations of different data are independent. See `CordSensitivity` for the data that are constant
            while one changes.
        exponent : float, optional
            Standard deviation of the exponent of the density.

        Returns
        -------
        CordUncertainty
            The standard deviations, and the part of each datum in them.

        Raises
        ------
        ValueError
            If a deviation is negative or not finite, or the cord has no such datum: a mass if given by weight, a tension if
            it hangs, a tip or an exponent if it is held, an exponent if the density is a function.

        Notes
        -----
        The result is to first order: heights are linear in the data.

        Examples
        --------
        >>> import revchain as rc
        >>> u = rc.modes(rc.Cord(2.0, mass=0.5, tip_mass=0.1), 2).uncertainty(length="1 %", tip_mass=0.02)
        >>> u.relative.round(5), u.largest
        (array([0.01867, 0.04308]), (('tip_mass', 0), ('tip_mass', 0)))
        """
        from .cord_sensitivity import cord_uncertainty

        given = {"mass": mass, "weight": weight, "length": length, "tip_mass": tip_mass, "tip_weight": tip_weight}
        return cord_uncertainty(self, given | {"exponent": exponent, "tension": tension})

    def offset(self, arc_length: ArrayLike) -> Floats:
        """Return the offsets of all modes at places of the cord.

        Parameters
        ----------
        arc_length : array_like
            Distances from the free end, m, 0 to the length, one number or one axis.

        Returns
        -------
        ndarray, shape (k,) or (k, places)
            Offsets divided by that of the free end; for a cord held at both ends, by the largest. Accuracy, relative to the
            largest offset of each mode (which exceeds 1 with a tip and for p below -1/2): 1e-15 times the mode number, twice
            that with a tip; for a density s^p 1e-15 times ``1 + 2 sqrt((p + 1) length / conical_height)``; 1e-14 by power
            series. Cost: 1 to 15 microseconds for each mode and place, 100 for a density function.

        Raises
        ------
        ValueError
            If a number lies outside the cord.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Cord(1.0), 2).offset(0.5).round(6)
        array([ 0.397714, -0.401734])
        """
        return self._along("offset", arc_length)

    def slope(self, arc_length: ArrayLike) -> Floats:
        """Return the slopes ``d offset / d arc_length`` of all modes at places of the cord.

        Parameters
        ----------
        arc_length : array_like
            Distances from the free end, as in `offset`.

        Returns
        -------
        ndarray, shape (k,) or (k, places)
            Slopes in 1/m of the offsets that `offset` returns; ``-1 / conical_height`` at a free end. Accuracy (relative to
            the largest slope) and cost are those of `offset`.

        Raises
        ------
        ValueError
            If a number lies outside the cord.

        Notes
        -----
        A whirling cord of weight `W` and length `L` whose free end has the offset `b` has the kinetic energy
        ``W * L * (b * slope(L))**2 / 2`` to second order in `b`, in joules for `W` in newtons. Its potential energy is
        equal. This holds without a tip and for a density that is a power.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Cord(1.0), 1).slope([0.0, 0.5, 1.0]).round(4)
        array([[-1.4458, -0.9825, -0.6242]])
        """
        return self._along("slope", arc_length)

    def _along(self, name: str, arc_length: ArrayLike) -> Floats:
        place = f"revchain.CordModes.{name}"
        arc = floats(place, "arc_length", arc_length)
        if arc.ndim > 1:
            raise ValueError(f"{place}: arc_length must be a number or have one axis, got shape {arc.shape}")
        wrong = ~((arc >= 0) & (arc <= self.system.length))
        refuse_where(wrong, arc, f"{place}: arc_length must lie between 0 and the length")
        found: Floats = getattr(self._found(), name)(np.atleast_1d(arc))
        return found.reshape((len(self), *arc.shape))

    def _points(self, name: str) -> Any:
        if len(self):
            refuse_beyond_memory(f"revchain.CordModes.{name}", "the number of the last mode", int(self.number[-1]), 8)
        return getattr(self._found(), name)

    def _from_parts(self) -> Any:
        if not len(self):
            none = lambda arc: np.empty((0, len(arc)))  # noqa: E731
            return SimpleNamespace(offset=none, slope=none, nodes=(), vertical_points=())
        first = int(self.number[0])
        if isinstance(self.system, Held):
            held = cast("_core.HeldCord", self.system._under(self.gravity))
            return _core.held_modes(held, first, len(self), None, None, self.rtol, None, self.gravity)
        return _core.cord_modes(self.system._compiled, first, len(self), None, None, self.rtol)

    def _shape_columns(self, brief: bool) -> list[Column]:
        nodes = self._node_column()
        return [nodes] if brief else [nodes, Column("shape", self.shape, axes=("place",))]


def _texts(nodes: Iterable[Numbers]) -> list[str]:
    """Text with the number of nodes of each mode, and the places of the first and the last."""

    def text(places: Numbers) -> str:
        shown = [f"{place:.3g}" if place < 1000 else f"{place:.0f}" for place in places[[0, -1]]] if places.size else []
        if places.size <= 1:
            return ": ".join([str(places.size), *shown[:1]])
        return f"{places.size}: {shown[0]} {'…' if places.size > 2 else ''} {shown[1]}".replace("  ", " ")

    return [text(places) for places in nodes]


def _speed_bound(error: Floats) -> Floats:
    """Bound for the speed of a height with this error: ``(1 - error)**-0.5 - 1`` plus rounding; infinite from 1 on."""
    with np.errstate(divide="ignore", invalid="ignore"):
        bound = np.expm1(-0.5 * np.log1p(-np.minimum(error, 1.0)))
    return np.asarray(bound * (1 + 1e-9) + SPEED_ROUNDING)


def rest(values: Numbers) -> Floats | None:
    """What doubles leave out of longdouble numbers, which a file of text cannot hold; None for doubles."""
    if values.dtype != np.longdouble:
        return None
    with np.errstate(invalid="ignore"):
        return np.nan_to_num(values - values.astype(np.float64)).astype(np.float64)


def _certificate(number: Whole, found: tuple[Any, ...] | None) -> Certificate | None:
    names = ("lower", "upper", "above_lower", "above_upper", "lower_low", "upper_low")
    given = None if found is None else dict(zip(names, found, strict=True))
    return given and Certificate._made(None, number=number, **{name: x for name, x in given.items() if x is not None})


def _sensitivity(modes: Modes) -> Any:
    from . import sensitivity

    if isinstance(modes, RigModes):
        return sensitivity.of_rig(modes)
    if isinstance(modes, CordModes):
        from .cord_sensitivity import of_cord

        return of_cord(modes)
    if not isinstance(modes.system, Chain):
        raise UnavailableError(
            "revchain.Modes.sensitivity: is for a Chain, a Rig or a Cord, got a chain held at both ends; change the datum "
            "and call modes again"
        )
    return sensitivity.of_modes(modes)


def _facts(system: Any) -> dict[str, Any]:
    """The data of the system in each dictionary and file."""
    return {"system": system.describe()}
