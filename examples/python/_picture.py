# SPDX-License-Identifier: GPL-3.0-or-later
"""For the programs that draw: style, size of figures, a hanging chain, the file of the picture."""

import sys
from pathlib import Path

import matplotlib
from matplotlib.figure import Figure

from revchain.plots.style import STYLE

matplotlib.rcParams.update(STYLE)
COLOURS = matplotlib.rcParams["axes.prop_cycle"].by_key()["color"]


def panels(count, widths=None):
    """A figure with `count` panels side by side."""
    figure = Figure(figsize=(8, 4.5), layout="constrained")
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


def save(figure, name=None):
    """Write the picture, named after the program or as told, into the folder given as argument, or the current one."""
    path = Path(sys.argv[1] if len(sys.argv) > 1 else ".") / ((name or Path(sys.argv[0]).stem) + ".svg")
    figure.savefig(path, metadata={"Date": None})  # the same picture gives the same file
    print("wrote", path.name)
