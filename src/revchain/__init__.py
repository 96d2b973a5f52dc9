# SPDX-License-Identifier: GPL-3.0-or-later
"""Whirl speeds and shapes of chains of links turning about a vertical axis.

A chain hangs from a turning point. At certain speeds it leaves the vertical and whirls as a rigid
figure: ``modes`` finds these speeds, their shapes and how sure they are. The theory is that of
G. Greenhill, "The Revolving Chain" (1908), section 8.

Links are listed lowest first. A result is a *conical height* ``g / n**2``, the height of the conical
pendulum that turns as fast: it does not depend on gravity and is in the unit of the lengths given.

Examples
--------
>>> import revchain as rc
>>> chain = rc.Chain.uniform_rods(120, length=0.36)
>>> result = rc.modes(chain, count=3)
>>> result.angular_speed.round(4)
array([ 6.2757, 14.4064, 22.59  ])
"""

from __future__ import annotations

from contextlib import suppress
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

from .closed_forms import conical_pendulum, elliptic, heavy_chain, hoop, plummet, tapered_chain, tip_mass, two_links
from .closed_forms.bell import BellAndClapper, bell_and_clapper
from .closed_forms.buffer import BufferImpact
from .closed_forms.governor import GovernorMotion
from .closed_forms.gyrostatic_string import GyrostaticString
from .closed_forms.rope import SkippingRope, TortuousRope
from .closed_forms.statics import FunicularPolygon, TransverseModes, funicular_polygon, transverse_modes
from .questions.batch import conical_heights
from .questions.branches import branch, branches, steady_shape
from .questions.cord import (
    ContinuousPlace,
    ContinuousShape,
    ContinuousShapes,
    continuous_critical_heights,
    continuous_shapes,
)
from .questions.explain import explain, solve
from .questions.held import (
    HeldCordShape,
    HeldShape,
    HeldShapes,
    TautModes,
    held_cord_shapes,
    held_shapes,
    taut_modes,
)
from .questions.modes import count_modes, modes, recurrence_matrices
from .questions.response import response, small_oscillation
from .questions.shapes import steady_shapes
from .questions.tune import momentum_for_speed, tune
from .results.branches import Branch, Branches, StabilityWindow
from .results.diagrams import ForceDiagram
from .results.explanation import Explanation, ModelEstimate, Solution
from .results.modes import Certificate, Modes, OtherModes, RigModes
from .results.motions import Response, SmallOscillation
from .results.sensitivity import (
    Derivatives,
    RigSensitivity,
    Sensitivity,
    Uncertainty,
)
from .results.shapes import Stability, SteadyShape, SteadyShapes
from .results.storage import load
from .results.tuned import Tuned
from .scenes.error import SceneError
from .systems.chain import Chain
from .systems.rig import Rig, driven_flywheel, free_flywheel

if TYPE_CHECKING:
    from .scenes.scene import Scene, load_scene
    from .studies.result import SweepResult
    from .studies.study import Study, load_study
    from .studies.sweep import sweep

    __version__: str

__all__ = [
    "BellAndClapper",
    "Branch",
    "Branches",
    "BufferImpact",
    "Certificate",
    "Chain",
    "ContinuousPlace",
    "ContinuousShape",
    "ContinuousShapes",
    "Derivatives",
    "Explanation",
    "ForceDiagram",
    "FunicularPolygon",
    "GovernorMotion",
    "GyrostaticString",
    "HeldCordShape",
    "HeldShape",
    "HeldShapes",
    "ModelEstimate",
    "Modes",
    "OtherModes",
    "Response",
    "Rig",
    "RigModes",
    "RigSensitivity",
    "SceneError",
    "Sensitivity",
    "SkippingRope",
    "SmallOscillation",
    "Solution",
    "Stability",
    "StabilityWindow",
    "SteadyShape",
    "SteadyShapes",
    "TautModes",
    "TortuousRope",
    "TransverseModes",
    "Tuned",
    "Uncertainty",
    "__version__",
    "bell_and_clapper",
    "branch",
    "branches",
    "conical_heights",
    "conical_pendulum",
    "continuous_critical_heights",
    "continuous_shapes",
    "count_modes",
    "driven_flywheel",
    "elliptic",
    "explain",
    "free_flywheel",
    "funicular_polygon",
    "heavy_chain",
    "held_cord_shapes",
    "held_shapes",
    "hoop",
    "load",
    "modes",
    "momentum_for_speed",
    "plummet",
    "recurrence_matrices",
    "response",
    "small_oscillation",
    "solve",
    "steady_shape",
    "steady_shapes",
    "tapered_chain",
    "taut_modes",
    "tip_mass",
    "transverse_modes",
    "tune",
    "two_links",
]
_OF_FILES = dict.fromkeys(("Scene", "load_scene"), "scenes.scene") | dict.fromkeys(("Study", "load_study"), "studies.study")
_OF_FILES |= {"SweepResult": "studies.result", "sweep": "studies.sweep"}
with suppress(ImportError):  # without it, `from revchain import *` must not ask for them
    if find_spec("msgspec") is not None:
        __all__ += list(_OF_FILES)


def __getattr__(name: str) -> Any:
    """Import what needs more than numpy at the moment it is asked for."""
    if name in _OF_FILES:
        from .systems.extras import require

        try:
            require("msgspec", "cli", "a scene file")
        except ImportError as error:
            raise AttributeError(str(error)) from error
        value = getattr(import_module(f".{_OF_FILES[name]}", __name__), name)
    elif name == "__version__":
        from importlib.metadata import version

        value = version("revchain")
    else:
        raise AttributeError(f"module 'revchain' has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
