# SPDX-License-Identifier: GPL-3.0-or-later
"""Films as solids: one .glb file (glTF 2.0) with the motion as an animation. Upwards is y, x is where offsets point."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..systems.extras import require
from ..systems.numbers import Floats
from ..plots.style import PALETTE
from .film import Complex, Figure, Film, pace, side_by_side

MOST_LINKS = 400  # of a chain of more, every second pin or fewer
FEWEST_KEYS, MOST_PLACES = 120, 60_000  # of links in time, about 30 bytes each
SIDES = 20  # of a cylinder
THIN, THICK, BALL = 0.006, 0.014, 0.035  # radii, over the height or the width of the whole
BALL_OF_LINK = 0.28  # most, over the mean link
DISC = 0.6  # radius of a flywheel, over the reach
GREYS = {
    "body": "595959",
    "floating": "f0f0f0",
    "support": "1a1a1a",
    "axis": "b3b3b3",
    "forward": PALETTE[0],
    "backward": PALETTE[3],
}
FLOAT, SHORT, ARRAY, ELEMENTS = 5126, 5123, 34962, 34963  # of glTF
Floats32 = NDArray[np.float32]


def write_glb(film: Film, path: Path, progress: Callable[[int, int], None]) -> None:
    """One file that holds all it needs."""
    path.write_bytes(glb_of(film, progress))


def glb_of(film: Film, progress: Callable[[int, int], None]) -> bytes:
    """One scene, a node for each figure; in it a node that turns, and in that one for each link and body."""
    links = min(film.figures[0].offset.shape[1] - 1, MOST_LINKS)
    keys = max(FEWEST_KEYS, MOST_PLACES // (links * len(film.figures)))
    solid = _Solid(film.thinned(film.frames if film.is_rigid else keys, links + 1))
    for nth, (few, figure) in enumerate(zip(solid.film.figures, film.figures, strict=True)):
        solid.add(few, nth, figure.phase, film)
        progress(nth + 1, len(film.figures))
    return solid.finished()


class _Solid:
    """A glTF that grows."""

    def __init__(self, film: Film) -> None:
        self.gltf = gltf = require("pygltflib", "exchange", "a .glb file")
        self.film = film
        low, high = film.low_and_high
        self.tall = max(high - low, 2 * film.reach)
        self.across = side_by_side(film.widths())
        asset = gltf.Asset(version="2.0", generator="revchain")
        extras = {"note": film.note, "clock": film.clock}
        scene = gltf.Scene(name=film.system, nodes=[], extras=extras)
        self.file = gltf.GLTF2(asset=asset, scene=0, scenes=[scene])
        self.blob = bytearray()
        self.materials: dict[str, int] = {}
        self.meshes: dict[tuple[str, str], int] = {}
        self.accessors: dict[str, tuple[int, int, int]] = {}
        self.animation = gltf.Animation(name=pace(film.time_scale), samplers=[], channels=[])
        self.clocks: dict[int, int] = {}

    def seconds(self, film: Film) -> int:
        """Of the frames of one film."""
        if film.frames not in self.clocks:
            seconds = np.arange(film.frames) / film.frames_per_second
            self.clocks[film.frames] = self._accessor(seconds.astype(np.float32), "SCALAR", ends=True)
        return self.clocks[film.frames]

    # ---- what is stored

    def _accessor(self, values: Any, kind: str, ends: bool = False, target: int | None = None) -> int:
        """Numbers in the file; their number."""
        gltf = self.gltf
        self.blob.extend(b"\0" * (-len(self.blob) % 4))
        view = gltf.BufferView(buffer=0, byteOffset=len(self.blob), byteLength=values.nbytes, target=target)
        self.blob.extend(values.tobytes())
        self.file.bufferViews.append(view)
        accessor = gltf.Accessor(
            bufferView=len(self.file.bufferViews) - 1,
            componentType=SHORT if values.dtype == np.uint16 else FLOAT,
            count=len(values),
            type=kind,
        )
        if ends:
            accessor.min, accessor.max = (np.atleast_1d(end(values, axis=0)).tolist() for end in (np.min, np.max))
        self.file.accessors.append(accessor)
        return len(self.file.accessors) - 1

    def _material(self, colour: str) -> int:
        if colour not in self.materials:
            # glTF has linear light, colours of the web do not
            light = [(int(colour[k : k + 2], 16) / 255) ** 2.2 for k in (0, 2, 4)]
            rough = self.gltf.PbrMetallicRoughness(
                baseColorFactor=[*light, 1.0], metallicFactor=0.1, roughnessFactor=0.6
            )
            self.file.materials.append(self.gltf.Material(name=f"#{colour}", pbrMetallicRoughness=rough))
            self.materials[colour] = len(self.file.materials) - 1
        return self.materials[colour]

    def _mesh(self, kind: str, colour: str) -> int:
        """A cylinder or a ball of radius 1 and height 1, of one colour."""
        if (kind, colour) not in self.meshes:
            if kind not in self.accessors:
                points, normals, faces = _cylinder() if kind == "cylinder" else _ball()
                self.accessors[kind] = (
                    self._accessor(points, "VEC3", ends=True, target=ARRAY),
                    self._accessor(normals, "VEC3", target=ARRAY),
                    self._accessor(faces, "SCALAR", target=ELEMENTS),
                )
            position, normal, indices = self.accessors[kind]
            attributes = self.gltf.Attributes(POSITION=position, NORMAL=normal)
            drawn = self.gltf.Primitive(attributes=attributes, indices=indices, material=self._material(colour))
            self.file.meshes.append(self.gltf.Mesh(name=kind, primitives=[drawn]))
            self.meshes[kind, colour] = len(self.file.meshes) - 1
        return self.meshes[kind, colour]

    def _node(self, name: str, parent: int | None, **given: Any) -> int:
        self.file.nodes.append(self.gltf.Node(name=name, **given))
        number = len(self.file.nodes) - 1
        if parent is None:
            self.file.scenes[0].nodes.append(number)
        else:
            self.file.nodes[parent].children.append(number)
        return number

    def _channel(self, node: int, what: str, values: Floats32, times: int) -> None:
        sampler = self.gltf.AnimationSampler(
            input=times, output=self._accessor(values, f"VEC{values.shape[1]}"), interpolation="LINEAR"
        )
        self.animation.samplers.append(sampler)
        target = self.gltf.AnimationChannelTarget(node=node, path=what)
        self.animation.channels.append(
            self.gltf.AnimationChannel(sampler=len(self.animation.samplers) - 1, target=target)
        )

    # ---- what is drawn

    def add(self, figure: Figure, nth: int, phase: Floats, whole: Film) -> None:
        """One figure: its axis, and what turns, by these angles in the frames of the whole film."""
        film, thin = self.film, THIN * self.tall
        low, high = film.low_and_high
        extras = {"gravity": film.gravity, "time_scale": film.time_scale, "caption": figure.caption(0)}
        if figure.is_rigid:
            extras["angular_speed"] = float(figure.speed[0])
        if len(figure.captions) > 1:
            extras["captions"] = figure.captions
        root = self._node(
            figure.label.replace("\n", ", ") or "figure",
            None,
            translation=[float(self.across[nth]), 0.0, 0.0],
            extras=extras,
        )
        self._node(
            "axis",
            root,
            mesh=self._mesh("cylinder", GREYS["axis"]),
            translation=[0.0, (low + high) / 2, 0.0],
            scale=[thin / 3, high - low, thin / 3],
        )
        turning = self._node("turning", root)
        self._turn(figure, turning, phase, whole)
        points = in_space(figure.offset, figure.height)
        colour = PALETTE[film.colours[nth] % len(PALETTE)]
        for k in range(points.shape[1] - 1):
            name = film.names[k] if film.names else f"segment {k}"
            self._bar(
                name, turning, points[:, k + 1], points[:, k], (THICK if film.stout[k] else THIN) * self.tall, colour
            )
        self._bodies(turning, points, colour)
        for end in (0, -1) if film.is_held else (-1,):
            self._ball("support", turning, points[:, end], 0.6 * BALL * self.tall, GREYS["support"])
            on_axis = points[:, end] * [0.0, 1.0, 0.0]
            if np.abs(points[:, end] - on_axis).max() > 1e-9 * self.tall:
                self._bar("arm", turning, on_axis, points[:, end], 1.3 * thin, GREYS["support"])

    def _turn(self, figure: Figure, node: int, angles: Floats, whole: Film) -> None:
        """The rotation about the axis as a channel."""
        film = self.film
        if not angles.any():
            return
        if figure.is_rigid:
            rate = float(figure.speed[0]) * film.time_scale
            quarters = np.arange(0.0, film.seconds * (1 - 1e-9), abs(np.pi / 2 / rate))
            seconds = np.append(quarters, film.seconds)
            angles, times = rate * seconds, self._accessor(seconds.astype(np.float32), "SCALAR", ends=True)
        else:
            times = self.seconds(whole)
        none = np.zeros_like(angles)
        turned = np.column_stack([none, np.sin(angles / 2), none, np.cos(angles / 2)])
        self._channel(node, "rotation", turned.astype(np.float32), times)

    def _placed(self, node: int, middle: Floats, rotation: Floats | None, scale: Floats) -> None:
        """Where a node is, first and, where it moves, in every frame."""
        parts = {"translation": middle, "rotation": rotation, "scale": scale}
        for what, values in parts.items():
            if values is None:
                continue
            setattr(self.file.nodes[node], what, values[0].astype(np.float32).tolist())
            if len(values) > 1 and np.ptp(values, axis=0).max() > 1e-6 * self.tall:
                self._channel(node, what, values.astype(np.float32), self.seconds(self.film))

    def _bar(self, name: str, parent: int, upper: Floats, lower: Floats, radius: float, colour: str) -> None:
        along = upper - lower  # upwards, as most links are: near the turn of none
        long = np.maximum(np.linalg.norm(along, axis=1), 1e-9 * self.tall)
        node = self._node(name, parent, mesh=self._mesh("cylinder", colour))
        wide = np.full_like(long, radius)
        self._placed(node, (upper + lower) / 2, _turned_to(along / long[:, None]), np.column_stack([wide, long, wide]))

    def _ball(self, name: str, parent: int, at: Floats, radius: float, colour: str) -> None:
        node = self._node(name, parent, mesh=self._mesh("ball", colour))
        self._placed(node, at, None, np.full((1, 3), radius))

    def _bodies(self, parent: int, points: Floats, colour: str) -> None:
        bodies, film = self.film.bodies, self.film
        ball = self.tall * min(BALL, max(BALL_OF_LINK / (points.shape[1] - 1), 1.5 * THIN))
        for link, along, size, rod, wheel, floats in zip(
            bodies.link, bodies.along, bodies.size, bodies.rod, bodies.wheel, bodies.floats, strict=True
        ):
            of = film.names[link] if film.names else "cord"
            upper, step = points[:, link + 1], points[:, link] - points[:, link + 1]
            middle = upper + along * step
            grey = GREYS["floating" if floats else "body"]
            self._ball(f"body of {of}", parent, middle, ball * max(size, 0.3), grey)
            if rod:
                self._bar(
                    f"rod of {of}", parent, middle - rod * step, middle + rod * step, 1.6 * THIN * self.tall, colour
                )
            if wheel:
                half = 0.6 * THIN * self.tall * step / np.linalg.norm(step, axis=1)[:, None]
                disc = GREYS["forward" if wheel > 0 else "backward"]
                self._bar(f"flywheel of {of}", parent, middle - half, middle + half, DISC * film.reach, disc)

    def finished(self) -> bytes:
        """The whole file."""
        if self.animation.channels:
            self.file.animations.append(self.animation)
        self.file.buffers.append(self.gltf.Buffer(byteLength=len(self.blob)))
        self.file.set_binary_blob(bytes(self.blob))
        return b"".join(self.file.save_to_bytes())


def in_space(offset: Complex, height: Floats) -> Floats:
    """Places (x, y upwards, z towards the viewer), shape (frames, pins, 3), of a figure that has not turned."""
    tall = np.broadcast_to(height, offset.shape)
    return np.stack([offset.real, tall, -offset.imag], axis=-1)


def _turned_to(way: Floats) -> Floats:
    """Quaternions x, y, z, w that turn the y axis to these directions."""
    found = np.column_stack([way[:, 2], np.zeros(len(way)), -way[:, 0], 1 + way[:, 1]])
    size = np.linalg.norm(found, axis=1)
    down = size < 1e-6
    found[down], size[down] = [0.0, 0.0, 1.0, 0.0], 1.0
    found /= size[:, None]
    flips = np.cumprod(np.concatenate([[1.0], np.where((found[1:] * found[:-1]).sum(axis=1) < 0, -1.0, 1.0)]))
    return np.asarray(found * flips[:, None])  # the shorter way from frame to frame


def _cylinder() -> tuple[Floats32, Floats32, NDArray[np.uint16]]:
    """Radius 1, height 1, about the y axis, with its ends."""
    angle = np.linspace(0, 2 * np.pi, SIDES, endpoint=False)
    ring = np.column_stack([np.cos(angle), np.zeros(SIDES), np.sin(angle)])
    up = np.array([0.0, 0.5, 0.0])
    flat = np.broadcast_to([0.0, 1.0, 0.0], ring.shape)
    points = np.concatenate([ring - up, ring + up, ring - up, ring + up])
    normals = np.concatenate([ring, ring, -flat, flat])
    k, after, n = np.arange(SIDES), (np.arange(SIDES) + 1) % SIDES, SIDES
    side = [np.column_stack([k, k + n, after]), np.column_stack([after, k + n, after + n])]
    fan = np.arange(1, n - 1)
    ends = [
        np.column_stack([0 * fan + 2 * n, fan + 2 * n, fan + 1 + 2 * n]),
        np.column_stack([0 * fan + 3 * n, fan + 1 + 3 * n, fan + 3 * n]),
    ]
    return (
        points.astype(np.float32),
        normals.astype(np.float32),
        np.concatenate([*side, *ends]).astype(np.uint16).ravel(),
    )


def _ball() -> tuple[Floats32, Floats32, NDArray[np.uint16]]:
    """Radius 1."""
    rows, n = 8, SIDES
    down, about = np.meshgrid(np.linspace(0, np.pi, rows + 1), np.linspace(0, 2 * np.pi, n + 1), indexing="ij")
    points = np.stack([np.sin(down) * np.cos(about), np.cos(down), np.sin(down) * np.sin(about)], -1).reshape(-1, 3)
    at = (np.arange(rows)[:, None] * (n + 1) + np.arange(n)).ravel()
    faces = np.concatenate(
        [np.column_stack([at, at + 1, at + n + 1]), np.column_stack([at + 1, at + n + 2, at + n + 1])]
    )
    inside = np.concatenate([np.repeat(np.arange(rows) > 0, n), np.repeat(np.arange(rows) < rows - 1, n)])
    points = points.astype(np.float32)
    return points, points, faces[inside].astype(np.uint16).ravel()
