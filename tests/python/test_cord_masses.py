# SPDX-License-Identifier: GPL-3.0-or-later
"""Cords with point masses, jumps and a bob: against Bessel functions piece by piece, and against chains."""

import importlib.util
import math
import pickle
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from scipy.special import j0, j1, y0, y1
from tier import by_tier

import revchain as rc

_spec = importlib.util.spec_from_file_location("expected_cords", Path(__file__).parents[1] / "data" / "expected_cords.py")
expected_cords = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(expected_cords)


class Pieces(expected_cords.Pieces):
    """The reference for a `Cord`, from which it takes its numbers."""

    def __init__(self, cord):
        bob = cord.tip_centroid, cord.tip_radius_of_gyration
        super().__init__(cord.length, cord.mass, cord.masses.items(), cord.tip_mass, *bob)

    def root(self, guess):
        with mp.workdps(32):
            return self.near(float(guess))

    def error(self, height):
        with mp.workdps(32):
            return float(abs(mp.mpf(float(height)) / self.root(height) - 1))


def random_cord(rng, bob=None):
    length, mass = 10 ** rng.uniform(-1, 1), 10 ** rng.uniform(-2, 2)
    masses = {rng.uniform(0.01, 0.99) * length: mass * 10 ** rng.uniform(-2, 2) for _ in range(rng.integers(1, 5))}
    tip = {"tip_mass": mass * 10 ** rng.uniform(-2, 2)} if rng.random() < 0.7 or bob else {}
    if bob:
        tip |= {"tip_centroid": length * 10 ** rng.uniform(-3, 0), "tip_radius_of_gyration": length * 10 ** rng.uniform(-3, 0)}
    return rc.Cord(length, mass=mass, masses=masses, **tip)


@pytest.mark.parametrize("bob", [False, True])
def test_random_cords_against_bessel_functions(bob):
    rng = np.random.default_rng(11 + bob)
    for _ in range(by_tier(6, 60)):
        cord = random_cord(rng, bob)
        modes = rc.modes(cord, 5)
        for j, height in enumerate(modes.conical_height):
            assert Pieces(cord).error(height) <= modes.error_bound[j], (cord._data(), j)
            for factor, count in ((1 - 1e-9, j + 1), (1 + 1e-9, j)):
                assert rc.count_modes(cord, conical_height=height * factor) == count
    assert modes.method == "power series"


def signs_at_support(cord, speeds):
    """Whether the offset at the support is positive, in doubles, for many values of 1/sqrt(height) at once."""
    height, line = speeds**-2.0, cord.mass / cord.length
    below, at, (h, k) = cord.tip_mass, 0.0, (cord.tip_centroid, cord.tip_radius_of_gyration)
    offset, pull = np.ones_like(height), -below / height
    if h:
        offset = height - (h + k * k / h)
        pull = -below / height * (offset + h)
    for place, mass in [*cord.masses.items(), (cord.length, 0.0)]:
        above = below + line * (place - at)
        x, y = (2 * np.sqrt(v / (line * height)) for v in (below, above))
        bend = -pull * np.sqrt(height / (line * below)) if below else np.zeros_like(offset)  # a J1 + b Y1
        a, b = (offset, 0.0) if not below else (
            (bend * y0(x) - offset * y1(x)) * np.pi * x / 2,
            (offset * j1(x) - bend * j0(x)) * np.pi * x / 2,
        )
        offset = a * j0(y) + b * y0(y)
        pull = -np.sqrt(line * above / height) * (a * j1(y) + b * y1(y)) - mass / height * offset
        below, at = above + mass, place
    return offset > 0


def test_no_mode_is_left_out():
    """Sign changes of the offset at the support, on a fine grid of speeds."""
    rng = np.random.default_rng(3)
    for k in range(by_tier(20, 200)):
        cord = random_cord(rng, k % 2 == 1)
        last = 1 / np.sqrt(rc.modes(cord, 4).conical_height[-1])
        fine = np.union1d(np.geomspace(1e-6, 1, 20_000), np.linspace(1e-3, 1, 20_000)) * last * (1 + 1e-9)
        turns = signs_at_support(cord, fine)
        assert (turns[1:] != turns[:-1]).sum() == 4, cord._data()


def test_the_bob_of_the_docstring():
    bob = rc.Cord(1.5, mass=0.05, tip_mass=0.2, tip_centroid=0.02, tip_radius_of_gyration=0.03)
    modes = rc.modes(bob, 3, gravity=9.81)
    assert np.allclose(modes.angular_speed, [2.58768689, 14.32558212, 17.92812052], rtol=0, atol=5e-9)
    pieces = Pieces(bob)
    for height, slope in zip(modes.conical_height, modes.bob_slope, strict=True):
        exact = pieces.root(height)
        assert slope == pytest.approx(float(-1 / (exact - mp.mpf("0.065"))), rel=1e-11)


def test_a_clasp_of_finite_width_and_one_of_none():
    """Breaks give the same as the function alone with fewer calls; a narrow clasp tends to a point mass, as its width."""
    calls = []

    def density(s, wide, heavy):
        calls.append(s)
        return 0.01003 + (heavy / wide if abs(s - 1.2173) < wide / 2 else 0.0)

    def speeds(wide, breaks):
        calls.clear()
        ends = [1.2173 - wide / 2, 1.2173 + wide / 2] if breaks else None
        cord = rc.Cord(1.8, density=lambda s: density(s, wide, 0.006), tip_mass=0.05, breaks=ends)
        return rc.modes(cord, 3).angular_speed, len(calls)

    alone, many = speeds(0.02, False)
    broken, few = speeds(0.02, True)
    assert alone == pytest.approx(broken, rel=1e-13)
    assert broken[1] == pytest.approx(11.3165088, abs=1e-6)
    assert few < many / 2
    point = rc.modes(rc.Cord(1.8, mass=0.01003 * 1.8, tip_mass=0.05, masses={1.2173: 0.006}), 3).angular_speed
    for wide in (1e-3, 1e-5, 1e-7):  # narrower than the grid on which a function is looked at
        assert speeds(wide, True)[0] == pytest.approx(point, rel=0.2 * wide + 3e-14)


def test_shapes_along_the_cord():
    """Offsets, slopes on both sides of a mass, nodes, and vertical points, against the Bessel functions."""
    rng = np.random.default_rng(8)
    for k in range(by_tier(2, 8)):
        cord = random_cord(rng, k % 2 == 1)
        modes = rc.modes(cord, 4)
        for j in range(4):
            pieces = Pieces(cord)
            exact = mp.mpf(float(modes.conical_height[j]))
            tip = pieces.start(exact)[0]
            largest = np.abs(modes.along(np.linspace(0, cord.length, 400))[j]).max()
            for place, below, offset, pull in list(pieces.states(exact))[:-1]:
                mass = dict(pieces.masses)[place]
                above = (pull - mass / exact * offset) / (below + mass)
                steep = max(abs(float(above / tip)), largest / cord.length)
                assert modes.along(float(place))[j] == pytest.approx(float(offset / tip), abs=1e-11 * largest)
                assert modes.slope(float(place))[j] == pytest.approx(float(above / tip), abs=1e-10 * steep)
                before = modes.slope(float(place) * (1 - 1e-13))[j]
                steep = max(abs(float(pull / below / tip)), largest / cord.length)
                assert before == pytest.approx(float(pull / below / tip), abs=1e-9 * steep)
            for node in modes.nodes[j]:
                assert abs(modes.along(node)[j]) <= 1e-10 * largest
            for place in modes.vertical_points[j]:
                near = [float(modes.slope(place * (1 + e))[j]) for e in (-1e-9, 1e-9)]
                assert near[0] * near[1] <= 0 or max(map(abs, near)) < 1e-6 * largest / cord.length


def richardson(system, counts, value):
    """Values of chains of equal links, of which errors fall as 1/count^2 and 1/count^4."""
    a, b, c = (np.asarray(value(system.chain(n))) for n in counts)
    ab, bc = (4 * b - a) / 3, (4 * c - b) / 3
    return (16 * bc - ab) / 15


@pytest.mark.parametrize(
    "cord",
    [
        rc.Cord(2.0, mass=0.3, masses={0.5: 0.2, 1.25: 0.4}, tip_mass=0.1),
        rc.Cord(2.0, mass=0.3, masses={1.0: 1.0}),
        rc.Cord(2.0, weight=0.3, weights={0.5: 0.2}, tip_weight=0.1, tip_centroid=0.05, tip_radius_of_gyration=0.04),
        rc.Cord(2.0, mass=0.3, density=1.0, masses={0.5: 0.2}, tip_mass=0.2),
    ],
)
def test_chains_tend_to_the_cord(cord):
    found = rc.modes(cord, 3).conical_height
    tends = richardson(cord, (320, 640, 1280), lambda chain: rc.modes(chain, 3).conical_height)
    assert found == pytest.approx(tends, rel=1e-9)


@pytest.mark.parametrize("speed", [5.0, 9.0, 14.0])
def test_shapes_and_stability_are_limits_of_chains(speed):
    cord = rc.Cord(2.0, mass=0.3, masses={0.5: 0.2, 1.25: 0.4}, tip_mass=0.1)
    found = rc.steady_shapes(cord, angular_speed=speed)
    counts = (40, 80, 160)

    def of(chain):
        shapes = rc.steady_shapes(chain, angular_speed=speed)
        assert len(shapes) == len(found)
        return [[s.offset[0], s.tension[-1]] for s in shapes]

    tends = richardson(cord, counts, of)
    few_links = rc.steady_shapes(cord.chain(40), angular_speed=speed)
    for shape, links, (offset, tension) in zip(found, few_links, tends, strict=True):
        place = shape.along([0.5, 1.25, 2.0])
        assert shape.offset[0] == pytest.approx(offset, rel=2e-6)
        assert place.tension[-1] == pytest.approx(tension, rel=2e-6)
        assert shape.residual < 1e-13
        slow = np.sort(np.abs(shape.stability().exponents.imag))
        few = np.sort(np.abs(links.stability().exponents.imag))
        assert slow[:6] == pytest.approx(few[:6], abs=2e-2 * speed)


def test_sensitivity_to_masses():
    """Differences of heights; heights depend on ratios of weights alone."""
    cord = rc.Cord(2.0, mass=0.3, masses={0.5: 0.2, 1.25: 0.4}, tip_mass=0.1)
    rates = rc.modes(cord, 3).sensitivity
    assert rates["masses"].shape == (3, 2)

    def height(**changed):
        given = {"mass": 0.3, "masses": {0.5: 0.2, 1.25: 0.4}, "tip_mass": 0.1} | changed
        return rc.modes(rc.Cord(2.0, **given), 3).conical_height

    step = 1e-5
    for i, s in enumerate((0.5, 1.25)):
        low, high = (height(masses=cord.masses | {s: cord.masses[s] + d}) for d in (-step, step))
        assert rates["masses"][:, i] == pytest.approx((high - low) / (2 * step), rel=1e-7, abs=1e-9)
    low, high = (height(mass=0.3 + d) for d in (-step, step))
    assert rates["mass"] == pytest.approx((high - low) / (2 * step), rel=1e-7, abs=1e-9)


def test_swing_begins_as_it_was_released():
    cord = rc.Cord(2.0, mass=0.3, masses={1.0: 1.0}, tip_mass=0.1)
    arc = np.linspace(0, 2, 41)
    start = 0.01 * (2 - arc)
    motion = rc.swing(cord, [0.0, 0.3], offset=start, arc_length=arc, count=60)
    assert motion.offset[0] == pytest.approx(start, abs=3e-5)
    links = cord.chain(400)
    of_links = rc.swing(links, [0.3], offset=0.01 * (2 - np.linspace(0, 2, 401)))
    assert motion.offset[1] == pytest.approx(of_links.offset[0][::10], abs=3e-5)


def test_what_a_cord_keeps():
    cord = rc.Cord(2.0, mass=0.3, masses={1.25: 0.4, 0.5: 0.2}, tip_mass=0.1, tip_centroid=0.05, tip_radius_of_gyration=0.04)
    assert cord.masses == {0.5: 0.2, 1.25: 0.4} and list(cord.masses) == [0.5, 1.25]
    assert pickle.loads(pickle.dumps(cord)) == cord
    assert rc.Cord._from_data(cord._data()) == cord
    assert cord != rc.Cord(2.0, mass=0.3, tip_mass=0.1)
    assert rc.Cord("2 m", mass="300 g", masses={"50 cm": "200 g", "1.25 m": 0.4}) == rc.Cord(2.0, mass=0.3, masses=cord.masses)
    assert "bob 0.1" in repr(cord) and "carrying 0.6 at 2 places" in repr(cord)
    assert "0.05 m below the end" in cord.describe() and "at 1.25 m: 0.4 kg" in cord.describe()
    other = rc.Cord(2.0, mass=0.3, density=lambda s: 1 if s < 1 else 3, breaks=[1.0], masses={0.5: 0.2})
    assert pickle.loads(pickle.dumps(other)) == other
    assert rc.modes(pickle.loads(pickle.dumps(other)), 2).conical_height.tolist() == rc.modes(other, 2).conical_height.tolist()
    with pytest.raises(AttributeError, match="has no weights"):
        _ = cord.weights


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"masses": {0.0: 1.0}}, r"places of masses must lie between .* below the length, 2 .*is the tip\), got 0"),
        ({"masses": {2.0: 1.0}}, r"places of masses must lie between .* got 2$"),
        ({"masses": {1.0: -1.0}}, r"masses\[1\] must be finite and not negative, got -1"),
        ({"masses": [0.5, 1.0]}, r"masses must map distances from the free end to masses"),
        ({"weights": {1.0: 1.0}}, r"give masses for a cord given by mass"),
        ({"breaks": [1.0]}, r"breaks are for a density that is a function; leave them out, got \[1.0\] beside density 0"),
        ({"density": lambda s: 1.0, "breaks": [0.0]}, r"breaks must be positive"),
        ({"density": lambda s: 1.0, "breaks": [3.0]}, r"breaks must lie between .*got 3"),
        ({"tip_mass": 1.0, "tip_radius_of_gyration": 0.1}, r"tip_radius_of_gyration needs a tip_centroid above 0"),
        ({"tip_centroid": 0.1}, r"tip_centroid needs a tip_mass above 0"),
        ({"tip_mass": 1.0, "tip_centroid": 1e50}, r"tip_centroid must be at most 100000 lengths of the cord .*got 1e\+50"),
        ({"tip_mass": 1.0, "tip_centroid": 0.1, "tip_radius_of_gyration": 3e5}, r"tip_radius_of_gyration must be at most"),
    ],
)
def test_wrong_cords(given, message):
    with pytest.raises(ValueError, match=message):
        rc.Cord(2.0, **({"mass": 1.0} | given))


def test_masses_at_one_place_are_added():
    added = rc.Cord(2.0, mass=1.0, masses={0.5: 1.0, "50 cm": "2 kg", 1.5: 4.0})
    assert added.masses == {0.5: 3.0, 1.5: 4.0} and added == rc.Cord(2.0, mass=1.0, masses={0.5: 3.0, 1.5: 4.0})
    at = [{"arc_length": 0.5, "mass": 1}, {"arc_length": "50 cm", "mass": 2}, {"arc_length": 1.5, "mass": 4}]
    assert rc.Scene.from_dict({"cord": {"length": 2, "mass": 1, "masses": at}}).system() == added


@pytest.mark.parametrize("given", [{"masses": {1.0: 1e200}}, {"masses": {1.0: 1e60}, "tip_mass": 1e60}])
def test_masses_beyond_all_measure_are_named(given):
    with pytest.raises(ValueError, match="modes: masses, tip or bob are too far from the cord's own mass and length to follow mode"):
        rc.modes(rc.Cord(2.0, mass=1.0, **given)).nodes


@pytest.mark.parametrize(
    "ask",
    [
        lambda cord: rc.steady_shapes(cord, angular_speed=9.0),
        lambda cord: rc.branches(cord, max_angular_speed=9.0),
        lambda cord: rc.swing(cord, [0.0], offset=lambda s: 2 - s),
        lambda cord: rc.modes(cord, 2).sensitivity,
    ],
)
def test_a_bob_has_small_motions_only(ask):
    cord = rc.Cord(2.0, mass=1.0, tip_mass=1.0, tip_centroid=0.1)
    with pytest.raises(ValueError, match=r"small motions only \(modes, count_modes\): cut it into links.*got 0.1"):
        ask(cord)
    assert len(rc.steady_shapes(cord.chain(20), angular_speed=9.0))
