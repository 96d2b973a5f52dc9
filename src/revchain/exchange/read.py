# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and rigs from models of MuJoCo (MJCF) and robot descriptions (URDF), whose files MuJoCo reads."""

from __future__ import annotations

import math
import os
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple, NoReturn
from xml.etree import ElementTree as Xml

import numpy as np

from ..results.files import naming
from ..systems.chain import Chain
from ..systems.extras import require
from ..systems.numbers import Floats, file_path
from ..systems.rig import Flywheel, Pin, Rig, Support
from .mechanism import radius_of_gyration
from .write import LEAST, LEAST_OF_URDF, RATIO

_NEAR = 1e-9  # parts of a length, an axis or a moment by which a model may differ from a straight link
_FORCES = ("jnt_stiffnesspoly", "dof_dampingpoly", "dof_frictionloss", "dof_armature")  # that are not read
_NUMBERS = {
    "body": ("pos", "quat", "mass", "inertia", "ipos", "iquat"),
    "jnt": ("pos", "axis", "stiffness"),
    "dof": ("damping",),
    "geom": ("pos", "quat", "size"),
    "site": ("pos",),
}
_MOST = 1e75  # of a number, so that the product of four is finite
_MORE = {
    "neq": "equality constraints",
    "ntendon": "tendons",
    "nflex": "flexes",
    "nplugin": "plugins",
}
_OTHER = {"mujoco": "a model of MuJoCo: use from_mjcf", "robot": "a URDF file: use from_urdf"}


def from_mjcf(source: str | os.PathLike[str]) -> Chain | Rig:
    """Read a serial chain of links from a model of MuJoCo.

    Parameters
    ----------
    source : path-like or str
        Path of the file, or its text, which begins with ``<``.

    Returns
    -------
    Chain or Rig
        By mass; a `Rig` if the model has a support on an arm, a spring or a trolley, springs or dashpots at pins, or axial
        moments of inertia that turn with the support. All numbers equal those of the model to the last digit.

    Raises
    ------
    ValueError
        If the model is not a serial chain of straight links hung by hinges or ball joints without dry friction, or a
        spring is not relaxed in the straight chain; the message names the body or joint and says why.
    ImportError
        If mujoco is not installed; the message says how to install it.
    OSError
        (a ValueError too) If the file cannot be read.

    Notes
    -----
    The lower pin of a link is where the next body is hinged. The free end of the lowest link is its only site, the
    position of a massless body fixed to it, or else the far end of its geoms. A hinge about the vertical above all
    links is a turntable that keeps its speed. Links without a turntable, or on ball joints, do not spin about their own
    axes: their moments of inertia about these axes have no effect and are left out.

    A body on two level slides at right angles above all links is the carriage of a `Support`, with the stiffness and
    damping of the slides; without stiffness it is a trolley. In a model that moves in one plane it has one slide. Stiffness
    and damping of the joints at a pin, equal in both its hinges, are springs and dashpots of a `Pin`. A link stands
    (is `inverted`) where a spring at its pin holds it so.

    Contacts, keyframes and gravity are not read, nor are motors, which do nothing without a signal, and the ends of the
    rails of a carriage.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(mass=[1.0, 3.0], length=[0.5, 0.7])
    >>> rc.from_mjcf(rc.to_mjcf(chain)) == chain
    True
    """
    return _system("revchain.from_mjcf", source, "mujoco", LEAST)


def from_urdf(source: str | os.PathLike[str]) -> Chain | Rig:
    """Read a serial chain of links from a URDF file.

    Parameters
    ----------
    source : path-like or str
        Path of the file, or its text, which begins with ``<``.

    Returns
    -------
    Chain or Rig
        As from `from_mjcf`.

    Raises
    ------
    ValueError
        If the file is no serial chain of straight links; the message names the link or joint and says why.
    ImportError
        If mujoco is not installed; the message says how to install it.
    OSError
        (a ValueError too) If the file cannot be read.

    Notes
    -----
    MuJoCo takes the root link as fixed only if its name is ``world``. A link without mass and length is part of the joint
    below it. The free end of the lowest link is a link without mass fixed to it.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(mass=[1.0, 3.0], length=[0.5, 0.7])
    >>> rc.from_urdf(rc.to_urdf(chain)) == chain
    True
    """
    return _system("revchain.from_urdf", source, "robot", LEAST_OF_URDF)


def _system(function: str, source: Any, root: str, least: float) -> Chain | Rig:
    mujoco = require("mujoco", "exchange", function)
    is_text = isinstance(source, str) and source.lstrip().startswith("<")
    name = "" if is_text else file_path(function, "source", source)
    with naming(name):
        text = source if is_text else Path(name).read_text(encoding="utf-8")
    try:
        found = Xml.fromstring(text).tag
        if found != root:
            raise ValueError(
                f"source must begin with <{root}>, got <{found}>, {_OTHER.get(found, 'neither MJCF nor URDF')}"
            )
        spec = mujoco.MjSpec.from_string(text) if is_text else mujoco.MjSpec.from_file(name)
        if root == "robot":
            spec.compiler.fusestatic = False
        model = spec.compile()
    except (ValueError, Xml.ParseError) as error:
        raise ValueError(f"{function}: {error}") from None
    try:
        return _Model(mujoco, model, function, least).system()
    except ValueError as error:  # of a chain that it would make
        raise ValueError(f"{function}: {str(error).partition(': ')[2]}") from None


class _Link(NamedTuple):
    """A body between two pins; `way` says how it can turn about the upper one, `axis` where it points in space."""

    name: str
    mass: float
    length: float
    centroid: float
    radius_of_gyration: float
    axial: float
    way: str
    axis: Floats
    stiffness: float
    damping: float
    inverted: bool


class _Model:
    """A model that MuJoCo has compiled, in its pose at rest with relaxed springs, read as links hung one from another.

    Anything else is refused with the reason. Masses and moments of inertia up to `least` count as 0.
    """

    def __init__(self, mujoco: Any, model: Any, function: str, least: float) -> None:
        self.mujoco, self.model, self.function, self.least = mujoco, model, function, least
        kinds = mujoco.mjtJoint
        self.hinge, self.slide, self.ball = int(kinds.mjJNT_HINGE), int(kinds.mjJNT_SLIDE), int(kinds.mjJNT_BALL)
        self.turn: int | None = None  # the joint of the turntable
        self._refuse_wild()
        self.at = mujoco.MjData(model)
        for joint in np.flatnonzero(model.jnt_stiffness):
            here = int(model.jnt_qposadr[joint])
            its = slice(here, here + 4 if model.jnt_type[joint] == self.ball else here + 1)
            self.at.qpos[its] = model.qpos_spring[its]
        mujoco.mj_kinematics(model, self.at)
        size = float(np.linalg.norm(model.opt.gravity))
        self.children: list[list[int]] = [[] for _ in range(model.nbody)]
        self.moves = [bool(count) for count in model.body_jntnum]  # or something that hangs from it does
        for body in range(model.nbody - 1, 0, -1):
            above = int(model.body_parentid[body])
            self.children[above].insert(0, body)
            self.moves[above] |= self.moves[body]
        self.up = -model.opt.gravity / size if size else np.array([0.0, 0.0, 1.0])

    def system(self) -> Chain | Rig:
        """The chain, and the support if it is not a firm point on the axis."""
        for name, what in _MORE.items():
            if getattr(self.model, name):
                self._refuse(f"the model has {what}, which a chain does not have; take them away")
        self._refuse_servos()
        if self.model.body_gravcomp.any():
            self._refuse("gravity does not act on all bodies (gravcomp); set gravcomp to 0")
        if self.model.opt.density or self.model.opt.viscosity:
            self._refuse("the model is in a fluid, whose forces are not read; set density and viscosity of option to 0")
        bodies = self._path()
        first = self._joints(bodies[0])[0]
        if self.model.jnt_type[first] == self.hinge and abs(self.at.xaxis[first] @ self.up) > 1 - 1e-12:
            self.turn = first  # it turns all that hangs about the vertical
        bodies = bodies if self._joints(bodies[0]) else bodies[1:]
        given = self._carriage(bodies[0]) if bodies else {}
        slides = self._joints(bodies[0]) if given else []
        bodies = bodies[1:] if given else bodies
        if not bodies:
            self._refuse("no link hangs from the support")
        links = self._links(bodies)
        if len(slides) == 1:
            hinge = self.at.xaxis[self._joints(bodies[0])[0]]
            if links[0].way != "one hinge" or abs(hinge @ self.at.xaxis[slides[0]]) > _NEAR:
                self._refuse(
                    f"{self._name('joint', slides[0])} is the only slide, but the links do not move in its plane alone; "
                    "give the carriage a second slide across it"
                )
        if self.turn is not None:
            arm = self.at.xanchor[self._joints(bodies[0])[0]] - self.at.xanchor[self.turn]
            given["radius"] = float(np.linalg.norm(arm - (arm @ self.up) * self.up))
        links.reverse()
        axial = np.array([link.axial for link in links])
        chain, support = _chain(links, self._numeric(RATIO)), Support(**given)
        pins = Pin(stiffness=[link.stiffness for link in links], damping=[link.damping for link in links])
        if support == Support() and pins == Pin() and not axial.any():
            return chain
        wheels = Flywheel(axial_moment=axial) if axial.any() else None
        inverted = [link.inverted for link in links]
        return Rig(chain, support=support, flywheels=wheels, pins=pins, inverted=inverted)

    def _numeric(self, name: str) -> Floats:
        """The custom numbers of the file with a name; empty where there are none."""
        model = self.model
        known = [model.numeric(k).name for k in range(model.nnumeric)]
        return np.array(model.numeric(name).data if name in known else [])

    def _refuse_wild(self) -> None:
        """Refuse numbers that are not finite, or whose products would not be."""
        for kind, fields in _NUMBERS.items():
            for field in fields:
                values = getattr(self.model, f"{kind}_{field}")
                wild = np.argwhere(~(np.abs(values) <= _MOST))
                if wild.size:
                    number = int(wild[0, 0])
                    if kind == "dof":
                        number = int(self.model.dof_jntid[number])
                    name = self._name("joint" if kind in ("jnt", "dof") else kind, number)
                    self._refuse(f"{name}: {field} must be finite and at most {_MOST:g}, got {values[tuple(wild[0])]:g}")
        for field, values in (("ref", self.model.qpos0), ("springref", self.model.qpos_spring)):
            if not (np.abs(values) <= _MOST).all():
                self._refuse(f"{field} of all joints must be finite and at most {_MOST:g}, got {values}")
        if not (np.abs(self.model.opt.gravity) <= _MOST).all():
            self._refuse(f"gravity must be finite and at most {_MOST:g}, got {self.model.opt.gravity}")

    def _refuse(self, why: str) -> NoReturn:
        raise ValueError(f"{self.function}: {why}")

    def _name(self, kind: str, number: int) -> str:
        """The name of a body or joint as messages have it."""
        name = getattr(self.model, kind)(number).name
        return f"{kind} {name!r}" if name else f"{kind} number {number}"

    def _joints(self, body: int) -> list[int]:
        """The joints of a body, without that of the turntable."""
        first = int(self.model.body_jntadr[body])
        return [j for j in range(first, first + int(self.model.body_jntnum[body])) if j != self.turn]

    def _path(self) -> list[int]:
        """The bodies with joints, from the support down; refuses a model that is no serial chain."""
        bodies: list[int] = []
        here = 0
        while True:
            below = [b for b in self.children[here] if self.moves[b]]
            if len(below) > 1:
                one, other = (self._name("body", b) for b in below[:2])
                self._refuse(
                    f"{one} and {other} both hang from {self._name('body', here)}; only a serial chain can be read"
                )
            fixed = [b for b in self.children[here] if b not in below and self.model.body_subtreemass[b] > self.least]
            if bodies and fixed:
                self._refuse(
                    f"{self._name('body', fixed[0])} is fixed to {self._name('body', here)}; make them one body"
                )
            if not below:
                break
            here = below[0]
            if self._joints(here):
                bodies.append(here)
            elif bodies:
                self._refuse(
                    f"{self._name('body', here)} has no joint; make it one body with {self._name('body', bodies[-1])}"
                )
        if not bodies:
            self._refuse("the model has no joints; a URDF file needs a root link of the name world")
        return bodies

    def _refuse_servos(self) -> None:
        """Refuse actuators that act without a signal."""
        model = self.model
        for what in ("biastype", "damping", "dampingpoly", "armature"):
            acts = np.argwhere(getattr(model, f"actuator_{what}", np.zeros(0)))  # some are not in all versions
            if acts.size:
                name = self._name("actuator", int(acts[0, 0]))
                self._refuse(f"{name} acts without a signal, and a chain has no motors; take it away")
        low, high = model.actuator_ctrlrange.T
        if np.any(model.actuator_ctrllimited & ~((low <= 0) & (high >= 0))):
            self._refuse("an actuator acts without a signal, as its ctrlrange does not contain 0; take it away")

    def _carriage(self, body: int) -> dict[str, Any]:
        """The arguments of a `Support` for a body that slides; empty if the body does not slide."""
        model, joints = self.model, self._joints(body)
        if not joints or any(model.jnt_type[j] != self.slide for j in joints):
            return {}
        name, axes = self._name("body", body), self.at.xaxis[joints]
        across = abs(axes[0] @ axes[1]) < _NEAR if len(joints) == 2 else len(joints) == 1 and self.turn is None
        if not across or np.abs(axes @ self.up).max() > _NEAR:
            instead = "not on two level joints at right angles, nor on one in a plane model without a turntable"
            self._refuse(f"{name} slides, but {instead}")
        stiffness, damping = self._held(joints, name)
        for j in joints:
            if stiffness and model.qpos_spring[model.jnt_qposadr[j]] != model.qpos0[model.jnt_qposadr[j]]:
                self._refuse(
                    f"{self._name('joint', j)} has a spring that is not at rest (springref); set springref to 0"
                )
        mass = float(model.body_mass[body])
        mass = mass if mass > self.least else 0.0
        return {"stiffness": stiffness or (None if mass else 0.0), "damping": damping, "mass": mass}

    def _held(self, joints: list[int], name: str) -> tuple[float, float]:
        """Stiffness and damping of a pin or carriage, which are those of all its joints; refuses other forces."""
        model, found = self.model, []
        forces = {"stiffness": model.jnt_stiffness[joints], "damping": model.dof_damping[model.jnt_dofadr[joints]]}
        for what, values in forces.items():
            each = [float(np.ravel(value)[0]) for value in values]
            for joint, value in zip(joints, each, strict=True):
                if value < 0:
                    self._refuse(f"{self._name('joint', joint)} has a negative {what}, {value:g}; give 0 or more")
                if value != each[0]:
                    self._refuse(f"the joints of {name} have {what} {each[0]:g} and {value:g}; give both the same")
            found.append(each[0])
        for joint in joints:
            self._refuse_forces(joint)
        return found[0], found[1]

    def _refuse_forces(self, joint: int) -> None:
        """Refuse dry friction, limits and what else of a joint is not read; a rail may have ends."""
        model, dof = self.model, self.model.jnt_dofadr[joint]
        for field in _FORCES:
            values = getattr(model, field, None)  # some are not in all versions
            here = 0.0 if values is None else np.max(np.abs(values[joint if field.startswith("jnt") else dof]))
            if here:
                self._refuse(f"{self._name('joint', joint)} has {field.partition('_')[2]} {here:g}; set it to 0")
        low, high = model.jnt_range[joint]
        within = model.jnt_type[joint] == self.slide and low < model.qpos0[model.jnt_qposadr[joint]] < high
        if model.jnt_limited[joint] and not within:
            self._refuse(f"{self._name('joint', joint)} has a range; take it away")

    def _links(self, bodies: list[int]) -> list[_Link]:
        """The links that the bodies are, from the support down."""
        links: list[_Link] = []
        joints: list[int] = []
        for body, after in zip(bodies, [*bodies[1:], None], strict=True):
            joints += self._joints(body)
            pin = self._pin(body)
            end = self._free_end(body, pin) if after is None else self._in_parent(after)
            along = end - pin
            if np.linalg.norm(along) > _NEAR * np.abs(self.model.body_pos).max(initial=0.0):
                links.append(self._link(body, joints, pin, along, links[-1] if links else None))
                joints = []
            elif self.model.body_mass[body] > self.least:
                self._refuse(f"{self._name('body', body)} has mass but no length: the next joint is at its own")
        ways = {link.way for link in links}
        if "one hinge" in ways:
            if len(ways) > 1:
                self._refuse("some links have one hinge and some have more; a chain moves in one plane or in space")
            axes = self.at.xaxis[[j for b in bodies for j in self._joints(b)]]
            if np.abs(np.cross(axes, axes[0])).max() > _NEAR or np.abs(axes @ self.up).max() > _NEAR:
                self._refuse("links have one hinge each, but these are not level and parallel")
        return links

    def _pin(self, body: int) -> Floats:
        """The position of the joints of a body in its own frame."""
        joints = self._joints(body)
        for j in joints:
            if self.model.jnt_type[j] not in (self.hinge, self.ball):
                self._refuse(f"{self._name('joint', j)} is neither a hinge nor a ball joint")
            if np.any(self.model.jnt_pos[j] != self.model.jnt_pos[joints[0]]):
                self._refuse(
                    f"the joints of {self._name('body', body)} are at different places; a link has one upper pin"
                )
        return np.array(self.model.jnt_pos[joints[0]])

    def _in_parent(self, body: int) -> Floats:
        """The position of the joints of a body in the frame of the body above."""
        turned = self._matrix(self.model.body_quat[body]) @ self.model.jnt_pos[self._joints(body)[0]]
        return np.asarray(self.model.body_pos[body] + turned)

    def _matrix(self, quaternion: Floats) -> Floats:
        flat = np.empty(9)
        self.mujoco.mju_quat2Mat(flat, quaternion)
        return flat.reshape(3, 3)

    def _free_end(self, body: int, pin: Floats) -> Floats:
        """The free end: a body without mass, the only site, or the end of the geoms beyond the centre of gravity."""
        model, marks = self.model, self.children[body]
        sites = np.flatnonzero(model.site_bodyid == body)
        if len(marks) == 1:
            return np.array(model.body_pos[marks[0]])
        if len(sites) == 1:
            return np.array(model.site_pos[sites[0]])
        out = model.body_ipos[body] - pin
        ends = [end for g in np.flatnonzero(model.geom_bodyid == body) for end in self._ends(int(g))]
        if not out.any() or not ends:
            self._refuse(f"the free end of {self._name('body', body)} is not marked; put a site there")
        out = out / np.linalg.norm(out)
        return np.asarray(pin + max((end - pin) @ out for end in ends) * out)

    def _ends(self, geom: int) -> list[Floats]:
        """The ends of the axis of a capsule or cylinder; the centre of any other geom."""
        model, kinds = self.model, self.mujoco.mjtGeom
        is_long = model.geom_type[geom] in (int(kinds.mjGEOM_CAPSULE), int(kinds.mjGEOM_CYLINDER))
        half = self._matrix(model.geom_quat[geom])[:, 2] * (model.geom_size[geom][1] if is_long else 0.0)
        return [model.geom_pos[geom] + half, model.geom_pos[geom] - half]

    def _link(self, body: int, joints: list[int], pin: Floats, along: Floats, above: _Link | None) -> _Link:
        model, name = self.model, self._name("body", body)
        length = float(np.linalg.norm(along))
        axis = along / length
        centre = model.body_ipos[body] - pin
        centroid, mass = float(centre @ axis), float(model.body_mass[body])
        if np.linalg.norm(centre - centroid * axis) > _NEAR * length and mass > self.least:
            self._refuse(f"the centre of gravity of {name} is not on the line between its pins")
        turned = self._matrix(self.at.xquat[body]) @ axis
        way, hinge = self._way(joints, turned, name)
        across, axial = self._moments(body, axis, hinge, name)
        is_ball = abs(axial - self.least) < _NEAR * self.least  # what to_mjcf and to_urdf add about all axes
        mass = mass if mass > self.least else 0.0
        radius = radius_of_gyration(across, mass, self.least if is_ball else 0.0)
        if self.turn is None or way == "ball" or not mass or is_ball or axial <= max(self.least, _NEAR * across):
            axial = 0.0  # of no effect
        pin_has, inverted = self._held(joints, name), False
        if any(pin_has) and len(joints) > 1 and (way == "ball" or abs(np.dot(*self.at.xaxis[joints])) > _NEAR):
            self._refuse(f"springs and dashpots at the pin of {name} need one hinge, two at right angles or a ball joint")
        if pin_has[0]:
            inverted = self._stands(turned, above, self._name("joint", joints[0]))
        return _Link(model.body(body).name, mass, length, centroid, radius, axial, way, turned, *pin_has, inverted)

    def _stands(self, axis: Floats, above: _Link | None, joint: str) -> bool:
        """Whether a link stands if the springs at its pin are relaxed in this direction."""
        over, what = (-self.up, "the vertical") if above is None else (above.axis, "the link above")
        cosine, sine = float(axis @ over), float(np.linalg.norm(np.cross(axis, over)))
        if sine > _NEAR:
            self._refuse(
                f"{joint} has a spring that is relaxed {math.degrees(math.atan2(sine, cosine)):.6g} degrees from {what}; "
                "set springref to where the chain is straight"
            )
        return (above is not None and above.inverted) != (cosine < 0)

    def _way(self, joints: list[int], axis: Floats, name: str) -> tuple[str, Floats | None]:
        """How a link with this axis in space turns about its pin, and the direction of its hinge if it has only one."""
        hinges = [j for j in joints if self.model.jnt_type[j] == self.hinge]
        if len(hinges) < len(joints) or len(hinges) > 2:
            return "ball", None
        axes = self.at.xaxis[hinges]
        if np.abs(axes @ axis).max() > _NEAR or (len(hinges) == 2 and np.linalg.norm(np.cross(*axes)) < _NEAR):
            self._refuse(f"the hinges of {name} are not across the link, at its upper pin")
        return ("one hinge", axes[0]) if len(hinges) == 1 else ("two hinges", None)

    def _moments(self, body: int, axis: Floats, hinge: Floats | None, name: str) -> tuple[float, float]:
        """Moments of inertia about the centre of gravity, across the link and along it."""
        model = self.model
        frame = self._matrix(model.body_iquat[body])
        inertia = frame @ np.diag(model.body_inertia[body]) @ frame.T
        if hinge is None:
            across = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
            across /= np.linalg.norm(across)
        else:
            across = self._matrix(self.at.xquat[body]).T @ hinge
        base = np.stack([across, np.cross(axis, across), axis])
        about = base @ inertia @ base.T
        uneven = np.abs(about - np.diag(about[[0, 0, 2], [0, 0, 2]])).max()
        if hinge is None and uneven > _NEAR * np.abs(about).max() + self.least:
            self._refuse(
                f"{name} is not alike all round its axis: its moments of inertia are {model.body_inertia[body]}"
            )
        return float(about[0, 0]), float(about[2, 2])


def _chain(links: list[_Link], ratio: Floats) -> Chain:
    """The chain of links from the free end up; `ratio` are their radii of gyration with more digits, or empty."""
    names = [link.name for link in links]
    numbered = not all(names) or names == [f"link_{k}" for k in range(len(names))]
    columns = {name: [getattr(link, name) for link in links] for name in _COLUMNS}
    chain = Chain(names=None if numbered else names, **columns)  # type: ignore[arg-type]
    if ratio.size == 2 * len(links):
        more = dict(zip(("gyration_ratio", "gyration_ratio_low"), ratio.reshape(2, -1).tolist(), strict=True))
        with suppress(ValueError):  # numbers of another chain
            exact = Chain.from_dict(chain.to_dict() | more)
            return exact if np.array_equal(exact.radius_of_gyration, chain.radius_of_gyration) else chain
    return chain


_COLUMNS = ("mass", "length", "centroid", "radius_of_gyration")
