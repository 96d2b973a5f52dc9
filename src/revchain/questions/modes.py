# SPDX-License-Identifier: GPL-3.0-or-later
"""The calls that compute something of a chain."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, overload

from numpy.typing import ArrayLike

from .. import _core
from ..results.modes import Certificate, Modes
from ..results.rig_modes import RigModes, refuse_for_rigs, rig_modes
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, Floats, boolean, floats, integer, positive, real, shown, together
from ..systems.numbers import count as checked_count
from ..systems.numbers import word as checked_word
from ..systems.rig import Rig


@overload
def modes(
    chain: Chain,
    count: int | None = ...,
    *,
    modes: Iterable[int] | None = ...,
    conical_height: tuple[float, float] | None = ...,
    angular_speed: tuple[float, float] | None = ...,
    gravity: float = ...,
    shapes: bool = ...,
    rtol: float | None = ...,
    certify: bool = ...,
    precision: str = ...,
    method: str = ...,
) -> Modes: ...
@overload
def modes(
    chain: Rig,
    count: int | None = ...,
    *,
    modes: Iterable[int] | None = ...,
    gravity: float = ...,
    shapes: bool = ...,
) -> RigModes: ...
def modes(
    chain: Chain | Rig,
    count: int | None = None,
    *,
    modes: Iterable[int] | None = None,
    conical_height: tuple[float, float] | None = None,
    angular_speed: tuple[float, float] | None = None,
    gravity: float = STANDARD_GRAVITY,
    shapes: bool = True,
    rtol: float | None = None,
    certify: bool = False,
    precision: str = "double",
    method: str = "auto",
) -> Modes | RigModes:
    """Find the ways in which a chain whirls: the slowest, those with given numbers, or those in a window.

    Parameters
    ----------
    chain : Chain or Rig
        The chain of N links, by itself or rigged with supports, flywheels, standing links, a fluid.
    count : int, optional
        How many modes, slowest first; all ``chain.mode_count`` of them if nothing is said. Of a rig with
        flywheels, so many in each sense of rotation.
    modes : range, optional
        Instead of `count`: numbers of the modes, from 1 for the slowest, without gaps and ascending.
        ``range(1000, 1010)`` is the 1000th to the 1009th slowest; those before are not computed.
    conical_height : (low, high), optional
        Instead of `count`: the modes with ``low < conical height <= high``, in the unit of the chain's
        lengths. `low` may be 0, `high` infinite.
    angular_speed : (low, high), optional
        Instead of `count`: the modes with ``low <= whirl speed < high``, in rad/s. `low` may be 0,
        `high` infinite.
    gravity : float, optional
        For `angular_speed`, and for the speeds of a rig; standard gravity, in metres, if left out.
    shapes : bool
        Whether to compute shapes, residuals and nodes.
    rtol : float, optional
        Relative tolerance asked of the conical heights; as accurate as the precision allows (2 ulp,
        that is 4.4e-16 in double precision) if left out.
    certify : bool
        Whether to return with every height the interval that holds it and the counts that prove it.
    precision : {"double", "single", "extended", "double-double"}
        The arithmetic of the result. ``"single"``: the chain's numbers and the window are ROUNDED to
        float32 first, and results are float32. ``"extended"``: results are of numpy's longdouble, which
        has 64 bits on x86-64 and on some platforms is no more than double. ``"double-double"``: twice
        the digits of double; ``conical_height + conical_height_low``, two float64 arrays, is the height that
        `error_bound` is of (3e-29 for one link, 1e-24 for 2000), and shapes are float64.
    method : {"auto", "bisection", "condensed", "aberth", "interpolated", "dense", "recurrence"}
        ``"bisection"`` counts the modes above a height and halves intervals: any modes of any chain,
        to 2 ulp. ``"condensed"`` condenses a long chain first: some of its slowest modes, to 2 ulp.
        ``"aberth"`` finds all modes of a small chain at once, to some 20 ulp. ``"interpolated"``
        interpolates the characteristic polynomial: many modes, to the last digit some 60 times faster
        than one by one, 100 times with ``rtol=1e-14``. Where they cannot, bisection is used; the
        result's ``method`` says so. ``"dense"`` solves the assembled pencil and ``"recurrence"``
        relation (21) as printed: references for small chains. ``"auto"`` takes the cheapest of the
        first four that keeps `rtol`. In extended and double-double there is bisection alone; single is
        computed in double and rounded.

    Returns
    -------
    Modes or RigModes
        The latter for a `Rig`, of which nothing else but `count`, `modes`, `gravity` and `shapes` can be
        asked; what is no steady motion is listed whole, however few modes are asked for. ``status`` is
        ``"tolerance_not_met"`` where `rtol` is smaller than what was reached; ``error_bound`` says what was. An empty
        window gives no modes.

    Raises
    ------
    ValueError
        If more than one of `count`, `modes`, `conical_height` and `angular_speed` is given; if a mode
        number is not from 1 to ``chain.mode_count``, `modes` has gaps, or a window is none; if `rtol`
        is NaN or negative, or `method` or `precision` unknown. For a rig of more than 200 links whose speeds may be
        complex: links that stand or driven wheels together with momentum, floats in fluid that turns.

    Notes
    -----
    Which modes lie in a window is decided as `count_modes` counts, by proved counts of the exact
    heights: windows that meet share no mode and lose none. A height just above `low` may be rounded to
    it.

    Accuracy: the relative error bound is returned in ``error_bound`` (2 ulp by default, certified
    by counting). Cost of bisection O(N) for each halving, about 50 halvings a mode; shapes O(N)
    time and memory a mode. Other Python threads run on meanwhile.

    References
    ----------
    Greenhill (1908), section 8 (21).

    Examples
    --------
    >>> import revchain as rc
    >>> result = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0))
    >>> result.conical_height
    array([1.5, 0.5])
    >>> result.status
    'success'
    >>> rods = rc.Chain.uniform_rods(2000, length=0.36)
    >>> rc.modes(rods, modes=range(1000, 1003)).number
    array([1000, 1001, 1002])
    >>> rc.modes(rods, angular_speed=(20.0, 40.0)).angular_speed().round(3)
    array([22.583, 30.772, 38.964])
    >>> rc.modes(rc.Rig(rc.Chain(weight=9.80665, length=1.0), momentum=1.5)).angular_speed().round(3)
    array([-2.47,  3.97])
    """
    return solve(
        chain,
        count,
        modes=modes,
        conical_height=conical_height,
        angular_speed=angular_speed,
        gravity=gravity,
        shapes=shapes,
        rtol=rtol,
        certify=certify,
        precision=precision,
        method=method,
    )


def solve(
    chain: Chain | Rig,
    count: int | None = None,
    *,
    modes: Iterable[int] | None = None,
    conical_height: tuple[float, float] | None = None,
    angular_speed: tuple[float, float] | None = None,
    gravity: float = STANDARD_GRAVITY,
    shapes: bool = True,
    rtol: float | None = None,
    certify: bool = False,
    precision: str = "double",
    method: str = "auto",
    progress: _core.Progress | None = None,
) -> Modes | RigModes:
    """`modes`, watched: `progress` tells how far it is and can cancel it from another thread."""
    place = "revchain.modes"
    if isinstance(chain, Rig):
        refuse_for_rigs(
            place,
            (
                ("conical_height", conical_height, None),
                ("angular_speed", angular_speed, None),
                ("rtol", rtol, None),
                ("certify", certify, False),
                ("precision", precision, "double"),
                ("method", method, "auto"),
            ),
        )
        if count is not None and modes is not None:
            raise ValueError(f"{place}: give only one of count, modes, got count and modes")
        first, wanted = (1, None if count is None else checked_count(place, "count", count))
        if modes is not None:
            first, wanted = _run_of_numbers(place, modes)
        return rig_modes(place, chain, first, wanted, gravity, shapes, progress)
    core = compiled(place, chain)
    if (modes is not None) + (conical_height is not None) + (angular_speed is not None) + (count is not None) > 1:
        selectors = {"count": count, "modes": modes, "conical_height": conical_height, "angular_speed": angular_speed}
        given = " and ".join(name for name, value in selectors.items() if value is not None)
        raise ValueError(f"{place}: give only one of {', '.join(selectors)}, got {given}")
    first = 1
    heights = speeds = None
    if count is not None:
        count = checked_count(place, "count", count)
    elif modes is not None:
        first, count = _run_of_numbers(place, modes)
    elif conical_height is not None:
        heights = _window(place, "conical_height", conical_height)
    elif angular_speed is not None:
        speeds = (*_window(place, "angular_speed", angular_speed), real(place, "gravity", gravity))
    if rtol is not None:
        rtol = real(place, "rtol", rtol)
    for name, word, known in (("method", method, _core.METHODS), ("precision", precision, _core.PRECISIONS)):
        checked_word(place, name, word, known)
    shapes, certify = boolean(place, "shapes", shapes), boolean(place, "certify", certify)
    number, height, low, bound, shape, residual, nodes, proof, used, status = _core.modes(
        core, first, count, heights, speeds, rtol, shapes, certify, precision, method, progress
    )
    certificate = None if proof is None else Certificate(*proof)
    return Modes(chain, number, height, bound, shape, residual, nodes, used, status, precision, certificate, low)


def _run_of_numbers(place: str, modes: Iterable[int]) -> tuple[int, int]:
    """First and count of consecutive mode numbers."""
    wanted = "modes must be mode numbers without gaps, ascending, such as range(1000, 1010)"
    if not isinstance(modes, range):
        try:
            numbers = [integer(place, "modes", number) for number in modes]
        except TypeError:
            raise ValueError(f"{place}: {wanted}, got {shown(modes)}") from None
        modes = range(numbers[0], numbers[0] + len(numbers)) if numbers else range(0)
        if list(modes) != numbers:
            raise ValueError(f"{place}: {wanted}, got {shown(numbers)}")
    if not modes:
        raise ValueError(f"{place}: modes names no mode, got {shown(modes)}")
    first, last = modes[0], modes[-1]
    if first != last and modes.step != 1:
        raise ValueError(f"{place}: {wanted}, got {modes}")
    return checked_count(place, "modes: its first number", first), checked_count(place, "modes", last - first + 1)


def _window(place: str, name: str, window: object) -> tuple[float, float]:
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
