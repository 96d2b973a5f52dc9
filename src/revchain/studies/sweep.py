# SPDX-License-Identifier: GPL-3.0-or-later
"""Computation of all points of a study by threads or any executor, in chunks that are stored on disk."""

from __future__ import annotations

import os
import time
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from typing import Any

import numpy as np

from .. import _core
from ..systems.extras import require
from ..systems.numbers import count as checked_count
from ..systems.numbers import shown
from .axes import BLOCK
from .plan import Plan, Stretch
from .points import Arrays
from .result import Made, SweepResult, stamp
from .store import Store, checked_ending
from .study import Study, load_study

_PLACE = "revchain.sweep"
_FEWEST, _MOST = 16, 8192  # limits of the points of a chunk that are solved one by one
_MOST_IN_BATCHES = 2**17
_NUMBERS = 2**20  # numbers of a chunk that is solved in batches
_SECONDS = 0.5  # time for a chunk, or a hundredth of the time so far: this gives hundreds of files, not millions
_IN_FLIGHT = 3  # chunks for each worker

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
    """Compute all points of a study and return their results.

    Parameters
    ----------
    study : Study, path-like or dict
        The study, its file, or its data.
    out : path-like, optional
        File for the results, for other programs: ``.csv``, ``.parquet`` or ``.nc`` (netCDF). It is written when all
        points are done. Until then finished chunks are stored in the folder ``OUT.partial`` beside it. After an
        interruption or a kill, the same call continues without recomputing finished chunks. (To store the result for
        `revchain.load`, use `SweepResult.save`.)
    executor : concurrent.futures.Executor, optional
        Executor for the chunks, such as a ``ProcessPoolExecutor``, or ``client.get_executor()`` of a Dask cluster; threads
        if left out. It is not shut down.
    threads : int, optional
        Number of threads, if there is no `executor`; one for each processor if left out.
    chunk : int, optional
        Number of points that are computed and stored together; about half a second of work if left out.
    progress : callable, optional
        Function that is called repeatedly with the number of finished points and the number of all points.

    Returns
    -------
    SweepResult
        The results. They are bitwise equal for any executor, number of threads and chunk.

    Raises
    ------
    SceneError
        If the study is not valid.
    OSError
        If `out` cannot be written, another run is writing it, or its partial folder has points of another study (the error
        is also a ValueError). Finished chunks stay.
    ValueError
        If `out` has another extension, `threads` is given with `executor`, or a number is below 1.
    ImportError
        If a package that writes `out` is missing; the message says how to install it.

    Notes
    -----
    Plain chains of up to 100 links whose weights, lengths, centroids and radii vary go to `revchain.conical_heights` in
    batches, also with an `rtol` that it meets. Other points are solved one by one, in C++ unless the system is held at
    both ends or a method or precision is given. A point that its scene refuses has the status ``refused`` and no numbers.
    Cost: that of the functions `modes`, `steady_shapes` and `response`.

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
        memory = _Memory(plan)
        _Run(plan, memory, chunk, progress).anywhere(executor, workers)
        return SweepResult._of(Made(study, plan), _arrays=memory.arrays)
    checked_ending(out)
    with Store(out, plan) as store:
        resumed = store.finished
        _Run(plan, store, chunk, progress).anywhere(executor, workers)
        store.join(study)
    return SweepResult._of(Made(study, plan, store.output, stamp(store.output)), resumed=resumed)


class _Memory:
    """The store of chunks in memory, without a file."""

    def __init__(self, plan: Plan) -> None:
        self.arrays: Arrays = {block.name: block.memory(plan.points) for block in plan.stored}
        self.arrays["status"] = np.empty(plan.points, np.uint8)
        self.kept: list[tuple[int, int]] = []
        self.finished = 0

    def place(self, start: int, stop: int) -> Arrays:
        """The part of the arrays for a chunk."""
        return {name: array[start:stop] for name, array in self.arrays.items() if name != "status"}

    def take(self, stretch: Stretch) -> None:
        for name, place in self.place(stretch.start, stretch.stop).items():
            if (array := stretch.arrays[name]).base is not place.base:
                place[...] = array
        self.arrays["status"][stretch.start : stretch.stop] = stretch.status
        self.finished += stretch.stop - stretch.start


class _Run:
    """The run of a study: the missing chunks and their computation."""

    def __init__(self, plan: Plan, kept_in: _Memory | Store, chunk: int | None, told: Told | None) -> None:
        self.plan = plan
        self.kept_in = kept_in
        self.told = told
        self.began = time.perf_counter()
        self.fixed = chunk is not None
        self.unit = plan.batch if plan.batched and chunk is None else 1
        self.most = min(max(_NUMBERS // plan.numbers, self.unit), _MOST_IN_BATCHES) if plan.batched else _MOST
        self.chunk = chunk or (self.unit if plan.batched else _FEWEST)

    def anywhere(self, executor: Executor | None, workers: int) -> None:
        """Compute each missing chunk by the executor or by our own threads."""
        if executor is not None:
            self._all(executor, _workers_of(executor))
        elif self.kept_in.finished < self.plan.points:
            pool, progress = ThreadPoolExecutor(workers, thread_name_prefix="revchain-sweep"), _core.Progress()
            try:
                self._all(pool, workers, progress)
            except BaseException:
                progress.cancel()
                raise
            finally:
                pool.shutdown(wait=True, cancel_futures=True)

    def _all(self, executor: Executor, workers: int, progress: _core.Progress | None = None) -> None:
        """Compute a few chunks at a time, so that few finished ones wait to be stored."""
        left = self._chunks()
        pending: set[Future[Stretch]] = set()
        try:
            self._tell()
            while True:
                while len(pending) < _IN_FLIGHT * workers and (ends := next(left, None)) is not None:
                    more = () if progress is None else (progress, self.kept_in.place(*ends))
                    pending.add(executor.submit(_found, self.plan, *ends, *more))
                if not pending:
                    return
                done, pending = wait(pending, return_when=FIRST_COMPLETED)
                for future in done:
                    self._take(future.result())
        finally:
            for future in pending:
                future.cancel()

    def _chunks(self) -> Iterator[tuple[int, int]]:
        """The ends of the missing chunks, between the stored ones."""
        there = 0
        for start, stop in [*sorted(self.kept_in.kept), (self.plan.points, self.plan.points)]:
            while there < start:
                end = there + self.chunk
                if not self.fixed and end // BLOCK > there // BLOCK:
                    end -= end % BLOCK  # a chunk that starts inside a block would draw the numbers before it in vain
                yield there, min(end, start)
                there = min(end, start)
            there = stop

    def _take(self, stretch: Stretch) -> None:
        self.kept_in.take(stretch)
        if not self.fixed:
            rate = (stretch.stop - stretch.start) / max(stretch.seconds, 1e-9)
            seconds = max(_SECONDS, (time.perf_counter() - self.began) / 100)
            most = min(rate * seconds, 4 * self.chunk, self.most)
            self.chunk = max(int(most) // self.unit, 1) * self.unit
        self._tell()

    def _tell(self) -> None:
        if self.told is not None:
            self.told(self.kept_in.finished, self.plan.points)


def _found(plan: Plan, start: int, stop: int, *more: Any) -> Stretch:
    """The work of a worker: a stretch of points."""
    return plan.found(start, stop, *more)


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


def _workers_of(executor: Executor) -> int:
    """Number of workers of an executor, if it tells."""
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
