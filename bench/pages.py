#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Writes what the documentation quotes of bench/results, so that a new run leaves no page stale.

    python bench/pages.py            writes the tables between `<!-- results: NAME -->` and `<!-- end -->`, and the numbers
                                     of CLAIMS; prints each sentence of HOLDS that is no longer true, to be written anew
    python bench/pages.py --check    writes nothing; exit status 1 if something is not as the results are

Tables and numbers without results (before the first whole run) stay as they are, and are listed.
"""

import argparse
import csv
import functools
import json
import re
import sys
import textwrap
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
RESULTS = ROOT / "bench" / "results"
ULP = 2.0**-52


class Missing(Exception):
    """A result that is not there."""


class Results:
    """Rows by the name of their file; numbers are read where they are used."""

    def __init__(self, folder=RESULTS):
        self.folder, self.opened = folder, set()

    @functools.cache  # noqa: B019  # one object a run
    def __call__(self, name):
        path = self.folder / f"{name}.csv"
        if not path.exists():
            raise Missing(path.name)
        self.opened.add(path.name)
        with path.open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file))

    @functools.cached_property
    def about(self):
        path = self.folder / "about.json"
        if not path.exists():
            raise Missing(path.name)
        return json.loads(path.read_text(encoding="utf-8"))

    def rows(self, name, **wanted):
        return [row for row in self(name) if all(row[column] == str(value) for column, value in wanted.items())]

    def row(self, name, **wanted):
        found = self.rows(name, **wanted)
        if not found:
            raise Missing(f"{name}.csv: {wanted}")
        return found[0]

    def value(self, name, column, **wanted):
        return float(self.row(name, **wanted)[column])

    def said(self, part, pattern):
        """Groups of a pattern in what a program said of its results."""
        text = "\n".join(self.about["parts"].get(part, {}).get("said", []))
        found = re.search(pattern, text)
        if not found:
            raise Missing(f"about.json: {part}: {pattern}")
        return found.groups()


# ---- tables --------------------------------------------------------------------------------------------------------


def digits(x, number=2):
    """So many digits, no exponents between 1e-4 and 1e6, thousands separated."""
    x = float(f"{x:.{number}g}")
    if x != 0 and not 1e-4 <= abs(x) < 1e6:
        mantissa, exponent = f"{x:.{number - 1}e}".split("e")
        return f"{float(mantissa):g}e{int(exponent)}"
    return f"{x:,.0f}" if abs(x) >= 10 ** (number - 1) else f"{x:.{number}g}"


def ratio(x):
    return f"{x:.1f}" if x < 10 else f"{x:,.0f}"


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)])


def about(r):
    a = r.about
    m = a["machine"]
    caches = ", ".join(f"{name} {m[name]}" for name in ("L1d cache", "L2 cache", "L3 cache") if name in m)
    peers = ", ".join(f"{name} {number}" for name, number in a["versions"].items())
    vectors = "".join(f", {name}" for name in m["vectors"])
    again = {}
    for name, part in a["parts"].items():
        again.setdefault(part.get("revision", a["revision"]), []).append(name)
    but = "".join(f" ({', '.join(names)}: {it})" for it, names in again.items() if it != a["revision"])
    lines = (f"All results on this page are of one run of `{a['command']}` on {a['date']}, revision {a['revision']}{but}.",
             f"Processor: {m['processor']}, {m['cores']} cores{vectors} ({caches}). Compiler: {a['compiler']};",
             f"flags `{a['flags']['portable']}`, native build `{a['flags']['native']}`.", f"Versions: {peers}.")
    return "\n".join(line for each in lines for line in textwrap.wrap(each, 120, break_on_hyphens=False))


SIZES = (2, 8, 20, 100, 300, 1000, 3000)
JOBS = {
    "plummets, all modes with shapes": "plummets, all modes with shapes",
    "rods, all modes with shapes": "rods, the same",
    "random bodies, all modes with shapes": "random bodies, the same",
    "plummets, heights alone": "plummets, heights alone",
    "plummets, three slowest with shapes": "plummets, three slowest with shapes",
    "rigs with springs": "rigs with springs, all modes with shapes",
    "rigs with flywheels": "rigs with flywheels, the same",
}
SHAPES = [job for job in JOBS if job.endswith("all modes with shapes")]
WITH_SHAPES = [job for job in JOBS if "alone" not in job]
MILLION = ("ten slowest of a million, heights alone", "ten slowest of a million, with shapes")


def ordinary(r):
    rows = []
    for job, name in JOBS.items():
        cells = {int(row["N"]): f"{digits(float(row['revchain_us']))} ({ratio(float(row['ratio']))})"
                 for row in r.rows("ordinary", job=job)}
        if not cells:
            raise Missing(f"ordinary.csv: {job}")
        rows.append([name, *(cells.get(n, "") for n in SIZES)])
    heights, shapes = (r.row("ordinary", job=job) for job in MILLION)
    lines = [table(["job", f"N = {SIZES[0]}", *(f"{n}" for n in SIZES[1:])], rows), ""]
    ms = [f"{digits(float(row['revchain_us']) / 1e3)} ms ({ratio(float(row['ratio']))})" for row in (heights, shapes)]
    lines.append(f"The ten slowest modes of a million plummets take {ms[0]}, with shapes {ms[1]}.\n")
    errors = [[f"{n:,}", *(digits(max(float(row[who]) for job in SHAPES for row in r.rows("ordinary", job=job, N=n)) / ULP)
                           for who in ("error", "peer_error"))] for n in (2, 20, 100, 1000)]
    return "\n".join(lines) + "\n" + table(["links", "largest error of a height, ulp", "of the fastest peer"], errors)


@dataclass(frozen=True)
class Peer:
    kind: str
    links: int
    modes: int
    rtol: float
    peers: tuple[str, ...]
    name: str
    kind_of_peer: str = ""


FACTORED, DIRECT = "scipy eigsh, factored inverse", ("direct Newton", "direct, two points")
PEERS = (
    Peer("C", 10**6, 10, 0, ("dstebz", FACTORED, *DIRECT), "10 slowest of 1,000,000 plummets"),
    Peer("R", 10**6, 10, 0, (FACTORED, *DIRECT), "10 slowest of 1,000,000 rods"),
    Peer("C", 10_000, 10_000, 1e-14, ("dlasq1", "dsterf"), "all of 10,000 plummets, to 1e-14"),
    Peer("C", 10_000, 10_000, 0, ("dlasq1",), "all of 10,000 plummets, to the last digit"),
    Peer("R", 10_000, 10_000, 1e-14, ("dsbgv",), "all of 10,000 rods, to 1e-14"),
    Peer("C", 10, 10, 1e-14, ("dsterf",), "all of 10 plummets, to 1e-14"),
    Peer("R", 10, 10, 1e-14, ("dsbgv",), "all of 10 rods, to 1e-14"),
    Peer("C", 2, 2, 1e-14, ("dsterf",), "all of 2 plummets, to 1e-14"),
)


def measured(r, kind, links, modes, method, rtol=0.0, build="native"):
    build = "Python" if method.startswith("scipy") or method.endswith("Python") else build
    wanted = {"kind": kind, "links": links, "modes": modes, "method": method, "build": build, "rtol": rtol or ""}
    row = r.row("heights", **wanted)
    return float(row["cpu_seconds"]), float(row["error_ulp"])


def heights(r):
    rows = []
    for job in PEERS:
        ours, error = measured(r, job.kind, job.links, job.modes, "modes", job.rtol)
        for number, peer in enumerate(job.peers):
            try:
                theirs, its = measured(r, job.kind, job.links, job.modes, peer)
            except Missing:  # a peer that is not installed
                continue
            first = number == 0
            rows.append([job.name if first else "", digits(1e3 * ours) if first else "", digits(error) if first else "",
                         f"`{peer}`" if peer[0] == "d" and peer not in DIRECT else peer, ratio(theirs / ours), digits(its)])
    for kind in ("plummets", "rods"):
        row = r.row("batch", kind=kind, N=10)
        chains = int(row["chains"])
        rows.append([f"{chains:,} chains of 10 {kind}, one call", digits(float(row["us"]) * chains / 1e3),
                     digits(float(row["error_ulp"])), "`dsterf`" if kind == "plummets" else "`dsbgv`",
                     ratio(float(row["ratio"])), digits(float(row["lapack_error_ulp"]))])
    return table(["modes of random chains", "CPU ms", "error, ulp", "peer", "times its CPU time", "its error, ulp"], rows)


METHODS = ("modes", "dstebz", "scipy eigsh", "Spectra shift-invert", FACTORED, DIRECT[0])
AT = (100, 10_000, 1_000_000)


def formulations(r):
    rows = []
    for kind, what in (("C", "random plummets"), ("E", "heavy tip (kind E)")):
        for method in METHODS if kind == "C" else METHODS[:2]:
            cells = []
            for links in AT:
                try:
                    cells.append(digits(measured(r, kind, links, 10, method)[1] * ULP, 1))
                except Missing:
                    cells.append("")
            if any(cells):
                rows.append([f"{what}, {method}", *cells])
    return table(["largest relative error of ten slowest modes", *(f"N = {n:,}" for n in AT)], rows)


LISTS = {
    "plummets 8 at a/lambda 35.4025": "8 equal plummets at n = 5.95 sqrt(g/a)",
    "plummets 10 at a/lambda 50.0000": "10 equal plummets at a/λ = 50",
    "plummets 12 at a/lambda 166.000": "12 equal plummets at a/λ = 166",
    "rods 8 at a/lambda 166": "8 uniform rods at a/λ = 166",
    "plummets 1000 at lambda = L/10": "1000 plummets, ten conical heights long",
    "rods 1000 at lambda = L/10": "1000 rods, ten conical heights long",
    "any posture: plummets 4 at a/lambda 166": "4 plummets in any posture, a/λ = 166",
    "any posture: rods 4 at a/lambda 166": "4 rods in any posture, a/λ = 166",
    "120 plummets to 8 links at lambda >= 1e-3 L": "120 random chains of up to 8 plummets, λ from 1e-3 L: the slowest",
    "120 rods to 8 links at lambda >= 1e-3 L": "120 random chains of up to 8 rods, the same",
    "120 links of l > a to 4 links at lambda >= 1e-3 L": "120 of up to 4 links that can hang at three inclinations",
    "rods 100000 on branch 1 at twice the first speed": "one shape of 100,000 rods at twice the first critical speed",
}


def steady_shapes(r):
    rows = [r.row("steady-shapes", chain=chain) for chain in LISTS]
    return table(["chain", "shapes", "ms"], [[name, f"{int(row['shapes']):,}", digits(float(row["milliseconds"]))]
                                             for name, row in zip(LISTS.values(), rows, strict=True)])


def random_shapes(r):
    def cell(chain):
        row = r.row("steady-shapes", chain=chain)
        return f"{digits(float(row['milliseconds']))} ({row['shapes']})"

    rows = []
    for n in (2, 3, 4, 6, 8, 10, 12):
        share = 50 if n > 6 else 200
        kinds = ("plummets", "rods")
        lists = [cell(f"random {kind} {n} at lambda = L/{at}") for at in (100, 1000) for kind in kinds]
        rows.append([str(n), *lists, *(cell(f"branches: random {kind} {n} to L/{share}") for kind in kinds)])
    return table(["N", "plummets, λ = L/100, ms", "rods", "plummets, λ = L/1000", "rods",
                  "branches to L/200 (N > 6: L/50), plummets", "rods"], rows)


def diagrams(r):
    names = {"plummets 8 to n = 5 sqrt(g/a)": "8 equal plummets to 5 sqrt(g/a)"}
    names |= {f"rods 20 of {length} m to 20 rad/s": f"20 rods, {length} m in all, to 20 rad/s" for length in (1, 2)}
    rows = [r.row("steady-shapes", chain=f"branches: {name}") for name in names]
    return table(["diagram", "branches", "ms"], [[name, f"{int(row['shapes']):,}", digits(float(row["milliseconds"]))]
                                                 for name, row in zip(names.values(), rows, strict=True)])


def continuous(r):
    rows = [["`steady_shapes` of a `Cord`" if row["method"] == "revchain" else row["method"],
             digits(float(row["milliseconds"])), ", ".join(row[what] for what in ("right", "wrong", "missing")),
             digits(float(row["inclination_error"]), 1)] for row in r("continuous")]
    return table(["method", "ms", "right, wrong, missing", "error of inclinations"], rows)


def threads(r):
    rows = [[row["question"].replace("lambda", "λ"), digits(float(row["ms by one thread"])), digits(float(row["ms by 2"])),
             f"{float(row['ratio']):.1f}"] for row in r("threads")]
    return table(["question", "ms, one thread", "ms, two", "ratio"], rows)


UNITS = {
    "chain.hpp": "`chain.hpp`", "revchain.hpp": "`revchain.hpp` alone", "modes of ten links": "`modes`, ten links",
    "modes by all methods": "`modes`, ten links, all methods", "README program": "the program of the README",
    "steady_shapes": "`steady_shapes`, ten links", "branches": "`branches`", "response": "`response`",
    "stability": "`stability`",
}


def compile_times(r):
    rows = []
    for unit, name in UNITS.items():
        alone = r.row("compile-times", unit=unit, way="header-only")
        linked = r.row("compile-times", unit=unit, way="revchain::compiled")
        size = "-" if unit.endswith("hpp") else alone["program KB"]
        rows.append([name, alone["x Eigen/Dense"], size, linked["x Eigen/Dense"]])
    return table(["program", "header-only", "size, KB", "`revchain::compiled`"], rows)


def accuracy(r):
    sizes = list(dict.fromkeys(row["N"] for row in r("accuracy")))
    worst = [max(float(row["worst_error_ulp"]) for row in r.rows("accuracy", N=n)) for n in sizes]
    head = [f"{int(n):,}" + (" (10 slowest)" if int(n) > 3000 else "") for n in sizes]
    return table(["N", *head], [["worst error, ulp", *(f"{x:.2f}" for x in worst)]])


def random_systems(r):
    rows = [[row["kind"], f"{int(row['numbers']):,}", row["outside"],
             "-" if row["kind"].startswith("counts") else row["worst_error_over_bound"]] for row in r("random-systems")]
    return table(["kind", "numbers", "outside the bound", "worst error over bound"], rows)


TOLERANCES = (1e-2, 1e-6, 1e-12, 1e-15, 1e-20)


def time_text(us):
    number, unit = (us / 1e6, "s") if us >= 1e6 else (us / 1e3, "ms") if us >= 1e3 else (us, "µs")
    return f"{float(f'{number:.2g}'):g} {unit}"


def tradeoff(r):
    """The cheapest model that keeps a tolerance, and its time."""
    kinds = ("equal plummets", "equal rods", "random rods")
    chains = [(kind, links, "0") for kind in kinds for links in (5, 100, 1000, 100_000)]
    chains += [(kind, 100, "0.3") for kind in kinds[1:]]
    rows = []
    for kind, links, inclination in chains:
        asked = r.rows("tradeoff", scene=kind, links=links, modes=3, inclination=inclination)
        points = [row for row in asked if row["took_us"]]
        cells = [f"{links:,} {kind}" + (f", {inclination} rad" if inclination != "0" else "")]
        for rtol in TOLERANCES:
            good = [row for row in points if float(row["bound"]) <= rtol]
            best = min(good, key=lambda row: float(row["took_us"]), default=None)
            cells.append(f"{best['model']}, {time_text(float(best['took_us']))}" if best else "-")
        rows.append(cells)
    return table(["three slowest modes of", *(f"to {rtol:g}" for rtol in TOLERANCES)], rows)


def choices(r):
    pattern = r"(\d+) answers asked; (\d+) errors above their bound, (\d+) tolerances not kept"
    answers, above, broken = r.said("tradeoff", pattern)
    number, share = r.said("tradeoff", r"(\d+) choices, \d+ \(([\d.]+) %\)")
    predicted, off = r.said("models", r"(\d+) of (\d+) predictions beyond a factor of 3")[::-1]
    _, asked, percent, violated = r.said("choices", r"(\d+) of (\d+) \(([\d.]+) %\) .* cheapest; (\d+) bounds violated")
    return table(["program", "measured", "result"], [
        ["`bench_tradeoff`", f"{int(answers):,} answers", f"{above} errors above their bound, {broken} tolerances not met"],
        ["", f"{int(number):,} choices", f"{share} % within a factor of 2 of the cheapest"],
        ["`bench_models`", f"{int(predicted):,} predicted times", f"{off} wrong by more than a factor of 3"],
        ["`bench_models choice 1000`", f"{int(asked):,} choices for random questions",
         f"{percent} % within a factor of 2 of the cheapest; {violated} bounds violated"]])


def studies(r):
    rows = []
    for varied, name in (("two", "two masses on a grid"), ("all", "all masses and a length, random")):
        for links in (2, 10):
            memory, chunks = (r.row("studies", varied=varied, links=links, work=work) for work in ("memory", "chunks"))
            rows.append([name if links == 2 else "", str(links), digits(float(memory["bare_cpu_s"])),
                         *(f"{float(row['cpu_share']):.1f}" for row in (memory, chunks))])
    return table(["varied", "links", "direct call, s", "share, in memory", "share, every chunk saved to disk"], rows)


def study_points(r):
    return table(["one chain of rods, ten modes with bounds", "CPU time of a point, ms"],
                 [[f"{row['links']} links", digits(float(row["cpu_us"]) / 1e3)] for row in r("study-points")])


BLOCKS = {
    "docs/benchmarks.md": {"about": about, "ordinary": ordinary, "heights": heights, "formulations": formulations,
                           "steady-shapes": steady_shapes, "random-shapes": random_shapes, "diagrams": diagrams,
                           "continuous": continuous, "threads": threads, "compile-times": compile_times},
    "docs/accuracy.md": {"accuracy": accuracy, "random-systems": random_systems},
    "docs/models.md": {"tradeoff": tradeoff, "choices": choices},
    "docs/studies.md": {"studies": studies, "study-points": study_points},
}

# ---- sentences -----------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Claim:
    """A number in a sentence: the group of the pattern is written anew."""

    page: str
    pattern: str  # a space stands for any space, and for the start of a comment's next line
    value: Callable[[Results], str]


@dataclass(frozen=True)
class Holds:
    """A sentence that is true of the results as long as the condition is."""

    page: str
    text: str
    condition: Callable[[Results], bool]


def ratios(r, jobs, sizes):
    """The ratios to the fastest peer. The plan may leave out sizes above 300, where a peer takes minutes."""
    measured = [(job, n) for job in jobs for n in sizes if n <= 300 or r.rows("ordinary", job=job, N=n)]
    return [r.value("ordinary", "ratio", job=job, N=n) for job, n in measured]


def near(value, *stated, factor=1.5):
    return min(stated) / factor <= value <= max(stated) * factor


def compiled_faster(r):
    alone, linked = (r.value("compile-times", "CPU s", unit="README program", way=way)
                     for way in ("header-only", "revchain::compiled"))
    return f"{alone / linked:.0f}"


def elliptic_lost(r):
    """Whether GSL has no digit of a function where the complementary modulus is at most 1e-8, and this library has all."""
    small = [row for row in r("elliptic") if float(row["complementary_modulus"]) <= 1e-8]
    ours = max(float(row["error"]) for row in r("elliptic"))
    return max(float(row["gsl_error"] or 0) for row in small) >= 1 and ours < 1e-14


CLAIMS = (
    Claim("README.md", r"relative errors reach (\S+) at 1000 links",
          lambda r: digits(max(r.value("ordinary", "peer_error", job=job, N=1000) for job in SHAPES), 1)),
    Claim("README.md", r"`revchain::compiled` compiles this program (\d+) times faster",
          compiled_faster),
)
HOLDS = (
    Holds("README.md", "With 20 or more links it finds modes with their shapes faster than NumPy and SciPy",
          lambda r: min(ratios(r, WITH_SHAPES, SIZES[2:])) >= 1),
    Holds("docs/index.md", "faster than NumPy and SciPy for 20 or more links, mode shapes included",
          lambda r: min(ratios(r, WITH_SHAPES, SIZES[2:])) >= 1),
    Holds("docs/index.md", "more than 50 times as fast as SciPy for the ten slowest modes of a million links",
          lambda r: r.value("ordinary", "ratio", job=MILLION[0]) >= 50),
    Holds("docs/benchmarks.md", "The error of every mode compared is at most 0.5 ulp",
          lambda r: max(float(row["error_ulp"]) for row in r.rows("heights", method="modes", rtol="")) <= 0.505),
    Holds("docs/benchmarks.md", "The portable build takes at most 1.5 times as long as the native one", lambda r: max(
        measured(r, kind, links, modes, "modes", build="portable")[0] / measured(r, kind, links, modes, "modes")[0]
        for kind in "CR" for links, modes in ((10**6, 10), (10_000, 10_000))) <= 1.5),
    Holds("docs/benchmarks.md", "Every list and every diagram is proved complete",
          lambda r: all(row["complete"] in ("yes", "") for row in r("steady-shapes"))),
    Holds("docs/benchmarks.md", "proved bound of at most 4.4e-16",
          lambda r: max(float(row["worst_bound"] or 0) for row in r("steady-shapes")) <= 4.45e-16),
    Holds("docs/accuracy.md", "Every reported bound is at most 2 ulp",
          lambda r: max(float(row["worst_bound_ulp"]) for row in r("accuracy")) <= 2),
    Holds("docs/accuracy.md", "of which GSL loses everything below κ' = 1e-8", elliptic_lost),
    Holds("docs/models.md", "The choice takes less than a microsecond in C++, and about two for a hundred unequal links",
          lambda r: r.about["parts"]["select"]["status"] == 0),
    Holds("docs/theory/convergence.md", "the order is 1.000 with plummets at the lower ends. It is 2.00 with",
          lambda r: all(abs(r.value("shape-convergence", "order", cutting=cutting, half_waves=1, links=5120) - order) < 0.005
                        for cutting, order in (("lower pins", 1), ("l = 3a/4", 2), ("cell centres", 2)))),
    Holds("docs/theory/convergence.md", "have an order of 1.90 to 1.95 at 5120 links", lambda r: all(
        1.895 <= float(row["order"]) <= 1.955 for row in r.rows("shape-convergence", links=5120)
        if row["cutting"] in ("rods", "l = a", "l = a/2", "l = 5a/6"))),
    Holds("docs/models.md", "It fails if a prediction is wrong by more than a factor of 3",
          lambda r: r.said("models", r"(\d+) of \d+ predictions")[0] == "0"),
    Holds("include/revchain/finite/cord/continuous_chain.hpp", "length/height 500 take 1.8 ms (bench/continuous.cpp)",
          lambda r: near(r.value("continuous", "milliseconds", method="revchain"), 1.8)),
    Holds("include/revchain/models/finite_amplitude.hpp",
          "Cost: 4 to 10 microseconds a link and mode (bench_tradeoff: 5 to 1000 links)",
          lambda r: all(4 <= float(row["took_us"]) / int(row["links"]) / int(row["modes"]) <= 10
                        for row in r.rows("tradeoff", model="finite amplitude")
                        if row["took_us"] and int(row["links"]) > 2)),
)


def written(text, name, made):
    """The page with the block anew."""
    pattern = re.compile(rf"(<!-- results: {re.escape(name)} -->\n).*?(<!-- end -->)", re.DOTALL)
    if not pattern.search(text):
        raise SystemExit(f"no block {name}")
    return pattern.sub(lambda found: f"{found[1]}{made}\n{found[2]}", text)


def spaced(pattern):
    return pattern.replace(" ", r"\s+(?:///?\s+)?")


def pages(r):
    """(page, text as it should be), complaints, and what has no results."""
    texts, complaints, missing = {}, [], []

    def text_of(page):
        return texts.setdefault(page, (ROOT / page).read_text(encoding="utf-8"))

    for page, blocks in BLOCKS.items():
        for name, make in blocks.items():
            try:
                texts[page] = written(text_of(page), name, make(r))
            except Missing as why:
                missing.append(f"{page}, {name}: {why}")
    for claim in CLAIMS:
        found = re.search(spaced(claim.pattern), text_of(claim.page))
        try:
            value = claim.value(r)
        except Missing as why:
            missing.append(f"{claim.page}, {claim.pattern}: {why}")
            continue
        if not found:
            complaints.append(f"{claim.page}: no sentence {claim.pattern!r}")
            continue
        text = text_of(claim.page)
        texts[claim.page] = text[: found.start(1)] + value + text[found.end(1) :]
    for sentence in HOLDS:
        if not re.search(spaced(re.escape(sentence.text).replace(r"\ ", " ")), text_of(sentence.page)):
            complaints.append(f"{sentence.page}: no sentence {sentence.text!r}")
        try:
            if not sentence.condition(r):
                complaints.append(f"{sentence.page}: no longer true: {sentence.text}")
        except Missing as why:
            missing.append(f"{sentence.page}, {sentence.text}: {why}")
    return texts, complaints, missing


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; 1: something is stale")
    options = parser.parse_args()
    texts, complaints, missing = pages(Results())
    for page, text in texts.items():
        if (ROOT / page).read_text(encoding="utf-8") != text:
            if options.check:
                complaints.append(f"{page}: not as bench/pages.py writes it")
            else:
                (ROOT / page).write_text(text, encoding="utf-8")
                print(f"wrote {page}")
    print(*(f"no results: {why}" for why in missing), *complaints, sep="\n")
    return 1 if complaints else 0


if __name__ == "__main__":
    sys.exit(main())
