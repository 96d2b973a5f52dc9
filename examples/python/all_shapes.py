# SPDX-License-Identifier: GPL-3.0-or-later
"""Every steady shape of three point masses
========================================

All steady shapes of three point masses at one speed, proved complete; their branches and their stability.

Usage: ``python all_shapes.py [FOLDER]``
"""

from _picture import COLOURS, panels, save

import revchain as rc

SPEED = 4.4  # in units of sqrt(g/a), a the length of a thread
chain = rc.Chain.uniform_plummets(3, length=3.0)
shapes = rc.steady_shapes(chain, angular_speed=SPEED, gravity=1.0)
print(f"three point masses at {SPEED} sqrt(g/a): {len(shapes)} shapes, {'all' if shapes.complete else 'at least'}")
print("half waves  inclinations, degrees   error bound  stability")
for shape in shapes:
    degrees = " ".join(f"{57.29577951308232 * d:6.2f}" for d in shape.inclination)
    print(f"{shape.half_waves:10}   {degrees}   {shape.error_bound:11.1e}  {shape.stability().verdict}")

diagram = rc.branches(chain, max_angular_speed=5.0, gravity=1.0)
born = diagram[3]
print(f"two are born at {born.angular_speed[born.folds[0]]:.9f} sqrt(g/a)")
eight = rc.steady_shapes(rc.Chain.uniform_plummets(8, length=8.0), conical_height=5.95**-2)
print(f"eight point masses at 5.95 sqrt(g/a): {len(eight)} shapes, {'all' if eight.complete else 'at least'}")

figure, axes = panels(2, [2, 3])
seen = set()
for shape in shapes:
    k = shape.half_waves
    axes[0].plot(shape.offset, -shape.height, "o-", color=COLOURS[k - 1], label=None if k in seen else f"{k}")
    seen.add(k)
axes[0].axvline(0, color="0.6", linewidth=0.8, linestyle="-.", zorder=0)
axes[0].set(title=f"all shapes at {SPEED}", xlabel="from the axis, threads", ylabel="below the support")
axes[0].invert_yaxis()
axes[0].set_aspect("equal")
axes[0].legend(title="half waves", fontsize=8, frameon=False)
for branch in diagram:
    speed, tip = branch.angular_speed, branch.tip_inclination
    k = branch.half_waves[-1]
    axes[1].plot(speed, 57.29577951308232 * tip, color=COLOURS[k - 1])
axes[1].axvline(SPEED, color="0.6", linewidth=0.8, linestyle=":")
axes[1].set(title="branches", xlabel="speed over sqrt(g/a)", ylabel="inclination of the lowest thread (°)")
save(figure)
