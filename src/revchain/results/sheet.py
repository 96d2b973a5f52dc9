# SPDX-License-Identifier: GPL-3.0-or-later
"""A result as a table, for people and for dictionaries, files, pandas and xarray."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from ..systems.extras import require
from ..systems.numbers import Numbers

if TYPE_CHECKING:
    from xarray import Dataset

MOST_ROWS = 20


@dataclass(frozen=True, slots=True)
class Column:
    """One quantity: a number for each row, or an array whose first axis counts the rows.

    Attributes
    ----------
    name : str
        Name in programs and files.
    values : array or list
        Values; a list of arrays if rows have different lengths.
    heading : str
        Heading in printed tables, with the unit; a column without a heading is not printed.
    digits : int
        Number of significant digits in printed tables.
    axes : tuple of str
        Names of the axes after the first.
    shown : array, optional
        Values to print instead, such as degrees or words.
    left : bool
        Whether printed tables align the column on the left.
    """

    name: str
    values: Any
    heading: str = ""
    digits: int = 6
    axes: tuple[str, ...] = ()
    shown: Any = None
    left: bool = False

    def cell(self, row: int) -> str:
        """Text of a row in a printed table."""
        value = (self.values if self.shown is None else self.shown)[row]
        if isinstance(value, str):
            return value
        if isinstance(value, bool | np.bool_):
            return "yes" if value else "no"
        if isinstance(value, int | np.integer):
            return f"{value:,}"
        if np.ndim(value):
            return f"{len(value):,}"
        return f"{value:.1e}" if self.name.endswith(("error_bound", "error_estimate")) else digits(value, self.digits)


@dataclass(frozen=True, slots=True)
class Sheet:
    """A result as columns.

    Attributes
    ----------
    row : str
        Name of a row, such as ``"mode"``.
    heading : str
        Line above the table.
    columns : list of Column
        Columns of the table.
    facts : dict
        Data of the whole result.
    notes : list of str
        Lines below the table.
    good : bool
        Whether everything was found and proved.
    spread : bool
        Whether a long table prints evenly spaced rows instead of the first ones.
    """

    row: str
    heading: str
    columns: list[Column]
    facts: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    good: bool = True
    spread: bool = False

    def __len__(self) -> int:
        return len(self.columns[0].values) if self.columns else 0


def speed_columns(speed: Any, digits: int = 6) -> list[Column]:
    """Columns of the speeds, which are given in rad/s, in rad/s and in rpm."""
    return [
        Column("angular_speed", speed, "speed (rad/s)", digits),
        Column("rpm", speed * (30 / math.pi), "speed (rpm)", digits),
    ]


def digits(number: float, count: int) -> str:
    """`number` as text with `count` significant digits, with zeros at the end."""
    return f"{number:#.{count}g}".removesuffix(".")


def cells(sheet: Sheet) -> tuple[list[str], list[list[str]], list[str]]:
    """Headings, the printed rows as text, and the lines below."""
    shown = [column for column in sheet.columns if column.heading]
    if not shown:
        return [], [], sheet.notes
    count = min(len(sheet), MOST_ROWS)
    last = len(sheet) if sheet.spread else count
    rows = [[column.cell(int(k)) for column in shown] for k in np.linspace(0, last - 1, count).round()]
    hidden = len(sheet) - count
    return [column.heading for column in shown], rows, ([f"and {hidden:,} more"] if hidden > 0 else []) + sheet.notes


def as_text(sheet: Sheet) -> str:
    """The table that a prompt shows."""
    headings, rows, notes = cells(sheet)
    widths = [max(map(len, column)) for column in zip(headings, *rows, strict=True)] if rows else []
    left = [column.left for column in sheet.columns if column.heading]

    def line(row: list[str]) -> str:
        places = zip(row, widths, left, strict=True)
        return "  ".join(cell.ljust(width) if words else cell.rjust(width) for cell, width, words in places).rstrip()

    lines = [line(row) for row in [headings, *rows]] if rows else []
    return "\n".join([sheet.heading, *lines, *notes])


def as_html(sheet: Sheet) -> str:
    """The table that a notebook shows."""
    from html import escape

    headings, rows, notes = cells(sheet)
    head = "".join(f"<th>{escape(heading)}</th>" for heading in headings)
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    foot = f'<tr><td colspan="{max(len(headings), 1)}">{escape("; ".join(notes))}</td></tr>' if notes else ""
    return (
        f"<table><caption>{escape(sheet.heading)}</caption><thead><tr>{head}</tr></thead>"
        f"<tbody>{body}</tbody><tfoot>{foot}</tfoot></table>"
    )


def as_dict(sheet: Sheet) -> dict[str, Any]:
    """Facts, then a dictionary for each row."""
    columns = {column.name: plain(column.values) for column in sheet.columns}
    rows = [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]
    return {**plain(sheet.facts), f"{sheet.row}s": rows}


def plain(value: Any) -> Any:
    """`value` as Python's numbers, text, lists and dictionaries; a complex number as a pair."""
    if isinstance(value, dict):
        return {name: plain(item) for name, item in value.items()}
    if isinstance(value, np.ndarray | np.generic):
        if value.dtype == np.longdouble:
            value = value.astype(np.float64)
        return plain(value.tolist()) if value.dtype.kind in "cO" else value.tolist()
    if isinstance(value, list | tuple):
        return [plain(item) for item in value]
    return [value.real, value.imag] if isinstance(value, complex) else value


def finite(value: Any) -> Any:
    """`value` for JSON: None in place of infinity and NaN, which JSON does not have."""
    if isinstance(value, dict):
        return {name: finite(item) for name, item in value.items()}
    if isinstance(value, list):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def as_csv(sheet: Sheet) -> str:
    """The table as CSV: one line for each row, with all digits; arrays as numbers separated by blanks."""
    import csv
    import io

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow([column.name for column in sheet.columns])
    for row in zip(*[plain(column.values) for column in sheet.columns], strict=True):
        writer.writerow([" ".join(map(repr, value)) if isinstance(value, list) else value for value in row])
    return text.getvalue()


def as_dataframe(sheet: Sheet) -> Any:
    """The table as a pandas data frame; facts are its ``attrs``; columns of arrays are left out."""
    pandas = require("pandas", "sweep", "to_dataframe")
    columns = {column.name: column.values for column in sheet.columns if not column.axes}
    table = pandas.DataFrame(columns)
    if sheet.row in columns and table[sheet.row].is_unique:
        table = table.set_index(sheet.row)
    table.attrs.update(plain(sheet.facts))
    return table


def as_dataset(sheet: Sheet) -> Dataset:
    """The table as an xarray data set: the first axis counts the rows; facts are variables (arrays) or attributes."""
    xarray = require("xarray", "netcdf", "to_xarray")
    variables = {
        column.name: ((sheet.row, *column.axes), padded(column.values, 1 + len(column.axes)))
        for column in sheet.columns
        if column.name != sheet.row
    }
    coordinates = {column.name: column.values for column in sheet.columns if column.name == sheet.row}
    for name, value in sheet.facts.items():
        if isinstance(value, np.ndarray):
            variables[name] = tuple(f"{name}_axis_{k}" for k in range(value.ndim)), value
    facts = {name: value for name, value in sheet.facts.items() if name not in variables and value is not None}
    data: Dataset = xarray.Dataset(variables, coordinates, {name: _attribute(value) for name, value in facts.items()})
    return data


def _attribute(value: Any) -> str | int | float:
    """A value as a netCDF attribute, which cannot be a bool or nested data."""
    import json

    value = plain(value)
    if isinstance(value, bool):
        return int(value)
    return value if isinstance(value, str | int | float) else json.dumps(value)


def padded(rows: Any, axes: int) -> Numbers:
    """Rows of different lengths as one array, the gaps filled with NaN."""
    if isinstance(rows, np.ndarray) or axes == 1:
        return np.asarray(rows)
    if not len(rows):
        return np.empty((0,) * axes)
    table = np.full((len(rows), max((len(row) for row in rows), default=0)), np.nan, rows[0].dtype)
    for line, row in zip(table, rows, strict=True):
        line[: row.size] = row
    return table
