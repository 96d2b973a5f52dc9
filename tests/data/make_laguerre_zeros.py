# SPDX-License-Identifier: MPL-2.0
"""Zeros of Laguerre polynomials to 25 digits, for tests/cpp/limits: python make_laguerre_zeros.py > laguerre_zeros.csv

x_k of L_N is length / (conical height k) of N equal plummets on threads of that length.
"""
import mpmath as mp

mp.mp.dps = 80  # the coefficients of L_60 cancel by 25 digits; what is left is ample

SIZES = [*range(1, 13), 16, 20, 25, 30, 40, 50, 60]


def zeros(size):
    """Sturm's way: the zeros of L_n separate those of L_{n+1}, so bisection and Newton cannot miss one."""
    found = []
    for n in range(1, size + 1):
        ends = [mp.mpf(0), *found, mp.mpf(4 * n + 2)]  # all zeros of L_n lie below 4 n + 2
        found = [root(n, low, high) for low, high in zip(ends, ends[1:])]
    return found


def laguerre(n, x):
    """L_n(x) and its derivative."""
    before, value = mp.mpf(0), mp.mpf(1)
    for k in range(n):
        before, value = value, ((2 * k + 1 - x) * value - k * before) / (k + 1)
    return value, n * (value - before) / x


def root(n, low, high):
    sign = 1 if low == 0 else mp.sign(laguerre(n, low)[0])
    for _ in range(12):
        middle = (low + high) / 2
        low, high = (middle, high) if mp.sign(laguerre(n, middle)[0]) == sign else (low, middle)
    x = (low + high) / 2
    for _ in range(60):
        value, slope = laguerre(n, x)
        step = value / slope
        x -= step
        if abs(step) < mp.mpf(10) ** -60 * x:
            break
    else:
        raise ArithmeticError(f"L_{n} near {x}: no convergence")
    assert low < x < high
    return x


print("size,k,zero")
for size in SIZES:
    for k, zero in enumerate(zeros(size), 1):
        print(f"{size},{k},{mp.nstr(zero, 25, strip_zeros=False)}")
