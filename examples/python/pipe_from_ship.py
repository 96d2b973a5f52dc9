# SPDX-License-Identifier: GPL-3.0-or-later
"""Pipe hung from a ship: lengths at which waves excite it
=======================================================

A drill ship lowers a valve block of 12 t on a pipe. At which lengths does the sway of the ship excite the pipe?

The sea is still except for the motion of the ship, and the pipe is full of water. In the fluid, tension uses the net weight
and inertia the full mass with the added mass. Bending stiffness matters only within a few metres of the ends, and drag is
left out: it limits the motion near resonance. Illustrative figures.

Checked: ``tests/python/test_examples.py`` computes periods and offsets again from matrices written by hand.
"""

import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, panels, save

STEEL, DISPLACED, ADDED = 29.0, 3.8, 22.5  # kg/m of the pipe; added: the water inside and around it that moves with it
BLOCK = {"mass": 12_000.0, "displaced": 1600.0, "added": 3000.0, "length": 8.0}  # kg and m
PIECES = 60
SWAY = 2.0  # m, amplitude of the ship
WAVES = (6.0, 14.0)  # s, the periods in which the sea has most of its energy


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


def swayed(rig, period):
    return rc.response(rig, angular_speed=2 * np.pi / period, support_radius=SWAY)


print("pipe (m)  periods of the four slowest modes (s)  block moves, waves of 8 s (m)  of 12 s (m)")
for length in (200.0, 400.0, 600.0, 800.0, 1000.0):
    rig = hung(length)
    periods = " ".join(f"{period:8.2f}" for period in rc.modes(rig, 4).period)
    moves = [abs(swayed(rig, period).offset[0]) for period in (8.0, 12.0)]
    print(f"{length:8.0f}  {periods:37}  {moves[0]:29.3f}  {moves[1]:11.3f}")

lengths = np.linspace(100.0, 1200.0, 111)
periods = np.array([rc.modes(hung(length), 4).period for length in lengths])
for mode in (1, 2):
    low, high = (np.interp(wave, periods[:, mode], lengths) for wave in WAVES)
    print(f"mode {mode + 1} is in waves of {WAVES[0]:g} to {WAVES[1]:g} s from {low:.0f} to {high:.0f} m of pipe")

figure, (tuned, shape) = panels(2, [1.5, 1])
tuned.axhspan(*WAVES, color="0.9", label="waves")
for mode, period in enumerate(periods.T):
    tuned.plot(lengths, period, color=COLOURS[mode], label=f"mode {mode + 1}")
tuned.set(xlabel="pipe (m)", ylabel="period (s)", ylim=(0, 40), xlim=(100, 1200), title="natural periods and waves")
tuned.legend(loc="upper right")
rig = hung(600.0)
depth = np.append(np.cumsum(rig.chain.length[::-1])[::-1], 0.0)
for wave, colour in zip((6.0, 8.0, 13.0), COLOURS, strict=False):
    hang(shape, swayed(rig, wave).offset, depth, color=colour, label=f"{wave:g} s")
shape.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
shape.set(xlabel="offset (m)", ylabel="below the ship (m)", ylim=(620, 0), xlim=(-4.5, 3), title=f"600 m, sway {SWAY:g} m")
shape.legend(title="waves", loc="upper left")
save(figure, "pipe_from_ship")
