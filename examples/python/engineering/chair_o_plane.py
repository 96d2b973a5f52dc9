# SPDX-License-Identifier: GPL-3.0-or-later
"""Chair-o-plane on a flexible mast: stability and limit speed
===========================================================

A chair-o-plane stands on a mast that bends: where does the chair hang, up to which speed, and is it stable?
"""

import matplotlib.pyplot as plt
import numpy as np

import revchain as rc

CHAIR, ARM = 8.0, 3.0  # kg without the rider, m


def with_rider(mass):
    """Chair and rider on 4 m of chain, on an arm whose end moves sideways against a spring: the bending mast."""
    bodies = {"length": [1.0, 4.0], "centroid": [0.8, 2.0], "radius_of_gyration": [0.3, 4.0 / np.sqrt(12)]}
    chain = rc.Chain(mass=[CHAIR + mass, 10.0], **bodies)
    return rc.Rig(chain, support=rc.Support(radius=ARM, stiffness="1000 N/m", mass=30.0))


shape = rc.steady_shape(with_rider(80.0), angular_speed="12 rpm")
mast = shape.offset[-1] - ARM

figure, axes = plt.subplots(figsize=(4.8, 3.4), layout="constrained")
axes.plot(mast * np.linspace(0, 1, 20) ** 2, np.linspace(-6, 0, 20), color="0.3", linewidth=5)
axes.plot([mast, shape.offset[-1]], [0, 0], color="0.3", linewidth=4)
axes.plot(shape.offset, shape.height, color="C0", linewidth=2)
axes.plot(shape.offset[:2], shape.height[:2], color="C1", linewidth=9, solid_capstyle="round")
axes.axvline(0, color="0.6", linestyle="-.", linewidth=0.8)
axes.set(xlabel="distance from axis (m)", ylabel="height above the arm (m)", aspect="equal")
plt.show()

# %%
# The picture shows a rider of 80 kg at 12 rpm. The pull of the chair bends the mast, so that the
# arm reaches further out than 3 m.
#
# The table compares five riders. At the limit speed the spring of the mast no longer holds the
# moving mass. Heavy riders have a second family of shapes below that speed, with the chair on the
# other side of the axis.


def rpm(speed):
    return 30 / np.pi * speed


figure, axes = plt.subplots(figsize=(8, 4), layout="constrained")
print("rider (kg)  chair at 12 rpm (m)  tension (N)  limit speed (rpm)  isolated from (rpm)  its shapes")
for mass, colour, *place in (
    (0, "#4f97c4", 19.5, 7.6), (40, "#2a82b8", 20.6, 10.4), (80, "#00629c", 19.3, 13.8),
    (120, "#00466f", 16.5, 14.1), (130, "#002a43", 13.6, 13.8),
):  # fmt: skip
    rig = with_rider(mass)
    shape = rc.steady_shape(rig, angular_speed="12 rpm")
    assert shape.stability().verdict == "minimum"
    limit = rpm(np.sqrt(rig.support.stiffness / (rig.chain.total_mass + rig.support.carriage)))
    diagram = rc.branches(rig, max_angular_speed="22 rpm")
    isolated = [branch for branch in diagram if branch.birth == "fold"]
    born = f"{rpm(isolated[0].angular_speed.min()):.2f}" if isolated else "-"
    verdicts = ", ".join(dict.fromkeys(w.verdict for b in isolated for w in b.stability_windows()))
    print(f"{mass:10} {shape.offset[0]:20.3f} {shape.tension[-1]:12.1f} {limit:18.2f} {born:>20}  {verdicts or '-'}")
    for branch in diagram:
        style = "-" if branch.birth == "rest" else "--"
        axes.plot(rpm(branch.angular_speed), branch.tip_radius, style, color=colour)
    axes.text(*place, f"{mass} kg" if mass else "empty chair", color=colour)
axes.set(xlabel="speed (rpm)", ylabel="distance of the chair from axis (m)", ylim=(-10, 15))
axes.text(20.8, -5, "dashed: isolated,\nchair beyond the axis", ha="right")
axes.axhline(0, color="0.6", linestyle="-.", linewidth=0.8)
axes.set_title("The mast yields: the heavier the rider, the farther out the chair goes")
plt.show()

# %%
# To try next: a stiffer mast, ``stiffness="4 kN/m"``, which doubles the limit speed.
#
# Checked: the rider of 120 kg is the scene ``examples/scenes/chair_o_plane.toml``, with its shape
# at 12 rpm in 40 digits from Lagrange's equations in
# ``examples/scenes/chair_o_plane.expected.json``. Stability:
# ``tests/python/test_rig_stability.py``.
