# SPDX-License-Identifier: GPL-3.0-or-later
"""Films as solids in a page: one .html file with the .glb file and a viewer of it (three.js) inside."""

from __future__ import annotations

import base64
import html
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path

from .film import Film
from .solid import glb_of


def write_viewer(film: Film, path: Path, progress: Callable[[int, int], None]) -> None:
    """One file that needs no other and no network."""
    path.write_text(viewer_of(film, progress), encoding="utf-8")


def viewer_of(film: Film, progress: Callable[[int, int], None]) -> str:
    """The text of the page."""
    solid = base64.b64encode(glb_of(film, progress)).decode()
    page, script = (_text(name) for name in ("viewer.html", "viewer.min.js"))
    return page.replace("@script@", script).replace("@solid@", solid).replace("@title@", html.escape(film.system))


def _text(name: str) -> str:
    return files("revchain").joinpath("motion", name).read_text(encoding="utf-8")
