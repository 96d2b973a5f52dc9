# SPDX-License-Identifier: GPL-3.0-or-later
"""Tuning of everything that people can change, against closed forms and random systems."""

import itertools
import math

import mpmath as mp
import numpy as np
import pytest
from rigs import random_chain

import revchain as rc

G = 9.80665
POINT = rc.Chain(mass=2.0, length=1.5)
PAIR = rc.Chain(mass=[1.0, 3.0], length=1.0)


def rig(chain=POINT, **given):
    return rc.Rig(chain, **given)


def carriage(n, m=2, a=1.5, e=90):
    """Of a point mass below a carriage: (e + k - M n^2) (k - m n^2) = k^2, k = m g / a."""
    k = m * mp.mpf(G) / a
    return (e + k - k**2 / (k - m * n**2)) / n**2


def momentum(n):
    """Of a gyrostat of 2 kg on a link of 1.5 m."""
    return (mp.mpf(4.5) * n**2 - 3 * mp.mpf(G)) / n


MASS, RADIUS, SPIN = mp.mpf(0.4), mp.mpf(0.3), 50
FIRM, SOFT, CARRIED = rig(), rig(support=rc.Support(stiffness=90.0)), rig(support=rc.Support(stiffness=90.0, mass=0.7))
SPUN, LED = (
    rig(flywheels=rc.Flywheel(mass=0.4, radius_of_gyration=0.3, spin=50.0, driven=driven)) for driven in (False, True)
)
FLOATING, MOVED = (rig(displaced=rc.Displaced(**given)) for given in ({"mass": 0.5}, {"mass": 0.0, "added_mass": 0.5}))
CLOSED = {  # system, path, mode, speed, the value in closed form
    "length on a spring": (SOFT, "length", 1, 2.0, lambda n: G / n**2 - 2 * mp.mpf(G) / 90),
    "mass on a spring": (SOFT, "mass", 1, 2.0, lambda n: (G / n**2 - mp.mpf(1.5)) * 90 / G),
    "the only link's mass": (SOFT, "links[0].mass", 1, 2.0, lambda n: (G / n**2 - mp.mpf(1.5)) * 90 / G),
    "carriage": (CARRIED, "support.mass", 1, 2.3, carriage),
    "carriage, faster mode": (CARRIED, "support.mass", 2, 11.0, carriage),
    "wheel's mass": (SPUN, "flywheels[0].mass", 1, 3.2, lambda n: momentum(n) / (RADIUS**2 * SPIN)),
    "wheel's radius": (SPUN, "flywheels[0].radius_of_gyration", 1, -2.4, lambda n: mp.sqrt(momentum(n) / (MASS * SPIN))),
    "spin": (SPUN, "flywheels[0].spin", 1, -2.4, lambda n: momentum(n) / (MASS * RADIUS**2)),
    "spin of a driven wheel": (LED, "flywheels[0].spin", 1, 3.2, lambda n: momentum(n) / (MASS * RADIUS**2) - n),
    "mass of a driven wheel": (LED, "flywheels[0].mass", 1, 3.2, lambda n: momentum(n) / (RADIUS**2 * (SPIN + n))),
    "float": (FLOATING, "displaced[0].mass", 1, 2.0, lambda n: 2 * (1 - n**2 * mp.mpf(1.5) / G)),
    "added mass": (MOVED, "displaced[0].added_mass", 1, 2.0, lambda n: 2 * mp.mpf(G) / (mp.mpf(1.5) * n**2) - 2),
    "tension": (rc.Held(PAIR, tension=60.0), "tension", 1, 7.0, lambda n: (3 * n**2 + 3 * mp.mpf(G)) / 2),
    "length under a tension": (rc.Held(PAIR, tension=60.0), "length", 1, 7.0, lambda n: 2 * (120 - 3 * mp.mpf(G)) / (3 * n**2)),
    "length of a cord": (rc.Cord(2.0, mass=1.0), "length", 1, 3.0, lambda n: G / n**2 * (mp.besseljzero(0, 1) / 2) ** 2),
}  # fmt: skip


@pytest.mark.parametrize("name", CLOSED)
def test_closed_forms(name):
    system, path, mode, speed, closed = CLOSED[name]
    found = rc.tune(system, vary=path, mode=mode, angular_speed=speed)
    assert found.status == "found" and type(found.system) is type(system)
    with mp.workdps(40):
        off = abs(mp.mpf(found.value) - closed(mp.mpf(speed)))
        bound = found.error_bound if found.error_bound is not None else 4e-15 * abs(found.value)
        assert off <= bound * (1 + 1e-9) and bound <= 3e-14 * abs(found.value), (off, bound)
    tuned = rc.modes(found.system)
    assert np.abs(tuned.angular_speed / speed - 1).min() < 4e-15
    by_height = rc.tune(system, vary=path, mode=mode, conical_height=G / speed**2)
    if speed > 0:
        assert by_height.value == pytest.approx(found.value, rel=2e-14)


@pytest.mark.parametrize(("vary", "present"), [("tip_mass", 0.3), ("mass", 1.0), ("length", 2.0)])
def test_a_cord_beside_its_tip(vary, present):
    """-M n^2 y = M g y' at the tip, y = 0 at the support; y of J0 and Y0 of 2 n sqrt((s + M/mu)/g)."""
    speed = 2.45
    found = rc.tune(rc.Cord(2.0, mass=1.0, tip_mass=0.3), vary=vary, angular_speed=speed)
    assert found.present == present and found.status == "found"
    cord = found.system

    def short(value):
        with mp.workdps(30):
            given = {"tip_mass": cord.tip_mass, "mass": cord.mass, "length": cord.length, vary: value}
            below = mp.mpf(given["tip_mass"]) * given["length"] / given["mass"]
            at = lambda s: 2 * speed * mp.sqrt((s + below) / G)  # noqa: E731
            tip, top = at(0), at(mp.mpf(given["length"]))
            slope = 2 * mp.mpf(speed) ** 2 / G / tip  # dz/ds
            # y = J0(z) + c Y0(z), y' + n^2/g y = 0 at the tip
            first = mp.besselj(0, tip) * speed**2 / G - mp.besselj(1, tip) * slope
            other = mp.bessely(0, tip) * speed**2 / G - mp.bessely(1, tip) * slope
            return mp.besselj(0, top) * other - mp.bessely(0, top) * first

    with mp.workdps(30):
        exact = mp.findroot(short, found.value)
        assert abs(exact - found.value) <= found.error_bound + 1e-20


PATHS = [
    "length", "mass", "links[1].mass", "links[0].length_in_proportion", "links[2].length", "links[1].centroid",
    "links[2].radius_of_gyration", "support.stiffness", "support.mass", "flywheels[1].momentum", "flywheels[1].spin",
    "flywheels[1].mass", "flywheels[1].radius_of_gyration", "displaced[0].mass", "displaced[2].added_mass",
    "displaced[1].centroid",
]  # fmt: skip


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("path", PATHS)
def test_what_was_changed_in_a_rig_is_found_again(path, seed):
    """Of random rigs of both directions, some with links that stand; its speed is that of the datum put back."""
    rng = np.random.default_rng(seed)
    bodies = random_chain(rng, 3, spread=0.7)
    mass, inner = bodies.weight, {"centroid": bodies.centroid, "radius_of_gyration": bodies.radius_of_gyration}
    whole = rc.Rig(
        rc.Chain(mass=mass, length=bodies.length, **inner),
        support=rc.Support(stiffness=60.0, mass=0.5),
        flywheels=rc.Flywheel(mass=0.3, radius_of_gyration=0.2, spin=rng.normal(size=3) * 40, driven=[True, False, False]),
        displaced=rc.Displaced(mass=0.05 * mass, added_mass=0.1 * mass, centroid=0.5 * bodies.length, radius_of_gyration=0.1),
        inverted=[bool(seed % 2), False, False],
    )
    start = rc.modes(whole)
    row = int(rng.integers(len(start)))
    speed, mode = float(start.angular_speed[row]), int(start.number[row])
    moves = (rc.tune(whole, vary=path, mode=mode, angular_speed=speed * share) for share in (1.01, 0.99))
    moved = next((found for found in moves if found.status == "found"), None)
    if moved is None:
        pytest.skip("this datum moves this mode by less than a hundredth")
    back = rc.tune(moved.system, vary=path, mode=mode, angular_speed=speed)
    assert back.status == "found" and back.present == moved.value
    bound = (back.error_bound or 1e-12 * abs(back.value)) + 1e-9 * abs(moved.present)
    assert np.abs(back.values - moved.present).min() <= bound
    again = rc.modes(back.system)
    same = (again.number == mode) & (again.direction == start.direction[row])
    assert again.angular_speed[same] == pytest.approx(speed, rel=1e-12)


@pytest.mark.parametrize("more", [{"pins": rc.Pin(stiffness=2.0)}, {"pins": rc.Pin(damping=0.5)}, {"drag": 0.3}])
def test_stiffness_and_momentum_beside_springs_and_dashpots_are_searched(more):
    def rig(stiffness, momentum):
        wheels = rc.Flywheel(momentum=[momentum, 0.1]) if momentum is not None else None
        support = rc.Support(stiffness=stiffness, mass=1.0)
        return rc.Rig(rc.Chain(mass=[1.0, 1.0], length=1.0), support=support, flywheels=wheels, **more)

    given = {"vary": "support.stiffness", "mode": 1, "angular_speed": rc.modes(rig(80.0, None)).angular_speed[0]}
    found = rc.tune(rig(50.0, None), **given)
    assert found.status == "found" and found.value == pytest.approx(80.0, rel=1e-12) and not found.complete
    if "pins" in more and more["pins"].damping is None:
        speeds = rc.modes(rig(80.0, 0.3)).angular_speed
        given = {"vary": "flywheels[0].momentum", "mode": 1, "angular_speed": speeds[speeds > 0][0]}
        assert rc.tune(rig(80.0, 0.2), **given).value == pytest.approx(0.3, rel=1e-12)
        with pytest.raises(ValueError, match="revchain.tune: give between, .* the present value is 0"):
            rc.tune(rig(80.0, 0.0), **given)


def test_a_value_past_a_jump_of_the_numbers_is_none():
    """Where a float lets links fall the modes that are left change their numbers: no value is there."""
    floating = rc.Rig(PAIR, support=rc.Support(stiffness=60.0, mass=0.5), flywheels=rc.Flywheel(momentum=[0.5, 0.0]), displaced=rc.Displaced(mass=0.1))
    for speed in np.linspace(1.7, 2.6, 10):
        found = rc.tune(floating, vary="displaced[0].mass", angular_speed=float(speed))
        if found.status == "found":
            modes = rc.modes(found.system)
            assert modes.angular_speed[(modes.number == 1) & (modes.direction == 1)] == pytest.approx(speed, rel=1e-14)


def test_where_to_look_and_what_was_seen():
    narrow = rc.tune(CARRIED, vary="support.mass", angular_speed=2.3, between=("1 kg", "20 kg"))
    assert narrow.between == (1.0, 20.0) and not narrow.complete
    none = rc.tune(CARRIED, vary="support.mass", angular_speed=3.0)
    assert none.status == "undecided" and none.system is None and none.reachable[0] > G / 9
    light = rc.modes(rig(support=rc.Support(stiffness=90.0, mass=0.7e-3)), 1)
    assert none.reachable[0] == pytest.approx(G / light.angular_speed[0] ** 2)
    same = rc.tune(rc.Cord(1.0, mass=1.0), vary="mass", angular_speed=3.0)  # nothing beside it
    assert same.status == "undecided" and same.reachable[0] == pytest.approx(same.reachable[1], rel=1e-15)
    firm = rc.tune(FIRM, vary="support.stiffness", angular_speed=2.0)
    assert firm.present == math.inf and firm.value == pytest.approx(2 * G / (G / 4 - 1.5), rel=1e-15)


@pytest.mark.parametrize(
    ("system", "given", "message"),
    [
        (FIRM, {"vary": "support.radius"}, "support.radius has no effect on the speeds of small oscillations"),
        (FIRM, {"vary": "links[0].weight"}, 'given by mass: vary "links\\[0\\].mass"'),
        (PAIR, {"vary": "mass"}, 'ratios alone; vary "links\\[k\\].mass"'),
        (FIRM, {"vary": "flywheels[0].spin"}, 'vary must be one of .*"flywheels\\[k\\].momentum", "gravity" of a Rig, got'),
        (FIRM, {"vary": "links[4].mass"}, "the highest is links\\[0\\]"),
        (CARRIED, {"vary": "support.mass", "mode": 3}, "mode must be from 1 to 2, the number of modes in a direction, got 3"),
        (rc.Held(PAIR, tension=60.0), {"vary": "tension", "mode": 3}, "mode must be from 1 to 1, the number of modes, got 3"),
        (rc.Held(PAIR, tension=60.0), {"vary": "span"}, 'vary must be one of .*"tension", "gravity" of a Held'),
        (rc.Held(PAIR, span=1.0), {"vary": "tension"}, "is bent.*give top_tension"),
        (rc.Held(PAIR, span=1.0), {"vary": "tension", "top_tension": 40.0}, 'vary must be one of .*"span", "gravity" of a Held'),
        (rc.Held(PAIR, span=1.0), {"vary": "span", "top_tension": -1.0}, "top_tension must be positive"),
        (PAIR, {"vary": "length", "top_tension": 40.0}, "top_tension is for a system held at a span; leave it out, got 40"),
        (rc.Cord(1.0), {"vary": "density"}, '"tip_mass", "gravity" of a Cord'),
        (CARRIED, {"vary": "support.mass", "between": 3}, "between must be a pair"),
        (CARRIED, {"vary": "support.mass", "between": ("1 m", 2)}, "mass \\(each end of between\\) must be a mass"),
        (CARRIED, {"vary": "support.mass", "between": (3.0, 2.0)}, "high end must exceed the low one, got 3 and 2"),
        (FIRM, {"vary": "support.stiffness", "between": (1.0, 2.0)}, "between is for a search, and support.stiffness has one value"),
        (rig(flywheels=rc.Flywheel(mass=0.0, radius_of_gyration=1.0, spin=0.0)), {"vary": "flywheels[0].spin"}, "has no moment of inertia"),
    ],
)  # fmt: skip
def test_questions_that_are_none(system, given, message):
    with pytest.raises(ValueError, match=f"^revchain.tune: .*{message}"):
        rc.tune(system, angular_speed=2.0, **given)


EXTREME = [10.0**power for power in (-300, -200, -150, -100, -30, 30, 100, 150, 200, 300)]


@pytest.mark.parametrize("name", CLOSED)
def test_no_speed_is_too_extreme_for_an_answer(name):
    """A value, none, or a sentence; no error of Python's numbers and no warning."""
    system, path, mode, _, _ = CLOSED[name]
    for quantity, size in itertools.product(("angular_speed", "conical_height"), EXTREME):
        try:
            found = rc.tune(system, vary=path, mode=mode, **{quantity: size})
            assert (found.status == "found") == (found.value is not None)
        except ValueError as error:
            assert str(error).startswith("revchain.tune: "), (quantity, size)


@pytest.mark.parametrize("wanted", [1e-160, 1e300])
def test_a_speed_without_a_conical_height_in_double_precision(wanted):
    for system in (PAIR, rc.Cord(2.0), rc.Rig(PAIR, support=rc.Support(stiffness=9.0))):
        for path in ("length", "links[0].length") if system is PAIR else ("length",):
            with pytest.raises(ValueError, match=r"gravity / angular_speed\*\*2 must be positive and finite, got (inf|0)"):
                rc.tune(system, vary=path, angular_speed=wanted)


def test_no_value_is_said_in_words():
    found = rc.tune(rc.Chain(mass=[1.0, 3.0], length=1.0), vary="links[0].length", mode=1, angular_speed="2 s")
    assert found.status == "no_value" and str(found).startswith("Tuned: no value of links[0].length in the range gives the speed")
