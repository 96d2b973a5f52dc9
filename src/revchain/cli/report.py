# SPDX-License-Identifier: GPL-3.0-or-later
"""An answer as a table for the terminal, as text, JSON, CSV, a workbook and a picture."""

from __future__ import annotations

import io
import math
import re
from dataclasses import replace
from functools import cached_property
from pathlib import Path
from textwrap import fill
from typing import Any

import msgspec
from msgspec import UnsetType
from rich import box
from rich.console import Console
from rich.table import Table
from rich.text import Text

from ..closed_forms.governor import SleeveGovernor
from ..results.excel import pages_of, write_workbook
from ..results.modes import Modes
from ..results.sheet import Sheet, as_csv, as_dict, cells
from ..scenes.report import drawn, further_sheets, in_radians, shortfall
from ..scenes.system import in_file
from ..scenes.scene import Scene
from . import ExitCode
from .frame import PICTURES, Stop, save_picture

NARROWEST = 80  # smallest width of a terminal in columns; numbers are never cut
HEADING = 10  # width of a line of a heading in columns


class Report:
    """The answer to one question of a scene: as text, JSON, CSV and picture."""

    def __init__(
        self, scene: Scene, stem: str, question: str, found: Any, units: str, count: int | str | None = None
    ) -> None:
        self.scene, self.question = scene, question
        self.title = scene.title or stem
        self.system: str = getattr(found, "description", "") or scene.system().describe()  # modes know it
        self.found = found
        self.units = units
        if count is None and isinstance(found, Modes) and not isinstance(scene.ask.modes, UnsetType):
            count = scene.ask.modes.count  # type: ignore[assignment]
        self.asked = count if isinstance(count, int) and isinstance(found, Modes) else 0
        self.sheet: Sheet = found._printed()

    @cached_property
    def tables(self) -> list[tuple[Text | None, Table | None]]:
        """The printed tables: the heading and the grid of each, None where it has none."""
        tables: list[tuple[Text | None, Table | None]] = []
        for sheet in (self.sheet, *further_sheets(self.found)):
            heading = Text(sheet.heading, style="" if sheet.good else "bold yellow") if sheet.heading else None
            tables.append((heading, _grid(sheet, self.units)))
        return tables

    def check(self, path: Path) -> None:
        """Raise Stop if something was not found, or not proved where a proof is required."""
        missing = getattr(self.found, "missing", ())
        if missing or not self.sheet.good:
            raise Stop(f"{path}: {shortfall(self.found)}", ExitCode.TOLERANCE_NOT_MET)

    def write(self, outputs: list[tuple[Path, str]], asides: list[Path]) -> None:
        """Write the outputs, each a file and its kind, to the temporary files beside them."""
        for aside, (file, kind) in zip(asides, outputs, strict=True):
            try:
                if kind in PICTURES:
                    axes = self.found.plot(**(drawn(self.found) if hasattr(self.found, "time") else {}))
                    save_picture(axes, self.title, aside)
                elif kind == ".xlsx":
                    write_workbook(aside, pages_of({self.question: self.found}, self.title), file)
                else:
                    aside.write_text(self.text(kind), encoding="utf-8")
            except OSError as error:  # may name the temporary file, or none
                raise OSError(error.errno, error.strerror or str(error), str(file)) from None

    def text(self, kind: str) -> str:
        """The report as ``.txt``, the numbers as ``.json``, or the table as ``.csv``, without the shapes of modes."""
        if kind == ".txt":
            file = io.StringIO()
            self.print(Console(file=file, width=NARROWEST))
            return re.sub(r" +$", "", file.getvalue(), flags=re.MULTILINE)
        if kind == ".csv":
            return as_csv(self._all)
        data = {"title": self.title, "description": self.system, "system": {}, **as_dict(self._all)}
        data["system"] = data["system"] or self._numbers()
        if getattr(self.found, "_stability", False):
            data["stability_windows"] = as_dict(self.found.stability_windows()._full())
        # msgspec writes null for a number that is not finite
        return msgspec.json.format(msgspec.json.encode(data), indent=2).decode() + "\n"

    def _numbers(self) -> dict[str, Any]:
        """The system in numbers, for an answer that does not hold it."""
        system = self.scene.system()
        if not isinstance(system, SleeveGovernor):
            return system.to_dict()
        return {"system": "SleeveGovernor", **{name: value for name, value in system._facts().items() if value < math.inf}}

    @cached_property
    def _all(self) -> Sheet:
        """All columns for files, apart from the shapes of modes."""
        sheet: Sheet = self.found._full()
        columns = [column for column in sheet.columns if (column.name, *column.axes) != ("shape", "pin")]
        return replace(sheet, columns=columns)

    def print(self, console: Console, heading: bool = True) -> None:
        needed = [Console(width=1000).measure(grid).maximum for _, grid in self.tables if grid]
        console.width = max(console.width, NARROWEST, *needed)
        if heading:
            console.print(Text(self.title, style="bold"), Text(self.system), sep="\n")
        for words, grid in self.tables:
            for part in (words, grid):
                if part is not None:
                    console.print(part)
        numbers: Any = self.sheet.columns[0].values if self.asked and self.sheet.good else []
        if len(numbers) and self.asked > (there := max(numbers) - min(numbers) + 1):
            after = f" from number {numbers[0]} on" if numbers[0] > 1 else ""
            only = f"there {'is' if there == 1 else 'are'} only {there}{after}"
            console.print(Text(f"{self.asked} modes are asked for: {only}", style="yellow"))
        for note in self.sheet.notes:
            if "links[" in note:
                bodies = self.scene._bodies()
                note = in_file(note, bodies[::-1] if self.scene.order == "support first" else bodies)
            console.print(Text(note, style="dim"))


def _grid(sheet: Sheet, units: str) -> Table | None:
    """The table of a sheet, with its angles in degrees or radians; None if it has no rows."""
    headings, rows, notes = cells(sheet := in_radians(sheet) if units == "rad" else sheet)
    if not rows:
        return None
    hidden = len(sheet) - len(rows)
    grid = Table(box=box.SIMPLE_HEAD, pad_edge=False, collapse_padding=True)
    for heading, column in zip(headings, [each for each in sheet.columns if each.heading], strict=True):
        lines = heading.replace(" (", "\n(").split("\n")
        heading = "\n".join([fill(line, HEADING, break_long_words=False) for line in lines])
        grid.add_column(heading, justify="left" if column.left else "right", no_wrap=True)  # none is ever cut
    for row in rows:
        grid.add_row(*row)
    if hidden > 0:
        grid.caption = f"{notes[0]}; --json and --csv write all of them"
        grid.caption_justify = "left"
    return grid
