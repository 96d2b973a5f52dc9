# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains held at both ends: complete lists against points in space, branches, verdicts on stability against the motion."""

import math

import numpy as np
import pytest
import scipy.optimize
from rigs import G
from scipy.integrate import solve_ivp

import revchain as rc


# ---- complete lists, against points in space


def by_points(masses, lengths, span, speed, rng, starts):
    """Plummets as points in the plane that turns, threads as constraints: Newton's method from random places, all threads in
    tension, one half wave; without the mirror images."""
    n = len(lengths)
    found = []

    def gaps(x):
        place = np.vstack([[0.0, 0.0], x[: 2 * (n - 1)].reshape(-1, 2), [0.0, span]])
        pull = x[2 * (n - 1) :]  # tension over length
        step = np.diff(place, axis=0)
        force = pull[1:, None] * step[1:] - pull[:-1, None] * step[:-1]
        force[:, 0] += masses[1:] * speed**2 * place[1:-1, 0]
        force[:, 1] -= masses[1:] * G
        return np.concatenate([force.ravel(), (step**2).sum(axis=1) - lengths**2])

    for _ in range(starts):
        start = np.cumsum(lengths)[:-1, None] / lengths.sum() * [0.0, span] + rng.normal(0, 0.3 * lengths.sum(), (n - 1, 2))
        most = masses.sum() * speed**2
        solution = scipy.optimize.root(gaps, np.concatenate([start.ravel(), most * rng.random(n)]), tol=1e-13)
        if not solution.success or np.abs(solution.fun).max() > 1e-8 * most:
            continue
        x = solution.x[: 2 * (n - 1) : 2]
        if (solution.x[2 * (n - 1) :] <= 0).any() or not ((x > 1e-6).all() or (x < -1e-6).all()):
            continue
        x = np.abs(x)
        if not any(np.abs(x - other).max() < 1e-6 for other in found):
            found.append(x)
    return found


@pytest.mark.parametrize("seed", range(6))
def test_complete_lists_hold_all_that_points_in_space_find(seed):
    rng = np.random.default_rng(seed)
    masses, lengths = rng.uniform(0.5, 2.0, 4), rng.uniform(0.5, 1.5, 4)
    span, speed = rng.uniform(0.3, 0.9) * lengths.sum(), rng.uniform(1.0, 6.0)
    held = rc.Held(rc.Chain(mass=masses, length=lengths), span=span)
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G)
    assert shapes.complete
    assert shapes.undecided.size == 0
    found = by_points(masses, lengths, span, speed, rng, 200)
    assert len(found) == len(shapes)
    for x in found:
        assert min(np.abs(shape.offset[1:-1] - x).max() for shape in shapes) < 1e-7


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
    with pytest.raises(ValueError, match="does not reach this conical height"):
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


def test_branches_of_many_links_tend_to_one_another():
    tension = []
    for links in (20, 40, 80):
        blade = rc.Held(rc.Chain.uniform_rods(links, length=24.0, mass=160.0), span=17.0)
        tension.append(rc.steady_shape(blade, mode=1, angular_speed=2.0).tension[-1])
    cord = rc.steady_shapes(rc.Held(rc.Cord(24.0, mass=160.0), span=17.0), angular_speed=2.0)[0].tension[-1]
    off = np.abs(np.array(tension) - cord)
    assert np.allclose(np.log2(off[:-1] / off[1:]), 2.0, atol=0.05)


# ---- stability, against the motion of points in space


def growth(masses, lengths, shape, speed, time, rng):
    """Growth of a small disturbance of plummets as points in the frame that turns at a constant speed, their threads as
    constraints whose forces keep the lengths; over the time, in its logarithm."""
    n = len(lengths)
    ends = np.array([[0.0, 0.0, 0.0]]), np.array([[0.0, 0.0, shape.span]])
    rest = np.column_stack([shape.offset, 0 * shape.offset, shape.height])[1:-1]

    def steps(place):
        return np.diff(np.vstack([ends[0], place, ends[1]]), axis=0)

    def jacobian(step):
        J = np.zeros((n, n - 1, 3))
        for m in range(n):
            if m < n - 1:
                J[m, m] += step[m]
            if m > 0:
                J[m, m - 1] -= step[m]
        return J.reshape(n, -1)

    def rate(_, state):
        place, velocity = state.reshape(2, n - 1, 3)
        free = np.zeros((n - 1, 3))
        free[:, :2] = speed**2 * place[:, :2] + 2 * speed * np.column_stack([velocity[:, 1], -velocity[:, 0]])
        free[:, 2] = -G
        step = steps(place)
        turned = steps(velocity) - steps(0 * velocity)  # the ends stay
        J = jacobian(step)
        weighed = J / np.repeat(masses[1:], 3)
        off = (step**2).sum(axis=1) - lengths**2  # drawn back, lest it drift
        wanted = -(turned**2).sum(axis=1) - J @ free.ravel() - 20 * J @ velocity.ravel() - 50 * off
        pull = np.linalg.solve(J @ weighed.T, wanted)
        return np.concatenate([velocity.ravel(), free.ravel() + pull @ weighed])

    J = jacobian(steps(rest))
    kick = rng.normal(size=3 * (n - 1))
    kick -= J.T @ np.linalg.solve(J @ J.T, J @ kick)
    start = np.concatenate([rest.ravel(), 1e-7 * kick / np.linalg.norm(kick)])
    times = np.linspace(0, time, 400)
    motion = solve_ivp(rate, (0, time), start, t_eval=times, rtol=1e-10, atol=1e-13, method="DOP853").y.T
    off = np.linalg.norm(motion[:, : 3 * (n - 1)] - rest.ravel(), axis=1)
    return np.log(off[-100:].max() / off[50:150].max())


@pytest.mark.parametrize("seed", range(5))
@pytest.mark.parametrize("waves", [1, 2])
def test_verdicts_agree_with_the_motion(seed, waves):
    rng = np.random.default_rng(seed)
    masses, lengths = rng.uniform(0.5, 2.0, 4), rng.uniform(0.5, 1.5, 4)
    held = rc.Held(rc.Chain(mass=masses, length=lengths), span=rng.uniform(0.5, 0.9) * lengths.sum())
    speed = rng.uniform(5.0, 9.0)
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G, max_half_waves=waves, budget=0)
    for shape in [shape for shape in shapes if shape.half_waves == waves]:
        stability = shape.stability()
        grown = growth(masses, lengths, shape, speed, 60.0 / speed, rng)
        if stability.verdict == "unstable" and 35 * stability.growth_rate > 3:
            assert grown > 1
        elif stability.verdict != "unstable":
            assert grown < 2.5  # a turn of the whole may drift
