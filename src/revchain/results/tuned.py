# SPDX-License-Identifier: GPL-3.0-or-later
"""`Tuned`: the result of `revchain.tune`."""

from __future__ import annotations

from typing import Any

from ..systems.numbers import Floats
from .base import Field, Result

Pair = tuple[float, float]


class Tuned(Result, row="value", title="Tuned: {summary}", good="status"):
    """The value of a datum for which a mode has a given speed; returned by `tune`.

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
        "``'found'``; ``'no_value'`` if no value in the range can give the speed; ``'undecided'`` if none was found.",
        fact=True,
    )
    vary: Field[str] = Field("Path of the datum, as given.", fact=True)
    system: Field[Any] = Field("The system with the new `value`; None if none was found.")
    value: Field[float | None] = Field(
        "The one of `values` nearest to the present value, mostly by ratio; None if there is none.", fact=True,
    )
    error_bound: Field[float | None] = Field(
        "Proved bound of the absolute error of `value`; an estimate for cords and with `top_tension`. None if no value was "
        "found, and for stiffness, momentum and spin of a rig, which are computed to 1e-15.", fact=True,
    )
    values: Field[Floats] = Field("All values found in the range, ascending.", heading="value", column="value")
    complete: Field[bool] = Field(
        "Whether `values` is known to have all values in the range.", fact=True,
    )
    present: Field[float] = Field("Present value of the datum.", fact=True)
    between: Field[Pair] = Field("Range of the search.", fact=True)
    reachable: Field[Pair | None] = Field(
        "The smallest and the largest conical height seen in a range without a value, or None.", fact=True,
    )
    summary: Field[str] = Field("The result in words.", lambda t: t._words())

    def _words(self) -> str:
        if self.status == "no_value":
            return f"no value of {self.vary} in the range gives the speed"
        found = f"= {self.value:.6g}" if self.value is not None else self.status.replace("_", " ")
        return f"{self.vary} {found}{', all found' if self.complete else ''}"
