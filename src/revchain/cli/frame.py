# SPDX-License-Identifier: GPL-3.0-or-later
"""The common parts of all commands: the application, errors, exit codes and output files."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Annotated, Any, NoReturn, ParamSpec

import typer
from typer.core import TyperGroup

from ..plots.style import save_picture as save_picture
from ..scenes.error import SceneError
from ..systems.extras import require
from ..systems.units import SPEED_UNITS
from . import MEANING, ExitCode

Arguments = ParamSpec("Arguments")

PICTURES = (".png", ".svg", ".pdf")
STDOUT = "-"

EXIT_CODES = "Exit codes: " + "; ".join(f"{code.value} {meaning}" for code, meaning in MEANING.items()) + "."

_ON_REQUEST = "only those given by --plot, --json, --csv and --xlsx"
# Of each command: a command line that works in a copy of the repository, and the files that the command writes.
USE: dict[str, tuple[str, str]] = {
    "run": (
        "revchain run examples/scenes/watch_chain.toml",
        "QUESTION.txt, .json, .csv and .png for each question of the scene, in the folder out/SCENE or --out; "
        "the page given by --report and the workbook given by --xlsx",
    ),
    "modes": ("revchain modes examples/scenes/watch_chain.toml --count 3 --plot modes.svg", _ON_REQUEST),
    "shapes": ('revchain shapes examples/scenes/chair_o_plane.toml --angular-speed "12 rpm"', _ON_REQUEST),
    "response": (
        'revchain response examples/scenes/crane_hook_block.toml --angular-speed "0.1 to 3 in 50" --csv response.csv',
        _ON_REQUEST,
    ),
    "swing": ('revchain swing examples/scenes/plucked_chain.toml --time "0 to 5 in 100" --json swing.json', _ON_REQUEST),
    "branches": (
        'revchain branches examples/scenes/chair_o_plane.toml --max-angular-speed "20 rpm" --plot branches.png',
        _ON_REQUEST,
    ),
    "campbell": (
        'revchain campbell examples/scenes/chair_o_plane.toml --angular-speed "1 rpm to 15 rpm in 29" --plot campbell.svg',
        _ON_REQUEST,
    ),
    "drag": ('revchain drag examples/scenes/whirling_machine.toml --angular-speed "60 rpm" --plot drag.svg', _ON_REQUEST),
    "equilibria": ('revchain equilibria examples/scenes/porter_governor.toml --angular-speed "125 rpm"', _ON_REQUEST),
    "explain": ("revchain explain examples/scenes/watch_chain.toml --rtol 1e-3", "only those given by --json, --csv and --xlsx"),
    "animate": ("revchain animate examples/scenes/two_weights.toml --out weights.html", "the file given by --out"),
    "sweep": (
        "revchain sweep examples/studies/two_weights.toml --out weights.csv",
        "the results (--out, or STUDY.csv in the current folder) and the picture given by --plot; RESULTS.partial "
        "while it computes, or if it is interrupted",
    ),
    "import": (
        'revchain import examples/models/acrobat.xml --ignore "friction range" --out acrobat.toml',
        "the scene given by --out, or FILE.toml in the current folder; existing files only with --force",
    ),
    "validate": ("revchain validate examples/scenes/watch_chain.toml", "none"),
    "new": ("revchain new crane.toml", "FILE, or scene.toml (study.toml with --study); existing files only with --force"),
    "schema": ("revchain schema", "none"),
}
NEVER = {  # exit codes that a command does not have
    "validate": {ExitCode.TOLERANCE_NOT_MET},
    "new": {ExitCode.TOLERANCE_NOT_MET, ExitCode.SCENE_INVALID},
    "import": {ExitCode.TOLERANCE_NOT_MET},
    "schema": {ExitCode.TOLERANCE_NOT_MET, ExitCode.SCENE_INVALID},
}


def codes_of(command: str) -> dict[ExitCode, str]:
    """The exit codes that a command can have, and their meanings."""
    return {code: meaning for code, meaning in MEANING.items() if code not in NEVER.get(command, ())}


def epilog(command: str) -> str:
    """The end of the help of a command: an example, the files written, the exit codes."""
    example, files = USE[command]
    codes = "; ".join(f"{code.value} {meaning}" for code, meaning in codes_of(command).items())
    return f"Example: [b]{example}[/b]\n\nFiles written: {files}.\n\nExit codes: {codes}."


class Commands(TyperGroup):
    """The commands; a scene file in the place of one means `run`."""

    def resolve_command(self, ctx: Any, args: list[str]) -> Any:
        word = args[0]
        is_scene = word not in self.commands and (word.lower().endswith((".toml", ".json")) or Path(word).is_file())
        return super().resolve_command(ctx, ["run", *args] if is_scene else args)


_WHAT = (
    "Whirl speeds and shapes of hanging chains, with error bounds. [b]revchain new[/b] writes a scene to begin with; "
    "[b]revchain SCENE[/b] means [b]revchain run SCENE[/b]."
)
app = typer.Typer(
    cls=Commands,
    add_completion=True,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    subcommand_metavar="COMMAND [ARGS]... | SCENE",
    help=_WHAT,
    epilog=EXIT_CODES,
)


class Stop(Exception):
    """The end of a command with a sentence and an exit code."""

    def __init__(self, message: str, code: ExitCode) -> None:
        super().__init__(message)
        self.code = code


def guarded(command: Callable[Arguments, None]) -> Callable[Arguments, None]:
    """Return the command with its errors turned into a message on stderr and an exit code."""

    @functools.wraps(command)
    def wrapper(*args: Arguments.args, **kwargs: Arguments.kwargs) -> None:
        try:
            command(*args, **kwargs)
            sys.stdout.flush()
        except Stop as stop:
            fail(str(stop), stop.code)
        except SceneError as error:
            fail(str(error).replace("\n", "\nrevchain: "), ExitCode.SCENE_INVALID)
        except ImportError as error:
            fail(str(error), ExitCode.WRONG_USAGE)
        except MemoryError:
            fail("not enough memory; ask for fewer modes", ExitCode.WRONG_USAGE)
        except KeyboardInterrupt:
            fail("interrupted", ExitCode.INTERRUPTED)
        except BrokenPipeError:  # the reader, such as head, has closed the pipe
            with suppress(OSError):
                sys.stdout = open("/dev/null", "w")  # so that nothing is flushed into it at the end
            raise typer.Exit(ExitCode.OK) from None
        except OSError as error:
            name = f"{error.filename}: " if error.filename is not None else ""
            fail(f"{name}cannot be written: {error.strerror or error}", ExitCode.OUTPUT_FAILED)

    return wrapper


def fail(message: str, code: ExitCode) -> NoReturn:
    """Print the message on stderr as plain text, and exit."""
    print(f"revchain: {message}", file=sys.stderr)
    raise typer.Exit(code)


def show_version(wanted: bool) -> None:
    if wanted:
        from .. import __version__

        print(f"revchain {__version__}")
        raise typer.Exit


@app.callback(help=_WHAT)
def common(
    version: Annotated[
        bool, typer.Option("--version", callback=show_version, is_eager=True, help="Print the version and exit.")
    ] = False,
    cmake_prefix: Annotated[
        bool, typer.Option("--cmake-prefix", help="Print the folder of the C++ headers, for CMake, and exit.")
    ] = False,
) -> None:
    """Whirl speeds and shapes of hanging chains, with error bounds."""
    if cmake_prefix:  # alone it is answered by __main__, which does not need typer
        raise typer.BadParameter("--cmake-prefix must be the only argument")


Speed = Annotated[
    str | None,
    typer.Option(metavar="rad/s|rpm|Hz|s", help="Unit of speeds in tables and pictures; data files have rad/s."),
]


def check_speed(speed: str | None) -> None:
    if speed is not None and speed not in SPEED_UNITS:
        sentence = f"must be one of {', '.join(SPEED_UNITS)}, the unit of speeds in tables, got {speed}"
        raise Stop(f"--speed: {sentence}; give a speed by --angular-speed or --max-angular-speed", ExitCode.WRONG_USAGE)


def checked_picture(plot: Path) -> None:
    if plot.suffix.lower() not in PICTURES:
        raise Stop(f"--plot: {plot} must end in {', '.join(PICTURES)}", ExitCode.WRONG_USAGE)
    require("matplotlib", "plot", "--plot")


def checked_workbook(path: Path) -> None:
    if path.suffix.lower() != ".xlsx":
        raise Stop(f"--xlsx: {path} must end in .xlsx", ExitCode.WRONG_USAGE)
    require("openpyxl", "excel", "--xlsx")


def outputs_of(
    scene: Path, plot: Path | None, json: str | None, csv: str | None, xlsx: Path | None = None
) -> list[tuple[Path, str]]:
    """The files to write, each with the kind of its content."""
    if json == STDOUT and csv == STDOUT:
        raise Stop("--json - and --csv - cannot share stdout", ExitCode.WRONG_USAGE)
    outputs = [(Path(name), kind) for name, kind in ((json, ".json"), (csv, ".csv")) if name not in (None, STDOUT)]
    if plot is not None:
        checked_picture(plot)
        outputs.append((plot, plot.suffix.lower()))
    if xlsx is not None:
        checked_workbook(xlsx)
        outputs.append((xlsx, ".xlsx"))
    seen = {scene.resolve(): ""}
    for path, kind in outputs:
        name = f"--{kind[1:]}" if kind in (".json", ".csv", ".xlsx") else "--plot"
        if (before := seen.setdefault(path.resolve(), name)) == "":
            raise Stop(f"{name}: {scene}: the scene itself would be overwritten", ExitCode.WRONG_USAGE)
        if before != name:
            raise Stop(f"{before} and {name}: two outputs have the same name, {path}", ExitCode.WRONG_USAGE)
    return outputs
