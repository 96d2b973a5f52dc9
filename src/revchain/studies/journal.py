# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished stretches of a study on disk, beside its output: their numbers, and a list of them with checksums."""

from __future__ import annotations

import errno
import json
import os
import shutil
import struct
import time
import zlib
from bisect import bisect
from contextlib import suppress
from io import FileIO
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..results.files import OutputError, naming, write_fully
from .find import Arrays
from .plan import Plan, Stretch

_HEAD, _POINTS, _INDEX = "study.json", "points", "index"
_RECORD = struct.Struct("<QQI")  # start, stop, checksum of the numbers; then one of these three
_CHECK = struct.Struct("<I")
_LENGTH = _RECORD.size + _CHECK.size
_PAGE = 4096  # where each array begins
_SYNC = 1.0  # seconds between the times when the disk is made to keep what was written
STATUS = "status"


class Journal:
    """The folder ``OUT.partial``; use it in a with statement.

    ``points`` has all arrays behind one another, with holes where nothing is finished; ``index`` a record for each
    finished stretch, written after its numbers. A process killed at any moment leaves whole records, and at most a
    piece of one, which is dropped. Records whose numbers a failing disk or power damaged are known by their
    checksums, and their points computed again; `damage` says so.
    """

    def __init__(self, output: str | os.PathLike[str], plan: Plan) -> None:
        self.output = Path(os.path.realpath(output))
        self.folder = self.output.with_name(self.output.name + ".partial")
        self.plan = plan
        self.fingerprint = plan.fingerprint()
        self.kept: list[tuple[int, int]] = []
        self.damage = ""
        self._layout: dict[str, tuple[int, np.dtype[Any], tuple[int, ...]]] = {}
        self._size = 0
        for name, kind, columns in [*((b.name, b.kind, b.each) for b in plan.stored), (STATUS, "u1", ())]:
            self._layout[name] = self._size, np.dtype(kind), columns
            bytes_ = plan.points * int(np.prod(columns, dtype=object)) * np.dtype(kind).itemsize
            self._size += -(-bytes_ // _PAGE) * _PAGE
        self._lock: int | None = None
        self._ours = False  # its folder, to be removed if nothing is kept
        self._files: list[FileIO] = []
        self._synced = time.monotonic()

    def __enter__(self) -> Journal:
        if self.output.exists() and not self.output.is_file():
            raise OutputError(21, "is no file", os.fspath(self.output))
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except FileExistsError:
            raise OutputError(17, f"{self.folder} is no folder", os.fspath(self.output)) from None
        self._lock = os.open(self.folder, os.O_RDONLY)
        try:
            _only_one(self._lock, self.output)
            for path in self.folder.iterdir():
                if path.is_symlink():
                    reason = f"{path} is a symbolic link; remove it or write elsewhere"
                    raise OutputError(errno.ELOOP, reason, os.fspath(self.output))
            head = self.folder / _HEAD
            if head.exists():
                self._same(head)
            else:
                with naming(self.output):
                    self._begin(head)
            self._ours = True
            for left in self.folder.glob(".*.writing*"):
                left.unlink()
            self._open()
        except BaseException:
            self._close()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        self._close()

    @property
    def aside(self) -> Path:
        """Where the output is written before it gets its name."""
        return self.folder / f".output.writing{self.output.suffix}"

    def _close(self) -> None:
        if self._files:
            with suppress(OSError):
                self.sync()
        for file in self._files:
            file.close()
        self._files.clear()
        if self._lock is not None:
            if self._ours and not self.kept:
                with suppress(OSError):
                    shutil.rmtree(self.folder)
            os.close(self._lock)
            self._lock = None

    def _same(self, head: Path) -> None:
        try:
            known = str(json.loads(head.read_text(encoding="utf-8"))["fingerprint"])
        except (ValueError, KeyError, TypeError, RecursionError):
            reason = f"{head} is damaged: it does not say of which study; remove {self.folder} or write elsewhere"
            raise OutputError(errno.EEXIST, reason, os.fspath(self.output)) from None
        if known != self.fingerprint:
            reason = f"{self.folder} holds points of another study, or of another version; remove it or write elsewhere"
            raise OutputError(17, reason, os.fspath(self.output))

    def _begin(self, head: Path) -> None:
        """A new journal: the head is written last, so that where it is there everything is."""
        if any(path.name not in (_POINTS, _INDEX) and ".writing" not in path.name for path in self.folder.iterdir()):
            reason = f"{self.folder} holds other files; remove it or write elsewhere"
            raise OutputError(17, reason, os.fspath(self.output))
        for name in (_POINTS, _INDEX):
            (self.folder / name).write_bytes(b"")
        text = json.dumps({"fingerprint": self.fingerprint, "points": self.plan.points})
        _write_whole(head, text.encode())

    def _open(self) -> None:
        for name in (_POINTS, _INDEX):
            path = self.folder / name
            if not path.exists():
                self.damage = f"{path} is missing; the points it told of are computed again"
                path.touch()
            self._files.append(FileIO(path, "r+"))
        if os.fstat(self._files[0].fileno()).st_size < self._size:
            try:
                self._files[0].truncate(self._size)  # all holes at first
            except OSError as error:
                raise OutputError(error.errno, f"{error.strerror}: {self._size:.3g} bytes", str(self.output)) from None
        self._read_index()

    def _read_index(self) -> None:
        """What is there and whole, no point twice; the index is written anew if anything is not."""
        arrays = self.map()
        data = (self.folder / _INDEX).read_bytes()
        whole: list[bytes] = []
        for place in range(0, len(data) - _LENGTH + 1, _LENGTH):
            record = data[place : place + _RECORD.size]
            start, stop, checksum = _RECORD.unpack(record)
            good = _CHECK.unpack_from(data, place + _RECORD.size)[0] == zlib.crc32(record)
            good = good and start < stop <= self.plan.points
            place_among = bisect(self.kept, (start, stop))
            good = good and all(
                stop <= first or last <= start for first, last in self.kept[max(place_among - 1, 0) : place_among + 1]
            )
            if good and _checksum([array[start:stop] for array in arrays.values()]) == checksum:
                whole.append(data[place : place + _LENGTH])
                self.kept.insert(place_among, (start, stop))
        if (damaged := len(data) // _LENGTH - len(whole)) > 0:
            self.damage = (
                f"{self.folder}: {damaged:,} of {len(data) // _LENGTH:,} records of finished points are damaged; "
                f"{sum(stop - start for start, stop in self.kept):,} points are kept, all others are computed again"
            )
        if data != b"".join(whole):
            self._files.pop().close()
            _write_whole(self.folder / _INDEX, *whole)
            self._files.append(FileIO(self.folder / _INDEX, "r+"))
        self._files[1].seek(0, os.SEEK_END)

    def map(self) -> Arrays:
        """All arrays as they lie on disk, read when looked at; valid after the files are removed, too."""
        path, points = self.folder / _POINTS, self.plan.points
        return {
            name: np.asarray(np.memmap(path, kind, "r", place, (points, *columns)))
            for name, (place, kind, columns) in self._layout.items()
        }

    def add(self, stretch: Stretch) -> None:
        """Keep a finished stretch: first the numbers, then the record of them."""
        arrays = [np.ascontiguousarray(stretch.arrays[name]) for name in self._layout if name != STATUS]
        arrays.append(stretch.status)
        points, index = self._files
        for (place, kind, columns), array in zip(self._layout.values(), arrays, strict=True):
            points.seek(place + stretch.start * kind.itemsize * int(np.prod(columns, dtype=int)))
            write_fully(points, array)
        record = _RECORD.pack(stretch.start, stretch.stop, _checksum(arrays))
        write_fully(index, record + _CHECK.pack(zlib.crc32(record)))
        self.kept.append((stretch.start, stretch.stop))
        if time.monotonic() - self._synced > _SYNC:
            self.sync()

    def sync(self) -> None:
        """Until now a loss of power may cost points, though it never makes wrong ones."""
        for file in self._files:
            os.fsync(file.fileno())
        self._synced = time.monotonic()

    def sync_output(self) -> None:
        """Make the disk keep what is written of the output."""
        with FileIO(self.aside, "r+") as file:
            os.fsync(file.fileno())

    def finish(self) -> None:
        """Give the output its name, and remove what was kept of it."""
        self.sync_output()
        os.replace(self.aside, self.output)
        for file in self._files:
            file.close()
        self._files.clear()
        for path in sorted(self.folder.iterdir(), key=lambda path: path.name == _HEAD):  # that one last
            path.unlink()
        self.folder.rmdir()


def _checksum(arrays: list[NDArray[Any]]) -> int:
    checksum = 0
    for array in arrays:
        checksum = zlib.crc32(array.data, checksum)
    return checksum


def _write_whole(path: Path, *parts: bytes) -> None:
    """A small file that is whole or as it was."""
    aside = path.with_name(f".{path.name}.writing")
    with FileIO(aside, "w") as file:
        write_fully(file, b"".join(parts))
        os.fsync(file.fileno())
    os.replace(aside, path)


def _only_one(folder: int, output: Path) -> None:
    """Refuse a second process at work on the same output; the lock ends with the process, however it does."""
    with suppress(ImportError):
        import fcntl

        try:
            fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise OutputError(11, "another run is writing it", os.fspath(output)) from None
