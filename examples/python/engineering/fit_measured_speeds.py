# SPDX-License-Identifier: GPL-3.0-or-later
"""Load and rope length of a crane from timed periods
==================================================

Three periods of a crane were timed: what are its load and its rope length, and how accurate are they?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

MEASURED = {1: ("10.97 s", "0.03 s"), 2: ("1.608 s", "0.008 s"), 3: ("0.2421 s", "0.0008 s")}
LOAD, ROPE = "links[load].mass", "links[hook block].length"

believed = rc.Chain(mass=[2500, 400], length=[6, 24], names=["load", "hook block"])
crane = rc.Rig(believed, support=rc.Support(stiffness="200 kN/m", mass=300))
found = rc.fit(crane, MEASURED, vary=[LOAD, ROPE])


def ellipse(size):
    """Loads and ropes at so many standard uncertainties from the fitted ones."""
    angle = np.linspace(0, 2 * np.pi, 100)
    return found.value[:, None] + size * np.linalg.cholesky(found.covariance) @ [np.cos(angle), np.sin(angle)]


figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
for size in (2, 1):
    load, rope = ellipse(size)
    axes.fill(rope, load, color="C0", alpha=0.35, linewidth=0)
axes.plot(found[ROPE], found[LOAD], "o", color="C0", markersize=9, label="fitted")
axes.plot(24, 2500, "o", color="C1", markersize=9, label="as believed")
axes.set(xlabel="rope (m)", ylabel="load (kg)")
axes.legend()
plt.show()

# %%
# A load of about 2500 kg hangs on slings of 6 m below a hook block of 400 kg. The block hangs on
# about 24 m of rope from a trolley on a spring. ``rc.fit`` finds the load and the rope that give
# the measured periods best. The shaded ellipses are one and two standard uncertainties. The figures
# are illustrative.

print(found)
print(f"correlation of load and rope {found.correlation[0, 1]:.3f}")

# %%
# Not everything can be determined. With a fixed trolley, two periods depend on the ratio of both
# masses alone.

hung = {1: MEASURED[1], 2: MEASURED[2]}  # the two modes in which the trolley hardly moves
print("\nboth masses, with a fixed trolley:")
print(rc.fit(believed, hung, vary=[LOAD, "links[hook block].mass"]))

# %%
# Does the fit explain the measurements, and are the uncertainties right? On the left, the fitted
# speeds are within the uncertainty of the measured ones. On the right, the fits of 400 other sets
# of periods, drawn at random with the same uncertainties, fill the ellipses.

figure, (pull, cloud) = plt.subplots(1, 2, figsize=(8, 5), layout="constrained")
speed, spread, modes = found.measured, found.measured_uncertainty, found.number
before = rc.modes(crane).angular_speed[modes - 1]
pull.axhline(0, color="0.6", linewidth=0.8)
bars = {"fmt": "none", "ecolor": "0.3", "capsize": 6, "label": "measured, standard uncertainty"}
pull.errorbar(modes, 0 * speed, 100 * spread / speed, **bars)
for values, colour, label in ((before, "C1", "2500 kg, 24 m"), (found.computed, "C0", "fitted")):
    pull.plot(modes, 100 * (values / speed - 1), "o", color=colour, label=label)
pull.set(title="computed speeds against measured ones", xlabel="mode", ylabel="difference (%)")
pull.set(xticks=modes, xlim=(0.5, 3.5))
pull.legend()

rng = np.random.default_rng(1)
for _ in range(400):
    drawn = {int(k): (n + s * rng.normal(), s) for k, n, s in zip(modes, found.computed, spread, strict=True)}
    again = rc.fit(found.system, drawn, vary=[LOAD, ROPE])
    cloud.plot(again[ROPE], again[LOAD], ".", color="0.7", markersize=3)
for size, line in ((1, "-"), (2, "--")):
    load, rope = ellipse(size)
    cloud.plot(rope, load, line, color="C0", label=f"{size} standard uncertaint{'ies' if size > 1 else 'y'}")
cloud.plot(24, 2500, "o", color="C1", label="as believed")
cloud.plot(found[ROPE], found[LOAD], "o", color="C0", label="fitted")
cloud.set(title="grey: fits of 400 drawn sets of periods", xlabel="rope (m)", ylabel="load (kg)", ylim=(2450, 2850))
cloud.legend()
plt.show()

# %%
# To try next: only modes 1 and 2 in ``MEASURED``, and see how the ellipse grows.
#
# Checked: ``tests/python/test_fit.py``, values and covariances against 40 digits and against random
# samples.
