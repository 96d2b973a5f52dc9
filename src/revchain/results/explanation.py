# SPDX-License-Identifier: GPL-3.0-or-later
"""The method that `modes` tries first for a tolerance."""

from __future__ import annotations

from typing import Any, NamedTuple

from .base import Field, Result
from .sheet import Column, Sheet


class MethodEstimate(NamedTuple):
    """Properties of a method before it is used: a row of `Explanation`."""

    name: str
    applies: bool
    reason: str
    error_bound: float
    cost: float
    chosen: bool


class Explanation(Result):
    """The method that `modes` tries first for a tolerance, with the alternatives; returned by `explain`.

    Examples
    --------
    >>> import revchain as rc
    >>> why = rc.explain(rc.Chain.uniform_rods(100_000), 1, rtol=0.01)
    >>> why.chosen.name, f"{why.chosen.error_bound:.1e}"
    ('continuous chain', '8.9e-16')
    """

    __slots__ = ()
    estimates: Field[tuple[tuple[Any, ...], ...]] = Field("The rows as plain tuples.")
    meets_tolerance: Field[bool] = Field(
        "Whether the chosen method is within `rtol`; if not, no method is, and it is the most accurate one."
    )
    rtol: Field[float] = Field("Requested relative tolerance; 0 for the best possible.")

    @property
    def rows(self) -> tuple[MethodEstimate, ...]:
        """For each method its name, whether it applies (if not, the reason), the bound of its relative error, the expected
        time in seconds, and whether it is chosen."""
        return tuple(MethodEstimate(*row) for row in self.estimates)

    @property
    def chosen(self) -> MethodEstimate | None:
        """The row of the chosen method; None if no method applies."""
        return next((row for row in self.rows if row.chosen), None)

    def _sheet(self, brief: bool = False) -> Sheet:
        rows = self.rows
        bounds = [row.error_bound if row.applies else None for row in rows]
        marked = [("-> " if row.chosen else "   ") + row.name for row in rows]
        costs = [row.cost if row.applies else None for row in rows]
        columns = [
            Column("name", [row.name for row in rows], "   method", left=True, shown=marked),
            Column("applies", [row.applies for row in rows]),
            Column("error_bound", bounds, "error bound", shown=["-" if x is None else f"{x:.1e}" for x in bounds]),
            Column("cost", costs, "expected time", shown=["-" if x is None else time_text(x) for x in costs]),
            Column("reason", [row.reason for row in rows], " ", left=True),
            Column("chosen", [row.chosen for row in rows]),
        ]
        asked = f"rtol {self.rtol:g}" if self.rtol else "full accuracy"
        heading = asked + ("" if self.meets_tolerance else ": no method keeps it")
        facts = {"rtol": self.rtol, "meets_tolerance": self.meets_tolerance}
        return Sheet("method", heading, columns, facts, good=self.meets_tolerance)


def time_text(seconds: float) -> str:
    """A time as text with a suitable unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)):
        if seconds >= size or unit == "ns":
            return f"{seconds / size:.3g} {unit}"
    raise AssertionError
