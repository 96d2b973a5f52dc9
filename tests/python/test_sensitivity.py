# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives, uncertainties, and inverse questions, against independent figures."""

import itertools
import math
import pickle

import mpmath as mp
import numpy as np
import pytest
import rigs
from exact import heights_of, stored_links
from mechanics import fourth_order
from rigs import random_chain, rigged
from tier import by_tier

import revchain as rc
from revchain import Chain, _core
from revchain.systems.datum import datum_at

QUANTITIES = ("mass", "length", "centroid", "radius_of_gyration", "length_in_proportion")


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
    new = {
        "mass": (x, a, h, square),
        "length": (w, x, h, square),
        "centroid": (w, a, x, square),
        "radius_of_gyration": (w, a, h, x**2),
        "length_in_proportion": (w, x, h * x / a, square * (x / a) ** 2),
    }
    return [*links[:m], new[quantity], *links[m + 1 :]]


@pytest.mark.parametrize("seed", [3, 400, 401, 402])
def test_derivatives_are_central_differences_in_50_digits(seed):
    chain = bodies() if seed == 3 else random_chain(np.random.default_rng(seed), 4)
    found = rc.modes(chain).sensitivity
    with mp.workdps(50):
        links = stored_links(chain)
        step = mp.mpf(10) ** -15
        for quantity in QUANTITIES:
            for m, (w, a, h, square) in enumerate(links):
                x = {"mass": w, "centroid": h, "radius_of_gyration": mp.sqrt(square)}.get(quantity, a)
                up = heights_of(moved(links, quantity, m, x * (1 + step)))
                down = heights_of(moved(links, quantity, m, x * (1 - step)))
                for j, (more, less) in enumerate(zip(up, down, strict=True)):
                    exact = (more - less) / (2 * step * x)
                    off = abs(mp.mpf(float(found[quantity][j, m])) - exact)
                    assert off <= found.error_bound[quantity][j, m] + 1e-26, (quantity, j, m)
                    assert off <= 1e-12 * abs(exact) + 1e-15 * np.abs(found[quantity][j]).max()
                    relative = float(found.relative[quantity][j, m])
                    assert abs(relative - exact * x / ((more + less) / 2)) < 1e-15


def test_laws_and_what_is_kept():
    modes = rc.modes(bodies(30), "all")
    s = modes.sensitivity
    assert modes.sensitivity is s
    assert np.abs(s.relative.mass.sum(axis=1)).max() < 1e-14
    lengths = s.relative.length + s.relative.centroid + s.relative.radius_of_gyration
    assert np.abs(lengths.sum(axis=1) - 1).max() < 1e-13
    assert np.abs(s.relative.length_in_proportion.sum(axis=1) - 1).max() < 1e-14
    assert (s.length_in_proportion >= 0).all() and (s.radius_of_gyration >= 0).all()
    assert (s.length[:, 0] == 0).all()
    with pytest.raises(ValueError, match="read-only"):
        s.mass[0, 0] = 1
    assert pickle.loads(pickle.dumps(modes)) == modes
    assert rc.modes(bodies(30), "all").sensitivity == s == pickle.loads(pickle.dumps(s))
    with pytest.raises(KeyError, match="quantity must be one of"):
        s["weight"]
    assert rc.modes(bodies(), conical_height=(100.0, 200.0)).sensitivity.mass.shape == (0, 4)


@pytest.mark.parametrize("options", [{"precision": each} for each in ("extended", "double-double")])
def test_derivatives_do_not_depend_on_how_the_modes_were_found(options):
    chain = bodies(6)
    exact, found = rc.modes(chain).sensitivity, rc.modes(chain, count=2, first=3, **options).sensitivity
    for quantity in QUANTITIES:
        allowed = found.error_bound[quantity] + exact.error_bound[quantity][2:4]
        assert (np.abs(found[quantity] - exact[quantity][2:4]) <= allowed).all()


def test_uncertainty_is_the_propagation_of_errors():
    modes = rc.modes(random_chain(np.random.default_rng(77), 5))
    s, dw, da = modes.sensitivity, 0.01 * modes.system.weight, 0.002 * np.arange(1, 6)
    root = np.random.default_rng(8).normal(size=(5, 5)) * 0.001
    found = modes.uncertainty(weight=dw, length=da, centroid=root @ root.T, radius_of_gyration=0.001)
    parts = {"mass": s.mass * dw, "length": s.length * da, "radius_of_gyration": s.radius_of_gyration * 0.001}
    variance = sum((part**2).sum(axis=1) for part in parts.values()) + ((s.centroid @ root) ** 2).sum(axis=1)
    want = np.sqrt(variance)
    assert found.conical_height == pytest.approx(want, rel=1e-13)
    assert found.relative == pytest.approx(want / modes.conical_height, rel=1e-13)
    assert found.angular_speed == pytest.approx(modes.angular_speed * want / modes.conical_height / 2, rel=1e-13)
    assert sum(found.share[quantity].sum(axis=1) for quantity in QUANTITIES) == pytest.approx(np.ones(5), abs=1e-13)
    for name, part in parts.items():
        assert found.share[name] == pytest.approx(part**2 / variance[:, None], rel=1e-12, abs=1e-15)
    link, quantity = found.largest[0].removeprefix("links[").split("].")
    assert found.share[quantity.replace("weight", "mass")][0, int(link)] == max(np.abs(found.share[q][0]).max() for q in QUANTITIES)
    # one weight shared by all links by a factor moves nothing
    same = modes.uncertainty(weight=np.outer(modes.system.weight, modes.system.weight))
    assert same.relative == pytest.approx(np.zeros(5), abs=1e-7)


def test_wrong_deviations_are_refused():
    modes = rc.modes(bodies())
    for wrong, message in [
        ({"weight": -1.0}, "weight must be finite and not negative"),
        ({"length": [1.0, 2.0]}, "length must be a number, one for each of the 4 links, or their covariance"),
        ({"length": np.triu(np.ones((4, 4)))}, "covariance of length must be finite, symmetric"),
        ({"centroid": "much"}, "centroid must be a number"),
    ]:
        with pytest.raises(ValueError, match=message):
            modes.uncertainty(**wrong)


def test_tuning_says_where_no_value_does():
    chain = Chain(weight=[1.0, 3.0], length=1.0)
    none = rc.tune(chain, vary="links[0].weight", conical_height=2.5)
    assert none.status == "no_value" and (none.system, none.value, none.error_bound) == (None, None, None)
    assert none.reachable[1] < 2 < none.reachable[1] + 0.01
    assert none.between == (0.001, 1000.0)
    narrow = rc.tune(chain, vary="links[0].length_in_proportion", conical_height=2.5, between=(0.9, 1.1))
    assert narrow.status == "no_value" and narrow.complete


def test_questions_that_are_none_are_refused():
    for wrong, message in [
        ({"vary": "links[0].colour", "conical_height": 1.0}, "vary must be .*, got"),
        ({"vary": "links[0].mass", "conical_height": 1.0}, "given by weight"),
        ({"vary": "links[4].weight", "conical_height": 1.0}, r"links\[4\], and the highest is links\[3\]"),
        ({}, "give exactly one of conical_height and angular_speed"),
        ({"conical_height": 1.0, "angular_speed": 2.0}, "give exactly one of"),
        ({"conical_height": -1.0}, "conical_height must be positive"),
        ({"conical_height": math.nan}, "conical_height must be positive"),
        ({"conical_height": 1.0, "between": 3}, "between must be a pair"),
        ({"conical_height": 1.0, "between": (3, 2)}, "high end must exceed"),
        ({"conical_height": 1.0, "mode": 5}, "mode must be from 1 to 4"),
        ({"conical_height": 1.0, "mode": 0}, "mode must be at least 1"),
    ]:
        with pytest.raises(ValueError, match=message):
            rc.tune(bodies(), **{"vary": "links[0].weight", **wrong})
    with pytest.raises(TypeError):
        rc.tune("chain", vary="links[0].weight", conical_height=1.0)


def momentum_for_speed(rig, speed, link, gravity=9.80665):
    """Of whichever mode."""
    return _core.momentum_for_speed(rig._under(gravity), link, speed, gravity)


def test_what_a_flywheel_does_to_a_speed():
    rig = rigged(Chain(weight=10.0, length=1.0), momentum=3.0)
    modes = rc.modes(rig, gravity=10.0)
    found = modes.sensitivity
    assert modes.angular_speed.tolist() == [-2.0, 5.0]  # A n^2 - H n - W a = 0, A = 1
    assert found.momentum[:, 0] == pytest.approx([2 / 7, 5 / 7], rel=1e-15)
    assert (found.stiffness == 0).all() and (found.support_mass == 0).all()
    assert modes.sensitivity is found and rc.modes(rig, gravity=10.0).sensitivity == found
    assert momentum_for_speed(rig, 5.0, 0, 10.0) == 3.0
    tuned = rc.tune(rc.Rig(rig.chain), vary="flywheels[0].momentum", angular_speed=5.0, gravity=10.0)
    assert tuned.value == 3.0 and rc.modes(tuned.system, gravity=10.0).angular_speed.tolist() == [-2.0, 5.0]
    for offsets, message in (
        ([1.0, 0.0, 0.0], "2 offsets"),
        *(([start, 0.0], "offsets must be finite and move a weight .*, got 5") for start in (0.0, math.nan, math.inf)),
    ):
        with pytest.raises(ValueError, match=message):
            _core.rig_sensitivity(rig._under(10.0), 5.0, np.array(offsets), 10.0)


def test_momentum_that_makes_a_speed_a_whirl_speed():
    rng = np.random.default_rng(600)
    chain, momentum = random_chain(rng, 4), rng.normal(size=4)
    rig = rigged(chain, momentum=momentum)
    for link, speed in itertools.product((0, 1, 3), (2.0, -7.0)):
        changed = momentum.copy()
        changed[link] = momentum_for_speed(rig, speed, link)
        modes = rc.modes(rigged(chain, momentum=changed))
        nearest = np.abs(modes.angular_speed / speed - 1).argmin()
        assert abs(modes.angular_speed[nearest] / speed - 1) < 1e-13
        for mode in range(1, 5):  # found where it is that mode
            tuned = rc.tune(rig, vary=f"flywheels[{link}].momentum", angular_speed=speed, mode=mode)
            assert tuned.status == ("found" if mode == modes.number[nearest] else "no_value")
            assert tuned.value in (None, changed[link])
    # none serves at n^2 / g = 1 / a of the massless thread above: what holds the plummet's upper pin is then no spring
    rig = rc.Rig(Chain(weight=[1.0, 0.0], length=1.0))
    with pytest.raises(ValueError, match=r"no finite momentum of links\[0\] makes this a whirl speed; .*, got 2"):
        momentum_for_speed(rig, 2.0, 0, 4.0)
    assert math.isfinite(momentum_for_speed(rig, 2.001, 0, 4.0))


def test_fluid_of_no_weight_has_the_place_given():
    """The derivative by a displaced weight of 0 is that of fluid there, not at the centroid of the link."""
    example = Chain(weight=[1, 2], length=[1, 0.5], centroid=[0.6, 0.3], radius_of_gyration=[0.2, 0.1])
    cases = [(example, np.array([0.8, 0.2]), np.array([0.3, 0.05]))]
    for seed in range(30):
        rng = np.random.default_rng([38, seed])
        chain = random_chain(rng, int(rng.integers(1, 4)))
        cases.append((chain, chain.length * rng.uniform(0, 1.2, chain.size), chain.length * rng.uniform(0, 0.5, chain.size)))
    for chain, centroid, gyration in cases:
        place = {"centroid": centroid, "gyration": gyration}
        found = rc.modes(rigged(chain, displaced=np.zeros(chain.size), **place)).sensitivity.displaced_mass
        at_rest = speeds_in_50_digits(rigged(chain))
        for k in range(chain.size):
            small = np.where(np.arange(chain.size) == k, 1e-30, 0.0)
            moved = speeds_in_50_digits(rigged(chain, displaced=small, **place))
            want = [float((n - m) / mp.mpf(1e-30)) for n, m in zip(moved, at_rest, strict=True)]
            np.testing.assert_allclose(found[:, k], want, rtol=1e-11, atol=1e-13 * max(map(abs, want)))
    assert rc.Rig(example, displaced=rc.Displaced(weight=0.0)) == rc.Rig(example)


def speeds_in_50_digits(rig):
    """The speeds of a rig without momentum, slowest first."""
    with mp.workdps(50):
        stiff, _, mass = (mp.matrix(x) for x in rigs.pencil(rig))
        root = mp.cholesky(stiff) ** -1
        heights = mp.eigsy(root * mass * root.T, eigvals_only=True)
        return sorted(mp.sqrt(mp.mpf(rigs.G) / height) for height in heights)


def test_a_rig_with_nothing_moves_as_its_chain():
    chain = bodies()
    plain, rigged = rc.modes(chain), rc.modes(rc.Rig(chain))
    speed = plain.angular_speed[:, None]
    for name in QUANTITIES:
        of_height = plain.sensitivity[name]
        np.testing.assert_allclose(
            getattr(rigged.sensitivity, name),
            -speed / (2 * plain.conical_height[:, None]) * of_height,
            rtol=1e-11,
            atol=1e-14 * np.abs(speed * of_height / plain.conical_height[:, None]).max(),
        )


def spinning(stiffness=30.0, carriage=0.5, spin=(40.0, 0.0, -25.0), displaced=(0.2, 0.0, 0.1), mass=(3.0, 1.0, 2.0), length=1.0):
    """A rig by mass that has everything: wheels of both kinds, a spring, a float, a link that stands."""
    chain = Chain(mass=mass, length=length * np.array([1.0, 0.5, 2.0]), centroid=[0.75, 0.25, 1.25], radius_of_gyration=[0.5, 0.125, 0.75])
    wheels = rc.Flywheel(mass=0.4, radius_of_gyration=[0.3, 0.2, 0.25], spin=spin, driven=[True, False, False])
    fluid = rc.Displaced(mass=displaced, centroid=0.5, radius_of_gyration=0.2, added_mass=0.05)
    support = rc.Support(stiffness=stiffness, mass=carriage)
    return rc.Rig(chain, support=support, flywheels=wheels, displaced=fluid, inverted=[False, True, False])


def by_weight(fluid):
    body = {"centroid": [0.75, 0.25, 1.25], "radius_of_gyration": [0.5, 0.125, 0.75]}
    place = {"displaced": [0.25, 0.06, 0.5], "centroid": [0.5, 0.25, 1.0], "gyration": [0.2, 0.1, 0.5]}
    if fluid == "still":
        place["added"] = [0.5, 0.1, 0.25]
    chain = Chain(weight=[3.0, 1.0, 2.0], length=[1.0, 0.5, 2.0], **body)
    return rigged(chain, momentum=[0.5, -0.25, 1.5], stiffness=40.0, carriage=1.5, fluid=fluid, **place)


WHOLE = spinning()
SYSTEMS = {
    "chain": WHOLE.chain,
    "rig": WHOLE,
    "rig without fluid": rc.Rig(WHOLE.chain, support=WHOLE.support, flywheels=WHOLE.flywheels, inverted=WHOLE.inverted),
    "by weight": by_weight("still"),
    "by weight, turning fluid": by_weight("turning"),
}


def paths_of(system, name):
    heavy = "mass" if system.by_mass else "weight"
    paths = ["length", *(f"links[{k}].{quantity}" for k in range(3) for quantity in (heavy, *QUANTITIES[1:]))]
    if name != "chain":
        wheels = ("spin", "momentum") if system.by_mass else ("momentum",)
        paths += [heavy, "support.stiffness", f"support.{heavy}"]
        paths += [f"flywheels[{k}].{each}" for k in range(3) for each in wheels]
    if name not in ("chain", "rig without fluid"):
        moved = (heavy,) if system.fluid == "turning" else (heavy, f"added_{heavy}")
        paths += [f"displaced[{k}].{each}" for k in range(3) for each in moved if getattr(system.displaced, heavy)[k]]
    return paths


@pytest.mark.parametrize("gravity", [9.80665, 1.62])
@pytest.mark.parametrize("name", SYSTEMS)
def test_derivatives_along_every_path_against_differences(name, gravity):
    """Derivatives of speeds, those that `fit` takes too, of links that stand too: differences of fourth order."""
    system = SYSTEMS[name]
    found, compared = rc.modes(system, "all", gravity=gravity), 0
    s, speeds = found.sensitivity, found.angular_speed
    for path in paths_of(system, name):
        datum = datum_at("", system, path, gravity)
        assert datum.change(datum.present) == system or "momentum" in path
        field, part = datum.rate or (datum.quantity, np.arange(3) == datum.link)
        if datum.rate is None:
            assert name == "rig" or "by weight" in name  # what is displaced may follow the link, but here stays
            if path == "length":
                continue
        rates = s[field] @ part if s[field].ndim == 2 else s[field] * part
        if name == "chain":  # of heights
            rates = -0.5 * speeds / found.conical_height * rates
        step = 4e-4 * (max(abs(datum.present), 0.1) if "momentum" in path else datum.typical)

        def speeds_of(by, datum=datum):
            return rc.modes(datum.change(datum.present + by), "all", gravity=gravity).angular_speed

        want = fourth_order(speeds_of, step)
        atol = 1e-9 * min(1.0, 10 * np.abs(s[field]).max(), np.abs(speeds).max() / datum.typical)
        np.testing.assert_allclose(rates, want, rtol=1e-8, atol=1e-12 if field == "spin" else atol, err_msg=path)
        compared += 1
    assert compared >= 16 and s.mass.shape == (len(found), 3) and (s.length[:, 0] == 0).all()
    chain = getattr(system, "chain", system)
    bodies_with_it = chain.centroid * s.centroid + chain.radius_of_gyration * s.radius_of_gyration
    in_proportion = s.length + bodies_with_it / chain.length
    np.testing.assert_allclose(s.length_in_proportion, in_proportion, rtol=1e-13, atol=1e-14)
    if name != "chain":
        assert s.stiffness.shape == (len(found),)
        with pytest.raises(KeyError, match="quantity must be one of mass, .*, support_mass, got"):
            s["radius"]
    assert (rc.modes(rc.Rig(bodies(), flywheels=rc.Flywheel(momentum=1.0))).sensitivity.spin == 0).all()


def test_uncertainty_of_a_rig_is_that_of_a_sample():
    """20,000 rigs, all data drawn at once, within four times the sample's own error: 2 %. Fewer in the quick tier."""
    rng, size = np.random.default_rng(11), by_tier(2_000, 20_000)
    found = rc.modes(spinning())
    given = {"stiffness": 0.3, "support_mass": 0.02, "spin": [0.4, 0.0, 0.3], "displaced_mass": 0.005, "mass": [0.03, 0.01, 0.02]}
    u = found.uncertainty(**given)
    drawn = np.empty((size, len(found)))
    for k in range(size):
        drawn[k] = rc.modes(spinning(
            30.0 + 0.3 * rng.normal(), 0.5 + 0.02 * rng.normal(), np.array([40.0, 0.0, -25.0]) + [0.4, 0.0, 0.3] * rng.normal(size=3),
            np.array([0.2, 0.0, 0.1]) + [0.005, 0.0, 0.005] * rng.normal(size=3),
            np.array([3.0, 1.0, 2.0]) + [0.03, 0.01, 0.02] * rng.normal(size=3),
        )).angular_speed  # fmt: skip
    alone = found.uncertainty(**(given | {"displaced_mass": [0.005, 0.0, 0.005]}))  # nothing negative can be displaced
    np.testing.assert_allclose(alone.angular_speed, drawn.std(axis=0), rtol=4 / math.sqrt(2 * size))
    assert (u.angular_speed >= alone.angular_speed).all()
    np.testing.assert_allclose(u.relative, 2 * u.angular_speed / np.abs(found.angular_speed), rtol=1e-15)
    np.testing.assert_allclose(u.period / found.period, 0.5 * u.relative, rtol=1e-15)
    share = sum(u.share[name].sum(axis=1) if u.share[name].ndim == 2 else u.share[name] for name in u.share.data)
    np.testing.assert_allclose(share, 1.0, rtol=1e-14)


def test_uncertainty_of_a_rig_in_all_its_forms():
    found = rc.modes(spinning())
    each = found.uncertainty(mass=["1 %", "2 %", 0.0], stiffness="5 %", momentum="1 %")
    wheels = np.abs(0.4 * np.array([0.3, 0.2, 0.25]) ** 2 * [40.0, 0.0, -25.0])
    again = found.uncertainty(mass=np.diag([0.03, 0.02, 0.0]) ** 2, stiffness=1.5, momentum=0.01 * wheels)
    np.testing.assert_allclose(each.angular_speed, again.angular_speed, rtol=1e-14)
    np.testing.assert_allclose(found.uncertainty(spin="1 %").angular_speed, found.uncertainty(momentum="1 %").angular_speed, rtol=1e-14)
    together = found.uncertainty(mass=np.outer([3.0, 1.0, 2.0], [3.0, 1.0, 2.0]) * 1e-4)  # all masses by one factor
    rates = found.sensitivity.mass @ [0.03, 0.01, 0.02]
    np.testing.assert_allclose(together.angular_speed, np.abs(rates), rtol=1e-12)
    assert set(found.uncertainty(stiffness=0.1).largest) == {"support.stiffness"}
    assert "support.stiffness" in repr(found.uncertainty(stiffness=0.1)) and "nothing" in repr(found.uncertainty())
    chain = bodies()
    plain, rigged = rc.modes(chain).uncertainty(weight=0.1, length=0.01), rc.modes(rc.Rig(chain)).uncertainty(weight=0.1, length=0.01)
    np.testing.assert_allclose(plain.angular_speed, rigged.angular_speed, rtol=1e-12)
    np.testing.assert_allclose(plain.conical_height, rigged.conical_height, rtol=1e-12)
    for wrong, message in [
        ({"mass": -1.0}, "mass must be finite and not negative, got -1"),
        ({"stiffness": math.nan}, "stiffness must be finite and not negative, got nan"),
        ({"stiffness": [1.0, 2.0]}, r"stiffness must be a number, one for each of the 1"),
        ({"length": np.triu(np.ones((3, 3)))}, "covariance of length must be finite, symmetric"),
        ({"spin": 1.0, "momentum": 1.0}, "give either spin or momentum"),
        ({"weight": 1.0}, "given by mass: give mass, not weight"),
    ]:
        with pytest.raises(ValueError, match=f"^revchain.Modes.uncertainty: .*{message}"):
            found.uncertainty(**wrong)
    by_momentum = rc.modes(rc.Rig(chain, flywheels=rc.Flywheel(momentum=1.0)))
    with pytest.raises(ValueError, match="spin is for flywheels that were given by spin; give momentum, got 1"):
        by_momentum.uncertainty(spin=1.0)
    with pytest.raises(ValueError, match="this one is firm; leave it out"):
        by_momentum.uncertainty(stiffness="5 %")
    assert by_momentum.uncertainty(displaced_mass="1 N").angular_speed.shape == (8,)
    with pytest.raises(ValueError, match="displaced_weight must be a force .*; give it as mass"):
        by_momentum.uncertainty(displaced_mass="1 kg")
