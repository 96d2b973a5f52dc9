#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Puts the live page together: web/page.html with its style, scripts, presets and the compiled engine, one file.

    tools/web_page.py ENGINES OUT.html

ENGINES is the folder of the compiled engines, simd and plain. The plain one goes into plain.js beside OUT.html: the
page loads it only where the browser lacks SIMD or cannot unpack the other one. The numbers of the presets are those of
examples/scenes, read by the package.
"""

import base64
import gzip
import json
import re
import sys
from pathlib import Path
from typing import Any

import numpy as np

import revchain as rc
from revchain.plots.forms import form_of

ROOT = Path(__file__).resolve().parent.parent
WEB = ROOT / "web"
STORIES = json.loads((WEB / "stories.json").read_text(encoding="utf-8"))  # a sentence and two things to try for each
LOWEST = {"swing_carousel": "seat"}  # forms of free ends that have no name
SCRIPTS = ("state.js", "client.js", "draw.js", "controls.js", "page.js")
# Scenes that the page shows, in the groups and the order of its list. It has no fluids, no held ends and no 10,000 links.
GROUPS = {
    "Weights and chains": "two_weights bernoulli_chain plucked_chain weight_ratio ball_on_chain watch_chain",
    "Rods and loads": "stick_on_string rods_on_threads jointed_rod crane_hook_block",
    "Bells and moving supports": "clamped_bell bell_and_clapper bell_on_soft_frame swing_carousel chair_o_plane "
    "carriage_on_springs",
    "Balancing and spinning": "broomstick acrobat bicycle_wheels two_gyrostats",
}
GROUP_OF = {name: group for group, names in GROUPS.items() for name in names.split()}
PRESETS = list(GROUP_OF)


def preset(name: str) -> dict[str, Any]:
    """The scene as the state of the page: parts of equal links, lowest first."""
    scene = rc.load_scene(ROOT / f"examples/scenes/{name}.toml")
    system, gravity = scene.system(), scene.gravity_value()
    assert isinstance(system, rc.Chain | rc.Rig), f"{name} is neither a chain nor a rig"
    rig = system if isinstance(system, rc.Rig) else rc.Rig(system)
    chain, support = rig.chain, rig.support
    momentum, axial = (0.0, 0.0) if rig.flywheels is None else rig._turning(gravity)
    heavy = chain.mass if chain.by_mass else chain.weight
    columns = (heavy, chain.length, chain.centroid, chain.radius_of_gyration, rig.inverted, momentum * gravity, axial)
    rows = list(zip(*(np.broadcast_to(column, chain.size).tolist() for column in columns), strict=True))
    of_links = [form_of(each) for each in chain.names or [""] * chain.size]
    of_links[0] = LOWEST.get(name, of_links[0])
    parts: list[list[float]] = []
    forms: list[str] = []
    for row, form in zip(rows, of_links, strict=True):
        if parts and parts[-1][1:] == [float(x) for x in row] and forms[-1] == form:
            parts[-1][0] += 1
        else:
            parts.append([1, *map(float, row)])
            forms.append(form)
    stiffness = None if np.isinf(support.stiffness) else support.stiffness
    return {
        "name": name,
        "group": GROUP_OF[name],
        "title": scene.title,
        **STORIES[name],  # may have a shorter title
        "parts": parts,
        "forms": forms,
        "gravity": gravity,
        "radius": support.radius,
        "stiffness": stiffness,
        "carriage": support.carriage,
    }


def without_comments(text: str) -> str:
    """Scripts and style as the page holds them: without the lines that are comments."""
    return re.sub(r"^\s*(//.*|/\*((?!\*/).)*\*/)\n", "", text, flags=re.MULTILINE)


def packed(path: Path) -> str:
    return base64.b64encode(gzip.compress(path.read_bytes(), 9, mtime=0)).decode()


def main(engines: Path, out: Path) -> None:
    text = {path.name: path.read_text(encoding="utf-8") for path in WEB.iterdir() if path.suffix != ".cpp"}
    parts = {
        "STYLE": without_comments(text["page.css"]),
        "PRESETS": json.dumps([preset(name) for name in PRESETS], separators=(",", ":")),
        "GLUE": (engines / "simd.js").read_text(encoding="utf-8"),
        "WORKER": without_comments(text["engine.js"]),
        "ENGINE": packed(engines / "simd.wasm"),
        "VIEWER": (ROOT / "src/revchain/motion/viewer.min.js").read_text(encoding="utf-8"),
        "SCRIPTS": without_comments("\n".join(text[name] for name in SCRIPTS)),
    }
    page = text["page.html"]
    for name, value in parts.items():
        page = page.replace(f"{{{{{name}}}}}", value.replace("</script", "<\\/script"))
    out.parent.mkdir(parents=True, exist_ok=True)
    out.write_text(page, encoding="utf-8")
    sizes = [f"{out.name} {out.stat().st_size / 1000:.0f} KB"]
    if (engines / "plain.wasm").is_file():
        plain = {
            "glue": (engines / "plain.js").read_text(encoding="utf-8"),
            "wasm": base64.b64encode((engines / "plain.wasm").read_bytes()).decode(),
        }
        fallback = out.with_name("plain.js")
        fallback.write_text(f"plainEngine({json.dumps(plain)});\n", encoding="utf-8")
        sizes.append(f"plain.js {fallback.stat().st_size / 1000:.0f} KB, loaded only where SIMD is missing")
    print(f"wrote {out}: {'; '.join(sizes)}")


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
