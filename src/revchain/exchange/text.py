# SPDX-License-Identifier: GPL-3.0-or-later
"""The text of a model, put right before MuJoCo compiles it: its elements with their lines and names."""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path
from xml.etree.ElementTree import Element, SubElement, TreeBuilder
from xml.parsers import expat
from xml.sax.saxutils import quoteattr

import numpy as np

from ..systems.numbers import Floats
from .findings import Findings
from .write import LEAST, LEAST_OF_URDF

OTHER = {"mujoco": "a model of MuJoCo: use from_mjcf", "robot": "a URDF file: use from_urdf"}
_LOOKS = {"visual", "statistic", "keyframe", "sensor", "contact", "skin", "material", "texture", "light", "camera"}
_LOOKS |= {"tuple", "size"}  # without an effect, too
_READ = {  # attributes that are read; others, of the solver, are not in all versions of MuJoCo
    "option": {"gravity", "density", "viscosity", "wind"},
    "flag": {"constraint", "equality", "frictionloss", "limit", "passive", "spring", "damper", "gravity", "actuation"},
}
_NAMED = {"body", "joint", "freejoint"}  # elements that get a name if they have none, and children of the next
_SECTIONS = {"actuator", "equality", "tendon"}
_COPIED = {"composite", "replicate", "flexcomp", "default"}  # whose elements MuJoCo names, or that are none
_HEAVY = {"geom", "frame", "attach", *_COPIED}  # parts of a body that may have mass
_TENSOR = ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")


class Text:
    """The elements of a file and of those that it includes.

    Attributes
    ----------
    root : Element
        The root, in which unnamed elements have names, and what MuJoCo refuses without need is replaced.
    inertia : dict
        By the name of a body: moments of inertia in the frame of its ``inertial`` that MuJoCo would refuse, as 3 x 3 array.
        The root has others in their place.
    least : float
        The mass and moment of inertia of a moving body that count as 0.
    """

    def __init__(self, text: str | bytes, path: str, findings: Findings) -> None:
        self.findings = findings
        self.folder = Path(path).parent if path else None
        self.place: dict[Element, tuple[str, int]] = {}
        self.by_name: dict[tuple[str, str], Element] = {}
        self.unnamed: set[str] = set()
        self._mark = "@"  # of the names of unnamed elements
        self.inertia: dict[str, Floats] = {}
        self.root = self._parsed(text, "")
        self.is_urdf = self.root.tag == "robot"
        self.least = LEAST_OF_URDF if self.is_urdf else LEAST

    def _parsed(self, text: str | bytes, file: str) -> Element:
        """The tree of elements, each with its place. Names of namespaces go."""
        parser, builder = expat.ParserCreate(), TreeBuilder()
        begin = len(text) - len(text.lstrip())  # a declaration must come first
        above = sum(each in ("\n", 10) for each in text[:begin])

        def start(tag: str, given: dict[str, str]) -> None:
            plain = {name: value for name, value in given.items() if ":" not in name and name != "xmlns"}
            self.place[builder.start(tag, plain)] = file, above + parser.CurrentLineNumber

        parser.StartElementHandler, parser.EndElementHandler = start, builder.end
        parser.Parse(text[begin:], True)
        return builder.close()

    def put_right(self) -> None:
        """Repair what MuJoCo would refuse for no good reason; note repairs that matter, and obstacles."""
        if not self.is_urdf:
            self._include(self.root, set())
        self.settings = {name: value for each in self.root.iter("compiler") for name, value in each.attrib.items()}
        if self.is_urdf:
            self._put_urdf_right()
        else:
            self._put_mjcf_right()

    def name_of(self, kind: str, name: str) -> str:
        """The words for a named or unnamed element in sentences."""
        kind = "link" if kind == "body" and self.is_urdf else kind
        if name not in self.unnamed:
            return f"{kind} {name!r}" if name else f"a {kind} without a name"
        file, line = self.place_of(kind, name)
        return f"the {kind} in line {line}" + (f" of {file}" if file else "")

    def place_of(self, kind: str, name: str) -> tuple[str, int]:
        """File and line of an element; the file is empty for the main one, the line 0 where it is not known."""
        kind = "link" if kind == "body" and self.is_urdf else kind
        element = self.by_name.get((kind, name))
        return ("", 0) if element is None else self.place[element]

    def option(self, name: str) -> tuple[str, int]:
        """File and line of the ``option`` with an attribute."""
        found = [self.place[each] for each in self.root.iter("option") if each.get(name)]
        return found[0] if found else ("", 0)

    def written(self) -> tuple[str, list[Element]]:
        """The text for MuJoCo, and the element in each of its lines."""
        lines: list[str] = []
        elements: list[Element] = []
        stack: list[Element | str] = [self.root]
        while stack:
            here = stack.pop()
            if isinstance(here, str):
                lines[-1] += here
                continue
            given = "".join(f" {name}={quoteattr(value)}" for name, value in here.attrib.items())
            lines.append(f"<{here.tag}{given}" + (">" if len(here) else "/>"))
            elements.append(here)
            if len(here):
                stack += [f"</{here.tag}>", *reversed(here)]
        return "\n".join(lines), elements

    def message(self, error: str, elements: list[Element], version: str) -> tuple[tuple[str, int], str]:
        """The place of an error in the file, and MuJoCo's message about it with the names of the file."""
        place = ("", 0)
        if found := re.search(r",? line (\d+)(, column \d+)?", error):
            if 0 < int(found[1]) <= len(elements):
                place = self.place.get(elements[int(found[1]) - 1], place)
            error = error.replace(found[0], "")
        for (kind, name), element in self.by_name.items():
            if name and re.search(rf"\bname '{re.escape(name)}'", error):
                place = place if place[1] else self.place.get(element, place)
                error = error if name not in self.unnamed else error.replace(f"name '{name}'", self.name_of(kind, name))
        sentence = " ".join(error.removeprefix("XML Error: ").removeprefix("Error: ").split())
        return place, f"MuJoCo {version} refuses it: {sentence}"

    # ---- MJCF

    def _put_mjcf_right(self) -> None:
        for parent in list(self.root.iter()):
            for child in list(parent):
                if child.tag in _LOOKS:
                    parent.remove(child)
            parent.attrib.pop("material", None)
            for name in set(parent.attrib) - _READ.get(parent.tag, {*parent.attrib}):
                del parent.attrib[name]
        while any(each.get("name", "").startswith(self._mark) for each in self.root.iter()):
            self._mark += "@"
        self._name_all(self.root, "")
        self._drop_lost_meshes()
        for body in self.root.iter("body"):
            name = body.get("name", "")
            inertial = body.find("inertial")
            if inertial is not None:
                self._mend_inertial(inertial, name)
            elif body.find("joint") is not None and not {child.tag for child in body} & _HEAVY:
                tiny = repr(self.least)
                SubElement(body, "inertial", pos="0 0 0", mass=tiny, diaginertia=f"{tiny} {tiny} {tiny}")

    def _include(self, parent: Element, seen: set[str]) -> None:
        """Put the elements of included files in their place; note files that are missing."""
        for child in list(parent):
            if child.tag != "include":
                self._include(child, seen)
                continue
            at, name = list(parent).index(child), child.get("file", "")
            parent.remove(child)
            try:
                if self.folder is None:
                    raise FileNotFoundError
                tree = self._parsed((self.folder / name).read_bytes(), name)
            except (OSError, ValueError):
                what = f"the included file {name!r} cannot be read"
                self.findings.obstacle(self.place[child], what, "put it there", "visual")
                continue
            except expat.ExpatError as error:
                self.findings.obstacle((name, error.lineno), f"no XML: {error}", "mend it", "visual")
                continue
            if name in seen:
                continue
            seen.add(name)
            self._include(tree, seen)
            for nth, each in enumerate(tree):
                parent.insert(at + nth, each)

    def _name_all(self, element: Element, section: str) -> None:
        """Give a name to bodies, joints, actuators and the like that have none."""
        for child in element:
            if child.tag in _COPIED:
                continue
            if child.tag in _NAMED or section in _SECTIONS:
                kind = section if section in _SECTIONS else child.tag.removeprefix("free")
                if not child.get("name"):
                    name = f"{self._mark}{len(self.unnamed) + 1}"
                    child.set("name", name)
                    self.unnamed.add(name)
                self.by_name[kind, child.attrib["name"]] = child
            if section not in _SECTIONS:
                self._name_all(child, child.tag if element is self.root else "body")

    def _drop_lost_meshes(self) -> None:
        """Take away meshes whose file is missing, and the geoms that show them."""
        settings = self.settings
        folder = (self.folder or Path()) / settings.get("meshdir", settings.get("assetdir", ""))
        lost: set[tuple[str, str]] = set()
        for assets in self.root.iter("asset"):
            for asset in list(assets):
                file = asset.get("file")
                if asset.tag not in ("mesh", "hfield") or file is None:
                    continue
                file = Path(file).name if settings.get("strippath") == "true" else file
                if self.folder is None or not (folder / file).is_file():
                    lost.add((asset.tag, asset.get("name", Path(file).stem)))
                    assets.remove(asset)
        if not lost:
            return
        for body in [each for each in self.root.iter() if each.tag in ("body", "worldbody", "frame")]:
            has_inertia = body.find("inertial") is not None and settings.get("inertiafromgeom") != "true"
            for geom in [each for each in body if each.tag == "geom"]:
                kind, name = next((one for one in lost if geom.get(one[0]) == one[1]), ("", ""))
                if not kind:
                    continue
                body.remove(geom)
                whose = "the ground" if body.tag == "worldbody" else self.name_of("body", body.get("name", ""))
                what = f"a geom of {whose} shows {kind} {name!r}, whose file is missing"
                if has_inertia or body.tag == "worldbody" or geom.get("mass") == "0":
                    self.findings.remark(self.place[geom], what)
                else:
                    instead = "put the file there, or give the body an inertial"
                    self.findings.obstacle(self.place[geom], f"{what}, and gives the body its mass", instead, "visual")

    # ---- URDF

    def _put_urdf_right(self) -> None:
        for element in self.root:
            element.tag = "joint" if element.tag == "drake:joint" else element.tag
        links = {link.get("name", ""): link for link in self.root.findall("link")}
        joints = self.root.findall("joint")
        for name, link in links.items():
            self.by_name["link", name] = link
        for joint in joints:
            self.by_name["joint", joint.get("name", "")] = joint
            self._mend_joint(joint)
        for element in self.root.iter():
            if element.tag.startswith("xacro:"):
                what = f"{element.tag} is not expanded"
                self.findings.obstacle(self.place[element], what, "write xacro FILE > model.urdf in a shell")
                self.findings.stop()
        below = {child: joint for joint in joints if (child := _link(joint, "child")) is not None}
        for joint in joints:
            if (parent := _link(joint, "parent")) == "world" and "world" not in links:
                self.findings.remark(self.place[joint], "link 'world' is not declared: taken as the ground")
                links["world"] = Element("link", name="world")
                self.root.insert(0, links["world"])
            for which, end in (("parent", parent), ("child", _link(joint, "child"))):
                if end not in links:
                    what = f"joint {joint.get('name')!r}: its {which} link {end!r} is not declared"
                    self.findings.obstacle(self.place[joint], what, "declare it")
        for name in [name for name in links if name not in below and name != "world"]:
            self.findings.remark(self.place[links[name]], f"link {name!r} hangs from no joint: taken as the ground")
        meshes = [self._mend_link(name, link, below.get(name)) for name, link in links.items()]
        if any(meshes):
            names = ", ".join(name for name, count in zip(links, meshes, strict=True) if count)
            self.findings.remark(("", 0), f"meshes are not read, as masses are in the file: {names}")

    def _mend_joint(self, joint: Element) -> None:
        """Take away limits of equal ends, which are none; note joints that move with others."""
        name = f"joint {joint.get('name')!r}"
        limit = joint.find("limit")
        if limit is not None and joint.get("type") in ("revolute", "prismatic"):
            with suppress(ValueError):
                low, high = float(limit.get("lower", "0")), float(limit.get("upper", "0"))
                if low >= high:
                    joint.remove(limit)
                    if joint.get("type") == "revolute":
                        joint.set("type", "continuous")
                    else:
                        limit.attrib.update(lower="-1e9", upper="1e9")
                        joint.append(limit)
                    ends = f"equal ends, {low:g}" if low == high else f"a lower end {low:g} above the upper one, {high:g}"
                    what = f"{name} has limits of {ends}: taken as without limits"
                    self.findings.remark(self.place[joint], what)
        if joint.get("type") == "ball":
            joint.set("type", "spherical")
            self.findings.remark(self.place[joint], f"{name} has type ball, which URDF does not have: read as a ball joint")
        if joint.find("mimic") is not None:
            self.findings.obstacle(self.place[joint], f"{name} moves with another joint (mimic)", "remove it", "equality")

    def _mend_link(self, name: str, link: Element, joint: Element | None) -> int:
        """Take away meshes, and return their number; give moving links without mass the least mass; mend inertia."""
        shapes = [each for each in link if each.tag in ("visual", "collision")]
        meshes = sum(shape.find("geometry/mesh") is not None for shape in shapes)
        for k, shape in enumerate(shapes):
            shape.set("name", f"{name} {k}")  # some versions of MuJoCo print a warning of those without a name
            if shape.tag == "visual" or shape.find("geometry/mesh") is not None:
                link.remove(shape)
        inertial = link.find("inertial")
        if inertial is not None and name == "world":
            link.remove(inertial)
        elif inertial is not None:
            self._mend_inertial(inertial, name)
        elif joint is None or joint.get("type") == "fixed":
            pass
        elif link.find("collision") is None:
            inertial = SubElement(link, "inertial")
            SubElement(inertial, "mass", value=repr(self.least))
            SubElement(inertial, "inertia", _tensor(*[self.least] * 3))
            if meshes:
                self.findings.remark(self.place[link], f"link {name!r} has no inertial: it is without mass")
        else:
            self.findings.remark(
                self.place[link], f"link {name!r} has no inertial: its mass is that of its collision shapes, of 1000 kg/m^3"
            )
        return meshes

    # ---- both

    def _mend_inertial(self, inertial: Element, name: str) -> None:
        """Replace moments of inertia that MuJoCo would refuse; keep those of the file."""
        if "boundinertia" in self.settings or "true" in map(self.settings.get, ("balanceinertia", "inertiafromgeom")):
            return  # MuJoCo makes others of them
        with suppress(ValueError):  # no numbers: MuJoCo says so
            mass, moments = _inertia_of(inertial, self.is_urdf)
            if mass < 0:
                what = f"{self.name_of('body', name)} has a negative mass, {mass:g}"
                self.findings.obstacle(self.place[inertial], what, "give 0 or more")
            if mass < 0 or not np.isfinite(moments).all() or not np.isfinite(mass):
                return
            values = np.sort(np.linalg.eigvalsh(moments))
            if self.is_urdf and mass < self.least:
                moments, values = np.zeros((3, 3)), np.zeros(3)
                _set(inertial, "mass", value=repr(self.least))
            if values[0] > 0 and values[2] <= (values[0] + values[1]) * (1 + 1e-12):
                return
            self.inertia[name] = moments
            size = max(float(np.abs(moments).max()), 2 * self.least)
            others = (size, 0.9 * size, 0.8 * size)  # unequal, so that MuJoCo keeps the axes
            if self.is_urdf:
                _set(inertial, "inertia", **_tensor(*others))
            else:
                inertial.attrib.pop("fullinertia", None)
                inertial.set("diaginertia", " ".join(map(repr, others)))
            if mass >= self.least:
                has = "a point mass" if not moments.any() else "moments of inertia that no body has"
                what = f"{self.name_of('body', name)} has {has}: MuJoCo refuses these, and they are read as they are"
                self.findings.remark(self.place[inertial], what)


def _link(joint: Element, which: str) -> str | None:
    """The name of the parent or child of a joint."""
    found = joint.find(which)
    return None if found is None else found.get("link")


def _tensor(*moments: float) -> dict[str, str]:
    """The attributes of an ``inertia`` with these moments about its axes."""
    return dict(zip(_TENSOR, [*map(repr, moments), "0", "0", "0"], strict=True))


def _set(parent: Element, tag: str, **given: str) -> None:
    """Set the attributes of a child, which is made if there is none."""
    child = parent.find(tag)
    (SubElement(parent, tag) if child is None else child).attrib.update(given)


def _inertia_of(inertial: Element, is_urdf: bool) -> tuple[float, Floats]:
    """Mass and moments of inertia about the axes of the frame of an ``inertial``; a ValueError if they are no numbers."""
    if is_urdf:
        mass, six = inertial.find("mass"), inertial.find("inertia")
        numbers = [0.0 if six is None else float(six.get(name, "0")) for name in _TENSOR]
        heavy = 0.0 if mass is None else float(mass.get("value", "0"))
    else:
        heavy = float(inertial.get("mass", ""))
        words = inertial.get("fullinertia", inertial.get("diaginertia", "0 0 0")).split()
        numbers = [float(word) for word in words] + [0.0] * 3
    a, b, c, d, e, f = numbers[:6]
    return heavy, np.array([[a, d, e], [d, b, f], [e, f, c]])


