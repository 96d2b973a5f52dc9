# SPDX-License-Identifier: MPL-2.0
"""Elliptic functions and integrals to 20 digits, for tests/cpp/special: python make_elliptic.py, a minute.

The modulus is given by its complement kappa', a double; kappa^2 = 1 - kappa'^2 takes as many digits as it needs.
elliptic_jacobi.csv: am, sn, cn, dn and int dn^2 at u; elliptic_complete.csv: K, E, D, B and Pi(n);
elliptic_incomplete.csv: F, E, D and Pi(n) up to an amplitude. Jacobi's functions are mpmath's (theta series of the nome); the integrals Carlson's, mpmath's too: another
road than that of the library (theta series of the complementary nome; Bulirsch; Carlson's where mpmath is used for them).
"""
import math
import random
from pathlib import Path

import mpmath as mp

HERE = Path(__file__).parent
COMPLEMENTS = [1.0, 0.999999999, 0.9, 0.75, math.sqrt(0.5), 0.7, 0.5, 0.1, 1e-3, 1e-8, 1e-20, 1e-80, 1e-150]
CHARACTERISTICS = [0.0, 0.3, 0.999, -1e-9, -0.5, -20.0, -1e8, -1e30]


def digits(value):
    return mp.nstr(value, 20, strip_zeros=False, min_fixed=0, max_fixed=0)


def integrals(amplitude, complement, n):
    """F, E, D, Pi of a right angle (amplitude None) or less."""
    k2 = 1 - complement**2
    s, x = (mp.mpf(1), mp.mpf(0)) if amplitude is None else (mp.sin(amplitude), mp.cos(amplitude) ** 2)
    y = x + (complement * s) ** 2
    first = s * mp.elliprf(x, y, 1)
    third = s**3 / 3 * mp.elliprd(x, y, 1)
    pi = first + n / 3 * s**3 * mp.elliprj(x, y, 1, 1 - n * s * s)
    return first, first - k2 * third, third, pi


def main():
    random.seed(1)
    jacobi, complete, incomplete = [["complement,u,am,sn,cn,dn,epsilon"], ["complement,n,K,E,D,B,Pi"],
                                    ["complement,amplitude,n,F,E,D,Pi"]]
    for complement in COMPLEMENTS:
        mp.mp.dps = 60 + int(-2.5 * math.log10(complement))
        c = mp.mpf(complement)
        m = 1 - c * c
        K, E, D, _ = integrals(None, c, mp.mpf(0))
        quarters = [0, 1e-9, 0.01, 0.2, 0.4999, 0.5001, 0.8, 0.99, 1, 1.01, 1.7, 2, 3.3, -0.6, 17.3, 1000.2]
        for share in quarters + [random.uniform(-4, 4) for _ in range(8)]:
            u = float(share * K)
            turns = mp.nint(u / (2 * K))
            within = u - 2 * K * turns
            sn, cn, dn = (mp.ellipfun(f, within, m=m) for f in ("sn", "cn", "dn")) if within else (mp.mpf(0), mp.mpf(1), mp.mpf(1))
            amplitude = mp.atan2(sn, cn)
            epsilon = integrals(amplitude, c, mp.mpf(0))[1] + 2 * E * turns
            sign = (-1) ** int(turns)
            row = [amplitude + turns * mp.pi, sign * sn, sign * cn, dn, epsilon]
            jacobi.append(",".join([repr(complement), repr(u), *map(digits, row)]))
        for n in CHARACTERISTICS:
            pi = integrals(None, c, mp.mpf(n))[3]
            complete.append(",".join([repr(complement), repr(n), *map(digits, (K, E, D, K - D, pi))]))
            for amplitude in [1e-9, 0.01, 0.2, 0.7, 1.2, 1.5, 1.57, math.pi / 2, 1.58, 2.5, 3.1, 3.2, -1.0, -7.0, 20.0]:
                turns = mp.nint(mp.mpf(amplitude) / mp.pi)
                within = integrals(amplitude - turns * mp.pi, c, mp.mpf(n))
                whole = integrals(None, c, mp.mpf(n))
                row = [a + 2 * turns * b for a, b in zip(within, whole)]
                incomplete.append(",".join([repr(complement), repr(amplitude), repr(n), *map(digits, row)]))
    for name, rows in (("jacobi", jacobi), ("complete", complete), ("incomplete", incomplete)):
        (HERE / f"elliptic_{name}.csv").write_text("\n".join(rows) + "\n")


main()
