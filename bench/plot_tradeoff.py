# SPDX-License-Identifier: MPL-2.0
"""Picture of what bench_tradeoff measured: python bench/plot_tradeoff.py tradeoff.csv

Writes tradeoff.svg beside the file. Needs matplotlib.
"""

import csv
import sys
from dataclasses import dataclass
from pathlib import Path

from picture import ACCURATE, WIDTH, decades, plt, save

FLOOR = 1e-34  # of the error axis: exact results are drawn here
COLOURS = {  # that colour-blind readers tell apart (Okabe and Ito)
    "continuous chain": "#D55E00",
    "coarse chain": "#009E73",
    "aberth": "#56B4E9",
    "bisection": "#7B3FA0",
    "condensed": "#0072B2",
    "double-double": "#000000",
}
OTHERS, BOUNDS = "0.5", "0.7"  # grey dots, grey line
MODES = 3
PANELS = [(kind, links) for kind in ("equal rods", "random rods") for links in (100, 100_000)]


@dataclass(frozen=True)
class Point:
    """One answer of a model."""

    model: str
    error: float
    bound: float
    us: float


def read(path):
    """Points by (scene, links, modes, inclination)."""
    points = {}
    with path.open(encoding="utf-8") as file:
        for row in csv.DictReader(file):
            if row["took_us"]:
                key = row["scene"], int(row["links"]), int(row["modes"]), float(row["inclination"])
                numbers = (float(row[name]) for name in ("error", "bound", "took_us"))
                points.setdefault(key, []).append(Point(row["model"], *numbers))
    return points


def front(points):
    """The answers that no other one with as tight a bound beats in time, the loosest bound first."""
    fastest = []
    for point in sorted(points, key=lambda p: p.bound):  # the tightest first: looser ones must be faster
        if not fastest or point.us < fastest[-1].us:
            fastest.append(point)
    return fastest[::-1]


def draw(axis, points):
    """The fastest answers in colour, with names; the others as grey dots."""
    fastest = front(points)
    corners = [(max(point.bound, FLOOR), point.us) for point in fastest]
    start, end = (1e3, corners[0][1]), (corners[-1][0], 1e12)  # from no digits at all; beyond the last, at no price
    axis.step(*zip(start, *corners, end), where="pre", color=BOUNDS, linewidth=1.8, zorder=1)
    others = [point for point in points if point not in fastest]
    axis.plot([max(point.error, FLOOR) for point in others], [point.us for point in others], "o", color=OTHERS, markersize=3.5)
    named = set()
    for point in fastest:
        colour, error = COLOURS.get(point.model, "black"), max(point.error, FLOOR)
        axis.plot([error, max(point.bound, FLOOR)], [point.us] * 2, color=colour, linewidth=1.3, zorder=2)
        axis.plot(error, point.us, "o", color=colour, markersize=8, markeredgewidth=0, zorder=3)
        if point.model not in named:
            side, dx = ("left", -4) if error > 1e-20 else ("right", 4)
            label = {"textcoords": "offset points", "color": colour, "ha": side, "va": "top"}
            axis.annotate(point.model, (error, point.us), (dx, -8), **label)
        named.add(point.model)
    axis.set_xscale("log")
    axis.set_yscale("log")
    axis.grid(True, which="major", color="0.93")


def picture(points):
    """A panel for each kind of chain; of a quick run those it has."""
    shown = [panel for panel in PANELS if (*panel, MODES, 0.0) in points]
    rows = -(-len(shown) // 2)
    size = {"figsize": (WIDTH, 2.9 * rows + 0.4), "layout": "constrained"}
    figure, axes = plt.subplots(rows, 2, sharex=True, sharey=True, squeeze=False, **size)
    for (kind, links), axis in zip(shown, axes.flat):
        draw(axis, points[kind, links, MODES, 0.0])
        axis.set_title(f"{links:,} {kind}")
    first = axes.flat[0]
    first.set_xlim(30, 1e-34)
    first.set_ylim(0.02, 2e6)
    decades(first.xaxis, -32, 0, 8)
    decades(first.yaxis, 0, 6, 3)
    first.yaxis.set_major_formatter(lambda us, _: time_text(us))
    first.text(1e-1, 35, "other answers", color=OTHERS)
    first.text(3e-26, 2e5, "shortest time\nfor a bound", color=OTHERS, ha="right")
    for axis in axes[-1]:
        axis.set_xlabel(ACCURATE)
    figure.supylabel("CPU time, faster \N{DOWNWARDS ARROW}", fontsize="medium")
    return figure


def time_text(us):
    """Two digits."""
    number, unit = (us / 1e6, "s") if us >= 1e6 else (us / 1e3, "ms") if us >= 1e3 else (us, "µs")
    return f"{float(f'{number:.2g}'):g} {unit}"


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    path = Path(sys.argv[1])
    save(picture(read(path)), path.with_suffix(".svg"), "bench_tradeoff")


if __name__ == "__main__":
    main()
