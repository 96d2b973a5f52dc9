# SPDX-License-Identifier: GPL-3.0-or-later
"""Models of MuJoCo (MJCF) and robot descriptions (URDF), written as XML."""

from __future__ import annotations

import math
import os
from typing import Any
from xml.etree import ElementTree as Xml

import numpy as np

from ..results.files import naming, written_aside
from ..results.shapes import SteadyShape, SteadyShapes
from ..systems.chain import Chain
from ..systems.numbers import file_path, one_positive, shown
from ..systems.rig import Rig
from .mechanism import Mechanism, State, mechanism

LEAST = 1e-15
"""The least mass and moment of inertia that MuJoCo takes for a moving body (mjMINVAL)."""
LEAST_OF_URDF = 2e-14
"""The least mass and moment of inertia in a URDF file: more than MuJoCo takes there."""
RATIO = "gyration_ratio"
"""Name of the numbers that hold more digits of the radii of gyration than MuJoCo's moments of inertia have."""
_STEPS = 1000  # of time in a turn
_STEPS_OF_LINK = 50  # in half an oscillation of the lightest link under the greatest tension and the stiffest springs


def to_mjcf(
    system: Chain | Rig | SteadyShape | SteadyShapes,
    path: str | os.PathLike[str] | None = None,
    *,
    gravity: float | None = None,
    timestep: float | None = None,
) -> str:
    """Write a chain, a rig or steady shapes as a model of MuJoCo.

    Parameters
    ----------
    system : Chain, Rig, SteadyShape or SteadyShapes
        A system is at rest in the keyframe of the model. A shape is a keyframe in steady motion; a list of shapes gives one
        keyframe per shape.
    path : path-like, optional
        Where to write the text.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out. Only for a system: a shape has its own.
    timestep : float, optional
        Time step of the integrator, s. If left out: a hundredth of the oscillation of the least mass on the shortest link
        under the greatest tension, less with springs and dashpots, and for a shape at most a thousandth of a turn.

    Returns
    -------
    str
        The model as XML, with all digits, in kg, m, N and rad. Weights are divided by gravity.

    Raises
    ------
    ValueError
        If the system is a cord or held at both ends, stands in a fluid, or has linear drag or more than 490 links; if a
        number is out of its range; or if the file cannot be written (the error is also an OSError).
    TypeError
        If `system` is of another class.

    Notes
    -----
    A ``turntable`` turns about the vertical and carries the upper pin. Each link has two hinges at its upper pin:
    ``inclination``, in the turning plane, and ``sideways``, out of it. In steady motion only the turntable and the wheels
    turn. A turntable with an arm, or of a system with dashpots, has a moment of inertia large enough to keep its speed to
    12 digits, or to stand still. A link with a flywheel has a wheel with half of its mass and the same angular momentum.

    A support on a spring, or a trolley, is a ``carriage`` on two slides, ``carriage_x`` and ``carriage_y``, with the
    support's stiffness and damping. Springs and dashpots at a pin are the stiffness and damping of both its hinges. The
    springs are relaxed where the chain hangs straight, or with its inverted links upright. Small motions about this
    position are those of `modes`.

    A moment of inertia of 1e-15 kg m^2, the least that MuJoCo accepts, is added to each link about all axes. Steady motion
    is unchanged.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shape(rc.Chain(mass=[1.0, 3.0], length=1.0), mode=1, angular_speed=3.0)
    >>> text = rc.to_mjcf(shape)
    >>> print(text.split("<keyframe>")[0].count("<joint"), shape.joint_angle.round(4))
    5 [0.2773 0.6179]
    """
    function = "revchain.to_mjcf"
    made, states = mechanism(function, system, gravity)
    if timestep is None:
        step = min(_step(made, state) for state in states)
    else:
        step = one_positive(function, "timestep", timestep)
    model = _mujoco(made, step)
    frames = _add(model, "keyframe")
    for state in states:
        at, rate = _keyframe(made, state)
        _add(frames, "key", name=state.name, qpos=at, qvel=rate)
    return _written(function, model, path)


def to_urdf(
    system: Chain | Rig | SteadyShape, path: str | os.PathLike[str] | None = None, *, gravity: float | None = None
) -> str:
    """Write a chain, a rig or a steady shape as a robot description (URDF).

    Parameters
    ----------
    system : Chain, Rig or SteadyShape
        With all joints at 0 a system hangs straight, its inverted links upright; a shape has its inclinations.
    path : path-like, optional
        Where to write the text.
    gravity : float, optional
        Acceleration of gravity, m/s^2, for a system given by weight; standard gravity if left out. A shape has its own.

    Returns
    -------
    str
        The model as XML, with all digits. A shape is in steady motion if the joint ``turn`` has the velocity
        ``shape.direction * shape.angular_speed``, all others being 0.

    Raises
    ------
    ValueError
        As for `to_mjcf`; also for flywheels, springs and trolleys.
    TypeError
        If `system` is of another class, such as a list of shapes.

    Notes
    -----
    The joints are those of `to_mjcf`, with its dashpots at pins. A URDF joint has one axis, so a link of negligible mass,
    2e-14 kg, is placed between the two axes of each pin.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shape(rc.Chain(mass=[1.0, 3.0], length=1.0), mode=1, angular_speed=3.0)
    >>> rc.to_urdf(shape).count("continuous")
    5
    """
    function = "revchain.to_urdf"
    if isinstance(system, SteadyShapes):
        raise TypeError(
            f"{function}: a URDF file has one configuration; give one shape, such as shapes[0], got {shown(system)}"
        )
    made, [state] = mechanism(function, system, gravity, several=False)
    if made.yields or made.pin_stiffness.any():
        got = f"a support of stiffness {made.stiffness:g}" if made.yields else "springs at pins"
        raise ValueError(f"{function}: URDF has no springs, and trolleys are not written; use to_mjcf, got {got}")
    if made.wheeled.any():
        raise ValueError(f"{function}: URDF has no velocities, which wheels need; use to_mjcf, got flywheels")
    return _written(function, _robot(made, state.joint_angle), path)


def _written(function: str, model: Xml.Element, path: str | os.PathLike[str] | None) -> str:
    """Return the text of a model; write it to a file if there is a path."""
    Xml.indent(model)
    text = Xml.tostring(model, encoding="unicode") + "\n"
    if path is not None:
        name = file_path(function, "path", path)
        with naming(name), written_aside(name) as (aside,):
            aside.write_text(text, encoding="utf-8")
    return text


def _add(parent: Xml.Element, tag: str, **given: Any) -> Xml.Element:
    """A new element. Numbers, alone or in a tuple, are written with all digits and without negative zeros."""
    texts = {name: value if isinstance(value, str) else _text(value) for name, value in given.items()}
    return Xml.SubElement(parent, tag, texts)


def _text(numbers: Any) -> str:
    return " ".join([repr(float(number) + 0.0).removesuffix(".0") for number in np.ravel(numbers)])


def _ball(made: Mechanism, k: int) -> float:
    """The radius of the ball that is drawn for the mass of link k; 0 for a thread."""
    return float(made.reach / 40 * np.cbrt(made.mass[k] / made.mass.max()))


def _step(made: Mechanism, state: State) -> float:
    """A time step that resolves a turn and the fastest oscillation and decay of a link."""
    short = float(made.length.min())
    light = float(made.mass[made.mass > 0].min()) * short
    held, rubbed = (4 * float(values.max()) / short for values in (made.pin_stiffness, made.pin_damping))
    pull = float(state.tension.max()) + held + (made.stiffness * short if made.yields else 0.0)
    rub = rubbed + made.damping * short
    step = math.pi / _STEPS_OF_LINK / (math.sqrt(pull / light) + rub / light)
    turn = math.tau / abs(state.speed) if state.speed else math.inf
    return min(step, turn / _STEPS)


def _mujoco(made: Mechanism, step: float) -> Xml.Element:
    """The model of MuJoCo without its keyframes."""
    root, size = Xml.Element("mujoco", model="revchain"), made.reach
    _add(root, "compiler", angle="radian", inertiafromgeom="false")
    option = _add(root, "option", timestep=step, gravity=(0, 0, -made.gravity), integrator="RK4")
    _add(option, "flag", contact="disable")
    _add(_add(root, "custom"), "numeric", name=RATIO, data=made.ratio)
    _add(root, "statistic", center=(0, 0, -size / 3), extent=1.4 * size)  # a figure that turns about the axis
    _add(_add(root, "visual"), "global", azimuth=90, elevation=-12)
    _add(_add(root, "asset"), "texture", type="skybox", builtin="flat", rgb1=(1, 1, 1), width=8, height=8)
    _add(_add(root, "default"), "geom", contype=0, conaffinity=0, rgba=(0.12, 0.47, 0.71, 1))
    world = _add(root, "worldbody")
    _add(world, "light", directional="true", pos=(0, 0, size), dir=(0.3, 0.5, -1))
    at = _body(world, "turntable", (0, 0, 0), LEAST, (0, 0, 0), (max(made.turning, LEAST),) * 3)
    _joint(at, "turn", (0, 0, 1))
    pin: Any = (made.radius, 0, 0)
    if made.radius:
        _rod(at, pin, size)
    if made.yields:
        at, pin = _body(at, "carriage", pin, max(made.carriage, LEAST), (0, 0, 0), (LEAST,) * 3), (0, 0, 0)
        for name, axis in (("carriage_x", (1, 0, 0)), ("carriage_y", (0, 1, 0))):
            _joint(at, name, axis, "slide", stiffness=made.stiffness, damping=made.damping)
    for k in reversed(range(made.size)):
        at, pin = _link(at, made, k, pin), (0, 0, -made.length[k])
    _add(at, "site", name="free_end", pos=pin, size=size / 150)
    return root


def _link(parent: Xml.Element, made: Mechanism, k: int, pin: Any) -> Xml.Element:
    """A link, its two hinges and its wheel, as a body of MuJoCo."""
    name, wheel = made.names[k], bool(made.wheeled[k])
    mass, half, at = made.mass[k] / (1 + wheel), made.moment[k] / 2, (0, 0, -made.centroid[k])
    across = half + LEAST if wheel else made.across(k, LEAST)
    link = _body(parent, name, pin, max(mass, LEAST), at, (across, across, LEAST))
    at_pin = {"stiffness": made.pin_stiffness[k], "damping": made.pin_damping[k]}
    _joint(link, f"{name}_inclination", (0, -1, 0), **at_pin, springref=made.rest[k] if made.pin_stiffness[k] else 0.0)
    _joint(link, f"{name}_sideways", (1, 0, 0), **at_pin)
    _rod(link, (0, 0, -made.length[k]), made.reach)
    ball = _ball(made, k)
    if ball:
        _add(link, "geom", type="sphere", pos=at, size=ball, mass=0)
    if wheel:
        disc = _body(link, made.part(k, "wheel"), at, mass, (0, 0, 0), (half, half, made.moment[k]))
        _joint(disc, f"{name}_spin", (0, 0, 1))
        _add(disc, "geom", type="cylinder", size=(2 * ball, ball / 3), mass=0)
    return link


def _body(parent: Xml.Element, name: str, pin: Any, mass: float, at: Any, moments: Any) -> Xml.Element:
    body = _add(parent, "body", name=name, pos=pin)
    _add(body, "inertial", pos=at, mass=mass, diaginertia=moments)
    return body


def _joint(body: Xml.Element, name: str, axis: tuple[int, int, int], kind: str = "hinge", **forces: float) -> None:
    """A joint with those of its forces that are not 0."""
    _add(body, "joint", name=name, type=kind, axis=axis, **{what: value for what, value in forces.items() if value})


def _rod(body: Xml.Element, end: Any, size: float) -> None:
    _add(body, "geom", type="capsule", fromto=(0, 0, 0, *end), size=size / 150, mass=0)


def _keyframe(made: Mechanism, state: State) -> tuple[list[float], list[float]]:
    """The positions and the velocities of all joints in a state."""
    at, rate = [0.0], [state.speed]
    if made.yields:
        at, rate = [*at, state.give, 0.0], [*rate, 0.0, 0.0]
    for k in reversed(range(made.size)):
        at, rate = [*at, float(state.joint_angle[k]), 0.0], [*rate, 0.0, 0.0]
        if made.wheeled[k]:
            at, rate = [*at, 0.0], [*rate, float(state.wheel_rate[k])]
    return at, rate


def _robot(made: Mechanism, angle: Any) -> Xml.Element:
    """The robot description, in which all joints are at 0 for these angles."""
    root = Xml.Element("robot", name="revchain")
    _add(root, "link", name="world")
    _turning(root, "turn", ("world", "turntable"), (0, 0, 0), 0.0, (0, 0, 1))
    _part(root, "turntable", LEAST_OF_URDF, 0.0, (max(made.turning, LEAST_OF_URDF),) * 3)
    parent, pin = "turntable", (made.radius, 0.0, 0.0)
    for k in reversed(range(made.size)):
        name, between, across = made.names[k], made.part(k, "pin"), made.across(k, LEAST_OF_URDF)
        damping = made.pin_damping[k]
        _turning(root, f"{name}_inclination", (parent, between), pin, -angle[k], (0, -1, 0), damping)
        _part(root, between, LEAST_OF_URDF, 0.0, (LEAST_OF_URDF,) * 3)
        _turning(root, f"{name}_sideways", (between, name), (0, 0, 0), 0.0, (1, 0, 0), damping)
        moments = (across, across, LEAST_OF_URDF)
        link = _part(root, name, max(made.mass[k], LEAST_OF_URDF), made.centroid[k], moments)
        _seen(link, -made.length[k] / 2, "cylinder", radius=made.reach / 300, length=made.length[k])
        if ball := _ball(made, k):
            _seen(link, -made.centroid[k], "sphere", radius=ball)
        parent, pin = name, (0.0, 0.0, -made.length[k])
    _add(root, "link", name="free_end")
    _turning(root, "end", (parent, "free_end"), pin, 0.0, None)
    return root


def _turning(
    root: Xml.Element, name: str, between: tuple[str, str], pin: Any, pitch: float, axis: Any, damping: float = 0.0
) -> None:
    """A joint of a robot between two links; fixed without an axis."""
    joint = _add(root, "joint", name=name, type="fixed" if axis is None else "continuous")
    _add(joint, "parent", link=between[0])
    _add(joint, "child", link=between[1])
    _add(joint, "origin", xyz=pin, rpy=(0, pitch, 0))
    if axis is not None:
        _add(joint, "axis", xyz=axis)
    if damping:
        _add(joint, "dynamics", damping=damping)


def _part(root: Xml.Element, name: str, mass: float, centroid: float, moments: tuple[float, ...]) -> Xml.Element:
    """A link of a robot, with its inertia."""
    link = _add(root, "link", name=name)
    inertial = _add(link, "inertial")
    _add(inertial, "origin", xyz=(0, 0, -centroid), rpy=(0, 0, 0))
    _add(inertial, "mass", value=mass)
    _add(inertial, "inertia", **dict(zip(("ixx", "iyy", "izz"), moments, strict=True)), ixy=0, ixz=0, iyz=0)
    return link


def _seen(link: Xml.Element, height: float, form: str, **size: float) -> None:
    visual = _add(link, "visual")
    _add(visual, "origin", xyz=(0, 0, height), rpy=(0, 0, 0))
    _add(_add(visual, "geometry"), form, **size)
