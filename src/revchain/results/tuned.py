# SPDX-License-Identifier: GPL-3.0-or-later
"""What `revchain.tune` returns."""

from __future__ import annotations

from typing import Any

from ..systems.numbers import Floats
from .base import Field, Result
from .sheet import Column, Sheet

Pair = tuple[float, float]


class Tuned(Result):
    """Which value of a datum gives a mode the speed wanted; returned by `tune`.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[1.0, 3.0], length=1.0)
    >>> rc.tune(chain, vary="links[0].weight", conical_height=1.7)
    Tuned: links[0].weight = 2.88235
      value
    2.88235
    >>> rc.tune(chain, vary="links[0].weight", conical_height=2.5).status
    'no_value'
    """

    __slots__ = ()
    status: Field[str] = Field(
        "``'found'``; ``'no_value'`` where none does in the range; ``'undecided'`` where none was found and that there is "
        "none could not be shown.",
        part=True,
    )
    vary: Field[str] = Field("What was changed, as in the question.", part=True)
    system: Field[Any] = Field("The system with `value` in place; None where none was found.", part=True)
    value: Field[float | None] = Field(
        "The one nearest to the present value (for weights, in ratio, and but for others within a few per cent of it); "
        "None where none was found.",
        part=True,
    )
    error_bound: Field[float | None] = Field(
        "Absolute, proved: `value` is that near to one that does exactly (of cords, whose own bounds are measured to hold, "
        "so is this). None where none was found, and of a rig's stiffness, momentum and spin, which are formed to 1e-15: "
        "the bound of the new rig's speed is proved.",
        part=True,
    )
    values: Field[Floats] = Field("All that were found in the range, ascending.", part=True)
    complete: Field[bool] = Field(
        "Whether `values` are all there are in the range. For a weight of a chain, what is known is the nearest on either "
        "side of the present value; of what is searched for, those between neighbours of 65 values.",
        part=True,
    )
    present: Field[float] = Field("The datum as it is.", part=True)
    between: Field[Pair] = Field("The range searched.", part=True)
    reachable: Field[Pair | None] = Field(
        "Where none was found: the least and the largest conical height seen in the range, at 33 or 65 places; None of "
        "what has one value for each speed.", part=True
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        names = ("status", "vary", "value", "error_bound", "complete", "present", "between", "reachable")
        found = f"= {self.value:.6g}" if self.value is not None else self.status.replace("_", " ")
        heading = f"Tuned: {self.vary} {found}{', all found' if self.complete else ''}"
        columns = [Column("value", self.values, "value")]
        return Sheet("value", heading, columns, {name: getattr(self, name) for name in names}, good=self.status == "found")
