# SPDX-License-Identifier: GPL-3.0-or-later
"""Finished points on disk, one file for each chunk, which are joined into one file of results."""

from __future__ import annotations

import errno
import json
import os
import re
import warnings
from collections.abc import Callable, Iterator
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..results.files import OutputError, hdf5_file, naming
from ..results.storage import WRONG
from ..systems.extras import require
from ..systems.numbers import file_path
from .plan import Plan, Stretch
from .points import STATUS, Arrays, Block

if TYPE_CHECKING:
    from .study import Study

ENDINGS = (".csv", ".parquet", ".nc")
ROWS = 65536  # rows of a table that are written together
_CHUNK = re.compile(r"(\d{13})-(\d{13})\.npz")
_HEAD, _LOCK, _ASIDE = "study.json", "lock", ".writing"


def checked_ending(path: str | os.PathLike[str]) -> str:
    """The ending of an output; the package that writes it is imported, so that a missing one is an error at once."""
    ending = Path(file_path("revchain.sweep", "the output", path)).suffix.lower()
    if ending not in ENDINGS:
        raise ValueError(f"{os.fspath(path)} must end in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")
    for module in ("xarray", "h5py", "h5netcdf") if ending == ".nc" else ("pyarrow",):
        require(module, "sweep", f"a {ending} file")
    return ending


class Store:
    """The folder ``OUT.partial`` with a file for each finished chunk; use it in a with statement.

    A chunk is written to a temporary file and renamed, so that a file of its name is complete even if the process is
    killed. A damaged file fails its checksum, and its points are computed again.
    """

    def __init__(self, output: str | os.PathLike[str], plan: Plan) -> None:
        self.output, self._plan = Path(os.path.realpath(output)), plan
        self.folder = self.output.with_name(self.output.name + ".partial")
        self.kept: list[tuple[int, int]] = []
        self.finished = 0
        self._stack = ExitStack()

    def __enter__(self) -> Store:
        filelock = require("filelock", "sweep", "revchain.sweep with out")
        if self.output.exists() and not self.output.is_file():
            raise self._refused(errno.EISDIR, "is no file")
        try:
            self.folder.mkdir(parents=True, exist_ok=True)
        except FileExistsError:
            raise self._refused(errno.EEXIST, f"{self.folder} is no folder") from None
        ours = (_HEAD, _LOCK)
        if any(path.name not in ours and not path.name.startswith(_ASIDE) for path in self.folder.iterdir()):
            if not (self.folder / _HEAD).exists():
                raise self._refused(errno.EEXIST, f"{self.folder} holds other files; remove it or write elsewhere")
        with naming(self.output), self._stack:
            try:
                self._stack.enter_context(filelock.FileLock(self.folder / _LOCK, timeout=0))
            except filelock.Timeout:
                raise self._refused(errno.EAGAIN, "another run is writing it") from None
            self._begin()
            self._stack.callback(self._clear)  # only now, because the folder may belong to another study
            self._stack = self._stack.pop_all()
        return self

    def __exit__(self, *_: object) -> None:
        self._stack.close()

    def place(self, start: int, stop: int) -> None:
        """None: results get their own arrays."""

    def take(self, stretch: Stretch) -> None:
        """Store a finished stretch of points."""
        final = self.folder / f"{stretch.start:013}-{stretch.stop:013}.npz"
        aside = self.folder / f"{_ASIDE}-{final.name}"
        with naming(self.output):
            with open(aside, "wb") as file:
                np.savez(file, allow_pickle=False, status=stretch.status, **stretch.arrays)
            os.replace(aside, final)
        self.kept.append((stretch.start, stretch.stop))
        self.finished += stretch.stop - stretch.start

    def join(self, study: Study) -> None:
        """Write the output from all chunks, then remove them."""
        aside = self.folder / f"{_ASIDE}{self.output.suffix}"
        with naming(self.output):
            write(aside, study, self._plan, self._read)
            with open(aside, "r+b") as file:
                os.fsync(file.fileno())  # before the chunks are removed
            os.replace(aside, self.output)
        self._remove()

    def _refused(self, number: int, reason: str) -> OutputError:
        return OutputError(number, reason, os.fspath(self.output))

    def _begin(self) -> None:
        """Write the head of a new folder, or read that of an old one."""
        for path in self.folder.glob(f"{_ASIDE}*"):
            path.unlink()  # before anything is written there: one may be a link to another file
        head, fingerprint = self.folder / _HEAD, self._plan.fingerprint()
        if not head.exists():
            aside = self.folder / f"{_ASIDE}-{_HEAD}"
            aside.write_text(json.dumps({"fingerprint": fingerprint}), encoding="utf-8")
            os.replace(aside, head)
        try:
            known = json.loads(head.read_text(encoding="utf-8"))["fingerprint"]
        except (ValueError, KeyError, TypeError, RecursionError):
            known = None
        if known != fingerprint:
            reason = f"{self.folder} holds points of another study, or of another version; remove it or write elsewhere"
            raise self._refused(errno.EEXIST, reason)
        for path in sorted(self.folder.iterdir()):
            found = _CHUNK.fullmatch(path.name)
            if found is not None:
                start, stop = int(found[1]), int(found[2])
                reached = self.kept[-1][1] if self.kept else 0
                if reached <= start < stop <= self._plan.points and self._is_whole(start, stop):
                    self.kept.append((start, stop))
                else:
                    path.unlink()
        self.finished = sum(stop - start for start, stop in self.kept)

    def _is_whole(self, start: int, stop: int) -> bool:
        """Whether the file of a chunk can be read and has the right contents."""
        expected = {block.name: ((stop - start, *block.each), np.dtype(block.kind)) for block in self._plan.stored}
        try:
            found = {name: (array.shape, array.dtype) for name, array in self._chunk(start, stop).items()}
        except WRONG:
            return False
        return found == {**expected, "status": ((stop - start,), np.dtype(np.uint8))}

    def _chunk(self, start: int, stop: int, names: list[str] | None = None) -> Arrays:
        with open(self.folder / f"{start:013}-{stop:013}.npz", "rb") as file, np.load(file, allow_pickle=False) as kept:
            return {name: kept[name] for name in (kept.files if names is None else names)}

    def _read(self, size: int, names: list[str] | None = None) -> Iterator[Arrays]:
        """All points in order, `size` at a time (fewer at the end)."""
        waiting: list[Arrays] = []
        there = 0
        for start, stop in sorted(self.kept):
            waiting.append(self._chunk(start, stop, names))
            there += stop - start
            if there >= size or stop == self._plan.points:
                whole = {name: np.concatenate([part[name] for part in waiting]) for name in waiting[0]}
                last = there if stop == self._plan.points else there - there % size
                for first in range(0, last, size):
                    yield {name: array[first : min(first + size, last)] for name, array in whole.items()}
                waiting, there = [{name: array[last:] for name, array in whole.items()}], there - last

    def _clear(self) -> None:
        """Remove the folder if it has no chunk."""
        if not self.kept and self.folder.exists():
            self._remove()

    def _remove(self) -> None:
        """Remove our files (the chunks before the head) and the folder; other files stay, with a warning."""
        with suppress(OSError):
            for path in self.folder.iterdir():
                if path.name.startswith(_ASIDE) or _CHUNK.fullmatch(path.name):
                    path.unlink()
            for name in (_HEAD, _LOCK):
                (self.folder / name).unlink(missing_ok=True)
            if others := sorted(path.name for path in self.folder.iterdir()):
                warnings.warn(f"{self.folder} stays: it holds other files, such as {others[0]}", stacklevel=4)
            else:
                self.folder.rmdir()


Read = Callable[..., Iterator[Arrays]]


def write(path: Path, study: Study, plan: Plan, read: Read) -> None:
    """Write a file of results; `read(size, names)` yields the stored results of all points, `size` points at a time."""
    if path.suffix.lower() == ".nc":
        _write_netcdf(path, study, plan, read)
        return
    arrow = require("pyarrow", "sweep", f"a {path.suffix} file")
    reader, start, writer = plan.reader(), 0, None
    with ExitStack() as stack:
        file = stack.enter_context(open(path, "wb"))
        for stored in read(ROWS):
            stop = start + len(stored["status"])
            columns = columns_of(plan, pieces_of(plan, reader.at(start, stop), stored), start, stop)
            words = arrow.DictionaryArray.from_arrays(stored["status"].view(np.int8), list(STATUS))
            columns["status"] = words if path.suffix.lower() == ".parquet" else words.cast(arrow.string())
            smooth = {name: np.ascontiguousarray(c) if name != "status" else c for name, c in columns.items()}
            table = arrow.table(smooth)
            if writer is None:
                schema = table.schema.with_metadata(about(study))
                writer = stack.enter_context(_table_writer(file, path, schema, plan))
            writer.write_table(table.replace_schema_metadata(about(study)))
            start = stop


def _table_writer(file: Any, path: Path, schema: Any, plan: Plan) -> Any:
    if path.suffix.lower() == ".csv":
        return require("pyarrow.csv", "sweep", "a .csv file").CSVWriter(file, schema)
    parquet = require("pyarrow.parquet", "sweep", "a .parquet file")
    repeated = ["status", *(axis.name for axis in plan.axes if axis.values is not None)]
    packed = {name: "snappy" if name in (*repeated, "point") else "none" for name in schema.names}
    return parquet.ParquetWriter(file, schema, use_dictionary=repeated, compression=packed)


def _write_netcdf(path: Path, study: Study, plan: Plan, read: Read) -> None:
    """Write one variable after another; one at a time is in memory."""
    xarray = require("xarray", "sweep", "a .nc file")
    h5netcdf = require("h5netcdf", "sweep", "a .nc file")
    backends = require("xarray.backends", "sweep", "a .nc file")
    blocks = {block.name: block for block in plan.blocks}
    axes = [axis.name for axis in plan.axes]

    def whole(name: str) -> NDArray[Any]:
        if name in axes:
            return plan.values(0, plan.points)[axes.index(name)]
        derived = name == "angular_speed" and plan.derived
        found = blocks[name].memory(plan.points) if name in blocks else np.empty(plan.points, np.uint8)
        reader, start = plan.reader(), 0
        for part in read(ROWS, ["conical_height" if derived else name, "status"]):
            stop = start + len(part["status"])
            found[start:stop] = plan.speeds(part["conical_height"], reader.at(start, stop)) if derived else part[name]
            start = stop
        return found

    with hdf5_file(path) as file, h5netcdf.File(file, "w") as target:
        store = backends.H5NetCDFStore(target)
        xarray.Dataset({}, coordinates_of(plan), about(study)).dump_to_store(store)
        for name, (dimensions, attributes) in variables_of(plan).items():
            variable = xarray.Variable(dimensions, shaped(plan, name, whole(name)), attributes, {"_FillValue": None})
            xarray.Dataset({name: variable}).dump_to_store(store)


def pieces_of(plan: Plan, values: list[NDArray[Any]], stored: Arrays) -> Arrays:
    """All numbers of a stretch of points by name: the varied numbers and the results."""
    pieces = dict(zip([axis.name for axis in plan.axes], values, strict=True))
    for block in plan.blocks:
        derived = block.name not in stored
        pieces[block.name] = plan.speeds(stored["conical_height"], values) if derived else stored[block.name]
    return pieces


def columns_of(plan: Plan, pieces: Arrays, start: int, stop: int) -> dict[str, Any]:
    """The columns of a table without the status."""
    columns: dict[str, Any] = {"point": np.arange(start, stop)}
    columns |= {axis.name: pieces[axis.name] for axis in plan.axes}
    for block in plan.blocks:
        values = pieces[block.name].reshape(stop - start, len(block.columns))
        columns |= {name: values[:, k] for k, name in enumerate(block.columns)}
    return columns


def read_back(path: Path, plan: Plan, blocks: tuple[Block, ...]) -> Arrays:
    """Some of the results from a file that `write` wrote, and the status as 0, 1, 2."""
    if path.suffix.lower() == ".nc":
        xarray = require("xarray", "sweep", "a .nc file")
        with xarray.open_dataset(path, engine="h5netcdf") as data:
            found = {block.name: data[block.name].to_numpy().reshape(plan.points, *block.each) for block in blocks}
            return found | {"status": data["status"].to_numpy().astype(np.uint8).reshape(-1)}
    kinds = {name: np.dtype(block.kind) for block in blocks for name in block.columns}
    names = [*kinds, "status"]
    if path.suffix.lower() == ".parquet":
        table = require("pyarrow.parquet", "sweep", "a .parquet file").read_table(path, columns=names)
    else:
        csv, arrow = require("pyarrow.csv", "sweep", "a .csv file"), require("pyarrow", "sweep", "a .csv file")
        types = {name: arrow.from_numpy_dtype(kind) for name, kind in kinds.items()} | {"status": arrow.string()}
        options = csv.ConvertOptions(include_columns=names, column_types=types, null_values=[])
        table = csv.read_csv(path, convert_options=options)
    arrays: Arrays = {}
    for block in blocks:
        columns = np.stack([table[name].to_numpy() for name in block.columns], axis=-1)
        arrays[block.name] = columns.reshape(plan.points, *block.each)
    words = table["status"].to_numpy()
    return arrays | {"status": np.select([words == word for word in STATUS], [0, 1, 2]).astype(np.uint8)}


# ---- labelled arrays


def about(study: Study) -> dict[str, str]:
    """The attributes of a file."""
    return {"title": study.title, "study": json.dumps(study.to_dict())}


def dimensions_of(plan: Plan) -> list[str]:
    """Names of the dimensions: one for each grid, and one for samples."""
    grids = [axis.name for axis in plan.axes if axis.values is not None]
    return grids if len(grids) == len(plan.axes) else [*grids, "sample"]


def coordinates_of(plan: Plan) -> dict[str, Any]:
    """Values of the grids, and numbers of modes, shapes and speeds."""
    grids = {axis.name: (axis.name, axis.values, {"path": axis.key}) for axis in plan.axes if axis.values is not None}
    return grids | {block.along: (block.along, np.array(block.labels)) for block in plan.blocks if block.along}


def variables_of(plan: Plan) -> dict[str, tuple[list[str], dict[str, Any]]]:
    """Dimensions and attributes of the variables that depend on the point."""
    points = dimensions_of(plan)
    found: dict[str, tuple[list[str], dict[str, Any]]] = {}
    for axis in plan.axes:
        if axis.values is None:
            found[axis.name] = points, {"path": axis.key}
    for block in plan.blocks:
        found[block.name] = [*points, block.along] if block.along else points, {}
    flags = {"flag_values": np.arange(len(STATUS), dtype=np.int8), "flag_meanings": " ".join(STATUS)}
    return found | {"status": (points, flags)}


def shaped(plan: Plan, name: str, values: NDArray[Any]) -> NDArray[Any]:
    """Values with an axis for each grid; the status in the form for netCDF."""
    return (values.astype(np.int8) if name == "status" else values).reshape(*plan.shape, *values.shape[1:])
