# SPDX-License-Identifier: MPL-2.0
"""What is measured, and what is wanted of it. Methods are not listed here: the workers say which they have."""

from dataclasses import dataclass
from math import log10

KINDS = {
    "A": "equal plummets",
    "B": "equal rods",
    "C": "random plummets",
    "R": "random rods",
    "D": "plummets, weights 1 … 1e12 upward",
    "E": "plummets, weights 1e12 … 1 upward (heavy tip)",
}


@dataclass(frozen=True)
class Task:
    """The `modes` slowest heights of a chain (`modes` = `links`: all), by every method that can."""

    kind: str
    links: int
    modes: int

    @property
    def all(self):
        return self.modes == self.links

    @property
    def floor(self):
        """Cycles for each link (and mode, where all are asked) below which the work cannot have been done.

        Few modes: every weight has to be read, summed and divided by once: 8 lanes of AVX-512 divide in no less than 4
        cycles on any processor of today. All modes: one evaluation costs two multiply-adds a link and mode, of which no
        core does more than 16 in a cycle; the other methods do more.
        """
        return 0.1 if self.all and self.links > 10 else 0.5

    def cycles(self, seconds, ns_per_cycle):
        work = self.links * (self.modes if self.all and self.links > 10 else 1)
        return seconds * 1e9 / ns_per_cycle / work

    def __str__(self):
        which = "all modes" if self.all else f"{self.modes} slowest modes"
        return f"{which} of {self.links:,} {KINDS[self.kind]}"


@dataclass(frozen=True)
class Target:
    """`ours` is to be `ratio` times faster than `baseline` (None: no target, shown for comparison)."""

    task: Task
    baseline: str
    ratio: float | None
    ours: str = "modes"
    baseline_kind: str = ""  # where the baseline can do another kind of chain only
    rtol: float = 0.0  # asked of `ours`; 0: none, to the last digit

    @property
    def baseline_task(self):
        return Task(self.baseline_kind or self.task.kind, self.task.links, self.task.modes)


@dataclass(frozen=True)
class Plan:
    name: str
    tasks: tuple[Task, ...]
    targets: tuple[Target, ...]
    tolerances: tuple[float, ...]  # 0: none asked
    rounds: int  # at most
    slice: float  # CPU seconds of one measurement, where a call is shorter
    # CPU seconds after which a method is not called again in a task; a quarter of it where no target is set
    budget: float
    patience: float  # seconds after which a call is given up
    truths: int  # heights compared with the truth in a task
    convergence: int  # largest N
    final: bool  # whether sizes are those of the targets


BATCH_RATIO = 10  # wanted of 1e5 chains of 10 links (bench_batch)


def few(links):
    return min(10, links)


def targets(slowest, all_modes):
    plummets, rods = Task("C", slowest, 10), Task("R", slowest, 10)
    result = [
        Target(plummets, "dstebz", 600),
        Target(plummets, "scipy eigsh, factored inverse", 1000),
        Target(plummets, "direct Newton", 12),
        Target(plummets, "direct, two points", None),
        Target(plummets, "Spectra shift-invert", None),
        Target(plummets, "scipy eigsh", None),
        Target(rods, "dstebz", 300, baseline_kind="C"),  # there is none for a pencil
        Target(rods, "scipy eigsh, factored inverse", 500),
        Target(rods, "direct Newton", 6),
        Target(rods, "direct, two points", None),
    ]
    # A proved 1e-14 (45 ulp) is far closer than these peers come; to the last digit it takes longer.
    for rtol, wanted in ((1e-14, (15, 10)), (0.0, (None, None))):
        result += [Target(Task("C", all_modes, all_modes), "dlasq1", wanted[0], rtol=rtol),
                   Target(Task("C", all_modes, all_modes), "dsterf", None, rtol=rtol),
                   Target(Task("R", all_modes, all_modes), "dsbgv", wanted[1], rtol=rtol)]
    for links in (2, 5, 10):
        for rtol, wanted in ((1e-14, 2), (0.0, None)):
            result += [Target(Task("C", links, links), "dsterf", wanted, rtol=rtol),
                       Target(Task("C", links, links), "dlasq1", None, rtol=rtol),
                       Target(Task("R", links, links), "dsbgv", wanted, rtol=rtol)]
    return tuple(result)


def tasks(sizes, all_sizes, wanted):
    listed = [Task(kind, links, few(links)) for links in sizes for kind in KINDS]
    listed += [Task(kind, links, links) for links in all_sizes for kind in "CR"]
    for target in wanted:
        listed += [target.task, target.baseline_task]
    return tuple(dict.fromkeys(listed))  # each once


def error_limit(links):
    """Wanted of every mode, in ulp (2^-52): 4, and one more for each decade beyond 1e4."""
    return 4 + max(0.0, log10(links / 1e4))


QUICK_TARGETS = targets(slowest=30_000, all_modes=300)
FULL_TARGETS = targets(slowest=1_000_000, all_modes=10_000)
QUICK = Plan("quick", tasks((10, 300), (), QUICK_TARGETS), QUICK_TARGETS, tolerances=(0.0, 1e-14, 1e-8, 1e-4), rounds=3,
             slice=0.002, budget=0.15, patience=20, truths=40, convergence=1000, final=False)
FULL = Plan("full", tasks((10, 100, 1000, 10_000, 100_000, 1_000_000), (100, 1000), FULL_TARGETS), FULL_TARGETS,
            tolerances=(0.0, 1e-14, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2), rounds=9,
            slice=0.02, budget=12, patience=900, truths=10_000, convergence=100_000, final=True)
