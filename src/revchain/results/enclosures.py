# SPDX-License-Identifier: GPL-3.0-or-later
"""Proved bounds of conical heights over a box of data; docs/theory/derivatives.md has the theorem.

The data of the links (weight, length, centroid, radius of gyration) and of a yielding support (stiffness, weight) are
products of factors, each with an interval. Heights are those of the pencil M - L K in the drifts of the links (differences
of the offsets of neighbouring pins), in which K is diagonal and a change of all lengths of a link leaves M unchanged.
"""

from __future__ import annotations

import heapq
import math
from dataclasses import dataclass
from functools import cached_property
from itertools import count
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from ..systems.numbers import Floats

EPS = 2.0**-52
ENOUGH = 0.01  # part of the distance from the nominal height that may lie between the bound and the height attained
ROUNDING = 1e-11  # smallest relative gap that a search tries to close
_SEARCHES = 4  # corners that are tried in a box
_STEPS = 16  # heights that are tried in a box
_PIECES = 4  # of the way from a corner, on which derivatives are enclosed
_GAMMA = 64 * EPS  # of rounding, for each coordinate and relative to the sum of the magnitudes


Interval = tuple[Floats, Floats]


class Extreme(NamedTuple):
    """One end of the range of a conical height over a box."""

    bound: float  # proved: no height in the box lies beyond
    attained: float  # the height at `factors`
    factors: Floats  # a point of the box
    boxes: int  # number of boxes examined


@dataclass(frozen=True, eq=False)
class Family:
    """Chains, with or without a yielding support, whose data are products of factors that vary in intervals.

    Attributes
    ----------
    base : ndarray, shape (4 N + 2,)
        Weight, length, centroid and radius of gyration of the links, stiffness of the support over the force of a unit of
        weight, and weight that moves with the support. An infinite stiffness is a firm support.
    follows : ndarray of bool, shape (p, 4 N + 2)
        Whether a datum is proportional to a factor.
    low, nominal, high : ndarray, shape (p,)
        Interval of each factor, and its nominal value.
    """

    base: Floats
    follows: NDArray[np.bool_]
    low: Floats
    nominal: Floats
    high: Floats

    @property
    def links(self) -> int:
        """Number of links."""
        return (self.base.size - 2) // 4

    @property
    def yields(self) -> bool:
        """Whether the support moves."""
        return math.isfinite(self.base[-2])

    @property
    def rigid(self) -> int:
        """1 if the support is a trolley that rolls freely, which adds an infinite height; else 0."""
        return int(self.base[-2] == 0)

    @property
    def size(self) -> int:
        """Number of coordinates."""
        return self.links + self.yields

    @property
    def gamma(self) -> float:
        """Bound of the relative rounding of sums of magnitudes over the coordinates."""
        return _GAMMA * (self.size + 4)

    @cached_property
    def effect(self) -> Floats:
        """1 or -1 for a factor that lowers no height or raises none, 0 for one that changes none, NaN if unknown."""
        found = np.full(len(self.low), np.nan)
        there = self.base != 0
        weight, length, centroid, radius = (there[:-2] & self.follows[:, :-2]).reshape(-1, 4, self.links).swapaxes(0, 1)
        spring, carriage = (there[-2:] & self.follows[:, -2:]).T
        bodies = there[:-2].reshape(4, self.links)
        none = ~weight.any(1) & ~spring & ~carriage
        follow = ((centroid == (length & bodies[2])) & (radius == (length & bodies[3]))).all(1)
        found[none & (follow | ~(length.any(1) | centroid.any(1)))] = 1
        bare = ~(length.any(1) | centroid.any(1) | radius.any(1))
        found[bare & ~weight.any(1) & carriage & ~spring] = 1
        found[bare & ~weight.any(1) & ~carriage & spring] = -1
        whole = bare & (weight == bodies[0]).all(1) & ~spring & (carriage | ~there[-1])
        found[whole] = 1.0 if self.yields and not self.rigid else 0.0
        return found

    @cached_property
    def inverted(self) -> NDArray[np.bool_]:
        """Whether a way to another point is straight in the inverse of a factor."""
        return np.asarray(self.follows[:, self.links : 2 * self.links].any(axis=1))

    @cached_property
    def _others(self) -> list[NDArray[np.int64]]:
        """For each factor the others of the same data."""
        shared = (self.follows.astype(int) @ self.follows.T.astype(int)) > 0
        return [np.flatnonzero(row & (np.arange(len(row)) != i)) for i, row in enumerate(shared)]

    def data(self, factors: Floats) -> Floats:
        """The data at a point of the box."""
        return np.asarray(self.base * np.where(self.follows, factors[:, None], 1.0).prod(axis=0))

    def intervals(self, low: Floats, high: Floats, without: int = -1) -> tuple[Floats, Floats]:
        """Lowest and highest data in a box; without one of the factors."""
        factors = np.arange(len(low)) if without < 0 else self._others[without]
        if not len(factors):
            return self.base, self.base
        follows = self.follows[factors]
        sure = low[factors] >= 0
        ends = [np.where(follows[sure], end[factors][sure, None], 1.0).prod(axis=0) for end in (low, high)]
        down, up = np.minimum(self.base * ends[0], self.base * ends[1]), np.maximum(self.base * ends[0], self.base * ends[1])
        for i in factors[~sure]:
            new = _times((down, up), (low[i], high[i]))
            down, up = np.where(self.follows[i], new[0], down), np.where(self.follows[i], new[1], up)
        return down, up

    def forms(self, factors: Floats) -> tuple[Floats, Floats]:
        """The matrices M and K at a point."""
        data = self.data(factors)
        weight, length, centroid, radius = data[:-2].reshape(4, -1)
        rows = self._rows(centroid / length)
        inertia = (rows.T * weight) @ rows
        np.einsum("ii->i", inertia)[: self.links] += weight * (radius / length) ** 2
        return self._with_support(inertia, (weight * centroid / length + _below(weight)) / length, data)

    def _with_support(self, inertia: Floats, diagonal: Floats, data: Floats) -> tuple[Floats, Floats]:
        if self.yields:
            inertia[-1, -1] += data[-1]
            diagonal = np.append(diagonal, data[-2])
        return inertia, np.diag(diagonal)

    def _rows(self, part: Floats) -> Floats:
        """Offsets of the centres of gravity for drifts of 1; `part` is centroid over length."""
        rows = np.triu(np.ones((self.links, self.size)), 1)
        rows.flat[:: self.size + 1] = part
        return rows

    def modes(self, factors: Floats) -> tuple[Floats, Floats]:
        """Conical heights at a point, largest first, and the drifts of the modes as columns."""
        return solved(*self.forms(factors))

    def slopes(self, factors: Floats, height: float, drift: Floats) -> Floats:
        """Derivatives of a height, times the mode's potential energy, with respect to the factors."""
        data = self.data(factors)
        weight, length, centroid, radius = data[:-2].reshape(4, -1)
        slope, aside = drift[: self.links] / length, self._rows(centroid / length) @ drift
        square = slope**2
        pull = length * square
        above = pull[::-1].cumsum()[::-1] - pull
        side = float(drift[-1]) if self.yields else 0.0
        rates = np.concatenate([
            aside**2 + radius**2 * square - height * (centroid * square + above),
            height * (2 * weight * centroid / length + _below(weight)) * square
            - (2 * weight / length) * (centroid * aside * slope + radius**2 * square),
            weight * slope * (2 * aside - height * slope),
            2 * weight * radius * square,
            [-height * side**2 if self.yields else 0.0, side**2],
        ])  # fmt: skip
        found = np.empty(len(factors))
        for i, follows in enumerate(self.follows):
            per, others = self.base[follows], self._others[i]
            if others.size:
                per = per * np.where(self.follows[others][:, follows], factors[others, None], 1.0).prod(axis=0)
            found[i] = (rates[follows] * per).sum()
        return found


def _below(weight: Floats) -> Floats:
    """Weight of all links below each link."""
    return np.asarray(np.append(0.0, weight.cumsum()[:-1]))


def solved(inertia: Floats, pull: Floats) -> tuple[Floats, Floats]:
    """Eigenvalues of M x = L K x, largest first, and vectors as columns; NaN if K is not positive definite.

    A zero at the end of K, that of a trolley that rolls freely, gives an infinite eigenvalue.
    """
    shift = 0.0
    if pull[-1, -1] == 0:
        shift = float(pull.trace() / inertia.trace())
    try:
        inverse = np.linalg.inv(np.linalg.cholesky(pull + shift * inertia))
        value, vector = np.linalg.eigh(inverse @ inertia @ inverse.T)
    except np.linalg.LinAlgError:
        return np.full(len(pull), np.nan), np.full(pull.shape, np.nan)
    vector = inverse.T @ vector[:, ::-1]
    with np.errstate(divide="ignore", invalid="ignore"):
        found = (vector * (inertia @ vector)).sum(0) / (vector * (pull @ vector)).sum(0)
    if shift:
        found[0] = np.inf
    return found, vector


def _times(one: Interval, other: Any) -> Interval:
    a, b, c, d = one[0] * other[0], one[0] * other[1], one[1] * other[0], one[1] * other[1]
    return np.minimum(np.minimum(a, b), np.minimum(c, d)), np.maximum(np.maximum(a, b), np.maximum(c, d))


def _plus(one: Interval, other: Interval) -> Interval:
    return one[0] + other[0], one[1] + other[1]


def _over(one: Interval, other: Interval) -> Interval:
    """The quotient by positive numbers."""
    return _times(one, (1 / other[1], 1 / other[0]))


def _scaled(factor: float, one: Interval) -> Interval:
    return (factor * one[0], factor * one[1]) if factor >= 0 else (factor * one[1], factor * one[0])


def _running(one: Interval) -> Interval:
    """Sums of all entries before each, and of all of them at the end."""
    low, high = (np.insert(end.cumsum(axis=-1), 0, 0.0, axis=-1) for end in one)
    return low, high


def _middle(one: Interval) -> Interval:
    """Middle and radius."""
    return (one[0] + one[1]) / 2, (one[1] - one[0]) / 2


class _Parts(NamedTuple):
    """The data of the links in a box, as intervals."""

    weight: Interval
    length: Interval
    centroid: Interval
    radius: Interval
    stiffness: Interval
    carriage: Interval
    part: Interval  # centroid over length


def _parts(family: Family, low: Floats, high: Floats) -> _Parts:
    down, up = family.intervals(low, high)
    weight, length, centroid, radius = zip(down[:-2].reshape(4, -1), up[:-2].reshape(4, -1), strict=True)
    support = (down[-2:-1], up[-2:-1]), (down[-1:], up[-1:])
    return _Parts(weight, length, centroid, radius, *support, _over(centroid, length))


def _pull(family: Family, parts: _Parts) -> Interval:
    """The diagonal of K."""
    low, high = _running(parts.weight)
    below = low[:-1], high[:-1]
    found = _over(_plus(_times(parts.weight, parts.part), below), parts.length)
    if family.yields:
        found = np.append(found[0], parts.stiffness[0]), np.append(found[1], parts.stiffness[1])
    return found


def _lost(family: Family, parts: _Parts, pull: Interval) -> float:
    """Bound of the relative error of K, and so of heights, by rounding where a centroid is above its pin."""
    weight, part = parts.weight[1], np.maximum(np.abs(parts.part[0]), np.abs(parts.part[1]))
    terms = (weight * part + _below(weight)) / parts.length[0]
    above = parts.part[0] < 0
    lost = (terms[above] / pull[0][: family.links][above]).max(initial=0.0)
    return family.gamma * (1 + len(family.low)) * float(lost)


def outermost(family: Family, low: Floats, high: Floats, row: int, side: int) -> float:
    """Bound of a height in a box from M at one end and K at the other."""
    parts = _parts(family, low, high)
    pull = _pull(family, parts)
    if not (pull[0][: family.links] > 0).all():
        return math.inf if side > 0 else 0.0
    middle, half = _middle(parts.part)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(half > 0, half / (np.abs(middle) + half), 0.0)
        spread = np.where(half > 0, half**2 * (1 / share + side), 0.0)
    end = (side + 1) // 2
    weight, rows = parts.weight[end], family._rows(middle)
    turn = (parts.radius[end] / parts.length[1 - end]) ** 2
    inertia = (rows.T * (weight * (1 + side * share))) @ rows
    np.einsum("ii->i", inertia)[: family.links] += weight * (turn + side * spread)
    if family.yields:
        inertia[-1, -1] += parts.carriage[end][0]
    value, _ = solved(inertia, np.diag(pull[1 - end]))
    if not value[row] > 0:
        return math.inf if side > 0 else 0.0
    scale = float(value[family.rigid])
    error = 1e3 * family.gamma * (scale if not family.rigid else scale + row)
    return max(float(value[row]) + side * error, 0.0)


class _Box:
    """A part of the box: bounds one height from above (side 1) or below (side -1) by a proof from a corner."""

    def __init__(self, family: Family, low: Floats, high: Floats, row: int, side: int) -> None:
        self.family, self.low, self.high, self.row, self.side = family, low, high, row, side
        self.active = np.flatnonzero(high > low)
        self.height, self.factors, self.vectors = self._corner()
        self.bound, self.split = self._bounded()

    def _corner(self) -> tuple[float, Floats, Floats]:
        """The farthest height found by following the derivatives to a corner, its factors, and the modes there."""
        at = np.where(self.high > self.low, (self.low + self.high) / 2, self.low)
        found = -self.side * math.inf, at, np.zeros((self.family.size, 0))
        for tried in range(_SEARCHES + 1):
            value, vectors = self.family.modes(at)
            height = float(value[self.row])
            if tried and not self.side * (height - found[0]) > 0:
                break
            if tried or not self.active.size:
                found = height, at, vectors
            slope = self.side * self.family.slopes(at, height, vectors[:, self.row])
            new = np.where(slope > 0, self.high, np.where(slope < 0, self.low, at if tried else self.high))
            if (new == at).all():
                break
            at = new
        return found

    def _bounded(self) -> tuple[float, int]:
        """The bound, and the factor whose interval is best divided to improve it."""
        far = outermost(self.family, self.low, self.high, self.row, self.side)
        if not math.isfinite(self.height):
            return far, -1
        self._changes()
        most, kept, refused = abs(far - self.height), math.inf, -1.0
        tried, split = 0.0, -1
        for _ in range(_STEPS):
            slack, shares = self._slack(self.height + self.side * tried)
            if slack <= 0:
                kept = tried
                if refused < 0 or kept < 1.1 * refused:
                    break
                tried = (kept + max(refused, 0.0)) / 2
                continue
            split = int(self.active[shares.argmax()]) if shares.size else -1
            if math.isfinite(slack):
                tried += 1.02 * slack / self.potential + 4 * self.family.gamma * self.height
            else:
                refused = tried
                tried = min((kept + tried) / 2, max(4 * tried, most / 16))
            if tried >= min(most, kept):
                break
        bound = self.height + self.side * min(kept, most) * (1 + 4 * EPS)
        bound += self.side * 4 * EPS * self.height
        return (min if self.side > 0 else max)(bound, far), split

    def _changes(self) -> None:
        """Store the forms at the corner and their changes with each factor, in the basis of the modes."""
        family, side = self.family, self.side
        rest = slice(self.row + 1, None) if side > 0 else slice(0, self.row)
        basis = np.column_stack([self.vectors[:, self.row], self.vectors[:, rest]])
        sizes = np.abs(basis)
        inertia, pull = family.forms(self.factors)
        self.inertia, self.pull = basis.T @ inertia @ basis, basis.T @ pull @ basis
        self.sizes = family.gamma * (sizes.T @ np.abs(inertia) @ sizes), family.gamma * (sizes.T @ np.abs(pull) @ sizes)
        self.potential = float(self.pull[0, 0])
        corner, active = self.factors[self.active], self.active
        other = np.where(corner == self.high[active], self.low[active], self.high[active])
        turned = family.inverted[active]
        step = np.where(turned, 1 / other - 1 / corner, other - corner)
        least = np.minimum.outer(np.arange(family.size), np.arange(family.size))
        diagonal = np.eye(family.size, dtype=bool)
        sums = np.zeros((active.size, 3, 2, family.size))
        for part in np.arange(1, _PIECES + 1) / _PIECES if active.size else ():  # the mean on a straight way from the corner
            far = self.factors.copy()
            far[active] = np.where(turned, 1 / (1 / corner + part * step), corner + part * step)
            low, high = np.minimum(far, self.factors), np.maximum(far, self.factors)
            sums += self._changes_in(low, high)
        off, own, gravity = (sums / _PIECES).transpose(1, 2, 0, 3)
        forms, radii = (np.where(diagonal, own[k][:, least], off[k][:, least]) for k in (0, 1))
        self.by_inertia = step[:, None, None] * (basis.T @ forms @ basis)
        self.by_pull = step[:, None, None] * np.einsum("pa,ip,pb->iab", basis, gravity[0], basis)
        long = np.abs(step)[:, None, None]
        several = family.follows[active].sum(axis=1) > 1  # terms that may cancel are at most twice the form over the factor
        per = np.abs(np.where(turned, corner, 1 / np.where(several, corner, 1.0)))
        size = np.where(several, 4 * family.gamma * per, 0.0)
        radii = radii + family.gamma * np.abs(forms) + size[:, None, None] * np.abs(inertia)
        wide = gravity[1] + family.gamma * np.abs(gravity[0]) + size[:, None] * np.abs(pull.diagonal())
        self.radius_of_inertia = long * (sizes.T @ radii @ sizes)
        self.radius_of_pull = long * np.einsum("pa,ip,pb->iab", sizes, wide, sizes)

    def _changes_in(self, box_low: Floats, box_high: Floats) -> Floats:
        """Derivatives of the forms in a box by each active factor, or by its inverse: of M beside its diagonal, of its
        diagonal, of K; each as middle and radius, shape (active, 3, 2, size)."""
        family, active, links = self.family, self.active, self.family.links
        follows, turned = family.follows[active], family.inverted[active, None]
        per = np.array([family.intervals(box_low, box_high, without=int(i)) for i in active])
        data = np.where(follows, per[:, 0], 0.0), np.where(follows, per[:, 1], 0.0)
        weight, length, centroid, radius, _, _, part = _parts(family, box_low, box_high)
        long = data[0][:, links : 2 * links], data[1][:, links : 2 * links]
        straight = _scaled(-1.0, _over(long, _times(length, length)))
        with np.errstate(divide="ignore"):
            by_inverse = _where(long[1] > 0, _where(turned, (1 / long[1], 1 / long[0]), straight), (0.0, 0.0))
        squared = _square((box_low[active, None], box_high[active, None]))
        data = _where(turned, _scaled(-1.0, _times(data, squared)), data)
        rates = [np.moveaxis(end[:, :-2].reshape(-1, 4, links), 1, 0) for end in data]
        by_weight, _, by_centroid, by_radius = zip(*rates, strict=True)
        over, turn = _over(weight, length), _over(radius, length)
        low, high = _running(weight)
        below = low[:-1], high[:-1]
        by_part = _plus(_over(by_centroid, length), _times(by_inverse, centroid))
        by_turn = _plus(_over(by_radius, length), _times(by_inverse, radius))
        off = _plus(_times(by_weight, part), _times(by_part, weight))
        spin = _plus(_times(by_part, part), _times(by_turn, turn))
        own = _plus(_times(by_weight, _plus(_square(part), _square(turn))), _scaled(2.0, _times(spin, weight)))
        low, high = _running(by_weight)
        before = low[:, :-1], high[:, :-1]
        gravity = _over(_plus(_times(by_weight, part), _plus(before, _times(by_centroid, over))), length)
        gravity = _plus(gravity, _times(by_inverse, _plus(_scaled(2.0, _times(weight, part)), below)))
        off, own = _plus(off, before), _plus(own, before)
        if family.yields:
            carried = low[:, -1:] + data[0][:, -1:], high[:, -1:] + data[1][:, -1:]
            off, own = _joined(off, carried), _joined(own, carried)
            gravity = _joined(gravity, (data[0][:, -2:-1], data[1][:, -2:-1]))
        return np.stack([_middle(each) for each in (off, own, gravity)]).transpose(2, 0, 1, 3)

    def _slack(self, height: float) -> tuple[float, Floats]:
        """An upper bound of side * (M - L K) over the box, for this mode and those after it; the share of each datum."""
        side, gamma = self.side, self.family.gamma
        form = side * (self.inertia - height * self.pull)
        error = self.sizes[0] + height * self.sizes[1]
        change = side * (self.by_inertia - height * self.by_pull)
        radius = self.radius_of_inertia + height * self.radius_of_pull
        gain = -(change[:, 0, 0] + radius[:, 0, 0])
        if len(form) == 1:
            cost, base = np.zeros(len(gain)), 0.0
        else:
            block = change[:, 1:, 1:] + np.eye(len(form) - 1) * radius[:, 1:, 1:].sum(2)[:, None, :]
            value, vector = np.linalg.eigh(block)
            positive = (vector * np.maximum(value, 0.0)[:, None, :]) @ vector.swapaxes(1, 2)
            rounding = gamma * np.abs(value).max(1).sum()
            left = -form[1:, 1:] - positive.sum(0) - np.diag(error[1:, 1:].sum(1) + rounding)
            try:
                root = np.linalg.cholesky(left - gamma * np.abs(left).max() * len(left) * np.eye(len(left)))
            except np.linalg.LinAlgError:
                return math.inf, positive.trace(axis1=1, axis2=2)
            inverse = np.linalg.inv(root)
            mixed = np.vstack([form[:1, 1:], change[:, 0, 1:]]) @ inverse.T
            wide = np.linalg.norm(np.vstack([error[:1, 1:], radius[:, 0, 1:]]) @ np.abs(inverse).T, axis=1)
            norm = np.linalg.norm(mixed, axis=1)
            cross = mixed @ mixed.T + np.outer(wide, norm) + np.outer(norm, wide) + np.outer(wide, wide)
            cross = cross + 1e-7 * np.outer(norm, norm)  # of rounding in the inverse
            base, first, cross = float(cross[0, 0]), np.maximum(cross[0, 1:], 0.0), cross[1:, 1:]
            rich = np.maximum(gain, 0.0) + 1e-300
            pairs = 2 * np.maximum(cross, 0.0) * (rich[:, None] / (rich[:, None] + rich))
            cost = cross.diagonal() + 2 * first + pairs.sum(1) - pairs.diagonal()
        shares = np.maximum(cost - gain, 0.0)
        return float(form[0, 0] + error[0, 0]) + base + float(shares.sum()), shares


def _square(one: Interval) -> Interval:
    low, high = np.minimum(np.abs(one[0]), np.abs(one[1])), np.maximum(np.abs(one[0]), np.abs(one[1]))
    return np.where((one[0] < 0) & (one[1] > 0), 0.0, low**2), high**2


def _where(there: NDArray[np.bool_], one: Any, other: Any) -> Interval:
    return np.where(there, one[0], other[0]), np.where(there, one[1], other[1])


def _joined(one: Interval, other: Interval) -> Interval:
    return np.append(one[0], other[0], axis=-1), np.append(one[1], other[1], axis=-1)


def extreme(family: Family, row: int, side: int, budget: int) -> Extreme:
    """The largest (side 1) or smallest (side -1) height with index `row`, 0 for the largest, over the box of a family."""
    row += family.rigid
    effect = side * family.effect
    low = np.where(effect > 0, family.high, np.where(effect == 0, family.nominal, family.low))
    high = np.where(effect < 0, family.low, np.where(effect == 0, family.nominal, family.high))
    value, _ = family.modes(family.nominal)
    nominal, order = float(value[row]), count()
    parts = _parts(family, family.low, family.high)
    pull = _pull(family, parts)
    lost = _lost(family, parts, pull) if (pull[0][: family.links] > 0).all() else math.inf
    if not lost < 0.1:  # it may not hang at rest
        return Extreme(math.inf if side > 0 else 0.0, nominal, family.nominal, 0)
    first = _Box(family, low, high, row, side)
    best, factors = (first.height, first.factors) if side * (first.height - nominal) > 0 else (nominal, family.nominal)
    boxes, examined = [(-side * first.bound, next(order), first)], 1
    while True:
        worst = boxes[0][2]
        close = ENOUGH * abs(best - nominal) + ROUNDING * best
        if side * (worst.bound - best) <= close or worst.split < 0 or examined + 2 > budget:
            break
        examined += 2
        heapq.heappop(boxes)
        middle = (worst.low[worst.split] + worst.high[worst.split]) / 2
        here = np.arange(len(low)) == worst.split
        for down, up in ((worst.low, np.where(here, middle, worst.high)), (np.where(here, middle, worst.low), worst.high)):
            part = _Box(family, down, up, row, side)
            if side * (part.height - best) > 0:
                best, factors = part.height, part.factors
            bound = part.bound if side * (part.bound - worst.bound) < 0 else worst.bound
            part.bound = bound
            heapq.heappush(boxes, (-side * bound, next(order), part))
    bound = boxes[0][2].bound
    bound = (bound if side * (bound - best) > 0 else best) * (1 + side * lost)
    return Extreme(bound, best * (1 - side * lost), factors, examined)
