# SPDX-License-Identifier: MPL-2.0
"""The peers that Python offers, by the same questions and answers as bench/worker.cpp (its heading lists them)."""

import json
import math
import sys
import time

import numpy as np
from scipy import linalg, sparse
from scipy.sparse import linalg as sparse_linalg

try:
    import revchain
except ImportError:
    revchain = None


def stiffness(weight, rods):
    """Of every link of length 1; the weights hung below are summed with twice the digits, or nearly."""
    total = np.cumsum(weight, dtype=np.longdouble)
    return np.asarray(total - weight / 2 if rods else total, dtype=float)


def pencil(weight, rods):
    """K and M assembled: diagonal, off-diagonal."""
    k = stiffness(weight, rods)
    diagonal = k.copy()
    diagonal[1:] += k[:-1]
    if not rods:
        return (diagonal, -k[:-1]), (weight, np.zeros(len(k) - 1))
    mass = weight / 3
    mass[1:] += weight[:-1] / 3
    return (diagonal, -k[:-1]), (mass, weight[:-1] / 6)


def standard_form(weight):
    """Plummets: M^-1/2 K M^-1/2."""
    (diagonal, off), _ = pencil(weight, rods=False)
    return diagonal / weight, off / np.sqrt(weight[:-1] * weight[1:])


def csc(tridiagonal):
    diagonal, off = tridiagonal
    return sparse.diags_array((off, diagonal, off), offsets=(-1, 0, 1)).tocsc()


def heights_of(mu, count):
    return 1 / np.sort(mu)[:count]


def eigh_tridiagonal(weight, rods, count):
    return heights_of(linalg.eigh_tridiagonal(*standard_form(weight), eigvals_only=True, select="i",
                                              select_range=(0, count - 1)), count)


def eigsh(weight, rods, count):
    """As the manual has it: shift-invert about 0, with SuperLU."""
    if rods:
        K, M = (csc(part) for part in pencil(weight, rods))
        return heights_of(sparse_linalg.eigsh(K, count, M, sigma=0, return_eigenvectors=False), count)
    return heights_of(sparse_linalg.eigsh(csc(standard_form(weight)), count, sigma=0, return_eigenvectors=False), count)


def eigsh_factored(weight, rods, count):
    """The inverse of K from its elements, two cumulative sums and a division: nothing is assembled but M."""
    flexibility = 1 / stiffness(weight, rods)

    def solve(force):
        return np.cumsum((np.cumsum(force) * flexibility)[::-1])[::-1]

    n = len(weight)
    start = np.ones(n)  # ARPACK's own is random
    if rods:
        K, M = (csc(part) for part in pencil(weight, rods))
        inverse = sparse_linalg.LinearOperator((n, n), matvec=solve, dtype=float)
        return heights_of(sparse_linalg.eigsh(K, count, M, sigma=0, OPinv=inverse, v0=start,
                                              return_eigenvectors=False), count)
    root = np.sqrt(weight)
    inverse = sparse_linalg.LinearOperator((n, n), matvec=lambda x: root * solve(root * x), dtype=float)
    return np.sort(sparse_linalg.eigsh(inverse, count, v0=start, return_eigenvectors=False))[::-1]


def revchain_modes(weight, rods, count):
    centroid, pendulum = (0.5, 2 / 3) if rods else (1.0, 1.0)
    chain = revchain.Chain(weight=weight, length=1.0, centroid=centroid, pendulum_length=pendulum)
    return revchain.modes(chain, count=count).conical_height


# name: (function, family, kinds, largest N, which: see method.hpp)
METHODS = {
    "scipy eigh_tridiagonal": (eigh_tridiagonal, "scipy", "ACDE", 1_000_000, "any"),
    "scipy eigsh": (eigsh, "scipy", "ABCDER", 1_000_000, "few"),
    "scipy eigsh, factored inverse": (eigsh_factored, "scipy", "ABCDER", 1_000_000, "few"),
}
MISSING = []
if revchain is None:
    MISSING.append(("revchain.modes from Python", "the package is not installed in this Python"))
else:
    METHODS["modes, from Python"] = (revchain_modes, "revchain", "ACDE", 10_000_000, "any")


def listing():
    methods = [{"name": name, "family": family, "kinds": kinds, "largest": largest,
                "which": which, "has_tolerance": False}
               for name, (_, family, kinds, largest, which) in METHODS.items()]
    return {"methods": methods, "missing": MISSING}


def run(function, chains, rods, count, repeat):
    """CPU seconds per chain, and the heights of the first."""
    first, sink = None, 0.0
    start = time.process_time()
    for _ in range(repeat):
        for weight in chains:
            heights = function(weight, rods, count)
            sink += heights[0]
            if first is None:
                first = heights
    seconds = (time.process_time() - start) / (repeat * len(chains))
    if len(first) != count:
        raise RuntimeError(f"found {len(first)} modes")
    heights = [float(h) if math.isfinite(h) else None for h in first]
    return {"seconds": seconds, "sink": float(sink) if math.isfinite(sink) else 0, "heights": [heights]}


def main():
    """`run` gets the raw weights from files that the driver had the other worker write, one for each chain."""
    for line in sys.stdin:
        words = line.rstrip("\n").split("\t")
        try:
            if words[0] == "list":
                answer = listing()
            else:
                _, method, kind, _, count, _, repeat, *files = words
                chains = [np.fromfile(name) for name in files]
                answer = run(METHODS[method][0], chains, kind in "BR", int(count), int(repeat))
        except Exception as error:  # a peer that fails is a result
            answer = {"error": f"{type(error).__name__}: {error}".splitlines()[0]}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
