# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes, branches, inverse questions, stability and swing of cords; the numbers themselves are those of tests/cpp:
cord_branches.cpp, finite/cord/continuous_chain.cpp."""

import math

import numpy as np
import pytest

import revchain as rc

TIP = rc.Cord(1.0, mass=2.0, tip_mass=0.3)


def test_a_branch_and_its_shapes():
    branch = rc.branch(TIP, 2, max_angular_speed=30.0)
    assert branch.end == "height" and branch.mode == 2 and set(branch.half_waves) == {2} and not branch.folds.size
    assert branch.angular_speed[0] == pytest.approx(rc.modes(TIP, 2).angular_speed[1], rel=1e-14)
    assert branch.angular_speed[-1] == pytest.approx(30.0, rel=1e-15)
    (shape,) = branch.at(angular_speed=20.0)
    listed = rc.steady_shapes(TIP, angular_speed=20.0)[1]
    assert shape.offset[0] == pytest.approx(listed.offset[0], rel=1e-12) and shape.half_waves == 2
    assert branch.at(angular_speed=5.0) == ()
    last = branch.shape(-1)
    ends = {"tip_radius": last.offset[0], "top_tension": last.tension[-1], "lowest_inclination": last.inclination[0]}
    for name, value in ends.items():
        assert getattr(branch, name)[-1] == pytest.approx(value, rel=1e-12), name
    # the moment of inertia, by the trapezium rule on the shape
    arc = np.linspace(0.0, 1.0, 4001)
    by_hand = 0.3 * last.offset[0] ** 2 + 2.0 * np.trapezoid(last.along(arc).offset ** 2, arc)
    assert branch.moment_of_inertia[-1] == pytest.approx(by_hand, rel=1e-5)
    for wrong in (len(branch), -len(branch) - 1, 0):
        with pytest.raises(ValueError, match="point"):
            branch.shape(wrong)
    with pytest.raises(ValueError, match="branch.shape"):
        branch.stability_windows()


@pytest.mark.parametrize("cord", [rc.Cord(1.0), TIP, rc.Cord(2.0, density=lambda s: 1 + s, tip_weight=0.1)], ids=repr)
def test_inverse_questions_agree(cord):
    speed = 1.4 * rc.modes(cord, 1, first=2).angular_speed[0]
    shape = rc.steady_shape(cord, mode=2, angular_speed=speed)
    assert shape.angular_speed == pytest.approx(speed, rel=1e-15)
    for asked in (
        {"lowest_inclination": float(shape.inclination[0])},
        {"tip_radius": float(shape.offset[0])},
        {"top_tension": float(shape.tension[-1])},
        {"conical_height": shape.conical_height},
    ):
        again = rc.steady_shape(cord, mode=2, **asked)
        assert again.angular_speed == pytest.approx(speed, rel=1e-11)
        (same,) = rc.steady_shapes(cord, mode=2, **asked)
        assert same == again
        assert again.along(0.4 * cord.length).offset == pytest.approx(shape.along(0.4 * cord.length).offset, rel=1e-9)


def test_the_diagram():
    diagram = rc.branches(rc.Cord(1.0), max_angular_speed=25.0)
    assert [each.mode for each in diagram] == [1, 2, 3, 4, 5] and diagram.complete and diagram.consistent
    assert "proved complete: no branch of steady shapes is missing" in repr(diagram)
    assert rc.branches(TIP, max_angular_speed=16.0).complete  # a tip, too
    tapered = rc.Cord(1.0, mass=2.0, density=1.0, tip_mass=0.3)
    other = rc.branches(tapered, max_angular_speed=16.0)
    assert len(other) == 3 and other.consistent and not other.complete and other.looked_at.size == 16
    assert rc.branches(tapered, max_angular_speed=5.0).complete  # one mode


def test_stability_is_the_limit_of_links():
    shape = rc.steady_shape(TIP, mode=2, angular_speed=14.0)
    limit = shape.stability()
    assert limit.verdict == "spectrally stable" and limit.negative_directions == 2 and np.isnan(limit.internal_damping).all()
    slowest = np.sort(limit.exponents.imag[limit.exponents.imag > 0])[:4]
    off = []
    for links in (20, 40):
        found = rc.steady_shape(TIP.chain(links), mode=2, angular_speed=14.0).stability()
        assert found.verdict == limit.verdict
        off.append(np.abs(np.sort(found.exponents.imag[found.exponents.imag > 0])[:4] - slowest).max())
    assert math.log2(off[0] / off[1]) == pytest.approx(2.0, abs=0.1)
    drag = [rc.steady_shape(TIP.chain(40), mode=2, angular_speed=14.0).stability().external_damping.min()]
    assert limit.external_damping.min() == pytest.approx(drag[0], rel=0.1)
    assert shape.stability(frame="driven").verdict == "unstable"


NEXT_TO_THE_VERTICAL = [  # how many of the slowest exponents are compared: the amplitude moves faster ones further
    ({}, 10),
    ({"tip_weight": 0.3}, 10),
    ({"density": 1.0, "tip_weight": 0.2}, 10),
    ({"density": 1.0}, 10),
    ({"density": 0.5}, 10),
    ({"density": -0.4}, 10),
    ({"density": 2.3}, 6),
    ({"density": 0.5, "tip_weight": 0.1}, 10),
    ({"density": lambda s: 31.0 if 0.6 <= s < 0.611 else 1.0, "tip_weight": 0.1}, 10),
    ({"density": lambda s: 1.0 if s < 0.5 else 4.0}, 10),
    ({"density": lambda s: s**0.7 + 3.0 * (s > 1 / 3)}, 7),
]


@pytest.mark.parametrize(("options", "count"), NEXT_TO_THE_VERTICAL)
@pytest.mark.parametrize("mode", [1, 2])
def test_exponents_next_to_the_vertical(options, count, mode):
    """There a disturbance is a sum of modes, which swing with sqrt(height / height of the mode) times the speed."""
    cord = rc.Cord(1.0, weight=1.0, **options)
    modes = rc.modes(cord, 8)
    below = 1e-9
    height = modes.conical_height[mode - 1] * (1 - below)
    found = rc.steady_shape(cord, mode=mode, conical_height=height).stability()
    ratio = np.sqrt(height / modes.conical_height)
    expected = np.abs(np.concatenate([ratio - 1, ratio + 1]))
    for each in np.sort(expected[expected > 1e-3])[:count]:
        assert np.abs(found.exponents.imag - each).min() < 10 * below
    assert found.negative_directions == 2 * (mode - 1)


def test_swing():
    arc = np.linspace(0.0, 1.0, 21)
    by_function = rc.swing(TIP, [0.0, 0.7], offset=lambda s: 0.1 * (1 - s))
    assert by_function.arc_length.size == 101 and by_function.offset.shape == (2, 101)
    by_numbers = rc.swing(TIP, [0.0, 0.7], offset=0.1 * (1 - arc), velocity=np.zeros(21))
    np.testing.assert_allclose(by_numbers.offset, by_function.offset[:, ::5], atol=1e-15)
    kept = by_function.energy.sum() + by_function.energy_left_out
    assert kept == pytest.approx(9.80665 * (2.0 / 2 + 0.3) * 0.1**2 / 2, rel=1e-13)  # of the start
    thrown = rc.swing(TIP, 0.0, velocity=lambda s: 1 - s, arc_length=[0.0, 0.5], count=60)
    assert thrown.velocity[0] == pytest.approx([1.0, 0.5], abs=5e-3)
    assert thrown.energy.sum() + thrown.energy_left_out == pytest.approx(0.5 * (2.0 / 3 + 0.3), rel=1e-12)
    chain = rc.swing(TIP.chain(200), [0.7], offset=0.1 * np.linspace(1.0, 0.0, 201), count=60)
    assert by_function.offset[1, 0] == pytest.approx(chain.offset[0, 0], abs=1e-5)
    assert by_function.truncation_error.max() < 1e-4


def counted(cord, height):
    """As many shapes as critical heights, which is proved."""
    shapes = rc.steady_shapes(cord, conical_height=height)
    assert shapes.complete and [shape.half_waves for shape in shapes] == list(range(1, len(shapes) + 1))
    assert len(shapes) == rc.count_modes(cord, conical_height=height)
    return shapes


def test_lists():
    for ratio in (1.0, 1.45, 7.61, 7.62, 100.0, 500.0):
        shapes = counted(rc.Cord(ratio), 1.0)
    assert repr(shapes).startswith("14 shapes at 3.13156 rad/s (29.90 rpm), proved complete\n")
    assert len(shapes) == 14 and len(shapes[1:3]) == 2
    for options in ({"tip_weight": 0.3}, {"density": 2.0}, {"density": -0.5, "tip_weight": 0.2}):
        assert len(counted(rc.Cord(1.0, weight=1.0, **options), 0.02)) > 1
    by_speed = rc.steady_shapes(rc.Cord(2.0), angular_speed=10.0, gravity=9.81)
    by_height = rc.steady_shapes(rc.Cord(2.0), conical_height=0.0981)
    assert len(by_speed) == len(by_height) == 3
    np.testing.assert_allclose(by_speed[2].offset, by_height[2].offset, atol=1e-12)


def test_arrays_and_places_agree():
    for options in ({}, {"tip_weight": 0.3}, {"density": lambda s: 1 + s}):
        for shape in rc.steady_shapes(rc.Cord(1.0, **options), conical_height=0.01):
            assert shape.arc_length[0] == 0 and shape.arc_length[-1] == 1 and np.all(np.diff(shape.arc_length) >= 0)
            assert shape.offset[-1] == 0 and shape.height[-1] == 0 and shape.offset[0] > 0
            place = shape.along(shape.arc_length)
            for name in ("offset", "height", "inclination"):
                slack = 4 * shape.error_bound
                np.testing.assert_allclose(getattr(place, name), getattr(shape, name), atol=slack, rtol=0)
            np.testing.assert_allclose(place.tension, shape.tension, rtol=1e-9)
            assert np.tan(shape.inclination[0]) == pytest.approx(shape.offset[0] / 0.01, rel=1e-12)
            assert not shape.offset.flags.writeable
            assert shape.along(0.25).offset.shape == () and shape.along([[0.25]]).tension.shape == (1, 1)
            assert shape.error_bound < 2e-13 and shape.residual < 1e-14


def test_beads_have_more_shapes_than_critical_heights():
    def beads(s):
        return 0.01 + sum(math.exp(-(((s - at) / 0.05) ** 2)) / (0.05 * math.sqrt(math.pi)) for at in (0.15, 1.0, 2.0))

    cord = rc.Cord(3.0, density=beads)
    shapes = rc.steady_shapes(cord, conical_height=0.06)
    assert np.sum(rc.modes(cord, 4).conical_height > 0.06) == 3
    assert [shape.half_waves for shape in shapes] == [1, 2, 3, 3, 3]
    assert not shapes.complete and "5 shapes at" in repr(shapes) and "there may be more" in repr(shapes)


def test_pictures():
    pytest.importorskip("matplotlib")
    branch = rc.branch(TIP, 1, max_angular_speed=10.0)
    assert branch.plot().get_ylabel() == "inclination of the lowest link (degrees)"
    assert rc.branches(rc.Cord(1.0), max_angular_speed=10.0).plot().get_title() == "all branches of steady shapes: proved complete"
    shapes = rc.steady_shapes(rc.Cord(1.0), conical_height=0.05)
    ax = shapes.plot()
    assert ax.get_xlabel() == "distance from axis (m)" and ax.get_title() == "3 shapes, proved complete"
    assert shapes[0].plot(ax) is ax
    none = rc.steady_shapes(rc.Cord(1.0), conical_height=1.0)
    assert none.plot().get_title() == "0 shapes, proved complete"
    found = rc.swing(TIP, [0.0, 0.7], offset=lambda s: 0.1 * (1 - s))
    assert found.plot().get_ylabel() == "depth below the support (m)"
    assert found.plot(kind="time", pins=[0, 50]).get_xlabel() == "time (s)"
    with pytest.raises(ValueError, match="pins must be numbers from 0 to 100"):
        found.plot(kind="time", pins=[101])


def shapes_of(**asked):
    return rc.steady_shapes(rc.Cord(1.0), **{"conical_height": 0.1} | asked)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: rc.branch(TIP, 1, max_angular_speed=1.0), "must be greater"),
        (lambda: rc.branch(TIP, 10**6, max_angular_speed=1.0), "mode must be from 1 to 100000"),
        (lambda: rc.steady_shape(TIP, top_tension=20.0), "more than the weight 22.5553 of the cord, got 20$"),
        (lambda: rc.steady_shape(TIP, tip_radius=1.0), "less than the length of the cord"),
        (lambda: rc.steady_shape(TIP, mode=2, tip_radius=0.9), "is not met on the branch of mode 2"),
        (lambda: rc.swing(TIP, 0.0, offset=0.1), "offset must be a function of the distance from the free end, or numbers"),
        (lambda: rc.swing(TIP, 0.0, offset=[0.1, math.nan]), "offset must be finite"),
        (lambda: rc.swing(TIP, 0.0, offset=[0.1, 0.1]), "of the support must be 0"),
        (lambda: rc.swing(TIP, 0.0, offset=lambda s: "far"), r"offset\(.*\) must be a number"),
        (lambda: rc.swing(TIP, 0.0, offset=lambda s: float(s < 0.5)), "must be continuous"),
        (lambda: rc.swing(TIP, 0.0, offset=[0.1, 0.0], velocity=[0.0, 0.0, 0.0]), "velocity must have a number for each of the 2 places"),
        (lambda: rc.swing(TIP, 0.0, arc_length=[0.0, 2.0]), "arc_length must lie between 0 and the length 1"),
        (lambda: rc.swing(TIP, 0.0, count=0), "count must be"),
        (lambda: rc.swing(TIP.chain(2), 0.0, offset=[0.1, 0.0], arc_length=[0.0]), "arc_length is for a Cord"),
        (lambda: shapes_of(conical_height=-1.0), "conical_height must be positive"),
        (lambda: shapes_of(conical_height=1e-7), "at most 1e6"),
        (lambda: shapes_of(conical_height=None), "exactly one of .*, got none$"),
        (lambda: shapes_of(angular_speed=1.0), "exactly one of .*, got conical_height and angular_speed$"),
        (lambda: shapes_of(conical_height=None, angular_speed=1e300), "height of angular_speed must be positive .*, got 0"),
        (lambda: shapes_of(budget=0), "budget must be from 1 to 1000000 offsets of the free end of a cord, got 0"),
        *((lambda x=x: rc.Cord(1.0, tip_weight=x), "tip_weight must be") for x in ("heavy", "1")),
        (lambda: rc.Cord(1.0, density="thick"), r"density \(the exponent, or a function .*\) must be"),
        (lambda: rc.Cord(1.0, density=lambda s: -s), "must be positive"),
        (lambda: rc.Cord(1.0, density=lambda s: "heavy"), "density.* must be a number without a unit, got 'heavy'$"),
        *((lambda x=x: shapes_of()[0].along(x), "between 0 and the length") for x in (-0.1, 1.1, math.nan, [0.5, 2.0])),
    ],
)
def test_wrong_calls(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


@pytest.mark.parametrize(
    "ask", [lambda function: rc.swing(TIP, 0.0, offset=function), lambda function: rc.Cord(1.0, density=function)]
)
def test_an_error_of_a_function_comes_through(ask):
    def broken(s):
        raise KeyError("no such place")

    with pytest.raises(KeyError, match="no such place"):
        ask(broken)


def test_stability_of_branches_is_refused_at_once():
    for cord, most in ((rc.Cord(1.0), 0.1), (rc.Held(rc.Cord(1.0), span=0.5), 10.0)):
        with pytest.raises(ValueError, match=r"^revchain.branches: stability is for links, as each verdict of a cord takes long"):
            rc.branches(cord, max_angular_speed=most, stability=True)
    rig = rc.Rig(rc.Chain(mass=[1.0, 1.0], length=1.0), support=rc.Support(stiffness=100.0), pins=rc.Pin(damping=1.0))
    with pytest.raises(ValueError, match=r"^revchain.branches: with dashpots a support"):
        rc.branches(rig, max_angular_speed=6.0, stability=True)
