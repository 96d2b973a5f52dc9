# SPDX-License-Identifier: GPL-3.0-or-later
"""Derivatives of steady shapes against differences of shapes found in 40 digits by Newton's method on the moments."""

from types import SimpleNamespace

import mpmath as mp
import numpy as np
import pytest
from mechanics import random_chain

import revchain as rc

DATA = {"mass": "weight", "length": "length", "centroid": "centroid", "radius_of_gyration": "radius_of_gyration"}


def found_again(data, height, radius, start):
    """Inclinations, offsets and tensions for numbers of many digits."""
    d, W, n = start, data.weight, len(start)
    c = np.array([[data.centroid[j] if i == j else data.length[j] * int(j > i) for j in range(n)] for i in range(n)])
    inert, kappa = c.T @ (W[:, None] * c) + np.diag(W * data.radius_of_gyration**2), W @ c
    for _ in range(7):
        s, c = (np.array([f(x) for x in d]) for f in (mp.sin, mp.cos))
        force = (inert @ s + kappa * radius) / height
        slope = np.diag(kappa * c + s * force) - np.outer(c, c) * inert / height
        d = d - np.array(list(mp.lu_solve(mp.matrix(slope.tolist()), mp.matrix(list(kappa * s - c * force)))))
    s = np.array([mp.sin(x) for x in d])
    pin = np.array([*(radius + sum((data.length * s)[i:]) for i in range(len(d))), radius])
    out = pin[1:] + data.centroid * s
    tension = np.array([mp.hypot(sum((W * out)[: k + 1]) / height, sum(W[: k + 1])) for k in range(len(d))])
    return d, pin, tension


def numbers(chain):
    return {
        "weight": chain.mass if chain.by_mass else chain.weight, "length": chain.length, "centroid": chain.centroid,
        "radius_of_gyration": chain.radius_of_gyration,
    }


def check(shape, chain, gravity):
    with mp.workdps(40):
        step, g = mp.mpf(10) ** -14, mp.mpf(gravity)
        base = {name: np.array([mp.mpf(float(x)) for x in np.broadcast_to(v, chain.size)]) for name, v in numbers(chain).items()}
        height, radius = mp.mpf(float(shape.conical_height)), mp.mpf(float(shape.offset[-1]))
        start = np.array([mp.mpf(float(x)) for x in shape.inclination])

        def at(height=height, radius=radius, **changed):
            return found_again(SimpleNamespace(**base | changed), height, radius, start)

        def slope(change):
            more, less = change(step), change(-step)
            return [np.array([float((x - y) / (2 * step)) for x, y in zip(*pair, strict=True)]) for pair in zip(more, less, strict=True)]

        speed = mp.sqrt(g / height)
        expected = {
            "angular_speed": slope(lambda e: at(height=g / (speed + e) ** 2)),
            "support_radius": slope(lambda e: at(radius=radius + e)),
        }
        for name, key in DATA.items():
            each = []
            for m in range(chain.size):
                unit = np.array([mp.mpf(int(i == m)) for i in range(chain.size)])
                each.append(slope(lambda e, key=key, unit=unit: at(**{key: base[key] + e * unit})))
            expected[name] = [np.stack([of_link[q] for of_link in each], axis=1) for q in range(3)]
    per = gravity if chain.by_mass else 1.0
    worst = (0.0, "", "")
    for q, quantity in enumerate(("inclination", "offset", "tension")):
        found = getattr(shape.sensitivity, quantity)
        for name, values in expected.items():
            want = values[q] * (per if quantity == "tension" else 1.0)
            got = getattr(found, name)
            assert got.shape == want.shape
            off = float(np.max(np.abs(got - want)) / max(1e-3, np.max(np.abs(want))))
            worst = max(worst, (off, quantity, name))
    assert worst[0] < 1e-13 * max(10.0, float(shape.condition)), worst
    one = shape.sensitivity.inclination
    share = one.length * chain.length + one.centroid * chain.centroid + one.radius_of_gyration * chain.radius_of_gyration
    np.testing.assert_allclose(one.length_in_proportion * chain.length, share, rtol=1e-12, atol=1e-14)


@pytest.mark.parametrize("kind", ["plummets", "rods", "bodies"])
@pytest.mark.parametrize("count", [1, 2, 4])
def test_against_differences_in_forty_digits(kind, count):
    chain = random_chain(kind, count, seed=11)
    height = float(rc.modes(chain).conical_height[0]) / 5
    shapes = rc.steady_shapes(chain, conical_height=height)
    assert len(shapes) > 0
    for shape in shapes[:3]:
        check(shape, chain, 9.80665)


def test_carried_round_and_by_mass():
    chain = rc.Chain(mass=[80.0, 3.0], length=[1.0, 5.0], centroid=[0.4, 2.5], radius_of_gyration=[0.3, 1.4])
    rig = rc.Rig(chain, support=rc.Support(radius=4.0))
    for shape in rc.steady_shapes(rig, angular_speed="9 rpm"):
        check(shape, chain, 9.80665)


def test_along_a_branch_and_scales():
    chain = rc.Chain.uniform_rods(60, length=2.0, mass=3.0)
    shape = rc.steady_shapes(chain, angular_speed=8.0)[0]
    s = shape.sensitivity
    near = [rc.steady_shapes(chain, angular_speed=8.0 + e)[0] for e in (-1e-4, 1e-4)]
    for name in ("inclination", "offset", "tension"):
        difference = (getattr(near[1], name) - getattr(near[0], name)) / 2e-4
        np.testing.assert_allclose(getattr(s, name).angular_speed, difference, rtol=1e-6, atol=1e-6)
    assert np.all(s.offset.angular_speed[-1] == 0) and np.all(s.offset.support_radius[-1] == 1)
    # masses act by their ratios, but on tensions; all lengths and gravity over speed squared scale alike
    np.testing.assert_allclose(s.inclination.mass @ chain.mass, 0, atol=1e-11)
    np.testing.assert_allclose(s.tension.mass @ chain.mass, shape.tension, rtol=1e-10)
    height_by_speed = -2 * shape.conical_height / shape.angular_speed
    by_height = s.offset.angular_speed / height_by_speed
    scaled = s.offset.length_in_proportion @ chain.length + by_height * shape.conical_height
    np.testing.assert_allclose(scaled, shape.offset, rtol=1e-9, atol=1e-11)


def test_what_it_is_not_for():
    rig = rc.Rig(rc.Chain.uniform_rods(2, mass=1.0), support=rc.Support(stiffness=20.0))
    shape = rc.steady_shapes(rig, angular_speed=9.0)[0]
    with pytest.raises(ValueError, match="is for shapes of a Chain, or of a Rig with a firm support"):
        _ = shape.sensitivity
