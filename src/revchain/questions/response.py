# SPDX-License-Identifier: GPL-3.0-or-later
"""`response`: the small motions that a moving support forces on a system."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.motions import Response
from ..systems.chain import Chain, checked, compiled
from ..systems.numbers import (
    STANDARD_GRAVITY,
    Whole,
    array_of,
    floats,
    integer,
    positive,
    real,
    refuse_where,
    shown,
)
from ..systems.rig import Rig
from .asked import in_unit_of
from .refuse import refuse_other


@in_unit_of("angular_speed")
def response(
    system: Chain | Rig,
    *,
    conical_height: ArrayLike | None = None,
    angular_speed: ArrayLike | None = None,
    gravity: float = STANDARD_GRAVITY,
    support_radius: float | None = None,
    acceleration: float | None = None,
    force: float | None = None,
    pins: ArrayLike | None = None,
    threads: int = 1,
) -> Response:
    """Return the forced motion of a chain whose support moves in a small circle or to and fro, or is pushed.

    With dashpots or linear drag offsets are complex, with amplitudes and phases.

    Parameters
    ----------
    system : Chain or Rig
        A chain of N links, or a rig. With a spring at the support, its far end moves; a free trolley moves itself.
    conical_height : array_like, optional
        Conical heights ``gravity / angular_speed**2``, m, any shape. Give either this or `angular_speed`.
    angular_speed : array_like, optional
        Speeds in rad/s, positive; for a rig with flywheels also negative (backward).
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    support_radius : float, optional
        Radius of the circle, or amplitude to and fro, m, positive. If left out, the radius of the rig, or 1 if it has none.
        Give at most one of this and the next two.
    acceleration : float, optional
        Amplitude of the acceleration of the support, m/s^2, instead of a radius; positive.
    force : float, optional
        Amplitude of a horizontal force on a support that yields, N or the unit of the weights, instead of a radius;
        positive. With momentum of flywheels the force turns with the speed, as a radius and an acceleration do; to and fro
        is then the mean of the responses at both signs of the speed.
    pins : int or array_like of int, optional
        Pins to return, from 0 (free end) to N or -1 (support); all N + 1 if left out.
    threads : int, optional
        Number of threads; 0 for all processors. Results are bitwise equal for any number.

    Returns
    -------
    Response
        The offsets and counts of modes. At a resonance without damping, as far as double-double can tell, `resonant` is true
        and the offsets below the support are NaN. The `error_bound` is proved. With springs at pins, dashpots, linear drag,
        a trolley, an acceleration or a force there is an `error_estimate` instead.

    Raises
    ------
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.
    ValueError
        If `system` is a `Cord` or a `Held`; if not exactly one of `conical_height` and `angular_speed` is given; if more
        than one of `support_radius`, `acceleration` and `force` is given, or a force on a firm support; if a number is out
        of its range; if there is no such pin.

    Notes
    -----
    The offsets solve ``K y = M y / conical_height`` for the given offset of the support. The theory is linear: offsets must
    be small compared with the links; scale them with the radius. Lowest links without net weight in a fluid that turns with
    them hang straight down.

    Dashpots at pins act on rates of angles between links that do not turn about their own axes, as in motion to and fro;
    that of the support on its velocity over the ground.

    Method: upward sweep of the dynamic stiffness in double-double with a running error bound. Accuracy: half an ulp of each
    offset, unless the speed is within about 1e-12 of a resonance (1000 links: 1e-11). The proved bound is wider: within
    1e-13 of a resonance for one link, 3e-7 for 1000. Cost: about 0.012 microseconds for each link and speed, 2.5 with
    springs or dashpots at pins.

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

    A trolley with a dashpot, pushed near a resonance:

    >>> trolley = rc.Support(mass=10.0, stiffness=400.0, damping=5.0)
    >>> pushed = rc.response(rc.Rig(rc.Chain(mass=1.0, length=2.0), support=trolley), angular_speed=6.4, force=1.0)
    >>> pushed.amplitude.round(4), pushed.phase.round(2)
    (array([0.0042, 0.031 ]), array([ 1.45, -1.7 ]))
    """
    caller = "revchain.response"
    refuse_other(caller, system, ("chain", "rig"), {"cord": "use its chain: cord.chain(100)", "held": "use steady_shapes"})
    if (conical_height is None) == (angular_speed is None):
        raise ValueError(f"{caller}: give either conical_height or angular_speed")
    g = float(positive(caller, "gravity", real(caller, "gravity", gravity)))
    drives = {"support_radius": support_radius, "acceleration": acceleration, "force": force}
    given_drives = {name: value for name, value in drives.items() if value is not None}
    if len(given_drives) > 1:
        raise ValueError(f"{caller}: give one of {', '.join(drives)}, got {' and '.join(given_drives)}")
    drive = {name: float(positive(caller, name, real(caller, name, value))) for name, value in given_drives.items()}
    support = system._support
    if not drive:
        drive = {"support_radius": (0.0 if support is None else support.radius) or 1.0}
    if angular_speed is None:
        assert conical_height is not None
        given = positive(caller, "conical_height", conical_height)
        height, speed = given, np.asarray(_core.conical_pendulum_angular_speed(given, np.full(given.shape, g)))
    else:
        given = floats(caller, "angular_speed", angular_speed)
        if system.has_momentum:
            wrong = ~((given != 0) & np.isfinite(given))
            refuse_where(wrong, given, f"{caller}: angular_speed must be finite and not 0")
        else:
            positive(caller, "angular_speed", given)
        height, speed = np.asarray(_core.conical_pendulum_height(np.abs(given), np.full(given.shape, g))), given
    which, axis = _pins(caller, pins, system.size)
    number = integer(caller, "threads", threads)
    parts: dict[str, Any] = {
        "system": system,
        "gravity": g,
        "conical_height": np.array(height),
        "angular_speed": np.array(speed),
        "pins": which,
        **{name: drive.get(name) for name in drives},
    }
    if "force" in drive and (support is None or not support._yields):
        raise ValueError(
            f"{caller}: force needs a support that yields, Support(stiffness=) or Support(mass=); a firm one does not move, got "
            f"{drive['force']:g}"
        )
    pinned = isinstance(system, Rig) and (system._has_pins or system.support.stiffness == 0)
    if pinned or "support_radius" not in drive:
        return _forced(caller, system, speed, g, drive, number, parts, axis)
    asked = (given.reshape(-1), angular_speed is not None, drive["support_radius"], which.reshape(-1), g, number)
    respond: Any = _core.rig_response if system._kind == "rig" else _core.response
    of: Any = system
    core: Any = compiled(caller, of) if system._kind == "chain" else system._under(g)
    found = respond(core, *asked)
    offset, bound, below, against, resonant, force_on_support, force_error = found
    shape = given.shape
    return Response._made(
        None,
        **parts,
        offset=offset.reshape(shape + axis),
        error_bound=bound.reshape(shape),
        error_estimate=None,
        modes_below=below.reshape(shape),
        reversed=against.reshape(shape),
        resonant=resonant.reshape(shape),
        support_force=np.asarray(system._force(g) * force_on_support.reshape(shape)),
        support_force_error=np.asarray(system._force(g) * force_error.reshape(shape)),
    )


def _forced(
    caller: str, system: Any, speed: Any, g: float, drive: dict[str, float], threads: int, parts: dict[str, Any],
    axis: tuple[int, ...],
) -> Response:
    """The response of a rig with springs or dashpots at pins or a trolley, or by an acceleration or a force."""
    rig = system if system._kind == "rig" else Rig(system)
    units = {"force": system._force(g)}
    amounts = [drive.get(name, 0.0) / units.get(name, 1.0) for name in ("support_radius", "acceleration", "force")]
    offset, estimate, below, resonant, force = checked(
        caller, system.by_mass, _core.forced_motion, rig._under(g), np.ascontiguousarray(speed).reshape(-1), *amounts, g, threads
    )
    shape = speed.shape
    if not rig.is_damped:
        offset, force = offset.real, force.real
    # Behind its drive by more than a quarter of a turn; an acceleration is opposite to its offset.
    against = (offset[:, 0].real * (-1 if "acceleration" in drive else 1)) < 0
    return Response._made(
        None,
        **parts,
        offset=np.array(offset[:, parts["pins"].reshape(-1)]).reshape(shape + axis),
        error_bound=None,
        error_estimate=estimate.reshape(shape),
        modes_below=below.reshape(shape),
        reversed=against.reshape(shape),
        resonant=resonant.reshape(shape),
        support_force=np.asarray(system._force(g) * force.reshape(shape)),
        support_force_error=None,
    )


def _pins(caller: str, pins: ArrayLike | None, size: int) -> tuple[Whole, tuple[int, ...]]:
    """Numbers of the pins asked for, and the shape of their axis."""
    if pins is None:
        return np.arange(size + 1), (size + 1,)
    asked = array_of(pins)
    if asked.dtype.kind not in "iu" and asked.size:
        raise ValueError(f"{caller}: pins must be whole numbers, got {shown(pins)}")
    if asked.ndim > 1:
        raise ValueError(f"{caller}: pins must be one number or a list of them, got an array of shape {asked.shape}")
    asked = asked.astype(np.int64)
    wrong = (asked < -(size + 1)) | (asked > size)
    if wrong.any():
        raise ValueError(f"{caller}: pins must be numbers from 0 to {size}, got {asked[wrong].flat[0]}")
    return np.where(asked < 0, asked + size + 1, asked), asked.shape
