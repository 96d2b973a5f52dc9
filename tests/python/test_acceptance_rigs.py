# SPDX-License-Identifier: GPL-3.0-or-later
"""Supports, flywheels, floats, standing links, attached weights, inverse questions and small oscillations,
held against references that share no code, and no formula but Newton's, with the library.

Three roads: small offsets as a matrix pencil put together here from the heights of centres of gravity, in mpmath
or 80-bit floats; steady figures by their effective potential and, turning, by the full equations of motion of
bodies in space (scipy); closed forms of textbooks."""

from __future__ import annotations

import itertools
import json
import math
import pickle
import subprocess
import sys
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

import revchain as rc

matplotlib.use("Agg")

G = 9.80665
EPS = 2.0**-52


# ---- small offsets, from the heights of centres of gravity ------------------------------------------------------


def pencil(rig, gravity=G, number=mp.mpf):
    """K, momentum matrix and M of ``(K + n P - n^2 M / g) y = 0``, dense; the support is free on a spring."""
    chain = rig.chain
    size = len(rig)
    yields = math.isfinite(rig.stiffness)
    count = size + 1

    def zeros():
        return [[number(0) for _ in range(count)] for _ in range(count)]

    stiff, spin, mass = zeros(), zeros(), zeros()

    def add(matrix, row, factor):
        for i, u in row.items():
            for j, v in row.items():
                matrix[i][j] += factor * u * v

    below = number(0)
    for m in range(size):
        weight, a = number(float(chain.weight[m])), number(float(chain.length[m]))
        h, rho = number(float(chain.centroid[m])), number(float(chain.radius_of_gyration[m]))
        fluid = number(float(rig.displaced_weight[m]))
        hf, rf = number(float(rig.displaced_centroid[m])), number(float(rig.displaced_radius_of_gyration[m]))
        added = number(float(rig.added_weight[m]))
        lean = {m: 1 / a, m + 1: -1 / a}

        def at(depth, m=m, a=a):
            return {m: depth / a, m + 1: 1 - depth / a}

        kappa = weight * h - fluid * hf + a * below
        add(stiff, lean, -kappa if rig.standing[m] else kappa)
        below += weight - fluid
        add(mass, at(h), weight)
        add(mass, lean, weight * rho**2 - number(float(rig.axial_moment[m])))
        dragged = added - (fluid if rig.fluid == "turning" else 0)
        add(mass, at(hf), dragged)
        add(mass, lean, dragged * rf**2)
        add(spin, lean, number(float(rig.momentum[m])))
    if yields:
        stiff[size][size] += number(rig.stiffness)
        mass[size][size] += number(rig.carriage_weight)
    else:
        for matrix in (stiff, spin, mass):
            matrix.pop()
            for row in matrix:
                row.pop()
    return stiff, spin, mass


def exact_speeds(rig, gravity=G, digits=60):
    """All speeds, complex, by linearising; singular M falls out as infinite speeds."""
    with mp.workdps(digits):
        stiff, spin, mass = (mp.matrix(x) for x in pencil(rig, gravity))
        size = stiff.rows
        # reversed polynomial in w = 1 / n: (w^2 K + w P - M / g) y = 0, K regular
        inverse = stiff**-1
        big = mp.zeros(2 * size)
        top_left = -inverse * spin
        top_right = inverse * mass / mp.mpf(gravity)
        for i in range(size):
            for j in range(size):
                big[i, j] = top_left[i, j]
                big[i, size + j] = top_right[i, j]
            big[size + i, i] = 1
        inverses, _ = mp.eig(big)
        cut = max(abs(w) for w in inverses) * mp.mpf(10) ** (-digits // 3)
        return [1 / w for w in inverses if abs(w) > cut]


def real_speeds(rig, gravity=G, digits=60):
    return sorted(
        (mp.re(n) for n in exact_speeds(rig, gravity, digits) if abs(mp.im(n)) < abs(n) * mp.mpf(10) ** (-digits // 4)),
        key=abs,
    )


def agree(rig, found, tolerance=4 * EPS, digits=60):
    """The whirl speeds found, both signs where there is momentum, are all of the pencil's."""
    want = real_speeds(rig, found.gravity, digits)
    if not found.has_momentum:
        want = [n for n in want if n > 0]
    assert len(found) == len(want), (found, [float(n) for n in want])
    for got, exact in zip(sorted(found.angular_speed), sorted(want), strict=True):
        assert abs(mp.mpf(got) - exact) <= tolerance * abs(exact), (got, float(exact))
    ends = list(np.abs(found.angular_speed))
    assert ends == sorted(ends)


def pivots(rig, speeds, gravity=G):
    """Negative pivots of K + n P - n^2 M / g, speeds side by side in 80-bit floats, link by link."""
    ld = np.longdouble
    chain = rig.chain
    n = np.asarray(speeds, dtype=ld)
    weight, a = chain.weight.astype(ld), chain.length.astype(ld)
    h, rho = chain.centroid.astype(ld), chain.radius_of_gyration.astype(ld)
    p = rig.momentum.astype(ld)
    below = ld(0)
    s = np.zeros_like(n)
    negative = np.zeros(n.shape, dtype=int)
    mu = n * n / ld(gravity)
    for m in range(len(rig)):
        k = ((weight[m] * h[m] + a[m] * below) + n * p[m]) / a[m] ** 2
        q = weight[m] * (h[m] ** 2 + rho[m] ** 2) / a[m] ** 2
        r = weight[m] * ((a[m] - h[m]) ** 2 + rho[m] ** 2) / a[m] ** 2
        d = s + k - mu * q
        negative += d < 0
        s = ((k - mu * r) * s - mu * (k * weight[m] - mu * (weight[m] * rho[m] / a[m]) ** 2)) / d
        below += weight[m]
    return negative


# ---- any motion at all: rigid bodies with an axis, jointed in a row, in space -------------------------------------


class Motion:
    """Unit vectors e of the links, from upper to lower pin: kinetic energy is quadratic in their rates with constant
    coefficients, gravity is linear in them, and a wheel adds -p e x e'. The support may be carried, or slide."""

    def __init__(self, rig, speed, gravity=G, axial=None):
        chain, self.gravity, self.rig, self.speed = rig.chain, gravity, rig, speed
        self.size = size = len(rig)
        self.slides = math.isfinite(rig.stiffness)
        a, w, h, rho = chain.length, chain.weight, chain.centroid, chain.radius_of_gyration
        both = size + 1  # the last place is the support's
        self.inertia = np.zeros((both, both))
        self.pull = np.zeros(size)
        assert rig.fluid == "still"
        for m in range(size):
            for mass, depth, turn, buoyant in (
                (w[m], h[m], rho[m], w[m]),
                (rig.added_weight[m], rig.displaced_centroid[m], rig.displaced_radius_of_gyration[m], 0.0),
                (0.0, rig.displaced_centroid[m], 0.0, -rig.displaced_weight[m]),
            ):
                row = np.zeros(both)
                row[m] = depth
                row[m + 1 : size] = a[m + 1 :]
                self.pull += buoyant * row[:size]
                row[size] = 1.0
                self.inertia += mass / gravity * np.outer(row, row)
                self.inertia[m, m] += mass / gravity * turn**2
        self.inertia[size, size] += rig.carriage_weight / gravity
        self.axial = rig.momentum if axial is None else np.asarray(axial)

    def __call__(self, t, state):
        size, both = self.size, self.size + 1
        place, rate = state.reshape(2, both, 3)
        e, f = place[:size], rate[:size]
        force = np.zeros((both, 3))
        force[:size, 2] = -self.pull
        force[:size] -= self.axial[:, None] * np.cross(e, f)
        radius, n = self.rig.support_radius, self.speed
        rest = radius * np.array([math.cos(n * t), math.sin(n * t), 0.0])
        if self.slides:
            force[size] -= self.rig.stiffness * (place[size] - rest)
            known, acceleration = 0, None
        else:
            known, acceleration = 1, -n * n * rest
        unknown = both - known
        # unknown accelerations (3 each) and a multiplier for each link
        big = np.zeros((3 * unknown + size, 3 * unknown + size))
        big[: 3 * unknown, : 3 * unknown] = np.kron(self.inertia[:unknown, :unknown], np.eye(3))
        side = np.zeros(3 * unknown + size)
        side[: 3 * unknown] = force[:unknown].ravel()
        if known:
            side[: 3 * unknown] -= np.outer(self.inertia[:size, size], acceleration).ravel()
        else:  # a slide is level
            j = 3 * size + 2
            big[j, :], big[j, j], side[j] = 0.0, 1.0, 0.0
        for m in range(size):
            big[3 * m : 3 * m + 3, 3 * unknown + m] = e[m]
            big[3 * unknown + m, 3 * m : 3 * m + 3] = e[m]
            side[3 * unknown + m] = -f[m] @ f[m]
        solved = np.linalg.solve(big, side)[: 3 * unknown].reshape(unknown, 3)
        change = np.empty((2, both, 3))
        change[0] = rate
        change[1, :unknown] = solved
        if known:
            change[1, size] = acceleration
        return change.ravel()

    def run(self, inclination, offset_of_support, turns, tolerance=1e-11):
        """From a steady figure: largest departure of unit vectors and support from turning as one piece."""
        e = np.column_stack([np.sin(inclination), np.zeros(self.size), -np.cos(inclination)])
        place = np.vstack([e, [offset_of_support, 0.0, 0.0]])
        rate = np.cross([0.0, 0.0, self.speed], place)
        time = abs(turns * 2 * math.pi / self.speed)
        done = scipy.integrate.solve_ivp(
            self, (0.0, time), np.stack([place, rate]).ravel(), "DOP853", rtol=tolerance, atol=tolerance, t_eval=[time]
        )
        assert done.success
        angle = self.speed * time
        turn = np.array([[math.cos(angle), -math.sin(angle), 0], [math.sin(angle), math.cos(angle), 0], [0, 0, 1]])
        end = done.y[:, -1].reshape(2, self.size + 1, 3)[0]
        return float(np.abs(end - place @ turn.T).max())


def figure_moments(rig, shape, gravity=G, sense=1):
    """Derivative of the effective potential by each inclination, over weight times length, in 50 digits.

    The support is where the shape has it; where it slides, the last number is the balance of the slide."""
    with mp.workdps(50):
        chain = rig.chain
        size = len(rig)
        height = mp.mpf(float(shape.conical_height))
        n = sense * mp.sqrt(mp.mpf(gravity) / height)
        angle = [mp.mpf(float(x)) for x in shape.inclination]
        sine, cosine = [mp.sin(x) for x in angle], [mp.cos(x) for x in angle]
        a = [mp.mpf(float(x)) for x in chain.length]
        top = mp.mpf(float(shape.offset[-1]))
        moment = [mp.mpf(0)] * size
        across = mp.mpf(0)
        for m in range(size):
            w, h, rho = (mp.mpf(float(x[m])) for x in (chain.weight, chain.centroid, chain.radius_of_gyration))
            b, hb, rb = (
                mp.mpf(float(x[m]))
                for x in (rig.displaced_weight, rig.displaced_centroid, rig.displaced_radius_of_gyration)
            )
            add = mp.mpf(float(rig.added_weight[m]))
            c, p = mp.mpf(float(rig.axial_moment[m])), mp.mpf(float(rig.momentum[m]))
            parts = [(w, w, h, rho), (-b, (-b if rig.fluid == "turning" else mp.mpf(0)) + add, hb, rb)]
            for bears, whirls, depth, turn in parts:
                y = top + depth * sine[m] + sum(a[r] * sine[r] for r in range(m + 1, size))
                across += whirls * y / height
                for r in range(m, size):
                    arm = depth if r == m else a[r]
                    moment[r] += bears * arm * sine[r] - whirls * y * arm * cosine[r] / height
                moment[m] -= whirls * turn**2 * sine[m] * cosine[m] / height
            # angular momentum along the axis, turned at n
            moment[m] += (p + c * n * cosine[m] / mp.mpf(gravity)) * n * sine[m]
        scale = sum(mp.mpf(float(x)) for x in chain.weight) * sum(a)
        answer = [float(abs(x) / scale) for x in moment]
        if math.isfinite(rig.stiffness):
            across += mp.mpf(rig.carriage_weight) * top / height
            balance = across - mp.mpf(rig.stiffness) * (top - mp.mpf(rig.support_radius))
            answer.append(float(abs(balance) * sum(a) / scale))
        return max(answer)


def random_chain(rng, size, spread=2.0, plummets=False):
    weight = np.exp(rng.uniform(-spread, spread, size))
    length = np.exp(rng.uniform(-1, 1, size))
    if plummets:
        return rc.Chain(weight=weight, length=length)
    centroid = length * rng.uniform(0.1, 1.2, size)
    radius = length * rng.uniform(0.1, 0.6, size)
    return rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=radius)


# ---- 1. supports ------------------------------------------------------------------------------------------------


def test_plummet_on_a_spring_is_longer_by_what_the_spring_yields():
    for weight, length, stiffness in [(1, 1, 4), (3, 0.2, 1e-6), (3, 0.2, 1e12), (1e-9, 5, 1)]:
        found = rc.modes(rc.Rig(rc.Chain(weight=weight, length=float(length)), stiffness=float(stiffness)))
        assert found.conical_height == pytest.approx([length + weight / stiffness], rel=2 * EPS)
        assert found.complete


@pytest.mark.parametrize("seed", range(6))
def test_spring_and_carriage_against_a_dense_pencil(seed):
    rng = np.random.default_rng(seed)
    rig = rc.Rig(
        random_chain(rng, int(rng.integers(1, 7)), plummets=seed % 2 == 0),
        stiffness=float(np.exp(rng.uniform(-3, 6))),
        carriage_weight=float(seed % 3) * float(rng.uniform(0.1, 3)),
    )
    agree(rig, rc.modes(rig))


@pytest.mark.parametrize(("ratio", "softest"), [(1e-12, 1e-12), (1.0, 1e-12), (1e12, 1e-6)])
def test_spring_stiffer_and_softer_than_anything(ratio, softest):
    chain = rc.Chain(weight=[1, ratio, 2], length=[0.5, 1, 0.3], centroid=[0.2, 0.4, 0.15], radius_of_gyration=0.1)
    for stiffness, carriage in itertools.product([softest, 1.0, 1e12], [0.0, 1e-9, 1e9]):
        rig = rc.Rig(chain, stiffness=stiffness, carriage_weight=carriage)
        agree(rig, rc.modes(rig), digits=100)


@pytest.mark.parametrize("stiffness", [1e-3, 1e-9, 1e-12])
def test_bounds_hold_on_the_softest_springs(stiffness):
    chain = rc.Chain(weight=[1, 1e12, 2], length=[0.5, 1, 0.3], centroid=[0.2, 0.4, 0.15], radius_of_gyration=0.1)
    rig = rc.Rig(chain, stiffness=stiffness)
    found = rc.modes(rig)
    want = sorted(n for n in real_speeds(rig, digits=120) if n > 0)
    for n, bound, exact in zip(found.angular_speed, found.speed_error_bound, want, strict=True):
        assert abs(n - exact) <= bound * exact


def test_spring_softer_than_the_chain_by_24_orders():
    chain = rc.Chain(weight=[1, 1e12, 2], length=[0.5, 1, 0.3], centroid=[0.2, 0.4, 0.15], radius_of_gyration=0.1)
    rig = rc.Rig(chain, stiffness=1e-12)
    agree(rig, rc.modes(rig), digits=120)


def test_bounds_of_slow_modes_on_soft_springs_are_not_wasteful():
    found = rc.modes(rc.Rig(rc.Chain(weight=[1.0, 1.0], length=[1.0, 1e-6]), stiffness=1e-12))
    assert found.conical_height[0] == pytest.approx(2e12 + 0.5, rel=1e-15)
    assert np.all(found.error_bound <= 4 * EPS)


def test_spring_tends_to_a_firm_support():
    chain = random_chain(np.random.default_rng(1), 8)
    firm = rc.modes(chain).conical_height
    for stiffness in (1e4, 1e6, 1e8):
        soft = rc.modes(rc.Rig(chain, stiffness=stiffness), count=8).conical_height[:8]
        assert np.all(soft >= firm)
        assert np.abs(soft / firm - 1).max() < 1e4 / stiffness
    assert np.array_equal(rc.modes(rc.Rig(chain)).conical_height, firm)
    assert np.array_equal(rc.modes(rc.Rig(chain, stiffness=math.inf)).conical_height, firm)


@pytest.mark.parametrize("stiffness", [20.0, 300.0])
def test_plummet_on_a_spring_at_any_inclination(stiffness):
    # tension vertical W, sideways W tan d = E c: (height - W / E) sec d = length
    chain = rc.Chain(weight=10.0, length=1.0)
    yields = 10.0 / stiffness
    for height in (0.9 * (1 + yields), 0.6 + yields, yields + 0.05):
        shapes = rc.steady_shapes(rc.Rig(chain, stiffness=stiffness), conical_height=height)
        assert shapes.complete
        assert len(shapes) == 1
        lean = math.acos(height - yields)
        assert shapes[0].inclination[0] == pytest.approx(lean, abs=1e-14)
        assert shapes[0].offset[1] == pytest.approx(yields * math.tan(lean), rel=1e-13)


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


@pytest.mark.parametrize("stiffness", [5.0, 10.0, 19.0, 20.5, 21.0, 30.0, 100.0, 1e4])
@pytest.mark.parametrize("radius", [0.0, 0.2])
def test_every_figure_on_a_spring_by_brute_force(stiffness, radius):
    # stiffness * height = 6 is the weight: softer, the spring cannot hold the whole against its own whirling
    rig = rc.Rig(rc.Chain(weight=[1.0, 2.0, 3.0], length=[0.5, 0.4, 0.3]), stiffness=stiffness, support_radius=radius)
    shapes = rc.steady_shapes(rig, conical_height=0.3)
    want = [x for x in sprung_by_brute_force(stiffness, radius, 0.3) if radius or x > 0]
    assert shapes.complete
    assert sorted(s.inclination[0] for s in shapes) == pytest.approx(want, abs=1e-12)
    for shape in shapes:
        assert figure_moments(rig, shape) <= 1e-14 + EPS * stiffness * abs(shape.offset[-1]) / 6  # offset rounded


def test_figure_on_a_spring_as_stiff_as_the_whole_is_heavy():
    rig = rc.Rig(rc.Chain(weight=[1.0, 2.0, 3.0], length=[0.5, 0.4, 0.3]), stiffness=20.0)
    shapes = rc.steady_shapes(rig, conical_height=0.3)
    want = [x for x in sprung_by_brute_force(20.0, 0.0, 0.3) if x > 0]
    assert want == pytest.approx([0.4472935980], abs=1e-9)
    assert [s.inclination[0] for s in shapes] == pytest.approx(want, abs=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_figures_on_springs_and_arms_balance_and_turn_as_one_piece(seed):
    rng = np.random.default_rng(40 + seed)
    chain = random_chain(rng, 3, spread=0.7)
    rig = rc.Rig(
        chain,
        stiffness=[math.inf, 30.0, 200.0][seed % 3],
        carriage_weight=[0.0, 0.3, 1.0][seed % 3],
        support_radius=[0.2, 0.0, 0.3, 0.15, 0.1][seed],
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
    rig = rc.Rig(rc.Chain(weight=800.0, length=4.0), support_radius=radius)
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
        shapes = rc.steady_shapes(rc.Rig(chain, support_radius=radius), conical_height=height)
        assert shapes.complete
        assert sorted(s.inclination[0] for s in shapes) == pytest.approx(roots, abs=1e-12)


def test_small_arm_is_no_arm():
    chain = rc.Chain.uniform_plummets(3, length=3.0)
    bare = rc.steady_shapes(chain, conical_height=0.4)
    carried = rc.steady_shapes(rc.Rig(chain, support_radius=1e-9), conical_height=0.4)
    want = sorted([s.inclination[0] for s in bare] + [-s.inclination[0] for s in bare] + [0.0])
    assert sorted(s.inclination[0] for s in carried) == pytest.approx(want, abs=1e-7)


@pytest.mark.parametrize("seed", range(6))
def test_response_of_every_pin_against_a_dense_solution(seed):
    rng = np.random.default_rng(70 + seed)
    size = int(rng.integers(1, 9))
    extra = {}
    if seed % 3 == 1:
        extra = dict(stiffness=25.0, carriage_weight=0.7)
    if seed % 2:
        extra["momentum"] = rng.normal(size=size)
    rig = rc.Rig(random_chain(rng, size), **extra)
    speeds = np.concatenate([np.exp(rng.uniform(-1, 3, 6)), -np.exp(rng.uniform(-1, 3, 2)) if seed % 2 else []])
    found = rc.response(rig if extra else rig.chain, angular_speed=speeds, support_radius=0.25)
    assert found.offset.shape == (len(speeds), size + 1)
    with mp.workdps(50):
        carried = rc.Rig(rig.chain, stiffness=1.0, momentum=rig.momentum)  # only to have the support's row
        stiff, spin, mass = (mp.matrix(x) for x in pencil(carried))
        stiff[size, size] -= 1
        force = mp.mpf(0)
        for i, speed in enumerate(speeds):
            n = mp.mpf(float(speed))
            big = stiff + n * spin - n**2 * mass / mp.mpf(G)
            if "stiffness" in extra:
                big[size, size] += 25 - n**2 * mp.mpf(0.7) / mp.mpf(G)
                side = mp.matrix(size + 1, 1)
                side[size] = 25 * mp.mpf(0.25)
                y = mp.lu_solve(big, side)
            else:
                side = -mp.mpf(0.25) * big[:size, size]
                y = mp.matrix(list(mp.lu_solve(big[:size, :size], side)) + [mp.mpf(0.25)])
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


def test_response_at_exactly_a_resonance_and_shapes_of_speeds():
    chain = rc.Chain(weight=1.0, length=0.75)
    found = rc.response(chain, conical_height=[[0.75, 1.5], [0.375, 3.0]])
    assert found.offset.shape == (2, 2, 2)
    assert found.resonant.tolist() == [[True, False], [False, False]]
    assert math.isnan(found.offset[0, 0, 0])
    assert math.isinf(found.error_bound[0, 0])
    assert found.offset[0, 1, 0] == 2.0
    assert found.offset[1, 0, 0] == -1.0
    assert found.amplification[1, 1, 0] == pytest.approx(4 / 3, rel=EPS)
    single = rc.response(chain, conical_height=1.5)
    assert single.offset.shape == (2,)
    assert single.modes_below.shape == ()
    near = rc.response(chain, conical_height=0.75 * (1 + 4 * EPS)).offset[0]
    with mp.workdps(40):
        height = mp.mpf(0.75 * (1 + 4 * EPS))
        assert near == pytest.approx(float(height / (height - mp.mpf(0.75))), rel=1e-10)
    assert rc.response(chain, conical_height=[]).offset.shape == (0, 2)


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
    # carried round by a ten-thousandth, started on the response, the full equations stay on it
    rng = np.random.default_rng(5)
    chain = random_chain(rng, 3, spread=0.7)
    speed = 1.3 * float(rc.modes(chain).angular_speed[0])
    off = []
    for radius in (1e-3, 1e-4):
        rig = rc.Rig(chain, support_radius=radius)
        y = rc.response(chain, angular_speed=speed, support_radius=radius).offset
        motion = Motion(rig, speed)
        lean = np.arcsin((y[:-1] - y[1:]) / chain.length)
        if not to_and_fro:
            off.append(motion.run(lean, radius, turns=1) / radius)
            continue
        # one component of the motion: support radius cos(nt) along a line
        size = len(chain)

        class Line(Motion):
            def __call__(self, t, state):
                # the same equations, the y axis left out: start at rest in the plane and project the support
                n, r = self.speed, self.rig.support_radius
                place, rate = state.reshape(2, size + 1, 3)
                e, f = place[:size], rate[:size]
                big = np.zeros((4 * size, 4 * size))
                big[: 3 * size, : 3 * size] = np.kron(self.inertia[:size, :size], np.eye(3))
                force = np.zeros((size, 3))
                force[:, 2] = -self.pull
                support = np.array([-n * n * r * math.cos(n * t), 0.0, 0.0])
                side = np.zeros(4 * size)
                side[: 3 * size] = (force - np.outer(self.inertia[:size, size], support)).ravel()
                for m in range(size):
                    big[3 * m : 3 * m + 3, 3 * size + m] = big[3 * size + m, 3 * m : 3 * m + 3] = e[m]
                    side[3 * size + m] = -f[m] @ f[m]
                change = np.empty((2, size + 1, 3))
                change[0], change[1, size] = rate, support
                change[1, :size] = np.linalg.solve(big, side)[: 3 * size].reshape(size, 3)
                return change.ravel()

        line = Line(rig, speed)
        e = np.column_stack([np.sin(lean), np.zeros(size), -np.cos(lean)])
        place = np.vstack([e, [radius, 0, 0]])
        time = 2.25 * math.pi / speed
        done = scipy.integrate.solve_ivp(
            line, (0, time), np.stack([place, 0 * place]).ravel(), "DOP853", rtol=1e-12, atol=1e-14
        )
        end = done.y[:, -1].reshape(2, size + 1, 3)[0]
        off.append(float(np.abs(end[:size, 0] - np.sin(lean) * math.cos(speed * time)).max()) / radius)
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


# -- both ends on the axis


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
    held = rc.held_shapes(chain, span=0.7, conical_height=0.01, most_half_waves=2)
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


def test_held_bearings_carry_weight_and_centrifugal_force():
    chain = rc.Chain.uniform_rods(30, length=1.0, weight=7.0)
    shape = rc.held_shapes(chain, span=0.6, conical_height=0.05)[0]
    down_on_upper, up_on_lower = -shape.upper_pull[1], shape.lower_pull[1]
    assert abs(down_on_upper) - abs(up_on_lower) == pytest.approx(7.0, rel=1e-12)
    middles = (shape.offset[1:] + shape.offset[:-1]) / 2
    total = 7.0 / 30 * middles.sum() / 0.05
    assert abs(shape.upper_pull[0]) + abs(shape.lower_pull[0]) == pytest.approx(abs(total), rel=1e-12)


def test_cord_held_at_both_ends_against_the_force_balance():
    length, span, height = 1.0, 0.55, 0.2
    cord = rc.held_cord_shapes(length, span=span, conical_height=height, weight=3.0)[0]

    def rhs(s, u):  # y, z, and the pull along the cord as a vector, over weight / length
        across, up = u[2], u[3]
        size = math.hypot(across, up)
        return [across / size, up / size, -u[0] / height, 1.0]

    def gap(start):
        end = scipy.integrate.solve_ivp(rhs, (0, length), [0, 0, start[0], start[1]], "DOP853", rtol=1e-12, atol=1e-13)
        return [end.y[0, -1], end.y[1, -1] - span]

    begin = cord.tension[0] / 3.0
    lean = cord.inclination[0]
    start = scipy.optimize.root(gap, [abs(math.sin(lean)) * begin * 1.02, math.cos(lean) * begin * 0.98], tol=1e-12)
    assert np.abs(gap(start.x)).max() < 1e-10
    assert math.hypot(*start.x) == pytest.approx(begin, rel=1e-9)
    inside = scipy.integrate.solve_ivp(
        rhs, (0, length), [0, 0, *start.x], "DOP853", rtol=1e-12, atol=1e-13, t_eval=[0.3, 0.5, 0.8]
    )
    assert cord.at_arc([0.3, 0.5, 0.8]).offset == pytest.approx(inside.y[0], abs=1e-9)


def test_held_links_tend_to_the_held_cord_with_gravity():
    cord = rc.held_cord_shapes(1.0, span=0.6, conical_height=0.15, weight=2.0, most_half_waves=2)
    chains = {count: rc.Chain.uniform_rods(count, length=1.0, weight=2.0) for count in (30, 60, 120)}
    held = {count: rc.held_shapes(c, span=0.6, conical_height=0.15, most_half_waves=2) for count, c in chains.items()}
    for i in range(len(cord)):
        error = []
        for count in chains:
            links = held[count][i]
            want = cord[i].at_arc(np.arange(count + 1) / count).offset
            error.append(np.abs(links.offset - want * np.sign(links.offset[1] * want[1])).max())
        assert error[0] / error[1] == pytest.approx(4, rel=0.2)
        assert error[1] / error[2] == pytest.approx(4, rel=0.2)


def test_held_by_its_tension_is_held_by_its_span():
    chain = random_chain(np.random.default_rng(15), 9)
    span = 0.7 * chain.total_length
    first = rc.held_shapes(chain, span=span, conical_height=0.5)[0]
    again = rc.held_shapes(chain, top_tension=float(first.tension[-1]), conical_height=0.5)
    nearest = min(again, key=lambda s: abs(s.span - span))
    assert nearest.span == pytest.approx(span, rel=1e-9)
    assert nearest.offset == pytest.approx(first.offset, abs=1e-8)


def test_continuous_chain_with_a_tip_weight_at_any_inclination():
    length, height, tip = 1.0, 0.35, 0.4
    found = rc.continuous_shapes(length, conical_height=height, tip_weight=tip)
    first = rc.tip_mass.conical_heights(2, tip=tip, length=length)
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
        shape = rc.held_shapes(chain, span=0.6, angular_speed=20.0, gravity=0.0)[0]
        error.append(abs(shape.offset.max() / rope.sag - 1))
        assert shape.conical_height == 0
    assert error[0] / error[1] == pytest.approx(4, rel=0.15)
    assert error[1] / error[2] == pytest.approx(4, rel=0.15)
    # with gravity, as fast as you like: the same
    fast = rc.held_cord_shapes(1.0, span=0.6, conical_height=1e-8)[0]
    assert float(fast.at_arc(0.5).offset) == pytest.approx(rope.sag, rel=1e-6)
    # tension in the middle is w h: weight 1, times g as masses
    light = rc.held_cord_shapes(1.0, span=0.6, angular_speed=20.0, gravity=0.0)[0]
    assert float(light.at_arc(0.5).tension) == pytest.approx(rope.tension_in_the_middle * G, rel=1e-10)


def test_taut_speeds_against_closed_forms():
    # equal beads on a thread under great tension: n^2 = (4 T / (m a)) sin^2(k pi / 2N)
    count, tension = 8, 1e9
    chain = rc.Chain.uniform_plummets(count, length=1.0, weight=float(count))
    found = rc.taut_modes(chain, tension=tension, count=7)
    k = np.arange(1, 8)
    n2 = 4 * tension * count * np.sin(k * math.pi / 2 / count) ** 2  # over g
    assert 1 / found.conical_height == pytest.approx(n2, rel=1e-8)
    # a heavy cord, tension T below and T + W above: cross products of Bessel functions
    w0, load = 1.0, 0.3
    got = rc.taut_modes(rc.Chain.uniform_rods(600, length=1.0, weight=w0), tension=load, count=3).conical_height

    def cross(x):
        a, b = 2 * math.sqrt(load / x), 2 * math.sqrt((load + 1) / x)
        return scipy.special.j0(a) * scipy.special.y0(b) - scipy.special.j0(b) * scipy.special.y0(a)

    for height in got:
        root = scipy.optimize.brentq(cross, height * 0.999, height * 1.001, xtol=1e-15)
        assert height == pytest.approx(root, rel=2e-4)


def test_taut_speeds_against_a_dense_pencil():
    chain = random_chain(np.random.default_rng(9), 7)
    with mp.workdps(50):
        stiff, _, mass = pencil(rc.Rig(chain))
        for m in range(7):
            k = 2.5 / mp.mpf(float(chain.length[m]))
            for i, j, sign in ((m, m, 1), (m, m + 1, -1), (m + 1, m, -1), (m + 1, m + 1, 1)):
                if i < 7 and j < 7:
                    stiff[i][j] += sign * k
        inside = [row[1:] for row in stiff[1:]]
        heavy = [row[1:] for row in mass[1:]]
        heights = sorted(
            (1 / x for x in mp.eig(mp.matrix(heavy) ** -1 * mp.matrix(inside))[0]), key=mp.re, reverse=True
        )
        got = rc.taut_modes(chain, tension=2.5, count=9)
        assert len(got.conical_height) == 6
        for a, b in zip(got.conical_height, heights, strict=True):
            assert abs(a - mp.re(b)) <= EPS * a


# ---- 2. flywheels -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("momentum", [0.0, 1e-12, 1.0, -3.0, 1e6, -1e9])
def test_one_gyrostat_is_the_top(momentum):
    # A n^2 - H n - W h = 0, A about the pin
    weight, h, rho = 7.0, 0.4, 0.25
    chain = rc.Chain(weight=weight, length=[0.6], centroid=h, radius_of_gyration=rho)
    found = rc.modes(rc.Rig(chain, momentum=momentum))
    with mp.workdps(50):
        about = mp.mpf(weight) * (mp.mpf(h) ** 2 + mp.mpf(rho) ** 2) / mp.mpf(G)
        root = mp.sqrt(mp.mpf(momentum) ** 2 + 4 * about * mp.mpf(weight) * mp.mpf(h))
        plus, minus = (momentum + root) / (2 * about), (momentum - root) / (2 * about)
        want = sorted([plus, minus], key=abs) if momentum else [plus]
        assert len(found) == len(want)
        for got, exact in zip(found.angular_speed, want, strict=True):
            assert abs(got - exact) <= 4 * EPS * abs(exact)
    assert found.direction.tolist() == [1 if n > 0 else -1 for n in want]


def test_two_gyrostats_quartic():
    rng = np.random.default_rng(20)
    for _ in range(60):
        w, a, h = np.exp(rng.uniform(-2, 2, 2)), np.exp(rng.uniform(-1, 1, 2)), np.exp(rng.uniform(-1, 0.3, 2))
        rho, p = np.exp(rng.uniform(-2, 0, 2)), rng.normal(0, 3, 2)
        chain = rc.Chain(weight=w, length=a, centroid=h, radius_of_gyration=rho)
        found = rc.modes(rc.Rig(chain, momentum=p))
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
    rig = rc.Rig(chain, momentum=momentum, stiffness=[math.inf, 10.0][seed % 2], carriage_weight=0.5 * (seed % 2))
    found = rc.modes(rig)
    agree(rig, found, digits=90)
    assert found.complete
    if strength:
        count = size + (seed % 2)
        assert found.available == (count, count)
        for sense in (1, -1):
            assert found.number[found.direction == sense].tolist() == list(range(1, count + 1))


@given(
    data=st.lists(
        st.tuples(
            st.floats(1e-3, 1e3), st.floats(0.05, 5), st.floats(0.05, 1.5), st.floats(0.02, 1.0), st.floats(-50, 50)
        ),
        min_size=1,
        max_size=4,
    )
)
@settings(max_examples=40)
def test_flywheels_of_any_kind(data):
    w, a, h, rho, p = (np.array(x) for x in zip(*data, strict=True))
    rig = rc.Rig(rc.Chain(weight=w, length=a, centroid=h * a, radius_of_gyration=rho * a), momentum=p)
    agree(rig, rc.modes(rig), digits=90)


def test_dense_linearisation_of_two_hundred_gyrostats():
    rng = np.random.default_rng(3)
    size = 200
    chain = rc.Chain(weight=rng.uniform(0.5, 2, size), length=0.01, centroid=0.005, radius_of_gyration=0.006)
    rig = rc.Rig(chain, momentum=rng.normal(size=size) * 0.02)
    stiff, spin, mass = (np.array(x, dtype=float) for x in pencil(rig, number=float))
    inverse = np.linalg.inv(mass / G)
    big = np.block([[np.zeros((size, size)), np.eye(size)], [inverse @ stiff, inverse @ spin]])
    want = np.sort(np.linalg.eigvals(big).real)
    found = rc.modes(rig, "all")
    assert len(found) == 400
    assert np.sort(found.angular_speed) == pytest.approx(want, rel=1e-7, abs=1e-7)


@pytest.mark.parametrize(("size", "slowest"), [(30, 30), (1000, 40), (10000, 12)])
def test_flywheel_speeds_of_long_chains_bracketed_in_extended_precision(size, slowest):
    rng = np.random.default_rng(size)
    chain = rc.Chain(
        weight=np.exp(rng.normal(size=size)),
        length=rng.uniform(0.5, 1.5, size),
        centroid=rng.uniform(0.2, 0.9, size),
        radius_of_gyration=rng.uniform(0.1, 0.4, size),
    )
    rig = rc.Rig(chain, momentum=rng.normal(size=size) * chain.weight.sum() * 0.3)
    found = rc.modes(rig, count=slowest)
    tolerance = 4 * EPS * (1 + math.log10(size))
    for sense in (1, -1):
        half = found.angular_speed[found.direction == sense]
        assert len(half) == slowest and np.all(half * sense > 0)
        inside, outside = half * (1 - tolerance), half * (1 + tolerance)
        assert pivots(rig, inside).tolist() == list(range(slowest))
        assert pivots(rig, outside).tolist() == list(range(1, slowest + 1))


def test_shapes_of_whirl_modes_with_flywheels():
    rng = np.random.default_rng(8)
    rig = rc.Rig(random_chain(rng, 5), momentum=rng.normal(size=5) * 2, stiffness=15.0)
    found = rc.modes(rig)
    with mp.workdps(40):
        stiff, spin, mass = (mp.matrix(x) for x in pencil(rig))
        for shape, n in zip(found.shape, found.angular_speed, strict=True):
            n = mp.mpf(float(n))
            y = mp.matrix([mp.mpf(float(x)) for x in shape])
            assert max(abs(x) for x in y) == 1
            assert y[0] > 0
            parts = [stiff * y, n * spin * y, n**2 / mp.mpf(G) * mass * y]
            left = mp.norm(parts[0] + parts[1] - parts[2], mp.inf)
            assert left <= 1e-14 * (
                mp.mnorm(stiff, 1) + abs(n) * mp.mnorm(spin, 1) + n**2 / mp.mpf(G) * mp.mnorm(mass, 1)
            )


def test_momentum_of_the_other_sign_is_the_mirror_image():
    rng = np.random.default_rng(12)
    chain, p = random_chain(rng, 6), rng.normal(size=6)
    one, other = rc.modes(rc.Rig(chain, momentum=p)), rc.modes(rc.Rig(chain, momentum=-p))
    assert len(one) == 12
    assert np.array_equal(one.angular_speed, -other.angular_speed)
    assert np.array_equal(one.direction, -other.direction)


def test_wheels_turned_by_a_motor_feel_less_inertia():
    # spin relative to the link that turns with the whole: A - C
    chain = rc.Chain(weight=5.0, length=[0.5], centroid=0.3, radius_of_gyration=0.2)
    spin = rc.driven_flywheel(weight=2.0, radius_of_gyration=0.25, spin=60.0)
    c = 2.0 * 0.25**2
    assert spin["momentum"] == pytest.approx(c * 60 / G, rel=EPS)
    found = rc.modes(rc.Rig(chain, **spin)).angular_speed
    about = (5.0 * (0.3**2 + 0.2**2) - c) / G
    want = np.roots([about, -c * 60 / G, -5.0 * 0.3])
    assert np.sort(found) == pytest.approx(np.sort(want), rel=1e-13)
    # free of a motor: absolute spin
    free = rc.free_flywheel(weight=2.0, radius_of_gyration=0.25, spin=60.0)
    want = np.roots([about + c / G, -c * 60 / G, -5.0 * 0.3])
    assert np.sort(rc.modes(rc.Rig(chain, **free)).angular_speed) == pytest.approx(np.sort(want), rel=1e-13)


@pytest.mark.parametrize("lean", [0.05, 0.7, 1.5])
@pytest.mark.parametrize("sense", [1, -1])
def test_steady_precession_of_a_gyrostat_is_the_textbook_tops(lean, sense):
    # A' cos(th) phi'^2 - C w phi' + W h = 0 with th = pi - lean, C w = -H
    weight, h, rho, momentum = 10.0, 0.5, 0.3, 4.0
    about = weight / G * (h * h + rho * rho)
    n = [x for x in np.roots([about * math.cos(lean), -momentum, -weight * h]) if x * sense > 0][0]
    rig = rc.Rig(rc.Chain(weight=weight, length=[1.0], centroid=h, radius_of_gyration=rho), momentum=momentum)
    kappa = weight * h + n * momentum
    if kappa <= 0:
        pytest.skip("no effective tension")
    shapes = rc.steady_shapes(rig, angular_speed=abs(n), sense=sense)
    assert shapes.complete
    assert [s.inclination[0] for s in shapes] == pytest.approx([lean], abs=1e-12)
    assert Motion(rig, n).run(shapes[0].inclination, 0.0, turns=1) < 1e-8
    turning = shapes[0].angular_momentum
    want = about * math.sin(lean) ** 2 * n + momentum * math.cos(lean)
    assert turning == pytest.approx(want, rel=1e-12)


def test_three_gyrostats_turn_as_one_piece_in_both_senses():
    chain = rc.Chain(weight=[2.0, 3.0, 1.5], length=[0.4, 0.3, 0.5], centroid=[0.2, 0.15, 0.3], radius_of_gyration=0.15)
    rig = rc.Rig(chain, momentum=[0.25, -0.1, 0.4], axial_moment=[0.02, 0.0, 0.01])
    for sense in (1, -1):
        for speed in (8.0, 14.0):
            try:
                shapes = rc.steady_shapes(rig, angular_speed=speed, sense=sense)
            except ValueError as error:
                assert "tension" in str(error)
                continue
            for shape in shapes:
                n = sense * speed
                assert figure_moments(rig, shape, sense=sense) <= 2e-14
                axial = rig.momentum + rig.axial_moment / G * n * np.cos(shape.inclination)
                assert Motion(rig, n, axial=axial).run(shape.inclination, 0.0, turns=0.4) < 1e-8


def test_slack_links_are_named_with_the_speed():
    # kappa + n H = 0 at n = -kappa / H
    chain = rc.Chain(weight=[1.0, 2.0], length=[0.5, 0.4])
    rig = rc.Rig(chain, momentum=[0.2, 0.0])
    found = rc.modes(rig)
    assert found.slack_link.tolist() == [0]
    assert found.slack_speed == pytest.approx([-0.5 / 0.2], rel=4 * EPS)
    # exactly there, in powers of two: 0.5 - 2 * 0.25
    none = rc.Rig(chain, momentum=[0.25, 0.0])
    with pytest.raises(ValueError, match="tension"):
        rc.steady_shapes(none, angular_speed=2.0, gravity=4.0, sense=-1)
    assert len(rc.modes(rc.Rig(chain)).slack_link) == 0
    assert rc.modes(none, gravity=4.0).slack_speed.tolist() == [-2.0]
    fine = rc.modes(rc.Rig(chain, momentum=[1e-6, 0.0]))
    fastest = -fine.angular_speed.min()
    assert len(fine.slack_link) == int(0.5 / 1e-6 < fastest)


@pytest.mark.parametrize("momentum", [0.0, 0.5, -2.0])
@pytest.mark.parametrize("rho", [0.0, 0.2])
def test_gyrostatic_string_dispersion(momentum, rho):
    weight, a, tension, h = 12.0, 0.3, 500.0, 0.1
    string = rc.GyrostaticString(
        weight=weight, length=a, tension=tension, momentum=momentum, centroid=h, radius_of_gyration=rho
    )
    # a travelling wave y_m = exp(-i m phase) put in row by row
    q = weight * (h * h + rho * rho) / a**2
    r = weight * ((a - h) ** 2 + rho * rho) / a**2
    off = weight * (h * (a - h) - rho * rho) / a**2
    for phase in (1e-3, 0.5, 2.0, math.pi):
        stiff, spin = 2 * (1 - math.cos(phase)) * tension / a, 2 * (1 - math.cos(phase)) * momentum / a**2
        mass = (q + r + 2 * off * math.cos(phase)) / G
        want = np.sort(np.roots([mass, -spin, -stiff]))
        speeds = string.angular_speeds(phase)
        got = np.sort([float(np.asarray(x)) for x in tuple(speeds)])
        assert np.sort(np.abs(got)) == pytest.approx(np.sort(np.abs(want)), rel=1e-12)
        for n in want:
            assert float(string.phase(n)) == pytest.approx(phase, rel=1e-7 if phase == math.pi else 1e-11)


def test_plane_of_vibration_turns_along_the_string():
    weight, a, tension, h, momentum = 12.0, 0.3, 500.0, 0.15, 0.5
    string = rc.GyrostaticString(weight=weight, length=a, tension=tension, momentum=momentum, radius_of_gyration=0.1)
    n = 15.0
    # drive one end of a long string to and fro along x, its other end with a matched load: here, march two
    # circular waves with the real rows and add them
    rows = []
    for sense in (1, -1):
        k = tension / a + sense * n * momentum / a**2
        q = weight * (h * h + 0.01) / a**2
        off = weight * (h * (a - h) - 0.01) / a**2
        mu = n * n / G
        cosine = (2 * k - mu * 2 * q) / (2 * (k + mu * off))
        rows.append(math.acos(cosine))
    want = (rows[1] - rows[0]) / 2
    got = float(string.plane_rotation(n))
    assert abs(got) == pytest.approx(abs(want), rel=1e-11)
    assert got > 0  # in the sense of a positive momentum
    # x + i y of the sum: exp(i(nt - m phase+)) + exp(-i(nt - m phase-)); the plane of link m lies at m (phase- - phase+) / 2
    m = 7
    t = np.linspace(0, 2 * math.pi / n, 200)
    z = np.exp(1j * (n * t - m * rows[0])) + np.exp(-1j * (n * t - m * rows[1]))
    assert np.abs(np.imag(z * np.exp(-1j * m * got))).max() < 1e-9
    assert float(rc.GyrostaticString(weight=1.0, length=1.0, tension=1.0, momentum=0.0).plane_rotation(0.5)) == 0.0
    tiny = rc.GyrostaticString(weight=weight, length=a, tension=tension, momentum=1e-200, radius_of_gyration=0.1)
    assert float(tiny.plane_rotation(n)) == pytest.approx(got / momentum * 1e-200, rel=0.01)


def test_gyrostatic_string_stops_waves():
    string = rc.GyrostaticString(weight=G, length=1.0, tension=100.0, momentum=0.0, centroid=1.0)
    # beads of mass 1: n^2 = 400 sin^2(phase / 2); beyond, 2 cosh - 2 over: 400 cosh^2(x / 2) = n^2
    assert float(string.attenuation(40.0)) == pytest.approx(2 * math.acosh(2.0), rel=1e-12)
    assert float(string.attenuation(10.0)) == 0.0
    assert math.isnan(float(string.plane_rotation(40.0)))
    with pytest.raises(ValueError, match="40"):
        string.plot_vibration(40.0)


# ---- 3. weight that is not mass ---------------------------------------------------------------------------------


def test_pendulum_in_still_water():
    # W h - B hb bears, W (h^2 + rho^2) + added whirls
    weight, h, rho, b, hb, rb, add = 10.0, 0.5, 0.2, 4.0, 0.45, 0.25, 3.0
    rig = rc.Rig(
        rc.Chain(weight=weight, length=[1.0], centroid=h, radius_of_gyration=rho),
        displaced_weight=b,
        displaced_centroid=hb,
        displaced_radius_of_gyration=rb,
        added_weight=add,
    )
    want = (weight * (h * h + rho * rho) + add * (hb * hb + rb * rb)) / (weight * h - b * hb)
    assert rc.modes(rig).conical_height == pytest.approx([want], rel=4 * EPS)


def test_cork_on_a_thread_does_not_stay_below():
    # displaces five times its weight: hanging it is unstable, and grows as it falls (upwards) from there
    rig = rc.Rig(rc.Chain(weight=1.0, length=0.8), displaced_weight=5.0, added_weight=2.5)
    found = rc.modes(rig)
    assert len(found) == 0
    assert len(found.angular_speed) == 0
    height = 0.8 * (1 + 2.5) / (1 - 5.0)
    assert found.other.conical_height == pytest.approx([height], rel=4 * EPS)
    rate = math.sqrt(G / -height)
    assert found.other.growth_rate == pytest.approx([rate], rel=4 * EPS)
    # and so it does, in the full motion
    motion = Motion(rig, 1.0)
    lean = 1e-6
    e = np.array([[math.sin(lean), 0, -math.cos(lean)], [0, 0, 0]])
    done = scipy.integrate.solve_ivp(motion, (0, 1.0), np.stack([e, 0 * e]).ravel(), "DOP853", rtol=1e-11, atol=1e-15)
    assert done.y[0, -1] == pytest.approx(lean * math.cosh(rate), rel=1e-6)
    # held from below, the buoy stands
    buoy = rc.modes(rc.Rig(rc.Chain(weight=1.0, length=0.8), displaced_weight=5.0, added_weight=2.5, standing=True))
    assert buoy.conical_height == pytest.approx([-height], rel=4 * EPS)


@pytest.mark.parametrize("ratio", [-0.5, -0.1, -0.25])
@pytest.mark.parametrize("x", [0.0, 0.3, 0.6, 0.9])
def test_stokes_float(ratio, x):
    # net weight of the lower plummet is ratio times the upper's, in K and in M
    rig = rc.Rig(
        rc.Chain(weight=[0.5, 1.0], length=[1 + x, 1 - x]), displaced_weight=[0.5 - ratio, 0.0], fluid="turning"
    )
    found = rc.modes(rig)
    with mp.workdps(40):
        mu = mp.mpf(0.5) - mp.mpf(0.5 - ratio)
        l1, l2 = mp.mpf(1 + x), mp.mpf(1 - x)
        product = mu * l1 * l2 / (mu + 1)
        # (z - l1)(z - l2) = product
        root = mp.sqrt(((l1 - l2) / 2) ** 2 + product)
        want = [(l1 + l2) / 2 + root, (l1 + l2) / 2 - root]
    if abs(mp.im(want[0])) > 0:
        assert len(found) == 0
        assert len(found.other) == 2
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
    rig = rc.Rig(
        chain,
        displaced_weight=chain.weight * rng.uniform(0, 1.8, size),
        displaced_centroid=chain.length * rng.uniform(0, 1, size),
        displaced_radius_of_gyration=chain.length * rng.uniform(0, 0.5, size),
        added_weight=chain.weight * rng.uniform(0, 1, size) if fluid == "still" else 0.0,
        fluid=fluid,
        standing=rng.random(size) < 0.3,
        stiffness=[math.inf, 12.0][seed % 3 == 0],
    )
    found = rc.modes(rig)
    with mp.workdps(60):
        stiff, _, mass = (mp.matrix(x) for x in pencil(rig))
        heights = [z for z in mp.eig(stiff**-1 * mass)[0] if abs(z) > mp.mpf(10) ** -30]
    real = sorted((mp.re(z) for z in heights if abs(mp.im(z)) < abs(z) * 1e-25 and mp.re(z) > 0), reverse=True)
    rest = [z for z in heights if not (abs(mp.im(z)) < abs(z) * 1e-25 and mp.re(z) > 0)]
    assert found.complete
    assert len(found) == len(real)
    assert len(found.other) == len(rest)
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
    for fluid in ("still", "turning"):
        for density in (1e-4, 1e-8, 0.0):
            found = rc.modes(rc.Rig(chain, displaced_weight=density * chain.weight, fluid=fluid)).conical_height
            assert np.abs(found / bare - 1).max() <= 30 * density + 4 * EPS


def test_links_as_heavy_as_the_fluid():
    # turning with it, a link that weighs nothing in the water is not there
    chain = rc.Chain(weight=[1.0, 2.0], length=[0.5, 0.8])
    rig = rc.Rig(chain, displaced_weight=[0.0, 2.0], fluid="turning")
    assert rc.modes(rig).conical_height == pytest.approx([1.3], rel=4 * EPS)
    # in still water it moves without weight: an infinite height is no mode
    still = rc.modes(rc.Rig(chain, displaced_weight=[1.0, 0.0]))
    assert len(still) == 1
    assert still.conical_height == pytest.approx([0.8], rel=4 * EPS)
    assert (
        still.other.conical_height == [np.inf] and still.other.growth_rate == [0.0] and still.other.error_bound == [0.0]
    )
    assert still.status == "success"


@pytest.mark.parametrize("size", [1, 2, 3])
def test_lowest_link_that_weighs_nothing_is_no_mode(size):
    rig = rc.Rig(
        rc.Chain(weight=np.ones(size), length=np.ones(size)),
        displaced_weight=[1.0] + [0.0] * (size - 1),
        fluid="turning",
    )
    # of the others the heights are those of the chain without it
    want = (
        list(rc.modes(rc.Chain(weight=np.ones(size - 1), length=np.ones(size - 1))).conical_height) if size > 1 else []
    )
    assert rc.modes(rig).conical_height == pytest.approx(want, rel=4 * EPS)


def test_gyrostat_that_weighs_nothing_has_one_speed():
    # A n^2 - H n = 0: it stays where it is put, or precesses at H / A
    found = rc.modes(rc.Rig(rc.Chain(weight=1.0, length=[1.0]), displaced_weight=1.0, momentum=3.0))
    assert np.isfinite(found.angular_speed).all()
    assert found.angular_speed[-1] == pytest.approx(3 * G, rel=4 * EPS)


def test_float_lighter_than_all_above_is_proved():
    # net weights -2 and 1.5: (z - 1)^2 = 4
    rig = rc.Rig(rc.Chain(weight=[1.0, 2.0], length=1.0), displaced_weight=[3.0, 0.5], fluid="turning")
    found = rc.modes(rig)
    assert found.conical_height == pytest.approx([3.0], rel=4 * EPS)
    assert found.other.conical_height == pytest.approx([-1.0], rel=4 * EPS)
    assert found.status == "success"


def test_figures_of_a_float_at_any_inclination():
    chain = rc.Chain(weight=[2.0, 5.0, 3.0], length=[0.6, 0.5, 0.4], centroid=[0.3, 0.25, 0.2], radius_of_gyration=0.15)
    for fluid, added in (("still", [0.5, 0.5, 0.2]), ("turning", 0.0)):
        rig = rc.Rig(chain, displaced_weight=[1.5, 1.0, 3.5], added_weight=added, fluid=fluid)
        first = rc.modes(rig).conical_height[0]
        shapes = rc.steady_shapes(rig, conical_height=0.5 * first)
        assert len(shapes) >= 1
        for shape in shapes:
            assert figure_moments(rig, shape) <= 1e-14
            if fluid == "still":
                speed = math.sqrt(G / (0.5 * first))
                assert Motion(rig, speed).run(shape.inclination, 0.0, turns=0.4) < 1e-8


# ---- 4. standing links ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("thread", [1e-3, 1.0, 1e3])
def test_broomstick_on_a_moving_hand(thread):
    h, rho = 0.6, 0.6 / 3**0.5
    # the hand is the end of a thread of that length: a massless link hung, the stick standing on it
    chain = rc.Chain(weight=[1.0, 0.0], length=[1.2, thread], centroid=[h, thread], radius_of_gyration=[rho, 0.0])
    found = rc.modes(rc.Rig(chain, standing=[True, False]))
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
    rig = rc.Rig(chain, standing=[True, False])
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
    rig = rc.Rig(chain, standing=[True, False])
    height = 0.7 * rc.modes(rig).conical_height[0]
    for shape in rc.steady_shapes(rig, conical_height=height):
        assert figure_moments(rig, shape) <= 1e-14
        assert Motion(rig, math.sqrt(G / height)).run(shape.inclination, 0.0, turns=0.3) < 1e-7


@pytest.mark.parametrize("seed", range(12))
def test_as_many_speeds_as_links_hang(seed):
    rng = np.random.default_rng(300 + seed)
    size = int(rng.integers(1, 30))
    standing = rng.random(size) < 0.5
    rig = rc.Rig(random_chain(rng, size), standing=standing)
    found = rc.modes(rig, "all")
    assert len(found) == int((~standing).sum())  # Sylvester
    assert len(found.other) == int(standing.sum())
    assert np.all(found.other.conical_height.real < 0)
    if size <= 8:
        agree(rig, found)


def test_all_standing_and_acrobats():
    chain = rc.Chain.uniform_rods(50, length=2.0)
    found = rc.modes(rc.Rig(chain, standing=True))
    hanging = rc.modes(chain, "all").conical_height
    assert len(found) == 0
    assert np.sort(-found.other.conical_height.real) == pytest.approx(np.sort(hanging), rel=1e-14)
    # what stands on a link with a fast wheel does not fall: a sleeping top, H^2 > 4 A W h
    top = rc.Chain(weight=G, length=[1.0], centroid=0.5, radius_of_gyration=0.3)
    about = 0.34
    slow = rc.modes(rc.Rig(top, standing=True, momentum=0.99 * math.sqrt(4 * about * G * 0.5)))
    fast = rc.modes(rc.Rig(top, standing=True, momentum=1.01 * math.sqrt(4 * about * G * 0.5)))
    assert len(slow) == 0
    assert len(slow.other) >= 1
    assert len(fast) == 2
    assert len(fast.other) == 0
    want = np.roots([about, -1.01 * math.sqrt(4 * about * G * 0.5), G * 0.5])
    assert np.sort(np.abs(fast.angular_speed)) == pytest.approx(np.sort(np.abs(want)), rel=1e-12)


# ---- 5. attached weights ----------------------------------------------------------------------------------------


def test_tip_mass_on_the_continuous_chain():
    for tip, length in [(0.0, 1.0), (1e-8, 1.0), (0.3, 2.0), (1e6, 1.0), (1e-3, 1e5)]:
        found = rc.tip_mass.conical_heights(4, tip=tip, length=length)
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
    want = rc.tip_mass.conical_heights(3, tip=0.4, length=1.0)
    error = []
    for count in (50, 100, 200):
        chain = rc.Chain.uniform_rods(count, length=1.0, weight=2.0).with_weight(0.8)
        error.append(np.abs(rc.modes(chain, count=3).conical_height / want - 1))
    assert np.all(np.abs(error[0] / error[1] - 4) < 0.2)
    assert np.all(np.abs(error[1] / error[2] - 4) < 0.2)


@pytest.mark.parametrize("pin", [0, 1, 3])
def test_weight_at_a_pin_and_a_thread_anywhere(pin):
    rng = np.random.default_rng(55)
    chain = random_chain(rng, 4)
    extra = chain.with_weight(1.7, pin=pin, radius_of_gyration=0.3)
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
    rig = rc.Rig(longer)
    found = rc.modes(longer)
    want = sorted((mp.mpf(G) / n**2 for n in real_speeds(rig, digits=80) if n > 0), reverse=True)
    assert len(want) == len(found) == longer.mode_count
    for got, exact in zip(found.conical_height, want, strict=True):
        assert abs(got - exact) <= 4 * EPS * exact


def test_clamped_pairs():
    rng = np.random.default_rng(66)
    chain = random_chain(rng, 4)
    for link in (1, 2, 3):
        stiff, _, mass = pencil(rc.Rig(chain), number=float)
        # constraint: pin `link` lies on the line of its neighbours
        a = chain.length
        part = np.eye(4)
        share = a[link] / (a[link - 1] + a[link])  # of the lower pin's offset
        column = np.zeros(4)
        part = np.delete(part, link, axis=1)
        part[link, :] = 0
        part[link, link - 1] = share
        if link + 1 < 4:
            part[link, link] = 1 - share
        del column
        want = scipy.linalg.eigh(part.T @ np.array(mass) @ part, part.T @ np.array(stiff) @ part, eigvals_only=True)
        got = rc.modes(chain.clamped(link)).conical_height
        assert got == pytest.approx(np.sort(want)[::-1], rel=1e-12)
    free = rc.modes(chain).conical_height
    assert np.all(got <= free[:3] * (1 + 4 * EPS))
    assert np.all(got >= free[1:] * (1 - 4 * EPS))
    with pytest.raises(ValueError, match="4"):
        chain.clamped(4)


def test_bell_and_clapper_one_piece_and_not():
    data = dict(weight=[18.0, 500.0], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    bell = rc.bell_and_clapper(rc.Chain(**data))
    modes = rc.modes(rc.Chain(**data))
    assert bell.conical_height == pytest.approx(tuple(modes.conical_height), rel=4 * EPS)
    y = modes.shape
    ratio = (y[:, 0] - y[:, 1]) / 0.65 / ((y[:, 1] - y[:, 2]) / 0.15)
    assert bell.inclination_ratio == pytest.approx(tuple(ratio), rel=1e-13)
    m = 500 * 0.2 / (18 * 0.15)
    l1, l2 = 0.52 + 0.08**2 / 0.52, 0.2 + 0.3**2 / 0.2
    assert bell.mismatch == pytest.approx(0.52 - (m + 1) * l1 - m * (0.15 - l2), rel=1e-12)
    names = {
        "clapper_weight": ("weight", 0),
        "clapper_centroid": ("centroid", 0),
        "clapper_radius_of_gyration": ("radius_of_gyration", 0),
        "bell_weight": ("weight", 1),
        "bell_centroid": ("centroid", 1),
        "bell_radius_of_gyration": ("radius_of_gyration", 1),
        "joint": ("length", 1),
    }
    assert set(bell.derivative) == set(names) == set(bell.present)

    def changed(name, value):
        new = {k: list(v) for k, v in data.items()}
        new[names[name][0]][names[name][1]] = value
        return rc.bell_and_clapper(rc.Chain(**new))

    for name, value in bell.with_ratio(1.0).items():
        step = 1e-5 * bell.present[name]
        slope = (
            changed(name, bell.present[name] + step).inclination_ratio[0]
            - changed(name, bell.present[name] - step).inclination_ratio[0]
        ) / (2 * step)
        assert bell.derivative[name] == pytest.approx(slope, rel=1e-7, abs=1e-9)
        if not math.isnan(value):
            silent = changed(name, value)
            assert silent.inclination_ratio[0] == pytest.approx(1, abs=1e-12)
            assert silent.mismatch == pytest.approx(0, abs=1e-12)
            assert silent.conical_height[0] == pytest.approx(silent.silent_height, rel=1e-12)
            clamped = rc.modes(silent.chain.clamped(1)).conical_height[0]
            assert clamped == pytest.approx(silent.conical_height[0], rel=1e-12)
            # and at any inclination, the pair is straight
            shape = rc.steady_shapes(silent.chain, conical_height=0.8 * silent.silent_height)[0]
            assert shape.inclination[0] == pytest.approx(shape.inclination[1], abs=1e-9)


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


# ---- 6. inverse questions ---------------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
def test_sensitivities_against_central_differences(seed):
    rng = np.random.default_rng(400 + seed)
    size = 4
    chain = random_chain(rng, size)
    modes = rc.modes(chain)
    found = modes.sensitivity
    names = ("weight", "length", "centroid", "radius_of_gyration")
    data = {k: [mp.mpf(float(x)) for x in getattr(chain, k)] for k in names}

    def heights(values):
        with mp.workdps(60):
            stiff, mass = mp.zeros(size), mp.zeros(size)
            below = mp.mpf(0)
            for m in range(size):
                w, a, h, rho = (values[k][m] for k in ("weight", "length", "centroid", "radius_of_gyration"))
                kappa = w * h + a * below
                below += w
                lean, at = mp.zeros(size, 1), mp.zeros(size, 1)
                lean[m], at[m] = 1 / a, h / a
                if m + 1 < size:
                    lean[m + 1], at[m + 1] = -1 / a, 1 - h / a
                stiff += kappa * lean * lean.T
                mass += w * at * at.T + w * rho**2 * lean * lean.T
            return sorted((mp.re(z) for z in mp.eig(stiff**-1 * mass)[0]), reverse=True)

    for quantity in ("weight", "length", "centroid", "radius_of_gyration", "length_in_proportion"):
        for m in range(size):
            with mp.workdps(60):
                sides = []
                step = mp.mpf(10) ** -18
                for sign in (1, -1):
                    new = {k: list(v) for k, v in data.items()}
                    if quantity == "length_in_proportion":
                        for k in ("length", "centroid", "radius_of_gyration"):
                            new[k][m] *= 1 + sign * step
                        width = data["length"][m] * step
                    else:
                        new[quantity][m] *= 1 + sign * step
                        width = data[quantity][m] * step
                    sides.append(heights(new))
                want = [(u - v) / (2 * width) for u, v in zip(*sides, strict=True)]
            for k in range(size):
                got, exact = found[quantity][k, m], float(want[k])
                largest = np.abs(found[quantity][k]).max()
                assert abs(got - exact) <= 1e-12 * abs(exact) + 1e-15 * largest
                assert abs(got - exact) <= found.error_bound[quantity][k, m] + 1e-15 * abs(exact) + 1e-16 * largest
    relative = found.relative
    assert relative["weight"].sum(axis=1) == pytest.approx(np.zeros(size), abs=1e-14)
    assert relative["length_in_proportion"].sum(axis=1) == pytest.approx(np.ones(size), rel=1e-14)


def test_uncertainty_is_the_propagation_of_errors():
    rng = np.random.default_rng(77)
    chain = random_chain(rng, 5)
    modes = rc.modes(chain)
    s = modes.sensitivity
    dw, da = 0.01 * chain.weight, 0.002
    found = modes.uncertainty(weight=dw, length=da)
    want = np.sqrt(((s.weight * dw) ** 2).sum(axis=1) + ((s.length * da) ** 2).sum(axis=1))
    assert found.conical_height == pytest.approx(want, rel=1e-13)
    assert found.relative == pytest.approx(want / modes.conical_height, rel=1e-13)
    assert found.angular_speed == pytest.approx(modes.angular_speed * want / modes.conical_height / 2, rel=1e-13)
    total = found.share.weight.sum(axis=1) + found.share.length.sum(axis=1)
    assert total == pytest.approx(np.ones(5), rel=1e-12)
    # one weight shared by all links by a factor moves nothing
    same = modes.uncertainty(weight=np.outer(chain.weight, chain.weight))
    assert same.relative == pytest.approx(np.zeros(5), abs=1e-7)
    # sampling
    sample = []
    for _ in range(300):
        new = rc.Chain(
            weight=chain.weight * (1 + 0.01 * rng.normal(size=5)),
            length=chain.length,
            centroid=chain.centroid,
            radius_of_gyration=chain.radius_of_gyration,
        )
        sample.append(rc.modes(new).conical_height)
    assert np.std(sample, axis=0) == pytest.approx(modes.uncertainty(weight=dw).conical_height, rel=0.25)


@pytest.mark.parametrize("quantity", ["weight", "length", "centroid", "radius_of_gyration", "length_in_proportion"])
def test_tuning_hits_the_height_wanted(quantity):
    rng = np.random.default_rng(500)
    chain = random_chain(rng, 5)
    heights = rc.modes(chain).conical_height
    for mode, link in itertools.product((1, 3), (1, 3, 5)):
        if quantity == "length" and link == 1:
            continue
        # the height of a chain in which the datum is 7 per cent more
        new = {k: getattr(chain, k).copy() for k in ("weight", "length", "centroid", "radius_of_gyration")}
        for k in (quantity,) if quantity in new else ("length", "centroid", "radius_of_gyration"):
            new[k][link - 1] *= 1.07
        height = float(rc.modes(rc.Chain(**new)).conical_height[mode - 1])
        if abs(height / heights[mode - 1] - 1) < 1e-9:
            continue
        tuned = rc.tune(chain, mode=mode, link=link, quantity=quantity, conical_height=height)
        assert tuned.status == "found"
        got = rc.modes(tuned.system).conical_height[mode - 1]
        assert got == pytest.approx(height, rel=1e-13)
        planted = new[quantity if quantity in new else "length"][link - 1]
        if tuned.complete:
            # double precision cannot tell the planted value better than this from its height
            assert np.abs(tuned.values / planted - 1).min() < 1e-5


def test_tuning_what_cannot_be():
    chain = rc.Chain(weight=[1.0, 3.0], length=1.0)
    tuned = rc.tune(chain, link=1, quantity="weight", conical_height=2.5)  # never above 2
    assert tuned.status == "no_value"
    assert tuned.value is None and tuned.error_bound is None
    assert tuned.system is None
    assert tuned.reachable[1] < 2.0
    for bad in (
        dict(link=0, quantity="weight", conical_height=1.0),
        dict(link=3, quantity="weight", conical_height=1.0),
        dict(link=1, quantity="colour", conical_height=1.0),
        dict(link=1, quantity="weight"),
        dict(link=1, quantity="weight", conical_height=1.0, angular_speed=2.0),
        dict(link=1, quantity="weight", conical_height=-1.0),
        dict(link=1, quantity="weight", conical_height=math.nan),
        dict(link=1, quantity="weight", conical_height=1.0, mode=3),
        dict(link=1, quantity="weight", conical_height=1.0, mode=0),
        dict(link=1, quantity="weight", conical_height=1.0, between=(2.0, 1.0)),
    ):
        with pytest.raises(ValueError):
            rc.tune(chain, **bad)


def test_momentum_that_makes_a_speed_a_whirl_speed():
    rng = np.random.default_rng(600)
    rig = rc.Rig(random_chain(rng, 4), momentum=rng.normal(size=4))
    for link, speed in itertools.product((1, 2, 4), (2.0, -7.0)):
        momentum = rc.momentum_for_speed(rig, speed, link=link)
        p = rig.momentum.copy()
        p[link - 1] = momentum
        got = rc.modes(rc.Rig(rig.chain, momentum=p)).angular_speed
        assert np.abs(got / speed - 1).min() < 1e-13


@pytest.mark.parametrize("gravity", [G, 1.62])
def test_speeds_differentiated_by_what_a_chain_is_rigged_with(gravity):
    rng = np.random.default_rng(700)
    chain = random_chain(rng, 4)
    data = dict(
        stiffness=20.0,
        carriage_weight=0.6,
        momentum=rng.normal(size=4),
        displaced_weight=0.3 * chain.weight,
        added_weight=0.2 * chain.weight,
    )
    rig = rc.Rig(chain, **data)
    modes = rc.modes(rig, gravity=gravity)
    for i in (0, 3, 6):
        speed = modes.angular_speed[i]
        for name in data:
            value = np.atleast_1d(data[name])
            for m in range(len(value)):
                sides = []
                step = 1e-4 * max(abs(value[m]), 1e-3)
                for sign in (1, -1):
                    new = value.copy().astype(float)
                    new[m] += sign * step
                    other = rc.Rig(chain, **{**data, name: new if len(value) > 1 else float(new[0])})
                    altered = rc.modes(other, gravity=gravity)
                    sides.append(altered.angular_speed[np.argmin(np.abs(altered.angular_speed - speed))])
                want = (sides[0] - sides[1]) / (2 * step)
                got = np.atleast_1d(getattr(modes.sensitivity, name)[i])[m]
                assert got == pytest.approx(want, rel=2e-6, abs=1e-8 * abs(speed))


# ---- 7. small oscillations in time ------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(3))
def test_swing_against_the_exponential_of_a_matrix(seed):
    rng = np.random.default_rng(800 + seed)
    size = 5
    chain = random_chain(rng, size)
    start, push = rng.normal(size=size) * 0.01, rng.normal(size=size) * 0.02 * (seed > 0)
    times = np.array([0.0, 0.3, -1.7, 12.0, 1000.0])
    found = rc.small_oscillation(chain, start, push, times)
    with mp.workdps(60):
        stiff, _, mass = (mp.matrix(x) for x in pencil(rc.Rig(chain)))
        values, vectors = mp.eig(mass**-1 * stiff * mp.mpf(G))
        inverse = vectors**-1
        c, s = inverse * mp.matrix(list(map(float, start))), inverse * mp.matrix(list(map(float, push)))
        for i, t in enumerate(times):
            y, v = mp.zeros(size, 1), mp.zeros(size, 1)
            for k in range(size):
                w = mp.sqrt(mp.re(values[k]))
                y += vectors[:, k] * (c[k] * mp.cos(w * t) + s[k] * mp.sin(w * t) / w)
                v += vectors[:, k] * (-c[k] * w * mp.sin(w * t) + s[k] * mp.cos(w * t))
            for m in range(size):
                assert abs(found.offset[i, m] - mp.re(y[m])) <= found.error_bound[i] + found.truncation_error[m]
                assert abs(found.velocity[i, m] - mp.re(v[m])) <= 1e-13
    assert found.error_bound.max() < 1e-15
    assert np.all(found.truncation_error < 1e-15)
    assert found.angular_frequency == pytest.approx(rc.modes(chain).angular_speed, rel=4 * EPS)


def test_plucked_chain_let_go_in_full():
    # the nonlinear motion differs by the third order in the pluck
    chain = rc.Chain.uniform_rods(5, length=1.0)
    shape = np.array([0.0, 0.3, 0.6, 1.0, 0.5, 0.0])
    times = np.linspace(0, 3.0, 7)
    off = []
    for size in (2e-3, 2e-4):
        start = size * shape
        linear = rc.small_oscillation(chain, start, None, times).offset
        lean = np.arcsin((start[:-1] - start[1:]) / chain.length)
        e = np.column_stack([np.sin(lean), 0 * lean, -np.cos(lean)])
        place = np.vstack([e, np.zeros(3)])
        done = scipy.integrate.solve_ivp(
            Motion(rc.Rig(chain), 1.0),
            (0, 3.0),
            np.stack([place, 0 * place]).ravel(),
            "DOP853",
            rtol=1e-12,
            atol=1e-14,
            t_eval=times,
        )
        x = done.y[: 3 * 6].reshape(6, 3, -1)[:5, 0]  # sines of inclinations
        y = np.cumsum((x * 0.2)[::-1], axis=0)[::-1].T
        off.append(np.abs(y - linear[:, :5]).max() / size)
    assert off[1] < 1e-4
    assert off[0] / off[1] == pytest.approx(100, rel=0.2)


def test_swing_with_few_modes_says_what_it_leaves_out():
    chain = rc.Chain.uniform_plummets(40, length=2.0)
    start = 0.05 * np.interp(np.arange(41), [0, 20, 40], [0, 1, 0])
    times = np.linspace(0, 20, 101)
    full = rc.small_oscillation(chain, start, None, times)
    total = full.energy.sum()
    previous = math.inf
    for kept in (1, 3, 10, 30, 40):
        part = rc.small_oscillation(chain, start, None, times, modes=kept)
        gap = np.abs(part.offset - full.offset).max(axis=0)
        assert np.all(gap <= part.truncation_error + 1e-15)
        assert part.energy_left_out >= (total - part.energy.sum()) * (1 - 1e-12) - 1e-15 * total
        assert part.energy_left_out <= previous
        previous = part.energy_left_out
    assert full.offset[0] == pytest.approx(start, abs=1e-16)
    # energy of the start: chords of 1/20, sum S (dy)^2 / (2 a)
    hang = np.arange(1, 41) * (1 / 40)
    energy = 0.5 * (hang * np.diff(start) ** 2 / (2.0 / 40)).sum()
    assert total == pytest.approx(energy, rel=1e-13)
    with pytest.raises(ValueError, match="41"):
        rc.small_oscillation(chain, start, None, times, modes=41)


def test_swing_of_the_continuous_chain():
    # started in the shape of its second mode, a fine chain keeps it
    chain = rc.Chain.uniform_rods(400, length=1.0)
    x = np.linspace(0, 1, 401)
    start = 1e-3 * rc.heavy_chain.shape(x, 2)
    start[-1] = 0.0
    n = math.sqrt(G / rc.heavy_chain.conical_heights(2)[1])
    found = rc.small_oscillation(chain, start, None, [0.0, math.pi / n, 2 * math.pi / n])
    assert found.offset[1] == pytest.approx(-start, abs=2e-7)
    assert found.offset[2] == pytest.approx(start, abs=2e-7)


def test_threads_without_mass_snap_straight():
    chain = rc.Chain(weight=[1.0, 0.0, 0.0], length=[1.0, 0.5, 0.5], centroid=[1.0, 0.5, 0.5], radius_of_gyration=0.0)
    found = rc.small_oscillation(chain, [0.1, 0.5, -0.3, 0.0], None, [0.0, 1.0])
    assert found.projected
    assert found.start == pytest.approx([0.1, 0.05, 0.025, 0.0], rel=1e-14)
    n = math.sqrt(G / 2)
    assert found.offset[1] == pytest.approx(np.array([0.1, 0.05, 0.025, 0.0]) * math.cos(n), abs=1e-16)


# ---- bad input --------------------------------------------------------------------------------------------------

CHAIN = rc.Chain(weight=[1.0, 2.0, 3.0], length=[0.5, 0.4, 0.3])


WORDS = {
    "carriage_weight": "carriage weight", "support_radius": "radius of the support", "axial_moment": "axial moment",
    "displaced_weight": "weight displaced", "displaced_centroid": "centre of buoyancy", "displaced_radius_of_gyration": "radius of gyration",
    "added_weight": "added weight",
}  # fmt: skip


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("stiffness", 0.0, "0"), ("stiffness", -3.5, "-3.5"), ("stiffness", math.nan, "nan"), ("stiffness", -math.inf, "inf"),
        ("carriage_weight", -1.25, "-1.25"), ("carriage_weight", math.inf, "inf"), ("carriage_weight", math.nan, "nan"),
        ("support_radius", -0.5, "-0.5"), ("support_radius", math.nan, "nan"), ("support_radius", math.inf, "inf"),
        ("momentum", math.nan, "nan"), ("momentum", [0, math.inf, 0], "inf"), ("momentum", [1.0, 2.0], "2"),
        ("axial_moment", [0, -2.5, 0], "-2.5"), ("axial_moment", math.inf, "inf"),
        ("displaced_weight", [0, 0, -7.5], "-7.5"), ("displaced_weight", [1.0] * 4, "4"), ("displaced_weight", math.nan, "nan"),
        ("added_weight", -0.75, "-0.75"), ("added_weight", [[1.0, 2.0, 3.0]], ""), ("standing", [True, False], "3 links"),
        ("fluid", "stirred", "stirred"), ("fluid", "", "fluid"),
    ],
)  # fmt: skip
def test_what_cannot_be_rigged_is_refused_with_place_and_value(name, value, said):
    with pytest.raises(ValueError) as caught:
        rc.Rig(CHAIN, **{name: value})
    text = str(caught.value)
    assert name in text or WORDS[name] in text, text
    assert said in text, text


@pytest.mark.parametrize("bad", [{"displaced_centroid": math.nan}, {"displaced_radius_of_gyration": -0.25}])
def test_places_of_fluid_are_checked_though_none_is_displaced(bad):
    with pytest.raises(ValueError, match=r"buoyancy|centroid|gyration"):
        rc.Rig(CHAIN, **bad)


@pytest.mark.parametrize(
    "call",
    [
        lambda: rc.held_shapes(CHAIN, span=0.5, conical_height=0.1, gravity=0.0),
        lambda: rc.held_cord_shapes(1.0, span=0.5, conical_height=0.1, gravity=0.0),
        lambda: rc.held_shapes(CHAIN, span=0.5, conical_height=0.1, gravity=-9.81),
        lambda: rc.Rig(CHAIN, displaced_weight=0.5, added_weight=0.5, fluid="turning"),
    ],
)
def test_what_contradicts_itself_is_refused(call):
    with pytest.raises(ValueError):
        call()


@pytest.mark.parametrize(
    "call",
    [
        lambda: rc.Rig(None),
        lambda: rc.Rig("chain"),
        lambda: rc.Rig(rc.Rig(CHAIN)),
        lambda: rc.Rig(CHAIN, stiffness="soft"),
        lambda: rc.Rig(CHAIN, momentum="much"),
        lambda: rc.Rig(CHAIN, momentum=1j),
        lambda: rc.Rig(CHAIN, standing="yes"),
        lambda: rc.Rig(CHAIN, fluid=3),
        lambda: rc.response(None, conical_height=1.0),
        lambda: rc.response(CHAIN),
        lambda: rc.response(CHAIN, conical_height=1.0, angular_speed=1.0),
        lambda: rc.response(CHAIN, conical_height=[1.0, -1.0]),
        lambda: rc.response(CHAIN, conical_height=0.0),
        lambda: rc.response(CHAIN, angular_speed=-2.0),
        lambda: rc.response(CHAIN, angular_speed=math.nan),
        lambda: rc.response(CHAIN, angular_speed=1e200),
        lambda: rc.response(CHAIN, conical_height=1.0, support_radius=0.0),
        lambda: rc.response(CHAIN, conical_height=1.0, pins=[4]),
        lambda: rc.response(CHAIN, conical_height=1.0, pins=[0.5]),
        lambda: rc.response(CHAIN, conical_height=1.0, gravity=-1.0),
        lambda: rc.steady_shapes(rc.Rig(CHAIN), conical_height=-1.0),
        lambda: rc.steady_shapes(rc.Rig(CHAIN, momentum=1.0), angular_speed=3.0, sense=0),
        lambda: rc.steady_shapes(rc.Rig(CHAIN, momentum=1.0), angular_speed=-3.0),
        lambda: rc.modes(rc.Rig(CHAIN), count=-1),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0), certify=True),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0), precision="double-double"),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0), method="dense"),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0), conical_height=(0.1, 0.2)),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0), rtol=1e-3),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0), gravity=0.0),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0), count="every"),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0), first=0),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0)).at(gravity=1.62),
        lambda: rc.modes(rc.Rig(CHAIN, momentum=1.0)).uncertainty(weight=0.1),
        lambda: rc.held_shapes(CHAIN, span=1.2000001, conical_height=0.1),
        lambda: rc.held_shapes(CHAIN, span=2.0, conical_height=0.1),
        lambda: rc.held_shapes(CHAIN, span=0.0, conical_height=0.1),
        lambda: rc.held_shapes(CHAIN, conical_height=0.1),
        lambda: rc.held_shapes(CHAIN, span=0.5),
        lambda: rc.held_shapes(CHAIN, span=0.5, top_tension=3.0, conical_height=0.1),
        lambda: rc.held_shapes(CHAIN, span=0.5, conical_height=0.1, most_half_waves=0),
        lambda: rc.held_cord_shapes(-1.0, span=0.5, conical_height=0.1),
        lambda: rc.held_cord_shapes(1.0, span=0.5, conical_height=0.1, weight=0.0),
        lambda: rc.held_cord_shapes(1.0, span=0.5, conical_height=0.1)[0].at_arc(1.5),
        lambda: rc.taut_modes(CHAIN, tension=0.0),
        lambda: rc.taut_modes(CHAIN, tension=1.0, count=0),
        lambda: rc.GyrostaticString(weight=0.0, length=1.0, tension=1.0, momentum=1.0),
        lambda: rc.GyrostaticString(weight=1.0, length=1.0, tension=-1.0, momentum=1.0),
        lambda: rc.GyrostaticString(weight=1.0, length=1.0, tension=1.0, momentum=math.inf),
        lambda: rc.GyrostaticString(weight=1.0, length=1.0, tension=1.0, momentum=1.0).plane_rotation(-1.0),
        lambda: rc.GyrostaticString(weight=1.0, length=1.0, tension=1.0, momentum=1.0).angular_speeds(4.0),
        lambda: rc.free_flywheel(weight=-1.0, radius_of_gyration=1.0, spin=1.0),
        lambda: rc.driven_flywheel(weight=1.0, radius_of_gyration=math.nan, spin=1.0),
        lambda: rc.small_oscillation(CHAIN, [0.1, 0.1], None, [0.0]),
        lambda: rc.small_oscillation(CHAIN, [0.1, 0.1, 0.1, 0.1], None, [0.0]),
        lambda: rc.small_oscillation(CHAIN, [0.1, 0.1, math.nan], None, [0.0]),
        lambda: rc.small_oscillation(CHAIN, [0.1, 0.1, 0.1], [1.0], [0.0]),
        lambda: rc.small_oscillation(CHAIN, [0.1, 0.1, 0.1], None, [[0.0]]),
        lambda: rc.small_oscillation(CHAIN, [0.1, 0.1, 0.1], None, [math.inf]),
        lambda: rc.small_oscillation(CHAIN, [0.1, 0.1, 0.1], None, 0.0, modes=-1),
        lambda: rc.small_oscillation(CHAIN, [0.1, 0.1, 0.1], None, 0.0, modes=4),
        lambda: rc.small_oscillation(rc.Rig(CHAIN), [0.1, 0.1, 0.1], None, 0.0),
        lambda: rc.momentum_for_speed(rc.Rig(CHAIN), 0.0, link=1),
        lambda: rc.momentum_for_speed(rc.Rig(CHAIN), 1.0, link=4),
        lambda: rc.momentum_for_speed(CHAIN, 1.0, link=1),
        lambda: rc.bell_and_clapper(CHAIN),
        lambda: rc.bell_and_clapper(rc.Rig(CHAIN)),
        lambda: rc.bell_and_clapper(rc.Chain(weight=[1.0, 2.0], length=1.0)).with_ratio(0.0),
        lambda: CHAIN.with_weight(-1.0),
        lambda: CHAIN.with_weight(1.0, pin=3),
        lambda: CHAIN.with_weight(1.0, radius_of_gyration=-1.0),
        lambda: CHAIN.with_thread(0.0, pin=1),
        lambda: CHAIN.with_thread(1.0, pin=0),
        lambda: CHAIN.with_thread(1.0, pin=4),
        lambda: CHAIN.clamped(0),
        lambda: CHAIN.clamped(1.5),
        lambda: rc.tip_mass.conical_heights(0, tip=1.0),
        lambda: rc.tip_mass.conical_heights(1, tip=-1.0),
        lambda: rc.modes(CHAIN).uncertainty(weight=-1.0),
        lambda: rc.modes(CHAIN).uncertainty(weight=[1.0, 2.0]),
        lambda: rc.modes(CHAIN).uncertainty(weight=np.array([[1.0, 2.0, 0], [0, 1, 0], [0, 0, 1]])),
    ],
)
def test_nonsense_is_refused_in_a_sentence(call, capfd):
    with pytest.raises((ValueError, TypeError)) as caught:
        call()
    text = str(caught.value)
    assert len(text) > 12
    assert "pybind" not in text
    assert "incompatible function arguments" not in text
    out, err = capfd.readouterr()
    assert not out
    assert not err


def test_extreme_rigs_neither_crash_nor_hang():
    for w, e, p in itertools.product([1e-12, 1e12], [1e-12, 1e12, math.inf], [0.0, 1e-12, 1e12]):
        rig = rc.Rig(rc.Chain(weight=[w, 1.0], length=[1.0, 1e-6]), stiffness=e, momentum=[p, -p])
        found = rc.modes(rig)
        assert np.all(np.isfinite(found.angular_speed))
        if found.status == "success":
            want = real_speeds(rig, digits=150)
            for n, bound in zip(found.angular_speed, found.error_bound, strict=True):
                assert min(abs(x - n) / abs(x) for x in want) <= max(bound, 4 * EPS)
        if p == 0:
            rc.steady_shapes(rig, conical_height=0.37, budget=20000)
    single = rc.modes(rc.Rig(rc.Chain(weight=1e-300, length=1e-150), stiffness=1e-200))
    assert single.conical_height == pytest.approx([1e-100], rel=1e-12)


def test_long_rigs():
    rng = np.random.default_rng(900)
    chain = rc.Chain.uniform_rods(10000, length=0.36)
    afloat = rc.modes(rc.Rig(chain, displaced_weight=chain.weight * rng.uniform(0, 0.9, 10000)), count=2)
    assert afloat.complete
    assert np.all(afloat.error_bound < 1e-14)
    # a uniform fluid of density r to the links' one: K times 1 - r
    thinned = rc.modes(rc.Rig(chain, displaced_weight=chain.weight * 0.25), count=3)
    assert thinned.conical_height[:3] == pytest.approx(rc.modes(chain, count=3).conical_height / 0.75, rel=1e-13)
    slow = rc.modes(rc.Rig(chain, stiffness=10.0, carriage_weight=0.3), count=3)
    assert slow.available == (10001, 0)
    many = rc.steady_shapes(rc.Rig(rc.Chain.uniform_rods(60, length=1.0), support_radius=0.05), conical_height=0.3)
    assert len(many) == 3
    for shape in many:
        assert shape.residual <= 1e-14
        assert figure_moments(rc.Rig(rc.Chain.uniform_rods(60, length=1.0), support_radius=0.05), shape) <= 1e-14
    # a bound the search cannot meet is said, and it ends
    cut = rc.steady_shapes(
        rc.Rig(rc.Chain.uniform_plummets(9, length=9.0), support_radius=0.1), conical_height=0.01, budget=5000
    )
    assert not cut.complete


def test_shapes_at_exactly_a_critical_speed_are_not_called_complete_wrongly():
    rig = rc.Rig(rc.Chain(weight=1.0, length=0.75), stiffness=4.0)
    at = rc.steady_shapes(rig, conical_height=1.0)
    assert len(at) == 0
    assert rc.steady_shapes(rig, conical_height=1.0 + 1e-12).complete
    below = rc.steady_shapes(rig, conical_height=1.0 - 1e-9)
    assert len(below) == 1
    assert below[0].inclination[0] == pytest.approx(math.acos((0.75 - 1e-9) / 0.75), rel=1e-6)


# ---- kept, drawn, copied, run ----------------------------------------------------------------------------------


def full_rig():
    return rc.Rig(
        CHAIN,
        stiffness=30.0,
        carriage_weight=0.2,
        momentum=[0.3, 0.0, -0.1],
        displaced_weight=[0.5, 0, 0],
        added_weight=0.1,
    )


def test_rigs_are_equal_hashable_and_can_be_pickled():
    one, two = full_rig(), full_rig()
    assert one == two
    assert hash(one) == hash(two)
    assert one != rc.Rig(CHAIN)
    assert pickle.loads(pickle.dumps(one)) == one
    assert "stiffness 30" in repr(one)
    with pytest.raises((AttributeError, ValueError)):
        one.stiffness = 3.0
    with pytest.raises(ValueError):
        one.momentum[0] = 1.0
    string = rc.GyrostaticString(weight=1.0, length=1.0, tension=3.0, momentum=1.0)
    assert pickle.loads(pickle.dumps(string)) == string
    swing = rc.small_oscillation(CHAIN, [0.1, 0, 0], None, [0.0, 1.0])
    assert pickle.loads(pickle.dumps(swing)) == swing
    answer = rc.response(full_rig(), angular_speed=[2.0, 3.0])
    assert pickle.loads(pickle.dumps(answer)) == answer
    found = pickle.loads(pickle.dumps(rc.modes(one)))
    assert np.array_equal(found.shape, rc.modes(one).shape)


@pytest.mark.parametrize("ending", [".npz", ".nc"])
@pytest.mark.parametrize(
    "rig",
    [
        rc.Rig(rc.Chain(weight=[0.5, 1, 1], length=1.0), displaced_weight=[1, 0, 0], fluid="turning", stiffness=3.0),
        rc.Rig(rc.Chain(weight=1.0, length=[1.0]), displaced_weight=1.0, momentum=3.0),  # an infinite height
        rc.Rig(rc.Chain(weight=1.0, length=1.0), displaced_weight=3.0),  # no mode at all
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
    names = ("conical_height", "error_bound", "number", "direction", "shape", "residual", "slack_link", "slack_speed")
    for name in names:
        assert np.array_equal(getattr(again, name), getattr(found, name))
    assert np.array_equal(again.other.conical_height, found.other.conical_height)
    assert np.array_equal(again.angular_speed, found.angular_speed)
    assert json.loads(json.dumps(found.to_dict())) == found.to_dict()


def test_everything_can_be_drawn():
    import matplotlib.pyplot as plt

    rig = full_rig()
    drawn = [
        rc.modes(rig).plot(),
        rc.response(rig, angular_speed=np.linspace(0.5, 20, 200)).plot(),
        rc.response(CHAIN, angular_speed=np.linspace(0.5, 20, 200)).plot(),
        rc.small_oscillation(CHAIN, [0.1, 0.05, 0.0], None, np.linspace(0, 2, 40)).plot(),
        rc.small_oscillation(CHAIN, [0.1, 0.05, 0.0], None, np.linspace(0, 2, 40)).plot(kind="time", pins=[0, 2]),
        rc.steady_shapes(rc.Rig(CHAIN, support_radius=0.2), conical_height=0.3).plot(),
        rc.steady_shapes(rc.Rig(CHAIN, support_radius=0.2), conical_height=0.3)[0].plot(),
        rc.held_shapes(rc.Chain.uniform_rods(20), span=0.5, conical_height=0.02, most_half_waves=2).plot(),
        rc.held_cord_shapes(1.0, span=0.5, conical_height=0.1)[0].plot(),
        rc.GyrostaticString(weight=1.0, length=1.0, tension=100.0, momentum=0.2).plot(),
        rc.GyrostaticString(weight=G, length=1.0, tension=100.0, momentum=1.0).plot_vibration(8.0),
    ]
    for ax in drawn:
        assert ax.get_xlabel()
        assert ax.get_ylabel()
        ax.figure.canvas.draw()
    plt.close("all")


SCENE = """
title = "Everything"
gravity = 9.81
[[links]]
mass = 1.5
length = 0.4
centroid = 0.2
radius_of_gyration = 0.1
flywheel = {mass = 0.5, radius_of_gyration = 0.2, spin = "300 rpm"}
displaced = {mass = 0.4, added_mass = 0.1}
[[links]]
kind = "rod"
mass = 0.2
length = 0.3
repeat = 2
[support]
stiffness = "200 N/m"
mass = 0.3
[ask]
modes = 3
"""


def run(*arguments, check=True):
    done = subprocess.run(
        [sys.executable, "-m", "revchain", *map(str, arguments)],
        capture_output=True,
        text=True,
        check=False,
        timeout=120,
    )
    if check:
        assert done.returncode == 0, done.stderr
    return done


def test_scene_file_end_to_end(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(SCENE)
    scene = rc.load_scene(path)
    assert scene.is_rigged
    g = 9.81
    chain = rc.Chain(
        weight=np.array([1.5, 0.2, 0.2]) * g,
        length=[0.4, 0.3, 0.3],
        centroid=[0.2, 0.15, 0.15],
        radius_of_gyration=[0.1, 0.3 / 12**0.5, 0.3 / 12**0.5],
    )
    rig = rc.Rig(
        chain,
        stiffness=200.0,
        carriage_weight=0.3 * g,
        displaced_weight=[0.4 * g, 0, 0],
        added_weight=[0.1 * g, 0, 0],
        momentum=[0.5 * 0.04 * 300 * 2 * math.pi / 60, 0, 0],
    )
    want = rc.modes(rig, count=3, gravity=g).angular_speed
    assert scene.modes().angular_speed == pytest.approx(want, rel=1e-13)
    out = tmp_path / "out"
    done = run("solve", path, "--out", out)
    assert "nan" not in done.stdout
    answer = json.loads(next(out.glob("*.json")).read_text())
    assert [m["angular_speed"] for m in answer["modes"]] == pytest.approx(list(want), rel=1e-13)
    assert rc.load(next(out.glob("*.npz"))).angular_speed == pytest.approx(want, rel=1e-13)
    assert next(out.glob("*.png")).stat().st_size > 5000
    assert next(out.glob("*.csv")).read_text().count("\n") >= 6


@pytest.mark.parametrize(
    ("old", "new", "place"),
    [
        ('spin = "300 rpm"', 'spin = "300 kg"', "flywheel"),
        ("radius_of_gyration = 0.2, spin", "radius_of_gyration = -0.2, spin", "flywheel"),
        ('stiffness = "200 N/m"', "stiffness = -1", "stiffness"),
        ("mass = 0.3\n[ask]", "mass = -0.3\n[ask]", "support"),
        ("displaced = {mass = 0.4", "displaced = {mass = -0.4", "displaced"),
        ("displaced = {mass = 0.4", "displaced = {colour = 1, mass = 0.4", "colour"),
        ("gravity = 9.81", 'gravity = 9.81\nfluid = "stirred"', "fluid"),
        ("kind = \"rod\"", "kind = \"rod\"\nstanding = 3", "standing"),
    ],
)  # fmt: skip
def test_scenes_that_cannot_be_name_the_key(tmp_path, old, new, place):
    assert old in SCENE
    path = tmp_path / "bad.toml"
    path.write_text(SCENE.replace(old, new, 1))
    with pytest.raises(rc.SceneError) as caught:
        rc.load_scene(path).modes()
    assert "bad.toml" in str(caught.value)
    assert place in str(caught.value)
    if place == "flywheel":
        done = run("solve", path, check=False)
        assert done.returncode == 3
        assert place in done.stdout + done.stderr
        assert "Traceback" not in done.stderr


def test_scene_without_modes_still_answers(tmp_path):
    path = tmp_path / "float.toml"
    path.write_text("[[links]]\nmass = 1\nlength = 1\ndisplaced = {mass = 3}\n")
    done = run("solve", path)
    assert "Traceback" not in done.stderr
    assert len(rc.load_scene(path).modes()) == 0


def test_new_scene_names_every_feature(tmp_path):
    path = tmp_path / "scene.toml"
    run("new", path)
    text = path.read_text()
    for word in ("stiffness", "radius", "flywheel", "driven", "displaced", "fluid", "standing", "added_mass"):
        assert word in text
    run("validate", path)
    # what is said in comments of a rig can be said
    said = {line[2:].split(" = ")[0]: line[2:] for line in text.splitlines() if line.startswith("# ") and " = " in line}
    full = text.replace(
        "centroid = 0.1 ", "\n".join(said[k] for k in ("standing", "displaced", "flywheel")) + "\ncentroid = 0.1 "
    )
    support = "\n".join(["[support]", said["stiffness"], said["radius"]])
    path.write_text(full.replace("\n[ask]", "\n" + support + "\n[ask]").replace("# fluid", "fluid"))
    run("validate", path)
    rig = rc.load_scene(path).rig()
    assert rig.standing.any()
    assert rig.momentum.any()
    assert rig.displaced_weight.any()
    assert rig.stiffness == 200.0
    assert rig.fluid == "turning"


def test_scenes_of_the_examples_folder_hold_rigs(repository):
    rigged = [p for p in Path(repository, "examples", "scenes").glob("*.toml") if rc.load_scene(p).is_rigged]
    assert rigged
