# SPDX-License-Identifier: GPL-3.0-or-later
"""Crane: rope lengths to avoid
============================

A crane slews at a given speed. At which length of the hoist rope is this a whirl speed of its load?

Hook block and load are a double pendulum. Its two natural frequencies rise while the rope is wound in. The program also
prints how the frequencies at this length change with the data, and how uncertain they are.

Checked: ``tests/cpp/tune.cpp``, against Greenhill's quadratic (1908, section 2 (5)). The speeds with 24 m of rope are in 40
digits in ``examples/scenes/crane_hook_block.expected.json``.
"""

import numpy as np

import revchain as rc
from revchain.plots.programs import panels, save
from revchain.plots.style import legend_outside

SLEWING = 0.8  # rad/s
HOOK, LOAD = 400.0, 2500.0  # kg
SLINGS = 6.0  # m


def hanging(rope):
    """The load, below the hook block, with this much rope."""
    return rc.Chain(mass=[LOAD, HOOK], length=[SLINGS, rope], names=["load", "hook block"])


print("rope, m  slower and faster whirl speed, rad/s")
for rope in np.arange(4.0, 29.0, 4.0):
    speeds = rc.modes(hanging(rope)).angular_speed
    print(f"{rope:7.1f}  {speeds[0]:.4f}  {speeds[1]:.4f}")

met = rc.tune(hanging(10.0), mode=1, vary="links[1].length_in_proportion", angular_speed=SLEWING)
assert met.complete and len(met.values) == 1
print(f"slewing at {SLEWING} rad/s meets the slower one with {met.value:.3f} m of rope: avoid this length")
for mode, name in ((1, "slower"), (2, "faster")):
    share = rc.modes(met.system).sensitivity.relative.length_in_proportion[mode - 1]
    print(
        f"1 % more sling lowers the {name} speed by {share[0] / 2:.3f} %, 1 % more rope lowers it by {share[1] / 2:.3f} %"
    )
speed = rc.modes(met.system).uncertainty(mass=[50.0, 5.0], length_in_proportion=[0.02, 0.05]).angular_speed
print("standard deviations of 50 kg (load), 5 kg (hook block), 2 cm (slings) and 5 cm (rope) give")
print(f"standard deviations of {speed[0]:.4f} and {speed[1]:.4f} rad/s of the two speeds")

lengths = np.linspace(2.0, 28.0, 105)
speeds = np.array([rc.modes(hanging(rope)).angular_speed for rope in lengths])
figure, (axes,) = panels(1)
axes.plot(lengths, speeds, label=["slower mode", "faster mode"])
axes.axhline(SLEWING, color="0.4", linestyle="--", label="slewing")
axes.axvline(met.value, color="0.4", linestyle=":", label=f"{met.value:.2f} m: keep away")
axes.set(xlabel="length of rope (m)", ylabel="whirl speed (rad/s)", ylim=(0, None), title="2500 kg on slings of 6 m below a hook block of 400 kg")
legend_outside(axes)
save(figure, "crane")
