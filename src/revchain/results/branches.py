# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes and the windows of stability along them."""

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
    """A part of a branch along which the verdict on stability is the same."""

    __slots__ = ()
    verdict: Field[str] = Field("``'minimum'``, ``'spectrally stable'``, ``'unstable'`` or ``'undecided'``.", part=True)
    conical_height: Field[Pair] = Field("At both ends, m; the one nearer to the start of the branch first.", part=True)
    arc: Field[Pair] = Field("Along the branch, at the same ends.", part=True)

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("end", ["start", "end"], "at"),
            Column("conical_height", np.array(self.conical_height), "height (m)"),
            Column("arc", np.array(self.arc), "along the branch"),
        ]
        return Sheet("end", f"Stability window: {self.verdict}", columns, {"verdict": self.verdict})


class Branch(Result, Moving):
    """A branch of steady shapes, point by point along its arc; returned by `branch` and in what `branches` returns.

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
    system: Field[Chain | Rig] = Field("The chain or rig.", part=True)
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", part=True)
    direction: Field[int] = Field("1 or -1: of the rotation; it matters to flywheels.", part=True)
    mode: Field[int | None] = Field(
        "Number of the mode at which it leaves the vertical; 1 from rest; None for an isolated branch.",
        lambda b: b._found().mode or None,
        part=True,
    )
    birth: Field[str] = Field(
        "``'vertical'``: it leaves the straight chain at a critical speed; ``'rest'``: it begins at rest, the support being "
        "off the axis; ``'fold'``: it is isolated, two shapes are born in a fold.",
        part=True,
    )
    arc: Field[Floats] = Field(
        "Along the branch, from its first point: measured by the root of the mean square of the links' "
        "``d arsinh(tan(inclination))`` and the square of ``d log(conical_height)``.",
        part=True,
    )
    conical_height: Field[Floats] = Field("Conical height of the speed, m.", part=True)
    angular_speed: Field[Floats] = Field("Speed at every point, rad/s.", lambda b: np.sqrt(b.gravity / b.conical_height))
    tip_inclination: Field[Floats] = Field(
        "Inclination of the lowest link to the vertical, rad. Of the two mirror images the branch is followed in one: that "
        "in which `modes` gives the mode; an isolated branch in that with the free end at a positive offset where it "
        "begins. Where the sign changes along the branch the link hangs vertically. If the support is off the axis there "
        "are no mirror images: outwards is positive.",
        part=True,
    )
    tip_radius: Field[Floats] = Field("Offset of the free end from the axis, m, with its sign.", part=True)
    top_tension: Field[Floats] = Field(
        "Size of the reaction at the topmost pin, N or in the unit of the weights.", forced("top_tension"), part=True
    )
    moment_of_inertia: Field[Floats] = Field(
        "About the axis, kg m^2; of a chain given by weight, weight times length squared.", part=True
    )
    effective_energy: Field[Floats] = Field(
        "Potential energy less half of moment of inertia times speed squared, J.", forced("effective_energy"), part=True
    )
    half_waves: Field[Whole] = Field("Sign changes of the offsets, plus one.", part=True)
    folds: Field[Whole] = Field(
        "Points at which the conical height turns, each located by itself: two shapes are born or meet there.", part=True
    )
    end: Field[str] = Field(
        "Why it was not followed farther: ``'height'``: at the one asked for; ``'closed'``: back where it began; "
        "``'vertical'``: back at the straight chain; ``'budget'``: after `max_points`; ``'stuck'``: no step passed every "
        "check; ``'slow'``: on the way to rest; ``'slack'``: flywheels take the tension from a link, which comes to the "
        "horizontal; ``'loose'``: the spring at the support no longer holds the whole.",
        part=True,
    )
    asked: Field[tuple[Any, ...]] = Field("The numbers it was asked with, for shapes that are asked for later.", part=True)

    def shape(self, point: int) -> SteadyShape:
        """Return the whole shape at a point.

        Parameters
        ----------
        point : int
            Which; negative ones count from the end.

        Returns
        -------
        SteadyShape
            Balanced in two words. Its ``error_bound`` is proved, but at a fold, where it is an estimate.

        Raises
        ------
        ValueError
            If there is no such point, or it is the straight chain, where the branch of a mode begins.

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
        """Return the shapes at which the branch, as far as it was followed, passes a speed.

        Parameters
        ----------
        conical_height : float
            Of the speed, positive.
        angular_speed : float
            Instead of `conical_height`: the speed in rad/s, positive.
        gravity : float, optional
            In m/s^2; that of the branch if left out. A rig has no other: what springs and wheels do depends on it.

        Returns
        -------
        tuple of SteadyShape
            In the order of the arc; empty where it does not pass there.

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
        """Say where along the branch small disturbances grow and where not.

        Parameters
        ----------
        frame : {"free", "driven"}, optional
            As for `SteadyShape.stability`.
        tolerance : float, optional
            Of the edges, relative in conical height and absolute in arc.
        samples : int, optional
            Places looked at between two points of the branch, one end counted.

        Returns
        -------
        list of StabilityWindow
            In the order of the arc. They cover the branch but for the vertical and the way from there to the
            first point. Edges are located by halving; a window shorter than the places are apart can be missed.

        Raises
        ------
        ValueError
            If `frame` is neither, `tolerance` is not positive or `samples` is below 1.

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
        """Draw a number of the branch against the speed over the first critical one; folds are marked.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        quantity : {"tip_inclination", "tip_radius", "top_tension", "moment_of_inertia", "effective_energy"}
            What to draw; inclinations in degrees.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If `quantity` is none of these.
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

    def _again(self) -> _core.Branch:
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
    """All branches found down to one conical height: those of the modes, slowest first, then isolated ones.

    Of a rig whose support is off the axis: the one from rest, then those born in folds.
    """

    __slots__ = ()
    system: Field[Chain | Rig] = Field("The chain or rig.", part=True)
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", part=True)
    direction: Field[int] = Field("1 or -1: of the rotation; it matters to flywheels.", part=True)
    consistent: Field[bool] = Field(
        "Whether at every speed looked at each shape of the proved list was met by a branch, and met once.", part=True
    )
    complete: Field[bool] = Field(
        "Whether it is proved besides that no branch is missing, not even a loop between two of those speeds.", part=True
    )
    looked_at: Field[Floats] = Field("The conical heights of those speeds, m, descending.", part=True)
    remark: Field[str] = Field("What may be missing, in a sentence.", part=True)

    def plot(self, ax: Axes | None = None, *, quantity: str = "tip_inclination") -> Axes:
        """Draw the diagram: a number of every branch against the speed over the first critical one.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        quantity : {"tip_inclination", "tip_radius", "top_tension", "moment_of_inertia", "effective_energy"}
            What to draw; inclinations in degrees.

        Returns
        -------
        matplotlib.axes.Axes
            Coloured by half waves; isolated branches dashed, with the speed at which each is born. The title
            says whether the diagram is `complete`.

        Raises
        ------
        ValueError
            If `quantity` is none of these.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), min_conical_height=0.04).plot()
        >>> ax.get_xlabel()
        'speed over the first critical speed'
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
    """A list around compiled branches; `given`: the system, gravity and direction."""
    items = branch_items(Branch, found.branches, asked, given)
    return Branches._made(found, _items=items, **given)


def branch_items(
    kind: type[AnyBranch], found: list[Any], asked: tuple[Any, ...], given: dict[str, Any]
) -> tuple[AnyBranch, ...]:
    """Branches around compiled ones; how each is asked for again ends with its place in the list."""
    return tuple(kind._made(each, asked=(*asked, k), **given) for k, each in enumerate(found))


def is_fold(branch: Any) -> NDArray[np.bool_]:
    """Of each point of a branch."""
    fold = np.zeros(len(branch), bool)
    fold[branch.folds] = True
    return fold


def fold_words(branch: Any) -> str:
    """How many points and folds a branch has, and where it ends."""
    many = branch.folds.size
    folds = f", {many} fold{'s' * (many != 1)}" if many else ""
    return f"{len(branch)} points{folds}, ends at {branch.end}"


def branch_sizes(branches: Sequence[Any]) -> list[Column]:
    """Columns of a list of branches that all kinds have."""
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
    """The conical height of the slowest mode; of a rig that has none the greatest height of a branch."""
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
