# SPDX-License-Identifier: GPL-3.0-or-later
"""Hanging chain with a moving support: forced response and free swing
===================================================================

A hand moves the upper end of a chain round a small circle: how far out, and on which side, is the free end?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

LENGTH, LINKS, HAND = 0.36, 120, 0.01  # m, and the radius of the hand's circle
chain = rc.Chain.uniform_rods(LINKS, length=LENGTH)
depth = np.linspace(LENGTH, 0, LINKS + 1)

figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
for turns in (0.5, 1.5, 2.8):
    found = rc.response(chain, angular_speed=2 * np.pi * turns, support_radius=HAND)
    axes.plot(1000 * found.offset, depth, linewidth=2.5, label=f"{turns} turns/s")
axes.plot(1000 * HAND, 0, "o", color="black", markersize=9, clip_on=False)
axes.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
axes.set(xlabel="distance from axis (mm)", ylabel="depth below the hand (m)", ylim=(0.37, -0.01))
axes.legend(loc="upper left", fontsize="small")
plt.show()

# %%
# The dot is the hand, 10 mm from the axis. Below its first whirl speed (Greenhill 1908, section 1
# (9)) the chain is on the same side as the hand. At each whirl speed the free end changes to the
# other side. Between two whirl speeds there is a speed at which a given link stays on the axis.

print("turns a second  modes passed  free end, mm  over the hand's 10 mm")
for turns in (0.5, 0.9, 1.1, 1.5, 2.2, 2.4):
    at = rc.response(chain, angular_speed=2 * np.pi * turns, support_radius=HAND, pins=0)
    print(f"{turns:14.1f}  {int(at.modes_below):12}  {1000 * float(at.offset):12.2f}  {float(at.amplification):8.3f}")

# %%
# The chain is plucked in the middle by 10 mm and released. Three modes have nearly all the energy.

plucked = HAND * np.interp(depth, [0, LENGTH / 2, LENGTH], [0, 1, 0])
moments = np.linspace(0, 4, 2000)
swing = rc.swing(chain, moments, offset=plucked)
few = rc.swing(chain, moments, offset=plucked, count=3)
share = swing.energy / swing.energy.sum()
print("plucked in the middle, share of the energy of modes 1 to 5:", " ".join(f"{100 * x:.1f} %" for x in share[:5]))
print(
    f"three modes leave out at most {1000 * few.truncation_error[0]:.1f} mm of the free end; "
    f"all, with rounding, {(swing.truncation_error[0] + swing.error_bound.max()):.1g} m"
)

rc.swing(chain, np.linspace(0.0, 2.0, 401), offset=plucked).show()

# %%
# The whole sweep of speeds, the shapes, and the free end after the release.

speeds = np.linspace(1, 28, 1400)
sweep = rc.response(chain, angular_speed=speeds, support_radius=HAND)
print(f"{speeds.size} speeds: error bounds up to {sweep.error_bound.max():.2g} of the largest offset")

BELOW = {"loc": "upper center", "bbox_to_anchor": (0.5, -0.15)}
figure, (curve, shapes, time) = plt.subplots(1, 3, figsize=(9, 4.5), layout="constrained", width_ratios=[1.6, 0.9, 1.2])
for pin, colour, name in ((0, "C0", "free end"), (LINKS // 2, "C1", "half way")):
    size, side = np.abs(sweep.offset[:, pin]), np.sign(sweep.offset[:, pin])
    curve.plot(speeds / (2 * np.pi), np.where(side > 0, size, np.nan), color=colour, label=name)
    curve.plot(speeds / (2 * np.pi), np.where(side < 0, size, np.nan), color=colour, linestyle="--")
for frequency in rc.modes(chain, count=3).frequency:
    curve.axvline(frequency, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
curve.axhline(HAND, color="0.6", linewidth=0.8, zorder=0)
curve.plot([], [], color="0.3", linestyle="--", label="opposite to the hand")
curve.set(yscale="log", ylim=(3e-4, 1), xlabel="speed (turns/s)", ylabel="distance from axis (m); grey: hand")
curve.set_title("hand carried round 0.01 m")
curve.legend(**BELOW)

for turns in (0.5, 1.5, 2.8):
    one = rc.response(chain, angular_speed=2 * np.pi * turns, support_radius=HAND)
    shapes.plot(one.offset, depth, label=f"{turns} turns/s")
shapes.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
shapes.set(xlabel="distance from axis (m)", ylabel="depth below the hand (m)", title="shapes")
shapes.set(xticks=[-0.02, 0.0, 0.02], ylim=(0.37, -0.01))
shapes.legend(**BELOW)

time.plot(moments, swing.offset[:, 0], linewidth=0.9, label="all modes")
time.plot(moments, few.offset[:, 0], linewidth=0.9, linestyle="--", label="three slowest modes")
time.set(xlabel="time (s)", ylabel="offset of the free end (m)", title="plucked 0.01 m half way")
time.legend(**BELOW)
plt.show()

# %%
# The theory has no damping, which limits the motion near a whirl speed. To try next: another place
# to pluck.
#
# Checked: ``tests/python/test_response.py``, against linear algebra in 50 digits.
