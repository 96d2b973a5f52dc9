# SPDX-License-Identifier: GPL-3.0-or-later
"""Scenes for tests of studies, and laws for what varies."""

UNIFORM = {"uniform_chain": {"kind": "rods", "count": 3, "length": 1.0, "weight": 1.0, "tip_mass": 0.3}}
GYROSTAT = {
    "links": [{"mass": 2.0, "length": 0.4, "flywheel": {"mass": 1.5, "radius_of_gyration": 0.29, "spin": 40.0}}] * 2,
    "support": {"stiffness": 200.0, "mass": 0.1, "radius": 0.02},
    "ask": {"modes": {"count": 3}, "shapes": {"angular_speed": 9.0}, "response": {"angular_speed": {"from": 2.0, "to": 9.0, "steps": 4}}},
}
GOVERNOR = {"ball_mass": 2.3, "arm": 0.33, "lower_arm": 0.33, "sleeve_mass": 9.5, "friction": 6.0}
STOPS = {"lowest_inclination": "25 deg", "highest_inclination": 0.6}
CAROUSEL = {"links": [{"mass": 80.0, "length": 4.0}], "support": {"radius": 3.0}}


def uniform(low, high):
    return {"uniform": [low, high]}


def normal(mean, deviation):
    return {"normal": [mean, deviation]}


def words(*values):
    return {"values": list(values)}
