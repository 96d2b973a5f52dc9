# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and cords held at both ends: units of forces, laws, refusals, pictures."""

from __future__ import annotations

import math
import time

import matplotlib
import numpy as np
import pytest

import revchain as rc
from revchain import Held

matplotlib.use("Agg")
RODS = rc.Chain.uniform_rods(60, length=2.0, weight=5.0)
BLADE, CORD = Held(RODS, span=1.2), Held(rc.Cord(2.0, weight=5.0), span=1.2)


def test_forces_are_weights_with_gravity_and_masses_without() -> None:
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


def test_speed_and_height_are_the_same_question() -> None:
    by_speed = rc.steady_shapes(BLADE, angular_speed=10.0, gravity=10.0)[0]
    by_height = rc.steady_shapes(BLADE, conical_height=0.1)[0]
    np.testing.assert_allclose(by_speed.inclination, by_height.inclination, rtol=0, atol=1e-15)
    np.testing.assert_allclose(by_speed.tension, by_height.tension, rtol=1e-14)


@pytest.mark.parametrize("waves", [1, 2, 3])
def test_cord_without_gravity_is_the_skipping_rope(waves: int) -> None:
    rope = rc.SkippingRope(span=1.0, length=1.7, angular_speed=3.0, half_waves=waves)
    of_cord = Held(rc.Cord(1.7, weight=1.7), span=1.0, weightless=True)
    cord = rc.steady_shapes(of_cord, angular_speed=3.0, max_half_waves=waves)[waves - 1]
    arc = np.linspace(0, 1.7, 31)
    np.testing.assert_allclose(cord.at(arc).offset, rope.at_arc(arc).offset, rtol=0, atol=4e-15)
    # the rope's tensions are lengths of rope: of mass 1 per length
    assert cord.lower_pull[1] == pytest.approx(rope.tension_in_the_middle * 9.80665, rel=1e-13)


@pytest.mark.parametrize("held", [BLADE, CORD], ids=["chain", "cord"])
def test_top_tension_comes_back(held: Held) -> None:
    shape = rc.steady_shapes(held, conical_height=0.1)[0]
    found = rc.steady_shapes(Held(held.system, tension=float(shape.tension[-1])), conical_height=0.1)
    assert min(abs(s.span - 1.2) for s in found) < 1e-11
    if held is BLADE:
        assert len(found) == 2  # it is largest at a span of 1.1
        assert [s.span > 1.1 for s in found] == [True, False]


def test_taut_modes_of_a_heavy_pull_are_those_of_a_string() -> None:
    modes = rc.modes(Held(rc.Chain.uniform_plummets(8, length=8.0, weight=8.0), tension=1e15 + 8), 7)
    string = 1e-15 / (4 * np.sin(np.arange(1, 8) * np.pi / 16) ** 2)
    np.testing.assert_allclose(modes.conical_height, string, rtol=1e-13)
    assert modes.shape.shape == (7, 9)


def test_a_slow_chain_folds_and_says_so() -> None:
    slow = rc.steady_shapes(BLADE, conical_height=50.0, max_half_waves=2)
    assert len(slow) == 0
    assert slow.missing == (1, 2)
    assert not slow.complete
    assert repr(slow).startswith("0 shapes at 0.442869 rad/s (4.229 rpm); none found with 1, 2 half waves")


def test_a_folded_cord_is_given_up_soon() -> None:
    begin = time.process_time()
    folded = rc.steady_shapes(Held(rc.Cord(0.678, weight=1.0), tension=0.861), angular_speed=0.693)
    assert len(folded) == 0 and folded.missing == (1,)
    assert time.process_time() - begin < 2  # 0.1 s; 7 s where it is followed into rounding


def test_bounds_without_proof_are_estimates() -> None:
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
def test_wrong_calls(system, held, asked, sentence) -> None:
    with pytest.raises(ValueError, match=sentence):
        rc.steady_shapes(Held(system, **held), **asked)


def test_wrong_frame_and_arc() -> None:
    shape = rc.steady_shapes(Held(rc.Chain.uniform_rods(5), span=0.5), conical_height=0.01)[0]
    with pytest.raises(ValueError, match="frame must be"):
        shape.stability(frame="fixed")
    assert shape.stability(frame="driven").exponents.size == 6
    with pytest.raises(ValueError, match="arc_length must lie between"):
        rc.steady_shapes(CORD, conical_height=0.01)[0].at([0.5, 2.5])


def test_plots() -> None:
    shapes = rc.steady_shapes(BLADE, conical_height=0.01, max_half_waves=2)
    ax = shapes.plot()
    assert ax.get_ylabel() == "height above the lower end (m)"
    assert len(ax.get_legend().get_texts()) == 2
    assert shapes[0].plot().get_aspect() == 1.0
