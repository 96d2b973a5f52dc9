# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands of the command line, by typer."""

from __future__ import annotations

import io
import json
import os
import re
import sys
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

import typer

from ..results.files import written_aside
from ..scenes.error import SceneError
from ..scenes.parse import is_json
from ..scenes.scene import json_schema, load_scene
from ..scenes.tables import SYSTEM_TABLES, fields_of
from ..studies.study import study_schema
from . import ExitCode, animate, ask, sweep, importing  # noqa: F401  their commands come first
from .frame import STDOUT, Stop, app, epilog, guarded


UNREADABLE: Any = typer.BadParameter.__mro__[1]  # click's UsageError, which not every version of typer has as its own


def run(arguments: list[str] | None = None) -> int:
    """Run the command line and return the exit code; a wrong command line gives one sentence on stderr."""
    if sys.stdout is None:  # closed by the caller
        sys.stdout = open(os.devnull, "w")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal without line characters shows question marks
    try:
        code = app(arguments, prog_name="revchain", standalone_mode=False)
        return code if isinstance(code, int) else ExitCode.OK
    except UNREADABLE as error:
        sentence, context = error.format_message(), error.ctx
        if "\n" in sentence:  # the help, for want of arguments; newer versions of typer have printed it
            print(sentence, file=sys.stderr)
        elif sentence:
            command = "revchain" if context is None else context.command_path
            sentence = sentence[0].lower() + sentence[1:].rstrip(".")
            print(f"revchain: {sentence}{_instead(error)}; see {command} --help", file=sys.stderr)
        return ExitCode.WRONG_USAGE
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except (KeyboardInterrupt, typer.Abort):
        return ExitCode.INTERRUPTED


def _instead(error: Any) -> str:
    """The hint for an option that does not exist: a speed, or a key of the scene."""
    if re.match(r"No such command '(fit|tune)'", error.format_message()):
        return "; fits and tuning are done in Python, by revchain.fit and revchain.tune"
    wrong = getattr(error, "option_name", "").lstrip("-").replace("-", "_")
    there = [] if error.ctx is None else [name for each in error.ctx.command.params for name in each.opts]
    if wrong in ("rpm", "hz", "speed", "frequency", "period"):
        speed = next((name for name in there if name.endswith("angular-speed")), "")
        return f'; write {speed} "60 rpm", or "1 Hz"' if speed else ""
    return f"; {wrong} is a key of the scene: change it there" if wrong in _OF_A_SYSTEM else ""


_OF_A_SYSTEM = {field.encode_name for kind in SYSTEM_TABLES for field in fields_of(kind)}


@app.command(epilog=epilog("validate"))
@guarded
def validate(
    scenes: Annotated[list[Path], typer.Argument(metavar="SCENE...", help="Scene files.")],
) -> None:
    """Check scene files without answering them."""
    bad = 0
    for path in scenes:
        try:
            read = load_scene(path)
            system, asks = read.system(), ", ".join(read.asks) or f"nothing, so its {read._questions[0]}"
            print(f"{path}: valid: {system.describe()}; asks {asks}")
            sentences = [ask.without_answer(question, system, path) for question in read._questions]
            print("".join(f"{path}: {sentence}\n" for sentence in sentences if sentence), end="")
        except SceneError as error:
            bad += 1
            print(f"revchain: {error}".replace("\n", "\nrevchain: "), file=sys.stderr)
    if bad:
        raise typer.Exit(ExitCode.SCENE_INVALID)


@app.command(epilog=epilog("new"))
@guarded
def new(
    file: Annotated[Path | None, typer.Argument(metavar="[FILE]", help="File to write; - is stdout.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
    study: Annotated[bool, typer.Option("--study", help="Write a study instead of a scene.")] = False,
) -> None:
    """Write an example scene with comments, or an example study."""
    kind, folder = ("study", "studies") if study else ("scene", "scenes")
    text = files("revchain").joinpath(folder, f"new_{kind}.toml").read_text(encoding="utf-8")
    if file is None:
        file = Path(f"{kind}.toml")
    if str(file) == STDOUT:
        sys.stdout.write(text)
        return
    if is_json(str(file)):
        right = f"a {kind} with comments is TOML: write revchain new {file.with_suffix('.toml')}"
        raise Stop(f"{file}: {right}", ExitCode.WRONG_USAGE)
    if file.exists() and not force:
        raise Stop(f"{file}: exists already; --force overwrites it", ExitCode.OUTPUT_FAILED)
    with written_aside(file) as [aside]:
        aside.write_text(text, encoding="utf-8")
    run_it = "sweep " if study else "" if file.suffix.lower() == ".toml" else "run "
    print(f"wrote {file}; now: revchain {run_it}{file}")


@app.command(epilog=epilog("schema"))
@guarded
def schema(study: Annotated[bool, typer.Option("--study", help="Print the schema of study files.")] = False) -> None:
    """Print the JSON Schema of scene files, for editors."""
    sys.stdout.write(json.dumps(study_schema() if study else json_schema(), indent=2) + "\n")
