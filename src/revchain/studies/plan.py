# SPDX-License-Identifier: GPL-3.0-or-later
"""The plan of a study: its axes, the results of each point, and their computation; a worker needs nothing else."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np
from msgspec import UNSET, UnsetType, convert
from numpy.typing import NDArray

from ..results.sheet import in_unit
from ..scenes.tables import DEFAULT_MODES, AskModes, Spread
from ..scenes.system import Numbers
from ..scenes.scene import Scene
from .axes import Axis, with_value
from .batch import Links

SUCCESS, NOT_MET, REFUSED = 1, 2, 3  # the status of a point; 0 if it has not been computed
STATUS = ("success", "tolerance_not_met", "refused")
Values = list[NDArray[Any]]  # the numbers of each axis, one for each point
Rows = dict[str, NDArray[Any]]  # arrays by name, with a row for each point
Labels = dict[str, tuple[int, ...]]  # by name of an output its modes, shapes or speeds; empty for one number


class Output(NamedTuple):
    """A result that a study can store, and how it is found."""

    question: str  # one of `STUDIED`
    of: Callable[[Any], Any]  # one number, or a list of them, from the answer to the question
    unit: str = ""
    kind: str = "f8"  # "f8", "i8" or "?"; NaN, 0 or False stands for a missing result
    along: str = ""  # "mode", "shape", "speed", "order" ..., or empty for one number
    only: str = ""  # "rig", "spinning" (a rig with momentum), "still" (without), "still rig", "stops" or "turning"; or all


def _of_modes(name: str, modes: Any) -> Any:
    return getattr(modes, name, ())


def _turning(name: str, sign: int, modes: Any) -> Any:
    return np.abs(getattr(modes, name)[modes.direction == sign]) if hasattr(modes, name) else ()


def _of_each(name: str, link: int, shapes: Any) -> list[Any]:
    return [getattr(shape, name)[link] for shape in shapes]


def _between_stops(name: str, found: Any) -> float:
    """A number of a governor, which is the answer to a question without a speed."""
    return getattr(getattr(found, "governor", found), name)  # type: ignore[no-any-return]


def _first_crossings(found: Any) -> list[float]:
    """The lowest speed at which a frequency meets each multiple of the speed; NaN if none does."""
    met = {order: [one.angular_speed for one in found.crossings if one.order == order] for order in found.orders}
    return [min(met[order], default=math.nan) for order in found.orders]


def _signed(numbers: Any) -> Any:
    """Numbers with their signs; of complex ones, with dashpots, the sizes."""
    return np.abs(numbers) if np.iscomplexobj(numbers) else numbers


_OF_MODES = {"angular_speed": "rad/s", "conical_height": "m", "error_bound": "", "speed_error_bound": ""}
_TURNS = (("forward", 1, "spinning"), ("backward", -1, "spinning"))
_ANSWERS = {
    "modes": Scene.modes, "shapes": Scene.steady_shapes, "response": Scene.response, "campbell": Scene.campbell,
    "drag": Scene.drag_shape, "equilibria": Scene.equilibria,
}  # fmt: skip
STUDIED = tuple(_ANSWERS)
WAYS = {"angular_speed": "rad/s", "rpm": "rpm", "frequency": "Hz", "period": "s"}  # of finding the speeds of modes: unit by name
_OF_STOPS = {"lowest_speed": "rad/s", "highest_speed": "rad/s", "lift": "m", "sensitiveness": "", "insensitiveness": ""}
_OF_EQUILIBRIA = {"inclination": "rad", "lift": "m", "ball_radius": "m", "period": "s"}
OUTPUTS = {
    **{
        name: Output("modes", partial(_of_modes, name), _OF_MODES[name], "f8", "mode", "still")
        for name in list(_OF_MODES)[:3]
    },
    "speed_error_bound": Output("modes", attrgetter("speed_error_bound"), "", "f8", "mode", "still rig"),
    **{
        f"{turn}_{name}": Output("modes", partial(_turning, name, sign), unit, "f8", "mode", only)
        for turn, sign, only in _TURNS
        for name, unit in _OF_MODES.items()
    },
    "other_modes": Output("modes", attrgetter("other_available"), kind="i8", only="rig"),
    "modes_complete": Output("modes", attrgetter("complete"), kind="?", only="rig"),
    "shapes": Output("shapes", len, kind="i8"),
    "shapes_complete": Output("shapes", attrgetter("complete"), kind="?"),
    "half_waves": Output("shapes", lambda shapes: [shape.half_waves for shape in shapes], kind="i8", along="shape"),
    "lowest_inclination": Output("shapes", partial(_of_each, "inclination", 0), "rad", along="shape"),
    "top_inclination": Output("shapes", partial(_of_each, "inclination", -1), "rad", along="shape"),
    "free_end_offset": Output("shapes", partial(_of_each, "offset", 0), "m", along="shape"),
    "top_tension": Output("shapes", partial(_of_each, "tension", -1), "N", along="shape"),
    "shape_error_bound": Output("shapes", lambda shapes: [shape.error_bound for shape in shapes], along="shape"),
    "response_angular_speed": Output("response", attrgetter("angular_speed"), "rad/s", along="speed"),
    "response_free_end_offset": Output("response", lambda moved: _signed(moved.offset[..., 0]), "m", along="speed"),
    "response_largest_offset": Output("response", lambda moved: np.abs(moved.offset).max(axis=-1), "m", along="speed"),
    "support_force": Output("response", lambda moved: _signed(moved.support_force), "N", along="speed"),
    "response_error_bound": Output("response", attrgetter("_error"), along="speed"),
    "first_crossing": Output("campbell", _first_crossings, "rad/s", along="order"),
    "lowest_frequency": Output("campbell", attrgetter("lowest"), "rad/s", along="campbell_speed"),
    "stable": Output("campbell", attrgetter("stable"), kind="?", along="campbell_speed"),
    "drag_torque": Output("drag", attrgetter("torque"), "N m"),
    "drag_power": Output("drag", attrgetter("power"), "W"),
    "drag_factor": Output("drag", attrgetter("factor")),
    **{
        f"{'sleeve_' * (name == 'lift')}{name}": Output("equilibria", partial(_between_stops, name), unit, only="stops")
        for name, unit in _OF_STOPS.items()
    },
    "equilibria": Output("equilibria", len, kind="i8", only="turning"),
    **{
        f"equilibrium_{name}": Output("equilibria", attrgetter(name), unit, along="equilibrium", only="turning")
        for name, unit in _OF_EQUILIBRIA.items()
    },
    "equilibrium_stable": Output("equilibria", attrgetter("stable"), kind="?", along="equilibrium", only="turning"),
}


@dataclass(frozen=True, eq=False)
class Plan:
    """The data that a worker needs; they can be sent to another process."""

    base: dict[str, Any]  # the scene as plain data
    axes: tuple[Axis, ...]
    shape: tuple[int, ...]  # number of values of each grid, then of samples; the last one varies fastest
    seed: int
    find: tuple[str, ...]  # of `STUDIED`
    outputs: Labels
    ways: tuple[str, ...]  # of `WAYS`, if speeds of modes are wanted in other units, or nothing else of modes
    links: Links | None  # how links follow the varied numbers, if heights come from `revchain.conical_heights`
    all_of_modes: bool  # whether all outputs of modes are stored, or only the speeds in `ways`

    @property
    def points(self) -> int:
        """Number of points."""
        return math.prod(self.shape)

    def rows(self, points: int) -> Rows:
        """Arrays for the results and the status of this number of points."""
        found = {
            name: np.zeros((points, len(labels)) if labels else points, OUTPUTS[name].kind)
            for name, labels in self.outputs.items()
        }
        return {**found, "status": np.zeros(points, np.int8)}

    def values(self) -> Values:
        """The numbers of each axis at all points."""
        grids = [axis.values for axis in self.axes if axis.values is not None]
        samples, meshes = self.points // math.prod(map(len, grids)), iter(np.meshgrid(*grids, indexing="ij"))
        return [
            axis.drawn(self.seed, self.points) if axis.values is None else np.repeat(next(meshes), samples)
            for axis in self.axes
        ]

    def scene(self, values: Sequence[Any]) -> dict[str, Any]:
        data = self.base
        for axis, value in zip(self.axes, values, strict=True):
            data = with_value(data, axis.path, value)
        return data

    def solve(self, values: Values, rows: Rows | None = None) -> Rows:
        """Results at points with these numbers, put into `rows` if given."""
        rows = self.rows(len(values[0])) if rows is None else rows
        if self.links is not None:
            self.links.solve(values, self.outputs["conical_height"][0], rows)
        left = np.flatnonzero(rows["status"] == 0)
        for name in self.outputs if left.size else ():
            rows[name][left] = math.nan if OUTPUTS[name].kind == "f8" else 0
        fixed, built = None, None  # the system of the point before, and the varied numbers on which it depends
        for k, *numbers in zip(left.tolist(), *(column[left].tolist() for column in values), strict=True):
            try:
                scene = convert(self.scene(numbers), Scene)  # the questions check the scene
                given = [number for number, axis in zip(numbers, self.axes, strict=True) if axis.path[0] != "ask"]
                if given == fixed:
                    scene._made()["system"] = built
                fixed, built = given, scene._built()
                found, proved = answers(scene, self.find)
            except (ValueError, OverflowError):
                rows["status"][k] = REFUSED
                continue
            rows["status"][k] = SUCCESS if proved else NOT_MET
            for name, labels in self.outputs.items():
                result = OUTPUTS[name].of(found[OUTPUTS[name].question])
                if labels:
                    there = min(len(result), len(labels))
                    rows[name][k, :there] = result[:there]
                else:
                    rows[name][k : k + 1] = result
        return rows


def answers(scene: Scene, find: Sequence[str]) -> tuple[dict[str, Any], bool]:
    """The answers to these questions of a scene, and whether all are complete and proved."""
    found: dict[str, Any] = {question: _ANSWERS[question](scene) for question in find}
    proved = [
        "modes" not in found or found["modes"].status == "success",
        "drag" not in found or found["drag"].status == "success",
        "shapes" not in found or found["shapes"].complete,
        "response" not in found or np.isfinite(found["response"]._error).all(),
    ]
    return found, all(proved)


def asked_of(scene: Scene, wanted: Sequence[str] | UnsetType, numbers: Numbers) -> tuple[str, ...]:
    """The questions in the order of the columns: `wanted`, or those of the scene. Errors are noted."""
    asked: list[str] = [name for name in STUDIED if name in scene.asks]
    always = "modes" if scene.governor is UNSET else "equilibria"
    if isinstance(wanted, UnsetType):
        asked = asked or [always]
        for name in set(scene.asks) - set(STUDIED):
            numbers.refuse(f"scene.ask.{name}", 'is not for studies; say what is: find = ["modes"]')
    else:
        wanted = list(dict.fromkeys("modes" if name in WAYS else name for name in wanted))
        for k, name in enumerate(wanted):
            if name == ("equilibria" if always == "modes" else "modes"):
                numbers.refuse(f"find[{k}]", f'has no answer for this system: write "{always}"')
            elif name not in (always, *asked):
                numbers.refuse(f"find[{k}]", f"the scene does not say at which speed: [ask.{name}]")
        asked = [name for name in STUDIED if name in wanted]
    for name in ("conical_height", "angular_speed"):
        if "modes" in asked and getattr(scene.ask.modes, name, UNSET) is not UNSET:
            numbers.refuse(f"scene.ask.modes.{name}", "gives each point another number of modes; give count and first")
    for name in ("response", "campbell"):
        if name in asked and (scene.is_held or scene.cord is not UNSET):
            numbers.refuse(f"scene.ask.{name}", f"does not go with {'held' if scene.is_held else 'cord'}")
    governor = scene.governor
    if "equilibria" in asked and not isinstance(governor, UnsetType):
        if governor.lowest_inclination is UNSET and not _turns(scene):
            numbers.refuse("scene.governor", "gives no number to store: write its two stops, or a speed in [ask.equilibria]")
    if "modes" in asked and not isinstance(scene.held, UnsetType) and scene.held.span is not UNSET:
        numbers.refuse("scene.held.span", 'makes the chain bent, without modes: write find = ["shapes"]')
    return tuple(asked)


def outputs_of(
    scene: Scene, largest: Scene, find: tuple[str, ...], max_shapes: int, bounds: bool, varied: bool
) -> Labels:
    """The outputs of a study; `largest` is the scene with the most links.

    `varied` says that a varied number may give the top pin inertia, a spring, or neither.
    """
    spins = getattr(scene.system(), "has_momentum", False)
    kinds = ["", *["rig"] * scene.is_rigged, *(["spinning"] if spins else ["still", *["still rig"] * scene.is_rigged])]
    if not isinstance(scene.governor, UnsetType):
        stops = scene.governor.lowest_inclination is not UNSET
        kinds = ["", *["stops"] * stops, *["turning"] * _turns(scene)]
    several = tuple(range(1, max_shapes + 1))
    labels: dict[str, tuple[int, ...]] = {"": (), "shape": several, "equilibrium": several}
    if "modes" in find:
        labels["mode"] = _modes_of(scene, largest, varied)
    if not isinstance(ask := scene.ask.campbell, UnsetType) and "campbell" in find:
        labels["order"] = (1, 2) if isinstance(ask.orders, UnsetType) else tuple(dict.fromkeys(ask.orders))
    for name, dimension in (("response", "speed"), ("campbell", "campbell_speed")):
        if name in find:
            count = _speeds_of(getattr(scene.ask, name))
            labels[dimension] = tuple(range(1, count + 1)) if count > 1 else ()
    return {
        name: labels[output.along]
        for name, output in OUTPUTS.items()
        if output.question in find and output.only in kinds and (bounds or not name.endswith("error_bound"))
    }


def said(plan: Plan, name: str) -> dict[str, tuple[str, Callable[[Any], Any]]]:
    """The variables in which a study stores an output: by name the unit and its conversion."""
    found: dict[str, tuple[str, Callable[[Any], Any]]] = {}
    if plan.all_of_modes or OUTPUTS[name].question != "modes":
        found[name] = OUTPUTS[name].unit, np.asarray
    for way in plan.ways if OUTPUTS[name].question == "modes" and name.endswith("angular_speed") else ():
        found[name.replace("angular_speed", way)] = WAYS[way], partial(in_unit, unit=WAYS[way])
    return found


def columns_of(name: str, labels: tuple[int, ...]) -> list[str]:
    return [f"{name}_{label}" for label in labels] or [name]


def _modes_of(scene: Scene, largest: Scene, varied: bool) -> tuple[int, ...]:
    """Numbers of the modes with columns."""
    ask = scene.ask.modes
    system: Any = largest.system()
    ask = AskModes() if isinstance(ask, UnsetType) else ask
    first = 1 if isinstance(ask.first, UnsetType) else ask.first
    if system._kind == "rig":
        there = 2 * (system.size + 1) if system.has_momentum else system.size + (varied or _top_moves(system))
    elif system._is_held and not system._is_cord:  # pins without mass in the scene may have one at a point
        there = system.size - 1 + sum(end.stiffness < math.inf for end in (system.lower, system.upper))
    else:
        there = system.size if system._kind == "chain" else system.mode_count or DEFAULT_MODES
    there = max(there - first + 1, 1)
    if isinstance(ask.count, int):
        count = ask.count if system._is_cord else min(ask.count, there)
    else:
        count = there if ask.count == "all" else min(DEFAULT_MODES, there)
    return tuple(range(first, first + count))


def _top_moves(rig: Any) -> bool:
    """Return whether the top pin adds a mode: it is on a spring and has inertia."""
    top = rig.chain
    is_plummet = top.centroid[-1] == top.length[-1] and top.radius_of_gyration[-1] == 0 and rig.displaced is None
    return bool(0 < rig.support.stiffness < math.inf and (rig.support.carriage or not is_plummet))


def _turns(scene: Scene) -> bool:
    """Return whether a governor is asked for its equilibria at one speed."""
    return not isinstance(scene.ask.equilibria, UnsetType) and scene.ask.equilibria.angular_speed is not UNSET


def _speeds_of(ask: Any) -> int:
    given = ask.conical_height if ask.angular_speed is UNSET else ask.angular_speed
    return given.steps if isinstance(given, Spread) else len(given) if isinstance(given, list) else 1
