# SPDX-License-Identifier: GPL-3.0-or-later
"""revchain.tip_mass, revchain.tapered_chain and what revchain.heavy_chain says of one mode, against mpmath and laws."""

import math

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from revchain import heavy_chain, tapered_chain, tip_mass

ULP = 2.0**-52
NAN, INF = math.nan, math.inf


def ulps(found, exact):
    return float(abs(mp.mpf(float(found)) / exact - 1) / ULP)


@pytest.mark.parametrize("exponent", [0.0, 0.3, 2.0, 11.5])
def test_heights_are_those_of_the_zeros_of_bessel_functions(exponent):
    """Zeros counted by mpmath, so that each mode is the right one."""
    heights = tapered_chain.conical_heights(8, exponent=exponent, length=0.7)
    with mp.workdps(40):
        exact = [4 * (mp.mpf(exponent) + 1) * mp.mpf(0.7) / mp.besseljzero(exponent, k) ** 2 for k in range(1, 9)]
        assert max(map(ulps, heights, exact)) <= 3
        if exponent == 0:
            assert max(map(ulps, heavy_chain.conical_heights(8, 0.7), exact)) <= 3


def test_numbers_of_the_paper():
    """Section 4 (12) and (14), corrected: x / lambda at the nodes and at the vertical points."""
    height = heavy_chain.conical_heights(4)[3]
    np.testing.assert_allclose(heavy_chain.nodes(4) / height, [1.445796, 7.617816, 18.721752], atol=5e-7)
    np.testing.assert_allclose(heavy_chain.vertical_points(4) / height, [3.670493, 12.304614, 25.874864], atol=5e-7)


@settings(max_examples=40, deadline=None)
@given(st.floats(-8, 8), st.integers(1, 25), st.floats(-3, 3))
def test_tip_mass_laws(log_tip, mode, log_length):
    length = 10.0**log_length
    tip = 10.0**log_tip * length
    heights = tip_mass.conical_heights(mode + 1, tip=tip, length=length)
    assert (np.diff(heights) < 0).all()
    # Weight at the end stretches the chain: slower than a chain of tip + length, faster than the string it becomes.
    assert (heights <= heavy_chain.conical_heights(mode + 1, tip + length) * (1 + 1e-14)).all()
    nodes = tip_mass.nodes(mode, tip=tip, length=length)
    between = np.concatenate([[0], nodes]) / 2 + np.concatenate([nodes, [length]]) / 2
    signs = np.sign(tip_mass.shape(between, mode, tip=tip, length=length))
    np.testing.assert_array_equal(signs, (-1.0) ** np.arange(mode))
    np.testing.assert_allclose(tip_mass.slope(0.0, mode, tip=tip, length=length) * heights[mode - 1], -1, rtol=1e-14)


@settings(max_examples=40, deadline=None)
@given(st.floats(-0.99, 60), st.integers(1, 25))
def test_tapered_chain_laws(exponent, mode):
    heights = tapered_chain.conical_heights(mode + 1, exponent=exponent)
    next_heights = tapered_chain.conical_heights(mode + 1, exponent=exponent + 1)
    # Zeros of neighbouring orders interlace.
    zeros, following = np.sqrt((exponent + 1) / heights), np.sqrt((exponent + 2) / next_heights)
    assert (zeros < following).all() and (following[:-1] < zeros[1:]).all()
    nodes = tapered_chain.nodes(mode, exponent=exponent)
    assert (np.diff(np.concatenate([[0], nodes, [1]])) > 0).all()
    assert nodes.shape == (mode - 1,)


@settings(max_examples=40, deadline=None)
@given(st.integers(1, 1000), st.floats(1e-3, 1e3))
def test_limits_agree(mode, length):
    uniform = heavy_chain.conical_heights(mode, length)
    np.testing.assert_allclose(tip_mass.conical_heights(mode, tip=0.0, length=length), uniform, rtol=4 * ULP)
    np.testing.assert_allclose(tapered_chain.conical_heights(mode, exponent=0.0, length=length), uniform, rtol=4 * ULP)


def test_uniform_chain_slope_and_energies():
    x = np.linspace(0, 0.7, 15)
    for mode in (1, 2, 9):
        height = heavy_chain.conical_heights(mode, 0.7)[-1]
        slope = heavy_chain.slope(x, mode, 0.7)
        assert slope[0] == -1 / height
        np.testing.assert_allclose(slope, tapered_chain.slope(x, mode, exponent=0, length=0.7), atol=4e-15 * mode / height)
        node, weight = np.polynomial.legendre.leggauss(60)
        z = (node + 1) / 2 * 2 * math.sqrt(0.7 / height)
        at = np.minimum(height * z**2 / 4, 0.7)
        dx = weight * math.sqrt(0.7 / height) * height * z / 2
        energy = heavy_chain.kinetic_energy(mode, 0.1)
        offset, steep = (0.1 * f(at, mode, 0.7) for f in (heavy_chain.shape, heavy_chain.slope))
        assert (offset**2 * dx).sum() / (2 * height) == pytest.approx(energy, rel=1e-13)
        assert (at * steep**2 * dx).sum() / 2 == pytest.approx(energy, rel=1e-13)


def test_shapes_of_arrays():
    assert tip_mass.conical_heights(3, tip=[0.0, 1.0], length=[[1.0], [2.0]]).shape == (2, 2, 3)
    assert tapered_chain.conical_heights(3, exponent=[0.0, 1.0]).shape == (2, 3)
    for function, given_ in ((tip_mass, {"tip": [0.1, 2.0]}), (tapered_chain, {"exponent": [0.1, 2.0]})):
        name, values = next(iter(given_.items()))
        for what in (function.shape, function.slope):
            both = what(np.linspace(0, 1, 5)[:, None, None], [[1], [7]], **given_)
            assert both.shape == (5, 2, 2)
            assert both[3, 1, 1] == what(0.75, 7, **{name: values[1]})
            assert np.ndim(what(0.75, 7, **{name: values[1]})) == 0
    assert heavy_chain.slope(np.zeros((4, 1)), [1, 2, 3]).shape == (4, 3)
    assert np.ndim(heavy_chain.kinetic_energy(1)) == np.ndim(heavy_chain.shape(0.0, 1)) == 0
    assert heavy_chain.conical_heights(3, [[1.0, 2.0]]).shape == (1, 2, 3)
    assert heavy_chain.revolutions_per_second(3, [1.0, 2.0], [[9.8], [1.6]]).shape == (2, 2, 3)
    assert heavy_chain.nodes(1).shape == heavy_chain.vertical_points(1).shape == (0,)
    assert heavy_chain.kinetic_energy([1, 2], [[1.0], [2.0]]).shape == (2, 2)


@pytest.mark.parametrize(
    ("function", "arguments", "message"),
    [
        (tip_mass.conical_heights, {"count": 0, "tip": 1}, "count must be at least 1, got 0"),
        (tip_mass.conical_heights, {"count": 1, "tip": -1}, "tip must not be negative, got -1"),
        (tip_mass.conical_heights, {"count": 1, "tip": [1.0, NAN]}, "tip must not be negative, got nan"),
        (tip_mass.conical_heights, {"count": 1, "tip": INF}, "tip must be at most 1e250 lengths, got inf"),
        (tip_mass.conical_heights, {"count": 1, "tip": 1.0, "length": 0.0}, "length must be positive and finite, got 0"),
        (tip_mass.conical_heights, {"count": 1, "tip": [1, 2], "length": [1, 2, 3]}, "do not go together"),
        (tip_mass.shape, {"x": 1.5, "mode": 1, "tip": 1.0}, "x must lie between 0 and length, got 1.5"),
        (tip_mass.shape, {"x": NAN, "mode": 1, "tip": 1.0}, "x must lie between 0 and length, got nan"),
        (tip_mass.slope, {"x": 0.5, "mode": 1.5, "tip": 1.0}, "mode must be a whole number, got 1.5"),
        (tip_mass.slope, {"x": 0.5, "mode": 2**60, "tip": 1.0}, "mode is too large"),
        (tip_mass.nodes, {"mode": 0, "tip": 1.0}, "mode must be at least 1, got 0"),
        (tip_mass.nodes, {"mode": 1, "tip": [1.0]}, "tip must be a single number"),
        (tapered_chain.conical_heights, {"count": 1, "exponent": -1.0}, "exponent must be above -1 and at most 1e4, got -1"),
        (tapered_chain.conical_heights, {"count": 1, "exponent": INF}, "exponent must be above -1 and at most 1e4, got inf"),
        (tapered_chain.shape, {"x": -1, "mode": 1, "exponent": 1.0}, "x must lie between 0 and length, got -1"),
        (tapered_chain.slope, {"x": 0, "mode": 0, "exponent": 1.0}, "mode must be at least 1, got 0"),
        (tapered_chain.nodes, {"mode": 2, "exponent": NAN}, "exponent must be above -1 and at most 1e4, got nan"),
        (heavy_chain.slope, {"x": 2.0, "mode": 1}, "x must lie between 0 and length, got 2"),
        (heavy_chain.kinetic_energy, {"mode": 0}, "mode must be at least 1, got 0"),
        (heavy_chain.kinetic_energy, {"mode": 1, "amplitude": 0.0}, "amplitude must be positive and finite, got 0"),
        (heavy_chain.conical_heights, {"count": 1.0}, "count must be a whole number, got 1.0"),
        (heavy_chain.conical_heights, {"count": 2, "length": [1.0, NAN]}, "length must be positive and finite, got nan"),
        (heavy_chain.conical_heights, {"count": 2, "length": INF}, "length must be positive and finite, got inf"),
        (heavy_chain.nodes, {"mode": 2, "length": -1.0}, "length must be positive and finite, got -1"),
        (heavy_chain.nodes, {"mode": 2, "length": [1.0, 2.0]}, "length must be a single number"),
        (heavy_chain.vertical_points, {"mode": 2.5}, "mode must be a whole number, got 2.5"),
        (heavy_chain.shape, {"x": -0.1, "mode": 1}, "x must lie between 0 and length, got -0.1"),
        (heavy_chain.shape, {"x": 0.5, "mode": [True]}, "mode must be a whole number, got [True]"),
        (heavy_chain.shape, {"x": 0.5, "mode": 1, "length": 0.0}, "length must be positive and finite, got 0"),
        (heavy_chain.shape, {"x": [0.5, 0.6], "mode": [1, 2, 3]}, "do not go together"),
        (heavy_chain.revolutions_per_second, {"count": 2, "gravity": 0.0}, "gravity must be positive and finite, got 0"),
    ],
)
def test_bad_input_is_named(function, arguments, message):
    with pytest.raises(ValueError) as caught:
        function(**arguments)
    assert str(caught.value).startswith(f"{function.__module__.replace('closed_forms.', '')}.{function.__name__}: ")
    assert message in str(caught.value)
