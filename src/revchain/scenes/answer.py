# SPDX-License-Identifier: GPL-3.0-or-later
"""Calls of the functions that answer the tables [ask.…] of a scene."""

from __future__ import annotations

import math
import re
from typing import Any

import numpy as np
from msgspec import UNSET

from .. import _core
from ..questions.branches import branches
from ..questions.explain import explain
from ..questions.modes import find_modes
from ..questions.response import response
from ..questions.shapes import steady_shapes
from ..questions.swing import swing
from ..systems.chain import Chain
from ..systems.held import Held
from ..systems.rig import Rig
from ..systems.system import System
from .ask import DEFAULT_MODES, AskBranches, AskExplain, AskModes, AskResponse, AskShapes, AskSwing, Spread
from .chain import Numbers
from .parse import choice, written
from .tables import Table, fields_of

METHODS = tuple(dict.fromkeys((*_core.METHODS[1:], *_core.MODELS)))
SPEEDS = ("angular_speed", "conical_height", "max_angular_speed", "min_conical_height")
Given = dict[str, Any]


def arguments(question: str, table: Table, system: System | None, numbers: Numbers) -> Given:
    """The keyword arguments of a table; errors are noted.

    If the system was refused (None), only the keys that do not depend on it are checked.
    """
    numbers = numbers.of(f"ask.{question}")
    for field in fields_of(type(table)):
        systems, reason = _ONLY.get((question, field.name), (object, ""))
        value = getattr(table, field.name)
        if system is not None and not isinstance(system, systems) and value != field.default:
            numbers.refuse(field.name, f"is for {reason}, got {written(value)}")
    found: Given = _ARGUMENTS[question](table, system, numbers)
    return found


_ALONE = (Chain, "a chain that hangs from a firm point, with nothing else")
_HANGS = (Chain | Rig, "a chain that hangs")
_ONLY: dict[tuple[str, str], tuple[Any, str]] = {
    **{("modes", name): _ALONE for name in ("precision", "method")},
    ("modes", "certify"): _HANGS,
    ("shapes", "direction"): _HANGS,
    ("branches", "direction"): _HANGS,
    ("shapes", "hanging_only"): _HANGS,
    ("shapes", "max_half_waves"): (Held, "a chain held at both ends"),
}


def _modes(table: AskModes, system: System | None, numbers: Numbers) -> Given:
    windows = [name for name in ("angular_speed", "conical_height") if getattr(table, name) is not UNSET]
    others = [name for name in ("count", "first") if getattr(table, name) is not UNSET] + windows[1:]
    if windows and others:
        numbers.refuse(windows[0], f"does not go with {others[0]}")
    given: Given = {name: getattr(table, name) for name in ("count", "first") if name in others}
    for name in windows:
        low, high = ends = getattr(table, name)
        given[name] = tuple(
            numbers.value(f"{name}[{k}]", end, name, "not negative", finite=False) for k, end in enumerate(ends)
        )
        if given[name][0] >= given[name][1]:
            numbers.refuse(name, f"its low end must lie below its high end, got {written([low, high])}")
    most = None if system is None else system.mode_count
    if most is not None:
        _check_numbers(table, most, numbers)
    if table.rtol is not UNSET:
        given["rtol"] = numbers.value("rtol", table.rtol, "rtol", "not negative")
    given |= {name: getattr(table, name) for name in ("certify",) if getattr(table, name)}
    if table.method is not UNSET:
        given["method"] = table.method
        if table.method not in METHODS:
            numbers.refuse("method", choice(list(METHODS), False, table.method))
    if table.precision != "double":
        given["precision"] = table.precision
        if table.method not in (UNSET, "bisection"):
            numbers.refuse("precision", f'method = "{table.method}" goes with "double" only')
    return given


def _check_numbers(table: AskModes, available: int, numbers: Numbers) -> None:
    """Note an error if the modes asked for do not exist."""
    first = 1 if table.first is UNSET else table.first
    count = 1 if not isinstance(table.count, int) else table.count
    if first > available:
        numbers.refuse("first", f"must be at most {available}, got {first}")
    elif count > available - first + 1:
        after = f" from number {first} on" if first > 1 else ""
        numbers.refuse("count", f"must be at most {available - first + 1}{after}, got {count}")


def _explain(table: AskExplain, system: System | None, numbers: Numbers) -> Given:
    modes = AskModes(count=table.count, first=table.first, rtol=table.rtol)
    given = _modes(modes, system, numbers)
    if given.get("count") == "all":
        there = DEFAULT_MODES if system is None or system._kind != "chain" else system.mode_count or 1
        given["count"] = max(there - given.get("first", 1) + 1, 1)
    return given


def _one_speed(table: Table, names: tuple[str, str], numbers: Numbers) -> tuple[str, Any]:
    """The one of two keys that gives the speed, and its value."""
    given = [name for name in names if getattr(table, name) is not UNSET]
    if len(given) != 1:
        numbers.refuse("", f"give {names[0]} or {names[1]}" + (", not both" if given else ": at which speed"))
        return names[0], UNSET
    return given[0], getattr(table, given[0])


def _shapes(table: AskShapes, system: System | None, numbers: Numbers) -> Given:
    name, value = _one_speed(table, ("angular_speed", "conical_height"), numbers)
    given: Given = {name: numbers.value(name, value, name, "positive")}
    unlike = [field.name for field in fields_of(AskShapes) if getattr(table, field.name) != field.default]
    return given | {name: getattr(table, name) for name in unlike if name not in SPEEDS}


def _response(table: AskResponse, system: System | None, numbers: Numbers) -> Given:
    name, value = _one_speed(table, ("angular_speed", "conical_height"), numbers)
    both_ways = name == "angular_speed" and system is not None and system.has_momentum
    given: Given = {name: _spread(name, value, "any" if both_ways else "positive", numbers)}
    if not np.all(given[name]):
        numbers.refuse(name, "must not be 0")
    if table.support_radius is not UNSET:
        given["support_radius"] = numbers.value("support_radius", table.support_radius, "length", "positive")
    return given


def _spread(name: str, given: Any, sign: str, numbers: Numbers) -> Any:
    """A number, or an array of numbers from a list or a range."""
    if isinstance(given, str) and (ends := re.fullmatch(r"(\S.*?)\s+to\s+(.+)", given)):
        numbers.refuse(name, f'a range is written {{from = "{ends[1]}", to = "{ends[2]}"}}, got "{given}"')
        return np.nan
    if isinstance(given, Spread):
        first = numbers.value(f"{name}.from", given.first, name, sign)
        last = numbers.value(f"{name}.to", given.last, name, sign)
        if given.log and first * last <= 0:
            numbers.refuse(f"{name}.log", "equal ratios need ends that are not 0 and have the same sign")
            return np.nan
        return np.geomspace(first, last, given.steps) if given.log else np.linspace(first, last, given.steps)
    if isinstance(given, list):
        if not given:
            numbers.refuse(name, "is an empty list")
        return np.array([numbers.value(f"{name}[{k}]", each, name, sign) for k, each in enumerate(given)])
    return numbers.value(name, given, name, sign)


def _swing(table: AskSwing, system: System | None, numbers: Numbers) -> Given:
    given: Given = {}
    for name in ("offset", "velocity"):
        start = getattr(table, name)
        if start is UNSET:
            continue
        given[name] = _spread(name, start, "any", numbers)
        if system is None or system._is_cord or system._is_held:
            continue
        support = system._support
        moving = system.size + (support is not None and math.isfinite(support.stiffness))
        if len(start) != moving:
            each = f"must have a number for each of the {moving} pins that move"
            numbers.refuse(name, f"{each}, free end first, got {len(start)}")
    given["time"] = _spread("time", table.time, "any", numbers)
    return given if table.count is UNSET else given | {"count": table.count}


def _branches(table: AskBranches, system: System | None, numbers: Numbers) -> Given:
    name, value = _one_speed(table, ("max_angular_speed", "min_conical_height"), numbers)
    return {name: numbers.value(name, value, name, "positive"), "direction": table.direction}


_ARGUMENTS: dict[str, Any] = {
    "modes": _modes,
    "shapes": _shapes,
    "response": _response,
    "swing": _swing,
    "branches": _branches,
    "explain": _explain,
}


def answered(question: str, system: Any, given: Given, gravity: float, progress: _core.Progress | None = None) -> Any:
    """The result of the function of the question."""
    if question == "explain":
        return explain(system, **given)
    given["gravity"] = gravity
    if question == "modes":
        return find_modes(system, **given, progress=progress)
    if question == "swing":
        return swing(system, **given)
    function: Any = {"shapes": steady_shapes, "response": response, "branches": branches}[question]
    return function(system, **given)
