# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes, their lists and their stability: figures known from elsewhere, what is refused, pictures."""

import numpy as np
import pytest
from mechanics import moments, plummets, scan, turned

import revchain as rc
from revchain import Chain

FOLD = 3.90376215692  # n of three plummets on threads of 1, in units of sqrt(g/a), where two shapes are born


@pytest.mark.parametrize(
    ("count", "ratio", "shapes"),
    [(1, 2.0, 1), (2, 166.0, 2), (3, 166.0, 5), (4, 166.0, 10), (6, 187.5, 56), (8, 16.0, 19), (8, 35.4025, 84),
     (10, 50.0, 412)],
)
def test_counts_known_from_elsewhere(count: int, ratio: float, shapes: int) -> None:
    found = rc.steady_shapes(plummets(count), conical_height=1 / ratio)
    assert found.complete
    assert len(found) == shapes
    assert found.undecided.shape == (0, 2)
    assert found.cells > 0
    assert repr(found).startswith(f"{shapes} shape") and "proved complete" in repr(found)


def test_two_shapes_are_born_at_the_fold() -> None:
    for speed, count in ((FOLD * (1 - 1e-9), 3), (FOLD * (1 + 1e-9), 5)):
        found = rc.steady_shapes(plummets(3), angular_speed=speed, gravity=1.0)
        assert found.complete
        assert len(found) == count


def test_two_unequal_plummets_have_four_shapes() -> None:
    chain = Chain(weight=[1.0, 3.0], length=[2.0, 1.0], centroid=[2.0, 1.0], radius_of_gyration=0.0)
    found = rc.steady_shapes(chain, conical_height=1 / 64)
    assert found.complete
    assert len(found) == 4


@pytest.mark.parametrize(("ratio", "hanging", "every"), [(0.7, 1, 2), (9.0, 2, 13), (16.0, 3, 14), (50.0, 7, 20)])
def test_three_rods_hanging_and_standing(ratio: float, hanging: int, every: int) -> None:
    rods = Chain.uniform_rods(3, length=3.0)
    assert len(rc.steady_shapes(rods, conical_height=1 / ratio)) == hanging
    found = rc.steady_shapes(rods, conical_height=1 / ratio, hanging_only=False)
    assert found.complete
    assert len(found) == every
    assert sum(bool(np.all(np.cos(shape.inclination) > 0)) for shape in found) == hanging
    for shape in found:
        assert moments(rods, shape) < 1e-15
        assert np.all(np.abs(shape.inclination) <= np.pi)
        assert shape.offset[0] > 0
        assert shape.error_bound < 4.5e-16


THREE = Chain(  # a plummet, a link with l = 4 a, a rod
    weight=[0.5, 1.0, 1.5],
    length=[0.8, 1.0, 1.2],
    centroid=[0.8, 0.6, 0.6],
    pendulum_length=[0.8, 4.0, 0.8],
)
PAIR = Chain(weight=[1.0, 1.0], length=[1.0, 0.2], centroid=[0.5, 0.5], radius_of_gyration=[0.3, 0.9])


@pytest.mark.parametrize(("chain", "height"), [(PAIR, 0.02), (THREE, 0.02), (THREE, 0.1), (THREE, 0.5), (THREE, 1.5)])
def test_links_with_three_inclinations_under_one_load(chain: Chain, height: float) -> None:
    for only in (False, True):
        found = rc.steady_shapes(chain, conical_height=height, hanging_only=only)
        assert found.complete
        listed = np.array([shape.inclination for shape in found])
        fallen_upon = scan(chain, height, only, 4000)
        for angles in fallen_upon:
            assert turned(listed, angles).min() < 1e-6
        assert len(fallen_upon) == len(found) > 0
        for shape in found:
            assert moments(chain, shape) < 1e-15


def test_above_the_first_height_nothing_leaves_the_vertical() -> None:
    chain = Chain.uniform_rods(4, length=1.0)
    first = rc.modes(chain, count=1).conical_height[0]
    for only in (True, False):
        found = rc.steady_shapes(chain, conical_height=first * 1.001, hanging_only=only)
        assert found.complete
        assert len(found) == 0
        assert len(rc.steady_shapes(chain, conical_height=first * 0.999, hanging_only=only)) == 1


def test_one_plummet_is_the_conical_pendulum() -> None:
    shape = rc.steady_shapes(Chain.uniform_plummets(1, length=2.0), conical_height=1.0, gravity=4.0)[0]
    assert shape.inclination == pytest.approx([np.pi / 3], rel=3e-16)
    assert shape.offset == pytest.approx([np.sqrt(3), 0.0], rel=3e-16)
    assert shape.height == pytest.approx([-1.0, 0.0], rel=3e-16)
    assert shape.tension == pytest.approx([2.0], rel=3e-16)
    assert shape.reaction_inclination == pytest.approx([np.pi / 3], rel=3e-16)
    assert shape.moment_of_inertia == pytest.approx(3.0, rel=3e-16)
    assert shape.effective_energy == pytest.approx(-2.5, rel=3e-16)
    assert shape.half_waves == 1
    assert shape.conical_height == 1.0
    assert shape.angular_momentum == pytest.approx(1.5, rel=3e-16)
    assert shape.residual < 1e-20
    assert shape.condition > 0
    assert "60.0000" in repr(shape)


def test_a_list_is_a_sequence() -> None:
    found = rc.steady_shapes(plummets(4), conical_height=0.02)
    assert found[-1] is list(found)[-1]
    assert found[1:3] == (found[1], found[2])
    order = [(shape.half_waves, shape.inclination[0]) for shape in found]
    assert order == sorted(order)
    assert found[0] in found
    assert list(reversed(found)) == list(found)[::-1]
    with pytest.raises(IndexError):
        found[len(found)]
    with pytest.raises(ValueError, match="read-only"):
        found[0].inclination[0] = 1.0


def test_a_budget_that_ends_is_told() -> None:
    for only in (True, False):
        found = rc.steady_shapes(plummets(8), conical_height=0.01, budget=50, hanging_only=only)
        assert not found.complete
        assert found.undecided.shape[0] > 0
        assert np.all(found.undecided[:, 0] <= found.undecided[:, 1])
        assert "there may be more" in repr(found)


def test_speed_and_height_are_one() -> None:
    chain = plummets(3)
    by_height = rc.steady_shapes(chain, conical_height=0.25)
    by_speed = rc.steady_shapes(chain, angular_speed=2.0, gravity=1.0)
    for x, y in zip(by_height, by_speed, strict=True):
        assert np.array_equal(x.inclination, y.inclination)


def test_stability_of_known_shapes() -> None:
    pendulum = rc.steady_shapes(Chain.uniform_plummets(1, length=1.0), conical_height=0.5)[0]
    free = pendulum.stability()
    assert free.verdict == "minimum"
    assert free.frame == "free"
    assert np.abs(free.exponents.imag).max() == pytest.approx(np.sqrt(1 + 3 / 4), rel=1e-14)
    driven = pendulum.stability(frame="driven")
    assert np.abs(driven.exponents.imag).max() == pytest.approx(np.sqrt(3) / 2, rel=1e-14)
    assert driven.negative_directions == 0
    assert driven.growth_rate <= driven.margin
    pair = plummets(2)
    second = rc.modes(pair).conical_height[1]
    for share, verdict in ((0.47, "spectrally stable"), (0.45, "unstable")):
        shapes = rc.steady_shapes(pair, conical_height=share * second)
        assert [shape.stability().verdict for shape in shapes] == ["minimum", verdict]
    assert repr(free).startswith("Stability (free): minimum")


def test_standing_shapes_have_a_stability() -> None:
    pair = plummets(2)
    shapes = rc.steady_shapes(pair, conical_height=0.2, hanging_only=False)
    standing = [shape for shape in shapes if np.any(np.cos(shape.inclination) < 0)]
    assert len(standing) == 2
    for shape in standing:
        assert shape.stability().verdict != "minimum"
        assert shape.stability().negative_directions > 0


def test_wrong_calls_are_refused() -> None:
    chain = plummets(2)
    for bad in (0.0, -1.0, float("nan"), float("inf")):
        with pytest.raises(ValueError, match="gravity"):
            rc.steady_shapes(chain, angular_speed=1.0, gravity=bad)
    with pytest.raises(TypeError, match="hanging_only"):
        rc.steady_shapes(chain, conical_height=1.0, hanging_only="no")  # type: ignore[arg-type]
    shape = rc.steady_shapes(chain, conical_height=0.2)[0]
    for frame in ("moving", ["free"], np.array(["free", "driven"]), None):
        with pytest.raises(ValueError, match="frame must be 'free' or 'driven', got"):
            shape.stability(frame=frame)  # type: ignore[arg-type]


def test_plots() -> None:
    pytest.importorskip("matplotlib")
    found = rc.steady_shapes(Chain.uniform_rods(3, length=3.0), conical_height=0.0625, hanging_only=False)
    axes = found.plot()
    assert axes.get_title() == "14 shapes, proved complete"
    assert axes.get_xlabel() == "distance from the axis (m)"
    drawn = [line.get_xydata() for line in axes.lines]
    for shape in found:
        points = np.column_stack([shape.offset, shape.height])
        assert any(np.array_equal(points, line) for line in drawn if line.shape == points.shape)
    assert found[0].plot(axes) is axes
    axes.figure.canvas.draw()
