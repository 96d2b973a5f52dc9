# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of a study as tables and labelled arrays, and in files that are written a piece at a time."""

from __future__ import annotations

import csv
import io
import json
import math
import os
from io import FileIO
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import numpy as np
from msgspec import Raw
from msgspec.json import Encoder
from numpy.typing import NDArray

from ..results.files import hdf5_file, write_fully
from ..systems.extras import require
from ..systems.numbers import file_path
from .axes import Axis, Reader
from .find import STATUS, Arrays
from .plan import Plan

if TYPE_CHECKING:
    from .result import SweepResult
    from .study import Study

ENDINGS = (".csv", ".parquet", ".nc")
ROWS = 65536  # written together
_LINES = 4096  # turned to text together
_JSON = Encoder()
_Variable = tuple[str, str, list[str], dict[str, Any]]
_WORDS = np.array([Raw(word.encode()) for word in STATUS], dtype=object)


class Writer(Protocol):
    """A file that takes all points, in order, a piece at a time; then it is closed."""

    def add(self, start: int, stop: int, pieces: Arrays) -> None:
        """The next points: whatever `pieces_of` gives."""

    def close(self) -> None:
        """Nothing more comes."""


def writer_of(path: str | os.PathLike[str]) -> type[_Csv] | type[_Parquet] | type[_NetCdf]:
    """What writes a file with this ending; that its packages are there is found out at once."""
    ending = Path(file_path("revchain.sweep", "the output", path)).suffix.lower()
    if ending not in ENDINGS:
        raise ValueError(f"{os.fspath(path)} must end in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")
    if ending == ".parquet":
        require("pyarrow", "sweep", "a .parquet file")
        return _Parquet
    if ending == ".nc":
        for module in ("h5py", "h5netcdf"):
            require(module, "sweep", "a .nc file")
        return _NetCdf
    return _Csv


def pieces_of(plan: Plan, reader: Reader, stored: Arrays, start: int, stop: int) -> Arrays:
    """Of a stretch of points all that a file has, by name: what varied, what was found, the status as 0, 1, 2."""
    values = reader.at(start, stop)
    pieces = dict(zip([axis.name for axis in plan.axes], values, strict=True))
    for block in plan.blocks:
        if block.name in stored:
            pieces[block.name] = stored[block.name][start:stop]
        else:
            pieces[block.name] = plan.speeds(stored["conical_height"][start:stop], values)
    pieces["status"] = stored["status"][start:stop]
    return pieces


def write_all(writer: Writer, plan: Plan, stored: Arrays) -> None:
    """Everything that is there already."""
    reader = plan.reader()
    try:
        for start in range(0, plan.points, ROWS):
            stop = min(start + ROWS, plan.points)
            writer.add(start, stop, pieces_of(plan, reader, stored, start, stop))
    finally:
        writer.close()


def columns_of(plan: Plan, pieces: Arrays, start: int, stop: int) -> dict[str, NDArray[Any]]:
    """The columns of a table."""
    columns: dict[str, NDArray[Any]] = {"point": np.arange(start, stop)}
    columns |= {axis.name: pieces[axis.name] for axis in plan.axes}
    for block in plan.blocks:
        values = pieces[block.name].reshape(stop - start, len(block.columns))
        columns |= {name: values[:, k] for k, name in enumerate(block.columns)}
    return {**columns, "status": pieces["status"]}


def dataframe_of(result: SweepResult) -> Any:
    """A pandas table."""
    pandas = require("pandas", "sweep", "SweepResult.to_dataframe")
    columns = result.columns(words=False)
    columns["status"] = pandas.Categorical.from_codes(columns["status"], STATUS)
    return pandas.DataFrame(columns)


def dataset_of(result: SweepResult) -> Any:
    """An xarray dataset: a dimension for each grid, one for samples, and those of modes, shapes, speeds."""
    xarray = require("xarray", "sweep", "SweepResult.to_xarray")
    plan = result._plan
    coordinates = {name: (name, values, about) for name, values, about in _coordinates(plan)}
    shape, data = plan.shape, {}
    for name, _, along, about in _variables(plan):
        values = result._status.astype(np.int8) if name == "status" else result[name]
        data[name] = ([*_dimensions(plan), *along], values.reshape(*shape, *values.shape[1:]), about)
    return xarray.Dataset(data, coordinates, _about(result.study))


def _about(study: Study) -> dict[str, str]:
    return {"title": study.title, "study": json.dumps(study.to_dict())}


def _dimensions(plan: Plan) -> list[str]:
    grids = [axis.name for axis in plan.axes if axis.values is not None]
    return grids if len(grids) == len(plan.axes) else [*grids, "sample"]


def _coordinates(plan: Plan) -> list[tuple[str, NDArray[Any], dict[str, Any]]]:
    """Values of the grids, and numbers of modes, shapes and speeds."""
    grids = [(axis.name, axis.values, _path(axis)) for axis in plan.axes if axis.values is not None]
    along = {block.along: np.array(block.labels) for block in plan.blocks if block.along}
    return [*grids, *((name, labels, {}) for name, labels in along.items())]


def _variables(plan: Plan) -> list[_Variable]:
    """What depends on the point: name, kind, dimension beside those of the points, what to say of it."""
    random: list[_Variable] = [(axis.name, "f8", [], _path(axis)) for axis in plan.axes if axis.values is None]
    found: list[_Variable] = [
        (block.name, block.kind, [block.along] if block.along else [], {}) for block in plan.blocks
    ]
    flags = {"flag_values": np.arange(len(STATUS), dtype=np.int8), "flag_meanings": " ".join(STATUS)}
    return [*random, *found, ("status", "i1", [], flags)]


def _path(axis: Axis) -> dict[str, Any]:
    return {"path": axis.key}


class _Csv:
    """Numbers in the fewest digits that read back the same."""

    def __init__(self, path: Path, study: Study, plan: Plan) -> None:
        self._plan = plan
        self._file = open(path, "wb")
        head = io.StringIO()
        csv.writer(head, lineterminator="\n").writerow(columns_of(plan, _empty(plan), 0, 0))
        self._file.write(head.getvalue().encode())

    def add(self, start: int, stop: int, pieces: Arrays) -> None:
        for first in range(start, stop, _LINES):
            last = min(first + _LINES, stop)
            part = {name: piece[first - start : last - start] for name, piece in pieces.items()}
            self._file.write(_lines(columns_of(self._plan, part, first, last)))

    def close(self) -> None:
        self._file.close()


def _lines(columns: dict[str, NDArray[Any]]) -> bytes:
    """Rows of a CSV file, by the fastest printer of numbers at hand: it makes JSON, all but the brackets the same."""
    rows = list(zip(*(_printable(name, column) for name, column in columns.items()), strict=True))
    return _JSON.encode(rows)[2:-2].replace(b"],[", b"\n") + b"\n"


def _printable(name: str, column: NDArray[Any]) -> list[Any]:
    """Numbers as they are; as it is to stand there whatever JSON has no number for."""
    if name == "status":
        return _WORDS[column].tolist()  # type: ignore[no-any-return]
    given: list[Any] = column.tolist()
    if column.dtype.kind not in "fi":
        return [Raw(str(value).encode()) for value in given]
    if column.dtype.kind == "f" and not np.isfinite(column).all():
        return [value if math.isfinite(value) else Raw(repr(value).encode()) for value in given]
    return given


def _empty(plan: Plan) -> Arrays:
    """Pieces of no points."""
    shapes: dict[str, tuple[int, ...]] = {axis.name: () for axis in plan.axes}
    shapes |= {block.name: block.each for block in plan.blocks}
    return {name: np.empty((0, *each)) for name, each in {**shapes, "status": ()}.items()}


class _Parquet:
    """A row group for each piece; what comes again and again is packed, in results hardly any number comes twice."""

    def __init__(self, path: Path, study: Study, plan: Plan) -> None:
        self._plan, self._path = plan, path
        self._arrow = require("pyarrow", "sweep", "a .parquet file")
        self._parquet = require("pyarrow.parquet", "sweep", "a .parquet file")
        self._metadata = _about(study)
        self._writer: Any = None

    def add(self, start: int, stop: int, pieces: Arrays) -> None:
        columns = {
            name: np.ascontiguousarray(column) for name, column in columns_of(self._plan, pieces, start, stop).items()
        }
        columns["status"] = self._arrow.DictionaryArray.from_arrays(columns["status"].view(np.int8), list(STATUS))
        table = self._arrow.table(columns)
        if self._writer is None:
            schema = table.schema.with_metadata(self._metadata)
            repeated = ["status", *(axis.name for axis in self._plan.axes if axis.values is not None)]
            packed = {name: "snappy" if name in (*repeated, "point") else "none" for name in columns}
            options = {"use_dictionary": repeated, "compression": packed}
            self._writer = self._parquet.ParquetWriter(self._path, schema, **options)
        self._writer.write_table(table.replace_schema_metadata(self._metadata))

    def close(self) -> None:
        if self._writer is not None:
            self._writer.close()


class _NetCdf:
    """netCDF-4, its arrays unbroken on disk: made with holes, which are filled piece by piece where they lie."""

    def __init__(self, path: Path, study: Study, plan: Plan) -> None:
        h5netcdf = require("h5netcdf", "sweep", "a .nc file")
        h5py = require("h5py", "sweep", "a .nc file")
        with hdf5_file(path) as whole:
            self._make(h5netcdf, h5py, whole, study, plan)
        with hdf5_file(path, "r+") as whole, h5py.File(whole, "r+") as file:
            for name, *_ in _variables(plan):
                file[name][(0,) * file[name].ndim] = 0  # now it has its place
            self._places = {name: file[name].id.get_offset() for name, *_ in _variables(plan)}
        self._file = FileIO(path, "r+")

    def _make(self, h5netcdf: Any, h5py: Any, whole: FileIO, study: Study, plan: Plan) -> None:
        """Everything but the results."""
        with h5netcdf.File(whole, "w") as file:
            dimensions = _dimensions(plan)
            file.dimensions = dict(zip(dimensions, plan.shape, strict=True))
            for name, values, about in _coordinates(plan):
                if name not in dimensions:
                    file.dimensions[name] = len(values)
                text = values.dtype.kind == "U"
                made = file.create_variable(
                    name, (name,), h5py.string_dtype() if text else _on_disk(values.dtype), **_filled(values.dtype)
                )
                made[...] = values.astype(object) if text else values
                made.attrs.update({**about, **_marked(values.dtype)})
            for name, kind, along, about in _variables(plan):
                dtype = np.dtype(kind)
                unfilled = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
                unfilled.set_fill_time(h5py.h5d.FILL_TIME_NEVER)
                place = (*dimensions, *along)
                made = file.create_variable(name, place, _on_disk(dtype), dcpl=unfilled, **_filled(dtype))
                made.attrs.update({**about, **_marked(dtype)})
            file.attrs.update(_about(study))

    def add(self, start: int, stop: int, pieces: Arrays) -> None:
        for name, place in self._places.items():
            piece = np.ascontiguousarray(pieces[name])
            self._file.seek(place + start * piece[:1].nbytes)
            write_fully(self._file, piece)

    def close(self) -> None:
        self._file.close()


def _on_disk(dtype: np.dtype[Any]) -> np.dtype[Any]:
    return np.dtype("i1") if dtype.kind == "b" else dtype


def _filled(dtype: np.dtype[Any]) -> dict[str, float]:
    return {"fillvalue": math.nan} if dtype.kind == "f" else {}


def _marked(dtype: np.dtype[Any]) -> dict[str, str]:
    return {"dtype": "bool"} if dtype.kind == "b" else {}


def first_refused(result: SweepResult, most: int) -> list[str]:
    """Lines about points that are refused."""
    return [f"point {point:,}: {sentence}" for point, sentence in islice(sorted(result.refused.items()), most)]
