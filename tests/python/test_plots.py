# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures: everything asked for is in them, inside the frame, and nothing else is touched."""

import numpy as np
import pytest
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.patches import Ellipse, Polygon
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import revchain as rc
from revchain.plots.modes import SPACING
from revchain.plots.style import SPEED_UNITS

RODS = rc.modes(rc.Chain.uniform_rods(120, length=0.36), count=8)


def texts(axes):
    return [label.get_text() for label in axes.get_xticklabels()]


def clipped(axes):
    """The texts that leave the picture."""
    figure = axes.figure
    FigureCanvasAgg(figure).draw()
    labels = [axes.title, axes.xaxis.label, axes.yaxis.label]
    for axis, ends in ((axes.xaxis, axes.get_xlim()), (axes.yaxis, axes.get_ylim())):  # other ticks are not drawn
        ticks = zip(axis.get_ticklocs(), axis.get_ticklabels(), strict=True)
        labels += [label for tick, label in ticks if min(ends) <= tick <= max(ends)]
    boxes = [(label.get_text(), label.get_window_extent()) for label in labels if label.get_text()]
    assert len(boxes) > 4
    frame = figure.bbox
    inside = lambda box: frame.x0 <= box.x0 and box.x1 <= frame.x1 and frame.y0 <= box.y0 and box.y1 <= frame.y1  # noqa: E731
    return [text for text, box in boxes if not inside(box)]


def overlapping(axes):
    FigureCanvasAgg(axes.figure).draw()
    boxes = [label.get_window_extent() for label in axes.get_xticklabels()]
    return any(left.x1 > right.x0 for left, right in zip(boxes[:-1], boxes[1:], strict=True))


@pytest.mark.parametrize("modes", [None, [1], [8, 3], range(1, 9)])
@pytest.mark.parametrize("gravity", [9.80665, 1.62e-7])
def test_modes(modes, gravity):
    result = RODS.with_gravity(gravity)
    axes = result.plot(modes=modes)
    assert isinstance(axes, Axes) and axes.get_ylabel() == "depth below the support (m)"
    chosen = list(range(1, 7)) if modes is None else list(modes)
    labels = [label.get_text() for label in axes.get_xticklabels()]
    assert [text.splitlines()[0] for text in labels] == ["at rest", *(f"mode {mode}" for mode in chosen)]
    speeds = result.rpm
    assert all(f"{speeds[mode - 1]:#.4g}".removesuffix(".") + " rpm" in text for mode, text in zip(chosen, labels[1:], strict=True))
    assert axes.yaxis_inverted() or axes.get_ylim()[0] > axes.get_ylim()[1]
    assert clipped(axes) == [] and not overlapping(axes)


def curve_of(axes, mode):
    return next(line for line in axes.lines if line.get_label() == f"mode {mode}")


def test_curves_and_nodes_are_where_they_belong():
    axes = RODS.plot(modes=[3])
    np.testing.assert_allclose(curve_of(axes, 3).get_xdata() - SPACING, RODS.shape[2], atol=1e-15)
    np.testing.assert_allclose(curve_of(axes, 3).get_ydata(), np.linspace(0.36, 0.0, 121), atol=1e-15)
    rings = next(line for line in axes.lines if len(line.get_xdata()) == 2 and line.get_marker() == "o")
    np.testing.assert_allclose(rings.get_ydata(), 0.36 - RODS.nodes[2])


def test_a_long_chain_is_thinned_and_keeps_its_extremes():
    result = rc.modes(rc.Chain.uniform_rods(10_000), count=40)
    for mode in (1, 40):
        curve, offset = curve_of(result.plot(modes=[mode]), mode).get_xdata(), SPACING + result.shape[mode - 1]
        assert len(curve) <= 2100
        assert [curve.max(), curve.min()] == pytest.approx([offset.max(), offset.min()], rel=1e-15)
        signs = np.sign(curve[:-1] - SPACING)
        assert (signs[1:] != signs[:-1]).sum() == mode - 1


@pytest.mark.parametrize("tip", [0.01, 0.5, 20.0])
def test_every_mode_is_as_wide_as_its_column(tip):
    """Shapes are 1 at the free end; below a heavy tip a cord is hundreds of times as far out in between."""
    cord = rc.Cord(2.0, mass=0.5, tip_mass=tip)
    for system in (cord, cord.chain(40)):
        axes = rc.modes(system, 4).plot()
        for number in range(1, 5):
            assert np.abs(curve_of(axes, number).get_xdata() - number * SPACING).max() == pytest.approx(1)


def test_pins_are_dots_where_they_are_few():
    few = rc.modes(rc.Chain.uniform_plummets(5)).plot(modes=[1])
    assert curve_of(few, 1).get_marker() == "o"
    assert curve_of(RODS.plot(modes=[1]), 1).get_marker() in ("", "None")


def test_the_axes_given_are_used():
    axes = Figure().add_subplot()
    assert RODS.plot(axes) is axes
    assert RODS.system.plot(ax=axes) is axes


@pytest.mark.parametrize(
    "chain",
    [
        rc.Chain(weight=1.0, length=1.0),
        rc.Chain(weight=[176.0, 4900.0], length=[0.65, 0.15], centroid=[0.5, 0.05], radius_of_gyration=0.3),
        rc.Chain(weight=10.0 ** np.arange(10), length=1.0),
        rc.Chain(weight=[1.0, 0.0, 2.0], length=0.1),
        rc.Chain.uniform_rods(10_000, length=1520.0, weight=4.7e5),
    ],
)
def test_chain(chain):
    axes = chain.plot()
    assert axes.get_ylabel() == "depth below the support (m)"
    assert clipped(axes) == []
    low, high = sorted(axes.get_ylim())
    middle = np.cumsum(chain.length[::-1])[::-1] - chain.length + chain.centroid
    assert low <= middle.min() and middle.max() <= high and low <= 0 and chain.total_length <= high


@pytest.mark.parametrize("modes", [[0], [9], [1, -1], [1.5], ["1"], []])
def test_modes_refused(modes):
    with pytest.raises(ValueError, match="mode"):
        RODS.plot(modes=modes)


def test_nothing_global_is_touched(python):
    program = """


import matplotlib, sys, revchain as rc
before = matplotlib.rcParams.copy()
axes = rc.modes(rc.Chain.uniform_rods(3)).plot()
axes.figure.savefig("modes.png")
assert "matplotlib.pyplot" not in sys.modules
assert matplotlib.rcParams.copy() == before
import matplotlib.pyplot as plt
plt.switch_backend("agg")
axes = rc.modes(rc.Chain.uniform_rods(3)).plot()
assert plt.get_fignums() == [axes.figure.number]  # so that plt.show() shows it
"""
    done = python("-c", program)
    assert done.returncode == 0, done.stderr


TORTUOUS = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
SWING = rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5)


@pytest.mark.parametrize(
    "thing",
    [rc.SkippingRope(span=2.0, length=3.0), rc.SkippingRope(span=2.0, sag=1e3, half_waves=3, angular_speed=1.0), TORTUOUS, SWING],
    ids=repr,
)
def test_ropes_and_governor(thing):
    axes = thing.plot()
    assert isinstance(axes, Axes)
    assert clipped(axes) == []
    assert thing.plot(axes) is axes


def test_governor_that_never_returns_asks_for_a_duration():
    swing = rc.GovernorMotion(angular_speed=0.0, pendulum_length=1.0, angle=0.0, angle_rate=2 * 9.80665**0.5)
    assert swing.regime == "asymptotic" and len(swing.plot(duration=3.0).lines) == 3
    for draw, words in (
        (swing.plot, "give duration"),
        (lambda: SWING.plot(duration=-1.0), "duration must be positive"),
        (lambda: TORTUOUS.plot(half_waves=0.0), "half_waves must be positive"),
    ):
        with pytest.raises(ValueError, match=words):
            draw()


UNITS = {
    "rad/s": lambda speed: speed,
    "rpm": lambda speed: speed * 30 / np.pi,
    "Hz": lambda speed: speed / (2 * np.pi),
    "s": lambda speed: 2 * np.pi / speed,
}
LABELS = {"rad/s": "speed (rad/s)", "rpm": "speed (rpm)", "Hz": "frequency (Hz)", "s": "period (s)"}
THREE = rc.Chain(mass=[1.0, 1.0, 1.0], length=1.0)
TOP = rc.Rig(rc.Chain(mass=1.0, length=1.0), flywheels=rc.Flywheel(momentum=0.2))
STRING = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0)


def test_each_unit_is_tested():
    assert SPEED_UNITS.keys() == UNITS.keys() == LABELS.keys()


@pytest.mark.parametrize("unit", UNITS)
def test_axes_of_speeds(unit):
    in_unit, branches = UNITS[unit], rc.branches(THREE, max_angular_speed=14.0)
    axes = branches.plot(speed=unit, stability=False)
    assert axes.get_xlabel() == LABELS[unit]
    for branch in branches:
        points = np.column_stack([in_unit(branch.angular_speed), np.degrees(branch.lowest_inclination)])
        drawn = [line.get_xydata() for line in axes.lines if len(line.get_xdata()) == len(points)]
        assert any(np.allclose(points, line, rtol=1e-14) for line in drawn)
    fold = next(branch for branch in branches if branch.mode is None)
    (above,) = axes.child_axes
    marks = [fold.angular_speed[fold.folds].min(), *rc.modes(THREE).angular_speed]
    np.testing.assert_allclose(np.sort(above.get_xticks()), np.sort(in_unit(np.array(marks))), rtol=1e-13)
    assert branches[0].plot(speed=unit).get_xlabel() == LABELS[unit]

    speeds = np.linspace(1.0, 9.0, 50)
    axes = rc.response(THREE, angular_speed=speeds).plot(pins=[0], speed=unit)
    assert axes.get_xlabel() == LABELS[unit] and clipped(axes) == []
    np.testing.assert_allclose(axes.lines[0].get_xdata(), in_unit(speeds), rtol=1e-14)
    marked = [line.get_xdata()[0] for line in axes.lines if line.get_linestyle() == "-."]
    np.testing.assert_allclose(marked, in_unit(rc.modes(THREE).angular_speed), rtol=1e-14)
    axes = STRING.plot(speed=unit)
    assert axes.get_ylabel() == LABELS[unit]
    wave = in_unit(STRING.angular_speeds(np.linspace(0.0, np.pi, 200)[1:]).forward)
    np.testing.assert_allclose(axes.lines[0].get_ydata(), wave, rtol=1e-14)


@pytest.mark.parametrize("unit", UNITS)
def test_labels_with_speeds(unit):
    said = f"{UNITS[unit](4.0):#.4g} {unit}"
    shapes = rc.steady_shapes(THREE, angular_speed=4.0)
    assert shapes.plot(speed=unit).get_legend().get_title().get_text() == f"at {said}"
    assert shapes[0].plot(speed=unit).get_legend().get_texts()[0].get_text() == f"1 half wave\n{said}"
    carried = rc.response(THREE, angular_speed=4.0)
    assert carried.plot(speed=unit).get_xlabel() == f"offset from the axis (m) at {said}"
    rope = rc.SkippingRope(span=2.0, length=3.0, angular_speed=4.0)
    assert rope.plot(speed=unit).get_legend().get_texts()[0].get_text() == said
    modes = rc.modes(THREE)
    expected = [f"mode {k + 1}\n{UNITS[unit](modes.angular_speed[k]):#.4g} {unit}" for k in range(3)]
    axes = modes.plot(speed=unit, carried=carried)
    assert texts(axes) == ["at rest\n", f"carried round\n{said}", *expected] and clipped(axes) == []


def test_modes_without_a_unit_say_two():
    modes = rc.modes(TOP)
    assert modes.angular_speed.min() < 0  # the period of a backward mode is positive
    for text, speed in zip(texts(modes.plot())[1:], modes.angular_speed, strict=True):
        numbers = [f"{speed * 30 / np.pi:#.4g} rpm".replace("-", "\N{MINUS SIGN}"), f"{2 * np.pi / abs(speed):#.4g} s"]
        assert text.splitlines()[2:] == numbers


def test_periods_of_both_directions_are_apart():
    speeds = np.linspace(-12.0, 12.0, 200)
    line = rc.response(TOP, angular_speed=speeds).plot(pins=[0], speed="s").lines[0].get_xydata()
    assert line[0, 0] == pytest.approx(-2 * np.pi / 12) and line[-1, 0] == pytest.approx(2 * np.pi / 12)
    assert len(line) == 201 and not np.isfinite(line[100]).any()  # the curve breaks at rest


PLOTS_WITH_SPEEDS = [
    RODS, rc.branch(THREE, 1, max_angular_speed=5.0), rc.branches(THREE, max_angular_speed=5.0), STRING,
    rc.steady_shapes(THREE, angular_speed=4.0), rc.steady_shapes(THREE, angular_speed=4.0)[0],
    rc.response(THREE, angular_speed=[1.0, 2.0]), rc.SkippingRope(span=2.0, length=3.0),
]  # fmt: skip


@pytest.mark.parametrize("thing", PLOTS_WITH_SPEEDS, ids=lambda thing: type(thing).__name__)
@pytest.mark.parametrize("wrong", ["RPM", "turns", "", 1, ("rpm",)])
def test_other_units_are_refused(thing, wrong):
    with pytest.raises(ValueError, match=rf"revchain.{type(thing).__name__}.plot: speed must be one of rad/s, rpm, Hz, s, got"):
        thing.plot(speed=wrong)
    assert "speed : str, optional\n    Unit of the speeds" in type(thing).plot.__doc__


def test_bodies_are_drawn_in_the_forms_of_their_names():
    """A bell below its axle, its clapper about the centre of gravity; a person up from his feet, as wide as in life."""
    links = {"length": [0.65, 0.15], "centroid": [0.52, 0.05], "radius_of_gyration": [0.2, 0.36]}
    axes = rc.Chain(mass=[18.0, 500.0], names=["clapper", "church bell"], **links).plot()
    bell = max((patch.get_xy() for patch in axes.patches if isinstance(patch, Polygon)), key=len)
    assert [bell[:, 1].min(), bell[:, 1].max()] == pytest.approx([0.14 * 0.36, 2.511 * 0.36])
    assert bell[:, 0].min() == pytest.approx(-bell[:, 0].max()) and np.abs(bell[[0, -2]]).min() == 0
    [ball] = [patch for patch in axes.patches if isinstance(patch, Ellipse)]
    assert ball.get_center()[1] == pytest.approx(0.15 + 0.52)
    FigureCanvasAgg(axes.figure).draw()
    assert ball.get_window_extent().width == pytest.approx(ball.get_window_extent().height)
    man = rc.Rig(rc.Chain(mass=[75.0], length=1.75, centroid=1.0, radius_of_gyration=0.48, names=["man"]), inverted=True).plot()
    levels = [patch.get_center()[1] for patch in man.patches if isinstance(patch, Ellipse)]
    assert levels == pytest.approx([0.64 * 1.75, 0.91 * 1.75])
    assert len(rc.Chain(mass=[1.0, 2.0], length=1.0).plot().patches) == 0


def test_rods_are_bars_from_end_to_end_and_rings_are_nodes():
    """Greenhill's jointed rod goes on above its pin, at rest and in each mode; other bodies are no bars."""
    found = rc.modes(rc.Chain(mass=[0.36, 0.84], length=[0.36, 0.49], centroid=[0.18, 0.07], pendulum_length=[0.24, 0.91]))
    axes = found.plot()
    [bars] = [each for each in axes.collections if isinstance(each, LineCollection) and each.get_linewidth()[0] == 6]
    np.testing.assert_allclose([path.vertices[:, 1] for path in bars.get_paths()], [[0.49, 0.85], [-0.35, 0.49]])
    assert sum(line.get_ydata()[-1] == pytest.approx(-0.35) for line in axes.lines) == 2
    assert "rings: nodes" in axes.get_xlabel() and "rings" not in found.plot(modes=[1]).get_xlabel()
    floats = rc.modes(rc.Rig(rc.Chain(mass=[17.7] * 3, length=2.0), inverted=True, displaced=rc.Displaced(mass=43.0)))
    rings = [line.get_ydata() for line in floats.plot().lines if line.get_gid() == "nodes"]
    np.testing.assert_allclose(np.concatenate(rings), 6.0 - np.concatenate([*floats.nodes]))
