# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: what it prints, what it writes, how it ends."""

import base64
import csv
import itertools
import json
import os
import pty
import re
import shlex
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest

import revchain as rc
from revchain import _core
from revchain.cli import app as _cli
from revchain.cli import ask as _ask
from revchain.cli import report as _report
from revchain.cli import sweep as _cli_sweep
from revchain.cli import MEANING, ExitCode
from revchain.cli.frame import USE
from revchain.scenes import answer as _answer
from revchain.scenes.scene import json_schema

WATCH = """
title = "Watch chain"
[uniform_chain]
kind = "rods"
count = 120
length = 0.36
mass = 0.03
[ask.modes]
count = 4
"""
SLOW = """
[uniform_chain]
kind = "rods"
count = 400_000
length = 1
mass = 1
[ask.modes]
count = 100
method = "bisection"
"""
SWINGING = """
title = "Swinging nuts"
[[links]]
mass = 0.5
length = 0.5
repeat = 2
[ask.shapes]
conical_height = 0.05
[ask.response]
angular_speed = {from = 1, to = 12, steps = 5}
[ask.swing]
offset = [0.02, 0]
"""
STUDY = """
scene = "swinging.toml"
find = ["modes"]
[vary."links[0].mass"]
values = [1, 2]
"""
ARM = "[support]\nradius = 2\n[[links]]\nmass = 1\nlength = 1\nair_drag = {coefficient = 1, area = 1}\n"
RIGGED = "[[links]]\nmass = 1\nlength = 1\ndrag = 2\n"
OF_THE_FIXTURE = {"watch.toml": WATCH, "swinging.toml": SWINGING, "study.toml": STUDY, "arm.toml": ARM, "rigged.toml": RIGGED}
SCENES = Path(__file__).resolve().parents[2] / "examples" / "scenes"


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    for name, text in OF_THE_FIXTURE.items():
        Path(name).write_text(text)


def files_in(folder):
    return sorted(path.name for path in folder.iterdir())


def files():
    """Names of the files that a command has written."""
    return sorted(set(files_in(Path())) - set(OF_THE_FIXTURE))


def test_the_table(run):
    code, out, err = run("modes", "watch.toml")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[:2] == ["Watch chain", "support: firm; 120 times rod, 0.00025 kg, 0.003 m"]
    assert " ".join(lines[2:4]).replace("  ", " ").startswith("4 of 120 modes of a chain of 120 links")
    assert lines[-1] == "gravity 9.80665 m/s^2; error bound: relative, of the conical height"
    assert all(unit in out for unit in ("(rad/s)", "(rpm)", "(s)", "error", "bound", "(m from", "the free", "end)"))
    (second,) = (line.split() for line in lines if line.strip().startswith("2 "))
    assert second == ["2", "14.4064", "137.571", "0.436139", "0.0472508729", "1.1e-16", "1:", "0.0683"]
    assert max(map(len, lines)) <= 80 and "…\n" not in out
    assert files() == []


def test_a_narrow_terminal_cuts_no_number(run, monkeypatch):
    monkeypatch.setenv("COLUMNS", "30")
    assert "0.0472508729 " in run("modes", "watch.toml")[1]


def test_many_modes(run):
    code, out, _ = run("modes", "watch.toml", "--count", 100)
    assert code == 0
    assert "and 80 more" in out and len(out.splitlines()) < 35


def test_json(run):
    code, out, err = run("modes", "watch.toml", "--json", "-")
    assert (code, err) == (0, "")
    data = json.loads(out)
    assert data["title"] == "Watch chain" and data["status"] == "success" and data["gravity"] == 9.80665
    result = rc.load_scene("watch.toml").modes()
    for k, mode in enumerate(data["modes"]):
        assert list(mode)[:5] == ["mode", "direction", "angular_speed", "frequency", "rpm"] and "shape" not in mode
        assert mode["mode"] == k + 1
        assert mode["conical_height"] == result.conical_height[k]
        assert mode["angular_speed"] == result.angular_speed[k]
        assert mode["error_bound"] == result.error_bound[k]
        assert mode["nodes"] == result.nodes[k].tolist()
    assert run("modes", "watch.toml", "--json", "a.json", "--quiet")[1] == ""
    assert json.loads(Path("a.json").read_text()) == data


def test_csv(run):
    code, out, _ = run("modes", "watch.toml", "--csv", "-")
    assert code == 0
    rows = list(csv.DictReader(out.splitlines()))
    result = rc.load_scene("watch.toml").modes()
    assert [float(row["conical_height"]) for row in rows] == result.conical_height.tolist()
    assert [[float(node) for node in row["nodes"].split()] for row in rows] == [list(nodes) for nodes in result.nodes]
    assert [len(nodes) for nodes in result.nodes] == [0, 1, 2, 3] and "shape" not in rows[0]


@pytest.mark.parametrize("name", ["a.png", "a.svg", "a.pdf", "A.PNG"])
def test_plot(run, name):
    code, out, _ = run("modes", "watch.toml", "--plot", name)
    assert code == 0 and f"wrote {name}" in out
    start = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[name[-3:].lower()]
    assert Path(name).read_bytes().startswith(start)
    assert files() == [name]


def test_all_that_a_scene_asks(run):
    code, out, _ = run("run", "swinging.toml", "--out", "results/here")
    assert code == 0 and out.count("Swinging nuts") == 1
    folder, kinds = Path("results/here"), (".csv", ".json", ".png", ".txt")
    assert files_in(folder) == sorted(f"{question}{kind}" for question in ("shapes", "response", "swing") for kind in kinds)
    for question in ("shapes", "response", "swing"):
        text = (folder / f"{question}.txt").read_text()
        assert text.startswith("Swinging nuts\nsupport: firm; 2 times 0.5 kg on 0.5 m\n")
        assert all(line.rstrip() in text for line in out.splitlines()[2:] if question == "shapes" and "(rad)" in line)
    before = files_in(folder)
    assert run("run", "swinging.toml", "--out", "results/here", "--quiet") == (0, "", "") and files_in(folder) == before
    code, out, _ = run("run", "watch.toml", "--gravity", "1.62")
    assert code == 0 and "gravity 1.62 m/s^2" in out and files_in(Path("out/watch")) == ["modes" + kind for kind in kinds]


def test_what_cannot_be_answered_does_not_stop_the_rest(run):
    Path("a.toml").write_text(WATCH.replace("count = 4", "method = 'dense'") + "[ask.branches]\nmax_angular_speed = 3\n[support]\nradius = 1\n")
    Path("b.toml").write_text("[[links]]\nmass = 1\nlength = 1\n[support]\nradius = 1\n[ask.swing]\noffset = [0.1]\n[ask.response]\nangular_speed = 1\n")
    assert run("run", "a.toml")[0] == ExitCode.SCENE_INVALID
    code, out, err = run("run", "b.toml")
    assert code == ExitCode.WRONG_USAGE and "carried round" in out
    assert "b.toml: line 5, column 1: support.radius: the support is carried round: it does not let the rig swing" in err and files_in(Path("out/b")) == ["response" + k for k in (".csv", ".json", ".png", ".txt")]


def test_a_scene_alone_means_run(run):
    asked = run("run", "watch.toml", "--out", "one", "--units", "rad")
    assert run("watch.toml", "--out", "one", "--units", "rad") == asked and asked[0] == 0 and files_in(Path("one"))
    Path("modes").write_text(WATCH)  # the name of a command means that command
    ends_in_one_sentence(run("modes"), ExitCode.WRONG_USAGE, "missing argument 'SCENE'")
    Path("a scene").write_text(WATCH)  # a file of any name
    assert run("a scene", "-q") == (0, "", "")
    Path("UP.TOML").write_text(WATCH)
    Path("a.json").write_text('{"links": [{"mass": 1, "length": 1}]}')
    assert run("UP.TOML", "-q")[0] == run("a.json", "-q")[0] == run("./watch.toml", "-q")[0] == 0
    ends_in_one_sentence(run("missing.toml"), ExitCode.SCENE_INVALID, "missing.toml: cannot be read: No such file or directory")
    ends_in_one_sentence(run("study.toml"), ExitCode.SCENE_INVALID, "is of a study, not of a scene: revchain sweep study.toml")
    ends_in_one_sentence(run("watch.toml", "--count", 3), ExitCode.WRONG_USAGE, "no such option: --count")
    assert run("watch.toml", "--count", 3)[2].endswith("; see revchain run --help\n")
    ends_in_one_sentence(run("x"), ExitCode.WRONG_USAGE, "no such command 'x'; see revchain --help")
    ends_in_one_sentence(run("modse"), ExitCode.WRONG_USAGE, "no such command 'modse'. Did you mean 'modes'?; see revchain --help")


def test_completion_knows_the_options_of_run_after_a_scene(python):
    for words, there in (("revchain watch.toml --", "--out"), ("revchain mod", "modes"), ("revchain swing watch.toml --", "--offset")):
        asked = {"_REVCHAIN_COMPLETE": "complete_bash", "COMP_WORDS": words, "COMP_CWORD": str(words.count(" "))}
        assert there in python("-m", "revchain", env={**os.environ, **asked}).stdout.split()


ONE = "[[links]]\nmass = 1\nlength = 1\n"
FEWER = {  # scenes with a number of modes that is larger than there are, and what is said
    "a chain": (ONE, ["--count", 5], "5 modes are asked for: there is only 1", 1),
    "some of a chain": (WATCH, ["--count", 9, "--first", 118], "9 modes are asked for: there are only 3 from number 118 on", 3),
    "a rig": (ONE + "[support]\nstiffness = 10\n", ["--count", 5], "5 modes are asked for: there is only 1", 1),
    "both directions": (ONE + "flywheel = {mass = 1, radius_of_gyration = 0.1, spin = 9}\n", ["--count", 2], "there is only 1", 2),
    "a dashpot": (ONE + "[support]\nstiffness = 10\nmass = 1\ndamping = 1\n", ["--count", 5], "there are only 2", 2),
    "held": (ONE + "repeat = 3\n[held]\ntension = 90\n", ["--count", 5], "5 modes are asked for: there are only 2", 2),
}


@pytest.mark.parametrize(("text", "options", "remark", "rows"), FEWER.values(), ids=FEWER.keys())
def test_more_modes_than_there_are(run, text, options, remark, rows):
    """The command and the scene answer with all there are; the table has a remark. Python keeps its error."""
    Path("a.toml").write_text(text)
    code, out, err = run("modes", "a.toml", *options)
    assert (code, err) == (0, "") and remark in out
    assert len(json.loads(run("modes", "a.toml", *options, "--json", "-")[1])["modes"]) == rows
    if "--first" not in options:
        Path("a.toml").write_text(f"{text}[ask.modes]\ncount = {options[1]}\n")
        assert run("validate", "a.toml")[0] == 0
        code, out, err = run("run", "a.toml")
        assert (code, err) == (0, "") and remark in out and remark in Path("out/a/modes.txt").read_text()
        assert len(rc.load_scene("a.toml").modes()) == rows
    assert "are asked for" not in run("modes", "a.toml", "--count", "1")[1] + run("modes", "a.toml", "--count", "all")[1]


def test_more_modes_than_there_are_in_python_are_refused():
    with pytest.raises(ValueError, match="count must not exceed the 1 modes of this chain, got 5"):
        rc.modes(rc.Chain(mass=1.0, length=1.0), 5)


def test_options_go_before_the_scene(run):
    code, out, _ = run("modes", "watch.toml", "--count", 2, "--method", "dense", "--rtol", "1e-6", "--json", "-")
    data = json.loads(out)
    assert code == 0 and len(data["modes"]) == 2 and data["method"] == "dense"


def test_a_tolerance_that_is_not_met(run):
    code, out, err = run("modes", "watch.toml", "--rtol", "1e-30", "--json", "a.json")
    assert code == ExitCode.TOLERANCE_NOT_MET == 1
    assert "tolerance not met" in out
    assert err == "revchain: watch.toml: the tolerance is not met: asked 1e-30, reached 1.3e-26\n"
    assert json.loads(Path("a.json").read_text())["status"] == "tolerance_not_met"


OF_SCENES = ("run", "modes", "explain", "shapes", "response", "swing", "branches")


def ends_in_one_sentence(done, code, words):
    assert done[0] == code and done[1] == "" and done[2].count("\n") == done[2].count("revchain: ") == 1
    assert done[2].startswith("revchain: ") and words in done[2]


ENDINGS = (".gif", ".mp4", ".html", ".glb")


@pytest.mark.parametrize("ending", ENDINGS)
def test_animate(run, ending):
    for package in {".gif": ["PIL"], ".mp4": ["imageio_ffmpeg"]}.get(ending, []):
        pytest.importorskip(package)
    code, out, err = run("animate", "watch.toml", "-o", f"film{ending}", "--duration", 0.2)
    assert (code, out, err) == (0, f"wrote film{ending}\n", "")
    whole = Path(f"film{ending}").read_bytes()
    assert len(whole) > 3000
    code, out, err = run("animate", "watch.toml", "-o", f"film{ending}", "--duration", 0.2, "--figures", "2; 1", "--quiet")
    assert (code, out, err) == (0, "", "") and Path(f"film{ending}").read_bytes() != whole
    assert files() == [f"film{ending}"]


def solid_in(page):
    """The 3D model in a page: its text."""
    [data] = re.findall(r'<script type="text/plain" id="solid">([^<]*)</script>', Path(page).read_text("utf-8"))
    return base64.b64decode(data).decode("utf-8", "replace")


@pytest.mark.parametrize("question", ["shapes", "response", "swing"])
def test_animate_shows_what_is_asked(run, question):
    code, _, err = run("animate", "swinging.toml", "-o", f"{question}.html", "--ask", question, "--gravity", "1.62 m/s^2")
    assert (code, err) == (0, "")
    assert '"gravity":1.62' in solid_in(f"{question}.html")
    assert {"shapes": "half wave", "response": "carried round", "swing": "Time: 0.000 s"}[question] in solid_in(f"{question}.html")
    code, _, err = run("animate", "swinging.toml", "-o", "first.html", "--gravity", "1.62")
    assert code == 0 and "half wave" in solid_in("first.html")  # the first that the scene asks


def test_animate_of_scenes_that_cannot_be_shown(run):
    code, out, err = run("animate", SCENES / "troposkien.toml", "-o", "a.html", "--ask", "modes")
    assert code == 2 and "a chain or cord whose ends are held a span apart; ask for its shapes" in err and out == ""
    Path("few.toml").write_text(SWINGING.replace("conical_height = 0.05", "conical_height = 5.0"))
    ends_in_one_sentence(run("animate", "few.toml", "-o", "a.html"), 2, "few.toml: shapes: there is no shape to draw")
    assert files() == ["few.toml"]


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("missing.toml", None, "missing.toml: cannot be read: No such file or directory"),
        ("watch.toml/missing.toml", None, "watch.toml/missing.toml: cannot be read: Not a directory"),
        (".", None, ".: cannot be read: Is a directory"),
        ("a.toml", "not toml", "a.toml: line 1, column 5: "),
        ("a.json", '{"links": [', "a.json: line 1, column 12: "),
        ("a.json", "[1, 2]", "must be a table, got [1, 2]"),
        ("a.toml", b"\x89PNG\xff", "a.toml: is not UTF-8 text (byte 1)"),
    ],
)
@pytest.mark.parametrize("command", [*OF_SCENES, "validate", "sweep"])
def test_files_that_cannot_be_read(run, command, name, text, words):
    if text is not None:
        Path(name).write_bytes(text if isinstance(text, bytes) else text.encode())
    ends_in_one_sentence(run(command, name), ExitCode.SCENE_INVALID, words)


@pytest.mark.parametrize("command", [*OF_SCENES, "validate", "sweep", "new", "schema"])
def test_command_lines_that_cannot_be_read(run, command):
    see = f"see revchain {command} --help"
    ends_in_one_sentence(run(command, "watch.toml", "--colour"), ExitCode.WRONG_USAGE, "no such option: --colour")
    ends_in_one_sentence(run(command, "watch.toml", "--colour"), ExitCode.WRONG_USAGE, see)
    if command not in ("new", "schema"):
        ends_in_one_sentence(run(command), ExitCode.WRONG_USAGE, "missing argument")
    if command != "validate":
        ends_in_one_sentence(run(command, "watch.toml", "b", "c"), ExitCode.WRONG_USAGE, "unexpected extra argument")


REFUSED = {  # command lines that end in one sentence without an answer
    "modes watch.toml --count 0": "--count: must be at least 1, got 0",
    "modes watch.toml --count many": '--count: must be a whole number or all, got "many"',
    "modes watch.toml --first 121": "--first: must be at most 120, got 121",
    "modes watch.toml --count 3 --angular-speed '1 to 2'": "--angular-speed: does not go with --count",
    "modes watch.toml --conical-height '2 to 1'": "--conical-height: its low end must lie below its high end, got 2 to 1",
    "modes watch.toml --conical-height '-1 to 1'": "--conical-height: LOW must not be negative, got -1",
    "modes watch.toml --angular-speed 'nan to 1'": "--angular-speed: LOW must not be negative, got nan",
    "modes watch.toml --angular-speed '30 kg'": "--angular-speed: HIGH must be an angular speed such as",
    "modes watch.toml --rtol much": "--rtol: must be a number, or a number and its unit",
    "modes watch.toml --rtol -1": "--rtol: must not be negative, got -1",
    "modes watch.toml --rtol nan": "--rtol: must not be negative, got nan",
    "modes watch.toml --method qr": "bisection, condensed, aberth, interpolated, dense, recurrence",
    "modes watch.toml --precision single": '--precision: must be one of double, extended, double-double, got "single"',
    "modes watch.toml --precision extended --method dense": '--precision: --method "dense" goes with "double" only',
    "modes watch.toml --plot a.jpg": "--plot: a.jpg must end in .png, .svg, .pdf",
    "modes watch.toml --json - --csv -": "cannot share stdout",
    "modes watch.toml --json a.txt --csv a.txt": "--json and --csv: two outputs have the same name",
    "modes watch.toml --json watch.toml": "--json: watch.toml: the scene itself would be overwritten",
    "shapes swinging.toml --angular-speed 1 --conical-height 1": "give --angular-speed or --conical-height, not both",
    "shapes swinging.toml --angular-speed '3 kg'": '--angular-speed: must be an angular speed such as "30 rpm", got "3 kg"',
    "shapes swinging.toml --angular-speed '2,5 rpm'": 'the decimal mark is a point: write "2.5 rpm"',
    "shapes swinging.toml --direction 3": "--direction: must be one of 1, -1, got 3",
    "shapes swinging.toml --max-half-waves 2": "--max-half-waves: is for a chain held at both ends, got 2",
    "shapes swinging.toml --gravity -1": "--gravity: must be positive, got -1",
    "shapes swinging.toml --units turns": "--units: must be deg or rad, the unit of angles, got turns",
    "response swinging.toml --angular-speed 1,5": '--angular-speed: a list has semicolons, such as "1; 2", and the decimal',
    "response swinging.toml --angular-speed '-1 to 2'": "--angular-speed: FROM must be positive, got -1",
    "response swinging.toml --angular-speed '1 to 2 rpm in 2.5'": 'such as "30 rpm", got "2 rpm in 2.5"',
    "response swinging.toml --angular-speed '1 to 2 in 0'": "--angular-speed: N must be at least 1, got 0",
    "explain watch.toml --rtol -1": "--rtol: must not be negative, got -1",
    "swing watch.toml": "watch.toml: give --offset, --velocity or --support-time: nothing would move",
    "swing swinging.toml --offset '1; x'": '--offset: item 2 must be a number, or a number and its unit such as "39.1396 inch", got "x"',
    "swing swinging.toml --velocity '1; 2; 3'": "--velocity: must have a number for each of the 2 pins that move, free end first, got 3",
    "swing swinging.toml --time 'nan'": "--time: must be finite, got nan",
    "swing swinging.toml --time '0 to 5 kg'": '--time: TO must be a time such as "2 min", got "5 kg"',
    "swing swinging.toml --count 0": "--count: must be at least 1, got 0",
    "swing swinging.toml --count 3": "--count: must be from 0 to 2, got 3",
    "swing swinging.toml --support-velocity '1; 0'": "--support-velocity: needs --support-time beside it, the time of each",
    "swing swinging.toml --support-time '0; 1'": "--support-time: needs one of --support-velocity, --support-acceleration, --support-offset and --support-force",
    "swing swinging.toml --support-time '0; 1' --support-velocity 1": "--support-velocity: must have as many values as --support-time, two or more, got 1 beside 2",
    "swing swinging.toml --support-time '1; 0' --support-velocity '1; 1'": "--support-time: must ascend, got 0",
    "swing swinging.toml --support-time '0; 1' --support-velocity '1; 1' --support-force '1; 1'": "--support-force: does not go with --support-velocity",
    "swing swinging.toml --support-time '0; 1' --support-force '1; 1'": "--support-force: needs a support that yields",
    "response swinging.toml --force 3 --angular-speed 1": "--force: needs a support that yields",
    "response swinging.toml --force 3 --acceleration 3 --angular-speed 1": "--force: does not go with --acceleration",
    "response watch.toml": "watch.toml: give --angular-speed or --conical-height: at which speed",
    "branches watch.toml": "watch.toml: give --max-angular-speed or --min-conical-height: at which speed",
    "campbell watch.toml": '--angular-speed: is missing: write --angular-speed "1 rpm to 20 rpm in 39"',
    "campbell watch.toml --angular-speed '2 to 1 in 3'": "--angular-speed: must be two or more ascending speeds, got 2 to 1",
    "campbell watch.toml --angular-speed '1 to 2 in 3' --orders '1; 0'": "--orders: item 2 must be at least 1, got 0",
    "campbell watch.toml --angular-speed '1 to 2 in 3'": "watch.toml: at none of the speeds, 1 to 2 rad/s, is there a shape",
    "modes watch.toml --angular-speed '1 to 2 to 3'": '--angular-speed: must be "LOW to HIGH", got 1 to 2 to 3',
    "shapes watch.toml --angular-speed '1 rpm to 3 rpm'": '--angular-speed: must be a number, or a number and its unit such as "30 rpm", got "1 rpm',
    "response swinging.toml --angular-speed 3 --support-radius '1 to inf'": '--support-radius: must be one number, not a range, got "1 to inf"',
    "shapes watch.toml --angular-speed 1e200": "--angular-speed: must be from 1e-100 to 1e+100 in size, in SI units, got 1e+200",
    "drag arm.toml": '--angular-speed: is missing: write --angular-speed "12 rpm"',
    "drag arm.toml --angular-speed 0": "--angular-speed: must not be 0",
    "drag arm.toml --angular-speed 3 --half-waves 4": "--half-waves: there is no shape without drag with this number of half waves",
    "shapes rigged.toml --angular-speed 3": "rigged.toml: line 4, column 1: links[0].drag: steady shapes cannot be found for a rig with linear drag",
    "run study.toml": "is of a study, not of a scene: revchain sweep study.toml",
    "sweep swinging.toml": "is of a scene, not of a study: revchain run swinging.toml",
    "sweep study.toml --chunk 0": "'--chunk'",
    "sweep study.toml --out a.txt": "--out: a.txt must end in .csv, .parquet, .xlsx or .nc",
    "sweep study.toml --out study.toml": "--out: study.toml: the study itself would be overwritten",
    "campbell watch.toml --angular-speed '1 to 15 rpm in 29'": '--angular-speed: only the last number has a unit: write "1 rpm to 15 rpm", got 1 to 15 rpm',
    "modes watch.toml --angular-speed '20 to 6e1 rpm'": '--angular-speed: only the last number has a unit: write "20 rpm to 6e1 rpm", got 20 to 6e1 rpm',
    "swing swinging.toml --offset '1; 2 cm'": '--offset: only the last number has a unit: write "1 cm; 2 cm", got 1; 2 cm',
    "shapes swinging.toml --rpm 60": 'no such option: --rpm; write --angular-speed "60 rpm", or "1 Hz"; see revchain shapes --help',
    "branches swinging.toml --speed 6": "the unit of speeds in tables, got 6; give a speed by --angular-speed or --max-angular",
    "modes watch.toml --tip-mass 3": "--tip-mass; tip_mass is a key of the scene: change it there; see revchain modes --help",
    "swing watch.toml --period 3": "no such option: --period",
    "frobnicate": "no such command 'frobnicate'; see revchain --help",
    "--colour": "no such option: --colour; see revchain --help",
    "animate watch.toml -o film.avi": "--out: film.avi must end in .gif, .mp4, .html, .glb",
    "animate watch.toml": "missing option '--out' / '-o'; see revchain animate --help",
    "animate watch.toml -o a.html --ask tune": "--ask: must be one of modes, shapes, response, swing, branches, got tune",
    "animate watch.toml -o a.html --ask shapes": "watch.toml: ask.shapes: give angular_speed or conical_height",
    "animate watch.toml -o a.html --figures '1, 2'": '--figures: must be whole numbers with semicolons between them, such',
    "animate watch.toml -o a.html --figures 9": "watch.toml: --figures: mode must be from 1 to 4, got 9",
    "animate watch.toml -o a.html --duration 0": "--duration: must be positive and finite, got 0",
    "animate watch.toml -o a.html --time-scale -1": "--time-scale: must be positive and finite, got -1",
    "animate watch.toml -o a.glb --frames-per-second 9": "--frames-per-second: a .glb file has no frames; leave it out",
    "animate watch.toml -o a.gif --duration 1e6": "watch.toml: --duration times --frames-per-second must be at most 20000",
    "animate watch.toml -o a.html --gravity -1": "--gravity: must be positive",
    "animate watch.toml -o missing/a.html": "missing/a.html: cannot be written: No such file or directory",
    "animate missing.toml -o a.html": "missing.toml: cannot be read",
}


@pytest.mark.parametrize("line", REFUSED)
def test_command_lines_that_are_refused(run, line):
    words = REFUSED[line]
    in_a_scene = "is of a s" in words or "cannot be read" in words
    code = ExitCode.SCENE_INVALID if in_a_scene else ExitCode.OUTPUT_FAILED if "cannot be written" in words else ExitCode.WRONG_USAGE
    ends_in_one_sentence(run(*shlex.split(line)), code, words)
    assert files() == [] and all(Path(name).read_text() == text for name, text in OF_THE_FIXTURE.items())


UNWRITABLE = ["--json missing/a.json", "--csv watch.toml/a.csv", "--plot missing/a.png", "--plot /proc/a.png"]
UNWRITABLE += ["--json a.json --plot missing/a.png", "--json .", "--json /dev/full"]


@pytest.mark.parametrize("command", ["modes", "shapes", "response", "swing"])
@pytest.mark.parametrize("options", UNWRITABLE)
def test_outputs_that_cannot_be_written(run, command, options):
    done = run(command, "swinging.toml", *options.split())
    ends_in_one_sentence(done, ExitCode.OUTPUT_FAILED, f"revchain: {options.split()[-1]}: cannot be written: ")
    assert files() == []


@pytest.mark.parametrize("place", ["watch.toml/a.csv", "/proc/a.csv", "/proc/a.nc"])
def test_results_of_studies_that_cannot_be_written(run, place):
    done = run("sweep", "study.toml", "--out", place)
    ends_in_one_sentence(done, ExitCode.OUTPUT_FAILED, place)
    assert files() == []


@pytest.mark.parametrize("place", ["watch.toml/a.png", "/proc/a.png"])
def test_a_picture_of_a_study_that_cannot_be_written_is_found_out_before_computing(run, monkeypatch, place):
    monkeypatch.setattr(_cli_sweep, "compute", lambda *_, **__: pytest.fail("computed"))
    done = run("sweep", "study.toml", "--plot", place)
    ends_in_one_sentence(done, ExitCode.OUTPUT_FAILED, f"revchain: {place}: cannot be written: ")
    done = run("sweep", "study.toml", "--plot", "a.png", "--out", "a.txt")
    ends_in_one_sentence(done, ExitCode.WRONG_USAGE, "a.txt must end in")
    assert files() == []


def test_a_picture_of_a_study_beside_its_results(run):
    assert run("sweep", "study.toml", "--out", "new/a.csv", "--plot", "new/a.png")[0] == 0
    assert sorted(path.name for path in Path("new").iterdir()) == ["a.csv", "a.png"]


def test_no_scene_and_no_command(run):
    assert run("solve")[0] == run("dissolve")[0] == ExitCode.WRONG_USAGE
    code, out, err = run()
    assert code == ExitCode.WRONG_USAGE and "Usage: revchain" in out + err and "modes" in out + err


@pytest.mark.parametrize("place", ["watch.toml", "/proc/results"])
def test_a_folder_that_cannot_be_made(run, place):
    code, out, err = run("run", "watch.toml", "--out", place)
    assert (code, out) == (ExitCode.OUTPUT_FAILED, "") and f"{place}: cannot be written: " in err


def test_it_is_found_out_before_solving(run, monkeypatch):
    monkeypatch.setattr(_ask, "watched", lambda *_: pytest.fail("solved"))
    assert run("modes", "watch.toml", "--json", "missing/a.json")[0] == ExitCode.OUTPUT_FAILED


def test_failure_in_the_middle_leaves_nothing_half_written(run, monkeypatch):
    Path("a.json").write_text("old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(_report, "as_csv", full)
    code, _, err = run("modes", "watch.toml", "--json", "a.json", "--csv", "a.csv")
    assert code == ExitCode.OUTPUT_FAILED and "No space left" in err
    assert Path("a.json").read_text() == "old" and files() == ["a.json"]


def test_memory(run, monkeypatch):
    def greedy(*_, **__):
        raise MemoryError

    monkeypatch.setitem(_answer.FUNCTIONS, "modes", greedy)
    code, _, err = run("modes", "watch.toml", "--json", "a.json")
    assert code == ExitCode.WRONG_USAGE and "memory" in err and files() == []


def test_validate(run):
    Path("bad.toml").write_text("[[links]]\nmass = 1\nlenght = 1\n")
    code, out, err = run("validate", "watch.toml", "bad.toml", "missing.toml")
    assert code == ExitCode.SCENE_INVALID
    assert out == "watch.toml: valid: support: firm; 120 times rod, 0.00025 kg, 0.003 m; asks modes\n"
    assert "bad.toml: line 3, column 1: links[0].lenght: unknown key; did you mean length?" in err and "missing.toml" in err
    assert run("validate", "watch.toml")[0] == 0


def test_new(run):
    code, out, _ = run("new")
    assert code == 0 and out == "wrote scene.toml; now: revchain scene.toml\n"
    text = Path("scene.toml").read_text()
    assert text.count("#") > 15 and "revchain THIS_FILE" in text.splitlines()[0]
    assert run("validate", "scene.toml")[0] == run("scene.toml")[0] == 0 and "bell" in Path("out/scene/modes.txt").read_text()
    Path("scene.toml").write_text("mine")
    code, _, err = run("new")
    assert code == ExitCode.OUTPUT_FAILED and "--force" in err and Path("scene.toml").read_text() == "mine"
    assert run("new", "scene.toml", "--force")[0] == 0 and Path("scene.toml").read_text() == text
    assert run("new", "-")[1] == text
    assert run("new", "missing/scene.toml")[0] == ExitCode.OUTPUT_FAILED
    ends_in_one_sentence(run("new", "a.json"), ExitCode.WRONG_USAGE, "a.json: a scene with comments is TOML: write revchain new a.toml")
    assert run("new", "crane") == (0, "wrote crane; now: revchain run crane\n", "") and run("crane", "-q") == (0, "", "")


def test_a_new_study_asks_nothing_and_is_computed_at_once(run):
    Path("study.toml").unlink()
    assert run("new", "--study") == (0, "wrote study.toml; now: revchain sweep study.toml\n", "")
    code, out, err = run("sweep", "study.toml")
    assert (code, err) == (0, "") and "wrote study.csv" in out and len(Path("study.csv").read_text().splitlines()) == 64


def test_what_the_new_scene_says_in_comments_is_right(run):
    """The other half, commented out, is a scene too."""
    run("new", "a.toml")
    _, _, rest = Path("a.toml").read_text().partition("# ---- other questions")[0].partition("# ---- ...")
    uncommented = [line.removeprefix("# ") for line in rest.splitlines()[2:] if not line.startswith("# ----")]
    Path("b.toml").write_text("\n".join(line for line in uncommented if line != "#").replace("first = 3", "first = 5"))
    read = rc.load_scene("b.toml")
    assert read.system() == rc.Chain.uniform_rods(120, 0.36, mass=0.03).with_body(mass=0.01)
    modes = read.ask.modes
    assert (modes.rtol, modes.first, modes.count, modes.certify, modes.method) == ("1 %", 5, 4, True, "bisection")


def test_what_the_new_scene_says_of_rigs_is_right(run):
    """What is commented out in the half that holds, put in."""
    run("new", "a.toml")
    text, mark, _ = Path("a.toml").read_text().partition("# ---- ... or")
    Path("b.toml").write_text(re.sub(r"^# (?=\w+ = |\[support\])", "", text.replace('# order = "support first"', ""), flags=re.MULTILINE))
    rig = rc.load_scene("b.toml").system()
    assert mark and (rig.support, rig.fluid) == (rc.Support(stiffness=200.0, mass=0.3, damping=3.0, radius=0.1), "turning")
    assert rig.pins.stiffness[-1] == 0.5 and rig.pins.damping[-1] == 0.02 and rig.drag[-1] == 0.1
    assert rig.inverted.tolist() == [False] * 4 + [True] and rig.has_momentum and rig.displaced.mass[-1] == 0.4
    assert rig.chain.mass[-1] == pytest.approx(2.1, rel=1e-15)  # with the weight at its pin
    assert "fluid: dashpots and a fluid that turns are not solved together" in run("modes", "b.toml")[2]
    Path("b.toml").write_text(re.sub(r"(?m)^(pin|drag|damping) = .*\n", "", Path("b.toml").read_text()))
    assert run("modes", "b.toml")[0] == 0


def test_what_the_new_scene_says_of_cords_governors_and_other_questions_is_right(run):
    run("new", "a.toml")
    text = Path("a.toml").read_text()
    body, _, rest = text.partition("# ---- other questions")
    cord = re.search(r"(## \[cord\]\n(?:## .*\n)+)", text)[1].replace("## ", "")
    Path("cord.toml").write_text(cord)
    assert rc.load_scene("cord.toml").system() == rc.Cord(0.36, mass=0.03, masses={0.1: 0.02})
    governor = re.sub(r"^# ?", "", rest[rest.index("# [governor]") :], flags=re.MULTILINE)
    Path("governor.toml").write_text(governor)
    assert run("governor.toml", "-q") == (0, "", "")
    asks = rest[: rest.index("## [ask.drag]")].replace("# orders", "orders")
    asks = re.sub(r"^# (?=\w+ = |\[ask)", "", asks.partition("\n")[2], flags=re.MULTILINE)
    Path("asks.toml").write_text(body + asks)
    read = rc.load_scene("asks.toml")
    assert read.asks == ("modes", "shapes", "response", "swing", "branches", "campbell") and len(read.system().length) == 5
    for question in read.asks:
        assert run(question, "asks.toml", "-q") == (0, "", ""), question


def test_schema(run):
    assert run("schema") == (0, json.dumps(json_schema(), indent=2) + "\n", "")


@pytest.mark.parametrize("name", USE)
def test_the_example_in_the_help_works(run, repository, name):
    """The example ends without an error. It writes the files that the help names, and no others."""
    Path("examples").symlink_to(repository / "examples")
    example, told = USE[name]
    before = set(files())
    program, *arguments = shlex.split(example)
    code, _, err = run(*arguments)
    assert (program, code, err) == ("revchain", 0, "")
    flat = " ".join(run(name, "--help")[1].split())
    assert f"Example: {example} Files written: {told}. Exit codes: 0 success;" in flat
    named = {word for option, word in itertools.pairwise(arguments) if option in ("--plot", "--json", "--csv", "--out")}
    extra = {"run": {"out"}, "new": {"crane.toml"}}.get(name, set())
    assert set(files()) - before == named | extra
    if name == "run":
        assert files_in(Path("out/watch_chain")) == ["modes.csv", "modes.json", "modes.png", "modes.txt"]


def test_every_command_has_an_example():
    assert [command.name or command.callback.__name__ for command in _cli.app.registered_commands] == list(USE)


def test_help_tells_the_exit_codes(run):
    for arguments in (["--help"], ["modes", "--help"], ["run", "--help"]):
        code, out, _ = run(*arguments)
        assert code == 0
        flat = " ".join(out.split())
        for number, meaning in MEANING.items():
            assert f"{number.value} {meaning}" in flat
    assert set(MEANING) == set(ExitCode)


def test_version(run):
    assert run("--version") == (0, f"revchain {rc.__version__}\n", "")


def test_as_a_program(python):
    done = python("-m", "revchain", "modes", "watch.toml", "--quiet", "--json", "-")
    assert done.returncode == 0 and done.stderr == "" and len(json.loads(done.stdout)["modes"]) == 4
    done = python("-m", "revchain", "modes", "missing.toml")
    assert done.returncode == 3 and len(done.stderr.splitlines()) == 1
    script = Path(sys.executable).with_name("revchain")
    assert (
        subprocess.run([script, "--version"], capture_output=True, text=True).stdout == f"revchain {rc.__version__}\n"
    )


def test_a_reader_that_stops_early():
    done = subprocess.run(
        f"{sys.executable} -m revchain modes watch.toml --count 120 --json - | head -n 1; echo ${{PIPESTATUS[0]}}",
        shell=True, executable="/bin/bash", capture_output=True, text=True,
    )  # fmt: skip
    assert done.stdout.splitlines() == ["{", "0"] and done.stderr == ""


@pytest.mark.parametrize("missing", ["typer", "rich", "msgspec"])
def test_without_a_package(python, without, missing):
    program = without(missing) + "from revchain.__main__ import main\nsys.exit(main())\n"
    done = python("-c", program)
    assert done.returncode == 2
    assert done.stdout == "" and done.stderr == f"The command line needs {missing}: pip install {missing}\n"


def test_cmake_prefix(python, without, tmp_path, monkeypatch):
    program = without("typer", "msgspec") + "from revchain.__main__ import main\nsys.exit(main())\n"
    done = python("-c", program, "--cmake-prefix")
    assert done.returncode == 0 and done.stdout == f"{rc.cmake_prefix()}\n", done.stderr
    for name in ("share/cmake/revchain/revchain-config.cmake", "share/pkgconfig/revchain.pc", "include/revchain/modes.hpp"):
        assert (Path(rc.cmake_prefix()) / name).is_file()
    done = python("-m", "revchain", "--cmake-prefix", "modes")
    assert done.returncode == 2 and "--cmake-prefix must be the only argument" in done.stderr
    monkeypatch.setattr(rc, "__path__", [str(tmp_path)])
    with pytest.raises(FileNotFoundError, match=f"no C\\+\\+ headers in {tmp_path}; install a wheel"):
        rc.cmake_prefix()


def test_without_matplotlib(python, without):
    program = without("matplotlib") + "from revchain.__main__ import main\nsys.exit(main())\n"
    done = python("-c", program, "modes", "watch.toml", "--plot", "a.png")
    assert done.returncode == 2 and done.stderr == 'revchain: --plot needs matplotlib: pip install "revchain[plot]"\n'
    done = python("-c", program, "run", "watch.toml", "--out", "here")
    assert done.returncode == 0 and "no picture" in done.stderr
    assert files_in(Path("here")) == ["modes.csv", "modes.json", "modes.txt"]


def test_interrupted(start):
    Path("slow.toml").write_text(SLOW)
    command = [sys.executable, "-m", "revchain", "modes", "slow.toml", "--json", "a.json"]
    process = start(*command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    until = time.monotonic() + 20
    while not any(name.startswith(".a-") for name in os.listdir()) and time.monotonic() < until:
        time.sleep(0.01)  # the file set aside shows that it is at work
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert (process.returncode, out, err) == (ExitCode.INTERRUPTED, "", "revchain: interrupted\n")
    assert files() == ["slow.toml"]


def test_progress_is_shown_on_a_terminal_after_a_while(start):
    Path("slow.toml").write_text(SLOW)
    screen, terminal = pty.openpty()
    command = [sys.executable, "-m", "revchain", "modes", "slow.toml"]
    environment = {**os.environ, "TERM": "xterm"}
    process = start(*command, stdout=subprocess.DEVNULL, stderr=terminal, env=environment)
    os.close(terminal)
    shown, started = b"", time.monotonic()
    try:
        while b"solving" not in shown and time.monotonic() < started + 20:
            shown += os.read(screen, 4096)
        waited = time.monotonic() - started
        process.send_signal(signal.SIGINT)
        assert process.wait(20) == ExitCode.INTERRUPTED
    finally:
        process.kill()
        os.close(screen)
    assert b"solving" in shown and waited >= 2


def test_errors_of_the_worker_arrive(monkeypatch):
    from rich.console import Console

    from revchain.cli.progress import watched

    def work(progress):
        assert isinstance(progress, _core.Progress)
        raise ValueError("from the thread")

    with pytest.raises(ValueError, match="from the thread"):
        watched(work, Console())


def test_a_terminal_without_line_characters(python):
    done = python("-m", "revchain", "modes", "watch.toml", env={**os.environ, "PYTHONIOENCODING": "ascii"})
    assert done.returncode == ExitCode.OK, done.stderr
    assert "Watch chain" in done.stdout and "6.27" in done.stdout


def test_a_window(run):
    chain = rc.load_scene("watch.toml").system()
    for options, expected in (
        (("--conical-height", "1 cm to 0.02"), rc.modes(chain, conical_height=(0.01, 0.02))),
        (("--angular-speed", "20 to 60"), rc.modes(chain, angular_speed=(20, 60))),
        (("--angular-speed", "200 rpm"), rc.modes(chain, angular_speed=(0, 200 * np.pi / 30))),
        (("--first", 119), rc.modes(chain, 2, first=119)),
    ):
        code, out, _ = run("modes", "watch.toml", *options, "--csv", "-")
        rows = list(csv.DictReader(out.splitlines()))
        assert code == 0
        assert [int(row["mode"]) for row in rows] == expected.number.tolist()
        assert [float(row["conical_height"]) for row in rows] == expected.conical_height.tolist()
    code, out, _ = run("modes", "watch.toml", "--conical-height", "5 to 6")
    assert code == 0 and "0 of 120 modes" in out
    assert run("modes", "watch.toml", "--conical-height", "5 to 6", "--csv", "-")[1].count("\n") == 1
    assert run("modes", "watch.toml", "--conical-height", "5 to 6", "--certify", "--csv", "-")[0] == 0


def test_certify(run):
    data = json.loads(run("modes", "watch.toml", "--certify", "--json", "-")[1])
    for mode in data["modes"]:
        assert mode["certificate_lower"] < mode["conical_height"] < mode["certificate_upper"]
        assert (mode["certificate_above_lower"], mode["certificate_above_upper"]) == (mode["mode"], mode["mode"] - 1)
    row = next(csv.DictReader(run("modes", "watch.toml", "--certify", "--csv", "-")[1].splitlines()))
    assert float(row["certificate_upper"]) == data["modes"][0]["certificate_upper"]
    assert row["certificate_above_lower"] == "1"
    code, out, _ = run("modes", "watch.toml", "--certify")
    assert code == 0 and f"{data['modes'][3]['certificate_lower']:.17g}" in out
    assert max(map(len, out.splitlines())) <= 80


@pytest.mark.parametrize("precision", _core.PRECISIONS)
def test_precision(run, precision):
    data = json.loads(run("modes", "watch.toml", "--precision", precision, "--json", "-")[1])
    assert data["precision"] == precision and data["status"] == "success"
    assert ("conical_height_low" in data["modes"][0]) == (precision in ("extended", "double-double"))
    out = run("modes", "watch.toml", "--precision", precision, "--certify", "--csv", "-")[1]
    assert len(list(csv.DictReader(out.splitlines()))) == 4
    code, out, _ = run("modes", "watch.toml", "--precision", precision, "--certify")
    assert code == 0 and max(map(len, out.splitlines())) <= 80


def test_a_scene_that_asks_for_a_window_gives_way_to_options(run):
    Path("window.toml").write_text(WATCH.replace("count = 4", "conical_height = ['10 mm', 0.02]\ncertify = true"))
    inside = json.loads(run("modes", "window.toml", "--json", "-")[1])["modes"]
    assert all(0.01 < mode["conical_height"] <= 0.02 and "certificate_lower" in mode for mode in inside) and inside
    slowest = json.loads(run("modes", "window.toml", "--count", 2, "--json", "-")[1])["modes"]
    assert [mode["mode"] for mode in slowest] == [1, 2]


@pytest.mark.parametrize("title", ["100 $% a $", r"\\frac{ $x_{$ $$"])
def test_a_title_is_no_mathematics(run, title):
    Path("a.toml").write_text(f'title = "{title}"\n[[links]]\nmass = 1\nlength = 1\n')
    assert run("modes", "a.toml", "--plot", "a.png")[0] == 0


def test_a_title_that_is_not_unicode(run):
    Path("a.json").write_text(r'{"title": "x \ud800 y", "links": [{"mass": 1, "length": 1}]}')
    ends_in_one_sentence(run("modes", "a.json", "--plot", "a.png"), ExitCode.SCENE_INVALID, "is not Unicode")


@pytest.mark.parametrize("path", sorted(SCENES.glob("*.toml")), ids=lambda path: path.stem)
def test_every_shipped_scene_is_answered(run, repository, monkeypatch, path):
    """With the words that docs/scenes.md shows, if the scene is there."""
    monkeypatch.setenv("COLUMNS", "100")
    read = rc.load_scene(path)
    code, out, err = run("run", path)
    asked = read.asks or ("modes",)
    assert (code, err) == (0, "") and out.startswith(f"{read.title}\n")
    assert any(words in out for words in ("support: ", "both ends held", "governor: "))
    assert files_in(Path("out") / path.stem) == sorted(f"{q}{kind}" for q in asked for kind in (".txt", ".json", ".csv", ".png"))
    for question in asked:
        text = (Path("out") / path.stem / f"{question}.txt").read_text()
        assert read.system().describe()[:30] in " ".join(text.split()) and "Traceback" not in text
        picture = (Path("out") / path.stem / f"{question}.png").read_bytes()
        assert picture.startswith(b"\x89PNG") and len(picture) > 5000
    for section in (repository / "docs" / "scenes.md").read_text(encoding="utf-8").split("\n## ")[1:]:
        if f"](../examples/scenes/{path.name}).\n" in section:
            printed = re.search(r"```toml\n.*?\n```\n\n```text\n(.*?)\n```\n", section, re.DOTALL)[1]
            assert printed.splitlines() == [line.rstrip() for line in out.splitlines() if not line.startswith("wrote ")]
