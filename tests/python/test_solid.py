# SPDX-License-Identifier: GPL-3.0-or-later
"""3D models: what is in the files is what the results have. They are read by pygltflib."""

import numpy as np
import pytest
from moving import ALL, CHAIN, ONE, WHEELS, film

import revchain as rc
from revchain.motion import solid
from revchain.plots.forms import forms

gltf = pytest.importorskip("pygltflib")

SIZES = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}
FLOAT, SHORT = 5126, 5123


def numbers(file, accessor):
    """What an accessor stands for."""
    of = file.accessors[accessor]
    view = file.bufferViews[of.bufferView]
    kind = {FLOAT: np.dtype("<f4"), SHORT: np.dtype("<u2")}[of.componentType]
    assert view.byteOffset % 4 == 0 and view.byteLength == of.count * SIZES[of.type] * kind.itemsize
    data = file.binary_blob()[view.byteOffset : view.byteOffset + view.byteLength]
    return np.frombuffer(data, kind).reshape(of.count, -1)


def saved(found, path, **given):
    found.to_glb(path, **given)
    return gltf.GLTF2().load(path)


def turned(quaternion, point):
    x, y, z, w = np.moveaxis(np.asarray(quaternion, float), -1, 0)
    axis = np.stack([x, y, z], -1)
    point = np.broadcast_to(point, axis.shape)
    return point + 2 * np.cross(axis, np.cross(axis, point) + w[..., None] * point)


def figures_of(file):
    """(root, nodes of what turns) of each figure."""
    for number in file.scenes[0].nodes:
        root = file.nodes[number]
        [turning] = [file.nodes[child] for child in root.children if file.nodes[child].name == "turning"]
        yield root, turning, [file.nodes[child] for child in turning.children]


def ends(translation, rotation, scale):
    """The upper and the lower end of a cylinder of height 1."""
    half = turned(rotation, [0.0, 0.5, 0.0]) * np.asarray(scale)[..., 1:2]
    return np.asarray(translation) + half, np.asarray(translation) - half


def is_link(node):
    return node.name.startswith(("links[", "segment"))


@pytest.mark.parametrize("kind", ALL)
def test_glb_is_whole(kind, tmp_path):
    """Seconds for the branch of a held cord, which is followed first."""
    found = ALL[kind]()
    file = saved(found, tmp_path / "solid.glb")
    assert file.asset.version == "2.0" and len(file.scenes) == 1 and file.scene == 0
    [buffer] = file.buffers
    assert buffer.byteLength <= len(file.binary_blob()) < buffer.byteLength + 4
    assert max(view.byteOffset + view.byteLength for view in file.bufferViews) == buffer.byteLength
    for number, accessor in enumerate(file.accessors):
        values = numbers(file, number)
        assert np.isfinite(values).all()
        if accessor.min:
            assert np.array_equal(accessor.min, values.min(axis=0)) and np.array_equal(accessor.max, values.max(axis=0))
    for mesh in file.meshes:
        [part] = mesh.primitives
        points, faces = numbers(file, part.attributes.POSITION), numbers(file, part.indices).reshape(-1, 3)
        assert len(file.accessors[part.attributes.POSITION].max) == 3 and faces.max() < len(points)
        normals = numbers(file, part.attributes.NORMAL)
        assert np.allclose(np.linalg.norm(normals, axis=1), 1, atol=1e-6)
        corners = points[faces].astype(float)
        outwards = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        assert (np.einsum("ij,ij->i", outwards, normals[faces].sum(axis=1)) > 0).all()  # seen from outside
    reached, todo = set(), list(file.scenes[0].nodes)
    while todo:
        node = todo.pop()
        assert node not in reached
        reached.add(node)
        todo += file.nodes[node].children
    assert reached == set(range(len(file.nodes)))
    shown = film(found)
    assert len(file.scenes[0].nodes) == len(shown.figures)
    for root, _, inside in figures_of(file):
        assert sum(is_link(node) for node in inside) == shown.figures[0].offset.shape[1] - 1
        names = [node.name.partition(" of ")[0] for node in inside]
        plain = [form == "" and not shown.rings[link] for form, link in zip(shown.bodies.form, shown.bodies.link, strict=True)]
        assert names.count("body") == sum(plain)
        for form in {*shown.bodies.form} - {""}:
            assert names.count(form) == shown.bodies.form.count(form) * len(forms()["bodies"][form]["pieces"])
        assert sum(node.name == "support" for node in inside) == 1 + shown.is_held
        assert root.extras["gravity"] == shown.gravity and root.extras["time_scale"] == shown.time_scale
        assert all(abs(np.linalg.norm(node.rotation) - 1) < 1e-6 for node in inside if node.rotation is not None)
    [animation] = file.animations
    for channel in animation.channels:
        sampler = animation.samplers[channel.sampler]
        times, output = numbers(file, sampler.input), numbers(file, sampler.output)
        assert len(file.accessors[sampler.input].max) == 1 and len(times) == len(output)
        assert (np.diff(times, axis=0) > 0).all() and times[0] == 0
        if channel.target.path == "rotation":
            assert np.allclose(np.linalg.norm(output, axis=1), 1, atol=1e-6)
            turn = (output[1:] * output[:-1]).sum(axis=1)
            assert (turn > -1e-6).all()  # the short way round; an arm may change sides


def test_modes_are_where_they_are(tmp_path):
    found = rc.modes(WHEELS)
    file = saved(found, tmp_path / "solid.glb", time_scale=0.05, duration=3.0)
    [animation] = file.animations
    channels = {channel.target.node: animation.samplers[channel.sampler] for channel in animation.channels}
    shown = film(found, time_scale=0.05, duration=3.0)
    for row, (root, turning, inside) in enumerate(figures_of(file)):
        links = [node for node in inside if is_link(node)]
        upper, lower = zip(*(ends(n.translation, n.rotation, n.scale) for n in links), strict=True)
        pins = np.array([lower[0], *upper])
        scale = shown.figures[row].scale[0]
        assert np.allclose(pins[:, 0], scale * found.shape[row], atol=2e-7)
        assert np.allclose(pins[:, 1], shown.figures[row].height[0], atol=2e-7) and np.abs(pins[:, 2]).max() < 2e-7
        sampler = channels[file.nodes.index(turning)]
        times, turns = numbers(file, sampler.input)[:, 0].astype(float), numbers(file, sampler.output)
        where = turned(turns, [1.0, 0.0, 0.0])
        angle = found.angular_speed[row] * 0.05 * times
        assert np.allclose(where, np.column_stack([np.cos(angle), 0 * angle, -np.sin(angle)]), atol=2e-5)
        assert times[-1] == 3.0 and np.abs(np.diff(angle)).max() < np.pi / 2 + 1e-4
        assert root.name == shown.figures[row].label


def test_shapes_bodies_and_arms(tmp_path):
    shapes = ALL["shapes of a carousel"]()
    file = saved(shapes, tmp_path / "solid.glb", figures=[1])
    [(root, _, inside)] = figures_of(file)
    assert root.name == f"shape 2, {shapes[1].half_waves} half wave{'s' * (shapes[1].half_waves != 1)}"
    named = {node.name: node for node in inside}
    on_axis, support = ends(*(getattr(named["arm"], name) for name in ("translation", "rotation", "scale")))
    assert np.allclose(on_axis, 0, atol=1e-6) and np.allclose(support, [1.0, 0.0, 0.0], atol=1e-6)
    for k in (0, 1):  # bodies are point masses at lower pins; their size goes by the cube root of the mass
        body = named[f"body of links[{k}]"]
        assert np.allclose(body.translation, [shapes[1].offset[k], shapes[1].height[k], 0.0], atol=1e-6)
    sizes = [named[f"body of links[{k}]"].scale[0] for k in (0, 1)]
    assert abs(sizes[1] / sizes[0] - (5.0 / 80.0) ** (1 / 3)) < 1e-6
    of_a_chain = saved(rc.modes(CHAIN), tmp_path / "b.glb")
    assert "arm" not in {node.name for _, _, nodes in figures_of(of_a_chain) for node in nodes}


@pytest.mark.parametrize("kind", ["swing", "whirl swing", "branch"])
def test_what_bends_is_keyed(kind, tmp_path):
    """Links, at the times of their keys, are where the film has them."""
    found = ONE[kind]()
    given = {"duration": 2.0} | ({} if kind == "branch" else {"time_scale": 1.0})
    file = saved(found, tmp_path / "solid.glb", **given)
    shown = film(found, **given)
    [figure] = shown.figures
    [animation] = file.animations
    [(_, _, inside)] = figures_of(file)
    tracks = {(c.target.node, c.target.path): animation.samplers[c.sampler] for c in animation.channels}
    for k, node in enumerate(node for node in inside if is_link(node)):
        parts = []
        for what in ("translation", "rotation", "scale"):
            sampler = tracks.get((file.nodes.index(node), what))
            still = np.broadcast_to(getattr(node, what), (shown.frames, len(getattr(node, what))))
            parts.append(still if sampler is None else numbers(file, sampler.output).astype(float))
            if sampler is not None:
                assert np.allclose(numbers(file, sampler.input)[:, 0], np.arange(shown.frames) / 25, atol=1e-6)
        upper, lower = ends(*parts)
        for end, pin in ((upper, k + 1), (lower, k)):
            assert np.abs(end[:, 0] - figure.offset[:, pin].real).max() < 1e-5
            assert np.abs(end[:, 2] + figure.offset[:, pin].imag).max() < 1e-5
            assert np.abs(end[:, 1] - np.broadcast_to(figure.height, figure.offset.shape)[:, pin]).max() < 1e-5


def test_long_chains_are_thinned(tmp_path):
    file = saved(rc.modes(rc.Chain.uniform_rods(5000), 2), tmp_path / "solid.glb")
    assert [sum(map(is_link, inside)) for _, _, inside in figures_of(file)] == [400, 400]
    assert (tmp_path / "solid.glb").stat().st_size < 400_000


def meshes_of(found, path):
    """The name of each node with the mesh it shows, and the file."""
    file = saved(found, path)
    return [(node.name, file.meshes[node.mesh].name) for node in file.nodes if node.mesh is not None], file


def test_bodies_have_the_forms_of_their_names(tmp_path):
    bell = rc.Chain(mass=[18.0, 500.0], length=[0.65, 0.15], centroid=[0.52, 0.05], radius_of_gyration=[0.2, 0.36],
                    names=["clapper", "the bell"])  # fmt: skip
    drawn, file = meshes_of(rc.modes(bell, 1), tmp_path / "bell.glb")
    assert ("bell of links[1] the bell", "bell") in drawn and ("clapper of links[0] clapper", "ball") in drawn
    node, link = ([each for each in file.nodes if each.name == name] for name in ("bell of links[1] the bell", "links[1] the bell"))
    assert node[0].scale == pytest.approx([0.36] * 3)
    upper, _ = ends(link[0].translation, link[0].rotation, link[0].scale)
    assert np.linalg.norm(np.asarray(node[0].translation) - upper) < 1e-6  # its centre of gravity is near the axle
    ride, _ = meshes_of(rc.modes(rc.Chain(mass=[80.0], length=5.0, names=["chair and rider"])), tmp_path / "seat.glb")
    assert sum(name.startswith("seat of") for name, _ in ride) == len(forms()["bodies"]["seat"]["pieces"])


def test_wheels_and_rings(tmp_path):
    wheels = rc.Rig(rc.Chain(mass=[1.5] * 3, length=0.3, centroid=0.15, radius_of_gyration=0.2), flywheels=rc.Flywheel(momentum=2.0))
    drawn, file = meshes_of(rc.modes(wheels, 1), tmp_path / "wheels.glb")
    assert [mesh for name, mesh in drawn if name.startswith("wheel of links[0]")][:5] == ["rim", "ball", *["cylinder"] * 3]
    rim = next(node for node in file.nodes if node.name.startswith("wheel of"))
    assert rim.scale == pytest.approx([0.2 * 2**0.5] * 3)
    resting = rc.Rig(rc.Chain.uniform_rods(9, mass=1.0), flywheels=rc.Flywheel(mass=[0.01] + [0.0] * 8, radius_of_gyration=0.05, spin=0.0))
    drawn, _ = meshes_of(rc.modes(resting, 1), tmp_path / "resting.glb")
    assert {name for name, mesh in drawn if mesh == "rim"} == {"wheel of links[0]"}
    assert [mesh for name, mesh in drawn if name.startswith("links[")] == ["cylinder"] + ["ring"] * 8
    drawn, _ = meshes_of(rc.modes(rc.Chain.uniform_rods(8), 1), tmp_path / "rings.glb")
    assert [mesh for name, mesh in drawn if name.startswith("links[")] == ["ring"] * 8
    drawn, _ = meshes_of(rc.modes(rc.Chain.uniform_rods(7), 1), tmp_path / "bars.glb")
    assert [mesh for name, mesh in drawn if name.startswith("links[")] == ["cylinder"] * 7


@pytest.mark.parametrize("kind", [*solid.FORMS, "bell", "jar"])
def test_surfaces_face_outwards(kind):
    """Normals have length 1 and point to the side from which the corners of each face run anticlockwise."""
    points, normals, faces = solid.FORMS[kind]() if kind in solid.FORMS else solid._lathed(forms()["profiles"][kind])
    np.testing.assert_allclose(np.linalg.norm(normals, axis=1), 1, rtol=1e-6)
    a, b, c = points[faces.reshape(-1, 3)].transpose(1, 0, 2).astype(float)
    area = np.cross(b - a, c - a)
    large = np.linalg.norm(area, axis=1) > 1e-6
    assert (np.einsum("ij,ij->i", area, normals[faces.reshape(-1, 3)].sum(axis=1))[large] > 0).all()
    if kind in ("box", "ball", "cylinder", "rim", "ring"):  # closed, so that the volume is positive
        volume = np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6
        assert volume > 0
