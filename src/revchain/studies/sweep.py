# SPDX-License-Identifier: GPL-3.0-or-later
"""Computation of all points of a study by threads or any executor, in chunks that are stored on disk."""

from __future__ import annotations

import errno
import json
import os
import warnings
from collections.abc import Callable, Generator, Iterator
from concurrent.futures import Executor, Future, ThreadPoolExecutor, as_completed
from contextlib import ExitStack, closing, contextmanager, suppress
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any
from zipfile import ZipFile

import numpy as np
from numpy.typing import NDArray

from ..results.excel import MOST_LINES, Page, write_workbook
from ..results.files import OutputError, hdf5_file, naming, written_aside
from ..results.sheet import Column
from ..results.storage import WRONG, whole_array
from ..systems.extras import require
from ..systems.numbers import count as checked_count
from ..systems.numbers import file_path, shown
from .plan import OUTPUTS, STATUS, Plan, Rows, Values, said
from .scatter import worst_cases
from .study import Study, load_study

if TYPE_CHECKING:
    from xarray import Dataset

_CALLER = "revchain.sweep"
BATCH, ONE_BY_ONE, MOST_CHUNKS = 65536, 100, 10_000  # points in a chunk of a batch, in another chunk; number of chunks
CHUNKS = "[0-9]*-[0-9]*.npz"
PACKAGES = {
    ".csv": ["pyarrow.csv"], ".parquet": ["pyarrow.parquet"], ".nc": ["h5py", "h5netcdf"], ".xlsx": ["openpyxl"],
}  # fmt: skip


def sweep(
    study: Study | str | os.PathLike[str] | dict[str, Any],
    *,
    out: str | os.PathLike[str] | None = None,
    executor: Executor | None = None,
    workers: int | None = None,
    chunk: int | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> Dataset:
    """Compute all points of a study and return their results.

    Parameters
    ----------
    study : Study, path-like or dict
        The study, its file, or its data.
    out : path-like, optional
        File for the results: ``.nc`` (netCDF, which xarray reads), or a table with a row for each point, ``.csv``,
        ``.parquet`` or ``.xlsx`` (a workbook, up to 1,048,575 points). It is written when all points are done. Until then
        finished chunks are in the folder ``OUT.partial`` beside it; after an interruption the same call continues from them.
    executor : concurrent.futures.Executor, optional
        Executor for the chunks, such as a ``ProcessPoolExecutor``, or ``client.get_executor()`` of a Dask cluster; threads
        if left out. It is not shut down.
    workers : int, optional
        Number of threads, or of workers of the executor; one for each processor if left out.
    chunk : int, optional
        Number of points that are computed and stored together; chosen by the sweep if left out.
    progress : callable, optional
        Called with the number of finished points and that of all points.

    Returns
    -------
    xarray.Dataset
        The results by name, with SI units in ``attrs["units"]``. There is one dimension for each grid, one named ``sample``
        for random numbers, and one each for the modes, shapes, speeds, orders or equilibria found. NaN (0 for whole numbers,
        False for verdicts) stands for a missing result. The variable ``status`` is 1 for success, 2 if a result is not
        proved, 3 for a refused point. The numbers do not depend on `executor`, `workers` and `chunk`.

    Raises
    ------
    SceneError
        If the study is not valid.
    OSError
        If `out` cannot be written, another run is writing it, or its partial folder has points of another study (the error
        is also a ValueError). Finished chunks stay.
    ValueError
        If `out` has another extension or cannot hold all points, or `workers` or `chunk` is below 1.
    TypeError
        If an argument has the wrong type.
    ImportError
        If xarray or a package that writes `out` is missing; the message says how to install it.

    Warns
    -----
    UserWarning
        If a stored chunk cannot be read (its points are computed again), or the partial folder holds other files and stays.

    Notes
    -----
    If only modes are asked for, points of a `Chain` can be computed in batches, without bounds, by
    `revchain.conical_heights`; ``revchain sweep STUDY --check`` says whether they are. A refused point has no numbers;
    `Study.scene_at`, or the question asked of its scene, raises the error with the reason. Cost: 0.1 microseconds a point of
    two links in a batch, 0.2 to 1 ms otherwise, if the question is not a long one.

    Examples
    --------
    >>> import revchain as rc
    >>> found = rc.sweep({
    ...     "scene": {"links": [{"mass": 1.0, "length": 0.5, "kind": "rod"}], "support": {"stiffness": 50.0}},
    ...     "vary": {"support.stiffness": {"from": "10 N/m", "to": "1 kN/m", "steps": 3, "log": True}},
    ... })
    >>> found["angular_speed"].sel(mode=1).to_numpy().round(4)
    array([2.8026, 4.8815, 5.3647])
    """
    if isinstance(study, dict):
        study = Study.from_dict(study)
    elif not isinstance(study, Study):
        study = load_study(study)
    if executor is not None and (isinstance(executor, type) or not callable(getattr(executor, "submit", None))):
        wanted = "a concurrent.futures.Executor, such as ThreadPoolExecutor(4)"
        raise TypeError(f"{_CALLER}: executor must be {wanted}, got {shown(executor)}")
    if progress is not None and not callable(progress):
        raise TypeError(f"{_CALLER}: progress must be a function of two numbers, got {shown(progress)}")
    chunk = None if chunk is None else checked_count(_CALLER, "chunk", chunk)
    workers = _processors() if workers is None else checked_count(_CALLER, "workers", workers)
    require("xarray", "sweep", _CALLER)
    plan = study._plan("study")
    if out is not None:
        check_output(out, plan.points)
    if chunk is None:
        few = max(min(ONE_BY_ONE, plan.points // (4 * workers)), plan.points // MOST_CHUNKS, 1)
        chunk = few if plan.links is None else BATCH
    values, rows, folder = plan.values(), plan.rows(plan.points), None
    with ExitStack() as stack:
        if out is not None:
            output = Path(os.path.realpath(out))
            stack.enter_context(naming(output))
            folder = stack.enter_context(_folder(output, study))
            _read_chunks(folder, rows)
        pool = executor or stack.enter_context(ThreadPoolExecutor(workers, thread_name_prefix="revchain-sweep"))
        done = int(np.count_nonzero(rows["status"]))
        computed = closing(_computed(plan, values, rows, chunk, pool, executor is None, folder))
        for points in chain([0], stack.enter_context(computed)):
            done += points
            if progress is not None:
                progress(done, plan.points)
        found = dataset(study, plan, values, rows)
        if folder is not None:
            with written_aside(output) as [aside]:
                write(found, aside)
            _remove(folder)
    return found


def _computed(
    plan: Plan, values: Values, rows: Rows, chunk: int, pool: Executor, in_place: bool, folder: Path | None
) -> Generator[int, None, None]:
    """Compute the points without results, store each chunk, and yield the number of its points."""
    ends = np.flatnonzero(np.diff(rows["status"] == 0, prepend=False, append=False)).reshape(-1, 2)
    pending: dict[Future[Rows], int] = {}
    try:
        for first, last in ends.tolist():
            for start in range(first, last, chunk):
                part = slice(start, min(start + chunk, last))
                to = {name: array[part] for name, array in rows.items()} if in_place else None
                pending[pool.submit(plan.solve, [column[part] for column in values], to)] = start
        for future in as_completed(pending):
            start, found = pending.pop(future), future.result()
            stop = start + len(found["status"])
            for name, array in found.items() if not in_place else ():
                rows[name][start:stop] = array
            if folder is not None:
                with written_aside(folder / f"{start:013}-{stop:013}.npz") as [aside]:
                    np.savez(aside, **found)  # type: ignore[arg-type]
            yield stop - start
    finally:
        for future in pending:
            future.cancel()


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


# ---- files


@contextmanager
def _folder(output: Path, study: Study) -> Iterator[Path]:
    """Yield the locked folder ``OUT.partial`` with the finished chunks of this study."""
    filelock = require("filelock", "sweep", "revchain.sweep with out")
    folder = output.with_name(output.name + ".partial")

    def refused(number: int, reason: str) -> OutputError:
        return OutputError(number, reason, os.fspath(output))

    if output.exists() and not output.is_file():
        raise refused(errno.EISDIR, "is no file")
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with filelock.FileLock(folder / "lock", timeout=0):
            known, head = folder / "study.json", _head(study)
            if any(folder.glob(CHUNKS)) and not (known.is_file() and known.read_bytes() == head):
                reason = f"{folder} holds points of another study, or of another version; remove it or write elsewhere"
                raise refused(errno.EEXIST, reason)
            with written_aside(known) as [aside]:
                aside.write_bytes(head)
            yield folder
    except FileExistsError:
        raise refused(errno.EEXIST, f"{folder} is no folder") from None
    except filelock.Timeout:
        raise refused(errno.EAGAIN, "another run is writing it") from None


def _head(study: Study) -> bytes:
    """The data on which the results depend."""
    from .. import __version__

    texts = ("title", "description")
    data = {key: value for key, value in study.to_dict().items() if key not in texts}
    scene = {key: value for key, value in data["scene"].items() if key not in texts}
    return json.dumps({"revchain": __version__, "numpy": np.__version__, "study": {**data, "scene": scene}}).encode()


def _read_chunks(folder: Path, rows: Rows) -> None:
    """Read the finished chunks of an earlier run; those that cannot be read are removed."""
    for path in sorted(folder.glob(CHUNKS)):
        try:
            start, stop = map(int, path.stem.split("-"))
            with ZipFile(path) as entries:
                for name, array in rows.items():  # the status is the last one
                    array[start:stop] = whole_array(entries, f"{name}.npy")
        except WRONG as error:
            reason = f"{path} cannot be read, and its points are computed again: {error}"
            warnings.warn(reason.replace("\n", " "), stacklevel=3)
            path.unlink()


def _remove(folder: Path) -> None:
    """Remove our files (the chunks before the head) and the folder; other files stay, with a warning."""
    with suppress(OSError):
        for pattern in (CHUNKS, f".{CHUNKS}", ".study-*.json", "study.json", "lock"):
            for path in folder.glob(pattern):
                path.unlink()
        if others := sorted(path.name for path in folder.iterdir()):
            warnings.warn(f"{folder} stays: it holds other files, such as {others[0]}", stacklevel=3)
        else:
            folder.rmdir()


def check_output(path: str | os.PathLike[str], points: int) -> None:
    """Raise an error if an output cannot be written."""
    ending = Path(file_path(_CALLER, "the output", path)).suffix.lower()
    if ending not in PACKAGES:
        raise ValueError(f"{os.fspath(path)} must end in .csv, .parquet, .xlsx or .nc")
    if ending == ".xlsx" and points > MOST_LINES:
        raise ValueError(f"{os.fspath(path)}: a sheet has at most {MOST_LINES:,} rows, got {points:,} points; write .csv or .nc")
    for module in PACKAGES[ending]:
        require(module, "excel" if ending == ".xlsx" else "sweep", f"a {ending} file")


def write(found: Dataset, path: Path) -> None:
    if path.suffix.lower() == ".nc":
        h5netcdf, backends = (require(name, "sweep", "a .nc file") for name in ("h5netcdf", "xarray.backends"))
        with hdf5_file(path) as guarded, h5netcdf.File(guarded, "w") as target:
            found.dump_to_store(backends.H5NetCDFStore(target))
    elif path.suffix.lower() == ".xlsx":
        write_workbook(path, _pages(found), path)
    else:
        table = require("pyarrow", "sweep", "a table").table(columns(found)).replace_schema_metadata(found.attrs)
        if path.suffix.lower() == ".csv":
            require("pyarrow.csv", "sweep", "a .csv file").write_csv(table, path)
        else:
            require("pyarrow.parquet", "sweep", "a .parquet file").write_table(table, path)
    with open(path, "r+b") as file:
        os.fsync(file.fileno())  # before the chunks are removed


def _pages(found: Dataset) -> list[Page]:
    from .. import __version__

    study = json.loads(found.attrs["study"])
    rows = [("title", found.attrs["title"]), ("revchain", __version__), ("points", int(found["status"].size))]
    rows += [(f"vary {path}", json.dumps(values)) for path, values in study["vary"].items()]
    rows += [("study", found.attrs["study"])]
    about = Page("study", [Column("", [row[k] for row in rows], heading) for k, heading in enumerate(("what", "value"))])
    units = {str(name): str(found[name].attrs.get("units", "")) for name in found.variables}
    points = []
    for name, values in columns(found).items():
        of = max((known for known in units if name == known or name.startswith(f"{known}_")), key=len, default="")
        points.append(Column(name, values, unit=units.get(of, "")))
    return [about, Page("points", points)]


# ---- labelled arrays


def dataset(study: Study, plan: Plan, values: Values, rows: Rows) -> Dataset:
    coordinates: dict[str, Any] = {}
    data: dict[str, Any] = {}
    grids = [axis.name for axis in plan.axes if axis.values is not None]
    points = [*grids, *["sample"] * (len(grids) < len(plan.axes))]
    for axis, column in zip(plan.axes, values, strict=True):
        about = {"units": axis.unit, "path": axis.key} if axis.unit else {"path": axis.key}
        if axis.values is None:
            data[axis.name] = points, column.reshape(plan.shape), about
        else:
            coordinates[axis.name] = axis.name, axis.values, about
    for name, labels in plan.outputs.items():
        along = [OUTPUTS[name].along] * bool(labels)
        array = rows[name].reshape(*plan.shape, *[len(labels)] * len(along))
        for stored, (unit, of) in said(plan, name).items():
            data[stored] = [*points, *along], of(array), {"units": unit} if unit else {}
        coordinates |= {dimension: (dimension, np.array(labels)) for dimension in along}
    if study.scatter.worst:
        data |= worst_cases(plan, values)
    flags = {"flag_values": np.arange(1, 4, dtype=np.int8), "flag_meanings": " ".join(STATUS)}
    data["status"] = points, rows["status"].reshape(plan.shape), flags
    about = {"title": study.title, "study": json.dumps(study.to_dict())}
    if (asked := study._speed_unit()) is not None:
        about["speed_unit"] = asked
    found: Dataset = require("xarray", "sweep", _CALLER).Dataset(data, coordinates, about)
    return found


def columns(found: Dataset) -> dict[str, NDArray[Any]]:
    status = found["status"]
    table: dict[str, NDArray[Any]] = {"point": np.arange(status.size)}
    for name in [*(name for name in status.dims if name in found.coords), *found.data_vars]:
        array = found[name]
        along = [dimension for dimension in array.dims if dimension not in status.dims]
        for one in array.transpose(*along, ...) if along else [array]:
            label = f"_{one.coords[along[0]].item()}" if along else ""
            table[f"{name}{label}"] = one.broadcast_like(status).transpose(*status.dims).to_numpy().ravel()
    table["status"] = np.array(["", *STATUS])[table["status"]]
    return table
