# SPDX-License-Identifier: MPL-2.0
"""Builds the benchmark programs and runs the parts of the benchmark: see bench/run --help and docs/benchmarks.md."""

import argparse
import datetime
import importlib.metadata
import json
import os
import platform
import re
import shlex
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
BENCH, BUILD = ROOT / "bench", ROOT / "build" / "bench"
RESULTS, SCRATCH = BENCH / "results", ROOT / "out" / "bench"
LIBRARY = BUILD / "librevchain_compiled.a"
CSV = "FILE"  # in the words of a part: its file of results; without it these are what the part prints
# CPU time is counted over all threads of the peers, and more than one would only add to it.
ENVIRONMENT = os.environ | {name: "1" for name in ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")}


@dataclass(frozen=True)
class Part:
    """One file of results, NAME.csv; what the program says of them on standard error is kept in about.json."""

    name: str
    words: tuple  # a program bench_... or a file of bench/, and its arguments
    quick: tuple | None = ()  # added by --quick, in place of the arguments after a program; None: left out by it
    needs: tuple[str, ...] = ()  # further targets of the build
    picture: str = ""  # the file of bench/ that draws it, into the same folder
    table: bool = True  # whether the rows are kept; else only what is said of them

    @property
    def targets(self):
        return (self.words[0], *self.needs) if self.words[0].startswith("bench_") else self.needs


PARTS = (
    Part("ordinary", ("ordinary.py", "--csv", CSV), ("--quick",), picture="plot_ordinary.py"),
    Part("heights", ("heights.py", "--csv", CSV), ("--quick",), ("bench_worker", "bench_worker_native"), "plot_heights.py"),
    Part("batch", ("bench_batch",), ("1000",)),
    Part("engines", ("bench_engines", "0", "0", "10", "100", "1000"), ("0", "0", "10")),
    Part("models", ("bench_models",), None, table=False),
    Part("choices", ("bench_models", "choice", "1000"), ("choice", "5"), table=False),
    Part("select", ("bench_models", "select"), table=False),
    Part("tradeoff", ("bench_tradeoff",), ("--quick",), picture="plot_tradeoff.py"),
    Part("steady-shapes", ("bench_steady_shapes",), None),
    Part("convergence", ("bench_convergence",), ("1000",), picture="plot_convergence.py"),
    Part("shape-convergence", ("bench_convergence", "shapes"), ("shapes", "40")),
    Part("continuous", ("continuous_peers.py", BUILD / "bench" / "bench_continuous", "--csv", CSV), ("--rounds", "1"),
         ("bench_continuous",)),
    Part("elliptic", ("bench_elliptic",)),
    Part("response", ("bench_response",)),
    Part("threads", ("bench_threads", "2"), ("2", "1")),
    Part("accuracy", ("bench_accuracy",), ("100",)),
    Part("random-systems", ("bench_random_systems", "10000", "1"), ("20", "1")),
    Part("studies", ("sweep.py", "--links", "2", "10", "--kinds", "plummet", "--works", "memory", "chunks", "--rounds", "5"),
         ("--points", "10000", "--rounds", "1")),
    Part("study-points", ("sweep.py", "--single", "--links", "2", "10", "40", "--points", "3000", "--rounds", "5"),
         ("--points", "100", "--rounds", "1")),
    Part("compile-times", ("compile_times", "--repeat", "2", "--library", LIBRARY, "--csv", CSV),
         None, ("revchain_compiled",)),
)


def build(targets):
    configure = ["cmake", "-S", ROOT, "-B", BUILD, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release",
                 "-DREVCHAIN_BUILD_BENCH=ON", "-DREVCHAIN_BENCH_TIMED=ON", "-DREVCHAIN_BUILD_TESTS=OFF",
                 "-DREVCHAIN_BUILD_EXAMPLES=OFF", "-DREVCHAIN_BUILD_COMPILED=DOUBLE", "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON"]
    if shutil.which("ccache"):
        configure.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    log = subprocess.run(configure, capture_output=True, text=True)
    if log.returncode:
        sys.exit(log.stdout + log.stderr)
    if targets and subprocess.run(["cmake", "--build", BUILD, "--target", *targets]).returncode:
        sys.exit("the benchmarks do not build")


def run(part, folder, quick):
    """Runs a part. Returns its seconds, its exit status and its lines on standard error."""
    name, *words = part.words
    if quick and name.startswith("bench_"):
        words = part.quick or words
    elif quick:
        words += part.quick
    table = folder / f"{part.name}.csv" if part.table else Path(os.devnull)
    command = [BUILD / "bench" / name] if name.startswith("bench_") else [sys.executable, BENCH / name]
    command += [table if word == CSV else word for word in words]
    start = time.monotonic()
    if CSV in words:
        done = subprocess.run(command, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, cwd=ROOT)
    else:
        with table.open("w", encoding="utf-8") as file:
            done = subprocess.run(command, stdout=file, stderr=subprocess.PIPE, text=True, env=ENVIRONMENT, cwd=ROOT)
    status = done.returncode
    if part.table and (not table.exists() or table.read_text(encoding="utf-8").count("\n") < 2):
        status = 2  # no rows
    said = done.stderr.splitlines()
    print(*said, sep="\n", end="\n" if said else "")
    if part.picture and status in (0, 1) and subprocess.run([sys.executable, BENCH / part.picture, table]).returncode:
        status = 2
    return {"seconds": round(time.monotonic() - start), "status": status, "said": said}


# ---- what the results were measured with ---------------------------------------------------------------------------


def output(*command, stdin=""):
    try:
        done = subprocess.run(command, input=stdin, capture_output=True, text=True, cwd=ROOT, check=True,
                              env=ENVIRONMENT)
    except (OSError, subprocess.CalledProcessError):
        return ""
    return done.stdout.strip()


def machine():
    """Processor, cores, caches; no names."""
    fields = dict(line.split(":", 1) for line in output("lscpu").splitlines() if ":" in line)
    vectors = [name for name in ("avx512f", "avx2", "asimd") if name in fields.get("Flags", "").split()]
    found = {"processor": fields.get("Model name", platform.machine()).strip(), "cores": os.cpu_count(),
             "vectors": vectors[:1]}
    return found | {name: fields[name].strip() for name in ("L1d cache", "L2 cache", "L3 cache") if name in fields}


def flags(target):
    for command in json.loads((BUILD / "compile_commands.json").read_text()):
        if f"/{target}.dir/" in command["command"]:
            words = shlex.split(command["command"])
            return " ".join(word for word in words if word.startswith(("-O", "-m", "-std", "-f", "-DNDEBUG")))
    return ""


def of_header(header, *names):
    """The values of macros, such as the version of a library; empty without the header."""
    command = [os.environ.get("CXX", "c++"), "-E", "-P", "-x", "c++", "-std=c++20", "-I/usr/include/eigen3", "-"]
    found = output(*command, stdin=f"#include <{header}>\nnumbers: {' . '.join(names)}\n")
    number = re.sub(r'[\s"]', "", found.rpartition("numbers:")[2]).replace("_", ".")
    return "" if any(name in number for name in names) else number


def versions():
    found = {name: importlib.metadata.version(name) for name in ("numpy", "scipy", "xarray")}
    import scipy  # noqa: PLC0415  # slow to load

    lapack = scipy.show_config(mode="dicts")["Build Dependencies"]["lapack"]
    found = {"Python": platform.python_version(), "NumPy": found["numpy"],
             "SciPy": f"{found['scipy']} with {lapack['name']} {lapack['version']}", "xarray": found["xarray"]}
    worker = BUILD / "bench" / "bench_worker_native"
    library = json.loads(output(worker, stdin="list\n") or "{}").get("lapack", "")
    if number := re.search(r"openblas.*?-r([\d.]+\d)", library):
        library = f"OpenBLAS {number[1]}"
    found["LAPACK"] = Path(library).name
    found["Eigen"] = of_header("Eigen/Core", "EIGEN_WORLD_VERSION", "EIGEN_MAJOR_VERSION", "EIGEN_MINOR_VERSION")
    spectra = [f"SPECTRA_{part}_VERSION" for part in ("MAJOR", "MINOR", "PATCH")]
    found["Spectra"] = of_header("Spectra/Util/Version.h", *spectra)
    found["GSL"] = of_header("gsl/gsl_version.h", "GSL_VERSION")
    found["Boost"] = of_header("boost/version.hpp", "BOOST_LIB_VERSION")
    return {name: number or "not installed" for name, number in found.items()}


def about(quick):
    native, portable = (flags(f"bench_worker{end}") for end in ("_native", ""))
    return {"command": f"bench/run --{'quick' if quick else 'full'}",
            "date": f"{datetime.datetime.now(datetime.timezone.utc):%Y-%m-%d}",
            "revision": output("git", "describe", "--always", "--dirty"), "machine": machine(),
            "compiler": output(os.environ.get("CXX", "g++"), "--version").partition("\n")[0],
            "flags": {"native": native, "portable": portable}, "versions": versions(), "parts": {}}


def publish(folder):
    """The results of a whole run take the place of all former ones."""
    RESULTS.mkdir(exist_ok=True)
    for file in RESULTS.iterdir():
        file.unlink()
    for file in folder.iterdir():
        shutil.copy(file, RESULTS)


def main():
    names = ", ".join(part.name for part in PARTS)
    parser = argparse.ArgumentParser(prog="bench/run", description="Speed and error of revchain and its peers.",
                                     epilog=f"The parts: {names}.")
    which = parser.add_mutually_exclusive_group()
    which.add_argument("--full", action="store_true",
                       help="everything that the documentation quotes, into bench/results; then: python bench/pages.py")
    which.add_argument("--quick", action="store_true", help="small sizes, to test the benchmarks")
    parser.add_argument("--only", nargs="+", default=[part.name for part in PARTS], metavar="PART", help="these parts")
    parser.add_argument("--into", type=Path, default=SCRATCH, metavar="FOLDER", help="where to write (out/bench)")
    options = parser.parse_args()
    unknown = set(options.only) - {part.name for part in PARTS}
    if unknown:
        parser.error(f"--only: there is no part {sorted(unknown)[0]!r}; the parts are {names}")
    whole = options.full and len(set(options.only)) == len(PARTS)
    parts = [part for part in PARTS if part.name in options.only and not (options.quick and part.quick is None)]
    folder = options.into
    folder.mkdir(parents=True, exist_ok=True)

    build(sorted({target for part in parts for target in part.targets} | ({"bench_worker_native"} if whole else set())))
    found, own = about(options.quick), {}
    note = folder / "about.json"
    if whole:
        for file in folder.iterdir():
            file.unlink()
    elif note.exists():  # parts again, of a run of the same day and machine, maybe at another revision
        before = json.loads(note.read_text(encoding="utf-8"))
        if all(before[key] == found[key] for key in ("command", "date", "machine")):
            own = {"revision": found["revision"]} if found["revision"] != before["revision"] else {}
            found = before
    start = time.monotonic()
    failed = []
    for number, part in enumerate(parts, 1):
        print(f"[{number}/{len(parts)}, {time.monotonic() - start:.0f} s] {part.name}", flush=True)
        found["parts"][part.name] = run(part, folder, options.quick) | own
        if found["parts"][part.name]["status"]:
            failed.append(part.name)
        note.write_text(json.dumps(found, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    if whole and not any(entry["status"] not in (0, 1) for entry in found["parts"].values()):
        publish(folder)
        folder = RESULTS
    print(f"{len(parts)} parts in {time.monotonic() - start:.0f} s; results in {folder}")
    print(*(f"not as it should be: {name}" for name in failed), sep="\n", end="\n" if failed else "")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
