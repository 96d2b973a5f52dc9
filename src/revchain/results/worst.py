# SPDX-License-Identifier: GPL-3.0-or-later
"""`WorstCase`: the lowest and highest speeds of modes whose data lie within tolerances."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import _core
from ..systems.numbers import Floats, Whole
from .base import Field, Result
from .enclosures import EPS, Extreme, Family, extreme
from .sheet import in_unit

if TYPE_CHECKING:
    from .modes import Modes

BOXES = 33  # examined at most for each bound: the box of tolerances, its halves and theirs
MOST_LINKS = 100
SLIGHT = 1e-9  # of a speed: a proved range that is only rounding
CLOSE = 0.05  # of the range of a speed: the gap of a result that is a success
_LEAST_ERROR = 1e-13  # of a height of a cord, relative; also covers the rounding of data and of ratios of mass
_PARTS = 128  # of the interval of the ratio of a cord's tip to its mass
_OF_SUPPORT = {"stiffness": -2, "support_mass": -1}  # places in the data of a `Family`
_COLUMNS = ("mass", "length", "centroid", "radius_of_gyration")


class WorstCase(Result, row="mode", title="{_words}", notes=("{_remarks}",)):
    """Bounds of the speeds of k modes whose data lie anywhere in a box of tolerances.

    No system in the box has a speed outside of `lowest_angular_speed` and `highest_angular_speed`: proved for chains and
    rigs, while for cords it rests on `Modes.error_bound`. The speeds `lowest_reached` and `highest_reached` belong to
    systems in the box, whose data are `lowest_at` and `highest_at`.

    Examples
    --------
    >>> import revchain as rc
    >>> crane = rc.Chain(mass=[2500.0, 400.0], length=[6.0, 24.0], names=["load", "hook block"])
    >>> found = rc.modes(crane).uncertainty(mass=["10 %", 0], length_in_proportion="0.5 m", worst=True).worst
    >>> found.lowest_period.round(3), found.highest_period.round(3)
    (array([10.676,  1.525]), array([11.05,  1.79]))
    >>> found.status, found.highest_at["mass"][0].round(6).tolist()
    ('success', [2250.0, 400.0])
    """

    __slots__ = ()
    number: Field[Whole] = Field("Mode numbers, shape (k,).", heading="mode", column="mode")
    lowest_angular_speed: Field[Floats] = Field(
        "Lower bound of each speed over the box, rad/s, shape (k,).", heading="speed at least", unit="rad/s"
    )
    lowest_reached: Field[Floats] = Field(
        "Lowest speed found in the box, rad/s, shape (k,).", heading="lowest reached", unit="rad/s"
    )
    highest_reached: Field[Floats] = Field(
        "Highest speed found in the box, rad/s, shape (k,).", heading="highest reached", unit="rad/s"
    )
    highest_angular_speed: Field[Floats] = Field(
        "Upper bound of each speed over the box, rad/s, shape (k,).", heading="speed at most", unit="rad/s"
    )
    lowest_period: Field[Floats] = Field(
        "Lower bound of each period, s, shape (k,).",
        lambda w: _outward(in_unit(w.highest_angular_speed, "s"), -1),
        heading="period at least",
        unit="s",
    )
    highest_period: Field[Floats] = Field(
        "Upper bound of each period, s, shape (k,).",
        lambda w: _outward(in_unit(w.lowest_angular_speed, "s"), 1),
        heading="period at most",
        unit="s",
    )
    lowest_conical_height: Field[Floats] = Field(
        "Lower bound of each conical height, m, shape (k,).", axes=(), unit="m"
    )
    highest_conical_height: Field[Floats] = Field(
        "Upper bound of each conical height, m, shape (k,).", axes=(), unit="m"
    )
    gap: Field[Floats] = Field(
        "Part of the range between the bounds of each speed that was not reached, shape (k,); 1 if nothing is proved.",
        lambda w: _gap(w),
        heading="gap",
        digits=2,
    )
    lowest_at: Field[dict[str, Floats]] = Field(
        "Data at which each lowest speed is reached, by path or keyword: shape (k, N) for a keyword for links, else (k,)."
    )
    highest_at: Field[dict[str, Floats]] = Field("Data at which each highest speed is reached, in the same form.")
    boxes: Field[Whole] = Field("Number of parts of the box that were examined for each mode, shape (k,).")
    status: Field[str] = Field(
        "``'success'``, or ``'budget_spent'`` if a gap is above 5 %. The bounds hold in both cases.",
        lambda w: "success" if not (w.gap > CLOSE).any() else "budget_spent",
        fact=True,
    )

    @property
    def _words(self) -> str:
        return f"Worst case over the box of tolerances: {self.status.replace('_', ' ')}"

    @property
    def _remarks(self) -> str:
        slight = self.highest_angular_speed - self.lowest_angular_speed <= SLIGHT * self.highest_angular_speed
        without = [f"mode {number}" for number in self.number[slight].tolist()]
        which = "any speed" if slight.all() else "the speed of " + ", ".join(without)
        return "\n".join([
            *([f"no effect: the data do not change {which} within their tolerances"] if without else []),
            "at least, at most: bounds for every system in the box; reached: by a system in the box",
            "gap: part of the range between the bounds that was not reached",
        ])  # fmt: skip


def _outward(values: Floats, side: int) -> Floats:
    return np.asarray(values * (1 + 4 * side * EPS))


def _gap(worst: WorstCase) -> Floats:
    with np.errstate(divide="ignore", invalid="ignore"):
        wide = worst.highest_angular_speed - worst.lowest_angular_speed
        inner = worst.highest_reached - worst.lowest_reached
        gap = np.where(np.isfinite(wide), 1 - inner / wide, 1.0)
    nothing = np.isfinite(wide) & (wide <= SLIGHT * worst.highest_angular_speed)
    return np.where(nothing, 0.0, np.maximum(gap, 0.0))


def worst_of(found: list[tuple[Extreme, Extreme]], number: Any, gravity: tuple[float, float], data_at: Any) -> WorstCase:
    """The result from the lowest and the highest height of each mode; `gravity` has its lowest and highest value."""
    low, high = (np.array([pair[k].bound for pair in found]) for k in (0, 1))
    reached = [np.array([pair[k].attained for pair in found]) for k in (0, 1)]
    with np.errstate(divide="ignore"):
        ends = [np.sqrt(gravity[1]) / np.sqrt(low), np.sqrt(gravity[0]) / np.sqrt(high)]
        inner = [np.sqrt(gravity[1]) / np.sqrt(reached[0]), np.sqrt(gravity[0]) / np.sqrt(reached[1])]
    at = [[data_at(pair[k]) for pair in found] for k in (1, 0)]  # the highest height is that of the lowest speed
    places = [{name: np.array([one[name] for one in rows]) for name in (rows[0] if rows else {})} for rows in at]
    return WorstCase._made(
        None,
        number=np.asarray(number),
        lowest_angular_speed=_outward(ends[1], -1),
        highest_angular_speed=_outward(ends[0], 1),
        lowest_reached=inner[1],
        highest_reached=inner[0],
        lowest_conical_height=low,
        highest_conical_height=high,
        lowest_at=places[0],
        highest_at=places[1],
        boxes=np.array([pair[0].boxes + pair[1].boxes for pair in found], np.int64),
    )


def extremes(family: Family, numbers: Any) -> list[tuple[Extreme, Extreme]]:
    """The lowest and the highest conical height of each mode by number over the box of a family."""
    return [(extreme(family, int(k) - 1, -1, BOXES), extreme(family, int(k) - 1, 1, BOXES)) for k in numbers]


def data_of(system: Any, gravity: float) -> Floats:
    """The data of a chain or rig, as a `Family` has them."""
    chain = system._base
    size, rig = chain.size, system._kind == "rig"
    support: Any = system.support if rig else None
    yields = rig and support._yields
    return np.concatenate([
        *(np.broadcast_to(column, size) for column in (
            chain._compiled.weight, chain.length, chain.centroid, chain.radius_of_gyration,
        )),
        [support.stiffness / system._force(gravity) if yields else math.inf, support.carriage if yields else 0.0],
    ])  # fmt: skip


def refuse_unbounded(caller: str, system: Any) -> None:
    """Raise a ValueError for a system that has no proof."""
    reason = ""
    if system._kind == "rig":
        parts = {
            "flywheels": system.has_momentum or system.flywheels is not None,
            "a fluid": system.displaced is not None,
            "springs or dashpots at pins": system._has_pins or system.is_damped,
            "standing links": bool(system._stands.any()),
        }
        reason = next((what for what, there in parts.items() if there), "")
    elif system._kind == "held chain":
        reason = "two held ends"
    if reason:
        raise ValueError(f"{caller}: worst has no proof for a system with {reason}; leave worst out, or sample the data")
    if not system._is_cord and system.size > MOST_LINKS:
        raise ValueError(f"{caller}: worst is for at most {MOST_LINKS} links, got {system.size}; leave worst out")


class Moved(NamedTuple):
    """A datum given by its path: the data that it moves, its nominal value, and its half-width."""

    name: str  # of data of links or of the support
    factor: Any  # not 0 for the links that follow it
    present: float
    width: float


def worst_of_modes(
    caller: str, modes: Modes, widths: dict[str, Floats], data: dict[str, Any], moved: dict[str, Moved]
) -> WorstCase:
    """The worst case of modes: `widths` has half-widths by name, `data` nominal values, `moved` the data given by path."""
    system = modes.system
    refuse_unbounded(caller, system)
    for name, width in widths.items():
        if width.ndim == 2:
            raise ValueError(f"{caller}: {name} must be half-widths of tolerances with worst=True, not a covariance")
        _refuse_wide(caller, name, np.asarray(data[name], float), width)
    for path, each in moved.items():
        _refuse_wide(caller, path, np.float64(each.present), np.float64(each.width), each.name)
    if system._is_cord:
        by_name = {each.name: np.array(each.width) for each in moved.values()}
        return _worst_of_cord(caller, modes, widths | by_name, data)
    widths = {name: _without_lowest_pin(width, system) if name == "length" else width for name, width in widths.items()}
    moved = {
        path: each._replace(width=0.0) if each.name == "length" and not np.any(np.asarray(each.factor)[1:]) else each
        for path, each in moved.items()
    }
    family, names = _family(system, modes.gravity, widths, data, moved)

    def data_at(end: Extreme) -> dict[str, Any]:
        return {name: factor * np.clip(end.factors[where], low, high) for name, where, factor, low, high in names}

    found = extremes(family, modes.number)
    return worst_of(found, modes.number, (modes.gravity, modes.gravity), data_at)


def _without_lowest_pin(width: Floats, system: Any) -> Floats:
    """The half-widths of lengths, 0 for the lowest link: nothing hangs on its lower pin."""
    return np.where(np.arange(system.size) == 0, 0.0, width)


def _refuse_wide(caller: str, name: str, data: Any, width: Any, of: str = "") -> None:
    """Raise a ValueError if a datum that must be positive, or not negative, could leave that range."""
    of = of or name
    if of == "centroid":
        return
    low = data - width
    wrong = low < 0 if of in ("radius_of_gyration", "support_mass") else (low <= 0) & (width > 0)
    if wrong.any():
        k = int(np.flatnonzero(np.atleast_1d(wrong))[0])
        link = f" of links[{k}]" if np.ndim(data) else ""
        size = float(np.broadcast_to(width, np.shape(np.atleast_1d(data))).flat[k])
        raise ValueError(
            f"{caller}: the half-width of {name}{link} must be less than its value {float(np.atleast_1d(data)[k]):g}, "
            f"got {size:g}"
        )


def _family(
    system: Any, gravity: float, widths: dict[str, Floats], data: dict[str, Any], moved: dict[str, Moved]
) -> tuple[Family, list[Any]]:
    """The systems in the box, and for each datum its name, the indices of its factors, and what they are multiplied by."""
    base = data_of(system, gravity)
    links = (base.size - 2) // 4
    follows, low, nominal, high, names = list[Any](), list[float](), list[float](), list[float](), list[Any]()
    force = system._force(gravity)
    for name, width in widths.items():
        value = np.atleast_1d(np.asarray(data[name], float))
        half, where = np.broadcast_to(width, value.shape), []
        for k, (x, w) in enumerate(zip(value.tolist(), half.tolist(), strict=True)):
            row = np.zeros(base.size, bool)
            if name == "length_in_proportion":
                row[[links + k, 2 * links + k, 3 * links + k]] = True
            else:
                row[_COLUMNS.index(name) * links + k if name in _COLUMNS else _OF_SUPPORT[name]] = True
            where.append(len(low))
            own = name not in ("length", "length_in_proportion")  # the factor is the datum itself, which may be 0
            if own:
                base[row] = 1 / force if name == "stiffness" else 1.0
            ends = (x - w, x, x + w) if own else (1 - w / x, 1.0, 1 + w / x)
            for column, end in zip((low, nominal, high), ends, strict=True):
                column.append(end)
            follows.append(row)
        factor: Any = value if name in ("length", "length_in_proportion") else 1.0
        at: Any = np.array(where)
        given = (name, at, factor, np.array(low)[at], np.array(high)[at])
        names.append(given if np.ndim(data[name]) else (name, at[0], 1.0, given[3][0], given[4][0]))
    for path, each in moved.items():
        row = np.zeros(base.size, bool)
        there = np.flatnonzero(np.broadcast_to(np.asarray(each.factor) != 0, links))
        if each.name in _OF_SUPPORT:
            row[_OF_SUPPORT[each.name]] = True
        for name in _COLUMNS[1:] if each.name == "length_in_proportion" else (each.name,):
            if name in _COLUMNS:
                row[_COLUMNS.index(name) * links + there] = True
        if each.present == 0:  # the factor is the datum itself
            base[row] = 1.0
        scale = each.present or 1.0
        place, nominal_of = len(low), each.present / scale
        for numbers, end in zip((low, nominal, high), (-1, 0, 1), strict=True):
            numbers.append(nominal_of + end * each.width / abs(scale))
        follows.append(row)
        names.append((path, place, scale, low[place], high[place]))
    ends_of = [np.array(column) for column in (low, nominal, high)]
    wide = np.where(ends_of[2] > ends_of[0], 4 * EPS * np.abs(ends_of[1]), 0.0)  # of rounding
    made = np.array(follows, bool).reshape(-1, base.size)
    return Family(base, made, ends_of[0] - wide, ends_of[1], ends_of[2] + wide), names


def _worst_of_cord(caller: str, modes: Modes, widths: dict[str, Floats], data: dict[str, Any]) -> WorstCase:
    """The worst case of a cord; docs/theory/derivatives.md has the laws."""
    system, held = modes.system, modes.system._is_held
    cord = system.system if held else system
    if np.max(widths.get("exponent", 0.0)) > 0:
        raise ValueError(f"{caller}: worst has no proof for the exponent of a cord; leave exponent or worst out")
    if cord._particles or (not held and cord._compiled.has_bob):
        part = "point masses" if cord._particles else "a bob"
        raise ValueError(f"{caller}: worst has no proof for a cord with {part}; leave worst out, or cut it into links")
    half = {name: float(np.max(widths.get(name, 0.0))) for name in data}
    ends = {name: (float(x) - half[name], float(x) + half[name]) for name, x in data.items() if name != "masses"}
    if held and not system.weightless:
        heaviest = ends["mass"][1] * (modes.gravity if cord.by_mass else 1.0)
        if not ends["tension"][0] > heaviest:
            what = f"the least tension within the half-widths must exceed the greatest weight {heaviest:.6g}"
            raise ValueError(f"{caller}: {what}, or the lower part is slack, got {ends['tension'][0]:.6g}")
    rows = _held_cord if held else _hung_cord
    found = rows(system, modes, ends)

    def data_at(end: Extreme) -> dict[str, Any]:
        known = dict(zip(_OF_CORDS, end.factors, strict=True))
        return {name: known[name] for name in widths}

    return worst_of(found, modes.number, (modes.gravity, modes.gravity), data_at)


_OF_CORDS = ("length", "mass", "tip_mass", "tension")


def _hung_cord(cord: Any, modes: Modes, ends: dict[str, tuple[float, float]]) -> list[tuple[Extreme, Extreme]]:
    """Heights are proportional to the length, and depend on the ratio of tip to mass."""
    (short, long), (light, heavy), tip = ends["length"], ends["mass"], ends["tip_mass"]
    least, most = tip[0] / heavy, tip[1] / light
    parts = np.geomspace(least, most, _PARTS + 1) if 0 < least < most else np.array([least])
    data = cord._state()
    first, size = int(modes.number[0]), len(modes)
    state = [data._replace(weight=1.0, tip=float(ratio)) for ratio in parts]
    modes_of = [_core.cord_modes(type(cord)._from_state(one)._compiled, first, size, None, None, None, None) for one in state]
    heights = np.array([each.conical_height for each in modes_of])
    errors = 1 + np.maximum(np.array([each.error_bound for each in modes_of]), _LEAST_ERROR)
    found = []
    for k in range(size):
        column, error, pair = heights[:, k], errors[:, k], list[Extreme]()
        for side, length in ((-1, short), (1, long)):
            best = int((side * column).argmax())
            bound = side * (side * column * error**side).max()
            if len(parts) > 1 and first + k > 1:  # the first height rises with the ratio
                ratio = parts[1:] / parts[:-1]
                bounds = column[1:] * error[1:] * ratio if side > 0 else column[:-1] / (error[:-1] * ratio)
                bound = bounds.max() if side > 0 else bounds.min()
            q = float(parts[best])  # a mass and a tip with this ratio
            weight = min(max(tip[0] / q, light), heavy) if q else light
            factor = length / data.length
            factors = np.array([length, weight, q * weight, math.nan])
            pair.append(Extreme(float(bound * factor), float(column[best] * factor), factors, len(parts)))
        found.append((pair[0], pair[1]))
    return found


def _held_cord(held: Any, modes: Modes, ends: dict[str, tuple[float, float]]) -> list[tuple[Extreme, Extreme]]:
    """Heights rise with mass and length and fall with the tension: the extremes are at two corners."""
    pairs = []
    for k, other in ((0, 1), (1, 0)):
        length, mass, tension = ends["length"][k], ends["mass"][k], ends["tension"][other]
        data = held.system._state()
        cord = type(held.system)._from_state(data._replace(weight=mass))
        one = held._between_its_ends(cord, None, tension)
        under = one._under(modes.gravity)
        found = _core.held_modes(under, int(modes.number[0]), len(modes), None, None, None, None, modes.gravity)
        heights = found.conical_height * (length / data.length)
        factors = np.array([length, mass, math.nan, tension])
        side = 1 if k else -1
        bounds = heights * (1 + np.maximum(found.error_bound, _LEAST_ERROR)) ** side
        pairs.append([Extreme(float(bound), float(x), factors, 1) for bound, x in zip(bounds, heights, strict=True)])
    return list(zip(*pairs, strict=True))

