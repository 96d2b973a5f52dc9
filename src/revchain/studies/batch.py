# SPDX-License-Identifier: GPL-3.0-or-later
"""Many chains in one call of `revchain.conical_heights`, if their links follow the varied numbers in proportion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType, structs
from numpy.typing import NDArray

from ..questions.batch import conical_heights
from ..scenes.tables import AskModes
from ..scenes.system import Numbers
from ..scenes.scene import Scene
from ..systems.chain import Chain
from ..systems.numbers import Floats
from .axes import Axis, with_value

MAX_LINKS = 100  # the accuracy of `conical_heights` was measured up to this number
SLICE = 16384  # chains in one call: their numbers stay in the cache of the processor
_VERIFIED = 16.0  # errors of `conical_heights` in ulp that counts verify; a quarter for each link is added
_NAMES = ("weight", "length", "centroid", "radius_of_gyration")


@dataclass(frozen=True, eq=False)
class Links:
    """The numbers of all links: a factor for each, times the varied numbers that it follows."""

    factor: Floats  # shape (4, links): weight, length, centroid, radius of gyration
    follows: NDArray[np.bool_]  # shape (axes, 4, links)
    gravity: float  # unless it varies

    def columns(self, values: Sequence[Floats]) -> dict[str, Any]:
        """The arguments of `conical_heights` at points with these values of the axes."""
        found = {}
        for k, name in enumerate(_NAMES[: 2 if self.are_plummets else 4]):
            follows = self.follows[:, k]
            table = np.empty((len(values[0]) if follows.any() else 1, follows.shape[1]))
            for link, factor in enumerate(self.factor[k]):
                product = factor
                for axis in np.flatnonzero(follows[:, link]).tolist():
                    product = np.multiply(product, values[axis], out=table[:, link])
                table[:, link] = product
            found[name] = table
        return found

    @property
    def are_plummets(self) -> bool:
        """Whether all links are point masses at every point."""
        same = np.array_equal(self.factor[1], self.factor[2]) and np.array_equal(self.follows[:, 1], self.follows[:, 2])
        return same and not self.factor[3].any()

    def solve(self, values: Sequence[Floats], first: int, to: Mapping[str, Floats]) -> None:
        """Put heights and status 1 into `to`, a row for each point; the first column is of mode `first`.

        Points stay unchanged if `conical_heights` refuses them or a varied number is not positive.
        """
        usual = np.logical_and.reduce([column > 0 for column in values])
        rows = None if usual.all() else np.flatnonzero(usual)
        for start in range(0, len(usual) if rows is None else len(rows), SLICE):
            part = slice(start, min(start + SLICE, len(usual)))
            self._solve(values, part if rows is None else rows[part], first, to)

    def _solve(self, values: Any, rows: slice | NDArray[np.int64], first: int, to: Any) -> None:
        """Solve some points; if they are refused, each half of them."""
        count = first - 1 + to["conical_height"].shape[1]
        try:
            heights = conical_heights(**self.columns([column[rows] for column in values]), count=count)[:, first - 1 :]
        except ValueError:
            each = np.arange(len(values[0]))[rows]
            for half in np.array_split(each, 2) if len(each) > 1 else ():
                self._solve(values, half, first, to)
        else:
            to["conical_height"][rows], to["status"][rows] = heights, 1


def links_of(scene: Scene, axes: Sequence[Axis]) -> Links | None:
    """How the links follow the varied numbers; None unless `conical_heights` answers the question for each point.

    The scene itself is asked: each number is varied alone by a quarter, then all of them together by unequal parts.
    """
    if not _is_answered(scene) or not all(axis.is_number for axis in axes):
        return None
    middle = np.array([np.mean(axis.examples()) for axis in axes])
    if not (middle > 0).all():
        return None

    def links_at(values: Floats) -> Floats:
        data = scene.to_dict()
        for axis, value in zip(axes, values.tolist(), strict=True):
            data = with_value(data, axis.path, value)
        chain = Scene.from_dict(data).system()
        assert isinstance(chain, Chain)
        heavy = chain.mass if chain.by_mass else chain.weight
        return np.array([heavy, chain.length, chain.centroid, chain.radius_of_gyration])

    try:
        own = links_at(middle)
        alone = np.array([links_at(np.where(np.arange(len(axes)) == k, 1.25, 1) * middle) for k in range(len(axes))])
        follows = alone != own
        product = np.array([np.where(follows[k], middle[k], 1.0) for k in range(len(axes))]).prod(axis=0)
        together = middle * (1 + 0.3 / np.arange(2, len(axes) + 2))
        found = Links(own / product, follows, scene.gravity_value())
        columns = found.columns(list(together[:, np.newaxis]))
        expected = links_at(together)[: len(columns)]
    except ValueError:
        return None
    rtol = 4e-16 * (1 + len(axes))
    right = all(np.allclose(column[0], own, rtol, 0) for column, own in zip(columns.values(), expected, strict=True))
    return found if right else None


def _is_answered(scene: Scene) -> bool:
    """Whether `conical_heights` answers what the scene asks about its modes."""
    ask, chain = scene.ask.modes, scene.system()
    if not isinstance(chain, Chain) or chain.size > MAX_LINKS or chain.mode_count < chain.size:
        return False
    if isinstance(ask, UnsetType):
        return True
    if structs.replace(ask, count=UNSET, first=UNSET, rtol=UNSET) != AskModes():
        return False
    rtol = 1.0 if isinstance(ask.rtol, UnsetType) else Numbers("scene").value("rtol", ask.rtol, "rtol", "not negative")
    return rtol >= (_VERIFIED + chain.size / 4) * 2.0**-52
