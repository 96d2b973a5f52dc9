# SPDX-License-Identifier: GPL-3.0-or-later
"""`Unchangeable`: the base of classes whose attributes cannot be changed."""

from __future__ import annotations


class Unchangeable:
    """A base class that refuses to set or delete attributes; constructors set them by `object.__setattr__`."""

    __slots__ = ()

    def __setattr__(self, name: str, value: object) -> None:
        raise AttributeError(f"a {type(self).__name__} cannot be changed: {name} was not set")

    def __delattr__(self, name: str) -> None:
        raise AttributeError(f"a {type(self).__name__} cannot be changed: {name} was not deleted")
