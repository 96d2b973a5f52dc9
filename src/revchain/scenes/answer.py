# SPDX-License-Identifier: GPL-3.0-or-later
"""Arguments from the tables [ask.…] of a scene, and the calls of the functions that answer them."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from msgspec import UNSET, to_builtins

from .. import _core
from ..closed_forms.governor import SleeveGovernor
from ..questions.branches import branches
from ..questions.campbell import campbell
from ..questions.drag import drag_shape
from ..questions.explain import explain
from ..questions.modes import find_modes
from ..questions.response import response
from ..questions.shapes import steady_shapes
from ..questions.swing import swing
from ..results.sheet import digits, in_unit
from ..systems.chain import Chain
from ..systems.held import Held
from ..systems.numbers import without_function
from ..systems.rig import Rig
from ..systems.support_motion import KINDS, SupportMotion
from ..systems.units import SI, speed_unit
from .parse import choice, written
from .system import Given, Numbers, System, Whirling, has_air_drag
from .tables import DEFAULT_MODES, AskCampbell, AskDrag, Spread, Table, Tables, fields_of, number_fields


def _equilibria(governor: SleeveGovernor, angular_speed: float | None = None) -> Any:
    """The equilibria at a speed; without one the governor itself, whose table has those between its stops."""
    return governor if angular_speed is None else governor.equilibria(angular_speed)


METHODS = tuple(dict.fromkeys((*_core.METHODS[1:], *_core.MODELS)))
FUNCTIONS: dict[str, Callable[..., Any]] = {
    "modes": find_modes,
    "shapes": steady_shapes,
    "response": response,
    "swing": swing,
    "branches": branches,
    "campbell": campbell,
    "drag": drag_shape,
    "equilibria": _equilibria,
    "explain": explain,
}
WINDOWS = ("angular_speed", "conical_height")
MOVES = tuple(f"support_{kind}" for kind in KINDS)
SPEEDS = {  # by question: the two keys of which one is given
    "shapes": WINDOWS,
    "response": WINDOWS,
    "branches": ("max_angular_speed", "min_conical_height"),
}
_YIELDS = "needs a support that yields; a firm one does not move: write [support] with mass or stiffness"
_ALONE = (Chain, "a chain that hangs from a firm point, with nothing else")
_HANGS = (Chain | Rig, "a chain that hangs")
_ONLY: dict[tuple[str, str], tuple[Any, str]] = {
    **{("modes", name): _ALONE for name in ("precision", "method")},
    ("modes", "certify"): _HANGS,
    ("shapes", "direction"): _HANGS,
    ("branches", "direction"): _HANGS,
    ("shapes", "hanging_only"): _HANGS,
    ("branches", "hanging_only"): _HANGS,
    ("shapes", "max_half_waves"): (Held, "a chain held at both ends"),
}


def arguments(question: str, table: Table, system: System | None, numbers: Numbers) -> Given:
    """The keyword arguments of a table; errors are noted. Keys that depend on the system are not checked without one."""
    numbers = numbers.of(f"ask.{question}")
    if system is not None and isinstance(system, SleeveGovernor) != (question == "equilibria"):
        instead = "write [ask.equilibria]" if question != "equilibria" else "write [ask.modes] or [ask.shapes]"
        numbers.refuse("", f"does not go with {'[governor]' if question != 'equilibria' else 'a chain or cord'}: {instead}")
        return {}
    if isinstance(system, SleeveGovernor):
        system = None  # its one question depends on none of its data
    signs = {name: sign for name, sign, _ in number_fields(type(table))}
    if question == "response" and system is not None and system.has_momentum:
        signs["angular_speed"] = "any"
    speeds = SPEEDS.get(question, ())
    there = [name for name in speeds if getattr(table, name) is not UNSET]
    if speeds and len(there) != 1:
        one, other = map(numbers.named, speeds)
        numbers.refuse("", f"give {one} or {other}" + (", not both" if there else ": at which speed"))
        signs = {name: sign for name, sign in signs.items() if name not in speeds}
    given: Given = {}
    for field in fields_of(type(table)):
        value = getattr(table, field.name)
        if value is UNSET or (value == field.default and not isinstance(value, Spread)):
            continue
        systems, reason = _ONLY.get((question, field.name), (object, ""))
        if system is not None and not isinstance(system, systems):
            numbers.refuse(field.name, f"is for {reason}, got {written(value)}")
        given[field.name] = value
        if field.name in signs:
            given[field.name] = numbers.values(field.name, value, signs[field.name], "Spread" in str(field.type))
    if question in _CHECKS:
        _CHECKS[question](table, given, system, numbers)
    return given


def _modes(table: Table, given: Given, system: Whirling | None, numbers: Numbers) -> None:
    """Check the choice of modes, the method and the precision."""
    windows = [name for name in WINDOWS if name in given]
    others = [name for name in ("count", "first", *windows[1:]) if name in given]
    if windows and others:
        numbers.refuse(windows[0], f"does not go with {numbers.named(others[0])}")
    for name in windows:
        low, high = given[name]
        if low >= high:
            got = f"{low:g} to {high:g}" if numbers.options else written(getattr(table, name))
            numbers.refuse(name, f"its low end must lie below its high end, got {got}")
    available = None if system is None else system.mode_count
    first, count = given.get("first", 1), given.get("count", 1)
    if available == 0:
        numbers.refuse("", "has no answer: one link held at both ends has no pin that could move; give it two links or more")
    elif available is not None and first > available:
        numbers.refuse("first", f"must be at most {available}, got {first}")
    elif available is not None and count != "all" and count > available - first + 1:
        given["count"] = available - first + 1  # all there are; `remark` says so
    method = given.get("method", "bisection")
    if method not in METHODS:
        numbers.refuse("method", choice(list(METHODS), False, method))
    if "precision" in given and method != "bisection":
        its = numbers.named("method", f'"{method}"')
        numbers.refuse("precision", f'{its} goes with "double" only')


def _explain(table: Table, given: Given, system: Whirling | None, numbers: Numbers) -> None:
    """Check the choice of modes, and count all of them."""
    _modes(table, given, system, numbers)
    if given.get("count") == "all":
        there = DEFAULT_MODES if system is None or system._kind != "chain" else system.mode_count or 1
        given["count"] = max(there - given.get("first", 1) + 1, 1)


def _response(table: Table, given: Given, system: Whirling | None, numbers: Numbers) -> None:
    """Refuse a speed of 0, and more than one drive."""
    drives = [name for name in ("support_radius", "acceleration", "force") if name in given]
    if len(drives) > 1:
        numbers.refuse(drives[1], f"does not go with {numbers.named(drives[0])}")
    support = None if system is None else system._support
    if "force" in given and system is not None and not (support is not None and support._yields):
        numbers.refuse("force", _YIELDS)
    for name in WINDOWS:
        if not np.all(given.get(name, 1.0)):
            numbers.refuse(name, "must not be 0")


def _swing(table: Table, given: Given, system: Whirling | None, numbers: Numbers) -> None:
    """Check that something moves and that there is a number for each pin that does; make the motion of the support."""
    moved = {name: given.pop(name) for name in MOVES if name in given}
    time = given.pop("support_time", None)
    if time is None and not moved:
        if "offset" not in given and "velocity" not in given:
            what = f"{numbers.named('offset')}, {numbers.named('velocity')} or {numbers.named('support_time')}"
            numbers.refuse("", f"give {what}: nothing would move")
    elif (motion := _support_motion(time, moved, numbers)) is not None:
        given["support"] = motion
    if system is None or system._is_cord or system._is_held:
        return
    support = system._support
    yields = support is not None and support._yields
    if "support_force" in moved and not yields:
        numbers.refuse("support_force", _YIELDS)
    if yields and support is not None and support.stiffness == 0 and moved and "support_force" not in moved:
        yields = False  # the trolley is moved itself
    moving = system.size + yields
    order = "free end first" if system._listed.step == 1 else "support first"
    for name in ("offset", "velocity"):
        if name in given and len(given[name]) != moving:
            each = f"must have a number for each of the {moving} pins that move"
            numbers.refuse(name, f"{each}, {order}, got {len(given[name])}")
        elif name in given:
            given[name] = given[name][system._listed]


def _support_motion(time: Any, moved: Given, numbers: Numbers) -> SupportMotion | None:
    """The motion of the support; None if it was refused, which is noted."""
    if len(moved) != 1 or time is None:
        first, *others = [*moved, "support_time"]
        if not moved:
            *some, last = map(numbers.named, MOVES)
            numbers.refuse(first, f"needs one of {', '.join(some)} and {last} beside it")
        elif len(moved) > 1:
            numbers.refuse(others[0], f"does not go with {numbers.named(first)}")
        else:
            numbers.refuse(first, f"needs {numbers.named('support_time')} beside it, the time of each of its values")
        return None
    [(name, values)] = moved.items()
    if min(sizes := (np.size(time), np.size(values))) < 2 or sizes[0] != sizes[1]:
        beside = f"must have as many values as {numbers.named('support_time')}, two or more"
        numbers.refuse(name, f"{beside}, got {sizes[1]} beside {sizes[0]}")
        return None
    if np.isnan(time).any() or np.isnan(values).any():
        return None  # noted already
    try:
        return SupportMotion(time, **{name.removeprefix("support_"): values})
    except ValueError as error:
        reason = without_function(error).removeprefix("time ")
        numbers.refuse("support_time", reason.replace("; time, got", ", got"))
        return None


def _campbell(table: AskCampbell, given: Given, system: Whirling | None, numbers: Numbers) -> None:
    """Check that there are ascending speeds."""
    speeds: Any = given.get("angular_speed")
    if np.size(speeds) > 1 and speed_unit(to_builtins(table)) == "s" and (np.diff(speeds) < 0).all():  # ascending periods are descending speeds
        speeds = given["angular_speed"] = speeds[::-1]
    if speeds is None:
        example = '"1 rpm to 20 rpm in 39"' if numbers.options else '{from = "1 rpm", to = "20 rpm", steps = 39}'
        numbers.refuse("angular_speed", f"is missing: write {numbers.named('angular_speed', example)}")
    elif np.size(speeds) < 2 or not (np.isnan(speeds).any() or (np.diff(speeds) > 0).all()):
        given_as_range = isinstance(table.angular_speed, Spread)
        got = f"{speeds[0]:g} to {speeds[-1]:g}" if given_as_range else written(table.angular_speed)
        numbers.refuse("angular_speed", f"must be two or more ascending speeds, got {got}")
    if given.get("orders") == []:
        numbers.refuse("orders", "is an empty list: write [1, 2], or leave it out")


def _drag(table: AskDrag, given: Given, system: Whirling | None, numbers: Numbers) -> None:
    """Check that there is a speed and an arm."""
    if table.angular_speed is UNSET:
        example = numbers.named("angular_speed", '"12 rpm"')
        numbers.refuse("angular_speed", f"is missing: write {example}")
    elif given["angular_speed"] == 0:
        why = "at rest air has no effect; positive and negative speeds turn either way"
        numbers.refuse("angular_speed", f"must not be 0: {why}")
    if system is not None and not (isinstance(system, Rig) and system.support.radius):
        why = "needs a support off the axis, which carries the chain round"
        numbers.refuse("", f'{why}: write [support] and radius = "2 m"')


_CHECKS: dict[str, Callable[[Any, Given, Whirling | None, Numbers], None]] = {
    "modes": _modes,
    "explain": _explain,
    "response": _response,
    "swing": _swing,
    "campbell": _campbell,
    "drag": _drag,
}


def notes_on(scene: Tables, question: str, table: Table, system: System, given: Given, options: bool) -> tuple[str, ...]:
    """Notes on what the answer to a question leaves out, and on plain numbers that were read in rad/s."""
    notes = []
    if question not in ("drag", "equilibria") and has_air_drag(scene):
        notes.append("the drag of air is left out here: air_drag acts in [ask.drag] only")
    if question == "swing" and is_driven_trolley(system, given.get("support")):
        notes.append("the trolley moves as prescribed: its own mass and damping have no effect")
    unit = scene.speed
    if unit not in (UNSET, "rad/s"):
        numbers = Numbers("scene", options=options)
        for name, sign, _ in number_fields(type(table)):
            value = getattr(table, name)
            is_speed = SI.get(name, ("", ""))[1] == "an angular speed"
            if is_speed and isinstance(value, float | int) and value:
                shown = digits(in_unit(float(value), str(unit)), 4)
                said, right = numbers.named(name, f"{value:g}"), numbers.named(name, f'"{value:g} {unit}"')
                read = f"the plain number {said} was read as {value:g} rad/s = {shown} {unit}"
                notes.append(f"{read}: for {value:g} {unit} write {right}")
            elif is_speed and isinstance(value, list | tuple | Spread) and speed_unit(to_builtins(value)) is None:
                notes.append(f'plain numbers of {name} were read in rad/s: write text such as "8 {unit}" for another unit')
    return tuple(notes)


def is_driven_trolley(system: System, motion: SupportMotion | None) -> bool:
    """Return whether a support that rolls freely has a prescribed motion."""
    if motion is None or motion._what == "force" or not isinstance(system, Rig):
        return False
    support = system.support
    return support.stiffness == 0 and (support.carriage > 0 or support.damping > 0)


def answered(question: str, system: System, given: Given, gravity: float, progress: _core.Progress | None) -> Any:
    """The result of the function of the question; the progress is that of modes."""
    more: Given = {} if question in ("explain", "equilibria") else {"gravity": gravity}
    if question == "modes":
        more["progress"] = progress
    return FUNCTIONS[question](system, **given, **more)
