# SPDX-License-Identifier: GPL-3.0-or-later
"""Proved error bounds hold for the numbers given, by mass and by weight: random systems against 60 digits.

REVCHAIN_CASES=10000 tries so many systems of each kind instead of a few (tests/python/support/tier.py)."""

import math

import mpmath as mp
import numpy as np
import pytest
from ends import polished
from exactly import System, newton, power
from rigs import G
from tier import by_tier

import revchain as rc

ULP = 2.0**-52
BY = pytest.mark.parametrize("by", ["mass", "weight"])


@pytest.fixture(autouse=True)
def digits():
    with mp.workdps(60):
        yield


class Tally:
    """Counts what was compared and what was outside its bound; prints both."""

    def __init__(self, what):
        self.what, self.systems, self.numbers, self.outside, self.worst, self.refused = what, 0, 0, [], 0.0, 0

    def compare(self, error, bound, where):
        """An error within its bound; an infinite bound says nothing."""
        if not math.isfinite(bound):
            return
        self.numbers += 1
        ratio = float(abs(error) / mp.mpf(bound)) if bound else float(error != 0)
        self.worst = max(self.worst, ratio)
        if not ratio <= 1:
            self.outside.append((ratio, where))

    def inside(self, good, where):
        self.numbers += 1
        if not good:
            self.outside.append((math.nan, where))

    def finish(self, numbers):
        print(f"\n{self.what}: {self.systems} systems, {self.refused} refused, {self.numbers} numbers,"
              f" {len(self.outside)} outside their bound, largest error/bound {self.worst:.3g}")  # fmt: skip
        assert not self.outside, (len(self.outside), self.outside[:3])
        assert self.systems and self.numbers >= numbers * self.systems


def samples(many, seed):
    """Generators of random numbers, one for each system."""
    for i in range(by_tier(many // 3, many)):
        yield i, np.random.default_rng([seed, i])


def heights_hold(tally, pencil, m, g, where):
    """A speed of the pencil lies within the bound of every height, and of every speed."""
    for i in range(len(m)):
        height, bound = mp.mpf(float(m.conical_height[i])), mp.mpf(float(m.error_bound[i]))
        sense = -1 if m.angular_speed[i] < 0 else 1
        slow, fast = (sense * mp.sqrt(mp.mpf(g) / (height * (1 + sign * bound))) for sign in (1, -1))
        tally.inside(pencil.between(slow, fast), (*where, "height", i, float(height), float(bound)))
        speed, off = mp.mpf(float(m.angular_speed[i])), mp.mpf(float(m.speed_error_bound[i]))
        tally.inside(pencil.between(speed * (1 - off), speed * (1 + off)), (*where, "speed", i, float(speed), float(off)))


@BY
def test_modes_of_rigs(by):
    tally = Tally(f"modes of rigs by {by}")
    for i, rng in samples(60, 1):
        system = System(rng, by)
        m = rc.modes(system.rig(rng), gravity=G)
        tally.systems += 1
        pencil = system.pencil()
        heights_hold(tally, pencil, m, G, (i,))
        for k in range(len(m.other)):
            n = complex(m.other.angular_speed[k])
            if n == 0:
                continue
            n = pencil.root(mp.mpc(n))
            height, found = mp.mpf(G) / n**2, mp.mpc(complex(m.other.conical_height[k]))
            tally.compare(abs(height / found - 1), float(m.other.error_bound[k]), (i, "other", k))
    tally.finish(2)


@BY
def test_modes_of_held_systems(by):
    tally = Tally(f"modes of held systems by {by}")
    for i, rng in samples(60, 2):
        system = System(rng, by)
        held, pull = system.held(rng)
        if not held.mode_count:
            continue
        m = rc.modes(held)
        tally.systems += 1
        heights_hold(tally, system.pencil(pull), m, G, (i,))
    tally.finish(2)


@BY
def test_response(by):
    """At speeds of any size, and as near to a resonance as an ulp."""
    tally = Tally(f"response by {by}")
    for i, rng in samples(60, 3):
        system = System(rng, by)
        rig = system.rig(rng, inverted=0.1)
        pencil, radius = system.pencil(), float(power(rng, 2))
        m = rc.modes(rig)
        senses = (-1, 1) if rig.has_momentum else (1,)
        speeds = [float(rng.choice(senses) * power(rng, 1) * math.sqrt(G / system.long)) for _ in range(2)]
        if len(m):
            near = m.angular_speed[rng.integers(len(m), size=3)]
            speeds += [float(n * (1 + rng.choice([-1, 0, 1]) * 10 ** rng.uniform(-16, -1))) for n in near]
        found = rc.response(rig, angular_speed=speeds, support_radius=radius)
        tally.systems += 1
        for j, n in enumerate(speeds):
            if found.resonant[j]:
                continue
            y, pull = pencil.forced(mp.mpf(n), mp.mpf(radius), mp.mpf(system.stiffness[1]))
            largest = max(abs(x) for x in y)
            for pin in range(system.size + 1):
                error = (y[pin] - mp.mpf(float(found.offset[j, pin]))) / largest
                tally.compare(error, float(found.error_bound[j]), (i, n, pin))
            tally.compare(pull - mp.mpf(float(found.support_force[j])), float(found.support_force_error[j]), (i, n, "force"))
    tally.finish(4)


@BY
@pytest.mark.parametrize("wheels", [0, 1], ids=["swing", "whirl"])
def test_swing(by, wheels):
    """Long after the start, where a change of a frequency in its last digit would show."""
    tally = Tally(f"{'whirl_swing' if wheels else 'swing'} by {by}")
    for i, rng in samples(25, 4 + wheels):
        system = System(rng, by, most_links=3 if wheels else int(rng.choice([2, 4, 12], p=[0.6, 0.3, 0.1])), extreme=False)
        if wheels and not system.rho.any():
            system.h, system.rho = system.a * 0.6, system.a * 0.3
            system.hf, system.rf = system.h, system.rho
            system.chain = rc.Chain(**{by: system.heavy}, length=system.a, centroid=system.h, radius_of_gyration=system.rho)
        whole = system.whole * power(rng, 1)
        rig = system.rig(rng, wheels=wheels, inverted=0, carriage=whole)
        if rig.fluid == "turning":
            continue
        yields = math.isfinite(system.stiffness[1])
        system.axial = [mp.mpf(0)] * system.size  # links do not turn about themselves as they swing
        pencil, moving, m = system.pencil(), system.size + yields, rc.modes(rig)
        slow = min(abs(m.angular_speed))
        start = np.zeros((2, system.size + 1), dtype=complex if wheels else float)
        start[:, :moving] = rng.normal(size=(2, moving))
        if wheels:
            start[:, :moving] += 1j * rng.normal(size=(2, moving))
        start[1] *= slow
        times = [float(t) for t in power(rng, 4, 3) / slow]
        try:
            found = rc.swing(rig, times, offset=start[0], velocity=start[1])
        except ValueError:  # something does not draw it back
            tally.refused += 1
            continue
        tally.systems += 1
        number = (lambda x: mp.mpc(complex(x))) if wheels else (lambda x: mp.mpf(float(x)))
        given = (*([number(x) for x in row[:moving]] for row in start), [mp.mpf(t) for t in times])
        truth = pencil.whirled(*given, found.angular_frequency) if wheels else pencil.swung(*given)
        for j, offsets in enumerate(truth):
            for pin, y in enumerate(offsets):
                bound = float(found.error_bound[j] + found.truncation_error[pin])
                tally.compare(abs(y - number(found.offset[j, pin])), bound, (i, times[j], pin))
    tally.finish(2)


def test_spring_by_mass():
    """One point mass under a spring with a carriage: the quadratic of its two heights."""
    tally = Tally("one mass under a spring")
    for i, rng in samples(300, 6):
        mass, length, carriage = rng.uniform(0.5, 3, 3)
        stiffness = 30 * rng.uniform(0.5, 3)
        m = rc.modes(rc.Rig(rc.Chain(mass=mass, length=length), support=rc.Support(stiffness=stiffness, mass=carriage)))
        tally.systems += 1
        w, a, c, k, g = (mp.mpf(float(x)) for x in (mass, length, carriage, stiffness, G))
        # (g w/a - s w)(k + g w/a - s c) = (g w/a)^2 in s = n^2
        one, two, three = w * c, -(w * k + g * w / a * (w + c)), g * w / a * k
        root = mp.sqrt(two**2 - 4 * one * three)
        for height, bound, square in zip(m.conical_height, m.error_bound, (-two - root, -two + root), strict=True):
            truth = g / (square / (2 * one))
            tally.compare(mp.mpf(float(height)) / truth - 1, float(bound), (i, float(height)))
    tally.finish(2)


@pytest.mark.parametrize("by", ["momentum", "spin"])
def test_top_near_its_limit(by):
    """A standing link with a wheel just fast enough: 1e-9 from the least momentum the square root of a small number."""
    tally = Tally(f"top near its limit by {by}")
    for i, rng in samples(60, 7):
        mass, length = (1.0, 0.3) if i == 0 else (float(x) for x in rng.uniform(0.2, 3, 2))
        least = 2 * math.sqrt(mass * length**2 * mass * G * length)
        momentum = least * (1 + (1e-9 if i == 0 else 10 ** rng.uniform(-12, -6)))
        if by == "momentum":
            wheel, H = rc.Flywheel(momentum=momentum), mp.mpf(momentum)
        else:
            heavy, radius = mass / 3, length / 7
            spin = momentum / (heavy * radius**2)
            wheel = rc.Flywheel(mass=heavy, radius_of_gyration=radius, spin=spin)
            H = mp.mpf(heavy) * mp.mpf(radius) ** 2 * mp.mpf(spin)
        m = rc.modes(rc.Rig(rc.Chain(mass=mass, length=length), flywheels=wheel, inverted=True))
        w, a, g = mp.mpf(mass), mp.mpf(length), mp.mpf(G)
        roots = [(H + sign * mp.sqrt(H**2 - 4 * w * a**2 * w * g * a)) / (2 * w * a**2) for sign in (-1, 1)]
        tally.systems += 1
        assert len(m) == 2 or not m.complete or len(m.other)
        for n, height, bound, off in zip(m.angular_speed, m.conical_height, m.error_bound, m.speed_error_bound, strict=True):
            truth = min(roots, key=lambda x, n=n: abs(abs(x) - abs(n)))
            tally.compare(mp.mpf(float(height)) * truth**2 / g - 1, float(bound), (i, "height"))
            tally.compare(abs(mp.mpf(float(n)) / truth) - 1, float(off), (i, "speed"))
    tally.finish(4)


@BY
def test_steady_shapes_of_rigs(by):
    tally = Tally(f"steady shapes of rigs by {by}")
    for i, rng in samples(25, 8):
        system = System(rng, by, most_links=4, extreme=False)
        radius = float(rng.choice([0.0, system.long * rng.uniform(0.05, 0.5)]))
        rig = system.rig(rng, spring=0.7, most=1, radius=radius)
        sense = -1 if rig.has_momentum and rng.random() < 0.5 else 1
        speed = float(sense * math.sqrt(G / system.long) * 10 ** rng.uniform(-0.3, 0.7))
        try:
            found = rc.steady_shapes(rig, angular_speed=speed, budget=3000)
        except ValueError:  # an effective tension that vanishes
            tally.refused += 1
            continue
        tally.systems += 1
        for k, shape in enumerate(found[:4]):
            if not math.isfinite(shape.error_bound) or shape.error_bound > 1e-9:
                continue
            start = [mp.mpf(float(x)) for x in shape.inclination]
            start += [mp.mpf(float(shape.offset[-1]))] * math.isfinite(system.stiffness[1])
            truth = newton(lambda x, s=system, r=radius, n=speed: s.figure(mp.mpf(n), r, x), start)
            for m in range(system.size):
                tally.compare(truth[m] - start[m], float(shape.error_bound), (i, k, m))
    tally.finish(0.5)


@BY
def test_steady_shapes_of_held_chains(by):
    """Between firm ends, on arms and on springs; under a tension the shape is that of the span it has."""
    tally = Tally(f"steady shapes of held chains by {by}")
    for i, rng in samples(25, 9):
        system = System(rng, by, most_links=5, extreme=False)
        if system.size < 2:
            continue
        weightless, ends, radii = bool(rng.random() < 0.3), {}, [0.0, 0.0]
        system.unit = G if weightless else system.unit
        tension = None
        if rng.random() < 0.3:
            tension = float(system.unit * system.whole * rng.uniform(1.2, 8))
        for above, name in enumerate(("lower", "upper")):
            if rng.random() < 0.5:
                radii[above] = 0.0 if tension else float(system.long * rng.uniform(0, 0.2))
                ends[name] = system.spring(rng, above, most=1, radius=radii[above])
        how = {"tension": tension} if tension else {"span": float(system.long * rng.uniform(0.3, 0.9))}
        held = rc.Held(system.chain, weightless=weightless, **how, **ends)
        speed = float(math.sqrt(G / system.long) * 10 ** rng.uniform(0.3, 1))
        found = rc.steady_shapes(held, angular_speed=speed, budget=0)
        tally.systems += 1
        for k, shape in enumerate(found):
            if not shape.proved:
                continue
            truth = polished(held, speed, shape, digits=60, span=shape.span)
            for m in range(system.size):
                tally.compare(truth[m] - mp.mpf(float(shape.inclination[m])), float(shape.error_bound), (i, k, m))
    tally.finish(0.5)
