# SPDX-License-Identifier: MPL-2.0
"""Pictures of what bench_tradeoff measured: python bench/plot_tradeoff.py results/tradeoff-DATE.csv [FOLDER]

Writes tradeoff.png (kinds of chain by number of links) and tradeoff_readme.png (two of them, with words) into FOLDER, else
beside the file, and prints the table of docs/models.md; of a quick run the first picture alone. Needs matplotlib.
"""

import csv
import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import matplotlib.ticker
from PIL import Image  # comes with matplotlib

FLOOR = 1e-34  # of the error axis: exact results are drawn here
# Colours that colour-blind readers tell apart (Okabe and Ito): closed and asymptotic formulas warm, numbers cold.
STYLE = {
    "closed forms": ("#B8860B", "s"),
    "Laguerre asymptotics": ("#CC79A7", "v"),
    "continuous chain": ("#D55E00", "o"),
    "tapered chain": ("#7B3FA0", "h"),
    "coarse chain": ("#009E73", "D"),
    "single precision": ("#332288", "<"),
    "aberth": ("#56B4E9", "P"),
    "interpolated": ("#0072B2", "X"),
    "condensed": ("#0072B2", "o"),
    "bisection": ("#999999", "^"),
    "dense": ("#444444", "p"),
    "double-double": ("#000000", "D"),
    "finite amplitude": ("#7B3FA0", "*"),
}
ROWS = (("equal plummets", 0.0), ("equal rods", 0.0), ("random rods", 0.0), ("heavy tip", 0.0), ("equal rods", 0.3))
SIZES = ((5, 100, 1000, 100_000), (5, 10, 100, 1000))  # hanging straight; at an inclination
TABLE = (1e-2, 1e-6, 1e-12, 1e-15, 1e-20)  # tolerances
TITLE = {"heavy tip": "rods, weights $10^{12}$ … 1 upward"}
# Where names stand in the picture for the README: points to the right and up, which end, of the tightest answer or the loosest.
ANNOTATED = {
    "continuous chain": (12, -1, "left", min),
    "coarse chain": (-3, -13, "left", max),
    "single precision": (-3, 20, "left", max),
    "bisection": (-10, 13, "right", min),
    "condensed": (12, 1, "left", min),
    "aberth": (10, -9, "left", min),
    "double-double": (14, 15, "right", min),
    "dense": (0, 12, "center", min),
}
plt.rcParams.update(
    {
        "font.size": 10,
        "axes.titlesize": 10.5,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "legend.frameon": False,
        "savefig.dpi": 130,
        "axes.axisbelow": True,
    }
)


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
            points.setdefault(key, []).append(Point(row["model"], *numbers, bool(row["chosen_from"])))
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
    axis.xaxis.set_minor_locator(matplotlib.ticker.NullLocator())
    axis.yaxis.set_minor_locator(matplotlib.ticker.NullLocator())


def save(figure, path):
    figure.savefig(path)
    plt.close(figure)
    Image.open(path).convert("RGB").quantize(256).save(path, optimize=True)  # half the size


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
            label="chosen by select for some tolerance",
        )
    )
    handles.append(plt.Line2D([], [], color="#0072B2", alpha=0.6, linewidth=1.1, label="from the error to its bound"))
    handles.append(plt.Line2D([], [], color="0.75", linewidth=1.8, label="least time for a bound"))
    return handles


def every_kind(points, source):
    figure, axes = plt.subplots(
        len(ROWS), 4, figsize=(13, 2.75 * len(ROWS) + 1.3), sharex=True, sharey=True, layout="constrained"
    )
    models = set()
    for line, (kind, inclination) in zip(axes, ROWS):
        for axis, links in zip(line, SIZES[inclination > 0]):
            here = points.get((kind, links, 3, inclination), [])
            models |= {point.model for point in here}
            draw(axis, here)
            lean = f" at {inclination:g} rad" if inclination else ""
            axis.set_title(f"{links:,} {TITLE.get(kind, kind)}{lean}")
        line[0].set_ylabel("CPU time, µs")
    for axis in axes[-1]:
        axis.set_xlabel("worst relative error of the heights")
    axes[0, 0].set_xlim(30, 1e-34)
    axes[0, 0].set_ylim(0.04, 2e6)
    axes[0, 0].set_xticks([10.0**-e for e in range(0, 33, 8)])
    axes[0, 0].set_yticks([10.0**e for e in range(-1, 7)])
    figure.legend(handles=key_handles(models), loc="outside lower center", ncols=4)
    figure.suptitle(
        "What digits cost: every model, the three slowest modes, tolerances 1 to $10^{-26}$ (right is more "
        "accurate, down is faster)",
        fontsize=12,
    )
    figure.text(0.995, 0.002, source, ha="right", fontsize=6.5, color="0.5")
    return figure


def for_readme(points, source):
    shown = {"1,000 random rods": ("random rods", 1000, 3, 0.0), "100 equal rods": ("equal rods", 100, 3, 0.0)}
    figure, axes = plt.subplots(1, 2, figsize=(10, 4.2), sharey=True, layout="constrained", width_ratios=(1, 1))
    for axis, (title, key) in zip(axes, shown.items()):
        draw(axis, points[key], size=7.5)
        for model in dict.fromkeys(point.model for point in points[key]):
            place = ANNOTATED.get(model, (0, 10, "center", min))
            at = place[3]((p for p in points[key] if p.model == model), key=lambda p: (p.bound, -p.us))
            colour = style(model)[0]
            axis.annotate(
                model,
                (max(at.error, FLOOR), at.us),
                xytext=place[:2],
                ha=place[2],
                color=colour,
                textcoords="offset points",
                fontsize=9.5,
                va="center",
            )
        axis.set_title(title)
        axis.set_xlabel("worst relative error of the three slowest heights")
        least = min(point.error for point in points[key])
        axis.set_xlim(20, least / 1e2)
        axis.set_xticks([10.0**-e for e in range(0, 33, 4) if 10.0**-e > least / 1e2])
    axes[0].set_ylabel("CPU time, µs")
    axes[0].set_ylim(0.04, 5e5)
    axes[0].set_yticks([10.0**e for e in range(-1, 6)])
    figure.legend(handles=key_handles(set()), loc="outside lower center", ncols=3)
    figure.text(0.995, 0.003, source, ha="right", fontsize=6, color="0.6")
    return figure


def table(points):
    """The cheapest model that keeps a tolerance, and its time, as Markdown."""
    chains = [(kind, links, 0.0) for kind in ("equal plummets", "equal rods", "random rods") for links in SIZES[0]]
    chains += [(kind, 100, 0.3) for kind in ("equal rods", "random rods")]
    lines = ["| three slowest modes of | " + " | ".join(f"to {rtol:g}" for rtol in TABLE) + " |", "|---" * 6 + "|"]
    for kind, links, inclination in chains:
        cells = [f"{links:,} {kind}" + (f", {inclination:g} rad" if inclination else "")]
        for rtol in TABLE:
            good = [point for point in points[kind, links, 3, inclination] if point.bound <= rtol]
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
    source = "; ".join(comments[:3])
    save(every_kind(points, source), folder / "tradeoff.png")
    if max(links for _, links, _, _ in points) < max(SIZES[0]):
        return  # a quick run
    save(for_readme(points, source), folder / "tradeoff_readme.png")
    print(table(points))


if __name__ == "__main__":
    main()
