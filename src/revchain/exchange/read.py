# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and rigs from models of MuJoCo (MJCF) and robot descriptions (URDF), whose files MuJoCo reads."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import Any, NamedTuple
from xml.parsers import expat

from ..results.files import naming
from ..systems.chain import Chain
from ..systems.extras import require
from ..systems.numbers import STANDARD_GRAVITY, file_path
from ..systems.rig import Rig
from .findings import Blocked, Findings, ModelWarning, Sentence, ignored, listed_words
from .model import Model
from .text import OTHER, Text


_NOT_XML = ("{", "[", "#", b"{", b"[", b"#")  # first letters of JSON and TOML


def from_mjcf(
    source: str | os.PathLike[str], *, ignore: str | tuple[str, ...] = (), links: str | tuple[str, ...] | None = None
) -> Chain | Rig:
    """Return the serial chain of links in a model of MuJoCo.

    Parameters
    ----------
    source : path-like or str
        Path of the file, or its text, which begins with ``<``.
    ignore : str or tuple of str
        Parts of the model to leave out, which a chain cannot have: words of the table below, such as ``"damping range"``;
        ``"all"`` leaves out each of these.
    links : str or tuple of str, optional
        Names of the bodies that are the links, if more than one body hangs from another.

    Returns
    -------
    Chain or Rig
        By mass; a `Rig` where a `Chain` does not suffice.

    Warns
    -----
    ModelWarning
        If something was left out, changed or guessed, or if gravity is not the standard one. The warning has the gravity to
        give to questions.

    Raises
    ------
    ValueError
        If the model is not a serial chain (the message lists the obstacles and what to do), or if `ignore` has an unknown
        word or `links` an unknown body.
    ImportError
        If mujoco is not installed.
    OSError
        If the file cannot be read.

    Notes
    -----
    Words of `ignore`:

    ============= =======================================================================================
    word          what is left out
    ============= =======================================================================================
    actuator      motors that exert a force without a signal
    armature      inertia of rotors that is not of the carriage or, in a plane, of the uppermost hinge
    damping       all dashpots
    equality      constraints between joints or bodies
    fluid         forces of the medium (density, viscosity)
    friction      dry friction of joints (frictionloss)
    gravcomp      forces against gravity on single bodies
    plugin        plugins of the engine
    range         limits of joints
    stiffness     springs that are not relaxed in the straight chain, or differ in the hinges of one pin
    tendon        tendons that exert a force
    visual        included files and meshes that are missing
    ============= =======================================================================================

    A link hangs down, whatever its pose in the file; it stands (is `inverted`) where a spring at its pin holds it so.
    Bodies fixed to each other are one link. The lower pin of a link is where the next body is hinged. The free end, on
    which no speed depends, is the only massless body fixed to the lowest link, else its only site, the far end of its
    geoms, or its centre of gravity.

    If all joints are parallel hinges, the links move in one plane. A link whose centre of gravity lies beside the line of
    its pins is then read as the straight link with the same small motion, and a last body that turns freely about its
    centre of gravity as a point mass. Inclined hinges reduce the gravity in that plane.

    Stiffness and damping of the joints at a pin, equal in both its hinges, are those of a `Pin`. Bodies on slides above
    all links are the carriage of a `Support`: on a spring, or a trolley. Links on parallel hinges need one slide, in their
    plane; others two, at right angles. A hinge about the vertical above all links is a turntable that keeps its speed.
    Links without a turntable, or on ball joints, do not spin about their own axes.

    Contacts, keyframes, the ends of a rail, and motors that exert no force without a signal are not read.

    Accuracy: speeds of small motion agree with MuJoCo's linearised equations to 1e-9, the error of the differences there.
    Cost: that of MuJoCo's compiler, 1.5 milliseconds, and 0.3 for each link.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(mass=[1.0, 3.0], length=[0.5, 0.7])
    >>> text = rc.to_mjcf(chain)
    >>> rc.from_mjcf(text) == chain
    True
    >>> rubbed = text.replace('name="link_0_sideways"', 'name="link_0_sideways" frictionloss="0.1"')
    >>> rc.from_mjcf(rubbed)
    Traceback (most recent call last):
    ...
    ValueError: revchain.from_mjcf: line 33: joint 'link_0_sideways' has frictionloss 0.1; set it to 0, or ignore="friction"
    """
    return _read("revchain.from_mjcf", source, "mujoco", ignore, links)


def from_urdf(
    source: str | os.PathLike[str], *, ignore: str | tuple[str, ...] = (), links: str | tuple[str, ...] | None = None
) -> Chain | Rig:
    """Return the serial chain of links in a URDF file.

    Parameters
    ----------
    source : path-like or str
        Path of the file, or its text, which begins with ``<``.
    ignore : str or tuple of str
        Words as in `from_mjcf`.
    links : str or tuple of str, optional
        Names of the links of the chain, if more than one link hangs from another.

    Returns
    -------
    Chain or Rig
        As from `from_mjcf`.

    Warns
    -----
    ModelWarning
        If something was left out, changed or guessed. URDF has no gravity: the warning has that of MuJoCo.

    Raises
    ------
    ValueError
        If the file is no serial chain, `ignore` has an unknown word, or `links` an unknown name.
    ImportError
        If mujoco is not installed.
    OSError
        If the file cannot be read.

    Notes
    -----
    The root link is the ground, and so is a link ``world`` that is not declared. Point masses, moments of inertia that no
    body has, namespaces, meshes, and limits whose two ends are equal are put right before MuJoCo compiles the file. A link
    without mass and length is part of the joint below it. The free end of the lowest link is a link without mass fixed to
    it, or else as in `from_mjcf`.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(mass=[1.0, 3.0], length=[0.5, 0.7])
    >>> rc.from_urdf(rc.to_urdf(chain)) == chain
    True
    """
    return _read("revchain.from_urdf", source, "robot", ignore, links)


class Imported(NamedTuple):
    """A system read from a file, the gravity of the model, its title, what was left out, and remarks."""

    system: Chain | Rig
    gravity: float
    title: str
    left_out: tuple[Sentence, ...]
    remarks: tuple[Sentence, ...]
    has_gravity: bool

    def said(self) -> list[tuple[str, tuple[Sentence, ...]]]:
        """The list of what was left out and that of the remarks, each with a title."""
        return [(title, each) for title, each in (("left out:", self.left_out), ("remarks:", self.remarks)) if each]


def read_model(function: str, source: Any, root: str, ignore: Any, links: Any) -> Imported:
    """Read a model; `root` is the element with which it must begin, "" for any model."""
    mujoco = require("mujoco", "exchange", function)
    findings = Findings(function, ignored(function, ignore))
    chosen = () if links is None else listed_words(function, "links", links)
    is_text = isinstance(source, str) and source.lstrip().startswith("<")
    name = "" if is_text else file_path(function, "source", source)
    with naming(name):
        content = source if is_text else Path(name).read_bytes()
    try:
        text = Text(content, name, findings)
    except (expat.ExpatError, ValueError, LookupError) as error:
        if content.lstrip(b"\xef\xbb\xbf \t\r\n" if isinstance(content, bytes) else None)[:1] in _NOT_XML:
            raise Blocked(f"{function}: is no XML model: MJCF begins with <mujoco>, URDF with <robot>") from None
        raise Blocked(f"{function}: {error}") from None
    found = text.root.tag
    if found not in ([root] if root else OTHER):
        other = OTHER.get(found, "neither MJCF nor URDF") if root else "neither MJCF nor URDF"
        wanted = f"<{root}>" if root else "<mujoco> or <robot>"
        raise Blocked(f"{function}: source must begin with {wanted}, got <{found}>, {other}")
    try:
        text.put_right()
    except RecursionError:
        raise Blocked(f"{function}: elements are nested too deep; MuJoCo takes some 500 bodies, one in another") from None
    compiled = _compiled(mujoco, text, findings)
    model = Model(mujoco, compiled, text, findings)
    model.choose(chosen)
    system = model.system()
    left_out, remarks = (tuple(sorted(each)) for each in (findings.left_out, findings.remarks))
    title = text.root.get("model" if found == "mujoco" else "name", "")
    return Imported(system, model.gravity, title, left_out, remarks, found == "mujoco")


def _compiled(mujoco: Any, text: Text, findings: Findings) -> Any:
    """The compiled model; one error for all obstacles of the text and that of MuJoCo."""
    plain, elements = text.written()
    said: list[str] = []
    before = mujoco.get_mju_user_warning()
    mujoco.set_mju_user_warning(said.append)  # otherwise MuJoCo prints warnings and writes them to a file
    try:
        spec = mujoco.MjSpec.from_string(plain)
        spec.modelfiledir = "" if text.folder is None else str(text.folder)
        if text.is_urdf:
            spec.compiler.fusestatic = False
        return spec.compile()
    except ValueError as error:
        place, sentence = text.message(str(error), elements, mujoco.__version__)
        findings.obstacle(place, sentence, "correct the file")
        findings.stop()
    finally:
        mujoco.set_mju_user_warning(before)
        for sentence in said:
            findings.remark(("", 0), f"MuJoCo says: {sentence.strip()}")


def _read(function: str, source: Any, root: str, ignore: Any, links: Any) -> Chain | Rig:
    """The system, with a warning if something was left out or changed, or if gravity is not the standard one."""
    try:
        model = read_model(function, source, root, ignore, links)
    except Blocked as error:
        raise ValueError(str(error)) from None
    said = model.said()
    if said or (model.has_gravity and model.gravity != STANDARD_GRAVITY):
        whose = "gravity of the model" if model.has_gravity else "URDF has no gravity; that of MuJoCo"
        lines = [f"{whose} is {model.gravity:.9g} m/s^2: give gravity={model.gravity!r} in questions"]
        lines += [line for title, each in said for line in (title, *(f"  {sentence}" for sentence in each))]
        left_out, remarks = tuple(map(str, model.left_out)), tuple(map(str, model.remarks))
        warnings.warn(ModelWarning("\n".join(lines), model.gravity, left_out, remarks), stacklevel=3)
    return model.system
