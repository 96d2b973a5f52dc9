# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain or rig written as a scene, with all digits."""

from __future__ import annotations

import json
import math
from typing import Any

import numpy as np

from ..systems.chain import Chain
from ..systems.rig import Rig


def scene_text(system: Chain | Rig, gravity: float, title: str, comments: list[str], description: str = "") -> str:
    """The TOML of a scene that asks for all modes of a chain or rig; a ValueError if a scene cannot hold a part of it."""
    rig = system if isinstance(system, Rig) else Rig(system)
    if rig.flywheels is not None and np.any(rig.flywheels.momentum):
        wanted = "a scene gives flywheels by mass, radius_of_gyration and spin, not by momentum"
        raise ValueError(f"revchain: {wanted}, got {rig.flywheels}")
    lines = [f"# {_plain(comment)}".rstrip() for comment in comments]
    lines += ["", f"title = {_word(title)}", *[f"description = {_word(description)}"] * bool(description)]
    lines += [f"gravity = {gravity!r}  # m/s^2", *[f"fluid = {_word(rig.fluid)}"] * (rig.displaced is not None)]
    lines += ["", "# Links, the lowest first: kg, m."]
    for k in range(rig.size):
        lines += ["", "[[links]]", *(f"{key} = {_word(value)}" for key, value in _link(rig, k).items())]
    if support := rig.support._given:
        lines += ["", "[support]", *(f"{key} = {_word(value)}" for key, value in support.items())]
    return "\n".join([*lines, "", "[ask.modes]", 'count = "all"', ""])


def _link(rig: Rig, k: int) -> dict[str, Any]:
    """The keys of a link and their values."""
    chain = rig.chain
    heavy = "mass" if chain.by_mass else "weight"
    numbers = {key: float(getattr(chain, key)[k]) for key in (heavy, "length", "centroid", "radius_of_gyration")}
    if numbers["centroid"] == numbers["length"] and not numbers["radius_of_gyration"]:
        del numbers["centroid"], numbers["radius_of_gyration"]  # a point mass
    found: dict[str, Any] = {"name": chain.names[k]} if chain.names else {}
    found |= numbers
    if rig.inverted[k]:
        found["standing"] = True
    pin = {key: float(rig._pin(key)[k]) for key in ("stiffness", "damping")}
    if any(pin.values()):
        found["pin"] = {key: value for key, value in pin.items() if value}
    if rig.flywheels is not None and rig.flywheels.spin is not None:
        found["flywheel"] = _at(rig, rig.flywheels._given, k)
    elif axial := float(rig._turning(1.0)[1][k]):
        if not numbers[heavy]:
            raise ValueError(f"revchain: a scene cannot give link {k} an axial_moment, as it has no {heavy}, got {axial:g}")
        radius = math.sqrt(axial / numbers[heavy])
        found["flywheel"] = {heavy: numbers[heavy], "radius_of_gyration": radius, "spin": 0.0, "driven": True}
    if rig.displaced is not None:
        found["displaced"] = _at(rig, rig.displaced._given, k)
    if rig.drag is not None:
        found |= _at(rig, {"drag": rig.drag}, k)
    return found


def _at(rig: Rig, given: dict[str, Any], k: int) -> dict[str, Any]:
    """The numbers of link k of columns that may be one number for all."""
    return {name: np.broadcast_to(column, rig.size)[k].item() for name, column in given.items()}


def _word(value: Any) -> str:
    """A value as TOML."""
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key} = {_word(each)}" for key, each in value.items()) + "}"
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def _plain(text: str) -> str:
    """Text without characters that a comment cannot have."""
    return "".join(letter if letter.isprintable() else " " for letter in text)
