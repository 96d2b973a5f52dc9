# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors for questions that a system cannot answer: the reason, and the question to ask instead."""

from __future__ import annotations

from typing import Any

from ..systems.numbers import shown
from ..systems.system import System


def no_system(place: str, system: Any) -> TypeError:
    """The error for an argument that is not a system, in a question that all systems answer."""
    return TypeError(f"{place}: system must be a revchain.Chain, Rig, Cord or Held, got {shown(system)}")


def refuse_other(place: str, system: Any, kinds: tuple[type, ...], instead: dict[type, str]) -> None:
    """Raise a ValueError for a system without an answer, with the question to ask instead; a TypeError for no system."""
    if isinstance(system, kinds):
        return
    if isinstance(system, System):
        name = type(system).__name__
        raise ValueError(f"{place}: is not available for a {name}; {instead[type(system)]}")
    names = " or ".join(kind.__name__ for kind in kinds)
    raise TypeError(f"{place}: system must be a revchain.{names}, got {shown(system)}")
