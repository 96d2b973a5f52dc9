# SPDX-License-Identifier: GPL-3.0-or-later
"""What all commands share: the application, how one ends, what it prints and the files it writes."""

from __future__ import annotations

import functools
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, NoReturn, ParamSpec, Protocol, TypeVar

import typer
from rich.console import Console, RenderableType

from ..plots.style import plain
from ..results.files import written_aside
from ..scenes.error import SceneError
from ..systems.extras import require
from .exit_codes import MEANING, ExitCode
from .report import NARROWEST

Arguments = ParamSpec("Arguments")

PICTURES = (".png", ".svg", ".pdf")
STDOUT = "-"

UNREADABLE: Any = typer.BadParameter.__mro__[1]  # click's UsageError, which not every version of typer has as its own

EXIT_CODES = "Exit codes: " + "; ".join(f"{code.value} {meaning}" for code, meaning in MEANING.items()) + "."

app = typer.Typer(
    add_completion=False,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode="rich",
    help="At which speeds a hanging chain whirls, in which shapes, and how sure these numbers are.",
    epilog=EXIT_CODES,
)


class Stop(Exception):
    """Ends a command with a sentence and an exit code."""

    def __init__(self, message: str, code: ExitCode) -> None:
        super().__init__(message)
        self.code = code


def guarded(command: Callable[Arguments, None]) -> Callable[Arguments, None]:
    """Turn what a command may raise into one line on stderr and an exit code."""

    @functools.wraps(command)
    def wrapper(*args: Arguments.args, **kwargs: Arguments.kwargs) -> None:
        try:
            command(*args, **kwargs)
            sys.stdout.flush()
        except Stop as stop:
            fail(str(stop), stop.code)
        except SceneError as error:
            fail(str(error), ExitCode.SCENE_INVALID)
        except ImportError as error:
            fail(str(error), ExitCode.WRONG_USAGE)
        except MemoryError:
            fail("not enough memory; ask for fewer modes", ExitCode.WRONG_USAGE)
        except KeyboardInterrupt:
            fail("interrupted", ExitCode.INTERRUPTED)
        except BrokenPipeError:  # the reader, such as head, has seen enough
            with suppress(OSError):
                sys.stdout = open("/dev/null", "w")  # so that nothing is flushed into it at the end
            raise typer.Exit(ExitCode.OK) from None
        except OSError as error:
            name = f"{error.filename}: " if error.filename is not None else ""
            fail(f"{name}cannot be written: {error.strerror or error}", ExitCode.OUTPUT_FAILED)

    return wrapper


def fail(message: str, code: ExitCode) -> NoReturn:
    """Say why on stderr, in plain text, and end."""
    print(f"revchain: {message}", file=sys.stderr)
    raise typer.Exit(code)


def run_app(arguments: list[str] | None) -> int:
    """The exit code; of a command line that cannot be read, one sentence on stderr."""
    try:
        code = app(arguments, prog_name="revchain", standalone_mode=False)
    except UNREADABLE as error:
        sentence, context = error.format_message(), error.ctx
        if "\n" in sentence:  # the help, for want of arguments; newer versions of typer have printed it
            print(sentence, file=sys.stderr)
        elif sentence:
            command = "revchain" if context is None else context.command_path
            sentence = sentence[0].lower() + sentence[1:].rstrip(".")
            print(f"revchain: {sentence}; see {command} --help", file=sys.stderr)
        return ExitCode.WRONG_USAGE
    except typer.Abort:
        return ExitCode.INTERRUPTED
    return code if isinstance(code, int) else ExitCode.OK


def show_version(wanted: bool) -> None:
    """Print the version and end."""
    if wanted:
        from .. import __version__

        print(f"revchain {__version__}")
        raise typer.Exit


@app.callback()
def common(
    version: Annotated[
        bool, typer.Option("--version", callback=show_version, is_eager=True, help="Print the version and end.")
    ] = False,
) -> None:
    """At which speeds a hanging chain whirls, in which shapes, and how sure these numbers are."""


@dataclass(frozen=True)
class Wanted:
    """What the options of a command say of its output."""

    plot: Path | None
    json: str | None
    csv: str | None
    quiet: bool
    out: Path | None = None


class Answer(Protocol):
    """What a command found, in every form in which it can be asked for."""

    @property
    def title(self) -> str: ...
    def json(self) -> str: ...
    def csv(self) -> str: ...
    def table(self) -> RenderableType: ...
    def plot(self) -> Any:
        """Axes without a title."""

    def save(self, path: Path) -> None:
        """As an .npz file."""


Found = TypeVar("Found", bound=Answer)


def answered(scene: Path, find: Callable[[], Found], wanted: Wanted) -> Found:
    """Find, write the files, print the table or what was asked for on stdout. Places to write are tried first."""
    outputs = outputs_of(scene, wanted)
    with written_aside(*(path for path, _ in outputs)) as asides:
        with told_of(scene):
            found = find()
        for aside, (path, kind) in zip(asides, outputs, strict=True):
            try:
                _write(found, aside, kind)
            except OSError as error:  # says the place that was asked for, or none
                raise OSError(error.errno, error.strerror or str(error), str(path)) from None
    if wanted.json == STDOUT:
        sys.stdout.write(found.json())
    elif wanted.csv == STDOUT:
        sys.stdout.write(found.csv())
    elif not wanted.quiet:
        console = Console()
        console.width = max(console.width, NARROWEST)
        console.print(found.table())
        for path, _ in outputs:
            print(f"wrote {path}")
    return found


@contextmanager
def told_of(scene: Path) -> Iterator[None]:
    """The scene itself has been checked: an error is of the options, or the command is not for this scene."""
    try:
        yield
    except SceneError as error:
        raise Stop(f"{scene}: {error.key}: {error.reason}", ExitCode.WRONG_USAGE) from None
    except ValueError as error:
        raise Stop(str(error), ExitCode.WRONG_USAGE) from None


def _write(found: Answer, path: Path, kind: str) -> None:
    if kind == ".json":
        path.write_text(found.json(), encoding="utf-8")
    elif kind == ".csv":
        path.write_text(found.csv(), encoding="utf-8")
    elif kind == ".npz":
        found.save(path)
    else:
        save_picture(found.plot(), found.title, path)


def save_picture(axes: Any, title: str, path: Path) -> None:
    """With its title."""
    axes.set_title(plain(title), wrap=True)
    axes.figure.savefig(path, dpi=150)


def checked_picture(plot: Path) -> None:
    """That it can be drawn."""
    if plot.suffix.lower() not in PICTURES:
        raise Stop(f"--plot: {plot} must end in {', '.join(PICTURES)}", ExitCode.WRONG_USAGE)
    require("matplotlib", "plot", "--plot")


def outputs_of(scene: Path, wanted: Wanted) -> list[tuple[Path, str]]:
    """Files to write and what goes into them; the folder is made if it is not there."""
    plot, json, csv, out = wanted.plot, wanted.json, wanted.csv, wanted.out
    if json == STDOUT and csv == STDOUT:
        raise Stop("--json - and --csv - cannot share stdout", ExitCode.WRONG_USAGE)
    outputs = [(Path(name), kind) for name, kind in ((json, ".json"), (csv, ".csv")) if name not in (None, STDOUT)]
    if plot is not None:
        checked_picture(plot)
        outputs.append((plot, plot.suffix.lower()))
    if out is not None:
        kinds = [".json", ".csv", ".npz"]
        try:
            require("matplotlib", "plot", "the picture")
            kinds.append(".png")
        except ModuleNotFoundError as error:
            print(f"revchain: no picture: {error}", file=sys.stderr)
        outputs.extend((out / f"{scene.stem}{kind}", kind) for kind in kinds)
    places = [path.resolve() for path, _ in outputs]
    if len(set(places)) < len(places):
        raise Stop("two outputs have the same name", ExitCode.WRONG_USAGE)
    if scene.resolve() in places:
        raise Stop(f"{scene}: the scene itself would be overwritten", ExitCode.WRONG_USAGE)
    if out is not None:
        out.mkdir(parents=True, exist_ok=True)
    return outputs
