# SPDX-License-Identifier: GPL-3.0-or-later
"""A crane slewing at a given speed: on which lengths of hoist rope does it meet a whirl speed of its load?

While the rope is wound in, hook block and load are a double pendulum whose two whirl speeds rise. The
number of them below the slewing speed changes where one of them equals it.
"""

import numpy as np

import revchain as rc

SLEWING = 0.8  # rad/s
HOOK, LOAD = 400.0, 2500.0  # kg; only their ratio matters
SLINGS = 6.0  # m


def slower_modes(rope):
    """How many whirl speeds lie below the slewing speed with this much rope."""
    chain = rc.Chain(weight=[LOAD, HOOK], length=[SLINGS, rope])
    return int(rc.count_modes(chain, angular_speed=SLEWING))


print(" rope m  slower  faster whirl speed, rad/s")
for rope in np.arange(4.0, 29.0, 4.0):
    speeds = rc.modes(rc.Chain(weight=[LOAD, HOOK], length=[SLINGS, rope])).angular_speed()
    print(f"{rope:7.1f}  {speeds[0]:.4f}  {speeds[1]:.4f}")

low, high = 1.0, 40.0
assert slower_modes(low) == 0 and slower_modes(high) == 1
while high - low > 1e-9:
    middle = (low + high) / 2
    low, high = (middle, high) if slower_modes(middle) == 0 else (low, middle)
print(f"slewing at {SLEWING} rad/s meets the slower one with {low:.3f} m of rope: keep away from that")
