# SPDX-License-Identifier: MPL-2.0
"""Pictures of what bench_convergence measured: python bench/plot_convergence.py results/convergence-DATE.csv

Writes convergence-DATE.svg (relative difference against the number of links) and convergence-DATE-coefficients.svg (the
same times N^2, where the laws lie on level lines) beside the file. Needs numpy and matplotlib.
"""

import csv
import sys
from pathlib import Path

import numpy as np
from picture import WIDTH, decades, plt, save

MODES = (1, 2, 3)
# Colours that colour-blind readers tell apart (Okabe and Ito).
STYLE = {
    "lower pins": ("#000000", "o"),
    "l = a": ("#0072B2", "s"),
    "l = 5a/6": ("#56B4E9", "P"),
    "l = 3a/4": ("#009E73", "D"),
    "cell centres": ("#999999", "X"),
    "cell centres, half thread": ("#CC79A7", "v"),
    "rods": ("#D55E00", "o"),
    "l = a/2": ("#B8860B", "^"),
    "shifted ends": ("#7B3FA0", "h"),
}
OVERVIEW = ("lower pins", "l = a", "rods", "l = 3a/4", "shifted ends")


def read(path):
    """Curves by (cutting, mode), dictionaries of columns; and the second comment line, which says how they arose."""
    with path.open(encoding="utf-8") as file:
        lines = file.read().splitlines()
    comments = [line[2:] for line in lines if line.startswith("#")]
    curves = {}
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        curve = curves.setdefault((row["cutting"], int(row["mode"])), {"description": row["description"]})
        for name, value in row.items():
            if name not in ("cutting", "description"):
                curve.setdefault(name, []).append(float(value) if value else np.nan)
    for curve in curves.values():
        curve.update({name: np.array(values) for name, values in curve.items() if name != "description"})
    return curves, comments[1]


def overview(curves):
    figure, axes = plt.subplots(1, 3, figsize=(WIDTH, 6.6), sharex=True, sharey=True, layout="constrained")
    floor = max(curve["error_bound"].max() for curve in curves.values())
    for mode, ax in zip(MODES, axes):
        for name in OVERVIEW:
            curve = curves[name, mode]
            colour, marker = STYLE[name]
            order = int(curve["order"][0])
            n = np.geomspace(2, 2e5, 50)
            ax.loglog(n, abs(curve["law_coefficient"][0]) * n**-order, color=colour, linewidth=1, alpha=0.6, zorder=1)
            above = curve["difference"] > 0
            for which, face in ((above, colour), (~above, "white")):
                ax.loglog(curve["links"][which], abs(curve["difference"][which]), marker, color=colour, markersize=5.5,
                          markerfacecolor=face, markeredgewidth=1.3, zorder=2)
        ax.axhspan(1e-18, floor, color="0.88", zorder=0)
        ax.set_title(f"mode {mode}" + (" (the slowest)" if mode == 1 else ""))
        ax.set_xlabel("number of links $N$")
        ax.grid(True, which="major", color="0.93", zorder=0)
    axes[0].text(1.3, floor / 1.6, "below the proved bound", va="top", fontsize="small", color="0.35")
    axes[0].set_ylabel(r"relative difference of the conical height,  $|\lambda_N / \lambda_\infty - 1|$")
    decades(axes[0].xaxis, 0, 5, 1)
    axes[0].set_xlim(0.8, 2e5)
    axes[0].set_ylim(3e-17, 10)

    handles = [plt.Line2D([], [], color=STYLE[n][0], marker=STYLE[n][1], linewidth=1,
                          label=f"{curves[n, 1]['description']}:  $\\propto N^{{-{int(curves[n, 1]['order'][0])}}}$")
               for n in OVERVIEW]
    handles += [plt.Line2D([], [], color="0.3", linewidth=1, label="line: the law (the steepest: fitted)"),
                plt.Line2D([], [], color="0.3", marker="o", linestyle="", label="filled: the height is too large"),
                plt.Line2D([], [], color="0.3", marker="o", linestyle="", markerfacecolor="white",
                           label="hollow: the height is too small")]
    figure.legend(handles=handles, loc="outside lower center", ncols=2, fontsize="small")
    figure.suptitle("heights of a uniform chain cut into $N$ links", fontsize="large")
    return figure


def spread(places, gap):
    """Label places, ascending order kept, at least `gap` apart."""
    order = np.argsort(places)
    result = np.array(places, dtype=float)
    for _ in range(200):
        for low, high in zip(order, order[1:]):
            lack = gap - (result[high] - result[low])
            if lack > 0:
                result[low] -= lack / 2
                result[high] += lack / 2
    return result


def coefficients(curves):
    figure, axes = plt.subplots(1, 3, figsize=(WIDTH, 6), sharex=True, layout="constrained")
    names = [name for name in STYLE if curves[name, 1]["order"][0] == 2]
    for mode, ax in zip(MODES, axes):
        laws = [curves[name, mode]["law_coefficient"][0] for name in names]
        reach = max(laws) - min(laws)
        for name, law in zip(names, laws):
            curve = curves[name, mode]
            colour, marker = STYLE[name]
            scale = curve["length_in_links"] ** 2
            ax.axhline(law, color=colour, linewidth=1, alpha=0.6, zorder=1)
            ax.plot(curve["links"], curve["difference"] * scale, marker, color=colour, markersize=5, zorder=2)
        bottom, top = min(laws) - 0.12 * reach, max(laws) + 0.12 * reach
        for name, law, place in zip(names, laws, spread(laws, 0.05 * (top - bottom))):
            ax.annotate(f"{law:.4g}".replace("-", "\N{MINUS SIGN}"), (1.6e5, law), xytext=(3.2e5, place), color=STYLE[name][0], fontsize="small", va="center",
                        annotation_clip=False, arrowprops={"arrowstyle": "-", "color": STYLE[name][0], "linewidth": 0.6})
        ax.axhline(0, color="0.5", linewidth=0.8, linestyle=":")
        ax.set_xscale("log")
        ax.set_xlim(0.8, 1.6e5)
        decades(ax.xaxis, 0, 5, 1)
        ax.set_ylim(bottom, top)
        ax.set_title(f"mode {mode}" + (" (the slowest)" if mode == 1 else ""))
        ax.set_xlabel("number of links $N$")
        ax.yaxis.set_major_formatter(lambda x, _: f"{x:g}".replace("-", "\N{MINUS SIGN}"))
    axes[0].set_ylabel(r"$(\lambda_N / \lambda_\infty - 1)\,N^2$")
    note = {"cell centres": r",  times $(N+\frac{1}{2})^2$"}  # that chain is so much longer
    handles = [plt.Line2D([], [], color=STYLE[n][0], marker=STYLE[n][1], linewidth=1,
                          label=curves[n, 1]["description"] + note.get(n, "")) for n in names]
    figure.legend(handles=handles, loc="outside lower center", ncols=1, fontsize="small")
    figure.suptitle("cuttings of second order: points computed, lines and numbers the laws", fontsize="large")
    return figure


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    path = Path(sys.argv[1])
    curves, source = read(path)
    save(overview(curves), path.with_suffix(".svg"), source)
    save(coefficients(curves), path.with_name(path.stem + "-coefficients.svg"), source)


if __name__ == "__main__":
    main()
