# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs to try, and their mechanics written out here with nothing of the library's: small offsets as a matrix pencil
from the heights of centres of gravity, steady figures by their effective potential, any motion by Newton's equations of
bodies in space. All chains are given by weight."""

import math
from types import SimpleNamespace

import mpmath as mp
import numpy as np
import scipy.integrate

import revchain as rc

G = 9.80665


def rigged(chain, *, stiffness=math.inf, carriage=0.0, radius=0.0, momentum=None, axial_moment=None, displaced=None,
           centroid=None, gyration=None, added=None, fluid="still", inverted=False):
    """A rig from plain numbers; `centroid`, `gyration` and `added` are those of the fluid displaced."""
    spins = momentum is not None or axial_moment is not None
    bears = any(each is not None for each in (displaced, centroid, gyration, added))
    return rc.Rig(
        chain,
        support=rc.Support(stiffness=stiffness, weight=carriage, radius=radius),
        flywheels=rc.Flywheel(momentum=momentum, axial_moment=axial_moment) if spins else None,
        displaced=rc.Displaced(weight=0.0 if displaced is None else displaced, centroid=centroid,
                               radius_of_gyration=gyration, added_weight=added) if bears else None,
        fluid=fluid,
        inverted=inverted,
    )  # fmt: skip


def columns(rig):
    """One number for each link of all that a rig made by `rigged` has."""
    chain, wheels, fluid = rig.chain, rig.flywheels, rig.displaced

    def column(of, name, left_out=0.0):
        value = getattr(of, name, None)
        return np.broadcast_to(left_out if value is None else value, rig.size).astype(float)

    return SimpleNamespace(
        w=chain.weight, a=chain.length, h=chain.centroid, rho=chain.radius_of_gyration,
        p=column(wheels, "momentum"), c=column(wheels, "axial_moment"), fluid=column(fluid, "weight"),
        hf=column(fluid, "centroid", chain.centroid), rf=column(fluid, "radius_of_gyration", chain.radius_of_gyration),
        added=column(fluid, "added_weight"),
    )  # fmt: skip


def random_chain(rng, size, spread=2.0, plummets=False):
    weight = np.exp(rng.uniform(-spread, spread, size))
    length = np.exp(rng.uniform(-1, 1, size))
    if plummets:
        return rc.Chain(weight=weight, length=length)
    centroid = length * rng.uniform(0.1, 1.2, size)
    radius = length * rng.uniform(0.1, 0.6, size)
    return rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=radius)


def rows_of(rig, number=mp.mpf):
    """All that `columns` has, a row for each link."""
    return list(zip(*([number(float(x)) for x in column] for column in vars(columns(rig)).values()), strict=True))


def assembled(rows, inverted, turns, below=0, bears=1):
    """K, P and M of the offsets of all pins, the support's last, dense. `turns`: the fluid turns with the rig; `below`:
    the tension at the lower end; `bears`: 0 without gravity."""
    number = type(rows[0][0])
    stiff, spin, mass = ([[number(0)] * (len(rows) + 1) for _ in range(len(rows) + 1)] for _ in range(3))

    def add(matrix, row, factor):
        for i, u in row.items():
            for j, v in row.items():
                matrix[i][j] += factor * u * v

    for m, (w, a, h, rho, p, c, fluid, hf, rf, added) in enumerate(rows):
        lean, sign = {m: 1 / a, m + 1: -1 / a}, -1 if inverted[m] else 1
        add(stiff, lean, sign * (bears * (w * h - fluid * hf) + a * below))
        add(spin, lean, sign * p)  # along the link, from its upper pin to its lower
        below += bears * (w - fluid)
        for moves, depth, turn in ((w, h, rho), (added - (fluid if turns else 0), hf, rf)):
            add(mass, {m: depth / a, m + 1: 1 - depth / a}, moves)
            add(mass, lean, moves * turn**2)
        add(mass, lean, -c)
    return stiff, spin, mass


def pencil(rig, number=mp.mpf, whole=False):
    """K, P and M of ``(K + n P - n^2 M / g) y = 0``, dense; the support last if it is on a spring, or if `whole`."""
    matrices, size = assembled(rows_of(rig, number), rig.inverted, rig.fluid == "turning"), len(rig)
    if math.isfinite(rig.support.stiffness):
        matrices[0][size][size] += number(rig.support.stiffness)
        matrices[2][size][size] += number(rig.support.carriage)
    elif not whole:
        return tuple([row[:size] for row in matrix[:size]] for matrix in matrices)
    return matrices


def real_speeds(rig, gravity=G, digits=60):
    """All real speeds, slowest first, by linearising; singular M falls out as infinite speeds."""
    with mp.workdps(digits):
        stiff, spin, mass = (mp.matrix(x) for x in pencil(rig))
        size = stiff.rows
        # reversed polynomial in w = 1 / n: (w^2 K + w P - M / g) y = 0, K regular
        inverse = stiff**-1
        big = mp.zeros(2 * size)
        top_left, top_right = -inverse * spin, inverse * mass / mp.mpf(gravity)
        for i in range(size):
            for j in range(size):
                big[i, j], big[i, size + j] = top_left[i, j], top_right[i, j]
            big[size + i, i] = 1
        inverses, _ = mp.eig(big)
        cut = max(abs(w) for w in inverses) * mp.mpf(10) ** (-digits // 3)
        every = [1 / w for w in inverses if abs(w) > cut]
    return sorted((mp.re(n) for n in every if abs(mp.im(n)) < abs(n) * mp.mpf(10) ** (-digits // 4)), key=abs)


def agree(rig, found, tolerance=2.0**-50, digits=60):
    """The whirl speeds found, both signs where there is momentum, are all of the pencil's."""
    want = [n for n in real_speeds(rig, found.gravity, digits) if found.has_momentum or n > 0]
    assert len(found) == len(want), (found, [float(n) for n in want])
    for got, exact in zip(sorted(found.angular_speed), sorted(want), strict=True):
        assert abs(mp.mpf(got) - exact) <= tolerance * abs(exact), (got, float(exact))
    assert np.all(np.diff(np.abs(found.angular_speed)) >= 0)


def agree_with_others(rig, found, tolerance=1e-14):
    """The conical heights found of a rig without momentum, and the others with their rates of growth, are all of the
    pencil's."""
    with mp.workdps(60):
        stiff, _, mass = (mp.matrix(x) for x in pencil(rig))
        heights = [z for z in mp.eig(stiff**-1 * mass)[0] if abs(z) > mp.mpf(10) ** -30]
        whirls = [abs(mp.im(z)) < abs(z) * 1e-25 and mp.re(z) > 0 for z in heights]
        real = sorted((mp.re(z) for z, whirl in zip(heights, whirls, strict=True) if whirl), reverse=True)
        rest = [z for z, whirl in zip(heights, whirls, strict=True) if not whirl]
        rates = [float(abs(mp.im(mp.sqrt(mp.mpf(G) / z)))) for z in rest]
    assert found.complete
    assert (len(found), len(found.other)) == (len(real), len(rest))
    for got, want in zip(found.conical_height, real, strict=True):
        assert abs(got - want) <= tolerance * want
    assert np.all(np.diff(found.conical_height) <= 0)
    for z, rate in zip(rest, rates, strict=True):
        distance = [abs(complex(got) - complex(z)) / abs(z) for got in found.other.conical_height]
        i = int(np.argmin(distance))
        assert distance[i] <= 1e-13
        assert abs(found.other.growth_rate[i] - rate) <= 1e-12 * rate


class Motion:
    """Unit vectors e of the links, from upper to lower pin: kinetic energy is quadratic in their rates with constant
    coefficients, gravity is linear in them, and a wheel adds -p e x e'. The support may be carried, or slide;
    `to_and_fro` along x only. `friction` is that at the pins, N m s."""

    def __init__(self, rig, speed, axial=None, to_and_fro=False, friction=0.0):
        assert rig.fluid == "still"
        self.friction = friction
        self.rig, self.speed, self.size, given = rig, speed, len(rig), columns(rig)
        self.slides, self.plane = math.isfinite(rig.support.stiffness), not to_and_fro
        size, both = self.size, self.size + 1  # the last place is the support's
        self.inertia, self.pull = np.zeros((both, both)), np.zeros(size)
        for m in range(size):
            for weight, depth, turn, bears in (
                (given.w[m], given.h[m], given.rho[m], given.w[m]),
                (given.added[m], given.hf[m], given.rf[m], 0.0),
                (0.0, given.hf[m], 0.0, -given.fluid[m]),
            ):
                row = np.concatenate([np.zeros(m), [depth], given.a[m + 1 :], [1.0]])
                self.pull += bears * row[:size]
                self.inertia += weight / G * np.outer(row, row)
                self.inertia[m, m] += weight / G * turn**2
        self.inertia[size, size] += rig.support.carriage / G
        self.axial = given.p if axial is None else np.asarray(axial)

    def __call__(self, t, state):
        size, both, n = self.size, self.size + 1, self.speed
        place, rate = state.reshape(2, both, 3)
        e, f = place[:size], rate[:size]
        force = np.zeros((both, 3))
        force[:size, 2] = -self.pull
        force[:size] -= self.axial[:, None] * np.cross(e, f)
        if self.friction:
            given, left, support = turning(e, np.cross(e, f), self.rig.support.radius == 0)
            given[-1] -= 0 if self.rig.support.radius == 0 else n * support
            about = np.linalg.lstsq(left, -given.ravel(), rcond=None)[0]
            moment = self.friction * (given.ravel() + left @ about).reshape(size, 3)
            moment[1:] -= moment[:-1].copy()  # from the pin above, less that from the pin below
            force[:size] -= np.cross(moment, e)
        rest = self.rig.support.radius * np.array([math.cos(n * t), self.plane * math.sin(n * t), 0.0])
        if self.slides:
            force[size] -= self.rig.support.stiffness * (place[size] - rest)
        unknown = size + self.slides
        # unknown accelerations (3 each) and a multiplier for each link
        big = np.zeros((3 * unknown + size, 3 * unknown + size))
        big[: 3 * unknown, : 3 * unknown] = np.kron(self.inertia[:unknown, :unknown], np.eye(3))
        side = np.zeros(3 * unknown + size)
        side[: 3 * unknown] = force[:unknown].ravel()
        if self.slides:  # level
            j = 3 * size + 2
            big[j, :], big[j, j], side[j] = 0.0, 1.0, 0.0
        else:
            side[: 3 * unknown] -= np.outer(self.inertia[:size, size], -n * n * rest).ravel()
        for m in range(size):
            big[3 * m : 3 * m + 3, 3 * unknown + m] = big[3 * unknown + m, 3 * m : 3 * m + 3] = e[m]
            side[3 * unknown + m] = -f[m] @ f[m]
        change = np.empty((2, both, 3))
        change[0], change[1, size] = rate, -n * n * rest
        change[1, :unknown] = np.linalg.solve(big, side)[: 3 * unknown].reshape(unknown, 3)
        return change.ravel()

    def after(self, time, lean, offset, rate=None, tolerance=1e-12, t_eval=None):
        """Unit vectors and support after a time, or times (last axis), from a plane, at rest or turning at `rate`."""
        place = np.zeros((self.size + 1, 3))
        place[: self.size, 0], place[: self.size, 2], place[-1, 0] = np.sin(lean), -np.cos(lean), offset
        first = np.stack([place, np.zeros_like(place) if rate is None else np.cross([0.0, 0.0, rate], place)]).ravel()
        times, tolerances = [time] if t_eval is None else t_eval, dict(rtol=tolerance, atol=tolerance / 100)
        done = scipy.integrate.solve_ivp(self, (0.0, time), first, "DOP853", t_eval=times, **tolerances)
        assert done.success
        places = done.y.reshape(2, self.size + 1, 3, -1)[0]
        return places[..., 0] if t_eval is None else places

    def run(self, inclination, offset_of_support, turns):
        """From a steady figure: largest departure of unit vectors and support from turning as one piece."""
        time = abs(turns * 2 * math.pi / self.speed)
        end = self.after(time, inclination, offset_of_support, self.speed, tolerance=1e-11)
        x, angle = np.append(np.sin(inclination), offset_of_support), self.speed * time
        down = np.append(-np.cos(inclination), 0.0)
        return float(np.abs(end - np.column_stack([x * math.cos(angle), x * math.sin(angle), down])).max())


def turning(e, across, swivels):
    """At each pin the lower link's rate of turning less the upper one's, that across the links given; how it depends on
    their rates about themselves (and on that of a support that swivels) that are still to be had; the vertical."""
    size, up = len(e), np.array([0.0, 0.0, 1.0])
    left = np.zeros((size, 3, size + swivels))
    for m in range(size):
        left[m, :, m] = e[m]
        if m:
            left[m - 1, :, m] = -e[m]
    if swivels:
        left[-1, :, size] = -up
    given = across - np.vstack([across[1:], np.zeros(3)])
    return given, left.reshape(3 * size, -1), up


def small_motions(rig, shape, frame="free", dashpots=None):
    """M, G, K of small motions about a shape, M a'' + G a' + K a = 0, from second differences of Lagrange's function in
    60 digits; friction at pins of 1 N m s, or of a number for the upper pin of each link; drag of 1 N s/m^2 as D a' + N a. Coordinates: inclinations in the plane, those
    out of it, then the support's offsets if it yields. In the free frame links keep what turns about their own axes; in
    the driven one, without motions out of the plane, they turn with it."""
    with mp.workdps(60):
        given, size, rows = columns(rig), len(rig), rows_of(rig)
        g, slides, free = mp.mpf(G), math.isfinite(rig.support.stiffness), frame == "free"
        n = shape.direction * mp.sqrt(g / mp.mpf(float(shape.conical_height)))
        rest = [mp.mpf(float(x)) for x in shape.inclination]
        top, b = mp.mpf(float(shape.offset[-1])), mp.mpf(rig.support.radius)
        mass, stiffness = mp.mpf(rig.support.carriage) or mp.mpf(10) ** -16, mp.mpf(rig.support.stiffness)
        count = (size + slides) * (1 + free)

        def placed(a, rate):
            """Unit vectors, the support, and their rates seen from the turning frame."""
            inside, out = a[: size + slides], a[size + slides :] if free else [mp.mpf(0)] * (size + slides)
            inward, outward = rate[: size + slides], rate[size + slides :] if free else [mp.mpf(0)] * (size + slides)
            vectors, rates = [], []
            for m in range(size):
                s, c, so, co = *(f(rest[m] + inside[m]) for f in (mp.sin, mp.cos)), mp.sin(out[m]), mp.cos(out[m])
                vectors.append((s * co, so, -c * co))
                u, v = inward[m], outward[m]
                rates.append((c * co * u - s * so * v, co * v, s * co * u + c * so * v))
            x, y, u, v = (inside[-1], out[-1], inward[-1], outward[-1]) if slides else [mp.mpf(0)] * 4
            return [*vectors, (top + x, y, mp.mpf(0))], [*rates, (u, v, mp.mpf(0))]

        def in_space(place, rate):
            return (rate[0] - n * place[1], rate[1] + n * place[0], rate[2])

        def along(m, depth, vectors):
            total = list(vectors[size])
            for r, length in [(m, depth), *((r, rows[r][1]) for r in range(m + 1, size))]:
                total = [x + length * y for x, y in zip(total, vectors[r], strict=True)]
            return total

        def square(vector):
            return sum(x * x for x in vector)

        def lagrangian(a, rate):
            e, f = placed(a, rate)
            total = mp.mpf(0)
            for m, (w, _, h, rho, p, c, fluid, hf, rf, added) in enumerate(rows):
                lent = -fluid if rig.fluid == "turning" else added
                for moves, bears, depth, turn in ((w, w, h, rho), (lent, -fluid, hf, rf)):
                    speed = square(in_space(along(m, depth, e), along(m, depth, f)))
                    total += moves / (2 * g) * (speed + turn**2 * square(in_space(e[m], f[m])))
                    total -= bears * along(m, depth, e)[2]
                x, y, z = e[m]
                if not free:
                    total += -p * n * z + c / (2 * g) * (n * z) ** 2
                elif p or c:
                    kept = p + c / g * n * mp.cos(rest[m])
                    total -= kept * z * ((x * f[m][1] - y * f[m][0]) / (x * x + y * y) + n)
            if slides:
                x, y, _ = e[size]
                total += mass / (2 * g) * square(in_space(e[size], f[size])) - stiffness / 2 * ((x - b) ** 2 + y**2)
            return total

        step, zero = mp.mpf(10) ** -18, [mp.mpf(0)] * count

        def moved(i, by):
            return [mp.mpf(by) * step if j == i else x for j, x in enumerate(zero)]

        def second(function, i, j, both):
            total = mp.mpf(0)
            for p, q in ((1, 1), (1, -1), (-1, 1), (-1, -1)):
                one, other = moved(i, p), moved(j, q)
                total += p * q * (function([x + y for x, y in zip(one, other, strict=True)]) if both else function(one, other))
            return total / (4 * step * step)

        inert, turn, stiff = (mp.zeros(count) for _ in range(3))
        for i in range(count):
            for j in range(count):
                inert[i, j] = second(lambda rate: lagrangian(zero, rate), i, j, True)
                stiff[i, j] = -second(lambda a: lagrangian(a, zero), i, j, True)
                turn[i, j] = second(lambda rate, a: lagrangian(a, rate), i, j, False)
        turn = turn - turn.T

        def drag(a, rate):
            e, f = placed(a, rate)
            tangents = [placed(a, [mp.mpf(i == j) for j in range(count)])[1] for i in range(count)]
            total = [mp.mpf(0)] * count
            for m in range(size):
                length = rows[m][1]
                for share in ((1 - 1 / mp.sqrt(3)) / 2, (1 + 1 / mp.sqrt(3)) / 2):
                    speed = in_space(along(m, share * length, e), along(m, share * length, f))
                    for i, tangent in enumerate(tangents):
                        moves = along(m, share * length, tangent)
                        total[i] += length / 2 * sum(x * y for x, y in zip(speed, moves, strict=True))
            return total

        slope = [[[(x - y) / (2 * step) for x, y in zip(drag(*up), drag(*down), strict=True)] for up, down in pairs]
                 for pairs in ([((zero, moved(j, 1)), (zero, moved(j, -1))) for j in range(count)],
                               [((moved(j, 1), zero), (moved(j, -1), zero)) for j in range(count)])]  # fmt: skip
        vectors = np.array([[float(x) for x in each] for each in placed(zero, zero)[0][:size]])
        seen = []
        for i in range(count):
            rates = placed(zero, [mp.mpf(i == j) for j in range(count)])[1][:size]
            across = np.cross(vectors, np.array([[float(x) for x in each] for each in rates]))
            relative, left, _ = turning(vectors, across, free and rig.support.radius == 0)
            left[:, :size] *= given.c == 0
            relative = relative.ravel()
            root = np.repeat(np.sqrt(np.ones(size) if dashpots is None else dashpots), 3)
            relative, left = relative * root, left * root[:, None]
            seen.append(relative + left @ np.linalg.lstsq(left, -relative, rcond=None)[0])
        bend = np.array(seen) @ np.array(seen).T
    return SimpleNamespace(
        inertia=inert, turn=turn, stiffness=stiff, friction=bend, speed=n, placed=placed,
        drag=np.array(slope[0], float).T, follow=np.array(slope[1], float).T,
    )  # fmt: skip


def first_order(motions, friction=0.0, drag=0.0):
    """The matrix of the damped motions, times in 1/n, in 40 digits."""
    friction, drag = mp.mpf(float(friction)), mp.mpf(float(drag))
    count, inverse = motions.inertia.rows, motions.inertia**-1
    whole = mp.zeros(2 * count)
    whole[:count, count:] = mp.eye(count)
    whole[count:, :count] = -inverse * (motions.stiffness + drag * mp.matrix(motions.follow.tolist())) / motions.speed**2
    rates = motions.turn + friction * mp.matrix(motions.friction.tolist()) + drag * mp.matrix(motions.drag.tolist())
    whole[count:, count:] = -inverse * rates / abs(motions.speed)
    return whole


def exponents(motions, **damping):
    """Exponents of small motions over the speed; those of a nearly massless support, at least 1e5, are left out."""
    with mp.workdps(40):
        found = mp.eig(first_order(motions, **damping), left=False, right=False)
        return [s for s in found if abs(s) < 1e5]


def balance(rows, n, place, turns=False, radius=0, stiffness=0, carriage=0):
    """Return the unbalanced loads of a steady shape at a speed: the moment about each upper pin and, on a spring, the force on
    the support; with it the sideways pull at each upper pin and the weight below it. `place`: inclinations, lowest
    first, then the offset of a support on a spring."""
    size, rate = len(rows), n * n / mp.mpf(G)
    sine, cosine = ([f(x) for x in place[:size]] for f in (mp.sin, mp.cos))
    top = place[size] if len(place) > size else radius
    moment, pull, hung = ([mp.mpf(0)] * size for _ in range(3))
    for m, (w, _, h, rho, p, c, fluid, hf, rf, added) in enumerate(rows):
        for bears, moves, depth, turn in ((w, w, h, rho), (-fluid, added - (fluid if turns else 0), hf, rf)):
            y = top + depth * sine[m] + sum(rows[r][1] * sine[r] for r in range(m + 1, size))
            for r in range(m, size):
                arm = depth if r == m else rows[r][1]
                moment[r] += arm * (bears * sine[r] - moves * rate * y * cosine[r])
                pull[r] += moves * rate * y
                hung[r] += bears
            moment[m] -= moves * rate * turn**2 * sine[m] * cosine[m]
        moment[m] += (p + c * n * cosine[m] / mp.mpf(G)) * n * sine[m]  # angular momentum along the axis, turned at n
    force = [pull[-1] + carriage * rate * top - stiffness * (top - radius)] if len(place) > size else []
    return [*moment, *force], pull, hung


def figure_moments(rig, shape, sense=1):
    """The largest of what is unbalanced in a shape, over weight times length, in 50 digits."""
    with mp.workdps(50):
        support, rows = rig.support, rows_of(rig)
        n = sense * mp.sqrt(mp.mpf(G) / mp.mpf(float(shape.conical_height)))
        place = [mp.mpf(float(x)) for x in (*shape.inclination, shape.offset[-1])]
        if math.isfinite(support.stiffness):
            held = {"radius": support.radius, "stiffness": support.stiffness, "carriage": support.carriage}
        else:
            held = {"radius": place.pop()}  # where the shape has it
        whole, length = sum(row[0] for row in rows), sum(row[1] for row in rows)
        gaps, _, _ = balance(rows, n, place, rig.fluid == "turning", **{name: mp.mpf(x) for name, x in held.items()})
        return float(max(abs(x) / (whole * (length if i < len(rows) else 1)) for i, x in enumerate(gaps)))
