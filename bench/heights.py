# SPDX-License-Identifier: MPL-2.0
"""Heights alone, from the raw weights, by this library and its peers: a part of bench/run (docs/benchmarks.md).

    python bench/heights.py --csv FILE [--quick] [--tasks TEXT]

The programs bench_worker and bench_worker_native must be built. Exit status 1: a method of this library failed, its error
is above `error_limit`, or a time is too short for the work.
"""

import argparse
import csv
import json
import math
import os
import random
import select
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from math import log10
from pathlib import Path

import plan as plans
from measure import BUILD, ENVIRONMENT, ROOT

ULP = 2.0**-52


class Worker:
    """A process that answers lines with lines. One that hangs or dies is replaced, and what it was asked has failed."""

    def __init__(self, name, command):
        self.name, self.command = name, command
        self.start()
        self.about = self.ask("list", patience=120)
        self.methods = {method["name"]: method for method in self.about["methods"]}

    def start(self):
        self.process = subprocess.Popen(self.command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, env=ENVIRONMENT)

    def stop(self):
        self.process.kill()
        self.process.wait()
        self.process.stdin.close()
        self.process.stdout.close()

    def ask(self, *words, patience):
        self.process.stdin.write(("\t".join(map(str, words)) + "\n").encode())
        self.process.stdin.flush()
        line, end = b"", time.monotonic() + patience
        while not line.endswith(b"\n"):
            if not select.select([self.process.stdout], [], [], max(0, end - time.monotonic()))[0]:
                return self.replaced(f"given up after {patience:g} s")
            part = os.read(self.process.stdout.fileno(), 1 << 16)
            if not part:
                return self.replaced("the process died")
            line += part
        return json.loads(line)

    def replaced(self, why):
        self.stop()
        self.start()
        return {"error": why}


@dataclass
class Entry:
    """One method on one task: what is measured, and a row of the results."""

    task: plans.Task
    worker: Worker
    method: dict
    rtol: float
    seconds: list = field(default_factory=list)
    heights: list = field(default_factory=list)  # of the first chain of the first round
    calls: int = 1  # in one measurement
    error: float = math.nan  # worst relative error
    worst_mode: int = 0
    status: str = "ok"

    @property
    def time(self):
        return statistics.median(self.seconds) if self.seconds else math.nan

    def row(self, ns_per_cycle):
        return {
            "kind": self.task.kind, "links": self.task.links, "modes": self.task.modes,
            "method": self.method["name"], "family": self.method["family"], "build": self.worker.name,
            "rtol": self.rtol or "", "cpu_seconds": f"{self.time:.4g}",
            "fastest": f"{min(self.seconds, default=math.nan):.4g}",
            "slowest": f"{max(self.seconds, default=math.nan):.4g}", "rounds": len(self.seconds),
            "cycles": f"{self.task.cycles(self.time, ns_per_cycle):.4g}", "error": f"{self.error:.3g}",
            "error_ulp": f"{self.error / ULP:.4g}", "worst_mode": self.worst_mode, "status": self.status,
        }


class Bench:
    def __init__(self, plan, workers, folder):
        self.plan, self.workers, self.folder = plan, workers, folder
        self.native = workers[0]
        self.ns_per_cycle = self.native.about["ns_per_cycle"]
        self.entries = []

    def entries_of(self, task):
        for worker in self.workers:
            for method in worker.methods.values():
                ours = method["family"] in ("revchain", "baseline")
                if worker.name == "portable" and not ours:
                    continue  # the same library, or of no consequence
                fits = task.kind in method["kinds"] and task.links <= method["largest"]
                if method["which"] == "few":
                    fits = fits and task.modes <= 10 and not task.all
                if not fits or method["family"] == "canary" or (task.only and method["name"] not in task.only):
                    continue
                if method["which"] == "all" and not task.all and task.links > 1000:
                    continue  # the same time as for all, which has tasks of its own
                sweep = method["has_tolerance"] and worker.name != "portable"
                for rtol in task.tolerances if sweep else (0.0,):
                    yield Entry(task, worker, method, rtol)

    def ask(self, entry, seed):
        """`entry.calls` calls or a few more, on up to 64 different chains."""
        task, chains = entry.task, min(64, entry.calls)
        repeat = -(-entry.calls // chains)
        if entry.worker.name == "Python":
            names = [self.raw_file(task, seed + i) for i in range(chains)]
            words = ("run", entry.method["name"], task.kind, task.links, task.modes, entry.rtol, repeat, *names)
        else:
            words = ("run", entry.method["name"], task.kind, task.links, task.modes, entry.rtol, seed, chains,
                     repeat)
        return entry.worker.ask(*words, patience=self.plan.patience)

    def raw_file(self, task, seed):
        name = f"{self.folder}/{task.kind}{task.links}-{seed}"
        if not os.path.exists(name):
            self.native.ask("write", task.kind, task.links, seed, name, patience=60)
        return name

    def measure(self, task):
        """All methods take turns, in a new order and on new chains each round."""
        entries = list(self.entries_of(task))
        order = random.Random(1)
        for round_number in range(self.plan.rounds):
            due = [e for e in entries if e.status == "ok" and sum(e.seconds) * e.calls < self.plan.budget]
            order.shuffle(due)
            for entry in due:
                answer = self.ask(entry, 100 * round_number)
                if round_number == 0 and "error" not in answer:
                    entry.heights = answer["heights"][0]
                    entry.calls = max(1, math.ceil(self.plan.slice / max(answer["seconds"], 1e-8)))
                    if entry.calls > 1:  # the first was too short to count
                        answer = self.ask(entry, 0)
                if "error" in answer:
                    entry.status = "FAILED: " + answer["error"]
                else:
                    entry.seconds.append(answer["seconds"])
        for name in os.listdir(self.folder):
            os.unlink(f"{self.folder}/{name}")
        self.judge(task, entries)
        self.entries += entries

    def judge(self, task, entries):
        self.compare(task, [e for e in entries if e.heights])
        for entry in entries:
            if entry.status == "ok" and task.cycles(entry.time, self.ns_per_cycle) < task.floor:
                entry.status = "BROKEN: faster than the arithmetic allows"

    def compare(self, task, entries):
        """The largest error of each, over all modes or a sample."""
        guess = next((e for e in entries if e.method["name"] == "modes" and not e.rtol), None)
        if guess is None:
            return
        numbers = range(task.modes)
        if task.modes > self.plan.truths:
            between = range(0, task.modes, task.modes // self.plan.truths)
            numbers = sorted({*range(10), *between, *range(task.modes - 10, task.modes)})
        words = [f"{j}:{guess.heights[j]!r}" for j in numbers]
        answer = self.native.ask("truth", task.kind, task.links, 0, *words, patience=3600)
        if "error" in answer:
            sys.exit(f"no truth for {task}: {answer['error']}")
        for entry in entries:
            for j, truth in zip(numbers, zip(*answer["heights"], strict=True), strict=True):
                height = entry.heights[j]
                error = math.inf if height is None else abs(math.fsum([height, *(-t for t in truth)]) / truth[0])
                if not error <= entry.error:
                    entry.error, entry.worst_mode = error, j + 1

    def check_the_checks(self):
        """The truth against another formulation; and whether a method that skips its work is found out."""
        checks = self.native.ask("check", patience=300)
        if not checks.get("good"):
            sys.exit(f"the truth or the baseline is wrong: {checks}")
        canary = Entry(plans.Task("C", 100_000, 10), self.native, self.native.methods["canary"], 0.0)
        canary.calls = 100
        canary.seconds = [self.ask(canary, 0)["seconds"]]
        self.judge(canary.task, [canary])
        if not canary.status.startswith("BROKEN"):
            sys.exit("a method that skips its work was not found out: the floor is too low")
        return checks


def error_limit(links):
    """Largest error allowed of a mode, in ulp (2^-52): 4, and one more for each decade of links beyond 1e4."""
    return 4 + max(0.0, log10(links / 1e4))


def wrong(entry):
    """The fault of an entry, empty if there is none. Peers may fail; this library may not."""
    if entry.status.startswith("BROKEN") or (entry.status != "ok" and entry.method["family"] == "revchain"):
        return entry.status
    if entry.method["name"] == "modes" and not entry.rtol and not entry.error <= error_limit(entry.task.links) * ULP:
        return f"error of {entry.error / ULP:.2g} ulp"
    return ""


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--csv", type=Path, required=True, metavar="FILE")
    parser.add_argument("--quick", action="store_true", help="small sizes")
    parser.add_argument("--tasks", default="", metavar="TEXT", help="those whose description contains this")
    options = parser.parse_args()
    plan = plans.QUICK if options.quick else plans.FULL
    tasks = [task for task in plan.tasks if options.tasks in str(task)]
    if not tasks:
        parser.error(f"--tasks: no description contains {options.tasks!r}; one is {str(plan.tasks[0])!r}")
    start = time.monotonic()
    workers = [Worker("native", [BUILD / "bench" / "bench_worker_native"]),
               Worker("portable", [BUILD / "bench" / "bench_worker"]),
               Worker("Python", [sys.executable, ROOT / "bench" / "scipy_worker.py"])]
    with tempfile.TemporaryDirectory() as raw:
        bench = Bench(plan, workers, raw)
        bench.check_the_checks()
        for number, task in enumerate(tasks, 1):
            print(f"[{number}/{len(tasks)}, {time.monotonic() - start:.0f} s] {task}", flush=True)
            bench.measure(task)
    for worker in workers:
        worker.stop()
    rows = [entry.row(bench.ns_per_cycle) for entry in bench.entries]
    with options.csv.open("w", newline="", encoding="utf-8") as file:
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)
    bad = [(entry, why) for entry in bench.entries if (why := wrong(entry))]
    for entry, why in bad:
        print(f"{entry.task}, {entry.method['name']} ({entry.worker.name}): {why}", file=sys.stderr)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
