# SPDX-License-Identifier: GPL-3.0-or-later
"""The method that `modes` tries first for a tolerance."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from .base import Field, Result


class MethodEstimate(NamedTuple):
    """Properties of a method before it is used: a row of `Explanation`."""

    name: str
    applies: bool
    reason: str
    error_bound: float
    cost: float
    chosen: bool


def _column(name: str) -> Callable[[Explanation], list[Any]]:
    return lambda e: [getattr(row, name) for row in e.rows]


def _shown(name: str, text: Callable[[float], str]) -> Callable[[Explanation], list[str]]:
    return lambda e: [text(getattr(row, name)) if row.applies else "-" for row in e.rows]


class Explanation(Result, row="method", title="{_heading}", good="meets_tolerance"):
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
    _names: Field[list[str]] = Field(
        "The names of the methods.",
        _column("name"),
        column="name",
        heading="   method",
        left=True,
        shown=lambda e: [("-> " if row.chosen else "   ") + row.name for row in e.rows],
    )
    _applies: Field[list[bool]] = Field("Whether each method applies.", _column("applies"), axes=(), column="applies")
    _bounds: Field[list[float]] = Field(
        "The bound of the relative error of each method.",
        lambda e: [row.error_bound if row.applies else None for row in e.rows],
        column="error_bound",
        heading="error bound",
        shown=_shown("error_bound", "{:.1e}".format),
    )
    _costs: Field[list[float]] = Field(
        "The expected time of each method.",
        lambda e: [row.cost if row.applies else None for row in e.rows],
        column="cost",
        heading="expected time",
        shown=_shown("cost", lambda seconds: time_text(seconds)),
    )
    _reasons: Field[list[str]] = Field(
        "The reason why a method does not apply.", _column("reason"), column="reason", heading=" ", left=True
    )
    _chosen: Field[list[bool]] = Field("Whether each method is chosen.", _column("chosen"), axes=(), column="chosen")
    rtol: Field[float] = Field("Requested relative tolerance; 0 for the best possible.", fact=True)
    meets_tolerance: Field[bool] = Field(
        "Whether the chosen method is within `rtol`; if not, it is the most accurate one.", fact=True
    )

    @property
    def rows(self) -> tuple[MethodEstimate, ...]:
        """For each method its name, whether it applies, the reason if not, the bound of its relative error, the expected
        time in seconds, and whether it is chosen."""
        return tuple(MethodEstimate(*row) for row in self.estimates)

    @property
    def chosen(self) -> MethodEstimate | None:
        """The row of the chosen method; None if no method applies."""
        return next((row for row in self.rows if row.chosen), None)

    @property
    def _heading(self) -> str:
        wanted = f"rtol {self.rtol:g}" if self.rtol else "full accuracy"
        return wanted + ("" if self.meets_tolerance else ": no method keeps it")


def time_text(seconds: float) -> str:
    """Return a time in seconds as text with a suitable unit."""
    for unit, size in (("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)):
        if seconds >= size or unit == "ns":
            return f"{seconds / size:.3g} {unit}"
    raise AssertionError
