# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of shapes held at both ends, against differences of fourth order between shapes."""

import numpy as np
import pytest
from mechanics import fourth_order

import revchain as rc

PARTS = ("inclination", "offset", "tension")
MASS = np.array([1.0, 2.0, 1.5, 1.2, 0.7])
LENGTH = np.array([0.5, 0.4, 0.6, 0.3, 0.5])
BODIES = {"centroid": 0.4 * LENGTH, "radius_of_gyration": 0.25 * LENGTH}
SPRINGS = {"lower": {"radius": 0.05, "stiffness": 2000.0, "mass": 3.0}, "upper": {"radius": 0.2, "stiffness": 5000.0, "mass": 5.0}}
ENDS = {
    "span": {"span": 1.7},
    "tension": {"tension": 110.0},
    "arms": {"span": 1.7, "lower": {"radius": 0.1}, "upper": {"radius": 0.3}},
    "springs": {"span": 1.7, **SPRINGS},
    "weightless": {"span": 1.7, "weightless": True},
    "weightless, springs": {"span": 1.7, "weightless": True, **SPRINGS},
    "weightless, tension": {"tension": 84.5, "weightless": True},
}


def shape_of(data, speed=7.0):
    ends = {name: value for name, value in data.items() if name not in ("chain", "speed")}
    for name in ("lower", "upper"):
        if name in ends:
            ends[name] = rc.Support(**ends[name])
    held = rc.Held(rc.Chain(**data["chain"]), **ends)
    return rc.steady_shapes(held, angular_speed=data["speed"], budget=0)[0]


def changed(data, path, step):
    """The data with one number more by a step."""
    head, *tail = path
    inner = data[head]
    if not tail:
        return {**data, head: inner + step}
    if isinstance(inner, dict):
        return {**data, head: changed(inner, tail, step)}
    column = np.array(inner, float)
    column[tail[0]] += step
    return {**data, head: column}


def slope(data, path, step):
    """Of inclinations, offsets and tensions, by differences of fourth order."""

    def parts(by):
        shape = shape_of(changed(data, path, by))
        return np.concatenate([getattr(shape, part) for part in PARTS])

    size = len(MASS)
    return np.split(fourth_order(parts, step), [size, 2 * size + 1])


# what takes 10 s is slow: "tension" and "weightless" are tested by themselves
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=[pytest.mark.slow] * (name == "weightless, tension")) for name in ENDS]
)
def test_differences(name):
    chain = {"mass": MASS, "length": LENGTH, **BODIES}
    data = {"chain": chain, "speed": 7.0, **ENDS[name]}
    sensitivity = shape_of(data).sensitivity
    held_by = next(name for name in ("span", "tension") if name in data)
    paths = {("angular_speed", None): ("speed",), (held_by, None): (held_by,)}
    for datum in ("mass", "length", "centroid", "radius_of_gyration"):
        paths |= {(datum, k): ("chain", datum, k) for k in range(5)}
    for end in ("lower", "upper"):
        for datum in data.get(end, {}):
            paths[f"{end}_{datum}", None] = (end, datum)
    for (datum, link), path in paths.items():
        value = data
        for step in path:
            value = value[step]
        best = dict.fromkeys(PARTS, np.inf)  # of several steps: near the largest tension shapes change fast
        for step in (3e-3, 1e-3, 3e-4, 1e-4, 3e-5, 1e-5):
            for part, exact in zip(PARTS, slope(data, path, step * float(value)), strict=True):
                every = getattr(getattr(sensitivity, part), datum)
                given = every if link is None else every[:, link]
                largest = max(np.abs(exact).max(), np.abs(every).max(), 1e-2)
                best[part] = min(best[part], np.abs(given - exact).max() / largest)
        assert max(best.values()) < 1e-10, (datum, link, best)


def test_the_length_in_proportion_and_what_was_not_given():
    data = {"chain": {"mass": MASS, "length": LENGTH, **BODIES}, "speed": 7.0, "span": 1.7}
    sensitivity = shape_of(data).sensitivity
    step = 1e-4
    pair = []
    for sign in (-1, 1):
        longer = {key: np.where(np.arange(5) == 2, value * (1 + sign * step), value) for key, value in {"length": LENGTH, **BODIES}.items()}
        pair.append(shape_of({**data, "chain": {"mass": MASS, **longer}}).offset)
    found = (pair[1] - pair[0]) / (2 * step * LENGTH[2])
    np.testing.assert_allclose(sensitivity.offset.length_in_proportion[:, 2], found, atol=1e-6)
    assert np.isnan(sensitivity.offset.tension).all() and np.isfinite(sensitivity.offset.span).all()
    assert (sensitivity.tension.lower_stiffness == 0).all()
