# SPDX-License-Identifier: GPL-3.0-or-later
"""Pipe hung from a drill ship: resonance with waves
=================================================

A drill ship lowers a valve block of 12 t on a pipe: at which lengths does the sway of the ship excite the pipe?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

STEEL, DISPLACED, ADDED = 29.0, 3.8, 22.5  # kg/m of the pipe; added: the water inside and around it that moves with it
BLOCK = {"mass": 12_000.0, "displaced": 1600.0, "added": 3000.0, "length": 8.0}  # kg and m
PIECES = 60
SWAY = 2.0  # m, amplitude of the ship


def hung(length):
    """The block below so many metres of pipe in still water."""
    piece = length / PIECES
    lengths = np.array([BLOCK["length"], *[piece] * PIECES])
    mass, displaced, added = (
        [BLOCK[name], *[per_metre * piece] * PIECES]
        for name, per_metre in (("mass", STEEL), ("displaced", DISPLACED), ("added", ADDED))
    )
    chain = rc.Chain(mass=mass, length=lengths, centroid=lengths / 2, radius_of_gyration=lengths / np.sqrt(12))
    return rc.Rig(chain, displaced=rc.Displaced(mass=displaced, added_mass=added), fluid="still")


rig = hung(600.0)
depth = np.append(np.cumsum(rig.chain.length[::-1])[::-1], 0.0)

figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
x = np.linspace(-6, 5, 300)
axes.fill_between(x, 6 * np.sin(4 * x), 650, color="#d6e9f5")
axes.fill([0.3, 3.7, 4.2, -0.2], [18, 18, -35, -35], color="0.3", zorder=3)
axes.plot([1.6, 2, 2.4], [-35, -110, -35], color="0.3", linewidth=2)
for number, period in enumerate((6.0, 8.0, 13.0)):
    found = rc.response(rig, angular_speed=2 * np.pi / period, support_radius=SWAY)
    axes.plot(found.offset, depth, linewidth=2.5, color=f"C{number}")
    axes.plot(found.offset[0], depth[0], "s", markersize=10, color=f"C{number}", markeredgecolor="black", zorder=4)
    left = found.offset.argmin()
    axes.text(found.offset[left] - 0.2, depth[left], f"waves of {period:g} s", color=f"C{number}", ha="right")
axes.text(1.4, 618, "valve block", color="0.3")
axes.axvline(0, color="0.6", linestyle="-.", linewidth=0.8)
axes.set(xlabel="offset (m), ship not to scale", xlim=(-6, 5))
axes.set(ylabel="depth (m)", ylim=(650, -120), yticks=range(0, 601, 200))
plt.show()

# %%
# The picture shows 600 m of pipe when the ship sways by 2 m in waves of three periods. In shorter
# waves the pipe bends in more half waves. The block moves less than the ship.
#
# The sea is still except for the motion of the ship, and the pipe is full of water. In the fluid,
# tension uses the net weight and inertia the full mass with the added mass. Bending stiffness
# matters only within a few metres of the ends, and drag is left out: it limits the motion near
# resonance. The figures are illustrative.

print("pipe (m)  periods of the four slowest modes (s)  block moves, waves of 8 s (m)  of 12 s (m)")
for length in (200.0, 400.0, 600.0, 800.0, 1000.0):
    rig = hung(length)
    periods = " ".join(f"{period:8.2f}" for period in rc.modes(rig, 4).period)
    moves = [abs(rc.response(rig, angular_speed=2 * np.pi / t, support_radius=SWAY).offset[0]) for t in (8.0, 12.0)]
    print(f"{length:8.0f}  {periods:37}  {moves[0]:29.3f}  {moves[1]:11.3f}")

# %%
# Here most waves have periods from 6 s to 14 s. A length is critical where the period of a mode is in
# that range, the grey band.

WAVES = (6.0, 14.0)  # s
lengths = np.linspace(100.0, 1200.0, 111)
periods = np.array([rc.modes(hung(length), 4).period for length in lengths])
for mode in (1, 2):
    low, high = (np.interp(wave, periods[:, mode], lengths) for wave in WAVES)
    print(f"mode {mode + 1} is in waves of {WAVES[0]:g} to {WAVES[1]:g} s from {low:.0f} to {high:.0f} m of pipe")

figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
axes.axhspan(*WAVES, color="0.9")
axes.plot(lengths, periods)
axes.text(1190, 6.3, "most waves", color="0.3", ha="right")
for mode, place in enumerate(((365, 37), (800, 24.3), (1000, 15.8), (1000, 8.2)), 1):
    axes.text(*place, f"mode {mode}", color=f"C{mode - 1}", ha="right")
axes.set(xlabel="length of the pipe (m)", ylabel="period (s)", ylim=(0, 40), xlim=(100, 1200))
plt.show()

# %%
# To try next: a heavier block, which raises the tension and shortens every period.
#
# Checked: ``tests/python/test_examples.py`` computes periods and offsets again from matrices
# written by hand.
