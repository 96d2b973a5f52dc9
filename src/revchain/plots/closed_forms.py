# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of the closed forms of the paper, and force diagrams."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ..closed_forms.table import described
from ..systems.numbers import count, one_positive, refuse_beyond_memory, shown
from .forms import colour_of, forms
from .style import (
    AXIS, BLUE, ORANGE, WIDEST, SpeedUnit, axes_or_new, checked_axes, house, keep_room, legend_outside, new_figure,
)

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..closed_forms.bell import BellAndClapper
    from ..closed_forms.governor import GovernorEquilibria, SleeveGovernor
    from ..closed_forms.motions import GovernorMotion, SkippingRope, TortuousRope
    from ..closed_forms.strings import FunicularPolygon, GyrostaticString
    from ..results.diagrams import ForceDiagram

BYTES = 64  # of a point of a curve
MAX_LETTERED = 8  # points of one kind with a letter each
MAX_LINKS_SEEN = 12  # of which the plane is drawn end on


def _two_axes(axes: tuple[Axes, Axes] | None, width: float, height: float) -> tuple[Axes, Axes]:
    """Return the two axes of the caller, or new axes side by side on a figure of their own."""
    if axes is None:
        left, right = new_figure(width, height).subplots(1, 2)
        return left, right
    two = list(axes) if isinstance(axes, Iterable) and getattr(axes, "ndim", 1) != 0 else []
    if len(two) != 2:
        raise TypeError(f"plot: axes must be two axes of matplotlib, got {shown(axes)}")
    return checked_axes(two[0]), checked_axes(two[1])


def _letter(
    ax: Axes, text: str, x: float, z: float, right: bool = True, color: str = "black", below: bool = False
) -> None:
    """Write a letter beside a point, to the right of it or to the left, above or below."""
    beside: dict[str, Any] = {"ha": "left" if right else "right", "va": "top" if below else "bottom", "color": color}
    ax.annotate(f"${text}$", (x, z), (5 if right else -5, -3 if below else 3), textcoords="offset points", **beside)


def _finish(ax: Axes, across: str, up: str, title: str) -> None:
    """Write what the axes are, and leave room for the letters."""
    ax.margins(0.12)
    ax.set(xlabel=across, ylabel=up, title=title, aspect="equal")
    keep_room(ax)
    ax.locator_params(axis="x", nbins=3 if ax.dataLim.height > 2.5 * ax.dataLim.width else 5)


@described(bound=True)
def plot_force_diagram(diagram: ForceDiagram, axes: tuple[Axes, Axes] | None = None) -> tuple[Axes, Axes]:
    """Draw the shape and its force diagram side by side.

    Up to 8 links have the letters of Fig. 3 of the paper.

    returns: Axes of the shape and of the forces, with ON as the mean weight.

    >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=3.0), conical_height=0.5)[0]
    >>> figure, forces = shape.force_diagram().plot()
    >>> forces.get_title()
    'force diagram'
    """
    figure, forces = _two_axes(axes, WIDEST, 5.5)
    pin, ray, reaction, load = diagram.pin, diagram.ray, diagram.reaction, diagram.load
    count, height = len(ray), diagram.conical_height
    lettered = count <= MAX_LETTERED
    plummets = bool(np.array_equal(ray, reaction))
    centre = diagram.centre_of_gravity

    figure.axvline(0.0, **AXIS)
    for m in range(count):
        figure.plot(*pin[m : m + 2].T, color=house(m), linewidth=1.8, zorder=3)
    figure.plot(*pin[:-1].T, linestyle="none", marker="o", markersize=5.0, color="black", zorder=4)
    figure.plot(0.0, 0.0, marker="v", color="black", markersize=8.0, zorder=4)
    if lettered:
        for m in range(count):
            _letter(figure, f"P_{m + 1}", pin[m, 0], pin[m, 1], right=bool(pin[m, 0] >= 0))
        for m in range(count):  # G, H, K: the direction of thread or reaction above
            x, z = centre[m]
            colour = house(m)
            figure.plot([x, 0.0, 0.0], [z, z, z + height], color=colour, linewidth=0.9, linestyle=":", zorder=2)
            figure.plot([0.0, x], [z + height, z], color=colour, linewidth=0.9, linestyle="--", zorder=2)
            _letter(figure, f"K_{m + 1}", 0.0, z + height, right=bool(x < 0), color=colour)
            if m > 0:
                figure.plot(x, z, marker="+", color=colour, zorder=3)
                _letter(figure, f"G_{m + 1}", x, z, right=bool(x < 0), color=colour, below=True)
    _finish(figure, "distance from axis (m)", "height above the support (m)", "funicular polygon")

    total = float(ray[-1, 1])
    scale = total / count / height  # ON as the mean weight
    forces.plot([0.0, 0.0], [-scale * height, total], color="0.4", linewidth=0.9, zorder=1)
    level = np.cumsum(-load[:, 1])
    corners = np.concatenate([[[0.0, 0.0]], ray])
    for m in range(count):
        colour = house(m)
        forces.plot([0.0, ray[m, 0]], [0.0, ray[m, 1]], color=colour, linewidth=1.8, zorder=3)
        forces.plot(*corners[m : m + 2].T, color="0.4", linewidth=1.0, zorder=2)
        forces.plot([0.0, ray[m, 0]], [level[m], level[m]], color="0.7", linewidth=0.8, linestyle=":", zorder=1)
        if not plummets:
            label = "reaction at the upper pin" if m == 0 else None
            forces.plot([0.0, reaction[m, 0]], [0.0, reaction[m, 1]], color=colour, linestyle="--", label=label)
        if np.isfinite(diagram.lifted[m]):
            x = scale * diagram.lifted[m]
            forces.plot([0.0, x], [0.0, -scale * height], color=colour, linewidth=0.9, linestyle="-.", zorder=2)
            forces.plot(x, -scale * height, marker="o", markersize=4.0, color="black", zorder=4)
            if lettered:
                _letter(forces, f"P_{m + 1}", x, -scale * height, right=bool(x >= 0), below=True)
        if lettered:
            _letter(forces, f"Q_{m + 1}", ray[m, 0], ray[m, 1], right=bool(ray[m, 0] >= 0))
            _letter(forces, f"W_{m + 1}", 0.0, level[m] + 0.5 * load[m, 1], right=bool(ray[m, 0] < 0), color="0.4")
    reach = [0.0, *(scale * x for x in diagram.lifted if np.isfinite(x))]
    forces.plot([min(reach), max(reach)], [-scale * height] * 2, color="0.6", linewidth=0.9, zorder=1)
    _letter(forces, "O", 0.0, 0.0, right=bool(ray[0, 0] < 0))
    _letter(forces, "N", 0.0, -scale * height, right=False, below=True)
    _finish(forces, "horizontal force (N)", "vertical force (N)", "force diagram")
    if not plummets:
        legend_outside(forces)
    return figure, forces


@described(bound=True)
def plot_funicular_polygon(
    polygon: FunicularPolygon, axes: tuple[Axes, Axes] | None = None
) -> tuple[Axes, Axes]:
    """Draw the polygon and its force diagram side by side, sides and rays in the same colours.

    returns: Axes of the polygon and of the force diagram.

    >>> line = rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], horizontal_tension=0.5)
    >>> polygon, forces = line.plot()
    >>> polygon.get_title()
    'funicular polygon'
    """
    left, forces = _two_axes(axes, WIDEST, 4.0)
    x, z, rise, pull = polygon.position, polygon.height, polygon.rise, polygon.horizontal_tension
    lettered = len(x) - 2 <= MAX_LETTERED
    line = max(float(z.max()), 0.0) + 0.12 * (float(x[-1] - x[0]))
    left.plot([x[0], x[-1]], [line, line], color="0.4", linewidth=1.0)
    left.vlines(x[1:-1], z[1:-1], line, color="0.7", linewidth=0.8, linestyle=":")
    left.plot(x[1:-1], np.full(len(x) - 2, line), linestyle="none", marker="o", markersize=5.0, color="0.4")
    for j in range(len(x) - 1):
        left.plot(x[j : j + 2], z[j : j + 2], color=house(j), linewidth=1.8)
        forces.plot([0.0, pull], [0.0, rise[j]], color=house(j), linewidth=1.8)
    left.plot(x[1:-1], z[1:-1], linestyle="none", marker="o", markersize=5.0, color="black")
    left.plot(x[[0, -1]], z[[0, -1]], linestyle="none", marker="^", markersize=7.0, color="black")
    forces.plot([pull, pull], [rise[0], rise[-1]], color="0.4", linewidth=1.2)
    forces.plot(np.full(len(rise), pull), rise, linestyle="none", marker="_", color="0.4")
    _letter(forces, "O", 0.0, 0.0, right=False)
    if lettered:
        for j in range(1, len(x) - 1):
            _letter(left, f"P_{j}", x[j], z[j], below=True)
            _letter(forces, f"W_{j}", pull, 0.5 * float(rise[j - 1] + rise[j]))
    _finish(left, "horizontal distance (m)", "height (m)", "funicular polygon")
    _finish(forces, "horizontal force (N)", "vertical force (N)", "force diagram")
    return left, forces


@described(bound=True)
def plot_skipping_rope(rope: SkippingRope, ax: Axes | None = None, *, speed: str | None = None) -> Axes:
    """Draw the rope seen from the side.

    >>> rc.SkippingRope(span=2.0, length=3.0).plot().get_xlabel()
    'along the axis (m)'
    """
    unit = SpeedUnit("revchain.SkippingRope.plot", speed, rope)
    refuse_beyond_memory("revchain.SkippingRope.plot", "half_waves", rope.half_waves, 200 * BYTES)
    ax = axes_or_new(ax, 6.4, 4.0)
    points = rope.at_arc(np.linspace(0.0, rope.length, 200 * rope.half_waves + 1))
    ax.axhline(0.0, **AXIS)
    label = unit.text(rope.angular_speed) if rope.has_speed else f"length {rope.length:.4g}"
    ax.plot(points.x, points.offset, color=BLUE, linewidth=1.6, label=label)
    ax.set(xlabel="along the axis (m)", ylabel="distance from axis (m)", aspect="equal")
    legend_outside(ax)
    return ax


@described(bound=True)
def plot_tortuous_rope(rope: TortuousRope, ax: Axes | None = None, *, half_waves: float = 4.0) -> Axes:
    """Draw the rope seen along the axis, with the circles of its smallest and largest distance.

    half_waves: Number of half waves to draw, from a point nearest to the axis; positive and finite

    >>> rope = rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0)
    >>> rope.plot().get_xlabel()
    'x (m)'
    """
    half_waves = one_positive("revchain.TortuousRope.plot", "half_waves", half_waves)
    refuse_beyond_memory("revchain.TortuousRope.plot", "half_waves", int(half_waves), 200 * BYTES)
    ax = axes_or_new(ax, 5.0, 5.0)
    points = rope.at(np.linspace(0.0, half_waves * rope.half_wave, 1 + int(200 * max(half_waves, 1.0))))
    round_ = np.linspace(0.0, 2 * np.pi, 200)
    for radius in {rope.least_radius, rope.greatest_radius} - {0.0}:
        ax.plot(radius * np.cos(round_), radius * np.sin(round_), color="0.7", linestyle="--", linewidth=0.9)
    ax.plot(points.radius * np.cos(points.angle), points.radius * np.sin(points.angle), color=BLUE, linewidth=1.6)
    ax.plot(0.0, 0.0, marker="+", color="0.4")
    ax.set(
        xlabel="x (m)",
        ylabel="y (m)",
        title=f"seen along the axis: {np.degrees(rope.half_wave_angle):.4g}° in {rope.half_wave:.3g} m",
        aspect="equal",
    )
    return ax


@described(bound=True)
def plot_governor(motion: GovernorMotion, ax: Axes | None = None, *, duration: float | None = None) -> Axes:
    """Draw the angle against time, with its smallest and largest values.

    duration: Length of the time axis in s; if left out two periods, or 1 s if the angle is constant.
    raises: If the motion never returns and no `duration` is given, or if `duration` is not positive and finite.

    >>> rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5).plot().get_ylabel()
    'angle (degrees)'
    """
    caller = "revchain.GovernorMotion.plot"
    if duration is None:
        if motion.regime == "asymptotic":
            raise ValueError(f"{caller}: give duration: the motion never returns")
        duration = 2 * motion.period if motion.period > 0 else 1.0
    time = np.linspace(0.0, one_positive(caller, "duration", duration), 801)
    ax = axes_or_new(ax, 6.4, 4.0)
    for angle in (motion.least_angle, motion.greatest_angle):
        if np.isfinite(angle):
            ax.axhline(np.degrees(angle), color="0.6", linestyle=":", linewidth=0.9, zorder=1)
    ax.plot(time, np.degrees(motion.state(time).angle), color=BLUE, linewidth=1.6)
    period = f", period {motion.period:.4g} s" if 0 < motion.period < np.inf else ""
    ax.set(xlabel="time (s)", ylabel="angle (degrees)", title=f"{motion.regime}{period}")
    return ax


@described(bound=True)
def plot_sleeve_governor(governor: SleeveGovernor, ax: Axes | None = None, *, speed: str | None = None) -> Axes:
    """Draw the lift of the sleeve against the speed, grey where friction holds it, dashed where it is unstable.

    Without a sleeve the distance of the balls from the axis is drawn.

    >>> hartnell = rc.SleeveGovernor(ball_mass=1.5, arm=0.12, pivot_offset=0.12, sleeve_arm=0.06, sleeve_mass=2.0,
    ...     spring_stiffness=5000.0, spring_force=150.0, friction=5.0, lowest_inclination=-0.2, highest_inclination=0.3)
    >>> hartnell.plot().get_xlabel()
    'speed (rpm)'
    """
    unit = SpeedUnit("revchain.SleeveGovernor.plot", speed, governor, "rpm")
    ax = axes_or_new(ax, 6.4, 4.0)
    low, *_, high = governor._sheet().columns[0].values.tolist()
    at = governor.at(np.linspace(low, high, 300))
    lift, turning = np.asarray(at.lift), np.asarray(at.angular_speed)
    if governor._given["sleeve_arm"] == governor._given["lower_arm"] == 0:  # no sleeve: the balls instead
        lift = np.asarray(at.ball_radius)
    if governor._given["friction"]:
        ax.fill_betweenx(lift, unit.of(np.asarray(at.low_speed)), unit.of(np.asarray(at.high_speed)), color="0.85", zorder=1)
    for stable, style in ((True, "-"), (False, "--")):
        ax.plot(unit.of(np.where(np.asarray(at.stable) == stable, turning, np.nan)), lift, style, color=BLUE, linewidth=1.6)
    what = "lift of the sleeve (m)" if np.ptp(at.lift) else "balls off the axis (m)"
    ax.set(xlabel=unit.label, ylabel=what)
    return ax


@described(bound=True)
def plot_governor_equilibria(found: GovernorEquilibria, ax: Axes | None = None, *, speed: str | None = None) -> Axes:
    """Draw the curve of the governor and a dot at each equilibrium, hollow if it is unstable.

    >>> porter = rc.SleeveGovernor(ball_mass=2.3, arm=0.33, lower_arm=0.33, sleeve_mass=9.5122, gravity=9.81)
    >>> len(porter.equilibria("125 rpm").plot().lines) > len(porter.plot().lines)
    True
    """
    unit = SpeedUnit("revchain.GovernorEquilibria.plot", speed, found, "rpm")
    ax = plot_sleeve_governor(found.governor, ax, speed=unit.unit)
    given, at = found.governor._given, unit.of(found.angular_speed)
    ax.axvline(at, color="0.6", linewidth=0.9, zorder=0)
    places = found.lift if given["sleeve_arm"] or given["lower_arm"] else found.ball_radius
    for place, stable in zip(places, found.stable, strict=True):
        ax.plot(at, place, "o", color=BLUE, fillstyle="full" if stable else "none", markersize=6)
    return ax


@described(bound=True)
def plot_waves(string: GyrostaticString, ax: Axes | None = None, *, speed: str | None = None) -> Axes:
    """Draw the speeds of circular waves in both directions against their phase.

    >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0)
    >>> string.plot().get_xlabel()
    'phase difference between links (degrees)'
    """
    unit = SpeedUnit("revchain.GyrostaticString.plot", speed, string)
    ax = axes_or_new(ax, 6.4, 4.0)
    phase = np.linspace(0.0, np.pi, 200)[1:]
    speeds = string.angular_speeds(phase)
    both = [unit.of(speeds.forward), unit.of(-speeds.backward)]
    labels = ["with the spin", "against the spin"][:: 1 if string.momentum >= 0 else -1]
    for y, color, label in zip(both, (BLUE, ORANGE), labels, strict=True):
        ax.plot(np.degrees(phase), y, color=color, label=label)
    ax.set(xlabel="phase difference between links (degrees)", ylabel=unit.label, xlim=(0, 180))
    usual = 2 * np.nanmedian(both)  # a wave of bodies without inertia across themselves has no bound at 180 degrees
    ax.set_ylim(0, usual if np.nanmax(both) > 3 * usual else None)
    legend_outside(ax)
    return ax


@described(bound=True)
def plot_vibration(string: GyrostaticString, angular_speed: float, links: int = 60, ax: Axes | None = None) -> Axes:
    """Draw the turning plane of a vibration along the string, from the side and from the end.

    angular_speed: Angular frequency of the vibration, rad/s
    links: Number of links to draw.
    raises: If one of the two circular waves does not pass at that speed.

    >>> string = rc.GyrostaticString(weight=9.80665, length=1.0, tension=100.0, momentum=1.0)
    >>> string.plot_vibration(8.0).get_xlabel()
    'link'
    """
    caller = "revchain.GyrostaticString.plot_vibration"
    speed = one_positive(caller, "angular_speed", angular_speed)
    links = count(caller, "links", links, each=64)
    turn = float(string.plane_rotation(speed))  # of the plane, from link to link
    if turn != turn:
        raise ValueError(f"{caller}: a circular wave does not pass at angular_speed, got {speed:g}")
    phase = float(string.phase(speed) + string.phase(-speed)) / 2
    ax = axes_or_new(ax, 8.0, 4.0)
    pin = np.arange(links + 1)
    wave, angle = np.cos(phase * pin), turn * pin
    ax.plot(pin, wave * np.cos(angle), color=BLUE, linewidth=1.2, label="in the initial plane")
    ax.plot(pin, wave * np.sin(angle), color=ORANGE, linewidth=1.2, label="perpendicular to it")
    for at in np.unique(np.linspace(0, links, min(MAX_LINKS_SEEN, links) + 1).astype(int)):
        across, along = 0.45 * np.sin(turn * at) * links / 30, 0.22 * np.cos(turn * at)
        ax.plot([at - across, at + across], [1.5 - along, 1.5 + along], color="black", linewidth=1.4)
    ax.annotate("plane of vibration, end on", (0.0, 1.85), fontsize="small")
    ax.set(xlabel="link", ylabel="offset / amplitude", ylim=(-1.7, 2.1), yticks=[-1, 0, 1])
    legend_outside(ax)
    return ax


@described(bound=True)
def plot_bell(bell: BellAndClapper, ax: Axes | None = None) -> Axes:
    """Draw bell and clapper at rest with their pendulum lengths.

    returns: The drawing. The outlines of the bell and its headstock are only illustrations.

    >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.05]}
    >>> rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.36])).plot().get_ylabel()
    'depth below axle (m)'
    """
    data = bell.present
    turned = -1.0 if bell.inverted[0] != bell.inverted[1] else 1.0  # the clapper points down, or up if it stands
    pin, h1, h2 = turned * data["joint"], data["clapper_centroid"], turned * data["bell_centroid"]
    gyration = data["clapper_radius_of_gyration"], data["bell_radius_of_gyration"]
    l1, l2 = (h + rho**2 / h if h else np.inf for h, rho in zip((h1, h2), gyration, strict=True))
    lip = pin + 1.3 * h1  # the ball is at the centroid of the clapper
    crown = max(0.0, pin - 0.15 * h1)
    ax = axes_or_new(ax, 8.5, 5.0)

    outline = np.array(forms()["profiles"]["bell"])
    wide, depth = (outline - [0, outline[0, 1]]).T * (lip - crown) / np.ptp(outline[:, 1])
    ax.fill([*wide, *-wide[::-1]], crown + np.array([*depth, *depth[::-1]]), colour_of("bronze", False), edgecolor="0.2")
    half, top = 0.32 * (lip - crown), min(-0.06 * h1, crown - 0.18 * h1)
    ax.fill([-half, half, half, -half], [crown, crown, top, top], color="0.88", edgecolor="0.45", zorder=1)
    ax.text(1.1 * half, (crown + top) / 2, "headstock", color="0.35", va="center", fontsize="small")
    ax.plot([0.0, 0.0], [pin, pin + bell.system.length[0]], color=ORANGE, linewidth=2.2, zorder=3)
    ax.plot(0.0, pin + h1, marker="o", markersize=13.0, color=ORANGE, zorder=3)
    marks = [
        (0.0, "axle", "^", "black"),
        (pin, "pin of the clapper", "o", ORANGE),
        (h2, "centroid of the bell", "x", "0.3"),
        (pin + h1, "centroid of the clapper", "x", "black"),
    ]
    for z, name, marker, colour in marks:
        ax.plot(0.0, z, marker=marker, linestyle="none", color=colour, markersize=8.0, label=name, zorder=4)
    side = -1.25 * wide.max()
    for x, start, length, name, colour in (
        (side, 0.0, l2, "bell: $l_2$", "0.3"),
        (0.82 * side, pin, l1, "clapper: $l_1$", ORANGE),
    ):
        if abs(length) > 3 * lip:  # too far to be drawn
            ax.plot([], [], color=colour, linewidth=1.2, label=f"pendulum length, {name} = {length:.4g} m")
            continue
        ax.plot([x, x], [start, start + length], color=colour, linewidth=1.2, marker="_", markersize=12.0)
        ax.annotate(name.split()[1], (x, start + length / 2), xytext=(5, 0), textcoords="offset points", color=colour)
    stands = bool(bell.inverted[0])
    depth_of = "height above" if stands else "depth below"
    ax.set(xlabel="distance from axle (m)", ylabel=f"{depth_of} axle (m)", aspect="equal")
    swing = bool((bell.conical_height > 0).all())
    which = ("slower" if bell.mode[0] == 1 else "faster") if swing else "first"
    ax.set_title(f"Clapper / bell in the {which} mode: {bell.inclination_ratio[0]:.3g}")
    ax.margins(0.1)
    if not stands and not ax.yaxis_inverted():
        ax.invert_yaxis()
    legend_outside(ax)
    return ax
