# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands, by typer. What they print is in `_report`, what they ask in `scene`."""

from __future__ import annotations

import io
import json as json_module
import os
import re
import sys
from collections.abc import Callable
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Annotated, Any

import typer
from msgspec import UNSET
from rich.console import Console, RenderableType

from .. import _core
from ..questions.modes import find_modes
from ..results.files import written_aside
from ..results.modes import Modes, RigModes
from ..results.motions import Response
from ..scenes.error import SceneError
from ..scenes.scene import Scene, json_schema, load_scene
from ..studies.study import study_schema
from ..systems.rig import base_chain
from .exit_codes import ExitCode
from .frame import EXIT_CODES, STDOUT, Stop, Wanted, answered, app, guarded, run_app, told_of
from .progress import watched
from .report import csv_text, json_of, json_text, table


def run(arguments: list[str] | None = None) -> int:
    """Run the command line; the exit code is returned."""
    from . import motion, sweep  # noqa: F401  their commands come after those here

    if sys.stdout is None:  # closed by the caller
        sys.stdout = open(os.devnull, "w")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):
            stream.reconfigure(errors="replace")  # a terminal that has no line characters shows question marks
    try:
        return run_app(arguments)
    except SystemExit as end:
        return end.code if isinstance(end.code, int) else int(end.code is not None)
    except KeyboardInterrupt:
        return ExitCode.INTERRUPTED


@app.command(epilog=EXIT_CODES)
@guarded
def solve(
    scene: Annotated[
        Path, typer.Argument(metavar="SCENE", help="Scene file (.toml or .json); [b]revchain new[/b] writes one.")
    ],
    plot: Annotated[Path | None, typer.Option(metavar="FILE", help="Picture: .png, .svg or .pdf.")] = None,
    json: Annotated[str | None, typer.Option(metavar="FILE|-", help="All numbers as JSON; - is stdout.")] = None,
    csv: Annotated[str | None, typer.Option(metavar="FILE|-", help="All numbers as CSV; - is stdout.")] = None,
    out: Annotated[
        Path | None, typer.Option(metavar="DIR", help="Folder for everything: .json, .csv, .npz (with shapes), .png.")
    ] = None,
    modes: Annotated[
        str | None,
        typer.Option(metavar="K|FIRST:LAST", help="How many modes, or which by their numbers, instead of the scene's."),
    ] = None,
    conical_height: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="LOW HIGH", help="Instead: the modes with LOW < conical height <= HIGH, in m."),
    ] = None,
    angular_speed: Annotated[
        tuple[float, float] | None,
        typer.Option(metavar="LOW HIGH", help="Instead: the modes with LOW <= speed < HIGH, in rad/s."),
    ] = None,
    rtol: Annotated[float | None, typer.Option(metavar="X", help="Relative tolerance of the heights.")] = None,
    certify: Annotated[bool, typer.Option("--certify", help="Also the intervals and counts that prove them.")] = False,
    precision: Annotated[str | None, typer.Option(metavar="P", help=f"One of {', '.join(_core.PRECISIONS)}.")] = None,
    method: Annotated[str | None, typer.Option(metavar="M", help=f"One of {', '.join(_core.METHODS[1:])}.")] = None,
    quiet: Annotated[bool, typer.Option("--quiet", "-q", help="No table, no progress bar.")] = False,
) -> None:
    """Find the whirl speeds of a scene and print them as a table; of a slack chain held at both ends, its shapes."""
    given = load_scene(scene)
    chosen = {"modes": modes, "conical_height": conical_height, "angular_speed": angular_speed}
    overriding = {"rtol": rtol, "precision": precision, "method": method}
    if given.held is not UNSET:
        from .motion import answer, refuse_any

        of_others = {**chosen, **overriding, "out": out, "certify": certify or None}
        refuse_any(of_others, "a chain held at both ends")
        slack = given.held.span is not UNSET
        find: Callable[[Scene], Any] = Scene.steady_shapes if slack else Scene.modes
        return answer(scene, find, Wanted(plot, json, csv, quiet))
    hung = given._hung(str(scene))
    asked = given.asked(base_chain(hung))
    if len(named := [name for name, value in chosen.items() if value is not None]) > 0:
        if len(named) > 1:
            options = " and ".join("--" + name.replace("_", "-") for name in named)
            raise Stop(f"{options} cannot both say which modes", ExitCode.WRONG_USAGE)
        for name in ("count", "first", *chosen):
            asked.pop(name, None)
        asked |= _numbers(modes) if modes is not None else {named[0]: chosen[named[0]]}
    asked |= {name: value for name, value in overriding.items() if value is not None}
    if certify:
        asked["certify"] = True

    def solved() -> _Solved:
        carried = given.response() if given.is_carried else None
        found = watched(lambda progress: find_modes(hung, **asked, progress=progress), Console(stderr=True), quiet)
        return _Solved(found, given.title or scene.stem, carried)

    found = answered(scene, solved, Wanted(plot, json, csv, quiet, out)).found
    if found.status != "success":
        wanted = asked.get("rtol")
        asked_for = "" if wanted is None else f": asked {wanted:g}, reached {found.error_bound.max():.1e}"
        raise Stop(f"the tolerance is not met{asked_for}", ExitCode.TOLERANCE_NOT_MET)


@dataclass(frozen=True)
class _Solved:
    """Modes as the command shows them."""

    found: Modes | RigModes
    title: str
    carried: Response | None

    def json(self) -> str:
        return json_text(self.found._sheet(), self.title, self.carried)

    def csv(self) -> str:
        return csv_text(self.found._sheet())

    def table(self) -> RenderableType:
        more = []
        if self.found.certificate is not None:
            more.append(self.found.certificate._sheet())
        if isinstance(self.found, RigModes) and len(self.found.other):
            more.append(self.found.other._sheet())
        return table(self.found._sheet(brief=True), self.title, *more, carried=self.carried)

    def plot(self) -> Any:
        return self.found.plot(carried=self.carried) if isinstance(self.found, RigModes) else self.found.plot()

    def save(self, path: Path) -> None:
        self.found.save(path)


@app.command(epilog=EXIT_CODES)
@guarded
def explain(
    scene: Annotated[Path, typer.Argument(metavar="SCENE", help="Scene file (.toml or .json).")],
    rtol: Annotated[
        float | None, typer.Option(metavar="X", help="Relative tolerance of the heights, instead of the scene's.")
    ] = None,
    inclination: Annotated[
        float, typer.Option(metavar="A", help="Of the lowest link, in rad: of the shapes that grow out of the modes.")
    ] = 0.0,
    time_budget: Annotated[
        float | None, typer.Option(metavar="S", help="The most time it may take, in seconds.")
    ] = None,
    count: Annotated[int | None, typer.Option(metavar="K", help="So many modes, instead of the scene's.")] = None,
    first: Annotated[int | None, typer.Option(metavar="N", help="From this number on.")] = None,
    model: Annotated[str | None, typer.Option(metavar="NAME", help="With --solve: by this one.")] = None,
    solve: Annotated[bool, typer.Option("--solve", help="Also the heights, by the model chosen.")] = False,
    json: Annotated[bool, typer.Option("--json", help="As JSON, on stdout.")] = False,
) -> None:
    """Say which model finds the scene's heights cheapest for a tolerance, and what others would cost."""
    from ..questions.explain import explain as explain_models
    from ..questions.explain import solve as solve_cheapest

    given = load_scene(scene)
    found = None
    with told_of(scene):
        asked: dict[str, Any] = {"rtol": rtol, "inclination": inclination, "time_budget": time_budget, "first": first}
        why = explain_models(given, count, **asked)
        if solve or model is not None:
            found = solve_cheapest(given, count, model=model, **asked)
    title = given.title or scene.stem
    if json:
        answer = {} if found is None else {"answer": found.to_dict()}
        sys.stdout.write(json_of({"title": title, **why.to_dict(), **answer}))
    else:
        print(title)
        print(why)
        if found is not None:
            print(found)
    if found is not None and found.status != "success":
        raise Stop("no model keeps the tolerance", ExitCode.TOLERANCE_NOT_MET)
    if found is None and not why.meets_tolerance:
        best = f"keeps the tolerance; the best bound is {why.chosen.error_bound:.1e}" if why.chosen else "applies"
        raise Stop(f"no model {best}", ExitCode.TOLERANCE_NOT_MET)


@app.command()
@guarded
def validate(scenes: Annotated[list[Path], typer.Argument(metavar="SCENE...", help="Scene files.")]) -> None:
    """Check scene files without solving them."""
    bad = 0
    for path in scenes:
        try:
            scene = load_scene(path)
            print(f"{path}: valid: {scene._hung(str(path))!r}")
        except SceneError as error:
            bad += 1
            print(f"revchain: {error}", file=sys.stderr)
    if bad:
        raise typer.Exit(ExitCode.SCENE_INVALID)


@app.command()
@guarded
def new(
    file: Annotated[Path | None, typer.Argument(metavar="[FILE]", help="Where to write it; - is stdout.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite the file if it is there.")] = False,
    study: Annotated[bool, typer.Option("--study", help="A study, not a scene.")] = False,
) -> None:
    """Write a commented scene to start from, or a study."""
    kind, folder, command = ("study", "studies", "sweep") if study else ("scene", "scenes", "solve")
    text = files("revchain").joinpath(folder, f"new_{kind}.toml").read_text(encoding="utf-8")
    if file is None:
        file = Path(f"{kind}.toml")
    if str(file) == STDOUT:
        sys.stdout.write(text)
        return
    if file.exists() and not force:
        raise Stop(f"{file}: is there already; --force overwrites it", ExitCode.OUTPUT_FAILED)
    with written_aside(file) as [aside]:
        aside.write_text(text, encoding="utf-8")
    print(f"wrote {file}; now: revchain {command} {file}")


@app.command()
@guarded
def schema(study: Annotated[bool, typer.Option("--study", help="Of study files.")] = False) -> None:
    """Print the JSON Schema of scene files, for editors."""
    sys.stdout.write(json_module.dumps(study_schema() if study else json_schema(), indent=2) + "\n")


def _numbers(text: str) -> dict[str, Any]:
    """What ``--modes`` says."""
    found = re.fullmatch(r"(\d{1,18})(?::(\d{1,18}))?", text)
    if found is None:
        raise Stop(f"--modes: must be a number such as 5, or two such as 1000:1009, got {text}", ExitCode.WRONG_USAGE)
    if found[2] is None:
        return {"count": int(found[1])}
    first, last = int(found[1]), int(found[2])
    if last < first or first < 1:
        raise Stop(f"--modes: must be ascending and from 1 on, got {text}", ExitCode.WRONG_USAGE)
    return {"first": first, "count": last - first + 1}
