# SPDX-License-Identifier: GPL-3.0-or-later
"""When a clapper strikes. Truth: the two bodies with a side that gives way like a stiff spring, in other coordinates."""

import mpmath
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


@pytest.mark.parametrize(("name", "value"), [("clearance", 0.0), ("clearance", 1.6), ("amplitude", -0.1), ("amplitude", 3.2)])
def test_angles_out_of_range(name, value):
    with pytest.raises(ValueError, match=rf"revchain\.BellAndClapper\.first_strike: {name} must be between 0 and pi.*, got"):
        LIGHT.first_strike(**{"clearance": 0.3, name: value})


def test_a_bell_is_drawn_at_rest():
    pytest.importorskip("matplotlib")
    ax = LIGHT.plot()
    labels = [text.get_text() for text in ax.get_legend().get_texts()]
    assert labels == ["axle", "pin of the clapper", "centroid of the bell", "centroid of the clapper"]
    assert ax.yaxis_inverted()
    up = rc.bell_and_clapper(LIGHT.system, inverted=[True, False]).plot()
    assert up.get_ylabel() == "height above axle (m)" and not up.yaxis_inverted()
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


# The bell (-0.005, 1.363) of Woodhouse et al. (2012), doi:10.1155/2012/681787: joint and pendulum length of the bell over
# the pendulum length of the clapper. Our data: that is 0.65 m, contact at 27 degrees, release at rest at 170 degrees, the
# clapper on the lower side, a bell much heavier than its clapper. Thin: radius of gyration equal to the centroid's depth.
THIN = np.array([0.65 / 2, 1.363 * 0.65 / 2])


def woodhouse(mass):
    chain = rc.Chain(mass=[1.0, mass], length=0.65, centroid=THIN, radius_of_gyration=THIN)
    return rc.bell_and_clapper(chain, joint=-0.005 * 0.65)


def by_taylor(state, rests, stop, digits=20):
    """A bell that its clapper does not move, and the clapper: bell angle x, angle u in it. The motion by mpmath to where
    `stop` passes 0: time and state."""
    r, lb, lc, g = (mpmath.mpf(text) for text in ("-0.00325", "0.88595", "0.65", "9.80665"))

    def rates(_, y):
        x, u, vx, vu = y
        ax = -g / lb * mpmath.sin(x)
        # the pin moves on a circle of radius r: of its acceleration the part across the clapper turns it
        au = -ax - (r * (ax * mpmath.cos(u) + vx**2 * mpmath.sin(u)) + g * mpmath.sin(x + u)) / lc
        return [vx, 0, ax, 0] if rests else [vx, vu, ax, au]

    def pressed(y):
        """Acceleration that the clapper would have in the bell without contact."""
        x, u, vx, _ = y
        ax = -g / lb * mpmath.sin(x)
        return -ax - (r * (ax * mpmath.cos(u) + vx**2 * mpmath.sin(u)) + g * mpmath.sin(x + u)) / lc

    with mpmath.workdps(digits):
        motion = mpmath.odefun(rates, 0, state)
        rest = (lambda t: pressed(motion(t))) if stop is None else (lambda t: stop(motion(t)))
        low, step = mpmath.mpf("0.02"), mpmath.mpf("0.04")
        while rest(low) * rest(low + step) > 0:
            low += step
        time = mpmath.findroot(rest, (low, low + step), solver="anderson", tol=mpmath.mpf(10) ** (-2 * digits + 16))
        return time, motion(time)


def test_bell_of_woodhouse():
    """1.616683 s, from an integration with contact in 20 digits."""
    with mpmath.workdps(20):
        contact = 27 * mpmath.pi / 180
        lifted, state = by_taylor([170 * mpmath.pi / 180, -contact, 0, 0], True, None)
        assert lifted > 0.1  # it lies on the bell at first
        flown, state = by_taylor(state, False, lambda y: y[1] - contact)
        truth = np.array([-state[0], -state[3], lifted + flown], float)
    assert truth[2] == pytest.approx(1.616683, abs=5e-7)
    blow = woodhouse(1e15).first_strike("27 deg", amplitude="170 deg")
    assert (blow.status, blow.side) == ("strikes", "trailing")
    assert [blow.bell_angle, blow.relative_speed, blow.time] == pytest.approx(truth, rel=1e-13)
    assert blow.error_estimate < 1e-12
    errors = [woodhouse(mass).first_strike("27 deg", amplitude="170 deg").time - truth[2] for mass in (1e3, 1e5)]
    assert errors[1] == pytest.approx(errors[0] / 100, rel=2e-3)  # in proportion to the mass of the clapper
    sides = [woodhouse(1e9).first_strike("27 deg", amplitude="170 deg", clapper_angle=c) for c in ("27 deg", "-27 deg")]
    assert [each.side for each in sides] == ["trailing", "leading"]
    assert sides[0].time == pytest.approx(blow.time, abs=1e-8)


def test_speeds_of_bodies_that_stand():
    """Against the modes of a rig with these links inverted, where the pin is below the axle."""
    for inverted in ([True, False], [False, True], [True, True]):
        found = rc.bell_and_clapper(LIGHT.system, inverted=inverted, gravity=G)
        modes = rc.modes(rc.Rig(LIGHT.system, inverted=inverted), "all")
        swings = found.angular_speed[~np.isnan(found.angular_speed)]
        assert len(swings) == 2 - sum(inverted)
        heights = np.sort(found.conical_height[found.conical_height > 0])
        assert np.sort(modes.conical_height) == pytest.approx(heights, rel=1e-14)
        assert len(modes.other) == sum(inverted)
        assert found.inverted.tolist() == inverted and found.plot() is not None
    assert rc.bell_and_clapper(LIGHT.system, inverted=True) == rc.bell_and_clapper(LIGHT.system, inverted=[True, True])
    with pytest.raises(ValueError, match="inverted must be True, False or an array"):
        rc.bell_and_clapper(LIGHT.system, inverted=[True] * 3)


def test_a_bell_above_its_axle_is_an_inverted_one():
    """One bell in two descriptions: centroid -5 mm below the axle, or 5 mm with the bell inverted."""
    below = rc.bell_and_clapper(rc.Chain(mass=[18.0, 500.0], **LINKS | {"centroid": [0.52, -0.005]}), gravity=G)
    chain = rc.Chain(mass=[18.0, 500.0], **LINKS | {"centroid": [0.52, 0.005]})
    above = rc.bell_and_clapper(chain, joint=-0.15, inverted=[False, True], gravity=G)
    assert above.conical_height == pytest.approx(below.conical_height, rel=1e-14)
    assert above.inclination_ratio == pytest.approx(below.inclination_ratio, rel=1e-13)
    struck = 0
    for angle in (0.4, 1.0, 1.7, 2.4, 3.0):
        for clapper in (-0.5, -0.3, 0.0, 0.2, 0.5, None):
            one = below.first_strike(0.5, amplitude=angle, clapper_angle=clapper)
            other = above.first_strike(0.5, amplitude=np.pi - angle, clapper_angle=clapper)
            assert (one.status, one.side) == (other.status, other.side)
            if one.strikes:
                struck += 1
                assert abs(abs(one.bell_angle - other.bell_angle) - np.pi) < 1e-12
                assert [other.relative_speed, other.time] == pytest.approx([one.relative_speed, one.time], rel=1e-12)
    assert struck > 10


def test_starts_in_balance_and_both_inverted():
    assert LIGHT.first_strike(0.4, amplitude=np.pi, clapper_angle=0.0).status == "at_rest"
    assert LIGHT.first_strike(0.4, amplitude=0.0, clapper_angle=0.0)[:2] == (False, "")
    assert LIGHT.first_strike(0.4, amplitude=0.0).status == "at_rest"
    assert LIGHT.first_strike(0.4, amplitude=np.pi).strikes  # the clapper lies on one side
    assert LIGHT.first_strike(0.4, amplitude=np.pi, clapper_angle=1e-9).strikes
    assert not LIGHT.first_strike(0.3, amplitude=0.05).strikes and LIGHT.first_strike(0.3, amplitude=0.05).status == "turns"
    both = rc.bell_and_clapper(LIGHT.system, inverted=True, gravity=G)
    assert np.isnan(both.angular_speed).all() and (both.conical_height < 0).all()
    assert both.first_strike(0.4) == LIGHT.first_strike(0.4)
    one = rc.bell_and_clapper(LIGHT.system, inverted=[True, False])
    assert one.first_strike(0.4, amplitude=np.pi, clapper_angle=0.0).status == "at_rest"
    with pytest.raises(ValueError, match=r"give amplitude if one of .* is inverted, got inverted=\[True, False\]"):
        one.first_strike(0.4)
    with pytest.raises(ValueError, match="clapper_angle must be between -clearance and clearance, got 0.5"):
        LIGHT.first_strike(0.4, amplitude=1.0, clapper_angle=0.5)
    with pytest.raises(ValueError, match="without amplitude clapper_angle must be clearance or -clearance, got 0"):
        LIGHT.first_strike(0.4, clapper_angle=0.0)
    assert LIGHT.first_strike(0.4, clapper_angle=-0.4) == LIGHT.first_strike(0.4)


def test_a_bell_in_balance_with_its_clapper_on_a_side():
    """The balance of both as one body, to rounding: the clapper presses, and nothing moves for long."""
    d, c = LIGHT.present, 0.4
    tilt = np.arctan2(
        d["clapper_weight"] * d["clapper_centroid"] * np.sin(c),
        d["bell_weight"] * d["bell_centroid"] + d["clapper_weight"] * (d["joint"] + d["clapper_centroid"] * np.cos(c)),
    )
    found = LIGHT.first_strike(c, amplitude=np.pi - tilt, clapper_angle=-c)
    assert found.status == "at_rest" and np.isnan(found.time)
