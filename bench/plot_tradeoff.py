# SPDX-License-Identifier: MPL-2.0
"""Picture of what bench_tradeoff measured: python bench/plot_tradeoff.py results/tradeoff-DATE.csv [FOLDER]

Writes tradeoff.svg into FOLDER, else beside the file, and prints the table of docs/models.md. Needs matplotlib.
"""

import csv
import sys
from dataclasses import dataclass
from pathlib import Path

from picture import ACCURATE, WIDTH, decades, plt, save

FLOOR = 1e-34  # of the error axis: exact results are drawn here
# Colours that colour-blind readers tell apart (Okabe and Ito): closed and asymptotic formulas warm, numbers cold.
STYLE = {
    "closed forms": ("#B8860B", "s"),
    "Laguerre asymptotics": ("#CC79A7", "v"),
    "continuous chain": ("#D55E00", "o"),
    "tapered chain": ("#7B3FA0", "h"),
    "coarse chain": ("#009E73", "D"),
    "aberth": ("#56B4E9", "P"),
    "interpolated": ("#0072B2", "X"),
    "condensed": ("#0072B2", "o"),
    "bisection": ("#999999", "^"),
    "dense": ("#444444", "p"),
    "double-double": ("#000000", "D"),
    "finite amplitude": ("#7B3FA0", "*"),
}
FORMER = {  # names in files of before 2026-11-23
    "all together": "aberth",
    "interpolated spectrum": "interpolated",
    "compressed blocks": "condensed",
    "element bisection": "bisection",
}
MODES = 3
PANELS = [  # kind, links, inclination
    *(("equal rods", 100, 0.0), ("equal rods", 100_000, 0.0), ("random rods", 100, 0.0), ("random rods", 100_000, 0.0)),
    *(("heavy tip", 100, 0.0), ("equal rods", 100, 0.3)),
]
SIZES = (5, 100, 1000, 100_000)
TABLE = (1e-2, 1e-6, 1e-12, 1e-15, 1e-20)  # tolerances
TITLE = {"heavy tip": "rods, weights $10^{12}$ … 1 upward"}


@dataclass(frozen=True)
class Point:
    """One answer of a model."""

    model: str
    error: float
    bound: float
    us: float
    chosen: bool


def read(path):
    """Points by (scene, links, modes, inclination); and the comments, which say how they arose."""
    with path.open(encoding="utf-8") as file:
        lines = file.read().splitlines()
    points = {}
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        if row["took_us"]:
            key = row["scene"], int(row["links"]), int(row["modes"]), float(row["inclination"])
            numbers = (float(row[name]) for name in ("error", "bound", "took_us"))
            points.setdefault(key, []).append(Point(FORMER.get(row["model"], row["model"]), *numbers, bool(row["chosen_from"])))
    return points, [line[2:] for line in lines if line.startswith("# ") and "SPDX" not in line]


def style(model):
    return STYLE.get(model, ("#444444", "p"))


def front(points):
    """Corners of the least time in which each bound can be had, from the loosest on."""
    corners, least = [], float("inf")
    for point in sorted(points, key=lambda p: p.bound):  # the tightest first: looser ones must be faster
        if point.us < least:
            corners.append((max(point.bound, FLOOR), point.us))
            least = point.us
    return corners[::-1]


def draw(axis, points, size=6.0):
    corners = front(points)
    if corners:
        start, end = (1e3, corners[0][1]), (corners[-1][0], 1e12)  # from no digits at all; beyond the last, at no price
        axis.step(*zip(start, *corners, end), where="pre", color="0.75", linewidth=1.8, zorder=1)
    for point in points:
        colour, marker = style(point.model)
        error = max(point.error, FLOOR)
        axis.plot([error, max(point.bound, FLOOR)], [point.us] * 2, color=colour, alpha=0.45, linewidth=1.1, zorder=2)
        axis.plot(error, point.us, marker, color=colour, markersize=size, markeredgewidth=0, zorder=3)
        if point.chosen:
            axis.plot(
                error,
                point.us,
                "o",
                color="black",
                markersize=size + 5,
                markerfacecolor="none",
                markeredgewidth=0.9,
                zorder=4,
            )
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(True, which="major", color="0.93")


def key_handles(models):
    handles = [
        plt.Line2D(
            [],
            [],
            linestyle="",
            marker=style(model)[1],
            color=style(model)[0],
            markersize=6.5,
            markeredgewidth=0,
            label=model,
        )
        for model in [*STYLE, *sorted(models - set(STYLE))]
        if model in models
    ]
    handles.append(
        plt.Line2D(
            [],
            [],
            linestyle="",
            marker="o",
            color="black",
            markersize=11,
            markerfacecolor="none",
            markeredgewidth=0.9,
            label="taken for some tolerance",
        )
    )
    handles.append(plt.Line2D([], [], color="#0072B2", alpha=0.6, linewidth=1.1, label="from the error to its bound"))
    handles.append(plt.Line2D([], [], color="0.75", linewidth=1.8, label="shortest time for a bound"))
    return handles


def picture(points):
    """A panel for each kind of chain; of a quick run those it has."""
    shown = [panel for panel in PANELS if (panel[0], panel[1], MODES, panel[2]) in points]
    figure, axes = plt.subplots(
        -(-len(shown) // 2), 2, figsize=(WIDTH, 2.9 * -(-len(shown) // 2) + 1.8), sharex=True, sharey=True, layout="constrained"
    )
    models = set()
    for (kind, links, inclination), axis in zip(shown, axes.flat):
        here = points[kind, links, MODES, inclination]
        models |= {point.model for point in here}
        draw(axis, here)
        lean = f" at {inclination:g} rad" if inclination else ""
        axis.set_title(f"{links:,} {TITLE.get(kind, kind)}{lean}")
    axes.flat[0].set_xlim(30, 1e-34)
    axes.flat[0].set_ylim(0.04, 2e6)
    decades(axes.flat[0].xaxis, -32, 0, 8)
    decades(axes.flat[0].yaxis, -1, 6, 1)
    for axis in axes.flat[len(shown) - 2 : len(shown)]:
        axis.set_xlabel(ACCURATE)
    figure.supylabel("CPU time (µs); faster is lower", fontsize="medium")
    figure.legend(handles=key_handles(models), loc="outside lower center", ncols=3)
    return figure


def table(points):
    """The cheapest model that keeps a tolerance, and its time, as Markdown."""
    chains = [(kind, links, 0.0) for kind in ("equal plummets", "equal rods", "random rods") for links in SIZES]
    chains += [(kind, 100, 0.3) for kind in ("equal rods", "random rods")]
    lines = ["| three slowest modes of | " + " | ".join(f"to {rtol:g}" for rtol in TABLE) + " |", "|---" * 6 + "|"]
    for kind, links, inclination in chains:
        cells = [f"{links:,} {kind}" + (f", {inclination:g} rad" if inclination else "")]
        for rtol in TABLE:
            good = [point for point in points[kind, links, MODES, inclination] if point.bound <= rtol]
            best = min(good, key=lambda point: point.us, default=None)
            cells.append(f"{best.model}, {time_text(best.us)}" if best else "-")
        lines.append("| " + " | ".join(cells) + " |")
    return "\n".join(lines)


def time_text(us):
    """Two digits."""
    number, unit = (us / 1e3, "ms") if us >= 1000 else (us, "µs")
    return f"{float(f'{number:.2g}'):g} {unit}"


def main():
    if len(sys.argv) not in (2, 3):
        sys.exit(__doc__)
    path = Path(sys.argv[1])
    folder = Path(sys.argv[2]) if len(sys.argv) == 3 else path.parent
    points, comments = read(path)
    save(picture(points), folder / "tradeoff.svg", "; ".join(comments[:3]))
    if max(links for _, links, _, _ in points) == max(SIZES):  # not of a quick run
        print(table(points))


if __name__ == "__main__":
    main()
