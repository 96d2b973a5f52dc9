# SPDX-License-Identifier: GPL-3.0-or-later
"""For the programs that draw: style, size of figures, a hanging chain, the file of the picture."""

import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.transforms import ScaledTranslation

from revchain.plots.style import STYLE

matplotlib.rcParams.update(STYLE)
COLOURS = matplotlib.rcParams["axes.prop_cycle"].by_key()["color"]


def panels(count, widths=None, height=4.5):
    """A figure with `count` panels side by side, 8 inches wide."""
    figure = Figure(figsize=(8, height), layout="constrained")
    return figure, figure.subplots(1, count, width_ratios=widths, squeeze=False)[0]


def hang(axes, offset, depth, *, weights=(), **line):
    """Draw a chain given by offsets from the axis and depths below the support; `weights` are the sizes of dots."""
    (drawn,) = axes.plot(offset, depth, **line)
    for y, z, size in zip(offset, depth, weights, strict=False):
        axes.scatter(y, z, s=size, color=drawn.get_color(), alpha=drawn.get_alpha(), linewidth=0, zorder=3)


def side_view(axes, title, *, bottom, top=0.05, half_width):
    """True proportions, the vertical axis dash-dotted, metres below the support."""
    axes.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
    axes.set(title=title, xlabel="distance from axis (m)", xlim=(-half_width, half_width), ylim=(bottom, -top))
    axes.set_aspect("equal")


def branch_of(shape, branches):
    """Number of the branch on which a shape lies: the one with the nearest point."""
    apart = [
        np.hypot(branch.angular_speed / shape.angular_speed - 1, branch.tip_inclination - shape.inclination[0]).min()
        for branch in branches
    ]
    return int(np.argmin(apart))


def legend_below(axes, **more):
    """A legend under the frame and the label, where it covers no curve."""
    down = axes.transAxes + ScaledTranslation(0, -0.55, axes.figure.dpi_scale_trans)  # inches
    axes.legend(**{"loc": "upper center", "bbox_to_anchor": (0.5, 0), "bbox_transform": down, "ncols": 2, **more})


def save(figure, name=None):
    """Write the picture, named after the program or as told, into the folder given as argument, or the current one."""
    path = Path(sys.argv[1] if len(sys.argv) > 1 else ".") / ((name or Path(sys.argv[0]).stem) + ".svg")
    figure.savefig(path, metadata={"Date": None})  # the same picture gives the same file
    print("wrote", path.name)
