# SPDX-License-Identifier: MPL-2.0
"""Zeros of J0 and J1 to 25 digits, for tests/cpp/special: python make_bessel_zeros.py > bessel_zeros.csv"""
import mpmath as mp

mp.mp.dps = 40
orders = [*range(1, 61), 75, 100, 200, 500, 1000, 3000, 10**4, 10**5, 999_999, 10**6]
print("order,k,zero")
for order in (0, 1):
    for k in orders:
        # Newton from the asymptotic place; mpmath's own search is slow for large k
        zero = mp.besseljzero(order, k) if k <= 60 else mp.findroot(
            lambda z: mp.besselj(order, z), (k + mp.mpf(order) / 2 - mp.mpf(1) / 4) * mp.pi)
        print(f"{order},{k},{mp.nstr(zero, 25, strip_zeros=False)}")
