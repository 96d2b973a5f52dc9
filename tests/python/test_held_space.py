# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains held at both ends against shooting in space: where a list is complete there is no other shape, in any plane."""

import numpy as np
import pytest
from ends import G, Pins
from space import Shooting

import revchain as rc
from revchain import Support


def end(rng, kind):
    """A support: `firm` or `spring`, on the axis unless an arm is named, which may lie on either side."""
    radius = rng.choice([-1, 1]) * rng.uniform(0.1, 0.6) if "arm" in kind else 0.0
    if "spring" not in kind:
        return Support(radius=radius)
    return Support(stiffness=rng.uniform(100.0, 500.0), mass=rng.choice([0.0, 0.3]), radius=radius)


def held_at_random(rng, lower, upper):
    size = int(rng.integers(2, 5))
    while True:
        mass, length = rng.uniform(0.3, 2.0, size), rng.uniform(0.5, 1.5, size)
        ends = {"lower": end(rng, lower), "upper": end(rng, upper)}
        try:
            return rc.Held(rc.Chain(mass=mass, length=length), span=rng.uniform(0.2, 0.9) * length.sum(), **ends)
        except ValueError:  # firm ends are too far apart
            continue


PLANAR = [
    ("firm", "firm"),
    ("firm", "arm"),
    ("arm", "firm"),
    ("spring", "firm"),
    ("firm", "spring"),
    ("spring", "spring"),
    ("spring", "arm"),
    ("arm", "spring"),
    ("firm", "spring on an arm"),
    ("spring on an arm", "firm"),
    ("spring", "spring on an arm"),
]
TWISTED = [("arm", "arm"), ("arm", "spring on an arm"), ("spring on an arm", "arm"), ("spring on an arm", "spring on an arm")]


def check_planar(lower, upper, seed, starts):
    """The number of complete lists, none of which lacks a shape."""
    rng = np.random.default_rng(seed)
    held, most, speed = held_at_random(rng, lower, upper), int(rng.integers(1, 4)), rng.uniform(2.0, 15.0)
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G, max_half_waves=most)
    assert held.is_planar
    for place in Shooting(held, speed, G).shapes(rng, starts):
        assert np.abs(place[:, 1]).max() < 1e-6 * held.length
        if held.is_on_axis and np.abs(place[:, 0]).max() < 1e-6 * held.length:
            continue  # along the axis
        if shapes.complete and Pins(held, speed).half_waves(place[:, 0], place[:, 2]) <= most:
            assert any(np.abs(shape.offset - place[:, 0]).max() < 1e-6 * held.length for shape in shapes)
    return shapes.complete


def check_twisted(lower, upper, seed, starts):
    """Whether a shape leaves the plane of the ends."""
    rng = np.random.default_rng(seed)
    held, most, speed = held_at_random(rng, lower, upper), int(rng.integers(1, 4)), rng.uniform(2.0, 15.0)
    shapes = rc.steady_shapes(held, angular_speed=speed, gravity=G, max_half_waves=most)
    assert not held.is_planar and not shapes.complete
    return any(np.abs(place[:, 1]).max() > 1e-3 for place in Shooting(held, speed, G).shapes(rng, starts))


@pytest.mark.parametrize(("lower", "upper"), PLANAR)
def test_complete_lists_lack_no_shape_in_space(lower, upper):
    assert sum(check_planar(lower, upper, seed, 60) for seed in range(6)) >= 2


def test_shapes_between_two_arms_may_leave_the_plane_and_no_list_is_complete():
    assert sum(check_twisted(*ends, seed, 60) for ends in TWISTED for seed in range(3)) >= 3


def test_a_shape_out_of_the_plane_of_two_arms():
    """Three plummets with two shapes in the plane, both unstable; a third, out of it, is in tension."""
    chain = rc.Chain(
        mass=[0.7858013800881416, 0.5539307023816564, 0.8833688807855182],
        length=[1.3050029237453802, 1.3079407897364939, 1.0153255610421419],
    )
    arms = {"lower": Support(radius=0.3042366027099993), "upper": Support(radius=-0.222607681722941)}
    held, speed = rc.Held(chain, span=1.1769338342209616, **arms), 13.14413859626347
    shapes = rc.steady_shapes(held, angular_speed=speed, max_half_waves=2)
    found = Shooting(held, speed, G).shapes(np.random.default_rng(0), 500)
    out = [place for place in found if np.abs(place[:, 1]).max() > 0.1]
    assert len(found) - len(out) == len(shapes) == 2
    assert len(out) == 2  # two mirror images
    assert sorted(place[1, 1] for place in out) == pytest.approx([-1.2822, 1.2822], abs=1e-4)
    assert not shapes.complete and shapes.undecided.size == 0
    assert "2 shapes" in repr(shapes) and "there may be more" in repr(shapes)
    assert "both ends are off the axis: shapes that leave the plane of the ends are not searched for" in repr(shapes)


if __name__ == "__main__":
    for ends in PLANAR:
        print(*ends, sum(check_planar(*ends, seed, 120) for seed in range(1000, 1120)), "complete of 120")
    for ends in TWISTED:
        print(*ends, sum(check_twisted(*ends, seed, 100) for seed in range(1000, 1060)), "of 60 with shapes out of the plane")
