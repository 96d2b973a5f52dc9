# SPDX-License-Identifier: GPL-3.0-or-later
"""Computing all points of a study: in threads, or by any executor, in stretches that are kept on disk."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from threading import Event
from typing import Any

from ._arguments import count as checked_count
from ._extras import require
from ._study_journal import Journal
from ._study_plan import BATCH, Plan, Stretch
from ._sweep_output import writer_of
from ._sweep_result import SweepResult
from .study import Study, load_study

_PLACE = "revchain.sweep"
_FEWEST, _MOST = 16, 8192  # points of a stretch
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
    chunk = None if chunk is None else checked_count(_PLACE, "chunk", chunk)
    workers = _processors() if threads is None else checked_count(_PLACE, "threads", threads)
    plan = study._plan("study")
    result = SweepResult._empty(study, plan)
    if out is None:
        _compute(plan, result, None, executor, workers, chunk, progress)
        return result
    write = writer_of(out)
    with Journal(out, plan) as journal:
        for stretch in journal.stretches():
            result._take(stretch)
        result._resumed = result._finished
        _compute(plan, result, journal, executor, workers, chunk, progress)
        write(result, journal.aside)
        journal.finish()
    return result


def _compute(
    plan: Plan,
    result: SweepResult,
    journal: Journal | None,
    executor: Executor | None,
    workers: int,
    chunk: int | None,
    told: Told | None,
) -> None:
    run = _Run(plan, result, journal, chunk, told)
    if executor is not None:
        run.all(executor, _workers_of(executor))
    elif run.missing:
        run.in_threads(workers)


class _Run:
    """What is to be done, and what becomes of it."""

    def __init__(
        self, plan: Plan, result: SweepResult, journal: Journal | None, chunk: int | None, told: Told | None
    ) -> None:
        self.plan = plan
        self.result = result
        self.journal = journal
        self.told = told
        self.missing = result._missing()
        self.fixed = chunk is not None
        self.unit = BATCH if plan.batched and chunk is None else 1
        self.chunk = chunk or (4 * BATCH if plan.batched else _FEWEST)
        self.stopped = Event()

    def in_threads(self, workers: int) -> None:
        """With threads of our own; they end with the stretch at hand when interrupted."""
        pool = ThreadPoolExecutor(workers, thread_name_prefix="revchain-sweep")
        try:
            self.all(pool, workers, own=True)
        except BaseException:
            self.stopped.set()
            raise
        finally:
            pool.shutdown(wait=True, cancel_futures=True)

    def all(self, executor: Executor, workers: int, own: bool = False) -> None:
        """Every stretch that is missing; a few at a time, so that little waits to be kept."""
        left = self._stretches()
        pending: set[Future[Stretch]] = set()
        try:
            self._tell()
            while True:
                while len(pending) < _IN_FLIGHT * workers and (ends := next(left, None)) is not None:
                    more = (self.stopped.is_set, self.result._place(*ends)) if own else ()
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
                end = min(start + self.chunk, stop)
                yield start, end
                start = end

    def _take(self, stretch: Stretch) -> None:
        if self.journal is not None:
            self.journal.add(stretch)
        self.result._take(stretch)
        if not self.fixed:
            rate = (stretch.stop - stretch.start) / max(stretch.seconds, 1e-9)
            most = min(rate * _SECONDS, 4 * self.chunk, _MOST if self.unit == 1 else 16 * BATCH)
            self.chunk = max(int(most) // self.unit, 1) * self.unit
        self._tell()

    def _tell(self) -> None:
        if self.told is not None:
            self.told(self.result._finished, self.plan.points)


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
