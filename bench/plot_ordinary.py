# SPDX-License-Identifier: MPL-2.0
"""The bars of README: time of the fastest NumPy or SciPy program over that of revchain.

    python bench/plot_ordinary.py ordinary.csv    writes ordinary.svg beside it
"""

import csv
import sys
from pathlib import Path

from picture import plt, save

KINDS = {"plummets, all modes with shapes": ("point masses", "#0072b2"), "rods, all modes with shapes": ("rods", "#d55e00")}
SIZES = (2, 8, 20, 100, 300, 1000, 3000)


def read(path):
    with open(path, encoding="utf-8") as file:
        return {(row["job"], int(row["N"])): float(row["ratio"]) for row in csv.DictReader(file) if row["ratio"]}


def main(source):
    ratio = read(source)
    sizes = [n for n in SIZES if all((job, n) in ratio for job in KINDS)]
    figure, axes = plt.subplots(figsize=(8, 2.9), layout="constrained")
    for k, (job, (name, colour)) in enumerate(KINDS.items()):
        x = [i + (k - 0.5) * 0.4 for i in range(len(sizes))]
        high = [ratio[job, n] for n in sizes]
        bars = axes.bar(x, [each - 1 for each in high], 0.38, bottom=1, color=colour, label=name)
        axes.bar_label(bars, [f"{each:.1f}" if each < 10 else f"{each:.0f}" for each in high], padding=2, fontsize=9)
    slowest = ratio.get(("ten slowest of a million, heights alone", 10**6), 1.0)  # a quick run has none
    bars = axes.bar([len(sizes)], [slowest - 1], 0.38, bottom=1, color=KINDS["plummets, all modes with shapes"][1])
    axes.bar_label(bars, [f"{slowest:.0f}"], padding=2, fontsize=9)
    axes.axhline(1, color="#595959", linewidth=1)
    axes.set_yscale("log")
    axes.set_ylim(0.4, 3 * max(ratio.values()))
    axes.set_yticks([1, 10, 100], ["as long", "10 times", "100 times"])
    axes.minorticks_off()
    axes.set_xticks(range(len(sizes) + 1), [*(f"{n:,}" for n in sizes), "1,000,000:\n10 slowest"])
    axes.tick_params(length=0)
    axes.set_xlabel("links")
    axes.set_title("Time that the fastest NumPy or SciPy program takes, over that of revchain: all modes", loc="left")
    axes.legend(loc="upper left")
    save(figure, Path(source).with_suffix(".svg"), "bench/ordinary.py")


if __name__ == "__main__":
    main(*sys.argv[1:])
