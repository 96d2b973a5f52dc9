# SPDX-License-Identifier: GPL-3.0-or-later
"""A model that MuJoCo has compiled: its names and forces, and the obstacles that are not of its geometry."""

from __future__ import annotations

import math
from typing import Any, NoReturn

import numpy as np

from ..systems.numbers import Floats
from .findings import Findings
from .text import Text

_NUMBERS = {
    "body": ("pos", "quat", "mass", "inertia", "ipos", "iquat"),
    "jnt": ("pos", "axis", "stiffness"),
    "dof": ("damping",),
    "geom": ("pos", "quat", "size"),
    "site": ("pos",),
}
_MOST = 1e75  # of a number, so that the product of four is finite
_OF_TENDONS = ("stiffness", "damping", "frictionloss", "limited", "armature", "actfrclimited")  # those that act
_ACTING = ("actuator", "tendon", "equality", "body")  # elements that may act on bodies outside of the chain alone
_OF_ACTUATORS = ("biastype", "damping", "dampingpoly", "armature")  # those that act without a signal


class Compiled:
    """A model in its pose at rest with relaxed springs."""

    def __init__(self, mujoco: Any, model: Any, text: Text, findings: Findings) -> None:
        self.mujoco, self.model, self.text, self.findings, self.least = mujoco, model, text, findings, text.least
        kinds = mujoco.mjtJoint
        self.hinge, self.slide, self.ball = int(kinds.mjJNT_HINGE), int(kinds.mjJNT_SLIDE), int(kinds.mjJNT_BALL)
        self.outside: set[int] = set()  # bodies that do not belong to the chain that the caller names
        self._refuse_wild()
        self.at = mujoco.MjData(model)
        for joint in range(model.njnt):
            here = int(model.jnt_qposadr[joint])
            its = slice(here, here + 4 if model.jnt_type[joint] == self.ball else here + 1)
            if self._stiffness(joint):
                self.at.qpos[its] = model.qpos_spring[its]
        mujoco.mj_kinematics(model, self.at)
        self.gravity = float(np.linalg.norm(model.opt.gravity)) if self._acts("gravity") else 0.0
        self.up = -model.opt.gravity / self.gravity if self.gravity else np.array([0.0, 0.0, 1.0])

    def _numeric(self, name: str) -> Floats:
        """The custom numbers of the file with a name; empty where there are none."""
        model = self.model
        known = [model.numeric(k).name for k in range(model.nnumeric)]
        return np.array(model.numeric(name).data if name in known else [])

    def _acts(self, *what: str) -> bool:
        """Return whether none of these kinds of forces is disabled in the file."""
        flags = [getattr(self.mujoco.mjtDisableBit, f"mjDSBL_{each.upper()}", None) for each in what]
        return not any(self.model.opt.disableflags & int(flag) for flag in flags if flag is not None)

    def _stiffness(self, joint: int) -> float:
        """The stiffness of a joint, or 0 where springs are disabled."""
        return float(np.ravel(self.model.jnt_stiffness[joint])[0]) * self._acts("passive", "spring")

    def _damping(self, joint: int) -> float:
        """The damping of a joint, or 0 where dashpots are disabled."""
        return float(np.ravel(self.model.dof_damping[self.model.jnt_dofadr[joint]])[0]) * self._acts("passive", "damper")

    def _armature(self, joint: int) -> float:
        """The inertia of a rotor at a joint."""
        return float(self.model.dof_armature[self.model.jnt_dofadr[joint]])

    def _matrix(self, quaternion: Floats) -> Floats:
        flat = np.empty(9)
        self.mujoco.mju_quat2Mat(flat, quaternion)
        return flat.reshape(3, 3)

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
        """Refuse a number of an element."""
        place = self._place(kind, number) if kind else ("", 0)
        self.findings.obstacle(place, f"{name}{field} must be finite and at most {_MOST:g}, got {value}", "change it")
        self.findings.stop()

    def _obstacle(self, kind: str, number: int, what: str, instead: str, word: str = "") -> None:
        """Note an obstacle of a body, joint or other element."""
        place, name = self._place(kind, number), self._name(kind, number)
        acts_on = self._acts_on(kind, number) if self.outside and kind in _ACTING else set()
        if acts_on and acts_on <= self.outside:
            if kind != "body":  # bodies themselves are listed
                self.findings.leave_out(place, f"{name} acts on no body among links")
        else:
            self.findings.obstacle(place, f"{name} {what}", instead, word)

    def _remark(self, kind: str, number: int, what: str) -> None:
        """Note what was changed or has no effect."""
        self.findings.remark(self._place(kind, number), f"{self._name(kind, number)} {what}")

    def _name(self, kind: str, number: int) -> str:
        """The name of a body or joint as messages have it."""
        if kind in ("geom", "site"):
            return f"{kind} {getattr(self.model, kind)(number).name!r}"
        if kind == "actuator":
            return self._name_of_actuator(number)
        return self.text.name_of(kind, self._plain(kind, number)) if kind != "body" or number else "the ground"

    def _name_of_actuator(self, number: int) -> str:
        """The name of an actuator, if it has one, and what it drives."""
        plain, (what, at) = self._plain("actuator", number), self._driven(number)[0]
        name = "the actuator" if plain in self.text.unnamed or not plain else f"actuator {plain!r}"
        return f"{name} of {self._name(what, at)}"

    # ---- the bodies on which elements act

    def _driven(self, number: int) -> list[tuple[str, int]]:
        """The joint, tendon, body or sites that an actuator drives, each with its kind."""
        model, kinds = self.model, self.mujoco.mjtTrn
        kind = {
            int(kinds.mjTRN_JOINT): "jnt",
            int(kinds.mjTRN_JOINTINPARENT): "jnt",
            int(kinds.mjTRN_TENDON): "tendon",
            int(kinds.mjTRN_BODY): "body",
        }.get(int(model.actuator_trntype[number]), "site")
        ids = [int(k) for k in model.actuator_trnid[number] if k >= 0]
        return [("joint" if kind == "jnt" else kind, k) for k in (ids if kind == "site" else ids[:1])]

    def _bodies_of(self, what: str, number: int) -> set[int]:
        """The bodies of a joint, tendon, body, site or geom."""
        model, kinds = self.model, self.mujoco.mjtWrap
        if what == "body":
            return {number}
        if what != "tendon":
            return {int(getattr(model, f"{'jnt' if what == 'joint' else what}_bodyid")[number])}
        of = {int(kinds.mjWRAP_JOINT): "joint", int(kinds.mjWRAP_SITE): "site"}
        of |= {int(kinds.mjWRAP_SPHERE): "geom", int(kinds.mjWRAP_CYLINDER): "geom"}
        first = int(model.tendon_adr[number])
        along = range(first, first + int(model.tendon_num[number]))
        met = [(of[int(model.wrap_type[k])], int(model.wrap_objid[k])) for k in along if int(model.wrap_type[k]) in of]
        return {body for each in met for body in self._bodies_of(*each)}

    def _acts_on(self, kind: str, number: int) -> set[int]:
        """The moving bodies on which a tendon, actuator, constraint or force against gravity acts."""
        model = self.model
        if kind == "actuator":
            met = self._driven(number)
        elif kind == "equality":
            ends = [int(k) for k in (model.eq_obj1id[number], model.eq_obj2id[number]) if k >= 0]
            kinds, is_site = self.mujoco.mjtEq, int(model.eq_objtype[number]) == int(self.mujoco.mjtObj.mjOBJ_SITE)
            of = {int(kinds.mjEQ_JOINT): "joint", int(kinds.mjEQ_TENDON): "tendon"}
            of |= dict.fromkeys((int(kinds.mjEQ_CONNECT), int(kinds.mjEQ_WELD)), "site" if is_site else "body")
            met = [(of[int(model.eq_type[number])], end) for end in ends if int(model.eq_type[number]) in of]
        else:
            met = [(kind, number)]
        return {body for each in met for body in self._bodies_of(*each) if model.body_weldid[body]}

    def _place(self, kind: str, number: int) -> tuple[str, int]:
        """File and line of an element."""
        return self.text.place_of(kind, self._plain(kind, number))

    def _plain(self, kind: str, number: int) -> str:
        """The name of an element in the compiled model."""
        return str(getattr(self.model, {"equality": "eq"}.get(kind, kind))(number).name)

    def _look_at_the_whole(self) -> None:
        """Note what is not of one joint: constraints, tendons, actuators, fluids, gravity."""
        model, note, no_chain = self.model, self.findings.obstacle, "which a chain does not have"
        for k in range(model.neq):
            if self._acts("constraint", "equality") and model.eq_active0[k]:
                self._obstacle("equality", k, f"is a constraint, {no_chain}", "take it away", "equality")
        for k in range(model.ntendon):
            if self._any("tendon", _OF_TENDONS, k):
                self._obstacle("tendon", k, f"pulls at the links, {no_chain}", "take it away", "tendon")
        if model.nflex:
            note(("", 0), f"the model has flexes, {no_chain}", "take them away")
        if model.nplugin:
            note(("", 0), "the model has plugins, whose forces are not read", "take them away", "plugin")
        for body in range(model.nbody):
            if model.body_gravcomp[body]:
                self._obstacle("body", body, "is held against gravity (gravcomp)", "set gravcomp to 0", "gravcomp")
        if model.opt.density or model.opt.viscosity:
            what = "the model is in a fluid, whose forces are not read"
            note(self.text.option("density"), what, "set density and viscosity of option to 0", "fluid")
        if not self.gravity:
            note(self.text.option("gravity"), "gravity is 0, so that nothing makes the links hang", "set gravity of option")
        for k in range(model.nu if self._acts("actuation") else 0):
            self._look_at_actuator(k)

    def _any(self, kind: str, fields: tuple[str, ...], number: int) -> bool:
        """Return whether one of these fields of an element is not 0; some are not in all versions of MuJoCo."""
        values = [getattr(self.model, f"{kind}_{field}", None) for field in fields]
        return any(np.any(each[number]) for each in values if each is not None)

    def _look_at_actuator(self, k: int) -> None:
        """Note an actuator that acts without a signal; the others exert no force."""
        low, high = self.model.actuator_ctrlrange[k]
        if self._any("actuator", _OF_ACTUATORS, k):
            self._obstacle("actuator", k, "acts without a signal, and a chain has no motors", "take it away", "actuator")
        elif self.model.actuator_ctrllimited[k] and not low <= 0 <= high:
            what = "acts without a signal, as its ctrlrange does not contain 0"
            self._obstacle("actuator", k, what, "take it away", "actuator")
        else:
            self._remark("actuator", k, "exerts no force without a signal: left out")

    def _look_at_joint(self, joint: int) -> None:
        """Note dry friction, limits, dashpots and springs of a joint that are not read; a rail may have ends."""
        model, dof, is_slide = self.model, int(self.model.jnt_dofadr[joint]), self.model.jnt_type[joint] == self.slide
        degrees = {self.hinge: 1, self.slide: 1, self.ball: 3}.get(int(model.jnt_type[joint]), 6)
        numbers: dict[str, Any] = {"jnt": joint, "dof": slice(dof, dof + degrees)}
        damping, stiffness = self._damping(joint), self._stiffness(joint)
        if damping and "damping" in self.findings.ignore:
            self.findings.leave_out(self._place("joint", joint), f"{self._name('joint', joint)} has damping {damping:g}")
        for field, word, kind in (
            ("jnt_stiffnesspoly", "stiffness", "spring"),
            ("dof_dampingpoly", "damping", "damper"),
            ("dof_frictionloss", "friction", "frictionloss"),
        ):
            here = np.max(np.abs(getattr(model, field, np.zeros(model.nv))[numbers[field[:3]]]), initial=0.0)
            if here and self._acts("constraint" if word == "friction" else "passive", kind):
                self._obstacle("joint", joint, f"has {field.partition('_')[2]} {here:g}", "set it to 0", word)
        for word, value in (("damping", damping), ("stiffness", stiffness)):
            if value < 0:
                self._obstacle("joint", joint, f"has a negative {word}, {value:g}", "give 0 or more", word)
        if not model.jnt_limited[joint] or not self._acts("constraint", "limit"):
            return
        low, high = model.jnt_range[joint] if is_slide else map(math.degrees, model.jnt_range[joint])
        has = f"has a range, {low:g} to {high:g} {'m' if is_slide else 'degrees'}"
        if is_slide and low < model.qpos0[model.jnt_qposadr[joint]] < high:
            self._remark("joint", joint, f"{has}: the ends of the rail are left out")
        else:
            self._obstacle("joint", joint, has, "take it away", "range")
