# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of chains without links from Python; the numbers themselves are tests/cpp/finite/cord/continuous_chain.cpp's."""

import math

import numpy as np
import pytest

import revchain as rc


def test_counted_by_the_critical_heights():
    for ratio in (1.0, 1.45, 7.61, 7.62, 100.0, 500.0):
        shapes = rc.continuous_shapes(ratio, conical_height=1.0)
        assert shapes.complete
        assert len(shapes) == np.sum(rc.heavy_chain.conical_heights(20, length=ratio) > 1.0)
        assert [shape.half_waves for shape in shapes] == list(range(1, len(shapes) + 1))
    assert repr(shapes) == "ContinuousShapes: 14, all there are"
    assert len(shapes[1:3]) == 2


def test_arrays_and_places_agree():
    for options in ({}, {"tip_weight": 0.3}, {"line_density": lambda s: 1 + s}):
        for shape in rc.continuous_shapes(1.0, conical_height=0.01, **options):
            assert shape.arc_length[0] == 0 and shape.arc_length[-1] == 1 and np.all(np.diff(shape.arc_length) >= 0)
            assert shape.offset[-1] == 0 and shape.height[-1] == 0 and shape.offset[0] > 0
            place = shape(shape.arc_length)
            for name in ("offset", "height", "inclination"):
                np.testing.assert_allclose(getattr(place, name), getattr(shape, name), atol=4 * shape.error_bound, rtol=0)
            np.testing.assert_allclose(place.tension, shape.tension, rtol=1e-9)
            assert np.tan(shape.inclination[0]) == pytest.approx(shape.offset[0] / 0.01, rel=1e-12)
            assert not shape.offset.flags.writeable
            assert shape(0.25).offset.shape == () and shape([[0.25]]).tension.shape == (1, 1)
            assert shape.error_bound < 2e-13 and shape.residual < 1e-14


def test_speed_and_height_are_one():
    by_speed = rc.continuous_shapes(2.0, angular_speed=10.0, gravity=9.81)
    by_height = rc.continuous_shapes(2.0, conical_height=0.0981)
    assert len(by_speed) == len(by_height) == 3
    np.testing.assert_allclose(by_speed[2].offset, by_height[2].offset, atol=1e-12)


def test_small_amplitude_is_the_linear_mode():
    height = float(rc.heavy_chain.conical_heights(2)[1])
    shape = rc.continuous_shapes(1.0, conical_height=height * (1 - 1e-6))[1]
    s = np.linspace(0, 1, 11)
    np.testing.assert_allclose(shape(s).offset / shape.offset[0], rc.heavy_chain.shape(s, 2), atol=1e-5)


def test_many_links_come_near():
    links = rc.steady_shapes(rc.Chain.uniform_rods(8, length=1.0), conical_height=0.1)
    shapes = rc.continuous_shapes(1.0, conical_height=0.1)
    assert len(links) == len(shapes) == 2
    for chain, curve in zip(links, shapes, strict=True):
        at = np.linspace(0, 1, 9)
        assert np.abs(chain.offset - curve(at).offset).max() < 0.02


def test_critical_heights():
    for tip in (0.0, 0.3):
        np.testing.assert_allclose(
            rc.continuous_critical_heights(2.0, count=5, tip_weight=tip),
            rc.tip_mass.conical_heights(5, tip=tip, length=2.0),
            rtol=4e-15,
        )
    np.testing.assert_allclose(
        rc.continuous_critical_heights(2.0, count=4, line_density=lambda s: 3 * s**1.5),
        rc.tapered_chain.conical_heights(4, exponent=1.5, length=2.0),
        rtol=3e-14,
    )


def test_beads_have_more_shapes_than_critical_heights():
    def beads(s):
        return 0.01 + sum(math.exp(-(((s - at) / 0.05) ** 2)) / (0.05 * math.sqrt(math.pi)) for at in (0.15, 1.0, 2.0))

    shapes = rc.continuous_shapes(3.0, conical_height=0.06, line_density=beads)
    assert np.sum(rc.continuous_critical_heights(3.0, count=4, line_density=beads) > 0.06) == 3
    assert [shape.half_waves for shape in shapes] == [1, 2, 3, 3, 3]
    assert not shapes.complete
    assert repr(shapes) == "ContinuousShapes: 5, there may be more"


def test_pictures():
    shapes = rc.continuous_shapes(1.0, conical_height=0.05)
    ax = shapes.plot(length_unit="ft")
    assert ax.get_xlabel() == "from the axis (ft)" and ax.get_title() == "3 shapes, all there are"
    assert shapes[0].plot(ax) is ax
    assert rc.continuous_shapes(1.0, conical_height=1.0).plot().get_title() == "0 shapes, all there are"


def test_an_error_of_the_density_comes_through():
    def broken(s):
        raise KeyError("no such place")

    with pytest.raises(KeyError, match="no such place"):
        rc.continuous_shapes(1.0, conical_height=0.1, line_density=broken)


@pytest.mark.parametrize(
    ("arguments", "error", "message"),
    [
        ({"length": 0.0}, ValueError, "length must be positive"),
        ({"length": math.nan}, ValueError, "length must be positive"),
        ({"length": [1.0, 2.0]}, ValueError, "length must be a single number"),
        ({"conical_height": -1.0}, ValueError, "conical_height must be positive"),
        ({"conical_height": 1e-7}, ValueError, "at most 1e6"),
        ({"conical_height": None}, ValueError, "exactly one of .*, got none$"),
        ({"angular_speed": 1.0}, ValueError, "exactly one of .*, got conical_height and angular_speed$"),
        ({"conical_height": None, "angular_speed": 1e300}, ValueError, r"gravity / angular_speed\*\*2 must be positive and finite, got 0$"),
        ({"tip_weight": -0.1}, ValueError, "tip_weight must be finite and not negative, got -0.1"),
        ({"tip_weight": "1"}, ValueError, "tip_weight must be a real number"),
        ({"line_density": 1.0}, TypeError, "line_density must be a function of .*, got 1.0$"),
        ({"line_density": lambda s: -s}, ValueError, "weight per length must be positive"),
        ({"line_density": lambda s: "heavy"}, ValueError, "must be a real number"),
        ({"scanned": 0}, ValueError, "scanned must be from 1"),
    ],
)
def test_wrong_calls(arguments, error, message):
    arguments = {"length": 1.0, "conical_height": 0.1} | arguments
    with pytest.raises(error, match=message):
        rc.continuous_shapes(arguments.pop("length"), **arguments)


def test_places_outside_are_refused():
    shape = rc.continuous_shapes(1.0, conical_height=0.1)[0]
    for wrong in (-0.1, 1.1, math.nan, [0.5, 2.0]):
        with pytest.raises(ValueError, match="between 0 and length"):
            shape(wrong)
    with pytest.raises(ValueError, match="count must be at least 1"):
        rc.continuous_critical_heights(1.0, count=0)
