# SPDX-License-Identifier: GPL-3.0-or-later
"""The report of a scene: one page that is complete, valid and needs nothing else; what it says is what was found."""

import re
from datetime import date
from pathlib import Path

import numpy as np
import pytest
from pages import Page, style_of

import revchain as rc
from revchain.cli import ExitCode
from revchain.cli import ask as _ask
from revchain.results.sheet import cells
from revchain.scenes import report as _report

SCENES = Path(__file__).resolve().parents[2] / "examples" / "scenes"
EXAMPLES = sorted(path for path in SCENES.glob("*.toml"))
CRANE = SCENES / "crane_hook_block.toml"
HOSTILE = """
title = "Crane & <script>alert(1)</script> $x$"
description = 'A "quoted" <b>text</b>'
order = "support first"
[[links]]
name = "hook <b>block</b> & co"
mass = "0.4 t"
length = "24 m"
pin = {damping = "20 kN m s/rad"}
[[links]]
name = "load"
mass = "2.5 t"
length = "6 m"
[ask.modes]
[ask.response]
angular_speed = {from = "0.1 rad/s", to = "5 rad/s", steps = 100}
acceleration = "0.1 m/s^2"
[ask.shapes]
angular_speed = "10 rpm"
"""


def page_of(path, scene):
    scene.report(path)
    text = path.read_text(encoding="utf-8")
    return text, Page(text)


def numbers_of(text):
    """The significant words of a text: numbers and words, without blanks."""
    return re.sub(r"\s+", "", text)


@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_every_example(path, tmp_path):
    """The page is valid and self-contained, and has each table, the system, the verdicts and the scene."""
    scene = rc.load_scene(path)
    text, page = page_of(tmp_path / "report.html", scene)
    assert page.problems == []
    assert [each for each in page.resources if not each.startswith("data:")] == []
    assert not re.search(r"https?:|//|url\(|@import", style_of(text)) and "<script" not in text
    answers, system = scene.answers(), scene.system()
    assert len([*page.svgs()]) == 1 + len(answers)
    shown = numbers_of(page.text)
    for part in system.describe().split("; "):
        assert numbers_of(part).lower() in shown.lower()
    assert numbers_of(path.read_text(encoding="utf-8")) in shown
    assert scene.title in page.text and f"revchain {rc.__version__}" in page.text and "9.80665 m/s²" in page.text
    assert f"revchain run {path.name} --report {path.stem}.html" in page.text
    rows = [[cell.strip() for cell in row] for table in page.tables for row in table]
    for question, found in answers.items():
        assert _report.TITLES[question] in page.text and question in page.ids
        for sheet in [found._printed(), *_report.further_sheets(found)]:
            headings, body, _ = cells(sheet, _report.MOST_SHOWN)
            for row in body:
                assert [cell.replace("nan", "–") for cell in row] in rows
            if body:
                assert [numbers_of(re.sub(r"[()]|\^[23]", "", heading)) for heading in headings] in [
                    [re.sub("[²³]", "", numbers_of(cell)) for cell in row] for row in rows
                ]
        for verdict in _report.verdicts(found):
            assert verdict.sentence in page.text and _report.WORDS[verdict.kind] + "." in page.text


def test_each_question_has_a_verdict_and_a_finding():
    asked = set()
    for path in EXAMPLES:
        for question, found in rc.load_scene(path).answers().items():
            asked.add(question)
            said = _report.verdicts(found)
            assert said and all(each.kind in _report.WORDS and each.sentence.endswith(".") for each in said)
            assert _report.finding(found).endswith(".")
    assert asked == set(_report.TITLES)


def test_verdicts_are_true():
    """What the report calls proved is what the result says."""
    shapes = rc.load_scene(SCENES / "chair_o_plane.toml").steady_shapes()
    first, second, third = _report.verdicts(shapes)
    assert shapes.complete and first.kind == "proved" and "no other hanging shape" in first.sentence
    assert second.sentence == f"The error of each inclination is at most {shapes[0].error_bound:.1e} rad."
    assert shapes[0].stability().verdict == "minimum" and "also with friction" in third.sentence
    held = rc.load_scene(SCENES / "troposkien.toml").steady_shapes()
    assert not held.complete and _report.verdicts(held)[0].kind == "open"
    modes = rc.load_scene(CRANE).modes()
    bound, counted = _report.verdicts(modes)
    assert f"{modes.speed_error_bound.max():.1e}" in bound.sentence and bound.kind == counted.kind == "proved"
    rough = rc.modes(rc.Chain.uniform_rods(300, length=1.0), 5, rtol=1e-3)
    said = _report.verdicts(rough)
    assert said[0].kind == "proved" and f"{rough.speed_error_bound.max():.1e}" in said[0].sentence
    chain = rc.Chain(mass=[1.0, 1.0, 1.0], length=1.0)
    branch = rc.steady_shapes(chain, angular_speed=13.5, mode=2)
    assert branch.mode == 2 and _report.verdicts(branch)[0].sentence == "Only the branch of mode 2 was searched."
    three = rc.steady_shapes(chain, angular_speed=13.5)
    words = {_report.STABILITY[shape.stability().verdict] for shape in three}
    assert words == {each.sentence.partition(" is ")[2][:-1] for each in _report.verdicts(three)[2:]} and len(words) > 1


def test_damped_modes_are_decaying_oscillations(tmp_path):
    """No whirl goes on with dashpots; the main result has the decay times."""
    scene = tmp_path / "damped.toml"
    scene.write_text('[[links]]\nmass = 1\nlength = 1\npin = {damping = 0.2}\n[ask.modes]\n', encoding="utf-8")
    loaded = rc.load_scene(scene)
    page = _report.page_of(loaded, loaded.answers())
    assert "can whirl" not in page and "it oscillates with this period and decays" in page
    found = loaded.modes()
    assert _report.finding(found).endswith(", decays in 10 s to 1/e.") and "rad/s" in _report.finding(found)
    strong = rc.modes(rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=10.0)), gravity=9.81)
    assert _report.finding(strong).startswith("Mode 1: decays in ") and "rad/s" not in _report.finding(strong)
    standing = rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=1.0), inverted=True)
    assert "grows in" in _report.finding(rc.modes(standing, gravity=9.81))


def test_resonance_and_empty_answers():
    height = float(rc.modes(rc.Chain(mass=1.0, length=1.0)).conical_height[0])
    resonant = rc.response(rc.Chain(mass=1.0, length=1.0), conical_height=height, support_radius=0.01)
    assert resonant.resonant and "without bound" in _report.finding(resonant)
    assert "open" in [each.kind for each in _report.verdicts(resonant)]
    none = rc.steady_shapes(rc.Chain(mass=1.0, length=1.0), angular_speed=1.0)
    assert len(none) == 0 and [each.kind for each in _report.verdicts(none)] == ["proved"]
    falling = rc.modes(rc.Rig(rc.Chain(mass=1.0, length=1.0), inverted=True))
    assert len(falling) == 0 and "doubles every" in _report.finding(falling)


def test_hostile_texts(tmp_path, run):
    path = tmp_path / "a scene.toml"
    path.write_text(HOSTILE)
    code, out, err = run("run", path, "--out", tmp_path / "out", "--report", tmp_path / "r.html", "--gravity", "1.62 m/s^2")
    assert (code, err) == (0, "") and f"wrote {tmp_path / 'r.html'}" in out
    text = (tmp_path / "r.html").read_text(encoding="utf-8")
    page = Page(text)
    assert page.problems == [] and "<script" not in text and "<b>block" not in text
    assert "Crane & <script>alert(1)</script> $x$" in page.text and 'A "quoted" <b>text</b>' in page.text
    assert 'revchain run "a scene.toml" --report "a scene.html" --gravity "1.62 m/s^2"' in page.text
    assert "gravity 1.62 m/s²" in page.text and "40 of 100 rows, evenly spaced" in page.text
    speeds = [row[0] for table in page.tables for row in table if len(row) == 8]
    assert speeds.count("5.0000") == 2  # in the printed table, and in that of all rows
    assert date.today().isoformat() in page.text


def test_angles_in_radians(tmp_path, run):
    path = SCENES / "chair_o_plane.toml"
    shapes = rc.load_scene(path).steady_shapes()
    for units, inclination in (("deg", np.degrees(shapes.lowest_inclination[0])), ("rad", shapes.lowest_inclination[0])):
        file = tmp_path / f"{units}.html"
        assert run("run", path, "--out", tmp_path / "out", "--report", file, "--units", units, "--quiet")[0] == 0
        page = Page(file.read_text(encoding="utf-8"))
        assert f"{inclination:#.5g}" in [cell for table in page.tables for row in table for cell in row]
        assert ("--units rad" in page.text) == (units == "rad")


def test_numbers_are_aligned_at_the_point():
    texts = _report._aligned(["1.5", "12.25", "-3", "nan", "inf"])
    assert [re.sub(r"<[^>]*>", "", text) for text in texts] == ["1.50", "12.25", "-3.00", "–", "inf"]
    assert _report._aligned(["1.1e-16", "2.2e-16"]) == ["1.1e-16", "2.2e-16"]
    assert _report._aligned(["1,000", "20"]) == ["1,000", "20"] and _report._aligned([]) == []
    lengths = [len(re.sub(r"<[^>]*>", "", text).partition(".")[2]) for text in _report._aligned(["0.1", "100.", "7", "3.1415"])]
    assert lengths == [4] * 4


def test_a_scene_of_a_dictionary(tmp_path):
    """Its data are in the report as JSON, which the command line reads."""
    data = {"title": "Bob", "links": [{"mass": 1, "length": "50 cm"}], "ask": {"modes": {}}}
    text, page = page_of(tmp_path / "bob.html", rc.Scene.from_dict(data))
    assert page.problems == []
    written = re.search(r'<pre class="scene">(.*?)</pre>', text, re.DOTALL)[1]
    (tmp_path / "scene.json").write_text(written.replace("&quot;", '"'))
    assert rc.load_scene(tmp_path / "scene.json").to_dict() == data
    assert "revchain run scene.json --report scene.html" in page.text


def test_the_text_is_that_of_the_file_when_it_was_read(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text('title = "First"\n[[links]]\nmass = 1\nlength = 1  # m\n')
    scene = rc.load_scene(path)
    path.write_text("changed")
    _, page = page_of(tmp_path / "a.html", scene)
    assert "length = 1  # m" in page.text and "changed" not in page.text


def test_a_question_without_an_answer_is_said(tmp_path, run):
    path = tmp_path / "a.toml"
    path.write_text('[cord]\nlength = 1\nmass = 1\n[ask.modes]\ncount = 2\n[ask.response]\nangular_speed = 3\n')
    file = tmp_path / "a.html"
    code, _, err = run("run", path, "--out", tmp_path / "out", "--report", file)
    page = Page(file.read_text(encoding="utf-8"))
    assert code == ExitCode.WRONG_USAGE and "response: no answer for a cord" in err and page.problems == []
    assert "No answer. No answer for a cord; cut it into links" in page.text and "Whirl speeds" in page.text


@pytest.mark.parametrize(
    ("options", "code", "sentence"),
    [
        (["--report", "a.pdf"], ExitCode.WRONG_USAGE, "--report: must end in .html, got a.pdf; a browser prints the page to PDF"),
        (["--report", "a"], ExitCode.WRONG_USAGE, "--report: must end in .html, got a"),
        (["--report", "missing/a.html"], ExitCode.OUTPUT_FAILED, "missing/a.html: cannot be written: No such file or directory"),
        (["--report", "/proc/a.html"], ExitCode.OUTPUT_FAILED, "/proc/a.html: cannot be written: "),
        (["--xlsx", "a.xls"], ExitCode.WRONG_USAGE, "--xlsx: a.xls must end in .xlsx"),
        (["--xlsx", "missing/a.xlsx"], ExitCode.OUTPUT_FAILED, "missing/a.xlsx: cannot be written: "),
    ],
)
def test_wrong_outputs(options, code, sentence, tmp_path, monkeypatch, run):
    """They are found out before anything is solved."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(_ask, "watched", lambda *_: pytest.fail("solved"))
    found, out, err = run("run", CRANE, *options)
    assert (found, out) == (code, "") and sentence in err and err.count("\n") == 1
    assert [path for path in tmp_path.rglob("*") if path.is_file()] == []


def test_the_scene_is_not_overwritten(tmp_path, run):
    path = tmp_path / "scene.html"
    path.write_text('{"links": [{"mass": 1, "length": 1}]}')
    code, _, err = run("run", path, "--report", path)
    assert code != 0 and path.read_text().startswith('{"links"')
    for wrong in ("a.txt", tmp_path / "a.HTM.gz"):
        with pytest.raises(ValueError, match="revchain.Scene.report: path must end in .html, got"):
            rc.load_scene(CRANE).report(wrong)
    with pytest.raises(OSError, match="No such file"):
        rc.load_scene(CRANE).report(tmp_path / "missing" / "a.html")


def test_an_old_report_stays_if_the_new_one_fails(tmp_path, monkeypatch, run):
    file = tmp_path / "a.html"
    file.write_text("old")
    monkeypatch.setattr(_report, "_picture", lambda *_: (_ for _ in ()).throw(OSError(28, "No space left on device")))
    code, _, err = run("run", CRANE, "--out", tmp_path / "out", "--report", file)
    assert code == ExitCode.OUTPUT_FAILED and "No space left" in err and file.read_text() == "old"
    assert [path.name for path in tmp_path.iterdir() if path.is_file()] == ["a.html"]


def test_the_same_scene_gives_the_same_page(tmp_path):
    """But for the date, so that two reports can be compared."""
    pages = []
    for name in ("a.html", "b.html"):
        rc.load_scene(SCENES / "two_weights.toml").report(tmp_path / name)
        pages.append((tmp_path / name).read_bytes())
    assert pages[0] == pages[1]


def test_figures_are_closed(tmp_path):
    import matplotlib.pyplot as plt

    before = plt.get_fignums()
    rc.load_scene(SCENES / "two_weights.toml").report(tmp_path / "a.html")
    assert plt.get_fignums() == before


def test_long_chains_and_long_tables(tmp_path):
    """Many links are drawn and described in a page of ordinary size."""
    scene = rc.Scene.from_dict({"uniform_chain": {"kind": "rods", "count": 100_000, "length": 100, "mass": 50}, "ask": {"modes": {"count": 45}}})
    text, page = page_of(tmp_path / "a.html", scene)
    assert page.problems == [] and len(text) < 1_000_000 and "0 to 99999" in page.text
    assert "40 of 45 rows" in page.text and "All 45 rows" in page.text
    masses = np.arange(1.0, 61.0)
    unlike = rc.Scene.from_dict({"links": [{"mass": mass, "length": 1} for mass in masses.tolist()]})
    _, page = page_of(tmp_path / "b.html", unlike)
    assert page.problems == [] and "The other 30 links are not shown." in page.text
