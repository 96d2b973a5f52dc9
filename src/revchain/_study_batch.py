# SPDX-License-Identifier: GPL-3.0-or-later
"""Points of a study that are plain chains of equally many links, as the arrays of `revchain.conical_heights`."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import UNSET

from ._arguments import Floats
from ._scene_chain import Numbers
from ._scene_tables import Link, UniformChain
from ._study_paths import Path

if TYPE_CHECKING:
    from .scene import Scene

MOST_LINKS = 100  # as far as the accuracy of the batches has been measured
_LINK = ("weight", "mass", "length", "centroid", "radius_of_gyration", "pendulum_length")
_UNIFORM = ("weight", "mass", "length")

Points = Mapping[Path, Floats]


def goes_in_batches(scene: Scene, paths: list[Path]) -> bool:
    """Whether all points are chains that differ in the numbers of their links alone, asked as batches answer."""
    ask = scene.ask
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
    return not any(
        link.clamped or link.tip_mass is not UNSET or link.tip_weight is not UNSET for link in scene.links
    )


def gravity_at(scene: Scene, points: Points) -> float | Floats:
    """One for all points, or that of each."""
    return points.get(("gravity",), scene.gravity_value())


def links_at(scene: Scene, points: Points) -> dict[str, Floats]:
    """Weight, length and, of links that are not all plummets, centroid and radius of gyration.

    Of shape (N,) where all points have the same, else (points, N). The same operations as for one scene,
    in the same order: the numbers are the same to the last bit.
    """
    gravity = gravity_at(scene, points)
    if isinstance(scene.uniform_chain, UniformChain):
        tables: list[Any] = [scene.uniform_chain]
        bodies = [_uniform(scene.uniform_chain, gravity, points)]
        repeats = [scene.uniform_chain.count]
    else:
        assert isinstance(scene.links, list)
        tables = scene.links
        bodies = [_body(link, index, gravity, points) for index, link in enumerate(tables)]
        repeats = [link.repeat for link in tables]
    names = ("weight", "length", "centroid", "radius_of_gyration")
    if all(plummet for *_, plummet in bodies):
        names = names[:2]
    firsts = np.cumsum([0, *repeats])
    columns = {}
    for k, name in enumerate(names):
        varied = [np.ndim(body[k]) > 0 for body in bodies]
        size = next((len(body[k]) for body, each in zip(bodies, varied, strict=True) if each), None)
        column = np.empty((firsts[-1],) if size is None else (size, firsts[-1]))
        for body, first, last, each in zip(bodies, firsts[:-1], firsts[1:], varied, strict=True):
            column[..., first:last] = body[k][:, np.newaxis] if each else body[k]
        columns[name] = column
    return columns


def _of(table: Any, key: str, path: Path, quantity: str, points: Points) -> Any:
    """The number of a key of a table: of each point, or the table's own."""
    if path in points:
        return points[path]
    return Numbers("scene", "").value(key, getattr(table, key), quantity, "any")


def _weight(table: Any, place: Path, gravity: Any, points: Points) -> Any:
    if table.weight is not UNSET:
        return _of(table, "weight", (*place, "weight"), "weight", points)
    return _of(table, "mass", (*place, "mass"), "mass", points) * gravity


def _uniform(table: UniformChain, gravity: Any, points: Points) -> tuple[Any, Any, Any, Any, bool]:
    place = ("uniform_chain",)
    length = _of(table, "length", (*place, "length"), "length", points) / table.count
    weight = _weight(table, place, gravity, points) / table.count
    if table.kind == "rods":
        return weight, length, length / 2, length / math.sqrt(12), False
    return weight, length, length, 0.0, True


def _body(link: Link, index: int, gravity: Any, points: Points) -> tuple[Any, Any, Any, Any, bool]:
    """Weight, length, centroid, radius of gyration, and whether it is a plummet."""
    place = ("links", index)

    def of(key: str) -> Any:
        return _of(link, key, (*place, key), "length", points)

    length = of("length")
    weight = _weight(link, place, gravity, points)
    if link.kind == "rod":
        return weight, length, length / 2, length / math.sqrt(12), False
    if link.centroid is UNSET:
        return weight, length, length, 0.0, True
    centroid = of("centroid")
    if link.radius_of_gyration is not UNSET:
        return weight, length, centroid, of("radius_of_gyration"), False
    squared = centroid * (of("pendulum_length") - centroid)
    with np.errstate(invalid="ignore"):
        return weight, length, centroid, np.sqrt(squared), False
