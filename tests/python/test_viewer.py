# SPDX-License-Identifier: GPL-3.0-or-later
"""Pages: they contain the file of `to_glb`, load nothing, and a browser shows all of it."""

import base64
import html
import json
import re
import shutil
import subprocess
from importlib.resources import files
from pathlib import Path

import numpy as np
import pytest
from moving import ALL, CHAIN, WHEELS, film

import revchain as rc

gltf = pytest.importorskip("pygltflib")

ROOT = Path(__file__).parents[2]
SOURCES = ROOT / "src" / "revchain" / "motion" / "viewer"
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser")
SOFTWARE = ["--enable-unsafe-swiftshader", "--use-angle=swiftshader"]
needs_browser = pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")


def page_of(found, tmp_path, **given):
    path = tmp_path / "solid.html"
    found.animate(path, **given)
    return path


def solid_in(page):
    [data] = re.findall(r'<script type="text/plain" id="solid">([^<]*)</script>', page)
    return base64.b64decode(data, validate=True)


def opened(address, tmp_path, *options):
    """What the page is after a few seconds in a browser: the data of its body, and the whole."""
    done = subprocess.run(
        [CHROMIUM, "--headless", "--no-sandbox", "--disable-extensions", f"--user-data-dir={tmp_path / 'profile'}"]
        + ["--window-size=1280,900", "--virtual-time-budget=5000", *options, "--dump-dom", address],
        capture_output=True,
        text=True,
        timeout=300,
    )
    assert done.returncode == 0, done.stderr
    [body] = re.findall(r"<body([^>]*)>", done.stdout)
    return dict(re.findall(r'data-(\w+)="([^"]*)"', body)), done.stdout


@pytest.mark.parametrize("kind", ALL)
def test_the_solid_is_that_of_to_glb(kind, tmp_path):
    found = ALL[kind]()
    calls = []
    page = page_of(found, tmp_path, duration=1.0, progress=lambda *now: calls.append(now)).read_text(encoding="utf-8")
    found.to_glb(tmp_path / "solid.glb", duration=1.0)
    assert solid_in(page) == (tmp_path / "solid.glb").read_bytes()
    shown = film(found, duration=1.0)
    assert calls == [(n + 1, len(shown.figures)) for n in range(len(shown.figures))]
    assert f"<title>{html.escape(shown.system)}</title>" in page


def test_what_the_nodes_say(tmp_path):
    """Captions, and the speed of what only turns."""
    modes, branch = rc.modes(WHEELS), rc.branch(CHAIN, 1, max_angular_speed=9.0)
    for found in (modes, branch):
        path = tmp_path / "solid.glb"
        found.to_glb(path, duration=1.0)
        file, shown = gltf.GLTF2().load(path), film(found, duration=1.0)
        [scene] = file.scenes
        assert scene.extras.get("note", "") == shown.note and scene.extras["progress"] == list(shown.progress)
        assert ("chart" in scene.extras) == (shown.chart is not None)
        for node, figure in zip(scene.nodes, shown.figures, strict=True):
            extras = file.nodes[node].extras
            assert extras["caption"] == figure.captions[0]
            assert extras.get("captions", [extras["caption"]]) == list(figure.captions)
            assert extras.get("angular_speed") == (figure.speed[0] if figure.is_rigid else None)
    assert not film(branch).is_rigid and shown.progress[-1] == "Along branch: 9.00 rad/s"
    chart = scene.extras["chart"]
    assert (chart["x_label"], chart["y_label"]) == (shown.chart.x_label, shown.chart.y_label)
    for name in ("x", "y", "lines"):
        for one, other in zip(chart[name], getattr(shown.chart, name), strict=True):
            assert np.allclose(one, other, rtol=1e-4, atol=0)


def test_progress_of_each_kind():
    """Time, speed, or how far along the branches; pages of what only turns count the time themselves."""
    assert film(ALL["modes"]()).progress == ()
    assert film(ALL["swing"](), time_scale=1.0).progress[0] == "Time: 0.500 s"
    assert film(ALL["response"]()).progress[0] == "Speed: 1.00 rad/s"
    several = film(ALL["branches"]()).progress
    assert (several[0], several[-1]) == ("Along branches: 0 %", "Along branches: 100 %")


def test_the_page_names_no_other_file(tmp_path):
    text = page_of(rc.modes(CHAIN), tmp_path).read_text(encoding="utf-8")
    assert "default-src 'none'" in text  # the browser refuses all that is not in the page
    page = re.sub(r"<script[^>]*>.*?</script>", "", text, flags=re.DOTALL)
    assert not re.search(r"https?:|\b(src|href|url)\b\s*[=(]", page)
    names = {"http://www.w3.org/1999/xhtml", "http://www.w3.org/2000/svg"}  # of XML, no addresses
    assert set(re.findall(r"https?://[^\"'`\s]*", text)) == names
    script = files("revchain").joinpath("motion", "viewer.min.js").read_text(encoding="utf-8")
    assert len(script.encode()) < 603_000 and "three.js authors" in script and "Permission is hereby granted" in script


@pytest.mark.slow
@needs_browser
@pytest.mark.parametrize(
    "kind", ["modes", "modes of a rig", "shapes of a carousel", "shapes on arms", "branches", "swing", "response"]
)
def test_a_browser_shows_all_of_it(kind, tmp_path):
    found = ALL[kind]()
    path = page_of(found, tmp_path, duration=2.0)
    status, page = opened(f"{path.as_uri()}#t=1.24", tmp_path, *SOFTWARE)
    file, shown = gltf.GLTF2.load_from_bytes(solid_in(page)), film(found, duration=2.0)
    sides = {n: file.accessors[mesh.primitives[0].indices].count // 3 for n, mesh in enumerate(file.meshes)}
    counts = {
        "figures": len(shown.figures),
        "nodes": len(file.nodes),
        "channels": len(file.animations[0].channels),
        "triangles": sum((1 if node.name == "axis" else 2) * sides[node.mesh]  # of each part and its shadow
                         for node in file.nodes if node.mesh is not None),
        "seen": sum(node.mesh is not None and node.name != "axis" for node in file.nodes),
    }  # fmt: skip
    assert status == {"state": "loaded", **{name: str(count) for name, count in counts.items()}}
    captions = re.findall(r'<div class="caption"[^>]*data-words="([^"]*)"', page)
    assert [html.unescape(words) for words in captions] == [figure.caption(31) for figure in shown.figures]
    assert re.findall(r'<p id="words">([^<]*)</p>', page) == [shown.words]
    controls = re.findall(r'<(?:button|output|input) id="(\w+)', page.partition("<footer>")[2])
    assert controls == ["play", "playback", "pace", "progress", "at", "reset"]  # in the same order on every page
    said = dict(re.findall(r'<output id="(\w+)"[^>]*>([^<]*)</output>', page))
    seconds = 1.24 * shown.time_scale
    time = f"Time: {seconds:.{max(0, 2 - int(np.floor(np.log10(shown.seconds * shown.time_scale))))}f} s"
    assert said == {"playback": "×1", "progress": shown.progress[31] if shown.progress else time}
    assert page.count("<circle") == (len(shown.figures) if shown.chart else 0)


@pytest.mark.slow
@needs_browser
def test_without_webgl(tmp_path):
    path = page_of(rc.modes(CHAIN), tmp_path, duration=0.2)
    status, page = opened(path.as_uri(), tmp_path, "--disable-3d-apis")
    error = "This page needs WebGL, which this browser does not have or has switched off."
    assert status == {"state": "failed", "error": error} and f'<p id="wrong">{error}</p>' in page


@pytest.mark.slow  # asks a registry
def test_the_bundle_is_what_its_sources_make(tmp_path):
    npm = shutil.which("npm")
    if npm is None or not SOURCES.is_dir():
        pytest.skip("npm is not installed")
    three = json.loads((SOURCES / "package.json").read_text("utf-8"))["dependencies"]["three"]
    if subprocess.run([npm, "view", f"three@{three}", "version"], capture_output=True, timeout=120).returncode:
        pytest.skip("npm finds no registry")
    done = subprocess.run([ROOT / "tools" / "viewer", tmp_path / "viewer.min.js"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert (tmp_path / "viewer.min.js").read_bytes() == SOURCES.with_name("viewer.min.js").read_bytes()
