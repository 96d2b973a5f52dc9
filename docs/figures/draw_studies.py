# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the studies of examples/studies: speeds of wheels against spin, a map over two ratios, scatter of a crane's periods.

python draw_studies.py writes studies.svg into the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import revchain as rc
from revchain.plots.modes import BACKWARD, FORWARD
from revchain.plots.programs import COLOURS, save

STUDIES = Path(__file__).resolve().parents[2] / "examples/studies"
RPM = 60 / (2 * np.pi)

figure = Figure(figsize=(8, 7.4), layout="constrained")
figure.get_layout_engine().set(hspace=0.08, wspace=0.08)
panels = figure.subplot_mosaic([["spun", "ratio"], ["scatter", "scatter"]], height_ratios=[1.3, 1])
spun, ratio, scatter = (panels[name] for name in ("spun", "ratio", "scatter"))

wheels = rc.sweep(STUDIES / "wheels_spun_up.toml")
for sense, way, colour in (("forward", 1, FORWARD), ("backward", -1, BACKWARD)):
    speeds = way * wheels[f"{sense}_angular_speed"].to_numpy() * RPM
    spun.plot(wheels["spin"] * RPM, speeds, color=colour)
    print(f"twelve wheels at 600 rpm, {sense}: " + ", ".join(f"{speed:.2f}" for speed in speeds[-1]) + " rpm")
spun.text(390, 195, "forward", color=FORWARD, ha="right")
spun.text(590, -50, "backward", color=BACKWARD, ha="right")
spun.axhline(0, color="0.6", linewidth=0.8)
spun.set(title="Twelve bicycle wheels spun up", xlabel="spin (rpm)", ylabel="whirl speed (rpm)", ylim=(-75, 250))

weights = rc.sweep(STUDIES / "two_weights.toml")
speed = weights["angular_speed"]
mass, length = "links[0].mass", "links[0].length"
closest = (speed.sel(mode=2) / speed.sel(mode=1)).transpose(length, mass)
lines = ratio.contour(closest[mass], closest[length], closest, levels=[1.2, 1.5, 2, 3, 5, 9, 16], colors=COLOURS[0])
for level in lines.levels:
    at = np.interp(level, closest[len(closest) // 2], closest[mass]), 1.0  # on this line, where lengths are equal
    ratio.text(*at, f"{level:g}", color=COLOURS[0], ha="center", va="center", bbox={"color": "white", "pad": 1})
ratio.set(title="Two weights: second speed over first", xscale="log", yscale="log")
ratio.set(xlabel="lower weight / upper weight", ylabel="lower length / upper length")
print(f"two weights: the second speed is at least {float(closest.min()):.3f} of the first")

crane = rc.sweep(STUDIES / "crane_scatter.toml")
for k, (name, at) in enumerate((("first", (1.9, 0.24)), ("second", (4.7, 0.07)))):
    periods = 2 * np.pi / crane["angular_speed"].to_numpy()[:, k]
    deviation = 100 * (periods / periods.mean() - 1)
    style = {"histtype": "step", "linewidth": 1.8} if k else {"histtype": "stepfilled", "alpha": 0.6}
    scatter.hist(deviation, np.linspace(-15, 15, 61), density=True, color=COLOURS[k], **style)
    scatter.text(*at, f"{name} mode, mean {periods.mean():.2f} s", color=COLOURS[k])
    print(f"crane, {name} mode: period {periods.mean():.3f} s, deviation {periods.std():.3f} s")
scatter.set(title="One crane, data varied 20,000 times by a few per cent", xlabel="deviation of the period from its mean (%)", yticks=[])
scatter.spines["left"].set_visible(False)
save(figure, "studies")
