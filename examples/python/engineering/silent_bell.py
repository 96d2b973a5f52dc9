# SPDX-License-Identifier: GPL-3.0-or-later
"""Church bell and clapper: a bell that does not ring
==================================================

How must a bell be hung so that bell and clapper swing as one body, and the clapper never strikes?
"""

import matplotlib.pyplot as plt

import revchain as rc

H1, RHO1, A1, W1 = 0.52, 0.08, 0.65, 18.0  # clapper: centroid, radius of gyration, length (m), mass (kg)
RHO2, A2, W2 = 0.30, 0.15, 500.0  # bell: radius of gyration, axle to the clapper's pin, mass


def hung(h2):
    """Clapper and bell, with the axle of the bell at this height above the bell's centre of gravity."""
    chain = rc.Chain(mass=[W1, W2], length=[A1, A2], centroid=[H1, h2], radius_of_gyration=[RHO1, RHO2])
    return rc.bell_and_clapper(chain)


bell = hung(0.10)
figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
bell.plot(axes)
axes.get_legend().remove()
plt.show()

# %%
# The triangle is the axle, the dot below it is the pin of the clapper, crosses are the centres of
# gravity. The bell has two modes. In each, clapper and bell swing with a fixed ratio of their
# angles; the title gives that of the slower mode. If it is 1, the bell is silent.
#
# The table changes the height at which the bell is hung.

silent = bell.with_ratio(1.0)["bell_centroid"]
print("centroid of the bell m  clapper/bell inclination, mode 1 and 2")
for h2 in (0.05, 0.10, silent, 0.25):
    first, second = hung(h2).inclination_ratio
    print(f"{h2:22.4f}  {first:+.6f}  {second:+.6f}")
print(f"hung {1000 * silent:.1f} mm above its centre of gravity the bell is silent in its slower mode")

# %%
# Greenhill (1908) section 8 (16): with m = W2 h2 / (W1 a2) this happens if the clapper's centre of
# gravity is h1 = (m + 1) l1 + m (a2 - l2) below its pin. Any other dimension can be changed
# instead.

print("hung 100 mm above it: single changes that silence the bell, or make the clapper swing 1.5 times as far:")
louder = bell.with_ratio(1.5)
for name, value in bell.with_ratio(1.0).items():
    print(f"{name:27} now {bell.present[name]:8.4f}, silent {value:8.4f}, ringing {louder[name]:8.4f}")

# %%
# To try next: a lighter clapper, ``W1 = 12.0``. The figures are illustrative.
#
# Checked: ``tests/cpp/bell.cpp``, ratios against quadruple precision and silent values against the
# paper's equation.
