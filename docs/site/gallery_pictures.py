# SPDX-License-Identifier: MPL-2.0
"""How the gallery takes the pictures that programs write, and in which order it shows the programs."""

import shutil
from pathlib import Path
from typing import Any

from sphinx_gallery.scrapers import figure_rst


def scrape(block: Any, block_vars: dict[str, Any], gallery_conf: dict[str, Any]) -> str:
    """Takes every picture that a program has written beside itself."""
    names = block_vars["image_path_iterator"]
    taken = []
    for written in sorted(Path(block_vars["src_file"]).parent.glob("*.svg")):
        name = Path(next(names)).with_suffix(".svg")
        shutil.move(written, name)
        taken.append(str(name))
    return figure_rst(taken, gallery_conf["src_dir"])


def programs_before_experiments(name: str) -> tuple[bool, str]:
    return Path(name).name.startswith("experiment"), name
