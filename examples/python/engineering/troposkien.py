# SPDX-License-Identifier: GPL-3.0-or-later
"""Troposkien: the blade of a Darrieus wind turbine
================================================

Which shape has the blade of a vertical-axis wind turbine if it is to have no bending stress? That of a whirling rope.
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

LENGTH, SPAN, MASS, WIND = 24.0, 17.0, 160.0, 10.0  # m of blade, m of mast, kg of blade, m/s

cord = rc.Held(rc.Cord(LENGTH, mass=MASS), span=SPAN)
(shape,) = rc.steady_shapes(cord, angular_speed="50 rpm")

figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
axes.plot([0, 0], [-1.5, SPAN + 1], color="0.3", linewidth=6)
for side in (-1, 1):
    axes.plot(side * shape.offset, shape.height, color="C0", linewidth=4)
axes.set(xlabel="distance from mast (m)", ylabel="height (m)", aspect="equal")
plt.show()

# %%
# The picture shows both blades at 50 rpm, 24 m long on 17 m of mast. Gravity is included: the
# widest point is a little below the middle.
#
# A rope without weight has one shape at every speed. How far is the heavy blade from that shape?
# The tip-speed ratio is the speed of the widest point over that of the wind, here 10 m/s. The table
# has the largest distance in its last column.

light = rc.SkippingRope(span=SPAN, length=LENGTH)
arc = np.linspace(0, LENGTH, 401)
rope = light.at_arc(arc)
found = {}
print("tip-speed  turns a   sag, m  height of   pull below,  pull above,  from the light")
print("ratio      minute            sag, m      kN           kN           rope, m")
for ratio in (1.25, 2.0, 4.0, 8.0):
    speed = ratio * WIND / light.sag
    shape = rc.steady_shapes(cord, angular_speed=speed)[0]
    along = shape.along(arc)
    found[f"{ratio:g}: {30 * speed / np.pi:.0f} rpm"] = along
    lowest = int(np.argmax(along.offset))
    off = np.hypot(along.offset - rope.offset, along.height - rope.x)
    numbers = (ratio, 30 * speed / np.pi, along.offset[lowest], along.height[lowest])
    pulls = (np.hypot(*shape.lower_pull) / 1e3, np.hypot(*shape.upper_pull) / 1e3)
    print("{:9.2f}  {:7.1f}  {:7.2f}  {:9.2f}  {:11.2f}  {:11.2f}  {:14.3f}".format(*numbers, *pulls, off.max()))

# %%
# Blades are made as two straight ends and a circular arc. The bisection finds the angle of the
# straight ends that gives the same length and the same sag.


def ends_and_arc(angle):
    """Length of each straight end, and radius of the arc, with the ends at this angle to the axis."""
    c, s = np.cos(angle), np.sin(angle)
    return np.linalg.solve([[c, s], [s, 1 - c]], [SPAN / 2, light.sag])


low, high = np.arctan2(light.sag, SPAN / 2) + 1e-6, np.pi / 2
for _ in range(80):
    angle = (low + high) / 2
    end, radius = ends_and_arc(angle)
    low, high = (angle, high) if 2 * (end + radius * angle) < LENGTH else (low, angle)
print(f"straight ends of {end:.2f} m at {np.degrees(angle):.1f} degrees, an arc of radius {radius:.2f} m")

turn, out = (arc - LENGTH / 2) / radius, np.minimum(arc, LENGTH - arc)
bent = np.abs(turn) <= angle
made_offset = np.where(bent, light.sag - radius * (1 - np.cos(turn)), out * np.sin(angle))
made_height = SPAN / 2 + np.where(bent, radius * np.sin(turn), np.sign(turn) * (SPAN / 2 - out * np.cos(angle)))

# %%
# On the left, the shapes at four tip-speed ratios, and the form with straight ends, dashed. On the
# right, the distance from the rope without weight, on a logarithmic scale: the faster the turbine,
# the less gravity matters.

figure, (side, apart) = plt.subplots(1, 2, figsize=(8, 5.5), layout="constrained")
for label, along in found.items():
    side.plot(along.offset, along.height, label=label)
    apart.plot(arc, np.hypot(along.offset - rope.offset, along.height - rope.x))
side.plot(made_offset, made_height, color="black", linestyle="--", linewidth=1, label="straight, arc, straight")
apart.plot(arc, np.hypot(made_offset - rope.offset, made_height - rope.x), color="black", linestyle="--", linewidth=1)
side.set(xlabel="distance from mast (m)", ylabel="height above the lower bearing (m)", xlim=(-0.5, 9), aspect="equal")
apart.set(xlabel="distance along the blade (m)", ylabel="distance from the light rope (m)")
apart.set(yscale="log", ylim=(1e-3, 10))
figure.legend(loc="outside lower center", ncols=3)
plt.show()

# %%
# To try next: a longer blade on the same mast, ``LENGTH = 30.0``.
#
# Checked: ``tests/python/test_held.py``, against the balance of moments and against integration of
# the rope with gravity.
