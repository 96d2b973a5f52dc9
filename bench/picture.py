# SPDX-License-Identifier: MPL-2.0
"""Pictures of measurements: they have the style of the documentation and are written by one function."""

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import matplotlib.ticker

WIDTH = 8  # inches
ACCURATE = "worst relative error, more accurate \N{RIGHTWARDS ARROW}"  # of an axis that falls to the right
plt.rcParams.update(
    {
        "axes.titlesize": "medium",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.axisbelow": True,
        "legend.frameon": False,
        "svg.hashsalt": "revchain",
    }
)


def decades(axis, first, last, step):
    """Marks at every so many powers of ten, and none between."""
    axis.set_major_locator(matplotlib.ticker.FixedLocator([10.0**e for e in range(first, last + 1, step)]))
    axis.set_minor_locator(matplotlib.ticker.NullLocator())


def save(figure, path, source=""):
    """Write an SVG, the source of its numbers among its metadata; the same numbers give the same file."""
    figure.savefig(path, metadata={"Date": None, "Description": source or None})
    plt.close(figure)
