# SPDX-License-Identifier: MPL-2.0
"""Picture of what bench_shape_convergence measured: python bench/plot_shape_convergence.py FILE.csv

Writes FILE.svg: the largest difference of the pins' offsets from the uncut chain, against the number of links, and the
observed order beneath. Needs matplotlib.
"""

import csv
import sys
from collections import defaultdict
from pathlib import Path

from picture import WIDTH, plt, save
from plot_convergence import STYLE

path = Path(sys.argv[1])
curves = defaultdict(lambda: ([], [], []))
with path.open(encoding="utf-8") as file:
    for row in csv.DictReader(line for line in file if not line.startswith("#")):
        links, difference, order = curves[row["cutting"], int(row["half_waves"])]
        links.append(int(row["links"]))
        difference.append(float(row["difference"]))
        order.append(float(row["order"] or "nan"))

figure, axes = plt.subplots(2, 2, figsize=(WIDTH, 7.5), sharex=True, sharey="row", layout="constrained",
                            height_ratios=(3, 2))
for (name, half_waves), (links, difference, order) in curves.items():
    if name not in STYLE:
        continue
    colour, marker = STYLE[name]
    column = axes[:, half_waves - 1]
    column[0].loglog(links, difference, color=colour, marker=marker, markersize=4, linewidth=1, label=name)
    column[1].semilogx(links, order, color=colour, marker=marker, markersize=4, linewidth=1)
for half_waves, column in enumerate(axes.T, 1):
    column[0].set_title(f"shape of {half_waves} half wave{'s' * (half_waves > 1)}")
    column[1].set(xlabel="number of links $N$", ylim=(0.8, 2.2))
    column[1].grid(axis="y", color="0.9")
axes[0, 0].set_ylabel("largest difference of an offset,\nover the length")
axes[1, 0].set_ylabel("observed order")
figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
figure.suptitle("shapes of a uniform chain ten conical heights long, cut into $N$ links", fontsize="large")
save(figure, path.with_suffix(".svg"))
