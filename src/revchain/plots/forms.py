# SPDX-License-Identifier: GPL-3.0-or-later
"""Forms of bodies by the names of their links, from one table: pictures, 3D models and the live page draw them."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.axes import Axes

FORM_OF_WORD = {  # in the name of a link
    "bell": "bell", "clapper": "clapper", "jar": "jar", "man": "person", "acrobat": "person", "chair": "seat", "seat": "seat", "load": "crate",
    "hook": "hook", "wheel": "wheel", "gyrostat": "disc",
}  # fmt: skip


@cache
def forms() -> dict[str, Any]:
    """Return the table of forms: colours, profiles, and the pieces of each body."""
    found: dict[str, Any] = json.loads(files("revchain").joinpath("motion/viewer/forms.json").read_text(encoding="utf-8"))
    return found


SIZES: dict[str, Any] = forms()["sizes"]  # over the height or the width of the whole; `rim` of a wheel on a point mass


def form_of(name: str) -> str:
    """Return the form of a link whose name has one of the words of the table; empty for a bar with a ball."""
    return next((form for word, form in FORM_OF_WORD.items() if word in name.lower().split()), "")


def unit_of(body: dict[str, Any], tall: float, length: float, gyration: float) -> float:
    """Return what the numbers of the pieces of a body are multiplied by, m, in a system that is so tall."""
    rim = max(np.sqrt(2) * gyration, SIZES["rim"] * tall)
    return float({"tall": tall, "gyration": gyration, "length": length, "rim": rim}[body["unit"]])


def colour_of(shade: str, backward: bool) -> str:
    """Return the colour of a piece; one without a colour of its own has that of its direction of spin."""
    colours: dict[str, str] = forms()["colours"]
    return colours.get(shade, colours["back" if backward else "ahead"])


def opacity_of(colour: str) -> float:
    """Return the opacity of a colour of the table, below 1 for a bell, whose clapper is seen."""
    table = forms()
    return float({table["colours"][name]: part for name, part in table["opacity"].items()}.get(colour, 1.0))


def pieces_of(body: dict[str, Any], along: Any) -> Iterator[tuple[Any, list[Any]]]:
    """Yield each piece of a body with the distance from the pin at which its heights start.

    The body starts at its centre of gravity, at the distance `along`, unless its unit is the length of the link.
    """
    start = 0.0 if body["unit"] == "length" else along
    yield from ((start, piece) for piece in body["pieces"])
    yield from ((0.0, piece) for piece in body.get("at_pin", ()))


def reach_of(form: str) -> float:
    """Return how far a form reaches sideways, in its unit."""
    pieces = forms()["bodies"][form]["pieces"]
    return float(max(abs(at[2]) + (scale[2] / 2 if kind == "box" else scale[2]) for kind, _, at, scale, *_ in pieces))


def draw_form(ax: Axes, form: str, at: float, pin: float, down: float, along: float, unit: float, wide: float) -> None:
    """Draw the pieces of a body, seen from the side, on an axis whose numbers are `wide` times metres.

    The link hangs from or stands on the pin at the level `pin`. Levels grow by `down` (1 or -1) along it. Its centre of
    gravity is `along` metres from the pin.
    """
    from matplotlib.patches import Ellipse, Polygon, Rectangle

    body, profiles = forms()["bodies"][form], forms()["profiles"]
    for start, (kind, shade, (_, y, z), scale, *tilt) in pieces_of(body, along):
        x, level, (_, high, deep) = at + wide * z * unit, pin + down * (start + y * unit), np.multiply(scale, unit)
        style: dict[str, Any] = {"facecolor": colour_of(shade, False), "edgecolor": "0.2", "linewidth": 0.6, "zorder": 3}
        if kind in profiles:
            profile, up = np.array(profiles[kind]), -down if tilt else down
            side = np.column_stack([wide * deep * profile[:, 0], up * high * profile[:, 1]])
            outline = np.concatenate([side, (side * [-1, 1])[::-1]]) + [x, level]
            ax.add_patch(Polygon(outline, closed=True, **style))
        elif kind == "ball":
            ax.add_patch(Ellipse((x, level), 2 * wide * deep, 2 * high, **style))
        elif kind == "rim" or (kind == "bar" and not tilt):
            half = deep * (1.05 if kind == "rim" else 1.0)
            tall = 0.1 * high if kind == "rim" else high
            ax.add_patch(Rectangle((x - wide * half, level - tall / 2), 2 * wide * half, tall, **style))
        elif kind == "box":
            ax.add_patch(Rectangle((x - wide * deep / 2, level - high / 2), wide * deep, high, **style))
