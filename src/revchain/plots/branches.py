# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of branches."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..closed_forms.table import described
from ..systems.numbers import word
from .modes import beside_at_rest
from .style import half_waves_style, legend_outside

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from ..results.branches import Branch, Branches

QUANTITIES = {
    "lowest_inclination": "inclination of the lowest link (degrees)",
    "tip_radius": "tip radius (m)",
    "largest_offset": "largest distance from axis (m)",
    "top_tension": "tension at the upper end (N)",
    "moment_of_inertia": "moment of inertia (kg m^2)",
    "effective_energy": "effective energy (J)",
}
BY_WEIGHT = {
    "top_tension": "tension at the upper end (unit of the weights)",
    "moment_of_inertia": "moment of inertia (weight x length^2)",
    "effective_energy": "effective energy (weight x length)",
}
CLOSEST = 0.03  # of the width, between births whose speeds are written out


def words_of(quantity: str, by_mass: bool) -> str:
    """The label of a quantity."""
    return QUANTITIES[quantity] if by_mass else BY_WEIGHT.get(quantity, QUANTITIES[quantity])


@described(bound=True)
def plot_branch(branch: Branch, ax: Axes | None = None, *, quantity: str | None = None) -> Axes:
    """Draw a quantity of the branch against the speed; folds are marked.

    quantity: Quantity to draw: ``lowest_inclination`` (in degrees; of hanging systems unless given),
        ``tip_radius``, ``largest_offset`` (of held systems unless given), ``top_tension``, ``moment_of_inertia`` or
        ``effective_energy``.
    raises: If `quantity` is another word, or one that the system does not have.

    >>> ax = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1).plot()
    >>> ax.get_ylabel()
    'inclination of the lowest link (degrees)'
    """
    return _curves([branch], ax, quantity, "revchain.Branch.plot")


@described(bound=True)
def plot_branches(branches: Branches, ax: Axes | None = None, *, quantity: str | None = None) -> Axes:
    """Draw the bifurcation diagram: a quantity of each branch against the speed.

    quantity: Quantity to draw, as in `Branch.plot`.
    returns: The drawing. Colours show half waves, hollow marks folds. Isolated branches are dashed, with the speed
        at which each starts. The title says whether the diagram is `complete`.
    raises: If `quantity` is another word, or one that the system does not have.

    >>> ax = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), min_conical_height=0.04).plot()
    >>> ax.get_xlabel()
    'speed (rad/s)'
    """
    ax = _curves(branches, ax, quantity, "revchain.Branches.plot")
    if not branches:
        ax.set_title("no shape at or above this conical height")
    elif hasattr(branches, "complete"):
        ax.set_title("all branches: proved complete" if branches.complete else "branches found: not proved complete")
    return ax


def _curves(branches: Sequence[Branch], ax: Axes | None, quantity: str | None, place: str) -> Axes:
    """A curve for each branch."""
    available = [name for name in QUANTITIES if not len(branches) or hasattr(branches[0], name)]
    if quantity is None:
        quantity = "largest_offset" if len(branches) and "tip_radius" not in available else "lowest_inclination"
    word(place, "quantity", quantity, available)
    ax = beside_at_rest(branches[0].system if len(branches) else None, ax, 7.2, 5.0)
    named: set[int] = set()
    curves: dict[Artist, int] = {}
    births: list[tuple[float, str]] = []
    for branch in branches:
        waves = int(branch.half_waves[0])
        speed, value = branch.angular_speed, getattr(branch, quantity)
        if quantity.endswith("inclination"):
            value = np.degrees(value)
        colour, label = half_waves_style(waves, named)
        style = "-" if branch.mode is not None else "--"
        curves[ax.plot(speed, value, style, color=colour, linewidth=1.6, label=label)[0]] = waves
        if getattr(branch, "birth", "fold") != "fold":
            ax.plot(speed[0], value[0], "o", color=colour, markersize=5.0)
        folds = branch.folds  # hollow marks, which hide no loop however small
        ax.plot(speed[folds], value[folds], "D", color=colour, markersize=5.0, markerfacecolor="none", zorder=3)
        if branch.mode is None and folds.size:
            births.append((float(speed[folds].min()), colour))
    _mark_births(ax, births)
    ax.set(xlabel="speed (rad/s)", ylabel=words_of(quantity, all(branch.system.by_mass for branch in branches)))
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
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
