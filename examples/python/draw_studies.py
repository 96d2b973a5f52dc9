# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the studies of examples/studies: speeds of wheels against spin, a map over two ratios, scatter of a crane's periods.

python draw_studies.py [FOLDER]
"""

from pathlib import Path

import numpy as np
from _picture import COLOURS, save
from matplotlib.figure import Figure

import revchain as rc

STUDIES = Path(__file__).resolve().parent.parent / "studies"
RPM = 60 / (2 * np.pi)

figure = Figure(figsize=(11, 3.6), layout="constrained")
spun, ratio, scatter = figure.subplots(1, 3)

wheels = rc.sweep(STUDIES / "wheels_spun_up.toml")
for sense, colour in (("forward", COLOURS[0]), ("backward", COLOURS[1])):
    speeds = wheels[f"{sense}_angular_speed"] * RPM
    lines = spun.plot(wheels["spin"] * RPM, speeds, color=colour)
    lines[0].set_label(sense)
    print(f"twelve wheels at 600 rpm, {sense}: " + ", ".join(f"{speed:.2f}" for speed in speeds[-1]) + " rpm")
spun.set(title="Twelve bicycle wheels spun up", xlabel="spin, rpm", ylabel="whirl, rpm")
spun.legend()

weights = rc.sweep(STUDIES / "two_weights.toml").to_xarray()
speed = weights["angular_speed"]
mass, length = "links[0].mass", "links[0].length"
closest = (speed.sel(mode=2) / speed.sel(mode=1)).transpose(length, mass)
drawn = ratio.contourf(closest[mass], closest[length], closest, levels=[1, 1.5, 2, 3, 4, 6, 8, 12, 16, 24, 40])
figure.colorbar(drawn, ax=ratio, label="second speed over first")
ratio.set(
    title="Two weights", xscale="log", yscale="log", xlabel="lower over upper weight", ylabel="lower over upper length"
)
print(f"two weights: the second speed is at least {float(closest.min()):.3f} of the first")

crane = rc.sweep(STUDIES / "crane_scatter.toml")
for k, name in enumerate(("first", "second")):
    periods = 2 * np.pi / crane["angular_speed"][:, k]
    deviation = 100 * (periods / periods.mean() - 1)
    bins = np.linspace(-15, 15, 121)
    scatter.hist(deviation, bins, density=True, histtype="step", color=COLOURS[k], label=f"{name} mode")
    print(f"crane, {name} mode: period {periods.mean():.3f} s, deviation {periods.std():.3f} s")
scatter.set(title="A crane known to some per cent", xlabel="period, % from its mean", ylabel="of 20,000 cranes, 1/%")
scatter.legend(loc="upper left", frameon=False, fontsize="small")
save(figure, "studies")
