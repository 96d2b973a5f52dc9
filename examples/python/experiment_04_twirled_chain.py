# SPDX-License-Identifier: GPL-3.0-or-later
"""Experiment IV: the hand carries the upper end round a small circle; at higher speeds the tip crosses the axis.

python experiment_04_twirled_chain.py [FOLDER]
"""

import numpy as np
from _picture import COLOURS, hang, panels, save, side_view

import revchain as rc

LENGTH = 0.36  # m, of the chain, and of the thread of a plummet
HAND = 0.005  # m, radius of the circle


def driven(x, turns):
    """Offset over that of the hand, `x` from the free end: the lowest part of a longer chain that whirls freely."""
    height = rc.conical_pendulum.height(2 * np.pi * turns)
    mode = 8  # any in which the longer chain is long enough
    longer = height / rc.heavy_chain.conical_heights(mode)[-1]
    return rc.heavy_chain.shape(x, mode, longer) / rc.heavy_chain.shape(LENGTH, mode, longer)


print(f"reversals of the plummet at {rc.conical_pendulum.revolutions_per_second(LENGTH):.4f} turns a second,", end=" ")
print("of the chain at", *rc.heavy_chain.revolutions_per_second(3, LENGTH).round(4))
print("tip over hand, near the vertical:")
print("turns a second  plummet    chain")
for turns in (0.4, 0.7, 0.9, 1.1, 1.5, 2.0, 2.5):
    plummet = rc.plummet.carried_response(LENGTH, rc.conical_pendulum.height(2 * np.pi * turns))
    print(f"{turns:14.2f}  {plummet:+7.3f}  {driven(0.0, turns):+7.3f}")
print("plummet on 0.36 m, hand on a circle of radius 5 mm, all steady inclinations, degrees:")
for turns in (0.7, 0.83, 0.9, 1.0):
    found = rc.plummet.carried_inclinations(LENGTH, rc.conical_pendulum.height(2 * np.pi * turns), HAND)
    print(f"{turns:14.2f}  ", *(f"{x:8.2f}" for x in np.degrees(found[~np.isnan(found)])))

figure, axes = panels(4, [2.2, 1, 1, 1])
turns = np.linspace(0.2, 2.8, 1301)
plummet = rc.plummet.carried_response(LENGTH, rc.conical_pendulum.height(2 * np.pi * turns))
curves = [("plummet", plummet, "0.45", (2, 0.4)), ("chain", driven(0, turns), COLOURS[0], (1.4, -2))]
for name, tip, colour, place in curves:
    axes[0].plot(turns, np.where(np.abs(tip) < 12, tip, np.nan), color=colour)
    axes[0].annotate(name, place, color=colour)
axes[0].axhline(0, color="black", linewidth=0.6)
axes[0].set(xlabel="turns a second", ylabel="offset of the tip over that of the hand", ylim=(-12, 12))
axes[0].set_title("with the hand above 0, against it below")

x = np.linspace(0, LENGTH, 200)
for panel, speed in zip(axes[1:], (0.7, 1.5, 2.6), strict=True):
    hang(panel, HAND * driven(x, speed), LENGTH - x, color=COLOURS[0])
    panel.plot(HAND, 0, "o", color="black", markersize=5)
    panel.annotate("hand", (HAND, 0), xytext=(4, 3), textcoords="offset points")
    side_view(panel, f"chain\n{speed} turns/s", bottom=0.38, top=0.03, half_width=0.06)
    panel.set_xticks([-0.05, 0, 0.05])
axes[1].set_ylabel("below the hand, m")
save(figure)
