# SPDX-License-Identifier: GPL-3.0-or-later
"""The modes of a system, and the number of modes below a speed."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.base import asked_in
from ..results.modes import Modes, speed_bound_of_exponents
from ..systems.chain import Chain, checked, compiled
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, Floats, Whole, boolean, floats, integer, one_positive, positive, real, shown, together
from ..systems.numbers import count as checked_count
from ..systems.numbers import word as checked_word
from ..systems.rig import Rig
from ..systems.units import has_units, speed_unit
from .refuse import no_system

Pair = tuple[float, float]


def modes(
    system: Chain | Rig | Cord | Held,
    count: int | Literal["all"] | None = None,
    *,
    first: int = 1,
    conical_height: Pair | None = None,
    angular_speed: Pair | None = None,
    rtol: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    method: str | None = None,
    precision: str = "double",
    certify: bool = False,
    threads: int = 1,
) -> Modes:
    """Return the modes of a system: whirl speeds (critical speeds), with shapes, nodes and error bounds.

    For a chain hung from a fixed point, the small-amplitude whirl speed equals the natural angular frequency of its swing in
    a plane.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system: a chain of N links, a rig, a cord, or a chain or cord held straight by a tension, with or without
        gravity.
    count : int or "all", optional
        Number of modes, slowest first; 10 if left out, or all if there are fewer. A cord has infinitely many. For a rig with
        flywheels `count`, `first` and the windows (of absolute speeds) apply to each direction of rotation; with dashpots or
        linear drag `count` and `first` apply to both together, by the size of the exponents.
    first : int, optional
        Number of the first mode; the slowest mode is 1.
    conical_height : (low, high), optional
        Window of conical heights, m: all modes with ``low < conical height <= high``. `low` may be 0 except for a cord,
        `high` infinite.
    angular_speed : (low, high), optional
        Window of speeds, rad/s: all modes with ``low <= whirl speed < high``. `low` may be 0, `high` infinite except for a
        cord.
    rtol : float, optional
        Relative tolerance of the conical heights of a chain. The cheapest method whose bound is within it is used: closed
        form, Bessel zero, coarser chain, ... (`explain` lists them). If left out: full accuracy in double, 2 ulp. Other
        systems are solved to full accuracy. For errors below 2 ulp use ``precision="double-double"``.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    method : str, optional
        Method for a chain; the cheapest if left out. ``"bisection"`` counts the modes above a height and halves intervals:
        any modes of any chain, to 2 ulp. ``"condensed"`` condenses a long chain first: some of its slowest modes, to 2 ulp.
        ``"aberth"`` finds all modes of a small chain at once. ``"interpolated"`` interpolates the characteristic polynomial:
        many modes. If one of these three does not apply, bisection is used, and ``method`` of the result says so.
        ``"dense"`` solves the assembled pencil, ``"recurrence"`` relation (21) as printed: both are references for small
        chains. Any other name that `explain` lists selects that method.
    precision : {"double", "extended", "double-double"}
        Arithmetic of the result. ``"extended"``: the results are numpy's longdouble, with a significand of 64 bits on
        x86-64; on some platforms it equals double. ``"double-double"``: twice the digits of double; the height is the sum of
        two float64 arrays, ``conical_height + conical_height_low``, `error_bound` bounds the error of that sum (3e-29 for
        one link, 1e-24 for 2000), and shapes are float64.
    certify : bool
        Whether to return, for each height of a chain (also of a held one) or a rig, the interval that contains it and the
        counts that prove it.
    threads : int, optional
        Number of threads for the heights and shapes of chains and rigs; 0 for all processors. Results are bitwise equal for
        any number.

    Returns
    -------
    Modes
        The modes. ``status`` is ``"tolerance_not_met"`` if `rtol` was not reached; ``error_bound`` is the bound reached.

    Raises
    ------
    ValueError
        If the requested modes do not exist (of a rig: the first) or are specified in two ways, a number is out of its range,
        `method` or `precision` is unknown, or the method does not apply to the chain; if a method or another precision than
        double is asked of a system other than a chain, or `certify` of a cord; if a rig with dashpots or linear drag comes
        with a window or `certify`, or has more than 1000 links; if a rig has more than 20,000 links, or springs at pins, and
        its speeds may be complex (inverted or floating links or driven wheels together with momentum, floats in rotating
        fluid); if a held system is held at a span, or its tension does not exceed its weight.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.

    Notes
    -----
    For chains, held chains and rigs whose speeds cannot be complex, proved counts of the exact heights decide which modes
    lie in a window: adjacent windows share no mode and miss none.

    Accuracy: ``error_bound`` is the relative error bound (by default at most 2 ulp for a chain and 1 ulp for a held chain,
    proved by counts). Cost: O(N) for each mode; shapes, when they are read, take O(N) time and memory for each mode, too.
    For a rig whose speeds may be complex all speeds are found, in about 1 microsecond times the square of the number of
    links.

    References
    ----------
    Greenhill (1908), section 8 (21).

    Examples
    --------
    >>> import revchain as rc
    >>> m = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0))
    >>> m.conical_height
    array([1.5, 0.5])
    >>> m.angular_speed.round(4)
    array([2.5569, 4.4287])
    >>> rods = rc.Chain.uniform_rods(2000, length=0.36)
    >>> rc.modes(rods, 3, first=1000).number
    array([1000, 1001, 1002])
    >>> rc.modes(rods, angular_speed=(20.0, 40.0)).angular_speed.round(3)
    array([22.583, 30.772, 38.964])
    >>> rc.modes(rods, 3, rtol=0.01).method
    'continuous chain'
    >>> top = rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=1.5))
    >>> rc.modes(top).angular_speed.round(3)
    array([-2.47,  3.97])
    >>> rc.modes(rc.Held(rc.Chain.uniform_rods(50, length=1.0), tension=11.0), 2).angular_speed.round(2)
    array([31.87, 63.78])
    """
    return find_modes(
        system,
        count,
        first=first,
        conical_height=conical_height,
        angular_speed=angular_speed,
        rtol=rtol,
        gravity=gravity,
        method=method,
        precision=precision,
        certify=certify,
        threads=threads,
    )


_DOUBLE = "double"
FULL = 4.4432e-16  # 2 ulp: the bound of full accuracy in double
METHODS = tuple(name for name in dict.fromkeys((*_core.METHODS[1:], *_core.MODELS)) if name != "finite amplitude")
_DEFAULTS: dict[str, Any] = {"conical_height": None, "angular_speed": None, "rtol": None, "method": None}
_DEFAULTS |= {"precision": "double", "certify": False}
_CALLER = "revchain.modes"


class _Asked(NamedTuple):
    """The checked arguments of `modes`."""

    many: int | str | None
    first: int
    heights: Pair | None
    speeds: Pair | None
    rtol: float | None
    gravity: float
    method: str | None
    precision: str
    certify: bool
    threads: int
    progress: _core.Progress | None

    @property
    def speeds_and_gravity(self) -> tuple[float, float, float] | None:
        return None if self.speeds is None else (*self.speeds, self.gravity)

    def refuse(self, names: str, reason: str) -> None:
        """Raise a ValueError if one of these options was given."""
        for name in names.split():
            value, default = getattr(self, name), _DEFAULTS[name]
            if value is not default and not (isinstance(value, str) and value == default):
                raise ValueError(f"{_CALLER}: {name} {reason}, got {shown(value)}")


def find_modes(
    system: Chain | Rig | Cord | Held,
    count: int | Literal["all"] | None = None,
    *,
    first: int = 1,
    conical_height: Pair | None = None,
    angular_speed: Pair | None = None,
    rtol: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    method: str | None = None,
    precision: str = "double",
    certify: bool = False,
    threads: int = 1,
    progress: _core.Progress | None = None,
) -> Modes:
    """`modes` with `progress`, which another thread can read, and with which it can cancel."""
    g = gravity if type(gravity) is float and 0 < gravity < 1e300 else one_positive(_CALLER, "gravity", gravity)
    start = first if type(first) is int and first == 1 else checked_count(_CALLER, "first", first)
    shared = threads if type(threads) is int and threads == 1 else integer(_CALLER, "threads", threads)
    heights = window = None
    if conical_height is not None or angular_speed is not None:
        _refuse_two_choices(conical_height, angular_speed, count, start)
        if conical_height is not None:
            heights = _window("conical_height", conical_height)
        else:
            window = _window("angular_speed", angular_speed)
    if rtol is not None:
        rtol = real(_CALLER, "rtol", rtol)
        if not rtol >= 0:
            raise ValueError(f"{_CALLER}: rtol must not be negative or NaN, got {rtol:g}")
    if certify is not False:
        certify = boolean(_CALLER, "certify", certify)
    find = _FIND.get(getattr(system, "_kind", ""))
    if find is None:
        raise no_system(_CALLER, system)
    found = find(system, _Asked(count, start, heights, window, rtol, g, method, precision, certify, shared, progress))
    return found if window is None else asked_in(speed_unit(angular_speed), found)


def _of_chain(chain: Chain, asked: _Asked) -> Modes:
    count, first, heights, _, rtol, g, method, precision, certify, threads, progress = asked
    core, speeds = compiled(_CALLER, chain), asked.speeds_and_gravity
    wanted: int | None = None
    if heights is None and speeds is None:
        wanted = how_many(_CALLER, count, first, core.mode_count)
    if precision is not _DOUBLE:
        checked_word(_CALLER, "precision", precision, _core.PRECISIONS, "; float is for C++ alone")
    if rtol is not None and 0 < rtol <= FULL and method is None and wanted and precision == "double" and not certify:
        method = "double-double"  # no method in double keeps it
    if method is not None and not (isinstance(method, str) and method in _core.METHODS[1:]):
        checked_word(_CALLER, "method", method, METHODS)
        if wanted is None or precision != "double" or certify:
            raise ValueError(f"{_CALLER}: method {method!r} goes with count, first and rtol alone")
        tolerance = FULL / 2 if method == "double-double" and rtol is None else rtol or 0.0
        return _by_model(_core.solve_by(core, first, wanted, tolerance, 0.0, method), chain, g, rtol, first)
    way = method or "auto"
    found = _core.modes(core, first, wanted, heights, speeds, rtol, certify, precision, way, progress, threads)
    return Modes._made(found, system=chain, gravity=g, precision=precision, rtol=rtol)


def _of_rig(rig: Rig, asked: _Asked) -> Modes:
    asked.refuse("method precision", "is for a Chain; a Rig has one method, in double")
    count, first, heights, speeds, rtol, g, _, _, certify, threads, progress = asked
    many = count_of(_CALLER, count, 10)
    if rig.is_damped:
        return _of_damped_rig(rig, asked, many)
    core = _core.rig_modes(rig._under(g), first, many, heights, speeds, rtol, certify, g, progress, threads)
    found = Modes._made(core, system=rig, gravity=g, rtol=rtol)
    if first > (most := max(1, *core.available)):
        raise ValueError(f"{_CALLER}: first must be from 1 to {most}, the number of modes in a direction, got {first}")
    return found


def _of_damped_rig(rig: Rig, asked: _Asked, many: int | None) -> Modes:
    asked.refuse("certify", "is for a Rig without dashpots, whose modes counts can prove")
    if asked.heights or asked.speeds:
        raise ValueError(f"{_CALLER}: a window is for a system without dashpots; give count and first")
    g = asked.gravity
    exponent, bound, estimate, shape, available, rigid, complete, status = checked(
        _CALLER, False, _core.damped_modes, rig._under(g), asked.first, many, g, asked.progress
    )
    if asked.first > max(1, available):
        raise ValueError(f"{_CALLER}: first must be from 1 to {available}, the number of modes, got {asked.first}")
    speed = exponent.imag
    if asked.rtol is not None and not np.all(bound <= asked.rtol):
        status = "tolerance_not_met"
    given: dict[str, Any] = {"number": np.arange(asked.first, asked.first + len(exponent)), "angular_speed": speed}
    given |= {"exponent": exponent, "error_bound": bound, "error_estimate": estimate}
    given |= {"speed_error_bound": speed_bound_of_exponents(exponent, bound, rig.has_momentum)}
    given |= {"shape": shape, "available": (available, 0), "rigid": rigid, "complete": complete, "status": status}
    given |= {"direction": np.where(speed < 0, -1, 1), "has_momentum": rig.has_momentum, "method": "exponents"}
    given |= {"_is_damped": True, "_unused": ("nodes",)}  # in general no point stays on the axis
    return Modes._made(None, system=rig, gravity=g, rtol=asked.rtol, **given)


def _of_cord(cord: Cord, asked: _Asked) -> Modes:
    asked.refuse("method precision certify", "is for a Chain; the heights of a Cord have closed forms or power series")
    wanted = _of_infinitely_many(asked)
    speeds = asked.speeds_and_gravity
    try:
        found = _core.cord_modes(cord._compiled, asked.first, wanted, asked.heights, speeds, asked.rtol, asked.progress)
    except ValueError as error:
        _, followed, number = str(error).partition(" to follow up to critical height, got ")
        if not followed or not (cord._particles or cord._bob[0]):
            raise
        what = "masses, tip or bob are too far from the cord's own mass and length"
        raise ValueError(f"{_CALLER}: {what} to follow mode {number}; use its chain: cord.chain(100)") from None
    return Modes._made(found, system=cord, gravity=asked.gravity, rtol=asked.rtol)


def _of_held_cord(held: Held, asked: _Asked) -> Modes:
    asked.refuse("method precision certify", "is for a Chain that hangs")
    core: Any = straight(_CALLER, held, asked.gravity)
    wanted, g, rtol = _of_infinitely_many(asked), asked.gravity, asked.rtol
    found = _core.held_modes(
        core, asked.first, wanted, asked.heights, asked.speeds_and_gravity, rtol, asked.progress, g
    )
    return Modes._made(found, system=held, gravity=g, rtol=rtol)


def _of_held_chain(held: Held, asked: _Asked) -> Modes:
    asked.refuse("method precision", "is for a Chain that hangs")
    count, first, heights, speeds, rtol, g, _, _, certify, _, progress = asked
    core: Any = straight(_CALLER, held, g)
    default = max(min(10, (held.mode_count or 0) - first + 1), 1)
    wanted = None if heights or speeds else count_of(_CALLER, count, default, each=24)
    found = _core.held_modes(
        core, first, wanted, heights, asked.speeds_and_gravity, rtol, certify, progress, g
    )
    return Modes._made(found, system=held, gravity=g, rtol=rtol)


_FIND: dict[str, Callable[[Any, _Asked], Modes]] = {
    "chain": _of_chain, "rig": _of_rig, "cord": _of_cord, "held chain": _of_held_chain, "held cord": _of_held_cord
}  # fmt: skip


def _of_infinitely_many(asked: _Asked) -> int | None:
    if asked.many == "all":
        raise ValueError(f"{_CALLER}: a cord has infinitely many modes; give count, or a window that ends")
    return None if asked.heights or asked.speeds else count_of(_CALLER, asked.many, 10, each=32)


def _refuse_two_choices(height: Any, speed: Any, count: Any, first: int) -> None:
    given = {"conical_height": height is not None, "angular_speed": speed is not None}
    named = [name for name, there in {**given, "count": count is not None, "first": first != 1}.items() if there]
    if len(named) > 1:
        raise ValueError(f"{_CALLER}: give one window, or count and first, not both, got {' and '.join(named)}")


def _by_model(found: tuple[Any, ...], chain: Chain, gravity: float, rtol: float | None, first: int) -> Modes:
    height, bound, low, method, status = found
    if not len(height):
        raise ValueError(f"revchain.modes: method {method!r} does not apply to this chain; explain says why")
    given: dict[str, Any] = {"conical_height": height, "error_bound": bound, "conical_height_low": low}
    given |= {"number": np.arange(first, first + len(height)), "certificate": None, "method": method}
    precision = "double" if low is None else "double-double"
    given |= {"status": "success" if rtol is None else status, "precision": precision}
    given["_make"] = lambda: _core.modes(chain._compiled, first, len(height), None, None, rtol, False, precision, "auto")
    return Modes._made(None, system=chain, gravity=gravity, rtol=rtol, **given)


def straight(caller: str, held: Held, gravity: float) -> _core.Held | _core.HeldCord:
    """The compiled system of a chain or cord that a tension holds straight; a ValueError if it is not so held."""
    if held.span is not None:
        raise ValueError(
            f"{caller}: a chain or cord held at a span is bent and has no critical speeds; use steady_shapes, and the stability "
            f"of a shape, got span {held.span:g}"
        )
    least = 0.0 if held.weightless else held._force(gravity) * held._total
    if held.tension is not None and not held.tension > least:
        raise ValueError(
            f"{caller}: tension at the upper end must exceed the weight {least:.6g}, or the lower part is slack, got "
            f"{held.tension:g}"
        )
    return held._under(gravity)


def how_many(caller: str, count: int | str | None, first: int, most: int) -> int:
    """The number of modes asked for out of `most`: ten by default, at most all from `first` on."""
    left = max(most - first + 1, 1)
    return count_of(caller, count, min(10, left)) or left


def count_of(caller: str, count: int | str | None, default: int, each: int = 0) -> int | None:
    """The checked count, of results of `each` bytes; None for all."""
    if count is None:
        return default
    if isinstance(count, str):
        if count != "all":
            raise ValueError(f'{caller}: count must be a number or "all", got {shown(count)}')
        return None
    return checked_count(caller, "count", count, each)


def _window(name: str, window: object) -> Pair:
    """The two ends of a window; their order is checked where it is used."""
    if isinstance(window, str | set | dict) or not isinstance(window, Iterable) or getattr(window, "ndim", 1) == 0:
        raise ValueError(f"{_CALLER}: {name} must be a pair (low, high), got {shown(window)}")
    ends = [real(_CALLER, f"{name} (each end)", end) for end in window]
    if len(ends) != 2:
        raise ValueError(f"{_CALLER}: {name} must be a pair (low, high), got {shown(window)}")
    if has_units(window):
        if speed_unit(window) == "s":  # a long period is a low speed
            ends.sort()
        if not 0 <= ends[0] < ends[1]:
            raise ValueError(f"{_CALLER}: {name} must be a pair (low, high), 0 <= low < high, got {shown(window)}")
    return ends[0], ends[1]


def count_modes(
    system: Chain | Rig | Cord | Held,
    *,
    conical_height: ArrayLike | None = None,
    angular_speed: ArrayLike | None = None,
    gravity: ArrayLike = STANDARD_GRAVITY,
) -> np.int64 | Whole:
    """Return the number of modes slower than a speed, that is, with a conical height above a height.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system: a chain of N links, a rig, a cord, or a chain or cord held straight by a tension.
    conical_height : array_like, optional
        Conical heights, m, positive, any shape.
    angular_speed : array_like, optional
        Speeds in rad/s, positive, any shape. Give either this or `conical_height`. For a rig with flywheels a negative speed
        counts the backward modes between 0 and that speed.
    gravity : array_like, optional
        Acceleration of gravity, m/s^2, broadcast against `angular_speed` for a chain; standard gravity if left out. For
        other systems it must be a single number.

    Returns
    -------
    numpy.int64 or ndarray of int64
        Number of modes slower than each speed. For a rig with flywheels a speed counts the modes in its own direction, and a
        height those of both directions.

    Raises
    ------
    ValueError
        If both or neither of height and speed are given, or a number is out of its range; if `modes` refuses the system; if
        a rig has dashpots or linear drag; if, for a rig, rounding leaves the count uncertain.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.

    Notes
    -----
    For chains and rigs the count is exact for the stored data. Method: Sylvester's law of inertia, in rounded arithmetic
    with a proof, and with twice the digits if the proof fails. Cost: O(N) for each number. If the speeds of a rig may be
    complex, all are found once, as by `modes`, and the real ones are counted. For a cord, a mode whose height differs from
    the given one by less than the error bound of `modes` may be counted on either side. Source: Greenhill (1908), section 8
    (21).

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain.uniform_rods(120, length=0.36)
    >>> int(rc.count_modes(chain, angular_speed=20.0))
    2
    >>> rc.count_modes(chain, conical_height=[0.3, 0.2, 0.04])
    array([0, 1, 2])
    >>> top = rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=1.5))
    >>> rc.count_modes(top, angular_speed=[3.0, -3.0])
    array([0, 1])
    """
    caller = "revchain.count_modes"
    if (conical_height is None) == (angular_speed is None):
        raise ValueError(f"{caller}: give either conical_height or angular_speed")
    kind = getattr(system, "_kind", None)
    if kind not in _FIND:
        raise no_system(caller, system)
    of: Any = system
    height: Any = conical_height
    speed: Any = None if angular_speed is None else floats(caller, "angular_speed", angular_speed)
    if kind == "chain":
        core, g = compiled(caller, of), positive(caller, "gravity", gravity)
        if speed is None:
            return _core.count_modes(core, floats(caller, "conical_height", height))[()]
        speed = positive(caller, "angular_speed", angular_speed)  # type: ignore[arg-type]
        return _core.count_modes_at_speed(core, *together(caller, angular_speed=speed, gravity=g))[()]
    one = one_positive(caller, "gravity", gravity)
    if kind == "rig" and of.is_damped:
        what = "a rig with dashpots or linear drag has damped motions, which no speed separates"
        raise ValueError(f"{caller}: {what}; take them from modes(rig)")
    if kind == "rig" and speed is not None:
        return _core.count_rig_modes(of._under(one), speed, False, one)[()]
    if speed is None:
        height = positive(caller, "conical_height", height)
    else:
        height = one / positive(caller, "angular_speed", angular_speed) ** 2  # type: ignore[arg-type]
    if kind == "rig":
        return _core.count_rig_modes(of._under(one), height, True, one)[()]
    if kind == "cord":
        return _core.count_cord_modes(of._under(one), height)[()]
    return _core.count_held_modes(straight(caller, of, one), height, one)[()]


def recurrence_matrices(chain: Chain) -> tuple[Floats, Floats]:
    """Return relation (21) of the paper as a pair of matrices.

    Parameters
    ----------
    chain : Chain
        The chain of N links.

    Returns
    -------
    A, B : ndarray, shape (N, N)
        Dense matrices with ``A @ y = conical_height * B @ y``, where `y` are the offsets of the pins from the free end up,
        without the support.

    Notes
    -----
    The relation is for small amplitude and is corrected: ``h_{m-2} / a_{m-2}`` in its third bracket, and the lowest pin as
    an unknown. Time and memory: O(N**2).

    References
    ----------
    Greenhill (1908), section 8 (21).

    Examples
    --------
    >>> import numpy as np, revchain as rc
    >>> A, B = rc.recurrence_matrices(rc.Chain(weight=[1.0, 3.0], length=1.0))
    >>> y = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).shape[0, :-1]
    >>> bool(np.allclose(A @ y, 1.5 * B @ y))
    True
    """
    return _core.recurrence_matrices(compiled("revchain.recurrence_matrices", chain))
