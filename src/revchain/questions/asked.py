# SPDX-License-Identifier: GPL-3.0-or-later
"""Results print and draw speeds in the unit in which the question was asked."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import ParamSpec, TypeVar

from ..results.base import Result, asked_in
from ..systems.units import speed_unit

Arguments = ParamSpec("Arguments")
Found = TypeVar("Found", bound=Result)


def in_unit_of(name: str) -> Callable[[Callable[Arguments, Found]], Callable[Arguments, Found]]:
    """Make the result of a question print and draw speeds in the unit of the argument `name`, by a decorator.

    The argument is given by name, or is the second of the function.
    """

    def decorated(question: Callable[Arguments, Found]) -> Callable[Arguments, Found]:
        @functools.wraps(question)
        def wrapper(*given: Arguments.args, **named: Arguments.kwargs) -> Found:
            value = named.get(name, given[1] if len(given) > 1 else None)
            return asked_in(None if value is None else speed_unit(value), question(*given, **named))

        return wrapper

    return decorated
