# SPDX-License-Identifier: GPL-3.0-or-later
"""The questions of a study at each point, and the numbers of the systems of many points.

Points go in batches to `revchain.conical_heights`, or one by one through `_core.Points`, both without Python between
two points. `one_by_one` solves other points by the methods of `Scene`.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType
from numpy.typing import NDArray

from .. import _core
from ..results.modes import RigModes
from ..scenes.ask import DEFAULT_MODES, AskModes, AskResponse, AskShapes, Spread
from ..scenes.chain import Numbers
from ..scenes.scene import Scene, is_by_mass
from ..scenes.tables import Displaced, Flywheel, Support, TaperedChain, UniformChain
from ..systems.chain import Chain
from ..systems.numbers import LARGEST, Floats
from ..systems.rig import Rig
from .axes import Path

Arrays = dict[str, NDArray[Any]]
SUCCESS, NOT_MET, REFUSED = 0, 1, 2
STATUS = ("success", "tolerance_not_met", "refused")

MAX_LINKS = 100  # the accuracy of batches was measured up to this number
_BATCH_ULP = 16.0  # error of heights of batches, in ulp, that counts verify; a quarter for each link is added
_FULL = 4.5e-16  # `revchain.modes` takes double-double for a tolerance below this
_LINK = ("weight", "mass", "length", "centroid", "radius_of_gyration", "pendulum_length")
_UNIFORM = ("weight", "mass", "length")
_METHODS = (UNSET, "bisection", "condensed", "aberth", "interpolated")
_SPEED = ("angular_speed", "conical_height", "error_bound", "speed_error_bound")
_SHAPE = ("lowest_inclination", "top_inclination", "free_end_offset", "top_tension")
_RESPONSE = ("angular_speed", "free_end_offset", "largest_offset", "support_force", "error_bound")
_OF_RESPONSE = ["support_force" if name == "support_force" else f"response_{name}" for name in _RESPONSE]


@dataclass(frozen=True)
class Block:
    """A result of each point: one number, or one for each mode, shape or speed."""

    name: str
    kind: str  # "f8", "i8" or "?"; NaN, 0 or False stands where nothing was found
    along: str = ""  # "mode", "shape", "speed", or empty for one number
    labels: tuple[int, ...] = ()  # numbers of the modes, shapes or speeds

    def memory(self, points: int) -> NDArray[Any]:
        """An uninitialized array for the values at this number of points."""
        return np.empty((points, *self.each), self.kind)

    @property
    def nothing(self) -> float:
        """The value in place of a missing result."""
        return math.nan if self.kind == "f8" else 0

    @property
    def each(self) -> tuple[int, ...]:
        """The shape of the results of one point."""
        return (len(self.labels),) if self.along else ()

    @property
    def columns(self) -> list[str]:
        """Names of its columns in a table."""
        return [f"{self.name}_{label}" for label in self.labels] if self.along else [self.name]


# ---- what the scene asks


def _asked_modes(scene: Scene) -> AskModes:
    return AskModes() if isinstance(scene.ask.modes, UnsetType) else scene.ask.modes


def _first(scene: Scene) -> int:
    """Number of the first mode asked for."""
    first = _asked_modes(scene).first
    return 1 if isinstance(first, UnsetType) else first


def asked_of(scene: Scene, wanted: Sequence[str] | UnsetType, numbers: Numbers) -> tuple[str, ...]:
    """The questions in the order of the columns: `wanted`, or those of the scene. Errors are noted."""
    asked: list[str] = [name for name in ("modes", "shapes", "response") if name in scene.asks] or ["modes"]
    if isinstance(wanted, UnsetType):
        for name in set(scene.asks) - {"modes", "shapes", "response"}:
            numbers.refuse(f"scene.ask.{name}", 'is not for studies; say what is: find = ["modes"]')
    else:
        for k, name in enumerate(wanted):
            if name not in ("modes", *asked):
                numbers.refuse(f"find[{k}]", f"the scene does not say at which speed: [ask.{name}]")
        asked = [name for name in ("modes", "shapes", "response") if name in wanted]
    for name in ("conical_height", "angular_speed"):
        if "modes" in asked and getattr(_asked_modes(scene), name) is not UNSET:
            numbers.refuse(f"scene.ask.modes.{name}", "gives each point another number of modes; give count and first")
    if "response" in asked and (scene.is_held or scene.cord is not UNSET):
        numbers.refuse("scene.ask.response", f"does not go with {'held' if scene.is_held else 'cord'}")
    if "modes" in asked and scene.held is not UNSET and scene.held.span is not UNSET:
        numbers.refuse("scene.held.span", 'makes the chain bent, without modes: write find = ["shapes"]')
    return tuple(asked)


def blocks_of(scene: Scene, largest: Scene, find: tuple[str, ...], max_shapes: int, bounds: bool) -> tuple[Block, ...]:
    """The results of each point; `largest` is the scene of the point with the most modes."""
    blocks: list[Block] = []
    system = scene.system()
    if "modes" in find:
        labels = tuple(range(_first(scene), _first(scene) + _modes_of(scene, largest)))
        names = list(_SPEED[: (4 if scene.is_rigged else 3) if bounds else 2])
        turns = ["forward_", "backward_"] if isinstance(system, Rig) and system.has_momentum else ["forward_"]
        for turn in turns if scene.is_rigged else [""]:
            blocks += [Block(turn + name, "f8", "mode", labels) for name in names]
        if scene.is_rigged:
            blocks += [Block("other_modes", "i8"), Block("modes_complete", "?")]
    if "shapes" in find:
        labels = tuple(range(1, max_shapes + 1))
        blocks += [Block("shapes", "i8"), Block("shapes_complete", "?"), Block("half_waves", "i8", "shape", labels)]
        blocks += [Block(name, "f8", "shape", labels) for name in (*_SHAPE, *["shape_error_bound"] * bounds)]
    if "response" in find:
        speeds = Columns(scene, 1).speeds_of_response({})[0].shape[1]
        labels = tuple(range(1, speeds + 1))
        names = _OF_RESPONSE if bounds else _OF_RESPONSE[:-1]
        blocks += [Block(name, "f8", "" if speeds == 1 else "speed", labels) for name in names]
    return tuple(blocks)


def _modes_of(scene: Scene, largest: Scene) -> int:
    """Number of modes with columns: those asked for, at most those of the point with the most modes."""
    asked, system = _asked_modes(scene).count, largest.system()
    if isinstance(asked, int):
        return asked
    if isinstance(system, Rig):
        there = 2 * (system.size + 1)  # in each direction
    else:
        there = system.size if isinstance(system, Chain) else getattr(system, "mode_count", None) or DEFAULT_MODES
    there = max(there - _first(scene) + 1, 1)
    return there if asked == "all" else min(DEFAULT_MODES, there)


def goes_in_batches(scene: Scene, paths: list[Path]) -> bool:
    """Whether all points are chains that differ only in numbers of their links, with questions that batches answer."""
    ask, chain = _asked_modes(scene), scene.system()
    if not isinstance(chain, Chain) or scene.tapered_chain is not UNSET or not _is_compiled(scene) or ask.certify:
        return False
    if chain.size > MAX_LINKS or chain.mode_count < chain.size or ask.method is not UNSET:
        return False
    if (rtol := _rtol(scene)) is not None and rtol < (_BATCH_ULP + chain.size / 4) * 2.0**-52:
        return False
    for path in paths:
        in_link = len(path) == 3 and path[0] == "links" and path[2] in _LINK
        in_uniform = len(path) == 2 and path[0] == "uniform_chain" and path[1] in _UNIFORM
        if not (in_link or in_uniform or path == ("gravity",)):
            return False
    return not any(_has_tip(table) for _, table in _tables(scene))


def _rtol(scene: Scene) -> float | None:
    rtol = _asked_modes(scene).rtol
    return None if isinstance(rtol, UnsetType) else Numbers("scene").value("rtol", rtol, "rtol", "not negative")


def derives_speeds(scene: Scene) -> bool:
    """Whether speeds follow from the heights by `conical_pendulum.angular_speed`, so that they are not stored."""
    return not scene.is_rigged and _is_compiled(scene)


def _is_compiled(scene: Scene) -> bool:
    """Whether `_core.Points` can solve the scene."""
    ask, response = _asked_modes(scene), scene.ask.response
    own_radius = isinstance(response, AskResponse) and response.support_radius is not UNSET
    tight = 0 < (_rtol(scene) or 0) < _FULL
    alone = not (scene.is_held or scene.cord is not UNSET or own_radius or tight)
    return alone and ask.precision == "double" and ask.method in _METHODS


def _tables(scene: Scene) -> list[tuple[Path, Any]]:
    """The tables of the chain and their places, lowest first."""
    if isinstance(scene.links, list):
        return [(("links", index), link) for index, link in scene._links()]
    name = "tapered_chain" if isinstance(scene.uniform_chain, UnsetType) else "uniform_chain"
    return [((name,), getattr(scene, name))]


def _has_tip(table: Any) -> bool:
    return table.tip_mass is not UNSET or table.tip_weight is not UNSET or bool(getattr(table, "clamped", False))


# ---- the numbers of many points


class Columns:
    """The numbers of the systems of many points that differ only in numbers; for one thread.

    The operations and their order are those for one scene, so the numbers are equal to the last bit. `wrong` marks the
    points with a number that a scene refuses and the solvers would accept.
    """

    def __init__(self, scene: Scene, max_points: int) -> None:
        self._scene, self._max_points = scene, max_points
        self._numbers: dict[Path, float] = {}
        self._memory: dict[str, Floats] = {}
        self._points: Mapping[Path, Floats] = {}
        self.by_mass = is_by_mass(scene)
        self._places, self._tables = zip(*_tables(scene), strict=True)
        self._repeats = [getattr(table, "repeat", 1) for table in self._tables]
        self.wrong: Any = False

    def bodies(self, points: Mapping[Path, Floats]) -> dict[str, Floats]:
        """Weight, length and, unless all links are point masses, centroid and radius of gyration of each link.

        The shape is (1, N) if all points have equal numbers, else (points, N). The arrays are valid until the next call.
        """
        self._points, self.wrong = points, False
        gravity = self._gravity()
        bodies = [self._body(place, table, gravity) for place, table in zip(self._places, self._tables, strict=True)]
        repeats = self._repeats if isinstance(self._scene.links, list) else [self._tables[0].count]
        names = ["weight", "length", "centroid", "radius_of_gyration"]
        if all(body[2] is None for body in bodies):
            names = names[:2]
        else:
            bodies = [body if body[2] is not None else (body[0], body[1], body[1], 0.0) for body in bodies]
        return {name: self._column(name, [body[k] for body in bodies], repeats) for k, name in enumerate(names)}

    def systems(self, points: Mapping[Path, Floats], count: int) -> _core.Points:
        """The numbers of `bodies` and of all other parts of the scene, for a compiled loop."""
        scene, kind = self._scene, "links"
        if isinstance(scene.links, list):
            tables = self.bodies(points)
            links = sum(self._repeats)
        else:
            self._points, self.wrong = points, False
            table, place = self._tables[0], self._places[0]
            kind = table.kind if isinstance(table, UniformChain) else "tapered"
            links = table.count
            tables = {"length": self._alone(self._number(table, place, "length", "length", "positive"))}
            tables["weight"] = self._alone(self._weight(table, place, self._gravity(), "positive"))
            if isinstance(table, TaperedChain):
                tables["exponent"] = self._alone(self._number(table, place, "exponent", "", "any"))
        marked = any(_has_tip(table) for table in self._tables)
        if marked:
            gravity = self._gravity()
            tips = [
                self._weight(table, place, gravity, "not negative", "tip_", 0.0)
                for place, table in zip(self._places, self._tables, strict=True)
            ]
            tables["tip"] = self._column("tip", tips, [1] * len(tips))
        clamped = [bool(getattr(table, "clamped", False)) for table in self._tables]
        first = np.cumsum([0, *self._repeats])[:-1].tolist()
        standing = self._rig(tables) if scene.is_rigged else []
        turning = scene.fluid == "turning"
        if not marked:
            clamped, first = [], []
        return _core.Points(count, links, kind, tables, clamped, first, scene.is_rigged, standing, turning, self.by_mass)

    def speed_of_shapes(self, points: Mapping[Path, Floats]) -> tuple[Floats, bool]:
        """The speed or height of the shapes at each point, and whether it is a speed."""
        self._points = points
        table = self._scene.ask.shapes
        name = "conical_height" if getattr(table, "angular_speed", UNSET) is UNSET else "angular_speed"
        return self._alone(self._number(table, ("ask", "shapes"), name, name, "any")), name == "angular_speed"

    def speeds_of_response(self, points: Mapping[Path, Floats]) -> tuple[Floats, bool]:
        """The speeds or heights of the response, a row for each point or one for all, and whether they are speeds."""
        self._points = points
        table = self._scene.ask.response
        assert isinstance(table, AskResponse)
        name = "conical_height" if table.angular_speed is UNSET else "angular_speed"
        said, place = getattr(table, name), ("ask", "response", name)
        if isinstance(said, Spread):
            ends = [self._value((*place, end), value, name) for end, value in (("from", said.first), ("to", said.last))]
            spread: Any = np.geomspace if said.log else np.linspace
            first, last = np.broadcast_arrays(*map(np.atleast_1d, ends))
            with np.errstate(invalid="ignore"):
                rows = [spread(*pair, said.steps) for pair in zip(first, last, strict=True)]
            return np.array(rows), name == "angular_speed"
        if not isinstance(said, list):
            return self._alone(self._value(place, said, name)), name == "angular_speed"
        columns = [np.atleast_1d(self._value((*place, k), each, name)) for k, each in enumerate(said)]
        return np.stack(np.broadcast_arrays(*columns), axis=-1), name == "angular_speed"

    def _value(self, path: Path, given: Any, quantity: str) -> Any:
        """A number of a list or a range, for each point or for the scene."""
        if path in self._points:
            return self._points[path]
        return Numbers("scene").value("", given, quantity, "any")

    def gravity(self, points: Mapping[Path, Floats]) -> Floats:
        """Gravity of each point, shape (points, 1), or of all, shape (1, 1)."""
        self._points = points
        return self._alone(self._gravity())

    def _gravity(self) -> Any:
        return self._number(self._scene, (), "gravity", "gravity", "positive")

    def _number(self, table: Any, place: Path, key: str, quantity: str, sign: str, otherwise: Any = None) -> Any:
        """The number of a key of a table, for each point or as in the table."""
        path = (*place, key)
        if path in self._points:
            values = self._points[path]
            if sign != "any":
                wrong = ~(values > 0) if sign == "positive" else ~(values >= 0)
                self.wrong = self.wrong | wrong if wrong.any() else self.wrong
            return values
        if path not in self._numbers:
            given = getattr(table, key)
            if given is UNSET:
                return otherwise
            self._numbers[path] = Numbers("scene").value(key, given, quantity, sign)
        return self._numbers[path]

    def _weight(self, table: Any, place: Path, gravity: Any, sign: str, prefix: str = "", otherwise: Any = None) -> Any:
        weight = self._number(table, place, f"{prefix}weight", "weight", sign)
        mass = self._number(table, place, f"{prefix}mass", "mass", sign) if weight is None else None
        return weight if weight is not None else otherwise if mass is None else mass if self.by_mass else mass * gravity

    def _body(self, place: Path, table: Any, gravity: Any) -> tuple[Any, Any, Any, Any]:
        """Weight, length, centroid and radius of gyration; None for the last two of a point mass."""
        length = self._number(table, place, "length", "length", "positive")
        if isinstance(table, UniformChain):
            length = length / table.count
            weight = self._weight(table, place, gravity, "positive") / table.count
        else:
            weight = self._weight(table, place, gravity, "not negative")
        if table.kind in ("rod", "rods"):
            return weight, length, length / 2, length / math.sqrt(12)
        if isinstance(table, UniformChain) or table.centroid is UNSET:
            return weight, length, None, None
        centroid = self._number(table, place, "centroid", "length", "any")
        if table.radius_of_gyration is not UNSET:
            return weight, length, centroid, self._number(table, place, "radius_of_gyration", "length", "not negative")
        pendulum = self._number(table, place, "pendulum_length", "length", "any")
        with np.errstate(invalid="ignore"):
            radius = np.sqrt(centroid * (pendulum - centroid))
        return weight, length, centroid, np.where(np.equal(centroid, 0), np.nan, radius)[()]

    def _rig(self, tables: dict[str, Floats]) -> list[bool]:
        """Add the fittings of the rig to the tables; return which links stand, or none."""
        scene, gravity = self._scene, self._gravity()
        if isinstance(scene.support, Support):
            support, place = scene.support, ("support",)
            stiffness = self._number(support, place, "stiffness", "stiffness", "positive", math.inf)
            tables["stiffness"] = self._alone(stiffness)
            carriage = self._weight(support, place, gravity, "not negative", "", 0.0)
            radius = self._number(support, place, "radius", "length", "not negative", 0.0)
            tables |= {"carriage_weight": self._alone(carriage), "support_radius": self._alone(radius)}
        if not isinstance(scene.links, list):
            return []
        pairs = zip(self._places, self._tables, strict=True)
        links = [(place, link) for place, link in pairs if not link.clamped]  # those belong to the link above
        repeats = [link.repeat for _, link in links]
        if any(link.flywheel is not UNSET for _, link in links):
            wheels = [self._flywheel(link.flywheel, (*place, "flywheel"), gravity) for place, link in links]
            for k, name in enumerate(("wheel_weight", "wheel_radius_of_gyration", "spin", "driven")):
                tables[name] = self._column(name, [wheel[k] for wheel in wheels], repeats)
        if any(link.displaced is not UNSET for _, link in links):
            fluids = [self._displaced(link.displaced, (*place, "displaced"), gravity) for place, link in links]
            names = ["displaced_weight", "added_weight", "displaced_centroid", "displaced_radius_of_gyration"]
            if all(link.displaced is UNSET or link.displaced.radius_of_gyration is UNSET for _, link in links):
                names.pop()
            for k, name in enumerate(names):
                tables[name] = self._column(name, [fluid[k] for fluid in fluids], repeats)
        standing = [link.standing for _, link in links]
        return np.repeat(standing, repeats).tolist() if any(standing) else []

    def _flywheel(self, table: Flywheel | UnsetType, place: Path, gravity: Any) -> tuple[Any, ...]:
        if isinstance(table, UnsetType):
            return 0.0, 0.0, 0.0, 0.0
        radius = self._number(table, place, "radius_of_gyration", "length", "not negative")
        heavy = self._weight(table, place, gravity, "not negative")
        return heavy, radius, self._number(table, place, "spin", "spin", "any"), float(table.driven)

    def _displaced(self, table: Displaced | UnsetType, place: Path, gravity: Any) -> tuple[Any, Any, Any, Any]:
        """Displaced weight, added weight, centroid and radius of gyration; NaN for those of the link."""
        if isinstance(table, UnsetType):
            return 0.0, 0.0, math.nan, math.nan
        return (
            self._weight(table, place, gravity, "not negative"),
            self._weight(table, place, gravity, "not negative", "added_", 0.0),
            self._number(table, place, "centroid", "length", "any", math.nan),
            self._number(table, place, "radius_of_gyration", "length", "not negative", math.nan),
        )

    @staticmethod
    def _alone(value: Any) -> Floats:
        """A column with one row for each point, or one for all."""
        return np.reshape(np.asarray(value, float), (-1, 1))

    def _column(self, name: str, parts: list[Any], repeats: list[int]) -> Floats:
        """An array with a number for each link; parts that do not vary are written once."""
        column = self._memory.get(name)
        varied = [part for part in parts if isinstance(part, np.ndarray)]
        fresh = column is None
        if column is None:
            column = self._memory[name] = np.empty((self._max_points if varied else 1, sum(repeats)))
        points, first = len(varied[0]) if varied else 1, 0
        for part, repeat in zip(parts, repeats, strict=True):
            if isinstance(part, np.ndarray):
                column[:points, first : first + repeat] = part[:, np.newaxis]
            elif fresh:
                column[:, first : first + repeat] = part
            first += repeat
        return column[:points]


def refused_by_chains(links: Mapping[str, Floats], count: int) -> NDArray[np.bool_]:
    """Whether each chain has numbers that `revchain.Chain` is known to refuse."""
    wrong = np.zeros(count, bool)
    for name, column in links.items():
        right = np.isfinite(column)
        if name in ("weight", "radius_of_gyration"):
            right &= column >= 0
        elif name == "length":
            right &= column > 0
        wrong |= ~right.all(axis=-1)
        if name == "weight":
            wrong |= column[..., 0] <= 0
    return wrong


def solve_compiled(
    scene: Scene,
    find: tuple[str, ...],
    blocks: tuple[Block, ...],
    points: Mapping[Path, Floats],
    count: int,
    progress: _core.Progress,
) -> tuple[Arrays, NDArray[np.uint8]] | None:
    """Results and status of points that differ from the scene in these numbers; None if they need a scene each."""
    if not _is_compiled(scene):
        return None
    columns, ask = Columns(scene, count), _asked_modes(scene)
    systems = columns.systems(points, count)
    gravity = columns.gravity(points)
    found: Arrays = {}
    status = np.where(np.broadcast_to(columns.wrong, count), REFUSED, SUCCESS).astype(np.uint8)
    size = {block.along: len(block.labels) for block in blocks}
    if "modes" in find:
        first, limit = _first(scene), None if isinstance(ask.count, UnsetType) else ask.count
        count_of = LARGEST if limit == "all" else limit
        if scene.is_rigged:
            asked = DEFAULT_MODES if count_of is None else count_of
            good, tables, other, complete = systems.rig_modes(size["mode"], first, asked, gravity, progress)
            names = [f"{turn}_{name}" for turn in ("forward", "backward") for name in _SPEED]
            found |= dict(zip(names, tables, strict=True)) | {"other_modes": other, "modes_complete": complete}
        else:
            how = (_rtol(scene), ask.certify, "auto" if isinstance(ask.method, UnsetType) else ask.method, progress)
            good, height, bound = systems.modes(size["mode"], first, count_of, *how)
            found |= {"conical_height": height, "error_bound": bound}
        status = np.maximum(status, good)
    if "shapes" in find:
        given, speeds = columns.speed_of_shapes(points)
        shapes = scene.ask.shapes
        assert isinstance(shapes, AskShapes)
        options = (speeds, shapes.direction, shapes.hanging_only, gravity, progress)
        good, number, complete, half_waves, tables = systems.steady_shapes(size["shape"], given, *options)
        found |= {"shapes": number, "shapes_complete": complete, "half_waves": half_waves}
        found |= dict(zip((*_SHAPE, "shape_error_bound"), tables, strict=True))
        status = np.maximum(status, good)
    if "response" in find:
        given, speeds = columns.speeds_of_response(points)
        good, tables = systems.response(given, speeds, gravity, progress)
        found |= dict(zip(_OF_RESPONSE, tables, strict=True))
        status = np.maximum(status, good)
    if columns.by_mass:
        found |= {name: gravity * found[name] for name in ("top_tension", "support_force") if name in found}
    kept = {block.name: found[block.name].reshape(count, *block.each) for block in blocks if block.name in found}
    for block in blocks:
        if block.name in kept:
            kept[block.name][status == REFUSED] = block.nothing
    return kept, status


def one_by_one(scene: Scene, find: tuple[str, ...]) -> tuple[dict[str, Any], bool]:
    """The results of one scene, by the names of the blocks, and whether all of them are proved."""
    found: dict[str, Any] = {}
    good = True
    if "modes" in find:
        modes: Any = scene.modes()
        if isinstance(modes, RigModes):
            for turn, which in (("forward", modes.direction > 0), ("backward", modes.direction < 0)):
                found |= {f"{turn}_{name}": np.abs(getattr(modes, name)[which]) for name in _SPEED}
            found |= {"other_modes": modes.other_available, "modes_complete": modes.complete}
        else:
            found |= {name: getattr(modes, name) for name in _SPEED[:3]}
        good = modes.status == "success"
    if "shapes" in find:
        shapes: Any = scene.steady_shapes()
        found |= {"shapes": len(shapes), "shapes_complete": shapes.complete, "half_waves": [s.half_waves for s in shapes]}
        for name, field in zip(_SHAPE, ("inclination", "inclination", "offset", "tension"), strict=True):
            found[name] = [getattr(s, field)[-1 if name.startswith("top") else 0] for s in shapes]
        found["shape_error_bound"] = shapes.error_bound
        good = good and bool(shapes.complete)
    if "response" in find:
        moved = scene.response()
        offset = np.atleast_2d(moved.offset)
        largest = np.abs(offset).max(axis=1)
        numbers = [moved.angular_speed, offset[:, 0], largest, moved.support_force, moved.error_bound]
        found |= dict(zip(_OF_RESPONSE, map(np.atleast_1d, numbers), strict=True))
        good = good and bool(np.isfinite(moved.error_bound).all())
    return found, good
