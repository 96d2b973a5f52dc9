# SPDX-License-Identifier: GPL-3.0-or-later
"""Solve and draw every scene of docs/scenes.md.

python draw_scenes.py writes scene_NAME.svg into the current folder.
"""

from pathlib import Path

from matplotlib.figure import Figure

import revchain as rc
from revchain.plots.programs import save

SCENES = Path(__file__).resolve().parents[1] / "scenes"
NAMES = [
    *("rods_on_threads", "ball_on_chain", "clamped_bell", "jointed_rod", "carriage_on_springs"),
    *("bell_on_soft_frame", "swing_carousel", "chair_o_plane"),
    *("bicycle_wheels", "two_gyrostats", "moored_floats", "gyroscopes_under_float", "stokes_float", "broomstick"),
    *("acrobat", "troposkien", "plucked_chain"),
]
CLAPPER = {"mass": [18, 500], "length": [0.65, 0.15]}
BELLS = {
    "clamped_bell": {**CLAPPER, "centroid": [0.52, 0.05], "radius_of_gyration": [0.204, 0.36]},
    "bell_on_soft_frame": {**CLAPPER, "centroid": [0.52, 0.2], "radius_of_gyration": [0.204, 0.3]},
}



def drawn(name, scene, question, found):
    """The picture of the first answer: of bells beside the bell, of a broomstick with its lean."""
    if name in BELLS:
        figure = Figure(figsize=(8, 4.5), layout="constrained")
        modes, bell = figure.subplots(1, 2, width_ratios=[1.2, 1])
        rc.bell_and_clapper(rc.Chain(**BELLS[name])).plot(bell)
        bell.set_title("bell and clapper")
        bell.get_legend().remove()
        figure.legend(*bell.get_legend_handles_labels(), loc="outside lower center", ncols=3)
        return found.plot(modes)
    if question == "modes" and not len(found) and "response" in scene.asks:
        return found.plot(carried=scene.response())
    return found.plot()


for name in NAMES:
    scene = rc.load_scene(SCENES / f"{name}.toml")
    [question, found], *_ = scene.answers().items()
    axes = drawn(name, scene, question, found)
    count, what = (len(found), question.removesuffix("s")) if question != "swing" else (found.time.size, "time")
    axes.set_title(scene.title)
    axes.figure.set_figheight(min(4.5, axes.figure.get_figheight()))
    print(f"{scene.title}: {count} {what}{'s' * (count != 1)},", end=" ")
    save(axes.figure, f"scene_{name}")
