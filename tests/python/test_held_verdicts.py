# SPDX-License-Identifier: GPL-3.0-or-later
"""Verdicts on stability of what is held at both ends, in both frames, against motions integrated step by step
(support/motion_of_pins.py); cords against the limit of many links. By hand: ``python tests/python/test_held_verdicts.py 1500``
tries so many random systems."""

import math
import sys
from collections import Counter
from dataclasses import dataclass, field

import numpy as np
import pytest
from ends import G
from motion_of_pins import Motion, growth_rate, step_of

import revchain as rc
from revchain import Support

FRAMES = ("free", "driven")
GROWS = 1e-8  # rates, over the speed, that integration of 1e9 turns tells from none
COMPARED = 1e-6


# ---- systems


def random_end(rng, kind):
    radius = rng.choice([-1, 1]) * rng.uniform(0.05, 0.8) if "arm" in kind else 0.0
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
    axis = rng.random() < 0.25
    lower, upper = (random_end(rng, "axis" if axis else rng.choice(["axis", "arm", "spring", "spring on arm"])) for _ in range(2))
    chain = random_chain(rng, rng.integers(3, 7))
    width = upper.radius - lower.radius
    span = math.sqrt((rng.uniform(0.3, 0.95) * chain.total_length) ** 2 - min(width**2, 0.08 * chain.total_length**2))
    held = rc.Held(chain, span=span, lower=lower, upper=upper, weightless=bool(rng.random() < 0.1))
    return held, rng.uniform(2.0, 10.0)


def shapes_of(held, speed, most=3):
    given = {} if held.weightless else {"gravity": G}
    return rc.steady_shapes(held, angular_speed=speed, max_half_waves=most, budget=0, **given)


# ---- verdicts


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
        rate, negative = motion.growth_rate(), motion.negative_directions()
        verdict = "unstable" if rate > GROWS else "minimum" if negative == 0 else "spectrally stable"
        self.verdicts[stability.verdict] += 1
        if stability.verdict not in ("undecided", verdict) or stability.negative_directions != negative:
            self.differ.append((stability.verdict, verdict, rate, stability.growth_rate, negative, held))
        elif rate > COMPARED:
            self.worst = max(self.worst, abs(stability.growth_rate / rate - 1))

    def __str__(self):
        kinds = ("minimum", "spectrally stable", "unstable", "undecided")
        counted = ", ".join(f"{self.verdicts[kind]} {kind}" for kind in kinds)
        return "\n".join(
            [
                f"systems: {self.systems}",
                f"shapes: {self.shapes}, each free and driven",
                f"verdicts: {self.verdicts.total()} ({counted})",
                f"disagreements: {len(self.differ)}",
                f"growth rates: worst relative difference {self.worst:.1e}",
            ]
        )


def random_systems(number, seed=0):
    tally = Tally()
    for each in np.random.SeedSequence(seed).spawn(number):
        tally.add(*random_system(np.random.default_rng(each)))
    return tally


if __name__ == "__main__":
    found = random_systems(int(sys.argv[1]))
    print(found)
    for x in found.differ: print(x)
