# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes the pages of the reference that come from headers, the schema and the command line."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import command_line
import cpp_reference
import scene_reference


def write(app: Any) -> None:
    """A page that has not changed keeps its time, so that it is not built again."""
    for name, text in {**cpp_reference.pages(), **scene_reference.pages(), **command_line.pages()}.items():
        path = Path(app.srcdir) / name
        path.parent.mkdir(parents=True, exist_ok=True)
        if not path.is_file() or path.read_text(encoding="utf-8") != text:
            path.write_text(text, encoding="utf-8")


def turned_links(_: Any, name: str, source: list[str]) -> None:
    """The list of headers leads to their pages here, and to the headers in the repository."""
    if name == "reference/cpp":
        source[0] = cpp_reference.with_pages(source[0])


def setup(app: Any) -> dict[str, bool]:
    app.connect("config-inited", lambda app, _: write(app))
    app.connect("source-read", turned_links)
    return {"parallel_read_safe": True}
