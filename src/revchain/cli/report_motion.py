# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes and motions of a scene as a table for the terminal, as JSON and as CSV."""

from __future__ import annotations

import csv
import io
from dataclasses import dataclass
from typing import Any

import numpy as np
from rich.console import Group
from rich.text import Text

from ..questions.held import HeldShape, HeldShapes, TautModes
from ..questions.response import Response, SmallOscillation
from ..questions.shapes import SteadyShapes
from ..results.sheet import MOST_ROWS, digits
from ..systems.numbers import Floats
from .report import empty_grid, json_of

Found = SteadyShapes | HeldShapes[HeldShape] | Response | SmallOscillation | TautModes


@dataclass(frozen=True)
class Column:
    """A column: its name in files, its heading and unit in tables, its numbers, how many digits of them are shown."""

    name: str
    heading: str
    unit: str
    values: Any
    digits: int = 6

    def cell(self, k: int) -> str:
        """Number k as the table shows it."""
        value = self.values[k]
        if isinstance(value, bool | np.bool_):
            return "yes" if value else "no"
        if isinstance(value, int | np.integer):
            return f"{value:,}"
        return f"{value:.1e}" if self.name == "error_bound" else digits(float(value), self.digits)


@dataclass(frozen=True)
class Sheet:
    """What a table shows, and what goes into files besides: `arrays` belong to the rows, `facts` to the whole."""

    heading: str
    columns: list[Column]
    arrays: dict[str, Any]
    facts: dict[str, Any]
    notes: list[str]
    good: bool = True

    @property
    def rows(self) -> int:
        """How many."""
        return len(self.columns[0].values)


def sheet_of(found: Found, gravity: float) -> Sheet:
    """The sheet of any of them."""
    if isinstance(found, SteadyShapes):
        return _steady(found)
    if isinstance(found, HeldShapes):
        return _held(found)
    if isinstance(found, TautModes):
        return _taut(found, gravity)
    return _response(found) if isinstance(found, Response) else _swing(found)


def table(found: Found, title: str, gravity: float) -> Group:
    """The table with its heading; of many rows some, evenly spaced."""
    sheet = sheet_of(found, gravity)
    grid = empty_grid(f"{column.heading}\n{column.unit}" for column in sheet.columns)
    shown = np.unique(np.linspace(0, sheet.rows - 1, min(sheet.rows, MOST_ROWS)).round().astype(int))
    for k in shown if sheet.rows else ():
        grid.add_row(*(column.cell(int(k)) for column in sheet.columns))
    parts: list[Any] = [Text(title, style="bold"), Text(sheet.heading, style="" if sheet.good else "bold yellow"), grid]
    if len(shown) < sheet.rows:
        parts.append(Text(f"{len(shown)} of {sheet.rows:,} rows; --json and --csv write all of them", style="dim"))
    parts += [Text(note, style="dim") for note in sheet.notes]
    return Group(*parts)


def json_text(found: Found, title: str, gravity: float) -> str:
    """Everything, with all digits; what is not finite is null."""
    sheet = sheet_of(found, gravity)
    columns = {column.name: column.values for column in sheet.columns} | sheet.arrays
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    return json_of({"title": title, "gravity": gravity, **sheet.facts, "rows": rows})


def csv_text(found: Found, gravity: float) -> str:
    """The columns of the table with all their rows and digits, then the arrays, numbers separated by blanks."""
    sheet = sheet_of(found, gravity)
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([*(column.name for column in sheet.columns), *sheet.arrays])
    columns = [np.asarray(column.values).tolist() for column in sheet.columns]
    arrays = [[" ".join(map(repr, np.asarray(row).tolist())) for row in rows] for rows in sheet.arrays.values()]
    writer.writerows(zip(*columns, *arrays, strict=True))
    return text.getvalue()


def _of(shapes: Any, name: str) -> list[Any]:
    return [getattr(shape, name) for shape in shapes]


def _steady(shapes: SteadyShapes) -> Sheet:
    inclination = _of(shapes, "inclination")
    columns = [
        Column("shape", "shape", "", list(range(1, len(shapes) + 1))),
        Column("half_waves", "half", "waves", _of(shapes, "half_waves")),
        Column("lowest_inclination", "lowest", "link, °", [float(np.degrees(x[0])) for x in inclination]),
        Column("top_inclination", "top", "link, °", [float(np.degrees(x[-1])) for x in inclination]),
        Column("free_end_offset", "free end", "off axis, m", [float(x[0]) for x in _of(shapes, "offset")]),
        Column("free_end_height", "free end", "height, m", [float(x[0]) for x in _of(shapes, "height")]),
        Column("top_tension", "tension", "top, N", [float(x[-1]) for x in _of(shapes, "tension")]),
        Column("error_bound", "error", "rad", _of(shapes, "error_bound")),
    ]
    names = ("inclination", "offset", "height", "tension", "reaction_inclination")
    count = f"{len(shapes)} shape{'s' * (len(shapes) != 1)}"
    heading = f"{count}, proved to be all" if shapes.complete else f"{count}; there may be more"
    return Sheet(
        heading,
        columns,
        {name: _of(shapes, name) for name in names},
        {"complete": shapes.complete, "undecided": shapes.undecided},
        ["inclinations: to the downward vertical; error: proved bound of every inclination"],
        shapes.complete,
    )


def _held(shapes: HeldShapes[HeldShape]) -> Sheet:
    columns = [
        Column("half_waves", "half", "waves", _of(shapes, "half_waves")),
        Column("sag", "sag", "m", [float(np.abs(x).max()) for x in _of(shapes, "offset")]),
        Column("lower_tension", "tension at", "bottom, N", [float(x[0]) for x in _of(shapes, "tension")]),
        Column("upper_tension", "tension at", "top, N", [float(x[-1]) for x in _of(shapes, "tension")]),
        Column("lower_side_pull", "side pull", "bottom, N", [float(x[0]) for x in _of(shapes, "lower_pull")]),
        Column("upper_side_pull", "side pull", "top, N", [float(x[0]) for x in _of(shapes, "upper_pull")]),
        Column("error_bound", "error bound", "rad", _of(shapes, "error_bound")),
    ]
    count = f"{len(shapes)} shape{'s' * (len(shapes) != 1)} between two points of the axis"
    missing = ", ".join(str(k) for k in shapes.missing)
    notes = ["side pull: on the bearing, towards the lowest free pin's side", "error bound: of every inclination"]
    return Sheet(
        count + (f"; none was found of {missing} half waves" if missing else ""),
        columns,
        {name: _of(shapes, name) for name in ("inclination", "offset", "height", "tension")},
        {"missing": list(shapes.missing)},
        notes,
        not missing,
    )


def _taut(modes: TautModes, gravity: float) -> Sheet:
    speed = np.asarray(modes.angular_speed(gravity))
    columns = [
        Column("mode", "mode", "", list(range(1, speed.size + 1))),
        *_speed_columns(speed),
        Column("conical_height", "height", "m", modes.conical_height, 10),
        Column("error_bound", "error", "bound", modes.error_bound),
    ]
    notes = ["height: of the equivalent conical pendulum; error bound: relative, of the height"]
    heading = f"straight between two points of the axis, tension {modes.tension:g} N at the lower"
    return Sheet(heading, columns, {"shape": modes.shape}, {"tension": modes.tension}, notes)


def _speed_columns(speed: Floats, shown: int = 6) -> list[Column]:
    return [
        Column("angular_speed", "speed", "rad/s", speed, shown),
        Column("revolutions_per_minute", "speed", "rev/min", speed * (30 / np.pi), shown),
    ]


def _response(found: Response) -> Sheet:
    speed, bound = np.atleast_1d(found.angular_speed), np.atleast_1d(found.error_bound)
    offset = np.atleast_2d(found.offset)
    columns = [
        *_speed_columns(speed, 5),
        Column("modes_below", "modes", "below", np.atleast_1d(found.modes_below)),
        Column("free_end_offset", "free end", "off axis, m", offset[:, 0], 5),
        Column("amplification", "over", "support", offset[:, 0] / found.support_radius, 4),
        Column("largest_offset", "farthest", "pin, m", np.abs(offset).max(axis=1), 5),
        Column("support_force", "pull on", "support, N", np.atleast_1d(found.support_force), 5),
        Column("error_bound", "error", "bound", bound),
    ]
    notes = [
        "negative: against the support; nan: a resonance",
        "error bound: of every offset, over the largest; pull: of the chain, outwards",
    ]
    heading = f"support carried round a circle of {found.support_radius:g} m, or to and fro as far"
    return Sheet(
        heading, columns, {"offset": offset}, {"support_radius": found.support_radius, "pins": found.pins}, notes
    )


def _swing(found: SmallOscillation) -> Sheet:
    columns = [
        Column("time", "time", "s", found.time),
        Column("free_end_offset", "free end", "m", found.offset[:, 0]),
        Column("free_end_velocity", "free end", "m/s", found.velocity[:, 0]),
        Column("largest_offset", "farthest", "pin, m", np.abs(found.offset).max(axis=1)),
        Column("error_bound", "error bound", "m", found.error_bound),
    ]
    names = ("angular_frequency", "energy", "truncation_error")
    share = found.energy / found.energy.sum() if found.energy.sum() > 0 else found.energy
    most = np.argsort(share)[::-1][:3]
    words = ", ".join(f"{100 * share[k]:.3g} % in mode {k + 1}" for k in most if share[k] > 0)
    return Sheet(
        f"{found.energy.size} modes; of the energy {words}" if words else f"{found.energy.size} modes, at rest",
        columns,
        {"offset": found.offset, "velocity": found.velocity},
        {name: getattr(found, name) for name in names},
        ["error bound: of every offset as a sum of modes, rounding"],
    )
