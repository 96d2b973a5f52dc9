# SPDX-License-Identifier: MPL-2.0
"""A million small chains: `revchain.sweep` beside the bare `revchain.conical_heights` on arrays that are there already.

    python bench/sweep.py [--points 1000000] [--links 10] [--threads 1] [--rounds 7]

Rows of CSV: what varies (`two`: two masses on a grid; `all`: all masses and a length, random), kind, links, chains, threads;
least seconds of interleaved rounds of the bare call, of the sweep in memory, and of the sweep kept on disk and written as
.nc; the share of the bare speed that each sweep has, and in CPU seconds the share of the one in memory (on a machine with
other work the one to believe). It ends with an error where the heights of the two are not the same to the last bit.
"""

import argparse
import os
import tempfile
import time
from math import isqrt

import numpy as np

import revchain as rc


def study_of(kind, links, points, varied="all"):
    """All numbers of the chains random, or two of them on a grid."""
    link = {"mass": 1.0, "length": 1.0, "kind": kind}
    scene = {"links": [dict(link) for _ in range(links)], "ask": {"modes": "all"}}
    if varied == "two":
        grid = {"from": 0.5, "to": 2.0, "steps": isqrt(points)}
        return rc.Study.from_dict({"scene": scene, "vary": {"links[0].mass": grid, "links[1].mass": grid}})
    vary = {f"links[{k}].mass": {"uniform": [0.5, 2.0]} for k in range(links)}
    vary["links[0].length"] = {"uniform": [0.5, 2.0]}
    return rc.Study.from_dict({"scene": scene, "vary": vary, "samples": points, "seed": 1})


def arrays_of(kind, links, swept):
    """What the bare call takes for the same chains."""
    mass = np.ones((len(swept), links))
    length = np.ones((len(swept), links))
    for name in swept.varied:
        link = int(name[6 : name.index("]")])
        (mass if name.endswith("mass") else length)[:, link] = swept[name]
    body = {"centroid": length / 2, "radius_of_gyration": length / np.sqrt(12)} if kind == "rod" else {}
    return {"weight": mass * swept.study.scene.gravity_value(), "length": length, **body}


def measure(study, kind, links, threads, rounds):
    """Least seconds of each, and least CPU seconds."""
    first = rc.sweep(study, threads=threads)
    arrays = arrays_of(kind, links, first)
    bare = rc.conical_heights(**arrays, threads=threads)
    if bare.tobytes() != first["conical_height"].tobytes():
        raise SystemExit("the heights of the sweep and of the bare call differ")
    spent = []
    with tempfile.TemporaryDirectory() as folder:
        works = (
            lambda: rc.conical_heights(**arrays, threads=threads),
            lambda: rc.sweep(study, threads=threads),
            lambda: rc.sweep(study, threads=threads, out=os.path.join(folder, "out.nc")),
        )
        for _ in range(rounds):
            for work in works:
                wall, cpu = time.perf_counter(), time.process_time()
                work()
                spent.append((time.perf_counter() - wall, time.process_time() - cpu))
    return np.array(spent).reshape(rounds, len(works), 2).min(axis=0).T


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--links", type=int, default=10)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=7)
    asked = parser.parse_args()
    print("varied,kind,links,chains,threads,bare_s,sweep_s,disk_s,sweep_share,disk_share,sweep_cpu_share")
    for varied in ("two", "all"):
        for kind in ("plummet", "rod"):
            study = study_of(kind, asked.links, asked.points, varied)
            (bare, memory, disk), cpu = measure(study, kind, asked.links, asked.threads, asked.rounds)
            shares = f"{bare / memory:.2f},{bare / disk:.2f},{cpu[0] / cpu[1]:.2f}"
            row = f"{varied},{kind},{asked.links},{study.points},{asked.threads}"
            print(f"{row},{bare:.3f},{memory:.3f},{disk:.3f},{shares}", flush=True)


if __name__ == "__main__":
    main()
