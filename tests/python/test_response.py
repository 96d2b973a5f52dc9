# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain whose support is carried round, and a chain swinging, against linear algebra in 50 digits."""

import math

import mpmath as mp
import numpy as np
import pytest
import scipy.special
from rigs import G, Motion, pencil, random_chain, rigged

import revchain as rc

ULP = 2.0**-52


@pytest.fixture
def chain():
    return rc.Chain(
        weight=[1.0, 2.5, 0.7, 3.0, 1.0],
        length=[0.5, 1.0, 0.8, 0.6, 1.1],
        centroid=[0.4, 0.2, 0.5, 0.6, 0.5],
        radius_of_gyration=[0.25, 0.5, 0.125, 0.0, 0.5],
    )


@pytest.mark.parametrize("seed", range(8))
def test_every_offset_against_a_dense_solution(chain, seed):
    """In 50 digits; rigs: test_proved_bounds.py. A radius of gyration is what the chain gives back, rounded."""
    rng = np.random.default_rng(70 + seed)
    radius, speeds = 0.25, np.exp(rng.uniform(-1, 3, (2, 3)))
    if seed < 6:
        chain = random_chain(rng, int(rng.integers(1, 9)))
    elif seed == 6:
        speeds = np.sqrt(G / np.geomspace(0.02, 20, 40).reshape(8, 5))
    else:
        chain, radius = rc.Chain(weight=[1.0, 3.0, 0.1], length=[0.3, 1.0, 0.5]), 1.0
        speeds = np.sqrt(G / np.geomspace(0.01, 10, 50).reshape(10, 5))
    found, size = rc.response(chain, angular_speed=speeds, support_radius=radius), chain.size
    assert found.offset.shape == (*speeds.shape, size + 1) and found.error_bound.shape == speeds.shape
    assert found.error_bound.max() < 1.2e-16
    assert np.array_equal(found.modes_below, rc.count_modes(chain, angular_speed=speeds))
    with mp.workdps(50):
        stiff, _, mass = (mp.matrix(x) for x in pencil(rc.Rig(chain), whole=True))
        for place in np.ndindex(speeds.shape):
            big = stiff - mp.mpf(float(speeds[place])) ** 2 * mass / mp.mpf(G)
            y = mp.matrix([*mp.lu_solve(big[:size, :size], -mp.mpf(radius) * big[:size, size]), mp.mpf(radius)])
            force = -(big[size, :] * y)[0]
            assert abs(found.support_force[place] - force) <= found.support_force_error[place]
            assert found.support_force_error[place] <= 1e-12 * max(abs(force), 1)
            worst = max(abs(mp.mpf(float(x)) - exact) for x, exact in zip(found.offset[place], y, strict=True))
            assert worst <= 1.01 * ULP / 2 * max(abs(x) for x in y)
            assert bool(found.reversed[place]) == (y[0] < 0)


def test_tends_to_the_continuous_chains():
    """Offsets J0(2 sqrt(x / height)) / J0(2 sqrt(L / height)); off as 1/N^2, at the free end as (A + B log N)/N^2."""

    def compared(height, count):
        found = rc.response(rc.Chain.uniform_rods(count, length=0.36), conical_height=height).offset
        z = 2 * np.sqrt(np.linspace(0, 0.36, count + 1) / height)
        return found, scipy.special.j0(z) / scipy.special.j0(z[-1])

    for height in (1.08, 0.108, 0.0288):
        largest = [np.abs(np.subtract(*compared(height, count))).max() for count in (100, 200, 400)]
        assert 3.4 < largest[0] / largest[1] < 4.1
        assert 3.4 < largest[1] / largest[2] < 4.1
    links = np.array([100, 200, 400, 800])
    for turns in (0.4, 0.9, 1.5, 2.5):
        pairs = [compared(G / (2 * np.pi * turns) ** 2, count) for count in links]
        off = np.array([found[0] / want[0] - 1 for found, want in pairs])
        assert np.all(np.abs(off) < 5e-4)  # 4.2e-4: 100 links at 2.5 turns
        growth = np.diff(off * links**2)  # for each doubling B log 2
        np.testing.assert_allclose(growth, growth.mean(), rtol=0.02)  # measured 0.013


@pytest.mark.parametrize("to_and_fro", [False, True])
def test_what_the_full_motion_does_for_a_small_radius(to_and_fro):
    # carried by a ten-thousandth, round or along a line, and started on the response, the full equations stay on it
    chain = random_chain(np.random.default_rng(5), 3, spread=0.7)
    speed = 1.3 * float(rc.modes(chain).angular_speed[0])
    off = []
    for radius in (1e-3, 1e-4):
        y = rc.response(chain, angular_speed=speed, support_radius=radius).offset
        motion = Motion(rigged(chain, radius=radius), speed, to_and_fro=to_and_fro)
        lean = np.arcsin((y[:-1] - y[1:]) / chain.length)
        if to_and_fro:
            time = 2.25 * math.pi / speed
            end = motion.after(time, lean, radius)
            off.append(float(np.abs(end[:-1, 0] - np.sin(lean) * math.cos(speed * time)).max()) / radius)
        else:
            off.append(motion.run(lean, radius, turns=1) / radius)
    assert off[1] < 1e-3
    assert off[0] / off[1] == pytest.approx(100, rel=0.3)  # what is left out is of the third order


def test_sweep_of_a_long_chain_at_few_pins():
    """The same links, marched up from the free end by the balance of moments, all speeds side by side, in 80 bits, which
    takes seconds."""
    chain = rc.Chain.uniform_rods(10000, length=0.36)
    speeds = np.linspace(1.0, 60.0, 1000)
    found = rc.response(chain, angular_speed=speeds, support_radius=0.01, pins=[0, 5000])
    assert found.offset.shape == (1000, 2)
    ld = np.longdouble
    mu, a, w = speeds.astype(ld) ** 2 / ld(G), ld(0.36) / 10000, ld(1) / 10000
    y, force, below = np.ones(1000, dtype=ld), np.zeros(1000, dtype=ld), ld(0)
    for m in range(10000):
        if m == 5000:
            middle = y
        s = (a * force + mu * w * a / 2 * y) / (a * below + w * a / 2 + mu * w * a * a / 6)
        force += mu * w * (y - a * s / 2)
        below += w
        y = y - a * s
    assert np.array_equal(found.reversed, y < 0)
    near, far = np.abs(y) > 1e-3, np.abs(y) > 0.02
    assert found.offset[near, 0] == pytest.approx((ld(0.01) / y)[near].astype(float), rel=1e-13)
    assert found.offset[near, 1] == pytest.approx((ld(0.01) * middle / y)[near].astype(float), rel=1e-11, abs=1e-13)
    roots, zeros = 2 * np.sqrt(0.36 / (G / speeds**2)), scipy.special.jn_zeros(0, 40)
    assert np.array_equal(found.modes_below[far], [(zeros < z).sum() for z in roots[far]])


def test_the_joint_above_a_stick_that_swings_alone_is_still():
    """Experiment X: whatever the string, at the speed of the stick by itself; its end where the string pulls it."""
    length, centroid, gyration = 0.6, 0.25, 0.2
    own = (centroid**2 + gyration**2) / centroid
    for string in (0.1, 0.4, 3.0):
        stick = {"centroid": [centroid, 0], "radius_of_gyration": [gyration, 0]}
        chain = rc.Chain(weight=[1, 0], length=[length, string], **stick)
        end, joint, hand = rc.response(chain, conical_height=own).offset
        assert abs(joint) < 1e-15 and hand == 1
        assert end == pytest.approx(-own / string * length / centroid, rel=1e-14)


def test_speeds_and_heights(chain):
    speed = np.array([1.0, 4.0, 9.0])
    one = rc.response(chain, angular_speed=speed, gravity=2.0)
    two = rc.response(chain, conical_height=2.0 / speed**2)
    np.testing.assert_allclose(one.offset, two.offset, rtol=1e-12)
    np.testing.assert_allclose(two.angular_speed, speed * math.sqrt(G / 2.0))
    np.testing.assert_allclose(one.conical_height, two.conical_height)
    assert np.array_equal(one.offset, one.amplification)


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
    assert repr(found).startswith("support moving in a circle of radius ") and repr(found).count("nan") >= 2
    plummet = rc.Chain(weight=1.0, length=0.75)  # offset height / (height - length)
    found = rc.response(plummet, conical_height=[[0.75, 1.5], [0.375, 3.0]])
    assert found.offset.shape == (2, 2, 2) and found.resonant.tolist() == [[True, False], [False, False]]
    assert found.offset[0, 1, 0] == 2.0 and found.offset[1, 0, 0] == -1.0
    assert found.amplification[1, 1, 0] == pytest.approx(4 / 3, rel=2.0**-52, abs=0)
    single = rc.response(plummet, conical_height=0.75 * (1 + 2.0**-50))
    assert single.offset.shape == (2,) and single.modes_below.shape == ()
    assert single.offset[0] == pytest.approx(1 + 2.0**50, rel=1e-10)


def test_rig(chain):
    plain, same = (rc.response(system, conical_height=[3.0, 0.2]) for system in (chain, rc.Rig(chain)))
    assert np.array_equal(plain.offset, same.offset)
    carousel = rigged(chain, radius=0.4)
    assert rc.response(carousel, conical_height=9.0).offset[-1] == 0.4
    assert rc.response(carousel, conical_height=9.0, support_radius=0.2).offset[-1] == 0.2


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, "give either conical_height or angular_speed"),
        ({"conical_height": 1.0, "angular_speed": 1.0}, "give either"),
        ({"conical_height": [1.0, -2.0]}, "conical_height must be positive and finite, got -2"),
        *(({"angular_speed": speed}, "angular_speed must be positive") for speed in (0.0, -1.0)),
        ({"conical_height": "1"}, "conical_height must be a number"),
        ({"conical_height": 1e200}, "must not be that far from the chain's own"),
        *(({"angular_speed": speed}, "must not be that far from the chain's own") for speed in (1e-200, 1e200)),
        ({"conical_height": 1.0, "support_radius": 0.0}, "support_radius must be positive"),
        ({"conical_height": 1.0, "gravity": -1.0}, "gravity must be positive"),
        ({"conical_height": 1.0, "pins": [6]}, "pins must be numbers from 0 to 5, got 6"),
        ({"conical_height": 1.0, "pins": -7}, "pins must be numbers from 0 to 5, got -7"),
        ({"conical_height": 1.0, "pins": 0.5}, "pins must be whole numbers"),
        ({"conical_height": 1.0, "pins": [[1]]}, "pins must be one number or a list"),
    ],
)
def test_wrong_response(chain, given, message):
    with pytest.raises(ValueError, match=rf"revchain(\.|::)response: .*{message}"):
        rc.response(chain, **given)


def exact_swing(chain, offset, velocity, times):
    """Offsets and velocities: cos and sin of the square root of g M^-1 K, by its eigenvectors."""
    K, _, M = map(mp.matrix, pencil(rc.Rig(chain)))
    n = chain.size
    inverse = mp.cholesky(M) ** -1
    values, Q = mp.eigsy(inverse * K * inverse.T * mp.mpf(G))
    T = inverse.T * Q
    y, v = T**-1 * mp.matrix(offset), T**-1 * mp.matrix(velocity)
    w = [mp.sqrt(x) for x in values]
    for t in times:
        c, s = [mp.cos(x * t) for x in w], [mp.sin(x * t) for x in w]
        yield (
            T * mp.matrix([y[k] * c[k] + v[k] / w[k] * s[k] for k in range(n)]),
            T * mp.matrix([v[k] * c[k] - y[k] * w[k] * s[k] for k in range(n)]),
        )


@pytest.mark.parametrize(("size", "bodies"), [(1, False), (2, False), (4, False), (6, False), (5, True), (7, True)])
def test_swing(size, bodies):
    generator = np.random.default_rng(size)
    chain = rc.Chain(weight=generator.uniform(0.5, 2, size), length=generator.uniform(0.5, 2, size))
    if bodies:
        chain = random_chain(generator, size)
    offset, velocity = generator.uniform(-0.1, 0.1, (2, size)) * (0.1 if bodies else 1)
    time = np.array([0.0, 0.3, 0.7, -1.7, -3.0, 12.0, 1000.0, 1e5, 1e10])
    found = rc.swing(chain, time, offset=offset, velocity=velocity)
    assert not found.projected and found.truncation_error.max() < 1e-28
    with mp.workdps(60):
        for i, exact in enumerate(exact_swing(chain, offset.tolist(), velocity.tolist(), map(mp.mpf, time.tolist()))):
            for m in range(size):
                off = abs(mp.mpf(float(found.offset[i, m])) - exact[0][m])
                assert off <= found.error_bound[i] + found.truncation_error[m]
                assert abs(time[i]) > 1000 or abs(mp.mpf(float(found.velocity[i, m])) - exact[1][m]) <= 1e-13
    assert found.error_bound.max() < (1e-15 if bodies else 1e-14)
    np.testing.assert_allclose(found.offset[0], [*offset, 0.0], atol=3e-16)
    np.testing.assert_allclose(found.velocity[0], [*velocity, 0.0], atol=3e-15)
    np.testing.assert_allclose(found.angular_frequency, rc.modes(chain).angular_speed, rtol=8e-16)


def test_energy(chain):
    start = np.array([0.1, 0.05, -0.02, 0.03, 0.0, 0.0])
    swing = rc.swing(chain, np.linspace(0, 10, 7), offset=start, velocity=-3 * start)
    share = chain.centroid / chain.length
    stiffness = (chain.weight * share + np.append(0.0, np.cumsum(chain.weight)[:-1])) / chain.length
    centre = swing.velocity[:, :-1] * share + swing.velocity[:, 1:] * (1 - share)
    turning = np.diff(swing.velocity, axis=1) / chain.length * chain.radius_of_gyration
    stretch = np.diff(swing.offset, axis=1)
    energy = ((stiffness * stretch**2).sum(1) + (chain.weight * (centre**2 + turning**2)).sum(1) / G) / 2
    np.testing.assert_allclose(energy, swing.energy.sum(), rtol=1e-13)
    assert swing.energy_left_out < 1e-25


def test_modes_kept(chain):
    start, time = [0.1, 0.05, -0.02, 0.03, 0.0], np.linspace(0, 10, 50)
    whole = rc.swing(chain, time, offset=start)
    assert whole.offset[0] == pytest.approx([*start, 0.0], abs=3e-16)
    left = np.inf
    for kept in range(6):
        some = rc.swing(chain, time, offset=start, count=kept)
        assert some.energy.size == kept
        assert (np.abs(some.offset - whole.offset) <= some.truncation_error + 1e-14).all()
        assert some.energy_left_out == pytest.approx(whole.energy[kept:].sum(), rel=1e-9, abs=1e-25)
        assert some.energy_left_out <= left
        left = some.energy_left_out
    # energy of a plucked start: sum S (dy)^2 / (2 a)
    start = 0.05 * np.interp(np.arange(40), [0, 20, 40], [0, 1, 0])
    energy = 0.5 * (np.arange(1, 41) / 40 * np.diff([*start, 0.0]) ** 2 / (2.0 / 40)).sum()
    plucked = rc.swing(rc.Chain.uniform_plummets(40, length=2.0), 0.0, offset=start)
    assert plucked.energy.sum() == pytest.approx(energy, rel=1e-13)


def test_massless_pins_are_snapped_straight():
    chain = rc.Chain(weight=[2.0, 0.0], length=1.0)
    swing = rc.swing(chain, 0.0, offset=[0.02, 0.5])
    assert swing.projected and swing.start.tolist() == [0.02, 0.01, 0.0]
    assert not rc.swing(chain, 0.0, offset=[0.02, 0.01]).projected
    assert repr(swing).startswith("1 mode; of the energy 100 % in mode 1")


def test_a_plucked_chain_let_go_in_full():
    # the nonlinear motion, integrated for seconds, differs by the third order in the pluck
    chain = rc.Chain.uniform_rods(5, length=1.0)
    shape, times, off = np.array([0.0, 0.3, 0.6, 1.0, 0.5, 0.0]), np.linspace(0, 3.0, 7), []
    for size in (2e-3, 2e-4):
        start = size * shape
        linear = rc.swing(chain, times, offset=start).offset
        lean = np.arcsin((start[:-1] - start[1:]) / chain.length)
        x = Motion(rc.Rig(chain), 1.0).after(3.0, lean, 0.0, t_eval=times)[:5, 0]  # sines of inclinations
        y = np.cumsum((x * 0.2)[::-1], axis=0)[::-1].T
        off.append(np.abs(y - linear[:, :5]).max() / size)
    assert off[1] < 1e-4
    assert off[0] / off[1] == pytest.approx(100, rel=0.2)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        *(({"offset": offset}, "offset must have shape") for offset in ([0.1], [[0.1] * 5])),
        ({"offset": [0.1, math.nan, 0, 0, 0]}, "offset must be finite, got nan"),
        ({"offset": [0.1] * 6}, "offsets? of the support must be 0, got 0.1"),
        ({"velocity": [1.0]}, "velocity must have shape"),
        ({"velocity": [math.nan] * 5}, "velocity must be finite, got nan"),
        ({"time": math.inf}, "time must be finite"),
        ({"time": [[0.0]]}, "time must be a number or have one axis"),
        *(({"count": count}, "count must be") for count in (-1, 6, 2**70, 1.5)),
    ],
)
def test_wrong_swing(chain, given, message):
    with pytest.raises(ValueError, match=r"swing: .*" + message):
        rc.swing(chain, **{"time": 0.0, "offset": [0.1] * 5} | given)


@pytest.mark.parametrize("inverted", [False, True])
def test_a_response_at_one_speed_is_drawn_as_a_shape(chain, inverted):
    pytest.importorskip("matplotlib")
    hung = rigged(chain, inverted=True) if inverted else chain
    found = rc.response(hung, conical_height=1.9, support_radius=0.1)
    ax = found.plot()
    x, y = ax.get_lines()[1].get_data()
    assert np.array_equal(x, found.offset) and y[-1] == 0 and y[0] == pytest.approx(chain.length.sum())
    assert ax.get_ylabel() == f"{'height above' if inverted else 'depth below'} the support (m)"
    x, y = found.plot(pins=[2]).get_lines()[1].get_data()
    assert np.flatnonzero(~np.isnan(x)).tolist() == [2] and x[2] == found.offset[2]
    with pytest.raises(ValueError, match="pins must be numbers from 0 to .*, got 9"):
        found.plot(pins=[9])


def test_plots(chain):
    pytest.importorskip("matplotlib")
    found = rc.response(chain, angular_speed=np.linspace(0.5, 12, 300))
    ax = found.plot(pins=[0, 3])
    marked = [line for line in ax.get_lines() if line.get_linestyle() == "-."]
    assert len(marked) == int(found.modes_below[-1]) and ax.get_yscale() == "log"
    turned = rc.response(chain, angular_speed=found.angular_speed[np.r_[200:300, :200]]).plot(pins=[0, 3])
    for line, same in zip(ax.get_lines(), turned.get_lines(), strict=True):  # whatever the order of the speeds
        np.testing.assert_array_equal(line.get_xydata(), same.get_xydata())
    rc.response(rigged(chain, momentum=1.0), angular_speed=[-2.0, 1.0, 2.0]).plot()
    rc.response(chain, conical_height=[1.5, 2.0], pins=2).plot()
    swing = rc.swing(chain, np.linspace(0, 2, 9), offset=[0.1] * 5)
    assert sorted(text.get_text() for text in swing.plot().texts) == ["0 s", "0.5 s", "1 s", "1.5 s", "2 s"]
    assert swing.plot(kind="time", pins=[0, 4]).get_ylabel() == "distance from axis (m)"
    for draw, words in (
        (lambda: found.plot(pins=[9]), "pins must be numbers from 0 to .*, got 9"),
        (lambda: rc.response(chain, angular_speed=[1.0, 2.0], pins=[1, 4]).plot(pins=[2]), "pins must be 1, 4, .*, got 2"),
        (rc.response(chain, conical_height=[]).plot, "no speed to draw"),
        (lambda: swing.plot(kind="x"), "kind must be"),
        (lambda: swing.plot(kind="time", pins=[7]), "pins must be numbers from 0 to 5, got 7"),
    ):
        with pytest.raises(ValueError, match=words):
            draw()


def test_a_table_leaves_out_what_its_pins_do_not_tell():
    chain = rc.Chain(weight=[1.0] * 3, length=1.0)
    none = rc.response(chain, angular_speed=3.0, support_radius=0.1, pins=[])
    assert "nan" not in str(none) and "off axis" not in str(none) and "farthest" not in str(none)
    assert none.to_xarray().sizes["pin"] == 0
    some = str(rc.response(chain, angular_speed=3.0, support_radius=0.1, pins=[3]))
    assert "pin 3 off axis" in some and "farthest of these pins" in some and "resonance" not in some
    assert "nan: at a resonance" in str(rc.response(rc.Chain(weight=1.0, length=1.0), conical_height=1.0))
