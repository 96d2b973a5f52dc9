# SPDX-License-Identifier: GPL-3.0-or-later
"""Blade of a vertical-axis wind turbine (troposkien)
==================================================

The blade of a wind turbine with a vertical axis, in the shape of a whirling rope, which has no bending stress. Gravity is
included. The dashed form (two straight ends and an arc) is how such blades are made.

Checked: ``tests/python/test_held.py``, against the balance of moments and against integration of the rope with gravity.
"""

import numpy as np

import revchain as rc
from revchain.plots.programs import COLOURS, panels, save

LENGTH, SPAN, MASS, WIND = 24.0, 17.0, 160.0, 10.0  # m of blade, m of mast, kg of blade, m/s

light = rc.SkippingRope(span=SPAN, length=LENGTH)
RADIUS = light.sag


def straight_arc_straight(length, span, sag):
    """Two straight ends with a circular arc between them, of given length, span and sag."""

    def parts(angle):  # of the straight ends to the axis
        c, s = np.cos(angle), np.sin(angle)
        return np.linalg.solve([[c, s], [s, 1 - c]], [span / 2, sag])  # straight end, radius of the arc

    low, high = np.arctan2(sag, span / 2) + 1e-6, np.pi / 2
    for _ in range(80):
        middle = (low + high) / 2
        end, radius = parts(middle)
        if 2 * (end + radius * middle) < length:
            low = middle
        else:
            high = middle
    return low, *parts(low)


def on_straight_arc_straight(arc, length, form):
    """Heights and offsets at lengths along that form."""
    angle, end, radius = form
    turn = (arc - length / 2) / radius
    on_arc = np.abs(turn) <= angle
    out = np.minimum(arc, length - arc)
    height = np.where(on_arc, SPAN / 2 + radius * np.sin(turn), np.where(turn < 0, 0, SPAN))
    height = height + np.where(on_arc, 0, -np.sign(turn) * out * np.cos(angle))
    offset = np.where(on_arc, RADIUS - radius * (1 - np.cos(turn)), out * np.sin(angle))
    return height, offset


figure, (side, apart) = panels(2, height=5.5)
form = straight_arc_straight(LENGTH, SPAN, light.sag)
arc = np.linspace(0, LENGTH, 401)
rope = light.at_arc(arc)
print(f"straight ends of {form[1]:.2f} m at {np.degrees(form[0]):.1f} degrees, an arc of radius {form[2]:.2f} m")
print("tip-speed  turns a   sag, m  height of   pull below,  pull above,  from the light")
print("ratio      minute            sag, m      kN           kN           rope, m")
cord = rc.Held(rc.Cord(LENGTH, mass=MASS), span=SPAN)
blade = rc.Held(rc.Chain.uniform_rods(200, length=LENGTH, mass=MASS), span=SPAN)
for ratio, colour in zip((1.25, 2.0, 4.0, 8.0), COLOURS, strict=False):
    speed = ratio * WIND / RADIUS
    shape = rc.steady_shapes(blade, angular_speed=speed)[0]
    along = rc.steady_shapes(cord, angular_speed=speed)[0].at(arc)
    lowest = int(np.argmax(along.offset))
    off = np.hypot(along.offset - rope.offset, along.height - rope.x)
    numbers = (ratio, 30 * speed / np.pi, along.offset[lowest], along.height[lowest])
    pulls = (np.hypot(*shape.lower_pull) / 1e3, np.hypot(*shape.upper_pull) / 1e3)
    print("{:9.2f}  {:7.1f}  {:7.2f}  {:9.2f}  {:11.2f}  {:11.2f}  {:14.3f}".format(*numbers, *pulls, off.max()))
    side.plot(along.offset, along.height, color=colour, label=f"{ratio:g}: {30 * speed / np.pi:.0f} turns/min")
    apart.plot(arc, off, color=colour)
height, offset = on_straight_arc_straight(arc, LENGTH, form)
side.plot(offset, height, color="black", linestyle="--", linewidth=1, label="straight, arc, straight")
apart.plot(arc, np.hypot(offset - rope.offset, height - rope.x), color="black", linestyle="--", linewidth=1)
side.axvline(0, color="0.6", linewidth=0.8, linestyle="-.")
side.set(xlabel="distance from mast (m)", ylabel="height above the lower bearing (m)")
side.set(title="a 24 m blade at four tip-speed ratios", xlim=(-0.5, 9))
side.set_aspect("equal")
figure.legend(loc="outside lower center", ncols=3)
apart.set(xlabel="distance along the blade (m)", ylabel="distance from the light rope (m)")
apart.set_title("difference from the rope without gravity")
apart.set_yscale("log")
apart.set_ylim(1e-3, 10)
save(figure, "troposkien")
