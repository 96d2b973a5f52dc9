# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes and motions asked for in scene files: what is read, what is found, what the commands print and write."""

import csv
import io
import json
import re

import numpy as np
import pytest

import revchain as rc

LINKS = [{"mass": 0.5, "length": 0.5, "repeat": 2}]
CAROUSEL = {"links": [{"mass": 80, "length": 4.0}], "support": {"radius": 2.0}}
BLADE = {"uniform_chain": {"kind": "rods", "count": 40, "length": 3.0, "mass": 12.0}, "held": {"span": 2.4}}


def scene(base, **ask):
    return rc.Scene.from_dict({**base, "ask": ask})


def write(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text, encoding="utf-8")
    return path


TOML = """
title = "Two nuts"
[[links]]
mass = 0.5
length = 0.5
repeat = 2
[support]
radius = "5 mm"
[ask.shapes]
conical_height = 0.05
[ask.response]
angular_speed = {from = "20 rpm", to = "120 rpm", steps = 30}
"""
SWING = """
[[links]]
mass = 0.5
length = 0.5
repeat = 2
[ask.swing]
offset = ["2 cm", 0]
time = {to = "5 s", steps = 51}
"""


def test_what_a_scene_asks_is_what_the_functions_give():
    chain = rc.Chain(mass=[0.5] * 2, length=0.5)
    shapes = scene({"links": LINKS}, shapes={"conical_height": "5 cm"}).steady_shapes()
    assert shapes == rc.steady_shapes(chain, conical_height=0.05) and shapes.complete and len(shapes) == 2
    anyhow = scene({"links": LINKS}, shapes={"conical_height": 0.05, "hanging_only": False}).steady_shapes()
    assert anyhow == rc.steady_shapes(chain, conical_height=0.05, hanging_only=False) and len(anyhow) == 4

    rig = rc.Rig(rc.Chain(mass=[80], length=4.0), support=rc.Support(radius=2.0))
    for given, speeds in (
        ({"from": "6 rpm", "to": 3.0, "steps": 7}, np.linspace(0.2 * np.pi, 3.0, 7)),
        ({"from": 1, "to": 4, "steps": 3, "log": True}, np.array([1.0, 2.0, 4.0])),
        (["6 rpm", 3.0], np.array([0.2 * np.pi, 3.0])),
        ("60 rpm", 2 * np.pi),
    ):
        driven = scene(CAROUSEL, response={"angular_speed": given}).response()
        np.testing.assert_allclose(driven.angular_speed, speeds, rtol=1e-15)
        assert driven == rc.response(rig, angular_speed=driven.angular_speed) and driven.support_radius == 2.0
    assert scene(CAROUSEL).response(angular_speed=np.ones(3), support_radius="1 cm").support_radius == 0.01

    swing = scene({"links": LINKS}, swing={"offset": ["2 cm", 0], "velocity": [0, "1 cm/s"], "time": {"to": 2, "steps": 5}})
    assert swing.swing() == rc.swing(chain, np.linspace(0, 2, 5), offset=[0.02, 0.0], velocity=[0.0, 0.01])
    assert swing.swing(count=1, time=3.0) == rc.swing(chain, 3.0, offset=[0.02, 0.0], velocity=[0.0, 0.01], count=1)
    diagram = scene({"links": LINKS}, branches={"max_angular_speed": "120 rpm"}).branches()
    assert diagram == rc.branches(chain, max_angular_speed=4 * np.pi) and len(diagram) == 2


def test_both_ends_held():
    shapes = scene(BLADE, shapes={"angular_speed": "120 rpm", "max_half_waves": 3}).steady_shapes()
    chain = rc.Chain.uniform_rods(40, length=3.0, mass=12.0)
    direct = rc.steady_shapes(rc.Held(chain, span=2.4), angular_speed=4 * np.pi, max_half_waves=3)
    assert [shape.half_waves for shape in shapes] == [1, 2, 3] and shapes == direct
    light = scene({**BLADE, "held": {"span": 2.4, "weightless": True}}, shapes={"angular_speed": 10.0}).steady_shapes()
    rope = rc.SkippingRope(span=2.4, length=3.0, angular_speed=10.0)
    assert light[0].offset.max() == pytest.approx(rope.sag, rel=2e-3)  # 40 links: second order
    per_metre = 12.0 / 3.0 * 9.80665  # its tensions are lengths of rope that weigh as much
    assert light[0].tension[0] == pytest.approx(rope.tension_at_ends * per_metre, rel=5e-3)
    straight = {**BLADE, "held": {"tension": "500 N"}}
    assert scene(straight, modes={"count": 3}).modes() == rc.modes(rc.Held(chain, tension=500.0), 3)


@pytest.mark.parametrize(
    ("base", "method", "given", "words"),
    [
        ({"links": LINKS}, "steady_shapes", {}, "ask.shapes: give angular_speed or conical_height"),
        ({"links": LINKS}, "response", {}, "ask.response: give angular_speed or conical_height"),
        ({"links": LINKS}, "swing", {}, "ask.swing: give offset, velocity or support_time"),
        ({"links": LINKS}, "branches", {}, "ask.branches: give max_angular_speed or min_conical_height"),
        (BLADE, "modes", {}, "held at a span is bent"),
        (BLADE, "response", {"angular_speed": 3.0}, "is not available for a"),
        ({**BLADE, "held": {"tension": 5.0}}, "steady_shapes", {}, "ask.shapes: give angular_speed"),
        (CAROUSEL, "swing", {"offset": [0.1]}, "carried round: it does not let the rig swing; use response"),
    ],
)
def test_refused_when_asked(base, method, given, words):
    with pytest.raises(ValueError, match=words):
        getattr(scene(base), method)(**given)


LINK = "[[links]]\nmass = 1\nlength = 0.5\nrepeat = 3\n"
CORD = "[cord]\nlength = 1\nmass = 1\n"
KINDS = {  # what hangs, and the questions it has no answer for
    "chain": (LINK, ""),
    "rig": (LINK + "[support]\nstiffness = 50\n", ""),
    "cord": (CORD, "response"),
    "bent chain": (LINK + "[held]\nspan = 1\n", "run modes explain response swing"),
    "bent cord": (CORD + "[held]\nspan = 0.8\n", "run modes explain response swing"),
    "taut chain": (LINK + "[held]\ntension = 100\n", "response swing branches"),
    "taut chain without gravity": (LINK + "[held]\ntension = 100\nweightless = true\n", "response swing branches"),
    "taut cord": (CORD + "[held]\ntension = 100\n", "response swing branches"),
}
OPTIONS = {"run": (), "modes": (), "explain": (), "shapes": ("--angular-speed", 9), "response": ("--angular-speed", 5)}
OPTIONS |= {"swing": ("--offset", "1 cm; 0; 0"), "branches": ("--max-angular-speed", 5)}


@pytest.mark.parametrize(("text", "unanswered"), KINDS.values(), ids=KINDS.keys())
def test_questions_without_an_answer_say_what_to_run(run, tmp_path, text, unanswered):
    path = write(tmp_path, text)
    for command, options in OPTIONS.items():
        if command == "swing" and "[support]" in text:  # which moves, too
            options = ("--offset", "1 cm; 0; 0; 0")
        out = ("--out", tmp_path / "out") if command == "run" else ("--quiet",)
        code, _, err = run(command, path, *options, *out)
        if command not in unanswered.split():
            assert code in (0, 1) and "no answer" not in err  # 1: not proved
            continue
        question = command.replace("run", "modes")
        assert code == 2 and err.startswith(f"revchain: {path}: {question}: no answer for a c")
        assert "; ask for its " in err and ": revchain " in err or "; cut it into links: [tapered_chain]" in err
        assert not re.search(r"rc\.|Held|Rig|Cord|steady_shapes|\.chain\(|None", err.replace(str(path), ""))
    assert run("validate", path)[1].count("no answer") == ("run" in unanswered)


def test_the_commands(run, tmp_path):
    path = write(tmp_path, TOML)
    code, out, err = run("shapes", path, "--plot", tmp_path / "shapes.png")
    assert (code, err) == (0, "") and "proved complete" in out and out.count("2.2e-16") == 5
    assert out.endswith(f"the scene also asks: response; for all of it: revchain run {path}\n")
    assert (tmp_path / "shapes.png").stat().st_size > 5000
    code, out, _ = run("shapes", path, "--json", "-")
    data = json.loads(out)
    found = rc.load_scene(path).steady_shapes()
    assert code == 0 and data["complete"] is True and data["title"] == "Two nuts"
    assert rc.Rig.from_dict(data["system"]) == found.system
    assert data["description"].startswith("support: firm, carried round at 0.005 m; 2 times 0.5 kg on 0.5 m")
    assert [row["inclination"] for row in data["shapes"]] == [shape.inclination.tolist() for shape in found]
    code, out, _ = run("shapes", path, "--csv", "-", "--angular-speed", "5.0", "--gravity", "1.62 m/s^2")
    rows = list(csv.DictReader(io.StringIO(out)))
    again = rc.Scene.from_dict({**rc.load_scene(path).to_dict(), "gravity": 1.62}).steady_shapes(angular_speed=5.0)
    assert code == 0 and [float(row["top_tension"]) for row in rows] == [float(shape.tension[-1]) for shape in again]
    assert [float(row["lowest_inclination"]) for row in rows] == [shape.inclination[0] for shape in again]  # rad

    code, out, _ = run("response", path, "--plot", tmp_path / "response.svg", "--csv", tmp_path / "response.csv")
    driven = rc.load_scene(path).response()
    rows = list(csv.DictReader(io.StringIO((tmp_path / "response.csv").read_text())))
    assert code == 0 and "and 10 more" in out and len(rows) == 30
    assert [float(row["free_end_offset"]) for row in rows] == driven.offset[:, 0].tolist()
    for heights, lines in (("10 cm to 20 cm in 4", 5), ("10 cm to 0.2", 201), ("0.1; 20 cm; 3", 4), ("20 cm", 2)):
        assert run("response", path, "--conical-height", heights, "--csv", "-")[1].count("\n") == lines

    path = write(tmp_path, SWING)
    code, out, _ = run("swing", path, "--json", "-")
    data = json.loads(out)
    assert code == 0 and len(data["times"]) == 51
    assert data["times"][7]["offset"] == rc.load_scene(path).swing().offset[7].tolist()
    offsets = ("--offset", "1 cm; 0", "--velocity", "0; 2", "--count", 1, "--time", "0 to 2 in 11")
    code, out, _ = run("swing", path, *offsets, "--plot", tmp_path / "swing.png")
    assert code == 0 and "1 mode;" in out and (tmp_path / "swing.png").exists()
    code, out, _ = run("branches", path, "--max-angular-speed", "90 rpm", "--plot", tmp_path / "branches.png")
    assert code == 0 and "proved complete" in out and (tmp_path / "branches.png").exists()


def test_angles_in_tables_are_in_the_unit_asked_for(run, tmp_path):
    path, shapes = write(tmp_path, TOML), rc.load_scene(write(tmp_path, TOML)).steady_shapes()
    lowest = shapes[0].inclination[0]
    out, rad = run("shapes", path)[1], run("shapes", path, "--units", "rad")[1]
    assert "(°)" in out and f"{np.degrees(lowest):#.5g}" in out and "(°)" not in rad and f"{lowest:#.5g}" in rad


def test_tables_are_never_cut(run, tmp_path):
    for command, text in (("shapes", TOML), ("response", TOML), ("swing", SWING)):
        code, out, _ = run(command, write(tmp_path, text))
        assert code == 0 and "…" not in out
        assert max(len(line) for line in out.splitlines() if not line.startswith("the scene also")) <= 80


def test_held_scenes_by_command(run, tmp_path):
    blade = '[uniform_chain]\nkind = "rods"\ncount = 40\nlength = 3.0\nmass = 12.0\n[held]\n'
    path = write(tmp_path, blade + "span = 2.4\n")
    code, out, _ = run("shapes", path, "--angular-speed", 12.5, "--max-half-waves", 2, "--plot", tmp_path / "blade.png")
    assert code == 0 and "both ends held on the axis, 2.4 m apart" in out
    code, _, err = run("run", path, "--out", tmp_path / "out")
    assert code == 2 and "modes: no answer for a chain or cord whose ends are held a span apart; ask for its shapes: revchain shapes" in err
    code, _, err = run("shapes", path, "--angular-speed", 2.0)  # too slow: it folds along the axis
    assert code == 1 and "no shape was found with 1 half wave" in err
    path = write(tmp_path, blade + 'tension = "617.6798 N"\n')
    code, out, _ = run("modes", path, "--plot", tmp_path / "taut.png", "--json", tmp_path / "taut.json")
    assert code == 0 and "12.3620" in out and (tmp_path / "taut.png").exists()
    assert len(json.loads((tmp_path / "taut.json").read_text())["modes"]) == 10
    assert run("modes", path, "--certify")[0] == 2 and run("validate", path)[0] == 0


def test_count_and_first_take_the_place_of_the_scenes(run, tmp_path):
    path = write(tmp_path, LINK + "[ask.modes]\ncount = 2\n")
    assert len(json.loads(run("modes", path, "--json", "-")[1])["modes"]) == 2
    assert [mode["mode"] for mode in json.loads(run("modes", path, "--first", 2, "--json", "-")[1])["modes"]] == [2, 3]
    for command, named in (("modes", 4), ("explain", 2)):
        assert " ".join(run(command, "--help")[1].replace("│", "").split()).count("of the scene do not apply") == named


def test_the_new_scene_with_everything_said(run, tmp_path):
    """Every commented line of the new scene is a line that can stand there."""
    assert run("new", tmp_path / "new.toml")[0] == 0
    everything, mark, governor = (tmp_path / "new.toml").read_text().partition("# ---- a centrifugal governor")
    assert mark
    text, mark, held = everything.partition("# ---- a chain held at both ends")
    plain, ask_mark, ask = text.partition("# ---- other questions")
    assert mark and ask_mark

    def uncommented(part):
        return "\n".join(line.removeprefix("# ") for line in part.splitlines()[1:] if line != "#")

    (tmp_path / "all.toml").write_text(plain + uncommented(ask))
    read = rc.load_scene(tmp_path / "all.toml")
    assert read.asks == ("modes", "shapes", "response", "swing", "branches", "campbell")
    assert len(read.response().angular_speed) == 200 and len(read.swing().time) == 201
    assert run("shapes", tmp_path / "all.toml", "--quiet")[0] == 0
    for left_out in ("span", "tension"):
        lines = [line for line in uncommented(held).splitlines() if not line.startswith((left_out, "weightless"))]
        (tmp_path / "held.toml").write_text(plain + "\n".join(lines))
        assert rc.load_scene(tmp_path / "held.toml").is_held
    (tmp_path / "governor.toml").write_text(uncommented(governor))
    assert len(rc.load_scene(tmp_path / "governor.toml").equilibria()) == 2
