# SPDX-License-Identifier: GPL-3.0-or-later
"""Films for ParaView and other readers of VTK: one instant as .vtu or .vtk, all of them as .xdmf. Upwards is z."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from ..systems.extras import require
from ..systems.numbers import Floats, Whole
from .film import Film, side_by_side

Progress = Callable[[int, int], None]


def write_grid(film: Film, path: Path, progress: Progress) -> None:
    """Through meshio: a line for each link, figures side by side."""
    meshio = require("meshio", "exchange", f"a {path.suffix} file")
    cells = {name: [values] for name, values in _of_links(film, 0).items()}
    mesh = meshio.Mesh(_points(film, 0), [("line", _lines(film))], point_data=_of_pins(film, 0), cell_data=cells)
    mesh.write(path)
    progress(film.frames, film.frames)


def write_xdmf(film: Film, path: Path, progress: Progress) -> None:
    """XDMF 3 with all numbers inside: one grid for each frame, its time that of the motion."""
    root = ElementTree.Element("Xdmf", Version="3.0")
    steps = ElementTree.SubElement(
        ElementTree.SubElement(root, "Domain"),
        "Grid",
        Name=film.system,
        GridType="Collection",
        CollectionType="Temporal",
    )
    lines = _lines(film)
    for frame in range(film.frames):
        grid = ElementTree.SubElement(steps, "Grid", Name=f"frame {frame}", GridType="Uniform")
        ElementTree.SubElement(grid, "Time", Value=repr(frame / film.frames_per_second * film.time_scale))
        topology = ElementTree.SubElement(
            grid, "Topology", TopologyType="Polyline", NodesPerElement="2", NumberOfElements=str(len(lines))
        )
        _item(topology, lines)
        _item(ElementTree.SubElement(grid, "Geometry", GeometryType="XYZ"), _points(film, frame))
        for center, data in (("Node", _of_pins(film, frame)), ("Cell", _of_links(film, frame))):
            for name, values in data.items():
                kind = "Vector" if values.ndim == 2 else "Scalar"
                _item(ElementTree.SubElement(grid, "Attribute", Name=name, AttributeType=kind, Center=center), values)
        progress(frame + 1, film.frames)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def _item(parent: Any, values: Any) -> None:
    size = " ".join(map(str, values.shape))
    kind = "Int" if values.dtype.kind == "i" else "Float"
    item = ElementTree.SubElement(parent, "DataItem", Format="XML", Dimensions=size, NumberType=kind, Precision="8")
    item.text = " ".join(map(repr, values.ravel().tolist()))


def _lines(film: Film) -> Whole:
    """The pins of every link."""
    pins = film.figures[0].offset.shape[1]
    first = np.arange(pins - 1)
    return np.concatenate([np.column_stack([first, first + 1]) + nth * pins for nth in range(len(film.figures))])


def _points(film: Film, frame: int) -> Floats:
    rows = []
    for figure, at in zip(film.figures, side_by_side(film.widths()), strict=True):
        offset = figure.in_space(frame)
        rows.append(np.column_stack([at + offset.real, offset.imag, figure.heights(frame)]))
    return np.concatenate(rows)


def _of_pins(film: Film, frame: int) -> dict[str, Any]:
    """Numbers of every pin: as the result has them, not as they are drawn."""
    pins = film.figures[0].offset.shape[1]
    true = [figure.in_space(frame) / _row(figure.scale, frame) for figure in film.figures]
    offset = np.concatenate(true)
    found = {
        "pin": np.tile(np.arange(pins), len(true)),
        "offset": np.column_stack([offset.real, offset.imag, np.zeros(offset.size)]),
    }
    if film.chart is None and any(figure.speed.any() for figure in film.figures):
        moved = np.concatenate(
            [1j * _row(figure.speed, frame) * each for figure, each in zip(film.figures, true, strict=True)]
        )
        found["velocity"] = np.column_stack([moved.real, moved.imag, np.zeros(moved.size)])
    return found | _tension(film, pins)


def _of_links(film: Film, frame: int) -> dict[str, Any]:
    """Numbers of every link."""
    links, many = film.figures[0].offset.shape[1] - 1, len(film.figures)
    found = {
        "link": np.tile(np.arange(links), many),
        "figure": np.repeat(np.arange(many), links),
        "angular_speed": np.repeat([_row(figure.speed, frame) for figure in film.figures], links),
    }
    return found | _tension(film, links)


def _tension(film: Film, size: int) -> dict[str, Floats]:
    """Of every link or pin, whichever has so many; nothing where it is not known."""
    known = [figure.tension for figure in film.figures if figure.tension is not None and figure.tension.size == size]
    return {"tension": np.concatenate(known)} if len(known) == len(film.figures) else {}


def _row(values: Floats, frame: int) -> float:
    return float(values[0 if len(values) == 1 else frame])
