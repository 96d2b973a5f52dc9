# SPDX-License-Identifier: GPL-3.0-or-later
"""Heights of rigged chains in many digits, from the physics and not from the program's pencil; for make_expected.py.

Lagrange's equations in the ANGLES of the links (and the displacement of a support that yields), small, about the
straight chain. A rig is a list of bodies, each with what it weighs, what has to be moved with it, and where it is:

    potential   V = sum of (weight that bears) z,     z = -+ (lengths above) cos(angle): + where a link stands
    inertia     T = 1/2 sum of (weight that moves)/g (x'^2 + rho^2 angle'^2),     x = support + sum of lengths angle
    a wheel     of angular momentum p along the vector from the lower to the upper pin adds -+ 1/2 p n angle^2 to the
                Lagrangian of a steady whirl n; driven relative to its link, p = C (spin +- n)

so that (V'' + n P - n^2 M) angle = 0. Links locked to the one above have its angle. All roots 1/n are eigenvalues of
the dense companion matrix of the reversed polynomial, by mpmath.eig.
"""

from __future__ import annotations

import mpmath as mp
from mpmath import mpf

# as texts, which are read with the digits of the moment
UNITS = {"N/m": "1", "m": "1", "cm": "0.01", "cm^2": "1e-4", "mm": "0.001", "kg": "1", "g": "0.001", "t": "1000", "rpm": None}
UNITS |= {"kN m/rad": "1000", "kN m s/rad": "1000", "N": "1", "deg": None}


def number(given):
    """A decimal, or a text with a unit."""
    if not isinstance(given, str):
        return mpf(given)
    value, _, unit = given.partition(" ")
    return mpf(value) * ({"rpm": mp.pi / 30, "deg": mp.pi / 180}[unit] if UNITS[unit] is None else mpf(UNITS[unit]))


class Link:
    """Length, +1 or -1 for hanging or standing, bodies (bears, moves, centroid, rho^2) as masses, wheel p = H + C n."""

    def __init__(self, table, fluid):
        self.length = number(table["length"])
        self.sign = -1 if table.get("standing") else 1
        self.clamped = table.get("clamped", False)
        mass = number(table["mass"])
        if "centroid" in table:
            h = number(table["centroid"])
            if "radius_of_gyration" in table:
                rho2 = number(table["radius_of_gyration"]) ** 2
            else:
                rho2 = h * (number(table["pendulum_length"]) - h)
        elif table.get("kind") == "rod":
            h, rho2 = self.length / 2, self.length**2 / 12
        else:
            h, rho2 = self.length, mpf(0)
        self.bodies = [(mass, mass, h, rho2)]
        if "tip_mass" in table:
            self.bodies.append((number(table["tip_mass"]), number(table["tip_mass"]), self.length, mpf(0)))
        if "displaced" in table:  # it bears as a body would of that much less mass; turning, it also presses inwards
            water = table["displaced"]
            displaced = number(water["mass"])
            moves = -displaced if fluid == "turning" else number(water.get("added_mass", 0))
            assert not {"centroid", "radius_of_gyration"} & set(water)
            self.bodies.append((-displaced, moves, h, rho2))
        pin = table.get("pin", {})
        self.spring, self.dashpot = (number(pin.get(name, 0)) for name in ("stiffness", "damping"))
        wheel = table.get("flywheel")
        self.momentum = self.axial_moment = mpf(0)
        if wheel:
            moment = number(wheel["mass"]) * number(wheel["radius_of_gyration"]) ** 2
            self.momentum = moment * number(wheel["spin"])
            self.axial_moment = moment if wheel.get("driven") else mpf(0)


def links_of(scene):
    """Lowest first."""
    fluid = scene.get("fluid", "still")
    if "uniform_chain" in scene:
        chain = scene["uniform_chain"]
        count = chain["count"]
        one = {
            "kind": chain["kind"].removesuffix("s"),
            "length": number(chain["length"]) / count,
            "mass": number(chain["mass"]) / count,
        }
        tip = {"tip_mass": chain["tip_mass"]} if "tip_mass" in chain else {}
        return [Link(one | tip, fluid)] + [Link(one, fluid) for _ in range(count - 1)]
    return [Link(table, fluid) for table in scene["links"] for _ in range(table.get("repeat", 1))]


def equations(links, gravity, stiffness=None, carriage=mpf(0)):
    """V'', P and M in the angles, lowest first, then the support's displacement if it yields."""
    n = len(links)
    size = n + (stiffness is not None)
    bend, gyro, inertia = mp.matrix(size), mp.matrix(size), mp.matrix(size)
    for m, link in enumerate(links):
        for bears, moves, centroid, rho2 in link.bodies:
            arm = [mpf(0)] * size  # d(x of the body)/d(coordinate)
            arm[m] = centroid
            for above in range(m + 1, n):
                arm[above] = links[above].length
            for j in range(n):
                bend[j, j] += bears * gravity * arm[j] * links[j].sign  # z = -sign arm cos(angle)
            if size > n:
                arm[n] = mpf(1)
            for j in range(size):
                for k in range(size):
                    inertia[j, k] += moves * arm[j] * arm[k]
            inertia[m, m] += moves * rho2
        bend[m, m] += link.spring  # at the upper pin, to the link above or the vertical
        if m + 1 < n:
            bend[m + 1, m + 1] += link.spring
            bend[m, m + 1] -= link.spring
            bend[m + 1, m] -= link.spring
        # the axis from the lower to the upper pin is up where the link hangs, down where it stands
        gyro[m, m] += link.sign * link.momentum
        inertia[m, m] -= link.axial_moment  # p = C (spin +- n), and the axis down once more changes the sign
    if size > n:
        bend[n, n] = stiffness
        inertia[n, n] += carriage
    free = [m for m in range(size) if m >= n or not links[m].clamped]
    same = mp.matrix(size, len(free))  # a clamped link has the angle of the one above
    for m in range(size):
        same[m, next(k for k, of in enumerate(free) if of >= m)] = 1
    return [same.T * matrix * same for matrix in (bend, gyro, inertia)] + [same]


def speeds(bend, gyro, inertia):
    """All roots n, complex, and the angles of each: 1/n are eigenvalues of the reversed polynomial's companion."""
    size = bend.rows
    inverse = bend**-1
    if not any(gyro):
        values, vectors = mp.eig(inverse * inertia)
        greatest = max(map(abs, values))  # what has stiffness and no inertia is infinitely fast
        finite = [(k, value) for k, value in enumerate(values) if not is_zero(value, greatest)]
        return [(1 / mp.sqrt(mp.mpc(value)), vectors[:, k]) for k, value in finite]
    companion = mp.matrix(2 * size)
    m, p = inverse * inertia, inverse * gyro
    for j in range(size):
        companion[j, size + j] = 1
        for k in range(size):
            companion[size + j, k], companion[size + j, size + k] = m[j, k], -p[j, k]
    values, vectors = mp.eig(companion)
    return [(1 / value, vectors[:size, k]) for k, value in enumerate(values)]


def is_zero(part, whole):
    return abs(part) < abs(whole) * mpf(10) ** -50


def is_singular(matrix):
    return is_zero(mp.det(matrix), mp.norm(matrix) ** matrix.rows)


def solve(scene):
    """Modes [(n, offsets of the pins, free end first)], slowest first, and others [(height, growth rate)]."""
    gravity = number(scene.get("gravity", mpf("9.80665")))
    links = links_of(scene)
    support = scene.get("support", {})
    stiffness = number(support["stiffness"]) if "stiffness" in support else None
    bend, gyro, inertia, same = equations(links, gravity, stiffness, number(support.get("mass", 0)))
    modes, others = [], []
    for n, vector in speeds(bend, gyro, inertia):
        residual = (bend + n * gyro - n**2 * inertia) * vector
        assert mp.norm(residual) < mpf(10) ** -55 * mp.norm(bend * vector)
        if is_zero(mp.im(n), n):
            angles = same * vector
            offset = [angles[len(links)] if stiffness is not None else mpf(0)]
            for m in reversed(range(len(links))):
                offset.insert(0, offset[0] + links[m].length * angles[m])
            modes.append((mp.re(n), [mp.re(y / offset[0]) for y in offset]))
        else:
            height = gravity / n**2
            height = mp.mpc(mp.re(height), 0 if is_zero(mp.im(height), height) else mp.im(height))
            others.append((height, abs(mp.im(n))))
    modes.sort(key=lambda mode: abs(mode[0]))
    hanging = sum(link.sign > 0 for link in links if not link.clamped) + (stiffness is not None)
    if "fluid" not in scene and not any(gyro) and not is_singular(inertia):
        assert len(modes) == hanging  # Sylvester
    return gravity, links, modes, others


def carried(scene, speed):
    """Offsets of the pins while the support, or its spring's place of rest, goes round: its displacement is given."""
    gravity, links, support = number(scene.get("gravity", mpf("9.80665"))), links_of(scene), scene["support"]
    radius = number(support["radius"])
    stiffness = number(support["stiffness"]) if "stiffness" in support else None
    bend, gyro, inertia, same = equations(links, gravity, stiffness or mpf(0), number(support.get("mass", 0)))
    dynamic, last = bend + speed * gyro - speed**2 * inertia, bend.rows - 1
    if stiffness is None:
        force = -radius * dynamic[:last, last]
        angles = mp.lu_solve(dynamic[:last, :last], force)
        angles = same * mp.matrix([*angles, radius])
    else:
        angles = same * mp.lu_solve(dynamic, mp.matrix([0] * last + [stiffness * radius]))
    offset = [angles[len(links)]]
    for m in reversed(range(len(links))):
        offset.insert(0, offset[0] + links[m].length * angles[m])
    return offset


def damped(scene):
    """The exponents of a chain with dashpots, and its offsets at some times while the support is moved by velocities."""
    gravity, links = number(scene.get("gravity", mpf("9.80665"))), links_of(scene)
    n, whole = len(links), mp.matrix(2 * len(links) + 2)
    bend, _, inertia, _ = equations(links, gravity)
    _, _, with_support, _ = equations(links, gravity, mpf(0))
    rub = mp.matrix(n)
    for m, link in enumerate(links):
        for j, k, sign in ((m, m, 1), (m + 1, m + 1, 1), (m, m + 1, -1), (m + 1, m, -1)):
            if max(j, k) < n:
                rub[j, k] += sign * link.dashpot
    inverse = inertia**-1
    # angles, rates, and the support's velocity and acceleration; its inertia drives the angles
    whole[:n, n : 2 * n], whole[2 * n, 2 * n + 1] = mp.eye(n), mpf(1)
    whole[n : 2 * n, :n], whole[n : 2 * n, n : 2 * n] = -inverse * bend, -inverse * rub
    whole[n : 2 * n, 2 * n + 1] = -inverse * with_support[:n, n]
    exponents = sorted(mp.eig(whole[: 2 * n, : 2 * n], left=False, right=False), key=lambda s: (abs(s), mp.im(s)))
    swing, moved = scene.get("ask", {}).get("swing", {}), {}
    if "support_velocity" in swing:
        times, speeds = ([number(x) for x in swing[f"support_{name}"]] for name in ("time", "velocity"))
        state, place, now = mp.matrix(2 * n + 2, 1), mpf(0), times[0]
        assert now == 0
        state[2 * n] = speeds[0]
        for end, speed in [*zip(times[1:], speeds[1:], strict=True), (number(swing["time"]["to"]), speeds[-1])]:
            state[2 * n + 1] = (speed - state[2 * n]) / (end - now)
            place += (end - now) * (state[2 * n] + speed) / 2
            state, now = mp.expm(whole * (end - now)) * state, end
            offset = [place]
            for m in reversed(range(n)):
                offset.insert(0, offset[0] + links[m].length * state[m])
            moved[mp.nstr(end, 20)] = [mp.nstr(y, 30) for y in offset]
    return [s for s in exponents if mp.im(s) >= 0], moved


def nodes_of(links, offset):
    """Distances from the free end where the offset changes its sign; of hanging links on a firm support."""
    nodes, at = [], mpf(0)
    for m, link in enumerate(links[:-1]):
        if offset[m] * offset[m + 1] < 0:
            nodes.append(at + link.length * offset[m] / (offset[m] - offset[m + 1]))
        at += link.length
    return nodes


def check_closed_forms():
    """What the paper has in closed form, through the same functions."""
    tiny = mpf(10) ** -60

    def height(scene):
        gravity, _, modes, others = solve(scene)
        return sorted([gravity / n**2 for n, _ in modes], reverse=True), others

    # section 2 (7): a plummet on a spring has its thread lengthened by c; a compound link (lambda - l)(lambda - c) = c h
    bob = {"mass": mpf("0.7"), "length": mpf("1.3")}
    weight = mpf("0.7") * mpf("9.80665")
    [found], _ = height({"links": [bob], "support": {"stiffness": "20 N/m"}})
    assert abs(found - mpf("1.3") - weight / 20) < tiny
    rod = bob | {"kind": "rod"}
    c, h, l = weight / 20, mpf("0.65"), mpf("2.6") / 3
    for found in height({"links": [rod], "support": {"stiffness": "20 N/m"}})[0]:
        assert abs((found - l) * (found - c) - c * h) < tiny
    # section 1 (9): a plummet carried round, b lambda/(lambda - l); on a spring its place of rest is
    whirl = mpf("2.1")
    turning = mpf("9.80665") / whirl**2
    tip, top = carried({"links": [bob], "support": {"radius": 2}}, whirl)
    assert abs(tip - 2 * turning / (turning - mpf("1.3"))) < tiny and top == 2
    tip, _ = carried({"links": [bob], "support": {"radius": 2, "stiffness": "20 N/m"}}, whirl)
    assert abs(tip - 2 * turning / (turning - mpf("1.3") - weight / 20)) < tiny
    # section 6 (12): a rod standing on a thread, (l + lambda)(a - lambda) = a h
    found, others = height({"links": [rod | {"standing": True}, {"mass": 0, "length": 2}]})
    for root in (*found, *(other for other, _ in others)):
        assert abs((l + root) * (2 - root) - 2 * h) < tiny
    # a top: I_P n^2 - p n - W h = 0, the spin that of the wheel, or relative to the link (I_P less by C)
    wheel = {"mass": mpf("0.5"), "radius_of_gyration": mpf("0.2"), "spin": mpf(200)}
    for driven, standing in ((False, False), (True, False), (False, True), (True, True)):
        link = rod | {"flywheel": wheel | {"driven": driven}, "standing": standing}
        _, _, modes, _ = solve({"links": [link]})
        moment, turn = mpf("0.7") * h * l - driven * mpf("0.02"), -1 if standing else 1
        assert len(modes) == 2
        for n, _ in modes:
            assert abs(moment * n**2 - turn * mpf(4) * n - turn * weight * h) < mpf(10) ** -50
    # two gyrostats in series: the quartic that two equal links' determinant is
    _, (low, high), modes, _ = solve({"links": [rod | {"flywheel": wheel}, rod]})
    a = mpf("1.3")
    for n, _ in modes:
        one = weight * h + mpf(4) * n - n**2 * mpf("0.7") * h * l
        two = weight * (h + a) - n**2 * (mpf("0.7") * h * l + mpf("0.7") * a * a)
        assert abs(one * two - (n**2 * mpf("0.7") * h * a) ** 2) < mpf(10) ** -45
    # Stokes, section 2 (6): weights as -1/4 : 1 make a (1 +- sqrt(-1/3)), a half the thread
    float_ = {"mass": mpf(1), "length": mpf("0.5"), "displaced": {"mass": mpf(2)}}
    _, others = height({"links": [float_, {"mass": mpf(4), "length": mpf("0.5")}], "fluid": "turning"})
    for other, _ in others:
        assert abs(abs(mp.im(other)) - mp.sqrt(mpf(1) / 12)) < tiny and abs(mp.re(other) - mpf("0.5")) < tiny


def expected_of(scene, digits, asked):
    """What stands in the file of expected values about modes and others."""
    check_closed_forms()
    if any(link.dashpot for link in links_of(scene)):
        exponents, moved = damped(scene)
        pairs = [[mp.nstr(mp.re(s), digits), mp.nstr(mp.im(s), digits)] for s in exponents]
        return {"size": len(links_of(scene)), "modes": [], "exponents": pairs, "swing": moved}
    gravity, links, modes, others = solve(scene)
    rigged = "support" in scene or any({"standing", "flywheel", "displaced", "pin"} & set(t) for t in scene.get("links", []))
    spinning = any(link.momentum for link in links)
    numbers = {1: 0, -1: 0}
    rows = []
    for n, offset in modes:
        if n < 0 and not spinning:
            continue
        sense = int(mp.sign(n))
        numbers[sense] += 1
        if numbers[sense] > asked:
            continue
        row = {"sense": sense, "number": numbers[sense]} if rigged else {}
        row["conical_height"] = mp.nstr(gravity / n**2, digits)
        row["angular_speed"] = mp.nstr(n, digits)
        if rigged:
            row["offset"] = [mp.nstr(y, 20) for y in offset]
        else:
            row["nodes"] = [mp.nstr(node, 20) for node in nodes_of(links, offset)]
        rows.append(row)
    others.sort(key=lambda other: (abs(other[0]), mp.im(other[0])))
    found = {"size": sum(not link.clamped for link in links), "modes": rows}
    if "response" in scene.get("ask", {}):
        (speed,) = scene["ask"]["response"]["angular_speed"]
        found["carried"] = [mp.nstr(y, digits) for y in carried(scene, number(speed))]
    if rigged:
        found["other"] = [
            {
                "conical_height": [mp.nstr(mp.re(h), digits), mp.nstr(mp.im(h), digits)],
                "growth_rate": mp.nstr(r, digits),
            }
            for h, r in others
        ]
    return found
