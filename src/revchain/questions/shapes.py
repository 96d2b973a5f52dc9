# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes (relative equilibria) at any inclination."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import _core
from ..results.bent import cord_shapes_made, held_shapes_made
from ..results.shapes import SteadyShapes, shapes_made
from ..systems.chain import Chain, compiled
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, boolean, exactly_one, integer, limit, one_positive, shown
from ..systems.numbers import count as counted
from ..systems.rig import Rig
from .refuse import no_system

LEAST, MOST = 1e-150, 1e150
"""Limits of conical heights, and of squared speeds without gravity; products with tensions then stay finite."""
MOST_HALF_WAVES = 1000
_BUDGET = {False: 3_000_000, True: 300_000}


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
    scanned: int = 200,
    threads: int = 1,
) -> SteadyShapes:
    """Return all steady shapes (relative equilibria) of a system at a given speed, at any inclination.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system: a chain of N links, a rig, a cord, or a chain or cord held at both ends.
    angular_speed : float
        Speed, rad/s, positive.
    conical_height : float
        Conical height of the speed, m, positive, instead of `angular_speed`. It does not exist without gravity.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out. Not used for a weightless held system.
    budget : int, optional
        Largest number of links to visit while the range of inclinations of the lowest link is split. Chains and rigs:
        3,000,000 if left out, at half a microsecond each (two if ``l < a``), about 2 to 10 seconds in all; with 0 or less
        the list is empty and not complete. Held chains: 300,000 if left out, at 1 to 2 microseconds each; with 0
        completeness is not proved.
    hanging_only : bool, optional
        Chains and rigs: whether to leave out shapes in which a link is inverted, that is, at more than a right angle to
        the downward vertical. For a rig: whether to leave out shapes with other links inverted than those of the rig.
    direction : {1, -1}, optional
        Direction of rotation; only a rig with flywheels depends on it.
    max_half_waves : int, optional
        For `Held` systems: search only for shapes with at most this number of half waves.
    prove : bool, optional
        Held chains: whether to prove error bounds and completeness; else the bounds are estimates.
    scanned : int, optional
        Cords for which no theorem counts the shapes: number of offsets of the free end to examine.
    threads : int, optional
        Number of threads for chains and rigs; 0 for all processors. Results are bitwise equal for any number. Threads
        share the refinement of the shapes, not the search, which is about half of the work.

    Returns
    -------
    SteadyShapes
        A sequence of shapes.

        Chains and rigs: every hanging shape (all links within a right angle of the downward vertical) or, if
        `hanging_only` is false, every shape. Straight shapes are left out. Of two mirror images the one with the free end
        at a positive offset is given (if that is 0, the one with a positive inclination of the lowest inclined link). If
        the support is carried round there are no mirror images; outwards is positive. The order is by half waves, then by
        inclination of the lowest link. ``complete`` is true if it is proved that none is missing among those asked for. Inclinations are within
        the proved ``error_bound``, usually 2.2e-16. The list is empty and complete if the height exceeds that of the
        first mode, in any posture.

        Cords: ordered by half waves. ``complete`` is true if a theorem counts the shapes: there is then one for each
        critical height above the given height. This holds for a uniform cord with or without a tip, and for a density
        ``s**p`` without a tip, or with a tip if p is below 0. It also holds if at most one critical height lies above the
        given one. Otherwise a shape that exists only between two scanned offsets is missed.

        Held systems: shapes of 1 to `max_half_waves` half waves, ordered by half waves. Among shapes with equally many,
        the one that is reached from the nearly straight chain without gravity, as the ends approach and gravity then
        grows, comes first. Each link points along the pull on it, as a thread does. Of two mirror images the one whose
        lowest link leads outwards is given; ends off the axis have no mirror images. Half waves are counted about the
        line between the ends (with springs: between their rest positions). ``missing`` lists the half waves without a
        shape. Held chains: ``complete`` is true if it is proved that there are no other shapes with these numbers of
        half waves; else ``undecided`` gives the inclinations of the lowest link at which others may start. The proof
        usually succeeds for one half wave of 3 to 9 links with ``l <= a`` and mass at every pin. With 20 links and more
        it often leaves a few hundredths of a radian; for more half waves it seldom succeeds. If both ends are off the
        axis, a shape need not lie in a plane. Only shapes in the plane of the ends are searched for, and ``complete``
        is false. Held cords: ``complete`` is true for a span without gravity, which has one shape for each number of
        half waves.

    Raises
    ------
    ValueError
        If not exactly one of `angular_speed` and `conical_height` is given, a number is not positive
        and finite, `direction` is neither 1 nor -1, or a link of a rig has no effective tension (tension plus
        speed times momentum divided by length) at the speed.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`, or `hanging_only` or `prove` is not a bool.

    Notes
    -----
    Chains and rigs. Method: interval arithmetic with first and second derivatives of the upward sweep, Greenhill (1908),
    section 8 (4), (12), then Newton's method on all pins in double-double. A link that is inverted, or whose
    ``pendulum_length > length``, can have three inclinations under one load; all are followed. The list is not complete
    exactly at a critical speed or where two shapes start, or if the budget ends. For heights below about 2e-15 of the
    longest link it is empty and not complete: double-double cannot represent the offsets from which the tensions follow.
    Cost: 15 milliseconds for 84 hanging shapes of eight plummets, about 30 for all 64 shapes of four plummets. The
    number of shapes and the time roughly double with each link; if links may be inverted they quadruple.

    Cords. Method: power series along the cord, Newton's method on the point where it crosses the axis. Inclinations,
    and offsets divided by the length, are within ``error_estimate``.

    Held systems. Accuracy: inclinations of chains are correctly rounded to within 1e-20, with a bound that is usually
    proved; positions on cords are within 1e-13 of the length. Completeness: Krawczyk's test on the pull along the
    lowest link and its inclination, 0.05 to 0.5 s.

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
    1 hanging shape at 1.25660 rad/s (12.00 rpm), proved complete
    shape  half waves  lowest link (°)  top link (°)  free end: from axis (m)  above support (m)  top tension  error (rad)
        1           1           21.824        21.824                   2.4870            -3.7133       861.76      2.2e-16
    inclinations: from the downward vertical; error: proved bound on every inclination
    hanging_only=False also looks for shapes with links above their pins
    >>> [round(float(np.degrees(s.inclination[0])), 1) for s in rc.steady_shapes(carousel, angular_speed=3.0)]
    [77.5, -68.1, -20.7]

    A blade with exactly one shape, and one that turns too slowly to have any:

    >>> blade = rc.Held(rc.Chain.uniform_rods(10, length=1.0), span=0.51)
    >>> found = rc.steady_shapes(blade, angular_speed=15.0)
    >>> len(found), found.complete
    (1, True)
    >>> slow = rc.steady_shapes(blade, angular_speed=1.0)
    >>> slow.missing, slow.complete
    ((1,), True)

    A cord, and a skipping rope with one and two half waves:

    >>> cord = rc.Cord(500.0)
    >>> found = rc.steady_shapes(cord, conical_height=1.0)
    >>> len(found), found.complete, round(float(found[13].offset[0]), 9)
    (14, True, 2.705556715)
    >>> rope = rc.Held(rc.Cord(1.0), span=0.5)
    >>> [round(float(shape.offset.max()), 4) for shape in rc.steady_shapes(rope, conical_height=0.05, max_half_waves=2)]
    [0.402, 0.2013]
    """
    place = "revchain.steady_shapes"
    most = limit(place, "budget", _BUDGET[isinstance(system, Held)] if budget is None else budget)
    hanging = boolean(place, "hanging_only", hanging_only)
    if integer(place, "direction", direction) not in (1, -1):
        raise ValueError(f"{place}: direction must be 1 or -1, got {shown(direction)}")
    waves = counted(place, "max_half_waves", max_half_waves)
    if waves > MOST_HALF_WAVES:
        raise ValueError(f"{place}: max_half_waves must be at most {MOST_HALF_WAVES}, got {waves}")
    looks = integer(place, "scanned", scanned)
    if not 1 <= looks <= 10**6:
        raise ValueError(f"{place}: scanned must be from 1 to 1000000, got {looks}")
    proved = boolean(place, "prove", prove)
    shared = integer(place, "threads", threads)
    if isinstance(system, Held) and system.weightless:
        return _weightless(place, system, conical_height, angular_speed, (waves, proved, most))
    name, value = exactly_one(place, conical_height=conical_height, angular_speed=angular_speed)
    g = one_positive(place, "gravity", gravity)
    if name == "angular_speed":
        height, speed = float(_core.conical_pendulum_height(np.asarray(value), np.asarray(g))), value
    else:
        height, speed = value, float(_core.conical_pendulum_angular_speed(np.asarray(value), np.asarray(g)))
    if isinstance(system, Cord):
        one_positive(place, f"the conical height of {name}", height)
        return cord_shapes_made(_core.cord_shapes(system._under(g), height, looks), system, height, speed, g, looks)
    if isinstance(system, Held):
        if not LEAST <= height <= MOST:
            raise ValueError(f"{place}: {name} must give a conical height from {LEAST:g} to {MOST:g}, got {value:g}")
        given = (value, None) if name == "conical_height" else (None, value)
        return _held(system, height, speed, g, (*given, g, waves, proved, most))
    if isinstance(system, Rig):
        core = system._under(g)
        if name == "conical_height":
            found = _core.steady_shapes_of_rig(core, value, most, hanging, int(direction), g, shared)
        else:
            found = _core.steady_shapes_of_rig_at_speed(core, int(direction) * value, most, hanging, g, shared)
    elif not isinstance(system, Chain):
        raise no_system(place, system)
    elif name == "conical_height":
        found = _core.steady_shapes(compiled(place, system), value, most, hanging, shared)
    else:
        found = _core.steady_shapes_at_speed(compiled(place, system), value, g, most, hanging, shared)
    return shapes_made(found, system, height, speed, g, int(direction), hanging)


def _weightless(
    place: str, held: Held, conical_height: Any, angular_speed: Any, how: tuple[int, bool, int]
) -> SteadyShapes:
    if conical_height is not None:
        raise ValueError(
            f"{place}: without gravity there is no conical height; give angular_speed, got {shown(conical_height)}"
        )
    speed = one_positive(place, "angular_speed", angular_speed) if angular_speed is not None else None
    if speed is None:
        raise ValueError(f"{place}: give angular_speed: without gravity tensions are as its square")
    if not LEAST <= speed * speed <= MOST:
        raise ValueError(f"{place}: angular_speed must have a square from {LEAST:g} to {MOST:g}, got {speed:g}")
    return _held(held, 0.0, speed, 0.0, (None, speed, 0.0, *how))


def _held(held: Held, height: float, speed: float, gravity: float, asked: tuple[Any, ...]) -> SteadyShapes:
    by = (held.span, held._pull(gravity), held.weightless, *held._ends(gravity))
    return held_shapes_made(_core.held_shapes(held.system._compiled, *by, *asked), held, height, speed, gravity, asked)
