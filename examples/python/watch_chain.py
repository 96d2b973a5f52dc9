# SPDX-License-Identifier: GPL-3.0-or-later
"""Watch chain: 120 links and the continuous limit
===============================================

A watch chain twirled by a string: how close its 120 links are to the continuous limit.

Checked: the heights of the links are in 40 digits in ``examples/scenes/watch_chain.expected.json``. Those of the limit are
4 L / j², with the zeros j of the Bessel function J₀.
"""


import revchain as rc
from revchain.plots.programs import save

chain = rc.Chain.uniform_rods(120, length=0.36)  # metres; the weight does not matter
result = rc.modes(chain, count=5)
continuous = rc.modes(rc.Cord(0.36), count=5)

print(result)
print()
print("mode  rpm  rpm, continuous  relative difference of the height")
for k, off in enumerate(result.conical_height / continuous.conical_height - 1):
    print(f"{k + 1:4}  {result.rpm[k]:7.3f}  {continuous.rpm[k]:19.3f}  {off:+33.2e}")

axes = result.plot()
axes.set_title("A watch chain of 120 links")
save(axes.figure, "watch_chain")

# %%
# The five modes turning. Drag the picture to turn the view.

result.show()
