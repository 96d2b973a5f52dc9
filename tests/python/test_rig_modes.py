# SPDX-License-Identifier: GPL-3.0-or-later
"""Whirl speeds of rigs (supports, flywheels, floats, standing links), against references that share no code with the
library: a matrix pencil of small offsets in mpmath (rigs.py), full motions. Closed forms, long rigs and links without
weight in their fluid: tests/cpp/rig_modes*.cpp."""

import itertools
import math
import pickle

import mpmath as mp
import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from rigs import G, Motion, agree, agree_with_others, pencil, random_chain, real_speeds, rigged

import revchain as rc

EPS = 2.0**-52


# ---- supports


@pytest.mark.parametrize("seed", range(6))
def test_spring_and_carriage_against_a_dense_pencil(seed):
    rng = np.random.default_rng(seed)
    chain = random_chain(rng, int(rng.integers(1, 7)), plummets=seed % 2 == 0)
    stiffness, carriage = float(np.exp(rng.uniform(-3, 6))), float(seed % 3) * float(rng.uniform(0.1, 3))
    rig = rigged(chain, stiffness=stiffness, carriage=carriage)
    agree(rig, rc.modes(rig))


@pytest.mark.parametrize(("ratio", "softest"), [(1e-12, 1e-12), (1.0, 1e-12), (1e12, 1e-6)])
def test_spring_stiffer_and_softer_than_anything(ratio, softest):
    chain = rc.Chain(weight=[1, ratio, 2], length=[0.5, 1, 0.3], centroid=[0.2, 0.4, 0.15], radius_of_gyration=0.1)
    for stiffness, carriage in itertools.product([softest, 1.0, 1e12], [0.0, 1e-9, 1e9]):
        rig = rigged(chain, stiffness=stiffness, carriage=carriage)
        agree(rig, rc.modes(rig), digits=100)
    for stiffness in (1e-3, 1e-9, 1e-12):
        rig = rigged(chain, stiffness=stiffness)
        found = rc.modes(rig)
        want = [n for n in real_speeds(rig, digits=120) if n > 0]
        for n, bound, exact in zip(found.angular_speed, found.speed_error_bound, want, strict=True):
            assert abs(n - exact) <= bound * exact
    agree(rig, found, digits=120)
    single = rc.modes(rigged(rc.Chain(weight=1e-300, length=1e-150), stiffness=1e-200))
    assert single.complete and single.conical_height == pytest.approx([1e-100], rel=1e-12)


def test_spring_tends_to_a_firm_support_and_a_firm_support_is_the_chain_itself():
    chain = random_chain(np.random.default_rng(1), 8)
    firm = rc.modes(chain)
    for stiffness in (1e4, 1e6, 1e8):
        soft = rc.modes(rigged(chain, stiffness=stiffness), count=8).conical_height[:8]
        assert np.all(soft >= firm.conical_height)
        assert np.abs(soft / firm.conical_height - 1).max() < 1e4 / stiffness
    for same in (rc.modes(rc.Rig(chain)), rc.modes(rigged(chain, stiffness=math.inf))):
        assert np.array_equal(same.conical_height, firm.conical_height)
        assert np.array_equal(same.angular_speed, firm.angular_speed)
        assert same.method == "modes" and list(same.direction) == [1] * 8 and not same.has_momentum


# ---- flywheels


def test_wheels_turned_by_a_motor_feel_less_inertia():
    # spin relative to the link that turns with the whole: A - C; free of a motor: absolute spin
    chain = rc.Chain(weight=5.0, length=[0.5], centroid=0.3, radius_of_gyration=0.2)
    c = 2.0 * 0.25**2
    for driven in (True, False):
        wheels = rc.Flywheel(weight=2.0, radius_of_gyration=0.25, spin=60.0, driven=driven)
        want = np.roots([(5.0 * (0.3**2 + 0.2**2) - driven * c) / G, -c * 60 / G, -5.0 * 0.3])
        found = rc.modes(rc.Rig(chain, flywheels=wheels)).angular_speed
        assert np.sort(found) == pytest.approx(np.sort(want), rel=1e-13)


@pytest.mark.parametrize("seed", range(8))
def test_flywheels_against_a_dense_quadratic_pencil(seed):
    rng = np.random.default_rng(100 + seed)
    size = int(rng.integers(1, 7))
    chain = random_chain(rng, size)
    strength = [0.0, 1e-6, 1.0, 1.0, 30.0, 1e4, 1.0, 1e8][seed]
    momentum = rng.normal(size=size) * strength * (rng.random(size) < 0.8)
    momentum[0] += strength
    support = dict(stiffness=10.0, carriage=0.5) if seed % 2 else {}
    rig = rigged(chain, momentum=momentum, **support)
    found = rc.modes(rig)
    agree(rig, found, digits=90)
    assert found.complete
    if strength:
        count = size + (seed % 2)
        assert found.available == (count, count)
        for sense in (1, -1):
            assert found.number[found.direction == sense].tolist() == list(range(1, count + 1))
        mirrored = rc.modes(rigged(chain, momentum=-momentum, **support))
        assert np.array_equal(found.angular_speed, -mirrored.angular_speed)
        assert np.array_equal(found.direction, -mirrored.direction)


RANGES = [(1e-3, 1e3), (0.05, 5), (0.05, 1.5), (0.02, 1.0), (-50, 50)]


@given(data=st.lists(st.tuples(*itertools.starmap(st.floats, RANGES)), min_size=1, max_size=4))
@example(data=[(2.0, 4.0, 1.125, 1.0, 4.5e-16)])  # both senses at one height, speeds an ulp apart
@settings(max_examples=40)
def test_flywheels_of_any_kind(data):
    w, a, h, rho, p = (np.array(x) for x in zip(*data, strict=True))
    rig = rigged(rc.Chain(weight=w, length=a, centroid=h * a, radius_of_gyration=rho * a), momentum=p)
    agree(rig, rc.modes(rig), digits=90)


@pytest.mark.parametrize(("size", "stiffness"), [(5, 15), (12, np.inf), (12, 30), (200, np.inf)])
def test_shapes_and_nodes_of_a_chain_of_wheels(size, stiffness):
    """Forces at every pin balance, of each shape; each node is where its offset is 0."""
    rng = np.random.default_rng(71)
    weight, length, gyration = (rng.uniform(low, high, size) for low, high in ((0.5, 2), (0.5, 2), (0.2, 0.5)))
    chain = rc.Chain(weight=weight, length=length, centroid=0.4, radius_of_gyration=gyration)
    momentum = rng.normal(0, 1, size)
    if size == 200:
        chain = rc.Chain(weight=weight, length=0.01, centroid=0.005, radius_of_gyration=0.006)
        momentum *= 0.02
    rig = rigged(chain, momentum=momentum, stiffness=stiffness, carriage=0.5 * np.isfinite(stiffness))
    m = rc.modes(rig, "all")
    K, S, M = (np.array(matrix) for matrix in pencil(rig, float))
    assert m.shape.shape == (2 * len(K), size + 1) and np.all(np.diff(m.conical_height) <= 0)
    assert m.rpm == pytest.approx(m.angular_speed * 30 / np.pi)
    assert m.frequency * m.period == pytest.approx(m.direction)
    pins = np.append(0, np.cumsum(chain.length))
    for row, n, nodes in zip(m.shape, m.angular_speed, m.nodes, strict=True):
        last = np.flatnonzero(row[:-1] * row[1:] < 0)  # the offset changes its sign above these pins
        part = row[last] / (row[last] - row[last + 1])
        if size < 200:  # where every offset is large enough for a sign
            assert nodes == pytest.approx(pins[last] + part * chain.length[last], rel=1e-12)
        assert max(abs(row)) == 1 and row[0] > 0
        y = row[: len(K)]
        terms = np.abs(K) @ np.abs(y) + n * n / G * np.abs(M) @ np.abs(y)
        assert np.abs((K + n * S - n * n / G * M) @ y).max() <= 4e-15 * terms.max()


def test_rigs_with_coordinates_without_inertia_have_every_finite_speed():
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
        stiffness = 10 ** rng.uniform(0, 2.5) if rng.random() < 0.7 else np.inf
        rig = rigged(
            chain,
            stiffness=stiffness,
            carriage=0.5 if rng.random() < 0.3 and np.isfinite(stiffness) else 0,
            momentum=np.where(rng.random(n) < 0.4, rng.normal(0, 1, n), 0),
            inverted=rng.random(n) < 0.25,
        )
        m = rc.modes(rig)
        with mp.workdps(300):
            K, S, M = (mp.matrix(X) for X in pencil(rig))
            huge = mp.mpf(10) ** 60
            sizes = [mp.log(abs(mp.det(K + x * S - x * x * M / mp.mpf(G)))) for x in (huge, 2 * huge)]
            degree = round(float((sizes[1] - sizes[0]) / mp.log(2))) // (1 if m.has_momentum else 2)
        neutral = sum(1 for height in m.other.conical_height if np.isinf(height))
        assert m.complete and m.status == "success", rig
        assert len(m) + len(m.other) - neutral == degree, rig
        assert np.all(np.isfinite(m.angular_speed))
        methods.add(m.method)
    assert methods >= {"counts", "discs"}


def test_sleeping_top():
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
        assert falls.other.growth_rate == pytest.approx(abs(np.roots([A, H, 0.5]).imag), rel=1e-13)
        assert np.all(falls.other.error_bound < 1e-14) and falls.complete


def test_slack_links_are_named_with_the_speed():
    # kappa + n H = 0 at n = -kappa / H
    chain = rc.Chain(weight=[1.0, 2.0], length=[0.5, 0.4])
    found = rc.modes(rigged(chain, momentum=[0.2, 0.0]))
    assert found.slack_link.tolist() == [0]
    assert found.slack_speed == pytest.approx([-0.5 / 0.2], rel=4 * EPS, abs=0)
    upper = rc.Chain(weight=[1.0, 2.0], length=[1.0, 0.5], centroid=[0.5, 0.25], radius_of_gyration=0.2)
    found = rc.modes(rigged(upper, momentum=[0.0, -0.5]))
    assert list(found.slack_link) == [1] and list(found.slack_speed) == [2.0]
    # exactly there, in powers of two: 0.5 - 2 * 0.25
    none = rigged(chain, momentum=[0.25, 0.0])
    with pytest.raises(ValueError, match=r"links\[0\]: the effective tension .* must not vanish"):
        rc.steady_shapes(none, angular_speed=2.0, gravity=4.0, direction=-1)
    assert len(rc.modes(rc.Rig(chain)).slack_link) == 0
    assert rc.modes(none, gravity=4.0).slack_speed.tolist() == [-2.0]
    fine = rc.modes(rigged(chain, momentum=[1e-6, 0.0]))
    assert len(fine.slack_link) == int(0.5 / 1e-6 < -fine.angular_speed.min())


# ---- weight that is not mass


def test_cork_on_a_thread_does_not_stay_below():
    # displaces five times its weight: hanging it is unstable, and grows as it falls (upwards) from there
    rig = rigged(rc.Chain(weight=1.0, length=0.8), displaced=5.0, added=2.5)
    found = rc.modes(rig)
    assert len(found) == len(found.angular_speed) == 0
    height = 0.8 * (1 + 2.5) / (1 - 5.0)
    assert found.other.conical_height == pytest.approx([height], rel=4 * EPS, abs=0)
    rate = math.sqrt(G / -height)
    assert found.other.growth_rate == pytest.approx([rate], rel=4 * EPS, abs=0)
    end = Motion(rig, 1.0).after(1.0, [1e-6], 0.0, tolerance=1e-11)  # and so it does, in the full motion
    assert end[0, 0] == pytest.approx(1e-6 * math.cosh(rate), rel=1e-6)
    # held from below, the buoy stands
    buoy = rc.modes(rigged(rc.Chain(weight=1.0, length=0.8), displaced=5.0, added=2.5, inverted=True))
    assert buoy.conical_height == pytest.approx([-height], rel=4 * EPS, abs=0)


@pytest.mark.parametrize("seed", range(10))
def test_floats_against_a_dense_pencil(seed):
    rng = np.random.default_rng(200 + seed)
    size = int(rng.integers(1, 7))
    chain = random_chain(rng, size)
    fluid = "still" if seed % 2 == 0 else "turning"
    rig = rigged(
        chain,
        displaced=chain.weight * rng.uniform(0, 1.8, size),
        centroid=chain.length * rng.uniform(0, 1, size),
        gyration=chain.length * rng.uniform(0, 0.5, size),
        added=chain.weight * rng.uniform(0, 1, size) if fluid == "still" else 0.0,
        fluid=fluid,
        inverted=rng.random(size) < 0.3,
        stiffness=[math.inf, 12.0][seed % 3 == 0],
    )
    found = rc.modes(rig)
    agree_with_others(rig, found)
    assert fluid == "turning" or all(z.imag == 0 for z in found.other.conical_height)


# ---- standing links


@pytest.mark.parametrize("seed", range(20))
def test_as_many_speeds_as_links_hang(seed):
    """Sylvester's law of inertia: every posture of three links, random ones of up to 30."""
    rng = np.random.default_rng(300 + seed)
    size = int(rng.integers(1, 30)) if seed < 12 else 3
    inverted = rng.random(size) < 0.5 if seed < 12 else np.array([seed & 1, seed & 2, seed & 4], bool)
    rig = rigged(random_chain(rng, size), inverted=inverted)
    found = rc.modes(rig, "all")
    assert (len(found), len(found.other)) == (int((~inverted).sum()), int(inverted.sum()))
    assert np.all(found.other.conical_height.real < 0) and found.complete
    if size <= 8:
        agree_with_others(rig, found, tolerance=2.0**-50)


@pytest.mark.parametrize("sticks", [1, 2, 3, 8, 50])
def test_sticks_on_end_fall_as_they_swing(sticks):
    """Every way to fall of a column is a mode of the same chain hung up, time imaginary."""
    chain = rc.Chain.uniform_rods(sticks, length=0.9)
    found = rc.modes(rigged(chain, inverted=True), "all")
    assert len(found) == 0 and found.complete
    np.testing.assert_allclose(found.other.growth_rate, rc.modes(chain, "all").angular_speed, rtol=4e-16)


# ---- extremes, long rigs, what is asked


def test_extreme_rigs_neither_crash_nor_hang():
    for w, e, p in itertools.product([1e-12, 1e12], [1e-12, 1e12, math.inf], [0.0, 1e-12, 1e12]):
        rig = rigged(rc.Chain(weight=[w, 1.0], length=[1.0, 1e-6]), stiffness=e, momentum=[p, -p])
        found = rc.modes(rig)
        assert np.all(np.isfinite(found.angular_speed))
        if found.status == "success":
            want = real_speeds(rig, digits=150)
            for n, bound in zip(found.angular_speed, found.error_bound, strict=True):
                assert min(abs(x - n) / abs(x) for x in want) <= max(bound, 4 * EPS)
        if p == 0:
            rc.steady_shapes(rig, conical_height=0.37, budget=20000)


def test_long_rigs():
    rng = np.random.default_rng(900)
    chain = rc.Chain.uniform_rods(10000, length=0.36)
    afloat = rc.modes(rigged(chain, displaced=chain.weight * rng.uniform(0, 0.9, 10000)), count=2)
    assert afloat.complete
    assert np.all(afloat.error_bound < 1e-14)
    # a uniform fluid of density r to the links' one: K times 1 - r
    thinned = rc.modes(rigged(chain, displaced=chain.weight * 0.25), count=3)
    assert thinned.conical_height[:3] == pytest.approx(rc.modes(chain, count=3).conical_height / 0.75, rel=1e-13)
    slow = rc.modes(rigged(chain, stiffness=10.0, carriage=0.3), count=3)
    assert slow.available == (10001, 0)


def test_what_was_asked():
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
    wrong = [{"count": count} for count in (0, -1, "every")] + [{"first": 0}, {"gravity": 0.0}]
    for given_ in wrong:  # what is for a chain alone: test_wrong_arguments.py
        with pytest.raises(ValueError, match=rf"revchain.*modes: .*{next(iter(given_))}"):
            rc.modes(rig, **given_)
    with pytest.raises(ValueError, match="not both"):
        rc.modes(rig, 2, conical_height=(0.1, 0.2))
    window = rc.modes(rig, angular_speed=(6.0, 20.0), certify=True, rtol=1e-9)
    inside = (abs(all_of_them.angular_speed) >= 6.0) & (abs(all_of_them.angular_speed) < 20.0)
    np.testing.assert_allclose(window.angular_speed, all_of_them.angular_speed[inside], rtol=EPS)
    assert np.array_equal(window.number, all_of_them.number[inside]) and window.rtol == 1e-9
    proof = window.certificate
    assert np.all((proof.lower < window.conical_height) & (window.conical_height < proof.upper))
    assert np.array_equal(proof.above_lower, window.number) and np.array_equal(proof.above_upper, window.number - 1)
    again = pickle.loads(pickle.dumps(window))
    assert again == window and np.array_equal(again.shape, window.shape)
    assert len(rc.modes(rig, angular_speed=(0.0, 1e-3))) == 0


@pytest.mark.parametrize("gravity", [G, 1.62])
def test_counts_below_a_speed(gravity):
    rng = np.random.default_rng(411)
    chain = random_chain(rng, 9)
    inverted = rng.random(9) < 0.4
    for rig in (
        rigged(chain, stiffness=3.0),
        rigged(chain, inverted=inverted),
        rigged(chain, momentum=0.2),
        rigged(chain, momentum=0.2, inverted=inverted),
        rigged(chain, displaced=chain.weight * rng.uniform(0, 1.8, 9), fluid="turning"),
        rc.Rig(chain),
    ):
        every = rc.modes(rig, "all", gravity=gravity)
        speeds = rng.uniform(0.5, 90, (3, 4))
        for way in (1, -1):
            sense = every.angular_speed[every.direction == (way if every.has_momentum else 1)]
            count = rc.count_modes(rig, angular_speed=way * speeds, gravity=gravity)
            assert count.shape == speeds.shape and count.dtype == np.int64
            assert np.array_equal(count, (abs(sense)[:, None, None] < speeds).sum(axis=0))
        heights = gravity / speeds**2
        count = rc.count_modes(rig, conical_height=heights, gravity=gravity)
        assert np.array_equal(count, (every.conical_height[:, None, None] > heights).sum(axis=0))
    with pytest.raises(ValueError, match="angular speed must be finite and not 0, got 0"):
        rc.count_modes(rig, angular_speed=[1.0, 0.0])


def test_other_solutions_are_found_when_they_are_read():
    rng = np.random.default_rng(412)
    long = rigged(rc.Chain.uniform_rods(10000), inverted=rng.random(10000) < 0.4)
    few = rc.modes(long, 3)
    assert few.complete and few.other_available == long.inverted.sum() and "solutions are not steady" in repr(few)
    assert "other" not in few.__dict__
    short = rigged(rc.Chain.uniform_rods(20), inverted=rng.random(20) < 0.4)
    few = rc.modes(short, 3)
    assert len(few.other) == few.other_available == short.inverted.sum()
    assert few.other == rc.modes(short, "all").other == pickle.loads(pickle.dumps(few)).other


def test_picture():
    pytest.importorskip("matplotlib")
    rig = rigged(rc.Chain.uniform_rods(6, length=2.0), momentum=0.1, inverted=[True] * 2 + [False] * 4)
    ax = rc.modes(rig).plot(modes=[1, 2])
    labels = [label.get_text() for label in ax.get_xticklabels()]
    assert len(labels) == 5 and labels[0].strip() == "at rest"
    assert labels[1].startswith("mode 1\nbackward\n−2.657 rpm") and labels[2].startswith("mode 1\nforward\n")
    ax.figure.savefig("/dev/null", format="png")


def test_counts_at_speeds_next_to_nothing():
    rig = rc.Rig(rc.Chain(weight=[1.0, 2.0], length=1.0), support=rc.Support(stiffness=3.0))
    assert rc.count_modes(rig, angular_speed=1e-200) == 0
    assert len(rc.modes(rig, angular_speed=(1e-200, 3.0))) == 1


@pytest.mark.parametrize("rtol", [-1.0, math.nan])
def test_no_tolerance_of_a_damped_rig_is_negative(rtol):
    with pytest.raises(ValueError, match="rtol must not be negative or NaN"):
        rc.modes(rc.Rig(rc.Chain(mass=[1.0] * 3, length=1.0), drag=0.1), rtol=rtol)


def test_a_list_without_a_mode_is_not_complete():
    """Masses that double words cannot hold together: no exponent is found, and the result says so."""
    found = rc.modes(rc.Rig(rc.Chain(mass=[1e-60, 1.0], length=1.0), pins=rc.Pin(damping=0.01)))
    assert len(found) > 0 or not found.complete
