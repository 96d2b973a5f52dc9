# SPDX-License-Identifier: GPL-3.0-or-later
"""One plummet, two links, the hoop and elliptic functions: balance of forces and mpmath, from the docstrings alone."""

import itertools
import math

import mpmath as mp
import numpy as np
import pytest
from exact import jacobi
from hypothesis import given, settings
from hypothesis import strategies as st

from revchain import elliptic, hoop, plummet, two_links

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


def near(value, rel):
    """Within that of the value, however small."""
    return pytest.approx(value, rel=rel, abs=0)


def exactly(*numbers):
    return [mp.mpf(float(number)) for number in numbers]


# One plummet ---------------------------------------------------------------------------------------------------------


@given(ratios, st.one_of(st.floats(1e-9, 1 - 1e-9), st.floats(-52, -1).map(lambda e: 1 - 2.0**e)))
@settings(max_examples=60)
def test_an_inclined_plummet_balances_within_3_ulp(length, cosine):
    height = length * cosine
    l, h = exactly(length, height)  # noqa: E741
    swing = plummet.inclined_pendulum(length, height)
    if h >= l:
        assert swing == (0, 0, length, 1)
        return
    r = mp.sqrt(l**2 - h**2)
    # weight 1 and centrifugal force r / h along the thread
    assert ulps(swing, [mp.atan2(r, h), r, h, mp.hypot(1, r / h)]) <= 3


def test_a_slow_plummet_hangs_vertically():
    swing = plummet.inclined_pendulum([1.0, 2.0, 3.0], [1.0, 2.5, 1e300])
    assert swing.inclination.tolist() == swing.radius.tolist() == [0.0] * 3
    assert swing.depth.tolist() == [1.0, 2.0, 3.0] and swing.tension.tolist() == [1.0] * 3


def held(upper, lower, distance, height):
    """Radius, depth and tensions of the two threads over the weight, by moments about the two points of the axis."""
    u, l, d, h = exactly(upper, lower, distance, height)  # noqa: E741
    depth = (u**2 - l**2 + d**2) / (2 * d)
    radius = mp.sqrt(u**2 - depth**2)
    along_upper = (depth - d) * -radius / h + radius  # about the lower point, outward force r / h, weight 1
    along_lower = depth * radius / h - radius
    return [radius, depth, along_upper * u / (d * radius), along_lower * l / (d * radius)]


TRIANGLES = [
    (1.0, 1.0, 1.2),
    (3.0, 4.0, 5.0),
    (1.0, 2.0, 1.5),
    (5.0, 1.0, 5.5),
    (1.0, 1.0, 1e-6),
    (1.0, 1.0, 2 - 2**-40),
    (1.0, 2**-30, 1.0),
    (2.0, 1.0, 1 + 2**-40),
    (1.0, 2.0, 1 + 2**-40),
]


@pytest.mark.parametrize("triangle", TRIANGLES)
@pytest.mark.parametrize("height", [1e-6, 0.3, 1.1, 40.0, 1e6])
def test_forces_on_a_held_plummet_balance_within_3_ulp(triangle, height):
    found = plummet.held_plummet(*triangle, height)
    u, l, d, h = exactly(*triangle, height)  # noqa: E741
    upper, lower = exactly(*found[2:4])
    r, z, *_ = held(*triangle, height)  # exact: of the rounded depth, depth - distance may have no digit
    outward = [upper * r / u, lower * r / l, -r / h]
    upward = [upper * z / u, lower * (z - d) / l, -1]
    for forces in (outward, upward):
        assert abs(mp.fsum(forces)) <= 3 * ULP * max(map(abs, forces))
    exact = held(*triangle, height)
    assert bool(found.upper_taut) == (exact[2] >= 0) and bool(found.lower_taut) == (exact[3] >= 0)


@pytest.mark.parametrize("triangle", TRIANGLES)
def test_a_held_plummet_lies_where_the_threads_meet(triangle):
    found = plummet.held_plummet(*triangle, 0.3)
    radius, depth, *_ = held(*triangle, 0.3)
    assert ulps(found.radius, radius) <= 6
    assert abs(found.depth - depth) <= 6 * ULP * max(triangle[0], abs(depth))


@pytest.mark.parametrize("distance", [1e-9, 1e-20, 1e-100, 1e-150, 1e-200, 1e-300])
def test_two_equal_threads_from_nearly_one_point_reach_as_far_as_they_are_long(distance):
    found = plummet.held_plummet(1.0, 1.0, distance, 0.5)
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


@given(ratios, ratios, ratios)
@settings(max_examples=40)
def test_the_whirling_machine_is_in_balance(arm, height, radius):
    a, h, r = exactly(arm, height, radius)
    thread = mp.sqrt(a**2 + h**2 + r**2)  # from (0, a, h) to the plummet at (r, 0, 0), the weight along -z
    assert ulps(plummet.whirling_thread(arm, height, radius), thread) <= 2
    tension = thread / h  # its vertical part carries the weight; its part along the arm is the air's resistance
    assert ulps(plummet.air_resistance(arm, height), tension * a / thread) <= 0.5 * (1 + 1e-9)


@given(ratios, st.one_of(ratios, st.floats(-52, -1).map(lambda e: 1 + 2.0**e)))
@settings(max_examples=40)
def test_the_carried_response_within_1_1_ulp(length, ratio):
    height = length * ratio
    l, h = exactly(length, height)  # noqa: E741
    found = plummet.carried_response(length, height)
    if h == l:
        assert math.isinf(found)
    else:
        assert ulps(found, h / (h - l)) <= 1.1


def carried_roots(length, height, radius, cells=4000):
    """Roots of height tan d = radius + length sin d by a scan in tan d, each refined."""
    l, h, r = exactly(length, height, radius)  # noqa: E741
    value = lambda p: h * p - r - l * p / mp.sqrt(1 + p * p)  # noqa: E731
    bound = (length + radius) / height * 1.01
    grid = np.geomspace(1e-12 * min(1, radius / (height + length)), bound, cells)
    grid = np.concatenate([-grid[::-1], [0.0], grid])
    signs = np.sign(height * grid - radius - length * grid / np.hypot(1, grid))
    brackets = [(grid[i], grid[i + 1]) for i in np.flatnonzero(np.diff(signs) != 0)]
    return [mp.atan(mp.findroot(value, ends, solver="anderson", tol=1e-90, maxsteps=200)) for ends in brackets]


@pytest.mark.parametrize(
    ("length", "height", "radius"),
    [
        (1.0, 0.25, 0.1),
        (1.0, 0.25, 0.45),
        (1.0, 0.25, 0.6),
        (1.0, 2.0, 0.1),
        (1.0, 2.0, 30.0),
        (1.0, 1.0, 1e-6),
        (1.0, 0.999, 1e-9),
        (1.0, 0.950272226711884, 0.002397700354444707),
        (3.0, 1e-5, 2.99),
        (1e-3, 1e-9, 1e-12),
        (1e6, 3.0, 1e-3),
    ],
)
def test_all_inclinations_of_a_carried_plummet(length, height, radius):
    exact = carried_roots(length, height, radius, 2000)
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


@pytest.mark.parametrize("height", [1e-20, 1e-100, 1e-200, 1e-300, 1e-307])
def test_three_inclinations_at_any_speed(height):
    found = plummet.carried_inclinations(1.0, height, 0.1)
    np.testing.assert_allclose(found, [-math.pi / 2, -math.asin(0.1), math.pi / 2], rtol=4 * ULP)


@pytest.mark.parametrize("length", [1e100, 1e200, 1e300, 1e307])
def test_three_inclinations_of_any_thread(length):
    found = plummet.carried_inclinations(length, 0.25, 0.1)
    np.testing.assert_allclose(found, [-math.pi / 2, -0.1 / length, math.pi / 2], rtol=4 * ULP)


# Two links -----------------------------------------------------------------------------------------------------------


def roots_of(total, product):
    """Roots of x^2 - total x + product, the larger first."""
    root = mp.sqrt(total**2 / 4 - product)
    return [total / 2 + root, total / 2 - root]


def pendulum(centroid, gyration):
    h, k = exactly(centroid, gyration)
    return h + k**2 / h


@given(ratios, ratios, ratios, ratios)
@settings(max_examples=60)
def test_two_plummets_within_3_ulp(w1, l1, w2, l2):
    found = two_links.two_plummets(lower_weight=w1, lower_thread=l1, upper_weight=w2, upper_thread=l2)
    w1, l1, w2, l2 = exactly(w1, l1, w2, l2)
    assert ulps(found, roots_of(l1 + l2, l1 * l2 * w2 / (w1 + w2))) <= 3


@given(ratios, st.floats(-0.999, 0.999), ratios)
@settings(max_examples=40)
def test_two_plummets_from_the_middle_within_4_ulp(half, share, ratio):
    a, x, mu = exactly(half, half * share, ratio)
    found = two_links.two_plummets_from_the_middle(half, half * share, ratio)
    assert ulps(found, roots_of(2 * a, (a**2 - x**2) / (1 + mu))) <= 4


@pytest.mark.parametrize("ratio", [-0.9, -0.5, -1e-3, -1e-12])
@pytest.mark.parametrize("beyond", [1e-9, 1e-3, 0.9])
def test_a_float_within_4_ulp(ratio, beyond):
    edge = math.sqrt(-ratio)
    x = edge + beyond * (1 - edge)
    a, at, mu = exactly(1.0, x, ratio)
    found = two_links.two_plummets_from_the_middle(1.0, [x, -x], ratio)
    assert ulps(found[0], roots_of(2 * a, (a**2 - at**2) / (1 + mu))) <= 4
    assert ulps(found[1], roots_of(2 * a, (a**2 - at**2) / (1 + mu))) <= 4
    with pytest.raises(ValueError, match=r"two_plummets_from_the_middle.*x"):
        two_links.two_plummets_from_the_middle(1.0, edge * (1 - 1e-9), ratio)


def test_from_the_middle_agrees_with_the_threads():
    args = dict(lower_weight=1.5, lower_thread=1.25, upper_weight=3.0, upper_thread=0.75)
    # which thread is the longer is lost in x: heights do not depend on it
    np.testing.assert_allclose(
        two_links.two_plummets(**args), two_links.two_plummets_from_the_middle(1.0, 0.25, 0.5), rtol=7 * ULP
    )


@given(ratios, ratios, st.one_of(st.just(0.0), ratios))
@settings(max_examples=60)
def test_a_link_on_a_thread_within_4_ulp(thread, centroid, gyration):
    a, h, k = exactly(thread, centroid, gyration)
    l = pendulum(centroid, gyration)  # noqa: E741
    found = two_links.link_on_thread(thread, centroid, gyration)
    big = roots_of(a + l, a * k**2 / h)[0]
    exact = [big, a * k**2 / h / big]
    assert ulps(found, exact) <= 4
    assert found.tolist() == two_links.link_on_spring(thread, centroid, gyration).tolist()
    assert ulps(two_links.pendulum_length(centroid, gyration), l) <= 1.5
    assert ulps(two_links.share_at_centre_of_oscillation(centroid, gyration), h / l) <= 2


@given(ratios, ratios, st.one_of(st.just(0.0), ratios))
@settings(max_examples=60)
def test_a_standing_link_and_its_thread(thread, centroid, gyration):
    a, h, k = exactly(thread, centroid, gyration)
    l = pendulum(centroid, gyration)  # noqa: E741
    product = a * h
    found = two_links.standing_link(thread, centroid, gyration)
    # (l + x)(a - x) = a h: x^2 + (l - a) x - a (l - h) = 0
    exact = max(roots_of(a - l, product - a * l)) if k else max(a - l, mp.mpf(0))
    if k or a > l:
        assert ulps(found, exact) <= 5
    x = exactly(found)[0]
    if x > 0:
        # the inverse, of the height that was found: a = x (l + x) / (l + x - h)
        assert ulps(two_links.thread_of_standing_link(found, centroid, gyration), x * (l + x) / (l + x - h)) <= 3


@given(ratios, ratios, ratios)
@settings(max_examples=40)
def test_a_thread_is_found_again(height, centroid, gyration):
    thread = two_links.thread_of_standing_link(height, centroid, gyration)
    a, h, k = exactly(thread, centroid, gyration)
    l = pendulum(centroid, gyration)  # noqa: E741
    x = max(roots_of(a - l, -a * k**2 / h))
    assert ulps(two_links.standing_link(thread, centroid, gyration), x) <= 5


@given(ratios, ratios, ratios, ratios)
@settings(max_examples=60)
def test_a_standing_plummet_within_4_ulp(w1, rod, w2, thread):
    found = two_links.standing_plummet(standing_weight=w1, rod=rod, hung_weight=w2, thread=thread)
    w1, l1, w2, l2 = exactly(w1, rod, w2, thread)
    # a linear chain of two with the lower link's thrust: (l1 + x)(l2 - x) = w1 l1 l2 / (w1 + w2)
    assert ulps(found, max(roots_of(l2 - l1, -l1 * l2 * w2 / (w1 + w2)))) <= 4


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
        pair = two_links.two_plummets(lower_weight=w1, lower_thread=l1, upper_weight=w2, upper_thread=l2)
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
        pair = two_links.two_plummets(lower_weight=1, lower_thread=length, upper_weight=3, upper_thread=length)
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


def test_a_spring_moves_as_a_thread():
    assert two_links.spring_deflection(3.0, [6.0, 0.5]).tolist() == [0.5, 6.0]
    assert two_links.link_on_spring(0.25, 1.0, 0.0).tolist() == [1.25, 0.0]


# Figures at any inclination: one unknown, the tangent of the first link, scanned and refined --------------------------


class TwoPlummets:
    """The lower plummet out by y: tan 1 = y / height; then forces on the upper one and geometry."""

    def __init__(self, w1, l1, w2, l2, height):
        self.numbers = (w1, l1, w2, l2, height)
        self.reach = (l1 + l2) / height

    def residual(self, p, numbers, root):
        w1, l1, w2, l2, x = numbers
        y1 = x * p
        y2 = y1 - l1 * p / root(1 + p * p)
        q = (w1 * y1 + w2 * y2) / (x * (w1 + w2))
        return y2 - l2 * q / root(1 + q * q)

    def offsets(self, p):
        _, l1, _, _, x = exactly(*self.numbers)
        return [x * p, x * p - l1 * p / mp.sqrt(1 + p * p)]


class LinkOnThread(TwoPlummets):
    """Weight 1 at the centroid; moments about the lower pin give the offset of the centre of oscillation."""

    def __init__(self, thread, centroid, gyration, height):
        self.numbers = (thread, centroid, gyration, height)
        self.reach = (thread + float(pendulum(centroid, gyration))) / height

    def residual(self, p, numbers, root):
        a, h, k, x = numbers
        s = p / root(1 + p * p)
        pin = x * p - (h + k * k / h) * s
        q = (pin + h * s) / x
        return pin - a * q / root(1 + q * q)

    def offsets(self, p):
        _, h, k, x = exactly(*self.numbers)
        return [x * p, x * p - (h + k * k / h) * p / mp.sqrt(1 + p * p)]


class StandingLink(LinkOnThread):
    """The link up, leaning inwards by the inclination whose tangent is scanned."""

    def residual(self, p, numbers, root):
        a, h, k, x = numbers
        s = p / root(1 + p * p)
        pin = x * p + (h + k * k / h) * s
        q = (pin - h * s) / x
        return pin - a * q / root(1 + q * q)

    def offsets(self, p):
        _, h, k, x = exactly(*self.numbers)
        return [x * p, x * p + (h + k * k / h) * p / mp.sqrt(1 + p * p)]


class StandingPlummet(TwoPlummets):
    def residual(self, p, numbers, root):
        w1, l1, w2, l2, x = numbers
        y1 = x * p
        y2 = y1 + l1 * p / root(1 + p * p)
        q = (w1 * y1 + w2 * y2) / (x * (w1 + w2))
        return y2 - l2 * q / root(1 + q * q)

    def offsets(self, p):
        _, l1, _, _, x = exactly(*self.numbers)
        return [x * p, x * p + l1 * p / mp.sqrt(1 + p * p)]


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


PAIRS = [(1, 1, 3, 1), (1, 2, 3, 1), (1, 1, 1, 1), (1e-3, 5, 1, 0.2), (100, 0.1, 1, 2), (1, 30, 1, 1), (1, 1, 30, 1)]
HEIGHTS = [1e-4, 1 / 64, 0.1, 0.49, 1.49, 5.0]


@pytest.mark.parametrize("pair", PAIRS)
def test_all_figures_of_two_plummets(pair):
    names = ("lower_weight", "lower_thread", "upper_weight", "upper_thread")
    args = dict(zip(names, pair, strict=True))
    heights = two_links.two_plummets(**args)
    w1, l1, w2, l2 = pair
    for height in HEIGHTS:
        shapes = two_links.two_plummets_shapes(**args, height=height)
        check(TwoPlummets(*pair, height), shapes)
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
    names = ("lower_weight", "lower_thread", "upper_weight", "upper_thread")
    value = lambda p, x: TwoPlummets(*pair, x).residual(p, (*exactly(*pair), x), mp.sqrt)  # noqa: E731
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
    shapes = two_links.two_plummets_shapes(**dict(zip(names, pair, strict=True)), height=height)
    assert [shape.half_waves for shape in shapes] == [1, 2, 2, 2]
    met = sorted(shapes[1:], key=lambda shape: abs(math.tan(shape.inclination[0]) - float(middle)))[:2]
    for shape, p in zip(sorted(met, key=lambda shape: shape.inclination[0]), exact, strict=True):
        y1, y2 = TwoPlummets(*pair, height).offsets(p)
        assert ulps(shape.inclination[0], mp.atan(p)) <= 4
        assert ulps(shape.offset, [y1, y2]) <= 4
    beyond = math.nextafter(float(fold[1]), 1) + 2 * math.ulp(float(fold[1]))
    assert len(two_links.two_plummets_shapes(**dict(zip(names, pair, strict=True)), height=beyond)) == 2


@pytest.mark.parametrize(
    "link", [(2.0, 1.0, 1.0), (1.0, 0.6, 0.35), (0.01, 1.0, 0.5), (5.0, 0.1, 2.0), (1.0, 1.0, 0.0)]
)
def test_all_figures_of_a_link_on_a_thread(link):
    for height in HEIGHTS:
        shapes = two_links.link_on_thread_shapes(*link, height)
        check(LinkOnThread(*link, height), shapes)
        for shape in shapes:
            thread, centroid, _ = link
            (d1, d2), (_, pin) = shape.inclination, shape.offset
            outward = (pin + centroid * math.sin(d1)) / height
            np.testing.assert_allclose(shape.tension, math.hypot(1, outward), rtol=1e-12)
            np.testing.assert_allclose(pin, thread * math.sin(d2), rtol=1e-12)


@pytest.mark.parametrize("link", [(1.0, 0.6, 0.35), (2.0, 0.5, 0.5), (0.05, 1.0, 0.3), (30.0, 1.0, 1.0)])
@pytest.mark.parametrize("share", [1e-4, 0.5, 0.999, 1.001, 7.0])
def test_the_figure_of_a_standing_link(link, share):
    critical = float(two_links.standing_link(*link))
    height = critical * share
    shape = two_links.standing_link_shape(*link, height)
    assert (shape is None) == (share >= 1)
    found = [] if shape is None else [shape]
    check(StandingLink(*link, height), found)


@pytest.mark.parametrize("pair", [(1, 1, 3, 2), (1, 0.1, 1, 1), (5, 2, 1, 0.3), (1e-3, 1, 1, 1)])
@pytest.mark.parametrize("share", [1e-4, 0.5, 0.999, 1.001, 7.0])
def test_the_figure_of_a_standing_plummet(pair, share):
    args = dict(zip(("standing_weight", "rod", "hung_weight", "thread"), pair, strict=True))
    critical = float(two_links.standing_plummet(**args))
    height = critical * share
    shape = two_links.standing_plummet_shape(**args, height=height)
    assert (shape is None) == (share >= 1)
    check(StandingPlummet(*pair, height), [] if shape is None else [shape])
    if shape is not None:
        w1, l1, w2, l2 = pair
        (d1, d2), (y1, y2), (thrust, tension) = shape.inclination, shape.offset, shape.tension
        np.testing.assert_allclose(-thrust, w1 / math.cos(d1) / (w1 + w2), rtol=1e-10)
        np.testing.assert_allclose(tension, math.hypot(1, (w1 * y1 + w2 * y2) / height / (w1 + w2)), rtol=1e-12)
        np.testing.assert_allclose([y2, y2 - y1], [l2 * math.sin(d2), l1 * math.sin(d1)], rtol=1e-12)


@pytest.mark.parametrize("below", [1e-3, 1e-6, 1e-9, 1e-12, 1e-14])
def test_figures_next_to_where_they_leave_the_vertical(below):
    args = dict(lower_weight=1, lower_thread=1, upper_weight=3, upper_thread=1)
    for mode, x in enumerate((1.5, 0.5)):
        height = x * (1 - below)
        shapes = [s for s in two_links.two_plummets_shapes(**args, height=height) if s.half_waves == mode + 1]
        assert len(shapes) == 1
        problem = TwoPlummets(1, 1, 3, 1, height)
        numbers = exactly(*problem.numbers)
        value = lambda q: problem.residual(q, numbers, mp.sqrt) / q  # noqa: E731, B023
        first = shapes[0].offset[0] / height
        exact = mp.findroot(value, (first * 0.99, first * 1.01), solver="anderson", tol=1e-80, maxsteps=200)
        assert ulps(first, exact) <= 4


@pytest.mark.parametrize("height", [1e-12, 1e-50, 1e-100])
def test_figures_at_any_speed(height):
    args = dict(lower_weight=1, lower_thread=2, upper_weight=3, upper_thread=1)
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
        two_links.two_plummets_shapes(lower_weight=1, lower_thread=2, upper_weight=3, upper_thread=1, height=1e-300)
    with pytest.raises(ValueError, match="standing_link_shape: height must not be smaller .* got 1e-300"):
        two_links.standing_link_shape(1.0, 0.6, 0.35, 1e-300)


@pytest.mark.parametrize("exponent", [-300, -40, 40, 300])
def test_lengths_of_two_links_scale_exactly(exponent):
    f = 2.0**exponent
    heights = two_links.two_plummets(lower_weight=1, lower_thread=2, upper_weight=3, upper_thread=1)
    larger = two_links.two_plummets(lower_weight=f, lower_thread=2 * f, upper_weight=3 * f, upper_thread=f)
    assert (heights * f).tolist() == larger.tolist()
    plain, other = two_links.link_on_thread(2.0, 1.0, 0.7), two_links.link_on_thread(2 * f, f, 0.7 * f)
    assert (plain * f).tolist() == other.tolist()
    assert two_links.standing_link(2.0, 1.0, 0.7) * f == two_links.standing_link(2 * f, f, 0.7 * f)
    plain = two_links.two_plummets_shapes(lower_weight=1, lower_thread=2, upper_weight=3, upper_thread=1, height=0.1)
    other = two_links.two_plummets_shapes(
        lower_weight=1, lower_thread=2 * f, upper_weight=3, upper_thread=f, height=0.1 * f
    )
    for a, b in zip(plain, other, strict=True):
        assert a.inclination.tolist() == b.inclination.tolist() and (a.offset * f).tolist() == b.offset.tolist()
        assert a.tension.tolist() == b.tension.tolist()


# The hoop ------------------------------------------------------------------------------------------------------------


@given(ratios, ratios, ratios)
@settings(max_examples=40)
def test_the_hoop_within_3_ulp(speed, gravity, span):
    v, g, a = exactly(speed, gravity, span)
    tension = hoop.tension(speed, gravity)
    assert ulps(tension, v**2 / g) <= 3
    t = exactly(tension)[0]
    assert ulps(hoop.speed(tension, gravity), mp.sqrt(g * t)) <= 3
    assert ulps(hoop.string_revolutions_per_second(span, tension, gravity), mp.sqrt(g * t) / (2 * a)) <= 3


@pytest.mark.parametrize("exponent", [-140, 140])
def test_speed_and_tension_of_a_hoop_are_inverse_at_extremes(exponent):
    tension = 1.3 * 10.0**exponent
    assert hoop.tension(hoop.speed(tension)) == near(tension, rel=8 * ULP)


def test_standard_gravity_is_the_default():
    assert hoop.speed(2.0) == hoop.speed(2.0, 9.80665) and hoop.tension(2.0) == hoop.tension(2.0, 9.80665)


# Elliptic integrals and functions ------------------------------------------------------------------------------------

COMPLEMENTS = [1e-150, 1e-100, 1.9098631509497832e-75, 1e-30, 1e-9, 1e-3, 0.1, 0.5, 0.8, 0.999, 1 - 1e-12, 1.0]


def parameter(complementary):
    """m of a complementary modulus, digits enough for 1 - m."""
    return 1 - mp.mpf(complementary) ** 2


def legendre(amplitude, complementary):
    """F, E, D up to an amplitude by Carlson's forms of mpmath and whole half turns; complement given."""
    kc, phi = mp.mpf(complementary), mp.mpf(amplitude)
    turns = mp.nint(phi / mp.pi)
    rest = phi - turns * mp.pi
    s, c = mp.sin(rest), mp.cos(rest)
    y = c**2 + (kc * s) ** 2
    first, third = s * mp.elliprf(c**2, y, 1), s**3 / 3 * mp.elliprd(c**2, y, 1)
    if turns:
        whole, part = mp.elliprf(0, kc**2, 1), mp.elliprd(0, kc**2, 1) / 3
        first, third = first + 2 * turns * whole, third + 2 * turns * part
    return [first, first - (1 - kc**2) * third, third]


@pytest.mark.parametrize("complementary", COMPLEMENTS)
def test_complete_integrals_within_1e_15(complementary):
    with mp.workdps(350):
        kc = mp.mpf(complementary)
        m = 1 - kc**2
        K, D = mp.elliprf(0, kc**2, 1), mp.elliprd(0, kc**2, 1) / 3
        exact = [K, K - m * D, D, K - D]
        found = elliptic.complete(complementary_modulus=complementary)
        assert ulps(found, exact) * ULP <= 1e-15


@pytest.mark.parametrize("modulus", [0.0, 1e-9, 0.3, 0.6, 0.9, 0.999999, 1 - 2**-53])
def test_the_argument_is_the_modulus(modulus):
    found = elliptic.complete(modulus=modulus)
    m = mp.mpf(modulus) ** 2
    assert ulps(found[:2], [mp.ellipk(m), mp.ellipe(m)]) * ULP <= 3e-16
    assert found.D + found.B == near(found.K, rel=2 * ULP)
    assert ulps(elliptic.complete_pi(-0.7, modulus=modulus), mp.ellippi(-mp.mpf(0.7), m)) * ULP <= 1e-15
    exact = [mp.ellipf(mp.mpf(1.1), m), mp.ellipe(mp.mpf(1.1), m)]
    assert ulps(elliptic.incomplete(1.1, modulus=modulus)[:2], exact) * ULP <= 2e-15
    f = elliptic.jacobi(1.3, modulus=modulus)
    exact = [mp.ellipfun(kind, mp.mpf(1.3), m=m) for kind in ("sn", "cn", "dn")]
    np.testing.assert_allclose(f[1:4], [float(each) for each in exact], rtol=3e-15)


def test_limits_of_the_modulus():
    straight, round_ = elliptic.complete(modulus=[1.0, 0.0]), elliptic.complete(complementary_modulus=[0.0, 1.0])
    for one, other in zip(straight, round_, strict=True):
        assert one.tolist() == other.tolist()
    assert straight.K.tolist() == [INF, math.pi / 2] and straight.E.tolist() == [1.0, math.pi / 2]
    assert straight.D.tolist() == [INF, math.pi / 4] and straight.B.tolist() == [1.0, math.pi / 4]
    assert elliptic.complete_pi([-2.0, 0.0, 0.5], modulus=1.0).tolist() == [INF] * 3
    u = np.array([-3.0, 0.0, 0.1, 2.0])
    f = elliptic.jacobi(u, modulus=1.0)
    np.testing.assert_allclose(f.sn, np.tanh(u), rtol=1e-15 * 2)
    np.testing.assert_allclose([f.cn, f.dn], [1 / np.cosh(u)] * 2, rtol=4e-15)
    np.testing.assert_allclose(f.amplitude, np.arctan(np.sinh(u)), rtol=2e-15)
    np.testing.assert_allclose(f.epsilon, np.tanh(u), rtol=2e-15)
    f = elliptic.jacobi(u, modulus=0.0)
    np.testing.assert_allclose(f.amplitude, u, rtol=1e-15)
    np.testing.assert_allclose([f.sn, f.cn], [np.sin(u), np.cos(u)], atol=1e-15 * 4)
    assert f.dn.tolist() == [1.0] * 4


@pytest.mark.parametrize("complementary", COMPLEMENTS)
@pytest.mark.parametrize("characteristic", [-1e12, -30.0, -1e-9, 0.0, 1e-9, 0.3, 0.999, 1 - 2**-50])
def test_complete_integral_of_the_third_kind_within_1e_15(characteristic, complementary):
    with mp.workdps(50):
        n, kc = mp.mpf(characteristic), mp.mpf(complementary)
        exact = mp.elliprf(0, kc**2, 1) + n / 3 * mp.elliprj(0, kc**2, 1, 1 - n)
        assert ulps(elliptic.complete_pi(characteristic, complementary_modulus=complementary), exact) * ULP <= 1e-15


AMPLITUDES = [1e-100, 1e-9, 0.7, 1.5, math.pi / 2, 1.6, math.pi, -2.0, 100.0, 1e6]


@pytest.mark.parametrize("complementary", [1e-150, 1e-9, 1e-3, 0.5, 0.999, 1.0])
def test_incomplete_integrals_within_2e_15(complementary):
    found = elliptic.incomplete(AMPLITUDES, complementary_modulus=complementary)
    worst = {}
    with mp.workdps(330):
        for i, amplitude in enumerate(AMPLITUDES):
            for name, f, e in zip("FED", found, legendre(amplitude, complementary), strict=True):
                error = ulps(f[i], e) * ULP
                if error > 2e-15 and abs(e) > 1e-300:
                    worst[name, amplitude] = error
    assert not worst


@pytest.mark.parametrize("complementary", [1e-150, 1e-3, 0.5, 1.0])
@pytest.mark.parametrize("characteristic", [-1e6, -0.5, 0.0, 0.5, 1 - 1e-9])
def test_incomplete_integral_of_the_third_kind_within_3e_15(characteristic, complementary):
    found = elliptic.incomplete_pi(characteristic, AMPLITUDES, complementary_modulus=complementary)
    worst = {}
    n, kc = mp.mpf(characteristic), mp.mpf(complementary)
    with mp.workdps(50):
        for f, amplitude in zip(found, AMPLITUDES, strict=True):
            phi = mp.mpf(amplitude)
            turns = mp.nint(phi / mp.pi)
            rest = phi - turns * mp.pi
            s, c = mp.sin(rest), mp.cos(rest)
            y = c**2 + (kc * s) ** 2
            exact = s * mp.elliprf(c**2, y, 1) + n * s**3 / 3 * mp.elliprj(c**2, y, 1, 1 - n * s**2)
            if turns:
                exact += 2 * turns * (mp.elliprf(0, kc**2, 1) + n / 3 * mp.elliprj(0, kc**2, 1, 1 - n))
            error = ulps(f, exact) * ULP
            if error > 3e-15:
                worst[amplitude] = error
    assert not worst


def test_the_reference_agrees_with_mpmath():
    m = mp.mpf(0.36)
    found = jacobi(2.3, mp.sqrt(1 - m))
    for (value, _), kind in zip(found[1:4], ("sn", "cn", "dn"), strict=True):
        assert abs(value - mp.ellipfun(kind, mp.mpf(2.3), m=m)) < 1e-50
    assert abs(found[4][0] - mp.ellipe(found[0][0], m)) < 1e-50


@pytest.mark.parametrize("complementary", [1e-150, 1e-30, 1e-9, 1e-3, 0.1, 0.5, 0.9, 1 - 1e-12, 1.0])
def test_jacobi_functions_within_1e_15(complementary):
    K = float(elliptic.complete(complementary_modulus=complementary).K)
    times = [0.0, 1e-100, 1e-9, 0.3, -0.7, *(K * np.array([0.25, 0.5, 0.999, 1.0, 1.3, 2.0, 3.1, 57.0])), 1e6]
    found = elliptic.jacobi(times, complementary_modulus=complementary)
    worst = {}
    with mp.workdps(400):
        for i, u in enumerate(times):
            for name, column, (f, df) in zip(found._fields, found, jacobi(u, complementary), strict=True):
                bound = mp.mpf(1e-15) * (abs(f) + abs(u * df))
                error = abs(mp.mpf(float(column[i])) - f)
                if error > bound:
                    worst[name, u] = float(error / bound)
    assert not worst


@given(st.floats(-50, 50), st.floats(0, 1))
@settings(max_examples=40)
def test_identities_of_jacobi_functions(u, modulus):
    f = elliptic.jacobi(u, modulus=modulus)
    slack = 4e-15 * (1 + abs(u))
    assert abs(f.sn**2 + f.cn**2 - 1) <= slack and abs(f.dn**2 + (modulus * f.sn) ** 2 - 1) <= slack
    assert abs(math.sin(f.amplitude) - f.sn) <= slack and abs(math.cos(f.amplitude) - f.cn) <= slack
    opposite = elliptic.jacobi(-u, modulus=modulus)
    assert opposite == (-f.amplitude, -f.sn, f.cn, f.dn, -f.epsilon)


@given(st.floats(-7, 7), st.floats(0.0, 0.999999))
@settings(max_examples=40)
def test_amplitude_inverts_the_first_integral(u, modulus):
    f = elliptic.jacobi(u, modulus=modulus)
    integral = elliptic.incomplete(f.amplitude, modulus=modulus)
    # d F = d amplitude / dn; dn is at least the complementary modulus
    slack = 1e-14 * (1 + abs(u)) / float(elliptic.jacobi(u, modulus=modulus).dn)
    assert integral.F == pytest.approx(u, abs=slack) and integral.E == pytest.approx(f.epsilon, abs=slack)


@pytest.mark.parametrize("u", [1e15, -1e20, -1e50, 1e100, 1e308])
@pytest.mark.parametrize("moduli", [dict(modulus=0.0), dict(modulus=0.3), dict(modulus=0.85), dict(modulus=1.0)])
def test_jacobi_far_out(u, moduli):
    """Where no digit is left the functions are still those of some argument, and the amplitude grows as it must."""
    f = elliptic.jacobi(u, **moduli)
    k = moduli["modulus"]
    assert f.sn**2 + f.cn**2 == near(1, 1e-14) and f.dn**2 + k**2 * f.sn**2 == near(1, 1e-14)
    whole = elliptic.complete(**moduli)
    if k < 1:
        assert f.amplitude == near(u * (math.pi / 2 / whole.K), 1e-14)
        assert f.epsilon == near(u * (whole.E / whole.K), 1e-14)
    else:
        assert (f.amplitude, f.epsilon) == (near(math.copysign(math.pi / 2, u), 1e-15), math.copysign(1, u))


# Shapes, numbers and refusals ----------------------------------------------------------------------------------------

EACH = [
    (plummet.inclined_pendulum, dict(length=2.0, height=1.0)),
    (plummet.held_plummet, dict(upper_thread=1.0, lower_thread=1.0, distance=1.2, height=0.3)),
    (plummet.whirling_thread, dict(arm=1.0, height=1.0, radius=0.1)),
    (plummet.carried_response, dict(length=1.0, height=3.0)),
    (plummet.air_resistance, dict(arm=1.0, height=3.0)),
    (two_links.two_plummets, dict(lower_weight=1.0, lower_thread=1.0, upper_weight=3.0, upper_thread=1.0)),
    (two_links.two_plummets_from_the_middle, dict(half_length=1.0, x=0.5, weight_ratio=0.5)),
    (two_links.link_on_thread, dict(thread=1.0, centroid=0.5, radius_of_gyration=0.3)),
    (two_links.link_on_spring, dict(deflection=1.0, centroid=0.5, radius_of_gyration=0.3)),
    (two_links.pendulum_length, dict(centroid=0.5, radius_of_gyration=0.3)),
    (two_links.share_at_centre_of_oscillation, dict(centroid=0.5, radius_of_gyration=0.3)),
    (two_links.seconds_lost_per_day, dict(deflection=1e-6, centroid=0.5, radius_of_gyration=0.3)),
    (two_links.spring_deflection, dict(weight=1.0, stiffness=2.0)),
    (two_links.standing_link, dict(thread=1.0, centroid=0.5, radius_of_gyration=0.3)),
    (two_links.standing_plummet, dict(standing_weight=1.0, rod=1.0, hung_weight=3.0, thread=2.0)),
    (two_links.swung_link, dict(centroid=0.5, radius_of_gyration=0.3, height=0.3)),
    (two_links.thread_of_standing_link, dict(height=1.0, centroid=0.5, radius_of_gyration=0.3)),
    (hoop.speed, dict(tension=1.0, gravity=9.0)),
    (hoop.tension, dict(speed=1.0, gravity=9.0)),
    (hoop.string_revolutions_per_second, dict(span=1.0, tension=1.0, gravity=9.0)),
    (elliptic.complete, dict(modulus=0.5)),
    (elliptic.complete, dict(complementary_modulus=0.5)),
    (elliptic.complete_pi, dict(characteristic=0.3, modulus=0.5)),
    (elliptic.incomplete, dict(amplitude=1.0, modulus=0.5)),
    (elliptic.incomplete_pi, dict(characteristic=0.3, amplitude=1.0, complementary_modulus=0.5)),
]
SINGLE = [
    (two_links.two_plummets_shapes, dict(lower_weight=1, lower_thread=1, upper_weight=3, upper_thread=1, height=0.1)),
    (two_links.link_on_thread_shapes, dict(thread=1.0, centroid=0.5, radius_of_gyration=0.3, height=0.1)),
    (two_links.standing_link_shape, dict(thread=1.0, centroid=0.5, radius_of_gyration=0.3, height=0.3)),
    (two_links.standing_plummet_shape, dict(standing_weight=1, rod=1, hung_weight=3, thread=2, height=0.9)),
]
spaced = lambda text: text.replace("_", " ")  # noqa: E731
by_name = lambda value: getattr(value, "__name__", None)  # noqa: E731
TAIL = {"two_plummets": (2,), "two_plummets_from_the_middle": (2,), "link_on_thread": (2,), "link_on_spring": (2,)}


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


@pytest.mark.parametrize(("function", "arguments"), EACH[:6], ids=by_name)
def test_whole_numbers_are_numbers(function, arguments):
    whole = {name: 3 for name in arguments}
    for one, other in zip(columns(function(**whole)), columns(function(**{k: 3.0 for k in whole})), strict=True):
        assert np.array_equal(one, other, equal_nan=True)


ZERO_ALLOWED = {"x", "weight_ratio", "radius_of_gyration", "characteristic", "amplitude", "modulus"}
ZERO_ALLOWED |= {"complementary_modulus", "u"}
SIGNED = {"x", "weight_ratio", "characteristic", "amplitude", "u"}
OTHERS = [
    (elliptic.jacobi, dict(u=1.0, modulus=0.5)),
    (plummet.carried_inclinations, dict(length=1.0, height=0.25, radius=0.1)),
]
CASES = [(*each, name) for each in [*EACH, *SINGLE, *OTHERS] for name in each[1]]


@pytest.mark.parametrize(("function", "arguments", "name"), CASES, ids=by_name)
def test_refusals_name_the_place_and_the_parameter_and_the_value(function, arguments, name):
    bad = [NAN, INF, -INF, "x", None, 1j, True, object(), [1, "a"]]
    bad += [] if name in ZERO_ALLOWED else [0.0]
    bad += [] if name in SIGNED else [-1.5]
    if {"modulus", "complementary_modulus"} & {name}:
        bad = [1.5 if value is None else value for value in bad]
    unclear = []
    for value in bad:
        if name == "characteristic" and value == -INF:
            continue
        with pytest.raises(ValueError) as refusal:
            function(**{**arguments, name: value})
        text = str(refusal.value)
        shown = f"{value:g}" if isinstance(value, float) else repr(value)
        if function.__name__ not in text or spaced(name) not in spaced(text) or shown not in text:
            unclear.append(text)
    assert not unclear


@pytest.mark.parametrize(("function", "arguments", "name"), CASES, ids=by_name)
def test_one_bad_number_among_good_ones_is_refused(function, arguments, name):
    with pytest.raises(ValueError, match=name.replace("_", "[_ ]")):
        function(**{**arguments, name: [arguments[name], NAN]})


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


@pytest.mark.parametrize("function", [elliptic.complete, lambda **k: elliptic.complete_pi(0.1, **k)])
@pytest.mark.parametrize("moduli", [{}, dict(modulus=0.5, complementary_modulus=0.5)])
def test_exactly_one_modulus(function, moduli):
    with pytest.raises(ValueError, match="modulus"):
        function(**moduli)


@pytest.mark.parametrize("characteristic", [1.0, 1.5, NAN, INF])
def test_characteristics_beyond_the_principal_value_are_refused(characteristic):
    for function in (elliptic.complete_pi, lambda n, **k: elliptic.incomplete_pi(n, 0.3, **k)):
        with pytest.raises(ValueError, match="characteristic"):
            function(characteristic, modulus=0.5)


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
    with pytest.raises(ValueError, match=r"hoop\.wave_speeds: speed must be positive"):
        hoop.wave_speeds(-1.0)
