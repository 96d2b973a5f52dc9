# SPDX-License-Identifier: GPL-3.0-or-later
"""The inverse question: the value of a datum that gives a mode a wanted speed."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise
from typing import Any

import numpy as np

from .. import _core
from ..results.tuned import Tuned
from ..systems.chain import Chain, compiled
from ..systems.cord import Cord
from ..systems.datum import Datum, datum_at, gravity_datum
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, count, exactly_one, height_of, one_positive, real, shown
from ..systems.rig import Rig
from ..systems.system import System
from .modes import modes, straight
from .refuse import no_system
from .shapes import shape_on_branch
from .speeds import speeds

_CALLER = "revchain.tune"
_PATHS = '"length", "links[load].mass", "links[0].mass", "support.stiffness" or "gravity"'
_SEARCHED = 65  # values


def tune(
    system: Chain | Rig | Cord | Held,
    *,
    vary: str = "length",
    mode: int = 1,
    angular_speed: float | None = None,
    conical_height: float | None = None,
    top_tension: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    between: tuple[float, float] | None = None,
) -> Tuned:
    """Return the value of one datum for which a mode has a given speed.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The present system. A system held at a span needs `top_tension`.
    vary : str
        Path to the datum that may change; all others are constant:

        - ``"length"``: length of the whole chain or cord, which keeps its proportions; also in a rig or a held system.
        - ``"mass"`` (``"weight"``): mass of the whole chain in a rig or a held system, or of a cord without its tip and its
          point masses.
        - ``"links[k].NAME"``: datum of a link of a chain (also in a rig or a held system); k is the name of the link
          (``"links[hook block].length"``) or its index, from 0 for the first one listed (see `Chain.order`). NAME is
          ``mass`` (``weight``), ``length`` (of a point mass at its lower pin and of a uniform rod with centre of gravity and
          radius of gyration in proportion, as in a scene; of another body these are constant), ``length_in_proportion``
          (they grow with it, as for a point mass on a thread), ``centroid`` or ``radius_of_gyration``.
        - for a rig also ``"support.stiffness"``, ``"support.mass"``, ``"flywheels[k].momentum"``, and the data given for
          flywheels and displaced fluid: ``"flywheels[k].spin"``, ``.mass``, ``.radius_of_gyration``, ``.axial_moment``,
          ``"displaced[k].mass"``, ``.added_mass``, ``.centroid``, ``.radius_of_gyration``. If the rig has such parts, also
          ``"support.damping"``, ``"pins[k].stiffness"``, ``"pins[k].damping"`` and ``"links[k].drag"``.
        - for a cord also ``"tip_mass"``; for a held system the one given of ``"tension"`` and ``"span"``.
        - ``"gravity"``: not a datum of the system; needs `angular_speed`.
    mode : int
        Number of the mode, from 1 for the slowest; for a rig with flywheels among those of the direction of the speed; at a
        span the number of half waves.
    angular_speed : float, optional
        Required whirl speed, rad/s; for a rig it may be negative.
    conical_height : float, optional
        Required conical height, m, instead of `angular_speed`.
    top_tension : float, optional
        For a system held at a span: required tension at the upper end at that speed (see `steady_shape`), in N or the unit
        of the weights.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out.
    between : (low, high), optional
        Range of the search, if one is needed. If left out, a wide range about the present value, see `Tuned.between`.

    Returns
    -------
    Tuned
        The value and the new system. Cost: for a link, 10 to 60 counts of O(N) each; for a mass the time of 10 to 25 modes
        for each link; for other searches that of some hundred modes.

    Raises
    ------
    ValueError
        If not exactly one of speed and height is given; if a number is out of its range, the path is unknown, a link would
        be inverted everywhere in the range, or there is no such mode; if a system held at a span comes without
        `top_tension`, or another system with it; if `between` is given for a datum that is not searched for (see Notes); if
        gravity is varied for a height or at a span.
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.

    Notes
    -----
    A link of a chain: proved counts select the values of this mode and bound their errors. The search for a mass takes steps
    that cannot miss a value. Its range leaves out masses with which a link would be inverted.

    Gravity has one value for a chain, a cord and a held system given by weight: speeds rise with its root. The length has
    one value for a chain, a cord and, under a tension, a held system with firm ends: heights are proportional to it.

    A rig without springs at pins and damping has at most one stiffness of its support, one momentum and one spin of a link
    for each speed, computed in double-double to 1e-15; the modes of the new rig give the number of the mode.

    Other data of rigs, cords and held systems are searched: the speed is computed at 65 values and at extrema between them,
    and each pair of neighbours that encloses the wanted speed is bisected. The error bound is that of two values whose
    speeds, with their own bounds, enclose the wanted one. The search may miss values: `complete` is True only if it finds
    the tension or a mass of a held system under a tension, which has at most one value for each speed. At a span with
    `top_tension` the speed is that of `steady_shape`, the fastest on the branch; its error is an estimate.

    Examples
    --------
    The mass of the lower of two point masses that gives a second whirl speed of 4 rad/s:

    >>> import revchain as rc
    >>> chain = rc.Chain(mass=[1.0, 3.0], length=1.0)
    >>> tuned = rc.tune(chain, mode=2, vary="links[0].mass", angular_speed=4.0, gravity=9.81)
    >>> round(tuned.value, 12)
    0.528051454425
    >>> rc.modes(tuned.system, gravity=9.81).angular_speed.round(12)[1]
    np.float64(4.0)
    >>> round(rc.tune(chain, angular_speed="30 rpm").value, 6)
    1.324829
    >>> rig = rc.Rig(rc.Chain(mass=1.0, length=1.0))
    >>> rc.tune(rig, vary="flywheels[0].momentum", angular_speed=2.0, gravity=10.0).value
    -3.0
    >>> round(rc.tune(rc.Held(chain, tension=60.0), vary="tension", angular_speed="60 rpm").value, 9)
    73.927601407

    A skipping rope turns twice a second; how heavy must it be to pull with 9 N?

    >>> rope = rc.Held(rc.Cord(2.6, mass=0.15), span=1.2)
    >>> round(rc.tune(rope, vary="mass", angular_speed="2 Hz", top_tension=9.0).value, 6)
    0.173584
    """
    if not isinstance(system, System):
        raise no_system(_CALLER, system)
    of: Any = system
    if not isinstance(vary, str):
        raise ValueError(f"{_CALLER}: vary must be a path such as {_PATHS}, got {shown(vary)}")
    number = count(_CALLER, "mode", mode)
    g = one_positive(_CALLER, "gravity", gravity)
    if system._kind == "rig":
        name, value = _of_either_sign(angular_speed, conical_height)
    else:
        name, value = exactly_one(_CALLER, conical_height=conical_height, angular_speed=angular_speed)
    bent = system._is_held and of.span is not None
    if bent and top_tension is None:
        raise ValueError(
            f"{_CALLER}: a system held at a span is bent and has no critical speed; also give top_tension, the "
            "required tension at the upper end"
        )
    if top_tension is not None and not bent:
        raise ValueError(f"{_CALLER}: top_tension is for a system held at a span; leave it out, got {shown(top_tension)}")
    if system._is_held and not bent:
        straight(_CALLER, of, g)
    datum = gravity_datum(system, g) if vary == "gravity" else datum_at(_CALLER, system, vary, g)
    if vary == "gravity" and (bent or name == "conical_height"):
        why = "of a system held at a span" if bent else "for a conical height, which does not depend on it"
        raise ValueError(f"{_CALLER}: gravity cannot be found {why}; give angular_speed, of a system that has modes")
    height, speed = _height_and_speed(name, value, g)
    if system._kind == "chain" and vary not in ("length", "gravity"):
        return _link(of, datum, number, name, value, g, between)
    if bent:
        pull = one_positive(_CALLER, "top_tension", top_tension)
        return _searched(datum, speed, g, between, lambda x: _speed_under(datum.change(x), number, pull, g))
    one: Tuned | None = None
    if vary == "gravity":
        one = _gravity(system, datum, number, speed) if system._fixes_gravity is None else None
    elif system._kind == "rig":
        one = _formed(of, datum, number, speed, g)
    elif vary == "length" and not (system._is_held and not of.is_plain):  # springs keep their stiffness
        one = _length(of, datum, number, height, g)
    if one is None:
        signed = np.array([number if speed > 0 else -number])

        def speed_of(value: float) -> tuple[float, float]:
            found = speeds(_CALLER, datum.change(value), signed, value if vary == "gravity" else g)
            return float(found.speed[0]), float(found.bound[0])

        return _searched(datum, speed, g, between, speed_of)
    if between is not None:
        raise ValueError(f"{_CALLER}: between is for a search, and {vary} has one value; leave it out, got {shown(between)}")
    return one


def _height_and_speed(name: str, value: float, gravity: float) -> tuple[float, float]:
    """The wanted conical height and speed, of which one is given; a ValueError if the other does not fit in a double."""
    if name == "angular_speed":
        return height_of(_CALLER, None, abs(value), gravity), value
    return value, one_positive(_CALLER, "(gravity / conical_height)**0.5", math.sqrt(gravity / value))


def _of_either_sign(speed: Any, height: Any) -> tuple[str, float]:
    if speed is None or height is not None:
        return exactly_one(_CALLER, conical_height=height, angular_speed=speed)
    wanted = real(_CALLER, "angular_speed", speed)
    if not np.isfinite(wanted) or wanted == 0:
        raise ValueError(f"{_CALLER}: angular_speed must be finite and not 0, got {wanted:g}")
    return "angular_speed", wanted


def _link(chain: Chain, datum: Datum, mode: int, name: str, wanted: float, gravity: float, between: Any) -> Tuned:
    """The values of a datum of a link of a chain, by proved counts."""
    low, high = (None, None) if between is None else _ends(between, datum)
    height, speed = (wanted, None) if name == "conical_height" else (None, wanted)
    core, quantity = compiled(_CALLER, chain), datum.quantity.replace("mass", "weight")
    status, present, tuned, bound, values, complete, low, high, lowest, highest, found = _core.tune(
        core, mode, datum.link, quantity, height, speed, gravity, low, high
    )
    return Tuned._made(
        None,
        status=status,
        system=None if found is None else Chain._wrap(found, chain.by_mass, chain.names, chain.order),
        value=None if found is None else tuned,
        error_bound=None if found is None else bound,
        values=values,
        complete=complete,
        present=present,
        between=(low, high),
        reachable=(lowest, highest) if status != "found" else None,
        vary=datum.said,
    )


def _length(system: Chain | Cord | Held, datum: Datum, mode: int, height: float, gravity: float) -> Tuned:
    """The length, to which all heights are proportional, also under a tension."""
    found = modes(system, 1, first=mode, gravity=gravity)
    length = height / float(found.conical_height[0]) * datum.present
    return _one(system, datum, datum.change(length), length, length * (float(found.error_bound[0]) + 2.0**-50))


def _gravity(system: Any, datum: Datum, mode: int, speed: float) -> Tuned:
    """The gravity at which a mode has a speed, if its height does not depend on gravity."""
    found = speeds(_CALLER, system, np.array([mode]), datum.present)
    value = datum.present * (speed / float(found.speed[0])) ** 2
    return _one(system, datum, system, value, value * (2 * float(found.bound[0]) + 2.0**-50))


def _one(system: Any, datum: Datum, tuned: Any, value: float | None, bound: float | None) -> Tuned:
    """The result with the only value that exists, or with none."""
    return Tuned._made(
        None,
        status="no_value" if value is None else "found",
        system=None if value is None else tuned,
        value=value,
        error_bound=bound,
        values=np.array([] if value is None else [value]),
        complete=True,
        present=datum.present,
        between=(-np.inf if datum.floor is None else 0.0, np.inf),
        reachable=None,
        vary=datum.said,
    )


def _formed(rig: Rig, datum: Datum, mode: int, speed: float, gravity: float) -> Tuned | None:
    """The only stiffness, momentum or spin for a speed; None for another datum, and with springs at pins or damping."""
    under, per, link = rig._under(gravity), rig._force(gravity), datum.link
    of: Callable[[], float]
    if datum.path == "support.stiffness":
        of = lambda: per * _core.stiffness_for_speed(under, speed, gravity)  # noqa: E731
    elif datum.quantity == "momentum":
        of = lambda: per * _core.momentum_for_speed(under, link, speed, gravity)  # noqa: E731
    elif datum.quantity == "spin":
        assert rig.flywheels is not None
        inertia = np.broadcast_to(rig.flywheels._inertia, rig.size)[link]
        if not inertia:
            raise ValueError(f"{_CALLER}: flywheels[{link}] has no moment of inertia, so its spin has no effect; vary another")
        of = lambda: gravity / inertia * _core.momentum_for_speed(under, link, speed, gravity)  # noqa: E731
    else:
        return None
    if rig._has_pins:
        return None
    value, tuned = None, rig
    with suppress(ValueError):  # none is finite, or of a stiffness positive
        value = float(of())
        tuned = datum.change(value)
    found: Any = modes(tuned, mode, gravity=gravity)
    if mode > max(1, *found.available):
        raise ValueError(f"{_CALLER}: mode must be from 1 to {max(found.available)}, got {mode}")
    same = found.number == mode
    if found.has_momentum:
        same &= np.sign(found.angular_speed) == np.sign(speed)
    is_met = value is not None and bool(np.isclose(np.abs(found.angular_speed[same]), abs(speed), rtol=1e-9).any())
    return _one(rig, datum, tuned, value if is_met else None, None)


def _speed_under(held: Held, mode: int, tension: float, gravity: float) -> tuple[float, float]:
    """The speed at which the branch of a mode has a tension, and the estimate of its relative error."""
    shape = shape_on_branch(_CALLER, held, mode, "top_tension", tension, gravity)
    return shape.angular_speed, 1e-13 if held.size else 1e-11


def _searched(
    datum: Datum, speed: float, gravity: float, between: Any, speed_of: Callable[[float], tuple[float, float]]
) -> Tuned:
    """The values by bisection between neighbours whose speeds enclose the wanted one."""

    reached: list[float] = []

    def found(value: float) -> tuple[float, float]:
        """Speed divided by the wanted one, less 1, and its bound; a ValueError if the system has no such mode."""
        there, bound = speed_of(value)
        reached.append(there)
        return there / speed - 1, bound * there / speed + 2.0**-52

    low, high = _range(datum) if between is None else _ends(between, datum)
    if between is None and not low < high:
        raise ValueError(f"{_CALLER}: give between, the range of the search: the present value is 0")
    if not -np.inf < low < high < np.inf:
        raise ValueError(f"{_CALLER}: between must be finite, and its high end must exceed the low one, got {low:g} and {high:g}")
    off: dict[float, float] = {}

    def seen(value: float) -> float:
        with suppress(ValueError):
            off[value] = found(value)[0]
        return off.get(value, np.nan)

    for value in _places(datum, low, high):
        seen(value)
    if not off:
        found(datum.present)  # says why
        raise ValueError(f"{_CALLER}: the mode does not exist for any value between {low:g} and {high:g}")
    for before, here, after in list(zip(off, [*off][1:], [*off][2:], strict=False)):
        if off[here] and min(off[before] / off[here], off[after] / off[here]) > 1:  # an extreme near the wanted speed
            _turn(lambda x, sign=np.sign(off[here]): sign * seen(x), before, after)  # type: ignore[misc]
    values = {}
    for left, right in pairwise(sorted(value for value in off if off[value])):
        if off[left] * off[right] < 0:
            with suppress(ValueError):  # a system between two possible ones is impossible
                value, bound = _root(found, left, right, off[left] < 0)
                values[value] = bound
    nearest = min(values, key=lambda x: abs(_scale(datum, x) - _scale(datum, datum.present)), default=None)
    with np.errstate(divide="ignore"):  # a motion that only decays has the speed 0
        heights = gravity / np.array(reached) ** 2
    return Tuned._made(
        None,
        status="undecided" if nearest is None else "found",
        system=None if nearest is None else datum.change(nearest),
        value=nearest,
        error_bound=None if nearest is None else values[nearest],
        values=np.array(sorted(values)),
        complete=datum.one_way and nearest is not None,
        present=datum.present,
        between=(low, high),
        reachable=None if nearest is not None or datum.path == "gravity" else (float(heights.min()), float(heights.max())),
        vary=datum.said,
    )


def _turn(above: Callable[[float], float], left: float, right: float) -> None:
    """Look for the minimum between two values by golden section, until one is below 0."""
    part = (np.sqrt(5) - 1) / 2
    for _ in range(30):
        first, second = right - part * (right - left), left + part * (right - left)
        one, other = above(first), above(second)
        if not (one > 0 and other > 0):
            return
        left, right = (left, second) if one < other else (first, right)


def _root(found: Callable[[float], tuple[float, float]], left: float, right: float, rises: bool) -> tuple[float, float]:
    """A zero between two values, and the bound of its error; a ValueError for a jump without a zero."""
    low, high = left, right
    while low < (middle := 0.5 * (low + high)) < high:
        low, high = (middle, high) if (found(middle)[0] < 0) == rises else (low, middle)
    value = min(low, high, key=lambda x: abs(found(x)[0]))
    if abs(found(value)[0]) > 1e-9:
        raise ValueError("a jump")
    bound = max(high - low, np.spacing(abs(value)))
    while bound < right - left:
        (below, left_bound), (above, right_bound) = found(max(value - bound, left)), found(min(value + bound, right))
        if (-below if rises else below) > left_bound and (above if rises else -above) > right_bound:
            break
        bound *= 2
    return value, float(bound)


def _range(datum: Datum) -> tuple[float, float]:
    """Return the range that a search covers if the caller gives none."""
    if datum.ceiling < np.inf:
        return min(0.0, datum.present), max(datum.ceiling, datum.present)
    floor = datum.floor or 0.0
    there = datum.present - floor if datum.has_scale else datum.typical
    return floor + there / 1000, floor + there * 1000


def _places(datum: Datum, low: float, high: float) -> list[float]:
    """Values from `low` to `high`, evenly spaced (by ratio if possible), and the present one if it is between."""
    if datum.ceiling < np.inf or datum.floor is None or not datum.floor < low:
        places = np.linspace(low, high, _SEARCHED)
    else:
        places = datum.floor + np.geomspace(low - datum.floor, high - datum.floor, _SEARCHED)
        places[[0, -1]] = low, high
    return sorted({*places.tolist(), *([datum.present] if low <= datum.present <= high else [])})


def _scale(datum: Datum, value: float) -> float:
    """A measure of the value that is logarithmic if possible."""
    in_ratio = datum.floor is not None and datum.ceiling == np.inf and datum.has_scale
    return float(np.log(value - datum.floor)) if in_ratio else value  # type: ignore[operator]


def _ends(between: Any, datum: Datum) -> tuple[float, float]:
    try:
        low, high = between
    except (TypeError, ValueError):
        raise ValueError(f"{_CALLER}: between must be a pair (low, high), got {shown(between)}") from None
    ends = [real(_CALLER, f"{datum.quantity} (each end of between)", end) for end in (low, high)]
    return ends[0], ends[1]
