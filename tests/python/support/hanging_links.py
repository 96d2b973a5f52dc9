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


def inclined_chain(links: list[Body], mode: int, inclination: float, digits: int = 25, steps: int = 16) -> mp.mpf:
    """Height at which the lowest link leans so, of the shape that grows out of a mode.

    Moments of a link about its upper pin, P the sum of W x of all that is lower, x from the axis to a centroid:
    sin (W h + a S) height = cos (a P + W h x + W r^2 sin). Each inclination follows from those below, by Newton's
    method of one unknown; started with the lowest link's inclination and a height, the support has to come out on the
    axis.
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
