# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and cords held at both ends, against balances of moments and closed forms; laws, refusals, pictures.

Cords as the limit of links, and integrated: tests/cpp/held.cpp, tests/cpp/paper/section_5_held_cord.cpp."""

import math
import time

import matplotlib
import numpy as np
import pytest
from mechanics import moments
from rigs import random_chain

import revchain as rc
from revchain import Held

matplotlib.use("Agg")
RODS = rc.Chain.uniform_rods(60, length=2.0, weight=5.0)
BLADE, CORD = Held(RODS, span=1.2), Held(rc.Cord(2.0, weight=5.0), span=1.2)
BODIES = random_chain(np.random.default_rng(15), 9)
BODIES = Held(BODIES, span=0.7 * BODIES.total_length)
LENGTHS, CENTROIDS = [0.2, 0.1, 0.2, 0.15, 0.2, 0.15], [0.1, 0.05, 0.1, 0.07, 0.09, 0.07]
SIX = rc.Chain(weight=[1.0, 2, 1, 1, 3, 1], length=LENGTHS, centroid=CENTROIDS, radius_of_gyration=0.05)
SIX = Held(SIX, span=0.7)
EPS = 2.0**-52


def test_forces_are_weights_with_gravity_and_masses_without():
    speed, gravity = 12.0, 9.81
    shape = rc.steady_shapes(BLADE, angular_speed=speed, gravity=gravity)[0]
    middle = (shape.offset[1:] + shape.offset[:-1]) / 2
    centrifugal = (5.0 / 60 / gravity) * speed**2 * middle.sum()
    assert shape.lower_pull[0] + shape.upper_pull[0] == pytest.approx(centrifugal, rel=1e-13)
    assert shape.lower_pull[1] + shape.upper_pull[1] == pytest.approx(-5.0, rel=1e-12)
    assert shape.tension[0] == pytest.approx(math.hypot(*shape.lower_pull), rel=1e-14)
    assert shape.tension[-1] == pytest.approx(math.hypot(*shape.upper_pull), rel=1e-14)

    weightless = Held(RODS, span=1.2, weightless=True)
    light = rc.steady_shapes(weightless, angular_speed=speed)[0]
    centrifugal = (5.0 / 60) * speed**2 * ((light.offset[1:] + light.offset[:-1]) / 2).sum()
    assert light.lower_pull[0] + light.upper_pull[0] == pytest.approx(centrifugal, rel=1e-13)
    assert light.conical_height == 0
    twice = rc.steady_shapes(weightless, angular_speed=2 * speed)[0]
    assert (twice.inclination == light.inclination).all()
    np.testing.assert_allclose(twice.tension, 4 * light.tension, rtol=1e-15)
    by_mass = Held(rc.Chain.uniform_rods(60, length=2.0, mass=5.0), span=1.2, weightless=True)
    np.testing.assert_allclose(rc.steady_shapes(by_mass, angular_speed=speed)[0].tension, light.tension, rtol=1e-15)


def test_speed_and_height_are_the_same_question():
    by_speed = rc.steady_shapes(BLADE, angular_speed=10.0, gravity=10.0)[0]
    by_height = rc.steady_shapes(BLADE, conical_height=0.1)[0]
    np.testing.assert_allclose(by_speed.inclination, by_height.inclination, rtol=0, atol=1e-15)
    np.testing.assert_allclose(by_speed.tension, by_height.tension, rtol=1e-14)


@pytest.mark.parametrize("waves", [1, 2, 3])
def test_cord_without_gravity_is_the_skipping_rope(waves):
    rope = rc.SkippingRope(span=1.0, length=1.7, angular_speed=3.0, half_waves=waves)
    of_cord = Held(rc.Cord(1.7, weight=1.7), span=1.0, weightless=True)
    cord = rc.steady_shapes(of_cord, angular_speed=3.0, max_half_waves=waves)[waves - 1]
    arc = np.linspace(0, 1.7, 31)
    np.testing.assert_allclose(cord.along(arc).offset, rope.at_arc(arc).offset, rtol=0, atol=4e-15)
    # the rope's tensions are lengths of rope: of mass 1 per length
    assert cord.lower_pull[1] == pytest.approx(rope.tension_in_the_middle * 9.80665, rel=1e-13)


@pytest.mark.parametrize("held", [BLADE, BODIES, CORD], ids=["rods", "bodies", "cord"])
def test_top_tension_comes_back(held):
    shape = rc.steady_shapes(held, conical_height=0.1)[0]
    found = rc.steady_shapes(Held(held.system, tension=float(shape.tension[-1])), conical_height=0.1)
    nearest = min(found, key=lambda s: abs(s.span - held.span))
    assert abs(nearest.span - held.span) < 1e-11
    if held is not CORD:
        assert nearest.offset == pytest.approx(shape.offset, abs=1e-8)
    if held is BLADE:
        assert len(found) == 2  # it is largest at a span of 1.1
        assert [s.span > 1.1 for s in found] == [True, False]


@pytest.mark.parametrize(
    ("count", "tension", "speed"), [(3, 80.0, 6.5), (5, 60.0, 5.5), (4, 90.0, 4.0), (4, 62.46, 6.15), (4, 153.4, 5.12)]
)
def test_every_shape_under_a_tension_has_it(count, tension, speed):
    """Where the branch of a number of half waves jumps past the tension, there is no shape."""
    held = rc.Held(rc.Chain.uniform_rods(count, length=4.0, mass=10.0), tension=tension)
    found = rc.steady_shapes(held, angular_speed=speed, max_half_waves=2)
    for shape in found:
        assert shape.tension[-1] == pytest.approx(tension, rel=1e-12)
    if (count, tension) == (3, 80.0):  # a shape of 189 N was listed, and the list called complete
        assert len(rc.steady_shapes(held, angular_speed=speed)) == 0


@pytest.mark.parametrize("held", [BLADE, BODIES, SIX], ids=["rods", "bodies", "six"])
def test_moments_about_every_pin_balance(held):
    shapes = rc.steady_shapes(held, conical_height=0.01, max_half_waves=2)
    assert not shapes.missing and [shape.half_waves for shape in shapes] == [1, 2]
    for shape in shapes:
        assert moments(held.system, shape) < 1e-16
        assert (shape.offset[0], shape.offset[-1], shape.height[0]) == (0.0, 0.0, 0.0)
        assert shape.height[-1] == pytest.approx(held.span, rel=4e-16)
        assert shape.residual <= 1e-14


def test_fast_with_gravity_is_as_without():
    rope = rc.SkippingRope(span=0.6, length=1.0, angular_speed=20.0)
    fast = rc.steady_shapes(Held(rc.Cord(1.0, weight=1.0), span=0.6), conical_height=1e-8)[0]
    assert float(fast.along(0.5).offset) == pytest.approx(rope.sag, rel=1e-6)


def test_where_the_rope_folds():
    """Its sag vanishes as exp(-c/(n - n0)), n0 the first speed of a chain as long as the upper part when folded."""
    (first,) = rc.modes(rc.Cord(1.5), 1).frequency
    rope = Held(rc.Cord(2.0), span=1.0)

    def sag(turns):
        (cord,) = rc.steady_shapes(rope, angular_speed=2 * np.pi * turns)
        return cord.offset.max()

    inverse = 1 / (np.array([0.52, 0.515, 0.51, 0.505]) - first)
    slopes = np.diff(np.log([sag(turns) for turns in (0.52, 0.515, 0.51, 0.505)])) / np.diff(inverse)
    assert np.ptp(slopes) < 0.04 * abs(slopes.mean())  # -0.287 ... -0.296; with n0 0.005 off -0.18 ... -0.14
    assert len(rc.steady_shapes(rope, angular_speed=2 * np.pi * first)) == 0


def test_taut_speeds_come_with_a_certificate():
    held = Held(rc.Chain.uniform_rods(9, length=1.0, mass=2.0), tension=40.0)
    found = rc.modes(held, "all", certify=True)
    proof = found.certificate
    assert (found.error_bound <= EPS * (1 + 1e-14)).all()
    assert (proof.lower < found.conical_height).all() and (found.conical_height < proof.upper).all()
    assert (proof.upper / proof.lower < 1 + 5 * EPS).all()
    np.testing.assert_array_equal(proof.above_lower, found.number)
    np.testing.assert_array_equal(proof.above_upper, found.number - 1)
    np.testing.assert_array_equal(rc.count_modes(held, conical_height=proof.lower), proof.above_lower)
    assert rc.modes(held, "all").certificate is None
    with pytest.raises(ValueError, match="certify is for a Chain that hangs"):
        rc.modes(Held(rc.Cord(1.0, weight=1.0), tension=2.0), certify=True)


def test_a_slow_chain_folds_and_says_so():
    slow = rc.steady_shapes(BLADE, conical_height=50.0, max_half_waves=2)
    assert len(slow) == 0
    assert slow.missing == (1, 2)
    assert not slow.complete
    assert repr(slow).startswith("0 shapes at 0.442869 rad/s (4.229 rpm); none found with 1, 2 half waves")


def test_a_folded_cord_is_given_up_soon():
    begin = time.process_time()
    folded = rc.steady_shapes(Held(rc.Cord(0.678, weight=1.0), tension=0.861), angular_speed=0.693)
    assert len(folded) == 0 and folded.missing == (1,)
    assert time.process_time() - begin < 2  # 0.1 s; 7 s where it is followed into rounding


def test_bounds_without_proof_are_estimates():
    sure = rc.steady_shapes(BLADE, conical_height=0.1)[0]
    quick = rc.steady_shapes(BLADE, conical_height=0.1, prove=False)[0]
    assert sure.proved
    assert not quick.proved
    assert (sure.inclination == quick.inclination).all()
    assert sure.error_bound < 1e-15


@pytest.mark.parametrize("system", [RODS, rc.Cord(2.0, weight=5.0)], ids=["chain", "cord"])
@pytest.mark.parametrize(
    ("held", "asked", "sentence"),
    [
        ({"span": 1.0}, {}, "exactly one of conical_height and angular_speed"),
        ({}, {"conical_height": 0.1}, "exactly one of span and tension"),
        ({"span": 1.0, "tension": 1.0}, {"conical_height": 0.1}, "exactly one of span and tension"),
        ({"span": 2.5}, {"conical_height": 0.1}, "span must be less than the length"),
        ({"span": -1.0}, {"conical_height": 0.1}, "span must be positive and finite"),
        ({"span": 1.0}, {"conical_height": 0.0}, "conical_height must be positive and finite"),
        ({"span": 1.0}, {"angular_speed": 1.0, "gravity": -1.0}, "gravity must be positive and finite"),
        ({"span": 1.0}, {"angular_speed": 1e170},
         r"angular_speed must give a conical height from 1e-150 to 1e\+150, got 1e\+170"),
        ({"span": 1.0}, {"angular_speed": 1e-170}, "angular_speed must give a conical height .* got 1e"),
        ({"tension": 1.0, "weightless": True}, {"angular_speed": 1e170}, "angular_speed must have a square"),
        ({"tension": 1.0, "weightless": True}, {"conical_height": 0.1}, "without gravity there is no conical height"),
        ({"span": 1.0}, {"conical_height": 1e-320}, "conical_height must give a conical height"),
        ({"span": 1.0}, {"conical_height": 0.1, "max_half_waves": 0}, "max_half_waves must be at least 1"),
        ({"span": 1.0}, {"conical_height": 0.1, "max_half_waves": 10**6}, "max_half_waves must be at most"),
    ],
)  # fmt: skip
def test_wrong_calls(system, held, asked, sentence):
    with pytest.raises(ValueError, match=sentence):
        rc.steady_shapes(Held(system, **held), **asked)


def test_wrong_frame_and_arc():
    shape = rc.steady_shapes(Held(rc.Chain.uniform_rods(5), span=0.5), conical_height=0.01)[0]
    with pytest.raises(ValueError, match="frame must be"):
        shape.stability(frame="fixed")
    assert shape.stability(frame="driven").exponents.size == 6
    with pytest.raises(ValueError, match="count must be at least 1"):
        rc.modes(Held(RODS, tension=10.0), count=0)
    with pytest.raises(ValueError, match="weight must be"):
        rc.Cord(1.0, weight=0.0)
    with pytest.raises(ValueError, match="arc_length must lie between"):
        rc.steady_shapes(CORD, conical_height=0.01)[0].along([0.5, 2.5])


def test_plots():
    shapes = rc.steady_shapes(BLADE, conical_height=0.01, max_half_waves=2)
    ax = shapes.plot()
    assert ax.get_ylabel() == "height above the lower end (m)"
    assert len(ax.get_legend().get_texts()) == 2
    assert shapes[0].plot().get_aspect() == 1.0
    rc.steady_shapes(CORD, conical_height=0.1)[0].plot().figure.canvas.draw()
