# SPDX-License-Identifier: GPL-3.0-or-later
"""Small motions of a chain: forced by a moving support (`response`), and free (`swing`)."""

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
"""Default number of modes of a swinging cord."""


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
    """Return the forced motion (base excitation) of a chain whose support moves in a small circle or to and fro.

    Parameters
    ----------
    system : Chain or Rig
        A chain of N links, or a rig. With a spring at the support, its rest position moves.
    conical_height : array_like, optional
        Conical heights ``gravity / angular_speed**2``, m, any shape. Give either this or `angular_speed`.
    angular_speed : array_like, optional
        Speeds in rad/s, positive; for a rig with flywheels also negative (backward).
    gravity : float, optional
        Acceleration of gravity, m/s^2, for `angular_speed` and for flywheels; standard gravity if left out.
    support_radius : float, optional
        Radius of the circle, or amplitude to and fro, m, positive. If left out, the radius of the rig, or 1 if it has
        none: offsets are then relative to that of the support.
    pins : int or array_like of int, optional
        Pins to return, from 0 (free end) to N or -1 (support); all N + 1 if left out. Fewer pins save memory in long
        sweeps.
    threads : int, optional
        Number of threads; 0 for all processors. Results are bitwise equal for any number.

    Returns
    -------
    Response
        The offsets, with a proved `error_bound` and proved counts of modes. At a resonance, or closer to one than 30
        digits can separate, offsets are NaN and `resonant` is true.

    Raises
    ------
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.
    ValueError
        If `system` is a `Cord` or a `Held`; if not exactly one of `conical_height` and `angular_speed` is given; if a
        number is not positive and finite or differs from the chain's by a factor of 1e75; if there is no such pin.

    Notes
    -----
    The offsets solve ``K y = M y / conical_height`` for the given offset of the support. The theory is linear: offsets
    must be small compared with the links; scale them with the radius. Below the first whirl speed the chain moves in
    phase with its support. The motion changes sign at each whirl speed; between two whirl speeds there is a speed at
    which a pin stays on the axis. Lowest links without net weight in a fluid that turns with them stay in line with the
    link above.

    Method: upward sweep of the dynamic stiffness in double-double, several speeds at a time, with a running error bound.
    Accuracy: half an ulp of each offset, unless the speed is within about 1e-12 of a resonance. Cost: about 0.03
    microseconds for each link and speed. Other Python threads can run meanwhile.

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
    refuse_other(place, system, (Chain, Rig), {Cord: "use its chain: cord.chain(100)", Held: "use steady_shapes"})
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
    """Numbers of the pins asked for, and the shape of their axis."""
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
    """Return the small free oscillations of a hanging chain, rig or cord from any initial state, as a sum of modes.

    The motion is in one plane; its natural angular frequencies are the whirl speeds of `modes`. Motions in the two
    horizontal directions are independent: call the function for each. Flywheels with momentum turn the plane of the
    swing; offsets and velocities of such a `Rig` are complex, x + i y.

    Parameters
    ----------
    system : Chain, Rig or Cord
        A chain of N links, a rig, or a cord.
    offset : array_like, shape (N + 1,) or (N,)
        Offsets of the pins at time 0, m, free end first. The last one, of the support, may be left out; it must be 0
        unless a `Rig` has a support that yields. For a cord: a continuous function of the distance from the free end, or
        numbers at `arc_length` with straight lines between them, or None for a cord on the axis.
    velocity : array_like, shape (N + 1,) or (N,), or None
        Velocities of the pins at time 0, m/s, in the same form; None for a start from rest.
    time : array_like
        Times in s, positive or negative; a number or an array with one axis.
    count : int, optional
        Number of modes, slowest first; if left out, all, or 40 for a cord. With momentum, modes of both directions count.
    arc_length : array_like, optional
        For a cord: distances from the free end of the points to return, m, ascending. They must go from 0 to the length
        if `offset` or `velocity` are numbers. If left out, the points are evenly spaced: one for each number, or 101.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.

    Returns
    -------
    Swing, WhirlSwing or CordSwing
        `WhirlSwing` for a rig with momentum, `CordSwing` for a cord. The offset of pin m at time i is within
        ``error_bound[i] + truncation_error[m]`` of the exact one; for a cord the offset of place m is within
        ``error_estimate[m]``.

    Raises
    ------
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.
    ValueError
        If `system` is a `Held`; if a number is not finite, a start has another length or moves a firm support, `count`
        exceeds the number of modes, or weights differ by more than a factor of 1e123; if a function jumps, or `arc_length`
        comes with a chain. For a rig: if its straight position is unstable (the message gives the growth rate), if its
        support is carried round (use `response`), if the fluid turns, if it has momentum and pins without inertia, or if a
        start is complex without momentum.

    Notes
    -----
    Pins without inertia (between massless threads) have no free offset. Offsets and velocities given for them are
    replaced by those to which their neighbours pull them, as a light thread snaps straight; `Swing.projected` is then
    true.

    Links of a `Rig` do not turn about their own axes: a wheel acts only by its momentum (a driven wheel by that of its
    spin). Still fluid acts by its buoyancy and its added mass.

    Method: heights and shapes as in `modes`, in double-double, with angles in double-double, so that beats of many years
    keep their phase. Accuracy: 1e-15 of the amplitudes. Cost: 2 microseconds for each link and mode, and 2 ns for each
    link, mode and time.

    References
    ----------
    Greenhill (1908), sections 2 and 8.

    Examples
    --------
    A light point mass below a heavy one: they beat.

    >>> import numpy as np
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[0.01, 1.0], length=1.0)
    >>> beat = rc.swing(chain, [0.01, 0.01, 0.0], None, np.linspace(0.0, 20.0, 2001))
    >>> round(float(abs(beat.offset[:, 0]).max()), 4), round(float(abs(beat.offset[:, 1]).max()), 4)
    (0.1002, 0.01)

    A cord pulled aside at its free end and released:

    >>> cord = rc.Cord(1.0, mass=0.5, tip_mass=0.2)
    >>> found = rc.swing(cord, lambda s: 0.1 * (1 - s), None, [0.0, 1.0])
    >>> round(float(found.offset[1, 0]), 4), bool(found.error_estimate.max() < 1e-4)
    (-0.0959, True)
    """
    place = "revchain.swing"
    refuse_other(place, system, (Chain, Rig, Cord), {Held: "use its modes"})
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
        raise ValueError(f"{place}: arc_length is for a Cord; a Chain has pins, leave it out, got {shown(arc_length)}")
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
    """Start values of the pins; complex for a rig whose momentum turns the plane of the swing."""
    size, array = system.size, array_of(value)
    if array.dtype.kind != "c":
        array = floats(place, name, value)
    elif not (isinstance(system, Rig) and system.has_momentum):
        raise ValueError(
            f"{place}: {name} must be real: without momentum of flywheels the two horizontal directions are independent; solve "
            f"for each, got {shown(value)}"
        )
    if array.shape not in ((size,), (size + 1,)):
        raise ValueError(
            f"{place}: {name} must have shape ({size + 1},), a number for each pin, or ({size},), the support's 0 "
            f"left out, got {array.shape}"
        )
    refuse_where(~np.isfinite(array), array, f"{place}: {name} must be finite")
    return array
