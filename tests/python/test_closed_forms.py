# SPDX-License-Identifier: GPL-3.0-or-later
"""One plummet, two links, the hoop and elliptic functions: balance of forces and mpmath, from the docstrings alone."""

import importlib
import inspect
import itertools
import math
import pickle
import pkgutil
import re
from operator import attrgetter

import mpmath as mp
import numpy as np
import pytest
from exact import carried_tangents, exactly, jacobi, near, pendulum, roots_of
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy import special

import revchain as rc
from revchain import closed_forms, conical_pendulum, elliptic, hoop, plummet, two_links
from revchain.closed_forms import table

ULP = 2.0**-52
NAN, INF = math.nan, math.inf
ratios = st.floats(-20, 20).map(np.exp2)  # twelve decades

pytestmark = pytest.mark.usefixtures("digits")


@pytest.fixture
def digits():
    with mp.workdps(60):
        yield


def ulps(found, exact):
    """The largest error in ulp of the exact numbers (2^-52), 0 for an exact zero that is found."""
    found, exact = np.ravel(found).tolist(), exact if isinstance(exact, (list, tuple)) else [exact]
    worst = mp.mpf(0)
    for f, e in zip(found, exact, strict=True):
        worst = max(worst, abs(mp.mpf(f) - e) / (abs(e) if e else mp.mpf(2) ** -1074) / ULP)
    return float(worst)


# One plummet ---------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize("distance", [1e-9, 1e-20, 1e-100, 1e-150, 1e-200, 1e-300])
def test_two_equal_threads_from_nearly_one_point_reach_as_far_as_they_are_long(distance):
    found = plummet.held_plummet(1.0, 1.0, distance, 0.1 * distance)
    assert found.radius == near(1.0, rel=4 * ULP)
    assert np.isfinite(found.depth)


@pytest.mark.parametrize("exponent", [-400, -60, 60, 400])
def test_lengths_of_a_plummet_scale_exactly(exponent):
    f = 2.0**exponent
    plain, other = plummet.inclined_pendulum(2.0, 1.1), plummet.inclined_pendulum(2 * f, 1.1 * f)
    assert other == (plain.inclination, plain.radius * f, plain.depth * f, plain.tension)
    plain, other = plummet.held_plummet(1.0, 1.3, 1.2, 0.3), plummet.held_plummet(f, 1.3 * f, 1.2 * f, 0.3 * f)
    assert other == (plain.radius * f, plain.depth * f, *plain[2:])
    assert plummet.whirling_thread(0.1 * f, f, 3 * f) == plummet.whirling_thread(0.1, 1.0, 3.0) * f
    plain, other = plummet.carried_inclinations(1.0, 0.25, 0.1), plummet.carried_inclinations(f, 0.25 * f, 0.1 * f)
    assert plain.tolist() == other.tolist()


CARRIED = [
    (1.0, 0.25, 0.1), (1.0, 0.25, 0.45), (1.0, 0.25, 0.6), (1.0, 2.0, 0.1), (1.0, 2.0, 30.0), (1.0, 1.0, 1e-6),
    (1.0, 0.999, 1e-9), (1.0, 0.950272226711884, 0.002397700354444707), (3.0, 1e-5, 2.99), (1e-3, 1e-9, 1e-12),
    (1e6, 3.0, 1e-3),
]  # fmt: skip


@pytest.mark.parametrize(("length", "height", "radius"), CARRIED)
def test_all_inclinations_of_a_carried_plummet(length, height, radius):
    exact = [mp.atan(tangent) for tangent in carried_tangents(*exactly(length, height, radius))[0]]
    found = plummet.carried_inclinations(length, height, radius)
    assert len(exact) == (3 if radius ** (2 / 3) <= length ** (2 / 3) - height ** (2 / 3) else 1)
    assert found.tolist() == sorted(found.tolist())
    assert ulps(found, exact) <= 4


def test_two_inclinations_meet():
    """h sec^3 d = length where they do: cos d = 3/5 of lengths 125, 27 and 64."""
    meeting = plummet.carried_inclinations(125.0, 27.0, np.nextafter(64.0, [0.0, 64.0, 100.0]))
    assert [each.size for each in meeting] == [3, 3, 1]
    np.testing.assert_allclose([each[:2] for each in meeting[:2]], -math.acos(0.6), atol=1e-7)


def test_inclinations_of_arrays_are_a_list():
    found = plummet.carried_inclinations([[1.0], [2.0]], [0.25, 3.0], 0.1)
    assert [each.size for each in found] == [3, 1, 3, 1]
    assert plummet.carried_inclinations([], 0.25, 0.1) == []
    for each, (length, height) in zip(found, itertools.product([1.0, 2.0], [0.25, 3.0]), strict=True):
        assert each.tolist() == plummet.carried_inclinations(length, height, 0.1).tolist()


EXTREME = [(1.0, 10.0**-e) for e in (20, 100, 200, 300, 307)] + [(10.0**e, 0.25) for e in (100, 200, 300, 307)]


@pytest.mark.parametrize(("length", "height"), EXTREME)
def test_three_inclinations_of_any_thread_at_any_speed(length, height):
    found = plummet.carried_inclinations(length, height, 0.1)
    np.testing.assert_allclose(found, [-math.pi / 2, -math.asin(0.1 / length), math.pi / 2], rtol=4 * ULP)


# Two links -----------------------------------------------------------------------------------------------------------


@given(ratios, st.floats(-52, 20).map(lambda e: 2.0**e), st.one_of(st.just(0.0), ratios))
@settings(max_examples=60)
def test_a_swung_link_within_4_ulp(centroid, excess, gyration):
    height = float(pendulum(centroid, gyration) / (1 + excess))
    check_swung_link(centroid, gyration, height)


@mp.workdps(500)
def check_swung_link(centroid, gyration, height):
    h, k, x = exactly(centroid, gyration, height)
    l = pendulum(centroid, gyration)  # noqa: E741
    found = two_links.swung_link(centroid, gyration, height)
    if x >= l:
        assert found == (0, 1, 0, 0)
        return
    sine = mp.sqrt((l - x) * (l + x)) / l
    outward = h * sine / x
    angle = mp.atan2(sine, x / l)
    assert ulps(found.inclination, angle) <= 4
    assert ulps(found.reaction, mp.hypot(1, outward)) <= 4
    assert ulps(found.reaction_inclination, mp.atan(outward)) <= 4
    # cos(angle) = x / l, differentiated by the logarithms of x, h and k
    slope = x / l / (sine * angle)
    condition = slope * (1 + abs(h - k**2 / h) / l + 2 * k**2 / h / l)
    assert found.condition == (near(float(condition), rel=1e-13) if condition < 1e308 else INF)


@pytest.mark.parametrize("centroid", [1.0583581553575252, 1.0, 3e-9, 1e5])
@pytest.mark.parametrize("gyration", [0.0, 1e-200, 1e-9, 3.1270066311776654, 7e30])
@pytest.mark.parametrize("steps", [-3, -1, 0, 1, 2, 40])
def test_a_swung_link_next_to_the_vertical_within_4_ulp(centroid, gyration, steps):
    with mp.workdps(500):
        height = float(pendulum(centroid, gyration))
    check_swung_link(centroid, gyration, height - steps * math.ulp(height))


def test_a_swung_link_of_a_difference_that_cancels():
    check_swung_link(1.0583581553575252, 3.1270066311776654, 10.297357620815864)


SPREAD = st.integers(-640, 640).map(lambda e: 2.0**e)


@given(SPREAD, SPREAD, SPREAD, SPREAD, ratios)
@settings(max_examples=200)
def test_heights_of_extreme_lengths_and_weights(w1, l1, w2, l2, factor):
    """A positive height is 0 only below the range of doubles."""
    with mp.workdps(1200):
        l1 *= factor
        a, b, c, d = exactly(w1, l1, w2, l2)
        pair = two_links.two_plummets(**named((w1, l1, w2, l2)))
        hung = two_links.link_on_thread(l1, l2, 0.0)
        stands = two_links.standing_plummet(standing_weight=w1, rod=l1, hung_weight=w2, thread=l2)
        cases = [(pair, roots_of(b + d, b * d * c / (a + c))), (hung[:1], [b + d])]
        cases.append(([stands], [max(roots_of(d - b, -b * d * c / (a + c)))]))
        gyration = min(w1, 1.0)
        if gyration / l2 * gyration < 1e300:
            h, k = exactly(l2, gyration)
            cases.append((two_links.link_on_thread(l1, l2, gyration), roots_of(b + h + k * k / h, b * k * k / h)))
            lift = [max(roots_of(b - h - k * k / h, -b * k * k / h))]
            cases.append(([two_links.standing_link(l1, l2, gyration)], lift))
            thread = b * (h + k * k / h + b) / (k * k / h + b)
            cases.append(([two_links.thread_of_standing_link(l1, l2, gyration)], [thread]))
        for found, exact in cases:
            for f, e in zip(found, exact, strict=True):
                if e > 1e-290:
                    assert ulps(f, e) <= 4, (float(f), mp.nstr(e))


@pytest.mark.parametrize("length", [1e-195, 5e-324, 1e-310, 1e290, 1.7e308])
def test_heights_of_equal_lengths_at_the_ends_of_the_range(length):
    try:
        pair = two_links.two_plummets(**named((1, length, 3, length)))
    except ValueError as refusal:  # the larger height is beyond the range
        assert length > 1.1e308 and "larger height" in str(refusal)
    else:
        np.testing.assert_allclose(pair, [1.5 * length, 0.5 * length], rtol=4 * ULP, atol=5e-324)
    gyration = length if length < 1 else length / 8
    assert 0 < two_links.standing_link(length, length, gyration) <= length


@given(ratios, ratios, st.one_of(st.just(0.0), ratios), st.one_of(st.just(0.0), ratios), st.integers(1, 60))
@settings(max_examples=60)
def test_the_pin_of_a_silent_clapper_within_4_ulp(weight, centroid, gyration, other, steps):
    """However near the two pendulum lengths are: the bell's centroid is chosen a few steps beyond."""
    clapper = pendulum(centroid, gyration)
    k = exactly(other)[0]
    if 2 * k > clapper:
        return
    bell_centroid = float(clapper / 2 + mp.sqrt(clapper**2 / 4 - k**2))
    bell_centroid += steps * math.ulp(bell_centroid)
    bell = pendulum(bell_centroid, other)
    if not bell > clapper:
        return
    w, h1, h2 = *exactly(weight, centroid), mp.mpf(bell_centroid)
    pin = w * h2 * (bell - clapper) / (w * h2 + clapper - h1)
    found = two_links.pin_of_silent_clapper(
        bell_weight=weight,
        bell_centroid=bell_centroid,
        bell_radius_of_gyration=other,
        clapper_weight=1.0,
        clapper_centroid=centroid,
        clapper_radius_of_gyration=gyration,
    )
    assert ulps(found, pin) <= 4


@pytest.mark.parametrize("deflection", [1e-300, 1e-30, 1e-9, 1e-6, 0.1, 3.0, 1e6])
@pytest.mark.parametrize("centroid", [0.994, 0.6, 1e-3, 1e-9])
@pytest.mark.parametrize("gyration", [0.0, 0.35, 2.0])
def test_seconds_lost_per_day_within_8_ulp(deflection, centroid, gyration):
    check_seconds_lost(deflection, centroid, gyration)
    check_seconds_lost(float(pendulum(centroid, gyration)), centroid, gyration)


def check_seconds_lost(deflection, centroid, gyration):
    """Over a true day the clock shows its own swings, fewer as sqrt(length / height)."""
    with mp.workdps(400):
        c, h = exactly(deflection, centroid)
        l = pendulum(centroid, gyration)  # noqa: E741
        x = roots_of(c + l, c * (l - h))[0]
        lost = 86400 * (1 - mp.sqrt(l / x))
        if lost > 1e-300:
            assert ulps(two_links.seconds_lost_per_day(deflection, centroid, gyration), lost) <= 8


# Figures at any inclination: one unknown, the tangent of the first link, scanned and refined --------------------------


def named(pair):
    return dict(zip(("lower_weight", "lower_thread", "upper_weight", "upper_thread"), pair, strict=True))


class Pair:
    """Two plummets (w1, l1, w2, l2, height), or a link on a thread (thread, centroid, gyration, height), weight 1.

    The tangent p of the first inclination gives the first offset, height p, as moments about the pin below do; then the
    forces on all of it give the tangent q above, and geometry closes. `up` is -1 where the first link stands.
    """

    def __init__(self, *numbers, up=1):
        self.numbers, self.up = numbers, up
        self.reach = sum(numbers[1:4:2] if len(numbers) == 5 else (numbers[0], float(pendulum(*numbers[1:3])))) / numbers[-1]

    def parts(self, p, numbers, root):
        """Both offsets, the tangent above and the length there."""
        x, s = numbers[-1], self.up * p / root(1 + p * p)
        if len(numbers) == 5:
            w1, l1, w2, above, _ = numbers
            joint = x * p - l1 * s
            return x * p, joint, (w1 * x * p + w2 * joint) / (x * (w1 + w2)), above
        above, h, k, _ = numbers
        joint = x * p - (h + k * k / h) * s
        return x * p, joint, (joint + h * s) / x, above

    def residual(self, p, numbers, root):
        _, joint, q, above = self.parts(p, numbers, root)
        return joint - above * q / root(1 + q * q)

    def offsets(self, p):
        return self.parts(p, exactly(*self.numbers), mp.sqrt)[:2]


def scan(problem, cells=5_000):
    """All tangents p > 0 with no residual, by change of sign on a fine grid, refined to 50 digits."""
    grid = np.geomspace(1e-9, problem.reach * 1.01, cells)
    signs = np.sign(problem.residual(grid, problem.numbers, np.sqrt))
    numbers = exactly(*problem.numbers)
    value = lambda p: problem.residual(p, numbers, mp.sqrt)  # noqa: E731
    brackets = [(grid[i], grid[i + 1]) for i in np.flatnonzero(np.diff(signs) != 0)]
    return [mp.findroot(value, ends, solver="anderson", tol=1e-90, maxsteps=300) for ends in brackets]


def check(problem, shapes):
    """The same figures, their order, half waves and inclinations within 4 ulp."""
    exact = []
    for p in scan(problem):
        y1, y2 = problem.offsets(p)
        exact.append((1 if y1 * y2 > 0 else 2, p, y1, y2))
    exact.sort(key=lambda each: each[:2])
    assert [shape.half_waves for shape in shapes] == [each[0] for each in exact]
    for shape, (_, p, y1, y2) in zip(shapes, exact, strict=True):
        assert ulps(shape.inclination[0], mp.atan(p)) <= 4
        assert ulps(shape.offset, [y1, y2]) <= 4
    return exact


def check_standing(problem, limit, figure):
    """The figure of a first link that stands, below its greatest height."""
    *numbers, height = problem.numbers
    names = list(inspect.signature(figure).parameters)
    shape = figure(**dict(zip(names, problem.numbers, strict=True)))
    assert (shape is None) == (height >= limit(**dict(zip(names, numbers, strict=False))))
    for (_, p, y1, y2) in check(problem, [] if shape is None else [shape]):
        if len(numbers) == 4:
            w1, _, w2, _ = numbers
            pull = math.hypot(1, float(w1 * y1 + w2 * y2) / height / (w1 + w2))
            np.testing.assert_allclose(shape.tension, [-w1 * math.hypot(1, float(p)) / (w1 + w2), pull], rtol=1e-10)


PAIRS = [(1, 1, 3, 1), (1, 2, 3, 1), (1, 1, 1, 1), (1e-3, 5, 1, 0.2), (100, 0.1, 1, 2), (1, 30, 1, 1), (1, 1, 30, 1)]
HEIGHTS = [1e-4, 1 / 64, 0.1, 0.49, 1.49, 5.0]


@pytest.mark.parametrize("pair", PAIRS)
def test_all_figures_of_two_plummets(pair):
    args = named(pair)
    heights = two_links.two_plummets(**args)
    w1, l1, w2, l2 = pair
    for height in HEIGHTS:
        shapes = two_links.two_plummets_shapes(**args, height=height)
        check(Pair(*pair, height), shapes)
        check_standing(Pair(*pair, height, up=-1), two_links.standing_plummet, two_links.standing_plummet_shape)
        counts = [sum(shape.half_waves == waves for shape in shapes) for waves in (1, 2)]
        assert counts[0] == (height < heights[0])
        assert counts[1] in ((1, 3) if height < heights[1] else (0,))
        for shape in shapes:
            (d1, d2), (y1, y2), (t1, t2) = shape.inclination, shape.offset, shape.tension
            total = w1 + w2
            # tensions carry the weights and the centrifugal forces
            np.testing.assert_allclose(t1, math.hypot(w1, w1 * y1 / height) / total, rtol=1e-13)
            np.testing.assert_allclose(t2, math.hypot(total, (w1 * y1 + w2 * y2) / height) / total, rtol=1e-12)
            np.testing.assert_allclose(y2, l2 * math.sin(d2), rtol=1e-12)
            np.testing.assert_allclose(y1 - y2, l1 * math.sin(d1), rtol=1e-12)


@pytest.mark.parametrize(
    ("pair", "guess"),
    [((1, 2, 3, 1), (5.0, 0.2325)), ((1, 3, 5, 0.7), (37.64, 0.06318)), ((1, 4, 20, 3), (2.15, 0.29955))],
)
@pytest.mark.parametrize("below", [0, 1, 2, 5, 100, 1e5, 1e9])
def test_figures_next_to_a_fold_within_4_ulp(pair, guess, below):
    """`below`: steps of the height from the last one at which the fold's two figures exist."""
    value = lambda p, x: Pair(*pair, x).residual(p, (*exactly(*pair), x), mp.sqrt)  # noqa: E731
    fold = mp.findroot(lambda p, x: [value(p, x), mp.diff(lambda q: value(q, x), p)], guess)
    height = float(fold[1])
    height = (height if height < fold[1] else math.nextafter(height, 0)) - below * math.ulp(float(fold[1]))
    middle = mp.findroot(lambda p: mp.diff(lambda q: value(q, height), p), fold[0])
    gap = mp.sqrt((fold[1] - height) / fold[1])
    ends = [middle * (1 - 20 * gap), middle * (1 + 20 * gap)]
    exact = [
        mp.findroot(lambda p: value(p, height), sorted((end, middle)), solver="anderson", tol=1e-90, maxsteps=300)
        for end in ends
    ]
    shapes = two_links.two_plummets_shapes(**named(pair), height=height)
    assert [shape.half_waves for shape in shapes] == [1, 2, 2, 2]
    met = sorted(shapes[1:], key=lambda shape: abs(math.tan(shape.inclination[0]) - float(middle)))[:2]
    for shape, p in zip(sorted(met, key=lambda shape: shape.inclination[0]), exact, strict=True):
        y1, y2 = Pair(*pair, height).offsets(p)
        assert ulps(shape.inclination[0], mp.atan(p)) <= 4
        assert ulps(shape.offset, [y1, y2]) <= 4
    beyond = math.nextafter(float(fold[1]), 1) + 2 * math.ulp(float(fold[1]))
    assert len(two_links.two_plummets_shapes(**named(pair), height=beyond)) == 2


@pytest.mark.parametrize(
    "link", [(2.0, 1.0, 1.0), (1.0, 0.6, 0.35), (0.01, 1.0, 0.5), (5.0, 0.1, 2.0), (1.0, 1.0, 0.0)]
)
def test_all_figures_of_a_link_on_a_thread(link):
    for height in HEIGHTS:
        shapes = two_links.link_on_thread_shapes(*link, height)
        check(Pair(*link, height), shapes)
        check_standing(Pair(*link, height, up=-1), two_links.standing_link, two_links.standing_link_shape)
        for shape in shapes:
            thread, centroid, _ = link
            (d1, d2), (_, pin) = shape.inclination, shape.offset
            outward = (pin + centroid * math.sin(d1)) / height
            np.testing.assert_allclose(shape.tension, math.hypot(1, outward), rtol=1e-12)
            np.testing.assert_allclose(pin, thread * math.sin(d2), rtol=1e-12)


def test_a_link_without_inertia_stands_only_below_the_length_of_its_thread():
    rng = np.random.default_rng(12)
    for thread, centroid, gyration in 10.0 ** rng.uniform(-3, 3, (300, 3)):
        height = float(two_links.standing_link(thread, centroid, 0.0))
        assert height == pytest.approx(max(thread - centroid, 0.0), rel=1e-12, abs=0)
        assert (two_links.standing_link_shape(thread, centroid, 0.0, 1e-3 * thread) is None) == (height <= 1e-3 * thread)
        assert two_links.standing_link(thread, centroid, gyration) > height


@pytest.mark.parametrize("below", [1e-3, 1e-6, 1e-9, 1e-12, 1e-14])
def test_figures_next_to_where_they_leave_the_vertical(below):
    args = named((1, 1, 3, 1))
    for mode, x in enumerate((1.5, 0.5)):
        height = x * (1 - below)
        shapes = [s for s in two_links.two_plummets_shapes(**args, height=height) if s.half_waves == mode + 1]
        assert len(shapes) == 1
        problem = Pair(1, 1, 3, 1, height)
        numbers = exactly(*problem.numbers)
        value = lambda q: problem.residual(q, numbers, mp.sqrt) / q  # noqa: E731, B023
        first = shapes[0].offset[0] / height
        exact = mp.findroot(value, (first * 0.99, first * 1.01), solver="anderson", tol=1e-80, maxsteps=200)
        assert ulps(first, exact) <= 4


@pytest.mark.parametrize("height", [1e-12, 1e-50, 1e-100])
def test_figures_at_any_speed(height):
    args = named((1, 2, 3, 1))
    shapes = two_links.two_plummets_shapes(**args, height=height)
    assert [shape.half_waves for shape in shapes] == [1, 2, 2, 2]
    standing = two_links.standing_plummet_shape(standing_weight=1, rod=1, hung_weight=3, thread=2, height=height)
    assert standing is not None and standing.half_waves == 1
    standing = two_links.standing_link_shape(1.0, 0.6, 0.35, height)
    assert standing is not None and standing.half_waves == 1
    for shape in [*shapes, standing]:
        assert np.isfinite(shape.inclination).all() and np.isfinite(shape.offset).all()


def test_speeds_beyond_the_range_are_refused():
    with pytest.raises(ValueError, match="two_plummets_shapes: height must not be smaller .* got 1e-300"):
        two_links.two_plummets_shapes(**named((1, 2, 3, 1)), height=1e-300)
    with pytest.raises(ValueError, match="standing_link_shape: height must not be smaller .* got 1e-300"):
        two_links.standing_link_shape(1.0, 0.6, 0.35, 1e-300)


@pytest.mark.parametrize("exponent", [-300, -40, 40, 300])
def test_lengths_of_two_links_scale_exactly(exponent):
    f = 2.0**exponent
    heights, larger = (two_links.two_plummets(**named(pair)) for pair in ((1, 2, 3, 1), (f, 2 * f, 3 * f, f)))
    assert (heights * f).tolist() == larger.tolist()
    plain, other = two_links.link_on_thread(2.0, 1.0, 0.7), two_links.link_on_thread(2 * f, f, 0.7 * f)
    assert (plain * f).tolist() == other.tolist()
    assert two_links.standing_link(2.0, 1.0, 0.7) * f == two_links.standing_link(2 * f, f, 0.7 * f)
    plain = two_links.two_plummets_shapes(**named((1, 2, 3, 1)), height=0.1)
    other = two_links.two_plummets_shapes(**named((1, 2 * f, 3, f)), height=0.1 * f)
    for a, b in zip(plain, other, strict=True):
        assert a.inclination.tolist() == b.inclination.tolist() and (a.offset * f).tolist() == b.offset.tolist()
        assert a.tension.tolist() == b.tension.tolist()


# The hoop ------------------------------------------------------------------------------------------------------------


def test_standard_gravity_is_the_default():
    assert hoop.speed(2.0) == hoop.speed(2.0, 9.80665) and hoop.tension(2.0) == hoop.tension(2.0, 9.80665)


# Elliptic integrals and functions ------------------------------------------------------------------------------------

COMPLEMENTS = [1e-150, 1e-100, 1.9098631509497832e-75, 1e-30, 1e-9, 1e-3, 0.1, 0.5, 0.8, 0.999, 1 - 1e-12, 1.0]


@pytest.mark.parametrize("complementary", COMPLEMENTS)
def test_scipy_has_the_complete_integrals_as_the_page_says(complementary):
    with mp.workdps(350):
        kc = mp.mpf(complementary)
        K, D = mp.elliprf(0, kc**2, 1), mp.elliprd(0, kc**2, 1) / 3
        assert ulps(special.ellipkm1(complementary**2), K) * ULP <= 1e-15
        assert ulps(special.ellipe((1 - complementary) * (1 + complementary)), K - (1 - kc**2) * D) * ULP <= 2e-15


def test_scipy_has_no_jacobi_functions_near_modulus_1():
    """Else this package needs none."""
    for complementary, lost in [(1e-9, 0.1), (1e-5, 1e-9), (0.03, 1e-14)]:
        u = 1.5 * float(mp.ellipk(1 - mp.mpf(complementary) ** 2))
        sn, cn, dn = (float(value) for value, _ in jacobi(u, complementary)[1:4])
        own = elliptic.jacobi(u, complementary_modulus=complementary)
        theirs = special.ellipj(u, (1 - complementary) * (1 + complementary))
        assert abs(own.dn / dn - 1) <= 1e-13 and abs(theirs[2] / dn - 1) > lost


@pytest.mark.parametrize("modulus", [0.0, 1e-9, 0.3, 0.6, 0.9, 0.999999, 1 - 2**-53])
def test_the_argument_is_the_modulus(modulus):
    m = mp.mpf(modulus) ** 2
    f = elliptic.jacobi(1.3, modulus=modulus)
    exact = [mp.ellipfun(kind, mp.mpf(1.3), m=m) for kind in ("sn", "cn", "dn")]
    np.testing.assert_allclose(f[1:4], [float(each) for each in exact], rtol=3e-15)


def test_limits_of_the_modulus():
    u = np.array([-3.0, 0.0, 0.1, 2.0])
    f = elliptic.jacobi(u, modulus=1.0)
    assert np.array_equal(f, elliptic.jacobi(u, complementary_modulus=0.0))
    np.testing.assert_allclose(f.sn, np.tanh(u), rtol=1e-15 * 2)
    np.testing.assert_allclose([f.cn, f.dn], [1 / np.cosh(u)] * 2, rtol=4e-15)
    np.testing.assert_allclose(f.amplitude, np.arctan(np.sinh(u)), rtol=2e-15)
    np.testing.assert_allclose(f.epsilon, np.tanh(u), rtol=2e-15)
    f = elliptic.jacobi(u, modulus=0.0)
    assert np.array_equal(f, elliptic.jacobi(u, complementary_modulus=1.0))
    np.testing.assert_allclose(f.amplitude, u, rtol=1e-15)
    np.testing.assert_allclose([f.sn, f.cn], [np.sin(u), np.cos(u)], atol=1e-15 * 4)
    assert f.dn.tolist() == [1.0] * 4


@pytest.mark.parametrize("u", [1e15, -1e20, -1e50, 1e100, 1e308])
@pytest.mark.parametrize("moduli", [dict(modulus=0.0), dict(modulus=0.3), dict(modulus=0.85), dict(modulus=1.0)])
def test_jacobi_far_out(u, moduli):
    """Where no digit is left the functions are still those of some argument, and the amplitude grows as it must."""
    f = elliptic.jacobi(u, **moduli)
    k = moduli["modulus"]
    assert f.sn**2 + f.cn**2 == near(1, 1e-14) and f.dn**2 + k**2 * f.sn**2 == near(1, 1e-14)
    if k < 1:
        K, E = (float(each(mp.mpf(k) ** 2)) for each in (mp.ellipk, mp.ellipe))
        assert f.amplitude == near(u * (math.pi / 2 / K), 1e-14)
        assert f.epsilon == near(u * (E / K), 1e-14)
    else:
        assert (f.amplitude, f.epsilon) == (near(math.copysign(math.pi / 2, u), 1e-15), math.copysign(1, u))


# Shapes, numbers and refusals ----------------------------------------------------------------------------------------

# A number that every function can take for an argument of that name.
NUMBERS = {
    "length": 2.0, "height": 0.3, "radius": 0.1, "arm": 1.0, "distance": 1.2, "span": 1.0, "pin": 0.5, "rod": 1.0,
    "thread": 2.0, "half_length": 1.0, "x": 0.5, "weight_ratio": 0.5, "weight": 1.0, "stiffness": 2.0,
    "deflection": 1e-6, "centroid": 0.5, "radius_of_gyration": 0.3, "upper_thread": 1.0, "lower_thread": 1.0,
    "standing_weight": 1.0, "hung_weight": 3.0, "lower_weight": 1.0, "lower_centroid": 0.75,
    "lower_radius_of_gyration": 0.4, "upper_weight": 3.0, "upper_length": 0.25, "upper_centroid": 0.125,
    "upper_radius_of_gyration": 0.45, "bell_weight": 1.0, "bell_centroid": 0.2, "bell_radius_of_gyration": 0.5,
    "clapper_weight": 1.0, "clapper_centroid": 0.3, "clapper_radius_of_gyration": 0.1, "gravity": 9.0, "period": 9.0,
    "angular_speed": 1.0, "seconds_pendulum": 1.0, "speed": 1.0, "tension": 1.0,
}  # fmt: skip
SIGNATURES = [(attrgetter(name)(rc), form.signature.parameters) for name, form in table.FORMS.items()]
FORMS = [(function, {name: NUMBERS[name] for name in names}) for function, names in SIGNATURES]
SINGLE = [each for each in FORMS if each[0].__name__.endswith(("_shape", "_shapes"))]
OTHERS = [(elliptic.jacobi, {"u": 1.0, name: 0.5}) for name in ("modulus", "complementary_modulus")]
OTHERS += [each for each in FORMS if each[0] is plummet.carried_inclinations]
EACH = [each for each in FORMS if each not in (*SINGLE, *OTHERS)]
spaced = lambda text: text.replace("_", " ")  # noqa: E731
by_name = lambda value: getattr(value, "__name__", None)  # noqa: E731
TAIL = {"two_plummets": (2,), "two_plummets_from_the_middle": (2,), "link_on_thread": (2,), "jointed_links": (2,)}


def test_the_table():
    """Each row can be inspected and has its sections; each word of the vocabulary is an argument."""
    assert (len(EACH), len(SINGLE), len(OTHERS)) == (30, 5, 3)
    for name, form in table.FORMS.items():
        function = attrgetter(name)(rc)
        assert inspect.signature(function) == form.signature == inspect.signature(form.function)
        assert inspect.getfullargspec(function).kwonlydefaults == inspect.getfullargspec(form.function).kwonlydefaults
        for attribute in ("__module__", "__qualname__", "__annotations__"):
            assert getattr(function, attribute) == getattr(form.function, attribute)
        assert pickle.loads(pickle.dumps(function)) is function
        lines = function.__doc__.splitlines()
        assert {"Parameters", "Returns", "Raises", "Notes", "Examples"} <= set(lines)
        assert {"Accuracy:", "Cost:", "Source:"} <= set(function.__doc__.split())
        described = [line.split(" : ")[0] for line in lines if re.search(" : (array_like|float)", line)]
        assert described == list(form.signature.parameters)
    path = closed_forms.__path__
    modules = [importlib.import_module(f"revchain.closed_forms.{each.name}") for each in pkgutil.iter_modules(path)]
    owners = modules + [kind for module in modules for _, kind in inspect.getmembers(module, inspect.isclass)]
    functions = [function for owner in owners for _, function in inspect.getmembers(owner, inspect.isfunction)]
    arguments = {name for function in functions for name in inspect.signature(function).parameters}
    assert {*table.POSITIVE, *table.NOT_NEGATIVE, *table.ANY} <= arguments


def columns(result):
    return result if isinstance(result, tuple) else (result,)


@pytest.mark.parametrize(("function", "arguments"), EACH, ids=by_name)
def test_everything_broadcasts(function, arguments):
    tail = TAIL.get(function.__name__, ())
    plain = columns(function(**arguments))
    for column in plain:
        assert np.shape(column) == tail
        assert tail or np.isscalar(column)
    forms = [lambda v: np.array(v), lambda v: [v], lambda v: np.full((2, 3), v), lambda v: []]
    for (name, value), form in itertools.product(arguments.items(), forms):
        given_ = form(value)
        for column, one in zip(columns(function(**{**arguments, name: given_})), plain, strict=True):
            assert np.shape(column) == np.shape(given_) + tail
            assert np.array_equal(column, np.broadcast_to(one, np.shape(given_) + tail), equal_nan=True)
    if len(arguments) > 1:
        first, last = list(arguments)[0], list(arguments)[-1]
        grid = {**arguments, first: np.full((2, 1), arguments[first]), last: np.full(3, arguments[last])}
        for column in columns(function(**grid)):
            assert np.shape(column) == (2, 3, *tail)
        wrong = {**arguments, first: np.full(2, arguments[first]), last: np.full(3, arguments[last])}
        with pytest.raises(ValueError, match=rf"{function.__name__}.*{first}"):
            function(**wrong)


APART = (two_links.two_plummets_from_the_middle, two_links.pin_of_silent_clapper, two_links.joint_without_bending)


@pytest.mark.parametrize(("function", "arguments"), [each for each in EACH if each[0] not in APART], ids=by_name)
def test_whole_numbers_are_numbers(function, arguments):
    """The functions that accept equal numbers for all arguments."""
    whole = {name: 3 for name in arguments}
    for one, other in zip(columns(function(**whole)), columns(function(**{k: 3.0 for k in whole})), strict=True):
        assert np.array_equal(one, other, equal_nan=True)


SIGNED = {"x", "weight_ratio", "upper_centroid", "u"}
ZERO_ALLOWED = {*SIGNED, "modulus", "complementary_modulus"}
CASES = [(*each, name) for each in [*EACH, *SINGLE, *OTHERS] for name in each[1]]


@pytest.mark.parametrize(("function", "arguments", "name"), CASES, ids=by_name)
def test_refusals_name_the_place_and_the_parameter_and_the_value(function, arguments, name):
    bad = [NAN, INF, -INF, "x", None, 1j, True, object(), [1, "a"], [arguments[name], NAN]]
    bad += [] if name in ZERO_ALLOWED or name.endswith("radius_of_gyration") else [0.0]
    bad += [] if name in SIGNED else [-1.5]
    if {"modulus", "complementary_modulus"} & {name}:
        bad = [1.5 if value is None else value for value in bad]
    unclear = []
    for value in bad:
        with pytest.raises(ValueError) as refusal:
            function(**{**arguments, name: value})
        text = str(refusal.value)
        plain = value[-1] if isinstance(value, list) else value
        shown = f"{plain:g}" if isinstance(plain, float) else plain if isinstance(plain, str) else repr(plain)
        named = function.__name__ in text and spaced(name) in spaced(text)
        if not named or shown not in text and "must be a single number" not in text:
            unclear.append(text)
    assert not unclear


@pytest.mark.parametrize(("function", "arguments"), SINGLE, ids=by_name)
def test_a_figure_takes_single_numbers(function, arguments):
    for name, value in arguments.items():
        function(**{**arguments, name: np.array(value)})
        with pytest.raises(ValueError, match=name):
            function(**{**arguments, name: [value, value]})


@pytest.mark.parametrize("lengths", [(1.0, 1.0, 2.1), (1.0, 3.0, 1.9), (3.0, 1.0, 1.9), (1.0, 1e-9, 2.0)])
def test_threads_that_do_not_meet_are_refused(lengths):
    with pytest.raises(ValueError, match=r"held_plummet.*distance.*triangle"):
        plummet.held_plummet(*lengths, 0.3)


@pytest.mark.parametrize("moduli", [{}, dict(modulus=0.5, complementary_modulus=0.5)])
def test_exactly_one_modulus(moduli):
    with pytest.raises(ValueError, match="modulus"):
        elliptic.jacobi(0.1, **moduli)


def test_nothing_is_silently_not_a_number():
    tiny, huge = 5e-324, 1.7e308
    silent = []
    for function, arguments in [*EACH, *OTHERS]:
        for name, value in itertools.product(arguments, (tiny, huge)):
            try:
                result = function(**{**arguments, name: value})
            except ValueError:
                continue
            numbers = [np.asarray(column, dtype=float) for column in columns(result)]
            if any(np.isnan(each).any() for each in numbers):
                silent.append((function.__name__, name, value))
    assert not silent


def test_waves_on_a_rim():
    waves = hoop.wave_speeds([1.0, 2.5])
    assert waves.standing.tolist() == [0.0, 0.0] and waves.running.tolist() == [2.0, 5.0]


def test_the_pendulum_that_beats_seconds():
    """Section 1 (5), (6): 39.1396 inches; pi^2 of it is 386.292."""
    gravity = conical_pendulum.gravity(39.1396)
    assert gravity == pytest.approx(386.29237, abs=5e-6)
    assert conical_pendulum.period(39.1396, gravity) == pytest.approx(2.0, rel=4 * ULP)


@pytest.mark.parametrize("ratio", [-0.9, -0.5, -1e-3, -1e-12])
def test_a_float_next_to_the_middle_is_refused(ratio):
    with pytest.raises(ValueError, match=r"two_plummets_from_the_middle.*x"):
        two_links.two_plummets_from_the_middle(1.0, math.sqrt(-ratio) * (1 - 1e-9), ratio)


def test_a_pair_shape_is_a_result():
    shapes = two_links.two_plummets_shapes(**named((1, 2, 3, 1)), height=0.1)
    assert shapes[0] != shapes[1] and repr(shapes[0]).startswith("PairShape: 1 half wave\n")
    assert not shapes[0].inclination.flags.writeable


def test_numbers_with_units():
    pytest.importorskip("pint")
    given = dict(lower_weight="2 kN", lower_thread="50 cm", upper_weight="3 kN", upper_thread=["1 m", "1 ft"])
    plain = dict(lower_weight=2000, lower_thread=0.5, upper_weight=3000, upper_thread=[1, 0.3048])
    np.testing.assert_allclose(two_links.two_plummets(**given), two_links.two_plummets(**plain), rtol=4 * ULP)
    assert conical_pendulum.height(["60 rpm"], "981 Gal") == near(conical_pendulum.height([2 * math.pi], 9.81), 4 * ULP)
    with pytest.raises(ValueError, match='lower_weight must be a force .* got "2 kg"; give it as mass'):
        two_links.two_plummets(**{**plain, "lower_weight": "2 kg"})
    for call in (hoop.speed, lambda t: hoop.string_revolutions_per_second(1.0, t)):
        with pytest.raises(ValueError, match="tension must be a number without a unit .*the length of chain"):
            call("20 N")
