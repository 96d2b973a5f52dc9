# SPDX-License-Identifier: GPL-3.0-or-later
"""Computing all points of a study: in threads, or by any executor, in stretches that are kept on disk."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import closing
from functools import partial
from threading import Event
from typing import Any

import numpy as np

from ..systems.extras import require
from ..systems.numbers import count as checked_count
from ..systems.numbers import shown
from .axes import BLOCK
from .find import Arrays
from .journal import Journal
from .keep import Keeper
from .output import writer_of
from .plan import Plan, Stretch
from .result import SweepResult
from .study import Study, load_study

_PLACE = "revchain.sweep"
_FEWEST, _MOST = 16, 8192  # points of a stretch, one by one
_MOST_IN_BATCHES = 2**17
_NUMBERS = 2**20  # of a stretch in batches
_SECONDS = 0.5  # that such a stretch is to take
_IN_FLIGHT = 3  # stretches for each worker

Told = Callable[[int, int], None]


def sweep(
    study: Study | str | os.PathLike[str] | dict[str, Any],
    *,
    out: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    threads: int | None = None,
    chunk: int | None = None,
    progress: Told | None = None,
) -> SweepResult:
    """Compute all points of a study.

    Parameters
    ----------
    study : Study, path-like or dict
        What to compute, or its file, or its data.
    out : path-like, optional
        A file for the results, whole or not there: ``.csv``, ``.parquet`` or ``.nc`` (netCDF). Finished points are
        kept in the folder ``OUT.partial`` beside it until then: the same call goes on where another was ended,
        even by a kill, and computes no finished point again.
    executor : concurrent.futures.Executor, optional
        What computes: a ``ProcessPoolExecutor``, or ``client.get_executor()`` of a Dask cluster. Threads if left out.
        It is not shut down.
    threads : int, optional
        How many threads, without `executor`; one for each processor if left out.
    chunk : int, optional
        How many points are computed, and kept, together; about half a second's work if left out.
    progress : callable, optional
        Called with the points finished and all of them, again and again.

    Returns
    -------
    SweepResult
        The same to the last bit whatever the executor, the threads and the chunk.

    Raises
    ------
    SceneError
        If the study is wrong.
    OSError
        If `out` cannot be written, or its partial folder holds points of another study.
    ValueError
        For another ending of `out`, `threads` beside `executor`, or numbers below 1.
    ImportError
        If a package that writes `out` is missing; the message says how to install it.

    Notes
    -----
    Plain chains of up to 100 links whose weights, lengths, centroids and radii vary go to
    `revchain.conical_heights` in batches; other points are solved one by one, as by the methods of `Scene`.
    A point that its scene refuses has status ``refused`` and no numbers.

    Examples
    --------
    >>> import revchain as rc
    >>> found = rc.sweep({
    ...     "scene": {"links": [{"mass": 1.0, "length": 0.5, "kind": "rod"}], "support": {"stiffness": 50.0}},
    ...     "vary": {"support.stiffness": {"from": "10 N/m", "to": "1 kN/m", "steps": 3, "log": True}},
    ... })
    >>> found["forward_angular_speed"][:, 0].round(4)
    array([2.8026, 4.8815, 5.3647])
    """
    if isinstance(study, dict):
        study = Study.from_dict(study)
    elif not isinstance(study, Study):
        study = load_study(study)
    if executor is not None and threads is not None:
        raise ValueError(f"{_PLACE}: threads does not go with executor, which has its own")
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise TypeError(f"{_PLACE}: executor must be a concurrent.futures.Executor, got {shown(executor)}")
    if progress is not None and not callable(progress):
        raise TypeError(f"{_PLACE}: progress must be a function of two numbers, got {shown(progress)}")
    chunk = None if chunk is None else checked_count(_PLACE, "chunk", chunk)
    workers = _processors() if threads is None else checked_count(_PLACE, "threads", threads)
    plan = study._plan("study")
    if out is None:
        memory = {block.name: block.memory(plan.points) for block in plan.stored}
        result = SweepResult._of(study, plan, {**memory, "status": np.empty(plan.points, np.uint8)})
        _Run(plan, _Memory(result), chunk, progress).anywhere(executor, workers)
        return result
    writer = writer_of(out)
    with Journal(out, plan) as journal:
        stored = journal.map()
        result = SweepResult._of(study, plan, stored)
        result._resumed = sum(stop - start for start, stop in journal.kept)
        result._damage = journal.damage
        with closing(Keeper(journal, partial(writer, journal.aside, study, plan), stored)) as keeper:
            _Run(plan, keeper, chunk, progress).anywhere(executor, workers)
        journal.finish()
    return result


class _Memory:
    """Where stretches go without a file."""

    def __init__(self, result: SweepResult) -> None:
        self._result = result
        self.kept: list[tuple[int, int]] = []
        self.finished = 0

    def place(self, start: int, stop: int) -> Arrays:
        """Where a stretch of points belongs."""
        return {name: array[start:stop] for name, array in self._result._arrays.items()}

    def take(self, stretch: Stretch) -> None:
        for name, place in self.place(stretch.start, stretch.stop).items():
            if (array := stretch.arrays[name]).base is not place.base:
                place[...] = array
        self._result._status[stretch.start : stretch.stop] = stretch.status
        self.finished += stretch.stop - stretch.start

    def finish(self) -> None:
        """Everything is where it belongs."""


class _Run:
    """What is to be done, and by whom."""

    def __init__(self, plan: Plan, kept_in: _Memory | Keeper, chunk: int | None, told: Told | None) -> None:
        self.plan = plan
        self.kept_in = kept_in
        self.told = told
        self.missing = _missing(kept_in.kept, plan.points)
        self.fixed = chunk is not None
        self.unit = plan.batch if plan.batched and chunk is None else 1
        self.most = min(max(_NUMBERS // plan.numbers, self.unit), _MOST_IN_BATCHES) if plan.batched else _MOST
        self.chunk = chunk or (self.unit if plan.batched else _FEWEST)
        self.stopped = Event()

    def anywhere(self, executor: Executor | None, workers: int) -> None:
        """Every stretch that is missing."""
        if executor is not None:
            self._all(executor, _workers_of(executor))
        elif self.missing:
            self._in_threads(workers)
        self.kept_in.finish()
        self._tell()

    def _in_threads(self, workers: int) -> None:
        """With threads of our own; they end with the stretch at hand when interrupted."""
        pool = ThreadPoolExecutor(workers, thread_name_prefix="revchain-sweep")
        try:
            self._all(pool, workers, own=True)
        except BaseException:
            self.stopped.set()
            raise
        finally:
            pool.shutdown(wait=True, cancel_futures=True)

    def _all(self, executor: Executor, workers: int, own: bool = False) -> None:
        """A few stretches at a time, so that little waits to be kept."""
        left = self._stretches()
        pending: set[Future[Stretch]] = set()
        try:
            self._tell()
            while True:
                while len(pending) < _IN_FLIGHT * workers and (ends := next(left, None)) is not None:
                    more = (self.stopped.is_set, self.kept_in.place(*ends)) if own else ()
                    pending.add(executor.submit(_found, self.plan, *ends, *more))
                if not pending:
                    return
                done, pending = wait(pending, return_when=FIRST_COMPLETED)
                for future in done:
                    self._take(future.result())
        finally:
            for future in pending:
                future.cancel()

    def _stretches(self) -> Iterator[tuple[int, int]]:
        for start, stop in self.missing:
            while start < stop:
                end = start + self.chunk
                if not self.fixed and end // BLOCK > start // BLOCK:
                    end -= end % BLOCK  # a stretch that begins inside a block draws the numbers before it in vain
                end = min(end, stop)
                yield start, end
                start = end

    def _take(self, stretch: Stretch) -> None:
        self.kept_in.take(stretch)
        if not self.fixed:
            rate = (stretch.stop - stretch.start) / max(stretch.seconds, 1e-9)
            most = min(rate * _SECONDS, 4 * self.chunk, self.most)
            self.chunk = max(int(most) // self.unit, 1) * self.unit
        self._tell()

    def _tell(self) -> None:
        if self.told is not None:
            self.told(self.kept_in.finished, self.plan.points)


def _missing(kept: list[tuple[int, int]], points: int) -> list[tuple[int, int]]:
    """The stretches between those that are there, which come in order."""
    missing, end = [], 0
    for start, stop in [*kept, (points, points)]:
        if start > end:
            missing.append((end, start))
        end = stop
    return missing


def _found(plan: Plan, start: int, stop: int, *more: Any) -> Stretch:
    """What a worker does."""
    return plan.found(start, stop, *more)


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _workers_of(executor: Executor) -> int:
    """How many it has, as far as it tells."""
    client = getattr(executor, "_client", None)
    if client is not None and hasattr(client, "ncores"):
        return max(int(sum(client.ncores().values())), 1)
    return int(getattr(executor, "_max_workers", 0)) or _processors()


def dask_client(address: str, workers: int | None = None) -> Any:
    """A client of the Dask cluster at an address; ``local`` starts one of processes on this machine."""
    distributed = require("distributed", "sweep", "--dask")
    if address != "local":
        return distributed.Client(address, timeout=10)
    cluster = distributed.LocalCluster(n_workers=workers or _processors(), threads_per_worker=1, dashboard_address=None)
    return distributed.Client(cluster)
