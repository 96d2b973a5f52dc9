# SPDX-License-Identifier: GPL-3.0-or-later
"""Numbers with units: text such as "39 inch" and pint quantities, converted to SI."""

from __future__ import annotations

import math
import re
from functools import lru_cache
from typing import Any

import numpy as np

from .extras import require

NUMBER = r"[+-]?(\d+(\.\d*)?|\.\d+)([eE][+-]?\d+)?"
_UNIT = r"([a-zA-Zµμ°]+((\^|\*\*)-?\d)?|%)"
PATTERN = rf"^\s*{NUMBER}\s*((1\s*)?/\s*)?{_UNIT}((\s*[*/]\s*|\s+){_UNIT})*\s*$"
"""A number and a unit, such as ``39.1396 inch``, ``9.81 m/s^2`` or ``60 1/min``.

Exponents have one digit, because pint evaluates any expression, and ``m**9**9**9`` would never end.
"""

_KINDS = {
    "a length": ("m", "39.1396 inch"),
    "an area": ("m^2", "40 cm^2"),
    "a mass": ("kg", "2 kg"),
    "a mass per volume": ("kg/m^3", "1.225 kg/m^3"),
    "a force": ("N", "20 N"),
    "an acceleration": ("m/s^2", "9.81 m/s^2"),
    "a force per length": ("N/m", "2 kN/m"),
    "a force over a speed": ("N s/m", "50 N s/m"),
    "a torque over an angle": ("N m/rad", "5 N m/rad"),
    "a torque over a rate of angle": ("N m s/rad", "0.2 N m s/rad"),
    "an angular speed": ("rad/s", "30 rpm"),
    "a speed": ("m/s", "2 cm/s"),
    "a time": ("s", "2 min"),
    "an angle": ("rad", "20 deg"),
    "an angular momentum": ("kg m^2/s", "0.5 N m s"),
    "a moment of inertia": ("kg m^2", "0.1 kg m^2"),
    "a fraction": ("", "1 %"),
    "a number without a unit": ("", ""),
}
_NAMES = {
    "a length": "length diameter centroid radius_of_gyration pendulum_length length_in_proportion conical_height min_conical_height span radius "
    "tip_radius tip_centroid tip_radius_of_gyration support_radius offset support_offset arc_length displaced_centroid displaced_radius_of_gyration "
    "height position x arm thread rod distance deflection tip slack sag arc place pendulum lift "
    "pivot_offset lower_arm joint sleeve_offset sleeve_arm",
    "an area": "area",
    "a mass": "mass added_mass tip_mass ball_mass sleeve_mass",
    "a mass per volume": "air_density",
    "a force": "weight added_weight tip_weight tension top_tension force support_force friction spring_force",
    "an acceleration": "gravity acceleration support_acceleration",
    "a force per length": "stiffness spring_stiffness",
    "a force over a speed": "damping drag",
    "a torque over an angle": "pin_stiffness",
    "a torque over a rate of angle": "pin_damping",
    "an angular speed": "angular_speed angle_rate spin max_angular_speed low_speed high_speed",
    "a speed": "speed velocity support_velocity",
    "a time": "time period support_time",
    "an angle": "angle phase inclination lowest_inclination highest_inclination clearance amplitude",
    "an angular momentum": "momentum",
    "a moment of inertia": "axial_moment shaft_inertia",
    "a fraction": "rtol coefficient body_coefficient",
    "a number without a unit": "exponent",
}
SI = {name: (_KINDS[kind][0], kind, _KINDS[kind][1]) for kind, names in _NAMES.items() for name in names.split()}
"""SI unit, kind and an example of each quantity."""
SPEED_UNITS = {
    "rad/s": ("speed", 1.0),
    "rpm": ("speed", 30 / math.pi),
    "Hz": ("frequency", 0.5 / math.pi),
    "s": ("period", 2 * math.pi),
}
"""Units in which speeds are shown: what is measured in each, and the number of the unit for 1 rad/s."""

_TURNS = {"1/min": "rpm", "/min": "rpm", "min^-1": "rpm", "min**-1": "rpm"}  # nameplates have turns in them
_UNCLEAR = ("1/s", "/s", "s^-1", "s**-1")
_TOLERANCE = re.compile(r"\(?\s*(.*?)\s*(?:±|\+\s*/?\s*-)\s*([^()]*?)\s*(?:\)\s*(.*))?")


def speed_unit(value: Any) -> str | None:
    """The unit of `SPEED_UNITS` of a speed in text or a pint quantity, or of the first one in a list; else None."""
    value = unpacked(value)
    if isinstance(value, dict):
        value = list(value.values())
    if isinstance(value, list | tuple):
        return next((unit for unit in map(speed_unit, value) if unit), None)
    if isinstance(value, str):
        value = (with_tolerance(value) or (value,))[0]
        found = re.fullmatch(rf"\s*{NUMBER}(.*)", value)
        return _way(found[4].strip()) if found and re.match(PATTERN, value) else None
    return _way(str(value.units)) if hasattr(value, "dimensionality") else None


@lru_cache(maxsize=256)
def _way(unit: str) -> str | None:
    try:
        given = _registry().Quantity(1.0, _registry().parse_units(_TURNS.get(re.sub(r"\s", "", unit), unit).replace("%", "percent")))
    except Exception:  # as in `si_value`
        return None
    if given.is_compatible_with("s"):
        return "s"
    if not given.is_compatible_with("rad/s"):
        return None
    names = str(given.units).lower()
    turns = any(word in names for word in ("turn", "rev", "hertz", "rps", "rpm"))
    return "rpm" if turns and ("minute" in names or names == "rpm") else "Hz" if turns else "rad/s" if names == "radian / second" else None


def with_tolerance(text: str) -> tuple[str, str] | None:
    """The value and the tolerance in text such as ``38 m +- 0.5 m``, with ``±`` or ``+/-``; None if it has none.

    Either may have the unit of both, and the value may be left out: ``+- 0.5 m`` gives an empty text for it.
    """
    found = _TOLERANCE.fullmatch(text.strip())
    if found is None:
        return None
    value, spread, unit = found[1], found[2], found[3] or ""
    own = [re.fullmatch(rf"{NUMBER}\s*(.*)", part) for part in (value, spread)]
    units = [part[4] if part else "" for part in own]
    value = f"{value} {unit or units[1]}".strip() if own[0] and not units[0] and units[1] != "%" else value
    spread = f"{spread} {unit or units[0]}".strip() if own[1] and not units[1] else spread
    return value, spread


def unpacked(value: Any) -> Any:
    """Return an array of text or of quantities as a list, plain numbers as floats; another value unchanged."""
    kind = getattr(getattr(value, "dtype", None), "kind", "")
    if kind not in ("U", "T", "O") or isinstance(value, str):
        return value
    items = value.tolist()
    return items if kind == "O" and has_units(items) else value if kind == "O" else _numbers_of(items)


def _numbers_of(text: Any) -> Any:
    if isinstance(text, list):
        return [_numbers_of(item) for item in text]
    return float(text) if re.fullmatch(NUMBER, text) else text


def has_units(value: Any) -> bool:
    """Return whether a value, or an item of a list or tuple, is text or a pint quantity and must be converted."""
    value = unpacked(value)
    if isinstance(value, str) or hasattr(value, "dimensionality"):
        return True
    return isinstance(value, list | tuple) and any(map(has_units, value))


def in_si(caller: str, name: str, value: Any, quantity: str = "") -> Any:
    """`value` in SI units; a ValueError if a unit does not fit the quantity, which `name` tells if `quantity` is empty."""
    value = unpacked(value)
    if isinstance(value, list | tuple):
        return [in_si(caller, name, item, quantity) for item in value]
    if not isinstance(value, str) and not hasattr(value, "dimensionality"):
        return value
    words = re.split(r"[ \[(]", name)[0].split("_")  # "lower_radius_of_gyration" is a radius of gyration
    quantity = quantity or next((known for k in range(len(words)) if (known := "_".join(words[k:])) in SI), name)
    if quantity not in SI:
        raise ValueError(f"{caller}: {name} must be a number without a unit, got {str(value)!r}")
    try:
        return si_value(value, quantity) if isinstance(value, str) else _converted(value, quantity)
    except ValueError as error:
        raise ValueError(f"{caller}: {name} {error}") from None


@lru_cache(maxsize=4096)  # pint takes half a millisecond, and files repeat their numbers
def si_value(text: str, quantity: str) -> float:
    """The number of `text` in SI units; a ValueError says what is wrong with the text."""
    if len(text) <= 100 and re.match(PATTERN, text) is None and (parts := with_tolerance(text)) is not None and parts[0]:
        where = "in uncertainty, in fit, or as uniform or normal in a study"
        raise ValueError(f'must be a number without a tolerance, got "{text}"; write "{parts[0]}" here, and the tolerance {where}')
    _, kind, example = SI[quantity]
    wanted = f'must be a number, or a number and its unit such as "{example}"' if example else f"must be {kind}"
    if len(text) > 100 or re.match(PATTERN, text) is None:
        point = re.sub(r"(?<=\d),(?=\d)", ".", text, count=1)
        number = re.fullmatch(NUMBER, point.strip())
        right = point.strip() if number else f'"{point}"' if re.match(PATTERN, point) else ""
        hint = f"; write {right} without quotes" if right else ""
        hint = f"; the decimal mark is a point: write {right}" if right and point != text else hint
        raise ValueError(f'{wanted}, got "{text}"{hint}')
    if not example:
        raise ValueError(f'{wanted}, got "{text}"')
    number = re.match(rf"\s*{NUMBER}", text)
    assert number is not None
    unit = text[number.end() :].strip()
    if kind == "an angular speed" and (bare := re.sub(r"\s", "", unit)) in (*_TURNS, *_UNCLEAR):
        if bare in _UNCLEAR:
            each = number.group().strip()
            raise ValueError(f'may be turns or radians per second: write "{each} Hz" or "{each} rad/s", got "{text}"')
        unit = _TURNS[bare]
    if unit == "%" and quantity == "rtol":
        return float(number.group()) / 100
    registry = _registry()
    try:
        given = registry.Quantity(float(number.group()), registry.parse_units(unit.replace("%", "percent")))
    except Exception:  # pint has many errors of its own for what is not a unit
        raise ValueError(f'has a unit that is not known: "{text}"') from None
    return float(_converted(given, quantity, text))


def _converted(given: Any, quantity: str, text: str = "") -> Any:
    """Return the numbers of a pint quantity in SI units, of the quantity that is wanted."""
    unit, kind, example = SI[quantity]
    if kind == "an angular speed" and given.is_compatible_with("s"):  # a period
        period = given.m_as("s")
        if not np.all(period):
            raise ValueError(f'must be {kind} such as "{example}", or a period that is not 0, got "{text or given}"')
        return 2 * math.pi / period
    if not given.is_compatible_with(unit or "dimensionless"):
        hint = "; give it as mass" if quantity.endswith("weight") and given.is_compatible_with("kg") else ""
        by_weight = quantity.endswith("mass") and quantity.replace("mass", "weight") in SI
        hint = "; give it as weight" if by_weight and given.is_compatible_with("N") else hint
        such = f' such as "{example}"' if example else ""
        raise ValueError(f'must be {kind}{such}, got "{text or given}"{hint}')
    number = given.m_as(unit or "dimensionless")
    if kind == "an angular speed" and "hertz" in str(given.units):
        number = 2 * math.pi * number  # pint reads Hz as rad/s; here it is one turn per second
    return number


@lru_cache(maxsize=1)
def _registry() -> Any:
    try:
        registry = require("pint", "units", "a number with a unit").UnitRegistry()
        registry.define("rev = turn")
        registry.define("RPM = rpm")
        return registry
    except ModuleNotFoundError as error:
        raise ValueError(str(error)) from None
