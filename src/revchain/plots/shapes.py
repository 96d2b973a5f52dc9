# SPDX-License-Identifier: GPL-3.0-or-later
"""Pictures of steady shapes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from ..closed_forms.table import described
from ..systems.numbers import word
from .modes import ARM, beside_at_rest, draw_spring
from .style import AXIS, MOST_PINS_AS_DOTS, SpeedUnit, axes_or_new, half_waves_style, house, keep_room
from .style import legend_outside, new_figure, thinned

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from ..results.drag import DragShape
    from ..results.shapes import SteadyShape, SteadyShapes


@described(bound=True)
def plot_shape(shape: SteadyShape, ax: Axes | None = None, *, speed: str | None = None) -> Axes:
    """Draw the shape, true to scale.

    >>> ax = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=1.0), conical_height=0.05)[0].plot()
    >>> ax.get_xlabel()
    'distance from axis (m)'
    """
    at = SpeedUnit("revchain.SteadyShape.plot", speed, shape).text(shape.angular_speed)
    return _draw_shapes([shape], ax, f"\n{at}")


@described(bound=True)
def plot_shapes(shapes: SteadyShapes, ax: Axes | None = None, *, speed: str | None = None) -> Axes:
    """Draw the shapes in one picture, true to scale, coloured by half waves.

    >>> ax = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=1.0), conical_height=0.02).plot(speed="rpm")
    >>> ax.get_title(), ax.get_legend().get_title().get_text()
    ('5 hanging shapes, proved complete', 'at 211.5 rpm')
    """
    unit = SpeedUnit("revchain.SteadyShapes.plot", speed, shapes)
    at = shapes.angular_speed if shapes else None
    ax = _draw_shapes(shapes, ax, title=None if at is None else f"at {unit.text(at)}")
    ax.set_title(shapes._how_many())
    return ax


@described(bound=True)
def plot_drag_shape(shape: DragShape, ax: Axes | None = None, *, view: str | None = None) -> Axes:
    """Draw the shape from the side and from above, true to scale.

    view: ``"side"``: seen along the motion. ``"above"``: seen from above. If left out, both, in given axes the view from
        above.

    >>> carousel = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=3.0))
    >>> ax = rc.drag_shape(carousel, rc.Drag(1.0, area=0.6), angular_speed="12 rpm").plot(view="above")
    >>> ax.get_ylabel()
    'distance in the\\nsense of motion (m)'
    """
    chosen = None if view is None else word("revchain.DragShape.plot", "view", view, ("side", "above"))
    if ax is None and chosen is None:
        x, y, z = (float(np.ptp(np.append(along, 0.0))) for along in shape.position.T)
        least = 0.25 * max(x, y, z)
        tall = max(z, least), max(1.4 * y, least)
        scale = min(4.8 / max(x, least), 6.4 / sum(tall))  # inches for a metre
        figure = new_figure(float(np.clip(scale * x + 1.4, 4.0, 6.2)), scale * sum(tall) + 1.6)
        side: Axes
        side, above = figure.subplots(2, 1, height_ratios=tall)
        for each in (side, above):
            each.spines[["top", "right"]].set_visible(False)
        _draw_from(shape, above, "above")
        _draw_from(shape, side, "side")
        ends = min(side.get_xlim()[0], above.get_xlim()[0]), max(side.get_xlim()[1], above.get_xlim()[1])
        for each in (side, above):
            each.set_xlim(*ends)
        return side
    return _draw_from(shape, axes_or_new(ax, 6.0, 5.0), chosen or "above")


def _draw_from(shape: DragShape, ax: Axes, view: str) -> Axes:
    x, y, z = shape.position.T
    across = y if view == "above" else -z
    dots = "o" if x.size <= MOST_PINS_AS_DOTS else ""
    ax.plot([0.0, x[-1]], [0.0, across[-1]], **ARM)
    ax.plot(x, across, color=house(0), linewidth=1.4, marker=dots, markersize=3.0)
    ax.plot(x[-1], across[-1], marker="v", color="black", markersize=7.0, clip_on=False)
    ax.set_aspect("equal")
    ax.margins(0.08)
    if view == "side":
        ax.axvline(0.0, **AXIS)
        ax.set(xlabel="outward distance (m)", ylabel="depth below\nthe support (m)")
        keep_room(ax)
        ax.yaxis.set_inverted(True)
        return ax
    ax.plot(0.0, 0.0, marker="+", color="0.4", markersize=9.0)
    low, high = sorted((0.0, float(np.arctan2(y[0], x[0]))))
    arc = np.linspace(low - 0.3, high + 0.3, 200)
    for radius in {float(np.hypot(x[0], y[0])), float(np.hypot(x[-1], y[-1]))}:
        ax.plot(radius * np.cos(arc), radius * np.sin(arc), color="0.8", linewidth=0.8, zorder=0)
    top = float(np.hypot(x[-1], y[-1]))
    ax.annotate("", (top * np.cos(0.3), top * np.sin(0.3)), (top * np.cos(0.1), top * np.sin(0.1)),
                arrowprops={"arrowstyle": "->", "color": "0.4"})
    ax.set(xlabel="outward distance (m)", ylabel="distance in the\nsense of motion (m)")
    keep_room(ax)
    return ax


def _draw_shapes(shapes: Sequence[SteadyShape], ax: Axes | None, more: str = "", title: str | None = None) -> Axes:
    """Draw a curve for each shape; dots mark the pins of links, of cords the free end. `more` ends each label."""
    given, system = ax, shapes[0].system if len(shapes) else None
    wide = float(np.ptp(np.concatenate([[0.0], *(np.asarray(shape.offset) for shape in shapes)])))
    ax = beside_at_rest(system, ax, 6.2, _fitting_height(shapes, wide), across=wide)
    held = any(hasattr(shape, "span") for shape in shapes)
    up = 1.0 if held or (system is not None and system._stands.all()) else -1.0
    ax.axvline(0.0, **AXIS)
    named: set[int] = set()
    for shape in shapes:
        x, z = shape.offset, up * shape.height
        colour, label = half_waves_style(shape.half_waves, named)
        linked = not hasattr(shape, "arc_length")
        marker = "o" if linked and x.size <= MOST_PINS_AS_DOTS else ""
        drawn = thinned(x) if linked else slice(None)
        label = label and label + more
        ax.plot(x[drawn], z[drawn], color=colour, linewidth=1.4, marker=marker, markersize=3.0, label=label)
        if held:
            ax.plot(x[[0, -1]], [0.0, shape.span], color="black", marker="o", linestyle="none", markersize=6.0)
        elif not linked:
            ax.plot(x[0], z[0], color=colour, marker="o", markersize=3.5)
    support = system._support if system is not None and not held else None
    for top in () if held else sorted({float(shape.offset[-1]) for shape in shapes} or {0.0}):
        arm = top if support is None else support.radius * np.sign(top)
        ax.plot([0.0, arm], [0.0, 0.0], **ARM)
        if arm != top:
            draw_spring(ax, arm, top, float(np.ptp([0.0, *shapes[0].height])))
        ax.plot(top, 0.0, marker="v" if arm == top else "s", color="black", markersize=7.0, clip_on=False)
    what = "height above the lower end" if held else "height above the support" if up > 0 else "depth below the support"
    ax.set(xlabel="distance from axis (m)", ylabel=f"{what} (m)")
    if given is None and len(ax.get_shared_y_axes().get_siblings(ax)) > 1:  # beside the system at rest
        ax.set_aspect("equal", adjustable="datalim")
        ends = [*ax.get_ylim(), *ax.dataLim.intervaly]
        ax.set_ylim(min(ends), max(ends))
        ax.legend(loc="best", frameon=False, title=title)
    else:
        ax.set_aspect("equal")
        keep_room(ax)
        if named:
            legend_outside(ax, title=title)
    ax.yaxis.set_inverted(up < 0)
    return ax


def _fitting_height(shapes: Sequence[SteadyShape], wide: float) -> float:
    """Return the height in inches of a figure for curves of these proportions, some 5 inches wide at most."""
    tall = max((np.ptp([0.0, *shape.height]) for shape in shapes), default=1.0)
    return float(np.clip(1.2 + 5.0 * tall / wide, 3.4, 6.0)) if wide else 6.0
