# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers for a system held at a span that need other methods than for a hanging chain."""

from __future__ import annotations

from typing import Any

from .. import _core
from ..results.bent import HeldCordShape, HeldShape
from ..results.held_branches import HeldBranch, HeldBranches, held_branches_made
from ..systems.chain import Chain
from ..systems.held import Held


def held_branch(place: str, held: Held, mode: int, least: float, gravity: float, step: float) -> HeldBranch:
    """See `branch`."""
    found = held_branches(place, held, least, gravity, step)
    for each in found:
        if each.mode == mode:
            return each
    if held.is_on_axis:
        most = len(found)
        raise ValueError(f"{place}: mode must be from 1 to {most}, the branches at the greatest speed, got {mode}")
    modes = ", ".join(str(each.mode) for each in found) or "none"
    raise ValueError(f"{place}: mode must be that of a branch at the greatest speed, here one of {modes}, got {mode}")


def held_branches(place: str, held: Held, least: float, gravity: float, step: float = 0.1) -> HeldBranches:
    """The branches down to the conical height `least`, see `branches`."""
    span = _span(place, held)
    found: Any = _core.held_branches(held.system._compiled, span, *held._ends(gravity), least, step)
    return held_branches_made(found, held, gravity, (least, step, gravity))


def held_shape(
    place: str, held: Held, mode: int, name: str, value: float, gravity: float, every: bool
) -> HeldShape | HeldCordShape:
    """See `steady_shape`."""
    span = _span(place, held)
    if name not in ("conical_height", "angular_speed", "top_tension"):
        raise ValueError(
            f"{place}: a held system has no free end; give conical_height, angular_speed or top_tension, got {name}"
        )
    if every:
        raise ValueError(f"{place}: all=True is not available for a Held; use branches for the shapes along a branch")
    most = max(held.size - 1, 1) * (1 if held.is_on_axis else 2)
    if isinstance(held.system, Chain) and mode > most:
        raise ValueError(f"{place}: mode must be from 1 to {most}, got {mode}")
    if name == "top_tension" and not held.is_firm:
        raise ValueError(
            f"{place}: top_tension is for firm ends; with springs give angular_speed, or read the speed from the top_tension "
            f"of a branch, got {value:g}"
        )
    asked = value / held._force(gravity) if name == "top_tension" else value
    try:
        found = _core.held_shape(held.system._compiled, span, *held._ends(gravity), mode, name, asked, gravity)
    except ValueError as error:
        if name != "top_tension":
            raise
        what = str(error).partition(": ")[2].rpartition(", got ")[0]  # the number there is asked / gravity
        raise ValueError(f"{place}: {what}; use branches for the tensions that it has, got {value:g}") from None
    kind: Any = HeldShape if isinstance(held.system, Chain) else HeldCordShape
    shape: HeldShape | HeldCordShape = kind._made(
        found,
        system=held,
        gravity=gravity,
        angular_speed=value if name == "angular_speed" else float((gravity / found.conical_height) ** 0.5),
        _asked=("mode", mode, name, asked, gravity),
    )
    return shape


def _span(place: str, held: Held) -> float:
    """The span of a held system; a ValueError if it is under a tension or has no gravity."""
    if held.span is None:
        raise ValueError(
            f"{place}: is for a system held at a span; under a tension use steady_shapes at a speed, or modes"
        )
    if held.weightless:
        why = "a shape is the same at every speed" if held.is_firm else "there are no branches"
        raise ValueError(f"{place}: without gravity {why}; use steady_shapes")
    return held.span
