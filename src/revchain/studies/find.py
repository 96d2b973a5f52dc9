# SPDX-License-Identifier: GPL-3.0-or-later
"""What is found at each point of a study, as arrays whose shape is the same at all points."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from msgspec import UNSET
from numpy.typing import NDArray

from ..results.modes import Modes, RigModes

if TYPE_CHECKING:
    from ..scenes.scene import Scene

Arrays = dict[str, NDArray[Any]]

SUCCESS, NOT_MET, REFUSED = 0, 1, 2
STATUS = ("success", "tolerance_not_met", "refused")


@dataclass(frozen=True)
class Block:
    """A result of each point: a number, or one for each mode, shape or speed.

    Attributes
    ----------
    name : str
    kind : str
        ``"f8"``, ``"i8"`` or ``"?"``; 0 and False stand where nothing was found, of ``"f8"`` NaN.
    along : str
        ``"mode"``, ``"shape"``, ``"speed"``, or empty for one number.
    labels : tuple of int
        Numbers of what it is along.
    """

    name: str
    kind: str
    along: str = ""
    labels: tuple[int, ...] = ()

    def memory(self, points: int) -> NDArray[Any]:
        """An array for so many points, with whatever lies there."""
        return np.empty((points, *self.each), dtype=self.kind)

    @property
    def each(self) -> tuple[int, ...]:
        """The shape of what one point has."""
        return (len(self.labels),) if self.along else ()

    @property
    def columns(self) -> list[str]:
        """Names of the columns of a table that hold it."""
        return [f"{self.name}_{label}" for label in self.labels] if self.along else [self.name]


def mode_blocks(scene: Scene, count: int, bounds: bool) -> list[Block]:
    """The blocks of the modes; `count` of them."""
    first = 1 if scene.ask.first is UNSET else int(scene.ask.first)
    labels = tuple(range(first, first + count))
    if not scene.is_rigged:
        names = ["angular_speed", "conical_height", *(["error_bound"] if bounds else [])]
        return [Block(name, "f8", "mode", labels) for name in names]
    senses = ["forward", "backward"] if scene.rig().momentum.any() else ["forward"]
    names = ["angular_speed", "conical_height", *(["error_bound", "speed_error_bound"] if bounds else [])]
    blocks = [Block(f"{sense}_{name}", "f8", "mode", labels) for sense in senses for name in names]
    return [*blocks, Block("other_modes", "i8"), Block("modes_complete", "?")]


def shape_blocks(most: int, bounds: bool) -> list[Block]:
    """The blocks of the steady shapes; so many are kept."""
    names = ["lowest_inclination", "top_inclination", "free_end_offset", "top_tension"]
    names += ["shape_error_bound"] if bounds else []
    labels = tuple(range(1, most + 1))
    blocks = [Block("shapes", "i8"), Block("shapes_complete", "?"), Block("half_waves", "i8", "shape", labels)]
    return blocks + [Block(name, "f8", "shape", labels) for name in names]


def response_blocks(speeds: int, bounds: bool) -> list[Block]:
    """The blocks of the response, of one speed or several."""
    names = ["response_angular_speed", "response_free_end_offset", "response_largest_offset", "support_force"]
    names += ["response_error_bound"] if bounds else []
    return [Block(name, "f8", "" if speeds == 1 else "speed", tuple(range(1, speeds + 1))) for name in names]


def found_at(scene: Scene, find: tuple[str, ...]) -> tuple[dict[str, Any], bool]:
    """Whatever is asked, by the names of the blocks, and whether all of it is proved."""
    found: dict[str, Any] = {}
    good = [_FIND[each](scene, found) for each in find]
    return found, all(good)


def put(arrays: Arrays, blocks: tuple[Block, ...], row: int, found: dict[str, Any]) -> None:
    """Into the arrays, as far as they reach."""
    for block in blocks:
        values = found[block.name]
        if not block.along:
            arrays[block.name][row] = np.asarray(values).reshape(-1)[0]
        else:
            count = min(len(block.labels), len(values))
            arrays[block.name][row, :count] = values[:count]


def _modes(scene: Scene, found: dict[str, Any]) -> bool:
    modes = scene.modes()
    if isinstance(modes, RigModes):
        _whirls(found, "forward", modes, modes.direction > 0)
        _whirls(found, "backward", modes, modes.direction < 0)
        found |= {"other_modes": len(modes.other), "modes_complete": modes.complete}
        return modes.status == "success"
    found |= {
        "angular_speed": modes.angular_speed if isinstance(modes, Modes) else modes.angular_speed(scene.gravity_value()),
        "conical_height": modes.conical_height,
        "error_bound": modes.error_bound,
    }
    return modes.status == "success" if isinstance(modes, Modes) else True


def _whirls(found: dict[str, Any], direction: str, modes: RigModes, which: NDArray[np.bool_]) -> None:
    for name in ("angular_speed", "conical_height", "error_bound", "speed_error_bound"):
        found[f"{direction}_{name}"] = np.abs(getattr(modes, name)[which])


def _shapes(scene: Scene, found: dict[str, Any]) -> bool:
    shapes: Any = scene.steady_shapes()
    complete = not shapes.missing if scene.is_held else shapes.complete
    found |= {
        "shapes": len(shapes),
        "shapes_complete": complete,
        "half_waves": [shape.half_waves for shape in shapes],
        "lowest_inclination": [shape.inclination[0] for shape in shapes],
        "top_inclination": [shape.inclination[-1] for shape in shapes],
        "free_end_offset": [shape.offset[0] for shape in shapes],
        "top_tension": [shape.tension[-1] for shape in shapes],
        "shape_error_bound": [shape.error_bound for shape in shapes],
    }
    return bool(complete)


def _response(scene: Scene, found: dict[str, Any]) -> bool:
    response = scene.response()
    offset = np.atleast_2d(response.offset)
    found |= {
        "response_angular_speed": np.atleast_1d(response.angular_speed),
        "response_free_end_offset": offset[:, 0],
        "response_largest_offset": np.abs(offset).max(axis=1),
        "support_force": np.atleast_1d(response.support_force),
        "response_error_bound": np.atleast_1d(response.error_bound),
    }
    return bool(np.isfinite(response.error_bound).all())


_FIND: dict[str, Callable[[Scene, dict[str, Any]], bool]] = {
    "modes": _modes,
    "shapes": _shapes,
    "response": _response,
}
