# SPDX-License-Identifier: GPL-3.0-or-later
"""Computing all points of a study: in threads, or by any executor, in chunks that are kept on disk."""

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
_FEWEST, _MOST = 16, 8192  # points of a chunk, one by one
_MOST_IN_BATCHES = 2**17
_NUMBERS = 2**20  # of a chunk in batches
_SECONDS = 0.5  # that a chunk is to take, or a hundredth of the time spent so far: hundreds of files, not millions
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
    """Compute all points of a study.

    Parameters
    ----------
    study : Study, path-like or dict
        The study, or its file, or its data.
    out : path-like, optional
        A file for the results: ``.csv``, ``.parquet`` or ``.nc`` (netCDF). Finished chunks are kept in the folder
        ``OUT.partial`` beside it until all are there: the same call goes on where another was ended, even by a kill,
        and computes no finished chunk again. The output appears when it is whole. It is for other programs:
        `SweepResult.save` writes what `revchain.load` reads.
    executor : concurrent.futures.Executor, optional
        What computes: a ``ProcessPoolExecutor``, or ``client.get_executor()`` of a Dask cluster. Threads if left out.
        It is not shut down.
    threads : int, optional
        Number of threads, without `executor`; one for each processor if left out.
    chunk : int, optional
        How many points are computed, and kept, together; about half a second's work if left out.
    progress : callable, optional
        Called with the number of points finished and of all points, again and again.

    Returns
    -------
    SweepResult
        The same to the last bit whatever the executor, the threads and the chunk.

    Raises
    ------
    SceneError
        If the study is wrong.
    OSError
        (a ValueError too) If `out` cannot be written, another run is writing it, or its partial folder holds points of
        another study. Chunks that are finished stay.
    ValueError
        For another ending of `out`, `threads` beside `executor`, or numbers below 1.
    ImportError
        If a package that writes `out` is missing; the message says how to install it.

    Notes
    -----
    Plain chains of up to 100 links whose weights, lengths, centroids and radii vary go to `revchain.conical_heights` in
    batches, also with a tolerance `rtol` that those keep. Other points are solved one by one, in C++ unless both ends
    are held or a method or precision is asked for. A point that its scene refuses has status ``refused`` and no
    numbers.

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
    """Where chunks go without a file."""

    def __init__(self, plan: Plan) -> None:
        self.arrays: Arrays = {block.name: block.memory(plan.points) for block in plan.stored}
        self.arrays["status"] = np.empty(plan.points, np.uint8)
        self.kept: list[tuple[int, int]] = []
        self.finished = 0

    def place(self, start: int, stop: int) -> Arrays:
        """Where a chunk belongs."""
        return {name: array[start:stop] for name, array in self.arrays.items() if name != "status"}

    def take(self, stretch: Stretch) -> None:
        for name, place in self.place(stretch.start, stretch.stop).items():
            if (array := stretch.arrays[name]).base is not place.base:
                place[...] = array
        self.arrays["status"][stretch.start : stretch.stop] = stretch.status
        self.finished += stretch.stop - stretch.start


class _Run:
    """The chunks that are missing, and who computes them."""

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
        """Every chunk that is missing, by the executor or threads of our own."""
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
        """A few chunks at a time, so that little waits to be kept."""
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
        """Their ends, between the chunks that are there."""
        there = 0
        for start, stop in [*sorted(self.kept_in.kept), (self.plan.points, self.plan.points)]:
            while there < start:
                end = there + self.chunk
                if not self.fixed and end // BLOCK > there // BLOCK:
                    end -= end % BLOCK  # a chunk that begins inside a block draws the numbers before it in vain
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
