# SPDX-License-Identifier: GPL-3.0-or-later
"""Finite amplitude as the docstrings promise it, against mechanics written out here and nothing of the library's."""

from concurrent.futures import ThreadPoolExecutor

import mpmath as mp
import numpy as np
import pytest
import revchain as rc
from mechanics import KINDS, inertia, parts, plummets, random_chain, scan, turned


# ---------------------------------------------------------------- independent mechanics
def exact(chain, height, start):
    """Newton's method in 40 digits on the gradient of the effective potential."""
    with mp.workdps(40):
        w, a, h, rho = ([mp.mpf(float(x)) for x in v] for v in parts(chain))
        lam = mp.mpf(float(height))
        count = len(w)
        inert, kappa = inertia(chain)
        d = [mp.mpf(float(x)) for x in start]
        for _ in range(8):
            s = [mp.sin(x) for x in d]
            y = [mp.mpf(0)] * (count + 1)
            for m in range(count - 1, -1, -1):
                y[m] = y[m + 1] + a[m] * s[m]
            below = force = mp.mpf(0)
            res = []
            for m in range(count):
                g = y[m + 1] + h[m] * s[m]
                res.append((w[m] * h[m] + a[m] * below) * s[m]
                           - mp.cos(d[m]) / lam * (a[m] * force + w[m] * (h[m] * g + rho[m] ** 2 * s[m])))
                below += w[m]
                force += w[m] * g
            sd = np.array([float(x) for x in s])
            cd = np.array([float(mp.cos(x)) for x in d])
            jac = np.diag(kappa * cd + sd * (inert @ sd) / float(lam)) - inert / float(lam) * np.outer(cd, cd)
            step = mp.lu_solve(mp.matrix(jac.tolist()), mp.matrix(res))
            d = [p - q for p, q in zip(d, step, strict=True)]
        return d


def linearised(shape, chain, frame):
    """Exponents, and the eigenvalues of the energy's second variation, of thin links."""
    inert, kappa = inertia(chain)
    b = inert / shape.conical_height
    s, c = np.sin(shape.inclination), np.cos(shape.inclination)
    n = s.size
    diag = np.diag(s * (b @ s) + kappa * c)
    plane, across = diag - b * np.outer(c, c), diag - b
    mass = b * (np.outer(c, c) + np.outer(s, s))
    if frame == "driven":
        root = np.sqrt(np.linalg.eigvals(-np.linalg.solve(mass, plane)) + 0j)
        return np.concatenate([root, -root]), np.linalg.eigvalsh(plane)
    zero = np.zeros((n, n))
    gyro = 2 * c[:, None] * b
    m = np.block([[mass, zero], [zero, b]])
    g = np.block([[zero, -gyro], [gyro.T, zero]])
    k = np.block([[plane, zero], [zero, across]])
    big = np.block([[np.zeros((2 * n, 2 * n)), np.eye(2 * n)], [-np.linalg.solve(m, k), -np.linalg.solve(m, g)]])
    turn = 2 * c * (b @ s)
    inside = np.linalg.eigvalsh(plane + np.outer(turn, turn) / (s @ b @ s))
    return np.linalg.eigvals(big), np.concatenate([inside, np.linalg.eigvalsh(across)])


CHAINS = [(kind, count, seed) for kind in KINDS for count in (1, 2, 3, 4) for seed in (1, 2)]


# ---------------------------------------------------------------- steady_shapes
@pytest.mark.parametrize("hanging", [True, False])
@pytest.mark.parametrize(("kind", "count", "seed"), CHAINS)
def test_list_is_complete_exact_and_in_order(kind, count, seed, hanging):
    chain = random_chain(kind, count, seed)
    for over in (1.3, 12.0):
        height = rc.modes(chain).conical_height[0] / over
        shapes = rc.steady_shapes(chain, conical_height=height, hanging_only=hanging)
        assert shapes.complete
        assert shapes.undecided.shape == (0, 2)
        listed = np.array([s.inclination for s in shapes]).reshape(-1, count)
        for found in scan(chain, height, hanging, 1500):
            assert min(turned(listed, found).min(), turned(listed, -found).min()) < 1e-4
        keys = [(s.half_waves, s.inclination[0]) for s in shapes]
        assert keys == sorted(keys)
        for shape in shapes[:4]:
            true = exact(chain, height, shape.inclination)
            error = max(abs(float(t - mp.mpf(float(g)))) for t, g in zip(true, shape.inclination, strict=True))
            assert error <= shape.error_bound
            assert shape.error_bound < 1e-14
            assert shape.offset[0] >= 0
            assert shape.offset.shape == shape.height.shape == (count + 1,)
            assert shape.offset[-1] == 0
            signs = np.sign(shape.offset[:-1])
            signs = signs[signs != 0]
            assert shape.half_waves == 1 + np.count_nonzero(np.diff(signs))


@pytest.mark.parametrize("less", [1e-3, 1e-9, 1e-12, 1e-15])
def test_just_below_the_critical_height(less):
    chain = plummets(3)
    height = rc.modes(chain).conical_height[0] * (1 - less)
    shapes = rc.steady_shapes(chain, conical_height=height)
    assert len(shapes) == 1
    assert shapes.complete
    one = rc.steady_shape(chain, conical_height=height)
    assert np.abs(one.inclination - shapes[0].inclination).max() <= 1e-14 * max(1, one.condition)
    assert rc.steady_shapes(chain, conical_height=1.01 * rc.modes(chain).conical_height[0]).complete


@pytest.mark.parametrize("weight", [1e-100, 1.0, 1e100])
@pytest.mark.parametrize("length", [1e-150, 1e-100, 1e100, 1e150])
def test_scale_invariance(length, weight):
    def pair(u, v):
        a = np.array([0.7, 1.0, 0.4]) * u
        return rc.Chain(weight=np.array([1.0, 3.0, 2.0]) * v, length=a, centroid=a * 0.5, radius_of_gyration=a * 0.6)

    base = rc.steady_shapes(pair(1, 1), conical_height=0.03)
    other = rc.steady_shapes(pair(length, weight), conical_height=0.03 * length)
    assert len(base) == len(other)
    assert other.complete
    for p, q in zip(base, other, strict=True):
        assert np.abs(p.inclination - q.inclination).max() < 1e-12
        assert np.allclose(q.tension / weight, p.tension, rtol=1e-12)
        assert p.stability().verdict == q.stability().verdict


@pytest.mark.parametrize("budget", [0, -1, 1, 10, np.int64(100), 2**31])
def test_small_budget_is_owned_up_to(budget):
    shapes = rc.steady_shapes(plummets(3), conical_height=0.03, budget=budget)
    full = rc.steady_shapes(plummets(3), conical_height=0.03)
    assert shapes.complete == (budget == 2**31)
    if not shapes.complete:
        assert shapes.undecided.shape[0] > 0
        for s in full:
            tip = s.inclination[0]
            assert any(abs(tip - q.inclination[0]) < 1e-12 for q in shapes) or any(
                lo <= abs(tip) <= hi or lo <= tip <= hi for lo, hi in shapes.undecided)
    else:
        assert len(shapes) == len(full)


@pytest.mark.parametrize("weight", [[1, 1e12, 1], [1e12, 1, 1e-12], [1e-12, 1, 1e12], [1, 0, 1], [1, 0, 0], [1, 1, 0]])
def test_extreme_weights(weight):
    chain = rc.Chain(weight=weight, length=[1.0, 1.0, 1.0])
    height = rc.modes(chain).conical_height[0] * 0.4
    shapes = rc.steady_shapes(chain, conical_height=height)
    assert shapes.complete
    for s in shapes:
        true = exact(chain, height, s.inclination)
        assert max(abs(float(t - mp.mpf(float(g)))) for t, g in zip(true, s.inclination, strict=True)) <= s.error_bound


# ---------------------------------------------------------------- what is refused, and how
BAD = [0, -1, float("nan"), float("inf"), "x", [0.1], True, 1j]


def questions(chain):
    """All that is asked at a speed."""
    return (lambda **k: rc.steady_shapes(chain, **k), lambda **k: rc.steady_shape(chain, **k),
            lambda **k: rc.branch(chain, 1, **{{"conical_height": "min_conical_height", "angular_speed":
                                                "max_angular_speed"}.get(name, name): k[name] for name in k}))


@pytest.mark.parametrize("value", BAD)
@pytest.mark.parametrize("name", ["conical_height", "angular_speed"])
def test_bad_speeds(name, value):
    for call in questions(plummets(2)):
        with pytest.raises(ValueError, match=r"revchain.*" + name + r".*got"):
            call(**{name: value})


def test_both_or_no_speed():
    chain = plummets(2)
    for call in (*questions(chain), rc.branch(chain, 1, min_conical_height=0.1).at, lambda **k: rc.branches(
            chain, **{f"{'min' if 'height' in name else 'max'}_{name}": k[name] for name in k})):
        both = "(min_)?conical_height and (max_)?angular_speed"
        for given, got in (({}, "none"), ({"conical_height": 0.1, "angular_speed": 1.0}, both)):
            with pytest.raises(ValueError, match=rf"exactly one of \w*conical_height.* and \w+, got {got}$"):
                call(**given)


@pytest.mark.parametrize("mode", [0, -1, 4, 1.0, 1.5, "x", None, True, 10**30])
def test_bad_modes(mode):
    with pytest.raises(ValueError, match="mode"):
        rc.steady_shape(plummets(3), mode=mode, conical_height=0.1)
    with pytest.raises(ValueError, match="mode"):
        rc.branch(plummets(3), mode, min_conical_height=0.1)


@pytest.mark.parametrize("budget", [1.5, "x", None, True, 10**30, 2**63, np.uint64(2**64 - 1)])
def test_budgets_that_are_none_or_beyond_all_bounds(budget):
    calls = [lambda: rc.steady_shapes(plummets(2), conical_height=0.1, budget=budget).complete,
             lambda: rc.branches(plummets(2), min_conical_height=0.1, budget=budget).consistent]
    for call in calls:
        if type(budget) in (int, np.uint64):
            assert call()
        else:
            with pytest.raises(ValueError, match="budget"):
                call()


@pytest.mark.parametrize("chain", [None, "x", 3])
def test_no_chain(chain):
    for call in (*questions(chain), lambda **k: rc.branches(chain, min_conical_height=0.1)):
        with pytest.raises(TypeError, match=rf"system must be a revchain.Chain.*, got {chain!r}"):
            call(conical_height=0.1)


def test_hopelessly_slow_speed_is_no_nan():
    shapes, *others = questions(plummets(2))
    found = shapes(angular_speed=1e-300)
    assert len(found) == 0 and found.complete and "0 shapes" in repr(found)
    for call in others:
        with pytest.raises(ValueError, match=r"must be positive and finite, got inf"):
            call(angular_speed=1e-300)


# ---------------------------------------------------------------- crashes and hangs
def test_absurd_speeds_end(python):
    run = python("-c", "import revchain as rc\nfor height in (5e-324, 1e-308, 1e-300, 1e-100, 1e-20):\n"
                 "    print(rc.steady_shapes(rc.Chain.uniform_plummets(3, 3.0), conical_height=height))", timeout=10)
    assert run.returncode == 0, run.stderr


@pytest.mark.parametrize("less", [1e-3, 1e-6, 1e-9, 1e-10, 1e-13, 1e-14, 1e-15])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_diagrams_just_below_critical(count, less):
    chain = plummets(count)
    diagram = rc.branches(chain, min_conical_height=rc.modes(chain).conical_height[0] * (1 - less))
    assert len(diagram) == 1
    assert diagram.consistent or less < 1e-9


# ---------------------------------------------------------------- steady_shape and branch
@pytest.mark.parametrize("given", [{"tip_inclination": 1.57}, {"tip_radius": 2.9999999}, {"top_tension": 3.00001},
                                   {"top_tension": 3e3},
                                   *({f"tip_{name}": x} for name in ("inclination", "radius")
                                     for x in (1e-6, 1e-8, 1e-12))])
def test_large_and_small_amplitudes_are_met(given):
    shape = rc.steady_shape(rc.Chain(weight=1.0, length=[1.0, 1.0, 1.0]), **given)
    name, value = next(iter(given.items()))
    tip = {"tip_inclination": shape.inclination[0], "tip_radius": shape.offset[0]}
    got = {**tip, "top_tension": shape.tension[-1]}[name]
    assert got == pytest.approx(value, rel=1e-12 if value > 1e-3 else 1e-15)


@pytest.mark.parametrize("given", [{"top_tension": 3.0}, {"top_tension": 2.0}, {"tip_radius": 3.0}, {"tip_radius": 4.0},
                                   {"tip_inclination": np.pi / 2}, {"tip_inclination": 2.0}, {"tip_inclination": 0.0},
                                   {"tip_radius": np.nan}])
def test_out_of_range(given):
    with pytest.raises(ValueError, match="got"):
        rc.steady_shape(rc.Chain(weight=1.0, length=[1.0, 1.0, 1.0]), **given)


@pytest.mark.parametrize(("count", "mode"), [(10, 10), (30, 30), (50, 40), (50, 50), (300, 2), (300, 100), (300, 300)])
@pytest.mark.parametrize("part", [0.999, 0.5])
def test_every_mode_has_its_shape(count, mode, part):
    chain = plummets(count)
    height = rc.modes(chain, 1, first=mode).conical_height[0] * part
    if count < 300:
        assert rc.branch(chain, mode, min_conical_height=height).end == "height"
    if (count, part) == (300, 0.5) and mode == 300:  # its free end would be 1e-370 from the axis
        with pytest.raises(ValueError, match="mode 300"):
            rc.steady_shape(chain, mode=mode, conical_height=height)
        return
    shape = rc.steady_shape(chain, mode=mode, conical_height=height)
    assert shape.half_waves == mode


def test_many_links():
    chain = plummets(300)
    height = 0.9 * rc.modes(chain, 1).conical_height[0]
    shapes = rc.steady_shapes(chain, conical_height=height)
    assert shapes.complete
    assert len(shapes) == 1
    assert np.abs(shapes[0].inclination - rc.steady_shape(chain, conical_height=height).inclination).max() < 1e-13


@pytest.mark.parametrize("points", [1, 2, 7])
def test_max_points(points):
    assert len(rc.branch(plummets(3), 1, min_conical_height=0.1, max_points=points)) <= points


# ---------------------------------------------------------------- stability
@pytest.mark.parametrize("frame", ["free", "driven"])
@pytest.mark.parametrize(("kind", "count", "seed"), [c for c in CHAINS if c[0] != "massless"])
def test_stability_against_own_linearisation(kind, count, seed, frame):
    chain = random_chain(kind, count, seed)
    height = rc.modes(chain).conical_height[0] / 9
    for hanging in (True, False):
        for shape in rc.steady_shapes(chain, conical_height=height, hanging_only=hanging)[:6]:
            mine, second = linearised(shape, chain, frame)
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


@pytest.mark.parametrize("frame", ["free", "driven"])
def test_a_massless_joint_does_not_change_stability(frame):
    jointed = rc.steady_shapes(rc.Chain(weight=[1, 0, 1], length=[1.0, 1.0, 1.0]), conical_height=0.13)
    plain = rc.steady_shapes(rc.Chain(weight=[1, 1], length=[2.0, 1.0]), conical_height=0.13)
    assert len(jointed) == len(plain) == 2
    for p, q in zip(jointed, plain, strict=True):
        a, b = p.stability(frame=frame), q.stability(frame=frame)
        assert not np.isnan(a.exponents).any()
        assert a.growth_rate == pytest.approx(b.growth_rate, abs=1e-6)
        assert a.verdict == b.verdict


def test_threads():
    def asked(_):
        shapes = rc.steady_shapes(plummets(8), conical_height=1 / 35.4025)
        shapes[3].stability()
        return np.array([s.inclination for s in shapes])

    with ThreadPoolExecutor(6) as pool:
        assert all(np.array_equal(asked(0), found) for found in pool.map(asked, range(6)))
