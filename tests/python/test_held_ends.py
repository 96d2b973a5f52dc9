# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains held at both ends on arms and on springs: lists against Lagrange's equations of pins in the frame that turns,
verdicts on stability against the motion, words and refusals."""

import math
import pickle

import mpmath as mp
import numpy as np
import pytest
from ends import G, Pins, polished, random_held, shapes_by_pins
from motion_of_pins import Motion
from rigs import random_chain

import revchain as rc
from revchain import Support

EPS = 2.0**-52
ARMS = (Support(radius=0.3), Support(radius=0.7))
EITHER_SIDE = (Support(radius=0.4), Support(radius=-0.5))
SPRINGS = (Support(stiffness=150.0, mass=0.4), Support(stiffness=300.0))
SPRUNG_ARMS = (Support(stiffness=200.0, radius=0.3), Support(stiffness=400.0, mass=0.5, radius=0.5))
ENDS = {
    "arms": ARMS,
    "either side": EITHER_SIDE,
    "springs": SPRINGS,
    "lower spring": (SPRINGS[0], Support()),
    "upper spring on an arm": (Support(radius=0.2), SPRUNG_ARMS[1]),
    "springs on arms": SPRUNG_ARMS,
}
PAST_RESONANCE = (Support(stiffness=60.0, mass=1.0), Support(stiffness=30.0, mass=0.5, radius=-0.2))


# ---- complete lists, against pins in the plane


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("kind", ["plummets", "rods"])
@pytest.mark.parametrize("ends", ENDS)
def test_decided_lists_hold_all_that_pins_in_the_plane_find(ends, kind, seed):
    rng = np.random.default_rng(seed)
    held = random_held(rng, 3, kind, *ENDS[ends], rng.uniform(0.4, 0.8))
    speed = rng.uniform(2.0, 6.0)
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G, max_half_waves=2)
    assert shapes.undecided.size == 0 and shapes.complete == held.is_planar
    found = shapes_by_pins(held, speed, rng, 50, 2)
    assert len(found) == len(shapes)
    for offset, _, x in found:
        shape = min(shapes, key=lambda one: np.abs(one.offset - offset).max())
        assert np.abs(shape.offset - offset).max() < 1e-7
        with mp.workdps(50):
            pairs = zip(polished(held, speed, x), shape.inclination, strict=True)
            assert max(abs(a - mp.mpf(float(b))) for a, b in pairs) <= shape.error_bound
        assert shape.proved
        assert shape.error_bound < 1e-15


def known(shapes, offset, height):
    """Whether a shape is in a list, or begins where the list may lack some."""
    first = math.atan2(offset[0] - offset[1], height[1])
    listed = any(np.abs(shape.offset - offset).max() < 1e-7 for shape in shapes)
    return listed or any(low <= first <= high for low, high in shapes.undecided)


@pytest.mark.parametrize(
    ("ends", "seed", "speed", "most", "number"),
    [("either side", 0, 8.7, 3, 4), ("lower spring", 0, 8.7, 3, 4), ("springs on arms", 1, 4.1, 3, 3)],
)
def test_lists_of_more_half_waves(ends, seed, speed, most, number):
    rng = np.random.default_rng(seed)
    held = random_held(rng, 4, "plummets", *ENDS[ends], rng.uniform(0.4, 0.8))
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G, max_half_waves=most)
    assert shapes.undecided.size == 0 and shapes.complete == held.is_planar
    found = shapes_by_pins(held, speed, rng, 80, most)
    assert len(found) == len(shapes) == number
    assert all(known(shapes, offset, height) for offset, height, _ in found)


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("kind", ["plummets", "rods"])
@pytest.mark.parametrize("ends", [(0,), (0, 1), (1,)], ids=["lower", "both", "upper"])
def test_past_resonance_no_shape_is_where_the_list_has_none(ends, kind, seed):
    """Where end and spring are slower than the chain, ends stand out to the other side, and links may hardly be pulled."""
    held = [Support(radius=0.3), Support()]
    for i in ends:
        held[i] = PAST_RESONANCE[i]
    rng = np.random.default_rng(seed)
    held = random_held(rng, 3, kind, *held, rng.uniform(0.4, 0.8))
    shapes = rc.steady_shapes(held, angular_speed=8.7, gravity=G, max_half_waves=3)
    found = shapes_by_pins(held, 8.7, rng, 60, 3)
    assert all(known(shapes, offset, height) for offset, height, _ in found)


@pytest.mark.parametrize("speed", [3.0, 8.649])
def test_a_rod_that_is_hardly_pulled_leaves_a_list_open(speed):
    """It could settle in two directions; here the middle one is nearly upright between two that lean."""
    rods = rc.Chain(mass=np.ones(3), length=1.0, centroid=0.5, radius_of_gyration=12**-0.5)
    held = rc.Held(rods, span=0.633, weightless=speed == 3.0)
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G)
    found = shapes_by_pins(held, speed, np.random.default_rng(0), 100, 1)
    assert found
    assert not shapes.complete
    assert all(known(shapes, offset, height) for offset, height, _ in found)
    assert np.diff(shapes.undecided).sum() < 1e-6


@pytest.mark.parametrize("ends", ENDS)
def test_without_gravity(ends):
    rng = np.random.default_rng(3)
    held = random_held(rng, 3, "rods", *ENDS[ends], 0.6)
    light = rc.Held(held.system, span=held.span, lower=held.lower, upper=held.upper, weightless=True)
    shapes = rc.steady_shapes(light, angular_speed=5.0, max_half_waves=2)
    found = shapes_by_pins(light, 5.0, rng, 50, 2)
    assert found
    assert all(known(shapes, offset, height) for offset, height, _ in found)
    slow = rc.steady_shapes(light, angular_speed=2.0)[0]
    same = np.abs(slow.offset - shapes[0].offset).max() < 1e-12
    assert same == light.is_firm  # springs give way


def test_forces_of_all_balance():
    held = rc.Held(rc.Chain.uniform_rods(8, length=2.0, mass=3.0), span=1.4, lower=SPRUNG_ARMS[0], upper=ARMS[1])
    for shape in rc.steady_shapes(held, angular_speed=9.0, gravity=G, max_half_waves=2, budget=0):
        middle = (shape.offset[1:] + shape.offset[:-1]) / 2
        centrifugal = 3.0 / 8 * 81.0 * middle.sum()
        assert shape.lower_pull[0] + shape.upper_pull[0] == pytest.approx(centrifugal, rel=1e-12, abs=1e-11)
        assert shape.lower_pull[1] + shape.upper_pull[1] == pytest.approx(-3.0 * G, rel=1e-12)
        assert 200.0 * (shape.offset[0] - 0.3) == pytest.approx(shape.lower_pull[0], rel=1e-12)
        assert shape.offset[-1] == 0.7
        inertia = 3.0 / 8 * ((shape.offset[1:] ** 2 + shape.offset[1:] * shape.offset[:-1] + shape.offset[:-1] ** 2) / 3).sum()
        assert shape.moment_of_inertia == pytest.approx(inertia, rel=1e-13)
        height = (shape.height[1:] + shape.height[:-1]) / 2
        energy = 3.0 / 8 * G * height.sum() + 100.0 * (shape.offset[0] - 0.3) ** 2 - 40.5 * inertia
        assert shape.effective_energy == pytest.approx(energy, rel=1e-12)


# ---- stability, against points in space


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("ends", ENDS)
def test_exponents_are_those_of_points_in_space(ends, seed):
    rng = np.random.default_rng(seed)
    lower, upper = (
        end if math.isinf(end.stiffness) else Support(stiffness=end.stiffness, radius=end.radius, mass=end.carriage or 0.3)
        for end in ENDS[ends]
    )
    held = random_held(rng, 4, "plummets", lower, upper, rng.uniform(0.4, 0.8))
    speed = rng.uniform(5.0, 9.0)
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G, max_half_waves=3)
    assert len(shapes)
    for shape in shapes:
        got = shape.stability().exponents
        want = np.linalg.eigvals(Motion(held, shape.offset, shape.height, speed, "free").first_order()) / speed
        assert got.size == want.size
        off = max(np.abs(got - s).min() for s in want), max(np.abs(want - s).min() for s in got)
        assert max(off) < 1e-6 * np.abs(want).max()  # two that meet are known to half the digits
        assert np.median([np.abs(got - s).min() for s in want]) < 1e-12 * np.abs(want).max()
        grows = want.real.max()
        if shape.stability().verdict == "unstable":
            assert grows > 1e-7
        elif shape.stability().verdict != "undecided":
            assert grows < 1e-6


# ---- branches


def test_branches_on_arms_and_springs_are_of_steady_shapes():
    rng = np.random.default_rng(4)
    for name in ENDS:
        held = random_held(rng, 4, "plummets", *ENDS[name], 0.7)
        branches = rc.branches(held, max_angular_speed=9.0, gravity=G)
        modes = [branch.mode for branch in branches]
        assert modes == sorted(set(modes))
        assert branches
        for branch in branches:
            assert math.isclose(branch.angular_speed[0], 9.0, rel_tol=1e-12)
            assert rc.branch(held, branch.mode, max_angular_speed=9.0, gravity=G) == branch
            first = rc.steady_shape(held, mode=branch.mode, angular_speed=9.0, gravity=G)
            assert np.abs(first.inclination - branch.shape(0).inclination).max() < 1e-13
            assert first.proved
            for k in {0, len(branch) // 3, len(branch) // 2, 2 * len(branch) // 3, *branch.folds}:
                shape, speed = branch.shape(int(k)), branch.angular_speed[k]
                pins = Pins(held, speed)
                pull = tensions(held, shape, speed)
                x = [*shape.offset[pins.free_y], *shape.height[1:-1], *(pull / held.system.length)]
                assert np.abs(pins.gaps(x)).max() < 1e-9 * max(pull.max(), 1.0)
        listed = rc.steady_shapes(held, angular_speed=9.0, gravity=G, max_half_waves=4)
        ends = [branch.shape(-1) for branch in branches if branch.end == "speed"]
        for shape in [*(branch.shape(0) for branch in branches), *ends]:
            if shape.half_waves <= 4:
                assert any(np.abs(other.inclination - shape.inclination).max() < 1e-8 for other in listed)


def tensions(held, shape, speed):
    """Of the threads of plummets, from the forces along the axis."""
    up = shape.lower_pull[1] + np.cumsum(held.system.mass) * G
    across = -shape.lower_pull[0] + np.cumsum(held.system.mass * shape.offset[:-1]) * speed**2
    return np.hypot(up, across)


def test_the_speed_of_a_tension_on_arms():
    arms = {"lower": Support(radius=0.1), "upper": Support(radius=0.2)}
    held = rc.Held(rc.Chain.uniform_rods(8, length=2.0, mass=3.0), span=1.4, **arms)
    for mode in (1, 2):
        shape = rc.steady_shape(held, mode=mode, top_tension=200.0)
        assert shape.tension[-1] == pytest.approx(200.0, rel=1e-12)
        again = rc.steady_shape(held, mode=mode, angular_speed=shape.angular_speed)
        assert np.abs(again.inclination - shape.inclination).max() < 1e-12
    outwards, inwards = (rc.steady_shape(held, mode=mode, angular_speed=9.0) for mode in (1, 2))
    assert outwards.inclination[0] < 0 < inwards.inclination[0]
    assert outwards.half_waves == inwards.half_waves == 1
    wide = rc.branch(rc.Held(held.system, span=1.4, lower=ARMS[0], upper=ARMS[1]), 1, max_angular_speed=9.0)
    assert wide.end == "rest"  # it hangs between the arms, as a catenary does
    assert wide.conical_height[-1] > 1e4 * 2.0
    links = held.system.total_mass / 8 * (np.arange(8) + 0.5)
    hung = wide.shape(-1)
    middle = (hung.offset[1:] - hung.offset[:-1]) / (hung.height[1:] - hung.height[:-1])
    np.testing.assert_allclose(1 / middle, (links * 9.80665 + hung.lower_pull[1]) / hung.lower_pull[0], rtol=2e-3)


# ---- under a tension


def test_shapes_between_springs_of_one_tension():
    rng = np.random.default_rng(8)
    held = random_held(rng, 4, "plummets", *SPRINGS, 0.7)
    shape = rc.steady_shapes(held, angular_speed=8.0, gravity=G)[0]
    pulled = rc.Held(held.system, tension=float(shape.tension[-1]), lower=held.lower, upper=held.upper)
    found = rc.steady_shapes(pulled, angular_speed=8.0, gravity=G)
    same = min(found, key=lambda other: abs(other.span - held.span))
    assert abs(same.span - held.span) < 1e-11
    assert np.abs(same.inclination - shape.inclination).max() < 1e-10


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("ends", ["springs", "lower spring", "both heavy", "firm"])
def test_whirl_speeds_under_a_tension_against_a_dense_pencil(ends, seed):
    rng = np.random.default_rng(seed)
    heavy = (Support(stiffness=50.0, mass=2.0), Support(stiffness=5e3, mass=0.1))
    lower, upper = (ENDS | {"both heavy": heavy, "firm": (Support(), Support())})[ends]
    held = random_held(rng, 5, "plummets" if seed % 2 else "rods", lower, upper, 0.7)
    if ends == "firm":
        held = rc.Held(random_chain(rng, 7), span=0.5)  # bodies, by weight
    tension = 2.5 * float(sum(Pins(held, 1.0).weight))
    taut = rc.Held(held.system, tension=tension, lower=lower, upper=upper)
    modes = rc.modes(taut, "all", gravity=G)
    with mp.workdps(50):
        pins = Pins(held, 1.0, mp.mpf)
        pull = mp.mpf(tension) - sum(pins.weight)
        moving = pins.free_y
        stiff = mp.diag([s for s in pins.spring])
        for i in range(pins.n):
            pull += pins.m[i] * pins.g * pins.h[i] / pins.a[i]
            for a, b, sign in ((i, i, 1), (i + 1, i + 1, 1), (i, i + 1, -1), (i + 1, i, -1)):
                stiff[a, b] += sign * pull / pins.a[i]
            pull += pins.m[i] * pins.g * (1 - pins.h[i] / pins.a[i])
        K = mp.matrix([[stiff[a, b] for b in moving] for a in moving])
        M = mp.matrix([[pins.mass[a][b] for b in moving] for a in moving])
        flexible = [mp.re(x) for x in mp.eig(K**-1 * M)[0]]
        heights = sorted((pins.g * x for x in flexible if x > mp.mpf(10) ** -30), reverse=True)
        assert taut.mode_count == len(modes) == len(heights)
        for got, want in zip(modes.conical_height, heights, strict=True):
            assert abs(mp.mpf(float(got)) - want) <= EPS * (1 + 1e-14) * want
        for speed in (5.0, 20.0):
            assert rc.count_modes(taut, angular_speed=speed, gravity=G) == sum(pins.g / speed**2 < h for h in heights)
    assert "error bound" in repr(modes)
    assert (modes.error_bound <= EPS * (1 + 1e-14)).all()
    assert np.abs(modes.residual).max() < 1e-13
    assert (np.abs(modes.shape).max(axis=1) == 1.0).all()
    assert (modes.shape[:, moving[0]] > 0).all()
    tuned = rc.tune(taut, mode=2, angular_speed=float(modes.angular_speed[1]) * 1.2, vary="tension", gravity=G)
    again = rc.modes(tuned.system, 2, gravity=G)
    assert again.angular_speed[1] == pytest.approx(1.2 * modes.angular_speed[1], rel=1e-14)
    assert tuned.system.lower == lower


# ---- refusals


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda c: rc.Held(c, tension=90.0, lower=ARMS[0]), "lower end must be on the axis under a tension; give the span"),
        (lambda c: rc.Held(c, span=1.0, upper=Support(radius=3.0)), "ends must be nearer to each other than the length 2"),
        (lambda c: rc.Held(c, span=1.0, upper=Support(stiffness=1.0, weight=2.0)), "upper: the chain was given by mass"),
        (lambda c: rc.Held(rc.Cord(2.0, mass=1.0), span=1.0, lower=ARMS[0]), r"firm point on the axis; cut it into links"),
        (lambda c: rc.modes(rc.Held(c, span=1.0, lower=ARMS[0])), "is bent.*use steady_shapes"),
        (lambda c: rc.steady_shape(rc.Held(c, span=1.0, lower=SPRINGS[0]), top_tension=90.0), "with springs give"),
        (lambda c: rc.steady_shape(rc.Held(c, span=1.0, lower=ARMS[0]), mode=9, angular_speed=9.0), "mode must be from 1 to 4"),
        (lambda c: rc.branch(rc.Held(c, span=1.0, lower=ARMS[0]), 4, max_angular_speed=3.0), "mode must be that of a branch"),
        (lambda c: rc.branches(rc.Held(c, span=1.0, lower=SPRINGS[0], weightless=True), max_angular_speed=3.0),
         "without gravity there are no branches; use steady_shapes"),
        (lambda c: rc.fit(rc.Held(c, span=1.0, lower=ARMS[0]), {1: (9.0, 0.1)}, vary="length"), "is bent"),
    ],
)  # fmt: skip
def test_refusals(make, sentence):
    with pytest.raises(ValueError, match=sentence):
        make(rc.Chain.uniform_rods(3, length=2.0, mass=1.0))


def test_ends_are_supports():
    chain = rc.Chain.uniform_rods(3, length=2.0, mass=1.0)
    with pytest.raises(TypeError, match=r"lower must be a revchain\.Support, got 3"):
        rc.Held(chain, span=1.0, lower=3)
    held = rc.Held(chain, span=1.0, lower=Support(radius=0.0), upper=Support())
    assert held == rc.Held(chain, span=1.0)
    assert hash(held) == hash(rc.Held(chain, span=1.0))
    sprung = rc.Held(chain, span=1.0, lower=SPRINGS[0])
    assert sprung != held
    assert pickle.loads(pickle.dumps(sprung)) == sprung == rc.Held.from_dict(sprung.to_dict())
    shape = rc.steady_shapes(sprung, angular_speed=9.0)[0]
    assert pickle.loads(pickle.dumps(shape)).stability().exponents.size == shape.stability().exponents.size


def test_plots_of_arms():
    pytest.importorskip("matplotlib")
    held = rc.Held(rc.Chain.uniform_rods(6, length=2.0, mass=3.0), span=1.4, lower=ARMS[0], upper=ARMS[1])
    shapes = rc.steady_shapes(held, angular_speed=9.0, budget=0)
    ax = shapes.plot()
    assert any(list(line.get_xdata()) == [0.3, 0.7] for line in ax.get_lines())
    assert rc.branches(held, max_angular_speed=9.0).plot().get_xlabel() == "speed (rad/s)"
    held.plot()


# ---- tuning and no gravity, between springs


def test_the_length_between_springs_that_gives_a_speed():
    """Springs keep their stiffness, so that heights are not as the length."""
    held = rc.Held(rc.Chain.uniform_rods(6, length=2.0, mass=1.0), tension=50.0, lower=Support(stiffness=150.0, mass=0.1))
    for mode, speed in ((1, 14.0), (2, 30.0)):
        tuned = rc.tune(held, vary="length", mode=mode, angular_speed=speed)
        assert tuned.status == "found" and not tuned.complete and tuned.system.lower == held.lower
        assert rc.modes(tuned.system, mode).angular_speed[-1] == pytest.approx(speed, rel=1e-13)


@pytest.mark.parametrize("gravity", [9.80665, 2.0])
def test_whirl_speeds_between_springs_without_gravity(gravity):
    """Of point masses on a string with springs: a dense pencil, and the same whatever the gravity of the question."""
    masses, length, tension, ends = np.array([0.3, 0.5, 0.2, 0.4]), 0.5, 40.0, (150.0, 900.0)
    springs = {"lower": Support(stiffness=ends[0], mass=0.1), "upper": Support(stiffness=ends[1], mass=0.25)}
    held = rc.Held(rc.Chain(mass=masses, length=length), tension=tension, weightless=True, **springs)
    M = np.diag([masses[0] + 0.1, *masses[1:], 0.25])
    K = np.diag([ends[0], 0.0, 0.0, 0.0, ends[1]])
    for i in range(4):
        K[i : i + 2, i : i + 2] += tension / length * np.array([[1.0, -1.0], [-1.0, 1.0]])
    speeds = np.sqrt(np.sort(np.linalg.eigvals(np.linalg.solve(M, K)).real))
    np.testing.assert_allclose(rc.modes(held, "all", gravity=gravity).angular_speed, speeds, rtol=1e-13)
