# SPDX-License-Identifier: MPL-2.0
"""Pictures and order of the gallery: which pictures a program makes, where they are on its page, which program is first."""

import re
from pathlib import Path
from typing import Any

import matplotlib
from sphinx_gallery.scrapers import matplotlib_scraper

from revchain.plots.style import STYLE

FIRST = ["crane", "swing_carousel", "chair_o_plane", "troposkien", "pipe_from_ship", "whirling_chain_3d", "watch_chain"]


def scrape(*given: Any) -> str:
    """Takes the figures of pyplot, as SVG."""
    return matplotlib_scraper(*given, format="svg", metadata={"Date": None})


def order(name: str) -> tuple[int, str]:
    """The programs of `FIRST` before the others of their group, which are in the order of their names."""
    stem = Path(name).stem
    return FIRST.index(stem) if stem in FIRST else len(FIRST), stem


def picture_first(_: Any, name: str, source: list[str]) -> None:
    """Moves the first picture of a program's page before the code that draws it. Its text is the title of the page."""
    picture = re.search(r"\n(\.\. image-sg:: .*?\n)(?=\n*\S)", source[0], re.DOTALL)
    if name.startswith("gallery/") and picture:
        [title] = re.findall(r"^(.+)\n=+$", source[0], re.MULTILINE)
        first = re.sub(r":alt: .*", lambda _: f":alt: {title}", picture[1])
        rest = source[0].replace(picture[0], "\n", 1)
        mark = ".. GENERATED FROM PYTHON SOURCE LINES"
        source[0] = rest.replace(mark, f"{first}\n{mark}", 1)


def setup(app: Any) -> dict[str, bool]:
    matplotlib.rcParams.update(STYLE)
    app.connect("source-read", picture_first)
    return {"parallel_read_safe": True}
