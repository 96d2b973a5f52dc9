# SPDX-License-Identifier: GPL-3.0-or-later
"""Bifurcation diagrams: branches of steady shapes against the speed."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from itertools import pairwise
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..closed_forms.table import described
from ..results.branches import MOST_JUDGED
from ..results.shapes import is_driven
from ..results.sheet import digits
from ..systems.numbers import boolean, word
from .modes import beside_at_rest
from .style import SpeedUnit, half_waves_style, house, legend_outside, plain

if TYPE_CHECKING:
    from matplotlib.artist import Artist
    from matplotlib.axes import Axes

    from ..results.branches import Branch, Branches

_Parts = tuple[tuple[float, float, str], ...]
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
LINES: dict[str, Any] = {  # by verdict
    "minimum": "-",
    "spectrally stable": (0, (7.0, 1.5, 1.5, 1.5)),
    "unstable": (0, (3.0, 2.0)),
    "undecided": (0, (1.0, 1.5)),
}
WORDS = {
    "minimum": "minimum (stable)",
    "spectrally stable": "spectrally stable",
    "unstable": "unstable",
    "undecided": "undecided",
}
WIDE, TALL = 0.4, 0.05  # room for a speed above the frame, level and upright, as a share of the width
WIDE_POINTS, TALL_POINTS = 115.0, 15.0  # the same in points
SAMPLES = 8  # verdicts for each point of a branch, as in `Branch.stability_windows`
MOST_POSTURES = 7  # postures with a colour each


class _Mark(NamedTuple):
    """A fold or a pitchfork: where it is, in the units of the picture, and what it is."""

    x: float
    y: float
    colour: str
    kind: str


MARKS: dict[str, dict[str, Any]] = {  # hollow marks hide no loop however small
    "fold": {"marker": "D", "markersize": 5.0, "markerfacecolor": "none", "zorder": 3},
    "pitchfork": {"marker": "o", "markersize": 5.0, "zorder": 3},
    "change of stability": {"marker": "x", "markersize": 5.0, "zorder": 3},
}


def words_of(quantity: str, by_mass: bool) -> str:
    """Return the label of an axis, with the unit that the quantity has for systems given by mass or by weight."""
    return QUANTITIES[quantity] if by_mass else BY_WEIGHT.get(quantity, QUANTITIES[quantity])


@described(bound=True)
def plot_branch(
    branch: Branch,
    ax: Axes | None = None,
    *,
    quantity: str | None = None,
    speed: str | None = None,
    stability: bool | None = None,
    frame: str = "free",
) -> Axes:
    """Draw a quantity of the branch against the speed, with its stability, folds and pitchforks.

    quantity: Quantity to draw: ``lowest_inclination`` (in degrees; the default), ``tip_radius``, ``largest_offset`` (the
        default of held systems), ``top_tension``, ``moment_of_inertia`` or ``effective_energy``.
    stability: Whether to draw the stability, as in `Branches.plot`.
    frame: Frame of the stability, ``"free"`` or ``"driven"``, as in `SteadyShape.stability`.
    raises: If `quantity` or `frame` is another word, or the system has no such quantity or stability.

    >>> ax = rc.branch(rc.Chain.uniform_plummets(2, length=2.0), 1, min_conical_height=0.1).plot()
    >>> ax.get_ylabel()
    'inclination of the lowest link (degrees)'
    """
    return _draw([branch], ax, quantity, speed, stability, frame, "revchain.Branch.plot")


@described(bound=True)
def plot_branches(
    branches: Branches,
    ax: Axes | None = None,
    *,
    quantity: str | None = None,
    speed: str | None = None,
    stability: bool | None = None,
    frame: str = "free",
) -> Axes:
    """Draw the bifurcation diagram: a quantity of each branch against the speed.

    Colours show half waves at the start, or the posture with ``hanging_only=False`` if there are at most 7. Lines are solid
    where the shape is a minimum of the energy, dash-dotted where it is only spectrally stable, dashed where it is unstable,
    dotted where the stability is undecided. Hollow diamonds are folds, discs are pitchforks, crosses are other changes of
    stability; for chains and rigs `Branches.stability_windows` lists them. In large diagrams a short window can be missed.

    quantity: Quantity to draw, as in `Branch.plot`.
    stability: Whether to draw the stability; if False, all lines are solid. If left out, it is drawn for systems of
        links if that takes less than about a second.
    frame: Frame of the stability, ``"free"`` or ``"driven"``, as in `SteadyShape.stability`.
    raises: If `quantity` or `frame` is another word, or the system has no such quantity or stability.

    >>> ax = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), min_conical_height=0.04).plot()
    >>> ax.get_xlabel()
    'speed (rad/s)'
    """
    ax = _draw(branches, ax, quantity, speed, stability, frame, "revchain.Branches.plot")
    if not branches:
        ax.set_title("no shape at or above this conical height")
    elif hasattr(branches, "complete"):
        proved = f"all branches of {branches._of_shapes}: proved complete"
        ax.set_title(proved if branches.complete else "branches found: not proved complete")
    return ax


def _draw(
    branches: Sequence[Branch],
    ax: Axes | None,
    quantity: str | None,
    speed: str | None,
    stability: bool | None,
    frame: str,
    caller: str,
) -> Axes:
    """Draw a curve for each branch, in the styles of its stability, and mark folds and pitchforks."""
    unit = SpeedUnit(caller, speed, branches[0] if len(branches) else branches)
    available = [name for name in QUANTITIES if not len(branches) or hasattr(branches[0], name)]
    if quantity is None:
        quantity = "largest_offset" if len(branches) and "tip_radius" not in available else "lowest_inclination"
    word(caller, "quantity", quantity, available)
    windows = _windows(caller, branches, stability, frame)
    ax = beside_at_rest(branches[0].system if len(branches) else None, ax, 7.2, 5.0)
    named: set[int] = set()
    postures = _postures(branches)
    curves: dict[Artist, int] = {}
    marks: list[_Mark] = []
    for branch, parts in zip(branches, windows, strict=True):
        x, y = unit.of(branch.angular_speed), getattr(branch, quantity)
        if quantity.endswith("inclination"):
            turned = np.degrees(np.unwrap(y))  # no jump from 180 to -180 degrees
            y = turned - 360.0 * np.round((turned[-1] - np.degrees(y[-1])) / 360.0)
        if postures:
            waves = list(postures).index(branch.system._stands.tobytes())
            colour, label = house(waves), None if waves in named else postures[branch.system._stands.tobytes()]
            named.add(waves)
        else:
            waves = int(branch.half_waves[0])
            colour, label = half_waves_style(waves, named)
        for low, high, verdict in parts:
            at = np.concatenate([[low], branch.point[(branch.point > low) & (branch.point < high)], [high]])
            line = {"linestyle": LINES.get(verdict, "-"), "color": colour, "linewidth": 1.6}
            ax.plot(*(_along(branch, at, each) for each in (x, y)), **line)
        if label:
            curves[ax.plot([], [], color=colour, linewidth=1.6, label=label)[0]] = waves
        of_kind = {
            "fold": branch.folds,
            "pitchfork": [k for k, end in ((0, getattr(branch, "birth", "")), (-1, branch.end)) if end == "vertical"],
            "change of stability": _changes(branch, parts),
        }
        for kind, points in of_kind.items():
            for at in np.asarray(points, float) % len(branch):
                here = [_along(branch, at, each).item() for each in (x, y)]
                marks.append(_Mark(here[0], here[1], colour, kind))
    for mark in marks:
        ax.plot(mark.x, mark.y, color=mark.colour, linestyle="none", **MARKS[mark.kind])
    _label(ax, [mark for mark in marks if mark.kind in ("fold", "pitchfork")])
    label = words_of(quantity, all(branch.system.by_mass for branch in branches))
    names = getattr(branches[0].system._base, "names", None) if len(branches) else None
    if names is not None and names[0] and quantity == "lowest_inclination":
        label = plain(textwrap.fill(f"inclination of {names[0]} (degrees)", 40))
    ax.set(xlabel=unit.label, ylabel=label)
    ax.grid(color="0.9", linewidth=0.6)
    ax.set_axisbelow(True)
    if named:
        there = {verdict for parts in windows for *_, verdict in parts}
        for verdict in [each for each in LINES if each in there]:
            ax.plot([], [], linestyle=LINES[verdict], color="0.3", linewidth=1.6, label=WORDS[verdict])
        for kind in [each for each in MARKS if any(mark.kind == each for mark in marks)]:
            ax.plot([], [], color="0.3", linestyle="none", **MARKS[kind], label=kind)
        handles, labels = ax.get_legend_handles_labels()
        order = sorted(range(len(labels)), key=lambda i: curves.get(handles[i], np.inf))  # those of the caller are last
        legend_outside(ax, handles=[handles[i] for i in order], labels=[labels[i] for i in order])
    return ax


def _windows(caller: str, branches: Sequence[Branch], stability: bool | None, frame: str) -> list[_Parts]:
    """Parts of each branch with one verdict; the verdict is empty where the stability is not drawn."""
    driven = is_driven(caller, frame)
    work = sum(branch._work for branch in branches)
    if stability is None:
        known = not driven and all("_windows" in branch.__dict__ for branch in branches)
        stability = known or work <= MOST_JUDGED
        required = False
    else:
        required = boolean(caller, "stability", stability)
    asked = required or getattr(branches, "_stability", False)
    samples = 1 if work > MOST_JUDGED else SAMPLES if asked else int(min(SAMPLES, MOST_JUDGED // max(work, 1.0)))
    found = []
    for branch in branches:
        parts: _Parts = ()
        if stability and (required or hasattr(branch, "_windows")):
            fine = samples > 1 and branch._is_of_links
            parts = branch._judged(frame, samples) if driven or fine else branch._windows
        found.append(parts or ((0.0, len(branch) - 1.0, ""),))
    return found


def _changes(branch: Branch, parts: _Parts) -> list[float]:
    """Where the stability changes and there is no fold, counted in points."""
    decided = [each for each in parts if each[2] != "undecided"]
    near = 0.05 if branch._is_of_links else 1.0  # the edges of other branches lie between two points
    return [
        (low + high) / 2
        for (_, low, before), (high, _, after) in pairwise(decided)
        if before != after and not ((branch.folds >= low - near) & (branch.folds <= high + near)).any()
    ]


def _along(branch: Branch, at: Any, values: Any) -> Any:
    """Numbers at places along the branch, counted in points: between points the cubic in the arc through four of them."""
    at = np.atleast_1d(np.asarray(at, float))
    found = np.interp(at, branch.point, values)
    if not branch._is_of_links or len(branch) < 4:
        return found
    for k in np.flatnonzero(at % 1.0):
        nearest = slice(first := min(max(int(at[k]) - 1, 0), len(branch) - 4), first + 4)
        arcs, four = branch.arc[nearest], values[nearest]
        gaps = np.interp(at[k], branch.point, branch.arc) - arcs
        found[k] = sum(
            four[i] * np.prod([gaps[j] / (arcs[i] - arcs[j]) for j in range(4) if j != i]) for i in range(4)
        )
    return found


def _postures(branches: Sequence[Branch]) -> dict[bytes, str]:
    """Words for each posture of a diagram with several postures; empty for other diagrams, or if the postures are many."""
    inverted = getattr(branches, "inverted", None) or ()
    words = {}
    for branch, links in zip(branches, inverted, strict=bool(inverted)):
        up = "all links hang" if links == "none" else f"link{'s' * (', ' in links)} {links} up"
        words[branch.system._stands.tobytes()] = plain(up)
    return words if len(words) <= MOST_POSTURES else {}


def _label(ax: Axes, marks: list[_Mark]) -> None:
    """Draw dotted lines at folds and pitchforks, with their speeds above the frame, where they hide no loop."""
    left, right = ax.get_xlim()
    points = ax.get_window_extent().width * 72.0 / ax.figure.dpi
    kept: list[_Mark] = []
    for mark in sorted(marks):
        ax.axvline(mark.x, color=mark.colour, linestyle=":", linewidth=0.8, zorder=1)
        if not kept or mark.x - kept[-1].x >= max(TALL, TALL_POINTS / points) * (right - left):
            kept.append(mark)
    if not kept:
        return
    room = max(WIDE, WIDE_POINTS / points) * (right - left)
    level = all(after.x - before.x >= room for before, after in pairwise(kept))
    above = ax.secondary_xaxis("top")
    labels = [f"{mark.kind} {digits(mark.x, 4)}" for mark in kept]
    above.set_xticks([mark.x for mark in kept], labels, rotation=0 if level else 90)
