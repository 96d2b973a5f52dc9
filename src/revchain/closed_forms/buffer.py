# SPDX-License-Identifier: GPL-3.0-or-later
"""Two coupled railway carriages that run against a buffer stop: the double blow."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.sheet import Column, Sheet
from .solved import Solved
from .table import FloatOrArray, described

__all__ = ["Blow", "BufferImpact", "CarriageState"]


class Blow(NamedTuple):
    """One contact with the buffer: start, end, and the momentum that the buffer absorbs."""

    start: float
    end: float
    impulse: float


class CarriageState(NamedTuple):
    """Displacements of both carriages towards the buffer since time 0, their speeds, the buffer force (0 if apart)."""

    front: FloatOrArray
    rear: FloatOrArray
    front_speed: FloatOrArray
    rear_speed: FloatOrArray
    buffer_force: FloatOrArray


@described(source="section 2, text after (7)")
class BufferImpact(Solved):
    """The motion of two carriages that run against a buffer stop.

    In contact, the carriages oscillate as a double pendulum of two point masses does. The buffer pushes and never
    pulls. Units: any consistent set.

    speed: Speed of both carriages towards the buffer at time 0, when the front one touches it
    raises: If a number is not positive and finite, or there are more than 100,000 blows.
    notes: Accuracy, measured against integration, if no blow only grazes the buffer: positions to 1e-13 of speed times
        time, speeds to 1e-13 of the speed and of acceleration times time, times to 1e-13 of the last time. Cost: 2
        microseconds for each blow, 0.1 for a state. Carriages of about equal mass give one to three blows; a heavy one
        behind a light one gives hundreds.

    >>> rc.BufferImpact(front_mass=1, rear_mass=1, buffer_stiffness=4, coupling_stiffness=0.5, speed=1)
    BufferImpact: 2 blows
    blow    start      end  impulse
       0  0.00000  1.69374  2.13365
       1  3.23975  4.85806  1.83769
    """

    __slots__ = ()
    _solver = _core.BufferImpact

    def __init__(
        self, *, front_mass: float, rear_mass: float, buffer_stiffness: float, coupling_stiffness: float, speed: float
    ) -> None:
        self._solve(locals())

    @property
    def blows(self) -> list[Blow]:
        """Start, end and impulse of each contact with the buffer."""
        return [Blow(*row) for row in self._found().blows.tolist()]

    @described()
    def state(self, time: ArrayLike) -> CarriageState:
        """Return the positions and speeds of the carriages, and the force of the buffer.

        time: Times, finite and not negative, any shape

        >>> impact = rc.BufferImpact(front_mass=1, rear_mass=1, buffer_stiffness=4, coupling_stiffness=0.5, speed=1)
        >>> round(float(impact.state(1.0).buffer_force), 6)
        1.87221
        """
        return CarriageState(*self._at("state", "time", time))

    def _sheet(self, brief: bool = False) -> Sheet:
        blows = self._found().blows
        columns = [Column("blow", np.arange(len(blows)), "blow")]
        columns += [Column(name, blows[:, k], name) for k, name in enumerate(Blow._fields)]
        heading = f"BufferImpact: {len(blows)} blow{'s' * (len(blows) != 1)}"
        return Sheet("blow", heading, columns, self._facts())
