# SPDX-License-Identifier: GPL-3.0-or-later
"""A model that MuJoCo has compiled, read as links hung one from another."""

from __future__ import annotations

import math
from contextlib import suppress
from typing import Any, NamedTuple, NoReturn

import numpy as np

from ..systems.chain import Chain
from ..systems.numbers import Floats
from ..systems.rig import Flywheel, Pin, Rig, Support
from .findings import Findings
from .mechanism import radius_of_gyration
from .text import Text
from .write import RATIO

_NEAR = 1e-9  # parts of a length, an axis or a moment by which a model may differ from a straight link
_ROUNDED = 1e-3  # of the direction of an axis, where angles of the file are rounded: second order in all speeds
_NUMBERS = {
    "body": ("pos", "quat", "mass", "inertia", "ipos", "iquat"),
    "jnt": ("pos", "axis", "stiffness"),
    "dof": ("damping",),
    "geom": ("pos", "quat", "size"),
    "site": ("pos",),
}
_MOST = 1e75  # of a number, so that the product of four is finite
_COLUMNS = ("mass", "length", "centroid", "radius_of_gyration")


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


class _Part(NamedTuple):
    """A rigid body of the model: a body with joints and the bodies fixed to it, in the frame of the former.

    `ball` is the moment of inertia about all axes that was added to the inertia for MuJoCo.
    """

    body: int
    joints: list[int]
    fixed: list[int]
    mass: float
    centre: Floats
    inertia: Floats
    ball: float
    pin: Floats
    name: str


class Model:
    """A model in its pose at rest with relaxed springs. Masses and moments of inertia up to `least` count as 0."""

    def __init__(self, mujoco: Any, model: Any, text: Text, findings: Findings, least: float) -> None:
        self.mujoco, self.model, self.text, self.findings, self.least = mujoco, model, text, findings, least
        self.wanted: list[int] = []  # the bodies that the caller names
        kinds = mujoco.mjtJoint
        self.hinge, self.slide, self.ball = int(kinds.mjJNT_HINGE), int(kinds.mjJNT_SLIDE), int(kinds.mjJNT_BALL)
        self.turn: int | None = None  # the joint of the turntable
        self._refuse_wild()
        self.at = mujoco.MjData(model)
        for joint in np.flatnonzero(self._stiffness()):
            here = int(model.jnt_qposadr[joint])
            its = slice(here, here + 4 if model.jnt_type[joint] == self.ball else here + 1)
            self.at.qpos[its] = model.qpos_spring[its]
        mujoco.mj_kinematics(model, self.at)
        self.gravity = float(np.linalg.norm(model.opt.gravity)) if self._acts("gravity") else 0.0
        self.children: list[list[int]] = [[] for _ in range(model.nbody)]
        self.moves = [bool(count) for count in model.body_jntnum]  # or something that hangs from it does
        for body in range(model.nbody - 1, 0, -1):
            above = int(model.body_parentid[body])
            self.children[above].insert(0, body)
            self.moves[above] |= self.moves[body]
        self.up = -model.opt.gravity / self.gravity if self.gravity else np.array([0.0, 0.0, 1.0])

    def choose(self, links: tuple[str, ...]) -> None:
        """Take the chain of these bodies; a ValueError lists all bodies if one is unknown."""
        known = {self._plain("body", b): b for b in range(1, self.model.nbody)}
        for name in links:
            if name not in known:
                names = ", ".join(repr(each) for each in known if each not in self.text.unnamed)
                raise ValueError(f"{self.findings.function}: links must be names of bodies, {names}; got {name!r}")
        self.wanted = [known[name] for name in links]

    def system(self) -> Chain | Rig:
        """The chain, and the support if it is not a firm point on the axis; one error with all obstacles."""
        self._look_at_the_whole()
        bodies = self._path()
        for joint in range(self.model.njnt) if bodies is None else [j for b in bodies for j in self._joints(b)]:
            self._look_at_joint(joint)
        if bodies is None:
            self.findings.stop()
        first = self._joints(bodies[0])[0]
        if self.model.jnt_type[first] == self.hinge and abs(self.at.xaxis[first] @ self.up) > 1 - 1e-12:
            self.turn = first  # it turns all that hangs about the vertical
        parts = [self._part(b, after) for b, after in zip(bodies, [*bodies[1:], None], strict=True)]
        parts = parts if parts[0].joints else parts[1:]
        given = self._carriage(parts[0]) if parts else {}
        slides = parts[0].joints if given else []
        parts = parts[1:] if given else parts
        if not parts:
            self._obstacle("body", bodies[-1], "no link hangs from the support", "add a body on a hinge below it")
            self.findings.stop()
        links = self._links(parts)
        if len(slides) == 1:
            hinge = self.at.xaxis[parts[0].joints[0]]
            if links[0].way != "one hinge" or abs(hinge @ self.at.xaxis[slides[0]]) > _ROUNDED:
                self._obstacle(
                    "joint", slides[0], "is the only slide, but the links do not move in its plane alone",
                    "give the carriage a second slide across it",
                )  # fmt: skip
        if self.turn is not None:
            given["radius"] = self._arm(self.turn, parts[0].joints, links[0].way, any(link.axial for link in links))
        self.findings.check()
        links.reverse()
        axial = np.array([link.axial for link in links])
        chain, support = _chain(links, self._numeric(RATIO), self.text.unnamed), Support(**given)
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

    def _acts(self, *what: str) -> bool:
        """Whether none of these kinds of forces is disabled in the file."""
        flags = [getattr(self.mujoco.mjtDisableBit, f"mjDSBL_{each.upper()}", None) for each in what]
        return not any(self.model.opt.disableflags & int(flag) for flag in flags if flag is not None)

    def _stiffness(self) -> Floats:
        """Stiffness of each joint; 0 where springs are disabled."""
        return np.asarray(self.model.jnt_stiffness) * self._acts("passive", "spring")

    # ---- obstacles of the whole and of single joints

    def _refuse_wild(self) -> None:
        """Refuse numbers that are not finite, or whose products would not be."""
        model = self.model
        for kind, fields in _NUMBERS.items():
            for field in fields:
                values = getattr(model, f"{kind}_{field}")
                wild = np.argwhere(~(np.abs(values) <= _MOST))
                if wild.size:
                    number = int(wild[0, 0])
                    if kind == "dof":
                        number = int(model.dof_jntid[number])
                    element = "joint" if kind in ("jnt", "dof") else kind
                    self._wild(self._name(element, number), f": {field}", values[tuple(wild[0])], element, number)
        for field, values in (("ref", model.qpos0), ("springref", model.qpos_spring)):
            if not (np.abs(values) <= _MOST).all():
                self._wild(f"{field} of all joints", "", values)
        if not (np.abs(model.opt.gravity) <= _MOST).all():
            self._wild("gravity", "", model.opt.gravity)

    def _wild(self, name: str, field: str, value: Any, kind: str = "", number: int = 0) -> NoReturn:
        place = self._place(kind, number) if kind else ("", 0)
        self.findings.obstacle(place, f"{name}{field} must be finite and at most {_MOST:g}, got {value}", "change it")
        self.findings.stop()

    def _obstacle(self, kind: str, number: int, what: str, instead: str, word: str = "") -> None:
        """Note an obstacle of a body, joint or other element."""
        self.findings.obstacle(self._place(kind, number), f"{self._name(kind, number)} {what}", instead, word)

    def _name(self, kind: str, number: int) -> str:
        """The name of a body or joint as messages have it."""
        if kind in ("geom", "site"):
            return f"{kind} {getattr(self.model, kind)(number).name!r}"
        return self.text.name_of(kind, self._plain(kind, number)) if kind != "body" or number else "the ground"

    def _place(self, kind: str, number: int) -> tuple[str, int]:
        return self.text.place_of(kind, self._plain(kind, number))

    def _plain(self, kind: str, number: int) -> str:
        return str(getattr(self.model, {"equality": "eq"}.get(kind, kind))(number).name)

    def _look_at_the_whole(self) -> None:
        """Note what is not of one joint: constraints, tendons, actuators, fluids, gravity."""
        model, note = self.model, self.findings.obstacle
        if self._acts("constraint", "equality"):
            for k in np.flatnonzero(getattr(model, "eq_active0", np.ones(model.neq))):
                self._obstacle("equality", int(k), "is a constraint, which a chain does not have", "take it away", "equality")
        for k in range(model.ntendon):
            fields = ("stiffness", "damping", "frictionloss", "limited", "armature", "actfrclimited")
            if any(np.any(getattr(model, f"tendon_{field}", 0.0)[k]) for field in fields if hasattr(model, f"tendon_{field}")):
                self._obstacle("tendon", k, "pulls at the links, which a chain does not have", "take it away", "tendon")
        if model.nflex:
            note(("", 0), "the model has flexes, which a chain does not have", "remove them")
        if model.nplugin:
            note(("", 0), "the model has plugins, whose forces are not read", "remove them", "plugin")
        if np.any(model.body_gravcomp):
            for body in np.flatnonzero(model.body_gravcomp):
                self._obstacle("body", int(body), "is held against gravity (gravcomp)", "set gravcomp to 0", "gravcomp")
        if model.opt.density or model.opt.viscosity:
            what = "the model is in a fluid, whose forces are not read"
            note(self.text.option("density"), what, "set density and viscosity of option to 0", "fluid")
        if not self.gravity:
            note(self.text.option("gravity"), "gravity is 0, so that nothing makes the links hang", "set gravity of option")
        if self._acts("actuation"):
            self._look_at_actuators()

    def _look_at_actuators(self) -> None:
        """Note actuators that act without a signal; the others exert no force."""
        model = self.model
        fields = [f"actuator_{what}" for what in ("biastype", "damping", "dampingpoly", "armature")]  # some are not in all versions
        for k in range(model.nu):
            low, high = model.actuator_ctrlrange[k]
            if any(np.any(getattr(model, field)[k]) for field in fields if hasattr(model, field)):
                self._obstacle("actuator", k, "acts without a signal, and a chain has no motors", "take it away", "actuator")
            elif model.actuator_ctrllimited[k] and not low <= 0 <= high:
                what = "acts without a signal, as its ctrlrange does not contain 0"
                self._obstacle("actuator", k, what, "take it away", "actuator")
            else:
                what = f"{self._name('actuator', k)} exerts no force without a signal: left out"
                self.findings.remark(self._place("actuator", k), what)

    def _look_at_joint(self, joint: int) -> None:
        """Note dry friction, limits, dashpots and springs of a joint that are not read; a rail may have ends."""
        model, dof = self.model, int(self.model.jnt_dofadr[joint])
        dofs = slice(dof, dof + {self.ball: 3, self.hinge: 1, self.slide: 1}.get(int(model.jnt_type[joint]), 6))
        damping = self._damping(joint)
        if "damping" in self.findings.ignore and damping:
            self.findings.leave_out(self._place("joint", joint), f"{self._name('joint', joint)} has damping {damping:g}")
        poly = np.abs(getattr(model, "dof_dampingpoly", np.zeros(model.nv))[dofs]).max()
        if poly and self._acts("passive", "damper"):
            self._obstacle("joint", joint, f"has dampingpoly {poly:g}", "set it to 0", "damping")
        poly = np.abs(getattr(model, "jnt_stiffnesspoly", np.zeros(model.njnt))[joint]).max()
        if poly and self._acts("passive", "spring"):
            self._obstacle("joint", joint, f"has stiffnesspoly {poly:g}", "set it to 0", "stiffness")
        friction = float(model.dof_frictionloss[dofs].max())
        if friction and self._acts("constraint", "frictionloss"):
            self._obstacle("joint", joint, f"has frictionloss {friction:g}", "set it to 0", "friction")
        for what, value, word in (("damping", damping, "damping"), ("stiffness", float(np.ravel(self._stiffness()[joint])[0]), "stiffness")):
            if value < 0:
                self._obstacle("joint", joint, f"has a negative {what}, {value:g}", "give 0 or more", word)
        if not model.jnt_limited[joint] or not self._acts("constraint", "limit"):
            return
        low, high = model.jnt_range[joint]
        if model.jnt_type[joint] == self.slide and low < model.qpos0[model.jnt_qposadr[joint]] < high:
            what = f"{self._name('joint', joint)} has a range, {low:g} to {high:g} m: the ends of the rail are left out"
            self.findings.remark(self._place("joint", joint), what)
            return
        unit, scale = ("m", 1.0) if model.jnt_type[joint] == self.slide else ("degrees", math.degrees(1))
        between = f"{low * scale:g} to {high * scale:g} {unit}"
        self._obstacle("joint", joint, f"has a range, {between}", "take it away", "range")

    def _damping(self, joint: int) -> float:
        """The damping of a joint, or 0 where dashpots are disabled."""
        value = np.ravel(self.model.dof_damping[self.model.jnt_dofadr[joint]])[0]
        return float(value) * self._acts("passive", "damper")

    # ---- bodies

    def _joints(self, body: int) -> list[int]:
        """The joints of a body, without that of the turntable."""
        first = int(self.model.body_jntadr[body])
        return [j for j in range(first, first + int(self.model.body_jntnum[body])) if j != self.turn]

    def _path(self) -> list[int] | None:
        """The bodies with joints, from the support down, along the longest branch if there are more; None without joints."""
        wanted, bodies = self.wanted, list[int]()
        here, rest = 0, set(wanted)
        while True:
            below = [b for b in self.children[here] if self.moves[b]]
            chosen = [b for b in below if not wanted or rest & self._below(b)]
            if len(chosen) > 1:
                chosen = [self._fork(bodies, here, chosen)]
            elif wanted:
                self._leave_out([b for b in below if b not in chosen])
            if not chosen:
                break
            here = chosen[0]
            rest.discard(here)
            if self._joints(here):
                bodies.append(here)
        if not bodies:
            instead = "add a hinge above each link"
            self.findings.obstacle(("", 0), "the model has no joints", instead)
            return None
        return bodies

    def _below(self, body: int) -> set[int]:
        """A body and all that hangs from it."""
        return {body}.union(*(self._below(b) for b in self.children[body]))

    def _fork(self, above: list[int], here: int, below: list[int]) -> int:
        """Note that more than one body hangs from another, and which names to give; return the body to follow."""
        followed = max(below, key=lambda b: len(self._longest(b)))
        others = [b for b in below if b != followed]
        names = [self._plain("body", b) for b in (*above, *self._longest(followed))]
        named = " ".join(name for name in names if name not in self.text.unnamed)
        instead = f'name the links of one chain, such as links="{named}"' if named else "name the bodies, and give links"
        *first, last = [self._name("body", b) for b in sorted(below)]
        these = f"{', '.join(first)} and {last}"
        number = "both" if len(others) == 1 else "all"
        what = f"{these} {number} hang from {self._name('body', here)}; only a serial chain can be read"
        self.findings.obstacle(self._place("body", others[0]), what, instead)
        return followed

    def _longest(self, body: int) -> list[int]:
        """The longest line of bodies that hang one from another, from this one down."""
        lines = [self._longest(b) for b in self.children[body] if self.moves[b]]
        return [body, *max(lines, key=len, default=[])]

    def _leave_out(self, bodies: list[int]) -> None:
        """Note bodies that do not belong to the chain that the caller names."""
        for body in bodies:
            what = f"{self._name('body', body)}, {self.model.body_subtreemass[body]:g} kg with what hangs from it, is not among links"
            self.findings.leave_out(self._place("body", body), what)

    def _part(self, body: int, after: int | None) -> _Part:
        """A body with joints and the bodies fixed to it."""
        joints, fixed, todo = self._joints(body), [], list(self.children[body])
        while todo:
            each = todo.pop(0)
            if not self._joints(each) and each != after:
                fixed.append(each)
                todo += self.children[each]
        pin = np.array(self.model.jnt_pos[joints[0]]) if joints else np.zeros(3)
        name = self._name("body", body)
        for j in joints:
            if np.any(self.model.jnt_pos[j] != self.model.jnt_pos[joints[0]]):
                what = f"the joints of {name} are at different places; a link has one upper pin"
                self.findings.obstacle(self._place("body", body), what, "give all the same pos")
        heavy = [b for b in (body, *fixed) if self.model.body_mass[b] > self.least]
        if len(heavy) < 2 and (not heavy or heavy[0] == body):
            inertia, ball = self._inertia(body)
            mass = float(self.model.body_mass[body])
            return _Part(body, joints, fixed, mass, np.array(self.model.body_ipos[body]), inertia, ball, pin, name)
        mass = float(sum(self.model.body_mass[b] for b in heavy))
        frames = {b: self._frame(b, body) for b in heavy}
        centres = {b: origin + turned @ self.model.body_ipos[b] for b, (origin, turned) in frames.items()}
        centre = np.sum([self.model.body_mass[b] * centres[b] for b in heavy], axis=0) / mass
        inertia = np.zeros((3, 3))
        for b in heavy:
            own, ball = self._inertia(b)
            turned, apart = frames[b][1], centres[b] - centre
            inertia += turned @ (own - ball * np.eye(3)) @ turned.T
            inertia += self.model.body_mass[b] * (apart @ apart * np.eye(3) - np.outer(apart, apart))
        return _Part(body, joints, fixed, mass, centre, inertia, 0.0, pin, name)

    def _frame(self, body: int, of: int) -> tuple[Floats, Floats]:
        """Origin and axes of a body in the frame of another to which it is fixed."""
        base = self._matrix(self.at.xquat[of])
        return base.T @ (self.at.xpos[body] - self.at.xpos[of]), base.T @ self._matrix(self.at.xquat[body])

    def _inertia(self, body: int) -> tuple[Floats, float]:
        """Moments of inertia about the centre of gravity in the frame of a body, and what was added to them for MuJoCo."""
        frame, given = self._matrix(self.model.body_iquat[body]), self.text.inertia.get(self._plain("body", body))
        values = self.model.body_inertia[body]
        about = frame @ (np.diag(values) if given is None else given) @ frame.T
        near = given is None and np.abs(values - self.least).min() < _NEAR * self.least
        return about, self.least if near else 0.0

    def _matrix(self, quaternion: Floats) -> Floats:
        flat = np.empty(9)
        self.mujoco.mju_quat2Mat(flat, quaternion)
        return flat.reshape(3, 3)

    # ---- the support

    def _carriage(self, part: _Part) -> dict[str, Any]:
        """The arguments of a `Support` for a body that slides; empty if the body does not slide."""
        model, joints = self.model, part.joints
        if not joints or any(model.jnt_type[j] != self.slide for j in joints):
            return {}
        axes = self.at.xaxis[joints]
        across = abs(axes[0] @ axes[1]) < _NEAR if len(joints) == 2 else len(joints) == 1 and self.turn is None
        if not across or np.abs(axes @ self.up).max() > (_NEAR if len(joints) == 2 else _ROUNDED):
            what = "slides, but not on two level joints at right angles, nor on one in a plane model without a turntable"
            self._obstacle("body", part.body, what, "give it such slides, or a firm support")
        stiffness, damping = self._held(part)
        for j in joints:
            if stiffness and model.qpos_spring[model.jnt_qposadr[j]] != model.qpos0[model.jnt_qposadr[j]]:
                what = "has a spring that is not at rest (springref)"
                self._obstacle("joint", j, what, "set springref to 0", "stiffness")
        rotors = model.dof_armature[model.jnt_dofadr[joints]]
        if rotors.min() != rotors.max():
            self._obstacle("body", part.body, "has slides of different armature", "give both the same", "armature")
            rotors = np.zeros(1)
        mass = float(part.mass) if part.mass > self.least else 0.0
        mass += float(rotors[0])
        return {"stiffness": stiffness or (None if mass else 0.0), "damping": damping, "mass": mass}

    def _arm(self, turn: int, joints: list[int], way: str, is_driven: bool) -> float:
        """The radius of the turntable, which keeps its speed in a `Rig` whatever its moment of inertia is."""
        apart = self.at.xanchor[joints[0]] - self.at.xanchor[turn]
        arm = apart - (apart @ self.up) * self.up
        radius = float(np.linalg.norm(arm))
        if way == "one hinge" and radius and abs(arm @ self.at.xaxis[joints[0]]) > _ROUNDED * radius:
            what = "swings its link across the arm of the turntable, and in a Rig links move in the plane of the arm"
            self._obstacle("joint", joints[0], what, "turn its axis by 90 degrees")
        whole = float(self.model.body_subtreemass[0]) * (radius**2 + float(np.ptp(self.at.xipos, axis=0).max()) ** 2)
        own = float(self.model.body_inertia[self.model.jnt_bodyid[turn]].max())
        if radius and own < 1e3 * whole:
            what = f"{self._name('joint', turn)} turns about the vertical: a support that keeps its speed, whatever its moment of inertia"
            self.findings.remark(self._place("joint", turn), what)
        if is_driven:
            what = "links turn with the support about their own axes: speeds are those of whirl, not of swing in a plane"
            self.findings.remark(self._place("joint", turn), what)
        return radius

    def _held(self, part: _Part) -> tuple[float, float]:
        """Stiffness and damping of a pin or carriage, which are those of all its joints."""
        found = []
        stiffness = [float(np.ravel(self._stiffness()[j])[0]) for j in part.joints]
        for what, each in (("stiffness", stiffness), ("damping", [self._damping(j) for j in part.joints])):
            if what == "damping" and what in self.findings.ignore:
                each = [0.0]
            if min(each) != max(each):
                other = next(value for value in each if value != each[0])
                self.findings.obstacle(
                    self._place("body", part.body), f"the joints of {part.name} have {what} {each[0]:g} and {other:g}",
                    "give both the same", what,
                )  # fmt: skip
                each = [0.0]
            found.append(max(each[0], 0.0))
        return found[0], found[1]

    # ---- the links

    def _links(self, parts: list[_Part]) -> list[_Link]:
        """The links that the bodies are, from the support down; a body without mass and length is part of a joint."""
        for part in parts:
            for j in part.joints:
                if self.model.jnt_type[j] not in (self.hinge, self.ball):
                    kind = "slides" if self.model.jnt_type[j] == self.slide else "moves freely"
                    what = f"is neither a hinge nor a ball joint: it {kind}"
                    self._obstacle("joint", j, what, "a chain slides only above its links")
        every = [j for part in parts for j in part.joints]
        is_plane = self._moves_in_a_plane(parts, every)
        self._look_at_rotors(parts, is_plane)
        links: list[_Link] = []
        joints: list[int] = []
        size = np.abs(self.model.body_pos).max(initial=0.0)
        for k, (part, after) in enumerate(zip(parts, [*parts[1:], None], strict=True)):
            joints += part.joints
            end = self._free_end(part, is_plane) if after is None else self._in_parent(part, after)
            along, centre = self._seen(part, end - part.pin, is_plane), self._seen(part, part.centre - part.pin, is_plane)
            if np.linalg.norm(along) > _NEAR * size or after is None:
                hung = sum(each.mass for each in parts[k + 1 :])
                links.append(self._link(part, joints, along, centre, hung, is_plane, links[-1] if links else None))
                joints = []
            elif part.mass > self.least:
                self._obstacle("body", part.body, "has mass but no length: the next joint is at its own", "move that joint")
        ways = {link.way for link in links} - {"none"}
        if "one hinge" in ways and not is_plane:
            what = "some links have one hinge and some have more"
            if len(ways) == 1:
                what = "links have one hinge each, but these are not level and parallel"
            instead = "give all links level and parallel hinges, or each two hinges or a ball joint"
            self.findings.obstacle(self._place("body", parts[0].body), f"{what}; a chain moves in one plane or in space", instead)
        return links

    def _moves_in_a_plane(self, parts: list[_Part], every: list[int]) -> bool:
        """Whether all joints are parallel hinges. Their inclination, if any, lowers the gravity in the plane."""
        if any(len(part.joints) != 1 or self.model.jnt_type[part.joints[0]] != self.hinge for part in parts):
            return False
        axes = self.at.xaxis[every]
        apart = np.linalg.norm(np.cross(axes, axes[0]), axis=1)
        if apart.max() > _ROUNDED:
            return False  # and `_way` says so
        tilt = abs(float(axes[0] @ self.up))
        if tilt > 1 - 1e-6:
            what = "turns about the vertical: gravity does not swing its link back"
            self._obstacle("joint", every[0], what, "a chain hangs from level hinges")
            return True
        if tilt > _NEAR and self.turn is None:
            degrees = math.degrees(math.asin(tilt))
            self.gravity *= math.sqrt(1 - tilt**2)
            what = f"the hinges are inclined by {degrees:.3g} degrees: gravity in the plane of motion is {self.gravity:.9g} m/s^2"
            self.findings.remark(self._place("joint", every[0]), what)
        return tilt < _NEAR or self.turn is None

    def _look_at_rotors(self, parts: list[_Part], is_plane: bool) -> None:
        """Note inertia of rotors below the uppermost hinge of a plane chain."""
        model = self.model
        for k, part in enumerate(parts):
            for j in part.joints:
                value = float(model.dof_armature[model.jnt_dofadr[j]])
                if value and not (k == 0 and is_plane):
                    self._obstacle("joint", j, f"has armature {value:g}", "set it to 0", "armature")

    def _seen(self, part: _Part, vector: Floats, is_plane: bool) -> Floats:
        """A vector in the frame of a body, or its projection on the plane in which the chain moves."""
        if not is_plane:
            return vector
        hinge = np.asarray(self.model.jnt_axis[part.joints[0]])
        return np.asarray(vector - (vector @ hinge) * hinge)

    def _in_parent(self, part: _Part, after: _Part) -> Floats:
        """The position of the joints of a body in the frame of the body above."""
        body, model = after.body, self.model
        joint = model.jnt_pos[after.joints[0]]
        if model.body_parentid[body] == part.body:
            return np.asarray(model.body_pos[body] + self._matrix(model.body_quat[body]) @ joint)
        origin, turned = self._fixed_frame(body, part.body)
        return np.asarray(origin + turned @ joint)

    def _fixed_frame(self, body: int, of: int) -> tuple[Floats, Floats]:
        """The frame of a body whose joints are at their reference, in that of the body to whose parts it is hinged."""
        origin, turned = self._frame(int(self.model.body_parentid[body]), of)
        return origin + turned @ self.model.body_pos[body], turned @ self._matrix(self.model.body_quat[body])

    def _free_end(self, part: _Part, is_plane: bool) -> Floats:
        """The free end: a body without mass, the only site, the end of the geoms, or else the centre of gravity.

        Small motion does not depend on it. The link hangs with its centre of gravity straight below its pin; the end is the
        foot of the mark on this line.
        """
        model, body, pin = self.model, part.body, part.pin
        out = self._seen(part, part.centre - pin, is_plane)
        reach = float(np.linalg.norm(out))
        marks = [origin for b in part.fixed if model.body_mass[b] <= self.least for origin in [self._frame(b, body)[0]]]
        if len(part.fixed) == len(marks) == 1 and model.body_parentid[part.fixed[0]] == body:
            marks = [np.array(model.body_pos[part.fixed[0]])]
        sites = [np.array(model.site_pos[s]) for s in np.flatnonzero(model.site_bodyid == body)]
        for found in (marks, sites):
            if len(found) == 1:
                along = self._seen(part, found[0] - pin, is_plane)
                length = float(np.linalg.norm(along))
                hangs = along @ out >= 0 or self._stiffness()[part.joints].any()  # springs hold a link that stands
                if length > _NEAR * reach and (part.mass <= self.least or (hangs and self._is_on(out, along))):
                    return np.asarray(found[0])
                if reach and length and along @ out > 0:
                    return np.asarray(pin + (along @ out) / reach**2 * out)
        scale = max([reach, *(float(np.linalg.norm(end - pin)) for end in self._ends(part))])
        if reach > _NEAR * scale:
            out = out / reach
            far = max([(end - pin) @ out for end in self._ends(part)], default=0.0)
            if far > _NEAR * scale:
                return np.asarray(pin + far * out)
            what = f"the free end of {part.name} is not marked: taken at its centre of gravity; no speed depends on it"
            self.findings.remark(self._place("body", body), what)
            return np.asarray(part.centre)
        what = f"the free end of {part.name} is not marked, and its centre of gravity is at its pin"
        self.findings.obstacle(self._place("body", body), what, "put a site there")
        return np.asarray(pin + np.array([0.0, 0.0, -1.0]))

    @staticmethod
    def _is_on(vector: Floats, line: Floats) -> bool:
        """Whether a vector lies on a line, to rounding."""
        along = line / np.linalg.norm(line)
        return bool(np.linalg.norm(vector - (vector @ along) * along) <= _NEAR * np.linalg.norm(line))

    def _ends(self, part: _Part) -> list[Floats]:
        """The ends of the axes of capsules and cylinders of a rigid body; the centres of other geoms."""
        model, kinds, found = self.model, self.mujoco.mjtGeom, []
        for body in (part.body, *part.fixed):
            origin, turned = (np.zeros(3), np.eye(3)) if body == part.body else self._frame(body, part.body)
            for geom in np.flatnonzero(model.geom_bodyid == body):
                is_long = model.geom_type[geom] in (int(kinds.mjGEOM_CAPSULE), int(kinds.mjGEOM_CYLINDER))
                half = self._matrix(model.geom_quat[geom])[:, 2] * (model.geom_size[geom][1] if is_long else 0.0)
                found += [origin + turned @ (model.geom_pos[geom] + way * half) for way in (1, -1)]
        return found

    def _link(
        self, part: _Part, joints: list[int], along: Floats, centre: Floats, hung: float, is_plane: bool, above: _Link | None
    ) -> _Link:
        model, name, mass = self.model, part.name, part.mass
        length = float(np.linalg.norm(along))
        axis = along / (length or 1.0)
        if not self._is_on(centre, along) and mass > self.least:
            if is_plane:
                return self._bent(part, along, centre, hung, axis, above)
            what = "the centre of gravity of {} is not on the line between its pins, and it does not move in one plane"
            self.findings.obstacle(self._place("body", part.body), what.format(name), "move its pins or its centre of gravity")
        centroid = float(centre @ axis)
        turned = self._matrix(self.at.xquat[part.body]) @ axis
        way, hinge = self._way(part, joints, turned, is_plane)
        across, axial = self._moments(part, axis, hinge)
        is_ball = abs(axial - self.least) < _NEAR * self.least  # what to_mjcf and to_urdf add about all axes
        mass = mass if mass > self.least else 0.0
        rotor = float(model.dof_armature[model.jnt_dofadr[joints[0]]]) if is_plane and above is None else 0.0
        radius = radius_of_gyration(across + rotor, mass, self.least if is_ball else 0.0)
        if self.turn is None or way == "ball" or not mass or is_ball or axial <= max(self.least, _NEAR * across):
            axial = 0.0  # of no effect
        pin_has, inverted = self._held(part._replace(joints=joints)), False
        if any(pin_has) and len(joints) > 1 and (way == "ball" or abs(np.dot(*self.at.xaxis[joints])) > _NEAR):
            what = f"springs and dashpots at the pin of {name} need one hinge, two at right angles or a ball joint"
            word = "stiffness" if pin_has[0] else "damping"
            self.findings.obstacle(self._place("body", part.body), what, "remove them", word)
        if pin_has[0]:
            stands = self._stands(turned, above, joints[0])
            pin_has, inverted = (pin_has, stands) if stands is not None else ((0.0, pin_has[1]), False)
        return _Link(self._plain("body", part.body), mass, length, centroid, radius, axial, way, turned, *pin_has, inverted)

    def _bent(
        self, part: _Part, along: Floats, centre: Floats, hung: float, axis: Floats, above: _Link | None
    ) -> _Link:
        """The straight link with the same small motion in a plane as one whose centre of gravity is beside its pins.

        At rest the first moment of the link, with all that hangs from it at its lower pin, points down. Distances of the
        straight link are the heights in that position, and the horizontal distance of the lower pin adds inertia.
        """
        mass = part.mass
        down = mass * centre + hung * along
        down = down / (np.linalg.norm(down) or 1.0)
        length, centroid = float(along @ down), float(centre @ down)
        beside = float(np.linalg.norm(along - length * down))
        hinge = np.asarray(self.model.jnt_axis[part.joints[0]])
        own = float(hinge @ part.inertia @ hinge) - part.ball
        rotor = float(self.model.dof_armature[self.model.jnt_dofadr[part.joints[0]]]) if above is None else 0.0
        swing = own + rotor + mass * float(centre @ centre - centroid**2) + hung * beside**2
        stiffness, damping = self._held(part)
        apart = float(np.linalg.norm(centre - (centre @ axis) * axis))
        if stiffness:
            what = f"{part.name} has a spring, and its centre of gravity is {apart:.3g} m beside the line of its pins"
            self.findings.obstacle(self._place("body", part.body), what, "move it there, or remove the spring", "stiffness")
            stiffness = 0.0
        if length <= 0:
            what = f"{part.name} hangs with its lower pin above its upper one"
            self.findings.obstacle(self._place("body", part.body), what, "a chain needs it below")
            length = 1.0
        what = f"the centre of gravity of {part.name} is {apart:.3g} m beside the line of its pins: read as the straight link of the same small motion"
        self.findings.remark(self._place("body", part.body), what)
        turned = self._matrix(self.at.xquat[part.body]) @ down
        radius = math.sqrt(max(swing, 0.0) / mass)
        return _Link(
            self._plain("body", part.body), mass, length, centroid, radius, 0.0, "one hinge", turned, stiffness, damping, False
        )

    def _stands(self, axis: Floats, above: _Link | None, joint: int) -> bool | None:
        """Whether a link stands if the springs at its pin are relaxed in this direction; None if it is not straight."""
        over, what = (-self.up, "the vertical") if above is None else (above.axis, "the link above")
        cosine, sine = float(axis @ over), float(np.linalg.norm(np.cross(axis, over)))
        if sine > _NEAR:
            angle = math.degrees(math.atan2(sine, cosine))
            self._obstacle(
                "joint", joint, f"has a spring that is relaxed {angle:.6g} degrees from {what}",
                "set springref to where the chain is straight", "stiffness",
            )  # fmt: skip
            return None
        return (above is not None and above.inverted) != (cosine < 0)

    def _way(self, part: _Part, joints: list[int], axis: Floats, is_plane: bool) -> tuple[str, Floats | None]:
        """How a link with this axis in space turns about its pin, and the direction of its hinge if it has only one."""
        hinges = [j for j in joints if self.model.jnt_type[j] == self.hinge]
        if any(self.model.jnt_type[j] not in (self.hinge, self.ball) for j in joints):
            return "none", None
        if is_plane:
            return "one hinge", self.at.xaxis[hinges[0]]
        if len(hinges) < len(joints) or len(hinges) > 2:
            return "ball", None
        axes = self.at.xaxis[hinges]
        if len(hinges) == 1:
            return "one hinge", axes[0]
        elif np.abs(axes @ axis).max() > _NEAR or np.linalg.norm(np.cross(*axes)) < _NEAR:
            what = f"the hinges of {part.name} are not across the link, at its upper pin"
            self.findings.obstacle(self._place("body", part.body), what, "change their axes")
        return "two hinges", None

    def _moments(self, part: _Part, axis: Floats, hinge: Floats | None) -> tuple[float, float]:
        """Moments of inertia about the centre of gravity, across the link and along it."""
        if hinge is None:
            across = np.cross(axis, np.eye(3)[np.abs(axis).argmin()])
            across /= np.linalg.norm(across)
        else:
            across = self._matrix(self.at.xquat[part.body]).T @ hinge
        base = np.stack([across, np.cross(axis, across), axis])
        about = base @ part.inertia @ base.T
        uneven = np.abs(about - np.diag(about[[0, 0, 2], [0, 0, 2]])).max()
        if hinge is None and uneven > _NEAR * np.abs(about).max() + self.least:
            what = f"is not alike all round its axis: its moments of inertia are {np.linalg.eigvalsh(part.inertia)}"
            self._obstacle("body", part.body, what, "make two of them equal, or give all links one hinge")
        return float(about[0, 0]), float(about[2, 2])


def _chain(links: list[_Link], ratio: Floats, unnamed: set[str]) -> Chain:
    """The chain of links from the free end up; `ratio` are their radii of gyration with more digits, or empty."""
    names = [link.name for link in links]
    numbered = not all(names) or {*names} & unnamed or names == [f"link_{k}" for k in range(len(names))]
    columns = {name: [getattr(link, name) for link in links] for name in _COLUMNS}
    chain = Chain(names=None if numbered else names, **columns)  # type: ignore[arg-type]
    if ratio.size == 2 * len(links):
        more = dict(zip(("gyration_ratio", "gyration_ratio_low"), ratio.reshape(2, -1).tolist(), strict=True))
        with suppress(ValueError):  # numbers of another chain
            exact = Chain.from_dict(chain.to_dict() | more)
            return exact if np.array_equal(exact.radius_of_gyration, chain.radius_of_gyration) else chain
    return chain
