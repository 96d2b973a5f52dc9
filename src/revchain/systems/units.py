# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers with units in scene files, through pint where it is installed."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

from .extras import require

_NUMBER = r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?"
_UNIT = r"[a-zA-Zµμ°]+((\^|\*\*)-?\d)?"
PATTERN = rf"^\s*{_NUMBER}\s*{_UNIT}((\s*[*/]\s*|\s+){_UNIT})*\s*$"
"""A number and a unit, such as ``39.1396 inch`` or ``9.81 m/s^2``.

Exponents have one digit: pint works out whatever stands there, and ``m**9**9**9`` would take it for ever.
"""

SI = {
    "length": ("m", "a length", "39.1396 inch"),
    "mass": ("kg", "a mass", "2 kg"),
    "weight": ("N", "a force", "20 N"),
    "gravity": ("m/s^2", "an acceleration", "9.81 m/s^2"),
    "stiffness": ("N/m", "a force per length", "2 kN/m"),
    "spin": ("rad/s", "an angular speed", "3000 rpm"),
    "angular_speed": ("rad/s", "an angular speed", "30 rpm"),
    "speed": ("m/s", "a speed", "2 cm/s"),
    "time": ("s", "a time", "2 min"),
    "added_mass": ("kg", "a mass", "2 kg"),
    "added_weight": ("N", "a force", "20 N"),
    "tip_mass": ("kg", "a mass", "2 kg"),
    "tip_weight": ("N", "a force", "20 N"),
}
"""Quantity: its SI unit, its name, an example."""


def si_value(text: str, quantity: str) -> float:
    """The number that `text` means in SI units; a ValueError says what is wrong with it."""
    unit, name, example = SI[quantity]
    if len(text) > 100 or re.match(PATTERN, text) is None:
        raise ValueError(f'must be a number, or a number and its unit such as "{example}", got "{text}"')
    number = re.match(rf"\s*{_NUMBER}", text)
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
