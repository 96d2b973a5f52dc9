# SPDX-License-Identifier: GPL-3.0-or-later
"""Guaranteed extremes of the speeds of a study over the intervals of its random numbers."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np

from ..results.enclosures import EPS, Family
from ..results.modes import Modes
from ..results.sheet import in_unit
from ..results.worst import WorstCase, data_of, extremes, refuse_unbounded, worst_of
from ..scenes.scene import Scene
from ..scenes.tables import Table, says
from ..systems.numbers import Floats
from .plan import WAYS, Plan, Values

SPEEDS = ("lowest_angular_speed", "lowest_reached", "highest_reached", "highest_angular_speed")


class Scatter(Table, frozen=True):
    """The search for extremes over random numbers, beside the results of each point."""

    worst: Annotated[
        bool,
        says("Whether to find proved lowest and highest speeds of modes over intervals of uniform or log_uniform numbers."),
    ] = False


def why_no_worst(plan: Plan) -> str:
    """The reason why a study has no guaranteed extremes; empty if it has them."""
    random = [axis for axis in plan.axes if axis.values is None]
    if not random:
        return "is for random numbers, and none are varied: write uniform = [low, high]"
    for axis in random:
        if axis.law == "normal":
            return f'needs intervals, and {axis.key} is normal: write uniform = [middle, "5 %"]'
    if plan.find != ("modes",):
        return 'is for modes alone: write find = ["modes"]'
    try:
        _family(plan, [axis.values[0].item() if axis.values is not None else math.nan for axis in plan.axes])
    except ValueError as error:
        return str(error).removeprefix("scatter.worst: ").removeprefix("scene: ")
    return ""


def _family(plan: Plan, numbers: Sequence[Any]) -> tuple[Family, Modes, tuple[float, float]]:
    """The systems at a point of the grids, the modes of the middle one, and the lowest and highest gravity."""
    where = [k for k, axis in enumerate(plan.axes) if axis.values is None]
    low, high = np.array([plan.axes[k].law_numbers for k in where]).T
    middle = (low + high) / 2

    def scene_at(values: Floats) -> Scene:
        given = list(numbers)
        for k, value in zip(where, values.tolist(), strict=True):
            given[k] = value
        return Scene.from_dict(plan.scene(given))

    found = scene_at(middle).modes()
    refuse_unbounded("scatter.worst", found.system)
    if found.system._is_cord:
        raise ValueError("scatter.worst: has no proof for [cord]: cut it into links, [tapered_chain]")
    gravity = found.gravity, found.gravity

    def data(values: Floats) -> Floats:
        scene = scene_at(values)
        return data_of(scene.system(), scene.gravity_value())

    own, follows = data(middle), list[Any]()
    for k, axis in enumerate(plan.axes[at] for at in where):
        alone = data(np.where(np.arange(len(where)) == k, 1.25, 1.0) * middle)
        with np.errstate(invalid="ignore"):
            ratio = np.nan_to_num(np.where(own == alone, 1.0, alone / own), nan=math.inf)
        changed = np.abs(ratio - 1) > 1e-13
        if (np.abs(ratio[changed] - 1.25) > 1e-12).any():
            raise ValueError(f"scatter.worst: needs numbers to which the data of links are proportional, and {axis.key} is not")
        follows.append(changed)
        if axis.path == ("gravity",):
            gravity = float(low[k]), float(high[k])
    made = np.array(follows)
    base = own / np.where(made, middle[:, None], 1.0).prod(axis=0)
    ends = low - 4 * EPS * np.abs(low), high + 4 * EPS * np.abs(high)
    family = Family(base, made, ends[0], middle, ends[1])
    together = middle * (1 + 0.3 / np.arange(2, len(where) + 2))
    if not np.allclose(family.data(together), data(together), 1e-12, 0):
        raise ValueError("scatter.worst: needs data of links that are products of the varied numbers, and they are not")
    return family, found, gravity


def worst_cases(plan: Plan, values: Values) -> dict[str, tuple[list[str], Floats, dict[str, str]]]:
    """The extremes of the speeds at each point of the grids, as variables of a data set."""
    grids = [axis.name for axis in plan.axes if axis.values is not None]
    name = next(each for each in ("angular_speed", "forward_angular_speed") if each in plan.outputs)
    labels = plan.outputs[name]
    shape = (*plan.shape[:-1], len(labels))
    table = {speed: np.full((math.prod(plan.shape[:-1]), len(labels)), math.nan) for speed in SPEEDS}
    for row in range(math.prod(plan.shape[:-1])):
        point = row * plan.shape[-1]
        try:
            family, modes, gravity = _family(plan, [column[point].item() for column in values])
        except ValueError:  # a point of the grid that is refused has no numbers
            continue
        found: WorstCase = worst_of(extremes(family, modes.number), modes.number, gravity, lambda _: {})
        for speed in SPEEDS:
            table[speed][row, : len(modes)] = getattr(found, speed)[: len(labels)]
    stored = {speed: ([*grids, "mode"], each.reshape(shape), {"units": "rad/s"}) for speed, each in table.items()}
    said = dict(stored) if plan.all_of_modes else {}
    for way, unit in WAYS.items():
        for end, speed in zip(("lowest", "highest"), (SPEEDS[0], SPEEDS[-1])[:: -1 if unit == "s" else 1], strict=True):
            if way in plan.ways:
                said[f"{end}_{way}"] = [*grids, "mode"], in_unit(stored[speed][1], unit), {"units": unit}
    return said
