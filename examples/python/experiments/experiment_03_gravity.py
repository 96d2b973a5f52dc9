# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment III: gravity from a conical pendulum
===============================================

Gravity from the period of a conical pendulum that is almost vertical, and the error if it is not.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, legend_below, panels, picture, whirling

THREAD = 1.0  # m, from the support to the middle of the weight
GRAVITY = 9.80665  # m/s^2, what the functions take where nothing else is said

pendulum = rc.conical_pendulum
radius = 0.25
depth = np.sqrt(THREAD**2 - radius**2)  # the conical height is the depth at which the plummet hangs
figure, axes = picture()
whirling(axes, [radius, 0], [depth, 0], marker="o", markersize=14, markevery=[0])
axes.annotate("", (-0.45, 0), (-0.45, depth), arrowprops={"arrowstyle": "<->"})
axes.text(-0.52, depth / 2, "λ", fontsize="x-large")
axes.set(xlabel="distance from axis (m)", ylabel="depth (m)", xlim=(-0.8, 0.8), ylim=(1.1, -0.05), aspect="equal")
plt.show()

# %%
# The plummet goes round in a period T that depends on its depth λ below the support: g = 4π² λ/T².
# Near the vertical λ is the length of the thread. Count 100 turns.

print(f"thread 1 m, almost vertical: 100 turns in {100 * pendulum.period(THREAD):.2f} s")
print(f"thread that beats seconds: {pendulum.height_from_period(2.0):.4f} m")
inches = 39.1396  # London, as the paper has it
london = pendulum.gravity(inches)  # of the pendulum that beats seconds
print(f"{inches} inches beat seconds in London: g = {london:.2f} inches/s^2 = {london * 0.0254:.4f} m/s^2")

# %%
# If the circle is not small and λ is taken as the length of the thread, the result is wrong.

print("radius, m  inclination, degrees  100 turns, s  g if the circle is neglected, m/s^2")
for radius in (0.02, 0.05, 0.1, 0.2):
    depth = np.sqrt(THREAD**2 - radius**2)
    period = pendulum.period(depth)
    inclination = np.degrees(rc.plummet.inclined_pendulum(THREAD, depth).inclination)
    print(f"{radius:9.2f}  {inclination:20.2f}  {100 * period:12.2f}  {pendulum.gravity(THREAD, period):35.4f}")

# %%
# How accurate must the length and the time be?

measured = 100 * pendulum.period(THREAD)
print("errors of g from errors of measurement:")
errors = [(1e-3, 0, "1 mm in the length"), (0, 0.5, "half a second in 100 turns"), (1e-3, 0.5, "both")]
for length, time, what in errors:
    off = pendulum.gravity(THREAD + length, (measured - time) / 100) - GRAVITY
    print(f"  {what}: {off:.4f} m/s^2")

# %%
# The neglected circle (orange) against the error of careful measurement (blue band).

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
plt.show()

# %%
# To try next: a longer thread, ``THREAD = 2.0``: the same circle does less harm.
#
# Checked: ``tests/python/test_closed_forms.py`` has the paper's pendulum that beats seconds.
