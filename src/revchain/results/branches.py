# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes of all systems, and the windows of stability along them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from itertools import groupby, pairwise
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..systems.numbers import Floats, Whole, count, height_of, one_positive, place_of, word
from ..systems.units import SPEED_UNITS
from .base import Field, Result, Results, UnavailableError, asked_in
from .moving import Moving
from .shapes import FORCES, SteadyShape, forced, is_driven, shape_made, stacked
from .sheet import Column, Sheet, as_dataframe, as_rows, in_columns

if TYPE_CHECKING:
    from pandas import DataFrame

Pair = tuple[float, float]
_Part = tuple[float, float, float, float, str]  # arc at both ends, conical height at both ends, verdict
OWN = "proved complete in its own posture"
MOST_JUDGED = 150_000
"""Points times links squared whose stability takes about a second; above it tables and pictures omit it unless asked."""


class StabilityWindow(Result, row="end", title="Stability window: {verdict}"):
    """A part of a branch with one verdict on stability; an item of `StabilityWindows`.

    Examples
    --------
    >>> import revchain as rc
    >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1)
    >>> branch.stability_windows()[0].verdict
    'minimum'
    """

    __slots__ = ()
    end: Field[tuple[str, str]] = Field("Names of the ends.", lambda w: ("start", "end"), heading="at")
    verdict: Field[str] = Field("``'minimum'``, ``'spectrally stable'``, ``'unstable'`` or ``'undecided'``.", fact=True)
    change: Field[str] = Field(
        "What happens at the end of the window. ``'fold'``: two shapes meet. ``'Hamiltonian Hopf'``: two frequencies of "
        "small motion meet, and growing oscillations appear or vanish (with dashpots ``'Hopf'``: one pair of exponents "
        "crosses the imaginary axis). ``'momentum fold'``: the angular momentum has an extremum along the branch. ``'zero "
        "exponent'``: an exponent passes 0 elsewhere; in the free frame shapes that leave the plane may branch off. "
        "``'end'``: the branch ends. ``'undecided'``: none of these could be established.",
        fact=True,
    )
    angular_speed: Field[Pair] = Field(
        "Speed at both ends, rad/s; the end nearer to the start of the branch first.", heading="speed", unit="rad/s"
    )
    conical_height: Field[Pair] = Field("Conical height at both ends, m.", heading="height", unit="m")
    arc: Field[Pair] = Field("`Branch.arc` at both ends.", heading="along the branch")


def _of_windows(doc: str, name: str, end: int, **column: Any) -> Field[Any]:
    """A number at one end of each window."""
    return Field(doc, lambda w: np.array([getattr(each, name)[end] for each in w], float), **column)


class StabilityWindows(Results[StabilityWindow], row="window", title="{_title_words}"):
    """The windows of stability of a branch, in the order of its arc, or of all branches of a diagram.

    `Branch.stability_windows` and `Branches.stability_windows` return this sequence of `StabilityWindow`.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain.uniform_plummets(2, length=2.0)
    >>> rc.branches(chain, max_angular_speed=9.0).stability_windows()
    3 windows of stability of 2 branches, in the free frame
    branch  mode            verdict  from speed (rad/s)  to speed (rad/s)  from height (m)  to height (m)  change at the end
         0     1            minimum             2.39679           9.00000          1.70711       0.121070                end
         1     2  spectrally stable             5.78636           8.50090         0.292893       0.135704   Hamiltonian Hopf
         1     2           unstable             8.50090           9.00000         0.135704       0.121070                end
    """

    __slots__ = ()
    frame: Field[str] = Field("``'free'`` or ``'driven'``, as in `SteadyShape.stability`.", fact=True)
    branch: Field[Whole | None] = Field(
        "Number of the branch of each window; None if all are of one branch.", heading="branch"
    )
    mode: Field[tuple[str, ...] | None] = Field(
        "`Branches.mode` of the branch of each window; None if all are of one branch.", heading="mode"
    )
    verdict: Field[tuple[str, ...]] = Field(
        "Verdict of each window.", lambda w: tuple(each.verdict for each in w), heading="verdict"
    )
    start_speed = _of_windows("Speed at the start, rad/s.", "angular_speed", 0, heading="from speed", unit="rad/s")
    end_speed = _of_windows("Speed at the end, rad/s.", "angular_speed", 1, heading="to speed", unit="rad/s")
    start_height = _of_windows("Conical height at the start, m.", "conical_height", 0, heading="from height", unit="m")
    end_height = _of_windows("Conical height at the end, m.", "conical_height", 1, heading="to height", unit="m")
    start_arc = _of_windows("`Branch.arc` at the start.", "arc", 0, axes=())
    end_arc = _of_windows("`Branch.arc` at the end.", "arc", 1, axes=())
    change: Field[tuple[str, ...]] = Field(
        "`StabilityWindow.change` of each window.", lambda w: tuple(each.change for each in w), heading="change at the end"
    )
    branches: Field[int] = Field("Number of branches.", fact=True)

    @property
    def _title_words(self) -> str:
        of = f"{self.branches} branch{'es' * (self.branches != 1)}"
        return f"{len(self)} window{'s' * (len(self) != 1)} of stability of {of}, in the {self.frame} frame"


class Branch(Result, Moving, row="point", title="Branch {_name}: {_extent}", spread=True):
    """A branch of steady shapes, point by point; returned by `branch` and `branches`.

    Arrays other than `folds` have one entry for each point. A branch is followed along its arc from its start; that of a
    held system goes from the greatest speed to lower speeds and, after a fold, back.

    Examples
    --------
    >>> import revchain as rc
    >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1)
    >>> branch.angular_speed[[0, -1]].round(4)
    array([2.3968, 9.9029])
    >>> branch.end, branch.folds.size
    ('height', 0)
    >>> blade = rc.Held(rc.Chain.uniform_rods(20, length=24.0, mass=160.0), span=17.0)
    >>> branch = rc.branch(blade, 1, max_angular_speed=6.0)
    >>> branch.angular_speed[[0, -1]].round(3), branch.end
    (array([6.   , 0.828]), 'slack')
    """

    __slots__ = ()
    system: Field[Any] = Field("The chain, rig, cord, or held chain or cord.")
    mode: Field[int | None] = Field(
        "Number of the mode at whose critical speed the branch leaves the vertical; 1 for a branch from rest; None for an "
        "isolated branch. For a held system its half waves at the greatest speed. With an end off the axis it is ``2 * k - "
        "1`` or ``2 * k``: the branch is found from a nearly straight shape of k half waves whose lowest link leads "
        "outwards or inwards.",
        lambda b: b._found().mode or None,
        part=True,
        fact=True,
    )
    birth: Field[str] = Field(
        "Start of the branch. ``'vertical'``: it leaves the straight chain or cord at a critical speed. ``'rest'``: it "
        "starts at rest, with the support off the axis. ``'fold'``: it is isolated. Not for held systems.",
        fact=True,
    )
    end: Field[str] = Field(
        "Reason why the branch ends. ``'height'``: the given conical height is reached. ``'closed'``: the branch is back "
        "at its start. ``'vertical'``: it is back at the straight chain. ``'budget'``: the limit of points or steps is "
        "reached. ``'stuck'``: no step passed every check. ``'slow'``: it approaches rest. ``'slack'``: a link becomes "
        "slack, or with flywheels horizontal, or turns over. ``'loose'``: the spring at the support no longer holds the "
        "chain. ``'folded'``: a held cord hangs folded along the axis. ``'speed'``: the greatest speed is reached again. "
        "``'rest'``: a held chain with ends off the axis hangs as at rest.",
        fact=True,
    )
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    direction: Field[int] = Field(
        "Direction of rotation, 1 or -1; the branches of rigs with flywheels depend on it.", fact=True)
    point: Field[Whole] = Field("Indices of the points.", lambda b: np.arange(len(b)), heading="point")
    angular_speed: Field[Floats] = Field(
        "Speed at each point, rad/s.", lambda b: np.sqrt(b.gravity / b.conical_height), heading="speed", unit="rad/s"
    )
    conical_height: Field[Floats] = Field("Conical height of the speed, m.", heading="height", unit="m")
    lowest_inclination: Field[Floats] = Field(
        "Inclination of the lowest link, or of the lower end of a cord, to the downward vertical (of held systems to the "
        "upward one), rad. Of two mirror images the branch is the one that agrees with the mode shape of `modes` or, if "
        "isolated, starts with the free end at a positive offset.",
        heading="lowest link",
        unit="rad",
    )
    tip_radius: Field[Floats] = Field(
        "Signed offset of the free end from the axis, m; not for held systems.", heading="tip radius", unit="m"
    )
    largest_offset: Field[Floats] = Field(
        "Largest distance of a pin or place of a held system from the axis, m.",
        heading="largest distance from axis",
        unit="m",
    )
    top_tension: Field[Floats] = Field(
        "Magnitude of the reaction at the topmost pin or at the upper end, N or in the unit of the weights.",
        forced("top_tension"),
        part=True,
        heading="top tension",
    )
    half_waves: Field[Whole] = Field(
        "`SteadyShape.half_waves` at each point.",
        lambda b: b._half_waves(),
        part=True,
        heading="half waves",
    )
    is_fold: Field[NDArray[np.bool_]] = Field(
        "Whether each point is a fold.", lambda b: np.isin(b.point, b.folds), heading="fold", column="fold"
    )
    moment_of_inertia: Field[Floats] = Field(
        "Moment of inertia about the axis, kg m^2, or weight times length squared.",
        axes=(),
    )
    effective_energy: Field[Floats] = Field(
        "Potential energy minus half the moment of inertia times the speed squared, J. Not for held cords.",
        forced("effective_energy"),
        part=True,
        axes=(),
    )
    arc: Field[Floats] = Field(
        "Arc length of the branch from its first point, dimensionless, measured in the links' ``arsinh(tan(inclination))`` "
        "(of a cord: that of its free end) and in ``log(conical_height)``. Not for held systems.",
        axes=(),
    )
    inclination: Field[Any] = Field(
        "Inclination of each link at each point, rad, shape (points, N), as in `SteadyShape`; of held cords at the "
        "places of each shape. Not for hanging cords.",
        lambda b: b._inclination(),
        axes=lambda b: ("place",) if isinstance(b.inclination, tuple) else ("link",),
    )
    verdict: Field[tuple[str, ...]] = Field(
        "Verdict of `SteadyShape.stability` at each point, in the free frame; empty for the straight chain. Not for cords. "
        "Files and data frames have this column if it takes less than about a second or was computed before.",
        lambda b: b._verdicts(),
    )
    folds: Field[Whole] = Field(
        "Indices of the points at which the conical height has a local extremum: two shapes appear or merge there.",
    )
    _windows: Field[tuple[tuple[float, float, str], ...]] = Field(
        "Parts with one verdict in the free frame: their ends, counted in points, and the verdict.",
        lambda b: b._judged("free"),
    )
    _points: Field[Floats] = Field("The numbers that give the shapes.", lambda b: b._found().points, part=True)
    _shapes: Field[dict[str, Any] | None] = Field("The numbers of the shape at each point of a held system, else None.")

    def shape(self, point: int) -> SteadyShape:
        """Return the shape at a point of the branch.

        Parameters
        ----------
        point : int
            Index of the point; a negative one counts from the end.

        Returns
        -------
        SteadyShape
            The shape. Its ``error_bound`` is proved for chains and rigs, except at a fold; for cords and held systems it is
            an estimate.

        Raises
        ------
        ValueError
            If there is no such point, or its shape is straight, as where the branch of a mode starts, or does not balance.

        Examples
        --------
        >>> import revchain as rc
        >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1)
        >>> branch.shape(-1).inclination.round(4)
        array([1.5208, 1.5041])
        """
        k = place_of("revchain.Branch.shape", "point", point, len(self))
        if self._shapes is None:
            proved = {"proved": False} if self.is_fold[k] else {}
            return shape_made(self._found().shape(k), self.system, self.gravity, self.direction, **proved)
        numbers = {name: rows[k].item() if np.ndim(rows[k]) == 0 else rows[k] for name, rows in self._shapes.items()}
        speed = float(self.angular_speed[k])
        given = {"system": self.system, "gravity": self.gravity, "direction": self.direction, "angular_speed": speed}
        return SteadyShape._made(None, **given, **numbers)

    def at(
        self,
        angular_speed: float | None = None,
        *,
        conical_height: float | None = None,
        gravity: float | None = None,
    ) -> tuple[SteadyShape, ...]:
        """Return the shapes at a speed on the part of the branch that was followed.

        Parameters
        ----------
        angular_speed : float or str
            Speed in rad/s, or text such as ``"30 rpm"``, positive.
        conical_height : float
            Conical height of the speed, m, positive, instead of `angular_speed`.
        gravity : float, optional
            Acceleration of gravity, m/s^2; that of the branch if left out. For a rig it must be that of the branch.

        Returns
        -------
        tuple of SteadyShape
            The shapes in the order of the arc; none if the speed is outside the range of the branch. Within 1e-9 of the
            speed of a fold its two neighbouring shapes may be missing.

        Raises
        ------
        ValueError
            If not exactly one of `conical_height` and `angular_speed` is given, a number is not positive and finite, the
            system is held, or `gravity` is not that of the branch of a rig.

        Examples
        --------
        >>> import revchain as rc
        >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1)
        >>> [shape.half_waves for shape in branch.at(7.0)], len(branch.at("20 rpm"))
        ([1], 0)
        """
        caller = "revchain.Branch.at"
        g = self.gravity if gravity is None else one_positive(caller, "gravity", gravity)
        if hasattr(self.system, "support") and g != self.gravity:
            what = f"gravity must be that of the rig's branch, {self.gravity:g}"
            raise ValueError(f"{caller}: {what}, got {g:g}; follow it anew")
        height = height_of(caller, conical_height, angular_speed, g)
        if self._shapes is not None:
            what = "is for systems that hang; for a Held ask steady_shapes at the speed"
            raise ValueError(f"{caller}: {what}, got {height:g}")
        shapes = self._found().shapes_at(height)
        nearest = int(np.argmin(np.abs(self.conical_height - height)))
        if not shapes and abs(self.conical_height[nearest] - height) <= 8 * np.finfo(float).eps * height:
            return self._at_point(nearest, g)
        return tuple(shape_made(found, self.system, g, self.direction) for found in shapes)

    def _at_point(self, k: int, gravity: float) -> tuple[SteadyShape, ...]:
        """The shape at a point whose speed is given within rounding; none for the straight chain."""
        if k == 0 and self.birth == "vertical":
            return ()
        proved = {"proved": False} if self.is_fold[k] else {}
        return (shape_made(self._found().shape(k), self.system, gravity, self.direction, **proved),)

    def stability_windows(
        self, *, frame: str = "free", tolerance: float = 1e-6, samples: int = 8, speed: str | None = None
    ) -> StabilityWindows:
        """Return the windows of stability along the branch of a chain or rig.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            Frame, as in `SteadyShape.stability`.
        tolerance : float, optional
            Tolerance of the edges, relative in conical height and absolute in arc.
        samples : int, optional
            Number of places to examine between two points of the branch, with one end.
        speed : {"rad/s", "rpm", "Hz", "s"}, optional
            Unit in which the table prints speeds (``"s"``: periods); that of the question, or rad/s, if left out.

        Returns
        -------
        StabilityWindows
            The windows in the order of the arc; unless undecided, they begin anew at folds. A window shorter than the
            distance between two places can be missed.

        Raises
        ------
        ValueError
            If an argument is out of its range, `SteadyShape.stability` refuses the rig, or the system is a cord or held: ask
            its shapes, ``branch.shape(k).stability()``.

        Notes
        -----
        Cost: `samples` verdicts for each point of the branch, and some 20 for each edge. A verdict takes 0.05 ms for five
        links, 0.4 ms for twenty, 1.5 ms for forty.

        Examples
        --------
        >>> import revchain as rc
        >>> chain = rc.Chain.uniform_plummets(2, length=2.0)
        >>> second = rc.modes(chain).conical_height[1]
        >>> for window in rc.branch(chain, 2, min_conical_height=0.1 * second).stability_windows():
        ...     print(window.verdict, round(window.conical_height[1] / second, 5), window.change)
        spectrally stable 0.46332 Hamiltonian Hopf
        unstable 0.1 end
        """
        caller = "revchain.Branch.stability_windows"
        unit = self._speed_unit if speed is None else word(caller, "speed", speed, SPEED_UNITS)
        found = self._listed_windows(caller, frame, tolerance, samples)
        given = {"frame": frame, "branch": None, "mode": None, "branches": 1}
        return asked_in(unit, StabilityWindows._made(None, _items=tuple(found), **given))

    def _listed_windows(self, caller: str, frame: str, tolerance: float, samples: int) -> list[StabilityWindow]:
        driven = is_driven(caller, frame)
        wide = one_positive(caller, "tolerance", tolerance)
        places = min(count(caller, "samples", samples), 10**6)
        if not self._is_of_links:
            raise ValueError(f"{caller}: is for chains; use the stability of shapes: branch.shape(-1).stability()")
        found = _core.stability_windows(self.system._under(self.gravity), self._found(), driven, wide, places)
        windows = self._split_at_folds(self._from_vertical(found, frame), wide)
        changes = self._changes(windows, frame)
        return [
            StabilityWindow._made(
                None,
                verdict=verdict,
                change=change,
                conical_height=(h0, h1),
                arc=(s0, s1),
                angular_speed=((self.gravity / h0) ** 0.5, (self.gravity / h1) ** 0.5),
            )
            for (s0, s1, h0, h1, verdict), change in zip(windows, changes, strict=True)
        ]

    def _from_vertical(self, found: list[_Part], frame: str) -> list[_Part]:
        """The windows; the first begins at the vertical unless the verdict near it is another."""
        if not found or self.birth != "vertical" or len(self) < 2:
            return found
        s0, s1, h0, h1, verdict = found[0]
        top = float(self.conical_height[0])
        near = self.at(conical_height=top + 0.1 * (float(self.conical_height[1]) - top))
        if near:
            inclination = self.inclination[1]
            first = min(near, key=lambda shape: float(np.abs(shape.inclination - inclination).max()))
            if first.stability(frame=frame).verdict not in (verdict, "undecided"):
                return found
        return [(float(self.arc[0]), s1, top, h1, verdict), *found[1:]]

    def _split_at_folds(self, found: list[_Part], tolerance: float) -> list[_Part]:
        windows = []
        for s0, s1, h0, h1, verdict in found:
            for k in self.folds:
                arc, height = float(self.arc[k]), float(self.conical_height[k])
                if s0 + 10 * tolerance < arc < s1 - 10 * tolerance and verdict != "undecided":
                    windows.append((s0, arc, h0, height, verdict))
                    s0, h0 = arc, height
            windows.append((s0, s1, h0, h1, verdict))
        return windows

    def _changes(self, windows: list[_Part], frame: str) -> list[str]:
        """How the verdict changes at the end of each window."""
        changes: list[str] = []
        at_folds = self.arc[self.folds]
        for before, after in pairwise(windows):
            edge, near = before[1], 1e-5
            for low, high, _, _, verdict in (before, after):
                if verdict == "undecided":
                    near = max(near, 1.01 * (high - low))
            if (np.abs(at_folds - edge) <= near).any():
                changes.append("fold")
            elif "undecided" in (before[4], after[4]):
                changes.append("undecided")
            elif "unstable" not in (before[4], after[4]):
                changes.append("zero exponent")
            else:
                far = before[2] if before[4] == "unstable" else after[3]
                changes.append(self._growth(edge, before[3], far - before[3], frame))
        return [*changes, *["end"] * (len(windows) > 0)]

    def _growth(self, arc: float, height: float, ahead: float, frame: str) -> str:
        """How the fastest disturbance grows just beyond an edge."""
        inclination = np.array([np.interp(arc, self.arc, each) for each in self.inclination.T])

        def shape_at(h: float) -> Any:
            shapes = self.at(conical_height=h)
            return min(shapes, key=lambda shape: float(np.abs(shape.inclination - inclination).max()), default=None)

        step = math.copysign(min(1e-3 * height, 0.1 * abs(ahead)), ahead)
        beyond, here, short = (shape_at(height + k * step) for k in (1, 0, -1))
        found = None if beyond is None else beyond.stability(frame=frame)
        if found is None or found.verdict != "unstable":
            return "undecided"
        fastest = found.exponents[np.argmax(found.exponents.real)]
        if abs(fastest.imag) > 1e-9 * abs(fastest):
            return "Hopf" if getattr(self.system, "is_damped", False) else "Hamiltonian Hopf"
        support = self.system._support
        if frame == "free" and (support is None or not support.radius) and None not in (here, short):
            rises = [each.angular_momentum - here.angular_momentum for each in (beyond, short)]
            return "momentum fold" if rises[0] * rises[1] > 0 else "zero exponent"
        return "zero exponent"

    def _judged(self, frame: str, samples: int = 1) -> tuple[tuple[float, float, str], ...]:
        """Parts of the branch with one verdict, found with `samples` for each point: ends in points, and verdict."""
        if self.system._is_cord:
            what = "is for links, as each verdict of a cord takes long; ask shapes: branch.shape(-1).stability()"
            raise UnavailableError(f"revchain.Branch.verdict: {what}")
        try:
            if self._is_of_links:
                system: Any = self.system._under(self.gravity)
                tolerance = 1e-4 if samples == 1 else 1e-6
                found = _core.stability_windows(system, self._found(), frame == "driven", tolerance, samples)
                parts = [(*np.interp(each[:2], self.arc, self.point).tolist(), each[4]) for each in found]
            else:
                shapes = [(k, shape) for k in range(len(self)) if (shape := self._shape_or_none(k)) is not None]
                each_point = [(k, shape.stability(frame=frame).verdict) for k, shape in shapes]
                parts = [
                    (run[0][0] - 0.5, run[-1][0] + 0.5, verdict)
                    for verdict, same in groupby(each_point, key=lambda each: each[1])
                    if (run := list(same))
                ]
        except ValueError as error:
            raise UnavailableError(str(error)) from None
        if parts:
            parts[0] = (0.0, *parts[0][1:])
            parts[-1] = (parts[-1][0], len(self) - 1.0, parts[-1][2])
        return tuple(parts)

    def _verdicts(self) -> tuple[str, ...]:
        found: list[str] = []
        for k in range(len(self)):
            near = {verdict for low, high, verdict in self._windows if low - 1e-3 <= k <= high + 1e-3}
            if k > 0 and len(near) == 1:
                found += near
                continue
            shape = self._shape_or_none(k)
            found.append(shape.stability().verdict if shape is not None else "undecided" if k else "")
        return tuple(found)

    def _shape_or_none(self, point: int) -> Any:
        """The shape at a point; None for the straight chain, and where it does not balance."""
        try:
            return self.shape(point)
        except ValueError:
            return None

    @property
    def _is_of_links(self) -> bool:
        return self._shapes is None and isinstance(self._found(), _core.Branch)

    @property
    def _work(self) -> float:
        """Points times links squared; infinite for cords, where each verdict takes long."""
        return math.inf if self.system._is_cord else float(len(self) * self.system.size**2)

    def _sheet(self, brief: bool = False) -> Sheet:
        sheet = super()._sheet(brief)
        return sheet if brief else replace(sheet, columns=[*sheet.columns, *_verdict_column([self])])

    def to_dataframe(self) -> DataFrame:
        """Return a pandas table with a row for each point and a column for the inclination of each link.

        Returns
        -------
        pandas.DataFrame
            The table, in SI units, with columns such as ``inclination_link_0``, or ``inclination_link_0_load`` if the link
            has a name.

        Raises
        ------
        ImportError
            If pandas is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> chain = rc.Chain(mass=[1.0, 3.0], length=1.0, names=["load", "hook"])
        >>> table = rc.branch(chain, 1, min_conical_height=0.1).to_dataframe()
        >>> [name for name in table if name.startswith("inclination")], table.verdict.iloc[-1]
        (['inclination_link_0_load', 'inclination_link_1_hook'], 'minimum')
        """
        sheet = self._sheet()
        return as_dataframe(replace(sheet, columns=_by_link(sheet, self.system)))

    @property
    def _per(self) -> float:
        return float(self.system._force(self.gravity))

    def __len__(self) -> int:
        return int(self.conical_height.size)

    def _from_parts(self) -> Any:
        """The compiled branch with these numbers; no point is computed again."""
        if self._shapes is not None:
            raise UnavailableError("revchain.Branch: the branch of a held system does not have it")
        columns = (self.arc, self.conical_height, self.half_waves, self.folds, self._points)
        system: Any = self.system._under(self.gravity)
        return _core.branch_from(system, self.mode or 0, self.birth, *columns, self.gravity, self.direction)

    def _inclination(self) -> Any:
        if self._shapes is not None:
            return self._shapes["inclination"]
        if not isinstance(self._found(), _core.Branch):
            raise UnavailableError("revchain.Branch.inclination: a hanging cord has it in the shapes: branch.shape(k)")
        straight = np.arctan(np.sinh(self._points[:, : self.system.size]))  # to the line in which the link hangs or stands
        turned = np.copysign(np.pi, straight) - straight
        return np.where(getattr(self.system, "inverted", False), turned, straight)

    def _half_waves(self) -> Any:
        waves, support = self._found().half_waves, self.system._support
        if support is None or not support.radius or not self._is_of_links:
            return waves
        inwards = np.asarray(self.system._base.length) * np.sin(self.inclination)
        offsets = np.column_stack([self.tip_radius, self.tip_radius[:, None] - np.cumsum(inwards, axis=1)])
        signs = [np.sign(row[row != 0.0]) for row in offsets]
        return np.array([1 + np.count_nonzero(np.diff(row)) for row in signs], waves.dtype)

    @property
    def _name(self) -> str:
        if self._shapes is None:
            return "from rest" if self.birth == "rest" else "isolated" if self.mode is None else f"of mode {self.mode}"
        waves = int(self.half_waves[0])
        mode = "" if self.system.is_on_axis else f" (mode {self.mode})"
        return f"of {waves} half wave{'s' * (waves != 1)}{mode}"

    @property
    def _extent(self) -> str:
        many = self.folds.size
        folds = f", {many} fold{'s' * (many != 1)}" if many else ""
        return f"{len(self)} points{folds}, ends at {self._ends_at}"

    _by_speed = False  # whether the question gave a speed, not a conical height

    @property
    def _ends_at(self) -> str:
        return "largest speed" if self.end == "height" and self._by_speed else self.end


class Branches(Results[Branch], Moving, row="branch", title="{_title_words}", good="complete"):
    """The branches found down to one conical height; returned by `branches`.

    The branches of the modes, or the branch from rest, come first, then isolated ones, then those of other postures. Those
    of a held system are ordered by half waves.

    The printed table has a row for each branch; data frames, dictionaries and CSV files have one for each point.

    Examples
    --------
    >>> import revchain as rc
    >>> diagram = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), min_conical_height=0.04)
    >>> [each.mode for each in diagram], diagram.complete
    ([1, 2, 3, None], True)
    """

    __slots__ = ()
    system: Field[Any] = Field("The chain, rig, cord, or held chain or cord.")
    number: Field[Whole] = Field("Indices.", lambda b: np.arange(len(b)), heading="branch", column="branch")
    mode: Field[tuple[str, ...]] = Field(
        "Number of the mode of each branch as text, ``'rest'`` or ``'isolated'``.",
        lambda b: tuple(_born(each) for each in b),
        heading="mode",
    )
    inverted: Field[tuple[str, ...] | None] = Field(
        "Links that are above their upper pins along each branch, as text; None if `hanging_only`, for cords and for held "
        "systems.",
        lambda b: None if b.hanging_only or b.system._is_cord or b.system._is_held else tuple(_inverted(each.system) for each in b),
        heading="above their pins",
    )
    points: Field[Whole] = Field(
        "Number of points of each branch.", lambda b: np.array([len(each) for each in b], int), heading="points"
    )
    folds: Field[Whole] = Field(
        "Number of folds of each branch.", lambda b: np.array([each.folds.size for each in b], int), heading="folds"
    )
    lowest_speed: Field[Floats] = Field(
        "Lowest speed of each branch, rad/s.",
        lambda b: np.array([each.angular_speed.min() for each in b], float),
        heading="lowest speed",
        unit="rad/s",
    )
    highest_speed: Field[Floats] = Field(
        "Highest speed of each branch, rad/s.",
        lambda b: np.array([each.angular_speed.max() for each in b], float),
        heading="highest speed",
        unit="rad/s",
    )
    end: Field[tuple[str, ...]] = Field(
        "`Branch.end` of each branch; printed as ``largest speed`` instead of ``height`` if a speed was given.",
        lambda b: tuple(each.end for each in b),
        heading="ends at",
        shown=lambda b: [each._ends_at for each in b],
    )
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    direction: Field[int] = Field(
        "Direction of rotation, 1 or -1; the branches of rigs with flywheels depend on it.", fact=True)
    hanging_only: Field[bool] = Field(
        "Whether branches in other postures than that of the chain or rig were left out; false for cords and held systems.",
        fact=True,
    )
    consistent: Field[bool] = Field(
        "Whether at each of the speeds `looked_at` the list is proved (of a cord: scanned) and each of its shapes lies on "
        "exactly one branch, and no branch stops early. Held systems have neither this nor `complete`, `remark` and "
        "`looked_at`.",
        fact=True,
    )
    complete: Field[bool] = Field(
        "Whether it is also proved that no branch is missing, even a closed one between two of these speeds; for a cord by "
        "a theorem (see `steady_shapes`). With ``hanging_only=False`` it is false, except for a chain of one link.",
        fact=True,
    )
    remark: Field[str] = Field("A sentence that says what may be missing.", fact=True)
    looked_at: Field[Floats] = Field("Conical heights at which all shapes were listed, m, descending.", fact=True)

    _stability: Field[bool] = Field("Whether the verdicts were asked for, so that reports list the windows.")

    def _is_good(self) -> bool:
        """Whether all was found and proved; of other postures consistent lists are enough."""
        return super()._is_good() or (self._is_of_postures and self.consistent and self.remark.startswith(OWN))

    @property
    def _is_of_postures(self) -> bool:
        return not (self.hanging_only or self.system._is_cord or self.system._is_held)

    @property
    def _of_shapes(self) -> str:
        """The shapes for which ``complete`` is proved, in words."""
        if self.system._is_cord or self.system._is_held or self._is_of_postures and self.complete:
            return "steady shapes"
        inverted = getattr(self.system, "inverted", None)  # of a rig
        if inverted is None and self.system.size == 1:
            return "steady shapes"
        return "hanging shapes" if inverted is None or not np.any(inverted) else "shapes in this posture"

    def stability_windows(
        self, *, frame: str = "free", tolerance: float = 1e-6, samples: int = 8, speed: str | None = None
    ) -> StabilityWindows:
        """Return the windows of stability of all branches in one table.

        Parameters
        ----------
        frame, tolerance, samples, speed
            As in `Branch.stability_windows`.

        Returns
        -------
        StabilityWindows
            The windows, branch by branch.

        Raises
        ------
        ValueError
            As in `Branch.stability_windows`.

        Examples
        --------
        >>> import revchain as rc
        >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0))
        >>> windows = rc.branches(carousel, max_angular_speed=4.0).stability_windows()
        >>> for number, window in zip(windows.branch, windows):
        ...     print(number, window.verdict, round(window.angular_speed[1], 4), window.change)
        0 minimum 4.0 end
        1 unstable 2.2878 fold
        1 spectrally stable 4.0 end
        """
        caller = "revchain.Branches.stability_windows"
        unit = self._speed_unit if speed is None else word(caller, "speed", speed, SPEED_UNITS)
        each = [branch._listed_windows(caller, frame, tolerance, samples) for branch in self]
        numbers = np.repeat(np.arange(len(self)), [len(windows) for windows in each])
        found = StabilityWindows._made(
            None,
            _items=tuple(window for windows in each for window in windows),
            frame=frame,
            branch=numbers,
            mode=tuple(self.mode[k] for k in numbers),
            branches=len(self),
        )
        return asked_in(unit, found)

    def _sheet(self, brief: bool = False) -> Sheet:
        """The branches; unless `brief` all their points, with the branches as a fact."""
        sheet = super()._sheet(brief)
        if brief:
            return sheet
        words = [each for each in sheet.columns if each.name in ("branch", "mode", "inverted")]
        columns = [each._replace(values=np.repeat(np.asarray(each.values), self.points)) for each in words]
        parts = [_by_link(Result._sheet(branch), branch.system) for branch in self]
        for column in parts[0] if parts else []:
            of_each = [each.values for part in parts for each in part if each.name == column.name]
            if len(of_each) == len(self) and all(isinstance(values, np.ndarray) for values in of_each):
                columns.append(column._replace(values=np.concatenate(of_each)))
        columns += _verdict_column(self)
        return replace(sheet, row="point", columns=columns, facts={**sheet.facts, "branches": as_rows(sheet)})

    def _from_parts(self) -> Any:
        what = "the branches of a held system do not have it; steady_shapes proves a list"
        raise UnavailableError(f"revchain.Branches: {what}")

    @property
    def _title_words(self) -> str:
        if not hasattr(self, "complete"):
            return f"{len(self)} branch{'es' * (len(self) != 1)} from the nearly straight chain"
        isolated = sum(each.mode is None for each in self)
        begin = "from rest" if self and self[0].birth == "rest" else "from the vertical"
        which = "Branches" if self.inverted is None else "Branches in every posture"
        remark = f"proved complete: no branch of {self._of_shapes} is missing" if self.complete else self.remark
        return f"{which}: {len(self) - isolated} {begin}, {isolated} isolated; {remark}"


def _by_link(sheet: Sheet, system: Any) -> list[Column]:
    """The columns; one for each link where a column has a number for each."""
    named = replace(sheet, named=lambda axis, link: system._link_name(link) if axis == "link" else "")
    return in_columns(named, system.size)


def _verdict_column(branches: Sequence[Branch]) -> list[Column]:
    """The verdict at each point, if it is known or computed soon."""
    known = all("verdict" in branch.__dict__ for branch in branches)
    if not known and sum(branch._work for branch in branches) > MOST_JUDGED:
        return []
    verdicts = [getattr(branch, "verdict", None) for branch in branches]
    if None in verdicts:
        return []
    return [Column("verdict", [verdict for each in verdicts for verdict in each or ()])]


def _inverted(system: Any) -> str:
    """The links of a system that are above their upper pins, in words."""
    names = getattr(system._base, "names", None) or list(map(str, range(system.size)))
    return ", ".join(name for name, stands in zip(names, system._stands, strict=True) if stands) or "none"


def _born(branch: Branch) -> str:
    isolated = branch.mode is None
    return "rest" if getattr(branch, "birth", "") == "rest" else "isolated" if isolated else str(branch.mode)


def branch_made(found: Any, system: Any, gravity: float, direction: int) -> Branch:
    """The branch from a compiled one; of a held system from the shapes at its points."""
    given: dict[str, Any] = {"system": system, "gravity": gravity, "direction": direction}
    if not hasattr(found, "shapes"):
        return Branch._made(found, _shapes=None, **given)
    shapes, parts = found.shapes, [name for name, field in SteadyShape._fields.items() if field.part]
    rows = {name: stacked(_each(shapes, name)) for name in parts if hasattr(shapes[0], name.strip("_"))}
    height = rows["conical_height"]
    per = system._force(gravity) / height
    for name in (name for name in FORCES if name in rows):
        each = rows[name]
        if isinstance(each, tuple):
            rows[name] = tuple(factor * row for factor, row in zip(per, each, strict=True))
        else:
            rows[name] = per.reshape(-1, *(1,) * (each.ndim - 1)) * each
    rows.setdefault("proved", np.zeros(len(height), bool))  # estimated for cords
    energy = {"effective_energy": rows["effective_energy"]} if "effective_energy" in rows else {}
    return Branch._made(
        None,
        **given,
        **energy,
        mode=found.mode,
        end=found.end,
        folds=np.array(found.folds, int),
        conical_height=height,
        lowest_inclination=np.array([row[0] for row in rows["inclination"]]),
        largest_offset=np.array([np.abs(row).max() for row in rows["offset"]]),
        top_tension=np.array([row[-1] for row in rows["tension"]]),
        moment_of_inertia=rows["moment_of_inertia"],
        half_waves=rows["half_waves"],
        _shapes=rows,
    )


def _each(shapes: list[Any], name: str) -> list[Any]:
    values = [getattr(shape, name.strip("_")) for shape in shapes]
    return [np.ravel(value) for value in values] if name == "_path" else values


def branches_made(found: Any, system: Any, gravity: float, direction: int, stability: bool) -> Branches:
    items = tuple(branch_made(each, system, gravity, direction) for each in found.branches)
    given = {"system": system, "gravity": gravity, "direction": direction, "_stability": stability}
    return Branches._made(found, _items=items, **given, hanging_only=not (system._is_cord or system._is_held))


def joined(diagrams: Sequence[Branches], system: Any) -> Branches:
    """The diagram of all postures of a system from those of each, its own first."""
    first, consistent = diagrams[0], all(each.consistent for each in diagrams)
    heights = [set(each.looked_at.tolist()) for each in diagrams if not each.complete]
    looked_at = sorted(set.intersection(*heights) if heights else first.looked_at.tolist(), reverse=True)
    if all(each.complete for each in diagrams):
        remark = first.remark
    elif consistent:
        remark = (
            f"{OWN if first.complete else first.remark}; in the others each shape of the "
            "proved lists is on one branch, but loops between two of the heights looked at are not excluded"
        )
    else:
        worst = next(each for each in diagrams if not each.consistent)
        remark = f"inverted links {_inverted(worst.system)}: {worst.remark}"
    return Branches._made(
        None,
        _items=tuple(branch for each in diagrams for branch in each),
        system=system,
        gravity=first.gravity,
        direction=first.direction,
        hanging_only=False,
        _stability=first._stability,
        consistent=consistent,
        complete=all(each.complete for each in diagrams),
        remark=remark,
        looked_at=np.array(looked_at),
    )
