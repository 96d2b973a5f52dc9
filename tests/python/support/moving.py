# SPDX-License-Identifier: GPL-3.0-or-later
"""A result of every kind that moves, and its film."""

import numpy as np

import revchain as rc
from revchain.motion.staging import Choices, staged

CHAIN = rc.Chain(mass=[1.0, 2.0, 1.0], length=[0.5, 1.0, 0.7], names=["load", "$hook$", "</script>"])
WHEELS = rc.Rig(
    rc.Chain(mass=1.5, length=[0.1] * 4, centroid=0.05, radius_of_gyration=[0.2, 0.02, 0.02, 0.02]),
    support=rc.Support(stiffness=900.0, mass=0.5),
    flywheels=rc.Flywheel(mass=1.5, radius_of_gyration=0.29, spin=[40.0, -40.0, 0.0, 0.0]),
    inverted=[False, False, True, False],
)
CAROUSEL = rc.Rig(rc.Chain(mass=[80.0, 5.0], length=[1.0, 3.0]), support=rc.Support(radius=1.0))
TOP = rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=0.2))
BLADE = rc.Held(rc.Chain.uniform_rods(10, length=1.0), span=0.5)
ROPE = rc.Held(rc.Cord(1.0), span=0.5)
ARMS = rc.Held(
    rc.Chain.uniform_rods(10, length=1.0), span=0.5, lower=rc.Support(radius=0.1), upper=rc.Support(radius=0.2)
)
RELEASED = [0.05, 0.02, 0.01, 0.0]
TIMES = np.linspace(0.5, 2.5, 21)

ONE = {  # a single figure
    "shape": lambda: rc.steady_shapes(CHAIN, angular_speed=4.0)[0],
    "cord shape": lambda: rc.steady_shapes(rc.Cord(1.0, tip_weight=0.1), conical_height=0.1)[0],
    "branch": lambda: rc.branch(CHAIN, 1, max_angular_speed=9.0),
    "held shape": lambda: rc.steady_shapes(BLADE, angular_speed=15.0, max_half_waves=1)[0],
    "held cord shape": lambda: rc.steady_shapes(ROPE, angular_speed=9.0)[0],
    "cord branch": lambda: rc.branch(rc.Cord(1.0), 2, max_angular_speed=14.0),
    "held branch": lambda: rc.branch(BLADE, 1, max_angular_speed=15.0),
    "held cord branch": lambda: rc.branch(ROPE, 1, max_angular_speed=9.0),
    "response": lambda: rc.response(CHAIN, angular_speed=np.linspace(1.0, 9.0, 81), support_radius=0.01),
    "response at a speed": lambda: rc.response(WHEELS, angular_speed=9.0, support_radius=0.01),
    "swing": lambda: rc.swing(CHAIN, TIMES, offset=RELEASED),
    "rig swing": lambda: rc.swing(rc.Rig(CHAIN, support=rc.Support(stiffness=200.0, mass=1.0)), TIMES, offset=RELEASED),
    "whirl swing": lambda: rc.swing(TOP, TIMES, offset=[0.1, 0.0]),
    "cord swing": lambda: rc.swing(rc.Cord(1.0), TIMES, offset=lambda s: 0.1 * (1 - s)),
}
SEVERAL = {
    "modes": lambda: rc.modes(CHAIN),
    "modes of a rig": lambda: rc.modes(WHEELS),
    "modes of a cord": lambda: rc.modes(rc.Cord(1.0), 3),
    "modes of a held chain": lambda: rc.modes(rc.Held(rc.Chain.uniform_rods(10), tension=30.0, weightless=True), 3),
    "modes of a held cord": lambda: rc.modes(rc.Held(rc.Cord(1.0), tension=30.0), 3),
    "long double": lambda: rc.modes(CHAIN, precision="extended"),
    "shapes": lambda: rc.steady_shapes(CHAIN, angular_speed=9.0),
    "shapes of a carousel": lambda: rc.steady_shapes(CAROUSEL, angular_speed=3.0),
    "shapes of a blade": lambda: rc.steady_shapes(BLADE, angular_speed=15.0, max_half_waves=2),
    "shapes on arms": lambda: rc.steady_shapes(ARMS, angular_speed=15.0, max_half_waves=1, budget=0),
    "shapes of a rope": lambda: rc.steady_shapes(ROPE, angular_speed=9.0),
    "branches": lambda: rc.branches(CHAIN, max_angular_speed=9.0),
    "branches of a cord": lambda: rc.branches(rc.Cord(1.0), max_angular_speed=10.0),
    "branches of a carousel": lambda: rc.branches(CAROUSEL, max_angular_speed=4.0),
    "branches of a blade": lambda: rc.branches(BLADE, max_angular_speed=12.0),
}
ALL = ONE | SEVERAL


def film(result, figures=None, time_scale=None, duration=None, frames_per_second=25.0):
    return staged(result, Choices("place", frames_per_second, figures, time_scale, duration))
