# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve and draw every scene of docs/scenes.md.

python draw_scenes.py writes scene_NAME.svg into the current folder.
"""

from pathlib import Path

import matplotlib.pyplot as plt

import revchain as rc
from revchain.plots.programs import save

SCENES = Path(__file__).resolve().parents[2] / "examples/scenes"
NAMES = [
    *("rods_on_threads", "ball_on_chain", "clamped_bell", "jointed_rod", "carriage_on_springs"),
    *("bell_on_soft_frame", "swing_carousel", "chair_o_plane"),
    *("bicycle_wheels", "two_gyrostats", "moored_floats", "gyroscopes_under_float", "stokes_float", "broomstick"),
    *("acrobat", "troposkien", "plucked_chain", "crane_brakes", "crane_brakes_shaped", "hanging_cable"),
    *("clasp_on_cord", "whirling_machine"),
    "porter_governor",
]

COUNTS = {"swing": lambda found: (found.time.size, "times"), "drag": lambda found: (1, "shapes")}


def drawn(scene, question, found):
    """The picture of the first answer: of a broomstick with its lean."""
    if question == "modes" and not len(found) and "response" in scene.asks:
        return found.plot(carried=scene.response())
    return found.plot(speed="rpm") if question == "shapes" else found.plot()


for name in NAMES:
    scene = rc.load_scene(SCENES / f"{name}.toml")
    [question, found], *_ = scene.answers().items()
    axes = drawn(scene, question, found)
    count, what = (len(found), question) if question not in COUNTS else COUNTS[question](found)
    axes.set_title(scene.title)
    print(f"{scene.title}: {count} {what if count != 1 else what[:-1]},", end=" ")
    save(axes.figure, f"scene_{name}")
    plt.close(axes.figure)
