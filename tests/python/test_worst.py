# SPDX-License-Identifier: GPL-3.0-or-later
"""Proved extremes of speeds over a box of tolerances, against random systems in the box, its corners, and an optimiser."""

import itertools
import math

import numpy as np
import pytest
from scipy.optimize import minimize

import revchain as rc
from revchain.results import enclosures
from tier import by_tier

PER = 16  # samples of a box: half of them corners


def cases(seed, count, extreme=False):
    """Random chains and rigs on springs and trolleys, with random tolerances of some of their data."""
    rng = np.random.default_rng(seed)
    for nth in range(count):
        size = int(rng.integers(1, 9 if nth % 8 else 13))
        wide = 4 if extreme else 2
        mass, length = 10 ** rng.uniform(-wide / 2, wide / 2, size), 10 ** rng.uniform(-0.5, 0.5, size)
        given = {"mass": mass, "length": length}
        if rng.random() < 0.6:
            given |= {"centroid": length * rng.uniform(0.05, 1.5, size), "radius_of_gyration": length * rng.uniform(0, 1, size)}
        support = {}
        if rng.random() < 0.5:
            support = {"mass": float(10 ** rng.uniform(-1, 1))}
            if rng.random() < 0.7:
                support["stiffness"] = float(9.8 * mass.sum() / length.sum() * 10 ** rng.uniform(-2, 2))
        names = ["mass", "length_in_proportion", "radius_of_gyration"]
        if "centroid" in given and nth % 2:
            names += ["length", "centroid"]
        names += ["support_mass"] * ("mass" in support) + ["stiffness"] * ("stiffness" in support)
        chosen = [name for name in names if rng.random() < 0.7 and not (name == "radius_of_gyration" and len(given) == 2)]
        percent = {name: float(rng.choice([0.5, 1, 2, 5, 10])) for name in chosen or ["mass"]}
        yield given, support, percent, rng


def system_of(given, support):
    chain = rc.Chain(**given)
    return rc.Rig(chain, support=rc.Support(**support)) if support else chain


def sampled(given, support, percent, rng, count=PER):
    """Systems in the box, about half of them at corners."""
    for nth in range(count):
        new, held = {name: value.copy() for name, value in given.items()}, dict(support)
        for name, part in percent.items():
            size = 1 if name in ("stiffness", "support_mass") else len(given["mass"])
            by = 1 + part / 100 * (rng.choice([-1.0, 1.0], size) if nth % 2 else rng.uniform(-1, 1, size))
            if name in ("stiffness", "support_mass"):
                held[name.removeprefix("support_")] *= float(by[0])
            elif name == "length_in_proportion":
                for one in ("length", "centroid", "radius_of_gyration"):
                    new |= {one: new[one] * by} if one in new else {}
            else:
                new[name] = new[name] * by
        yield system_of(new, held)


def check(given, support, percent, rng):
    """No sample is outside of the bounds; returns the gaps."""
    found = rc.modes(system_of(given, support), "all")
    worst = found.uncertainty(**{name: f"{part} %" for name, part in percent.items()}, worst=True).worst
    low, high = worst.lowest_angular_speed, worst.highest_angular_speed
    assert (low <= worst.lowest_reached).all() and (worst.highest_reached <= high).all()
    assert (low <= found.angular_speed).all() and (found.angular_speed <= high).all()
    for system in sampled(given, support, percent, rng):
        speed = rc.modes(system, "all").angular_speed
        assert (low <= speed).all() and (speed <= high).all(), (given, support, percent)
    return worst.gap.tolist()


def test_no_system_in_the_box_is_outside(monkeypatch):
    monkeypatch.setattr("revchain.results.worst.BOXES", 3)
    gaps = [gap for case in cases(1, 8) for gap in check(*case)]
    assert np.median(gaps) < 1e-6


@pytest.mark.slow  # 20 times 30 ms for each random system
@pytest.mark.parametrize("seed", range(20))
def test_no_system_in_any_box_is_outside(seed, monkeypatch):
    """The proof of one box each; more boxes divide the same proof. With REVCHAIN_CASES=500 there are 10,000 systems."""
    monkeypatch.setattr("revchain.results.worst.BOXES", 1)
    gaps = [gap for case in cases(1000 + seed, by_tier(5, 25), extreme=seed % 4 == 0) for gap in check(*case)]
    print(f"gap of {len(gaps)} modes: median {np.median(gaps):.1e}, 90 % below {np.quantile(gaps, 0.9):.2f}, worst {max(gaps):.2f}")
    assert np.median(gaps) < 1e-6


@pytest.mark.parametrize("name", ["mass", "length_in_proportion", "radius_of_gyration"])
@pytest.mark.parametrize("percent", [1, 5, 10])
def test_extremes_of_one_kind_of_data_are_those_of_all_corners(name, percent):
    rng = np.random.default_rng(percent)
    length = rng.uniform(0.5, 1.5, 5)
    given = {"mass": rng.uniform(0.5, 3, 5), "length": length, "centroid": 0.6 * length, "radius_of_gyration": 0.3 * length}
    worst = rc.modes(rc.Chain(**given), "all").uncertainty(**{name: f"{percent} %"}, worst=True).worst
    speeds = []
    for signs in itertools.product((-1, 1), repeat=5):
        by = 1 + np.array(signs) * percent / 100
        names = ("length", "centroid", "radius_of_gyration") if name == "length_in_proportion" else (name,)
        changed = {one: value * by if one in names else value for one, value in given.items()}
        speeds.append(rc.modes(rc.Chain(**changed), "all").angular_speed)
    assert worst.lowest_angular_speed == pytest.approx(np.min(speeds, axis=0), rel=2e-4 if name == "mass" else 1e-11)
    assert worst.highest_angular_speed == pytest.approx(np.max(speeds, axis=0), rel=2e-4 if name == "mass" else 1e-11)
    assert worst.lowest_reached == pytest.approx(np.min(speeds, axis=0), rel=1e-11)
    assert worst.highest_reached == pytest.approx(np.max(speeds, axis=0), rel=1e-11)


@pytest.mark.slow  # three seconds of searches
def test_extremes_are_those_of_an_optimiser():
    length = np.array([0.6, 1.1, 0.8])
    data = np.concatenate([[1.0, 2.0, 0.7], length, 0.55 * length, 0.3 * length])
    part = 0.01

    def heights(factors):
        rows = (data * factors).reshape(4, 3)
        return rc.modes(rc.Chain(mass=rows[0], length=rows[1], centroid=rows[2], radius_of_gyration=rows[3])).conical_height

    chain = rc.Chain(mass=data[:3], length=data[3:6], centroid=data[6:9], radius_of_gyration=data[9:])
    half = {name: "1 %" for name in ("mass", "length", "centroid", "radius_of_gyration")}
    worst = rc.modes(chain).uncertainty(**half, worst=True).worst
    assert worst.status == "success"
    rng, box = np.random.default_rng(5), [(1 - part, 1 + part)] * 12
    for mode in range(3):
        for sign, bound in ((1, worst.lowest_conical_height[mode]), (-1, worst.highest_conical_height[mode])):
            starts = [np.where(rng.random(12) < 0.5, 1 - part, 1 + part) for _ in range(4)]
            found = [minimize(lambda x, k=mode, s=sign: s * heights(x)[k], one, bounds=box).fun for one in starts]
            assert sign * bound <= min(found)
            wide = worst.highest_conical_height[mode] - worst.lowest_conical_height[mode]
            assert abs(sign * min(found) - bound) < 0.05 * wide


def test_what_has_no_effect_changes_nothing():
    """Only ratios of masses matter: one factor of all masses leaves the speeds; a single link has none at all."""
    found = rc.modes(rc.Chain(mass=3.0, length=2.0))
    worst = found.uncertainty(mass="10 %", worst=True).worst
    assert worst.lowest_angular_speed == pytest.approx(found.angular_speed, rel=1e-11)
    assert worst.highest_angular_speed == pytest.approx(found.angular_speed, rel=1e-11)
    nothing = rc.modes(rc.Chain(mass=[3.0, 1.0], length=2.0)).uncertainty(worst=True).worst
    assert nothing.gap.max() == 0 and nothing.status == "success"
    assert nothing.lowest_angular_speed == pytest.approx(nothing.highest_angular_speed, rel=1e-11)


def test_scale_does_not_matter():
    """Speeds are those of lengths and gravity alone, at ordinary, tiny and huge masses and lengths."""
    first = None
    for scale in (1.0, 1e-8, 1e8):
        chain = rc.Chain(mass=scale * np.array([1.0, 2.0, 5.0]), length=scale * np.array([1.0, 0.5, 2.0]))
        worst = rc.modes(chain).uncertainty(mass="5 %", length_in_proportion="2 %", worst=True).worst
        ends = np.array([worst.lowest_conical_height, worst.highest_conical_height]) / scale
        first = ends if first is None else first
        assert ends == pytest.approx(first, rel=1e-9)


def test_bounds_grow_with_the_tolerance():
    rig = rc.Rig(rc.Chain(mass=[2.0, 1.0, 3.0], length=[1.0, 0.4, 0.7]), support=rc.Support(stiffness=60.0, mass=1.0))
    ends = []
    for part in (0, 1, 3, 9):
        data = ("mass", "length_in_proportion", "stiffness", "support_mass")
        worst = rc.modes(rig).uncertainty(**{name: f"{part} %" for name in data}, worst=True).worst
        ends.append(worst.highest_angular_speed - worst.lowest_angular_speed)
    assert (np.diff(ends, axis=0) > 0).all()


def test_cords():
    cord = rc.Cord(2.0, mass=0.5, tip_mass=0.3)
    worst = rc.modes(cord, 3).uncertainty(length="1 %", mass="5 %", tip_mass="5 %", worst=True).worst
    reached = []
    for by in itertools.product((0.99, 1.01), (0.95, 0.97, 1.0, 1.05), (0.95, 1.0, 1.02, 1.05)):
        reached.append(rc.modes(rc.Cord(2 * by[0], mass=0.5 * by[1], tip_mass=0.3 * by[2]), 3).angular_speed)
        assert (worst.lowest_angular_speed <= reached[-1]).all() and (reached[-1] <= worst.highest_angular_speed).all()
    assert worst.lowest_reached == pytest.approx(np.min(reached, axis=0), rel=1e-4)
    assert worst.gap[0] < 1e-9 and worst.gap.max() < 0.1
    bare = rc.modes(rc.Cord(2.0, mass=0.5), 2).uncertainty(length="1 %", mass="5 %", worst=True).worst
    assert bare.highest_angular_speed == pytest.approx(rc.modes(rc.Cord(1.98), 2).angular_speed, rel=1e-11)
    line = rc.Held(rc.Cord(2.0, mass=0.5), tension=30.0)
    held = rc.modes(line, 2).uncertainty(length="1 %", mass="5 %", tension="5 %", worst=True).worst
    slow = rc.modes(rc.Held(rc.Cord(2.02, mass=0.525), tension=28.5), 2).angular_speed
    fast = rc.modes(rc.Held(rc.Cord(1.98, mass=0.475), tension=31.5), 2).angular_speed
    assert held.lowest_angular_speed == pytest.approx(slow, rel=1e-11)
    assert held.highest_angular_speed == pytest.approx(fast, rel=1e-11)


def test_extremes_are_at_the_data_they_name():
    chain = rc.Chain(mass=[1.0, 2.0, 4.0], length=[0.5, 1.0, 0.8], names=["low", "middle", "high"])
    worst = rc.modes(chain).uncertainty(mass="4 %", length_in_proportion=0.01, worst=True).worst
    for at, reached in ((worst.lowest_at, worst.lowest_reached), (worst.highest_at, worst.highest_reached)):
        for k in range(3):
            there = rc.Chain(mass=at["mass"][k], length=at["length_in_proportion"][k])
            assert rc.modes(there).angular_speed[k] == pytest.approx(reached[k], rel=1e-11)


def test_nothing_is_proved_of_a_chain_that_may_tip_over():
    """The upper body's centre of gravity is above its pin: with a light load the chain does not hang."""
    chain = rc.Chain(mass=[1.0, 2.0], length=[0.5, 0.4], centroid=[0.3, -0.15], radius_of_gyration=[0.1, 0.1])
    firm = rc.modes(chain).uncertainty(mass="5 %", worst=True).worst
    assert firm.status == "success" and (firm.lowest_angular_speed > 0).all()
    may_tip = rc.modes(chain).uncertainty(mass="40 %", worst=True).worst
    assert may_tip.status == "budget_spent"
    assert (may_tip.lowest_angular_speed == 0).all() and np.isinf(may_tip.highest_angular_speed).all()
    assert "nan" not in repr(may_tip)


def test_paths_are_the_data_they_name():
    """By path or by keyword the bounds agree; whole chains move in proportion; text may have the value."""
    names = ["load", "block"]
    rig = rc.Rig(rc.Chain(mass=[2500, 400], length=[6, 24], names=names), support=rc.Support(stiffness=2e5, mass=300))
    modes = rc.modes(rig)
    paths = {"links[load].mass": "2500 kg +- 5 %", "links[block].length_in_proportion": "+- 0.5 m", "support.stiffness": "10 %"}
    one = modes.uncertainty(paths, worst=True).worst
    other = modes.uncertainty(mass=["5 %", 0], length_in_proportion=[0, 0.5], stiffness="10 %", worst=True).worst
    for name in ("lowest_angular_speed", "highest_angular_speed"):
        assert getattr(one, name) == pytest.approx(getattr(other, name), rel=1e-11)
    assert one.lowest_at["links[block].length_in_proportion"] == pytest.approx([24.5] * 3)
    assert one.highest_at["support.stiffness"] == pytest.approx([2.2e5] * 3)
    whole = rc.modes(rig.chain).uncertainty({"length": "1 %"}, worst=True).worst
    assert whole.highest_angular_speed == pytest.approx(rc.modes(rig.chain).angular_speed / 0.99**0.5, rel=1e-11)
    cord = rc.modes(rc.Cord(2.0, mass=1.0, tip_mass=0.3), 2)
    by_path = cord.uncertainty({"length": "1 %", "tip_mass": 0.01}, worst=True).worst
    assert by_path == cord.uncertainty(length="1 %", tip_mass=0.01, worst=True).worst
    with pytest.raises(ValueError, match=r"half-width of links\[load\].mass must be less than its value 2500, got 5000"):
        modes.uncertainty({"links[load].mass": "200 %"}, worst=True)


def test_the_budget_is_kept_and_said():
    length = np.linspace(0.5, 1.5, 4)
    chain = rc.Chain(mass=1.0, length=length, centroid=0.6 * length, radius_of_gyration=0.3 * length)
    worst = rc.modes(chain, 2).uncertainty(mass="20 %", length="20 %", centroid="20 %", worst=True).worst
    assert worst.status == "budget_spent" and "budget spent" in repr(worst)
    assert worst.boxes.max() <= 2 * 33 and (worst.lowest_angular_speed < worst.lowest_reached).any()


@pytest.mark.parametrize(
    ("system", "given", "message"),
    [
        (rc.Chain(mass=[1.0, 2.0], length=1.0), {"mass": np.eye(2)}, "mass must be half-widths of tolerances"),
        (rc.Chain(mass=[1.0, 2.0], length=1.0), {"mass": "100 %"}, r"half-width of mass of links\[0\] must be less than its"),
        (rc.Chain(mass=[1.0, 2.0], length=1.0), {"length_in_proportion": [0, 1.5]}, r"links\[1\] must be less than its value 1, got"),
        (rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=1.0)), {"mass": "1 %"}, "flywheels"),
        (rc.Rig(rc.Chain(mass=1.0, length=1.0), displaced=rc.Displaced(mass=0.2)), {"mass": "1 %"}, "a fluid"),
        (rc.Cord(1.0, density=1.0), {"exponent": 0.1}, "no proof for the exponent"),
        (rc.Cord(1.0, mass=1.0, masses={0.5: 1.0}), {"mass": "1 %"}, "point masses"),
        (rc.Chain.uniform_rods(101, length=1.0), {"length": "1 %"}, "at most 100 links, got 101"),
    ],
)
def test_what_has_no_proof_is_refused(system, given, message):
    name = {"mass": "mass" if system.by_mass else "weight"}
    with pytest.raises(ValueError, match=message):
        rc.modes(system, 1).uncertainty(**{name.get(key, key): value for key, value in given.items()}, worst=True)


def test_worst_is_true_or_false():
    with pytest.raises(TypeError, match="worst must be True or False, got 1"):
        rc.modes(rc.Chain(mass=1.0, length=1.0)).uncertainty(mass="1 %", worst=1)
    assert rc.modes(rc.Chain(mass=1.0, length=1.0)).uncertainty(mass="1 %").worst is None


def test_the_forms_are_those_of_the_library():
    """The pencil in the drifts of the links has the heights of `modes`, and its derivatives those of `sensitivity`."""
    for given, support, _, _ in cases(9, 30):
        found = rc.modes(system_of(given, support), "all")
        base = rc.results.worst.data_of(found.system, found.gravity)
        none = np.empty(0)
        family = enclosures.Family(base, np.empty((0, base.size), bool), none, none, none)
        value, _ = family.modes(none)
        assert value[family.rigid :][: len(found)] == pytest.approx(found.conical_height, rel=1e-9)
        assert math.isinf(value[0]) == bool(found.rigid)


SCATTER = {
    "scene": {"links": [{"mass": 2500, "length": 6}, {"mass": 400, "length": 24, "kind": "rod"}]},
    "vary": {
        "links[0].mass": {"uniform": "2500 kg +- 10 %"},
        "links[1].length": {"log_uniform": ["23 m", "25 m"]},
        "gravity": {"values": [1.62, 9.81]},
    },
    "samples": 200,
    "scatter": {"worst": True},
}


def changed(**more):
    return {key: value for key, value in {**SCATTER, **more}.items() if value is not None}


def test_a_study_finds_the_extremes_of_its_intervals():
    found = rc.sweep(changed())
    speed = found["angular_speed"]
    low, high = found["lowest_angular_speed"], found["highest_angular_speed"]
    assert low.dims == ("gravity", "mode") and low.attrs["units"] == "rad/s"
    assert ((speed >= low) & (speed <= high)).all()
    assert (found["lowest_reached"] >= low).all() and (found["highest_reached"] <= high).all()
    assert ((speed.max("sample") - speed.min("sample")) / (high - low)).min() > 0.8
    plain = rc.sweep(changed(scatter=None))
    assert set(found) - set(plain) == {"lowest_angular_speed", "lowest_reached", "highest_reached", "highest_angular_speed"}
    for k, mass in enumerate((2250, 2750)):  # the load alone moves the second mode upwards
        links = [{"mass": mass, "length": 6}, {"mass": 400, "length": 25 if k == 0 else 23, "kind": "rod"}]
        end = rc.Scene.from_dict({"links": links, "gravity": 9.81}).modes().angular_speed[1]
        assert (low if k == 0 else high).sel(gravity=9.81, mode=2).item() == pytest.approx(end, rel=1e-9)


def test_random_gravity_and_rigs_and_other_units():
    vary = {"gravity": {"uniform": [9.78, 9.83]}, "links[0].mass": {"uniform": [2400, 2600]}}
    found = rc.sweep(changed(vary=vary, find=["period"]))
    assert ((found["period"] >= found["lowest_period"]) & (found["period"] <= found["highest_period"])).all()
    assert found["lowest_period"].attrs["units"] == "s" and "lowest_angular_speed" not in found
    rig = {**SCATTER["scene"], "support": {"stiffness": "200 kN/m", "mass": 300}}
    vary = {"support.stiffness": {"uniform": ["100 kN/m", "300 kN/m"]}, "support.mass": {"uniform": [100, 500]}}
    found = rc.sweep(changed(scene=rig, vary=vary))
    speed = found["angular_speed"]
    inside = (speed >= found["lowest_angular_speed"]) & (speed <= found["highest_angular_speed"])
    assert (inside | speed.isnull()).all() and inside.sel(mode=3).all()


@pytest.mark.parametrize(
    ("more", "message"),
    [
        ({"vary": {"links[0].mass": {"normal": [2500, "5 %"]}}}, "needs intervals, and links.0..mass is normal: write uniform"),
        ({"vary": {"gravity": {"values": [1, 2]}}, "samples": None}, "is for random numbers, and none are varied"),
        ({"scene": {**SCATTER["scene"], "ask": {"shapes": {"angular_speed": 2}}}}, 'is for modes alone: write find = ."modes".'),
        ({"scene": {"cord": {"length": 1, "mass": 1}}, "vary": {"cord.length": {"uniform": [1, 2]}}}, "cut it into links"),
        ({"scatter": {"worst": 1}}, "worst: must be true or false, got 1"),
    ],
)
def test_studies_without_a_worst_case_are_refused(more, message):
    with pytest.raises(rc.SceneError, match=rf"scatter\.?.*{message}"):
        rc.Study.from_dict(changed(**more))


def test_a_number_to_which_no_datum_is_proportional_is_refused():
    links = [{"mass": 2500, "length": 6, "tip_mass": 10}, {"mass": 400, "length": 24, "kind": "rod"}]
    with pytest.raises(rc.SceneError, match=r"scatter.worst: needs numbers .* proportional, and links\[0\].mass is not"):
        rc.Study.from_dict(changed(scene={"links": links}))


def test_the_histogram_shows_the_extremes():
    from revchain.plots.sweep import plot_sweep

    vary = {"links[0].mass": {"uniform": "2500 kg +- 10 %"}}
    ax = plot_sweep(rc.sweep(changed(vary=vary)))
    dotted = [line for line in ax.lines if line.get_linestyle() == ":" and len(line.get_xdata())]
    assert len(dotted) == 4 and "guaranteed worst case" in ax.get_legend_handles_labels()[1]


def test_a_datum_without_effect():
    """Nothing hangs on the lower pin of the lowest link, and a point mass alone swings as any other."""
    bodies = rc.Chain(mass=[2.0, 1.0], length=1.0, centroid=0.4, radius_of_gyration=0.3)
    for system, data in ((bodies, {"links[0].length": "5 %"}), (rc.Chain(mass=1.0, length=1.0), {"links[0].mass": "5 %"})):
        worst = rc.modes(system).uncertainty(data, worst=True).worst
        assert worst.status == "success" and not worst.gap.any() and "no effect: the data do not change any speed" in repr(worst)
    worst = rc.modes(bodies).uncertainty(length=[0.05, 0.0], worst=True).worst
    assert worst.status == "success" and not worst.gap.any()
    some = rc.modes(bodies).uncertainty({"links[1].length": "1 %"}, worst=True).worst
    assert "no effect" not in repr(some)


def test_centroids_above_their_pins_that_take_nearly_all_load_off_a_link():
    """K loses digits there: the nominal heights, which `modes` proves, must not be outside."""
    rng = np.random.default_rng(19)
    for digits in np.linspace(1, 15.5, 60):
        weight, below, length = rng.uniform(0.05, 2, 2).tolist() + [rng.uniform(0.5, 2)]
        centroid = -below * length / weight * (1 - 10.0**-digits)
        chain = rc.Chain(
            mass=[below, weight], length=[1.0, length], centroid=[0.5, centroid], radius_of_gyration=[0.3, 0.2]
        )
        m = rc.modes(chain)
        found = m.uncertainty(radius_of_gyration=[1e-9, 0.0], worst=True).worst
        assert (found.lowest_conical_height <= m.conical_height).all(), digits
        assert (m.conical_height <= found.highest_conical_height).all(), digits
        if digits < 8:
            assert np.allclose(found.highest_conical_height, m.conical_height, rtol=1e-4)


def test_tolerances_that_reach_0_or_a_slack_cord_are_refused_by_name():
    rig = rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0), support=rc.Support(stiffness=30.0))
    with pytest.raises(ValueError, match="the half-width of stiffness must be less than its value 30, got 30"):
        rc.modes(rig, 1).uncertainty(stiffness="100 %", worst=True)
    cord = rc.Held(rc.Cord(1.0, mass=1.0), tension=10.0)
    with pytest.raises(ValueError, match="Modes.uncertainty: the least tension .* the greatest weight 10.297, .* got 10"):
        rc.modes(cord, 2).uncertainty(mass="5 %", worst=True)


def test_the_heights_of_a_cord_lie_within_their_error_bounds():
    cord = rc.Cord(1.0, mass=1.0, density=lambda s: 1 + s**-0.7)
    worst = rc.modes(cord, 3).uncertainty(length=0.0, worst=True).worst
    true = [0.84491174470062873758, 0.077261619126824963174, 0.026259849068216951646]  # Frobenius series, 40 digits
    assert (worst.lowest_conical_height < true).all() and (true < worst.highest_conical_height).all()
