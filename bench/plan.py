# SPDX-License-Identifier: MPL-2.0
"""Which chains bench/heights.py measures. Methods are not listed here: the workers say which they have."""

from dataclasses import dataclass

KINDS = {
    "A": "equal plummets",
    "B": "equal rods",
    "C": "random plummets",
    "R": "random rods",
    "D": "plummets, weights 1 … 1e12 upward",
    "E": "plummets, weights 1e12 … 1 upward (heavy tip)",
}
CLOSE = (0.0, 1e-14)  # tolerances; 0: none, to the last digit


@dataclass(frozen=True)
class Task:
    """The `modes` slowest heights of a chain (`modes` = `links`: all), by every method that can."""

    kind: str
    links: int
    modes: int
    tolerances: tuple[float, ...] = (0.0,)
    only: tuple[str, ...] = ()  # methods; empty: all

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
class Plan:
    tasks: tuple[Task, ...]
    rounds: int  # at most
    slice: float  # CPU seconds of one measurement, where a call is shorter
    budget: float  # CPU seconds after which a method is not called again in a task
    patience: float  # seconds after which a call is given up
    truths: int  # heights compared with the truth in a task


def tasks(sizes, small, drawn, many, drawn_at):
    """The ten slowest modes of chains of `sizes`; all modes of those of `small`, of `drawn` and of `many` links."""
    listed = [Task(kind, links, min(10, links)) for links in sizes for kind in "CR" if links > 10]
    listed += [Task(kind, links, min(10, links), only=("modes", "dstebz")) for links in sizes for kind in "ABDE"]
    listed += [Task(kind, links, links, CLOSE) for links in (*small, many) for kind in "CR"]
    return (*listed, *(Task(kind, drawn, drawn, drawn_at) for kind in "CR"))


SWEEP = (*CLOSE, 1e-12, 1e-10, 1e-8, 1e-6, 1e-4, 1e-2)
QUICK = Plan(tasks((10, 300), (2, 10), 100, 300, (*CLOSE, 1e-8, 1e-4)), rounds=3, slice=0.002, budget=0.15, patience=20,
             truths=40)
FULL = Plan(tasks((10, 100, 1000, 10_000, 100_000, 1_000_000), (2, 5, 10), 1000, 10_000, SWEEP), rounds=9, slice=0.02,
            budget=6, patience=300, truths=500)
