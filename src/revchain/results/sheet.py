# SPDX-License-Identifier: GPL-3.0-or-later
"""A result as a table, for people and for dictionaries, files, pandas and xarray."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from itertools import repeat
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from ..systems.extras import require
from ..systems.numbers import Numbers
from ..systems.units import SPEED_UNITS

if TYPE_CHECKING:
    from xarray import Dataset

MOST_ROWS = 20
MOST_COLUMNS = 1000  # of an array whose numbers get columns of their own


class Column(NamedTuple):
    """One quantity: a number for each row, or an array whose first axis counts the rows.

    Attributes
    ----------
    name : str
        Name in programs and files.
    values : array or list
        Values; a list of arrays if rows have different lengths.
    heading : str
        Heading in printed tables, with the unit; empty if the column is not printed.
    digits : int
        Number of significant digits in printed tables.
    axes : tuple of str
        Names of the axes after the first.
    shown : array, optional
        Values to print instead.
    left : bool
        Whether printed tables align the column on the left.
    unit : str
        Unit of `values`.
    """

    name: str
    values: Any
    heading: str = ""
    digits: int = 6
    axes: tuple[str, ...] = ()
    shown: Any = None
    left: bool = False
    unit: str = ""

    def texts(self, rows: Any) -> list[str]:
        """Return the texts in the cells of some rows of a printed table."""
        values = self.values if self.shown is None else self.shown
        if isinstance(values, np.ndarray) and values.ndim == 1:
            values = values.tolist()
        numbers = ".1e" if self.name.endswith("error_bound") else f"#.{self.digits}g"
        found: list[str] = []
        for row in rows:
            value = values[row]
            if isinstance(value, str):
                found.append(value)
            elif isinstance(value, bool | np.bool_):
                found.append("yes" if value else "no")
            elif isinstance(value, int | np.integer):
                found.append(f"{value:,}")
            elif isinstance(value, float | np.floating):
                found.append(format(value, numbers).removesuffix("."))
            else:
                found.append(f"{len(value):,}")
        return found


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
        False if something that could be found or proved was not.
    spread : bool
        Whether a long table prints evenly spaced rows instead of the first ones.
    named : callable, optional
        Function of an axis, such as ``"pin"``, and a number along it that returns a name, such as ``"free end"``.
    """

    row: str
    heading: str
    columns: list[Column]
    facts: dict[str, Any] = field(default_factory=dict)
    notes: list[str] = field(default_factory=list)
    good: bool = True
    spread: bool = False
    named: Callable[[str, int], str] | None = None

    def __len__(self) -> int:
        return len(self.columns[0].values) if self.columns else 0


def speed_columns(speed: Any, digits: int = 6) -> list[Column]:
    """Columns of speeds, given in rad/s, in rad/s and rpm."""
    return [
        Column("angular_speed", speed, "speed (rad/s)", digits, unit="rad/s"),
        Column("rpm", speed * (30 / math.pi), "speed (rpm)", digits, unit="rpm"),
    ]


def in_speed_unit(sheet: Sheet, unit: str | None) -> Sheet:
    """The sheet with its printed speeds in a unit of `units.SPEED_UNITS`; the same sheet for None.

    Columns keep their names and values. A column that would be printed twice is not printed.
    """
    if unit is None:
        return sheet
    quantity = SPEED_UNITS[unit][0]
    columns, speeds = [], None
    for column in sheet.columns:
        heading = column.heading
        if heading.endswith(" (rad/s)"):
            words = heading.removesuffix(" (rad/s)")
            values = np.asarray(column.values if column.shown is None else column.shown, np.float64)
            shown = in_unit(values, unit)
            speeds = values if speeds is None else speeds
            plain = re.fullmatch("(from |to )?speed", words)
            words = words.replace("speed", quantity) if plain else words if quantity == "speed" or quantity in words else f"{words}, as {quantity}"
            column = column._replace(heading=f"{words} ({unit})", shown=shown)
        elif heading and speeds is not None and (column.name == "rpm" or (column.unit == unit == "s" and _is_period(column, speeds))):
            column = column._replace(heading="")
        columns.append(column)
    return replace(sheet, columns=columns)


def _is_period(column: Column, speeds: Any) -> bool:
    """Return whether a column has the periods of these speeds."""
    with np.errstate(divide="ignore"):
        return bool(np.allclose(np.asarray(column.values, np.float64), 2 * math.pi / np.abs(speeds), rtol=1e-9, equal_nan=True))


def in_unit(speed: Any, unit: str) -> Any:
    """A speed in rad/s in a unit of `units.SPEED_UNITS`; a period has the sign of the speed."""
    per_radian = SPEED_UNITS[unit][1]
    if unit != "s":
        return per_radian * speed
    with np.errstate(divide="ignore"):
        return np.divide(per_radian, speed)


def speed_text(speed: float, unit: str | None, count: int = 6) -> str:
    """A speed as text in the unit asked and in rad/s, or in rad/s and rpm."""
    radians = f"{digits(speed, count)} rad/s"
    if unit in ("rpm", "Hz", "s"):
        return f"{'a period of ' if unit == 's' else ''}{digits(in_unit(speed, unit), count)} {unit} ({radians})"
    return f"{radians} ({digits(speed * 30 / math.pi, 4)} rpm)"


def digits(number: float, count: int) -> str:
    """`number` as text with `count` significant digits."""
    return f"{number:#.{count}g}".removesuffix(".")


def cells(sheet: Sheet, most: int = MOST_ROWS) -> tuple[list[str], list[list[str]], list[str]]:
    """Headings, the printed rows as text, and the lines below."""
    size = len(sheet)
    rows: Any = range(size)
    if size > most:
        rows = np.linspace(0, size - 1, most).round().astype(int).tolist() if sheet.spread else range(most)
    headings, columns = [], []
    for column in sheet.columns:
        if column.heading:
            headings.append(column.heading)
            columns.append(column.texts(rows))
    if not headings:
        return [], [], sheet.notes
    notes = [f"and {size - most:,} more", *sheet.notes] if size > most else sheet.notes
    return headings, [*map(list, zip(*columns, strict=True))], notes


def as_text(sheet: Sheet) -> str:
    """Return the table as text."""
    headings, rows, notes = cells(sheet)
    padded, table = [], zip(headings, *rows, strict=True)
    for column in sheet.columns if rows else []:
        if column.heading:
            cells_of = next(table)
            padded.append([*map(str.ljust if column.left else str.rjust, cells_of, repeat(max(map(len, cells_of))))])
    lines = map(str.rstrip, map("  ".join, zip(*padded, strict=True)))
    return "\n".join([sheet.heading, *lines, *notes])


def as_html(sheet: Sheet) -> str:
    """Return the table as HTML."""
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
    """Return the facts and the list of rows as a dictionary."""
    return {**plain(sheet.facts), f"{sheet.row}s": as_rows(sheet)}


def as_rows(sheet: Sheet) -> list[dict[str, Any]]:
    """Return one dictionary for each row of the table."""
    columns = {column.name: plain(column.values) for column in sheet.columns}
    return [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)]


def plain(value: Any) -> Any:
    """`value` as plain Python data; a complex number as a pair."""
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
    """`value` without infinity and NaN: left out of dictionaries, None in lists."""
    if isinstance(value, dict):
        return {name: kept for name, item in value.items() if (kept := finite(item)) is not None or item is None}
    if isinstance(value, list):
        return [finite(item) for item in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def in_columns(sheet: Sheet, most: int = MOST_COLUMNS) -> list[Column]:
    """The columns, with one for each pin, link or motion of an array that has at most `most` numbers in a row.

    Complex numbers get a column for each part.
    """
    columns: list[Column] = []
    for column in sheet.columns:
        values = np.asarray(column.values) if isinstance(column.values, np.ndarray) else None
        parts = [column]
        if values is not None and values.ndim == 2 and values.shape[1] <= most and sheet.named is not None:
            places = [sheet.named(column.axes[0], number) for number in range(values.shape[1])]
            if all(places):
                key = [re.sub(r"\W+", "_", place).strip("_") for place in places]
                parts = [
                    column._replace(name=f"{column.name}_{key[k]}", values=values[:, k], heading=f"{column.name}, {place}", axes=())
                    for k, place in enumerate(places)
                ]
        for part in parts:
            if part.axes or not np.iscomplexobj(part.values):
                columns.append(part)
                continue
            for kind, half in (("real", np.real(part.values)), ("imaginary", np.imag(part.values))):
                heading = part.heading and f"{part.heading}, {kind} part"
                columns.append(part._replace(name=f"{part.name}_{kind}", values=half, heading=heading, shown=None))
    return columns


def as_csv(sheet: Sheet) -> str:
    """The table as CSV: one line for each row, with all digits of a double."""
    import csv
    import io

    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    columns = in_columns(sheet)
    writer.writerow([column.name for column in columns])
    for row in zip(*[plain(column.values) for column in columns], strict=True):
        writer.writerow([" ".join(map(repr, value)) if isinstance(value, list) else value for value in row])
    return text.getvalue()


def as_dataframe(sheet: Sheet) -> Any:
    """The table as a pandas data frame without columns of arrays; facts are its ``attrs``."""
    pandas = require("pandas", "sweep", "to_dataframe")
    columns = {column.name: column.values for column in sheet.columns if not column.axes}
    table = pandas.DataFrame(columns)
    if sheet.row in columns and table[sheet.row].is_unique:
        table = table.set_index(sheet.row)
    table.attrs.update(plain(sheet.facts))
    return table


def as_dataset(sheet: Sheet) -> Dataset:
    """The table as an xarray data set; facts are variables (arrays) or attributes."""
    xarray = require("xarray", "netcdf", "to_xarray")
    variables = {
        column.name: (
            (sheet.row, *column.axes),
            padded(column.values, 1 + len(column.axes)),
            {"units": column.unit} if column.unit else {},
        )
        for column in sheet.columns
        if column.name != sheet.row
    }
    coordinates = {column.name: np.asarray(column.values) for column in sheet.columns if column.name == sheet.row}
    for name, value in sheet.facts.items():
        if isinstance(value, np.ndarray):
            variables[name] = tuple(f"{name}_axis_{k}" for k in range(value.ndim)), value, {}
    facts = {name: value for name, value in sheet.facts.items() if name not in variables and value is not None}
    data: Dataset = xarray.Dataset(variables, coordinates, {name: _attribute(value) for name, value in facts.items()})
    return data


def _attribute(value: Any) -> str | int | float:
    """A value as a netCDF attribute."""
    import json

    value = plain(value)
    if isinstance(value, bool):
        return int(value)
    return value if isinstance(value, str | int | float) else json.dumps(finite(value))


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
