# SPDX-License-Identifier: GPL-3.0-or-later
"""Texts in pictures: names of links and pins, none over another, over the axes or outside of the picture."""

import itertools
import re
from pathlib import Path

import numpy as np
import pytest
import tier
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.text import Text

import revchain as rc
from revchain.motion import frames
from revchain.plots.scale import plot_to_scale
from revchain.plots.style import apart

SCENES = Path(__file__).resolve().parents[2] / "examples" / "scenes"
RNG = np.random.default_rng(6)
WORDS = ["load of concrete on four slings", "hook block with sheaves and cable drum", "jib", "rope of the auxiliary hoist", "ring", "swivel", "upper rope"]


def names(count):
    return [WORDS[k % 7] + (f" {k}" if count > 7 else "") for k in range(count)]


CHAINS = {
    "2 links": rc.Chain(mass=[2500, 400], length=[6, 24], names=names(2)),
    "7 links": rc.Chain(mass=[5, 1, 0.5, 0.2, 3, 0.1, 2], length=[1, 0.1, 0.05, 0.04, 2, 0.03, 1.5], names=names(7)),
    "12 links": rc.Chain(mass=1.0, length=RNG.uniform(0.05, 1, 12), names=names(12)),
    "30 links": rc.Chain(mass=1.0, length=RNG.uniform(0.2, 1, 30), names=names(30)),
}


def carried(chain):
    return rc.Rig(chain, support=rc.Support(radius=0.4 * float(np.sum(chain.length))))


def speeds(chain):
    return rc.modes(chain, 2).angular_speed


KINDS = {
    "system": lambda c: c.plot(),
    "rig": lambda c: rc.Rig(c, support=rc.Support(radius=2.0, stiffness=5e4, mass=30.0)).plot(),
    "modes": lambda c: rc.modes(c, min(c.size, 6)).plot(),
    "shapes": lambda c: rc.steady_shapes(c, angular_speed=1.1 * speeds(c)[0]).plot(),
    "shape": lambda c: rc.steady_shapes(carried(c), angular_speed=0.5 * speeds(c)[0])[0].plot(),
    "response": lambda c: rc.response(c, angular_speed=np.linspace(0.1, 1.2 * speeds(c)[1], 100), support_radius=0.01).plot(),
    "response at one speed": lambda c: rc.response(c, angular_speed=1.3 * speeds(c)[0], support_radius=0.01).plot(),
    "swing": lambda c: rc.swing(c, [0.0, 1.0, 2.0], offset=np.linspace(0.05 * c.size, 0.05, c.size)).plot(kind="time", pins=[0, 1]),
    "branch": lambda c: rc.branch(c, 1, min_conical_height=float(rc.modes(c, 1).conical_height[0]) / 2).plot(),
    "drag": lambda c: rc.drag_shape(carried(c), rc.Drag(1.0, area=0.1), angular_speed=0.5 * speeds(c)[0]).plot(),
    "to scale": plot_to_scale,
    "to scale, carried": lambda c: plot_to_scale(carried(c)),
}


def texts_of(figure):
    """The visible texts of a drawn figure, each with its box in pixels."""
    renderer, found = figure.canvas.get_renderer(), []
    for ax in figure.axes:
        if not ax.axison:
            axes = []
        else:
            axes = [
                label
                for axis in (ax.xaxis, ax.yaxis)
                for tick, label in zip(axis.get_major_ticks(), axis.get_ticklabels(), strict=True)
                if min(axis.get_view_interval()) <= tick.get_loc() <= max(axis.get_view_interval())
            ]
            axes += [ax.xaxis.label, ax.yaxis.label, ax.title]
        legend = ax.get_legend()
        found += [*axes, *ax.texts, *(legend.get_texts() if legend is not None else [])]
    found = [text for text in [*found, *figure.texts] if text.get_visible() and text.get_text().strip()]
    return [(text.get_text(), Text.get_window_extent(text, renderer)) for text in found]


def check(figure, tight=False):
    """No text lies over another, and none leaves the picture."""
    FigureCanvasAgg(figure).draw()
    boxes = texts_of(figure)
    for (one, box), (other, second) in itertools.combinations(boxes, 2):
        shared = box.x0 < second.x1 - 1 and second.x0 < box.x1 - 1 and box.y0 < second.y1 - 1 and second.y0 < box.y1 - 1
        assert not shared, f"{one!r} lies over {other!r}"
    if not tight:
        whole = figure.bbox
        for one, box in boxes:
            inside = box.x0 > -1 and box.y0 > -1 and box.x1 < whole.x1 + 1 and box.y1 < whole.y1 + 1
            assert inside, f"{one!r} leaves the picture"
    assert boxes
    return [one for one, _ in boxes]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("chain", CHAINS.values(), ids=CHAINS)
def test_texts_keep_clear(chain, kind):
    ax = np.atleast_1d(KINDS[kind](chain)).flat[0]
    written = check(ax.get_figure(root=True), tight=kind.startswith("to scale"))
    together = " ".join(" ".join(written).split())
    if chain.size <= 12 and kind != "drag":
        assert all(name in together for name in chain.names)
    if kind in ("response", "swing"):
        assert f"free end of {chain.names[0]}" in together and f"below {chain.names[1 if kind == 'swing' else max(1, chain.size // 4)]}" in together


@pytest.mark.parametrize("path", sorted(SCENES.glob("*.toml")), ids=lambda path: path.stem)
def test_scale_drawings_of_the_examples(path):
    written = check(plot_to_scale(rc.load_scene(path).system()).get_figure(root=True), tight=True)
    assert any(re.search(r"\d m$|\d m\b", text) for text in written)


def test_scale_drawings_are_to_scale():
    """A metre across is as long as a metre down, and each dimension is that of its link."""
    ax = plot_to_scale(rc.Rig(rc.Chain(mass=[1.0, 2.0], length=[3.0, 4.0]), support=rc.Support(radius=5.0)))
    (wide, _, _), (_, tall, _), _ = ax.transData.get_affine().get_matrix()
    assert wide == pytest.approx(tall, rel=1e-9)
    written = [text.get_text() for text in ax.texts if text.get_text()]
    assert sorted(written) == ["1 kg", "2 kg", "3 m", "4 m", "5 m", "7 m"]
    weights = plot_to_scale(rc.Chain(weight=[0.5], length=1.0))
    assert "0.5 N" in [text.get_text() for text in weights.texts]
    many = plot_to_scale(rc.Chain.uniform_rods(50, length=10.0, mass=5.0))
    assert {"50 × 0.2 m", "10 m", "50 × 0.1 kg"} <= {text.get_text() for text in many.texts}


@pytest.mark.parametrize(
    "system",
    [
        rc.Held(rc.Cord(2.0, mass=1.0), tension=50.0),
        rc.Held(rc.Chain.uniform_rods(8, length=3.0, mass=1.0), span=2.0, lower=rc.Support(radius=0.4), upper=rc.Support(radius=0.7)),
        rc.SleeveGovernor(ball_mass=1.5, arm=0.12, pivot_offset=0.12, sleeve_arm=0.06, sleeve_mass=2.0, spring_stiffness=5000.0, spring_force=150.0, lowest_inclination=-0.2, highest_inclination=0.3),
        rc.SleeveGovernor(ball_mass=1.0, arm=0.5),
        rc.Rig(rc.Chain(mass=1000.0, length=2.0), support=rc.Support(mass=100.0)),
        rc.Chain(mass=[1.0], length=1e-6, names=["a name that is very much longer than its link " * 3]),
    ],
    ids=["held cord", "held off the axis", "Hartnell", "conical pendulum", "trolley", "tiny"],
)
def test_scale_drawings_of_other_systems(system):
    check(plot_to_scale(system).get_figure(root=True), tight=True)


def test_films_have_names(tmp_path, monkeypatch):
    made = []

    class Seen(frames.Drawing):
        def __init__(self, film):
            super().__init__(film)
            made.append(self)

    monkeypatch.setattr(frames, "Drawing", Seen)
    for chain, seen in ((CHAINS["7 links"], True), (CHAINS["30 links"], False), (rc.Chain(mass=[1.0, 2.0], length=1.0), False)):
        rc.modes(chain, 2).animate(tmp_path / "a.gif", duration=0.2)
        written = " ".join(" ".join(text.get_text() for text in made.pop().ax.texts).split())
        assert all((name in written) == seen for name in chain.names or ["link"])


# ---- texts apart


def test_apart():
    assert apart([1.0, 5.0], 1.0).tolist() == [1.0, 5.0]  # as they are
    assert apart([1.0, 1.0], 1.0).tolist() == [0.5, 1.5]
    assert apart([1.0, 1.0], [1.0, 3.0]).tolist() == [0.0, 2.0]
    assert apart([0.2, 0.1], 0.5, 0.0, 2.0).tolist() == [0.75, 0.25]
    assert apart([], 1.0).size == 0


def test_random_texts_apart():
    """None overlap, their order stays, they are within the ends if there is room, and no smaller move does it."""
    for _ in range(tier.by_tier(50, 1000)):
        count = int(RNG.integers(1, 15))
        places, sizes = RNG.uniform(0, 10, count), RNG.uniform(0.05, 0.5, count)
        moved = apart(places, sizes, 0.0, 10.0)
        order = np.argsort(places)
        gaps = np.diff(moved[order]) - (sizes[order][1:] + sizes[order][:-1]) / 2
        assert (gaps > -1e-12).all()
        assert (moved - sizes / 2 > -1e-12).all() and (moved + sizes / 2 < 10 + 1e-12).all()
        free = apart(places, sizes)
        for _ in range(20):  # another way that is allowed moves them farther
            other = free[order] + np.sort(RNG.uniform(-0.3, 0.3, count))
            assert ((other - places[order]) ** 2).sum() >= ((free - places) ** 2).sum() - 1e-9
