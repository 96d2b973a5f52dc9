# SPDX-License-Identifier: GPL-3.0-or-later
"""A crane slewing at a given speed: on which lengths of hoist rope does it meet a whirl speed of its load?

While the rope is wound in, hook block and load are a double pendulum whose two whirl speeds rise. Asked
besides: what a change of rope or slings does to them there, and how well they are known.
"""

import numpy as np

import revchain as rc

SLEWING = 0.8  # rad/s
HOOK, LOAD = 400.0, 2500.0  # kg; only their ratio matters
SLINGS = 6.0  # m


def hanging(rope):
    """The load, below the hook block, with this much rope."""
    return rc.Chain(weight=[LOAD, HOOK], length=[SLINGS, rope])


print(" rope m  slower  faster whirl speed, rad/s")
for rope in np.arange(4.0, 29.0, 4.0):
    speeds = rc.modes(hanging(rope)).angular_speed
    print(f"{rope:7.1f}  {speeds[0]:.4f}  {speeds[1]:.4f}")

met = rc.tune(hanging(10.0), mode=1, link=2, quantity="length_in_proportion", angular_speed=SLEWING)
assert met.complete and len(met.values) == 1
print(f"slewing at {SLEWING} rad/s meets the slower one with {met.value:.3f} m of rope: keep away from that")
for mode, name in ((1, "slower"), (2, "faster")):
    share = rc.modes(met.system).sensitivity.relative.length_in_proportion[mode - 1]
    print(
        f"one per cent more sling lowers the {name} speed by {share[0] / 2:.3f} per cent, of rope by {share[1] / 2:.3f}"
    )
speed = rc.modes(met.system).uncertainty(weight=[50.0, 5.0], length_in_proportion=[0.02, 0.05]).angular_speed
print(f"load to 50 kg, hook to 5, slings to 2 cm and rope to 5: speeds to {speed[0]:.4f} and {speed[1]:.4f} rad/s")
