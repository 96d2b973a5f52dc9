# SPDX-License-Identifier: GPL-3.0-or-later
"""From the tables of a scene to the calls for shapes and motions, and errors with the key."""

from __future__ import annotations

from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType

from ..questions.held import HeldShape, HeldShapes, TautModes, held_shapes, taut_modes
from ..questions.response import response, small_oscillation
from ..questions.shapes import steady_shapes
from ..results.motions import Response, SmallOscillation
from ..results.shapes import SteadyShapes
from ..systems.chain import Chain
from ..systems.numbers import Floats, one_positive
from ..systems.rig import Rig
from .ask_tables import AskResponse, AskShapes, AskSwing, Held
from .chain import Numbers
from .error import SceneError

QUANTITY = {"angular_speed": "angular_speed", "conical_height": "length"}


def the_speed(table: AskShapes | UnsetType, source: str) -> dict[str, float]:
    """The one speed at which shapes are asked for, as a keyword argument; empty where the scene says none."""
    if isinstance(table, UnsetType):
        return {}
    numbers = Numbers(source, "ask.shapes")
    name, value = _one_of_two(table, numbers)
    return {name: numbers.value(name, value, QUANTITY[name], "positive")}


def _one_of_two(table: AskShapes | AskResponse, numbers: Numbers) -> tuple[str, Any]:
    """Which of the two keys says the speed, and what it says."""
    given = [name for name in QUANTITY if getattr(table, name) is not UNSET]
    if len(given) != 1:
        raise numbers.refuse("", "give either angular_speed or conical_height")
    return given[0], getattr(table, given[0])


def shapes_of(
    hung: Chain | Rig,
    held: Held | UnsetType,
    table: AskShapes | UnsetType,
    changed: dict[str, Any],
    gravity: float,
    source: str,
) -> SteadyShapes | HeldShapes[HeldShape]:
    """All steady shapes at the speed asked; between two held ends those found."""
    asked = AskShapes() if table is UNSET else table
    speed = {name: changed.pop(name) for name in QUANTITY if name in changed} or the_speed(table, source)
    if not speed:
        raise SceneError(source, "ask.shapes", "is missing: say at which angular_speed or conical_height")
    if held is UNSET:
        if "half_waves" in changed:
            raise SceneError(source, "ask.shapes", "half_waves is for a chain held at both ends")
        arguments = {"sense": asked.sense, "hanging_only": not asked.any_posture, **changed}
        return steady_shapes(hung, **speed, gravity=gravity, **arguments)
    if isinstance(hung, Rig):
        raise SceneError(source, "held", "does not go with a support, standing links, flywheels or a fluid")
    ends = ends_of(held, hung, source)
    if "span" not in ends:
        raise SceneError(source, "held.span", "is missing: a chain drawn straight has no shape but the straight one")
    most = changed.pop("half_waves", asked.half_waves)
    if changed:
        raise SceneError(source, "held", f"{next(iter(changed))} is for chains that hang")
    if held.weightless:
        if "conical_height" in speed:
            raise SceneError(source, "held.weightless", "needs angular_speed, not conical_height")
        masses = Chain(
            weight=hung.weight / gravity,
            length=hung.length,
            centroid=hung.centroid,
            radius_of_gyration=hung.radius_of_gyration,
        )
        return held_shapes(masses, span=ends["span"], **speed, gravity=0.0, most_half_waves=most)
    return held_shapes(hung, span=ends["span"], **speed, gravity=gravity, most_half_waves=most)


def ends_of(held: Held, chain: Chain, source: str) -> dict[str, float]:
    """Span or tension, in m or N."""
    numbers = Numbers(source, "held")
    if (held.span is UNSET) == (held.tension is UNSET):
        raise numbers.refuse("", "give either span or tension")
    if held.span is UNSET:
        assert held.tension is not UNSET
        if held.weightless:
            raise numbers.refuse(
                "weightless", "goes with span: whirl speeds of a straight chain are in terms of gravity"
            )
        return {"tension": numbers.value("tension", held.tension, "weight", "positive")}
    span = numbers.value("span", held.span, "length", "positive")
    if not span < chain.total_length:
        raise numbers.refuse("span", f"must be less than the length, {chain.total_length:g} m, got {span:g}")
    return {"span": span}


def taut_modes_of(held: Held, chain: Chain, count: int, source: str) -> TautModes:
    """Whirl speeds of the straight chain under the tension said."""
    ends = ends_of(held, chain, source)
    if "tension" not in ends:
        raise SceneError(
            source,
            "held.span",
            "leaves the chain slack, without modes of small amplitude: ask for its shapes, or give tension",
        )
    return taut_modes(chain, tension=ends["tension"], count=count)


def response_of(
    hung: Chain | Rig, table: AskResponse | UnsetType, changed: dict[str, Any], gravity: float, source: str
) -> Response:
    """The response at the speeds asked."""
    asked = AskResponse() if table is UNSET else table
    steps = changed.pop("steps", asked.steps)
    drive = {name: changed.pop(name) for name in QUANTITY if name in changed} or the_speeds(table, hung, source)
    if not drive:
        raise SceneError(source, "ask.response", "is missing: say at which angular_speed or conical_height")
    speeds: dict[str, Any] = {name: _spread(ends, steps) for name, ends in drive.items()}
    return response(hung, **speeds, gravity=gravity, **changed)


def the_speeds(table: AskResponse | UnsetType, hung: Chain | Rig, source: str) -> dict[str, list[float]]:
    """One speed or the two ends of a range, as a keyword argument."""
    if isinstance(table, UnsetType):
        return {}
    numbers = Numbers(source, "ask.response")
    name, ends = _one_of_two(table, numbers)
    either_sense = name == "angular_speed" and isinstance(hung, Rig) and bool(hung.momentum.any())
    found = [numbers.value(name, x, QUANTITY[name], "any" if either_sense else "positive") for x in ends]
    if 0 in found:
        raise numbers.refuse(name, "must not be 0")
    return {name: found}


def swing_of(
    chain: Chain, table: AskSwing | UnsetType, changed: dict[str, Any], gravity: float, source: str
) -> SmallOscillation:
    """The chain let go from where the scene says."""
    if table is UNSET:
        raise SceneError(source, "ask.swing", "is missing: say with offset where the chain is let go")
    until, steps = changed.pop("until", None), changed.pop("steps", table.steps)
    offset, velocity, last = start_of(table, chain, source)
    if until is not None:
        last = one_positive("revchain.Scene.small_oscillation", "until", until)
    times = np.linspace(0.0, last, steps + 1)
    return small_oscillation(chain, offset, velocity, times, gravity=gravity, **changed)


def start_of(table: AskSwing, chain: Chain, source: str) -> tuple[Floats, Floats | None, float]:
    """Offsets, velocities, and the last time."""
    numbers = Numbers(source, "ask.swing")

    def at_pins(name: str, quantity: str) -> Floats:
        given = getattr(table, name)
        if len(given) != chain.size:
            raise numbers.refuse(
                name, f"must have a number for each of the {chain.size} pins that move, got {len(given)}"
            )
        return np.array([numbers.value(f"{name}[{i}]", x, quantity, "any") for i, x in enumerate(given)])

    velocity = None if table.velocity is UNSET else at_pins("velocity", "speed")
    return at_pins("offset", "length"), velocity, numbers.value("until", table.until, "time", "positive")


def _spread(ends: list[float], steps: int) -> Floats:
    return np.asarray(ends[0]) if len(ends) == 1 else np.linspace(ends[0], ends[1], steps)
