# SPDX-License-Identifier: GPL-3.0-or-later
"""What `revchain.sweep` returns."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ..systems.numbers import boolean, read_only, word
from .find import REFUSED, STATUS, Arrays
from .plan import Plan
from .study import Study

if TYPE_CHECKING:
    import xarray
    from matplotlib.axes import Axes

MOST_SENTENCES = 20


class SweepResult:
    """All points of a study and what was found there; made by `revchain.sweep`.

    ``result["angular_speed"]`` is an array whose first axis counts the points, grids with the last fastest, samples
    faster still; ``result["links[0].mass"]`` is what varied. Of modes, shapes and speeds a second axis counts these.
    NaN, or 0 of whole numbers, stands where a point has nothing of the kind.

    Attributes
    ----------
    study : Study

    Examples
    --------
    >>> import revchain as rc
    >>> found = rc.sweep({
    ...     "scene": {"links": [{"mass": 1.0, "length": 0.5}]},
    ...     "vary": {"links[0].length": {"values": [0.25, 1.0]}},
    ... })
    >>> found
    SweepResult: 2 points of links[0].length; angular_speed, conical_height
    >>> found["conical_height"]
    array([[0.25],
           [1.  ]])
    """

    study: Study
    _plan: Plan
    _arrays: Arrays
    _status: NDArray[np.uint8]
    _resumed: int
    _damage: str

    @classmethod
    def _of(cls, study: Study, plan: Plan, stored: Arrays) -> SweepResult:
        """With arrays for all points, of what is computed and of the status."""
        result = cls.__new__(cls)
        result.study, result._plan, result._resumed, result._damage = study, plan, 0, ""
        result._arrays = {name: array for name, array in stored.items() if name != "status"}
        result._status = stored["status"]
        return result

    def __len__(self) -> int:
        return self._plan.points

    @property
    def resumed(self) -> int:
        """How many of the points were there already, from a run that was ended."""
        return self._resumed

    @property
    def damage(self) -> str:
        """What was damaged of the points kept from a run that was ended, and computed again; empty if nothing was."""
        return self._damage

    @property
    def varied(self) -> list[str]:
        """Names of what varied, in the order of the study."""
        return [axis.name for axis in self._plan.axes]

    @property
    def found(self) -> list[str]:
        """Names of what was found."""
        return [block.name for block in self._plan.blocks]

    @property
    def shape(self) -> tuple[int, ...]:
        """How many values each grid has, and, where numbers are random, how many samples."""
        return self._plan.shape

    @property
    def status(self) -> NDArray[Any]:
        """Of each point: ``success``, ``tolerance_not_met`` (something is not proved) or ``refused``."""
        return np.array(STATUS)[self._status]

    @property
    def refused(self) -> dict[int, str]:
        """Sentences for points that their scenes refuse, by their numbers: the first twenty."""
        points = np.flatnonzero(self._status == REFUSED)[:MOST_SENTENCES].tolist()
        return {point: self._plan.refusal(point) for point in points}

    def count(self, status: str) -> int:
        """Count the points with a status.

        Parameters
        ----------
        status : {"success", "tolerance_not_met", "refused"}

        Returns
        -------
        int

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
        return int(np.count_nonzero(self._status == STATUS.index(known)))

    def __getitem__(self, name: str) -> NDArray[Any]:
        if name in self._arrays:
            return read_only(self._arrays[name])
        if name == "status":
            return self.status
        if name in self.varied:
            self._fill_varied()
        elif name == "angular_speed" and name in self.found:
            self._arrays[name] = self._speeds()
        else:
            known = ", ".join([*self.varied, *self.found, "status"])
            raise KeyError(f"there is no {name!r}; there are {known}")
        return read_only(self._arrays[name])

    def _speeds(self) -> NDArray[np.float64]:
        if "gravity" in [axis.key for axis in self._plan.axes]:
            self._fill_varied()
        values = [self._arrays.get(axis.name, np.empty(0)) for axis in self._plan.axes]
        return self._plan.speeds(self._arrays["conical_height"], values)

    def _fill_varied(self) -> None:
        values = self._plan.values(0, self._plan.points)
        self._arrays.update(zip(self.varied, values, strict=True))

    def columns(self, words: bool = True) -> dict[str, NDArray[Any]]:
        """Return everything as columns of equal length, as the tables have them.

        Parameters
        ----------
        words : bool
            Whether the status is said in words, or else as 0, 1, 2 in their order.

        Returns
        -------
        dict of str to ndarray
            The point's number, what varied, what was found (``conical_height_1`` and on), the status.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> list(rc.sweep({"scene": scene, "vary": {"gravity": {"values": [1.62, 9.81]}}}).columns())
        ['point', 'gravity', 'angular_speed_1', 'conical_height_1', 'status']
        """
        from .output import columns_of

        pieces = {name: self[name] for name in [*self.varied, *self.found]}
        columns = columns_of(self._plan, {**pieces, "status": self._status}, 0, len(self))
        in_words = boolean("revchain.SweepResult.columns", "words", words)
        return {**columns, "status": self.status} if in_words else columns

    def to_dataframe(self) -> Any:
        """Return a pandas table with one row for each point.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        ImportError
            If pandas is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> found = rc.sweep({"scene": scene, "vary": {"gravity": {"values": [1.62, 9.81]}}})
        >>> found.to_dataframe().shape  # doctest: +SKIP
        (2, 5)
        """
        from .output import dataframe_of

        return dataframe_of(self)

    def to_xarray(self) -> xarray.Dataset:
        """Return a labelled dataset with one dimension for each grid, and one for samples.

        Returns
        -------
        xarray.Dataset

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
        from .output import dataset_of

        dataset: xarray.Dataset = dataset_of(self)
        return dataset

    def save(self, path: str) -> None:
        """Write everything to a file.

        Parameters
        ----------
        path : path-like
            Ends in ``.csv``, ``.parquet`` or ``.nc``.

        Raises
        ------
        ValueError
            If `path` ends otherwise.
        OSError
            If it cannot be written.
        ImportError
            If a package for it is missing; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> rc.sweep({"scene": scene, "vary": {"gravity": {"values": [1.62, 9.81]}}}).save("moon.csv")
        """
        from ..results.files import naming, written_aside
        from .output import write_all, writer_of

        writer = writer_of(path)
        stored = {block.name: self._arrays[block.name] for block in self._plan.stored}
        with naming(path), written_aside(path) as [aside]:
            write_all(writer(aside, self.study, self._plan), self._plan, {**stored, "status": self._status})

    def plot(self, name: str | None = None, ax: Axes | None = None) -> Axes:
        """Draw what was found against what varied: one number as curves, two grids as a map of the first.

        Three or more numbers that are all random give a histogram: how what was found scatters about its mean.

        Parameters
        ----------
        name : str, optional
            Of what was found; whatever comes first if left out.
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If more than two numbers varied and not all are random, or if words varied.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 0.5}]}
        >>> found = rc.sweep({"scene": scene, "vary": {"links[0].length": {"from": 1, "to": 2, "steps": 5}}})
        >>> found.plot().get_xlabel()
        'links[0].length'
        """
        from ..plots.sweep import plot_sweep

        return plot_sweep(self, name, ax)

    def __repr__(self) -> str:
        refused = f"; {count:,} refused" if (count := self.count("refused")) else ""
        damage = f"; {self.damage}" if self.damage else ""
        found = ", ".join(self.found)
        return f"SweepResult: {len(self):,} points of {', '.join(self.varied)}; {found}{refused}{damage}"
