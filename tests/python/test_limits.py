# SPDX-License-Identifier: GPL-3.0-or-later
"""revchain.heavy_chain and revchain.conical_pendulum against mpmath and the paper's own numbers."""

import math

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from revchain import conical_pendulum, heavy_chain

ULP = 2.0**-52
NAN, INF = math.nan, math.inf


def errors(found, exact):
    """Relative errors in ulp (2^-52)."""
    with mp.workdps(40):
        return [float(abs(mp.mpf(float(f)) / e - 1) / ULP) for f, e in zip(found, exact, strict=True)]


def zeros(order, count):
    with mp.workdps(40):
        return [mp.besseljzero(order, k) for k in range(1, count + 1)]


@pytest.mark.parametrize("length", [1.0, 0.1, 1520.0, 2.0**-900])
def test_conical_heights_within_4_ulp(length):
    with mp.workdps(40):
        exact = [4 * mp.mpf(length) / z**2 for z in zeros(0, 60)]
    assert max(errors(heavy_chain.conical_heights(60, length), exact)) <= 4


@pytest.mark.parametrize("mode", [1, 2, 3, 7, 40])
def test_nodes_and_vertical_points_within_5_ulp(mode):
    with mp.workdps(40):
        last = zeros(0, mode)[-1]
        nodes = [mp.mpf(0.7) * (z / last) ** 2 for z in zeros(0, mode)[:-1]]
        vertical = [mp.mpf(0.7) * (z / last) ** 2 for z in zeros(1, mode)[: mode - 1]]
    assert max(errors(heavy_chain.nodes(mode, 0.7), nodes), default=0) <= 5
    assert max(errors(heavy_chain.vertical_points(mode, 0.7), vertical), default=0) <= 5


@pytest.mark.parametrize("mode", [1, 3, 20, 200])
def test_shape_absolute_error(mode):
    x = np.concatenate([np.linspace(0, 0.7, 41), heavy_chain.nodes(mode, 0.7)])
    found = heavy_chain.shape(x, mode, 0.7)
    with mp.workdps(40):
        z = mp.besseljzero(0, mode)
        exact = [mp.besselj(0, z * mp.sqrt(mp.mpf(float(at)) / mp.mpf(0.7))) for at in x]
        worst = max(abs(mp.mpf(float(f)) - e) for f, e in zip(found, exact, strict=True))
    assert found[0] == 1.0
    assert worst < 1e-15 * mode


def test_revolutions_of_the_paper():
    """Section 4 (11): R = N z / 2, N = sqrt(g / L) / (2 pi)."""
    with mp.workdps(40):
        exact = [mp.sqrt(mp.mpf(9.80665) / mp.mpf(0.36)) / (4 * mp.pi) * z for z in zeros(0, 5)]
    assert max(errors(heavy_chain.revolutions_per_second(5, 0.36), exact)) <= 6


def test_numbers_of_the_paper():
    """Section 4 (12) and (14), corrected: x / lambda at the nodes and at the vertical points."""
    height = heavy_chain.conical_heights(4)[3]
    np.testing.assert_allclose(heavy_chain.nodes(4) / height, [1.445796, 7.617816, 18.721752], atol=5e-7)
    np.testing.assert_allclose(heavy_chain.vertical_points(4) / height, [3.670493, 12.304614, 25.874864], atol=5e-7)


def test_broadcasting():
    assert heavy_chain.conical_heights(3, [[1.0, 2.0]]).shape == (1, 2, 3)
    assert heavy_chain.conical_heights(3).shape == (3,)
    assert heavy_chain.revolutions_per_second(3, [1.0, 2.0], [[9.8], [1.6]]).shape == (2, 2, 3)
    assert heavy_chain.shape(np.zeros((4, 1)), [1, 2, 3], 1.0).shape == (4, 3)
    assert heavy_chain.shape(0.0, 1) == 1.0 and np.ndim(heavy_chain.shape(0.0, 1)) == 0
    assert heavy_chain.nodes(1).shape == heavy_chain.vertical_points(1).shape == (0,)
    assert conical_pendulum.period([1.0, 4.0], [[9.8], [1.6], [3.7]]).shape == (3, 2)
    assert isinstance(conical_pendulum.period(1.0), float)


@pytest.mark.parametrize(
    ("function", "arguments"),
    [
        (heavy_chain.conical_heights, (0,)),
        (heavy_chain.conical_heights, (1.0,)),
        (heavy_chain.conical_heights, (2, 0.0)),
        (heavy_chain.conical_heights, (2, [1.0, NAN])),
        (heavy_chain.conical_heights, (2, INF)),
        (heavy_chain.nodes, (0,)),
        (heavy_chain.nodes, (2, -1.0)),
        (heavy_chain.nodes, (2, [1.0, 2.0])),
        (heavy_chain.vertical_points, (2.5,)),
        (heavy_chain.vertical_points, (2, NAN)),
        (heavy_chain.shape, (-0.1, 1)),
        (heavy_chain.shape, (1.1, 1)),
        (heavy_chain.shape, (NAN, 1)),
        (heavy_chain.shape, (0.5, 0)),
        (heavy_chain.shape, (0.5, 1.5)),
        (heavy_chain.shape, (0.5, [True])),
        (heavy_chain.shape, (0.5, 1, 0.0)),
        (heavy_chain.shape, ([0.5, 0.6], [1, 2, 3])),
        (heavy_chain.revolutions_per_second, (2, 1.0, 0.0)),
    ],
)
def test_heavy_chain_refused(function, arguments):
    with pytest.raises(ValueError):
        function(*arguments)


positive = st.floats(1e-100, 1e100)


@given(positive, positive)
def test_conical_pendulum_within_2_1_ulp(x, g):
    with mp.workdps(40):
        mx, mg = mp.mpf(x), mp.mpf(g)
        exact = [
            mp.sqrt(mg / mx),
            2 * mp.pi * mp.sqrt(mx / mg),
            mp.sqrt(mg / mx) / (2 * mp.pi),
            mg / mx**2,
            mg * mx**2 / (4 * mp.pi**2),
            mp.pi**2 * mx,
            4 * mp.pi**2 * mx / mg**2,
            mx * mg**2 / 4,
        ]
    found = [
        conical_pendulum.angular_speed(x, g),
        conical_pendulum.period(x, g),
        conical_pendulum.revolutions_per_second(x, g),
        conical_pendulum.height(x, g),
        conical_pendulum.height_from_period(x, g),
        conical_pendulum.gravity_from_seconds_pendulum(x),
        conical_pendulum.gravity(x, g),
        conical_pendulum.height_from_seconds_pendulum(x, g),
    ]
    assert max(errors(found, exact)) <= 2.1


@pytest.mark.parametrize(
    "function",
    [
        conical_pendulum.angular_speed,
        conical_pendulum.period,
        conical_pendulum.revolutions_per_second,
        conical_pendulum.height,
        conical_pendulum.height_from_period,
    ],
)
@pytest.mark.parametrize("bad", [0.0, -1.0, NAN, INF, [1.0, 0.0], "1", None, 1j, True])
def test_conical_pendulum_refused(function, bad):
    with pytest.raises(ValueError):
        function(bad)
    with pytest.raises(ValueError, match="gravity"):
        function(1.0, bad)
    with pytest.raises(ValueError, match="length"):
        conical_pendulum.gravity_from_seconds_pendulum(bad)
    for other in (conical_pendulum.gravity, conical_pendulum.height_from_seconds_pendulum):
        with pytest.raises(ValueError, match="period"):
            other(1.0, bad)


def test_the_pendulum_that_beats_seconds():
    """Section 1 (5), (6): 39.1396 inches; pi^2 of it is 386.292."""
    gravity = conical_pendulum.gravity_from_seconds_pendulum(39.1396)
    assert gravity == pytest.approx(386.29237, abs=5e-6)
    assert conical_pendulum.period(39.1396, gravity) == pytest.approx(2.0, rel=4 * ULP)
