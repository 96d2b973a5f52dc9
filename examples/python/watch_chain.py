# SPDX-License-Identifier: GPL-3.0-or-later
"""A watch chain twirled by a string: how close 120 links come to the continuous chain.

python watch_chain.py [PICTURE.png]
"""

import sys

import revchain as rc

chain = rc.Chain.uniform_rods(120, length=0.36)  # metres; the weight does not matter
result = rc.modes(chain, count=5)
continuous = rc.heavy_chain.conical_heights(5, length=0.36)

print(result)
print()
print("mode  rpm  rpm, continuous  relative difference of the height")
for k, (height, limit) in enumerate(zip(result.conical_height, continuous, strict=True)):
    speeds = 60 * rc.conical_pendulum.revolutions_per_second([height, limit])
    print(f"{k + 1:4}  {speeds[0]:7.3f}  {speeds[1]:19.3f}  {height / limit - 1:+33.2e}")

if len(sys.argv) > 1:
    axes = result.plot()
    axes.set_title("A watch chain of 120 links")
    axes.figure.savefig(sys.argv[1], dpi=150)
    print("wrote", sys.argv[1])
