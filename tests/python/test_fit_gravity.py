# SPDX-License-Identifier: GPL-3.0-or-later
"""Gravity from measured speeds, and which measured speed disagrees: closed forms, independent formulas, samples."""

import math

import mpmath as mp
import numpy as np
import pytest
import scipy.stats
from rigs import random_chain
from tier import by_tier

import revchain as rc

G = 9.80665


def measured_of(system, numbers, gravity, noise=0.0, uncertainty=None, rng=None):
    """Speeds of modes by number at another gravity, each with a relative error."""
    found = rc.modes(system, max(map(abs, numbers)), gravity=gravity)
    if isinstance(system, rc.Rig):
        exact = [abs(found.angular_speed[(found.number == abs(k)) & (found.direction == np.sign(k))][0]) for k in numbers]
    else:
        exact = [found.angular_speed[k - 1] for k in numbers]
    off = np.array(exact) * (1 + noise * (rng.normal(size=len(numbers)) if rng is not None else 0.0))
    return {k: float(x) if uncertainty is None else (float(x), float(uncertainty * x)) for k, x in zip(numbers, off, strict=True)}


# ---- gravity


def test_gravity_from_one_period():
    """A simple pendulum: g = (2 pi / T)^2 a, u(g) / g = 2 u(T) / T."""
    found = rc.fit(rc.Chain(mass=1.0, length=1.0), {1: ("2.01 s", "0.02 s")}, vary="gravity")
    assert found["gravity"] == found.gravity == found.value[0] == pytest.approx((2 * math.pi / 2.01) ** 2, rel=1e-14)
    assert found.standard_uncertainty[0] == pytest.approx(2 * found.gravity * 0.02 / 2.01, rel=1e-12)
    assert found.unit == ("m/s^2",) and found.present.tolist() == [G] and "m/s^2" in repr(found).splitlines()[2]
    assert found.system == rc.Chain(mass=1.0, length=1.0) and found.to_dict()["gravity"] == found.gravity
    assert rc.fit(rc.Chain(mass=1.0, length=1.0), {1: "2.01 s"}, vary={"gravity": 3.0}, gravity=4.0).gravity == pytest.approx(found.gravity, rel=1e-12)


def test_gravity_from_several_speeds_is_linear_in_its_root():
    """n_k = s c_k with s = sqrt(g), so that least squares have a closed form; 40 digits."""
    cord, rng = rc.Cord(1.2, mass=0.05), np.random.default_rng(5)
    for _ in range(10):
        off, spread = 0.01 * rng.normal(size=4), rng.uniform(0.005, 0.02, 4)
        with mp.workdps(40):
            c = [mp.besseljzero(0, k) / 2 / mp.sqrt(mp.mpf(cord.length)) for k in range(1, 5)]
            speed = [float(mp.sqrt(G) * one * (1 + x)) for one, x in zip(c, off, strict=True)]
            weight = [1 / (mp.mpf(float(n * s)) ** 2) for n, s in zip(speed, spread, strict=True)]
            root = sum(w * a * n for w, a, n in zip(weight, c, speed, strict=True)) / sum(w * a**2 for w, a in zip(weight, c, strict=True))
            value, deviation = root**2, 2 * root / mp.sqrt(sum(w * a**2 for w, a in zip(weight, c, strict=True)))
        found = rc.fit(cord, {k + 1: (speed[k], speed[k] * spread[k]) for k in range(4)}, vary="gravity")
        assert found.gravity == pytest.approx(float(value), rel=1e-12)
        assert found.standard_uncertainty[0] == pytest.approx(float(deviation), rel=1e-9)
        assert found.degrees_of_freedom == 3


CHAIN = rc.Chain(mass=[2.0, 1.0, 0.5], length=[0.5, 0.4, 0.3], names=["bob", "middle", "upper"])
WHEELS = rc.Flywheel(mass=0.3, radius_of_gyration=0.15, spin=[60.0, -20.0, 0.0])
WHOLE = rc.Rig(
    rc.Chain(mass=2.0, length=[0.5, 0.4, 0.3], centroid=[0.25, 0.2, 0.15], radius_of_gyration=0.2),
    support=rc.Support(stiffness=400.0, mass=0.8), flywheels=WHEELS, displaced=rc.Displaced(mass=0.2),
)  # fmt: skip
SYSTEMS = {
    "chain": (CHAIN, (1, 2, 3), ["gravity", "links[bob].mass"]),
    "by weight": (rc.Chain(weight=[1.0, 3.0, 2.0], length=1.0), (1, 2, 3), ["gravity", "links[0].weight"]),
    "cord": (rc.Cord(2.0, mass=1.0, tip_mass=0.3), (1, 2, 3), ["gravity", "tip_mass"]),
    "rig": (rc.Rig(CHAIN, support=rc.Support(stiffness=300.0, mass=0.4)), (1, 2, 3), ["gravity", "support.stiffness"]),
    "wheels": (WHOLE, (1, 2, -1, -2), ["gravity", "flywheels[0].spin", "support.mass"]),
    "springs at pins": (rc.Rig(CHAIN, pins=rc.Pin(stiffness=[0.0, 3.0, 2.0])), (1, 2, 3), ["gravity", "pins[upper].stiffness"]),
    "held": (rc.Held(CHAIN, tension=80.0), (1, 2), ["gravity", "tension"]),
    "held, by weight": (rc.Held(rc.Chain(weight=[1.0, 3.0, 2.0], length=1.0), tension=9.0), (1, 2), ["gravity"]),
}


@pytest.mark.parametrize("name", SYSTEMS)
def test_gravity_that_was_changed_is_found_again(name):
    system, numbers, vary = SYSTEMS[name]
    true = 9.61
    found = rc.fit(system, measured_of(system, numbers, true, uncertainty=1e-3), vary=vary)
    assert found.status == "success" and found.gravity == found["gravity"] == pytest.approx(true, rel=1e-9)
    np.testing.assert_allclose(found.value[1:], found.present[1:], rtol=1e-7)
    np.testing.assert_allclose(found.computed, found.measured, rtol=1e-11)
    # its uncertainty with the others, by differences of the speeds of `modes` themselves
    slopes = []
    for path, value, step in zip(vary, found.value, found.value * 1e-4, strict=True):
        near = []
        for x in (value - step, value + step):
            from revchain.systems.datum import datum_at

            changed = system if path == "gravity" else datum_at("", found.system, path, true).change(float(x))
            at = measured_of(changed, numbers, float(x) if path == "gravity" else true)
            near.append(np.array([*at.values()]))
        slopes.append((near[1] - near[0]) / (2 * step))
    scaled = np.column_stack(slopes) / (1e-3 * np.abs(found.measured))[:, None]
    want = np.sqrt(np.linalg.inv(scaled.T @ scaled).diagonal())
    np.testing.assert_allclose(found.standard_uncertainty, want, rtol=1e-4)


def test_gravity_and_length_cannot_be_told_apart():
    found = rc.fit(CHAIN, measured_of(CHAIN, (1, 2, 3), 9.7, uncertainty=0.01), vary=["gravity", "length"])
    assert found.status == "undetermined" and found.undetermined == (("gravity", "length"),)
    assert "cannot tell gravity and length apart" in repr(found)
    with pytest.raises(ValueError, match="gravity .start of gravity. must be an acceleration"):
        rc.fit(CHAIN, {1: 3.0}, vary={"gravity": "3 m"})
    with pytest.raises(ValueError, match="the start of gravity must be finite and more than 0, got -1"):
        rc.fit(CHAIN, {1: 3.0}, vary={"gravity": -1.0})
    assert rc.fit(CHAIN, {1: 3.0}, vary={"gravity": "980 cm/s^2"}).present.tolist() == [G]
    with pytest.raises(ValueError, match='vary has "gravity" and "gravity"'):
        rc.fit(CHAIN, {1: 3.0, 2: 4.0}, vary=["gravity", "gravity"])


def test_gravity_of_one_speed_by_tune():
    cord = rc.Cord(1.2, mass=0.05)
    for system in (CHAIN, cord, SYSTEMS["held, by weight"][0]):
        speed = rc.modes(system, 2, gravity=9.5).angular_speed[1]
        found = rc.tune(system, vary="gravity", mode=2, angular_speed=speed)
        assert found.status == "found" and found.complete and abs(found.value - 9.5) <= found.error_bound < 1e-11
        assert found.system == system and found.present == G and "gravity = 9.5" in repr(found)
    for name in ("rig", "springs at pins", "held"):
        system = SYSTEMS[name][0]
        speed = measured_of(system, (2,), 9.5)[2]
        found = rc.tune(system, vary="gravity", mode=2, angular_speed=speed)
        assert found.value == pytest.approx(9.5, rel=1e-12) and not found.complete
        nothing = rc.tune(system, vary="gravity", mode=2, angular_speed=speed, between=(1.0, 2.0))
        assert nothing.status == "undecided" and nothing.value is None and nothing.reachable is None
    with pytest.raises(ValueError, match="gravity cannot be found for a conical height, which does not depend on it"):
        rc.tune(CHAIN, vary="gravity", conical_height=1.0)
    with pytest.raises(ValueError, match="gravity cannot be found of a system held at a span"):
        rc.tune(rc.Held(CHAIN, span=1.0), vary="gravity", angular_speed=3.0, top_tension=60.0)
    with pytest.raises(ValueError, match="between is for a search, and gravity has one value"):
        rc.tune(CHAIN, vary="gravity", angular_speed=3.0, between=(9.0, 10.0))
    with pytest.raises(ValueError, match="mode must be from 1 to 3"):
        rc.tune(CHAIN, vary="gravity", mode=4, angular_speed=3.0)


# ---- which measurement disagrees


def drawn(rng, size=5):
    """A random chain, paths to vary, and its speeds."""
    chain = random_chain(rng, size, spread=0.7)
    return chain, [f"links[{size - 1}].length_in_proportion", "links[0].weight"], rc.modes(chain).angular_speed


def slopes_of(chain, vary, step=1e-5):
    """Relative derivatives of the speeds by the logarithms of the data, by differences of the speeds."""
    from revchain.systems.datum import datum_at

    columns = []
    for path in vary:
        datum = datum_at("", chain, path, G)
        down, up = (rc.modes(datum.change(datum.present * (1 + x))).angular_speed for x in (-step, step))
        columns.append((up - down) / (up + down) / step)
    return np.column_stack(columns)


def test_leverage_is_the_diagonal_of_the_hat_matrix():
    rng = np.random.default_rng(1)
    for _ in range(by_tier(5, 50)):
        chain, vary, speed = drawn(rng)
        spread = rng.uniform(0.5, 2.0, 5) * 1e-3
        off = speed * (1 + spread * rng.normal(size=5))
        found = rc.fit(chain, {k + 1: (off[k], speed[k] * spread[k]) for k in range(5)}, vary=vary)
        design = slopes_of(found.system, vary) * (found.computed / found.measured_uncertainty)[:, None]
        hat = design @ np.linalg.lstsq(design, np.eye(5), rcond=None)[0]
        np.testing.assert_allclose(found.leverage, hat.diagonal(), rtol=1e-6, atol=1e-9)
        assert found.leverage.sum() == pytest.approx(2, rel=1e-9)
        want = found.normalized_residual / np.sqrt(1 - hat.diagonal())
        np.testing.assert_allclose(found.standardized_residual, want, rtol=1e-5, atol=1e-9)
        assert found.disagreement_limit == pytest.approx(scipy.stats.norm.isf(0.01 / 10), rel=1e-12)


def test_residuals_are_those_of_fits_without_the_measurement():
    """The deleted residual over its deviation, from fits of the other measurements, of small errors."""
    rng = np.random.default_rng(2)
    for _ in range(by_tier(3, 30)):
        chain, vary, speed = drawn(rng, 6)
        off = speed * (1 + 1e-5 * rng.normal(size=6))
        known = rc.fit(chain, {k + 1: (off[k], 1e-5 * speed[k]) for k in range(6)}, vary=vary)
        bare = rc.fit(chain, {k + 1: off[k] for k in range(6)}, vary=vary)
        np.testing.assert_allclose(bare.leverage, known.leverage, rtol=1e-3)
        assert bare.disagreement_limit == pytest.approx(scipy.stats.t.isf(0.01 / 12, 3), rel=1e-10)
        for k in range(6):
            others = rc.fit(chain, {j + 1: off[j] for j in range(6) if j != k}, vary=vary)
            predicted = rc.modes(others.system).angular_speed[k]
            deleted = (off[k] - predicted) / off[k]
            left = math.sqrt(1 - known.leverage[k])
            assert known.standardized_residual[k] == pytest.approx(deleted * left / 1e-5, rel=1e-3, abs=1e-3)
            scatter = others.measured_uncertainty[0] / others.measured[0]  # of the others, estimated
            assert bare.standardized_residual[k] == pytest.approx(deleted * left / scatter, rel=1e-3, abs=1e-3)


@pytest.mark.parametrize("given", [True, False], ids=["given", "estimated"])
def test_a_wrong_measurement_is_found(given):
    rng, size = np.random.default_rng(3), 6
    for _ in range(by_tier(10, 100)):
        chain, vary, speed = drawn(rng, size)
        noise = 1e-4
        exact = rc.fit(chain, {k + 1: (speed[k], noise * speed[k]) for k in range(size)}, vary=vary)
        k = int(rng.integers(size))
        if exact.leverage[k] > 0.9:  # what such a measurement says is hardly checked by the others
            continue
        off = speed * (1 + noise * rng.normal(size=size))
        off[k] *= 1 + rng.choice([-1, 1]) * noise * (12 if given else 60) / math.sqrt(1 - exact.leverage[k])
        found = rc.fit(chain, {j + 1: (off[j], noise * speed[j]) if given else off[j] for j in range(size)}, vary=vary)
        assert found.disagreeing == (k + 1,), (found.standardized_residual, k)
        assert f"mode {k + 1} disagrees with the others: " in repr(found) and "(leverage 0." in repr(found)
        assert found.to_dict()["disagreeing"] == [k + 1]


@pytest.mark.parametrize("given", [True, False], ids=["given", "estimated"])
def test_a_correct_measurement_is_seldom_called_wrong(given):
    """At most one fit in a hundred. With given uncertainties Bonferroni's bound is nearly reached."""
    rng, alarms, size = np.random.default_rng(4), 0, by_tier(60, 1000)
    chain, vary, speed = drawn(rng)
    for _ in range(size):
        off = speed * (1 + 1e-4 * rng.normal(size=5))
        measured = {k + 1: (off[k], 1e-4 * speed[k]) if given else off[k] for k in range(5)}
        found = rc.fit(chain, measured, vary=vary)
        assert bool(found.disagreeing) == ("disagree" in repr(found))
        alarms += bool(found.disagreeing)
    assert alarms <= scipy.stats.binom.isf(1e-6, size, 0.01), (alarms, size)
    if given and size >= 1000:
        assert alarms >= scipy.stats.binom.ppf(1e-6, size, 0.005), (alarms, size)


def test_what_cannot_be_told():
    """With one degree of freedom all residuals are equal; a measurement of leverage 1 cannot disagree."""
    crane = rc.Chain(mass=[2500, 400], length=[6, 24])
    one = rc.fit(crane, {1: ("10.2 s", "0.02 s"), 2: ("1.60 s", "0.01 s")}, vary="length")
    assert np.ptp(np.abs(one.standardized_residual)) < 1e-6 * abs(one.standardized_residual[0])
    assert one.disagreeing == (1, 2) and "modes 1 and 2 disagree: " in repr(one)
    assert "; measure them again" in repr(one)  # a chain of two point masses has no other modes
    three = rc.Chain(mass=[2500, 400, 100], length=[6, 24, 3])
    assert "measure more modes to tell which of them is wrong" in repr(
        rc.fit(three, {1: ("10.2 s", "0.02 s"), 2: ("1.60 s", "0.01 s")}, vary="length")
    )
    bare = rc.fit(crane, {1: "10.2 s", 2: "1.60 s"}, vary="length")
    assert np.isnan(bare.standardized_residual).all() and math.isnan(bare.disagreement_limit) and bare.disagreeing == ()
    full = rc.fit(crane, {1: ("10.2 s", "0.02 s"), 2: ("1.60 s", "0.01 s")}, vary=["length", "links[0].mass"])
    np.testing.assert_allclose(full.leverage, 1.0, rtol=1e-9)
    assert np.isnan(full.standardized_residual).all() and full.disagreeing == () and "disagree" not in repr(full)
    speed = rc.modes(CHAIN).angular_speed
    exact = rc.fit(CHAIN, dict(enumerate(speed * math.sqrt(1.01), 1)), vary="gravity")  # errors of rounding are no scatter
    assert np.isnan(exact.standardized_residual).all() and exact.disagreeing == ()
    close = rc.fit(CHAIN, {k + 1: (n, 1e-3 * n) for k, n in enumerate(speed)}, vary="gravity")
    assert close.disagreeing == () and np.abs(close.standardized_residual).max() < 1e-6
    far = rc.fit(CHAIN, {1: (speed[0], 1e-9), 2: (speed[1], 1e-9), 3: (1.1 * speed[2], 1e-9)}, vary="gravity")
    assert far.disagreeing and "over 1000 standard deviations" in repr(far)


def test_the_result_is_kept(tmp_path):
    found = rc.fit(CHAIN, measured_of(CHAIN, (1, 2, 3), 9.7, 0.01, 0.01, np.random.default_rng(7)), vary=["gravity", "links[bob].mass"])
    found.save(tmp_path / "a.npz")
    again = rc.load(tmp_path / "a.npz")
    assert again == found and again.gravity == found.gravity and again.disagreeing == found.disagreeing
    np.testing.assert_array_equal(again.standardized_residual, found.standardized_residual)
    assert found.unit == ("m/s^2", "kg")
    by_weight = rc.fit(rc.Chain(weight=[1.0, 3.0], length=1.0), {1: 3.0, 2: 6.0}, vary=["links[0].weight", "length"])
    assert by_weight.unit == ("", "m")
