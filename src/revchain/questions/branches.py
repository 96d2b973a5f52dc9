# SPDX-License-Identifier: GPL-3.0-or-later
"""`branch` follows one branch of steady shapes; `branches` finds those up to a speed, isolated ones too."""

from __future__ import annotations

import re
from itertools import combinations
from typing import Any

import numpy as np

from .. import _core
from ..results.branches import Branch, Branches, branch_made, branches_made, joined
from ..systems.chain import Chain, checked
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, boolean, count, height_of, limit, one_positive, shown
from ..systems.rig import Rig
from ..systems.system import System
from .asked import in_unit_of
from .refuse import no_system
from .shapes import compiled_system, require_span, rotation

LISTS = 16
"""Number of speeds at which `branches` lists all shapes."""
MOST_LINKS = 10
"""Number of links of which `branches` follows all postures, 1024."""


@in_unit_of("max_angular_speed")
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
) -> Branch:
    """Return the branch of steady shapes of one mode, followed through its folds.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system: a chain of N links, a rig, a cord, or a chain or cord held at a span. Along the branch of a rig each link
        keeps its posture (hanging or inverted).
    mode : int
        Number of the mode, from 1 for the slowest. A rig with its support off the axis has only mode 1, the branch from
        rest; `branches` finds its isolated branches. For a held system see `Branch.mode`.
    max_angular_speed : float
        Speed at which to stop, rad/s, above that of the mode. The branch of a held system starts at this speed.
    min_conical_height : float
        Conical height of that speed, m, instead of `max_angular_speed`.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Direction of rotation; only a rig with flywheels depends on it.
    max_points : int, optional
        Largest number of points; not used for held systems.
    max_step : float, optional
        Largest step after the first, in units of ``Branch.arc``. For a held system: largest relative change of the forces at
        its end and of the conical height.

    Returns
    -------
    Branch
        The points of the branch. The branch of a hanging system runs from the critical speed of its mode, where it is
        straight, to the given speed. With the support off the axis it starts near rest. The branch of a held system runs
        from the given speed to lower ones and, after a fold, back. Accuracy: numbers to 1e-12; folds to 1e-6 of the arc,
        their heights to 1e-13, those of a cord to 1e-9.

    Raises
    ------
    ValueError
        If there is no such mode, if not exactly one of `max_angular_speed` and `min_conical_height` is given, if the speed
        is not above that of the mode, or if a number is out of its range; if a `Held` system is under a tension or has no
        gravity; if a rig has springs at pins, a dashpot at its support, linear drag or a free trolley.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.

    Notes
    -----
    Method: pseudo-arclength continuation in all inclinations and the height; for a held system in the forces at its lower
    end and the height. The steps are checked, not proved. Cost: O(N) for each point. Source: Greenhill (1908), section 8
    (4), (12).

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
    caller = "revchain.branch"
    height, g, turns = _checked(caller, system, min_conical_height, max_angular_speed, gravity, direction)
    number, points = count(caller, "mode", mode), count(caller, "max_points", max_points)
    step = one_positive(caller, "max_step", max_step)
    try:
        found: Any = _core.branch(compiled_system(caller, system, g), number, height, points, step, g, turns)
    except ValueError as error:
        begin = re.search(r"leaves the vertical at the conical height ([\d.e+-]+):", str(error))
        if begin is None or max_angular_speed is None:
            raise ValueError(f"{caller}: {str(error).partition(': ')[2]}") from None
        speed = (g / float(begin[1])) ** 0.5
        what = f"mode {number} leaves the vertical at {speed:.6g} rad/s ({speed * 30 / np.pi:.6g} rpm)"
        raise ValueError(f"{caller}: {what}; max_angular_speed must be greater, got {shown(max_angular_speed)}") from None
    return _ended(branch_made(found, system, g, turns), max_angular_speed)


@in_unit_of("max_angular_speed")
def branches(
    system: Chain | Rig | Cord | Held,
    *,
    max_angular_speed: float | None = None,
    min_conical_height: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    direction: int = 1,
    budget: int = 3_000_000,
    hanging_only: bool = True,
    stability: bool = False,
) -> Branches:
    """Return the branches of steady shapes up to a speed, including isolated ones, and whether any can be missing.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        A chain or a rig of few links, because all shapes are listed (`steady_shapes`); a cord; or a chain or cord held at a
        span. For a held system the branches that start with the nearly straight chain are found.
    max_angular_speed : float
        Largest speed, rad/s.
    min_conical_height : float
        Smallest conical height, m, instead of `max_angular_speed`.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Direction of rotation; only a rig with flywheels depends on it.
    budget : int, optional
        Limit of the work. The list of all shapes may visit this many links at each of 16 speeds (see `steady_shapes`). A
        visit takes 0.1 to 1 microsecond. Not used for cords and held systems.
    hanging_only : bool, optional
        Chains and rigs: whether to leave out branches with a link above its upper pin (for a rig: with other links inverted
        than those of the rig). If false, the branches of all ``2**N`` postures are found; N at most 10.
    stability : bool, optional
        Whether to compute `Branch.verdict` of every branch now, to draw the windows of stability and to list them in
        reports; not for cords.

    Returns
    -------
    Branches
        A sequence of branches. First come those that leave the vertical, slowest first (with the support off the axis the
        one from rest), then the isolated ones, slowest first. Those of a held system are ordered by half waves and have no
        ``complete``; `steady_shapes` can prove a list at one speed. With ``hanging_only=False`` the branches of the system's
        own posture come first, then those of each other posture. `Branch.system` is the `Rig` with the links of the posture
        inverted, and ``mode`` counts its modes.

    Raises
    ------
    ValueError
        If not exactly one of `max_angular_speed` and `min_conical_height` is given, or a number is out of its range; if a
        link of a rig has no effective tension at one of the speeds; if a `Held` system is under a tension or has no gravity;
        if a rig has springs at pins, a dashpot at its support, linear drag or a free trolley; with ``hanging_only=False``
        for a cord, a held system, or more than 10 links; with `stability` for a cord.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.

    Notes
    -----
    A listed shape that matches no branch lies on an isolated branch, which is then followed from that shape to its end.

    An isolated branch that is a closed loop can begin and end between two of the 16 speeds, so that no list contains it.
    Interval arithmetic therefore splits the plane of conical height and tangent of the lowest link until each part has no
    fold, or has all its shapes on one curve through a known branch. Loops found in this way are followed. ``complete`` is
    true if this succeeds for every part. The proof relies on the checks of `branch`.

    For rigs (on springs, on an arm, with flywheels, in fluids) the proof needs all links in tension at every speed up to the
    given one.

    A branch keeps its posture. ``hanging_only=False`` therefore computes the branches of the ``2**N`` rigs in which some of
    the links are inverted.

    Cost for equal plummets down to a conical height of 1/200 of the length: three 5 ms, five 25 ms, eight on threads of
    length a, to 5 sqrt(g/a): 0.1 s; for twenty equal rods, 1 m in all, to 20 rad/s: 0.04 s. All postures of plummets down to
    1/50 of the length: three 0.02 s, four 0.07 s, six (196 branches) 0.5 s.

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

    Two links in every posture: one of them stands on its upper pin, or both hang:

    >>> rc.branches(rc.Chain.uniform_plummets(2, length=2.0), max_angular_speed=9.0, hanging_only=False).inverted
    ('none', 'none', '0', '1')
    """
    caller = "revchain.branches"
    height, g, turns = _checked(caller, system, min_conical_height, max_angular_speed, gravity, direction)
    most = limit(caller, "budget", budget)
    if most < 0:
        raise ValueError(f"{caller}: budget must not be negative, got {shown(budget)}")
    postures, judged = [system], boolean(caller, "stability", stability)
    if judged and system._is_cord:
        instead = "ask shapes: branch.shape(-1).stability()"
        raise ValueError(f"{caller}: stability is for links, as each verdict of a cord takes long; {instead}")
    if not boolean(caller, "hanging_only", hanging_only):
        postures = _postures(caller, system)
    diagrams = []
    for each in postures:
        found: Any = _core.branches(compiled_system(caller, each, g), height, LISTS, most, most // 3, g, turns)
        diagrams.append(branches_made(found, each, g, turns, judged))
    diagram = diagrams[0] if hanging_only else joined(diagrams, system)
    for branch in diagram:
        _ended(branch, max_angular_speed)
    if judged:
        checked(caller, False, list, (branch.verdict for branch in diagram))  # each is stored when first read
    return diagram


def _ended(branch: Branch, max_angular_speed: Any) -> Branch:
    """The branch, which prints that it ends at the largest speed if one was given."""
    branch.__dict__["_by_speed"] = max_angular_speed is not None
    return branch


def _postures(caller: str, system: Any) -> list[Any]:
    """The system in all postures, its own first; a ValueError if it has no links that can stand, or too many."""
    if not isinstance(system, Chain | Rig):
        what = "hanging_only=False is for chains and rigs, whose links can be above their upper pins"
        raise ValueError(f"{caller}: {what}; leave it out, got {shown(system)}")
    if system.size > MOST_LINKS:
        raise ValueError(
            f"{caller}: hanging_only=False follows 2**N postures of at most {MOST_LINKS} links, got {system.size}; at one "
            "speed use steady_shapes with hanging_only=False"
        )
    if isinstance(system, Chain) and system.size == 1:
        return [system]  # one link alone cannot stand
    rig = system if isinstance(system, Rig) else Rig(system)
    fittings = {name: getattr(rig, name) for name in ("support", "flywheels", "displaced", "fluid", "pins", "drag")}
    own, links = set(np.flatnonzero(rig.inverted)), range(rig.size)
    others = [set(each) for many in range(rig.size + 1) for each in combinations(links, many) if set(each) != own]
    return [system, *(Rig(rig.chain, **fittings, inverted=[k in each for k in links]) for each in others)]


def _checked(
    caller: str, system: Any, height: float | None, speed: float | None, gravity: float, direction: int
) -> tuple[float, float, int]:
    """The lowest conical height, gravity and direction."""
    if not isinstance(system, System):
        raise no_system(caller, system)
    least = height_of(caller, height, speed, gravity, "min_conical_height", "max_angular_speed")
    g, turns = one_positive(caller, "gravity", gravity), rotation(caller, direction)
    if isinstance(system, Held):
        require_span(caller, system)
    return least, g, turns
