# SPDX-License-Identifier: GPL-3.0-or-later
"""Files of what moves, by their endings."""

from __future__ import annotations

import html
import os
from collections.abc import Callable, Iterable
from pathlib import Path
from typing import Any

import numpy as np

from ..results.files import naming, written_aside
from ..systems.extras import require
from ..systems.numbers import boolean, file_path, one_positive, shown
from .film import Film
from .frames import write_gif, write_mp4
from .grid import write_grid, write_xdmf
from .page import page_of, write_page
from .solid import write_glb
from .solid_page import viewer_of, write_viewer
from .staging import Asked, staged

RATES = (0.1, 1000.0)  # frames in a second
MOST_TURNS = 5000  # of a solid, which has four keys for each
Progress = Callable[[int, int], None]
Writer = Callable[[Film, Path, Progress], None]
FILMS: dict[str, Writer] = {".gif": write_gif, ".mp4": write_mp4, ".html": write_page}
SOLIDS: dict[str, Writer] = {".glb": write_glb}
VIEWERS: dict[str, Writer] = {".html": write_viewer}
GRIDS: dict[str, Writer] = {".vtu": write_grid, ".vtk": write_grid, ".xdmf": write_xdmf}

METHODS = {
    ending: name for name, writers in (("animate", FILMS), ("to_glb", SOLIDS), ("to_vtk", GRIDS)) for ending in writers
}


def require_for(ending: str, method: str = "") -> None:
    """Refuse an ending whose packages are missing, before anything is computed."""
    if ending in (".gif", ".mp4"):
        require("matplotlib", "animate", f"a {ending} film")
    if ending == ".gif":
        require("PIL", "animate", "a .gif film")
    if ending == ".mp4":
        require("imageio_ffmpeg", "animate", "a .mp4 film")
    if ending == ".glb":
        require("pygltflib", "exchange", "a .glb file")
    if method == "to_html":
        require("pygltflib", "exchange", "a page with a solid")
    if ending in (".vtu", ".vtk"):
        require("meshio", "exchange", f"a {ending} file")


def write_film(
    result: Any,
    method: str,
    writers: dict[str, Writer],
    path: str | os.PathLike[str],
    *,
    figures: Iterable[int] | None = None,
    time_scale: float | None = None,
    duration: float | None = None,
    frames_per_second: float = 25.0,
    progress: Progress | None = None,
) -> None:
    """See `Moving`, whose method this is; the ending of the path says who writes."""
    place = f"revchain.{type(result).__name__}.{method}"
    ending = os.path.splitext(file_path(place, "path", path))[1].lower()
    if ending not in writers:
        raise ValueError(f"{place}: path must end in {', '.join(writers)}, got {os.fspath(path)}")
    require_for(ending, method)
    rate = one_positive(place, "frames_per_second", frames_per_second)
    if not RATES[0] <= rate <= RATES[1]:
        raise ValueError(f"{place}: frames_per_second must be from {RATES[0]:g} to {RATES[1]:g}, got {rate:g}")
    if progress is not None and not callable(progress):
        raise TypeError(f"{place}: progress must be a function of two numbers, got {shown(progress)}")
    if ending == ".gif":
        rate = 100 / max(2, round(100 / rate))  # its clock counts hundredths of a second
    film = _film(result, place, figures, time_scale, duration, rate)
    if method in ("to_glb", "to_html"):
        _check_turns(film, place)
    if writers[ending] is write_grid and not film.is_rigid:
        raise ValueError(
            f"{place}: this result is another at every instant; path must end in .xdmf, got {os.fspath(path)}"
        )
    with naming(path), written_aside(path) as [aside]:
        writers[ending](film, aside, progress or _silent)


class View:
    """A page in a notebook: what shows objects by their ``_repr_html_`` shows it."""

    def __init__(self, page: str, height: float) -> None:
        self._frame = f'<iframe srcdoc="{html.escape(page)}" style="width: 100%; height: {height:g}px; border: 0"></iframe>'

    def _repr_html_(self) -> str:
        return self._frame

    def __repr__(self) -> str:
        return "a motion, which notebooks show"


def show_film(
    result: Any,
    figures: Iterable[int] | None,
    time_scale: float | None,
    duration: float | None,
    height: float,
    solid: bool,
) -> View:
    """See `Moving.show`."""
    place = f"revchain.{type(result).__name__}.show"
    tall, solid = one_positive(place, "height", height), boolean(place, "solid", solid)
    if solid:
        require_for(".html", "to_html")
    film = _film(result, place, figures, time_scale, duration, 25.0)
    if not solid:
        return View(page_of(film), tall)
    _check_turns(film, place)
    return View(viewer_of(film, _silent), tall)


def _film(
    result: Any, place: str, figures: Iterable[int] | None, time_scale: float | None, duration: float | None, rate: float
) -> Film:
    given = {"time_scale": time_scale, "duration": duration}
    numbers = {name: None if value is None else one_positive(place, name, value) for name, value in given.items()}
    return staged(result, Asked(place, figures, numbers["time_scale"], numbers["duration"], rate))


def _check_turns(film: Film, place: str) -> None:
    """Refuse a solid with too many turns."""
    turns = max(float(np.abs(figure.phase).max()) for figure in film.figures) / (2 * np.pi)
    if turns > MOST_TURNS:
        raise ValueError(
            f"{place}: no figure may turn more than {MOST_TURNS} times; lower time_scale or duration, got {turns:g} turns"
        )


def _silent(done: int, total: int) -> None:
    pass
