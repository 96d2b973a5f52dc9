# SPDX-License-Identifier: GPL-3.0-or-later
"""Laws that the experiments show with carried supports, standing links and held ropes, and other roads to them."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import eigh
from scipy.optimize import brentq, fsolve
from rigs import G, rigged

import revchain as rc


def test_the_driven_chain_without_end():
    """N links carried round go over to J0 of the depth over J0 at the hand, as (A + B log N)/N^2."""
    length, links = 0.36, np.array([100, 200, 400, 800])
    eighth = rc.modes(rc.Cord(1.0), 1, first=8)
    for turns in (0.4, 0.9, 1.5, 2.5):
        speed = 2 * np.pi * turns
        longer = rc.conical_pendulum.height(speed) / eighth.conical_height[0]
        exact = 1 / eighth.offset(length / longer)[0]
        chains = [rc.Chain.uniform_rods(count, length=length) for count in links]
        off = np.array([rc.response(chain, angular_speed=speed, pins=0).offset for chain in chains]) / exact - 1
        assert np.all(np.abs(off) < 5e-4)  # 4.2e-4: 100 links at 2.5 turns
        growth = np.diff(off * links**2)  # for each doubling B log 2
        np.testing.assert_allclose(growth, growth.mean(), rtol=0.02)  # measured 0.013


def test_every_shape_of_a_driven_chain():
    """100 links against the chain without end, integrated from its free end for every tip: five shapes."""
    length, hand, height = 0.36, 0.005, G / (2 * np.pi * 3.0) ** 2

    def missed(tip):
        def change(s, state):  # offset and horizontal pull, up along the chain
            return [-state[1] / np.hypot(state[1], s), state[0] / height]

        start = 1e-6
        first = [tip - start * tip / np.hypot(tip, height), tip * start / height]
        ends = solve_ivp(change, (start, length), first, rtol=1e-10, atol=1e-13, method="DOP853").y[0, -1]
        return ends - hand

    tips = np.linspace(-0.36, 0.364, 363)
    ends = np.array([missed(tip) for tip in tips])
    crossed = np.flatnonzero(ends[:-1] * ends[1:] < 0)
    exact = [brentq(missed, tips[i], tips[i + 1], xtol=1e-12) for i in crossed]
    rig = rigged(rc.Chain.uniform_rods(100, length=length), radius=hand)
    shapes = rc.steady_shapes(rig, conical_height=height)
    assert shapes.complete
    np.testing.assert_allclose(sorted(shape.offset[0] for shape in shapes), exact, rtol=0, atol=5e-5)  # 4e-5


@pytest.mark.parametrize("sticks", [1, 2, 3, 8, 50])
def test_sticks_on_end_fall_as_they_swing(sticks):
    """Every way to fall of a column is a mode of the same chain hung up, time imaginary."""
    chain = rc.Chain.uniform_rods(sticks, length=0.9)
    found = rc.modes(rigged(chain, inverted=True), "all")
    assert len(found) == 0 and found.complete
    np.testing.assert_allclose(found.other.growth_rate, rc.modes(chain, "all").angular_speed, rtol=4e-16)


@pytest.mark.parametrize("size", [1, 2, 3, 5])
def test_as_many_speeds_as_links_hang(size):
    """Sylvester's law of inertia, in every posture, and the speeds by a dense solver."""
    random = np.random.default_rng(size)
    weight, length = random.uniform(0.2, 5, size), random.uniform(0.2, 2, size)
    chain = rc.Chain(weight=weight, length=length)
    for standing in itertools.product([False, True], repeat=size):
        found = rc.modes(rigged(chain, inverted=standing))
        assert found.complete
        assert (len(found), len(found.other)) == (size - sum(standing), sum(standing))
        pull = np.cumsum(weight) / length * np.where(standing, -1, 1)
        stiffness = np.diag(pull + np.append(0, pull[:-1])) - np.diag(pull[:-1], 1) - np.diag(pull[:-1], -1)
        squares = eigh(stiffness, np.diag(weight), eigvals_only=True) * G
        np.testing.assert_allclose(found.angular_speed, np.sqrt(squares[squares > 0]), rtol=1e-12)
        falls = np.sort(found.other.growth_rate)
        np.testing.assert_allclose(falls, np.sqrt(np.sort(-squares[squares < 0])), rtol=1e-12)


@pytest.mark.parametrize("sticks", [1, 2, 3])
def test_how_a_column_leans(sticks):
    """Moments about every hinge, of weights and of centrifugal forces along the sticks."""
    length, hand, n = 0.9, 0.05, 2 * np.pi
    a, mass = length / sticks, 1 / G / sticks

    def moments(lean):  # outwards, the lowest stick first
        foot = hand + a * np.append(0, np.cumsum(np.sin(lean))[:-1])
        out, left = np.zeros(sticks), 0.0
        for i in reversed(range(sticks)):
            sine, cosine = np.sin(lean[i]), np.cos(lean[i])
            above = (sticks - 1 - i) * mass * G
            flung = mass * n**2 * a * cosine * (foot[i] / 2 + a * sine / 3)
            out[i] = flung + mass * G * a / 2 * sine + left * a * cosine + above * a * sine
            left += mass * n**2 * (foot[i] + a * sine / 2)
        return out

    lean = fsolve(moments, np.full(sticks, -0.05), xtol=1e-12)
    rig = rigged(rc.Chain.uniform_rods(sticks, length=length), inverted=True, radius=hand)
    shapes = rc.steady_shapes(rig, angular_speed=n)
    assert shapes.complete and len(shapes) == 1
    np.testing.assert_allclose(np.pi + shapes[0].inclination[::-1], -lean, rtol=1e-11)


def test_the_joint_above_a_stick_that_swings_alone_is_still():
    """Experiment X: whatever the string, at the speed of the stick by itself; its end where the string pulls it."""
    length, centroid, gyration = 0.6, 0.25, 0.2
    own = (centroid**2 + gyration**2) / centroid
    for string in (0.1, 0.4, 3.0):
        chain = rc.Chain(
            weight=[1, 0], length=[length, string], centroid=[centroid, 0], radius_of_gyration=[gyration, 0]
        )
        end, joint, hand = rc.response(chain, conical_height=own).offset
        assert abs(joint) < 1e-15 and hand == 1
        assert end == pytest.approx(-own / string * length / centroid, rel=1e-14)


@pytest.mark.parametrize(
    ("length", "span", "height"),
    [(2.0, 1.0, G / (2 * np.pi) ** 2), (2.0, 1.0, G / (2 * np.pi * 0.6) ** 2), (1.0, 0.55, 0.2)],
)
def test_the_rope_with_gravity(length, span, height):
    """Integrated from the lower hand with the pull that the library says is there: it ends in the upper hand."""
    (cord,) = rc.steady_shapes(rc.Held(rc.Cord(length, weight=length), span=span), conical_height=height)

    def change(_, state):
        offset, _, out, up = state
        pull = np.hypot(out, up)
        return [out / pull, up / pull, -offset / height, 1.0]

    first, arc = [0, 0, *cord.lower_pull], [0.3 * length, 0.5 * length, 0.8 * length, length]
    *inside, last = solve_ivp(change, (0, length), first, rtol=1e-12, atol=1e-14, method="DOP853", t_eval=arc).y.T
    np.testing.assert_allclose(last, [0, span, *(-cord.upper_pull)], rtol=0, atol=1e-10)
    np.testing.assert_allclose(cord.at(arc[:3]).offset, [state[0] for state in inside], rtol=0, atol=1e-10)


def test_where_the_rope_folds():
    """Its sag vanishes as exp(-c/(n - n0)), n0 the first speed of a chain as long as the upper part when folded."""
    (first,) = rc.modes(rc.Cord(1.5), 1).frequency
    rope = rc.Held(rc.Cord(2.0), span=1.0)

    def sag(turns):
        (cord,) = rc.steady_shapes(rope, angular_speed=2 * np.pi * turns)
        return cord.offset.max()

    inverse = 1 / (np.array([0.52, 0.515, 0.51, 0.505]) - first)
    slopes = np.diff(np.log([sag(turns) for turns in (0.52, 0.515, 0.51, 0.505)])) / np.diff(inverse)
    assert np.ptp(slopes) < 0.04 * abs(slopes.mean())  # -0.287 ... -0.296; with n0 0.005 off -0.18 ... -0.14
    assert len(rc.steady_shapes(rope, angular_speed=2 * np.pi * first)) == 0
