# SPDX-License-Identifier: GPL-3.0-or-later
"""Films as pages: one .html file with the numbers and a script that draws them; no picture is inside."""

from __future__ import annotations

import base64
import html
import json
from collections.abc import Callable
from importlib.resources import files
from pathlib import Path
from typing import Any

import numpy as np

from ..plots.style import PALETTE
from .film import Figure, Film, spread

MOST_NUMBERS = 36_000  # of places, 2.7 bytes each: no page exceeds 200 KB
FRAMES, PINS = (60, 120), (30, 200)  # least and most
LINE = 400  # points of a curve


def write_page(film: Film, path: Path, progress: Callable[[int, int], None]) -> None:
    """One file that needs no other."""
    path.write_text(page_of(film), encoding="utf-8")
    progress(film.frames, film.frames)


def page_of(film: Film) -> str:
    """The text of the page."""
    film = _light(film)
    text = json.dumps(_data(film), ensure_ascii=False, separators=(",", ":"), allow_nan=False)
    page = files("revchain").joinpath("motion", "page.html").read_text(encoding="utf-8")
    return page.replace("@title@", html.escape(film.system)).replace("@data@", text.replace("<", "\\u003c"))


def _light(film: Film) -> Film:
    """With no more frames and pins than a page holds; the script draws what is between frames."""
    pins = min(film.figures[0].offset.shape[1], PINS[1])
    if film.is_rigid:
        return film.thinned(film.frames, PINS[1])
    first = film.figures[0]
    arrays = 1 + bool(first.offset.imag.any()) + (len(first.height) > 1)
    each = MOST_NUMBERS // (arrays * len(film.figures))
    frames = int(np.clip(each // pins, *FRAMES))
    return film.thinned(frames, int(np.clip(each // frames, *PINS)))


def _data(film: Film) -> dict[str, Any]:
    """All that the script reads."""
    low, high = film.low_and_high
    bodies, chart = film.bodies, film.chart
    return {
        "gravity": film.words.partition(";")[0],
        "note": film.note,
        "scale": film.time_scale,
        "seconds": film.seconds,
        "frames": film.frames,
        "pins": film.figures[0].offset.shape[1],
        "reach": film.reach,
        "low": low,
        "high": high,
        "widths": film.widths().tolist(),
        "few": film.shows_pins,
        "held": film.is_held,
        "stands": bool(film.stout.all()),
        "stout": np.flatnonzero(film.stout).tolist(),
        "bodies": {
            name: _rounded(getattr(bodies, name)) for name in ("link", "along", "size", "rod", "wheel", "floats")
        },
        "figures": [
            _figure(figure, f"#{PALETTE[colour % len(PALETTE)]}") for figure, colour in zip(film.figures, film.colours, strict=True)
        ],
        "clock": film.clock,
        "chart": None
        if chart is None
        else {
            "x_label": chart.x_label,
            "y_label": chart.y_label,
            "log": chart.is_logarithmic,
            "lines": [[_rounded(part[spread(part.size, LINE)]) for part in line] for line in chart.lines],
            "x": [_rounded(x) for x in chart.x],
            "y": [_rounded(y) for y in chart.y],
        },
    }


def _figure(figure: Figure, colour: str) -> dict[str, Any]:
    level = figure.offset.imag if figure.offset.imag.any() else figure.offset.imag[:1]
    return {
        "colour": colour,
        "captions": figure.captions,
        "rate": float(figure.speed[0]) if figure.is_rigid else None,
        "phase": None if figure.is_rigid else _rounded(figure.phase),
        "re": _packed(figure.offset.real),
        "im": _packed(level),
        "height": _packed(figure.height),
    }


def _packed(values: Any) -> dict[str, Any]:
    """Numbers as whole ones of 16 bits, and their unit."""
    unit = float(np.abs(values).max()) / 32767 or 1.0
    return {"unit": unit, "data": base64.b64encode(np.rint(values / unit).astype("<i2").tobytes()).decode()}


def _rounded(values: Any) -> Any:
    return [float(f"{value:.6g}") if isinstance(value, float) else value for value in values.tolist()]
