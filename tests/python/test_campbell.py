# SPDX-License-Identifier: GPL-3.0-or-later
"""Campbell diagrams: crossings against Lagrange's equations in 60 digits, closed forms, tables and what is refused."""

import math
import pickle

import mpmath as mp
import numpy as np
import pytest
from exact import near
from rigs import exponents, rigged, small_motions

import revchain as rc

CAROUSEL = rc.Rig(rc.Chain(mass=80.0, length=4.0), support=rc.Support(radius=3.0))


def test_one_link_that_turns_freely_on_the_axis():
    """n sqrt(1 + 3 cos^2 d) out of the vertical, section 7 (6): it meets 1n never, and 2n nowhere but at the height of the thread."""
    found = rc.campbell(rc.Chain(mass=1.0, length=1.0), [4.0, 6.0, 9.0])
    cosine = 9.80665 / found.angular_speed**2
    assert found.frequency[:, 0] == near(found.angular_speed * np.sqrt(1 + 3 * cosine**2), rel=1e-13)
    assert found.crossings == () and found.stable.all() and found.frequency.shape == (3, 1)


def test_one_link_driven_meets_1n_never_and_is_at_rest_in_the_vertical():
    """n sin d in the plane that is driven."""
    found = rc.campbell(rc.Chain(mass=1.0, length=1.0), [4.0, 6.0, 9.0], frame="driven")
    cosine = 9.80665 / found.angular_speed**2
    assert found.frequency[:, 0] == near(found.angular_speed * np.sqrt(1 - cosine**2), rel=1e-12)
    below = rc.campbell(rc.Chain(mass=1.0, length=1.0), [1.0, 2.0, 6.0])
    assert np.isnan(below.frequency[:2]).all() and below.stable.tolist() == [False, False, True]


@pytest.mark.parametrize("name", ["carousel", "two bodies on a spring"])
def test_crossings_against_lagranges_equations(name):
    if name == "carousel":
        rig = rigged(rc.Chain(weight=800.0, length=4.0), radius=3.0)
    else:
        bodies = rc.Chain(weight=[1280.0, 100.0], length=[1.0, 4.0], centroid=[0.8, 2.0], radius_of_gyration=[0.3, 1.1547])
        rig = rigged(bodies, radius=3.0, stiffness=1000.0, carriage=300.0)
    found = rc.campbell(rig, np.linspace(0.3, 1.6, 14))
    assert len(found.crossings) >= 2 and {one.order for one in found.crossings} == {1, 2}
    for one in found.crossings:
        shapes = rc.steady_shapes(rig, angular_speed=one.angular_speed)
        shape = max((s for s in shapes if s.half_waves == 1), key=lambda s: s.offset[0])
        exact = exponents(small_motions(rig, shape))
        above = sorted(float(mp.im(s)) for s in exact if mp.im(s) > 1e-9)
        assert above[one.motion - 1] == near(one.order, rel=1e-9)


def test_tables_files_pictures(tmp_path):
    found = rc.campbell(CAROUSEL, np.linspace(0.3, 1.5, 13), orders=[1, 3])
    assert found.over_speed == near(found.frequency[:, 0] / found.angular_speed, rel=1e-15)
    one = found.crossings[0]
    assert one.order == 1 and one.rpm == near(one.angular_speed * 30 / math.pi, rel=1e-15)
    text = str(found)
    assert "1n meets frequency 1 at 7.7" in text and "Campbell diagram: 2 frequencies" in text
    assert pickle.loads(pickle.dumps(found)) == found
    for name in ("c.npz", "c.nc"):
        found.save(tmp_path / name)
        assert rc.load(tmp_path / name) == found
    assert found.to_dict()["speeds"][0]["rpm"] == found.rpm[0]
    assert found.plot(speed="Hz").get_xlabel() == "frequency (Hz)"
    with pytest.raises(ValueError, match='must be "rpm", "rad/s" or "Hz"'):
        found.plot(speed="s")


def test_an_order_listed_twice_counts_once():
    speeds = np.linspace(0.2, 1.6, 15)
    once, twice = (rc.campbell(CAROUSEL, speeds, orders=orders) for orders in ([2, 1], [2, 1, 1, 2]))
    assert twice == once and twice.orders == (2, 1) and len(once.crossings) > 1
    assert len({(one.order, one.motion, one.angular_speed) for one in twice.crossings}) == len(twice.crossings)
    scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 4}], "support": {"radius": 4}})
    assert scene.campbell(angular_speed=[0.5, 1.0], orders=[1, 1]).orders == (1,)


def test_a_fluid_that_turns():
    floats = rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0), displaced=rc.Displaced(mass=[0.1, 0.0]), fluid="turning")
    with pytest.raises(ValueError, match="revchain.campbell: no small motion .* fluid that turns; use steady_shapes"):
        rc.campbell(floats, [6.0, 8.0])


@pytest.mark.parametrize(
    ("given", "words"),
    [
        ({"angular_speed": [1.0]}, "at least two ascending speeds"),
        ({"angular_speed": [2.0, 1.0]}, "at least two ascending speeds"),
        ({"angular_speed": [-1.0, 1.0]}, "angular_speed must be positive"),
        ({"orders": []}, "orders must be whole positive numbers"),
        ({"orders": [0]}, "orders must be whole positive numbers"),
        ({"half_waves": 4}, r"at none of the speeds, [\d.]+ to [\d.]+ rad/s, is there a shape with this number of half_waves, got 4"),
        ({"frame": "fixed"}, "frame"),
    ],
)
def test_what_is_refused(given, words):
    with pytest.raises(ValueError, match=words):
        rc.campbell(CAROUSEL, **({"angular_speed": [1.0, 2.0]} | given))
    with pytest.raises(ValueError, match="use its chain"):
        rc.campbell(rc.Cord(1.0), [5.0, 6.0])
