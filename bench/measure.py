# SPDX-License-Identifier: MPL-2.0
"""Builds and runs the benchmarks: see bench/run --help and docs/benchmarks.md."""

import argparse
import csv
import datetime
import json
import math
import os
import random
import select
import shlex
import statistics
import subprocess
import sys
import tempfile
import time
from dataclasses import asdict, dataclass, field
from pathlib import Path

import plan as plans

ROOT = Path(__file__).resolve().parent.parent
BUILD = ROOT / "build" / "bench"
ULP = 2.0**-52
# Peers as they are used: CPU time is counted over all threads, and more than one would only add to it.
ENVIRONMENT = os.environ | {name: "1" for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")}


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
    heights: list = field(default_factory=list)  # of the first chain of the first round, in parts
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
            "method": self.method["name"], "family": self.method["family"], "scalar": self.method["scalar"],
            "build": self.worker.name, "rtol": self.rtol or "", "cpu_seconds": f"{self.time:.4g}",
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
                ours = method["family"] in ("revchain", "baseline") and method["scalar"] == "double"
                if worker.name == "portable" and not ours:
                    continue  # the same library, or of no consequence
                fits = task.kind in method["kinds"] and task.links <= method["largest"]
                if method["which"] == "few":
                    fits = fits and task.modes <= 10 and not task.all
                if not fits or method["family"] == "canary":
                    continue
                if method["which"] == "all" and not task.all and task.links > 1000:
                    continue  # the same time as for all, which has tasks of its own
                if method["family"] == "revchain" and method["scalar"] != "double" and task.all and task.links > 1000:
                    continue  # one by one, minutes to hours
                sweep = method["has_tolerance"] and worker.name != "portable"
                for rtol in self.plan.tolerances if sweep else (0.0,):
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
        wanted = any(task in (target.task, target.baseline_task) for target in self.plan.targets)
        budget = self.plan.budget if wanted else self.plan.budget / 4
        order = random.Random(1)
        for round_number in range(self.plan.rounds):
            due = [e for e in entries if e.status == "ok" and sum(e.seconds) * e.calls < budget]
            order.shuffle(due)
            for entry in due:
                answer = self.ask(entry, 100 * round_number)
                if round_number == 0 and "error" not in answer:
                    entry.heights = answer["heights"]
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
        with_heights = [e for e in entries if e.heights]
        guess = next((e for e in with_heights if e.method["name"] == "modes" and not e.rtol), None)
        numbers = range(task.modes)
        if task.modes > self.plan.truths:
            between = range(0, task.modes, task.modes // self.plan.truths)
            numbers = sorted({*range(10), *between, *range(task.modes - 10, task.modes)})
        truths = {}
        for entry in with_heights:
            secants = 2 if entry.method["scalar"] in ("long double", "__float128", "double-double") else 1
            if secants not in truths:
                words = [f"{j}:{guess.heights[0][j]!r}" for j in numbers]
                answer = self.native.ask("truth", task.kind, task.links, 0, secants, *words, patience=3600)
                if "error" in answer:
                    sys.exit(f"no truth for {task}: {answer['error']}")
                truths[secants] = list(zip(*answer["heights"]))
            for j, truth in zip(numbers, truths[secants]):
                parts = [part[j] for part in entry.heights]
                error = math.inf if None in parts else abs(math.fsum([*parts, *(-t for t in truth)]) / truth[0])
                if not error <= entry.error:
                    entry.error, entry.worst_mode = error, j + 1
        for entry in entries:
            if entry.status == "ok" and task.cycles(entry.time, self.ns_per_cycle) < task.floor:
                entry.status = "BROKEN: faster than the arithmetic allows"

    def find(self, task, method, build="native", rtol=0.0):
        for e in self.entries:
            if e.task == task and e.method["name"] == method and e.rtol == rtol and e.worker.name in (build, "Python"):
                return e
        return None

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


COLUMNS = {"job": "job", "ours": "method", "baseline": "baseline", "reached": "reached", "target": "target",
           "verdict": "verdict", "our_ms": "CPU ms", "baseline_ms": "CPU ms, baseline",
           "our_ulp": "error, ulp", "baseline_ulp": "error, ulp, baseline"}


def compared(job, ours, peer, reached, target, verdict, names=()):
    """A row of the table of targets: two entries, either of which may be missing, and what was made of them."""
    def of(entry, what):
        return "" if entry is None else what(entry)

    row = {"job": job, "ours": of(ours, lambda e: e.method["name"]), "baseline": of(peer, lambda e: e.method["name"]),
           "reached": reached, "target": target, "verdict": verdict,
           "our_ms": of(ours, lambda e: e.time * 1e3), "baseline_ms": of(peer, lambda e: e.time * 1e3),
           "our_ulp": of(ours, lambda e: e.error / ULP), "baseline_ulp": of(peer, lambda e: e.error / ULP)}
    return {name: in_digits(value) for name, value in (row | dict(names)).items()}


def target_rows(bench):
    """Ratios reached, errors of both, verdicts."""
    def verdict(good, timed=True):
        if timed and not bench.plan.final:
            return "quick run: none"
        return "reached" if good else "MISSED"

    rows = []
    for target in bench.plan.targets:
        ours = bench.find(target.task, target.ours, rtol=target.rtol)
        peer = bench.find(target.baseline_task, target.baseline)
        if ours is None:
            continue  # --only
        names = {"ours": target.ours + (f", rtol {target.rtol:g}" if target.rtol else ""),
                 "baseline": target.baseline + (f" (on {plans.KINDS[target.baseline_kind]})" if target.baseline_kind else "")}
        if peer is None or not peer.seconds or not ours.seconds:
            why = "baseline missing" if peer is None else peer.status if ours.seconds else ours.status
            rows.append(compared(str(target.task), ours, peer, "", "", why, names))
            continue
        ratio = peer.time / ours.time
        asked = (f"{target.ratio} x", verdict(ratio >= target.ratio)) if target.ratio else ("", "")
        rows.append(compared(str(target.task), ours, peer, f"{ratio:.3g} x", *asked, names))
    for task in dict.fromkeys(target.task for target in bench.plan.targets):
        ours, portable = bench.find(task, "modes"), bench.find(task, "modes", "portable")
        if task.links > 10 and ours and portable and ours.seconds and portable.seconds:
            slower = portable.time / ours.time
            rows.append(compared(f"portable build: {task}", portable, ours, f"{slower:.3g} x slower", "1.5 x",
                                 verdict(slower <= 1.5), {"ours": "modes, portable", "baseline": "modes, native"}))
        python = bench.find(task, "modes, from Python")
        if task.links == 10 and portable and python and portable.seconds and python.seconds:  # as the module is built
            added = (python.time - portable.time) * 1e6
            rows.append(compared(f"called from Python: {task}", python, portable, f"{added:.3g} microseconds more", "20",
                                 verdict(added <= 20)))
    for links in sorted({task.links for task in bench.plan.tasks}):
        found = [e for e in bench.entries
                 if e.task.links == links and e.method["name"] == "modes" and not e.rtol and e.worker is bench.native]
        if found:
            worst, limit = max(found, key=lambda e: e.error), plans.error_limit(links)
            rows.append(compared(f"error of every mode, N = {links:,}, {len(found)} chains", worst, None,
                                 f"{worst.error / ULP:.2g} ulp", f"{limit:.3g} ulp",
                                 verdict(worst.error / ULP <= limit, timed=False)))
    return rows


def in_digits(x):
    return f"{x:.3g}" if isinstance(x, float) else str(x)


def summary(rows, heading):
    lines = ["| " + " | ".join(COLUMNS.values()) + " |", "|---" * len(COLUMNS) + "|"]
    lines += ["| " + " | ".join(row[name] for name in COLUMNS) + " |" for row in rows]
    return "\n".join([*(f"{line}  " for line in heading), "", *lines, ""])


# ---- what the results were measured with ---------------------------------------------------------------------------


def output(*command):
    try:
        return subprocess.run(command, capture_output=True, text=True, cwd=ROOT, check=True).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return ""


def machine():
    """Model, cores, caches; no names."""
    fields = dict(line.split(":", 1) for line in output("lscpu").splitlines() if ":" in line)
    wanted = ("Model name", "CPU(s)", "L1d cache", "L2 cache", "L3 cache")
    text = ", ".join(f"{name} {fields[name].strip()}" for name in wanted if name in fields)
    return text or f"CPU(s) {os.cpu_count()}"


def flags(target):
    for command in json.loads((BUILD / "compile_commands.json").read_text()):
        if f"/{target}.dir/" in command["command"]:
            words = shlex.split(command["command"])
            return " ".join(w for w in words if w.startswith(("-O", "-m", "-std", "-f", "-DNDEBUG")))
    return ""


def has_batch():
    return (ROOT / "bench" / "batch.cpp").exists()


def build():
    configure = ["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                 "-DREVCHAIN_BUILD_BENCH=ON", "-DREVCHAIN_BENCH_TIMED=ON",
                 "-DREVCHAIN_BUILD_TESTS=OFF", "-DREVCHAIN_BUILD_EXAMPLES=OFF",
                 "-DREVCHAIN_ANALYTIC=OFF", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"]
    log = subprocess.run(configure, capture_output=True, text=True)
    if log.returncode:
        sys.exit(log.stdout + log.stderr)
    targets = ["bench_worker", "bench_worker_native", "bench_convergence", "bench_models", "bench_tradeoff"]
    if has_batch():
        targets += ["bench_batch", "bench_batch_native"]
    if subprocess.run(["cmake", "--build", BUILD, "--target", *targets]).returncode:
        sys.exit("the benchmarks do not build")


def start_workers():
    return [Worker("native", [BUILD / "bench" / "bench_worker_native"]),
            Worker("portable", [BUILD / "bench" / "bench_worker"]),
            Worker("Python", [sys.executable, ROOT / "bench" / "scipy_worker.py"])]


def heading(plan, workers, missing):
    native, _, python = workers
    lines = [f"bench/run --{plan.name}, {datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d}, revision "
             f"{output('git', 'describe', '--always', '--dirty')}",
             f"machine: {machine()}; one cycle {native.about['ns_per_cycle']:.4g} ns",
             f"compiler: {native.about['compiler']}",
             f"native: {flags('bench_worker_native')}; portable: {flags('bench_worker')}",
             f"LAPACK: {native.about['lapack']}; {python.about['versions']}"]
    return lines + [f"skipped: {name}: {reason}" for name, reason in missing]


def run_convergence(plan, folder):
    file = folder / "convergence.csv"
    with (folder / "convergence.txt").open("w") as text:
        subprocess.run([BUILD / "bench" / "bench_convergence", "--largest", str(plan.convergence), "--csv", file,
                        "--flags", flags("bench_convergence")], stdout=text, check=True)
    subprocess.run([sys.executable, ROOT / "bench" / "plot_convergence.py", file], check=True)


def run_batch(folder):
    """bench_batch in both builds: rows for the table of targets, and how many it found broken."""
    tables = {}
    for build_name, program in (("native", "bench_batch_native"), ("portable", "bench_batch")):
        text = subprocess.run([BUILD / "bench" / program], capture_output=True, text=True, env=ENVIRONMENT, check=True)
        (folder / f"batch-{build_name}.csv").write_text(text.stdout)
        tables[build_name] = text.stdout
    rows = []
    for row in csv.DictReader(tables["native"].splitlines()):
        if row["N"] == "10":
            ratio, chains = float(row["ratio"]), int(row["chains"])
            reached = "baseline missing" if ratio == 0 else "reached" if ratio >= plans.BATCH_RATIO else "MISSED"
            rows.append(dict(zip(COLUMNS, (
                f"{chains:,} chains of 10 {row['kind']}, all modes", "conical_heights",
                "dsterf, one by one" if row["kind"] == "plummets" else "dsbgv, one by one", f"{ratio:.3g} x",
                f"{plans.BATCH_RATIO} x", reached, in_digits(float(row["us"]) * chains / 1e3),
                in_digits(float(row["lapack_us"]) * chains / 1e3), row["error_ulp"], row["lapack_error_ulp"]))))
    return rows, sum(table.count("broken") for table in tables.values())


def run_models(plan, folder, about):
    """What models cost beside what they say, how good choices among them are, and every model over a grid of questions:
    rows for the table of targets, and how many bounds were violated or times too short for the work."""
    def row(job, method, reached, target, verdict):
        return dict(zip(COLUMNS, (job, method, "", reached, target, verdict, "", "", "", "")))

    rows, broken = [], 0
    table = folder / "tradeoff.csv"
    program = [BUILD / "bench" / "bench_tradeoff", *([] if plan.final else ["--quick"])]
    done = subprocess.run(program, capture_output=True, text=True)
    head = "".join(f"# {line}\n" for line in ["SPDX-License-Identifier: MPL-2.0", *about[:3]])
    table.write_text(head + done.stdout, encoding="utf-8")
    (folder / "tradeoff.txt").write_text(done.stderr, encoding="utf-8")
    broken += done.returncode != 0
    rows.append(row("every model, all tolerances: error within its bound, bound within the tolerance", "solve_by",
                    f"{done.stdout.count(chr(10)) - 1} answers", "all", "reached" if done.returncode == 0 else "MISSED"))
    subprocess.run([sys.executable, ROOT / "bench" / "plot_tradeoff.py", table], check=True)
    if not plan.final:
        return rows, broken
    for name, words in (("models", []), ("choices", ["choice", "1000"])):
        done = subprocess.run([BUILD / "bench" / "bench_models", *words], capture_output=True, text=True)
        (folder / f"{name}.csv").write_text(done.stdout, encoding="utf-8")
        found = list(csv.DictReader(done.stdout.splitlines()))
        if not found:
            sys.exit(done.stderr)
        if name == "models":
            off = sum(not 1 / 3 <= float(entry["ratio"]) <= 3 for entry in found)
            rows.append(row(f"{len(found)} times predicted, off by more than 3 x", "select", str(off), "0",
                            "reached" if off == 0 else "MISSED"))
        else:
            good = sum(float(e["ratio"]) <= 2 or float(e["took_us"]) < 0.2 for e in found) / len(found)
            broken += sum(not float(entry["error_over_bound"]) <= 1 for entry in found)
            rows.append(row(f"{len(found)} random questions: within 2 x of the cheapest model", "select", f"{good:.1%}",
                            "95 %", "reached" if good >= 0.95 else "MISSED"))
    return rows, broken


def write(folder, name, rows, comments):
    with (folder / name).open("w", newline="", encoding="utf-8") as file:
        file.writelines(f"# {line}\n" for line in ["SPDX-License-Identifier: MPL-2.0", *comments])
        table = csv.DictWriter(file, rows[0], lineterminator="\n")
        table.writeheader()
        table.writerows(rows)


def main():
    parser = argparse.ArgumentParser(prog="bench/run", description="Speed and error of revchain and its peers.")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--full", dest="plan", action="store_const", const=plans.FULL, default=plans.FULL,
                       help="everything, at the sizes of the targets, into bench/results/DATE/ (default)")
    which.add_argument("--quick", dest="plan", action="store_const", const=plans.QUICK,
                       help="small sizes, some two minutes, into out/bench/")
    parser.add_argument("--into", type=Path, help="another folder for the results")
    parser.add_argument("--only", default="", help="tasks whose description contains this")
    options = parser.parse_args()
    plan = options.plan
    tasks = [task for task in plan.tasks if options.only in str(task)]
    if not tasks:
        parser.error(f"--only: no task's description contains {options.only!r}; one is {str(plan.tasks[0])!r}")
    today = f"{datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d}"
    folder = options.into or (ROOT / "bench" / "results" / today if plan.final else ROOT / "out" / "bench")
    folder.mkdir(parents=True, exist_ok=True)

    build()
    start = time.monotonic()
    workers = start_workers()
    with tempfile.TemporaryDirectory() as raw:
        bench = Bench(plan, workers, raw)
        missing = [tuple(m) for worker in (workers[0], workers[2]) for m in worker.about["missing"]]
        about = heading(plan, workers, missing)
        print("\n".join(about))
        bench.check_the_checks()
        for number, task in enumerate(tasks, 1):
            print(f"[{number}/{len(tasks)}, {time.monotonic() - start:.0f} s] {task}", flush=True)
            bench.measure(task)
    for worker in workers:
        worker.stop()

    rows = [entry.row(bench.ns_per_cycle) for entry in bench.entries]
    wanted, broken_others = target_rows(bench), 0
    if plan.final and has_batch() and not options.only:
        batch_rows, broken_others = run_batch(folder)
        wanted += batch_rows
    if not options.only:
        model_rows, broken_models = run_models(plan, folder, about)
        wanted, broken_others = wanted + model_rows, broken_others + broken_models
    write(folder, "measurements.csv", rows, about)
    write(folder, "targets.csv", wanted, about)
    results = {"heading": about, "plan": asdict(plan), "rows": rows,
               "targets": wanted}
    (folder / "results.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    (folder / "summary.md").write_text(summary(wanted, about), encoding="utf-8")
    run_convergence(plan, folder)
    subprocess.run([sys.executable, ROOT / "bench" / "plot_work_precision.py", folder / "measurements.csv"], check=True)

    print("\n" + summary(wanted, []))
    for entry in bench.entries:
        if entry.status != "ok":
            print(f"{entry.task}, {entry.method['name']} ({entry.worker.name}): {entry.status}")
    bad = [e for e in bench.entries
           if e.status.startswith("BROKEN") or (e.status != "ok" and e.method["family"] == "revchain")]
    print(f"{len(rows)} measurements in {time.monotonic() - start:.0f} s, {len(bad) + broken_others} broken; results in {folder}")
    return 1 if bad or broken_others else 0


if __name__ == "__main__":
    sys.exit(main())
