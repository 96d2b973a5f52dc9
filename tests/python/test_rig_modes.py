# SPDX-License-Identifier: MPL-2.0
"""Modes of rigs from Python: closed forms by mpmath, a dense linearisation by scipy, what is asked and what comes."""

import mpmath
import numpy as np
import pytest
import scipy.linalg
from rigs import G, pencil, random_chain, rigged

import revchain as rc


def speeds(rig: rc.Rig) -> np.ndarray:
    K, S, M = (np.array(matrix) for matrix in pencil(rig, float))
    n = len(K)
    inverse = np.linalg.inv(M / G)
    companion = np.block([[np.zeros((n, n)), np.eye(n)], [inverse @ K, inverse @ S]])
    return scipy.linalg.eigvals(companion)


@pytest.mark.parametrize("data", [(3.0, 0.7, 0.3), (7.0, 0.4, 0.25)])
@pytest.mark.parametrize("H", [0.0, 1e-12, 0.02, 1.0, -3.0, 40.0, 1e6, -1e9])
def test_one_gyrostat(data: tuple[float, float, float], H: float) -> None:
    """A n^2 - H n - W h = 0, A about the pin."""
    weight, centroid, gyration = data
    chain = rc.Chain(weight=weight, length=1.0, centroid=centroid, radius_of_gyration=gyration)
    m = rc.modes(rigged(chain, momentum=H))
    with mpmath.workdps(50):
        W, h, k, p = map(mpmath.mpf, (*data, H))
        A = W * (h**2 + k**2) / mpmath.mpf(G)
        root = mpmath.sqrt(p**2 + 4 * A * W * h)
        exact = sorted([(p - root) / 2 / A, (p + root) / 2 / A], key=abs) if H else [root / 2 / A]
        for n, x, bound in zip(m.angular_speed, exact, m.speed_error_bound, strict=True):
            assert abs(n / x - 1) <= 1.2e-16
            assert bound <= (2.3e-16 if H else 6.7e-16)
    assert m.complete and m.has_momentum == (H != 0) and m.status == "success"
    assert m.method == "counts" or not H
    assert list(m.direction) == [np.sign(n) for n in m.angular_speed]


@pytest.mark.parametrize(("size", "stiffness"), [(5, 15), (12, np.inf), (12, 30), (200, np.inf)])
def test_chain_of_wheels_against_a_dense_linearisation(size: int, stiffness: float) -> None:
    rng = np.random.default_rng(71)
    weight, length, gyration = (rng.uniform(low, high, size) for low, high in ((0.5, 2), (0.5, 2), (0.2, 0.5)))
    chain = rc.Chain(weight=weight, length=length, centroid=0.4, radius_of_gyration=gyration)
    momentum = rng.normal(0, 1, size)
    if size == 5:
        chain, momentum = random_chain(rng, size), 2 * momentum
    if size == 200:
        chain = rc.Chain(weight=weight, length=0.01, centroid=0.005, radius_of_gyration=0.006)
        momentum *= 0.02
    rig = rigged(chain, momentum=momentum, stiffness=stiffness, carriage=0.5)
    m = rc.modes(rig, "all")
    expected = np.sort(speeds(rig).real)
    assert len(m) == expected.size
    assert np.allclose(np.sort(m.angular_speed), expected, rtol=1e-10, atol=0)
    assert m.shape.shape == (len(m), size + 1)
    assert np.all(np.diff(m.conical_height) <= 0)
    assert m.rpm == pytest.approx(m.angular_speed * 30 / np.pi)
    assert m.frequency * m.period == pytest.approx(m.direction)
    pins = np.append(0, np.cumsum(chain.length))
    K, S, M = (np.array(matrix) for matrix in pencil(rig, float))
    for row, n, nodes in zip(m.shape, m.angular_speed, m.nodes, strict=True):
        last = np.flatnonzero(row[:-1] * row[1:] < 0)  # the offset changes its sign above these pins
        part = row[last] / (row[last] - row[last + 1])
        if size < 200:  # where every offset is large enough for a sign
            assert nodes == pytest.approx(pins[last] + part * chain.length[last], rel=1e-12)
        assert max(abs(row)) == 1 and row[0] > 0
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
        gyration = np.where(kind == 0, 0.2 * length, 0)
        chain = rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=gyration)
        rig = rigged(
            chain,
            stiffness=10 ** rng.uniform(0, 2.5) if rng.random() < 0.7 else np.inf,
            carriage=0.5 if rng.random() < 0.3 else 0,
            momentum=np.where(rng.random(n) < 0.4, rng.normal(0, 1, n), 0),
            inverted=rng.random(n) < 0.25,
        )
        m = rc.modes(rig)
        with mpmath.workdps(300):
            K, S, M = (mpmath.matrix(X) for X in pencil(rig))
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
    """H^2 > 4 A W h: A n^2 + H n + W h = 0 has two roots."""
    chain = rc.Chain(weight=1.0, length=1.0, centroid=0.5, radius_of_gyration=0.3)
    A = 0.34 / G
    least = np.sqrt(4 * A * 0.5)
    for H in (2.0, 1.01 * least):
        asleep = rc.modes(rigged(chain, inverted=True, momentum=H))
        assert np.sort(asleep.angular_speed) == pytest.approx(np.sort(np.roots([A, H, 0.5])), rel=1e-12)
        assert len(asleep.other) == 0
    for H in (0.1, 0.99 * least):
        falls = rc.modes(rigged(chain, inverted=True, momentum=H))
        assert len(falls) == 0 and len(falls.other) == 2
        assert falls.other.growth_rate == pytest.approx(abs(speeds(falls.system).imag.max()), rel=1e-13)
        assert np.all(falls.other.error_bound < 1e-14) and falls.complete


def test_standing_and_floats_have_others() -> None:
    stick = rc.modes(rigged(rc.Chain(weight=[1.0, 3.0], length=1.0), inverted=[True, False]))
    assert stick.conical_height == pytest.approx([np.sqrt(0.75)], rel=1e-15)
    assert stick.other.conical_height == pytest.approx([-np.sqrt(0.75)], rel=1e-15)
    assert stick.other.growth_rate == pytest.approx([np.sqrt(G / np.sqrt(0.75))], rel=1e-15)
    buoy = rc.modes(rigged(rc.Chain(weight=[1.0, 4.0], length=1.0), displaced=[2.0, 0.0], fluid="turning"))
    assert len(buoy) == 0 and buoy.angular_speed.size == 0
    assert buoy.other.conical_height == pytest.approx([1 + 1j / np.sqrt(3), 1 - 1j / np.sqrt(3)], rel=4e-16)


def test_nothing_on_it_is_the_chain_itself() -> None:
    chain = rc.Chain.uniform_rods(30, length=2.0)
    plain, same = rc.modes(chain, "all"), rc.modes(rc.Rig(chain), "all")
    assert np.array_equal(plain.conical_height, same.conical_height)
    assert np.array_equal(plain.angular_speed, same.angular_speed)
    assert same.method == "modes" and list(same.direction) == [1] * 30 and not same.has_momentum


def test_what_was_asked() -> None:
    rig = rigged(rc.Chain.uniform_rods(30, length=2.0), momentum=0.001)
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
    m = rc.modes(rigged(chain, momentum=[0.0, -0.5]))
    assert list(m.slack_link) == [1] and list(m.slack_speed) == [2.0]


def test_picture() -> None:
    pytest.importorskip("matplotlib")
    rig = rigged(rc.Chain.uniform_rods(6, length=2.0), momentum=0.1, inverted=[True] * 2 + [False] * 4)
    ax = rc.modes(rig).plot(modes=[1, 2])
    labels = [label.get_text() for label in ax.get_xticklabels()]
    assert len(labels) == 5 and labels[0] == "at rest"
    assert labels[1].startswith("mode 1 backward\n-0.") and labels[2].startswith("mode 1 forward\n")
    ax.figure.savefig("/dev/null", format="png")
