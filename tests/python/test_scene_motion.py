# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes and motions asked for in scene files: what is read, what is found, what the commands print and write."""

import csv
import io
import json

import numpy as np
import pytest

import revchain as rc
from revchain.cli import app as _cli

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
angular_speed = ["20 rpm", "120 rpm"]
steps = 30
"""
SWING = """
[[links]]
mass = 0.5
length = 0.5
repeat = 2
[ask.swing]
offset = ["2 cm", 0]
until = "5 s"
steps = 50
"""


@pytest.fixture
def run(capsys):
    def call(*arguments):
        code = _cli.run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return call


def test_what_a_scene_asks_is_what_the_functions_give():
    chain = rc.Chain(weight=[0.5 * 9.80665] * 2, length=0.5)
    shapes = scene({"links": LINKS}, shapes={"conical_height": "5 cm"}).steady_shapes()
    direct = rc.steady_shapes(chain, conical_height=0.05)
    assert shapes.complete and len(shapes) == len(direct) == 2
    assert all(np.array_equal(one.inclination, two.inclination) for one, two in zip(shapes, direct, strict=True))
    anyhow = scene({"links": LINKS}, shapes={"conical_height": 0.05, "any_posture": True}).steady_shapes()
    assert len(anyhow) == len(rc.steady_shapes(chain, conical_height=0.05, hanging_only=False)) == 4

    driven = scene(CAROUSEL, response={"angular_speed": ["6 rpm", 3.0], "steps": 7}).response()
    rig = rc.Rig(rc.Chain(weight=80 * 9.80665, length=4.0), support_radius=2.0)
    assert driven == rc.response(rig, angular_speed=np.linspace(0.2 * np.pi, 3.0, 7))
    assert driven.support_radius == 2.0

    swing = scene({"links": LINKS}, swing={"offset": ["2 cm", 0], "velocity": [0, "1 cm/s"], "until": 2, "steps": 4})
    times = np.linspace(0, 2, 5)
    assert swing.small_oscillation() == rc.small_oscillation(chain, [0.02, 0.0], [0.0, 0.01], times)


def test_both_ends_held():
    shapes = scene(BLADE, shapes={"angular_speed": "120 rpm", "half_waves": 3}).steady_shapes()
    chain = rc.Chain.uniform_rods(40, length=3.0, weight=12.0 * 9.80665)
    direct = rc.held_shapes(chain, span=2.4, angular_speed=4 * np.pi, most_half_waves=3)
    assert [shape.half_waves for shape in shapes] == [1, 2, 3]
    assert all(np.array_equal(one.offset, two.offset) for one, two in zip(shapes, direct, strict=True))
    light = scene({**BLADE, "held": {"span": 2.4, "weightless": True}}, shapes={"angular_speed": 10.0}).steady_shapes()
    rope = rc.SkippingRope(span=2.4, length=3.0, angular_speed=10.0)
    assert light[0].offset.max() == pytest.approx(rope.sag, rel=2e-3)  # 40 links: second order
    per_metre = 12.0 / 3.0 * 9.80665  # its tensions are lengths of rope that weigh as much
    assert light[0].tension[0] == pytest.approx(rope.tension_at_ends * per_metre, rel=5e-3)
    straight = {**BLADE, "held": {"tension": "500 N"}}
    assert np.array_equal(
        scene(straight, modes=3).modes().conical_height, rc.taut_modes(chain, tension=500.0, count=3).conical_height
    )


@pytest.mark.parametrize(
    ("base", "ask", "key", "words"),
    [
        ({"links": LINKS}, {"shapes": {}}, "ask.shapes", "either angular_speed or conical_height"),
        ({"links": LINKS}, {"shapes": {"angular_speed": "3 kg"}}, "ask.shapes.angular_speed", "an angular speed"),
        ({"links": LINKS}, {"shapes": {"angular_speed": 1.0, "sense": 2}}, "ask.shapes.sense", "2"),
        ({"links": LINKS}, {"response": {"angular_speed": [1, 2, 3]}}, "ask.response.angular_speed", "2"),
        ({"links": LINKS}, {"response": {"conical_height": ["2 s"]}}, "ask.response.conical_height", "a length"),
        ({"links": LINKS}, {"swing": {"offset": [0.1]}}, "ask.swing.offset", "each of the 2 pins"),
        ({"links": LINKS}, {"swing": {"offset": [0.1, "3 s"]}}, "ask.swing.offset[1]", "a length"),
        ({"links": LINKS}, {"swing": {"offset": [0.1, 0], "until": "2 m"}}, "ask.swing.until", "a time"),
        ({**BLADE, "held": {}}, {}, "held", "either span or tension"),
        ({**BLADE, "held": {"span": 3.0}}, {}, "held.span", "less than the length"),
        ({**BLADE, "held": {"tension": 3.0, "weightless": True}}, {}, "held.weightless", "goes with span"),
        ({**BLADE, "support": {"radius": 1}}, {}, "held", "does not go with"),
        (BLADE, {"first": 2}, "ask.first", "held at both ends give modes, got 2"),
        (BLADE, {"rtol": 1e-3}, "ask.rtol", "held at both ends give modes, got 0.001"),
        (BLADE, {"rtol": np.inf}, "ask.rtol", "got inf"),
        (BLADE, {"conical_height": [0, "2 m"]}, "ask.conical_height", 'got [0.0,"2 m"]'),
        (BLADE, {"angular_speed": [1, 2]}, "ask.angular_speed", "got [1.0,2.0]"),
        (BLADE, {"certify": True}, "ask.certify", "got true"),
        (BLADE, {"precision": "single"}, "ask.precision", 'got "single"'),
        (BLADE, {"method": "dense"}, "ask.method", 'got "dense"'),
        (BLADE, {"shapes": {"angular_speed": 1, "sense": -1}}, "ask.shapes.sense", "a chain that hangs, got -1"),
        (BLADE, {"shapes": {"angular_speed": 1, "any_posture": True}}, "ask.shapes.any_posture", "hangs, got true"),
    ],
)
def test_refused_when_read(base, ask, key, words):
    with pytest.raises(rc.SceneError, match="scene: ") as caught:
        scene(base, **ask)
    assert caught.value.key == key and words in str(caught.value)


@pytest.mark.parametrize(
    ("base", "method", "words"),
    [
        ({"links": LINKS}, "steady_shapes", "ask.shapes: is missing"),
        ({"links": LINKS}, "response", "ask.response: is missing"),
        ({"links": LINKS}, "small_oscillation", "ask.swing: is missing"),
        (CAROUSEL, "small_oscillation", "hangs from a firm point"),
        (BLADE, "response", "no response is known"),
        (BLADE, "modes", "leaves the chain slack"),
        ({**BLADE, "held": {"tension": 5.0}}, "steady_shapes", "ask.shapes: is missing"),
    ],
)
def test_refused_when_asked(base, method, words):
    with pytest.raises(rc.SceneError, match=words):
        getattr(scene(base), method)()


def test_half_waves_are_of_chains_held_at_both_ends():
    with pytest.raises(rc.SceneError, match="ask.shapes: half_waves is for a chain held at both ends"):
        scene({"links": LINKS}, shapes={"angular_speed": 3.0}).steady_shapes(half_waves=2)


@pytest.mark.parametrize("ask", [rc.solve, rc.explain, lambda held: held.asked(held.chain())])
def test_models_are_not_of_chains_held_at_both_ends(ask):
    """Nor is the answer that of the chain let go."""
    with pytest.raises(rc.SceneError, match="held: is for shapes and modes"):
        ask(scene({**BLADE, "held": {"tension": "500 N"}}))


def test_the_commands(run, tmp_path):
    path = write(tmp_path, TOML)
    code, out, err = run("shapes", path, "--plot", tmp_path / "shapes.png")
    assert (code, err) == (0, "") and "proved complete" in out and out.count("2.2e-16") == 5
    assert (tmp_path / "shapes.png").stat().st_size > 5000
    code, out, _ = run("shapes", path, "--json", "-")
    data = json.loads(out)
    found = rc.load_scene(path).steady_shapes()
    assert code == 0 and data["complete"] is True and data["title"] == "Two nuts"
    assert [row["inclination"] for row in data["shapes"]] == [shape.inclination.tolist() for shape in found]
    code, out, _ = run("shapes", path, "--csv", "-", "--angular-speed", "5.0")
    rows = list(csv.DictReader(io.StringIO(out)))
    again = rc.load_scene(path).steady_shapes(angular_speed=5.0)
    assert code == 0 and [float(row["top_tension"]) for row in rows] == [float(shape.tension[-1]) for shape in again]
    assert [[float(x) for x in row["offset"].split()] for row in rows] == [shape.offset.tolist() for shape in again]

    code, out, _ = run("response", path, "--plot", tmp_path / "response.svg", "--csv", tmp_path / "response.csv")
    driven = rc.load_scene(path).response()
    rows = list(csv.DictReader(io.StringIO((tmp_path / "response.csv").read_text())))
    assert code == 0 and "and 10 more" in out and len(rows) == 30
    assert [float(row["free_end_offset"]) for row in rows] == driven.offset[:, 0].tolist()
    assert run("response", path, "--conical-height", 0.1, 0.2, "--steps", 4, "--csv", "-")[1].count("\n") == 5

    path = write(tmp_path, SWING)
    code, out, _ = run("swing", path, "--json", "-")
    data = json.loads(out)
    assert code == 0 and len(data["times"]) == 51
    assert data["times"][7]["offset"] == rc.load_scene(path).small_oscillation().offset[7].tolist()
    code, out, _ = run("swing", path, "--modes", 1, "--steps", 10, "--plot", tmp_path / "swing.png")
    assert code == 0 and "1 modes" in out and (tmp_path / "swing.png").exists()


def test_tables_are_never_cut(run, tmp_path):
    for command, text in (("shapes", TOML), ("response", TOML), ("swing", SWING)):
        code, out, _ = run(command, write(tmp_path, text))
        assert code == 0 and "…" not in out
        assert max(map(len, out.splitlines())) <= 80


def test_held_scenes_by_command(run, tmp_path):
    blade = '[uniform_chain]\nkind = "rods"\ncount = 40\nlength = 3.0\nmass = 12.0\n[held]\n'
    path = write(tmp_path, blade + "span = 2.4\n")
    code, out, _ = run("shapes", path, "--angular-speed", 12.5, "--half-waves", 2, "--plot", tmp_path / "blade.png")
    assert code == 0 and "between two points of the axis" in out
    code, _, err = run("solve", path)
    assert code == 2 and err == (
        f"revchain: {path}: ask.shapes: is missing: say at which angular_speed or conical_height\n"
    )
    code, _, err = run("shapes", path, "--angular-speed", 2.0)  # too slow: it folds along the axis
    assert code == 1 and "not proved" in err
    path = write(tmp_path, blade + 'tension = "500 N"\n')
    code, out, _ = run("solve", path, "--plot", tmp_path / "taut.png", "--json", tmp_path / "taut.json")
    assert code == 0 and "12.3620" in out and (tmp_path / "taut.png").exists()
    assert len(json.loads((tmp_path / "taut.json").read_text())["modes"]) == 10
    assert run("solve", path, "--certify")[0] == 2 and run("validate", path)[0] == 0


def test_wrong_options(run, tmp_path):
    path = write(tmp_path, TOML)
    assert run("shapes", path, "--angular-speed", 1, "--conical-height", 1)[0] == 2
    assert run("response", path, "--angular-speed", 1, 2, "--conical-height", 1, 2)[0] == 2
    code, _, err = run("shapes", path, "--sense", 3)
    assert code == 2 and "sense must be 1 or -1, got 3" in err
    code, _, err = run("response", path, "--angular-speed", -1, 2)
    assert code == 2 and "angular_speed must be positive" in err
    code, _, err = run("swing", path)
    assert code == 2 and f"{path}: ask.swing: is for a chain" in err
    code, _, err = run("swing", write(tmp_path, SWING), "--until", "nan")
    assert code == 2 and "finite" in err
    code, _, err = run("swing", write(tmp_path, SWING), "--until", -1)
    assert code == 2 and "until must be positive" in err and "-1" in err
    assert run("shapes", path, "--plot", tmp_path / "x.txt")[0] == 2
    assert sorted(p.name for p in tmp_path.iterdir()) == ["scene.toml"]


def test_the_new_scene_with_everything_said(run, tmp_path):
    """Every commented line of the new scene is a line that can stand there."""
    assert run("new", tmp_path / "new.toml")[0] == 0
    text, mark, held = (tmp_path / "new.toml").read_text().partition("# ---- a chain held at both ends")
    plain, ask_mark, ask = text.partition("# ---- what else can be asked")
    assert mark and ask_mark

    def uncommented(part):
        return "\n".join(line.removeprefix("# ") for line in part.splitlines()[1:] if line != "#")

    (tmp_path / "all.toml").write_text(plain + uncommented(ask))
    read = rc.load_scene(tmp_path / "all.toml")
    assert len(read.response().angular_speed) == 200 and len(read.small_oscillation().time) == 201
    assert run("shapes", tmp_path / "all.toml", "--quiet")[0] == 0
    for left_out in ("span", "tension"):
        lines = [line for line in uncommented(held).splitlines() if not line.startswith((left_out, "weightless"))]
        (tmp_path / "held.toml").write_text(plain + "\n".join(lines))
        assert rc.load_scene(tmp_path / "held.toml").is_held
