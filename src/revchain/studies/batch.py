# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves many points of a study in one call of `revchain.conical_heights`.

This needs every number of every link to be a constant times a product of varied numbers.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from contextlib import suppress
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

    factor: Floats  # a row each for weight and length and, unless all links are point masses, for the rest of `_NAMES`
    follows: NDArray[np.bool_]  # shape (axes, rows, links)
    gravity: float  # unless it varies
    gravity_axis: int | None

    def arguments(self, values: Sequence[Floats]) -> dict[str, Any]:
        """The arguments of `conical_heights` at points with these values of the axes."""
        found = {}
        for name, factors, follows in zip(_NAMES, self.factor, np.swapaxes(self.follows, 0, 1), strict=False):
            table = np.empty((len(values[0]) if follows.any() else 1, len(factors)))
            for link, product in enumerate(factors):
                for axis in np.flatnonzero(follows[:, link]).tolist():
                    product = np.multiply(product, values[axis], out=table[:, link])
                table[:, link] = product
            found[name] = table
        return found

    def solve(self, values: Sequence[Floats], first: int, to: Mapping[str, NDArray[Any]]) -> None:
        """Put heights, speeds and status 1 into `to`, a row for each point; the first column is of mode `first`.

        Points stay unchanged if `conical_heights` refuses them or a varied number is not positive.
        """
        size, each = to["conical_height"].shape
        if size <= SLICE and all(column.min() > 0 for column in values):
            with suppress(ValueError):
                heights = conical_heights(**self.arguments(values), count=first - 1 + each)[:, first - 1 :]
                gravity = self.gravity if self.gravity_axis is None else values[self.gravity_axis][:, np.newaxis]
                to["conical_height"][:], to["status"][:] = heights, 1
                np.divide(np.sqrt(gravity), np.sqrt(heights), out=to["angular_speed"])
                return
        for half in (slice(size // 2), slice(size // 2, size)) if size > 1 else ():
            self.solve([column[half] for column in values], first, {name: array[half] for name, array in to.items()})


def links_of(scene: Scene, axes: Sequence[Axis]) -> Links | None:
    """Return how each number of the links depends on the varied ones; None if `conical_heights` cannot answer the study.

    It builds the scene at trial values: each number alone raised by a quarter, then all together by unequal parts.
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
        together = middle * (1 + 0.3 / np.arange(2, len(axes) + 2))
        expected = links_at(together)
    except ValueError:
        return None
    follows = alone != own
    factor = own / np.where(follows, middle[:, np.newaxis, np.newaxis], 1.0).prod(axis=0)
    are_plummets = np.array_equal(own[1], own[2]) and np.array_equal(follows[:, 1], follows[:, 2]) and not own[3].any()
    rows = 2 if are_plummets else 4
    gravity_axis = next((k for k, axis in enumerate(axes) if axis.path == ("gravity",)), None)
    found = Links(factor[:rows], follows[:, :rows], scene.gravity_value(), gravity_axis)
    rtol = 4e-16 * (1 + len(axes))
    pairs = zip(found.arguments(list(together[:, np.newaxis])).values(), expected[:rows], strict=True)
    return found if all(np.allclose(one[0], two, rtol, 0) for one, two in pairs) else None


def _is_answered(scene: Scene) -> bool:
    """Return whether `conical_heights` answers what the scene asks about its modes."""
    ask, chain = scene.ask.modes, scene.system()
    if not isinstance(chain, Chain) or chain.size > MAX_LINKS or chain.mode_count < chain.size:
        return False
    if isinstance(ask, UnsetType):
        return True
    if structs.replace(ask, count=UNSET, first=UNSET, rtol=UNSET) != AskModes():
        return False
    rtol = 1.0 if isinstance(ask.rtol, UnsetType) else Numbers("scene").value("rtol", ask.rtol, "rtol", "not negative")
    return rtol >= (_VERIFIED + chain.size / 4) * 2.0**-52
