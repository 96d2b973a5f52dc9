# SPDX-License-Identifier: MPL-2.0
"""Pictures of what bench/heights.py measured: python bench/plot_heights.py heights.csv

Writes, beside the file, heights-cost.svg (CPU time of the ten slowest modes against the number of links) and
heights-precision.svg (CPU time against error, all modes, for the tolerances). Needs matplotlib.
"""

import csv
import sys
from collections import defaultdict
from math import isfinite
from pathlib import Path

from picture import ACCURATE, WIDTH, decades, plt, save
from plan import KINDS

ULP = 2.0**-52
FLOOR = 1e-34  # of the error axis: exact results are drawn here
# Colours that colour-blind readers tell apart (Okabe and Ito): black and blues for this library, one hue a family.
STYLE = {
    "modes": ("#000000", "o"),
    "modes, from Python": ("#777777", "o"),
    "modes_dense": ("#777777", "P"),
    "modes_recurrence": ("#777777", "X"),
    "direct Newton": ("#D55E00", "o"),
    "direct, two points": ("#D55E00", "^"),
    "dstebz": ("#0072B2", "o"),
    "dstemr": ("#0072B2", "s"),
    "dsterf": ("#0072B2", "D"),
    "dlasq1": ("#0072B2", "P"),
    "dsbgv": ("#0072B2", "X"),
    "dsbgv, M first": ("#0072B2", "v"),
    "Eigen SelfAdjoint, dense": ("#009E73", "o"),
    "Eigen computeFromTridiagonal": ("#009E73", "^"),
    "Eigen GeneralizedSelfAdjoint": ("#009E73", "s"),
    "Spectra shift-invert": ("#CC79A7", "o"),
    "Spectra shift-invert, pencil": ("#CC79A7", "s"),
    "scipy eigh_tridiagonal": ("#B8860B", "o"),
    "scipy eigsh": ("#B8860B", "^"),
    "scipy eigsh, factored inverse": ("#B8860B", "s"),
}


def read(path):
    with path.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        row["links"], row["modes"] = int(row["links"]), int(row["modes"])
        row["ms"], row["error"] = float(row["cpu_seconds"]) * 1e3, float(row["error"])
        row["rtol"] = float(row["rtol"] or 0)
    return [row for row in rows if row["build"] != "portable" and isfinite(row["ms"])]


def curves(rows):
    """Points by method, from no tolerance asked to the loosest."""
    found = defaultdict(list)
    for row in sorted(rows, key=lambda row: row["rtol"]):
        found[row["method"]].append(row)
    return dict(sorted(found.items(), key=lambda item: list(STYLE).index(item[0]) if item[0] in STYLE else 99))


def style(name):
    return STYLE.get(name, ("#56B4E9", "h"))


def marks(points):
    """Filled for this library, hollow for the others."""
    colour, marker = style(points[0]["method"])
    ours = points[0]["family"] == "revchain"
    return {"color": colour, "marker": marker, "markersize": 5.5, "linewidth": 1, "markeredgewidth": 1.2,
            "markerfacecolor": colour if ours else "white"}


def explain(figure, drawn, title, key="filled: this library"):
    order = [*STYLE, *sorted(set(drawn) - set(STYLE))]
    handles = [plt.Line2D([], [], label=name, **drawn[name]) for name in order if name in drawn]
    figure.legend(handles=handles, loc="outside lower center", ncols=3, title=key)
    figure.suptitle(title, fontsize="large")
    return figure


def high(panels, entries):
    """Inches of a figure with so many rows of panels and so many entries of the legend."""
    return 2.6 * panels + 0.22 * -(-entries // 3) + 1.4


def work_precision(rows, links, which):
    kinds = [kind for kind in KINDS if any(row["kind"] == kind for row in rows)]
    lines = -(-len(kinds) // 2)
    size = (WIDTH, high(lines, len({row["method"] for row in rows})))
    figure, axes = plt.subplots(lines, 2, figsize=size, sharex=True, sharey=True, layout="constrained", squeeze=False)
    drawn = {}
    least = max(FLOOR, min(row["error"] for row in rows if isfinite(row["error"])))
    for axis in axes.flat[len(kinds):]:
        axis.remove()
    for kind, axis in zip(kinds, axes.flat):
        for name, points in curves([row for row in rows if row["kind"] == kind]).items():
            good = [(max(p["error"], FLOOR), p["ms"]) for p in points if isfinite(p["error"])]
            if good:
                drawn[name] = marks(points)
                axis.loglog(*zip(*good), **drawn[name])
        axis.axvline(ULP, color="0.6", linewidth=0.8, linestyle=":", zorder=0)
        axis.grid(True, which="major", color="0.93")
        axis.set_title(KINDS[kind])
        axis.tick_params(labelbottom=True)
    axes[0, 0].set_xlim(10, min(least, ULP) / 30)
    decades(axes[0, 0].xaxis, -36, 0, 4 if least > 1e-20 else 8)
    for axis in axes.flat[max(len(kinds) - 2, 0):len(kinds)]:
        axis.set_xlabel(ACCURATE)
    figure.supylabel("CPU time of one chain (ms); faster is lower", fontsize="medium")
    return explain(figure, drawn, f"{which} of {links:,} links", "filled: this library; dotted line: one ulp")


def cost(rows):
    """CPU time against the number of links, random plummets and rods, no tolerance asked."""
    shown = [row for row in rows if not row["rtol"] and row["links"] >= 10 and row["modes"] == 10 and row["kind"] in "CR"]
    size = (WIDTH, high(1.5, len({row["method"] for row in shown})))
    figure, axes = plt.subplots(1, 2, figsize=size, sharex=True, sharey=True, layout="constrained")
    drawn = {}
    for kind, axis in zip("CR", axes):
        for name, points in curves([row for row in shown if row["kind"] == kind]).items():
            points = sorted(points, key=lambda p: p["links"])
            drawn[name] = marks(points)
            axis.loglog([p["links"] for p in points], [p["ms"] for p in points], **drawn[name])
        axis.set_title(KINDS[kind])
        axis.set_xlabel("number of links $N$")
        axis.grid(True, which="major", color="0.93")
    axes[0].set_ylabel("CPU time of one chain (ms)")
    return explain(figure, drawn, "the ten slowest modes, no tolerance asked")


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    path = Path(sys.argv[1])
    rows = read(path)
    tolerances = defaultdict(set)
    for row in rows:
        if row["links"] == row["modes"]:
            tolerances[row["links"]].add(row["rtol"])
    links = max(tolerances, key=lambda n: (len(tolerances[n]), n))
    all_modes = [row for row in rows if row["links"] == row["modes"] == links]
    save(work_precision(all_modes, links, "all modes"), path.with_name("heights-precision.svg"), "bench/heights.py")
    save(cost(rows), path.with_name("heights-cost.svg"), "bench/heights.py")


if __name__ == "__main__":
    main()
