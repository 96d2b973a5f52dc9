# SPDX-License-Identifier: GPL-3.0-or-later
"""Fits to measured speeds: closed forms, data that are found again, covariances against 40 digits and against samples."""

import math

import mpmath as mp
import numpy as np
import pytest
from exact import heights_of, stored_links
from rigs import random_chain

import revchain as rc
from revchain.systems.datum import datum_at

G = 9.80665
CRANE = rc.Chain(mass=[2500.0, 400.0], length=[6.0, 24.0])
SPRING = rc.Rig(rc.Chain(mass=2.0, length=1.5), support=rc.Support(stiffness=90.0, mass=0.7))


def speeds(system, numbers):
    """By the keys that `fit` has."""
    found = rc.modes(system, max(map(abs, numbers)))
    if not isinstance(system, rc.Rig):
        return {k: float(found.angular_speed[k - 1]) for k in numbers}
    return {k: float(abs(found.angular_speed[(found.number == abs(k)) & (found.direction == np.sign(k))][0])) for k in numbers}


# ---- closed forms of one link and two


def test_one_length_from_one_speed():
    found = rc.fit(rc.Chain(mass=1.0, length=2.0), {1: (2.5, 0.02)}, vary="length")
    assert found.value[0] == pytest.approx(G / 2.5**2, rel=1e-14)
    assert found.standard_uncertainty[0] == pytest.approx(2 * G / 2.5**3 * 0.02, rel=1e-13)
    assert found.status == "success" and found.degrees_of_freedom == 0 and found.chi_square == pytest.approx(0, abs=1e-20)
    assert found.system == rc.Chain(mass=1.0, length=found["length"])


def test_one_datum_from_two_speeds_is_their_weighted_mean():
    """Two point masses of one length a: n^2 = g x / a, x fixed; in logarithms both speeds say the same of a."""
    pair = rc.Chain(mass=[1.0, 3.0], length=1.0)  # heights 1.5 and 0.5 of a
    exact = np.sqrt(G / np.array([1.5, 0.5]) / 1.1)
    off = np.array([0.003, -0.002])
    found = rc.fit(pair, {k + 1: (exact[k] + off[k], 0.01 * (k + 1)) for k in range(2)}, vary="length")
    # n = c a^(-1/2): least squares of (measured - c s) with s = a^(-1/2)
    c, weight = np.sqrt(G / np.array([1.5, 0.5])), np.array([1.0, 0.25]) / 1e-4
    s = (weight * c * (exact + off)).sum() / (weight * c**2).sum()
    length = 2 / s**2
    assert found.value[0] == pytest.approx(length, rel=1e-14, abs=0)
    assert found.standard_uncertainty[0] == pytest.approx(2 * length / s / math.sqrt((weight * c**2).sum()), rel=1e-12)
    assert found.residual == pytest.approx(exact + off - c * s, abs=1e-14)
    assert found.chi_square == pytest.approx((weight * (exact + off - c * s) ** 2).sum(), rel=1e-12)
    assert found.degrees_of_freedom == 1 and found.covariance.shape == (1, 1)


def test_carriage_and_spring_from_two_speeds():
    """(E + k - M n^2) (k - m n^2) = k^2: linear in E and M, so two speeds give both."""
    speed = np.array([2.2, 12.0])
    found = rc.fit(SPRING, dict(enumerate(speed, 1)), vary=["support.stiffness", "support.mass"])
    k = 2 * G / 1.5
    matrix = np.column_stack([np.ones(2), -(speed**2)])
    want = np.linalg.solve(matrix, k**2 / (k - 2 * speed**2) - k)
    np.testing.assert_allclose(found.value, want, rtol=1e-12)
    assert found.chi_square is None and np.isnan(found.standard_uncertainty).all() and np.isnan(found.measured_uncertainty).all()


# ---- what was changed is found again


def by_mass(chain):
    return rc.Chain(mass=chain.weight, length=chain.length, centroid=chain.centroid, radius_of_gyration=chain.radius_of_gyration)


BODIES = by_mass(random_chain(np.random.default_rng(5), 3, spread=0.5))
WHEELS = rc.Flywheel(mass=0.3, radius_of_gyration=0.25, spin=[60.0, -20.0, 0.0], driven=[False, True, False])
FLOAT = rc.Displaced(mass=0.2, centroid=0.4, radius_of_gyration=0.1, added_mass=0.1)
WHOLE = rc.Rig(BODIES, support=rc.Support(stiffness=40.0, mass=0.8), flywheels=WHEELS, displaced=FLOAT)
STANDING = rc.Rig(BODIES, support=rc.Support(stiffness=40.0, mass=0.8), inverted=[True, False, False])
CASES = {
    "chain": (BODIES, (1, 2, 3), {"links[2].length": 1.1, "links[1].mass": 0.9, "links[0].centroid": 1.05}),
    "chain, bodies": (BODIES, (1, 2, 3), {"links[1].length": 1.05, "links[2].radius_of_gyration": 0.95, "links[0].mass": 1.2}),
    "crane": (CRANE, (1, 2), {"links[1].length_in_proportion": 1.2, "links[0].mass": 0.7}),
    "by weight": (rc.Chain(weight=[1.0, 3.0], length=1.0), (1, 2), {"links[0].weight": 1.4, "length": 0.8}),
    "carriage": (STANDING, (1, 2, 3), {"support.stiffness": 1.1, "support.mass": 0.9, "length": 1.05}),
    "both directions": (WHOLE, (1, 2, -1, -2, 3), {"support.stiffness": 1.05, "flywheels[0].spin": 1.1, "links[1].mass": 0.95, "length": 1.02}),
    "wheels": (WHOLE, (1, -1, 2, -2), {"flywheels[0].mass": 1.1, "flywheels[1].radius_of_gyration": 0.95, "mass": 1.1}),
    "momentum": (WHOLE, (1, -1, -2), {"flywheels[0].momentum": 1.05, "support.mass": 1.1}),
    "fluid": (WHOLE, (1, 2, 3, -1), {"displaced[0].mass": 1.2, "displaced[2].added_mass": 0.8, "displaced[1].centroid": 1.1}),
    "cord": (rc.Cord(2.0, mass=1.0, tip_mass=0.3), (1, 2, 3), {"length": 1.1, "tip_mass": 0.8}),
    "held": (rc.Held(BODIES, tension=150.0), (1, 2), {"tension": 1.1, "links[1].mass": 0.9}),
    "held cord": (rc.Held(rc.Cord(1.0, mass=2.0), tension=150.0), (1, 2), {"tension": 1.1}),
}  # fmt: skip


@pytest.mark.parametrize("name", CASES)
def test_what_was_changed_is_found_again(name):
    system, numbers, changes = CASES[name]
    true, values = system, []
    for path, factor in changes.items():
        datum = datum_at("", true, path, G)
        values.append(factor * datum.present)
        true = datum.change(values[-1])
    found = rc.fit(system, {k: (n, 1e-3 * n) for k, n in speeds(true, numbers).items()}, vary=list(changes))
    assert found.status == "success" and found.vary == tuple(changes)
    np.testing.assert_allclose(found.value, values, rtol=1e-9)
    np.testing.assert_allclose(found.residual, 0, atol=1e-11)
    assert type(found.system) is type(system) and found.number.tolist() == list(numbers)
    np.testing.assert_allclose(np.abs(found.measured), [*speeds(true, numbers).values()], rtol=1e-15)
    assert (np.sign(found.computed) == np.sign(numbers)).all()
    # the covariance by differences of the speeds themselves, one datum after another
    slopes = []
    for path, value in zip(changes, found.value, strict=True):
        near = []
        for x in (-2, -1, 1, 2):
            moved = datum_at("", found.system, path, G).change(value * (1 + 1e-3 * x))
            near.append(np.array([*speeds(moved, numbers).values()]))
        slopes.append((near[0] - 8 * near[1] + 8 * near[2] - near[3]) / (12e-3 * value))
    scaled = np.column_stack(slopes) / (1e-3 * np.abs(found.measured))[:, None]
    size = np.sqrt((scaled**2).sum(axis=0))
    want = np.linalg.inv((scaled / size).T @ (scaled / size)) / np.outer(size, size)
    np.testing.assert_allclose(found.standard_uncertainty, np.sqrt(want.diagonal()), rtol=1e-6)
    np.testing.assert_allclose(found.correlation, want / np.sqrt(np.outer(want.diagonal(), want.diagonal())), atol=1e-6)


# ---- covariances


def test_values_and_covariance_against_40_digits():
    """The normal equations in 40 digits, derivatives by differences of heights from Lagrange's equations."""
    chain = random_chain(np.random.default_rng(31), 4, spread=0.6)
    rng = np.random.default_rng(32)
    speed = rc.modes(chain).angular_speed * (1 + 0.004 * rng.normal(size=4))
    deviation = 0.004 * speed * np.array([1.0, 2.0, 0.5, 1.0])
    found = rc.fit(chain, {k + 1: (speed[k], deviation[k]) for k in range(4)}, vary=["links[0].weight", "links[2].centroid"])
    with mp.workdps(40):
        links = stored_links(found.system)

        def model(w, h):
            new = list(links)
            new[0], new[2] = (w, *links[0][1:]), (*links[2][:2], h, links[2][3])
            return [mp.sqrt(mp.mpf(G) / height) for height in heights_of(new)]

        at = [links[0][0], links[2][2]]
        step = mp.mpf(10) ** -12
        columns = []
        for k in range(2):
            moved = [[x + sign * step * (j == k) for j, x in enumerate(at)] for sign in (1, -1)]
            columns.append([(up - down) / (2 * step) for up, down in zip(model(*moved[0]), model(*moved[1]), strict=True)])
        slopes = mp.matrix([[columns[k][j] / deviation[j] for k in range(2)] for j in range(4)])
        off = mp.matrix([(n - m) / s for n, m, s in zip(model(*at), speed.tolist(), deviation.tolist(), strict=True)])
        normal = slopes.T * slopes
        step_left = normal**-1 * (slopes.T * off)  # what Gauss and Newton would still move
        covariance = np.array((normal**-1).tolist(), float)
        assert max(abs(x) / mp.sqrt(c) for x, c in zip(step_left, covariance.diagonal(), strict=True)) < 1e-6
        chi_square = float(sum(x**2 for x in off))
    np.testing.assert_allclose(found.covariance, covariance, rtol=1e-9)
    assert found.chi_square == pytest.approx(chi_square, rel=1e-10) and found.degrees_of_freedom == 2


SLOW = [pytest.param(name, marks=pytest.mark.slow) for name in ("both directions", "cord")]


@pytest.mark.parametrize("name", ["crane", *SLOW])
def test_covariance_is_that_of_a_sample(name):
    """Fits of 800 sets of measurements, which takes seconds: the standard error of a standard deviation is 2.5 %, of
    chi-square 5 %."""
    system, numbers, changes = CASES[name]
    exact, rng, size = speeds(system, numbers), np.random.default_rng(8), 800
    n = np.array([*exact.values()])

    def fitted(speeds):
        return rc.fit(system, {k: (x, 5e-4 * s) for k, x, s in zip(numbers, speeds, n, strict=True)}, vary=list(changes))

    drawn = [fitted(n * (1 + 5e-4 * rng.normal(size=len(n)))) for _ in range(size)]
    assert {found.status for found in drawn} == {"success"}
    want, spread = fitted(n), np.cov(np.array([found.value for found in drawn]).T)
    deviation = np.sqrt(spread.diagonal())
    np.testing.assert_allclose(deviation, want.standard_uncertainty, rtol=0.1)
    np.testing.assert_allclose(spread / np.outer(deviation, deviation), want.correlation, atol=0.1)
    freedom = len(n) - len(changes)
    chi_square = np.mean([found.chi_square for found in drawn])
    assert chi_square == pytest.approx(freedom, rel=0.15, abs=1e-12) and want.degrees_of_freedom == freedom


def test_uncertainties_that_were_not_given_are_estimated():
    """All as one part of their speeds, from what is left over: the values are those of any such uncertainties."""
    cord = rc.Cord(2.0, mass=1.0, tip_mass=0.3)
    rng = np.random.default_rng(3)
    measured = {k: n * (1 + 0.002 * rng.normal()) for k, n in speeds(cord, (1, 2, 3, 4)).items()}
    bare = rc.fit(cord, measured, vary=["length", "tip_mass"])
    given = rc.fit(cord, {k: (n, "3 %") for k, n in measured.items()}, vary=["length", "tip_mass"])
    np.testing.assert_allclose(bare.value, given.value, rtol=1e-9)
    spread = given.chi_square / 2  # of two degrees of freedom
    np.testing.assert_allclose(bare.covariance, given.covariance * spread, rtol=1e-6)
    np.testing.assert_allclose(bare.measured_uncertainty, 0.03 * math.sqrt(spread) * bare.measured, rtol=1e-8)
    assert bare.chi_square is None and "chi-square" not in repr(bare) and bare.degrees_of_freedom == 2


# ---- what cannot be told


def test_what_the_measurements_cannot_tell_is_named():
    measured = {k: (n, "1 %") for k, n in speeds(BODIES, (1, 2, 3)).items()}
    masses = [f"links[{k}].mass" for k in range(3)]
    found = rc.fit(BODIES, measured, vary=masses)
    assert found.status == "undetermined" and found.undetermined == (tuple(masses),)
    assert np.isnan(found.covariance).all() and found.degrees_of_freedom == 1
    np.testing.assert_allclose(found.value, BODIES.mass, rtol=1e-9)  # they stay as they were
    assert "cannot tell links[0].mass and links[1].mass and links[2].mass apart: leave one of them out" in repr(found)
    alone = rc.fit(BODIES, measured, vary=["links[0].length", "links[2].length_in_proportion"])  # where nothing hangs no pin matters
    assert alone.undetermined == (("links[0].length",),)
    assert np.isnan(alone.covariance[0]).all() and np.isnan(alone.covariance[:, 0]).all()
    want = rc.fit(BODIES, measured, vary="links[2].length_in_proportion")
    assert alone.value[1] == pytest.approx(want.value[0], rel=1e-9)
    assert alone.standard_uncertainty[1] == pytest.approx(want.standard_uncertainty[0], rel=1e-10)
    assert "links[0].length has no effect on the speeds measured" in repr(alone)
    two = rc.fit(BODIES, {k: (n * 1.01, "1 %") for k, (n, _) in measured.items()}, vary=["links[0].mass", "links[0].length", "links[2].length_in_proportion"])
    assert two.undetermined == (("links[0].length",),) and np.isfinite(two.covariance[[0, 2]][:, [0, 2]]).all()


def test_groups_that_cannot_be_told_are_told_apart():
    """A firm support's mass has no effect; the mass of the chain and the stiffness of its spring act by their ratio."""
    spring = rc.Rig(BODIES, support=rc.Support(stiffness=40.0))
    measured = {k: (1.01 * n, "1 %") for k, n in speeds(spring, (1, 2, 3)).items()}
    found = rc.fit(spring, measured, vary=["mass", "support.stiffness", "length"])
    assert found.undetermined == (("mass", "support.stiffness"),)
    want = rc.fit(spring, measured, vary=["support.stiffness", "length"])
    assert found["length"] == pytest.approx(want["length"], rel=1e-9)
    assert found.standard_uncertainty[2] == pytest.approx(want.standard_uncertainty[1], rel=1e-8)
    ratio = want["support.stiffness"] / BODIES.total_mass
    assert found["support.stiffness"] / found["mass"] == pytest.approx(ratio, rel=1e-9)
    cord = rc.fit(rc.Cord(1.0, mass=1.0, tip_mass=0.5), {1: (3.3, 0.1), 2: (9.1, 0.1)}, vary=["mass", "tip_mass"])
    assert cord.undetermined == (("mass", "tip_mass"),)


# ---- forms


def test_forms_of_what_was_measured():
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    turn = 2 * math.pi
    plain = rc.fit(CRANE, {1: (0.58, 0.0058), 2: (3.9, 0.039)}, vary=["length", "links[0].mass"])
    for measured in (
        {1: [0.58, "1 %"], 2: (3.9, 0.039)},
        {1: ("0.58 rad/s", "0.0058 rad/s"), 2: np.array([3.9, 0.039])},
        {1: (f"{0.58 / turn!r} Hz", f"{0.0058 / turn!r} Hz"), 2: (f"{3.9 * 30 / math.pi!r} rpm", "1%")},
        {1: (f"{turn / 0.58!r} s", f"{0.01 * turn / 0.58!r} s"), 2: (f"{turn / 3.9 / 60!r} min", "1 %")},
        {1: (turn / 0.58 * unit.s, "1 %"), 2: (3.9 * unit.rad / unit.s, 0.039 * unit.rad / unit.s)},
        {np.int64(1): (0.58, 0.0058), 2: (3.9, 0.039)},
    ):
        found = rc.fit(CRANE, measured, vary=["length", "links[0].mass"])
        np.testing.assert_allclose(found.measured, [0.58, 3.9], rtol=1e-14)
        np.testing.assert_allclose(found.measured_uncertainty, [0.0058, 0.039], rtol=1e-14)
        np.testing.assert_allclose(found.value, plain.value, rtol=1e-9)
    backward = rc.fit(WHOLE, {-1: -1.9, 1: 2.0}, vary="support.stiffness")  # the sign may be written, or not
    assert backward == rc.fit(WHOLE, {-1: 1.9, 1: 2.0}, vary=["support.stiffness"])
    moon = speeds(CRANE, (1, 2))
    moon = {k: n * math.sqrt(1.62 / G) for k, n in moon.items()}
    found = rc.fit(CRANE, moon, vary="length", gravity=1.62)
    assert found.gravity == 1.62 and found["length"] == pytest.approx(30.0, rel=1e-12)


def test_where_to_start():
    firm = rc.Rig(rc.Chain(mass=2.0, length=1.5))
    found = rc.fit(firm, {1: (2.2, 0.01)}, vary={"support.stiffness": "5 kN/m"})
    assert found["support.stiffness"] == pytest.approx(2 * G / (G / 2.2**2 - 1.5), rel=1e-12) and found.present[0] == math.inf
    still = rc.fit(firm, {1: (2.8, 0.01), -1: (2.3, 0.01)}, vary=["flywheels[0].momentum", "length"])
    a, h = still["length"], still["flywheels[0].momentum"]
    np.testing.assert_allclose(np.roots([2 * a**2, -h, -2 * G * a]), [2.8, -2.3], rtol=1e-12)
    heavy = rc.fit(rc.Rig(rc.Chain(mass=2.0, length=1.5), support=rc.Support(stiffness=90.0)), {1: 2.2, 2: 12.0}, vary={"support.mass": 1.0, "length": 1.4})
    assert heavy.status == "success" and heavy.present.tolist() == [0.0, 1.5]
    threads = rc.Chain(mass=[1.0, 0.0, 2.0], length=1.0)
    assert rc.fit(threads, {1: 2.1}, vary={"links[1].mass": 0.1}).status == "success"


OF_A_CRANE = [  # what is measured, what varies, what is wrong
    ({1: 0.58}, ["length", "links[0].mass"], "vary has 2 data for 1 measured speed; vary at most 1, or measure more modes"),
    ({1: 0.58, 3: 4.0}, "length", "mode must be from 1 to 2, the number of modes, got 3"),
    ({1: 0.58, -1: 4.0}, "length", "modes are counted from 1; only a rig with flywheels has backward modes, .*, got -1"),
    ({0: 0.58}, "length", "modes are counted from 1, got 0"),
    ({1.5: 0.58}, "length", "measured: each mode number must be a whole number, got 1.5"),
    ({1: (0.58, 0.0)}, "length", r"measured\[1\]: uncertainty must be positive and finite, got 0.0; leave out those of all"),
    ({1: (0.58, "-1 %")}, "length", r"measured\[1\]: uncertainty must be positive and finite, got '-1 %'"),
    ({1: (0.58, 1e300)}, "length", r"measured\[1\]: uncertainty must be from 1e-100 to 1e\+100 times the measured value, got 1e\+300"),
    ({1: (0.58, 1e-300)}, "length", r"measured\[1\]: uncertainty must be from 1e-100 to 1e\+100 times the measured value"),
    ({1: -0.58}, "length", r"measured\[1\]: speed must be positive and finite, got -0.58"),
    ({1: math.inf}, "length", r"measured\[1\]: speed must be positive and finite, got inf"),
    ({1: "3 kg"}, "length", r'measured\[1\]: angular_speed must be an angular speed such as "30 rpm", got "3 kg"'),
    ({1: (0.58, 0.1, 0.2)}, "length", r"measured\[1\] must be a speed, or a pair of it and its uncertainty"),
    ({1: ("10.9 s", 0.1)}, "length", r'measured\[1\]: give speed and uncertainty in the same unit, or "1 %", got'),
    ({1: ("10.9 s", "1 rpm")}, "length", r"measured\[1\]: give speed and uncertainty in the same unit"),
    ({1: (0.58, 0.01), 2: 3.9}, "length", r"measured\[2\] has no uncertainty, and others have"),
    ({}, "length", "measured must be a dictionary of speeds by mode number such as"),
    ([0.58, 3.9], "length", "measured must be a dictionary"),
    ({1: 0.58}, [], "vary must be a path or a list of paths"),
    ({1: 0.58}, np.ma.masked, "vary must be a path or a list of paths such as .*, got masked"),
    ({1: 0.58}, "links[0].colour", "vary must be one of .*, got 'links\\[0\\].colour'"),
    ({1: 0.58}, "links[0].weight", 'given by mass: vary "links\\[0\\].mass"'),
    ({1: 0.58}, "links[2].mass", r"links\[2\], and the highest is links\[1\]"),
    ({1: 0.58}, "mass", "ratios alone"),
    ({1: 0.58, 2: 3.9}, ["length", "links[0].length_in_proportion"], 'vary has "length" and "links\\[0\\].length_in_proportion", which change the same'),
    ({1: 0.58, 2: 3.9}, ["links[0].mass", "links[0].mass"], "which change the same number; leave one of them out"),
    ({1: 0.58, 2: 3.9}, {"length": 30.0, "links[0].mass": -3.0}, r"the start of links\[0\].mass must be finite and more than 0, got -3"),
    ({1: 0.58}, {"length": "30 kg"}, r'length \(start of length\) must be a length'),
    ({1: 0.58}, "links[0].radius_of_gyration", r"links\[0\].radius_of_gyration is 0: give a start value, as in vary=\{"),
]
OF_OTHERS = [
    (SPRING, {3: 2.0}, "support.mass", "mode must be from 1 to 2"),
    (SPRING, {-1: 2.0}, "support.mass", "only a rig with flywheels"),
    (SPRING, {1: 2.0}, "support.radius", "has no effect on the speeds of small oscillations"),
    (rc.Rig(CRANE), {1: 2.0}, "support.stiffness", r'support.stiffness is inf: give a start value, as in vary=\{"support.stiffness": '),
    (WHOLE, {1: 2.0, 2: 3.0}, ["flywheels[0].momentum", "flywheels[1].spin"], "which change the same number"),
    (WHOLE, {1: 2.0, 2: 3.0}, ["mass", "links[1].mass"], "which change the same number"),
    (WHOLE, {4: 2.0, -9: 3.0}, "mass", "(mode must be from 1 to|there is no mode)"),
    (rc.Held(CRANE, span=10.0), {1: 2.0}, "length", "is bent"),
    (rc.Held(rc.Cord(1.0), span=0.5), {1: 2.0}, "length", "is bent"),
]


@pytest.mark.parametrize(("system", "measured", "vary", "message"), [*((CRANE, *row) for row in OF_A_CRANE), *OF_OTHERS])
def test_questions_that_are_none(system, measured, vary, message):
    with pytest.raises(ValueError, match=f"^revchain.fit: .*{message}"):
        rc.fit(system, measured, vary=vary)


def test_uncertainties_of_any_size():
    """Only their ratios decide; their size is that of the result's own uncertainties."""
    sizes = [1e-97, 1e-30, 1.0, 1e30, 1e97]
    found = [rc.fit(CRANE, {1: (0.57, 0.01 * size), 2: (3.9, 0.1 * size)}, vary="length") for size in sizes]
    for size, fitted in zip(sizes, found, strict=True):
        assert fitted.value == pytest.approx(found[2].value, rel=1e-9)
        assert fitted.standard_uncertainty == pytest.approx(found[2].standard_uncertainty * size, rel=1e-6)
    apart = rc.fit(CRANE, {1: (0.57, 1e-97), 2: (3.9, 1e97)}, vary="length")
    assert apart.value == pytest.approx(rc.fit(CRANE, {1: 0.57}, vary="length").value, rel=1e-9)


def test_the_result():
    def of_a_crane(first, second):
        return rc.fit(CRANE, {1: (f"{first} s", "0.02 s"), 2: (f"{second} s", "0.01 s")}, vary="length")

    found = of_a_crane(10.91, 1.61)
    assert found["length"] == found.value[0] == pytest.approx(found.system.total_length, rel=1e-15)
    with pytest.raises(KeyError, match="path must be one of length, got 'mass'"):
        found["mass"]
    np.testing.assert_array_equal(found.residual, found.measured - found.computed)
    in_periods = found.residual * (found.measured / found.computed) / found.measured_uncertainty  # of a period in that of the period
    np.testing.assert_allclose(found.normalized_residual, in_periods, rtol=1e-12)
    assert found.chi_square == pytest.approx((found.normalized_residual**2).sum(), rel=1e-12)
    assert found.to_dataframe().loc["length", "value"] == found["length"]
    assert found.to_xarray()["covariance"].dims == ("datum", "other_datum")
    assert "1 datum to 2 speeds, success; chi-square" in repr(found) and "with 1 degree of freedom" in repr(found)
    doubtful, well = of_a_crane(11.5, 1.61), of_a_crane(10.9, 1.65)
    assert doubtful.status == "success" and "chi-square is far above" in repr(doubtful)
    assert "far above" not in repr(well) and well.degrees_of_freedom == 1
    rods = [rc.Chain.uniform_rods(30, length=length) for length in (2.0, 2.1)]
    many = rc.fit(rods[0], dict(enumerate(rc.modes(rods[1], 12).angular_speed, 1)), vary="length")
    assert "and 4 more measured speeds" in repr(many)


def test_without_scipy(python, without):
    program = without("scipy") + (
        "import revchain as rc\n"
        "try: rc.fit(rc.Chain(mass=1.0, length=1.0), {1: 3.0}, vary='length')\n"
        "except ImportError as error: print(error)\n"
    )
    assert python("-c", program).stdout == 'revchain.fit needs scipy: pip install "revchain[fit]"\n'


def test_why_there_is_no_standard_uncertainty():
    line = "no standard uncertainties: there are as many data as speeds, and the measurements have no uncertainties"
    paths = ["links[0].length", "links[1].length"]
    assert line in repr(rc.fit(CRANE, {1: 0.57, 2: 3.9}, vary=paths))
    assert line not in repr(rc.fit(CRANE, {1: (0.57, "1 %"), 2: (3.9, "1 %")}, vary=paths))
    assert line not in repr(rc.fit(CRANE, {1: 0.57, 2: 3.9}, vary="length"))
