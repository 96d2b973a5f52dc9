# SPDX-License-Identifier: MPL-2.0
"""python tools/check_search.py FOLDER: checks that visitors find their page with the search of a site.

An engineer's words are in a title or in the index. What visitors type leads to its page, which is the first or the second
result: the scripts of the site's search page are run by node.
"""

import json
import subprocess
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

# What a visitor types, and the page that must be the first or the second result. The first entry must be the first.
QUESTIONS = {
    "natural frequency": "tutorial/first_chain",
    "natural frequencies of a double pendulum": "tutorial/first_chain",
    "double pendulum period": "tutorial/first_chain",
    "natural frequency of a crane load": "tutorial/crane",
    "angle of a swing carousel at 12 rpm": "tutorial/carousel",
    "critical speed": "tutorial/first_chain",
    "skipping rope shape": "held",
    "period of a rope": "tutorial/measured_chain",
    "catenary": "howto/catenary",
    "cable between two points": "howto/catenary",
    "Campbell diagram": "howto/campbell",
    "Darrieus": "howto/darrieus",
    "stability of a steady shape": "theory/stability",
    "bifurcation diagram": "tutorial/carousel",
    "units rpm": "howto/units",
    "install without GSL": "install",
    "exit codes": "reference/command_line",
    "use it from C++": "tutorial/cpp",
    "compare with MuJoCo": "about/comparison",
    "limitations": "about/limitations",
    "friction": "about/limitations",
    "licence": "about/licence",
    "license commercial": "about/licence",
    "how to cite": "about/cite",
    "changelog": "about/changes",
    "classroom experiments": "howto/classroom",
    "steady_shapes": "reference/python/revchain.steady_shapes",
    "C++ reference": "reference/cpp",
    "tilt of the seat of a carousel": "tutorial/carousel",  # no page has the first word
    "eigenfrequency of my crane hoist": "tutorial/crane",
    "how can I find and compute the troposkien I will need": "howto/darrieus",
}


def misplaced(folder: Path) -> list[str]:
    """The questions whose page is not the first or the second result."""
    script = Path(__file__).with_name("search_site.js")
    done = subprocess.run(["node", script, folder], input="\n".join(QUESTIONS), capture_output=True, text=True, check=True)
    found = [[page.partition("#")[0] for page, *_ in json.loads(line)] for line in done.stdout.splitlines()]
    complaints = []
    for number, ((query, page), pages) in enumerate(zip(QUESTIONS.items(), found, strict=True)):
        if page not in list(dict.fromkeys(pages))[: 2 if number else 1]:
            complaints.append(f"{query!r} must find {page} first or second, finds {', '.join(pages[:4]) or 'nothing'}")
    return complaints


def main(folder: Path) -> int:
    text = (folder / "searchindex.js").read_text(encoding="utf-8")
    index = json.loads(text.removeprefix("Search.setIndex(").removesuffix(")"))
    words = [word.casefold() for word in [*index["alltitles"], *index["indexentries"]]]
    lost = [term for term in TERMS if not any(term.casefold() in word for word in words)]
    wrong = misplaced(folder)
    print(*(f"no title and no entry of the index has: {term}" for term in lost), *wrong, sep="\n", end="\n" if lost or wrong else "")
    print(f"{len(TERMS)} terms and {len(QUESTIONS)} questions searched")
    return min(len(lost) + len(wrong), 1)


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
