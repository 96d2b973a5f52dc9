# SPDX-License-Identifier: GPL-3.0-or-later
"""Rayleigh's law of constraints, which heights obey whatever computes them.

Units, equal plummets, the limit of many links: tests/cpp/modes.cpp, tests/cpp/linear/extremes.cpp, tests/cpp/limits."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

import revchain as rc

ULP = 2.0**-52
CONDITION = 6  # of a height in each of the numbers given, the largest found in extreme chains


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
