# SPDX-License-Identifier: GPL-3.0-or-later
"""Studies of every kind of system: each value of each point is that of the single call at this point."""

import numpy as np
import pytest
from studies import CAROUSEL, GOVERNOR, GYROSTAT, STOPS, UNIFORM, normal, uniform, words

import revchain as rc

pytest.importorskip("xarray")


ROD = {"mass": 1.0, "length": 0.5, "kind": "rod"}
BODY = {"weight": 2.0, "length": 0.4, "centroid": 0.2, "pendulum_length": 0.3}
WHEEL = {"mass": 0.5, "radius_of_gyration": 0.2, "spin": 40.0}
LINKS = {"links": [ROD, BODY, {"mass": 1, "length": 0.3, "repeat": 3}]}
TAPERED = {"tapered_chain": {"count": 12, "exponent": 1.0, "length": 1.0, "mass": 1.0, "tip_weight": 0.1}}
LONG = {"uniform_chain": {"kind": "rods", "count": 150, "length": 3.0, "mass": 1.0}, "ask": {"modes": {"count": 3, "rtol": "1 %"}}}

# Scenes that batches do not serve, and what varies: numbers of every kind, some of which the scene refuses.
SINGLE = {
    "bounds": ({**LINKS, "ask": {"modes": {"count": "all"}}}, {"links[0].mass": uniform(0.1, 2), "gravity": uniform(1, 10), "links[1].pendulum_length": normal(0.3, 0.1), "links[1].centroid": normal(0.2, 0.2)}),
    "too tight": ({"links": [ROD, BODY], "ask": {"modes": {"count": 1, "first": 2, "rtol": 6e-16}}}, {"links[0].mass": uniform(0.1, 2)}),
    "many links, a tolerance": (LONG, {"uniform_chain.length": uniform(1, 2), "uniform_chain.mass": normal(1, 1)}),
    "massless": ({"links": [ROD, {"mass": 0.0, "length": 0.2}, BODY]}, {"links[1].mass": words(0.0, 0.1), "links[0].length": uniform(0.1, 1)}),
    "tips and clamps": ({"links": [{**ROD, "tip_mass": 0.2}, {**BODY, "clamped": True}, {**ROD, "tip_weight": 1.0}, ROD]}, {"links[0].tip_mass": normal(0.2, 0.2), "links[2].tip_weight": uniform(0, 1), "links[1].clamped": words(True, False)}),
    "a tip that the scene has not": ({"links": [ROD, BODY]}, {"links[0].tip_mass": uniform(0, 0.2)}),
    "counts and kinds": (UNIFORM, {"uniform_chain.kind": words("rods", "plummets"), "uniform_chain.count": {"from": 1, "to": 9, "steps": 3}, "uniform_chain.tip_mass": uniform(-0.1, 1)}),
    "tapered": (TAPERED, {"tapered_chain.exponent": uniform(-1.2, 2), "tapered_chain.tip_weight": uniform(0, 1)}),
    "method": ({"links": [ROD, BODY], "ask": {"modes": {"method": "bisection", "certify": True}}}, {"links[0].mass": uniform(0.1, 2)}),
    "spring": ({**LINKS, "support": {"stiffness": 50.0, "mass": 0.1}}, {"support.stiffness": normal(50, 50), "support.mass": normal(0.1, 0.1), "gravity": normal(10, 3)}),
    "wheels": ({"links": [{**ROD, "flywheel": WHEEL}, {**BODY, "flywheel": {**WHEEL, "driven": True}}, ROD]}, {"links[0].flywheel.spin": normal(0, 50), "links[0].flywheel.radius_of_gyration": normal(0.2, 0.2), "gravity": uniform(5, 10)}),
    "fluid": ({"links": [{**ROD, "displaced": {"mass": 0.3, "centroid": 0.2, "added_mass": 0.0}}, {**BODY, "displaced": {"weight": 0.3}}, ROD]}, {"fluid": words("still", "turning"), "links[0].displaced.mass": normal(0.3, 0.3), "links[0].displaced.added_mass": words(0.0, 0.1), "links[1].displaced.radius_of_gyration": uniform(0, 0.2)}),
    "standing": ({"links": [ROD, {**ROD, "standing": True}], "support": {"stiffness": 500.0}}, {"links[0].mass": uniform(0.1, 2), "links[1].standing": words(True, False)}),
    "shapes": ({**LINKS, "ask": {"shapes": {"angular_speed": 9.0}}}, {"ask.shapes.angular_speed": uniform(-3, 12), "links[0].mass": uniform(0.1, 2)}),
    "shapes of a rig": ({"links": [{**ROD, "flywheel": WHEEL}, ROD], "support": {"radius": 0.2}, "ask": {"shapes": {"conical_height": 0.3, "direction": -1, "hanging_only": False}}}, {"ask.shapes.conical_height": uniform(0.1, 0.5)}),
    "the support first": ({"order": "support first", "links": [ROD, {**BODY, "tip_weight": 1.0}, {**BODY, "displaced": {"weight": 0.3}}]}, {"links[0].mass": uniform(0.1, 2), "links[2].displaced.weight": uniform(-0.1, 1), "links[1].tip_weight": uniform(0, 1)}),
    "many speeds": ({"links": [ROD, ROD], "ask": {"response": {"angular_speed": ["30 rpm", 7.0]}}}, {"ask.response.angular_speed[1]": uniform(0.1, 9), "gravity": normal(9, 1)}),
    "response": ({"links": [ROD, ROD], "ask": {"response": {"conical_height": [1.0]}}}, {"ask.response.conical_height[0]": uniform(-0.1, 1)}),
    "held at a tension": ({"links": [{"mass": 1.0, "length": 0.5, "repeat": 3}], "held": {"tension": "50 N"}}, {"held.tension": words("40 N", 60.0)}),
    "held at a span": ({"links": [{"mass": 1.0, "length": 0.5, "repeat": 3}], "held": {"span": 1.2}, "ask": {"shapes": {"angular_speed": 20.0}}}, {"held.span": words(1.2, "1.3 m")}),
    "governor": ({"governor": {**GOVERNOR, **STOPS}}, {"governor.sleeve_mass": uniform(-1, 12), "governor.spring_stiffness": uniform(0, 2000), "gravity": uniform(9, 10)}),
    "balls of a governor": ({"governor": {**GOVERNOR, **STOPS}}, {"governor.balls": words(1, 2, 3)}),
    "governor at a speed": ({"governor": GOVERNOR, "ask": {"equilibria": {"angular_speed": "125 rpm"}}}, {"ask.equilibria.angular_speed": uniform(-1, 20)}),
    "campbell": ({**CAROUSEL, "ask": {"campbell": {"angular_speed": {"from": 0.3, "to": 1.5, "steps": 7}, "orders": [2, 1]}}}, {"links[0].length": uniform(-1, 8), "support.radius": uniform(0.1, 5)}),
    "drag": (
        {"support": {"radius": 2}, "links": [{"mass": 1, "length": 1, "air_drag": {"coefficient": 1, "area": "9 cm^2"}}] * 2, "ask": {"drag": {"angular_speed": 3.0}}},
        {"links[0].air_drag.area": uniform(-1e-3, 0.1), "links[1].length": uniform(0.1, 3), "ask.drag.angular_speed": uniform(0.1, 5)},
    ),
    "campbell and response": ({**CAROUSEL, "ask": {"campbell": {"angular_speed": [1.0, 1.2, 1.4]}, "response": {"angular_speed": [0.5, 0.6]}}}, {"links[0].mass": uniform(1, 100)}),
    "everything": (GYROSTAT, {"links[1].flywheel.spin": words("-300 rpm", 50.0), "links[0].length": uniform(-0.1, 1), "ask.response.angular_speed.to": uniform(5, 12)}),
}  # fmt: skip


def number(rng, low, high):
    return float(rng.uniform(low, high))


def vary(rng, low, high):
    return uniform(low, number(rng, low, high) + 1e-3)


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
    span = uniform(0.2 * length, 1.05 * length)
    return scene, {"held.span": span, "ask.shapes.angular_speed": uniform(0.5, 15.0)}


def held_straight(rng):
    scene = {"links": links(rng, size=4), "held": {"tension": 90.0}, "ask": speeds(rng)}
    return scene, {"held.tension": uniform(20.0, 150.0)}


def held_cord(rng):
    scene = {"cord": {"length": 1.5, "mass": 1.0}, "held": {"span": 1.0}, "ask": speeds(rng)}
    scene["held"]["weightless"] = bool(rng.random() < 0.5)
    scene["ask"]["shapes"]["max_half_waves"] = 2
    del scene["ask"]["modes"]
    return scene, {"held.span": uniform(0.3, 1.6)}


KINDS = [chain, whole, rig, cord, held, held_straight, held_cord]


def of_modes(scene):
    m = scene.modes()
    names = ("angular_speed", "conical_height", "error_bound")
    if m.system._kind != "rig":
        return {name: getattr(m, name) for name in names}, m.status == "success"
    found = {"other_modes": m.other_available, "modes_complete": m.complete}
    if not m.has_momentum:
        return found | {name: getattr(m, name) for name in (*names, "speed_error_bound")}, m.status == "success"
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


def of_campbell(scene):
    found = rc.campbell(scene.system(), scene.campbell().angular_speed, orders=scene.campbell().orders, gravity=scene.gravity_value())
    first = [min([np.inf, *(c.angular_speed for c in found.crossings if c.order == k)]) for k in found.orders]
    return {
        "first_crossing": [np.nan if n == np.inf else n for n in first],
        "lowest_frequency": found.frequency[:, 0],
        "stable": found.stable,
    }, True


def of_equilibria(scene):
    governor, found = scene.system(), {}
    if "lowest_inclination" in scene.to_dict()["governor"]:
        low, high = governor.at(governor._given["lowest_inclination"]), governor.at(governor._given["highest_inclination"])
        found = {"lowest_speed": low.angular_speed, "highest_speed": high.angular_speed, "sleeve_lift": high.lift - low.lift}
        found |= {"sensitiveness": governor.sensitiveness, "insensitiveness": governor.insensitiveness}
    if "equilibria" in scene.asks:
        there = governor.equilibria(scene.ask.equilibria.angular_speed)
        found["equilibria"] = len(there)
        for name in ("inclination", "lift", "ball_radius", "period", "stable"):
            found[f"equilibrium_{name}"] = [getattr(one, name) for one in there]
    return found, True


def of_drag(scene):
    found = scene.drag_shape()
    return {"drag_torque": found.torque, "drag_power": found.power, "drag_factor": found.factor}, found.status == "success"


ANSWERS = {"drag": of_drag, "modes": of_modes, "shapes": of_shapes, "response": of_response, "campbell": of_campbell, "equilibria": of_equilibria}


def check(study):
    """The number of values that are compared, bit for bit, and of points that are refused."""
    found, find = rc.sweep(study), study._plan("").find
    points = found["status"].size
    results = {str(name): array for name, array in found.data_vars.items() if "path" not in array.attrs}
    flat = {name: array.to_numpy().reshape(points, *array.shape[found["status"].ndim :]) for name, array in results.items()}
    status, compared = flat.pop("status"), 0
    for point in range(points):
        try:
            answers = [ANSWERS[name](study.scene_at(point)) for name in find]
        except (ValueError, OverflowError):
            assert status[point] == 3
            continue
        assert status[point] == (1 if all(good for _, good in answers) else 2)
        want = {name: value for values, _ in answers for name, value in values.items()}
        for name, rows in flat.items():
            row, values = np.atleast_1d(rows[point]), np.atleast_1d(np.asarray(want[name], rows.dtype))
            there = min(row.size, values.size)
            assert row[:there].tobytes() == values[:there].tobytes(), (name, row, values)
            assert (np.isnan(row[there:]) if row.dtype.kind == "f" else row[there:] == 0).all(), name
            compared += row.size
    return compared, np.count_nonzero(status == 3)


def check_random(kind, seed, samples=3):
    scene, varied = kind(np.random.default_rng(seed))
    asked = [name for name in ("modes", "shapes", "response") if name in scene["ask"]]
    more = {"samples": samples, "seed": seed, "find": asked, "error_bounds": True}
    return check(rc.Study.from_dict({"scene": scene, "vary": varied, **more}))[0]


@pytest.mark.parametrize(("scene", "vary"), SINGLE.values(), ids=SINGLE.keys())
def test_every_value_of_every_kind_of_scene(scene, vary):
    """All results and refusals."""
    is_random = any("values" not in law and "from" not in law for law in vary.values())
    more = {"samples": 12, "seed": 5} if is_random else {}
    study = rc.Study.from_dict({"scene": scene, "vary": vary, "max_shapes": 3, "error_bounds": True, **more})
    assert study._plan("").links is None and check(study)[1] < study.points


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_every_value_of_random_systems(kind):
    assert sum(check_random(kind, seed) for seed in range(5)) > 60


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
        print(kind.__name__, sum(check_random(kind, seed, 4) for seed in range(1000, 1040)), "values of 160 points, none differs")
