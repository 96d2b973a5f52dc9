# SPDX-License-Identifier: GPL-3.0-or-later
"""What a first reader of a report, a table or a message must be able to rely on."""

import re

import numpy as np
import pytest
from pages import Page

import revchain as rc
from revchain.results.parts import parts_of

LINKS = """
title = "Carousel"
{head}
[[links]]
name = "{first}"
mass = {mass}
length = 2.0
[[links]]
name = "{second}"
mass = 80
length = 1.0
air_drag = {{coefficient = 1.1, area = 0.6}}
[support]
radius = 3
"""
TOP_FIRST = LINKS.format(head='order = "support first"\nspeed = "rpm"', first="arm", mass=10, second="chair")


def of(tmp_path, text):
    path = tmp_path / "scene.toml"
    path.write_text(text)
    return rc.load_scene(path)


def page(tmp_path, scene):
    scene.report(tmp_path / "report.html")
    text = (tmp_path / "report.html").read_text(encoding="utf-8")
    return text, Page(text)


@pytest.mark.parametrize("order", ["support first", "free end first"])
def test_links_have_the_numbers_of_the_scene(tmp_path, order):
    scene = of(tmp_path, LINKS.format(head=f'order = "{order}"', first="a", mass=10, second="b") + "[ask.modes]\n")
    text, found = page(tmp_path, scene)
    [table] = [table for table in found.tables if table[0][:2] == ["link", "name"]]
    assert {row[0].strip(): row[1] for row in table[1:]} == {"0": "a", "1": "b"}
    assert [row[1] for row in table[1:]] == (["a", "b"] if order == "support first" else ["b", "a"])  # from the support down
    which = "the one at the support" if order == "support first" else "the lowest"
    assert f"Links from the support down; link 0 is {which}, the first in the scene." in found.text
    system = scene.system()
    columns = {column.name: list(column.values) for column in parts_of(system)[1]}
    assert dict(zip(columns["link"], columns["name"], strict=True)) == {0: "a", 1: "b"}
    assert {system._link_name(k) for k in range(2)} == {"link 0, a", "link 1, b"}
    with pytest.raises(rc.SceneError, match=r'links\[0\]\.mass \("a"\)'):
        of(tmp_path, LINKS.format(head=f'order = "{order}"', first="a", mass=-1, second="b"))


def test_equal_links_count_upwards_from_either_end(tmp_path):
    for order, numbers in (("support first", ["0 to 2", "3"]), ("free end first", ["3", "0 to 2"])):
        scene = rc.Scene.from_dict({"order": order, "links": [{"mass": 1, "length": 1, "repeat": 3}, {"mass": 2, "length": 1}]})
        _, found = page(tmp_path, scene)
        [table] = [table for table in found.tables if table[0][0] == "link"]
        assert [row[0].strip() for row in table[1:]] == numbers


@pytest.mark.parametrize(("unit", "words"), [
    ("rpm", ["12.0000 rpm (1.25664 rad/s)", "rpm (1.831 rad/s, period 3.431 s)"]),
    ("Hz", ["0.200000 Hz (1.25664 rad/s)", "Hz (1.831 rad/s, period 3.431 s)"]),
    ("s", ["a period of 5.00000 s (1.25664 rad/s)", "Mode 1: period 3.431 s (1.831 rad/s)"]),
    ("rad/s", ["1.25664 rad/s (12.00 rpm)", "Mode 1: 1.831 rad/s (17.49 rpm, period 3.431 s)"]),
])  # fmt: skip
def test_headings_begin_with_the_unit_asked(tmp_path, unit, words):
    ask = '[ask.modes]\n[ask.shapes]\nangular_speed = "12 rpm"\n[ask.drag]\nangular_speed = "12 rpm"\n'
    scene = of(tmp_path, TOP_FIRST.replace('"rpm"', f'"{unit}"') + ask)
    _, found = page(tmp_path, scene)
    assert all(each in found.text for each in words)
    assert words[0] in repr(scene.steady_shapes())
    assert words[0].replace("(12.00", "(12") in repr(scene.drag_shape())
    assert "was read as" not in found.text


def test_a_plain_number_beside_another_unit_is_explained(run, tmp_path):
    scene = of(tmp_path, TOP_FIRST + "[ask.shapes]\nangular_speed = 8\n")
    said = 'the plain number angular_speed = 8 was read as 8 rad/s = 76.39 rpm: for 8 rpm write angular_speed = "8 rpm"'
    assert said in repr(scene.steady_shapes())
    assert scene.steady_shapes().angular_speed == 8.0
    text, found = page(tmp_path, scene)
    assert said[1:] in found.text
    _, out, _ = run("shapes", tmp_path / "scene.toml", "--angular-speed", "8")
    assert 'for 8 rpm write --angular-speed "8 rpm"' in " ".join(out.split())
    assert "was read as" not in repr(scene.steady_shapes(angular_speed="8 rpm"))
    plain = of(tmp_path, TOP_FIRST.replace('speed = "rpm"', "") + "[ask.shapes]\nangular_speed = 8\n")
    assert "was read as" not in repr(plain.steady_shapes())


def test_links_in_compression_are_named(tmp_path):
    scene = of(tmp_path, TOP_FIRST + '[ask.shapes]\nangular_speed = "30 rpm"\nhanging_only = false\n')
    shapes = scene.steady_shapes()
    hanging = 0
    for k, shape in enumerate(shapes, 1):
        down = np.diff(np.array([shape.offset, shape.height]).T, axis=0)  # from the lower pin of each link to its upper one
        pull = np.sum(shape.reaction[:, [0, 2]] * down, axis=1)
        assert len(shape._compressed) == int((pull < 0).sum())
        assert (f"shape {k}: in compression, which only rods can carry" in repr(shapes)) == bool((pull < 0).any())
        hanging += not (pull < 0).any()
    assert 0 < hanging < len(shapes)
    _, found = page(tmp_path, scene)
    assert "tension is the size of the force" in found.text
    assert "compression" not in repr(scene.steady_shapes(hanging_only=True))
    assert "compression" not in repr(rc.steady_shapes(rc.Cord(1.0), conical_height=0.05))


def test_what_air_drag_acts_on_is_said(tmp_path):
    scene = of(tmp_path, TOP_FIRST + '[ask.modes]\n[ask.drag]\nangular_speed = "8 rpm"\nair_density = 1.1\n')
    left_out = "the drag of air is left out here: air_drag acts in [ask.drag] only"
    assert left_out in repr(scene.modes()) and left_out not in repr(scene.drag_shape())
    _, found = page(tmp_path, scene)
    assert left_out[1:] in found.text and "density of the air" in found.text
    [table] = [table for table in found.tables if table[0][:2] == ["link", "name"]]
    assert [re.sub(r"\W", "", cell) for cell in table[0][-2:]] == ["dragcoefficient", "dragaream²"]
    drag = scene.drag_shape()
    assert drag.distance == pytest.approx(np.hypot(drag.position[:-1, 0], drag.position[:-1, 1]), rel=1e-15)
    without = of(tmp_path, TOP_FIRST.replace("air_drag", "# air_drag") + "[ask.modes]\n")
    assert "drag" not in repr(without.modes())


TROLLEY = """
[[links]]
name = "load"
mass = 2000
length = 10
[support]
mass = 500
"""


def test_words_for_a_trolley(tmp_path):
    scene = of(tmp_path, TROLLEY + "[ask.modes]\n[ask.swing]\nsupport_time = [0, 2]\nsupport_velocity = [1, 0]\n")
    _, found = page(tmp_path, scene)
    assert "Natural motions" in found.text and "about the vertical axis" not in found.text
    assert "Mode 1: period 2.837 s (2.214 rad/s)" in found.text
    note = "the trolley moves as prescribed: its own mass and damping have no effect"
    assert note in repr(scene.swing()) and note[1:] in found.text
    assert "after 2 s the free end of load sways" in repr(scene.swing())
    heavier = of(tmp_path, TROLLEY.replace("500", "5000") + "[ask.swing]\nsupport_time = [0, 2]\nsupport_velocity = [1, 0]\n")
    assert heavier.swing().offset == pytest.approx(scene.swing().offset, abs=1e-12)
    free = TROLLEY.replace("mass = 500", 'stiffness = "0 N/m"\ndamping = 5')
    damped = of(tmp_path, free + "[ask.swing]\nsupport_time = [0, 2]\nsupport_velocity = [1, 0]\n")
    assert note in repr(damped.swing()) and damped.swing().offset == pytest.approx(scene.swing().offset, abs=1e-12)
    pushed = of(tmp_path, TROLLEY + "[ask.swing]\nsupport_time = [0, 2]\nsupport_force = [1, 0]\n")
    assert "prescribed" not in repr(pushed.swing())


LINK = "links = [{mass = 1, length = 2}]\n"
MANY = "[" + ", ".join(f'"{k} rpm"' for k in range(30, 200, 10)) + "]"
SEVERAL = 'for several speeds write a study with [vary."ask.shapes.angular_speed"] and values = ["8 rpm", "10 rpm"]: revchain sweep'


@pytest.mark.parametrize(("text", "says"), [
    (LINK + '[ask.shapes]\nangular_speed = ["8 rpm", "10 rpm"]\n', SEVERAL),
    (LINK + '[ask.shapes]\nangular_speed = "8 rpm; 10 rpm"\n', SEVERAL),
    (LINK + '[ask.shapes]\nangular_speed = "1e1 rpm, 2e1 rpm"\n', 'values = ["1e1 rpm", "2e1 rpm"]: revchain sweep'),
    (LINK + f"[ask.shapes]\nangular_speed = {MANY}\n", f"values = {MANY}: revchain sweep"),
    (LINK + '[ask.swing]\noffset = [0.1]\ntime = "0 to 30 in 301"\n', "is written {from = 0, to = 30, steps = 301}, got"),
    (LINK + '[ask.swing]\noffset = [0.1]\ntime = "0 s to 30 s"\n', 'is written {from = "0 s", to = "30 s"}, got'),
    (LINK + '[ask.swing]\nsupport_time = "2 s"\nsupport_velocity = [1, 0]\n', 'write ["0 s", "2 s"]'),
    (LINK + '[support]\ndiameter = "12 m"\n', "write radius, half of the diameter"),
    (LINK + "[trolley]\nmass = 12\n", "write [support] and below it mass"),
    ("[[links]]\nmass = 1\nlength = 1\nrope = 3\n", 'write length, and name = "rope"'),
    ("[[links]]\nmass = 1\nlength = 1\nload = 3\n", 'write mass, and name = "load"'),
    (LINK + "[ask.fit]\nmode = 1\n", "fits are made in Python, by revchain.fit"),
])  # fmt: skip
def test_messages_say_what_to_write(tmp_path, text, says):
    with pytest.raises(rc.SceneError) as error:
        of(tmp_path, text)
    assert says in str(error.value) and len(error.value.problems) == 1


def test_the_advice_leads_to_no_second_error(run, tmp_path):
    said = of(tmp_path, LINK + '[ask.swing]\nsupport_time = ["0 s", "2 s"]\nsupport_velocity = [1, 0]\ntime = {from = 0, to = 30, steps = 301}\n')
    assert said.swing().time.size == 301
    assert of(tmp_path, LINK + '[support]\nradius = "6 m"\n').system().support.radius == 6.0
    of(tmp_path, LINK + '[ask.shapes]\nangular_speed = "8 rpm"\n')
    (tmp_path / "study.toml").write_text('scene = "scene.toml"\n[vary."ask.shapes.angular_speed"]\nvalues = ["40 rpm", "60 rpm"]\n')
    assert run("sweep", tmp_path / "study.toml", "--out", tmp_path / "s.csv")[0] == 0


def test_messages_of_the_command_line(run, tmp_path):
    of(tmp_path, LINK)
    code, _, err = run("shapes", tmp_path / "scene.toml", "--angular-speed", "8 rpm; 10 rpm")
    assert code != 0 and SEVERAL in err
    code, _, err = run("fit", tmp_path / "scene.toml")
    assert code != 0 and "fits and tuning are done in Python, by revchain.fit" in err


def test_only_results_that_can_be_drawn_list_plot():
    found = rc.modes(rc.Chain(mass=[1.0, 3.0], length=1.0))
    assert "plot" in dir(found) and callable(found.plot)
    uncertain = found.uncertainty(length=0.01, worst=True)
    for result in (uncertain, uncertain.worst):
        assert "plot" not in dir(result) and not hasattr(result, "plot") and "to_dict" in dir(result)


def test_a_decimal_comma_is_no_list_of_speeds(tmp_path):
    with pytest.raises(rc.SceneError) as error:
        of(tmp_path, LINK + '[ask.shapes]\nangular_speed = "3,5 rad/s"\n')
    assert 'write "3.5 rad/s"' in str(error.value) and "several speeds" not in str(error.value)
