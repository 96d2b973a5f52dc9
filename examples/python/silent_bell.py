# SPDX-License-Identifier: GPL-3.0-or-later
"""A bell that does not ring
=========================

A bell that does not ring: in one mode bell and clapper turn as one body, and the clapper never strikes.

Greenhill (1908) section 8 (16): with m = W2 h2 / (W1 a2) this happens if the clapper's centre of gravity is
h1 = (m + 1) l1 + m (a2 - l2) below its pin. Index 1 is the clapper (the lower link), 2 the bell. The program finds how high
above its centre of gravity the bell must be hung for this. Illustrative figures.

Checked: ``tests/cpp/bell.cpp``, ratios against quadruple precision and silent values against the paper's equation.
"""


import revchain as rc
from revchain.plots.programs import save

H1, RHO1, A1, W1 = 0.52, 0.08, 0.65, 18.0  # clapper: centroid, radius of gyration, length (m), mass (kg)
RHO2, A2, W2 = 0.30, 0.15, 500.0  # bell: radius of gyration, axle to the clapper's pin, mass


def hung(h2):
    """Bell and clapper, with the axle of the bell at this height above the bell's centre of gravity."""
    return rc.Chain(mass=[W1, W2], length=[A1, A2], centroid=[H1, h2], radius_of_gyration=[RHO1, RHO2])


print("centroid of the bell m  clapper/bell inclination, mode 1 and 2")
bell = rc.bell_and_clapper(hung(0.10))
silent = bell.with_ratio(1.0)["bell_centroid"]
for h2 in (0.05, 0.10, silent, 0.25):
    first, second = rc.bell_and_clapper(hung(h2)).inclination_ratio
    print(f"{h2:22.4f}  {first:+.6f}  {second:+.6f}")
print(f"hung {1000 * silent:.1f} mm above its centre of gravity the bell is silent in its slower mode")
print("hung 100 mm above it: single changes that silence the bell, or make the clapper swing 1.5 times as far:")
louder = bell.with_ratio(1.5)
for name, value in bell.with_ratio(1.0).items():
    print(f"{name:27} now {bell.present[name]:8.4f}, silent {value:8.4f}, ringing {louder[name]:8.4f}")

save(rc.bell_and_clapper(hung(silent)).plot().figure, "silent_bell")
