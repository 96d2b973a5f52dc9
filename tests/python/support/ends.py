# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains held at both ends on arms and springs, with nothing of the library's: Lagrange's equations of their pins in
Cartesian coordinates in the frame that turns, lengths as constraints with multipliers."""

import math

import mpmath as mp
import numpy as np

import revchain as rc

G = 9.80665


class Pins:
    """A chain between two ends. Unknowns: offsets and heights of the pins that move, lowest first, then the pull of
    each link over its length. `span` is that of a shape of a chain held by a tension."""

    def __init__(self, held, speed, number=float, span=None):
        self.held, self.number, chain = held, number, held.system
        self.n, self.speed, self.g = chain.size, number(speed), number(0.0 if held.weightless else G)
        per = number(1.0 if chain.by_mass or held.weightless else G)
        heavy = chain.mass if chain.by_mass else chain.weight
        columns = np.broadcast_arrays(heavy, chain.length, chain.centroid, chain.radius_of_gyration)
        self.m, self.a, self.h, self.k = ([number(float(x)) for x in column] for column in columns)
        self.m = [m / per for m in self.m]
        self.span, self.ends = number(held.span if span is None else span), (held.lower, held.upper)
        n, zero = self.n, number(0)
        self.free_y = [i for i in range(n + 1) if 0 < i < n or math.isfinite(self.ends[i > 0].stiffness)]
        self.free_z = list(range(1, n))
        self.mass = [[zero] * (n + 1) for _ in range(n + 1)]
        self.weight = [zero] * (n + 1)
        for i in range(n):
            m, first, second = self.m[i], self.h[i] / self.a[i], (self.h[i] ** 2 + self.k[i] ** 2) / self.a[i] ** 2
            self.mass[i][i] += m * second
            self.mass[i][i + 1] += m * (first - second)
            self.mass[i + 1][i] += m * (first - second)
            self.mass[i + 1][i + 1] += m * (1 - 2 * first + second)
            self.weight[i] += m * first * self.g
            self.weight[i + 1] += m * (1 - first) * self.g
        self.spring = [zero] * (n + 1)
        for i, end in zip((0, n), self.ends, strict=True):
            if math.isfinite(end.stiffness):
                self.spring[i] = number(end.stiffness)
                self.mass[i][i] += number(end.carriage) / per
        self.rest = [zero] * (n + 1)
        self.rest[0], self.rest[n] = number(self.ends[0].radius), number(self.ends[1].radius)

    def places(self, x):
        y, z = list(self.rest), [self.number(0)] * self.n + [self.span]
        for j, i in enumerate(self.free_y):
            y[i] = x[j]
        for j, i in enumerate(self.free_z):
            z[i] = x[len(self.free_y) + j]
        return y, z, list(x[len(self.free_y) + len(self.free_z) :])

    def forces(self, y, z, pull):
        """On every pin, the ends too, by all but what holds these along the axis (and across it, if firm)."""
        n, square = self.n, self.speed**2
        across = [square * sum(self.mass[i][j] * y[j] for j in range(max(0, i - 1), min(n, i + 1) + 1)) for i in range(n + 1)]
        along = [-w for w in self.weight]
        for i in (0, n):
            across[i] -= self.spring[i] * (y[i] - self.rest[i])
        for i in range(n):
            for force, place in ((across, y), (along, z)):
                force[i] += pull[i] * (place[i + 1] - place[i])
                force[i + 1] -= pull[i] * (place[i + 1] - place[i])
        return across, along

    def gaps(self, x):
        y, z, pull = self.places(x)
        across, along = self.forces(y, z, pull)
        lengths = [((y[i + 1] - y[i]) ** 2 + (z[i + 1] - z[i]) ** 2 - self.a[i] ** 2) / 2 for i in range(self.n)]
        return [across[i] for i in self.free_y] + [along[i] for i in self.free_z] + lengths

    def slopes(self, x):
        """Derivatives of the gaps, which are of second degree, by columns."""
        size, one = len(x), self.number(1)
        columns = []
        for j in range(size):
            up, down = list(x), list(x)
            up[j] += one
            down[j] -= one
            columns.append([(a - b) / 2 for a, b in zip(self.gaps(up), self.gaps(down), strict=True)])
        return columns

    def settles(self, y, z, pull):
        """Whether every link points where it is pulled."""
        n, square = self.n, self.speed**2
        across, along = self.forces(y, z, pull)
        H = -(across[0] + self.spring[0] * (y[0] - self.rest[0]) - square * float(self.carriage(0)) * y[0]) / square
        tau, hung = along[0] / square, 0.0
        for i in range(n):
            m, a, h, k = self.m[i], self.a[i], self.h[i], self.k[i]
            turning, moment = m * (h * (a - h) - k * k) / a, m * h / a
            R, V = H + moment * y[i], self.g / square * (moment + hung) + tau
            s, c = (y[i] - y[i + 1]) / a, (z[i + 1] - z[i]) / a
            if not V * c + turning * (c * c - s * s) + R * s > 0:
                return False
            H, hung = R + (m - moment) * y[i + 1], hung + m
        return True

    def carriage(self, i):
        end = self.ends[i]
        return end.carriage if math.isfinite(end.stiffness) else 0.0

    def half_waves(self, y, z):
        """Sides of the line between the ends' places of rest, counted."""
        counted = [i for i in range(self.n + 1) if i in self.free_y]
        side = [y[i] - self.rest[0] - (self.rest[-1] - self.rest[0]) * z[i] / self.span > 0 for i in counted]
        return 1 + sum(a != b for a, b in zip(side, side[1:], strict=False))

    def newton(self, x, rounds=60, tolerance=1e-12):
        x = np.array(x, float)
        for _ in range(rounds):
            gap = np.array(self.gaps(list(x)))
            try:
                step = np.linalg.solve(np.array(self.slopes(list(x))).T, gap)
            except np.linalg.LinAlgError:
                return None
            size = np.abs(step).max()
            x = x - step * min(1.0, 2 * sum(self.a) / max(np.abs(step[: len(self.free_y) + len(self.free_z)]).max(), 1e-30))
            if size < tolerance * np.abs(x).max():
                return x
        return None


def shapes_by_pins(held, speed, rng, starts, most):
    """Newton's method from random places: (offsets, heights, unknowns) of all shapes found of up to `most` half waves."""
    pins, found = Pins(held, speed), []
    whole = held.system.total_length
    for _ in range(starts):
        share = np.cumsum(held.system.length)[:-1] / whole
        line = np.interp(np.arange(pins.n + 1) / pins.n, [0, 1], [pins.rest[0], pins.rest[-1]])
        y = line + rng.normal(0, 0.35 * whole, pins.n + 1)
        z = share * held.span + rng.normal(0, 0.3 * whole, pins.n - 1)
        pull = held.system.total_mass * speed**2 * rng.random(pins.n) * rng.choice([0.3, 1.0, 3.0])
        x = pins.newton(np.concatenate([y[pins.free_y], z, pull]))
        if x is None:
            continue
        y, z, pull = pins.places(list(x))
        if not pins.settles(y, z, pull) or pins.half_waves(y, z) > most:
            continue
        if held.lower.radius == held.upper.radius == 0:
            if max(abs(value) for value in y) < 1e-6 * whole:  # along the axis
                continue
            if y[1] < y[0]:
                y = [-value for value in y]
                x[: len(pins.free_y)] *= -1
        if not any(np.abs(np.subtract(y, other[0])).max() < 1e-6 for other in found):
            found.append((np.array(y), np.array(z), x))
    return found


def unknowns(pins, shape):
    """Those of a shape of the library, pulls by least squares from its places."""
    x = [*(float(shape.offset[i]) for i in pins.free_y), *(float(shape.height[i]) for i in pins.free_z)]
    none = np.array([float(gap) for gap in pins.gaps([*x, *[0.0] * pins.n])])
    rows = np.array([[float(gap) for gap in pins.gaps([*x, *unit])] for unit in np.eye(pins.n).tolist()]) - none
    return [*x, *np.linalg.lstsq(rows.T, -none, rcond=None)[0]]


def polished(held, speed, x, digits=50, span=None):
    """Inclinations of a shape by Newton's method with so many digits; `x`: the unknowns, or a shape of the library."""
    with mp.workdps(digits):
        pins = Pins(held, speed, mp.mpf, span)
        x = [mp.mpf(float(value)) for value in (unknowns(pins, x) if hasattr(x, "offset") else x)]
        for _ in range(7):
            step = mp.lu_solve(mp.matrix(pins.slopes(x)).T, mp.matrix(pins.gaps(x)))
            x = [value - change for value, change in zip(x, step, strict=True)]
        y, z, _ = pins.places(x)
        return [mp.atan2(y[i] - y[i + 1], z[i + 1] - z[i]) for i in range(pins.n)]


def random_held(rng, size, kind, lower, upper, share):
    mass, length = rng.uniform(0.5, 2.0, size), rng.uniform(0.5, 1.5, size)
    if kind == "plummets":
        chain = rc.Chain(mass=mass, length=length)
    else:
        chain = rc.Chain(mass=mass, length=length, centroid=length / 2, radius_of_gyration=length / 12**0.5)
    return rc.Held(chain, span=share * length.sum(), lower=lower, upper=upper)
