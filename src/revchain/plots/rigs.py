# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of rigs: what there is at rest, and beside it the shapes in which it whirls."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ..results.motions import Response
from ..results.sheet import digits
from ..systems.numbers import integer, shown
from ..systems.rig import Rig
from .style import MOST_PINS_AS_DOTS, MOST_POINTS, SPACING, axes_or_new, thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..results.modes import RigModes
    from ..systems.numbers import Floats

FORWARD, BACKWARD, LINK, FLUID = "C0", "C3", "0.35", "#e4f1f9"
CARRIED = "C2"
ARM: dict[str, Any] = {"color": "black", "linewidth": 2.5, "zorder": 3, "clip_on": False}
FOLD = 0.3  # sideways, between the links that hang and those that stand on them, at rest


def plot_rig_modes(modes: RigModes, ax: Axes | None, most: int, length_unit: str, carried: Response | None) -> Axes:
    """See `RigModes.plot`."""
    place = "RigModes.plot"
    shape = modes.shape
    drawn = min(len(modes), integer(place, "most", most))
    if drawn < min(1, len(modes)):
        raise ValueError(f"{place}: most must be at least 1, got {shown(most)}")
    rig = modes.system
    if carried is not None and not isinstance(carried, Response):
        raise TypeError(f"{place}: carried must be a revchain.Response, got {shown(carried)}")
    if carried is not None and (carried.system != rig or carried.offset.shape != (rig.size + 1,)):
        raise ValueError(f"{place}: carried must be the response of the same rig at one speed, of every pin")
    before = 1 if carried is None else 2
    ax = axes_or_new(ax, 1.6 + 1.25 * (before + max(drawn, 2)), 6.0)
    upwards, level = _levels(rig)
    _draw_at_rest(rig, ax, level)
    labels = ["at rest" + (f"\nin {rig.fluid} fluid" if rig.displaced_weight.any() else "")]
    if carried is not None:
        turns = digits(float(carried.angular_speed) * 30 / np.pi, 4)
        labels.append(f"carried round\n{digits(float(carried.angular_speed), 4)} rad/s\n{turns} rev/min")
        scaled = carried.offset / np.abs(carried.offset).max()  # nothing is drawn of a resonance: NaN
        _draw_axis(ax, SPACING, level)
        _draw_links(rig, ax, SPACING + scaled, level, CARRIED)
        ax.plot([SPACING, SPACING + carried.support_radius / np.abs(carried.offset).max()], [0.0, 0.0], **ARM)
    speeds = modes.angular_speed
    for nth in range(drawn):
        axis = SPACING * (nth + before)
        colour = FORWARD if modes.direction[nth] > 0 else BACKWARD
        _draw_axis(ax, axis, level)
        _draw_links(rig, ax, axis + shape[nth], level, colour)
        if np.isfinite(rig.stiffness):
            ax.plot([axis, axis + shape[nth, -1]], [0.0, 0.0], color="0.3", linewidth=1.0, zorder=3)
            ax.plot(axis + shape[nth, -1], 0.0, marker="s", color="black", markersize=6.0, zorder=4, clip_on=False)
        else:
            ax.plot(axis, 0.0, marker="^" if upwards else "v", color="black", markersize=7.0, zorder=4, clip_on=False)
        sense = ("", " forward", " backward")[int(modes.direction[nth]) if modes.has_momentum else 0]
        turns = digits(speeds[nth] * 30 / np.pi, 4)
        labels.append(f"mode {modes.number[nth]}{sense}\n{digits(speeds[nth], 4)} rad/s\n{turns} rev/min")
    ticks = [SPACING * nth for nth in range(drawn + before)]
    if not drawn:
        rate = digits(modes.other.growth_rate.max(initial=0.0), 4)
        labels.append(f"no steady motion:\nfalls away as\nexp({rate} t), t in s")
        ticks.append(SPACING * (before + 0.5))
    ax.set_xticks(ticks, labels, fontsize="x-small")
    ax.set_xlim(-SPACING / 2, SPACING * (max(drawn, 2) + before - 0.5))
    _set_levels(ax, upwards, level, length_unit)
    if drawn or carried is not None:
        ax.set_xlabel("offset from the axis, own scale each", fontsize="small")
    if rig.displaced_weight.any():
        ax.set_facecolor(FLUID)
    for side in ("top", "right"):
        ax.spines[side].set_visible(False)
    return ax


def plot_carried(found: Response, ax: Axes | None, pins: list[int]) -> Axes:
    """The response at one speed as a shape, the support on its circle."""
    rig = found.system if isinstance(found.system, Rig) else Rig(found.system)
    upwards, level = _levels(rig)
    offset = dict(zip(np.atleast_1d(found.pins).tolist(), found.offset.reshape(-1).tolist(), strict=True))
    ax = axes_or_new(ax, 5.0, 6.0)
    _draw_axis(ax, 0.0, level)
    across = np.array([offset.get(pin, np.nan) if pin in pins else np.nan for pin in range(rig.size + 1)])
    if len(pins) == level.size:
        _draw_links(rig, ax, across, level, CARRIED)
    else:
        ax.plot(across, level, "o", color=CARRIED)
    ax.plot([0.0, found.support_radius], [0.0, 0.0], **ARM)
    _set_levels(ax, upwards, level, "m")
    ax.set_xlabel(f"offset from the axis (m) at {digits(found.angular_speed.item(), 4)} rad/s")
    return ax


def _levels(rig: Rig) -> tuple[bool, Floats]:
    """Whether all links stand, and the distances of the pins from the support along the axis, free end first."""
    upwards = bool(rig.standing.all())
    steps = rig.chain.length * np.where(rig.standing, -1.0, 1.0) * (-1.0 if upwards else 1.0)
    return upwards, np.concatenate([np.cumsum(steps[::-1])[::-1], [0.0]])


def _set_levels(ax: Axes, upwards: bool, level: Floats, length_unit: str) -> None:
    margin = 0.04 * (level.max() - level.min())
    ends = (level.min() - margin, level.max() + margin)
    ax.set_ylim(*(ends if upwards else ends[::-1]))
    ax.set_ylabel(f"{'height above' if upwards else 'depth below'} the support ({length_unit})")


def _draw_axis(ax: Axes, at: float, level: Floats) -> None:
    ax.plot([at, at], [level.max(), level.min()], color="0.6", linestyle="--", linewidth=0.9, zorder=1)


def _draw_links(rig: Rig, ax: Axes, across: Floats, level: Floats, colour: str) -> None:
    """The links, those that stand drawn stout."""
    kept = thinned(across)
    marker = "o" if level.size <= MOST_PINS_AS_DOTS else ""
    ax.plot(across[kept], level[kept], color=colour, linewidth=1.6, marker=marker, markersize=4.0, zorder=2)
    standing = np.flatnonzero(rig.standing)
    standing = standing[:: 1 + standing.size // MOST_POINTS]
    if standing.size:
        x, z = (np.stack([at[standing], at[standing + 1], np.full(standing.size, np.nan)], 1) for at in (across, level))
        ax.plot(x.ravel(), z.ravel(), color=colour, linewidth=4.0, alpha=0.45, zorder=2)


def _draw_at_rest(rig: Rig, ax: Axes, level: Floats) -> None:
    """The straight chain, wheels seen edge-on, bodies as heavy as they are, and what holds it."""
    chain, stands = rig.chain, rig.standing
    turns = np.flatnonzero(stands[1:] != stands[:-1]) + 1  # where a chain turns back, it is drawn beside itself
    first, end = np.concatenate([[0], turns]), np.concatenate([turns, [chain.size]])
    places = min(FOLD, 1.0 / first.size) * np.arange(first.size)[::-1]
    across = np.repeat(places, end - first)  # of the links
    path = np.stack([level[first], level[end]], 1).ravel()
    ax.plot(np.repeat(places, 2), path, color=LINK, linewidth=1.6)
    ax.vlines(places[stands[first]], level[first][stands[first]], level[end][stands[first]], color=LINK, linewidth=4.0)
    few = chain.size <= MOST_PINS_AS_DOTS
    along = (level[:-1] - level[1:]) / chain.length  # +1 or -1
    if few:
        middle = level[1:] + along * chain.centroid
        heavy = chain.weight > 0
        floats = rig.displaced_weight > chain.weight
        face = np.where(floats, "white", LINK)
        size = 20 + 60 * np.sqrt(chain.weight / chain.weight.max())
        ax.scatter(across[heavy], middle[heavy], s=size[heavy], c=face[heavy], edgecolors=LINK, zorder=3)
        for sign, colour in ((1, FORWARD), (-1, BACKWARD)):
            spun = np.flatnonzero(np.sign(rig.momentum) == sign)
            ax.hlines(middle[spun], across[spun] - 0.6, across[spun] + 0.6, color=colour, linewidth=4.0, zorder=3)
    elif rig.momentum.any():
        ax.axvspan(-0.5, 0.5, color=FORWARD, alpha=0.12)
    if rig.support_radius:
        ax.plot([-1.0, -1.0], [level.max(), level.min()], color="0.6", linestyle="-.", linewidth=0.9, zorder=1)
        ax.plot([-1.0, across[-1]], [0.0, 0.0], **ARM)
    held: dict[str, Any] = {"color": "black", "zorder": 4, "clip_on": False}
    if np.isfinite(rig.stiffness):
        tall = np.ptp(level)
        x = np.concatenate([[-1.0, -0.85], np.linspace(-0.8, -0.3, 9), [-0.25, 0.0]])
        zigzag = np.concatenate([[0.0, 0.0], np.tile([1.0, -1.0], 5)[:9], [0.0, 0.0]])
        ax.plot(x, 0.012 * tall * zigzag, color=LINK, linewidth=1.0, clip_on=False)
        ax.plot([-1.0, -1.0], [-0.03 * tall, 0.03 * tall], linewidth=2.5, **held)
        ax.plot(0.0, 0.0, marker="s", markersize=8.0 if rig.carriage_weight else 4.0, **held)
    else:
        ax.plot(across[-1], 0.0, marker="^" if stands.all() else "v", markersize=7.0, **held)
