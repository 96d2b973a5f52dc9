# SPDX-License-Identifier: GPL-3.0-or-later
"""The numbers of the live page against the package, and what its sliders, links and keys do."""

from __future__ import annotations

import importlib.util
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import revchain as rc

ROOT = Path(__file__).resolve().parents[2]
_spec = importlib.util.spec_from_file_location("web_page", ROOT / "tools" / "web_page.py")
assert _spec and _spec.loader
web_page = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(web_page)

TOLERANCE = 1e-12  # relative, the target of the page
ENGINES = ["", "?plain"] if (ROOT / "out/web/plain.js").is_file() else [""]


def settled(page: Any) -> dict[str, Any]:
    return page.evaluate(
        "settled().then((found) => JSON.parse(JSON.stringify(found, (key, x) => ArrayBuffer.isView(x) ? Array.from(x) : x)))"
    )


def close(found: Any, expected: Any) -> None:
    expected = np.asarray(expected)
    scale = np.max(np.abs(expected), initial=0)
    np.testing.assert_allclose(np.asarray(found), expected, rtol=TOLERANCE, atol=TOLERANCE * scale)


def same_modes(found: dict[str, Any], system: Any, gravity: float) -> None:
    of = system if isinstance(system, rc.Rig) else rc.Rig(system)
    expected = rc.modes(of, min(system.size + 1, 12), gravity=gravity)
    assert len(found["modes"]) == len(expected.angular_speed)
    for mode, speed, height, shape, nodes in zip(
        found["modes"], expected.angular_speed, expected.conical_height, expected.shape, expected.nodes, strict=True
    ):
        close(mode["speed"], speed)
        close(mode["height"], height)
        close(mode["offset"], shape)
        close(mode["nodes"], nodes)
        assert mode["speedBound"] <= 1e-14


def same_shapes(found: dict[str, Any], system: Any, speed: float, gravity: float) -> None:
    expected = rc.steady_shapes(system, angular_speed=speed, gravity=gravity)
    assert len(found["shapes"]) == len(expected)
    assert found["complete"] == expected.complete
    for mine, shape in zip(found["shapes"], expected, strict=True):
        close(mine["inclination"], shape.inclination)
        close(mine["offset"], shape.offset)
        close(mine["height"], shape.height)
        assert mine["halfWaves"] == shape.half_waves
        if mine["verdict"] is not None:
            judged = shape.stability()
            assert mine["verdict"] == judged.verdict


@pytest.mark.parametrize("query", ENGINES)
@pytest.mark.parametrize("name", web_page.PRESETS)
def test_numbers_of_a_preset_are_those_of_the_library(open_page, name, query):
    found = settled(open_page(f"x={name}", query))
    assert found["problem"] == ""
    assert found["fast"] == (query == "")
    scene = rc.load_scene(ROOT / f"examples/scenes/{name}.toml")
    gravity = scene.gravity_value()
    same_modes(found["modes"], scene.system(), gravity)
    same_shapes(found["shapes"], scene.system(), found["state"]["speed"], gravity)


@pytest.mark.parametrize("name", web_page.PRESETS)
def test_what_an_example_says_can_be_tried(open_page, name):
    """Each thing to try shows what it says: so many shapes, or the mode or the shape."""
    page = open_page(f"x={name}")
    settled(page)
    for part in re.split(r"\{[\d.]+\}", web_page.STORIES[name]["says"]):  # speeds are in the unit of the page
        assert part in page.text_content("#says")
    for nth, one in enumerate(web_page.STORIES[name]["tries"]):
        page.locator("#tries button").nth(nth).click()
        found = settled(page)
        assert found["state"]["name"] == name and found["problem"] == ""
        if "speed" in one:
            assert found["state"]["speed"] == one["speed"]
            assert len(found["shapes"]["shapes"]) == one["shapes"]
        if "select" in one:
            assert found["state"]["select"] == one["select"]
            kind, number = one["select"][0], int(one["select"][1:])
            assert len(found["modes" if kind == "m" else "shapes"]["modes" if kind == "m" else "shapes"]) >= number


@pytest.mark.parametrize("name", web_page.PRESETS)
def test_the_program_and_the_scene_are_the_same_chain(open_page, name, tmp_path):
    page = open_page(f"x={name}")
    found = settled(page)
    names: dict[str, Any] = {}
    exec(page.evaluate("copied('python')"), names)  # prints, too
    (tmp_path / "copied.toml").write_text(page.evaluate("copied('scene')"), encoding="utf-8")
    scene = rc.load_scene(tmp_path / "copied.toml")
    for system in (names["system"], scene.system()):
        same_modes(found["modes"], system, scene.gravity_value())


def test_speeds_in_another_unit(open_page):
    page = open_page("x=two_weights")
    before = settled(page)
    page.select_option("#speed-slider select", "Hz")
    page.wait_for_function("document.getElementById('mode-list').textContent.includes('0.5395 Hz')")
    assert page.locator("#speed-slider .number").input_value() == f"{before['state']['speed'] / (2 * np.pi):.4g}"
    page.locator("#speed-slider .number").fill("1")
    page.locator("#speed-slider .number").press("Enter")
    assert settled(page)["state"]["speed"] == pytest.approx(2 * np.pi)
    page.wait_for_function("location.hash.includes('u=Hz')")


def test_the_page_proves_what_the_library_proves(open_page):
    """Massless threads, which the proof for rigs does not cover."""
    for name in ("two_weights", "stick_on_string", "rods_on_threads", "bernoulli_chain"):
        assert settled(open_page(f"x={name}"))["diagram"]["complete"], name


def test_every_branch_is_that_of_the_library(open_page):
    found = settled(open_page("p=4_0.1_0.25_point&n=14"))
    expected = rc.branches(rc.Chain(mass=[0.1] * 4, length=0.25), max_angular_speed=found["top"])
    assert found["diagram"]["complete"] and expected.complete
    assert len(found["diagram"]["branches"]) == len(expected) > 4
    for mine, branch in zip(found["diagram"]["branches"], expected, strict=True):
        close(mine["speed"], branch.angular_speed)
        close(mine["tip"], branch.tip_radius)
        assert mine["halfWaves"] == np.asarray(branch.half_waves).tolist()


def test_a_link_holds_the_whole_state(open_page):
    page = open_page("x=chair_o_plane&n=1.5")
    before = settled(page)
    page.evaluate(
        "for (const id of ['arm', 'part0-mass']) { const s = document.getElementById(id); s.value = 300; s.oninput(); }"
    )
    changed = settled(page)
    assert changed["state"]["radius"] != before["state"]["radius"]
    page.wait_for_function(
        "decodeURIComponent(location.hash).includes('r=' + document.querySelector('#arm').parentNode.querySelector('.number').value)"
    )
    again = settled(open_page(page.url.split("#")[1]))
    assert again["state"] == changed["state"]
    assert again["shapes"]["shapes"] == changed["shapes"]["shapes"]


def test_a_link_that_is_wrong_is_refused_in_words(open_page):
    page = open_page("p=3_x_1_point")
    assert settled(page)["modes"]["modes"]  # of an example; what is wrong stays in sight
    page.wait_for_selector("#problem:not([hidden])")
    assert 'The link gives mass as "x"' in page.text_content("#problem")
    page = open_page("p=3_1_-2_rod")
    assert 'The link gives length as "-2"' in settled(page)["problem"]
    page.select_option("#preset", "two_weights")
    assert settled(page)["problem"] == ""
    page = open_page("p=3_0_1_rod")  # which the library refuses
    assert "the lowest link must have weight" in settled(page)["problem"]
    page.wait_for_selector("#problem:not([hidden])")
    page.select_option("#preset", "two_weights")  # and the page goes on
    assert settled(page)["problem"] == ""


def test_dragging_the_slider_follows_with_every_question(open_page):
    page = open_page("p=8_0.1_0.125_point")
    first = settled(page)
    page.evaluate("speed.value = 900; speed.oninput()")
    found = settled(page)
    assert found["state"]["speed"] == pytest.approx(0.9 * found["top"], rel=1e-3)  # in four digits
    assert len(found["shapes"]["shapes"]) > len(first["shapes"]["shapes"])
    same_shapes(found["shapes"], rc.Chain(mass=[0.1] * 8, length=0.125), found["state"]["speed"], 9.80665)


def test_the_picture_turns_and_pauses(open_page):
    """The stage of the package's pages draws the chain; keys and playback change what is seen."""
    page = open_page("x=swing_carousel")
    settled(page)
    view = page.locator("#view canvas")
    turning = {view.screenshot() for _ in range(3)}
    assert len(turning) > 1
    page.click("#play")
    page.wait_for_timeout(200)
    still = view.screenshot()
    page.wait_for_timeout(200)
    assert view.screenshot() == still
    page.focus("#view canvas")
    page.keyboard.press("ArrowLeft")
    page.wait_for_timeout(200)
    assert view.screenshot() != still
    page.click("#more > summary")
    page.click("#reset")
    page.wait_for_timeout(200)
    page.locator("#pace").fill("-1")
    page.wait_for_function("document.getElementById('scale').textContent.endsWith('times slower than real time')")
    assert page.text_content("#playback") == "×0.1"


def test_keys_and_touch(open_page):
    page = open_page("p=2_1_1_rod&n=6", has_touch=True, viewport={"width": 390, "height": 844})
    before = settled(page)["state"]
    page.focus("#diagram")
    page.keyboard.press("ArrowRight")
    assert settled(page)["state"]["speed"] > before["speed"]
    page.locator("#mode-list .card").nth(1).tap()
    assert settled(page)["state"]["select"] == "m2"
    page.focus("#diagram")
    page.keyboard.press("ArrowLeft")  # a speed shows shapes again
    found = settled(page)
    assert found["state"]["select"] == "s1"
    assert found["state"]["speed"] == pytest.approx(before["speed"], rel=1e-3)  # in four digits
    assert page.evaluate("document.documentElement.scrollWidth") <= 390  # nothing sticks out on a telephone


def test_a_mode_shows_its_speed_and_the_slider_goes_back_to_shapes(open_page):
    page = open_page("x=plucked_chain")
    first = settled(page)
    number = page.locator("#speed-slider .number")
    page.locator("#mode-list .card").nth(1).click()
    speed = first["modes"]["modes"][1]["speed"]
    page.wait_for_function("document.querySelector('#speed-slider .number').value === '103.1'")
    assert float(page.locator("#speed").input_value()) == pytest.approx(1000 * speed / first["top"], abs=0.01)
    assert settled(page)["state"]["speed"] == first["state"]["speed"]
    page.evaluate("speed.value = 300; speed.oninput()")
    found = settled(page)
    assert found["state"]["select"] == "s1"
    assert float(number.input_value()) == pytest.approx(found["state"]["speed"] * 30 / np.pi, rel=1e-4)


def test_a_rebuilt_list_keeps_the_focus(open_page):
    page = open_page("x=two_weights")
    settled(page)
    focused = "document.activeElement.textContent || document.activeElement.id"
    page.locator("#tries button").nth(1).focus()
    page.keyboard.press("Enter")
    settled(page)
    assert page.evaluate(focused) == "Turn fast enough for a second shape"
    page.click("#more > summary")
    page.click("#sliders summary")
    page.click("#spring")
    assert page.evaluate(focused) == "spring"


def test_reduced_motion_starts_in_the_plane_of_the_picture(open_page):
    page = open_page("x=swing_carousel", reduced_motion="reduce")
    settled(page)
    page.wait_for_timeout(200)
    assert page.text_content("#play") == "Play"
    still = page.locator("#view canvas").screenshot()
    page.wait_for_timeout(200)
    assert page.locator("#view canvas").screenshot() == still
    assert settled(page)["angle"] == 0
    page.click("#play")
    assert page.text_content("#play") == "Pause"


def test_the_menu_closes(open_page):
    page = open_page("x=two_weights")
    settled(page)
    menu = page.locator("#copy")
    for close in ("Escape", "Shift+Tab", "click", "copy"):
        page.focus("#copy > summary")
        page.keyboard.press("Enter")
        assert menu.get_attribute("open") is not None
        if close == "click":
            page.click("h1")
        elif close == "copy":
            page.once("dialog", lambda dialog: dialog.dismiss())  # if the clipboard is not allowed
            page.click("[data-copy=scene]")
        else:
            page.keyboard.press("Tab" if close == "Escape" else close)
            page.keyboard.press(close)
        page.wait_for_function("!document.getElementById('copy').open")
        if close in ("Escape", "copy"):
            assert page.evaluate("document.activeElement.textContent") == "Copy as …"


def test_the_list_has_every_example(open_page):
    page = open_page()
    options = page.locator("#preset optgroup option").evaluate_all("all => all.map((each) => each.value)")
    assert sorted(options) == sorted(web_page.PRESETS)


@pytest.mark.parametrize("size", [(390, 844), (320, 520), (640, 400)])
def test_the_picture_does_not_hide_what_has_the_focus(open_page, size):
    page = open_page("x=chair_o_plane", has_touch=True, is_mobile=True, viewport={"width": size[0], "height": size[1]})
    settled(page)
    page.click("#more > summary")
    assert page.evaluate("document.documentElement.scrollWidth") <= size[0]
    page.focus("#add")
    for _ in range(20):
        page.keyboard.press("Shift+Tab")
        seen = page.evaluate("""() => {
            const {top, bottom} = document.activeElement.getBoundingClientRect();
            const picture = document.getElementById('picture').getBoundingClientRect();
            return top >= Math.max(0, picture.bottom) - 1 && bottom <= innerHeight + 1;
        }""")
        assert seen, page.evaluate("document.activeElement.outerHTML")
