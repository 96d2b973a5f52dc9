# SPDX-License-Identifier: GPL-3.0-or-later
"""Output files that are either complete or as they were before."""

from __future__ import annotations

import os
import secrets
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from io import FileIO
from pathlib import Path
from typing import Any


class OutputError(OSError, ValueError):
    """The error of a file that cannot be written, or of a model that cannot be read."""


@contextmanager
def naming(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turn an OSError into one that names the path asked for, not a temporary file."""
    try:
        yield
    except OutputError:
        raise
    except OSError as error:
        reason = os.strerror(error.errno) if error.errno else str(error)
        raise OutputError(error.errno, reason, os.fspath(path)) from error


class _Unfailing(FileIO):
    """A file whose writes seem to succeed; the first failure is stored."""

    failure: OSError | None = None

    def write(self, data: Any) -> int:
        try:
            left = memoryview(data).cast("B")
            while left:
                left = left[super().write(left) or 0 :]
        except OSError as error:
            self.failure = self.failure or error
        return len(memoryview(data).cast("B"))

    def truncate(self, size: int | None = None) -> int:
        try:
            return super().truncate(size)
        except OSError as error:
            self.failure = self.failure or error
            return size or 0


@contextmanager
def hdf5_file(path: str | os.PathLike[str], mode: str = "w+") -> Iterator[FileIO]:
    """Yield a file for h5py. Without it HDF5 ends the process with a segmentation fault after a failed write."""
    with _Unfailing(path, mode) as file:
        try:
            yield file
        finally:
            if file.failure is not None:
                raise file.failure


@contextmanager
def written_aside(*paths: str | os.PathLike[str]) -> Iterator[list[Path]]:
    """Yield an empty temporary file beside each path or target of a link, with the path's ending; rename all at the end.

    A file that the caller removes from the list is not renamed. If anything fails before the renaming, existing files stay.
    Devices and pipes are written directly.
    """
    finals = [Path(os.path.realpath(path)) for path in paths]
    asides: list[Path] = []
    try:
        for final, path in zip(finals, paths, strict=True):
            if final.is_dir():
                raise IsADirectoryError(21, "Is a directory", os.fspath(path))
            direct = final.exists() and not final.is_file()
            aside = final if direct else final.with_name(f".{final.stem[:100]}-{secrets.token_hex(6)}{Path(path).suffix}")
            if not direct:
                try:
                    aside.open("xb").close()
                except OSError as error:
                    raise type(error)(error.errno, error.strerror, os.fspath(path)) from None
            elif not os.access(final, os.W_OK):
                raise PermissionError(13, "Permission denied", os.fspath(path))
            asides.append(aside)
        yield (listed := asides.copy())
        for aside, final in zip(asides, finals, strict=True):
            if aside != final and aside in listed:
                os.replace(aside, final)
    finally:
        for aside, final in zip(asides, finals, strict=False):
            if aside != final:
                with suppress(OSError):
                    aside.unlink()
