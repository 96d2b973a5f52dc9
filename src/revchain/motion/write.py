# SPDX-License-Identifier: GPL-3.0-or-later
"""Files and views of a motion; the ending of a path selects the writer."""

from __future__ import annotations

import base64
import html
import os
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from ..results.files import naming, written_aside
from ..systems.extras import require
from ..systems.numbers import file_path, one_positive, shown
from .film import Film
from .frames import write_gif, write_mp4
from .solid import glb_of, write_glb
from .staging import Choices, staged

RATES = (0.1, 1000.0)  # frames in a second
MOST_TURNS = 5000  # of a solid, which has four keys for each
Progress = Callable[[int, int], None]


def write_page(film: Film, path: Path, progress: Progress) -> None:
    path.write_text(page_of(film, progress), encoding="utf-8")


def page_of(film: Film, progress: Progress) -> str:
    """Return the page of a film: HTML that contains the .glb file and a viewer of it (three.js)."""
    solid = base64.b64encode(glb_of(film, progress)).decode()
    folder = files("revchain").joinpath("motion")
    page, script = (folder.joinpath(name).read_text(encoding="utf-8") for name in ("viewer.html", "viewer.min.js"))
    return page.replace("@script@", script).replace("@solid@", solid).replace("@title@", html.escape(film.system))


WRITERS: dict[str, dict[str, Callable[[Film, Path, Progress], None]]] = {
    "animate": {".gif": write_gif, ".mp4": write_mp4, ".html": write_page},
    "to_glb": {".glb": write_glb},
}
METHODS = {ending: method for method, writers in WRITERS.items() for ending in writers}


def require_for(ending: str) -> None:
    for module in {".gif": ("matplotlib", "PIL"), ".mp4": ("matplotlib", "imageio_ffmpeg")}.get(ending, ()):
        require(module, "animate", f"a {ending} film")


def write_film(
    result: Any,
    method: str,
    path: str | os.PathLike[str],
    *,
    frames_per_second: float = 25.0,
    progress: Progress | None = None,
    **chosen: Any,
) -> None:
    caller, writers = f"revchain.{type(result).__name__}.{method}", WRITERS[method]
    ending = os.path.splitext(file_path(caller, "path", path))[1].lower()
    if ending not in writers:
        raise ValueError(f"{caller}: path must end in {', '.join(writers)}, got {os.fspath(path)}")
    require_for(ending)
    rate = one_positive(caller, "frames_per_second", frames_per_second)
    if not RATES[0] <= rate <= RATES[1]:
        raise ValueError(f"{caller}: frames_per_second must be from {RATES[0]:g} to {RATES[1]:g}, got {rate:g}")
    if progress is not None and not callable(progress):
        raise TypeError(f"{caller}: progress must be a function of two numbers, got {shown(progress)}")
    if ending == ".gif":
        rate = 100 / max(2, round(100 / rate))  # its clock counts hundredths of a second
    film = _film(result, Choices(caller, rate, **chosen), is_solid=ending in (".html", ".glb"))
    with naming(path), written_aside(path) as [aside]:
        writers[ending](film, aside, progress or _silent)


class View:
    """A page in a notebook, which shows objects by their ``_repr_html_``."""

    def __init__(self, page: str, height: float) -> None:
        style = f"width: 100%; height: {height:g}px; border: 0"
        self._frame = f'<iframe srcdoc="{html.escape(page)}" style="{style}"></iframe>'

    def _repr_html_(self) -> str:
        return self._frame

    def __repr__(self) -> str:
        return "a motion, which notebooks show"


def show_film(result: Any, height: float, **chosen: Any) -> View:
    caller = f"revchain.{type(result).__name__}.show"
    tall = one_positive(caller, "height", height)
    return View(page_of(_film(result, Choices(caller, **chosen), is_solid=True), _silent), tall)


def _film(result: Any, choices: Choices, is_solid: bool) -> Film:
    """Return the film of a result; refuse a 3D model with too many turns."""
    film = staged(result, choices)
    turns = max(float(np.abs(figure.phase).max()) for figure in film.figures) / (2 * np.pi)
    if is_solid and turns > MOST_TURNS:
        most = f"no figure may turn more than {MOST_TURNS} times"
        raise ValueError(f"{choices.caller}: {most}; lower time_scale or duration, got {turns:g} turns")
    return film


def _silent(done: int, total: int) -> None:
    pass
