# SPDX-License-Identifier: GPL-3.0-or-later
"""Shapes with air drag against formulations that share nothing with the library: vector equations of one link in 40 digits,
Lagrange's equations in angles with generalised forces, the balance of a point mass, a cord integrated from its free end."""

import math

import mpmath as mp
import numpy as np
import pytest
from mpmath.calculus.quadrature import GaussLegendre
from scipy.integrate import solve_ivp
from scipy.optimize import brentq
from tier import by_tier

import revchain as rc
from revchain.systems.datum import datum_at

G = 9.80665


def tanh_sinh(step=0.1, reach=3.3):
    """Nodes in 0 ... 1 and weights: exact to rounding also where the integrand has a kink at an end."""
    t = np.arange(-reach, reach + step / 2, step)
    x = np.tanh(math.pi / 2 * np.sinh(t))
    weight = step * math.pi / 2 * np.cosh(t) / np.cosh(math.pi / 2 * np.sinh(t)) ** 2
    return (1 + x) / 2, weight / 2


NODES, WEIGHTS = tanh_sinh()


class Angles:
    """Links in inclinations and azimuths: Lagrange's equations with the generalised forces of drag."""

    def __init__(self, rig, drag, speed, gravity=G):
        chain = rig.chain
        self.mass, self.length, self.n = chain.mass, chain.length, speed
        self.centroid = np.broadcast_to(chain.centroid, self.mass.shape)
        self.gyration = np.broadcast_to(chain.radius_of_gyration, self.mass.shape)
        self.radius, self.gravity = rig.support.radius, gravity
        each = lambda name: np.broadcast_to(drag._given.get(name, np.zeros(())), self.mass.shape)  # noqa: E731
        bodies = each("body_coefficient" if "body_coefficient" in drag._given else "coefficient")
        self.line = drag.density / 2 * each("coefficient") * each("diameter")
        self.body = drag.density / 2 * bodies * each("area")

    def points(self, q, share):
        """Places at shares of the links below their upper pins, shape (N, S, 3); analytic in q."""
        size = self.mass.size
        tilt, turn = q[:size], q[size:]
        u = np.stack([np.sin(tilt) * np.cos(turn), np.sin(tilt) * np.sin(turn), -np.cos(tilt)], axis=-1)
        pin = np.zeros((size + 1, 3), u.dtype)
        pin[size, 0] = self.radius
        for m in range(size - 1, -1, -1):
            pin[m] = pin[m + 1] + self.length[m] * u[m]
        return pin[1:, None, :] + (self.length[:, None] * share)[..., None] * u[:, None, :], u

    def potential(self, q):
        """Potential of gravity and centrifugal force. Each body is two points on its link, a radius of gyration from its centre."""
        total = 0
        for sign in (-1, 1):
            where = ((self.centroid + sign * self.gyration) / self.length)[:, None]
            r = self.points(q, where)[0][:, 0]
            total = total + np.sum(self.mass / 2 * (self.gravity * r[:, 2] - self.n**2 / 2 * (r[:, 0] ** 2 + r[:, 1] ** 2)))
        return total

    def nodes(self, q):
        """Shares and weights of each link's drag, split at its slowest point."""
        ends, u = self.points(q, np.array([[0.0, 1.0]]))
        v = np.stack([-ends[..., 1], ends[..., 0], 0 * ends[..., 0]], axis=-1)
        v = v - np.sum(v * u[:, None, :], axis=-1, keepdims=True) * u[:, None, :]
        along = v[:, 1] - v[:, 0]
        square = np.sum(along**2, axis=-1)
        cut = np.clip(-np.sum(v[:, 0] * along, axis=-1) / np.where(square > 0, square, 1), 0, 1)[:, None]
        return np.hstack([cut * NODES, cut + (1 - cut) * NODES]), np.hstack([cut * WEIGHTS, (1 - cut) * WEIGHTS])

    def drag(self, q):
        """Forces of drag at points, and the shares of the links where they act."""
        share, weight = self.nodes(q)
        r, u = self.points(q, share)
        v = self.n * np.stack([-r[..., 1], r[..., 0], 0 * r[..., 0]], axis=-1)
        v = v - np.sum(v * u[:, None, :], axis=-1, keepdims=True) * u[:, None, :]
        force = -(self.line * self.length)[:, None, None] * weight[..., None] * np.linalg.norm(v, axis=-1, keepdims=True) * v
        middle = (self.centroid / self.length)[:, None]
        r = self.points(q, middle)[0]
        v = self.n * np.stack([-r[..., 1], r[..., 0], 0 * r[..., 0]], axis=-1)
        body = -self.body[:, None, None] * np.linalg.norm(v, axis=-1, keepdims=True) * v
        return np.hstack([share, middle]), np.concatenate([force, body], axis=1)

    def forces(self, q):
        """Generalised forces: 0 in a steady figure. Derivatives by complex steps."""
        share, force = self.drag(q)
        found = np.empty(q.size)
        for j in range(q.size):
            beside = q.astype(complex)
            beside[j] += 1e-30j
            found[j] = -self.potential(beside).imag / 1e-30
            found[j] += np.sum(force * self.points(beside, share)[0].imag) / 1e-30
        return found

    def newton_step(self, q):
        """How far the angles are from a figure in balance."""
        jacobian, h = np.empty((q.size, q.size)), 1e-6
        for j in range(q.size):
            ends = []
            for side in (-h, h):
                beside = q.copy()
                beside[j] += side
                ends.append(self.forces(beside))
            jacobian[:, j] = (ends[1] - ends[0]) / (2 * h)
        return np.linalg.solve(jacobian, self.forces(q))

    def power(self, q):
        """Power that the drag takes."""
        share, force = self.drag(q)
        r = self.points(q, share)[0]
        return -np.sum(force * self.n * np.stack([-r[..., 1], r[..., 0], 0 * r[..., 0]], axis=-1))


def random_case(random, most=12):
    size = int(random.integers(1, most + 1))
    length = 10.0 ** random.uniform(-1, 1, size)
    centroid = length * random.uniform(0.05, 1.5, size)
    chain = rc.Chain(
        mass=10.0 ** random.uniform(-2, 2, size), length=length, centroid=centroid,
        radius_of_gyration=length * random.uniform(0, 1, size),
    )
    reach, mass = length.sum(), chain.mass.sum()
    rig = rc.Rig(chain, support=rc.Support(radius=reach * 10.0 ** random.uniform(-1.5, 0.5)))
    strength = mass / reach * 10.0 ** random.uniform(-3, 1)  # of the drag to the centrifugal force
    drag = rc.Drag(
        random.uniform(0.5, 1.5, size), diameter=strength / reach * random.uniform(0, 2, size),
        area=strength / size * random.uniform(0, 1, size) * (random.random() < 0.5),
        body_coefficient=random.uniform(0.2, 2.0),
    )
    return rig, drag, math.sqrt(G / reach) * 10.0 ** random.uniform(-0.7, 0.7)


def angles_of(shape):
    return np.concatenate([shape.inclination, shape.azimuth])


def test_random_chains_against_lagranges_equations():
    """The step of Newton's method in other coordinates, and the power against the force on the support."""
    random, solved, worst, folds = np.random.default_rng(20240), 0, [], 0
    count = by_tier(60, 10_000)
    for _ in range(count):
        rig, drag, speed = random_case(random)
        shape = rc.drag_shape(rig, drag, angular_speed=speed)
        if shape.status != "success":
            continue
        solved, folds = solved + 1, folds + (shape.folds > 0)
        assert shape.factor == 1 and shape.residual < 1e-14 and shape.torque > 0
        other, q = Angles(rig, drag, speed), angles_of(shape)
        assert math.isclose(shape.torque * speed, other.power(q), rel_tol=1e-10)
        assert shape.power == shape.torque * speed
        step = other.newton_step(q)
        turned = step[rig.size :] * np.sin(shape.inclination)  # an azimuth is lost where a link is vertical
        worst.append(max(np.abs(step[: rig.size]).max(), np.abs(turned).max()))
    print(f"{count} chains: {solved} solved, {folds} beyond folds")
    print(f"Newton's steps: median {np.median(worst):.1e}, largest {max(worst):.1e}")
    assert solved >= 0.999 * count
    assert np.quantile(worst, 0.99) < 1e-14 and max(worst) < 3e-13


def exact_one_link(mass, length, centroid, gyration, radius, line, body, speed, start):
    """Direction of one link in 40 digits: the moment about its pin of weight, inertia and drag."""
    mp.mp.dps = 40
    nodes = GaussLegendre(mp.mp).calc_nodes(5, 150)
    m, a, h, k, R, cl, cb, n, g = map(mp.mpf, (mass, length, centroid, gyration, radius, line, body, speed, G))

    def cross(p, q):
        return [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]

    def moment(x, y):
        z = -mp.sqrt(1 - x * x - y * y)
        u = [x, y, z]

        def drag(s, across):
            v = [-n * s * y, n * (R + s * x), mp.mpf(0)]
            if across:
                slip = sum(p * q for p, q in zip(u, v, strict=True))
                v = [p - slip * q for p, q in zip(v, u, strict=True)]
            size = mp.sqrt(sum(p * p for p in v))
            return [-size * p for p in v]

        total = [mp.mpf(0)] * 3
        arm = [h * p for p in u]
        load = [m * n * n * (R + h * x), m * n * n * h * y, -m * g]
        for force, at in ((load, arm), ([m * n * n * k * k * x, m * n * n * k * k * y, mp.mpf(0)], u)):
            total = [p + q for p, q in zip(total, cross(at, force), strict=True)]
        total = [p + cb * q for p, q in zip(total, cross(arm, drag(h, False)), strict=True)]
        for part in range(4):
            for node, weight in nodes:
                s = a * (part + (1 + node) / 2) / 4
                total = [p + cl * a / 8 * weight * s * q for p, q in zip(total, cross(u, drag(s, True)), strict=True)]
        return total[0], total[1]

    found = mp.findroot(lambda x, y: moment(x, y), start, tol=1e-60)
    return found[0], found[1]


@pytest.mark.parametrize("seed", range(by_tier(4, 40)))
def test_one_link_in_forty_digits(seed):
    random = np.random.default_rng(seed)
    mass, length = random.uniform(0.5, 2), random.uniform(0.5, 2)
    centroid, gyration, radius = length * random.uniform(0.1, 1.2), length * random.uniform(0, 0.6), random.uniform(0.2, 2)
    diameter, area, speed = random.uniform(0.01, 0.2), random.uniform(0, 0.1), random.uniform(0.5, 3)
    rig = rc.Rig(
        rc.Chain(mass=mass, length=length, centroid=centroid, radius_of_gyration=gyration), support=rc.Support(radius=radius)
    )
    shape = rc.drag_shape(rig, rc.Drag(1.1, diameter=diameter, area=area, body_coefficient=0.6), angular_speed=speed)
    tilt, turn = float(shape.inclination[0]), float(shape.azimuth[0])
    x, y = math.sin(tilt) * math.cos(turn), math.sin(tilt) * math.sin(turn)
    density = 1.225 / 2
    forces = density * 1.1 * diameter, density * 0.6 * area
    exact = exact_one_link(mass, length, centroid, gyration, radius, *forces, speed, (x, y))
    with mp.workdps(40):
        incline, around = mp.asin(mp.hypot(*exact)), mp.atan2(exact[1], exact[0])
        assert abs(tilt - incline) < 2e-15 and abs(turn - around) * math.sin(tilt) < 2e-15
    assert shape.error_estimate < 1e-15 and shape.status == "success" and shape.folds == 0


def point_mass(mass, thread, radius, drag, speed):
    """Distance from the axis, trailing angle and inclination of a ball on a thread, from its four forces."""

    def beyond(r):  # what the distance of the support is too large by
        psi = math.atan2(drag * r, mass)
        tilt = math.atan2(speed**2 * r * math.hypot(mass, drag * r), mass * G)
        out = thread * math.sin(tilt)
        return r * r + out * out - 2 * r * out * math.cos(psi) - radius**2, (psi, tilt)

    r = brentq(lambda r: beyond(r)[0], radius * 0.5, radius + thread, xtol=1e-15, rtol=1e-15)
    return r, *beyond(r)[1]


@pytest.mark.parametrize("speed", [0.5, 1.5, 2.5])
def test_a_ball_on_a_thread(speed):
    """The triangle of axis, support and ball: tan(trail) = drag/centrifugal force, tan(tilt) = sideways pull/weight."""
    mass, thread, radius, area = 0.8, 2.0, 1.5, 0.04
    rig = rc.Rig(rc.Chain(mass=mass, length=thread), support=rc.Support(radius=radius))
    shape = rc.drag_shape(rig, rc.Drag(0.5, area=area), angular_speed=speed)
    drag = 1.225 / 2 * 0.5 * area
    r, psi, tilt = point_mass(mass, thread, radius, drag, speed)
    assert math.isclose(math.hypot(*shape.position[0, :2]), r, rel_tol=1e-14)
    assert math.isclose(shape.inclination[0], tilt, rel_tol=1e-14)
    assert math.isclose(shape.torque, drag * speed**2 * r**3, rel_tol=1e-13)
    assert math.isclose(shape.tension[0], mass * G / math.cos(tilt), rel_tol=1e-14)
    seen = math.atan2(shape.position[0, 1], shape.position[0, 0])
    assert math.isclose(seen - shape.azimuth[0], psi, rel_tol=1e-13)  # the thread trails behind the ball's own radius


@pytest.mark.parametrize(("arm", "radius", "speed"), [(0.1, 1.0, 4.0), (0.5, 1.5, 3.0), (1.0, 1.0, 2.0), (0.02, 3.0, 6.0)])
def test_figure_2_of_the_paper(arm, radius, speed):
    """Greenhill's whirling machine, section 1 (8): R / W = CA / CN where the arm is at right angles to the plane of the ball."""
    mass, height = 0.7, G / speed**2
    thread = rc.plummet.whirling_thread(arm=arm, height=height, radius=radius)
    resistance = rc.plummet.air_resistance(arm=arm, height=height) * mass * G
    area = resistance / (1.225 / 2 * 0.5 * (speed * radius) ** 2)
    rig = rc.Rig(rc.Chain(mass=mass, length=thread), support=rc.Support(radius=arm))
    shape = rc.drag_shape(rig, rc.Drag(0.5, area=area), angular_speed=speed)
    assert shape.status == "success"
    assert shape.position[0] == pytest.approx([0.0, -radius, -height], abs=1e-13 * thread)
    assert shape.torque == pytest.approx(resistance * radius, rel=1e-13)


@pytest.mark.parametrize("half_waves", [None, 1])
@pytest.mark.parametrize("seed", range(10))
def test_without_drag_the_shapes_are_those_in_a_plane(seed, half_waves):
    rig, _, speed = random_case(np.random.default_rng(seed))
    if (rig.chain.centroid > rig.chain.length).any() and half_waves:
        speed /= 3
    plane = rc.steady_shape(rig, angular_speed=speed)
    shape = rc.drag_shape(rig, rc.Drag(1.0, diameter=0.0), angular_speed=speed, half_waves=half_waves)
    if half_waves is None or plane.half_waves == 1:
        out = np.abs(plane.offset).max()
        assert np.abs(shape.position - plane.position).max() <= 4e-16 * (out + rig.chain.length.sum())
        assert np.allclose(shape.tension, plane.tension, rtol=4e-16, atol=0)
    assert shape.torque == 0 and (shape.position[:, 1] == 0).all()


def test_half_waves_begin_at_the_shapes_without_drag():
    rig = rc.Rig(rc.Chain.uniform_rods(6, length=3.0, mass=1.0), support=rc.Support(radius=0.05))
    for waves in (1, 2, 3):
        alike = [s for s in rc.steady_shapes(rig, angular_speed=9.0) if s.half_waves == waves]
        plane = max(alike, key=lambda s: s.offset[0])
        near = rc.drag_shape(rig, rc.Drag(1.0, diameter=1e-9), angular_speed=9.0, half_waves=waves)
        assert near.status == "success" and np.abs(near.position - plane.position).max() < 1e-6
        step = Angles(rig, near.drag, 9.0).newton_step(angles_of(near))
        assert np.abs(step * np.sin(np.tile(near.inclination, 2))).max() < 1e-11
    with pytest.raises(ValueError, match="no shape without drag with this number of half waves.*got 9"):
        rc.drag_shape(rig, rc.Drag(1.0, diameter=0.01), angular_speed=9.0, half_waves=9)


def integrated_cord(line, mass, length, tip, radius, speed, body):
    """A cord with a ball at its free end, integrated from there: distance and depth of the ball, and the torque."""

    def slope(s, state):
        p, pull = state[:3], state[3:]
        u = -pull / np.linalg.norm(pull)  # up the cord; `pull` is the force of what is below
        v = speed * np.array([-p[1], p[0], 0.0])
        v = v - v @ u * u
        force = np.array([mass * speed**2 * p[0], mass * speed**2 * p[1], -mass * G]) - line * np.linalg.norm(v) * v
        return np.concatenate([u, force])

    def end(r):
        load = np.array([tip * speed**2 * r, -body * (speed * r) ** 2, -tip * G])
        start = np.concatenate([[r, 0.0, 0.0], load])
        return solve_ivp(slope, (0, length), start, rtol=1e-13, atol=1e-14, method="DOP853").y[:, -1]

    r = brentq(lambda r: math.hypot(*end(r)[:2]) - radius, radius + 0.6 * length, radius + length, xtol=1e-14)
    p, pull = end(r)[:3], end(r)[3:]
    return np.array([r, p[2], p[1] * pull[0] - p[0] * pull[1]])


def test_links_converge_to_a_cord():
    """Rods of equal length: the error falls as 1/N^2, and extrapolation meets the integrated cord."""
    length, mass, tip, radius, speed, line, body = 2.0, 0.05, 0.1, 0.5, 3.0, 0.004, 0.002
    truth = integrated_cord(line, mass, length, tip, radius, speed, body)
    found = {}
    for n in (20, 40, 80):
        links = [mass * length / n] * n
        ball = rc.Chain(mass=[tip, *links], length=[1e-9, *[length / n] * n], centroid=[1e-9, *[length / n / 2] * n],
                        radius_of_gyration=[0.0, *[length / n / math.sqrt(12)] * n])
        areas = np.zeros(n + 1)
        areas[0] = body / (1.225 / 2)
        air = rc.Drag(1.0, diameter=line / (1.225 / 2), area=areas)
        shape = rc.drag_shape(rc.Rig(ball, support=rc.Support(radius=radius)), air, angular_speed=speed)
        found[n] = np.array([math.hypot(*shape.position[0, :2]), -shape.position[0, 2], shape.torque])
    errors = {n: found[n] - truth for n in found}
    for coarse in (20, 40):
        assert np.allclose(errors[coarse] / errors[2 * coarse], 4, rtol=0.02)
    better = (4 * found[80] - found[40]) / 3
    assert np.allclose(better, truth, rtol=2e-8)


@pytest.mark.parametrize("ratio", [0.1, 0.5, 2.0, 10.0])
def test_a_light_cylinder_towed_straight_hangs_at_the_critical_angle(ratio):
    """On an arm so long that the path is straight: w cos(phi) = R sin(phi)^2, with w the weight and R the drag across the
    cylinder for each metre, phi from the horizontal. Pode, Tables for Computing the Equilibrium Configuration of a Flexible
    Cable in a Uniform Stream, DTMB Report 687 (1951), without tangential drag. A body: tan(inclination) = drag/weight."""
    arm, velocity, weight = 1e7, 10.0, 2.0
    drag = ratio * weight / velocity**2 / (1.225 / 2)
    cable = rc.Rig(rc.Chain.uniform_rods(5, length=5.0, mass=5 * weight / G), support=rc.Support(radius=arm))
    shape = rc.drag_shape(cable, rc.Drag(1.0, diameter=drag), angular_speed=velocity / arm)
    cosine = math.sqrt(0.25 / ratio**2 + 1) - 0.5 / ratio
    assert np.allclose(np.sin(shape.inclination), cosine, rtol=2e-6)  # from the vertical
    assert np.allclose(shape.azimuth, -math.pi / 2, atol=3e-6)
    ball = rc.Rig(rc.Chain(mass=weight / G, length=3.0), support=rc.Support(radius=arm))
    shape = rc.drag_shape(ball, rc.Drag(1.0, area=drag), angular_speed=velocity / arm)
    assert math.isclose(math.tan(shape.inclination[0]), ratio, rel_tol=2e-6)
    assert math.isclose(shape.torque, ratio * weight * arm, rel_tol=2e-6)


def test_strong_drag_winds_the_chain_in():
    """Extremes: a drag up to 1e6 times the weight, a hundred links, and folds on the way."""
    rig = rc.Rig(rc.Chain.uniform_rods(30, length=3.0, mass=1.0), support=rc.Support(radius=0.5))
    for diameter in (1e-3, 1.0, 1e3):
        for speed in (0.1, 1.0, 10.0):
            shape = rc.drag_shape(rig, rc.Drag(1.2, diameter=diameter), angular_speed=speed)
            assert shape.status == "success" and shape.residual < 1e-15
            assert math.isclose(shape.power, Angles(rig, shape.drag, speed).power(angles_of(shape)), rel_tol=1e-10)
    jumped = rc.drag_shape(rig, rc.Drag(1.2, diameter=0.1), angular_speed=10.0)
    assert jumped.folds == 2 and "jumps" in repr(jumped)
    stuck = rc.drag_shape(rig, rc.Drag(1.2, diameter=0.1), angular_speed=10.0, half_waves=1)
    assert stuck.status == "fold" and 0.5 < stuck.factor < 0.7
    beyond = rc.drag_shape(rig, rc.Drag(1.2, diameter=0.1 * stuck.factor * 1.001), angular_speed=10.0, half_waves=1)
    before = rc.drag_shape(rig, rc.Drag(1.2, diameter=0.1 * stuck.factor * 0.999), angular_speed=10.0, half_waves=1)
    assert beyond.status == "fold" and before.status == "success"


def test_springs_of_the_support_wheels_and_turned_over_parts():
    """Where a support yields, a wheel spins or a link stands: moments about every upper pin from positions alone."""
    chain = rc.Chain(mass=[1.0, 2.0], length=[0.5, 0.4], centroid=[0.3, 0.2], radius_of_gyration=[0.1, 0.15])
    air = rc.Drag(1.0, diameter=0.05, area=[0.02, 0.0])
    speed, radius = 3.0, 0.6
    sprung = rc.Support(stiffness=300.0, mass=0.5, radius=radius)
    soft = rc.drag_shape(rc.Rig(chain, support=sprung), air, angular_speed=speed)
    x, y, _ = soft.position[-1]
    firm = rc.drag_shape(rc.Rig(chain, support=rc.Support(radius=math.hypot(x, y))), air, angular_speed=speed)
    around = math.atan2(y, x)  # the same figure, turned as far as the support trails
    turned = [[math.cos(around), -math.sin(around)], [math.sin(around), math.cos(around)]]
    assert np.allclose(firm.position[:, :2] @ np.transpose(turned), soft.position[:, :2], rtol=0, atol=1e-14)
    assert math.isclose(firm.torque, soft.torque, rel_tol=1e-13)
    # the force of the spring balances the pull and the carriage
    spring = 300.0 * (np.array([radius, 0.0]) - [x, y])
    assert math.isclose(radius * -spring[1] * -1, soft.torque, rel_tol=1e-12)
    # a wheel at the speed n adds n H to the weight's moment: as more weight at the same mass
    still = rc.drag_shape(rc.Rig(chain, support=rc.Support(radius=radius)), air, angular_speed=speed)
    wheel = rc.Rig(chain, support=rc.Support(radius=radius), flywheels=rc.Flywheel(momentum=[0.2, 0.1]))
    with_wheels = [rc.drag_shape(wheel, air, angular_speed=n) for n in (speed, -speed)]
    assert with_wheels[0].inclination.sum() < still.inclination.sum() < with_wheels[1].inclination.sum()
    for sign, shape in zip((1, -1), with_wheels, strict=True):
        other, q = Angles(wheel, air, speed), angles_of(shape)
        momenta = np.concatenate([sign * speed * np.array([0.2, 0.1]) * np.sin(shape.inclination), np.zeros(2)])
        assert np.abs(other.forces(q) - momenta).max() < 1e-13
    upright = rc.Rig(chain, support=rc.Support(radius=radius), inverted=[True, False])
    standing = rc.drag_shape(upright, air, angular_speed=0.5)
    assert standing.inclination[0] > math.pi / 2 > standing.inclination[1]
    assert np.abs(Angles(wheel, air, 0.5).forces(angles_of(standing))).max() < 1e-13


def test_by_weight_and_in_still_fluid():
    chain = {"length": [0.5, 0.4], "centroid": [0.3, 0.2], "radius_of_gyration": [0.1, 0.15]}
    support, air = rc.Support(radius=0.6), rc.Drag(1.0, diameter=0.05)
    by_mass = rc.drag_shape(rc.Rig(rc.Chain(mass=[1.0, 2.0], **chain), support=support), air, angular_speed=3.0)
    by_weight = rc.drag_shape(rc.Rig(rc.Chain(weight=[G, 2 * G], **chain), support=support), air, angular_speed=3.0)
    assert np.allclose(by_mass.position, by_weight.position, rtol=0, atol=1e-15)
    assert math.isclose(by_mass.torque, by_weight.torque, rel_tol=1e-14)
    assert np.allclose(by_mass.tension, by_weight.tension, rtol=1e-14)
    fluid = rc.Displaced(mass=[0.3, 0.4], added_mass=0.2)
    floating = rc.Rig(rc.Chain(mass=[1.0, 2.0], **chain), support=support, displaced=fluid)
    shape = rc.drag_shape(floating, rc.Drag(1.0, diameter=0.05, density=1000.0), angular_speed=1.0)
    moving = Angles(rc.Rig(rc.Chain(mass=[1.2, 2.2], **chain), support=support), shape.drag, 1.0)
    bearing = Angles(rc.Rig(rc.Chain(mass=[0.7, 1.6], **chain), support=support), shape.drag, 1.0, G)
    lost = Angles(rc.Rig(rc.Chain(mass=[0.5, 0.6], **chain), support=support), rc.Drag(1.0, diameter=0.0), 1e-200, -G)
    q = angles_of(shape)  # the moving mass at full gravity, less the weight of 0.5 and 0.6 kg
    assert bearing.mass.sum() + lost.mass.sum() == pytest.approx(moving.mass.sum())
    assert np.abs(moving.forces(q) + lost.forces(q)).max() < 1e-12


def test_files_tables_and_pictures(tmp_path):
    rig = rc.Rig(rc.Chain(mass=[1.0, 2.0], length=0.5, names=["ball", "hook"]), support=rc.Support(radius=0.5))
    shape = rc.drag_shape(rig, rc.Drag(1.0, diameter=0.01, area=[0.02, 0.0]), angular_speed=3.0)
    for ending in (".npz", ".nc"):
        if ending == ".nc":
            pytest.importorskip("h5netcdf")
        shape.save(tmp_path / f"shape{ending}")
        again = rc.load(tmp_path / f"shape{ending}")
        assert again == shape and repr(again) == repr(shape) and again.drag == shape.drag
    assert "ball" in repr(shape) and bool(shape)
    data = shape.to_dict()
    assert data["torque"] == shape.torque and data["links"][1]["azimuth"] == shape.azimuth[1]
    pytest.importorskip("matplotlib")
    above = shape.plot()
    labels = [ax.get_ylabel() for ax in above.figure.axes]
    assert labels == ["depth below\nthe support (m)", "distance in the\nsense of motion (m)"]
    assert shape.plot(view="side").get_xlabel() == "outward distance (m)"
    with pytest.raises(ValueError, match="view must be one of side, above, got 'x'"):
        shape.plot(view="x")


def test_refusals():
    chain = rc.Chain(mass=[1.0, 2.0], length=0.5)
    carried, air = rc.Rig(chain, support=rc.Support(radius=1.0)), rc.Drag(1.0, diameter=0.01)
    for system in (chain, rc.Rig(chain)):
        with pytest.raises(ValueError, match="on the axis a chain with drag has no steady whirl.*give the support a radius"):
            rc.drag_shape(system, air, angular_speed=3.0)
    with pytest.raises(TypeError, match="drag must be a revchain.Drag, got 1.0"):
        rc.drag_shape(carried, 1.0, angular_speed=3.0)
    with pytest.raises(ValueError, match="diameter of the drag must be a number or an array with one for each of the 2"):
        rc.drag_shape(carried, rc.Drag(1.0, diameter=[0.1, 0.2, 0.3]), angular_speed=3.0)
    with pytest.raises(ValueError, match=r"angular_speed must be at most 1e\+100 in size, got -1e\+200"):
        rc.drag_shape(carried, air, angular_speed=-1e200)
    with pytest.raises(ValueError, match="angular speed must be positive"):
        rc.drag_shape(carried, air, angular_speed=0.0)
    sprung = rc.Rig(chain, support=rc.Support(radius=1.0), pins=rc.Pin(stiffness=1.0))
    with pytest.raises(ValueError, match="springs at pins: leave them out"):
        rc.drag_shape(sprung, air, angular_speed=3.0)
    turning = rc.Rig(chain, support=rc.Support(radius=1.0), displaced=rc.Displaced(mass=0.1), fluid="turning")
    with pytest.raises(ValueError, match="fluid that turns with the chain has no drag"):
        rc.drag_shape(turning, air, angular_speed=3.0)
    for wrong, words in (
        ({}, "give a diameter of the links, an area"), ({"diameter": -1.0}, "diameter must not be negative, got -1"),
        ({"area": float("nan")}, "area must be finite"), ({"area": []}, "area must have a number for each link"),
        ({"area": 1.0, "density": [1.0, 2.0]}, "density must be one number"),
    ):
        with pytest.raises(ValueError, match=words):
            rc.Drag(1.0, **wrong)
    assert rc.Drag(1.2, diameter="5 mm", area="40 cm^2", density="1.2 kg/m^3").diameter == 0.005


# ---- linear drag: C of q'' M + q' C + K q = 0


def straight_matrices(chain, drag, gravity=G):
    """K, C, M of small motion in inclinations, in 50 digits: energies of points of Gauss's rule on each link."""
    mp.mp.dps = 50
    size, K, C, M = chain.size, *(mp.zeros(chain.size) for _ in range(3))
    root = mp.sqrt(mp.mpf(3) / 5)
    gauss = [((1 - root) / 2, mp.mpf(5) / 18), (mp.mpf(1) / 2, mp.mpf(4) / 9), ((1 + root) / 2, mp.mpf(5) / 18)]
    lengths = [mp.mpf(float(x)) for x in chain.length]
    for m in range(size):
        weight, a = mp.mpf(float(chain.mass[m])), lengths[m]
        h, k = mp.mpf(float(chain.centroid[m])), mp.mpf(float(chain.radius_of_gyration[m]))
        for s, part in ((h - k, weight / 2), (h + k, weight / 2)):
            row = mp.matrix([0] * m + [s] + lengths[m + 1 :])
            M += part * row * row.T
            for j in range(size):
                K[j, j] += part * mp.mpf(gravity) * row[j]
        for x, part in gauss:
            row = mp.matrix([0] * m + [a * x] + lengths[m + 1 :])
            C += mp.mpf(float(drag[m])) * part * row * row.T
    return K, C, M


@pytest.mark.parametrize("seed", range(by_tier(3, 20)))
def test_linear_drag_in_fifty_digits(seed):
    random = np.random.default_rng(seed)
    size = int(random.integers(1, 7))
    length = random.uniform(0.2, 2, size)
    chain = rc.Chain(mass=random.uniform(0.1, 5, size), length=length, centroid=length * random.uniform(0.1, 1.3, size),
                     radius_of_gyration=length * random.uniform(0.1, 0.8, size))
    drag = random.uniform(0, 1, size) * 10.0 ** random.uniform(-2, 1)
    found = rc.modes(rc.Rig(chain, drag=drag))
    K, C, M = straight_matrices(chain, drag)
    inverse = M**-1
    form = mp.zeros(2 * size)
    for j in range(size):
        form[j, size + j] = 1
    form[size:, :size], form[size:, size:] = -(inverse * K), -(inverse * C)
    exact = mp.eig(form, left=False, right=False)
    for s, bound in zip(found.exponent, found.error_bound, strict=True):
        near = min(abs(mp.mpc(complex(s)) - x) for x in exact)
        assert near <= mp.mpf(float(bound)) * abs(mp.mpc(complex(s))) and bound < 1e-15


def test_linear_drag_of_one_rod():
    """s = -c/(2 m) + i sqrt(3 g/(2 l) - (c/(2 m))^2); its amplitude and decay in response and swing."""
    mass, length, c = 2.0, 1.5, 0.6
    rig = rc.Rig(rc.Chain.uniform_rods(1, length=length, mass=mass), drag=c)
    own, decay = math.sqrt(1.5 * G / length), c / (2 * mass)
    mode = rc.modes(rig)
    assert abs(mode.exponent[0] - complex(-decay, math.sqrt(own**2 - decay**2))) < 2e-15
    assert math.isclose(mode.damping_ratio[0], decay / own, rel_tol=1e-15)
    assert math.isclose(mode.decay_time[0], 1 / decay, rel_tol=1e-15)
    n, arm = 2.0, 0.1
    s = 1j * n
    turn = -(mass * length / 2 * s * s + c * length / 2 * s) * arm / (
        mass * length**2 / 3 * s * s + c * length**2 / 3 * s + mass * G * length / 2
    )
    answer = rc.response(rig, angular_speed=n, support_radius=arm)
    assert abs(answer.offset[0] - (arm + length * turn)) < 1e-15
    time = np.linspace(0, 5, 11)
    swing = rc.swing(rig, time, offset=[0.1, 0.0])
    rate = math.sqrt(own**2 - decay**2)
    exact = 0.1 * np.exp(-decay * time) * (np.cos(rate * time) + decay / rate * np.sin(rate * time))
    assert np.abs(swing.offset[:, 0] - exact).max() < 1e-15


def test_linear_drag_is_a_part_of_a_rig():
    chain = rc.Chain(mass=[1.0, 2.0], length=0.5)
    rig = rc.Rig(chain, drag=[0.3, 0.0])
    assert rig == rc.Rig(chain, drag=[0.3, 0.0]) != rc.Rig(chain, drag=0.3) and rig != rc.Rig(chain)
    assert rc.Rig(chain, drag=0.0) == rc.Rig(chain) and rc.Rig(chain, drag=0.0).drag is None
    assert rc.Rig.from_dict(rig.to_dict()) == rig and rig.describe().endswith("1 link with linear drag")
    assert repr(rig) == "Rig of a chain of 2 links: 1 link with linear drag" and rig.is_damped
    assert rc.Rig(chain, drag="0.3 N s/m").drag == 0.3
    datum = datum_at("test", rig, "links[0].drag", G)
    assert datum.present == 0.3 and datum.change(0.7) == rc.Rig(chain, drag=[0.7, 0.0])
    by_weight = rc.Rig(rc.Chain(weight=[G, 2 * G], length=0.5), drag=[0.3, 0.0])
    assert np.allclose(rc.modes(rig).exponent, rc.modes(by_weight).exponent, rtol=1e-15)
    for wrong, words in ((-1.0, "drag must not be negative, got -1"), ([1.0] * 3, "drag must be a number or an array"),
                         (math.inf, "drag must be finite")):
        with pytest.raises(ValueError, match=words):
            rc.Rig(chain, drag=wrong)
    for ask in (
        lambda: rc.steady_shapes(rig, angular_speed=9.0), lambda: rc.branches(rig, max_angular_speed=9.0),
        lambda: rc.drag_shape(
            rc.Rig(chain, support=rc.Support(radius=1.0), drag=0.1), rc.Drag(1.0, diameter=0.1), angular_speed=2.0
        ),
    ):
        with pytest.raises(ValueError, match="linear drag: leave it out"):
            ask()
    with pytest.raises(ValueError, match="linear drag has no counterpart"):
        rc.to_mjcf(rig)
    with pytest.raises(ValueError):
        rc.modes(rig).sensitivity  # noqa: B018
    assert rc.modes(rc.Rig(chain, drag=[0.3, 0.1])).to_dict()["modes"][0]["decay_time"] > 0
