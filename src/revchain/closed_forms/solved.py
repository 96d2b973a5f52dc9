# SPDX-License-Identifier: GPL-3.0-or-later
"""`Solved`: results that a constructor computes from numbers."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from ..results.base import Field, Result
from ..results.sheet import Sheet
from ..systems.numbers import as_length, count, floats, numbers, real


class Solved(Result):
    """A result whose constructor computes it from numbers.

    In a subclass `_solver` is the compiled class that computes the result, and `_optional` are the arguments that may
    be None. The table has one row, unless a subclass writes another.
    """

    __slots__ = ()
    _given: Field[dict[str, Any]] = Field("The numbers given, by name.")
    _solver: ClassVar[Any]
    _optional: ClassVar[tuple[str, ...]] = ()

    def __init_subclass__(cls, **given: Any) -> None:
        super().__init_subclass__(**given)
        for name, field in cls._fields.items():
            field.part = name == "_given"

    def _solve(self, given: dict[str, Any]) -> None:
        """Check the arguments of the constructor, which are its `locals()`, and compute the result."""
        caller = f"revchain.{type(self).__name__}"
        checked: dict[str, Any] = {}
        for name, value in given.items():
            if name == "half_waves":
                checked[name] = count(caller, name, value)
            elif name != "self":
                number = as_length(caller, name, value) if name == "tension" else value
                checked[name] = None if number is None and name in self._optional else real(caller, name, number)
        self.__dict__.update(_given=checked, _core=None)
        self._found()

    def _at(self, method: str, name: str, value: ArrayLike) -> tuple[Any, ...]:
        """The columns that the method of the compiled result returns for an array."""
        caller = f"revchain.{type(self).__name__}.{method}"
        return tuple(numbers(getattr(self._found(), method)(floats(caller, name, value))))

    def _from_parts(self) -> Any:
        return self._solver(**self._given)

    def _facts(self) -> dict[str, float]:
        return {name: value for name, value in self._given.items() if value is not None}

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = []
        for field in self._fields.values():
            if field.axes is not None and field.name not in self._left_out():
                column = field.column(self)
                shown = None if column.shown is None else np.asarray([column.shown])
                columns.append(column._replace(values=np.asarray([column.values]), shown=shown))
        return Sheet(self._row, self._title.format(self=self), columns, self._facts())
