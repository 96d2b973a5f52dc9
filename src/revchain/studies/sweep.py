# SPDX-License-Identifier: GPL-3.0-or-later
"""Computation of all points of a study by threads or any executor, in chunks that are stored on disk."""

from __future__ import annotations

import errno
import json
import os
import time
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ThreadPoolExecutor, wait
from contextlib import ExitStack, contextmanager, suppress
from itertools import islice
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..results.files import OutputError, hdf5_file, naming, written_aside
from ..systems.extras import require
from ..systems.numbers import count as checked_count
from ..systems.numbers import file_path, shown
from .axes import BLOCK
from .plan import STATUS, Plan, Rows
from .study import Study, load_study

if TYPE_CHECKING:
    from xarray import Dataset

_PLACE = "revchain.sweep"
_SECONDS = 0.5  # of work in a chunk, or a hundredth of the time so far: this gives hundreds of files, not millions
_IN_FLIGHT = 3  # chunks for each worker
CHUNKS = "[0-9]*-[0-9]*.bin"
PACKAGES = {".csv": ["pyarrow.csv"], ".parquet": ["pyarrow.parquet"], ".nc": ["h5py", "h5netcdf"]}


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
        File for the results: ``.nc`` (netCDF, which xarray reads), or a table with a row for each point, ``.csv`` or
        ``.parquet``. It is written when all points are done. Until then finished chunks are stored in the folder
        ``OUT.partial`` beside it. After an interruption or a kill, the same call continues without recomputing finished
        chunks.
    executor : concurrent.futures.Executor, optional
        Executor for the chunks, such as a ``ProcessPoolExecutor``, or ``client.get_executor()`` of a Dask cluster; threads
        if left out. It is not shut down.
    workers : int, optional
        Number of threads, or of workers of the executor; one for each processor if left out.
    chunk : int, optional
        Number of points that are computed and stored together; about half a second of work if left out.
    progress : callable, optional
        Function that is called repeatedly with the number of finished points and the number of all points.

    Returns
    -------
    xarray.Dataset
        The results by name, with SI units in ``attrs["units"]``. There is one dimension for each grid, one named
        ``sample`` for random numbers, and one for modes, shapes or speeds. NaN (0 for whole numbers) stands for a
        missing result. The variable ``status`` is 1 for success, 2 if a result is not proved, 3 for a refused point.
        The numbers are bitwise equal for any executor, number of workers and chunk.

    Raises
    ------
    SceneError
        If the study is not valid.
    OSError
        If `out` cannot be written, another run is writing it, or its partial folder has points of another study (the error
        is also a ValueError). Finished chunks stay.
    ValueError
        If `out` has another extension, or a number is below 1.
    ImportError
        If xarray or a package that writes `out` is missing; the message says how to install it.

    Warns
    -----
    UserWarning
        If a stored chunk cannot be read; its points are computed again.

    Notes
    -----
    Chains of up to 100 links whose numbers are proportional to the varied ones go to `revchain.conical_heights`
    together. All other points are solved by the methods of `Scene`. A point that its scene refuses has no numbers;
    `Study.scene_at` raises the error with the reason. Cost: 10 to 50 ns a point beside `conical_heights`, 0.1 to 1 ms
    beside the methods of `Scene`.

    Examples
    --------
    >>> import revchain as rc
    >>> found = rc.sweep({
    ...     "scene": {"links": [{"mass": 1.0, "length": 0.5, "kind": "rod"}], "support": {"stiffness": 50.0}},
    ...     "vary": {"support.stiffness": {"from": "10 N/m", "to": "1 kN/m", "steps": 3, "log": True}},
    ... })
    >>> found["forward_angular_speed"].sel(mode=1).to_numpy().round(4)
    array([2.8026, 4.8815, 5.3647])
    """
    if isinstance(study, dict):
        study = Study.from_dict(study)
    elif not isinstance(study, Study):
        study = load_study(study)
    if executor is not None and not callable(getattr(executor, "submit", None)):
        raise TypeError(f"{_PLACE}: executor must be a concurrent.futures.Executor, got {shown(executor)}")
    if progress is not None and not callable(progress):
        raise TypeError(f"{_PLACE}: progress must be a function of two numbers, got {shown(progress)}")
    chunk = None if chunk is None else checked_count(_PLACE, "chunk", chunk)
    workers = _processors() if workers is None else checked_count(_PLACE, "workers", workers)
    require("xarray", "sweep", _PLACE)
    if out is not None:
        checked_ending(out)
    plan = study._plan("study")
    with ExitStack() as stack:
        run = _Run(plan, progress)
        if out is not None:
            output = Path(os.path.realpath(out))
            stack.enter_context(naming(output))
            run.folder = stack.enter_context(_folder(output, _head(study)))
            run.read_chunks()
        pool = executor or stack.enter_context(ThreadPoolExecutor(workers, thread_name_prefix="revchain-sweep"))
        run.compute(pool, workers, chunk, in_place=executor is None)
        found = dataset(study, plan, run.rows)
        if run.folder is not None:
            with written_aside(output) as [aside]:
                write(found, aside)
            _remove(run.folder)
    return found


class _Run:
    """The computation of the missing points, in chunks."""

    def __init__(self, plan: Plan, told: Callable[[int, int], None] | None) -> None:
        self.plan = plan
        self.rows = plan.zeros(plan.points)
        self.folder: Path | None = None
        self.done = 0
        self._told = told
        self._began = time.perf_counter()

    def read_chunks(self) -> None:
        """Read the finished chunks of an earlier run; those that cannot be read are removed."""
        assert self.folder is not None
        for path in sorted(self.folder.glob(CHUNKS)):
            try:
                self._read(path, *map(int, path.stem.split("-")))
            except (ValueError, TypeError, OSError) as error:
                reason = f"{path} cannot be read, and its points are computed again: {error}"
                warnings.warn(reason.replace("\n", " "), stacklevel=3)
                path.unlink()
        self.done = int(np.count_nonzero(self.rows["status"]))

    def _read(self, path: Path, start: int, stop: int) -> None:
        """Read the numbers of a chunk, which follow one another as in memory."""
        part = {name: array[start:stop] for name, array in self.rows.items()}
        size = sum(part[name].nbytes for name in self.plan.stored)
        if not 0 <= start < stop <= self.plan.points or path.stat().st_size != size:
            raise ValueError("it has another size")
        with open(path, "rb") as file:
            for name in self.plan.stored:
                file.readinto(part[name].data)
        if not part["status"].all():
            part["status"][:] = 0
            raise ValueError("a point has no status")
        self.plan.derive(part, self.plan.values(start, stop))

    def compute(self, pool: Executor, workers: int, fixed: int | None, in_place: bool) -> None:
        """Compute all missing chunks, a few at a time, so that few finished ones wait to be stored."""
        pending: set[Future[tuple[int, Rows, float]]] = set()
        self._size = fixed or (BLOCK if self.plan.links is not None else 16)
        chunks = self._chunks()
        self._tell()
        try:
            while True:
                for start, stop in islice(chunks, _IN_FLIGHT * workers - len(pending)):
                    rows = {name: array[start:stop] for name, array in self.rows.items()} if in_place else None
                    pending.add(pool.submit(_solved, self.plan, start, stop, rows))
                if not pending:
                    return
                ready, pending = wait(pending, return_when=FIRST_COMPLETED)
                for future in ready:
                    start, found, seconds = future.result()
                    count = self._take(start, found)
                    if fixed is None and self.plan.links is None:
                        wanted = max(_SECONDS, (time.perf_counter() - self._began) / 100)
                        self._size = max(int(min(wanted / max(seconds, 1e-9) * count, 4 * self._size, BLOCK)), 1)
        finally:
            for future in pending:
                future.cancel()

    def _chunks(self) -> Iterator[tuple[int, int]]:
        """The ends of chunks of points without results."""
        ends = np.flatnonzero(np.diff(np.concatenate([[True], self.rows["status"] != 0, [True]])))
        for start, stop in ends.reshape(-1, 2).tolist():
            while start < stop:
                end = min(start + self._size, stop)
                yield start, end
                start = end

    def _take(self, start: int, found: Rows) -> int:
        """Store the results of a chunk; return the number of its points."""
        stop = start + len(found["status"])
        if self.folder is not None:
            with written_aside(self.folder / f"{start:013}-{stop:013}.bin") as [aside], open(aside, "wb") as file:
                for name in self.plan.stored:
                    file.write(found[name].data)
        for name, array in found.items():
            if array.base is not self.rows[name]:
                self.rows[name][start:stop] = array
        self.done += stop - start
        self._tell()
        return stop - start

    def _tell(self) -> None:
        if self._told is not None:
            self._told(self.done, self.plan.points)


def _solved(plan: Plan, start: int, stop: int, rows: Rows | None) -> tuple[int, Rows, float]:
    """The work of a worker: first point, results and time in seconds of a chunk."""
    began = time.perf_counter()
    return start, plan.solved(start, stop, rows), time.perf_counter() - began


def _processors() -> int:
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


# ---- files


def checked_ending(path: str | os.PathLike[str]) -> str:
    """The ending of an output; a missing package that writes it is an error at once."""
    ending = Path(file_path(_PLACE, "the output", path)).suffix.lower()
    if ending not in PACKAGES:
        raise ValueError(f"{os.fspath(path)} must end in .csv, .parquet or .nc")
    for module in PACKAGES[ending]:
        require(module, "sweep", f"a {ending} file")
    return ending


def _head(study: Study) -> dict[str, Any]:
    """The data on which the results depend."""
    from .. import __version__

    texts = ("title", "description")
    data = {key: value for key, value in study.to_dict().items() if key not in texts}
    scene = {key: value for key, value in data["scene"].items() if key not in texts}
    return {"revchain": __version__, "numpy": np.__version__, "study": {**data, "scene": scene}}


@contextmanager
def _folder(output: Path, head: dict[str, Any]) -> Iterator[Path]:
    """Yield the locked folder ``OUT.partial`` with the finished chunks of this study; remove it at the end if empty."""
    filelock = require("filelock", "sweep", "revchain.sweep with out")
    folder = output.with_name(output.name + ".partial")

    def refused(number: int, reason: str) -> OutputError:
        return OutputError(number, reason, os.fspath(output))

    if output.exists() and not output.is_file():
        raise refused(errno.EISDIR, "is no file")
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except FileExistsError:
        raise refused(errno.EEXIST, f"{folder} is no folder") from None
    known = folder / "study.json"
    if not known.exists() and any(path.name != "lock" for path in folder.iterdir()):
        raise refused(errno.EEXIST, f"{folder} holds other files; remove it or write elsewhere")
    try:
        lock = filelock.FileLock(folder / "lock", timeout=0).acquire()
    except filelock.Timeout:
        raise refused(errno.EAGAIN, "another run is writing it") from None
    with lock:
        is_ours = False
        try:
            if not known.exists():
                with written_aside(known) as [aside]:
                    aside.write_text(json.dumps(head), encoding="utf-8")
            with suppress(ValueError, RecursionError):
                is_ours = json.loads(known.read_text(encoding="utf-8")) == json.loads(json.dumps(head))
            if not is_ours:
                reason = f"{folder} holds points of another study, or of another version; remove it or write elsewhere"
                raise refused(errno.EEXIST, reason)
            yield folder
        finally:
            if known.exists() and is_ours and not any(folder.glob(CHUNKS)):
                _remove(folder)


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


def write(found: Dataset, path: Path) -> None:
    """Write the results as netCDF or as a table."""
    if path.suffix.lower() == ".nc":
        h5netcdf, backends = (require(name, "sweep", "a .nc file") for name in ("h5netcdf", "xarray.backends"))
        with hdf5_file(path) as guarded, h5netcdf.File(guarded, "w") as target:
            found.dump_to_store(backends.H5NetCDFStore(target))
    else:
        table = require("pyarrow", "sweep", "a table").table(columns(found)).replace_schema_metadata(found.attrs)
        if path.suffix.lower() == ".csv":
            require("pyarrow.csv", "sweep", "a .csv file").write_csv(table, path)
        else:
            require("pyarrow.parquet", "sweep", "a .parquet file").write_table(table, path)
    with open(path, "r+b") as file:
        os.fsync(file.fileno())  # before the chunks are removed


# ---- labelled arrays


def dataset(study: Study, plan: Plan, rows: Rows) -> Dataset:
    """The results as an xarray data set."""
    random = [axis for axis in plan.axes if axis.values is None]
    grids = [axis for axis in plan.axes if axis.values is not None]
    points = [axis.name for axis in grids] + ["sample"] * bool(random)
    coordinates: dict[str, Any] = {axis.name: (axis.name, axis.values, _about(axis.unit, axis.key)) for axis in grids}
    data: dict[str, Any] = {}
    for axis in random:
        data[axis.name] = points, rows[axis.name].reshape(plan.shape), _about(axis.unit, axis.key)
    for block in plan.blocks:
        dimensions = [*points, block.along] if block.along else points
        data[block.name] = dimensions, rows[block.name].reshape(*plan.shape, *block.each), _about(block.unit)
        if block.along:
            coordinates[block.along] = block.along, np.array(block.labels)
    flags = {"flag_values": np.arange(1, 4, dtype=np.int8), "flag_meanings": " ".join(STATUS)}
    data["status"] = points, rows["status"].reshape(plan.shape), flags
    about = {"title": study.title, "study": json.dumps(study.to_dict())}
    found: Dataset = require("xarray", "sweep", _PLACE).Dataset(data, coordinates, about)
    return found


def _about(unit: str, path: str = "") -> dict[str, str]:
    return {name: text for name, text in (("units", unit), ("path", path)) if text}


def columns(found: Dataset) -> dict[str, NDArray[Any]]:
    """The results as columns with a row for each point: its number, the varied numbers, the results, the status."""
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
