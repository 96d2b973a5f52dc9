# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: what they may say, what is said where they are wrong, and the schema for editors."""

import json
import math
import pickle
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import revchain as rc
from revchain.scenes.scene import (
    Ask,
    AskResponse,
    AskShapes,
    AskSwing,
    Displaced,
    Flywheel,
    Held,
    Link,
    Scene,
    Support,
    TaperedChain,
    UniformChain,
    json_schema,
)

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
    chain = given.chain()
    assert chain.weight.tolist() == [20.0, 3.0, 3.0, 10.0, 0.0, 10.0]
    assert chain.length.tolist() == [0.5, 0.4, 0.4, 0.3, 1.0, 0.3]
    assert chain.centroid.tolist() == [0.5, 0.2, 0.2, -0.01, 1.0, 0.1]
    np.testing.assert_allclose(
        chain.radius_of_gyration, [0, 0.4 / 12**0.5, 0.4 / 12**0.5, 0.2, 0, 0.2], rtol=4 * 2.0**-52
    )


def test_uniform_chain_is_the_one_of_the_api():
    for kind, make in (("rods", rc.Chain.uniform_rods), ("plummets", rc.Chain.uniform_plummets)):
        given = Scene.from_dict({"uniform_chain": {"kind": kind, "count": 50, "length": 2.0, "weight": 3.0}})
        assert given.chain() == make(50, 2.0, 3.0)


def test_what_is_asked():
    many = dict(ONE, repeat=30)
    assert len(links(many).modes()) == 10
    assert len(links(dict(ONE, repeat=3)).modes()) == 3
    assert len(links(many, ask={"modes": 4}).modes()) == 4
    assert len(links(many, ask={"modes": "all"}).modes()) == 30
    assert links(many).modes().error_bound.max() < 1e-15 < links(many, ask={"rtol": 1e-3}).modes().error_bound.max()
    assert links(dict(ONE, repeat=4), ask={"method": "dense"}).modes().method == "dense"


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
    chain = links({**ONE, entry: text}, gravity=1.0).chain()
    found = chain.weight[0] if entry == "mass" else chain.length[0]
    assert found == pytest.approx(value, rel=4 * 2.0**-52)


def test_units_of_force_and_gravity():
    body = {"weight": "3 N", "length": 1, "centroid": "-1 mm", "radius_of_gyration": "5 cm"}
    chain = links({"weight": "20 N", "length": 1}, body).chain()
    assert chain.centroid[1] == -0.001 and chain.radius_of_gyration[1] == 0.05
    assert links({"weight": "2 kN", "length": 1}).chain().weight[0] == 2000.0
    assert scene(gravity="981 cm/s^2").gravity_value() == pytest.approx(9.81, rel=4 * 2.0**-52)
    assert scene(gravity="32.174 ft/s**2").gravity_value() == pytest.approx(9.80664, abs=1e-5)


BAD = {
    "nothing hangs": ({}, "give either [[links]] or [uniform_chain]"),
    "both": ({"links": [ONE], "uniform_chain": {"kind": "rods", "count": 2, **ONE}}, "give either [[links]]"),
    "no links": ({"links": []}, "links: "),
    "negative length": ({"links": [ONE, ONE, {**ONE, "length": -0.5}]}, "links[2].length: must be positive, got -0.5"),
    "zero length": ({"links": [{**ONE, "length": 0}]}, "links[0].length: must be positive, got 0"),
    "nan": ({"links": [{**ONE, "length": math.nan}]}, "links[0].length: must be"),
    "infinite": ({"links": [{**ONE, "mass": math.inf}]}, "links[0].mass: must be finite"),
    "negative mass": ({"links": [{**ONE, "mass": -1}]}, "links[0].mass: must not be negative, got -1"),
    "massless lowest": ({"links": [{**ONE, "mass": 0}, ONE]}, "links[0]: "),
    "massless uniform": ({"uniform_chain": {"kind": "rods", "count": 2, "length": 1, "mass": 0}}, "uniform_chain.mass: must be positive"),
    "weight and mass": ({"links": [{**ONE, "weight": 1}]}, "links[0]: give either weight or mass"),
    "no weight": ({"links": [{"length": 1}]}, "links[0]: give either weight or mass"),
    "no length": ({"links": [{"mass": 1}]}, "links[0].length: is missing"),
    "stands": ({"links": [{**ONE, "repeat": 3}, {"mass": 9, "length": 1, "centroid": -1, "radius_of_gyration": 1}]}, "links[1]: "),
    "imaginary": ({"links": [{**ONE, "centroid": 0.5, "pendulum_length": 0.4}]}, "links[0].pendulum_length: makes the radius"),
    "pendulum of a link at its pin": ({"links": [ONE, {**ONE, "centroid": 0, "pendulum_length": 0.4}]}, "links[1].pendulum_length: says nothing"),
    "centroid alone": ({"links": [{**ONE, "centroid": 0.5}]}, "links[0].centroid: needs either"),
    "centroid with both": ({"links": [{**ONE, "centroid": 0.5, "pendulum_length": 1, "radius_of_gyration": 1}]}, "links[0].centroid: needs either"),
    "radius alone": ({"links": [{**ONE, "radius_of_gyration": 0.5}]}, "links[0].radius_of_gyration: needs centroid"),
    "rod with centroid": ({"links": [{**ONE, "kind": "rod", "centroid": 0.5}]}, 'links[0].centroid: does not go with kind = "rod"'),
    "unknown key": ({"links": [{**ONE, "lenght": 1}]}, "links[0].lenght: unknown key; did you mean length?"),
    "unknown key, nothing near": ({"links": [{**ONE, "colour": 1}]}, "links[0].colour: unknown key; known keys: length, weight, mass"),
    "unknown key at the top": ({"links": [ONE], "gravitty": 1}, "gravitty: unknown key; did you mean gravity?"),
    "unknown key in ask": ({"links": [ONE], "ask": {"mode": 1}}, "ask.mode: unknown key; did you mean modes?"),
    "unknown kind": ({"links": [{**ONE, "kind": "rodd"}]}, "links[0].kind: must be one of plummet, rod, got 'rodd'; did you mean rod?"),
    "unknown method": ({"links": [ONE], "ask": {"method": "qr"}}, "ask.method: must be one of auto, bisection, condensed, aberth, interpolated, dense, recurrence"),
    "a list for a number": ({"links": [{**ONE, "length": [1]}]}, "links[0].length: must be a number, or a number and its unit"),
    "a boolean for a number": ({"links": [{**ONE, "length": True}]}, "links[0].length: must be a number"),
    "huge integer": ({"links": [{**ONE, "length": 10**400}]}, "links[0].length: must be a number"),
    "a table for a list": ({"links": ONE}, "links: must be a list of tables"),
    "a number for a table": ({"links": [3]}, "links[0]: must be a table, got 3"),
    "repeat 0": ({"links": [{**ONE, "repeat": 0}]}, "links[0].repeat: must be at least 1, got 0"),
    "repeat not whole": ({"links": [{**ONE, "repeat": 1.5}]}, "links[0].repeat: must be a whole number, got 1.5"),
    "too many": ({"links": [{**ONE, "repeat": 6_000_000}] * 2}, "links: must be at most 10,000,000"),
    "unit of another kind": ({"links": [{**ONE, "length": "2 kg"}]}, 'links[0].length: must be a length such as "39.1396 inch", got "2 kg"'),
    "mass for weight": ({"links": [{"length": 1, "weight": "2 kg"}]}, 'links[0].weight: must be a force such as "20 N", got "2 kg"; give it as mass'),
    "unknown unit": ({"links": [{**ONE, "length": "2 cubits and a half"}]}, "links[0].length: has a unit that is not known"),
    "no unit": ({"links": [{**ONE, "length": "2"}]}, "links[0].length: must be a number, or a number and its unit"),
    "no number": ({"links": [{**ONE, "length": "long"}]}, "links[0].length: must be a number, or a number and its unit"),
    "negative with unit": ({"links": [{**ONE, "length": "-2 m"}]}, 'links[0].length: must be positive, got "-2 m"'),
    "infinite with unit": ({"links": [{**ONE, "length": "1e999 m"}]}, "links[0].length: must be finite"),
    "gravity 0": ({"links": [ONE], "gravity": 0}, "gravity: must be positive, got 0"),
    "gravity of another kind": ({"links": [ONE], "gravity": "9.81 m"}, "gravity: must be an acceleration"),
    "modes 0": ({"links": [ONE], "ask": {"modes": 0}}, "ask.modes: must be at least 1, got 0"),
    "more modes than there are": ({"links": [ONE], "ask": {"modes": 2}}, "ask.modes: must be at most 1, got 2"),
    "modes not whole": ({"links": [ONE], "ask": {"modes": 1.5}}, "ask.modes: must be a whole number or all, got 1.5"),
    "rtol negative": ({"links": [ONE], "ask": {"rtol": -1}}, "ask.rtol: must not be negative, got -1"),
    "rtol nan": ({"links": [ONE], "ask": {"rtol": math.nan}}, "ask.rtol: must"),
    "rtol infinite": ({"links": [ONE], "ask": {"rtol": math.inf}}, "ask.rtol: must be finite"),
    "another version": ({"links": [ONE], "schema_version": 2}, "schema_version: must be 1, got 2"),
    "no table at all": ([], "must be a table"),
    "keys that are no text": ({1: 2}, "every key must be text"),
}  # fmt: skip


@pytest.mark.parametrize(("data", "message"), BAD.values(), ids=BAD.keys())
def test_errors_name_the_key(data, message):
    with pytest.raises(rc.SceneError) as caught:
        Scene.from_dict(data, source="my.toml")
    assert str(caught.value).startswith(f"my.toml: {message}")
    assert isinstance(caught.value, ValueError)
    assert "\n" not in str(caught.value)
    again = pickle.loads(pickle.dumps(caught.value))
    assert (str(again), again.key) == (str(caught.value), caught.value.key)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.toml", "title = 'x'\nlength 3\n", "a.toml: line 2, column 8: "),
        ("a.toml", "title = 'x", "a.toml: line 1, column 11: "),
        ("a.toml", "[[links]]\nmass = 1\nmass = 2\n", "a.toml: line 3, column 9: "),
        ("a.toml", "mass = [1,", "a.toml: line 1, column 11: "),
        ("a.json", '{"title": "x",\n "links": [}', "a.json: line 2, column 12: "),
        ("a.json", "", "a.json: line 1, column 1: "),
        ("a.json", "[" * 100_000, "a.json: "),
        ("a.toml", "x = " + "[" * 100_000, "a.toml: "),
        ("a.json", '{"gravity": ' + "9" * 5000 + "}", "a.json: "),
    ],
)
def test_errors_of_syntax_name_line_and_column(tmp_path, monkeypatch, name, text, message):
    monkeypatch.chdir(tmp_path)
    Path(name).write_text(text)
    with pytest.raises(rc.SceneError) as caught:
        rc.load_scene(name)
    assert str(caught.value).startswith(message)


def test_files_that_cannot_be_read(tmp_path):
    for path, message in ((tmp_path / "missing.toml", "No such file"), (tmp_path, "directory")):
        with pytest.raises(rc.SceneError, match=f"cannot be read: .*{message}"):
            rc.load_scene(path)
    (tmp_path / "latin.toml").write_bytes("title = 'Glöckner'".encode("latin-1"))
    with pytest.raises(rc.SceneError, match="is not UTF-8 text .byte 12."):
        rc.load_scene(tmp_path / "latin.toml")


def test_json_and_toml_say_the_same(tmp_path):
    (tmp_path / "a.toml").write_text('\ufefftitle = "x"\n[[links]]\nmass = 1\nlength = "2 m"\n', encoding="utf-8")
    (tmp_path / "a.json").write_text('{"title": "x", "links": [{"mass": 1, "length": "2 m"}]}')
    assert rc.load_scene(tmp_path / "a.toml") == rc.load_scene(str(tmp_path / "a.json"))


def test_structs_can_be_written_in_python():
    by_hand = Scene(links=[Link(mass=1.0, length=1.0, repeat=2)], ask=Ask(modes=1))
    assert by_hand == links({**ONE, "repeat": 2}, ask={"modes": 1})
    assert Scene(uniform_chain=UniformChain(kind="rods", count=3, length=1.0, mass=1.0)).chain().size == 3
    with pytest.raises(rc.SceneError, match="scene: links.0..length: must be positive"):
        Scene(links=[Link(mass=1.0, length=-1.0)]).chain()
    with pytest.raises(AttributeError):
        by_hand.title = "other"


def test_errors_without_pint_say_how_to_get_it(python, without):
    program = without("pint") + (
        "import revchain as rc\n"
        "assert rc.Scene.from_dict({'links': [{'mass': 1, 'length': 2}]}).chain().size == 1\n"
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
    | st.dictionaries(st.sampled_from(["modes", "rtol", "method"]), numbers | st.just("all")),
)


@settings(max_examples=500)
@given(scenes)
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
    data = {"title": "t", "gravity": gravity, "links": tables, "ask": {"modes": min(modes, count)}}
    made = Scene.from_dict(data)
    assert Scene.from_dict(made.to_dict()) == made
    (tmp_path / "a.json").write_text(json.dumps(made.to_dict()))
    again = rc.load_scene(tmp_path / "a.json")
    assert again == made and again.chain() == made.chain()


def test_defaults_are_left_out_of_the_dict():
    data = {"links": [{"mass": 0.1, "length": "20 inch"}]}
    assert Scene.from_dict(data).to_dict() == data
    assert repr(scene()) == "Scene(links=[Link(length=1.0, mass=1.0)])"


def test_the_schema_shipped_is_the_one_of_the_program(repository):
    text = json.dumps(json_schema(), indent=2) + "\n"
    shipped = Path(rc.__file__).with_name("scenes").joinpath("scene.schema.json").read_text(encoding="utf-8")
    assert shipped == text, "revchain schema > src/revchain/scenes/scene.schema.json"
    assert (repository / "src/revchain/scenes/scene.schema.json").read_text(encoding="utf-8") == text


def test_the_schema_knows_every_key():
    tables = json_schema()["$defs"]
    structs = (Scene, Link, UniformChain, TaperedChain, Support, Flywheel, Displaced, Held, Ask, AskShapes, AskResponse, AskSwing)
    assert set(tables) == {struct.__name__ for struct in structs}
    for struct in structs:
        name = struct.__name__
        assert list(tables[name]["properties"]) == list(struct.__struct_fields__)
        assert tables[name]["additionalProperties"] is False
        assert all("description" in entry for entry in tables[name]["properties"].values())


@pytest.mark.parametrize("text", ["1 m**9**9**9", "1 m^9^9^9", "1 m*9**9**9**9/m", "1 m**99", "1 " + "m*" * 200 + "m"])
def test_units_are_not_a_calculator(text):
    with pytest.raises(ValueError, match=r"links\[0\].length"):
        links({"mass": 1.0, "length": text}).chain()


RODS = {"uniform_chain": {"kind": "rods", "count": 30, "length": 1, "mass": 1}}


@pytest.mark.parametrize(
    ("ask", "numbers"),
    [
        ({}, range(1, 11)),
        ({"modes": 3}, range(1, 4)),
        ({"modes": "all"}, range(1, 31)),
        ({"first": 5}, range(5, 15)),
        ({"first": 25}, range(25, 31)),
        ({"first": 25, "modes": 2}, range(25, 27)),
        ({"first": 12, "modes": "all"}, range(12, 31)),
    ],
)
def test_which_modes_are_asked_for(ask, numbers):
    scene = rc.Scene.from_dict({**RODS, "ask": ask})
    assert scene.modes().number.tolist() == list(numbers)


@pytest.mark.parametrize(
    ("ask", "low", "high"),
    [
        ({"conical_height": [0, 0.01]}, 0, 0.01),
        ({"conical_height": ["1 mm", "40 cm"]}, 0.001, 0.4),
        ({"conical_height": [0.01, math.inf]}, 0.01, math.inf),
        ({"conical_height": [0.8, "1 mile"]}, 0.8, 1609.344),
        ({"angular_speed": [10, 40], "certify": True}, 9.80665 / 1600, 9.80665 / 100),
        ({"angular_speed": [0, math.inf]}, 0, math.inf),
    ],
)
def test_which_window_is_asked_for(ask, low, high):
    scene = rc.Scene.from_dict({**RODS, "ask": ask})
    every = rc.modes(scene.chain(), "all")
    inside = (low < every.conical_height) & (every.conical_height <= high)
    assert scene.modes().number.tolist() == every.number[inside].tolist()
    assert rc.modes(scene.chain(), **scene.asked(scene.chain())) == scene.modes()


@pytest.mark.parametrize(
    ("ask", "key", "reason"),
    [
        ({"first": 31}, "ask.first", "at most 30, got 31"),
        ({"first": 0}, "ask.first", "at least 1, got 0"),
        ({"first": 30, "modes": 2}, "ask.modes", "at most 1 from number 30 on, got 2"),
        ({"modes": 2, "conical_height": [1, 2]}, "ask.conical_height", "does not go with modes"),
        ({"first": 2, "angular_speed": [1, 2]}, "ask.angular_speed", "does not go with first"),
        ({"conical_height": [1, 2], "angular_speed": [1, 2]}, "ask.conical_height", "does not go with angular_speed"),
        ({"conical_height": [2, 1]}, "ask.conical_height", "low end"),
        ({"conical_height": ["2 cm", "2 mm"]}, "ask.conical_height", "low end"),
        ({"conical_height": ["2 kg", "2 mm"]}, "ask.conical_height", "must be a length"),
        ({"conical_height": [math.nan, 1]}, "ask.conical_height", "got nan"),
        ({"angular_speed": [1, math.nan]}, "ask.angular_speed", "got nan"),
        ({"precision": "half"}, "ask.precision", "single, double"),
        ({"precision": "single", "method": "dense"}, "ask.precision", "dense"),
        ({"certify": "yes"}, "ask.certify", "yes"),
    ],
)
def test_asked_for_what_is_not_there(ask, key, reason):
    with pytest.raises(rc.SceneError) as caught:
        rc.Scene.from_dict({**RODS, "ask": ask})
    assert key in str(caught.value) and reason in str(caught.value), str(caught.value)


def test_certify_and_precision_of_a_scene():
    result = rc.Scene.from_dict({**RODS, "ask": {"modes": 2, "certify": True, "precision": "extended"}}).modes()
    assert result.precision == "extended" and result.certificate.above_lower.tolist() == [1, 2]
