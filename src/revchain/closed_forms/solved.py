# SPDX-License-Identifier: GPL-3.0-or-later
"""Results whose constructors compute them from numbers."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..results.base import Field, Result
from ..results.sheet import Column, Sheet
from ..systems.numbers import as_length, count, floats, numbers, real


class Solved(Result):
    """A result whose constructor computes it from numbers; two are equal if the numbers given are equal.

    In a subclass `_solver` is the compiled class that computes the result, and `_table` returns the fields that are
    columns, with their headings; `_optional` are the arguments that may be None. Angles, whose headings end in (°),
    are shown in degrees.
    """

    __slots__ = ()
    _given: Field[dict[str, Any]] = Field("The numbers given, by name.")
    _solver: ClassVar[Any]
    _row: ClassVar[str]
    _optional: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls, **given: Any) -> None:
        super().__init_subclass__(**given)
        for name, field in cls._fields.items():
            field.part = name == "_given"

    def _solve(self, given: dict[str, Any]) -> None:
        """Check the arguments of the constructor, which are its `locals()`, and compute the result."""
        place = f"revchain.{type(self).__name__}"
        checked: dict[str, Any] = {}
        for name, value in given.items():
            if name == "half_waves":
                checked[name] = count(place, name, value)
            elif name != "self":
                number = as_length(place, name, value) if name == "tension" else value
                checked[name] = None if number is None and name in self._optional else real(place, name, number)
        self.__dict__.update(_given=checked, _core=None)
        self._found()

    def _at(self, method: str, name: str, value: ArrayLike) -> tuple[Any, ...]:
        """The columns that the method of the compiled result returns for an array."""
        place = f"revchain.{type(self).__name__}.{method}"
        return tuple(numbers(getattr(self._found(), method)(floats(place, name, value))))

    def _from_parts(self) -> Any:
        return self._solver(**self._given)

    def _facts(self) -> dict[str, float]:
        return {name: value for name, value in self._given.items() if value is not None}

    def _heading(self) -> str:
        raise NotImplementedError

    def _table(self) -> dict[str, str]:
        raise NotImplementedError

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = []
        for name, heading in self._table().items():
            value = np.asarray([getattr(self, name)])
            columns.append(Column(name, value, heading, shown=np.degrees(value) if heading.endswith("(°)") else None))
        return Sheet(self._row, f"{type(self).__name__}: {self._heading()}", columns, self._facts())
