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


def scene(*links, **entries):
    return Scene.from_dict({"links": list(links) or [dict(ROD)], **entries})


def test_a_scene_says_what_a_rig_is():
    given = scene(
        {**ROD, "flywheel": WHEEL, "repeat": 2},
        {"mass": 3.0, "length": 0.4, "standing": True},
        {**ROD, "displaced": {"mass": 0.5, "added_mass": 0.25, "centroid": 0.7}},
        {"mass": 1.0, "length": 1.0, "flywheel": {**WHEEL, "spin": -2.0, "driven": True}},
        support={"stiffness": "2 kN/m", "mass": 0.2, "radius": "10 cm"},
    )
    rig = given.system()
    assert given.is_rigged and rig.chain.mass.tolist() == [1, 1, 3, 1, 1]
    assert rig.support == rc.Support(stiffness=2000.0, mass=0.2, radius=0.1)
    driven, spin = [False] * 4 + [True], [10 * np.pi, 10 * np.pi, 0, 0, -2]
    on = np.array([1, 1, 0, 0, 1])
    assert rig.flywheels == rc.Flywheel(mass=1.5 * on, radius_of_gyration=0.29 * on, spin=spin, driven=driven)
    assert rig.inverted.tolist() == [False, False, True, False, False]
    displaced = rc.Displaced(mass=[0, 0, 0, 0.5, 0], added_mass=[0, 0, 0, 0.25, 0], centroid=[0.75, 0.75, 0.4, 0.7, 1.0])
    assert rig.displaced == displaced and rig.fluid == "still"


def test_a_scene_with_a_weight_is_one_by_weight():
    light = scene({**ROD, "flywheel": WHEEL}, support={"stiffness": 50, "mass": 0.2}, gravity=10.0)
    heavy = scene({**ROD, "flywheel": WHEEL}, support={"stiffness": 50, "weight": 2.0}, gravity=10.0)
    assert light.system().by_mass and not heavy.system().by_mass and heavy.system().support.carriage == 2.0
    np.testing.assert_allclose(heavy.modes().angular_speed, light.modes().angular_speed, rtol=1e-14)
    weightless = {"uniform_chain": {"kind": "rods", "count": 9, "length": 1, "weight": 20}, "gravity": 10.0}
    held = Scene.from_dict({**weightless, "held": {"span": 0.5, "weightless": True}}).system()
    assert held.system == rc.Chain.uniform_rods(9, length=1.0, mass=2.0)


def test_modes_of_a_scene_are_those_of_its_rig():
    support = {"stiffness": 50.0, "mass": 0.2}
    given = scene({**ROD, "flywheel": WHEEL, "repeat": 30}, support=support, ask={"modes": {"count": 4, "first": 2}})
    found = given.modes()
    assert isinstance(found, rc.Modes)
    same = rc.modes(given.system(), count=4, first=2, gravity=G)
    assert np.array_equal(found.conical_height, same.conical_height)
    assert list(np.sort(found.number)) == [2, 2, 3, 3, 4, 4, 5, 5] and found.direction.sum() == 0
    assert len(scene(ROD, support=support, ask={"modes": {"count": "all"}}).modes()) == 2
    assert len(scene(ROD, support=support).modes()) == 2
    assert len(scene({**ROD, "repeat": 20}, support=support).modes()) == 10


def test_weights_at_pins_and_clamped_links():
    tipped = scene({**ROD, "tip_mass": 0.5}, {**ROD, "tip_mass": 0.2}, ROD)
    rods = rc.Chain(mass=1.0, length=[1.5] * 3, centroid=0.75, radius_of_gyration=1.5 / 12**0.5)
    assert not tipped.is_rigged
    assert tipped.system() == rods.with_body(mass=0.2, pin=1).with_body(mass=0.5)
    whole = {"uniform_chain": {"kind": "rods", "count": 3, "length": 4.5, "mass": 3.0, "tip_mass": 0.5}}
    assert Scene.from_dict(whole).system() == rc.Chain.uniform_rods(3, 4.5, mass=3.0).with_body(mass=0.5)

    locked = {**ROD, "clamped": True}
    long = scene({**ROD, "repeat": 2}, locked, ROD, {**ROD, "repeat": 2})
    assert long.system() == scene({**ROD, "repeat": 6}).system().clamped(2)
    pair = scene(locked, {**ROD, "standing": True, "flywheel": WHEEL, "displaced": {"mass": 0.5}}, ROD)
    rig = pair.system()
    assert rig.chain == scene(ROD, ROD, ROD).system().clamped(0)
    assert rig.chain.length.tolist() == [3.0, 1.5]
    assert rig.inverted.tolist() == [True, False] and rig.flywheels.mass.tolist() == [1.5, 0]
    assert rig.displaced.centroid[0] == 1.5  # of the whole piece
    three = scene(locked, locked, {**ROD, "tip_mass": 0.1}).system()
    assert three.size == 1 and three.total_length == 4.5


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
    run = python("-m", "revchain", "run", path, "--out", tmp_path / "out")
    assert run.returncode == 0, run.stderr
    assert "1 link inverted; 1 link with momentum" in " ".join(run.stdout.split())
    data = json.loads((tmp_path / "out" / "modes.json").read_text())
    found = rc.load_scene(path).modes()
    assert [mode["angular_speed"] for mode in data["modes"]] == found.angular_speed.tolist()
    with (tmp_path / "out" / "modes.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [float(row["angular_speed"]) for row in rows] == found.angular_speed.tolist()
    assert all(f"{speed:.6g}" in run.stdout for speed in found.angular_speed)
    assert [mode["direction"] for mode in data["modes"]] == [1, -1] == [int(row["direction"]) for row in rows]
    assert data["other"] == found.to_dict()["other"] and len(found.other) == len(data["other"]) == 2
    assert (tmp_path / "out" / "modes.png").stat().st_size > 5000
    assert "valid: support: on a spring of 40 N/m" in python("-m", "revchain", "validate", path).stdout


def test_carried_round_from_the_command_line(python, tmp_path):
    data = {"links": [{"mass": 1.0, "length": 0.1, "repeat": 30}], "support": {"radius": 0.02}, "gravity": 9.0}
    path, out = tmp_path / "carried.json", tmp_path / "out"
    path.write_text(json.dumps({**data, "ask": {"modes": {"count": 2}, "response": {"angular_speed": "60 rpm"}}}))
    run = python("-m", "revchain", "run", path, "--out", out)
    assert run.returncode == 0, run.stderr
    assert "60.000" in run.stdout and "and 11 more; --json" in run.stdout
    found = json.loads((out / "response.json").read_text())
    assert found["speeds"][0]["offset"] == rc.load_scene(path).response().offset.tolist()
    assert {file.name for file in out.iterdir()} == {
        f"{question}{kind}" for question in ("modes", "response") for kind in (".txt", ".json", ".csv", ".png")
    }
    assert run.stdout.startswith((out / "modes.txt").read_text().splitlines()[0])
    # exactly at the whirl speed of a point mass: height and length 1
    resonance = {**data, "links": [{"mass": 1.0, "length": 1.0}], "ask": {"response": {"angular_speed": 3.0}}}
    path.write_text(json.dumps(resonance))
    run = python("-m", "revchain", "response", path, "--json", out / "a.json", "--plot", out / "a.png")
    assert run.returncode == 0 and "a resonance" in run.stdout, run.stderr
    found = json.loads((out / "a.json").read_text())["speeds"][0]
    assert found["resonant"] and found["offset"] == [None, 0.02]


def test_pictures_of_rigs():
    pytest.importorskip("matplotlib")
    broom = scene({**ROD, "standing": True}, support={"radius": 0.05}).modes()
    axes = broom.plot()  # nothing whirls: the rig at rest, and what becomes of it
    assert axes.get_ylabel() == "height above the support (m)"
    assert axes.get_xlabel() == "unstable: a small push\ndoubles every 0.22 s"
    axes.figure.savefig("/dev/null", format="png")
    long = scene(
        {**ROD, "repeat": 4_000},
        {**ROD, "standing": True, "repeat": 200},
        {**ROD, "displaced": {"mass": 2.0}},
        support={"stiffness": 1e9, "mass": 0.1},
    )
    axes = rc.modes(long.system(), count=1).plot()
    assert max(line.get_xdata().size for line in axes.lines) <= 3 * 2000
    axes.figure.savefig("/dev/null", format="png")
