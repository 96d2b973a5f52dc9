# SPDX-License-Identifier: MPL-2.0
"""Picture of what bench_convergence measured: python bench/plot_convergence.py convergence.csv

Writes convergence.svg beside the file: the relative difference against the number of links. Needs matplotlib.
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
    "rods": ("#D55E00", "o"),
    "l = 3a/4": ("#009E73", "D"),
    "shifted ends": ("#7B3FA0", "h"),
}


def read(path):
    """Curves by (cutting, mode), dictionaries of columns."""
    curves = {}
    with path.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            curve = curves.setdefault((row["cutting"], int(row["mode"])), {"description": row["description"]})
            for name, value in row.items():
                if name not in ("cutting", "description"):
                    curve.setdefault(name, []).append(float(value))
    for curve in curves.values():
        curve.update({name: np.array(values) for name, values in curve.items() if name != "description"})
    return curves


def overview(curves):
    figure, axes = plt.subplots(1, 3, figsize=(WIDTH, 6.6), sharex=True, sharey=True, layout="constrained")
    floor = max(curve["error_bound"].max() for curve in curves.values())
    for mode, ax in zip(MODES, axes):
        for name in STYLE:
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
               for n in STYLE]
    handles += [plt.Line2D([], [], color="0.3", linewidth=1, label="line: the law (the steepest: fitted)"),
                plt.Line2D([], [], color="0.3", marker="o", linestyle="", label="filled: the height is too large"),
                plt.Line2D([], [], color="0.3", marker="o", linestyle="", markerfacecolor="white",
                           label="hollow: the height is too small")]
    figure.legend(handles=handles, loc="outside lower center", ncols=2, fontsize="small")
    figure.suptitle("heights of a uniform chain cut into $N$ links", fontsize="large")
    return figure


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    path = Path(sys.argv[1])
    save(overview(read(path)), path.with_suffix(".svg"), "bench_convergence")


if __name__ == "__main__":
    main()
