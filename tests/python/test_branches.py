# SPDX-License-Identifier: GPL-3.0-or-later
"""Branches of steady shapes, single shapes on them, and the diagram."""

import math

import numpy as np
import pytest
from mechanics import plummets, rods

import revchain as rc
from revchain import _core


def test_one_link_is_the_conical_pendulum():
    chain = rc.Chain.uniform_plummets(1, length=2.0)
    for cosine in (1 - 1e-8, 0.9, 0.1, 1e-3):
        shape = rc.steady_shape(chain, conical_height=2.0 * cosine)
        assert abs(shape.inclination[0] - math.acos(cosine)) <= 1e-15 * max(1.0, shape.condition)
    branch = rc.branch(chain, 1, min_conical_height=0.2)
    assert np.allclose(np.cos(branch.lowest_inclination), branch.conical_height / 2, rtol=0, atol=1e-13)
    assert np.allclose(branch.tip_radius, 2 * np.sin(branch.lowest_inclination), rtol=0, atol=1e-13)
    assert np.allclose(branch.top_tension, 2 / branch.conical_height, rtol=1e-12)  # W sec d
    assert np.allclose(branch.moment_of_inertia, branch.tip_radius**2, rtol=1e-12)


def test_speed_and_height_are_two_words_for_one():
    chain = rc.Chain.uniform_rods(20, length=1.0)
    by_speed = rc.steady_shape(chain, mode=2, angular_speed=12.0)
    by_height = rc.steady_shape(chain, mode=2, conical_height=9.80665 / 144)
    assert np.abs(by_speed.inclination - by_height.inclination).max() <= 1e-14
    assert rc.branch(chain, 2, max_angular_speed=12.0).angular_speed[-1] == pytest.approx(12.0, rel=1e-12)


@pytest.mark.parametrize("make", [rc.Chain.uniform_plummets, rc.Chain.uniform_rods])
@pytest.mark.parametrize(("links", "mode"), [(2, 1), (2, 2), (3, 1), (3, 2), (3, 3), (7, 1), (7, 2), (60, 1), (60, 2)])
def test_what_is_asked_comes_back(make, links, mode):
    chain = make(links, length=1.0 if make == rc.Chain.uniform_rods else links)
    for share in (0.8, 0.6):
        height = share * rc.modes(chain, mode).conical_height[mode - 1]
        shape = rc.steady_shape(chain, mode=mode, conical_height=height)
        assert shape.conical_height == pytest.approx(height, rel=1e-15)
        assert shape.half_waves == mode
        tip = {"lowest_inclination": shape.inclination[0], "tip_radius": shape.offset[0]}
        for name, value in {**tip, "top_tension": shape.tension[-1]}.items():
            every = rc.steady_shapes(chain, mode=mode, **{name: value})
            assert every.mode == mode and every.angular_speed is None and every.speed.size == len(every)
            assert rc.steady_shape(chain, mode=mode, **{name: value}).conical_height == every[0].conical_height
            again = min(every, key=lambda state: abs(state.conical_height - height))
            assert again.conical_height == pytest.approx(height, rel=1e-13), name
            assert np.abs(again.inclination - shape.inclination).max() <= 1e-13, name


def test_the_diagram_holds_every_shape_there_is():
    """Other chains are checked in tests/cpp/branches.cpp."""
    diagram = rc.branches(plummets(4), min_conical_height=0.015)
    assert diagram.consistent and diagram.complete
    for height in (0.5, 0.1, 0.03, 0.0201):
        listed = rc.steady_shapes(plummets(4), conical_height=height)
        tips = [shape.inclination[0] for branch in diagram for shape in branch.at(conical_height=height)]
        assert np.allclose(sorted(tips), sorted(shape.inclination[0] for shape in listed), rtol=0, atol=1e-13)


def test_a_pair_is_born_on_no_branch_of_the_vertical():
    diagram = rc.branches(plummets(3), max_angular_speed=5.0, gravity=1.0)
    born = diagram[-1]
    assert [branch.mode for branch in diagram] == [1, 2, 3, None] and set(born.half_waves.tolist()) == {3}
    assert abs(born.angular_speed[born.folds[0]] - 3.90376215692) <= 1e-11
    assert len(born.at(angular_speed=4.5, gravity=1.0)) == 2
    assert born.at(angular_speed=3.9, gravity=1.0) == ()


def test_a_loop_between_the_heights_looked_at_is_found_by_the_proof():
    pytest.importorskip("matplotlib")
    chain = rc.Chain(weight=[12.1342, 26.048, 11.7601, 461.771], length=[1.4122, 2.89757, 7.23786, 1.03565])
    proved = rc.branches(chain, min_conical_height=0.0057 * chain.total_length)
    assert proved.complete and proved.remark == "proved complete: no branch is missing"
    (loop,) = [branch for branch in proved if branch.end == "closed"]
    assert loop.mode is None and len(loop.folds) == 2
    assert proved.plot().get_title() == "all branches of hanging shapes: proved complete"
    lists_alone = _core.branches(chain._compiled, 0.0057 * chain.total_length, 16, 3_000_000, 0, 9.8, 1)
    assert lists_alone.consistent and not lists_alone.complete and "not excluded" in lists_alone.remark
    assert len(proved) == len(lists_alone.branches) + 1


def test_all_states_of_one_branch():
    out_and_back = rc.steady_shapes(plummets(3), mode=2, tip_radius=0.53)
    assert len(out_and_back) == 2 and repr(out_and_back).startswith("2 shapes of the branch of mode 2\nshape  half waves  speed")
    assert out_and_back[0].conical_height > out_and_back[1].conical_height
    assert rc.steady_shape(plummets(3), mode=2, tip_radius=0.53).conical_height == out_and_back[0].conical_height
    assert len(rc.steady_shapes(plummets(3), mode=3, tip_radius=2.5)) == 0
    at_speed = rc.steady_shapes(plummets(3), mode=2, angular_speed=9.0)
    assert len(at_speed) == 1 and at_speed.angular_speed == 9.0 and at_speed.speed is None
    with pytest.raises(ValueError, match="tip_radius selects shapes of one branch; give mode, too, got tip_radius=2.5"):
        rc.steady_shapes(plummets(3), tip_radius=2.5)
    with pytest.raises(ValueError, match="mode is not available for a Held; use branches"):
        rc.steady_shapes(rc.Held(plummets(3), span=1.0), mode=1, angular_speed=9.0)


def test_windows_of_stability():
    chain = plummets(2)
    second = rc.modes(chain).conical_height[1]
    branch = rc.branch(chain, 2, min_conical_height=0.1 * second)
    stable, unstable = branch.stability_windows(tolerance=1e-9)
    assert (stable.verdict, unstable.verdict) == ("spectrally stable", "unstable")
    assert stable.conical_height[1] / second == pytest.approx(0.463321, abs=6e-7)
    assert stable.arc[1] == unstable.arc[0]
    assert stable.conical_height[1] == unstable.conical_height[0]
    assert {window.verdict for window in branch.stability_windows(frame="driven")} == {"unstable"}


def test_points_and_shapes_agree():
    branch = rc.branch(rc.Chain.uniform_rods(6, length=1.0), 3, min_conical_height=0.005)
    assert branch.end == "height" and len(branch) == branch.arc.size == branch.half_waves.size
    assert (np.diff(branch.arc) > 0).all()
    for point in (1, 5, -1):
        shape = branch.shape(point)
        assert shape.inclination[0] == pytest.approx(branch.lowest_inclination[point], abs=1e-12)
        assert shape.offset[0] == pytest.approx(branch.tip_radius[point], abs=1e-12)
        np.testing.assert_allclose(branch.inclination[point], shape.inclination, rtol=0, atol=1e-12)
        assert shape.conical_height == pytest.approx(branch.conical_height[point], rel=1e-12)
    for point, words in ((0, "straight chain"), (len(branch), "point must be from")):
        with pytest.raises(ValueError, match=words):
            branch.shape(point)


def test_pictures():
    pytest.importorskip("matplotlib")
    diagram = rc.branches(plummets(3), max_angular_speed=5.0, gravity=1.0)
    ax = diagram.plot()
    named = ["1 half wave", "2 half waves", "3 half waves", "minimum (stable)", "spectrally stable", "unstable"]
    named += ["fold", "pitchfork", "change of stability"]
    assert [text.get_text() for text in ax.get_legend().get_texts()] == named
    (above,) = ax.child_axes  # speeds of folds and pitchforks stand above the frame: no label hides a loop
    said = [f"pitchfork {speed:#.4g}" for speed in rc.modes(plummets(3), gravity=1.0).angular_speed]
    assert [text.get_text() for text in above.get_xticklabels()] == [*said, "fold 3.904"] and len(ax.texts) == 0
    for thing in (diagram, diagram[0]):
        quantities = ("lowest_inclination", "tip_radius", "top_tension", "moment_of_inertia", "effective_energy")
        labels = [thing.plot(quantity=quantity).get_ylabel() for quantity in quantities]
        ax.figure.canvas.draw()
        assert len(set(labels)) == 5 and labels[1].startswith("tip radius")
    with pytest.raises(ValueError, match="quantity must be one of"):
        diagram.plot(quantity="colour")
    empty = rc.branches(plummets(3), min_conical_height=10.0)
    assert len(empty) == 0 and empty.consistent
    assert empty.plot().get_title() == "no shape at or above this conical height"
    assert rc.branches(plummets(3), min_conical_height=0.5).plot().get_title() == "all branches of hanging shapes: proved complete"
    for chain in (plummets(3), rods(3)):  # next to the vertical: perhaps it alone
        for mode, critical in enumerate(rc.modes(chain).conical_height, 1):
            short = rc.branch(chain, mode, min_conical_height=np.nextafter(critical, 0))
            assert short.lowest_inclination[0] == 0 and (short.end == "height") == (len(short) > 1)
            short.plot()


def test_a_picture_goes_into_one_that_is_labelled():
    ax = pytest.importorskip("matplotlib.figure").Figure().add_subplot()
    ax.plot([1.0, 2.0], [0.0, 80.0], label="measured")
    assert rc.branches(plummets(2), min_conical_height=0.1).plot(ax, stability=False) is ax
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["1 half wave", "2 half waves", "measured", "pitchfork"]


THREE = rc.Chain(weight=1.0, length=[1.0, 1.0, 1.0])
LARGE = [{"lowest_inclination": 1.57}, {"tip_radius": 2.9999999}, {"top_tension": 3.00001}, {"top_tension": 3e3}]


@pytest.mark.parametrize("given", LARGE, ids=repr)
def test_large_amplitudes_are_met(given):
    shape = rc.steady_shape(THREE, **given)
    ((name, value),) = given.items()
    tip = {"lowest_inclination": shape.inclination[0], "tip_radius": shape.offset[0]}
    assert {**tip, "top_tension": shape.tension[-1]}[name] == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize("points", [1, 2, 7])
def test_max_points(points):
    assert len(rc.branch(plummets(3), 1, min_conical_height=0.1, max_points=points)) <= points


WRONG = [
    ({"conical_height": 0.1, "tip_radius": 1.0}, "tip_radius and top_tension, got conical_height and tip_radius$"),
    ({"mode": 3, "tip_radius": 2.5}, "not met on the branch of mode 3"),
    *(({"top_tension": x}, "top_tension must be more than the weight.*got") for x in (3.0, 2.0)),
    *(({"tip_radius": x}, "tip.radius.*got") for x in (3.0, 4.0, np.nan)),
    *(({"lowest_inclination": x}, "lowest_inclination must lie between 0 and pi/2.*got") for x in (np.pi / 2, 2.0)),
    ({"lowest_inclination": 0.0}, "lowest_inclination must be positive and finite, got 0"),
]


@pytest.mark.parametrize(("given", "message"), WRONG, ids=repr)
def test_shapes_that_are_not_there(given, message):
    with pytest.raises(ValueError, match=message):
        rc.steady_shape(THREE, **given)


def test_wrong_calls():
    chain = plummets(3)
    first = rc.modes(chain).conical_height[0]
    slow = r"angular speed must be greater than [\d.]+ rad/s, where mode 1 .*, got 1$"  # in the quantity that was given
    fast = 0.5 * rc.modes(plummets(300), 1, first=300).conical_height[0]  # its free end would be 1e-370 from the axis
    branch = rc.branch(chain, 1, min_conical_height=0.1)
    for call, words in (
        (lambda: rc.steady_shape(chain, mode=1, conical_height=first),
         r"conical height must be less than [\d.]+, where mode 1 leaves the vertical, got"),
        (lambda: rc.steady_shape(chain, mode=1, angular_speed=1.0), slow),
        (lambda: rc.steady_shape(rc.Cord(1.0), mode=1, angular_speed=1.0), slow),
        (lambda: rc.steady_shape(plummets(300), mode=300, conical_height=fast), "mode 300"),
        (lambda: branch.stability_windows(frame="fixed"), "frame must be"),
        (lambda: branch.stability_windows(tolerance=0.0), "tolerance must be positive"),
        (lambda: rc.steady_shape(chain, tip_radius=0.1, min_conical_height=first),
         "min_conical_height must be less than the conical height of the mode"),
    ):  # fmt: skip
        with pytest.raises(ValueError, match=words):
            call()
    for name, value in (("top_tension", 1e7), ("lowest_inclination", 1.5707963)):
        with pytest.raises(ValueError, match="give a smaller min_conical_height$"):
            rc.steady_shape(chain, **{name: value})
        assert rc.steady_shape(chain, **{name: value}, min_conical_height=1e-12).half_waves == 1
