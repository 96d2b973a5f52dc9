# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of all results: fields computed when first read, equality, pickles, tables, files."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar, overload

import numpy as np

from ..systems.numbers import integer, read_only, shown
from ..systems.unchangeable import Unchangeable
from .sheet import Sheet, as_dataframe, as_dataset, as_dict, as_html, as_text

if TYPE_CHECKING:
    from xarray import Dataset

Item = TypeVar("Item")
Value = TypeVar("Value")


class Field(Generic[Value]):
    """One number, array or result of a result: computed (or read from the compiled result) on first use, then kept.

    Two results are equal if all fields with `part` are equal, and a file holds all of these. Other fields follow from
    them; a file holds those that were computed.
    """

    def __init__(self, doc: str, compute: Callable[[Any], Any] | None = None, *, part: bool = False) -> None:
        self.__doc__ = doc
        self.compute = compute
        self.part = part

    def __set_name__(self, owner: type[Result], name: str) -> None:
        self.name = name

    @overload
    def __get__(self, result: None, owner: type[Any]) -> Self: ...
    @overload
    def __get__(self, result: Any, owner: type[Any]) -> Value: ...
    def __get__(self, result: Any, owner: type[Any]) -> Any:
        if result is None:
            return self
        kept = result._kept
        if self.name in kept:
            return kept[self.name]
        found = frozen(self.compute(result) if self.compute else getattr(result._found(), self.name))
        return kept.setdefault(self.name, found)  # two threads that compute it at once get one object

    def __set__(self, result: Result, value: object) -> None:
        raise AttributeError(f"a {type(result).__name__} cannot be changed: {self.name} was not set")


class UnavailableError(AttributeError, ValueError):
    """The error of a field that some results of a class do not have; for `hasattr` they do not have it."""


class Result(Unchangeable):
    """The base of all results: immutable values that can be pickled; two are equal if all their parts are equal.

    A subclass lists its data as `Field`s. Its `_sheet` returns the table, and its `_again` repeats the question for a
    field that a file did not hold.
    """

    __slots__ = ("_core", "_kept")
    _core: Any
    _kept: dict[str, Any]
    _fields: ClassVar[dict[str, Field[Any]]] = {}
    _kinds: ClassVar[dict[str, type[Result]]] = {}

    def __init_subclass__(cls, **given: Any) -> None:
        super().__init_subclass__(**given)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Field)}
        cls._fields = {**cls._fields, **own}
        if cls.__module__.startswith("revchain."):  # a class of a caller must not replace one of ours
            Result._kinds[cls.__name__] = cls

    def __init__(self) -> None:
        raise TypeError(f"revchain.{type(self).__name__}: is what a question returns or revchain.load reads; call a question, such as revchain.modes")

    @classmethod
    def _made(cls, core: Any, **parts: Any) -> Self:
        """A result from a compiled one and the parts that the compiled one does not hold."""
        result = object.__new__(cls)
        _set(result, "_core", core)
        for name, value in parts.items():
            if type(value) in _HOLD:
                parts[name] = frozen(value)
        _set(result, "_kept", parts)
        return result

    def _found(self) -> Any:
        """The compiled result."""
        if self._core is None:
            _set(self, "_core", self._again())
        return self._core

    def _again(self) -> Any:
        raise NotImplementedError

    def _sheet(self, brief: bool = False) -> Sheet:
        """The data as columns; with `brief` only the columns that a printed table shows."""
        raise NotImplementedError

    def _state(self) -> dict[str, Any]:
        """All parts, and the other fields computed so far."""
        parts = {name: getattr(self, name) for name, field in self._fields.items() if field.part}
        return parts | {name: value for name, value in dict(self._kept).items() if name in self._fields}

    def to_dict(self) -> dict[str, Any]:
        """Return the data of the table as plain Python data.

        Returns
        -------
        dict
            The data. They can be written as JSON unless a number is infinite or NaN.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).to_dict()["modes"][0]["conical_height"]
        1.5
        """
        return as_dict(self._sheet())

    def to_dataframe(self) -> Any:
        """Return a pandas table with one row for each row of the result.

        Returns
        -------
        pandas.DataFrame
            The table, without columns of arrays.

        Raises
        ------
        ImportError
            If pandas is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).to_dataframe()["conical_height"].tolist()
        [1.5, 0.5]
        """
        return as_dataframe(self._sheet())

    def to_xarray(self) -> Dataset:
        """Return all data as a labelled data set.

        Returns
        -------
        xarray.Dataset
            The data set, with arrays of any number of axes.

        Raises
        ------
        ImportError
            If xarray is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).to_xarray()["shape"].shape
        (2, 3)
        """
        return as_dataset(self._sheet())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write the result to a file that `revchain.load` reads.

        Parameters
        ----------
        path : path-like
            Path that ends in ``.npz`` (needs numpy only) or ``.nc`` (netCDF 4, needs xarray and h5netcdf).

        Raises
        ------
        ValueError
            If the path has another ending.
        ImportError
            If a package for ``.nc`` is not installed; the message says how to install it.
        OSError
            If the file cannot be written (the error is also a ValueError). The data are first written to a temporary
            file, which is then renamed, so that an existing file stays until the new one is complete.

        Notes
        -----
        The loaded result equals the saved one bit for bit. The file contains no pickles.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "result.npz"
        >>> m = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0))
        >>> m.save(path)
        >>> rc.load(path) == m
        True
        """
        from .storage import save

        save(self, path)

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        return all(
            same(getattr(self, name), getattr(other, name)) for name, field in self._fields.items() if field.part
        )

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (type(self), self._state())

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __repr__(self) -> str:
        return as_text(self._sheet(brief=True))

    def _repr_html_(self) -> str:
        return as_html(self._sheet(brief=True))


class Listed(Sequence[Item]):
    """A sequence of the results in `_items`."""

    __slots__ = ()
    _items: Any

    @overload
    def __getitem__(self, index: int) -> Item: ...
    @overload
    def __getitem__(self, index: slice) -> tuple[Item, ...]: ...
    def __getitem__(self, index: int | slice) -> Any:
        return self._items[index]

    def __len__(self) -> int:
        return len(self._items)

    def __contains__(self, value: object) -> bool:
        return self.count(value) > 0

    def count(self, value: object) -> int:
        """Number of results equal to `value`."""
        return sum(value is item or (type(value) is type(item) and value == item) for item in self)

    def index(self, value: object, start: int = 0, stop: int | None = None) -> int:
        """Index of the first result equal to `value`, from `start` on and before `stop`."""
        place = f"{type(self).__name__}.index"
        ends = integer(place, "start", start), None if stop is None else integer(place, "stop", stop)
        for number in range(len(self))[slice(*ends)]:
            if value is self[number] or (type(value) is type(self[number]) and value == self[number]):
                return number
        raise ValueError(f"{place}: none of the {len(self)} results is {shown(value)}")

    def __iter__(self) -> Iterator[Item]:
        return iter(self._items)


class Results(Result, Listed[Item]):
    """A list of results, with fields of its own."""

    __slots__ = ()
    _items: Field[tuple[Any, ...]] = Field("The results.", part=True)


_set = object.__setattr__


_HOLD = (np.ndarray, list, tuple)  # types that may hold writable arrays


def restored(kind: type[Result], state: dict[str, Any]) -> Result:
    """The result of a class from its state."""
    return kind._made(None, **state)


def frozen(value: Any) -> Any:
    """`value` with its arrays made read-only."""
    if isinstance(value, np.ndarray):
        return read_only(value) if value.flags.writeable else value
    if type(value) in (list, tuple):
        return tuple(map(frozen, value))
    return {name: frozen(item) for name, item in value.items()} if type(value) is dict else value


def same(one: Any, other: Any) -> bool:
    """Whether two parts are equal, number for number; NaN equals NaN."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        kinds = (one.dtype, other.dtype) if isinstance(one, np.ndarray) and isinstance(other, np.ndarray) else None
        return kinds is not None and np.array_equal(one, other, equal_nan=kinds[0].kind in "fc")
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(item, other[name]) for name, item in one.items())
    return bool(one == other or (one != one and other != other))
