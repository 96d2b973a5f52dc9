# SPDX-License-Identifier: MPL-2.0
"""Zeros of J of real order to 25 digits, for tests/cpp/special.

python make_bessel_zeros_real.py > bessel_zeros_real.csv

Small numbers are counted as J changes sign on a grid; great ones are those of the phase of J + iY, (k - 1/2) pi.
"""
import mpmath as mp

mp.mp.dps = 30
ORDERS = ["-0.99", "-0.9", "-0.75", "-0.5", "-0.25", "-0.01", "0.125", "0.5", "1.75", "3.5", "4", "7.3", "12", "20.25",
          "33.3", "50", "77.7", "100"]
FEW = [1, 2, 3, 4, 6, 9, 10, 11, 14, 20, 40]
FAR = [100, 225, 300, 1000, 10**5, 10**6]


def polished(order, guess):
    zero = mp.findroot(lambda z: mp.besselj(order, z), guess)
    assert abs(zero - guess) < 0.4, (order, guess, zero)
    return zero


def by_counting(order, numbers):
    """As J changes its sign on a grid of 1/4, finer than the zeros' distances, which are above 2.9."""
    found, z, before = {}, mp.mpf("0.01"), mp.mpf(1)
    if order > 1:
        z = order  # no zero is below
    k = 0
    while len(found) < len(numbers):
        z += mp.mpf("0.25")
        value = mp.besselj(order, z)
        if mp.sign(value) != mp.sign(before):
            k += 1
            if k in numbers:
                found[k] = mp.findroot(lambda t: mp.besselj(order, t), (z - mp.mpf("0.25"), z), solver="anderson")
                assert z - 0.25 <= found[k] <= z
        before = value
    return found


def far(order, k):
    """From the leading terms of the phase."""
    b = (k + order / 2 - mp.mpf(1) / 4) * mp.pi
    mu = 4 * order**2
    guess = b
    for _ in range(30):  # the phase, DLMF 10.18.18
        guess = b - (mu - 1) / (8 * guess) - (mu - 1) * (mu - 25) / (384 * guess**3) - (mu - 1) * (
            mu**2 - 114 * mu + 1073) / (5 * (4 * guess) ** 5)
    return polished(order, guess)


print("order,k,zero")
for text in ORDERS:
    order = mp.mpf(float(text))  # what the double is
    zeros = by_counting(order, FEW)
    zeros.update((k, far(order, k)) for k in FAR)
    for k in FEW + FAR:
        print(f"{text},{k},{mp.nstr(zeros[k], 25, strip_zeros=False)}")
