# SPDX-License-Identifier: GPL-3.0-or-later
"""Steady shapes of rigs: balance of moments in 50 digits, full motions, closed forms.

That lists lack no shape: tests/cpp/finite/shapes/rigs.cpp, by scans and random starts."""

import itertools
import math

import numpy as np
import pytest
from rigs import G, Motion, figure_moments, random_chain, rigged
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import revchain as rc

EPS = 2.0**-52


def bob(weight=1.0, length=1.0):
    return rc.Chain(weight=weight, length=[length])


# ---- supports on springs and on arms


@pytest.mark.parametrize("seed", range(5))
def test_figures_on_springs_and_arms_balance_and_turn_as_one_piece(seed):
    chain = random_chain(np.random.default_rng(40 + seed), 3, spread=0.7)
    rig = rigged(
        chain,
        stiffness=[math.inf, 30.0, 200.0][seed % 3],
        carriage=[0.0, 0.3, 1.0][seed % 3],
        radius=[0.2, 0.0, 0.3, 0.15, 0.1][seed],
        momentum=np.array([0.3, 0.0, -0.2]) * (seed > 2),
    )
    height = 0.6 * rc.modes(rc.Rig(chain)).conical_height[0]
    shapes = rc.steady_shapes(rig, conical_height=height)
    assert len(shapes) >= 1
    for shape in shapes:
        assert shape.residual <= 1e-14
        assert figure_moments(rig, shape) <= 1e-14
    motion = Motion(rig, math.sqrt(G / height))
    for shape in list(shapes)[:3]:
        assert motion.run(shape.inclination, shape.offset[-1], turns=0.5) < 1e-8
        # the same figure a thousandth of a radian away is none
        assert motion.run(shape.inclination + 1e-3, shape.offset[-1], turns=0.5) > 1e-5


@pytest.mark.parametrize(("weight", "stiffness"), [(3.0, 20.0), (10.0, 20.0), (10.0, 300.0)])
@pytest.mark.parametrize("carriage", [0.0, 4.0])
def test_a_plummet_on_a_spring(weight, stiffness, carriage):
    """(lambda - W/E) sec d = l, the support W tan d / E from the axis; with a carriage w: W/(E - w/lambda)."""
    own = weight / stiffness
    for height in (0.9 * (1 + own), 0.6 + own, own + 0.05) if not carriage else (0.5,) if weight == 3 else (0.8,):
        shapes = rc.steady_shapes(rigged(bob(weight), stiffness=stiffness, carriage=carriage), conical_height=height)
        (shape,) = shapes
        assert shapes.complete
        flexibility = weight / (stiffness - carriage / height)
        assert np.cos(shape.inclination[0]) == pytest.approx(height - flexibility, abs=1e-15)
        assert shape.inclination[0] == pytest.approx(np.arccos(height - flexibility), abs=1e-14)
        tan, sharp = np.tan(shape.inclination[0]), max(2e-15, 4 * EPS / np.sin(2 * shape.inclination[0]))
        assert shape.offset[1] == pytest.approx(flexibility * tan, rel=sharp, abs=0)
        inertia = weight * shape.offset[0] ** 2 + carriage * shape.offset[1] ** 2
        assert shape.moment_of_inertia == pytest.approx(inertia, rel=1e-15, abs=0)


def test_shapes_at_exactly_a_critical_speed_are_not_called_complete_wrongly():
    rig = rigged(bob(1.0, 0.75), stiffness=4.0)
    assert len(rc.steady_shapes(rig, conical_height=1.0)) == 0
    assert rc.steady_shapes(rig, conical_height=1.0 + 1e-12).complete
    (below,) = rc.steady_shapes(rig, conical_height=1.0 - 1e-9)
    assert below.inclination[0] == pytest.approx(math.acos((0.75 - 1e-9) / 0.75), rel=1e-6)


def test_every_shape_of_a_driven_chain():
    """100 links against the chain without end, integrated from its free end for every tip: five shapes."""
    length, hand, height = 0.36, 0.005, G / (2 * np.pi * 3.0) ** 2

    def missed(tip):
        def change(s, state):  # offset and horizontal pull, up along the chain
            return [-state[1] / np.hypot(state[1], s), state[0] / height]

        start = 1e-6
        first = [tip - start * tip / np.hypot(tip, height), tip * start / height]
        return solve_ivp(change, (start, length), first, rtol=1e-10, atol=1e-13, method="DOP853").y[0, -1] - hand

    tips = np.linspace(-0.36, 0.364, 363)
    ends = np.array([missed(tip) for tip in tips])
    crossed = np.flatnonzero(ends[:-1] * ends[1:] < 0)
    exact = [brentq(missed, tips[i], tips[i + 1], xtol=1e-12) for i in crossed]
    shapes = rc.steady_shapes(rigged(rc.Chain.uniform_rods(100, length=length), radius=hand), conical_height=height)
    assert shapes.complete
    np.testing.assert_allclose(sorted(shape.offset[0] for shape in shapes), exact, rtol=0, atol=5e-5)  # 4e-5


def test_long_chains_on_arms_and_a_budget_that_ends():
    rig = rigged(rc.Chain.uniform_rods(60, length=1.0), radius=0.05)
    many = rc.steady_shapes(rig, conical_height=0.3)
    assert len(many) == 3
    for shape in many:
        assert shape.residual <= 1e-14
        assert figure_moments(rig, shape) <= 1e-14
    nine = rigged(rc.Chain.uniform_plummets(9, length=9.0), radius=0.1)
    assert not rc.steady_shapes(nine, conical_height=0.01, budget=5000).complete


# ---- flywheels, floats, standing links


@pytest.mark.parametrize("lean", [0.05, 0.7, 1.5])
@pytest.mark.parametrize("sense", [1, -1])
def test_steady_precession_of_a_gyrostat_is_the_textbook_tops(lean, sense):
    # A' cos(th) phi'^2 - C w phi' + W h = 0 with th = pi - lean, C w = -H
    weight, h, rho, momentum = 10.0, 0.5, 0.3, 4.0
    about = weight / G * (h * h + rho * rho)
    n = [x for x in np.roots([about * math.cos(lean), -momentum, -weight * h]) if x * sense > 0][0]
    rig = rigged(rc.Chain(weight=weight, length=[1.0], centroid=h, radius_of_gyration=rho), momentum=momentum)
    if weight * h + n * momentum <= 0:
        pytest.skip("no effective tension")
    cosine = (weight * h + momentum * n) / (about * n * n)
    for asked in ({"angular_speed": abs(n)}, {"conical_height": G / n**2}):
        shapes = rc.steady_shapes(rig, **asked, direction=sense)
        assert shapes.complete
        assert [s.inclination[0] for s in shapes] == pytest.approx([lean], abs=1e-12)
        assert np.cos(shapes[0].inclination[0]) == pytest.approx(cosine, rel=1e-14)
        want = about * (1 - cosine**2) * n + momentum * cosine
        assert shapes[0].angular_momentum == pytest.approx(want, rel=1e-14)
    assert Motion(rig, n).run(shapes[0].inclination, 0.0, turns=1) < 1e-8


def test_three_gyrostats_turn_as_one_piece_in_both_senses():
    chain = rc.Chain(weight=[2.0, 3.0, 1.5], length=[0.4, 0.3, 0.5], centroid=[0.2, 0.15, 0.3], radius_of_gyration=0.15)
    momentum, axial_moment = np.array([0.25, -0.1, 0.4]), np.array([0.02, 0.0, 0.01])
    rig = rigged(chain, momentum=momentum, axial_moment=axial_moment)
    for sense, speed in itertools.product((1, -1), (8.0, 14.0)):
        try:
            shapes = rc.steady_shapes(rig, angular_speed=speed, direction=sense)
        except ValueError as error:
            assert "tension" in str(error)
            continue
        for shape in shapes:
            assert figure_moments(rig, shape, sense=sense) <= 2e-14
            axial = momentum + axial_moment / G * sense * speed * np.cos(shape.inclination)
            assert Motion(rig, sense * speed, axial=axial).run(shape.inclination, 0.0, turns=0.4) < 1e-8


def test_an_effective_tension_may_be_negative():
    turned = rigged(bob(), momentum=0.75)
    assert len(rc.steady_shapes(turned, angular_speed=4.0, direction=-1)) == 0
    (shape,) = rc.steady_shapes(turned, angular_speed=4.0, direction=-1, hanging_only=False, gravity=4.0)
    assert np.cos(shape.inclination[0]) == pytest.approx((1 - 0.75 * 4.0) / (4.0**2 / 4.0), abs=1e-15)


def test_figures_of_a_float_at_any_inclination():
    chain = rc.Chain(weight=[2.0, 5.0, 3.0], length=[0.6, 0.5, 0.4], centroid=[0.3, 0.25, 0.2], radius_of_gyration=0.15)
    for fluid, added in (("still", [0.5, 0.5, 0.2]), ("turning", 0.0)):
        rig = rigged(chain, displaced=[1.5, 1.0, 3.5], added=added, fluid=fluid)
        height = 0.5 * rc.modes(rig).conical_height[0]
        shapes = rc.steady_shapes(rig, conical_height=height)
        assert len(shapes) >= 1
        for shape in shapes:
            assert figure_moments(rig, shape) <= 1e-14
            if fluid == "still":
                assert Motion(rig, math.sqrt(G / height)).run(shape.inclination, 0.0, turns=0.4) < 1e-8


def test_broomstick_at_any_inclination_and_in_motion():
    h, rho, thread = 0.6, 0.6 / 3**0.5, 1.0
    first = float(rc.two_links.standing_link(thread, centroid=h, radius_of_gyration=rho))
    chain = rc.Chain(weight=[2.0, 0.0], length=[1.2, thread], centroid=[h, thread], radius_of_gyration=[rho, 0.0])
    rig = rigged(chain, inverted=[True, False])
    for height in (0.95 * first, 0.6 * first):
        closed = rc.two_links.standing_link_shape(thread, centroid=h, radius_of_gyration=rho, height=height)
        (shape,) = rc.steady_shapes(rig, conical_height=height)
        lean = np.abs(shape.inclination)
        assert [math.pi - lean[0], lean[1]] == pytest.approx(np.abs(closed.inclination), abs=1e-12)
        assert figure_moments(rig, shape) <= 1e-14
    # with some weight in the lower link, the full motion stays for a while
    chain = rc.Chain(weight=[2.0, 0.5], length=[1.2, 1.0], centroid=[h, 0.5], radius_of_gyration=[rho, 0.3])
    rig = rigged(chain, inverted=[True, False])
    height = 0.7 * rc.modes(rig).conical_height[0]
    for shape in rc.steady_shapes(rig, conical_height=height):
        assert figure_moments(rig, shape) <= 1e-14
        assert Motion(rig, math.sqrt(G / height)).run(shape.inclination, 0.0, turns=0.3) < 1e-7


# ---- what is refused, pictures


def test_what_is_known_of_chains_alone():
    (shape,) = rc.steady_shapes(rigged(bob(), radius=0.1), conical_height=2.0)
    for method in (shape.force_diagram, shape.transferred_to_axis):
        with pytest.raises(ValueError, match=f"SteadyShape.{method.__name__}"):
            method()


@pytest.mark.parametrize("sense", [0, 2, 1.0, True, "1"])
def test_senses_that_are_none(sense):
    with pytest.raises(ValueError, match="direction must be"):
        rc.steady_shapes(bob(), conical_height=0.5, direction=sense)


def test_pictures_show_the_arm():
    pytest.importorskip("matplotlib")
    shapes = rc.steady_shapes(rigged(bob(), radius=0.25), conical_height=0.2)
    assert shapes.plot().get_title() == f"{len(shapes)} hanging shapes, proved complete"
    for axes in (shapes.plot(), shapes[0].plot()):
        assert any(list(line.get_xdata()) == [0.0, 0.25] for line in axes.get_lines())
        axes.figure.canvas.draw()
