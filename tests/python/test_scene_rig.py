# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files of rigs: supports, standing links, flywheels, fluids; solved from the command line and kept in files."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

import revchain as rc
from revchain.scenes.scene import Scene

G = 9.80665
ROD = {"mass": 1.0, "length": 1.5, "kind": "rod"}
WHEEL = {"mass": 1.5, "radius_of_gyration": 0.29, "spin": "300 rpm"}


def at(speed):
    """What is asked: where the pins are while the support is carried round."""
    return {"response": {"angular_speed": [speed]}}


def scene(*links, **entries):
    return Scene.from_dict({"links": list(links) or [dict(ROD)], **entries})


def test_a_scene_says_what_a_rig_is():
    given = scene(
        {**ROD, "flywheel": WHEEL, "repeat": 2},
        {"weight": 3.0, "length": 0.4, "standing": True},
        {**ROD, "displaced": {"mass": 0.5, "added_mass": 0.25, "centroid": 0.7}},
        {"mass": 1.0, "length": 1.0, "flywheel": {**WHEEL, "spin": -2.0, "driven": True}},
        support={"stiffness": "2 kN/m", "mass": 0.2, "radius": "10 cm"},
        fluid="still",
        gravity=10.0,
    )
    rig = given.rig()
    assert given.is_rigged
    assert rig.chain == given.chain()
    assert (rig.stiffness, rig.support_radius) == (2000.0, 0.1)
    assert rig.carriage_weight == pytest.approx(2.0, rel=1e-15)
    momentum = 1.5 * 0.29**2 * 300 * 2 * np.pi / 60
    assert rig.momentum == pytest.approx([momentum, momentum, 0, 0, -2 * 1.5 * 0.29**2], rel=1e-14)
    assert rig.axial_moment == pytest.approx([0, 0, 0, 0, 15 * 0.29**2], rel=1e-14)
    assert rig.standing.tolist() == [False, False, True, False, False]
    assert rig.displaced_weight.tolist() == [0, 0, 0, 5.0, 0]
    assert rig.added_weight.tolist() == [0, 0, 0, 2.5, 0]
    assert rig.displaced_centroid.tolist() == [0.75, 0.75, 0.4, 0.7, 1.0]


def test_a_scene_without_any_of_it_is_a_chain():
    given = scene()
    assert not given.is_rigged
    assert isinstance(given.modes(), rc.Modes)
    assert given.rig() == rc.Rig(given.chain())


def test_modes_of_a_scene_are_those_of_its_rig():
    support = {"stiffness": 50.0, "mass": 0.2}
    given = scene({**ROD, "flywheel": WHEEL, "repeat": 30}, support=support, ask={"modes": 4, "first": 2})
    found = given.modes()
    assert isinstance(found, rc.RigModes)
    same = rc.modes(given.rig(), count=4, first=2, gravity=G)
    assert np.array_equal(found.conical_height, same.conical_height)
    assert list(np.sort(found.number)) == [2, 2, 3, 3, 4, 4, 5, 5] and found.direction.sum() == 0
    assert len(scene(ROD, support=support, ask={"modes": "all"}).modes()) == 2
    assert len(scene(ROD, support=support).modes()) == 2
    assert len(scene({**ROD, "repeat": 20}, support=support).modes()) == 10


def test_weights_at_pins_and_clamped_links():
    tipped = scene({**ROD, "tip_mass": 0.5}, {**ROD, "tip_weight": 2.0}, ROD, gravity=10.0)
    rods = rc.Chain(weight=10.0, length=[1.5] * 3, centroid=0.75, radius_of_gyration=1.5 / 12**0.5)
    assert not tipped.is_rigged
    assert tipped.chain() == rods.with_weight(2.0, pin=1).with_weight(5.0)
    whole = {"uniform_chain": {"kind": "rods", "count": 3, "length": 4.5, "weight": 30.0, "tip_weight": 5.0}}
    assert Scene.from_dict(whole).chain() == rc.Chain.uniform_rods(3, 4.5, 30.0).with_weight(5.0)

    locked = {**ROD, "clamped": True}
    long = scene({**ROD, "repeat": 2}, locked, ROD, {**ROD, "repeat": 2})
    assert long.chain() == scene({**ROD, "repeat": 6}).chain().clamped(3)
    pair = scene(locked, {**ROD, "standing": True, "flywheel": WHEEL, "displaced": {"mass": 0.5}}, ROD)
    rig = pair.rig()
    assert rig.chain == scene(ROD, ROD, ROD).chain().clamped(1)
    assert rig.chain.length.tolist() == [3.0, 1.5]
    assert rig.standing.tolist() == [True, False] and np.count_nonzero(rig.momentum) == 1
    assert rig.displaced_centroid[0] == 1.5  # of the whole piece
    three = scene(locked, locked, {**ROD, "tip_mass": 0.1}).chain()
    assert three.size == 1 and three.total_length == 4.5


@pytest.mark.parametrize(
    ("entries", "says"),
    [
        ({"support": {"stiffness": 0}}, r"support.stiffness: must be positive, got 0"),
        ({"support": {"stiffness": "3 kg"}}, r"support.stiffness: must be a force per length such as \"2 kN/m\""),
        ({"support": {"mass": 1}}, r"support.stiffness: is missing"),
        ({"support": {"stiffness": 1, "mass": 1, "weight": 2}}, r"support: give either weight or mass"),
        ({"support": {"spring": 1}}, r"support.spring: unknown key"),
        ({"fluid": "air"}, r"fluid: must be one of still, turning"),
        ({"links": [{**ROD, "standing": 1}]}, r"links\[0\].standing: "),
        (
            {"links": [ROD, {**ROD, "flywheel": {"mass": 1, "spin": 1}}]},
            r"links\[1\].flywheel.radius_of_gyration: is missing",
        ),
        (
            {"links": [{**ROD, "flywheel": {**WHEEL, "spin": "3 m"}}]},
            r"links\[0\].flywheel.spin: must be an angular speed",
        ),
        ({"links": [{**ROD, "flywheel": {**WHEEL, "weight": 1}}]}, r"links\[0\].flywheel: give either weight or mass"),
        ({"links": [{**ROD, "displaced": {}}]}, r"links\[0\].displaced: give either weight or mass"),
        ({"links": [{**ROD, "displaced": {"mass": 1, "added_mass": "1 m"}}]}, r"displaced.added_mass: must be a mass"),
        ({"links": [{**ROD, "tip_mass": 1, "repeat": 2}]}, r"links\[0\].repeat: must be 1 where a weight is fixed"),
        ({"links": [{**ROD, "tip_mass": 1, "tip_weight": 2}]}, r"links\[0\]: give either tip_weight or tip_mass"),
        ({"links": [{**ROD, "tip_mass": "1 N"}]}, r"links\[0\].tip_mass: must be a mass such as"),
        ({"links": [ROD, {**ROD, "clamped": True}]}, r"links\[1\].clamped: there is no link above"),
        (
            {"links": [{**ROD, "clamped": True}, {**ROD, "repeat": 2}]},
            r"links\[1\].repeat: must be 1 where links are clamped",
        ),
        (
            {"links": [{**ROD, "clamped": True, "flywheel": WHEEL}, ROD]},
            r"links\[0\].flywheel: is said by the link above",
        ),
        ({"support": {"radius": 1}, "ask": at(-1.0)}, r"ask.response.angular_speed: must be positive, got -1"),
        ({"support": {"radius": 1}, "ask": at("8 m")}, r"ask.response.angular_speed: must be an angular speed"),
        ({"links": [{**ROD, "flywheel": WHEEL}], "support": {"radius": 1}, "ask": at(0)}, "must not be 0"),
        ({"support": {"radius": 1}, "ask": {"rtol": 1e-3}}, r"ask.rtol: is for a chain alone.* got 0\.001"),
        ({"support": {"radius": 1}, "ask": {"angular_speed": [1, 2]}}, r"ask.angular_speed: is for a chain alone"),
    ],
)
def test_wrong_rigs_say_where(entries, says):
    with pytest.raises(rc.SceneError, match=says):
        Scene.from_dict({"links": [ROD], **entries})


def test_modes_of_a_rig_are_kept_to_the_last_digit(tmp_path):
    rig = rc.Rig(
        rc.Chain(weight=[1.0, 3.0, 2.0], length=[0.5, 0.4, 0.3]),
        stiffness=30.0,
        standing=[False, True, False],
        momentum=[0.2, 0.0, 0.1],
        displaced_weight=[0.1, 0.0, 0.0],
    )
    found = rc.modes(rig)
    for name in ("without_shapes.npz", "with_shapes.npz"):  # to_dict reads them; without, they are computed again
        found.save(tmp_path / name)
        back = rc.load(tmp_path / name)
        assert isinstance(back, rc.RigModes) and back == found
        assert back.system == rig
        assert json.dumps(back.to_dict()) == json.dumps(found.to_dict())
        assert back.available == found.available
    with pytest.raises(ValueError, match=r"kept in \.npz"):
        found.save(tmp_path / "rig.json")


def test_from_the_command_line(python, tmp_path):
    text = """
title = "Broomstick with a wheel"
[[links]]
kind = "rod"
mass = 1.0
length = 1.2
standing = true
flywheel = {mass = 0.5, radius_of_gyration = 0.2, spin = "300 rpm"}
[[links]]
mass = 0.1
length = 0.6
[support]
stiffness = 40
"""
    path = tmp_path / "broom.toml"
    path.write_text(text)
    run = python("-m", "revchain", "solve", path, "--out", tmp_path / "out")
    assert run.returncode == 0, run.stderr
    assert "1 link standing, 1 link with momentum" in " ".join(run.stdout.split())
    data = json.loads((tmp_path / "out" / "broom.json").read_text())
    found = rc.load(tmp_path / "out" / "broom.npz")
    assert [mode["angular_speed"] for mode in data["modes"]] == found.angular_speed.tolist()
    with (tmp_path / "out" / "broom.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["angular_speed"]) for row in rows] == found.angular_speed.tolist()
    assert all(f"{speed:.6g}" in run.stdout for speed in found.angular_speed)
    assert [mode["direction"] for mode in data["modes"]] == [1, -1] == [int(row["direction"]) for row in rows]
    assert data["other"] == found.to_dict()["other"] and len(found.other) == len(data["other"]) == 2
    assert (tmp_path / "out" / "broom.png").stat().st_size > 5000
    assert "valid: Rig of a chain of 2 links" in python("-m", "revchain", "validate", path).stdout


def test_carried_round_from_the_command_line(python, tmp_path):
    data = {"links": [{"mass": 1.0, "length": 0.1, "repeat": 30}], "support": {"radius": 0.02}, "gravity": 9.0}
    path = tmp_path / "carried.json"
    for speed in (2.0, "60 rpm"):
        path.write_text(json.dumps({**data, "ask": {"modes": 2, **at(speed)}}))
        run = python("-m", "revchain", "solve", path, "--json", tmp_path / "out.json", "--plot", tmp_path / "out.png")
        assert run.returncode == 0, run.stderr
        assert f"carried round at {'2.00000' if speed == 2.0 else '6.28319'} rad/s" in run.stdout
        assert "and 11 more; --json" in run.stdout
        found = json.loads((tmp_path / "out.json").read_text())["carried"]
        same = rc.load_scene(path).response()
        assert found["offset"] == same.offset.tolist() and found["support_radius"] == 0.02
        assert found["error_bound"] == same.error_bound and not found["resonant"]
    # exactly at the whirl speed of a plummet: height and length 1
    resonance = {"links": [{"mass": 1.0, "length": 1.0}], "support": {"radius": 0.02}, "gravity": 9.0, "ask": at(3.0)}
    path.write_text(json.dumps(resonance))
    run = python("-m", "revchain", "solve", path, "--json", tmp_path / "out.json", "--plot", tmp_path / "out.png")
    assert run.returncode == 0, run.stderr
    assert "a resonance" in run.stdout
    found = json.loads((tmp_path / "out.json").read_text())["carried"]
    assert found["resonant"] and found["offset"] is None
    rig = scene(ROD, support={"radius": 0.1}).modes()
    with pytest.raises(ValueError, match="same rig at one speed"):
        rig.plot(carried=scene(ROD, ROD, support={"radius": 0.1}, ask=at(1.0)).response())


def test_pictures_of_rigs():
    pytest.importorskip("matplotlib")
    broom = scene({**ROD, "standing": True}, support={"radius": 0.05}).modes()
    axes = broom.plot()  # nothing whirls: the rig at rest, and what becomes of it
    assert axes.get_ylabel() == "height above the support (m)"
    assert "exp(3.132 t)" in axes.get_xticklabels()[1].get_text()
    axes.figure.savefig("/dev/null", format="png")
    long = scene(
        {**ROD, "repeat": 4_000},
        {**ROD, "standing": True, "repeat": 200},
        {**ROD, "displaced": {"mass": 2.0}},
        support={"stiffness": 1e9, "mass": 0.1},
    )
    axes = rc.modes(long.rig(), count=1).plot(most=1)
    assert max(line.get_xdata().size for line in axes.lines) <= 3 * 2000
    axes.figure.savefig("/dev/null", format="png")
