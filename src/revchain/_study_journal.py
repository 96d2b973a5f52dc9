# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished stretches of a study on disk, beside its output: one file each, whole or not there, checked when read."""

from __future__ import annotations

import json
import os
import re
import shutil
import zlib
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

import numpy as np

from ._files import OutputError
from ._study_find import Arrays
from ._study_plan import Plan, Stretch

_NAME = re.compile(r"(\d{12})-(\d{12})\.points")
_HEAD = "study.json"


class Journal:
    """The folder ``OUT.partial``; use it in a with statement.

    A process killed at any moment leaves whole files of finished stretches, and at most one file under another name,
    which is not read. Files that a failing disk or power left damaged are known by their checksums, and their points
    computed again.
    """

    def __init__(self, output: str | os.PathLike[str], plan: Plan) -> None:
        self.output = Path(os.path.realpath(output))
        self.folder = self.output.with_name(self.output.name + ".partial")
        self.plan = plan
        self.fingerprint = plan.fingerprint()
        self._lock: int | None = None

    def __enter__(self) -> Journal:
        if self.output.exists() and not self.output.is_file():
            raise OutputError(21, "is no file", os.fspath(self.output))
        self.folder.mkdir(parents=True, exist_ok=True)
        self._lock = os.open(self.folder, os.O_RDONLY)
        try:
            _only_one(self._lock, self.output)
            head = self.folder / _HEAD
            if head.exists():
                self._same(head)
            else:
                text = json.dumps({"fingerprint": self.fingerprint, "points": self.plan.points})
                self._write(head, text.encode())
            for left in self.folder.glob(".*.writing*"):
                left.unlink()
        except BaseException:
            self._unlock()
            raise
        return self

    def __exit__(self, *_: object) -> None:
        with suppress(OSError):
            if not any(self.folder.glob("*.points")):
                shutil.rmtree(self.folder)
        self._unlock()

    @property
    def aside(self) -> Path:
        """Where the output is written before it gets its name."""
        return self.folder / f".output.writing{self.output.suffix}"

    def _unlock(self) -> None:
        if self._lock is not None:
            os.close(self._lock)
            self._lock = None

    def _same(self, head: Path) -> None:
        try:
            known = json.loads(head.read_text(encoding="utf-8"))["fingerprint"]
        except (ValueError, KeyError, TypeError):
            known = None
        if known != self.fingerprint:
            reason = f"{self.folder} holds points of another study, or of another version; remove it or write elsewhere"
            raise OutputError(17, reason, os.fspath(self.output))

    def add(self, stretch: Stretch) -> None:
        """Keep a finished stretch."""
        arrays = {**stretch.arrays, "status": stretch.status}
        header = {
            "fingerprint": self.fingerprint,
            "points": [stretch.start, stretch.stop],
            "arrays": [[name, array.dtype.str, array.shape] for name, array in arrays.items()],
        }
        parts = [json.dumps(header).encode() + b"\n", *(np.ascontiguousarray(array) for array in arrays.values())]
        name = f"{stretch.start:012d}-{stretch.stop:012d}.points"
        self._write(self.folder / name, *parts)

    def _write(self, path: Path, *parts: object) -> None:
        aside = path.with_name(f".{path.name}.writing")
        checksum = 0
        with open(aside, "wb") as file:
            for part in parts:
                checksum = zlib.crc32(part, checksum)  # type: ignore[arg-type]
                file.write(part)  # type: ignore[arg-type]
            if path.name != _HEAD:
                file.write(b"%08x" % checksum)
        os.replace(aside, path)

    def stretches(self) -> Iterator[Stretch]:
        """What is there, in order, no point twice; what cannot be read is removed."""
        end = 0
        for path in sorted(self.folder.iterdir()):
            found = _NAME.fullmatch(path.name)
            if found is None:
                continue
            start, stop = int(found[1]), int(found[2])
            stretch = self._read(path, start, stop) if end <= start < stop <= self.plan.points else None
            if stretch is None:
                path.unlink()
                continue
            end = stop
            yield stretch

    def _read(self, path: Path, start: int, stop: int) -> Stretch | None:
        data = path.read_bytes()
        body, checksum = memoryview(data)[:-8], data[-8:]
        if len(data) < 8 or checksum != b"%08x" % zlib.crc32(body):
            return None
        line = data.index(b"\n")
        header = json.loads(data[:line])
        if header["fingerprint"] != self.fingerprint or header["points"] != [start, stop]:
            return None
        arrays: Arrays = {}
        place = line + 1
        for name, kind, shape in header["arrays"]:
            count = int(np.prod(shape))
            arrays[name] = np.frombuffer(body, kind, count, place).reshape(shape)
            place += count * np.dtype(kind).itemsize
        status = arrays.pop("status")
        return Stretch(start, stop, arrays, status)

    def finish(self) -> None:
        """Give the output its name, and remove what was kept of it."""
        os.replace(self.aside, self.output)
        for path in sorted(self.folder.iterdir(), key=lambda path: path.name == _HEAD):  # that one last
            path.unlink()
        self.folder.rmdir()


def _only_one(folder: int, output: Path) -> None:
    """Refuse a second process at work on the same output; the lock ends with the process, however it does."""
    with suppress(ImportError):
        import fcntl

        try:
            fcntl.flock(folder, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            raise OutputError(11, "another run is writing it", os.fspath(output)) from None
