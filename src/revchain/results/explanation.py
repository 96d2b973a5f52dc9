# SPDX-License-Identifier: GPL-3.0-or-later
"""Which model answers to a tolerance, and what it found."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..systems.numbers import Floats
from .base import Field, Result
from .sheet import Column, Sheet


class Solution(Result):
    """Heights that keep a tolerance, and the model that gave them; returned by `solve`."""

    __slots__ = ()
    conical_height: Field[Floats] = Field("Conical heights of the modes asked for, m, shape (k,), descending.", part=True)
    error_bound: Field[Floats] = Field(
        "Bound of the relative error of each, for the data exactly as stored, shape (k,).", part=True
    )
    conical_height_low: Field[Floats | None] = Field(
        "What a double cannot hold of the heights, where the model knows: `error_bound` is then that of the sum.", part=True
    )
    model: Field[str] = Field("One of those that `explain` lists; empty where no model has an answer.", part=True)
    status: Field[str] = Field(
        "``'success'``, or ``'tolerance_not_met'`` where no model keeps `rtol` (within the budget); the bounds are then the "
        "best there are.",
        part=True,
    )
    rtol: Field[float] = Field("Tolerance asked; 0: as accurate as there is.", part=True)
    first: Field[int] = Field("Number of the slowest mode, from 1.", part=True)
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", part=True)
    angular_speed: Field[Floats] = Field(
        "Whirl speed of each mode, rad/s, shape (k,).",
        lambda s: np.sqrt(s.gravity / s.conical_height),
    )

    def __len__(self) -> int:
        return int(self.conical_height.size)

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("mode", np.arange(self.first, self.first + len(self)), "mode"),
            Column("angular_speed", self.angular_speed, "speed (rad/s)", 12),
            Column("conical_height", self.conical_height, "height (m)", 12),
            Column("error_bound", self.error_bound, "error bound"),
        ]
        if self.conical_height_low is not None:
            columns.append(Column("conical_height_low", self.conical_height_low))
        by = f"by {self.model}" if self.model else "no model has an answer"
        heading = f"{len(self)} heights: {by}, {self.status.replace('_', ' ')}"
        names = ("model", "status", "rtol", "first", "gravity")
        facts = {name: getattr(self, name) for name in names}
        return Sheet("mode", heading, columns, facts, good=self.status == "success")


class ModelEstimate(NamedTuple):
    """What is known of a model before it is asked: a row of `Explanation`."""

    name: str
    applies: bool
    reason: str
    error_bound: float
    cost: float
    chosen: bool


class Explanation(Result):
    """Which model `modes` takes for a tolerance, and why; returned by `explain`.

    Examples
    --------
    >>> import revchain as rc
    >>> why = rc.explain(rc.Chain.uniform_rods(100_000), rtol=0.01)
    >>> why.chosen.name, f"{why.chosen.error_bound:.1e}"
    ('continuous chain', '8.9e-16')
    """

    __slots__ = ()
    estimates: Field[tuple[tuple[Any, ...], ...]] = Field("The rows as plain tuples.", part=True)
    meets_tolerance: Field[bool] = Field(
        "Whether the one chosen keeps `rtol`; if not, none does (within the budget), and it is the most accurate.", part=True
    )
    rtol: Field[float] = Field("Tolerance asked; 0: as accurate as there is.", part=True)

    @property
    def rows(self) -> tuple[ModelEstimate, ...]:
        """For each model its name, whether it applies and if not the reason, the bound of its relative error, the time it
        is expected to take in seconds, and whether it is the one chosen."""
        return tuple(ModelEstimate(*row) for row in self.estimates)

    @property
    def chosen(self) -> ModelEstimate | None:
        """The row of the model chosen; None where no model applies."""
        return next((row for row in self.rows if row.chosen), None)

    def _sheet(self, brief: bool = False) -> Sheet:
        rows = self.rows
        bounds = [row.error_bound if row.applies else None for row in rows]
        marked = [("-> " if row.chosen else "   ") + row.name for row in rows]
        costs = [row.cost if row.applies else None for row in rows]
        columns = [
            Column("name", [row.name for row in rows], "   model", left=True, shown=marked),
            Column("applies", [row.applies for row in rows]),
            Column("error_bound", bounds, "error bound", shown=["-" if x is None else f"{x:.1e}" for x in bounds]),
            Column("cost", costs, "expected time", shown=["-" if x is None else time_text(x) for x in costs]),
            Column("reason", [row.reason for row in rows], " ", left=True),
            Column("chosen", [row.chosen for row in rows]),
        ]
        asked = f"rtol {self.rtol:g}" if self.rtol else "full accuracy"
        heading = asked + ("" if self.meets_tolerance else ": no model keeps it")
        facts = {"rtol": self.rtol, "meets_tolerance": self.meets_tolerance}
        return Sheet("model", heading, columns, facts, good=self.meets_tolerance)


def time_text(seconds: float) -> str:
    """With the unit that suits it."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)):
        if seconds >= size or unit == "ns":
            return f"{seconds / size:.3g} {unit}"
    raise AssertionError
