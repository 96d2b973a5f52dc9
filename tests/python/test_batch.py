# SPDX-License-Identifier: GPL-3.0-or-later
"""Many chains at once: against exact heights, against numpy's broadcasting, and with wrong numbers."""

import math

import numpy as np
import pytest

import revchain as rc

ULP = 2.0**-52


def random_batch(generator, *shape):
    length = generator.uniform(0.5, 2, shape)
    return {
        "weight": generator.uniform(0.5, 2, shape),
        "length": length,
        "centroid": length * generator.uniform(0.1, 1.2, shape),
        "radius_of_gyration": length * generator.uniform(0, 1, shape),
    }


@pytest.mark.parametrize("links", [1, 2, 3, 7])
def test_within_4_ulp(links, exact_heights):
    batch = random_batch(np.random.default_rng(links), 12, links)
    heights = rc.conical_heights(**batch)
    assert heights.shape == (12, links)
    for c, row in enumerate(heights):
        exact = exact_heights(rc.Chain(**{name: value[c] for name, value in batch.items()}))
        assert max(abs(float((x - e) / e)) for x, e in zip(row, exact, strict=True)) <= 4 * ULP


def test_defaults_are_those_of_chain(exact_heights):
    weight, length = [1.0, 2.5, 0.7], [0.3, 1.0, 2.0]
    h = np.array([0.2, -0.01, 1.4])
    for rest in (
        {},
        {"centroid": h, "radius_of_gyration": 0.5},
        {"centroid": [0.2, 0.5, 1.4], "pendulum_length": [0.2, 0.9, 3.0]},
        {"centroid": 0.5, "pendulum_length": 0.75},
    ):
        chain = rc.Chain(weight=weight, length=length, **rest)
        found = rc.conical_heights(weight=weight, length=length, **rest)
        assert found.shape == (3,)
        assert max(abs(float(x / e - 1)) for x, e in zip(found, exact_heights(chain), strict=True)) <= 4 * ULP


@pytest.mark.parametrize(
    ("weight", "length", "expected"),
    [((), (), (1,)), ((5,), (), (5,)), ((), (5,), (5,)), ((5,), (1,), (5,)), ((4, 5), (5,), (4, 5)), ((4, 1), (5,), (4, 5))]
    + [((4, 5), (4, 1), (4, 5)), ((3, 1, 5), (4, 1), (3, 4, 5)), ((3, 4, 5), (4, 5), (3, 4, 5))]
    + [((1, 4, 5), (3, 1, 1), (3, 4, 5)), ((0, 5), (5,), (0, 5)), ((2, 0, 5), (), (2, 0, 5))],
)
def test_shapes_broadcast_as_in_numpy(weight, length, expected):
    generator = np.random.default_rng(1)
    w, a = generator.uniform(1, 2, weight), generator.uniform(1, 2, length)
    found = rc.conical_heights(weight=w, length=a)
    assert found.shape == expected
    full_w, full_a = np.broadcast_to(w, expected), np.broadcast_to(a, expected)
    assert np.array_equal(found, rc.conical_heights(weight=full_w.copy(), length=full_a.copy()))
    for index in np.ndindex(expected[:-1]):
        assert np.array_equal(found[index], rc.conical_heights(weight=full_w[index], length=full_a[index]))


def test_any_memory_layout():
    w = np.random.default_rng(2).uniform(1, 2, (30, 4))
    expected = rc.conical_heights(weight=w, length=1.0)
    assert np.array_equal(rc.conical_heights(weight=np.asfortranarray(w), length=1), expected)
    backwards = rc.conical_heights(weight=w[::-1, ::-1], length=[1, 1, 1, 1])
    assert np.array_equal(backwards[::-1][3:5], rc.conical_heights(weight=w[3:5, ::-1], length=1))
    assert np.array_equal(rc.conical_heights(weight=w.tolist(), length=1), expected)
    assert np.array_equal(rc.conical_heights(weight=w.astype(">f8"), length=1), expected)


def test_count():
    batch = random_batch(np.random.default_rng(3), 100, 9)
    heights = rc.conical_heights(**batch)
    assert (abs(rc.conical_heights(**batch, count=2) / heights[:, :2] - 1) <= 4 * ULP).all()
    assert (np.diff(heights) < 0).all()


def test_massless_links_need_a_count_where_chains_differ():
    weight = [[1, 1, 1], [1, 0, 1]]
    with pytest.raises(ValueError, match=r"chain 1 has only 2 modes; count must not exceed them, got 3"):
        rc.conical_heights(weight=weight, length=1.0)
    found = rc.conical_heights(weight=weight, length=1.0, count=2)
    assert np.allclose(found[1], rc.modes(rc.Chain(weight=[1, 0, 1], length=1.0)).conical_height, rtol=1e-15)
    assert rc.conical_heights(weight=[1, 0, 1], length=np.ones((4, 3))).shape == (4, 2)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("weight", math.nan, "weight must be finite and not negative, got nan"),
        ("length", -1, "length must be positive and finite, got -1"),
        ("centroid", math.inf, "centroid must be finite, got inf"),
        ("centroid", -9, "it would stand, not hang"),
        ("radius_of_gyration", -2, "radius of gyration must be finite and not negative, got -2"),
    ],
)
def test_wrong_numbers_are_named(name, value, message):
    batch = random_batch(np.random.default_rng(4), 2, 5, 3)
    batch[name][1, 2, 2] = value
    with pytest.raises(ValueError, match=rf"chain \(1, 2\): links\[2\]: {message}"):
        rc.conical_heights(**batch)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ({"weight": "x", "length": 1}, "weight must be a number, or a number and its unit"),
        ({"weight": [1, 2], "length": [1, 2, 3]}, r"these shapes do not go together: weight \(2,\), length \(3,\)"),
        ({"weight": np.ones((2, 0)), "length": 1}, "a chain needs at least one link, got 0"),
        ({"weight": [1, 2], "length": 1, "count": 0}, "count must be at least 1, got 0"),
        ({"weight": [1, 2], "length": 1, "count": 3}, "count must not exceed the 2 links of a chain, got 3"),
        ({"weight": [1, 2], "length": 1, "threads": -1}, "threads must not be negative, got -1"),
        ({"weight": [1, 2], "length": 1, "threads": 1.5}, "threads must be a whole number, got 1.5"),
        ({"weight": 1, "length": 1, "centroid": 1}, "centroid needs exactly one of"),
        ({"weight": 1, "length": 1, "pendulum_length": 1}, "pendulum_length needs centroid"),
        ({"weight": 1, "length": 1, "radius_of_gyration": 1}, "radius_of_gyration needs centroid"),
        ({"weight": 1, "length": 1, "centroid": 2, "pendulum_length": 1}, r"chain 0: links\[0\]: imaginary radius of gyration"),
    ],
)
def test_wrong_calls(arguments, message):
    with pytest.raises(ValueError, match=message):
        rc.conical_heights(**arguments)
