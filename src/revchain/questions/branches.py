# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes: followed from each critical speed, and single shapes on them."""

from __future__ import annotations

from typing import Literal, overload

from .. import _core
from ..results.bent import HeldShape
from ..results.branches import Branch, Branches, branches_made
from ..results.held_branches import HeldBranch, HeldBranches, held_branches_made
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
    limit,
    one_positive,
)
from ..systems.rig import Rig
from .refuse import refuse_other

_OTHERS = {
    Rig: "ask steady_shapes at the speeds wanted",
    Cord: "ask the branches of its chain: cord.chain(10)",
}


@overload
def branch(
    system: Chain,
    mode: int,
    *,
    max_angular_speed: float | None = ...,
    min_conical_height: float | None = ...,
    gravity: float = ...,
    max_points: int = ...,
    max_step: float = ...,
) -> Branch: ...
@overload
def branch(
    system: Held,
    mode: int,
    *,
    max_angular_speed: float | None = ...,
    min_conical_height: float | None = ...,
    gravity: float = ...,
    max_points: int = ...,
    max_step: float = ...,
) -> HeldBranch: ...
def branch(
    system: Chain | Held,
    mode: int,
    *,
    max_angular_speed: float | None = None,
    min_conical_height: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    max_points: int = 10_000,
    max_step: float = 0.1,
) -> Branch | HeldBranch:
    """Follow the branch of shapes that leaves the vertical at one critical speed, through every fold.

    Parameters
    ----------
    system : Chain or Held
        The chain of N links, hung or held at both ends a span apart.
    mode : int
        Number of the mode, from 1, the slowest; of a held chain the half waves with which its branch begins.
    max_angular_speed : float
        Where to stop: at the first point of this speed, rad/s, above that of the mode. A held chain's branch begins at
        this speed.
    min_conical_height : float
        Instead of `max_angular_speed`: the conical height at which to stop, m.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    max_points : int, optional
        After which to stop in any case.
    max_step : float, optional
        Between two points, along the arc.

    Returns
    -------
    Branch or HeldBranch
        Of a held chain: shapes to slower speeds and through folds, until a link is slack. Else the first point
        is the straight chain, alone if no double tells the end from it (``end`` is then
        ``stuck``). Numbers to about 1e-12; folds to 1e-6 of the arc, their heights to 1e-13, mostly an ulp.

    Raises
    ------
    ValueError
        If there is no such mode, if not exactly one of `max_angular_speed` and `min_conical_height` is given, or if
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
    >>> branch = rc.branch(rc.Chain.uniform_plummets(3, length=3.0), 3, min_conical_height=0.04)
    >>> branch.conical_height[[0, -1]].round(6), set(branch.half_waves.tolist())
    (array([0.158984, 0.04    ]), {3})
    """
    place = "revchain.branch"
    refuse_other(place, system, (Chain, Held), _OTHERS)
    number = count(place, "mode", mode)
    if isinstance(system, Held):
        found_all = _held_branches(place, system, max_angular_speed, min_conical_height, gravity, max_step)
        if number > len(found_all):
            most = len(found_all)
            raise ValueError(f"{place}: mode must be from 1 to {most}, the branches at the greatest speed, got {number}")
        return found_all[number - 1]
    height = height_of(place, min_conical_height, max_angular_speed, gravity, "min_conical_height", "max_angular_speed")
    points = count(place, "max_points", max_points)
    step = one_positive(place, "max_step", max_step)
    asked = (number, height, points, step)
    found = _core.branch(compiled(place, system), *asked)
    return Branch._made(found, system=system, gravity=one_positive(place, "gravity", gravity), asked=asked)


@overload
def branches(
    system: Chain,
    *,
    max_angular_speed: float | None = ...,
    min_conical_height: float | None = ...,
    gravity: float = ...,
    lists: int = ...,
    budget: int = ...,
    proof_budget: int = ...,
) -> Branches: ...
@overload
def branches(
    system: Held,
    *,
    max_angular_speed: float | None = ...,
    min_conical_height: float | None = ...,
    gravity: float = ...,
    lists: int = ...,
    budget: int = ...,
    proof_budget: int = ...,
) -> HeldBranches: ...
def branches(
    system: Chain | Held,
    *,
    max_angular_speed: float | None = None,
    min_conical_height: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    lists: int = 16,
    budget: int = 2_000_000,
    proof_budget: int = 1_000_000,
) -> Branches | HeldBranches:
    """Find the whole diagram of branches up to a speed, isolated ones too, and prove that none is missing.

    Parameters
    ----------
    system : Chain or Held
        The chain of N links; few, as all shapes are listed (`steady_shapes`). Or a chain held at both ends, a span apart,
        of which shapes are followed from the greatest speed down, those alone that begin with the nearly straight chain;
        `lists` and budgets are then not used.
    max_angular_speed : float
        The speed up to which to go, rad/s.
    min_conical_height : float
        Instead of `max_angular_speed`: the conical height down to which to go, m.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    lists : int, optional
        At how many speeds to list all shapes and bring them together with the branches.
    budget : int, optional
        Work allowed for each list; see `steady_shapes`.
    proof_budget : int, optional
        Links to look at for the proof, 0.1 to 1 microsecond each; 0: no proof.

    Returns
    -------
    Branches or HeldBranches
        A sequence of `HeldBranch`, by half waves, or of `Branch`: those that leave the vertical, slowest first,
        then those that are born in a
        fold, slowest first.

    Raises
    ------
    ValueError
        If not exactly one of `max_angular_speed` and `min_conical_height` is given, or a number is out of its range.

    Notes
    -----
    A shape of a list that no branch meets lies on an isolated branch, which is followed from there both
    ways. ``consistent`` is true where every list is proved complete and each shape in it met once.

    Loops can open and close between two of the speeds. The plane of conical heights and tangents of the lowest
    link is therefore split, in interval arithmetic, until in each part there is no fold, or all shapes lie on
    one curve through a branch that is known; loops found so are followed. ``complete`` is true where
    no part resists. Links that could hang at several inclinations are left out: there it is false. It rests on
    `branch`: that a branch that was followed is where it seems to be is checked at every step, not proved.
    Measured, at heights of 1/200 of the length: three links 4 to 8 ms, five 15 ms, six 30 ms; eight equal plummets to
    5 sqrt(g/a) 0.1 s, twenty rods of 1 m in all to 20 rad/s 0.05 s.

    Examples
    --------
    >>> import revchain as rc
    >>> diagram = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), max_angular_speed=5.0, gravity=1.0)
    >>> len(diagram), diagram.consistent, diagram.complete
    (4, True, True)
    >>> born = diagram[3]
    >>> round(born.angular_speed[born.folds[0]], 10)
    np.float64(3.9037621569)
    """
    place = "revchain.branches"
    refuse_other(place, system, (Chain, Held), _OTHERS)
    if isinstance(system, Held):
        return _held_branches(place, system, max_angular_speed, min_conical_height, gravity, 0.1)
    height = height_of(place, min_conical_height, max_angular_speed, gravity, "min_conical_height", "max_angular_speed")
    at = min(count(place, "lists", lists), 10**6)
    most, most_of_proof = limit(place, "budget", budget), limit(place, "proof_budget", proof_budget)
    asked = (height, at, most, most_of_proof)
    found = _core.branches(compiled(place, system), *asked)
    return branches_made(found, system, one_positive(place, "gravity", gravity), asked)


@overload
def steady_shape(
    system: Chain,
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
    system: Chain,
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
@overload
def steady_shape(
    system: Held,
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
) -> HeldShape: ...
def steady_shape(
    system: Chain | Held,
    *,
    mode: int = 1,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    tip_inclination: float | None = None,
    tip_radius: float | None = None,
    top_tension: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    all: bool = False,
    min_conical_height: float | None = None,
) -> SteadyShape | HeldShape | tuple[SteadyShape, ...]:
    """Find the shape on the branch of one mode at a speed, or the speed at which the shape is as wanted.

    Parameters
    ----------
    system : Chain or Held
        The chain of N links, up to 100,000 and more; or a chain held at both ends, a span apart.
    mode : int, optional
        At which the branch leaves the vertical, from 1, the slowest; of a held chain the half waves with which its branch
        begins at great speed.
    conical_height : float
        Conical height of the speed, less than that of the mode.
    angular_speed : float
        Instead: the speed in rad/s.
    tip_inclination : float
        Instead: that of the lowest link, rad, above 0 and below pi/2; its size, whatever the sign.
    tip_radius : float
        Instead: the free end's distance from the axis, its size too.
    top_tension : float
        Instead: the size of the reaction at the support, more than the weight of the chain. Of a held chain the
        tension at the upper end.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    all : bool, optional
        All states met along the branch, in a tuple, not the first from the vertical alone; the tuple
        is empty where none is met.
    min_conical_height : float, optional
        The conical height at which the search ends, less than that of the mode; 1e-6 of that of the mode if
        left out, with `all` and a speed the half of its height.

    Returns
    -------
    SteadyShape, HeldShape or tuple of SteadyShape
        Of a held chain the first met from the greatest speed on. Inclinations to 2.3e-16 at a given height or
        speed (measured), and within ``error_bound``, proved but at
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
    refuse_other(place, system, (Chain, Held), _OTHERS)
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
    if isinstance(system, Held):
        return _held_shape(place, system, number, name, value, g, all)
    if name == "top_tension":
        least = system._force(g) * system._compiled.total_weight
        if not value > least:
            raise ValueError(f"{place}: top_tension must be more than the weight {least:.6g} of the chain, got {value:g}")
        value /= system._force(g)
    every = boolean(place, "all", all)
    lowest = None if min_conical_height is None else one_positive(place, "min_conical_height", min_conical_height)
    core = compiled(place, system)
    if not every:
        return _shape(_core.steady_shape(core, number, name, value, g, lowest), system, g)
    found = _core.shapes_on_branch(core, number, name, value, g, lowest)
    return tuple(_shape(shape, system, g) for shape in found)


def _shape(found: _core.SteadyShape, system: Chain, gravity: float) -> SteadyShape:
    return SteadyShape._made(found, system=system, gravity=gravity, direction=1)


def _spanned(place: str, held: Held) -> tuple[_core.Chain, float]:
    """The chain and its span."""
    if isinstance(held.system, Cord):
        raise ValueError(f"{place}: is for chains; cut the cord into links: Held(cord.chain(100), span=...)")
    if held.span is None:
        raise ValueError(f"{place}: is for a chain held at a span; under a tension ask steady_shapes at the speeds wanted, or modes")
    if held.weightless:
        raise ValueError(f"{place}: without gravity a shape is the same at every speed; ask steady_shapes")
    return held.system._compiled, held.span


def _held_branches(
    place: str, held: Held, speed: float | None, height: float | None, gravity: float, max_step: float
) -> HeldBranches:
    chain, span = _spanned(place, held)
    g = one_positive(place, "gravity", gravity)
    least = height_of(place, height, speed, g, "min_conical_height", "max_angular_speed")
    step = one_positive(place, "max_step", max_step)
    return held_branches_made(_core.held_branches(chain, span, least, step), held, g, (least, step))


def _held_shape(place: str, held: Held, mode: int, name: str, value: float, gravity: float, all_of_them: bool) -> HeldShape:
    chain, span = _spanned(place, held)
    if name not in ("conical_height", "angular_speed", "top_tension"):
        raise ValueError(f"{place}: a held chain has no free end; give conical_height, angular_speed or top_tension, got {name}")
    if all_of_them:
        raise ValueError(f"{place}: all is for a Chain; ask branches for the shapes along a branch of a held chain")
    if mode > max(chain.size - 1, 1):
        raise ValueError(f"{place}: mode must be from 1 to {max(chain.size - 1, 1)}, got {mode}")
    asked = value / held._force(gravity) if name == "top_tension" else value
    found = _core.held_shape(chain, span, mode, name, asked, gravity)
    height = found.conical_height
    return HeldShape._made(
        found,
        system=held,
        gravity=gravity,
        angular_speed=value if name == "angular_speed" else float((gravity / height) ** 0.5),
        _asked=("mode", mode, name, asked, gravity),
    )
