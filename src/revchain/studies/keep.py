# SPDX-License-Identifier: GPL-3.0-or-later
"""Keeping the points of a study on disk, and writing its output, while the next ones are computed."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from contextlib import suppress
from queue import Empty, Queue
from threading import Thread

from ..results.files import naming
from .find import Arrays
from .journal import Journal
from .output import ROWS, Writer, pieces_of
from .plan import Stretch

_WAITING = 4  # stretches that wait to be kept, at most
_SYNC = 2**25  # bytes of output after which the disk is made to keep them


class Keeper:
    """A thread that keeps stretches in the journal and, when none waits, writes the output as far as points go without
    a gap. To be closed; only after `finish` is the output whole.
    """

    def __init__(self, journal: Journal, make: Callable[[], Writer], stored: Arrays) -> None:
        self._journal, self._make, self._stored = journal, make, stored
        self._writer: Writer | None = None
        self._unsynced = 0  # bytes of the output
        self.kept = sorted(journal.kept)
        self.finished = sum(stop - start for start, stop in self.kept)
        self._beyond = dict(self.kept)  # stretches not reached yet: their ends by their beginnings
        self._whole = self._written = 0  # all points before are kept; are in the output
        self._reach()
        self._reader = journal.plan.reader()
        self._idle: deque[Arrays] = deque(maxlen=2 * _WAITING)  # memory of stretches that are kept
        self._queue: Queue[Stretch | None] = Queue(_WAITING)
        self._failed: BaseException | None = None
        self._given_up = False
        self._thread = Thread(target=self._run, name="revchain-sweep-keep", daemon=True)
        self._thread.start()

    def place(self, start: int, stop: int) -> Arrays:
        """Memory for a stretch: that of one that is kept by now, if it is large enough."""
        memory = self._idle.pop() if self._idle else {}
        if not memory or len(next(iter(memory.values()))) < stop - start:
            memory = {block.name: block.memory(stop - start) for block in self._journal.plan.stored}
        return {name: array[: stop - start] for name, array in memory.items()}

    def take(self, stretch: Stretch) -> None:
        """Have it kept; what went wrong with one before is raised here."""
        self._queue.put(stretch)
        self._raise()

    def finish(self) -> None:
        """Wait until everything is kept and written."""
        self._queue.put(None)
        self._thread.join()
        self._raise()

    def close(self) -> None:
        """Keep what was taken; without `finish` the output is dropped."""
        if self._thread.is_alive():
            self._given_up = True
            self._queue.put(None)
            self._thread.join()

    def _raise(self) -> None:
        if self._failed is not None:
            with naming(self._journal.output):
                raise self._failed

    def _run(self) -> None:
        while (stretch := self._next()) is not None:
            self._try(stretch)
        while not self._given_up and self._ready:
            self._try(None)
        try:
            if self._writer is not None:
                self._writer.close()
        except BaseException as error:
            self._failed = self._failed or error
        if self._given_up or self._failed is not None:
            with suppress(OSError):
                self._journal.aside.unlink()

    def _next(self) -> Stretch | None:
        """The next stretch to be kept; meanwhile the output is written."""
        while self._ready and not self._given_up:
            try:
                return self._queue.get_nowait()
            except Empty:
                self._try(None)
        return self._queue.get()

    def _try(self, stretch: Stretch | None) -> None:
        """Keep a stretch, or write a piece of the output; go on keeping if there is something wrong with either."""
        try:
            if stretch is None:
                self._write()
            else:
                self._journal.add(stretch)
                self._idle.append(stretch.arrays)
                self.finished += stretch.stop - stretch.start
                self._beyond[stretch.start] = stretch.stop
                self._reach()
        except BaseException as error:
            self._failed, self._given_up = self._failed or error, True

    def _reach(self) -> None:
        while (stop := self._beyond.pop(self._whole, None)) is not None:
            self._whole = stop

    @property
    def _piece(self) -> tuple[int, int]:
        """The next points of the output: always `ROWS`, but for the last. Pieces do not depend on when points come."""
        return self._written, min(self._written + ROWS, self._journal.plan.points)

    @property
    def _ready(self) -> bool:
        """Whether these points are kept."""
        start, stop = self._piece
        return start < stop <= self._whole

    def _write(self) -> None:
        start, stop = self._piece
        if self._writer is None:
            self._writer = self._make()
        pieces = pieces_of(self._journal.plan, self._reader, self._stored, start, stop)
        self._writer.add(start, stop, pieces)
        self._written = stop
        self._unsynced += sum(piece.nbytes for piece in pieces.values())
        if self._unsynced > _SYNC:  # not all of it at the end, when nothing is left to be done meanwhile
            self._journal.sync_output()
            self._unsynced = 0
