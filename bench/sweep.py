# SPDX-License-Identifier: MPL-2.0
"""A million small chains: `revchain.sweep` beside the bare `revchain.conical_heights` on arrays that are there already.

    python bench/sweep.py [--points 1000000] [--links 10] [--threads 2] [--rounds 5]

Rounds are interleaved; the least seconds of each are compared, and written as CSV: kind, links, chains, threads, seconds
of the bare call, of the sweep in memory, of the sweep kept on disk and written as .nc, and their shares of the bare speed.
"""

import argparse
import os
import tempfile
import time

import numpy as np

import revchain as rc


def study_of(kind, links, points):
    """Random weights of all links, and one random length."""
    link = {"mass": 1.0, "length": 1.0, "kind": kind}
    vary = {f"links[{k}].mass": {"uniform": [0.5, 2.0]} for k in range(links)}
    vary["links[0].length"] = {"uniform": [0.5, 2.0]}
    scene = {"links": [dict(link) for _ in range(links)], "ask": {"modes": "all"}}
    return rc.Study.from_dict({"scene": scene, "vary": vary, "samples": points, "seed": 1})


def seconds(work):
    began = time.perf_counter()
    result = work()
    return time.perf_counter() - began, result


def measure(kind, links, points, threads, rounds):
    study = study_of(kind, links, points)
    first = rc.sweep(study, threads=threads)
    weight = np.stack([first[f"links[{k}].mass"] for k in range(links)], axis=1) * study.scene.gravity_value()
    length = np.ones((points, links))
    length[:, 0] = first["links[0].length"]
    body = {"centroid": length / 2, "radius_of_gyration": length / 12**0.5} if kind == "rod" else {}
    times = [[], [], []]
    with tempfile.TemporaryDirectory() as folder:
        works = (
            lambda: rc.conical_heights(weight=weight, length=length, **body, threads=threads),
            lambda: rc.sweep(study, threads=threads),
            lambda: rc.sweep(study, threads=threads, out=os.path.join(folder, "out.nc")),
        )
        for _ in range(rounds):
            for work, spent in zip(works, times, strict=True):
                took, result = seconds(work)
                spent.append(took)
                if work is works[0]:
                    bare = result
    if not np.array_equal(bare, first["conical_height"]):
        raise SystemExit("the sweep and the bare call differ")
    return [min(spent) for spent in times]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--links", type=int, nargs="+", default=[10])
    parser.add_argument("--threads", type=int, default=2)
    parser.add_argument("--rounds", type=int, default=5)
    asked = parser.parse_args()
    print("kind,links,chains,threads,bare_s,sweep_s,sweep_to_disk_s,sweep_share,disk_share")
    for links in asked.links:
        for kind in ("plummet", "rod"):
            bare, memory, disk = measure(kind, links, asked.points, asked.threads, asked.rounds)
            row = f"{bare:.3f},{memory:.3f},{disk:.3f},{bare / memory:.2f},{bare / disk:.2f}"
            print(f"{kind},{links},{asked.points},{asked.threads},{row}", flush=True)


if __name__ == "__main__":
    main()
