# SPDX-License-Identifier: GPL-3.0-or-later
"""References in mpmath that several tests share: conical heights of stored numbers, Jacobi's elliptic functions."""

import mpmath as mp
import pytest


def exactly(*numbers):
    return [mp.mpf(float(number)) for number in numbers]


def near(value, rel):
    """Within that of the value, however small."""
    return pytest.approx(value, rel=rel, abs=0)


def roots_of(total, product):
    """Roots of x^2 - total x + product, the larger first."""
    larger = abs(total) / 2 + mp.sqrt(total**2 / 4 - product)
    return [larger, product / larger] if total > 0 else [product / -larger, -larger]


def pendulum(centroid, gyration):
    """The pendulum length of a link, exact."""
    h, k = mp.mpf(centroid), mp.mpf(gyration)
    return h + k**2 / h


def stored_links(chain):
    """(W, a, h, rho^2) of each link, from the numbers that a chain stores (rho^2/a^2 in two words)."""
    size, *columns, _ = chain._compiled.__getstate__()
    full = [column.tolist() if column.ndim else [float(column)] * size for column in columns]
    return [
        (mp.mpf(w), mp.mpf(a), mp.mpf(h), (mp.mpf(high) + mp.mpf(low)) * mp.mpf(a) ** 2)
        for w, a, h, high, low in zip(*full, strict=True)
    ]


def heights_of(links):
    """All conical heights of links (W, a, h, rho^2), descending, in the precision of mpmath.

    See tests/data/make_expected.py: a dense matrix in other coordinates than the program's, the angles of the links.
    """
    below = [mp.mpf(0)]
    for link in links[:-1]:
        below.append(below[-1] + link[0])
    kappa = [w * h + a * s for (w, a, h, _), s in zip(links, below, strict=True)]
    inertia = mp.matrix(len(links))
    for m, (w, a, h, square) in enumerate(links):
        inertia[m, m] = (w * (h**2 + square) + a**2 * below[m]) / kappa[m]
        for j in range(m + 1, len(links)):
            inertia[m, j] = inertia[j, m] = links[j][1] * kappa[m] / mp.sqrt(kappa[m] * kappa[j])
    return sorted(mp.eigsy(inertia, eigvals_only=True), reverse=True)


def jacobi(u, complementary):
    """am, sn, cn, dn, epsilon and their derivatives by descending arithmetic-geometric means."""
    u, kc = mp.mpf(u), mp.mpf(complementary)
    a, b, c = [mp.mpf(1)], kc, [mp.sqrt(1 - kc**2)]
    total = c[0] ** 2 / 2
    while abs(c[-1]) > mp.mpf(10) ** -(mp.mp.dps // 2 + 5):
        a, b, c = [*a, (a[-1] + b) / 2], mp.sqrt(a[-1] * b), [*c, (a[-1] - b) / 2]
        total += mp.mpf(2) ** (len(a) - 2) * c[-1] ** 2
    phi, epsilon = mp.mpf(2) ** (len(a) - 1) * a[-1] * u, (1 - total) * u
    for mean, difference in zip(a[:0:-1], c[:0:-1], strict=True):
        epsilon += difference * mp.sin(phi)
        phi = (phi + mp.asin(difference / mean * mp.sin(phi))) / 2
    s, c_ = mp.sin(phi), mp.cos(phi)
    d = mp.sqrt(c_**2 + (kc * s) ** 2)
    return [(phi, d), (s, c_ * d), (c_, -s * d), (d, -(1 - kc**2) * s * c_), (epsilon, d**2)]


def carried_tangents(length, height, radius):
    """Every root of height tan d = radius + length sin d, as tan d, by bisection between the extremes of
    t (height - length cos d) - radius; and the tangent at which two of them meet."""

    def short(t):
        return height * t - radius - length * t / mp.sqrt(1 + t * t)

    def root(low, high):
        rising = short(high) > short(low)
        for _ in range(330):
            middle = (low + high) / 2
            low, high = (middle, high) if (short(middle) < 0) == rising else (low, middle)
        return low

    far = 2 * (length + radius) / height
    turn = mp.sqrt((length / height) ** (mp.mpf(2) / 3) - 1) if height < length else mp.mpf(0)
    inner = [root(-far, -turn), root(-turn, mp.mpf(0))] if height < length and short(-turn) >= 0 else []
    return [*inner, root(turn, far)], turn
