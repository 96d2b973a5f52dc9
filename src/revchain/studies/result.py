# SPDX-License-Identifier: GPL-3.0-or-later
"""The result of `revchain.sweep`."""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..results.base import Field, Result, frozen
from ..results.files import OutputError, naming, written_aside
from ..results.sheet import Column, Sheet, digits
from ..systems.extras import require
from ..systems.numbers import file_path, word
from . import store
from .plan import Plan
from .points import REFUSED, STATUS, Arrays
from .study import Study

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

MAX_SENTENCES = 20


@dataclass(frozen=True)
class Made:
    """A study, its plan, and the file of its results if they are not in memory."""

    study: Study
    plan: Plan
    path: Path | None = None
    written: tuple[int, int] = (0, 0)  # its size and time, to see whether it is still the same

    def read(self, status_alone: bool = False) -> Arrays:
        """The results from the file."""
        assert self.path is not None
        if not self.path.is_file() or stamp(self.path) != self.written:
            raise OutputError(2, "the results are gone: the file was changed or removed since", os.fspath(self.path))
        return store.read_back(self.path, self.plan, () if status_alone else self.plan.stored)


def stamp(path: Path) -> tuple[int, int]:
    """Size and time of a file."""
    found = path.stat()
    return found.st_size, found.st_mtime_ns


class SweepResult(Result):
    """All points of a study with their results; returned by `revchain.sweep`.

    ``result["angular_speed"]`` is an array whose first axis counts the points; the last grid varies faster than the
    others, and samples fastest. A second axis counts modes, shapes or speeds. ``result["links[0].mass"]`` has the values
    that varied. NaN (0 for whole numbers) stands for a missing result. The printed table shows the range of each column.

    Results of ``sweep(..., out=...)`` are read from that file when they are used.

    Examples
    --------
    >>> import revchain as rc
    >>> found = rc.sweep({
    ...     "scene": {"links": [{"mass": 1.0, "length": 0.5}]},
    ...     "vary": {"links[0].length": {"values": [0.25, 0.5, 1.0]}},
    ... })
    >>> found
    Study of 3 points
    column              least   median  largest
    links[0].length   0.25000  0.50000   1.0000
    angular_speed_1    3.1316   4.4287   6.2631
    conical_height_1  0.25000  0.50000   1.0000
    >>> found["conical_height"]
    array([[0.25],
           [0.5 ],
           [1.  ]])
    """

    __slots__ = ()
    _study: Field[str] = Field("The study as JSON.")
    _arrays: Field[dict[str, NDArray[Any]]] = Field(
        "Stored results of all points, by name.", lambda result: result._found().read(), part=True
    )
    resumed: Field[int] = Field("Number of points that an earlier, interrupted run had computed.", lambda r: 0)

    @classmethod
    def _of(cls, made: Made, **kept: Any) -> SweepResult:
        return cls._made(made, _study=json.dumps(made.study.to_dict()), **kept)

    def _from_parts(self) -> Made:
        study = Study.from_dict(json.loads(self._study))
        return Made(study, study._plan("study"))

    @property
    def study(self) -> Study:
        """The study."""
        return self._found().study  # type: ignore[no-any-return]

    @property
    def _plan(self) -> Plan:
        return self._found().plan  # type: ignore[no-any-return]

    def __len__(self) -> int:
        return self._plan.points

    @property
    def varied(self) -> list[str]:
        """Names of the varied numbers, in the order of the study."""
        return [axis.name for axis in self._plan.axes]

    @property
    def found(self) -> list[str]:
        """Names of the results."""
        return [block.name for block in self._plan.blocks]

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each grid, then the number of samples if numbers are random."""
        return self._plan.shape

    @property
    def status(self) -> NDArray[Any]:
        """Status of each point: ``success``, ``tolerance_not_met`` (a result is not proved) or ``refused``."""
        words: NDArray[Any] = np.array(STATUS)[self._one("status")]
        return words

    @property
    def refused(self) -> dict[int, str]:
        """Reasons why the first twenty refused points were refused, by point number."""
        points = np.flatnonzero(self._one("status") == REFUSED)[:MAX_SENTENCES].tolist()
        return {point: self._plan.refusal(point) for point in points}

    def count(self, status: str) -> int:
        """Return the number of points with a status.

        Parameters
        ----------
        status : {"success", "tolerance_not_met", "refused"}
            Status of a point.

        Returns
        -------
        int
            Number of points.

        Raises
        ------
        ValueError
            If there is no such status.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> vary = {"links[0].length": {"normal": ["1 m", "0.3 m"]}}
        >>> rc.sweep({"scene": scene, "vary": vary, "samples": 1000}).count("success")
        1000
        """
        known = word("revchain.SweepResult.count", "status", status, STATUS)
        return int(np.count_nonzero(self._one("status") == STATUS.index(known)))

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name == "status":
            return self.status
        if name not in [*self.varied, *self.found]:
            raise KeyError(f"there is no {name!r}; there are {', '.join([*self.varied, *self.found, 'status'])}")
        return self._one(name)

    def _one(self, name: str) -> NDArray[Any]:
        """An array by its name, the status as 0, 1, 2; computed or read on first use, then kept."""
        kept, made = self.__dict__, self._found()
        if name == "status" and "_arrays" not in kept:
            kept.setdefault("[status]", made.read(status_alone=True)["status"])
            return kept["[status]"]  # type: ignore[no-any-return]
        if name == "status" or name in [block.name for block in made.plan.stored]:
            return self._arrays[name]
        if (key := f"[{name}]") not in kept:
            if name in self.varied:
                found = made.plan.values(0, len(self))[self.varied.index(name)]
            else:
                found = made.plan.speeds(self._one("conical_height"), made.plan.values(0, len(self)))
            kept.setdefault(key, frozen(found))
        return kept[key]  # type: ignore[no-any-return]

    def columns(self) -> dict[str, NDArray[Any]]:
        """Return all data as columns of equal length, as in the files.

        Returns
        -------
        dict of str to ndarray
            The number of the point, the varied numbers, the results (``conical_height_1`` and so on), and the status.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> list(rc.sweep({"scene": scene, "vary": {"gravity": {"values": [1.62, 9.81]}}}).columns())
        ['point', 'gravity', 'angular_speed_1', 'conical_height_1', 'status']
        """
        pieces = {name: self._one(name) for name in [*self.varied, *self.found]}
        return {**store.columns_of(self._plan, pieces, 0, len(self)), "status": self.status}

    def to_xarray(self) -> xarray.Dataset:
        """Return a labelled data set with one dimension for each grid, and one for samples.

        Returns
        -------
        xarray.Dataset
            The data set.

        Raises
        ------
        ImportError
            If xarray is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> vary = {"gravity": {"values": [1.62, 9.81]}, "links[0].length": {"from": 1, "to": 2, "steps": 5}}
        >>> dict(rc.sweep({"scene": scene, "vary": vary}).to_xarray().sizes)  # doctest: +SKIP
        {'gravity': 2, 'links[0].length': 5, 'mode': 1}
        """
        dataset = require("xarray", "netcdf", "to_xarray").Dataset
        plan = self._plan
        data = {
            name: (dimensions, store.shaped(plan, name, self._one(name)), attributes)
            for name, (dimensions, attributes) in store.variables_of(plan).items()
        }
        return dataset(data, store.coordinates_of(plan), store.about(self.study))  # type: ignore[no-any-return]

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write all data to a file.

        Parameters
        ----------
        path : path-like
            Path that ends in ``.npz`` or ``.nc``, which `revchain.load` reads, or in ``.csv`` or ``.parquet``. The last two
            are tables for other programs, with a row for each point, as ``sweep(..., out=...)`` writes them.

        Raises
        ------
        ValueError
            If `path` has another ending.
        OSError
            If the file cannot be written (the error is also a ValueError).
        ImportError
            If a package for it is missing; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "moon.npz"
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> found = rc.sweep({"scene": scene, "vary": {"gravity": {"values": [1.62, 9.81]}}})
        >>> found.save(path)
        >>> rc.load(path) == found
        True
        """
        if Path(file_path("revchain.SweepResult.save", "path", path)).suffix.lower() not in (".csv", ".parquet"):
            return super().save(path)
        store.checked_ending(path)
        with naming(path), written_aside(path) as [aside]:
            store.write(aside, self.study, self._plan, partial(_pieces, self._arrays))

    def plot(self, name: str | None = None, ax: Axes | None = None) -> Axes:
        """Draw a result against the varied numbers.

        One grid gives curves, two grids a map of the first mode, random numbers histograms with percentiles. One grid
        with random numbers gives percentile bands, two grids with random numbers a map of medians.

        Parameters
        ----------
        name : str, optional
            Name of the result; the first one if left out.
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing.

        Raises
        ------
        ValueError
            If there are more than two grids, or words varied.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> found = rc.sweep({"scene": scene, "vary": {"links[0].length": {"from": 1, "to": 2, "steps": 5}}})
        >>> found.plot().get_xlabel()
        'links[0].length (m)'
        """
        from ..plots.sweep import plot_sweep

        return plot_sweep(self, name, ax)

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = self.columns()
        if not brief:
            facts = {"title": self.study.title, "study": self.study.to_dict()}
            return Sheet("point", "", [Column(name, values) for name, values in columns.items()], facts)
        names, ranges = [], []
        for name, values in list(columns.items())[1:-1]:
            there = values[np.isfinite(values)] if values.dtype.kind == "f" else values
            if there.size and values.dtype.kind in "fi":
                names.append(name)
                ranges.append([there.min(), np.median(there), there.max()])
        shown = [[digits(float(number), 5) for number in row] for row in ranges]
        table = [Column("column", names, "column", left=True)]
        for k, heading in enumerate(("least", "median", "largest")):
            table.append(Column(heading, [row[k] for row in ranges], heading, shown=[row[k] for row in shown]))
        counts = [f"{count:,} {what}" for what in STATUS[1:] if (count := self.count(what))]
        heading = f"Study of {len(self):,} point{'s' * (len(self) != 1)}{''.join(f', {each}' for each in counts)}"
        return Sheet("column", heading.replace("tolerance_not_met", "not proved"), table)


def _pieces(arrays: Arrays, size: int, names: list[str] | None = None) -> Any:
    """The stored results in pieces, from which a file is written."""
    wanted = list(arrays) if names is None else names
    for start in range(0, len(arrays["status"]), size):
        yield {name: arrays[name][start : start + size] for name in wanted}
