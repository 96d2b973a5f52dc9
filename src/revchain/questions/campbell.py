# SPDX-License-Identifier: GPL-3.0-or-later
"""`campbell`: frequencies of small motion about a steady shape against the speed."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from ..results.campbell import Campbell, Crossing
from ..systems.chain import Chain
from ..systems.numbers import STANDARD_GRAVITY, Floats, integer, listed, one_positive, positive, shown
from ..systems.rig import Rig
from .refuse import refuse_other
from .shapes import steady_shapes

_CALLER = "revchain.campbell"
_HALVINGS = 60  # of an interval between two speeds: to the last digits
Steady = tuple[Floats, bool]  # frequencies over the speed, ascending, and whether no motion grows


def campbell(
    system: Chain | Rig,
    angular_speed: ArrayLike,
    *,
    orders: Iterable[int] = (1, 2),
    half_waves: int = 1,
    frame: str = "free",
    gravity: float = STANDARD_GRAVITY,
) -> Campbell:
    """Return the frequencies of small motion about a steady shape at many speeds, and the speeds to avoid.

    Wind, a tilted axis and every other influence that is constant in space turns once for each turn of the system, seen from
    the system. Where a frequency equals the speed (1n) it is in resonance with that; where it is twice the speed (2n), with
    what repeats twice in a turn.

    Parameters
    ----------
    system : Chain or Rig
        A chain of N links or a rig, such as a chair-o-plane: with ``Support(radius=)``.
    angular_speed : array_like, shape (S,)
        Speeds, rad/s, positive, ascending; at least two.
    orders : iterable of int
        Multiples of the speed.
    half_waves : int
        Number of half waves of the shape. If several shapes have this number, the one is taken that is farthest out; with the
        support off the axis it is that which begins at rest.
    frame : {"free", "driven"}
        As in `SteadyShape.stability`.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.

    Returns
    -------
    Campbell
        Frequencies, stability and crossings. Where there is no such shape they are NaN.

    Raises
    ------
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.
    ValueError
        If `system` is a `Cord` or a `Held`; if speeds are not positive, finite and ascending; if `orders` has none, or not
        whole positive numbers; as `steady_shapes` and `SteadyShape.stability`; if there is no such shape at any speed.

    Notes
    -----
    Method: `steady_shapes` and `stability` at each speed. A frequency that crosses a multiple of the speed between two
    speeds is found by halving, to 1e-12. Accuracy: that of the exponents, 1e-13 of the largest. Cost: one to twenty
    milliseconds for each speed, 60 times as much for each crossing. Source: W. Campbell, The Protection of Steam-Turbine
    Disk Wheels from Axial Vibration, Trans. ASME 46 (1924).

    Examples
    --------
    >>> import numpy as np
    >>> import revchain as rc
    >>> found = rc.campbell(rc.Chain(mass=[1.0, 1.0], length=0.5), np.linspace(5.0, 12.0, 8))
    >>> found.frequency[0].round(3)
    array([ 6.427,  9.472, 14.007])
    """
    refuse_other(_CALLER, system, ("chain", "rig"), {"cord": "use its chain: cord.chain(100)", "held": "use steady_shapes and stability"})
    speeds = np.array(positive(_CALLER, "angular_speed", angular_speed))
    if speeds.ndim != 1 or speeds.size < 2 or (np.diff(speeds) <= 0).any():
        raise ValueError(f"{_CALLER}: angular_speed must be a list of at least two ascending speeds, got {shown(angular_speed)}")
    multiples = tuple(integer(_CALLER, "orders", order) for order in listed(_CALLER, "orders", orders))
    if not multiples or min(multiples) < 1:
        raise ValueError(f"{_CALLER}: orders must be whole positive numbers, at least one, got {shown(orders)}")
    waves, g = integer(_CALLER, "half_waves", half_waves), one_positive(_CALLER, "gravity", gravity)

    def at(speed: float) -> Steady | None:
        return _frequencies(system, float(speed), waves, frame, g)

    found = [at(speed) for speed in speeds]
    if all(each is None for each in found):
        raise ValueError(f"{_CALLER}: there is no shape of {waves} half wave{'s' * (waves != 1)} at any of the speeds")
    width = max(each[0].size for each in found if each is not None)
    ratio = np.full((speeds.size, width), np.nan)
    for row, each in zip(ratio, found, strict=True):
        if each is not None:
            row[: each[0].size] = each[0]
    crossings = [
        Crossing(order, j + 1, _zero(at, j, order, float(speeds[k]), float(speeds[k + 1])))
        for order in multiples
        for k in range(speeds.size - 1)
        for j in range(width)
        if (ratio[k, j] - order) * (ratio[k + 1, j] - order) < 0
    ]
    return Campbell._made(
        None,
        system=system,
        gravity=g,
        frame=frame,
        orders=multiples,
        angular_speed=speeds,
        frequency=ratio * speeds[:, None],
        stable=np.array([each is not None and each[1] for each in found]),
        crossings=tuple(crossings),
    )


def _frequencies(system: Any, speed: float, half_waves: int, frame: str, gravity: float) -> Steady | None:
    """The frequencies of the shape over the speed; None if there is no such shape."""
    shapes = steady_shapes(system, angular_speed=speed, gravity=gravity)
    chosen = [shape for shape in shapes if shape.half_waves == half_waves]
    if not chosen:
        return None
    stability = max(chosen, key=lambda shape: float(shape.offset[0])).stability(frame=frame)
    above = stability.exponents.imag > stability.exponent_error
    return np.sort(stability.exponents.imag[above]), stability.verdict != "unstable"


def _zero(at: Any, motion: int, order: int, low: float, high: float) -> float:
    """The speed between two at which a frequency is a multiple of it, by halving."""
    sign = np.sign(at(low)[0][motion] - order)
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        there = at(middle)
        if not low < middle < high or there is None or there[0].size <= motion or high - low < 1e-12 * high:
            break
        if np.sign(there[0][motion] - order) == sign:
            low = middle
        else:
            high = middle
    return (low + high) / 2
