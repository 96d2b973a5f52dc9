# SPDX-License-Identifier: GPL-3.0-or-later
"""Claims of accuracy with a number, each against mpmath over the domain that its docstring states, edges included.

The list of all claims and of their tests is in docs/accuracy.md, "Claims and their tests".
"""

import inspect
import math
import re
from operator import attrgetter
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from exact import carried_tangents, exactly, heights_of, jacobi, pendulum, roots_of, stored_links
from point_masses import small_motions
from tier import by_tier

import revchain as rc
from revchain import elliptic, plummet

ULP = 2.0**-52
TINY, HUGE = mp.mpf(2) ** -1021, mp.mpf(2) ** 1023
SAMPLES = by_tier(50, 150)

pytestmark = pytest.mark.usefixtures("digits")


@pytest.fixture
def digits():
    with mp.workdps(60):
        yield


# Random data ---------------------------------------------------------------------------------------------------------


class Draw:
    """Random numbers of one test: the seed is the name of the claim."""

    def __init__(self, name):
        self.rng = np.random.default_rng(list(name.encode()))

    def uniform(self, low, high):
        return float(self.rng.uniform(low, high))

    def power(self, low, high):
        """Ten to a power between the two."""
        return 10.0 ** self.uniform(low, high)

    def near_one(self):
        """Next to 1 on either side: by 1/2 down to a rounding."""
        return 1 + float(self.rng.choice([-1, 1])) * 2.0 ** -self.uniform(1, 52)

    def lengths(self, count, spread=(0.3, 6, 40)):
        """Positive numbers about one scale from 1e-150 to 1e150; in one draw of three two of them nearly agree."""
        scale, decades = self.power(-150, 150), float(self.rng.choice(spread))
        numbers = [scale * self.power(-decades, decades) for _ in range(count)]
        if count > 1 and self.rng.random() < 1 / 3:
            one, other = self.rng.permutation(count)[:2]
            numbers[one] = numbers[other] * self.near_one()
        return numbers

    def anything(self, count):
        """Positive numbers from 1e-150 to 1e150, each by itself."""
        return [self.power(-150, 150) for _ in range(count)]

    def link(self, centroid):
        """A radius of gyration for a centroid: none, any."""
        return 0.0 if self.rng.random() < 0.2 else centroid * self.power(-8, 3)


def ulps(found, exact):
    """Error in ulp of the exact number; 0 where that is beyond the normal numbers."""
    if exact == 0:
        return 0.0 if found == 0 else math.inf
    return float(abs(mp.mpf(float(found)) - exact) / abs(exact) / ULP) if TINY < abs(exact) < HUGE else 0.0


class Worst:
    """The largest error over what is allowed, by name, and where it was; no number counts as infinite."""

    def __init__(self):
        self.found = {}

    def note(self, name, error, where=None):
        error = math.inf if math.isnan(error) else float(error)
        self.found[name] = max(self.found.get(name, (0.0, None)), (error, where), key=lambda each: each[0])

    def check(self):
        assert self.found
        assert max(error for error, _ in self.found.values()) <= 1, self.found


def off(found, exact):
    return abs(mp.mpf(float(found)) - exact)


def check_random(name, draw, found, exact, samples=SAMPLES):
    """All numbers that are found of random data. `exact` gives pairs of a number and the error allowed, in ulp."""
    given, worst = Draw(name), Worst()
    for _ in range(samples):
        arguments = draw(given)
        results = np.ravel(found(*arguments)).tolist()
        for result, (truth, allowed) in zip(results, exact(*exactly(*arguments)), strict=True):
            worst.note(name, ulps(result, truth) / float(allowed), arguments)
    worst.check()


# Closed forms --------------------------------------------------------------------------------------------------------


def within(allowed, *numbers):
    return [(number, allowed) for number in numbers]


def inclined(l, x):  # noqa: E741
    if x >= l:
        return within(3, mp.mpf(0), mp.mpf(0), l, mp.mpf(1))
    r = mp.sqrt((l - x) * (l + x))
    return within(3, mp.atan2(r, x), r, x, l / x)


def a_plummet(d):
    length, height = d.lengths(2)
    return (length, length / (1 + d.power(-15, 15))) if d.rng.random() < 0.6 else (length, height)


def a_link_on_a_thread(d):
    thread, centroid = d.lengths(2, (0.3, 6, 12))
    return thread, centroid, d.link(centroid)


def a_link(d):
    return a_link_on_a_thread(d)[1:]


def hung(a, h, k):
    return within(4, *roots_of(a + pendulum(h, k), a * k**2 / h))


def two_weights_and_lengths(d):
    (w1, w2), (l1, l2) = d.lengths(2, (0.3, 6)), d.lengths(2, (0.3, 6, 12))
    return w1, l1, w2, l2


def from_the_middle(d):
    half, share = d.power(-150, 150), d.uniform(-1, 1) * (1 if d.rng.random() < 0.5 else d.power(-12, 0))
    if d.rng.random() < 0.5:
        return half, half * share, d.power(-12, 12)
    ratio = -d.uniform(0, 1) * (1 if d.rng.random() < 0.5 else d.power(-12, 0))
    edge = math.sqrt(-ratio)
    return half, half * (edge + (1 - edge) * d.power(-12, 0) * 0.999 + 1e-15), ratio


def middle(a, x, mu):
    return within(4, *roots_of(2 * a, (a - x) * (a + x) / (1 + mu)))


def clock(c, h, k):
    l = pendulum(h, k)  # noqa: E741
    with mp.workdps(400):
        lost = 86400 * (1 - mp.sqrt(l / roots_of(c + l, c * k**2 / h)[0]))
    return within(8 * (1 + mp.sqrt(l / h) if abs(c / l - 1) < 0.1 else 1), lost)


def two_jointed(d):
    h1, a2, h2, k2 = d.lengths(4, (0.3, 3, 8))
    if d.rng.random() < 0.5:
        h2 = -h2
    w1, w2 = d.lengths(2, (0.3, 4))
    if h2 < 0 and w1 * a2 + w2 * h2 <= 0:
        w2 = -w1 * a2 / h2 * d.uniform(0.001, 0.999)
    return w1, h1, d.link(h1), w2, a2, h2, k2 if d.rng.random() < 0.8 else 0.0


def jointed(w1, h1, k1, w2, a2, h2, k2):
    l1, hung = pendulum(h1, k1), w1 * a2 + w2 * h2
    p = (w2 * (h2**2 + k2**2) + w1 * a2**2) / hung
    return within(3, *roots_of(l1 + p, l1 * p - a2 * h1 * w1 * a2 / hung))


def bell_and_clapper(d):
    h2, h1 = d.lengths(2, (0.3, 3))
    k2, k1 = d.link(h2), d.link(h1)
    w2, w1 = d.lengths(2, (0.3, 6))
    bell, clapper = h2 + k2 / h2 * k2, h1 + k1 / h1 * k1
    if bell <= clapper:
        factor = bell / clapper * d.uniform(0, 1) if d.rng.random() < 0.5 else bell / clapper * (1 - d.power(-9, -1))
        h1, k1 = h1 * factor, k1 * factor
    return w2, h2, k2, w1, h1, k1


def silent_pin(w2, h2, k2, w1, h1, k1):
    l1, l2 = pendulum(h1, k1), pendulum(h2, k2)
    w = w2 * h2 / w1
    return within(2 * (l1 + l2) / (l2 - l1), w * (l2 - l1) / (w + l1 - h1))


def jointed_rod(d):
    length = d.power(-150, 150)
    pin = d.uniform(1 / 6, 0.5) if d.rng.random() < 0.5 else 0.5 - d.power(-15, -0.5)
    return length, length * min(max(pin, 1 / 6 * (1 + 1e-14)), 0.5 * (1 - 1e-15))


def two(d):
    return d.anything(2)


def lengths(count):
    return lambda d: d.lengths(count)


# Random data, and the numbers they give with the errors allowed.
CLOSED_FORMS = {
    "conical_pendulum.angular_speed": (two, lambda x, g: within(2.1, mp.sqrt(g / x))),
    "conical_pendulum.period": (two, lambda x, g: within(2.1, 2 * mp.pi * mp.sqrt(x / g))),
    "conical_pendulum.revolutions_per_second": (two, lambda x, g: within(2.1, mp.sqrt(g / x) / (2 * mp.pi))),
    "conical_pendulum.height": (two, lambda n, g: within(2.1, g / n**2)),
    "conical_pendulum.height_from_period": (two, lambda t, g: within(2.1, g * (t / (2 * mp.pi)) ** 2)),
    "conical_pendulum.height_from_seconds_pendulum": (two, lambda x, t: within(2.1, x * t**2 / 4)),
    "conical_pendulum.gravity": (two, lambda x, t: within(2.1, x * (2 * mp.pi / t) ** 2)),
    "hoop.tension": (two, lambda v, g: within(3, v**2 / g)),
    "hoop.speed": (two, lambda t, g: within(3, mp.sqrt(g * t))),
    "hoop.string_revolutions_per_second": (
        lambda d: d.anything(3),
        lambda a, t, g: within(3, mp.sqrt(g * t) / (2 * a)),
    ),
    "plummet.inclined_pendulum": (a_plummet, inclined),
    "plummet.air_resistance": (two, lambda a, x: within(0.5 * (1 + 1e-15), a / x)),
    "plummet.whirling_thread": (lengths(3), lambda *sides: within(2, mp.sqrt(sum(side**2 for side in sides)))),
    "plummet.carried_response": (lengths(2), lambda l, x: within(1.1, x / (x - l) if x != l else mp.inf)),  # noqa: E741
    "two_links.two_plummets": (
        two_weights_and_lengths,
        lambda w1, l1, w2, l2: within(3, *roots_of(l1 + l2, l1 * l2 * w2 / (w1 + w2))),
    ),
    "two_links.two_plummets_from_the_middle": (from_the_middle, middle),
    "two_links.pendulum_length": (a_link, lambda h, k: within(1.5, pendulum(h, k))),
    "two_links.share_at_centre_of_oscillation": (a_link, lambda h, k: within(2, h / pendulum(h, k))),
    "two_links.link_on_thread": (a_link_on_a_thread, hung),
    "two_links.standing_link": (
        a_link_on_a_thread,
        lambda a, h, k: within(5, max(roots_of(a - pendulum(h, k), -a * k**2 / h))),
    ),
    "two_links.thread_of_standing_link": (
        a_link_on_a_thread,
        lambda x, h, k: within(3, x * (pendulum(h, k) + x) / (k**2 / h + x)),
    ),
    "two_links.standing_plummet": (
        two_weights_and_lengths,
        lambda w1, l1, w2, l2: within(4, max(roots_of(l2 - l1, -l1 * l2 * w2 / (w1 + w2)))),
    ),
    "two_links.seconds_lost_per_day": (a_link_on_a_thread, clock),
    "two_links.jointed_links": (two_jointed, jointed),
    "two_links.pin_of_silent_clapper": (bell_and_clapper, silent_pin),
    "two_links.spring_deflection": (lambda d: d.anything(2), lambda weight, stiffness: within(0.5, weight / stiffness)),
    "two_links.joint_without_bending": (jointed_rod, lambda l, p: within(2.5, (l / 2 - p) ** 2 / p)),  # noqa: E741
}


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_closed_forms(name):
    draw, exact = CLOSED_FORMS[name]
    function = attrgetter(name)(rc)
    names = inspect.signature(function).parameters
    check_random(name, draw, lambda *data: function(**dict(zip(names, data, strict=False))), exact)


def test_a_held_plummet():
    """Threads that make a triangle, thin ones too: depths and tensions that are differences."""
    d, worst = Draw("held_plummet"), Worst()
    for _ in range(2 * SAMPLES):
        scale, a = d.power(-100, 100), d.power(-6, 6)
        b = a * (d.power(-3, 3) if d.rng.random() < 0.6 else d.near_one())
        share = d.uniform(0, 1) if d.rng.random() < 0.5 else d.power(-12, 0)
        given = (a * scale, b * scale, (abs(a - b) + (a + b - abs(a - b)) * share) * scale, a * scale * d.power(-3, 3))
        u, l, c, x = exactly(*given)  # noqa: E741
        if not abs(u - l) < c < u + l:
            continue
        radius = mp.sqrt((u + l + c) * (u + l - c) * (u - l + c) * (l - u + c)) / (2 * c)
        half, along = c / 2, (u - l) * (u + l) / (2 * c)
        # each number, and the larger of the terms of its last difference
        exact = [
            (radius, 0),
            (half + along, half),
            (u / c * (x + half - along) / x, u / c * max(1, (half + abs(along)) / x)),
            (l / c * (half + along - x) / x, l / c * max(1, (half + abs(along)) / x)),
        ]
        if x >= half + along:  # the lower thread is slack
            depth = min(x, u)
            exact = [(mp.sqrt((u - depth) * (u + depth)), 0), (depth, 0), (u / depth, 0), (0, 0)]
        elif x <= along - half:
            exact = [(mp.sqrt((l - x) * (l + x)), 0), (c + x, 0), (0, 0), (l / x, 0)]
        held = plummet.held_plummet(*given)
        assert (held.upper_taut, held.lower_taut) == (exact[2][0] > 0, exact[3][0] > 0)
        for found, (number, term) in zip(held, exact, strict=False):
            if not number and not term:  # no pull on a slack thread, no radius where it hangs straight down
                assert found == 0
                continue
            allowed = 3 * ULP * abs(number) + mp.mpf(10) ** -29 * term
            worst.note("plummet", off(found, number) / allowed, given)
    worst.check()


def test_inclinations_of_a_carried_plummet():
    d, worst = Draw("carried_inclinations"), Worst()
    for _ in range(SAMPLES // 2):
        scale, share = d.power(-100, 100), d.power(-9, 0) if d.rng.random() < 0.5 else d.near_one()
        fold = abs(1 - share ** (2 / 3)) ** 1.5
        radius = d.power(-9, 3) if d.rng.random() < 0.5 or not fold else fold * d.near_one()
        given = (scale, scale * share, scale * radius)
        with mp.workdps(90):
            roots, turn = carried_tangents(*exactly(*given))
            found = [d for d in np.ravel(plummet.carried_inclinations(*given)) if not np.isnan(d)]
            meeting = 1 / mp.sqrt(1 + turn**2)
            for number, (f, t) in enumerate(zip(found, roots, strict=True)):
                inner = len(roots) == 3 and number < 2
                condition = abs(1 / (1 - (meeting * mp.sqrt(1 + t * t)) ** 3)) if inner else 1
                worst.note("inclination", ulps(f, mp.atan(t)) / 4 / max(1, condition), given)
    worst.check()


# Elliptic integrals and functions ------------------------------------------------------------------------------------


def moduli(d, least=-300):
    """Complementary moduli: any, tiny, next to 1."""
    kind = d.rng.integers(4)
    return [d.uniform(0, 1), d.power(least, 0), 1 - d.power(-16, -1), d.power(-16, 0)][kind]


def jacobi_within(u, kc):
    with mp.workdps(400):
        return [(f, 1e-15 / ULP * (1 + abs(u * df / f))) for f, df in jacobi(u, kc)]


def arguments_of_jacobi(d):
    kc = moduli(d, -150)
    quarter = float(mp.elliprf(0, mp.mpf(kc) ** 2, 1))
    kind = d.rng.integers(3)
    beside = quarter * float(d.rng.integers(1, 5)) * d.near_one()
    return [d.power(-100, 0), quarter * d.uniform(-9, 9), beside][kind], kc


def test_jacobi():
    check_random(
        "elliptic.jacobi", arguments_of_jacobi, lambda u, kc: elliptic.jacobi(u, complementary_modulus=kc), jacobi_within
    )


# Cords ----------------------------------------------------------------------------------------------------------------


def root_next_to(function, guess):
    """The root next to a number that is right to some 1e-13."""
    return mp.findroot(function, (guess, guess * (1 + mp.mpf(10) ** -14)), tol=mp.mpf(10) ** -70, verify=False)


def zero_of_bessel(order, number):
    """Zero of J of any order, next to the one that the library's heights give."""
    (height,) = rc.modes(rc.Cord(1.0, density=float(order)), 1, first=number).conical_height
    return root_next_to(lambda z: mp.besselj(mp.mpf(order), z), mp.mpf(2 * math.sqrt((order + 1) / height)))


def places(d):
    """Parts of a length: any, next to the free end, next to the support."""
    return d.uniform(0, 1), d.power(-20, 0), 1 - d.power(-16, 0)


def modes_up_to(d, most):
    return int(d.power(0, math.log10(most)))


@pytest.mark.parametrize(("size", "most"), [(1, 3e-29), (2000, 1e-24)])
def test_bounds_in_two_words(size, most):
    """`modes` with ``precision="double-double"``: how much is proved; that it holds is tested elsewhere."""
    found = rc.modes(rc.Chain.uniform_rods(size), count=min(size, 3), precision="double-double")
    assert found.error_bound.max() <= most


def test_speeds_of_a_tolerance():
    """`Modes.angular_speed` from the heights of a cheap method."""
    d = Draw("Modes.angular_speed")
    for _ in range(SAMPLES // 5):
        chain = rc.Chain(weight=d.lengths(3, (2,)), length=d.lengths(3, (2,)))
        solution = rc.modes(chain, rtol=d.power(-9, -1), gravity=d.power(-20, 20))
        for speed, height in zip(solution.angular_speed, solution.conical_height, strict=True):
            assert ulps(speed, mp.sqrt(mp.mpf(solution.gravity) / mp.mpf(float(height)))) <= 1


def check_places(worst, d, modes, exact, allowed):
    """Offset and slope of one mode against `exact` at shares of the length, of the largest of either."""
    length = modes.system.length
    grid = length * np.linspace(0, 1, 400)
    largest, steepest = (max(1.0 * first, np.abs(f(grid)).max()) for f, first in ((modes.along, 1), (modes.slope, 0)))
    for share in places(d):
        offset, slope = exact(mp.mpf(share * length) / mp.mpf(length))
        worst.note("offset", off(modes.along(share * length)[0], offset) / mp.mpf(largest) / allowed)
        worst.note("slope", off(modes.slope(share * length)[0], slope) / mp.mpf(steepest) / allowed)


def test_modes_of_a_uniform_cord():
    d, worst = Draw("heavy_chain"), Worst()

    for _ in range(40):
        length, mode = d.power(-150, 150), modes_up_to(d, 30_000)
        zero = zero_of_bessel(0, mode)
        gravity = d.power(-100, 100)
        found = rc.modes(rc.Cord(length), 1, first=mode, gravity=gravity)
        worst.note("conical_height", ulps(found.conical_height[0], 4 * mp.mpf(length) / zero**2) / 3)
        turning = mp.sqrt(mp.mpf(gravity) / mp.mpf(length)) / (2 * mp.pi)
        worst.note("frequency", ulps(found.frequency[0], turning * zero / 2) / 4)
        energy = (zero * mp.besselj(1, zero)) ** 2 / 8
        of_slope = (mp.mpf(length) * mp.mpf(float(found.slope(length)[0]))) ** 2 / 2  # over weight per length
        worst.note("kinetic energy", ulps(of_slope, energy) * ULP / 1e-15 / (1 + mode))
        if mode > 1:
            node = int(d.rng.integers(1, mode))
            there = found.nodes[0][node - 1]
            worst.note("nodes", ulps(there, mp.mpf(length) * (zero_of_bessel(0, node) / zero) ** 2) / 5)
            there = found.vertical_points[0][node - 1]
            worst.note("vertical_points", ulps(there, mp.mpf(length) * (zero_of_bessel(1, node) / zero) ** 2) / 5)
        for share in places(d):
            x = length * share
            z = zero * mp.sqrt(mp.mpf(x) / mp.mpf(length))
            worst.note("offset", off(found.along(x)[0], mp.besselj(0, z)) / 1e-15 / mode)
            slope = mp.mpf(float(found.slope(x)[0])) * mp.mpf(found.conical_height[0])
            worst.note("slope", abs(slope + 2 * mp.besselj(1, z) / z) / 1e-15 / mode)
    worst.check()


def test_modes_of_cords_that_taper():
    d, worst = Draw("tapered_chain"), Worst()

    for _ in range(40):
        length, mode = d.power(-150, 150), modes_up_to(d, 3000)
        p = [d.uniform(-0.99, 1), d.power(-1, 2), -0.99 + d.power(-6, -2)][d.rng.integers(3)]
        order, zero = mp.mpf(p), zero_of_bessel(p, mode)
        found = rc.modes(rc.Cord(length, density=p), 1, first=mode)
        worst.note("conical_height", ulps(found.conical_height[0], 4 * (order + 1) * mp.mpf(length) / zero**2) / 3)
        if mode > 1:
            node = int(d.rng.integers(1, mode))
            for name, of_node in (("nodes", p), ("vertical_points", p + 1)):
                there = getattr(found, name)[0][node - 1]
                worst.note(name, ulps(there, mp.mpf(length) * (zero_of_bessel(of_node, node) / zero) ** 2) / 3)

        def exact(share, order=order, zero=zero, length=length):
            z = zero * mp.sqrt(share)
            slope = -mp.hyp0f1(order + 2, -(z**2) / 4) * zero**2 / (4 * (order + 1) * mp.mpf(length))
            return mp.hyp0f1(order + 1, -(z**2) / 4), slope

        check_places(worst, d, found, exact, mp.mpf(1e-15) * (1 + zero))
    worst.check()


def tip_shape(m, height):
    """The same of a uniform chain with a weight of m lengths at its free end."""
    a = 2 * mp.sqrt(m / height)
    A, B = (mp.pi * a**2 / 4 * v for v in (-mp.bessely(2, a), mp.besselj(2, a)))

    def at(x):
        z = 2 * mp.sqrt((m + x) / height)
        offset = A * mp.besselj(0, z) + B * mp.bessely(0, z)
        return offset, -(A * mp.besselj(1, z) + B * mp.bessely(1, z)) * 2 / z

    return at


def test_modes_of_cords_with_a_tip():
    """Roots of Bessel functions in 300 digits take most of the time."""
    d, worst = Draw("tip_mass"), Worst()

    for turn in range(by_tier(4, 16)):
        length, mode = d.power(-140, 140), modes_up_to(d, 300)
        tip = length * [d.power(-12, 3), d.power(-3, 3), d.power(3, 12), d.power(12, 100)][turn % 4]
        where = (length, mode, tip)
        with mp.workdps(60 if tip < 1e12 * length else 300):
            L, m = mp.mpf(length), mp.mpf(tip) / mp.mpf(length)
            found = rc.modes(rc.Cord(length, weight=length, tip_weight=tip), 1, first=mode)
            cross = lambda y, m=m: tip_shape(m, y)(mp.mpf(1))[0]  # noqa: E731
            root = root_next_to(cross, mp.mpf(float(found.conical_height[0])) / L)
            worst.note("conical_height", ulps(found.conical_height[0], root * L) / 2, where)
            exact = tip_shape(m, root)
            scaled = lambda x, exact=exact, L=L, root=root: (exact(x)[0], exact(x)[1] / (root * L))  # noqa: E731
            check_places(worst, d, found, scaled, mp.mpf(2e-15) * mode)
            if mode > 1:
                index = d.rng.integers(0, mode - 1)
                for name, which in (("nodes", 0), ("vertical_points", 1)):
                    at = mp.mpf(float(getattr(found, name)[0][index])) / L
                    zero = root_next_to(lambda x: exact(x)[which], at)  # noqa: B023
                    worst.note(name, abs(zero - at) / 1e-15, where)
    worst.check()


def test_modes_of_cords_by_power_series():
    """A density given as a function against the same cord in closed form, in any unit."""
    d, worst = Draw("continuous_critical_heights"), Worst()
    for turn in range(40):
        length = d.power(-3, 3)
        if turn % 2:
            tip, p = length * d.power(-2, 2), 0.0
            given = {"weight": length, "tip_weight": tip}
        else:
            tip, p, given = 0.0, d.uniform(-0.9, 5), {}
        function = lambda s, p=p, length=length: (s / length) ** p if s > 0 or p == 0 else 0.0  # noqa: E731
        found = rc.modes(rc.Cord(length, density=function, **given), 5)
        closed = rc.modes(rc.Cord(length, density=p, **given), 5)
        assert found.method == "power series" != closed.method
        where, x = (length, tip, p), length * np.linspace(0, 1, 101)
        worst.note("heights", np.abs(found.conical_height / closed.conical_height - 1).max() / 4e-15, where)
        for name in ("along", "slope"):
            values, exact = getattr(found, name)(x), getattr(closed, name)(x)
            worst.note(name, (np.abs(values - exact).max(axis=1) / np.abs(exact).max(axis=1)).max() / 1e-14, where)
        for name in ("nodes", "vertical_points"):
            pairs = list(zip(getattr(found, name)[1:], getattr(closed, name)[1:], strict=True))
            worst.note(name, max(np.abs(a - b).max() for a, b in pairs) / length / 1e-15, where)
    worst.check()


def shot_from_the_free_end(offset, height, tip, steps=100):
    """Offset of the support, and the inclination there, of a chain of length and weight 1 with a heavy tip: Runge and
    Kutta, whose error is as small as the tip is heavy."""

    def slopes(s, y, moment):
        sine = moment / mp.hypot(moment, height * (tip + s))
        return -sine, y, sine

    y, moment, h, sine = offset, tip * offset, mp.mpf(1) / steps, mp.mpf(0)
    for i in range(steps):
        k1 = slopes(i * h, y, moment)
        k2 = slopes(i * h + h / 2, y + h / 2 * k1[0], moment + h / 2 * k1[1])
        k3 = slopes(i * h + h / 2, y + h / 2 * k2[0], moment + h / 2 * k2[1])
        k4 = slopes(i * h + h, y + h * k3[0], moment + h * k3[1])
        y += h / 6 * (k1[0] + 2 * k2[0] + 2 * k3[0] + k4[0])
        moment += h / 6 * (k1[1] + 2 * k2[1] + 2 * k3[1] + k4[1])
        sine = k4[2]
    return y, mp.asin(sine)


def test_heavy_tips_without_links():
    """`steady_shapes` of a `Cord`: what is within `error_bound` of the inclination of a point mass."""
    d, worst = Draw("continuous_shapes"), Worst()
    for _ in range(8):
        tip, height = d.power(6, 10), d.uniform(0.05, 0.95)
        shape = rc.steady_shapes(rc.Cord(1.0, weight=1.0, tip_weight=tip), conical_height=height)[0]
        with mp.workdps(30):
            t, x = exactly(tip, height)
            start = mp.sqrt(1 - x**2)
            offset = mp.findroot(lambda y: shot_from_the_free_end(y, x, t)[0], (start, start * 0.999999))  # noqa: B023
            inclination = shot_from_the_free_end(offset, x, t)[1]
            worst.note("inclination", off(shape.along(1.0).inclination, inclination) / shape.error_bound, (tip, height))
            worst.note("offset", off(shape.along(0.0).offset, offset) / shape.error_bound, (tip, height))
    worst.check()


# Wheels in a row, links made of others -------------------------------------------------------------------------------


def test_waves_of_a_gyrostatic_string():
    """Phases, speeds and rotations; where terms cancel as many times more is allowed as the docstring says."""
    d, worst = Draw("GyrostaticString"), Worst()

    for _ in range(3 * SAMPLES):
        a, W = d.power(-50, 50), d.power(-50, 50)
        given = dict(
            weight=W,
            length=a,
            tension=W * d.power(-3, 6),
            momentum=W * math.sqrt(a) * d.uniform(-1, 1) * (1 if d.rng.random() < 0.5 else d.power(-25, 0)),
            centroid=a * d.uniform(0, 1),
            radius_of_gyration=a * d.uniform(0, 1),
        )
        string = rc.GyrostaticString(**given)
        W, a, T, H, h, rho, g = exactly(*given.values(), 9.80665)
        X = W * (h * (a - h) - rho**2) / a**2
        terms_of_X = W * (abs(h * (a - h)) + rho**2) / a**2
        theta = d.power(-6, math.log10(math.pi)) if d.rng.random() < 0.7 else math.pi * (1 - d.power(-9, 0))
        t = mp.mpf(theta)
        s2 = 4 * mp.sin(t / 2) ** 2
        A, B, C = (W - X * s2) / g, s2 * H / a**2, s2 * T / a
        where = (given, theta)
        if A > 0:  # n^2 A - n B - C = 0
            cancelled = (W + terms_of_X * s2) / (A * g)
            q = (abs(B) + mp.sqrt(B**2 + 4 * A * C)) / 2
            forward, backward = (q / A, -C / q) if B >= 0 else (C / q, -q / A)
            found = string.angular_speeds(theta)
            worst.note("angular_speeds", ulps(found.forward, forward) / 4 / cancelled, where)
            worst.note("angular_speeds", ulps(found.backward, backward) / 4 / cancelled, where)

        def sine(n):
            """sin^2 of half the phase and how far its terms cancel."""
            k = (T + n * H / a) / a + n**2 / g * X
            return n**2 * W / g / (4 * k), (T / a + abs(n * H) / a**2 + n**2 / g * terms_of_X) / abs(k)

        n = float(mp.sqrt(g / a)) * d.power(-3, 2)
        ahead, back = sine(mp.mpf(n)), sine(-mp.mpf(n))
        condition = 1
        for sign, (s, cancelled) in ((1, ahead), (-1, back)):
            if not 0 < s < 1:
                continue
            condition = max(condition, cancelled / mp.sqrt(1 - s))
            error = ulps(string.phase(sign * n), 2 * mp.asin(mp.sqrt(s)))
            worst.note("phase", error / 4 / cancelled * mp.sqrt(1 - s), (given, n))
        turned = string.plane_rotation(n)
        if 0 < ahead[0] < 1 and 0 < back[0] < 1 and H:
            with mp.workdps(120):
                exact = mp.asin(mp.sqrt(sine(-mp.mpf(n))[0])) - mp.asin(mp.sqrt(sine(mp.mpf(n))[0]))
            worst.note("plane_rotation", ulps(turned, exact) / 8 / condition, (given, n))
    worst.check()


def test_links_of_a_tapered_chain():
    """Links of `Chain.tapered`, the lowest, the highest and some between: moments of the density."""
    d, worst = Draw("Chain.tapered"), Worst()

    for _ in range(SAMPLES // 4):
        count = modes_up_to(d, 100_000)
        length, weight = d.power(-100, 100), d.power(-100, 100)
        p = [d.uniform(-1, 1), d.power(-3, 2), d.power(-12, -3) - 1, d.power(2, 3)][d.rng.integers(4)]
        if (p + 1) * math.log10(count) > 180:
            continue
        chain = rc.Chain.tapered(count, length, weight, exponent=p)
        q = mp.mpf(p) + 1
        for m in {0, count - 1, *d.rng.integers(0, count, 3).tolist()}:
            low, high = mp.mpf(m) / count, mp.mpf(m + 1) / count
            share = high**q - low**q
            worst.note("weight", ulps(chain.weight[m], mp.mpf(weight) * share) / 0.51, (count, p, m))
            below = (high - q / (q + 1) * (high ** (q + 1) - low ** (q + 1)) / share) * count
            worst.note("centroid", ulps(chain.centroid[m], mp.mpf(chain.length[m]) * below) / 0.51, (count, p, m))
            mean, square = (q / (q + i) * (high ** (q + i) - low ** (q + i)) / share for i in (1, 2))
            radius = mp.sqrt(square - mean**2) * count * mp.mpf(chain.length[m])
            worst.note("radius", ulps(chain.radius_of_gyration[m], radius) / 1.01, (count, p, m))
    worst.check()


def joined(one, other):
    """One body of two (weight, depth of the centroid, rho^2) in the same link."""
    (w, h, r), (v, g, s) = one, other
    middle = (w * h + v * g) / (w + v)
    return w + v, middle, (w * (r + (h - middle) ** 2) + v * (s + (g - middle) ** 2)) / (w + v)


def test_heights_with_a_weight_at_a_pin():
    """`Chain.with_body`: of the exact body of link and weight."""
    d, worst = Draw("Chain.with_body"), Worst()
    for _ in range(SAMPLES // 3):
        n = int(d.rng.integers(1, 5))
        unit, force = d.power(-30, 30), d.power(-30, 30)
        length = [unit * d.power(-2, 2) for _ in range(n)]
        weight = [force * d.power(-4, 4) for _ in range(n)]
        centroid = [a * d.uniform(0.01, 1.2) for a in length]
        radius = [a * d.uniform(0, 0.6) for a in length]
        chain = rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=radius)
        pin, extra, rho = int(d.rng.integers(0, n)), force * d.power(-4, 4), unit * d.uniform(0, 1)
        data = zip(weight, length, centroid, radius, strict=True)
        links = [[w, a, h, k**2] for w, a, h, k in (exactly(*each) for each in data)]
        # the pin is the lower one of link `pin`
        w, a, h, r2 = links[pin]
        body = joined((w, h, r2), (mp.mpf(extra), a, mp.mpf(rho) ** 2))
        links[pin] = [body[0], a, body[1], body[2]]
        found = rc.modes(chain.with_body(weight=extra, pin=pin, radius_of_gyration=rho)).conical_height
        for f, e in zip(found, heights_of(links), strict=True):
            worst.note("heights", ulps(f, e) / 3, (weight, length, pin))
    worst.check()


def test_a_bell_and_its_clapper():
    """Heights and ratios of `bell_and_clapper`, the bell hung above and below its centroid."""
    d, worst = Draw("bell_and_clapper"), Worst()
    for _ in range(2 * SAMPLES):
        unit = d.power(-100, 100)
        a1, a2, h1 = (unit * d.power(-3, 3) for _ in range(3))
        w1, w2 = d.power(-50, 50), 0.0
        w2 = w1 * d.power(-4, 4)
        h2 = unit * d.power(-3, 3)
        if d.rng.random() < 0.4:  # hung below its centroid, up to where it would stand
            h2 = -w1 * a2 / w2 * [d.uniform(0, 1), 1 - d.power(-8, 0)][d.rng.integers(2)]
            if w1 * a2 + w2 * h2 <= 0:
                continue
        k1, k2 = d.link(h1), d.link(abs(h2))
        chain = rc.Chain(weight=[w1, w2], length=[a1, a2], centroid=[h1, h2], radius_of_gyration=[k1, k2])
        (W1, _, H1, R1), (W2, A2, H2, R2) = stored_links(chain)
        l1, f = H1 + R1 / H1, W2 / W1
        moment, turning = f * H2 + A2, f * (H2**2 + R2)
        slope = moment / A2 * l1 - turning / A2 - A2
        ratios = roots_of(slope / H1, -moment / H1)
        ratios = [max(ratios), min(ratios)]
        found = rc.bell_and_clapper(chain)
        for k, r in enumerate(ratios):
            for name, result, exact in (
                ("ratio", found.inclination_ratio[k], r),
                ("height", found.conical_height[k], l1 + A2 / r),
            ):
                worst.note(name, ulps(result, exact) / 2, (k, w1, w2, a2, h1, h2, k1, k2))
    worst.check()


def test_weights_on_a_thread():
    """`funicular_polygon` and `transverse_modes`."""
    d, worst = Draw("funicular_polygon"), Worst()

    for _ in range(SAMPLES // 2):
        n = int(d.rng.integers(1, 7))
        unit, force = d.power(-60, 60), d.power(-60, 60)
        weight = [force * d.power(-4, 4) for _ in range(n)]
        place = np.cumsum([unit * d.uniform(-1, 1), *(unit * d.power(-4, 4) for _ in range(n + 1))])
        if not (np.diff(place) > 0).all():
            continue
        pull, first, last = force * d.power(-3, 3), unit * d.uniform(-1, 1), unit * d.uniform(-1, 1)
        where = (weight, place.tolist(), pull, first, last)
        polygon = rc.funicular_polygon(weight, place, pull, first_height=first, last_height=last)
        W, x, H, z0, z1 = exactly(*weight), exactly(*place), *exactly(pull, first, last)
        span = x[-1] - x[0]
        rise = -(H * (z0 - z1) + sum(w * (x[-1] - at) for w, at in zip(W, x[1:-1], strict=True))) / span
        height, drop = z0, sum(W) * span / H
        for j in range(n + 1):
            rise += W[j - 1] if j else 0
            height += rise / H * (x[j + 1] - x[j])
            room = abs(height) * ULP / 2 * mp.mpf(1.001) + mp.mpf(10) ** -28 * (drop + abs(z0) + abs(z1))
            worst.note("height", off(polygon.height[j + 1], height) / room, where)
        modes = rc.transverse_modes(weight, place, pull)
        matrix, k = mp.matrix(n), [H / (b - a) for a, b in zip(x, x[1:], strict=False)]
        for j in range(n):
            matrix[j, j] = (k[j] + k[j + 1]) / W[j]
            if j:
                matrix[j, j - 1] = matrix[j - 1, j] = -k[j] / mp.sqrt(W[j] * W[j - 1])
        with mp.workdps(90):
            inverse = sorted(mp.eigsy(matrix, eigvals_only=True))
        for found, bound, e in zip(modes.conical_height, modes.error_bound, inverse, strict=True):
            worst.note("transverse", ulps(found, 1 / e) / 2, where)
            worst.note("bound", ulps(found, 1 / e) * ULP / bound, where)
    worst.check()


# Folds of branches ---------------------------------------------------------------------------------------------------


def test_folds():
    """`branch`: heights of folds of plummets, and their place by the inclination of the lowest thread."""
    d, count = Draw("folds"), 0
    while count < 10:
        size = int(d.rng.integers(2, 31))
        weight, length = ([d.power(-1, 1) for _ in range(size)] for _ in range(2))
        W, L = exactly(*weight), exactly(*length)

        def support(tangent, x, W=W, L=L):
            """Offset of the support for the tangent of the lowest thread."""
            y, load, whole = x * tangent, mp.mpf(0), mp.mpf(0)
            for w, l in zip(W, L, strict=True):  # noqa: E741
                load, whole = load + w * y, whole + w
                q = load / (x * whole)
                y -= l * q / mp.sqrt(1 + q * q)
            return y

        def fold_near(tangent, height, support=support):
            slope = lambda t, x: mp.diff(lambda p: support(p, x), t)  # noqa: E731
            with mp.workdps(40):
                return mp.findroot(lambda t, x: [support(t, x), slope(t, x)], (tangent, height), verify=False)

        chain, end = rc.Chain(weight=weight, length=length), 0.01 * sum(length)
        for mode in range(2, 1 + min(5, rc.count_modes(chain, conical_height=end * 1.01))):
            branch = rc.branch(chain, mode, min_conical_height=end)
            for at in branch.folds:
                height, inclination = float(branch.conical_height[at]), abs(branch.lowest_inclination[at])
                tangent, exact = fold_near(math.tan(inclination), height)
                assert ulps(height, exact) * ULP <= 1e-13, (weight, length, mode)
                assert inclination == pytest.approx(float(mp.atan(tangent)), abs=1e-6 * branch.arc[-1])
                count += 1


# Small disturbances of shapes ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("frame", ["free", "driven"])
def test_exponents_of_small_disturbances(frame):
    """`SteadyShape.stability`, where exponents are simple, of plummets and of rods."""
    d, compared = Draw(frame), 0
    while compared < 60:
        size, rods = int(d.rng.integers(1, 4)), bool(d.rng.integers(2))
        weight, length = (np.array([d.power(-1, 1) for _ in range(size)]) for _ in range(2))
        body = {"centroid": length / 2, "radius_of_gyration": length / 4} if rods else {}
        chain = rc.Chain(weight=weight, length=length, **body)
        for shape in rc.steady_shapes(chain, conical_height=rc.modes(chain).conical_height[0] * d.uniform(0.05, 0.95)):
            exact, _ = small_motions(rc.Rig(chain), shape, frame)
            largest = max(map(abs, exact))
            for value in shape.stability(frame=frame).exponents:
                near = sorted(abs(mp.mpc(complex(value)) - e) for e in exact)
                if len(near) > 1 and near[1] < largest / 100:
                    continue
                compared += 1
                assert near[0] <= 1e-13 * largest, (weight, length, shape)


# The list ------------------------------------------------------------------------------------------------------------


def test_every_test_of_the_list_exists(repository, claims):
    rows = claims["Tree"](repository).accuracy_rows
    assert len(rows) > 75
    missing = [first for first, tests in rows if not tests]
    missing += [test for _, tests in rows for test in tests if not claims["test_exists"](repository, test)]
    assert not missing


CLAIM = re.compile(r"\d ulp|\b(half )?an ulp|last digits?\b|\b[\d.]+e-1\d\b")


def test_every_docstring_with_a_number_is_in_the_list(repository, claims):
    tree = claims["Tree"](repository)
    listed = " ".join(first for first, _ in tree.accuracy_rows)
    found = [each for each in tree.sentences if each.file.startswith("src/") and each.name]
    assert len({each.file for each in found}) > 40
    absent = set()
    for each in found:
        module = Path(each.file).stem
        prefix = f"{module}." if module in dir(rc) and inspect.ismodule(getattr(rc, module)) else ""
        if CLAIM.search(each.text) and f"`{prefix}{each.name}`" not in listed:
            absent.add(prefix + each.name)
    assert not absent
