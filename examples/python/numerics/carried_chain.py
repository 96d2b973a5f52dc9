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
for turns, colour, place in ((0.5, "C0", (13.5, 0.2)), (1.5, "C1", (-27, 0.29)), (2.8, "C2", (20, 0.325))):
    found = rc.response(chain, angular_speed=2 * np.pi * turns, support_radius=HAND)
    axes.plot(1000 * found.offset, depth, linewidth=2.5, color=colour)
    axes.text(*place, f"{turns} turns/s", color=colour)
axes.plot(1000 * HAND, 0, "o", color="black", markersize=9, clip_on=False)
axes.text(1000 * HAND + 2, 0.006, "hand")
axes.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
axes.set(xlabel="distance from axis (mm)", ylabel="depth below the hand (m)", ylim=(0.37, -0.01))
plt.show()

# %%
# The hand is 10 mm from the axis. Below its first whirl speed (Greenhill 1908, section 1
# (9)) the chain is on the same side as the hand. At each whirl speed the free end changes to the
# other side. Above the first whirl speed the chain crosses the axis.

print("turns a second  modes passed  free end, mm  over the hand's 10 mm")
for turns in (0.5, 0.9, 1.1, 1.5, 2.2, 2.4):
    at = rc.response(chain, angular_speed=2 * np.pi * turns, support_radius=HAND, pins=0)
    print(f"{turns:14.1f}  {int(at.modes_below):12}  {1000 * float(at.offset):12.2f}  {float(at.amplification):8.3f}")

# %%
# The chain is plucked in the middle by 10 mm and released. Its three slowest modes
# have 86 % of the energy.

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
# The left picture has the whole sweep of speeds. Dash-dotted lines mark the whirl speeds. Near them
# the theory of small motion gives offsets without limit; the picture ends at 100 mm. The right picture is the free end after the release.

speeds = np.linspace(1, 28, 1400)
sweep = rc.response(chain, angular_speed=speeds, support_radius=HAND)
print(f"{speeds.size} speeds: error bounds up to {sweep.error_bound.max():.2g} of the largest offset")

figure, (curve, time) = plt.subplots(1, 2, figsize=(8, 4), layout="constrained")
for pin, colour, name, *place in ((0, "C0", "free end", 1.25, 60), (LINKS // 2, "C1", "middle", 2.4, 0.6)):
    size, side = 1000 * np.abs(sweep.offset[:, pin]), sweep.offset[:, pin]
    curve.plot(speeds / (2 * np.pi), np.where(side > 0, size, np.nan), color=colour)
    curve.plot(speeds / (2 * np.pi), np.where(side < 0, size, np.nan), color=colour, linestyle="--")
    curve.text(*place, name, color=colour)
for frequency in rc.modes(chain, count=3).frequency:
    curve.axvline(frequency, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
curve.axhline(1000 * HAND, color="0.6", linewidth=0.8, zorder=0)
curve.text(3.75, 0.4, "dashed:\nopposite\nto the hand")
curve.text(4.5, 8.3, "hand", color="0.4", va="top")
curve.set(yscale="log", xlim=(0, 5.3), ylim=(0.3, 100), xlabel="speed (turns/s)", ylabel="distance from axis (mm)")
curve.set_title("hand carried round 10 mm from the axis,\nsmall-motion theory")

time.plot(moments, 1000 * swing.offset[:, 0], linewidth=1)
time.plot(moments, 1000 * few.offset[:, 0], linewidth=1, linestyle="--")
time.set_title("plucked 10 mm in the middle,\nreleased")
time.set(xlabel="time (s)", ylabel="offset of the free end (mm)", ylim=(-32, 32))
time.text(0.1, 27, "all modes", color="C0")
time.text(2.1, 27, "three slowest modes", color="C1")
plt.show()

# %%
# The theory has no damping, which limits the motion near a whirl speed. To try next: another place
# to pluck.
#
# Checked: ``tests/python/test_response.py``, against linear algebra in 50 digits.
