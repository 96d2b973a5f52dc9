# SPDX-License-Identifier: GPL-3.0-or-later
"""Carriages, the governor and ropes that whirl: equations of motion and first integrals, from the docstrings alone.

The balance of forces is integrated in tests/cpp/governor.cpp and tests/cpp/rope.cpp."""

import itertools
import math

import mpmath as mp
import numpy as np
import pytest
from exact import exactly, near
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tier import by_tier

import revchain as rc

ULP = 2.0**-52
NAN, INF = math.nan, math.inf

pytestmark = pytest.mark.usefixtures("digits")


@pytest.fixture
def digits():
    with mp.workdps(40):
        yield


def random(count, low, high):
    return np.random.default_rng(count).uniform(low, high, count)


def close(found, exact, relative):
    return abs(mp.mpf(float(found)) - exact) <= relative * abs(exact)


# Two carriages and a buffer ------------------------------------------------------------------------------------------


class Carriages:
    """Phases (start, in contact, function of the time since) of the motion, in exact modes of each phase."""

    def __init__(self, front_mass, rear_mass, buffer_stiffness, coupling_stiffness, speed):
        self.m, self.n, self.b, self.c, v = exactly(front_mass, rear_mass, buffer_stiffness, coupling_stiffness, speed)
        self.phases, self.blows = [], []
        start, state, contact = mp.mpf(0), (mp.mpf(0), mp.mpf(0), v, v), True
        while True:
            motion = self.motion(self.b if contact else mp.mpf(0), *state)
            self.phases.append((start, contact, motion))
            lasts = self.first_zero(motion, state, contact)
            if lasts is None:
                return
            x, y, u, w = motion(lasts)
            if contact:
                gained = self.m * (state[2] - u) + self.n * (state[3] - w)
                self.blows.append((start, start + lasts, gained))
            start, state, contact = start + lasts, (mp.mpf(0), y, u, w), not contact

    def motion(self, b, x, y, u, w):
        """Both modes, shapes (1, r), of m x'' = -b x + c (y - x), n y'' = c (x - y); without the buffer one is a drift."""
        m, n, c = self.m, self.n, self.c
        p, q = (b + c) / m, c / n
        fast = (p + q) / 2 + mp.sqrt((p - q) ** 2 / 4 + c**2 / (m * n))
        modes = []
        for square in (fast, b * c / (m * n) / fast):
            r = (b + c - m * square) / c
            norm = m + n * r**2
            modes.append((r, mp.sqrt(square), (m * x + n * r * y) / norm, (m * u + n * r * w) / norm))

        def motion(t, f=mp):
            out = [0, 0, 0, 0]
            for r, k, a, d in modes:
                if f is np:
                    r, k, a, d = map(float, (r, k, a, d))
                cosine, sine = f.cos(k * t), f.sin(k * t)
                at, rate = a * cosine + d * (sine / k if k else t), d * cosine - a * k * sine
                out = [out[0] + at, out[1] + r * at, out[2] + rate, out[3] + r * rate]
            return out

        (_, motion.fastest, here, rate), (_, slow, place, speed) = modes
        swing = mp.hypot(here, rate / motion.fastest)
        drift = max((swing + abs(place)) / abs(speed), 2 * mp.pi / motion.fastest) + 1 / motion.fastest
        motion.horizon = 2 * mp.pi / slow if b else drift
        return motion

    def first_zero(self, motion, state, contact):
        step = float(0.01 / motion.fastest)
        horizon = float(motion.horizon)
        for begin in np.arange(0, horizon + 1000 * step, 1000 * step):
            times = begin + step * np.arange(1, 1002)
            x = motion(times, np)[0]
            past = np.flatnonzero(x < 0 if contact else x > 0)
            if past.size:
                ends = (times[past[0]] - step, times[past[0]])
                return mp.findroot(lambda t: motion(t)[0], ends, solver="anderson", tol=1e-60, maxsteps=200)
        return None

    def __call__(self, time):
        time = mp.mpf(time)
        start, contact, motion = [phase for phase in self.phases if phase[0] <= time][-1]
        out = motion(time - start)
        return [*out, self.b * out[0] if contact else mp.mpf(0)]


IMPACTS = [
    dict(front_mass=1, rear_mass=1, buffer_stiffness=4, coupling_stiffness=0.5, speed=1),
    dict(front_mass=1, rear_mass=3, buffer_stiffness=10, coupling_stiffness=1, speed=2),
    dict(front_mass=2, rear_mass=1, buffer_stiffness=1, coupling_stiffness=1, speed=1e-3),
    dict(front_mass=1, rear_mass=50, buffer_stiffness=1000, coupling_stiffness=2, speed=1),
    dict(front_mass=1e4, rear_mass=3e4, buffer_stiffness=1e6, coupling_stiffness=1e8, speed=0.4),
    dict(front_mass=30, rear_mass=1, buffer_stiffness=1, coupling_stiffness=7, speed=1),
]
IMPACTS += [
    dict(front_mass=10.0**m, rear_mass=1.0, buffer_stiffness=10.0**b, coupling_stiffness=10.0**c, speed=10.0**v)
    for m, b, c, v in random(32, -1, 1).reshape(8, 4) * [1, 2, 2, 9]
]


def times_of(blows):
    inside = [blow.start + share * (blow.end - blow.start) for blow in blows for share in (0.1, 0.5, 0.9)]
    between = [(one.end + other.start) / 2 for one, other in itertools.pairwise(blows)]
    return [0.0, *inside, *between, *(blows[-1].end * np.array([1.1, 3, 1e3, 1e6]))]


def fastest(numbers):
    """Of the frequencies, at most."""
    front, rear, buffer, coupling = (numbers[n] for n in ("front_mass", "rear_mass", "buffer_stiffness", "coupling_stiffness"))
    return math.sqrt((buffer + coupling) / front + coupling / rear)


@pytest.mark.parametrize("numbers", IMPACTS)
def test_blows_places_and_speeds_of_the_carriages(numbers):
    exact, impact = Carriages(**numbers), rc.BufferImpact(**numbers)
    last, v = exact.blows[-1][1], numbers["speed"]
    momentum = (numbers["front_mass"] + numbers["rear_mass"]) * v
    for blow, (start, end, impulse) in zip(impact.blows, exact.blows, strict=True):
        assert abs(blow.start - start) <= 1e-13 * last and abs(blow.end - end) <= 1e-13 * last
        assert abs(blow.impulse - impulse) <= 4e-13 * momentum  # of four speeds
    times = times_of(impact.blows)
    for time, *state in zip(times, *impact.state(times), strict=True):
        truth = exact(time)
        assert all(abs(f - e) <= 1e-13 * v * time for f, e in zip(state[:2], truth[:2], strict=True))
        within = 1e-13 * v * (1 + fastest(numbers) * time)
        assert all(abs(f - e) <= within for f, e in zip(state[2:4], truth[2:4], strict=True))
        assert abs(state[4] - truth[4]) <= 1e-13 * numbers["buffer_stiffness"] * v * time + 1e-300
        assert state[4] >= 0


def test_the_motion_of_the_carriages_is_in_proportion_to_the_speed():
    plain, fast = (rc.BufferImpact(**{**IMPACTS[1], "speed": speed}) for speed in (1.0, 2.0**40))
    for one, other in zip(plain.blows, fast.blows, strict=True):
        assert one[:2] == other[:2] and one.impulse * 2.0**40 == other.impulse
    assert np.array_equal(np.array(plain.state(1.3)) * 2.0**40, np.array(fast.state(1.3)))
    for speed in (1e-200, 1e-100, 1e100, 1e200):
        blows = rc.BufferImpact(**{**IMPACTS[1], "speed": speed}).blows
        assert [blow[:2] for blow in blows] == [near(blow[:2], rel=1e-13) for blow in plain.blows]


def test_couplings_stiff_and_soft_and_carriages_too_unlike():
    """One blow, and thousands of them, which take most of the time."""
    (blow,) = rc.BufferImpact(front_mass=1, rear_mass=1, buffer_stiffness=1, coupling_stiffness=1e12, speed=1).blows
    assert blow.end == near(math.pi * math.sqrt(2), rel=1e-5) and blow.impulse == near(4, rel=1e-5)  # one carriage
    # as many blows as it takes to turn a heavy one, which on a coupling soft next to the buffer swings half a period
    chatter = rc.BufferImpact(front_mass=1, rear_mass=1e4, buffer_stiffness=1e3, coupling_stiffness=1, speed=1)
    assert sum(blow.impulse for blow in chatter.blows) == near(2e4, rel=0.1)
    with pytest.raises(ValueError, match="nearer each other"):
        rc.BufferImpact(front_mass=5e-212, rear_mass=6e18, buffer_stiffness=1, coupling_stiffness=1, speed=1)


# The governor --------------------------------------------------------------------------------------------------------


class Swing:
    """theta'' = n^2 (1 - axial) sin cos - (g / l) sin by Taylor series of 40 digits."""

    def __init__(self, *, angular_speed, pendulum_length, angle, angle_rate=0.0, gravity=9.80665, axial_inertia=0.0):
        n, l, c, g = exactly(angular_speed, pendulum_length, axial_inertia, gravity)  # noqa: E741
        self.square, self.pull = n**2 * (1 - c), g / l
        self.angle, self.rate = exactly(angle, angle_rate)

    def acceleration(self, angle):
        return self.square * mp.sin(angle) * mp.cos(angle) - self.pull * mp.sin(angle)

    def energy(self, angle, rate):
        return rate**2 / 2 - self.square * mp.sin(angle) ** 2 / 2 - self.pull * mp.cos(angle)

    def step(self, angle, rate, h, order=36):
        scale = 1 << 140  # fixed point: series whose terms fall
        fixed = lambda x: int(mp.nint(x * scale))  # noqa: E731
        square, pull, h_ = fixed(self.square * h * h), fixed(self.pull * h * h), 140
        th, s, c, sc = [fixed(angle), fixed(rate * h)], [fixed(mp.sin(angle))], [fixed(mp.cos(angle))], []
        for k in range(order):
            sc.append(sum(s[j] * c[k - j] for j in range(k + 1)) >> h_)
            th.append(((square * sc[k] - pull * s[k]) >> h_) // ((k + 1) * (k + 2)))
            s.append(sum((j + 1) * th[j + 1] * c[k - j] for j in range(k + 1)) // (k + 1) >> h_)
            c.append(-(sum((j + 1) * th[j + 1] * s[k - j] for j in range(k + 1)) // (k + 1) >> h_))
        return mp.mpf(sum(th)) / scale, mp.mpf(sum(j * t for j, t in enumerate(th))) / scale / h

    def __call__(self, times):
        """States at ascending times."""
        time, angle, rate, out = mp.mpf(0), self.angle, self.rate, []
        for target in exactly(*times):
            span = target - time
            fastest = mp.sqrt(abs(self.square) + abs(self.pull)) + mp.sqrt(
                2 * abs(self.energy(angle, rate)) + abs(self.square) + 2 * abs(self.pull)
            )
            steps = int(mp.ceil(span * fastest / 0.6)) or 1
            for _ in range(steps):
                if span:
                    angle, rate = self.step(angle, rate, span / steps)
            time = target
            out.append((angle, rate))
        return out


def plain(angle, **more):
    return dict(angular_speed=0.0, pendulum_length=1.0, angle=angle, **more)


ASIDE = math.acos(9.80665 / 25)  # the relative equilibrium at 5 rad/s on 1 m
SWINGS = {
    "aside": dict(angular_speed=5.0, pendulum_length=1.0, angle=1.5),
    "aside, moving": dict(angular_speed=5.0, pendulum_length=1.0, angle=-1.0, angle_rate=0.7),
    "aside, little": dict(angular_speed=5.0, pendulum_length=1.0, angle=ASIDE * (1 + 1e-9)),
    "aside, turns away": dict(angular_speed=5.0, pendulum_length=1.0, angle=1.5 - 6 * math.pi),
    "through": dict(angular_speed=5.0, pendulum_length=1.0, angle=2.5, angle_rate=-0.3),
    "through, slow axis": dict(angular_speed=1.0, pendulum_length=2.0, angle=0.4, angle_rate=1.0),
    "through, little": dict(angular_speed=1.0, pendulum_length=2.0, angle=1e-9, angle_rate=1e-10),
    "through, axial": dict(angular_speed=9.0, pendulum_length=0.5, angle=0.3, angle_rate=-8.0, axial_inertia=0.8),
    "through, plain": plain(3.0, angle_rate=0.2),
    "through, plain, little": plain(1e-9),
    "through, upside down": dict(angular_speed=3.0, pendulum_length=1.0, angle=2.0, angle_rate=1.0, gravity=-9.8),
    "aside, upside down": dict(angular_speed=6.0, pendulum_length=1.0, angle=2.0, gravity=-9.8),
    "aside, weightless": dict(angular_speed=6.0, pendulum_length=1.0, angle=1.0, gravity=0.0),
    "revolutions": dict(angular_speed=5.0, pendulum_length=1.0, angle=0.3, angle_rate=9.0),
    "revolutions, back": dict(angular_speed=2.0, pendulum_length=1.0, angle=3.0, angle_rate=-4.0),
    "revolutions, plain": plain(0.0, angle_rate=6.3),
    "revolutions, fast": dict(angular_speed=1.0, pendulum_length=1.0, angle=0.0, angle_rate=1e3),
    "revolutions, weightless": dict(angular_speed=1.0, pendulum_length=1.0, angle=0.0, angle_rate=1.5, gravity=0.0),
}


def far_off(motion, swing, times, slack=None):
    """What is farther off than 1e-13 of the angle and of time times its rate."""
    found = motion.state(times)
    wrong = []
    for i, (time, (angle, rate)) in enumerate(zip(times, swing(times), strict=True)):
        allowed = mp.mpf(1e-13) * (abs(angle) + time * abs(rate))
        unit = 1 / mp.sqrt(abs(swing.square) + abs(swing.pull))
        allowed_rate = mp.mpf(1e-13) * (abs(rate) + (time + unit) * abs(swing.acceleration(angle)))
        allowed_rate += 4 * ULP * abs(angle) / unit
        if slack:
            allowed, allowed_rate = allowed + slack[i][0], allowed_rate + slack[i][1]
        off = abs(float(found.angle[i]) - angle), abs(float(found.angle_rate[i]) - rate)
        if off[0] > allowed or off[1] > allowed_rate:
            wrong.append((time, float(off[0] / allowed), float(off[1] / allowed_rate)))
    return wrong


@pytest.mark.parametrize("name", SWINGS)
def test_a_link_swings_as_its_equation_of_motion_says(name):
    motion, swing = rc.GovernorMotion(**SWINGS[name]), Swing(**SWINGS[name])
    assert motion.regime == name.partition(",")[0]
    assert not far_off(motion, swing, [0.0, *(motion.period * np.array([0.1, 0.25, 0.5, 0.77, 1.0, 1.9, 3.3]))])
    size = math.pi if motion.regime == "revolutions" else max(abs(motion.least_angle), abs(motion.greatest_angle))
    assert abs(motion.state(0.0).angle - SWINGS[name]["angle"]) <= 4 * ULP * size  # it starts where it is told to
    back = rc.GovernorMotion(**{**SWINGS[name], "angular_speed": -SWINGS[name]["angular_speed"]})
    assert np.array_equal(back.state(0.3), motion.state(0.3))


@pytest.mark.parametrize("seed", range(16))
def test_any_link_swings_as_its_equation_of_motion_says(seed):
    """To 1e-13 of the greatest angle, a turn where it revolves, and of the greatest rate and acceleration looked at."""
    turn, pull, angle, rate, power = np.random.default_rng(seed).uniform(-1, 1, 5)
    unit = 10.0 ** (6 * power)
    small = 10.0 ** -(6 * (seed % 3))
    numbers = dict(angular_speed=6 * abs(turn) / unit, pendulum_length=abs(pull) * unit**2, angle=3.1 * angle * small)
    numbers |= dict(angle_rate=10 * rate * small / unit, gravity=math.copysign(10 * pull**2, pull))
    motion, swing = rc.GovernorMotion(**numbers), Swing(**numbers)
    times = unit * np.array([0.0, *np.sort(random(12, 0, 4))])
    found, exact = motion.state(times), swing(times)
    greatest = min(max(abs(motion.least_angle), abs(motion.greatest_angle)), 2 * math.pi)
    fastest = max(abs(rate) for _, rate in exact)
    strongest = max(abs(swing.acceleration(angle)) for angle, _ in exact)
    for i, (time, (angle, rate)) in enumerate(zip(times, exact, strict=True)):
        assert abs(float(found.angle[i]) - angle) <= 1e-13 * (greatest + time * fastest)
        assert abs(float(found.angle_rate[i]) - rate) <= 1e-13 * (fastest + time * strongest)


@pytest.mark.parametrize("name", SWINGS)
def test_the_period_and_the_turning_angles(name):
    motion, swing = rc.GovernorMotion(**SWINGS[name]), Swing(**SWINGS[name])
    ((angle, rate),) = swing([motion.period])
    turn = 2 * mp.pi * mp.sign(swing.rate) if motion.regime == "revolutions" else 0
    unit = 1 / mp.sqrt(abs(swing.square) + abs(swing.pull))
    assert abs(angle - turn - swing.angle) <= 1e-13 * (abs(angle) + motion.period * abs(rate))
    assert abs(rate - swing.rate) <= 1e-13 * (abs(rate) + (motion.period + unit) * abs(swing.acceleration(angle)))
    if motion.regime == "revolutions":
        assert (motion.least_angle, motion.greatest_angle) == (-INF, INF)
        return
    start = swing.energy(swing.angle, swing.rate)
    assert motion.least_angle < motion.greatest_angle
    for turning in exactly(motion.least_angle, motion.greatest_angle):
        # all energy is potential there: off by (energy error) / slope
        slope = abs(swing.acceleration(turning))
        assert abs(swing.energy(turning, 0) - start) <= 4 * ULP * abs(turning) * slope + 1e-15 * abs(start)
    states = motion.state(np.linspace(0, 2 * motion.period, 201))
    room = 4 * ULP * max(abs(motion.least_angle), abs(motion.greatest_angle))
    assert (states.angle >= motion.least_angle - room).all() and (states.angle <= motion.greatest_angle + room).all()
    if name != "aside, little":
        width = motion.greatest_angle - motion.least_angle
        assert np.ptp(states.angle) == near(width, rel=1e-3)


@pytest.mark.parametrize("name", SWINGS)
@pytest.mark.parametrize("time", [1e3, 1e6, -1e6, -0.3])
def test_energy_is_kept_at_any_time(name, time):
    motion, swing = rc.GovernorMotion(**SWINGS[name]), Swing(**SWINGS[name])
    angle, rate = exactly(*motion.state(time))
    start = swing.energy(swing.angle, swing.rate) + swing.pull  # counted from the bottom
    size = rate**2 + abs(swing.square) * mp.sin(angle) ** 2 + abs(swing.pull) * 2 * mp.sin(angle / 2) ** 2
    slope = abs(angle * swing.acceleration(angle)) * ULP
    assert abs(swing.energy(angle, rate) + swing.pull - start) <= 1e-12 * (size + abs(start)) + 2 * slope


SEPARATRICES = {
    "over the bottom, from aside": (
        dict(angular_speed=5.0, pendulum_length=1.0),
        2 * math.acos(math.sqrt(9.80665 / 25)),
    ),
    "plain, to the top": (dict(angular_speed=0.0, pendulum_length=1.0, angle=0.0), 2 * math.sqrt(9.80665)),
    "to the top": (dict(angular_speed=2.0, pendulum_length=1.0, angle=0.0), 2 * math.sqrt(9.80665)),
}


@pytest.mark.parametrize("side", [-1, 1])
@pytest.mark.parametrize("beside", [1e-3, 1e-6, 1e-9, 1e-12, 1e-15, 0.0])
@pytest.mark.parametrize("name", SEPARATRICES)
def test_next_to_a_separatrix(name, beside, side):
    """The start rounded to double is known no better: one ulp of it either way is allowed for."""
    numbers, critical = SEPARATRICES[name]
    varied = "angle_rate" if "angle" in numbers else "angle"
    start = critical * (1 + side * beside)
    motion = rc.GovernorMotion(**numbers, **{varied: start})
    times = [0.1, 1.0, 4.0]
    swing = Swing(**numbers, **{varied: start})
    truth, moved = swing(times), Swing(**numbers, **{varied: start * (1 + 4 * ULP)})(times)
    slack = [[abs(a - b) for a, b in zip(*pair, strict=True)] for pair in zip(truth, moved, strict=True)]
    assert not far_off(motion, swing, times, slack)
    if beside >= 1e-12:
        sides = {"to": ("through", "revolutions"), "over": ("aside", "through")}["to" if "to the" in name else "over"]
        assert motion.regime == sides[side > 0]
    assert motion.period > 2


@pytest.mark.parametrize("amplitude", [1e-100, 1e-9, 1e-3, 1.0, 3.0, math.pi - 1e-7])
@pytest.mark.parametrize("length", [1e-6, 1.0, 1e6])
def test_the_plain_pendulum(amplitude, length):
    a, l, g = exactly(amplitude, length, 9.80665)  # noqa: E741
    period = 4 * mp.sqrt(l / g) * mp.ellipk(mp.sin(a / 2) ** 2)
    motion = rc.GovernorMotion(**{**plain(amplitude), "pendulum_length": length})
    assert motion.regime == "through" and close(motion.period, period, 1e-13)
    assert close(motion.modulus, mp.sin(a / 2), 1e-14) and close(motion.complementary_modulus, mp.cos(a / 2), 1e-13)
    assert close(motion.greatest_angle, a, 4 * ULP) and close(motion.least_angle, -a, 4 * ULP)


@pytest.mark.parametrize("numbers", [dict(angular_speed=5.0), dict(angular_speed=1.0), dict(angular_speed=0.0)])
def test_a_link_at_rest_stays(numbers):
    motion = rc.GovernorMotion(**numbers, pendulum_length=1.0, angle=0.0)
    assert motion.regime == "rest" and motion.period == 0
    state = motion.state([0.0, 1.0, 1e6])
    assert state.angle.tolist() == state.angle_rate.tolist() == [0.0] * 3


def test_angles_count_whole_turns():
    motion = rc.GovernorMotion(**SWINGS["revolutions"])
    turns = motion.state(motion.period * np.arange(5)).angle - 0.3
    np.testing.assert_allclose(turns, 2 * math.pi * np.arange(5), atol=1e-12)
    one, other = (rc.GovernorMotion(**{**SWINGS["aside"], "angle": a}) for a in (1.5, 1.5 + 8 * math.pi))
    times = np.linspace(0, 5, 11)
    np.testing.assert_allclose(other.state(times).angle - one.state(times).angle, 8 * math.pi, rtol=1e-12)
    assert other.least_angle - one.least_angle == near(8 * math.pi, rel=1e-13)


def test_motions_with_lengths_and_times_scale_exactly():
    one = rc.GovernorMotion(**SWINGS["aside, moving"])
    other = rc.GovernorMotion(angular_speed=10.0, pendulum_length=4.0, angle=-1.0, angle_rate=1.4, gravity=9.80665 * 16)
    assert other.period * 2 == one.period
    here, there = one.state(0.7), other.state(0.35)
    assert there.angle == here.angle and there.angle_rate == 2 * here.angle_rate


# The skipping rope ---------------------------------------------------------------------------------------------------


def third(m):
    """Integral of sin^2 cos^2 / Delta over a quarter turn."""
    K, E = mp.ellipk(m), mp.ellipe(m)
    return ((2 - m) * E - 2 * (1 - m) * K) / (3 * m**2)


class Rope:
    """Half waves of the balance y'^2 = (b^2 - y^2)(4 c + b^2 - y^2) / (4 c^2), c = height times tension."""

    def __init__(self, product, sag):
        self.c, self.b = c, b = product, sag
        self.root = mp.sqrt(4 * c + b**2)
        self.m = b**2 / self.root**2
        self.kc = 2 * mp.sqrt(c) / self.root
        K = mp.elliprf(0, self.kc**2, 1)
        D = mp.elliprd(0, self.kc**2, 1) / 3
        self.span = 4 * c / self.root * K
        self.slack = 2 * b**2 / self.root * (K - D)
        self.length = self.span + self.slack
        self.sag, self.height_times_tension = b, c

    @property
    def moment_of_inertia(self):
        D = mp.elliprd(0, self.kc**2, 1) / 3
        with mp.extradps(60):
            rest = third(self.m)
        return 2 * self.b**2 / self.root * (2 * self.c * D + self.b**2 * rest)

    def at(self, phi):
        """x, arc, offset, slope and tension over that in the middle where the offset is sag sin(phi)."""
        s, c = mp.sin(phi), mp.cos(phi)
        F = s * mp.elliprf(c**2, c**2 + (self.kc * s) ** 2, 1)
        D = s**3 / 3 * mp.elliprd(c**2, c**2 + (self.kc * s) ** 2, 1)
        x = 2 * self.c / self.root * F
        rest = (self.b * c) ** 2
        slope = mp.sqrt(rest * (4 * self.c + rest)) / (2 * self.c)
        return x, x + self.b**2 / self.root * (F - D), self.b * s, slope, 1 + rest / (2 * self.c)


def rope_of(span, complementary):
    K = mp.elliprf(0, mp.mpf(complementary) ** 2, 1)
    c = (mp.mpf(span) / 2 / (complementary * K)) ** 2
    return Rope(c, 2 * mp.sqrt(c) * mp.sqrt(1 - mp.mpf(complementary) ** 2) / complementary)


QUANTITIES = ("span", "length", "slack", "sag", "height_times_tension")
PAIRS = list(itertools.combinations(QUANTITIES, 2))
FORMS = [1 - 1e-15, 1 - 1e-8, 0.999, 0.8, 0.3, 1e-2, 1e-5]
FORMS += [1 - 10.0**e for e in random(2, -15, -1)] + [10.0**e for e in random(4, -6, 0)]


def logarithms(u, v):
    rope = Rope(mp.exp(u), mp.exp(v))
    return [mp.log(getattr(rope, name)) for name in QUANTITIES]


def conditions(rope, pair):
    """By how much errors of the two that are given grow in each quantity."""
    u, v, h = mp.log(rope.c), mp.log(rope.b), mp.mpf(10) ** -15
    base, by_u, by_v = logarithms(u, v), logarithms(u + h, v), logarithms(u, v + h)
    rows = {n: ((a - o) / h, (b - o) / h) for n, o, a, b in zip(QUANTITIES, base, by_u, by_v, strict=True)}
    given_ = mp.matrix([rows[name] for name in pair])
    inverse = given_**-1
    return {name: sum(abs(e) for e in (mp.matrix([row]) * inverse)) for name, row in rows.items()}


def made(pair, values, half_waves=1, **more):
    arguments = dict(zip(pair, values, strict=True))
    product = arguments.pop("height_times_tension", None)
    if product is not None:
        arguments |= dict(tension=product, angular_speed=1.0, gravity=1.0)
    return rc.SkippingRope(**arguments, half_waves=half_waves, **more)


@pytest.mark.parametrize("complementary", FORMS)
@pytest.mark.parametrize("pair", PAIRS, ids="-".join)
def test_any_two_numbers_give_the_rope(pair, complementary):
    exact = rope_of(2, complementary)
    # what is given is rounded to double, and so are the conditions' shares of that
    rope = made(pair, [float(getattr(exact, name)) for name in pair])
    wrong = {}
    for name, condition in conditions(exact, pair).items():
        if condition < 1e5:
            error = abs(mp.mpf(getattr(rope, name)) / getattr(exact, name) - 1)
            if error > 1e-14 * max(1, condition):
                wrong[name] = (float(error), float(condition))
    assert not wrong


@pytest.mark.parametrize("ratio", [1e-8, 1e-3, 0.5, 3.0, 1e2, 1e4])
def test_a_rope_of_any_sag(ratio):
    rope = rc.SkippingRope(span=2.0, sag=2 * ratio)
    exact = Rope(mp.mpf(rope.height_times_tension), mp.mpf(2 * ratio))
    condition = 1 + float(conditions(exact, ("sag", "height_times_tension"))["span"])
    assert close(2.0, exact.span, 1e-14 * condition)
    assert close(rope.slack, exact.slack, 3e-14 * condition) and close(rope.length, exact.length, 3e-14)
    assert close(rope.modulus, mp.sqrt(exact.m), 1e-14) and close(rope.complementary_modulus, exact.kc, 3e-14)
    assert close(rope.moment_of_inertia, exact.moment_of_inertia, 3e-14 * condition)
    _, _, _, slope, ratio_ = exact.at(mp.mpf(0))
    assert close(rope.slope_at_ends, slope, 3e-14) and close(rope.tension_ratio_at_ends, ratio_, 3e-14)


@pytest.mark.parametrize("slack", [1e-280, 1e-30, 1e-12, 1e-3])
def test_a_rope_nearly_straight(slack):
    """offset = sag sin(pi x / span): slack (pi sag)^2 / (4 span), height times tension (span / pi)^2."""
    rope = rc.SkippingRope(span=3.0, slack=slack)
    sag = math.sqrt(4 * 3.0 * slack) / math.pi
    assert rope.sag == near(sag, rel=1e-13 + slack)
    assert rope.slack == near(slack, rel=1e-14)
    assert rope.height_times_tension == near((3 / math.pi) ** 2, rel=1e-13 + slack)
    assert rope.at(1.0).offset == near(sag * math.sin(math.pi / 3), rel=1e-13 + slack)
    assert rope.moment_of_inertia == near(sag**2 * 1.5, rel=1e-13 + slack)


@pytest.mark.parametrize("complementary", [1 - 1e-8, 0.8, 0.3, 1e-3])
def test_places_on_the_rope(complementary):
    rope = made(("sag", "height_times_tension"), [float(v) for v in exactly(*both(complementary))])
    exact = Rope(*exactly(rope.height_times_tension, rope.sag))
    for phi in (1e-6, 0.1, 0.7, 1.3, 1.57):
        x, arc, offset, slope, tension = exact.at(mp.mpf(phi))
        found = rope.at(float(x))
        within = 2e-14 * (1 + abs(x * slope / offset))
        assert close(found.offset, offset, within)
        assert close(found.arc, arc, 3e-14 + within) and found.x == float(x)
        bend = abs(offset / exact.c) * tension * x  # of the slope with x
        assert abs(found.slope - slope) <= 3e-14 * (slope + bend * 10)
        assert close(found.tension_ratio, tension, within)
        back = rope.at_arc(float(arc))
        assert abs(back.x - x) <= 4e-14 * x + ULP * arc and close(back.offset, offset, 2 * within + 2e-14)


def both(complementary):
    exact = rope_of(2, complementary)
    return exact.sag, exact.height_times_tension


@pytest.mark.parametrize("half_waves", [1, 2, 5])
def test_half_waves_repeat(half_waves):
    rope = rc.SkippingRope(span=2.0 * half_waves, length=3.0 * half_waves, angular_speed=12.0, half_waves=half_waves)
    one = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
    assert rope.half_waves == half_waves
    for name in ("sag", "modulus", "tension_in_the_middle", "tension_at_ends", "slope_at_ends"):
        assert getattr(rope, name) == near(getattr(one, name), rel=1e-13)
    assert rope.moment_of_inertia == near(half_waves * one.moment_of_inertia, rel=1e-13)
    x = np.linspace(0, 2, 11)
    for wave in range(half_waves):
        sign = (-1) ** wave
        there, here = rope.at(np.minimum(x + 2 * wave, rope.span)), one.at(x)
        np.testing.assert_allclose(there.offset, sign * here.offset, atol=1e-13)
        np.testing.assert_allclose(there.slope, sign * here.slope, atol=1e-12)
        np.testing.assert_allclose(there.arc, here.arc + 3 * wave, rtol=1e-13)


def test_tensions_of_the_rope():
    rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
    assert rope.conical_height == near(9.80665 / 144, rel=4 * ULP)
    assert rope.tension_in_the_middle * rope.conical_height == near(rope.height_times_tension, rel=1e-14)
    assert rope.tension_at_ends == near(rope.tension_in_the_middle * rope.tension_ratio_at_ends, rel=1e-14)
    assert rope.tension_ratio_at_ends == near(math.hypot(1, rope.slope_at_ends), rel=1e-13)
    found = rope.at([0.0, 1.0]).tension_ratio * rope.tension_in_the_middle
    np.testing.assert_allclose(found, [rope.tension_at_ends, rope.tension_in_the_middle], rtol=1e-13)
    still = rc.SkippingRope(span=2.0, length=3.0)  # without a speed there is no tension
    for name in ("angular_speed", "conical_height", "tension_in_the_middle", "tension_at_ends"):
        with pytest.raises(ValueError, match="SkippingRope"):
            getattr(still, name)
    assert still.tension_ratio_at_ends > 1
    with pytest.raises(ValueError, match="SkippingRope"):
        still.drawn_to(1.0)


@pytest.mark.parametrize("span", [0.01, 1.0, 2.5, 2.999])
def test_a_rope_drawn_apart_keeps_its_momentum(span):
    rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0)
    drawn = rope.drawn_to(span)
    assert drawn.span == near(span, rel=1e-14) and drawn.length == near(3, rel=1e-14)
    momentum = rope.moment_of_inertia * 12.0
    assert drawn.moment_of_inertia * drawn.angular_speed == near(momentum, rel=1e-12)


@pytest.mark.parametrize("exponent", [-300, -200, -150, 60, 300])
def test_a_rope_in_any_unit_is_as_long_as_it_is_made(exponent):
    length, span = 4.0 * 2.0**exponent, 0.06261576368272406 * 4 * 2.0**exponent
    rope = rc.SkippingRope(span=span, length=length)
    assert rope.length == near(length, rel=1e-14) and rope.span == near(span, rel=1e-14)


@pytest.mark.parametrize("length", [3.0, 3.1, 2.7, 100.0, 2.0 + 1e-12])
def test_what_is_given_is_found_again(length):
    rope = rc.SkippingRope(span=2.0, length=length, angular_speed=3.0)
    assert rope.span == 2.0 and rope.angular_speed == near(3.0, rel=2 * ULP)
    assert rope.length == near(length, rel=4 * ULP)
    assert rope.at_arc(length).x == near(2.0, rel=1e-13)  # the end as the caller knows it
    assert abs(rope.at([0.0, 2.0]).offset).max() <= 1e-13 * rope.sag * max(1, rope.slope_at_ends)


@pytest.mark.parametrize(
    ("numbers", "named"),
    [
        ({}, "two"),
        (dict(span=1.0), "two"),
        (dict(span=1.0, length=2.0, sag=0.5), "two"),
        (dict(tension=1.0, angular_speed=1.0), "two"),
        (dict(span=1.0, tension=2.0), "two"),
        (dict(span=1.0, length=2.0, tension=1.0, angular_speed=1.0), "two"),
        (dict(span=2.0, length=1.0), "length.*got 1$"),
        (dict(span=2.0, length=2.0), "length.*got 2$"),
        (dict(length=2.0, sag=1.0), "sag.*got 1$"),
        (dict(length=2.0, slack=3.0), "slack"),
        (dict(slack=2.5, sag=1.0), "slack.*got 2.5$"),
        (dict(span=10.0, tension=1.0, angular_speed=3.0), "span.*got 10$"),
        (dict(length=0.125, tension=1.0, angular_speed=3.0), "length.*got 0.125$"),
        (dict(span=1.0, length=2.0, half_waves=0), "half_waves.*got 0$"),
        (dict(span=1.0, length=2.0, half_waves=1.5), "half_waves.*got 1.5$"),
        (dict(span=1.0, length=2.0, gravity=-1.0), "gravity.*got -1$"),
    ],
)
def test_ropes_that_cannot_be(numbers, named):
    with pytest.raises(ValueError, match=f"SkippingRope.*{named}"):
        rc.SkippingRope(**numbers)


def test_places_off_the_rope_are_refused():
    rope = rc.SkippingRope(span=2.0, length=3.0)
    for call, end, message in ((rope.at, 2.0, "at.*x"), (rope.at_arc, 3.0, "arc")):
        for bad in (-1e-3, end + 1e-3, NAN, INF, [0.0, end + 0.5], "x", None):
            with pytest.raises(ValueError, match=message):
                call(bad)
    for bad in (0.0, -1.0, 3.01, 4.0, NAN, "x", None, [1.0, 2.0]):
        with pytest.raises(ValueError, match="span"):
            rc.SkippingRope(span=2.0, length=3.0, angular_speed=1.0).drawn_to(bad)
    for length in (3.0, 2.5, 7.0, 2.013):  # nor is it drawn to its length
        with pytest.raises(ValueError, match="span"):
            rc.SkippingRope(span=2.0, length=length, angular_speed=1.0).drawn_to(length)


# The tortuous rope ---------------------------------------------------------------------------------------------------


class Tortuous:
    """First integrals T x' = h and T r^2 angle' = q, T = t - R / (2 l), R = r^2, by the arc; l the height."""

    def __init__(self, least, greatest, angular_speed, tension, gravity=9.80665):
        r1, r2, n, h, g = exactly(least, greatest, angular_speed, tension, gravity)
        self.h, self.l = h, g / n**2
        self.R1, self.R2 = R1, R2 = r1**2, r2**2
        self.t = (R1 + R2) / (2 * self.l) + mp.sqrt(h**2 + R1 * R2 / (4 * self.l**2))
        self.R3 = 4 * self.l * self.t - R1 - R2
        self.q = mp.sqrt(R1 * R2 * self.R3) / (2 * self.l)
        self.kc2 = (self.R3 - R2) / (self.R3 - R1)
        self.scale = 2 * h * self.l / mp.sqrt(self.R3 - R1)

    def at(self, phi):
        """x, arc and angle where R = R1 + (R2 - R1) sin(phi)^2, and slack."""
        s, c = mp.sin(phi), mp.cos(phi)
        y = c**2 + self.kc2 * s**2
        F, D = s * mp.elliprf(c**2, y, 1), s**3 / 3 * mp.elliprd(c**2, y, 1)
        angle = mp.mpf(0)
        if self.R1:
            n = -(self.R2 - self.R1) / self.R1
            P = F + n * s**3 / 3 * mp.elliprj(c**2, y, 1, 1 - n * s**2)
            angle = self.q / (self.h * self.R1) * self.scale * P
        x = self.scale * F
        squares = self.R1 * F + (self.R2 - self.R1) * D
        slack = ((self.t / self.h - 1) * F - squares / (2 * self.l * self.h)) * self.scale
        return x, x + slack, angle, slack


RADII = [(0.5, 1.0), (0.0, 1.0), (1.0, 1.0), (1e-6, 1.0), (1e-150, 1.0), (0.999999, 1.0), (1e-9, 1e-8), (3.0, 40.0)]
RADII += [(10.0**e, 10.0**f) for e, f in zip(random(12, -30, -1), random(12, 0, 3), strict=True)]
RADII += [(1 - 10.0**e, 1.0) for e in random(6, -15, 0)]
SPEEDS = [(5.0, 2.0), (0.1, 2.0), (50.0, 1e-3), *((10.0**e, 10.0**f) for e, f in random(24, -6, 6).reshape(12, 2))]


@pytest.mark.parametrize("radii", RADII)
@pytest.mark.parametrize("speed", SPEEDS)
def test_half_waves_of_a_tortuous_rope(radii, speed):
    rope = rc.TortuousRope(least_radius=radii[0], greatest_radius=radii[1], angular_speed=speed[0], tension=speed[1])
    exact = Tortuous(*radii, *speed)
    with mp.workdps(340 if radii[0] < 1e-9 * radii[1] else 40):
        x, arc, angle, slack = (2 * each for each in Tortuous(*radii, *speed).at(mp.pi / 2))
    assert close(rope.half_wave, x, 1e-14) and close(rope.half_wave_length, arc, 1e-14)
    assert close(rope.half_wave_slack, slack, 1e-14)
    assert abs(rope.half_wave_angle - (angle or mp.pi)) <= 1e-14 * (1 + angle)
    assert close(rope.modulus, mp.sqrt(1 - exact.kc2), 1e-14)
    assert close(rope.complementary_modulus, mp.sqrt(exact.kc2), 1e-14)
    assert close(rope.conical_height, exact.l, 3 * ULP) and close(rope.height_times_tension, exact.l * exact.h, 3 * ULP)
    assert (rope.least_radius, rope.greatest_radius) == radii


@pytest.mark.parametrize("radii", [(0.5, 1.0), (1e-3, 1.0), (0.99, 1.0), (3.0, 40.0)])
def test_places_on_a_tortuous_rope(radii):
    rope = rc.TortuousRope(least_radius=radii[0], greatest_radius=radii[1], angular_speed=5.0, tension=2.0)
    exact = Tortuous(*radii, 5.0, 2.0)
    wave = rope.half_wave
    for phi in (1e-3, 0.3, 1.0, 1.5):
        x, arc, angle, _ = exact.at(mp.mpf(phi))
        radius = mp.sqrt(exact.R1 + (exact.R2 - exact.R1) * mp.sin(phi) ** 2)
        tension = exact.t - radius**2 / (2 * exact.l)
        turn = exact.q / (exact.h * radius**2)
        slope = mp.sqrt(abs((tension / exact.h) ** 2 - 1 - (radius * turn) ** 2))
        found = rope.at([float(x), -float(x), float(x) + wave])
        within = 4e-14 * (1 + x * slope / radius)
        assert close(found.radius[0], radius, within) and close(found.arc[0], arc, 4e-14)
        assert abs(found.angle[0] - angle) <= 2e-14 * (1 + angle + x * turn)
        assert close(found.angle_slope[0], turn, 3 * within)
        assert abs(found.radius_slope[0] - slope) <= 4e-14 * (slope + 30 * tension / exact.h * radius / radii[0])
        # the mirror image, and the next half wave
        assert (found.radius[1], found.arc[1], found.angle[1]) == (found.radius[0], -found.arc[0], -found.angle[0])
        assert abs(found.radius[2] - radius) <= 1e-13 * (1 + wave * slope)
        assert abs(found.angle[2] - angle - rope.half_wave_angle) <= 1e-13 * (1 + wave * turn)
        assert found.arc[2] == near(float(arc) + rope.half_wave_length, rel=1e-13)


def test_the_smallest_radius():
    rope = rc.TortuousRope(least_radius=5e-324, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
    assert rope.half_wave_angle == near(math.pi, rel=1e-13) and np.isfinite(rope.at([0.3, 5.0]).angle).all()


@pytest.mark.parametrize("ratio", [1e-19, 1e-21, 1e-50, 1e-100, 1e-101, 1e-155, 1e-200])
def test_a_tortuous_rope_of_any_ratio_of_radii(ratio):
    """The slope of the angle is that of the areas: radius^2 d angle / dx is the same everywhere."""
    rope = rc.TortuousRope(least_radius=ratio, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
    point = rope.at(np.array([ratio, 0.1, 0.5, 1.0]) * rope.half_wave)
    areas = point.radius * point.angle_slope * point.radius
    np.testing.assert_allclose(areas, areas[-1], rtol=1e-13)
    assert areas[-1] > 0
    assert rope.half_wave_angle == near(math.pi, rel=1e-13)
    plane = rc.TortuousRope(least_radius=0.0, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
    there = plane.at(np.array([0.1, 0.5]) * rope.half_wave)
    np.testing.assert_allclose(point.angle[1:3], there.angle, rtol=1e-13)
    np.testing.assert_allclose(point.radius_slope[1:3], there.radius_slope, rtol=1e-12, atol=1e-12)


# Shapes, numbers and refusals ----------------------------------------------------------------------------------------

MADE = {
    "BufferImpact": IMPACTS[0],
    "GovernorMotion": dict(
        angular_speed=5.0, pendulum_length=1.0, angle=1.5, angle_rate=0.1, gravity=9.0, axial_inertia=0.1
    ),
    "SkippingRope": dict(span=2.0, length=3.0, angular_speed=12.0, gravity=9.0),
    "TortuousRope": dict(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0, gravity=9.0),
}
METHODS = {
    "BufferImpact": ["state"],
    "GovernorMotion": ["state"],
    "SkippingRope": ["at", "at_arc"],
    "TortuousRope": ["at"],
}
CASES = [(kind, name) for kind, numbers in MADE.items() for name in numbers]
SIGNED = {"angle", "angle_rate", "gravity", "angular_speed"}


@pytest.mark.parametrize(("kind", "name"), CASES)
def test_refusals_name_the_place_and_the_parameter_and_the_value(kind, name):
    bad = [NAN, INF, -INF, "x", 1j, True, object(), [1.0, 2.0], []]
    if not (kind == "GovernorMotion" and name in SIGNED):
        bad.append(-1.5)
    unclear = []
    for value in bad:
        with pytest.raises(ValueError) as refusal:
            getattr(rc, kind)(**{**MADE[kind], name: value})
        text = str(refusal.value)
        shown = f"{value:g}" if isinstance(value, float) else "" if isinstance(value, list) else str(value)
        if kind not in text or name.replace("_", " ") not in text.replace("_", " ") or shown not in text:
            unclear.append(text)
    assert not unclear


@pytest.mark.parametrize(("kind", "name"), [(kind, name) for kind, names in METHODS.items() for name in names])
def test_places_and_times_of_any_shape(kind, name):
    thing = getattr(rc, kind)(**MADE[kind])
    call = getattr(thing, name)
    columns = lambda value: value if isinstance(value, tuple) else (value,)  # noqa: E731
    one = columns(call(0.7))
    assert all(np.isscalar(each) for each in one)
    assert all(np.ndim(each) == 0 for each in columns(call(np.array(0.7))))
    for form in ([0.7], np.full((2, 3), 0.7), np.full((2, 0), 0.7), [[0.7], [0.7]]):
        for column, number in zip(columns(call(form)), one, strict=True):
            assert np.array_equal(column, np.full(np.shape(form), number))
    assert columns(call(1)) == columns(call(1.0)) == columns(call(np.int32(1)))
    for bad in (NAN, [0.1, INF], "x", None, 1j, True, [0.1, "x"]):
        with pytest.raises(ValueError, match=kind):
            call(bad)


@pytest.mark.parametrize("radii", [(1.0, 0.5), (0.0, 0.0), (-0.1, 1.0), (0.5, -1.0)])
def test_radii_and_times_that_cannot_be(radii):
    with pytest.raises(ValueError, match=r"TortuousRope.*(least|greatest).radius"):
        rc.TortuousRope(least_radius=radii[0], greatest_radius=radii[1], angular_speed=5.0, tension=2.0)
    with pytest.raises(ValueError, match=r"BufferImpact.*time.*got -1"):
        rc.BufferImpact(**IMPACTS[0]).state([0.0, -1.0])


RANGE = st.integers(-300, 300).map(lambda e: 10.0**e)


@given(*[RANGE] * 6)
@example(1.0, 1.0, 1e146, 1e-18, 1.0, 0.1)  # tension gravity / angular speed^2 below the normal numbers
@settings(max_examples=by_tier(20, 150), deadline=None)
def test_extreme_motions_have_numbers_or_are_refused(a, b, c, d, e, t):
    """Carriages of very unlike masses deal many blows, which take most of the time."""

    def finite(make):
        try:
            values = make()
        except ValueError as refusal:
            assert "must" in str(refusal) and ", got " in str(refusal)
            return
        assert np.isfinite(np.array(values, dtype=float)).all(), values

    finite(lambda: rc.GovernorMotion(angular_speed=a, pendulum_length=b, angle=c, angle_rate=d, gravity=e).state(t))
    finite(lambda: rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=c).state(t))
    finite(lambda: rc.GovernorMotion(angular_speed=0.0, pendulum_length=b, angle=1.0, gravity=e).state(t))

    def blows():
        impact = rc.BufferImpact(front_mass=a, rear_mass=b, buffer_stiffness=c, coupling_stiffness=d, speed=e)
        return [*np.ravel(impact.blows), *impact.state(t)]

    finite(blows)

    def printed():
        assert repr(rc.SkippingRope(span=2.0, length=3.0, angular_speed=c)).startswith("SkippingRope")
        return []

    finite(printed)
    try:
        rope = rc.TortuousRope(least_radius=min(a, b), greatest_radius=max(a, b), angular_speed=c, tension=d)
        point = rope.at([0.0, 0.3 * rope.half_wave, rope.half_wave, t])
    except ValueError as refusal:
        assert "must" in str(refusal) and ", got " in str(refusal)
    else:
        assert not any(np.isnan(each).any() for each in point)


@pytest.mark.parametrize("time", [1e15, 1e18, 1e100, 1e300])
def test_a_motion_stays_between_its_turning_angles_at_any_time(time):
    swing = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)
    assert swing.least_angle - 1e-12 <= swing.state(time).angle <= swing.greatest_angle + 1e-12
    far = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1e160)
    assert np.isfinite(far.state(1.0)).all()
