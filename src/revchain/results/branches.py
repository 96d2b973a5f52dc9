# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes of all systems, and the windows of stability along them."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..systems.numbers import Floats, Whole, count, height_of, one_positive, place_of
from .base import Field, Result, Results, UnavailableError
from .moving import Moving
from .shapes import FORCES, SteadyShape, forced, is_driven, shape_made, stacked


Pair = tuple[float, float]


class StabilityWindow(Result, row="end", title="Stability window: {verdict}"):
    """A part of a branch with one verdict on stability; returned by `Branch.stability_windows`.

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
    angular_speed: Field[Pair] = Field(
        "Speed at both ends, rad/s; the end nearer to the start of the branch first.", heading="speed", unit="rad/s"
    )
    conical_height: Field[Pair] = Field("Conical height at both ends, m.", heading="height", unit="m")
    arc: Field[Pair] = Field("`Branch.arc` at both ends.", heading="along the branch")


class Branch(Result, Moving, row="point", title="Branch {_name}: {_extent}", spread=True):
    """A branch of steady shapes, point by point; returned by `branch` and `branches`.

    Arrays have one number for each point. The branch of a chain, rig or cord that hangs is followed along its arc from
    its start; that of a held system goes from the greatest speed to lower speeds and, after a fold, back.

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
        "Number of the mode at whose critical speed the branch leaves the vertical; 1 for a branch from rest; None "
        "for an isolated branch. For a held system its half waves at the greatest speed; with ends off the axis the "
        "number is ``2 * k - 1`` if the lowest link of the k half waves leads outwards, ``2 * k`` if inwards.",
        lambda b: b._found().mode or None,
        part=True,
        fact=True,
    )
    birth: Field[str] = Field(
        "Start of the branch. ``'vertical'``: it leaves the straight chain or cord at a critical speed. ``'rest'``: "
        "it starts at rest, with the support off the axis. ``'fold'``: it is isolated; two shapes start at a fold. "
        "Not for held systems.",
        fact=True,
    )
    end: Field[str] = Field(
        "Reason why the branch ends. ``'height'``: the given conical height is reached. ``'closed'``: the branch is "
        "back at its start. ``'vertical'``: it is back at the straight chain. ``'budget'``: `max_points` (of a held "
        "system 3000 steps) are done. ``'stuck'``: no step passed every check. ``'slow'``: it approaches rest. "
        "``'slack'``: a link becomes slack, or with flywheels horizontal, or turns over (of a held system the last "
        "speed is within a measured 2e-5, relative). ``'loose'``: the spring at the support no longer holds the "
        "chain. ``'folded'``: a held cord hangs folded along the axis. ``'speed'``: the greatest speed is reached "
        "again. ``'rest'``: with ends off the axis the held chain hangs as at rest, at a conical height of 10,000 "
        "lengths.",
        fact=True,
    )
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    direction: Field[int] = Field("Direction of rotation, 1 or -1; only a rig with flywheels depends on it.", fact=True)
    point: Field[Whole] = Field("Indices of the points.", lambda b: np.arange(len(b)), heading="point")
    angular_speed: Field[Floats] = Field(
        "Speed at each point, rad/s.", lambda b: np.sqrt(b.gravity / b.conical_height), heading="speed", unit="rad/s"
    )
    conical_height: Field[Floats] = Field("Conical height of the speed, m.", heading="height", unit="m")
    lowest_inclination: Field[Floats] = Field(
        "Inclination of the lowest link, or of the lower end of a cord, to the downward vertical (of held systems to "
        "the upward one), rad. Of two mirror images the branch follows the one that agrees with the mode shape of "
        "`modes`; an isolated branch follows the one that starts with the free end at a positive offset. The link is "
        "vertical where the sign changes. With the support off the axis there are no mirror images; outwards is "
        "positive.",
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
    half_waves: Field[Whole] = Field("Sign changes of the offsets, plus one.", heading="half waves")
    is_fold: Field[NDArray[np.bool_]] = Field(
        "Whether each point is a fold.", lambda b: np.isin(b.point, b.folds), heading="fold", column="fold"
    )
    moment_of_inertia: Field[Floats] = Field(
        "Moment of inertia about the axis, kg m^2; for a system given by weight, in weight times length squared.",
        axes=(),
    )
    effective_energy: Field[Floats] = Field(
        "Potential energy minus half the moment of inertia times the speed squared, J. Not for held cords.",
        forced("effective_energy"),
        part=True,
        axes=(),
    )
    arc: Field[Floats] = Field(
        "Arc length of the branch from its first point, dimensionless: the root of the mean square of the links' ``d "
        "arsinh(tan(inclination))`` (of a cord: that of its free end) plus the square of ``d log(conical_height)``, "
        "summed up. Not for held systems.",
        axes=(),
    )
    inclination: Field[Any] = Field(
        "Inclination of each link at each point, rad, shape (points, N), as in `SteadyShape`; of held cords at the "
        "places of each shape. Not for hanging cords.",
        lambda b: b._inclination(),
        axes=lambda b: ("place",) if isinstance(b.inclination, tuple) else ("link",),
    )
    folds: Field[Whole] = Field(
        "Indices of the points at which the conical height has a local extremum: two shapes appear or merge there.",
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
            The shape of a chain or rig, computed in double-double. Its ``error_bound`` is proved, except at a fold,
            where it is an estimate, as it is for cords (at a fold 1e-7, because of the position of the fold on the arc)
            and for held systems; for a held chain `steady_shapes` at its speed proves one.

        Raises
        ------
        ValueError
            If there is no such point, or it is the straight chain, at which the branch of a mode starts.

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
        *,
        conical_height: float | None = None,
        angular_speed: float | None = None,
        gravity: float | None = None,
    ) -> tuple[SteadyShape, ...]:
        """Return the shapes at a speed on the part of the branch that was followed.

        Parameters
        ----------
        conical_height : float
            Conical height of the speed, m, positive.
        angular_speed : float
            Speed in rad/s, positive, instead of `conical_height`.
        gravity : float, optional
            Acceleration of gravity, m/s^2; that of the branch if left out. For a rig it must be that of the branch,
            because the effect of springs and wheels depends on it.

        Returns
        -------
        tuple of SteadyShape
            The shapes in the order of the arc; empty if the branch does not pass the speed.

        Raises
        ------
        ValueError
            If not exactly one of `conical_height` and `angular_speed` is given, or a number is not positive
            and finite, or the system is held.

        Examples
        --------
        >>> import revchain as rc
        >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1)
        >>> [shape.half_waves for shape in branch.at(conical_height=0.2)]
        [1]
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
        return tuple(shape_made(found, self.system, g, self.direction) for found in self._found().shapes_at(height))

    def stability_windows(
        self, *, frame: str = "free", tolerance: float = 1e-6, samples: int = 8
    ) -> list[StabilityWindow]:
        """Return the windows of stability along the branch of a chain or rig.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            Frame, as in `SteadyShape.stability`.
        tolerance : float, optional
            Tolerance of the edges, relative in conical height and absolute in arc.
        samples : int, optional
            Number of places to examine between two points of the branch, with one end.

        Returns
        -------
        list of StabilityWindow
            The windows in the order of the arc. They cover the branch except the part from the vertical to the next
            point. Edges are located by bisection. A window shorter than the distance of the places can be missed.

        Raises
        ------
        ValueError
            If `frame` is another word, `tolerance` is not positive or `samples` is below 1; for cords and held systems,
            whose shapes have their stability: ``branch.shape(k).stability()``.

        Examples
        --------
        >>> import revchain as rc
        >>> chain = rc.Chain.uniform_plummets(2, length=2.0)
        >>> second = rc.modes(chain).conical_height[1]
        >>> for window in rc.branch(chain, 2, min_conical_height=0.1 * second).stability_windows():
        ...     print(window.verdict, round(window.conical_height[1] / second, 5))
        spectrally stable 0.46332
        unstable 0.1
        """
        caller = "revchain.Branch.stability_windows"
        driven = is_driven(caller, frame)
        wide = one_positive(caller, "tolerance", tolerance)
        places = min(count(caller, "samples", samples), 10**6)
        if self._shapes is not None or not isinstance(self._found(), _core.Branch):
            raise ValueError(f"{caller}: is for chains; use the stability of shapes: branch.shape(-1).stability()")
        found = _core.stability_windows(self.system._under(self.gravity), self._found(), driven, wide, places)
        return [
            StabilityWindow._made(
                None,
                verdict=verdict,
                conical_height=(h0, h1),
                arc=(s0, s1),
                angular_speed=((self.gravity / h0) ** 0.5, (self.gravity / h1) ** 0.5),
            )
            for s0, s1, h0, h1, verdict in found
        ]

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
        return f"{len(self)} points{folds}, ends at {self.end}"


class Branches(Results[Branch], Moving, row="branch", title="{_title_words}", good="complete"):
    """The branches found down to one conical height; returned by `branches`.

    The branches of the modes come first, slowest first; with the support off the axis it is the branch from rest. The
    isolated branches, which start at folds, follow. Those of a held system are ordered by half waves.

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
        "`Branch.end` of each branch.", lambda b: tuple(each.end for each in b), heading="ends at"
    )
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    direction: Field[int] = Field("Direction of rotation, 1 or -1; only a rig with flywheels depends on it.", fact=True)
    consistent: Field[bool] = Field(
        "Whether at each of the speeds `looked_at` the list is proved (of a cord: scanned) and each of its shapes "
        "lies on exactly one branch. Not for held systems, nor are the next three.",
        fact=True,
    )
    complete: Field[bool] = Field(
        "Whether it is also proved that no branch is missing, even a closed one between two of these speeds; for a "
        "cord whether a theorem counts the shapes (see `steady_shapes`) and every branch was followed to its end.",
        fact=True,
    )
    remark: Field[str] = Field("A sentence that says what may be missing.", fact=True)
    looked_at: Field[Floats] = Field("Conical heights at which all shapes were listed, m, descending.", fact=True)

    def _from_parts(self) -> Any:
        what = "the branches of a held system do not have it; steady_shapes proves a list"
        raise UnavailableError(f"revchain.Branches: {what}")

    @property
    def _title_words(self) -> str:
        if not hasattr(self, "complete"):
            return f"{len(self)} branch{'es' * (len(self) != 1)} from the nearly straight chain"
        isolated = sum(each.mode is None for each in self)
        begin = "from rest" if self and self[0].birth == "rest" else "from the vertical"
        return f"Branches: {len(self) - isolated} {begin}, {isolated} isolated; {self.remark}"


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


def branches_made(found: Any, system: Any, gravity: float, direction: int) -> Branches:
    """Make `Branches` from a list of compiled branches."""
    items = tuple(branch_made(each, system, gravity, direction) for each in found.branches)
    return Branches._made(found, _items=items, system=system, gravity=gravity, direction=direction)
