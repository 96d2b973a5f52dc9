# SPDX-License-Identifier: GPL-3.0-or-later
"""Modes of cords, uniform, with a tip mass, of varying density; their laws are tested in tests/cpp/special."""

import math
import random

import mpmath as mp
import numpy as np
import pytest
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
def test_the_derivative_by_the_exponent(exponent):
    """The derivative of ``4 (p + 1) L / j**2`` by p in 40 digits. At p = 0 the integrand has a logarithm at the free end."""
    m = rc.modes(rc.Cord(0.7, density=exponent), 8)
    with mp.workdps(40):
        step = mp.mpf(10) ** -13
        for k, (height, found) in enumerate(zip(m.conical_height, m.sensitivity.exponent, strict=True), start=1):
            either = []
            for p in (exponent - step, exponent + step):
                zero = mp.findroot(lambda z, p=p: mp.besselj(p, z), mp.besseljzero(exponent, k))
                either.append(4 * (p + 1) * mp.mpf(0.7) / zero**2)
            assert abs(found - (either[1] - either[0]) / (2 * step)) < 2e-14 * height


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
        (lambda: rc.modes(tipped(1e260)), "tip must lie between 0 and 1e250 lengths"),
        (lambda: rc.Cord([1.0, 2.0]), "revchain.Cord: length must be a single number"),
        (lambda: rc.Cord(1.0, tip_weight=[1.0]), "revchain.Cord: tip_weight must be a single number"),
        *(
            (lambda given=given, x=x: rc.Cord(**{"length": 1.0, given: x}), f"revchain.Cord: {words}, got {x:g}")
            for given, words in (
                ("length", "length must be positive and finite"),
                ("tip_weight", "tip_weight must be finite and not negative"),
                ("density", "the exponent of the density must be above -1 and at most 1e4"),
            )
            for x in (-1.0, NAN, INF, *[0.0] * (given == "length"))
        ),
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


@pytest.mark.parametrize(
    ("tip", "centroid", "gyration"), [(5.0, 0.5, 0.5), (5.0, 0.25, 0.25), (1.0, 1.0, 0.0), (1.0, 2.0, 2.0)]
)
def test_a_bob_whose_own_height_is_a_power_of_two_of_the_length(tip, centroid, gyration):
    """There the bob hangs in line with the axis at a height that the search tries."""
    def heights(off):
        body = {"tip_centroid": centroid * (1 + off), "tip_radius_of_gyration": gyration}
        return rc.modes(rc.Cord(1.0, tip_mass=tip, **body), 3).conical_height

    assert np.allclose(heights(0.0), heights(1e-9), rtol=1e-8, atol=0)


@pytest.mark.parametrize("power", [400.0, 1500.0, 1e4])
def test_offsets_of_cords_that_taper_steeply(power):
    """The density is next to 0 but at the support: offsets of the cord are those of a light thread, 0F1(p + 1; -z^2/4)."""
    modes = rc.modes(rc.Cord(1.0, density=power), 3)
    assert np.isfinite(modes.along([0.5, 0.9, 0.999, 1.0])).all() and np.isfinite(modes.shape).all()
    with mp.workdps(30):
        x = (power + 1) * mp.mpf(0.9) / mp.mpf(float(modes.conical_height[1]))
        exact = mp.hyp0f1(power + 1, -x, maxprec=100_000) if power < 2000 else mp.mpf(0)
    assert abs(modes.along([0.9])[1, 0] - float(exact)) < 1e-13
