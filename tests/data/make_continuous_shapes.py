# SPDX-License-Identifier: MPL-2.0
"""Steady shapes of chains without links, to 22 digits: python make_continuous_shapes.py > continuous_shapes.csv

Conical height 1. Power series in the arc length itself (the library's are in another variable) of

    u' = -rho eta,   V' = rho,   eta' = u / sqrt(u^2 + V^2),   xi' = V / sqrt(u^2 + V^2),

eta the offset, xi the height above the free end, in mpmath, steps short against the radius of convergence; from the free
end with rho = s^p r(s), u = s^(p+1) (...), V = s^(p+1) (...). The free end's offset first in floats by bisection on the
number of crossings, then by the chord in mpmath until the support lies on the axis to 26 digits. Some minutes.
"""
import math

import mpmath as mp

mp.mp.dps = 36
ORDER, ACCURACY = 40, mp.mpf(10) ** -31


class Density:
    """rho(s) of a chain of length L as a name says: uniform, power:p, linear, bump."""

    def __init__(self, name, length, number):
        self.kind, _, power = name.partition(":")
        self.number, self.length = number, number(length)
        self.power = number(power) if power else number(0)
        self.tip_power = self.power

    def about(self, s, order, regular=False):
        """Coefficients at s; with `regular`, of rho / s^p at 0."""
        m, L = self.number, self.length
        if self.kind == "uniform" or (regular and self.kind == "power"):
            scale = m(1) if self.kind == "uniform" else L ** -self.power
            return [scale] + [m(0)] * order
        if self.kind == "power":
            out = [(s / L) ** self.power]
            for k in range(order):
                out.append(out[-1] * (self.power - k) / ((k + 1) * s))
            return out
        if self.kind == "linear":
            return [m(1) / 5 + 8 * s / (5 * L), m(8) / (5 * L)] + [m(0)] * (order - 1)
        c, w = 2 * L / m(5), L / m(10)
        x = (s - c) / w
        gauss = [(mp.exp if m is mp.mpf else math.exp)(-x * x)]
        for k in range(order):  # g' = -2 (x + h/w)/w g
            below = gauss[k - 1] / w if k else m(0)
            gauss.append(-2 * (x * gauss[k] + below) / (w * (k + 1)))
        return [m(1) + 3 * gauss[0]] + [3 * g for g in gauss[1:]]


def product(a, b, n):
    return sum(a[i] * b[n - i] for i in range(n + 1))


def sqrt_of(c, root):
    out = [root(c[0])]
    for n in range(1, len(c)):
        out.append((c[n] - sum(out[i] * out[n - i] for i in range(1, n))) / (2 * out[0]))
    return out


def series(rho, eta0, u0, V0, p, order, number, root):
    """eta, u, V, xi about a place; with u0 = V0 = None about a free end without weight, u and V over s^(p+1)."""
    tip = u0 is None
    shift = p + 1 if tip else number(0)
    eta, u, V, xi, size, T = [eta0], [], [], [number(0)], [], []
    for n in range(order + 1):
        if tip:
            u.append(-product(rho, eta, n) / (n + shift))
            V.append(rho[n] / (n + shift))
        elif n == 0:
            u.append(u0), V.append(V0)
        else:
            u.append(-product(rho, eta, n - 1) / n)
            V.append(rho[n - 1] / n)
        size.append(product(u, u, n) + product(V, V, n))
        if n == 0:
            T.append(root(size[0]))
        else:
            T.append((size[n] - sum(T[i] * T[n - i] for i in range(1, n))) / (2 * T[0]))
        if n == order:
            break
        # eta' T = u
        slope = (u[n] - sum((k + 1) * eta[k + 1] * T[n - k] for k in range(n))) / T[0]
        rise = (V[n] - sum((k + 1) * xi[k + 1] * T[n - k] for k in range(n))) / T[0]
        eta.append(slope / (n + 1))
        xi.append(rise / (n + 1))
    return eta, u, V, xi


def value(c, h):
    out = c[-1]
    for x in reversed(c[:-1]):
        out = out * h + x
    return out


def follow(name, length, tip, eta0, precise, stops=(), crossings=None):
    """(eta at `length`, places at stops, places where u = 0, number of crossings)."""
    number = mp.mpf if precise else float
    root = mp.sqrt if precise else math.sqrt
    order, accuracy = (ORDER, ACCURACY) if precise else (16, 1e-16)
    rho = Density(name, length, number)
    end, tip, eta0 = number(length), number(tip), number(eta0)
    stops = [number(s) for s in stops]
    s, eta, u, V, xi = number(0), eta0, -tip * eta0, tip, number(0)
    found, turns, count = {}, [], 0
    while s < end:
        at_tip = s == 0 and tip == 0
        p = rho.tip_power
        powers = rho.about(s, order, regular=at_tip) if not (s == 0 and rho.kind == "power" and not at_tip) else None
        if powers is None:  # a tip weight under a power law: s^p has no series; a whole power has
            powers = [number(0)] * (order + 1)
            powers[int(p)] = rho.length ** -p
        e, uu, VV, x = series(powers, eta, None if at_tip else u, None if at_tip else V, p, order, number, root)
        scale = abs(eta0)
        h = end - s
        for n in (order - 1, order):
            for c, size in ((e, scale), (uu, abs(uu[0]) + abs(VV[0])), (x, number(1)), (VV, abs(uu[0]) + abs(VV[0]))):
                if c[n] != 0:
                    h = min(h, (accuracy * size / abs(c[n])) ** (number(1) / n))
        factor = lambda t: t ** (p + 1) if at_tip else number(1)
        for stop in stops:
            if s <= stop <= s + h and stop not in found:
                t = stop - s
                if at_tip and t == 0:
                    found[stop] = (eta0, -eta0, number(1), number(0))
                else:
                    found[stop] = (value(e, t), value(uu, t) * factor(t), value(VV, t) * factor(t), xi + value(x, t))
        new = (value(e, h), value(uu, h) * factor(h), value(VV, h) * factor(h), xi + value(x, h))
        count += (new[0] > 0) != (eta > 0)
        if u * new[1] < 0:
            turns.append(s + h * u / (u - new[1]))
        s = end if s + h >= end else s + h
        eta, u, V, xi = new
        if crossings is not None and count > crossings:
            break
    return eta, found, turns, count


def tip_offset(name, length, tip, waves):
    """In floats: the offset below which the support lies beyond crossing `waves`."""
    low, high = 1e-9, float(length)
    if follow(name, length, tip, low, False)[3] < waves:
        return None
    for _ in range(60):
        middle = math.sqrt(low * high) if high > 2 * low else (low + high) / 2
        if follow(name, length, tip, middle, False, crossings=waves)[3] >= waves:
            low = middle
        else:
            high = middle
        if high - low < 1e-15 * high:
            break
    return low


CASES = [
    ("uniform", 1.4458, 0, [1]), ("uniform", 1.5, 0, [1]), ("uniform", 2, 0, [1]), ("uniform", 7.618, 0, [1, 2]),
    ("uniform", 10, 0, [1, 2]), ("uniform", 50, 0, [1, 2, 3, 4]), ("uniform", 500, 0, list(range(1, 15))),
    ("uniform", 10000, 0, [1, 2, 20]),
    ("uniform", 2, 0.001, [1]), ("uniform", 10, 0.01, [1, 2]), ("uniform", 10, 1, [1, 2]), ("uniform", 50, 1e-6, [1, 4]),
    ("uniform", 50, 1, [1, 2, 3, 4]), ("uniform", 50, 100, [1, 2]), ("uniform", 500, 1000, [1, 2, 3, 4]),
    ("uniform", 10000, 1, [1, 8]), ("uniform", 10000, 1000, [1, 8]),
    ("power:0.5", 30, 0, [1, 2, 3]), ("power:2", 30, 0, [1, 2, 3]), ("power:-0.25", 30, 0, [1, 2, 3]),
    ("linear", 50, 0, [1, 2, 3, 4]), ("bump", 50, 0, [1, 2, 3, 4]), ("bump", 500, 0, [1, 7]), ("linear", 50, 5, [1, 2, 3]),
    ("bump", 50, 20, [1, 2]), ("bump", 2, 0, [1]),
]


def main():
    print("density,length,tip_weight,half_waves,arc_length,offset,inclination,height")
    for name, length, tip, numbers in CASES:
        for waves in numbers:
            guess = tip_offset(name, length, tip, waves)
            if guess is None:
                continue
            step = 1e-5 * guess
            at = [follow(name, length, tip, guess + d, False)[0] for d in (-step, step)]
            slope = (at[1] - at[0]) / (2 * step)
            tip_eta, off = mp.mpf(guess), None
            for _ in range(12):
                before = off
                off, _, turns, count = follow(name, length, tip, tip_eta, True)
                if before is not None and off != before:
                    slope = (off - before) / (tip_eta - last)
                if abs(off) < mp.mpf(10) ** -26 * length * min(1, tip_eta):
                    break
                last = tip_eta
                tip_eta -= off / slope
            else:
                raise ArithmeticError((name, length, tip, waves, off))
            turning = sorted({float(t) for t in turns})
            kept = {turning[0], turning[len(turning) // 2], turning[-1]} if turning else set()
            stops = sorted({length * i / 8 for i in range(9)} | kept)
            found = follow(name, length, tip, tip_eta, True, stops)[1]
            top = found[mp.mpf(length)][3]
            for stop in stops:
                eta, u, V, xi = found[mp.mpf(stop)]
                texts = (mp.nstr(v, 22, strip_zeros=False) for v in (eta, -mp.atan2(u, V), xi - top))
                print(f"{name},{length!r},{tip!r},{waves},{stop!r},{','.join(texts)}", flush=True)


if __name__ == "__main__":
    main()
