# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes: followed from each critical speed, and single shapes on them."""

from __future__ import annotations

from typing import Any, Literal, TypedDict, Unpack, overload

from .. import _core
from ..results.bent import CordShape, HeldCordShape, HeldShape
from ..results.branches import Branch, Branches, branches_made
from ..results.cord_branches import CordBranch, CordBranches
from ..results.held_branches import HeldBranch, HeldBranches
from ..results.shapes import SteadyShape
from ..systems.chain import Chain, compiled
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import (
    STANDARD_GRAVITY,
    boolean,
    count,
    exactly_one,
    height_of,
    integer,
    limit,
    one_positive,
    shown,
)
from ..systems.rig import Rig
from ..systems.system import System
from .cords import cord_branch, cord_branches, cord_shapes_on_branch
from .held import held_branch, held_branches, held_shape
from .refuse import no_system


class _Path(TypedDict, total=False):
    max_angular_speed: float | None
    min_conical_height: float | None
    gravity: float
    direction: int
    max_points: int
    max_step: float


@overload
def branch(system: Chain | Rig, mode: int, **path: Unpack[_Path]) -> Branch: ...
@overload
def branch(system: Cord, mode: int, **path: Unpack[_Path]) -> CordBranch: ...
@overload
def branch(system: Held, mode: int, **path: Unpack[_Path]) -> HeldBranch: ...
def branch(
    system: Chain | Rig | Cord | Held,
    mode: int,
    *,
    max_angular_speed: float | None = None,
    min_conical_height: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    direction: int = 1,
    max_points: int = 10_000,
    max_step: float = 0.1,
) -> Branch | CordBranch | HeldBranch:
    """Follow the branch of shapes that leaves the vertical at one critical speed, through every fold.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        A chain of N links, by itself or rigged; a flexible cord; either held at both ends a span apart. Along the branch
        of a rig every link keeps its posture.
    mode : int
        Number of the mode, from 1, the slowest. Of a rig whose support is off the axis it must be 1, the branch from
        rest; `branches` finds the isolated ones. Of what is held it is the number of half waves at the start of the
        branch.
    max_angular_speed : float
        The speed at which to stop, rad/s, above that of the mode. The branch of what is held begins at this speed and
        goes to slower ones.
    min_conical_height : float
        Instead of `max_angular_speed`: the conical height of that speed, m.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Of rotation. Only a rig with flywheels depends on it.
    max_points : int, optional
        Largest number of points; there ``end`` is ``budget``. Not used for what is held: that stops after 3000 steps.
    max_step : float, optional
        Largest step between two points: of the arc, which has no unit (see ``Branch.arc``); of what is held the
        relative change of the forces at its end and of the conical height.

    Returns
    -------
    Branch, CordBranch or HeldBranch
        The points of the branch, from the critical speed of the mode to the speed given. The first point is the
        straight chain. If double precision cannot separate the end from it, it is the only one (``end`` is then
        ``stuck``). Of a rig whose support is off the axis: from a tenth of the first critical speed of the rig with its
        support in the axis, or of the speed given if that is slower. Of what is held: until a link becomes slack,
        or a cord folds.
        Accuracy: numbers to 1e-12; folds to 1e-6 of the arc, their heights to 1e-13, of a cord to 1e-9.

    Raises
    ------
    ValueError
        If there is no such mode (of a support off the axis: if `mode` is not 1), if not exactly one of
        `max_angular_speed` and `min_conical_height` is given, if the speed is not above that of the mode, or if
        `direction` is neither 1 nor -1. For a `Held`: if it is held by a tension or has no gravity.

    Notes
    -----
    Pseudo-arclength continuation in all inclinations and the height. A step is halved unless Newton's method contracts
    at once, the direction turns little, the middle of the step lies on the branch too, and, where no link has
    ``pendulum_length > length``, the half waves stay the same. That is a check, not a proof. Of a cord: on the curve on
    which crossing `mode` of the axis is at the support.

    Examples
    --------
    >>> import revchain as rc
    >>> branch = rc.branch(rc.Chain.uniform_plummets(3, length=3.0), 3, min_conical_height=0.04)
    >>> branch.conical_height[[0, -1]].round(6), set(branch.half_waves.tolist())
    (array([0.158984, 0.04    ]), {3})

    A chair on an arm of 1 m, from rest to 3 rad/s:

    >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0))
    >>> chair = rc.branch(carousel, 1, max_angular_speed=3.0)
    >>> chair.birth, chair.tip_radius[[0, -1]].round(4)
    ('rest', array([1.0101, 4.9048]))
    """
    place = "revchain.branch"
    if not isinstance(system, System):
        raise no_system(place, system)
    number = count(place, "mode", mode)
    height = height_of(place, min_conical_height, max_angular_speed, gravity, "min_conical_height", "max_angular_speed")
    points = count(place, "max_points", max_points)
    step = one_positive(place, "max_step", max_step)
    asked = (number, height, points, step)
    g, turns = one_positive(place, "gravity", gravity), _direction(place, direction)
    if isinstance(system, Held):
        return held_branch(place, system, number, height, g, step)
    if isinstance(system, Cord):
        return cord_branch(system, g, asked)
    found = _core.branch(_system(place, system, g), *asked, g, turns)
    return Branch._made(found, system=system, gravity=g, direction=turns, asked=asked)


class _Diagram(TypedDict, total=False):
    max_angular_speed: float | None
    min_conical_height: float | None
    gravity: float
    direction: int
    lists: int
    budget: int
    proof_budget: int


@overload
def branches(system: Chain | Rig, **diagram: Unpack[_Diagram]) -> Branches: ...
@overload
def branches(system: Cord, **diagram: Unpack[_Diagram]) -> CordBranches: ...
@overload
def branches(system: Held, **diagram: Unpack[_Diagram]) -> HeldBranches: ...
def branches(
    system: Chain | Rig | Cord | Held,
    *,
    max_angular_speed: float | None = None,
    min_conical_height: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    direction: int = 1,
    lists: int = 16,
    budget: int = 3_000_000,
    proof_budget: int = 1_000_000,
) -> Branches | CordBranches | HeldBranches:
    """Find all branches of steady shapes up to a speed, isolated ones too; ``complete``: proved, none is missing.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        A chain or a rig of few links, as all shapes are listed (`steady_shapes`), those of a rig in its own posture. Or
        a flexible cord. Or either held at both ends a span apart: of that only the branches are found that begin with
        the nearly straight chain, and `lists`, `budget` and `proof_budget` are not used.
    max_angular_speed : float
        The speed up to which to go, rad/s.
    min_conical_height : float
        Instead of `max_angular_speed`: the conical height down to which to go, m.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Of rotation. Only a rig with flywheels depends on it.
    lists : int, optional
        Number of speeds at which all shapes are listed and matched with the branches.
    budget : int, optional
        Work allowed for each list; see `steady_shapes`. Cords have none.
    proof_budget : int, optional
        Links to look at for the proof, 0.1 to 1 microsecond each; 0: no proof. Cords have none.

    Returns
    -------
    Branches, CordBranches or HeldBranches
        A sequence of branches: those that leave the vertical, slowest first (of a rig whose support is off the axis the
        one from rest), then isolated ones, which are born in a fold, slowest first. Of what is held by half waves.
        Of a cord ``complete`` is true where a theorem counts the shapes (see `steady_shapes`) and every branch was
        followed to its end. What is held has no ``complete``: `steady_shapes` proves the list of a chain at one speed.

    Raises
    ------
    ValueError
        If not exactly one of `max_angular_speed` and `min_conical_height` is given, or a number is out of its range; if
        a link of a rig has no effective tension at a speed looked at. For a `Held`: if it is held by a tension or
        has no gravity.

    Notes
    -----
    A shape of a list that matches no branch lies on an isolated branch, which is followed from there both ways.
    ``consistent`` is true where every list is proved complete and each of its shapes matches exactly one branch.

    Loops can open and close between two of the speeds. The plane of conical heights and tangents of the lowest
    link is therefore split, in interval arithmetic, until in each part there is no fold, or all shapes lie on
    one curve through a branch that is known; loops found so are followed. ``complete`` is true where that succeeds for
    every part. Where links could hang at several inclinations it is false. It rests on `branch`: that a branch that was
    followed is where it seems to be is checked at every step, not proved.

    Of rigs the proof covers those whose links all hang in tension at every speed up to the one given: on springs, on an
    arm, with flywheels, in fluids. Below the first critical speed such a rig has exactly one shape off the axis, and
    none but the straight one in it. Where stiffness times conical height is less than the weight that moves, a spring
    at the support cannot balance it, and nothing is proved; ``remark`` says at which heights.

    Measured, down to a conical height of 1/200 of the length: three links 4 to 8 ms, five 15 ms, six 30 ms. Eight equal
    plummets on threads of length a, to 5 sqrt(g/a): 0.1 s; twenty rods, 1 m in all, to 20 rad/s: 0.05 s.

    Examples
    --------
    >>> import revchain as rc
    >>> diagram = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), max_angular_speed=5.0, gravity=1.0)
    >>> len(diagram), diagram.consistent, diagram.complete
    (4, True, True)
    >>> born = diagram[3]
    >>> round(born.angular_speed[born.folds[0]], 10)
    np.float64(3.9037621569)

    A carousel: the way from rest outwards, and the pair of shapes inwards that is born at a fold:

    >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0))
    >>> diagram = rc.branches(carousel, max_angular_speed=4.0)
    >>> [each.birth for each in diagram], diagram.complete
    (['rest', 'fold'], True)
    >>> round(float(diagram[1].angular_speed.min()), 4)
    2.2878
    """
    place = "revchain.branches"
    if not isinstance(system, System):
        raise no_system(place, system)
    height = height_of(place, min_conical_height, max_angular_speed, gravity, "min_conical_height", "max_angular_speed")
    at = min(count(place, "lists", lists), 10**6)
    most, most_of_proof = limit(place, "budget", budget), limit(place, "proof_budget", proof_budget)
    asked = (height, at, most, most_of_proof)
    g, turns = one_positive(place, "gravity", gravity), _direction(place, direction)
    if isinstance(system, Held):
        return held_branches(place, system, height, g)
    if isinstance(system, Cord):
        return cord_branches(system, g, (height, at))
    found = _core.branches(_system(place, system, g), *asked, g, turns)
    return branches_made(found, asked, system=system, gravity=g, direction=turns)


class _Wanted(TypedDict, total=False):
    mode: int
    conical_height: float | None
    angular_speed: float | None
    tip_inclination: float | None
    tip_radius: float | None
    top_tension: float | None
    gravity: float
    direction: int
    min_conical_height: float | None


@overload
def steady_shape(system: Chain | Rig, *, all: Literal[False] = ..., **wanted: Unpack[_Wanted]) -> SteadyShape: ...
@overload
def steady_shape(system: Chain | Rig, *, all: Literal[True], **wanted: Unpack[_Wanted]) -> tuple[SteadyShape, ...]: ...
@overload
def steady_shape(system: Cord, *, all: Literal[False] = ..., **wanted: Unpack[_Wanted]) -> CordShape: ...
@overload
def steady_shape(system: Cord, *, all: Literal[True], **wanted: Unpack[_Wanted]) -> tuple[CordShape, ...]: ...
@overload
def steady_shape(system: Held, *, all: Literal[False] = ..., **wanted: Unpack[_Wanted]) -> HeldShape | HeldCordShape: ...
def steady_shape(
    system: Chain | Rig | Cord | Held,
    *,
    mode: int = 1,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    tip_inclination: float | None = None,
    tip_radius: float | None = None,
    top_tension: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    direction: int = 1,
    all: bool = False,
    min_conical_height: float | None = None,
) -> SteadyShape | CordShape | HeldShape | HeldCordShape | tuple[SteadyShape, ...] | tuple[CordShape, ...]:
    """Find the shape on the branch of one mode at a speed, or the speed at which the shape is as wanted.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        A chain of N links, up to 100,000 and more, by itself or rigged; a flexible cord; either held at both ends a span
        apart.
    mode : int, optional
        Number of the mode at which the branch leaves the vertical, from 1, the slowest. Of a rig whose support is off
        the axis it must be 1, the branch from rest; shapes of other branches: `Branch.at` of those that `branches`
        finds. Of what is held it is the number of half waves with which the branch begins at great speed.
    conical_height : float
        Conical height of the speed, m, less than that of the mode.
    angular_speed : float
        Instead: the speed in rad/s.
    tip_inclination : float
        Instead: the inclination of the lowest link, of a cord of its free end, rad, between 0 and pi/2, of either sign;
        of a link that stands between pi/2 and pi; outwards if the support is off the axis.
    tip_radius : float
        Instead: the distance of the free end from the axis, m; on either side.
    top_tension : float
        Instead: the tension at the topmost pin, more than the weight that it bears: N, or of systems by weight in its
        unit. Of what is held at its upper end.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Of rotation. Only a rig with flywheels depends on it.
    all : bool, optional
        All shapes on the branch that fit, as a tuple, which is empty where there is none. Otherwise the first one.
    min_conical_height : float, optional
        The conical height at which the search ends, m, less than that of the mode. Left out, with `all` and a speed:
        half of its height; else 1e-6 of that of the mode. Not used for what is held.

    Returns
    -------
    SteadyShape, CordShape, HeldShape, HeldCordShape or tuple of them
        Inclinations are within ``error_bound``, which is proved except at a fold (measured: 2.3e-16); of a cord within
        ``error_estimate``. That the shape is on this branch is checked at every step, see `branch`. Of what is held: at
        a speed the shape that is reached from the nearly straight chain; with a top tension the fastest one on the
        branch that has it.

    Raises
    ------
    ValueError
        If there is no such mode, if not exactly one number is given or it is out of its range, if `direction` is
        neither 1 nor -1, if `min_conical_height` is not below the height of the mode, if the branch does not exist yet
        at that speed, or, unless `all`, if what is given is not met on it. For a `Held`: if it is held by a tension or
        has no gravity, and for `tip_inclination`, `tip_radius` and ``all=True``.
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

    The speed at which a chair of a carousel is 2.5 m from the axis:

    >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0))
    >>> round(rc.steady_shape(carousel, tip_radius=2.5).angular_speed, 4)
    1.2597
    """
    place = "revchain.steady_shape"
    if not isinstance(system, System):
        raise no_system(place, system)
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
    turns = _direction(place, direction)
    if isinstance(system, Held):
        return held_shape(place, system, number, name, value, g, all)
    if name == "top_tension":
        if isinstance(system, (Chain, Cord)) and not value > (least := system._force(g) * _weight(system)):
            what = "cord" if isinstance(system, Cord) else "chain"
            raise ValueError(f"{place}: top_tension must be more than the weight {least:.6g} of the {what}, got {value:g}")
        value /= system._force(g)
    every = boolean(place, "all", all)
    lowest = None if min_conical_height is None else one_positive(place, "min_conical_height", min_conical_height)
    if isinstance(system, Cord):
        of_cord = cord_shapes_on_branch(system, number, name, value, g, lowest, every)
        return of_cord if every else of_cord[0]
    asked = (_system(place, system, g), number, name, value, g, turns, lowest)
    found = _core.shapes_on_branch(*asked) if every else [_core.steady_shape(*asked)]
    shapes = tuple(SteadyShape._made(shape, system=system, gravity=g, direction=turns) for shape in found)
    return shapes if every else shapes[0]


def _weight(system: Chain | Cord) -> float:
    """Of all that hangs, in the unit of the weights or masses given."""
    if isinstance(system, Cord):
        return system._compiled.weight + system._compiled.tip_weight
    return system._compiled.total_weight


def _direction(place: str, direction: int) -> int:
    if integer(place, "direction", direction) not in (1, -1):
        raise ValueError(f"{place}: direction must be 1 or -1, got {shown(direction)}")
    return int(direction)


def _system(place: str, system: Chain | Rig, gravity: float) -> Any:
    """The compiled chain or rig."""
    return system._under(gravity) if isinstance(system, Rig) else compiled(place, system)
