# SPDX-License-Identifier: GPL-3.0-or-later
"""The way of a command: the file is read once, the system is built once, and few calls are made in between."""

import gc
import pickle
import sys
import threading
from collections import Counter
from pathlib import Path

import pytest

import revchain as rc
from revchain.cli import app as _cli
from revchain.scenes.scene import _MADE

PACKAGE = str(Path(rc.__file__).parent)
CHAIN = '[uniform_chain]\nkind = "rods"\ncount = 3\nlength = 1\nmass = 1\n'
LINKS = '[[links]]\nname = "load"\nweight = "3 N"\nlength = 1\n[[links]]\nmass = 1\nlength = 1\n'
RIG = LINKS + "[support]\nstiffness = 50\n"
QUESTIONS = "[ask.modes]\n[ask.shapes]\nangular_speed = 5\n[ask.response]\nangular_speed = 2\n"
READ = ["scenes/parse.py text_of", "scenes/scene.py Scene._read", "scenes/system.py system_of"]


def calls_of(work):
    """Calls of the package's functions in all threads while `work` runs, and those among them from another file."""
    calls, changes = Counter(), Counter()

    def seen(frame, event, _):
        file = frame.f_code.co_filename
        if event == "call" and file.startswith(PACKAGE):
            calls[f"{file[len(PACKAGE) + 1 :]} {frame.f_code.co_qualname}"] += 1
            if frame.f_back is not None and frame.f_back.f_code.co_filename not in (file, __file__):
                changes[f"{Path(frame.f_back.f_code.co_filename).name} -> {Path(file).name}"] += 1

    threading.setprofile(seen)
    sys.setprofile(seen)
    try:
        work()
    finally:
        sys.setprofile(None)
        threading.setprofile(None)
    return calls, changes


def command(*arguments):
    def work():
        assert _cli.run([str(argument) for argument in arguments]) == 0

    return work


@pytest.mark.parametrize("text", [CHAIN, LINKS, RIG], ids=["chain", "links", "rig"])
@pytest.mark.parametrize("options", [(), ("--gravity", "1.62")], ids=["", "gravity"])
def test_the_system_is_built_once_for_three_questions(tmp_path, monkeypatch, capsys, text, options):
    monkeypatch.chdir(tmp_path)
    Path("a.toml").write_text(text + QUESTIONS)
    calls, _ = calls_of(command("run", "a.toml", "--quiet", *options))
    assert [calls[name] for name in READ] == [1, 1, 1]
    assert calls["systems/chain.py Chain.__init__"] + calls["systems/chain.py Chain._wrap"] == 1
    assert calls["systems/rig.py Rig.__init__"] == (text is RIG)


def test_what_is_made_of_a_scene_ends_with_it():
    gc.collect()
    before = len(_MADE)
    scenes = [rc.Scene.from_dict({"links": [{"mass": 1 + k, "length": 1}]}) for k in range(100)]
    assert len(_MADE) == before + 100 and scenes[7].system().mass == [8.0]
    del scenes
    gc.collect()
    assert len(_MADE) == before
    again = pickle.loads(pickle.dumps(rc.Scene.from_dict({"links": [{"mass": 5, "length": 1}]})))
    assert again.system().mass == [5.0]


def test_a_scene_read_in_python_keeps_its_system(tmp_path):
    (tmp_path / "a.toml").write_text(CHAIN + QUESTIONS)

    def work():
        scene = rc.load_scene(tmp_path / "a.toml")
        assert scene.system() is scene.system() is scene.modes(count=1).system
        scene.answers()

    calls, _ = calls_of(work)
    assert [calls[name] for name in READ] == [1, 1, 1] and calls["systems/chain.py Chain._wrap"] == 1


@pytest.fixture
def watch_chain(repository, tmp_path, monkeypatch, capsys):
    """Calls, and changes of file, of the command that answers the one question of the watch chain."""
    monkeypatch.chdir(tmp_path)
    return calls_of(command("run", repository / "examples/scenes/watch_chain.toml"))


def test_few_calls_for_one_question(watch_chain):
    calls, _ = watch_chain
    own = sum(count for name, count in calls.items() if name.startswith(("scenes/", "cli/")))
    assert calls.total() <= 600 and own <= 115, calls.most_common(30)


def test_few_changes_of_file_for_one_question(watch_chain):
    _, changes = watch_chain
    assert changes.total() <= 125, changes.most_common(30)  # five for units asked and names of options
