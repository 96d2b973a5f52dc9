# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains let go, and chains held at both ends, in many digits; for make_expected.py.

In the ANGLES of the links, from the physics. Let go: M angle'' + V'' angle = 0, all modes by mpmath. Held: the potential
in the turning frame, V = sum of m (g z - n^2/2 (y^2 + rho^2 sin(angle)^2)), stationary under the two conditions that the
upper end is on the axis, `span` above the lower; Newton's method on all angles and both pulls at once.
"""

from __future__ import annotations

import mpmath as mp
from expected_rigs import equations, links_of, number
from mpmath import mpf


def let_go(scene):
    """{time: offsets of the pins, free end first} at the last of the times asked and half of it."""
    swing, links = scene["ask"]["swing"], links_of(scene)
    gravity = number(scene.get("gravity", mpf("9.80665")))
    bend, _, inertia, _ = equations(links, gravity)
    n = len(links)
    start = [number(y) for y in swing["offset"]] + [mpf(0)]
    angles = mp.matrix([(start[m] - start[m + 1]) / links[m].length for m in range(n)])
    root = mp.matrix(n)  # V'' is diagonal
    for m in range(n):
        root[m, m] = 1 / mp.sqrt(bend[m, m])
    squares, vectors = mp.eigsy(root * inertia * root)  # 1/n^2
    share = vectors.T * root**-1 * angles
    found = {}
    for time in (number(swing["time"]["to"]) / 2, number(swing["time"]["to"])):
        moved = root * vectors * mp.matrix([share[k] * mp.cos(time / mp.sqrt(squares[k])) for k in range(n)])
        offset = [mpf(0)]
        for m in reversed(range(n)):
            offset.insert(0, offset[0] + links[m].length * moved[m])
        found[mp.nstr(time, 20)] = [mp.nstr(y, 30) for y in offset]
    return found


def held(scene):
    """Offsets of the pins, lower end first, of each number of half waves asked for, and the pulls at the lower end."""
    links, asked = links_of(scene), scene["ask"]["shapes"]
    gravity = number(scene.get("gravity", mpf("9.80665")))
    span, speed = number(scene["held"]["span"]), number(asked["angular_speed"])
    rows = []
    for waves in range(1, asked.get("max_half_waves", 1) + 1):
        angles, across, along = stationary(links, gravity, span, speed, waves)
        offset = [mpf(0)]
        for link, angle in zip(links, angles, strict=True):
            offset.append(offset[-1] + link.length * mp.sin(angle))
        assert sum(a * b < 0 for a, b in zip(offset[1:-2], offset[2:-1], strict=True)) == waves - 1
        sign = 1 if offset[1] > 0 else -1
        assert abs(offset[-1]) < mpf(10) ** -40
        rows.append(
            {
                "half_waves": waves,
                "offset": [mp.nstr(sign * y, 30) for y in offset[:-1]] + ["0.0"],
                "lower_pull": [mp.nstr(sign * across, 30), mp.nstr(along, 30)],
            }
        )
    return rows


def stationary(links, gravity, span, speed, waves):
    """Angles to the upward vertical, from below, and the pull on the lower bearing, by Newton's method."""
    n = len(links)
    slack = mp.findroot(  # angles like a cosine's along the chain, with the span wanted
        lambda most: (
            sum(
                link.length * mp.cos(most * mp.cos(mp.pi * waves * (m + mpf("0.5")) / n))
                for m, link in enumerate(links)
            )
            - span
        ),
        mpf(1),
    )
    x = [slack * mp.cos(mp.pi * waves * (m + mpf("0.5")) / n) for m in range(n)]
    weight = sum(body[0] for link in links for body in link.bodies) * gravity
    forces, jacobian = balance(links, gravity, span, speed, [*x, 0, 0])
    arms = -jacobian[:n, n:]  # of the pull, which at first is the one that leaves least over
    x += list(mp.lu_solve(arms.T * arms, arms.T * forces[:n, 0]))
    for _ in range(60):
        forces, jacobian = balance(links, gravity, span, speed, x)
        step = mp.lu_solve(jacobian, forces)
        largest = max(abs(step[k]) for k in range(n))
        part = min(mpf(1), mpf("0.3") / largest)
        x = [value - part * change for value, change in zip(x, step, strict=True)]
        if largest < mpf(10) ** -60:
            break
    # the conditions' multipliers pull the upper end; the lower end bears what is left of weight and centrifugal force
    angles, across, along = x[:n], x[n], x[n + 1]
    y, outwards = mpf(0), mpf(0)
    for link, angle in zip(links, angles, strict=True):
        for bears, _, centroid, _ in link.bodies:
            outwards += bears * speed**2 * (y + (link.length - centroid) * mp.sin(angle))
        y += link.length * mp.sin(angle)
    return angles, outwards + across, along - weight


def balance(links, gravity, span, speed, x):
    """dV/d(angle) less what the upper end's pull (x[n] across, x[n + 1] up) does, and both conditions; the Jacobian."""
    n = len(links)
    forces, jacobian = mp.matrix(n + 2, 1), mp.matrix(n + 2)
    sine, cosine = [mp.sin(a) for a in x[:n]], [mp.cos(a) for a in x[:n]]
    across, along = x[n], x[n + 1]
    reach = mpf(0)
    for m, link in enumerate(links):
        [(mass, _, centroid, rho2)] = link.bodies
        lever = link.length - centroid  # from the lower pin
        arms = [links[j].length for j in range(m)] + [lever]
        y = reach + lever * sine[m]
        for j, arm in enumerate(arms):
            forces[j] += mass * (-gravity * arm * sine[j] - speed**2 * y * arm * cosine[j])
            jacobian[j, j] += mass * (-gravity * arm * cosine[j] + speed**2 * y * arm * sine[j])
            for k, other in enumerate(arms):
                jacobian[j, k] -= mass * speed**2 * arm * cosine[j] * other * cosine[k]
        forces[m] -= mass * speed**2 * rho2 * sine[m] * cosine[m]
        jacobian[m, m] -= mass * speed**2 * rho2 * (cosine[m] ** 2 - sine[m] ** 2)
        reach += link.length * sine[m]
    for m, link in enumerate(links):
        a = link.length
        forces[m] -= across * a * cosine[m] - along * a * sine[m]
        jacobian[m, m] -= -across * a * sine[m] - along * a * cosine[m]
        jacobian[m, n], jacobian[m, n + 1] = -a * cosine[m], a * sine[m]
        jacobian[n, m], jacobian[n + 1, m] = a * cosine[m], -a * sine[m]
    forces[n] = reach
    forces[n + 1] = sum(link.length * c for link, c in zip(links, cosine, strict=True)) - span
    return forces, jacobian
