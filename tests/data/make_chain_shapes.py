# SPDX-License-Identifier: MPL-2.0
"""Offsets and slopes of chains of length 1 with a tip mass or of varying density, 1 at the free end, to 20 digits, for
tests/cpp/special: python make_chain_shapes.py > chain_shapes.csv

Heights and zeros are those of tip_mass.csv and bessel_zeros_real.csv.
"""
import csv
import pathlib

import mpmath as mp

mp.mp.dps = 60
HERE = pathlib.Path(__file__).parent
PLACES = ["0", "1e-9", "0.001", "0.1", "0.5", "0.97", "1"]


def rows(name, parameters, modes):
    with open(HERE / name, newline="") as file:
        for first, mode, value in list(csv.reader(file))[1:]:
            if first in parameters and int(mode) in modes:
                yield first, mode, mp.mpf(value)


def with_tip(tip, height, x):
    a, z = 2 * mp.sqrt(tip / height), 2 * mp.sqrt((tip + x) / height)
    scale = mp.pi * a**2 / 4
    p, q = -scale * mp.bessely(2, a), scale * mp.besselj(2, a)
    slope = -2 / (height * z) * (p * mp.besselj(1, z) + q * mp.bessely(1, z))
    return p * mp.besselj(0, z) + q * mp.bessely(0, z), slope


def tapered(p, zero, x):
    height = 4 * (p + 1) / zero**2
    z = zero * mp.sqrt(x)
    return mp.hyp0f1(p + 1, -z**2 / 4), -mp.hyp0f1(p + 2, -z**2 / 4) / height


print("chain,parameter,mode,x,offset,slope")
for chain, function, found in (
    ("tip", with_tip, rows("tip_mass.csv", ("1e-12", "0.001", "0.3", "1", "20", "150", "1e6"), (1, 2, 9, 1000))),
    ("tapered", tapered, rows("bessel_zeros_real.csv", ("-0.99", "-0.5", "0.125", "3.5", "20.25", "100"),
                              (1, 4, 40, 1000))),
):
    for parameter, mode, value in found:
        for x in PLACES:
            offset, slope = function(mp.mpf(float(parameter)), value, mp.mpf(float(x)))
            print(",".join([chain, parameter, mode, x, mp.nstr(offset, 20), mp.nstr(slope, 20)]), flush=True)
