# SPDX-License-Identifier: GPL-3.0-or-later
"""What the lists of results share."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any, TypeVar, overload

Item = TypeVar("Item")


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
