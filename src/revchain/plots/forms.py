# SPDX-License-Identifier: GPL-3.0-or-later
"""Forms of bodies by the names of their links, from one table: pictures, 3D models and the live page draw them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

from ..systems.numbers import Floats

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FORM_OF_WORD = {  # the first of which all words are in the name of a link
    "clapper bell": "tied", "bell": "bell", "clapper": "clapper", "jar": "jar", "man": "person", "acrobat": "person", "swing": "swing",
    "chair": "seat", "seat": "seat", "load": "crate", "hook": "hook", "wheel": "wheel", "gyrostat": "disc",
}  # fmt: skip


@cache
def forms() -> dict[str, Any]:
    """Return the table of forms: colours, profiles, and the pieces of each body."""
    found: dict[str, Any] = json.loads(files("revchain").joinpath("motion/viewer/forms.json").read_text(encoding="utf-8"))
    return found


SIZES: dict[str, Any] = forms()["sizes"]  # over the height or the width of the whole; `rim` of a wheel on a point mass
HALVES = {  # one half of an outline, of radius or width 1
    "box": [[0, -0.5], [0.5, -0.5], [0.5, 0.5], [0, 0.5]], "bar": [[0, -0.5], [1, -0.5], [1, 0.5], [0, 0.5]],
    "ball": [[0, -1], [1, 0], [0, 1]], "rim": [[0, -0.05], [1.05, -0.05], [1.05, 0.05], [0, 0.05]],
}  # fmt: skip
WIDEST_FORM = 4.0  # of a body, half its width, in units of the axis


def form_of(name: str) -> str:
    """Return the form of a link whose name has the words of an entry; empty for a rod, or a bar with a ball."""
    words = set(name.lower().split())
    return next((form for each, form in FORM_OF_WORD.items() if words.issuperset(each.split())), "")


def unit_of(body: dict[str, Any], tall: float, length: float, gyration: float) -> float:
    """Return what the numbers of the pieces of a body are multiplied by, m, in a system that is so tall."""
    rim = max(np.sqrt(2) * gyration, SIZES["rim"] * tall)
    return float({"tall": tall, "gyration": gyration, "length": length, "rim": rim}[body["unit"]])


def colour_of(shade: str, backward: bool) -> str:
    """Return the colour of a piece, or of its direction of spin."""
    colours: dict[str, str] = forms()["colours"]
    return colours.get(shade, colours["back" if backward else "ahead"])


def opacity_of(colour: str) -> float:
    """Return the opacity of a colour of the table."""
    table = forms()
    return float({table["colours"][name]: part for name, part in table["opacity"].items()}.get(colour, 1.0))


def start_of(body: dict[str, Any], along: Any, unit: float) -> Any:
    """Return how far from the pin the heights of the pieces start, m, if the centre of gravity is at `along`."""
    return np.maximum(along - body.get("above", 0.0) * unit, 0.0)


def seen_of(form: str) -> Iterator[tuple[str, str, Floats]]:
    """Yield the pieces of a form seen from the side, in its unit: kind, colour, and outline (aside, along the link)."""
    for kind, shade, (_, up, aside), scale, *tilt in forms()["bodies"][form]["pieces"]:
        turn, _, spoke = tilt[0] if tilt else (0.0, 0.0, 0.0)
        if not spoke:
            half: Floats = np.array(forms()["profiles"].get(kind) or HALVES[kind]) * scale[2:0:-1]
            across = np.concatenate([half, half[::-1] * [-1, 1]])
            yield kind, shade, across @ [[np.cos(turn), -np.sin(turn)], [np.sin(turn), np.cos(turn)]] + [aside, up]


def extent_of(form: str) -> tuple[float, float, float]:
    """Return the half width of a form and its two ends along the link, in the unit of the form."""
    every = np.concatenate([outline for *_, outline in seen_of(form)])
    return float(np.abs(every[:, 0]).max()), float(every[:, 1].min()), float(every[:, 1].max())


def draw_form(ax: Axes, form: str, at: float, most: float, levels: Any, unit: float, backward: bool) -> None:
    """Draw a body, seen from the side. A metre is as wide as it is high, or `most` units of the axis if that is less.

    `levels` converts distances along the link to levels of the picture.
    """
    from matplotlib.patches import Ellipse, Polygon
    from matplotlib.transforms import Affine2DBase

    class Proportions(Affine2DBase):
        def get_matrix(self) -> Any:  # for the present size of the figure
            (wide, _, left), (_, tall, low), _ = ax.transData.get_affine().get_matrix()
            return np.array([[min(abs(tall), most * wide), 0, left + wide * at], [0, tall, low], [0, 0, 1]])

    true = Proportions()
    true.set_children(ax.transData)
    for kind, shade, outline in seen_of(form):
        points = np.column_stack([outline[:, 0] * unit, levels(outline[:, 1] * unit)])
        low, high = points.min(axis=0), points.max(axis=0)
        patch = Ellipse(tuple((low + high) / 2), *(high - low)) if kind == "ball" else Polygon(points, closed=True)
        patch.set(facecolor=colour_of(shade, backward), edgecolor="0.2", linewidth=0.6, zorder=3, transform=true)
        ax.add_patch(patch)
