# SPDX-License-Identifier: GPL-3.0-or-later
"""Questions that a system does not answer: why, and what to ask instead."""

from __future__ import annotations

from typing import Any

from ..systems.numbers import shown
from ..systems.system import System


def no_system(place: str, system: Any) -> TypeError:
    """The error of a question that all systems answer, for what is none."""
    return TypeError(f"{place}: system must be a revchain.Chain, Rig, Cord or Held, got {shown(system)}")


def refuse_other(place: str, system: Any, kinds: tuple[type, ...], instead: dict[type, str]) -> None:
    """A ValueError for a system that has no answer, with what to ask instead; a TypeError for what is no system."""
    if isinstance(system, kinds):
        return
    if isinstance(system, System):
        name = type(system).__name__
        raise ValueError(f"{place}: is not available for a {name}; {instead[type(system)]}")
    names = " or ".join(kind.__name__ for kind in kinds)
    raise TypeError(f"{place}: system must be a revchain.{names}, got {shown(system)}")
