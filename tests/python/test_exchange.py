# SPDX-License-Identifier: GPL-3.0-or-later
"""Models of multibody engines: MuJoCo starts in the steady state and stays there, and reads back what was written."""

import itertools
import json
import random
import re
import warnings

import numpy as np
import pytest

import revchain as rc

mujoco = pytest.importorskip("mujoco")
pytestmark = pytest.mark.filterwarnings("ignore::revchain.ModelWarning")  # see test_models_of_others.py

RODS = rc.Chain.uniform_rods(3, length=1.0, mass=2.0)
WHEELS = rc.Flywheel(mass=0.3, radius_of_gyration=0.1, spin=[100.0, 0.0, 20.0], driven=[False, False, True])
RIGS = {
    "arm": rc.Rig(RODS, support=rc.Support(radius=0.3)),
    "spring": rc.Rig(RODS, support=rc.Support(stiffness=300.0, mass=0.5)),
    "arm and spring": rc.Rig(RODS, support=rc.Support(stiffness=300.0, radius=0.2)),
    "flywheels": rc.Rig(RODS, flywheels=WHEELS),
    "momentum": rc.Rig(rc.Chain.uniform_rods(2, weight=20.0), flywheels=rc.Flywheel(momentum=0.2, axial_moment=0.3)),
}
BODIES = rc.Chain(
    mass=[1.3, 0.4, 2.1], length=[0.7, 0.5, 0.9], centroid=[0.31, -0.1, 1.1], radius_of_gyration=[0.2, 0.3, 0.1]
)
BY_SIZE = {n: rc.Chain.uniform_rods(n, length=1.0, mass=2.0) for n in (1, 3, 5, 20)}
SYSTEMS = {**{f"{n} rods": chain for n, chain in BY_SIZE.items()}, **RIGS, "bodies": BODIES}
ROD = {"centroid": [0.2, 0.0, 0.2, 0.7], "radius_of_gyration": [0.1, 0.0, 0.1, 0.0]}  # threads and a point mass
SYSTEMS["watch chain"] = rc.Chain.uniform_rods(30, length=0.36, mass=0.014)  # moments of inertia of 5e-9 kg m^2
SYSTEMS["dust"] = rc.Chain(mass=[1e-6, 1e-7], length=[0.3, 0.2], centroid=[0.2, 0.1], radius_of_gyration=[0.001, 0.0])
SYSTEMS["threads"] = rc.Chain(mass=[1.0, 0.0, 3.0, 0.5], length=[0.4, 0.3, 0.4, 0.7], **ROD)


def shapes_of(system, speed=10.0, **how):
    shapes = rc.steady_shapes(system, angular_speed=speed, **how)[:4]
    assert shapes
    return shapes


def started(text):
    """MuJoCo in the first keyframe of a model."""
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    mujoco.mj_resetDataKeyframe(model, data, 0)
    mujoco.mj_forward(model, data)
    return model, data


def links_of(model):
    """Numbers of the bodies that are links, from the free end up."""
    names = [f"link_{k}" for k in range(model.nbody)]
    known = [model.body(k).name for k in range(model.nbody)]
    return [known.index(name) for name in names if name in known]


def pins(model, data):
    """Places of the pins from the free end up."""
    return np.vstack([data.site("free_end").xpos, data.xpos[links_of(model)]])


def hinges(model):
    """Places of the links' two angles and of the carriage among the coordinates, which are still in steady motion."""
    names = [model.joint(j).name for j in range(model.njnt)]
    return [j for j, name in enumerate(names) if name != "turn" and not name.endswith("_spin")]


def scale(system):
    chain = getattr(system, "chain", system)
    heavy = 9.80665 * chain.total_mass if chain.by_mass else chain.total_weight
    return heavy * chain.total_length


@pytest.mark.parametrize("system", SYSTEMS.values(), ids=SYSTEMS)
def test_no_force_is_needed(system):
    """Inverse dynamics: all joints but the turntable at rest, no acceleration, and no moment at any joint."""
    for shape in shapes_of(system):
        model, data = started(rc.to_mjcf(shape))
        data.qacc[:] = 0
        mujoco.mj_inverse(model, data)
        assert np.abs(data.qfrc_inverse).max() <= 1e-12 * scale(system)  # measured 4e-14
        assert not data.qvel[hinges(model)].any() and data.qvel[0] == shape.direction * shape.angular_speed


@pytest.mark.parametrize("size", BY_SIZE)
@pytest.mark.parametrize("integrator", ["RK4", "Euler"])
def test_it_stays_for_ten_turns(size, integrator):
    """A steady shape is a fixed point of every integrator in these coordinates: what moves is rounding."""
    shape = rc.steady_shapes(BY_SIZE[size], conical_height=0.05)[0]
    assert shape.stability().verdict == "minimum"
    model, data = started(rc.to_mjcf(shape).replace("RK4", integrator))
    start = data.qpos.copy()
    mujoco.mj_step(model, data, round(10 * shape.period / model.opt.timestep))
    still = hinges(model)
    assert np.abs(data.qpos[still] - start[still]).max() < 1e-10  # rad; measured 3e-13
    assert data.qpos[0] == pytest.approx(shape.angular_speed * data.time, rel=1e-9)


@pytest.mark.parametrize("direction", [1, -1])
@pytest.mark.parametrize("rig", RIGS.values(), ids=RIGS)
def test_rigs_stay(rig, direction):
    shape = shapes_of(rig, direction=direction)[0]
    model, data = started(rc.to_mjcf(shape))
    start, still = data.qpos.copy(), hinges(model)
    assert data.qvel[0] == direction * shape.angular_speed
    turns = 1 if shape.stability().growth_rate > 0 else 10
    mujoco.mj_step(model, data, round(turns * shape.period / model.opt.timestep))
    assert np.abs(data.qpos[still] - start[still]).max() < 1e-10  # rad and m
    assert data.qpos[0] == pytest.approx(direction * shape.angular_speed * data.time, rel=1e-9)


def without_turning(model, data, shape):
    """The same motion with the turntable at rest: it must not matter, as a turntable on the axis drives nothing."""
    speed, turn = shape.angular_speed, np.zeros(3)
    data.qvel[:] = 0
    for k in reversed(range(shape.inclination.size)):
        angle = shape.inclination[k]
        across = np.array([np.cos(angle), 0.0, np.sin(angle)])
        rate = speed * np.sin(angle) - turn @ across
        data.joint(f"link_{k}_sideways").qvel[:] = rate
        turn = turn + rate * across
    mujoco.mj_forward(model, data)


@pytest.mark.parametrize("size", BY_SIZE)
def test_drift_is_that_of_the_integrator(size):
    """With the turntable at rest all hinges move, and MuJoCo makes errors: halving its step says how large they are."""
    chain = BY_SIZE[size]
    shape = rc.steady_shape(chain, mode=1, angular_speed=1.15 * rc.modes(chain, 1).angular_speed[0])
    ends = []
    for step in (shape.period / 500, shape.period / 1000):
        model, data = started(rc.to_mjcf(shape, timestep=step))
        without_turning(model, data, shape)
        mujoco.mj_step(model, data, round(10 * shape.period / step))
        mujoco.mj_kinematics(model, data)
        ends.append(pins(model, data))
    error, own = np.abs(ends[0] - shape.position).max(), 16 / 15 * np.abs(ends[0] - ends[1]).max()
    assert own > 1e-13 and error <= 1.1 * own + 1e-11  # m; the error of RK4 falls to a sixteenth


@pytest.mark.parametrize("system", [BY_SIZE[3], BY_SIZE[5], *RIGS.values()], ids=["3 rods", "5 rods", *RIGS])
def test_unstable_shapes_leave_at_their_growth_rate(system):
    found = [rc.steady_shapes(system, angular_speed=n, hanging_only=n < 30) for n in (8.0, 11.0, 15.0, 20.0, 30.0)]
    shapes = [shape for shapes in found for shape in shapes if shape.stability().growth_rate > 0.02]
    assert shapes
    rng = np.random.default_rng(1)
    for shape in (shapes[0], shapes[-1]):
        rate = shape.stability().growth_rate * shape.angular_speed
        model, data = started(rc.to_mjcf(shape))
        free = hinges(model)
        start = data.qpos[free].copy()
        data.qpos[free] += 1e-10 * rng.normal(size=len(free))
        stride = max(1, round(0.05 * shape.period / model.opt.timestep))
        apart = []
        while not apart or np.abs(apart[-1]).max() < 1e-5:
            mujoco.mj_step(model, data, stride)
            apart.append(np.concatenate([data.qpos[free] - start, data.qvel[free] / shape.angular_speed]))
            assert data.time < 25 / rate
        # x(t + 2) = a x(t + 1) + b x(t): the roots of z^2 = a z + b are the growth in one stride
        last = np.array(apart[-60:])
        a, b = np.linalg.lstsq(np.stack([last[1:-1].ravel(), last[:-2].ravel()], 1), last[2:].ravel(), rcond=None)[0]
        growth = np.log(np.abs(np.roots([1, -a, -b])).max()) / (stride * model.opt.timestep)
        assert growth == pytest.approx(rate, rel=0.005)  # measured 0.0019


@pytest.mark.parametrize("system", SYSTEMS.values(), ids=SYSTEMS)
def test_positions_velocities_and_reactions(system):
    for shape in shapes_of(system):
        model, data = started(rc.to_mjcf(shape))
        mujoco.mj_rnePostConstraint(model, data)
        size = shape.reaction.shape[0]
        assert shape.position.shape == shape.velocity.shape == (size + 1, 3)
        links = links_of(model)
        np.testing.assert_allclose(pins(model, data), shape.position, rtol=0, atol=1e-13)
        velocity = np.empty(6)
        for k, body in enumerate(links):
            mujoco.mj_objectVelocity(model, data, mujoco.mjtObj.mjOBJ_XBODY, body, velocity, 0)
            np.testing.assert_allclose(velocity[3:], shape.velocity[k + 1], rtol=0, atol=1e-11)
        force = data.cfrc_int[links][:, 3:]
        np.testing.assert_allclose(force, shape.reaction, rtol=0, atol=1e-11 * np.abs(shape.reaction).max())
        np.testing.assert_allclose(np.linalg.norm(shape.reaction, axis=1), shape.tension, rtol=1e-15)
        rows = json.loads(json.dumps(shape.to_dict()))["links"]
        for name in ("joint_angle", "reaction"):
            assert [row[name] for row in rows] == getattr(shape, name).tolist()
        for name in ("position", "velocity"):
            assert [row[name] for row in rows] == getattr(shape, name)[:-1].tolist()
        assert np.cumsum(shape.joint_angle[::-1])[::-1] == pytest.approx(shape.inclination, abs=1e-14)
        assert shape.to_xarray()["reaction"].shape == (size, 3)


def test_positions_of_other_shapes():
    cord = rc.steady_shapes(rc.Cord(1.0), conical_height=0.1)[0]
    held = rc.steady_shapes(rc.Held(RODS, span=0.5), angular_speed=15.0)[0]
    for shape in (cord, held):
        np.testing.assert_array_equal(shape.position[:, [0, 2]], np.stack([shape.offset, shape.height], 1))
        np.testing.assert_array_equal(shape.velocity[:, 1], shape.angular_speed * shape.offset)
        assert not shape.position[:, 1].any() and not shape.velocity[:, [0, 2]].any()


@pytest.mark.parametrize("span", [0.5, 0.7])
def test_reactions_of_held_chains(span):
    """Each force carries what is below it: weights and the lower bearing's force, with the centripetal acceleration."""
    shape = rc.steady_shapes(rc.Held(RODS, span=span), angular_speed=15.0)[0]
    assert shape.reaction[0] == pytest.approx([shape.lower_pull[0], 0.0, shape.lower_pull[1]], rel=1e-12)
    assert shape.reaction[-1] == pytest.approx([-shape.upper_pull[0], 0.0, -shape.upper_pull[1]], rel=1e-12)
    across = shape.offset[1:] + (shape.offset[:-1] - shape.offset[1:]) * RODS.centroid / RODS.length
    below = np.stack([-(15.0**2) * across, 0.0 * across, np.full(3, 9.80665)], 1) * RODS.mass[:, None]
    np.testing.assert_allclose(shape.reaction[1:], shape.reaction[0] + np.cumsum(below, 0), atol=1e-12 * shape.tension.max())
    np.testing.assert_allclose(shape.joint_angle, [-shape.inclination[0], *-np.diff(shape.inclination), shape.inclination[-1]])
    rows = json.loads(json.dumps(shape.to_dict()))["places"]
    assert [row["reaction"] for row in rows] == shape.reaction.tolist()
    assert [row["joint_angle"] for row in rows] == shape.joint_angle.tolist()


def test_a_list_of_shapes_is_a_list_of_keyframes(tmp_path):
    shapes = rc.steady_shapes(RODS, conical_height=0.03)
    text = rc.to_mjcf(shapes, tmp_path / "shapes.xml")
    assert (tmp_path / "shapes.xml").read_text(encoding="utf-8") == text
    model = mujoco.MjModel.from_xml_path(str(tmp_path / "shapes.xml"))
    assert model.nkey == len(shapes) == 3 and model.key(2).name == "shape 3"
    for k, shape in enumerate(shapes):
        np.testing.assert_array_equal(model.key_qpos[k][1::2], shape.joint_angle[::-1])
    assert model.opt.gravity.tolist() == [0, 0, -9.80665]


def test_systems_are_at_rest():
    standing = rc.Rig(RODS, inverted=[True, False, False], support=rc.Support(radius=0.3))
    model, data = started(rc.to_mjcf(standing, gravity=1.62, timestep=0.01))
    assert np.abs(data.qacc).max() < 1e-12 and not data.qvel.any()
    assert data.site("free_end").xpos == pytest.approx([0.3, 0.0, -1 / 3])
    assert model.opt.timestep == 0.01 and model.opt.gravity[2] == -1.62
    spinning, data = started(rc.to_mjcf(rc.Rig(RODS, flywheels=WHEELS)))
    wheel = spinning.body("link_0_wheel").id
    momentum = spinning.body_inertia[wheel][2] * data.joint("link_0_spin").qvel[0]
    assert momentum == pytest.approx(0.3 * 0.1**2 * 100.0)


def test_names():
    """Links with names of parts of the support, or of each other, get a number; names of files come back."""
    named = rc.Chain(mass=[1.0, 2.0, 3.0, 4.0], length=1.0, names=["hook", "hook", "turntable", "free_end"])
    model = started(rc.to_mjcf(named))[0]
    assert [model.body(k).name for k in range(2, 6)] == ["free_end_3", "turntable_2", "hook_1", "hook"]
    assert rc.from_urdf(rc.to_urdf(named)).names == ("hook", "hook_1", "turntable_2", "free_end_3")


def names_of(text, kind):
    return re.findall(rf'<{kind} name="(.*?)"', text)


@pytest.mark.parametrize("size", [1, 2, 3])
def test_no_name_is_given_twice(size):
    """MuJoCo refuses a body or joint whose name another has; links keep names that no other link has."""
    words = ["", "a", "a_wheel", "a_pin", "link", "link_1", "link_2", "a_1", "carriage", "a_wheel_", "a_inclination"]
    bodies = {name: [value] * size for name, value in {"mass": 1.0, "length": 1.0, "centroid": 0.5, "radius_of_gyration": 0.3}.items()}
    chosen = list(itertools.product(words, repeat=size))
    for names in random.Random(size).sample(chosen, min(len(chosen), 200)):
        chain = rc.Chain(**bodies, names=names)
        wheels = rc.Rig(chain, flywheels=rc.Flywheel(momentum=1.0), support=rc.Support(stiffness=9.0))
        texts = [(rc.to_mjcf(wheels), "body"), (rc.to_urdf(chain), "link")]
        for (text, body), kind in itertools.product(texts, (0, "joint")):
            found = names_of(text, kind or body)
            assert len(found) == len(set(found)) > size, names
        found = rc.from_urdf(texts[1][0]).names
        kept = [name for name in names if name not in ("", "carriage") and names.count(name) == 1]
        assert size > 1 or names[0] or found is None
        assert found is None or set(kept) <= set(found)


def test_weights_are_masses_times_gravity():
    text = rc.to_mjcf(rc.Chain(weight=[9.0, 18.0], length=1.0), gravity=9.0)
    assert started(text)[0].body_mass[-2:].tolist() == [2.0, 1.0]


@pytest.mark.parametrize(
    ("given", "kind", "message"),
    [
        (rc.Cord(1.0), ValueError, r"cut a cord into links first: cord.chain\(100\); got Cord"),
        (rc.Held(RODS, span=0.5), ValueError, "only a Chain or a Rig is a serial chain of links"),
        (rc.steady_shapes(rc.Cord(1.0), conical_height=0.1)[0], ValueError, "only a Chain or a Rig is a serial chain"),
        (rc.steady_shapes(rc.Held(RODS, span=0.5), angular_speed=15.0), ValueError, "only a Chain or a Rig is a serial chain"),
        (rc.Rig(RODS, displaced=rc.Displaced(mass=0.1)), ValueError, "a fluid has no counterpart"),
        (rc.Chain(mass=[1.0, 0.0, 0.0], length=1.0), ValueError, r"a pin without mass stay in line.*chain.clamped\(k\)"),
        (rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=1.0)), ValueError, r"flywheels\[0\] needs a link"),
        (rc.Chain.uniform_rods(491, mass=1.0), ValueError, "at most 490 links, one below another, got 491"),
        (rc.steady_shapes(RODS, conical_height=5.0), ValueError, "the list of shapes is empty; give the system"),
        ([RODS], TypeError, r"system must be a revchain.Chain, Rig, SteadyShape or SteadyShapes, got \[Chain"),
    ],
)  # fmt: skip
def test_what_has_no_model(given, kind, message):
    with pytest.raises(kind, match=message):
        rc.to_mjcf(given)


def test_wrong_arguments(tmp_path):
    with pytest.raises(ValueError, match=r"to_mjcf: a shape has its gravity, 9.80665; leave gravity out, got 1.0"):
        rc.to_mjcf(shapes_of(RODS)[0], gravity=1.0)
    with pytest.raises(ValueError, match="to_mjcf: timestep must be positive and finite, got 0"):
        rc.to_mjcf(RODS, timestep=0.0)
    with pytest.raises(OSError, match="No such file or directory"):
        rc.to_mjcf(RODS, tmp_path / "nowhere" / "model.xml")


# ---- reading


COLUMNS = ("mass", "length", "centroid", "radius_of_gyration")


def same_numbers(one, other):
    return one.size == other.size and all(np.array_equal(getattr(one, name), getattr(other, name)) for name in COLUMNS)


@pytest.mark.parametrize("system", SYSTEMS.values(), ids=SYSTEMS)
@pytest.mark.parametrize("of_shape", [False, True], ids=["system", "shape"])
@pytest.mark.parametrize("form", ["mjcf", "urdf"])
def test_back_to_the_last_digit(system, of_shape, form, tmp_path):
    write, read = getattr(rc, f"to_{form}"), getattr(rc, f"from_{form}")
    given = shapes_of(system)[0] if of_shape else system
    if getattr(system, "flywheels", None) is not None:
        with pytest.raises(ValueError, match="both hang from body 'link_1'|both hang from body 'link_2'|flywheels"):
            read(write(given))
        return
    if form == "urdf" and isinstance(system, rc.Rig) and np.isfinite(system.support.stiffness):
        with pytest.raises(ValueError, match="URDF has no springs.*use to_mjcf, got a support of stiffness 300"):
            write(given)
        return
    text = write(given, tmp_path / "model.xml")
    for found in (read(text), read(tmp_path / "model.xml"), read(str(tmp_path / "model.xml"))):
        assert type(found) is type(system)
        assert found == system or form == "urdf"
        assert same_numbers(getattr(found, "chain", found), getattr(system, "chain", system))
        if isinstance(system, rc.Rig):
            assert found.support == system.support and found.flywheels is None


@pytest.mark.parametrize("seed", range(20))
def test_back_from_any_numbers(seed):
    rng = np.random.default_rng(seed)
    size = int(rng.integers(1, 9))
    mass, length, centroid, radius = np.exp(rng.normal(0, 2, (4, size)))
    bodies = rc.Chain(mass=mass, length=length, centroid=centroid, radius_of_gyration=radius)
    points = rc.Chain(mass=mass, length=length, names=[f"part {k}" for k in range(size)])
    for chain in (bodies, points):
        assert rc.from_mjcf(rc.to_mjcf(chain)) == rc.from_urdf(rc.to_urdf(chain)) == chain
    pendulums = rc.Chain(mass=mass, length=length, centroid=centroid, pendulum_length=centroid + radius)
    assert rc.from_mjcf(rc.to_mjcf(pendulums)) == pendulums
    assert same_numbers(rc.from_urdf(rc.to_urdf(pendulums)), pendulums)


def test_the_longest_chain():
    """As many bodies as MuJoCo nests, and a carriage."""
    rig = rc.Rig(rc.Chain.uniform_rods(490, mass=1.0), support=rc.Support(radius=0.1, stiffness=9.0))
    assert mujoco.MjModel.from_xml_string(rc.to_mjcf(rig)).nv == 983


def test_an_edited_file_is_read_as_it_is():
    """More digits of the radii of gyration are in the file; they must not outlive a change of the moments."""
    text = rc.to_mjcf(RODS)
    moment = re.findall('diaginertia="(.*) (.*) 1e-15"', text)[-1]
    assert moment[0] == moment[1] and RODS != rc.from_mjcf(text.replace(moment[0], "0.02"))
    wrong = rc.from_mjcf(text.replace(moment[0], "0.02"))
    assert wrong.radius_of_gyration[0] == pytest.approx(np.sqrt(0.02 / RODS.mass[0]), rel=1e-15)
    assert rc.from_mjcf(text.replace('name="gyration_ratio"', 'name="other"')).mass.tolist() == RODS.mass.tolist()


def test_shapes_in_urdf():
    """With all joints at 0 the links are where the shape has them, and a turning support keeps them there."""
    shape = shapes_of(RIGS["arm"])[1]
    model = mujoco.MjModel.from_xml_string(rc.to_urdf(shape))
    model.opt.gravity[2] = -shape.gravity
    data = mujoco.MjData(model)
    data.qvel[0] = shape.angular_speed
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.xpos[links_of(model)], shape.position[1:], rtol=0, atol=1e-14)
    data.qacc[:] = 0
    mujoco.mj_inverse(model, data)
    assert np.abs(data.qfrc_inverse).max() <= 1e-12 * scale(RIGS["arm"])
    assert rc.to_urdf(shape).count('type="continuous"') == 7


def test_urdf_has_one_configuration():
    with pytest.raises(TypeError, match=r"one configuration; give one shape, such as shapes\[0\]"):
        rc.to_urdf(shapes_of(RODS.clamped(0)) and rc.steady_shapes(RODS, angular_speed=9.0))
    with pytest.raises(ValueError, match="URDF has no velocities, which wheels need"):
        rc.to_urdf(RIGS["flywheels"])
    with pytest.raises(TypeError, match="^revchain.to_urdf: system must be a revchain.Chain, Rig or SteadyShape, got None$"):
        rc.to_urdf(None)
    with pytest.raises(TypeError, match="system must be a revchain.Chain, Rig, SteadyShape or SteadyShapes, got None$"):
        rc.to_mjcf(None)
    assert rc.from_urdf(rc.to_urdf(rc.Chain(weight=[4.0, 9.0], length=1.0), gravity=2.0)).mass.tolist() == [2.0, 4.5]


BALLS = """<mujoco><worldbody>
  <body name="upper" pos="0.3 0 2"><joint name="a" type="ball"/>
    <geom type="capsule" fromto="0 0 0  0.6 0 0" size="0.02" mass="2"/>
    <body name="lower" pos="0.7 0.1 0" quat="0.6 0 0.8 0"><joint name="b" type="ball" pos="-0.1 0 0.05"/>
      <inertial pos="-0.1 0.2 0.05" mass="3" diaginertia="0.2 0.02 0.2"/>
    </body></body>
</worldbody></mujoco>"""
PLANE = """<mujoco><worldbody>
  <body name="upper" pos="0 0 2"><joint name="a" type="hinge" axis="0 1 0"/>
    <inertial pos="0 0 -0.2" mass="2" diaginertia="0.3 0.4 0.35"/>
    <body name="lower" pos="0 0 -0.5"><joint name="b" type="hinge" axis="0 1 0"/>
      <inertial pos="0 0 -0.3" mass="3" diaginertia="0.1 0.16 0.1"/><site name="tip" pos="0 0 -0.8"/>
    </body></body>
</worldbody></mujoco>"""


def test_models_of_others():
    """Links along any axis of their frames, pins off its origin, inertia of geoms, free ends by site or geom."""
    plane = rc.from_mjcf(PLANE)
    assert (plane.mass.tolist(), plane.length.tolist(), plane.centroid.tolist()) == ([3.0, 2.0], [0.8, 0.5], [0.3, 0.2])
    assert plane.radius_of_gyration == pytest.approx(np.sqrt([0.16 / 3, 0.4 / 2]), rel=1e-15)
    assert plane.names == ("lower", "upper")
    ended = BALLS.replace(
        "</body></body>", '<geom type="cylinder" fromto="-0.1 0 0.05  -0.1 0.4 0.05" size="0.01"/></body></body>'
    )
    with pytest.raises(ValueError, match="centre of gravity of body 'upper' is not on the line between its pins"):
        rc.from_mjcf(ended)
    # the pin of the lower link, in the frame of the upper: (0.7, 0.1, 0) turned to lie on the x axis
    straight = ended.replace('pos="0.7 0.1 0" quat="0.6 0 0.8 0"', 'pos="0.8 0 -0.05"')
    balls = rc.from_mjcf(straight)
    assert balls.length == pytest.approx([0.4, 0.7], rel=1e-12) and balls.centroid == pytest.approx(
        [0.2, 0.3], rel=1e-12
    )
    assert balls.mass.tolist() == [3.0, 2.0] and balls.radius_of_gyration[0] == pytest.approx(np.sqrt(0.2 / 3))
    turned = straight.replace('pos="0.8 0 -0.05"', 'pos="0.73 0.05 0" quat="0.7071067811865476 0 0.7071067811865476 0"')
    turned = turned.replace('pos="0.73', 'pos="0.65').replace("0.65 0.05 0", "0.65 0 -0.1")
    assert rc.from_mjcf(turned).length == pytest.approx([0.4, 0.7], rel=1e-12)
    arm = rc.to_mjcf(RIGS["arm"]).replace('<body name="link_2" pos="0.3 0 0">', '<body name="link_2" pos="0.3 0 -0.4">')
    assert "-0.4" in arm and rc.from_mjcf(arm).support.radius == 0.3  # from the axis, however low the pin


POLE = '<inertial pos="0 0 -0.4" mass="0.8" diaginertia="0.05 0.05 0.01"/>'
CART = f"""<mujoco><worldbody>
  <body name="cart" pos="0 0 1"><joint name="rail" type="slide" axis="1 0 0" damping="0.2" range="-2 2"/><geom size="0.1" mass="1.5"/>
    <body name="pole"><joint axis="0 1 0" damping="0.3"/>{POLE}
      <body name="tip" pos="0 0 -0.9"><joint axis="0 1 0" stiffness="1.2"/>{POLE}<site pos="0 0 -0.8"/></body>
    </body></body>
</worldbody><actuator><motor joint="rail" ctrlrange="-1 1"/></actuator></mujoco>"""
SPACE_CART = re.sub('(<joint axis="0 1 0" )(.*?/>)', r'\1\2<joint axis="1 0 0" \2', CART)
OTHERS = {
    "plane": PLANE,
    "dashpots": PLANE.replace('"hinge"', '"hinge" damping="0.4"'),
    "springs": PLANE.replace('"hinge"', '"hinge" damping="0.4" stiffness="7"'),
    "cart": CART,
    "cart on a spring": CART.replace('name="rail"', 'name="rail" stiffness="20"'),
    "balls": PLANE.replace('"hinge"', '"ball" damping="0.4" stiffness="7"').replace("0.3 0.4 0.35", "0.3 0.3 0.2"),
}
OTHERS["balls"] = OTHERS["balls"].replace("0.1 0.16 0.1", "0.1 0.1 0.2")


def exponents(text):
    """Exponents of small motions in MuJoCo, from central differences of its forces about the first keyframe or the pose at rest."""
    model = mujoco.MjModel.from_xml_string(text)
    data, size = mujoco.MjData(model), model.nv
    if model.nkey:
        mujoco.mj_resetDataKeyframe(model, data, 0)
    rest, inertia, step = data.qpos.copy(), np.empty((size, size)), 1e-5

    def force(way):
        data.qpos[:], data.qvel[:], data.qacc[:] = rest, way[size:], 0
        mujoco.mj_integratePos(model, data.qpos, way[:size], 1.0)
        mujoco.mj_inverse(model, data)
        return data.qfrc_inverse.copy()

    held = np.stack([(force(step * way) - force(-step * way)) / (2 * step) for way in np.eye(2 * size)], 1)
    force(np.zeros(2 * size))
    for column, way in zip(inertia, np.eye(size), strict=True):
        mujoco.mj_mulM(model, data, column, way)
    faster = -np.linalg.solve(inertia, held)
    return np.linalg.eigvals(np.block([[np.zeros((size, size)), np.eye(size)], [faster]]))


def agree(system, found, gravity, times):
    """All exponents of the modes, and their conjugates, are among those of MuJoCo, whose others are 0 (and twice in space)."""
    wanted = rc.modes(system, gravity=gravity).exponent
    wanted = np.concatenate([wanted, wanted[wanted.imag > 0].conj()])
    assert np.abs(wanted[:, None] - found).min(1).max() < 1e-9 * max(1.0, np.abs(wanted).max())  # measured 1e-11
    assert np.count_nonzero(np.abs(found) > 1e-3) == times * wanted.size


@pytest.mark.parametrize("text", OTHERS.values(), ids=OTHERS)
def test_swing_of_a_model_of_others(text):
    """MuJoCo's own linearised motion has the exponents of the chain or rig that was read."""
    found = exponents(text)
    if "ball" in text:  # the links twist too
        wanted = rc.modes(rc.from_mjcf(text), gravity=9.81).exponent
        assert np.abs(wanted[:, None] - found).min(1).max() < 1e-9
    else:
        agree(rc.from_mjcf(text), found, 9.81, times=1)


def test_carts():
    """What a cart is read as: a trolley on one slide; motors, and the ends of its rail, are left out."""
    rig = rc.from_mjcf(CART)
    assert rig.support == rc.Support(mass=1.5, damping=0.2) and rig.chain.names == ("tip", "pole")
    assert rig.pins == rc.Pin(stiffness=[1.2, 0.0], damping=[0.0, 0.3])
    sprung = rc.from_mjcf(OTHERS["cart on a spring"])
    assert sprung.support == rc.Support(stiffness=20.0, mass=1.5, damping=0.2) and not sprung.inverted.any()
    free = rc.from_mjcf(CART.replace('damping="0.2"', "").replace('damping="0.3"', "").replace('stiffness="1.2"', ""))
    assert free == rc.Rig(rig.chain, support=rc.Support(mass=1.5))


def test_springs_that_hold_links_up():
    """A spring at the lowest pin of a pole that stands says which way it is straight; one that is bent there does not."""
    standing = PLANE.replace('name="a" type="hinge"', 'name="a" type="hinge" stiffness="90" springref="180"')
    assert rc.from_mjcf(standing).inverted.tolist() == [False, True]
    both = standing.replace('name="b" type="hinge"', 'name="b" type="hinge" stiffness="40"')
    assert rc.from_mjcf(both).inverted.tolist() == [True, True]
    assert rc.from_mjcf(both.replace('"180"', '"-180" ref="-180"')).inverted.tolist() == [False, False]


def random_rig(seed):
    rng = np.random.default_rng(seed)
    size = int(rng.integers(1, 6))
    mass, length, centroid, radius = np.exp(rng.normal(0, 0.5, (4, size)))
    chain = rc.Chain(mass=mass, length=length, centroid=centroid, radius_of_gyration=radius)
    trolley, spring = {"mass": 1.3}, {"mass": 0.7, "stiffness": 50.0}
    support = ({}, trolley, trolley | {"damping": 0.7}, spring, spring | {"damping": 2.0})[seed % 5]
    stiffness, damping = rng.uniform(0, [[30.0], [2.0]], (2, size)) * (rng.random((2, size)) < 0.7)
    pins = ({"stiffness": stiffness, "damping": damping}, {"stiffness": stiffness}, {"damping": damping}, {})[seed // 5 % 4]
    return rc.Rig(chain, support=rc.Support(**support), pins=rc.Pin(**pins))


@pytest.mark.parametrize("seed", range(1, 21))
def test_rigs_with_springs_and_dashpots(seed):
    """Written and read they are the same; MuJoCo moves as their modes say, in two directions."""
    rig = random_rig(seed)
    text = rc.to_mjcf(rig)
    found = rc.from_mjcf(text)
    assert found == (rig.chain if rig == rc.Rig(rig.chain) else rig)
    assert getattr(found, "support", rc.Support()) == rig.support
    agree(rig, exponents(text), 9.80665, times=2)


def test_crane_and_double_pendulum():
    """Systems given by weight are the same in kilograms; springs and dashpots in newtons stay."""
    crane = rc.Rig(rc.Chain(mass=4000.0, length=10.0), support=rc.Support(mass=1000.0))
    text = rc.to_mjcf(crane, gravity=9.81)
    assert rc.from_mjcf(text) == crane and "stiffness" not in text
    agree(crane, exponents(text), 9.81, times=2)
    assert rc.modes(crane, gravity=9.81).angular_speed == pytest.approx(np.sqrt(9.81 * 5000.0 / (10.0 * 1000.0)), rel=1e-15)
    how = {"support": rc.Support(stiffness=40.0, damping=3.0, weight=4.0), "pins": rc.Pin(stiffness=2.0, damping=[0.5, 1.5])}
    double = rc.Rig(rc.Chain(weight=[9.0, 18.0], length=[0.6, 0.9]), **how)
    text = rc.to_mjcf(double, gravity=8.0)
    found = rc.from_mjcf(text)
    how["support"] = rc.Support(stiffness=40.0, damping=3.0, mass=0.5)
    assert found == rc.Rig(rc.Chain(mass=[1.125, 2.25], length=[0.6, 0.9]), **how)
    for rig in (double, found):
        agree(rig, exponents(text), 8.0, times=2)


def test_simulation_decays_as_the_modes_say():
    """A push sideways at the free end of a damped double pendulum; its own motion follows after the same time."""
    rig = rc.Rig(rc.Chain.uniform_rods(2, length=1.0, mass=2.0), pins=rc.Pin(stiffness=1.0, damping=[0.3, 0.2]))
    model, data = started(rc.to_mjcf(rig))
    data.joint("link_0_sideways").qvel[:] = push = 1e-6
    rates = []
    for _ in range(200):
        mujoco.mj_step(model, data, 10)
        rates.append([data.joint(f"link_{k}_sideways").qpos[0] for k in (0, 1)])
    found = np.array(rates) / push
    exponent = rc.modes(rig).exponent
    time = np.arange(1, 201) * 10 * model.opt.timestep
    base = np.exp(np.outer(time, exponent))
    base = np.hstack([base.real, base.imag])
    left = found - base @ np.linalg.lstsq(base, found, rcond=None)[0]
    assert np.abs(left).max() < 1e-6 * np.abs(found).max() and model.opt.timestep < 0.02


def test_inverted_links_on_springs():
    """Springs are relaxed where the links stand, and say so when the file is read."""
    rig = rc.Rig(RODS, inverted=[False, True, True], pins=rc.Pin(stiffness=[40.0, 60.0, 90.0], damping=0.2))
    text = rc.to_mjcf(rig)
    assert rc.from_mjcf(text) == rig
    agree(rig, exponents(text), 9.80665, times=2)


def test_dashpots_of_a_steady_shape_are_at_rest():
    """In rigid whirl no hinge moves."""
    rig = rc.Rig(RODS, pins=rc.Pin(damping=0.5), support=rc.Support(stiffness=300.0, mass=0.5))
    for shape in shapes_of(rig):
        model, data = started(rc.to_mjcf(shape))
        data.qacc[:] = 0
        mujoco.mj_inverse(model, data)
        assert np.abs(data.qfrc_inverse).max() <= 1e-12 * scale(rig) and model.dof_damping.any()
    assert rc.from_mjcf(rc.to_mjcf(shapes_of(rig)[0])) == rig


def test_springs_and_dashpots_in_urdf():
    """URDF joints have damping, but no springs."""
    rig = rc.Rig(BODIES, pins=rc.Pin(damping=[0.5, 0.0, 0.2]), support=rc.Support(radius=0.2))
    assert rc.from_urdf(rc.to_urdf(rig)) == rig
    with pytest.raises(ValueError, match="URDF has no springs, and trolleys are not written; use to_mjcf, got springs at pins"):
        rc.to_urdf(rc.Rig(RODS, pins=rc.Pin(stiffness=1.0)))
    with pytest.raises(ValueError, match="trolleys are not written; use to_mjcf, got a support of stiffness 0"):
        rc.to_urdf(rc.Rig(RODS, support=rc.Support(mass=1.0)))


def test_a_turning_support_keeps_axial_moments():
    """Links on hinges below a turntable turn with it, about their own axes too."""
    text = rc.to_mjcf(RIGS["arm"]).replace('1e-15"', '0.001"')
    rig = rc.from_mjcf(text)
    assert rig.support == RIGS["arm"].support
    assert rig.flywheels == rc.Flywheel(axial_moment=0.001)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("</worldbody>", '</worldbody><actuator><position name="servo" joint="b"/></actuator>', "actuator 'servo' of joint 'b' acts without a signal, and a chain has no motors; take it away"),
        ("</worldbody>", '</worldbody><actuator><motor joint="b" ctrllimited="true" ctrlrange="1 2"/></actuator>', "the actuator of joint 'b' acts without a signal, as its ctrlrange does not contain 0; take it away"),
        ("</worldbody>", '</worldbody><actuator><motor joint="a"/><velocity name="brake" joint="b"/></actuator>', "actuator 'brake' of joint 'b' acts without a signal"),
        ("</worldbody>", '</worldbody><equality><connect body1="lower" anchor="0 0 0"/></equality>', "the equality in line 7 is a constraint, which a chain does not have; take it away"),
        ('name="lower"', 'name="lower" gravcomp="1"', r"body 'lower' is held against gravity \(gravcomp\); set gravcomp to 0"),
        ("<worldbody>", '<option density="1.2"/><worldbody>', "in a fluid, whose forces are not read; set density"),
        ("</body></body>", '</body><body><joint/><geom size="1"/></body></body>', "body 'lower' and the body in line 6 both hang from body 'upper'; only a serial chain can be read; name the links"),
        ('name="b" type="hinge"', 'name="b" type="hinge" damping="-0.5"', "joint 'b' has a negative damping, -0.5; give 0 or more"),
        ('name="b" type="hinge"', 'name="b" type="hinge" stiffness="-3"', "joint 'b' has a negative stiffness, -3; give 0 or more"),
        ('name="b" type="hinge"', 'name="b" type="hinge" stiffness="3" springref="20"', "joint 'b' has a spring that is relaxed 20 degrees from the link above; set springref to where the chain is straight"),
        ('name="a" type="hinge"', 'name="a" type="hinge" stiffness="3" springref="20"', "joint 'a' has a spring that is relaxed 20 degrees from the vertical"),
        ('name="a" type="hinge"', 'name="a" type="hinge" springref="1e80"', "springref of all joints must be finite and at most 1e.75, got"),
        ('name="a" type="hinge"', 'name="a" type="hinge" damping="1e80"', "joint 'a': damping must be finite and at most 1e.75, got 1e.80"),
        ('name="b" type="hinge"', 'name="b" type="hinge" armature="0.1"', "joint 'b' has armature 0.1; set it to 0"),
        ('name="b" type="hinge"', 'name="b" type="hinge" frictionloss="1"', "joint 'b' has frictionloss 1; set it to 0"),
        ('name="b" type="hinge"', 'name="b" type="hinge" range="-1 1"', "joint 'b' has a range, -1 to 1 degrees; take it away"),
        ('name="b" type="hinge"', 'name="b" type="slide"', "joint 'b' is neither a hinge nor a ball joint"),
        ('name="b" type="hinge" axis="0 1 0"', 'name="b" type="hinge" axis="1 0 0"', "not level and parallel"),
        ('name="b" type="hinge" axis="0 1 0"', 'name="b" type="hinge" axis="0 0 1"', "links have one hinge each, but these are not level and parallel"),
        ('pos="0 0 -0.5"', 'pos="0 0 0"', "body 'upper' has mass but no length"),
        ('<joint name="a" type="hinge" axis="0 1 0"/>', '<freejoint name="a"/>', "joint 'a' is neither a hinge nor a ball joint"),
        ('<joint name="a" type="hinge" axis="0 1 0"/>', '<joint type="slide" axis="1 0 1"/>', "body 'upper' slides, but not on two level joints at right angles, nor on one in a plane model"),
        ('<joint name="a" type="hinge" axis="0 1 0"/>', '<joint name="rail" type="slide" axis="1 0 0" range="0 1"/>', "joint 'rail' has a range, 0 to 1 m; take it away"),
    ],
)  # fmt: skip
def test_what_is_no_chain(old, new, message):
    assert old in PLANE
    with pytest.raises(ValueError, match=rf"(?s)^revchain.from_mjcf: .*{message}"):
        rc.from_mjcf(PLANE.replace(old, new))


SPRING = rc.to_mjcf(RIGS["spring"])
SPRUNG = rc.to_mjcf(rc.Rig(RODS, support=rc.Support(stiffness=300.0), pins=rc.Pin(stiffness=4.0, damping=0.5)))
BALL = PLANE.replace('name="b" type="hinge" axis="0 1 0"', 'name="b" type="ball"')


@pytest.mark.parametrize(
    ("text", "old", "new", "message"),
    [
        (SPRING, 'stiffness="300"', 'stiffness="300" frictionloss="2"', "joint 'carriage_x' has frictionloss 2; set it to 0"),
        (SPRING, 'axis="0 1 0" stiffness="300"', 'axis="0 1 0" stiffness="300" damping="2"', "the joints of body 'carriage' have damping 0 and 2; give both the same"),
        (SPRUNG, 'name="link_1_sideways" type="hinge" axis="1 0 0" stiffness="4"', 'name="link_1_sideways" type="hinge" axis="1 0 0"', "the joints of body 'link_1' have stiffness 4 and 0; give both the same"),
        (SPRUNG, 'name="link_1_sideways" type="hinge" axis="1 0 0"', 'name="link_1_sideways" type="hinge" axis="1 0.1 0"', "springs and dashpots at the pin of body 'link_1' need one hinge, two at right angles or a ball"),
        (SPRUNG, '<joint name="link_0_inclination"', '<joint axis="0 0 1" stiffness="4" damping="0.5"/><joint name="link_0_inclination"', "springs and dashpots at the pin of body 'link_0' need"),
        (SPRUNG.replace('axis="0 1 0" stiffness="300"', 'axis="0 1 0"'), "", "", "the joints of body 'carriage' have stiffness 300 and 0"),
        (SPACE_CART, "", "", "joint 'rail' is the only slide, but the links do not move in its plane alone"),
        (SPRING, 'stiffness="300"', 'stiffness="300" springref="0.1"', r"'carriage_x' has a spring that is not at rest \(springref\)"),
        (SPRING, 'axis="0 1 0" stiffness="300"', 'axis="0 1 0" stiffness="200"', "the joints of body 'carriage' have stiffness 300 and 200; give both the same"),
        (SPRING, 'axis="0 1 0" stiffness="300"', 'axis="0 1 1" stiffness="300"', "'carriage' slides, but not on two level joints at right angles"),
        (BALL, "", "", "body 'lower' is not alike all round its axis"),
        (BALL, "0.1 0.16 0.1", "0.16 0.16 0.1", "some links have one hinge and some have more"),
        (PLANE, '<joint name="a"', '<joint pos="0 0 0.1" axis="1 0 0"/><joint name="a"', "the joints of body 'upper' are at different places"),
        (BALLS.replace("0.02 0.2", "0.2 0.2"), "", "", "centre of gravity of body 'upper' is not on the line between its pins, and it does not move in one plane"),
    ],
)  # fmt: skip
def test_what_is_no_carriage_or_link(text, old, new, message):
    assert old in text
    with pytest.raises(ValueError, match=message):
        rc.from_mjcf(text.replace(old, new) if old else text)


def test_a_support_without_links():
    text = rc.to_mjcf(rc.Chain(mass=1.0, length=1.0)).partition('<body name="link')[0] + "</body></worldbody></mujoco>"
    with pytest.raises(ValueError, match="no link hangs from the support"):
        rc.from_mjcf(text)


NUMBER = re.compile(r'(?<=[" ])-?\d[\d.e+-]*(?=[" ])')
WILD = ("nan", "inf", "-inf", "0", "-1", "x", "", "5e-324", "1e-155", "1e-16", "1e76", "1e155", "1e200", "-1e200", "1e308", "1e400")


def changed(text, draw):
    """A model in which some numbers, or any letter, are others."""
    for _ in range(draw.choice((1, 1, 2, 3))):
        numbers = list(NUMBER.finditer(text))
        if numbers and draw.random() < 0.9:
            begin, end = draw.choice(numbers).span()
            text = text[:begin] + draw.choice(WILD) + text[end:]
        else:
            at = draw.randrange(1, len(text))
            text = text[:at] + draw.choice("<>\"' 0aZ-.e") + text[at + 1 :]
    return text


def test_changed_models(tmp_path, monkeypatch):
    """A model of any numbers is read, or refused in a sentence of ours, without a warning of numpy."""
    monkeypatch.chdir(tmp_path)  # MuJoCo writes a list of its warnings
    models = [(rc.from_mjcf, rc.to_mjcf(system)) for system in (BODIES, *RIGS.values())]
    models += [(rc.from_mjcf, CART), (rc.from_mjcf, SPRUNG)]
    models += [(rc.from_urdf, rc.to_urdf(system)) for system in (BODIES, RIGS["arm"])] + [(rc.from_mjcf, PLANE)]
    outcomes = {"read": 0, "refused": 0}
    for seed in range(300):
        draw = random.Random(seed)
        read, text = draw.choice(models)
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", "Inertia matrix is too close to singular")  # MuJoCo's own
            try:
                read(changed(text, draw))
                outcomes["read"] += 1
            except ValueError as error:
                assert str(error).startswith(f"revchain.{read.__name__}: "), seed
                outcomes["refused"] += 1
    assert min(outcomes.values()) > 30


@pytest.mark.parametrize(
    ("read", "source", "kind", "message"),
    [
        (rc.from_mjcf, rc.to_urdf(RODS), ValueError, "source must begin with <mujoco>, got <robot>, a URDF file: use from_urdf"),
        (rc.from_urdf, "<a/>", ValueError, "source must begin with <robot>, got <a>, neither MJCF nor URDF"),
        (rc.from_mjcf, "<mujoco>", ValueError, "no element found|not well-formed"),
        (rc.from_mjcf, "<mujoco><chain/></mujoco>", ValueError, ".*unrecognized"),
        (rc.from_mjcf, "<mujoco/>", ValueError, "the model has no joints"),
        (rc.from_mjcf, "missing/nothing.xml", OSError, "No such file or directory: .*nothing.xml"),
        (rc.from_urdf, 3, TypeError, "source must be a path"),
    ],
)  # fmt: skip
def test_what_is_no_model(read, source, kind, message):
    with pytest.raises(kind, match=message if kind is OSError else f"{read.__name__}: ({message})"):
        read(source)


def test_mujoco_is_an_extra(python, without):
    program = without("mujoco") + (
        "import revchain as rc\n"
        "text = rc.to_mjcf(rc.Chain(mass=1.0, length=1.0)); rc.to_urdf(rc.Chain(mass=1.0, length=1.0))\n"
        "try: rc.from_mjcf(text)\n"
        "except ImportError as error: print(error)\n"
    )
    done = python("-c", program)
    assert done.stdout == 'revchain.from_mjcf needs mujoco: pip install "revchain[exchange]"\n', done.stderr
