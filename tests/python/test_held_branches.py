# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains held at both ends: complete lists against pins in the plane, and branches."""

import math

import numpy as np
import pytest
from ends import G, shapes_by_pins

import revchain as rc


@pytest.mark.parametrize("seed", range(6))
def test_complete_lists_hold_all_that_points_in_space_find(seed):
    """Newton's method from 200 random places takes most of the time."""
    rng = np.random.default_rng(seed)
    masses, lengths = rng.uniform(0.5, 2.0, 4), rng.uniform(0.5, 1.5, 4)
    span, speed = rng.uniform(0.3, 0.9) * lengths.sum(), rng.uniform(1.0, 6.0)
    held = rc.Held(rc.Chain(mass=masses, length=lengths), span=span)
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G)
    assert shapes.complete
    assert shapes.undecided.size == 0
    found = shapes_by_pins(held, speed, rng, 200, 1)
    assert len(found) == len(shapes)
    for offset, _, _ in found:
        assert min(np.abs(shape.offset - offset).max() for shape in shapes) < 1e-7


def test_what_is_not_decided_is_said():
    beads = rc.Held(rc.Chain.uniform_plummets(9, length=1.0), span=0.211, weightless=True)
    shapes = rc.steady_shapes(beads, angular_speed=5.0)
    assert not shapes.complete
    assert len(shapes) == 1
    ((low, high),) = shapes.undecided  # the lowest link across the axis, others slack
    assert low < -np.pi / 2 < high
    assert high - low < 1e-5
    assert "there may be more" in repr(shapes)
    assert not rc.steady_shapes(beads, angular_speed=5.0, prove=False).complete
    assert not rc.steady_shapes(beads, angular_speed=5.0, budget=0).complete
    assert rc.steady_shapes(rc.Held(rc.Cord(1.0), span=0.4, weightless=True), angular_speed=2.0, max_half_waves=3).complete


def test_several_shapes_of_one_tension():
    rods = rc.Chain.uniform_rods(20, length=1.0, weight=1.0)
    shapes = rc.steady_shapes(rc.Held(rods, tension=3.0), conical_height=0.0437)
    assert [round(shape.span, 6) for shape in shapes] == [0.592013, 0.382109, 0.117882, 0.000523]
    for shape in shapes:
        again = rc.steady_shapes(rc.Held(rods, span=shape.span), conical_height=0.0437, budget=0)[0]
        assert math.isclose(again.tension[-1], 3.0, rel_tol=1e-9)


# ---- branches

MAST = rc.Held(rc.Chain.uniform_rods(20, length=24.0, mass=160.0), span=17.0)


def test_branches_pass_through_the_shapes_of_every_speed():
    branches = rc.branches(MAST, max_angular_speed=6.0)
    assert [branch.mode for branch in branches] == list(range(1, len(branches) + 1))
    for branch in branches[:3]:
        assert math.isclose(branch.angular_speed[0], 6.0, rel_tol=1e-12)
        assert branch.end == "slack"
        for k in (0, len(branch) // 3, len(branch) // 2):
            shape = branch.shape(k)
            same = rc.steady_shape(MAST, mode=branch.mode, conical_height=branch.conical_height[k])
            assert np.abs(same.inclination - shape.inclination).max() < 1e-9
            assert same.proved
            assert np.abs(shape.offset).max() == branch.largest_offset[k]
            assert shape.tension[-1] == pytest.approx(branch.top_tension[k], rel=1e-15)
    with pytest.raises(ValueError, match="has no shape at this conical height"):
        rc.steady_shape(MAST, mode=1, angular_speed=0.9 * branches[0].angular_speed[-1])


def test_the_speed_of_a_tension():
    shape = rc.steady_shape(MAST, mode=1, top_tension=5000.0)
    assert math.isclose(shape.tension[-1], 5000.0, rel_tol=1e-12)
    again = rc.steady_shapes(MAST, angular_speed=shape.angular_speed, budget=0)[0]
    assert np.abs(again.inclination - shape.inclination).max() < 1e-13
    with pytest.raises(ValueError, match="no shape of the branch"):
        rc.steady_shape(MAST, mode=1, top_tension=1.0)
    with pytest.raises(ValueError, match="has no free end"):
        rc.steady_shape(MAST, mode=1, tip_radius=1.0)


def test_steps_do_not_lead_to_another_branch():
    """With the default step the branch of mode 2 once went over to that of mode 1, and lists had one shape twice."""
    held = rc.Held(rc.Chain(weight=[10.0, 1.0, 1.0], length=[2.0, 5.0, 2.0]), span=6.0)
    branch = rc.branch(held, 2, min_conical_height=0.02)
    assert set(branch.half_waves.tolist()) == {2} and len(branch.folds) == 1 and branch.end == "slack"
    assert [each.mode for each in rc.branches(held, min_conical_height=2.0)] == [1]
    for height in (0.7, 1.0, 2.0):
        shapes = rc.steady_shapes(held, conical_height=height, max_half_waves=3)
        places = [tuple(shape.offset.round(8)) for shape in shapes]
        assert shapes.complete and len(set(places)) == len(places)
