# SPDX-License-Identifier: GPL-3.0-or-later
"""Thomson's gyrostatic string: against a row of links moved at one end, and its pictures."""

from __future__ import annotations

import pickle

import mpmath as mp
import numpy as np
import pytest
from scipy.linalg import solve_banded

import revchain as rc

WHEELS = {"weight": 15.0, "length": 0.1, "tension": 2000.0, "radius_of_gyration": 0.2}


def string(momentum=0.5, **other):
    return rc.GyrostaticString(**{**WHEELS, **other}, momentum=momentum)


def offsets(given, speed, count):
    """Offsets of the first pins of a long row, pin 0 moved, the far end held: assembled from the links' mass matrices; a
    little damping lets the wave die out before it comes back."""
    W, a, h, rho = given.weight, given.length, given.centroid, WHEELS["radius_of_gyration"]
    diagonal = W * (h**2 + (a - h) ** 2 + 2 * rho**2) / a**2 / 2
    beside = W * (h * (a - h) - rho**2) / a**2
    k = (given.tension + speed * given.momentum / a) / a * (1 + 1e-3j * np.sign(speed))
    w = speed**2 / 9.80665
    bands = np.empty((3, count - 1), complex)
    bands[0] = bands[2] = -k - w * beside
    bands[1] = 2 * k - 2 * w * diagonal
    right = np.zeros(count - 1, complex)
    right[0] = -bands[0, 0]
    return np.concatenate([[1.0], solve_banded((1, 1), bands, right)[:50]])


@pytest.mark.parametrize("speed", [20.0, -20.0, 50.0, -50.0])
@pytest.mark.parametrize(("momentum", "centroid"), [(0.5, 0.05), (0.5, 0.02), (-0.5, 0.02), (0.0, 0.02)])
def test_the_phase_is_that_of_a_long_row_driven_at_its_end(speed, momentum, centroid):
    given = string(momentum, centroid=centroid)
    y = offsets(given, speed, 200_000)
    seen = np.abs(np.angle(y[1:50] / y[:49]))
    assert seen == pytest.approx(given.phase(speed), rel=2e-5)


def test_the_plane_turns_by_half_the_difference_of_the_phases():
    given = string()
    speeds = np.array([5.0, 20.0, 50.0])
    assert given.plane_rotation(speeds) == pytest.approx((given.phase(-speeds) - given.phase(speeds)) / 2, rel=1e-12)
    assert given.plane_rotation(20.0) == -string(-0.5).plane_rotation(20.0)
    assert string(1e-12).plane_rotation(20.0) == pytest.approx(2e-12 * string(0.5).plane_rotation(20.0), rel=1e-3)
    assert np.isnan(given.plane_rotation(1e5))


def test_a_string_is_a_value():
    given = string()
    assert pickle.loads(pickle.dumps(given)) == given and hash(given) == hash(string())
    assert given != string(0.25)
    assert (given.weight, given.length, given.tension, given.momentum) == (15.0, 0.1, 2000.0, 0.5)
    with pytest.raises(AttributeError, match="cannot assign"):
        given.momentum = 1.0


@pytest.mark.parametrize("speed", [1e-300, 1e-160, 1e-20, 20.0, 1e5, 1e160, 1e300])
@pytest.mark.parametrize("scale", [1e-290, 1e-100, 1.0, 1e100, 1e290])
def test_extreme_strings_have_phases_and_speeds(speed, scale):
    """Against the same formulas in 60 digits and any exponent."""
    with mp.workdps(2500):
        W, a, T, rho, H, g = map(mp.mpf, (15.0 * scale, 0.1, 2000.0 / scale, 0.2, 0.5, 9.80665))
        given = string(weight=15.0 * scale, tension=2000.0 / scale)
        share = mp.mpf(0.05) / a * (1 - mp.mpf(0.05) / a) - (rho / a) ** 2
        sines = []
        for n in (mp.mpf(speed), -mp.mpf(speed)):
            stiffness = (T + n * H / a) / a + n**2 / g * W * share
            sines.append(n**2 / g * W / (4 * stiffness))
            phase, attenuation = given.phase(float(n)), given.attenuation(float(n))
            exact = 2 * mp.asin(mp.sqrt(sines[-1])) if 0 <= sines[-1] <= 1 else mp.pi if sines[-1] > 1 else 0
            assert phase == pytest.approx(float(exact), rel=1e-13, abs=0)
            decay = 0 if 0 <= sines[-1] <= 1 else 2 * mp.asinh(mp.sqrt(max(-sines[-1], sines[-1] - 1)))
            assert attenuation == pytest.approx(float(decay), rel=1e-13, abs=0)
        turn = given.plane_rotation(speed)
        if all(0 <= sine < 1 for sine in sines):
            ahead, back = (mp.asin(mp.sqrt(sine)) for sine in sines)
            assert turn == pytest.approx(float(back - ahead), rel=1e-12, abs=0)
        else:
            assert np.isnan(turn)  # one of the two waves does not pass
        for angle in (5e-324, 1e-200, 1e-3, 1.0, np.pi):
            chord = 2 * mp.sin(mp.mpf(angle) / 2)
            A, B, C = W / g * (1 - chord**2 * share), H / a**2 * chord**2, T / a * chord**2
            root = mp.sqrt(B**2 + 4 * A * C)
            found = given.angular_speeds(angle)
            for speed_found, exact in zip(found, ((B + root) / (2 * A), -2 * C / (B + root)), strict=True):
                if abs(exact) > 1e-290 and abs(exact) < 1e308:
                    assert speed_found == pytest.approx(float(exact), rel=1e-13, abs=0)
                assert not np.isnan(speed_found)


def test_a_string_of_point_masses_has_no_bound_at_half_a_turn():
    found = string(0.0, radius_of_gyration=0.0).angular_speeds(np.pi)
    assert (found.forward, found.backward) == (np.inf, -np.inf)


def test_a_length_too_small_for_its_centroid_is_refused():
    with pytest.raises(ValueError, match="length must not be so small"):
        string(length=1e-200, radius_of_gyration=1.0)


@pytest.mark.parametrize("name", ["weight", "length", "tension", "gravity"])
def test_wrong_strings_are_refused(name):
    with pytest.raises(ValueError, match=f"{name} must be positive and finite, got 0"):
        string(**{name: 0.0})
    with pytest.raises(ValueError, match="momentum must be finite"):
        string(np.nan)
    with pytest.raises(ValueError, match="radius of gyration must be finite and not negative"):
        string(radius_of_gyration=-1.0)
    for wrong in (0.0, -1.0, 4.0, np.nan):
        with pytest.raises(ValueError, match="phase"):
            string().angular_speeds(wrong)
    for wrong in (0.0, -1.0, np.nan):
        with pytest.raises(ValueError, match="angular"):
            string().plane_rotation(wrong)


def test_pictures():
    given = string()
    assert given.plot().get_ylabel() == "speed (rad/s)"
    assert given.plot_vibration(50.0).get_xlabel() == "link"
    with pytest.raises(ValueError, match="does not pass"):
        given.plot_vibration(1e5)
