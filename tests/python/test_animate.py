# SPDX-License-Identifier: GPL-3.0-or-later
"""Films: every position in them is that of the result, at its time."""

import html
import re
import subprocess

import numpy as np
import pytest
from moving import ALL, CHAIN, ONE, RELEASED, TIMES, WHEELS, film

import revchain as rc
from revchain.motion.film import pace

pytest.importorskip("matplotlib")
image = pytest.importorskip("PIL.Image")

TURN = 2 * np.pi


# ---- what is where, and when


def test_modes_turn_at_their_own_speeds():
    found = rc.modes(WHEELS)
    shown = film(found, duration=2.0, time_scale=0.1)
    assert len(shown.figures) == min(len(found), 6) and shown.frames == 50 and shown.seconds == 2.0
    for k, figure in enumerate(shown.figures):
        assert np.allclose(figure.offset[0].real / figure.scale[0], found.shape[k], rtol=1e-15, atol=0)
        assert np.allclose(figure.phase, found.angular_speed[k] * 0.1 * np.arange(50) / 25, rtol=1e-14, atol=0)
        assert figure.captions[0].splitlines()[1] == f"{found.angular_speed[k]:#.4g} rad/s".replace("-", "\N{MINUS SIGN}")
        whirled = figure.scale[0] * found.shape[k] * np.exp(1j * found.angular_speed[k] * 0.1 * 30 / 25)
        assert np.allclose(figure.in_space(30), whirled, atol=1e-15)
    assert {figure.label.split()[-1] for figure in shown.figures} == {"forward", "backward"}
    assert shown.words == "gravity 9.80665 m/s²; 10 times slower than real time; offsets exaggerated"


def test_the_pace():
    found = rc.modes(rc.Chain.uniform_rods(20, length=1.0), 3)
    shown = film(found)
    turns = TURN / (np.abs(found.angular_speed) * shown.time_scale)  # seconds of film
    assert turns.min() >= 0.8 * (1 - 1e-2) and abs(turns.max() - shown.seconds) < 1e-12  # the slowest closes its round
    twice = film(found, duration=2.5 * shown.seconds)
    assert abs(turns.max() * shown.time_scale / twice.time_scale * 2 - twice.seconds) < 1e-12
    assert film(found, time_scale=0.01).seconds == 10.0
    one = film(rc.modes(CHAIN, 1))
    assert abs(one.figures[0].phase[1] * one.frames - TURN) < 1e-12
    assert pace(1.0) == "in real time"
    assert (pace(0.125), pace(20.0)) == ("8 times slower than real time", "20 times faster than real time")


@pytest.mark.parametrize("kind", ["shapes", "shapes of a carousel", "shapes of a blade", "shapes on arms", "shape"])
def test_shapes_are_true_to_scale(kind):
    found = ALL[kind]()
    shapes = [found] if kind == "shape" else [found[-1], found[0]]
    shown = film(found, figures=None if kind == "shape" else [len(found) - 1, 0])
    for figure, shape in zip(shown.figures, shapes, strict=True):
        assert np.array_equal(figure.offset[0], shape.offset) and np.array_equal(figure.height[0], shape.height)
        assert figure.speed[0] == shape.angular_speed


def test_places_of_cords():
    for kind in ("cord shape", "held cord shape", "shapes of a rope"):
        found = ALL[kind]()
        shape = found[0] if kind == "shapes of a rope" else found
        figure = film(found).figures[0]
        at = shape.along(np.linspace(0, 1, 101))
        assert np.array_equal(figure.offset[0], at.offset) and np.array_equal(figure.height[0], at.height)


def test_a_branch_is_gone_through_from_end_to_end():
    branch = rc.branch(CHAIN, 1, max_angular_speed=9.0)
    shown = film(branch, duration=3.0)
    [figure] = shown.figures
    assert np.array_equal(figure.offset[0], np.zeros(4)) and figure.height[0, 0] == -CHAIN.total_length
    assert np.allclose(figure.offset[-1], branch.shape(-1).offset, rtol=1e-15)
    assert np.allclose(figure.height[-1], branch.shape(-1).height, rtol=1e-14)
    assert figure.speed[0] == branch.angular_speed[0] and figure.speed[-1] == branch.angular_speed[-1]
    chords = np.hypot(np.diff(figure.offset.real, axis=1), np.diff(figure.height, axis=1))
    assert np.abs(chords / CHAIN.length - 1).max() < 3e-3  # between points, shapes are interpolated
    mean = (figure.speed[1:] + figure.speed[:-1]) / 2
    assert np.allclose(np.diff(figure.phase), mean * shown.time_scale / 25, rtol=1e-9)
    for frame in (20, 40, 60):  # what is shown is a shape of that speed
        assert abs(float(shown.progress[frame].split()[2]) / figure.speed[frame] - 1) < 6e-3
        [shape] = branch.at(angular_speed=figure.speed[frame])
        assert np.abs(figure.offset[frame] - shape.offset).max() < 5e-3
        assert abs(shown.chart.x[0][frame] - figure.speed[frame]) < 1e-12
        assert abs(shown.chart.y[0][frame] - abs(shape.offset[0])) < 5e-3


def test_a_branch_passes_its_folds():
    found = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), max_angular_speed=13.0)
    isolated = [branch for branch in found if branch.folds.size]
    assert isolated
    for branch in isolated:
        speeds = film(branch, duration=20.0).figures[0].speed
        assert all(np.abs(speeds - branch.angular_speed[fold]).min() < 1e-3 for fold in branch.folds)


def test_a_response_goes_out_at_its_speeds():
    found = ONE["response"]()
    [figure] = film(found, duration=81 / 25).figures
    assert np.allclose(figure.speed, found.angular_speed, rtol=1e-12)
    assert np.allclose(figure.offset.real / figure.scale[:, None], found.offset, rtol=1e-9, atol=1e-12)
    widest = np.abs(figure.offset).max(axis=1)
    assert widest.max() <= 0.25 * CHAIN.total_length * (1 + 1e-12) and np.ptp(figure.scale) > 0
    assert figure.captions[-1].endswith(f"offsets {figure.scale[-1]:.3g}:1")
    resonant = [3.0, float(rc.modes(CHAIN).angular_speed[0]), 4.0]
    driven = rc.response(CHAIN, angular_speed=resonant, support_radius=0.01)
    assert np.isfinite(film(driven).figures[0].offset).all()


@pytest.mark.parametrize("kind", ["swing", "rig swing", "whirl swing", "cord swing"])
def test_a_swing_is_where_it_is_at_each_time(kind):
    found = ONE[kind]()
    shown = film(found, time_scale=1.0, frames_per_second=10.0)
    [figure] = shown.figures
    assert shown.frames == TIMES.size - 1  # the film ends one frame before the last time, so that it runs as long
    true = figure.offset / figure.scale[0]
    assert np.abs(true - found.offset[:-1]).max() < 1e-14
    assert shown.progress[3] == f"Time: {TIMES[3]:.3f} s" and not figure.phase.any()


def test_bodies_are_on_their_links():
    bodies = film(rc.modes(WHEELS)).bodies
    assert bodies.link.tolist() == [0, 1, 2, 3] and np.allclose(bodies.along, 0.5)
    assert bodies.wheel.tolist() == [1, -1, 1, 1]  # two are at rest
    assert not bodies.rod.any()  # a rod ends at its lower pin
    assert film(rc.modes(rc.Chain.uniform_rods(3))).bodies.rod.tolist() == pytest.approx([0.5] * 3)
    assert film(rc.modes(CHAIN)).names == ("links[0] load", "links[1] $hook$", "links[2] </script>")
    assert film(ONE["cord shape"]()).bodies.along.tolist() == [1.0]


def test_thinned_films_keep_the_ends():
    whole = film(rc.modes(rc.Chain.uniform_rods(10_000), 2))
    few = whole.thinned(whole.frames, 300)
    for one, other in zip(few.figures, whole.figures, strict=True):
        assert one.offset.shape == (1, 300)
        assert np.array_equal(one.offset[0, [0, -1]], other.offset[0, [0, -1]])
    swing = film(ONE["swing"]())
    fewer = swing.thinned(11, 100)
    assert fewer.frames == 11 and fewer.progress[-1] == swing.progress[-1] and fewer.bodies is swing.bodies
    assert abs((fewer.frames - 1) / fewer.frames_per_second - (swing.frames - 1) / swing.frames_per_second) < 1e-12


# ---- films


@pytest.mark.parametrize("kind", ALL)
def test_gif(kind, tmp_path):
    path = tmp_path / "film.gif"
    told = []
    ALL[kind]().animate(path, duration=0.6, frames_per_second=10, progress=lambda *done: told.append(done))
    with image.open(path) as film_:
        assert film_.n_frames == 6 and film_.info["loop"] == 0 and film_.info["duration"] == 100
        pictures = []
        for frame in range(6):
            film_.seek(frame)
            pictures.append(np.asarray(film_.convert("RGB"), int))
    assert all(np.abs(one - other).max() > 100 for one, other in zip(pictures, pictures[1:], strict=False))
    assert (pictures[0] == 255).all(axis=2).mean() > 0.8  # on white paper
    assert told == [(k, 6) for k in range(1, 7)]


def test_places_of_pixels(tmp_path):
    """The free end of a mode is drawn where its film has it, in its colour."""
    from matplotlib.colors import to_rgb

    from revchain.motion.frames import Drawing, seen
    from revchain.plots.style import house

    found = rc.modes(rc.Chain.uniform_rods(120, length=0.36), 6)
    shown = film(found, duration=1.0)
    drawing = Drawing(shown)
    for frame, picture in enumerate(drawing.frames(lambda done, total: None)):
        for nth, figure in enumerate(shown.figures):
            row = figure.in_space(frame)
            x, y = seen(row[[5, 60]], figure.height[0, [5, 60]], drawing.across[nth])
            for column, line in drawing.ax.transData.transform(np.column_stack([x, y])):
                around = picture[int(len(picture) - line) - 1 :, int(column) - 1 :][:3, :3] / 255.0
                assert np.abs(around - to_rgb(house(nth))).max(axis=2).min() < 0.25, (frame, nth)


def test_arms_of_a_carousel_are_drawn_with_it():
    """In each frame the arm ends at the support, as it is in that frame."""
    from revchain.motion.frames import Drawing

    shown = film(ALL["shapes of a carousel"](), duration=0.4)
    drawing = Drawing(shown)
    drawn = {artist: [] for artist, _ in drawing.moving if hasattr(artist, "get_xdata")}
    for line, places in drawn.items():
        line.draw = lambda renderer, line=line, places=places, draw=line.draw: (
            places.append(np.array(line.get_data())),
            draw(renderer),
        )
    assert len([*drawing.frames(lambda done, total: None)]) == shown.frames
    arms = [places for line, places in drawn.items() if line.get_color() == "0.3"]
    chains = [places for line, places in drawn.items() if len(line.get_xdata()) == 3 and line.get_color()[0] == "#"]
    assert len(arms) == len(chains) == len(shown.figures)
    for arm, chain in zip(arms, chains, strict=True):
        assert len(arm) == len(chain) == shown.frames
        assert all(np.array_equal(one[:, 1], other[:, -1]) for one, other in zip(arm, chain, strict=True))


def test_mp4(tmp_path):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    path = tmp_path / "film.mp4"
    for kind in ("modes of a rig", "branch"):
        ALL[kind]().animate(path, duration=0.6)
        read = [ffmpeg.get_ffmpeg_exe(), "-i", path, "-f", "rawvideo", "-pix_fmt", "rgb24", "-"]
        done = subprocess.run(read, capture_output=True, check=True)
        [about] = re.findall(r"Stream #0:0.*?: Video: (h264.*)", done.stderr.decode())[:1]
        wide, tall = map(int, re.findall(r"(\d{3,})x(\d{3,})", about)[0])
        frames = np.frombuffer(done.stdout, np.uint8).reshape(-1, tall, wide, 3).astype(int)
        assert "yuv420p" in about and "25 fps" in about and len(frames) == 15
        assert np.abs(frames[0] - frames[-1]).max() > 100 and (frames[0] > 250).all(axis=2).mean() > 0.8


def test_ffmpeg_that_fails(tmp_path, monkeypatch):
    ffmpeg = pytest.importorskip("imageio_ffmpeg")
    program = tmp_path / "ffmpeg"
    program.write_text("#!/bin/sh\necho no such codec >&2\nexit 1\n")
    program.chmod(0o755)
    monkeypatch.setattr(ffmpeg, "get_ffmpeg_exe", lambda: str(program))
    with pytest.raises(OSError, match="ffmpeg says: no such codec"):
        rc.modes(CHAIN).animate(tmp_path / "film.mp4", duration=0.4)
    assert not (tmp_path / "film.mp4").exists()


# ---- what is refused


REFUSED = [
    ("modes", {"path": "film.avi"}, r"Modes\.animate: path must end in \.gif, \.mp4, \.html, got film\.avi"),
    ("modes", {"figures": [4]}, r"mode must be from 1 to 3, got 4"),
    ("modes", {"figures": []}, r"modes names no mode"),
    ("modes", {"figures": 1.5}, r"modes must be a list of whole numbers, got 1\.5"),
    ("modes", {"time_scale": 0.0}, r"time_scale must be positive and finite, got 0"),
    ("modes", {"time_scale": 1e6}, r"Modes\.animate: no figure may turn more than 5000 times; lower time_scale"),
    ("modes", {"duration": -1.0}, r"duration must be positive"),
    ("modes", {"duration": 1e9}, r"duration times frames_per_second must be at most 20000, got 1e\+09 s at 25"),
    ("modes", {"frames_per_second": np.inf}, r"frames_per_second must be positive and finite"),
    ("modes", {"frames_per_second": 1e4}, r"frames_per_second must be from 0\.1 to 1000, got 10000"),
    ("shapes", {"figures": [9]}, r"SteadyShapes\.animate: figures must be from -\d to \d, got 9"),
    ("shapes", {"figures": []}, r"figures names no shape"),
    ("branches", {"figures": [99]}, r"Branches\.animate: figures must be from"),
    ("shape", {"figures": [0]}, r"SteadyShape\.animate: figures is for several modes, shapes or branches"),
    ("swing", {"figures": [0]}, r"Swing\.animate: figures is for several"),
    ("modes", {"path": "a.gltf"}, r"Modes\.to_glb: path must end in \.glb, got a\.gltf"),
    ("modes", {"path": "a.glb", "figures": [0]}, r"Modes\.to_glb: figures|mode must be from 1 to 3, got 0"),
]


@pytest.mark.parametrize(("kind", "given", "words"), REFUSED)
def test_refused(kind, given, words, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    path = given.get("path", "film.html")
    with pytest.raises(ValueError, match=words):
        getattr(ALL[kind](), "to_glb" if path.startswith("a.") else "animate")(**{"path": path, **given})
    assert list(tmp_path.iterdir()) == []


def test_nothing_to_show(tmp_path):
    driven = rc.response(CHAIN, angular_speed=[3.0, 4.0], pins=[0, 1])
    for found, words in (
        (rc.modes(CHAIN, angular_speed=(0.0, 0.1)), "there are no modes"),
        (rc.steady_shapes(CHAIN, angular_speed=0.1), "there is no shape to draw"),
        (rc.branches(CHAIN, max_angular_speed=0.5), "there is no branch to draw"),
        (driven, "every pin is needed; compute the response without pins="),
        (rc.response(CHAIN, angular_speed=[]), "no speed to draw that is not a resonance"),
        (rc.swing(CHAIN, [1.0], offset=RELEASED), "needs two times or more"),
    ):
        with pytest.raises(ValueError, match=words):
            found.animate(tmp_path / "page.html")
    assert list(tmp_path.iterdir()) == []


def test_what_cannot_be_written_leaves_what_was_there(tmp_path):
    path = tmp_path / "film.gif"
    path.write_text("before")

    def stop(done, total):
        raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        rc.modes(CHAIN).animate(path, duration=0.2, progress=stop)
    assert path.read_text() == "before" and [each.name for each in tmp_path.iterdir()] == ["film.gif"]
    with pytest.raises(OSError, match=r"No such file or directory.*film\.gif"):
        rc.modes(CHAIN).animate(tmp_path / "missing" / "film.gif")


def test_the_view_of_a_notebook_is_the_page(tmp_path):
    shapes = rc.steady_shapes(CHAIN, conical_height=0.1)
    shapes.animate(tmp_path / "shapes.html", figures=[0], time_scale=0.5)
    shown = shapes.show(figures=[0], time_scale=0.5, height=500)._repr_html_()
    page = re.search(r'<iframe srcdoc="([^"]*)" style="width: 100%; height: 500px; border: 0"></iframe>', shown)[1]
    assert html.unescape(page) == (tmp_path / "shapes.html").read_text(encoding="utf-8")
    with pytest.raises(ValueError, match=r"revchain\.SteadyShapes\.show: no figure may turn more than 5000 times"):
        shapes.show(duration=800, time_scale=1000.0)
    with pytest.raises(ValueError, match=r"revchain\.SteadyShapes\.show: height must be positive and finite, got 0"):
        shapes.show(height=0)


def test_packages_that_are_missing(python, without):
    """Films need them; pages and 3D models do not."""
    program = without("matplotlib", "PIL", "imageio_ffmpeg") + (
        "import revchain as rc\n"
        "m = rc.modes(rc.Chain.uniform_rods(12), 2)\n"
        "for path in ('a.gif', 'a.mp4'):\n"
        "    try: m.animate(path)\n"
        "    except ImportError as error: print(error)\n"
        "m.animate('a.html'); m.to_glb('a.glb'); m.show()\n"
    )
    done = python("-c", program)
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines() == [
        'a .gif film needs matplotlib: pip install "revchain[animate]"',
        'a .mp4 film needs matplotlib: pip install "revchain[animate]"',
    ]


def test_every_kind_of_moving_result_is_here():
    from revchain.results.moving import Moving

    def kinds(of):
        return {of} | {each for kind in of.__subclasses__() for each in kinds(kind)}

    shown = {kind.__name__ for kind in kinds(Moving) if not kind.__name__.startswith("_")}
    assert shown == {type(make()).__name__ for make in ALL.values()} | {"Moving"}


def test_speeds_of_both_directions_are_in_the_chart():
    rig = rc.Rig(CHAIN, flywheels=rc.Flywheel(momentum=0.3))
    both = film(rc.response(rig, angular_speed=np.linspace(-3.0, 3.0, 30), support_radius=0.01))
    assert both.chart.x[0][0] == -3.0 and both.chart.x[0][-1] == 3.0 and (np.diff(both.figures[0].phase)[:100] < 0).all()
    back = film(rc.branch(rig, 1, max_angular_speed=9.0, direction=-1))
    assert (back.chart.x[0] > 0).all() and (back.figures[0].speed < 0).all()
    [(line, _)] = back.chart.lines
    assert (line > 0).all() and (line.min(), line.max()) == (back.chart.x[0].min(), back.chart.x[0].max())


def test_a_swing_ends_with_its_last_time():
    rig = rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0), pins=rc.Pin(damping=0.1))
    found = film(rc.swing(rig, np.linspace(0, 5, 101), offset=[0.1, 0, 0]), time_scale=1.0, duration=10.0)
    offset = found.figures[0].offset / found.figures[0].scale[:, None]
    assert np.abs(offset).max() <= 0.1 + 1e-9 and found.progress[-1] == "Time: 5.000 s"


def test_rings_of_a_thinned_film_stay_with_their_links():
    low = np.arange(800) < 400
    centroid, gyration = np.where(low, 0.01, 0.005), np.where(low, 0.0, 0.01 / 12**0.5)
    found = film(rc.modes(rc.Chain(mass=1.0, length=0.01, centroid=centroid, radius_of_gyration=gyration), 1))
    thin = found.thinned(found.frames, 401)
    assert 0 < thin.rings.sum() < 400 and np.array_equal(thin.rings, found.rings[::2])


def test_a_response_says_its_scale_at_one_speed():
    chain = rc.Chain(mass=[1.0, 2.0, 1.0], length=1.0)
    one = film(rc.response(chain, angular_speed=6.0, support_radius=3.0)).figures[0]
    assert one.captions[0].endswith(f"offsets {one.scale[0]:.3g}:1") and one.scale[0] != 1
    slow = film(rc.response(chain, angular_speed=[0.01, 0.011], support_radius=3.0)).figures[0]
    assert all("offsets 0.25:1" in caption for caption in slow.captions)
