# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain whose support is carried round, and a chain swinging by itself: small amplitudes."""

from __future__ import annotations

from typing import Any, overload

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.cord_motions import CordSwing
from ..results.motions import SWING, WHIRL_SWING, Response, Swing, WhirlSwing
from ..systems.chain import Chain, checked, compiled
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import (
    STANDARD_GRAVITY,
    Floats,
    Whole,
    array_of,
    floats,
    integer,
    limit,
    positive,
    real,
    refuse_where,
    shown,
)
from ..systems.rig import Rig
from .cords import Start, cord_swing
from .refuse import refuse_other

CORD_MODES = 40
"""Of a cord that swings, unless asked."""


def response(
    system: Chain | Rig,
    *,
    conical_height: ArrayLike | None = None,
    angular_speed: ArrayLike | None = None,
    gravity: float = STANDARD_GRAVITY,
    support_radius: float | None = None,
    pins: ArrayLike | None = None,
    threads: int = 1,
) -> Response:
    """Find the forced motion (base excitation) of a chain whose support is carried round a small circle, or to and fro.

    Parameters
    ----------
    system : Chain or Rig
        The chain of N links, or one rigged with a spring at its support (the spring's place of rest is then
        carried round), flywheels, inverted links, a fluid.
    conical_height : array_like, optional
        Heights ``gravity / angular_speed**2``, m, of any shape.
    angular_speed : array_like, optional
        Instead: speeds in rad/s, positive; negative, too, of a rig whose flywheels tell one direction
        from the other.
    gravity : float, optional
        For `angular_speed`, and for flywheels; standard gravity, in metres, if left out.
    support_radius : float, optional
        Radius of the circle, or amplitude to and fro, positive. Left out: the rig's own, or 1 where it
        has none: offsets are then over those of the support.
    pins : int or array_like of int, optional
        Only these pins, 0 the free end, N (or -1) the support; all N + 1 if left out. Long sweeps of
        long chains need less memory.
    threads : int, optional
        How many threads to use; 0 for all processors. Results are bitwise the same whatever their number.

    Returns
    -------
    Response
        Proved `error_bound` and counts. At a resonance, or nearer to one than 30 digits can tell, offsets
        are NaN and `resonant` says so.

    Raises
    ------
    TypeError
        If `system` is none of the four systems.
    ValueError
        For a cord and for what is held at both ends. If not exactly one of `conical_height` and `angular_speed` is given, for numbers that are not positive
        and finite or out of all proportion to the chain (1e75), and for pins there are not.

    Notes
    -----
    ``K y = M y / conical_height`` with the support's offset given; of small amplitude, as everything in
    this theory: where offsets are no longer small beside the links, multiply by a smaller radius.
    A chain slower than its first whirl speed goes out with its support. Past each whirl speed its motion is turned
    round; between two there is a speed at which a pin stays on the axis.
    Lowest links that weigh nothing in a fluid that turns with them hang along with the link above.

    Method: dynamic stiffness carried up in words of two doubles, several speeds to a pass, with a running bound.
    Accuracy: half an ulp of each offset until the speed is within 1e-12 or so of a resonance. Cost: about
    0.03 microseconds for each link and speed. Other Python threads run on meanwhile.

    References
    ----------
    Greenhill (1908), section 1 (9): one plummet, ``support_radius * height / (height - length)``.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.response(rc.Chain(weight=1.0, length=1.0), conical_height=[4.0, 0.5]).offset[:, 0]
    array([ 1.33333333, -1.        ])
    >>> hand = rc.response(rc.Chain.uniform_rods(120, length=0.36), angular_speed=6.0, support_radius=0.01, pins=0)
    >>> round(float(hand.offset), 4), int(hand.modes_below)
    (0.1786, 0)
    """
    place = "revchain.response"
    either_sense, own = False, 1.0
    refuse_other(place, system, (Chain, Rig), {Cord: "ask its chain: cord.chain(100)", Held: "ask steady_shapes"})
    if isinstance(system, Rig):
        either_sense, own = system.has_momentum, system.support.radius or 1.0
    if (conical_height is None) == (angular_speed is None):
        raise ValueError(f"{place}: give either conical_height or angular_speed")
    g = float(positive(place, "gravity", real(place, "gravity", gravity)))
    radius = own
    if support_radius is not None:
        radius = float(positive(place, "support_radius", real(place, "support_radius", support_radius)))
    if angular_speed is None:
        assert conical_height is not None
        given = positive(place, "conical_height", conical_height)
        height, speed = given, np.asarray(_core.conical_pendulum_angular_speed(given, np.full(given.shape, g)))
    else:
        given = floats(place, "angular_speed", angular_speed)
        if either_sense:
            wrong = ~((given != 0) & np.isfinite(given))
            refuse_where(wrong, given, f"{place}: angular_speed must be finite and not 0")
        else:
            positive(place, "angular_speed", given)
        height, speed = np.asarray(_core.conical_pendulum_height(np.abs(given), np.full(given.shape, g))), given
    which, axis = _pins(place, pins, system.size)
    asked = (given.reshape(-1), angular_speed is not None, radius, which.reshape(-1), g, integer(place, "threads", threads))
    if isinstance(system, Rig):
        found = _core.rig_response(system._under(g), *asked)
    else:
        found = _core.response(compiled(place, system), *asked)
    offset, bound, below, against, resonant, force, force_error = found
    shape = given.shape
    return Response._made(
        None,
        system=system,
        gravity=g,
        conical_height=np.array(height),
        angular_speed=np.array(speed),
        support_radius=radius,
        pins=which,
        offset=offset.reshape(shape + axis),
        error_bound=bound.reshape(shape),
        modes_below=below.reshape(shape),
        reversed=against.reshape(shape),
        resonant=resonant.reshape(shape),
        support_force=np.asarray(system._force(g) * force.reshape(shape)),
        support_force_error=np.asarray(system._force(g) * force_error.reshape(shape)),
    )


def _pins(place: str, pins: ArrayLike | None, size: int) -> tuple[Whole, tuple[int, ...]]:
    """Numbers of the pins asked for, and the axis they make."""
    if pins is None:
        return np.arange(size + 1), (size + 1,)
    asked = array_of(pins)
    if asked.dtype.kind not in "iu" and asked.size:
        raise ValueError(f"{place}: pins must be whole numbers, got {shown(pins)}")
    if asked.ndim > 1:
        raise ValueError(f"{place}: pins must be one number or a list of them, got an array of shape {asked.shape}")
    asked = asked.astype(np.int64)
    wrong = (asked < -(size + 1)) | (asked > size)
    if wrong.any():
        raise ValueError(f"{place}: pins must be numbers from 0 to {size}, got {asked[wrong].flat[0]}")
    return np.where(asked < 0, asked + size + 1, asked), asked.shape


@overload
def swing(
    system: Chain,
    offset: ArrayLike,
    velocity: ArrayLike | None,
    time: ArrayLike,
    *,
    count: int | None = ...,
    arc_length: ArrayLike | None = ...,
    gravity: float = ...,
) -> Swing: ...
@overload
def swing(
    system: Cord,
    offset: Start | None,
    velocity: Start | None,
    time: ArrayLike,
    *,
    count: int | None = ...,
    arc_length: ArrayLike | None = ...,
    gravity: float = ...,
) -> CordSwing: ...
@overload
def swing(
    system: Rig,
    offset: ArrayLike,
    velocity: ArrayLike | None,
    time: ArrayLike,
    *,
    count: int | None = ...,
    arc_length: ArrayLike | None = ...,
    gravity: float = ...,
) -> Swing | WhirlSwing: ...
def swing(
    system: Chain | Cord | Rig,
    offset: Start | None,
    velocity: Start | None,
    time: ArrayLike,
    *,
    count: int | None = None,
    arc_length: ArrayLike | None = None,
    gravity: float = STANDARD_GRAVITY,
) -> Swing | CordSwing | WhirlSwing:
    """Start a hanging chain, rig or cord anywhere and see it swing, by superposing its modes.

    Small oscillations in one plane, of natural angular frequencies that are the whirl speeds of `modes`. For motions in
    both directions ask for each: they are independent, but where a `Rig` has flywheels with momentum. These turn the
    plane of the swing: offsets and velocities are then complex, x + i y.

    Parameters
    ----------
    system : Chain, Rig or Cord
        The chain of N links, what it is rigged with, or a flexible cord.
    offset : array_like, shape (N + 1,) or (N,)
        Offsets of the pins at time 0, m, free end first; that of the support last or left out: 0, but of a `Rig` whose
        support yields. Of a cord a
        continuous function of the distance from the free end, or numbers at `arc_length`, straight between them; None:
        on the axis.
    velocity : array_like, shape (N + 1,) or (N,), or None
        Likewise, m/s; None: at rest.
    time : array_like
        Times in s, of either sign, a number or one axis.
    count : int, optional
        Only so many of the slowest modes; all if left out, of a cord 40. With momentum those of both senses count.
    arc_length : array_like, optional
        Cords: distances from the free end at which to look, m, ascending; for numbers as `offset` or `velocity` from 0 to
        the length. If left out: evenly spaced, as many as numbers are given, or 101.
    gravity : float, optional
        In m/s^2; standard gravity if left out.

    Returns
    -------
    Swing, WhirlSwing or CordSwing
        The offset of pin m at time i is within ``error_bound[i] + truncation_error[m]`` of the exact one. Of a cord the
        offset of place m is within ``error_estimate[m]``. A `WhirlSwing` for a rig with momentum.

    Raises
    ------
    TypeError
        If `system` is none of the four systems.
    ValueError
        For what is held at both ends; for numbers that are not finite, starts of another length, a support that would
        move, more modes than there are, and weights more than 1e123 apart; for a function that jumps, and `arc_length` of
        a chain. For a rig whose straight position is unstable, with the rate at which it falls; whose support is carried
        round (ask `response`); in a fluid that turns; with momentum and pins without inertia; for complex starts without
        momentum.

    Notes
    -----
    Pins that have no inertia, between massless threads, cannot be anywhere: offsets given for them are
    replaced by those to which their neighbours pull them, and velocities likewise, as a light thread snaps
    straight. `Swing.projected` says that it was done.

    Links of a `Rig` do not turn about their own axes: of its wheels `momentum` alone plays a part (a driven wheel's is that
    of its spin). Still fluid bears, and moves as the added mass says.

    Method: heights and shapes as of `modes`, once more in words of two doubles, with angles in two words: beats of
    many years keep their phase. Accuracy: 1e-15 of the amplitudes. Cost: 2 microseconds for each link
    and mode, 2 ns for each link, mode and time.

    References
    ----------
    Greenhill (1908), sections 2 and 8.

    Examples
    --------
    A light point mass below a heavy one: they take turns.

    >>> import numpy as np
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[0.01, 1.0], length=1.0)
    >>> beat = rc.swing(chain, [0.01, 0.01, 0.0], None, np.linspace(0.0, 20.0, 2001))
    >>> round(float(abs(beat.offset[:, 0]).max()), 4), round(float(abs(beat.offset[:, 1]).max()), 4)
    (0.1002, 0.01)

    A cord drawn aside at its free end, and let go:

    >>> cord = rc.Cord(1.0, mass=0.5, tip_mass=0.2)
    >>> found = rc.swing(cord, lambda s: 0.1 * (1 - s), None, [0.0, 1.0])
    >>> round(float(found.offset[1, 0]), 4), bool(found.error_estimate.max() < 1e-4)
    (-0.0959, True)
    """
    place = "revchain.swing"
    refuse_other(place, system, (Chain, Rig, Cord), {Held: "ask its modes"})
    times = floats(place, "time", time)
    if times.ndim > 1:
        raise ValueError(f"{place}: time must be a number or have one axis, got an array of shape {times.shape}")
    refuse_where(~np.isfinite(times), times, f"{place}: time must be finite")
    number = None if count is None else limit(place, "count", integer(place, "count", count))
    g = float(positive(place, "gravity", real(place, "gravity", gravity)))
    times = np.atleast_1d(times)
    if isinstance(system, Cord):
        kept = CORD_MODES if number is None else number
        return cord_swing(place, system, offset, velocity, times, arc_length, kept, g)
    if arc_length is not None:
        raise ValueError(f"{place}: arc_length is for a Cord; pins of a Chain are where they are, got {shown(arc_length)}")
    if isinstance(system, Rig) and system.has_momentum:
        return _whirling(place, system, offset, velocity, times, number, g)
    start = _start(place, "offset", offset, system)
    speed = _start(place, "velocity", np.zeros(system.size) if velocity is None else velocity, system)
    asked = (start, speed, times, number, g)
    if isinstance(system, Rig):
        swung = checked(place, system.by_mass, _core.rig_swing, system._under(g), *asked)
    else:
        swung = _core.swing(compiled(place, system), *asked)
    found: dict[str, Any] = dict(zip(SWING, swung, strict=True))
    if system.by_mass:
        found |= {name: g * found[name] for name in ("energy", "energy_left_out")}
    return Swing._made(None, system=system, gravity=g, time=np.array(times), **found)


def _whirling(
    place: str, rig: Rig, offset: Any, velocity: Any, times: Floats, count: int | None, gravity: float
) -> WhirlSwing:
    start = _start(place, "offset", offset, rig)
    speed = _start(place, "velocity", np.zeros(rig.size) if velocity is None else velocity, rig)
    asked = (start.astype(np.complex128), speed.astype(np.complex128), times, count, gravity)
    swung = checked(place, rig.by_mass, _core.whirl_swing, rig._under(gravity), *asked)
    found: dict[str, Any] = dict(zip(WHIRL_SWING, swung, strict=True))
    if rig.by_mass:
        found |= {name: gravity * found[name] for name in ("energy", "energy_left_out")}
    return WhirlSwing._made(None, system=rig, gravity=gravity, time=np.array(times), **found)


def _start(place: str, name: str, value: Any, system: Chain | Rig) -> Any:
    """Numbers for the pins; complex ones for a rig whose momentum turns the plane of the swing."""
    size, array = system.size, array_of(value)
    if array.dtype.kind != "c":
        array = floats(place, name, value)
    elif not (isinstance(system, Rig) and system.has_momentum):
        raise ValueError(
            f"{place}: {name} must be real: without momentum of flywheels the two level directions are independent; ask "
            f"for each, got {shown(value)}"
        )
    if array.shape not in ((size,), (size + 1,)):
        raise ValueError(
            f"{place}: {name} must have shape ({size + 1},), a number for each pin, or ({size},), the support's 0 "
            f"left out, got {array.shape}"
        )
    refuse_where(~np.isfinite(array), array, f"{place}: {name} must be finite")
    return array
