# SPDX-License-Identifier: GPL-3.0-or-later
"""A result as plain Python data and as a labelled data set."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import fields
from typing import TYPE_CHECKING, Any

import numpy as np

from ..systems.extras import require
from ..systems.numbers import Floats, Numbers, boolean, real
from .modes import Certificate

if TYPE_CHECKING:
    from xarray import Dataset

    from .modes import Modes

CERTIFICATE = "certificate_"
LINK_COLUMNS = ("weight", "length", "centroid", "pendulum_length", "radius_of_gyration")


def to_dict(modes: Modes, gravity: float, shapes: bool) -> dict[str, Any]:
    """See `Modes.to_dict`."""
    gravity = real("revchain.Modes.to_dict", "gravity", gravity)
    shapes = boolean("revchain.Modes.to_dict", "shapes", shapes)
    height, low = two_floats(modes.conical_height, modes.conical_height_low)
    columns: dict[str, list[Any]] = {
        "mode": modes.number.tolist(),
        "conical_height": height.tolist(),
        "angular_speed": plain(modes.angular_speed(gravity)),
        "period": plain(modes.period(gravity)),
        "revolutions_per_minute": plain(60 * modes.revolutions_per_second(gravity)),
        "error_bound": plain(modes.error_bound),
    }
    if low is not None:
        columns["conical_height_low"] = low.tolist()
    if modes.nodes is not None and modes.residual is not None and modes.shape is not None:
        columns["nodes"] = [plain(nodes) for nodes in modes.nodes]
        columns["residual"] = plain(modes.residual)
        if shapes:
            columns["shape"] = plain(modes.shape)
    if modes.certificate is not None:
        columns["certificate"] = _certificates(modes.certificate)
    chain = modes.chain
    return {
        "modes": [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)],
        "method": modes.method,
        "status": modes.status,
        "precision": modes.precision,
        "gravity": gravity,
        "chain": {
            "size": chain.size,
            "mode_count": chain.mode_count,
            "length": chain.total_length,
            "weight": chain.total_weight,
        },
    }


def plain(numbers: Numbers) -> list[Any]:
    """As Python's floats, rounded where they are wider."""
    rounded: list[Any] = numbers.astype(np.float64, copy=False).tolist()
    return rounded


def two_floats(numbers: Numbers, low: Floats | None) -> tuple[Floats, Floats | None]:
    """Numbers of any precision as float64 and, where that is too short for them, what it leaves."""
    high = numbers.astype(np.float64, copy=False)
    if numbers.dtype != np.longdouble:
        return high, low
    finite = np.isfinite(high)
    return high, np.where(finite, numbers - np.where(finite, high, 0), 0).astype(np.float64)


def extra_columns(modes: Modes) -> dict[str, Any]:
    """The arrays, one number for each mode, that are not always there."""
    columns = {} if modes.conical_height_low is None else {"conical_height_low": modes.conical_height_low}
    if modes.certificate is not None:
        for field in fields(modes.certificate):
            columns[CERTIFICATE + field.name] = getattr(modes.certificate, field.name)
    return {name: column for name, column in columns.items() if column is not None}


def extra_fields(columns: Mapping[str, Any]) -> dict[str, Any]:
    """The arguments of `Modes` that `extra_columns` came from."""
    proof = {name.removeprefix(CERTIFICATE): columns[name] for name in columns if name.startswith(CERTIFICATE)}
    return {
        "conical_height_low": columns.get("conical_height_low"),
        "certificate": Certificate(**proof) if proof else None,
    }


def _certificates(proof: Certificate) -> list[dict[str, Any]]:
    """One for each mode."""
    columns: dict[str, Any] = {}
    for end in ("lower", "upper"):
        columns[end], columns[f"{end}_low"] = two_floats(getattr(proof, end), getattr(proof, f"{end}_low"))
    columns |= {"above_lower": proof.above_lower, "above_upper": proof.above_upper}
    lists = {name: column.tolist() for name, column in columns.items() if column is not None}
    return [dict(zip(lists, row, strict=True)) for row in zip(*lists.values(), strict=True)]


def to_xarray(modes: Modes) -> Dataset:
    """See `Modes.to_xarray`."""
    xarray = require("xarray", "netcdf", "Modes.to_xarray")
    chain = modes.chain
    variables: dict[str, Any] = {
        "conical_height": ("mode", modes.conical_height),
        "error_bound": ("mode", modes.error_bound),
    }
    for name in LINK_COLUMNS:
        variables[name] = ("link", getattr(chain, name))
    if modes.shape is not None and modes.residual is not None and modes.nodes is not None:
        variables["residual"] = ("mode", modes.residual)
        variables["shape"] = (("mode", "pin"), modes.shape)
        variables["node_position"] = (("mode", "node"), padded(modes.nodes))
    variables |= {name: ("mode", column) for name, column in extra_columns(modes).items()}
    coordinates = {
        "mode": modes.number,
        "pin_position": ("pin", np.concatenate([[0.0], np.cumsum(chain.length)])),
    }
    attributes = {"method": modes.method, "status": modes.status, "precision": modes.precision}
    data: Dataset = xarray.Dataset(variables, coordinates, attributes)
    return data


def padded(rows: list[Numbers]) -> Numbers:
    """Rows of different lengths as one array, the gaps filled with NaN."""
    kind = rows[0].dtype if rows else np.dtype(np.float64)
    table = np.full((len(rows), max((row.size for row in rows), default=0)), np.nan, kind)
    for line, row in zip(table, rows, strict=True):
        line[: row.size] = row
    return table
