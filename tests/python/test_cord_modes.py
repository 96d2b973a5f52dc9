# SPDX-License-Identifier: GPL-3.0-or-later
"""Modes of cords, uniform, with a tip mass, of varying density: against mpmath and laws."""

import math
import random

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.special import j0, j1, y0, y1

import revchain as rc

ULP = 2.0**-52
NAN, INF = math.nan, math.inf


def ulps(found, exact):
    return float(abs(mp.mpf(float(found)) / exact - 1) / ULP)


def tipped(tip, length=1.0):
    """A uniform cord whose tip weighs as much as that length of it."""
    return rc.Cord(length, weight=length, tip_weight=tip)


def one(cord, mode):
    return rc.modes(cord, 1, first=mode)


@pytest.mark.parametrize("exponent", [0.0, 0.3, 2.0, 11.5])
def test_heights_are_those_of_the_zeros_of_bessel_functions(exponent):
    """Zeros counted by mpmath, so that each mode is the right one."""
    heights = rc.modes(rc.Cord(0.7, density=exponent), 8).conical_height
    with mp.workdps(40):
        exact = [4 * (mp.mpf(exponent) + 1) * mp.mpf(0.7) / mp.besseljzero(exponent, k) ** 2 for k in range(1, 9)]
        assert max(map(ulps, heights, exact)) <= 3


def at_support(pieces, tip, speed, gravity=9.80665):
    """Offset of the support, 1 at the free end, of a cord in pieces of even density (length, mass per length)."""
    offset, pull, tension = np.ones_like(speed), -tip * speed**2, tip * gravity  # pull: tension times slope
    for length, density in pieces:
        low, high = (2 * speed * np.sqrt(t / density) / gravity for t in (tension, tension + density * gravity * length))
        wronskian, bend = -2 / (np.pi * low), -2 * pull / (density * gravity * low)
        a = (offset * y1(low) - bend * y0(low)) / wronskian
        b = (bend * j0(low) - offset * j1(low)) / wronskian
        offset, pull = a * j0(high) + b * y0(high), -density * gravity * high / 2 * (a * j1(high) + b * y1(high))
        tension += density * gravity * length
    return offset


@pytest.mark.parametrize("wide", [0.02, 0.005])
@pytest.mark.parametrize("total", [None, 2.5])
def test_clasps_are_found_wherever_they_are(wide, total):
    """A clasp of 6 g on a cord of 1.8 m with a tip of 50 g."""
    rng = np.random.default_rng(5)
    for middle in [1.2173, *rng.uniform(wide, 1.8 - wide, 9 if total else 30)]:
        low, high, heavy = middle - wide / 2, middle + wide / 2, 0.01003 + 0.006 / wide
        scale = 1 if total is None else total / (0.01003 * 1.8 + 0.006)
        density = lambda s, low=low, high=high, heavy=heavy: heavy if low <= s < high else 0.01003  # noqa: E731
        modes = rc.modes(rc.Cord(1.8, mass=total, density=density, tip_mass=0.05 * scale), 2)
        pieces = [(low, 0.01003), (high - low, heavy), (1.8 - high, 0.01003)]
        for number, speed in enumerate(modes.angular_speed, 1):
            turns = np.sign(at_support(pieces, 0.05, np.append(np.linspace(0.01, speed * (1 - 1e-11), 400), speed * (1 + 1e-11))))
            assert (turns[1:] != turns[:-1]).sum() == number and turns[-1] != turns[-2], (middle, number)
        assert modes.error_bound.max() < 1e-13


def test_a_density_that_cannot_be_resolved_is_refused():
    with pytest.raises(ValueError, match=r"integral that cannot be resolved \(use a chain of many short links.*; near s, got 0.7"):
        rc.Cord(1.8, density=lambda s: (abs(s - math.sqrt(0.5)) + 1e-25) ** -0.9)
    dice = random.Random(1)
    with pytest.raises(ValueError, match=r"rough at too many places \(use a chain of many short links .*; near s, got "):
        rc.Cord(1.8, density=lambda s: 1 + dice.random())


def test_numbers_of_the_paper():
    """Section 4 (12) and (14), corrected: x / lambda at the nodes and at the vertical points."""
    modes = rc.modes(rc.Cord(1.0), 4)
    height = modes.conical_height[3]
    np.testing.assert_allclose(modes.nodes[3] / height, [1.445796, 7.617816, 18.721752], atol=5e-7)
    np.testing.assert_allclose(modes.vertical_points[3] / height, [3.670493, 12.304614, 25.874864], atol=5e-7)


@settings(max_examples=40, deadline=None)
@given(st.floats(-8, 8), st.integers(1, 25), st.floats(-3, 3))
def test_tip_mass_laws(log_tip, mode, log_length):
    length = 10.0**log_length
    tip = 10.0**log_tip * length
    modes = rc.modes(tipped(tip, length), mode + 1)
    heights, nodes = modes.conical_height, modes.nodes[mode - 1]
    assert (np.diff(heights) < 0).all()
    # Weight at the end stretches the cord: slower than a cord of tip + length, faster than the string it becomes.
    assert (heights <= rc.modes(rc.Cord(tip + length), mode + 1).conical_height * (1 + 1e-14)).all()
    between = np.concatenate([[0], nodes]) / 2 + np.concatenate([nodes, [length]]) / 2
    np.testing.assert_array_equal(np.sign(modes.along(between)[mode - 1]), (-1.0) ** np.arange(mode))
    np.testing.assert_allclose(modes.slope(0.0) * heights, -1, rtol=1e-14)


@settings(max_examples=40, deadline=None)
@given(st.floats(-0.99, 60), st.integers(1, 25))
def test_tapered_cord_laws(exponent, mode):
    modes = rc.modes(rc.Cord(1.0, density=exponent), mode + 1)
    following = rc.modes(rc.Cord(1.0, density=exponent + 1), mode + 1).conical_height
    # Zeros of neighbouring orders interlace.
    zeros, following = np.sqrt((exponent + 1) / modes.conical_height), np.sqrt((exponent + 2) / following)
    assert (zeros < following).all() and (following[:-1] < zeros[1:]).all()
    nodes = modes.nodes[mode - 1]
    assert (np.diff(np.concatenate([[0], nodes, [1]])) > 0).all()
    assert nodes.shape == (mode - 1,)


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 1000), st.floats(1e-3, 1e3))
def test_limits_agree(mode, length):
    """A tip of next to no weight, and next to no taper."""
    uniform = rc.modes(rc.Cord(length), mode).conical_height
    np.testing.assert_allclose(rc.modes(tipped(1e-200, length), mode).conical_height, uniform, rtol=4 * ULP)
    heights = rc.modes(rc.Cord(length, density=1e-30), mode).conical_height
    np.testing.assert_allclose(heights, uniform, rtol=4 * ULP)


@pytest.mark.parametrize(
    "given_",
    [{}, {"tip_weight": 1e-6}, {"tip_weight": 0.3}, {"tip_weight": 1e3}, {"density": -0.5}, {"density": 1.5},
     {"density": 1.0, "tip_weight": 0.3}, {"density": lambda s: 1 + (s > 0.2) + s}],
    ids=["uniform", "light tip", "tip", "heavy tip", "thin", "thick", "power with tip", "function"],
)  # fmt: skip
def test_vertical_points_part_the_nodes(given_):
    """One above each node; there the slope is 0, and the slope is that of the offset."""
    length = 0.7
    cord = rc.Cord(length, **given_)
    modes = rc.modes(cord, 6)
    for k, (nodes, vertical) in enumerate(zip(modes.nodes, modes.vertical_points, strict=True)):
        assert vertical.shape == nodes.shape == (k,)
        assert (nodes < vertical).all() and (vertical < np.append(nodes, length)[1:]).all()
        if k:
            steepest = np.abs(modes.slope(np.linspace(0, length, 400))[k]).max()
            np.testing.assert_allclose(modes.slope(vertical)[k] / steepest, 0, atol=1e-14)
    x, step = np.linspace(0.05, 0.65, 7), 1e-4
    wave = math.pi / np.diff(np.append(modes.nodes[5], length)).min()  # rad per length, at the most
    difference = (modes.along(x + step) - modes.along(x - step)) / (2 * step)
    size = wave * np.abs(modes.along(np.linspace(0, length, 99))).max()
    np.testing.assert_allclose(modes.slope(x), difference, atol=size * (wave * step) ** 2)


def test_slope_and_kinetic_energy():
    """Of the weight per length 1: half the integral of offset^2 / height and of tension times slope^2."""
    x = np.linspace(0, 0.7, 15)
    for mode in (1, 2, 9):
        modes = one(rc.Cord(0.7), mode)
        (height,), slope = modes.conical_height, modes.slope(x)[0]
        assert slope[0] == -1 / height
        near = one(rc.Cord(0.7, density=1e-30), mode).slope(x)[0]
        np.testing.assert_allclose(slope, near, atol=4e-15 * mode / height)
        node, weight = np.polynomial.legendre.leggauss(60)
        z = (node + 1) / 2 * 2 * math.sqrt(0.7 / height)
        at = np.minimum(height * z**2 / 4, 0.7)
        dx = weight * math.sqrt(0.7 / height) * height * z / 2
        energy = 0.7 * 0.7 * (0.1 * modes.slope(0.7)[0]) ** 2 / 2
        offset, steep = 0.1 * modes.along(at)[0], 0.1 * modes.slope(at)[0]
        assert (offset**2 * dx).sum() / (2 * height) == pytest.approx(energy, rel=1e-13)
        assert (at * steep**2 * dx).sum() / 2 == pytest.approx(energy, rel=1e-13)


def test_kinetic_energy_of_a_cord_that_tapers():
    """Weight 3 and density s^2: the weight below s is 3 s^3 / length^3, which is the tension."""
    length, weight = 0.7, 3.0
    modes = rc.modes(rc.Cord(length, weight=weight, density=2.0), 4)
    node, part = np.polynomial.legendre.leggauss(60)
    s, ds = length * (node + 1) / 2, part * length / 2
    energy = weight * length * modes.slope(length) ** 2 / 2
    kinetic = (modes.along(s) ** 2 * 3 * weight * s**2 / length**3 * ds).sum(axis=1) / (2 * modes.conical_height)
    potential = (modes.slope(s) ** 2 * weight * (s / length) ** 3 * ds).sum(axis=1) / 2
    np.testing.assert_allclose(kinetic, energy, rtol=1e-13)
    np.testing.assert_allclose(potential, energy, rtol=1e-13)


def test_places_of_one_number_and_of_many():
    for cord in (rc.Cord(1.0), tipped(2.0), rc.Cord(1.0, density=2.0), rc.Cord(1.0, density=lambda s: 1 + s)):
        modes, x = rc.modes(cord, 7), np.linspace(0, 1, 5)
        for values in (modes.along, modes.slope):
            assert values(x).shape == (7, 5) and values(0.75).shape == (7,)
            assert values(x)[6, 3] == values(0.75)[6] == getattr(one(cord, 7), values.__name__)(0.75)[0]
        none = rc.modes(cord, conical_height=(2.0, 3.0))
        assert none.along(x).shape == none.slope(x).shape == (0, 5) and none.nodes == none.vertical_points == ()
    assert one(rc.Cord(1.0), 1).nodes[0].shape == one(rc.Cord(1.0), 1).vertical_points[0].shape == (0,)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: rc.modes(rc.Cord(1.0), 0), "revchain.modes: count must be at least 1, got 0"),
        (lambda: rc.modes(rc.Cord(1.0), 1.0), "revchain.modes: count must be a whole number, got 1.0"),
        (lambda: rc.modes(rc.Cord(1.0), 1, first=0), "revchain.modes: first must be at least 1, got 0"),
        (lambda: rc.modes(rc.Cord(1.0), 1, first=1.5), "revchain.modes: first must be a whole number, got 1.5"),
        (lambda: rc.modes(rc.Cord(1.0), 1, first=True), "revchain.modes: first must be a whole number, got True"),
        (lambda: rc.modes(rc.Cord(1.0), 1, first=2**63), "revchain.modes: first is too large"),
        (lambda: rc.modes(rc.Cord(1.0), 1, first=2**60).nodes, "too large, got 1152921504606846976: it would take"),
        (lambda: rc.modes(rc.Cord(1.0), 1, first=2**60).vertical_points, "too large, got 1152921504606846976"),
        (lambda: rc.modes(rc.Cord(1.0), 2, gravity=0.0), "revchain.modes: gravity must be positive and finite, got 0"),
        (lambda: rc.Cord(1.0, tip_weight=-1), "revchain.Cord: tip_weight must be finite and not negative, got -1"),
        (lambda: rc.Cord(1.0, tip_weight=NAN), "revchain.Cord: tip_weight must be finite and not negative, got nan"),
        (lambda: rc.Cord(1.0, tip_weight=INF), "revchain.Cord: tip_weight must be finite and not negative, got inf"),
        (lambda: rc.modes(tipped(1e260)), "tip must lie between 0 and 1e250 lengths"),
        (lambda: rc.Cord(0.0), "revchain.Cord: length must be positive and finite, got 0"),
        (lambda: rc.Cord(NAN), "revchain.Cord: length must be positive and finite, got nan"),
        (lambda: rc.Cord(INF), "revchain.Cord: length must be positive and finite, got inf"),
        (lambda: rc.Cord(-1.0), "revchain.Cord: length must be positive and finite, got -1"),
        (lambda: rc.Cord([1.0, 2.0]), "revchain.Cord: length must be a single number"),
        (lambda: rc.Cord(1.0, tip_weight=[1.0]), "revchain.Cord: tip_weight must be a single number"),
        (lambda: rc.Cord(1.0, density=-1.0), "exponent of the density must be above -1 and at most 1e4, got -1"),
        (lambda: rc.Cord(1.0, density=INF), "exponent of the density must be above -1 and at most 1e4, got inf"),
        (lambda: rc.Cord(1.0, density=NAN), "exponent of the density must be above -1 and at most 1e4, got nan"),
        *(
            (lambda x=x, name=name: getattr(rc.modes(rc.Cord(1.0), 1), name)(x), f"revchain.Modes.{name}: {words}")
            for name in ("along", "slope")
            for x, words in [
                (1.5, "arc_length must lie between 0 and the length, got 1.5"),
                (-0.1, "arc_length must lie between 0 and the length, got -0.1"),
                ([0.5, NAN], "arc_length must lie between 0 and the length, got nan"),
                ([[0.5]], "arc_length must be a number or have one axis, got shape (1, 1)"),
                ("x", "arc_length must be a number"),
            ]
        ),
    ],
)
def test_bad_input_is_named(call, message):
    with pytest.raises(ValueError) as caught:
        call()
    assert message in str(caught.value)
