# SPDX-License-Identifier: MPL-2.0
"""Conical heights of the chain of length 1 with a tip mass, to 25 digits: python make_tip_mass.py > tip_mass.csv

Zeros of Y2(z0) J0(zL) - J2(z0) Y0(zL). Small numbers: all of them, counted by changes of sign on a grid in zL - z0 of a
twentieth of half a wave. Large numbers: from the string with the first corrections, which are small there.
"""
import mpmath as mp

mp.mp.dps = 34
TIPS = ["1e-12", "1e-6", "0.001", "0.03", "0.3", "1", "3.7", "20", "150", "1000", "1e6", "1e12"]
FEW = [1, 2, 3, 5, 9, 14, 30]
FAR = [1000, 10**6]

print("tip,mode,height")
for text in TIPS:
    tip = mp.mpf(float(text))
    r = mp.sqrt(tip / (tip + 1))
    gap = 1 / (tip + 1) / (1 + r)

    def cross(w):
        mp.mp.dps = 64  # for heavy tips the products agree in half their digits
        z = w / gap
        value = mp.bessely(2, r * z) * mp.besselj(0, z) - mp.besselj(2, r * z) * mp.bessely(0, z)
        mp.mp.dps = 34
        return value

    def height(w):
        return 4 * (tip + 1) * gap**2 / w**2

    found = {}
    start = mp.sqrt(2 * gap) / 3
    w, before, k = start, cross(start), 0
    while len(found) < len(FEW):
        step = w * mp.mpf("0.02") if k == 0 else mp.mpf("0.15")
        step = min(step, mp.mpf("0.15"))
        value = cross(w + step)
        if mp.sign(value) != mp.sign(before):
            k += 1
            if k in FEW:
                found[k] = mp.findroot(cross, (w, w + step), solver="anderson", tol=1e-60, verify=False)
                assert w <= found[k] <= w + step
        w, before = w + step, value
    for k in FAR:
        guess = (k - 1) * mp.pi
        for _ in range(80):
            z = guess / gap
            z0 = r * z
            phase2 = mp.atan2(mp.bessely(2, z0), mp.besselj(2, z0)) if z0 < 30 else None
            if phase2 is not None:  # the branch of theta_2 by its asymptote
                near = z0 - 5 * mp.pi / 4 + mp.mpf(15) / (8 * z0) if z0 > 3 else -mp.pi / 2
                phase2 += 2 * mp.pi * mp.nint((near - phase2) / (2 * mp.pi))
                guess = gap * (phase2 + k * mp.pi + mp.pi / 4 + 1 / (8 * z))
            else:
                guess = (k - 1) * mp.pi + 1 / (8 * z) + mp.mpf(15) / (8 * z0)
        root = mp.findroot(cross, guess, tol=1e-60, verify=False)
        assert abs(root - guess) < 1e-3, (text, k, root, guess)
        found[k] = root
    for k in FEW + FAR:
        print(f"{text},{k},{mp.nstr(height(found[k]), 25, strip_zeros=False)}", flush=True)
