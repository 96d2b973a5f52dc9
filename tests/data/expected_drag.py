# SPDX-License-Identifier: GPL-3.0-or-later
"""A ball on a thread that an arm carries round in air, in many digits: the balance of forces in the turning frame."""

import mpmath as mp
from expected_rigs import number


def ball(scene, digits):
    """Place of the ball, tension and torque of a scene with one plummet: x outward, y in the sense of motion, z up."""
    [link], asked = scene["links"], scene["ask"]["drag"]
    mass, length, air = number(link["mass"]), number(link["length"]), link["air_drag"]
    radius, speed, gravity = number(scene["support"]["radius"]), number(asked["angular_speed"]), mp.mpf("9.80665")
    k = number(asked["air_density"]) / 2 * number(air["coefficient"]) * number(air["area"])

    def forces(x, y, z, pull):
        out = mp.sqrt(x * x + y * y)
        return [
            pull * (radius - x) / length + mass * speed**2 * x + k * speed**2 * out * y,
            -pull * y / length + mass * speed**2 * y - k * speed**2 * out * x,
            -pull * z / length - mass * gravity,
            (x - radius) ** 2 + y * y + z * z - length**2,
        ]

    start = [radius + length, -length / 10, -gravity / speed**2, mass * speed**2 * (radius + length)]
    x, y, z, pull = mp.findroot(forces, start, tol=mp.mpf(10) ** -140, maxsteps=100)
    shown = {"outward": x, "ahead": y, "height": z, "tension": pull, "torque": k * speed**2 * mp.sqrt(x * x + y * y) ** 3}
    return {name: mp.nstr(value, digits) for name, value in shown.items()}
