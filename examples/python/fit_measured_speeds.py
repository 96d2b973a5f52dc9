# SPDX-License-Identifier: GPL-3.0-or-later
"""Masses and lengths from timed periods
=====================================

The load and the rope length of a crane from three timed periods: how accurate they are, and what cannot be determined.

A load of about 2500 kg hangs on slings of 6 m below a hook block of 400 kg. The block hangs on about 24 m of rope from a
trolley on a spring. Illustrative figures.

Checked: ``tests/python/test_fit.py``, values and covariances against 40 digits and against random samples.
"""

import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, legend_below, panels, save

MEASURED = {1: ("10.97 s", "0.03 s"), 2: ("1.608 s", "0.008 s"), 3: ("0.2421 s", "0.0008 s")}
LOAD, ROPE = "links[0].mass", "links[1].length_in_proportion"

believed = rc.Chain(mass=[2500, 400], length=[6, 24], names=["load", "hook block"])
crane = rc.Rig(believed, support=rc.Support(stiffness="200 kN/m", mass=300))
found = rc.fit(crane, MEASURED, vary=[LOAD, ROPE])
print(found)
print(f"correlation of load and rope {found.correlation[0, 1]:.3f}")

hung = {1: MEASURED[1], 2: MEASURED[2]}  # the two modes in which the trolley hardly moves
print("\nboth masses, with a fixed trolley:")
print(rc.fit(believed, hung, vary=[LOAD, "links[1].mass"]))

figure, (pull, cloud) = panels(2, height=5.0)
speed, spread, modes = found.measured, found.measured_uncertainty, found.number
before = rc.modes(crane).angular_speed
pull.axhline(0, color="0.6", linewidth=0.8)
pull.errorbar(modes, 0 * speed, 100 * spread / speed, fmt="none", ecolor="0.3", capsize=6, label="measured, standard uncertainty")
for values, colour, label in ((before, COLOURS[1], "2500 kg, 24 m"), (found.computed, COLOURS[0], "fitted")):
    pull.plot(modes, 100 * (values / speed - 1), "o", color=colour, label=label)
pull.set(title="computed speeds against measured ones", xlabel="mode", ylabel="difference (%)", xticks=modes, xlim=(0.5, 3.5))
legend_below(pull, ncols=1)

rng = np.random.default_rng(1)
for _ in range(400):  # what other measurements of the same crane might have said
    drawn = {int(k): (n + s * rng.normal(), s) for k, n, s in zip(modes, found.computed, spread, strict=True)}
    again = rc.fit(found.system, drawn, vary=[LOAD, ROPE])
    cloud.plot(again[ROPE], again[LOAD], ".", color="0.7", markersize=3)
axes = np.linalg.cholesky(found.covariance)
for size, line in ((1, "-"), (2, "--")):
    angle = np.linspace(0, 2 * np.pi, 100)
    load, rope = found.value[:, None] + size * axes @ [np.cos(angle), np.sin(angle)]
    cloud.plot(rope, load, line, color=COLOURS[0], label=f"{size} standard uncertainties" if size == 2 else None)
cloud.plot(24, 2500, "o", color=COLOURS[1], label="as believed")
cloud.plot(found[ROPE], found[LOAD], "o", color=COLOURS[0], label="fitted")
cloud.set(title="grey: fits of 400 drawn sets of periods", xlabel="rope (m)", ylabel="load (kg)", ylim=(2450, 2850))
legend_below(cloud, ncols=1)
save(figure, "fit_measured_speeds")
