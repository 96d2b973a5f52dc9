# SPDX-License-Identifier: GPL-3.0-or-later
"""Robot descriptions (URDF)."""

from __future__ import annotations

import os
from typing import Any
from xml.etree import ElementTree as Xml

import numpy as np

from ..results.shapes import SteadyShape, SteadyShapes
from ..systems.chain import Chain
from ..systems.numbers import shown
from ..systems.rig import Rig
from .mechanism import Mechanism, mechanism
from .mjcf import numbers, written

LEAST = 2e-14
"""The least mass and moment of inertia: twice what MuJoCo takes in a URDF file."""


def to_urdf(
    system: Chain | Rig | SteadyShape, path: str | os.PathLike[str] | None = None, *, gravity: float | None = None
) -> str:
    """Write a chain, a rig or a steady shape as a robot description (URDF).

    Parameters
    ----------
    system : Chain, Rig or SteadyShape
        With all joints at 0 a system hangs straight; a shape has its inclinations.
    path : path-like, optional
        Where to write the text.
    gravity : float, optional
        Acceleration of gravity, m/s^2, for a system given by weight; standard gravity if left out. A shape has its own.

    Returns
    -------
    str
        The model as XML, with all digits. URDF has no velocities: a shape is in steady motion if the joint ``turn`` has the
        velocity ``shape.direction * shape.angular_speed``, all others being 0.

    Raises
    ------
    ValueError
        As for `to_mjcf`; also for a support on a spring or flywheels, which URDF cannot describe.
    TypeError
        If `system` is of another class.

    Notes
    -----
    The joints are those of `to_mjcf`. A URDF joint has one axis, so a link of negligible mass, 2e-14 kg, is placed
    between the two axes of each pin.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shape(rc.Chain(mass=[1.0, 3.0], length=1.0), mode=1, angular_speed=3.0)
    >>> rc.to_urdf(shape).count("continuous")
    5
    """
    place = "revchain.to_urdf"
    if isinstance(system, SteadyShapes):
        raise TypeError(
            f"{place}: a URDF file has one configuration; give one shape, such as shapes[0], got {shown(system)}"
        )
    made, [state] = mechanism(place, system, gravity)
    if made.yields:
        raise ValueError(f"{place}: URDF has no springs; use to_mjcf, got a support of stiffness {made.stiffness:g}")
    if made.wheeled.any():
        raise ValueError(f"{place}: URDF has no velocities, which wheels need; use to_mjcf, got flywheels")
    return written(place, _robot(made, state.joint_angle), path)


def _robot(made: Mechanism, angle: Any) -> Xml.Element:
    root, thick = Xml.Element("robot", name="revchain"), made.reach / 300
    Xml.SubElement(root, "link", name="world")
    _joint(root, "turn", ("world", "turntable"), (0, 0, 0), 0.0, "0 0 1")
    _link(root, "turntable", LEAST, 0.0, (made.turning,) * 3)
    parent, pin = "turntable", (made.radius, 0, 0)
    for k in reversed(range(made.size)):
        name, between, across = made.names[k], made.part(k, "pin"), made.across(k, LEAST)
        _joint(root, f"{name}_inclination", (parent, between), pin, -angle[k], "0 -1 0")
        _link(root, between, LEAST, 0.0, (LEAST,) * 3)
        _joint(root, f"{name}_sideways", (between, name), (0, 0, 0), 0.0, "1 0 0")
        link = _link(root, name, max(made.mass[k], LEAST), made.centroid[k], (across, across, LEAST))
        _seen(link, -made.length[k] / 2, "cylinder", radius=numbers(thick), length=numbers(made.length[k]))
        ball = made.reach / 40 * np.cbrt(made.mass[k] / made.mass.max())
        if made.mass[k] > 0:
            _seen(link, -made.centroid[k], "sphere", radius=numbers(ball))
        parent, pin = name, (0, 0, -made.length[k])
    Xml.SubElement(root, "link", name="free_end")
    _joint(root, "end", (parent, "free_end"), pin, 0.0, None)
    return root


def _joint(root: Xml.Element, name: str, between: tuple[str, str], pin: Any, pitch: float, axis: str | None) -> None:
    joint = Xml.SubElement(root, "joint", name=name, type="fixed" if axis is None else "continuous")
    Xml.SubElement(joint, "parent", link=between[0])
    Xml.SubElement(joint, "child", link=between[1])
    Xml.SubElement(joint, "origin", xyz=numbers(*pin), rpy=numbers(0, pitch, 0))
    if axis is not None:
        Xml.SubElement(joint, "axis", xyz=axis)


def _link(root: Xml.Element, name: str, mass: float, centroid: float, moments: tuple[float, ...]) -> Xml.Element:
    link = Xml.SubElement(root, "link", name=name)
    inertial = Xml.SubElement(link, "inertial")
    Xml.SubElement(inertial, "origin", xyz=numbers(0, 0, -centroid), rpy="0 0 0")
    Xml.SubElement(inertial, "mass", value=numbers(mass))
    about = {name: numbers(value) for name, value in zip(("ixx", "iyy", "izz"), moments, strict=True)}
    Xml.SubElement(inertial, "inertia", about | dict.fromkeys(("ixy", "ixz", "iyz"), "0"))
    return link


def _seen(link: Xml.Element, height: float, form: str, **size: str) -> None:
    visual = Xml.SubElement(link, "visual")
    Xml.SubElement(visual, "origin", xyz=numbers(0, 0, height), rpy="0 0 0")
    Xml.SubElement(Xml.SubElement(visual, "geometry"), form, size)
