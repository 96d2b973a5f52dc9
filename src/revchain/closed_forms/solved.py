# SPDX-License-Identifier: GPL-3.0-or-later
"""Results that their constructors find from numbers."""

from __future__ import annotations

from typing import Any, ClassVar

import numpy as np

from ..results.base import Field, Result
from ..results.sheet import Column, Sheet


class Solved(Result):
    """A result that its constructor finds from numbers; two are equal if the same numbers were given.

    A class says by `_solver` what finds it from the numbers, and by `_table` which of its fields are columns, with
    their headings; angles, whose headings end in (°), are shown in degrees.
    """

    __slots__ = ()
    _given: Field[dict[str, Any]] = Field("The numbers given, by name.", part=True)
    _solver: ClassVar[Any]
    _row: ClassVar[str]

    def _solve(self, given: dict[str, Any]) -> None:
        object.__setattr__(self, "_kept", {"_given": given})
        object.__setattr__(self, "_core", self._again())

    def _again(self) -> Any:
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
