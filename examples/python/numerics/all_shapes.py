# SPDX-License-Identifier: GPL-3.0-or-later
"""Triple conical pendulum: every steady shape, proved complete
============================================================

Three point masses on a thread whirl at one speed: in which shapes, which of them are stable, and are there others?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

SPEED = 4.4  # in units of sqrt(g/a), a the length of a thread
chain = rc.Chain.uniform_plummets(3, length=3.0)
shapes = rc.steady_shapes(chain, angular_speed=SPEED, gravity=1.0)

figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
for view in np.cos(np.linspace(np.pi, 0, 7)):  # at seven moments of half a turn
    strength = 1.0 if view == 1 else 0.25
    axes.plot(view * shapes[1].offset, shapes[1].height, "o-", color="C1", linewidth=2, markersize=9, alpha=strength)
axes.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
axes.set(aspect="equal", xlabel="distance from axis / a", ylabel="height / a")
plt.show()

# %%
# The picture shows the shape with two half waves: it turns about the axis, seen from the side. The
# speed has five shapes, one with one half wave, one with two, and three with three. The table has
# the inclination of each thread, the lowest first, its error bound, and the stability. ``complete``
# is true: it has been proved that there are no other shapes at this speed.

print(f"three point masses at {SPEED} sqrt(g/a): {len(shapes)} shapes, {'all' if shapes.complete else 'at least'}")
print("half waves  inclinations, degrees   error bound  stability")
for shape in shapes:
    degrees = " ".join(f"{np.degrees(d):6.2f}" for d in shape.inclination)
    print(f"{shape.half_waves:10}   {degrees}   {shape.error_bound:11.1e}  {shape.stability().verdict}")

# %%
# Two of the shapes belong to an isolated branch. It does not leave the vertical: both appear
# together at a fold.

diagram = rc.branches(chain, max_angular_speed=5.0, gravity=1.0)
born = diagram[3]
print(f"two shapes appear at a fold at {born.angular_speed[born.folds[0]]:.9f} sqrt(g/a)")

# %%
# More masses have many more shapes.

eight = rc.steady_shapes(rc.Chain.uniform_plummets(8, length=8.0), conical_height=5.95**-2)
print(f"eight point masses at 5.95 sqrt(g/a): {len(eight)} shapes, {'all' if eight.complete else 'at least'}")

# %%
# All branches of the three masses, and where the five shapes A to E are on them.

figure = plt.figure(figsize=(8, 4.5), layout="constrained")
axes = figure.subplot_mosaic([["A", "B", "C", "all"], ["D", "E", ".", "all"]], width_ratios=[1.3, 1.3, 1.3, 3])
curves = axes["all"]
closer = curves.inset_axes((0.5, 0.46, 0.49, 0.31), xlim=(3.85, 4.75), ylim=(80.3, 86.4), xticks=[4.0, 4.4])
for panel in (curves, closer):
    for branch in diagram:
        panel.plot(branch.angular_speed, np.degrees(branch.lowest_inclination), color=f"C{branch.half_waves[-1] - 1}")
    panel.axvline(SPEED, color="0.6", linewidth=0.8, linestyle=":")
curves.indicate_inset_zoom(closer)
closer.annotate("isolated", (3.9, 85.3), color="C2")
for letter, shape in zip("ABCDE", shapes, strict=True):
    panel, colour, tip = axes[letter], f"C{shape.half_waves - 1}", np.degrees(shape.inclination[0])
    panel.plot(shape.offset, shape.height, "o-", color=colour, clip_on=False)
    panel.axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
    panel.set_title(f"{letter}: {shape.half_waves} half wave{'s' * (shape.half_waves > 1)}")
    middle = 1.5 if letter == "A" else 0
    panel.set(aspect="equal", xticks=[], yticks=[], xlim=(middle - 1.6, middle + 1.6), ylim=(-3.1, 0.2))
    panel.spines[:].set_visible(False)
    curves.plot(SPEED, tip, "o", color=colour)
    closer.plot(SPEED, tip, "o", color=colour)
    panel = closer if 80.3 < tip < 86.4 else curves
    beside = {"B": (-13, 3), "D": (7, -9), "E": (8, -6)}.get(letter, (5, 4))
    panel.annotate(letter, (SPEED, tip), xytext=beside, textcoords="offset points", color=colour, weight="bold")
curves.set(title="branches, and the five shapes at 4.4 $\\sqrt{g/a}$", xlabel="speed over $\\sqrt{g/a}$, $a$: length of one thread")
curves.set_ylabel("inclination of the lowest thread (°)")
plt.show()

# %%
# To try next: four masses. ``rc.steady_shapes(rc.Chain.uniform_plummets(4, length=4.0),
# angular_speed=SPEED, gravity=1.0)`` has eight shapes.
#
# Checked: ``tests/python/test_steady_shapes.py`` has the shapes by Newton's method in 40 digits,
# and the numbers of shapes and the speed of the fold as known from elsewhere.
