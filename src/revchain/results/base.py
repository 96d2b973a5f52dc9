# SPDX-License-Identifier: GPL-3.0-or-later
"""What the classes around compiled results share: how one is made, lists of them, that they cannot be changed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import fields
from typing import Any, Generic, Self, TypeVar, overload

import numpy as np

from ..systems.numbers import integer, read_only, shown

Compiled = TypeVar("Compiled")
Given = TypeVar("Given")
Item = TypeVar("Item")


class Result(Generic[Compiled, Given]):
    """A compiled result and what was given for it that it does not hold itself; functions of this package make it."""

    __slots__ = ("_compiled", "_given")
    _compiled: Compiled
    _given: Given

    @classmethod
    def _wrap(cls, compiled: Compiled, given: Given) -> Self:
        result = object.__new__(cls)
        result._compiled, result._given = compiled, given
        return result


class Results(Sequence[Item]):
    """A list of results that cannot be changed; what is said of the list as a whole is up to its kind."""

    __slots__ = ("_items",)
    _items: tuple[Item, ...]

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


class Record:
    """For dataclasses of arrays: these are frozen, compared number for number, and can be pickled."""

    __slots__ = ()

    def __post_init__(self) -> None:
        for field in fields(self):  # type: ignore[arg-type]
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray) and value.flags.writeable:
                object.__setattr__(self, field.name, read_only(value))

    def __eq__(self, other: object) -> bool:
        if type(other) is not type(self):
            return NotImplemented
        for field in fields(self):  # type: ignore[arg-type]
            one, two = getattr(self, field.name), getattr(other, field.name)
            if isinstance(one, np.ndarray):
                if not np.array_equal(one, two, equal_nan=one.dtype.kind == "f"):
                    return False
            elif one != two:
                return False
        return True

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), tuple(getattr(self, field.name) for field in fields(self))  # type: ignore[arg-type]
