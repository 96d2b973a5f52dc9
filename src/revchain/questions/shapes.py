# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of a whirling chain at any inclination: all of them, proved complete."""

from __future__ import annotations

import numpy as np

from .. import _core
from ..results.shapes import SteadyShapes, shapes_made
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, boolean, exactly_one, integer, limit, one_positive, shown
from ..systems.rig import Rig


def steady_shapes(
    chain: Chain | Rig,
    *,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    budget: int = 3_000_000,
    hanging_only: bool = True,
    sense: int = 1,
) -> SteadyShapes:
    """Find all shapes in which a chain, or a rig, whirls steadily at a given speed, at any inclination.

    Parameters
    ----------
    chain : Chain or Rig
        The chain of N links, or what it is rigged with: a support on a spring or carried round, flywheels, a fluid.
    conical_height : float
        Conical height of the speed, in the unit of the chain's lengths, positive.
    angular_speed : float
        Instead of `conical_height`: the speed in rad/s, positive.
    gravity : float, optional
        For `angular_speed`, and for a rig's flywheels; standard gravity, in metres, if left out.
    budget : int, optional
        How many links to look at, at the most, while parts of the range of the lowest link's inclination are
        split: half a microsecond each, or two where ``l < a``; the default takes some 2 to 10 seconds. With 0
        and less nothing is looked at, and the list is empty and not complete.
    hanging_only : bool, optional
        Whether to leave out shapes with links that stand: more than a right angle from the downward
        vertical. Of a rig: shapes with links that do not stand or hang as the rig has them.
    sense : {1, -1}, optional
        Direction of rotation; it matters to a rig with flywheels.

    Returns
    -------
    SteadyShapes
        A sequence of `SteadyShape`: every hanging shape (all links within a right angle of the
        downward vertical) or, if `hanging_only` is false, every shape; straight ones left out, of two
        mirror images that with the free end at a positive offset (if it is on the axis, the lowest
        inclined link); by half waves, then inclination of the lowest link. ``complete`` is true where it
        is proved that none is missing. Inclinations within ``error_bound``, proved, mostly 2.2e-16.
        Empty and complete where the height is greater than the first of `modes`, in any posture.
        If the support is carried round: every shape, outwards positive, those inwards too.

    Raises
    ------
    ValueError
        If not exactly one of `conical_height` and `angular_speed` is given, a number is not positive
        and finite, `sense` is neither 1 nor -1, or a link of a rig has no effective tension (tension and
        speed times momentum over length) at the speed.
    TypeError
        If `chain` is neither a `Chain` nor a `Rig`, or `hanging_only` is not a bool.

    Notes
    -----
    Interval arithmetic with first and second derivatives of the upward sweep, Greenhill (1908) section
    8 (4), (12); Newton's method on all pins in two words. A link that stands, or is so heavy off its
    pins (``pendulum_length > length``) that it hangs at three inclinations under one load, is followed
    along every one of them. Not complete: at exactly a critical speed or where two shapes are born, and
    where the budget ends. At heights below some 2e-15 of the longest link the list is empty and not
    complete: two words of double precision no longer hold the offsets that give the tensions. Cost: 15 milliseconds for 84 hanging shapes of eight plummets, about 30 for
    all 64 shapes of four; shapes, and time, about double with each link, and grow fourfold if links may
    stand.

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

    A chair on a chain of 4 m, on an arm of 1 m, at twelve turns a minute; and at 3 rad/s, where it could also
    hang inwards in two ways:

    >>> carousel = rc.Rig(rc.Chain(weight=800.0, length=4.0), support_radius=1.0)
    >>> rc.steady_shapes(carousel, angular_speed=1.2566)
    1 shape at 1.25660 rad/s, proved complete
    shape  half waves  lowest link (°)  top link (°)  free end: off axis (m)  height (m)  top tension  error (rad)
        1           1           21.824        21.824                  2.4870     -3.7133       861.76      2.2e-16
    inclinations: to the downward vertical; error: proved bound of every inclination
    >>> [round(float(np.degrees(s.inclination[0])), 1) for s in rc.steady_shapes(carousel, angular_speed=3.0)]
    [77.5, -68.1, -20.7]
    """
    place = "revchain.steady_shapes"
    name, value = exactly_one(place, conical_height=conical_height, angular_speed=angular_speed)
    most = limit(place, "budget", budget)
    hanging = boolean(place, "hanging_only", hanging_only)
    if integer(place, "sense", sense) not in (1, -1):
        raise ValueError(f"{place}: sense must be 1 or -1, got {shown(sense)}")
    g, turns = one_positive(place, "gravity", gravity), int(sense)
    if name == "angular_speed":
        height, speed = float(_core.conical_pendulum_height(np.asarray(value), np.asarray(g))), value
    else:
        height, speed = value, float(_core.conical_pendulum_angular_speed(np.asarray(value), np.asarray(g)))
    if isinstance(chain, Rig):
        rig = chain._compiled
        if name == "conical_height":
            return shapes_made(_core.steady_shapes_of_rig(rig, value, most, hanging, turns, g), chain, height, speed, g, turns)
        return shapes_made(_core.steady_shapes_of_rig_at_speed(rig, turns * value, most, hanging, g), chain, height, speed, g, turns)
    core = compiled(place, chain)
    if name == "conical_height":
        return shapes_made(_core.steady_shapes(core, value, most, hanging), chain, height, speed, g, turns)
    return shapes_made(_core.steady_shapes_at_speed(core, value, g, most, hanging), chain, height, speed, g, turns)
