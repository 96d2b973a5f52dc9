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
figure, panels = plt.subplots(1, 2, figsize=(4.8, 3.4), layout="constrained")
for axes, name, shape, period in zip(panels, ("slower", "faster"), modes.shape, modes.period):
    axes.plot([-6, -6, 5], [21, 0, 0], color="0.3", linewidth=5)
    axes.plot([0, 0], [0, 20], color="0.6", linestyle="-.", linewidth=0.8, zorder=0)
    axes.plot(0, 0, "s", color="black", markersize=10, zorder=3)
    for offset, rope, load in ((-3 * shape, "#bfdcec", "#f4d7bf"), (3 * shape, "C0", "C1")):
        axes.plot(offset, [16, 10, 0], color=rope, linewidth=2)
        axes.plot(offset[1], 10, "o", color=rope, markersize=9)
        axes.plot(offset[0], 16, "s", color=load, markersize=17, markeredgecolor="white")
    axes.axis("off")
    axes.set(title=f"{name} mode: {period:.2f} s", xlim=(-6.5, 7.5), ylim=(21, -2), aspect="equal")
for text, *place in (("trolley", 1, 1.8), ("rope", 1.8, 6), ("hook\nblock", 3, 11), ("load", 4.7, 16.5)):
    panels[0].text(*place, text)
plt.show()

# %%
# Hook block and load are a double pendulum, which can whirl in two ways: with the load and the
# block on the same side, and on opposite sides. The picture shows both with 10 m of rope, also half
# a turn later (pale). The offsets are exaggerated.
#
# Both whirl speeds rise as the rope is wound in.

print("rope, m  slower and faster whirl speed, rad/s")
for rope in np.arange(4.0, 29.0, 4.0):
    speeds = rc.modes(hanging(rope)).angular_speed
    print(f"{rope:7.1f}  {speeds[0]:.4f}  {speeds[1]:.4f}")

# %%
# Which length of rope gives the slower mode a speed of 0.8 rad/s? ``rc.tune`` varies the rope until
# it does.

met = rc.tune(hanging(10.0), mode=1, vary="links[hook block].length", angular_speed=SLEWING)
print(f"slewing at {SLEWING} rad/s meets the slower one with {met.value:.3f} m of rope: avoid this length")

lengths = np.linspace(2.0, 28.0, 105)
figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
axes.plot(lengths, [rc.modes(hanging(rope)).angular_speed for rope in lengths])
axes.axhline(SLEWING, color="0.4", linestyle="--")
axes.plot(met.value, SLEWING, "o", color="black")
axes.text(20, 4.1, "faster mode", color="C1")
axes.text(20, 0.25, "slower mode", color="C0")
axes.text(24, 0.95, "slewing", color="0.4")
axes.text(met.value, 1.1, f"avoid {met.value:.2f} m")
axes.set(xlabel="length of rope (m)", ylabel="whirl speed (rad/s)", ylim=(0, None))
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
