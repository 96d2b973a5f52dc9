# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability where masses are far apart: against points in space in 55 digits (support/point_masses.py)."""

import mpmath as mp
import numpy as np
import pytest
from point_masses import random_system, small_motions

import revchain as rc


def compare(rig, shape, frame):
    """Checks exponents, errors, negative directions and verdict; the largest error of an exponent, of the largest."""
    got = shape.stability(frame=frame)
    exact, negative = small_motions(rig, shape, frame)
    assert got.exponents.size == got.exponent_error.size == len(exact)
    largest, growth = float(max(map(abs, exact))), float(max(mp.re(s) for s in exact))
    left, worst = list(exact), 0.0
    for value, error in zip(got.exponents, got.exponent_error, strict=True):
        nearest = min(range(len(left)), key=lambda i: abs(left[i] - complex(value)))
        off = float(abs(left.pop(nearest) - complex(value)))
        assert off <= error
        worst = max(worst, off)
    assert got.negative_directions == negative
    grows = growth > 1e-20 * largest
    if got.verdict == "undecided":
        assert growth <= got.margin
    else:
        assert got.verdict == ("unstable" if grows else "spectrally stable" if negative else "minimum")
    return worst / largest


@pytest.mark.parametrize("ratio", [1.0, 1e4, 1e8, 1e12, 1e16])
def test_a_light_link_between_heavy_ones(ratio):
    """Held by gyroscopic forces at any ratio; exponents of the size of 1 keep their digits beside those of sqrt(ratio)."""
    chain = rc.Chain(mass=[1.0, 1 / ratio, 1.0], length=1.0)
    shape = rc.steady_shapes(chain, angular_speed=6.0)[1]
    rig = rc.Rig(rc.Chain(weight=[1.0, 1 / ratio, 1.0], length=1.0))
    assert compare(rig, shape, "free") <= 1e-15
    got = shape.stability()
    assert got.verdict == "spectrally stable" and got.growth_rate == 0
    slow = np.sort(np.abs(got.exponents))[:6]
    exact = sorted(float(abs(s)) for s in small_motions(rig, shape, "free")[0])[:6]
    np.testing.assert_allclose(slow, exact, rtol=1e-13)


def trials(seed, count, spread, rigged):
    """The number of shapes compared, and the worst error."""
    rng, compared, worst = np.random.default_rng(seed), 0, 0.0
    for _ in range(count):
        rig, height = random_system(rng, spread, rigged)
        found = rc.steady_shapes(rig, conical_height=height, budget=30_000)
        if not len(found):
            continue
        shape = found[int(rng.integers(0, len(found)))]
        for frame in ("free", "driven"):
            worst = max(worst, compare(rig, shape, frame))
            compared += 1
    return compared, worst


@pytest.mark.parametrize(
    ("spread", "rigged", "largest"), [(2.0, False, 2e-13), (2.0, True, 2e-13), (8.0, False, 2e-13), (8.0, True, 5e-9)]
)
def test_random_masses(spread, rigged, largest):
    """Masses 10^U(-2, 2) and 10^U(-8, 8), also on arms and springs. `largest` is about twice the worst that was found."""
    for seed in (20, 101, 103, 105, 107, 319):  # 319: links all but level below a spring
        compared, worst = trials(seed, 8, spread, rigged)
        assert compared >= 10
        assert worst <= largest
