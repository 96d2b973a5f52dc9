# SPDX-License-Identifier: GPL-3.0-or-later
"""`swing`: the free motion of small amplitude after a release."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.motions import Swing
from ..systems.chain import Chain, checked
from ..systems.cord import Cord
from ..systems.numbers import STANDARD_GRAVITY, Floats, array_of, floats, integer, limit, one_positive, real, refuse_where, shown
from ..systems.rig import Rig
from ..systems.support_motion import SupportMotion
from .refuse import refuse_other

Start = ArrayLike | Callable[[float], float]
CORD_MODES = 40  # default number of modes of a cord
_CALLER = "revchain.swing"
_IN_A_PLANE = (
    *("offset", "velocity", "angular_frequency", "energy", "shape", "cosine", "sine", "start", "projected"),
    *("energy_left_out", "truncation_error", "error_bound"),
)
_TURNING = (
    *("offset", "velocity", "angular_frequency", "amplitude", "energy", "shape", "energy_left_out", "truncation_error"),
    "error_bound",
)
_OF_A_CORD = (
    *("offset", "velocity", "angular_frequency", "energy", "shape", "cosine", "sine", "energy_left_out"),
    "truncation_error",
)


def swing(
    system: Chain | Cord | Rig,
    time: ArrayLike,
    *,
    offset: Start | None = None,
    velocity: Start | None = None,
    support: SupportMotion | None = None,
    count: int | None = None,
    arc_length: ArrayLike | None = None,
    gravity: float = STANDARD_GRAVITY,
) -> Swing:
    """Return the small oscillations of a chain, rig or cord from an initial state: the sum of its modes.

    The support may be moved: a crane that brakes, a ship that rolls. Dashpots and linear drag damp the motion.

    The motion is in one plane; without damping its natural angular frequencies are the whirl speeds of `modes`, of links
    that do not turn about their own axes. Motions in the two horizontal directions are independent: call the function for
    each. Flywheels with momentum turn the plane of the swing; offsets and velocities of such a `Rig` are complex, x + i y.

    Parameters
    ----------
    system : Chain, Rig or Cord
        A chain of N links, a rig, or a cord.
    time : array_like
        Times in s. Negative ones only without damping, springs at pins, trolleys and a moving support.
    offset : array_like, shape (N + 1,) or (N,), optional
        Offsets of the pins at time 0, m, free end first; on the axis if left out. The last one, of the support, may be left
        out; that of a firm support must be 0, or that of `support`. For a cord: a continuous function of the distance from
        the free end, or numbers at `arc_length` with straight lines between them.
    velocity : array_like, shape (N + 1,) or (N,), optional
        Velocities of the pins at time 0, m/s, in the same form; at rest if left out.
    support : SupportMotion, optional
        How the support of a chain or rig is moved or pushed. Offsets and velocities that are left out are then those of the
        support: the system is straight and moves along.
    count : int, optional
        Number of modes, slowest first; if left out, all, or 40 for a cord. With momentum, modes of both directions count.
    arc_length : array_like, optional
        For a cord: distances from the free end of the points to return, m, ascending. They must go from 0 to the length if
        `offset` or `velocity` are numbers. If left out, the points are evenly spaced: one for each number, or 101.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.

    Returns
    -------
    Swing
        The motion. The offset of pin m at time i is within ``error_bound[i] + truncation_error[m]`` of the exact one; for a
        cord that of place m is within ``truncation_error[m]``, which is an estimate. With damping, springs at pins, a
        trolley or a support that is moved there is an `error_estimate` instead of a bound.

    Raises
    ------
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`, or `support` is not a `SupportMotion`.
    ValueError
        If `system` is a `Held`, or a `Cord` with a bob or whose support is moved; if a number is out of its range, a start
        has another length, moves a firm support or is complex without momentum; if a function jumps, or `arc_length` comes
        with a chain or a rig. For a rig: if its support is carried round (use `response`), or if the fluid turns. For a rig
        without damping, springs at pins, a trolley and a moving support: if its straight position is unstable or neutral, or
        if it has momentum and pins without inertia. With damping, springs at pins, a trolley or a moving support: if `count`
        is given, a force acts on a firm support, or there are more than 1000 links.

    Notes
    -----
    Pins without inertia (between massless threads) have no free offset. Offsets and velocities given for them are replaced
    by those to which their neighbours pull them; `Swing.projected` is then true.

    Links of a `Rig` do not turn about their own axes: a wheel acts only by its momentum (a driven wheel by that of its
    spin).

    Method: heights, shapes and angles in double-double, so that beats of many years keep their phase; for a cord, angles in
    double, wrong by 1e-15 times the number of swings, which ``truncation_error`` does not include. Accuracy otherwise: 1e-15
    of the amplitudes. Cost: 0.6 microseconds for each link and mode, and 3 ns for each link, mode and time.

    With damping, springs at pins, a trolley or a moving support: each motion of `modes` is driven by its part of the load.
    The dashpot of the support acts on its absolute velocity. The straight system may then be unstable. Accuracy: 1e-14 of
    the sum of amplitudes. Cost: 1 to 3 times that of `modes` of a damped rig with as many links, and 20 ns for each link,
    mode and time; more if damping is critical.

    References
    ----------
    Greenhill (1908), sections 2 and 8.

    Examples
    --------
    A light point mass below a heavy one: they beat.

    >>> import numpy as np
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[0.01, 1.0], length=1.0)
    >>> beat = rc.swing(chain, np.linspace(0.0, 20.0, 2001), offset=[0.01, 0.01, 0.0])
    >>> round(float(abs(beat.offset[:, 0]).max()), 4), round(float(abs(beat.offset[:, 1]).max()), 4)
    (0.1002, 0.01)

    A cord pulled aside at its free end and released:

    >>> cord = rc.Cord(1.0, mass=0.5, tip_mass=0.2)
    >>> found = rc.swing(cord, [0.0, 1.0], offset=lambda s: 0.1 * (1 - s))
    >>> round(float(found.offset[1, 0]), 4), bool(found.truncation_error.max() < 1e-4)
    (-0.0959, True)

    A crane that brakes within one period of its load, and within half of it:

    >>> crane = rc.Chain(mass=1000.0, length=10.0)
    >>> for seconds in (rc.modes(crane).period[0], rc.modes(crane).period[0] / 2):
    ...     braking = rc.SupportMotion([0.0, seconds], velocity=[2.0, 0.0])
    ...     print(round(rc.swing(crane, seconds, support=braking).residual_sway, 4))
    0.0
    1.2857
    """
    refuse_other(_CALLER, system, ("chain", "rig", "cord"), {"held": "use its modes"})
    times = floats(_CALLER, "time", time)
    if times.ndim > 1:
        raise ValueError(f"{_CALLER}: time must be a number or have one axis, got an array of shape {times.shape}")
    refuse_where(~np.isfinite(times), times, f"{_CALLER}: time must be finite")
    number = None if count is None else limit(_CALLER, "count", integer(_CALLER, "count", count))
    g = one_positive(_CALLER, "gravity", gravity)
    times = np.atleast_1d(times)
    arc: Floats | None = None
    if support is not None and not isinstance(support, SupportMotion):
        raise TypeError(f"{_CALLER}: support must be a revchain.SupportMotion, got {shown(support)}")
    if support is not None and system._kind == "cord":
        raise ValueError(f"{_CALLER}: a Cord has no moving support; use its chain: cord.chain(100)")
    if arc_length is not None and system._kind != "cord":
        raise ValueError(f"{_CALLER}: arc_length is for a Cord; a Chain has pins, leave it out, got {shown(arc_length)}")
    if _needs_all_motions(system, support):
        return _transient(system, times, offset, velocity, support, number, g)
    of: Any = system
    names: tuple[str, ...] = _OF_A_CORD
    if system._kind == "cord":
        starts = [_start_of_cord("offset", offset), _start_of_cord("velocity", velocity)]
        arc = _places(of, arc_length, starts)
        many = CORD_MODES if number is None else number
        swung = _core.cord_swing(of._under(g), starts[0], starts[1], times, arc, many, g)
    else:
        turns = system._kind == "rig" and of.has_momentum
        names = _TURNING if turns else _IN_A_PLANE
        ask: Any = _core.whirl_swing if turns else _core.swing if system._kind == "chain" else _core.rig_swing
        begin = [_start(name, given, system, turns) for name, given in (("offset", offset), ("velocity", velocity))]
        swung = checked(_CALLER, system.by_mass, ask, system._under(g), *begin, times, number, g)
    found: dict[str, Any] = dict(zip(names, swung, strict=True))
    if system.by_mass:
        found |= {name: g * found[name] for name in ("energy", "energy_left_out")}
    if "cosine" in found:
        found["amplitude"] = found.pop("cosine") - 1j * found.pop("sine")
    absent: dict[str, Any] = {"arc_length": arc, "start": None, "projected": False, "error_bound": None}
    absent |= dict.fromkeys(("exponent", "error_estimate", "sway", "motion_end"))
    return Swing._made(None, **{**absent, **found, "system": system, "gravity": g, "time": np.array(times)})


def _needs_all_motions(system: Any, support: SupportMotion | None) -> bool:
    """Return whether the motion is not a sum of the modes of a chain or a plain rig, but of a rig with pins."""
    if system._kind == "cord":
        return False
    own = system._support
    return support is not None or (own is not None and (system._has_pins or own.stiffness == 0))


def _transient(
    system: Any, times: Floats, offset: Any, velocity: Any, support: SupportMotion | None, count: int | None, g: float
) -> Swing:
    """The motion of a rig with springs or dashpots at pins or a trolley, or under a moving support."""
    if count is not None:
        raise ValueError(
            f"{_CALLER}: count must be left out with dashpots, springs at pins, a trolley or a moving support: all motions are "
            f"used, got {count}"
        )
    refuse_where(times < 0, times, f"{_CALLER}: time must not be negative with dashpots, springs at pins, a trolley or a moving support")
    rig = system if system._kind == "rig" else Rig(system)
    turns = rig.has_momentum
    starts = [
        None if given is None else np.asarray(_start(name, given, system, turns), np.complex128)
        for name, given in (("offset", offset), ("velocity", velocity))
    ]
    if support is not None and support._what == "force" and (system._support is None or not system._support._yields):
        raise ValueError(
            f"{_CALLER}: support must not be a force on a firm support, which does not move; give Support(stiffness=) or "
            f"Support(mass=), or velocities, got {support!r}"
        )
    kind, when, values = "acceleration", np.empty(0), np.empty(0)
    if support is not None:
        kind, when = support._what, support.time
        values = support._given[kind] / (system._force(g) if kind == "force" else 1.0)
    order = np.argsort(times, kind="stable")
    y, v, estimate, end, sway, exponent, shape, amplitude, start, projected = checked(
        _CALLER, system.by_mass, _core.transient, rig._under(g), *starts, times[order], kind, when, values, support is None or support.rests is not False, g
    )
    back = np.argsort(order, kind="stable")
    plain = (lambda x: x) if turns else np.real
    links = system.size
    return Swing._made(
        None,
        system=system,
        gravity=g,
        time=np.array(times),
        arc_length=None,
        offset=np.array(plain(y[back])),
        velocity=np.array(plain(v[back])),
        angular_frequency=np.array(exponent.imag),
        exponent=exponent,
        energy=None,
        shape=shape if rig.is_damped else np.array(shape.real),
        amplitude=amplitude,
        start=np.array(plain(start)),
        projected=projected,
        energy_left_out=0.0,
        truncation_error=np.zeros(links + 1),
        error_bound=None,
        error_estimate=estimate[back],
        sway=sway,
        motion_end=end,
    )


def _start(name: str, value: Any, system: Any, turns: bool) -> Any:
    """Start values of the pins; complex for a rig whose momentum turns the plane of the swing."""
    size = system.size
    array = array_of(np.zeros(size) if value is None else value)
    if array.dtype.kind != "c":
        array = floats(_CALLER, name, np.zeros(size) if value is None else value)
    elif not turns:
        raise ValueError(
            f"{_CALLER}: {name} must be real: without momentum of flywheels the two horizontal directions are independent; solve "
            f"for each, got {shown(value)}"
        )
    if array.shape not in ((size,), (size + 1,)):
        raise ValueError(
            f"{_CALLER}: {name} must have shape ({size + 1},), a number for each pin, or ({size},), the support's 0 "
            f"left out, got {array.shape}"
        )
    refuse_where(~np.isfinite(array), array, f"{_CALLER}: {name} must be finite")
    return array.astype(np.complex128) if turns else array


def _places(system: Cord, arc_length: ArrayLike | None, starts: list[Any]) -> Floats:
    """The places of a cord to return, as many as the numbers of its start."""
    given = {name: start.size for name, start in zip(("offset", "velocity"), starts, strict=True) if isinstance(start, np.ndarray)}
    if arc_length is None:
        arc = np.linspace(0.0, system.length, next(iter(given.values()), 101))
    else:
        arc = np.array(floats(_CALLER, "arc_length", arc_length))
        if arc.ndim != 1 or not arc.size:
            raise ValueError(f"{_CALLER}: arc_length must have one axis, got {shown(arc_length)}")
        inside = (arc >= 0) & (arc <= system.length)
        refuse_where(~inside, arc, f"{_CALLER}: arc_length must lie between 0 and the length {system.length:g}")
    for name, size in given.items():
        if size != arc.size:
            raise ValueError(f"{_CALLER}: {name} must have a number for each of the {arc.size} places of arc_length, got {size}")
    return arc


def _start_of_cord(name: str, given: Start | None) -> Floats | Callable[[float], float] | None:
    """A start given as a function, checked at every call, or as an array of at least two numbers."""
    if given is None:
        return None
    if callable(given):
        function = given
        return lambda s: real(_CALLER, f"{name}({s:g})", function(s))
    array = floats(_CALLER, name, given)
    if array.ndim != 1 or array.size < 2:
        raise ValueError(
            f"{_CALLER}: {name} must be a function of the distance from the free end, or numbers from the free end to the "
            f"support, got {shown(given)}"
        )
    refuse_where(~np.isfinite(array), array, f"{_CALLER}: {name} must be finite")
    return array
