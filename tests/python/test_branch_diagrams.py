# SPDX-License-Identifier: GPL-3.0-or-later
"""Bifurcation diagrams: what is drawn agrees with the windows of stability and with the shapes along the branches."""

from itertools import combinations

import numpy as np
import pytest

import revchain as rc
from revchain.plots.branches import LINES

TOP_HEAVY = rc.Chain(mass=[1.0, 3.0], length=1.0)
BOTTOM_HEAVY = rc.Chain(mass=[3.0, 1.0], length=1.0)
CAROUSEL = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0))
TWO_SEATS = rc.Rig(rc.Chain(mass=[40.0, 80.0], length=2.0), support=rc.Support(radius=1.0))


@pytest.mark.parametrize("stability", [None, True])
def test_the_line_changes_at_the_ends_of_the_windows(stability):
    pytest.importorskip("matplotlib")
    diagram = rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0, stability=bool(stability))
    windows = diagram[1].stability_windows()
    assert windows.verdict == ("spectrally stable", "unstable", "spectrally stable")
    ax = diagram.plot(stability=stability)
    dashed, crosses = [
        [line for line in ax.lines if line.get_marker() == marker and len(line.get_xdata())] for marker in ("None", "x")
    ]
    assert sorted(line.get_xdata()[0] for line in crosses) == pytest.approx([9.49377, 9.68501], abs=2e-4)
    of_second = [line for line in dashed if line.get_xdata()[0] > 8.5 and np.ptp(line.get_xdata()) > 0]
    for line, window in zip(of_second, windows, strict=True):
        assert line.get_xdata()[[0, -1]] == pytest.approx(window.angular_speed, abs=2e-4)
        tip = [diagram[1].at(speed * (1 + side * 1e-9)) for speed, side in zip(window.angular_speed, (1, -1), strict=True)]
        exact = [np.degrees(shapes[0].inclination[0]) for shapes in tip]
        assert line.get_ydata()[[0, -1]] == pytest.approx(exact, abs=0.02)
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert "unstable" in labels and "change of stability" in labels


def test_large_systems_are_drawn_with_the_verdicts_at_their_points(monkeypatch):
    pytest.importorskip("matplotlib")
    diagram = rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0)
    monkeypatch.setattr("revchain.plots.branches.MOST_JUDGED", 1)
    coarse = diagram.plot(stability=True)
    drawn = {str(line.get_linestyle()) for line in coarse.lines}
    assert LINES["minimum"] in drawn
    assert "verdict" not in diagram[0].__dict__
    plain = rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0).plot()
    assert "minimum (stable)" not in [text.get_text() for text in plain.get_legend().get_texts()]


@pytest.mark.parametrize("hanging_only", [True, False])
@pytest.mark.parametrize("system", [TOP_HEAVY, BOTTOM_HEAVY, CAROUSEL, TWO_SEATS, rc.Chain.uniform_plummets(3, length=3.0)])
def test_speeds_above_the_frame_do_not_overlap(system, hanging_only):
    pytest.importorskip("matplotlib")
    ax = rc.branches(system, max_angular_speed=10.0, hanging_only=hanging_only).plot()
    ax.figure.draw_without_rendering()
    renderer = ax.figure._get_renderer()
    (above,) = ax.child_axes
    boxes = [label.get_window_extent(renderer) for label in above.get_xticklabels() if label.get_text()]
    assert boxes and not any(first.overlaps(second) for first, second in combinations(boxes, 2))


@pytest.mark.parametrize("system", [TOP_HEAVY, BOTTOM_HEAVY])
def test_no_line_crosses_the_picture_where_an_inclination_passes_180_degrees(system):
    pytest.importorskip("matplotlib")
    ax = rc.branches(system, max_angular_speed=10.0, hanging_only=False).plot()
    for line in ax.lines:
        if line.get_marker() == "None" and len(line.get_xdata()) > 2:
            assert np.abs(np.diff(line.get_ydata())).max(initial=0.0) < 60.0
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels[:3] == ["all links hang", "link 0 up", "link 1 up"]


@pytest.mark.parametrize("seed", range(6))
def test_half_waves_of_branches_are_those_of_their_shapes(seed):
    rng = np.random.default_rng(seed)
    size = int(rng.integers(1, 4))
    chain = rc.Chain(mass=rng.uniform(10.0, 80.0, size), length=rng.uniform(0.5, 2.0, size))
    rig = rc.Rig(chain, support=rc.Support(radius=float(rng.uniform(0.2, 3.0))))
    diagram = rc.branches(rig, max_angular_speed=5.0)
    for branch in diagram:
        for k in range(0, len(branch), 7):
            offset = branch.shape(k).offset
            assert branch.half_waves[k] == branch.shape(k).half_waves == 1 + np.count_nonzero(np.diff(np.sign(offset)))


def test_half_waves_count_the_crossing_between_support_and_tip():
    inward = rc.branches(CAROUSEL, max_angular_speed=8.0)[1]
    assert set(inward.half_waves.tolist()) == {2} == {shape.half_waves for shape in inward.at(7.0)}


@pytest.mark.parametrize(("system", "speed"), [(CAROUSEL, 3.0), (CAROUSEL, 7.0), (TWO_SEATS, 7.0), (BOTTOM_HEAVY, 20.0)])
def test_pictures_of_shapes_hold_all_pins(system, speed):
    pytest.importorskip("matplotlib")
    shapes = rc.steady_shapes(system, angular_speed=speed)
    ax = shapes.plot()
    ax.figure.draw_without_rendering()
    offset, depth = (np.concatenate([getattr(shape, name) for shape in shapes]) for name in ("offset", "height"))
    assert min(ax.get_xlim()) < offset.min() and offset.max() < max(ax.get_xlim())
    assert min(ax.get_ylim()) < -depth.max() and -depth.min() < max(ax.get_ylim())


@pytest.mark.parametrize("mode", [1, 2])
def test_windows_begin_where_the_branch_leaves_the_vertical(mode):
    branch = rc.branch(BOTTOM_HEAVY, mode, max_angular_speed=10.0)
    first = branch.stability_windows()[0]
    assert first.angular_speed[0] == branch.angular_speed[0] and first.arc[0] == 0.0
    assert first.angular_speed[0] == pytest.approx(rc.modes(BOTTOM_HEAVY).angular_speed[mode - 1], rel=1e-12)


def test_the_shape_at_the_speed_of_a_fold():
    for system in (CAROUSEL, TWO_SEATS, rc.Chain.uniform_plummets(3, length=3.0)):
        diagram = rc.branches(system, max_angular_speed=14.0)
        folded = [branch for branch in diagram if branch.folds.size]
        assert folded
        for branch in folded:
            fold = int(branch.folds[0])
            speed = float(branch.angular_speed[fold])
            near = branch.at(speed)
            assert 1 <= len(near) <= 2
            assert near[0].inclination == pytest.approx(branch.inclination[fold], abs=1e-6)
            assert branch.at(1e-3 * speed) == ()
    assert rc.branch(BOTTOM_HEAVY, 2, max_angular_speed=10.0).at("10.5 rad/s") == ()


SCENE = """
[[links]]
mass = 1.0
length = 1.0
[[links]]
mass = 3.0
length = 1.0
[ask.branches]
max_angular_speed = 10.0
"""


@pytest.fixture
def scene(tmp_path):
    def written(more):
        path = tmp_path / "scene.toml"
        path.write_text(SCENE + more)
        return path

    return written


def test_json_holds_the_windows(run, scene):
    import json

    code, out, _ = run("branches", scene(""), "--stability", "--json", "-")
    assert code == 0
    windows = json.loads(out)["stability_windows"]["windows"]
    direct = rc.branches(rc.load_scene(scene("")).system(), max_angular_speed=10.0).stability_windows()
    assert [each["verdict"] for each in windows] == list(direct.verdict)
    assert [each["end_speed"] for each in windows] == pytest.approx(direct.end_speed.tolist(), rel=1e-9)
    code, out, _ = run("branches", scene(""), "--json", "-")
    assert code == 0 and "stability_windows" not in json.loads(out)


def test_words_say_which_branches_are_complete(run, scene):
    from revchain.scenes.report import verdicts

    hanging = rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0)
    assert "no branch of hanging shapes is missing" in str(hanging)
    assert verdicts(hanging)[0].sentence.startswith("Complete: no branch of hanging shapes is missing")
    every = rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0, hanging_only=False)
    assert every._is_good() and not every.complete and verdicts(every)[0].kind == "open"
    one = rc.branches(rc.Chain(mass=[1.0], length=1.0), max_angular_speed=9.0)
    assert "no branch of steady shapes is missing" in str(one)
    code, out, err = run("branches", scene("hanging_only = false\n"))
    assert (code, err) == (0, "") and "loops between two of the heights looked at are not excluded" in " ".join(out.split())
    assert "hanging_only" not in run("shapes", scene("[ask.shapes]\nangular_speed = 9.0\n"))[1]


def test_a_search_that_ends_before_its_proof_fails():
    from revchain.scenes.report import shortfall

    with pytest.raises(ValueError, match="^revchain.branches: budget must not be negative, got -1$"):
        rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0, budget=-1)
    with pytest.raises(ValueError, match="^revchain.steady_shapes: budget must not be negative, got -1$"):
        rc.steady_shapes(BOTTOM_HEAVY, angular_speed=10.0, budget=-1)
    assert not rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0, budget=0).complete
    cut = rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0, budget=10)
    assert not cut._is_good() and shortfall(cut).startswith("the branches are not proved to be all: ")
    assert not rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0, budget=10, hanging_only=False)._is_good()
    few = rc.steady_shapes(BOTTOM_HEAVY, angular_speed=10.0, budget=3)
    assert not few._is_good() and "the shapes are not proved to be all" in shortfall(few)


def test_answers_name_a_speed_if_the_question_does():
    by_speed = rc.branches(BOTTOM_HEAVY, max_angular_speed=10.0)
    by_height = rc.branches(BOTTOM_HEAVY, min_conical_height=0.1)
    assert "largest speed" in str(by_speed) and "largest speed" not in str(by_height)
    assert "ends at largest speed" in str(rc.branch(BOTTOM_HEAVY, 1, max_angular_speed=10.0))
    assert by_speed[0].end == by_height[0].end == "height"
    with pytest.raises(ValueError, match=r"mode 2 leaves the vertical at 8\.55557 rad/s .*must be greater, got 7"):
        rc.branch(BOTTOM_HEAVY, 2, max_angular_speed=7)
    with pytest.raises(ValueError, match=r"at the conical height 0\.133974.* got 1$"):
        rc.branch(BOTTOM_HEAVY, 2, min_conical_height=1.0)
