# SPDX-License-Identifier: GPL-3.0-or-later
"""Governors with a sleeve: numbers of text books, laws, tables and what is refused. Speeds by the forces in the links:
tests/cpp/sleeve_governor.cpp."""

import json
import math
import pickle

import mpmath as mp
import numpy as np
import pytest
from exact import near
from tier import by_tier

import revchain as rc

WATT = {"ball_mass": 4.0, "arm": 1.4, "lower_arm": 1.4, "sleeve_mass": 3.0, "gravity": 12.0}
HARTNELL = {
    "ball_mass": 1.5, "arm": 0.12, "pivot_offset": 0.12, "sleeve_arm": 0.06, "sleeve_mass": 2.0, "spring_stiffness": 5000.0,
    "spring_force": 150.0, "friction": 5.0, "lowest_inclination": -0.2, "highest_inclination": 0.3,
}  # fmt: skip


def test_watt_and_porter():
    hanging, open_ = rc.SleeveGovernor(**WATT).equilibria(5.0)
    assert math.cos(open_.inclination) == near(0.6, rel=3e-16) and open_.period == near(0.7 * math.pi, rel=1e-15)
    assert (hanging.stable, open_.stable, hanging.inclination) == (False, True, 0.0)
    light = rc.SleeveGovernor(**WATT, shaft_inertia=0.0).equilibria("5 rad/s")[1]
    assert light.period / math.pi == near(0.388, rel=1e-3)
    porter = rc.SleeveGovernor(ball_mass=2.3, arm=0.33, lower_arm=0.33, sleeve_mass=9.5122, gravity=9.81)
    assert porter.at("27 deg").angular_speed * 30 / math.pi == near(125.0, rel=1e-6)
    unequal = rc.SleeveGovernor(ball_mass=30 / 9.81, arm=0.2, lower_arm=0.25, sleeve_mass=225 / 9.81, gravity=9.81)
    assert unequal.at(["30 deg", "40 deg"]).angular_speed == near([20.7264, 21.8109], rel=2.4e-6)


@pytest.mark.parametrize("inertia", [math.inf, 0.0, 7.0])
def test_watts_periods_in_40_digits(inertia):
    """From the second derivative of the energy: at constant speed, or at constant angular momentum."""
    with mp.workdps(40):
        m, M, l, g, n = (mp.mpf(x) for x in ("4", "3", "1.4", "12", "5"))
        angle = mp.acos(mp.mpf("0.6"))

        def turning(x):
            return 2 * m * (l * mp.sin(x)) ** 2

        momentum = n * (inertia + turning(angle)) if inertia < math.inf else mp.mpf(0)

        def energy(x):
            height = -2 * m * g * l * mp.cos(x) - 2 * M * g * l * mp.cos(x)
            if inertia == math.inf:
                return height - n**2 * turning(x) / 2
            return height + momentum**2 / (2 * (inertia + turning(x)))

        moving = 2 * m * l**2 + M * (2 * l * mp.sin(angle)) ** 2
        period = 2 * mp.pi * mp.sqrt(moving / mp.diff(energy, angle, 2))
    found = rc.SleeveGovernor(**WATT, shaft_inertia=inertia).equilibria(5.0)[1]
    assert found.period == near(float(period), rel=1e-14)


def test_a_shaft_whose_speed_is_held_is_left_out_of_attributes():
    """Its moment of inertia is infinite, which the JSON of an attribute cannot hold."""
    for given in ({}, {"shaft_inertia": 0.4}):
        found = rc.SleeveGovernor(**WATT, **given).equilibria(8.0)
        kept, data = {**WATT, **given}, json.loads(found.to_xarray().attrs["governor"])
        assert {name: data[name] for name in kept} == kept and ("shaft_inertia" in data) == bool(given)
        assert found.to_dict()["governor"]["shaft_inertia"] == given.get("shaft_inertia", math.inf)


def test_the_stops_of_hartnells_governor(tmp_path):
    governor = rc.SleeveGovernor(**HARTNELL)
    at = governor.at([-0.2, 0.05, 0.3])
    assert (governor.lowest_speed, governor.highest_speed) == (at.angular_speed[0], at.angular_speed[2])
    assert governor.sensitiveness == near(2 * (at.angular_speed[2] - at.angular_speed[0]) / (at.angular_speed[2] + at.angular_speed[0]), rel=1e-15)
    assert governor.lift == near(0.06 * (math.sin(0.3) + math.sin(0.2)), rel=1e-14)
    assert governor.insensitiveness == near((at.high_speed[1] - at.low_speed[1]) / at.angular_speed[1], rel=1e-14)
    assert (at.low_speed < at.angular_speed).all() and (at.angular_speed < at.high_speed).all() and at.stable.all()
    text = str(governor)
    assert "lift 0.02965 m, sensitiveness 9.84 %" in text and "rises at (rpm)" in text and "inclination (°)" in text
    assert governor.to_dict()["points"][0]["angular_speed"] == at.angular_speed[0]
    assert pickle.loads(pickle.dumps(governor)) == governor
    governor.save(tmp_path / "governor.npz")
    assert rc.load(tmp_path / "governor.npz") == governor
    assert governor.plot(speed="rad/s").get_ylabel() == "lift of the sleeve (m)"
    assert rc.SleeveGovernor(ball_mass=1.0, arm=1.0).plot().get_ylabel() == "balls off the axis (m)"


def test_equilibria_at_a_speed(tmp_path):
    """A sequence of points, with a table, a picture and files."""
    governor = rc.SleeveGovernor(**WATT, joint="1.4 m")
    found = governor.equilibria("5 rad/s")
    assert len(found) == 2 and found[-1] == list(found)[1] and found[1].angular_speed == 5.0
    assert found.inclination.tolist() == [one.inclination for one in found] and found.stable.tolist() == [False, True]
    text = str(found)
    assert "2 equilibria at 5.00000 rad/s (47.75 rpm), proved complete" in text and "53.130" in text
    assert found.to_dict()["governor"]["sleeve_mass"] == 3.0 and found.to_dict()["points"][1]["lift"] == near(1.12, rel=4e-16)
    assert pickle.loads(pickle.dumps(found)) == found and found != governor.equilibria(5.1)
    for name in ("e.npz", "e.nc"):
        found.save(tmp_path / name)
        assert rc.load(tmp_path / name) == found
    assert "1 equilibrium at" in str(governor.equilibria(3.0))
    assert found.plot(speed="rad/s").get_xlabel() == "speed (rad/s)"
    dots = [line for line in found.plot().lines if line.get_marker() == "o"]
    places = [(dot.get_xdata()[0], dot.get_ydata()[0]) for dot in dots]
    np.testing.assert_allclose(places, [(5.0, 0.0), (5.0, 1.12)], rtol=4e-16)
    assert governor.describe() == "governor: 2 balls of 4 kg on arms of 1.4 m; lower links of 1.4 m; sleeve of 3 kg"


def test_without_a_sleeve_it_is_a_conical_pendulum():
    speed = np.array([3.5, 5.0, 9.0])
    pendulum = rc.SleeveGovernor(ball_mass=3.0, arm=1.0, balls=1)
    heights = [pendulum.equilibria(n)[1].height for n in speed]
    assert heights == near(rc.conical_pendulum.height(speed), rel=4e-16)
    (rest,) = pendulum.equilibria(0.0)
    assert rest.stable and rest.period == near(2 * math.pi * math.sqrt(1 / 9.80665), rel=4e-16)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"sleeve_mass": 1.0}, "sleeve mass needs a sleeve"),
        ({"lower_arm": 1.0, "sleeve_arm": 1.0}, "give lower_arm or sleeve_arm, not both"),
        ({"balls": 1.5}, "balls must be a whole number from 1 to 1000"),
        ({"lowest_inclination": 0.1}, "give both lowest_inclination and highest_inclination"),
        ({"lowest_inclination": 0.3, "highest_inclination": 0.1}, "must be below highest_inclination"),
        ({"lowest_inclination": 0.3, "highest_inclination": 2.1}, "cannot reach this inclination"),
        ({"ball_mass": -1.0}, "ball mass"),
        ({"arm": math.nan}, "arm"),
        ({"shaft_inertia": -1.0}, "shaft inertia must not be negative"),
    ],
)
def test_what_is_refused(given, words):
    with pytest.raises(ValueError, match=words):
        rc.SleeveGovernor(**({"ball_mass": 1.0, "arm": 1.0} | given))


def test_the_effort_in_the_axis_is_a_limit():
    """At inclination 0, where moment of the balls and way of the sleeve vanish, as beside it."""
    rng = np.random.default_rng(7)
    for _ in range(by_tier(50, 1000)):
        ball, arm, sleeve, joint, longer, change = rng.uniform(0.3, 3.0, 6)
        joint = arm * min(joint / 3, 1.0)
        governor = rc.SleeveGovernor(
            ball_mass=ball, arm=arm, balls=int(rng.integers(1, 5)), lower_arm=joint * (1.05 + longer), joint=joint,
            sleeve_mass=sleeve, spring_stiffness=rng.uniform(0, 9), spring_force=rng.uniform(0, 9),
        )  # fmt: skip
        there, beside = governor.effort(0.0, change), governor.effort(1e-4, change)
        np.testing.assert_allclose(there, beside, rtol=1e-6)
        assert 0 < there.effort < math.inf and np.isnan(there.power) == np.isnan(there.lift)
    equal = rc.SleeveGovernor(ball_mass=2.3, arm=0.33, lower_arm=0.33, sleeve_mass=9.5, gravity=9.81)
    assert equal.effort(0.0, 0.01).effort == near((2.3 + 9.5) * 9.81 * (0.01 + 0.01**2 / 2), rel=1e-14)


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({}, "effort: needs a sleeve: give the governor lower_arm or sleeve_arm"),
        ({"lower_arm": 1.0, "pivot_offset": 0.05, "sleeve_offset": 0.05}, "at a speed above 0, got 0 with speed 0"),
        ({"sleeve_arm": 1.0, "sleeve_mass": 1.0}, "at a speed above 0, got 0 with speed inf"),
        ({"lower_arm": 1.0, "sleeve_offset": 0.05, "sleeve_mass": 1.0}, "at a speed above 0, got 0 with speed nan"),
    ],
)
def test_efforts_that_are_refused(given, words):
    with pytest.raises(ValueError, match=words):
        rc.SleeveGovernor(**({"ball_mass": 1.0, "arm": 1.0} | given)).effort(0.0)


def test_calls_that_are_refused():
    governor = rc.SleeveGovernor(**WATT)
    for ask, words in (
        (lambda: governor.at(1.6), "cannot reach"),
        (lambda: governor.equilibria(-1.0), "speed"),
        (lambda: governor.effort(0.5, 0.0), "change must be positive"),
        (lambda: governor.at("3 kg"), "must be an angle"),
    ):
        with pytest.raises(ValueError, match=words):
            ask()


def test_links_that_reach_a_little_way_alone():
    """A cell of the search whose ends the links do not reach may hold all that they reach."""
    governor = rc.SleeveGovernor(ball_mass=1, arm=1, pivot_offset=0.5, sleeve_offset=0.5, lower_arm=0.01, sleeve_mass=1)
    at = governor.at(math.asin(0.0099))
    found = governor.equilibria(float(at.angular_speed))
    assert np.abs(np.asarray(found.inclination) - math.asin(0.0099)).min() < 1e-12
