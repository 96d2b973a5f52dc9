# SPDX-License-Identifier: GPL-3.0-or-later
"""Which method answers, why, and that its bound holds: from Python and the command line."""

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
METHODS = [row.name for row in rc.explain(RODS).rows]


def test_the_cheapest_that_keeps_the_tolerance():
    for chain in (RODS, PLUMMETS, UNLIKE, rc.Chain.uniform_rods(2), rc.Chain(weight=1.0, length=2.0)):
        exact = rc.modes(chain, 1).conical_height
        for rtol in (1.0, 1e-2, 1e-5, 1e-9, 1e-14, None):
            why, found = rc.explain(chain, 1, rtol=rtol), rc.modes(chain, 1, rtol=rtol)
            admissible = [row for row in why.rows if row.applies and row.error_bound <= (rtol or 4.45e-16)]
            assert why.chosen == min(admissible, key=lambda row: row.cost)
            assert found.method == why.chosen.name
            assert why.meets_tolerance and found.status == "success" and found.error_bound.max() <= (rtol or 4.45e-16)
            assert abs(found.conical_height / exact - 1) <= found.error_bound + 2.3e-16


def test_every_method_by_its_name():
    exact = rc.modes(PLUMMETS, 3).conical_height
    answered = set()
    for row in rc.explain(PLUMMETS, 3, rtol=1e-3).rows:
        if not row.applies:
            assert row.reason
            if row.name not in _core.METHODS:
                with pytest.raises(ValueError, match=f"method '{row.name}' does not apply .*; explain says why"):
                    rc.modes(PLUMMETS, 3, rtol=1e-3, method=row.name)
            continue
        found = rc.modes(PLUMMETS, 3, rtol=1e-3, method=row.name)
        assert found.method == row.name
        answered.add(row.name)
        assert len(found) == 3 and np.all(np.abs(found.conical_height / exact - 1) <= found.error_bound + 2.3e-16)
    formulas = {"Laguerre asymptotics", "continuous chain", "coarse chain"}
    assert answered == formulas | {"single precision", "condensed", "bisection"}
    with pytest.raises(ValueError, match="method must be one of bisection, .*, closed forms, .*, got 'magic'"):
        rc.modes(PLUMMETS, method="magic")
    with pytest.raises(ValueError, match="method 'coarse chain' goes with count, first and rtol alone"):
        rc.modes(PLUMMETS, conical_height=(0.1, 1.0), method="coarse chain")


def test_thirty_digits():
    chain = rc.Chain.uniform_plummets(7)
    found = rc.modes(chain, 7, rtol=1e-20, method="double-double")
    assert found.method == "double-double" and found.error_bound.max() < 1e-26
    with mp.workdps(50):
        zeros = [mp.findroot(lambda x: mp.laguerre(7, 0, x), x0) for x0 in (0.19, 1.03, 2.57, 4.9, 8.18, 12.73, 19.4)]
        a = mp.mpf(float(chain.length[0]))
        heights = zip(found.conical_height, found.conical_height_low, found.error_bound, zeros, strict=True)
        for height, low, bound, x in heights:
            assert abs((mp.mpf(float(height)) + mp.mpf(float(low))) * x / a - 1) <= bound
    assert rc.modes(chain, 7, rtol=1e-9).conical_height_low is None


def test_at_an_inclination():
    chain = rc.Chain.uniform_plummets(12, length=1.0)
    for inclination in (0.01, 0.2, 1.0):
        exact = rc.steady_shape(chain, mode=2, tip_inclination=inclination).conical_height
        for rtol in (0.5, 1e-3, 1e-6, 1e-12):
            height, bound, _, _, status = _core.solve(chain._compiled, 2, 1, rtol, inclination, None)
            assert abs(height[0] / exact - 1) <= bound[0] + 4e-16
            assert bound[0] <= rtol or status == "tolerance_not_met"
    assert _core.solve(chain._compiled, 1, 1, 1e-9, 0.2, None)[3] == "finite amplitude"
    with pytest.raises(ValueError, match="right angle"):
        _core.solve(chain._compiled, 1, 1, 0.0, 1.6, None)


def test_no_model_applies():
    threads = rc.Chain(weight=[1.0, 0.0, 1.0, 2.0], length=1.0)._compiled
    rows, chosen, met = _core.select(threads, 1, 3, 1e-3, 0.3, None)
    assert chosen == len(rows) == 14 and not met and all(reason for _, reason, _, _ in rows)
    height, bound, low, model, status = _core.solve(threads, 1, 3, 1e-3, 0.3, None)
    assert len(height) == len(bound) == 0 and low is None and (model, status) == ("", "tolerance_not_met")


def test_a_budget_of_time():
    rows, chosen, met = _core.select(RODS._compiled, 1, 1, 1e-15, 0.0, 1e-6)
    assert not met and rows[chosen][0] == "continuous chain"
    _, bound, _, _, status = _core.solve(RODS._compiled, 1, 1, 1e-15, 0.0, 1e-6)
    assert status == "tolerance_not_met" and bound.max() < 2e-13
    assert _core.solve(RODS._compiled, 1, 1, 1e-15, 0.0, 10.0)[4] == "success"
    assert "no method keeps it" in repr(rc.explain(RODS, 1, rtol=1e-40))


def test_rigs_and_gravity():
    moon = rc.modes(rc.Chain(weight=1.0, length=1.0), rtol=1e-15, gravity=1.62)
    assert moon.angular_speed[0] == pytest.approx(math.sqrt(1.62), rel=1e-15)
    rig = rc.Rig(UNLIKE, support=rc.Support(stiffness=50.0))
    wheels = rc.Rig(UNLIKE, flywheels=rc.Flywheel(weight=1.0, radius_of_gyration=0.3, spin=30.0))
    for one in (rig, wheels):
        assert [row.chosen for row in rc.explain(one).rows] == [True]
        assert rc.modes(one, 2).error_bound.max() <= rc.explain(one, 2).chosen.error_bound
    with pytest.raises(ValueError, match="method is for a Chain; .*, got 'closed forms'"):
        rc.modes(rig, method="closed forms")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"count": 0}, "count must be at least 1"),
        ({"count": 5}, "4 modes"),
        ({"first": 5}, "4 modes"),
        ({"rtol": -1.0}, "rtol must not be negative"),
        ({"rtol": math.nan}, "rtol must not be negative or NaN"),
    ],
)
def test_wrong_questions(arguments, words):
    for ask in (rc.modes, rc.explain):
        with pytest.raises(ValueError, match=words):
            ask(UNLIKE, **arguments)


def test_equal_links_are_seen_however_stored():
    for last, same in ((0.001, True), (0.0011, False)):
        chain = rc.Chain(weight=[*np.full(999, 0.001), last], length=np.full(1000, 0.002))
        assert (rc.explain(chain, 1, rtol=1e-6).chosen.name == "Laguerre asymptotics") == same


def test_the_command(capsys, tmp_path, monkeypatch):
    path, broken = tmp_path / "chain.toml", tmp_path / "broken.toml"
    rods = '[uniform_chain]\nkind = "rods"\ncount = 5000\nlength = 1\nmass = 1\n[ask.modes]\ncount = 2\n'
    path.write_text('title = "Rods"\n' + rods)
    broken.write_text("[[links]]\nmass = 1\nlength = -1\n")
    monkeypatch.setenv("COLUMNS", "100")

    def run(*words, scene=path):
        code = _cli.run(["explain", str(scene), *words])
        return code, *capsys.readouterr()

    code, out, _ = run("--rtol", "1e-3")
    assert code == 0 and out.startswith("Rods\nsupport: firm; 5,000 times rod, 0.0002 kg, 0.0002 m\nrtol 0.001\n") and "-> continuous chain" in out
    assert "more than two links" in out and max(map(len, out.splitlines()[:-1])) <= 100  # the last names the file
    why = rc.explain(rc.load_scene(path).system(), 2, rtol=1e-3)
    assert all(row.name in out and row.reason in out for row in why.rows)
    code, out, _ = run("--rtol", "0.1 %", "--json", "-")
    data = json.loads(out)
    assert data.pop("system").startswith("support: firm") and data == {"title": "Rods", **why.to_dict()} and data["meets_tolerance"] and data["rtol"] == 1e-3
    assert [row["name"] for row in data["methods"]] == METHODS
    assert [row["name"] for row in data["methods"] if row["chosen"]] == ["continuous chain"]
    for words, scene, code in (
        ((), path, 0),
        (("--rtol", "1e-4", "--count", "2", "--first", "3"), path, 0),
        (("--rtol", "1e-40"), path, 1),
        *((("--rtol", value), path, 2) for value in ("-1", "nan", "loose")),
        (("--first", "9999"), path, 2),
        ((), broken, 3),
    ):
        ended, _, err = run(*words, scene=scene)
        assert ended == code and bool(err.strip()) == bool(code) and "Traceback" not in err, (words, err)
        assert code != 1 or "no method keeps the tolerance; the best bound is" in err
