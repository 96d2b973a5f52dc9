# SPDX-License-Identifier: GPL-3.0-or-later
"""Chair-o-plane on a mast that yields
===================================

A chair-o-plane on a flexible mast, for five masses of the rider: where the chair hangs, up to which speed, and whether it is
stable.

Checked: the rider of 120 kg is the scene ``examples/scenes/chair_o_plane.toml``, with its shape at 12 rpm in 40 digits from
Lagrange's equations in ``examples/scenes/chair_o_plane.expected.json``. Stability: ``tests/python/test_rig_stability.py``.
"""

import numpy as np
from matplotlib.figure import Figure

import revchain as rc
from revchain.plots.programs import COLOURS, save
from revchain.plots.style import legend_outside

CHAIR = 8.0  # kg, without the rider
LIMIT = "22 rpm"


def with_rider(mass):
    """Chair and rider on 4 m of chain, on an arm of 3 m whose end moves sideways against a spring: the bending mast."""
    bodies = {"length": [1.0, 4.0], "centroid": [0.8, 2.0], "radius_of_gyration": [0.3, 4.0 / np.sqrt(12)]}
    chain = rc.Chain(mass=[CHAIR + mass, 10.0], **bodies)
    return rc.Rig(chain, support=rc.Support(radius=3.0, stiffness="1000 N/m", mass=30.0))


def rpm(speed):
    return 30 / np.pi * speed


axes = (figure := Figure(figsize=(8, 4), layout="constrained")).subplots()
print("rider (kg)  chair at 12 rpm (m)  tension (N)  limit speed (rpm)  isolated from (rpm)  its shapes")
for k, mass in enumerate((0, 40, 80, 120, 130)):
    rig = with_rider(mass)
    shape = rc.steady_shape(rig, angular_speed="12 rpm")
    assert shape.stability().verdict == "minimum"
    limit = rpm(np.sqrt(rig.support.stiffness / (rig.chain.total_mass + rig.support.carriage)))
    diagram = rc.branches(rig, max_angular_speed=LIMIT)
    assert diagram.complete
    isolated = [branch for branch in diagram if branch.birth == "fold"]
    born = f"{rpm(isolated[0].angular_speed.min()):.2f}" if isolated else "-"
    verdicts = ", ".join(dict.fromkeys(w.verdict for b in isolated for w in b.stability_windows()))
    print(f"{mass:10} {shape.offset[0]:20.3f} {shape.tension[-1]:12.1f} {limit:18.2f} {born:>20}  {verdicts or '-'}")
    for branch in diagram:
        style = "-" if branch.birth == "rest" else "--"
        label = f"rider of {mass} kg" if branch.birth == "rest" else None
        axes.plot(rpm(branch.angular_speed), branch.tip_radius, style, color=COLOURS[k % len(COLOURS)], label=label)
axes.set(xlabel="speed (rpm)", ylabel="offset of the chair from the axis (m)", ylim=(-20, 40))
axes.set_title("dashed: isolated branch, the chair on the other side of the axis")
legend_outside(axes)
save(figure, "chair_o_plane")
