# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the studies of examples/studies: speeds of wheels against spin, a map over two ratios, scatter of a crane's periods.

python draw_studies.py writes studies.svg into the current folder.
"""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

import revchain as rc
from revchain.plots.programs import COLOURS, save
from revchain.plots.style import legend_outside

STUDIES = Path(__file__).resolve().parent.parent / "studies"
RPM = 60 / (2 * np.pi)

figure = Figure(figsize=(8, 7), layout="constrained")
panels = figure.subplot_mosaic([["spun", "ratio"], ["scatter", "scatter"]], height_ratios=[1.3, 1])
spun, ratio, scatter = (panels[name] for name in ("spun", "ratio", "scatter"))

wheels = rc.sweep(STUDIES / "wheels_spun_up.toml")
for sense, colour in (("forward", COLOURS[0]), ("backward", COLOURS[3])):
    speeds = wheels[f"{sense}_angular_speed"].to_numpy() * RPM
    spun.plot(wheels["spin"] * RPM, speeds, color=colour)
    modes = {f"forward {k}": speed for k, speed in enumerate(speeds[-1], 1)} if sense == "forward" else {}
    for text, at in (modes or {"backward 1 to 3, from below": -24.0}).items():
        spun.annotate(text, (600, at), (-6, 4), textcoords="offset points", color=colour, ha="right")
    print(f"twelve wheels at 600 rpm, {sense}: " + ", ".join(f"{speed:.2f}" for speed in speeds[-1]) + " rpm")
spun.set(title="Twelve bicycle wheels spun up", xlabel="spin (rpm)", ylabel="whirl speed (rpm)", ylim=(-25, None))

weights = rc.sweep(STUDIES / "two_weights.toml")
speed = weights["angular_speed"]
mass, length = "links[0].mass", "links[0].length"
closest = (speed.sel(mode=2) / speed.sel(mode=1)).transpose(length, mass)
drawn = ratio.contourf(closest[mass], closest[length], closest, levels=[1, 1.5, 2, 3, 4, 6, 8, 12, 16, 24, 40])
figure.colorbar(drawn, ax=ratio, label="second speed over first", location="bottom")
ratio.set(
    title="Two weights", xscale="log", yscale="log", xlabel="lower weight over upper", ylabel="lower length over upper"
)
print(f"two weights: the second speed is at least {float(closest.min()):.3f} of the first")

crane = rc.sweep(STUDIES / "crane_scatter.toml")
for k, name in enumerate(("first", "second")):
    periods = 2 * np.pi / crane["angular_speed"].to_numpy()[:, k]
    deviation = 100 * (periods / periods.mean() - 1)
    bins = np.linspace(-15, 15, 121)
    scatter.hist(deviation, bins, density=True, histtype="step", color=COLOURS[k], label=f"{name} mode")
    print(f"crane, {name} mode: period {periods.mean():.3f} s, deviation {periods.std():.3f} s")
scatter.set(title="A crane known to a few per cent", xlabel="period from its mean (%)", ylabel="share of 20,000 cranes (1/%)")
legend_outside(scatter)
save(figure, "studies")
