# SPDX-License-Identifier: GPL-3.0-or-later
"""`Campbell`: the result of `revchain.campbell`."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import NDArray

from ..systems.numbers import Floats
from .base import Field, Result
from .sheet import Sheet, in_unit


class Crossing(NamedTuple):
    """The crossing of a frequency with a multiple of the speed.

    `order`: the multiple. `motion`: number of the frequency, from 1 for the lowest. `angular_speed`: rad/s.
    """

    order: int
    motion: int
    angular_speed: float

    @property
    def rpm(self) -> float:
        """The speed in revolutions per minute."""
        return self.angular_speed * 30 / np.pi


class Campbell(Result, row="speed", title="{summary}", notes=("{_remarks}",), spread=True):
    """Frequencies of small motion about a steady shape against the speed (a Campbell diagram); returned by `campbell`.

    Examples
    --------
    >>> import numpy as np
    >>> import revchain as rc
    >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=3.0))
    >>> found = rc.campbell(carousel, np.linspace(0.3, 1.5, 25))
    >>> [(one.order, one.motion, round(one.rpm, 3)) for one in found.crossings]
    [(1, 1, 7.705), (2, 1, 5.001), (2, 2, 12.823)]
    """

    __slots__ = ()
    system: Field[Any] = Field("The system.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    frame: Field[str] = Field('``"free"`` or ``"driven"``, as given.', fact=True)
    orders: Field[tuple[int, ...]] = Field("Multiples of the speed whose crossings are listed.", fact=True)
    angular_speed: Field[Floats] = Field("Speeds, rad/s, shape (S,).", heading="speed", unit="rad/s", digits=5)
    rpm: Field[Floats] = Field(
        "Revolutions per minute, shape (S,).", lambda c: c.angular_speed * (30 / np.pi), heading="speed (rpm)", digits=5, axes=()
    )
    frequency: Field[Floats] = Field(
        "Angular frequencies of the small motions in the turning frame, rad/s, shape (S, J), ascending; NaN where a motion "
        "does not oscillate or there is no shape.",
        axes=("motion",),
        unit="rad/s",
    )
    lowest: Field[Floats] = Field(
        "The lowest frequency, rad/s, shape (S,).", lambda c: c.frequency[:, 0], heading="lowest frequency", unit="rad/s", axes=()
    )
    over_speed: Field[Floats] = Field(
        "The lowest frequency over the speed, shape (S,): 1 in resonance with what is constant in space.",
        lambda c: c.frequency[:, 0] / c.angular_speed,
        heading="over speed",
        digits=5,
        axes=(),
    )
    stable: Field[NDArray[np.bool_]] = Field(
        "Whether no motion grows, as far as the exponents tell, shape (S,).", heading="stable", axes=()
    )
    crossings: Field[tuple[Crossing, ...]] = Field(
        "Crossings of the frequencies with the multiples of the speed, by order and speed. Two between neighbouring speeds "
        "can be missed.",
    )
    summary: Field[str] = Field("What was found, in words.", lambda c: c._words())

    @classmethod
    def _made(cls, core: Any = None, **parts: Any) -> Self:
        parts["crossings"] = tuple(Crossing(*one) for one in parts["crossings"])  # a file has them as plain tuples
        return super()._made(core, **parts)

    def _sheet(self, brief: bool = False) -> Sheet:
        sheet = super()._sheet(brief)
        crossings = [{**one._asdict(), "rpm": one.rpm} for one in self.crossings]
        return sheet if brief else replace(sheet, facts={**sheet.facts, "crossings": crossings})

    def _words(self) -> str:
        unit = self._speed_unit or "rpm"
        ends = [in_unit(at, unit) for at in self.angular_speed[[0, -1]]]
        many = self.frequency.shape[1]
        return f"Campbell diagram: {many} frequenc{'y' if many == 1 else 'ies'} from {ends[0]:.4g} to {ends[1]:.4g} {unit}"

    @property
    def _remarks(self) -> str:
        unit = self._speed_unit or "rpm"
        lines = [
            f"{one.order}n meets frequency {one.motion} at {in_unit(one.angular_speed, unit):.5g} {unit}" for one in self.crossings
        ]
        if missing := int(np.isnan(self.frequency).all(axis=1).sum()):
            lines.append(f"nan: at {missing} of {self.angular_speed.size} speeds no shape was found, or none of its motions oscillates")
        return "\n".join([*lines, "frequencies: of small motion in the turning frame, where what is constant in space turns once (1n)"])
