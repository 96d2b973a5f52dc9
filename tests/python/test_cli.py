# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: what it prints, what it writes, how it ends."""

import csv
import json
import os
import pty
import re
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
from revchain.cli import sweep as _cli_sweep
from revchain.cli.exit_codes import MEANING, ExitCode

WATCH = """
title = "Watch chain"
[uniform_chain]
kind = "rods"
count = 120
length = 0.36
mass = 0.03
[ask]
modes = 4
"""
SLOW = """
[uniform_chain]
kind = "rods"
count = 400_000
length = 1
mass = 1
[ask]
modes = 100
method = "bisection"
"""


@pytest.fixture(autouse=True)
def in_a_folder_of_its_own(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("COLUMNS", "80")
    Path("watch.toml").write_text(WATCH)


@pytest.fixture
def run(capsys):
    """Run a command in this process: exit code, stdout, stderr."""

    def call(*arguments):
        code = _cli.run([str(argument) for argument in arguments])
        captured = capsys.readouterr()
        assert "Traceback" not in captured.err
        return code, captured.out, captured.err

    return call


def files():
    return sorted(path.name for path in Path().iterdir())


def test_the_table(run):
    code, out, err = run("solve", "watch.toml")
    assert (code, err) == (0, "")
    lines = out.splitlines()
    assert lines[0] == "Watch chain"
    assert " ".join(lines[1:3]).replace("  ", " ") == (
        "4 of 120 modes of a chain of 120 links, length 0.36, weight 0.294199: by bisection, success"
    )
    assert lines[-1] == "gravity 9.80665 m/s^2; error bound: relative, of the conical height"
    assert all(unit in out for unit in ("(rad/s)", "(rpm)", "(s)", "error", "bound", "(m from", "the free", "end)"))
    (second,) = (line.split() for line in lines if line.strip().startswith("2 "))
    assert second == ["2", "14.4064", "137.571", "0.436139", "0.0472508729", "4.4e-16", "1:", "0.0683"]
    assert max(map(len, lines)) <= 80 and "…\n" not in out
    assert files() == ["watch.toml"]


def test_a_narrow_terminal_cuts_no_number(run, monkeypatch):
    monkeypatch.setenv("COLUMNS", "30")
    assert "0.0472508729 " in run("solve", "watch.toml")[1]


def test_many_modes(run):
    code, out, _ = run("solve", "watch.toml", "--modes", 100)
    assert code == 0
    assert "and 80 more" in out and len(out.splitlines()) < 35


def test_json(run):
    code, out, err = run("solve", "watch.toml", "--json", "-")
    assert (code, err) == (0, "")
    data = json.loads(out)
    assert data["title"] == "Watch chain" and data["status"] == "success" and data["gravity"] == 9.80665
    result = rc.load_scene("watch.toml").modes()
    for k, mode in enumerate(data["modes"]):
        assert list(mode)[:5] == ["mode", "angular_speed", "frequency", "rpm", "period"] and "shape" not in mode
        assert mode["mode"] == k + 1
        assert mode["conical_height"] == result.conical_height[k]
        assert mode["angular_speed"] == result.angular_speed[k]
        assert mode["error_bound"] == result.error_bound[k]
        assert mode["nodes"] == result.nodes[k].tolist()
    assert run("solve", "watch.toml", "--json", "a.json", "--quiet")[1] == ""
    assert json.loads(Path("a.json").read_text()) == data


def test_csv(run):
    code, out, _ = run("solve", "watch.toml", "--csv", "-")
    assert code == 0
    rows = list(csv.DictReader(out.splitlines()))
    result = rc.load_scene("watch.toml").modes()
    assert [float(row["conical_height"]) for row in rows] == result.conical_height.tolist()
    assert [[float(node) for node in row["nodes"].split()] for row in rows] == [list(nodes) for nodes in result.nodes]
    assert [len(nodes) for nodes in result.nodes] == [0, 1, 2, 3] and "shape" not in rows[0]


@pytest.mark.parametrize("name", ["a.png", "a.svg", "a.pdf", "A.PNG"])
def test_plot(run, name):
    code, out, _ = run("solve", "watch.toml", "--plot", name)
    assert code == 0 and f"wrote {name}" in out
    start = {"png": b"\x89PNG", "svg": b"<?xml", "pdf": b"%PDF"}[name[-3:].lower()]
    assert Path(name).read_bytes().startswith(start)
    assert files() == sorted([name, "watch.toml"])


def test_out(run):
    code, out, _ = run("solve", "watch.toml", "--out", "results/here")
    assert code == 0
    folder = Path("results/here")
    assert sorted(path.name for path in folder.iterdir()) == ["watch.csv", "watch.json", "watch.npz", "watch.png"]
    assert np.array_equal(rc.load(folder / "watch.npz").shape, rc.load_scene("watch.toml").modes().shape)
    assert run("solve", "watch.toml", "--out", "results/here", "--quiet") == (0, "", "")


def test_options_go_before_the_scene(run):
    code, out, _ = run("solve", "watch.toml", "--modes", 2, "--method", "dense", "--rtol", "1e-6", "--json", "-")
    data = json.loads(out)
    assert code == 0 and len(data["modes"]) == 2 and data["method"] == "dense"


def test_a_tolerance_that_is_not_met(run):
    code, out, err = run("solve", "watch.toml", "--rtol", "1e-30", "--json", "a.json")
    assert code == ExitCode.TOLERANCE_NOT_MET == 1
    assert "tolerance not met" in out
    assert err == "revchain: the tolerance is not met: asked 1e-30, reached 4.4e-16\n"
    assert json.loads(Path("a.json").read_text())["status"] == "tolerance_not_met"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--modes", "121"], "count"),
        (["--modes", "0"], "count must be at least 1, got 0"),
        (["--modes", "many"], "--modes"),
        (["--rtol", "-1"], "-1"),
        (["--rtol", "nan"], "nan"),
        (["--method", "qr"], "bisection, condensed, aberth, interpolated, dense, recurrence"),
        (["--plot", "a.jpg"], ".png, .svg, .pdf"),
        (["--json", "-", "--csv", "-"], "cannot share stdout"),
        (["--json", "a.txt", "--csv", "a.txt"], "same name"),
        (["--colour"], "--colour"),
    ],
)
def test_wrong_usage(run, arguments, message):
    code, out, err = run("solve", "watch.toml", *arguments)
    assert code == ExitCode.WRONG_USAGE == 2
    assert out == "" and message in err
    assert files() == ["watch.toml"]


SWINGING = """
[[links]]
mass = 0.5
length = 0.5
repeat = 2
[ask.shapes]
conical_height = 0.05
[ask.response]
angular_speed = [1, 12]
steps = 5
[ask.swing]
offset = [0.02, 0]
"""
STUDY = """
scene = "swinging.toml"
find = ["modes"]
[vary."links[0].mass"]
values = [1, 2]
"""
OF_SCENES = ("solve", "explain", "shapes", "response", "swing")


def ends_in_one_sentence(done, code, words):
    assert done[0] == code and done[1] == "" and done[2].startswith("revchain: ") and done[2].count("\n") == 1
    assert words in done[2]


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("missing.toml", None, "missing.toml: cannot be read: No such file or directory"),
        ("watch.toml/missing.toml", None, "watch.toml/missing.toml: cannot be read: Not a directory"),
        (".", None, ".: cannot be read: Is a directory"),
        ("a.toml", "not toml", "a.toml: line 1, column 5: "),
        ("a.json", '{"links": [', "a.json: line 1, column 12: "),
        ("a.json", "[1, 2]", "a.json: must be a table, got [1, 2]"),
        ("a.toml", b"\x89PNG\xff", "a.toml: is not UTF-8 text (byte 1)"),
        ("a.toml", "", "a.toml: "),
        ("a.toml", "[[links]]\nmass = 1\nlength = 1\ncolour = 3", "a.toml: links"),
        ("a.toml", '[[links]]\nmass = "1 m"\nlength = 1', "a.toml: links"),
        ("a.toml", '[[links]]\nmass = "1 parsnip"\nlength = 1', "a.toml: links"),
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


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["frobnicate"], "no such command 'frobnicate'; see revchain --help"),
        (["--colour"], "no such option: --colour; see revchain --help"),
        (["solve", "watch.toml", "--rtol", "much"], "'--rtol'"),
        (["response", "swinging.toml", "--steps", "0"], "'--steps'"),
        (["response", "swinging.toml", "--angular-speed", "1"], "'--angular-speed' requires 2 arguments"),
        (["shapes", "swinging.toml", "--half-waves", "2"], "--half-waves is not for a chain that hangs"),
        (["explain", "watch.toml", "--rtol", "-1"], "rtol must not be negative or NaN, got -1"),
        (["sweep", "study.toml", "--chunk", "0"], "'--chunk'"),
        (["sweep", "study.toml", "--out", "a.txt"], "a.txt must end in .csv, .parquet or .nc"),
        (["sweep", "study.toml", "--out", "study.toml"], "study.toml: the study itself would be overwritten"),
    ],
)
def test_options_that_cannot_be_meant(run, arguments, words):
    Path("swinging.toml").write_text(SWINGING)
    Path("study.toml").write_text(STUDY)
    ends_in_one_sentence(run(*arguments), ExitCode.WRONG_USAGE, words)


@pytest.mark.parametrize("command", ["shapes", "response", "swing"])
@pytest.mark.parametrize(
    ("option", "place"),
    [
        ("--json", "missing/a.json"),
        ("--csv", "watch.toml/a.csv"),
        ("--plot", "/proc/a.png"),
        ("--json", "."),
        ("--json", "/dev/full"),
        ("--plot", "missing/a.png"),
    ],
)
def test_outputs_of_motions_that_cannot_be_written(run, command, option, place):
    Path("swinging.toml").write_text(SWINGING)
    done = run(command, "swinging.toml", option, place)
    ends_in_one_sentence(done, ExitCode.OUTPUT_FAILED, f"revchain: {place}: cannot be written: ")
    assert files() == ["swinging.toml", "watch.toml"]


@pytest.mark.parametrize("place", ["watch.toml/a.csv", "/proc/a.csv", "/proc/a.nc"])
def test_results_of_studies_that_cannot_be_written(run, place):
    Path("swinging.toml").write_text(SWINGING)
    Path("study.toml").write_text(STUDY)
    done = run("sweep", "study.toml", "--out", place)
    ends_in_one_sentence(done, ExitCode.OUTPUT_FAILED, place)
    assert files() == ["study.toml", "swinging.toml", "watch.toml"]


@pytest.mark.parametrize("place", ["watch.toml/a.png", "/proc/a.png"])
def test_a_picture_of_a_study_that_cannot_be_written_is_found_out_before_computing(run, monkeypatch, place):
    Path("swinging.toml").write_text(SWINGING)
    Path("study.toml").write_text(STUDY)
    monkeypatch.setattr(_cli_sweep, "compute", lambda *_, **__: pytest.fail("computed"))
    done = run("sweep", "study.toml", "--plot", place)
    ends_in_one_sentence(done, ExitCode.OUTPUT_FAILED, f"revchain: {place}: cannot be written: ")
    done = run("sweep", "study.toml", "--plot", "a.png", "--out", "a.txt")
    ends_in_one_sentence(done, ExitCode.WRONG_USAGE, "a.txt must end in")
    assert files() == ["study.toml", "swinging.toml", "watch.toml"]


def test_a_picture_of_a_study_beside_its_results(run):
    Path("swinging.toml").write_text(SWINGING)
    Path("study.toml").write_text(STUDY)
    assert run("sweep", "study.toml", "--out", "new/a.csv", "--plot", "new/a.png")[0] == 0
    assert sorted(path.name for path in Path("new").iterdir()) == ["a.csv", "a.png"]


def test_no_scene_and_no_command(run):
    assert run("solve")[0] == run("dissolve")[0] == ExitCode.WRONG_USAGE
    code, out, err = run()
    assert code == ExitCode.WRONG_USAGE and "Usage: revchain" in out + err and "solve" in out + err


def test_scene_invalid(run):
    Path("bad.toml").write_text("[[links]]\nmass = 1\nlength = -0.5\n")
    code, out, err = run("solve", "bad.toml", "--json", "a.json")
    assert (code, out) == (ExitCode.SCENE_INVALID, "") and code == 3
    assert err == "revchain: bad.toml: links[0].length: must be positive, got -0.5\n"
    Path("bad.toml").write_text("[[links\n")
    assert run("solve", "bad.toml")[2].startswith("revchain: bad.toml: line 1, column 8: ")
    assert run("solve", "missing.toml")[2] == "revchain: missing.toml: cannot be read: No such file or directory\n"
    assert files() == ["bad.toml", "watch.toml"]


@pytest.mark.parametrize(
    "arguments",
    [
        ["--json", "missing/a.json"],
        ["--csv", "watch.toml/a.csv"],
        ["--plot", "missing/a.png"],
        ["--json", "a.json", "--plot", "missing/a.png"],
        ["--out", "watch.toml"],
        ["--out", "/proc/results"],
        ["--json", "."],
        ["--json", "/dev/full"],
    ],
)
def test_output_that_cannot_be_written(run, arguments):
    code, out, err = run("solve", "watch.toml", *arguments)
    assert (code, out) == (ExitCode.OUTPUT_FAILED, "") and code == 4
    assert len(err.splitlines()) == 1 and f"{arguments[-1]}: cannot be written: " in err.replace("/watch.json", "")
    assert files() == ["watch.toml"]


def test_it_is_found_out_before_solving(run, monkeypatch):
    monkeypatch.setattr(_cli, "watched", lambda *_: pytest.fail("solved"))
    assert run("solve", "watch.toml", "--json", "missing/a.json")[0] == ExitCode.OUTPUT_FAILED


def test_failure_in_the_middle_leaves_nothing_half_written(run, monkeypatch):
    Path("a.json").write_text("old")

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(_cli, "csv_text", full)
    code, _, err = run("solve", "watch.toml", "--json", "a.json", "--csv", "a.csv")
    assert code == ExitCode.OUTPUT_FAILED and "No space left" in err
    assert Path("a.json").read_text() == "old" and files() == ["a.json", "watch.toml"]


def test_memory(run, monkeypatch):
    def greedy(*_, **__):
        raise MemoryError

    monkeypatch.setattr(_cli, "find_modes", greedy)
    code, _, err = run("solve", "watch.toml", "--json", "a.json")
    assert code == ExitCode.WRONG_USAGE and "memory" in err and files() == ["watch.toml"]


def test_validate(run):
    Path("bad.toml").write_text("[[links]]\nmass = 1\nlenght = 1\n")
    code, out, err = run("validate", "watch.toml", "bad.toml", "missing.toml")
    assert code == ExitCode.SCENE_INVALID
    assert out == "watch.toml: valid: Chain of 120 links, length 0.36, weight 0.294199\n"
    assert "bad.toml: links[0].lenght: unknown key; did you mean length?" in err and "missing.toml" in err
    assert run("validate", "watch.toml")[0] == 0


def test_new(run):
    code, out, _ = run("new")
    assert code == 0 and out == "wrote scene.toml; now: revchain solve scene.toml\n"
    text = Path("scene.toml").read_text()
    assert text.count("#") > 15
    assert run("validate", "scene.toml")[0] == run("solve", "scene.toml")[0] == 0
    Path("scene.toml").write_text("mine")
    code, _, err = run("new")
    assert code == ExitCode.OUTPUT_FAILED and "--force" in err and Path("scene.toml").read_text() == "mine"
    assert run("new", "scene.toml", "--force")[0] == 0 and Path("scene.toml").read_text() == text
    assert run("new", "-")[1] == text
    assert run("new", "missing/scene.toml")[0] == ExitCode.OUTPUT_FAILED


def test_what_the_new_scene_says_in_comments_is_right(run):
    """The other half, commented out, is a scene too."""
    run("new", "a.toml")
    _, _, rest = Path("a.toml").read_text().partition("# ---- what else")[0].partition("# ---- ...")
    uncommented = [line.removeprefix("# ") for line in rest.splitlines()[2:] if not line.startswith("# ----")]
    Path("b.toml").write_text("\n".join(line for line in uncommented if line != "#"))
    assert rc.load_scene("b.toml").chain() == rc.Chain.uniform_rods(120, 0.36, 0.03 * 9.80665).with_weight(
        0.01 * 9.80665
    )
    ask = rc.load_scene("b.toml").ask
    assert (ask.rtol, ask.first, ask.modes, ask.certify) == (1e-9, 3, 5, True)


def test_what_the_new_scene_says_of_rigs_is_right(run):
    """What is commented out in the half that holds, put in."""
    run("new", "a.toml")
    text, mark, _ = Path("a.toml").read_text().partition("# ---- ... or")
    Path("b.toml").write_text(re.sub(r"^# (?=\w+ = |\[support\])", "", text, flags=re.MULTILINE))
    rig = rc.load_scene("b.toml").rig()
    assert mark and (rig.stiffness, rig.support_radius, rig.fluid) == (200.0, 0.1, "turning")
    assert rig.standing.tolist() == [False] * 4 + [True] and rig.momentum[-1] > 0 and rig.displaced_weight[-1] > 3.9
    assert rig.chain.weight[-1] == pytest.approx(2.1 * 9.80665, rel=1e-15)  # with the weight at its pin
    assert run("solve", "b.toml")[0] == 0


def test_schema(run):
    assert run("schema")[1] == Path(rc.__file__).with_name("scenes").joinpath("scene.schema.json").read_text(encoding="utf-8")


def test_help_tells_the_exit_codes(run):
    for arguments in (["--help"], ["solve", "--help"]):
        code, out, _ = run(*arguments)
        assert code == 0
        flat = " ".join(out.split())
        for number, meaning in MEANING.items():
            assert f"{number.value} {meaning}" in flat
    assert set(MEANING) == set(ExitCode)


def test_version(run):
    assert run("--version") == (0, f"revchain {rc.__version__}\n", "")


def test_as_a_program(python):
    done = python("-m", "revchain", "solve", "watch.toml", "--quiet", "--json", "-")
    assert done.returncode == 0 and done.stderr == "" and len(json.loads(done.stdout)["modes"]) == 4
    done = python("-m", "revchain", "solve", "missing.toml")
    assert done.returncode == 3 and len(done.stderr.splitlines()) == 1
    script = Path(sys.executable).with_name("revchain")
    assert (
        subprocess.run([script, "--version"], capture_output=True, text=True).stdout == f"revchain {rc.__version__}\n"
    )


def test_a_reader_that_stops_early():
    done = subprocess.run(
        f"{sys.executable} -m revchain solve watch.toml --modes 120 --json - | head -n 1; echo ${{PIPESTATUS[0]}}",
        shell=True, executable="/bin/bash", capture_output=True, text=True,
    )  # fmt: skip
    assert done.stdout.splitlines() == ["{", "0"] and done.stderr == ""


@pytest.mark.parametrize("missing", ["typer", "rich", "msgspec"])
def test_without_the_extra(python, without, missing):
    program = without(missing) + "from revchain.__main__ import main\nsys.exit(main())\n"
    done = python("-c", program)
    assert done.returncode == 2
    assert done.stdout == "" and done.stderr == f'The command line needs {missing}: pip install "revchain[cli]"\n'


def test_without_matplotlib(python, without):
    program = without("matplotlib") + "from revchain.__main__ import main\nsys.exit(main())\n"
    done = python("-c", program, "solve", "watch.toml", "--plot", "a.png")
    assert done.returncode == 2 and done.stderr == 'revchain: --plot needs matplotlib: pip install "revchain[plot]"\n'
    done = python("-c", program, "solve", "watch.toml", "--out", "here")
    assert done.returncode == 0 and "no picture" in done.stderr
    assert sorted(path.name for path in Path("here").iterdir()) == ["watch.csv", "watch.json", "watch.npz"]


def test_interrupted(start):
    Path("slow.toml").write_text(SLOW)
    command = [sys.executable, "-m", "revchain", "solve", "slow.toml", "--json", "a.json"]
    process = start(*command, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    until = time.monotonic() + 20
    while not any(name.startswith(".a-") for name in os.listdir()) and time.monotonic() < until:
        time.sleep(0.01)  # the file set aside shows that it is at work
    time.sleep(0.3)
    process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=20)
    assert (process.returncode, out, err) == (ExitCode.INTERRUPTED, "", "revchain: interrupted\n")
    assert files() == ["slow.toml", "watch.toml"]


def test_progress_is_shown_on_a_terminal_after_a_while(start):
    Path("slow.toml").write_text(SLOW)
    screen, terminal = pty.openpty()
    command = [sys.executable, "-m", "revchain", "solve", "slow.toml"]
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
    done = python("-m", "revchain", "solve", "watch.toml", env={**os.environ, "PYTHONIOENCODING": "ascii"})
    assert done.returncode == ExitCode.OK, done.stderr
    assert "Watch chain" in done.stdout and "6.27" in done.stdout


def test_the_scene_is_not_overwritten(python):
    before = Path("watch.toml").read_text()
    done = python("-m", "revchain", "solve", "watch.toml", "--json", "watch.toml")
    assert (done.returncode, done.stderr) == (
        ExitCode.WRONG_USAGE,
        "revchain: watch.toml: the scene itself would be overwritten\n",
    )
    assert Path("watch.toml").read_text() == before


def test_modes_by_number(run):
    code, out, _ = run("solve", "watch.toml", "--modes", "100:104")
    assert code == 0 and "modes 100 to 104 of 120 of a chain" in out
    rows = [line.split()[0] for line in out.splitlines() if line.strip()[:3].isdigit()]
    assert rows == ["100", "101", "102", "103", "104"]
    data = json.loads(run("solve", "watch.toml", "--modes", "7:7", "--json", "-")[1])
    assert [mode["mode"] for mode in data["modes"]] == [7]
    assert "mode 120 of 120" in run("solve", "watch.toml", "--modes", "120:120")[1]


def test_a_window(run):
    chain = rc.load_scene("watch.toml").chain()
    for options, expected in (
        (("--conical-height", 0.01, 0.02), rc.modes(chain, conical_height=(0.01, 0.02))),
        (("--angular-speed", 20, 60), rc.modes(chain, angular_speed=(20, 60))),
    ):
        code, out, _ = run("solve", "watch.toml", *options, "--csv", "-")
        rows = list(csv.DictReader(out.splitlines()))
        assert code == 0
        assert [int(row["mode"]) for row in rows] == expected.number.tolist()
        assert [float(row["conical_height"]) for row in rows] == expected.conical_height.tolist()
    code, out, _ = run("solve", "watch.toml", "--conical-height", 5, 6)
    assert code == 0 and "0 of 120 modes" in out
    assert run("solve", "watch.toml", "--conical-height", 5, 6, "--csv", "-")[1].count("\n") == 1
    assert run("solve", "watch.toml", "--conical-height", 5, 6, "--certify", "--csv", "-")[0] == 0


def test_certify(run):
    data = json.loads(run("solve", "watch.toml", "--certify", "--json", "-")[1])
    for mode in data["modes"]:
        assert mode["certificate_lower"] < mode["conical_height"] < mode["certificate_upper"]
        assert (mode["certificate_above_lower"], mode["certificate_above_upper"]) == (mode["mode"], mode["mode"] - 1)
    row = next(csv.DictReader(run("solve", "watch.toml", "--certify", "--csv", "-")[1].splitlines()))
    assert float(row["certificate_upper"]) == data["modes"][0]["certificate_upper"]
    assert row["certificate_above_lower"] == "1"
    code, out, _ = run("solve", "watch.toml", "--certify")
    assert code == 0 and f"{data['modes'][3]['certificate_lower']:.17g}" in out
    assert max(map(len, out.splitlines())) <= 80


@pytest.mark.parametrize("precision", _core.PRECISIONS)
def test_precision(run, precision):
    data = json.loads(run("solve", "watch.toml", "--precision", precision, "--json", "-")[1])
    assert data["precision"] == precision and data["status"] == "success"
    assert ("conical_height_low" in data["modes"][0]) == (precision in ("extended", "double-double"))
    out = run("solve", "watch.toml", "--precision", precision, "--certify", "--csv", "-")[1]
    assert len(list(csv.DictReader(out.splitlines()))) == 4
    code, out, _ = run("solve", "watch.toml", "--precision", precision, "--certify")
    assert code == 0 and max(map(len, out.splitlines())) <= 80
    assert run("solve", "watch.toml", "--precision", precision, "--out", "all")[0] == 0


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (("--modes", "5:3"), "ascending and from 1 on, got 5:3"),
        (("--modes", "0:3"), "ascending and from 1 on, got 0:3"),
        (("--modes", "119:121"), "121|the 2 from number 119"),
        (("--modes", "121:121"), "the 120 modes of this chain, got 121"),
        (("--modes", "some"), "such as 1000:1009, got some"),
        (("--modes", "3", "--angular-speed", "1", "2"), "--modes and --angular-speed"),
        (("--conical-height", "2", "1"), "exceed its low end 2, got 1"),
        (("--conical-height", "-1", "1"), "not negative, got -1"),
        (("--angular-speed", "nan", "1"), "nan"),
        (("--precision", "half"), "single, double, extended, double-double.*half"),
        (("--precision", "single", "--method", "dense"), "precision double only"),
    ],
)
def test_selections_refused(run, options, message):
    code, out, err = run("solve", "watch.toml", *options)
    assert (code, out) == (ExitCode.WRONG_USAGE, "")
    assert re.search(message, err), err


def test_a_scene_that_asks_for_a_window_gives_way_to_options(run):
    Path("window.toml").write_text(WATCH.replace("modes = 4", "conical_height = ['10 mm', 0.02]\ncertify = true"))
    inside = json.loads(run("solve", "window.toml", "--json", "-")[1])["modes"]
    assert all(0.01 < mode["conical_height"] <= 0.02 and "certificate_lower" in mode for mode in inside) and inside
    slowest = json.loads(run("solve", "window.toml", "--modes", 2, "--json", "-")[1])["modes"]
    assert [mode["mode"] for mode in slowest] == [1, 2]


@pytest.mark.parametrize("title", ["100 $% a $", r"\\frac{ $x_{$ $$"])
def test_a_title_is_no_mathematics(run, title):
    Path("a.toml").write_text(f'title = "{title}"\n[[links]]\nmass = 1\nlength = 1\n')
    assert run("solve", "a.toml", "--plot", "a.png")[0] == 0


def test_a_title_that_is_not_unicode(run):
    Path("a.json").write_text(r'{"title": "x \ud800 y", "links": [{"mass": 1, "length": 1}]}')
    ends_in_one_sentence(run("solve", "a.json", "--plot", "a.png"), ExitCode.SCENE_INVALID, "is not Unicode")


def test_numbers_of_very_many_digits(run):
    began = time.monotonic()
    for name, mass in (("a.json", "1" * 10**5), ("a.toml", "0x" + "f" * 10**4), ("a.toml", f'"{"1" * 20_000} kg!"')):
        link = f'{{"mass": {mass}, "length": 1}}' if name == "a.json" else f"{{mass = {mass}, length = 1}}"
        Path(name).write_text(f'{{"links": [{link}]}}' if name == "a.json" else f"links = [{link}]")
        ends_in_one_sentence(run("solve", name), ExitCode.SCENE_INVALID, name)
    assert time.monotonic() - began < 5


@pytest.mark.parametrize("name", ["swing_carousel", "broomstick"])
def test_the_response_at_one_speed_has_a_picture(run, repository, name):
    assert run("response", repository / f"examples/scenes/{name}.toml", "--plot", "a.png")[0] == 0


def test_every_shipped_scene_is_solved(run, repository):
    for path in (repository / "examples/scenes").glob("*.toml"):
        assert run("solve", path)[0] == 0, path


def test_a_benchmark_that_is_not_there(python, repository):
    done = python(repository / "bench/measure.py", "--only", "nothing of the kind")
    assert done.returncode == 2 and "no task's description contains 'nothing of the kind'" in done.stderr
