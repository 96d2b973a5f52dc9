# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers for a cord that need other methods than for a chain."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.cord_motions import CORD_SWING, CordSwing
from ..systems.cord import Cord
from ..systems.numbers import Floats, floats, real, refuse_where, shown

Start = ArrayLike | Callable[[float], float]


def cord_swing(
    place: str,
    system: Cord,
    offset: Start | None,
    velocity: Start | None,
    times: Floats,
    arc_length: ArrayLike | None,
    count: int,
    gravity: float,
) -> CordSwing:
    """See `swing`."""
    starts = {"offset": _start(place, "offset", offset), "velocity": _start(place, "velocity", velocity)}
    if arc_length is not None:
        arc = np.array(floats(place, "arc_length", arc_length))
        if arc.ndim != 1 or not arc.size:
            raise ValueError(f"{place}: arc_length must have one axis, got {shown(arc_length)}")
        inside = (arc >= 0) & (arc <= system.length)
        refuse_where(~inside, arc, f"{place}: arc_length must lie between 0 and the length {system.length:g}")
    else:
        given = [start.size for start in starts.values() if isinstance(start, np.ndarray)]
        arc = np.linspace(0.0, system.length, given[0] if given else 101)
    for name, start in starts.items():
        if isinstance(start, np.ndarray) and start.size != arc.size:
            raise ValueError(
                f"{place}: {name} must have a number for each of the {arc.size} places of arc_length, got {start.size}"
            )
    core = (system._compiled, starts["offset"], starts["velocity"], times, arc, count, gravity)
    found: dict[str, Any] = dict(zip(CORD_SWING, _core.cord_swing(*core), strict=True))
    if system.by_mass:
        found |= {name: gravity * found[name] for name in ("energy", "energy_left_out")}
    return CordSwing._made(None, system=system, gravity=gravity, time=np.array(times), arc_length=arc, **found)


def _start(place: str, name: str, given: Start | None) -> Floats | Callable[[float], float] | None:
    """A start given as a function, checked at every call, or as an array of at least two numbers."""
    if given is None:
        return None
    if callable(given):
        function = given
        return lambda s: real(place, f"{name}({s:g})", function(s))
    array = floats(place, name, given)
    if array.ndim != 1 or array.size < 2:
        raise ValueError(
            f"{place}: {name} must be a function of the distance from the free end, or numbers from the free end to the "
            f"support, got {shown(given)}"
        )
    refuse_where(~np.isfinite(array), array, f"{place}: {name} must be finite")
    return array
