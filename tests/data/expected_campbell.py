# SPDX-License-Identifier: GPL-3.0-or-later
"""Crossings of Campbell diagrams, and equilibria of governors, in many digits; for make_expected.py.

Campbell: Lagrange's equations of links in space, seen from a frame that turns with n. Coordinates are the support's place
and the horizontal part of the direction of each link, in the plane of the shape (p) and out of it (o):

    (U_pp - w^2 M_pp) p + 2 n w B o = 0,    2 n w B p + (U_oo - w^2 M_oo) o = 0

for a motion with cos(w t) in the plane and sin(w t) out of it. A crossing of order k is a zero of the determinant at w = k n.

Governors: the potential V and the balls' moment of inertia J as functions of the inclination from the geometry of the
linkage, differentiated numerically in 80 digits.
"""

from __future__ import annotations

from functools import partial

import mpmath as mp
from expected_rigs import links_of, number
from mpmath import mpf


def small_motion(scene, speed, start):
    """The place of the shape, then U_pp, M_pp, U_oo, M_oo, B; links that hang from a support on a spring, or firm."""
    gravity, links, support = number(scene.get("gravity", mpf("9.80665"))), links_of(scene), scene["support"]
    n, rest = len(links), number(support["radius"])
    spring = number(support["stiffness"]) if "stiffness" in support else None
    moment, weight = mp.matrix(n + 1), [mpf(0)] * (n + 1)
    for m, link in enumerate(links):
        for mass, moves, centroid, rho2 in link.bodies:
            assert mass == moves
            arm = [mpf(0)] * m + [centroid] + [above.length for above in links[m + 1 :]] + [mpf(1)]
            for j in range(n + 1):
                weight[j] += mass * gravity * arm[j] * (j < n)
                for k in range(n + 1):
                    moment[j, k] += mass * arm[j] * arm[k]
            moment[m, m] += mass * rho2
    moment[n, n] += number(support.get("mass", 0))
    free = n + (spring is not None)

    def residual(*place):
        u = mp.matrix([*place, *[rest] * (n + 1 - free)])
        pull = speed**2 * moment * u
        forces = [weight[j] * u[j] / mp.sqrt(1 - u[j] ** 2) - pull[j] for j in range(n)]
        return forces + ([spring * (u[n] - rest) - pull[n]] if free > n else [])

    place = list(mp.findroot(residual, start, tol=mpf(10) ** -70, maxsteps=100))
    cosine = [mp.sqrt(1 - x**2) for x in place[:n]]
    lever = mp.matrix(free)  # of vertical velocities: those of all bodies, and of each link's own turning
    for m, link in enumerate(links):
        for mass, _, centroid, rho2 in link.bodies:
            rise = [mpf(0)] * free
            for j in range(m, n):
                rise[j] = (centroid if j == m else links[j].length) * place[j] / cosine[j]
            for j in range(free):
                for k in range(free):
                    lever[j, k] += mass * rise[j] * rise[k]
            lever[m, m] += mass * rho2 * (place[m] / cosine[m]) ** 2
    moment = moment[:free, :free]
    inside, outside = -(speed**2) * moment, -(speed**2) * moment
    for j in range(n):
        inside[j, j] += weight[j] / cosine[j] ** 3
        outside[j, j] += weight[j] / cosine[j]
    if free > n:
        inside[n, n] += spring
        outside[n, n] += spring
    return place, inside, moment + lever, outside, moment


def shapes_from_rest(scene, speeds):
    """The shape that begins at rest, followed through ascending speeds."""
    links, support = links_of(scene), scene["support"]
    start = [mpf("0.01")] * len(links) + [number(support["radius"])] * ("stiffness" in support)
    places = []
    for speed in speeds:
        for part in range(1, 11):  # small steps, so that Newton's method stays on the branch
            low = places[-1][0] if places else mpf(0)
            start = small_motion(scene, low + (speed - low) * part / 10, start)[0]
        places.append((speed, start))
    return places


def frequencies(scene, speed, start):
    """All frequencies at a speed, ascending, by the companion matrix of Lagrange's equations."""
    _, inside, heavy, outside, moment = small_motion(scene, speed, start)
    size = heavy.rows
    whole = mp.matrix(4 * size)
    whole[: 2 * size, 2 * size :] = mp.eye(2 * size)
    whole[2 * size : 3 * size, :size] = -(heavy**-1) * inside
    whole[2 * size : 3 * size, 3 * size :] = 2 * speed * heavy**-1 * moment
    whole[3 * size :, size : 2 * size] = -(moment**-1) * outside
    whole[3 * size :, 2 * size : 3 * size] = -2 * speed * mp.eye(size)
    found = mp.eig(whole, left=False, right=False)
    return sorted(mp.im(s) for s in found if mp.im(s) > mpf(10) ** -30)


def crossings(scene):
    """The crossings in the range asked for: each as its order, the number of its frequency, and its speed."""
    ask = scene["ask"]["campbell"]
    assert ask.get("frame", "free") == "free" and ask.get("half_waves", 1) == 1
    low, high = (number(ask["angular_speed"][end]) for end in ("from", "to"))
    count = 60
    places = shapes_from_rest(scene, [low + (high - low) * k / count for k in range(count + 1)])
    rows = []
    for order in ask.get("orders", (1, 2)):
        for (slow, start), (fast, end) in zip(places, places[1:], strict=False):
            off = partial(determinant, scene, order, start)
            if off(slow) * determinant(scene, order, end, fast) < 0:
                at = mp.findroot(off, (slow, fast), solver="anderson", tol=mpf(10) ** -60)
                there = frequencies(scene, at, start)
                motion = min(range(len(there)), key=lambda j, of=there, to=order * at: abs(of[j] - to))
                assert abs(there[motion] - order * at) < mpf(10) ** -40
                rows.append({"order": order, "motion": motion + 1, "angular_speed": mp.nstr(at, 40)})
    return rows


def determinant(scene, order, start, speed):
    """0 where a frequency is `order` times the speed, in parts of those at rest; `start` is a shape nearby."""
    _, inside, heavy, outside, moment = small_motion(scene, speed, start)
    size, square = heavy.rows, (order * speed) ** 2
    whole = mp.matrix(2 * size)
    whole[:size, :size], whole[size:, size:] = inside - square * heavy, outside - square * moment
    whole[:size, size:] = whole[size:, :size] = 2 * speed * order * speed * moment
    return mp.det(whole) / mp.det(inside) / mp.det(outside)


def governor(scene):
    """Equilibria at the speed asked for, and the speeds at both stops, with friction and without."""
    gravity = number(scene.get("gravity", mpf("9.80665")))
    given = {name: number(value) for name, value in scene["governor"].items()}
    assert "sleeve_arm" not in given and "shaft_inertia" not in given
    arm, lower = given["arm"], given.get("lower_arm", mpf(0))
    joint, balls = given.get("joint", mpf(0)) or arm, given.get("balls", mpf(2)) * given["ball_mass"]
    pivot, sleeve = given.get("pivot_offset", mpf(0)), given.get("sleeve_offset", mpf(0))

    def depth(angle):  # of the sleeve below the pivots
        return joint * mp.cos(angle) + mp.sqrt(lower**2 - (pivot + joint * mp.sin(angle) - sleeve) ** 2) if lower else mpf(0)

    def potential(angle):
        lift = depth(0) - depth(angle)
        spring = given.get("spring_force", 0) * lift + given.get("spring_stiffness", 0) * lift**2 / 2
        return -balls * gravity * arm * mp.cos(angle) + given.get("sleeve_mass", 0) * gravity * lift + spring

    def inertia(angle):
        return balls * (pivot + arm * mp.sin(angle)) ** 2

    def speed(angle, friction=0):
        rise = -mp.diff(depth, angle)
        return mp.sqrt(2 * (mp.diff(potential, angle) + friction * rise) / mp.diff(inertia, angle))

    stops = [given[f"{end}_inclination"] for end in ("lowest", "highest")]
    rub = given.get("friction", mpf(0))
    asked = number(scene["ask"]["equilibria"]["angular_speed"])
    inside = mp.findroot(lambda angle: speed(angle) - asked, tuple(stops), solver="anderson", tol=mpf(10) ** -60)
    rows = []
    for angle in [mpf(0)] * (pivot == 0 and sleeve == 0) + [inside]:
        stiff = mp.diff(potential, angle, 2) - asked**2 * mp.diff(inertia, angle, 2) / 2
        moving = balls * arm**2 + given.get("sleeve_mass", 0) * mp.diff(depth, angle) ** 2
        row = {"inclination": mp.nstr(angle, 40), "lift": mp.nstr(depth(0) - depth(angle), 40), "stable": bool(stiff > 0)}
        rows.append(row | ({"period": mp.nstr(2 * mp.pi * mp.sqrt(moving / stiff), 40)} if stiff > 0 else {}))
    return {
        "equilibria": rows,
        "stops": [
            {name: mp.nstr(speed(stop, sign * rub), 40) for name, sign in (("falls", -1), ("angular_speed", 0), ("rises", 1))}
            for stop in stops
        ],
    }
