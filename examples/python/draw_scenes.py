# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve and draw every scene of docs/scenes.md.

python draw_scenes.py [FOLDER]
"""

from pathlib import Path
from typing import Any

from _picture import save

import revchain as rc

SCENES = Path(__file__).resolve().parents[1] / "scenes"
NAMES = [
    *("rods_on_threads", "ball_on_chain", "clamped_bell", "jointed_rod", "carriage_on_springs"),
    *("bell_on_soft_frame", "swing_carousel", "chair_o_plane"),
    *("bicycle_wheels", "two_gyrostats", "moored_floats", "gyroscopes_under_float", "stokes_float", "broomstick"),
    *("acrobat", "troposkien", "plucked_chain"),
]

for name in NAMES:
    scene = rc.load_scene(SCENES / f"{name}.toml")
    [question, found], *_ = scene.answers().items()
    axes = found.plot()
    count, what = (len(found), question.removesuffix("s")) if question != "swing" else (found.time.size, "time")
    axes.set_title(scene.title)
    axes.figure.set_size_inches(axes.figure.get_figwidth(), 4.5)
    print(f"{scene.title}: {count} {what}{'s' * (count != 1)},", end=" ")
    save(axes.figure, f"scene_{name}")
