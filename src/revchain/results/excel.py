# SPDX-License-Identifier: GPL-3.0-or-later
"""Results as workbooks for spreadsheet programs (.xlsx), by openpyxl."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..systems.extras import require
from ..systems.numbers import Floats, file_path
from .files import naming, written_aside
from .parts import parts_of
from .sheet import Column, Sheet, in_columns, plain

if TYPE_CHECKING:
    from .base import Result

MOST_LINES, MOST_ACROSS, MOST_LETTERS = 1_048_575, 16_384, 31  # rows below the heading, columns, letters of a sheet's name
LINE = 90  # letters in the width of a column at most
MOST_DRESSED = 200  # columns whose widths and headings are set
PURPOSE = "an .xlsx file"
UNITS_OF_FACTS = {
    **dict.fromkeys(("gravity", "acceleration"), "m/s^2"),
    **dict.fromkeys(("angular_speed", "angular_frequency", "slack_speed"), "rad/s"),
    **dict.fromkeys(("conical_height", "support_radius", "sway", "start", "truncation_error", "arc_length"), "m"),
    "motion_end": "s",
}


class Page(NamedTuple):
    """One sheet of a workbook.

    Attributes
    ----------
    name : str
        Name of the sheet.
    columns : list of Column
        Its columns; none has further axes.
    """

    name: str
    columns: list[Column]


def pages_of(results: Mapping[str, Result], title: str = "") -> list[Page]:
    """Return the sheets for named results of one system: its facts, its links or point masses, and the tables."""
    from .. import __version__

    first = next(iter(results.values()))
    system: Any = getattr(first, "system", getattr(first, "governor", first))
    has_system = hasattr(system, "describe")  # standard deviations and other results of results have none
    facts, links = parts_of(system) if has_system else ([], [])
    rows: list[tuple[str, Any, str]] = [("title", title, "")] * bool(title)
    rows += [("description", system.describe(), "")] if has_system else []
    rows += [("revchain", __version__, ""), *facts]
    pages = [Page("links" if len(links) > 2 else "point masses", links)] * bool(links)
    for name, result in results.items():
        sheet = result._full()
        rows += [("", "", ""), (name, sheet.heading or result._sheet(brief=True).heading, "")]
        rows += [("note", note, "") for note in sheet.notes]
        rows += [
            ("note", f"{column.name} has more numbers in a row than a sheet has columns, {MOST_ACROSS:,}: it is not in this file", "")
            for column in sheet.columns if isinstance(column.values, np.ndarray) and column.values.ndim == 2 and column.values.shape[1] >= MOST_ACROSS
        ]  # fmt: skip
        rows += _facts(sheet)
        pages += _tables(name, sheet)
        pages += [
            Page(f"{name} {key}", [Column(each, [row[each] for row in value]) for each in value[0]])
            for key, value in sheet.facts.items()
            if isinstance(value, list) and value and isinstance(value[0], dict)
        ]
    about = [Column("", [row[k] for row in rows], heading) for k, heading in enumerate(("what", "value", "unit"))]
    return [Page("system", about), *pages]


def _facts(sheet: Sheet) -> list[tuple[str, Any, str]]:
    """The numbers and words of a result."""
    rows: list[tuple[str, Any, str]] = []
    for name, value in sheet.facts.items():
        value, words = plain(value), name.replace("_", " ")
        if isinstance(value, list) and value and not isinstance(value[0], dict | list) and len(value) <= MOST_ACROSS:
            rows += [(f"{words} {k}", each, UNITS_OF_FACTS.get(name, "")) for k, each in enumerate(value)]
        elif isinstance(value, bool | int | float | str) and name != "description":
            rows.append((words, value, UNITS_OF_FACTS.get(name, "")))
    return rows


def _tables(name: str, sheet: Sheet) -> list[Page]:
    """The table of a result, and a sheet for each quantity with several numbers in a row."""
    keys = [column for column in sheet.columns[:1] if not column.axes]
    arrays = [column for column in sheet.columns if column.axes]
    pages = [Page(name, _single(Sheet(sheet.row, "", [column for column in sheet.columns if not column.axes])))]
    for column in arrays:
        values = _padded(column.values)
        if values is not None and 0 < values.shape[1] < MOST_ACROSS:
            wide = Sheet(sheet.row, "", [column._replace(values=values)], named=_named(sheet))
            pages.append(Page(f"{name} {column.name}", [*keys, *_single(wide)]))
    return pages


def _named(sheet: Sheet) -> Callable[[str, int], str]:
    """The names of the numbers along an axis; their numbers from 1 where the system has none."""
    if sheet.named is None:
        return lambda axis, number: str(number + 1)
    named = sheet.named
    return lambda axis, number: named(axis, number) or str(number + 1)


def _padded(rows: Any) -> Floats | None:
    """Rows of numbers as an array of two axes, the gaps filled with NaN; None for more axes."""
    if isinstance(rows, np.ndarray):
        return rows if rows.ndim == 2 else None
    width = max((len(row) for row in rows), default=0)
    table = np.full((len(rows), width), np.nan)
    for line, row in zip(table, rows, strict=True):
        line[: len(row)] = row
    return table


def _single(sheet: Sheet) -> list[Column]:
    """The columns of a table as numbers, under headings with units."""
    columns = []
    for column in in_columns(sheet, MOST_ACROSS):
        values = column.values
        if isinstance(values, np.ndarray) and values.dtype == np.longdouble:
            values = values.astype(np.float64)
        columns.append(column._replace(values=values))
    return columns


def heading_of(column: Column) -> str:
    """Return the heading of a column: its name in words, with the unit."""
    if column.heading and (not column.unit or f"({column.unit})" in column.heading) and "°" not in column.heading:
        return column.heading
    words = column.name.replace("_", " ") if "°" in column.heading or not column.heading else column.heading
    return f"{words} ({column.unit})" if column.unit else words


def write_workbook(path: Path, pages: Iterable[Page], asked: str | os.PathLike[str]) -> None:
    """Write the sheets to a file; a ValueError if one has too many rows or columns."""
    openpyxl, styles = (require(name, "excel", PURPOSE) for name in ("openpyxl", "openpyxl.styles"))
    pages, taken = list(pages), set[str]()
    for page in pages:
        lines = len(page.columns[0].values) if page.columns else 0
        if lines > MOST_LINES or len(page.columns) > MOST_ACROSS:
            what = f"{lines:,} rows" if lines > MOST_LINES else f"{len(page.columns):,} columns"
            most = f"{MOST_LINES:,} rows and {MOST_ACROSS:,} columns"
            name = os.fspath(asked)
            raise ValueError(f"{name}: a sheet has at most {most}, got {what} of {page.name}; write a .csv or .nc file")
    book = openpyxl.Workbook()
    book.remove(book.active)
    for page in pages:
        sheet = book.create_sheet(_sheet_name(page.name, taken))
        headings = [_legal(heading_of(column)) for column in page.columns]
        sheet.append(headings)
        for row in zip(*[map(_cell, plain(column.values)) for column in page.columns], strict=True):
            sheet.append(row)
        _dress(sheet, styles, page, headings)
    book.save(path)


def _cell(value: Any) -> Any:
    """A value for a cell: a number, a text or None."""
    value = plain(value)
    if isinstance(value, list | tuple | dict):
        value = " ".join(map(repr, value))
    if isinstance(value, str):
        value = _legal(value)[:32_000]
    if isinstance(value, float) and not math.isfinite(value):
        return None if value != value else str(value)
    return value


def _legal(text: str) -> str:
    """The text without characters that a workbook cannot hold."""
    return re.sub(r"[\x00-\x08\x0b\x0c\x0e-\x1f]", " ", text)


def _sheet_name(name: str, taken: set[str]) -> str:
    """A name that a sheet may have, different from those taken."""
    name = short = re.sub(r"[\[\]:*?/\\']", " ", name.replace("_", " "))[:MOST_LETTERS].strip() or "sheet"
    number = 2
    while short.lower() in taken:
        short, number = f"{name[: MOST_LETTERS - 4]} {number}", number + 1
    taken.add(short.lower())
    return short


def _dress(cells: Any, styles: Any, page: Page, headings: list[str]) -> None:
    """Make the headings bold and keep them in view, and the columns wide enough."""
    cells.freeze_panes = "A2"
    for k, heading in enumerate(headings[:MOST_DRESSED]):
        top = cells.cell(1, k + 1)
        top.font, top.border = styles.Font(bold=True), styles.Border(bottom=styles.Side("thin"))
        numbers = isinstance(page.columns[k].values, np.ndarray)
        top.alignment = styles.Alignment(wrap_text=True, vertical="bottom", horizontal="right" if numbers else "left")
        texts = [str(value) for value in page.columns[k].values[:200] if isinstance(value, str)]
        longest = max([14 if numbers else 8, min(len(heading), 24), *map(len, texts)])
        cells.column_dimensions[top.column_letter].width = min(longest + 2, LINE)
        for number, value in enumerate(page.columns[k].values if not numbers else (), 2):
            if isinstance(value, str) and value.startswith("="):
                cells.cell(number, k + 1).data_type = "s"  # a name, no formula
    if page.name == "system":
        for line in cells.iter_rows(min_row=2):
            for cell in line:
                cell.alignment = styles.Alignment(vertical="top", wrap_text=isinstance(cell.value, str), horizontal="left")


def name_of(result: Result) -> str:
    """Return the name of a result in words."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", " ", type(result).__name__).lower()


def save_workbook(caller: str, path: str | os.PathLike[str], results: Mapping[str, Result], title: str = "") -> None:
    """Write results of one system to a workbook."""
    if Path(file_path(caller, "path", path)).suffix.lower() != ".xlsx":
        raise ValueError(f"{caller}: path must end in .xlsx, got {os.fspath(path)}; for other files: save, to_dataframe")
    require("openpyxl", "excel", PURPOSE)
    with naming(path), written_aside(path) as [aside]:
        write_workbook(aside, pages_of(results, title), path)
