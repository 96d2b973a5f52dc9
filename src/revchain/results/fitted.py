# SPDX-License-Identifier: GPL-3.0-or-later
"""`Fitted`: the result of `revchain.fit`."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..systems.numbers import Floats, Whole, shown
from .base import Field, Result
from .sheet import in_unit

_MOST_LINES = 8
_ALIKE = 1e-6  # relative difference of standardized residuals that are equal


class Fitted(Result, row="datum", title="Fitted: {summary}", notes=("{_lines}",), good="status"):
    """Values of p data that best fit m measured speeds, with uncertainties; returned by `fit`.

    Examples
    --------
    >>> import revchain as rc
    >>> crane = rc.Chain(mass=[2500, 400], length=[6, 24])
    >>> found = rc.fit(crane, {1: ("10.87 s", "0.02 s"), 2: ("1.60 s", "0.01 s")}, vary=["length", "links[0].mass"])
    >>> found
    Fitted: 2 data to 2 speeds, success; chi-square 0 with 0 degrees of freedom
    datum            value  standard uncertainty   before  unit
    length         29.9867              0.108299  30.0000  m
    links[0].mass  2683.31               38.4727  2500.00  kg
    mode 1: measured 10.8700 s, computed 10.8700, residual +0.0 standard uncertainties
    mode 2: measured 1.60000 s, computed 1.60000, residual +0.0 standard uncertainties
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
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2; the fitted value if it varied.", fact=True)
    value: Field[Floats] = Field(
        "Values of the data, shape (p,); ``fitted[path]`` is one of them.",
        heading="value",
    )
    standard_uncertainty: Field[Floats] = Field(
        "Standard uncertainty of each value, shape (p,): the root of its variance.",
        lambda f: np.sqrt(f.covariance.diagonal()),
        heading="standard uncertainty",
    )
    present: Field[Floats] = Field("Values of the data before the fit, shape (p,).", heading="before")
    unit: Field[tuple[str, ...]] = Field(
        "Unit of each value; empty for the unit of the weights.", heading="unit", left=True
    )
    covariance: Field[Floats] = Field(
        "Covariance of the values, shape (p, p), to first order; NaN where it is not determined.",
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
        "speeds, estimated from the residuals; NaN if these are too few.",
        fact=True,
    )
    computed: Field[Floats] = Field("Speeds of the modes of the new system, rad/s, shape (m,).", fact=True)
    residual: Field[Floats] = Field(
        "Measured speeds minus computed ones, rad/s, shape (m,).", lambda f: f.measured - f.computed,
        fact=True,
    )
    normalized_residual: Field[Floats] = Field(
        "Residual divided by the uncertainty of the measurement, shape (m,). Where a period was measured it is that of the "
        "period, with the sign of the speed's residual.",
        fact=True,
    )
    leverage: Field[Floats] = Field(
        "Leverage of each measurement, shape (m,), from 0 to 1: the diagonal of the hat matrix. With leverage 1 a "
        "measurement alone decides a combination of the data, and cannot disagree.",
        fact=True,
    )
    standardized_residual: Field[Floats] = Field(
        "Residual of each measurement divided by its own standard deviation, shape (m,): that of the measurement times "
        "``sqrt(1 - leverage)``. If no uncertainties were given, that deviation is estimated from the other measurements "
        "(externally studentized). NaN where it is not determined.",
        fact=True,
    )
    disagreement_limit: Field[float] = Field(
        "Size that the largest standardized residual exceeds by chance in at most one fit of a hundred, if model and "
        "uncertainties are correct: 2.8 for two measurements, 3.3 for ten; more if uncertainties are estimated.",
        fact=True,
    )
    disagreeing: Field[tuple[int, ...]] = Field(
        "Number of the mode whose measured speed disagrees with the others: its standardized residual is the largest and "
        "exceeds `disagreement_limit`. Several if the measurements cannot tell which one; empty if none does.",
        lambda f: f._most_unlike(),
        fact=True,
    )
    chi_square: Field[float | None] = Field(
        "Sum of squares of the normalized residuals; about `degrees_of_freedom` if model and uncertainties are correct. "
        "None without given uncertainties.",
        fact=True,
    )
    degrees_of_freedom: Field[int] = Field(
        "Number of measurements minus number of data, m - p, plus the number of undetermined combinations of data.",
        fact=True,
    )
    undetermined: Field[tuple[tuple[str, ...], ...]] = Field(
        "Groups of paths that the measurements do not determine.",
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
                more = "" if self._all_are_measured or "gravity" in group else ", or measure more"
                lines.append(f"the speeds measured cannot tell {both} apart: leave one of them out{more}")
        free = self.degrees_of_freedom
        if not free and not self.undetermined and np.isnan(self.standard_uncertainty).any():
            lines.append(
                "no standard uncertainties: there are as many data as speeds, and the measurements have no uncertainties; "
                "give them, or measure more"
            )
        if self.chi_square is not None and free and self.chi_square > free + 5 * (2 * free) ** 0.5:  # five standard deviations
            why = "a measurement is wrong, the uncertainties are too small, or other data differ from the system"
            lines.append(f"chi-square is far above its degrees of freedom: {why}")
        lines += self._disagreement()
        unit = self._speed_unit or "rad/s"
        for k, (number, measured, computed) in enumerate(zip(self.number, self.measured, self.computed, strict=True)):
            if k == _MOST_LINES:
                lines.append(f"and {len(self.number) - k} more measured speeds")
                break
            one, other = (in_unit(abs(speed) if unit == "s" else speed, unit) for speed in (measured, computed))
            line = f"mode {number}: measured {one:#.6g} {unit}, computed {other:#.6g}"
            off = round(float(self.normalized_residual[k]) * (-1 if unit == "s" else 1), 1) + 0.0  # of what is printed
            lines.append(f"{line}, residual {off:+.1f} standard uncertainties" if np.isfinite(off) else line)
        return "\n".join(lines)

    def _most_unlike(self) -> tuple[int, ...]:
        """The modes with the largest standardized residual, if it exceeds the limit."""
        size = np.nan_to_num(np.abs(self.standardized_residual), nan=0.0, posinf=np.inf)
        most = float(size.max(initial=0.0))
        return tuple(self.number[size > most * (1 - _ALIKE)].tolist()) if most > self.disagreement_limit else ()

    def _disagreement(self) -> list[str]:
        """A line on the measurement that disagrees, if there is one."""
        if not self.disagreeing:
            return ["the measurements agree with one another"] if np.isfinite(self.disagreement_limit) else []
        k = self.number.tolist().index(self.disagreeing[0])
        size, lever = abs(self.standardized_residual[k]), self.leverage[k]
        off = f"{size:.1f} standard deviations" if size < 1e3 else "over 1000 standard deviations"
        if len(self.disagreeing) == 1:
            return [f"mode {self.disagreeing[0]} disagrees with the others: {off} (leverage {lever:.2f}); measure it again"]
        modes = ", ".join(map(str, self.disagreeing[:-1])) + f" and {self.disagreeing[-1]}"
        more = "measure them again" if self._all_are_measured else "measure more modes to tell which of them is wrong"
        return [f"modes {modes} disagree: {off}; {more}"]

    @property
    def _all_are_measured(self) -> bool:
        """Whether the system has no other modes than those measured."""
        return self.system.mode_count is not None and len(self.number) >= self.system.mode_count

    def _words(self) -> str:
        free = f"{self.degrees_of_freedom} degree{'s' * (self.degrees_of_freedom != 1)} of freedom"
        chi = "" if self.chi_square is None else f"; chi-square {round(self.chi_square, 9):.3g} with {free}"
        p, m = len(self.vary), len(self.number)
        what = f"{p} {'datum' if p == 1 else 'data'} to {m} speed{'s' * (m > 1)}"
        return f"{what}, {self.status.replace('_', ' ')}{chi}"


def _over(one: Floats, other: Floats) -> Floats:
    """The quotient; NaN for 0 divided by 0."""
    with np.errstate(divide="ignore", invalid="ignore"):
        return one / other
