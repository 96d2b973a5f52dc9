# SPDX-License-Identifier: MPL-2.0
"""Modes of the cord of length 1 held straight, to 25 digits: python make_taut_cord.py > taut_cord.csv

`lower` is the tension at the lower end as the length of cord that weighs as much. Heights are zeros of J0(z0) Y0(zL) -
Y0(z0) J0(zL), counted by changes of sign on a grid in zL - z0 of a twentieth of half a wave; offset and slope are those at
the distance x from the lower end, the largest offset 1; `first` is the lowest vertical point.
"""
import mpmath as mp

mp.mp.dps = 60
LOWER = ["1e-16", "1e-12", "1e-6", "0.001", "0.03", "0.3", "1", "3.7", "20", "150", "1000", "1e6", "1e12"]
MODES = [1, 2, 3, 7, 20]
PLACES = ["0", "1e-6", "0.01", "0.3", "0.77", "1"]

print("lower,mode,height,first,x,offset,slope")
for text in LOWER:
    lower = mp.mpf(float(text))
    r = mp.sqrt(lower / (lower + 1))
    gap = 1 / (lower + 1) / (1 + r)

    def cross(w, gap=gap, r=r):
        z = w / gap
        return mp.besselj(0, r * z) * mp.bessely(0, z) - mp.bessely(0, r * z) * mp.besselj(0, z)

    w, k = mp.mpf(1), 0
    before = cross(w)
    while k < max(MODES):
        step = mp.mpf("0.15")
        value = cross(w + step)
        if mp.sign(value) != mp.sign(before):
            k += 1
            if k in MODES:
                apart = mp.findroot(cross, (w, w + step), solver="anderson", tol=1e-90, verify=False)
                height = 4 * (lower + 1) * gap**2 / apart**2
                z0 = apart / gap * r
                place = lambda x: 2 * mp.sqrt((lower + x) / height)  # noqa: E731
                of = lambda n, z: mp.besselj(0, z0) * mp.bessely(n, z) - mp.bessely(0, z0) * mp.besselj(n, z)  # noqa: E731
                x = mp.mpf("0.001") / k**2
                while of(1, place(x)) < 0:
                    x *= mp.mpf("1.2")
                first = mp.findroot(lambda x: of(1, place(x)), (x / mp.mpf("1.2"), x), solver="anderson", tol=1e-90, verify=False)
                largest = of(0, place(first))
                for at in PLACES:
                    x = mp.mpf(float(at))
                    z = place(x)
                    y, slope = of(0, z) / largest, -of(1, z) * 2 / (z * height) / largest
                    digits = [mp.nstr(number, 25, strip_zeros=False) for number in (height, first, y, slope)]
                    print(f"{text},{k},{digits[0]},{digits[1]},{at},{digits[2]},{digits[3]}", flush=True)
        w, before = w + step, value
