# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the figure of paper.md and print its numbers: python figure.py FILE (.svg or .pdf)."""

import sys

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from scipy.linalg import eigh_tridiagonal, svd

import revchain as rc

matplotlib.rcParams.update(
    {
        "font.size": 8,
        "axes.titlesize": 8,
        "legend.fontsize": 7,
        "legend.title_fontsize": 7,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "svg.hashsalt": "revchain",
    }
)
BLUE, ORANGE, GREEN, RED = "#0072B2", "#E69F00", "#009E73", "#D55E00"  # Okabe, Ito
STYLES = {"minimum": "-", "spectrally stable": "--", "unstable": ":"}
SOLVERS = {  # of panel (c): mark and colour
    "matrix, bisection": ("s--", RED),
    "matrix, MRRR": ("^-.", ORANGE),
    "factor, SVD": ("v:", GREEN),
    "revchain": ("o-", BLUE),
    "proved bound": ("_", "k"),
}
SPEED, FASTEST = 13.8, 16.0  # rad/s: of the shapes; the end of the diagram


def shapes(axes, chain):
    """Draw all shapes at one speed, to scale."""
    found = rc.steady_shapes(chain, angular_speed=SPEED)
    print(f"{len(found)} shapes at {SPEED} rad/s, complete: {found.complete}")
    places = [(0.0, 0.75), (0.0, 0.0), (1.25, 0.0), (2.2, 0.0), (3.0, 0.0)]
    for number, (shape, (x, y)) in enumerate(zip(found, places, strict=True), 1):
        below = np.append(np.cumsum(np.cos(shape.inclination[::-1]))[::-1], 0.0)  # depths of the pins; each link is 1 m
        offset = shape.offset if number != 2 else -shape.offset  # its mirror image, which is the same shape
        colour = BLUE if number <= 3 else RED
        axes.plot([x, x], [y, y - 2.1 if y == 0 else y - 0.2], color="0.6", lw=0.7, ls="-.")
        axes.plot(x + offset, y - below, "-", color=colour, lw=1.2, zorder=3)
        axes.plot(x + offset[:-1], y - below[:-1], "o", color=colour, ms=4, zorder=3)
        axes.plot(x, y, "^", color="k", ms=4, zorder=4)
        axes.text(x, -2.15 if y == 0 else y + 0.12, number, ha="center", va="top" if y == 0 else "bottom")
        print(f"  {number}: free end {below[0]:.3f} m below the support, {shape.stability().verdict}")
    for verdict, style in STYLES.items():
        axes.plot([], [], style, color="k", lw=1.3, label=verdict)
    axes.legend(
        title="lines in (b)", frameon=False, loc="lower center", bbox_to_anchor=(0.5, -0.08), ncols=3, handlelength=1.7,
        columnspacing=1.0,
    )
    axes.set(xlim=(-1.1, 3.6), ylim=(-3.2, 1.1), title=f"(a) all shapes at {SPEED} rad/s")
    axes.set_aspect("equal")
    axes.axis("off")


def diagram(axes, chain):
    """Draw all branches. The style of a line is the stability."""
    found = rc.branches(chain, max_angular_speed=FASTEST)
    for branch in found:
        isolated, part = branch.mode is None, 0
        for window in branch.stability_windows():
            start, end = window.angular_speed
            speeds = start + (end - start) * np.linspace(0, 1, 80)[1:-1] ** 2
            depths = [np.cos(branch.at(speed)[part].inclination).sum() for speed in speeds]
            if start == branch.angular_speed.min() and not isolated:  # the straight chain
                speeds, depths = np.append(start, speeds), [3.0, *depths]
            axes.plot(speeds, depths, STYLES[window.verdict], color=RED if isolated else BLUE, lw=1.3)
            part += window.change == "fold"
        name = "isolated branch" if isolated else f"branch of mode {branch.mode}"
        print(f"  {name} from {branch.angular_speed.min():.4f} rad/s")
    print(f"{len(found)} branches to {FASTEST} rad/s, complete: {found.complete}")
    for number, shape in enumerate(rc.steady_shapes(chain, angular_speed=SPEED), 1):
        axes.plot(SPEED, np.cos(shape.inclination).sum(), "o", color="k", ms=2.5, zorder=3)
        side = {"va": "top"} if number in (1, 3) else {"va": "bottom"}
        axes.text(SPEED + 0.2, np.cos(shape.inclination).sum(), number, fontsize=7, **side)
    axes.plot([SPEED, SPEED], [0, 2.15], color="0.7", lw=0.7, zorder=0)
    axes.set(xlabel="speed (rad/s)", ylabel="depth of the free end (m)", xlim=(0, FASTEST), ylim=(3.1, 0))
    axes.set_title("(b) all branches")


def errors(axes):
    """Draw the relative error of the height of the slowest mode of random point masses, against the double-double result."""
    sizes, rows = [10, 30, 100, 300, 1000, 3000, 10_000], []
    rng = np.random.default_rng(1908)
    for size in sizes:
        weight, length = rng.uniform(0.5, 1.5, (2, size))
        chain = rc.Chain(weight=weight, length=length)
        exact = rc.modes(chain, 1, precision="double-double")
        high, low = exact.conical_height[0], exact.conical_height_low[0]
        pull = np.cumsum(weight) / length
        diagonal = (pull + np.append(0.0, pull[:-1])) / weight
        side = -pull[:-1] / np.sqrt(weight[:-1] * weight[1:])
        row = []
        for driver in ("stebz", "stemr"):
            value = eigh_tridiagonal(diagonal, side, True, "i", (0, 0), lapack_driver=driver)[0]
            row.append(abs(value * high - 1))
        if size <= 1000:  # the scaled matrix is factor.T @ factor; a dense solver is slow for more
            factor = np.diag(np.sqrt(pull / weight)) - np.diag(np.sqrt(pull[:-1] / weight[1:]), 1)
            row.append(abs(svd(factor, compute_uv=False, lapack_driver="gesvd")[-1] ** 2 * high - 1))
        else:
            row.append(np.nan)
        ours = rc.modes(chain, 1)
        row += [abs((ours.conical_height[0] - high) - low) / high, ours.error_bound[0]]
        rows.append(row)
        print(f"  {size:6} point masses:", *(f"{name} {error:.1e}" for name, error in zip(SOLVERS, row, strict=True)))
    for name, error, (mark, colour) in zip(SOLVERS, np.transpose(rows), SOLVERS.values(), strict=True):
        axes.loglog(sizes, error, mark, color=colour, lw=1.2, ms=7 if mark == "_" else 4, label=name)
    axes.set(xlabel="number of links", ylabel="relative error", ylim=(1e-18, 1e-2), title="(c) slowest conical height")
    axes.legend(frameon=False, loc="upper left", labelspacing=0.25)


def main():
    chain = rc.Chain(mass=[1, 1, 1], length=1.0)  # kg and m
    figure = Figure(figsize=(7.0, 2.4), layout="constrained")
    left, middle, right = figure.subplots(1, 3, width_ratios=[1.25, 1, 1])
    shapes(left, chain)
    diagram(middle, chain)
    errors(right)
    name = sys.argv[1]
    figure.savefig(name, dpi=200, metadata={"Date" if name.endswith(".svg") else "CreationDate": None})


if __name__ == "__main__":
    main()
