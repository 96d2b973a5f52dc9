# SPDX-License-Identifier: GPL-3.0-or-later
"""Sheets for chains held at both ends."""

from __future__ import annotations

from typing import Any

import numpy as np

from ..questions.held import HeldShape, HeldShapes, TautModes
from ..results.base import Result
from ..results.sheet import Column, Sheet, speed_columns

Found = Result | HeldShapes[HeldShape] | TautModes


def sheet_of(found: Found, gravity: float) -> Sheet:
    """The sheet of any of them."""
    if isinstance(found, Result):
        return found._sheet()
    return _taut(found, gravity) if isinstance(found, TautModes) else _held(found, gravity)


def _of(shapes: Any, name: str) -> list[Any]:
    return [getattr(shape, name) for shape in shapes]


def _held(shapes: HeldShapes[HeldShape], gravity: float) -> Sheet:
    tension, lower, upper = (_of(shapes, name) for name in ("tension", "lower_pull", "upper_pull"))
    columns = [
        Column("half_waves", _of(shapes, "half_waves"), "half waves"),
        Column("sag", [float(np.abs(x).max()) for x in _of(shapes, "offset")], "sag (m)"),
        Column("lower_tension", [float(x[0]) for x in tension], "tension at bottom (N)"),
        Column("upper_tension", [float(x[-1]) for x in tension], "tension at top (N)"),
        Column("lower_side_pull", [float(x[0]) for x in lower], "side pull at bottom (N)"),
        Column("upper_side_pull", [float(x[0]) for x in upper], "side pull at top (N)"),
        Column("error_bound", _of(shapes, "error_bound"), "error bound (rad)"),
    ]
    columns += [Column(name, _of(shapes, name), axes=("pin",)) for name in ("inclination", "offset", "height", "tension")]
    count = f"{len(shapes)} shape{'s' * (len(shapes) != 1)} between two points of the axis"
    missing = ", ".join(str(k) for k in shapes.missing)
    return Sheet(
        "shape",
        count + (f"; none was found of {missing} half waves" if missing else ""),
        columns,
        {"gravity": gravity, "missing": list(shapes.missing)},
        ["side pull: on the bearing, towards the lowest free pin's side", "error bound: of every inclination"],
        not missing,
    )


def _taut(modes: TautModes, gravity: float) -> Sheet:
    speed = np.asarray(modes.angular_speed(gravity))
    columns = [
        Column("mode", list(range(1, speed.size + 1)), "mode"),
        *speed_columns(speed),
        Column("conical_height", modes.conical_height, "height (m)", 10),
        Column("error_bound", modes.error_bound, "error bound"),
        Column("shape", modes.shape, axes=("pin",)),
    ]
    notes = ["height: of the equivalent conical pendulum; error bound: relative, of the height"]
    heading = f"straight between two points of the axis, tension {modes.tension:g} N at the lower"
    return Sheet("mode", heading, columns, {"gravity": gravity, "tension": modes.tension}, notes)
