# SPDX-License-Identifier: GPL-3.0-or-later
"""The slowest modes of a system, and how many there are below a speed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Literal, overload

from numpy.typing import ArrayLike

from .. import _core
from ..results.modes import Modes, RigModes
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, Floats, boolean, floats, one_positive, positive, real, shown, together
from ..systems.numbers import count as checked_count
from ..systems.numbers import word as checked_word
from ..systems.rig import Rig

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
) -> Modes: ...
@overload
def modes(
    system: Rig, count: int | Literal["all"] | None = ..., *, first: int = ..., gravity: float = ...
) -> RigModes: ...
def modes(
    system: Chain | Rig,
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
) -> Modes | RigModes:
    """Find the modes of a system: its whirl speeds, with shapes, nodes and error bounds.

    Parameters
    ----------
    system : Chain or Rig
        N links, by themselves or rigged with supports, flywheels, standing links, a fluid.
    count : int or "all", optional
        How many modes, slowest first: 10 if left out, or fewer where there are fewer. For a rig with flywheels, so many
        in each direction of rotation.
    first : int, optional
        Number of the first mode wanted; the slowest is 1. Slower ones are not computed.
    conical_height : (low, high), optional
        All modes with ``low < conical height <= high`` instead, m. `low` may be 0, `high` infinite.
    angular_speed : (low, high), optional
        All modes with ``low <= whirl speed < high`` instead, rad/s. `low` may be 0, `high` infinite.
    rtol : float, optional
        Relative tolerance of the conical heights. The cheapest method whose bound keeps it is taken: closed form,
        Bessel zero, coarser chain, ... (`explain` says which and why). Full accuracy, 2 ulp, if left out.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    method : {"bisection", "condensed", "aberth", "interpolated", "dense", "recurrence"}, optional
        ``"bisection"`` counts the modes above a height and halves intervals: any modes of any chain, to 2 ulp.
        ``"condensed"`` condenses a long chain first: some of its slowest modes, to 2 ulp. ``"aberth"`` finds all modes
        of a small chain at once. ``"interpolated"`` interpolates the characteristic polynomial: many modes. Where they
        cannot, bisection is used; ``method`` of the result says so. ``"dense"`` solves the assembled pencil and
        ``"recurrence"`` relation (21) as printed: references for small chains. The cheapest if left out.
    precision : {"double", "single", "extended", "double-double"}
        The arithmetic of the result. ``"single"``: the chain's numbers and the window are ROUNDED to float32 first, and
        results are float32. ``"extended"``: results are of numpy's longdouble, which has 64 bits on x86-64 and on some
        platforms is no more than double. ``"double-double"``: twice the digits of double;
        ``conical_height + conical_height_low``, two float64 arrays, is the height that `error_bound` is of (3e-29 for
        one link, 1e-24 for 2000), and shapes are float64.
    certify : bool
        Whether to return with every height the interval that holds it and the counts that prove it.

    Returns
    -------
    Modes or RigModes
        ``status`` is ``"tolerance_not_met"`` where `rtol` is smaller than what was reached; ``error_bound`` says what
        was. An empty window gives no modes.

    Raises
    ------
    ValueError
        If the modes asked for are not there or are given twice, a window is none, `rtol` is NaN or negative, or
        `method` or `precision` unknown. For a rig if anything but `count`, `first` and `gravity` is given; for a rig of
        more than 200 links whose speeds may be complex (links that stand or driven wheels together with momentum,
        floats in fluid that turns).

    Notes
    -----
    Which modes lie in a window is decided by proved counts of the exact heights: windows that meet share no mode and
    lose none. A height just above `low` may be rounded to it.

    Accuracy: the relative error bound is returned in ``error_bound`` (2 ulp by default, proved by counts). Cost of
    bisection O(N) for each halving, about 50 halvings a mode; shapes O(N) time and memory a mode when they are read.
    Other Python threads run on meanwhile.

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
    >>> rc.modes(rc.Rig(rc.Chain(weight=9.80665, length=1.0), momentum=1.5)).angular_speed.round(3)
    array([-2.47,  3.97])
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
    )


_DEFAULTS: dict[str, Any] = {"conical_height": None, "angular_speed": None, "rtol": None, "method": None}
_DEFAULTS |= {"precision": "double", "certify": False}


def find_modes(
    system: Chain | Rig,
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
    progress: _core.Progress | None = None,
) -> Modes | RigModes:
    """`modes`, watched: `progress` tells how far it is and can cancel it from another thread."""
    place = "revchain.modes"
    g = gravity if type(gravity) is float and 0 < gravity < 1e300 else one_positive(place, "gravity", gravity)
    start = checked_count(place, "first", first)
    windows = {"conical_height": conical_height, "angular_speed": angular_speed}
    named = [name for name, window in windows.items() if window is not None]
    if len(named) > 1 or (named and (count is not None or start != 1)):
        others = [name for name, there in (("count", count is not None), ("first", start != 1)) if there]
        both = " and ".join([*named, *others])
        raise ValueError(f"{place}: give one window, or count and first, not both, got {both}")
    if isinstance(system, Rig):
        asked = {**windows, "rtol": rtol, "method": method, "precision": precision, "certify": certify}
        _refuse_for_rigs(place, asked)
        of_rig = _core.rig_modes(system._compiled, start, _count(place, count, 10), g, progress)
        found = RigModes._made(of_rig, system=system, gravity=g)
        if start > max(1, *found.available):
            raise ValueError(f"{place}: there are {max(found.available)} modes in a direction, got first = {start}")
        return found
    if not isinstance(system, Chain):
        raise TypeError(f"{place}: system must be a revchain.Chain or Rig, got {shown(system)}")
    core = compiled(place, system)
    wanted: int | None = None
    heights = speeds = None
    if conical_height is not None:
        heights = _window(place, "conical_height", conical_height)
    elif angular_speed is not None:
        speeds = (*_window(place, "angular_speed", angular_speed), g)
    else:
        wanted = _count(place, count, max(min(10, core.mode_count - start + 1), 1))
    if rtol is not None:
        rtol = real(place, "rtol", rtol)
    if method is not None:
        checked_word(place, "method", method, _core.METHODS[1:])
    checked_word(place, "precision", precision, _core.PRECISIONS)
    certify = boolean(place, "certify", certify)
    of_chain = _core.modes(core, start, wanted, heights, speeds, rtol, certify, precision, method or "auto", progress)
    return Modes._made(of_chain, system=system, gravity=g, precision=precision, rtol=rtol)


def _count(place: str, count: int | str | None, default: int) -> int | None:
    """How many; None for all."""
    if count is None:
        return default
    if isinstance(count, str):
        if count != "all":
            raise ValueError(f'{place}: count must be a number or "all", got {shown(count)}')
        return None
    return checked_count(place, "count", count)


def _refuse_for_rigs(place: str, given: dict[str, Any]) -> None:
    """Raise a ValueError for options that are for chains only."""
    for name, value in given.items():
        if value is not _DEFAULTS[name] and not (isinstance(value, str) and value == _DEFAULTS[name]):
            raise ValueError(
                f"{place}: {name} is for a Chain; the modes of a Rig are chosen by count and first, got {shown(value)}"
            )


def _window(place: str, name: str, window: object) -> Pair:
    """The two ends of a window; whether they make one is checked where it is used."""
    if isinstance(window, str) or not isinstance(window, Iterable):
        raise ValueError(f"{place}: {name} must be a pair (low, high), got {shown(window)}")
    ends = [real(place, f"{name} (each end)", end) for end in window]
    if len(ends) != 2:
        raise ValueError(f"{place}: {name} must be a pair (low, high), got {shown(window)}")
    return ends[0], ends[1]


def count_modes(
    chain: Chain,
    *,
    conical_height: ArrayLike | None = None,
    angular_speed: ArrayLike | None = None,
    gravity: ArrayLike = STANDARD_GRAVITY,
) -> Any:
    """Count the conical heights above a height, which is the whirl speeds below a speed.

    Parameters
    ----------
    chain : Chain
        The chain of N links.
    conical_height : array_like, optional
        Heights in the unit of the chain's lengths, positive, any shape.
    angular_speed : array_like, optional
        Speeds in rad/s, positive, any shape. Give either this or `conical_height`.
    gravity : array_like, optional
        Acceleration of gravity, broadcast against `angular_speed`; standard gravity if left out.

    Returns
    -------
    numpy.int64 or ndarray of int64
        How many modes are slower than each speed given; shape of the argument.

    Raises
    ------
    ValueError
        If both or neither of height and speed are given, or for numbers out of their range.

    Notes
    -----
    Sylvester's law of inertia, in rounded arithmetic with a proof, and in twice the digits where
    the proof fails: the count is that of the numbers stored. Cost O(N) for each number.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain.uniform_rods(120, length=0.36)
    >>> int(rc.count_modes(chain, angular_speed=20.0))
    2
    >>> rc.count_modes(chain, conical_height=[0.3, 0.2, 0.04])
    array([0, 1, 2])
    """
    place = "revchain.count_modes"
    if (conical_height is None) == (angular_speed is None):
        raise ValueError(f"{place}: give either conical_height or angular_speed")
    core = compiled(place, chain)
    if conical_height is not None:
        return _core.count_modes(core, floats(place, "conical_height", conical_height))[()]
    assert angular_speed is not None
    speed = floats(place, "angular_speed", angular_speed)
    speed, g = together(place, angular_speed=speed, gravity=positive(place, "gravity", gravity))
    return _core.count_modes_at_speed(core, speed, g)[()]


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
