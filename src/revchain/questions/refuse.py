# SPDX-License-Identifier: GPL-3.0-or-later
"""Errors for arguments that are no system, and for systems without an answer, with the question to ask instead."""

from __future__ import annotations

from typing import Any

from ..systems.numbers import shown


def no_system(caller: str, system: Any) -> TypeError:
    """Return the TypeError for an argument that is not a system, in a question that every kind of system answers."""
    return TypeError(f"{caller}: system must be a revchain.Chain, Rig, Cord or Held, got {shown(system)}")


def refuse_other(caller: str, system: Any, kinds: tuple[str, ...], instead: dict[str, str]) -> None:
    """Raise a ValueError for a system without an answer, with the question to ask instead; a TypeError for no system.

    `kinds` are first words of kinds of systems that have an answer; `instead` has the others.
    """
    kind = getattr(system, "_kind", "").partition(" ")[0]
    if kind in kinds:
        return
    if kind:
        raise ValueError(f"{caller}: is not available for a {type(system).__name__}; {instead[kind]}")
    names = " or ".join(each.capitalize() for each in kinds)
    raise TypeError(f"{caller}: system must be a revchain.{names}, got {shown(system)}")
