# SPDX-License-Identifier: GPL-3.0-or-later
"""Supports, flywheels, floats, standing links, held ends, attached weights and small oscillations, held against
references that share no code, and no formula but Newton's, with the library.

Three roads: small offsets as a matrix pencil put together from the heights of centres of gravity (rigs.py), in mpmath
or 80-bit floats; steady figures by their effective potential and, turning, by the full equations of motion of
bodies in space (scipy); closed forms of textbooks."""

from __future__ import annotations

import itertools
import json
import math
from pathlib import Path

import matplotlib
import mpmath as mp
import numpy as np
import pytest
import scipy.integrate
import scipy.linalg
import scipy.optimize
import scipy.special
from hypothesis import given, settings
from hypothesis import strategies as st
from rigs import G, Motion, agree, figure_moments, pencil, pivots, random_chain, real_speeds, rigged

import revchain as rc

matplotlib.use("Agg")

EPS = 2.0**-52


# ---- 1. supports ----------------------------------------------------------------------------------------------------


def test_plummet_on_a_spring_is_longer_by_what_the_spring_yields():
    for weight, length, stiffness in [(1, 1, 4), (3, 0.2, 1e-6), (3, 0.2, 1e12), (1e-9, 5, 1)]:
        found = rc.modes(rigged(rc.Chain(weight=weight, length=float(length)), stiffness=float(stiffness)))
        assert found.conical_height == pytest.approx([length + weight / stiffness], rel=2 * EPS, abs=0)
        assert found.complete


@pytest.mark.parametrize("seed", range(6))
def test_spring_and_carriage_against_a_dense_pencil(seed):
    rng = np.random.default_rng(seed)
    rig = rigged(
        random_chain(rng, int(rng.integers(1, 7)), plummets=seed % 2 == 0),
        stiffness=float(np.exp(rng.uniform(-3, 6))),
        carriage=float(seed % 3) * float(rng.uniform(0.1, 3)),
    )
    agree(rig, rc.modes(rig))


@pytest.mark.parametrize(("ratio", "softest"), [(1e-12, 1e-12), (1.0, 1e-12), (1e12, 1e-6)])
def test_spring_stiffer_and_softer_than_anything(ratio, softest):
    chain = rc.Chain(weight=[1, ratio, 2], length=[0.5, 1, 0.3], centroid=[0.2, 0.4, 0.15], radius_of_gyration=0.1)
    for stiffness, carriage in itertools.product([softest, 1.0, 1e12], [0.0, 1e-9, 1e9]):
        rig = rigged(chain, stiffness=stiffness, carriage=carriage)
        agree(rig, rc.modes(rig), digits=100)
    for stiffness in (1e-3, 1e-9, 1e-12):
        rig = rigged(chain, stiffness=stiffness)
        found = rc.modes(rig)
        want = [n for n in real_speeds(rig, digits=120) if n > 0]
        for n, bound, exact in zip(found.angular_speed, found.speed_error_bound, want, strict=True):
            assert abs(n - exact) <= bound * exact
    agree(rig, found, digits=120)


def test_bounds_of_slow_modes_on_soft_springs_are_not_wasteful():
    found = rc.modes(rigged(rc.Chain(weight=[1.0, 1.0], length=[1.0, 1e-6]), stiffness=1e-12))
    assert found.conical_height[0] == pytest.approx(2e12 + 0.5, rel=1e-15)
    assert np.all(found.error_bound <= 4 * EPS)


def test_spring_tends_to_a_firm_support():
    chain = random_chain(np.random.default_rng(1), 8)
    firm = rc.modes(chain).conical_height
    for stiffness in (1e4, 1e6, 1e8):
        soft = rc.modes(rigged(chain, stiffness=stiffness), count=8).conical_height[:8]
        assert np.all(soft >= firm)
        assert np.abs(soft / firm - 1).max() < 1e4 / stiffness
    assert np.array_equal(rc.modes(rc.Rig(chain)).conical_height, firm)
    assert np.array_equal(rc.modes(rigged(chain, stiffness=math.inf)).conical_height, firm)


def sprung_by_brute_force(stiffness, radius, height):
    """Inclinations of the lowest of three plummets, every sign change of what the spring is short of."""
    weight, length = (1.0, 2.0, 3.0), (0.5, 0.4, 0.3)

    def short(lean):
        t = np.tan(lean)
        y, force, below = height * t, 0.0, 0.0
        for w, a in zip(weight, length, strict=True):
            force, below = force + w * y, below + w
            slope = force / (height * below)
            y = y - a * slope / np.sqrt(1 + slope * slope)
        return y - radius - force / (height * stiffness)

    grid = np.linspace(-math.pi / 2, math.pi / 2, 400001)[1:-1]
    values = short(grid)
    places = np.nonzero(values[:-1] * values[1:] < 0)[0]
    return [scipy.optimize.brentq(short, grid[i], grid[i + 1], xtol=1e-15) for i in places]


@pytest.mark.parametrize("stiffness", [5.0, 10.0, 19.0, 20.0, 20.5, 21.0, 30.0, 100.0, 1e4])
@pytest.mark.parametrize("radius", [0.0, 0.2])
def test_every_figure_on_a_spring_by_brute_force(stiffness, radius):
    # stiffness * height = 6 is the weight: softer, the spring cannot hold the whole against its own whirling
    rig = rigged(rc.Chain(weight=[1.0, 2.0, 3.0], length=[0.5, 0.4, 0.3]), stiffness=stiffness, radius=radius)
    shapes = rc.steady_shapes(rig, conical_height=0.3)
    want = [x for x in sprung_by_brute_force(stiffness, radius, 0.3) if radius or x > 0]
    assert stiffness != 20.0 or radius or want == pytest.approx([0.4472935980], abs=1e-9)
    assert shapes.complete or stiffness == 20.0
    assert sorted(s.inclination[0] for s in shapes) == pytest.approx(want, abs=1e-12)
    for shape in shapes:
        assert figure_moments(rig, shape) <= 1e-14 + EPS * stiffness * abs(shape.offset[-1]) / 6  # offset rounded


@pytest.mark.parametrize("seed", range(5))
def test_figures_on_springs_and_arms_balance_and_turn_as_one_piece(seed):
    rng = np.random.default_rng(40 + seed)
    chain = random_chain(rng, 3, spread=0.7)
    rig = rigged(
        chain,
        stiffness=[math.inf, 30.0, 200.0][seed % 3],
        carriage=[0.0, 0.3, 1.0][seed % 3],
        radius=[0.2, 0.0, 0.3, 0.15, 0.1][seed],
        momentum=np.array([0.3, 0.0, -0.2]) * (seed > 2),
    )
    first = rc.modes(rc.Rig(chain)).conical_height[0]
    shapes = rc.steady_shapes(rig, conical_height=0.6 * first)
    assert len(shapes) >= 1
    for shape in shapes:
        assert shape.residual <= 1e-14
        assert figure_moments(rig, shape) <= 1e-14
    speed = math.sqrt(G / (0.6 * first))
    for shape in list(shapes)[:3]:
        off = Motion(rig, speed).run(shape.inclination, shape.offset[-1], turns=0.5)
        assert off < 1e-8, (off, shape)
        # the same figure a thousandth of a radian away is none
        assert Motion(rig, speed).run(shape.inclination + 1e-3, shape.offset[-1], turns=0.5) > 1e-5


def plummet_roots(length, height, radius):
    """All roots of height tan d = radius + length sin d in (-pi/2, pi/2), by a fine scan in mpmath-safe steps."""
    grid = np.linspace(-math.pi / 2 + 1e-9, math.pi / 2 - 1e-9, 20001)

    def f(d):
        return height * math.sin(d) - (radius + length * math.sin(d)) * math.cos(d)

    values = [f(d) for d in grid]
    return [
        scipy.optimize.brentq(f, a, b, xtol=1e-15, rtol=1e-15)
        for a, b, u, v in zip(grid, grid[1:], values, values[1:], strict=False)
        if u * v < 0
    ]


@pytest.mark.parametrize("radius", [1e-6, 0.1, 1.0, 5.0, 1e3])
@pytest.mark.parametrize("height", [0.01, 0.5, 3.99, 4.0, 4.01, 100.0])
def test_carousel_chair_all_its_figures(radius, height):
    rig = rigged(rc.Chain(weight=800.0, length=4.0), radius=radius)
    shapes = rc.steady_shapes(rig, conical_height=height)
    want = sorted(plummet_roots(4.0, height, radius))
    if radius == 1e-6 and height == 4.0:  # h sin d (1 / cos d - 1) = b: cube root
        want = [(2 * radius / 4.0) ** (1 / 3)]
        assert shapes[0].inclination[0] == pytest.approx(want[0], rel=1e-4)
        want = [shapes[0].inclination[0]]  # what a scan in doubles finds is no better
    got = sorted(s.inclination[0] for s in shapes)
    assert shapes.complete
    assert got == pytest.approx(want, abs=2e-13)
    closed = rc.plummet.carried_inclinations(4.0, height=height, radius=radius)
    assert sorted(closed) == pytest.approx(got, abs=1e-13)
    assert all(s.offset[-1] == radius for s in shapes)
    tension = [800.0 / math.cos(d) for d in got]
    assert sorted(s.tension[0] for s in shapes) == pytest.approx(sorted(tension), rel=1e-10)


def test_two_chairs_on_an_arm_every_figure_by_brute_force():
    # lower chair hangs from the upper one; bottom-up sweep over the lowest inclination, explicit for plummets
    chain = rc.Chain(weight=[1.0, 2.0], length=[1.0, 0.7])
    for radius, height in itertools.product([0.05, 0.3], [0.1, 0.35, 1.0]):

        def gap(t, radius=radius, height=height):
            s1 = t / np.sqrt(1 + t * t)
            y0 = height * t
            y1 = y0 - s1
            t2 = (1.0 * y0 + 2.0 * y1) / (height * 3.0)
            return y1 - 0.7 * t2 / np.sqrt(1 + t2 * t2) - radius

        most = (radius + 1.8) / height
        grid = np.linspace(-most, most, 400001)
        values = gap(grid)
        places = np.nonzero(values[:-1] * values[1:] < 0)[0]
        roots = sorted(math.atan(scipy.optimize.brentq(gap, grid[i], grid[i + 1], xtol=1e-15)) for i in places)
        shapes = rc.steady_shapes(rigged(chain, radius=radius), conical_height=height)
        assert shapes.complete
        assert sorted(s.inclination[0] for s in shapes) == pytest.approx(roots, abs=1e-12)


def test_small_arm_is_no_arm():
    chain = rc.Chain.uniform_plummets(3, length=3.0)
    bare = rc.steady_shapes(chain, conical_height=0.4)
    carried = rc.steady_shapes(rigged(chain, radius=1e-9), conical_height=0.4)
    want = sorted([s.inclination[0] for s in bare] + [-s.inclination[0] for s in bare] + [0.0])
    assert sorted(s.inclination[0] for s in carried) == pytest.approx(want, abs=1e-7)


@pytest.mark.parametrize("seed", range(6))
def test_response_of_every_pin_against_a_dense_solution(seed):
    rng = np.random.default_rng(70 + seed)
    size = int(rng.integers(1, 9))
    extra = dict(stiffness=25.0, carriage=0.7) if seed % 3 == 1 else {}
    if seed % 2:
        extra["momentum"] = rng.normal(size=size)
    rig = rigged(random_chain(rng, size), **extra)
    speeds = np.concatenate([np.exp(rng.uniform(-1, 3, 6)), -np.exp(rng.uniform(-1, 3, 2)) if seed % 2 else []])
    found = rc.response(rig if extra else rig.chain, angular_speed=speeds, support_radius=0.25)
    assert found.offset.shape == (len(speeds), size + 1)
    with mp.workdps(50):
        stiff, spin, mass = (mp.matrix(x) for x in pencil(rig, whole=True))
        for i, speed in enumerate(speeds):
            n = mp.mpf(float(speed))
            big = stiff + n * spin - n**2 * mass / mp.mpf(G)
            if "stiffness" in extra:
                side = mp.matrix(size + 1, 1)
                side[size] = 25 * mp.mpf(0.25)
                y = mp.lu_solve(big, side)
            else:
                y = mp.matrix([*mp.lu_solve(big[:size, :size], -mp.mpf(0.25) * big[:size, size]), mp.mpf(0.25)])
                force = -(big[size, :] * y)[0]
                assert abs(found.support_force[i] - force) <= found.support_force_error[i]
                assert found.support_force_error[i] <= 1e-12 * max(abs(force), 1)
            largest = max(abs(x) for x in y)
            for m in range(size + 1):
                assert abs(mp.mpf(found.offset[i, m]) - y[m]) <= EPS / 2 * 1.01 * largest
            assert bool(found.reversed[i]) == (y[0] < 0)


def test_response_reverses_at_each_whirl_speed_and_not_elsewhere():
    chain = rc.Chain.uniform_rods(12, length=1.0)
    critical = rc.modes(chain).angular_speed
    assert rc.response(chain, angular_speed=critical[:4] * (1 - 1e-9)).modes_below.tolist() == [0, 1, 2, 3]
    assert rc.response(chain, angular_speed=critical[:4] * (1 + 1e-9)).modes_below.tolist() == [1, 2, 3, 4]
    below = rc.response(chain, angular_speed=critical[:4] * (1 - 1e-9), pins=[0]).offset[:, 0]
    above = rc.response(chain, angular_speed=critical[:4] * (1 + 1e-9), pins=0).offset
    assert np.all(np.sign(below) != np.sign(above))
    assert np.all(np.abs(below) > 1e5)


def test_response_tends_to_the_continuous_chains():
    # offset J0(2 sqrt(x / height)) / J0(2 sqrt(L / height)), order 2 for rods
    for height in (3.0, 0.3, 0.08):
        error = []
        for count in (100, 200, 400):
            found = rc.response(rc.Chain.uniform_rods(count, length=1.0), conical_height=height)
            x = np.arange(count + 1) / count
            want = scipy.special.j0(2 * np.sqrt(x / height)) / scipy.special.j0(2 * math.sqrt(1 / height))
            error.append(np.abs(found.offset - want).max())
        # order 2, with a logarithm at the free end
        assert 3.4 < error[0] / error[1] < 4.1
        assert 3.4 < error[1] / error[2] < 4.1


@pytest.mark.parametrize("to_and_fro", [False, True])
def test_response_is_what_the_full_motion_does_for_a_small_radius(to_and_fro):
    # carried by a ten-thousandth, round or along a line, and started on the response, the full equations stay on it
    chain = random_chain(np.random.default_rng(5), 3, spread=0.7)
    speed = 1.3 * float(rc.modes(chain).angular_speed[0])
    off = []
    for radius in (1e-3, 1e-4):
        y = rc.response(chain, angular_speed=speed, support_radius=radius).offset
        motion = Motion(rigged(chain, radius=radius), speed, to_and_fro=to_and_fro)
        lean = np.arcsin((y[:-1] - y[1:]) / chain.length)
        if to_and_fro:
            time = 2.25 * math.pi / speed
            end = motion.after(time, lean, radius)
            off.append(float(np.abs(end[:-1, 0] - np.sin(lean) * math.cos(speed * time)).max()) / radius)
        else:
            off.append(motion.run(lean, radius, turns=1) / radius)
    assert off[1] < 1e-3
    assert off[0] / off[1] == pytest.approx(100, rel=0.3)  # what is left out is of the third order


def test_sweep_of_a_long_chain_at_few_pins():
    chain = rc.Chain.uniform_rods(10000, length=0.36)
    speeds = np.linspace(1.0, 60.0, 1000)
    found = rc.response(chain, angular_speed=speeds, support_radius=0.01, pins=[0, 5000])
    assert found.offset.shape == (1000, 2)
    # the same links, marched up from the free end by the balance of moments, all speeds side by side, in 80 bits
    ld = np.longdouble
    mu, a, w = speeds.astype(ld) ** 2 / ld(G), ld(0.36) / 10000, ld(1) / 10000
    y, force, below = np.ones(1000, dtype=ld), np.zeros(1000, dtype=ld), ld(0)
    middle = None
    for m in range(10000):
        if m == 5000:
            middle = y.copy()
        s = (a * force + mu * w * a / 2 * y) / (a * below + w * a / 2 + mu * w * a * a / 6)
        force += mu * w * (y - a * s / 2)
        below += w
        y = y - a * s
    assert np.array_equal(found.reversed, y < 0)
    near = np.abs(y) > 1e-3
    assert found.offset[near, 0] == pytest.approx((ld(0.01) / y)[near].astype(float), rel=1e-13)
    assert found.offset[near, 1] == pytest.approx((ld(0.01) * middle / y)[near].astype(float), rel=1e-11, abs=1e-13)
    zeros = scipy.special.jn_zeros(0, 40)
    far = np.abs(y) > 0.02
    roots = 2 * np.sqrt(0.36 / (G / speeds**2))
    assert np.array_equal(found.modes_below[far], [(zeros < z).sum() for z in roots[far]])


# ---- 2. both ends held ----------------------------------------------------------------------------------------------


def held_by_hand(chain, span, height, half_waves=1):
    """Angles and pulls of rods held at both ends by Newton's method on the balance of moments and two closures."""
    size = len(chain)
    a, w, h, rho = chain.length, chain.weight, chain.centroid, chain.radius_of_gyration

    def equations(z, gravity):
        d, (across, up) = z[:size], z[size:]
        s, c = np.sin(d), np.cos(d)
        answer = np.zeros(size + 2)
        for m in range(size):
            y = h[m] * s[m] + (a[m + 1 :] * s[m + 1 :]).sum()
            for r in range(m, size):
                arm = h[m] if r == m else a[r]
                answer[r] += gravity * w[m] * arm * s[r] - w[m] * y * arm * c[r] / height
            answer[m] -= w[m] * rho[m] ** 2 * s[m] * c[m] / height
        answer[:size] += up * a * s - across * a * c  # the lower end is held: pulled down, and towards the axis
        answer[size] = (a * s).sum()
        answer[size + 1] = (a * c).sum() - span
        return answer

    middle = (np.cumsum(a) - a / 2) / a.sum()
    sag = math.sqrt(1 - span / a.sum())
    pull = w.sum() * a.sum() / (height * math.pi**2 * half_waves**2) / 2
    z = np.concatenate([-1.6 * sag * np.cos(half_waves * math.pi * middle), [0.0, pull]])
    z[size] = 0.0
    for gravity in np.linspace(0, 1, 6):
        done = scipy.optimize.root(equations, z, args=(gravity,), tol=1e-14)
        z = done.x
    assert np.abs(equations(z, 1.0)).max() < 1e-9 * w.sum() * a.sum() / height
    return z


@pytest.mark.parametrize("half_waves", [1, 2])
def test_rods_held_at_both_ends_against_newtons_method_by_hand(half_waves):
    chain = rc.Chain(
        weight=[1.0, 2, 1, 1, 3, 1],
        length=[0.2, 0.1, 0.2, 0.15, 0.2, 0.15],
        centroid=[0.1, 0.05, 0.1, 0.07, 0.09, 0.07],
        radius_of_gyration=0.05,
    )
    held = rc.steady_shapes(rc.Held(chain, span=0.7), conical_height=0.01, max_half_waves=2)
    assert not held.missing
    shape = next(s for s in held if s.half_waves == half_waves)
    z = held_by_hand(chain, 0.7, 0.01, half_waves)
    lean = z[:6] if z[0] * shape.inclination[0] > 0 else -z[:6]
    # inclination is to the upward vertical, the same line seen from below: sign as the offsets say
    y = np.concatenate([np.cumsum((chain.length * np.sin(lean))[::-1])[::-1], [0.0]])
    y = y * np.sign(y[1]) * np.sign(shape.offset[1])
    assert shape.offset == pytest.approx(y, abs=1e-11)
    assert math.hypot(*shape.lower_pull) == pytest.approx(math.hypot(z[6], z[7]), rel=1e-9)
    assert shape.residual <= 1e-14
    assert shape.height[-1] == pytest.approx(0.7, abs=1e-15)


def test_held_links_tend_to_the_held_cord_with_gravity():
    cord = rc.Cord(1.0, weight=2.0)
    limit, *held = (
        rc.steady_shapes(rc.Held(system, span=0.6), conical_height=0.15, max_half_waves=2)
        for system in (cord, *(cord.chain(count) for count in (30, 60, 120)))
    )
    for exact, *links in zip(limit, *held, strict=True):
        error = []
        for shape in links:
            want = exact.at(np.linspace(0, 1, shape.offset.size)).offset
            error.append(np.abs(shape.offset - want * np.sign(shape.offset[1] * want[1])).max())
        assert error[0] / error[1] == pytest.approx(4, rel=0.2)
        assert error[1] / error[2] == pytest.approx(4, rel=0.2)


def test_held_by_its_tension_is_held_by_its_span():
    chain = random_chain(np.random.default_rng(15), 9)
    span = 0.7 * chain.total_length
    first = rc.steady_shapes(rc.Held(chain, span=span), conical_height=0.5)[0]
    again = rc.steady_shapes(rc.Held(chain, tension=float(first.tension[-1])), conical_height=0.5)
    nearest = min(again, key=lambda s: abs(s.span - span))
    assert nearest.span == pytest.approx(span, rel=1e-9)
    assert nearest.offset == pytest.approx(first.offset, abs=1e-8)


def test_continuous_chain_with_a_tip_weight_at_any_inclination():
    length, height, tip = 1.0, 0.35, 0.4
    cord = rc.Cord(length, weight=length, tip_weight=tip)
    found = rc.steady_shapes(cord, conical_height=height)
    first = rc.modes(cord, 2).conical_height
    assert len(found) == int((first > height).sum())
    start = float(found[0].offset[0])

    def rhs(s, u):  # y, pull across: pull up is tip + s
        size = math.hypot(u[1], tip + s)
        return [u[1] / size, -u[0] / height]

    end = scipy.integrate.solve_ivp(rhs, (0, length), [start, -tip * start / height], "DOP853", rtol=1e-13, atol=1e-15)
    assert abs(end.y[0, -1]) < 1e-12


def test_weightless_links_tend_to_the_skipping_rope():
    rope = rc.SkippingRope(span=0.6, length=1.0, angular_speed=20.0)
    error = []
    for count in (20, 40, 80):
        chain = rc.Chain.uniform_rods(count, length=1.0)
        shape = rc.steady_shapes(rc.Held(chain, span=0.6, weightless=True), angular_speed=20.0)[0]
        error.append(abs(shape.offset.max() / rope.sag - 1))
        assert shape.conical_height == 0
    assert error[0] / error[1] == pytest.approx(4, rel=0.15)
    assert error[1] / error[2] == pytest.approx(4, rel=0.15)
    # with gravity, as fast as you like: the same
    cord = rc.Cord(1.0, weight=1.0)
    fast = rc.steady_shapes(rc.Held(cord, span=0.6), conical_height=1e-8)[0]
    assert float(fast.at(0.5).offset) == pytest.approx(rope.sag, rel=1e-6)
    # tension in the middle is w h: weight 1, times g as masses
    light = rc.steady_shapes(rc.Held(cord, span=0.6, weightless=True), angular_speed=20.0)[0]
    assert float(light.at(0.5).tension) == pytest.approx(rope.tension_in_the_middle * G, rel=1e-10)


def test_taut_speeds_of_a_heavy_cord():
    # tension T below and T + W above: cross products of Bessel functions
    load = 0.3
    got = rc.modes(rc.Held(rc.Chain.uniform_rods(600, length=1.0, weight=1.0), tension=load + 1.0), 3).conical_height

    def cross(x):
        a, b = 2 * math.sqrt(load / x), 2 * math.sqrt((load + 1) / x)
        return scipy.special.j0(a) * scipy.special.y0(b) - scipy.special.j0(b) * scipy.special.y0(a)

    for height in got:
        root = scipy.optimize.brentq(cross, height * 0.999, height * 1.001, xtol=1e-15)
        assert height == pytest.approx(root, rel=2e-4)


def test_taut_speeds_against_a_dense_pencil():
    chain = random_chain(np.random.default_rng(9), 7)
    tension = 2.5 + float(chain.weight.sum())
    found = rc.modes(rc.Held(chain, tension=tension), "all")
    with mp.workdps(50):
        stiff, _, mass = pencil(rc.Rig(chain), whole=True)
        below = mp.mpf(tension) - sum(mp.mpf(float(w)) for w in chain.weight)
        for m, a in enumerate(chain.length):
            for i, j, sign in ((m, m, 1), (m, m + 1, -1), (m + 1, m, -1), (m + 1, m + 1, 1)):
                stiff[i][j] += sign * below / mp.mpf(float(a))
        inside, heavy = (mp.matrix([row[1:-1] for row in matrix[1:-1]]) for matrix in (stiff, mass))
        heights = sorted((mp.re(1 / x) for x in mp.eig(heavy**-1 * inside)[0]), reverse=True)
        assert len(found) == 6
        for a, b in zip(found.conical_height, heights, strict=True):
            assert abs(a - b) <= EPS * a


# ---- 3. flywheels ---------------------------------------------------------------------------------------------------


def test_two_gyrostats_quartic():
    rng = np.random.default_rng(20)
    for _ in range(60):
        w, a, h = np.exp(rng.uniform(-2, 2, 2)), np.exp(rng.uniform(-1, 1, 2)), np.exp(rng.uniform(-1, 0.3, 2))
        rho, p = np.exp(rng.uniform(-2, 0, 2)), rng.normal(0, 3, 2)
        chain = rc.Chain(weight=w, length=a, centroid=h, radius_of_gyration=rho)
        found = rc.modes(rigged(chain, momentum=p))
        # with inclinations: (A1 n^2 - p1 n - W1 h1)(A2 n^2 - p2 n - W2 h2 - W1 a2) = n^4 (W1 h1 a2 / g)^2
        about = [w[0] / G * (h[0] ** 2 + rho[0] ** 2), w[1] / G * (h[1] ** 2 + rho[1] ** 2) + w[0] / G * a[1] ** 2]
        one = np.array([about[0], -p[0], -w[0] * h[0]])
        two = np.array([about[1], -p[1], -w[1] * h[1] - w[0] * a[1]])
        quartic = np.polysub(np.polymul(one, two), np.array([(w[0] * h[0] * a[1] / G) ** 2, 0, 0, 0, 0]))
        assert np.sort(found.angular_speed) == pytest.approx(np.sort(np.roots(quartic).real), rel=1e-9)


@pytest.mark.parametrize("seed", range(8))
def test_flywheels_against_a_dense_quadratic_pencil(seed):
    rng = np.random.default_rng(100 + seed)
    size = int(rng.integers(1, 7))
    chain = random_chain(rng, size)
    strength = [0.0, 1e-6, 1.0, 1.0, 30.0, 1e4, 1.0, 1e8][seed]
    momentum = rng.normal(size=size) * strength * (rng.random(size) < 0.8)
    momentum[0] += strength
    support = dict(stiffness=10.0, carriage=0.5) if seed % 2 else {}
    rig = rigged(chain, momentum=momentum, **support)
    found = rc.modes(rig)
    agree(rig, found, digits=90)
    assert found.complete
    if strength:
        count = size + (seed % 2)
        assert found.available == (count, count)
        for sense in (1, -1):
            assert found.number[found.direction == sense].tolist() == list(range(1, count + 1))
        mirrored = rc.modes(rigged(chain, momentum=-momentum, **support))
        assert np.array_equal(found.angular_speed, -mirrored.angular_speed)
        assert np.array_equal(found.direction, -mirrored.direction)


RANGES = [(1e-3, 1e3), (0.05, 5), (0.05, 1.5), (0.02, 1.0), (-50, 50)]


@given(data=st.lists(st.tuples(*itertools.starmap(st.floats, RANGES)), min_size=1, max_size=4))
@settings(max_examples=40)
def test_flywheels_of_any_kind(data):
    w, a, h, rho, p = (np.array(x) for x in zip(*data, strict=True))
    rig = rigged(rc.Chain(weight=w, length=a, centroid=h * a, radius_of_gyration=rho * a), momentum=p)
    agree(rig, rc.modes(rig), digits=90)


@pytest.mark.parametrize(("size", "slowest"), [(30, 30), (1000, 40), (10000, 12)])
def test_flywheel_speeds_of_long_chains_bracketed_in_extended_precision(size, slowest):
    rng = np.random.default_rng(size)
    chain = rc.Chain(
        weight=np.exp(rng.normal(size=size)),
        length=rng.uniform(0.5, 1.5, size),
        centroid=rng.uniform(0.2, 0.9, size),
        radius_of_gyration=rng.uniform(0.1, 0.4, size),
    )
    rig = rigged(chain, momentum=rng.normal(size=size) * chain.weight.sum() * 0.3)
    found = rc.modes(rig, count=slowest)
    tolerance = 4 * EPS * (1 + math.log10(size))
    for sense in (1, -1):
        half = found.angular_speed[found.direction == sense]
        assert len(half) == slowest and np.all(half * sense > 0)
        inside, outside = half * (1 - tolerance), half * (1 + tolerance)
        assert pivots(rig, inside).tolist() == list(range(slowest))
        assert pivots(rig, outside).tolist() == list(range(1, slowest + 1))


def test_wheels_turned_by_a_motor_feel_less_inertia():
    # spin relative to the link that turns with the whole: A - C; free of a motor: absolute spin
    chain = rc.Chain(weight=5.0, length=[0.5], centroid=0.3, radius_of_gyration=0.2)
    c = 2.0 * 0.25**2
    for driven in (True, False):
        wheels = rc.Flywheel(weight=2.0, radius_of_gyration=0.25, spin=60.0, driven=driven)
        want = np.roots([(5.0 * (0.3**2 + 0.2**2) - driven * c) / G, -c * 60 / G, -5.0 * 0.3])
        found = rc.modes(rc.Rig(chain, flywheels=wheels)).angular_speed
        assert np.sort(found) == pytest.approx(np.sort(want), rel=1e-13)


@pytest.mark.parametrize("lean", [0.05, 0.7, 1.5])
@pytest.mark.parametrize("sense", [1, -1])
def test_steady_precession_of_a_gyrostat_is_the_textbook_tops(lean, sense):
    # A' cos(th) phi'^2 - C w phi' + W h = 0 with th = pi - lean, C w = -H
    weight, h, rho, momentum = 10.0, 0.5, 0.3, 4.0
    about = weight / G * (h * h + rho * rho)
    n = [x for x in np.roots([about * math.cos(lean), -momentum, -weight * h]) if x * sense > 0][0]
    rig = rigged(rc.Chain(weight=weight, length=[1.0], centroid=h, radius_of_gyration=rho), momentum=momentum)
    if weight * h + n * momentum <= 0:
        pytest.skip("no effective tension")
    shapes = rc.steady_shapes(rig, angular_speed=abs(n), direction=sense)
    assert shapes.complete
    assert [s.inclination[0] for s in shapes] == pytest.approx([lean], abs=1e-12)
    assert Motion(rig, n).run(shapes[0].inclination, 0.0, turns=1) < 1e-8
    want = about * math.sin(lean) ** 2 * n + momentum * math.cos(lean)
    assert shapes[0].angular_momentum == pytest.approx(want, rel=1e-12)


def test_three_gyrostats_turn_as_one_piece_in_both_senses():
    chain = rc.Chain(weight=[2.0, 3.0, 1.5], length=[0.4, 0.3, 0.5], centroid=[0.2, 0.15, 0.3], radius_of_gyration=0.15)
    momentum, axial_moment = np.array([0.25, -0.1, 0.4]), np.array([0.02, 0.0, 0.01])
    rig = rigged(chain, momentum=momentum, axial_moment=axial_moment)
    for sense, speed in itertools.product((1, -1), (8.0, 14.0)):
        try:
            shapes = rc.steady_shapes(rig, angular_speed=speed, direction=sense)
        except ValueError as error:
            assert "tension" in str(error)
            continue
        for shape in shapes:
            assert figure_moments(rig, shape, sense=sense) <= 2e-14
            axial = momentum + axial_moment / G * sense * speed * np.cos(shape.inclination)
            assert Motion(rig, sense * speed, axial=axial).run(shape.inclination, 0.0, turns=0.4) < 1e-8


def test_slack_links_are_named_with_the_speed():
    # kappa + n H = 0 at n = -kappa / H
    chain = rc.Chain(weight=[1.0, 2.0], length=[0.5, 0.4])
    rig = rigged(chain, momentum=[0.2, 0.0])
    found = rc.modes(rig)
    assert found.slack_link.tolist() == [0]
    assert found.slack_speed == pytest.approx([-0.5 / 0.2], rel=4 * EPS, abs=0)
    # exactly there, in powers of two: 0.5 - 2 * 0.25
    none = rigged(chain, momentum=[0.25, 0.0])
    with pytest.raises(ValueError, match="tension"):
        rc.steady_shapes(none, angular_speed=2.0, gravity=4.0, direction=-1)
    assert len(rc.modes(rc.Rig(chain)).slack_link) == 0
    assert rc.modes(none, gravity=4.0).slack_speed.tolist() == [-2.0]
    fine = rc.modes(rigged(chain, momentum=[1e-6, 0.0]))
    fastest = -fine.angular_speed.min()
    assert len(fine.slack_link) == int(0.5 / 1e-6 < fastest)


@pytest.mark.parametrize("momentum", [0.0, 0.5, -2.0])
@pytest.mark.parametrize("rho", [0.0, 0.2])
def test_gyrostatic_string_dispersion(momentum, rho):
    weight, a, tension, h = 12.0, 0.3, 500.0, 0.1
    row = dict(weight=weight, length=a, centroid=h, radius_of_gyration=rho)
    string = rc.GyrostaticString(tension=tension, momentum=momentum, **row)
    # a travelling wave y_m = exp(-i m phase) put in row by row
    q = weight * (h * h + rho * rho) / a**2
    r = weight * ((a - h) ** 2 + rho * rho) / a**2
    off = weight * (h * (a - h) - rho * rho) / a**2
    for phase in (1e-3, 0.5, 2.0, math.pi):
        stiff, spin = 2 * (1 - math.cos(phase)) * tension / a, 2 * (1 - math.cos(phase)) * momentum / a**2
        mass = (q + r + 2 * off * math.cos(phase)) / G
        want = np.sort(np.roots([mass, -spin, -stiff]))
        got = [float(x) for x in string.angular_speeds(phase)]
        assert np.sort(np.abs(got)) == pytest.approx(np.sort(np.abs(want)), rel=1e-12)
        for n in want:
            assert float(string.phase(n)) == pytest.approx(phase, rel=1e-7 if phase == math.pi else 1e-11)
    assert np.sign(string.plane_rotation(5.0)) == np.sign(momentum)  # in the sense of the momentum


# ---- 4. weight that is not mass -------------------------------------------------------------------------------------


def test_pendulum_in_still_water():
    # W h - B hb bears, W (h^2 + rho^2) + added whirls
    weight, h, rho, b, hb, rb, add = 10.0, 0.5, 0.2, 4.0, 0.45, 0.25, 3.0
    chain = rc.Chain(weight=weight, length=[1.0], centroid=h, radius_of_gyration=rho)
    rig = rigged(chain, displaced=b, centroid=hb, gyration=rb, added=add)
    want = (weight * (h * h + rho * rho) + add * (hb * hb + rb * rb)) / (weight * h - b * hb)
    assert rc.modes(rig).conical_height == pytest.approx([want], rel=4 * EPS, abs=0)


def test_cork_on_a_thread_does_not_stay_below():
    # displaces five times its weight: hanging it is unstable, and grows as it falls (upwards) from there
    rig = rigged(rc.Chain(weight=1.0, length=0.8), displaced=5.0, added=2.5)
    found = rc.modes(rig)
    assert len(found) == len(found.angular_speed) == 0
    height = 0.8 * (1 + 2.5) / (1 - 5.0)
    assert found.other.conical_height == pytest.approx([height], rel=4 * EPS, abs=0)
    rate = math.sqrt(G / -height)
    assert found.other.growth_rate == pytest.approx([rate], rel=4 * EPS, abs=0)
    # and so it does, in the full motion
    end = Motion(rig, 1.0).after(1.0, [1e-6], 0.0, tolerance=1e-11)
    assert end[0, 0] == pytest.approx(1e-6 * math.cosh(rate), rel=1e-6)
    # held from below, the buoy stands
    buoy = rc.modes(rigged(rc.Chain(weight=1.0, length=0.8), displaced=5.0, added=2.5, inverted=True))
    assert buoy.conical_height == pytest.approx([-height], rel=4 * EPS, abs=0)


@pytest.mark.parametrize("ratio", [-0.5, -0.1, -0.25])
@pytest.mark.parametrize("x", [0.0, 0.3, 0.6, 0.9])
def test_stokes_float(ratio, x):
    # net weight of the lower plummet is ratio times the upper's, in K and in M
    chain = rc.Chain(weight=[0.5, 1.0], length=[1 + x, 1 - x])
    rig = rigged(chain, displaced=[0.5 - ratio, 0.0], fluid="turning")
    found = rc.modes(rig)
    with mp.workdps(40):
        mu = mp.mpf(0.5) - mp.mpf(0.5 - ratio)
        l1, l2 = mp.mpf(1 + x), mp.mpf(1 - x)
        product = mu * l1 * l2 / (mu + 1)
        # (z - l1)(z - l2) = product
        root = mp.sqrt(((l1 - l2) / 2) ** 2 + product)
        want = [(l1 + l2) / 2 + root, (l1 + l2) / 2 - root]
    if abs(mp.im(want[0])) > 0:
        assert (len(found), len(found.other)) == (0, 2)
        got = sorted(found.other.conical_height, key=lambda z: z.imag)
        assert got[1] == pytest.approx(complex(max(want, key=mp.im)), rel=1e-14)
        n = math.sqrt(G) / np.sqrt(got)
        assert sorted(found.other.growth_rate) == pytest.approx(sorted(np.abs(n.imag)), rel=1e-13)
        with pytest.raises(ValueError):
            rc.two_links.two_plummets_from_the_middle(1.0, x, weight_ratio=ratio)
    else:
        assert found.conical_height == pytest.approx([float(z) for z in want], rel=1e-14)
        closed = rc.two_links.two_plummets_from_the_middle(1.0, x, weight_ratio=ratio)
        assert found.conical_height == pytest.approx(closed, rel=1e-13)


@pytest.mark.parametrize("seed", range(10))
def test_floats_against_a_dense_pencil(seed):
    rng = np.random.default_rng(200 + seed)
    size = int(rng.integers(1, 7))
    chain = random_chain(rng, size)
    fluid = "still" if seed % 2 == 0 else "turning"
    rig = rigged(
        chain,
        displaced=chain.weight * rng.uniform(0, 1.8, size),
        centroid=chain.length * rng.uniform(0, 1, size),
        gyration=chain.length * rng.uniform(0, 0.5, size),
        added=chain.weight * rng.uniform(0, 1, size) if fluid == "still" else 0.0,
        fluid=fluid,
        inverted=rng.random(size) < 0.3,
        stiffness=[math.inf, 12.0][seed % 3 == 0],
    )
    found = rc.modes(rig)
    with mp.workdps(60):
        stiff, _, mass = (mp.matrix(x) for x in pencil(rig))
        heights = [z for z in mp.eig(stiff**-1 * mass)[0] if abs(z) > mp.mpf(10) ** -30]
    real = sorted((mp.re(z) for z in heights if abs(mp.im(z)) < abs(z) * 1e-25 and mp.re(z) > 0), reverse=True)
    rest = [z for z in heights if not (abs(mp.im(z)) < abs(z) * 1e-25 and mp.re(z) > 0)]
    assert found.complete
    assert (len(found), len(found.other)) == (len(real), len(rest))
    for got, want in zip(found.conical_height, real, strict=True):
        assert abs(got - want) <= 1e-14 * want
    assert np.all(np.diff(found.conical_height) <= 0)
    for z in rest:
        distance = [abs(complex(got) - complex(z)) / abs(z) for got in found.other.conical_height]
        i = int(np.argmin(distance))
        assert distance[i] <= 1e-13
        assert found.other.growth_rate[i] == pytest.approx(float(abs(mp.im(mp.sqrt(mp.mpf(G) / z)))), rel=1e-12)
    if fluid == "still":
        assert all(z.imag == 0 for z in found.other.conical_height)


def test_thin_fluid_is_no_fluid():
    chain = random_chain(np.random.default_rng(31), 6)
    bare = rc.modes(chain).conical_height
    for fluid, density in itertools.product(("still", "turning"), (1e-4, 1e-8, 0.0)):
        found = rc.modes(rigged(chain, displaced=density * chain.weight, fluid=fluid)).conical_height
        assert np.abs(found / bare - 1).max() <= 30 * density + 4 * EPS


def test_links_as_heavy_as_the_fluid():
    # turning with it, a link that weighs nothing in the water is not there
    chain = rc.Chain(weight=[1.0, 2.0], length=[0.5, 0.8])
    rig = rigged(chain, displaced=[0.0, 2.0], fluid="turning")
    assert rc.modes(rig).conical_height == pytest.approx([1.3], rel=4 * EPS, abs=0)
    # in still water it moves without weight: an infinite height is no mode
    still = rc.modes(rigged(chain, displaced=[1.0, 0.0]))
    assert still.conical_height == pytest.approx([0.8], rel=4 * EPS, abs=0)
    other = still.other
    assert (*other.conical_height, *other.growth_rate, *other.error_bound) == (np.inf, 0.0, 0.0)
    assert still.status == "success"
    # the lowest: of the others the heights are those of the chain without it
    for size in (1, 2, 3):
        rig = rigged(rc.Chain(weight=[1.0] * size, length=1.0), displaced=[1.0] + [0.0] * (size - 1), fluid="turning")
        want = rc.modes(rc.Chain(weight=[1.0] * (size - 1), length=1.0)).conical_height if size > 1 else []
        assert rc.modes(rig).conical_height == pytest.approx(want, rel=4 * EPS, abs=0)
    # a gyrostat, A n^2 - H n = 0: it stays where it is put, or precesses at H / A
    found = rc.modes(rigged(rc.Chain(weight=1.0, length=[1.0]), displaced=1.0, momentum=3.0))
    assert np.isfinite(found.angular_speed).all()
    assert found.angular_speed[-1] == pytest.approx(3 * G, rel=4 * EPS, abs=0)
    # lighter than all above, proved: net weights -2 and 1.5, (z - 1)^2 = 4
    found = rc.modes(rigged(rc.Chain(weight=[1.0, 2.0], length=1.0), displaced=[3.0, 0.5], fluid="turning"))
    assert found.conical_height == pytest.approx([3.0], rel=4 * EPS, abs=0)
    assert found.other.conical_height == pytest.approx([-1.0], rel=4 * EPS, abs=0)
    assert found.status == "success"


def test_figures_of_a_float_at_any_inclination():
    chain = rc.Chain(weight=[2.0, 5.0, 3.0], length=[0.6, 0.5, 0.4], centroid=[0.3, 0.25, 0.2], radius_of_gyration=0.15)
    for fluid, added in (("still", [0.5, 0.5, 0.2]), ("turning", 0.0)):
        rig = rigged(chain, displaced=[1.5, 1.0, 3.5], added=added, fluid=fluid)
        first = rc.modes(rig).conical_height[0]
        shapes = rc.steady_shapes(rig, conical_height=0.5 * first)
        assert len(shapes) >= 1
        for shape in shapes:
            assert figure_moments(rig, shape) <= 1e-14
            if fluid == "still":
                speed = math.sqrt(G / (0.5 * first))
                assert Motion(rig, speed).run(shape.inclination, 0.0, turns=0.4) < 1e-8


# ---- 5. standing links ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("thread", [1e-3, 1.0, 1e3])
def test_broomstick_on_a_moving_hand(thread):
    h, rho = 0.6, 0.6 / 3**0.5
    # the hand is the end of a thread of that length: a massless link hung, the stick standing on it
    chain = rc.Chain(weight=[1.0, 0.0], length=[1.2, thread], centroid=[h, thread], radius_of_gyration=[rho, 0.0])
    found = rc.modes(rigged(chain, inverted=[True, False]))
    # (l + x)(a - x) = a h
    l = h + rho * rho / h
    want = max(np.roots([1.0, l - thread, -thread * (l - h)]))
    assert found.conical_height == pytest.approx([want], rel=1e-12)
    assert len(found.other) == 1
    assert rc.two_links.standing_link(thread, centroid=h, radius_of_gyration=rho) == pytest.approx(want, rel=1e-12)


def test_broomstick_at_any_inclination_and_in_motion():
    h, rho, thread = 0.6, 0.6 / 3**0.5, 1.0
    first = float(rc.two_links.standing_link(thread, centroid=h, radius_of_gyration=rho))
    chain = rc.Chain(weight=[2.0, 0.0], length=[1.2, thread], centroid=[h, thread], radius_of_gyration=[rho, 0.0])
    rig = rigged(chain, inverted=[True, False])
    for height in (0.95 * first, 0.6 * first):
        closed = rc.two_links.standing_link_shape(thread, centroid=h, radius_of_gyration=rho, height=height)
        shapes = rc.steady_shapes(rig, conical_height=height)
        assert len(shapes) == 1
        lean = shapes[0].inclination
        assert abs(math.pi - abs(lean[0])) == pytest.approx(abs(closed.inclination[0]), abs=1e-12)
        assert abs(lean[1]) == pytest.approx(abs(closed.inclination[1]), abs=1e-12)
        assert figure_moments(rig, shapes[0]) <= 1e-14
    # with some weight in the lower link, the full motion stays for a while
    chain = rc.Chain(weight=[2.0, 0.5], length=[1.2, 1.0], centroid=[h, 0.5], radius_of_gyration=[rho, 0.3])
    rig = rigged(chain, inverted=[True, False])
    height = 0.7 * rc.modes(rig).conical_height[0]
    for shape in rc.steady_shapes(rig, conical_height=height):
        assert figure_moments(rig, shape) <= 1e-14
        assert Motion(rig, math.sqrt(G / height)).run(shape.inclination, 0.0, turns=0.3) < 1e-7


@pytest.mark.parametrize("seed", range(12))
def test_as_many_speeds_as_links_hang(seed):
    rng = np.random.default_rng(300 + seed)
    size = int(rng.integers(1, 30))
    inverted = rng.random(size) < 0.5
    rig = rigged(random_chain(rng, size), inverted=inverted)
    found = rc.modes(rig, "all")
    assert (len(found), len(found.other)) == (int((~inverted).sum()), int(inverted.sum()))  # Sylvester
    assert np.all(found.other.conical_height.real < 0)
    if size <= 8:
        agree(rig, found)


# ---- 6. attached weights --------------------------------------------------------------------------------------------


def test_tip_mass_on_a_cord():
    for tip, length in [(0.0, 1.0), (1e-8, 1.0), (0.3, 2.0), (1e6, 1.0), (1e-3, 1e5)]:
        found = rc.modes(rc.Cord(length, weight=length, tip_weight=tip), 4).conical_height
        with mp.workdps(40):

            def f(x, tip=tip, length=length):
                if tip == 0:
                    return mp.besselj(0, 2 * mp.sqrt(length / x))
                a, b = 2 * mp.sqrt(mp.mpf(tip) / x), 2 * mp.sqrt((mp.mpf(tip) + mp.mpf(length)) / x)
                return mp.bessely(2, a) * mp.besselj(0, b) - mp.besselj(2, a) * mp.bessely(0, b)

            for height in found:
                x = mp.mpf(float(height))
                low, high = x * (1 - 2 * EPS), x * (1 + 2 * EPS)
                assert f(low) * f(high) < 0, (tip, float(height))


def test_tip_mass_is_the_limit_of_links():
    want = rc.modes(rc.Cord(1.0, weight=2.0, tip_weight=0.8), 3).conical_height
    error = []
    for count in (50, 100, 200):
        chain = rc.Chain.uniform_rods(count, length=1.0, weight=2.0).with_body(weight=0.8)
        error.append(np.abs(rc.modes(chain, count=3).conical_height / want - 1))
    assert np.all(np.abs(error[0] / error[1] - 4) < 0.2)
    assert np.all(np.abs(error[1] / error[2] - 4) < 0.2)


@pytest.mark.parametrize("pin", [0, 1, 3])
def test_weight_at_a_pin_and_a_thread_anywhere(pin):
    rng = np.random.default_rng(55)
    chain = random_chain(rng, 4)
    extra = chain.with_body(weight=1.7, pin=pin, radius_of_gyration=0.3)
    with mp.workdps(50):
        stiff, _, mass = pencil(rc.Rig(chain))
        w = mp.mpf(1.7)
        for m in range(pin, 4):
            a = mp.mpf(float(chain.length[m]))
            for i, j, sign in ((m, m, 1), (m, m + 1, -1), (m + 1, m, -1), (m + 1, m + 1, 1)):
                if i < 4 and j < 4:
                    stiff[i][j] += sign * w / a
                    if m == pin:
                        mass[i][j] += sign * w * mp.mpf(0.3) ** 2 / a**2
        mass[pin][pin] += w
        want = sorted((mp.re(1 / x) for x in mp.eig(mp.matrix(mass) ** -1 * mp.matrix(stiff))[0]), reverse=True)
        for got, exact in zip(rc.modes(extra).conical_height, want, strict=True):
            assert abs(got - exact) <= 4 * EPS * exact
    longer = chain.with_thread(0.4, pin=pin + 1)
    assert longer.weight[pin + 1] == 0
    want = [mp.mpf(G) / n**2 for n in real_speeds(rc.Rig(longer), digits=80) if n > 0]
    assert len(want) == longer.mode_count
    for got, exact in zip(rc.modes(longer).conical_height, want, strict=True):
        assert abs(got - exact) <= 4 * EPS * exact


def test_clamped_pairs():
    chain = random_chain(np.random.default_rng(66), 4)
    stiff, _, mass = (np.array(x) for x in pencil(rc.Rig(chain), number=float))
    for link in (0, 1, 2):
        # constraint: the pin between lies on the line of its neighbours
        a = chain.length
        share = a[link + 1] / (a[link] + a[link + 1])  # of the lower pin's offset
        part = np.delete(np.eye(4), link + 1, axis=1)
        part[link + 1, link] = share
        if link < 2:
            part[link + 1, link + 1] = 1 - share
        want = scipy.linalg.eigh(part.T @ mass @ part, part.T @ stiff @ part, eigvals_only=True)
        got = rc.modes(chain.clamped(link)).conical_height
        assert got == pytest.approx(np.sort(want)[::-1], rel=1e-12)
    free = rc.modes(chain).conical_height
    assert np.all(got <= free[:3] * (1 + 4 * EPS))
    assert np.all(got >= free[1:] * (1 - 4 * EPS))
    rods = rc.Chain.uniform_rods(3, length=3.0, weight=3.0).clamped(0).clamped(0)
    assert rc.modes(rods).conical_height == pytest.approx([2.0], rel=1e-15)


def test_bell_and_clapper_one_piece_and_not():
    data = dict(weight=[18.0, 500.0], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    bell = rc.bell_and_clapper(rc.Chain(**data))
    modes = rc.modes(rc.Chain(**data))
    assert bell.conical_height == pytest.approx(tuple(modes.conical_height), rel=4e-16)
    y = modes.shape
    ratio = (y[:, 0] - y[:, 1]) / 0.65 / ((y[:, 1] - y[:, 2]) / 0.15)
    assert bell.inclination_ratio == pytest.approx(tuple(ratio), rel=1e-13)
    m = 500 * 0.2 / (18 * 0.15)
    l1, l2 = 0.52 + 0.08**2 / 0.52, 0.2 + 0.3**2 / 0.2
    assert bell.mismatch == pytest.approx(0.52 - (m + 1) * l1 - m * (0.15 - l2), rel=1e-12)
    of = ("weight", "centroid", "radius_of_gyration")
    names = {f"{body}_{name}": (name, i) for i, body in enumerate(("clapper", "bell")) for name in of}
    names["joint"] = ("length", 1)
    assert set(bell.derivative) == set(names) == set(bell.present)

    def changed(name, value):
        new = {k: list(v) for k, v in data.items()}
        new[names[name][0]][names[name][1]] = value
        return rc.bell_and_clapper(rc.Chain(**new))

    for name, value in bell.with_ratio(1.0).items():
        step = 1e-5 * bell.present[name]
        sides = [changed(name, bell.present[name] + sign * step).inclination_ratio[0] for sign in (1, -1)]
        assert bell.derivative[name] == pytest.approx((sides[0] - sides[1]) / (2 * step), rel=1e-7, abs=1e-9)
        if not math.isnan(value):
            silent = changed(name, value)
            assert silent.inclination_ratio[0] == pytest.approx(1, abs=1e-12)
            assert silent.mismatch == pytest.approx(0, abs=1e-12)
            assert silent.conical_height[0] == pytest.approx(silent.silent_height, rel=1e-12)
            clamped = rc.modes(silent.system.clamped(0)).conical_height[0]
            assert clamped == pytest.approx(silent.conical_height[0], rel=1e-12)
            # and at any inclination, the pair is straight
            shape = rc.steady_shapes(silent.system, conical_height=0.8 * silent.silent_height)[0]
            assert shape.inclination[0] == pytest.approx(shape.inclination[1], abs=1e-9)
    silent = changed("joint", bell.with_ratio(1.0)["joint"])
    assert silent.inclination_ratio[0] == pytest.approx(1, abs=4e-16) and abs(silent.mismatch) < 1e-16
    heights = [rc.modes(chain).conical_height[0] for chain in (silent.system, silent.system.clamped(0))]
    assert heights[0] == pytest.approx(heights[1], rel=4e-16)
    given = {name: value for name, value in bell.present.items() if name != "joint"}
    assert bell.with_ratio(1.0)["joint"] == pytest.approx(float(rc.two_links.pin_of_silent_clapper(**given)), rel=1e-14)


def test_uniform_rod_jointed_where_it_does_not_bend():
    for pin in (0.2, 0.25, 0.4, 0.45):
        # rod of length 1, pin `pin` above its middle; joint below the pin
        joint = float(rc.two_links.joint_without_bending(1.0, pin))
        low = 0.5 + pin - joint  # length of the part below the joint
        up = 1 - low
        chain = rc.Chain(
            weight=[low, up],
            length=[low, joint],
            centroid=[low / 2, joint - up / 2],
            radius_of_gyration=[low / 12**0.5, up / 12**0.5],
        )
        bell = rc.bell_and_clapper(chain)
        assert min(abs(ratio - 1) for ratio in bell.inclination_ratio) < 1e-12
        pendulum = pin + 1 / 12 / pin
        assert min(abs(x / pendulum - 1) for x in bell.conical_height) < 1e-12


# ---- 7. swinging ----------------------------------------------------------------------------------------------------


def test_plucked_chain_let_go_in_full():
    # the nonlinear motion differs by the third order in the pluck
    chain = rc.Chain.uniform_rods(5, length=1.0)
    shape = np.array([0.0, 0.3, 0.6, 1.0, 0.5, 0.0])
    times = np.linspace(0, 3.0, 7)
    off = []
    for size in (2e-3, 2e-4):
        start = size * shape
        linear = rc.swing(chain, start, None, times).offset
        lean = np.arcsin((start[:-1] - start[1:]) / chain.length)
        x = Motion(rc.Rig(chain), 1.0).after(3.0, lean, 0.0, t_eval=times)[:5, 0]  # sines of inclinations
        y = np.cumsum((x * 0.2)[::-1], axis=0)[::-1].T
        off.append(np.abs(y - linear[:, :5]).max() / size)
    assert off[1] < 1e-4
    assert off[0] / off[1] == pytest.approx(100, rel=0.2)


def test_swing_of_the_continuous_chain():
    # started in the shape of its second mode, a fine chain keeps it
    chain = rc.Chain.uniform_rods(400, length=1.0)
    x = np.linspace(0, 1, 401)
    second = rc.modes(rc.Cord(1.0), 1, first=2, gravity=G)
    start = 1e-3 * second.offset(x)[0]
    start[-1] = 0.0
    (n,) = second.angular_speed
    found = rc.swing(chain, start, None, [0.0, math.pi / n, 2 * math.pi / n])
    assert found.offset[1] == pytest.approx(-start, abs=2e-7)
    assert found.offset[2] == pytest.approx(start, abs=2e-7)


# ---- 8. bad input, extremes -----------------------------------------------------------------------------------------


CHAIN = rc.Chain(weight=[1.0, 2.0, 3.0], length=[0.5, 0.4, 0.3])


@pytest.mark.parametrize(
    "call",
    [
        lambda: rc.Rig(None),
        lambda: rc.Rig(rc.Rig(CHAIN)),
        lambda: rc.Rig(CHAIN, support=3.0),
        lambda: rc.Rig(CHAIN, support=rc.Support(mass=1.0)),
        lambda: rc.Rig(CHAIN, inverted="yes"),
        lambda: rc.Rig(CHAIN, fluid=3),
        lambda: rc.Support(stiffness="soft"),
        lambda: rc.Flywheel(momentum=1j),
        lambda: rc.Displaced(weight=0.0, centroid=math.nan),
        lambda: rc.Displaced(weight=0.0, radius_of_gyration=-0.25),
        lambda: rc.Rig(CHAIN, displaced=rc.Displaced(weight=0.5, added_weight=0.5), fluid="turning"),
        lambda: rc.response(None, conical_height=1.0),
        lambda: rc.steady_shapes(rc.Rig(CHAIN), conical_height=-1.0),
        lambda: rc.steady_shapes(rigged(CHAIN, momentum=1.0), angular_speed=3.0, direction=0),
        lambda: rc.steady_shapes(rigged(CHAIN, momentum=1.0), angular_speed=-3.0),
        lambda: rc.modes(rc.Rig(CHAIN), count=-1),
        lambda: rc.modes(rigged(CHAIN, momentum=1.0), precision="double-double"),
        lambda: rc.modes(rigged(CHAIN, momentum=1.0), conical_height=(0.1, 0.2)),
        lambda: rc.modes(rigged(CHAIN, momentum=1.0), count="every"),
        lambda: rc.modes(rigged(CHAIN, momentum=1.0), first=0),
        lambda: rc.modes(rigged(CHAIN, momentum=1.0)).at(gravity=1.62),
        lambda: rc.modes(rigged(CHAIN, momentum=1.0)).uncertainty(weight=0.1),
        lambda: rc.Held(CHAIN, span=1.2000001),
        lambda: rc.Held(CHAIN, span=0.5, tension=3.0),
        lambda: rc.steady_shapes(rc.Held(CHAIN, span=0.5, weightless=True), conical_height=0.1),
        lambda: rc.steady_shapes(rc.Held(rc.Cord(1.0), span=0.5, weightless=True), conical_height=0.1),
        lambda: rc.steady_shapes(rc.Held(CHAIN, span=0.5), conical_height=0.1, gravity=-9.81),
        lambda: rc.Cord(1.0, weight=0.0),
        lambda: rc.steady_shapes(rc.Held(rc.Cord(1.0), span=0.5), conical_height=0.1)[0].at(1.5),
        lambda: rc.modes(rc.Held(CHAIN, tension=1.0), count=0),
        lambda: rc.modes(rc.Held(CHAIN, tension=6.0)),
        lambda: rc.swing(rc.Rig(CHAIN), [0.1, 0.1, 0.1], None, 0.0),
        lambda: rc.tune(rc.Rig(CHAIN), vary="flywheels[0].momentum", angular_speed=0.0),
        lambda: rc.tune(rc.Rig(CHAIN), vary="flywheels[3].momentum", angular_speed=1.0),
        lambda: rc.tune(CHAIN, vary="flywheels[0].momentum", angular_speed=1.0),
        lambda: rc.bell_and_clapper(CHAIN),
        lambda: rc.bell_and_clapper(rc.Rig(CHAIN)),
        lambda: rc.bell_and_clapper(rc.Chain(weight=[1.0, 2.0], length=1.0)).with_ratio(0.0),
        lambda: CHAIN.with_body(weight=-1.0),
        lambda: CHAIN.with_body(weight=1.0, pin=3),
        lambda: CHAIN.with_body(weight=1.0, radius_of_gyration=-1.0),
        lambda: CHAIN.with_thread(0.0, pin=1),
        lambda: CHAIN.with_thread(1.0, pin=0),
        lambda: CHAIN.with_thread(1.0, pin=4),
        lambda: CHAIN.clamped(-1),
        lambda: CHAIN.clamped(2),
        lambda: CHAIN.clamped(1.5),
        lambda: rc.modes(rc.Cord(1.0, tip_mass=1.0), 0),
        lambda: rc.Cord(1.0, tip_mass=-1.0),
    ],
)
def test_nonsense_is_refused_in_a_sentence(call, capfd):
    with pytest.raises((ValueError, TypeError)) as caught:
        call()
    text = str(caught.value)
    assert len(text) > 12
    assert "pybind" not in text and "incompatible function arguments" not in text
    assert capfd.readouterr() == ("", "")


def test_extreme_rigs_neither_crash_nor_hang():
    for w, e, p in itertools.product([1e-12, 1e12], [1e-12, 1e12, math.inf], [0.0, 1e-12, 1e12]):
        rig = rigged(rc.Chain(weight=[w, 1.0], length=[1.0, 1e-6]), stiffness=e, momentum=[p, -p])
        found = rc.modes(rig)
        assert np.all(np.isfinite(found.angular_speed))
        if found.status == "success":
            want = real_speeds(rig, digits=150)
            for n, bound in zip(found.angular_speed, found.error_bound, strict=True):
                assert min(abs(x - n) / abs(x) for x in want) <= max(bound, 4 * EPS)
        if p == 0:
            rc.steady_shapes(rig, conical_height=0.37, budget=20000)
    single = rc.modes(rigged(rc.Chain(weight=1e-300, length=1e-150), stiffness=1e-200))
    assert single.conical_height == pytest.approx([1e-100], rel=1e-12)


def test_long_rigs():
    rng = np.random.default_rng(900)
    chain = rc.Chain.uniform_rods(10000, length=0.36)
    afloat = rc.modes(rigged(chain, displaced=chain.weight * rng.uniform(0, 0.9, 10000)), count=2)
    assert afloat.complete
    assert np.all(afloat.error_bound < 1e-14)
    # a uniform fluid of density r to the links' one: K times 1 - r
    thinned = rc.modes(rigged(chain, displaced=chain.weight * 0.25), count=3)
    assert thinned.conical_height[:3] == pytest.approx(rc.modes(chain, count=3).conical_height / 0.75, rel=1e-13)
    slow = rc.modes(rigged(chain, stiffness=10.0, carriage=0.3), count=3)
    assert slow.available == (10001, 0)
    many = rc.steady_shapes(rigged(rc.Chain.uniform_rods(60, length=1.0), radius=0.05), conical_height=0.3)
    assert len(many) == 3
    for shape in many:
        assert shape.residual <= 1e-14
        assert figure_moments(rigged(rc.Chain.uniform_rods(60, length=1.0), radius=0.05), shape) <= 1e-14
    # a bound the search cannot meet is said, and it ends
    cut = rc.steady_shapes(
        rigged(rc.Chain.uniform_plummets(9, length=9.0), radius=0.1), conical_height=0.01, budget=5000
    )
    assert not cut.complete


def test_shapes_at_exactly_a_critical_speed_are_not_called_complete_wrongly():
    rig = rigged(rc.Chain(weight=1.0, length=0.75), stiffness=4.0)
    at = rc.steady_shapes(rig, conical_height=1.0)
    assert len(at) == 0
    assert rc.steady_shapes(rig, conical_height=1.0 + 1e-12).complete
    below = rc.steady_shapes(rig, conical_height=1.0 - 1e-9)
    assert len(below) == 1
    assert below[0].inclination[0] == pytest.approx(math.acos((0.75 - 1e-9) / 0.75), rel=1e-6)


# ---- 9. kept, drawn, run --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("ending", [".npz", ".nc"])
@pytest.mark.parametrize(
    "rig",
    [
        rigged(rc.Chain(weight=[0.5, 1, 1], length=1.0), displaced=[1, 0, 0], fluid="turning", stiffness=3.0),
        rigged(rc.Chain(weight=1.0, length=[1.0]), displaced=1.0, momentum=3.0),  # an infinite height
        rigged(rc.Chain(weight=1.0, length=1.0), displaced=3.0),  # no mode at all
    ],
    ids=["turning fluid", "weightless", "rises"],
)
def test_results_of_rigs_are_kept_bit_for_bit(tmp_path, ending, rig):
    found = rc.modes(rig)
    path = tmp_path / f"result{ending}"
    found.save(path)
    again = rc.load(path)
    assert again == found
    assert again.system == found.system
    for name in ("conical_height", "angular_speed", "error_bound", "number", "direction", "shape", "residual",
                 "slack_link", "slack_speed"):  # fmt: skip
        assert np.array_equal(getattr(again, name), getattr(found, name))
    assert np.array_equal(again.other.conical_height, found.other.conical_height)
    assert json.loads(json.dumps(found.to_dict())) == found.to_dict()


def test_everything_can_be_drawn():
    rig = rigged(CHAIN, stiffness=30.0, carriage=0.2, momentum=[0.3, 0.0, -0.1], displaced=[0.5, 0, 0], added=0.1)
    swing = rc.swing(CHAIN, [0.1, 0.05, 0.0], None, np.linspace(0, 2, 40))
    carried = rc.steady_shapes(rigged(CHAIN, radius=0.2), conical_height=0.3)
    held = rc.steady_shapes(rc.Held(rc.Chain.uniform_rods(20), span=0.5), conical_height=0.02, max_half_waves=2)
    for ax in (
        rc.modes(rig).plot(),
        rc.response(rig, angular_speed=np.linspace(0.5, 20, 200)).plot(),
        rc.response(CHAIN, angular_speed=np.linspace(0.5, 20, 200)).plot(),
        swing.plot(),
        swing.plot(kind="time", pins=[0, 2]),
        carried.plot(),
        carried[0].plot(),
        held.plot(),
        rc.steady_shapes(rc.Held(rc.Cord(1.0), span=0.5), conical_height=0.1)[0].plot(),
    ):
        assert ax.get_xlabel() and ax.get_ylabel()
        ax.figure.canvas.draw()


@pytest.mark.parametrize(
    ("entries", "place"),
    [
        ("flywheel = {mass = 1, radius_of_gyration = -0.2, spin = 3}", "flywheel"),
        ("displaced = {mass = -0.4}", "displaced"),
        ("displaced = {mass = 0.4, colour = 1}", "colour"),
        ("[support]\nstiffness = 1\nmass = -0.3", "support"),
        ("[support]\nstiffness = -1", "stiffness"),
    ],
)
def test_scenes_that_cannot_be_name_the_key(python, tmp_path, entries, place):
    path = tmp_path / "bad.toml"
    path.write_text(f"[[links]]\nmass = 1\nlength = 1\n{entries}\n")
    with pytest.raises(rc.SceneError, match=rf"bad\.toml.*{place}"):
        rc.load_scene(path).modes()
    if place == "flywheel":
        done = python("-m", "revchain", "modes", path)
        assert done.returncode == 3
        assert place in done.stdout + done.stderr
        assert "Traceback" not in done.stderr


def test_scene_without_modes_still_answers(python, tmp_path):
    path = tmp_path / "float.toml"
    path.write_text("[[links]]\nmass = 1\nlength = 1\ndisplaced = {mass = 3}\n")
    assert "Traceback" not in python("-m", "revchain", "modes", path).stderr
    assert len(rc.load_scene(path).modes()) == 0


def test_new_scene_names_every_feature(python, tmp_path):
    path = tmp_path / "scene.toml"
    assert python("-m", "revchain", "new", path).returncode == 0
    text = path.read_text()
    for word in ("stiffness", "radius", "flywheel", "driven", "displaced", "fluid", "standing", "added_mass"):
        assert word in text
    # what is said in comments of a rig can be said
    said = {line[2:].split(" = ")[0]: line[2:] for line in text.splitlines() if line.startswith("# ") and " = " in line}
    links = "\n".join(said[k] for k in ("standing", "displaced", "flywheel"))
    support = "\n".join(["[support]", said["stiffness"], said["radius"]])
    full = text.replace("centroid = 0.1 ", links + "\ncentroid = 0.1 ").replace("\n[ask.modes]", "\n" + support + "\n[ask.modes]")
    for written in (text, full.replace("# fluid", "fluid")):
        path.write_text(written)
        assert python("-m", "revchain", "validate", path).returncode == 0
    rig = rc.load_scene(path).system()
    assert rig.inverted.any()
    assert rig.has_momentum
    assert np.any(rig.displaced.mass)
    assert rig.support.stiffness == 200.0
    assert rig.fluid == "turning"


def test_scenes_of_the_examples_folder_hold_rigs(repository):
    rigged = [p for p in Path(repository, "examples", "scenes").glob("*.toml") if rc.load_scene(p).is_rigged]
    assert rigged
