# SPDX-License-Identifier: GPL-3.0-or-later
"""Bifurcation diagrams: stability along branches, folds, pitchforks, tables of every point, and all postures."""

import csv
import io
import math
import pickle

import numpy as np
import pytest
from mechanics import plummets
from rigs import random_chain, rigged
from tier import by_tier

import revchain as rc
from revchain.plots.branches import LINES
from revchain.results.branches import Branch

CAROUSEL = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0))
TWO_SEATS = rc.Rig(rc.Chain(mass=90, length=[2.0, 2.0]), support=rc.Support(radius=0.5))
THREE = rc.Chain(mass=1.0, length=[1.0, 1.0, 1.0], names=["load", "hook", "rope"])


def some_system(seed):
    """A chain, a carousel, or one on a spring, of one to three links, and a height for the end of its diagram."""
    rng = np.random.default_rng(seed)
    size = 1 + seed % 3
    chain = random_chain(rng, size, spread=0.7, plummets=seed % 2 == 0)
    whole, length = chain.weight.sum(), chain.length.sum()
    system = chain
    if seed // 3 % 2:
        radius = 0.2 * length * rng.uniform()
        stiffness = rng.uniform(80, 200) * whole / length if seed // 6 % 2 else math.inf
        system = rigged(chain, radius=radius, stiffness=stiffness, carriage=0.2 * whole if stiffness < math.inf else 0.0)
    return rng, system, 0.2 * float(np.max(rc.modes(system).conical_height))


def drawn(axes):
    """The lines of branches by their styles, each with its points."""
    styles = {None if style == "-" else style[1]: verdict for verdict, style in LINES.items()}
    found = []
    for line in axes.lines:
        if len(line.get_xdata()) > 1 and line.get_linewidth() == 1.6:
            dashes = line._unscaled_dash_pattern[1]
            found.append((styles[dashes and tuple(dashes)], line.get_xydata()))
    return found


def marked(axes, marker):
    """Speeds of the marks of one form, without the one of the legend."""
    return sorted(line.get_xdata()[0] for line in axes.lines if line.get_marker() == marker and len(line.get_xdata()) == 1)


@pytest.mark.parametrize("seed", range(by_tier(6, 30)))
def test_verdicts_are_those_of_the_shapes(seed):
    rng, system, height = some_system(seed)
    for branch in rc.branches(system, min_conical_height=height):
        verdict = branch.verdict
        assert len(verdict) == len(branch) and (verdict[0] == "") == (branch.birth == "vertical")
        for k in rng.integers(1, len(branch), 8) if len(branch) > 1 else ():
            assert verdict[k] == branch.shape(int(k)).stability().verdict, k
        for window in branch.stability_windows():
            low, high = sorted(window.conical_height)
            inside = (branch.arc > window.arc[0] + 1e-4) & (branch.arc < window.arc[1] - 1e-4)
            assert {verdict[k] for k in np.flatnonzero(inside)} <= {window.verdict}
            heights = branch.conical_height[inside]
            assert ((heights > low * (1 - 1e-9)) & (heights < high * (1 + 1e-9))).all()  # the speed is monotone


@pytest.mark.parametrize("seed", range(by_tier(6, 30)))
def test_pitchforks_are_the_modes_and_folds_are_the_folds(seed):
    pytest.importorskip("matplotlib")
    _, system, height = some_system(seed)
    diagram = rc.branches(system, min_conical_height=height)
    axes = diagram.plot()
    critical = rc.modes(system).angular_speed
    top = (9.80665 / height) ** 0.5
    off_axis = getattr(system, "support", None) is not None and system.support.radius > 0
    expected = [] if off_axis else sorted(critical[(critical > 0) & (critical < top)])
    np.testing.assert_allclose(marked(axes, "o"), expected, rtol=1e-13)
    folds = sorted(speed for branch in diagram for speed in branch.angular_speed[branch.folds])
    np.testing.assert_allclose(marked(axes, "D"), folds, rtol=1e-14)
    above = [label.get_text() for each in axes.child_axes for label in each.get_xticklabels()]
    said = {f"fold {speed:#.4g}" for speed in folds} | {f"pitchfork {speed:#.4g}" for speed in expected}
    assert set(above) <= said and (len(above) > 0) == (len(said) > 0)
    if len(said) == 1:
        assert set(above) == said


def test_the_inward_branch_of_a_carousel_changes_its_style_at_the_fold():
    """One thread: sin d = -(b/l)^(1/3) at the fold, where lambda = l (1 - (b/l)^(2/3))^1.5."""
    pytest.importorskip("matplotlib")
    diagram = rc.branches(CAROUSEL, max_angular_speed=4.0)
    fold = (9.80665 / (4 * (1 - (1 / 4) ** (2 / 3)) ** 1.5)) ** 0.5
    low = -math.degrees(math.asin((1 / 4) ** (1 / 3)))
    for frame, inner in (("free", "spectrally stable"), ("driven", "minimum")):
        (outward,), lines = drawn(diagram[:1][0].plot(frame=frame)), drawn(diagram[1].plot(frame=frame))
        assert outward[0] == "minimum" and len(outward[1]) == len(diagram[0])
        styles = {verdict: points for verdict, points in lines}
        assert len(lines) == 2 and "unstable" in styles and set(styles) - {"unstable"} == {inner}
        for verdict, points in lines:
            assert points[:, 0].min() == pytest.approx(fold, rel=1e-6)
            end = points[np.argmin(points[:, 0])]
            assert end[1] == pytest.approx(low, abs=0.05)
        turned = [diagram[1].shape(k).stability(frame=frame).verdict for k in (0, -1)]
        assert [verdict for verdict, _ in lines] == turned
    assert marked(diagram.plot(), "D") == [pytest.approx(fold, rel=1e-12)]
    assert marked(diagram.plot(), "x") == []  # the change at the fold is no other change


def test_what_is_drawn_of_the_stability(monkeypatch):
    pytest.importorskip("matplotlib")
    diagram = rc.branches(THREE, max_angular_speed=14.0)
    words = [text.get_text() for text in diagram.plot().get_legend().get_texts()]
    assert words == ["1 half wave", "2 half waves", "3 half waves", "minimum (stable)", "spectrally stable", "unstable", "fold",
                     "pitchfork", "change of stability"]  # fmt: skip
    plain = diagram.plot(stability=False)
    assert {verdict for verdict, _ in drawn(plain)} == {"minimum"} and len(drawn(plain)) == 4 and marked(plain, "x") == []
    assert {verdict for verdict, _ in drawn(diagram.plot(frame="driven"))} == {"minimum", "unstable"}
    edges = [each.angular_speed[1] for each in diagram.stability_windows() if each.change != "end"]
    crosses = marked(diagram.plot(), "x")  # between two points a picture is interpolated
    assert crosses and all(min(abs(at / edge - 1) for edge in edges) < 5e-3 for at in crosses)
    # what would take long is left out unless it is asked for, or known
    for module in ("revchain.results.branches", "revchain.plots.branches"):
        monkeypatch.setattr(f"{module}.MOST_JUDGED", 100)
    fresh = rc.branches(THREE, max_angular_speed=14.0)
    assert {verdict for verdict, _ in drawn(fresh.plot())} == {"minimum"}
    assert "verdict" not in fresh.to_dataframe() and "verdict" not in fresh[0].to_dict()["points"][3]
    assert len({verdict for verdict, _ in drawn(fresh.plot(stability=True))}) == 3
    asked = rc.branches(THREE, max_angular_speed=14.0, stability=True)
    assert "verdict" in asked.to_dataframe() and len({verdict for verdict, _ in drawn(asked.plot())}) == 3
    for wrong, error, words in (
        ({"stability": 1}, TypeError, "stability must be True or False"),
        ({"frame": "fixed"}, ValueError, "frame must be 'free' or 'driven'"),
    ):
        with pytest.raises(error, match=rf"revchain.Branches.plot: {words}"):
            diagram.plot(**wrong)


def test_a_held_chain_is_drawn_with_its_stability_and_a_cord_without():
    pytest.importorskip("matplotlib")
    blade = rc.branches(rc.Held(rc.Chain.uniform_rods(5, length=1.0, mass=1.0), span=0.7), max_angular_speed=20.0)
    for branch in blade:
        points = [branch.shape(k).stability().verdict for k in range(len(branch))]
        assert list(branch.verdict) == points
        runs = [each for k, each in enumerate(points) if k == 0 or each != points[k - 1]]
        assert [verdict for verdict, _ in drawn(branch.plot())] == runs
    cord = rc.branches(rc.Cord(1.0), max_angular_speed=9.0)
    assert {verdict for verdict, _ in drawn(cord.plot())} == {"minimum"} and not hasattr(cord[0], "verdict")
    for call in (lambda: cord.plot(stability=True), lambda: rc.branches(rc.Cord(1.0), max_angular_speed=9.0, stability=True)):
        with pytest.raises(ValueError, match="each verdict of a cord takes long"):
            call()
    with pytest.raises(ValueError, match=r"revchain.Branches.stability_windows: is for chains"):
        cord.stability_windows()


def test_a_folded_cord_is_undecided():
    branch = rc.branch(rc.Held(rc.Cord(1.0, mass=1.0), span=0.7), 1, max_angular_speed=15.0)
    assert branch.end == "folded"
    found = branch.shape(200).stability()
    assert found.verdict == "undecided" and math.isnan(found.growth_rate)


def test_windows_in_one_table():
    diagram = rc.branches(THREE, max_angular_speed=14.0)
    windows = diagram.stability_windows()
    assert list(windows) == [window for branch in diagram for window in branch.stability_windows()]
    assert windows.branch.tolist() == [k for k, branch in enumerate(diagram) for _ in branch.stability_windows()]
    lines = repr(windows).splitlines()
    assert len(lines) == 2 + len(windows) and "from speed (rad/s)" in lines[1] and "to speed (rad/s)" in lines[1]
    assert f"{windows[0].angular_speed[0]:#.6g}" in lines[2]
    for unit, heading, per in (("rpm", "from speed (rpm)", lambda n: n * 30 / np.pi), ("s", "to period (s)", lambda n: 2 * np.pi / n)):
        text = repr(diagram.stability_windows(speed=unit)).splitlines()
        assert heading in text[1] and f"{per(windows[0].angular_speed[0]):#.6g}" in text[2]
        assert diagram.stability_windows(speed=unit).to_dataframe()["start_speed"].tolist() == windows.start_speed.tolist()
    assert windows.to_dict()["windows"][0]["verdict"] == "minimum"
    for branch in diagram:
        own = branch.stability_windows()
        assert own.branch is None and "branch " not in repr(own).splitlines()[1]
        assert [each.change for each in own][-1] == "end"
        for before, after in zip(own[:-1], own[1:], strict=True):
            assert before.arc[1] == after.arc[0] and before.conical_height[1] == after.conical_height[0]
            assert (before.verdict == after.verdict) <= (before.change == "fold")
    with pytest.raises(ValueError, match="revchain.Branch.stability_windows: speed must be one of rad/s, rpm, Hz, s, got 'turns'"):
        diagram[0].stability_windows(speed="turns")


def test_changes_of_stability_are_what_they_are_called():
    """A fold of the angular momentum is its extremum; where frequencies meet, the exponents are complex beyond."""
    born = rc.branches(THREE, max_angular_speed=14.0)[3]
    windows = born.stability_windows()
    assert [each.change for each in windows] == ["fold", "momentum fold", "Hamiltonian Hopf", "end"]
    assert windows[0].angular_speed[1] == pytest.approx(born.angular_speed[born.folds[0]], rel=1e-9)
    edge = windows[1].angular_speed[1]
    momentum = [born.at(edge + off)[1].angular_momentum for off in (-0.02, -0.01, 0.0, 0.01, 0.02)]
    assert np.argmin(momentum) == 2
    meeting = windows[2].angular_speed[1]
    exponents = born.at(meeting * 1.0005)[1].stability().exponents
    growing = exponents[np.argmax(exponents.real)]
    assert growing.real > 1e-3 and abs(growing.imag) > 0.1
    rubbing = rc.Rig(CAROUSEL.chain, support=CAROUSEL.support, pins=rc.Pin(damping=20.0))
    assert "Hamiltonian Hopf" not in {each.change for each in rc.branches(rubbing, max_angular_speed=4.0).stability_windows()}


def test_a_link_that_passes_the_vertical_is_decided():
    """Its changes relative to its own inclination are rounding; a window of 0.006 along the branch was undecided."""
    inwards = rc.branches(TWO_SEATS, max_angular_speed=8.0)[1]
    assert (np.diff(np.sign(inwards.inclination[:, 1])) != 0).any()
    for frame in ("free", "driven"):
        assert "undecided" not in {window.verdict for window in inwards.stability_windows(frame=frame)}


def test_every_point_is_in_the_long_table():
    pytest.importorskip("pandas")
    diagram = rc.branches(THREE, max_angular_speed=14.0)
    assert len(repr(diagram).splitlines()) == 2 + len(diagram)
    table = diagram.to_dataframe()
    assert len(table) == sum(map(len, diagram)) and set(table["branch"]) == set(range(len(diagram)))
    columns = [f"inclination_link_{k}_{name}" for k, name in enumerate(THREE.names)]
    for number, branch in enumerate(diagram):
        rows = table[table["branch"] == number]
        assert rows["point"].tolist() == list(range(len(branch))) and set(rows["mode"]) == {diagram.mode[number]}
        np.testing.assert_array_equal(rows[columns], branch.inclination)
        for name in ("angular_speed", "conical_height", "tip_radius", "top_tension", "half_waves", "arc"):
            np.testing.assert_array_equal(rows[name], getattr(branch, name))
        assert np.flatnonzero(rows["fold"]).tolist() == branch.folds.tolist()
        assert tuple(rows["verdict"]) == branch.verdict
        shape = branch.shape(len(branch) // 2)
        np.testing.assert_allclose(rows[columns].iloc[len(branch) // 2], shape.inclination, rtol=0, atol=1e-12)
        alone = branch.to_dataframe()
        assert [name for name in alone if name.startswith("inclination")] == columns and len(alone) == len(branch)
    data = diagram.to_dict()
    assert [each["points"] for each in data["branches"]] == [len(branch) for branch in diagram]
    assert len(data["points"]) == len(table) and data["points"][70]["verdict"] == table["verdict"].iloc[70]
    unnamed = rc.branches(rc.Chain(mass=1.0, length=[1.0, 1.0]), max_angular_speed=6.0).to_dataframe()
    assert [name for name in unnamed if name.startswith("inclination")] == ["inclination_link_0", "inclination_link_1"]
    none = rc.branches(THREE, min_conical_height=10.0)
    assert len(none.to_dataframe()) == 0 and none.to_dict()["points"] == [] == list(none.stability_windows())


def test_the_command_line_writes_every_point(tmp_path, monkeypatch, run):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "three.toml").write_text(
        "".join(f'[[links]]\nname = "{name}"\nmass = 1\nlength = 1\n' for name in THREE.names) + "[ask.branches]\nmax_angular_speed = 9\n"
    )
    table = rc.branches(THREE, max_angular_speed=9.0).to_dataframe()
    code, out, _ = run("branches", "three.toml", "--csv", "-")
    rows = list(csv.DictReader(io.StringIO(out)))
    assert code == 0 and [row["verdict"] for row in rows] == table["verdict"].tolist()
    for name in ("angular_speed", "inclination_link_0_load", "inclination_link_2_rope"):
        assert [float(row[name]) for row in rows] == table[name].tolist()
    code, out, _ = run("run", "three.toml")
    assert code == 0 and "windows of stability" not in out
    assert len((tmp_path / "out/three/branches.csv").read_text().splitlines()) == len(rows) + 1
    code, out, _ = run("branches", "three.toml", "--stability")
    many = len(rc.branches(THREE, max_angular_speed=9.0).stability_windows())
    assert code == 0 and f"{many} windows of stability of 3 branches" in out
    code, out, _ = run("branches", "three.toml", "--no-hanging-only")
    assert code == 0 and "Branches in every posture" in out and "load, hook" in out


def test_scenes_ask_for_postures_and_stability(tmp_path):
    links = [{"name": name, "mass": 1.0, "length": 1.0} for name in THREE.names]
    asked = {"max_angular_speed": 9.0, "hanging_only": False, "stability": True}
    found = rc.Scene.from_dict({"links": links, "ask": {"branches": asked}}).branches()
    assert found == rc.branches(THREE, **asked) and "verdict" in found[0].__dict__
    cord = {"cord": {"length": 1.0, "mass": 1.0}, "ask": {"branches": {"max_angular_speed": 9.0, "hanging_only": False}}}
    with pytest.raises(rc.SceneError, match="ask.branches.hanging_only: is for a chain that hangs, got false"):
        rc.Scene.from_dict(cord)


def test_a_speed_is_all_that_at_needs():
    branch = rc.branch(plummets(2), 1, min_conical_height=0.1)
    assert branch.at(7.0) == branch.at(angular_speed=7.0) and len(branch.at(7.0)) == 1
    assert branch.at("60 rpm")[0].angular_speed == pytest.approx(2 * np.pi, rel=1e-15)
    assert branch.at("1 rpm") == ()
    assert branch.at(conical_height=0.2)[0].conical_height == pytest.approx(0.2, rel=1e-15)
    for wrong, words in (
        (lambda: branch.at(), "give exactly one of conical_height and angular_speed, got none"),
        (lambda: branch.at(7.0, conical_height=0.2), "got conical_height and angular_speed"),
        (lambda: branch.at("30 m"), "angular_speed"),
        (lambda: branch.at(0.0), "angular_speed must be positive"),
    ):
        with pytest.raises(ValueError, match=rf"revchain.Branch.at: .*{words}"):
            wrong()


# ---- all postures


def listed(system, height, **given):
    found = rc.steady_shapes(system, conical_height=height, hanging_only=False, **given)
    assert not len(found.undecided)
    return sorted(tuple(shape.inclination) for shape in found)


@pytest.mark.parametrize("seed", range(by_tier(8, 64)))
def test_branches_of_all_postures_hold_every_shape_there_is(seed):
    """Rigs with springs, arms, wheels and fluids: at any height the branches pass each shape of the proved list once."""
    rng = np.random.default_rng(seed)
    size = 1 + seed % 3
    chain = random_chain(rng, size, spread=0.7, plummets=seed % 2 == 0)
    whole, length = chain.weight.sum(), chain.length.sum()
    rig = rigged(
        chain,
        stiffness=rng.uniform(40, 200) * whole / length if seed & 1 else math.inf,
        carriage=0.2 * whole if seed & 1 else 0.0,
        radius=0.2 * length * rng.uniform() if seed & 2 else 0.0,
        momentum=rng.uniform(0, 0.2, size) * whole * length if seed & 4 else None,
        displaced=chain.weight * rng.uniform(0, 0.5, size) if seed & 8 else None,
        inverted=rng.random(size) < 0.3 if seed & 16 else False,
    )
    first = float(np.max(rc.modes(chain, 1).conical_height))
    diagram = rc.branches(rig, min_conical_height=0.15 * first, hanging_only=False)
    assert diagram.consistent and not diagram.hanging_only
    for branch in diagram:
        stands = np.cos(branch.inclination) < 0
        assert (stands == branch.system.inverted).all()  # no link leaves its posture
    assert diagram[0].system is rig or not len(rc.branches(rig, min_conical_height=0.15 * first))
    for height in first * np.array([1.3, 0.77, 0.31, 0.16]):
        shapes = sorted(tuple(shape.inclination) for branch in diagram for shape in branch.at(conical_height=height))
        np.testing.assert_allclose(np.array(shapes).reshape(-1, size), np.array(listed(rig, height)).reshape(-1, size), rtol=0, atol=1e-12)


def test_postures_of_a_chain():
    diagram = rc.branches(THREE, max_angular_speed=9.0, hanging_only=False)
    hanging = rc.branches(THREE, max_angular_speed=9.0)
    assert diagram[: len(hanging)] == hanging[:] and not diagram.complete and diagram.consistent
    assert "proved complete in its own posture" in diagram.remark and "not excluded" in diagram.remark
    assert diagram.inverted[: len(hanging)] == ("none",) * 3 and "load, hook" in diagram.inverted and hanging.inverted is None
    assert "above their pins" in repr(diagram) and "above their pins" not in repr(hanging)
    for branch in diagram:
        if branch.birth == "vertical":  # pitchforks are modes of the straight chain in that posture
            speed = rc.modes(branch.system).angular_speed
            assert branch.angular_speed[0] == pytest.approx(sorted(speed[speed > 0])[branch.mode - 1], rel=1e-13)
        shape = branch.shape(len(branch) // 2)
        (same,) = [
            each
            for each in rc.steady_shapes(THREE, conical_height=shape.conical_height, hanging_only=False)
            if np.abs(each.inclination - shape.inclination).max() < 1e-9
        ]
        assert isinstance(same.system, rc.Chain)
        assert branch.verdict[len(branch) // 2] == same.stability().verdict == shape.stability().verdict
    assert set(diagram.to_dataframe()["inverted"]) == set(diagram.inverted)


def test_where_no_posture_has_a_shape_the_list_is_complete():
    first = float(rc.modes(THREE).conical_height[0])
    above = rc.branches(THREE, min_conical_height=1.0001 * first, hanging_only=False)
    assert len(above) == 0 and above.consistent
    pendulum = rc.branches(rc.Chain(mass=1.0, length=1.0), max_angular_speed=9.0, hanging_only=False)  # one link cannot stand
    assert pendulum.complete and len(pendulum) == 1


def test_postures_are_kept_in_files(tmp_path):
    diagram = rc.branches(TWO_SEATS, max_angular_speed=2.0, hanging_only=False, stability=True)
    diagram.save(tmp_path / "diagram.npz")
    windows = diagram.stability_windows(speed="rpm")
    windows.save(tmp_path / "windows.npz")
    assert rc.load(tmp_path / "windows.npz") == windows and repr(rc.load(tmp_path / "windows.npz")) == repr(windows)
    for twin in (rc.load(tmp_path / "diagram.npz"), pickle.loads(pickle.dumps(diagram))):
        assert twin == diagram and twin.inverted == diagram.inverted and "verdict" in twin[2].__dict__
        assert twin[-1].shape(-1) == diagram[-1].shape(-1) and twin[-1].system == diagram[-1].system


def test_postures_that_are_refused():
    for system in (rc.Cord(1.0), rc.Held(THREE, span=2.0)):
        with pytest.raises(ValueError, match="revchain.branches: hanging_only=False is for chains and rigs.*leave it out, got"):
            rc.branches(system, max_angular_speed=5.0, hanging_only=False)
    with pytest.raises(ValueError, match="at most 10 links, got 11; at one speed use steady_shapes with hanging_only=False"):
        rc.branches(plummets(11), max_angular_speed=5.0, hanging_only=False)
    for name in ("hanging_only", "stability"):
        with pytest.raises(TypeError, match=f"revchain.branches: {name} must be True or False, got 1"):
            rc.branches(THREE, max_angular_speed=5.0, **{name: 1})


def test_straight_branches_have_no_verdict():
    short = rc.branch(plummets(3), 1, min_conical_height=np.nextafter(rc.modes(plummets(3)).conical_height[0], 0))
    assert isinstance(short, Branch) and short.verdict[0] == "" and len(short.stability_windows()) == len(short) - 1


def test_links_in_tables_of_branches_count_as_listed():
    """As in all tables: a chain listed from the support has its link 0 there."""
    chain = rc.Chain(mass=[3.0, 1.0], length=1.0, names=["hook b", "load"], order="support first")
    table = rc.branches(chain, max_angular_speed=5.0).to_dataframe()
    one = rc.branch(chain, 1, max_angular_speed=5.0)
    names = ["inclination_link_1_load", "inclination_link_0_hook_b"]
    assert [name for name in table if name.startswith("inclination")] == names
    np.testing.assert_array_equal(one.to_dataframe()[names].to_numpy(), one.inclination)
