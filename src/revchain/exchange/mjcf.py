# SPDX-License-Identifier: GPL-3.0-or-later
"""Models of MuJoCo (MJCF)."""

from __future__ import annotations

import math
import os
from typing import Any
from xml.etree import ElementTree as Xml

import numpy as np

from ..results.files import naming, written_aside
from ..results.shapes import SteadyShape, SteadyShapes
from ..systems.chain import Chain
from ..systems.numbers import file_path, one_positive
from ..systems.rig import Rig
from .mechanism import Mechanism, State, mechanism

LEAST = 1e-15
"""The least mass and moment of inertia that MuJoCo takes for a moving body (mjMINVAL)."""
RATIO = "gyration_ratio"
"""Name of the numbers that hold more digits of the radii of gyration than MuJoCo's moments of inertia have."""
_STEPS = 1000  # of time in a turn
_STEPS_OF_LINK = 50  # in an oscillation of the lightest link under the greatest tension


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
        A system is at rest in the keyframe of the model. A shape is a keyframe from which MuJoCo continues the steady
        motion; a list of shapes gives one keyframe per shape.
    path : path-like, optional
        Where to write the text.
    gravity : float, optional
        Acceleration of gravity, m/s^2; standard gravity if left out. Only for a system: a shape has its own.
    timestep : float, optional
        Time step of the integrator, s. If left out: a thousandth of a turn, less for links that oscillate faster.

    Returns
    -------
    str
        The model as XML, with all digits. Masses are in kg: weights divided by gravity.

    Raises
    ------
    ValueError
        If the system is a cord or held at both ends, stands in a fluid, has a flywheel in a link without moment of
        inertia, links that meet at a pin without mass, or more than 490 links; if `gravity` is given with a shape; or if
        the file cannot be written.
    TypeError
        If `system` is of another class.

    Notes
    -----
    A ``turntable`` turns about the vertical and carries the upper pin. Each link has two hinges there: ``inclination``, in
    the turning plane, and ``sideways``, out of it. In steady motion only the turntable and the wheels turn. A turntable
    on the axis exerts no torque on the chain. One with an arm has a moment of inertia large enough to keep its speed to
    12 digits. A link with a flywheel has a wheel with half of its mass, which carries the same angular momentum.

    MuJoCo accepts no moment of inertia below 1e-15 kg m^2. This amount is added to each link about all axes, as for a
    small ball. Steady motion is unchanged; disturbed motion changes by the ratio of this amount to the moment of
    inertia about the pin.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shape(rc.Chain(mass=[1.0, 3.0], length=1.0), mode=1, angular_speed=3.0)
    >>> text = rc.to_mjcf(shape)
    >>> print(text.split("<keyframe>")[0].count("<joint"), shape.joint_angle.round(4))
    5 [0.2773 0.6179]
    """
    place = "revchain.to_mjcf"
    made, states = mechanism(place, system, gravity)
    step = (
        one_positive(place, "timestep", timestep)
        if timestep is not None
        else min(_step(made, state) for state in states)
    )
    model = _model(made, step)
    frames = Xml.SubElement(model, "keyframe")
    for state in states:
        at, rate = _keyframe(made, state)
        Xml.SubElement(frames, "key", name=state.name, qpos=numbers(*at), qvel=numbers(*rate))
    return written(place, model, path)


def written(place: str, model: Xml.Element, path: str | os.PathLike[str] | None) -> str:
    """The text of a model, in a file too where there is a path."""
    Xml.indent(model)
    text = Xml.tostring(model, encoding="unicode") + "\n"
    if path is not None:
        name = file_path(place, "path", path)
        with naming(name), written_aside(name) as (aside,):
            aside.write_text(text, encoding="utf-8")
    return text


def numbers(*values: Any) -> str:
    """With all digits, no negative zeros."""
    return " ".join(repr(float(value) + 0.0).removesuffix(".0") for value in values)


def _step(made: Mechanism, state: State) -> float:
    light = made.mass[made.mass > 0].min() * made.length.min()
    step = math.pi / _STEPS_OF_LINK * math.sqrt(light / state.tension.max())
    turn = math.tau / abs(state.speed) if state.speed else math.inf
    return min(step, turn / _STEPS)


def _model(made: Mechanism, step: float) -> Xml.Element:
    root, size = Xml.Element("mujoco", model="revchain"), made.reach
    Xml.SubElement(root, "compiler", angle="radian", inertiafromgeom="false")
    option = {"timestep": numbers(step), "gravity": numbers(0, 0, -made.gravity), "integrator": "RK4"}
    Xml.SubElement(Xml.SubElement(root, "option", option), "flag", contact="disable")
    Xml.SubElement(Xml.SubElement(root, "custom"), "numeric", name=RATIO, data=numbers(*made.ratio.flat))
    world = _scenery(root, size)
    at = _body(world, "turntable", (0, 0, 0), LEAST, (0, 0, 0), (made.turning,) * 3)
    _joint(at, "turn", "hinge", (0, 0, 1))
    pin = (made.radius, 0, 0)
    if made.radius:
        _rod(at, pin, size)
    if made.yields:
        at, pin = _body(at, "carriage", pin, max(made.carriage, LEAST), (0, 0, 0), (LEAST,) * 3), (0, 0, 0)
        for name, axis in (("carriage_x", (1, 0, 0)), ("carriage_y", (0, 1, 0))):
            _joint(at, name, "slide", axis).set("stiffness", numbers(made.stiffness))
    for k in reversed(range(made.size)):
        at, pin = _link(at, made, k, pin, size), (0, 0, -made.length[k])
    Xml.SubElement(at, "site", name="free_end", pos=numbers(*pin), size=numbers(size / 150))
    return root


def _scenery(root: Xml.Element, size: float) -> Xml.Element:
    """Camera, light and background for a figure that turns about the axis; the world."""
    Xml.SubElement(root, "statistic", center=numbers(0, 0, -size / 3), extent=numbers(1.4 * size))
    Xml.SubElement(Xml.SubElement(root, "visual"), "global", azimuth="90", elevation="-12")
    sky = {"type": "skybox", "builtin": "flat", "rgb1": "1 1 1", "width": "8", "height": "8"}
    Xml.SubElement(Xml.SubElement(root, "asset"), "texture", sky)
    Xml.SubElement(Xml.SubElement(root, "default"), "geom", contype="0", conaffinity="0", rgba="0.12 0.47 0.71 1")
    world = Xml.SubElement(root, "worldbody")
    Xml.SubElement(world, "light", directional="true", pos=numbers(0, 0, size), dir="0.3 0.5 -1")
    return world


def _link(parent: Xml.Element, made: Mechanism, k: int, pin: Any, size: float) -> Xml.Element:
    name, wheel = made.names[k], bool(made.wheeled[k])
    mass, half, at = made.mass[k] / (1 + wheel), made.moment[k] / 2, (0, 0, -made.centroid[k])
    across = half + LEAST if wheel else made.across(k, LEAST)
    link = _body(parent, name, pin, max(mass, LEAST), at, (across, across, LEAST))
    _joint(link, f"{name}_inclination", "hinge", (0, -1, 0))
    _joint(link, f"{name}_sideways", "hinge", (1, 0, 0))
    _rod(link, (0, 0, -made.length[k]), size)
    ball = size / 40 * np.cbrt(made.mass[k] / made.mass.max())
    if made.mass[k] > 0:
        Xml.SubElement(link, "geom", type="sphere", pos=numbers(*at), size=numbers(ball), mass="0")
    if wheel:
        disc = _body(link, made.part(k, "wheel"), at, mass, (0, 0, 0), (half, half, made.moment[k]))
        _joint(disc, f"{name}_spin", "hinge", (0, 0, 1))
        Xml.SubElement(disc, "geom", type="cylinder", size=numbers(2 * ball, ball / 3), mass="0")
    return link


def _body(parent: Xml.Element, name: str, pin: Any, mass: float, at: Any, moments: Any) -> Xml.Element:
    body = Xml.SubElement(parent, "body", name=name, pos=numbers(*pin))
    Xml.SubElement(body, "inertial", pos=numbers(*at), mass=numbers(mass), diaginertia=numbers(*moments))
    return body


def _joint(body: Xml.Element, name: str, kind: str, axis: tuple[int, int, int]) -> Xml.Element:
    return Xml.SubElement(body, "joint", name=name, type=kind, axis=numbers(*axis))


def _rod(body: Xml.Element, end: Any, size: float) -> None:
    Xml.SubElement(body, "geom", type="capsule", fromto=numbers(0, 0, 0, *end), size=numbers(size / 150), mass="0")


def _keyframe(made: Mechanism, state: State) -> tuple[list[float], list[float]]:
    """Positions and velocities of all joints."""
    place, rate = [0.0], [state.speed]
    if made.yields:
        place, rate = [*place, state.give, 0.0], [*rate, 0.0, 0.0]
    for k in reversed(range(made.size)):
        place, rate = [*place, float(state.joint_angle[k]), 0.0], [*rate, 0.0, 0.0]
        if made.wheeled[k]:
            place, rate = [*place, 0.0], [*rate, float(state.wheel_rate[k])]
    return place, rate
