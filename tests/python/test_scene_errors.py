# SPDX-License-Identifier: GPL-3.0-or-later
"""What is said of scene files that are wrong: the mistakes people make, each with its message, and every one at once."""

import json
import math
import pickle
import random
import re
from pathlib import Path

import numpy as np
import pytest

import revchain as rc
from revchain.cli import app as _cli
from revchain.scenes import parse
from revchain.scenes.error import Problem
from revchain.scenes.tables import QUESTIONS, fields_of
from revchain.scenes.scene import Scene

LINK = "[[links]]\nmass = 1\nlength = 1\n"
ARM = "[support]\nradius = 2\n"
AIR = LINK + "air_drag = {coefficient = 1, area = 1}\n"
CORD = "[cord]\nlength = 1\nmass = 1\n"
GOVERNOR = "[governor]\nball_mass = 2\narm = 0.3\n"

# A file, and what is said of it: line and column, key, sentence. The first two dozen are those of engineers.
FILES = {
    "decimal comma": ("[[links]]\nmass = 1\nlength = 2,5  # m\n", "3:1 the decimal mark is a point: write length = 2.5, not 2,5"),
    "decimal comma in text": ('[[links]]\nmass = 1\nlength = "2,5 m"\n', '3:1 links[0].length: must be a number, or a number and its unit such as "39.1396 inch", got "2,5 m"; the decimal mark is a point: write "2.5 m"'),
    "unit without quotes": ("[[links]]\nmass = 5000 kg\nlength = 1\n", '2:1 a number with a unit is text, in quotes: write mass = "5000 kg", not 5000 kg'),
    "unit inside a line": ("[[links]]\nmass = 1\nlength = 1\nflywheel = {spin = 30 rpm, mass = 1, radius_of_gyration = 1}\n", '4:13 a number with a unit is text, in quotes: write spin = "30 rpm", not 30 rpm'),
    "text without quotes": ("[[links]]\nmass = 1\nlength = 1\nkind = rod\n", '4:1 text is in quotes: write kind = "rod", not rod'),
    "True": (LINK + "standing = True\n", "4:1 true is written small: write standing = true, not True"),
    "no digit before the point": ("[[links]]\nmass = .5\nlength = 1\n", "2:1 a number has a digit before its point: write mass = 0.5, not .5"),
    "no digit behind the point": ("[[links]]\nmass = 5.\nlength = 1\n", "2:1 a number has a digit after its point: write mass = 5.0, not 5."),
    "colon": ("[[links]]\nmass = 1\nlength: 2\n", "3:1 an equals sign is missing: write length = 2"),
    "[links]": ("[links]\nmass = 1\nlength = 1\n", "1:1 links: is a list of tables: write [[links]], with two brackets, above each of them"),
    "decimal comma and unit": ("[[links]]\nmass = 1\nlength = 2,5 m\nname = 3\n", '3:1 the decimal mark is a point: write length = "2.5 m", not 2,5 m\n4:1 links[0].name: must be text, got 3'),
    "decimal comma inside a line": (LINK + "flywheel = {spin = 2,5, mass = 1, radius_of_gyration = -1}\n", "4:13 the decimal mark is a point: write spin = 2.5, not 2,5\n4:35 links[0].flywheel.radius_of_gyration: must not be negative, got -1"),
    "list without brackets": ("[[links]]\nmass = 1\nlength = 1, 2, 3 # m\nname = 3\n", "3:1 a list is in brackets: write length = [1, 2, 3], not 1, 2, 3\n4:1 links[0].name: must be text, got 3"),
    "unit in a list": (LINK + "[ask.swing]\noffset = [\n  2 cm]\ncount = 0", '6:3 a number with a unit is text, in quotes: write "2 cm", not 2 cm\n7:1 ask.swing.count: must be at least 1, got 0'),
    "unclosed quote": ('[[links]]\nmass = -1\nlength = "2 m  # long\nname = 3\n', '2:1 links[0].mass: must not be negative, got -1\n3:1 a quote is missing: write length = "2 m", not "2 m\n4:1 links[0].name: must be text, got 3'),
    "unclosed quote inside a line": (LINK + 'flywheel = {spin = "30 rpm, mass = -1, radius_of_gyration = 1}\n', '4:13 a quote is missing: write spin = "30 rpm", not "30 rpm\n4:29 links[0].flywheel.mass: must not be negative, got -1'),
    "unopened quote": ('[[links]]\nmass = -1\nlength = 2 m"\n', '2:1 links[0].mass: must not be negative, got -1\n3:1 a quote is missing: write length = "2 m", not 2 m"'),
    "two kinds of quotes": (LINK + "name = \"bell'\n", "4:1 a quote is missing: write name = \"bell\", not \"bell'"),
    "curly quotes": (LINK + "name = “bell”\n", '4:1 quotes are straight: write name = "bell", not “bell”'),
    "text with a comma": ("title = Two, nuts\n" + LINK, '1:1 text is in quotes: write title = "Two, nuts", not Two, nuts'),
    "comma at the end": ("[[links]]\nmass = 1,\nlength = 1;\n", "2:1 a line ends without comma and semicolon: write mass = 1, not 1,\n3:1 a line ends without comma and semicolon: write length = 1, not 1;"),
    "no equals sign": ('[[links]]\nmass 1\nlength == "2 m"\n', '2:1 an equals sign is missing: write mass = 1\n3:1 an equals sign is missing: write length = "2 m"'),
    "grouped digits": ("[[links]]\nmass = 5 000\nlength = 1\n", "2:1 digits are not grouped: write mass = 5000, not 5 000"),
    "comments of C": ("// nuts\n[[links]]\nmass = 1 // kg\nlength = 1\n", "1:1 a comment begins with #: write # nuts, not // nuts\n3:1 a comment begins with #: write mass = 1 # kg, not 1 // kg"),
    "brackets": ("[[links]\nmass = -1\nlength = 1\n", "1:8 brackets go in pairs: write [[links]], not [[links]\n2:1 links[0].mass: must not be negative, got -1"),
    "[links] twice": ("[links]\nmass = 1\nlength = 1\n[links]\nmass = -2\nlength = 1\n", "4:7 [links] is there twice: write [[links]], with two brackets, above each link\n5:1 links[1].mass: must not be negative, got -2"),
    "links = 5": ("links = 5\n", "1:1 links: must be tables, got 5: write [[links]] above each of them, and below it mass = 1.0 and length = 0.5"),
    "a number among links": ("links = [ {mass = 1, length = 1}, 5, {mass = -1, length = 1} ]\n", "1:35 links[1]: must be a table, got 5\n1:39 links[2].mass: must not be negative, got -1"),
    "quoted number with a comma": ('[[links]]\nmass = "2,5"\nlength = 1\n', '2:1 links[0].mass: must be a number, or a number and its unit such as "2 kg", got "2,5"; the decimal mark is a point: write 2.5'),
    "two keys in a line": ("[[links]]\nmass = 1, length = 1\n", "2:9 the line should end here: each key has a line of its own"),
    "no comma in a list": ("links = [{mass = 1, length = 1}\n{mass = 1, length = 1}]\n", "2:1 a comma or the closing bracket ] is missing"),
    "JSON in a TOML file": ('{"links": []} # toml', "1:1 is JSON: give the file a name that ends in .json"),
    "XML in a TOML file": ("<mujoco>\n  <worldbody/>\n</mujoco> # toml", "1:1 is XML, not a scene: revchain import FILE.xml writes a model of a multibody engine (MJCF, URDF) as a scene"),
    "[modes]": (LINK + "[modes]\ncount = 1\n", "4:1 modes: unknown key; write [ask.modes]"),
    "[[ask.modes]]": (LINK + "[[ask.modes]]\ncount = 1\n", "4:1 ask.modes: is one table: write [ask.modes], with one pair of brackets"),
    "top keys below the links": (LINK + 'order = "support first"\n', "4:1 links[0].order: unknown key; belongs at the top of the file, above the first table"),
    "links without a table": ("mass = 1\nlength = 1\n", "1:1 mass: unknown key; belongs in [[links]], to one of the links\n2:1 length: unknown key; belongs in [[links]], to one of the links"),
    "rpm of a wheel": (LINK + "flywheel = {mass = 1, radius_of_gyration = 1, rpm = 60}\n", '4:1 links[0].flywheel.spin: is missing\n4:47 links[0].flywheel.rpm: unknown key; write spin = "60 rpm"'),
    "a range in words": (LINK + '[ask.response]\nangular_speed = "1 to 60 rpm"\n', '5:1 ask.response.angular_speed: a range is written {from = "1 rpm", to = "60 rpm"}, got "1 to 60 rpm"'),
    "tension in kilograms": (LINK + '[held]\ntension = "2 kg"\n', '5:1 held.tension: must be a force such as "20 N", got "2 kg"'),
    "a key in quotes": ('"links[0].mass" = 3\n' + LINK, '1:1 "links[0].mass": unknown key; known keys: schema_version, title, description, gravity, order, links, uniform_chain, tapered_chain, cord, governor, support, speed, fluid, held, ask'),
    "[[link]]": ("[[link]]\nmass = 1\nlength = 1\n", "1:1 link: unknown key; did you mean [[links]]?"),
    "[[support]]": (LINK + "[[support]]\nradius = 1\n", "4:1 support: is one table: write [support], with one pair of brackets"),
    "lenght": ("[[links]]\nmass = 1\nlenght = 1\n", "1:1 links[0].length: is missing\n3:1 links[0].lenght: unknown key; did you mean length?"),
    "inertia": (LINK + "inertia = 3\n", "4:1 links[0].inertia: unknown key; give radius_of_gyration, the square root of inertia / mass, about the centre of gravity"),
    "rpm": (LINK + "[ask.shapes]\nrpm = 3\n", '5:1 ask.shapes.rpm: unknown key; write angular_speed = "60 rpm"'),
    "one number for two": (LINK + "[ask.modes]\nangular_speed = 30\n", "5:1 ask.modes.angular_speed: must be a pair [low, high], got 30; either end may be 0 or inf"),
    "two numbers for one": (LINK + "[ask.shapes]\nangular_speed = [1, 2]\n", '5:1 ask.shapes.angular_speed: must be a number, or a number and its unit such as "30 rpm", got [1, 2]; for several speeds write a study with [vary."ask.shapes.angular_speed"] and values = [1, 2]: revchain sweep STUDY'),
    "one number for a list": (LINK + "[ask.swing]\noffset = 1\n", "5:1 ask.swing.offset: must be a list of numbers, got 1: write [1]"),
    "negative mass": ("[[links]]\nmass = -2\nlength = 1\n", "2:1 links[0].mass: must not be negative, got -2"),
    "both mass and weight": (LINK + "weight = 3\n", "4:1 links[0].weight: is given beside mass: give one of them, not both"),
    "neither mass nor weight": ("[[links]]\nlength = 1\n", "1:1 links[0]: mass (kg) or weight (N) is missing"),
    "order misspelt": ('order = "support frist"\n' + LINK, '1:1 order: must be one of free end first, support first, got "support frist"; did you mean support first?'),
    "kind of another table": (LINK + 'kind = "rods"\n', '4:1 links[0].kind: must be one of plummet, rod, got "rods"; did you mean rod?'),
    "wrong dimension": ('[[links]]\nmass = 1\nlength = "2 kg"\n', '3:1 links[0].length: must be a length such as "39.1396 inch", got "2 kg"'),
    "kilograms as weight": ('[[links]]\nweight = "2 kg"\nlength = 1\n', '2:1 links[0].weight: must be a force such as "20 N", got "2 kg"; give it as mass'),
    "unknown unit": ('[[links]]\nmass = "2 parsnip"\nlength = 1\n', '2:1 links[0].mass: has a unit that is not known: "2 parsnip"'),
    "quotes without a unit": ('[[links]]\nmass = "2"\nlength = 1\n', '2:1 links[0].mass: must be a number, or a number and its unit such as "2 kg", got "2"; write 2 without quotes'),
    "missing length": (LINK + "[[links]]\nmass = 1\n", "4:1 links[1].length: is missing"),
    "empty links": ("links = []\n", "1:1 links: is an empty list: give at least one link"),
    "nothing hangs": ('title = "x"\n', "1:1 give one of [[links]], [uniform_chain], [tapered_chain], [cord] or [governor], got none of them"),
    "two systems": (LINK + '[uniform_chain]\nkind = "rods"\ncount = 2\nlength = 1\nmass = 1\n', "1:1 give one of [[links]], [uniform_chain], [tapered_chain], [cord] or [governor], got links and uniform_chain"),
    "no speed": (LINK + "[ask.branches]\n", "4:1 ask.branches: give max_angular_speed or min_conical_height: at which speed"),
    "a range without its end": (LINK + "[ask.response]\nangular_speed = {from = 1}\n", "5:1 ask.response.angular_speed.to: is missing"),
    "a study": ('scene = "a.toml"\n[vary."links[0].mass"]\nvalues = [1]\n', "2:1 vary: is of a study, not of a scene: revchain sweep a.toml"),
    "a number for a table": (LINK + "[ask]\nmodes = 3\n", "5:1 ask.modes: must be a table, got 3"),
    "the name of the link": ('[[links]]\nmass = 1\nlength = 0\nname = "bell"\n', '3:1 links[0].length ("bell"): must be positive, got 0'),
    "key twice": ("[[links]]\nmass = 1\nmass = 2\n", "3:9 is there twice"),
    "no value": ("[[links]]\nmass =\nlength = 1\n", "2:7 a value is missing here, or is none: write a number, or text in quotes"),
    "the end": ("mass = [1,", "1:11 a value is missing here, or is none: write a number, or text in quotes (the file ends)"),
    "a governor on a support": (GOVERNOR + "[support]\nradius = 1\n", "4:1 support: does not go with [governor]: remove it"),
    "modes of a governor": (GOVERNOR + "[ask.modes]\n", "4:1 ask.modes: does not go with [governor]: write [ask.equilibria]"),
    "equilibria of a chain": (LINK + "[ask.equilibria]\n", "4:1 ask.equilibria: does not go with a chain or cord: write [ask.modes] or [ask.shapes]"),
    "a governor without arms": ("[governor]\nball_mass = 2\n", "1:1 governor.arm: is missing"),
    "balls by weight": ('[governor]\nball_mass = "2 N"\narm = 0.3\n', '2:1 governor.ball_mass: must be a mass such as "2 kg", got "2 N"'),
    "a mass of a governor": (GOVERNOR + "mass = 3\n", "4:1 governor.mass: unknown key; did you mean ball_mass?"),
    "half a ball": (GOVERNOR + "balls = 2.5\n", "4:1 governor.balls: must be a whole number, got 2.5"),
    "one stop": (GOVERNOR + "lowest_inclination = 0.1\n", "1:1 governor: give both lowest_inclination and highest_inclination, or neither"),
    "stops the wrong way round": (GOVERNOR + "lowest_inclination = 0.3\nhighest_inclination = 0.1\n", "4:1 governor.lowest_inclination: must be below highest_inclination, got 0.3 and 0.1"),
    "a sleeve on nothing": (GOVERNOR + "sleeve_mass = 1\n", "4:1 governor.sleeve_mass: needs a sleeve: give lower_arm or sleeve_arm, got 1"),
    "lower arms too short": (GOVERNOR + "lower_arm = 0.1\npivot_offset = 0.3\n", "4:1 governor.lower_arm: must be long enough to reach the sleeve at inclination 0, got 0.1"),
    "a governor that turns backwards": (GOVERNOR + "[ask.equilibria]\nangular_speed = -3\n", "5:1 ask.equilibria.angular_speed: must not be negative, got -3"),
    "a governor and links": (GOVERNOR + LINK, "1:1 give one of [[links]], [uniform_chain], [tapered_chain], [cord] or [governor], got links and governor"),
    "drag without a speed": (ARM + AIR + "[ask.drag]\n", '7:1 ask.drag.angular_speed: is missing: write angular_speed = "12 rpm"'),
    "drag on the axis": (LINK + 'air_drag = {coefficient = 1, area = 1}\n[ask.drag]\nangular_speed = 3\n', '5:1 ask.drag: needs a support off the axis, which carries the chain round: write [support] and radius = "2 m"'),
    "no link has drag": (ARM + LINK + "[ask.drag]\nangular_speed = 3\n", '6:1 ask.drag: no link has drag: write air_drag = {coefficient = 1.1, diameter = "5 mm"} in a link'),
    "drag of nothing": (ARM + LINK + "air_drag = {coefficient = 1}\n[ask.drag]\nangular_speed = 3\n", "6:1 links[0].air_drag: give a diameter of the link, an area of a body at it, or both"),
    "no coefficient": (ARM + LINK + "air_drag = {area = 1}\n[ask.drag]\nangular_speed = 3\n", "6:1 links[0].air_drag.coefficient: is missing"),
    "negative coefficient": (ARM + LINK + "air_drag = {coefficient = -1, area = 1}\n[ask.drag]\nangular_speed = 3\n", "6:13 links[0].air_drag.coefficient: must not be negative, got -1"),
    "negative area": (ARM + LINK + "air_drag = {coefficient = 1, area = -2}\n[ask.drag]\nangular_speed = 3\n", "6:30 links[0].air_drag.area: must not be negative, got -2"),
    "area in metres": (ARM + LINK + 'air_drag = {coefficient = 1, area = "2 m"}\n[ask.drag]\nangular_speed = 3\n', '6:30 links[0].air_drag.area: must be an area such as "40 cm^2", got "2 m"'),
    "a mass at the support": (CORD + "[[cord.masses]]\narc_length = 1\nmass = 1\n", "5:1 cord.masses[0].arc_length: must be below the length of the cord, 1, got 1.0"),
    "a mass without a place": (CORD + "[[cord.masses]]\nmass = 1\n", "4:1 cord.masses[0].arc_length: is missing"),
    "a mass without a mass": (CORD + "[[cord.masses]]\narc_length = 0.5\n", "4:1 cord.masses[0]: mass (kg) or weight (N) is missing"),
    "a bob without weight": (CORD + "tip_centroid = 0.1\n", "4:1 cord.tip_centroid: needs a tip_mass above 0 beside it"),
    "campbell without speeds": (LINK + "[ask.campbell]\n", '4:1 ask.campbell.angular_speed: is missing: write angular_speed = {from = "1 rpm", to = "20 rpm", steps = 39}'),
    "campbell from rest": (LINK + '[ask.campbell]\nangular_speed = {to = "9 rpm"}\n', "5:1 ask.campbell.angular_speed.from: must be positive, got 0.0"),
    "campbell at one speed": (LINK + "[ask.campbell]\nangular_speed = 3\n", "5:1 ask.campbell.angular_speed: must be two or more ascending speeds, got 3.0"),
    "campbell downwards": (LINK + "[ask.campbell]\nangular_speed = {from = 2, to = 1}\n", "5:1 ask.campbell.angular_speed: must be two or more ascending speeds, got 2 to 1"),
    "order 0": (LINK + "[ask.campbell]\nangular_speed = [2, 3]\norders = [0]\n", "6:11 ask.campbell.orders[0]: must be at least 1, got 0"),
    "no orders": (LINK + "[ask.campbell]\nangular_speed = [2, 3]\norders = []\n", "6:1 ask.campbell.orders: is an empty list: write [1, 2], or leave it out"),
    "true for speeds": (LINK + "[ask.campbell]\nangular_speed = true\n", "5:1 ask.campbell.angular_speed: must be a number or a list of numbers, got true"),
    "one order": (LINK + "[ask.campbell]\nangular_speed = [2, 3]\norders = 2\n", "6:1 ask.campbell.orders: must be a list of numbers, got 2: write [2]"),
    "a wrong speed of several": (LINK + '[ask.response]\nangular_speed = [1, "3 kg"]\n', '5:21 ask.response.angular_speed[1]: must be an angular speed such as "30 rpm", got "3 kg"'),
    "a direction in quotes": (LINK + '[ask.shapes]\nangular_speed = 1\ndirection = "1"\n', '6:1 ask.shapes.direction: must be a number, got "1"; write 1 without quotes'),
    "drag at rest": (ARM + AIR + "[ask.drag]\nangular_speed = 0\n", "8:1 ask.drag.angular_speed: must not be 0: at rest air has no effect; positive and negative speeds turn either way"),
    "a motion without times": (LINK + "[ask.swing]\nsupport_velocity = [1, 0]\n", "5:1 ask.swing.support_velocity: needs support_time beside it, the time of each of its values"),
    "times without a motion": (LINK + "[ask.swing]\nsupport_time = [1, 0]\n", "5:1 ask.swing.support_time: needs one of support_velocity, support_acceleration, support_offset and support_force beside it"),
    "times of another unit": (LINK + '[ask.swing]\nsupport_time = [0, "1 m"]\nsupport_velocity = [1, 0]\n', '5:20 ask.swing.support_time[1]: must be a time such as "2 min", got "1 m"'),
    "two motions": (LINK + "[ask.swing]\nsupport_time = [0, 1]\nsupport_velocity = [1, 0]\nsupport_offset = [1, 0]\n", "7:1 ask.swing.support_offset: does not go with support_velocity"),
    "a force on a firm support": (LINK + "[ask.response]\nangular_speed = 1\nforce = 2\n", "6:1 ask.response.force: needs a support that yields; a firm one does not move: write [support] with mass or stiffness"),
    "modes of one link held": (LINK + '[held]\ntension = 90\n[ask.modes]\n', "6:1 ask.modes: has no answer: one link held at both ends has no pin that could move; give it two links or more"),
    "another frame": (LINK + '[ask.campbell]\nangular_speed = [2, 3]\nframe = "fixed"\n', '6:1 ask.campbell.frame: must be one of free, driven, got "fixed"'),
    "inside a JSON file": ('{"links": [{"mass": 1,\n  "length": -1, "flywheel": {"mas": 2}}],\n "ask": {"modes": {"angular_speed": ["1 rpm", "3 kg"]}}}', '2:3 links[0].length: must be positive, got -1\n2:17 links[0].flywheel.radius_of_gyration: is missing\n2:17 links[0].flywheel.spin: is missing\n2:30 links[0].flywheel.mas: unknown key; did you mean mass?\n3:47 ask.modes.angular_speed[1]: must be an angular speed such as "30 rpm", got "3 kg"'),
    "JSON": ('{"title": "x",\n "links": [}', "2:12 Expecting value"),
    "no JSON": ("{", "1:2 Expecting property name enclosed in double quotes"),
}  # fmt: skip
PYTHON = re.compile(r"\bdict\b|\bNone\b|\bfloat\b|\bint\b|\bstr\b|Traceback|array|object|shape \(|\btuple\b|struct")


@pytest.mark.parametrize(("text", "said"), FILES.values(), ids=FILES.keys())
def test_mistakes(tmp_path, monkeypatch, capsys, text, said):
    monkeypatch.chdir(tmp_path)
    name = "a.json" if text.startswith("{") and "toml" not in text else "a.toml"
    Path(name).write_text(text)
    lines = [re.sub(r"^(\d+):(\d+) ", rf"{name}: line \1, column \2: ", line) for line in said.split("\n")]
    with pytest.raises(rc.SceneError) as caught:
        rc.load_scene(name)
    assert str(caught.value).split("\n") == lines
    assert [f"{line}:{column}" for line, column, _, _ in caught.value.problems] == re.findall(r"(?m)^\d+:\d+", said)
    assert _cli.run(["run", name]) == 3
    printed = capsys.readouterr()
    assert printed.err.splitlines() == [f"revchain: {line}" for line in lines] and printed.out == ""
    assert PYTHON.search(printed.err) is None


def test_all_at_once(tmp_path):
    text = "\n".join(
        ("gravity = -1", "[[links]]", 'name = "a"', "mass = 5000 kg", "length = 2,5 # m", "[[links]]", "lenght = 1", "mass = -1")
        + ('kind = "rood"', "[[support]]", "[ask.modes]", "count = 0", "[ask.shapes]", "angular_speed = '3 m'", "[ask.swing]", "")
    )
    (tmp_path / "a.toml").write_text(text)
    with pytest.raises(rc.SceneError) as caught:
        rc.load_scene(tmp_path / "a.toml")
    assert [problem.line for problem in caught.value.problems] == [1, 4, 5, 6, 7, 8, 9, 10, 12, 14, 15]
    again = pickle.loads(pickle.dumps(caught.value))
    assert again.problems == caught.value.problems and str(again) == str(caught.value)
    assert (again.source, again.key) == (str(tmp_path / "a.toml"), "gravity")


def test_what_follows_from_another_error_is_not_said(tmp_path):
    """But what does not follow is."""
    for link, keys in (
        ("length = -1", ["links[0]", "links[0].length"]),
        ("length = 1\nmas = 1", ["links[0].mas"]),
        ("length = 1\nmass = '1 m'", ["links[0].mass"]),
    ):
        (tmp_path / "a.toml").write_text(f"[[links]]\n{link}\n")
        with pytest.raises(rc.SceneError) as caught:
            rc.load_scene(tmp_path / "a.toml")
        assert [problem.key for problem in caught.value.problems] == keys


TURNED = """order = "support first"
[[links]]
mass = 1
length = 1
repeat = 2
[[links]]
name = "wheel"
mass = 1
length = 1
kind = "rod"
flywheel = {mass = 1, radius_of_gyration = 1, spin = -9.80665}
"""


def test_links_are_those_of_the_file(tmp_path, monkeypatch, capsys):
    """The solver counts links from the free end with their repeats; messages and notes have the index of the file."""
    monkeypatch.chdir(tmp_path)
    Path("a.toml").write_text(TURNED)
    vanishes = 'links[1] ("wheel"): the effective tension (tension and n times momentum over length) must not vanish'
    assert _cli.run(["shapes", "a.toml", "--angular-speed", "0.5"]) == 2
    assert capsys.readouterr().err.startswith(f"revchain: a.toml: line 6, column 1: {vanishes}")
    with pytest.raises(rc.SceneError, match=re.escape(vanishes)):
        rc.load_scene("a.toml").steady_shapes(angular_speed=0.5)
    assert _cli.run(["modes", "a.toml"]) == 0 and 'links[1] ("wheel") goes slack at 0.5' in capsys.readouterr().out
    Path("a.toml").write_text(TURNED.replace("mass = 1\n", "mass = 0\n").replace("flywheel", "# "))
    with pytest.raises(rc.SceneError, match=r'a.toml: line 6, column 1: links\[1\] \("wheel"\): the lowest link must have'):
        rc.load_scene("a.toml")


STUDY = TURNED.replace("[[links]]", "[[scene.links]]").replace("order", "scene.order") + '[vary."links[0].mass"]\nvalues = [1, "2 kg"]\n'


@pytest.mark.parametrize(("text", "load"), [(TURNED, rc.load_scene), (STUDY, rc.load_study)], ids=["scene", "study"])
def test_every_error_has_its_place_whatever_is_typed(tmp_path, text, load):
    chance, path, wrong = random.Random(1), tmp_path / "a.toml", 0
    path.write_text(text)
    load(path)
    for _ in range(300):
        at = chance.randrange(len(text))
        typed = chance.choice([*"[]{}=,.;:'\"#\n /", "", "links", "vary", "2,5", "1 kg", "true", "-", '"""', "“", "["])
        path.write_text(text[:at] + typed + text[at + chance.choice([0, 1, 2, 8]) :])
        try:
            load(path)
        except rc.SceneError as error:
            wrong += 1
            assert all(1 <= each.line <= text.count("\n") + 2 and each.column >= 1 for each in error.problems), typed
            assert "Expected" not in str(error)
    assert wrong > 150


ROD_AND_NUT = LINK + '[[links]]\nname = "nut"\nmass = 2\nlength = 0.5\n'
ASKED = {  # a system for each question, and keys that it needs
    "modes": (ROD_AND_NUT, {}),
    "shapes": (ROD_AND_NUT, {"angular_speed": "5"}),
    "response": (ROD_AND_NUT + "[support]\nstiffness = 20\n", {"angular_speed": "5"}),
    "swing": (ROD_AND_NUT, {"offset": "[0.1, 0]"}),
    "branches": (ROD_AND_NUT, {"max_angular_speed": "6"}),
    "campbell": (ROD_AND_NUT, {"angular_speed": "[8, 9]"}),
    "drag": (ARM + AIR, {"angular_speed": "3"}),
    "equilibria": (GOVERNOR, {"angular_speed": "9"}),
}
WRONG = ["0", "-1", "nan", "inf", "-inf", "1e300", "1e-300", "9223372036854775807", "1.5", "true", '"x"', '"3 parsnip"', '"3 kg"', '"-3 s"']
WRONG += ["[]", "[1, 1]", "[2, 1]", "[-1, 2]", "[0, 0]", "[nan, 1]", '["1 kg", 2]', "[1, 2, 3]", "{}", "{to = 1}", "{from = 2, to = 1}"]
WRONG += ['{from = "1 kg", to = 2}', "{from = 1, to = 2, steps = 0}", "{from = 1, to = 1e300}", "{from = nan, to = 1}"]


@pytest.mark.parametrize("question", ASKED)
def test_every_wrong_value_of_every_key_is_named(tmp_path, question):
    """Of each key of each question: a number out of range, another unit, another type: file, line, key and reason."""
    system, needed = ASKED[question]
    path, refused = tmp_path / "a.toml", 0
    keys = [field.encode_name for field in fields_of(QUESTIONS[question])]
    for key in keys:
        other = {"angular_speed": "conical_height", "max_angular_speed": "min_conical_height"}
        for wrong in WRONG:
            given = {name: value for name, value in needed.items() if key not in (other.get(name), name)} | {key: wrong}
            table = "".join(f"{name} = {value}\n" for name, value in given.items())
            path.write_text(f"{system}[ask.{question}]\n{table}")
            try:
                rc.load_scene(path)._answer(question, {})
            except rc.SceneError as error:
                refused += 1
                last = path.read_text().count("\n")
                first = system.count("\n") + 1
                for line, column, named, reason in error.problems:
                    assert first <= line <= last and column >= 1 and named.startswith(f"ask.{question}"), (str(error), table)
                    assert PYTHON.search(reason) is None and not reason.endswith("got"), str(error)
                assert str(error).startswith(f"{path}: line ")
    assert refused > 15 * len(keys)


RIGGED = '[support]\nradius = 1\n[[links]]\nname = "nut"\nmass = 1\nlength = 1\n'
SHAPE = "[ask.shapes]\nangular_speed = 5\n"
UNANSWERED = {  # a rig, a question that has no answer for it, and what is said
    "linear drag": (RIGGED + "drag = 2\n" + SHAPE, "steady_shapes", "7:1 links[0].drag: steady shapes cannot be found for a rig with linear drag: leave it out"),
    "drag beside campbell": (RIGGED + "drag = 2\n[ask.campbell]\nangular_speed = [6, 8]\n", "campbell", "7:1 links[0].drag: steady shapes cannot be found for a rig with linear drag: leave it out"),
    "springs at pins": (RIGGED + "pin = {stiffness = 1}\n" + SHAPE, "steady_shapes", "7:1 links[0].pin: steady shapes cannot be found for a rig with springs at pins: leave them out"),
    "dashpots": ("[support]\nstiffness = 1\ndamping = 1\n" + LINK + SHAPE, "steady_shapes", "3:1 support.damping: steady shapes cannot be found for a rig with dashpots: leave them out"),
    "a trolley": ("[support]\nmass = 1\n" + LINK + "[ask.branches]\nmax_angular_speed = 5\n", "branches", "1:1 support: branches cannot be found for a rig with a trolley that rolls freely: give it a stiffness"),
    "an arm": (RIGGED + "[ask.swing]\noffset = [0.1]\n", "swing", "2:1 support.radius: the support is carried round: it does not let the rig swing; use response, got 1"),
    "a fluid": ('fluid = "turning"\n' + LINK + "displaced = {mass = 0.1}\n[ask.swing]\noffset = [0.1]\n", "swing", "1:1 fluid: links[0] is in a fluid that turns"),
    "too slow": (LINK + "[ask.campbell]\nangular_speed = [1, 2]\n", "campbell", "4:1 ask.campbell: at none of the speeds, 1 to 2 rad/s, is there a shape"),
    "no such shape": (ARM + AIR + "[ask.drag]\nangular_speed = 3\nhalf_waves = 4\n", "drag_shape", "9:1 ask.drag.half_waves: there is no shape without drag"),
    "too fast": (CORD + "[ask.shapes]\nangular_speed = 1e9\n", "steady_shapes", "4:1 ask.shapes: length / conical height must be at most 1e6"),
    "in JSON": ('{"links": [{"mass": 1,\n  "length": 1, "drag": 2}],\n "ask": {"shapes": {"angular_speed": 5}}}', "steady_shapes", "2:16 links[0].drag: steady shapes"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "ask", "said"), UNANSWERED.values(), ids=UNANSWERED.keys())
def test_an_answer_that_fails_names_line_and_key(tmp_path, monkeypatch, capsys, text, ask, said):
    """Of what is refused only when it is asked: in Python and on the command line, which answers the other questions."""
    monkeypatch.chdir(tmp_path)
    name = "a.json" if text.startswith("{") else "a.toml"
    Path(name).write_text(text)
    scene = rc.load_scene(name)
    line, column, key = re.match(r"(\d+):(\d+) (\S+): ", said).groups()
    with pytest.raises(rc.SceneError) as caught:
        getattr(scene, ask)()
    assert str(caught.value).startswith(re.sub(r"^\d+:\d+", f"{name}: line {line}, column {column}:", said))
    assert caught.value.problems[0][:3] == (int(line), int(column), key) and "Support(" not in str(caught.value)
    assert _cli.run([name]) == 2
    assert capsys.readouterr().err == f"revchain: {caught.value}\n"
    Path(name).unlink()  # without the file there is no line
    with pytest.raises(rc.SceneError, match=re.escape(f"scene: {said.partition(' ')[2]}")):
        getattr(scene, ask)()


def test_a_value_of_the_caller_has_no_line(tmp_path):
    path = tmp_path / "a.toml"
    path.write_text(LINK + "[ask.swing]\noffset = [0.1]\ncount = 1\n")
    with pytest.raises(rc.SceneError) as caught:
        rc.load_scene(path).swing(offset=[0.1, 0.2])
    assert caught.value.problems == ((0, 0, "ask.swing.offset", "must have a number for each of the 1 pins that move, free end first, got 2"),)
    with pytest.raises(rc.SceneError, match="line 6, column 1: ask.swing.count: must be from 0 to 1, got 3"):
        path.write_text(LINK + "[ask.swing]\noffset = [0.1]\ncount = 3\n")
        rc.load_scene(path).swing(offset=[0.2])


HUGE = {
    "mass": "[[links]]\nlength = 1\nmass = X\n",
    "length": "[[links]]\nmass = 1\nlength = X\n",
    "tip_mass": LINK + "tip_mass = X\n",
    "drag": LINK + "drag = X\n",
    "pin.stiffness": LINK + "pin.stiffness = X\n",
    "support.mass": LINK + "[support]\nstiffness = 1\nmass = X\n",
    "uniform_chain.tip_mass": '[uniform_chain]\nkind = "rods"\ncount = 3\nlength = 1\nmass = 1\ntip_mass = X\n',
    "cord.tip_mass": CORD + "tip_mass = X\n",
    "cord.masses[0].mass": CORD + "[[cord.masses]]\narc_length = 0.5\nmass = X\n",
    "held.tension": LINK + "[held]\ntension = X\n",
    "governor.ball_mass": "[governor]\narm = 1\nball_mass = X\n",
    "air_drag.area": ARM + LINK + "air_drag.coefficient = 1\nair_drag.area = X\n[ask.drag]\nangular_speed = 3\n",
}


@pytest.mark.parametrize("number", ["1e200", "1e300", "1e-200", "9e99"])
@pytest.mark.parametrize("key", HUGE)
def test_a_number_beyond_all_measure_is_named_itself(tmp_path, key, number):
    path = tmp_path / "a.toml"
    path.write_text(HUGE[key].replace("X", number))
    try:
        rc.load_scene(path)
        assert abs(float(number)) < 1e100
    except rc.SceneError as error:
        [problem] = error.problems
        assert problem.key.endswith(key) and f"{key.rpartition('.')[2]} = {number}" in path.read_text().split("\n")[problem.line - 1]
        assert problem.reason.endswith(f"from 1e-100 to 1e+100 in size, in SI units, got {float(number):g}")


ONE = {"mass": 1.0, "length": 1.0}
ROD = {"mass": 1.0, "length": 1.5, "kind": "rod"}
WHEEL = {"mass": 1.5, "radius_of_gyration": 0.29, "spin": "300 rpm"}
RODS = {"uniform_chain": {"kind": "rods", "count": 30, "length": 1, "mass": 1}}
BLADE = {"uniform_chain": {"kind": "rods", "count": 40, "length": 3.0, "mass": 12.0}, "held": {"span": 2.4}}
UP = {"standing": True}


def of(table, **ask):
    return {**table, "ask": ask}


# Plain data, and how the first line begins.
DATA = {
    "negative length": ({"links": [ONE, ONE, {**ONE, "length": -0.5}]}, "links[2].length: must be positive, got -0.5"),
    "nan": ({"links": [{**ONE, "length": math.nan}]}, "links[0].length: must be"),
    "infinite": ({"links": [{**ONE, "mass": math.inf}]}, "links[0].mass: must be finite"),
    "massless lowest": ({"links": [{**ONE, "mass": 0}, ONE]}, "links[0]: "),
    "massless uniform": ({"uniform_chain": {"kind": "rods", "count": 2, "length": 1, "mass": 0}}, "uniform_chain.mass: must be positive"),
    "stands": ({"links": [{**ONE, "repeat": 3}, {"mass": 9, "length": 1, "centroid": -1, "radius_of_gyration": 1}]}, "links[1]: "),
    "stands, from the top": ({"order": "support first", "links": [{"mass": 9, "length": 1, "centroid": -1, "radius_of_gyration": 1}, {**ONE, "repeat": 3}]}, "links[0]: "),
    "imaginary": ({"links": [{**ONE, "centroid": 0.5, "pendulum_length": 0.4}]}, "links[0].pendulum_length: makes the radius"),
    "pendulum of a link at its pin": ({"links": [ONE, {**ONE, "centroid": 0, "pendulum_length": 0.4}]}, "links[1].pendulum_length: does not determine"),
    "centroid alone": ({"links": [{**ONE, "centroid": 0.5}]}, "links[0].centroid: needs either"),
    "centroid with both": ({"links": [{**ONE, "centroid": 0.5, "pendulum_length": 1, "radius_of_gyration": 1}]}, "links[0].centroid: needs either"),
    "radius alone": ({"links": [{**ONE, "radius_of_gyration": 0.5}]}, "links[0].radius_of_gyration: needs centroid"),
    "rod with centroid": ({"links": [{**ONE, "kind": "rod", "centroid": 0.5}]}, 'links[0].centroid: does not go with kind = "rod"'),
    "unknown key, nothing near": ({"links": [{**ONE, "colour": 1}]}, "links[0].colour: unknown key; known keys: length, name, weight, mass"),
    "unknown method": (of(RODS, modes={"method": "qr"}), "ask.modes.method: must be one of bisection, condensed, aberth, interpolated, dense, recurrence"),
    "a boolean for a number": ({"links": [{**ONE, "length": True}]}, "links[0].length: must be a number"),
    "huge integer": ({"links": [{**ONE, "length": 10**400}]}, "links[0].length: must be a number"),
    "repeat 0": ({"links": [{**ONE, "repeat": 0}]}, "links[0].repeat: must be at least 1, got 0"),
    "repeat not whole": ({"links": [{**ONE, "repeat": 1.5}]}, "links[0].repeat: must be a whole number, got 1.5"),
    "too many": ({"links": [{**ONE, "repeat": 6_000_000}] * 2}, "links: must be at most 10,000,000 together with their repeats, got 12,000,000; use fewer and longer links, or [cord]"),
    "no number": ({"links": [{**ONE, "length": "long"}]}, "links[0].length: must be a number, or a number and its unit"),
    "negative with unit": ({"links": [{**ONE, "length": "-2 m"}]}, 'links[0].length: must be positive, got "-2 m"'),
    "infinite with unit": ({"links": [{**ONE, "length": "1e999 m"}]}, "links[0].length: must be finite"),
    "gravity 0": ({"links": [ONE], "gravity": 0}, "gravity: must be positive, got 0"),
    "gravity of another kind": ({"links": [ONE], "gravity": "9.81 m"}, "gravity: must be an acceleration"),
    "another version": ({"links": [ONE], "schema_version": 3}, "schema_version: must be 2, got 3"),
    "no table at all": ([], "must be a table"),
    "an array for the scene": (np.zeros(3), "must be a table"),
    "an array for a link": ({"links": [np.zeros(3)]}, "links[0]: must be a table"),
    "an array for a system": ({"cord": np.zeros(3)}, "cord: must be a table"),
    "keys that are no text": ({1: 2}, "every key must be text"),
    "spring below 0": ({"links": [ROD], "support": {"stiffness": -2}}, "support.stiffness: must not be negative, got -2"),
    "spring in kg": ({"links": [ROD], "support": {"stiffness": "3 kg"}}, 'support.stiffness: must be a force per length such as "2 kN/m"'),
    "firm with a dashpot": ({"links": [ROD], "support": {"damping": 1}}, "support.damping: does not go with a firm support"),
    "damping in kg": ({"links": [ROD], "support": {"damping": "3 kg"}}, 'support.damping: must be a force over a speed such as "50 N s/m"'),
    "pin below 0": ({"links": [{**ROD, "pin": {"stiffness": -1}}]}, "links[0].pin.stiffness: must not be negative, got -1"),
    "pin in N/m": ({"links": [{**ROD, "pin": {"stiffness": "3 N/m"}}]}, "links[0].pin.stiffness: must be a torque over an angle"),
    "pin of what": ({"links": [{**ROD, "pin": {"spring": 3}}]}, "links[0].pin.spring: unknown key"),
    "fluid": ({"links": [ROD], "fluid": "air"}, "fluid: must be one of still, turning"),
    "standing": ({"links": [{**ROD, "standing": 1}]}, "links[0].standing: must be true or false, got 1"),
    "no radius": ({"links": [ROD, {**ROD, "flywheel": {"mass": 1, "spin": 1}}]}, "links[1].flywheel.radius_of_gyration: is missing"),
    "spin": ({"links": [{**ROD, "flywheel": {**WHEEL, "spin": "3 m"}}]}, "links[0].flywheel.spin: must be an angular speed"),
    "wheel": ({"links": [{**ROD, "flywheel": {**WHEEL, "weight": 1}}]}, "links[0].flywheel.weight: is given beside mass"),
    "displaced": ({"links": [{**ROD, "displaced": {}}]}, "links[0].displaced: mass (kg) or weight (N) is missing"),
    "added mass": ({"links": [{**ROD, "displaced": {"mass": 1, "added_mass": "1 m"}}]}, "links[0].displaced.added_mass: must be a mass"),
    "tip of many": ({"links": [{**ROD, "tip_mass": 1, "repeat": 2}]}, "links[0].repeat: must be 1 where a weight is fixed"),
    "two tips": ({"links": [{**ROD, "tip_mass": 1, "tip_weight": 2}]}, "links[0].tip_weight: is given beside tip_mass"),
    "no link above": ({"links": [ROD, {**ROD, "clamped": True}]}, "links[1].clamped: there is no link above"),
    "clamped to many": ({"links": [{**ROD, "clamped": True}, {**ROD, "repeat": 2}]}, "links[0].clamped: needs repeat = 1"),
    "clamped wheel": ({"links": [{**ROD, "clamped": True, "flywheel": WHEEL}, ROD]}, "links[0].flywheel: must be given for the link above"),
    "held by nothing": ({**BLADE, "held": {}}, "held: give either span or tension"),
    "span": ({**BLADE, "held": {"span": 3.0}}, "held.span: must be less than the length"),
    "held rig": ({**BLADE, "support": {"radius": 1}}, "held: does not go with"),
    "count 0": (of(RODS, modes={"count": 0}), "ask.modes.count: must be at least 1, got 0"),
    "count not whole": (of(RODS, modes={"count": 1.5}), "ask.modes.count: must be a whole number or all, got 1.5"),
    "first too far": (of(RODS, modes={"first": 31}), "ask.modes.first: must be at most 30, got 31"),
    "window and count": (of(RODS, modes={"count": 2, "conical_height": [1, 2]}), "ask.modes.conical_height: does not go with count"),
    "two windows": (of(RODS, modes={"conical_height": [1, 2], "angular_speed": [1, 2]}), "ask.modes.angular_speed: does not go with conical_height"),
    "low above high": (of(RODS, modes={"conical_height": ["2 cm", "2 mm"]}), 'ask.modes.conical_height: its low end must lie below its high end, got ["2 cm", "2 mm"]'),
    "three ends": (of(RODS, modes={"conical_height": [1, 2, 3]}), "ask.modes.conical_height: must be a pair [low, high], got [1, 2, 3]"),
    "end nan": (of(RODS, modes={"angular_speed": [1, math.nan]}), "ask.modes.angular_speed[1]: must"),
    "rtol nan": (of(RODS, modes={"rtol": math.nan}), "ask.modes.rtol: must"),
    "rtol infinite": (of(RODS, modes={"rtol": math.inf}), "ask.modes.rtol: must be finite"),
    "rtol in m": (of(RODS, modes={"rtol": "1 m"}), 'ask.modes.rtol: must be a fraction such as "1 %", got "1 m"'),
    "single precision": (of(RODS, modes={"precision": "single"}), 'ask.modes.precision: must be one of double, extended, double-double, got "single"'),
    "precision with method": (of(RODS, modes={"precision": "extended", "method": "dense"}), "ask.modes.precision: method ="),
    "certify": (of(RODS, modes={"certify": "yes"}), 'ask.modes.certify: must be true or false, got "yes"'),
    "direction": (of(RODS, shapes={"angular_speed": 1.0, "direction": 2}), "ask.shapes.direction: must be one of 1, -1, got 2"),
    "half waves of what hangs": (of(RODS, shapes={"angular_speed": 1.0, "max_half_waves": 2}), "ask.shapes.max_half_waves: is for a chain held at both ends, got 2"),
    "response in s": (of(RODS, response={"conical_height": ["2 s"]}), "ask.response.conical_height[0]: must be a length"),
    "response backward": (of(RODS, response={"angular_speed": -1.0}), "ask.response.angular_speed: must be positive, got -1"),
    "response at rest": (of({"links": [{**ROD, "flywheel": WHEEL}]}, response={"angular_speed": 0}), "ask.response.angular_speed: must not be 0"),
    "log through 0": (of({"links": [{**ROD, "flywheel": WHEEL}]}, response={"angular_speed": {"from": -1, "to": 2, "log": True}}), "ask.response.angular_speed.log: equal ratios"),
    "offsets": (of({"links": [ONE, ONE]}, swing={"offset": [0.1]}), "ask.swing.offset: must have a number for each of the 2 pins"),
    "offset in s": (of({"links": [ONE, ONE]}, swing={"offset": [0.1, "3 s"]}), "ask.swing.offset[1]: must be a length"),
    "time": (of({"links": [ONE]}, swing={"offset": [0.1], "time": "2 m"}), "ask.swing.time: must be a time"),
    "certified cord": ({"cord": {"length": 1, "mass": 1}, "ask": {"modes": {"certify": True}}}, "ask.modes.certify: is for a chain that hangs"),
    "supported cord": ({"cord": {"length": 1, "mass": 1}, "support": {"radius": 1}}, "cord: does not go with a support"),
    "held cord with a tip": ({"cord": {"length": 1, "mass": 1, "tip_mass": 1}, "held": {"span": 0.5}}, "held.span: a held cord must be uniform"),
    "direction of held": (of(BLADE, shapes={"angular_speed": 1, "direction": -1}), "ask.shapes.direction: is for a chain that hangs, got -1"),
    "added mass in a fluid that turns": ({"fluid": "turning", "links": [ROD, {**ROD, "displaced": {"mass": 1, "added_mass": 2}}]}, "links[1].displaced: must have no added_mass"),
    "text that is not Unicode": ({"links": [ONE], "title": "\ud800"}, "has text that is not Unicode"),
}  # fmt: skip


@pytest.mark.parametrize(("data", "message"), DATA.values(), ids=DATA.keys())
def test_errors_name_the_key(data, message):
    with pytest.raises(rc.SceneError) as caught:
        Scene.from_dict(data, source="my.toml")
    assert str(caught.value).startswith(f"my.toml: {message}")
    assert isinstance(caught.value, ValueError) and PYTHON.search(str(caught.value)) is None


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("a.json", '{"gravity": ' + "9" * 5000 + "}"),
        ("a.json", '{"links": [{"mass": ' + "1" * 10**5 + ', "length": 1}]}'),
        ("a.toml", "links = [{mass = 0x" + "f" * 10**4 + ", length = 1}]"),
        ("a.toml", 'links = [{mass = "' + "1" * 20_000 + ' kg!", length = 1}]'),
        ("a.json", '{"a": ' * 900 + "1" + "}" * 900),
    ],
)
def test_files_beyond_all_measure(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    with pytest.raises(rc.SceneError, match=name):
        rc.load_scene(tmp_path / name)


def test_files_that_cannot_be_read(tmp_path):
    for path, message in ((tmp_path / "missing.toml", "No such file"), (tmp_path, "directory")):
        with pytest.raises(rc.SceneError, match=f"cannot be read: .*{message}"):
            rc.load_scene(path)
    (tmp_path / "latin.toml").write_bytes("title = 'Glöckner'".encode("latin-1"))
    with pytest.raises(rc.SceneError, match="is not UTF-8 text .byte 12."):
        rc.load_scene(tmp_path / "latin.toml")


DEEP = {
    "lists.toml": f"links = {'[' * 33}{']' * 33}",
    "tables.toml": f"{'a.' * 33}b = 1",
    "recursion.toml": f"links = {'[' * 100_000}",
    "lists.json": '{"links": ' + "[" * 33 + "]" * 33 + "}",
    "recursion.json": "[" * 100_000,
}


@pytest.mark.parametrize("name", DEEP)
def test_tables_and_lists_too_deep(tmp_path, name):
    path = tmp_path / name
    path.write_text(DEEP[name])
    for load in (rc.load_scene, rc.load_study):
        with pytest.raises(rc.SceneError) as caught:
            load(path)
        more = "remove brackets or dots: a scene needs at most 8"
        assert str(caught.value) == f"{path}: tables and lists lie more than 32 levels deep; {more}"


def test_the_deepest_level_that_is_read(tmp_path):
    path = tmp_path / "scene.toml"
    path.write_text(f"links = {'[' * 31}{']' * 31}")
    with pytest.raises(rc.SceneError, match=r"links\[0\]: must be a table, got \["):
        rc.load_scene(path)


@pytest.mark.parametrize("ending", ["toml", "json"])
def test_a_file_too_large(tmp_path, ending, monkeypatch):
    monkeypatch.setattr(parse, "MOST_BYTES", 100)
    path = tmp_path / f"scene.{ending}"
    scene = {"toml": LINK, "json": json.dumps({"links": [{"mass": 1, "length": 1}]})}[ending]
    path.write_text(scene + " " * (100 - len(scene)))
    assert rc.load_scene(path).system().size == 1
    path.write_text(scene + " " * (101 - len(scene)))
    with pytest.raises(rc.SceneError) as caught:
        rc.load_scene(path)
    more = "write equal links once, with repeat, or make the system in Python"
    assert str(caught.value) == f"{path}: has more than 100 bytes, the limit for a file; {more}"


def test_a_file_without_end():
    with pytest.raises(rc.SceneError, match="/dev/zero: has more than 16,777,216 bytes"):
        rc.load_scene("/dev/zero")


NAMES = {"\0": "must have no null byte", "\ud800": "is no name of a file: it has a lone surrogate"}


@pytest.mark.parametrize(("name", "reason"), NAMES.items(), ids=ascii)
def test_a_study_that_names_no_file(tmp_path, name, reason):
    path = tmp_path / "study.json"
    path.write_text(json.dumps({"scene": name, "vary": {"gravity": {"values": [1, 2]}}}))
    with pytest.raises(rc.SceneError) as caught:
        rc.load_study(path)
    assert str(caught.value).startswith(f"{path}: line 1, column 2: scene: ") and reason in str(caught.value)


def test_the_work_for_many_problems_grows_with_their_number():
    """Not with its square: counted in reasons that are compared, not in seconds."""

    class Reason(str):
        compared = 0

        def startswith(self, *_):
            Reason.compared += 1
            return super().startswith(*_)

    def compared(count):
        found = [Problem(0, 0, f"links[{k}].length", Reason("is missing")) for k in range(count)]
        remaining = parse.without_consequences([*found, *found, Problem(0, 0, "links", "gravity and length are wrong")])
        result, Reason.compared = Reason.compared, 0
        assert [id(each) for each in remaining] == [id(each) for each in found]
        return result

    assert 0 < compared(2000) < 3 * compared(1000)
