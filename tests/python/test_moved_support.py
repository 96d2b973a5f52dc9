# SPDX-License-Identifier: GPL-3.0-or-later
"""Forced motion with dashpots, by accelerations and forces; motion in time under a moving support: public numbers, closed
forms, laws, files, scenes and what is refused. Against dense matrices in quadruple precision: tests/cpp/forced_motion.cpp,
tests/cpp/transient.cpp."""

import math
import pickle

import mpmath as mp
import numpy as np
import pytest
from exact import near
from scipy.integrate import solve_ivp

import revchain as rc

G = 9.81
CRANE = rc.Chain(mass=1000.0, length=10.0)
DAMPED = rc.Rig(rc.Chain(mass=[1.0, 2.0], length=[0.7, 1.1]), pins=rc.Pin(stiffness=[0.5, 3.0], damping=[0.3, 0.8]))
TROLLEY = rc.Rig(rc.Chain(mass=1.0, length=2.0), support=rc.Support(mass=10.0, stiffness=4 * math.pi**2))


def test_a_trolley_pushed_at_the_speed_of_its_spring():
    """The load hangs so that it balances the push; 10 kg, 4 pi^2 N/m, 1 kg on 2 m, 1 N."""
    found = rc.response(TROLLEY, angular_speed=math.sqrt(4 * math.pi**2 / 10), force=1.0, gravity=G)
    assert found.offset == near([-0.25330296, -0.04942936], rel=1e-7)
    assert found.support_force == near(-1.0, rel=1e-14) and found.error_estimate < 2e-16
    assert found.amplification is None and found.support_radius is None and found.force == 1.0
    assert "pushed to and fro with 1 N" in str(found)


def test_resonance_is_finite_with_a_dashpot():
    """(g/l - n^2 + i c n) r = n^2 b / l for the angle r of one link."""
    rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=0.2))
    n = np.array([1.0, math.sqrt(G), 5.0])
    found = rc.response(rig, angular_speed=n, support_radius=0.01, gravity=G)
    angle = n**2 * 0.01 / (G - n**2 + 0.2j * n)
    assert found.offset == near(np.stack([0.01 + angle, np.full(3, 0.01)], axis=1), rel=1e-14)
    assert found.amplitude.tolist() == np.abs(found.offset).tolist() and found.phase.tolist() == np.angle(found.offset).tolist()
    assert not found.resonant.any() and found.modes_below[[0, 2]].tolist() == [0, 1]
    text = str(found)
    assert "ahead (°)" in text and "with damping" in text and "error estimate" in text
    assert found.to_dataframe().shape[0] == 3
    undamped = rc.response(rc.Rig(rig.chain, pins=rc.Pin(stiffness=2.0)), angular_speed=3.0, support_radius=0.01)
    assert undamped.offset.dtype == float and undamped.error_bound is None


def test_an_acceleration_is_a_radius_over_the_square_of_the_speed():
    n = np.array([0.3, 2.0, 7.0])
    found = rc.response(DAMPED, angular_speed=n, acceleration=0.5)
    for k, speed in enumerate(n):
        same = rc.response(DAMPED, angular_speed=speed, support_radius=0.5 / speed**2)
        assert found.offset[k] == near(-same.offset, rel=1e-14)
        assert found.reversed[k] == same.reversed and found.modes_below[k] == same.modes_below
        assert np.abs(found.amplification[k]) == near(np.abs(same.amplification), rel=1e-14)
    plain = rc.response(CRANE, angular_speed=n, acceleration=0.5)
    radius = [rc.response(CRANE, angular_speed=speed, support_radius=0.5 / speed**2).offset for speed in n]
    assert plain.offset == near(-np.array(radius), rel=1e-14)


def test_weak_damping_tends_to_none():
    chain, spring = rc.Chain(mass=[1.0, 3.0, 0.5], length=0.8), rc.Support(stiffness=30.0, mass=1.0)
    n = np.linspace(0.5, 9.0, 40)
    without = rc.response(rc.Rig(chain, support=spring), angular_speed=n, support_radius=0.1)
    weak = rc.response(rc.Rig(chain, support=spring, pins=rc.Pin(damping=1e-12)), angular_speed=n, support_radius=0.1)
    assert weak.offset == near(without.offset + 0j, rel=1e-8)
    assert weak.support_force == near(without.support_force + 0j, rel=1e-8)
    assert weak.modes_below.tolist() == without.modes_below.tolist()


def matrices(rig):
    """M, C, K of two point masses in the rotations of the lower and the upper link; and M times a motion of all."""
    (a, b), (p, q), d, k = rig.chain.length, rig.chain.mass, rig.pins.damping, rig.pins.stiffness
    inertia = np.array([[p * a * a, p * a * b], [p * a * b, (p + q) * b * b]])
    bend, top = np.array([[1.0, -1.0], [-1.0, 1.0]]), np.diag([0.0, 1.0])
    return inertia, d[0] * bend + d[1] * top, np.diag([p * G * a, (p + q) * G * b]) + k[0] * bend + k[1] * top, np.array(
        [p * a, (p + q) * b]
    )


@pytest.mark.parametrize(("kind", "rests"), [("acceleration", True), ("velocity", True), ("offset", True), ("offset", False)])
def test_a_damped_double_pendulum_under_a_moving_support_against_integration(kind, rests):
    M, C, K, together = matrices(DAMPED)
    t = np.array([0.0, 0.4, 1.0, 1.9, 2.5])
    y = np.array([0.0, 0.3, -0.2, 0.1, 0.0])
    motion = rc.SupportMotion(t, **{kind: y}, rests=rests)
    start, times = np.array([0.05, -0.02, 0.0]), np.array([0.0, 0.7, 1.4, 2.5, 4.0])
    found = rc.swing(DAMPED, times, offset=start, velocity=[0.1, 0.0, 0.0] if kind == "acceleration" else None, support=motion,
                     gravity=G)  # fmt: skip
    if kind == "acceleration":
        def moved(s):
            return np.interp(s, t, y, left=0.0, right=0.0)
        rate = np.array([0.1, 0.0])
    elif kind == "velocity":
        def moved(s):
            return 0.0 if s >= t[-1] else np.diff(y)[np.searchsorted(t, s, side="right") - 1] / np.diff(t)[np.searchsorted(t, s, side="right") - 1]
        rate = np.array([0.0, 0.0])
    else:
        from scipy.interpolate import CubicSpline

        spline = CubicSpline(t, y, bc_type="clamped" if rests else "not-a-knot")
        second = spline.derivative(2)
        def moved(s):
            return float(second(s)) if s < t[-1] else 0.0
        rate = np.array([float(spline(0.0, 1))] * 2)  # moves along
    a, b = DAMPED.chain.length
    place = np.array([start[0] - start[1], start[1]]) / [a, b]
    turning = np.array([rate[0] - rate[1], rate[1] - (rate[1] if kind != "acceleration" else 0.0)]) / [a, b]
    ends = [0.0, *t[1:], 4.0]
    state, got = np.concatenate([place, turning]), [np.concatenate([place, turning])]
    for low, high in zip(ends[:-1], ends[1:], strict=True):
        asked = times[(times > low) & (times <= high)]
        done = solve_ivp(
            lambda s, z: np.concatenate([z[2:], np.linalg.solve(M, -K @ z[:2] - C @ z[2:] - together * moved(s))]),
            (low, high - 1e-13), state, "DOP853", rtol=1e-12, atol=1e-14, t_eval=None, dense_output=True,
        )  # fmt: skip
        got += [done.sol(min(s, high - 1e-13)) for s in asked]
        state = done.y[:, -1]
    support = found.offset[:, -1]
    for row, z in enumerate(got):
        upper = support[row] + b * z[1]
        assert np.abs(found.offset[row] - np.array([upper + a * z[0], upper, support[row]])).max() <= 1e-10
    assert found.error_estimate.max() < 1e-14 and found.motion_end == 2.5


def test_a_shaped_stop_leaves_no_swing():
    period = rc.modes(CRANE).period[0]
    for seconds, sway in ((period, 0.0), (period / 2, 2 * 2.0 / (period / 2) * 10 / 9.80665)):
        stop = rc.SupportMotion([0.0, seconds], velocity=[2.0, 0.0])
        assert np.abs(rc.swing(CRANE, seconds, support=stop).residual_sway - sway).max() <= 1e-13
    # two steps half a period apart, for any number of links only the slowest mode is quiet
    chain = rc.Chain(mass=[10.0, 1000.0], length=[1.0, 10.0])
    half = rc.modes(chain).period[0] / 2
    stop = rc.SupportMotion([0, 0.5, half, half + 0.5], velocity=[2.0, 1.0, 1.0, 0.0])
    found = rc.swing(chain, half + 0.5, support=stop)
    assert abs(found.amplitude[0]) < 1e-14 and found.residual_sway > 1e-4
    assert found.sway[-1] == 0 and np.abs(found.exponent.real).max() <= 1e-14


def test_what_a_swing_in_time_is_made_of(tmp_path):
    stop = rc.SupportMotion([0.5, 1.0], velocity=[0.0, 1.0])
    found = rc.swing(DAMPED, np.linspace(0.0, 3.0, 31)[::-1], support=stop)
    assert found.offset.dtype == float and (found.offset[found.time <= 0.5] == 0).all()
    after = found.time > 1.0
    rest = found.offset[:, -1:][after]
    sums = (found.amplitude * np.exp(np.outer(found.time[after] - 1.0, found.exponent))) @ found.shape
    assert np.abs(found.offset[after] - rest - sums.real).max() <= 1e-15
    assert (np.abs(found.offset[after] - rest) <= found.sway + 1e-15).all() and found.energy is None
    assert pickle.loads(pickle.dumps(found)) == found
    for name in ("s.npz", "s.nc"):
        found.save(tmp_path / name)
        assert rc.load(tmp_path / name) == found
    table = found.to_dataframe()
    assert {"support_offset", "error_estimate"} <= set(table.columns)
    assert "after 1 s the free end sways by" in str(found) and "support (m)" in str(found)
    found.animate(tmp_path / "film.html")
    for kind in ("shapes", "time"):
        found.plot(kind=kind)
    rc.response(DAMPED, angular_speed=[1.0, 2.0, 3.0], acceleration=0.1).plot()
    rc.response(DAMPED, angular_speed=2.0, support_radius=0.1).plot()
    rc.response(TROLLEY, angular_speed=[1.0, 2.0, 3.0], force=0.1).plot(speed="rpm")
    free = rc.swing(DAMPED, [0.0, 1.0], offset=[0.1, 0.0])
    assert "the free end sways by" in str(free) and free.motion_end == 0


def test_sway_is_what_is_seen():
    """Near critical damping, of a trolley that coasts, and of what falls."""
    for ratio in (0.3, 0.999999, 1.0, 5.0):
        rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=ratio * 2 * math.sqrt(9.80665)))
        found = rc.swing(rig, np.linspace(1.0, 21.0, 20001), support=rc.SupportMotion([0.0, 1.0], velocity=[1.0, 0.0]))
        assert found.residual_sway == near(found.largest_deflection.max(), rel=0.01)
    trolley = rc.Rig(rc.Chain(mass=4.0, length=2.0), support=rc.Support(mass=10.0, damping=1e-6))
    coasting = rc.swing(trolley, np.linspace(2.0, 22.0, 2001), support=rc.SupportMotion([0.0, 1.0, 2.0], force=[0.0, 5.0, 0.0]))
    assert coasting.residual_sway == near(coasting.largest_deflection.max(), rel=0.01)
    fallen = rc.swing(rc.Rig(CRANE, inverted=True), [0.0, 5.0], offset=[0.01, 0.0], support=stop())
    assert math.isinf(fallen.residual_sway) and "the free end falls" in str(fallen)


def test_flywheels_are_driven_round():
    """To and fro is the mean of both signs of the speed."""
    rig = rc.Rig(
        rc.Chain(mass=[1.0, 2.0], length=[0.5, 1.0]), support=rc.Support(mass=5.0, stiffness=100.0, damping=5.0),
        flywheels=rc.Flywheel(momentum=[0.2, 0.6]), pins=rc.Pin(damping=0.5),
    )  # fmt: skip
    both = rc.response(rig, angular_speed=[-3.0, 3.0], force=1.0)
    assert "pushed round with 1 N" in str(both)
    time = np.linspace(0.0, 120.0, 24001)
    push = rc.SupportMotion(time, force=np.cos(3.0 * time))
    late = rc.swing(rig, [119.2], support=push).offset[0]
    steady = (both.offset * np.exp(1j * both.angular_speed * 119.2)[:, None]).mean(axis=0)
    assert np.abs(late - steady).max() <= 1e-4 * np.abs(steady).max()


def test_one_drive_on_the_command_line_replaces_another():
    ask = {"response": {"angular_speed": 2.0, "force": "3 kN"}, "swing": {"support_time": [0, 1], "support_velocity": [1, 0]}}
    scene = rc.Scene.from_dict({**SCENE, "support": {"mass": "1 t"}, "ask": ask})
    assert scene.response(acceleration=0.5).force is None
    assert scene.swing(support_acceleration=[1.0, 0.0], time=[2.0]).motion_end == 1.0


def test_pushed_and_free_trolleys():
    """A free trolley: the centre of mass moves as the force says; whoever moves it by hand moves it itself."""
    rig = rc.Rig(rc.Chain(mass=4.0, length=1.0), support=rc.Support(mass=2.0))
    push = rc.SupportMotion([0.0, 1.0], force=[3.0, 3.0])
    found = rc.swing(rig, [0.5, 1.0, 3.0], support=push)
    centre = found.offset @ [4.0, 2.0] / 6.0
    assert centre == near([0.0625, 0.25, 0.25 + 0.5 * 2], rel=1e-13)
    assert np.abs(rc.swing(rig, [0.0, 2.0], velocity=[1.0, 1.0]).offset - np.array([[0.0, 0.0], [2.0, 2.0]])).max() <= 1e-14
    stopped = rc.Rig(rig.chain, support=rc.Support(mass=2.0, damping=5.0))
    rest = rc.swing(stopped, [100.0], velocity=[1.0, 1.0])
    assert rest.offset[0] == near([6.0 / 5.0] * 2, rel=1e-12)  # momentum over damping
    by_hand = rc.SupportMotion([0.0, 1.0], velocity=[0.0, 1.0])
    chain = rc.swing(rig.chain, [0.5, 1.0, 2.0], support=by_hand).offset
    assert rc.swing(rig, [0.5, 1.0, 2.0], support=by_hand).offset == near(chain, rel=1e-15)
    weight = rc.Rig(rc.Chain(weight=4.0 * G, length=1.0), support=rc.Support(weight=2.0 * G))
    assert rc.swing(weight, [0.5, 1.0, 3.0], support=push, gravity=G).offset == near(
        rc.swing(rig, [0.5, 1.0, 3.0], support=push, gravity=G).offset, rel=1e-13
    )


def test_flywheels_turn_a_damped_swing():
    rig = rc.Rig(rc.Chain(mass=[1.0, 1.0], length=1.0), flywheels=rc.Flywheel(momentum=[0.8, -0.2]), pins=rc.Pin(damping=0.1))
    m = rc.modes(rig)
    found = rc.swing(rig, [0.0, 0.7], offset=[0.1, 0.05j])
    assert found.offset.dtype == complex and np.abs(found.offset[0] - np.array([0.1, 0.05j, 0.0])).max() <= 1e-15
    assert sorted(found.exponent, key=abs) == near(sorted(m.exponent, key=abs), rel=1e-13)
    weak = rc.swing(rc.Rig(rig.chain, flywheels=rig.flywheels, pins=rc.Pin(damping=1e-13)), [0.7], offset=[0.1, 0.05j])
    plain = rc.swing(rc.Rig(rig.chain, flywheels=rig.flywheels), [0.7], offset=[0.1, 0.05j])
    assert weak.offset == near(plain.offset, rel=1e-10)


def equations_of(rig):
    """M, C - i G, K of point masses in rotations, lowest first, in 50 digits; and M times a motion of all."""
    n, a, m = rig.size, [mp.mpf(x) for x in rig.chain.length], [mp.mpf(x) for x in rig.chain.mass]
    M, C, K, together = mp.matrix(n), mp.matrix(n), mp.matrix(n), mp.matrix(n, 1)
    for k in range(n):  # the mass at the lower end of link k
        arm = [mp.mpf(0)] * k + a[k:]
        for i in range(n):
            together[i] += m[k] * arm[i]
            K[i, i] += m[k] * G * arm[i]
            for j in range(n):
                M[i, j] += m[k] * arm[i] * arm[j]
    momentum = np.broadcast_to(rig.flywheels.momentum, n)
    for k in range(n):
        C[k, k] -= mp.mpc(0, float(momentum[k]))
        for i, j, sign in ((k, k, 1), (k + 1, k + 1, 1), (k, k + 1, -1), (k + 1, k, -1)):
            if max(i, j) < n:
                C[i, j] += sign * mp.mpf(rig.pins.damping[k])
                K[i, j] += sign * mp.mpf(rig.pins.stiffness[k])
    return M, C, K, together


@pytest.mark.parametrize("seed", range(12))
def test_gyroscopic_damped_chains_in_50_digits(seed):
    """Exponents by the first-order form, and motions under an accelerated support by its exponential."""
    random = np.random.default_rng(seed)
    n = 1 + seed % 4
    rig = rc.Rig(
        rc.Chain(mass=10 ** random.uniform(-1, 1, n), length=10 ** random.uniform(-0.5, 0.5, n)),
        flywheels=rc.Flywheel(momentum=random.uniform(-3, 3, n)),
        pins=rc.Pin(stiffness=10 ** random.uniform(-1, 1, n), damping=10 ** random.uniform(-2, 0.5, n)),
    )
    start = random.uniform(-1, 1, n) + 1j * random.uniform(-1, 1, n)
    speed = random.uniform(-1, 1, n) + 1j * random.uniform(-1, 1, n)
    push, end = random.uniform(-1, 1, 2), 1.25
    found = rc.swing(rig, [end], offset=start, velocity=speed, support=rc.SupportMotion([0.0, end], acceleration=push), gravity=G)
    with mp.workdps(50):
        M, C, K, together = equations_of(rig)
        whole, inverse = mp.matrix(2 * n + 2), M**-1
        whole[:n, n : 2 * n] = mp.eye(n)
        whole[n : 2 * n, :n], whole[n : 2 * n, n : 2 * n] = -inverse * K, -inverse * C
        whole[n : 2 * n, 2 * n], whole[2 * n, 2 * n + 1] = -inverse * together, mp.mpf(1)
        exponents = mp.eig(whole[: 2 * n, : 2 * n], left=False, right=False)
        m = rc.modes(rig, "all", gravity=G)
        assert len(m) == 2 * n and m.complete
        for s, bound in zip(m.exponent, m.error_bound, strict=True):
            near_by = min(exponents, key=lambda t: abs(t - mp.mpc(complex(s))))
            assert abs(near_by - mp.mpc(complex(s))) <= 4 * mp.mpf(2) ** -53 * abs(near_by) and bound < 1e-14
        state = mp.matrix(2 * n + 2, 1)
        for k in range(n):
            for at, y in ((k, start), (n + k, speed)):
                above = y[k + 1] if k + 1 < n else 0.0
                state[at] = (mp.mpc(complex(y[k])) - mp.mpc(complex(above))) / mp.mpf(rig.chain.length[k])
        low, high = (mp.mpf(float(x)) for x in push)
        state[2 * n], state[2 * n + 1] = low, (high - low) / end
        state = mp.expm(whole * end) * state
        offset = [end * end * (low / 3 + high / 6)]
        for k in reversed(range(n)):
            offset.insert(0, offset[0] + mp.mpf(rig.chain.length[k]) * state[k])
        largest = max(abs(y) for y in offset)
        for got, exact in zip(found.offset[0], offset, strict=True):
            assert abs(mp.mpc(complex(got)) - exact) <= 1e-13 * largest
        assert found.error_estimate[0] >= float(abs(mp.mpc(complex(found.offset[0, 0])) - offset[0])) / 10


SCENE = {"links": [{"mass": "4 t", "length": "12 m"}]}


def test_scenes_move_their_supports():
    ask = {"swing": {"time": [6.0], "support_time": [0, "5 s"], "support_velocity": ["1.5 m/s", 0]}}
    found = rc.Scene.from_dict({**SCENE, "ask": ask}).swing()
    stop = rc.SupportMotion([0.0, 5.0], velocity=[1.5, 0.0])
    assert found == rc.swing(rc.Chain(mass=4000.0, length=12.0), [6.0], support=stop)
    pushed = {**SCENE, "support": {"mass": "1 t"}, "ask": {"response": {"angular_speed": 2.0, "force": "3 kN"}}}
    assert rc.Scene.from_dict(pushed).response().force == 3000.0


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        ({"swing": {}}, "give offset, velocity or support_time: nothing would move"),
        ({"swing": {"support_time": [0, 1]}}, "support_time: needs one of support_velocity, support_acceleration, support_offset and support_force beside it"),
        ({"swing": {"support_velocity": [0, 1]}}, "support_velocity: needs support_time beside it"),
        ({"swing": {"support_time": [0, 1, 1], "support_velocity": [0, 1, 2]}}, "a support cannot jump"),
        ({"response": {"angular_speed": 1.0, "force": 1.0, "acceleration": 2.0}}, "does not go with acceleration"),
        ({"response": {"angular_speed": 1.0, "force": 1.0}}, "force: needs a support that yields"),
    ],
)
def test_scenes_say_what_is_wrong(ask, words):
    with pytest.raises(rc.SceneError, match=words):
        rc.Scene.from_dict({**SCENE, "ask": ask}).answers()


def stop(time=(0.0, 1.0), **given):
    return rc.SupportMotion(time, **(given or {"velocity": [1.0, 0.0]}))


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: stop(velocity=[0, 1], force=[0, 1]), "give one of velocity, acceleration, offset, force, got velocity and force"),
        (lambda: stop([0.0], velocity=[1.0]), "at least 2, got 1 and 1"),
        (lambda: stop([-1.0, 0.0]), "time must not be negative"),
        (lambda: stop([1.0, 0.0]), "time must ascend"),
        (lambda: stop([1.0, 1.0]), "a support cannot jump, nor its velocity"),
        (lambda: stop([0.0, 1.0], offset=[0.0, math.nan]), "offset must be finite"),
        (lambda: stop([0.0, 1.0], offset=3.0), "offset must be a list of numbers"),
        (lambda: stop([0.0, 1.0], velocity=[0.0, 1.0], rests=False), "rests=False goes with offsets"),
        (lambda: rc.swing(rc.Rig(CRANE, inverted=True), [1e5], support=stop()), "grows beyond all numbers"),
        (lambda: rc.response(DAMPED, angular_speed=1e200, acceleration=1.0), "that far from the rig's own"),
        (lambda: rc.Pin(damping=[]), "must have a number for each link"),
        (lambda: rc.swing(CRANE, [-1.0], support=stop()), "time must not be negative"),
        (lambda: rc.swing(CRANE, [1.0], support=[0, 1]), "support must be a revchain.SupportMotion"),
        (lambda: rc.swing(CRANE, [1.0], support=stop(), count=1), "count must be left out"),
        (lambda: rc.swing(rc.Cord(1.0), [1.0], support=stop()), "use its chain"),
        (lambda: rc.swing(CRANE, [1.0], support=stop(force=[1.0, 0.0])), "must not be a force on a firm support"),
        (lambda: rc.swing(CRANE, [1.0], offset=[0.0, 1.0], support=stop()), "leave out the offset of the support"),
        (lambda: rc.swing(DAMPED, [1.0], offset=[0.1j, 0.0]), "must be real"),
        (lambda: rc.response(CRANE, angular_speed=1.0, support_radius=1.0, force=2.0), "give one of support_radius"),
        (lambda: rc.response(CRANE, angular_speed=1.0, force=2.0), "force needs a support that yields"),
        (lambda: rc.response(CRANE, angular_speed=1.0, acceleration=-2.0), "acceleration must be positive"),
    ],
)
def test_what_is_wrong_is_said(ask, words):
    with pytest.raises((ValueError, TypeError), match=words):
        ask()
