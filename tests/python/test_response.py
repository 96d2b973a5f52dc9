# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain whose support is carried round, and a chain swinging, against linear algebra in 50 digits."""

import math
import pickle

import mpmath as mp
import numpy as np
import pytest

import revchain as rc


def matrices(chain):
    """K and M of all pins, support last, from the two energies: sums of weights times squares."""
    n = chain.size
    K, M, below = mp.zeros(n + 1), mp.zeros(n + 1), mp.mpf(0)
    for m in range(n):
        W, a, h, r = (
            mp.mpf(float(x[m])) for x in (chain.weight, chain.length, chain.centroid, chain.radius_of_gyration)
        )
        stiffness = (W * h + a * below) / a**2
        below += W
        for i, p in ((m, h / a), (m + 1, 1 - h / a)):
            for j, q in ((m, h / a), (m + 1, 1 - h / a)):
                sign = 1 if i == j else -1
                K[i, j] += sign * stiffness
                M[i, j] += W * (p * q + sign * r**2 / a**2)
    return K, M


def exact_response(chain, height, radius=1.0):
    K, M = matrices(chain)
    A = mp.mpf(height) * K - M
    n = chain.size
    y = mp.lu_solve(A[:n, :n], -A[:n, n] * radius)
    return [*y, mp.mpf(radius)], -sum(A[n, j] * x for j, x in enumerate([*y, radius])) / height


@pytest.fixture
def chain():
    return rc.Chain(
        weight=[1.0, 2.5, 0.7, 3.0, 1.0],
        length=[0.5, 1.0, 0.8, 0.6, 1.1],
        centroid=[0.4, 0.2, 0.5, 0.6, 0.5],
        radius_of_gyration=[0.25, 0.5, 0.125, 0.0, 0.5],
    )


def test_exact(chain):
    heights = np.geomspace(0.02, 20, 40).reshape(8, 5)
    found = rc.response(chain, conical_height=heights, support_radius=0.25)
    assert found.offset.shape == (8, 5, 6) and found.error_bound.shape == (8, 5)
    below = rc.count_modes(chain, conical_height=heights)
    assert np.array_equal(found.modes_below, below)
    with mp.workdps(50):
        for place in np.ndindex(heights.shape):
            exact, force = exact_response(chain, float(heights[place]), 0.25)
            largest = max(abs(y) for y in exact)
            worst = max(abs(mp.mpf(float(x)) - y) for x, y in zip(found.offset[place], exact, strict=True))
            # the radius of gyration is what the chain gives back, rounded: 4 ulp of the largest allowed for that
            assert worst <= (found.error_bound[place] + 200 * 2.0**-52) * largest
            assert bool(found.reversed[place]) == (exact[0] < 0)
            assert abs(found.support_force[place] / float(force) - 1) < 1e-12


def test_plummets_to_the_bound():
    chain = rc.Chain(weight=[1.0, 3.0, 0.1], length=[0.3, 1.0, 0.5])
    heights = np.geomspace(0.01, 10, 50)
    found = rc.response(chain, conical_height=heights)
    assert found.error_bound.max() < 1.2e-16
    with mp.workdps(50):
        for i, height in enumerate(heights):
            exact, _ = exact_response(chain, float(height))
            largest = max(abs(y) for y in exact)
            assert max(abs(mp.mpf(float(x)) - y) for x, y in zip(found.offset[i], exact, strict=True)) <= (
                found.error_bound[i] * largest
            )


def test_speeds_and_heights(chain):
    speed = np.array([1.0, 4.0, 9.0])
    one = rc.response(chain, angular_speed=speed, gravity=2.0)
    two = rc.response(chain, conical_height=2.0 / speed**2)
    np.testing.assert_allclose(one.offset, two.offset, rtol=1e-12)
    np.testing.assert_allclose(two.angular_speed, speed * math.sqrt(9.80665 / 2.0))
    np.testing.assert_allclose(one.conical_height, two.conical_height)
    assert np.array_equal((one.offset / 1.0), one.amplification)


def test_pins(chain):
    whole = rc.response(chain, conical_height=[3.0, 0.2])
    assert np.array_equal(rc.response(chain, conical_height=[3.0, 0.2], pins=0).offset, whole.offset[:, 0])
    some = rc.response(chain, conical_height=[3.0, 0.2], pins=[-1, 2])
    np.testing.assert_allclose(some.offset, whole.offset[:, [5, 2]], rtol=3e-16)
    assert some.pins.tolist() == [5, 2]
    assert rc.response(chain, conical_height=3.0).offset.shape == (6,)
    assert rc.response(chain, conical_height=[]).offset.shape == (0, 6)
    assert rc.response(chain, conical_height=3.0, pins=[]).offset.shape == (0,)


def test_resonance():
    chain = rc.Chain(weight=[1.0, 3.0], length=1.0)
    found = rc.response(chain, conical_height=[1.5, 1.0, 0.5])
    assert found.resonant.tolist() == [True, False, True]
    assert np.isinf(found.error_bound[[0, 2]]).all() and np.isnan(found.offset[[0, 2], :2]).all()
    assert found.offset[1].tolist() == [-4.0, 0.0, 1.0]
    assert found.modes_below.tolist() == [0, 1, 1]
    assert repr(found).startswith("support carried round a circle of ") and repr(found).count("nan") >= 2


def test_rig(chain):
    assert np.array_equal(
        rc.response(rc.Rig(chain), conical_height=[3.0, 0.2]).offset,
        rc.response(chain, conical_height=[3.0, 0.2]).offset,
    )
    carousel = rc.Rig(chain, support_radius=0.4)
    assert rc.response(carousel, conical_height=9.0).offset[-1] == 0.4
    assert rc.response(carousel, conical_height=9.0, support_radius=0.2).offset[-1] == 0.2
    sprung = rc.response(rc.Rig(chain, stiffness=50.0), conical_height=9.0)
    assert sprung.offset[-1] > 1
    # the spring gives way by the pull
    assert sprung.offset[-1] - 1 == pytest.approx(float(sprung.support_force) / 50.0, rel=1e-12)
    wheels = rc.Rig(chain, momentum=0.4)
    there, back = rc.response(wheels, angular_speed=[3.0, -3.0]).offset
    assert abs(there[0] - back[0]) > 1e-3
    mirrored = rc.response(rc.Rig(chain, momentum=-0.4), angular_speed=-3.0).offset
    np.testing.assert_allclose(mirrored, there, rtol=1e-14)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "give either conical_height or angular_speed"),
        ({"conical_height": 1.0, "angular_speed": 1.0}, "give either"),
        ({"conical_height": [1.0, -2.0]}, "conical_height must be positive and finite, got -2"),
        ({"angular_speed": 0.0}, "angular_speed must be positive"),
        ({"angular_speed": -1.0}, "angular_speed must be positive"),
        ({"conical_height": "1"}, "conical_height must be a real number"),
        ({"conical_height": 1e200}, "must not be that far from the chain's own"),
        ({"angular_speed": 1e-200}, "must not be that far from the chain's own"),
        ({"angular_speed": 1e200}, "must not be that far from the chain's own"),
        ({"conical_height": 1.0, "support_radius": 0.0}, "support_radius must be positive"),
        ({"conical_height": 1.0, "gravity": -1.0}, "gravity must be positive"),
        ({"conical_height": 1.0, "pins": [6]}, "pins must be numbers from 0 to 5, got 6"),
        ({"conical_height": 1.0, "pins": -7}, "pins must be numbers from 0 to 5, got -7"),
        ({"conical_height": 1.0, "pins": 0.5}, "pins must be whole numbers"),
        ({"conical_height": 1.0, "pins": [[1]]}, "pins must be one number or a list"),
    ],
)
def test_wrong_response(chain, given, message):
    with pytest.raises(ValueError, match=r"revchain(\.|::)response: .*" + message.replace("[", r"\[")):
        rc.response(chain, **given)


def test_not_a_chain():
    with pytest.raises(TypeError, match=r"chain must be a revchain.Chain or a revchain.Rig, got 3"):
        rc.response(3, conical_height=1.0)
    with pytest.raises(TypeError, match="small_oscillation: chain must be a revchain.Chain"):
        rc.small_oscillation(None, [1.0], None, 0.0)


def test_records(chain):
    found = rc.response(chain, conical_height=[3.0, 0.2])
    assert pickle.loads(pickle.dumps(found)) == found
    assert found != rc.response(chain, conical_height=[3.0, 0.3])
    swing = rc.small_oscillation(chain, [0.1] * 5, None, [0.0, 1.0])
    assert pickle.loads(pickle.dumps(swing)) == swing and swing != found
    for array in (found.offset, swing.offset):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1.0


def exact_swing(chain, offsets, velocities, t):
    """cos and sin of the square root of g M^-1 K, by its eigenvectors in 50 digits."""
    K, M = matrices(chain)
    n = chain.size
    L = mp.cholesky(M[:n, :n])
    inverse = L**-1
    values, Q = mp.eigsy(inverse * K[:n, :n] * inverse.T * mp.mpf(9.80665))
    T = inverse.T * Q
    y, v = T**-1 * mp.matrix(offsets), T**-1 * mp.matrix(velocities)
    w = [mp.sqrt(x) for x in values]
    return T * mp.matrix([y[k] * mp.cos(w[k] * t) + v[k] / w[k] * mp.sin(w[k] * t) for k in range(n)])


@pytest.mark.parametrize("size", [1, 2, 4, 6])
def test_swing(size):
    generator = np.random.default_rng(size)
    chain = rc.Chain(weight=generator.uniform(0.5, 2, size), length=generator.uniform(0.5, 2, size))
    offsets, velocities = generator.uniform(-0.1, 0.1, (2, size))
    time = np.array([0.0, 0.7, -3.0, 1e5, 1e10])
    found = rc.small_oscillation(chain, offsets, velocities, time)
    assert not found.projected and found.truncation_error.max() < 1e-28
    with mp.workdps(50):
        for i, t in enumerate(time):
            exact = exact_swing(chain, offsets.tolist(), velocities.tolist(), mp.mpf(float(t)))
            for m in range(size):
                assert (
                    abs(mp.mpf(float(found.offset[i, m])) - exact[m])
                    <= found.error_bound[i] + found.truncation_error[m]
                )
    assert found.error_bound.max() < 1e-14
    np.testing.assert_allclose(found.offset[0], [*offsets, 0.0], atol=3e-16)
    np.testing.assert_allclose(found.velocity[0], [*velocities, 0.0], atol=3e-15)
    np.testing.assert_allclose(found.angular_frequency, rc.modes(chain).angular_speed, rtol=1e-15)


def test_energy(chain):
    start = np.array([0.1, 0.05, -0.02, 0.03, 0.0, 0.0])
    swing = rc.small_oscillation(chain, start, -3 * start, np.linspace(0, 10, 7))
    stretch = np.diff(swing.offset, axis=1)
    below = np.concatenate([[0.0], np.cumsum(chain.weight)[:-1]])
    stiffness = (chain.weight * chain.centroid / chain.length + below) / chain.length
    centre = swing.velocity[:, :-1] * chain.centroid / chain.length + swing.velocity[:, 1:] * (
        1 - chain.centroid / chain.length
    )
    turning = np.diff(swing.velocity, axis=1) / chain.length * chain.radius_of_gyration
    energy = ((stiffness * stretch**2).sum(1) + (chain.weight * (centre**2 + turning**2)).sum(1) / 9.80665) / 2
    np.testing.assert_allclose(energy, swing.energy.sum(), rtol=1e-13)
    assert swing.energy_left_out < 1e-25


def test_modes_kept(chain):
    start = [0.1, 0.05, -0.02, 0.03, 0.0]
    time = np.linspace(0, 10, 50)
    whole = rc.small_oscillation(chain, start, None, time)
    for kept in range(6):
        some = rc.small_oscillation(chain, start, None, time, modes=kept)
        assert some.energy.size == kept
        off = np.abs(some.offset - whole.offset)
        assert (off <= some.truncation_error + 1e-14).all()
        assert some.energy_left_out == pytest.approx(whole.energy[kept:].sum(), rel=1e-9, abs=1e-25)


def test_massless_pin():
    chain = rc.Chain(weight=[2.0, 0.0], length=1.0)
    swing = rc.small_oscillation(chain, [0.02, 0.5], None, 0.0)
    assert swing.projected and swing.start.tolist() == [0.02, 0.01, 0.0]
    assert not rc.small_oscillation(chain, [0.02, 0.01], None, 0.0).projected
    assert repr(swing).startswith("1 modes; of the energy 100 % in mode 1")


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (([0.1], None, 0.0), "offsets must have shape"),
        (([[0.1] * 5], None, 0.0), "offsets must have shape"),
        (([0.1] * 6, None, 0.0), "offsets of the support must be 0, got 0.1"),
        (([0.1] * 5, [math.nan] * 5, 0.0), "velocities must be finite, got nan"),
        (([0.1] * 5, None, math.inf), "t must be finite"),
        (([0.1] * 5, None, [[0.0]]), "t must be a number or have one axis"),
    ],
)
def test_wrong_swing(chain, given, message):
    with pytest.raises(ValueError, match=r"small_oscillation: .*" + message):
        rc.small_oscillation(chain, *given)


@pytest.mark.parametrize("modes", [-1, 6, 2**70, 1.5])
def test_wrong_modes(chain, modes):
    with pytest.raises(ValueError, match="small_oscillation: modes must be"):
        rc.small_oscillation(chain, [0.1] * 5, None, 0.0, modes=modes)


@pytest.mark.parametrize("rigged", [False, True])
def test_a_response_at_one_speed_is_drawn_as_a_shape(chain, rigged):
    pytest.importorskip("matplotlib")
    hung = rc.Rig(chain, standing=True) if rigged else chain
    found = rc.response(hung, conical_height=1.9, support_radius=0.1)
    ax = found.plot()
    x, y = ax.get_lines()[1].get_data()
    assert np.array_equal(x, found.offset) and y[-1] == 0 and y[0] == pytest.approx(chain.length.sum())
    assert ax.get_ylabel() == f"{'height above' if rigged else 'depth below'} the support (m)"
    x, y = found.plot(pins=[2]).get_lines()[1].get_data()
    assert np.flatnonzero(~np.isnan(x)).tolist() == [2] and x[2] == found.offset[2]
    with pytest.raises(ValueError, match="pins must be among"):
        found.plot(pins=[9])


def test_plots(chain):
    pytest.importorskip("matplotlib")
    found = rc.response(chain, angular_speed=np.linspace(0.5, 12, 300))
    ax = found.plot(pins=[0, 3])
    marked = [line for line in ax.get_lines() if line.get_linestyle() == "-."]
    assert len(marked) == int(found.modes_below[-1])
    assert ax.get_yscale() == "log"
    rc.response(rc.Rig(chain, momentum=1.0), angular_speed=[-2.0, 1.0, 2.0]).plot()
    rc.response(chain, conical_height=[1.5, 2.0], pins=2).plot()
    with pytest.raises(ValueError, match="pins must be among"):
        found.plot(pins=[9])
    with pytest.raises(ValueError, match="no speed to draw"):
        rc.response(chain, conical_height=[]).plot()
    swing = rc.small_oscillation(chain, [0.1] * 5, None, np.linspace(0, 2, 9))
    assert len(swing.plot().get_legend().get_texts()) == 9
    assert swing.plot(kind="time", pins=[0, 4]).get_ylabel() == "from the axis (m)"
    with pytest.raises(ValueError, match="kind must be"):
        swing.plot(kind="x")
    with pytest.raises(ValueError, match="pins must be numbers"):
        swing.plot(kind="time", pins=[7])
