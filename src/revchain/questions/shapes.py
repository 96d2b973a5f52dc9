# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes (relative equilibria) at any inclination."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from ..results.shapes import SteadyShape, SteadyShapes, shape_made, shapes_made
from ..systems.chain import Chain, compiled
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, boolean, exactly_one, integer, limit, one_positive, shown, without_function
from ..systems.numbers import count as counted
from ..systems.rig import Rig
from ..systems.system import System
from .asked import in_unit_of
from .refuse import no_system

LEAST, MOST = 1e-150, 1e150
"""Limits of conical heights, and of squared speeds without gravity; products with tensions then stay finite."""
MOST_HALF_WAVES = 1000
BUDGET = {Chain: 3_000_000, Rig: 3_000_000, Cord: 200, Held: 300_000}


@in_unit_of("angular_speed")
def steady_shapes(
    system: Chain | Rig | Cord | Held,
    *,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    budget: int | None = None,
    hanging_only: bool = True,
    direction: int = 1,
    max_half_waves: int = 1,
    prove: bool = True,
    threads: int = 1,
    mode: int | None = None,
    lowest_inclination: float | None = None,
    tip_radius: float | None = None,
    top_tension: float | None = None,
    min_conical_height: float | None = None,
) -> SteadyShapes:
    """Return the steady shapes (relative equilibria) of a system at a speed, or those of one branch with a property.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system: a chain of N links, a rig, a cord, or a chain or cord held at both ends.
    angular_speed : float
        Speed, rad/s, positive.
    conical_height : float
        Conical height of the speed, m, positive, instead of `angular_speed`. It does not exist without gravity.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    budget : int, optional
        Largest number of links to visit while the range of inclinations of the lowest link is split. Chains and rigs:
        3,000,000 if left out, at 0.1 to 1 microsecond each besides the refinement of shapes. Held chains: 300,000 if left
        out, at about a microsecond each; with 0 completeness is not proved. Cords for which no theorem counts the shapes:
        number of offsets of the free end to examine, 200 if left out.
    hanging_only : bool, optional
        Chains and rigs: whether to leave out shapes in which a link is inverted, that is, at more than a right angle to the
        downward vertical. For a rig: whether to leave out shapes with other links inverted than those of the rig.
    direction : {1, -1}, optional
        Direction of rotation; only a rig with flywheels depends on it.
    max_half_waves : int, optional
        For `Held` systems: search only for shapes with at most this number of half waves.
    prove : bool, optional
        Held chains: whether to prove error bounds and completeness; else the bounds are estimates.
    threads : int, optional
        Number of threads for chains and rigs, which share the refinement of the shapes; 0 for all processors. Results are
        bitwise equal for any number.
    mode : int, optional
        Chains, rigs and cords: search only the branch of this mode, see `steady_shape`. Then a property may be given instead
        of the speed, and the shapes have different speeds.
    lowest_inclination, tip_radius, top_tension, min_conical_height : float, optional
        With `mode`, as in `steady_shape`.

    Returns
    -------
    SteadyShapes
        A sequence of shapes. Straight shapes are left out. ``complete`` tells whether it is proved that no shape is missing,
        see `SteadyShapes`.

        Chains and rigs: the hanging shapes (all links within a right angle of the downward vertical, but for those that a
        rig has inverted) or, if `hanging_only` is false, the shapes of all postures. Of two mirror images the one with the
        free end at a positive offset is given; if the support is carried round there are none, and outwards is positive.
        Inclinations are within the proved ``error_bound``, usually 2.2e-16.

        Cords: ``complete`` is true if a theorem counts the shapes, one for each critical height above the given one, and
        none is within 7e-15 of it. There is one for uniform cords with or without a tip. Without a theorem a shape may be
        missed.

        Held systems: shapes of 1 to `max_half_waves` half waves about the line between the ends. Among shapes with equally
        many, the one that is reached from the nearly straight chain comes first. Of two mirror images the one whose lowest
        link leads outwards is given. For held chains the proof of ``complete`` usually succeeds for one half wave of up to 9
        links with ``l <= a`` and mass at every pin; with more links or half waves it often leaves a part undecided. Held
        cords: ``complete`` is true for a span without gravity.

    Raises
    ------
    ValueError
        If not exactly one of `angular_speed` and `conical_height` is given, a number is out of its range, or a link of a rig
        has no effective tension at the speed; if a rig has springs at pins, a dashpot at its support, linear drag or, with
        `mode`, a free trolley; if a property is given without `mode`, or `mode` for a held system.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`, or `hanging_only` or `prove` is not a bool.

    Notes
    -----
    Chains and rigs. Method: interval arithmetic with first and second derivatives of the upward sweep, Greenhill (1908),
    section 8 (4), (12), then Newton's method on all pins in double-double. ``complete`` is false if the budget ends, and may
    be false at a critical speed or at a fold. For heights below about 2e-15 of the longest link the list is empty and not
    complete. Cost: 12 milliseconds for 84 hanging shapes of eight plummets, or for all 64 shapes of four plummets. One link
    more multiplies the number of shapes and the time by 1.5 to 2; if links may be inverted, by about 4.

    Cords. Method: power series along the cord, Newton's method on the point where it crosses the axis. Inclinations, and
    offsets divided by the length, are within ``error_bound``, which is an estimate.

    Held systems. Accuracy: inclinations of chains are within half an ulp plus 1e-20, and ``error_bound`` is usually proved;
    positions on cords are within 1e-13 of the length. Completeness: Krawczyk's test on the pull along the lowest link and
    its inclination, at most about 0.2 s for one half wave.

    Examples
    --------
    >>> import numpy as np
    >>> import revchain as rc
    >>> shapes = rc.steady_shapes(rc.Chain.uniform_plummets(8, length=8.0), conical_height=1 / 35.4025)
    >>> len(shapes), shapes.complete
    (84, True)
    >>> rods = rc.Chain.uniform_rods(3, length=3.0)
    >>> [len(rc.steady_shapes(rods, conical_height=0.05, hanging_only=only)) for only in (True, False)]
    [3, 14]

    A chair on a chain of 4 m on an arm of 1 m, at twelve turns a minute; and at 3 rad/s, where it could also
    hang inwards in two ways:

    >>> carousel = rc.Rig(rc.Chain(weight=800.0, length=4.0), support=rc.Support(radius=1.0))
    >>> rc.steady_shapes(carousel, angular_speed=1.2566)
    1 hanging shape at 1.25660 rad/s (12.00 rpm), proved complete; with links above their pins there may be more
    shape  half waves  lowest link (°)  top link (°)  free end: from axis (m)  above support (m)  top tension  error (rad)
        1           1           21.824        21.824                   2.4870            -3.7133       861.76      2.2e-16
    inclinations: from the downward vertical; error: proved bound on every inclination
    >>> [round(float(np.degrees(s.inclination[0])), 1) for s in rc.steady_shapes(carousel, angular_speed=3.0)]
    [77.5, -68.1, -20.7]

    A blade with exactly one shape of one half wave, and one that turns too slowly to have any:

    >>> blade = rc.Held(rc.Chain.uniform_rods(10, length=1.0), span=0.51)
    >>> found = rc.steady_shapes(blade, angular_speed=15.0)
    >>> len(found), found.complete
    (1, True)
    >>> slow = rc.steady_shapes(blade, angular_speed=1.0)
    >>> slow.missing, slow.complete
    ((1,), True)

    The shapes of one branch whose free end is 0.53 m from the axis:

    >>> plummets = rc.Chain.uniform_plummets(3, length=3.0)
    >>> rc.steady_shapes(plummets, mode=2, tip_radius=0.53).speed.round(4)
    array([ 7.0837, 13.5539])

    A cord, and a skipping rope with one and two half waves:

    >>> cord = rc.Cord(500.0)
    >>> found = rc.steady_shapes(cord, conical_height=1.0)
    >>> len(found), found.complete, round(float(found[13].offset[0]), 9)
    (14, True, 2.705556715)
    >>> rope = rc.Held(rc.Cord(1.0), span=0.5)
    >>> [round(float(shape.offset.max()), 4) for shape in rc.steady_shapes(rope, conical_height=0.05, max_half_waves=2)]
    [0.402, 0.2013]
    """
    caller = "revchain.steady_shapes"
    if not isinstance(system, System):
        raise no_system(caller, system)
    wanted = {"lowest_inclination": lowest_inclination, "tip_radius": tip_radius, "top_tension": top_tension}
    turns = rotation(caller, direction)
    if mode is not None:
        name, value = exactly_one(caller, conical_height=conical_height, angular_speed=angular_speed, **wanted)
        g = one_positive(caller, "gravity", gravity)
        found = on_branch(caller, system, mode, name, value, g, turns, min_conical_height, _core.shapes_on_branch)
        searched = {"mode": mode, "complete": False, "hanging_only": False, "missing": ()}
        speed = dict.fromkeys(("conical_height", "angular_speed"))
        if name in speed:
            speed = dict(zip(speed, _height_and_speed(name, value, g), strict=True))
        items = tuple(shape_made(shape, system, g, turns) for shape in found)
        nothing: dict[str, Any] = {"undecided": np.empty((0, 2)), "cells": 0}
        return SteadyShapes._made(None, _items=items, system=system, gravity=g, **searched, **speed, **nothing)
    for name, given in (*wanted.items(), ("min_conical_height", min_conical_height)):
        if given is not None:
            raise ValueError(f"{caller}: {name} selects shapes of one branch; give mode, too, got {name}={shown(given)}")
    kind = next(kind for kind in BUDGET if isinstance(system, kind))
    most = limit(caller, "budget", BUDGET[kind] if budget is None else budget)
    if kind is Cord and not 1 <= most <= 10**6:
        raise ValueError(f"{caller}: budget must be from 1 to 1000000 offsets of the free end of a cord, got {most}")
    if most < 0:
        raise ValueError(f"{caller}: budget must not be negative, got {shown(budget)}")
    hanging = boolean(caller, "hanging_only", hanging_only)
    waves = counted(caller, "max_half_waves", max_half_waves)
    if waves > MOST_HALF_WAVES:
        raise ValueError(f"{caller}: max_half_waves must be at most {MOST_HALF_WAVES}, got {waves}")
    proved = boolean(caller, "prove", prove)
    shared = integer(caller, "threads", threads)
    g, height, speed_ = _turning(caller, system, conical_height, angular_speed, gravity)
    # of the two numbers for one speed the core gets the one that was given; a cord the height
    of_core, by_height = compiled_system(caller, system, g), kind is Cord or conical_height is not None
    one, other = (height, None) if by_height else (None, speed_)
    found = _core.steady_shapes(of_core, one, other, g, turns, hanging, waves, proved, most, shared)
    limits = {"hanging_only": hanging and kind in (Chain, Rig), "conical_height": height, "angular_speed": speed_}
    return shapes_made(found, system, g, turns, **limits)


def _turning(
    caller: str, system: System, conical_height: float | None, angular_speed: float | None, gravity: float
) -> tuple[float, float, float]:
    """Return gravity, the conical height and the speed, of which the caller gives one."""
    if getattr(system, "weightless", False):
        if conical_height is not None:
            raise ValueError(
                f"{caller}: without gravity there is no conical height; give angular_speed, got {shown(conical_height)}"
            )
        if angular_speed is None:
            raise ValueError(f"{caller}: give angular_speed: without gravity tensions are as its square")
        speed = one_positive(caller, "angular_speed", angular_speed)
        if not LEAST <= speed * speed <= MOST:
            raise ValueError(f"{caller}: angular_speed must have a square from {LEAST:g} to {MOST:g}, got {speed:g}")
        return 0.0, 0.0, speed
    name, value = exactly_one(caller, conical_height=conical_height, angular_speed=angular_speed)
    g = one_positive(caller, "gravity", gravity)
    height, speed = _height_and_speed(name, value, g)
    if isinstance(system, Cord):
        one_positive(caller, f"the conical height of {name}", height)
    if isinstance(system, Held) and not LEAST <= height <= MOST:
        raise ValueError(f"{caller}: {name} must give a conical height from {LEAST:g} to {MOST:g}, got {value:g}")
    return g, height, speed


def _height_and_speed(name: str, value: float, gravity: float) -> tuple[float, float]:
    one, g = np.asarray(value), np.asarray(gravity)
    if name == "angular_speed":
        return float(_core.conical_pendulum_height(one, g)), value
    return value, float(_core.conical_pendulum_angular_speed(one, g))


@in_unit_of("angular_speed")
def steady_shape(
    system: Chain | Rig | Cord | Held,
    *,
    mode: int = 1,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    lowest_inclination: float | None = None,
    tip_radius: float | None = None,
    top_tension: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    direction: int = 1,
    min_conical_height: float | None = None,
) -> SteadyShape:
    """Return the steady shape on the branch of one mode at a speed, or the one with a given property.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system: a chain of N links (100,000 and more are possible), a rig, a cord, or a chain or cord held at a span.
    mode : int, optional
        Number of the mode at which the branch leaves the vertical, from 1 for the slowest. With the support off the axis it
        must be 1, the branch from rest; for shapes of other branches use `branches` and `Branch.at`. For a held system it is
        the number of half waves of the branch at high speed.
    conical_height : float
        Conical height of the speed, m, less than that of the mode. Give exactly one of this and the next four.
    angular_speed : float
        Speed, rad/s.
    lowest_inclination : float
        Magnitude of the inclination of the lowest link (of a cord: of its free end), rad: between 0 and pi/2, for an
        inverted link between pi/2 and pi. The link may lean either way; with the support off the axis it leans outwards.
    tip_radius : float
        Distance of the free end from the axis, m, on either side.
    top_tension : float
        Tension at the topmost pin (of a hanging system greater than its weight), or at the upper end of a held system; in N,
        or in the unit of the weights.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    direction : {1, -1}, optional
        Direction of rotation; only a rig with flywheels depends on it.
    min_conical_height : float, optional
        Conical height at which the search ends, m, less than that of the mode; if left out, half of a given height (or that
        of a given speed), else 1e-6 of that of the mode. Not used for a held system.

    Returns
    -------
    SteadyShape
        The shape, the first on the branch that has the property. Inclinations are within ``error_bound``, for chains proved
        except at a fold (measured: 2.3e-16), for cords estimated.
        For a held system and a speed it is the shape reached from the nearly straight chain; for a held system and a top
        tension it is the fastest shape of the branch with that tension.

    Raises
    ------
    ValueError
        If there is no such mode, if not exactly one number is given or it is out of its range, if the branch does not exist
        yet at that speed, or if no shape of the branch has the property; if a `Held` system is under a tension or has no
        gravity, comes with `lowest_inclination` or `tip_radius`, or has springs and comes with `top_tension`; if a rig has
        springs at pins, a dashpot at its support, linear drag or a free trolley.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.

    Notes
    -----
    Each step along the branch is checked, see `branch`. Cost: O(N); 0.7 s for 100,000 rods at twice the first critical
    speed. Source: Greenhill (1908), section 8 (4), (12).

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
    caller = "revchain.steady_shape"
    if not isinstance(system, System):
        raise no_system(caller, system)
    wanted = {"lowest_inclination": lowest_inclination, "tip_radius": tip_radius, "top_tension": top_tension}
    name, value = exactly_one(caller, conical_height=conical_height, angular_speed=angular_speed, **wanted)
    g, turns = one_positive(caller, "gravity", gravity), rotation(caller, direction)
    return shape_on_branch(caller, system, mode, name, value, g, turns, min_conical_height)


def shape_on_branch(
    caller: str,
    system: System,
    mode: int,
    name: str,
    value: float,
    gravity: float,
    direction: int = 1,
    lowest: float | None = None,
) -> SteadyShape:
    """The first shape on the branch of a mode with a number, such as ``angular_speed``; see `steady_shape`."""
    found = on_branch(caller, system, mode, name, value, gravity, direction, lowest, _core.steady_shape)
    speed = {}
    if hasattr(system, "span"):
        speed = {"angular_speed": value if name == "angular_speed" else float((gravity / found.conical_height) ** 0.5)}
    return shape_made(found, system, gravity, direction, **speed)


def on_branch(
    caller: str,
    system: System,
    mode: int,
    name: str,
    value: float,
    gravity: float,
    direction: int,
    lowest: float | None,
    question: Any,
) -> Any:
    """The compiled answer to a question about shapes on the branch of a mode."""
    number = counted(caller, "mode", mode)
    if held := isinstance(system, Held):
        _check_held(caller, system, number, name, value)
        if question is not _core.steady_shape:
            what = "mode is not available for a Held; use branches for the shapes along a branch"
            raise ValueError(f"{caller}: {what}, got {mode}")
    lowest = None if lowest is None else one_positive(caller, "min_conical_height", lowest)
    force = value
    if name == "top_tension":
        unit = system._force(gravity)
        if isinstance(system, Chain | Cord) and not value > (least := unit * system._total):
            what = type(system).__name__.lower()
            what = f"top_tension must be more than the weight {least:.6g} of the {what}"
            raise ValueError(f"{caller}: {what}, got {value:g}")
        force /= unit
    core = compiled_system(caller, system, gravity)
    try:
        return question(core, number, name, force, gravity, direction, lowest)
    except ValueError as error:
        reason = without_function(error)
        if name == "lowest_inclination":  # which C++ calls that of the tip
            reason = reason.replace("tip inclination", name)
        if name != "top_tension" or "tension" not in reason:
            raise ValueError(f"{caller}: {reason}") from None
        what = reason.rpartition(", got ")[0]  # the number there is the tension / gravity
        what += "; use branches for the tensions that it has" if held else ""
        raise ValueError(f"{caller}: {what}, got {value:g}") from None


def _check_held(caller: str, held: Held, mode: int, name: str, value: float) -> None:
    require_span(caller, held)
    if name not in ("conical_height", "angular_speed", "top_tension"):
        raise ValueError(
            f"{caller}: a held system has no free end; give conical_height, angular_speed or top_tension, got {name}"
        )
    most = max(held.size - 1, 1) * (1 if held.is_on_axis else 2)
    if held.size and mode > most:
        raise ValueError(f"{caller}: mode must be from 1 to {most}, got {mode}")
    if name == "top_tension" and not held.is_firm:
        raise ValueError(
            f"{caller}: top_tension is for firm ends; with springs give angular_speed, or read the speed from the "
            f"top_tension of a branch, got {value:g}"
        )


def require_span(caller: str, held: Held) -> None:
    """Raise a ValueError for a held system under a tension or without gravity: it has no branches."""
    if held.span is None:
        raise ValueError(
            f"{caller}: is for a system held at a span; under a tension use steady_shapes at a speed, or modes"
        )
    if held.weightless:
        why = "a shape is the same at every speed" if held.is_firm else "there are no branches"
        raise ValueError(f"{caller}: without gravity {why}; use steady_shapes")


def rotation(caller: str, direction: int) -> int:
    """Return `direction`; raise a ValueError unless it is 1 or -1."""
    if integer(caller, "direction", direction) not in (1, -1):
        raise ValueError(f"{caller}: direction must be 1 or -1, got {shown(direction)}")
    return int(direction)


def compiled_system(caller: str, system: System, gravity: float) -> Any:
    """The compiled system; a ValueError for a chain of too many links."""
    return compiled(caller, system) if isinstance(system, Chain) else system._under(gravity)
