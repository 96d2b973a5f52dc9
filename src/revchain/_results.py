# SPDX-License-Identifier: GPL-3.0-or-later
"""What the classes around compiled results share: how one is made, and lists of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, Generic, Self, TypeVar, overload

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

    def __iter__(self) -> Iterator[Item]:
        return iter(self._items)
