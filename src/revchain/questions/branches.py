# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes that start at the critical speeds, and single shapes on them."""

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
    """Return the branch of steady shapes that leaves the vertical at one critical speed, followed through every fold.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system: a chain of N links, a rig, a cord, or a chain or cord held at a span. Along the branch of a rig each
        link keeps its posture (hanging or inverted).
    mode : int
        Number of the mode, from 1 for the slowest. A rig with its support off the axis has only mode 1, the branch from
        rest; `branches` finds its isolated branches. For a held system it is the number of half waves at the start of
        the branch.
    max_angular_speed : float
        Speed at which to stop, rad/s, above that of the mode. The branch of a held system starts at this speed and goes
        to lower speeds.
    min_conical_height : float
        Conical height of that speed, m, instead of `max_angular_speed`.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Direction of rotation; only a rig with flywheels depends on it.
    max_points : int, optional
        Largest number of points; ``end`` is ``budget`` if it is reached. A held system ignores it and stops after 3000
        steps.
    max_step : float, optional
        Largest step between two points, in units of ``Branch.arc``. For a held system: largest relative change of the
        forces at its end and of the conical height.

    Returns
    -------
    Branch, CordBranch or HeldBranch
        The points of the branch, from the critical speed of the mode to the given speed. The first point is the
        straight chain. It is the only one if double precision cannot separate the end from it; ``end`` is then
        ``stuck``. With the support off the axis the branch starts at a tenth of a speed: of the given speed, or of
        the first critical speed of the rig with its support on the axis, whichever is lower. The branch of a held
        system ends where a link becomes slack or a cord folds. Accuracy: numbers to 1e-12; folds to 1e-6 of the arc,
        their heights to 1e-13, those of a cord to 1e-9.

    Raises
    ------
    ValueError
        If there is no such mode (with a support off the axis: if `mode` is not 1), if not exactly one of
        `max_angular_speed` and `min_conical_height` is given, if the speed is not above that of the mode, or if
        `direction` is neither 1 nor -1; if a `Held` system is under a tension or has no gravity.

    Notes
    -----
    Method: pseudo-arclength continuation in all inclinations and the height. A step is halved unless Newton's method
    contracts at once, the direction turns little, and the middle of the step lies on the branch too. If no link has
    ``pendulum_length > length``, the half waves must not change either. This is a check, not a proof. For a cord the
    curve is that on which crossing `mode` of the axis lies at the support. Cost: O(N) for each point. Source: Greenhill
    (1908), section 8 (4), (12).

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
    """Return all branches of steady shapes up to a speed, including isolated ones, and whether any can be missing.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        A chain or a rig of few links, because all shapes are listed (`steady_shapes`), for a rig those in its own
        posture; a cord; or a chain or cord held at a span. For a held system only the branches that start with the nearly
        straight chain are found, and `lists`, `budget` and `proof_budget` are not used.
    max_angular_speed : float
        Largest speed, rad/s.
    min_conical_height : float
        Smallest conical height, m, instead of `max_angular_speed`.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Direction of rotation; only a rig with flywheels depends on it.
    lists : int, optional
        Number of speeds at which all shapes are listed and matched with the branches.
    budget : int, optional
        Work allowed for each list; see `steady_shapes`. Not used for cords.
    proof_budget : int, optional
        Number of links that the proof may visit, at 0.1 to 1 microsecond each; 0 for no proof. Not used for cords.

    Returns
    -------
    Branches, CordBranches or HeldBranches
        A sequence of branches. First come those that leave the vertical, slowest first (with the support off the axis the
        one from rest), then the isolated ones, which start at a fold, slowest first. Those of a held system are ordered by
        half waves. For a cord ``complete`` is true if a theorem counts the shapes (see `steady_shapes`) and every branch
        was followed to its end. `HeldBranches` has no ``complete``; `steady_shapes` can prove a list at one speed.

    Raises
    ------
    ValueError
        If not exactly one of `max_angular_speed` and `min_conical_height` is given, or a number is out of its range; if
        a link of a rig has no effective tension at one of the speeds; if a `Held` system is under a tension or has no
        gravity.

    Notes
    -----
    A listed shape that matches no branch lies on an isolated branch, which is then followed in both directions.
    ``consistent`` is true if every list is proved complete and each of its shapes matches exactly one branch.

    Loops can open and close between two of the speeds. Interval arithmetic therefore splits the plane of conical height
    and tangent of the lowest link until each part has no fold, or has all its shapes on one curve through a known branch.
    Loops found in this way are followed. ``complete`` is true if this succeeds for every part; it is false if links could
    hang at several inclinations. The proof relies on `branch`, whose steps are checked, not proved.

    For rigs (on springs, on an arm, with flywheels, in fluids) the proof needs all links in tension at every speed up to
    the given one. Below the first critical speed such a rig has exactly one shape if its support is off the axis, and only
    the straight one if it is on the axis. If stiffness times conical height is less than the weight that moves, a spring
    at the support cannot balance it, and nothing is proved; ``remark`` gives these heights.

    Cost, measured down to a conical height of 1/200 of the length: three links 4 to 8 ms, five 15 ms, six 30 ms. Eight
    equal plummets on threads of length a, to 5 sqrt(g/a): 0.1 s; twenty rods, 1 m in all, to 20 rad/s: 0.05 s.

    Examples
    --------
    >>> import revchain as rc
    >>> diagram = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), max_angular_speed=5.0, gravity=1.0)
    >>> len(diagram), diagram.consistent, diagram.complete
    (4, True, True)
    >>> born = diagram[3]
    >>> round(born.angular_speed[born.folds[0]], 10)
    np.float64(3.9037621569)

    A carousel: the branch from rest outwards, and an inward branch that starts at a fold:

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
    """Return the steady shape on the branch of one mode at a speed, or the one with a given property.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system: a chain of N links (100,000 and more are possible), a rig, a cord, or a chain or cord held at a span.
    mode : int, optional
        Number of the mode at which the branch leaves the vertical, from 1 for the slowest. With the support off the axis
        it must be 1, the branch from rest; for shapes of other branches use `branches` and `Branch.at`. For a held
        system it is the number of half waves of the branch at high speed.
    conical_height : float
        Conical height of the speed, m, less than that of the mode. Give exactly one of this and the next four.
    angular_speed : float
        Speed, rad/s.
    tip_inclination : float
        Magnitude of the inclination of the lowest link (of a cord: of its free end), rad: between 0 and pi/2, for an
        inverted link between pi/2 and pi. The link may lean either way; with the support off the axis it leans
        outwards.
    tip_radius : float
        Distance of the free end from the axis, m, on either side.
    top_tension : float
        Tension at the topmost pin (of a held system: at its upper end), greater than the weight that hangs there; in N,
        or in the unit of the weights.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Direction of rotation; only a rig with flywheels depends on it.
    all : bool, optional
        True to return all such shapes of the branch as a tuple, which may be empty; False for the first one.
    min_conical_height : float, optional
        Conical height at which the search ends, m, less than that of the mode. If left out, it is half the height of the
        speed (with `all` and a speed), else 1e-6 of that of the mode. Not used for a held system.

    Returns
    -------
    SteadyShape, CordShape, HeldShape, HeldCordShape or tuple of them
        The shape. Inclinations are within ``error_bound``, which is proved except at a fold (measured: 2.3e-16); those of a
        cord within ``error_estimate``. Each step checks that the shape is on this branch, see `branch`. For a held system
        and a speed it is the shape reached from the nearly straight chain; for a held system and a top tension it is the
        fastest shape of the branch with that tension.

    Raises
    ------
    ValueError
        If there is no such mode, if not exactly one number is given or it is out of its range, if `direction` is
        neither 1 nor -1, if `min_conical_height` is not below the height of the mode, if the branch does not exist yet
        at that speed, or, unless `all` is true, if no shape of the branch has the property; if a `Held` system is under
        a tension or has no gravity, or comes with `tip_inclination`, `tip_radius` or ``all=True``.
    TypeError
        If `all` is not a bool.

    Notes
    -----
    Cost: O(N); 0.4 s for 100,000 rods at twice the first critical speed. Source: Greenhill (1908), section 8 (4), (12).

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
    """Weight or mass of the whole system, as given."""
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
