# SPDX-License-Identifier: GPL-3.0-or-later
"""Crane with a hook block: rope lengths to avoid
==============================================

At which length of the hoist rope does the slewing speed of a crane meet a natural frequency of its load?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

LOAD, HOOK_BLOCK, SLINGS = 2500.0, 400.0, 6.0  # kg, kg, m
SLEWING = 0.8  # rad/s


def hanging(rope):
    """The load on its slings below the hook block, with this much rope."""
    return rc.Chain(mass=[LOAD, HOOK_BLOCK], length=[SLINGS, rope], names=["load", "hook block"])


modes = rc.modes(hanging(10.0))
figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
axes.plot([-9, -9, 2], [24, 0, 0], color="0.3", linewidth=6)
for side, strength in ((-1, 0.3), (1, 1.0)):
    axes.plot(3 * side * modes.shape[0], [16, 10, 0], color="C0", linewidth=2, alpha=strength)
    axes.scatter(3 * side * modes.shape[0, :2], [16, 10], s=[260, 70], color="C0", alpha=strength)
axes.set(xlabel="distance from axis (m)", ylabel="depth below the jib (m)")
axes.set(xlim=(-10, 6), ylim=(24, -1), aspect="equal")
plt.show()

# %%
# Hook block and load are a double pendulum, which can whirl in two ways: with the load and the
# block on the same side, as in the picture, and with the load and the block on opposite sides.
# ``modes.plot()`` shows both, with their speeds. The offsets are exaggerated.
#
# Both whirl speeds rise as the rope is wound in.

print("rope, m  slower and faster whirl speed, rad/s")
for rope in np.arange(4.0, 29.0, 4.0):
    speeds = rc.modes(hanging(rope)).angular_speed
    print(f"{rope:7.1f}  {speeds[0]:.4f}  {speeds[1]:.4f}")

# %%
# Which length of rope gives the slower mode a speed of 0.8 rad/s? ``rc.tune`` varies the rope until
# it does.

met = rc.tune(hanging(10.0), mode=1, vary="links[1].length_in_proportion", angular_speed=SLEWING)
print(f"slewing at {SLEWING} rad/s meets the slower one with {met.value:.3f} m of rope: avoid this length")

lengths = np.linspace(2.0, 28.0, 105)
figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
axes.plot(lengths, [rc.modes(hanging(rope)).angular_speed for rope in lengths], label=["slower mode", "faster mode"])
axes.axhline(SLEWING, color="0.4", linestyle="--", label="slewing")
axes.axvline(met.value, color="0.4", linestyle=":", label=f"{met.value:.2f} m: avoid")
axes.set(xlabel="length of rope (m)", ylabel="whirl speed (rad/s)", ylim=(0, None))
axes.legend()
plt.show()

# %%
# How do the speeds change with the data, and how uncertain are they? The sensitivities are those of
# the conical height g/ω². The speed ω changes by half as many per cent, in the other direction.

for mode, name in ((1, "slower"), (2, "faster")):
    share = rc.modes(met.system).sensitivity.relative.length_in_proportion[mode - 1]
    print(f"{name} speed: 1 % more sling lowers it by {share[0] / 2:.3f} %, 1 % more rope by {share[1] / 2:.3f} %")

found = rc.modes(met.system).uncertainty(mass=[50.0, 5.0], length_in_proportion=[0.02, 0.05])
print("standard deviations of 50 kg (load), 5 kg (hook block), 2 cm (slings) and 5 cm (rope) give")
print("standard deviations of {:.4f} and {:.4f} rad/s of the two speeds".format(*found.angular_speed))

# %%
# To try next: a heavier hook block, or a trolley that yields, ``rc.Rig(hanging(10.0),
# support=rc.Support(stiffness="200 kN/m"))``.
#
# Checked: ``tests/cpp/tune.cpp``, against Greenhill's quadratic (1908, section 2 (5)). The speeds
# with 24 m of rope are in 40 digits in ``examples/scenes/crane_hook_block.expected.json``.
