# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and cords held at both ends: units of forces, laws, refusals, pictures."""

from __future__ import annotations

import math
import time

import matplotlib
import numpy as np
import pytest

import revchain as rc

matplotlib.use("Agg")
BLADE = rc.Chain.uniform_rods(60, length=2.0, weight=5.0)


def test_forces_are_weights_with_gravity_and_masses_without() -> None:
    speed, gravity = 12.0, 9.81
    shape = rc.held_shapes(BLADE, span=1.2, angular_speed=speed, gravity=gravity)[0]
    middle = (shape.offset[1:] + shape.offset[:-1]) / 2
    centrifugal = (5.0 / 60 / gravity) * speed**2 * middle.sum()
    assert shape.lower_pull[0] + shape.upper_pull[0] == pytest.approx(centrifugal, rel=1e-13)
    assert shape.lower_pull[1] + shape.upper_pull[1] == pytest.approx(-5.0, rel=1e-12)
    assert shape.tension[0] == pytest.approx(math.hypot(*shape.lower_pull), rel=1e-14)
    assert shape.tension[-1] == pytest.approx(math.hypot(*shape.upper_pull), rel=1e-14)

    light = rc.held_shapes(BLADE, span=1.2, angular_speed=speed, gravity=0.0)[0]
    centrifugal = (5.0 / 60) * speed**2 * ((light.offset[1:] + light.offset[:-1]) / 2).sum()
    assert light.lower_pull[0] + light.upper_pull[0] == pytest.approx(centrifugal, rel=1e-13)
    assert light.conical_height == 0
    twice = rc.held_shapes(BLADE, span=1.2, angular_speed=2 * speed, gravity=0.0)[0]
    assert (twice.inclination == light.inclination).all()
    np.testing.assert_allclose(twice.tension, 4 * light.tension, rtol=1e-15)


def test_speed_and_height_are_the_same_question() -> None:
    by_speed = rc.held_shapes(BLADE, span=1.2, angular_speed=10.0, gravity=10.0)[0]
    by_height = rc.held_shapes(BLADE, span=1.2, conical_height=0.1)[0]
    np.testing.assert_allclose(by_speed.inclination, by_height.inclination, rtol=0, atol=1e-15)
    np.testing.assert_allclose(by_speed.tension, by_height.tension, rtol=1e-14)


@pytest.mark.parametrize("waves", [1, 2, 3])
def test_cord_without_gravity_is_the_skipping_rope(waves: int) -> None:
    rope = rc.SkippingRope(span=1.0, length=1.7, angular_speed=3.0, half_waves=waves)
    held = rc.held_cord_shapes(1.7, span=1.0, angular_speed=3.0, gravity=0.0, most_half_waves=waves, weight=1.7)
    cord, arc = held[waves - 1], np.linspace(0, 1.7, 31)
    np.testing.assert_allclose(cord.at_arc(arc).offset, rope.at_arc(arc).offset, rtol=0, atol=4e-15)
    # the rope's tensions are lengths of rope: of mass 1 per length
    assert cord.lower_pull[1] == pytest.approx(rope.tension_in_the_middle * 9.80665, rel=1e-13)


def test_top_tension_comes_back() -> None:
    shape = rc.held_shapes(BLADE, span=1.2, conical_height=0.1)[0]
    found = rc.held_shapes(BLADE, top_tension=float(shape.tension[-1]), conical_height=0.1)
    assert len(found) == 2  # it is largest at a span of 1.1
    assert min(abs(s.span - 1.2) for s in found) < 1e-11
    assert [s.span > 1.1 for s in found] == [True, False]
    cord = rc.held_cord_shapes(2.0, span=1.2, conical_height=0.1, weight=5.0)[0]
    back = rc.held_cord_shapes(2.0, top_tension=float(cord.tension[-1]), conical_height=0.1, weight=5.0)
    assert min(abs(c.span - 1.2) for c in back) < 1e-11


def test_taut_modes_of_a_heavy_pull_are_those_of_a_string() -> None:
    modes = rc.taut_modes(rc.Chain.uniform_plummets(8, length=8.0, weight=8.0), tension=1e15, count=9)
    string = 1e-15 / (4 * np.sin(np.arange(1, 8) * np.pi / 16) ** 2)
    np.testing.assert_allclose(modes.conical_height, string, rtol=1e-13)
    assert modes.shape.shape == (7, 9)


def test_a_slow_chain_folds_and_says_so() -> None:
    slow = rc.held_shapes(BLADE, span=1.2, conical_height=50.0, most_half_waves=2)
    assert len(slow) == 0
    assert slow.missing == (1, 2)
    assert not slow.complete
    assert repr(slow) == "HeldShapes: 0; nothing with 1, 2 half waves"


def test_a_folded_cord_is_given_up_soon() -> None:
    begin = time.process_time()
    cord = rc.held_cord_shapes(0.678, top_tension=0.861, angular_speed=0.693)
    assert len(cord) == 0 and cord.missing == (1,)
    assert time.process_time() - begin < 2  # 0.1 s; 7 s where it is followed into rounding


def test_bounds_without_proof_are_estimates() -> None:
    sure = rc.held_shapes(BLADE, span=1.2, conical_height=0.1)[0]
    quick = rc.held_shapes(BLADE, span=1.2, conical_height=0.1, prove=False)[0]
    assert sure.proved
    assert not quick.proved
    assert (sure.inclination == quick.inclination).all()
    assert sure.error_bound < 1e-15


@pytest.mark.parametrize(
    ("given", "sentence"),
    [
        ({"span": 1.0}, "exactly one of conical_height and angular_speed"),
        ({"conical_height": 0.1}, "exactly one of span and top_tension"),
        ({"span": 1.0, "top_tension": 1.0, "conical_height": 0.1}, "exactly one of span and top_tension"),
        ({"span": 2.5, "conical_height": 0.1}, "span must be less than the length"),
        ({"span": -1.0, "conical_height": 0.1}, "span must be positive and finite"),
        ({"span": 1.0, "conical_height": 0.0}, "conical_height must be positive and finite"),
        ({"span": 1.0, "angular_speed": 1.0, "gravity": -1.0}, "gravity must be positive and finite"),
        ({"span": 1.0, "angular_speed": 1e170}, "angular_speed must give a conical height .* got 1e"),
        ({"span": 1.0, "angular_speed": 1e-170}, "angular_speed must give a conical height .* got 1e"),
        ({"top_tension": 1.0, "angular_speed": 1e170, "gravity": 0.0}, "angular_speed must give a conical height"),
        ({"span": 1.0, "conical_height": 1e-320}, "conical_height must give a conical height"),
        ({"span": 1.0, "conical_height": 0.1, "most_half_waves": 0}, "most_half_waves must be at least 1"),
        ({"span": 1.0, "conical_height": 0.1, "most_half_waves": 10**6}, "most_half_waves must be at most"),
    ],
)
def test_wrong_calls(given: dict[str, float], sentence: str) -> None:
    with pytest.raises(ValueError, match=sentence):
        rc.held_shapes(BLADE, **given)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=sentence):
        rc.held_cord_shapes(2.0, **given)  # type: ignore[arg-type]


def test_wrong_frame_and_arc() -> None:
    shape = rc.held_shapes(rc.Chain.uniform_rods(5), span=0.5, conical_height=0.01)[0]
    with pytest.raises(ValueError, match="frame must be"):
        shape.stability(frame="fixed")
    assert shape.stability(frame="driven").exponents.size == 6
    cord = rc.held_cord_shapes(1.0, span=0.5, conical_height=0.01)[0]
    with pytest.raises(ValueError, match="arc length must lie between"):
        cord.at_arc([0.5, 1.5])


def test_plots() -> None:
    shapes = rc.held_shapes(BLADE, span=1.2, conical_height=0.01, most_half_waves=2)
    ax = shapes.plot(length_unit="ft")
    assert ax.get_ylabel() == "above the lower end (ft)"
    assert len(ax.get_legend().get_texts()) == 2
    assert shapes[0].plot().get_aspect() == 1.0


def test_speeds_whose_square_overflows():
    with pytest.raises(ValueError, match=r"angular_speed must give a conical height .* from 1e-150 to 1e\+150, got 1e\+170"):
        rc.held_shapes(rc.Chain.uniform_rods(3), span=0.5, angular_speed=1e170)
