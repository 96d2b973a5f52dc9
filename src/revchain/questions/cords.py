# SPDX-License-Identifier: GPL-3.0-or-later
"""Answers for a cord that need other methods than for a chain."""

from __future__ import annotations

from .. import _core
from ..results.bent import CordShape, branch_shape
from ..results.cord_branches import CordBranch, CordBranches, cord_branches_made
from ..systems.cord import Cord


def cord_branch(system: Cord, gravity: float, asked: tuple[int, float, int, float]) -> CordBranch:
    """See `branch`."""
    return CordBranch._made(_core.cord_branch(system._compiled, *asked), system=system, gravity=gravity, asked=asked)


def cord_branches(system: Cord, gravity: float, asked: tuple[float, int]) -> CordBranches:
    """See `branches`."""
    return cord_branches_made(_core.cord_branches(system._compiled, *asked), system, gravity, asked)


def cord_shapes_on_branch(
    system: Cord, mode: int, name: str, value: float, gravity: float, lowest: float | None, every: bool
) -> tuple[CordShape, ...]:
    """See `steady_shape`."""
    found = _core.cord_shapes_on_branch(system._compiled, mode, name, value, gravity, lowest, every)
    return tuple(branch_shape(shape, system, gravity) for shape in found)
