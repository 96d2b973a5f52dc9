# SPDX-License-Identifier: GPL-3.0-or-later
"""Ask for an accuracy, get the cheapest model that has it: what is promised, held against mechanics worked out anew.

Written from the documentation alone. References are in support/hanging_links.py (counts of an assembled pencil in 60
digits, dense matrices in other coordinates, finite equations by Newton's method) and in mpmath's Bessel and Laguerre
functions. Errors are relative to the exact height, as the bounds are.
"""

from __future__ import annotations

import csv
import json
import math
import os
import signal
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from decimal import Decimal
from pathlib import Path

import mpmath as mp
import numpy as np
import pytest
from hanging_links import Hanging, bodies, dense_heights, inclined_chain, inclined_height, plummets, rods, wide

import revchain as rc
from revchain.__main__ import main

TOLERANCES = [1.0, 0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-6, 1e-8, 1e-10, 1e-12, 1e-13, 1e-14, 3e-15, 1e-15]
NAMES = [
    "closed forms",
    "conical pendulum",
    "Laguerre asymptotics",
    "continuous chain",
    "tapered chain",
    "coarse chain",
    "single precision",
    "aberth",
    "interpolated",
    "condensed",
    "double-double",
    "finite amplitude",
    "bisection",
    "dense",
]
REPOSITORY = Path(__file__).resolve().parents[2]


# ---- scenes, with the exact numbers beside them


def random_scene(rng, most=120):
    """A chain, and its links in decimals, of a random kind."""
    size = int(np.exp(rng.uniform(0, np.log(most))))
    kind = rng.integers(9)
    length = np.exp(rng.normal(0, 1, size)) * 10.0 ** rng.integers(-6, 7)
    weight = np.exp(rng.normal(0, 2, size))
    if kind == 0:
        chain = rc.Chain.uniform_plummets(size, length=float(length[0]), weight=float(weight[0]))
        return chain, plummets(chain.weight, chain.length)
    if kind == 1:
        chain = rc.Chain.uniform_rods(size, length=float(length[0]), weight=float(weight[0]))
        return chain, rods(chain.weight, chain.length)
    if kind == 2:
        return rc.Chain(weight=weight, length=length), plummets(weight, length)
    if kind in (3, 4):  # over twelve decades, growing upward or downward
        weight = np.logspace(0, 12, size)[:: 1 if kind == 3 else -1].copy()
        return rc.Chain(weight=weight, length=length), plummets(weight, length)
    if kind == 5:  # threads between plummets
        weight[1:][rng.random(size - 1) < 0.4] = 0.0
        return rc.Chain(weight=weight, length=length), plummets(weight, length)
    if kind == 6:
        length = np.full(size, length[0])
        return rc.Chain(weight=weight, length=length), plummets(weight, length)
    # Bodies: centroids above the upper pin and beyond the lower one; still hanging.
    below = np.concatenate([[0.0], np.cumsum(weight)[:-1]])
    centroid = rng.uniform(-0.4, 1.4, size) * length if kind == 7 else 0.5 * length
    bad = weight * centroid + length * below <= 0.05 * weight * length
    centroid[bad] = 0.5 * length[bad]
    gyration = np.abs(rng.normal(0, 0.4, size)) * length * (rng.random(size) < rng.choice([0.5, 1.0]))
    chain = rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=gyration)
    return chain, bodies(weight, length, centroid, gyration)


class Truth:
    """Exact heights of one scene, each found once."""

    def __init__(self, chain, links, digits=60, known_to=30):
        self.chain, self.pencil, self._known, self._known_to = chain, Hanging(links, digits=digits), {}, known_to

    def height(self, mode):
        if mode not in self._known:
            near = rc.modes(self.chain, 1, first=mode).conical_height[0]  # proved or dropped by counts
            self._known[mode] = self.pencil.height(mode, near=near, digits=self._known_to)
        return self._known[mode]


def errors(solution, truth):
    """Of each height, relative to the exact one."""
    low = solution.conical_height_low
    context, found = wide(50), []
    for i, height in enumerate(solution.conical_height):
        exact = truth.height(solution.first + i) if hasattr(truth, "height") else truth[i]
        given = context.add(Decimal(float(height)), Decimal(0 if low is None else float(low[i])))
        found.append(float(context.divide(abs(context.subtract(given, exact)), exact)))
    return np.array(found)


def keeps_its_word(solution, truth, count, rtol):
    """Everything that an answer promises; returns the sentence that is broken, or nothing."""
    heights, bounds = solution.conical_height, solution.error_bound
    if solution.status not in ("success", "tolerance_not_met"):
        return f"status {solution.status!r}"
    if len(heights) != len(bounds):
        return "as many bounds as heights"
    if solution.status == "success":
        if len(heights) != count:
            return f"{len(heights)} heights of {count}"
        if rtol and not bounds.max() <= rtol:
            return f"success with a bound of {bounds.max()} at rtol {rtol}"
    if len(heights) == 0:
        return None
    if not (np.all(heights > 0) and np.all(np.diff(heights) <= 0) and np.all(bounds >= 0)):
        return f"heights {heights}, bounds {bounds}"
    wrong = errors(solution, truth)
    if np.any(wrong > bounds * (1 + 1e-9)):
        return f"errors {wrong} beyond bounds {bounds}"
    return None


def told(chain, solution, rtol, what):
    size, kind = len(chain), "plummets" if np.all(chain.centroid == chain.length) else "bodies"
    return f"{what} [{size} {kind}, modes {solution.first}+{len(solution)}, rtol {rtol}, {solution.model}]"


# ---- the references themselves


def test_the_references_agree_with_one_another():
    rng = np.random.default_rng(1)
    for _ in range(4):
        size = 6
        links = bodies(*(rng.uniform(0.3, 2, size) for _ in range(4)))
        pencil = Hanging(links)
        with mp.workdps(50):
            for mode, height in enumerate(dense_heights(links), start=1):
                assert abs(mp.mpf(str(pencil.height(mode))) / height - 1) < mp.mpf("1e-28")
    # Zeros of the Laguerre polynomial of degree 7; the continuous chain, 4 L / j^2, which equal rods approach as 1/N^2.
    with mp.workdps(40):
        starts, _ = np.polynomial.laguerre.laggauss(7)
        roots = [mp.findroot(lambda t: mp.laguerre(7, 0, t), float(start)) for start in starts]
        pencil = Hanging(plummets([1.0] * 7, [1.0] * 7))
        for mode, root in enumerate(sorted(roots), start=1):
            assert abs(mp.mpf(str(pencil.height(mode))) * root - 1) < mp.mpf("1e-28")
        pencil = Hanging(rods([1.0] * 1024, [1.0] * 1024))
        limit = 4 * 1024 / mp.besseljzero(0, 1) ** 2
        assert abs(mp.mpf(str(pencil.height(1, digits=14))) / limit - 1) < 1 / mp.mpf(1024) ** 2
    with mp.workdps(40):
        assert abs(inclined_height(plummets([1.0], [2.0]), 1, 0.5) - 2 * mp.cos(mp.mpf(0.5))) < 1e-30


# ---- random scenes by every tolerance


def test_no_bound_is_violated_on_random_scenes():
    rng = np.random.default_rng(7)
    broken, answers = [], 0
    for _ in range(2000):
        chain, links = random_scene(rng)
        truth = Truth(chain, links, known_to=21)
        first = int(rng.integers(1, chain.mode_count + 1)) if rng.random() < 0.4 else 1
        count = int(min(rng.integers(1, 6), chain.mode_count - first + 1))
        for rtol in TOLERANCES + [None]:
            solution = rc.solve(chain, count, first=first, rtol=rtol)
            answers += 1
            what = keeps_its_word(solution, truth, count, rtol)
            if what is None and (solution.first != first or (solution.status != "success")):
                what = f"first {solution.first}, {solution.status}, bounds {solution.error_bound}"
            if what:
                broken.append(told(chain, solution, rtol, what))
    assert not broken, f"{len(broken)} of {answers}:\n" + "\n".join(broken[:10])


def test_all_modes_of_a_chain_keep_every_tolerance():
    rng = np.random.default_rng(8)
    broken = []
    for _ in range(25):
        chain, links = random_scene(rng, most=60)
        truth = Truth(chain, links)
        for rtol in (1.0, 1e-3, 1e-9, 1e-14, None):
            solution = rc.solve(chain, chain.mode_count, rtol=rtol)
            what = keeps_its_word(solution, truth, chain.mode_count, rtol)
            if what or solution.status != "success":
                broken.append(told(chain, solution, rtol, what or solution.status))
    assert not broken, "\n".join(broken[:10])


# ---- every model by name


def test_every_model_documented_can_be_named():
    chain = rc.Chain(weight=[1.0, 2.0, 3.0], length=1.0)
    for name in NAMES:
        solution = rc.solve(chain, model=name)
        assert solution.model == name
        assert solution.status in ("success", "tolerance_not_met")


def test_the_documentation_has_a_row_for_every_model():
    rows = rc.explain(rc.Chain(weight=[1.0, 2.0, 3.0], length=1.0)).rows
    assert sorted(row.name for row in rows) == sorted(NAMES)
    page = (REPOSITORY / "docs" / "models.md").read_text()
    table = [line.split("|")[1].strip() for line in page.split("## The models")[1].splitlines() if line.startswith("|")]
    assert [name for name in NAMES if name not in table] == []


def test_models_by_name_keep_their_bounds_where_they_apply_and_say_nothing_where_not():
    rng = np.random.default_rng(9)
    broken, asked = [], dict.fromkeys(NAMES, 0)
    scenes = [random_scene(rng, most=60) for _ in range(140)]
    for size in (300, 400):
        weight, length = rng.uniform(1, 2, size), rng.uniform(1, 2, size)
        scenes.append((rc.Chain(weight=weight, length=length), plummets(weight, length)))
    for chain, links in scenes:
        truth = Truth(chain, links)
        first = 1 if rng.random() < 0.7 or len(chain) >= 256 else int(rng.integers(1, chain.mode_count + 1))
        count = int(min(rng.integers(1, 12), chain.mode_count - first + 1))
        for rtol in (0.3, 1e-3, 1e-10, None, 1e-22):
            for row in rc.explain(chain, count, first=first, rtol=rtol).rows:
                solution = rc.solve(chain, count, first=first, rtol=rtol, model=row.name)
                what = keeps_its_word(solution, truth, count, rtol)
                if row.applies and len(solution):
                    asked[row.name] = asked.get(row.name, 0) + 1
                if not row.applies and (len(solution) or solution.status != "tolerance_not_met" or not row.reason):
                    what = f"does not apply ({row.reason!r}), yet {solution.status}, {len(solution)} heights"
                if row.applies and row.reason:
                    what = f"applies, and a reason {row.reason!r}"
                if solution.model != row.name:
                    what = f"{row.name} was asked"
                if what:
                    broken.append(told(chain, solution, rtol, what))
    assert not broken, f"{len(broken)}:\n" + "\n".join(broken[:10])
    assert {name for name, times in asked.items() if not times} == {"conical pendulum", "tapered chain", "finite amplitude"}


def test_the_status_of_a_model_asked_by_name_is_what_its_bounds_say():
    rng = np.random.default_rng(18)
    broken, answers = {}, 0
    for _ in range(200):
        chain, _ = random_scene(rng, most=60)
        count = int(min(rng.integers(1, 4), chain.mode_count))
        for rtol in (0.1, 1e-3, 1e-8, 1e-13):
            for row in rc.explain(chain, count, rtol=rtol).rows:
                solution = rc.solve(chain, count, rtol=rtol, model=row.name)
                if len(solution):
                    answers += 1
                    kept = len(solution) == count and solution.error_bound.max() <= rtol
                    if kept != (solution.status == "success"):
                        broken.setdefault(row.name, []).append((rtol, solution.status, solution.error_bound))
    assert answers > 1000
    assert not broken, {name: (len(cases), cases[:2]) for name, cases in broken.items()}


def test_formulas_that_apply_have_an_answer():
    # Nothing is iterated: what is foreseen is known. Solvers may find that they cannot, and another one is asked.
    rng = np.random.default_rng(19)
    formulas, broken = ("closed forms", "Laguerre asymptotics", "continuous chain"), []
    for _ in range(600):
        chain, _ = random_scene(rng, most=10)
        count = int(rng.integers(1, chain.mode_count + 1))
        for row in rc.explain(chain, count, rtol=0.1).rows:
            if row.name in formulas and row.applies and row.error_bound <= 0.1:
                solution = rc.solve(chain, count, rtol=0.1, model=row.name)
                if solution.status != "success" or solution.error_bound.max() > row.error_bound * (1 + 1e-9):
                    broken.append(f"{row}: {solution}, {chain.weight}, {chain.length}, {chain.centroid}")
    assert not broken, f"{len(broken)}:\n" + "\n".join(broken[:3])


@pytest.mark.parametrize("exponent", [-0.98, -0.5, 0.0, 0.3, 1.0, 2.0, 10.0, 100.0])
def test_tapered_chains_against_their_own_links_and_the_cord(exponent):
    broken, asked, answered = [], 0, 0
    for size in (2, 3, 9, 40, 300):
        chain = rc.Chain.tapered(size, 1.7, exponent=exponent)
        # Radii are given back rounded to double: an error of u in each moves no height by more than 2 u.
        links = bodies(chain.weight, chain.length, chain.centroid, chain.radius_of_gyration)
        truth = Truth(chain, links, digits=90)
        for first, count in ((1, 1), (1, min(4, size)), (max(1, size // 3), 1)):
            for rtol in (1.0, 1e-2, 1e-4, 1e-7, 1e-10, 1e-13, None):
                for model in (None, "tapered chain"):
                    asked += 1
                    solution = rc.solve(chain, count, first=first, rtol=rtol, model=model)
                    if model is None and solution.status != "success":
                        broken.append(told(chain, solution, rtol, solution.status))
                    if len(solution):
                        answered += solution.model == "tapered chain"
                        wrong = errors(solution, truth)
                        if np.any(wrong > solution.error_bound * (1 + 1e-9) + 2.3e-16):
                            broken.append(told(chain, solution, rtol, f"{wrong} beyond {solution.error_bound}"))
    assert not broken, "\n".join(broken[:10])
    assert answered > 0.25 * asked or exponent == 0  # which is the continuous chain's


def test_equal_plummets_are_laguerre_zeros_and_rods_bessel_zeros():
    with mp.workdps(40):
        for size in (1000, 100_000):
            for rtol in (1.0, 1e-2, 1e-4, 1e-8, 1e-12, 1e-15):
                solution = rc.solve(rc.Chain.uniform_plummets(size, length=float(size)), 2, rtol=rtol)
                for mode in (1, 2):
                    # Tricomi: x = j^2/(4 n + 2) (1 + (j^2 - 2)/(3 (4 n + 2)^2) ...), here by Newton on 1F1(-n; 1; x).
                    j = mp.besseljzero(0, mode)
                    x = mp.findroot(lambda t: mp.hyp1f1(-size, 1, t), j**2 / (4 * size + 2), tol=1e-50)  # noqa: B023
                    error = abs(mp.mpf(float(solution.conical_height[mode - 1])) * x - 1)
                    assert error <= solution.error_bound[mode - 1] <= rtol, (size, rtol, mode, solution)
        for rtol in (1.0, 1e-2, 1e-8):
            solution = rc.solve(rc.Chain.uniform_rods(100_000, length=100_000.0), 3, rtol=rtol)
            for mode in (1, 2, 3):
                j = mp.besseljzero(0, mode)
                # The limit, less j^2 I/(24 J^2 N^2), I and J as docs/models.md writes them with p = 0.
                lost = j**2 * mp.quad(lambda t: mp.besselj(2, t) ** 2 / t, [0, j]) / (24 * mp.besselj(1, j) ** 2)
                exact = 4e5 / j**2 / (1 + lost / mp.mpf(10) ** 10)
                error = abs(mp.mpf(float(solution.conical_height[mode - 1])) / exact - 1)
                assert error <= solution.error_bound[mode - 1] + 1e-17 <= rtol, (rtol, mode, solution)


def test_formulas_at_every_mode_of_short_chains():
    broken, answered = [], 0
    for size in (*range(1, 25), 40, 70):
        for chain, build in (
            (rc.Chain.uniform_plummets(size), plummets),
            (rc.Chain.uniform_rods(size), rods),
        ):
            truth = Truth(chain, build(chain.weight, chain.length))
            for mode in range(1, size + 1):
                for name in ("Laguerre asymptotics", "continuous chain", "closed forms"):
                    solution = rc.solve(chain, 1, first=mode, rtol=0.999, model=name)
                    answered += len(solution)
                    what = keeps_its_word(solution, truth, 1, 0.999)
                    if what:
                        broken.append(told(chain, solution, 0.999, what))
    assert answered > 600
    assert not broken, f"{len(broken)}:\n" + "\n".join(broken[:10])


@pytest.mark.parametrize("kind", ["plummets", "rods", "random", "upward", "downward"])
def test_a_hundred_thousand_links(kind):
    size, rng = 100_000, np.random.default_rng(11)
    length = np.full(size, 2.0**-16)
    weight = np.full(size, 2.0**-10)
    if kind == "random":
        length, weight = rng.uniform(0.5, 1.5, size), rng.uniform(0.5, 1.5, size)
    elif kind in ("upward", "downward"):
        weight = np.logspace(0, 12, size)[:: 1 if kind == "upward" else -1].copy()
    if kind == "rods":
        chain = rc.Chain.uniform_rods(size, length=size * 2.0**-16, weight=size * 2.0**-10)
        assert chain.length[0] == length[0]
        pencil = Hanging(rods(weight, length))
    else:
        chain, pencil = rc.Chain(weight=weight, length=length), Hanging(plummets(weight, length))
    known = {}
    for rtol in (0.1, 1e-4, 1e-12, None):
        solution = rc.solve(chain, rtol=rtol)
        assert solution.status == "success"
        assert solution.error_bound.max() <= (rtol or 4.5e-16)
        key = (float(solution.conical_height[0]), float(solution.error_bound[0]))
        if key not in known:
            known[key] = pencil.lies_within(1, *key)
        assert known[key], solution


# ---- extremes


@pytest.mark.parametrize("scale", [1e-150, 1e-77, 1.0, 1e77, 1e150])
def test_units_of_length_and_weight_make_no_difference(scale):
    weight, length = [1.0, 3.0, 2.0, 5.0], [1.0, 0.5, 2.0, 0.25]
    for heavy in (1.0, 1e-150, 1e150):
        w, a = [x * heavy for x in weight], [x * scale for x in length]
        chain = rc.Chain(weight=w, length=a)
        truth = Truth(chain, plummets(w, a))
        for rtol in (1.0, 1e-5, 1e-14, 1e-15, None):
            solution = rc.solve(chain, 4, rtol=rtol)
            assert solution.status == "success"
            assert keeps_its_word(solution, truth, 4, rtol) is None, (scale, heavy, solution)
    for chain in (rc.Chain.uniform_rods(300, length=scale), rc.Chain.uniform_plummets(300, length=scale)):
        links = (rods if chain.centroid[0] < chain.length[0] else plummets)(chain.weight, chain.length)
        truth = Truth(chain, links)
        for rtol in (1.0, 1e-3, 1e-6, 1e-14, None):
            solution = rc.solve(chain, 2, rtol=rtol)
            assert keeps_its_word(solution, truth, 2, rtol) is None and solution.status == "success", solution


def test_lengths_that_span_seventy_decades():
    length = [1e-35, 1.0, 1e35, 1e-20]
    chain, links = rc.Chain(weight=[1.0, 2.0, 3.0, 4.0], length=length), plummets([1.0, 2.0, 3.0, 4.0], length)
    truth = Truth(chain, links, digits=400)
    for rtol in (1.0, 1e-3, 1e-14, None):
        for mode in (1, 2, 3, 4):
            solution = rc.solve(chain, 1, first=mode, rtol=rtol)
            assert keeps_its_word(solution, truth, 1, rtol) is None, (mode, solution)


def test_one_link_and_two():
    rng = np.random.default_rng(12)
    for _ in range(300):
        size = int(rng.integers(1, 3))
        weight, length = 10.0 ** rng.uniform(-6, 6, size), 10.0 ** rng.uniform(-6, 6, size)
        centroid, gyration = rng.uniform(0.1, 1.5, size) * length, 10.0 ** rng.uniform(-3, 1, size) * length
        chain = rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=gyration)
        truth = Truth(chain, bodies(weight, length, centroid, gyration), digits=90)
        for rtol in (1.0, 1e-14, 1e-15, None, 1e-20, 1e-26):
            for model in (None, "closed forms"):
                solution = rc.solve(chain, size, rtol=rtol, model=model)
                assert keeps_its_word(solution, truth, size, rtol) is None, (rtol, model, solution)
                if model is None:
                    assert solution.status == "success", (rtol, solution)
                if model is None and rtol in (1.0, 1e-14):
                    assert solution.model == "closed forms"


def test_tolerances_below_an_ulp():
    rng = np.random.default_rng(13)
    for _ in range(25):
        chain, links = random_scene(rng, most=30)
        pencil = Hanging(links, digits=90)
        for rtol in (1e-17, 1e-20, 1e-26):
            solution = rc.solve(chain, min(2, chain.mode_count), rtol=rtol)
            low = solution.conical_height_low
            if solution.status == "success":
                assert solution.error_bound.max() <= rtol
                assert low is not None
            for i in range(len(solution)):
                word = 0.0 if low is None else float(low[i])
                height, bound = float(solution.conical_height[i]), float(solution.error_bound[i])
                assert pencil.lies_within(i + 1, height, bound * (1 + 1e-9), word), solution
        hopeless = rc.solve(chain, 1, rtol=1e-40)
        assert hopeless.status == "tolerance_not_met"
        assert len(hopeless) == 1
        assert 1e-40 < hopeless.error_bound[0] < 1e-20  # the best there is: not double where two doubles do better


def test_tolerances_that_are_none():
    chain = rc.Chain(weight=[1.0, 2.0, 3.0], length=1.0)
    exact = [mp.mpf(str(Hanging(plummets([1.0, 2.0, 3.0], [1.0] * 3)).height(1)))]
    for rtol in (-1e-3, -math.inf, math.nan):
        for call in (rc.solve, rc.explain):
            with pytest.raises(ValueError, match="rtol"):
                call(chain, rtol=rtol)
    with pytest.raises((TypeError, ValueError), match="rtol"):
        rc.solve(chain, rtol="loose")
    for rtol in (0, 0.0, None):
        solution = rc.solve(chain, rtol=rtol)
        assert solution.status == "success"
        assert solution.error_bound[0] <= 4.45e-16
        assert solution.rtol == 0
    for rtol in (5, 1e300, math.inf):
        solution = rc.solve(chain, rtol=rtol)
        assert solution.status == "success"
        assert abs(float(exact[0]) - solution.conical_height[0]) <= solution.error_bound[0] * float(exact[0])


def test_two_ulp_are_two_ulp():
    # What explain foresees at this tolerance, and calls met, is what is then paid for.
    chain, two_ulp = rc.Chain(weight=[1.0, 2.0, 3.0], length=1.0), 2 * 2.0**-52
    assert rc.solve(chain).error_bound[0] <= two_ulp
    why = rc.explain(chain, rtol=two_ulp)
    assert why.meets_tolerance
    assert rc.solve(chain, rtol=two_ulp).model == why.chosen.name


def test_modes_that_are_not_there():
    for chain in (
        rc.Chain(weight=[1.0, 2.0, 3.0], length=1.0),
        rc.Chain.uniform_plummets(3),
        rc.Chain.uniform_rods(100_000),
        rc.Chain(weight=[1.0, 0.0, 2.0, 0.0], length=1.0),
        rc.Chain(weight=1.0, length=1.0),
    ):
        most = chain.mode_count
        for call in (rc.solve, rc.explain):
            for count, first in ((most + 1, 1), (1, most + 1), (2, most), (0, 1), (-1, 1), (1, 0), (1, -1)):
                with pytest.raises(ValueError, match="mode|count|first"):
                    call(chain, count, first=first, rtol=0.1)
            for count in (1.5, "1", [1]):
                with pytest.raises((TypeError, ValueError)):
                    call(chain, count)
        with pytest.raises((TypeError, ValueError)):
            rc.solve(chain, 10**30)
        last = rc.solve(chain, 1, first=most, rtol=1e-6)
        assert last.status == "success"
    assert rc.solve(rc.Chain(weight=[1.0, 0.0, 2.0, 0.0], length=1.0), 2).status == "success"


def test_words_and_things_that_mean_nothing():
    chain = rc.Chain(weight=[1.0, 2.0], length=1.0)
    for model in ("", "Closed Forms", "halving", "nonsense", 3):
        with pytest.raises((ValueError, TypeError), match="model"):
            rc.solve(chain, model=model)
    for what in (None, 3, "scene.toml", [1, 2], np.ones(3)):
        for call in (rc.solve, rc.explain):
            with pytest.raises(TypeError):
                call(what)
    for budget in (0.0, -1.0, math.nan):
        for call in (rc.solve, rc.explain):
            with pytest.raises(ValueError, match="time_budget"):
                call(chain, time_budget=budget)
    for inclination in (-0.1, math.pi / 2, 2.0, math.nan, math.inf):
        for call in (rc.solve, rc.explain):
            with pytest.raises(ValueError, match="inclination"):
                call(chain, inclination=inclination)
    for gravity in (0.0, -1.0, math.nan, math.inf):
        with pytest.raises(ValueError, match="gravity"):
            rc.solve(chain, gravity=gravity)


def test_gravity_gives_speeds():
    solution = rc.solve(rc.Chain(weight=1.0, length=2.0), gravity=8.0)
    assert solution.gravity == 8.0
    np.testing.assert_allclose(solution.angular_speed, [2.0], rtol=4e-16)


# ---- explain says what solve does


def test_explain_says_what_solve_does():
    rng = np.random.default_rng(14)
    other, asked, weaker = [], 0, {}
    for _ in range(600):
        chain, links = random_scene(rng, most=3000 if rng.random() < 0.05 else 150)
        count = int(min(rng.integers(1, 6), chain.mode_count))
        rtol = 10.0 ** -rng.uniform(0, 15)
        why, solution = rc.explain(chain, count, rtol=rtol), rc.solve(chain, count, rtol=rtol)
        row = why.chosen
        assert sum(r.chosen for r in why.rows) == 1
        assert row.applies
        assert row.cost > 0
        assert why.meets_tolerance == (row.error_bound <= rtol)
        assert row.cost == min(r.cost for r in why.rows if r.applies and r.error_bound <= rtol), (chain, rtol)
        for r in why.rows:
            assert r.applies == (not r.reason)
        assert solution.status == "success"
        if solution.model != row.name:  # only where the one chosen has no answer that keeps the tolerance
            assert rc.solve(chain, count, rtol=rtol, model=row.name).status == "tolerance_not_met"
        # Chains as one hangs them up: weights within some decades, centroids and pendulum lengths in the links.
        weight, inside = chain.weight[chain.weight > 0], (chain.centroid > 0) & (chain.centroid <= chain.length)
        if weight.max() < 1e6 * weight.min() and np.all(inside & (chain.pendulum_length <= chain.length * 1.000001)):
            asked += 1
            if solution.model != row.name:
                other.append((chain, count, rtol, row.name, solution.model))
        if solution.model == row.name:
            error = errors(solution, Truth(chain, links, known_to=21)).max()
            if max(error, solution.error_bound.max()) > row.error_bound * (1 + 1e-9):
                weaker.setdefault(row.name, []).append((rtol, row.error_bound, error, solution.error_bound.max()))
    assert asked > 200
    assert len(other) <= 0.02 * asked, other
    # (tolerance, bound foreseen, error, bound found)
    assert not weaker, {name: (len(cases), cases[:3]) for name, cases in weaker.items()}


def test_a_looser_tolerance_is_never_dearer_and_a_smaller_budget_never_more_accurate():
    rng = np.random.default_rng(15)
    for _ in range(150):
        chain, _ = random_scene(rng, most=3000 if rng.random() < 0.1 else 150)
        count = int(min(rng.integers(1, 6), chain.mode_count))
        costs = [rc.explain(chain, count, rtol=rtol).chosen.cost for rtol in TOLERANCES]
        assert all(a <= b for a, b in zip(costs, costs[1:], strict=False)), (chain, count, costs)
        budgets = 10.0 ** np.linspace(-12, 1, 27)
        rows = [rc.explain(chain, count, time_budget=budget).chosen for budget in budgets]
        bounds = [row.error_bound for row in rows]
        assert all(a >= b for a, b in zip(bounds, bounds[1:], strict=False)), (chain, count, rows)
        fits = [row.cost <= budget for row, budget in zip(rows, budgets, strict=True)]
        assert fits == sorted(fits)  # once one model fits, one that fits is taken


def test_budgets_and_answers():
    rng = np.random.default_rng(16)
    for _ in range(60):
        chain, links = random_scene(rng, most=100)
        truth, count = Truth(chain, links), min(2, chain.mode_count)
        worst = math.inf
        for budget in (1e-12, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 10.0):
            why, solution = rc.explain(chain, count, time_budget=budget), rc.solve(chain, count, time_budget=budget)
            assert keeps_its_word(solution, truth, count, None) is None, (chain, budget, solution)
            assert len(solution) == 0 or solution.error_bound.max() <= worst * (1 + 1e-9), (chain, budget, solution)
            if len(solution):
                worst = solution.error_bound.max()
            # Within the budget, of those that fit the most accurate.
            fitting = [row for row in why.rows if row.applies and row.cost <= budget]
            if fitting:
                assert why.chosen.error_bound <= min(row.error_bound for row in fitting)
                assert why.chosen.cost <= budget
            else:
                assert solution.status == "tolerance_not_met"
        assert solution.status == "success"
        # With a tolerance as well: the cheapest that keeps it, if it fits.
        loose = rc.explain(chain, count, rtol=0.5, time_budget=10.0)
        assert loose.chosen == rc.explain(chain, count, rtol=0.5).chosen
        tight = rc.solve(chain, count, rtol=1e-40, time_budget=1e-12)
        assert tight.status == "tolerance_not_met"
        assert keeps_its_word(tight, truth, count, None) is None


@pytest.mark.parametrize("size", [1, 3, 30, 300, 5000])
def test_a_budget_that_no_model_keeps_is_not_passed_over_in_silence(size):
    # No model is expected to be done in a picosecond: whatever is answered, it is not "success" within the budget.
    chain = rc.Chain(weight=1.0, length=np.ones(size)).with_weight(3.0)
    for rtol in (0.5, None):
        why = rc.explain(chain, rtol=rtol, time_budget=1e-12)
        assert why.chosen.cost > 1e-12
        assert not why.meets_tolerance, why
        assert rc.solve(chain, rtol=rtol, time_budget=1e-12).status == "tolerance_not_met"


# ---- at an inclination


@pytest.mark.parametrize("size", [1, 2, 3])
def test_inclined_shapes_of_one_two_and_three_links(size):
    rng = np.random.default_rng(20 + size)
    broken = []
    for case in range(4):
        weight, length = rng.uniform(0.5, 3, size), rng.uniform(0.5, 2, size)
        if case % 4 == 0:
            chain, links = rc.Chain(weight=weight, length=length), plummets(weight, length)
        elif case % 4 == 1:
            chain = rc.Chain.uniform_plummets(size, length=1.5)
            links = plummets(chain.weight, chain.length)
        elif case % 4 == 2:
            chain = rc.Chain.uniform_rods(size, length=1.5)
            links = rods(chain.weight, chain.length)
        else:
            centroid, gyration = rng.uniform(0.3, 1.0, size) * length, rng.uniform(0, 0.5, size) * length
            chain = rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=gyration)
            links = bodies(weight, length, centroid, gyration)
        for mode, inclination in ((1, 1e-8), (1, 0.01), (1, 0.3), (1, 1.0), (1, 1.5), (size, 0.1), (size, 0.3)):
            exact = [Decimal(mp.nstr(inclined_height(links, mode, inclination, digits=25), 25))]
            for rtol in (1.0, 0.05, 1e-3, 1e-6, 1e-10):
                for model in (None, *NAMES):
                    solution = rc.solve(chain, 1, first=mode, rtol=rtol, inclination=inclination, model=model)
                    what = keeps_its_word(solution, exact, 1, rtol)
                    # "1e-15 over it" is the accuracy of the exact equations; with a margin of two.
                    if model is None and solution.status != "success" and rtol * inclination > 2e-15:
                        what = f"{solution.status}, bounds {solution.error_bound}"
                    if model is None and not len(solution):
                        what = "no answer at all"
                    if what:
                        broken.append(told(chain, solution, rtol, f"inclination {inclination}, case {case}: {what}"))
    assert not broken, f"{len(broken)}:\n" + "\n".join(broken[:12])


def test_the_two_references_at_an_inclination_agree():
    three = [1.0, 0.7, 2.0], [0.5, 1.5, 1.0]
    for links in (plummets(*three), rods(*three), bodies(*three, [0.3, 0.5, 0.7], [0.1, 0.4, 0.2])):
        for mode, inclination in ((1, 0.3), (1, 1.2), (2, 0.3)):
            one, other = (f(links, mode, inclination, digits=25) for f in (inclined_height, inclined_chain))
            assert abs(one / other - 1) < mp.mpf("1e-14")  # to the 15 digits mpmath divides with here


def test_inclined_shapes_of_equal_plummets():
    # Where the theory of small inclinations is offered with its own error, and where the exact equations are.
    broken, linear = [], 0
    for size in (3, 4, 7, 12, 30):
        chain = rc.Chain.uniform_plummets(size)
        links = plummets(chain.weight, chain.length)
        for mode in {1, max(1, size // 3)}:
            for inclination in (0.02, 0.1, 0.3, 0.7) if mode > 1 else (0.02, 0.1, 0.3, 0.7, 1.3):
                exact = [Decimal(mp.nstr(inclined_chain(links, mode, inclination), 25))]
                for rtol in (5.0, 1.0, 0.3, 0.1, 1e-2, 1e-3, 1e-4, 1e-8):
                    for model in (None, "continuous chain", "Laguerre asymptotics", "bisection"):
                        solution = rc.solve(chain, 1, first=mode, rtol=rtol, inclination=inclination, model=model)
                        linear += len(solution) and solution.model != "finite amplitude"
                        what = keeps_its_word(solution, exact, 1, rtol)
                        if model is None and solution.status != "success":
                            what = solution.status
                        if what:
                            broken.append(told(chain, solution, rtol, f"inclination {inclination}: {what}"))
    assert linear > 100
    assert not broken, f"{len(broken)}:\n" + "\n".join(broken[:12])


def test_inclined_shapes_of_equal_rods():
    # Mode 20 of 60: links halfway lean 2.6 times as much as the lowest.
    broken = []
    for size, mode, inclination in ((12, 4, 0.3), (30, 1, 1.0), (60, 20, 0.1)):
        chain = rc.Chain.uniform_rods(size)
        exact = [Decimal(mp.nstr(inclined_chain(rods(chain.weight, chain.length), mode, inclination), 25))]
        for rtol in (1.0, 0.1, 1e-2, 1e-3, 1e-8):
            solution = rc.solve(chain, 1, first=mode, rtol=rtol, inclination=inclination)
            what = keeps_its_word(solution, exact, 1, rtol)
            if what or solution.status != "success":
                broken.append(told(chain, solution, rtol, f"inclination {inclination}: {what or solution.status}"))
    assert not broken, "\n".join(broken)


def test_inclined_shapes_of_long_chains_have_answers():
    for chain in (rc.Chain.uniform_plummets(100_000), rc.Chain.uniform_rods(50), rc.Chain.uniform_rods(100_000)):
        for rtol in (1.0, 0.1):
            solution = rc.solve(chain, 1, rtol=rtol, inclination=0.3)
            assert solution.status == "success", solution
            assert solution.error_bound[0] <= rtol


def test_a_shape_that_leans_no_farther():
    # The lowest of three equal plummets never leans 1.5 rad in the third mode's shapes; no height is made up for it.
    chain = rc.Chain(weight=[1.0, 2.0, 3.0], length=1.0)
    solution = rc.solve(chain, 1, first=3, rtol=1e-3, inclination=1.5)
    if len(solution):
        links = plummets(chain.weight, chain.length)
        exact = [Decimal(mp.nstr(inclined_chain(links, 3, 1.5), 25))]
        assert keeps_its_word(solution, exact, 1, 1e-3) is None
    else:
        assert solution.status == "tolerance_not_met"


@pytest.mark.parametrize("left", [1e-3, 1e-6, 1e-9, 1e-12])
def test_almost_a_right_angle(left):
    inclination = math.pi / 2 - left
    links = [plummets([1.0], [2.0]), plummets([1.0, 2.0], [1.0, 1.5])]
    for link in links:
        chain = rc.Chain(weight=[float(b.weight) for b in link], length=[float(b.length) for b in link])
        for rtol in (5.0, 1.0, 1e-2, 1e-8):
            solution = rc.solve(chain, 1, rtol=rtol, inclination=inclination)
            if len(link) == 1:
                with mp.workdps(40):
                    exact = [Decimal(mp.nstr(2 * mp.cos(mp.mpf(inclination)), 38))]
                assert keeps_its_word(solution, exact, 1, rtol) is None, solution
            # Whatever the status, some best bound, but nearer than the page says; and what explain calls met is met.
            if len(link) > 1 and left < 1e-6:
                assert len(solution) == 0 and solution.status == "tolerance_not_met"
                assert rc.explain(chain, rtol=rtol, inclination=inclination).chosen is None
                continue
            assert len(solution) == 1, (left, rtol, rc.explain(chain, rtol=rtol, inclination=inclination))
            assert solution.model in NAMES
            if rc.explain(chain, rtol=rtol, inclination=inclination).meets_tolerance:
                assert solution.status == "success"
            if solution.status == "success":
                assert solution.error_bound.max() <= rtol


# ---- rigs, held scenes, files


def test_rigs():
    rng = np.random.default_rng(30)
    for _ in range(20):
        size = int(rng.integers(1, 12))
        weight, length = rng.uniform(0.5, 3, size), rng.uniform(0.5, 2, size)
        spring, carriage = float(rng.uniform(1, 50)), float(rng.uniform(0.1, 5))
        rig = rc.Rig(rc.Chain(weight=weight, length=length), stiffness=spring, carriage_weight=carriage)
        pencil = Hanging(plummets(weight, length), spring=spring, carriage=carriage)
        for rtol in (1.0, 1e-6, None):
            solution = rc.solve(rig, 2, rtol=rtol)
            assert solution.status == "success", solution
            for i in range(2):
                height, bound = float(solution.conical_height[i]), float(solution.error_bound[i])
                assert bound <= (rtol or 1e-13)
                assert pencil.lies_within(i + 1, height, bound), solution
        why = rc.explain(rig, 2, rtol=1e-6)
        assert len(why.rows) == 1
        assert why.chosen.applies
        assert rc.solve(rig, 2, rtol=1e-6).model == why.chosen.name
        assert rc.solve(rig, 2, rtol=1e-6, model=why.chosen.name).status == "success"
    hopeless = rc.solve(rig, 1, rtol=1e-40)
    assert hopeless.status == "tolerance_not_met"
    assert hopeless.error_bound.max() < 1e-13


def test_modes_of_a_rig_that_are_not_there():
    rig = rc.Rig(rc.Chain(weight=[1.0, 2.0, 3.0], length=1.0), stiffness=3.0)
    assert len(rc.modes(rig)) == 3
    for count, first in ((20, 1), (4, 1), (1, 4), (2, 9)):
        with pytest.raises(ValueError, match="mode|count|first"):
            rc.solve(rig, count, first=first, rtol=0.1)


def test_a_rig_of_one_wheel():
    # W h + n H = n^2 W (h^2 + r^2)/g: one speed forward, one backward.
    chain = rc.Chain(weight=15.0, length=0.3, centroid=0.15, radius_of_gyration=0.205)
    rig = rc.Rig(chain, momentum=2.0)
    inertia, restoring = 15.0 * (0.15**2 + 0.205**2) / 9.80665, 15.0 * 0.15
    root = math.sqrt(4.0 + 4 * inertia * restoring)
    both = sorted((9.80665 / ((2.0 + s * root) / (2 * inertia)) ** 2 for s in (1, -1)), reverse=True)
    solution = rc.solve(rig, 2, rtol=1e-6, gravity=9.80665)
    assert solution.status == "success"
    np.testing.assert_allclose(solution.conical_height, both, rtol=1e-12)


SCENE = """
title = "Three plummets in other units"
gravity = "981 cm/s^2"
[[links]]
mass = "100 g"
length = "39.1396 inch"
[[links]]
mass = 0.3
length = 0.5
[[links]]
mass = "1 lb"
length = "25 cm"
[ask]
modes = 2
"""


def test_scenes_from_files(tmp_path):
    path = tmp_path / "three.toml"
    path.write_text(SCENE)
    scene = rc.load_scene(path)
    chain = scene.chain()
    np.testing.assert_allclose(chain.length, [0.99414584, 0.5, 0.25], rtol=1e-14)
    np.testing.assert_allclose(chain.weight, np.array([0.1, 0.3, 0.45359237]) * 9.81, rtol=1e-14)
    truth = Truth(chain, plummets(chain.weight, chain.length))
    for rtol in (1.0, 1e-3, 1e-14, None):
        solution = rc.solve(scene, rtol=rtol)
        assert keeps_its_word(solution, truth, 2, rtol) is None
        assert len(solution) == 2
        assert solution.status == "success"
        assert solution.gravity == 9.81
        np.testing.assert_allclose(solution.angular_speed, np.sqrt(9.81 / solution.conical_height), rtol=5e-16)
    assert len(rc.solve(scene, 3)) == 3
    assert rc.explain(scene, rtol=1e-3).chosen.name == rc.solve(scene, rtol=1e-3).model
    examples = sorted((REPOSITORY / "examples" / "scenes").glob("*.toml"))
    assert len(examples) > 15
    for example in examples:
        scene = rc.load_scene(example)
        if scene.is_held:
            for call in (rc.solve, rc.explain):
                with pytest.raises(ValueError, match="held|both ends"):
                    call(scene)
            continue
        for rtol in (1.0, 1e-9, None):
            try:
                solution = rc.solve(scene, rtol=rtol)
            except ValueError as refusal:
                assert scene.is_rigged, (example.name, str(refusal))  # nothing whirls by itself
                continue
            assert solution.status == "success", (example.name, rtol, solution)
            exact = scene.modes().conical_height[: len(solution)]
            assert np.all(abs(solution.conical_height / exact - 1) <= solution.error_bound + 1e-15), example.name


@pytest.mark.parametrize(
    ("ask", "modes"),
    [
        ({}, range(1, 11)),
        ({"modes": 3}, range(1, 4)),
        ({"modes": "all"}, range(1, 31)),
        ({"first": 25}, range(25, 31)),
        ({"first": 3, "modes": 2}, range(3, 5)),
        ({"conical_height": [0.5, 5.0]}, None),
        ({"angular_speed": [1, 4]}, None),
    ],
)
def test_what_a_scene_asks_is_what_is_answered(ask, modes):
    scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 1, "repeat": 30}], "ask": {**ask, "rtol": 1e-3}})
    expected = scene.modes().conical_height
    if modes is None:  # a window: the modes in it, or a refusal, but not others
        assert 0 < len(expected) < 30
        try:
            solution = rc.solve(scene)
        except ValueError:
            return
    else:
        solution = rc.solve(scene)
        assert solution.first == modes[0]
        assert len(solution) == len(modes)
    assert solution.rtol == 1e-3
    assert len(solution) == len(expected)
    np.testing.assert_allclose(solution.conical_height, expected, rtol=2e-3)


# ---- the command line


def command(*words, cwd=None, check=None):
    done = subprocess.run(
        [sys.executable, "-m", "revchain", *map(str, words)], cwd=cwd, capture_output=True, text=True, timeout=120
    )
    if check is not None:
        assert done.returncode == check, (words, done.returncode, done.stdout[-2000:], done.stderr[-2000:])
    return done


def within(capsys, monkeypatch, *words, cwd=None):
    """The command, run in this process: what it says, and its exit code."""
    monkeypatch.setattr(sys, "argv", ["revchain", *map(str, words)])
    monkeypatch.setenv("COLUMNS", "200")
    if cwd is not None:
        monkeypatch.chdir(cwd)
    code = 0
    try:
        code = main()
    except SystemExit as end:
        code = end.code
    said = capsys.readouterr()
    return subprocess.CompletedProcess(words, code or 0, said.out, said.err)


def test_explain_on_the_command_line(tmp_path, capsys, monkeypatch):
    scene = tmp_path / "three.toml"
    scene.write_text(SCENE)
    broken = tmp_path / "broken.toml"
    broken.write_text("[[links]]\nmass = 1\nlength = -1\n")
    held = REPOSITORY / "examples" / "scenes" / "troposkien.toml"
    calls = [
        ((scene, "--rtol", "1e-3"), 0),
        ((scene, "--rtol", "1e-3", "--json"), 0),
        ((scene,), 0),
        ((scene, "--rtol", "1e-40"), 1),
        ((scene, "--time-budget", "1e-12", "--json"), 1),
        ((scene, "--inclination", "0.2", "--rtol", "1e-6", "--json"), 0),
        ((scene, "--rtol", "-1"), 2),
        ((scene, "--rtol", "nan"), 2),
        ((scene, "--rtol", "loose"), 2),
        ((scene, "--inclination", "1.6"), 2),
        ((scene, "--time-budget", "0"), 2),
        ((broken, "--rtol", "1e-3"), 3),
        ((tmp_path / "nowhere.toml",), None),
        ((held,), None),
    ]
    done = [within(capsys, monkeypatch, "explain", *words) for words, _ in calls]
    assert command("explain", *calls[0][0], check=0).stdout.splitlines()[1:] == done[0].stdout.splitlines()[1:]
    for (words, code), run in zip(calls, done, strict=True):
        assert "Traceback" not in run.stderr + run.stdout, (words, run.stderr)
        if code is None:
            assert run.returncode in (2, 3), (words, run.returncode, run.stderr)
        else:
            assert run.returncode == code, (words, run.returncode, run.stdout, run.stderr)
        if code:
            assert run.stderr.strip(), words
    text, data = done[0].stdout, json.loads(done[1].stdout)
    scene = rc.load_scene(scene)
    why = rc.explain(scene, rtol=1e-3)
    marked = [line for line in text.splitlines() if line.startswith("->")]
    assert len(marked) == 1
    assert why.chosen.name in marked[0]
    for row in why.rows:
        assert row.name in text
        assert not row.reason or row.reason in text
    assert data["meets_tolerance"] is True
    assert data["rtol"] == 1e-3
    assert data["models"] == why.to_dict()["models"]
    hopeless = json.loads(done[4].stdout)
    assert hopeless["meets_tolerance"] is False
    inclined = json.loads(done[5].stdout)
    assert [m["name"] for m in inclined["models"] if m["chosen"]] == ["finite amplitude"]


# ---- studies


TWO = {
    "scene": {
        "links": [{"mass": 1.0, "length": 1.0}, {"mass": 1.0, "length": 1.0, "kind": "rod"}],
        "ask": {"modes": 2},
    },
    "vary": {
        "links[0].mass": {"from": 0.1, "to": 10, "steps": 5, "log": True},
        "links[1].length": {"values": [0.5, "70 cm", 1.5]},
        "links[1].mass": {"uniform": [1, 2]},
        "gravity": {"normal": [9.8, 0.1]},
    },
    "samples": 4,
    "seed": 3,
}


def test_a_study_is_its_points():
    found = rc.sweep(TWO)
    study = rc.Study.from_dict(TWO)
    assert len(found) == study.points == 60
    assert found.shape == (5, 3, 4)
    assert found.count("success") == 60
    masses = found["links[0].mass"].reshape(5, 3, 4)
    np.testing.assert_allclose(masses[:, 0, 0], np.geomspace(0.1, 10, 5), rtol=1e-15)
    assert np.all(masses == masses[:, :1, :1])
    lengths = found["links[1].length"].reshape(5, 3, 4)
    np.testing.assert_allclose(lengths[0, :, 0], [0.5, 0.7, 1.5], rtol=1e-15)
    drawn = found["links[1].mass"]
    assert np.all((drawn >= 1) & (drawn < 2))
    assert len(set(drawn)) == 60
    for point in range(60):
        scene = study.scene_at(point)
        chain = scene.chain()
        w, a = chain.weight, chain.length
        links = [plummets(w[:1], a[:1])[0], rods(w[1:], a[1:])[0]]
        truth = Truth(chain, links)
        for mode in (1, 2):
            exact = float(truth.height(mode))
            # Five ulp of the batch; another order of rounding weights, mass times gravity, costs two more.
            assert abs(found["conical_height"][point, mode - 1] / exact - 1) <= 7 * 2.0**-52
            speed = math.sqrt(scene.gravity_value() / exact)
            assert abs(found["angular_speed"][point, mode - 1] / speed - 1) <= 7 * 2.0**-52
    proved = rc.sweep({**TWO, "error_bounds": True})
    assert np.all(proved["error_bound"] <= 4.45e-16)
    for point in range(60):
        single = study.scene_at(point).modes()
        assert np.array_equal(proved["conical_height"][point], single.conical_height)
        assert np.array_equal(proved["error_bound"][point], single.error_bound)
    # More samples, or another path beside it, leave a point's numbers as they were: those of its number.
    more = rc.sweep({**TWO, "samples": 9})
    assert np.array_equal(more["links[1].mass"][:60], drawn)
    fewer = {**TWO, "vary": {k: v for k, v in TWO["vary"].items() if k != "gravity"}}
    assert np.array_equal(rc.sweep(fewer)["links[1].mass"], drawn)
    for chunk in (1, 7, 1000):
        again = rc.sweep(TWO, chunk=chunk, threads=2)
        for name in (*found.found, *found.varied):
            assert np.array_equal(again[name], found[name]), (chunk, name)


@pytest.mark.parametrize("ending", ["csv", "parquet", "nc"])
def test_files_read_back(tmp_path, ending):
    path = tmp_path / f"found.{ending}"
    found = rc.sweep(TWO, out=path)
    assert not (tmp_path / f"found.{ending}.partial").exists()
    fresh = rc.sweep(TWO)
    if ending == "nc":
        xarray = pytest.importorskip("xarray")
        with xarray.open_dataset(path, engine="h5netcdf") as data:
            heights = data["conical_height"]
            assert heights.shape == (5, 3, 4, 2)
            assert np.array_equal(heights.values.reshape(60, 2), fresh["conical_height"])
            assert np.array_equal(data["links[0].mass"].values, fresh["links[0].mass"].reshape(5, 12)[:, 0])
            assert np.array_equal(data["gravity"].values.reshape(-1), fresh["gravity"])
            np.testing.assert_array_equal(fresh.to_xarray()["angular_speed"].values, data["angular_speed"].values)
        return
    pandas = pytest.importorskip("pandas")
    if ending == "csv":
        assert len(pandas.read_csv(path)) == 60
        with path.open(newline="") as lines:
            rows = list(csv.DictReader(lines))
        words = {name: [row[name] for row in rows] for name in rows[0]}
        table = pandas.DataFrame({n: c if n == "status" else list(map(float, c)) for n, c in words.items()})
    else:
        table = pytest.importorskip("pyarrow.parquet").read_table(path).to_pandas()
    assert list(table.columns) == list(fresh.columns())
    for name, column in fresh.columns().items():
        assert np.array_equal(table[name].to_numpy(), column), name
    for name in found.found:
        assert np.array_equal(found[name], fresh[name])
    assert set(table["status"]) == {"success"}
    assert list(table["point"]) == list(range(60))


def test_points_that_are_refused_and_status_in_words(tmp_path):
    study = {
        "scene": {"links": [{"mass": 1.0, "length": 0.5}]},
        "vary": {"links[0].length": {"normal": [0.2, 0.2]}},
        "samples": 200,
        "seed": 5,
    }
    found = rc.sweep(study)
    bad = found["links[0].length"] <= 0
    assert 10 < bad.sum() < 100
    assert found.count("refused") == bad.sum()
    assert np.array_equal(np.asarray(found.status) == "refused", bad)
    assert np.all(np.isnan(found["conical_height"][bad]))
    np.testing.assert_allclose(found["conical_height"][~bad][:, 0], found["links[0].length"][~bad], rtol=5 * 2.0**-52)
    assert found.refused
    assert min(found.refused) == int(np.flatnonzero(bad)[0])
    path = tmp_path / "study.json"
    path.write_text(json.dumps(study))
    run = command("sweep", path, "--out", tmp_path / "found.csv", check=1)
    assert "length" in run.stderr + run.stdout


def test_shapes_and_responses_in_studies():
    study = {
        "scene": {
            "links": [{"mass": 1.0, "length": 1.0}],
            "support": {"radius": 0.1},
            "ask": {"shapes": {"angular_speed": 5.0}, "response": {"angular_speed": [2.0]}},
        },
        "vary": {"links[0].length": {"from": 0.5, "to": 2.0, "steps": 4}},
    }
    found = rc.sweep(study)
    for point, length in enumerate(np.linspace(0.5, 2.0, 4)):
        # r/(1 - n^2 l/g)
        pin = 0.1 / (1 - 4.0 * length / 9.80665)
        assert abs(abs(found["response_free_end_offset"][point]) / abs(pin) - 1) < 1e-13
        # n^2 (r + l sin) = g tan: the shapes of one plummet, by signs.
        angle = np.linspace(-math.pi / 2 + 1e-9, math.pi / 2 - 1e-9, 200_001)
        side = 25.0 * (0.1 + length * np.sin(angle)) * np.cos(angle) - 9.80665 * np.sin(angle)
        roots = np.flatnonzero(side[1:] * side[:-1] < 0)
        single = rc.Study.from_dict(study).scene_at(point).steady_shapes()
        assert found["shapes"][point] == len(single)
        below = [s for s in range(len(single)) if abs(single[s].inclination[0]) < math.pi / 2]
        assert len(below) == len(roots)


WRONG = [
    ({"vary": {"links[0].mas": {"values": [1]}}}, "links"),
    ({"vary": {"links[9].mass": {"values": [1]}}}, "links"),
    ({"vary": {"links[0].mass": {"values": []}}}, "values"),
    ({"vary": {"links[0].mass": {"from": 1, "to": 2}}}, "steps"),
    ({"vary": {"links[0].mass": {"from": 1, "to": 2, "steps": 0}}}, "steps"),
    ({"vary": {"links[0].mass": {"from": -1, "to": 2, "steps": 3, "log": True}}}, "log"),
    ({"vary": {"links[0].mass": {"from": 1, "to": 2, "steps": 3, "values": [1]}}}, "links"),
    ({"vary": {"links[0].mass": {"uniform": [1, 2]}}}, "samples"),
    ({"vary": {"links[0].mass": {"uniform": [1]}}, "samples": 3}, "uniform"),
    ({"vary": {"links[0].mass": {"uniform": [2, 1]}}, "samples": 3}, "uniform"),
    ({"vary": {"links[0].mass": {"normal": [2, -1]}}, "samples": 3}, "normal"),
    ({"vary": {"links[0].mass": {"log_uniform": [0, 1]}}, "samples": 3}, "log_uniform"),
    ({"vary": {"links[0].mass": {"values": ["1 m"]}}}, "mass"),
    ({"vary": {"links[0].mass": {"values": ["heavy"]}}}, "mass"),
    ({"vary": {"links[0].mass": {"values": [1]}}, "samples": 0}, "samples"),
    ({"vary": {"links[0].mass": {"values": [1]}}, "seed": -1}, "seed"),
    ({"vary": {"links[0].mass": {"values": [1]}}, "find": ["speeds"]}, "find"),
    ({"vary": {}}, "vary"),
    ({}, "vary"),
    ({"vary": {"links[0].mass": {"values": [1]}}, "smaples": 3}, "smaples"),
]


@pytest.mark.parametrize(("changed", "key"), WRONG)
def test_wrong_studies_are_refused_by_their_key(changed, key):
    study = {"scene": {"links": [{"mass": 1.0, "length": 0.5}]}, **changed}
    with pytest.raises(rc.SceneError, match="study") as refusal:
        rc.sweep(study)
    assert key in str(refusal.value)


def test_wrong_calls_of_sweep(tmp_path):
    with pytest.raises(ValueError, match="csv"):
        rc.sweep(TWO, out=tmp_path / "found.xls")
    assert not list(tmp_path.iterdir())
    (tmp_path / "file").write_text("")
    with pytest.raises(OSError, match="file"):
        rc.sweep(TWO, out=tmp_path / "file" / "found.csv")
    for name in ("threads", "chunk"):
        with pytest.raises(ValueError, match=name):
            rc.sweep(TWO, **{name: 0})
    with ThreadPoolExecutor(1) as pool, pytest.raises(ValueError, match="threads"):
        rc.sweep(TWO, executor=pool, threads=2)
    with pytest.raises((OSError, rc.SceneError)):
        rc.sweep(tmp_path / "nowhere.toml")
    with pytest.raises(TypeError):
        rc.sweep(3)


SLOW = {
    "scene": {
        "links": [{"mass": 1.0, "length": 1.0, "kind": "rod"}, {"mass": 1.0, "length": 1.0, "repeat": 5}],
        "ask": {"modes": 2},
    },
    "vary": {"links[0].mass": {"log_uniform": [0.1, 10]}, "links[1].length": {"values": [0.5, 1.0]}},
    "samples": 3600,
    "error_bounds": True,
}


@pytest.mark.parametrize("ending", ["csv", "nc"])
def test_killed_again_and_again_a_study_goes_on(tmp_path, ending):
    study = tmp_path / "slow.json"
    study.write_text(json.dumps(SLOW))
    whole, out = tmp_path / f"whole.{ending}", tmp_path / f"found.{ending}"
    words = [sys.executable, "-m", "revchain", "sweep", str(study), "--chunk", "50", "--quiet", "--out"]
    subprocess.run([*words, str(whole)], check=True, timeout=120)
    index = tmp_path / f"found.{ending}.partial" / "index"
    kills, sizes, rng = 0, [], np.random.default_rng(40)
    for _ in range(4):
        before = index.stat().st_size if index.exists() else 0
        run = subprocess.Popen([*words, str(out)], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        deadline = time.monotonic() + 60
        while run.poll() is None and time.monotonic() < deadline:
            if index.exists() and index.stat().st_size > before:
                time.sleep(rng.uniform(0, 0.15))
                break
            time.sleep(0.002)
        os.kill(run.pid, signal.SIGKILL)
        run.communicate()
        kills += run.returncode == -signal.SIGKILL
        if not index.exists():
            break
        assert not out.exists()
        sizes.append(index.stat().st_size)
    assert kills >= 3
    assert sizes == sorted(sizes)  # nothing lost
    last = rc.sweep(study, out=out, chunk=50)
    assert 0 < last.resumed < 7200  # nothing repeated that was kept
    if ending == "csv":
        assert out.read_bytes() == whole.read_bytes()
    fresh = rc.sweep(study)
    for name, column in fresh.columns().items():
        assert np.array_equal(last.columns()[name], column), name
    assert not index.parent.exists()
    if ending == "nc":
        xarray = pytest.importorskip("xarray")
        with xarray.open_dataset(out) as one, xarray.open_dataset(whole) as other:
            assert one.equals(other)


def test_torn_records_and_another_study(tmp_path):
    study, out = tmp_path / "slow.json", tmp_path / "found.csv"
    study.write_text(json.dumps(SLOW))

    def stop(done, _all):
        if done >= 1000:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rc.sweep(study, out=out, chunk=100, progress=stop)
    folder = tmp_path / "found.csv.partial"
    assert folder.is_dir()
    assert not out.exists()
    with pytest.raises(OSError, match="another study"):
        rc.sweep({**SLOW, "seed": 2}, out=out)
    index = folder / "index"
    index.write_bytes(index.read_bytes()[:-3])  # a torn record
    points = folder / "points"
    content = bytearray(points.read_bytes())
    content[100] ^= 1  # damaged numbers of the first stretch
    points.write_bytes(bytes(content))
    found = rc.sweep(study, out=out)
    assert 0 < found.resumed <= 1000 + 200
    fresh = rc.sweep(study)
    for name, column in fresh.columns().items():
        assert np.array_equal(found.columns()[name], column), name


def test_two_workers_of_a_dask_cluster_find_the_same(tmp_path):
    pytest.importorskip("distributed")
    study = tmp_path / "study.json"
    study.write_text(json.dumps({**SLOW, "samples": 400}))
    command("sweep", study, "--out", tmp_path / "threads.csv", "--quiet", check=0)
    run = command(
        "sweep", study, "--dask", "local", "--workers", 2, "--chunk", 50, "--out", tmp_path / "dask.csv", "--quiet"
    )
    assert run.returncode == 0, run.stderr
    assert (tmp_path / "threads.csv").read_bytes() == (tmp_path / "dask.csv").read_bytes()


def test_any_executor_finds_the_same():
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    study = {**SLOW, "samples": 200}
    fresh = rc.sweep(study)
    with ProcessPoolExecutor(2, mp_context=get_context("spawn")) as pool:
        found = rc.sweep(study, executor=pool, chunk=30)
    for name, column in fresh.columns().items():
        assert np.array_equal(found.columns()[name], column), name


def test_sweep_says_what_it_would_compute_and_refuses_nonsense(tmp_path, capsys, monkeypatch):
    study, wrong = tmp_path / "study.json", tmp_path / "wrong.toml"
    study.write_text(json.dumps(TWO))
    wrong.write_text('scene = "nowhere.toml"\n[vary."links[0].mass"]\nvalues = [1]\n')
    broken = tmp_path / "broken.toml"
    broken.write_text("[vary\n")
    calls = [
        ((study, "--check"), 0),
        ((study, "--out", tmp_path / "found.xls"), 2),
        ((study, "--workers", "0"), 2),
        ((wrong,), 3),
        ((broken,), 3),
        ((study, "--out", wrong / "found.csv"), 4),
        ((study, "--dask", "nonsense"), 2),
        ((study,), 0),
    ]
    done = [within(capsys, monkeypatch, "sweep", *words, cwd=tmp_path) for words, _ in calls]
    codes = [(str(words[-1]), run.returncode, code) for (words, code), run in zip(calls, done, strict=True)]
    assert [got for _, got, _ in codes] == [want for _, _, want in codes], [
        (c, run.stderr[-300:]) for c, run in zip(codes, done, strict=True) if c[1] != c[2]
    ]
    for run in done:
        assert "Traceback" not in run.stderr
    assert "60" in done[0].stdout + done[0].stderr
    assert (tmp_path / "study.csv").exists()
