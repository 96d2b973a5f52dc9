# SPDX-License-Identifier: GPL-3.0-or-later
"""Every steady shape of three point masses
========================================

All steady shapes of three point masses at one speed, their branches and their stability. The list is proved complete.

Checked: ``tests/python/test_steady_shapes.py`` has the shapes by Newton's method in 40 digits, and the numbers of shapes and
the speed of the fold as known from elsewhere.
"""

import numpy as np
from matplotlib.figure import Figure

import revchain as rc
from revchain.plots.programs import COLOURS, save

SPEED = 4.4  # in units of sqrt(g/a), a the length of a thread
chain = rc.Chain.uniform_plummets(3, length=3.0)
shapes = rc.steady_shapes(chain, angular_speed=SPEED, gravity=1.0)
print(f"three point masses at {SPEED} sqrt(g/a): {len(shapes)} shapes, {'all' if shapes.complete else 'at least'}")
print("half waves  inclinations, degrees   error bound  stability")
for shape in shapes:
    degrees = " ".join(f"{np.degrees(d):6.2f}" for d in shape.inclination)
    print(f"{shape.half_waves:10}   {degrees}   {shape.error_bound:11.1e}  {shape.stability().verdict}")

diagram = rc.branches(chain, max_angular_speed=5.0, gravity=1.0)
born = diagram[3]
print(f"two shapes appear at a fold at {born.angular_speed[born.folds[0]]:.9f} sqrt(g/a)")
eight = rc.steady_shapes(rc.Chain.uniform_plummets(8, length=8.0), conical_height=5.95**-2)
print(f"eight point masses at 5.95 sqrt(g/a): {len(eight)} shapes, {'all' if eight.complete else 'at least'}")

figure = Figure(figsize=(8, 4.5), layout="constrained")
axes = figure.subplot_mosaic([["A", "B", "C", "all"], ["D", "E", ".", "all"]], width_ratios=[1.25, 1, 1, 3.4])
curves = axes["all"]
closer = curves.inset_axes((0.47, 0.44, 0.51, 0.37), xlim=(3.85, 4.6), ylim=(80.3, 85.9), xticks=[4.0, 4.4])
for panel in (curves, closer):
    for branch in diagram:
        colour = COLOURS[branch.half_waves[-1] - 1]
        panel.plot(branch.angular_speed, np.degrees(branch.tip_inclination), color=colour)
    panel.axvline(SPEED, color="0.6", linewidth=0.8, linestyle=":")
curves.indicate_inset_zoom(closer)
closer.annotate("isolated branch", (3.92, 85.1), color=COLOURS[2])
for letter, shape in zip("ABCDE", shapes, strict=True):
    panel, colour, tip = axes[letter], COLOURS[shape.half_waves - 1], np.degrees(shape.inclination[0])
    panel.plot(shape.offset, shape.height, "o-", color=colour, clip_on=False)
    panel.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
    panel.set_title(f"{letter}: {shape.half_waves} half wave{'s' * (shape.half_waves > 1)}")
    panel.set(aspect="equal", xticks=[], yticks=[])
    panel.spines[:].set_visible(False)
    curves.plot(SPEED, tip, "o", color=colour)
    closer.plot(SPEED, tip, "o", color=colour)
    panel = closer if 80.3 < tip < 85.9 else curves
    panel.annotate(letter, (SPEED, tip), xytext=(5, 4 if letter == "A" else -12), textcoords="offset points")
curves.set(title="branches, and the five shapes at 4.4 $\\sqrt{g/a}$", xlabel="speed over $\\sqrt{g/a}$")
curves.set_ylabel("inclination of the lowest thread (°)")
save(figure, "all_shapes")
