# SPDX-License-Identifier: GPL-3.0-or-later
"""Conical heights of three chains to 45 digits, for scalars wider than double: writes heights.csv beside itself.

    python tests/data/make_heights.py

Needs mpmath alone. The numbers of the links are exact in every scalar. The heights are the eigenvalues of the dense
inertia matrix in the ANGLES of the links (the programs use the offsets of the pins), 70 digits in the work.
tests/cpp/linear/scalars.cpp builds the same chains.
"""

from pathlib import Path

import mpmath as mp
from make_expected import heights_by_angles
from mpmath import mpf

mp.mp.dps = 70


def link(weight, length, centroid, radius):
    return mpf(weight), mpf(length), mpf(centroid), mpf(radius) ** 2


CHAINS = {
    "bodies": [link(1 + m % 7, 0.5 * (1 + m % 3), 0.25 * (1 + m % 2), 0.125 * (m % 4)) for m in range(40)],
    "upward": [link(4**m, 1, 1, 0) for m in range(20)],
    "heavy tip": [link(4 ** (19 - m), 1, 0.5, 0.25) for m in range(20)],
}

lines = ["chain,mode,height"]
for name, links in CHAINS.items():
    for mode, height in enumerate(heights_by_angles(links), start=1):
        lines.append(f"{name},{mode},{mp.nstr(height, 45, min_fixed=0, max_fixed=0)}")
Path(__file__).with_name("heights.csv").write_text("\n".join(lines) + "\n")
