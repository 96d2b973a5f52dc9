# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives, uncertainties, inverse questions, attached weights and bells from Python, against independent figures."""

import math
import pickle

import mpmath as mp
import numpy as np
import pytest
from exact import heights_of, stored_links

import revchain as rc
from revchain import Chain, _core

QUANTITIES = ("weight", "length", "centroid", "radius_of_gyration", "length_in_proportion")


def bodies(count: int = 4) -> Chain:
    rng = np.random.default_rng(3)
    length = rng.uniform(0.5, 1.5, count)
    return Chain(
        weight=rng.uniform(0.5, 3, count),
        length=length,
        centroid=length * rng.uniform(0.2, 1.1, count),
        radius_of_gyration=length * rng.uniform(0.1, 0.5, count),
    )


def moved(links, quantity, m, x):
    """(W, a, h, rho^2) of every link, one datum of link m being x."""
    w, a, h, square = links[m]
    if quantity == "weight":
        w = x
    elif quantity == "length":
        a = x
    elif quantity == "centroid":
        h = x
    elif quantity == "radius_of_gyration":
        square = x**2
    else:
        a, h, square = x, h * x / a, square * (x / a) ** 2
    return [*links[:m], (w, a, h, square), *links[m + 1 :]]


def test_derivatives_are_central_differences_in_50_digits():
    chain = bodies()
    found = rc.modes(chain).sensitivity
    with mp.workdps(50):
        links = stored_links(chain)
        step = mp.mpf(10) ** -15
        for quantity in QUANTITIES:
            for m, (w, a, h, square) in enumerate(links):
                x = {"weight": w, "centroid": h, "radius_of_gyration": mp.sqrt(square)}.get(quantity, a)
                up = heights_of(moved(links, quantity, m, x * (1 + step)))
                down = heights_of(moved(links, quantity, m, x * (1 - step)))
                for j, (more, less) in enumerate(zip(up, down, strict=True)):
                    exact = (more - less) / (2 * step * x)
                    off = abs(mp.mpf(float(found[quantity][j, m])) - exact)
                    assert off <= found.error_bound[quantity][j, m] + 1e-26, (quantity, j, m)
                    relative = float(found.relative[quantity][j, m])
                    assert abs(relative - exact * x / ((more + less) / 2)) < 1e-15


def test_laws_and_what_is_kept():
    modes = rc.modes(bodies(30), "all")
    s = modes.sensitivity
    assert modes.sensitivity is s
    assert np.abs(s.relative.weight.sum(axis=1)).max() < 1e-14
    lengths = s.relative.length + s.relative.centroid + s.relative.radius_of_gyration
    assert np.abs(lengths.sum(axis=1) - 1).max() < 1e-13
    assert np.abs(s.relative.length_in_proportion.sum(axis=1) - 1).max() < 1e-14
    assert (s.length_in_proportion >= 0).all() and (s.radius_of_gyration >= 0).all()
    assert (s.length[:, 0] == 0).all()
    with pytest.raises(ValueError, match="read-only"):
        s.weight[0, 0] = 1
    assert pickle.loads(pickle.dumps(modes)) == modes
    assert rc.modes(bodies(30), "all").sensitivity == s == pickle.loads(pickle.dumps(s))
    with pytest.raises(KeyError, match="quantity must be one of"):
        s["mass"]


@pytest.mark.parametrize("options", [{"precision": each} for each in ("single", "extended", "double-double")])
def test_derivatives_do_not_depend_on_how_the_modes_were_found(options):
    chain = bodies(6)
    exact, found = rc.modes(chain).sensitivity, rc.modes(chain, count=2, first=3, **options).sensitivity
    for quantity in QUANTITIES:
        allowed = found.error_bound[quantity] + exact.error_bound[quantity][2:4]
        assert (np.abs(found[quantity] - exact[quantity][2:4]) <= allowed).all()


def test_an_empty_window_has_no_derivatives():
    assert rc.modes(bodies(), conical_height=(100.0, 200.0)).sensitivity.weight.shape == (0, 4)


def test_uncertainty_against_a_sample():
    chain = bodies()
    rng = np.random.default_rng(8)
    found = rc.modes(chain, gravity=9.81).uncertainty(
        weight=0.02, length=[0.001, 0.002, 0.003, 0.004], centroid=np.full((4, 4), 0.002**2), radius_of_gyration=0.001
    )
    count = 20000
    sample = rc.conical_heights(
        weight=chain.weight + 0.02 * rng.standard_normal((count, 4)),
        length=chain.length + [0.001, 0.002, 0.003, 0.004] * rng.standard_normal((count, 4)),
        centroid=chain.centroid + 0.002 * rng.standard_normal((count, 1)),
        radius_of_gyration=chain.radius_of_gyration + 0.001 * rng.standard_normal((count, 4)),
    )
    assert found.conical_height == pytest.approx(sample.std(axis=0), rel=0.02)
    speed = np.sqrt(9.81 / sample)
    assert found.angular_speed == pytest.approx(speed.std(axis=0), rel=0.02)
    total = sum(found.share[quantity].sum(axis=1) for quantity in QUANTITIES)
    assert total == pytest.approx(np.ones(4), abs=1e-13)
    quantity, link = found.largest[0]
    assert found.share[quantity][0, link] == max(np.abs(found.share[q][0]).max() for q in QUANTITIES)


def test_wrong_deviations_are_refused():
    modes = rc.modes(bodies())
    for wrong, message in [
        ({"weight": -1.0}, "weight must be finite and not negative"),
        ({"length": [1.0, 2.0]}, "length must be a number, one for each of the 4 links, or their covariance"),
        ({"length": np.triu(np.ones((4, 4)))}, "covariance of length must be finite, symmetric"),
        ({"centroid": "much"}, "centroid must be a real number"),
    ]:
        with pytest.raises(ValueError, match=message):
            modes.uncertainty(**wrong)


def test_tuning_two_plummets_against_lagrange():
    chain = Chain(weight=[1.0, 3.0], length=[1.0, 2.0])
    for height, mode in [(2.3, 1), (0.6, 2)]:
        tuned = rc.tune(chain, mode=mode, link=1, quantity="weight", conical_height=height)
        share = (height - 1) * (height - 2) / 2  # W1/(W1 + W2), section 2 (5)
        assert tuned.status == "found"
        assert tuned.value == pytest.approx(3 * share / (1 - share), rel=1e-14)
        assert tuned.error_bound < 1e-14
        assert rc.modes(tuned.system).conical_height[mode - 1] == pytest.approx(height, rel=4e-16)
        assert tuned.reachable is None


def test_tuning_says_where_no_value_does():
    chain = Chain(weight=[1.0, 3.0], length=1.0)
    none = rc.tune(chain, link=1, quantity="weight", conical_height=2.5)
    assert none.status == "no_value" and none.system is None and none.value is None
    assert none.reachable[1] < 2 < none.reachable[1] + 0.01
    assert none.between == (0.001, 1000.0)
    narrow = rc.tune(chain, link=1, quantity="length_in_proportion", conical_height=2.5, between=(0.9, 1.1))
    assert narrow.status == "no_value" and narrow.complete


@pytest.mark.parametrize("quantity", QUANTITIES)
def test_what_was_changed_is_found_again(quantity):
    chain = bodies()
    data = {name: np.array(getattr(chain, name)) for name in QUANTITIES[:4]}
    m = 2
    if quantity == "length_in_proportion":
        for name in ("length", "centroid", "radius_of_gyration"):
            data[name][m] *= 1.05
        wanted = data["length"][m]
    else:
        data[quantity][m] *= 1.05
        wanted = data[quantity][m]
    height = rc.modes(Chain(**data)).conical_height[1]
    tuned = rc.tune(chain, mode=2, link=m + 1, quantity=quantity, conical_height=height)
    assert np.abs(tuned.values / wanted - 1).min() < 1e-12
    assert rc.modes(tuned.system).conical_height[1] == pytest.approx(height, rel=1e-14)


def test_questions_that_are_none_are_refused():
    chain = bodies()
    for wrong, message in [
        ({"quantity": "mass", "conical_height": 1.0}, "quantity must be one of"),
        ({"quantity": "weight"}, "give either conical_height or angular_speed"),
        ({"quantity": "weight", "conical_height": 1.0, "between": 3}, "between must be a pair"),
        ({"quantity": "weight", "conical_height": 1.0, "between": (3, 2)}, "high end must exceed"),
        ({"quantity": "weight", "conical_height": 1.0, "mode": 5}, "mode must be from 1 to 4"),
    ]:
        with pytest.raises(ValueError, match=message):
            rc.tune(chain, link=1, **wrong)
    with pytest.raises(TypeError):
        rc.tune("chain", link=1, quantity="weight", conical_height=1.0)


def test_attached_weights_and_clamped_links():
    chain = Chain.uniform_rods(3, length=3.0, weight=3.0)
    heavy = chain.with_weight(2.0)
    assert heavy.weight.tolist() == [3.0, 1.0, 1.0]
    assert heavy.centroid[0] == pytest.approx((0.5 + 2 * 1.0) / 3, rel=1e-15)
    thread = Chain(weight=1.0, length=1.0).with_thread(0.5, pin=1)
    assert rc.modes(thread).conical_height.tolist() == [1.5]
    # a tip weight many times the chain's: a plummet on a chain without weight
    assert rc.modes(chain.with_weight(1e9)).conical_height[0] == pytest.approx(3.0, rel=1e-8)
    whole = chain.clamped(1).clamped(1)
    assert rc.modes(whole).conical_height == pytest.approx([2.0], rel=1e-15)
    for wrong in (lambda: chain.clamped(3), lambda: chain.with_weight(1.0, 3), lambda: chain.with_thread(1.0, 0)):
        with pytest.raises(ValueError):
            wrong()


def test_a_bell_made_silent():
    chain = Chain(weight=[18, 500], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    bell = rc.bell_and_clapper(chain)
    modes = rc.modes(chain)
    assert bell.conical_height == pytest.approx(modes.conical_height, rel=4e-16)
    s = (modes.shape[:, :-1] - modes.shape[:, 1:]) / chain.length
    assert bell.inclination_ratio == pytest.approx(s[:, 0] / s[:, 1], rel=1e-13)
    joint = bell.with_ratio(1.0)["joint"]
    silent = Chain(weight=[18, 500], length=[0.65, joint], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    again = rc.bell_and_clapper(silent)
    assert again.inclination_ratio[0] == pytest.approx(1, abs=4e-16)
    assert abs(again.mismatch) < 1e-16
    assert rc.modes(silent).conical_height[0] == pytest.approx(rc.modes(silent.clamped(1)).conical_height[0], rel=4e-16)
    pin = rc.two_links.pin_of_silent_clapper(
        bell_weight=500,
        bell_centroid=0.2,
        bell_radius_of_gyration=0.3,
        clapper_weight=18,
        clapper_centroid=0.52,
        clapper_radius_of_gyration=0.08,
    )
    assert joint == pytest.approx(float(pin), rel=1e-14)
    with pytest.raises(ValueError, match="two links"):
        rc.bell_and_clapper(bodies())


def test_what_a_flywheel_does_to_a_speed():
    rig = rc.Rig(Chain(weight=10.0, length=1.0), momentum=3.0)
    modes = rc.modes(rig, gravity=10.0)
    found = modes.sensitivity
    assert modes.angular_speed.tolist() == [-2.0, 5.0]  # A n^2 - H n - W a = 0, A = 1
    assert found.momentum[:, 0] == pytest.approx([2 / 7, 5 / 7], rel=1e-15)
    assert (found.stiffness == 0).all() and (found.carriage_weight == 0).all()
    assert modes.sensitivity is found and rc.modes(rig, gravity=10.0).sensitivity == found
    assert rc.momentum_for_speed(rig, 5.0, link=1, gravity=10.0) == 3.0
    with pytest.raises(TypeError, match="rig must be"):
        rc.momentum_for_speed(rig.chain, 5.0, link=1)
    for offsets, message in (
        ([1.0, 0.0, 0.0], "2 offsets"),
        *(([start, 0.0], "offsets must be finite and move a weight .*, got 5") for start in (0.0, math.nan, math.inf)),
    ):
        with pytest.raises(ValueError, match=message):
            _core.rig_sensitivity(rig._compiled, 5.0, np.array(offsets), 10.0)


def test_no_momentum_serves_at_the_speed_of_the_thread_above():
    """n^2 / g = 1 / a of the massless thread: what holds the upper pin of the plummet is then no spring at all."""
    rig = rc.Rig(Chain(weight=[1.0, 0.0], length=1.0))
    with pytest.raises(ValueError, match="no finite momentum of link 1 makes this a whirl speed; .*, got 2"):
        rc.momentum_for_speed(rig, 2.0, link=1, gravity=4.0)
    assert math.isfinite(rc.momentum_for_speed(rig, 2.001, link=1, gravity=4.0))


@pytest.mark.parametrize("fluid", ["still", "turning"])
def test_every_datum_of_a_rig_against_differences_of_its_speeds(fluid):
    """Differences of speeds that are right to half an ulp, fourth order: to 1e-9 or so."""
    data = {"weight": [3.0, 1.0, 2.0], "length": [1.0, 0.5, 2.0], "centroid": [0.75, 0.25, 1.25]}
    data["radius_of_gyration"] = [0.5, 0.125, 0.75]
    rigging = {"momentum": [0.5, -0.25, 1.5], "displaced_weight": [0.25, 0.06, 0.5]}
    if fluid == "still":
        rigging["added_weight"] = [0.5, 0.1, 0.25]
    displaced = {"displaced_centroid": [0.5, 0.25, 1.0], "displaced_radius_of_gyration": [0.2, 0.1, 0.5]}
    support = {"stiffness": 40.0, "carriage_weight": 1.5}

    def rig(**changed):
        new = {**data, **rigging, **support, **changed}
        chain = Chain(**{name: new[name] for name in data})
        return rc.Rig(chain, **displaced, fluid=fluid, **{name: new[name] for name in (*rigging, *support)})

    found = rc.modes(rig())
    derivative = found.sensitivity
    assert derivative.weight.shape == (len(found), 3) and derivative.stiffness.shape == (len(found),)
    for name, values in {**data, **rigging}.items():
        exact = getattr(derivative, name)
        for link in range(3):
            if name == "length" and link == 0:
                assert np.all(exact[:, 0] == 0)
                continue
            step = 1e-3 * max(abs(values[link]), 0.1)
            speeds = [
                rc.modes(rig(**{name: [x + k * step * (i == link) for i, x in enumerate(values)]})).angular_speed
                for k in (-2, -1, 1, 2)
            ]
            difference = (speeds[0] - 8 * speeds[1] + 8 * speeds[2] - speeds[3]) / (12 * step)
            np.testing.assert_allclose(exact[:, link], difference, rtol=2e-8, atol=2e-8 * np.abs(exact).max())
    for name, value in support.items():
        speeds = [rc.modes(rig(**{name: value * (1 + 1e-3 * k)})).angular_speed for k in (-2, -1, 1, 2)]
        difference = (speeds[0] - 8 * speeds[1] + 8 * speeds[2] - speeds[3]) / (12e-3 * value)
        np.testing.assert_allclose(getattr(derivative, name), difference, rtol=2e-8, atol=1e-9)
    in_proportion = derivative.length + (
        np.array(data["centroid"]) * derivative.centroid
        + np.array(data["radius_of_gyration"]) * derivative.radius_of_gyration
    ) / np.array(data["length"])
    np.testing.assert_allclose(derivative.length_in_proportion, in_proportion, rtol=1e-13, atol=1e-14)


def test_a_rig_with_nothing_moves_as_its_chain():
    chain = bodies()
    plain, rigged = rc.modes(chain), rc.modes(rc.Rig(chain))
    speed = plain.angular_speed[:, None]
    for name in ("weight", "length", "centroid", "radius_of_gyration", "length_in_proportion"):
        of_height = plain.sensitivity[name]
        np.testing.assert_allclose(
            getattr(rigged.sensitivity, name),
            -speed / (2 * plain.conical_height[:, None]) * of_height,
            rtol=1e-11,
            atol=1e-14 * np.abs(speed * of_height / plain.conical_height[:, None]).max(),
        )
