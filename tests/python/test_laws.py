# SPDX-License-Identifier: GPL-3.0-or-later
"""Laws that heights obey whatever computes them."""

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import revchain as rc

ULP = 2.0**-52
CONDITION = 6  # of a height in each of the numbers given, the largest found in extreme chains (docs/theory/matrices.md)


@st.composite
def links(draw, most=8):
    n = draw(st.integers(1, most))
    column = lambda low, high: np.array(draw(st.lists(st.floats(low, high), min_size=n, max_size=n)))  # noqa: E731
    weight, length = np.exp2(column(-10, 10)), np.exp2(column(-3, 3))
    return {
        "weight": weight,
        "length": length,
        "centroid": length * column(0.05, 1.5),
        "radius_of_gyration": length * column(0.01, 1.5),
    }


def scaled(link, **factors):
    return rc.Chain(**{name: column * factors.get(name, 1.0) for name, column in link.items()})


@given(links(), st.integers(-100, 100), st.integers(-60, 60))
def test_powers_of_two_scale_exactly(link, weight, length):
    factor = 2.0**length
    plain = rc.modes(rc.Chain(**link))
    other = rc.modes(scaled(link, weight=2.0**weight, length=factor, centroid=factor, radius_of_gyration=factor))
    assert np.array_equal(other.conical_height, plain.conical_height * factor)
    assert np.array_equal(other.error_bound, plain.error_bound)


@given(links(), st.floats(1e-3, 1e3), st.floats(1e-3, 1e3))
def test_heights_scale_with_lengths_and_not_with_weights(link, weight, factor):
    plain = rc.modes(rc.Chain(**link))
    other = rc.modes(scaled(link, weight=weight, length=factor, centroid=factor, radius_of_gyration=factor))
    # each of the four columns is rounded once (half an ulp, condition 6), and the product too
    slack = plain.error_bound + other.error_bound + (4 * CONDITION + 1) * ULP / 2
    assert (np.abs(other.conical_height / (plain.conical_height * factor) - 1) <= slack).all()


def append(link, above):
    return {name: np.append(column, above[name]) for name, column in link.items()}


@given(links(6), links(1))
def test_a_link_added_above_interlaces(link, above):
    """The old chain is the new one with its old support held fast: a constraint (Rayleigh)."""
    old = rc.modes(rc.Chain(**link))
    new = rc.modes(rc.Chain(**append(link, above)))
    assert (new.conical_height[:-1] * (1 + new.error_bound[:-1]) >= old.conical_height * (1 - old.error_bound)).all()
    assert (new.conical_height[1:] * (1 - new.error_bound[1:]) <= old.conical_height * (1 + old.error_bound)).all()


@given(links(6), st.floats(0.01, 10.0), st.floats(0.1, 10.0))
def test_a_plummet_added_below_interlaces(link, weight, length):
    """The chain with that weight fixed in its lowest pin is the new one with the plummet held vertical."""
    n = link["weight"].size
    below = {"weight": weight, "length": length, "centroid": length, "radius_of_gyration": 0.0}
    new = rc.modes(rc.Chain(**{name: np.insert(link[name], 0, below[name]) for name in link}))
    w, a = link["weight"][0], link["length"][0]
    h, rho = link["centroid"][0], link["radius_of_gyration"][0]
    total = w + weight
    centroid = (w * h + weight * a) / total
    square = (w * rho**2 + w * (h - centroid) ** 2 + weight * (a - centroid) ** 2) / total
    body = {"weight": total, "length": a, "centroid": centroid, "radius_of_gyration": np.sqrt(square)}
    fixed = {name: np.concatenate([[body[name]], link[name][1:]]) for name in link}
    old = rc.modes(rc.Chain(**fixed))
    slack = 1 + 3 * CONDITION * 4 * ULP  # the body's three numbers are computed here, within 4 ulp each
    assert len(old) == n and len(new) == n + 1
    assert (new.conical_height[:-1] * slack >= old.conical_height).all()
    assert (new.conical_height[1:] <= old.conical_height * slack).all()


@pytest.mark.parametrize("count", [1, 2, 3, 5, 8, 13, 21, 34, 50])
def test_equal_plummets_are_laguerre_zeros(count):
    chain = rc.Chain.uniform_plummets(count, length=float(count))  # threads of length 1 exactly
    result = rc.modes(chain, "all")
    with mp.workdps(80):
        value = lambda height: mp.laguerre(count, 0, 1 / mp.mpf(height))  # noqa: E731
        for height, bound in zip(result.conical_height.tolist(), result.error_bound.tolist(), strict=True):
            below, above = (value(mp.mpf(height) * (1 + sign * mp.mpf(bound))) for sign in (-1, 1))
            assert mp.sign(below) != mp.sign(above)  # a zero lies within the bound


# Relative error of 1 / height against the continuous chain: coefficient of 1/N (plummets) and 1/N^2
# (rods: links h = a/2, l = 2a/3), modes 1 to 3; measured coefficients within 0.06 percent at N = 160, 320.
RODS = (0.0614, 2.065, 8.985)


def test_rods_converge_with_the_square_of_their_number():
    n = 400
    exact = rc.modes(rc.Cord(1.0), 3).conical_height
    found = rc.modes(rc.Chain.uniform_rods(n), count=3).conical_height
    coefficient = (exact / found - 1) * n**2
    np.testing.assert_allclose(coefficient, RODS, rtol=2e-3)  # next term ~ j^2/N^2 and 3 given digits


def test_plummets_converge_with_their_number():
    exact = rc.modes(rc.Cord(1.0), 3).conical_height
    for n in (1000, 10_000):
        found = rc.modes(rc.Chain.uniform_plummets(n), count=3).conical_height
        np.testing.assert_allclose((exact / found - 1) * n, -0.5, rtol=4 / n)  # next term ((j^2 - 2)/48 + 1/4)/N


def test_tip_mass_is_the_limit_of_links():
    want = rc.modes(rc.Cord(1.0, weight=2.0, tip_weight=0.8), 3).conical_height
    error = []
    for count in (50, 100, 200):
        chain = rc.Chain.uniform_rods(count, length=1.0, weight=2.0).with_body(weight=0.8)
        error.append(np.abs(rc.modes(chain, count=3).conical_height / want - 1))
    assert np.all(np.abs(error[0] / error[1] - 4) < 0.2)
    assert np.all(np.abs(error[1] / error[2] - 4) < 0.2)


def test_shapes_tend_to_bessel_functions():
    n = 2000
    result, cord = rc.modes(rc.Chain.uniform_rods(n), count=4), rc.modes(rc.Cord(1.0), count=4)
    x = np.arange(n + 1) / n
    for mode in range(1, 5):
        assert np.abs(result.shape[mode - 1] - cord.along(x)[mode - 1]).max() < 20 * mode**2 / n**2 * np.log(n)
        np.testing.assert_allclose(result.nodes[mode - 1], cord.nodes[mode - 1], atol=20 * mode**2 / n**2)
