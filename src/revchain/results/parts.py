# SPDX-License-Identifier: GPL-3.0-or-later
"""The parts of a system as tables."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from ..systems.system import System
from .sheet import Column

UNITS = {
    **dict.fromkeys(("mass", "added_mass", "tip_mass", "ball_mass", "sleeve_mass"), "kg"),
    **dict.fromkeys(("length", "centroid", "radius_of_gyration", "radius", "span", "tip_centroid", "diameter"), "m"),
    **dict.fromkeys(("tip_radius_of_gyration", "arm", "lower_arm", "pivot_offset", "joint", "sleeve_offset", "sleeve_arm"), "m"),
    **dict.fromkeys(("weight", "added_weight", "tip_weight"), ""),  # in the unit of the weights, which is not known
    **{"tension": "N", "stiffness": "N/m", "damping": "N s/m", "spin": "rad/s", "momentum": "kg m^2/s", "area": "m^2"},
    **{"density": "kg/m^3", "spring_stiffness": "N/m", "spring_force": "N", "friction": "N", "gravity": "m/s^2"},
    **{"shaft_inertia": "kg m^2", "lowest_inclination": "rad", "highest_inclination": "rad"},
}
AT_PINS = {"stiffness": "N m/rad", "damping": "N m s/rad"}
FITTINGS = {"flywheels": "flywheel", "displaced": "displaced", "pins": "pin", "drag": "drag"}


class Fact(NamedTuple):
    """One number, or one word, of the whole system.

    Attributes
    ----------
    name : str
        Its name in words.
    value : float, str or bool
        The value.
    unit : str
        Its unit.
    """

    name: str
    value: Any
    unit: str = ""


def parts_of(system: Any) -> tuple[list[Fact], list[Column]]:
    """Return the numbers of the whole system, and the columns of a table of its links or point masses, free end first."""
    if not isinstance(system, System):  # a governor
        return [Fact(_words(name), value, UNITS.get(name, "")) for name, value in system._facts().items()], []
    base, by_mass = system._base, system.by_mass
    facts = [Fact("system", system._kind)]
    if system._fluid:
        facts.append(Fact("fluid", system._fluid))
    for name in ("span", "tension", "weightless"):
        if system._is_held and getattr(system, name, None):
            facts.append(Fact(name, getattr(system, name), UNITS.get(name, "")))
    for name in ("support", "lower", "upper"):
        end = getattr(system, name, None)
        for key, value in getattr(end, "_given", {}).items():
            facts.append(Fact(f"{name if name == 'support' else f'{name} end'}: {_words(key)}", float(value), UNITS[key]))
    if system._is_cord:
        return [*facts, *_of_cord(base)], _particles(base)
    heavy = "mass" if by_mass else "weight"
    columns = [Column("link", system._link_numbers, "link")]
    if base.names is not None:
        columns.append(Column("name", list(base.names), "name", left=True))
    lengths = (heavy, "length", "centroid", "radius_of_gyration")
    columns += [_column(name, getattr(base, name, None), base.size, UNITS[name]) for name in lengths]
    if system._stands.any():
        columns.append(Column("inverted", np.asarray(system._stands), "inverted"))
    for attribute, prefix in FITTINGS.items():
        for key, value in getattr(getattr(system, attribute, None), "_given", {}).items():
            unit = AT_PINS[key] if attribute == "pins" else UNITS.get(key, "")
            columns.append(_column(f"{prefix}_{key}", value, base.size, unit))
    return facts, columns


def _of_cord(cord: Any) -> list[Fact]:
    """Numbers of a cord."""
    data = cord._data()
    if not isinstance(data["density"], float):
        data["density"] = "a function"
    elif data["density"]:
        data["density"] = f"as the power {data['density']:g} of the distance from the free end"
    else:
        del data["density"]
    return [
        Fact(_words(name), value, UNITS.get(name, "") if not isinstance(value, str) else "")
        for name, value in data.items() if not isinstance(value, list) and value
    ]  # fmt: skip


def _particles(cord: Any) -> list[Column]:
    """The point masses on a cord."""
    places = cord._particles
    if not places:
        return []
    heavy = "mass" if cord.by_mass else "weight"
    return [
        _column("arc_length", np.array([*places], float), len(places), "m"),
        _column(heavy, np.array([*places.values()], float), len(places), UNITS[heavy]),
    ]


def _column(name: str, value: Any, size: int, unit: str) -> Column:
    """A column of the table of links."""
    heading = _words(name) + (f" ({unit})" if unit else "")
    return Column(name, np.broadcast_to(np.asarray(value), size), heading, unit=unit)


def _words(name: str) -> str:
    return name.replace("_", " ")
