#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""All shapes of a chain without links at length / conical height 500: compiled methods and SciPy's, taking turns.

    bench/continuous_peers.py PROGRAM [--rounds 5] [--csv FILE]

PROGRAM is the built bench/continuous.cpp. Medians over rounds of CPU time; what is found is compared with
tests/data/continuous_shapes.csv: a shape is right with its number of half waves and inclinations within 1e-6, wrong where a
method returned something else, missing otherwise. SciPy's, in the arc length:

- solve_ivp: DOP853, rtol = atol = 1e-13; 400 offsets of the free end tried at 1e-7, then brentq on the support's offset.
- solve_bvp: tol 1e-8, 500 nodes to begin with and at most 100000; begins with the mode of small amplitude, as large as its
  tip would be on a hyperbola between the quadratic and the stretched chain; success as it reports it.
"""

import argparse
import csv
import io
import math
import statistics
import subprocess
import time
from pathlib import Path

import numpy as np
from scipy.integrate import solve_bvp, solve_ivp
from scipy.optimize import brentq
from scipy.special import j0, j1, jn_zeros

ROOT = Path(__file__).resolve().parents[1]
LENGTH, EXPECTED, START = 500.0, 14, 1e-8


def truth():
    table = {}
    with open(ROOT / "tests/data/continuous_shapes.csv", encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if (row["density"], row["length"], row["tip_weight"]) == ("uniform", "500", "0"):
                place = [float(row[name]) for name in ("arc_length", "offset", "inclination")]
                table.setdefault(int(row["half_waves"]), []).append(place)
    return {waves: np.array(places) for waves, places in table.items()}


def derivative(s, x):
    return np.array([-x[1], x[0] / np.sqrt(x[0] ** 2 + s**2)])


def follow(tip, tolerance, **options):
    slope = -tip / math.sqrt(1 + tip * tip)
    start = [-START * (tip + 0.5 * slope * START), tip + slope * START]
    return solve_ivp(derivative, (START, LENGTH), start, method="DOP853", rtol=tolerance, atol=tolerance, **options)


def by_shooting(exact):
    tips = LENGTH * (np.arange(1, 401) / 400) ** 3
    ends = [follow(tip, 1e-7).y[1, -1] for tip in tips]
    found = []
    for low, high, left, right in zip(tips[:-1], tips[1:], ends[:-1], ends[1:], strict=True):
        if left * right < 0:
            tip = brentq(lambda x: follow(x, 1e-13).y[1, -1], low, high, xtol=1e-13, rtol=1e-14)
            path = follow(tip, 1e-13, dense_output=True)
            found.append(path.sol)
    return [described(curve, np.linspace(START, LENGTH * (1 - 1e-9), 20001), exact) for curve in found]


def by_collocation(exact):
    found = []
    for waves in range(1, EXPECTED + 1):
        zero = jn_zeros(0, waves)[-1]
        rest = zero**2 / 4
        c = 0.502 * waves - 0.15
        b, rise = c / (2 * waves - 1), LENGTH - rest
        tip = (0.5 * b * rise + math.sqrt((0.5 * b * rise) ** 2 + c * rise)) / c
        s = np.linspace(1e-6, LENGTH, 500)
        z = zero * np.sqrt(s / LENGTH)
        guess = np.array([-tip * 2 * s * j1(z) / z, tip * j0(z)])
        # the free end: u = -s y there; a shape with this tip, or any other on the branch, is free to come
        got = solve_bvp(derivative, lambda a, b: np.array([a[0] + 1e-6 * a[1], b[1]]), s, guess, tol=1e-8, max_nodes=100_000)
        if got.success:
            found.append(described(got.sol, s, exact, waves))
    return found


def described(curve, grid, exact, meant=None):
    """(half waves, whether right, errors): of a curve that a method offers, as that with `meant` half waves if it says so."""
    offset = curve(grid)[1]
    waves = int(np.sum(offset[:-2] * offset[1:-1] < 0)) + 1
    if waves not in exact or np.abs(offset).max() < 1e-6 or (meant is not None and meant != waves):
        return waves, False, 0.0, 0.0
    arc, true_offset, inclination = exact[waves].T
    at = np.maximum(arc, grid[0])
    pull, y = curve(at)
    y, pull = np.sign(y[0]) * y, np.sign(y[0]) * pull
    turned = np.abs(-np.arctan2(pull, at) - inclination).max()
    return waves, bool(turned <= 1e-6), turned, np.abs(y - true_offset).max() / LENGTH


def row_of(method, exact):
    before = time.process_time()
    found = method(exact)
    milliseconds = 1e3 * (time.process_time() - before)
    right = {waves: (turned, moved) for waves, good, turned, moved in found if good}
    wrong = len(found) - len(right)
    worst = [max((x[i] for x in right.values()), default=0.0) for i in (0, 1)]
    return [milliseconds, len(right), wrong, EXPECTED - len(right), *worst]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--csv", metavar="FILE")
    options = parser.parse_args()
    exact = truth()
    rows = {}
    for _ in range(options.rounds):
        text = subprocess.run([options.program], check=True, capture_output=True, text=True).stdout
        for row in csv.reader(io.StringIO(text)):
            if row[0] == "method":
                continue
            if len(row) < 7:
                print(*row)  # a peer that is not installed
                continue
            rows.setdefault(row[0], []).append([float(x) for x in row[1:]])
        rows.setdefault("SciPy solve_ivp + brentq", []).append(row_of(by_shooting, exact))
        rows.setdefault("SciPy solve_bvp", []).append(row_of(by_collocation, exact))
    lines = [["method", "milliseconds", "ratio", "right", "wrong", "missing", "inclination_error", "offset_error"]]
    ours = statistics.median(row[0] for row in rows["revchain"])
    for name, found in rows.items():
        middle = statistics.median(row[0] for row in found)
        worst = [max(row[i] for row in found) for i in range(1, 6)]
        worst[0] = min(row[1] for row in found)
        counts = [str(int(x)) for x in worst[:3]]
        lines.append([name, f"{middle:.4g}", f"{middle / ours:.3g}", *counts, f"{worst[3]:.2g}", f"{worst[4]:.2g}"])
    if options.csv:
        with open(options.csv, "w", encoding="utf-8", newline="") as file:
            csv.writer(file, lineterminator="\n").writerows(lines)
    widths = [max(len(line[i]) for line in lines) for i in range(len(lines[0]))]
    for line in lines:
        print("  ".join(text.ljust(width) for text, width in zip(line, widths, strict=True)))


if __name__ == "__main__":
    main()
