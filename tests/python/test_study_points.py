# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies of random systems of every kind: each value of each point is that of the single call at this point."""

import numpy as np
import pytest

import revchain as rc

pytest.importorskip("xarray")


def number(rng, low, high):
    return float(rng.uniform(low, high))


def vary(rng, low, high):
    return {"uniform": [low, number(rng, low, high) + 1e-3]}


def links(rng, kind="any", size=None):
    found = []
    for _ in range(size or int(rng.integers(2, 5))):
        length = number(rng, 0.3, 1.2)
        link = {"mass": number(rng, 0.2, 2.0), "length": length}
        if kind == "rods" or (kind == "any" and rng.random() < 0.5):
            link["kind"] = "rod"
        elif kind == "any" and rng.random() < 0.5:
            link |= {"centroid": number(rng, 0.3, 0.9) * length, "radius_of_gyration": number(rng, 0.05, 0.3) * length}
        found.append(link)
    return found


def speeds(rng, *more):
    ask = {"shapes": {"angular_speed": number(rng, 3.0, 12.0)}}
    return ask | {name: {"angular_speed": [2.0, number(rng, 3.0, 9.0)]} for name in more} | {"modes": {"count": 2}}


def chain(rng):
    return {"links": links(rng), "ask": speeds(rng, "response")}, {"links[0].length": vary(rng, 0.2, 1.0)}


def whole(rng):
    uniform = {"kind": str(rng.choice(["rods", "plummets"])), "count": 4, "length": 1.5, "mass": 1.0}
    return {"uniform_chain": uniform, "ask": speeds(rng, "response")}, {"uniform_chain.length": vary(rng, 0.5, 2.0)}


def rig(rng):
    scene = {"links": links(rng), "support": {"radius": number(rng, 0.01, 0.2)}, "ask": speeds(rng, "response")}
    if rng.random() < 0.5:
        scene["support"] |= {"stiffness": number(rng, 300.0, 900.0), "mass": 0.2}
    if rng.random() < 0.5:
        scene["links"][0]["flywheel"] = {"mass": 0.5, "radius_of_gyration": 0.1, "spin": number(rng, -30.0, 30.0)}
    return scene, {"support.radius": vary(rng, 0.01, 0.3)}


def cord(rng):
    scene = {"cord": {"length": 1.5, "mass": 1.0}, "ask": speeds(rng)}
    if rng.random() < 0.5:
        scene["cord"] |= {"tip_mass": number(rng, 0.1, 1.0)}
    if rng.random() < 0.5:
        scene["cord"] |= {"density": number(rng, -0.5, 0.5)}
    return scene, {"cord.length": vary(rng, 0.5, 2.0)}


def held(rng):
    """At a span: on the axis, on arms, on springs; at some points too slow for any shape, or too far apart."""
    found = links(rng, str(rng.choice(["rods", "plummets"])))
    length = sum(link["length"] for link in found)
    scene = {"links": found, "held": {"span": 0.6 * length}, "ask": speeds(rng)}
    scene["ask"]["shapes"]["max_half_waves"] = int(rng.integers(1, 3))
    for end in ("lower", "upper"):
        if rng.random() < 0.4:
            scene["held"][end] = {"radius": number(rng, -0.3, 0.3)}
        elif rng.random() < 0.4:
            scene["held"][end] = {"stiffness": number(rng, 100.0, 900.0)}
    del scene["ask"]["modes"]
    span = {"uniform": [0.2 * length, 1.05 * length]}
    return scene, {"held.span": span, "ask.shapes.angular_speed": {"uniform": [0.5, 15.0]}}


def held_straight(rng):
    scene = {"links": links(rng, size=4), "held": {"tension": 90.0}, "ask": speeds(rng)}
    return scene, {"held.tension": {"uniform": [20.0, 150.0]}}


def held_cord(rng):
    scene = {"cord": {"length": 1.5, "mass": 1.0}, "held": {"span": 1.0}, "ask": speeds(rng)}
    scene["held"]["weightless"] = bool(rng.random() < 0.5)
    scene["ask"]["shapes"]["max_half_waves"] = 2
    del scene["ask"]["modes"]
    return scene, {"held.span": {"uniform": [0.3, 1.6]}}


KINDS = [chain, whole, rig, cord, held, held_straight, held_cord]


def of_modes(scene):
    m = scene.modes()
    names = ("angular_speed", "conical_height", "error_bound")
    if m.system._kind != "rig":
        return {name: getattr(m, name) for name in names}, m.status == "success"
    found = {"other_modes": m.other_available, "modes_complete": m.complete}
    for turn, which in (("forward", m.direction > 0), ("backward", m.direction < 0)):
        for name in (*names, "speed_error_bound"):
            found[f"{turn}_{name}"] = np.abs(getattr(m, name)[which])
    return found, m.status == "success"


def of_shapes(scene):
    shapes = scene.steady_shapes()
    return {
        "shapes": len(shapes),
        "shapes_complete": shapes.complete,
        "half_waves": [s.half_waves for s in shapes],
        "lowest_inclination": [s.inclination[0] for s in shapes],
        "top_inclination": [s.inclination[-1] for s in shapes],
        "free_end_offset": [s.offset[0] for s in shapes],
        "top_tension": [s.tension[-1] for s in shapes],
        "shape_error_bound": [s.error_bound for s in shapes],
    }, shapes.complete


def of_response(scene):
    moved = scene.response()
    offset = np.atleast_2d(moved.offset)
    return {
        "response_angular_speed": moved.angular_speed,
        "response_free_end_offset": offset[:, 0],
        "response_largest_offset": np.abs(offset).max(axis=1),
        "support_force": moved.support_force,
        "response_error_bound": moved.error_bound,
    }, bool(np.isfinite(moved.error_bound).all())


def check(kind, seed, samples=3):
    """The number of values that are compared; every value of every point is."""
    rng = np.random.default_rng(seed)
    scene, varied = kind(rng)
    asked = [name for name in ("modes", "shapes", "response") if name in scene["ask"]]
    study = rc.Study.from_dict({"scene": scene, "vary": varied, "samples": samples, "seed": seed, "find": asked, "error_bounds": True})
    found = rc.sweep(study)
    ask = {"modes": of_modes, "shapes": of_shapes, "response": of_response}
    compared = 0
    flat = {name: found[name].to_numpy().reshape(samples, *found[name].shape[1:]) for name in found.data_vars}
    results = [name for name in flat if name not in (*varied, "status")]
    for point in range(samples):
        try:
            answers = [ask[name](study.scene_at(point)) for name in asked]
        except ValueError:
            assert flat["status"][point] == 3
            continue
        assert flat["status"][point] == (1 if all(good for _, good in answers) else 2)
        want = {name: value for values, _ in answers for name, value in values.items()}
        assert set(results) <= set(want)
        for name in results:
            row, values = np.atleast_1d(flat[name][point]), np.atleast_1d(np.asarray(want[name], flat[name].dtype))
            there = min(row.size, values.size)
            assert row[:there].tobytes() == values[:there].tobytes(), (name, row, values)
            assert (np.isnan(row[there:]) if row.dtype.kind == "f" else row[there:] == 0).all(), name
            compared += row.size
    return compared


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_value_of_a_study_is_that_of_the_single_call(kind):
    assert sum(check(kind, seed) for seed in range(5)) > 60


def test_what_is_proved_of_shapes_between_held_ends():
    """A list that is complete and empty is a success; one that is undecided is not, even if no half waves are missing."""
    three = {"links": [{"mass": 1.0, "length": 1.0, "repeat": 3}], "held": {"span": 2.0}, "ask": {"shapes": {"angular_speed": 1.0}}}
    found = rc.sweep({"scene": three, "vary": {"ask.shapes.angular_speed": {"values": [1.0]}}})
    assert found["shapes"][0] == 0 and found["shapes_complete"][0] and found["status"][0] == 1
    twenty = {"uniform_chain": {"kind": "rods", "count": 20, "length": 24.0, "mass": 160.0}, "held": {"span": 17.0}}
    found = rc.sweep({"scene": {**twenty, "ask": {"shapes": {"angular_speed": 3.0}}}, "vary": {"held.span": {"values": [17.0]}}})
    assert found["shapes"][0] == 1 and not found["shapes_complete"][0] and found["status"][0] == 2


if __name__ == "__main__":
    for kind in KINDS:
        print(kind.__name__, sum(check(kind, seed, 4) for seed in range(1000, 1040)), "values of 160 points, none differs")
