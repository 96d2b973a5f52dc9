# SPDX-License-Identifier: GPL-3.0-or-later
"""Least-squares fit of several data of a system to measured speeds."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from contextlib import suppress
from typing import Any

import numpy as np

from ..results.base import asked_in
from ..results.fitted import Fitted

from ..results.sensitivity import rig_derivatives
from ..systems.chain import Chain
from ..systems.cord import Cord
from ..systems.datum import Datum, datum_at, gravity_datum, refuse_overlap
from ..systems.extras import require
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, Floats, Whole, integer, one_positive, real, shown
from ..systems.rig import Rig
from ..systems.system import System
from ..systems.units import SI, has_units, in_si, speed_unit, unpacked, with_tolerance
from .modes import straight
from .refuse import no_system
from .speeds import Speeds, speeds

_CALLER = "revchain.fit"
_FORM = '{1: (3.21, 0.02)}, {1: "0.5 Hz"} or {1: ["10.9 s", "1 %"]}'
_SINGULAR = 1e-8  # of the largest singular value: a smaller one belongs to a combination that is undetermined
_EFFECT = 1e-9  # smallest relative effect on a speed of a relative change of 1 of a datum
_EXTREME = 1e100  # an uncertainty over its value, or less than 1 / it, whose square would overflow
_PART = 1e-6  # smallest part of a datum in a combination
_FIXED = 1e-9  # 1 less the leverage of a measurement that alone decides a combination of the data
_ROUNDED = 1e-10  # relative residuals that are errors of rounding
_CHANCE = 0.01  # how often a fit with a correct model says that a measurement disagrees


def fit(
    system: Chain | Rig | Cord | Held,
    measured: Mapping[int, Any],
    *,
    vary: str | Iterable[str] | Mapping[str, float],
    gravity: float = STANDARD_GRAVITY,
) -> Fitted:
    """Return the values of several data that best fit measured speeds, by least squares.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system with its assumed data, at which the search starts.
    measured : dict
        Measured speed of each mode by its number, from 1 for the slowest; for a rig with flywheels -1 is the slowest
        backward mode. A speed is a number in rad/s, or text such as ``"0.5 Hz"``, ``"30 rpm"`` or a period ``"10.9 s"``. A
        pair is a speed and its standard uncertainty, in the same unit or relative such as ``"1 %"``, also as one text
        ``"10.9 s +- 0.1 s"``: ``{1: ("10.9 s", "0.1 s"), 2: (3.8, 0.05)}``. Give uncertainties for all speeds or for none.
        Without them all speeds have equal relative weight, and their uncertainty is estimated from the residuals. Where a
        period is given, the residual is that of the period.
    vary : str, list of str or dict
        Paths of the data that may change, as in `tune`, such as ``"links[load].mass"`` or ``"gravity"``. A dictionary also
        gives a start value, which is needed if the present value is infinite or at its lower limit, as the stiffness of a
        firm support or a mass of 0: ``{"support.stiffness": 2000.0}``.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out. The start value if it varies.

    Returns
    -------
    Fitted
        The new system; the values with standard uncertainties, covariance and correlation; residuals and chi-square; which
        measurement disagrees with the others; the data that the measurements do not determine. Cost: 5 ms for a small chain,
        5 to 20 times that of `Modes.sensitivity` for a long one; 30 to 60 times that of the modes for cords and held
        systems.

    Raises
    ------
    ValueError
        If there are more data than speeds, an unknown path, two paths to the same number, a mode that does not exist, a
        number out of its range, uncertainties of some speeds alone, or a datum without a start value; if the system is held
        at a span, or its tension does not exceed its weight.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.
    ImportError
        If scipy is not installed; the message says how to install it.

    Notes
    -----
    Method: trust-region least squares (`scipy.optimize.least_squares`). Derivatives are analytic, or differences of fourth
    order. The values are within a millionth of their standard uncertainties of a local minimum of the sum of squares. It is
    not proved that there is no lower minimum far from the start. Uncertainties are to first order: they assume that speeds
    are linear in the data.

    The measurement with the largest `Fitted.standardized_residual` disagrees with the others if that exceeds
    `Fitted.disagreement_limit`. If the model is correct, at most one fit in a hundred does so by chance (Bonferroni's
    inequality). To first order; Cook and Weisberg, *Residuals and Influence in Regression* (1982), chapter 2.

    The speeds of a chain without springs and wheels depend on ratios of its masses: they cannot determine all. Such
    combinations have singular values of the derivatives below 1e-8 of the largest; the result names them.

    Examples
    --------
    A crane's two periods were measured; how long is the rope, and how heavy the load?

    >>> import revchain as rc
    >>> crane = rc.Chain(mass=[2500, 400], length=[6, 24])
    >>> measured = {1: ("10.91 s", "0.02 s"), 2: ("1.61 s", "0.01 s")}
    >>> found = rc.fit(crane, measured, vary=["links[1].length_in_proportion", "links[0].mass"])
    >>> found.value.round(2), found.standard_uncertainty.round(2)
    (array([  24.21, 2652.13]), array([ 0.11, 36.99]))
    >>> rc.fit(crane, measured, vary=["links[0].mass", "links[1].mass"]).undetermined
    (('links[0].mass', 'links[1].mass'),)

    Gravity, from three periods of a bead chain of 1.2 m:

    >>> timed = {1: ("1.83 s", "0.01 s"), 2: ("0.79 s", "0.01 s"), 3: ("0.512 s", "0.005 s")}
    >>> found = rc.fit(rc.Cord("1.2 m"), timed, vary="gravity")
    >>> print(f"{found.gravity:.2f} +- {found.standard_uncertainty[0]:.2f} m/s^2")
    9.78 +- 0.09 m/s^2
    """
    if not isinstance(system, System):
        raise no_system(_CALLER, system)
    of: Any = system
    g = one_positive(_CALLER, "gravity", gravity)
    if system._is_held and of.span is not None:
        raise ValueError(
            f"{_CALLER}: a system held at a span is bent and has no critical speeds; tune with top_tension finds one datum for "
            "a speed and a tension"
        )
    if system._is_held:
        straight(_CALLER, of, g)
    paths, starts = _varied(vary)
    number, speed, deviation, timed = _measurements(measured)
    if len(paths) > len(number):
        raise ValueError(
            f"{_CALLER}: vary has {len(paths)} data for {len(number)} measured speed{'s' * (len(number) > 1)}; vary at most "
            f"{len(number)}, or measure more modes"
        )
    data = [gravity_datum(system, g) if path == "gravity" else datum_at(_CALLER, system, path, g) for path in paths]
    refuse_overlap(_CALLER, data)
    turns = system.has_momentum or any(datum.path.startswith("flywheels") for datum in data)
    if (number < 0).any() and not turns:
        raise ValueError(
            f"{_CALLER}: measured: modes are counted from 1; only a rig with flywheels has backward modes, -1 the slowest, "
            f"got {number.min()}"
        )
    model = _Model(system, data, number, speed, timed, np.abs(speed if deviation is None else deviation), g)
    found = _fitted(model, *_least(model, np.array([_start(*each) for each in zip(data, starts, strict=True)])), deviation)
    return asked_in(speed_unit(list(measured.values())), found)


class _Model:
    """Speeds and their residuals as functions of unbounded variables that stand for the data.

    Residuals are those of what was measured: speeds, or periods where `timed` is true. In terms of the speed n and the
    measured m that of a period is (n - m) m / n, in units of the same deviation.
    """

    def __init__(
        self, system: Any, data: list[Datum], number: Whole, speed: Floats, timed: Any, deviation: Floats, gravity: float
    ):
        self.system, self.data, self.number, self.timed, self.gravity = system, data, number, timed, gravity
        self.measured, self.scale = speed, float((deviation / np.abs(speed)).min())
        self.deviation = deviation / self.scale  # the tolerances of the search are for residuals that are parts of a speed
        self.kept: tuple[bytes, Any] = (b"", None)

    def values(self, free: Floats) -> Floats:
        with np.errstate(over="ignore"):
            return np.array([_bounded(datum, x) for datum, x in zip(self.data, free, strict=True)])

    def at(self, free: Floats) -> tuple[Any, Speeds]:
        """The system and its speeds; a ValueError if such a system is impossible or lacks these modes."""
        if self.kept[0] != free.tobytes():
            paths = [datum.said for datum in self.data]
            system, values = self.system, dict(zip(paths, self.values(free).tolist(), strict=True))
            gravity = values.pop("gravity", self.gravity)
            for path, value in values.items():
                system = datum_at(_CALLER, system, path, gravity).change(value)
            self.kept = (free.tobytes(), (system, speeds(_CALLER, system, self.number, gravity)))
        found: tuple[Any, Speeds] = self.kept[1]
        return found

    def off(self, free: Floats) -> Floats:
        """(Computed - measured) / uncertainty; NaN if there is no such system, and the search then steps back."""
        try:
            speed = self.at(free)[1].speed
        except ValueError:
            return np.full(len(self.number), np.nan)
        return (speed - self.measured) * self._part(speed) / self.deviation

    def _part(self, speed: Floats) -> Floats:
        """Measured over computed speed where a period was measured, else 1."""
        return np.where(self.timed, self.measured / speed, 1.0)

    def slopes(self, free: Floats) -> Floats:
        """The derivatives of the deviations `off`, shape (m, p): m measurements, p data."""
        _, there = self.at(free)
        rates, per = self._rates(there), self._part(there.speed) ** 2 / self.deviation
        columns = []
        for k, (datum, value) in enumerate(zip(self.data, self.values(free), strict=True)):
            if datum.path == "gravity" and there.modes.system._fixes_gravity is None:  # speeds rise with its root
                columns.append(0.5 * there.speed * per)
                continue
            if datum.rate is None or rates is None:
                columns.append(self._difference(free, k))
                continue
            name, part = datum.rate
            column = rates[name] @ part if rates[name].ndim == 2 else rates[name] * part
            columns.append(column * _inner(datum, value) * per)
        return np.column_stack(columns)

    def _rates(self, there: Speeds) -> Any:
        """Derivatives of the speeds by the data of a chain or a rig; None if there are none."""
        if there.modes.system._kind == "rig":
            if there.modes.system._has_pins:
                return None
            return rig_derivatives(there.modes.system, there.speed, there.modes.shape[there.rows], there.modes.gravity)
        if self.system._kind != "chain":
            return None
        of_heights: Any = there.modes.sensitivity
        factor = -0.5 * there.speed / there.modes.conical_height[there.rows].astype(np.float64)
        named = {datum.rate[0] for datum in self.data if datum.rate is not None}
        return {name: of_heights[name][there.rows] * factor[:, None] for name in named}

    def _difference(self, free: Floats, k: int) -> Floats:
        for step in (1e-3, 1e-5):
            move = step * (np.arange(len(free)) == k)
            near = [self.off(free + x * move) for x in (-2, -1, 1, 2)]
            column: Floats = (near[0] - 8 * near[1] + 8 * near[2] - near[3]) / (12 * step)
            if np.isfinite(column).all():
                break
        return np.nan_to_num(column)


def _least(model: _Model, start: Floats) -> tuple[Floats, bool, _Known]:
    """Return the variables at the minimum, whether the search converged, and how well each datum is known there.

    Combinations that the measurements do not determine stay at their start.
    """
    model.at(start)  # raises the errors of the start
    optimize, hold = require("scipy.optimize", "fit", _CALLER), np.empty((0, len(start)))
    for _ in range(2):
        found = optimize.least_squares(
            lambda free, hold=hold: np.append(model.off(free), hold @ (free - start)),
            start,
            lambda free, hold=hold: np.vstack([model.slopes(free), hold]),
            x_scale="jac",
            ftol=1e-12,
            xtol=1e-10,
            gtol=1e-15,
            max_nfev=500,
        )
        slopes, off = model.slopes(found.x), model.off(found.x)
        known = _Known(slopes, model.measured / model.deviation)
        hold = known.lost
        if not len(hold):
            break
    last = found.x - known.inverse @ (slopes.T @ off)  # a Gauss-Newton step, for the digits below the tolerances
    if not (model.off(last) ** 2).sum() <= (off**2).sum() * (1 + 1e-9) + 1e-18:
        last = found.x
    return last, found.status > 0, known


class _Known:
    """The information of the measurements about the data, from the singular values of the derivatives.

    Attributes
    ----------
    inverse : ndarray, shape (p, p)
        Pseudo-inverse of the normal equations.
    covariance : ndarray, shape (p, p)
        Covariance of the variables; NaN for undetermined ones.
    lost : ndarray, shape (p - rank, p)
        Undetermined combinations of the variables, one in each row.
    groups : list of list of int
        Data that belong to the same combinations.
    """

    def __init__(self, slopes: Floats, per_part: Floats) -> None:
        moves = np.abs(slopes / per_part[:, None]).max(axis=0) > _EFFECT
        size = np.where(moves, np.sqrt((slopes**2).sum(axis=0)), 1.0)
        _, singular, rows = np.linalg.svd(np.where(moves, slopes / size, 0.0), full_matrices=True)
        is_known = singular > _SINGULAR * max(singular[0], _SINGULAR)
        self.rank = int(is_known.sum())
        self.lost = rows[~is_known] * size
        together = np.abs(rows[~is_known].T @ rows[~is_known]) > _PART
        self.groups: list[list[int]] = []
        rest = {int(k) for k in np.flatnonzero(together.diagonal())}
        while rest:
            group, new = set(), {min(rest)}
            while new:
                group |= new
                new = {int(k) for one in new for k in np.flatnonzero(together[one])} - group
            self.groups.append(sorted(group))
            rest -= group
        self.inverse = rows[is_known].T @ (rows[is_known] / singular[is_known, None] ** 2) / np.outer(size, size)
        self.covariance = self.inverse.copy()
        for lost in self.groups:
            self.covariance[lost] = self.covariance[:, lost] = np.nan


def _fitted(model: _Model, free: Floats, converged: bool, known: _Known, deviation: Floats | None) -> Fitted:
    system, there = model.at(free)
    values, paths = model.values(free), tuple(datum.said for datum in model.data)
    inner = np.array([_inner(*each) for each in zip(model.data, values, strict=True)])
    covariance = known.covariance * np.outer(inner, inner) * model.scale**2
    off, slopes = model.off(free) / model.scale, model.slopes(free)
    left, freedom = float((off**2).sum()), len(model.number) - known.rank
    inverse = _Known(slopes, model.measured / model.deviation).inverse
    leverage = np.clip(np.einsum("ik,kl,il->i", slopes, inverse, slopes), 0.0, 1.0)
    standardized, limit = _standardized(-off, leverage, freedom, deviation is None)
    if deviation is None:
        spread = left / freedom if freedom else math.nan
        covariance, deviation = covariance * spread, np.abs(model.measured) * math.sqrt(spread)
        with np.errstate(divide="ignore", invalid="ignore"):
            off, chi_square = off / math.sqrt(spread), None
    else:
        chi_square = left
    return Fitted._made(
        None,
        status="undetermined" if known.groups and converged else "success" if converged else "not_converged",
        vary=paths,
        system=system,
        gravity=there.modes.gravity,
        value=values,
        covariance=covariance,
        present=np.array([datum.present for datum in model.data]),
        unit=tuple(_unit(datum, system.by_mass) for datum in model.data),
        number=model.number,
        measured=model.measured,
        measured_uncertainty=deviation,
        computed=there.speed,
        normalized_residual=-off,
        leverage=leverage,
        standardized_residual=standardized,
        disagreement_limit=limit,
        chi_square=chi_square,
        degrees_of_freedom=freedom,
        undetermined=tuple(tuple(paths[k] for k in group) for group in known.groups),
    )


def _standardized(residual: Floats, leverage: Floats, freedom: int, estimated: bool) -> tuple[Floats, float]:
    """The standardized residuals, and the size that the largest of them exceeds by chance in one fit of a hundred.

    `residual` is divided by the uncertainties; if these are unknown (`estimated`), the residuals are studentized externally:
    by the scatter of the other measurements.
    """
    free = 1 - leverage > _FIXED  # the fit passes through the others, whatever was measured
    share = np.where(free, 1 - leverage, np.nan)
    standardized, law = residual / np.sqrt(share), np.inf
    if estimated:
        law = freedom - 1
        if law < 1 or (residual**2).sum() < _ROUNDED**2:
            return np.full(len(residual), np.nan), math.nan
        others = np.maximum((residual**2).sum() - standardized**2, 0.0) / law
        with np.errstate(divide="ignore", invalid="ignore"):  # no scatter at all
            standardized = standardized / np.sqrt(others)
    if not free.any() or freedom < 1:
        return standardized, math.nan
    special, tail = require("scipy.special", "fit", _CALLER), _CHANCE / (2 * int(free.sum()))
    return standardized, float(-special.ndtri(tail) if law == np.inf else -special.stdtrit(law, tail))


def _unit(datum: Datum, by_mass: bool) -> str:
    """The unit of a datum; empty if it depends on that of the weights, which is unknown."""
    unit = SI[datum.quantity][0] if datum.quantity in SI else ""
    return unit if by_mass or not {"N", "N/m", "kg"} & set(unit.split()) else ""


def _inner(datum: Datum, value: float) -> float:
    """The derivative of a datum with respect to the variable that the fit changes."""
    return datum.typical if datum.floor is None else value - datum.floor


def _bounded(datum: Datum, free: float) -> float:
    return float(free * datum.typical if datum.floor is None else datum.floor + np.exp(free))


def _start(datum: Datum, given: Any) -> float:
    """The variable that stands for the start value of a datum."""
    value = datum.present if given is None else real(_CALLER, f"{datum.quantity} (start of {datum.said})", given)
    if datum.floor is None and math.isfinite(value):
        return value / datum.typical
    if datum.floor is not None and datum.floor < value < math.inf:
        return math.log(value - datum.floor)
    if given is None:
        raise ValueError(
            f"{_CALLER}: {datum.said} is {value:g}: give a start value, as in vary={{\"{datum.said}\": {datum.typical:.3g}}}"
        )
    limit = "finite" if datum.floor is None else f"finite and more than {datum.floor:.6g}"
    raise ValueError(f"{_CALLER}: the start of {datum.said} must be {limit}, got {value:g}")


def _varied(vary: Any) -> tuple[list[Any], list[Any]]:
    """The paths of the data to vary, with their start values where the caller gives them."""
    if isinstance(vary, Mapping):
        paths = list(vary)
    elif isinstance(vary, str):
        paths = [vary]
    else:
        paths = []
        with suppress(TypeError):  # numpy's arrays without an axis
            paths = list(vary) if isinstance(vary, Iterable) and not isinstance(vary, bytes) else []
    if not paths:
        such = '["length", "links[load].mass"]'
        raise ValueError(f"{_CALLER}: vary must be a path or a list of paths such as {such}, got {shown(vary)}")
    return paths, list(vary.values()) if isinstance(vary, Mapping) else [None] * len(paths)


def _measurements(measured: Any) -> tuple[Whole, Floats, Floats | None, Any]:
    """Mode numbers, speeds (negative for backward modes), standard uncertainties or None, and which are periods."""
    if not isinstance(measured, Mapping) or not measured:
        such = f"a dictionary of speeds by mode number such as {_FORM}"
        raise ValueError(f"{_CALLER}: measured must be {such}, got {shown(measured)}")
    numbers, found = [], []
    for key, value in measured.items():
        number = integer(_CALLER, "measured: each mode number", key)
        if number == 0:
            raise ValueError(f"{_CALLER}: measured: modes are counted from 1, got 0")
        numbers.append(number)
        found.append(_measurement(number, unpacked(value)))
    bare = [number for number, (_, spread, _) in zip(numbers, found, strict=True) if spread is None]
    if bare and len(bare) < len(found):
        raise ValueError(
            f"{_CALLER}: measured[{bare[0]}] has no uncertainty, and others have; give that of all, as in {_FORM}, or of none"
        )
    speed = np.array([np.sign(k) * x for k, (x, *_) in zip(numbers, found, strict=True)])
    timed = np.array([is_period for *_, is_period in found])
    return np.array(numbers), speed, None if bare else np.array([spread for _, spread, _ in found]), timed


def _measurement(number: int, value: Any) -> tuple[float, float | None, bool]:
    """A speed and its uncertainty, both positive, in rad/s, and whether a period was measured."""
    caller, spread = f"{_CALLER}: measured[{number}]", None
    if isinstance(value, str) and (parts := with_tolerance(value)) is not None and parts[0]:
        value = parts  # "2.01 s +- 0.02 s"
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, list | tuple):
        if len(value) != 2:
            raise ValueError(f"{caller} must be a speed, or a pair of it and its uncertainty, as in {_FORM}, got {shown(value)}")
        value, spread = value
    size, is_period = _speed_or_period(caller, "speed", value)
    size = -size if number < 0 and not is_period else size
    if not 0 < abs(size) < math.inf or (size < 0 and number > 0):
        raise ValueError(f"{caller}: speed must be positive and finite, got {shown(value)}")
    size = abs(size)
    speed = 2 * math.pi / size if is_period else size
    if spread is None:
        return speed, None, is_period
    if isinstance(spread, str) and spread.strip().endswith("%"):
        part = real(caller, "rtol (the uncertainty)", spread)
    else:
        deviation, as_period = _speed_or_period(caller, "uncertainty", spread)
        if has_units(value) != has_units(spread) or as_period != is_period:
            raise ValueError(f'{caller}: give speed and uncertainty in the same unit, or "1 %", got {shown((value, spread))}')
        part = deviation / size
    if not 0 < part < math.inf:
        raise ValueError(
            f"{caller}: uncertainty must be positive and finite, got {shown(spread)}; leave out those of all speeds if none "
            "is known"
        )
    if not 1 / _EXTREME <= part <= _EXTREME:
        raise ValueError(
            f"{caller}: uncertainty must be from {1 / _EXTREME:g} to {_EXTREME:g} times the measured value, got {shown(spread)}"
        )
    return speed, part * speed, is_period


def _speed_or_period(caller: str, name: str, value: Any) -> tuple[float, bool]:
    """A number in rad/s or, where its unit is that of a time, in s."""
    if has_units(value):
        try:
            return float(in_si(caller, "period", value)), True
        except (ValueError, TypeError):
            return real(caller, "angular_speed", value), False
    return real(caller, name, value), False
