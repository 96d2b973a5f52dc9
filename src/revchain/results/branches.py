# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes, and the windows of stability along them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from numpy.typing import NDArray

from .. import _core
from ..systems.chain import Chain
from ..systems.cord import Cord
from ..systems.numbers import Floats, Whole, count, height_of, one_positive, place_of
from ..systems.rig import Rig
from .base import Field, Result, Results
from .moving import Moving
from .shapes import SteadyShape, forced, is_driven
from .sheet import Column, Sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Pair = tuple[float, float]
AnyBranch = TypeVar("AnyBranch", bound=Result)


class StabilityWindow(Result):
    """A part of a branch with one verdict on stability; returned by `Branch.stability_windows`.

    Examples
    --------
    >>> import revchain as rc
    >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1)
    >>> branch.stability_windows()[0].verdict
    'minimum'
    """

    __slots__ = ()
    verdict: Field[str] = Field("``'minimum'``, ``'spectrally stable'``, ``'unstable'`` or ``'undecided'``.")
    conical_height: Field[Pair] = Field(
        "Conical height at both ends, m; the end nearer to the start of the branch first."
    )
    arc: Field[Pair] = Field("`Branch.arc` at both ends.")

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("end", ["start", "end"], "at"),
            Column("conical_height", np.array(self.conical_height), "height (m)"),
            Column("arc", np.array(self.arc), "along the branch"),
        ]
        return Sheet("end", f"Stability window: {self.verdict}", columns, {"verdict": self.verdict})


class Branch(Result, Moving):
    """A branch of steady shapes, point by point along its arc; returned by `branch` and `branches`.

    Arrays have one number for each point.

    Examples
    --------
    >>> import revchain as rc
    >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1)
    >>> branch.angular_speed[[0, -1]].round(4)
    array([2.3968, 9.9029])
    >>> branch.end, branch.folds.size
    ('height', 0)
    """

    __slots__ = ()
    system: Field[Chain | Rig] = Field("The chain or rig.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.")
    direction: Field[int] = Field("Direction of rotation, 1 or -1; only a rig with flywheels depends on it.")
    mode: Field[int | None] = Field(
        "Number of the mode at whose critical speed the branch leaves the vertical; 1 for a branch from rest; None for "
        "an isolated branch.",
        lambda b: b._found().mode or None,
        part=True,
    )
    birth: Field[str] = Field(
        "Start of the branch. ``'vertical'``: it leaves the straight chain at a critical speed. ``'rest'``: it starts at "
        "rest, with the support off the axis. ``'fold'``: it is isolated; two shapes start at a fold.",
    )
    arc: Field[Floats] = Field(
        "Arc length of the branch from its first point, dimensionless: the root of the mean square of the links' ``d "
        "arsinh(tan(inclination))`` plus the square of ``d log(conical_height)``, summed up.",
    )
    conical_height: Field[Floats] = Field("Conical height of the speed, m.")
    angular_speed: Field[Floats] = Field("Speed at each point, rad/s.", lambda b: np.sqrt(b.gravity / b.conical_height))
    tip_inclination: Field[Floats] = Field(
        "Inclination of the lowest link to the vertical, rad. Of two mirror images the branch follows the one that agrees "
        "with the mode shape of `modes`; an isolated branch follows the one that starts with the free end at a positive "
        "offset. The link is vertical where the sign changes. With the support off the axis there are no mirror images; "
        "outwards is positive.",
    )
    tip_radius: Field[Floats] = Field("Signed offset of the free end from the axis, m.")
    top_tension: Field[Floats] = Field(
        "Magnitude of the reaction at the topmost pin, N or in the unit of the weights.",
        forced("top_tension"),
        part=True,
    )
    moment_of_inertia: Field[Floats] = Field(
        "Moment of inertia about the axis, kg m^2; for a chain given by weight, in weight times length squared."
    )
    effective_energy: Field[Floats] = Field(
        "Potential energy minus half the moment of inertia times the speed squared, J.",
        forced("effective_energy"),
        part=True,
    )
    half_waves: Field[Whole] = Field("Sign changes of the offsets, plus one.")
    folds: Field[Whole] = Field(
        "Indices of the points at which the conical height has a local extremum: two shapes appear or merge there.",
    )
    end: Field[str] = Field(
        "Reason why the branch ends. ``'height'``: the given conical height is reached. ``'closed'``: the branch is "
        "back at its start. ``'vertical'``: it is back at the straight chain. ``'budget'``: `max_points` is reached. "
        "``'stuck'``: no step passed every check. ``'slow'``: it approaches rest. ``'slack'``: flywheels cancel the "
        "tension of a link, which becomes horizontal. ``'loose'``: the spring at the support no longer holds the "
        "chain.",
    )
    asked: Field[tuple[Any, ...]] = Field("Arguments of the call, used to compute shapes later.")

    def shape(self, point: int) -> SteadyShape:
        """Return the shape at a point of the branch.

        Parameters
        ----------
        point : int
            Index of the point; a negative one counts from the end.

        Returns
        -------
        SteadyShape
            The shape, computed in double-double. Its ``error_bound`` is proved, except at a fold, where it is an estimate.

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
        number = place_of("revchain.Branch.shape", "point", point, len(self))
        return self._shape(self._found().shape(number), self.gravity)

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
            and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1)
        >>> [shape.half_waves for shape in branch.at(conical_height=0.2)]
        [1]
        """
        place = "revchain.Branch.at"
        g = self.gravity if gravity is None else one_positive(place, "gravity", gravity)
        if isinstance(self.system, Rig) and g != self.gravity:
            raise ValueError(f"{place}: gravity must be that of the rig's branch, {self.gravity:g}, got {g:g}; follow it anew")
        height = height_of(place, conical_height, angular_speed, g)
        return tuple(self._shape(found, g) for found in self._found().states_at(height))

    def stability_windows(
        self, *, frame: str = "free", tolerance: float = 1e-6, samples: int = 8
    ) -> list[StabilityWindow]:
        """Return the windows of stability along the branch.

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
            If `frame` is another word, `tolerance` is not positive or `samples` is below 1.

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
        place = "revchain.Branch.stability_windows"
        driven = is_driven(place, frame)
        wide = one_positive(place, "tolerance", tolerance)
        places = min(count(place, "samples", samples), 10**6)
        found = _core.stability_windows(self._compiled(), self._found(), driven, wide, places)
        return [StabilityWindow._made(None, verdict=verdict, conical_height=(h0, h1), arc=(s0, s1)) for s0, s1, h0, h1, verdict in found]

    def plot(self, ax: Axes | None = None, *, quantity: str = "tip_inclination") -> Axes:
        """Draw a quantity of the branch against the speed divided by the first critical speed; folds are marked.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.
        quantity : {"tip_inclination", "tip_radius", "top_tension", "moment_of_inertia", "effective_energy"}
            Quantity to draw; an inclination is in degrees.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing.

        Raises
        ------
        ValueError
            If `quantity` is another word.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1).plot()
        >>> ax.get_ylabel()
        'tip inclination (degrees)'
        """
        from ..plots.branches import plot_branches

        return plot_branches([self], _first_height([self]), ax, quantity=quantity, place="revchain.Branch.plot")

    @property
    def _per(self) -> float:
        return self.system._force(self.gravity)

    def __len__(self) -> int:
        return int(self.arc.size)

    def _shape(self, found: _core.SteadyShape, gravity: float) -> SteadyShape:
        return SteadyShape._made(found, system=self.system, gravity=gravity, direction=self.direction)

    def _compiled(self) -> Any:
        return self.system._under(self.gravity) if isinstance(self.system, Rig) else self.system._compiled

    def _from_parts(self) -> _core.Branch:
        core = self._compiled()
        if len(self.asked) == 4:
            found: _core.Branch = _core.branch(core, *self.asked, self.gravity, self.direction)
            return found
        height, lists, budget, proof_budget, place = self.asked
        diagram = _core.branches(core, height, lists, budget, proof_budget, self.gravity, self.direction)
        found = diagram.branches[place]
        return found

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("point", np.arange(len(self)), "point"),
            Column("angular_speed", self.angular_speed, "speed (rad/s)"),
            Column("conical_height", self.conical_height, "height (m)"),
            Column("tip_inclination", self.tip_inclination, "tip (°)", shown=np.degrees(self.tip_inclination)),
            Column("tip_radius", self.tip_radius, "tip radius (m)"),
            Column("top_tension", self.top_tension, "top tension"),
            Column("half_waves", self.half_waves, "half waves"),
            Column("fold", is_fold(self), "fold"),
            Column("moment_of_inertia", self.moment_of_inertia),
            Column("effective_energy", self.effective_energy),
            Column("arc", self.arc),
        ]
        name = "from rest" if self.birth == "rest" else "isolated" if self.mode is None else f"of mode {self.mode}"
        heading = f"Branch {name}: {fold_words(self)}"
        names = ("mode", "birth", "end", "gravity", "direction")
        facts = {each: getattr(self, each) for each in names}
        return Sheet("point", heading, columns, facts, spread=True)


class Branches(Results[Branch], Moving):
    """All branches found down to one conical height; returned by `branches`.

    The branches of the modes come first, slowest first; with the support off the axis it is the branch from rest. The
    isolated branches, which start at folds, follow.

    Examples
    --------
    >>> import revchain as rc
    >>> diagram = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), min_conical_height=0.04)
    >>> [each.mode for each in diagram], diagram.complete
    ([1, 2, 3, None], True)
    """

    __slots__ = ()
    system: Field[Chain | Rig] = Field("The chain or rig.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.")
    direction: Field[int] = Field("Direction of rotation, 1 or -1; only a rig with flywheels depends on it.")
    consistent: Field[bool] = Field(
        "Whether at each of the speeds `looked_at` the list is proved and each of its shapes lies on exactly one branch.",
    )
    complete: Field[bool] = Field(
        "Whether it is also proved that no branch is missing, even a closed one between two of these speeds."
    )
    looked_at: Field[Floats] = Field("Conical heights at which all shapes were listed, m, descending.")
    remark: Field[str] = Field("A sentence that says what may be missing.")

    def plot(self, ax: Axes | None = None, *, quantity: str = "tip_inclination") -> Axes:
        """Draw the bifurcation diagram: a quantity of each branch against the speed divided by the first critical speed.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.
        quantity : {"tip_inclination", "tip_radius", "top_tension", "moment_of_inertia", "effective_energy"}
            Quantity to draw; an inclination is in degrees.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing. Colours show half waves. Isolated branches are dashed, with the speed at which each starts. The
            title says whether the diagram is `complete`.

        Raises
        ------
        ValueError
            If `quantity` is another word.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), min_conical_height=0.04).plot()
        >>> ax.get_xlabel()
        'speed / first critical speed'
        """
        from ..plots.branches import plot_branches

        ax = plot_branches(self, _first_height(self), ax, quantity=quantity, place="revchain.Branches.plot")
        if not self:
            ax.set_title("no shape at or above this conical height")
        else:
            ax.set_title("all branches: proved complete" if self.complete else "branches found: not proved complete")
        return ax

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("branch", np.arange(len(self)), "branch"),
            Column("mode", [_born(each) for each in self], "mode"),
            *branch_sizes(self),
        ]
        isolated = sum(each.mode is None for each in self)
        begin = "from rest" if self and self[0].birth == "rest" else "from the vertical"
        heading = f"Branches: {len(self) - isolated} {begin}, {isolated} isolated; {self.remark}"
        names = ("gravity", "direction", "consistent", "complete", "remark", "looked_at")
        return Sheet("branch", heading, columns, {name: getattr(self, name) for name in names}, good=self.complete)


def branches_made(found: _core.Branches, asked: tuple[Any, ...], **given: Any) -> Branches:
    """The list of compiled branches; `given` holds the system, gravity and direction."""
    items = branch_items(Branch, found.branches, asked, given)
    return Branches._made(found, _items=items, **given)


def branch_items(
    kind: type[AnyBranch], found: list[Any], asked: tuple[Any, ...], given: dict[str, Any]
) -> tuple[AnyBranch, ...]:
    """The branches from compiled ones; the data to repeat the question of each end with its index."""
    return tuple(kind._made(each, asked=(*asked, k), **given) for k, each in enumerate(found))


def is_fold(branch: Any) -> NDArray[np.bool_]:
    """Whether each point of a branch is a fold."""
    fold = np.zeros(len(branch), bool)
    fold[branch.folds] = True
    return fold


def fold_words(branch: Any) -> str:
    """Text with the number of points and folds of a branch, and its end."""
    many = branch.folds.size
    folds = f", {many} fold{'s' * (many != 1)}" if many else ""
    return f"{len(branch)} points{folds}, ends at {branch.end}"


def branch_sizes(branches: Sequence[Any]) -> list[Column]:
    """The columns that all lists of branches have."""
    return [
        Column("points", [len(each) for each in branches], "points"),
        Column("folds", [int(each.folds.size) for each in branches], "folds"),
        Column("lowest_speed", [float(each.angular_speed.min()) for each in branches], "lowest speed (rad/s)"),
        Column("highest_speed", [float(each.angular_speed.max()) for each in branches], "highest speed (rad/s)"),
        Column("end", [each.end for each in branches], "ends at"),
    ]


def _born(branch: Branch) -> str:
    return "rest" if branch.birth == "rest" else "isolated" if branch.mode is None else str(branch.mode)


def _first_height(of: Sequence[Branch] | Branches) -> float:
    """The conical height of the slowest mode; if a rig has none, the greatest height of a branch."""
    one = of if isinstance(of, Branches) else of[0]
    system = one.system
    if isinstance(system, Rig):
        modes = _core.rig_modes(system._under(one.gravity), 1, 1, None, None, None, False, one.gravity)
        heights = modes.conical_height[modes.direction == (one.direction if modes.has_momentum else 1)]
        return float(heights[0]) if heights.size else max(float(each.conical_height.max()) for each in of)
    if isinstance(system, Cord):
        return float(_core.cord_modes(system._compiled, 1, 1, None, None, None).conical_height[0])
    found = _core.modes(system._compiled, 1, 1, None, None, None, False, "double", "auto")
    return float(found.conical_height[0])
