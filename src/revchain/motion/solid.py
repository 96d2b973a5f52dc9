# SPDX-License-Identifier: GPL-3.0-or-later
"""Films as solids: one .glb file (glTF 2.0) with the motion as an animation. Upwards is y, x is where offsets point."""

from __future__ import annotations

import json
import struct
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..plots.forms import SIZES, colour_of, forms, opacity_of, start_of, unit_of
from ..plots.style import PALETTE
from ..systems.numbers import Floats, Whole
from .film import Complex, Figure, Film, pace, side_by_side

MOST_LINKS = 400  # of a longer chain only some of the pins are drawn
FEWEST_KEYS, MOST_PLACES = 120, 60_000  # of links in time, about 30 bytes each
SIDES, ROWS = 20, 8  # of a cylinder and a ball
THIN, THICK, BALL = SIZES["thin"], SIZES["thick"], SIZES["ball"]  # radii, over the height or the width of the whole
GREYS = {
    "body": "595959",
    "floating": "f0f0f0",
    "support": "1a1a1a",
    "axis": "b3b3b3",
}
COMPONENTS = {"f": 5126, "u": 5123}  # numbers of glTF for 32-bit floats and unsigned 16-bit integers
VERTICES, ELEMENTS = 34962, 34963  # what glTF uses an array for
Floats32 = NDArray[np.float32]
Surface = tuple[Floats32, Floats32, NDArray[np.uint16]]  # points, normals, faces


def write_glb(film: Film, path: Path, progress: Callable[[int, int], None]) -> None:
    path.write_bytes(glb_of(film, progress))


def glb_of(film: Film, progress: Callable[[int, int], None]) -> bytes:
    """Return a file with a node for each figure; in it is a node that turns, which holds the links and bodies."""
    links = min(film.figures[0].offset.shape[1] - 1, MOST_LINKS)
    keys = max(FEWEST_KEYS, MOST_PLACES // (links * len(film.figures)))
    solid = _Solid(film.thinned(film.frames if film.is_rigid else keys, links + 1))
    for nth, (few, figure) in enumerate(zip(solid.film.figures, film.figures, strict=True)):
        solid.add(few, nth, figure.phase, film)
        progress(nth + 1, len(film.figures))
    return solid.finished()


class _Solid:
    """A glTF file that grows: its JSON as dictionaries, and its numbers as bytes."""

    def __init__(self, film: Film) -> None:
        self.film = film
        low, high = film.low_and_high
        self.tall = max(high - low, 2 * film.reach)
        self.across = side_by_side(film.widths())
        extras = {"note": film.note, "progress": film.progress} | _chart(film)
        self.scene: dict[str, Any] = {"name": film.system, "nodes": [], "extras": extras}
        self.lists: dict[str, list[dict[str, Any]]] = {}  # of the file, by their names in glTF
        self.animation: dict[str, list[Any]] = {"samplers": [], "channels": []}
        self.blob = bytearray()
        self.known: dict[Any, int] = {}  # numbers of materials, meshes and times, which are stored once

    # ---- what is stored

    def _put(self, kind: str, **item: Any) -> int:
        held = self.lists.setdefault(kind, [])
        held.append(item)
        return len(held) - 1

    def _once(self, key: Any, make: Callable[[], int]) -> int:
        if key not in self.known:
            self.known[key] = make()
        return self.known[key]

    def _array(self, values: Any, kind: str, ends: bool = False, target: int | None = None) -> int:
        self.blob.extend(b"\0" * (-len(self.blob) % 4))
        use = {} if target is None else {"target": target}
        view = self._put("bufferViews", buffer=0, byteOffset=len(self.blob), byteLength=values.nbytes, **use)
        self.blob.extend(values.tobytes())
        limits = {name: np.atleast_1d(of(values, axis=0)).tolist() for name, of in (("min", np.min), ("max", np.max))}
        item = {"bufferView": view, "componentType": COMPONENTS[values.dtype.kind], "count": len(values), "type": kind}
        return self._put("accessors", **item, **(limits if ends else {}))

    def _seconds(self, seconds: Floats) -> int:
        """Store the times of keys; those of one film once."""
        times = seconds.astype(np.float32)
        return self._once(times.tobytes(), lambda: self._array(times, "SCALAR", ends=True))

    def _material(self, colour: str) -> int:
        def make() -> int:
            # glTF has linear light, colours of the web do not
            light = [(int(colour[k : k + 2], 16) / 255) ** 2.2 for k in (0, 2, 4)]
            opacity = opacity_of(f"#{colour}")
            surface = {"baseColorFactor": [*light, opacity], "metallicFactor": 0.1, "roughnessFactor": 0.6}
            blend = {"alphaMode": "BLEND"} if opacity < 1 else {}
            return self._put("materials", name=f"#{colour}", pbrMetallicRoughness=surface, **blend)

        return self._once(colour, make)

    def _form(self, kind: str) -> dict[str, Any]:
        points, normals, faces = FORMS[kind]() if kind in FORMS else _lathed(forms()["profiles"][kind])
        attributes = {
            "POSITION": self._once((kind, 0), lambda: self._array(points, "VEC3", ends=True, target=VERTICES)),
            "NORMAL": self._once((kind, 1), lambda: self._array(normals, "VEC3", target=VERTICES)),
        }
        indices = self._once((kind, 2), lambda: self._array(faces, "SCALAR", target=ELEMENTS))
        return {"attributes": attributes, "indices": indices}

    def _mesh(self, kind: str, colour: str) -> int:
        def make() -> int:
            return self._put("meshes", name=kind, primitives=[self._form(kind) | {"material": self._material(colour)}])

        return self._once((kind, colour), make)

    def _node(self, name: str, parent: int | None, **given: Any) -> int:
        number = self._put("nodes", name=name, **given)
        held = self.scene["nodes"] if parent is None else self.lists["nodes"][parent].setdefault("children", [])
        held.append(number)
        return number

    def _channel(self, node: int, what: str, values: Floats, seconds: Floats) -> None:
        output = self._array(values.astype(np.float32), f"VEC{values.shape[1]}")
        sampler = {"input": self._seconds(seconds), "output": output, "interpolation": "LINEAR"}
        target = {"node": node, "path": what}
        self.animation["channels"].append({"sampler": len(self.animation["samplers"]), "target": target})
        self.animation["samplers"].append(sampler)

    # ---- what is drawn

    def add(self, figure: Figure, nth: int, phase: Floats, whole: Film) -> None:
        """Add a figure: its axis, and what turns, by these angles in the frames of the whole film."""
        film, thin = self.film, THIN * self.tall
        low, high = film.low_and_high
        extras: dict[str, Any] = {"gravity": film.gravity, "time_scale": film.time_scale, "caption": figure.caption(0)}
        if figure.is_rigid:
            extras["angular_speed"] = float(figure.speed[0])
        if len(figure.captions) > 1:
            extras["captions"] = figure.captions
        name, at = figure.label.replace("\n", ", ") or "figure", float(self.across[nth])
        root = self._node(name, None, translation=[at, 0.0, 0.0], extras=extras)
        axis = {"translation": [0.0, (low + high) / 2, 0.0], "scale": [thin / 3, high - low, thin / 3]}
        self._node("axis", root, mesh=self._mesh("cylinder", GREYS["axis"]), **axis)
        turning = self._node("turning", root)
        self._turn(figure, turning, phase, whole)
        points = in_space(figure.offset, figure.height)
        colour = PALETTE[film.colours[nth] % len(PALETTE)]
        of_form = zip(film.bodies.link.tolist(), film.bodies.form, strict=True)
        shapes = {link: (k, forms()["bodies"][form]) for k, (link, form) in enumerate(of_form) if form}
        for k in range(points.shape[1] - 1):
            name = film.names[k] if film.names else f"segment {k}"
            if film.rings[k]:
                self._ring(name, turning, points[:, k + 1], points[:, k], colour, k % 2)
                continue
            if (body := shapes.get(k, (0, {}))[1]).get("bare"):
                continue
            radius = (THICK if film.stout[k] else THIN) * self.tall
            lower = points[:, k]
            if above := body.get("hangs"):  # from a bar that ends above its centre of gravity
                step = lower - points[:, k + 1]
                long = np.linalg.norm(step, axis=1)[:, None]
                lower = points[:, k + 1] + (film.bodies.along[shapes[k][0]] - above * self.tall / long) * step
            self._bar(name, turning, points[:, k + 1], lower, radius, colour)
        self._bodies(turning, points, colour)
        for end in (0, -1) if film.is_held else (-1,):
            self._ball("support", turning, points[:, end], 0.6 * BALL * self.tall, GREYS["support"])
            on_axis = points[:, end] * [0.0, 1.0, 0.0]
            if np.abs(points[:, end] - on_axis).max() > 1e-9 * self.tall:
                self._bar("arm", turning, on_axis, points[:, end], 1.3 * thin, GREYS["support"])

    def _turn(self, figure: Figure, node: int, angles: Floats, whole: Film) -> None:
        """Add the rotation of a figure about its axis as a channel of the animation."""
        if not angles.any():
            return
        seconds = _times(whole)
        if figure.is_rigid:
            film = self.film
            rate = float(figure.speed[0]) * film.time_scale
            quarters = np.arange(0.0, film.seconds * (1 - 1e-9), abs(np.pi / 2 / rate))
            seconds = np.append(quarters, film.seconds)
            angles = rate * seconds
        none = np.zeros_like(angles)
        self._channel(node, "rotation", np.column_stack([none, np.sin(angles / 2), none, np.cos(angles / 2)]), seconds)

    def _placed(self, node: int, middle: Floats, rotation: Floats | None, scale: Floats) -> None:
        """Set the position of a node in the first frame and, where it moves, in every frame."""
        parts = {"translation": middle, "rotation": rotation, "scale": scale}
        for what, values in parts.items():
            if values is None:
                continue
            self.lists["nodes"][node][what] = values[0].astype(np.float32).tolist()
            if len(values) > 1 and np.ptp(values, axis=0).max() > 1e-6 * self.tall:
                self._channel(node, what, values, _times(self.film))

    def _bar(self, name: str, parent: int, upper: Floats, lower: Floats, radius: float, colour: str) -> None:
        along = upper - lower  # upwards, as most links are: near the turn of none
        long = np.maximum(np.linalg.norm(along, axis=1), 1e-9 * self.tall)
        node = self._node(name, parent, mesh=self._mesh("cylinder", colour))
        wide = np.full_like(long, radius)
        self._placed(node, (upper + lower) / 2, _turned_to(along / long[:, None]), np.column_stack([wide, long, wide]))

    def _ball(self, name: str, parent: int, at: Floats, radius: float, colour: str) -> None:
        node = self._node(name, parent, mesh=self._mesh("ball", colour))
        self._placed(node, at, None, np.full((1, 3), radius))

    def _ring(self, name: str, parent: int, upper: Floats, lower: Floats, colour: str, odd: int) -> None:
        along = upper - lower
        long = np.maximum(np.linalg.norm(along, axis=1), 1e-9 * self.tall)
        part, least, taller = SIZES["ring"]
        wide = np.maximum(part * long, least * THIN * self.tall)
        turn = _turned_to(along / long[:, None])
        if odd:
            turn = _after(turn, _by_angles(0.0, np.pi / 2, 0.0))
        node = self._node(name, parent, mesh=self._mesh("ring", colour))
        self._placed(node, (upper + lower) / 2, turn, np.column_stack([wide, taller * long, wide]))

    def _bodies(self, parent: int, points: Floats, colour: str) -> None:
        bodies, film = self.film.bodies, self.film
        heavy = float(np.sum(bodies.size**3))  # the heaviest as one, the others as parts of it
        ball = self.tall * min(BALL, max(SIZES["balls"] / max(heavy, 1.0), 1.5 * THIN))
        for k, (link, along, size, rod, wheel, floats) in enumerate(
            zip(bodies.link, bodies.along, bodies.size, bodies.rod, bodies.wheel, bodies.floats, strict=True)
        ):
            of = film.names[link] if film.names else "cord"
            upper, step = points[:, link + 1], points[:, link] - points[:, link + 1]
            middle = upper + along * step
            if bodies.form[k]:
                self._shaped(of, parent, bodies.form[k], upper, step, along, float(bodies.gyration[k]), wheel < 0)
                continue
            if film.rings.size > link and film.rings[link]:
                continue
            if rod:
                ends = middle - rod * step, middle + rod * step
                self._bar(f"rod of {of}", parent, *ends, 1.6 * THIN * self.tall, colour)
                continue
            grey = GREYS["floating" if floats else "body"]
            self._ball(f"body of {of}", parent, middle, ball * max(size, 0.3), grey)

    def _shaped(
        self, of: str, parent: int, form: str, upper: Floats, step: Floats, along: float, gyration: float, back: bool
    ) -> None:
        """Add the pieces of a form of the table, in axes of the link whose y points from its upper pin along it."""
        body, long = forms()["bodies"][form], np.maximum(np.linalg.norm(step, axis=1), 1e-9 * self.tall)
        unit, turn = unit_of(body, self.tall, float(long[0]), gyration), _turned_to(step / long[:, None])
        start = start_of(body, along * long, unit)
        for kind, shade, (x, y, z), scale, *tilt in [*body["pieces"], *body.get("solid", ())]:
            mesh = self._mesh("cylinder" if kind == "bar" else kind, colour_of(shade, back)[1:])
            node = self._node(f"{form} of {of}", parent, mesh=mesh)
            inside = np.column_stack([np.full_like(long, x * unit), start + y * unit, np.full_like(long, z * unit)])
            at = upper + _rotated(turn, inside)
            self._placed(node, at, _after(turn, _by_angles(*tilt[0])) if tilt else turn, np.array([scale]) * unit)

    def finished(self) -> bytes:
        """Return the whole file: a header and two chunks, each of whole words."""
        file = {"asset": {"version": "2.0", "generator": "revchain"}, "scene": 0, "scenes": [self.scene], **self.lists}
        if self.animation["channels"]:
            file["animations"] = [{"name": pace(self.film.time_scale), **self.animation}]
        file["buffers"] = [{"byteLength": len(self.blob)}]
        text = json.dumps(file, ensure_ascii=False, separators=(",", ":"), allow_nan=False).encode()
        text, data = text + b" " * (-len(text) % 4), bytes(self.blob) + b"\0" * (-len(self.blob) % 4)
        chunks = [(b"JSON", text), (b"BIN\0", data)]
        body = b"".join(struct.pack("<I4s", len(data), kind) + data for kind, data in chunks)
        return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


def in_space(offset: Complex, height: Floats) -> Floats:
    """Positions (x, y upwards, z towards the viewer), shape (frames, pins, 3), of a figure that has not turned."""
    tall = np.broadcast_to(height, offset.shape)
    return np.stack([offset.real, tall, -offset.imag], axis=-1)


def _times(film: Film) -> Floats:
    return np.arange(film.frames) / film.frames_per_second


def _chart(film: Film) -> dict[str, Any]:
    """The chart of a film for its page, to five digits."""
    chart = film.chart
    if chart is None:
        return {}

    def rounded(values: Any) -> list[float]:
        return [float(f"{value:.5g}") for value in values]

    rows = {name: [rounded(row) for row in getattr(chart, name)] for name in ("x", "y")}
    lines = [[rounded(part) for part in line] for line in chart.lines]
    words = {"x_label": chart.x_label, "y_label": chart.y_label, "logarithmic": chart.is_logarithmic}
    return {"chart": words | rows | {"lines": lines}}


def _turned_to(way: Floats) -> Floats:
    """Quaternions (x, y, z, w) that turn the y axis to these directions."""
    found = np.column_stack([way[:, 2], np.zeros(len(way)), -way[:, 0], 1 + way[:, 1]])
    size = np.linalg.norm(found, axis=1)
    down = size < 1e-6
    found[down], size[down] = [0.0, 0.0, 1.0, 0.0], 1.0
    found /= size[:, None]
    flips = np.cumprod(np.concatenate([[1.0], np.where((found[1:] * found[:-1]).sum(axis=1) < 0, -1.0, 1.0)]))
    return np.asarray(found * flips[:, None])  # the shorter way from frame to frame


def _after(turn: Floats, first: Floats) -> Floats:
    """Quaternions (x, y, z, w) of the rotation `first` followed by `turn`."""
    (ax, ay, az, aw), (bx, by, bz, bw) = turn.T, first
    return np.column_stack(
        [
            aw * bx + ax * bw + ay * bz - az * by,
            aw * by - ax * bz + ay * bw + az * bx,
            aw * bz + ax * by - ay * bx + az * bw,
            aw * bw - ax * bx - ay * by - az * bz,
        ]
    )


def _by_angles(x: float, y: float, z: float) -> Floats:
    """The quaternion of rotations about z, then y, then x, as three.js orders them."""
    one = np.array([[0.0, 0.0, 0.0, 1.0]])
    for axis, angle in enumerate((x, y, z)):
        turn = np.zeros(4)
        turn[axis], turn[3] = np.sin(angle / 2), np.cos(angle / 2)
        one = _after(one, turn)
    return np.asarray(one[0])


def _rotated(turn: Floats, vectors: Floats) -> Floats:
    """Vectors rotated by quaternions, row by row."""
    axis, real = turn[:, :3], turn[:, 3:]
    return np.asarray(vectors + 2 * np.cross(axis, np.cross(axis, vectors) + real * vectors))


def _lathed(points: list[list[float]]) -> Surface:
    """The surface of revolution of a line of points (radius, height), which goes up outside."""
    upper, lower = np.array(points[::-1], float)[:-1], np.array(points[::-1], float)[1:]
    way = upper - lower
    normal = np.column_stack([way[:, 1], -way[:, 0]]) / np.linalg.norm(way, axis=1)[:, None]
    above, below = normal.copy(), normal.copy()
    smooth = (normal[1:] * normal[:-1]).sum(axis=1) > 0.5  # the others are edges
    above[1:][smooth] += normal[:-1][smooth]
    below[:-1][smooth] += normal[1:][smooth]
    above, below = (each / np.linalg.norm(each, axis=1)[:, None] for each in (above, below))
    rows = np.stack([np.hstack([upper, above]), np.hstack([lower, below])], axis=1).reshape(-1, 4)
    return _revolved(rows, np.arange(0, len(rows), 2))


def _torus(thick: float, radius: float = 1.0) -> Surface:
    angle = np.linspace(np.pi / 2, np.pi / 2 - 2 * np.pi, 9)
    out, up = np.cos(angle), np.sin(angle)
    return _revolved(np.column_stack([radius + thick * out, thick * up, out, up]), np.arange(8))


def _upright(surface: Surface) -> Surface:
    points, normals, faces = surface
    return points[:, [0, 2, 1]], normals[:, [0, 2, 1]], faces.reshape(-1, 3)[:, [0, 2, 1]].ravel()


def _box() -> Surface:
    points, normals = [], []
    for axis in range(3):
        for side in (-1.0, 1.0):
            for corner in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                one = np.zeros(3)
                one[axis], one[(axis + 1) % 3], one[(axis + 2) % 3] = side, corner[0] * side, corner[1]
                points.append(one / 2)
                normals.append(side * np.eye(3)[axis])
    faces = np.concatenate([[[k, k + 1, k + 2], [k, k + 2, k + 3]] for k in range(0, 24, 4)])
    return np.array(points, np.float32), np.array(normals, np.float32), faces.astype(np.uint16).ravel()


def _cylinder() -> Surface:
    rim = [[0, 0.5, 0, 1], [1, 0.5, 0, 1], [1, 0.5, 1, 0], [1, -0.5, 1, 0], [1, -0.5, 0, -1], [0, -0.5, 0, -1]]
    return _revolved(np.array(rim, float), np.array([0, 2, 4]))


def _ball() -> Surface:
    down = np.linspace(0, np.pi, ROWS + 1)
    return _revolved(np.column_stack([np.sin(down), np.cos(down)] * 2), np.arange(ROWS))


def _revolved(profile: Floats, bands: Whole) -> Surface:
    """The surface of revolution of a profile about the y axis.

    Rows of the profile are radius, height and the two components of the normal, the highest first. Faces lie between
    the rows whose indices are given and the rows after them.
    """
    angle, n = np.linspace(0, 2 * np.pi, SIDES + 1), SIDES + 1
    around = np.stack([np.cos(angle), np.ones(n), np.sin(angle)], -1)
    points, normals = (
        (part[:, [0, 1, 0]][:, None] * around).reshape(-1, 3).astype(np.float32)
        for part in (profile[:, :2], profile[:, 2:])
    )
    at = (bands[:, None] * n + np.arange(SIDES)).ravel()
    pairs = np.stack([at, at + 1, at + n, at + 1, at + n + 1, at + n], axis=1).reshape(-1, 3)  # what is half clear, band by band
    radius = profile[:, 0].repeat(n)
    faces = pairs[np.stack([radius[at] > 1e-6, radius[at + n] > 1e-6], axis=1).ravel()]  # on the axis they have no area
    return points, normals, faces.astype(np.uint16).ravel()


FORMS: dict[str, Callable[[], Surface]] = {
    "cylinder": _cylinder,
    "ball": _ball,
    "box": _box,
    "rim": lambda: _torus(0.05),
    "ring": lambda: _upright(_torus(0.15, 0.5)),
}
