# SPDX-License-Identifier: GPL-3.0-or-later
"""Films as pages: one .html file that contains the .glb file and a viewer of it (three.js)."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

from .film import Film
from .solid import glb_of


def write_page(film: Film, path: Path, progress: Callable[[int, int], None]) -> None:
    """Write one file that needs no other file and no network."""
    path.write_text(page_of(film, progress), encoding="utf-8")


def page_of(film: Film, progress: Callable[[int, int], None]) -> str:
    """Return the text of the page."""
    solid = base64.b64encode(glb_of(film, progress)).decode()
    page, script = (_text(name) for name in ("viewer.html", "viewer.min.js"))
    return page.replace("@script@", script).replace("@solid@", solid).replace("@title@", html.escape(film.system))


def _text(name: str) -> str:
    return files("revchain").joinpath("motion", name).read_text(encoding="utf-8")
