# SPDX-License-Identifier: GPL-3.0-or-later
"""Governors and Campbell diagrams in scene files and on the command line; mistakes in test_scene_errors.py, studies in
test_study_points.py, numbers to 40 digits in test_examples.py."""

import json
from pathlib import Path

import numpy as np
import pytest

import revchain as rc

pytest.importorskip("typer")

SCENES = Path(__file__).resolve().parents[2] / "examples" / "scenes"
PORTER, CHAIR = SCENES / "porter_governor.toml", SCENES / "chair_o_plane.toml"
HARTNELL = {
    "ball_mass": "1.5 kg", "arm": "12 cm", "balls": 3, "pivot_offset": "12 cm", "sleeve_arm": "6 cm", "sleeve_mass": 2.0,
    "spring_stiffness": "5 kN/m", "spring_force": "150 N", "friction": "5 N", "shaft_inertia": "0.4 kg m^2",
    "lowest_inclination": -0.2, "highest_inclination": 0.3,
}  # fmt: skip


@pytest.fixture(autouse=True)
def empty_folder(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)


def test_every_number_of_a_governor():
    scene = rc.Scene.from_dict({"governor": HARTNELL, "gravity": 9.81, "ask": {"equilibria": {"angular_speed": "145 rpm"}}})
    given = {
        "ball_mass": 1.5, "arm": 0.12, "balls": 3, "pivot_offset": 0.12, "sleeve_arm": 0.06, "sleeve_mass": 2.0, "gravity": 9.81,
        "spring_stiffness": 5000.0, "spring_force": 150.0, "friction": 5.0, "shaft_inertia": 0.4, "lowest_inclination": -0.2,
        "highest_inclination": 0.3,
    }  # fmt: skip
    governor = rc.SleeveGovernor(**given)
    assert scene.system() == governor and scene.gravity_value() == 9.81
    assert scene.equilibria() == governor.equilibria("145 rpm") and scene.answers().keys() == {"equilibria"}
    assert scene.equilibria(angular_speed=15.0) == governor.equilibria(15.0)
    assert rc.Scene.from_dict(scene.to_dict()) == scene
    links = {"lower_arm": "20 cm", "joint": "10 cm", "sleeve_offset": "3 cm"}
    porter = rc.Scene.from_dict({"governor": {"ball_mass": 1.0, "arm": 0.2, **links}})
    assert porter.system() == rc.SleeveGovernor(ball_mass=1.0, arm=0.2, lower_arm=0.2, joint=0.1, sleeve_offset=0.03)
    assert porter._questions == ("equilibria",) and porter.equilibria() == porter.system()
    assert not porter.asks and list(porter.answers()) == ["equilibria"]


@pytest.mark.parametrize("question", ["modes", "steady_shapes", "response", "swing", "branches", "campbell"])
def test_a_governor_has_one_question(question):
    with pytest.raises(rc.SceneError, match=r"does not go with \[governor\]: write \[ask.equilibria\]"):
        getattr(rc.load_scene(PORTER), question)()


def test_a_chain_has_no_equilibria():
    with pytest.raises(rc.SceneError, match="does not go with a chain or cord"):
        rc.load_scene(CHAIR).equilibria(angular_speed=3.0)


def test_equilibria_on_the_command_line(run):
    code, out, err = run("equilibria", PORTER, "--angular-speed", "128 rpm", "--json", "e.json", "--csv", "e.csv", "--plot", "e.svg")
    assert (code, err) == (0, "") and "2 equilibria at 128.000 rpm (13.4041 rad/s), proved complete" in out
    assert "SleeveGovernor: lift 0.05752 m" in out and "governor: 2 balls of 2.3 kg on arms of 0.33 m" in out
    written, found = json.loads(Path("e.json").read_text()), rc.load_scene(PORTER).equilibria(angular_speed="128 rpm")
    assert [point["inclination"] for point in written["points"]] == found.inclination.tolist()
    assert written["governor"]["sleeve_mass"] == 9.5 and written["angular_speed"] == found.angular_speed
    assert len(Path("e.csv").read_text().splitlines()) == 3 and Path("e.svg").stat().st_size > 5000
    code, out, err = run("equilibria", PORTER, "--gravity", "1.62")
    slow = rc.Scene.from_dict(rc.load_scene(PORTER).to_dict() | {"gravity": 1.62}).equilibria()
    assert (code, err) == (0, "") and f"{np.degrees(slow[-1].inclination):.3f}" in out
    code, out, err = run("equilibria", PORTER, "--angular-speed", "-3")
    assert code == 2 and err == f"revchain: {PORTER}: --angular-speed: must not be negative, got -3\n"


def test_a_governor_that_is_asked_nothing(run):
    Path("watt.toml").write_text("[governor]\nball_mass = 4\narm = 1.4\nlower_arm = 1.4\nsleeve_mass = 3\n")
    assert "asks nothing, so its equilibria" in run("validate", "watt.toml")[1]
    code, out, err = run("run", "watt.toml")
    assert (code, err) == (0, "") and "speed (rad/s)" in " ".join(out.split()) or "(rad/s)" in out
    assert {path.name for path in Path("out/watt").iterdir()} == {f"equilibria{kind}" for kind in (".txt", ".json", ".csv", ".png")}
    assert len(json.loads(Path("out/watt/equilibria.json").read_text())["points"]) == 9


def test_questions_without_an_answer(run):
    Path("cord.toml").write_text("[cord]\nlength = 1\nmass = 1\n")
    Path("chain.toml").write_text("[[links]]\nmass = 1\nlength = 1\n")
    Path("held.toml").write_text('[[links]]\nmass = 1\nlength = 1\nrepeat = 3\n[held]\ntension = "50 N"\n')
    speeds = ("--angular-speed", "5; 6")
    for arguments, words in (
        (("modes", PORTER), f"modes: no answer for a governor; ask for its equilibria: revchain equilibria {PORTER}"),
        (("campbell", PORTER, *speeds), "campbell: no answer for a governor; ask for its equilibria"),
        (("explain", PORTER), "explain: no answer for a governor"),
        (("animate", PORTER, "-o", "a.html"), "modes: no answer for a governor"),
        (("animate", CHAIR, "-o", "a.html", "--ask", "campbell"), "--ask: must be one of modes, shapes, response, swing, branches, got campbell"),
        (("equilibria", "chain.toml"), "equilibria: no answer for a chain; ask for its modes: revchain modes chain.toml"),
        (("campbell", "cord.toml", *speeds), "campbell: no answer for a cord; cut it into links"),
        (("campbell", "held.toml", *speeds), "campbell: no answer for a chain or cord held at both ends; ask for its modes"),
        (("campbell", "chain.toml"), "--angular-speed: is missing: write --angular-speed \"1 rpm to 20 rpm in 39\""),
        (("campbell", "chain.toml", *speeds, "--half-waves", "3"), "is there a shape with this number of half_waves, got 3"),
    ):
        code, out, err = run(*arguments)
        assert code == 2 and out == "" and words in err, err
        assert err.startswith("revchain: ") and err.count("\n") == 1


def test_campbell_on_the_command_line(run):
    given = ("--angular-speed", "1 rpm to 15 rpm in 8", "--orders", "3; 1", "--frame", "driven")
    code, out, err = run("campbell", CHAIR, *given, "--json", "c.json", "--plot", "c.svg")
    scene = rc.load_scene(CHAIR)
    found = rc.campbell(scene.system(), np.linspace(1, 15, 8) * (np.pi / 30), orders=[3, 1], frame="driven")
    assert (code, err) == (0, "") and "Campbell diagram: " in out and found.crossings
    for one in found.crossings:
        assert f"{one.order}n meets frequency {one.motion} at {one.rpm:.5g} rpm" in out
    written = json.loads(Path("c.json").read_text())
    assert len(written["speeds"]) == 8 and written["orders"] == [3, 1] and written["frame"] == "driven"
    assert [row["angular_speed"] for row in written["crossings"]] == pytest.approx([one.angular_speed for one in found.crossings], rel=1e-13)
    assert [row["rpm"] for row in written["crossings"]] == pytest.approx([one.rpm for one in found.crossings], rel=1e-13)
    assert Path("c.svg").stat().st_size > 5000
