# SPDX-License-Identifier: GPL-3.0-or-later
"""What `revchain.modes` returns."""

from __future__ import annotations

import os
from collections.abc import Iterable
from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.chain import Chain
from ..systems.numbers import STANDARD_GRAVITY, Floats, Numbers, Whole, positive, read_only, together

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from xarray import Dataset

    from .sensitivity import Sensitivity, Uncertainty


TURN = 8 * np.arctan(np.longdouble(1))


@dataclass(frozen=True, slots=True, eq=False)
class Certificate:
    """Intervals that are proved to hold the conical heights, and the counts that prove it.

    Exactly ``above_lower[i]`` conical heights of the chain exceed ``lower[i]`` and ``above_upper[i]``
    exceed ``upper[i]``. As ``above_upper[i] < number[i] <= above_lower[i]``, the height with that number
    lies in between: ``lower < height <= upper``.

    Attributes
    ----------
    lower, upper : ndarray, shape (k,)
        Ends of the intervals, as far from the height as `Modes.error_bound` says, rounded. An end at
        which nothing could be proved is 0 or infinite.
    above_lower, above_upper : ndarray of int64, shape (k,)
        Proved counts of the heights above each end.
    lower_low, upper_low : ndarray, shape (k,), or None
        With ``precision="double-double"``: what is to be added to `lower` and `upper`.

    Notes
    -----
    `revchain.count_modes` gives the same counts at the very same numbers, in double precision. The
    heights are those of the numbers stored, with another precision those of the rounded ones.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[1.0, 3.0], length=1.0)
    >>> proof = rc.modes(chain, certify=True).certificate
    >>> proof.above_lower, proof.above_upper
    (array([1, 2]), array([0, 1]))
    >>> rc.count_modes(chain, conical_height=proof.lower)
    array([1, 2])
    """

    lower: Numbers
    upper: Numbers
    above_lower: Whole
    above_upper: Whole
    lower_low: Floats | None = None
    upper_low: Floats | None = None

    def __post_init__(self) -> None:
        _freeze(self)

    def __reduce__(self) -> tuple[Any, ...]:
        return Certificate, _values(self)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Certificate):
            return NotImplemented
        return all(map(_same, _values(self), _values(other)))

    __hash__ = None  # type: ignore[assignment]


class _Derived:
    """What is computed when first asked for: no field, and no part of what two results are compared by."""

    __slots__ = ("_sensitivity",)


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Modes(_Derived):
    """Modes of a chain, slowest first.

    Attributes
    ----------
    chain : Chain
        The chain of N links they belong to.
    number : ndarray of int64, shape (k,)
        Mode numbers: the slowest of all modes has number 1.
    conical_height : ndarray, shape (k,)
        Height ``gravity / angular_speed**2`` of the equivalent conical pendulum, descending, in the
        unit of the chain's lengths.
    error_bound : ndarray, shape (k,)
        Bound of the relative error of each conical height against the exact one of the numbers
        stored in `chain` (2 ulp by default, certified by counting).
    shape : ndarray, shape (k, N + 1), or None
        Offsets of the pins from the axis, free end first, support last (0); the largest magnitude
        is 1 and the free end positive.
    residual : ndarray, shape (k,), or None
        Residual of each shape, relative.
    nodes : list of k ndarrays, or None
        Distances from the free end, along the chain, where the mode crosses the axis; the support
        left out.
    method : str
        The method that was used.
    status : str
        ``"success"`` or ``"tolerance_not_met"``.
    precision : str
        As asked of `revchain.modes`, which says what it means for the arrays.
    certificate : Certificate or None
        What proves the error bounds, if ``certify=True`` was asked.
    conical_height_low : ndarray, shape (k,), or None
        With ``precision="double-double"``: what is to be added to `conical_height`, whose sum
        `error_bound` is of.

    Notes
    -----
    Arrays are read-only. Two results are equal when everything in them is. `shape`, `residual` and
    `nodes` are None if ``shapes=False`` was asked. There may be no modes (k = 0) in a window.

    Examples
    --------
    >>> import revchain as rc
    >>> result = rc.modes(rc.Chain.uniform_plummets(2, length=2.0))
    >>> result.shape.round(4)
    array([[ 1.    ,  0.4142,  0.    ],
           [ 0.4142, -1.    ,  0.    ]])
    >>> [nodes.round(4).tolist() for nodes in result.nodes]
    [[], [0.2929]]
    """

    chain: Chain
    number: Whole
    conical_height: Numbers
    error_bound: Numbers
    shape: Numbers | None
    residual: Numbers | None
    nodes: list[Numbers] | None
    method: str
    status: str
    precision: str = "double"
    certificate: Certificate | None = None
    conical_height_low: Floats | None = None

    def __post_init__(self) -> None:
        _freeze(self)
        if self.nodes is not None and any(nodes.flags.writeable for nodes in self.nodes):
            object.__setattr__(self, "nodes", [read_only(nodes) for nodes in self.nodes])

    def __reduce__(self) -> tuple[Any, ...]:
        return Modes, _values(self)

    def __len__(self) -> int:
        return int(self.conical_height.size)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Modes):
            return NotImplemented
        return all(map(_same, _values(self), _values(other)))

    __hash__ = None  # type: ignore[assignment]

    def angular_speed(self, gravity: ArrayLike = STANDARD_GRAVITY) -> Numbers:
        """Return the whirl speed of each mode, ``sqrt(gravity / conical_height)``.

        Parameters
        ----------
        gravity : array_like, optional
            Acceleration of gravity in the unit of length per s^2; standard gravity, in metres, if
            left out. Broadcasts against shape (k,).

        Returns
        -------
        ndarray, shape (k,)
            In rad/s, ascending; longdouble with ``precision="extended"``, else float64. Relative error
            at most half of `error_bound` and 2.1 ulp.

        Raises
        ------
        ValueError
            If gravity is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=1.0, length=2.4525)).angular_speed(gravity=9.81)
        array([2.])
        """
        height, g = self._with_gravity("angular_speed", gravity)
        if self.precision == "extended":
            extended: Numbers = np.sqrt(g) / np.sqrt(height)
            return extended
        return _core.conical_pendulum_angular_speed(height, g)

    def period(self, gravity: ArrayLike = STANDARD_GRAVITY) -> Numbers:
        """Return the time of one turn of each mode, ``2 pi sqrt(conical_height / gravity)``.

        Parameters
        ----------
        gravity : array_like, optional
            As for `angular_speed`.

        Returns
        -------
        ndarray, shape (k,)
            In seconds, descending. Relative error at most half of `error_bound` and 2.1 ulp.

        Raises
        ------
        ValueError
            If gravity is not positive and finite.

        Notes
        -----
        Greenhill (1908) section 1 (2).

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=1.0, length=39.1396)).period(gravity=386.2924).round(5)
        array([2.])
        """
        height, g = self._with_gravity("period", gravity)
        if self.precision == "extended":
            extended: Numbers = TURN * (np.sqrt(height) / np.sqrt(g))
            return extended
        return _core.conical_pendulum_period(height, g)

    def revolutions_per_second(self, gravity: ArrayLike = STANDARD_GRAVITY) -> Numbers:
        """Return the turns in a second of each mode.

        Parameters
        ----------
        gravity : array_like, optional
            As for `angular_speed`.

        Returns
        -------
        ndarray, shape (k,)
            In 1/s, ascending. Relative error at most half of `error_bound` and 2.1 ulp.

        Raises
        ------
        ValueError
            If gravity is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain.uniform_rods(120, length=0.36), count=2).revolutions_per_second().round(4)
        array([0.9988, 2.2928])
        """
        height, g = self._with_gravity("revolutions_per_second", gravity)
        if self.precision == "extended":
            extended: Numbers = np.sqrt(g) / np.sqrt(height) / TURN
            return extended
        return _core.conical_pendulum_revolutions_per_second(height, g)

    @property
    def sensitivity(self) -> Sensitivity:
        """Derivatives of every conical height with respect to every datum of every link.

        Computed when first asked for, from the heights alone: about 2 microseconds a link and mode, O(N k) memory.
        They are those of the numbers stored in `chain`, in double precision whatever the modes' own.

        Returns
        -------
        Sensitivity

        Raises
        ------
        ValueError
            If the chain's weights are more than 1e123 apart.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain.uniform_rods(2)).sensitivity.relative.length_in_proportion.round(4)
        array([[0.4055, 0.5945],
               [0.5945, 0.4055]])
        """
        found: Sensitivity | None = getattr(self, "_sensitivity", None)
        if found is None:
            from .sensitivity import of_modes

            found = of_modes(self)
            object.__setattr__(self, "_sensitivity", found)
        return found

    def uncertainty(
        self,
        *,
        weight: ArrayLike | None = None,
        length: ArrayLike | None = None,
        centroid: ArrayLike | None = None,
        radius_of_gyration: ArrayLike | None = None,
        length_in_proportion: ArrayLike | None = None,
    ) -> Uncertainty:
        """Return how uncertain conical heights and speeds are where the data are.

        Parameters
        ----------
        weight, length, centroid, radius_of_gyration, length_in_proportion : array_like, optional
            Standard deviation of each: one number for all links, shape (N,) one for each, or shape (N, N) the
            covariance of the links (its diagonal variances, not deviations). Left out: exactly known. What is
            held while one changes: see `Sensitivity`. Deviations of different links are independent unless a
            covariance says otherwise, those of different quantities always.

        Returns
        -------
        Uncertainty

        Raises
        ------
        ValueError
            For deviations that are negative or not finite, other shapes, a covariance that is not symmetric.

        Notes
        -----
        First order: heights are taken as linear in the data. Where a derivative is all but 0, or a deviation a
        large part of its datum, sample instead.

        Examples
        --------
        A thread known to 1 per cent gives the speed to half a per cent:

        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=1.0, length=2.0)).uncertainty(length_in_proportion=0.02).relative
        array([0.01])
        """
        from .sensitivity import uncertainty

        given = {
            "weight": weight,
            "length": length,
            "centroid": centroid,
            "radius_of_gyration": radius_of_gyration,
            "length_in_proportion": length_in_proportion,
        }
        return uncertainty(self, given)

    def plot(
        self,
        ax: Axes | None = None,
        modes: Iterable[int] | None = None,
        *,
        gravity: float = STANDARD_GRAVITY,
        length_unit: str = "m",
    ) -> Axes:
        """Draw the shapes side by side, each hanging from its own axis.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        modes : iterable of int, optional
            Which modes, by their numbers; the six slowest of this result if left out.
        gravity : float, optional
            For the speeds written below the axes.
        length_unit : str
            What to write on the axis of depth.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If there are no shapes, or `modes` names one that is not there.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> ax = rc.modes(rc.Chain.uniform_rods(120, length=0.36), count=4).plot()
        >>> ax.get_ylabel()
        'depth below the support (m)'
        """
        from ..plots.style import plot_modes

        return plot_modes(self, ax, modes, gravity=gravity, length_unit=length_unit)

    def to_dict(self, gravity: float = STANDARD_GRAVITY, shapes: bool = True) -> dict[str, Any]:
        """Return everything as plain Python numbers, lists and strings, ready for JSON.

        Parameters
        ----------
        gravity : float, optional
            For speeds and periods.
        shapes : bool
            Whether to include the shapes, which are long.

        Returns
        -------
        dict
            ``{"modes": [{"mode": 1, "conical_height": ..., "angular_speed": ..., "period": ...,
            "revolutions_per_minute": ..., "error_bound": ..., "nodes": [...], "residual": ...,
            "shape": [...]}, ...], "method": ..., "status": ..., "precision": ..., "gravity": ...,
            "chain": {...}}``;
            what was not computed is left out. ``"conical_height_low"`` is added to the height where
            a float is too short for it, ``"certificate"`` where there is one.

        Raises
        ------
        ValueError
            If gravity is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).to_dict()["modes"][0]["conical_height"]
        1.5
        """
        from .record import to_dict

        return to_dict(self, gravity, shapes)

    def to_xarray(self) -> Dataset:
        """Return everything as a labelled data set.

        Returns
        -------
        xarray.Dataset
            Variables over the dimensions ``mode`` (its number), ``pin`` (from the free end), ``link``
            (lowest first) and ``node`` (padded with NaN).

        Raises
        ------
        ImportError
            If xarray is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> data = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).to_xarray()
        >>> float(data.conical_height.sel(mode=2))
        0.5
        """
        from .record import to_xarray

        return to_xarray(self)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything to a file, to be read again by `revchain.load`.

        Parameters
        ----------
        path : path-like
            Ends in ``.npz`` (numpy alone) or ``.nc`` (netCDF 4, needs xarray and h5netcdf).

        Raises
        ------
        ValueError
            If the path has another ending.
        ImportError
            If what ``.nc`` needs is not installed; the message says how to install it.
        OSError
            (a ValueError too) If the file cannot be written. It is written aside and renamed: what
            was there before stays until the new file is whole.

        Notes
        -----
        Nothing is rounded: what is loaded equals what was saved, bit for bit. No pickles inside.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "result.npz"
        >>> rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).save(path)
        >>> rc.load(path).conical_height
        array([1.5, 0.5])
        """
        from .storage import save

        save(self, path)

    def _with_gravity(self, name: str, gravity: ArrayLike) -> tuple[Numbers, Numbers]:
        place = f"revchain.Modes.{name}"
        wide = np.longdouble if self.precision == "extended" else np.float64
        height = self.conical_height.astype(wide, copy=False)
        g = positive(place, "gravity", gravity).astype(wide, copy=False)
        height, g = together(place, conical_height=height, gravity=g)
        return height, g

    def __repr__(self) -> str:
        from .tables import text_table

        return text_table(self)

    def _repr_html_(self) -> str:
        from .tables import html_table

        return html_table(self)


def _values(record: Certificate | Modes) -> tuple[Any, ...]:
    return tuple(getattr(record, field.name) for field in fields(record))


def _freeze(record: Certificate | Modes) -> None:
    """Make the arrays read-only that are not."""
    for name in record.__slots__:
        value = getattr(record, name)
        if isinstance(value, np.ndarray) and value.flags.writeable:
            object.__setattr__(record, name, read_only(value))


def _same(one: Any, other: Any) -> bool:
    """Whether two fields are equal, number for number."""
    if isinstance(one, list) and isinstance(other, list):
        return len(one) == len(other) and all(map(_same, one, other))
    if isinstance(one, np.ndarray) and isinstance(other, np.ndarray):
        return np.array_equal(one, other, equal_nan=True)
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        return False
    return bool(one == other)
