# SPDX-License-Identifier: GPL-3.0-or-later
"""Stability of steady shapes of rigs, and what damping does: Lagrange's equations in 60 digits (support/rigs.py), motions
integrated in space, laws."""

import math

import mpmath as mp
import numpy as np
import pytest
from rigs import G, Motion, exponents, first_order, rigged, small_motions
from scipy.integrate import solve_ivp
from tier import by_tier

import revchain as rc

RODS = rc.Chain.uniform_rods(2, length=1.0, weight=2.0)
THREE = rc.Chain(weight=[1.0, 2.0, 0.5], length=[1.0, 0.7, 1.3])
BODIES = rc.Chain(weight=[2.0, 3.0], length=[0.4, 0.5], centroid=[0.2, 0.3], radius_of_gyration=[0.15, 0.1])
RIGS = {
    "plain": rigged(THREE),
    "arm": rigged(THREE, radius=0.2),
    "arm, bodies": rigged(BODIES, radius=0.1),
    "spring": rigged(RODS, stiffness=60.0, carriage=0.7),
    "spring without mass": rigged(THREE, stiffness=80.0),
    "spring on an arm": rigged(RODS, stiffness=60.0, carriage=0.3, radius=0.15),
    "wheels": rigged(BODIES, momentum=[0.25, -0.1]),
    "driven wheels": rigged(BODIES, momentum=[0.2, 0.1], axial_moment=[0.03, 0.0]),
    "wheels on an arm": rigged(BODIES, momentum=[-0.1, 0.3], axial_moment=[0.02, 0.05], radius=0.1),
    "float": rigged(BODIES, displaced=[1.2, 0.5], added=[0.5, 0.4]),
    "float of another centre": rigged(BODIES, displaced=[1.2, 0.5], centroid=[0.1, 0.2], gyration=0.1, added=0.3),
    "standing": rigged(BODIES, inverted=[True, False]),
    "all": rigged(BODIES, stiffness=90.0, carriage=0.3, radius=0.1, momentum=[0.1, 0.2], displaced=0.4, added=0.1),
}
def shapes_of(rig, most=4):
    height = 0.3 * rc.modes(rc.Rig(rig.chain)).conical_height[0]
    found = rc.steady_shapes(rig, conical_height=height, hanging_only=False)
    assert len(found)
    step = max(1, len(found) // most)
    return found[::step][:most]


@pytest.mark.parametrize("frame", ["free", "driven"])
@pytest.mark.parametrize("name", RIGS)
def test_exponents_are_those_of_lagranges_equations(name, frame):
    """Second differences of Lagrange's function in 60 digits take most of the time."""
    rig, compared = RIGS[name], 0
    for shape in shapes_of(rig, by_tier(2, 4)):
        got = shape.stability(frame=frame)
        exact = exponents(small_motions(rig, shape, frame))
        largest = max(map(abs, exact))
        rotates = 2 * (frame == "free" and rig.support.radius == 0)
        assert sum(abs(s) < 1e-7 * largest for s in exact) == rotates  # the rotation's, where it is free
        assert got.exponents.size == len(exact) - rotates
        for value in got.exponents:
            near = sorted(abs(mp.mpc(complex(value)) - s) for s in exact)
            assert near[0] <= 1e-7 * largest
            if near[1] > largest / 100:
                compared += 1
                assert near[0] <= 2e-13 * largest
        growth = max(mp.re(s) for s in exact)
        assert abs(growth - got.growth_rate) <= 1e-7 * largest
        assert got.verdict != "unstable" or growth > 1e-7 * largest
        assert got.verdict == "unstable" or growth <= 2e-7 * largest
    assert compared > 3


def with_dashpots(rig, damping):
    return rc.Rig(
        rig.chain, support=rig.support, flywheels=rig.flywheels, displaced=rig.displaced, fluid=rig.fluid,
        inverted=rig.inverted, pins=rc.Pin(damping=damping),
    )  # fmt: skip


@pytest.mark.parametrize("frame", ["free", "driven"])
@pytest.mark.parametrize("name", RIGS)
def test_exponents_with_dashpots_are_those_of_damped_motions(name, frame):
    """Dashpots of any strength, unlike at each pin."""
    rig, compared = RIGS[name], 0
    refused = {"spring without mass": "with dashpots a support must not be without mass"}
    if frame == "free":
        refused["driven wheels"] = "dashpots and a driven wheel are not solved together"
    if name in refused:
        shape = shapes_of(rig, 1)[0]
        shape = rc.steady_shapes(with_dashpots(rig, 0.1), conical_height=shape.conical_height, hanging_only=False)[0]
        with pytest.raises(ValueError, match=refused[name]):
            shape.stability(frame=frame)
        return
    scale = rig.chain.total_weight / G * rig.chain.total_length**2
    for k, shape in enumerate(shapes_of(rig, by_tier(2, 4))):
        damping = scale * shape.angular_speed * 10.0 ** np.random.default_rng(k).uniform(-2.5, -0.5, len(rig))
        damped = with_dashpots(rig, damping)
        (same,) = (each for each in rc.steady_shapes(damped, conical_height=shape.conical_height, hanging_only=False)
                   if np.array_equal(each.inclination, shape.inclination))  # fmt: skip
        got = same.stability(frame=frame)
        exact = exponents(small_motions(rig, shape, frame, damping), friction=1.0)
        largest = max(map(abs, exact))
        for value, bound in zip(got.exponents, got.exponent_error, strict=True):
            near = sorted(abs(mp.mpc(complex(value)) - s) for s in exact)
            assert near[0] <= 1e-7 * largest
            if near[1] > largest / 100:
                compared += 1
                assert near[0] <= 5e-13 * largest and near[0] <= bound
        growth = max(mp.re(s) for s in exact)
        assert abs(growth - got.growth_rate) <= 1e-6 * largest or (growth < 0 and got.growth_rate == 0)
        assert got.verdict != "unstable" or growth > 1e-7 * largest
    assert compared > 3


def exponents_of_points(chain, shape, damping, radius, frame):
    """Exponents over the speed of point masses on ball joints (in the plane that is driven: hinges) in the turning frame: Newton's
    equations in space for the coordinates inclination and angle out of the plane, in double."""
    n, speed = chain.size, shape.angular_speed
    a, mass, lean = chain.length, chain.weight / G, shape.inclination
    s, c, zero = np.sin(lean), np.cos(lean), np.zeros(n)
    e = np.stack([s, zero, -c], axis=1)
    tangent = np.stack([c, zero, s], axis=1), np.stack([zero, zero + 1, zero], axis=1)
    planes = 2 if frame == "free" else 1
    below = np.triu(np.ones((n, n))) * a  # pin m is below links m, m + 1, ...
    place = below @ e + np.array([radius, 0.0, 0.0])
    first = np.concatenate([below[:, :, None] * tangent[k] for k in range(planes)], axis=1)  # pins, coordinates, space
    second = np.concatenate([below[:, :, None] * -e] * planes, axis=1)  # of a coordinate by itself; mixed ones are 0
    inertia = np.einsum("m,mix,mjx->ij", mass, first, first)
    turned = np.stack([-first[..., 1], first[..., 0], 0 * first[..., 2]], axis=-1)
    turn = 2 * speed * np.einsum("m,mix,mjx->ij", mass, first, turned)
    stiff = -(speed**2) * np.einsum("m,mix,mjx->ij", mass, first[..., :2], first[..., :2])
    stiff += np.diag(mass @ (G * second[..., 2] - speed**2 * np.einsum("mx,mix->mi", place[:, :2], second[..., :2])))
    rates = np.concatenate([np.cross(e, tangent[k]) for k in range(planes)])  # of each link, without spin
    spins = n + (frame == "free" and radius == 0)  # the support turns freely, too
    given, left, root = np.zeros((n, 3, planes * n)), np.zeros((n, 3, spins)), np.sqrt(damping)
    for k in range(n):  # the joint above link k
        for link, sign in ((k, 1.0), (k + 1, -1.0)):
            if link < n:
                for plane in range(planes):
                    given[k, :, plane * n + link] += sign * root[k] * rates[plane * n + link]
                left[k, :, link] += sign * root[k] * e[link]
    if spins > n:
        left[-1, 2, n] = root[-1]
    given, left = given.reshape(3 * n, -1), left.reshape(3 * n, -1)
    if frame == "free":
        given = given - left @ np.linalg.lstsq(left, given, rcond=None)[0]
    count = planes * n
    whole = np.zeros((2 * count, 2 * count))
    whole[:count, count:] = np.eye(count)
    whole[count:, :count] = -np.linalg.solve(inertia, stiff)
    whole[count:, count:] = -np.linalg.solve(inertia, turn + given.T @ given)
    return np.linalg.eigvals(whole) / speed


def test_random_chains_with_dashpots():
    """Point masses on ball joints or hinges, on the axis or on an arm, with dashpots of any strength; REVCHAIN_CASES=10000: 12 min."""
    random, compared, shapes = np.random.default_rng(45), 0, 0
    while shapes < by_tier(40, 150):
        n = int(random.integers(1, 6))
        chain = rc.Chain(weight=10 ** random.uniform(-0.7, 0.7, n), length=10 ** random.uniform(-0.3, 0.3, n))
        speed = random.uniform(1.05, 3.0) * rc.modes(chain, 1).angular_speed[0]
        scale = chain.total_weight / G * chain.total_length**2 * speed
        damping = scale * 10 ** random.uniform(-3, -0.5, n)
        radius = float(random.choice([0.0, 0.2 * chain.total_length]))
        rig = rc.Rig(chain, support=rc.Support(radius=radius), pins=rc.Pin(damping=damping))
        for shape in rc.steady_shapes(rig, angular_speed=speed)[:2]:
            shapes += 1
            for frame in ("free", "driven"):
                got, exact = shape.stability(frame=frame), exponents_of_points(chain, shape, damping, radius, frame)
                largest = np.abs(exact).max()
                assert got.exponents.size == exact.size - 2 * (frame == "free" and radius == 0)
                for value in got.exponents:
                    near = np.sort(np.abs(exact - value))
                    assert near[0] <= 1e-6 * largest
                    if near[1] > 1e-2 * largest:
                        compared += 1
                        assert near[0] <= 1e-9 * largest
    assert compared > 2 * shapes


@pytest.mark.parametrize("frame", ["free", "driven"])
@pytest.mark.parametrize("name", RIGS)
def test_rates_of_damping_are_those_of_damped_motions(name, frame):
    """Central differences of the exponents, in 60 digits, by friction at the pins and by drag in still air."""
    rig, compared = RIGS[name], 0
    for shape in shapes_of(rig, by_tier(1, 2)):
        got, motions = shape.stability(frame=frame), small_motions(rig, shape, frame)
        largest, speed = np.abs(got.exponents).max(), abs(float(motions.speed))
        for kind, rates in (("friction", got.internal_damping), ("drag", got.external_damping)):
            assert rates.size == got.exponents.size
            small = 1e-7 * speed / np.nanmax(np.abs(rates))
            more, less = (exponents(motions, **{kind: sign * small}) for sign in (1, -1))
            for s, rate in zip(got.exponents, rates, strict=True):
                if np.sort(np.abs(got.exponents - s))[1] < 1e-3 * largest or abs(s) < 1e-3 * largest:
                    continue
                pair = [min(found, key=lambda t: abs(t - complex(s))) for found in (more, less)]
                slope = float(mp.re(pair[0] - pair[1])) / (2 * small) * speed
                compared += 1
                assert slope == pytest.approx(rate, rel=1e-6, abs=1e-6 * np.nanmax(np.abs(rates)))
    assert compared > 3


def followed(rig, shape, which, friction=0.0, turns=3.0, size=1e-6):
    """A motion in space from a small disturbance along one mode: its exponent, how much it grew and how far it is from
    the mode, of its size."""
    motions = small_motions(rig, shape)
    with mp.workdps(30):
        values, vectors = mp.eig(first_order(motions, friction=friction))
        index = min(range(len(values)), key=lambda i: abs(values[i] - complex(which)))
        s, speed, count = complex(values[index]), float(motions.speed), motions.inertia.rows
        mode = np.array([complex(x) for x in vectors[:count, index]])
    mode *= size / np.abs(mode).max()
    given, time = rig.flywheels, turns * 2 * math.pi / abs(speed)

    def state(at):
        a = mode * np.exp(s * abs(speed) * at)
        place, rate = motions.placed([mp.mpf(float(x)) for x in a.real], [mp.mpf(float(x)) for x in (s * abs(speed) * a).real])
        place, rate = (np.array([[float(x) for x in row] for row in rows]) for rows in (place, rate))
        return place, rate + np.cross([0.0, 0.0, speed], place)

    axial = 0.0
    if given is not None:
        axial = given.momentum + (given.axial_moment if given.axial_moment is not None else 0.0) / G * speed * np.cos(
            shape.inclination
        )
    motion = Motion(rig, speed, np.broadcast_to(axial, len(rig)), friction=friction)
    done = solve_ivp(motion, (0.0, time), np.stack(state(0.0)).ravel(), "DOP853", rtol=1e-12, atol=1e-15)
    end = done.y[:, -1].reshape(2, -1, 3)[0]
    angle = speed * time
    back = np.array([[math.cos(angle), math.sin(angle), 0.0], [-math.sin(angle), math.cos(angle), 0.0], [0.0, 0.0, 1.0]])
    still = np.array([[float(x) for x in row] for row in motions.placed([mp.mpf(0)] * count, [mp.mpf(0)] * count)[0]])
    moved, wanted = end @ back.T - still, state(time)[0] - still
    return s, np.linalg.norm(wanted) / np.linalg.norm(state(0.0)[0] - still), np.linalg.norm(moved - wanted) / np.linalg.norm(
        wanted
    )


@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name == "all")) for name in RIGS if name != "spring without mass"]
)
def test_disturbances_in_space_grow_as_exponents_say(name):
    """Motions of up to six turns, integrated to 1e-12."""
    rig, unstable = RIGS[name], 0
    for shape in shapes_of(rig):
        got = shape.stability()
        if got.growth_rate < 1e-3:
            continue
        fastest = got.exponents[np.argmax(got.exponents.real)]
        s, grown, off = followed(rig, shape, fastest, turns=min(6.0, 0.5 / got.growth_rate))
        assert abs(s - fastest) <= 1e-9 * np.abs(got.exponents).max()
        assert grown > 2 and off < 1e-3
        unstable += 1
    assert unstable


@pytest.mark.slow
def test_friction_makes_what_gyroscopic_forces_hold_grow():
    """Kelvin, Tait and Chetaev: a plain chain and a chain on an arm, in space, with friction at the pins."""
    found = 0
    for rig in (rigged(RODS), rigged(RODS, radius=0.05)):
        height = 0.7 * rc.modes(RODS).conical_height[1]
        for shape in rc.steady_shapes(rig, conical_height=height):
            got = shape.stability()
            if got.verdict != "spectrally stable":
                continue
            worst = int(np.argmax(got.internal_damping))
            rate, speed = got.internal_damping[worst], math.sqrt(G / height)
            assert rate > 0
            friction = 0.01 * speed / rate
            s, grown, off = followed(rig, shape, got.exponents[worst], friction, turns=20.0)
            assert s.real == pytest.approx(0.01, rel=0.05)
            assert grown > 2.5 and off < 1e-3
            found += 1
    assert found >= 2


def test_drag_in_proportion_to_mass_halves_and_units():
    """Rods of one density: -1/2 of drag over mass. By mass and by weight, with any gravity, damping is in SI."""
    for chain in (rc.Chain.uniform_rods(4, length=2.0, mass=3.0), rc.Chain.uniform_rods(4, length=2.0, weight=3.0 * 1.62)):
        for shape in rc.steady_shapes(chain, conical_height=0.15, gravity=1.62):
            got = shape.stability()
            np.testing.assert_allclose(got.external_damping, -0.5 * 2.0 / 3.0, rtol=1e-8)
            other = rc.steady_shapes(rc.Rig(chain), conical_height=0.15, gravity=1.62)[0].stability()
            assert other.verdict == "minimum" and other.internal_damping.max() < 0
    by_mass, by_weight = (
        rc.steady_shapes(rc.Rig(rc.Chain(**{kind: [2.0 * g, 3.0 * g]}, length=0.5),
                                flywheels=rc.Flywheel(**{kind: g}, radius_of_gyration=0.1, spin=50.0, driven=True)),
                         angular_speed=9.0, gravity=1.62)[0].stability()
        for kind, g in (("mass", 1.0), ("weight", 1.62))
    )  # fmt: skip
    for name in ("exponents", "internal_damping", "external_damping"):
        np.testing.assert_allclose(getattr(by_mass, name), getattr(by_weight, name), rtol=1e-9)


def test_the_other_direction_mirrors_wheels():
    """A rig that turns the other way with its wheels' momentum reversed is the mirror image."""
    one, other = (rigged(BODIES, momentum=[sign * 0.2, sign * -0.1], radius=0.1) for sign in (1, -1))
    for p, q in zip(
        rc.steady_shapes(one, angular_speed=7.0), rc.steady_shapes(other, angular_speed=7.0, direction=-1), strict=True
    ):
        np.testing.assert_allclose(p.stability().exponents, q.stability().exponents, atol=1e-13)
        np.testing.assert_allclose(p.stability().internal_damping, q.stability().internal_damping, rtol=1e-9)


BODIES3 = rc.Chain(weight=[1.0, 2.0, 0.8], length=[0.5, 0.4, 0.6], centroid=[0.3, 0.2, 0.35], radius_of_gyration=0.1)


def test_what_is_refused():
    wheel = rigged(THREE, stiffness=80.0, momentum=[0.0, 0.0, 0.1])
    with pytest.raises(ValueError, match="give it a carriage"):
        rc.steady_shapes(wheel, conical_height=0.5)[0].stability()
    with pytest.raises(ValueError, match="frame must be"):
        rc.steady_shapes(RIGS["arm"], conical_height=0.3)[0].stability(frame="fixed")


@pytest.mark.parametrize("more", [{}, {"stiffness": 60.0, "carriage": 0.5}, {"radius": 0.2}, {"momentum": [0.1, 0.0, -0.1]}])
@pytest.mark.parametrize("frame", ["free", "driven"])
def test_in_a_fluid_that_turns_the_energy_decides(more, frame):
    """Signs of the second differences of the energy in the turning frame, in 60 digits; no other motion is known."""
    seen = set()
    for displaced in ([0.3, 0.2, 0.1], [0.1, 0.5, 0.0]):
        rig = rigged(BODIES3, displaced=displaced, centroid=0.3, gyration=0.15, fluid="turning", **more)
        for shape in rc.steady_shapes(rig, conical_height=0.12):
            got = shape.stability(frame=frame)
            stiff = small_motions(rig, shape, frame).stiffness
            with mp.workdps(60):
                signs = [x for x in mp.eigsy(stiff, eigvals_only=True) if abs(x) > mp.mpf(10) ** -8]
            rotates = frame == "free" and not rig.support.radius
            assert len(signs) == stiff.rows - rotates
            assert got.negative_directions == sum(x < 0 for x in signs)
            assert got.verdict == ("undecided" if got.negative_directions else "minimum")
            assert got.exponents.size == 0 and math.isnan(got.growth_rate) == (got.verdict == "undecided")
            seen.add(got.verdict)
    assert "minimum" in seen
