# SPDX-License-Identifier: GPL-3.0-or-later
"""Every scene of docs/scenes.md solved and drawn: what a scene file can hold.

python draw_scenes.py [FOLDER]
"""

from pathlib import Path

from _picture import save

import revchain as rc

SCENES = Path(__file__).resolve().parents[1] / "scenes"
NAMES = [
    *("rods_on_threads", "ball_on_chain", "clamped_bell", "jointed_rod", "carriage_on_springs", "swing_carousel"),
    *("bicycle_wheels", "two_gyrostats", "moored_floats", "stokes_float", "broomstick", "acrobat"),
]

for name in NAMES:
    scene = rc.load_scene(SCENES / f"{name}.toml")
    found = scene.modes()
    carried = scene.response() if scene.is_carried else None
    axes = found.plot(carried=carried) if scene.is_rigged else found.plot(gravity=scene.gravity_value())
    axes.set_title(scene.title)
    axes.figure.set_size_inches(axes.figure.get_figwidth(), 4.5)
    print(f"{scene.title}: {len(found)} mode{'s' * (len(found) != 1)},", end=" ")
    save(axes.figure, f"scene_{name}")
