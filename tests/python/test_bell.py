# SPDX-License-Identifier: GPL-3.0-or-later
"""When a clapper strikes. Truth: the two bodies with a side that gives way like a stiff spring, in other coordinates."""

import numpy as np
import pytest

import revchain as rc

scipy_integrate = pytest.importorskip("scipy.integrate")
G = 9.81
LINKS = {"length": [0.65, 0.15], "centroid": [0.52, 0.2], "radius_of_gyration": [0.08, 0.3]}
LIGHT = rc.bell_and_clapper(rc.Chain(mass=[18.0, 500.0], **LINKS), gravity=G)
HEAVY_CLAPPER = rc.bell_and_clapper(
    rc.Chain(mass=[30.0, 200.0], length=[0.8, 0.3], centroid=[0.7, 0.25], radius_of_gyration=[0.1, 0.35]), gravity=G
)
ABOVE, IN_THE_AXLE = (rc.bell_and_clapper(LIGHT.system, joint=joint, gravity=G) for joint in (-0.03, 0.0))


def by_springs(bell, clearance, state, stiffness):
    """First touch of the other side, the clapper resting on a spring: bell angle, relative speed. Angles of the bell and
    of the clapper in the bell; energies from the places of the masses, differentiated by hand in these coordinates."""
    d = bell.present
    m1, m2 = d["clapper_weight"], d["bell_weight"]
    h1, h2, a = d["clapper_centroid"], d["bell_centroid"], d["joint"]
    k1, k2 = d["clapper_radius_of_gyration"] ** 2, d["bell_radius_of_gyration"] ** 2
    start, damping = np.sign(state[1]), 4 * np.sqrt(stiffness * m1 * (h1 * h1 + k1))

    def side(depth, speed):
        return max(0.0, stiffness * depth + damping * speed) if depth > 0 else 0.0

    def rates(_, y):
        x, u, vx, vu = y
        # squares of speeds: m2 (h2^2 + k2) vx^2 + m1 [a^2 vx^2 + h1^2 (vx + vu)^2 + 2 a h1 cos u vx (vx + vu) + k1 (vx + vu)^2]
        c, s = a * h1 * np.cos(u), a * h1 * np.sin(u)
        own = h1 * h1 + k1
        mass = np.array([
            [m2 * (h2 * h2 + k2) + m1 * (a * a + own + 2 * c), m1 * (own + c)],
            [m1 * (own + c), m1 * own],
        ])
        force = np.array([
            m1 * s * vu * (2 * vx + vu) - G * (m2 * h2 + m1 * a) * np.sin(x) - G * m1 * h1 * np.sin(x + u),
            -m1 * s * vx * vx - G * m1 * h1 * np.sin(x + u) - start * side(start * u - clearance, start * vu),
        ])
        return np.concatenate([y[2:], np.linalg.solve(mass, force)])

    def touches(_, y):
        return start * y[1] + clearance

    touches.terminal, touches.direction = True, -1
    found = scipy_integrate.solve_ivp(rates, (0, 60), state, events=touches, method="Radau", rtol=1e-8, atol=1e-10, max_step=0.1)
    assert found.t_events[0].size == 1
    x, u, _, vu = found.y[:, -1]
    return -x, -vu


@pytest.mark.parametrize(
    ("bell", "clearance"),
    [*((bell, clearance) for bell in (LIGHT, HEAVY_CLAPPER, IN_THE_AXLE) for clearance in (0.2, 0.45)), (ABOVE, 0.2)],
)
def test_first_blow_of_a_full_circle(bell, clearance):
    blow = bell.first_strike(clearance)
    assert blow.strikes and blow.side == "leading"
    d = bell.present
    tilt = np.arctan2(
        d["clapper_weight"] * d["clapper_centroid"] * np.sin(clearance),
        d["bell_weight"] * d["bell_centroid"] + d["clapper_weight"] * (d["joint"] + d["clapper_centroid"] * np.cos(clearance)),
    )
    state = np.array([np.pi - tilt - 1e-3, clearance, -3e-3, 0.0])  # beside the balance, by little
    soft, stiff = (np.array(by_springs(bell, clearance, state, stiffness)) for stiffness in (1e5, 1e6))
    limit = stiff + (stiff - soft) / 9
    assert limit == pytest.approx([blow.bell_angle, blow.relative_speed], abs=5e-4)


@pytest.mark.parametrize("amplitude", [1.8, 2.5])
def test_let_go_at_rest(amplitude):
    blow = LIGHT.first_strike(0.3, amplitude=amplitude)
    assert blow.strikes and blow.side == "trailing" and blow.relative_speed < 0
    soft, stiff = (np.array(by_springs(LIGHT, 0.3, np.array([amplitude, -0.3, 0.0, 0.0]), k)) for k in (1e5, 1e6))
    assert stiff + (stiff - soft) / 9 == pytest.approx([blow.bell_angle, blow.relative_speed], abs=5e-4)


def test_small_swings_do_not_strike_and_larger_ones_do():
    reach = LIGHT.strike_amplitude("3 deg")
    apart = LIGHT.inclination_ratio[0] - 1
    assert reach == pytest.approx(np.radians(3) / apart, rel=1e-15)
    m = rc.modes(LIGHT.system, gravity=G)
    slope = np.diff(m.shape[0]) / LIGHT.system.length  # of the clapper, of the bell
    assert slope[0] / slope[1] - 1 == pytest.approx(apart, rel=1e-12)
    silent = rc.Chain(mass=[18.0, 500.0], **LINKS | {"length": [0.65, LIGHT.with_ratio(1.0)["joint"]]})
    assert rc.bell_and_clapper(silent).strike_amplitude(0.1) > 1e12
    assert not LIGHT.first_strike(0.3, amplitude=0.05).strikes
    assert np.isnan(LIGHT.first_strike(0.3, amplitude=0.05).bell_angle)


def test_in_another_gravity_only_times_change():
    one, other = LIGHT.first_strike(0.3), rc.bell_and_clapper(LIGHT.system, gravity=G / 6).first_strike(0.3)
    assert other.bell_angle == pytest.approx(one.bell_angle, rel=1e-12)
    assert other.time == pytest.approx(one.time * 6**0.5, rel=1e-12)
    assert other.relative_speed == pytest.approx(one.relative_speed / 6**0.5, rel=1e-12)


@pytest.mark.parametrize(("name", "value"), [("clearance", 0.0), ("clearance", 1.6), ("amplitude", 0.0), ("amplitude", 3.2)])
def test_angles_out_of_range(name, value):
    with pytest.raises(ValueError, match=rf"revchain\.BellAndClapper\.first_strike: {name} must be between 0 and pi.*, got"):
        LIGHT.first_strike(**{"clearance": 0.3, name: value})


def test_a_bell_is_drawn_at_rest():
    pytest.importorskip("matplotlib")
    ax = LIGHT.plot()
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["axle", "pin of the clapper", "centroid of the bell", "centroid of the clapper"]
    assert ax.yaxis_inverted()
    low = rc.bell_and_clapper(rc.Chain(mass=[18.0, 500.0], **LINKS | {"centroid": [0.52, 1e-3]}))  # a pendulum of 90 m
    assert "90" in low.plot().get_legend().get_texts()[-1].get_text()


def test_a_clapper_pinned_above_the_axle_or_in_it():
    """500 kg and 18 kg; above the axle the slower mode is that in which they lean opposite ways."""
    assert ABOVE.angular_speed == pytest.approx([4.29572, 3.87184], abs=5e-6)
    assert ABOVE.mode.tolist() == [2, 1] and LIGHT.mode.tolist() == [1, 2] and ABOVE.present["joint"] == -0.03
    assert (ABOVE.inclination_ratio > 0).tolist() == [True, False]
    assert ABOVE.with_ratio(1.2)["joint"] < 0 or np.isnan(ABOVE.with_ratio(1.2)["joint"])
    d = LIGHT.present
    alone = [d[f"{part}_centroid"] + d[f"{part}_radius_of_gyration"] ** 2 / d[f"{part}_centroid"] for part in ("bell", "clapper")]
    assert sorted(IN_THE_AXLE.conical_height) == pytest.approx(sorted(alone), rel=1e-15)
    with pytest.raises(ValueError, match="do not move each other"):
        IN_THE_AXLE.with_ratio(1.0)
    with pytest.raises(ValueError, match="joint"):
        rc.bell_and_clapper(LIGHT.system, joint=np.nan)
    assert "2" in str(ABOVE) and ABOVE.plot() is not None
