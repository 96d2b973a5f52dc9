# SPDX-License-Identifier: MPL-2.0
"""A million small chains: `revchain.sweep` beside the bare `revchain.conical_heights` on arrays that are there already.

    python bench/sweep.py [--points 1000000] [--links 2 3 5 10] [--modes 0] [--threads 1] [--rounds 9] [--works memory nc]

Rows of CSV: what varies (`two`: two masses on a grid; `all`: all masses and a length, random), kind, links, modes (`all`, or
the first of them), chains, threads; what is done (`memory`: the sweep without a file; `chunks`: every point kept on disk,
but no output; `nc`, `parquet`, `csv`: that and the output, made to last by fsync); median seconds of the bare call and of
the sweep, in wall and in CPU time; the share of the bare speed that the sweep has, the median of interleaved rounds, in
each; megabytes that are written. It ends with an error if the heights of the two differ by more than 10 ulp: each is within 5 ulp.

    python bench/sweep.py --memory nc --points 10000000

prints the most memory that one sweep took, from a process of its own: all of it, and what is not pages of files.

    python bench/sweep.py --single --links 2 10 40

prints microseconds a point for points that are solved one by one, ten modes with proved bounds.
"""

import argparse
import contextlib
import os
import tempfile
import threading
import time
from math import isqrt
from unittest import mock

import numpy as np

import revchain as rc

WORKS = ("memory", "chunks", "nc", "parquet", "csv")


def study_of(kind, links, points, varied="all", modes=0):
    """All numbers of the chains random, or two of them on a grid; 0 modes are all."""
    link = {"mass": 1.0, "length": 1.0, "kind": kind}
    scene = {"links": [dict(link) for _ in range(links)], "ask": {"modes": {"count": modes or "all"}}}
    if varied == "two":
        grid = {"from": 0.5, "to": 2.0, "steps": isqrt(points)}
        return rc.Study.from_dict({"scene": scene, "vary": {"links[0].mass": grid, "links[1].mass": grid}})
    vary = {f"links[{k}].mass": {"uniform": [0.5, 2.0]} for k in range(links)}
    vary["links[0].length"] = {"uniform": [0.5, 2.0]}
    return rc.Study.from_dict({"scene": scene, "vary": vary, "samples": points, "seed": 1})


def arrays_of(kind, links, swept):
    """What the bare call takes for the same chains."""
    mass = np.ones((swept["status"].size, links))
    length = np.ones((swept["status"].size, links))
    for name in (name for name in [*swept.coords, *swept] if name.startswith("links")):
        link = int(name[6 : name.index("]")])
        (mass if name.endswith("mass") else length)[:, link] = swept[name].broadcast_like(swept["status"]).to_numpy().ravel()
    body = {"centroid": length / 2, "radius_of_gyration": length / np.sqrt(12)} if kind == "rod" else {}
    return {"weight": mass, "length": length, **body}


def work_of(name, study, threads, folder):
    """What is measured."""
    if name == "memory":
        return lambda: rc.sweep(study, workers=threads)
    out = os.path.join(folder, "out." + ("nc" if name == "chunks" else name))

    def with_a_file():
        if os.path.exists(out):
            os.remove(out)
        began = time.perf_counter(), time.process_time()
        rc.sweep(study, workers=threads, out=out)
        return began

    def without_output():
        with mock.patch("revchain.studies.sweep.write", lambda found, path: None):
            return with_a_file()

    return without_output if name == "chunks" else with_a_file


def timed(work):
    wall, cpu = time.perf_counter(), time.process_time()
    began = work()
    wall, cpu = began if isinstance(began, tuple) else (wall, cpu)
    return time.perf_counter() - wall, time.process_time() - cpu


def measure(study, kind, links, modes, threads, rounds, works):
    """Of each work the median seconds of the bare call and of its own, and the median share; wall and CPU."""
    first = rc.sweep(study, workers=threads)
    arrays = arrays_of(kind, links, first)
    count = modes or None

    def bare():
        rc.conical_heights(**arrays, threads=threads, count=count)

    heights = first["conical_height"].to_numpy().reshape(-1, modes or links)
    if not np.allclose(rc.conical_heights(**arrays, count=count), heights, rtol=2.3e-15, atol=0):
        raise SystemExit("the heights of the sweep and of the bare call differ")
    del first
    for name in works:
        with tempfile.TemporaryDirectory(dir=".") as folder:
            work = work_of(name, study, threads, folder)
            work()
            spent = np.array([[timed(bare), timed(work), timed(bare)] for _ in range(rounds)])
            size = sum(os.path.getsize(os.path.join(folder, file)) for file in os.listdir(folder))
        plain = (spent[:, 0] + spent[:, 2]) / 2
        medians = np.median(plain, axis=0), np.median(spent[:, 1], axis=0)
        yield name, *medians, np.median(plain / spent[:, 1], axis=0), size


def peak(name, study, threads):
    """Megabytes of this process at most, sampled: all that is resident, and what is memory of its own."""
    most, ended = [0, 0], threading.Event()

    def look():
        while not ended.wait(0.01):
            with open("/proc/self/status") as file:
                lines = dict(line.split(":", 1) for line in file)
            now = [int(lines[key].split()[0]) / 1e3 for key in ("VmRSS", "RssAnon")]
            most[:] = [max(pair) for pair in zip(most, now, strict=True)]

    with tempfile.TemporaryDirectory(dir=".") as folder, contextlib.ExitStack() as stack:
        thread = threading.Thread(target=look)
        thread.start()
        stack.callback(thread.join)
        stack.callback(ended.set)
        began = time.perf_counter()
        found = work_of(name, study, threads, folder)()
        seconds = time.perf_counter() - began
        del found
    print("work,chains,links,seconds,resident_MB,own_MB")
    print(f"{name},{study.points},{len(study.scene.links)},{seconds:.1f},{most[0]:.0f},{most[1]:.0f}")


def singles(links, points, rounds):
    """Print the time of points that are solved one by one, ten modes with proved bounds."""
    data = study_of("rod", links, points, modes=min(links, 10)).to_dict()
    study = rc.Study.from_dict({**data, "error_bounds": True})
    wall, cpu = np.median([timed(lambda: rc.sweep(study, workers=1) is None) for _ in range(rounds)], axis=0)
    print(f"{links},{points},{1e6 * wall / points:.1f},{1e6 * cpu / points:.1f}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--points", type=int, default=1_000_000)
    parser.add_argument("--links", type=int, nargs="+", default=[2, 3, 5, 10])
    parser.add_argument("--modes", type=int, nargs="+", default=[0])
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--rounds", type=int, default=9)
    parser.add_argument("--works", nargs="+", choices=WORKS, default=["memory", "chunks", "nc"])
    parser.add_argument("--varied", nargs="+", choices=("two", "all"), default=["two", "all"])
    parser.add_argument("--kinds", nargs="+", choices=("plummet", "rod"), default=["plummet", "rod"])
    parser.add_argument("--memory", choices=WORKS)
    parser.add_argument("--single", action="store_true")
    asked = parser.parse_args()
    if asked.memory:
        peak(asked.memory, study_of("plummet", asked.links[-1], asked.points), asked.threads)
        return
    if asked.single:
        print("links,points,us,cpu_us")
        for links in asked.links:
            singles(links, min(asked.points, 20_000), asked.rounds)
        return
    print("varied,kind,links,modes,chains,threads,work,bare_s,bare_cpu_s,sweep_s,sweep_cpu_s,share,cpu_share,MB")
    for varied in asked.varied:
        for kind in asked.kinds:
            for links in asked.links:
                for modes in asked.modes:
                    study = study_of(kind, links, asked.points, varied, modes)
                    given = kind, links, modes, asked.threads, asked.rounds, asked.works
                    for work, bare, sweep, share, size in measure(study, *given):
                        row = f"{varied},{kind},{links},{modes or 'all'},{study.points},{asked.threads},{work}"
                        seconds = ",".join(f"{number:.3f}" for number in (*bare, *sweep))
                        print(f"{row},{seconds},{share[0]:.2f},{share[1]:.2f},{size / 1e6:.0f}", flush=True)


if __name__ == "__main__":
    main()
