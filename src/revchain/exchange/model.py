# SPDX-License-Identifier: GPL-3.0-or-later
"""A compiled model read as links hung one from another."""

from __future__ import annotations

import math
import re
from contextlib import suppress
from typing import Any, NamedTuple

import numpy as np

from ..systems.chain import Chain
from ..systems.numbers import Floats, without_function
from ..systems.rig import Flywheel, Pin, Rig, Support
from .compiled import Compiled
from .mechanism import radius_of_gyration
from .write import RATIO

_NEAR = 1e-9  # parts of a length, an axis or a moment by which a model may differ from a straight link
_ROUNDED = 1e-3  # of the direction of an axis, where angles of the file are rounded: second order in all speeds
_UPRIGHT = 0.7  # cosine of the angle from upright below which a link points up
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
    """A rigid body: a body with joints, and bodies fixed to it. Vectors and the inertia are in the frame of the first.

    `ball` is the moment of inertia about all axes that was added to the inertia for MuJoCo.
    """

    body: int
    name: str
    joints: list[int]
    pin: Floats
    fixed: list[int]
    mass: float
    centre: Floats
    inertia: Floats
    ball: float = 0.0


class Model(Compiled):
    """A compiled model, read as a chain or rig. Masses, and moments along links, up to `least` count as 0."""

    turn: int | None = None  # the joint of the turntable
    wanted: tuple[int, ...] = ()  # the bodies that the caller names

    def choose(self, links: tuple[str, ...]) -> None:
        """Take the chain of these bodies; a ValueError lists all bodies if one is unknown."""
        known = {self._plain("body", b): b for b in range(1, self.model.nbody)}
        for name in links:
            if name not in known:
                names = ", ".join(repr(each) for each in known if each not in self.text.unnamed)
                raise ValueError(f"{self.findings.function}: links must be names of bodies, {names}; got {name!r}")
        self.wanted = tuple(known[name] for name in links)

    def system(self) -> Chain | Rig:
        """The chain, and the support if it is not a firm point on the axis; one error with all obstacles."""
        parts = self._parts()
        sliding = 0
        while sliding < len(parts) and all(self.model.jnt_type[j] == self.slide for j in parts[sliding].joints):
            sliding += 1
        carriages, parts = parts[:sliding], parts[sliding:]
        if not parts:
            self.findings.obstacle(("", 0), "no link hangs from the support", "add a body on a hinge below it")
            self.findings.stop()
        is_plane = self._moves_in_a_plane(parts)
        given = self._carriage(carriages, self.at.xaxis[parts[0].joints[0]] if is_plane else None)
        links = self._links(self._without_wheel(parts) if is_plane else parts, is_plane)
        if self.turn is not None:
            given["radius"] = self._arm(self.turn, parts[0].joints, is_plane, any(link.axial for link in links))
        system = self._made(links[::-1], given) if all(self.findings.words) else None
        if system is None or self.findings.obstacles:
            self.findings.stop()
        return system

    def _made(self, links: list[_Link], given: dict[str, Any]) -> Chain | Rig | None:
        """The system of links from the free end up; None, and an obstacle, if there is no such system."""
        try:
            return self._system(links, given)
        except ValueError as error:
            sentence = without_function(error)
        found = re.match(r"links\[(\d+)\](: )?", sentence)
        name = links[int(found[1])].name if found else ""
        if found:
            sentence = self.text.name_of("body", name) + (found[2] or "") + sentence[found.end() :]
        self.findings.obstacle(self.text.place_of("body", name), sentence, "change the model")
        return None

    def _system(self, links: list[_Link], given: dict[str, Any]) -> Chain | Rig:
        """The system of links from the free end up."""
        axial = np.array([link.axial for link in links])
        chain, support = _chain(links, self._numeric(RATIO), self.text.unnamed), Support(**given)
        pins = Pin(stiffness=[link.stiffness for link in links], damping=[link.damping for link in links])
        if support == Support() and pins == Pin() and not axial.any():
            return chain
        wheels = Flywheel(axial_moment=axial) if axial.any() else None
        inverted = [link.inverted for link in links]
        return Rig(chain, support=support, flywheels=wheels, pins=pins, inverted=inverted)

    # ---- bodies

    def _parts(self) -> list[_Part]:
        """The rigid bodies from the support down, without the turntable."""
        self.children: list[list[int]] = [[] for _ in range(self.model.nbody)]
        self.depth = [int(count > 0) for count in self.model.body_jntnum]  # moving bodies of the longest line from here down
        for body in range(self.model.nbody - 1, 0, -1):
            above = int(self.model.body_parentid[body])
            self.children[above].insert(0, body)
            own = int(self.model.body_jntnum[above] > 0)
            self.depth[above] = max(self.depth[above], own + self.depth[body])
        bodies = self._path()
        self._look_at_the_whole()
        for joint in (j for b in bodies for j in self._joints(b)):
            self._look_at_joint(joint)
        if not bodies:
            self.findings.obstacle(("", 0), "the model has no joints", "add a hinge above each link")
            self.findings.stop()
        first = self._joints(bodies[0])[0]
        if self.model.jnt_type[first] == self.hinge and abs(self.at.xaxis[first] @ self.up) > 1 - 1e-12:
            self.turn = first  # it turns all that hangs about the vertical
        parts = [self._part(b, after) for b, after in zip(bodies, [*bodies[1:], None], strict=True)]
        return parts if parts[0].joints else parts[1:]

    def _joints(self, body: int) -> list[int]:
        """The joints of a body, without that of the turntable."""
        first = int(self.model.body_jntadr[body])
        return [j for j in range(first, first + int(self.model.body_jntnum[body])) if j != self.turn]

    def _path(self) -> list[int]:
        """The bodies with joints, from the support down: those that the caller names, or else the longest line."""
        bodies: list[int] = []
        here, rest = 0, set(self.wanted)
        while below := [b for b in self.children[here] if self.depth[b]]:
            chosen = [b for b in below if rest & self._below(b)] if self.wanted else below
            if self.wanted and len(chosen) < 2:
                self._leave_out([b for b in below if b not in chosen])
            if not chosen:
                break
            here = chosen[0] if len(chosen) == 1 else self._fork(bodies, here, chosen)
            rest.discard(here)
            if self._joints(here):
                bodies.append(here)
        return bodies

    def _below(self, body: int) -> set[int]:
        """A body and all that hangs from it."""
        found = [body]
        for each in found:
            found += self.children[each]
        return set(found)

    def _fork(self, above: list[int], here: int, below: list[int]) -> int:
        """Note that more than one body hangs from another, and which names to give; return the body to follow."""
        followed = max(below, key=self.depth.__getitem__)
        line = [*above, followed]
        while lower := [b for b in self.children[line[-1]] if self.depth[b]]:
            line.append(max(lower, key=self.depth.__getitem__))
        names = [self._plain("body", b) for b in line if self._joints(b)]
        named = [name for name in names if name and name not in self.text.unnamed]
        words = (", " if " " in "".join(named) else " ").join(named)
        links = f'links="{words}"' if named else ""
        instead = f"name the links of one chain, such as {links}" if links else "name the bodies, and give links"
        *first, last = [self._name("body", b) for b in below]
        these = f"{', '.join(first)} and {last} {'both' if len(first) == 1 else 'all'}"
        what = f"{these} hang from {self._name('body', here)}; only a serial chain can be read"
        self.findings.obstacle(self._place("body", next(b for b in below if b != followed)), what, instead, links=links)
        return followed

    def _leave_out(self, bodies: list[int]) -> None:
        """Note bodies that do not belong to the chain that the caller names."""
        for body in bodies:
            self.outside |= self._below(body)
            heavy = f"{self.model.body_subtreemass[body]:g} kg with what hangs from it"
            self.findings.leave_out(self._place("body", body), f"{self._name('body', body)}, {heavy}, is not among links")

    def _part(self, body: int, after: int | None) -> _Part:
        """A body with joints and the bodies fixed to it."""
        model, name, joints = self.model, self._name("body", body), self._joints(body)
        fixed, todo = list[int](), list(self.children[body])
        while todo:
            each = todo.pop(0)
            if not self._joints(each) and each != after:
                fixed.append(each)
                todo += self.children[each]
        pin = np.array(model.jnt_pos[joints[0]]) if joints else np.zeros(3)
        if any(np.any(model.jnt_pos[j] != pin) for j in joints):
            what = f"the joints of {name} are at different places; a link has one upper pin"
            self.findings.obstacle(self._place("body", body), what, "give all the same pos")
        heavy = [b for b in (body, *fixed) if model.body_mass[b] > self.least]
        if heavy in ([], [body]):
            inertia, ball = self._inertia(body)
            mass, centre = float(model.body_mass[body]), np.array(model.body_ipos[body])
            return _Part(body, name, joints, pin, fixed, mass, centre, inertia, ball)
        members = []
        for b in heavy:
            (origin, turned), (inertia, ball) = self._frame(b, body), self._inertia(b)
            inertia = turned @ (inertia - ball * np.eye(3)) @ turned.T
            members.append((float(model.body_mass[b]), origin + turned @ model.body_ipos[b], inertia))
        return _Part(body, name, joints, pin, fixed, *_together(members))

    def _frame(self, body: int, of: int) -> tuple[Floats, Floats]:
        """Origin and axes of a body in the frame of another to which it is fixed."""
        base = self._matrix(self.at.xquat[of])
        return base.T @ (self.at.xpos[body] - self.at.xpos[of]), base.T @ self._matrix(self.at.xquat[body])

    def _inertia(self, body: int) -> tuple[Floats, float]:
        """Moments of inertia about the centre of gravity in the frame of a body, and what was added to them for MuJoCo."""
        frame, given = self._matrix(self.model.body_iquat[body]), self.text.inertia.get(self._plain("body", body))
        values = self.model.body_inertia[body]
        about = frame @ (np.diag(values) if given is None else given) @ frame.T
        is_ball = given is None and np.abs(values - self.least).min() < _NEAR * self.least
        return about, self.least if is_ball else 0.0

    # ---- the support

    def _carriage(self, carriages: list[_Part], hinge: Floats | None) -> dict[str, Any]:
        """The arguments of a `Support` for bodies that slide above all links, which turn about `hinge` in a plane model."""
        model, joints, mass = self.model, list[int](), 0.0
        for part in carriages:
            across = [j for j in part.joints if hinge is not None and abs(self.at.xaxis[j] @ hinge) > 1 - _ROUNDED]
            for j in across:
                self._remark("joint", j, "slides across the plane in which the links move: left out")
            along = [j for j in part.joints if j not in across]
            if along and mass:
                what = "slides on a body that slides and has mass, and the mass of a support is the same in all directions"
                self._obstacle("body", part.body, what, "fix one of the two")
            joints += along
            mass += part.mass if joints and part.mass > self.least else 0.0
        if not joints:
            return {}
        part, axes = carriages[-1]._replace(joints=joints), self.at.xaxis[joints]
        is_level = np.abs(axes @ self.up).max() < (_NEAR if len(joints) == 2 else _ROUNDED)
        is_right = abs(axes[0] @ axes[1]) < _NEAR if len(joints) == 2 else len(joints) == 1 and self.turn is None
        if not (is_level and is_right):
            what = "slides, but not on two level joints at right angles, nor on one in a plane model without a turntable"
            self._obstacle("body", part.body, what, "give it such slides, or a firm support")
        elif len(joints) == 1 and (hinge is None or abs(axes[0] @ hinge) > _ROUNDED):
            what = "is the only slide, but the links do not move in its plane alone"
            self._obstacle("joint", joints[0], what, "give the carriage a second slide across it")
        stiffness, damping = self._held(part)
        for j in joints:
            if stiffness and model.qpos_spring[model.jnt_qposadr[j]] != model.qpos0[model.jnt_qposadr[j]]:
                self._obstacle(
                    "joint", j, "has a spring that is not at rest (springref)", "set springref to 0", "stiffness"
                )
                stiffness = 0.0
        rotors = [self._armature(j) for j in joints]
        if min(rotors) != max(rotors):
            self._obstacle("body", part.body, "has slides of different armature", "give both the same", "armature")
        mass += min(rotors)
        return {"stiffness": stiffness or (None if mass else 0.0), "damping": damping, "mass": mass}

    def _arm(self, turn: int, joints: list[int], is_plane: bool, is_driven: bool) -> float:
        """The radius of the turntable, which keeps its speed in a `Rig` whatever its moment of inertia is."""
        apart = self.at.xanchor[joints[0]] - self.at.xanchor[turn]
        arm = apart - (apart @ self.up) * self.up
        radius = float(np.linalg.norm(arm))
        if is_plane and abs(arm @ self.at.xaxis[joints[0]]) > _ROUNDED * radius:
            what = "swings its link across the arm of the turntable, and in a Rig links move in the plane of the arm"
            self._obstacle("joint", joints[0], what, "turn its axis by 90 degrees")
        hung = float(self.model.body_subtreemass[0]) * (radius + float(np.ptp(self.at.xipos, axis=0).max())) ** 2
        if radius and self.model.body_inertia[self.model.jnt_bodyid[turn]].max() < 1e3 * hung:
            self._remark("joint", turn, "is read as a support that keeps its speed, whatever its moment of inertia")
        if is_driven:
            self._remark("joint", turn, "turns the links about their own axes: speeds are those of whirl, not of swing")
        return radius

    def _held(self, part: _Part) -> tuple[float, float]:
        """Stiffness and damping of a pin or carriage, which are those of all its joints."""
        found = []
        for what, of in (("stiffness", self._stiffness), ("damping", self._damping)):
            each = [0.0 if what == "damping" in self.findings.ignore else of(j) for j in part.joints]
            if other := [value for value in each if value != each[0]]:
                both = f"the joints of {part.name} have {what} {each[0]:g} and {other[0]:g}"
                self.findings.obstacle(self._place("body", part.body), both, "give both the same", what)
            found.append(0.0 if other else max(each[0], 0.0))
        return found[0], found[1]

    # ---- the links

    def _moves_in_a_plane(self, parts: list[_Part]) -> bool:
        """Return whether all joints are parallel hinges."""
        every = [j for part in parts for j in part.joints]
        if len(every) > len(parts) or any(self.model.jnt_type[j] != self.hinge for j in every):
            return False
        axes = self.at.xaxis[every]
        tilt = abs(float(axes[0] @ self.up))
        if np.linalg.norm(np.cross(axes, axes[0]), axis=1).max() > _ROUNDED:
            return False
        if tilt > 1 - 1e-6:
            what = "turns about the vertical: gravity does not swing its link back"
            where = "; URDF has no gravity, and that of MuJoCo points to -z" if self.text.is_urdf else ""
            self._obstacle("joint", every[0], what, f"a chain hangs from level hinges{where}")
        elif tilt > _NEAR and self.turn is None:
            self.gravity *= math.sqrt(1 - tilt**2)
            what = f"is inclined by {math.degrees(math.asin(tilt)):.3g} degrees: gravity in the plane of motion is"
            self._remark("joint", every[0], f"{what} {self.gravity:.9g} m/s^2")
        return tilt < _NEAR or self.turn is None or tilt > 1 - 1e-6

    def _without_wheel(self, parts: list[_Part]) -> list[_Part]:
        """The bodies of a plane chain; a last one that turns about its centre of gravity becomes a point mass."""
        *rest, last = parts
        reach = float(np.linalg.norm(self._seen(last, last.centre - last.pin, True)))
        if not rest or last.mass <= self.least or reach > _NEAR * np.linalg.norm(self._in_parent(rest[-1], last)):
            return parts
        if any(self._held(last)):
            what = "turns about its centre of gravity on a spring or dashpot, and a chain has no such wheel"
            self._obstacle("body", last.body, what, "take them away", "stiffness" if self._held(last)[0] else "damping")
        what = "turns freely about its centre of gravity: read as a point mass at its pin, as its turning is no mode"
        self._remark("body", last.body, what)
        one = rest[-1]
        members = [(last.mass, self._in_parent(one, last), np.zeros((3, 3)))]
        if one.mass > self.least:
            members.append((one.mass, one.centre, one.inertia - one.ball * np.eye(3)))
        mass, centre, inertia = _together(members)
        return [*rest[:-1], one._replace(mass=mass, centre=centre, inertia=inertia, ball=0.0)]

    def _links(self, parts: list[_Part], is_plane: bool) -> list[_Link]:
        """The links that the bodies are, from the support down; a body without mass and length is part of a joint."""
        for k, part in enumerate(parts):
            for j in part.joints:
                if self.model.jnt_type[j] not in (self.hinge, self.ball):
                    kind = "slides" if self.model.jnt_type[j] == self.slide else "moves freely"
                    instead = "a chain slides only above its links: fix it at the length that it has"
                    self._obstacle("joint", j, f"is neither a hinge nor a ball joint: it {kind}", instead)
                if self._armature(j) and not (k == 0 and is_plane):
                    self._obstacle("joint", j, f"has armature {self._armature(j):g}", "set it to 0", "armature")
        links: list[_Link] = []
        joints: list[int] = []
        up: list[int] = []  # bodies whose links point up in the file, and do not stand on a spring
        size = np.abs(self.model.body_pos).max(initial=0.0)
        for k, (part, after) in enumerate(zip(parts, [*parts[1:], None], strict=True)):
            joints += part.joints
            end = self._free_end(part, is_plane) if after is None else self._in_parent(part, after)
            along = self._seen(part, end - part.pin, is_plane)
            if np.linalg.norm(along) > _NEAR * size or after is None:
                hung = sum(each.mass for each in parts[k + 1 :])
                links.append(self._link(part._replace(joints=joints), along, hung, is_plane, links[-1] if links else None))
                joints = []
                up += [part.body] * (not links[-1].inverted and float(links[-1].axis @ self.up) > _UPRIGHT)
            elif part.mass > self.least:
                self._obstacle("body", part.body, "has mass but no length: the next joint is at its own", "move that joint")
        if up:
            names = ", ".join(self._name("body", body) for body in up)
            what = f"{names} {'point' if len(up) > 1 else 'points'} up in the pose of the file (qpos0): read hanging"
            self.findings.remark(self._place("body", up[0]), what)
        ways = {link.way for link in links} - {"none"}
        if "one hinge" in ways and not is_plane:
            what = "links have one hinge each, but these are not level and parallel"
            what = what if len(ways) == 1 else "some links have one hinge and some have more"
            instead = "give all links level and parallel hinges, or each two hinges or a ball joint"
            place = self._place("body", parts[0].body)
            self.findings.obstacle(place, f"{what}; a chain moves in one plane or in space", instead)
        return links

    def _seen(self, part: _Part, vector: Floats, is_plane: bool) -> Floats:
        """A vector in the frame of a body, or its projection on the plane in which the chain moves."""
        hinge = self.model.jnt_axis[part.joints[0]]
        return np.asarray(vector - (vector @ hinge) * hinge if is_plane else vector)

    def _in_parent(self, part: _Part, after: _Part) -> Floats:
        """The position of the joints of a body in the frame of the body above, joints being at their reference."""
        body, model = after.body, self.model
        there = model.body_pos[body] + self._matrix(model.body_quat[body]) @ model.jnt_pos[after.joints[0]]
        if (parent := int(model.body_parentid[body])) == part.body:
            return np.asarray(there)
        origin, turned = self._frame(parent, part.body)
        return np.asarray(origin + turned @ there)

    def _free_end(self, part: _Part, is_plane: bool) -> Floats:
        """The free end: a body without mass, the only site, the end of the geoms, or else the centre of gravity.

        No speed depends on it. The link hangs with its centre of gravity straight below its pin: the end is there, or at
        the foot of the mark on this line.
        """
        model, body, pin = self.model, part.body, part.pin
        out = self._seen(part, part.centre - pin, is_plane)
        reach = float(np.linalg.norm(out)) if part.mass > self.least else 0.0
        massless = [b for b in part.fixed if model.body_mass[b] <= self.least]
        is_held = any(self._stiffness(j) for j in part.joints)  # a spring may hold it with its centre of gravity above
        for marks in (
            [np.array(model.body_pos[b]) if model.body_parentid[b] == body else self._frame(b, body)[0] for b in massless],
            [np.array(model.site_pos[s]) for s in np.flatnonzero(model.site_bodyid == body)],
        ):
            along = self._seen(part, marks[0] - pin, is_plane) if len(marks) == 1 else np.zeros(3)
            if np.linalg.norm(along) > _NEAR * reach and (not reach or is_held or along @ out > 0):
                return np.asarray(marks[0] if not reach or _is_on(out, along) else pin + (along @ out) / reach**2 * out)
        ends = self._ends(part)
        scale = max([reach, *(float(np.linalg.norm(end - pin)) for end in ends)])
        if reach > _NEAR * scale:
            far = max([float((end - pin) @ out) / reach for end in ends], default=0.0)
            if far > _NEAR * scale:
                return np.asarray(pin + far / reach * out)
            what = f"the free end of {part.name} is not marked: taken at its centre of gravity; no speed depends on it"
            self.findings.remark(self._place("body", body), what)
            return np.asarray(part.centre)
        what = f"the free end of {part.name} is not marked, and its centre of gravity is at its pin"
        self.findings.obstacle(self._place("body", body), what, "put a site there")
        return np.asarray(pin + np.eye(3)[np.abs(model.jnt_axis[part.joints[0]]).argmin()])  # for the obstacles that follow

    def _ends(self, part: _Part) -> list[Floats]:
        """The ends of the axes of capsules and cylinders of a rigid body; the centres of other geoms."""
        model, kinds, found = self.model, self.mujoco.mjtGeom, list[Floats]()
        for body in (part.body, *part.fixed):
            origin, turned = (np.zeros(3), np.eye(3)) if body == part.body else self._frame(body, part.body)
            for geom in np.flatnonzero(model.geom_bodyid == body):
                is_long = model.geom_type[geom] in (int(kinds.mjGEOM_CAPSULE), int(kinds.mjGEOM_CYLINDER))
                half = self._matrix(model.geom_quat[geom])[:, 2] * (model.geom_size[geom][1] if is_long else 0.0)
                found += [origin + turned @ (model.geom_pos[geom] + way * half) for way in (1, -1)]
        return found

    def _link(self, part: _Part, along: Floats, hung: float, is_plane: bool, above: _Link | None) -> _Link:
        """The link of a body with its lower pin at `along` from the upper one, from which a mass is hung."""
        name, joints, place = part.name, part.joints, self._place("body", part.body)
        centre, mass = self._seen(part, part.centre - part.pin, is_plane), part.mass if part.mass > self.least else 0.0
        length = float(np.linalg.norm(along))
        axis, stiffness, damping = along / length, *self._held(part)
        beside = mass and not _is_on(centre, along)
        if beside and is_plane:
            axis = mass * centre + hung * along  # the first moment of the link with all below it points down at rest
            axis /= np.linalg.norm(axis) or 1.0
            length = float(along @ axis)
        apart = np.linalg.norm(np.cross(along, centre)) / np.linalg.norm(along) if beside else 0.0
        if beside and not is_plane:
            what = f"the centre of gravity of {name} is not on the line between its pins, and it does not move in one plane"
            self.findings.obstacle(place, what, "move its pins or its centre of gravity")
        elif beside and stiffness:
            what = f"{name} has a spring, and its centre of gravity is {apart:.3g} m beside the line of its pins"
            self.findings.obstacle(place, what, "move it there, or remove the spring", "stiffness")
            stiffness = 0.0
        elif beside:
            what = f"the centre of gravity of {name} is {apart:.3g} m beside the line of its pins"
            self.findings.remark(place, f"{what}: read as the straight link of the same small motion")
        if length <= 0:
            self.findings.obstacle(place, f"{name} hangs with its lower pin above its upper one", "a chain needs it below")
            length = 1.0
        centroid = float(centre @ axis)
        turned = self._matrix(self.at.xquat[part.body]) @ axis
        way, hinge = self._way(part, turned, is_plane)
        across, axial = self._moments(part, axis, hinge)
        is_ball = abs(axial - self.least) < _NEAR * self.least  # what to_mjcf and to_urdf add about all axes
        across += self._armature(joints[0]) if is_plane and above is None else 0.0
        if beside and is_plane:  # horizontal distances add inertia; in a straight link there are none
            across += mass * float(centre @ centre - centroid**2) + hung * float(along @ along - length**2)
        radius = radius_of_gyration(across, mass, self.least if is_ball else 0.0)
        if self.turn is None or way == "ball" or not mass or is_ball or axial <= max(self.least, _NEAR * across):
            axial = 0.0  # of no effect
        if (stiffness or damping) and len(joints) > 1:
            if way == "ball" or abs(np.dot(*self.at.xaxis[joints])) > _NEAR:
                what = f"springs and dashpots at the pin of {name} need one hinge, two at right angles or a ball joint"
                self.findings.obstacle(place, what, "take them away", "stiffness" if stiffness else "damping")
        inverted = self._stands(turned, above, joints[0]) if stiffness else False
        stiffness = 0.0 if inverted is None else stiffness
        named = self._plain("body", part.body)
        return _Link(named, mass, length, centroid, radius, axial, way, turned, stiffness, damping, bool(inverted))

    def _stands(self, axis: Floats, above: _Link | None, joint: int) -> bool | None:
        """Return whether a link stands if the springs at its pin relax in this direction; None if it is not straight."""
        over, what = (-self.up, "the vertical") if above is None else (above.axis, "the link above")
        cosine, sine = float(axis @ over), float(np.linalg.norm(np.cross(axis, over)))
        if sine > _NEAR:
            has = f"has a spring that is relaxed {math.degrees(math.atan2(sine, cosine)):.6g} degrees from {what}"
            self._obstacle("joint", joint, has, "set springref to where the chain is straight", "stiffness")
            return None
        return (above is not None and above.inverted) != (cosine < 0)

    def _way(self, part: _Part, axis: Floats, is_plane: bool) -> tuple[str, Floats | None]:
        """The way in which a link with this axis turns about its pin, and the direction of its hinge if it has one."""
        kinds, axes = {int(self.model.jnt_type[j]) for j in part.joints}, self.at.xaxis[part.joints]
        if not kinds <= {self.hinge, self.ball}:
            return "none", None
        if is_plane or (kinds == {self.hinge} and len(axes) == 1):
            return "one hinge", axes[0]
        if self.ball in kinds or len(axes) > 2:
            return "ball", None
        if np.abs(axes @ axis).max() > _NEAR or np.linalg.norm(np.cross(*axes)) < _NEAR:
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


def _is_on(vector: Floats, line: Floats) -> bool:
    """Return whether a vector lies on a line, to rounding."""
    along = line / np.linalg.norm(line)
    return bool(np.linalg.norm(vector - (vector @ along) * along) <= _NEAR * np.linalg.norm(line))


def _together(members: list[tuple[float, Floats, Floats]]) -> tuple[float, Floats, Floats]:
    """Mass, centre of gravity and moments of inertia about it of bodies that are fixed to each other."""
    mass = sum(heavy for heavy, _, _ in members)
    centre = sum((heavy * at for heavy, at, _ in members), np.zeros(3)) / mass
    inertia = np.zeros((3, 3))
    for heavy, at, own in members:
        apart = at - centre
        inertia += own + heavy * (apart @ apart * np.eye(3) - np.outer(apart, apart))
    return mass, centre, inertia


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
