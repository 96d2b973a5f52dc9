# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes: followed from each critical speed, and single shapes on them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, overload

from .. import _core
from ..closed_forms import conical_pendulum
from ..results.base import Wrapped, WrappedList
from ..results.shapes import SteadyShape, is_driven
from ..systems.chain import Chain, compiled
from ..systems.numbers import (
    STANDARD_GRAVITY,
    Floats,
    Whole,
    boolean,
    count,
    exactly_one,
    height_of,
    integer,
    limit,
    one_positive,
)
from .modes import modes

if TYPE_CHECKING:
    from matplotlib.axes import Axes


@dataclass(frozen=True, slots=True)
class StabilityWindow:
    """A part of a branch throughout which a small disturbance is seen to fare alike.

    Attributes
    ----------
    verdict : str
        ``minimum``, ``spectrally stable``, ``unstable`` or ``undecided``, as `Stability` says.
    conical_height : tuple of two floats
        At both ends, the one nearer to the start of the branch first.
    arc : tuple of two floats
        At the same ends.
    """

    verdict: str
    conical_height: tuple[float, float]
    arc: tuple[float, float]


class Branch(Wrapped[_core.Branch, Chain]):
    """A branch of steady shapes, point by point along its arc, in the units of the chain.

    Returned by `branch`, and in what `branches` returns. Arrays have one number for each point.
    """

    __slots__ = ()

    @property
    def mode(self) -> int | None:
        """Number of the mode at which it leaves the vertical; None: an isolated branch."""
        return self._compiled.mode or None

    @property
    def arc(self) -> Floats:
        """Along the branch, from its first point.

        Measured by the root of the mean square of the links' ``d arsinh(tan(inclination))`` and the square of
        ``d log(conical_height)``.
        """
        return self._compiled.arc

    @property
    def conical_height(self) -> Floats:
        """Of the speed."""
        return self._compiled.conical_height

    @property
    def tip_inclination(self) -> Floats:
        """Of the lowest link to the vertical, rad.

        Of the two mirror images the branch is followed in one: that in which `modes` gives the mode; an isolated one
        in that with the free end at a positive offset where it begins. The sign is the lowest link's there; where
        it changes along the branch the link hangs vertically.
        """
        return self._compiled.tip_inclination

    @property
    def tip_radius(self) -> Floats:
        """Of the free end from the axis."""
        return self._compiled.tip_radius

    @property
    def top_tension(self) -> Floats:
        """Size of the reaction at the support."""
        return self._compiled.top_tension

    @property
    def moment_of_inertia(self) -> Floats:
        """About the axis, weight times length squared: divide by gravity for mass."""
        return self._compiled.moment_of_inertia

    @property
    def effective_energy(self) -> Floats:
        """Potential energy less half of ``moment_of_inertia / conical_height``."""
        return self._compiled.effective_energy

    @property
    def half_waves(self) -> Whole:
        """Sign changes of the offsets, and one."""
        return self._compiled.half_waves

    @property
    def folds(self) -> Whole:
        """Points at which the conical height turns, each located by itself: two shapes are born or meet there."""
        return self._compiled.folds

    @property
    def end(self) -> str:
        """Why it was not followed farther.

        ``height``: at the one asked for; ``closed``: back where it began; ``vertical``: back at the
        straight chain; ``budget``: after `max_points`; ``stuck``: no step passed every check.
        """
        return self._compiled.end

    def angular_speed(self, gravity: float = STANDARD_GRAVITY) -> Floats:
        """Return the speed at every point.

        Parameters
        ----------
        gravity : float, optional
            In the unit of length of the chain per s^2, positive; standard gravity in m/s^2 if left out.

        Returns
        -------
        ndarray
            In rad/s.

        Raises
        ------
        ValueError
            If `gravity` is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, conical_height=0.1)
        >>> branch.angular_speed()[[0, -1]].round(4)
        array([2.3968, 9.9029])
        """
        g = one_positive("revchain.Branch.angular_speed", "gravity", gravity)
        speed: Floats = conical_pendulum.angular_speed(self.conical_height, g)
        return speed

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
        >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, conical_height=0.1)
        >>> branch.shape(-1).inclination.round(4)
        array([1.5208, 1.5041])
        """
        place = "revchain.Branch.shape"
        wanted = integer(place, "point", point)
        if not -len(self) <= wanted < len(self):
            raise ValueError(f"{place}: point must be from {-len(self)} to {len(self) - 1}, got {wanted}")
        return _shape(self._compiled.shape(wanted % len(self)), self._given, STANDARD_GRAVITY)

    def at(
        self,
        *,
        conical_height: float | None = None,
        angular_speed: float | None = None,
        gravity: float = STANDARD_GRAVITY,
    ) -> tuple[SteadyShape, ...]:
        """Return the shapes at which the branch, as far as it was followed, passes a speed.

        Parameters
        ----------
        conical_height : float
            Of the speed, positive.
        angular_speed : float
            Instead of `conical_height`: the speed in rad/s, positive.
        gravity : float, optional
            For `angular_speed`; standard gravity, in metres, if left out.

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
        >>> branch = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, conical_height=0.1)
        >>> [shape.half_waves for shape in branch.at(conical_height=0.2)]
        [1]
        """
        height = height_of("revchain.Branch.at", conical_height, angular_speed, gravity)
        g = one_positive("revchain.Branch.at", "gravity", gravity)
        return tuple(_shape(s, self._given, g) for s in self._compiled.states_at(height))

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
        >>> for window in rc.branch(chain, 2, conical_height=0.1 * second).stability_windows():
        ...     print(window.verdict, round(window.conical_height[1] / second, 5))
        spectrally stable 0.46332
        unstable 0.1
        """
        place = "revchain.Branch.stability_windows"
        driven = is_driven(place, frame)
        wide = one_positive(place, "tolerance", tolerance)
        places = min(count(place, "samples", samples), 10**6)
        found = _core.stability_windows(self._given._compiled, self._compiled, driven, wide, places)
        return [StabilityWindow(verdict, (h0, h1), (s0, s1)) for s0, s1, h0, h1, verdict in found]

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
        >>> ax = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, conical_height=0.1).plot()
        >>> ax.get_ylabel()
        'tip inclination (degrees)'
        """
        from ..plots.branches import plot_branches

        return plot_branches([self], _first_height(self._given), ax, quantity=quantity, place="revchain.Branch.plot")

    def __len__(self) -> int:
        return int(self.arc.size)

    def __repr__(self) -> str:
        name = "isolated" if self.mode is None else f"of mode {self.mode}"
        folds = f", {self.folds.size} fold{'s' * (self.folds.size != 1)}" if self.folds.size else ""
        return f"Branch {name}: {len(self)} points{folds}, ends at {self.end}"


class Branches(WrappedList[Branch]):
    """All branches found down to one conical height: those of the modes, slowest first, then isolated ones."""

    __slots__ = ("_chain", "_compiled")
    _compiled: _core.Branches
    _chain: Chain

    @classmethod
    def _wrap(cls, compiled: _core.Branches, chain: Chain) -> Branches:
        result = object.__new__(cls)
        result._compiled, result._chain = compiled, chain
        result._items = tuple(Branch._wrap(each, chain) for each in compiled.branches)
        return result

    @property
    def consistent(self) -> bool:
        """Whether at every speed looked at each shape of the proved list was met by a branch, and met once."""
        return self._compiled.consistent

    @property
    def complete(self) -> bool:
        """Whether it is proved besides that no branch is missing, not even a loop between two of those speeds."""
        return self._compiled.complete

    @property
    def looked_at(self) -> Floats:
        """The conical heights of those speeds, descending."""
        return self._compiled.looked_at

    @property
    def remark(self) -> str:
        """What may be missing, in a sentence."""
        return self._compiled.remark

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
        >>> ax = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), conical_height=0.04).plot()
        >>> ax.get_xlabel()
        'speed over the first critical speed'
        """
        from ..plots.branches import plot_branches

        ax = plot_branches(self, _first_height(self._chain), ax, quantity=quantity, place="revchain.Branches.plot")
        if not self:
            ax.set_title("no shape at or above this conical height")
        else:
            ax.set_title("all branches: proved complete" if self.complete else "branches found: not proved complete")
        return ax

    def __repr__(self) -> str:
        isolated = sum(each.mode is None for each in self)
        return f"Branches: {len(self) - isolated} from the vertical, {isolated} isolated; {self.remark}"


def branch(
    chain: Chain,
    mode: int,
    *,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    max_points: int = 10_000,
    max_step: float = 0.1,
) -> Branch:
    """Follow the branch of shapes that leaves the vertical at one critical speed, through every fold.

    Parameters
    ----------
    chain : Chain
        The chain of N links.
    mode : int
        Number of the mode, from 1, the slowest.
    conical_height : float
        Where to stop: at the first point of this conical height, less than that of the mode.
    angular_speed : float
        Instead of `conical_height`: the speed in rad/s at which to stop.
    gravity : float, optional
        For `angular_speed`; standard gravity, in metres, if left out.
    max_points : int, optional
        After which to stop in any case.
    max_step : float, optional
        Between two points, along the arc.

    Returns
    -------
    Branch
        The first point is the straight chain, alone if no double tells the end from it (``end`` is then
        ``stuck``). Numbers to about 1e-12; folds to 1e-6 of the arc, their heights to 1e-13, mostly an ulp.

    Raises
    ------
    ValueError
        If there is no such mode, if not exactly one of `conical_height` and `angular_speed` is given, or if
        the speed is not above that of the mode.

    Notes
    -----
    Continuation by arc on all links and the height at once. A step is kept only if Newton's method
    contracts at once, the direction turns little, the middle of the step lies on the branch too, and, where no
    link has ``pendulum_length > length``, the half waves stay the same; else half of it is tried. That is a check,
    not a proof.

    Examples
    --------
    >>> import revchain as rc
    >>> branch = rc.branch(rc.Chain.uniform_plummets(3, length=3.0), 3, conical_height=0.04)
    >>> branch.conical_height[[0, -1]].round(6), set(branch.half_waves.tolist())
    (array([0.158984, 0.04    ]), {3})
    """
    place = "revchain.branch"
    number = count(place, "mode", mode)
    height = height_of(place, conical_height, angular_speed, gravity)
    points = count(place, "max_points", max_points)
    step = one_positive(place, "max_step", max_step)
    return Branch._wrap(_core.branch(compiled(place, chain), number, height, points, step), chain)


def branches(
    chain: Chain,
    *,
    up_to: float | None = None,
    conical_height: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    lists: int = 16,
    budget: int = 2_000_000,
    proof_budget: int = 1_000_000,
) -> Branches:
    """Find the whole diagram of branches up to a speed, isolated ones too, and prove that none is missing.

    Parameters
    ----------
    chain : Chain
        The chain of N links; few, as all shapes are listed (`steady_shapes`).
    up_to : float
        The speed, rad/s.
    conical_height : float
        Instead of `up_to`: the conical height down to which to go.
    gravity : float, optional
        For `up_to`; standard gravity, in metres, if left out.
    lists : int, optional
        At how many speeds to list all shapes and bring them together with the branches.
    budget : int, optional
        Of each list, as for `steady_shapes`.
    proof_budget : int, optional
        Links to look at for the proof, 1 to 4 microseconds each; 0: no proof.

    Returns
    -------
    Branches
        A sequence of `Branch`: those that leave the vertical, slowest first, then those that are born in a
        fold, slowest first.

    Raises
    ------
    ValueError
        If not exactly one of `up_to` and `conical_height` is given, or a number is out of its range.

    Notes
    -----
    A shape of a list that no branch meets lies on an isolated branch, which is followed from there both
    ways. ``consistent`` is true where every list is proved complete and each shape in it met once.

    Loops can open and close between two of the speeds. The plane of conical heights and tangents of the lowest
    link is therefore split, in interval arithmetic, until in each part there is no fold, or all shapes lie on
    one curve through a branch that is known; loops found so are followed. ``complete`` is true where
    no part resists. Links that could hang at several inclinations are left out: there it is false. It rests on
    `branch`: that a branch that was followed is where it seems to be is checked at every step, not proved.
    Measured, at heights of 1/200 of the length: three links 10 to 50 ms, five 0.1 to 0.3 s, six 0.2 to 0.6 s.

    Examples
    --------
    >>> import revchain as rc
    >>> diagram = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), up_to=5.0, gravity=1.0)
    >>> len(diagram), diagram.consistent, diagram.complete
    (4, True, True)
    >>> born = diagram[3]
    >>> round(born.angular_speed(1.0)[born.folds[0]], 10)
    np.float64(3.9037621569)
    """
    place = "revchain.branches"
    height = height_of(place, conical_height, up_to, gravity, speed_name="up_to")
    at = min(count(place, "lists", lists), 10**6)
    most, most_of_proof = limit(place, "budget", budget), limit(place, "proof_budget", proof_budget)
    return Branches._wrap(_core.branches(compiled(place, chain), height, at, most, most_of_proof), chain)


@overload
def steady_shape(
    chain: Chain,
    *,
    mode: int = ...,
    conical_height: float | None = ...,
    angular_speed: float | None = ...,
    tip_inclination: float | None = ...,
    tip_radius: float | None = ...,
    top_tension: float | None = ...,
    gravity: float = ...,
    all: Literal[False] = ...,
    min_conical_height: float | None = ...,
) -> SteadyShape: ...
@overload
def steady_shape(
    chain: Chain,
    *,
    mode: int = ...,
    conical_height: float | None = ...,
    angular_speed: float | None = ...,
    tip_inclination: float | None = ...,
    tip_radius: float | None = ...,
    top_tension: float | None = ...,
    gravity: float = ...,
    all: Literal[True],
    min_conical_height: float | None = ...,
) -> tuple[SteadyShape, ...]: ...
def steady_shape(
    chain: Chain,
    *,
    mode: int = 1,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    tip_inclination: float | None = None,
    tip_radius: float | None = None,
    top_tension: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    all: bool = False,  # noqa: A002: the word the question is asked in
    min_conical_height: float | None = None,
) -> SteadyShape | tuple[SteadyShape, ...]:
    """Find the shape on the branch of one mode at a speed, or the speed at which the shape is as wanted.

    Parameters
    ----------
    chain : Chain
        The chain of N links, up to 100,000 and more.
    mode : int, optional
        At which the branch leaves the vertical, from 1, the slowest.
    conical_height : float
        Of the speed, less than that of the mode.
    angular_speed : float
        Instead: the speed in rad/s.
    tip_inclination : float
        Instead: that of the lowest link, rad, above 0 and below pi/2; its size, whatever the sign.
    tip_radius : float
        Instead: the free end's distance from the axis, its size too.
    top_tension : float
        Instead: the size of the reaction at the support, more than the weight of the chain.
    gravity : float, optional
        For `angular_speed`; standard gravity, in metres, if left out.
    all : bool, optional
        All states met along the branch, in a tuple, not the first from the vertical alone; the tuple
        is empty where none is met.
    min_conical_height : float, optional
        The conical height at which the search ends, less than that of the mode; 1e-6 of that of the mode if
        left out, with `all` and a speed the half of its height.

    Returns
    -------
    SteadyShape or tuple of SteadyShape
        Inclinations to 2.3e-16 at a given height or speed (measured), and within ``error_bound``, proved but at
        a fold. That the state is on this branch is checked at every step, see `branch`.

    Raises
    ------
    ValueError
        If there is no such mode, if not exactly one number is given or it is out of its range, if
        `min_conical_height` is not below the height of the mode, if the branch does not exist yet at that speed, or,
        unless `all`, if what is given is not met on it.
    TypeError
        If `all` is not a bool.

    Notes
    -----
    Cost: O(N); 0.4 s for 100,000 rods at twice the first critical speed.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain.uniform_rods(120, length=0.36)
    >>> shape = rc.steady_shape(chain, mode=2, angular_speed=20.0)
    >>> shape.half_waves, round(shape.angular_speed, 9)
    (2, 20.0)
    >>> again = rc.steady_shape(chain, mode=2, tip_radius=shape.offset[0])
    >>> round((9.80665 / again.conical_height) ** 0.5, 9)
    20.0
    """
    place = "revchain.steady_shape"
    number = count(place, "mode", mode)
    name, value = exactly_one(
        place,
        conical_height=conical_height,
        angular_speed=angular_speed,
        tip_inclination=tip_inclination,
        tip_radius=tip_radius,
        top_tension=top_tension,
    )
    g = one_positive(place, "gravity", gravity)
    every = boolean(place, "all", all)
    lowest = None if min_conical_height is None else one_positive(place, "min_conical_height", min_conical_height)
    core = compiled(place, chain)
    if not every:
        return _shape(_core.steady_shape(core, number, name, value, g, lowest), chain, g)
    found = _core.shapes_on_branch(core, number, name, value, g, lowest)
    return tuple(_shape(shape, chain, g) for shape in found)


def _shape(found: _core.SteadyShape, chain: Chain, gravity: float) -> SteadyShape:
    return SteadyShape._made(found, system=chain, gravity=gravity, direction=1)


def _first_height(chain: Chain) -> float:
    """The conical height of the slowest mode."""
    return float(modes(chain, 1).conical_height[0])
