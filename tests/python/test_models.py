# SPDX-License-Identifier: GPL-3.0-or-later
"""Which model answers, why, and that its bound holds: from Python and the command line."""

import json
import math

import mpmath as mp
import numpy as np
import pytest

import revchain as rc
from revchain import _core
from revchain.cli import app as _cli

RODS, PLUMMETS = rc.Chain.uniform_rods(1000, length=2.0), rc.Chain.uniform_plummets(1000, length=2.0)
UNLIKE = rc.Chain(weight=[1.0, 3.0, 0.5, 2.0], length=[0.3, 0.4, 0.5, 0.6])
MODELS = [row.name for row in rc.explain(RODS).rows]


def test_the_cheapest_that_keeps_the_tolerance():
    for chain in (RODS, PLUMMETS, UNLIKE, rc.Chain.uniform_rods(2), rc.Chain(weight=1.0, length=2.0)):
        for rtol in (1.0, 1e-2, 1e-5, 1e-9, 1e-14, None):
            why, found = rc.explain(chain, rtol=rtol), rc.solve(chain, rtol=rtol)
            admissible = [row for row in why.rows if row.applies and row.error_bound <= (rtol or 4.45e-16)]
            assert why.chosen == min(admissible, key=lambda row: row.cost)
            assert why.meets_tolerance and found.status == "success" and found.error_bound.max() <= (rtol or 4.45e-16)
            exact = rc.modes(chain, 1).conical_height
            assert abs(found.conical_height / exact - 1) <= found.error_bound + 2.3e-16


def test_every_model_by_its_name():
    exact = rc.modes(PLUMMETS, 3).conical_height
    answered = set()
    for name in MODELS:
        found = rc.solve(PLUMMETS, 3, rtol=1e-3, model=name)
        row = next(row for row in rc.explain(PLUMMETS, 3, rtol=1e-3).rows if row.name == name)
        assert found.model == name
        if row.applies:
            answered.add(name)
            assert len(found) == 3 and np.all(np.abs(found.conical_height / exact - 1) <= found.error_bound + 2.3e-16)
        else:
            assert row.reason and len(found) == 0 and found.status == "tolerance_not_met"
    assert answered == {
        "Laguerre asymptotics",
        "continuous chain",
        "coarse chain",
        "single precision",
        "condensed",
        "bisection",
    }
    with pytest.raises(ValueError, match="model must be one of closed forms, .*, got 'magic'"):
        rc.solve(PLUMMETS, model="magic")


def test_thirty_digits():
    found = rc.solve(rc.Chain.uniform_plummets(7), 7, rtol=1e-20)
    assert found.model == "double-double" and found.error_bound.max() < 1e-26
    with mp.workdps(50):
        zeros = [mp.findroot(lambda x: mp.laguerre(7, 0, x), x0) for x0 in (0.19, 1.03, 2.57, 4.9, 8.18, 12.73, 19.4)]
        a = mp.mpf(float(rc.Chain.uniform_plummets(7).length[0]))
        for height, low, bound, x in zip(
            found.conical_height, found.conical_height_low, found.error_bound, zeros, strict=True
        ):
            assert abs((mp.mpf(float(height)) + mp.mpf(float(low))) * x / a - 1) <= bound
    assert rc.solve(rc.Chain.uniform_plummets(7), 7, rtol=1e-9).conical_height_low is None


def test_at_an_inclination():
    chain = rc.Chain.uniform_plummets(12, length=1.0)
    for inclination in (0.01, 0.2, 1.0):
        exact = rc.steady_shape(chain, mode=2, tip_inclination=inclination).conical_height
        for rtol in (0.5, 1e-3, 1e-6, 1e-12):
            found = rc.solve(chain, first=2, rtol=rtol, inclination=inclination)
            assert abs(found.conical_height[0] / exact - 1) <= found.error_bound[0] + 4e-16
            assert found.error_bound[0] <= rtol or found.status == "tolerance_not_met"
    assert rc.solve(chain, rtol=1e-9, inclination=0.2).model == "finite amplitude"
    with pytest.raises(ValueError, match="right angle"):
        rc.solve(chain, inclination=1.6)


def test_no_model_applies():
    threads = rc.Chain(weight=[1.0, 0.0, 1.0, 2.0], length=1.0)
    why = rc.explain(threads, 3, rtol=1e-3, inclination=0.3)
    assert why.chosen is None and not why.meets_tolerance and "->" not in repr(why)
    found = rc.solve(threads, 3, rtol=1e-3, inclination=0.3)
    assert len(found) == 0 and found.model == "" and found.status == "tolerance_not_met"
    assert repr(found) == "0 heights: no model has an answer, tolerance not met"


def test_the_command_where_no_model_applies(capsys, tmp_path):
    path = tmp_path / "threads.toml"
    links = "\n".join(f"[[links]]\nmass = {mass}\nlength = 1" for mass in (1, 0, 1, 2))
    path.write_text(f"{links}\n[ask]\nmodes = 3\n")
    assert _cli.run(["explain", str(path), "--inclination", "0.3"]) == 1
    assert "no model applies" in capsys.readouterr().err


def test_a_budget_of_time():
    why = rc.explain(RODS, rtol=1e-15, time_budget=1e-6)
    assert not why.meets_tolerance and why.chosen.name == "continuous chain" and "no model keeps it" in repr(why)
    found = rc.solve(RODS, rtol=1e-15, time_budget=1e-6)
    assert found.status == "tolerance_not_met" and found.error_bound.max() < 2e-13
    assert rc.solve(RODS, rtol=1e-15, time_budget=10.0).status == "success"


def test_scenes_and_rigs():
    scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 1, "repeat": 30}], "ask": {"modes": 4, "rtol": 1e-3}})
    found = rc.solve(scene)
    assert len(found) == 4 and found.rtol == 1e-3 and found.error_bound.max() <= 1e-3
    assert found.angular_speed == pytest.approx(rc.modes(scene.chain(), 4).angular_speed, rel=1e-3)
    moon = rc.Scene.from_dict({"gravity": 1.62, "links": [{"mass": 1, "length": 1}]})
    assert rc.solve(moon).angular_speed[0] == pytest.approx(math.sqrt(1.62), rel=1e-15)
    rig = rc.Rig(UNLIKE, stiffness=50.0)
    found = rc.solve(rig, 2, rtol=1e-9)
    assert np.array_equal(found.conical_height, rc.modes(rig, 2).conical_height) and found.status == "success"
    assert [row.chosen for row in rc.explain(rig).rows] == [True]
    wheels = rc.Rig(UNLIKE, **rc.free_flywheel(weight=1.0, radius_of_gyration=0.3, spin=30.0))
    for one in (rig, wheels):
        assert rc.solve(one, 2).error_bound.max() <= rc.explain(one, 2).chosen.error_bound
    assert rc.solve(rig, model=found.model) == rc.solve(rig)
    with pytest.raises(ValueError, match="model must be 'rig, by counts or discs' for a Rig, got 'closed forms'"):
        rc.solve(rig, model="closed forms")
    with pytest.raises(TypeError, match="Scene, Chain or Rig, got 3"):
        rc.solve(3)


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"count": 0}, "count must be at least 1"),
        ({"count": 5}, "there are 4 modes"),
        ({"first": 5}, "there are 4 modes"),
        ({"rtol": -1.0}, "rtol must not be negative"),
        ({"rtol": math.nan}, "rtol must not be negative or NaN"),
        ({"time_budget": 0.0}, "time_budget must be positive"),
    ],
)
def test_wrong_questions(arguments, words):
    for ask in (rc.solve, rc.explain):
        with pytest.raises(ValueError, match=words):
            ask(UNLIKE, **arguments)


def test_equal_links_are_seen_however_stored():
    stored = rc.Chain(weight=np.full(1000, 0.001), length=np.full(1000, 0.002))
    assert rc.explain(stored, rtol=1e-6).chosen.name == "Laguerre asymptotics"
    other = rc.Chain(weight=[*np.full(999, 0.001), 0.0011], length=0.002)
    assert rc.explain(other, rtol=1e-6).chosen.name != "Laguerre asymptotics"


def test_the_command(capsys, tmp_path):
    path = tmp_path / "chain.toml"
    path.write_text(
        'title = "Rods"\n[uniform_chain]\nkind = "rods"\ncount = 5000\nlength = 1\nmass = 1\n[ask]\nmodes = 2\n'
    )
    assert _cli.run(["explain", str(path), "--rtol", "1e-3"]) == 0
    out = capsys.readouterr().out
    assert out.startswith("Rods\nrtol 0.001\n") and "-> continuous chain" in out and "more than two links" in out
    assert max(map(len, out.splitlines())) <= 100
    assert _cli.run(["explain", str(path), "--json"]) == 0
    data = json.loads(capsys.readouterr().out)
    assert [row["name"] for row in data["models"]] == list(_core.MODELS) and sum(
        row["chosen"] for row in data["models"]
    ) == 1
    assert _cli.run(["explain", str(path), "--rtol", "1e-15", "--time-budget", "1e-6"]) == 1
    assert "no model keeps the tolerance" in capsys.readouterr().err
    assert _cli.run(["explain", str(path), "--rtol", "-1"]) == 2
    capsys.readouterr()
    exact = rc.modes(rc.load_scene(path).chain(), count=2, first=3)
    asked = ["explain", str(path), "--rtol", "1e-4", "--count", "2", "--first", "3"]
    assert _cli.run([*asked, "--solve"]) == 0
    out = capsys.readouterr().out
    assert "2 heights: by continuous chain" in out and f"{exact.conical_height[0]:.6g}"[:7] in out
    assert _cli.run([*asked, "--model", "coarse chain", "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)["answer"]
    assert answer["model"] == "coarse chain" and answer["first"] == 3
    for name in ("conical_height", "angular_speed"):
        assert [mode[name] for mode in answer["modes"]] == pytest.approx(getattr(exact, name), rel=1e-4)
    assert max(mode["error_bound"] for mode in answer["modes"]) <= 1e-4
    assert _cli.run([*asked, "--model", "dense"]) == 1
    assert "no model keeps" in capsys.readouterr().err
    assert _cli.run([*asked, "--model", "magic"]) == 2 and "model must be one of" in capsys.readouterr().err
    assert _cli.run(["explain", str(path), "--first", "9999"]) == 2
