# SPDX-License-Identifier: GPL-3.0-or-later
"""The slowest modes of a system, and how many there are below a speed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal, overload

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.modes import CordModes, Modes, RigModes
from ..systems.chain import Chain, compiled
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, Floats, boolean, floats, integer, one_positive, positive, real, shown, together
from ..systems.numbers import count as checked_count
from ..systems.numbers import word as checked_word
from ..systems.rig import Rig
from .refuse import no_system

Pair = tuple[float, float]


@overload
def modes(
    system: Chain,
    count: int | Literal["all"] | None = ...,
    *,
    first: int = ...,
    conical_height: Pair | None = ...,
    angular_speed: Pair | None = ...,
    rtol: float | None = ...,
    gravity: float = ...,
    method: str | None = ...,
    precision: str = ...,
    certify: bool = ...,
    threads: int = ...,
) -> Modes: ...
@overload
def modes(
    system: Rig,
    count: int | Literal["all"] | None = ...,
    *,
    first: int = ...,
    conical_height: Pair | None = ...,
    angular_speed: Pair | None = ...,
    rtol: float | None = ...,
    gravity: float = ...,
    certify: bool = ...,
    threads: int = ...,
) -> RigModes: ...
@overload
def modes(
    system: Cord,
    count: int | None = ...,
    *,
    first: int = ...,
    conical_height: Pair | None = ...,
    angular_speed: Pair | None = ...,
    rtol: float | None = ...,
    gravity: float = ...,
) -> CordModes: ...
@overload
def modes(
    system: Held,
    count: int | Literal["all"] | None = ...,
    *,
    first: int = ...,
    conical_height: Pair | None = ...,
    angular_speed: Pair | None = ...,
    rtol: float | None = ...,
    gravity: float = ...,
) -> Modes: ...
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
) -> Modes | RigModes:
    """Find the modes of a system: whirl speeds (critical speeds), with shapes, nodes and error bounds.

    The whirl speed of small amplitude of a chain hung from a fixed point is the natural angular frequency of its swing
    in a plane.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        A chain of N links, by itself or rigged; a flexible cord; a chain or cord held straight by a tension at both ends,
        with gravity or without.
    count : int or "all", optional
        How many modes, slowest first: 10 if left out, or fewer where there are fewer. For a rig with flywheels, so many
        in each direction of rotation; `first` and windows, of the sizes of speeds, choose in each, too. A cord has
        infinitely many.
    first : int, optional
        Number of the first mode wanted; the slowest is 1. Slower ones are not computed.
    conical_height : (low, high), optional
        All modes with ``low < conical height <= high`` instead, m. `low` may be 0, `high` infinite.
    angular_speed : (low, high), optional
        All modes with ``low <= whirl speed < high`` instead, rad/s. `low` may be 0, `high` infinite.
    rtol : float, optional
        Relative tolerance of the conical heights. The cheapest method whose bound keeps it is taken: closed form,
        Bessel zero, coarser chain, ... (`explain` says which and why); below 2 ulp it is double-double, whose heights
        are ``conical_height + conical_height_low``. Full accuracy in double, 2 ulp, if left out. Rigs are solved to
        full accuracy whatever it is.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    method : str, optional
        ``"bisection"`` counts the modes above a height and halves intervals: any modes of any chain, to 2 ulp.
        ``"condensed"`` condenses a long chain first: some of its slowest modes, to 2 ulp. ``"aberth"`` finds all modes
        of a small chain at once. ``"interpolated"`` interpolates the characteristic polynomial: many modes. Where they
        cannot, bisection is used; ``method`` of the result says so. ``"dense"`` solves the assembled pencil and
        ``"recurrence"`` relation (21) as printed: references for small chains. Any other name that `explain` lists is
        that method, whatever it costs. The cheapest if left out.
    precision : {"double", "single", "extended", "double-double"}
        The arithmetic of the result. ``"single"``: the chain's numbers and the window are ROUNDED to float32 first, and
        results are float32. ``"extended"``: results are of numpy's longdouble, which has 64 bits on x86-64 and on some
        platforms is no more than double. ``"double-double"``: twice the digits of double;
        ``conical_height + conical_height_low``, two float64 arrays, is the height that `error_bound` is of (3e-29 for
        one link, 1e-24 for 2000), and shapes are float64.
    certify : bool
        Whether to return with every height the interval that holds it and the counts that prove it. Chains and rigs.
    threads : int, optional
        Chains and rigs: how many threads to use for heights and, when they are read, shapes; 0 for all processors. Results are
        bitwise the same whatever their number.

    Returns
    -------
    Modes, RigModes or CordModes
        ``status`` is ``"tolerance_not_met"`` where `rtol` is smaller than what was reached; ``error_bound`` says what
        was. An empty window gives no modes.

    Raises
    ------
    ValueError
        If the modes asked for are not there or are given twice, a window is none, `rtol` is NaN or negative, or
        `method` or `precision` unknown. For a rig if `method` or `precision` is given; for a rig of
        more than 20,000 links whose speeds may be complex (inverted links or driven wheels together with momentum,
        floats in fluid that turns). For a held system unless it is under a tension that exceeds its weight.
    TypeError
        If `system` is none of these.

    Notes
    -----
    Which modes lie in a window is decided by proved counts of the exact heights: windows that meet share no mode and
    lose none. A height just above `low` may be rounded to it.

    Accuracy: the relative error bound is returned in ``error_bound`` (2 ulp by default, proved by counts). Cost of
    bisection O(N) for each halving, about 50 halvings a mode; shapes O(N) time and memory a mode when they are read.
    Other Python threads run on meanwhile. Rigs whose speeds may be complex: all speeds are found, in 0.3 microseconds
    times the square of the number of links: 5000 links in 7 s.

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
FULL = 4.4432e-16  # 2 ulp: what full accuracy in double is sure to keep
METHODS = tuple(name for name in dict.fromkeys((*_core.METHODS[1:], *_core.MODELS)) if name != "finite amplitude")
_DEFAULTS: dict[str, Any] = {"conical_height": None, "angular_speed": None, "rtol": None, "method": None}
_DEFAULTS |= {"precision": "double", "certify": False}


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
) -> Modes | RigModes | CordModes:
    """`modes`, watched: `progress` tells how far it is and can cancel it from another thread."""
    place = "revchain.modes"
    g = gravity if type(gravity) is float and 0 < gravity < 1e300 else one_positive(place, "gravity", gravity)
    start = first if type(first) is int and first == 1 else checked_count(place, "first", first)
    shared = threads if type(threads) is int and threads == 1 else integer(place, "threads", threads)
    if conical_height is not None or angular_speed is not None:
        _refuse_two_choices(place, conical_height, angular_speed, count, start)
    if isinstance(system, Rig):
        _refuse(place, {"method": method, "precision": precision}, "is for a Chain; a Rig has one method, in double")
    heights = window = None
    if conical_height is not None:
        heights = _window(place, "conical_height", conical_height)
    elif angular_speed is not None:
        window = _window(place, "angular_speed", angular_speed)
    if rtol is not None:
        rtol = real(place, "rtol", rtol)
    if certify is not False:
        certify = boolean(place, "certify", certify)
    if isinstance(system, Rig):
        many = count_of(place, count, 10)
        of_rig = _core.rig_modes(system._under(g), start, many, heights, window, rtol, certify, g, progress, shared)
        found = RigModes._made(of_rig, system=system, gravity=g, rtol=rtol)
        if start > max(1, *found.available):
            raise ValueError(f"{place}: first must be from 1 to {max(found.available)}, the number of modes in a direction, got {start}")
        return found
    speeds = None if window is None else (*window, g)
    if not isinstance(system, Chain):
        asked = {"method": method, "precision": precision, "certify": certify}
        return _of_cord_or_held(place, system, count, start, heights, speeds, rtol, g, asked, progress)
    core = compiled(place, system)
    wanted: int | None = None
    if heights is None and speeds is None:
        wanted = how_many(place, count, start, core.mode_count)
    if precision is not _DOUBLE:
        checked_word(place, "precision", precision, _core.PRECISIONS)
    if rtol is not None and 0 < rtol <= FULL and method is None and wanted and precision == "double" and not certify:
        method = "double-double"  # no method in double keeps it
    if method is not None and not (isinstance(method, str) and method in _core.METHODS[1:]):
        checked_word(place, "method", method, METHODS)
        if wanted is None or precision != "double" or certify:
            raise ValueError(f"{place}: method {method!r} goes with count, first and rtol alone")
        tolerance = FULL / 2 if method == "double-double" and rtol is None else rtol or 0.0
        of_model = _core.solve_by(core, start, wanted, tolerance, 0.0, method)
        return _by_model(of_model, system, g, rtol, start)
    way = method or "auto"
    of_chain = _core.modes(core, start, wanted, heights, speeds, rtol, certify, precision, way, progress, shared)
    return Modes._made(of_chain, system=system, gravity=g, precision=precision, rtol=rtol)


def _refuse_two_choices(place: str, height: Any, speed: Any, count: Any, first: int) -> None:
    given = {"conical_height": height is not None, "angular_speed": speed is not None}
    named = [name for name, there in {**given, "count": count is not None, "first": first != 1}.items() if there]
    if len(named) > 1:
        raise ValueError(f"{place}: give one window, or count and first, not both, got {' and '.join(named)}")


def _by_model(found: tuple[Any, ...], chain: Chain, gravity: float, rtol: float | None, first: int) -> Modes:
    height, bound, low, method, status = found
    if not len(height):
        raise ValueError(f"revchain.modes: method {method!r} does not apply to this chain; explain says why")
    given: dict[str, Any] = {"conical_height": height, "error_bound": bound, "conical_height_low": low}
    given |= {"number": np.arange(first, first + len(height)), "certificate": None, "method": method}
    given |= {"status": "success" if rtol is None else status, "precision": "double" if low is None else "double-double"}
    return Modes._made(None, system=chain, gravity=gravity, rtol=rtol, **given)


def _of_cord_or_held(
    place: str,
    system: Cord | Held,
    count: int | str | None,
    first: int,
    heights: Pair | None,
    speeds: tuple[float, float, float] | None,
    rtol: float | None,
    gravity: float,
    asked: dict[str, Any],
    progress: _core.Progress | None,
) -> Modes:
    if isinstance(system, Cord):
        _refuse(place, asked, "is for a Chain; the heights of a Cord have closed forms or power series")
        if count == "all":
            raise ValueError(f"{place}: a cord has infinitely many modes; give count, or a window that ends")
        wanted = None if heights or speeds else count_of(place, count, 10, each=24)
        of_cord = _core.cord_modes(system._under(gravity), first, wanted, heights, speeds, rtol, progress)
        return CordModes._made(of_cord, system=system, gravity=gravity, rtol=rtol)
    if not isinstance(system, Held):
        raise no_system(place, system)
    _refuse(place, asked, "is for a Chain that hangs")
    core, most = straight(place, system, gravity), system.mode_count
    if most is None and count == "all":
        raise ValueError(f"{place}: a cord has infinitely many modes; give count, or a window that ends")
    default = 10 if most is None else max(min(10, most - first + 1), 1)
    wanted = None if heights or speeds else count_of(place, count, default, each=24)
    of_held = _core.held_modes(core, first, wanted, heights, speeds, rtol, progress, gravity)
    if most is None:
        return CordModes._made(of_held, system=system, gravity=gravity, rtol=rtol)
    return Modes._made(of_held, system=system, gravity=gravity, precision="double", rtol=rtol)


def straight(place: str, held: Held, gravity: float) -> _core.Held | _core.HeldCord:
    """A chain or cord that a tension holds straight."""
    if held.span is not None:
        raise ValueError(
            f"{place}: a chain or cord whose ends are a span apart is bent, and has no modes of a straight one; ask "
            f"steady_shapes, and stability of a shape, got span {held.span:g}"
        )
    least = 0.0 if held.weightless else held._force(gravity) * held._total
    if held.tension is not None and not held.tension > least:
        raise ValueError(
            f"{place}: tension at the upper end must exceed the weight {least:.6g}, or the lower part is slack, got "
            f"{held.tension:g}"
        )
    return held._under(gravity)


def how_many(place: str, count: int | str | None, first: int, most: int) -> int:
    """How many modes are asked for where there are `most`: ten unless said, or all that are left."""
    left = max(most - first + 1, 1)
    return count_of(place, count, min(10, left)) or left


def count_of(place: str, count: int | str | None, default: int, each: int = 0) -> int | None:
    """How many, of so many bytes each; None for all."""
    if count is None:
        return default
    if isinstance(count, str):
        if count != "all":
            raise ValueError(f'{place}: count must be a number or "all", got {shown(count)}')
        return None
    return checked_count(place, "count", count, each)


def _refuse(place: str, given: dict[str, Any], reason: str) -> None:
    """Raise a ValueError for options that are for chains only."""
    for name, value in given.items():
        if value is not _DEFAULTS[name] and not (isinstance(value, str) and value == _DEFAULTS[name]):
            raise ValueError(f"{place}: {name} {reason}, got {shown(value)}")


def _window(place: str, name: str, window: object) -> Pair:
    """The two ends of a window; whether they make one is checked where it is used."""
    if isinstance(window, str | set | dict) or not isinstance(window, Iterable) or getattr(window, "ndim", 1) == 0:
        raise ValueError(f"{place}: {name} must be a pair (low, high), got {shown(window)}")
    ends = [real(place, f"{name} (each end)", end) for end in window]
    if len(ends) != 2:
        raise ValueError(f"{place}: {name} must be a pair (low, high), got {shown(window)}")
    return ends[0], ends[1]


def count_modes(
    system: Chain | Rig | Cord | Held,
    *,
    conical_height: ArrayLike | None = None,
    angular_speed: ArrayLike | None = None,
    gravity: ArrayLike = STANDARD_GRAVITY,
) -> Any:
    """Count the whirl speeds below a speed, which are the conical heights above a height.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        A chain of N links, by itself or rigged, a cord, or what is held straight by a tension.
    conical_height : array_like, optional
        Heights, m, positive, any shape.
    angular_speed : array_like, optional
        Speeds in rad/s, positive, any shape. Give either this or `conical_height`. Of a rig with flywheels a negative
        speed counts the backward modes between 0 and it.
    gravity : array_like, optional
        Acceleration of gravity, broadcast against `angular_speed`; standard gravity if left out. One number for a rig
        and for what is held.

    Returns
    -------
    numpy.int64 or ndarray of int64
        How many modes are slower than each speed given; shape of the argument. Of a rig with flywheels, those in the
        direction of the speed, or above a height those of both directions.

    Raises
    ------
    ValueError
        If both or neither of height and speed are given, or for numbers out of their range. For a rig as `modes`, and
        where rounding leaves the number in doubt.

    Notes
    -----
    Chains and rigs: Sylvester's law of inertia, in rounded arithmetic with a proof, and in twice the digits where
    the proof fails: the count is that of the numbers stored. Cost O(N) for each number. Rigs whose speeds may be complex:
    all are found once, as by `modes`, and each speed is compared with those that are real. Cords: heights within the error
    bound of `modes` of the one given may be counted on either side.

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
    place = "revchain.count_modes"
    if (conical_height is None) == (angular_speed is None):
        raise ValueError(f"{place}: give either conical_height or angular_speed")
    if isinstance(system, Chain):
        core = compiled(place, system)
        if conical_height is not None:
            positive(place, "gravity", gravity)
            return _core.count_modes(core, floats(place, "conical_height", conical_height))[()]
        assert angular_speed is not None
        speed = floats(place, "angular_speed", angular_speed)
        speed, each = together(place, angular_speed=speed, gravity=positive(place, "gravity", gravity))
        return _core.count_modes_at_speed(core, speed, each)[()]
    g = one_positive(place, "gravity", gravity)
    if conical_height is not None:
        height = positive(place, "conical_height", conical_height)
    elif isinstance(system, Rig):
        return _core.count_rig_modes(system._under(g), floats(place, "angular_speed", angular_speed), False, g)[()]
    else:
        assert angular_speed is not None
        height = g / positive(place, "angular_speed", angular_speed) ** 2
    if isinstance(system, Cord):
        return _core.count_cord_modes(system._under(g), height)[()]
    if isinstance(system, Held):
        return _core.count_held_modes(straight(place, system, g), height, g)[()]
    if isinstance(system, Rig):
        return _core.count_rig_modes(system._under(g), height, True, g)[()]
    raise no_system(place, system)


def recurrence_matrices(chain: Chain) -> tuple[Floats, Floats]:
    """Write relation (21) of the paper as a pair of matrices.

    Parameters
    ----------
    chain : Chain
        The chain of N links.

    Returns
    -------
    A, B : ndarray, shape (N, N)
        Dense matrices with ``A @ y = conical_height * B @ y``, `y` the offsets of the pins from the
        free end up, the support left out.

    Notes
    -----
    The relation as corrected: ``h_{m-2} / a_{m-2}`` in its third bracket, and the lowest pin kept
    as an unknown. Small amplitude. Memory O(N**2).

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
