# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures by matplotlib, imported when something is drawn.

`DRAWN_BY` has, for the name of a class, the function that is its method `plot`.
"""

DRAWN_BY = {
    **dict.fromkeys(("Chain", "Rig", "Cord", "Held"), "modes.plot_system"),
    "Modes": "modes.plot_modes",
    "SteadyShape": "shapes.plot_shape",
    "SteadyShapes": "shapes.plot_shapes",
    "Branch": "branches.plot_branch",
    "Branches": "branches.plot_branches",
    "DragShape": "shapes.plot_drag_shape",
    "Response": "response.plot_response",
    "Swing": "response.plot_swing",
    "Campbell": "response.plot_campbell",
    "ForceDiagram": "closed_forms.plot_force_diagram",
    "FunicularPolygon": "closed_forms.plot_funicular_polygon",
    "SkippingRope": "closed_forms.plot_skipping_rope",
    "TortuousRope": "closed_forms.plot_tortuous_rope",
    "GovernorMotion": "closed_forms.plot_governor",
    "SleeveGovernor": "closed_forms.plot_sleeve_governor",
    "GovernorEquilibria": "closed_forms.plot_governor_equilibria",
    "GyrostaticString": "closed_forms.plot_waves",
    "GyrostaticString.vibration": "closed_forms.plot_vibration",
    "BellAndClapper": "closed_forms.plot_bell",
}
