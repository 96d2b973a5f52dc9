# SPDX-License-Identifier: GPL-3.0-or-later
"""Gyrostatic string: wheels that turn the plane of vibration
==========================================================

Spinning wheels on a stretched cord turn the plane of a vibration, as magnetised glass turns that of polarised light.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

MASS, LENGTH, TENSION, RADIUS = 1.5, 0.3, 120.0, 0.29  # kg, m, N, m: a wheel on each link, the cord drawn tight
VIBRATION = 3.0  # rad/s


def string(turns_a_second):
    """Wheels spinning so fast, a body for each link of the wheel's inertia across."""
    return rc.GyrostaticString(
        weight=MASS * 9.80665,
        length=LENGTH,
        tension=TENSION,
        momentum=MASS * RADIUS**2 * 2 * np.pi * turns_a_second,
        centroid=LENGTH / 2,
        radius_of_gyration=RADIUS / np.sqrt(2),
    )


figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
string(5.0).plot_vibration(VIBRATION, links=120, ax=axes)
axes.get_legend().remove()
plt.show()

# %%
# The vibration starts in one plane, at the left. Along 120 wheels at 5 turns a second the motion in
# that plane (blue) goes over into motion across it (pink), and back. The bars above are the plane
# seen along the string.
#
# Greenhill (1908) section 8, after Thomson: a vibration in a plane is the sum of two circular
# waves, one with the spin and one against it. Their wavelengths differ, so the plane turns from
# link to link.

print("wheels at    links in a wave  links in a wave  the plane turns   in a")
print("turns/s       with the spin   against it       degrees a link    half turn, links")
for turns in (0.0, 2.0, 5.0, 8.0):
    one = string(turns)
    forward, backward = float(one.phase(VIBRATION)), float(one.phase(-VIBRATION))
    turn = float(np.degrees(one.plane_rotation(VIBRATION)))
    half = "" if turn == 0 else f"{abs(180 / turn):18.1f}"
    print(f"{turns:9.1f}  {2 * np.pi / forward:16.2f}  {2 * np.pi / backward:15.2f}  {turn:15.3f}  {half}".rstrip())

# %%
# Above, the speeds of both waves against the phase from link to link; they differ more, the faster
# the wheels spin. Below, the vibration of the first picture.

figure, (waves, plane) = plt.subplots(2, 1, figsize=(8, 6.5), layout="constrained")
phase = np.linspace(0.02, np.pi, 200)
for turns, colour in ((0.0, "C0"), (5.0, "C1"), (8.0, "C2")):
    found = string(turns).angular_speeds(phase)
    waves.plot(np.degrees(phase), found.forward, color=colour, label=f"{turns:g} turns/s")
    waves.plot(np.degrees(phase), -found.backward, color=colour, linestyle="--")
waves.plot([], [], color="0.3", linestyle="--", label="against the spin")
waves.axhline(VIBRATION, color="0.6", linewidth=0.8, label="the vibration below")
waves.set(xlabel="phase from link to link (°)", ylabel="speed (rad/s)", xlim=(0, 180), ylim=(0, None))
waves.set_title("circular waves with the spin and against it")
waves.legend()
string(5.0).plot_vibration(VIBRATION, links=120, ax=plane)
plane.set_title("a vibration of 3 rad/s along 120 wheels at 5 turns/s")
plt.show()

# %%
# To try next: a tighter cord, ``TENSION = 240.0``.
#
# Checked: ``tests/python/test_gyrostatic.py``, against a long row of links driven at one end.
