# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of a study that are plain chains of equally many links, as the arrays of `revchain.conical_heights`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import UNSET
from numpy.typing import NDArray

from ..scenes.chain import Numbers
from ..scenes.tables import Link, UniformChain
from ..systems.numbers import Floats
from .paths import Path

if TYPE_CHECKING:
    from ..scenes.scene import Scene

MOST_LINKS = 100  # as far as the accuracy of the batches has been measured
_LINK = ("weight", "mass", "length", "centroid", "radius_of_gyration", "pendulum_length")
_UNIFORM = ("weight", "mass", "length")

Points = Mapping[Path, Floats]
_Body = tuple[Any, Any, Any, Any, bool]


def goes_in_batches(scene: Scene, paths: list[Path]) -> bool:
    """Whether all points are chains that differ in the numbers of their links alone, asked as batches answer."""
    ask = scene.ask
    if scene.tapered_chain is not UNSET:
        return False
    if scene.is_rigged or scene.is_held or ask.rtol is not UNSET or ask.certify:
        return False
    if ask.precision != "double" or ask.method != "auto":
        return False
    if any(window is not UNSET for window in (ask.conical_height, ask.angular_speed)):
        return False
    for path in paths:
        in_link = len(path) == 3 and path[0] == "links" and path[2] in _LINK
        in_uniform = len(path) == 2 and path[0] == "uniform_chain" and path[1] in _UNIFORM
        if not (in_link or in_uniform or path == ("gravity",)):
            return False
    chain = scene.chain()
    if chain.size > MOST_LINKS or chain.mode_count < chain.size:
        return False
    if isinstance(scene.uniform_chain, UniformChain):
        table = scene.uniform_chain
        return table.tip_mass is UNSET and table.tip_weight is UNSET
    assert isinstance(scene.links, list)
    return not any(link.clamped or link.tip_mass is not UNSET or link.tip_weight is not UNSET for link in scene.links)


class _Product:
    """Mass times gravity of each point, not formed yet."""

    def __init__(self, mass: Any, gravity: Any) -> None:
        self.factors = [
            factor[:, np.newaxis] if isinstance(factor, np.ndarray) else factor for factor in (mass, gravity)
        ]

    def __len__(self) -> int:
        return max(len(factor) for factor in self.factors if isinstance(factor, np.ndarray))

    def put(self, place: Floats) -> None:
        mass, gravity = self.factors
        np.multiply(mass, gravity, out=place)

    def __truediv__(self, count: int) -> Any:
        mass, gravity = self.factors
        return (mass * gravity)[:, 0] / count


class LinkColumns:
    """The numbers of the links of many points, for `revchain.conical_heights`; one thread's own.

    The same operations as for one scene, in the same order: the numbers are the same to the last bit.
    """

    def __init__(self, scene: Scene, most: int) -> None:
        self._scene = scene
        self._most = most  # points asked for at once
        self._numbers: dict[Path, float] = {}
        self._fixed: dict[int, _Body] = {}  # of tables in which nothing varies
        self._memory: dict[str, Floats] = {}
        if isinstance(scene.uniform_chain, UniformChain):
            repeats = [scene.uniform_chain.count]
        else:
            repeats = [link.repeat for link in scene.links]  # type: ignore[union-attr]
        ends = np.cumsum([0, *repeats]).tolist()
        self._slices = [slice(first, last) for first, last in zip(ends[:-1], ends[1:], strict=True)]
        self._size = ends[-1]

    def at(self, points: Points) -> dict[str, Floats]:
        """Weight, length and, of links that are not all plummets, centroid and radius of gyration.

        Of shape (N,) where all points have the same, else (points, N); valid until the next call.
        """
        bodies = self._bodies(points)
        names = ["weight", "length", "centroid", "radius_of_gyration"]
        if all(plummet for *_, plummet in bodies):
            names = names[:2]
        return {name: self._column(name, [body[k] for body in bodies]) for k, name in enumerate(names)}

    def _column(self, name: str, parts: list[Any]) -> Floats:
        """Parts that do not vary are written once; a product is formed where it belongs."""
        varied = [k for k, part in enumerate(parts) if isinstance(part, (np.ndarray, _Product))]
        column: Floats | None = self._memory.get(name)
        if column is None:
            column = np.empty((self._most if varied else 1, self._size))
            for k, part in enumerate(parts):
                if k not in varied:
                    column[:, self._slices[k]] = part
            self._memory[name] = column
        if not varied:
            only: Floats = column[0]
            return only
        size = len(parts[varied[0]])
        for k in varied:
            place = column[:size, self._slices[k]]
            if isinstance(parts[k], _Product):
                parts[k].put(place)
            else:
                place[...] = parts[k][:, np.newaxis]
        return column[:size]

    def _bodies(self, points: Points) -> list[_Body]:
        """Weight, length, centroid, radius of gyration of each table, and whether it is of plummets."""
        gravity = self._of(self._scene, (), "gravity", "gravity", points)
        if isinstance(self._scene.uniform_chain, UniformChain):
            return [self._uniform(self._scene.uniform_chain, gravity, points)]
        assert isinstance(self._scene.links, list)
        if not self._fixed and ("gravity",) not in points:
            varied = {path[1] for path in points}
            fixed = [index for index in range(len(self._scene.links)) if index not in varied]
            self._fixed = {k: self._body(self._scene.links[k], ("links", k), gravity, points) for k in fixed}
        return [
            self._fixed.get(index) or self._body(link, ("links", index), gravity, points)
            for index, link in enumerate(self._scene.links)
        ]

    def _of(self, table: Any, place: Path, key: str, quantity: str, points: Points) -> Any:
        """The number of a key of a table: of each point, or the table's own."""
        path = (*place, key)
        if path in points:
            return points[path]
        if path not in self._numbers:
            self._numbers[path] = Numbers("scene", "").value(key, getattr(table, key), quantity, "any")
        return self._numbers[path]

    def _weight(self, table: Any, place: Path, gravity: Any, points: Points) -> Any:
        if table.weight is not UNSET:
            return self._of(table, place, "weight", "weight", points)
        mass = self._of(table, place, "mass", "mass", points)
        if isinstance(mass, np.ndarray) or isinstance(gravity, np.ndarray):
            return _Product(mass, gravity)
        return mass * gravity

    def _uniform(self, table: UniformChain, gravity: Any, points: Points) -> _Body:
        place = ("uniform_chain",)
        length = self._of(table, place, "length", "length", points) / table.count
        weight = self._weight(table, place, gravity, points) / table.count
        if table.kind == "rods":
            return weight, length, length / 2, length / math.sqrt(12), False
        return weight, length, length, 0.0, True

    def _body(self, link: Link, place: Path, gravity: Any, points: Points) -> _Body:
        length = self._of(link, place, "length", "length", points)
        weight = self._weight(link, place, gravity, points)
        if link.kind == "rod":
            return weight, length, length / 2, length / math.sqrt(12), False
        if link.centroid is UNSET:
            return weight, length, length, 0.0, True
        centroid = self._of(link, place, "centroid", "length", points)
        if link.radius_of_gyration is not UNSET:
            return weight, length, centroid, self._of(link, place, "radius_of_gyration", "length", points), False
        squared = centroid * (self._of(link, place, "pendulum_length", "length", points) - centroid)
        with np.errstate(invalid="ignore"):
            return weight, length, centroid, np.sqrt(squared), False


def wrong_chains(links: Mapping[str, Floats], count: int) -> NDArray[np.bool_]:
    """Which of the chains have numbers that `revchain.Chain` is known to refuse."""
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
