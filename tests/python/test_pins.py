# SPDX-License-Identifier: GPL-3.0-or-later
"""Free trolleys, springs and dashpots at pins: numbers with their data, laws, files, and what is refused.

The exponents themselves are checked in quadruple precision by tests/cpp/damped_modes.cpp.
"""

import math
import pickle

import mpmath as mp
import numpy as np
import pytest
from exact import near

import revchain as rc
from revchain.results.modes import speed_bound_of_exponents

G = 9.81


def expm(matrix):
    """exp of a matrix by its Taylor series after halving; double."""
    halvings = max(0, int(np.ceil(np.log2(max(np.abs(matrix).sum(axis=1).max(), 1e-300)))) + 4)
    small, term, total = matrix / 2**halvings, np.eye(len(matrix)), np.eye(len(matrix))
    for k in range(1, 18):
        term = term @ small / k
        total = total + term
    for _ in range(halvings):
        total = total @ total
    return total


def test_the_load_under_a_free_trolley():
    crane = rc.Rig(rc.Chain(mass=4000.0, length=10.0), support=rc.Support(mass=1000.0))
    m = rc.modes(crane, gravity=G)
    assert m.angular_speed == near([2.2147234590], rel=3e-11) and m.rigid == 1 and m.other_available == 0
    assert rc.modes(crane).angular_speed == near([2.2143452757], rel=3e-11)
    assert m.speed_error_bound[0] < 4e-16 and m.complete and "rolls freely" in str(m)
    assert m.shape[0] == near([0.25, -1.0], rel=1e-15)  # the centre of mass stays
    assert rc.count_modes(crane, angular_speed=[2.2, 2.3], gravity=G).tolist() == [0, 1]
    same = rc.Rig(rc.Chain(mass=4000.0, length=10.0), support=rc.Support(stiffness=0, mass=1000.0))
    assert same == crane and rc.modes(same).angular_speed == rc.modes(crane).angular_speed


def test_a_trolley_on_a_soft_spring_tends_to_the_free_one():
    chain = rc.Chain(mass=[3.0, 1.0, 2.0], length=[1.0, 0.5, 0.7])
    free = rc.modes(rc.Rig(chain, support=rc.Support(mass=2.0)))
    assert len(free) == 3
    soft = rc.modes(rc.Rig(chain, support=rc.Support(mass=2.0, stiffness=1e-9)))
    assert len(soft) == 4 and soft.angular_speed[0] < 1e-4
    assert soft.angular_speed[1:] == near(free.angular_speed, rel=1e-9)


def test_five_bobs_upright_on_a_cart():
    bobs = rc.Rig(rc.Chain(mass=[0.002] * 5, length=0.2), support=rc.Support(mass=0.002), inverted=True)
    m = rc.modes(bobs, gravity=G)
    assert len(m) == 0 and m.rigid == 1
    growth = [5.5013964911919557909, 10.180421418992271246, 15.038662375936563491, 20.297148443503030888, 26.447269336992368467]
    assert m.other.growth_rate == near(growth, rel=4e-16)


def test_a_pendulum_with_a_dashpot():
    rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=0.2))
    m = rc.modes(rig, gravity=G)
    assert m.exponent == near([complex(-0.1, math.sqrt(G - 0.01))], rel=2e-16)
    assert m.angular_speed == near([math.sqrt(G - 0.01)], rel=2e-16)
    assert (m.decay_time[0], m.damping_ratio[0]) == near((10.0, 0.1 / math.sqrt(G)), rel=4e-16)
    assert m.period == near([2 * math.pi / math.sqrt(G - 0.01)], rel=4e-16)
    assert m.complete and m.status == "success" and m.speed_error_bound[0] < 2e-16
    strong = rc.modes(rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=10.0)), gravity=G)
    root = math.sqrt(25 - G)
    assert strong.exponent == near([root - 5, -root - 5], rel=4e-16)
    assert (strong.angular_speed.tolist(), strong.damping_ratio.tolist()) == ([0.0, 0.0], [1.0, 1.0])
    assert np.isinf(strong.period).all() and "only decays" in str(strong)


def within(got, exact, bound):
    return abs(mp.mpf(float(got)) - exact) <= mp.mpf(float(bound)) * abs(exact)


@pytest.mark.parametrize("nearness", [1e-1, 1e-4, 1e-8, 1e-11, -1e-4])
def test_the_bound_of_a_slow_speed_is_that_of_the_speed(nearness):
    """Near critical damping the speed is far smaller than the exponent, whose error is relative to its size."""
    damping = 2 * math.sqrt(G) * (1 - nearness)
    m = rc.modes(rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=damping)), gravity=G)
    with mp.workdps(50):
        squared = mp.mpf(G) - (mp.mpf(damping) / 2) ** 2
        if nearness < 0:
            assert squared < 0 and m.angular_speed.tolist() == [0.0, 0.0]
            assert m.speed_error_bound.tolist() == [0.0, 0.0] and (m.error_bound > 0).all()
            return
        exact = mp.sqrt(squared)
        assert within(m.angular_speed[0], exact, m.speed_error_bound[0])
        derived = m.speed_error_bound[0] + 4.5e-16
        assert within(m.frequency[0], exact / (2 * mp.pi), derived) and within(m.rpm[0], 30 * exact / mp.pi, derived)
        assert within(m.period[0], 2 * mp.pi / exact, derived)
        ratio = float(abs(m.exponent[0]) / m.angular_speed[0])
    assert m.speed_error_bound[0] == near(m.error_bound[0] * ratio, rel=1e-3)


def test_an_underdamped_mode_does_not_read_as_critical():
    """The damping ratio 1 - x in the table, with all digits of x."""

    def table(damping):
        rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=damping))
        return rc.modes(rig, gravity=G)

    near_critical = table(6.264183904719912)
    assert near_critical.damping_ratio[0] == near(1.0, rel=1e-9)
    apart = 2.00e-10 / 2  # (Im s / |s|)^2 / 2
    assert "1 - 1.0e-10" in str(near_critical) and (near_critical.angular_speed[0] / abs(near_critical.exponent[0])) ** 2 / 2 == near(apart, rel=0.01)
    assert "1 - " not in str(table(0.2)) and "0.0319275" in str(table(0.2))
    assert "1 - " not in str(table(10.0)) and "1.00000" in str(table(10.0))
    assert "modes are numbered by the size of their exponents, smallest first" in str(table(0.2))


def test_speeds_of_which_nothing_is_known():
    """A bound of the exponent that reaches the real axis says nothing of the speed; wheels have no conjugate exponents."""
    s, off = np.array([-1 + 1e-3j, -1 + 1e-3j, -1 + 0j, -1 + 0j]), np.array([1e-2, np.inf, 1e-16, np.inf])
    assert speed_bound_of_exponents(s, off, False).tolist() == [np.inf, np.inf, 0.0, np.inf]
    assert speed_bound_of_exponents(s, off, True).tolist() == [np.inf] * 4
    assert speed_bound_of_exponents(np.array([-1 + 2j]), np.array([2.0]), False).tolist() == [np.inf]
    critical = rc.modes(rc.Rig(rc.Chain(mass=1.0, length=1.0), pins=rc.Pin(damping=6.0)), gravity=9.0)
    assert not np.isfinite(critical.error_bound).any() and not np.isfinite(critical.speed_error_bound).any()


def random_damped(seed, drums=False):
    random = np.random.default_rng(seed)
    n = 1 + seed % 4
    wheels = rc.Flywheel(momentum=random.uniform(-3, 3, n)) if drums else None
    pins = rc.Pin(stiffness=10 ** random.uniform(-1, 1, n), damping=10 ** random.uniform(-2, 1.5, n))
    chain = rc.Chain(mass=10 ** random.uniform(-1, 1, n), length=10 ** random.uniform(-0.5, 0.5, n))
    return rc.Rig(chain, flywheels=wheels, pins=pins)


@pytest.mark.parametrize("drums", [False, True])
@pytest.mark.parametrize("seed", range(12))
def test_random_damped_speeds_within_their_bounds_in_50_digits(seed, drums):
    rig = random_damped(seed, drums)
    m, n = rc.modes(rig, "all", gravity=G), rig.size
    with mp.workdps(50):
        mass, length, stiffness, damping = (
            [mp.mpf(float(x)) for x in each] for each in (rig.chain.mass, rig.chain.length, rig.pins.stiffness, rig.pins.damping)
        )
        momentum = [mp.mpf(float(x)) for x in rig.flywheels.momentum] if drums else [mp.mpf(0)] * n
        M, C, K = mp.matrix(n), mp.matrix(n), mp.matrix(n)
        for i in range(n):
            for j in range(n):
                M[i, j] = mp.fsum(mass[: min(i, j) + 1]) * length[i] * length[j]
            K[i, i] += mp.fsum(mass[: i + 1]) * mp.mpf(G) * length[i]
            C[i, i] -= mp.mpc(0, momentum[i])
            for a, b, sign in ((i, i, 1), (i + 1, i + 1, 1), (i, i + 1, -1), (i + 1, i, -1)):
                if max(a, b) < n:
                    K[a, b] += sign * stiffness[i]
                    C[a, b] += sign * damping[i]
        first, inverse = mp.matrix(2 * n), M**-1
        first[:n, n:], first[n:, :n], first[n:, n:] = mp.eye(n), -inverse * K, -inverse * C
        exact = mp.eig(first, left=False, right=False)
        assert np.isfinite(m.error_bound).all()
        for s, speed, off, bound in zip(m.exponent, m.angular_speed, m.error_bound, m.speed_error_bound, strict=True):
            near_by = min(exact, key=lambda t: abs(t - mp.mpc(complex(s))))
            assert abs(near_by - mp.mpc(complex(s))) <= mp.mpf(float(off)) * abs(near_by) + mp.mpf("1e-40")
            assert abs(mp.mpf(float(speed)) - near_by.imag) <= mp.mpf(float(bound)) * abs(near_by.imag) + mp.mpf("1e-40")
            assert speed == 0 or off <= bound * (1 + 1e-9) < 1e-9


def test_a_damped_double_pendulum_against_its_motion():
    """The state after a while is the sum of the modes: first-order form, exp of a matrix."""
    mass, length, stiffness, damping = [1.0, 2.0], [0.7, 1.1], [0.5, 3.0], [0.3, 0.8]
    m = rc.modes(rc.Rig(rc.Chain(mass=mass, length=length), pins=rc.Pin(stiffness=stiffness, damping=damping)), gravity=G)
    (a, b), (p, q) = length, mass
    # rotations of the lower and the upper link
    inertia = np.array([[p * a * a, p * a * b], [p * a * b, (p + q) * b * b]])
    bend = np.array([[1.0, -1.0], [-1.0, 1.0]])
    top = np.diag([0.0, 1.0])
    K = np.diag([p * G * a, (p + q) * G * b]) + stiffness[0] * bend + stiffness[1] * top
    C = damping[0] * bend + damping[1] * top
    A = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(inertia, K), -np.linalg.solve(inertia, C)]])
    assert sorted(m.exponent, key=abs) == near(sorted(np.linalg.eigvals(A)[::2], key=abs), rel=1e-13)
    to_rotation = np.array([[1 / a, -1 / a], [0, 1 / b]])
    for s, shape in zip(m.exponent, m.shape, strict=True):
        r = to_rotation @ shape[:2]
        state = np.concatenate([r, s * r])
        assert expm(A * 0.8) @ state == near(np.exp(0.8 * s) * state, rel=1e-12)


def test_dashpots_at_wheels_keep_the_senses_apart():
    rig = rc.Rig(
        rc.Chain(mass=[1.0, 1.0], length=1.0), flywheels=rc.Flywheel(momentum=[0.8, -0.2]), pins=rc.Pin(damping=0.1)
    )
    m = rc.modes(rig)
    assert m.has_momentum and len(m) == 4 and m.complete
    assert (m.direction == np.sign(m.angular_speed)).all() and (m.exponent.real < 0).all()
    less = rc.modes(rc.Rig(rig.chain, flywheels=rig.flywheels, pins=rc.Pin(damping=1e-9)))
    assert np.sort(less.angular_speed) == near(np.sort(rc.modes(rc.Rig(rig.chain, flywheels=rig.flywheels)).angular_speed), rel=1e-9)


@pytest.mark.parametrize("links", [10, 40])
def test_a_hanging_cable_with_bending_stiffness(links):
    """Springs EI/a at the pins, far stiffer than the weight: the error against a clamped beam falls as 1/N^2."""
    a, EI = 1.0 / links, 1e4
    spring = np.full(links, EI / a)
    spring[-1] *= 2
    m = rc.modes(rc.Rig(rc.Chain.uniform_rods(links, length=1.0, mass=1.0), pins=rc.Pin(stiffness=spring)), 2)
    beam = np.array([1.8751040687, 4.6940911330]) ** 2 * math.sqrt(EI)  # Euler and Bernoulli: a cantilever
    assert m.angular_speed == near(beam, rel=1.7 / links**2)
    assert m.complete and m.method == "counts"


def test_files_words_and_equality(tmp_path):
    rig = rc.Rig(
        rc.Chain(mass=[1.0, 2.0], length=1.0, names=["load", "hook"]),
        support=rc.Support(stiffness=50.0, damping=3.0, mass=1.0),
        pins=rc.Pin(stiffness=[0.0, 2.0], damping=0.5),
    )
    assert pickle.loads(pickle.dumps(rig)) == rig == rc.Rig.from_dict(rig.to_dict())
    assert "springs at 1 pin, dashpots at 2 pins" in repr(rig) and "damped by 3 N s/m" in rig.describe()
    m = rc.modes(rig)
    assert pickle.loads(pickle.dumps(m)) == m
    for name in ("m.npz", "m.nc"):
        m.save(tmp_path / name)
        assert rc.load(tmp_path / name) == m
    table = m.to_dataframe()
    assert {"damping_ratio", "decay_time", "error_estimate"} <= set(table.columns)
    assert m.to_dict()["modes"][0]["exponent"] == [m.exponent[0].real, m.exponent[0].imag]
    assert "damping ratio" in str(m) and "decay time (s)" in str(m)
    assert m[0].decay_time == m.decay_time[0]
    plain = rc.modes(rig.chain)
    assert plain.exponent.tolist() == [1j * n for n in plain.angular_speed] and (plain.damping_ratio == 0).all()
    assert np.isinf(plain.decay_time).all() and "damping" not in str(plain)


def test_a_mass_is_fitted_through_springs_and_dashpots():
    """Speeds of a rig with known data give the data back."""
    for pins in (rc.Pin(stiffness=2.0), rc.Pin(stiffness=2.0, damping=0.3)):
        true = rc.Rig(rc.Chain(mass=[1.1, 2.0], length=1.0), pins=pins)
        speeds = rc.modes(true).angular_speed
        found = rc.fit(rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0), pins=pins), dict(enumerate(speeds, 1)), vary="links[0].mass")
        assert found.system.chain.mass == near([1.1, 2.0], rel=1e-9)


def test_pins_are_data_that_can_be_varied():
    rig = rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0), pins=rc.Pin(stiffness=2.0))
    target = 1.05 * rc.modes(rig).angular_speed[0]
    tuned = rc.tune(rig, mode=1, vary="pins[1].stiffness", angular_speed=target)
    assert rc.modes(tuned.system).angular_speed[0] == near(target, rel=1e-13)
    assert tuned.system.pins.stiffness[1] == near(tuned.value, rel=1e-15)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: rc.Pin(damping=-1), "damping must not be negative, got -1"),
        (lambda: rc.Pin(stiffness=math.inf), "stiffness must be finite"),
        (lambda: rc.Support(damping=3), "damping does not go with a firm support"),
        (lambda: rc.Support(stiffness=-1), "stiffness must not be negative, got -1"),
        (lambda: rc.Support(mass=1, stiffness=math.inf), "give a stiffness .0 for a trolley"),
        (lambda: rc.Support(mass=1, radius=2), "has no radius"),
        (lambda: rc.Rig(rc.Chain(mass=[1, 2], length=1), pins=rc.Pin(stiffness=[1, 2, 3])), "one for each of the 2 links"),
        (lambda: rc.Rig(rc.Chain(mass=1, length=1), pins=3), "pins must be a revchain.Pin"),
    ],
)
def test_what_is_wrong_is_said(ask, words):
    with pytest.raises((ValueError, TypeError), match=words):
        ask()


TROLLEY = rc.Rig(rc.Chain(mass=[4.0, 1.0], length=1.0), support=rc.Support(mass=2.0))
SPRINGS = rc.Rig(rc.Chain(mass=[4.0, 1.0], length=1.0), pins=rc.Pin(stiffness=2.0))
DASHPOTS = rc.Rig(rc.Chain(mass=[4.0, 1.0], length=1.0), pins=rc.Pin(damping=0.3))


@pytest.mark.parametrize("rig", [TROLLEY, SPRINGS, DASHPOTS], ids=["trolley", "springs", "dashpots"])
def test_what_cannot_be_found_yet_is_refused_and_not_wrong(rig):
    if rig is SPRINGS:
        with pytest.raises(ValueError, match="cannot be found for a rig with springs at pins"):
            rc.steady_shapes(rig, angular_speed=5.0)
    if rig is not DASHPOTS:  # at pins that do not move they have no effect on a steady shape
        with pytest.raises(ValueError, match="cannot be found for a rig with"):
            rc.branches(rig, max_angular_speed=8.0)
    else:
        shapes = rc.steady_shapes(rig, angular_speed=5.0)
        without = rc.steady_shapes(rc.Rig(rig.chain), angular_speed=5.0)
        assert [shape.offset.tolist() for shape in shapes] == [shape.offset.tolist() for shape in without] and len(shapes) == 1
    if rig is not TROLLEY:
        with pytest.raises(ValueError, match="cannot be found for a rig with"):
            rc.modes(rig).uncertainty(mass="1 %")
        with pytest.raises(ValueError, match="cannot be found for a rig with"):
            _ = rc.modes(rig).sensitivity


def test_shapes_under_a_free_trolley():
    """The centre of mass stays on the axis; a spring that is too soft to be noticed gives the same."""
    found = rc.steady_shapes(TROLLEY, angular_speed=12.0)
    soft = rc.steady_shapes(rc.Rig(TROLLEY.chain, support=rc.Support(mass=2.0, stiffness=1e-20)), angular_speed=12.0)
    assert found.complete and len(found) == len(soft) == 2
    for shape, other in zip(found, soft, strict=True):
        assert shape.offset == near(other.offset, rel=1e-15)
        assert abs(shape.offset @ [4.0, 1.0, 2.0]) <= 1e-14
        with pytest.raises(ValueError, match="a trolley that rolls freely"):
            shape.stability()


def test_windows_and_proofs_of_damped_modes_are_refused():
    with pytest.raises(ValueError, match="a window is for a system without dashpots"):
        rc.modes(DASHPOTS, angular_speed=(1.0, 2.0))
    with pytest.raises(ValueError, match="certify is for a Rig without dashpots"):
        rc.modes(DASHPOTS, certify=True)
    with pytest.raises(ValueError, match="dashpots"):
        rc.count_modes(DASHPOTS, angular_speed=1.0)
    with pytest.raises(ValueError, match="first must be from 1 to 2"):
        rc.modes(DASHPOTS, 1, first=3)


def test_sensitivities_under_a_trolley_against_differences():
    m = rc.modes(TROLLEY)
    step = 1e-6
    for name, change in (("mass", {"mass": [4.0 + step, 1.0]}), ("length_in_proportion", {"length": [1.0 + step, 1.0]})):
        data = {"mass": [4.0, 1.0], "length": 1.0} | change
        moved = rc.modes(rc.Rig(rc.Chain(**data), support=rc.Support(mass=2.0))).angular_speed
        rates = getattr(m.sensitivity, name)[:, 0]
        assert rates == near((moved - m.angular_speed) / step, rel=1e-4)
