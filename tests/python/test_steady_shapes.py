# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes, their lists and their stability, against mechanics written out in support/mechanics.py; figures known
from elsewhere, what is refused, pictures."""

from functools import partial

import mpmath as mp
import numpy as np
import pytest
from mechanics import KINDS, disturbed, inertia, moments, plummets, random_chain, scan, turned

import revchain as rc


def error_of(chain, height, shape):
    """The largest of an inclination: Newton's method in 40 digits on the gradient of the effective potential."""
    with mp.workdps(40):
        inert, kappa = inertia(chain, mp.mpf)
        inert, given = inert / mp.mpf(float(height)), np.array([mp.mpf(float(x)) for x in shape.inclination])
        d = given
        for _ in range(5):
            s, c = (np.array([f(x) for x in d]) for f in (mp.sin, mp.cos))
            force = inert @ s
            slope = np.diag(kappa * c + s * force) - inert * np.outer(c, c)
            d = d - np.array(list(mp.lu_solve(mp.matrix(slope.tolist()), mp.matrix(list(kappa * s - c * force)))))
        return float(max(abs(d - given)))


CHAINS = [(kind, count, seed) for kind in KINDS for count in (1, 2, 3, 4) for seed in (1, 2)]


# ---- lists


def may_lean(chain, height, hanging):
    """Whether a link between others could lean to any side under no load: lambda (W h + a S) <= W h (l - a), standing a - l."""
    below = np.cumsum(chain.weight) - chain.weight
    stiffness = height * (chain.weight * chain.centroid + chain.length * below)
    turning = chain.weight * chain.centroid * (chain.pendulum_length - chain.length)
    return bool(np.any(((turning if hanging else abs(turning)) >= stiffness)[1:-1]))


@pytest.mark.parametrize("hanging", [True, False])
@pytest.mark.parametrize(("kind", "count", "seed"), CHAINS)
def test_list_is_complete_exact_and_in_order(kind, count, seed, hanging):
    chain = random_chain(kind, count, seed)
    for over in (1.3, 12.0):
        height = rc.modes(chain).conical_height[0] / over
        shapes = rc.steady_shapes(chain, conical_height=height, hanging_only=hanging)
        assert shapes.undecided.shape == (0, 2) and shapes.complete == (not may_lean(chain, height, hanging))
        listed = np.array([s.inclination for s in shapes]).reshape(-1, count)
        for found in scan(chain, height, hanging, 1500):
            assert min(turned(listed, found).min(), turned(listed, -found).min()) < 1e-4
        keys = [(s.half_waves, s.inclination[0]) for s in shapes]
        assert keys == sorted(keys)
        for shape in shapes[:4]:
            assert error_of(chain, height, shape) <= shape.error_bound < 1e-14
            assert moments(chain, shape) < 1e-15
            assert shape.offset[0] >= 0 and shape.offset[-1] == 0
            assert shape.offset.shape == shape.height.shape == (count + 1,)
            signs = np.sign(shape.offset[:-1])
            signs = signs[signs != 0]
            assert shape.half_waves == 1 + np.count_nonzero(np.diff(signs))


@pytest.mark.parametrize(("count", "over"), [(100, 500), (1000, 20), (1000, 100)])
@pytest.mark.parametrize("rods", [False, True])
def test_long_chains_far_from_the_vertical_are_complete(count, over, rods):
    rng = np.random.default_rng([count, over, rods])
    length = rng.uniform(0.5, 2.0, count)
    body = {"centroid": length / 2, "radius_of_gyration": length / np.sqrt(12)} if rods else {}
    chain = rc.Chain(weight=rng.uniform(0.5, 2.0, count), length=length, **body)
    height = length.sum() / over
    shapes = rc.steady_shapes(chain, conical_height=height)
    assert shapes.complete and len(shapes) == len({tuple(s.inclination) for s in shapes})
    # from each speed of small motion on there is a shape with as many half waves
    assert {s.half_waves for s in shapes} >= set(range(1, rc.count_modes(chain, conical_height=height) + 1))
    assert all(moments(chain, shape) < 1e-13 for shape in shapes)


@pytest.mark.parametrize(
    ("count", "ratio", "shapes"),
    [(1, 2.0, 1), (2, 166.0, 2), (3, 166.0, 5), (4, 166.0, 10), (6, 187.5, 56), (8, 16.0, 19), (8, 35.4025, 84),
     (10, 50.0, 412)],
)
def test_counts_known_from_elsewhere(count, ratio, shapes):
    found = rc.steady_shapes(plummets(count), conical_height=1 / ratio)
    assert found.complete and len(found) == shapes and found.cells > 0
    kind = "shape" if count == 1 else "hanging shape"  # one link alone cannot stand
    assert repr(found).startswith(f"{shapes} {kind}") and "proved complete" in repr(found)


def test_complete_says_of_which_shapes():
    """Four links at 15 rad/s have 10 hanging shapes, and 64 in any posture."""
    chain = plummets(4)
    hanging, every = (rc.steady_shapes(chain, angular_speed=15.0, hanging_only=only) for only in (True, False))
    assert (len(hanging), hanging.complete, hanging.hanging_only) == (10, True, True)
    more = "there may be more"
    said = "10 hanging shapes at 15.0000 rad/s (143.2 rpm), proved complete; with links above their pins " + more
    assert repr(hanging).splitlines()[0] == said
    cut_short = repr(rc.steady_shapes(chain, angular_speed=15.0, budget=0)).splitlines()[0]
    assert cut_short.endswith("; there may be more, also with links above their pins")
    assert (len(every), every.complete, every.hanging_only) == (64, True, False)
    assert repr(every).startswith("64 shapes at 15.0000 rad/s") and more not in repr(every)
    slow = rc.steady_shapes(chain, conical_height=10.0)  # below the first critical speed no posture has a shape
    assert repr(slow).startswith("0 shapes at") and more not in repr(slow)
    turned = rc.steady_shapes(rc.Rig(plummets(2), inverted=[True, False]), conical_height=0.1)
    assert f"{len(turned)} shape" in repr(turned) and "in the rig's posture" in repr(turned)
    assert f"in other postures {more}" in repr(turned)
    assert more not in repr(rc.steady_shapes(rc.Cord(1.0), conical_height=0.1))
    assert hanging.to_dict()["hanging_only"] is True


@pytest.mark.parametrize(("ratio", "hanging", "every"), [(0.7, 1, 2), (9.0, 2, 13), (16.0, 3, 14), (50.0, 7, 20)])
def test_three_rods_hanging_and_standing(ratio, hanging, every):
    rods = rc.Chain.uniform_rods(3, length=3.0)
    assert len(rc.steady_shapes(rods, conical_height=1 / ratio)) == hanging
    found = rc.steady_shapes(rods, conical_height=1 / ratio, hanging_only=False)
    assert len(found) == every and not len(found.undecided)
    assert found.complete == (ratio < 9.0)  # faster, the middle one may lean out of the plane
    assert sum(bool(np.all(np.cos(shape.inclination) > 0)) for shape in found) == hanging
    for shape in found:
        assert moments(rods, shape) < 1e-15 and shape.error_bound < 4.5e-16
        assert np.all(np.abs(shape.inclination) <= np.pi) and shape.offset[0] > 0


@pytest.mark.parametrize("weight", [1e-100, 1.0, 1e100])
@pytest.mark.parametrize("length", [1e-150, 1e-100, 1e100, 1e150])
def test_scale_invariance(length, weight):
    def pair(u, v):
        a = np.array([0.7, 1.0, 0.4]) * u
        return rc.Chain(weight=np.array([1.0, 3.0, 2.0]) * v, length=a, centroid=a * 0.5, radius_of_gyration=a * 0.6)

    base = rc.steady_shapes(pair(1, 1), conical_height=0.03)
    other = rc.steady_shapes(pair(length, weight), conical_height=0.03 * length)
    assert not len(other.undecided) and other.complete == base.complete
    for p, q in zip(base, other, strict=True):
        assert np.abs(p.inclination - q.inclination).max() < 1e-12
        assert np.allclose(q.tension / weight, p.tension, rtol=1e-12)
        assert p.stability().verdict == q.stability().verdict


@pytest.mark.parametrize("weight", [[1, 1e12, 1], [1e12, 1, 1e-12], [1e-12, 1, 1e12], [1, 0, 1], [1, 0, 0], [1, 1, 0]])
def test_extreme_weights(weight):
    chain = rc.Chain(weight=weight, length=[1.0, 1.0, 1.0])
    height = rc.modes(chain).conical_height[0] * 0.4
    shapes = rc.steady_shapes(chain, conical_height=height)
    assert shapes.complete
    assert all(error_of(chain, height, s) <= s.error_bound for s in shapes)


@pytest.mark.parametrize("budget", [0, 1, 10, np.int64(100), 2**31])
def test_small_budget_is_owned_up_to(budget):
    shapes, full = (rc.steady_shapes(plummets(3), conical_height=0.03, **given) for given in ({"budget": budget}, {}))
    assert shapes.complete == (budget == 2**31)
    if shapes.complete:
        assert len(shapes) == len(full)
        return
    assert shapes.undecided.shape[0] > 0 and np.all(shapes.undecided[:, 0] <= shapes.undecided[:, 1])
    assert "there may be more" in repr(shapes)
    for tip in (s.inclination[0] for s in full):
        assert any(abs(tip - q.inclination[0]) < 1e-12 for q in shapes) or any(
            lo <= abs(tip) <= hi or lo <= tip <= hi for lo, hi in shapes.undecided
        )
    assert not rc.steady_shapes(plummets(8), conical_height=0.01, budget=50, hanging_only=False).complete


def test_one_plummet_is_the_conical_pendulum():
    shape = rc.steady_shapes(rc.Chain.uniform_plummets(1, length=2.0), conical_height=1.0, gravity=4.0)[0]
    lean = {"inclination": [np.pi / 3], "reaction_inclination": [np.pi / 3], "tension": [2.0]}
    place = {"offset": [np.sqrt(3), 0.0], "height": [-1.0, 0.0]}
    whole = {"moment_of_inertia": 3.0, "effective_energy": -2.5, "angular_momentum": 1.5}
    for name, value in {**lean, **place, **whole}.items():
        assert getattr(shape, name) == pytest.approx(value, rel=3e-16), name
    assert shape.half_waves == 1 and shape.conical_height == 1.0
    assert shape.residual < 1e-20 and shape.condition > 0 and "60.0000" in repr(shape)


def test_a_list_is_a_sequence():
    found = rc.steady_shapes(plummets(4), conical_height=0.02)
    assert found[-1] is list(found)[-1]
    assert found[1:3] == (found[1], found[2])
    assert list(reversed(found)) == list(found)[::-1]
    with pytest.raises(IndexError):
        found[len(found)]
    found = rc.steady_shapes(plummets(4), conical_height=0.0625)
    by_speed = rc.steady_shapes(plummets(4), angular_speed=4.0, gravity=1.0)
    assert all(np.array_equal(x.inclination, y.inclination) for x, y in zip(found, by_speed, strict=True))


def test_absurd_speeds_end():
    for height in (5e-324, 1e-308, 1e-300, 1e-100, 1e-20):
        assert "shape" in repr(rc.steady_shapes(plummets(3), conical_height=height))
    found = rc.steady_shapes(plummets(2), angular_speed=1e-300)
    assert len(found) == 0 and found.complete and "0 shapes" in repr(found)


# ---- stability


@pytest.mark.parametrize("frame", ["free", "driven"])
@pytest.mark.parametrize(("kind", "count", "seed"), [c for c in CHAINS if c[0] != "massless"])
def test_stability_against_own_linearisation(kind, count, seed, frame):
    chain = random_chain(kind, count, seed)
    height = rc.modes(chain).conical_height[0] / 9
    for hanging in (True, False):
        for shape in rc.steady_shapes(chain, conical_height=height, hanging_only=hanging)[:6]:
            mass, turn, rest, inside = disturbed(chain, shape)
            zero, one = np.zeros_like(mass), np.eye(2 * count)
            if frame == "driven":
                root = np.sqrt(np.linalg.eigvals(-np.linalg.solve(mass[:count, :count], rest[:count, :count])) + 0j)
                mine, second = np.concatenate([root, -root]), np.linalg.eigvalsh(rest[:count, :count])
            else:
                whole = np.block([[zero, one], [-np.linalg.solve(mass, rest), -np.linalg.solve(mass, turn)]])
                mine = np.linalg.eigvals(whole)
                second = np.concatenate([np.linalg.eigvalsh(inside), np.linalg.eigvalsh(rest[count:, count:])])
            got = shape.stability(frame=frame)
            negative = int((second < -1e-9 * np.abs(second).max()).sum())
            assert got.negative_directions == negative
            assert got.frame == frame
            assert got.exponents.size == (4 * count - 2 if frame == "free" else 2 * count)
            assert (np.diff(got.exponents.imag) >= -1e-12).all()
            assert abs(got.growth_rate - mine.real.max()) < 1e-5 * np.abs(mine).max()
            for e in got.exponents:
                assert np.abs(mine - e).min() < 1e-5 * np.abs(mine).max()
            if negative == 0:
                assert got.verdict == "minimum"
            elif mine.real.max() > 1e-4:
                assert got.verdict == "unstable"


def test_stability_of_known_shapes():
    pendulum = rc.steady_shapes(rc.Chain.uniform_plummets(1, length=1.0), conical_height=0.5)[0]
    free, driven = pendulum.stability(), pendulum.stability(frame="driven")
    assert (free.verdict, free.frame) == ("minimum", "free") and repr(free).startswith("Stability (free): minimum")
    assert np.abs(free.exponents.imag).max() == pytest.approx(np.sqrt(1 + 3 / 4), rel=1e-14)
    assert np.abs(driven.exponents.imag).max() == pytest.approx(np.sqrt(3) / 2, rel=1e-14)
    assert driven.negative_directions == 0 and driven.growth_rate <= driven.margin
    shapes = rc.steady_shapes(plummets(2), conical_height=0.2, hanging_only=False)
    standing = [shape.stability() for shape in shapes if np.any(np.cos(shape.inclination) < 0)]
    assert len(standing) == 2
    assert all(found.verdict != "minimum" and found.negative_directions > 0 for found in standing)


# ---- what is refused, pictures


def questions(chain):
    """All that is asked at a speed, or down to it."""
    ends = {"conical_height": "min_conical_height", "angular_speed": "max_angular_speed"}
    until = lambda ask: lambda **k: ask(**{ends[name]: k[name] for name in k})  # noqa: E731
    shapes = partial(rc.steady_shapes, chain), partial(rc.steady_shape, chain)
    return *shapes, until(partial(rc.branch, chain, 1)), until(partial(rc.branches, chain))


@pytest.mark.parametrize("value", [0, -1, float("nan"), float("inf"), "x", [0.1], True, 1j])
@pytest.mark.parametrize("name", ["conical_height", "angular_speed"])
def test_bad_speeds(name, value):
    for call in questions(plummets(2)):
        with pytest.raises(ValueError, match=r"revchain.*" + name + r".*got"):
            call(**{name: value})
    if name == "angular_speed":
        with pytest.raises(ValueError, match="gravity"):
            rc.steady_shapes(plummets(2), angular_speed=1.0, gravity=value)


def test_both_or_no_speed():
    chain = plummets(2)
    both = "(min_)?conical_height and (max_)?angular_speed"
    for call in (*questions(chain), rc.branch(chain, 1, min_conical_height=0.1).at):
        for given, got in (({}, "none"), ({"conical_height": 0.1, "angular_speed": 1.0}, both)):
            with pytest.raises(ValueError, match=rf"exactly one of \w*conical_height.* and \w+, got {got}$"):
                call(**given)
    for call in questions(chain)[1:]:
        with pytest.raises(ValueError, match=r"must be positive and finite, got inf"):
            call(angular_speed=1e-300)


@pytest.mark.parametrize("mode", [0, -1, 4, 1.0, 1.5, "x", None, True, 10**30])
def test_bad_modes(mode):
    least = "mode must be at least 1"
    words = {4: "mode must be from 1 to the number of modes, 3", 0: least, -1: least}.get(mode, "mode must|mode is")
    with pytest.raises(ValueError, match=words):
        rc.steady_shape(plummets(3), mode=mode, conical_height=0.1)
    with pytest.raises(ValueError, match=words):
        rc.branch(plummets(3), mode, min_conical_height=0.1)


@pytest.mark.parametrize("budget", [None, 1.5, "x", True, 10**30, 2**63, np.uint64(2**64 - 1)])
def test_budgets_that_are_none_wrong_or_beyond_all_bounds(budget):
    """None is that of the system for a list, and no number for branches."""
    for is_right, call in (
        (budget is None, lambda: rc.steady_shapes(plummets(2), conical_height=0.1, budget=budget).complete),
        (False, lambda: rc.branches(plummets(2), min_conical_height=0.1, budget=budget).consistent),
    ):
        if is_right or type(budget) in (int, np.uint64):
            assert call()
        else:
            with pytest.raises(ValueError, match="budget"):
                call()


def test_wrong_calls_are_refused():
    with pytest.raises(TypeError, match="hanging_only"):
        rc.steady_shapes(plummets(2), conical_height=1.0, hanging_only="no")
    shape = rc.steady_shapes(plummets(2), conical_height=0.2)[0]
    for frame in ("moving", ["free"], np.array(["free", "driven"]), None):
        with pytest.raises(ValueError, match="frame must be 'free' or 'driven', got"):
            shape.stability(frame=frame)


def test_a_link_that_may_lean_to_any_side():
    """tests/cpp/finite/shapes/several_inclinations.cpp shows that this chain has a shape out of the plane."""
    chain = rc.Chain(weight=[0.2, 1.0, 2.0], length=1.0, centroid=[1.0, 0.5, 1.0], pendulum_length=[1.0, 3.0, 1.0])
    found = rc.steady_shapes(chain, conical_height=0.5)
    assert len(found) == 5 and not found.complete and not len(found.undecided) and found._is_good()
    assert "proved complete in a plane" in str(found) and "shapes that leave the plane" in str(found)
    every = rc.steady_shapes(chain, conical_height=0.5, hanging_only=False)
    assert len(every) == 16 and not every.complete
    assert not rc.steady_shapes(chain, conical_height=1.42).complete  # the link balances by itself up to 1/0.7
    assert rc.steady_shapes(chain, conical_height=1.44).complete
    poor = rc.steady_shapes(plummets(8), conical_height=0.01, budget=50)
    assert not poor.complete and not poor._is_good() and "there may be more" in str(poor)


def test_plots():
    pytest.importorskip("matplotlib")
    found = rc.steady_shapes(rc.Chain.uniform_rods(3, length=3.0), conical_height=0.0625, hanging_only=False)
    axes = found.plot()
    assert axes.get_title() == "14 shapes, proved complete in a plane"
    assert axes.get_xlabel() == "distance from axis (m)"
    drawn = [line.get_xydata() for line in axes.lines]
    for shape in found:
        points = np.column_stack([shape.offset, -shape.height])  # depths
        assert any(np.array_equal(points, line) for line in drawn if line.shape == points.shape)
    assert found[0].plot(axes) is axes
    axes.figure.canvas.draw()
