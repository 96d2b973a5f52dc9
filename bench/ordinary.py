# SPDX-License-Identifier: MPL-2.0
"""The ordinary call from Python against what NumPy and SciPy offer: chain or matrices built, heights and shapes.

A part of bench/run. All take turns in every round, on chains that are new in every round; times
are medians of the CPU time of one thread; the ratio is that of the fastest peer over revchain. Errors are of heights,
relative, the worst of the first round (of 50 modes, where there are more than 100), against double-double (of rigs:
against revchain). A call that takes less time than its results take to be written (0.2 ns a number) is reported as
BROKEN.
"""

# ruff: noqa: E402
import os

for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ[name] = "1"  # before numpy is loaded: threads that wait for work would be counted with what comes next

import argparse
import csv
import statistics
import sys
import time

import numpy as np
from scipy import linalg

import revchain as rc

GRAVITY = 9.80665
SIZES = (2, 8, 20, 100, 300, 1000, 3000)


class Links:
    """The arrays that a user has: weights, lengths, and for bodies centroids and radii of gyration."""

    def __init__(self, rng, kind, n):
        self.weight, self.length = rng.uniform(0.5, 2.0, n), rng.uniform(0.5, 2.0, n)
        self.more = {}
        if kind == "rods":
            self.more = {"centroid": self.length / 2, "radius_of_gyration": self.length / np.sqrt(12)}
        if kind == "bodies":
            p = rng.uniform(0.2, 0.8, n)
            radius = self.length * np.sqrt(p * (1 - p)) * rng.uniform(0.3, 0.95, n)
            self.more = {"centroid": p * self.length, "radius_of_gyration": radius}
        self.stiffness = rng.uniform(5.0, 50.0) * self.weight.sum() / self.length.sum()
        self.momentum = rng.uniform(0.1, 1.0, n) * self.weight * self.length**1.5 / np.sqrt(GRAVITY)

    def chain(self):
        return rc.Chain(weight=self.weight, length=self.length, **self.more)

    def pencil(self, held=True):
        """K and M as diagonal and what is beside it; with the support's pin unless it is held."""
        w, a = self.weight, self.length
        h, rho = self.more.get("centroid", a), self.more.get("radius_of_gyration", 0.0)
        p, r = h / a, (rho / a) ** 2
        hung = np.cumsum(w)
        k = (w * p + hung - w) / a
        lower, upper, cross = w * (p**2 + r), w * ((1 - p) ** 2 + r), w * (p * (1 - p) - r)
        n = len(w)
        K, M = np.zeros(n + 1), np.zeros(n + 1)
        K[:-1] += k
        K[1:] += k
        M[:-1] += lower
        M[1:] += upper
        return (K[:n], -k[:-1], M[:n], cross[:-1]) if held else (K, -k, M, cross)


def dense(diagonal, off):
    n = len(diagonal)
    full = np.zeros((n, n))
    full.flat[:: n + 1] = diagonal
    full.flat[1 :: n + 1] = full.flat[n :: n + 1] = off
    return full


# ---- revchain: heights, shapes


def ours(count, shapes=True, **options):
    def modes(links):
        found = rc.modes(links.chain(), count, **options)
        return (found.conical_height, found.shape) if shapes else (found.conical_height, None)

    return modes


def our_rig(links):
    found = rc.modes(rc.Rig(links.chain(), support=rc.Support(stiffness=links.stiffness)), "all")
    return found.conical_height, found.shape


def our_wheels(links):
    found = rc.modes(rc.Rig(links.chain(), flywheels=rc.Flywheel(momentum=links.momentum)), "all")
    return np.sort(found.conical_height)[::-1], found.shape


# ---- peers: the leanest programs that we could write, without checks and with one triangle of each matrix


def pencil_matrices(links, held=True):
    """K and M assembled; the lower triangle is enough for eigh."""
    K, off, M, cross = links.pencil(held)
    return lower_triangle(K, off), lower_triangle(M, cross)


def lower_triangle(diagonal, below):
    n = len(diagonal)
    full = np.zeros((n, n))
    flat = full.reshape(-1)
    flat[:: n + 1] = diagonal
    flat[n :: n + 1] = below
    return full


def numpy_eigh(links):
    """Point masses: M^-1/2 K M^-1/2, whose vectors are divided by the root of the mass."""
    k, scale = links.weight.cumsum() / links.length, links.weight**-0.5
    diagonal = k.copy()
    diagonal[1:] += k[:-1]
    values, vectors = np.linalg.eigh(lower_triangle(diagonal * scale * scale, -k[:-1] * scale[:-1] * scale[1:]))
    return 1 / values, vectors.T * scale


def by_inclination(weight, length, more):
    """Heights as eigenvalues: with the inclinations as unknowns K is diagonal and M needs an outer product.

    Slowest first they come last; the matrix is scaled by the roots of K.
    """
    h = more.get("centroid", length)
    below = weight.cumsum() - weight
    kappa = weight * h + length * below
    root = np.sqrt(kappa)
    full = np.outer(length / root, root)  # of link j and a link i below it: a_j kappa_i / (root_i root_j)
    inertia = weight * (h * h + more.get("radius_of_gyration", 0.0) ** 2) + length * length * below
    full.reshape(-1)[:: len(weight) + 1] = inertia / kappa
    return full, root


def offsets_of(vectors, root, length):
    """Offsets of the pins, a row for each mode: sums of length times inclination from the support down."""
    turned = vectors.T * (length / root)
    return np.cumsum(turned[:, ::-1], axis=1)[:, ::-1]


def numpy_inclinations(links):
    full, root = by_inclination(links.weight, links.length, links.more)
    values, vectors = np.linalg.eigh(full)
    return values[::-1], offsets_of(vectors, root, links.length)[::-1]


def numpy_eigvalsh(links):
    return np.linalg.eigvalsh(by_inclination(links.weight, links.length, links.more)[0])[::-1], None


def tridiagonal(links, count=None, vectors=True):
    k, scale = links.weight.cumsum() / links.length, links.weight**-0.5
    diagonal = k.copy()
    diagonal[1:] += k[:-1]
    chosen = {} if count is None else {"select": "i", "select_range": (0, count - 1)}
    pair = diagonal * scale * scale, -k[:-1] * scale[:-1] * scale[1:]
    if not vectors:
        return 1 / linalg.eigvalsh_tridiagonal(*pair, check_finite=False, **chosen), None
    values, found = linalg.eigh_tridiagonal(*pair, check_finite=False, **chosen)
    return 1 / values, found.T * scale


LEAN = {"check_finite": False, "overwrite_a": True, "overwrite_b": True}


def generalised(links, count=None, vectors=True):
    K, M = pencil_matrices(links)
    chosen = {} if count is None else {"subset_by_index": (0, count - 1)}
    found = linalg.eigh(K, M, eigvals_only=not vectors, **LEAN, **chosen)
    return (1 / found[0], found[1].T) if vectors else (1 / found, None)


def inverted(links):
    """M first, which is what has to be definite for SciPy: K is as well, and the heights are the eigenvalues."""
    K, M = pencil_matrices(links)
    values, vectors = linalg.eigh(M, K, **LEAN)
    return values[::-1], vectors.T[::-1]


def on_spring(links):
    K, M = pencil_matrices(links, held=False)
    K[-1, -1] += links.stiffness
    values, vectors = linalg.eigh(M, K, **LEAN)
    values = values[::-1]
    return values[values > 1e-14 * values[0]], vectors.T[::-1]


def spring_as_link(links):
    """The spring as one more massless thread: its length is the weight over the stiffness."""
    weight = np.append(links.weight, 0.0)
    length = np.append(links.length, links.weight.sum() / links.stiffness)
    full, root = by_inclination(weight, length, {})
    values, vectors = np.linalg.eigh(full)
    values = values[::-1]
    return values[values > 1e-14 * values[0]], offsets_of(vectors, root, length)[::-1]


def wheels_by_inclination(links):
    """n^2 M/g - n G - K with K diagonal: a definite pencil of twice the size, and one eigh of it."""
    full, root = by_inclination(links.weight, links.length, links.more)
    n = len(root)
    both, mass = np.zeros((2 * n, 2 * n)), np.zeros((2 * n, 2 * n))
    flat = both.reshape(-1)
    flat[: 2 * n * n : 2 * n + 1] = links.momentum / (root * root)
    flat[2 * n * n :: 2 * n + 1] = 1.0
    mass[:n, :n] = full / GRAVITY
    mass.reshape(-1)[2 * n * n + n :: 2 * n + 1] = 1.0
    values, vectors = linalg.eigh(both, mass, **LEAN)
    return np.sort(GRAVITY / (values * values))[::-1], offsets_of(vectors[:n], root, links.length)


JOBS = {
    "plummets, all modes with shapes": ("plummets", ours("all"), {
        "numpy eigh": numpy_eigh, "numpy eigh, inclinations": numpy_inclinations,
        "scipy eigh_tridiagonal": tridiagonal}),
    "rods, all modes with shapes": ("rods", ours("all"), {
        "numpy eigh, inclinations": numpy_inclinations, "scipy eigh(K, M)": generalised, "scipy eigh(M, K)": inverted}),
    "random bodies, all modes with shapes": ("bodies", ours("all"), {
        "numpy eigh, inclinations": numpy_inclinations, "scipy eigh(K, M)": generalised, "scipy eigh(M, K)": inverted}),
    "plummets, heights alone": ("plummets", ours("all", shapes=False), {
        "numpy eigvalsh": numpy_eigvalsh, "scipy eigvalsh_tridiagonal": lambda links: tridiagonal(links, vectors=False),
        "scipy eigh(K, M)": lambda links: generalised(links, vectors=False)}),
    "plummets, three slowest with shapes": ("plummets", lambda links: ours(min(3, len(links.weight)))(links), {
        "numpy eigh": numpy_eigh, "scipy eigh(K, M)": lambda links: generalised(links, min(3, len(links.weight))),
        "scipy eigh_tridiagonal": lambda links: tridiagonal(links, min(3, len(links.weight)))}),
    "rigs with springs": ("plummets", our_rig, {
        "scipy eigh(M, K)": on_spring, "numpy eigh, inclinations": spring_as_link}),
    "rigs with flywheels": ("plummets", our_wheels, {
        "scipy eigh, inclinations": wheels_by_inclination}),
}
LARGEST = {  # where the peer takes minutes
    "plummets, three slowest with shapes": 1000, "rigs with springs": 300, "rigs with flywheels": 300}
MILLION = {
    "ten slowest of a million, heights alone": ("plummets", ours(10, shapes=False), {
        "scipy eigvalsh_tridiagonal": lambda links: tridiagonal(links, 10, vectors=False)}),
    "ten slowest of a million, with shapes": ("plummets", ours(10), {
        "scipy eigh_tridiagonal": lambda links: tridiagonal(links, 10)}),
}


def truth(job, links, count):
    """Numbers of modes, from 0, and their heights to more than double: all, or 50 of many.

    For rigs they are revchain's own heights, which have proved bounds of 2 ulp.
    """
    if job == "rigs with springs":
        return np.arange(count), our_rig(links)[0]
    if job == "rigs with flywheels":
        return np.arange(count), our_wheels(links)[0]
    if count <= 100:
        found = rc.modes(links.chain(), count, precision="double-double")
        return np.arange(count), found.conical_height.astype(np.longdouble) + found.conical_height_low
    chosen = np.unique(np.linspace(0, count - 1, 50).astype(int))
    each = [rc.modes(links.chain(), 1, first=j + 1, precision="double-double") for j in chosen.tolist()]
    return chosen, np.array([np.longdouble(m.conical_height[0]) + m.conical_height_low[0] for m in each])


def error(found, exact):
    modes, heights = exact
    there = modes < len(found)
    return float(np.abs(np.asarray(found[modes[there]], np.longdouble) / heights[there] - 1).max())


def measure(job, kind, method, peers, n, budget, rounds, seed=1):
    """A row: the CPU time of one call of each, the errors, the ratio."""
    calls = {"revchain": method, **peers}
    times, repeat, errors, written = {}, {}, {}, {}
    for number in range(rounds):
        rng = np.random.default_rng([seed, n, number])
        links = Links(rng, kind, n)
        if number == 0 and n <= 1000:
            exact = truth(job, links, len(method(links)[0]))
        for name in rng.permutation(list(calls)):
            call = calls[name]
            if sum(times.get(name, ())) * repeat.get(name, 1) > budget:
                continue
            try:
                if number == 0:
                    start = time.process_time()
                    heights, shapes = call(links)
                    once = time.process_time() - start
                    repeat[name] = max(1, int(0.004 / max(once, 1e-6)))
                    own = job.startswith("rigs") and name == "revchain"  # what the others are compared with
                    errors[name] = np.nan if own or n > 1000 else error(heights, exact)
                    written[name] = heights.size, 0 if shapes is None else shapes.size
                start = time.process_time()
                for _ in range(repeat[name]):
                    call(links)
                times.setdefault(name, []).append((time.process_time() - start) / repeat[name])
            except (ValueError, MemoryError, linalg.LinAlgError) as why:
                errors[name] = str(why).splitlines()[0]
    row = {"job": job, "N": n}
    medians = {name: statistics.median(values) for name, values in times.items()}
    for name, seconds in medians.items():
        if seconds < 0.2e-9 * sum(written[name]):
            row["status"] = f"BROKEN: {name} is faster than its results can be written"
    best = min((name for name in medians if name != "revchain"), key=medians.get, default=None)
    row |= {"revchain_us": 1e6 * medians["revchain"], "error": errors["revchain"]}
    if best:
        row |= {"peer": best, "peer_us": 1e6 * medians[best], "peer_error": errors[best]}
        row["ratio"] = medians[best] / medians["revchain"]
    return row | {"status": row.get("status", "ok")}


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="sizes up to 100, few rounds")
    parser.add_argument("--sizes", type=int, nargs="+", default=None)
    parser.add_argument("--jobs", nargs="+", default=None, metavar="TEXT", help="those whose names contain one of these")
    parser.add_argument("--csv", default=None, metavar="FILE")
    given = parser.parse_args()
    sizes = given.sizes or [n for n in SIZES if not given.quick or n <= 100]
    rounds, budget = (5, 0.3) if given.quick else (15, 2.5)
    listed = JOBS if given.quick or given.sizes else JOBS | MILLION
    rows = []
    measure("plummets, all modes with shapes", *JOBS["plummets, all modes with shapes"], 20, 0.3, 20)  # wakes the processor
    print(f"{'job':40} {'N':>8} {'revchain':>11} {'best peer':>11} {'ratio':>7} {'error':>8} {'its error':>9}  peer")
    for job, (kind, method, peers) in listed.items():
        if given.jobs is not None and not any(text in job for text in given.jobs):
            continue
        for n in [10**6] if job in MILLION else sizes:
            if n > LARGEST.get(job, n):
                continue
            row = measure(job, kind, method, peers, n, budget, 5 if job in MILLION else rounds)
            rows.append(row)
            print(f"{job:40} {n:8,} {row['revchain_us']:8.1f} us {row.get('peer_us', np.nan):8.1f} us "
                  f"{row.get('ratio', np.nan):7.2f} {row['error']:8.1e} {row.get('peer_error', np.nan):9.1e}  "
                  f"{row.get('peer', '')}{'' if row['status'] == 'ok' else '  ' + row['status']}", flush=True)
    if given.csv:
        with open(given.csv, "w", newline="", encoding="utf-8") as file:
            table = csv.DictWriter(file, list(dict.fromkeys(name for row in rows for name in row)), lineterminator="\n")
            table.writeheader()
            rounded = ({name: f"{x:.4g}" if isinstance(x, float) else x for name, x in row.items()} for row in rows)
            table.writerows(rounded)
    sys.exit(any(row["status"] != "ok" for row in rows))


if __name__ == "__main__":
    main()
