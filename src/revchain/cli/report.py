# SPDX-License-Identifier: GPL-3.0-or-later
"""A solved scene as a table for the terminal, as JSON and as CSV."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable
from dataclasses import replace
from textwrap import fill
from typing import Any

from rich import box
from rich.console import Group
from rich.table import Table
from rich.text import Text

from ..results.motions import Response
from ..results.sheet import MOST_ROWS, Sheet, as_csv, as_dict, cells, digits, finite, plain

NARROWEST = 80  # columns of a terminal; numbers are never cut to fit into fewer
HEADING = 10  # columns of a line of a heading


def empty_grid(headings: Iterable[str]) -> Table:
    """A table without rows yet; none of its columns is ever cut."""
    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for heading in headings:
        grid.add_column(heading, justify="right", no_wrap=True)
    return grid


def table(sheet: Sheet, title: str, *more: Sheet, carried: Response | None = None) -> Group:
    """The table of a result with its heading, then `more` of them."""
    heading = Text(sheet.heading, style="" if sheet.good else "bold yellow")
    parts: list[Text | Table] = [Text(title, style="bold"), heading]
    if len(sheet):
        parts.append(_grid(sheet))
    for one in more:
        parts += [Text(one.heading), _grid(one)]
    if carried is not None:
        parts += _carried(carried)
    return Group(*parts, *(Text(note, style="dim") for note in sheet.notes))


def _grid(sheet: Sheet) -> Table:
    headings, rows, notes = cells(sheet)
    hidden = len(sheet) - len(rows)
    lines = [heading.replace(" (", "\n(").split("\n") for heading in headings]
    grid = empty_grid("\n".join(fill(line, HEADING, break_long_words=False) for line in each) for each in lines)
    for row in rows:
        grid.add_row(*row)
    if hidden > 0:
        grid.caption = f"{notes[0]}; --json and --csv write all of them"
        grid.caption_justify = "left"
    return grid


def _carried(found: Response) -> list[Text | Table]:
    """Where the pins are while the support goes round."""
    speed = float(found.angular_speed)
    turns = f"{digits(speed, 6)} rad/s, {digits(speed * 30 / math.pi, 6)} rev/min"
    if found.resonant:
        return [Text(f"carried round at {turns}: a resonance, it goes out without bound")]
    grid = empty_grid(["pin\n0: free end", "from the axis\nm"])
    shown = list(zip(found.pins, found.offset, strict=True))
    for pin, offset in shown if len(shown) <= MOST_ROWS else [*shown[: MOST_ROWS - 1], shown[-1]]:
        grid.add_row(f"{pin}", digits(offset, 10))
    heading = Text(f"carried round at {turns}; error bound {float(found.error_bound):.1e}")
    hidden = len(shown) - MOST_ROWS
    more = [Text(f"and {hidden:,} more; --json writes all of them", style="dim")] if hidden > 0 else []
    return [heading, grid, *more]


def json_text(sheet: Sheet, title: str, carried: Response | None = None) -> str:
    """Everything but the shapes of modes; numbers with all their digits."""
    data = as_dict(without_shapes(sheet))
    if carried is not None:
        numbers = {name: float(getattr(carried, name)) for name in ("angular_speed", "support_radius", "error_bound")}
        offset = None if carried.resonant else carried.offset
        data["carried"] = {**numbers, "resonant": bool(carried.resonant), "offset": offset}
    return json_of({"title": title, **data})


def without_shapes(sheet: Sheet) -> Sheet:
    """The sheet without the shapes of modes, which are long."""
    return replace(sheet, columns=[column for column in sheet.columns if (column.name, *column.axes) != ("shape", "pin")])


def json_of(data: dict[str, Any]) -> str:
    """As JSON, which has no infinity and no NaN: null in their place."""
    return json.dumps(finite(plain(data)), indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def csv_text(sheet: Sheet) -> str:
    """One line for each row; numbers of an array separated by blanks."""
    return as_csv(without_shapes(sheet))
