# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths into the plain data of a scene, such as ``links[0].mass``."""

from __future__ import annotations

import re
from typing import Any

from ..scenes.error import SceneError

Step = str | int
Path = tuple[Step, ...]

_PATH = re.compile(r"[a-z_]+(\[\d{1,9}\])?(\.[a-z_]+(\[\d{1,9}\])?)*")
ASKED = re.compile(r"ask\.(shapes\.(angular_speed|conical_height)|response\.(angular_speed|conical_height)\[\d+\])")


def path_of(text: str, refuse: SceneError) -> Path:
    """The steps of a path; `refuse` is raised with a sentence where it is none."""
    if _PATH.fullmatch(text) is None:
        raise SceneError(refuse.source, refuse.key, "is no path into a scene such as links[0].mass")
    if text.partition(".")[0] in ("title", "description", "schema_version", "held") and text.count(".") == 0:
        raise SceneError(refuse.source, refuse.key, "is nothing to vary")
    if text.startswith("ask") and ASKED.fullmatch(text) is None:
        reason = "what is asked is the same at all points, but for the speeds of ask.shapes and ask.response"
        raise SceneError(refuse.source, refuse.key, reason)
    return tuple(int(index) if index else name for name, index in re.findall(r"([a-z_]+)|\[(\d+)\]", text))


def quantity_of(path: Path) -> str:
    """The quantity of the number there, a key of `_units.SI`."""
    from ..systems.units import SI

    name = next(step for step in reversed(path) if isinstance(step, str))
    return {"tension": "weight", "until": "time", "velocity": "speed"}.get(name, name if name in SI else "length")


def with_value(data: Any, path: Path, value: Any, refuse: SceneError) -> Any:
    """A copy of `data` with the value there; what does not lie on the path is shared."""
    if not path:
        return value
    step, rest = path[0], path[1:]
    if isinstance(step, str):
        table = data if isinstance(data, dict) else {}
        return {**table, step: with_value(table.get(step), rest, value, refuse)}
    if not isinstance(data, list) or step >= len(data):
        count = len(data) if isinstance(data, list) else 0
        there = f"there are {count}, counted from 0" if count else "there is no such list"
        raise SceneError(refuse.source, refuse.key, f"the scene has nothing at [{step}]: {there}")
    return [*data[:step], with_value(data[step], rest, value, refuse), *data[step + 1 :]]
