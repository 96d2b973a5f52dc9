# SPDX-License-Identifier: GPL-3.0-or-later
"""The calls that compute something of a chain."""

from __future__ import annotations

from typing import Any

from numpy.typing import ArrayLike

from . import _core
from ._arguments import STANDARD_GRAVITY, Floats, floats, positive, real, shown, together
from ._arguments import count as checked_count
from ._chain import Chain
from ._modes import Modes


def modes(
    chain: Chain,
    count: int | None = None,
    rtol: float | None = None,
    method: str = "auto",
    shapes: bool = True,
) -> Modes:
    """Find the slowest ways in which a chain whirls.

    Parameters
    ----------
    chain : Chain
        The chain of N links.
    count : int, optional
        How many modes, slowest first; all ``chain.mode_count`` of them if left out.
    rtol : float, optional
        Relative tolerance asked of the conical heights; as accurate as double precision allows
        (2 ulp, that is 4.4e-16) if left out.
    method : {"auto", "bisection", "dense", "recurrence"}
        ``"bisection"`` counts the modes above a height and halves intervals, each height certified
        by counting; ``"dense"`` solves the assembled pencil and ``"recurrence"`` relation (21) as
        printed: references for small chains. ``"auto"`` chooses.
    shapes : bool
        Whether to compute shapes, residuals and nodes.

    Returns
    -------
    Modes
        ``status`` is ``"tolerance_not_met"`` where `rtol` is smaller than what was reached;
        ``error_bound`` says what was.

    Raises
    ------
    ValueError
        If `count` is not from 1 to ``chain.mode_count``, `rtol` is NaN or negative, or `method` is
        unknown.

    Notes
    -----
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
    """
    return solve(chain, count, rtol, method, shapes)


def solve(
    chain: Chain,
    count: int | None,
    rtol: float | None,
    method: str,
    shapes: bool = True,
    progress: _core.Progress | None = None,
) -> Modes:
    """`modes`, watched: `progress` tells how far it is and can cancel it from another thread."""
    place = "revchain.modes"
    if count is not None:
        count = checked_count(place, "count", count)
    if rtol is not None:
        rtol = real(place, "rtol", rtol)
    if not isinstance(method, str):
        raise ValueError(f"{place}: method must be one of {', '.join(_core.METHODS)}, got {shown(method)}")
    found = _core.modes(_compiled(place, chain), count, rtol, method, bool(shapes), progress)
    return Modes(
        chain=chain,
        conical_height=found.conical_height,
        error_bound=found.error_bound,
        shape=found.shape,
        residual=found.residual,
        nodes=found.nodes,
        method=found.method,
        status=found.status,
    )


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
    core = _compiled(place, chain)
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
    return _core.recurrence_matrices(_compiled("revchain.recurrence_matrices", chain))


def _compiled(place: str, chain: Chain) -> _core.Chain:
    if not isinstance(chain, Chain):
        raise TypeError(f"{place}: chain must be a revchain.Chain, got {shown(chain)}")
    return chain._compiled
