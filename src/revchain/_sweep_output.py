# SPDX-License-Identifier: GPL-3.0-or-later
"""Results of a study as tables and labelled arrays, and in files."""

from __future__ import annotations

import csv
import json
import os
from collections.abc import Callable
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ._extras import require
from ._study_axes import Axis
from ._study_find import STATUS

if TYPE_CHECKING:
    from ._sweep_result import SweepResult

ENDINGS = (".csv", ".parquet", ".nc")
_ROWS = 65536  # of a table turned to text together


def writer_of(path: str | os.PathLike[str]) -> Callable[[SweepResult, Path], None]:
    """What writes a file with this ending; that its packages are there is found out at once."""
    ending = Path(path).suffix.lower()
    if ending not in ENDINGS:
        raise ValueError(f"{os.fspath(path)} must end in {', '.join(ENDINGS[:-1])} or {ENDINGS[-1]}")
    if ending == ".parquet":
        require("pyarrow", "sweep", "a .parquet file")
    elif ending == ".nc":
        for module in ("h5py", "h5netcdf", "xarray"):
            require(module, "sweep", "a .nc file")
    return {".csv": _csv, ".parquet": _parquet, ".nc": _netcdf}[ending]


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
    grids = [axis for axis in plan.axes if axis.values is not None]
    dimensions = [axis.name for axis in grids]
    if len(grids) < len(plan.axes):
        dimensions.append("sample")
    shape = plan.shape
    coordinates: dict[str, Any] = {axis.name: (axis.name, axis.values, _attributes(axis)) for axis in grids}
    data: dict[str, Any] = {
        axis.name: (dimensions, result[axis.name].reshape(shape), _attributes(axis))
        for axis in plan.axes
        if axis.values is None
    }
    for block in plan.blocks:
        if block.along:
            coordinates[block.along] = (block.along, np.array(block.labels))
        along = [block.along] if block.along else []
        data[block.name] = ([*dimensions, *along], result[block.name].reshape(*shape, *([-1] if along else [])))
    flags = {"flag_values": np.arange(len(STATUS), dtype=np.int8), "flag_meanings": " ".join(STATUS)}
    data["status"] = (dimensions, result._status.astype(np.int8).reshape(shape), flags)
    return xarray.Dataset(data, coordinates, {"title": result.study.title, "study": json.dumps(result.study.to_dict())})


def _attributes(axis: Axis) -> dict[str, str]:
    return {"path": axis.key}


def _csv(result: SweepResult, path: Path) -> None:
    columns = result.columns()
    with open(path, "w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for start in range(0, len(result), _ROWS):
            part = [column[start : start + _ROWS].tolist() for column in columns.values()]
            writer.writerows(zip(*part, strict=True))


def _parquet(result: SweepResult, path: Path) -> None:
    arrow = require("pyarrow", "sweep", "a .parquet file")
    parquet = require("pyarrow.parquet", "sweep", "a .parquet file")
    columns = {name: np.ascontiguousarray(column) for name, column in result.columns(words=False).items()}
    columns["status"] = arrow.DictionaryArray.from_arrays(columns["status"].view(np.int8), list(STATUS))
    table = arrow.table(columns)
    about = {"title": result.study.title, "study": json.dumps(result.study.to_dict())}
    parquet.write_table(table.replace_schema_metadata(about), path)


def _netcdf(result: SweepResult, path: Path) -> None:
    dataset_of(result).to_netcdf(path, engine="h5netcdf")


def first_refused(result: SweepResult, most: int) -> list[str]:
    """Lines about points that are refused."""
    return [f"point {point:,}: {sentence}" for point, sentence in islice(sorted(result.refused.items()), most)]
