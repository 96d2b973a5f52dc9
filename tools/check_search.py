# SPDX-License-Identifier: MPL-2.0
"""python tools/check_search.py FOLDER: an engineer's words lead somewhere, in the titles or the index of a site."""

import json
import sys
from pathlib import Path

TERMS = [
    "natural frequency", "eigenfrequency", "critical speed", "whirl", "relative equilibrium", "double pendulum",
    "spherical pendulum", "conical pendulum", "Bessel function", "troposkien", "bifurcation diagram", "fold", "gyrostat",
    "flywheel", "added mass", "buoyancy", "base excitation", "resonance", "mode shape", "node", "uncertainty", "sensitivity",
    "stability", "damping", "tapered cord", "skipping rope", "governor", "bell", "clapper", "carousel", "crane",
    "compound pendulum", "radius of gyration", "inverted pendulum", "least squares", "error bound", "generalized eigenproblem",
    "elliptic function", "limit of many links",
]  # fmt: skip


def main(folder: Path) -> int:
    text = (folder / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text.removeprefix("Search.setIndex(").removesuffix(")"))
    words = [word.casefold() for word in [*index["alltitles"], *index["indexentries"]]]
    lost = [term for term in TERMS if not any(term.casefold() in word for word in words)]
    print(*(f"no title and no entry of the index has: {term}" for term in lost), f"{len(TERMS)} terms searched", sep="\n")
    return min(len(lost), 1)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
