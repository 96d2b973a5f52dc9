# SPDX-License-Identifier: GPL-3.0-or-later
"""Models as other people write them: what is read, what is left out or refused, and the command that makes a scene of it."""

import pickle
import re
import shlex
import tomllib
import warnings
from pathlib import Path

import numpy as np
import pytest

import revchain as rc
from revchain.exchange.findings import WORDS
from revchain.exchange.read import read_model
from revchain.scenes.write import scene_text

mujoco = pytest.importorskip("mujoco")

ALL_WORDS = ", ".join(WORDS)


def speeds_in_mujoco(text, start=None, damped=False):
    """Natural speeds of small motion about the rest position, or all exponents with damping, in MuJoCo.

    The mass matrix is MuJoCo's, the stiffness is the central difference of its forces at rest; limits, friction and
    damping are off. Newton's method finds the rest position from `start`, the angles of the joints.
    """
    model = mujoco.MjModel.from_xml_string(text)
    damping = np.ravel(model.dof_damping)[:: np.size(model.dof_damping) // model.nv].copy()
    model.dof_damping[:], model.jnt_limited[:], model.dof_frictionloss[:] = 0, 0, 0
    data, size = mujoco.MjData(model), model.nv
    pose = model.qpos0 + (0 if start is None else np.asarray(start))

    def force(away):
        data.qpos[:], data.qvel[:] = pose, 0
        mujoco.mj_integratePos(model, data.qpos, away, 1.0)
        mujoco.mj_forward(model, data)
        return data.qfrc_bias - data.qfrc_passive

    def stiffness(step=1e-5):
        return np.stack([(force(step * way) - force(-step * way)) / (2 * step) for way in np.eye(size)], 1)

    for _ in range(12):
        mujoco.mj_integratePos(model, pose, -np.linalg.pinv(stiffness(), rcond=1e-9) @ force(np.zeros(size)), 1.0)
    held, inertia = stiffness(), np.empty((size, size))
    force(np.zeros(size))
    for column, way in zip(inertia, np.eye(size), strict=True):
        mujoco.mj_mulM(model, data, column, way)
    if damped:
        inverse = np.linalg.inv(inertia)
        return np.linalg.eigvals(np.block([[np.zeros((size, size)), np.eye(size)], [-inverse @ held, -inverse * damping]]))
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(inertia, held)).real)
    assert squares[0] > -1e-6 * squares[-1]  # a rest position that is stable, but for a trolley
    return np.sqrt(squares[squares > 1e-6 * squares[-1]])


def read(text, **how):
    """The system and what the warning says; `text` or a path, MJCF or URDF."""
    is_urdf = "<robot" in str(text) or str(text).endswith("urdf")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        system = (rc.from_urdf if is_urdf else rc.from_mjcf)(text, **how)
    assert len(said) < 2 and all(each.category is rc.ModelWarning for each in said)
    return system, said[0].message if said else None


def agrees(text, start=None, others=None, **how):
    """The speeds of the system that was read are those of MuJoCo's linearisation, of `others` where MuJoCo refuses the text."""
    system, said = read(text, **how)
    wanted = speeds_in_mujoco(others or text, start)
    assert rc.modes(system, gravity=said.gravity).angular_speed == pytest.approx(wanted, rel=1e-9)  # measured 1e-10
    return system, said


def hinged(size, rng, cart=False):
    """A chain of any bodies on parallel hinges: centres beside the pins, offsets along the axes, hinges of any direction."""
    turn = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    quat = np.empty(4)
    mujoco.mju_mat2Quat(quat, turn.ravel())
    row = lambda vector: " ".join(map(repr, map(float, vector)))  # noqa: E731
    inside = "<site pos='0 0 -9'/>"
    for k in range(size):
        off = rng.uniform(-0.2, 0.2, 2)
        centre = np.array([off[0], rng.uniform(-0.5, 0.5), -rng.uniform(0.2, 1.0)])
        pin = np.array([off[1], rng.uniform(-0.5, 0.5), -rng.uniform(0.3, 1.5)])
        moments = rng.uniform(0.1, 0.2, 3)
        rotor = ' armature="0.03"' if k == size - 1 else ""
        inside = (
            f'<body name="b{k}" pos="@"><joint name="j{k}" axis="0 1 0"{rotor}/>'
            f'<inertial pos="{row(centre)}" mass="{float(np.exp(rng.normal()))!r}" diaginertia="{row(moments)}"/>'
            + inside.replace("@", row(pin))
            + "</body>"
        )
    if cart:
        inside = f'<body name="cart" pos="0 0 3"><joint name="rail" type="slide" axis="1 0 0"/><geom size="0.1" mass="2"/>{inside.replace("@", "0 0 0")}</body>'
        return f'<mujoco><option gravity="0 0 -9.81"/><worldbody>{inside}</worldbody></mujoco>'
    frame = f'<body pos="1 2 3" quat="{row(quat)}">{inside.replace("@", "0 0 0")}</body>'
    down = turn @ np.array([0.3, rng.uniform(-0.8, 0.8), -1.0])  # in the plane of the hinges, and across it
    return f'<mujoco><option gravity="{row(9.81 * down / np.linalg.norm(down))}"/><worldbody>{frame}</worldbody></mujoco>'


@pytest.mark.parametrize("seed", range(12))
def test_any_bodies_on_parallel_hinges(seed):
    """Exact for small motion: centres of gravity beside the line of the pins, hinges that are not level, a rotor at the top."""
    rng = np.random.default_rng(seed)
    size = int(rng.integers(1, 6))
    system, said = agrees(hinged(size, rng))
    assert system.size == size and said.gravity < 9.81
    assert any(" is inclined by " in each for each in said.remarks)
    assert sum("beside the line of its pins" in each for each in said.remarks) == size - 1
    trolley, _ = agrees(hinged(size, rng, cart=True))
    assert trolley.support == rc.Support(mass=2.0)


@pytest.mark.parametrize("beside", [0.0, 0.02, 0.3])
def test_offsets_along_the_hinges(beside):
    """In a plane they have no effect."""
    ball = '<geom pos="0 0 -0.5" size="0.05" mass="1"/>'
    text = f"""<mujoco><worldbody><body name="upper" pos="0 0 2"><joint axis="0 1 0"/>{ball}
      <body name="lower" pos="0 {beside} -1"><joint axis="0 1 0"/>{ball}</body></body></worldbody></mujoco>"""
    system, said = agrees(text)
    assert rc.modes(system, gravity=9.81).angular_speed == pytest.approx([2.78066119, 12.07697545], abs=1e-8)
    assert said.remarks == () == said.left_out  # the end of the geoms is the free end


UPRIGHT = """<mujoco model="acrobat">
  <default><joint axis="0 1 0" damping="0.4"/><geom type="capsule" size="0.05"/></default>
  <option><flag constraint="disable"/></option>
  <worldbody><geom name="floor" type="plane" size="3 3 .2" material="grid"/>
    <body name="arms" pos="0 0 2"><joint name="bar" frictionloss="9"/><geom fromto="0 0 0 0 0 1" mass="3"/>
      <body name="legs" pos="0 0 1"><joint name="hips" range="-1 1"/><geom fromto="0 0 0 0 0 0.8" mass="2"/>
        <body name="shoes" pos="0.02 0 0.8"><geom type="sphere" size="0.06" mass="0.7"/></body>
      </body>
    </body>
  </worldbody>
  <actuator><motor joint="hips"/></actuator>
</mujoco>"""


def test_a_model_that_stands_in_its_file():
    """It is read hanging. Materials that are nowhere, disabled limits and friction do not count; fixed bodies are one."""
    bare = UPRIGHT.replace(' material="grid"', "")
    system, said = agrees(UPRIGHT, start=[np.pi, 0.0], others=bare, ignore="damping")
    assert system.names == ("legs", "arms") and system.mass.tolist() == [2.7, 3.0]
    assert said.left_out == ("line 5: joint 'bar' has damping 0.4", "line 6: joint 'hips' has damping 0.4")
    assert said.remarks == (
        "line 5: body 'arms', body 'legs' point up in the pose of the file (qpos0): read hanging",
        "line 11: the actuator of joint 'hips' exerts no force without a signal: left out",
    )
    damped, said = read(UPRIGHT)
    assert damped.pins == rc.Pin(damping=[0.4, 0.4]) and said.left_out == ()
    found = speeds_in_mujoco(bare, [np.pi, 0.0], damped=True)
    assert np.abs(rc.modes(damped, gravity=9.81).exponent[:, None] - found).min(1).max() < 1e-8
    with pytest.raises(ValueError, match="for 2 reasons"):
        read(UPRIGHT.replace("disable", "enable"))


ROBOT = """<?xml version="1.0"?>
<robot xmlns="http://drake.mit.edu" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance" xsi:schemaLocation="a b" name="two">
  <link name="base"><inertial><mass value="1"/><inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="weld" type="fixed"><parent link="world"/><child link="base"/></joint>
  <link name="arm">
    <inertial><origin xyz="0 0 -1"/><mass value="0.5"/><inertia ixx="0" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial>
    <visual><geometry><mesh filename="package://nowhere/arm.stl"/></geometry></visual>
  </link>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="arm"/><axis xyz="0 1 0"/><limit lower="0" upper="0" effort="0" velocity="0"/>
    <dynamics damping="0.2" friction="0.1"/>
  </joint>
  <link name="bob">
    <inertial><origin xyz="0 0 -0.5"/><mass value="0.5"/><inertia ixx="0.1" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial>
    <collision><geometry><mesh filename="bob.stl"/></geometry></collision>
  </link>
  <joint name="bob_weld" type="fixed"><parent link="arm"/><child link="bob"/><origin xyz="0 0 -0.5"/></joint>
  <link name="dummy"/>
  <joint name="swivel" type="continuous"><parent link="arm"/><child link="dummy"/><origin xyz="0 0.2 -1" rpy="1.57 0 0"/><axis xyz="0 0 -1"/></joint>
  <link name="leg"><inertial><origin xyz="0 0 -2"/><mass value="1"/><inertia ixx="1" iyy="0.3" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <joint name="knee" type="fixed"><parent link="dummy"/><child link="leg"/><origin xyz="0 0 0" rpy="-1.57 0 0"/></joint>
</robot>"""


def test_a_robot_that_mujoco_refuses():
    """An undeclared world, namespaces, point masses, lost meshes, limits of equal ends, rounded angles, a dummy link."""
    with pytest.raises(ValueError):
        mujoco.MjModel.from_xml_string(ROBOT)
    with pytest.raises(ValueError, match=r"from_urdf: line 9: joint 'shoulder' has frictionloss 0.1; set it to 0, or ignore=\"friction\"$"):
        rc.from_urdf(ROBOT)
    rig, said = read(ROBOT, ignore="friction")
    assert rig.pins == rc.Pin(damping=[0.0, 0.2]) and said.left_out == ("line 9: joint 'shoulder' has frictionloss 0.1",)
    assert rig.chain.names == ("dummy", "arm")
    assert rig.chain.mass.tolist() == [1.0, 1.0] and rig.chain.centroid == pytest.approx([2.0, 1.0], rel=1e-6)
    assert rig.chain.radius_of_gyration == pytest.approx([np.sqrt(0.3), 0.0], rel=1e-6)
    words = " ".join(said.remarks)
    for part in ("'world' is not declared", "'arm' has a point mass", "'bob' has moments of inertia that no body has",
                 "meshes are not read, as masses are in the file: arm, bob", "'shoulder' has limits of equal ends, 0", "free end of link 'dummy'"):  # fmt: skip
        assert part in words
    assert "URDF has no gravity; that of MuJoCo is 9.81 m/s^2: give gravity=9.81 in questions" in str(said)
    speeds = rc.modes(rig.chain, gravity=9.81).angular_speed
    # by hand: 1 kg at 1 m, then 1 kg at 2 m with 0.3 kg m^2
    squares = np.linalg.eigvals(np.linalg.solve([[2.0, 2.0], [2.0, 4.3]], np.diag([2 * 9.81, 2 * 9.81])))
    assert speeds == pytest.approx(np.sqrt(np.sort(squares)), rel=1e-6)  # 1.57 for a right angle


def test_a_cart_in_urdf():
    body = '<inertial><origin xyz="0 0 {}"/><mass value="{}"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>'
    text = f"""<robot name="cartpole"><link name="bar">{body.format(0, 0)}</link><link name="cart">{body.format(0, 2)}</link>
      <joint name="rail" type="prismatic"><axis xyz="1 0 0"/><parent link="bar"/><child link="cart"/><limit lower="-5" upper="5" effort="1" velocity="1"/></joint>
      <link name="pole">{body.format(0.5, 10)}</link>
      <joint name="pin" type="continuous"><axis xyz="0 1 0"/><parent link="cart"/><child link="pole"/></joint></robot>"""
    rig, said = agrees(text, start=[0.0, np.pi])
    assert rig.support == rc.Support(mass=2.0) and rig.chain.length.tolist() == [0.5]
    assert "link 'bar' hangs from no joint: taken as the ground" in said.remarks[0]
    assert any("joint 'rail' has a range, -5 to 5 m: the ends of the rail are left out" in each for each in said.remarks)


FULL = """<mujoco model="full">
  <option density="1.2"/>
  <worldbody>
    <body name="upper" pos="0 0 2" gravcomp="0.5">
      <joint name="a" axis="0 1 0" frictionloss="0.1" range="-30 30"/>
      <inertial pos="0 0 -0.2" mass="2" diaginertia="0.3 0.4 0.35"/>
      <body pos="0 0 -0.5">
        <joint axis="0 1 0" armature="0.2" stiffness="3" springref="20"/>
        <inertial pos="0 0 -0.3" mass="3" diaginertia="0.1 0.16 0.1"/><site pos="0 0 -0.8"/>
      </body>
    </body>
  </worldbody>
  <tendon><fixed name="cable" stiffness="5"><joint joint="a" coef="1"/></fixed></tendon>
  <equality><joint joint1="a"/></equality>
  <actuator><position name="servo" joint="a"/></actuator>
</mujoco>"""
REASONS = [
    ("fluid", "line 2: the model is in a fluid, whose forces are not read"),
    ("gravcomp", "line 4: body 'upper' is held against gravity (gravcomp)"),
    ("range", "line 5: joint 'a' has a range, -30 to 30 degrees"),
    ("friction", "line 5: joint 'a' has frictionloss 0.1"),
    ("stiffness", "line 8: the joint in line 8 has a spring that is relaxed 20 degrees from the link above"),
    ("armature", "line 8: the joint in line 8 has armature 0.2"),
    ("tendon", "line 13: tendon 'cable' pulls at the links, which a chain does not have"),
    ("equality", "line 14: the equality in line 14 is a constraint, which a chain does not have"),
    ("actuator", "line 15: actuator 'servo' of joint 'a' acts without a signal, and a chain has no motors"),
]


def test_all_obstacles_at_once():
    with pytest.raises(ValueError) as raised:
        rc.from_mjcf(FULL)
    first, *lines, last = str(raised.value).splitlines()
    assert first == "revchain.from_mjcf: the model is no hanging chain, for 9 reasons:"
    assert last == f'  ignore="{" ".join(sorted(word for word, _ in REASONS))}" reads the file without them'
    for line, (word, reason) in zip(lines, REASONS, strict=True):
        assert line.startswith(f"  {reason}; ") and line.endswith(f', or ignore="{word}"')


@pytest.mark.parametrize("word", [word for word, _ in REASONS])
def test_each_word_leaves_out_its_own(word):
    with pytest.raises(ValueError) as raised:
        rc.from_mjcf(FULL, ignore=word)
    assert "for 8 reasons" in str(raised.value) and dict(REASONS)[word] not in str(raised.value)


def test_the_message_has_all_words_that_are_needed():
    """Those that were given, too, so that it can be copied."""
    words = [word for word, _ in REASONS]
    with pytest.raises(ValueError) as raised:
        rc.from_mjcf(FULL, ignore=words[1:])
    said = re.search(r'; set density and viscosity of option to 0, or ignore="(.*)"$', str(raised.value))[1]
    assert sorted(said.split()) == sorted(words) and read(FULL, ignore=said)[1].left_out


@pytest.mark.parametrize(
    "ignore", ["all", [word for word, _ in REASONS], tuple(WORDS), ", ".join(WORDS), " ".join(WORDS), {"all"}]
)
def test_what_is_left_out_is_listed(ignore):
    chain, said = read(FULL, ignore=ignore)
    assert (chain.mass.tolist(), chain.length.tolist(), chain.centroid.tolist()) == ([3.0, 2.0], [0.8, 0.5], [0.3, 0.2])
    assert chain.radius_of_gyration == pytest.approx(np.sqrt([0.16 / 3, 0.4 / 2]), rel=1e-15)
    assert sorted(said.left_out) == sorted(reason for _, reason in REASONS)
    assert said.gravity == 9.81 and str(said).startswith("gravity of the model is 9.81 m/s^2: give gravity=9.81 in questions\nleft out:")
    twin = pickle.loads(pickle.dumps(said))
    assert (str(twin), twin.gravity, twin.left_out, twin.remarks) == (str(said), 9.81, said.left_out, said.remarks)


def test_the_warning_names_the_line_of_the_caller():
    with pytest.warns(rc.ModelWarning) as said:
        rc.from_mjcf(FULL, ignore="all")
    assert said[0].filename == __file__


def test_no_warning_without_a_reason():
    chain = rc.Chain(mass=[1.0, 3.0], length=1.0)
    assert read(rc.to_mjcf(chain)) == (chain, None) == read(rc.to_urdf(chain))
    assert read(rc.to_mjcf(chain, gravity=1.62))[1].gravity == 1.62


@pytest.mark.parametrize(
    ("how", "kind", "message"),
    [
        ({"ignore": "dampin"}, ValueError, f"ignore must have words of {ALL_WORDS}, or be \"all\", got 'dampin'; did you mean damping[?]"),
        ({"ignore": ("damping", "")}, ValueError, "ignore must have words of .*, got ''"),
        ({"ignore": 3}, TypeError, "ignore must be text or a tuple of texts, got 3"),
        ({"ignore": ("damping", 3)}, TypeError, "ignore must be text or a tuple of texts, got"),
        ({"ignore": "all", "links": "uper"}, ValueError, "links must be names of bodies, 'upper'; got 'uper'"),
        ({"links": 3}, TypeError, "links must be text or a tuple of texts, got 3"),
    ],
)  # fmt: skip
def test_wrong_words(how, kind, message):
    with pytest.raises(kind, match=f"^revchain.from_mjcf: {message}"):
        rc.from_mjcf(FULL, **how)


ROD = '<geom type="capsule" fromto="0 0 0 0 0 -0.4" size="0.02" mass="1"/>'
TREE = f"""<mujoco><worldbody>
  <body name="root"><joint axis="0 1 0"/>{ROD}
    <body name="left arm" pos="0 0 -0.4"><joint axis="0 1 0"/>{ROD}</body>
    <body name="right" pos="0 0 -0.4"><joint axis="0 1 0"/>{ROD}
      <body name="low" pos="0 0 -0.4"><joint axis="0 1 0"/>{ROD}</body></body>
  </body>
  <body name="ball" pos="1 0 0"><freejoint/><geom size="0.1"/></body>
</worldbody></mujoco>"""


def test_a_tree_and_the_chain_to_take():
    with pytest.raises(ValueError) as raised:
        rc.from_mjcf(TREE)
    both = 'hang from {}; only a serial chain can be read; name the links of one chain, such as links="root right low"'
    assert f"line 3: body 'left arm' and body 'right' both {both.format(chr(98) + 'ody ' + repr('root'))}" in str(raised.value)
    assert f"line 7: body 'root' and body 'ball' both {both.format('the ground')}" in str(raised.value)
    for links in ("root right low", ["low"], ("low", "root")):
        chain, said = read(TREE, links=links)
        assert chain.names == ("low", "right", "root") and chain.length == pytest.approx(0.4)
        assert said.left_out[0] == "line 3: body 'left arm', 1 kg with what hangs from it, is not among links"
        assert said.left_out[1].startswith("line 7: body 'ball', 4.18879 kg with")
    assert read(TREE, links="left arm,")[0].names == ("left arm", "root")
    assert read(TREE, links="right")[0].names == ("right", "root")
    with pytest.raises(ValueError, match=r"links must be names of bodies, 'root', 'left arm', 'right', 'low', 'ball'; got 'left'"):
        rc.from_mjcf(TREE, links="left arm")
    with pytest.raises(ValueError, match="'left arm' and body 'right' both hang from body 'root'"):
        rc.from_mjcf(TREE, links=("left arm", "low"))
    unnamed = re.sub(r' name="[^"]*"', "", TREE)
    with pytest.raises(ValueError, match="line 3: the body in line 3 and the body in line 4 both hang from the body in line 2; .*; name the bodies"):
        rc.from_mjcf(unnamed)


def test_all_that_hang_from_one_body_are_named():
    three = TREE.replace('<body name="low"', '<body name="more"/><body name="low"').replace('name="more"/>', 'name="more"><joint/><geom size="1"/></body>')
    third = three.replace("</body></body>", f'</body><body name="last"><joint axis="0 1 0"/>{ROD}</body></body>', 1)
    with pytest.raises(ValueError, match="body 'more', body 'low' and body 'last' all hang from body 'right'"):
        rc.from_mjcf(third, links="right low more last")


TWO_ARMS = f"""<mujoco><worldbody>
  <body name="left" pos="1 0 0"><joint name="l" axis="0 1 0"/>{ROD}
    <body name="left hand" pos="0 0 -0.4" gravcomp="1"><joint name="lh" axis="0 1 0"/>{ROD}<site name="palm"/></body></body>
  <body name="right"><joint name="r" axis="0 1 0"/>{ROD}
    <body name="right hand" pos="0 0 -0.4"><joint name="rh" axis="0 1 0"/>{ROD}<site name="fist"/></body></body>
</worldbody>
<tendon><fixed name="cord" stiffness="5"><joint joint="lh" coef="1"/></fixed>
  <spatial name="rope" stiffness="3"><site site="palm"/><site site="post"/></spatial></tendon>
<equality><joint joint1="l" joint2="lh"/><weld body1="left"/><connect site1="palm" site2="post"/></equality>
<actuator><position name="servo" joint="l"/><position joint="lh"/><position tendon="cord"/><position site="palm"/></actuator>
<sensor><jointpos joint="lh"/></sensor>
</mujoco>""".replace("<worldbody>", '<worldbody><site name="post" pos="1 0 -2"/>')


def test_what_acts_on_another_branch_is_left_out_with_it():
    chain, said = read(TWO_ARMS, links=("right", "right hand"))
    assert chain == read(re.sub(r"<(tendon|equality|actuator|sensor)>.*</\1>", "", TWO_ARMS, flags=re.S), links=("right", "right hand"))[0]
    assert said.left_out == (
        "line 2: body 'left', 2 kg with what hangs from it, is not among links",
        *(f"line {line}: {what} acts on no body among links" for line, what in [
            (7, "tendon 'cord'"), (8, "tendon 'rope'"), (9, "the equality in line 9"), (9, "the equality in line 9"),
            (9, "the equality in line 9"), (10, "actuator 'servo' of joint 'l'"), (10, "the actuator of joint 'lh'"),
            (10, "the actuator of site 'palm'"), (10, "the actuator of tendon 'cord'"),
        ]),
    )  # fmt: skip
    assert said.remarks == ()


@pytest.mark.parametrize(
    ("old", "new", "reason"),
    [
        ('name="servo" joint="l"', 'name="servo" joint="r"', "actuator 'servo' of joint 'r' acts without a signal"),
        ('tendon="cord"', 'joint="rh"', "the actuator of joint 'rh' acts without a signal"),
        ('<joint joint="lh" coef="1"/>', '<joint joint="lh" coef="1"/><joint joint="rh" coef="1"/>', "tendon 'cord' pulls"),
        ('<site site="post"/></spatial>', '<site site="fist"/></spatial>', "tendon 'rope' pulls"),
        ('joint2="lh"', 'joint2="rh"', "line 9: the equality in line 9 is a constraint"),
        ('site2="post"', 'site2="fist"', "line 9: the equality in line 9 is a constraint"),
        ('<weld body1="left"', '<weld body1="right"', "line 9: the equality in line 9 is a constraint"),
        ('name="right hand"', 'name="right hand" gravcomp="1"', "body 'right hand' is held against gravity"),
    ],
)
def test_what_acts_on_the_chain_is_an_obstacle(old, new, reason):
    """Also where it acts on another branch besides."""
    assert TWO_ARMS.count(old) == 1
    with pytest.raises(ValueError, match=reason):
        rc.from_mjcf(TWO_ARMS.replace(old, new), links=("right", "right hand"))


def test_the_last_line_names_links_where_they_help():
    with pytest.raises(ValueError) as raised:
        rc.from_mjcf(TREE)
    assert str(raised.value).splitlines()[-1] == '  links="root right low" reads the file without them'
    braked = TREE.replace('<joint axis="0 1 0"/>', '<joint axis="0 1 0" frictionloss="1"/>')
    with pytest.raises(ValueError) as raised:
        rc.from_mjcf(braked)
    last = str(raised.value).splitlines()[-1]
    assert last == '  ignore="friction" and links="root right low" read the file without them'
    assert read(braked, ignore="friction", links="root right low")[0] == read(TREE, links="low")[0]
    with pytest.raises(ValueError) as raised:
        rc.from_mjcf(braked.replace("<worldbody>", '<option gravity="0 0 0"/><worldbody>'))
    last = str(raised.value).splitlines()[-1]
    assert last.endswith('links="root right low" remove some of these reasons; the others need a change of the model')


@pytest.mark.parametrize(("tilt", "is_said"), [(0, True), (30, True), (60, False), (180, False)])
def test_a_pole_that_stands_in_its_file(tilt, is_said):
    """A remark says that it is read hanging, unless it hangs, or stands on a spring."""
    pole = '<mujoco><compiler angle="degree"/><worldbody><body name="pole" euler="0 {} 0"><joint axis="0 1 0"{}/><geom type="capsule" size="0.02" fromto="0 0 0 0 0 1" mass="1"/></body></worldbody></mujoco>'
    remarks = getattr(read(pole.format(tilt, ""))[1], "remarks", ())
    assert remarks == ("line 1: body 'pole' points up in the pose of the file (qpos0): read hanging",) * is_said
    if tilt == 0:
        rig, said = read(pole.format(tilt, ' stiffness="50"'))
        assert rig.inverted.all() and said.remarks == ()


INCLUDING = """<mujoco><include file="looks.xml"/><compiler meshdir="shapes"/>
<asset><mesh name="bob" file="bob.obj"/></asset>
<worldbody><include file="body.xml"/></worldbody></mujoco>"""
INCLUDED = """<mujoco>
<body name="rod"><joint name="pin" axis="0 1 0" frictionloss="1"/>
  <geom type="mesh" mesh="bob"/>{}
</body></mujoco>"""
INERTIAL = '<inertial pos="0 0 -1" mass="2" diaginertia="0 0 0"/>'
CUBE = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]


def test_included_files_and_meshes(tmp_path):
    """The line of an included file; files that are missing, with and without an effect; a mesh that gives the mass."""
    main = tmp_path / "main.xml"
    main.write_text(INCLUDING)
    (tmp_path / "body.xml").write_text(INCLUDED.format(INERTIAL))
    with pytest.raises(ValueError) as raised:
        rc.from_mjcf(main)
    assert [line.strip() for line in str(raised.value).splitlines()[1:]] == [
        "line 1: the included file 'looks.xml' cannot be read; put it there, or ignore=\"visual\"",
        "body.xml, line 2: joint 'pin' has frictionloss 1; set it to 0, or ignore=\"friction\"",
        'ignore="friction visual" reads the file without them',
    ]
    chain, said = read(main, ignore="visual friction")
    assert chain == rc.Chain(mass=2.0, length=1.0, names=["rod"])
    assert any("body.xml, line 3: a geom of body 'rod' shows mesh 'bob', whose file is missing" == each for each in said.remarks)
    (tmp_path / "looks.xml").write_text('<mujoco><asset><texture name="t" file="no.png" type="2d"/></asset></mujoco>')
    assert read(main, ignore="friction")[0] == chain
    (tmp_path / "body.xml").write_text(INCLUDED.format(""))
    with pytest.raises(ValueError, match="shows mesh 'bob', whose file is missing, and gives the body its mass; put the file there, or give the body an inertial, or ignore=\"visual\""):
        rc.from_mjcf(main)
    faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"]
    cube = [f"v {x} {y} {z - 2}" for x, y, z in CUBE] + [f"f {face}" for face in faces]
    (tmp_path / "shapes").mkdir()
    (tmp_path / "shapes" / "bob.obj").write_text("\n".join(cube))
    solid, said = read(main, ignore="friction")
    assert solid.mass == pytest.approx([8000.0]) and solid.centroid == pytest.approx([2.0])
    (tmp_path / "body.xml").write_text("<mujoco><body></mujoco>")
    with pytest.raises(ValueError, match="body.xml, line 1: no XML: mismatched tag"):
        rc.from_mjcf(main)
    with pytest.raises(ValueError, match="included file 'body.xml' cannot be read"):
        rc.from_mjcf(INCLUDING, ignore="friction")  # a text has no folder


JOINT = '<joint name="pin" type="continuous"><parent link="world"/><child link="bob"/><axis xyz="0 1 0"/></joint>'
BOB = f'<link name="bob"><inertial><origin xyz="0 0 -2"/><mass value="3"/></inertial></link>{JOINT}'


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f'<robot><xacro:property name="a"/>{BOB}</robot>', "line 1: xacro:property is not expanded; write xacro FILE > model.urdf"),
        (f"<robot>{BOB}</robot>".replace('"world"', '"ground"'), "line 1: joint 'pin': its parent link 'ground' is not declared; declare it"),
        (f"<robot>{BOB}</robot>".replace('child link="bob"', 'child link="ball"'), "joint 'pin': its child link 'ball' is not declared"),
        (f"<robot>{BOB}</robot>".replace("</joint>", '<mimic joint="a"/></joint>'), r"joint 'pin' moves with another joint \(mimic\); remove it, or ignore=\"equality\""),
        (f"<robot>{BOB}</robot>".replace("continuous", "floating"), "joint 'pin' is neither a hinge nor a ball joint: it moves freely"),
        (f"<robot>{BOB}</robot>".replace("continuous", "screw"), r"line 1: MuJoCo .* refuses it: .*; correct the file"),
        (f"<robot>{BOB}</robot>".replace("0 0 -2", "0 0 0"), "free end of link 'bob' is not marked, and its centre of gravity is at its pin; put a site there"),
        (f"<robot>{BOB}</robot>".replace("0 1 0", "0 0 1"), "no link hangs from the support"),
        (f"<robot>{BOB}</robot>".replace('"3"', '"-3"'), "link 'bob' has a negative mass, -3; give 0 or more"),
    ],
)  # fmt: skip
def test_robots_that_are_refused(text, message):
    with pytest.raises(ValueError, match=f"(?s)^revchain.from_urdf: .*{message}"):
        rc.from_urdf(text)


@pytest.mark.parametrize("change", [("", ""), ("<joint", "<drake:joint"), ("continuous", "ball"), ("continuous", "spherical")])
def test_robots_that_are_read(change):
    text = f"<robot>{BOB}</robot>".replace(*change).replace("</joint", "</drake:joint" if "drake" in change[1] else "</joint")
    assert read(text)[0] == rc.Chain(mass=3.0, length=2.0, names=["bob"])


def test_moments_of_inertia_that_mujoco_refuses():
    """They are read about the axes of their frame; where MuJoCo makes others of them, these count."""
    turned = BOB.replace('"0 0 -2"/>', '"0 0 -2" rpy="0 0 1.5707963267948966"/>')
    turned = turned.replace("</inertial>", '<inertia ixx="0.3" iyy="0" izz="0" ixy="0" ixz="0" iyz="0"/></inertial>')
    chain, said = read(f"<robot>{turned}</robot>")
    assert chain.radius_of_gyration == pytest.approx([np.sqrt(0.1)], rel=1e-14)
    assert "line 1: link 'bob' has moments of inertia that no body has: MuJoCo refuses these, and they are read as they are" in said.remarks
    text = f'<mujoco><worldbody><body name="bob"><joint axis="0 1 0"/><inertial pos="0 0 -2" mass="3" quat="1 0 0 1" diaginertia="0.3 0 0"/></body></worldbody></mujoco>'
    assert read(text)[0].radius_of_gyration == pytest.approx([np.sqrt(0.1)], rel=1e-14)
    full = text.replace('quat="1 0 0 1" diaginertia="0.3 0 0"', 'fullinertia="0 0.3 0 0 0 0"')
    assert read(full)[0].radius_of_gyration == pytest.approx([np.sqrt(0.1)], rel=1e-14)
    balanced = text.replace("<worldbody>", '<compiler balanceinertia="true" boundinertia="1e-9"/><worldbody>')
    assert read(balanced)[0].radius_of_gyration == pytest.approx([np.sqrt(0.1 / 3)], rel=1e-6)
    geoms = text.replace("</body>", '<geom pos="0 0 -1" size="0.1" mass="1"/></body>').replace("<worldbody>", '<compiler inertiafromgeom="true"/><worldbody>')
    assert read(geoms)[0].mass.tolist() == [1.0] and read(geoms)[0].radius_of_gyration == pytest.approx([np.sqrt(0.4) * 0.1])


def test_blank_lines_above_the_declaration(tmp_path):
    """Text in a program often begins with a line feed; lines are counted with it."""
    for above in ("", "\n", "\n\n  "):
        text = f'{above}<?xml version="1.0"?>\n<robot>{BOB}</robot>'.replace("continuous", "floating")
        (tmp_path / "a.urdf").write_text(text)
        for source in (text, tmp_path / "a.urdf"):
            with pytest.raises(ValueError, match=f"line {above.count(chr(10)) + 2}: joint 'pin' is neither a hinge"):
                rc.from_urdf(source)


def test_mass_of_collision_shapes():
    shape = '<collision><origin xyz="0 0 -2"/><geometry><sphere radius="0.1"/></geometry></collision>'
    chain, said = read(f'<robot><link name="bob">{shape}</link>{JOINT}</robot>')
    assert chain.mass == pytest.approx([1000 * 4 / 3 * np.pi * 0.1**3]) and chain.centroid.tolist() == [2.0]
    assert any("link 'bob' has no inertial: its mass is that of its collision shapes, of 1000 kg/m^3" in each for each in said.remarks)


BODY = '<inertial pos="0 0 -0.3" mass="3" diaginertia="0.1 0.16 0.1"/>'


@pytest.mark.parametrize(
    ("mark", "length"),
    [
        ('<site pos="0 0 -0.8"/>', 0.8),
        ('<site pos="0.1 0.2 -0.8"/>', 0.8),  # the foot on the line through the centre of gravity
        ('<site pos="0 0 0.8"/>', 0.3),  # beyond the pin: no mark
        ('<body pos="0 0 -0.7"/>', 0.7),
        ('<body pos="0 0 0"/>', 0.3),  # at the pin: no mark
        ('<geom type="capsule" fromto="0 0 0.1 0 0 -0.9" size="0.1"/>', 0.9),
        ('<geom size="0.1"/>', 0.3),
        ('<site pos="0 0 -0.8"/><site pos="0 0 -0.9"/>', 0.3),
        ("", 0.3),
    ],
)
def test_the_free_end(mark, length):
    """No speed depends on it."""
    text = f'<mujoco><worldbody><body name="rod"><joint axis="0 1 0"/>{BODY}{mark}</body></worldbody></mujoco>'
    chain, said = read(text)
    assert chain.length == pytest.approx([length], rel=1e-15)
    if not mark:
        assert said.remarks == ("line 1: the free end of body 'rod' is not marked: taken at its centre of gravity; no speed depends on it",)
    if abs(chain.centroid[0] - 0.3) < 1e-15:
        assert rc.modes(chain, gravity=9.81).angular_speed == pytest.approx(np.sqrt(9.81 * 0.9 / (0.16 + 3 * 0.09)), rel=1e-14)


def test_a_spring_beside_an_offset_is_refused():
    bent = f"""<mujoco><worldbody><body name="a"><joint axis="0 1 0" stiffness="5"/><inertial pos="0.1 0 -0.3" mass="1" diaginertia="1 1 1"/>
      <body name="b" pos="0 0 -1"><joint axis="0 1 0"/>{BODY}</body></body></worldbody></mujoco>"""
    with pytest.raises(ValueError, match="body 'a' has a spring, and its centre of gravity is 0.1 m beside the line of its pins"):
        rc.from_mjcf(bent)
    agrees(bent.replace(' stiffness="5"', ""))
    assert type(read(bent, ignore="stiffness")[0]) is rc.Chain


def test_a_link_that_turns_over_is_refused():
    """Its first moment points down where its lower pin is above the upper one."""
    text = f"""<mujoco><worldbody><body name="a"><joint axis="0 1 0"/><inertial pos="0.1 0 -3" mass="9" diaginertia="1 1 1"/>
      <body name="b" pos="0 0 1"><joint axis="0 1 0"/>{BODY}</body></body></worldbody></mujoco>"""
    with pytest.raises(ValueError, match="body 'a' hangs with its lower pin above its upper one; a chain needs it below"):
        rc.from_mjcf(text)


def test_a_chain_that_would_stand_is_refused():
    """With what could be left out, in one list."""
    text = f"""<mujoco><worldbody><body name="a"><joint axis="0 1 0"/><inertial pos="0 0 3" mass="9" diaginertia="1 1 1"/>
      <body name="b" pos="0 0 -1"><joint axis="0 1 0" frictionloss="1"/>{BODY}</body></body></worldbody></mujoco>"""
    with pytest.raises(ValueError, match="(?s)for 2 reasons:\n  line 1: body 'a': it would stand, not hang; .*removes some of these reasons"):
        rc.from_mjcf(text)
    with pytest.raises(ValueError, match="^revchain.from_mjcf: line 1: body 'a': it would stand, not hang; .*; change the model$"):
        rc.from_mjcf(text, ignore="friction")


def test_turntables():
    arm = f"""<mujoco><worldbody><body name="arm"><joint name="turn" axis="0 0 1"/><geom size="0.1" mass="1"/>
      <body name="bob" pos="0.5 0 0"><joint name="pin" axis="0 1 0"/>{BODY}</body></body></worldbody></mujoco>"""
    rig, said = read(arm)
    assert rig.support == rc.Support(radius=0.5) and rig.flywheels == rc.Flywheel(axial_moment=0.1)
    assert "joint 'turn' is read as a support that keeps its speed" in " ".join(said.remarks)
    assert "speeds are those of whirl" in " ".join(said.remarks)
    with pytest.raises(ValueError, match="line 2: joint 'pin' swings its link across the arm of the turntable"):
        rc.from_mjcf(arm.replace("0.5 0 0", "0 0.5 0"))
    with pytest.raises(ValueError, match="joint 'pin' turns about the vertical: gravity does not swing its link back"):
        rc.from_mjcf(arm.replace('"0 1 0"', '"0 0 1"').replace("0 0 -0.3", "0.3 0 0"))
    with pytest.raises(ValueError, match="gravity is 0, so that nothing makes the links hang; set gravity of option"):
        rc.from_mjcf(arm.replace("<worldbody>", '<option gravity="0 0 0"/><worldbody>'))


def test_rotors_that_are_read():
    """The inertia of a rotor at the uppermost hinge turns with the link; that of a slide moves with the carriage."""
    text = TREE.partition('<body name="ball"')[0] + "</worldbody></mujoco>"
    chain = re.sub(r'<body name="left arm".*?</body>', "", text).replace('<joint axis="0 1 0"/>', '<joint axis="0 1 0" armature="0.3"/>', 1)
    agrees(chain)
    cart = chain.replace('<body name="root">', '<body name="cart"><joint type="slide" axis="1 0 0" armature="0.7"/><geom size="0.1" mass="1"/><body name="root">')
    rig, _ = agrees(cart.replace("</worldbody>", "</body></worldbody>"))
    assert rig.support == rc.Support(mass=1.7)


GANTRY = f"""<mujoco><worldbody>
  <body name="bridge"><joint name="long" type="slide" axis="0 1 0"/><geom size="0.1" mass="5"/>
    <body name="trolley"><joint name="cross" type="slide" axis="1 0 0" damping="0.3"/><geom size="0.1" mass="2"/>
      <body name="load"><joint axis="0 1 0"/>{BODY}</body></body></body>
</worldbody></mujoco>"""


def test_a_gantry_crane():
    """In a plane the slide across it does not count; the other one moves its body and those that slide on it."""
    rig, said = read(GANTRY)
    assert rig.support == rc.Support(mass=2.0, damping=0.3)
    assert "line 2: joint 'long' slides across the plane in which the links move: left out" in said.remarks
    agrees(GANTRY, ignore="damping")
    along = GANTRY.replace('<joint axis="0 1 0"/>', '<joint axis="1 0 0"/>').replace("0.1 0.16 0.1", "0.16 0.1 0.1")
    rig, said = agrees(along, ignore="damping")
    assert rig.support == rc.Support(mass=7.0) and "joint 'cross' slides across" in " ".join(said.remarks)
    ball = GANTRY.replace('<joint axis="0 1 0"/>', '<joint type="ball"/>').replace("0.1 0.16 0.1", "0.16 0.16 0.1")
    with pytest.raises(ValueError, match="body 'trolley' slides on a body that slides and has mass, and the mass of a support is the same in all"):
        rc.from_mjcf(ball)
    thin = '<inertial pos="0 0 0" mass="1e-15" diaginertia="1e-15 1e-15 1e-15"/>'
    rig, _ = read(ball.replace('<geom size="0.1" mass="5"/>', thin), ignore="damping")
    assert rig.support == rc.Support(mass=2.0)
    both = PLANE_OF_TWO.replace('type="hinge" axis="0 1 0"', 'type="slide" axis="0 1 0"', 1)
    assert type(read(both)[0]) is rc.Chain


PLANE_OF_TWO = TREE.partition('<body name="ball"')[0].replace('name="left arm"', 'name="left"') + "</worldbody></mujoco>"
PLANE_OF_TWO = re.sub(r'<body name="left".*?</body>', "", PLANE_OF_TWO).replace("<joint axis", '<joint type="hinge" axis')


@pytest.mark.parametrize("alone", [False, True])
def test_a_reaction_wheel(alone):
    """A wheel that turns about its centre of gravity is a point mass."""
    wheel = '<body name="wheel" pos="0 0.1 -0.4"><joint axis="0 1 0"/><geom type="cylinder" size="0.1 0.01" zaxis="0 1 0" mass="0.5"/></body>'
    rod = ROD if not alone else '<inertial pos="0 0 -0.1" mass="1" diaginertia="0.01 0.01 0.01"/>'
    text = f'<mujoco><worldbody><body name="rod"><joint axis="0 1 0"/>{rod}{wheel}</body></worldbody></mujoco>'
    chain, said = agrees(text)
    assert chain.mass.tolist() == [1.5] and chain.names == ("rod",)
    assert "body 'wheel' turns freely about its centre of gravity: read as a point mass at its pin" in " ".join(said.remarks)
    braked = text.replace('-0.4"><joint', '-0.4"><joint damping="0.1"')
    with pytest.raises(ValueError, match="body 'wheel' turns about its centre of gravity on a spring or dashpot.*ignore=.damping"):
        rc.from_mjcf(braked)
    assert read(braked, ignore="damping")[0] == chain


def test_settings_of_old_versions():
    """Sizes of memory and settings of the solver, which newer versions may not know, have no effect."""
    old = TREE.replace("<worldbody>", '<size nstack="3000" nothing="1"/><option collision="all" density="0" iterations="3"><flag contact="disable" old="enable"/></option><worldbody>')
    assert read(old, links="low")[0] == read(TREE, links="low")[0]


@pytest.mark.parametrize("version", ["rope", "cable"])
def test_composites(version):
    """They are read in versions of MuJoCo that have them; others say which version refuses them, and in which line."""
    text = f"""<mujoco><worldbody><body name="top" pos="0 0 1">
      <composite prefix="c" type="{version}" count="6 1 1" curve="0 0 -s" size="1" initial="ball">
        <joint kind="main"/><geom type="capsule" size="0.01" mass="0.1"/></composite></body></worldbody></mujoco>"""
    try:
        mujoco.MjModel.from_xml_string(text)
    except ValueError:
        with pytest.raises(ValueError, match=f"line 2: MuJoCo {mujoco.__version__} refuses it: "):
            rc.from_mjcf(text)
        return
    assert read(text)[0].size == 5


@pytest.mark.parametrize("name", ["a\x01b", "a\ufffeb", 'a"b', "a&<b>", "a\nb", "a/b", "@1", "{a}"])
def test_names_in_xml(name):
    """Names are written so that they come back; a character that XML does not have becomes an underline."""
    chain = rc.Chain(mass=[1.0, 2.0, 3.0], length=1.0, names=[name, "turn", name])
    kept = re.sub("[\x01\ufffe]", "_", name)
    for found in (read(rc.to_mjcf(chain))[0], read(rc.to_urdf(chain))[0]):
        assert found.names == (kept, "turn", f"{kept}_2") and found.mass.tolist() == [1.0, 2.0, 3.0]


# ---- scenes


def rigs():
    """Rigs of each kind that a model can be."""
    rng = np.random.default_rng(5)
    column = lambda: np.exp(rng.normal(size=3))  # noqa: E731
    bodies = rc.Chain(mass=column(), length=column(), centroid=column(), radius_of_gyration=column(), names=['a "b"', "c\\d\x7f", "é\n"])
    points = rc.Chain(weight=column(), length=column())
    yield bodies
    yield points
    yield rc.Rig(bodies, support=rc.Support(mass=1.3, damping=0.2), pins=rc.Pin(damping=[0.0, 0.3, 0.1]))
    yield rc.Rig(bodies, support=rc.Support(stiffness=9.0, radius=0.3), inverted=[False, True, True], pins=rc.Pin(stiffness=[0.0, 50.0, 70.0]))
    yield rc.Rig(points, support=rc.Support(stiffness=0.0, weight=2.0))
    yield rc.Rig(points, support=rc.Support(stiffness=0.0))


@pytest.mark.parametrize("system", list(rigs()), ids=repr)
def test_a_system_as_a_scene(system):
    scene = rc.Scene.from_dict(tomllib.loads(scene_text(system, 9.81, 'A "title" \\ é', ["a comment\nof two lines"])))
    assert scene.system() == system and scene.gravity_value() == 9.81 and scene.title == 'A "title" \\ é'
    assert scene.asks == ("modes",) and len(scene.modes()) == len(rc.modes(system, "all", gravity=9.81))


def test_turning_parts_as_a_scene():
    chain = rc.Chain(mass=[1.0, 2.0], length=1.0, centroid=0.5, radius_of_gyration=0.3)
    rig = rc.Rig(chain, support=rc.Support(radius=0.2), flywheels=rc.Flywheel(axial_moment=[0.02, 0.0]))
    scene = rc.Scene.from_dict(tomllib.loads(scene_text(rig, 9.81, "", [])))
    assert scene.modes().angular_speed == pytest.approx(rc.modes(rig, gravity=9.81).angular_speed, rel=1e-15)


def test_all_parts_of_a_rig_as_a_scene():
    """Drag, wheels that spin and a fluid are written; what a scene cannot hold is refused."""
    bodies = rc.Chain(mass=[1.0, 2.0], length=1.0, centroid=0.5, radius_of_gyration=0.3)
    points = rc.Chain(weight=[1.0, 2.0], length=1.0)
    for rig in (
        rc.Rig(bodies, drag=[0.0, 0.2]),
        rc.Rig(points, flywheels=rc.Flywheel(weight=0.5, radius_of_gyration=0.1, spin=30.0, driven=[True, False])),
        rc.Rig(bodies, displaced=rc.Displaced(mass=0.1, centroid=0.4, radius_of_gyration=0.2), fluid="turning"),
    ):
        assert rc.Scene.from_dict(tomllib.loads(scene_text(rig, 9.81, "", []))).system() == rig
    with pytest.raises(ValueError, match="a scene gives flywheels by mass, radius_of_gyration and spin, not by momentum"):
        scene_text(rc.Rig(bodies, flywheels=rc.Flywheel(momentum=[0.1, 0.0])), 9.81, "", [])
    thread = rc.Chain(mass=[1.0, 0.0], length=1.0)
    with pytest.raises(ValueError, match="a scene cannot give link 1 an axial_moment, as it has no mass, got 0.02"):
        scene_text(rc.Rig(thread, flywheels=rc.Flywheel(axial_moment=[0.0, 0.02])), 9.81, "", [])


# ---- the command


@pytest.fixture
def here(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    for name, text in {"full.xml": FULL, "robot.urdf": ROBOT, "tree.xml": TREE}.items():
        Path(name).write_text(text)


def test_the_command(run, here):
    """The scene is the system that the function reads, with the gravity of the file; it is written whole or not at all."""
    code, out, err = run("import", "full.xml")
    assert (code, out) == (3, "") and not Path("full.toml").exists()
    assert err.splitlines()[0] == "revchain: full.xml: the model is no hanging chain, for 9 reasons:"
    assert 'revchain:   line 5: joint \'a\' has frictionloss 0.1; set it to 0, or --ignore "friction"' in err.splitlines()
    assert err.splitlines()[-1].startswith('revchain:   --ignore "actuator armature equality')
    code, out, err = run("import", "full.xml", "--ignore", "all")
    assert (code, err) == (0, "") and out.splitlines()[-1] == "wrote full.toml; now: revchain run full.toml"
    assert out.splitlines()[0].endswith("gravity 9.81 m/s^2") and all(f"  {reason}\n" in out for _, reason in REASONS)
    scene = rc.load_scene("full.toml")
    assert scene.system() == read(FULL, ignore="all")[0] and scene.gravity_value() == 9.81 and scene.title == "full"
    written = Path("full.toml").read_text()
    assert all(f"#   {reason}\n" in written for _, reason in REASONS)
    assert run("modes", "full.toml")[0] == 0 and "valid" in run("validate", "full.toml")[1]
    code, _, err = run("import", "full.xml", "--ignore", "all")
    assert (code, err) == (4, "revchain: full.toml: exists already; --force overwrites it\n")
    assert run("import", "full.xml", "--ignore", "all", "--force")[0] == 0 and Path("full.toml").read_text() == written
    assert run("import", "full.xml", "--ignore", "all", "-o", "-") == (0, written, "")


def test_what_was_left_out_is_in_the_report(run, here):
    assert run("import", "full.xml", "--ignore", "all")[0] == 0
    described = rc.load_scene("full.toml").description
    assert described.startswith("Read from full.xml. Left out: ") and all(reason in described for _, reason in REASONS)
    plain = rc.to_mjcf(rc.Chain(mass=1.0, length=1.0))
    Path("plain.xml").write_text(plain)
    assert "description" not in run("import", "plain.xml", "-o", "-")[1]


def test_the_command_names_the_right_command(run, here):
    code, _, err = run("modes", "full.xml")
    assert code == 3 and "line 1, column 1: is XML, not a scene: revchain import FILE.xml writes a model" in err
    for name, text in {"a.json": '{"a": 1}', "b.toml": "\n# a scene\n[[links]]\n"}.items():
        Path(name).write_text(text)
        code, _, err = run("import", name)
        assert (code, err) == (3, f"revchain: {name}: is no XML model: MJCF begins with <mujoco>, URDF with <robot>\n")
    code, _, err = run("import", "none.xml")
    assert (code, err) == (3, "revchain: none.xml: cannot be read: No such file or directory\n")


def test_a_missing_model(tmp_path):
    with pytest.raises(OSError, match="none.xml") as raised:
        rc.from_mjcf(tmp_path / "none.xml")
    assert isinstance(raised.value, ValueError)


@pytest.mark.parametrize(("word", "same"), [("frictionloss", "friction"), ("limited", "range"), ("density", "fluid")])
def test_words_of_the_file_are_accepted(word, same):
    said = []
    for each in (word, same):
        with pytest.raises(ValueError) as raised:
            rc.from_mjcf(FULL, ignore=each)
        said.append(str(raised.value))
    assert said[0] == said[1] and "for 8 reasons" in said[0]


def test_the_command_reads_urdf_and_trees(run, here):
    code, out, _ = run("import", "robot.urdf", "--ignore", "friction", "--out", "a.toml")
    assert code == 0 and "gravity 9.81 m/s^2, that of MuJoCo, as URDF has none" in out and rc.load_scene("a.toml").title == "two"
    code, _, err = run("import", "tree.xml")
    assert code == 3 and 'such as --links "root right low"' in err
    assert run("import", "robot.urdf", "--ignore", "friction", "--ignore", "damping range", "-o", "b.toml")[0] == 0
    assert type(rc.load_scene("b.toml").system()) is rc.Chain
    assert run("import", "tree.xml", "--links", "root", "--links", "left arm", "-o", "c.toml")[0] == 0
    assert rc.load_scene("c.toml").system().names == ("left arm", "root")
    code, out, _ = run("import", "tree.xml", "--links", "right")
    assert code == 0 and "body 'left arm', 1 kg" in out and rc.load_scene("tree.toml").system().names == ("right", "root")


@pytest.mark.parametrize(
    ("arguments", "code", "message"),
    [
        (["missing.xml"], 3, "missing.xml: cannot be read: No such file or directory"),
        (["."], 3, ".: cannot be read: Is a directory"),
        (["full.xml", "--ignore", "all that"], 2, f"--ignore must have words of {ALL_WORDS}, or be \"all\", got 'that'"),
        (["full.xml", "--ignore", "all", "--links", "x"], 2, "--links must be names of bodies, 'upper'; got 'x'"),
        (["full.xml", "--ignore", "all", "--out", "no/a.toml"], 4, "no/a.toml: cannot be written: No such file or directory"),
        (["full.xml", "--ignore", "all", "--out", "./full.xml", "--force"], 2, "full.xml: the model itself would be overwritten"),
        (["full.xml", "--ignore", "all", "-o", "a.json"], 2, "--out: the scene is TOML: its name must not end in .json, got a.json"),
        (["notes.txt"], 3, "notes.txt: syntax error: line 1, column 0"),
        (["page.html"], 3, "page.html: source must begin with <mujoco> or <robot>, got <html>, neither MJCF nor URDF"),
        ([], 2, "missing argument 'FILE'; see revchain import --help"),
    ],
)  # fmt: skip
def test_the_command_fails(run, here, arguments, code, message):
    Path("notes.txt").write_text("words")
    Path("page.html").write_text("<html/>")
    before = sorted(Path().rglob("*"))
    assert run("import", *arguments) == (code, "", f"revchain: {message}\n")
    assert sorted(Path().rglob("*")) == before


def test_any_model_for_the_reader():
    assert read_model("f", FULL, "", "all", None).title == "full"
    with pytest.raises(ValueError, match="^f: source must begin with <mujoco> or <robot>, got <a>"):
        read_model("f", "<a/>", "", "", None)


def test_the_words_are_in_the_documentation():
    for word, what in WORDS.items():
        assert re.search(rf"^    {word} +{re.escape(what)}$", rc.from_mjcf.__doc__, re.MULTILINE)


def test_the_page_shows_the_command(run, tmp_path, monkeypatch, repository):
    """The blocks of docs/howto/exchange.md, line by line."""
    monkeypatch.chdir(tmp_path)
    Path("examples").symlink_to(repository / "examples")
    page = (repository / "docs/howto/exchange.md").read_text("utf-8")
    [block] = re.findall(r"```\n(\$ revchain import.*?)```", page, re.DOTALL)
    for part in block.split("$ revchain ")[1:]:
        line, _, shown = part.partition("\n")
        code, out, err = run(*shlex.split(line))
        assert (out or err) == shown and code == (0 if out else 3)


def test_mujoco_writes_no_file_and_prints_nothing(tmp_path, monkeypatch, capfd):
    """MuJoCo warns about <mimic> on a joint that floats: the warning is in the message, not in MUJOCO_LOG.TXT."""
    monkeypatch.chdir(tmp_path)
    text = f"<robot>{BOB}</robot>".replace("</joint>", '<mimic joint="pin"/></joint>').replace("continuous", "floating")
    with pytest.raises(ValueError, match="pin"):
        rc.from_urdf(text)
    assert not list(tmp_path.iterdir())
    said = capfd.readouterr()
    assert not said.out and not said.err
