# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains and rigs from the models of multibody engines; MuJoCo reads the files."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any
from xml.etree import ElementTree as Xml

from ..results.files import naming
from ..systems.chain import Chain
from ..systems.extras import require
from ..systems.numbers import file_path
from ..systems.rig import Rig
from .mjcf import LEAST as LEAST_OF_MJCF
from .serial import Serial
from .urdf import LEAST as LEAST_OF_URDF

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
        By mass; a `Rig` if the model has a support on an arm or on springs, or axial moments of inertia that turn with
        it. Masses, lengths, centroids and radii of gyration equal those of the model to the last digit.

    Raises
    ------
    ValueError
        If the model is not a serial chain of straight links hung by hinges or ball joints without friction; the message
        names the body or joint and says why.
    ImportError
        If mujoco is not installed; the message says how to install it.
    OSError
        (a ValueError too) If the file cannot be read.

    Notes
    -----
    The lower pin of a link is where the next body is hinged. The free end of the lowest link is its only site, the
    position of a massless body fixed to it, or else the far end of its geoms. A hinge about the vertical above all
    links is a turntable that keeps its speed. Links without a turntable, or on ball joints, do not spin about their own
    axes: their moments of inertia about these axes have no effect and are left out. Contacts, keyframes and gravity are
    not read.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(mass=[1.0, 3.0], length=[0.5, 0.7])
    >>> rc.from_mjcf(rc.to_mjcf(chain)) == chain
    True
    """
    return _system("revchain.from_mjcf", source, "mujoco", LEAST_OF_MJCF)


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


def _system(place: str, source: Any, root: str, least: float) -> Chain | Rig:
    mujoco = require("mujoco", "exchange", place)
    is_text = isinstance(source, str) and source.lstrip().startswith("<")
    name = "" if is_text else file_path(place, "source", source)
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
        raise ValueError(f"{place}: {error}") from None
    try:
        return Serial(mujoco, model, place, least).system()
    except ValueError as error:  # of a chain that it would make
        raise ValueError(f"{place}: {str(error).partition(': ')[2]}") from None
