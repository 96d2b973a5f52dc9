# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of branches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..systems.numbers import Floats, word
from .modes import beside_at_rest
from .style import half_waves_style, legend_outside

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from ..results.branches import Branch
    from ..results.held_branches import HeldBranch

QUANTITIES = {
    "tip_inclination": "tip inclination (degrees)",
    "tip_radius": "tip radius (m)",
    "top_tension": "tension at the support (N)",
    "moment_of_inertia": "moment of inertia (kg m^2)",
    "effective_energy": "effective energy (J)",
}
BY_WEIGHT = {
    "top_tension": "tension at the support (unit of the weights)",
    "moment_of_inertia": "moment of inertia (weight x length^2)",
    "effective_energy": "effective energy (weight x length)",
}
CLOSEST = 0.03  # of the width, between births whose speeds are written out


def plot_branches(branches: Sequence[Branch], first: float, ax: Axes | None, *, quantity: str, place: str) -> Axes:
    """See `Branches.plot`; `first` is the conical height of the slowest mode."""
    word(place, "quantity", quantity, QUANTITIES)
    ax = beside_at_rest(branches[0].system if len(branches) else None, ax, 7.2, 5.0)
    named: set[int] = set()
    curves: dict[Artist, int] = {}
    births: list[tuple[float, str]] = []
    for branch in branches:
        waves = int(branch.half_waves[0])
        speed = np.sqrt(first / branch.conical_height)
        value = _values(branch, quantity)
        colour, label = half_waves_style(waves, named)
        style = "-" if branch.mode is not None else "--"
        curves[ax.plot(speed, value, style, color=colour, linewidth=1.6, label=label)[0]] = waves
        if branch.mode is not None:
            ax.plot(speed[0], value[0], "o", color=colour, markersize=5.0)
        folds = branch.folds
        _mark_folds(ax, speed[folds], value[folds], colour)
        if branch.mode is None and folds.size:
            born = int(folds[np.argmin(speed[folds])])
            births.append((float(speed[born]), colour))
    _mark_births(ax, births)
    _label(ax, branches, "speed / first critical speed", QUANTITIES, quantity)
    if named:
        handles, labels = ax.get_legend_handles_labels()
        order = sorted(range(len(labels)), key=lambda i: curves.get(handles[i], np.inf))  # what was there before: last
        legend_outside(ax, handles=[handles[i] for i in order], labels=[labels[i] for i in order])
    return ax


def _mark_births(ax: Axes, births: list[tuple[float, str]]) -> None:
    """Dotted lines at speeds where pairs are born, written above the frame, where they hide no loop however small."""
    left, right = ax.get_xlim()
    last = -np.inf
    ticks: list[float] = []
    for at, colour in sorted(births):
        ax.axvline(at, color=colour, linestyle=":", linewidth=0.8, zorder=1)
        if at - last >= CLOSEST * (right - left):
            ticks.append(at)
            last = at
    if not ticks:
        return
    above = ax.secondary_xaxis("top")
    above.set_xticks(ticks, [f"{at:.5g}" for at in ticks], rotation=90, fontsize="small")
    above.set_xlabel("pairs appear at", fontsize="small")


def _values(branch: Branch | HeldBranch, quantity: str) -> Floats:
    """The numbers to draw: inclinations in degrees."""
    values: Floats = getattr(branch, quantity)
    return np.degrees(values) if quantity.endswith("inclination") else values


def _mark_folds(ax: Axes, speed: Floats, value: Floats, colour: str) -> None:
    """Hollow marks, which hide no loop however small."""
    ax.plot(speed, value, "D", color=colour, markersize=5.0, markerfacecolor="none", zorder=3)


def _label(
    ax: Axes, branches: Sequence[Branch] | Sequence[HeldBranch], speed: str, quantities: dict[str, str], quantity: str
) -> None:
    by_mass = all(branch.system.by_mass for branch in branches)
    label = quantities[quantity] if by_mass else BY_WEIGHT.get(quantity, quantities[quantity])
    ax.set(xlabel=speed, ylabel=label)
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)


HELD_QUANTITIES = {
    "largest_offset": "largest distance from axis (m)",
    "lowest_inclination": "lowest link from the upward vertical (degrees)",
    "top_tension": "tension at the upper end (N)",
    "moment_of_inertia": "moment of inertia (kg m^2)",
}


def plot_held_branches(branches: Sequence[HeldBranch], ax: Axes | None, *, quantity: str, place: str) -> Axes:
    """See `HeldBranches.plot`."""
    word(place, "quantity", quantity, HELD_QUANTITIES)
    ax = beside_at_rest(branches[0].system if len(branches) else None, ax, 7.2, 5.0)
    named: set[int] = set()
    for branch in branches:
        value = _values(branch, quantity)
        colour, label = half_waves_style(branch.mode, named)
        ax.plot(branch.angular_speed, value, color=colour, linewidth=1.6, label=label)
        _mark_folds(ax, branch.angular_speed[branch.folds], value[branch.folds], colour)
    _label(ax, branches, "speed (rad/s)", HELD_QUANTITIES, quantity)
    if named:
        legend_outside(ax)
    return ax
