# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers with units in scene files, through pint where it is installed."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

from ._extras import require

PATTERN = r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*[a-zA-Zµμ°][^'\"]*$"
"""A number and the name of a unit, such as ``39.1396 inch``."""

SI = {
    "length": ("m", "a length", "39.1396 inch"),
    "mass": ("kg", "a mass", "2 kg"),
    "weight": ("N", "a force", "20 N"),
    "gravity": ("m/s^2", "an acceleration", "9.81 m/s^2"),
}
"""Quantity: its SI unit, its name, an example."""


def si_value(text: str, quantity: str) -> float:
    """The number that `text` means in SI units; a ValueError says what is wrong with it."""
    unit, name, example = SI[quantity]
    if re.match(PATTERN, text) is None:
        raise ValueError(f'must be a number, or a number and its unit such as "{example}", got "{text}"')
    number = re.match(r"\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?", text)
    assert number is not None
    registry = _registry()
    try:
        given = registry.parse_units(text[number.end() :].strip())
        if not given.is_compatible_with(unit):
            hint = "; give it as mass" if quantity == "weight" and given.is_compatible_with("kg") else ""
            raise ValueError(f'must be {name} such as "{example}", got "{text}"{hint}')
        return float(registry.Quantity(float(number.group()), given).m_as(unit))
    except ValueError as error:
        if "must be" in str(error):
            raise
        raise ValueError(f'has a unit that is not known: "{text}"') from None
    except Exception:  # pint has many errors of its own for what is not a unit
        raise ValueError(f'has a unit that is not known: "{text}"') from None


@lru_cache(maxsize=1)
def _registry() -> Any:
    try:
        return require("pint", "units", "a number with a unit").UnitRegistry()
    except ModuleNotFoundError as error:
        raise ValueError(str(error)) from None
