# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of rigs, single shapes on them and the diagram: against the mechanics of tests/python/support/rigs.py."""

import math
import pickle

import numpy as np
import pytest
from rigs import figure_moments, random_chain, rigged

import revchain as rc

CAROUSEL = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=1.0))
G = 9.80665


def some_rig(rng, size, radius, stiffness, momentum):
    chain = random_chain(rng, size, spread=0.7, plummets=True)
    whole, length = chain.weight.sum(), chain.length.sum()
    return rigged(
        chain,
        stiffness=rng.uniform(40, 200) * whole / length if stiffness else math.inf,
        carriage=0.2 * whole if stiffness else 0.0,
        radius=0.2 * length * rng.uniform() if radius else 0.0,
        momentum=rng.uniform(0, 0.2, size) * whole * length if momentum else None,
    )


@pytest.mark.parametrize("seed", range(16))
def test_points_balance_and_cuts_are_the_lists(seed):
    rng = np.random.default_rng(seed)
    rig = some_rig(rng, 1 + seed % 3, *(bool(seed & bit) for bit in (1, 2, 4)))
    first = rc.modes(rig, 1).conical_height[0]
    diagram = rc.branches(rig, min_conical_height=0.15 * first)
    assert diagram.consistent and diagram.complete, diagram.remark
    for branch in diagram:
        assert branch.birth == ("fold" if branch.mode is None else "rest" if rig.support.radius else "vertical")
        for point in range(1, len(branch), 12):
            assert figure_moments(rig, branch.shape(point)) <= 1e-13
    for height in first * np.array([1.5, 0.8, 0.3, 0.16]):
        listed = rc.steady_shapes(rig, conical_height=height)
        on_branches = [shape for branch in diagram for shape in branch.at(conical_height=height)]
        assert listed.complete and len(on_branches) == len(listed)
        tips = sorted(shape.inclination[0] for shape in on_branches)
        assert np.allclose(tips, sorted(shape.inclination[0] for shape in listed), rtol=0, atol=1e-12)


def test_a_chair_on_an_arm_by_its_closed_form():
    """One thread: lambda tan d = b + l sin d; the pair inwards is born where both sides and their slopes agree."""
    out, inwards = rc.branches(CAROUSEL, max_angular_speed=4.0)
    for branch in (out, inwards):
        d = branch.lowest_inclination
        assert np.allclose(branch.conical_height * np.tan(d), 1 + 4 * np.sin(d), rtol=1e-10, atol=1e-10)
    assert (out.birth, inwards.birth, inwards.mode) == ("rest", "fold", None)
    assert out.folds.size == 0 and (np.diff(out.angular_speed) > 0).all()
    fold = inwards.lowest_inclination[inwards.folds[0]]
    assert np.sin(fold) == pytest.approx(-((1 / 4) ** (1 / 3)), abs=1e-6)  # sin d = -(b/l)^(1/3)
    height = 4 * np.cos(fold) ** 3
    assert inwards.conical_height.max() == pytest.approx(4 * (1 - (1 / 4) ** (2 / 3)) ** 1.5, rel=1e-12)
    assert height == pytest.approx(inwards.conical_height.max(), rel=1e-5)
    assert inwards.at(conical_height=0.9999 * inwards.conical_height.max())[0].inclination[0] < 0


def test_what_is_asked_of_the_branch_from_rest_comes_back():
    for speed in (1e-3, 0.1, 1.0, 3.0):
        shape = rc.steady_shape(CAROUSEL, angular_speed=speed)
        assert shape.angular_speed == pytest.approx(speed, rel=1e-15)
        (same,) = (s for s in rc.steady_shapes(CAROUSEL, angular_speed=speed) if s.inclination[0] > 0)
        assert np.abs(same.inclination - shape.inclination).max() <= 4.5e-16
        assert shape.stability().verdict == "minimum"
    tip = {"lowest_inclination": shape.inclination[0], "tip_radius": shape.offset[0], "top_tension": shape.tension[-1]}
    for name, value in tip.items():
        assert rc.steady_shape(CAROUSEL, **{name: value}).angular_speed == pytest.approx(3.0, rel=1e-13), name
        assert len(rc.steady_shapes(CAROUSEL, mode=1, **{name: value})) == 1
    assert rc.steady_shape(CAROUSEL, lowest_inclination="30 deg").conical_height == pytest.approx(3 / math.tan(math.pi / 6))


def test_windows_of_stability_of_a_rig():
    out, inwards = rc.branches(CAROUSEL, max_angular_speed=4.0)
    assert [window.verdict for window in out.stability_windows()] == ["minimum"]
    windows = inwards.stability_windows(tolerance=1e-9)
    assert {"unstable", "spectrally stable"} <= {window.verdict for window in windows}
    for window in windows:
        middle = np.argmin(np.abs(inwards.arc - np.mean(window.arc)))
        if window.arc[0] < inwards.arc[middle] < window.arc[1] and middle not in inwards.folds:
            assert inwards.shape(int(middle)).stability().verdict == window.verdict
    assert inwards.stability_windows(frame="driven")


def test_flywheels_tell_directions_apart():
    rig = rigged(rc.Chain(weight=[1.0, 2.0], length=[0.5, 0.7]), momentum=[0.05, 0.1])
    modes = rc.modes(rig)
    speeds = {direction: modes.angular_speed[modes.direction == direction] for direction in (1, -1)}
    for direction in (1, -1):
        branch = rc.branch(rig, 1, max_angular_speed=8.0, direction=direction)
        assert branch.direction == direction and branch.birth == "vertical"
        assert branch.angular_speed[0] == pytest.approx(abs(speeds[direction][0]), rel=1e-13)
        shape = branch.at(angular_speed=7.0)[0]
        listed = rc.steady_shapes(rig, angular_speed=7.0, direction=direction)
        assert min(np.abs(each.inclination - shape.inclination).max() for each in listed) < 1e-13
        assert shape.direction == direction and figure_moments(rig, shape, direction) <= 1e-13
        assert rc.branches(rig, max_angular_speed=8.0, direction=direction).complete
    assert rc.branch(rig, 1, max_angular_speed=8.0) != rc.branch(rig, 1, max_angular_speed=8.0, direction=-1)
    slack = rc.branch(rig, 1, max_angular_speed=12.0, direction=-1)  # 1 = 10 * 0.05 / 0.5: no tension at 10 rad/s
    assert slack.end == "slack" and slack.angular_speed[-1] == pytest.approx(10.0, rel=1e-4)
    assert "flywheels take the tension from links" in rc.branches(rig, max_angular_speed=12.0, direction=-1).remark


@pytest.mark.parametrize("momentum", [0.4, 1.0, 1.5, 2.3, 4.0])
def test_a_branch_ends_where_the_flywheel_takes_all_tension(momentum):
    """One link of 1 kg and 1 m: m g - h n falls to 0 at n = g / h, where its cosine (g - h n) / n^2 does too."""
    rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=momentum))
    slack = G / momentum
    branch = rc.branch(rig, 1, max_angular_speed=2 * slack, direction=-1)
    assert branch.end == "slack" and not len(branch.folds) and len(branch) < 400
    assert branch.angular_speed[-1] == pytest.approx(slack, rel=1e-7)
    cosine = (G - momentum * branch.angular_speed[1:]) / branch.angular_speed[1:] ** 2
    assert np.cos(branch.lowest_inclination[1:]) == pytest.approx(cosine, rel=1e-10, abs=1e-14)


def test_a_soft_spring_leaves_the_fastest_speeds_unproved():
    """Above sqrt(g E / W) a spring of stiffness E cannot hold a weight W against its own whirling."""
    rig = rigged(rc.Chain(weight=[1.0, 2.0], length=[0.5, 0.4]), stiffness=20.0, radius=0.1)  # 3 / 20 m
    diagram = rc.branches(rig, min_conical_height=0.14)
    assert not diagram.complete
    assert diagram.consistent and "between the heights 0.14" in diagram.remark and " and 0.15" in diagram.remark
    assert diagram[0].end == "loose" and diagram[0].conical_height[-1] == pytest.approx(0.15, rel=1e-3)
    with pytest.raises(ValueError, match="there the spring at the support no longer holds the whole"):
        rc.steady_shape(rig, conical_height=0.14)
    assert rc.branches(rig, min_conical_height=0.16).complete


def test_links_that_stand_and_floats():
    """No proof, and the remark says why; each shape is in the proved list."""
    standing = rigged(rc.Chain(weight=[1.0, 1.0], length=[0.5, 1.0]), radius=0.1, momentum=[-0.1, 0.0], inverted=[True, False])
    diagram = rc.branches(standing, max_angular_speed=0.5)
    assert not diagram.complete and "all hang in tension" in diagram.remark
    (shape,) = diagram[0].at(angular_speed=0.4)
    assert abs(shape.inclination[0]) > math.pi / 2 and figure_moments(standing, shape) <= 1e-14
    np.testing.assert_allclose(diagram[0].inclination[-1], diagram[0].shape(-1).inclination, rtol=0, atol=1e-12)
    listed = rc.steady_shapes(standing, angular_speed=0.4)
    assert min(np.abs(each.inclination - shape.inclination).max() for each in listed) < 1e-13
    back = rc.steady_shape(standing, tip_radius=shape.offset[0])
    assert back.angular_speed == pytest.approx(0.4, rel=1e-12)
    with pytest.raises(ValueError, match="between pi/2 and pi, since the lowest link stands"):
        rc.steady_shape(standing, lowest_inclination=1.0)


def test_results_are_values(tmp_path):
    pytest.importorskip("matplotlib")
    diagram = rc.branches(CAROUSEL, max_angular_speed=4.0)
    assert "from rest" in repr(diagram) and "from rest" in repr(diagram[0]) and "isolated" in repr(diagram[1])
    assert diagram[0].to_dict()["birth"] == "rest"
    assert diagram.plot().get_title() == "all branches of hanging shapes: proved complete" and diagram[1].plot()
    diagram.save(tmp_path / "diagram.npz")
    for twin in (pickle.loads(pickle.dumps(diagram)), rc.load(tmp_path / "diagram.npz")):
        assert twin == diagram and twin[1].birth == "fold"
        assert twin[0].shape(-1) == diagram[0].shape(-1)
        assert len(twin[1].stability_windows()) == len(diagram[1].stability_windows())


def test_wrong_calls():
    for ask in (rc.branch, rc.steady_shape):
        given = {"max_angular_speed": 4.0} if ask is rc.branch else {"angular_speed": 4.0}
        with pytest.raises(ValueError, match="mode must be 1, the branch from rest; branches lists those born in folds, got 2"):
            ask(CAROUSEL, mode=2, **given)
        with pytest.raises(ValueError, match="direction must be 1 or -1, got 0"):
            ask(CAROUSEL, mode=1, direction=0, **given)
    with pytest.raises(ValueError, match="tip radius must be less than the radius of the support and the length, got 5"):
        rc.steady_shape(CAROUSEL, tip_radius=5.0)
    with pytest.raises(ValueError, match="more than the weight that the topmost pin bears"):
        rc.steady_shape(CAROUSEL, top_tension=80 * G)
    branch = rc.branch(CAROUSEL, 1, max_angular_speed=2.0)
    with pytest.raises(ValueError, match="gravity must be that of the rig's branch"):
        branch.at(angular_speed=1.0, gravity=1.62)
    sprung = rigged(rc.Chain(weight=1.0, length=1.0), stiffness=30.0)
    with pytest.raises(ValueError, match="mode must be from 1 to the number of modes"):
        rc.branch(sprung, 7, max_angular_speed=9.0)


def test_rigs_of_every_posture_balance_all_along():
    """Links that stand or lean against their loads, in the axis and off it; some branches begin towards slower speeds."""
    rng = np.random.default_rng(1)
    rising = points = 0
    for k in range(60):
        size = int(rng.integers(1, 4))
        chain = rc.Chain(weight=np.exp(rng.uniform(-0.7, 0.7, size)), length=np.exp(rng.uniform(-0.7, 0.7, size)))
        whole, length = chain.weight.sum(), chain.length.sum()
        rig = rigged(
            chain,
            stiffness=rng.uniform(20, 200) * whole / length if k % 3 == 0 else math.inf,
            radius=0.1 if k % 5 == 0 else 0.0,
            momentum=rng.uniform(-0.3, 0.3, size) * whole * length if k % 2 else None,
            inverted=rng.random(size) < 0.4,
            displaced=chain.weight * rng.uniform(0, 1.5, size) if k % 7 == 0 else None,
        )
        modes = rc.modes(rig)
        forward = modes.conical_height[modes.direction == 1]
        for branch in rc.branches(rig, min_conical_height=0.3 * max(forward, default=1.0)):
            rising += branch.birth == "vertical" and len(branch) > 1 and branch.conical_height[1] > branch.conical_height[0]
            if branch.end == "slack":  # its links come to the horizontal
                continue
            for point in range(1, len(branch), max(1, len(branch) // 4)):
                shape = branch.shape(point)
                points += 1
                assert figure_moments(rig, shape) <= 1e-12 * (1 + abs(shape.offset[-1]) / length)
    assert rising > 0 and points > 100


def test_a_rig_that_is_a_plain_chain_has_windows_of_stability():
    chain = rc.Chain(mass=[1.0, 1.0], length=1.0)
    of_rig, of_chain = (rc.branches(each, max_angular_speed=8.0)[0] for each in (rc.Rig(chain), chain))
    assert [w.verdict for w in of_rig.stability_windows()] == [w.verdict for w in of_chain.stability_windows()]


def test_a_branch_that_rises_is_not_followed_down():
    rig = rc.Rig(rc.Chain(mass=[2.79], length=[0.21356]), inverted=[True], support=rc.Support(stiffness=24.107))
    slowest = rc.modes(rig).angular_speed[0]
    with pytest.raises(ValueError, match="revchain.branch: mode 1 leaves the vertical at"):
        rc.branch(rig, 1, max_angular_speed=0.9 * slowest)
    assert len(rc.branch(rig, 1, max_angular_speed=1.01 * slowest)) > 10
