# SPDX-License-Identifier: GPL-3.0-or-later
"""What all results share: fields computed when first read, equality, pickles, tables, files."""

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
    """One number, array or result: computed or read from the compiled result when it is first asked for, then kept.

    `part`: two results are equal when all their parts are, and a file holds all of them. Other fields follow from the
    parts; a file holds those that were computed.
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
        return kept.setdefault(self.name, found)  # two threads that compute it at once get the same

    def __set__(self, result: Result, value: object) -> None:
        raise AttributeError(f"a {type(result).__name__} cannot be changed: {self.name} was not set")


class Result(Unchangeable):
    """What a question returns. It cannot be changed and can be pickled; two are equal if all their parts are.

    A class says what it holds by `Field`s, how it is shown by `_sheet`, and by `_again` how the question is asked again
    where a file did not hold what is asked for.
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
        if cls.__module__.startswith("revchain."):  # a class of a caller must not take the place of ours
            Result._kinds[cls.__name__] = cls

    @classmethod
    def _made(cls, core: Any, **parts: Any) -> Self:
        """A result around a compiled one, and the parts that this does not hold."""
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
        """What it holds as columns; `brief`: those that a table for people shows."""
        raise NotImplementedError

    def _state(self) -> dict[str, Any]:
        """All parts, and what else was computed."""
        parts = {name: getattr(self, name) for name, field in self._fields.items() if field.part}
        return parts | {name: value for name, value in dict(self._kept).items() if name in self._fields}

    def to_dict(self) -> dict[str, Any]:
        """Return everything that the table is made of as plain Python data.

        Returns
        -------
        dict
            Ready for JSON, but for infinite numbers and NaN.
        """
        return as_dict(self._sheet())

    def to_dataframe(self) -> Any:
        """Return a pandas table with one row for each row of the result.

        Returns
        -------
        pandas.DataFrame

        Raises
        ------
        ImportError
            If pandas is not installed; the message says how to install it.
        """
        return as_dataframe(self._sheet())

    def to_xarray(self) -> Dataset:
        """Return everything as a labelled data set.

        Returns
        -------
        xarray.Dataset

        Raises
        ------
        ImportError
            If xarray is not installed; the message says how to install it.
        """
        return as_dataset(self._sheet())

    def save(self, path: str | os.PathLike[str]) -> None:
        """Write everything to a file, which `revchain.load` reads.

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
            (a ValueError too) If the file cannot be written. It is written aside and renamed: what was there before
            stays until the new file is whole.

        Notes
        -----
        What is loaded equals what was saved, bit for bit. No pickles inside.
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
        """How many of the results equal `value`."""
        return sum(value is item or (type(value) is type(item) and value == item) for item in self)

    def index(self, value: object, start: int = 0, stop: int | None = None) -> int:
        """The place of the first result that equals `value`, from `start` on and before `stop`."""
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


_HOLD = (np.ndarray, list, tuple)  # what may hold arrays that can be written to


def restored(kind: type[Result], state: dict[str, Any]) -> Result:
    """A result from its state."""
    return kind._made(None, **state)


def frozen(value: Any) -> Any:
    """`value`, its arrays read-only."""
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
