# SPDX-License-Identifier: GPL-3.0-or-later
"""Random systems by mass and by weight, and the mechanics of exactly the numbers given, in 60 digits, with nothing of
the library's: small motions ``(K + n P - n^2 M) y = 0`` in newtons, metres and seconds, and steady shapes."""

import math

import mpmath as mp
import numpy as np
from rigs import G, assembled, balance

import revchain as rc


def power(rng, most, size=None):
    return 10.0 ** rng.uniform(-most, most, size)


class System:
    """Numbers of links as given, lowest first, and of what holds them; `by` is the name of what is heavy."""

    def __init__(self, rng, by, most_links=12, extreme=True):
        self.by = by
        self.unit = G if by == "mass" else 1.0  # the weight of one of what is heavy, without gravity of 1 kg
        self.size = n = int(rng.integers(1, most_links + 1))
        spread = 8 if extreme and rng.random() < 0.1 else 2
        self.heavy, self.a = power(rng, spread, n), power(rng, 1, n)
        self.h, self.rho, self.given = self.a, np.zeros(n), {}
        if rng.random() < 0.75:
            self.h, self.rho = self.a * rng.uniform(0.05, 1.5, n), self.a * rng.uniform(0, 1, n)
            self.given = {"centroid": self.h, "radius_of_gyration": self.rho}
        self.chain = rc.Chain(**{by: self.heavy}, length=self.a, **self.given)
        self.whole, self.long = self.heavy.sum(), self.a.sum()
        self.stiffness, self.carriage = [math.inf, math.inf], [0.0, 0.0]  # of the lower end and the upper one
        self.momentum, self.axial = [mp.mpf(0)] * n, [mp.mpf(0)] * n
        self.fluid, self.hf, self.rf, self.added, self.turns = np.zeros(n), self.h, self.rho, np.zeros(n), False
        self.inverted = np.zeros(n, bool)

    def spring(self, rng, above=1, carriage=None, most=3, radius=0.0):
        """A support on a spring."""
        stiffness = float(self.unit * self.whole / self.long * power(rng, most))
        if carriage is None:
            carriage = float(rng.random() < 0.7) * self.whole * power(rng, 2)
        self.stiffness[above], self.carriage[above] = stiffness, float(carriage)
        return rc.Support(stiffness=stiffness, radius=radius, **{self.by: float(carriage)})

    def wheels(self, rng):
        """Wheels by momentum, or free or driven ones by their spin."""
        n, per = self.size, math.sqrt(G) if self.by == "mass" else 1 / math.sqrt(G)
        if rng.random() < 0.5:
            momentum = per * self.heavy * self.a**1.5 * power(rng, 2, n) * rng.choice([-1, 1], n)
            axial = self.heavy * self.rho**2 * rng.uniform(0, 1, n) * (rng.random() < 0.3)
            self.momentum, self.axial = _numbers(momentum), _numbers(axial)
            return rc.Flywheel(momentum=momentum, axial_moment=axial)
        heavy, radius = self.heavy * rng.uniform(0.1, 1, n), np.where(self.rho > 0, self.rho, self.a) * rng.uniform(0.1, 0.9, n)
        spin, driven = power(rng, 2, n) * rng.choice([-1, 1], n), rng.random(n) < 0.3 * (self.rho[0] > 0)
        inertia = [w * r * r for w, r in zip(_numbers(heavy), _numbers(radius), strict=True)]
        force = 1 if self.by == "mass" else mp.mpf(G)
        self.momentum = [c * n / force for c, n in zip(inertia, _numbers(spin), strict=True)]
        self.axial = [c if turns else mp.mpf(0) for c, turns in zip(inertia, driven, strict=True)]
        return rc.Flywheel(**{self.by: heavy}, radius_of_gyration=radius, spin=spin, driven=driven)

    def displaced(self, rng, turns):
        n, given = self.size, {}
        self.fluid, self.turns = self.heavy * rng.uniform(0, 0.7, n), turns
        if rng.random() < 0.5:
            self.hf, self.rf = self.h * rng.uniform(0.5, 1.2, n), self.a * rng.uniform(0, 1, n)
            given = {"centroid": self.hf, "radius_of_gyration": self.rf}
        if not turns:
            self.added = self.fluid * rng.uniform(0, 1, n)
            given[f"added_{self.by}"] = self.added
        return rc.Displaced(**{self.by: self.fluid}, **given)

    def rig(self, rng, spring=0.6, wheels=0.4, fluid=0.25, inverted=0.2, carriage=None, most=3, radius=0.0):
        """A random rig of the chain."""
        given = {"support": rc.Support(radius=radius)}
        if rng.random() < spring:
            given["support"] = self.spring(rng, carriage=carriage, most=most, radius=radius)
        if rng.random() < wheels:
            given["flywheels"] = self.wheels(rng)
        if rng.random() < fluid:
            turns = bool(rng.random() < 0.3)
            given |= {"displaced": self.displaced(rng, turns), "fluid": "turning" if turns else "still"}
        if rng.random() < inverted:
            self.inverted = rng.random(self.size) < 0.5
            given["inverted"] = self.inverted
        return rc.Rig(self.chain, **given)

    def held(self, rng):
        """The chain held straight by a tension; returns it and the tension at its lower end in newtons."""
        weightless, ends = bool(rng.random() < 0.4), {}
        if weightless:
            self.unit = G  # weights are masses
        for above, name in enumerate(("lower", "upper")):
            if rng.random() < 0.4:
                ends[name] = self.spring(rng, above)
        weight = self.unit * self.whole
        tension = float(weight * power(rng, 1)) if weightless else float(weight * (1 + power(rng, 3)))
        held = rc.Held(self.chain, tension=tension, weightless=weightless, **ends)
        if weightless:
            return held, (mp.mpf(tension), True)
        force = mp.mpf(G if self.by == "mass" else 1.0)
        return held, (mp.mpf(tension) - force * sum(_numbers(self.heavy)), False)

    def figure(self, n, radius, x):
        """Return the unbalanced moments and force in a steady shape of a rig, see `balance`."""
        held = {"radius": mp.mpf(radius)}
        if math.isfinite(self.stiffness[1]):
            held |= {"stiffness": mp.mpf(self.stiffness[1]), "carriage": mp.mpf(self.unit) * mp.mpf(self.carriage[1])}
        return balance(self._rows(), n, x, self.turns, **held)[0]

    def _rows(self):
        """Links by weight, as `rigs.balance` takes them."""
        force, heavy = mp.mpf(self.unit), (self.heavy, self.fluid, self.added)
        w, fluid, added = ([force * x for x in _numbers(column)] for column in heavy)
        a, h, rho, hf, rf = (_numbers(column) for column in (self.a, self.h, self.rho, self.hf, self.rf))
        axial = [force * c for c in self.axial]
        return list(zip(w, a, h, rho, self.momentum, axial, fluid, hf, rf, added, strict=True))

    def pencil(self, pull=None):
        """The pencil of the pins. `pull`: tension at the lower end, and whether without gravity."""
        below, weightless = pull or (0, False)
        stiff, spin, mass = assembled(self._rows(), self.inverted, self.turns, below, 0 if weightless else 1)
        yields = [math.isfinite(stiffness) for stiffness in self.stiffness]
        for above, end in enumerate((0, self.size)):
            if yields[above]:
                stiff[end][end] += mp.mpf(self.stiffness[above])
                mass[end][end] += mp.mpf(self.unit) * mp.mpf(self.carriage[above])
        whole = []
        for matrix, unit in ((stiff, 1), (spin, 1), (mass, mp.mpf(G))):
            diagonal = [matrix[i][i] / unit for i in range(self.size + 1)]
            whole.append((diagonal, [matrix[i][i + 1] / unit for i in range(self.size)]))
        first, last = 1 if pull and not yields[0] else 0, self.size + yields[1]
        return Pencil([(diagonal[first:last], beside[first : last - 1]) for diagonal, beside in whole], *whole)


class Pencil:
    """K, P and M of the pins that can move; `whole` also has the row of the support."""

    def __init__(self, moving, *whole):
        self.moving, self.whole = moving, whole

    def at(self, n, whole=False):
        """K + n P - n^2 M, its diagonal and what is beside that."""
        (k, k1), (p, p1), (m, m1) = self.whole if whole else self.moving
        square = n * n
        return (
            [x + n * y - square * z for x, y, z in zip(k, p, m, strict=True)],
            [x + n * y - square * z for x, y, z in zip(k1, p1, m1, strict=True)],
        )

    def below(self, n):
        """How many pivots are negative."""
        diagonal, beside = self.at(n)
        count, pivot = 0, mp.mpf(1)
        for i, x in enumerate(diagonal):
            pivot = x - (beside[i - 1] ** 2 / pivot if i else 0)
            pivot = pivot or mp.mpf(10) ** -200
            count += pivot < 0
        return count

    def between(self, low, high):
        """Whether a speed makes K + n P - n^2 M singular between these two."""
        return self.below(low) != self.below(high)

    def root(self, n, rounds=8):
        """The complex speed next to this one, by Newton's method on the determinant."""
        (_, _), (p, p1), (m, m1) = self.moving
        for _ in range(rounds):
            diagonal, beside = self.at(n)
            one, two, d_one, d_two = mp.mpc(1), mp.mpc(0), mp.mpc(0), mp.mpc(0)
            for i, x in enumerate(diagonal):
                change = p[i] - 2 * n * m[i]
                square, d_square = (beside[i - 1] ** 2, 2 * beside[i - 1] * (p1[i - 1] - 2 * n * m1[i - 1])) if i else (0, 0)
                value = x * one - square * two
                d_value = change * one + x * d_one - d_square * two - square * d_two
                one, two, d_one, d_two = value, one, d_value, d_one
            n -= one / d_one
        return n

    def forced(self, n, radius, stiffness):
        """Offsets of all pins, lowest first, and the outward pull on the support, carried at a speed."""
        diagonal, beside = self.at(n, whole=True)
        size = len(beside)
        if math.isinf(stiffness):
            y = solved(diagonal[:size], beside[: size - 1], [mp.mpf(0)] * (size - 1) + [-beside[-1] * radius]) + [radius]
            return y, -(beside[-1] * y[-2] + diagonal[-1] * radius)
        y = solved(diagonal, beside, [mp.mpf(0)] * size + [stiffness * radius])
        return y, stiffness * (y[-1] - radius)

    def swung(self, offset, velocity, times):
        """Offsets of what moves at times after a start, without wheels: a sum of modes."""
        (k, k1), _, (m, m1) = self.moving
        size = len(k)

        def dense(diagonal, beside):
            full = mp.zeros(size)
            for i in range(size):
                full[i, i] = diagonal[i]
                if i:
                    full[i, i - 1] = full[i - 1, i] = beside[i - 1]
            return full

        mass = dense(m, m1)
        root = mp.cholesky(mass)
        inverse = root**-1
        squares, vectors = mp.eigsy(inverse * dense(k, k1) * inverse.T)
        shapes = inverse.T * vectors
        back = shapes.T * mass
        one, two = back * mp.matrix(offset), back * mp.matrix(velocity)
        found = []
        for t in times:
            part = mp.matrix(size, 1)
            for j in range(size):
                n = mp.sqrt(squares[j])
                part[j] = one[j] * mp.cos(n * t) + two[j] * mp.sin(n * t) / n
            found.append(list(shapes * part))
        return found

    def whirled(self, offset, velocity, times, speeds):
        """Offsets of what moves with wheels, M z'' - i P z' + K z = 0: a sum of whirls, each near one of the speeds."""
        size, roots, shapes = len(offset), [mp.re(self.root(mp.mpc(n))) for n in speeds], []
        assert len(roots) == 2 * size
        for n in roots:
            (diagonal, beside), y = self.at(n), [mp.mpf(1)]
            for i in range(size - 1):
                y.append(-(diagonal[i] * y[i] + (beside[i - 1] * y[i - 1] if i else 0)) / beside[i])
            shapes.append(y)
        both = mp.matrix([[y[i] for y in shapes] for i in range(size)] + [[n * y[i] for n, y in zip(roots, shapes, strict=True)] for i in range(size)])
        part = mp.lu_solve(both, mp.matrix([*offset, *(v / mp.mpc(0, 1) for v in velocity)]))
        return [[mp.fsum(part[j] * y[i] * mp.expj(n * t) for j, (n, y) in enumerate(zip(roots, shapes, strict=True)))
                 for i in range(size)] for t in times]  # fmt: skip


def solved(diagonal, beside, right):
    """The solution of a tridiagonal system, eliminated from the first row on."""
    pivots, sides = list(diagonal), list(right)
    for i in range(1, len(pivots)):
        ratio = beside[i - 1] / pivots[i - 1]
        pivots[i] = pivots[i] - ratio * beside[i - 1]
        sides[i] = sides[i] - ratio * sides[i - 1]
    for i in reversed(range(len(pivots))):
        rest = beside[i] * sides[i + 1] if i + 1 < len(pivots) else 0
        sides[i] = (sides[i] - rest) / pivots[i]
    return sides


def newton(gaps, x, rounds=5):
    """The zero of as many gaps as there are unknowns, next to x known to 12 digits."""
    step = mp.mpf(10) ** -(mp.mp.dps // 2)
    for _ in range(rounds):
        at, size = gaps(x), len(x)
        slopes = mp.zeros(size)
        for j in range(size):
            by = step * max(abs(x[j]), mp.mpf(10) ** -3)
            moved = gaps([value + by if i == j else value for i, value in enumerate(x)])
            for i in range(size):
                slopes[i, j] = (moved[i] - at[i]) / by
        change = mp.lu_solve(slopes, mp.matrix(at))
        x = [value - off for value, off in zip(x, change, strict=True)]
    return x


def _numbers(values):
    return [mp.mpf(float(x)) for x in values]
