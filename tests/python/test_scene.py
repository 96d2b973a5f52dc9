# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: what they may say, what is said where they are wrong, and the schema for editors."""

import json
import math
import tomllib

import numpy as np
import pytest
from hypothesis import example, given, settings
from hypothesis import strategies as st
from tier import by_tier

import revchain as rc
from revchain.scenes import tables as hung
from revchain.scenes.tables import QUESTIONS, Ask, AskModes, Link, Spread, UniformChain
from revchain.scenes.scene import Scene, json_schema

_HANGING = ("Link", "UniformChain", "TaperedChain", "Cord", "PointMass", "AirDrag", "Support", "Flywheel", "Displaced", "Pin", "Held", "End", "Governor")

ONE = {"mass": 1.0, "length": 1.0}


def scene(**entries):
    return Scene.from_dict({"links": [dict(ONE)], **entries})


def links(*tables, **entries):
    return Scene.from_dict({"links": list(tables), **entries})


def test_links_one_by_one():
    given = links(
        {"mass": 2.0, "length": 0.5},
        {"weight": 3.0, "length": 0.4, "kind": "rod", "repeat": 2},
        {"mass": 1.0, "length": 0.3, "centroid": -0.01, "radius_of_gyration": 0.2},
        {"mass": 0, "length": 1},
        {"mass": 1.0, "length": 0.3, "centroid": 0.1, "pendulum_length": 0.5},
        gravity=10.0,
    )
    chain = given.system()
    assert chain.weight.tolist() == [20.0, 3.0, 3.0, 10.0, 0.0, 10.0]
    assert chain.length.tolist() == [0.5, 0.4, 0.4, 0.3, 1.0, 0.3]
    assert chain.centroid.tolist() == [0.5, 0.2, 0.2, -0.01, 1.0, 0.1]
    np.testing.assert_allclose(
        chain.radius_of_gyration, [0, 0.4 / 12**0.5, 0.4 / 12**0.5, 0.2, 0, 0.2], rtol=4 * 2.0**-52
    )


def test_uniform_chain_is_the_one_of_the_api():
    for kind, make in (("rods", rc.Chain.uniform_rods), ("plummets", rc.Chain.uniform_plummets)):
        given = Scene.from_dict({"uniform_chain": {"kind": kind, "count": 50, "length": 2.0, "weight": 3.0}})
        assert given.system() == make(50, 2.0, 3.0)


def test_what_is_asked():
    many = dict(ONE, repeat=30)
    assert len(links(dict(ONE, repeat=3)).modes()) == 3
    coarse = links(many, ask={"modes": {"rtol": "0.1 %"}}).modes()
    assert coarse.rtol == 1e-3 and links(many).modes().error_bound.max() < 1e-15 < coarse.error_bound.max()
    assert links(dict(ONE, repeat=4)).modes(method="dense").method == "dense"


@pytest.mark.parametrize(
    ("entry", "text", "value"),
    [
        ("length", "39.1396 inch", 39.1396 * 0.0254),
        ("length", "100cm", 1.0),
        ("length", "  +1.5e2 mm ", 0.15),
        ("length", ".5 m", 0.5),
        ("length", "2 ft", 0.6096),
        ("mass", "2 lb", 2 * 0.45359237),
        ("mass", "5 gram", 0.005),
    ],
)
def test_units(entry, text, value):
    chain = links({**ONE, entry: text}, gravity=1.0).system()
    found = chain.mass[0] if entry == "mass" else chain.length[0]
    assert found == pytest.approx(value, rel=4 * 2.0**-52)


def test_units_of_force_and_gravity():
    body = {"weight": "3 N", "length": 1, "centroid": "-1 mm", "radius_of_gyration": "5 cm"}
    chain = links({"weight": "20 N", "length": 1}, body).system()
    assert chain.centroid[1] == -0.001 and chain.radius_of_gyration[1] == 0.05
    assert links({"weight": "2 kN", "length": 1}).system().weight[0] == 2000.0
    assert scene(gravity="981 cm/s^2").gravity_value() == pytest.approx(9.81, rel=4 * 2.0**-52)
    assert scene(gravity="32.174 ft/s**2").gravity_value() == pytest.approx(9.80664, abs=1e-5)


def test_json_and_toml_say_the_same(tmp_path):
    (tmp_path / "a.toml").write_text('\ufefftitle = "x"\n[[links]]\nmass = 1\nlength = "2 m"\n', encoding="utf-8")
    (tmp_path / "a.json").write_text('{"title": "x", "links": [{"mass": 1, "length": "2 m"}]}')
    assert rc.load_scene(tmp_path / "a.toml") == rc.load_scene(str(tmp_path / "a.json"))


def test_structs_can_be_written_in_python():
    by_hand = Scene(links=[Link(mass=1.0, length=1.0, repeat=2)], ask=Ask(modes=AskModes(count=1)))
    assert by_hand == links({**ONE, "repeat": 2}, ask={"modes": {"count": 1}})
    assert Scene(uniform_chain=UniformChain(kind="rods", count=3, length=1.0, mass=1.0)).system().size == 3
    with pytest.raises(rc.SceneError, match="scene: links.0..length: must be positive"):
        Scene(links=[Link(mass=1.0, length=-1.0)]).system()
    with pytest.raises(AttributeError):
        by_hand.title = "other"


def test_errors_without_pint_say_how_to_get_it(python, without):
    program = without("pint") + (
        "import revchain as rc\n"
        "assert rc.Scene.from_dict({'links': [{'mass': 1, 'length': 2}]}).system().size == 1\n"
        "try: rc.Scene.from_dict({'links': [{'mass': 1, 'length': '2 m'}]})\n"
        "except rc.SceneError as error: print(error)\n"
    )
    done = python("-c", program)
    assert done.stdout == 'scene: links[0].length: a number with a unit needs pint: pip install "revchain[units]"\n', (
        done.stderr
    )


numbers = st.floats(allow_nan=True) | st.integers() | st.sampled_from(["1 m", "2 kg", "3 N", "1 m/s^2", "x"])
table = st.dictionaries(
    st.sampled_from(["length", "mass", "weight", "kind", "centroid", "pendulum_length", "radius_of_gyration", "other"]),
    numbers | st.sampled_from(["rod", "plummet"]) | st.none() | st.booleans() | st.lists(st.integers(), max_size=1),
)
scenes = st.dictionaries(
    st.sampled_from(["links", "uniform_chain", "gravity", "ask", "title", "schema_version", "`", " - at `$`"]),
    numbers
    | table
    | st.lists(table, max_size=3)
    | st.dictionaries(
        st.sampled_from(["modes", "shapes", "response", "swing"]),
        numbers | st.dictionaries(st.sampled_from(["count", "rtol", "angular_speed"]), numbers | st.lists(numbers)),
    ),
)


@settings(max_examples=by_tier(100, 500))
@given(scenes)
@example({"ask": {"response": {"angular_speed": []}, "modes": 1}})  # an empty list beside a number for a table
def test_whatever_a_scene_says_there_is_an_answer_or_a_scene_error(data):
    try:
        made = Scene.from_dict(data)
    except rc.SceneError as error:
        assert str(error).startswith("scene: ")
    else:
        made.modes()


finite = st.floats(0.01, 100.0)
good_link = st.fixed_dictionaries(
    {"mass": finite, "length": finite},
    optional={"repeat": st.integers(1, 4), "kind": st.sampled_from(["rod", "plummet"])},
)


@given(st.lists(good_link, min_size=1, max_size=4), st.integers(1, 3), finite)
def test_round_trip_through_dict_and_files(tmp_path, tables, modes, gravity):
    count = sum(entry.get("repeat", 1) for entry in tables)
    data = {"title": "t", "gravity": gravity, "links": tables, "ask": {"modes": {"count": min(modes, count)}}}
    made = Scene.from_dict(data)
    assert Scene.from_dict(made.to_dict()) == made
    (tmp_path / "a.json").write_text(json.dumps(made.to_dict()))
    again = rc.load_scene(tmp_path / "a.json")
    assert again == made and again.system() == made.system()


def test_defaults_are_left_out_of_the_dict():
    data = {"links": [{"mass": 0.1, "length": "20 inch"}]}
    assert Scene.from_dict(data).to_dict() == data
    assert repr(scene()) == "Scene(links=[Link(length=1.0, mass=1.0)])"


def test_the_schema_is_one_that_accepts_the_examples(repository):
    """It is a valid JSON Schema, it refuses a wrong scene, and it accepts every scene of the examples."""
    jsonschema = pytest.importorskip("jsonschema")
    schema = json_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    validator = jsonschema.Draft202012Validator(schema)
    scenes = sorted((repository / "examples/scenes").glob("*.toml"))
    assert len(scenes) > 20
    for path in scenes:
        validator.validate(tomllib.loads(path.read_text(encoding="utf-8")))
    assert not validator.is_valid({"links": [{"mass": 1}]})


def test_the_schema_knows_every_key():
    tables = json_schema()["$defs"]
    asked = {table.__name__: table for table in (*QUESTIONS.values(), Ask, Spread)}
    hanging = {name: getattr(hung, name) for name in _HANGING}
    assert set(tables) == {"Scene", *asked, *hanging}
    for name, table in {"Scene": Scene, **asked, **hanging}.items():
        assert list(tables[name]["properties"]) == list(table.__struct_encode_fields__)
        assert tables[name]["additionalProperties"] is False
        assert all("description" in entry for entry in tables[name]["properties"].values())


@pytest.mark.parametrize("text", ["1 m**9**9**9", "1 m^9^9^9", "1 m*9**9**9**9/m", "1 m**99", "1 " + "m*" * 200 + "m"])
def test_units_are_not_a_calculator(text):
    with pytest.raises(ValueError, match=r"links\[0\].length"):
        links({"mass": 1.0, "length": text}).system()


RODS = {"uniform_chain": {"kind": "rods", "count": 30, "length": 1, "mass": 1}}


@pytest.mark.parametrize(
    ("modes", "numbers"),
    [
        ({}, range(1, 11)),
        ({"count": 3}, range(1, 4)),
        ({"count": "all"}, range(1, 31)),
        ({"first": 5}, range(5, 15)),
        ({"first": 25}, range(25, 31)),
        ({"first": 25, "count": 2}, range(25, 27)),
    ],
)
def test_which_modes_are_asked_for(modes, numbers):
    assert rc.Scene.from_dict({**RODS, "ask": {"modes": modes}}).modes().number.tolist() == list(numbers)
    assert rc.Scene.from_dict(RODS).modes(**modes).number.tolist() == list(numbers)


@pytest.mark.parametrize(
    ("modes", "low", "high"),
    [
        ({"conical_height": [0, 0.01]}, 0, 0.01),
        ({"conical_height": ["1 mm", "40 cm"]}, 0.001, 0.4),
        ({"conical_height": [0.01, math.inf]}, 0.01, math.inf),
        ({"conical_height": [0.8, "1 mile"]}, 0.8, 1609.344),
        ({"angular_speed": ["600 deg/s", 40], "certify": True}, 9.80665 / 1600, 9.80665 / math.radians(600) ** 2),
        ({"angular_speed": [0, math.inf]}, 0, math.inf),
    ],
)
def test_which_window_is_asked_for(modes, low, high):
    scene = rc.Scene.from_dict({**RODS, "ask": {"modes": modes}})
    every = rc.modes(scene.system(), "all")
    inside = (low < every.conical_height) & (every.conical_height <= high)
    assert scene.modes().number.tolist() == every.number[inside].tolist()


def test_what_is_asked_gives_way_to_arguments():
    scene = rc.Scene.from_dict({**RODS, "ask": {"modes": {"count": 3, "rtol": 0.01}}})
    assert scene.asks == ("modes",) and scene.modes(first=29).number.tolist() == [29, 30]
    assert len(scene.modes(conical_height=("1 cm", 1.0))) == len(rc.modes(scene.system(), conical_height=(0.01, 1.0)))
    assert scene.modes().rtol == scene.modes(first=29).rtol == 0.01
    with pytest.raises(rc.SceneError, match="scene: ask.modes.cuont: unknown key; did you mean count"):
        scene.modes(cuont=3)


def test_links_from_the_support_down():
    """And their names."""
    listed = [{**ONE, "name": "load", "tip_mass": 1}, {"mass": 2.0, "length": 0.5, "repeat": 2}, {"mass": 3.0, "length": "1 ft"}]
    down, up = links(*listed[::-1], order="support first"), links(*listed)
    assert down.system().mass.tolist() == up.system().mass.tolist() == [2, 2, 2, 3] and down.system().order == "support first"
    assert down.system().names == ("load", "links[1]", "links[1]", "links[0]")  # those without a name: as in the file
    assert up.system().names == ("load", "links[1]", "links[1]", "links[2]")
    named = [{**link, "name": name} for link, name in zip(listed, "abc", strict=True)]
    assert links(*named[::-1], order="support first").system() == links(*named).system()
    assert "load: 2 kg on 1 m" in down.system().describe()
    clamped = [{**ONE, "clamped": True}, {**ONE, "standing": True}]
    assert links(*clamped[::-1], order="support first").system() == links(*clamped).system()


def test_masses_and_weights():
    assert links(ONE).system() == rc.Chain(mass=1.0, length=1.0)
    mixed = links(ONE, {"weight": 3.0, "length": 1.0}, gravity=10.0)
    assert mixed.system() == rc.Chain(weight=[10.0, 3.0], length=[1.0, 1.0])
    assert links({"weight": 3.0, "length": 1.0, "tip_mass": 2.0}, gravity=10.0).system().weight.tolist() == [23.0]
    lunar = links(ONE, gravity="1.62 m/s^2")
    assert lunar.modes().gravity == 1.62 and lunar.modes().angular_speed[0] == pytest.approx(1.62**0.5, rel=1e-15)


def test_a_cord():
    cord = {"cord": {"length": "36 cm", "mass": 0.2, "density": 0.5, "tip_mass": "1 g"}, "ask": {"modes": {"count": 3}}}
    made = rc.Scene.from_dict(cord)
    assert made.system() == rc.Cord(0.36, mass=0.2, density=0.5, tip_mass=0.001)
    assert made.modes() == rc.modes(rc.Cord(0.36, mass=0.2, density=0.5, tip_mass=0.001), 3)
    rope = rc.Scene.from_dict({"cord": {"length": 1, "mass": 1}, "held": {"span": 0.5}})
    shapes = rope.steady_shapes(angular_speed="200 rpm", max_half_waves=2)
    assert len(shapes) == 2 and shapes.system == rc.Held(rc.Cord(1.0, mass=1.0), span=0.5)


def test_ends_on_arms_and_springs():
    lower, upper = {"stiffness": "2 kN/m", "mass": 0.3}, {"radius": "-50 cm"}
    made = rc.Scene.from_dict({**RODS, "held": {"span": 0.6, "lower": lower, "upper": upper}})
    ends = {"lower": rc.Support(stiffness=2000.0, mass=0.3), "upper": rc.Support(radius=-0.5)}
    assert made.system() == rc.Held(rc.Scene.from_dict(RODS).system(), span=0.6, **ends)
    for held, message in (
        ({"span": 0.6, "lower": {"mass": 0.3}}, r"held\.lower: end must be firm or on a spring"),
        ({"span": 0.6, "upper": {"radius": 30.0}}, r"held\.span: the ends must be nearer"),
        ({"tension": 200.0, "upper": {"radius": 0.1}}, r"held\.upper: end must be on the axis under a tension"),
        ({"span": 0.6, "upper": {"stiffness": -1.0}}, r"held\.upper\.stiffness"),
    ):
        with pytest.raises(rc.SceneError, match=message):
            rc.Scene.from_dict({**RODS, "held": held}).system()


def test_certify_and_precision_of_a_scene():
    result = rc.Scene.from_dict({**RODS, "ask": {"modes": {"count": 2, "certify": True, "precision": "extended"}}}).modes()
    assert result.precision == "extended" and result.certificate.above_lower.tolist() == [1, 2]
