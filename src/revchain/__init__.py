# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains that whirl: natural frequencies, whirl speeds, steady shapes (relative equilibria), with bounds of their errors.

A chain of rigid links hangs from a support and whirls about the vertical as one rigid figure. For a chain hung from a
fixed point the whirl speed of small amplitude is the natural angular frequency of its swing in a plane. Theory:
G. Greenhill, "The Revolving Chain" (1908).

Systems
    Chain, Rig (with Support, Pin, Flywheel, Displaced), Cord, Held; SupportMotion, Drag
Questions
    modes, count_modes, steady_shapes, steady_shape, branches, branch, response, swing, campbell, drag_shape, tune, fit,
    explain;
    conical_heights for many chains at once
Results
    Modes, SteadyShapes, SteadyShape, Branches, Branch,
    Stability, ForceDiagram, Response, Swing, Campbell, DragShape, Tuned, Fitted, Explanation, Sensitivity, Uncertainty,
    WorstCase; ``load`` reads the files that their method ``save`` wrote
Closed forms
    conical_pendulum, plummet, two_links, elliptic, hoop, bell_and_clapper, funicular_polygon, transverse_modes,
    recurrence_matrices; BellAndClapper, BufferImpact, GovernorMotion, SleeveGovernor, GyrostaticString, SkippingRope,
    TortuousRope, FunicularPolygon, TransverseModes
Files
    Scene, load_scene, Study, load_study, sweep, SceneError; of multibody engines to_mjcf, from_mjcf, to_urdf,
    from_urdf, ModelWarning
C++
    cmake_prefix: the folder of the C++ headers in this package

Links are listed from the free end up, unless a chain is given in the other order. Numbers are in SI units; text such
as "39 inch" is converted. Links and pins are counted from 0, modes from 1. The *conical height* of a speed is
``gravity / speed**2``, the height of the conical pendulum with that speed.

Examples
--------
A double pendulum of 1 kg and 3 kg on threads of 1 m:

>>> import revchain as rc
>>> chain = rc.Chain(mass=[1.0, 3.0], length=1.0)
>>> rc.modes(chain)
2 of 2 modes of a chain of 2 links, length 2, mass 4: by aberth, success
mode  speed (rad/s)  speed (rpm)  period (s)   height (m)  error bound  nodes (m from the free end)
   1        2.55691      24.4167     2.45734   1.50000000      1.1e-16                            0
   2        4.42869      42.2909     1.41875  0.500000000      1.1e-16                       1: 0.5
gravity 9.80665 m/s^2; error bound: relative, of the conical height
"""

from importlib import import_module as _import_module
from importlib.util import find_spec as _find_spec
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from .questions.batch import conical_heights as conical_heights
from .questions.branches import branch as branch
from .questions.branches import branches as branches
from .questions.campbell import campbell as campbell
from .questions.drag import drag_shape as drag_shape
from .questions.explain import explain as explain
from .questions.fit import fit as fit
from .questions.modes import count_modes as count_modes
from .questions.modes import modes as modes
from .questions.modes import recurrence_matrices as recurrence_matrices
from .questions.response import response as response
from .questions.shapes import steady_shape as steady_shape
from .questions.shapes import steady_shapes as steady_shapes
from .questions.swing import swing as swing
from .questions.tune import tune as tune
from .results.branches import Branch as Branch
from .results.branches import Branches as Branches
from .results.campbell import Campbell as Campbell
from .results.diagrams import ForceDiagram as ForceDiagram
from .results.drag import DragShape as DragShape
from .results.explanation import Explanation as Explanation
from .results.fitted import Fitted as Fitted
from .results.modes import Modes as Modes
from .results.motions import Response as Response
from .results.motions import Swing as Swing
from .results.sensitivity import Sensitivity as Sensitivity
from .results.sensitivity import Uncertainty as Uncertainty
from .results.worst import WorstCase as WorstCase
from .results.shapes import Stability as Stability
from .results.shapes import SteadyShape as SteadyShape
from .results.shapes import SteadyShapes as SteadyShapes
from .results.tuned import Tuned as Tuned
from .scenes.error import SceneError as SceneError
from .systems.chain import Chain as Chain
from .systems.cord import Cord as Cord
from .systems.drag import Drag as Drag
from .systems.held import Held as Held
from .systems.rig import Displaced as Displaced
from .systems.rig import Flywheel as Flywheel
from .systems.rig import Pin as Pin
from .systems.rig import Rig as Rig
from .systems.rig import Support as Support
from .systems.support_motion import SupportMotion as SupportMotion

if _TYPE_CHECKING:
    from .cli import cmake_prefix as cmake_prefix
    from .closed_forms import conical_pendulum as conical_pendulum
    from .closed_forms import elliptic as elliptic
    from .closed_forms import hoop as hoop
    from .closed_forms import plummet as plummet
    from .closed_forms import two_links as two_links
    from .closed_forms.bell import BellAndClapper as BellAndClapper
    from .closed_forms.bell import bell_and_clapper as bell_and_clapper
    from .closed_forms.governor import GovernorEquilibria as GovernorEquilibria
    from .closed_forms.governor import SleeveGovernor as SleeveGovernor
    from .closed_forms.motions import BufferImpact as BufferImpact
    from .closed_forms.motions import GovernorMotion as GovernorMotion
    from .closed_forms.strings import GyrostaticString as GyrostaticString
    from .closed_forms.motions import SkippingRope as SkippingRope
    from .closed_forms.motions import TortuousRope as TortuousRope
    from .closed_forms.strings import FunicularPolygon as FunicularPolygon
    from .closed_forms.strings import TransverseModes as TransverseModes
    from .closed_forms.strings import funicular_polygon as funicular_polygon
    from .closed_forms.strings import transverse_modes as transverse_modes
    from .exchange.findings import ModelWarning as ModelWarning
    from .exchange.write import to_mjcf as to_mjcf
    from .exchange.read import from_mjcf as from_mjcf
    from .exchange.read import from_urdf as from_urdf
    from .exchange.write import to_urdf as to_urdf
    from .closed_forms.bell import Strike as Strike
    from .results.shapes import Place as Place
    from .results.branches import StabilityWindow as StabilityWindow
    from .results.branches import StabilityWindows as StabilityWindows
    from .results.modes import Certificate as Certificate
    from .results.modes import OtherModes as OtherModes
    from .results.storage import load as load
    from .scenes.scene import Scene as Scene
    from .scenes.scene import load_scene as load_scene
    from .studies.study import Study as Study
    from .studies.study import load_study as load_study
    from .studies.sweep import sweep as sweep

    __version__: str

_CLOSED_FORMS = "conical_pendulum elliptic hoop plummet two_links".split()
_LATER = dict.fromkeys(_CLOSED_FORMS, "closed_forms") | {
    "BellAndClapper": "closed_forms.bell",
    "bell_and_clapper": "closed_forms.bell",
    "BufferImpact": "closed_forms.motions",
    "SleeveGovernor": "closed_forms.governor",
    "GovernorMotion": "closed_forms.motions",
    "GyrostaticString": "closed_forms.strings",
    "SkippingRope": "closed_forms.motions",
    "TortuousRope": "closed_forms.motions",
    "FunicularPolygon": "closed_forms.strings",
    "TransverseModes": "closed_forms.strings",
    "funicular_polygon": "closed_forms.strings",
    "transverse_modes": "closed_forms.strings",
    "cmake_prefix": "cli",
    "load": "results.storage",
    "to_mjcf": "exchange.write",
    "to_urdf": "exchange.write",
    "from_mjcf": "exchange.read",
    "from_urdf": "exchange.read",
}
_RECEIVED = {  # classes of results that no program makes; `dir` leaves them out
    "Certificate": "results.modes",
    "GovernorEquilibria": "closed_forms.governor",
    "ModelWarning": "exchange.findings",
    "OtherModes": "results.modes",
    "Place": "results.shapes",
    "StabilityWindow": "results.branches",
    "StabilityWindows": "results.branches",
    "Strike": "closed_forms.bell",
}
_OF_FILES = {"Scene": "scenes.scene", "load_scene": "scenes.scene", "Study": "studies.study", "load_study": "studies.study"}
_OF_FILES |= {"sweep": "studies.sweep"}


def __getattr__(name: str) -> _Any:
    """Import a rarely used name on its first use."""
    value: _Any
    if name in _CLOSED_FORMS:
        value = _import_module(f".closed_forms.{name}", __name__)
    elif module := _LATER.get(name) or _RECEIVED.get(name):
        value = getattr(_import_module(f".{module}", __name__), name)
    elif name in _OF_FILES:
        from .systems.extras import require

        try:
            require("msgspec", None, "a scene file")
        except ImportError as error:
            raise AttributeError(str(error)) from error
        value = getattr(_import_module(f".{_OF_FILES[name]}", __name__), name)
    elif name == "__version__":
        from importlib.metadata import version

        value = version("revchain")
    else:
        raise AttributeError(f"module 'revchain' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """The public names. There is no `__all__`, because `help` would then print each class."""
    of_files = list(_OF_FILES) if _find_spec("msgspec") is not None else []
    own = [name for name, value in globals().items() if name[0] != "_" and not hasattr(value, "__path__")]
    return sorted({*own, *_LATER, *of_files, "__version__"} - {*_RECEIVED})
