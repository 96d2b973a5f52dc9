# SPDX-License-Identifier: GPL-3.0-or-later
"""Draw the pictures of docs/theory.

python draw_theory.py [FOLDER [NAME ...]]
"""

import sys
from pathlib import Path

import matplotlib
import numpy as np
from matplotlib.figure import Figure
from matplotlib.patches import Arc

import revchain as rc

matplotlib.rcParams.update(
    {
        "font.size": 9.5,
        "axes.titlesize": 9.5,
        "legend.fontsize": 9,
        "axes.spines.top": False,
        "axes.spines.right": False,
        "svg.fonttype": "path",
        "svg.hashsalt": "revchain",
    }
)
BLUE, ORANGE, GREEN, RED, PURPLE, SKY = "#0072B2", "#E69F00", "#009E73", "#D55E00", "#CC79A7", "#56B4E9"  # Okabe, Ito
COLOURS = [BLUE, RED, GREEN, ORANGE, PURPLE, SKY]
DASHES = ["-", "--", "-.", ":", (0, (5, 1, 1, 1, 1, 1)), (0, (1, 1))]
WIDTH = 7.3  # inches: 700 pixels on the page, so that a point is a point


def panels(height, count=1, widths=None):
    figure = Figure(figsize=(WIDTH, height), layout="constrained")
    return figure, figure.subplots(1, count, width_ratios=widths, squeeze=False)[0]


def geometry(axes, x, y):
    """A drawing without scales, in true proportions."""
    axes.set(xlim=x, ylim=y)
    axes.set_aspect("equal")
    axes.axis("off")


def vertical(axes, top, bottom, x=0.0, **line):
    axes.plot([x, x], [top, bottom], **({"color": "0.55", "lw": 0.9, "ls": "-."} | line))


def arrow(axes, start, end, colour="k", width=1.3, style="-|>"):
    line = {"arrowstyle": style, "color": colour, "lw": width, "shrinkA": 0, "shrinkB": 0, "mutation_scale": 10}
    axes.annotate("", end, start, arrowprops=line)


def measure(axes, start, end, text, shift=(0.0, 0.0), colour="0.25", **place):
    """A length between two points, with its letter."""
    arrow(axes, start, end, colour, 0.9, "<->")
    x, y = (np.add(start, end)) / 2 + shift
    axes.text(x, y, text, color=colour, ha="center", va="center", **place)


def pin(axes, point, text="", shift=(0.0, 0.0), size=5.5, **face):
    axes.plot(*point, **({"marker": "o", "ls": "", "ms": size, "mfc": "w", "mec": "k", "zorder": 5} | face))
    axes.text(point[0] + shift[0], point[1] + shift[1], text, ha="center", va="center")


def angle(axes, centre, radius, first, last, text, out=1.25, colour="0.25"):
    """An arc from `first` to `last`, degrees counterclockwise from the right."""
    axes.add_patch(Arc(centre, 2 * radius, 2 * radius, theta1=first, theta2=last, color=colour, lw=0.9))
    middle = np.radians((first + last) / 2)
    axes.text(*(centre + out * radius * np.array([np.cos(middle), np.sin(middle)])), text, ha="center", va="center")


def below(point, length, inclination, sign=1):
    """The point `length` further down a link that leans outwards."""
    return np.asarray(point) + length * np.array([sign * np.sin(inclination), -np.cos(inclination)])


def chain():
    """A whirling chain, and the letters used on all pages."""
    figure, [axes] = panels(3.7)
    shape = rc.steady_shapes(rc.Chain(weight=[1.0, 2.0, 1.5], length=[1.0, 0.8, 1.2]), conical_height=1.5)[0]
    pins = np.column_stack([shape.offset, shape.height])
    vertical(axes, 0.35, -2.3)
    axes.plot(*pins.T, color=BLUE, lw=2.2)
    for k, point in enumerate(pins):
        pin(axes, point, f"$P_{k}$", (0.17, 0.1) if k < 3 else (-0.2, 0.12))
    for k, (low, high) in enumerate(zip(pins[:-1], pins[1:], strict=True), 1):
        vertical(axes, high[1], high[1] - 0.62, high[0], color="0.7", ls="-", lw=0.7)
        angle(axes, high, 0.45, 270, 270 + np.degrees(shape.inclination[k - 1]), rf"$\delta_{k}$", 0.72)
        x, y = (low + high) / 2
        axes.text(x + 0.08, y + 0.14, f"link {k}", color=BLUE, ha="left", va="center")
    for k, (place, level) in enumerate(pins[:3]):
        arrow(axes, (0, level), (place - 0.05, level), "0.45", 0.8, "<->")
        axes.text(0.3, level + 0.1, f"$y_{k}$", color="0.25", ha="center", va="center")
    arrow(axes, (-0.75, 0), (-0.75, -1.5), RED, 1.2, "<->")
    axes.text(-0.85, -0.75, r"$\lambda = g/n^2$", color=RED, ha="right", va="center")
    for level in (0.0, -1.5):
        axes.plot([-0.85, 0], [level, level], color=RED, lw=0.6, ls=":")
    axes.add_patch(Arc((0, 0.32), 0.5, 0.16, theta1=200, theta2=520, color=GREEN, lw=1.5))
    arrow(axes, (0.22, 0.263), (0.245, 0.305), GREEN, 1.5)
    axes.text(0.36, 0.32, "angular speed $n$", color=GREEN, va="center")
    arrow(axes, (3.0, -0.3), (3.0, -0.95), "k")
    axes.text(3.08, -0.62, "$g$", va="center")
    axes.text(-0.12, -2.22, "axis", color="0.4", ha="right", va="center")
    geometry(axes, (-2.1, 3.4), (-2.35, 0.5))
    return figure


def link():
    """One link with its lengths and what acts on it."""
    figure, (axes, held) = panels(3.6, 2, [1.15, 1])
    tilt = np.radians(32)
    top = np.array([0.55, 0.0])
    across = np.array([np.cos(tilt), np.sin(tilt)])
    axes.set_title("lengths")
    vertical(axes, 0.35, -2.25)
    axes.text(-0.05, -2.1, "axis", color="0.4", ha="right")
    bottom, centroid, lower = below(top, 1.9, tilt), below(top, 1.0, tilt), below(top, 1.45, tilt)
    body = np.array([top - 0.09 * across, bottom - 0.09 * across, bottom + 0.09 * across, top + 0.09 * across])
    axes.fill(*body.T, fc="#DCEBF5", ec=BLUE, lw=1.2)
    vertical(axes, 0, -0.95, top[0], color="0.6", ls="-", lw=0.8)
    angle(axes, top, 0.6, 270, 302, r"$\delta_m$", 1.22)
    pin(axes, top, "$P_m$", (0.05, 0.17))
    pin(axes, bottom, "$P_{m-1}$", (0.33, -0.02))
    pin(axes, centroid, "$G_m$", (-0.3, -0.1), mfc=RED, mec=RED)
    pin(axes, lower, "$L_m$", (-0.25, -0.06), mfc=GREEN, mec=GREEN, marker="s", ms=5)
    for k, (end, letter) in enumerate(((centroid, "$h_m$"), (lower, "$l_m$"), (bottom, "$a_m$"))):
        away = (0.28 + 0.26 * k) * across
        axes.plot(*np.column_stack([end, end + away]), color="0.7", lw=0.6)
        measure(axes, top + away, end + away, letter, 0.12 * across)
    axes.plot(*np.column_stack([top, top + 0.8 * across]), color="0.7", lw=0.6)
    arrow(axes, (0, -0.02), (top[0] - 0.04, -0.02), "0.45", 0.8, "<->")
    axes.text(0.27, 0.1, "$y_m$", ha="center")
    level = bottom[1]
    arrow(axes, (0, level), (bottom[0] - 0.05, level), "0.45", 0.8, "<->")
    axes.text(0.45, level + 0.1, "$y_{m-1}$", ha="center")
    geometry(axes, (-0.35, 2.35), (-2.25, 0.6))

    held.set_title("forces in the frame that turns")
    top = np.array([0.0, 0.0])
    bottom, centroid = below(top, 1.9, tilt), below(top, 1.0, tilt)
    held.plot(*np.column_stack([top, bottom]), color=BLUE, lw=3, solid_capstyle="round")
    pin(held, top)
    pin(held, bottom)
    pin(held, centroid, "", mfc=RED, mec=RED)
    arrow(held, centroid, centroid + [0, -0.65], RED)
    held.text(centroid[0] - 0.07, centroid[1] - 0.6, "$W_m$", color=RED, ha="right")
    arrow(held, centroid, centroid + [0.75, 0], RED)
    held.text(centroid[0] + 0.8, centroid[1], r"$W_m\,y_{G}/\lambda$", color=RED, va="center")
    arrow(held, bottom, bottom + [0, -0.6], BLUE)
    held.text(bottom[0] - 0.07, bottom[1] - 0.55, "$S_m$", color=BLUE, ha="right")
    arrow(held, bottom, bottom + [0.6, 0], BLUE)
    held.text(bottom[0] + 0.65, bottom[1], r"$F_{m-1}/\lambda$", color=BLUE, va="center")
    arrow(held, top, top + [0, 0.62], GREEN)
    held.text(0.07, 0.5, "$S_m + W_m$", color=GREEN, va="center")
    arrow(held, top, top + [-0.62, 0], GREEN)
    held.text(-0.67, 0, r"$F_m/\lambda$", color=GREEN, ha="right", va="center")
    geometry(held, (-1.15, 2.35), (-2.35, 0.7))
    return figure


def section_1():
    figure, (side, speed, carried) = panels(3.1, 3, [0.8, 1, 1])
    tilt = np.radians(50)
    mass = below((0, 0), 1.0, tilt)
    vertical(side, 0.15, -1.15)
    side.plot(*np.column_stack([(0, 0), mass]), color=BLUE, lw=2)
    pin(side, (0, 0), "$C$", (-0.12, 0.05))
    pin(side, mass, "", mfc=BLUE, mec=BLUE, ms=8)
    side.plot([0, mass[0]], [mass[1]] * 2, color="0.6", lw=0.8, ls=":")
    side.text(-0.08, mass[1], "$N$", ha="right", va="center")
    arrow(side, (-0.3, 0), (-0.3, mass[1]), RED, 1, "<->")
    side.text(-0.36, mass[1] / 2, r"$\lambda$", color=RED, ha="right", va="center")
    side.text(0.48, -0.24, "$l$", color=BLUE)
    side.text(0.4, mass[1] + 0.07, "$y$", ha="center")
    arrow(side, mass, mass + [0, -0.4], "k")
    side.text(mass[0] + 0.05, mass[1] - 0.4, "$W$")
    arrow(side, mass, mass + [0.4 * np.tan(tilt), 0], "k")
    side.text(mass[0] + 0.05, mass[1] + 0.08, r"$Wy/\lambda$")
    angle(side, np.zeros(2), 0.25, 270, 320, r"$\delta$", 1.45)
    side.set_title("forces")
    geometry(side, (-0.5, 1.35), (-1.2, 0.2))

    x = np.linspace(1, 4, 400)
    speed.plot([0, 1], [0, 0], color=BLUE, lw=2)
    speed.plot(x, np.degrees(np.arccos(1 / x**2)), color=BLUE, lw=2)
    speed.plot([1, 4], [0, 0], color=BLUE, lw=1.2, ls=":")
    speed.set(xlabel=r"speed $n/\sqrt{g/l}$", ylabel=r"inclination $\delta$ (degrees)", title="support on the axis", ylim=(-4, 92))

    for k, b in enumerate((0.02, 0.1, 0.3)):
        rows = [(v, d) for v in np.linspace(0.05, 4, 800) for d in rc.plummet.carried_inclinations(1.0, v**-2, b)]
        v, d = np.array(rows).T
        d = np.degrees(d)
        for name, kept in (("out", d > 0), ("far", (d < 0) & (v > 0))):
            if name == "out":
                carried.plot(v[kept], d[kept], color=COLOURS[k], ls=DASHES[k], label=f"{b}")
            else:
                lower = {}
                for a, e in zip(v[kept], d[kept], strict=True):
                    lower.setdefault(a, []).append(e)
                pairs = np.array([(a, min(e), max(e)) for a, e in lower.items()])
                if len(pairs):
                    loop = np.r_[pairs[::-1, 1], pairs[:, 2]]
                    carried.plot(np.r_[pairs[::-1, 0], pairs[:, 0]], loop, color=COLOURS[k], ls=DASHES[k])
    carried.axhline(0, color="0.7", lw=0.7)
    carried.set(xlabel=r"speed $n/\sqrt{g/l}$", ylabel=r"inclination $\delta$ (degrees)", title="support carried round", ylim=(-92, 92))
    carried.set_yticks([-90, -45, 0, 45, 90])
    carried.legend(title="radius $b/l$", frameon=False, loc="lower right", bbox_to_anchor=(1.04, 0.5), handlelength=2.4)
    return figure


def section_2():
    figure, (shape, heights) = panels(3.4, 2, [0.8, 1.2])
    found = rc.modes(rc.Chain(weight=[1, 3], length=1.0))
    for k, start in enumerate((0.0, 1.6)):
        y = 0.55 * found.shape[k]
        y = y if k == 0 else -y
        pins = np.column_stack([start + y, [-2, -1, 0]])
        vertical(shape, 0.25, -2.3, start)
        shape.plot(*pins.T, color=COLOURS[k], lw=2)
        pin(shape, pins[2])
        pin(shape, pins[0], "", mfc=COLOURS[k], mec=COLOURS[k], ms=7)
        pin(shape, pins[1], "", mfc=COLOURS[k], mec=COLOURS[k], ms=12)
        shape.text(start, 0.33, rf"mode {k + 1}, $\lambda = {found.conical_height[k]:.1f}$ m", ha="center", color=COLOURS[k])
    shape.text(0.5, -2.22, "$W_1 = 1$", ha="center", va="center")
    shape.text(0.42, -1.0, "$W_2 = 3$", va="center")
    geometry(shape, (-0.75, 2.3), (-2.35, 0.5))
    x = np.linspace(-0.999, 0.999, 400)
    for k, mu in enumerate((1 / 3, 1.0, 3.0)):
        both = rc.two_links.two_plummets_from_the_middle(1.0, x, mu)
        heights.plot(x, both, color=COLOURS[k], ls=DASHES[k], label=[rf"$\mu = {'1/3' if k == 0 else round(mu)}$", None])
    for k, side in enumerate((-1, 1)):
        xs = side * np.linspace(0.5, 0.999, 200)
        both = rc.two_links.two_plummets_from_the_middle(1.0, xs, -0.25)
        xs, both = np.r_[xs[::-1], xs], np.r_[both[::-1, 0], both[:, 1]]
        heights.plot(xs, both, color=COLOURS[3], ls=DASHES[3], label=None if k else r"$\mu = -1/4$ (float)")
    heights.set(
        xlabel=r"place of the upper plummet, $x/a$",
        ylabel=r"conical heights $\lambda/a$",
        title="two plummets on a thread of length $2a$",
        ylim=(0, 2.75),
        xticks=[-1, -0.5, 0, 0.5, 1],
    )
    heights.legend(frameon=False, ncols=2, loc="upper center", handlelength=2.8)
    return figure


def section_3():
    figure, (form, force) = panels(3.7, 2)
    shape = rc.steady_shapes(rc.Chain(weight=[1.0, 1.0, 4.0], length=[1.0, 0.8, 1.3]), conical_height=1.4)[0]
    drawn = shape.force_diagram()
    vertical(form, 0.3, -2.2)
    form.plot(*drawn.pin.T, color="k", lw=2)
    names = [(0.2, 0.0), (0.2, 0.06), (0.2, 0.06)]
    for k, point in enumerate(drawn.pin[:3]):
        pin(form, point, f"$P_{k + 1}$", names[k], mfc="k", ms=4 + 2 * shape.system.weight[k])
    for k, g in enumerate(drawn.centre_of_gravity):
        level = g[1] + shape.conical_height
        form.plot([g[0], 0], [g[1], level], color=COLOURS[k], ls=DASHES[k], lw=1.3)
        form.plot([g[0], 0], [g[1], g[1]], color=COLOURS[k], lw=0.6)
        form.text(-0.08, level, f"$K_{k + 1}$", color=COLOURS[k], ha="right", va="center")
        form.text(-0.08, g[1], f"$H_{k + 1}$", color=COLOURS[k], ha="right", va="center")
        if k:
            pin(form, g, f"$G_{k + 1}$", (-0.02, -0.16), mfc=COLOURS[k], mec=COLOURS[k], ms=5)
    form.set(title="the chain: each thread is parallel to $GK$")
    geometry(form, (-0.6, 2.7), (-2.3, 0.35))
    force.set(title=r"diagram of force, $ON = \lambda$")
    vertical(force, 6.6, -shape.conical_height, ls="-", lw=0.8)
    tip = np.zeros(2)
    for k, ray in enumerate(drawn.ray):
        arrow(force, (0, 0), ray, COLOURS[k], 1.4)
        force.text(ray[0] - 0.15, ray[1] - 0.25, f"$Q_{k + 1}$", color=COLOURS[k], ha="right", va="center")
        force.plot(*np.column_stack([tip, ray]), color="0.5", lw=0.8, ls="--")
        force.plot([0, ray[0]], [ray[1]] * 2, color="0.8", lw=0.6, zorder=0)
        force.plot([0, drawn.lifted[k]], [0, -shape.conical_height], color=COLOURS[k], ls=DASHES[k], lw=1.1)
        force.text(drawn.lifted[k], -shape.conical_height - 0.28, f"$P_{k + 1}$", color=COLOURS[k], ha="center", va="center")
        tip = ray
    force.plot([0, 2.5], [-shape.conical_height] * 2, color="0.6", lw=0.8)
    force.text(-0.1, -shape.conical_height, "$N$", ha="right", va="center")
    force.text(0.22, 0.12, "$O$", ha="center", va="center")
    force.text(0.15, 6.2, "line of load")
    geometry(force, (-6.5, 3.0), (-2.1, 6.8))
    return figure


def section_4():
    figure, (form, tips) = panels(3.5, 2, [1.15, 1])
    found = rc.modes(rc.Cord(1.0), 3)
    s = np.linspace(0, 1, 400)
    for k in range(3):
        start = 1.4 * k
        vertical(form, 1.04, -0.04, start)
        form.plot(start + 0.5 * found.along(s)[k], s, color=COLOURS[k], lw=2)
        nodes, up = found.nodes[k], found.vertical_points[k]
        form.plot(np.full(len(nodes), start), nodes, "o", color=COLOURS[k], ms=6)
        if len(up):
            form.plot(start + 0.5 * found.along(up)[k], up, "s", color=COLOURS[k], mfc="w", ms=6)
        form.text(start, 1.08, f"mode {k + 1}", color=COLOURS[k], ha="center")
    form.set(ylabel="from the free end, $s/L$", xticks=[], xlim=(-0.6, 3.5), ylim=(-0.05, 1.17), title="modes of the uniform chain")
    form.spines["bottom"].set_visible(False)
    form.text(1.5, found.nodes[1][0] + 0.02, "node", color=COLOURS[1])
    form.text(1.45, found.vertical_points[1][0], "vertical", color=COLOURS[1], va="center")
    ratio = np.geomspace(1e-3, 1e3, 61)
    heights = np.array([rc.modes(rc.Cord(1.0, weight=1.0, tip_weight=r), 3).conical_height for r in ratio])
    bare = rc.modes(rc.Cord(1.0), 3).conical_height
    for k in range(3):
        tips.loglog(ratio, heights[:, k], color=COLOURS[k], ls=DASHES[k], lw=1.8, label=f"mode {k + 1}")
        tips.plot(1e-3, bare[k], ">", color=COLOURS[k], ms=5, clip_on=False)
    for k in (1, 2):
        tips.loglog(ratio[ratio > 3], 1 / (ratio[ratio > 3] * (k * np.pi) ** 2), color="0.4", lw=0.8, ls=":")
    tips.set(xlabel="tip weight over weight of the chain", ylabel=r"conical height $\lambda/L$", title="a weight at the free end")
    tips.legend(frameon=False, handlelength=2.8, loc="lower left")
    return figure


def section_5():
    figure, (form, drawn) = panels(3.3, 2, [1.5, 1])
    for k, ratio in enumerate((1.02, 1.2, 1.5, 2.0)):
        rope = rc.SkippingRope(span=2.0, length=2.0 * ratio)
        x = np.linspace(0, 2, 300)
        form.plot(x, rope.at(x).offset, color=COLOURS[k], ls=DASHES[k], lw=1.8, label=f"{ratio}")
    form.axhline(0, color="0.55", lw=0.9, ls="-.")
    form.set(xlabel="along the axis, $x/a$", ylabel="offset $y/a$", title="ropes of several lengths on one span $2a$")
    form.set_aspect("equal")
    form.legend(title="length/span", frameon=False, loc="center left", bbox_to_anchor=(1.0, 0.5), handlelength=2.6)
    ratio = np.linspace(0.05, 0.98, 120)
    start = rc.SkippingRope(span=0.05, length=1.0, angular_speed=1.0)
    speed = [start.drawn_to(r).angular_speed / start.angular_speed if r > 0.05 else 1.0 for r in ratio]
    drawn.semilogy(ratio, speed, color=BLUE, lw=2)
    drawn.set(xlabel="span/length", ylabel="speed over speed at 0.05", title="drawn out while it spins")
    return figure


def section_6():
    figure, (form, heights) = panels(3.5, 2, [0.9, 1.1])
    h, rho, a = 0.3, 0.6 / 12**0.5, 0.4
    height = 0.04
    for k, shape in enumerate(rc.two_links.link_on_thread_shapes(a, h, rho, height)):
        stick, string = shape.inclination
        top = np.array([1.15 * k, 0.0])
        joint = below(top, a, string)
        end, centroid, osc = (below(joint, d, stick) for d in (0.6, h, h + rho**2 / h))
        vertical(form, 0.08, -0.95, top[0])
        form.plot(*np.column_stack([top, joint]), color="0.3", lw=1.2)
        form.plot(*np.column_stack([joint, end]), color=COLOURS[k], lw=5, alpha=0.55, solid_capstyle="butt")
        pin(form, top, "$O$", (-0.09, 0.03))
        pin(form, joint, "$D$", (0.1, 0.05) if k == 0 else (-0.1, 0.03))
        pin(form, centroid, "$G$", (0.09, 0.06), mfc="k", ms=4)
        pin(form, osc, "$L$", (0.09, 0.06), mfc=GREEN, mec=GREEN, ms=5, marker="s")
        form.text(top[0] + 0.06, 0.14, f"{k + 1} half wave{'s' * k}", color=COLOURS[k], ha="center")
    form.set_title(rf"every shape at $\lambda = {height}$ m")
    geometry(form, (-0.25, 1.75), (-1.0, 0.22))
    thread = np.linspace(0.001, 1.5, 300)
    both = rc.two_links.link_on_thread(thread, h, rho)
    heights.plot(thread, both[:, 0], color=BLUE, lw=1.8, label="mode 1")
    heights.plot(thread, both[:, 1], color=RED, lw=1.8, ls="--", label="mode 2")
    heights.plot(thread, rc.two_links.standing_link(thread, h, rho), color=GREEN, lw=1.8, ls="-.", label="stick stands on its end")
    heights.plot(thread, thread + h, color="0.4", lw=0.9, ls=":", label="$a + h$")
    heights.set(xlabel="thread $a$ (m)", ylabel=r"conical height $\lambda$ (m)", title="a stick of 0.6 m on a thread", ylim=(0, 2))
    heights.legend(frameon=False, handlelength=2.6)
    return figure


def section_7():
    figure, (phase, time) = panels(3.4, 2, [1.25, 1])
    c = 0.5  # conical height over pendulum length
    theta, rate = np.meshgrid(np.linspace(-np.pi, np.pi, 601), np.linspace(-3, 3, 401))
    level = np.sqrt(rate**2 + (np.cos(theta) - c) ** 2)
    kinds = [
        ([0.2, 0.4], BLUE, "-", "dn: to one side"),
        ([1 - c], "k", "--", "sech: into the bottom"),
        ([0.8, 1.2], GREEN, "-.", "cn: through the bottom"),
        ([1 + c], "0.4", ":", "sinh: to the top"),
        ([1.9, 2.5], RED, (0, (5, 1, 1, 1)), "tn: over the top"),
    ]
    for levels, colour, dash, name in kinds:
        phase.contour(np.degrees(theta), rate, level, levels=levels, colors=[colour], linestyles=[dash], linewidths=1.5)
        phase.plot([], [], color=colour, ls=dash, label=name)
    phase.plot([-60, 60], [0, 0], "o", color=BLUE, ms=5)
    phase.set(
        xlabel=r"inclination $\theta$ (degrees)",
        ylabel=r"rate $\dot\theta/n$",
        title=r"motions at $\lambda = l/2$",
        xticks=[-180, -90, 0, 90, 180],
    )
    figure.legend(frameon=False, loc="outside lower center", ncols=3, handlelength=2.4)
    speed = 2.0**0.5
    t = np.linspace(0, 14, 800)
    for k, (degrees, dash) in enumerate(((75, "-"), (89.9, "--"), (110, "-."))):
        motion = rc.GovernorMotion(angular_speed=speed, pendulum_length=1.0, angle=np.radians(degrees), gravity=1.0)
        angles = np.degrees(np.array([motion.state(x)[0] for x in t]))
        time.plot(t * speed, angles, color=[BLUE, "k", GREEN][k], ls=dash, label=f"{degrees}°")
    time.axhline(60, color="0.6", lw=0.8, ls=":")
    time.set(xlabel="time $n t$", ylabel=r"$\theta$ (degrees)", title=r"released at rest from $\alpha$", ylim=(-120, 175), yticks=[-90, 0, 60, 90])
    time.legend(frameon=False, loc="upper center", ncols=3, handlelength=1.8, columnspacing=1.0, handletextpad=0.4)
    return figure


def section_8():
    figure, [axes] = panels(3.6)
    tilts = np.radians([56, 44, 30])
    lengths = [0.95, 0.9, 1.15]
    pins = [np.array([0.75, 0.0])]
    for tilt, length in zip(tilts[::-1], lengths[::-1], strict=True):
        pins.append(below(pins[-1], length, tilt))
    vertical(axes, 0.3, -2.5)
    axes.text(-0.06, -2.35, "axis", color="0.4", ha="right")
    names = ["P_m", "P_{m-1}", "P_{m-2}", "P_{m-3}"]
    for k, (high, low) in enumerate(zip(pins[:-1], pins[1:], strict=True)):
        own = k == 0
        axes.plot(*np.column_stack([high, low]), color=BLUE if own else "0.6", lw=3.5 if own else 2.5, solid_capstyle="round")
        centroid = high + 0.5 * (low - high)
        pin(axes, centroid, "", mfc=RED, mec=RED, ms=5)
        arrow(axes, centroid, centroid + [0, -0.4], RED)
        arrow(axes, centroid, centroid + [0.3 + 0.12 * k, 0], RED)
        index = "m" if own else f"m-{k}"
        axes.text(centroid[0] - 0.05, centroid[1] - 0.36, f"$W_{{{index}}}$", color=RED, ha="right")
        axes.text(centroid[0] + 0.36 + 0.12 * k, centroid[1], rf"$W_{{{index}}}\, y_{{G}}/\lambda$", color=RED, va="center")
    for k, point in enumerate(pins):
        pin(axes, point, f"${names[k]}$", (0.28, 0.1))
    first = pins[0]
    vertical(axes, 0, -1.05, first[0], color="0.6", ls="-", lw=0.8)
    angle(axes, first, 0.62, 270, 300, r"$\delta_m$", 0.78)
    low = pins[1]
    arrow(axes, (first[0] - 0.5, 0), (first[0] - 0.5, low[1]), GREEN, 1, "<->")
    axes.plot([first[0] - 0.55, low[0]], [low[1]] * 2, color=GREEN, lw=0.6, ls=":")
    axes.plot([first[0] - 0.55, first[0]], [0, 0], color=GREEN, lw=0.6, ls=":")
    axes.text(first[0] - 0.6, low[1] / 2, r"$a_m\cos\delta_m$", color=GREEN, ha="center", va="center", rotation=90)
    measure(axes, (first[0], 0.2), (low[0], 0.2), r"$a_m\sin\delta_m$", (0, 0.13), GREEN)
    axes.plot([low[0]] * 2, [0.25, low[1]], color=GREEN, lw=0.6, ls=":")
    axes.text(2.75, -0.15, "moments about $P_m$:\nlink $m$ with its own arms;\nall links below act at $P_{m-1}$,\nthe pin to which they hang", va="top")
    geometry(axes, (-0.5, 5.0), (-2.5, 0.5))
    return figure


def slowest(count, guess, spread):
    """Bisection for the slowest mode, the value at which `count` passes from 0 to 1, next to `guess`."""
    low, high = guess * (1 - spread), guess * (1 + spread)
    for _ in range(40 if spread > 1e-9 else 14):
        middle = (low + high) / 2
        low, high = (low, middle) if count(middle) else (middle, high)
    return (low + high) / 2


def pivots(diagonal, side, mass):
    """Whether K - mu M has a negative pivot, from its assembled entries, in extended precision."""
    diagonal, side, mass = (np.asarray(x, np.longdouble) for x in (diagonal, np.r_[0, side], mass))
    square = side**2

    def count(mu):
        last = np.longdouble(1)
        for d, s, m in zip(diagonal, square, mass, strict=True):
            last = d - mu * m - s / last
            if last < 0:
                return True
        return False

    return count


def links(stiffness, weight):
    """Computes the same number from the stiffness and weight of each link in double precision, without matrices."""
    pairs = list(zip(stiffness.tolist(), weight.tolist(), strict=True))

    def count(mu):
        s = 0.0
        for k, w in pairs:
            d = s - mu * w
            if d + k < 0:
                return True
            s = k * d / (d + k)
        return False

    return count


def matrices():
    """The slowest mode of N unlike plummets from an assembled matrix and from link elements."""
    from scipy.linalg import eigh_tridiagonal

    figure, [axes] = panels(3.4)
    sizes = [10, 30, 100, 300, 1000, 3000, 10_000]
    rng = np.random.default_rng(1908)
    rows = []
    for n in sizes:
        weight, length = rng.uniform(0.5, 1.5, (2, n))
        exact = 1 / rc.modes(rc.Chain(weight=weight, length=length), 1).conical_height[0]
        k = np.cumsum(weight) / length
        diagonal, side = np.r_[k[0], k[:-1] + k[1:]], -k[:-1]
        root = np.sqrt(weight)
        lapack = eigh_tridiagonal(diagonal / weight, side / (root[:-1] * root[1:]), True, "i", (0, 0))[0]
        stored = slowest(pivots(diagonal, side, weight), np.longdouble(exact), 1e-6)
        element = slowest(links(k, weight), exact, 1e-12)
        rows.append([abs(float(x / exact) - 1) for x in (lapack, stored, element)])
        print(f"{n:6} plummets: LAPACK {rows[-1][0]:.1e}, matrix {rows[-1][1]:.1e}, elements {rows[-1][2]:.1e}")
    names = ["assembled, then LAPACK (stebz)", "assembled, then solved in extended precision", "recursion over link elements"]
    for k, (name, errors) in enumerate(zip(names, np.transpose(rows), strict=True)):
        axes.loglog(sizes, np.maximum(errors, 5e-17), "s^o"[k], ls=["--", "-.", "-"][k], color=[RED, ORANGE, BLUE][k], label=name)
    axes.axhline(2.2e-16, color="0.5", lw=0.8, ls=":")
    axes.text(10_000, 1.4e-16, "one unit of the last digit", color="0.35", ha="right", va="top")
    axes.set(
        xlabel="number of links $N$",
        ylabel="relative error",
        title=r"slowest mode of $N$ unlike plummets, double precision",
        ylim=(3e-17, 1e-6),
    )
    axes.legend(frameon=False, loc="upper left")
    return figure


def counts():
    figure, (stairs, zoom) = panels(3.1, 2, [1.35, 1])
    system = rc.Chain(weight=[1.0, 2.0, 1.5, 1.0, 0.5], length=[1.0, 0.8, 1.2, 0.6, 0.9])
    found = rc.modes(system, certify=True)
    x = np.geomspace(0.015, 6, 4000)
    stairs.step(x, rc.count_modes(system, conical_height=x), where="post", color=BLUE, lw=1.8)
    for k, height in enumerate(found.conical_height):
        stairs.plot([height, height], [k, k + 1], color="w", lw=3)
        stairs.plot([height, height], [k, k + 1], color=RED, lw=1, ls=":")
        stairs.text(height * 1.06, k + 0.5, rf"$\lambda_{k + 1}$", color=RED, va="center")
    stairs.set(xscale="log", xlabel=r"height $\lambda$ (m)", ylabel=r"heights above $\lambda$", title="the count is a staircase")
    stairs.set_xticks([0.1, 1.0], labels=["0.1", "1"])
    exact = found.conical_height[0]
    grid = exact + np.arange(-6, 7) * np.spacing(exact)
    number = rc.count_modes(system, conical_height=grid)
    zoom.plot(np.arange(-6, 7), number, "o", color=BLUE)
    for side in (-2, 2):
        zoom.axvline(side * 2.220446049250313e-16 * exact / np.spacing(exact), color=GREEN, lw=1.2, ls="--")
    zoom.axvline(0, color=RED, lw=1, ls=":")
    zoom.set(
        xlabel=r"steps of double precision from $\lambda_1$",
        ylabel="count",
        xticks=[-6, -4, -2, 0, 2, 4, 6],
        yticks=[0, 1],
        ylim=(-0.25, 1.25),
        title=r"two proved counts around $\lambda_1$",
    )
    return figure


class Interval:
    """Just enough interval arithmetic for a picture; not rounded outwards."""

    def __init__(self, low, high=None):
        self.low, self.high = float(low), float(low if high is None else high)

    def __add__(self, other):
        other = other if isinstance(other, Interval) else Interval(other)
        return Interval(self.low + other.low, self.high + other.high)

    def __neg__(self):
        return Interval(-self.high, -self.low)

    def __sub__(self, other):
        return self + -(other if isinstance(other, Interval) else Interval(other))

    def __mul__(self, other):
        other = other if isinstance(other, Interval) else Interval(other)
        ends = [a * b for a in (self.low, self.high) for b in (other.low, other.high)]
        return Interval(min(ends), max(ends))

    def sine(self):
        """Returns the sine of the angle that has this tangent."""
        return Interval(*(p / np.hypot(1, p) for p in (self.low, self.high)))

    def cube(self):
        """cos^3 of the angle with this tangent."""
        largest = max(abs(self.low), abs(self.high))
        least = 0.0 if self.low <= 0 <= self.high else min(abs(self.low), abs(self.high))
        return Interval((1 + largest**2) ** -1.5, (1 + least**2) ** -1.5)

    def __contains__(self, number):
        return self.low <= number <= self.high


def swept(height, n, t, slope):
    """Offset of the support of n equal plummets, and its derivative, for the tangent t of the lowest link; intervals."""
    first, height = t, Interval(height)
    y, dy = height * t, height * slope  # of the lowest plummet: tan = y / height
    force, dforce = y, dy
    for m in range(1, n + 1):
        p, dp = (force * (1 / (height.low * m)), dforce * (1 / (height.low * m))) if m > 1 else (first, slope)
        y, dy = y - p.sine(), dy - dp * p.cube()
        force, dforce = force + y, dforce + dy
    return y, dy


def completeness():
    figure, (curve, cells) = panels(3.5, 2, [1.2, 1])
    n, height = 3, 1 / 4.4**2
    t_max = n / height + 1
    t = np.concatenate([np.geomspace(1e-3, 2, 1000), np.geomspace(2, t_max, 3000)])
    y = np.array([swept(height, n, Interval(v), Interval(1.0))[0].low for v in t])
    curve.semilogx(t[1:], y[1:], color=BLUE, lw=1.6)
    curve.axhline(0, color="0.5", lw=0.8)
    shapes = rc.steady_shapes(rc.Chain.uniform_plummets(n, length=float(n)), conical_height=height)
    curve.plot(np.tan([s.inclination[0] for s in shapes]), np.zeros(len(shapes)), "o", color=RED, ms=6, zorder=4)
    curve.set(xlabel=r"tangent of $\delta_1$, the lowest inclination", ylabel="offset of the support, $y_3/a$", title="a steady shape is a zero", xlim=(0.01, 80))
    todo, done = [(0.0, t_max)], []
    while todo:
        a, b = todo.pop()
        value, slope = swept(height, n, Interval(a, b), Interval(1.0))
        if 0 not in value and a > 0:
            done.append((a, b, "no zero", "0.6"))
        elif 0 not in slope:
            ends = [swept(height, n, Interval(v), Interval(1.0))[0].low for v in (a, b)]
            one = a > 0 and ends[0] * ends[1] < 0
            done.append((a, b, *(("monotone, one zero", RED) if one else ("monotone, no zero", SKY) if a > 0 else ("straight chain alone", GREEN))))
        else:
            middle = b / 16 if a == 0 else (a * b) ** 0.5 if b > 2 * a else a + 0.487 * (b - a)
            todo += [(a, middle), (middle, b)]
    print(f"completeness: {len(done)} parts, {sum(kind == 'monotone, one zero' for *_, kind, _ in done)} with one zero")
    names = ["no zero", "monotone, no zero", "monotone, one zero", "straight chain alone"]
    shown = [name for name in names if any(kind == name for *_, kind, _ in done)]
    for a, b, kind, colour in sorted(done):
        row = shown.index(kind)
        cells.plot([max(a, 1e-3), b], [row, row], color=colour, lw=10, solid_capstyle="butt")
        cells.plot([a, a], [row - 0.2, row + 0.2], color="w", lw=0.8)
    cells.set(
        xscale="log",
        yticks=range(len(shown)),
        yticklabels=[name.replace(", ", ":\n").replace("straight chain", "straight\nchain") for name in shown],
        xlim=(0.01, 80),
        ylim=(-0.5, len(shown) - 0.5),
        xlabel=r"tangent of $\delta_1$",
        title=f"{len(done)} parts cover the whole range",
    )
    return figure


def stability():
    figure, (free, driven) = panels(3.3, 2)
    pair = rc.Chain.uniform_plummets(2, length=2.0)
    second = rc.modes(pair).conical_height[1]
    ratios = np.linspace(0.02, 0.999, 240)
    for axes, frame in ((free, "free"), (driven, "driven")):
        growth, swing = [], []
        for ratio in ratios:
            shape = next(s for s in rc.steady_shapes(pair, conical_height=ratio * second) if s.half_waves == 2)
            found = shape.stability(frame=frame)
            growth.append(found.exponents.real.max())
            rates = np.unique(np.abs(found.exponents.imag).round(9))
            swing.append(rates[rates > 1e-6])
        for k, (ratio, rates) in enumerate(zip(ratios, swing, strict=True)):
            axes.plot(np.full(len(rates), ratio), rates, ".", color=BLUE, ms=2, label="frequencies" if k == 0 else None)
        axes.plot(ratios, growth, color=RED, lw=2, label="largest growth rate")
        axes.set(xlabel=r"$\lambda/\lambda_2$ (slower to the right)", title=f"{frame} frame", ylim=(-0.1, 2.2))
        if frame == "free":
            axes.axvline(0.463321, color="0.4", lw=0.9, ls="--")
            axes.text(0.44, 2.05, "0.4633", color="0.3", ha="right")
            axes.set_ylabel("exponents, in units of $n$")
        else:
            axes.legend(frameon=False, loc="upper right", markerscale=4)
    return figure


def convergence():
    figure, (heights, shapes) = panels(3.5, 2)
    sizes = np.unique(np.geomspace(5, 3000, 15).astype(int))
    limit = rc.modes(rc.Cord(1.0), 3).conical_height
    kinds = {
        "plummets, $1/(2N)$": (lambda n: rc.Chain(weight=np.ones(n), length=1 / n), lambda n: 0.5 / n),
        "$l = a$": (lambda n: rigid(n, 1.0), lambda n: 0.5917 / n**2),
        "$l = 3a/4$": (lambda n: rigid(n, 0.75), lambda n: 0.1019 / n**2),
        "rods, $l = 2a/3$": (lambda n: rigid(n, 2 / 3), lambda n: 0.0614 / n**2),
    }
    marks = "o^sD"
    for k, (name, (make, law)) in enumerate(kinds.items()):
        errors = [abs(rc.modes(make(n), 1).conical_height[0] / limit[0] - 1) for n in sizes]
        heights.loglog(sizes, law(sizes.astype(float)), color=COLOURS[k], ls=DASHES[k], lw=1)
        heights.loglog(sizes, errors, marks[k], color=COLOURS[k], ms=5, label=name)
    heights.set(xlabel="number of links $N$", ylabel="relative difference of $\\lambda_1$", title="small amplitude: heights")
    heights.legend(frameon=False, loc="lower left", handletextpad=0.2)
    cord = rc.steady_shapes(rc.Cord(1.0), conical_height=0.1)[0]
    for k, (name, (make, _)) in enumerate(kinds.items()):
        found = []
        for n in (few := sizes[sizes <= 700]):
            shape = rc.steady_shapes(make(n), conical_height=0.1)[0]
            found.append(abs(shape.offset[0] - tip_offset(cord)))
        shapes.loglog(few, found, marks[k], ls=DASHES[k], lw=1, color=COLOURS[k], ms=5)
    shapes.set(xlabel="number of links $N$", ylabel="difference at the free end, over $L$", title=r"at $L = 10\,\lambda$: first shape")
    return figure


def rigid(n, pendulum):
    """n rigid links with the centroid in the middle and a pendulum length of `pendulum` links, length 1 in all."""
    return rc.Chain(weight=np.ones(n), length=1 / n, centroid=0.5 / n, pendulum_length=pendulum / n)


def tip_offset(shape):
    return np.abs(np.asarray(shape.offset))[[0, -1]].max()


def misprints():
    figure, [axes] = panels(3.5)
    rng = np.random.default_rng(1908)
    rows = {m: ([], []) for m in range(3, 9)}
    for _ in range(100):
        weight, length, centroid, extra = rng.uniform(0.5, 2.0, (4, 8))
        centroid *= 0.5 * length
        system = rc.Chain(weight=weight, length=length, centroid=centroid, pendulum_length=centroid + 0.1 * extra * length)
        found = rc.modes(system)
        for m in rows:
            for printed in (False, True):
                left = [unbalanced(system, *mode, m, printed) for mode in zip(found.conical_height, found.shape, strict=True)]
                rows[m][printed].append(max(left))
    for printed, colour, at, text in (
        (True, RED, (8, 0.01), "as printed, $h_{m-2}/a_{m-1}$: a fifth to a seventh is left over"),
        (False, BLUE, (8, 2e-14), "corrected, $h_{m-2}/a_{m-2}$: only rounding is left over"),
    ):
        axes.semilogy([*rows], [np.mean(rows[m][printed]) for m in rows], "o-", color=colour)
        axes.text(*at, text, color=colour, ha="right", va="top" if printed else "bottom")
    axes.set(xlabel="link $m$", ylabel="sum of the terms / sum of their sizes", ylim=(1e-17, 10), yticks=10.0 ** np.arange(-16, 1, 4))
    axes.set_title("Relation (21): the printed form fails from link 4 on")
    print(f"misprints: {np.mean(rows[4][1]):.3f} unbalanced at m = 4 as printed, {np.mean(rows[4][0]):.1e} corrected")
    return figure


def damping():
    """Exponents of three links while their dashpots grow."""
    figure, [axes] = panels(3.4)
    chain = rc.Chain(mass=1.0, length=[1.0, 1.0, 1.0])
    found = [rc.modes(rc.Rig(chain, pins=rc.Pin(damping=float(d)))).exponent for d in np.geomspace(1e-3, 200, 3000)]
    for mode in range(3):  # the fastest are the first that no longer swing
        path = [s[s.imag > 0][mode] for s in found if np.count_nonzero(s.imag) > mode]
        axes.plot(np.real(path), np.imag(path), color=BLUE)
    axes.plot([-12, 0], [0, 0], color=RED)
    free = rc.modes(chain).angular_speed
    axes.plot(0 * free, free, "o", color="black", label="no dashpots")
    for k, speed in enumerate(free, 1):
        axes.text(0.15, speed, f"mode {k}", va="center")
    axes.set_title("Three weights: along each curve the damping grows, from the dot on")
    axes.text(-9.5, 0.3, "no swing, only decay", color=RED, ha="center")
    axes.set(xlim=(-12, 1.6), ylim=(-0.4, 9), xlabel="real part of $s$ (1/s): decay", ylabel="imaginary part (rad/s): swing")
    print(f"damping: {len(found[0])} modes at first, {len(found[-1])} exponents at last")
    return figure


def unbalanced(system, height, y, m, printed):
    """Returns the residual of (21) for link m, divided by the sum of the absolute values of its terms; y[0], y[1], ... are pins."""
    W, a, h, l = (np.r_[np.nan, x] for x in (system.weight, system.length, system.centroid, system.pendulum_length))
    S = W[1:m].sum()
    own = W[m] * h[m] / a[m]
    terms = [
        (S * height / a[m] + own * (1 + (height - l[m]) / a[m])) * y[m],
        (W[m - 1] * (1 - h[m - 1] / a[m - 1]) - S * height / a[m] - own * (height - l[m]) / a[m]) * y[m - 1],
    ]
    for r in range(m - 2, 0, -1):
        over = a[m - 1] if printed and r == m - 2 else a[r]
        upper = W[r + 1] * h[r + 1] / a[r + 1]
        if r == 1:
            terms.append((W[1] * (1 + h[1] / (height - l[1])) + upper) * y[1])
        else:
            terms.append((W[r] * (1 - h[r] / over) + upper) * y[r])
    return abs(sum(terms)) / sum(abs(term) for term in terms)


PICTURES = [
    *(chain, link, section_1, section_2, section_3, section_4, section_5, section_6, section_7, section_8),
    *(matrices, counts, completeness, stability, convergence, misprints, damping),
]

folder = Path(sys.argv[1] if len(sys.argv) > 1 else ".")
for draw in PICTURES:
    if not sys.argv[2:] or draw.__name__ in sys.argv[2:]:
        path = folder / f"theory_{draw.__name__}.svg"
        draw().savefig(path, metadata={"Date": None, "Creator": None})
        print("wrote", path.name)
