# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of cords from Python; the numbers themselves are tests/cpp/finite/cord/continuous_chain.cpp's."""

import math

import numpy as np
import pytest

import revchain as rc
from revchain import Cord


def test_counted_by_the_critical_heights():
    for ratio in (1.0, 1.45, 7.61, 7.62, 100.0, 500.0):
        shapes = rc.steady_shapes(Cord(ratio), conical_height=1.0)
        assert shapes.complete
        assert len(shapes) == np.sum(rc.modes(Cord(ratio), 20).conical_height > 1.0)
        assert [shape.half_waves for shape in shapes] == list(range(1, len(shapes) + 1))
    assert repr(shapes).startswith("14 shapes at 3.13156 rad/s (29.90 rpm), proved complete\n")
    assert len(shapes[1:3]) == 2


@pytest.mark.parametrize("options", [{"tip_weight": 0.3}, {"density": 2.0}, {"density": -0.5, "tip_weight": 0.2}])
def test_counted_with_a_tip_or_a_power(options):
    cord = Cord(1.0, weight=1.0, **options)
    shapes = rc.steady_shapes(cord, conical_height=0.02)
    assert shapes.complete and len(shapes) == rc.count_modes(cord, conical_height=0.02) > 1


def test_arrays_and_places_agree():
    for options in ({}, {"tip_weight": 0.3}, {"density": lambda s: 1 + s}):
        for shape in rc.steady_shapes(Cord(1.0, **options), conical_height=0.01):
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


def test_speed_and_height_are_one():
    by_speed = rc.steady_shapes(Cord(2.0), angular_speed=10.0, gravity=9.81)
    by_height = rc.steady_shapes(Cord(2.0), conical_height=0.0981)
    assert len(by_speed) == len(by_height) == 3
    np.testing.assert_allclose(by_speed[2].offset, by_height[2].offset, atol=1e-12)


def test_small_amplitude_is_the_linear_mode():
    mode = rc.modes(Cord(1.0), 1, first=2)
    shape = rc.steady_shapes(Cord(1.0), conical_height=mode.conical_height[0] * (1 - 1e-6))[1]
    s = np.linspace(0, 1, 11)
    np.testing.assert_allclose(shape.along(s).offset / shape.offset[0], mode.along(s)[0], atol=1e-5)


def test_many_links_come_near():
    links = rc.steady_shapes(Cord(1.0).chain(8), conical_height=0.1)
    shapes = rc.steady_shapes(Cord(1.0), conical_height=0.1)
    assert len(links) == len(shapes) == 2
    for chain, curve in zip(links, shapes, strict=True):
        assert np.abs(chain.offset - curve.along(np.linspace(0, 1, 9)).offset).max() < 0.02


@pytest.mark.parametrize("tip", [0.0, 0.3])
def test_critical_heights_with_a_tip(tip):
    series = rc.modes(Cord(2.0, density=lambda s: 1.0, tip_weight=tip), 5)
    closed = rc.modes(Cord(2.0, weight=2.0, tip_weight=tip), 5)
    assert series.method == "power series" != closed.method
    np.testing.assert_allclose(series.conical_height, closed.conical_height, rtol=4e-15)


def test_critical_heights_of_a_power():
    heights = rc.modes(Cord(2.0, density=lambda s: 3 * s**1.5), 4).conical_height
    np.testing.assert_allclose(heights, rc.modes(Cord(2.0, density=1.5), 4).conical_height, rtol=4e-15)


def test_beads_have_more_shapes_than_critical_heights():
    def beads(s):
        return 0.01 + sum(math.exp(-(((s - at) / 0.05) ** 2)) / (0.05 * math.sqrt(math.pi)) for at in (0.15, 1.0, 2.0))

    cord = Cord(3.0, density=beads)
    shapes = rc.steady_shapes(cord, conical_height=0.06)
    assert np.sum(rc.modes(cord, 4).conical_height > 0.06) == 3
    assert [shape.half_waves for shape in shapes] == [1, 2, 3, 3, 3]
    assert not shapes.complete
    assert "5 shapes at" in repr(shapes) and "there may be more" in repr(shapes)


def test_pictures():
    shapes = rc.steady_shapes(Cord(1.0), conical_height=0.05)
    ax = shapes.plot()
    assert ax.get_xlabel() == "distance from axis (m)" and ax.get_title() == "3 shapes, proved complete"
    assert shapes[0].plot(ax) is ax
    assert rc.steady_shapes(Cord(1.0), conical_height=1.0).plot().get_title() == "0 shapes, proved complete"


def test_an_error_of_the_density_comes_through():
    def broken(s):
        raise KeyError("no such place")

    with pytest.raises(KeyError, match="no such place"):
        Cord(1.0, density=broken)


@pytest.mark.parametrize(
    ("cord", "asked", "message"),
    [
        ({"length": 0.0}, {}, "length must be positive"),
        ({"length": math.nan}, {}, "length must be positive"),
        ({"length": [1.0, 2.0]}, {}, "length must be a single number"),
        ({}, {"conical_height": -1.0}, "conical_height must be positive"),
        ({}, {"conical_height": 1e-7}, "at most 1e6"),
        ({}, {"conical_height": None}, "exactly one of .*, got none$"),
        ({}, {"angular_speed": 1.0}, "exactly one of .*, got conical_height and angular_speed$"),
        ({}, {"conical_height": None, "angular_speed": 1e300}, "height of angular_speed must be positive .*, got 0"),
        ({"tip_weight": -0.1}, {}, "tip_weight must be finite and not negative, got -0.1"),
        ({"tip_weight": "heavy"}, {}, "tip_weight must be"),
        ({"tip_weight": "1"}, {}, "tip_weight must be"),
        ({"density": "thick"}, {}, r"density \(the exponent, or a function .*\) must be"),
        ({"density": -1.0}, {}, "exponent"),
        ({"density": lambda s: -s}, {}, "must be positive"),
        ({"density": lambda s: "heavy"}, {}, "density.* must be a number without a unit, got 'heavy'$"),
        ({}, {"budget": 0}, "budget must be from 1 to 1000000 offsets of the free end of a cord, got 0"),
    ],
)
def test_wrong_calls(cord, asked, message):
    with pytest.raises(ValueError, match=message):
        rc.steady_shapes(Cord(**{"length": 1.0} | cord), **{"conical_height": 0.1} | asked)


@pytest.mark.parametrize("wrong", [-0.1, 1.1, math.nan, [0.5, 2.0]])
def test_places_outside_are_refused(wrong):
    with pytest.raises(ValueError, match="between 0 and the length"):
        rc.steady_shapes(Cord(1.0), conical_height=0.1)[0].along(wrong)
    with pytest.raises(ValueError, match="count must be at least 1"):
        rc.modes(Cord(1.0), 0)
