# SPDX-License-Identifier: MPL-2.0
"""Modes of rigs from Python: closed forms by mpmath, a dense linearisation by scipy, what is asked and what comes."""

from collections.abc import Callable
from typing import Any

import mpmath
import numpy as np
import pytest
import scipy.linalg

import revchain as rc

G = 9.80665


def matrices(rig: rc.Rig, number: Callable[[float], Any] = float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """K, G and M assembled, small amplitude, from the energies; their entries are made of `number(datum)`."""
    chain, n = rig.chain, rig.size
    K, S, M = (np.full((n + 1, n + 1), number(0.0)) for _ in range(3))
    hung = number(0.0)
    for m in range(n):
        data = (chain.weight, chain.length, chain.centroid, chain.radius_of_gyration, rig.momentum, rig.axial_moment)
        W, a, h, k, H, C = (number(float(column[m])) for column in data)
        sign = -1 if rig.standing[m] else 1
        D, Y = np.full((2, n + 1), number(0.0))
        D[m], D[m + 1] = 1 / a, -1 / a
        K += sign * (W * h + a * hung) * np.outer(D, D)
        S += sign * H * np.outer(D, D)
        Y[m], Y[m + 1] = h / a, 1 - h / a
        M += W * np.outer(Y, Y) + (W * k**2 - C) * np.outer(D, D)
        hung += W
    if np.isfinite(rig.stiffness):
        K[n, n] += number(rig.stiffness)
        M[n, n] += number(rig.carriage_weight)
        return K, S, M
    return K[:n, :n], S[:n, :n], M[:n, :n]


def speeds(rig: rc.Rig) -> np.ndarray:
    K, S, M = matrices(rig)
    n = len(K)
    inverse = np.linalg.inv(M / G)
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [inverse @ K, inverse @ S]])
    return scipy.linalg.eigvals(companion)


def test_one_gyrostat() -> None:
    for H in (-3.0, 0.02, 40.0):
        m = rc.modes(rc.Rig(rc.Chain(weight=3.0, length=1.0, centroid=0.7, radius_of_gyration=0.3), momentum=H))
        with mpmath.workdps(40):
            A = 3 * (mpmath.mpf(0.7) ** 2 + mpmath.mpf(0.3) ** 2) / mpmath.mpf(G)
            root = mpmath.sqrt(mpmath.mpf(H) ** 2 + 4 * A * 3 * mpmath.mpf(0.7))
            exact = sorted([(H - root) / 2 / A, (H + root) / 2 / A], key=abs)
            for n, x, bound in zip(m.angular_speed, exact, m.speed_error_bound, strict=True):
                assert abs(n / x - 1) <= 1.2e-16
                assert bound <= 2.3e-16
        assert m.complete and m.has_momentum and m.status == "success" and m.method == "counts"
        assert list(m.direction) == [np.sign(n) for n in m.angular_speed]


def test_chain_of_wheels_against_a_dense_linearisation() -> None:
    rng = np.random.default_rng(71)
    for stiffness in (np.inf, 30.0):
        chain = rc.Chain(
            weight=rng.uniform(0.5, 2, 12),
            length=rng.uniform(0.5, 2, 12),
            centroid=0.4,
            radius_of_gyration=rng.uniform(0.2, 0.5, 12),
        )
        rig = rc.Rig(chain, momentum=rng.normal(0, 1, 12), stiffness=stiffness, carriage_weight=0.5)
        m = rc.modes(rig, "all")
        expected = np.sort(speeds(rig).real)
        assert len(m) == expected.size
        assert np.allclose(np.sort(m.angular_speed), expected, rtol=1e-10)
        assert m.shape.shape == (len(m), 13)
        assert np.all(np.diff(m.conical_height) <= 0)
        assert m.rpm == pytest.approx(m.angular_speed * 30 / np.pi)
        assert m.frequency * m.period == pytest.approx(m.direction)
        pins = np.append(0, np.cumsum(chain.length))
        for row, n, nodes in zip(m.shape, m.angular_speed, m.nodes, strict=True):
            last = np.flatnonzero(row[:-1] * row[1:] < 0)  # the offset changes its sign above these pins
            part = row[last] / (row[last] - row[last + 1])
            assert nodes == pytest.approx(pins[last] + part * chain.length[last], rel=1e-12)
            K, S, M = matrices(rig)
            y = row[: len(K)]
            terms = np.abs(K) @ np.abs(y) + n * n / G * np.abs(M) @ np.abs(y)
            assert np.abs((K + n * S - n * n / G * M) @ y).max() <= 4e-15 * terms.max()


def test_rigs_with_coordinates_without_inertia_have_every_finite_speed() -> None:
    """The degree of det(K + n S - n^2 M/g), read off at huge n with 300 digits, is the number of finite speeds."""
    rng = np.random.default_rng(1908)
    methods = set()
    for _ in range(400):
        n = int(rng.integers(1, 5))
        kind = rng.integers(0, 5, n)  # bodies, point masses within the link, at either pin, links without mass
        length = rng.uniform(0.2, 3, n)
        centroid = length * np.select([kind == 2, kind == 3], [1.0, 0.0], rng.uniform(0.1, 1.2, n))
        weight = np.where(kind == 4, 0, 10 ** rng.uniform(-1, 1.5, n))
        if weight[0] * centroid[0] == 0:
            weight[0], centroid[0] = 1.0, 0.6 * length[0]
        chain = rc.Chain(
            weight=weight,
            length=length,
            centroid=centroid,
            radius_of_gyration=np.where(kind == 0, 0.2 * length, 0),
        )
        rig = rc.Rig(
            chain,
            stiffness=10 ** rng.uniform(0, 2.5) if rng.random() < 0.7 else np.inf,
            carriage_weight=0.5 if rng.random() < 0.3 else 0,
            momentum=np.where(rng.random(n) < 0.4, rng.normal(0, 1, n), 0),
            standing=rng.random(n) < 0.25,
        )
        m = rc.modes(rig)
        with mpmath.workdps(300):
            K, S, M = (mpmath.matrix(X.tolist()) for X in matrices(rig, mpmath.mpf))
            huge = mpmath.mpf(10) ** 60

            def size(x: mpmath.mpf, K: mpmath.matrix = K, S: mpmath.matrix = S, M: mpmath.matrix = M) -> mpmath.mpf:
                return mpmath.log(abs(mpmath.det(K + x * S - x * x * M / mpmath.mpf(G))))

            degree = round(float((size(2 * huge) - size(huge)) / mpmath.log(2)))
            if not m.has_momentum:
                degree //= 2
        neutral = sum(1 for height in m.other.conical_height if np.isinf(height))
        assert m.complete and m.status == "success", rig
        assert len(m) + len(m.other) - neutral == degree, rig
        assert np.all(np.isfinite(m.angular_speed))
        methods.add(m.method)
    assert methods >= {"counts", "discs"}


def test_sleeping_top() -> None:
    chain = rc.Chain(weight=1.0, length=1.0, centroid=0.5, radius_of_gyration=0.3)
    asleep = rc.modes(rc.Rig(chain, standing=True, momentum=2.0))
    assert len(asleep) == 2 and len(asleep.other) == 0
    falls = rc.modes(rc.Rig(chain, standing=True, momentum=0.1))
    assert len(falls) == 0 and len(falls.other) == 2
    assert falls.other.growth_rate == pytest.approx(abs(speeds(falls.system).imag.max()), rel=1e-13)
    assert np.all(falls.other.error_bound < 1e-14) and falls.complete


def test_standing_and_floats_have_others() -> None:
    stick = rc.modes(rc.Rig(rc.Chain(weight=[1.0, 3.0], length=1.0), standing=[True, False]))
    assert stick.conical_height == pytest.approx([np.sqrt(0.75)], rel=1e-15)
    assert stick.other.conical_height == pytest.approx([-np.sqrt(0.75)], rel=1e-15)
    assert stick.other.growth_rate == pytest.approx([np.sqrt(G / np.sqrt(0.75))], rel=1e-15)
    buoy = rc.modes(rc.Rig(rc.Chain(weight=[1.0, 4.0], length=1.0), displaced_weight=[2.0, 0.0], fluid="turning"))
    assert len(buoy) == 0 and buoy.angular_speed.size == 0
    assert buoy.other.conical_height == pytest.approx([1 + 1j / np.sqrt(3), 1 - 1j / np.sqrt(3)], rel=4e-16)


def test_nothing_on_it_is_the_chain_itself() -> None:
    chain = rc.Chain.uniform_rods(30, length=2.0)
    plain, same = rc.modes(chain, "all"), rc.modes(rc.Rig(chain), "all")
    assert np.array_equal(plain.conical_height, same.conical_height)
    assert np.array_equal(plain.angular_speed, same.angular_speed)
    assert same.method == "modes" and list(same.direction) == [1] * 30 and not same.has_momentum


def test_what_was_asked() -> None:
    rig = rc.Rig(rc.Chain.uniform_rods(30, length=2.0), momentum=0.001)
    all_of_them = rc.modes(rig, "all")
    some = rc.modes(rig, count=3, first=4)
    slow = rc.modes(rig, 2, gravity=G / 4)
    for way in (1, -1):
        one, every = some.direction == way, all_of_them.direction == way
        assert list(some.number[one]) == [4, 5, 6]
        assert np.array_equal(some.angular_speed[one], all_of_them.angular_speed[every][3:6])
        assert np.array_equal(some.shape[one], all_of_them.shape[every][3:6])
        assert np.all(abs(slow.angular_speed[slow.direction == way]) < abs(all_of_them.angular_speed[every][:2]))
    assert slow.gravity == G / 4 and slow.system == rig
    assert len(rc.modes(rig, 2)) == 4 and len(rc.modes(rig)) == 20
    assert all_of_them.available == some.available == (30, 30)
    assert "60 of 60 modes of a rig of a chain of 30 links: 30 links with momentum" in repr(all_of_them)
    assert not all_of_them.conical_height.flags.writeable and not some.shape.flags.writeable
    assert len(rc.modes(rig, 31)) == 60 and sorted(rc.modes(rig, 11, first=29).number) == [29, 29, 30, 30]
    wrongs = ({"count": 0}, {"gravity": 0.0}, {"rtol": 1e-3}, {"method": "dense"}, {"certify": True})
    for wrong in wrongs:
        with pytest.raises(ValueError, match=r"revchain\.?:?"):
            rc.modes(rig, **wrong)
    with pytest.raises(ValueError, match="not both"):
        rc.modes(rig, 2, conical_height=(0.1, 0.2))
    with pytest.raises(TypeError):
        rc.modes("a rig")  # type: ignore[call-overload]


def test_links_that_go_slack() -> None:
    chain = rc.Chain(weight=[1.0, 2.0], length=[1.0, 0.5], centroid=[0.5, 0.25], radius_of_gyration=0.2)
    m = rc.modes(rc.Rig(chain, momentum=[0.0, -0.5]))
    assert list(m.slack_link) == [1] and list(m.slack_speed) == [2.0]


def test_picture() -> None:
    pytest.importorskip("matplotlib")
    rig = rc.Rig(rc.Chain.uniform_rods(6, length=2.0), momentum=0.1, standing=[True] * 2 + [False] * 4)
    ax = rc.modes(rig).plot(most=4)
    labels = [label.get_text() for label in ax.get_xticklabels()]
    assert len(labels) == 5 and labels[0] == "at rest"
    assert labels[1].startswith("mode 1 backward\n-0.") and labels[2].startswith("mode 2 backward\n")
    ax.figure.savefig("/dev/null", format="png")
