# SPDX-License-Identifier: GPL-3.0-or-later
"""Cords held at both ends: modes under a tension, branches and stability at a span; how modes of cords change with data."""

import json
import math
from time import process_time

import mpmath as mp
import numpy as np
import pytest
from mechanics import fourth_order

import revchain as rc

G = 9.80665
ROPE = rc.Cord(2.0, mass=0.2)
TAUT = rc.Held(ROPE, tension=10.0)
STRING = rc.Held(ROPE, tension=10.0, weightless=True)
BOWED = rc.Held(rc.Cord(2.0, mass=1.0), span=1.5)


def _height(cord, tension, number, gravity=G):
    """The conical height in 40 digits, by the zeros of a cross product of Bessel functions."""
    with mp.workdps(40):
        length = mp.mpf(cord.length)
        lower = (mp.mpf(tension) / mp.mpf(gravity) - mp.mpf(cord.mass)) / mp.mpf(cord.mass) * length
        ends = [2 * mp.sqrt(lower), 2 * mp.sqrt(lower + length)]

        def cross(root):
            low, high = (end * root for end in ends)
            return mp.besselj(0, low) * mp.bessely(0, high) - mp.bessely(0, low) * mp.besselj(0, high)

        start = number * mp.pi / (ends[1] - ends[0])
        return 1 / mp.findroot(cross, start * mp.mpf("0.999")) ** 2


@pytest.mark.parametrize("tension", [2.5, 10.0, 4000.0])
def test_modes_under_a_tension(tension):
    held = rc.Held(ROPE, tension=tension)
    m = rc.modes(held, 3, first=4)
    for number, height, bound in zip(m.number, m.conical_height, m.error_bound, strict=True):
        exact = _height(ROPE, tension, int(number))
        assert abs(float(height / exact - 1)) <= bound
    assert np.array_equal(rc.count_modes(held, conical_height=m.conical_height * (1 + 1e-13)), [3, 4, 5])
    assert np.array_equal(rc.modes(held, angular_speed=(0.0, float(m.angular_speed[0]) * 1.01)).number, [1, 2, 3, 4])
    again = type(m).from_dict(json.loads(json.dumps(m.to_dict()))) if hasattr(type(m), "from_dict") else m
    assert again is m or again == m
    ends = m.along([0.0, 2.0])
    np.testing.assert_allclose(ends, 0.0, atol=1e-14)
    assert m.slope(0.0).min() > 0
    for k in range(3):
        np.testing.assert_allclose(m.along(m.nodes[k])[k], 0.0, atol=1e-14)
        assert m.along(m.vertical_points[k])[k].max() == pytest.approx(1.0, abs=1e-14)
        # one below each node and one below the upper end
        edges = [0.0, *m.nodes[k], 2.0]
        assert all(low < x < high for low, x, high in zip(edges, m.vertical_points[k], edges[1:], strict=False))
    assert rc.explain(held, 2).chosen.name == m.method


def test_without_gravity_it_is_a_string():
    for g in (G, 1.62):
        m = rc.modes(STRING, 5, gravity=g)
        expected = np.arange(1, 6) * math.pi * math.sqrt(10.0 / (0.2 * 2.0))
        np.testing.assert_allclose(m.angular_speed, expected, rtol=1e-15)
        np.testing.assert_allclose(m.shape[2], np.sin(1.5 * np.pi * m.arc_length), atol=1e-14)
    with pytest.raises(ValueError, match="a system held by a tension in newtons has other modes"):
        m.with_gravity(3.0)
    assert rc.count_modes(STRING, angular_speed=[16.0, 32.0, 10.0]).tolist() == [1, 2, 0]
    by_weight = rc.Held(rc.Cord(2.0, weight=0.2), tension=10.0, weightless=True)  # 0.2 stands for a mass
    np.testing.assert_allclose(rc.modes(by_weight, 5).angular_speed, expected, rtol=1e-15)
    # two beads, 1 kg each, on a line of three parts
    beads = rc.Held(rc.Chain(mass=[1e-9, 1.0, 1.0], length=1.0), tension=5.0, weightless=True)
    first = rc.modes(beads, 2, gravity=3.0).angular_speed
    assert first[0] == pytest.approx(math.sqrt(5.0), rel=1e-8)
    assert rc.modes(beads, 2).angular_speed == pytest.approx(first, rel=1e-14)


@pytest.mark.parametrize("held", [TAUT, STRING], ids=["taut", "string"])
def test_tuned(held):
    for vary, mode, speed in (("length", 3, 50.0), ("mass", 1, 20.0), ("tension", 2, 45.0)):
        tuned = rc.tune(held, vary=vary, mode=mode, angular_speed=speed)
        assert tuned.status == "found" and tuned.complete and tuned.system.weightless == held.weightless
        assert rc.modes(tuned.system, 1, first=mode).angular_speed[0] == pytest.approx(speed, rel=1e-14)
    tension = rc.tune(STRING, vary="tension", angular_speed=10.0).value
    assert tension == pytest.approx((10.0 / math.pi) ** 2 * 0.4, rel=1e-14)
    with pytest.raises(ValueError, match='vary must be one of "length", "mass", "tension"'):
        rc.tune(held, vary="links[0].mass", angular_speed=9.0)
    chain = rc.tune(rc.Held(ROPE.chain(10), tension=10.0), vary="length", angular_speed=20.0)
    assert chain.complete and rc.modes(chain.system, 1).angular_speed[0] == pytest.approx(20.0, rel=1e-14)


def test_fitted():
    speeds = rc.modes(rc.Held(rc.Cord(2.0, mass=0.23), tension=12.0), 3).angular_speed
    measured = {k + 1: (float(x), 0.01) for k, x in enumerate(speeds)}
    found = rc.fit(rc.Held(rc.Cord(2.0, mass=0.23), tension=10.0), measured, vary="tension")
    np.testing.assert_allclose(found.value, [12.0], rtol=1e-8)
    # speeds depend on the ratio of the two
    assert rc.fit(TAUT, measured, vary=["tension", "mass"]).undetermined == (("tension", "mass"),)


# ---- at a span


def test_branches():
    branches = rc.branches(BOWED, max_angular_speed=20.0)
    assert [branch.mode for branch in branches] == [1, 2, 3, 4, 5, 6, 7]
    for branch in branches:
        assert branch.end == "folded" and not len(branch.folds) and branch.angular_speed[0] == pytest.approx(20.0)
        point = len(branch) // 5
        shape = branch.shape(point)
        same = rc.steady_shape(BOWED, mode=branch.mode, angular_speed=float(branch.angular_speed[point]))
        assert same.half_waves == branch.half_waves[point] or branch.mode > 3
        places = np.linspace(0.1, 1.9, 7)
        np.testing.assert_allclose(same.along(places).offset, shape.along(places).offset, atol=1e-12)
        assert same.moment_of_inertia == pytest.approx(branch.moment_of_inertia[point], rel=1e-10)
        listed = rc.steady_shapes(BOWED, angular_speed=float(same.angular_speed), max_half_waves=branch.mode)
        assert any(abs(each.moment_of_inertia / same.moment_of_inertia - 1) < 1e-9 for each in listed)
    # straight parts of 1.75 m and 0.25 m, each hung from its end, begin to whirl
    for branch, zero, part in zip(branches[:2], (2.404825557695773, 5.520078110286311), (1.75, 1.75), strict=True):
        slowest = zero / 2 * math.sqrt(G / part)
        assert slowest < branch.angular_speed[-1] < 1.06 * slowest
    assert rc.branch(BOWED, 2, max_angular_speed=20.0) == branches[1]
    pytest.importorskip("matplotlib")
    assert branches.plot().get_xlabel() == "speed (rad/s)"


def test_many_links_tend_to_the_branch():
    wanted = {"mode": 1, "top_tension": 50.0}
    cord = rc.steady_shape(BOWED, **wanted)
    chains = [rc.steady_shape(rc.Held(BOWED.system.chain(n), span=1.5), **wanted) for n in (40, 80)]
    few, many = (chain.angular_speed for chain in chains)
    assert (few - cord.angular_speed) / (many - cord.angular_speed) == pytest.approx(4.0, rel=0.01)
    few, many = (chain.moment_of_inertia for chain in chains)
    assert many + (many - few) / 3 == pytest.approx(cord.moment_of_inertia, rel=1e-6)


@pytest.mark.parametrize("system", [BOWED.system, BOWED.system.chain(12)], ids=["cord", "chain"])
def test_tuned_at_a_span(system):
    held = rc.Held(system, span=1.5)
    wider = float(rc.steady_shape(rc.Held(system, span=1.61), angular_speed=15.0).tension[-1])
    for vary, top, between in (("span", wider, (1.2, 1.8)), ("length", 55.0, (1.6, 3.0)), ("mass", 40.0, (0.5, 2.0))):
        tuned = rc.tune(held, vary=vary, mode=1, angular_speed=15.0, top_tension=top, between=between)
        assert tuned.status == "found" and not tuned.complete, vary
        shape = rc.steady_shape(tuned.system, mode=1, angular_speed=15.0)
        assert shape.tension[-1] == pytest.approx(top, rel=1e-10)
        assert vary != "span" or tuned.value == pytest.approx(1.61, rel=1e-9)
    # forces are as the mass
    assert tuned.value == pytest.approx(40.0 / rc.steady_shape(held, angular_speed=15.0).tension[-1], rel=1e-10)
    with pytest.raises(ValueError, match="without gravity"):
        light = rc.Held(system, span=1.5, weightless=True)
        rc.tune(light, vary="span", angular_speed=15.0, top_tension=50.0)


def test_a_tension_that_no_shape_has():
    """Less than half of what the ends bear of the weight: refused at once, with the number as it was given."""
    rope = rc.Held(rc.Cord(2.6, mass=0.15), span=1.2)
    least = 9.80665 * 0.15 / 2 * (1 + 1.2 / 2.6)
    for mode in (1, 2, 3):
        assert rc.steady_shape(rope, mode=mode, top_tension=1.01 * least).tension[-1] == pytest.approx(1.01 * least, rel=1e-9)
    began = process_time()
    with pytest.raises(ValueError, match=r"tune: no shape of the branch has this tension at its upper end; .*, got 0\.5$"):
        rc.tune(rope, vary="length", angular_speed="2 Hz", top_tension="0.5 N")
    assert process_time() - began < 2
    with pytest.raises(ValueError, match=r"steady_shape: no shape of the branch has this tension .*, got 1$"):
        rc.steady_shape(rope, top_tension="1 N")


# ---- derivatives


CORDS = {
    "uniform": rc.Cord(2.0, mass=0.5),
    "tip": rc.Cord(2.0, mass=0.5, tip_mass=0.1),
    "thicker": rc.Cord(2.0, mass=0.5, density=1.3),
    "thicker with a tip": rc.Cord(2.0, mass=0.5, density=1.3, tip_mass=0.1),
    "thinner": rc.Cord(2.0, weight=0.5, density=-0.4, tip_weight=0.02),
    "held": rc.Held(rc.Cord(2.0, mass=0.5), tension=7.0),
    "held hard": rc.Held(rc.Cord(2.0, weight=0.5), tension=70.0),
    "string": STRING,
}


def _changed(system, name, value):
    """The system with another number."""
    if isinstance(system, rc.Held):
        if name == "tension":
            return rc.Held(system.system, tension=value, weightless=system.weightless)
        return rc.Held(_changed(system.system, name, value), tension=system.tension, weightless=system.weightless)
    heavy = "mass" if system.by_mass else "weight"
    data = {"length": system.length, "mass": getattr(system, heavy), "tip_mass": getattr(system, f"tip_{heavy}")}
    data |= {"density": system.density, ("density" if name == "exponent" else name): value}
    return rc.Cord(data["length"], density=data["density"], **{heavy: data["mass"], f"tip_{heavy}": data["tip_mass"]})


@pytest.mark.parametrize("system", CORDS.values(), ids=CORDS.keys())
def test_sensitivity_against_differences(system):
    m = rc.modes(system, 3)
    held, cord = isinstance(system, rc.Held), getattr(system, "system", system)
    heavy = "mass" if system.by_mass else "weight"
    present = {"length": cord.length, "mass": getattr(cord, heavy)}
    present |= {"tension": system.tension} if held else {"tip_mass": getattr(cord, f"tip_{heavy}"), "exponent": cord.density}
    for name, value in present.items():
        if value == 0 and name == "tip_mass":
            continue
        step = 1e-3 * (value or 1.0)

        def heights(by, name=name, value=value):
            return rc.modes(_changed(system, name, value + by), 3).conical_height

        slope = fourth_order(heights, step)
        np.testing.assert_allclose(m.sensitivity[name] / m.conical_height, slope / m.conical_height, rtol=2e-9, atol=2e-10)
    relative = m.sensitivity.relative
    np.testing.assert_allclose(relative.length, 1.0, rtol=1e-14)
    np.testing.assert_allclose(relative.mass + relative.tip_mass + relative.tension, 0.0, atol=1e-12)


def test_sensitivity_of_a_density_function():
    power, function = (rc.Cord(2.0, mass=0.5, tip_mass=0.1, density=density) for density in (1.0, lambda s: s))
    one, other = (rc.modes(cord, 3).sensitivity for cord in (power, function))
    for name in ("length", "mass", "tip_mass"):
        np.testing.assert_allclose(one[name], other[name], rtol=1e-10)
    assert np.isnan(other.exponent).all() and np.isfinite(one.exponent).all()
    with pytest.raises(ValueError, match="was given as a function and has no exponent"):
        rc.modes(function, 1).uncertainty(exponent=0.1)


def test_sensitivity_in_forty_digits():
    """To 1e-12 of the height over the datum, by heights from zeros of Bessel functions."""

    def check(found, height, value):
        """`height(x)`: with this datum at x."""
        with mp.workdps(40):
            x, step = mp.mpf(value), mp.mpf(10) ** -9
            slope = mp.fdot((1, -8, 8, -1), [height(x * (1 + step * k)) for k in (-2, -1, 1, 2)]) / (12 * x * step)
            assert abs(mp.mpf(float(found)) - slope) * x <= 1e-12 * height(x)

    def root(f, guess):
        return mp.findroot(f, (mp.mpf(guess) * (1 - mp.mpf(10) ** -8), mp.mpf(guess)))

    length, mass, tip = 1.3, 2.0, 0.3
    m = rc.modes(rc.Cord(length, mass=mass, tip_mass=tip), 1, first=2)

    def with_tip(mass, tip):
        def cross(x):
            low, high = 2 * mp.sqrt(length * tip / mass / x), 2 * mp.sqrt(length * (tip / mass + 1) / x)
            return mp.bessely(2, low) * mp.besselj(0, high) - mp.besselj(2, low) * mp.bessely(0, high)

        return root(cross, float(m.conical_height[0]))

    check(m.sensitivity.mass[0], lambda x: with_tip(x, mp.mpf(tip)), mass)
    check(m.sensitivity.tip_mass[0], lambda x: with_tip(mp.mpf(mass), x), tip)
    for power in (0.1, 2.0):
        m = rc.modes(rc.Cord(1.0, density=power), 1, first=3)
        zero = 2 * math.sqrt((power + 1) / m.conical_height[0])
        check(m.sensitivity.exponent[0], lambda x, z=zero: 4 * (x + 1) / root(lambda y: mp.besselj(x, y), z) ** 2, power)
    check(rc.modes(TAUT, 2).sensitivity.tension[1], lambda x: _height(ROPE, x, 2), TAUT.tension)


def test_uncertainty():
    m = rc.modes(CORDS["thicker with a tip"], 2)
    u = m.uncertainty(mass="2 %", tip_mass=0.01, length=0.03, exponent=0.1)
    s = m.sensitivity
    parts = np.array([s.mass * 0.01, s.tip_mass * 0.01, s.length * 0.03, s.exponent * 0.1])
    np.testing.assert_allclose(u.conical_height, np.sqrt((parts**2).sum(axis=0)), rtol=1e-13)
    np.testing.assert_allclose(u.angular_speed, 0.5 * m.angular_speed * u.conical_height / m.conical_height, rtol=1e-13)
    np.testing.assert_allclose(u.period, 0.5 * m.period * u.conical_height / m.conical_height, rtol=1e-13)
    np.testing.assert_allclose(u.share.length, parts[2] ** 2 / u.conical_height**2, rtol=1e-12)
    held = rc.modes(TAUT, 2).uncertainty(tension="1 %")
    assert held.largest == ("tension",) * 2 and "tension" in repr(held)
    assert (rc.modes(TAUT, 2).uncertainty().relative == 0).all()
    for system, given, message in (
        (TAUT, {"tip_mass": 0.1}, "tip_mass is for a hanging cord"),
        (TAUT, {"exponent": 0.1}, "exponent is for a hanging cord"),
        (TAUT, {"weight": 0.1}, "give mass, not weight"),
        (ROPE, {"tension": 0.1}, "tension is for a cord held"),
        (ROPE, {"mass": -0.1}, "mass must be finite and not negative"),
    ):
        with pytest.raises(ValueError, match=message):
            rc.modes(system, 1).uncertainty(**given)
