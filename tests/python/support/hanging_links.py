# SPDX-License-Identifier: GPL-3.0-or-later
"""Exact heights of hanging chains, from mechanics alone: nothing here is the library's.

Rigid links on pins, lowest first. Offsets of the pins are the coordinates: with `a` the length, `h` the distance of
the centroid from the upper pin, `r` the radius of gyration and `S` the weight below a link, a small tilt of it costs
(W h + a S)/2 times its square, and it whirls with W times the squared offset of its centroid and W r^2 times the
squared tilt. Heights g/n^2 are those of K y = (1/height) M y; as many lie above x as x K - M has negative pivots.
Everything in decimal arithmetic of 60 digits and more, so that assembling loses nothing that is asked about.
"""

from __future__ import annotations

import math
from decimal import Context, Decimal, localcontext
from itertools import accumulate
from typing import NamedTuple

import mpmath as mp


class Body(NamedTuple):
    """A link: weight, length, distance of the centroid from the upper pin, square of the radius of gyration."""

    weight: Decimal
    length: Decimal
    centroid: Decimal
    gyration_squared: Decimal


def wide(digits: int) -> Context:
    """Decimal arithmetic in which nothing overflows."""
    return Context(prec=digits, Emax=10**8, Emin=-(10**8))


def plummets(weight, length) -> list[Body]:
    return [Body(Decimal(w), Decimal(a), Decimal(a), Decimal(0)) for w, a in zip(weight, length, strict=True)]


def rods(weight, length) -> list[Body]:
    with localcontext(wide(60)):
        return [
            Body(Decimal(w), Decimal(a), Decimal(a) / 2, Decimal(a) ** 2 / 12)
            for w, a in zip(weight, length, strict=True)
        ]


def bodies(weight, length, centroid, gyration) -> list[Body]:
    with localcontext(wide(60)):
        return [
            Body(Decimal(w), Decimal(a), Decimal(h), Decimal(r) ** 2)
            for w, a, h, r in zip(weight, length, centroid, gyration, strict=True)
        ]


class Hanging:
    """The pencil of a chain, its counts and its heights.

    A support that yields to a spring (weight over length) and moves a carriage adds a coordinate.
    """

    def __init__(self, links: list[Body], *, spring: float | None = None, carriage: float = 0.0, digits: int = 60):
        self.links = links
        self.context = wide(digits)
        with localcontext(self.context):
            size = len(links)
            stiff, mass = [Decimal(0)] * (size + 1), [Decimal(0)] * (size + 1)
            self.stiff_off, self.mass_off = [], []
            below = Decimal(0)
            for i, (w, a, h, r2) in enumerate(links):
                k = (w * h + a * below) / (a * a)
                tilt = w * r2 / (a * a)
                low, up = h / a, 1 - h / a  # the centroid's share of either pin
                stiff[i] += k
                stiff[i + 1] += k
                self.stiff_off.append(-k)
                mass[i] += w * low * low + tilt
                mass[i + 1] += w * up * up + tilt
                self.mass_off.append(w * low * up - tilt)
                below += w
            if spring is not None:
                stiff[size] += Decimal(spring)
                mass[size] += Decimal(carriage)
            last = size + (spring is not None)
            self.stiff, self.mass = stiff[:last], mass[:last]
            self.pairs = list(zip(self.stiff[1:], self.mass[1:], self.stiff_off, self.mass_off, strict=False))

    def above(self, height) -> int:
        """How many heights are larger."""
        with localcontext(self.context):
            x = Decimal(height)
            pivot = x * self.stiff[0] - self.mass[0]
            count = pivot < 0
            for stiff, mass, stiff_off, mass_off in self.pairs:
                if not pivot:
                    pivot = Decimal(10) ** -(10**5)
                off = x * stiff_off - mass_off
                pivot = x * stiff - mass - off * off / pivot
                count += pivot < 0
            return count

    def lies_within(self, mode: int, height: float, bound: float, low: float = 0.0) -> bool:
        """Whether the exact height is no farther than `bound`, relative to itself, from height + low."""
        with localcontext(self.context):
            given, b = Decimal(height) + Decimal(low), Decimal(bound)
            if b < 1 and self.above(given / (1 - b)) >= mode:
                return False
            return self.above(given / (1 + b) * (1 - Decimal(10) ** -40)) >= mode

    def height(self, mode: int, near: float | None = None, digits: int = 30) -> Decimal:
        """Height of a mode, slowest first from 1; `near` saves time and is not believed."""
        with localcontext(self.context):
            if near is not None and near > 0 and math.isfinite(near):
                low, high = Decimal(near) * (1 - Decimal("1e-15")), Decimal(near) * (1 + Decimal("1e-15"))
                if self.above(low) < mode or self.above(high) >= mode:
                    low = None
            else:
                low = None
            if low is None:
                low = high = sum(link.length for link in self.links)
                while self.above(high) >= mode:
                    low, high = high, 16 * high
                while self.above(low) < mode:
                    low, high = low / 16, low
            while high - low > high * Decimal(10) ** -digits:
                middle = (low + high) / 2 if high < 2 * low else (low * high).sqrt()
                if self.above(middle) >= mode:
                    low = middle
                else:
                    high = middle
            return (low + high) / 2


def dense_heights(links: list[Body]) -> list[mp.mpf]:
    """All heights, descending, of the same links in other coordinates: their tilts, dense, with 60 digits."""
    with mp.workdps(60):
        rows = [tuple(mp.mpf(str(number)) for number in link) for link in links]
        size = len(rows)
        below = [mp.mpf(0), *accumulate(row[0] for row in rows)]
        # A tilt of link j moves its own centroid by h_j and those of all lower links by a_j.
        moved = mp.matrix(size, size)
        for body in range(size):
            moved[body, body] = rows[body][2]
            for tilt in range(body + 1, size):
                moved[body, tilt] = rows[tilt][1]
        scale = [1 / mp.sqrt(rows[j][0] * rows[j][2] + rows[j][1] * below[j]) for j in range(size)]
        whirl = mp.matrix(size, size)
        for i in range(size):
            for j in range(size):
                total = sum(rows[body][0] * moved[body, i] * moved[body, j] for body in range(min(i, j) + 1))
                if i == j:
                    total += rows[i][0] * rows[i][3]
                whirl[i, j] = total * scale[i] * scale[j]
        return sorted(mp.eigsy(whirl, eigvals_only=True), reverse=True)


def inclined_height(links: list[Body], mode: int, inclination: float, digits: int = 40) -> mp.mpf:
    """Height at which the lowest link leans so, of the shape that grows out of a mode; a few links.

    Moments of a link about its upper pin, P the sum of W x of all that is lower, x from the axis to a centroid:
    sin (W h + a S) height = cos (a P + W h x + W r^2 sin). Unknown are the other inclinations and the height,
    followed from the straight chain in steps of the lowest link's inclination by Newton's method.
    """
    with mp.workdps(digits + 10):
        rows = [tuple(mp.mpf(str(number)) for number in link) for link in links]
        size = len(rows)
        if size == 1:
            _, _, h, r2 = rows[0]
            return mp.cos(mp.mpf(inclination)) * (h + r2 / h)
        straight = mp.mpf(str(Hanging(links).height(mode)))

        def moments(first, unknown):
            angles, height = [first, *unknown[:-1]], unknown[-1]
            upper, places = mp.mpf(0), [mp.mpf(0)] * size
            for j in reversed(range(size)):
                places[j] = upper + rows[j][2] * mp.sin(angles[j])
                upper += rows[j][1] * mp.sin(angles[j])
            outward, below, residuals = mp.mpf(0), mp.mpf(0), []
            for (w, a, h, r2), x, angle in zip(rows, places, angles, strict=True):
                pull = a * outward + w * h * x + w * r2 * mp.sin(angle)
                residuals.append((mp.sin(angle) * (w * h + a * below) * height - mp.cos(angle) * pull))
                outward += w * x
                below += w
            return residuals

        # The mode itself: tilts from the linear moments, link by link upward.
        tiny, steps = min(mp.mpf("1e-6"), mp.mpf(inclination) / 10), 12

        def linear(height):
            tilts, places = [mp.mpf(1)], []
            outward, below = mp.mpf(0), mp.mpf(0)
            lower = None
            for j, (w, a, h, r2) in enumerate(rows):
                if j == 0:
                    x = height - r2 / h
                    lower = x + (a - h)
                    tilt = mp.mpf(1)
                else:
                    # x = lower - (a - h) tilt
                    tilt = (a * outward + w * h * lower) / ((w * h + a * below) * height + w * h * (a - h) - w * r2)
                    x = lower - (a - h) * tilt
                    tilts.append(tilt)
                places.append(x)
                outward += w * x
                below += w
                lower = lower - a * tilt
            return tilts

        guess = [tilt * tiny for tilt in linear(straight)[1:]] + [straight]
        first = tiny
        target = mp.mpf(inclination)
        previous, step = None, (target - tiny) / steps
        tight = {"tol": mp.mpf(10) ** (-2 * digits), "maxsteps": 60, "verify": False}
        solved = list(mp.findroot(lambda *u: moments(first, u), guess, **tight))
        while first < target:
            new = min(first + step, target)
            if previous is None:
                guess = [value * new / first for value in solved[:-1]] + [solved[-1]]
            else:
                ratio = (new - first) / (first - previous[0])
                guess = [v + (v - p) * ratio for v, p in zip(solved, previous[1], strict=True)]
            found = list(mp.findroot(lambda *u: moments(new, u), guess, **tight))  # noqa: B023
            if max(abs(r) for r in moments(new, found)) > mp.mpf(10) ** (-digits) * rows[0][0] * rows[0][1] ** 2:
                raise AssertionError("the reference itself has not converged")
            previous, solved, first = (first, solved), found, new
        return solved[-1]


def inclined_chain(links: list[Body], mode: int, inclination: float, digits: int = 25, steps: int = 16) -> mp.mpf:
    """The same for any number of links: each inclination follows from those below, by Newton's method of one unknown.

    Started with the lowest link's inclination and a height, the support has to come out on the axis.
    """
    with mp.workdps(digits + 5):
        rows = [tuple(mp.mpf(str(number)) for number in link) for link in links]

        def off_axis(height, angle):
            w, a, h, r2 = rows[0]
            x = height * mp.tan(angle) - r2 * mp.sin(angle) / h
            outward, borne = w * x, w
            x -= h * mp.sin(angle)
            for w, a, h, r2 in rows[1:]:
                pull, stiff = a * outward + w * h * x, (w * h + a * borne) * height
                less = w * h * (a - h) - w * r2
                tilt = mp.atan(pull / (stiff + less))
                for _ in range(60):
                    s, c = mp.sin(tilt), mp.cos(tilt)
                    change = (s * stiff - c * (pull - less * s)) / (
                        c * stiff + s * (pull - less * s) + c * c * less
                    )
                    tilt -= change
                    if abs(change) < mp.mpf(10) ** (-digits - 3):
                        break
                s = mp.sin(tilt)
                outward += w * (x - (a - h) * s)
                borne += w
                x -= a * s
            return x / mp.sin(angle)

        height = [mp.mpf(str(Hanging(links).height(mode)))] * 2
        for step in range(1, steps + 1):
            angle = mp.mpf(inclination) * step / steps
            guess = 2 * height[-1] - height[-2]
            root = mp.findroot(
                lambda y: off_axis(y, angle),  # noqa: B023
                (guess, guess * (1 - mp.mpf("1e-6"))),
                solver="secant",
                tol=mp.mpf(10) ** (-2 * digits),
                maxsteps=60,
                verify=False,
            )
            height.append(root)
        if abs(off_axis(height[-1], angle)) > sum(row[1] for row in rows) * mp.mpf(10) ** (-digits // 2):
            raise AssertionError("the reference itself has not converged")
        return height[-1]
