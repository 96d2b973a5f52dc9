# SPDX-License-Identifier: GPL-3.0-or-later
"""Whirl speeds of modes by their numbers, for `tune` and `fit`; those of backward modes are negative."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..results.modes import Modes
from ..systems.numbers import Floats, Whole
from .modes import modes


class Speeds(NamedTuple):
    """The speeds of some modes as found, with their numbers and derivatives."""

    speed: Floats  # rad/s, signed
    bound: Floats  # of their relative errors
    rows: Whole  # of `modes`
    modes: Modes


def speeds(caller: str, system: Any, numbers: Whole, gravity: float) -> Speeds:
    """The speeds of modes by number, with -k for the k-th backward mode; a ValueError if there is no such mode."""
    size = np.abs(numbers)
    first, last = int(size.min()), int(size.max())
    most = system.mode_count
    if most is not None and last > most:
        raise ValueError(f"{caller}: mode must be from 1 to {most}, the number of modes, got {last}")
    try:
        found: Any = modes(system, last - first + 1, first=first, gravity=gravity)
    except ValueError as error:
        raise ValueError(f"{caller}: {str(error).partition(': ')[2].replace('first must', 'mode must')}") from None
    turned = found.has_momentum
    known, wanted = (found.number * found.direction, numbers) if turned else (found.number, size)
    there = known == wanted[:, None]
    if not there.any(axis=1).all():
        forward, backward = found.available
        missing = wanted[~there.any(axis=1)][0]
        raise ValueError(f"{caller}: there is no mode {missing}: the rig has {forward} forward and {backward} backward")
    rows = there.argmax(axis=1)
    speed = found.angular_speed[rows].astype(np.float64)
    return Speeds(speed if turned else np.sign(numbers) * speed, found.speed_error_bound[rows], rows, found)

