# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of rigs from Python, against equations written out here; the list itself is tested in C++."""

from __future__ import annotations

import mpmath
import numpy as np
import pytest
from rigs import G, rigged

import revchain as rc


def bob(weight: float = 1.0, length: float = 1.0) -> rc.Chain:
    return rc.Chain(weight=weight, length=length, centroid=length, radius_of_gyration=0.0)


@pytest.mark.parametrize(("speed", "count"), [(1.0, 1), (3.0, 1), (8.0, 3), (20.0, 3)])
def test_a_plummet_carried_round(speed: float, count: int) -> None:
    """g tan d = n^2 (b + l sin d), 40 digits."""
    length, radius = 0.9, 0.2
    found = rc.steady_shapes(rigged(bob(2.0, length), radius=radius), angular_speed=speed)
    assert found.complete
    assert len(found) == count
    for shape in found:
        (d,) = shape.inclination
        with mpmath.workdps(40):
            n, g, l, b = (mpmath.mpf(x) for x in (speed, G, length, radius))
            exact = mpmath.findroot(lambda x: g * mpmath.tan(x) - n * n * (b + l * mpmath.sin(x)), d)
            assert abs(exact - mpmath.mpf(float(d))) <= shape.error_bound < 2.3e-16
            np.testing.assert_allclose(shape.offset, [float(b + l * mpmath.sin(exact)), radius], rtol=3e-16)


@pytest.mark.parametrize(("weight", "stiffness"), [(3.0, 20.0), (10.0, 20.0), (10.0, 300.0)])
@pytest.mark.parametrize("carriage", [0.0, 4.0])
def test_a_plummet_on_a_spring(weight: float, stiffness: float, carriage: float) -> None:
    """(lambda - W/E) sec d = l, the support W tan d / E from the axis; with a carriage w: W/(E - w/lambda)."""
    own = weight / stiffness
    for height in (0.9 * (1 + own), 0.6 + own, own + 0.05) if not carriage else (0.5,) if weight == 3 else (0.8,):
        rig = rigged(bob(weight), stiffness=stiffness, carriage=carriage)
        shapes = rc.steady_shapes(rig, conical_height=height)
        (shape,) = shapes
        assert shapes.complete
        flexibility = weight / (stiffness - carriage / height)
        assert np.cos(shape.inclination[0]) == pytest.approx(height - flexibility, abs=1e-15)
        assert shape.inclination[0] == pytest.approx(np.arccos(height - flexibility), abs=1e-14)
        tan, sharp = np.tan(shape.inclination[0]), max(2e-15, 4 * 2.0**-52 / np.sin(2 * shape.inclination[0]))
        assert shape.offset[1] == pytest.approx(flexibility * tan, rel=sharp, abs=0)
        inertia = weight * shape.offset[0] ** 2 + carriage * shape.offset[1] ** 2
        assert shape.moment_of_inertia == pytest.approx(inertia, rel=1e-15, abs=0)


@pytest.mark.parametrize("sense", [1, -1])
def test_a_gyrostat_in_either_sense(sense: int) -> None:
    """A n^2 cos d = W h + H n, and its angular momentum."""
    weight, length, speed, momentum = 2.0, 0.7, 6.0, 0.1
    rig = rigged(bob(weight, length), momentum=momentum)
    n = sense * speed
    moment = weight * length**2 / G
    for shapes in (
        rc.steady_shapes(rig, angular_speed=speed, direction=sense),
        rc.steady_shapes(rig, conical_height=G / speed**2, direction=sense),
    ):
        (shape,) = shapes
        cosine = (weight * length + momentum * n) / (moment * n * n)
        assert np.cos(shape.inclination[0]) == pytest.approx(cosine, rel=1e-14)
        assert shape.angular_momentum == pytest.approx(moment * n * (1 - cosine**2) + momentum * cosine, rel=1e-14)


def test_an_effective_tension_may_be_negative_but_not_nothing() -> None:
    speed = 4.0
    turned = rigged(bob(), momentum=0.75)
    assert len(rc.steady_shapes(turned, angular_speed=speed, direction=-1)) == 0
    (shape,) = rc.steady_shapes(turned, angular_speed=speed, direction=-1, hanging_only=False, gravity=4.0)
    assert np.cos(shape.inclination[0]) == pytest.approx((1 - 0.75 * speed) / (speed**2 / 4.0), abs=1e-15)
    with pytest.raises(ValueError, match=r"links\[0\]: the effective tension .* must not vanish"):
        rc.steady_shapes(rigged(bob(), momentum=0.25), angular_speed=speed, direction=-1)


def test_a_rig_with_nothing_is_its_chain() -> None:
    chain = rc.Chain.uniform_rods(3, length=3.0)
    for only in (True, False):
        want = rc.steady_shapes(chain, conical_height=0.05, hanging_only=only)
        found = rc.steady_shapes(rc.Rig(chain), conical_height=0.05, hanging_only=only)
        assert [s.inclination.tolist() for s in found] == [s.inclination.tolist() for s in want]


def test_what_is_known_of_chains_alone() -> None:
    (shape,) = rc.steady_shapes(rigged(bob(), radius=0.1), conical_height=2.0)
    for method in (shape.stability, shape.force_diagram, shape.transferred_to_axis):
        with pytest.raises(ValueError, match=f"SteadyShape.{method.__name__}"):
            method()


@pytest.mark.parametrize("sense", [0, 2, 1.0, True, "1"])
def test_senses_that_are_none(sense: object) -> None:
    with pytest.raises(ValueError, match="direction must be"):
        rc.steady_shapes(bob(), conical_height=0.5, direction=sense)  # type: ignore[arg-type]


def test_neither_chain_nor_rig() -> None:
    with pytest.raises(TypeError, match="Chain"):
        rc.steady_shapes([1.0], conical_height=0.5)  # type: ignore[arg-type]


def test_pictures_show_the_arm() -> None:
    pytest.importorskip("matplotlib")
    shapes = rc.steady_shapes(rigged(bob(), radius=0.25), conical_height=0.2)
    axes = shapes.plot()
    assert axes.get_title() == f"{len(shapes)} shapes, proved complete"
    ends = [line.get_xdata() for line in axes.get_lines()]
    assert any(list(x) == [0.0, 0.25] for x in ends)
    axes.figure.clear()
