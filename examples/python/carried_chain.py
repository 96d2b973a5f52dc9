# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain in a hand that circles
==============================

A hand moves the upper end of a chain round a circle of 1 cm, faster and faster. Then the same chain is plucked and released.

Greenhill (1908) section 1 (9) for a chain. Below its first whirl speed the chain is on the same side as the hand. At each
whirl speed the free end changes to the other side. Between two whirl speeds there is a speed at which a given link stays
on the axis.

Checked: ``tests/python/test_response.py``, against linear algebra in 50 digits.
"""

import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, hang, legend_below, panels, save

LENGTH, LINKS, HAND = 0.36, 120, 0.01  # m, and the radius of the hand's circle
chain = rc.Chain.uniform_rods(LINKS, length=LENGTH)
whirls = rc.modes(chain, count=3).angular_speed

print("turns a second  modes passed  free end, mm  over the hand's 10 mm")
for turns in (0.5, 0.9, 1.1, 1.5, 2.2, 2.4):
    at = rc.response(chain, angular_speed=2 * np.pi * turns, support_radius=HAND, pins=0)
    print(f"{turns:14.1f}  {int(at.modes_below):12}  {1000 * float(at.offset):12.2f}  {float(at.amplification):8.3f}")

speeds = np.linspace(1, 28, 1400)
sweep = rc.response(chain, angular_speed=speeds, support_radius=HAND)
print(f"{speeds.size} speeds: error bounds up to {sweep.error_bound.max():.2g} of the largest offset")

figure, (curve, shapes, time) = panels(3, [1.6, 0.9, 1.2], height=5.0)
for pin, name in ((0, "free end"), (LINKS // 2, "half way")):
    size, side = np.abs(sweep.offset[:, pin]), np.sign(sweep.offset[:, pin])
    colour = COLOURS[0 if pin == 0 else 1]
    curve.plot(speeds / (2 * np.pi), np.where(side > 0, size, np.nan), color=colour, label=name)
    curve.plot(speeds / (2 * np.pi), np.where(side < 0, size, np.nan), color=colour, linestyle="--")
for n in whirls:
    curve.axvline(n / (2 * np.pi), color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
curve.axhline(HAND, color="0.6", linewidth=0.8, zorder=0)
curve.plot([], [], color="0.3", linestyle="--", label="opposite to the hand")
curve.set(yscale="log", ylim=(3e-4, 1), xlabel="speed (turns/s)", ylabel="distance from axis (m); grey: hand")
curve.set_title("hand carried round 0.01 m")
legend_below(curve, ncols=1)

depth = np.linspace(LENGTH, 0, LINKS + 1)
for number, turns in enumerate((0.5, 1.5, 2.8)):
    one = rc.response(chain, angular_speed=2 * np.pi * turns, support_radius=HAND)
    hang(shapes, one.offset, depth, color=COLOURS[number], label=f"{turns} turns/s")
shapes.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
shapes.set(xlabel="distance from axis (m)", ylabel="depth below the hand (m)", title="shapes")
shapes.set(xticks=[-0.02, 0.0, 0.02], ylim=(0.37, -0.01))
legend_below(shapes, ncols=1)

# Plucked in the middle by 1 cm: all 120 modes, and the three slowest.
plucked = HAND * np.interp(depth, [0, LENGTH / 2, LENGTH], [0, 1, 0])
moments = np.linspace(0, 4, 2000)
swing = rc.swing(chain, plucked, None, moments)
few = rc.swing(chain, plucked, None, moments, count=3)
share = swing.energy / swing.energy.sum()
print("plucked in the middle, share of the energy of modes 1 to 5:", " ".join(f"{100 * x:.1f} %" for x in share[:5]))
print(
    f"three modes leave out at most {1000 * few.truncation_error[0]:.1f} mm of the free end; "
    f"all, with rounding, {(swing.truncation_error[0] + swing.error_bound.max()):.1g} m"
)
time.plot(moments, swing.offset[:, 0], color=COLOURS[0], linewidth=0.9, label="all modes")
time.plot(moments, few.offset[:, 0], color=COLOURS[1], linewidth=0.9, linestyle="--", label="three slowest modes")
time.set(xlabel="time (s)", ylabel="offset of the free end (m)", title="plucked 0.01 m half way")
legend_below(time, ncols=1)
save(figure, "carried_chain")

# %%
# The plucked chain swinging.

rc.swing(chain, plucked, None, np.linspace(0.0, 2.0, 401)).show()
