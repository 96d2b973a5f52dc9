# SPDX-License-Identifier: GPL-3.0-or-later
"""`campbell`: frequencies of small motion about a steady shape against the speed."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.campbell import Campbell, Crossing
from ..results.shapes import is_driven
from ..systems.chain import Chain, checked
from ..systems.numbers import STANDARD_GRAVITY, integer, listed, one_positive, positive, shown
from ..systems.rig import Rig
from ..systems.units import has_units, speed_unit
from .asked import in_unit_of
from .refuse import refuse_other

_CALLER = "revchain.campbell"


@in_unit_of("angular_speed")
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

    Seen from the system, an influence that is constant in space, such as wind or a tilted axis, turns once in each turn. A
    motion whose frequency equals the speed (1n) is in resonance with it; one of twice the speed (2n) is in resonance with
    what repeats twice in a turn.

    Parameters
    ----------
    system : Chain or Rig
        A chain of N links or a rig, such as a chair-o-plane: with ``Support(radius=)``.
    angular_speed : array_like, shape (S,)
        Speeds, rad/s, positive, ascending; at least two.
    orders : iterable of int
        Multiples of the speed, positive.
    half_waves : int
        Number of half waves of the shape. Of several shapes with this number it is the one whose free end is farthest out.
        With the support off the axis and one half wave, that is the shape from rest, as far as its branch goes.
    frame : {"free", "driven"}
        Frame, as in `SteadyShape.stability`.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.

    Returns
    -------
    Campbell
        Frequencies, stability and crossings. Where there is no such shape, frequencies are NaN and `stable` is false.

    Raises
    ------
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.
    ValueError
        If `system` is a `Cord` or a `Held`; if a number is out of its range or the speeds do not ascend; if `steady_shapes`
        or `SteadyShape.stability` refuses the system; if there is no such shape at any of the speeds, or no small motion of
        it is known (in a fluid that turns).

    Notes
    -----
    Method: `steady_shapes` and `stability` at each speed. Where a frequency less a multiple of the speed changes its sign
    between two speeds, the zero is found by interpolation. Accuracy: that of the exponents, 1e-13 of the largest; crossings
    1e-12. Cost: 0.05 milliseconds for each speed with two links, 0.7 with twenty, and a few times as much for each crossing.
    Source: W. Campbell, The Protection of Steam-Turbine Disk Wheels from Axial Vibration, Trans. ASME 46 (1924).

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
    if has_units(angular_speed) and speed_unit(angular_speed) == "s" and (np.diff(speeds) < 0).all():  # ascending periods are descending speeds
        speeds = speeds[::-1]
    if speeds.ndim != 1 or speeds.size < 2 or (np.diff(speeds) <= 0).any():
        raise ValueError(f"{_CALLER}: angular_speed must be a list of at least two ascending speeds, got {shown(angular_speed)}")
    multiples = tuple(dict.fromkeys(integer(_CALLER, "orders", order) for order in listed(_CALLER, "orders", orders)))
    if not multiples or min(multiples) < 1:
        raise ValueError(f"{_CALLER}: orders must be whole positive numbers, at least one, got {shown(orders)}")
    waves, g = integer(_CALLER, "half_waves", half_waves), one_positive(_CALLER, "gravity", gravity)
    given = (system._under(g), speeds.tolist(), list(multiples), waves, is_driven(_CALLER, frame), g)
    try:
        frequency, stable, crossings = checked(_CALLER, system.by_mass, _core.campbell, *given)
    except ValueError as error:
        if "at none of the speeds" not in str(error):
            raise
        faster = f"on the axis it exists above critical speed {waves} of `modes`: give faster speeds"
        raise ValueError(f"{error}; {faster}") from None
    if not frequency.size:
        what = "no small motion of the shapes oscillates, or none is known, as in a fluid that turns"
        raise ValueError(f"{_CALLER}: {what}; use steady_shapes")
    return Campbell._made(
        None,
        system=system,
        gravity=g,
        frame=frame,
        orders=multiples,
        angular_speed=speeds,
        frequency=frequency,
        stable=np.array(stable),
        crossings=tuple([Crossing(*one) for one in crossings]),
    )
