# SPDX-License-Identifier: GPL-3.0-or-later
"""From the table [ask] of a scene to the arguments of `revchain.modes`, and errors with the key."""

from __future__ import annotations

import math
from typing import Any

from msgspec import UNSET, UnsetType, json

from ..systems.chain import Chain
from .ask_tables import Ask, AskShapes
from .chain import Numbers
from .error import SceneError

DEFAULT_MODES = 10

_OF_HANGING_CHAINS = ("conical_height", "angular_speed", "rtol", "certify", "precision", "method")


def asked(ask: Ask, chain: Chain, gravity: float, source: str, rigged: bool) -> dict[str, Any]:
    """What differs from the defaults of `revchain.modes`, checked; `source` is what errors name."""
    if rigged:
        return _asked_of_rig(ask, gravity, source)
    arguments = {"gravity": gravity, **_selection(ask, chain, source)}
    if ask.rtol is not UNSET:
        if not math.isfinite(ask.rtol):
            raise SceneError(source, "ask.rtol", f"must be finite, got {ask.rtol}")
        arguments["rtol"] = ask.rtol
    if ask.certify:
        arguments["certify"] = True
    for name, default in (("precision", "double"), ("method", "auto")):
        if (word := getattr(ask, name)) != default:
            arguments[name] = word
    if ask.precision != "double" and ask.method not in ("auto", "bisection"):
        raise SceneError(source, "ask.precision", f'method = "{ask.method}" goes with "double" only')
    return arguments


def asked_of_held(ask: Ask, chain: Chain, source: str) -> int:
    """How many modes of a chain held at both ends, slowest first; what would be passed over is refused."""
    reason = "is for a chain that hangs"
    _refuse_any(("first", *_OF_HANGING_CHAINS), ask, Numbers(source, "ask"), f"{reason}: held at both ends give modes")
    if not isinstance(ask.shapes, UnsetType):
        _refuse_any(("sense", "any_posture"), ask.shapes, Numbers(source, "ask.shapes"), reason)
    most = max(chain.size - 1, 1)
    return most if ask.modes == "all" else DEFAULT_MODES if isinstance(ask.modes, UnsetType) else ask.modes


def _asked_of_rig(ask: Ask, gravity: float, source: str) -> dict[str, Any]:
    """The modes of each sense of rotation, by their numbers: how many there are is found with them."""
    reason = "is for a chain alone: with a support, standing links, flywheels or a fluid give modes"
    _refuse_any(_OF_HANGING_CHAINS, ask, Numbers(source, "ask"), reason)
    first = 1 if ask.first is UNSET else ask.first
    count = DEFAULT_MODES if ask.modes is UNSET else ask.modes
    return {"gravity": gravity, "first": first, "count": count}


def _refuse_any(names: tuple[str, ...], table: Ask | AskShapes, numbers: Numbers, reason: str) -> None:
    """Refuse keys of a table that are not left at their defaults."""
    defaults = type(table)()
    for name in names:
        if (value := getattr(table, name)) != getattr(defaults, name):
            raise numbers.refuse(name, f"{reason}, got {_as_written(value)}")


def _as_written(value: Any) -> str:
    """As a scene file has it."""
    return f"{value}" if isinstance(value, float) else json.encode(value).decode()  # JSON has no infinity


def _selection(ask: Ask, chain: Chain, source: str) -> dict[str, Any]:
    """Which modes."""
    windows = [name for name in ("conical_height", "angular_speed") if getattr(ask, name) is not UNSET]
    numbers = [name for name in ("modes", "first") if getattr(ask, name) is not UNSET]
    if len(windows) > 1 or (windows and numbers):
        raise SceneError(source, f"ask.{windows[0]}", f"does not go with {[*numbers, *windows[1:]][0]}")
    if windows:
        name = windows[0]
        given = getattr(ask, name)
        if name == "conical_height":
            numbers_of = Numbers(source, "ask")
            low, high = (numbers_of.value(name, end, "length", "not negative", finite=False) for end in given)
        else:
            low, high = given
        if not low < high:
            raise SceneError(source, f"ask.{name}", f"its low end must lie below its high end, got {list(given)}")
        return {name: (low, high)}
    available = chain.mode_count
    if ask.first is UNSET:
        if ask.modes == "all":
            return {"count": "all"}
        if ask.modes is UNSET:
            return {"count": min(DEFAULT_MODES, available)}
        if ask.modes > available:
            raise SceneError(source, "ask.modes", f"must be at most {available}, got {ask.modes}")
        return {"count": ask.modes}
    left = available - ask.first + 1
    if left < 1:
        raise SceneError(source, "ask.first", f"must be at most {available}, got {ask.first}")
    count = left if ask.modes == "all" else min(DEFAULT_MODES, left) if ask.modes is UNSET else ask.modes
    if count > left:
        raise SceneError(source, "ask.modes", f"must be at most {left} from number {ask.first} on, got {count}")
    return {"first": ask.first, "count": count}
