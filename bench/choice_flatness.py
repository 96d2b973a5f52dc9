# SPDX-License-Identifier: MPL-2.0
"""How flat the choice among models is: python bench/choice_flatness.py results/tradeoff-DATE.csv

For every scene and tolerance of what bench_tradeoff measured, the model is chosen again with the costs of one model
after the other multiplied by a factor. Printed: the share of choices whose measured time is within a factor of 2 of the
cheapest that keeps the tolerance, for the model where that share is the least.
"""

import csv
import sys
from collections import defaultdict
from pathlib import Path

FACTORS = (0.125, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0)


def read(path):
    """Rows by scene, links, modes and inclination."""
    scenes = defaultdict(list)
    with path.open(encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["took_us"]:
                names = ("loosest", "tightest", "bound", "predicted_us", "took_us")
                key = row["scene"], row["links"], row["modes"], row["inclination"]
                scenes[key].append((row["model"], *(float(row[name]) for name in names)))
    return scenes


def share(scenes, slower, factor):
    """Of the choices, with the predicted cost of the model `slower` multiplied, those within a factor of 2."""
    good = asked = 0
    for rows in scenes.values():
        for digits in range(16):
            rtol = 10.0**-digits
            keeping = [row for row in rows if row[2] <= rtol <= row[1] and row[3] <= rtol]
            if len(keeping) < 2:
                continue
            chosen = min(keeping, key=lambda row: row[4] * (factor if row[0] == slower else 1))
            asked += 1
            good += chosen[5] <= 2 * min(row[5] for row in keeping) or chosen[5] < 0.2
    return good / asked


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    scenes = read(Path(sys.argv[1]))
    models = sorted({row[0] for rows in scenes.values() for row in rows})
    for factor in FACTORS:
        least, model = min((share(scenes, model, factor), model) for model in models)
        print(f"costs x {factor:<5g}: {100 * least:.1f} % within a factor of 2 of the cheapest, least of {model}")


if __name__ == "__main__":
    main()
