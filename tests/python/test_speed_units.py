# SPDX-License-Identifier: GPL-3.0-or-later
"""Speeds in rad/s, rpm, Hz and as periods: in questions, ranges, scenes, studies, tables, pictures and on the command line."""

import itertools
import json
import math
import re

import matplotlib.pyplot as plt
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import revchain as rc
from revchain.plots.sweep import plot_sweep
from revchain.results.sheet import in_speed_unit
from revchain.systems.units import SPEED_UNITS, si_value, speed_unit, with_tolerance

CHAIN = rc.Chain(mass=[1.0, 3.0], length=0.5)
CAROUSEL = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=3.0))
TEXT = {"rad/s": "{:.17g} rad/s", "rpm": "{:.17g} rpm", "Hz": "{:.17g} Hz", "s": "{:.17g} s"}
LINKS = [{"mass": 2500, "length": 6}, {"mass": 400, "length": 24}]


def said(speed, unit):
    """A speed in rad/s as a user writes it in a unit."""
    per = SPEED_UNITS[unit][1]
    return TEXT[unit].format(per / speed if unit == "s" else per * speed)


@settings(max_examples=40)
@given(st.floats(1e-6, 1e6), st.sampled_from(sorted(SPEED_UNITS)))
def test_the_four_ways_say_one_speed(speed, unit):
    assert si_value(said(speed, unit), "angular_speed") == pytest.approx(speed, rel=1e-14)
    assert speed_unit(said(speed, unit)) == unit
    assert si_value("-" + said(speed, unit), "angular_speed") == pytest.approx(-speed, rel=1e-14)


@pytest.mark.parametrize(
    ("text", "unit", "speed"),
    [
        ("60 1/min", "rpm", 2 * math.pi), ("60/min", "rpm", 2 * math.pi), ("60 min^-1", "rpm", 2 * math.pi),
        ("60 RPM", "rpm", 2 * math.pi), ("2 turn/min", "rpm", math.pi / 15), ("1 rev/s", "Hz", 2 * math.pi),
        ("500 ms", "s", 4 * math.pi), ("1 min", "s", math.pi / 30), ("0.5 kHz", "Hz", 1000 * math.pi),
        ("3 deg/s", None, math.pi / 60), ("2 rad/s", "rad/s", 2.0),
    ],
)  # fmt: skip
def test_what_else_is_written(text, unit, speed):
    assert si_value(text, "angular_speed") == pytest.approx(speed, rel=1e-14)
    assert speed_unit(text) == unit


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("60 1/s", 'may be turns or radians per second: write "60 Hz" or "60 rad/s", got "60 1/s"'),
        ("60 s^-1", 'write "60 Hz" or "60 rad/s"'),
        ("0 s", 'or a period that is not 0, got "0 s"'),
        ("2 m", 'must be an angular speed such as "30 rpm", got "2 m"'),
        ("30 rpm +- 1 rpm", 'must be a number without a tolerance, got "30 rpm .- 1 rpm"; write "30 rpm" here'),
    ],
)
def test_what_no_speed_is(text, message):
    with pytest.raises(ValueError, match=message):
        rc.steady_shapes(CHAIN, angular_speed=text)


def test_a_reciprocal_is_no_length():
    with pytest.raises(ValueError, match='must be a length such as "39.1396 inch", got "3 1/m"'):
        rc.Chain(mass=1.0, length="3 1/m")


QUESTIONS = {
    "steady_shapes": lambda n: rc.steady_shapes(CHAIN, angular_speed=n(6.0)),
    "steady_shape": lambda n: rc.steady_shape(CHAIN, mode=1, angular_speed=n(6.0)),
    "branches": lambda n: rc.branches(CHAIN, max_angular_speed=n(6.0)),
    "branch": lambda n: rc.branch(CHAIN, 1, max_angular_speed=n(6.0)),
    "response": lambda n: rc.response(CHAIN, angular_speed=[n(2.0), n(6.0)]),
    "modes": lambda n: rc.modes(CHAIN, angular_speed=(n(2.0), n(50.0))),
    "campbell": lambda n: rc.campbell(CAROUSEL, [n(0.5), n(1.0)]),
    "drag_shape": lambda n: rc.drag_shape(CAROUSEL, rc.Drag(1.0, area=0.6), angular_speed=n(1.2)),
}


@pytest.mark.parametrize("question", QUESTIONS)
def test_every_question_takes_the_four_ways(question):
    """The numbers agree, and what is printed speaks the unit that was asked."""
    plain = QUESTIONS[question](lambda speed: speed)
    for unit in SPEED_UNITS:
        found = QUESTIONS[question](lambda speed, unit=unit: said(speed, unit))
        assert found._speed_unit == unit and plain._speed_unit is None
        one, other = (np.asarray(x.angular_speed if hasattr(x, "angular_speed") else x.highest_speed, float) for x in (found, plain))
        assert np.sort(one.ravel()) == pytest.approx(np.sort(other.ravel()), rel=1e-12)
        text = repr(found)
        assert f"({unit})" in text.replace(f" {unit} (", f"({unit})") or re.search(rf"\d {unit}\b", text), text
        assert [column.name for column in found._sheet().columns] == [column.name for column in plain._sheet().columns]
        drawn = found.plot()
        words = [drawn.get_xlabel(), drawn.get_title(), *(label.get_text() for label in drawn.get_xticklabels())]
        words += [drawn.get_legend().get_title().get_text()] if drawn.get_legend() else []
        words += [each.get_text() for axes in drawn.figure.axes for each in axes.texts]
        if question not in ("drag_shape", "steady_shape"):
            assert any(unit in each for each in words), words


def test_tables_say_one_speed_once():
    by_hertz = repr(rc.modes(CHAIN, angular_speed=("0.1 Hz", "5 Hz")))
    assert "frequency (Hz)" in by_hertz and "rpm" not in by_hertz and "period (s)" in by_hertz
    by_period = repr(rc.modes(CHAIN, angular_speed=("10 s", "0.2 s")))
    assert by_period.count("period (s)") == 1 and "rad/s" not in by_period
    both = repr(rc.modes(CHAIN))
    assert "speed (rad/s)" in both and "speed (rpm)" in both


def test_printed_numbers_are_the_stored_ones_in_the_unit():
    modes = rc.modes(CHAIN)
    for unit, field in (("rad/s", "angular_speed"), ("rpm", "rpm"), ("Hz", "frequency"), ("s", "period")):
        sheet = in_speed_unit(modes._sheet(brief=True), unit)
        [shown] = [column for column in sheet.columns if column.heading == f"{SPEED_UNITS[unit][0]} ({unit})"]
        assert shown.shown == pytest.approx(getattr(modes, field), rel=1e-14)
        assert (shown.values == modes.angular_speed).all() or unit == "s"
    assert in_speed_unit(modes._sheet(), None).columns == modes._sheet().columns


def test_uncertainties_speak_the_unit_but_deviations_are_no_periods():
    window = rc.modes(CHAIN, angular_speed=("1 rpm", "600 rpm"))
    assert "speed at least (rpm)" in repr(window.uncertainty(mass="5 %", worst=True))
    assert "of the speed (rpm)" in repr(window.uncertainty(mass="5 %"))
    periods = rc.modes(CHAIN, angular_speed=("10 s", "0.1 s")).uncertainty(mass="5 %")
    assert "of the speed (rad/s)" in repr(periods) and repr(periods) == repr(rc.modes(CHAIN).uncertainty(mass="5 %"))


def test_windows_and_ranges_of_periods():
    slow, fast = rc.modes(CHAIN).period
    both = rc.modes(CHAIN, angular_speed=(f"{0.9 * fast} s", f"{1.1 * slow} s"))
    assert len(both) == 2 and both == rc.modes(CHAIN, angular_speed=(f"{1.1 * slow} s", f"{0.9 * fast} s"))
    found = rc.campbell(CAROUSEL, ["4 s", "6 s", "8 s"])
    assert 2 * np.pi / found.angular_speed == pytest.approx([8, 6, 4]) and (np.diff(found.angular_speed) > 0).all()
    with pytest.raises(ValueError, match="ascending speeds"):
        rc.campbell(CAROUSEL, ["4 s", "8 s", "6 s"])
    with pytest.raises(ValueError, match="ascending speeds"):
        rc.campbell(CAROUSEL, ["4 rpm", "3 rpm"])


def scene(**more):
    return rc.Scene.from_dict({"links": LINKS, **more})


def test_scenes():
    even = {"response": {"angular_speed": {"from": "2 s", "to": "4 s", "steps": 5}}}
    found = scene(ask=even).response()
    assert found.period == pytest.approx([2, 2.5, 3, 3.5, 4], rel=1e-14) and found._speed_unit == "s"
    ratios = {"response": {"angular_speed": {"from": "2 s", "to": "8 s", "steps": 3, "log": True}}}
    assert scene(ask=ratios).response().period == pytest.approx([2, 4, 8], rel=1e-14)
    mixed = {"response": {"angular_speed": {"from": "1 rad/s", "to": "2 s", "steps": 3}}}
    assert scene(ask=mixed).response().angular_speed == pytest.approx(np.linspace(1, np.pi, 3))
    for window in (["20 s", "1 s"], ["1 s", "20 s"]):
        modes = scene(ask={"modes": {"angular_speed": window}}).modes()
        assert len(modes) == 2 and modes._speed_unit == "s"
    assert "period (s)" in repr(scene(ask={"shapes": {"angular_speed": "5 s"}}, speed="s").modes())
    chosen = scene(speed="Hz", ask={"modes": {"angular_speed": ["20 s", "1 s"]}})
    assert "frequency (Hz)" in repr(chosen.modes()) and chosen.to_dict()["speed"] == "Hz"
    ranged = {"campbell": {"angular_speed": {"from": "5 s", "to": "8 s", "steps": 3}}}
    assert (np.diff(scene(ask=ranged, support={"radius": 2.0}).campbell().angular_speed) > 0).all()
    with pytest.raises(rc.SceneError, match='speed: must be one of rad/s, rpm, Hz, s, got "60 rpm"'):
        scene(speed="60 rpm")


def study(vary, **more):
    return {"scene": {"links": LINKS, **more.pop("scene", {})}, "vary": vary, **more}


def test_a_study_stores_what_it_is_asked_to_find():
    grid = {"links[0].mass": {"from": "2 t", "to": "3 t", "steps": 4}}
    plain = rc.sweep(study(grid))
    for way, unit in (("period", "s"), ("frequency", "Hz"), ("rpm", "rpm"), ("angular_speed", "rad/s")):
        found = rc.sweep(study(grid, find=[way]))
        assert set(found.data_vars) == {way, "status"} and found[way].attrs["units"] == unit
        speed = plain["angular_speed"].to_numpy()
        wanted = 2 * np.pi / speed if unit == "s" else speed * SPEED_UNITS[unit][1]
        assert found[way].to_numpy() == pytest.approx(wanted, rel=1e-14)
    both = rc.sweep(study(grid, find=["period", "rpm"]))
    assert set(both.data_vars) == {"period", "rpm", "status"}
    every = rc.sweep(study(grid, find=["modes", "period"]))
    assert set(every.data_vars) == {*plain.data_vars, "period"}
    assert every["period"].to_numpy() == pytest.approx(2 * np.pi / plain["angular_speed"].to_numpy(), rel=1e-14)
    rig = rc.sweep(study(grid, find=["period"], scene={"support": {"stiffness": "200 kN/m"}}))
    assert set(rig.data_vars) == {"period", "status"}
    wheels = [{**link, "flywheel": {"mass": 5.0, "radius_of_gyration": 0.5, "spin": 30.0}} for link in LINKS]
    turning = rc.sweep(study(grid, find=["period"], scene={"links": wheels}))
    assert set(turning.data_vars) == {"forward_period", "backward_period", "status"}


def test_a_study_draws_and_varies_periods():
    shapes = {"support": {"radius": 1.0}, "ask": {"shapes": {"angular_speed": "20 s"}}}
    found = rc.sweep(study({"ask.shapes.angular_speed": {"from": "8 s", "to": "20 s", "steps": 4}}, scene=shapes))
    assert 2 * np.pi / found["ask.shapes.angular_speed"].to_numpy() == pytest.approx([8, 12, 16, 20])
    ax = plot_sweep(found, "free_end_offset")
    assert ax.get_xlabel() == "ask.shapes.period (s)" and ax.lines[0].get_xdata() == pytest.approx([8, 12, 16, 20])
    modes = rc.sweep(study({"links[0].mass": {"values": ["2 t", "3 t"]}}, scene={"speed": "rpm"}))
    ax = plot_sweep(modes)
    assert ax.get_ylabel() == "angular speed (rpm)"
    assert ax.lines[0].get_ydata() == pytest.approx(modes["angular_speed"][:, 0] * 30 / np.pi)
    assert plot_sweep(modes, speed="s").get_ylabel() == "period (s)"
    with pytest.raises(ValueError, match="speed must be one of rad/s, rpm, Hz, s, got 'min'"):
        plot_sweep(modes, speed="min")


@pytest.mark.parametrize(
    ("text", "value", "spread"),
    [
        ("38 m +- 0.5 m", "38 m", "0.5 m"), ("38 m ± 0.5 m", "38 m", "0.5 m"), ("38 m +/- 0.5 m", "38 m", "0.5 m"),
        ("38 +- 0.5 m", "38 m", "0.5 m"), ("38 m ± 0.5", "38 m", "0.5 m"), ("(38 ± 0.5) m", "38 m", "0.5 m"),
        ("38 m +- 1 %", "38 m", "1 %"), ("+- 2 cm", "", "2 cm"), ("1e-3 kg+-1e-5 kg", "1e-3 kg", "1e-5 kg"), ("-2 ± 1", "-2", "1"),
    ],
)  # fmt: skip
def test_tolerances(text, value, spread):
    assert with_tolerance(text) == (value, spread)


@pytest.mark.parametrize("text", ["38 m", "-3 m", "+3 m", "1e-3 m", "1e+3 m", ""])
def test_no_tolerances(text):
    assert with_tolerance(text) is None


def test_tolerances_of_uncertainty_fit_and_studies():
    modes = rc.modes(rc.Chain(mass=[2500, 400], length=[6, 24]))
    want = modes.uncertainty(length_in_proportion=[0.1, 0.2]).angular_speed
    for given_ in (["6 m +- 0.1 m", "± 20 cm"], ["+/- 10 cm", "24 m +- 0.2"], ["(6 +- 0.1) m", 0.2]):
        assert modes.uncertainty(length_in_proportion=given_).angular_speed == pytest.approx(want, rel=1e-14)
    assert modes.uncertainty(mass="+- 5 %").angular_speed == pytest.approx(modes.uncertainty(mass="5 %").angular_speed)
    with pytest.raises(ValueError, match='is 6, not "38 m": write ".- 0.5 m", or give the system that'):
        modes.uncertainty(length_in_proportion="38 m +- 0.5 m")
    with pytest.raises(ValueError, match='must be a length .*, got "1 kg"'):
        modes.uncertainty(length_in_proportion="+- 1 kg")
    pair = rc.fit(modes.system, {1: ("10.87 s", "0.02 s"), 2: ("1.60 s", "1 %")}, vary=["length", "links[0].mass"])
    one = rc.fit(modes.system, {1: "10.87 s +- 0.02 s", 2: "1.60 s ± 1 %"}, vary=["length", "links[0].mass"])
    assert one == pair and np.isfinite(one.standard_uncertainty).all()
    laws = {"uniform": [2375, 2625], "normal": [2500, 125], "log_uniform": [2375, 2625]}
    for law, numbers in laws.items():
        texts = ["2500 kg +- 125 kg", "2.5 t ± 125 kg", ["2500 kg", "+- 125 kg"]] + ["2500 kg +- 5 %"] * (law != "log_uniform")
        plain = rc.sweep(study({"links[0].mass": {law: numbers}}, samples=5))
        for text in texts:
            other = rc.sweep(study({"links[0].mass": {law: text}}, samples=5))
            assert other["links[0].mass"].to_numpy() == pytest.approx(plain["links[0].mass"].to_numpy(), rel=1e-14)
    for wrong in ("2500", "+- 5 %", "2 s"):
        with pytest.raises(rc.SceneError, match=r'must be two numbers \[low, high\], or text such as "38 m .- 0.5 m"'):
            rc.Study.from_dict(study({"links[0].mass": {"uniform": wrong}}, samples=5))


def test_the_command_line(run, tmp_path):
    file = tmp_path / "a.toml"
    file.write_text("[[links]]\nmass = 2500\nlength = 6\n[[links]]\nmass = 400\nlength = 24\n")
    code, out, _ = run("response", file, "--angular-speed", "2 s to 4 s in 3")
    assert code == 0 and "period" in out and re.search(r"2\.0000.*\n.*3\.0000.*\n.*4\.0000", out)
    code, out, _ = run("modes", file, "--angular-speed", "1 s to 20 s")
    assert code == 0 and "2 of 2 modes" in out
    code, out, _ = run("shapes", file, "--angular-speed", "60 1/min")
    assert code == 0 and "60.0000 rpm (6.28319 rad/s)" in out
    code, out, _ = run("modes", file, "--speed", "Hz", "--csv", tmp_path / "a.csv")
    assert code == 0 and "frequency" in out and "rad/s" not in out
    assert (tmp_path / "a.csv").read_text().startswith("mode,direction,angular_speed,frequency,rpm,period")
    code, _, err = run("modes", file, "--speed", "min")
    assert code == 2 and "--speed: must be one of rad/s, rpm, Hz, s, the unit of speeds in tables, got min; give a speed by" in err
    code, _, err = run("shapes", file, "--angular-speed", "60 1/s")
    assert code == 2 and 'write "60 Hz" or "60 rad/s"' in err
    plan = tmp_path / "s.toml"
    plan.write_text('scene = "a.toml"\nfind = ["period"]\n[vary."links[0].mass"]\nvalues = [2000, 2500]\n')
    (tmp_path / "r.toml").write_text(plan.read_text().replace('find = ["period"]', ""))
    code, out, _ = run("sweep", plan, "--out", tmp_path / "s.csv")
    assert code == 0 and "period_1" in out
    table = (tmp_path / "s.csv").read_text()
    code, out, _ = run("sweep", tmp_path / "r.toml", "--out", tmp_path / "r.csv", "--speed", "Hz")
    assert code == 0 and re.search(r"angular_speed_1 \(Hz\) +0\.09", out)
    code, _, err = run("sweep", tmp_path / "r.toml", "--speed", "min")
    assert code == 2 and "--speed: must be one of rad/s, rpm, Hz, s, the unit of speeds in tables, got min; give a speed by" in err
    assert table.splitlines()[0].replace('"', "") == "point,links[0].mass,period_1,period_2,status"


@pytest.mark.slow  # twenty pictures
def test_pictures_take_every_unit():
    """Every drawing with speeds takes the four units, and says which one it drew."""
    results = [rc.modes(CHAIN), rc.response(CHAIN, angular_speed=[2.0, 6.0, 9.0]), rc.branches(CHAIN, max_angular_speed=6.0),
               rc.branch(CHAIN, 1, max_angular_speed=6.0), rc.campbell(CAROUSEL, np.linspace(0.4, 1.4, 9))]  # fmt: skip
    for found, unit in itertools.product(results, SPEED_UNITS):
        ax = found.plot(speed=unit)
        labels = [ax.get_xlabel(), *(label.get_text() for label in ax.get_xticklabels())]
        assert any(unit in label for label in labels), (type(found), unit)
        plt.close(ax.figure)
    periods = results[-1].plot(speed="s")
    assert periods.get_ylabel() == "period of the motion (s)"
    one = results[-1].crossings[0]
    dots = [line for line in periods.lines if line.get_marker() == "o"]
    assert dots[0].get_xdata()[0] == pytest.approx(2 * np.pi / one.angular_speed)
    assert dots[0].get_ydata()[0] == pytest.approx(2 * np.pi / one.angular_speed / one.order)


def test_the_summary_of_a_study_in_periods(tmp_path, run):
    """The lowest period belongs to the highest speed; the histogram has its proved ends as dotted lines."""
    data = {"scene": {"speed": "s", "links": [{"mass": 2500, "length": 6}, {"mass": 400, "length": 24}]}, "scatter": {"worst": True},
            "vary": {"links[0].mass": {"uniform": [2400, 2600]}}, "samples": 20}  # fmt: skip
    path = tmp_path / "study.json"
    path.write_text(json.dumps(data), encoding="utf-8")
    code, out, _ = run("sweep", path, "--out", tmp_path / "a.csv")
    low, high = (next(line for line in out.splitlines() if line.startswith(f"{end}_period_1 (s)")) for end in ("lowest", "highest"))
    assert code == 0 and float(low.split()[-1]) <= float(high.split()[-1]) and out.index(low) < out.index(high)
    assert "angular_speed" not in out and "\nperiod_1 (s)" in out
    found = rc.sweep({**data, "find": ["period"]})
    ax = plot_sweep(found)
    dotted = [line for line in ax.lines if line.get_linestyle() == ":" and len(line.get_xdata())]
    assert len(dotted) == 4 and "guaranteed worst case" in ax.get_legend_handles_labels()[1]
    both = rc.sweep({**data, "find": ["modes", "period"]})
    assert {"period", "lowest_period", "lowest_angular_speed", "conical_height"} <= set(both.data_vars)


def test_a_grid_of_a_count_with_equal_ratios():
    scene = {"links": [{"mass": 1.0, "length": 0.01, "repeat": 5}]}
    grid = {"from": 5, "to": 640, "steps": 8, "log": True}
    found = rc.Study.from_dict({"scene": scene, "vary": {"links[0].repeat": grid}})._plan("study").axes[0].values
    assert found.tolist() == [5, 10, 20, 40, 80, 160, 320, 640]
    with pytest.raises(rc.SceneError, match="makes numbers that are not whole, such as"):
        rc.Study.from_dict({"scene": scene, "vary": {"links[0].repeat": {**grid, "steps": 7}}})


@pytest.mark.parametrize(
    ("support", "vary", "modes"),
    [
        ({"mass": 300}, {}, 2), ({"stiffness": 1e5}, {}, 2), ({"stiffness": 1e5, "mass": 300}, {}, 3), ({}, {}, 2),
        ({"mass": 300}, {"support.stiffness": {"values": [1e4, 1e5]}}, 3),
    ],
)  # fmt: skip
def test_a_study_has_the_modes_that_exist(support, vary, modes):
    """A trolley that rolls freely adds no mode, nor a spring without mass to point masses; without flywheels nothing turns forward."""
    links = [{"mass": 2500, "length": 6}, {"mass": 400, "length": 24}]
    found = rc.sweep({"scene": {"links": links, "support": support}, "vary": {"links[0].mass": {"values": [2400, 2600]}, **vary}})
    assert found["angular_speed"].sizes["mode"] == modes and np.isfinite(found["angular_speed"].to_numpy()).all()
    assert not any("forward" in name or "backward" in name for name in found.data_vars)


def test_shapes_and_drag_at_two_speeds_are_refused():
    links = [{"mass": 1.0, "length": 1.0, "air_drag": {"coefficient": 1.1, "diameter": "5 mm"}}]
    scene = {"links": links, "support": {"radius": 0.5}, "ask": {"shapes": {"angular_speed": 2.0}, "drag": {"angular_speed": 2.0}}}
    speeds = {"values": [1.0, 2.0]}
    one, other = ({f"ask.{question}.angular_speed": speeds} for question in ("shapes", "drag"))
    for vary, stays in ((one, "drag"), (other, "shapes")):
        with pytest.raises(rc.SceneError, match=rf"leaves the speed of \[ask.{stays}\] as it is: write find"):
            rc.Study.from_dict({"scene": scene, "vary": vary, "find": ["shapes", "drag"]})
    assert rc.Study.from_dict({"scene": scene, "vary": one, "find": ["shapes"]}).points == 2
    assert rc.Study.from_dict({"scene": scene, "vary": {**one, **other}, "find": ["shapes", "drag"]}).points == 4


def test_equilibria_of_a_governor_speak_the_unit():
    found = rc.SleeveGovernor(ball_mass=2.3, arm=0.33, lower_arm=0.33, sleeve_mass=9.5122).equilibria("2.1 Hz")
    assert "2.10000 Hz (13.1947 rad/s)" in str(found)
    axes = found.plot()
    assert axes.get_xlabel() == "frequency (Hz)" and axes.lines[-1].get_xdata()[0] == pytest.approx(2.1)


def test_the_note_of_slack_links_speaks_the_unit():
    rig = rc.Rig(rc.Chain(mass=[1.0, 1.0], length=1.0), flywheels=rc.Flywheel(momentum=[-3.0, 0.0]))
    assert "links[0] goes slack at 31.2155 rpm" in str(rc.modes(rig, angular_speed=("1 rpm", "400 rpm")))
    assert "links[0] goes slack at a period of 1.92212 s" in str(rc.modes(rig, angular_speed=("60 s", "0.15 s")))
    assert "links[0] goes slack at 3.26888 rad/s" in str(rc.modes(rig))


def test_messages_quote_what_was_written():
    chain = rc.Chain(mass=[1.0, 3.0], length=1.0)
    with pytest.raises(ValueError, match=r"low < high, got \('60 rpm', '20 rpm'\)"):
        rc.modes(chain, angular_speed=("60 rpm", "20 rpm"))
    for system in (chain, rc.Cord(1.0)):
        with pytest.raises(ValueError, match="^revchain.count_modes: angular_speed must be positive and finite, got '-2 s'"):
            rc.count_modes(system, angular_speed="-2 s")
    with pytest.raises(ValueError, match="angular_speed must be positive and finite, got '-2 rpm'"):
        rc.steady_shapes(chain, angular_speed="-2 rpm")
