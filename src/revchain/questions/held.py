# SPDX-License-Identifier: GPL-3.0-or-later
"""Questions about a chain held at a span that hanging chains answer in another way."""

from __future__ import annotations

from .. import _core
from ..results.bent import HeldShape
from ..results.held_branches import HeldBranch, HeldBranches, held_branches_made
from ..systems.cord import Cord
from ..systems.held import Held


def held_branch(place: str, held: Held, mode: int, least: float, gravity: float, step: float) -> HeldBranch:
    """See `branch`."""
    found = held_branches(place, held, least, gravity, step)
    if mode > len(found):
        most = len(found)
        raise ValueError(f"{place}: mode must be from 1 to {most}, the branches at the greatest speed, got {mode}")
    return found[mode - 1]


def held_branches(place: str, held: Held, least: float, gravity: float, step: float = 0.1) -> HeldBranches:
    """See `branches`; down to the conical height `least`."""
    chain, span = _spanned(place, held)
    found = _core.held_branches(chain, span, *held._ends(gravity), least, step)
    return held_branches_made(found, held, gravity, (least, step, gravity))


def held_shape(place: str, held: Held, mode: int, name: str, value: float, gravity: float, every: bool) -> HeldShape:
    """See `steady_shape`."""
    chain, span = _spanned(place, held)
    if name not in ("conical_height", "angular_speed", "top_tension"):
        raise ValueError(
            f"{place}: a held chain has no free end; give conical_height, angular_speed or top_tension, got {name}"
        )
    if every:
        raise ValueError(f"{place}: all is for a Chain; ask branches for the shapes along a branch of a held chain")
    if mode > max(chain.size - 1, 1):
        raise ValueError(f"{place}: mode must be from 1 to {max(chain.size - 1, 1)}, got {mode}")
    asked = value / held._force(gravity) if name == "top_tension" else value
    found = _core.held_shape(chain, span, *held._ends(gravity), mode, name, asked, gravity)
    return HeldShape._made(
        found,
        system=held,
        gravity=gravity,
        angular_speed=value if name == "angular_speed" else float((gravity / found.conical_height) ** 0.5),
        _asked=("mode", mode, name, asked, gravity),
    )


def _spanned(place: str, held: Held) -> tuple[_core.Chain, float]:
    """The chain and its span."""
    if isinstance(held.system, Cord):
        raise ValueError(f"{place}: is for chains; cut the cord into links: Held(cord.chain(100), span=...)")
    if held.span is None:
        raise ValueError(
            f"{place}: is for a chain held at a span; under a tension ask steady_shapes at the speeds wanted, or modes"
        )
    if held.weightless:
        raise ValueError(f"{place}: without gravity a shape is the same at every speed; ask steady_shapes")
    if not held.is_plain:
        raise ValueError(
            f"{place}: is for ends that are firm points on the axis; for others ask steady_shapes at the speeds wanted, "
            f"got {held!r}"
        )
    return held.system._compiled, held.span
