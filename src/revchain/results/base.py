# SPDX-License-Identifier: GPL-3.0-or-later
"""The base of all results: fields computed when first read, equality, pickles, tables, files."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Iterator, Sequence
from dataclasses import replace
from itertools import repeat
from typing import TYPE_CHECKING, Any, ClassVar, Generic, Self, TypeVar, overload

import numpy as np

from ..systems.drawing import Plot
from ..systems.numbers import integer, read_only, shown
from ..systems.system import System
from ..systems.unchangeable import Unchangeable
from .kinds import KINDS, restored
from .sheet import Column, Sheet, as_dataframe, as_dataset, as_dict, as_html, as_rows, as_text, in_speed_unit

if TYPE_CHECKING:
    from pandas import DataFrame
    from xarray import Dataset

Item = TypeVar("Item")
Value = TypeVar("Value")


class Field(Generic[Value]):
    """One item of a result: given when the result is made, or computed on first use and then stored.

    Results are equal if their fields that are parts are equal, and files hold these. Other fields follow from them; files
    hold those that were computed. A field without a function is a part unless it says ``part=False``.

    A field with a heading is a column of the printed table, and one with `axes` a column of dictionaries and files. A field
    with `fact` describes the whole result in these. A column that is None is left out.

    Attributes
    ----------
    otherwise : callable, optional
        Function of the result where its compiled result has no such field.
    heading : str or callable
        Heading of the column, to which the unit is added unless it ends with ")"; or a function of the result.
    unit : str
        Unit of the numbers. Angles (``"rad"``) are printed in degrees. ``"force"`` is N for a system given by mass.
    digits : int
        Number of significant digits in printed tables.
    axes : tuple of str, optional
        Names of the axes after the first; or a function of the result.
    shown : callable, optional
        Function of the result that returns what is printed instead.
    joined : bool
        Whether the columns of the field, a result with the same rows, are added to those of this one.
    key : str, optional
        Name of the column (argument `column`) if it differs from that of the field.
    left : bool
        Whether printed tables align the column on the left.
    """

    def __init__(
        self,
        doc: str,
        compute: Callable[[Any], Any] | None = None,
        *,
        otherwise: Callable[[Any], Any] | None = None,
        part: bool | None = None,
        heading: str | Callable[[Any], str] | None = None,
        unit: str = "",
        digits: int = 6,
        axes: tuple[str, ...] | Callable[[Any], tuple[str, ...]] | None = None,
        shown: Callable[[Any], Any] | None = None,
        fact: bool = False,
        joined: bool = False,
        column: str | None = None,
        left: bool = False,
    ) -> None:
        self.__doc__ = doc
        self.compute, self.otherwise = compute, otherwise
        self.part = compute is None if part is None else part
        self.key, self.joined, self.left = column, joined, left
        self.heading, self.unit, self.digits, self.shown, self.fact = heading, unit, digits, shown, fact
        self.axes = () if axes is None and heading is not None else axes

    def __set_name__(self, owner: type[Result], name: str) -> None:
        self.name = name

    @overload
    def __get__(self, result: None, owner: type[Any]) -> Self: ...
    @overload
    def __get__(self, result: Any, owner: type[Any]) -> Value: ...
    def __get__(self, result: Any, owner: type[Any]) -> Any:
        # Not called where the dictionary of the result has the name: a descriptor without __set__ comes after it.
        if result is None:
            return self
        if self.compute is not None:
            found = self.compute(result)
        else:
            core = result.__dict__["_core"] or result._found()
            if hasattr(core, self.name):
                found = getattr(core, self.name)
            elif self.otherwise is not None:
                found = self.otherwise(result)
            else:  # the compiled result of this kind of system has no such number
                raise UnavailableError(not_there(result, self.name))
        if type(found) is np.ndarray:
            found.flags.writeable = False
        elif type(found) is list or (type(found) is tuple and self.compute is not None):
            found = frozen(found)
        return result.__dict__.setdefault(self.name, found)  # two threads that compute it at once get one object

    def column(self, result: Any) -> Column:
        """Return the column of a printed table that the field gives for a result."""
        values = getattr(result, self.name)
        heading = self.heading(result) if callable(self.heading) else self.heading or ""
        unit, shown = self.unit, None if self.shown is None else self.shown(result)
        if unit == "force":
            unit = "N" if result.system.by_mass else ""
        if heading and unit == "rad":
            heading, shown = f"{heading} (°)", np.degrees(values) if shown is None else shown
        elif heading and unit and heading[-1] != ")":
            heading = f"{heading} ({unit})"
        axes = self.axes(result) if callable(self.axes) else self.axes or ()
        data = (self.key or self.name, values, heading, self.digits, axes, shown, self.left, unit)
        return tuple.__new__(Column, data)  # Column(...) would take a call more


_ASKED = ("_speed_unit", "_asked_notes", "_by_speed")  # how the question was asked, as far as printed tables tell it


class UnavailableError(AttributeError, ValueError):
    """The error of a field that some results of a class do not have."""


class Result(Unchangeable):
    """The base of all results: immutable values that can be pickled; two of one class are equal if their parts are.

    A subclass lists its data as `Field`s, from which the table, dictionaries, files and equality follow. Its
    `_from_parts` makes a compiled result from the parts of a file. Arguments of the class statement:

    - `row`: name of what a row of the table is, such as ``"mode"``;
    - `title`: line above the table, with names of fields or properties in braces;
    - `notes`: lines below it, likewise;
    - `spread`: whether a long table prints evenly spaced rows instead of the first ones;
    - `good`: name of the field that says whether everything was found and proved.
    """

    __slots__ = ("__dict__",)  # has the fields known so far and, as `_core`, the compiled result
    plot = Plot()
    _core: Any
    _speed_unit: str | None = None  # in which the question was asked: printed tables and pictures speak it
    _asked_notes: tuple[str, ...] = ()  # further lines below printed tables, about how the question was asked
    _fields: ClassVar[dict[str, Field[Any]]] = {}
    _row: ClassVar[str] = "row"
    _title: ClassVar[str] = ""
    _notes: ClassVar[tuple[str, ...]] = ()
    _spread: ClassVar[bool] = False
    _good: ClassVar[str] = ""

    def __init_subclass__(cls, **given: Any) -> None:
        for name in ("row", "title", "notes", "spread", "good"):
            if name in given:
                setattr(cls, f"_{name}", given.pop(name))
        super().__init_subclass__(**given)
        own = {name: value for name, value in vars(cls).items() if isinstance(value, Field)}
        cls._fields = {**cls._fields, **own}
        if cls.__module__.startswith("revchain."):  # a class of a caller must not replace one of ours
            KINDS[cls.__name__] = cls

    def __init__(self) -> None:
        raise TypeError(
            f"revchain.{type(self).__name__}: is what a question returns or revchain.load reads; call a question, such as "
            "revchain.modes"
        )

    @classmethod
    def _made(cls, core: Any = None, **parts: Any) -> Self:
        """A result from a compiled one and the parts that the compiled one does not hold."""
        result = object.__new__(cls)
        for name, value in parts.items():
            if type(value) in _HOLD:
                parts[name] = frozen(value)
        parts["_core"] = core
        result.__dict__.update(parts)
        return result

    def _found(self) -> Any:
        """Return the compiled result; of a loaded one it is made from the parts."""
        core = self.__dict__["_core"]
        if core is None:
            core = self.__dict__["_core"] = self._from_parts()
        return core

    def _from_parts(self) -> Any:
        """The compiled result, made from the parts of a loaded one; a ValueError if the file lacks some of them."""
        raise ValueError(
            f"revchain.{type(self).__name__}: the file that it was loaded from lacks some of its numbers; compute and "
            "save it again"
        )

    def _is_good(self) -> bool:
        """Return whether everything was found and proved."""
        return not self._good or getattr(self, self._good, True) in (True, "success", "found")

    _unused: Collection[str] = ()  # names of columns that this result does not need

    def _left_out(self) -> Collection[str]:
        """Names of columns that a printed table leaves out."""
        return self._unused

    def _sheet(self, brief: bool = False) -> Sheet:
        """The data as columns; with `brief` only what a printed table shows."""
        columns, facts, left_out = [], {}, self._left_out() if brief else self._unused
        for name, field in self._fields.items():
            if field.axes is not None and (field.heading or not brief):
                if name not in left_out and getattr(self, name, None) is not None:
                    columns.append(field.column(self))
            elif brief or not (field.fact or field.joined) or not hasattr(self, name):
                continue
            elif (value := getattr(self, name)) is not None and field.joined:
                columns += [each._replace(name=f"{name}_{each.name}", heading="") for each in value._sheet().columns[1:]]
            elif field.fact:
                facts[field.key or name] = as_rows(value._sheet()) if isinstance(value, Result) else value
        words = _Words(self)
        notes = "\n".join(map(str.format_map, self._notes, repeat(words))).splitlines()
        title = self._title.format_map(words)
        return Sheet(self._row, title, columns, facts, notes, self._is_good(), self._spread)

    def _printed(self) -> Sheet:
        """The sheet of a printed table, with its speeds in the unit in which the question was asked."""
        sheet, unit, notes = self._sheet(brief=True), self._speed_unit, self._asked_notes
        sheet = sheet if unit is None else in_speed_unit(sheet, unit)
        return replace(sheet, notes=[*sheet.notes, *notes]) if notes else sheet

    def _full(self) -> Sheet:
        """All data for dictionaries and files: the columns, and the facts after the system in numbers."""
        sheet, system = self._sheet(), getattr(self, "system", None)
        if not isinstance(system, System):
            return sheet

        def named(axis: str, number: int) -> str:
            if axis == "pin":
                pins = np.atleast_1d(getattr(self, "pins", np.arange(number + 1)))
                return system._pin_name(int(pins[number])) if number < pins.size else ""
            return system._link_name(number) if axis == "link" else str(number + 1) if axis == "motion" else ""

        numbers = {"system": type(system).__name__, **system._data()}  # as `to_dict`
        return replace(sheet, facts={"system": numbers, **sheet.facts}, named=named)

    def __dir__(self) -> list[str]:
        return [name for name in super().__dir__() if name != "plot" or hasattr(type(self), "plot")]

    def _state(self) -> dict[str, Any]:
        """All parts, and the other fields computed so far."""
        parts = {name: getattr(self, name) for name, field in self._fields.items() if field.part and hasattr(self, name)}
        return parts | {name: value for name, value in dict(self.__dict__).items() if name in self._fields or name in _ASKED}

    def to_dict(self) -> dict[str, Any]:
        """Return the data of the table as plain Python data.

        Returns
        -------
        dict
            The data. The entry ``system`` holds the system as its own `to_dict` returns it.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).to_dict()["modes"][0]["conical_height"]
        1.5
        >>> m = rc.modes(rc.Chain(mass=[1.0, 3.0], length=1.0))
        >>> rc.Chain.from_dict(m.to_dict()["system"]) == m.system
        True
        """
        return as_dict(self._full())

    def to_dataframe(self) -> DataFrame:
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
        return as_dataframe(self._full())

    def to_xarray(self) -> Dataset:
        """Return the data as a labelled data set.

        Returns
        -------
        xarray.Dataset
            The data set. The attribute ``system`` holds the system in numbers as JSON.

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
        return as_dataset(self._full())

    def to_excel(self, path: str | os.PathLike[str]) -> None:
        """Write the result to a workbook for a spreadsheet program.

        The first sheet describes the system and the result. Each table has a sheet of its own: the links or point masses,
        the rows of this result, and each quantity that has several numbers in a row.

        Parameters
        ----------
        path : path-like
            Path that ends in ``.xlsx``.

        Raises
        ------
        ValueError
            If the path has another ending, or a table is too large for a sheet.
        ImportError
            If openpyxl is not installed; the message says how to install it.
        OSError
            (a ValueError too) If the file cannot be written. An existing file stays until the new one is complete.

        Notes
        -----
        Numbers have 16 digits, angles are in radians. NaN is an empty cell. Cost: about 12 microseconds a cell.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "modes.xlsx"
        >>> rc.modes(rc.Chain(mass=[1.0, 3.0], length=1.0, names=["bob", "ball"])).to_excel(path)
        >>> import openpyxl
        >>> openpyxl.load_workbook(path).sheetnames
        ['system', 'links', 'modes', 'modes nodes', 'modes shape']
        """
        from .excel import name_of, save_workbook

        save_workbook(f"revchain.{type(self).__name__}.to_excel", path, {name_of(self): self})

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
            (a ValueError too) If the file cannot be written. An existing file stays until the new one is complete.

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
            same(getattr(self, name, None), getattr(other, name, None))
            for name, field in self._fields.items()
            if field.part
        )

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return restored, (type(self), self._state())

    def __copy__(self) -> Self:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self

    def __repr__(self) -> str:
        return as_text(self._printed())

    def _repr_html_(self) -> str:
        return as_html(self._printed())


class Listed(Sequence[Item]):
    """The base of sequences of results, which the field `_items` holds."""

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
        """Return the number of results that are equal to `value`."""
        return sum(value is item or (type(value) is type(item) and value == item) for item in self)

    def index(self, value: object, start: int = 0, stop: int | None = None) -> int:
        """Index of the first result equal to `value`, from `start` on and before `stop`."""
        caller = f"{type(self).__name__}.index"
        ends = integer(caller, "start", start), None if stop is None else integer(caller, "stop", stop)
        for number in range(len(self))[slice(*ends)]:
            if value is self[number] or (type(value) is type(self[number]) and value == self[number]):
                return number
        raise ValueError(f"{caller}: none of the {len(self)} results is {shown(value)}")

    def __iter__(self) -> Iterator[Item]:
        return iter(self._items)


class Results(Result, Listed[Item]):
    """The base of sequences of results that have fields of their own, such as a status."""

    __slots__ = ()
    _items: Field[tuple[Any, ...]] = Field("The results.")


Answered = TypeVar("Answered", bound=Result)


def asked_in(unit: str | None, found: Answered, notes: tuple[str, ...] = ()) -> Answered:
    """Return a result that prints and draws its speeds in the unit of the question, with further `notes` below its table."""
    if notes and isinstance(found, Result):
        found.__dict__["_asked_notes"] = notes
    if unit is not None and isinstance(found, Result):
        found.__dict__["_speed_unit"] = unit
        items: Any = found if isinstance(found, Listed) else ()
        for item in items:
            if isinstance(item, Result):
                item.__dict__["_speed_unit"] = unit
    return found


class _Words:
    """The fields of a result by name, for the text of titles and notes."""

    def __init__(self, result: Result) -> None:
        self.result = result

    def __getitem__(self, name: str) -> Any:
        return getattr(self.result, name)


def not_there(result: Any, name: str) -> str:
    """The sentence about a field that a result of this kind of system does not have."""
    system = type(result.system).__name__ if "system" in result.__dict__ else "result of this kind"
    return f"revchain.{type(result).__name__}.{name}: this {system} does not have it"


_HOLD = (np.ndarray, list, tuple, dict)  # types that may hold writable arrays


def frozen(value: Any) -> Any:
    """Return `value` with its arrays made read-only."""
    if isinstance(value, np.ndarray):
        return read_only(value) if value.flags.writeable else value
    if type(value) in (list, tuple):
        return tuple(map(frozen, value))
    return {name: frozen(item) for name, item in value.items()} if type(value) is dict else value


def same(one: Any, other: Any) -> bool:
    """Return whether two parts are equal, number for number; NaN equals NaN."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        kinds = (one.dtype, other.dtype) if isinstance(one, np.ndarray) and isinstance(other, np.ndarray) else None
        return kinds is not None and np.array_equal(one, other, equal_nan=kinds[0].kind in "fc")
    if isinstance(one, tuple) and isinstance(other, tuple):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(item, other[name]) for name, item in one.items())
    return bool(one == other or (one != one and other != other))


class Row:
    """One row of a result: the entry of each of its columns, by the name of the field."""

    __slots__ = ("_index", "_result")

    def __init__(self, result: Result, index: int) -> None:
        self._result, self._index = result, index

    def __getattr__(self, name: str) -> Any:
        field = type(self._result)._fields.get(name)
        if field is None or field.axes is None:
            raise AttributeError(f"a row of {type(self._result).__name__} has no {name}; see dir(row)")
        values = getattr(self._result, name)
        return None if values is None else values[self._index]

    def __dir__(self) -> list[str]:
        return [name for name, field in self._result._fields.items() if field.axes is not None]

    def __repr__(self) -> str:
        sheet = self._result._printed()
        cells = [f"{column.heading} {column.texts([self._index])[0]}" for column in sheet.columns if column.heading]
        return ", ".join(cells)
