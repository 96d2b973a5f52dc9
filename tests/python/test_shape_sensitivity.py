# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of steady shapes against differences of shapes found in 50 digits by Newton's method on the moments."""

import math

import mpmath as mp
import numpy as np
import pytest
import rigs
from mechanics import random_chain
from rigs import G

import revchain as rc



class Figure:
    """A steady shape of a rig and what may change, in 50 digits: Newton's method on the balance of its bodies. Data are
    by weight, columns as `rigs.columns` has them."""

    def __init__(self, rig, shape):
        rows = list(zip(*rigs.rows_of(rig), strict=True))
        self.data = dict(zip(vars(rigs.columns(rig)), rows, strict=True))
        self.size, self.turns = len(rig), rig.fluid == "turning"
        support = {"stiffness": rig.support.stiffness, "carriage": rig.support.carriage, "radius": rig.support.radius}
        self.slides = np.isfinite(rig.support.stiffness)
        self.data |= {name: [mp.mpf(value)] for name, value in support.items()}
        self.data["speed"] = [shape.direction * mp.sqrt(mp.mpf(G) / mp.mpf(float(shape.conical_height)))]
        self.start = [mp.mpf(float(x)) for x in [*shape.inclination, shape.offset[-1]]][: self.size + self.slides]
        self.slope = self.slopes()
        self.start = self.found(self.data)
        self.slope = self.slopes()

    def balance(self, data, place):
        rows = list(zip(*list(data.values())[:10], strict=True))
        held = {name: data[name][0] for name in ("radius", "stiffness", "carriage") if self.slides or name == "radius"}
        return rigs.balance(rows, data["speed"][0], place, self.turns, **held)

    def slopes(self):
        step, each = mp.mpf(10) ** -22, []
        for i in range(len(self.start)):
            moved = ([x + by * (i == j) for j, x in enumerate(self.start)] for by in (step, -step))
            ends = [self.balance(self.data, place)[0] for place in moved]
            each.append([(x - y) / (2 * step) for x, y in zip(*ends, strict=True)])
        return mp.matrix(each).T

    def found(self, data):
        place = self.start
        for _ in range(6):
            change = mp.lu_solve(self.slope, mp.matrix(self.balance(data, place)[0]))
            place = [x - y for x, y in zip(place, change, strict=True)]
        return place

    def numbers(self, data):
        """Inclinations, offsets of the pins, tensions."""
        place = self.found(data)
        _, pull, hung = self.balance(data, place)
        offset = [place[self.size] if self.slides else data["radius"][0]]
        for m in reversed(range(self.size)):
            offset.insert(0, offset[0] + data["a"][m] * mp.sin(place[m]))
        return place[: self.size], offset, [mp.hypot(x, y) for x, y in zip(pull, hung, strict=True)]

    def derivative(self, name, link, sign=1):
        step = mp.mpf(10) ** -14

        def moved(by):
            return self.numbers(self.data | {name: [x + by * (k == link) for k, x in enumerate(self.data[name])]})

        ends = [moved(step), moved(-step)]
        return [np.array([float(sign * (x - y) / (2 * step)) for x, y in zip(*pair, strict=True)])
                for pair in zip(*ends, strict=True)]  # fmt: skip


OF_RIG = {
    "mass": "w", "length": "a", "centroid": "h", "radius_of_gyration": "rho", "momentum": "p", "axial_moment": "c",
    "displaced_mass": "fluid", "added_mass": "added",
}  # fmt: skip
OF_CHAIN = ("mass", "length", "centroid", "radius_of_gyration")
OF_SUPPORT = {"stiffness": "stiffness", "support_mass": "carriage", "support_radius": "radius", "angular_speed": "speed"}


def check(rig, shape, per=1.0):
    """Derivatives of a shape against differences; `per`: newtons for one of the weights of `rig`."""
    with mp.workdps(50):
        figure, size, expected = Figure(rig, shape), len(rig), {}
        for name, key in OF_SUPPORT.items():
            if figure.slides or name not in ("stiffness", "support_mass"):
                expected[name] = figure.derivative(key, 0, shape.direction if name == "angular_speed" else 1)
        for name, key in OF_RIG.items():
            if (name != "added_mass" or not figure.turns) and (name in OF_CHAIN or shape.system is not rig.chain):
                each = [figure.derivative(key, m) for m in range(size)]
                expected[name] = [np.stack([of_link[q] for of_link in each], axis=1) for q in range(3)]
    worst = (0.0, "", "")
    for q, quantity in enumerate(("inclination", "offset", "tension")):
        found = getattr(shape.sensitivity, quantity)
        for name, values in expected.items():
            unit = (per if quantity == "tension" else 1.0) / (per if name in ("momentum", "stiffness") else 1.0)
            got, want = getattr(found, name), values[q] * unit
            assert got.shape == want.shape
            off = float(np.max(np.abs(got - want)) / max(1e-3, np.max(np.abs(want))))
            worst = max(worst, (off, quantity, name))
    assert worst[0] < 1e-13 * max(10.0, float(shape.condition)), worst
    one = shape.sensitivity.inclination
    share = sum(getattr(one, name) * getattr(rig.chain, name) for name in OF_CHAIN[1:])
    np.testing.assert_allclose(one.length_in_proportion * rig.chain.length, share, rtol=1e-12, atol=1e-14)


def random_rig(kind, size, seed):
    rng = np.random.default_rng([seed, size])
    given = {"chain": rigs.random_chain(rng, size, 1.0, plummets=seed % 3 == 0)}
    weight, length = given["chain"].weight, given["chain"].length
    scale = weight.sum() * length.sum()
    if "spring" in kind:
        given |= {"stiffness": weight.sum() / length.sum() * rng.uniform(2, 9), "carriage": weight.sum() * rng.uniform(0, 1)}
    if "arm" in kind:
        given["radius"] = rng.uniform(0.1, 2)
    if "wheels" in kind:
        given |= {"momentum": scale * rng.uniform(-0.3, 0.3, size), "axial_moment": weight * length**2 * rng.uniform(0, 0.2, size)}
    if "fluid" in kind:
        given |= {"displaced": weight * rng.uniform(0.1, 0.7, size), "centroid": length * rng.uniform(0.3, 0.8, size)}
        given |= {"gyration": length * rng.uniform(0.1, 0.4, size)}
    if "still" in kind:
        given["added"] = weight * rng.uniform(0, 0.5, size)
    if "turning" in kind:
        given["fluid"] = "turning"
    if "standing" in kind:
        given["inverted"] = rng.random(size) < 0.5
    return rigs.rigged(**given)


KINDS = ("spring", "spring arm", "wheels", "wheels spring arm", "still fluid", "turning fluid spring", "standing",
         "wheels still fluid spring standing")  # fmt: skip


@pytest.mark.parametrize("kind", ["plummets", "rods", "bodies"])
@pytest.mark.parametrize("count", [1, 2, 4])
def test_against_differences_in_forty_digits(kind, count):
    chain = random_chain(kind, count, seed=11)
    height = float(rc.modes(chain).conical_height[0]) / 5
    shapes = rc.steady_shapes(chain, conical_height=height)
    assert len(shapes) > 0
    for shape in shapes[:3]:
        check(rc.Rig(chain), shape)


def test_carried_round_and_by_mass():
    links = {"length": [1.0, 5.0], "centroid": [0.4, 2.5], "radius_of_gyration": [0.3, 1.4]}
    rig = rc.Rig(rc.Chain(mass=[80.0, 3.0], **links), support=rc.Support(radius=4.0))
    for shape in rc.steady_shapes(rig, angular_speed="9 rpm"):
        check(rigs.rigged(rc.Chain(weight=[80.0, 3.0], **links), radius=4.0), shape, per=G)


def test_along_a_branch_and_scales():
    chain = rc.Chain.uniform_rods(60, length=2.0, mass=3.0)
    shape = rc.steady_shapes(chain, angular_speed=8.0)[0]
    s = shape.sensitivity
    near = [rc.steady_shapes(chain, angular_speed=8.0 + e)[0] for e in (-1e-4, 1e-4)]
    for name in ("inclination", "offset", "tension"):
        difference = (getattr(near[1], name) - getattr(near[0], name)) / 2e-4
        np.testing.assert_allclose(getattr(s, name).angular_speed, difference, rtol=1e-6, atol=1e-6)
    assert np.all(s.offset.angular_speed[-1] == 0) and np.all(s.offset.support_radius[-1] == 1)
    # masses act by their ratios, but on tensions; all lengths and gravity over speed squared scale alike
    np.testing.assert_allclose(s.inclination.mass @ chain.mass, 0, atol=1e-11)
    np.testing.assert_allclose(s.tension.mass @ chain.mass, shape.tension, rtol=1e-10)
    height_by_speed = -2 * shape.conical_height / shape.angular_speed
    by_height = s.offset.angular_speed / height_by_speed
    scaled = s.offset.length_in_proportion @ chain.length + by_height * shape.conical_height
    np.testing.assert_allclose(scaled, shape.offset, rtol=1e-9, atol=1e-11)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("size", [1, 3])
def test_of_rigs_against_differences_in_fifty_digits(kind, size):
    seen = 0
    for seed, faster in ((0, 3), (1, 9), (2, 6)):
        rig = random_rig(kind, size, seed)
        speed, direction = math.sqrt(faster * G / rig.chain.length.sum()), -1 if "wheels" in kind and seed else 1
        shapes = rc.steady_shapes(rig, angular_speed=speed, direction=direction)
        for shape in [x for x in shapes if x.condition < 1e6][-2:]:
            seen += 1
            check(rig, shape)
    assert seen


def test_of_rigs_by_mass_and_spin():
    chain = rc.Chain(mass=[2.0, 1.0], length=[0.6, 0.5], centroid=[0.3, 0.2], radius_of_gyration=[0.2, 0.1])
    given = {"stiffness": 200.0, "mass": 0.5, "radius": 0.1}
    wheels = {"mass": [0.4, 0.2], "radius_of_gyration": 0.3, "spin": [9.0, -4.0], "driven": [True, False]}

    def shape(support=given, wheels=wheels, **fluid):
        displaced = rc.Displaced(mass=[0.3, 0.2], added_mass=[0.1, 0.2])
        rig = rc.Rig(chain, support=rc.Support(**support), flywheels=rc.Flywheel(**wheels), displaced=displaced, **fluid)
        return next(x for x in rc.steady_shapes(rig, angular_speed=6.0) if x.half_waves == 1 and x.inclination[0] > 0)

    s = shape().sensitivity
    for name, step in (("stiffness", 1e-3), ("mass", 1e-5), ("radius", 1e-5)):
        ends = [shape(support=given | {name: given[name] + e}) for e in (step, -step)]
        field = {"mass": "support_mass", "radius": "support_radius"}.get(name, name)
        for part in ("inclination", "offset", "tension"):
            difference = (getattr(ends[0], part) - getattr(ends[1], part)) / (2 * step)
            np.testing.assert_allclose(getattr(getattr(s, part), field), difference, rtol=1e-7, atol=1e-9)
    ends = [shape(wheels=wheels | {"spin": [9.0 + e, -4.0]}) for e in (1e-4, -1e-4)]
    for part in ("inclination", "offset", "tension"):
        difference = (getattr(ends[0], part) - getattr(ends[1], part)) / 2e-4
        np.testing.assert_allclose(getattr(s, part).spin[:, 0], difference, rtol=1e-7, atol=1e-9)
