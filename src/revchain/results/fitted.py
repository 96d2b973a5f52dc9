# SPDX-License-Identifier: GPL-3.0-or-later
"""`Fitted`: the result of `revchain.fit`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..systems.numbers import Floats, Whole, shown
from .base import Field, Result

_MOST_LINES = 8


class Fitted(Result, row="datum", title="Fitted: {summary}", notes=("{_lines}",), good="status"):
    """Values of p data that best fit m measured speeds, with uncertainties; returned by `fit`.

    Examples
    --------
    >>> import revchain as rc
    >>> crane = rc.Chain(mass=[2500, 400], length=[6, 24])
    >>> found = rc.fit(crane, {1: ("10.87 s", "0.02 s"), 2: ("1.60 s", "0.01 s")}, vary=["length", "links[0].mass"])
    >>> found
    Fitted: 2 data to 2 speeds, success; chi-square 0 with 0 degrees of freedom
    datum            value  standard uncertainty   before
    length         29.9867              0.108299  30.0000
    links[0].mass  2683.31               38.4727  2500.00
    mode 1: measured 0.578030 rad/s, computed 0.578030, residual +0.0 standard uncertainties
    mode 2: measured 3.92699 rad/s, computed 3.92699, residual +0.0 standard uncertainties
    >>> round(found["length"], 4)
    29.9867
    >>> found.system.total_length == found["length"]
    True
    """

    __slots__ = ()
    status: Field[str] = Field(
        "``'success'``; ``'undetermined'`` if the measurements do not determine some data, see `undetermined`; "
        "``'not_converged'`` if the search stopped before the minimum of the sum of squares.",
        fact=True,
    )
    vary: Field[tuple[str, ...]] = Field("Paths of the data, as given.", heading="datum", column="datum", left=True)
    system: Field[Any] = Field("The system with the new values.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    value: Field[Floats] = Field(
        "Values of the data, shape (p,); ``fitted[path]`` is one of them. Many other values of the data in `undetermined` fit "
        "equally well.",
        heading="value",
    )
    standard_uncertainty: Field[Floats] = Field(
        "Standard uncertainty of each value, shape (p,): the root of its variance. NaN if the covariance is NaN.",
        lambda f: np.sqrt(f.covariance.diagonal()),
        heading="standard uncertainty",
    )
    present: Field[Floats] = Field("Values of the data before the fit, shape (p,).", heading="before")
    covariance: Field[Floats] = Field(
        "Covariance of the values, shape (p, p), to first order. NaN for data in `undetermined`; NaN for all data if no "
        "uncertainties were given and there are no more measurements than data to estimate them.",
        axes=("other_datum",),
    )
    correlation: Field[Floats] = Field(
        "Covariance divided by both standard uncertainties, shape (p, p).",
        lambda f: _over(f.covariance, np.outer(f.standard_uncertainty, f.standard_uncertainty)),
        axes=("other_datum",),
    )
    number: Field[Whole] = Field("Numbers of the measured modes, shape (m,); negative for backward modes of a rig.", fact=True)
    measured: Field[Floats] = Field("Measured speeds, rad/s, shape (m,); negative for backward modes.", fact=True)
    measured_uncertainty: Field[Floats] = Field(
        "Standard uncertainties of the measured speeds, rad/s, shape (m,): as given, else one relative uncertainty for all "
        "speeds, estimated from the residuals; NaN if there are no more measurements than data.",
        fact=True,
    )
    computed: Field[Floats] = Field("Speeds of the modes of the new system, rad/s, shape (m,).", fact=True)
    residual: Field[Floats] = Field(
        "Measured speeds minus computed ones, rad/s, shape (m,).", lambda f: f.measured - f.computed,
        fact=True,
    )
    normalized_residual: Field[Floats] = Field(
        "Residuals divided by the uncertainties of the measured speeds, shape (m,).",
        lambda f: _over(f.residual, f.measured_uncertainty),
        fact=True,
    )
    chi_square: Field[float | None] = Field(
        "Sum of squares of the normalized residuals; about `degrees_of_freedom` if model and uncertainties are correct. "
        "None if no uncertainties were given.",
        fact=True,
    )
    degrees_of_freedom: Field[int] = Field(
        "Number of measurements minus number of data, m - p, plus the number of undetermined combinations of data.",
        fact=True,
    )
    undetermined: Field[tuple[tuple[str, ...], ...]] = Field(
        "Groups of paths that the measurements do not determine. A single path has no effect on the measured speeds; the "
        "effects of several paths cancel.",
        fact=True,
    )

    description: Field[str] = Field("The new system in words.", lambda f: f.system.describe(), fact=True)
    summary: Field[str] = Field("How many data were fitted to how many speeds, in words.", lambda f: f._words())

    def __getitem__(self, path: str) -> float:
        """Return the fitted value of the datum with this path."""
        if path not in self.vary:
            raise KeyError(f"path must be one of {', '.join(self.vary)}, got {shown(path)}")
        return float(self.value[self.vary.index(path)])

    @property
    def _lines(self) -> str:
        """The lines below the table: undetermined data, and each measurement."""
        lines = []
        for group in self.undetermined:
            if len(group) == 1:
                lines.append(f"{group[0]} has no effect on the speeds measured: leave it out, or measure another mode")
            else:
                both = " and ".join(group)
                lines.append(f"the speeds measured cannot tell {both} apart: leave one of them out, or measure more")
        free = self.degrees_of_freedom
        if self.chi_square is not None and free and self.chi_square > free + 5 * (2 * free) ** 0.5:  # five standard deviations
            why = "start nearer, vary other data, or doubt the uncertainties"
            lines.append(f"chi-square is far above its degrees of freedom: {why}")
        for k, (number, measured, computed) in enumerate(zip(self.number, self.measured, self.computed, strict=True)):
            if k == _MOST_LINES:
                lines.append(f"and {len(self.number) - k} more measured speeds")
                break
            line = f"mode {number}: measured {measured:#.6g} rad/s, computed {computed:#.6g}"
            off = round(float(self.normalized_residual[k]), 1) + 0.0
            lines.append(f"{line}, residual {off:+.1f} standard uncertainties" if np.isfinite(off) else line)
        return "\n".join(lines)

    def _words(self) -> str:
        free = f"{self.degrees_of_freedom} degree{'s' * (self.degrees_of_freedom != 1)} of freedom"
        chi = "" if self.chi_square is None else f"; chi-square {round(self.chi_square, 9):.3g} with {free}"
        p, m = len(self.vary), len(self.number)
        what = f"{p} {'datum' if p == 1 else 'data'} to {m} speed{'s' * (m > 1)}"
        return f"{what}, {self.status.replace('_', ' ')}{chi}"


def _over(one: Floats, other: Floats) -> Floats:
    """The quotient; NaN for 0 divided by 0, as in a fit without residuals."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return one / other
