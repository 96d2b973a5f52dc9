# SPDX-License-Identifier: GPL-3.0-or-later
"""A result as plain Python data and as a labelled data set."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from ._arguments import Floats, real
from ._extras import require

if TYPE_CHECKING:
    from xarray import Dataset

    from ._modes import Modes

LINK_COLUMNS = ("weight", "length", "centroid", "pendulum_length", "radius_of_gyration")


def to_dict(modes: Modes, gravity: float, shapes: bool) -> dict[str, Any]:
    """See `Modes.to_dict`."""
    gravity = real("Modes.to_dict", "gravity", gravity)
    columns: dict[str, list[Any]] = {
        "mode": list(range(1, len(modes) + 1)),
        "conical_height": modes.conical_height.tolist(),
        "angular_speed": modes.angular_speed(gravity).tolist(),
        "period": modes.period(gravity).tolist(),
        "revolutions_per_minute": (60 * modes.revolutions_per_second(gravity)).tolist(),
        "error_bound": modes.error_bound.tolist(),
    }
    if modes.nodes is not None and modes.residual is not None and modes.shape is not None:
        columns["nodes"] = [nodes.tolist() for nodes in modes.nodes]
        columns["residual"] = modes.residual.tolist()
        if shapes:
            columns["shape"] = modes.shape.tolist()
    chain = modes.chain
    return {
        "modes": [dict(zip(columns, row, strict=True)) for row in zip(*columns.values(), strict=True)],
        "method": modes.method,
        "status": modes.status,
        "gravity": gravity,
        "chain": {
            "size": chain.size,
            "mode_count": chain.mode_count,
            "length": chain.total_length,
            "weight": chain.total_weight,
        },
    }


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
    coordinates = {
        "mode": np.arange(1, len(modes) + 1),
        "pin_position": ("pin", np.concatenate([[0.0], np.cumsum(chain.length)])),
    }
    data: Dataset = xarray.Dataset(variables, coordinates, {"method": modes.method, "status": modes.status})
    return data


def padded(rows: list[Floats]) -> Floats:
    """Rows of different lengths as one array, the gaps filled with NaN."""
    table = np.full((len(rows), max(row.size for row in rows)), np.nan)
    for line, row in zip(table, rows, strict=True):
        line[: row.size] = row
    return table
