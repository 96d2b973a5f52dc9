# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment III: gravity from a pendulum
=======================================

Gravity from the period of a conical pendulum that is almost vertical, and the error if it is not.

Checked: ``tests/python/test_closed_forms.py`` has the paper's pendulum that beats seconds.
"""

import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, legend_below, panels, save

THREAD = 1.0  # m, from the support to the middle of the weight
GRAVITY = 9.80665  # m/s^2, what the functions take where nothing else is said

pendulum = rc.conical_pendulum
print(f"thread 1 m, almost vertical: 100 turns in {100 * pendulum.period(THREAD):.2f} s")
print(f"thread that beats seconds: {pendulum.height_from_period(2.0):.4f} m")
inches = 39.1396  # London, as the paper has it
london = pendulum.gravity(inches)  # of the pendulum that beats seconds
print(f"{inches} inches beat seconds in London: g = {london:.2f} inches/s^2 = {london * 0.0254:.4f} m/s^2")

print("radius, m  inclination, degrees  100 turns, s  g if the circle is neglected, m/s^2")
for radius in (0.02, 0.05, 0.1, 0.2):
    depth = np.sqrt(THREAD**2 - radius**2)  # the conical height is where the plummet hangs
    period = pendulum.period(depth)
    inclination = np.degrees(rc.plummet.inclined_pendulum(THREAD, depth).inclination)
    print(f"{radius:9.2f}  {inclination:20.2f}  {100 * period:12.2f}  {pendulum.gravity(THREAD, period):35.4f}")

measured = 100 * pendulum.period(THREAD)
print("errors of g from errors of measurement:")
errors = [(1e-3, 0, "1 mm in the length"), (0, 0.5, "half a second in 100 turns"), (1e-3, 0.5, "both")]
for length, time, what in errors:
    off = pendulum.gravity(THREAD + length, (measured - time) / 100) - GRAVITY
    print(f"  {what}: {off:.4f} m/s^2")

figure, (axes,) = panels(1, height=5.0)
radius = np.linspace(0.001, 0.25, 200)
neglected = pendulum.gravity(THREAD, pendulum.period(np.sqrt(THREAD**2 - radius**2)))
axes.plot(100 * radius, neglected, color=COLOURS[1], label="g = 4π² l/T²: as if it hung at the thread's length")
axes.axhline(GRAVITY, color=COLOURS[0], label="g = 4π² λ/T²: with the depth λ at which it swings")
wrong = "1 mm and half a second in 100 turns, both the wrong way"
axes.fill_between([0, 25], GRAVITY - off, GRAVITY + off, color=COLOURS[0], alpha=0.15, linewidth=0, label=wrong)
axes.set(xlabel="radius of the circle (cm)", ylabel="g found (m/s²)", xlim=(0, 25), ylim=(9.7, 10.2))
axes.set_title("Gravity from a conical pendulum of 1 m")
legend_below(axes, ncols=1)
save(figure, "experiment_03_gravity")
