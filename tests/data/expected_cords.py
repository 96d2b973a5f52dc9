# SPDX-License-Identifier: GPL-3.0-or-later
"""Modes of uniform cords with point masses and a particle or a bob at the end, in many digits: Bessel functions between masses.

With V the weight below, offset y and pull u = V y' satisfy u' = -(line / height) y (' by the distance from the free end), and
at a mass m the pull falls by m y / height. Masses stand for weights. Between masses y = a J0(x) + b Y0(x) with
x = 2 sqrt(V / (line height)).
"""

import mpmath as mp


class Pieces:
    """A uniform cord with point masses and a tip or bob, in mpmath: Bessel functions between masses, from the free end."""

    def __init__(self, length, mass, masses, tip, centroid=0, gyration=0):
        self.length, self.mass, self.tip = mp.mpf(length), mp.mpf(mass), mp.mpf(tip)
        self.masses = [(mp.mpf(s), mp.mpf(x)) for s, x in sorted(masses)]
        self.centroid, self.gyration = self.bob = mp.mpf(centroid), mp.mpf(gyration)

    def start(self, height):
        """Offset and pull at the free end, with the inclination 1 of a bob."""
        if not self.centroid:
            return mp.mpf(1), -self.tip / height
        lever = self.centroid + self.gyration**2 / self.centroid
        offset = height - lever
        return offset, -self.tip / height * (offset + self.centroid)

    def states(self, height):
        """Place, weight below, offset and pull at the upper end of each piece, before the mass there."""
        height, line = mp.mpf(height), self.mass / self.length
        offset, pull = self.start(height)
        below, at = self.tip, mp.mpf(0)
        for place, mass in [*self.masses, (self.length, mp.mpf(0))]:
            above = below + line * (place - at)
            x, y = (2 * mp.sqrt(v / (line * height)) for v in (below, above))
            root = mp.sqrt(line / height)
            if below:
                # pull = V dy/ds = -root sqrt(V) (a J1 + b Y1), with sqrt(V) = x sqrt(line height) / 2
                ones = [-root * mp.sqrt(below) * mp.besselj(1, x), -root * mp.sqrt(below) * mp.bessely(1, x)]
                zeros = [mp.besselj(0, x), mp.bessely(0, x)]
                det = zeros[0] * ones[1] - zeros[1] * ones[0]
                a, b = (offset * ones[1] - pull * zeros[1]) / det, (zeros[0] * pull - ones[0] * offset) / det
            else:
                a, b = offset, mp.mpf(0)
            offset = a * mp.besselj(0, y) + b * (mp.bessely(0, y) if b else 0)
            pull = -root * mp.sqrt(above) * (a * mp.besselj(1, y) + b * (mp.bessely(1, y) if b else 0))
            yield place, above, offset, pull
            pull -= mass / height * offset
            below, at = above + mass, place

    def at_support(self, height):
        return list(self.states(height))[-1][2]

    def near(self, guess):
        """The height near a guess of double precision, by one step of the secant method: to the square of the guess's error."""
        low = mp.mpf(guess)
        high = low * (1 + mp.mpf(10) ** -13)
        value = self.at_support(low)
        return low - value * (high - low) / (self.at_support(high) - value)

    def heights(self, count, steps=4000):
        """The greatest heights, from changes of sign over even steps of the speed, 1/sqrt(height)."""
        found = []
        step = 40 / mp.sqrt(self.length) / steps
        last, before = step / 7, self.at_support((step / 7) ** -2)
        while len(found) < count:
            now = last + step
            value = self.at_support(now**-2)
            if value * before < 0:
                speed = mp.findroot(lambda n: self.at_support(n**-2), (last, now), solver="anderson", tol=mp.mpf(10) ** -60)
                found.append(mp.findroot(self.at_support, speed**-2, tol=mp.mpf(10) ** -120, verify=False))
            last, before = now, value
        return found

    def nodes(self, height):
        """Where the cord crosses the axis below the support, from changes of sign at many places, by bisection."""
        places = [self.length * k / 400 for k in range(1, 400)]
        values = [self.offset(height, s) for s in places]
        changes = [k for k in range(len(places) - 1) if values[k] * values[k + 1] < 0]
        return [
            mp.findroot(lambda s: self.offset(height, s), (places[k], places[k + 1]), solver="anderson", tol=mp.mpf(10) ** -60)
            for k in changes
        ]

    def offset(self, height, at):
        """The offset at a place: that at the upper end of a cord that ends there."""
        part = Pieces(at, self.mass / self.length * at, [x for x in self.masses if x[0] < at], self.tip, *self.bob)
        return part.at_support(height)
