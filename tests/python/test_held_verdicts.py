# SPDX-License-Identifier: GPL-3.0-or-later
"""Verdicts on stability of what is held at both ends, in both frames, against motions integrated step by step
(support/motion_of_pins.py); cords against the limit of many links. By hand, ``PYTHONPATH=tests/python/support python
tests/python/test_held_verdicts.py 1500`` tries so many random systems."""

import math
import sys
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import pytest
from ends import G
from motion_of_pins import Motion
from scipy.linalg import expm
from tier import by_tier

import revchain as rc
from revchain import Support

FRAMES = ("free", "driven")
GROWS = 1e-9  # rates, over the fastest disturbance's, that rounding does not pass for
COMPARED = 1e-6


# ---- systems


def random_end(rng, kind, length):
    radius = rng.choice([-1, 1]) * rng.uniform(0.02, 0.35) * length if "arm" in kind else 0.0
    if "spring" not in kind:
        return Support(radius=radius)
    return Support(radius=radius, stiffness=math.exp(rng.uniform(3.0, 7.0)), mass=math.exp(rng.uniform(-3.0, 1.0)))


def random_chain(rng, size):
    mass, length = np.exp(rng.normal(0, 0.7, size)), rng.uniform(0.3, 1.5, size)
    kind = rng.choice(["plummets", "rods", "bodies"])
    if kind == "plummets":
        return rc.Chain(mass=mass, length=length)
    if kind == "rods":
        return rc.Chain(mass=mass, length=length, centroid=length / 2, radius_of_gyration=length / 12**0.5)
    centroid, gyration = length * rng.uniform(0.2, 0.9, size), length * rng.uniform(0.1, 0.4, size)
    return rc.Chain(mass=mass, length=length, centroid=centroid, radius_of_gyration=gyration)


def random_system(rng):
    """Three in four turn between arms, springs or both; one in ten without gravity. With it the speed."""
    chain, axis, kinds = random_chain(rng, rng.integers(3, 7)), rng.random() < 0.25, ("axis", "arm", "spring", "spring on arm")
    length = chain.total_length
    lower, upper = (random_end(rng, "axis" if axis else rng.choice(kinds), length) for _ in range(2))
    width = abs(upper.radius - lower.radius) / length
    apart = rng.uniform(max(width, 0.25) + 0.03, 0.97)
    span = length * math.sqrt(apart**2 - width**2)
    held = rc.Held(chain, span=span, lower=lower, upper=upper, weightless=bool(rng.random() < 0.1))
    return held, rng.uniform(2.0, 10.0)


def shapes_of(held, speed, most=3):
    given = {} if held.weightless else {"gravity": G}
    return rc.steady_shapes(held, angular_speed=speed, max_half_waves=most, budget=0, **given)


# ---- verdicts


def verdict_of(grows, negative):
    return "unstable" if grows else "spectrally stable" if negative else "minimum"


@dataclass
class Tally:
    """What was compared, and what differed."""

    systems: int = 0
    shapes: int = 0
    verdicts: Counter = field(default_factory=Counter)
    worst: float = 0.0
    differ: list = field(default_factory=list)

    def add(self, held, speed):
        shapes = shapes_of(held, speed)
        self.systems += 1
        self.shapes += len(shapes)
        for shape in shapes:
            for frame in FRAMES:
                self.compare(shape.stability(frame=frame), Motion(held, shape.offset, shape.height, speed, frame), held)
        return len(shapes)

    def compare(self, stability, motion, held):
        (rate, fastest), negative = motion.growth_rate(), motion.negative_directions()
        verdict = verdict_of(rate > GROWS * fastest, negative)
        self.verdicts[stability.verdict] += 1
        if stability.verdict not in ("undecided", verdict) or stability.negative_directions != negative:
            self.differ.append((stability.verdict, verdict, rate, stability.growth_rate, negative, held))
        elif rate > COMPARED:
            self.worst = max(self.worst, abs(stability.growth_rate / rate - 1))


def random_systems(number, seed=0):
    tally = Tally()
    for each in np.random.SeedSequence(seed).spawn(number):
        tally.add(*random_system(np.random.default_rng(each)))
    return tally


ROPE = rc.Chain.uniform_rods(5, length=2.0, mass=3.0)
BEADS = rc.Chain(mass=[0.3, 0.02, 5.0, 0.02], length=[0.4, 0.5, 0.6, 0.5])
MASSES = rc.Chain(mass=[1.0, 2.0, 0.5, 1.5], length=0.5)
PENDULUMS = rc.Chain(mass=[1.0, 2.0, 0.5, 1.5], length=0.5, centroid=0.45, radius_of_gyration=0.3)
NAMED = {
    "on the axis": (rc.Held(ROPE, span=1.4), 16.0),
    "three half waves": (rc.Held(ROPE, span=1.6), 14.0),  # without angular momentum kept, energy falls in one direction more
    "equal arms": (rc.Held(ROPE, span=1.4, lower=Support(radius=0.3), upper=Support(radius=0.3)), 7.0),
    "arms to either side": (rc.Held(ROPE, span=1.2, lower=Support(radius=0.4), upper=Support(radius=-0.5)), 7.0),
    "one arm": (rc.Held(ROPE, span=1.3, upper=Support(radius=0.6)), 8.0),
    "nearly straight": (rc.Held(ROPE, span=1.9995), 6.0),
    "nearly folded": (rc.Held(MASSES, span=0.15), 12.0),
    "past the resonance of soft springs": (
        rc.Held(ROPE, span=1.3, lower=Support(stiffness=60.0, mass=1.0), upper=Support(stiffness=30.0, mass=0.5, radius=-0.2)),
        8.7,
    ),
    "stiff springs": (
        rc.Held(ROPE, span=1.4, lower=Support(stiffness=1e6, mass=0.1), upper=Support(stiffness=1e6, mass=0.1, radius=0.4)),
        9.0,
    ),
    "springs without carriages": (
        rc.Held(ROPE, span=1.2, lower=Support(stiffness=300.0), upper=Support(stiffness=80.0, radius=0.3)),
        9.0,
    ),
    "a heavy carriage": (rc.Held(ROPE, span=1.5, lower=Support(stiffness=4e3, mass=30.0)), 9.0),
    "a heavy bead": (rc.Held(BEADS, span=1.2, lower=Support(radius=0.2)), 6.0),
    "pendulums longer than links": (rc.Held(PENDULUMS, span=1.4, upper=Support(stiffness=200.0, mass=0.2)), 8.0),
    "no gravity": (
        rc.Held(ROPE, span=1.4, lower=Support(radius=0.2), upper=Support(stiffness=90.0, mass=0.2), weightless=True),
        7.0,
    ),
    "twelve links": (rc.Held(rc.Chain.uniform_rods(12, length=2.0, mass=3.0), span=1.4, upper=Support(radius=0.5)), 9.0),
}


def four_plummets(seed):
    rng = np.random.default_rng(seed)
    masses, lengths = rng.uniform(0.5, 2.0, 4), rng.uniform(0.5, 1.5, 4)
    held = rc.Held(rc.Chain(mass=masses, length=lengths), span=rng.uniform(0.5, 0.9) * lengths.sum())
    return held, rng.uniform(5.0, 9.0)


NAMED |= {f"four plummets, {seed}": four_plummets(seed) for seed in range(5)}


@pytest.mark.parametrize("seed", range(1, 5))
def test_random_systems(seed):
    tally = random_systems(60, seed)
    assert not tally.differ
    assert tally.worst < 1e-6
    assert min(tally.verdicts[kind] for kind in ("minimum", "spectrally stable", "unstable")) > 3


@pytest.mark.parametrize("name", NAMED)
def test_named_systems(name):
    tally = Tally()
    assert tally.add(*NAMED[name])
    assert not tally.differ
    assert tally.worst < 1e-6
    assert not tally.verdicts["undecided"]


@pytest.mark.parametrize("upper", [Support(), Support(stiffness=90.0, mass=0.2)])
def test_without_gravity_neither_end_is_the_lower(upper):
    """Exponents and rates of damping of rods, and of the same rods upside down."""
    mass, length = np.array([1.0, 0.4, 2.0, 0.7]), np.array([0.5, 0.3, 0.6, 0.4])
    found = []
    for way, ends in ((1, {"upper": upper}), (-1, {"lower": upper})):
        m, a = mass[::way], length[::way]
        rods = rc.Chain(mass=m, length=a, centroid=a / 2, radius_of_gyration=a / math.sqrt(12))
        held = rc.Held(rods, span=1.2, weightless=True, **ends)
        found.append(rc.steady_shapes(held, angular_speed=9.0, max_half_waves=2))
    assert len(found[0]) == len(found[1]) == 2
    for frame in FRAMES:
        for one, other in zip(*found, strict=True):
            up, down = one.stability(frame=frame), other.stability(frame=frame)
            for name in ("internal_damping", "external_damping"):
                want = np.sort(getattr(up, name))
                np.testing.assert_allclose(np.sort(getattr(down, name)), want, atol=1e-10 * np.abs(want).max())
            assert np.sort(down.exponents.imag) == pytest.approx(np.sort(up.exponents.imag), abs=1e-12)


@pytest.mark.parametrize("frame", FRAMES)
def test_an_upper_end_without_mass_is_the_limit_of_light_carriages(frame):
    light, none = (
        rc.Held(MASSES, span=1.2, lower=Support(radius=0.2), upper=Support(stiffness=60.0, mass=mass)) for mass in (1e-4, 0.0)
    )
    shapes = shapes_of(none, 12.0)
    assert "unstable" in [shape.stability(frame=frame).verdict for shape in shapes]
    for shape, near in zip(shapes, shapes_of(light, 12.0), strict=True):
        motion, stability = Motion(light, near.offset, near.height, 12.0, frame), shape.stability(frame=frame)
        rate, fastest = motion.growth_rate()
        assert stability.verdict == verdict_of(rate > GROWS * fastest, motion.negative_directions())
        assert stability.growth_rate == pytest.approx(rate, rel=1e-4, abs=GROWS * fastest)


# ---- edges of stability


def unstable_at(held, mode, speed):
    shape = rc.steady_shape(held, mode=mode, angular_speed=speed, gravity=G)
    return shape.stability().verdict == "unstable", shape


SPRINGS = {"lower": Support(stiffness=300.0, mass=0.4), "upper": Support(stiffness=500.0, mass=0.3)}
EDGES = {
    "two half waves of rods": (rc.Held(ROPE, span=1.4), 2, (12.0, 18.0)),
    "two half waves of masses": (rc.Held(MASSES, span=1.4), 2, (14.0, 20.0)),
    "two half waves between springs": (rc.Held(ROPE, span=1.4, **SPRINGS), 2, (12.0, 15.0)),
}


@pytest.mark.parametrize("name", EDGES)
def test_edges_of_stability(name):
    """Bisected by verdicts; 1e-6 of the speed to either side motions confirm them."""
    held, mode, (low, high) = EDGES[name]
    first = unstable_at(held, mode, low)[0]
    assert unstable_at(held, mode, high)[0] != first
    for _ in range(40):
        middle = (low + high) / 2
        low, high = (middle, high) if unstable_at(held, mode, middle)[0] == first else (low, middle)
    rates = []
    for speed in (low * (1 - 1e-6), high * (1 + 1e-6)):
        grows, shape = unstable_at(held, mode, speed)
        rate, fastest = Motion(held, shape.offset, shape.height, speed, "free").growth_rate()
        assert grows == (rate > GROWS * fastest)
        assert shape.stability().growth_rate == pytest.approx(rate, rel=1e-5, abs=GROWS * fastest)
        rates.append(rate)
    assert 1e-6 < max(rates) < 1e-2


# ---- motions that are not linearised


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("name", ["on the axis", "arms to either side", "past the resonance of soft springs", "no gravity"])
def test_disturbed_motions_leave_as_verdicts_say(name, frame):
    """From 1e-7 along a random direction, for ten turns or while what grows most becomes 1000 times as large."""
    held, speed = NAMED[name]
    rng = np.random.default_rng(7)
    for shape in shapes_of(held, speed):
        stability, motion = shape.stability(frame=frame), Motion(held, shape.offset, shape.height, speed, frame)
        start = rng.normal(size=motion.basis.shape[1])
        start *= 1e-7 / np.linalg.norm(start)
        time = min(20 * math.pi, math.log(1e3) / max(stability.growth_rate, 1e-9)) / speed
        times = np.linspace(0, time, 11)[1:]
        found, rates = motion.after(start, times), motion.first_order()
        wanted = np.array([expm(rates * time) @ start for time in times])
        assert np.linalg.norm(found - wanted, axis=1).max() < 1e-3 * np.linalg.norm(wanted, axis=1).max()
        values, rows = np.linalg.eig(rates.T)
        fastest = np.abs(found @ rows[:, np.argmax(values.real)])
        rate = np.log(fastest[-1] / fastest[4]) / (times[-1] - times[4]) / speed
        assert rate == pytest.approx(stability.growth_rate, rel=1e-3, abs=1e-6)
        if stability.verdict != "unstable":
            assert np.abs(found).max() < 1e-5


# ---- cords


CORD = rc.Cord(2.0, mass=1.0)
CORDS = {
    "skipping rope": (rc.Held(CORD, span=1.5), 15.0),
    "slower and flatter": (rc.Held(CORD, span=1.7), 9.0),
    "no gravity": (rc.Held(CORD, span=1.2, weightless=True), 6.0),
}


def exponents_of_links(held, speed, shape, frame, links):
    """And negative directions, of the same shape of so many rods; None if they have none: few push in a sharp bend."""
    chain = rc.Held(held.system.chain(links), span=held.span, weightless=held.weightless)
    found = [each for each in shapes_of(chain, speed, shape.half_waves) if each.half_waves == shape.half_waves]
    if not found:
        return None
    (of_links,) = found
    motion = Motion(chain, of_links.offset, of_links.height, speed, frame)
    return np.linalg.eigvals(motion.first_order() / speed), motion.negative_directions()


@pytest.mark.parametrize("frame", FRAMES)
@pytest.mark.parametrize("name", CORDS)
def test_cords_are_the_limit_of_links(name, frame):
    """Verdicts, and the eight slowest exponents as 1/N^2: to 160 links, whose eigenvalues take most of the time; in the
    quick tier to 80, and then without the order."""
    held, speed = CORDS[name]
    shapes = shapes_of(held, speed, 2)
    assert len(shapes) == 2
    counts = [links for links in (40, 80, 160) if links <= by_tier(80, 160)]
    for shape in shapes:
        stability = shape.stability(frame=frame)
        found, negative = zip(*(exponents_of_links(held, speed, shape, frame, links) for links in counts), strict=True)
        if counts[-1] == 160:
            slow = sorted(stability.exponents, key=abs)[:8]
            off = [np.linalg.norm([np.abs(each - one).min() for one in slow]) for each in found]
            assert np.log2(off[-2] / off[-1]) == pytest.approx(2.0, abs=0.05)
        assert stability.verdict == verdict_of(found[-1].real.max() > COMPARED, negative[-1])
        assert stability.negative_directions == negative[-1]


def limit_of_links(held, speed, shape, frame):
    """The verdict, negative directions and growth rate, for as many links as are needed before twice as many change none of
    the first two, and the last by 5 percent at the most; None if 320 links are too few."""
    before = None
    for links in (40, 80, 160, 320):
        of_links = exponents_of_links(held, speed, shape, frame, links)
        if of_links is None:
            continue
        found, negative = of_links
        rate = found.real.max() if found.real.max() > COMPARED else 0.0
        now = verdict_of(rate > 0, negative), negative, rate
        if before and now[:2] == before[:2] and abs(rate - before[2]) <= 0.05 * rate:
            return now
        before = now
    return None


def random_cords(number, seed=0):
    """Verdicts by how they compare with the limit."""
    rng, counted = np.random.default_rng(seed), Counter()
    for _ in range(number):
        held = rc.Held(CORD, span=rng.uniform(0.9, 1.9), weightless=bool(rng.random() < 0.2))
        speed = rng.uniform(5.0, 20.0)
        for shape in shapes_of(held, speed, 2):
            for frame in FRAMES:
                stability, limit = shape.stability(frame=frame), limit_of_links(held, speed, shape, frame)
                if limit is None or stability.verdict == "undecided":
                    counted["open"] += 1
                else:
                    same = (stability.verdict, stability.negative_directions) == limit[:2]
                    counted["agree" if same else "differ"] += 1
    return counted


if __name__ == "__main__":
    number = int(sys.argv[1])
    print(random_systems(number), random_cords(number // 50), sep="\n")
