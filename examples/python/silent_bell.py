# SPDX-License-Identifier: GPL-3.0-or-later
"""A bell that does not ring: in one mode bell and clapper turn as one body, and the clapper never strikes.

Greenhill (1908) section 8 (16): with m = W2 h2 / (W1 a2) that happens where the clapper's centre of
gravity lies h1 = (m + 1) l1 + m (a2 - l2) below its pin; 1 is the clapper (the lower link), 2 the
bell. Asked here: how high must the bell be hung for that? Illustrative figures.
"""

import revchain as rc

H1, RHO1, A1, W1 = 0.52, 0.08, 0.65, 18.0  # clapper: centroid, radius of gyration, length (m), mass (kg)
RHO2, A2, W2 = 0.30, 0.15, 500.0  # bell: radius of gyration, gudgeons to the clapper's pin, mass
L1 = H1 + RHO1**2 / H1  # equivalent simple pendulum


def silence(h2):
    """Zero where the bell is silent: relation (16)."""
    m = W2 * h2 / (W1 * A2)
    return (m + 1) * L1 + m * (A2 - (h2 + RHO2**2 / h2)) - H1


def inclinations(h2):
    """Inclination of the clapper over that of the bell, in both modes."""
    chain = rc.Chain(weight=[W1, W2], length=[A1, A2], centroid=[H1, h2], radius_of_gyration=[RHO1, RHO2])
    shape = rc.modes(chain).shape
    return ((shape[:, 0] - shape[:, 1]) / A1) / ((shape[:, 1] - shape[:, 2]) / A2)


low, high = 0.10, 0.30
assert silence(low) < 0 < silence(high)
while high - low > 1e-12:
    middle = (low + high) / 2
    low, high = (middle, high) if silence(middle) < 0 else (low, middle)

print("centroid of the bell m  clapper/bell inclination, mode 1 and 2")
for h2 in (0.05, 0.10, low, 0.25):
    first, second = inclinations(h2)
    print(f"{h2:22.4f}  {first:+.6f}  {second:+.6f}")
print(f"hung {1000 * low:.1f} mm above its centre of gravity the bell is silent in one of its modes")
