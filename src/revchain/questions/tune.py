# SPDX-License-Identifier: GPL-3.0-or-later
"""Inverse questions: which value of a datum gives a mode the speed wanted."""

from __future__ import annotations

import re
from contextlib import suppress
from typing import Any

import numpy as np

from .. import _core
from ..results.tuned import Tuned
from ..systems.chain import Chain, compiled
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, Floats, count, exactly_one, one_positive, real, shown
from ..systems.rig import Rig, Support
from .modes import modes
from .refuse import refuse_other

_PLACE = "revchain.tune"
_DATA = ("mass", "weight", "length", "centroid", "radius_of_gyration", "length_in_proportion")
_PATHS = '"length", "links[0].mass", "support.stiffness" or "flywheels[0].momentum"'


def tune(
    system: Chain | Rig | Cord,
    *,
    vary: str = "length",
    mode: int = 1,
    angular_speed: float | None = None,
    conical_height: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    between: tuple[float, float] | None = None,
) -> Tuned:
    """Find the value of one datum that gives a mode the speed wanted.

    Parameters
    ----------
    system : Chain, Rig or Cord
        The system as it is.
    vary : str
        The path to the datum that may change, all else held. ``"length"``: the length of a whole chain or cord, which
        keeps its proportions. Of a chain also one link's datum, ``"links[k].NAME"`` with k from 0 for the lowest and
        NAME ``mass`` (``weight``), ``length`` (centre of gravity and radius of gyration stay where they are),
        ``length_in_proportion`` (they grow with it, as of a point mass's thread), ``centroid`` or
        ``radius_of_gyration``. Of a rig ``"support.stiffness"`` or ``"flywheels[k].momentum"``.
    mode : int
        Number of the mode, from 1 for the slowest; of a rig among those of the direction of the speed wanted.
    angular_speed : float, optional
        The whirl speed wanted, rad/s; of a rig of either sign.
    conical_height : float, optional
        Instead: the conical height wanted, m.
    gravity : float, optional
        In m/s^2; standard gravity if left out.
    between : (low, high), optional
        For one link's datum: where to look. Left out: from a thousandth to a thousand times the present mass (the
        whole chain's for a massless link) or length; for centroid and radius of gyration from 0 to the
        link's length or the present value.

    Returns
    -------
    Tuned
        With the new system, and the bound of the value's error. Cost for a link O(N) for each of some 10 to 60
        counts; of a mass some 10 to 100 modes.

    Raises
    ------
    ValueError
        Unless exactly one of speed and height is given; for numbers out of range, another path, a range in which the
        link would stand rather than hang; for what is held at both ends.
    TypeError
        If `system` is none of the four systems.

    Notes
    -----
    At a given height the chain is a spring at each pin of the link. The values of a centroid or a length are
    then roots of a quadratic, those of a radius of gyration or a length in proportion of a linear
    equation, and proved counts say which are this mode's and how accurate they are. Heights rise with a
    length in proportion and a radius of gyration; with others they may turn. A mass bears on every
    link above; there the search moves in steps that can pass no value, since a height never changes faster
    than the mass, in ratio. Of a rig there is one stiffness, and one momentum of a link, for each speed, formed in
    double-double to 1e-15; the modes of the new rig tell which mode it is.

    Examples
    --------
    How heavy must the lower of two point masses be for their second whirl speed to be 4 rad/s?

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
    """
    refuse_other(_PLACE, system, (Chain, Rig, Cord), {Held: "change its system, and ask modes or steady_shapes again"})
    if not isinstance(vary, str):
        raise ValueError(f"{_PLACE}: vary must be a path such as {_PATHS}, got {shown(vary)}")
    number = count(_PLACE, "mode", mode)
    g = one_positive(_PLACE, "gravity", gravity)
    if isinstance(system, Rig):
        return _of_rig(system, vary, number, angular_speed, conical_height, g, between)
    name, value = exactly_one(_PLACE, conical_height=conical_height, angular_speed=angular_speed)
    if vary == "length":
        if between is not None:
            raise ValueError(f"{_PLACE}: between is for the datum of one link; a length has one value, got {shown(between)}")
        return _length(system, number, name, value, g)
    link, datum = _link(system, vary)
    low, high = (None, None) if between is None else _ends(between, datum)
    of_core = "weight" if datum in ("mass", "weight") else datum
    height, speed = (value, None) if name == "conical_height" else (None, value)
    core = compiled(_PLACE, system)  # type: ignore[arg-type]
    status, present, tuned, bound, values, complete, low, high, lowest, highest, found = _core.tune(
        core, number, link, of_core, height, speed, g, low, high
    )
    return Tuned._made(
        None,
        status=status,
        system=None if found is None else Chain._wrap(found, system.by_mass, system.names),  # type: ignore[union-attr]
        value=None if found is None else tuned,
        error_bound=None if found is None else bound,
        values=values,
        complete=complete,
        present=present,
        between=(low, high),
        reachable=(lowest, highest) if status != "found" else None,
        vary=vary,
    )


def _link(system: Chain | Cord, vary: str) -> tuple[int, str]:
    """Index and datum of a path such as ``links[0].mass``."""
    path = re.fullmatch(r"links\[(\d+)\]\.(\w+)", vary)
    if path is None or path[2] not in _DATA or not isinstance(system, Chain):
        known = '"length"' if isinstance(system, Cord) else f'"length" or "links[k].NAME", NAME one of {", ".join(_DATA)}'
        raise ValueError(f"{_PLACE}: vary must be {known}, got {shown(vary)}")
    link, datum = int(path[1]), path[2]
    if link >= system.size:
        raise ValueError(f"{_PLACE}: vary names links[{link}], and the highest is links[{system.size - 1}]")
    if datum in ("mass", "weight") and (datum == "mass") != system.by_mass:
        other = "mass" if system.by_mass else "weight"
        raise ValueError(f"{_PLACE}: the chain was given by {other}: vary its {other}, got {shown(vary)}")
    return link, datum


def _length(system: Chain | Cord, mode: int, name: str, value: float, gravity: float) -> Tuned:
    """Heights are as the length."""
    found = modes(system, 1, first=mode)
    wanted = value if name == "conical_height" else gravity / value**2
    factor = wanted / float(found.conical_height[0])
    if isinstance(system, Cord):
        present = system.length
        tuned: Any = _longer_cord(system, factor)
    else:
        present = system.total_length
        size, heavy, length, centroid, *rest = system._compiled.__getstate__()
        state = ((size, heavy, factor * length, factor * centroid, *rest), system.by_mass, system.names)
        tuned = Chain._from_state(state)
    length = factor * present
    return Tuned._made(
        None,
        status="found",
        system=tuned,
        value=length,
        error_bound=length * (float(found.error_bound[0]) + 2.0**-50),
        values=np.array([length]),
        complete=True,
        present=present,
        between=(0.0, np.inf),
        reachable=None,
        vary="length",
    )


def _longer_cord(cord: Cord, factor: float) -> Cord:
    length, weight, tip, kept, by_mass = cord._state()
    if not isinstance(kept, float):
        pieces = kept[1].copy()
        pieces[:, :2] *= factor
        pieces[:, 3:] /= factor
        kept = (factor * length, pieces)
    return Cord._from_state((factor * length, weight, tip, kept, by_mass))


def _of_rig(
    rig: Rig,
    vary: str,
    mode: int,
    angular_speed: float | None,
    conical_height: float | None,
    gravity: float,
    between: Any,
) -> Tuned:
    if between is not None:
        raise ValueError(f"{_PLACE}: between is for the datum of one link of a Chain, got {shown(between)}")
    if (angular_speed is None) == (conical_height is None):
        raise ValueError(f"{_PLACE}: give exactly one of conical_height and angular_speed")
    if angular_speed is not None:
        speed = real(_PLACE, "angular_speed", angular_speed)
        if not np.isfinite(speed) or speed == 0:
            raise ValueError(f"{_PLACE}: angular_speed must be finite and not 0, got {speed:g}")
    else:
        speed = float(np.sqrt(gravity / one_positive(_PLACE, "conical_height", conical_height)))
    path = re.fullmatch(r"flywheels\[(\d+)\]\.momentum", vary)
    force = rig._force(gravity)
    value: float | None = None
    if vary == "support.stiffness":
        present, tuned = rig.support.stiffness, rig
        with suppress(ValueError):  # none is positive
            value = force * _core.stiffness_for_speed(rig._under(gravity), speed, gravity)
            tuned = _with_stiffness(rig, value)
    elif path is not None and int(path[1]) < rig.size:
        link, kept = int(path[1]), force * rig._momentum(gravity)
        present, tuned = float(kept[link]), rig
        with suppress(ValueError):  # none is finite
            value = force * _core.momentum_for_speed(rig._under(gravity), link, speed, gravity)
            tuned = _with_momentum(rig, np.where(np.arange(rig.size) == link, value, kept), gravity)
    else:
        known = '"support.stiffness" or "flywheels[k].momentum"'
        raise ValueError(f"{_PLACE}: vary must be {known} for a Rig of {rig.size} links, got {shown(vary)}")
    found = modes(tuned, mode, gravity=gravity)
    if mode > max(1, *found.available):
        raise ValueError(f"{_PLACE}: mode must be from 1 to {max(found.available)}, got {mode}")
    same = (found.number == mode) & (np.sign(found.angular_speed) == np.sign(speed))
    if not found.has_momentum:
        same = found.number == mode
    is_met = value is not None and bool(np.isclose(np.abs(found.angular_speed[same]), abs(speed), rtol=1e-9).any())
    return Tuned._made(
        None,
        status="found" if is_met else "no_value",
        system=tuned if is_met else None,
        value=value if is_met else None,
        error_bound=None,
        values=np.array([value] if is_met else []),
        complete=True,
        present=present,
        between=(-np.inf if path else 0.0, np.inf),
        reachable=None,
        vary=vary,
    )


def _with_momentum(rig: Rig, momentum: Floats, gravity: float) -> Rig:
    moment = 0.0 if rig.flywheels is None else rig.flywheels._about(gravity)[1]
    _, support, _, *rest = rig._state()
    return Rig._from_state((rig.chain, support, {"momentum": momentum, "axial_moment": moment}, *rest))


def _with_stiffness(rig: Rig, stiffness: float) -> Rig:
    _, support, *rest = rig._state()
    return Rig._from_state((rig.chain, {**Support(**support)._given, "stiffness": stiffness}, *rest))


def _ends(between: Any, datum: str) -> tuple[float, float]:
    try:
        low, high = between
    except (TypeError, ValueError):
        raise ValueError(f"{_PLACE}: between must be a pair (low, high), got {shown(between)}") from None
    return real(_PLACE, f"{datum} (each end of between)", low), real(_PLACE, f"{datum} (each end of between)", high)
