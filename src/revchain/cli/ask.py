# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands that answer the questions of a scene: all of them, or one, with the keys of its table as options."""

from __future__ import annotations

import inspect
import re
import sys
from contextlib import AbstractContextManager, nullcontext, suppress
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal, get_args, get_origin

import typer
from msgspec import Meta, structs
from rich.console import Console

from ..closed_forms.governor import SleeveGovernor
from ..results.excel import pages_of, write_workbook
from ..results.files import naming, written_aside
from ..scenes.report import check_path, page_of
from ..scenes.tables import QUESTIONS, TABLES, AskExplain, Pair, Spread, Table, fields_of
from ..scenes.error import Problem, SceneError
from ..scenes.parse import written
from ..scenes.scene import EXCLUSIVE, Scene, load_scene, read
from ..scenes.system import Numbers, System, option
from ..systems.extras import require
from ..systems.units import PATTERN
from . import ExitCode
from .frame import STDOUT, Speed, Stop, app, check_speed, checked_workbook, epilog, guarded, outputs_of
from .progress import watched
from .report import Report

SceneFile = Annotated[
    Path, typer.Argument(metavar="SCENE", help="Scene file (.toml or .json); [b]revchain new[/b] writes one.")
]
Gravity = Annotated[
    str | None, typer.Option(metavar="G", help="Gravity in m/s^2 or with a unit; overrides that of the scene.")
]
Units = Annotated[str, typer.Option(metavar="deg|rad", help="Unit of angles in tables; data files have radians.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print no table and no progress bar.")]
COMMON: dict[str, tuple[Any, Any]] = {
    "gravity": (Gravity, None),
    "units": (Units, "deg"),
    "speed": (Speed, None),
    "plot": (Annotated[Path | None, typer.Option(metavar="FILE", help="Picture: .png, .svg or .pdf.")], None),
    "json": (
        Annotated[str | None, typer.Option(metavar="FILE|-", help="All numbers but mode shapes as JSON; - is stdout.")],
        None,
    ),
    "csv": (
        Annotated[str | None, typer.Option(metavar="FILE|-", help="All columns but mode shapes as CSV; - is stdout.")],
        None,
    ),
    "xlsx": (Annotated[Path | None, typer.Option(metavar="FILE", help="All numbers as a workbook: .xlsx.")], None),
    "quiet": (Quiet, False),
}


@app.command(epilog=epilog("run"))
@guarded
def run(
    scene: SceneFile,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder for reports, numbers and pictures; out/SCENE if left out.")
    ] = None,
    report: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Page with the system, all answers and pictures to hand on: .html.")
    ] = None,
    xlsx: Annotated[Path | None, typer.Option(metavar="FILE", help="All numbers as a workbook: .xlsx.")] = None,
    gravity: Gravity = None,
    units: Units = "deg",
    speed: Speed = None,
    quiet: Quiet = False,
) -> None:
    """Answer all questions of a scene; find its modes (of a governor its equilibria) if it has none."""
    wholes = checked_wholes(scene, report, xlsx) if report or xlsx else []
    checked, folder = read_scene(scene, gravity, units, speed), Path("out", scene.stem) if out is None else out
    kinds = [".txt", ".json", ".csv", ".png"]
    try:
        require("matplotlib", "plot", "the picture")
    except ModuleNotFoundError as error:
        kinds.pop()
        print(f"revchain: no picture: {error}", file=sys.stderr)
    if scene.resolve() in [(folder / f"{question}.json").resolve() for question in QUESTIONS]:
        raise Stop(f"{scene}: the scene itself would be overwritten", ExitCode.WRONG_USAGE)
    folder.mkdir(parents=True, exist_ok=True)
    failed: list[Stop] = []
    answers: dict[str, Any] = {}
    opened: AbstractContextManager[list[Path]] = written_aside(*wholes) if wholes else nullcontext([])
    with opened as asides:  # before the questions are answered
        for nth, question in enumerate(checked._questions):
            outputs = [(folder / f"{question}{kind}", kind) for kind in kinds]
            try:
                answer = _answer(scene, checked, question, None, outputs, units, quiet)
                answers[question] = answer.found
                if not quiet:
                    _show(answer, outputs, heading=nth == 0)
                answer.check(scene)
            except Stop as stop:
                answers.setdefault(question, str(stop).removeprefix(f"{scene}: ").removeprefix(f"{question}: "))
                failed.append(stop)
        written = write_wholes(checked, answers, wholes, asides, units, gravity) if wholes else []
    if written and not quiet:
        print(f"wrote {', '.join(map(str, written))}")
    if failed:
        raise Stop("\nrevchain: ".join(map(str, failed)), max(stop.code for stop in failed))


def checked_wholes(scene: Path, report: Path | None, xlsx: Path | None) -> list[Path]:
    """The files that hold all answers, after a check that they can be made."""
    if report is not None:
        try:
            check_path("--report:", report)
        except ValueError as error:
            raise Stop(str(error), ExitCode.WRONG_USAGE) from None
    if xlsx is not None:
        checked_workbook(xlsx)
    wholes = [path for path in (report, xlsx) if path is not None]
    if scene.resolve() in [path.resolve() for path in wholes]:
        raise Stop(f"{scene}: the scene itself would be overwritten", ExitCode.WRONG_USAGE)
    return wholes


def write_wholes(
    scene: Scene, answers: dict[str, Any], wholes: list[Path], asides: list[Path], units: str, gravity: str | None
) -> list[Path]:
    """Write the report and the workbook of all answers to the temporary files beside them; return what is written.

    Without any answer there is no workbook: its temporary file is removed from the list.
    """
    options = (f' --gravity "{gravity}"' if gravity else "") + (f" --units {units}" if units != "deg" else "")
    found = {question: answer for question, answer in answers.items() if not isinstance(answer, str)}
    written = []
    for path, aside in zip(wholes, tuple(asides), strict=True):
        with naming(path):
            if path.suffix.lower() != ".xlsx":
                aside.write_text(page_of(scene, answers, units, options), encoding="utf-8")
            elif found:
                write_workbook(aside, pages_of(found, scene.title), path)
            else:
                asides.remove(aside)
                continue
        written.append(path)
    return written


def _command(question: str, table: type[Table], summary: str) -> None:
    """Add the command of a question, with an option for each key of its table."""

    def command(scene: Path, **given: Any) -> None:
        common = {name: given.pop(name) for name in COMMON if name in given}
        changed = {name: _meant(field, given[name]) for name, field in fields.items() if given[name] is not None}
        checked = read_scene(scene, common["gravity"], common["units"], common["speed"])
        outputs = outputs_of(scene, common.get("plot"), common["json"], common["csv"], common["xlsx"])
        report = _answer(scene, checked, question, changed, outputs, common["units"], common["quiet"])
        if STDOUT in (common["json"], common["csv"]):
            sys.stdout.write(report.text(".json" if common["json"] == STDOUT else ".csv"))
        elif not common["quiet"]:
            _show(report, outputs)
            if others := [name for name in checked.asks if name != question]:
                print(f"the scene also asks: {', '.join(others)}; for all of it: revchain run {scene}")
        report.check(scene)

    fields = {field.name: field for field in fields_of(table)}
    options = {name: (_option(field, "first" in fields), None) for name, field in fields.items()} | COMMON
    if question == "explain":
        del options["plot"]
    kind = inspect.Parameter.KEYWORD_ONLY
    scene = inspect.Parameter("scene", kind, annotation=SceneFile)
    others = [inspect.Parameter(name, kind, annotation=hint, default=x) for name, (hint, x) in options.items()]
    command.__signature__ = inspect.Signature([scene, *others])  # type: ignore[attr-defined]
    command.__annotations__ = {each.name: each.annotation for each in (scene, *others)}
    command.__doc__ = summary
    app.command(name=question, epilog=epilog(question))(guarded(command))


def _option(field: structs.FieldInfo, of_modes: bool) -> Any:
    """The option of a command that stands for a key of a table."""
    help_text = next(part.description for part in get_args(field.type) if isinstance(part, Meta) and part.description)
    if of_modes and field.name in EXCLUSIVE:
        help_text += " The count, first and windows of the scene do not apply."
    help_text = help_text.replace("[", "\\[")
    name = option(field.encode_name)
    default: Any = field.default if isinstance(field.default, (bool, int, str)) else None
    if bool in get_args(field.type):
        shown = name[2:] if default else f"no-{name[2:]}"
        return Annotated[bool | None, typer.Option(f"{name}/--no-{name[2:]}", help=help_text, show_default=shown)]
    choices = [get_args(part) for part in get_args(field.type) if get_origin(part) is Literal]
    metavar = "|".join(map(str, choices[0])) if choices else _FORMS.get(_form(field), "X")
    known = default is not None and str(default)
    return Annotated[str | None, typer.Option(name, metavar=metavar, help=help_text, show_default=known)]


_FORMS = {Pair: '"LOW to HIGH"', Spread: 'X|"FROM to TO in N"|"X; Y; ..."', list: '"X; Y; ..."'}


def _form(field: structs.FieldInfo) -> Any:
    """The kind of a value: a pair, a spread, a list, or None for a single one."""
    text = str(field.type)
    return Pair if "tuple[" in text else Spread if "Spread" in text else list if "list[" in text else None


def _meant(field: structs.FieldInfo, given: Any) -> Any:
    """The value of an option in the form of a scene file."""
    if not isinstance(given, str):
        return given
    form = _form(field)
    if form in (Spread, list) and "," in given:
        sentence = f'a list has semicolons, such as "1; 2", and the decimal mark is a point, got {given}'
        raise Stop(f"{option(field.encode_name)}: {sentence}", ExitCode.WRONG_USAGE)
    if form is Pair:
        if " to " not in given:
            return [0, _number(given)]
        return _of_one_unit(field, [_number(part) for part in re.split(r"\s+to\s+", given)], " to ")
    if form is Spread and (found := re.fullmatch(r"(.*\S)\s+to\s+(.*?\S)(?:\s+in\s+(\d{1,9}))?", given)):
        steps = {"steps": int(found[3])} if found[3] else {}
        first, last = _of_one_unit(field, [_number(found[1]), _number(found[2])], " to ")
        return {"from": first, "to": last, **steps}
    if form in (Spread, list) and (";" in given or form is list):
        return _of_one_unit(field, [_number(part) for part in given.split(";")], "; ")
    return _number(given)


def _of_one_unit(field: structs.FieldInfo, parts: list[Any], between: str) -> list[Any]:
    """The parts of a value; Stop if only the last has a unit."""
    *others, last = parts
    bare = any(others) and all(isinstance(part, float | int) for part in others)
    if bare and isinstance(last, str) and re.match(PATTERN, last):
        unit = re.sub(r"^\s*[-+.\d]+([eE][-+]?\d+)?\s*", "", last)
        right = between.join([*(f"{part} {unit}" for part in others), last])
        sentence = f'only the last number has a unit: write "{right}", got {between.join(map(str, parts))}'
        raise Stop(f"{option(field.encode_name)}: {sentence}", ExitCode.WRONG_USAGE)
    return parts


def _number(text: str) -> Any:
    for kind in (int, float):
        with suppress(ValueError):
            return kind(text)
    return text.strip()


def read_scene(path: Path, gravity: str | None, units: str, speed: str | None = None) -> Scene:
    if units not in ("deg", "rad"):
        raise Stop(f"--units: must be deg or rad, the unit of angles, got {units}", ExitCode.WRONG_USAGE)
    check_speed(speed)
    changed = {} if speed is None else {"speed": speed}
    if gravity is None:
        return read(path, changed) if changed else load_scene(path)
    numbers = Numbers("scene")
    numbers.value("gravity", _number(gravity), "gravity", "positive")
    if numbers.problems:
        raise Stop(f"--gravity: {numbers.problems[0].reason}", ExitCode.WRONG_USAGE)
    return read(path, {"gravity": _number(gravity), **changed})


def _answer(
    path: Path,
    scene: Scene,
    question: str,
    changed: dict[str, Any] | None,
    outputs: list[tuple[Path, str]],
    units: str,
    quiet: bool,
) -> Report:
    """Answer one question and write the files, which are opened first. `changed` are options, None without any."""
    with written_aside(*[file for file, _ in outputs]) as asides:
        found = answer_of(path, scene, question, changed, quiet)
        report = Report(scene, path.stem, question, found, units, None if changed is None else changed.get("count"))
        report.write(outputs, asides)
    return report


def answer_of(path: Path, scene: Scene, question: str, changed: dict[str, Any] | None, quiet: bool) -> Any:
    """The result; Stop where the system has no answer.

    `changed` are the options given to the command of the question, which messages name; None for other commands.
    """
    if sentence := without_answer(question, scene.system(), path):
        raise Stop(f"{path}: {sentence}", ExitCode.WRONG_USAGE)
    ask = partial(scene._answer, question, changed or {}, options=changed is not None)
    try:
        if question == "modes":
            return watched(lambda progress: ask(progress), Console(stderr=True), quiet)
        return ask()
    except SceneError as error:
        lines = [f"{path}: {_line(each, question, changed)}" for each in error.problems]
        raise Stop("\nrevchain: ".join(lines), ExitCode.WRONG_USAGE) from None


def _show(report: Report, outputs: list[tuple[Path, str]], heading: bool = True) -> None:
    report.print(Console(), heading)
    print(f"wrote {', '.join([str(file) for file, _ in outputs])}\n" if outputs else "", end="")


def _line(problem: Problem, question: str, changed: dict[str, Any] | None) -> str:
    line, column, key, reason = problem
    if line:
        return f"line {line}, column {column}: {key}: {reason}"
    name, dot, part = key.partition(f"ask.{question}.")[2].partition(".")
    name, bracket, index = name.partition("[")
    if changed is None or not name:
        return f"{key}: {reason}" if key and (changed is None or key != f"ask.{question}") else reason
    value = changed.get(name)
    if bracket:
        is_pair = _form(next(each for each in fields_of(TABLES[question]) if each.name == name)) is Pair
        place = int(index.rstrip("]"))
        reason = f"{('LOW', 'HIGH')[place] if is_pair else f'item {place + 1}'} {reason}"
    elif dot:
        reason = f"{_PARTS.get(part, part)} {reason}"
    elif isinstance(value, list):
        typed = (" to " if "pair" in reason else "; ").join(map(str, value))
        reason = reason.replace(written(value), typed).replace("a pair [low, high]", '"LOW to HIGH"')
    return f"{option(name)}: {reason}"


_PARTS = {"from": "FROM", "to": "TO", "steps": "N"}  # of a range, as in the help


_SHAPES = (
    'ask for its shapes: revchain shapes {path} --angular-speed "60 rpm", '
    'or write [ask.shapes] and angular_speed = "60 rpm" in the scene'
)
_MODES = "ask for its modes: revchain modes {path}"
_CUT = "cut it into links: [tapered_chain] with count = 100 and exponent = density, instead of [cord]"
_ARM = 'give it an arm: [support] and radius = "2 m"'
_NO_ANSWER = {  # by question, and what hangs
    "modes": {"bent": _SHAPES},
    "explain": {"bent": _SHAPES},
    "shapes": {},
    "response": {"cord": _CUT, "bent": _SHAPES, "held": _MODES},
    "swing": {"bent": _SHAPES, "held": _MODES},
    "branches": {"held": _SHAPES},
    "campbell": {"cord": _CUT, "bent": _SHAPES, "held": _MODES},
    "drag": {"chain": _ARM, "cord": _CUT, "bent": _SHAPES, "held": _MODES},
    "equilibria": {"chain": _MODES, "rig": _MODES, "cord": _MODES, "bent": _SHAPES, "held": _MODES},
}
_NAMES = {
    "rig": "a chain with a support, standing links, flywheels or a fluid",
    "bent": "a chain or cord whose ends are held a span apart",
    "held": "a chain or cord held at both ends",
    "cord": "a cord",
    "chain": "a chain",
    "governor": "a governor",
}
_GOVERNOR = "ask for its equilibria: revchain equilibria {path}"


def without_answer(question: str, system: System, path: Path) -> str:
    """The reason why a question has no answer for a system, and what to do instead; empty if it has one."""
    if isinstance(system, SleeveGovernor):
        kind, instead = "governor", "" if question == "equilibria" else _GOVERNOR
    else:
        kind = "bent" if system._is_held and getattr(system, "span", None) is not None else system._kind.partition(" ")[0]
        instead = _NO_ANSWER[question].get(kind, "")
    instead = instead.format(path=path)
    return f"{question}: no answer for {_NAMES[kind]}; {instead}" if instead else ""


_SUMMARIES = {
    "modes": "Find the whirl speeds (natural frequencies) and mode shapes.",
    "shapes": "Find the steady shapes (relative equilibria) at one speed, at any inclination.",
    "response": "Find the forced motion of each pin when the support moves in a small circle or to and fro.",
    "swing": "Find the small oscillations after release, or while the support is moved.",
    "branches": "Find the bifurcation diagram: the branches of steady shapes up to a speed.",
    "campbell": "Find the frequencies of small motion about a steady shape against the speed (Campbell diagram).",
    "drag": "Find the steady shape of a chain that an arm carries round through still air, and the torque.",
    "equilibria": "Find the equilibria of a governor: at one speed, or those between its stops.",
}
for _question, _table in QUESTIONS.items():
    _command(_question, _table, _SUMMARIES[_question])
_command("explain", AskExplain, "List the methods that can find the modes for a tolerance, and their cost.")
