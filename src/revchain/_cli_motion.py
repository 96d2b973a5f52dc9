# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands for shapes and motions: what a scene asks under `[ask.shapes]`, `[ask.response]`, `[ask.swing]`."""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import Console

from ._cli_frame import EXIT_CODES, STDOUT, Stop, app, guarded, outputs_of
from ._exit_codes import ExitCode
from ._files import written_aside
from ._report import NARROWEST
from ._report_motion import Found, csv_text, json_text, sheet_of, table
from ._scene_error import SceneError
from .scene import Scene, load_scene

SceneFile = Annotated[
    Path, typer.Argument(metavar="SCENE", help="Scene file (.toml or .json); [b]revchain new[/b] writes one.")
]
Plot = Annotated[Path | None, typer.Option(metavar="FILE", help="Picture: .png, .svg or .pdf.")]
Json = Annotated[str | None, typer.Option(metavar="FILE|-", help="All numbers as JSON; - is stdout.")]
Csv = Annotated[str | None, typer.Option(metavar="FILE|-", help="All numbers as CSV; - is stdout.")]
Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="No table.")]


@app.command(epilog=EXIT_CODES)
@guarded
def shapes(
    scene: SceneFile,
    angular_speed: Annotated[
        float | None, typer.Option(metavar="N", help="The speed in rad/s, instead of the scene's.")
    ] = None,
    conical_height: Annotated[float | None, typer.Option(metavar="H", help="Instead: g / n^2, in m.")] = None,
    sense: Annotated[int | None, typer.Option(metavar="1|-1", help="Of the rotation; it matters to flywheels.")] = None,
    any_posture: Annotated[bool, typer.Option("--any-posture", help="Also shapes in which links turn over.")] = False,
    half_waves: Annotated[
        int | None, typer.Option(metavar="K", help="Between two held ends: shapes of 1 to K half waves.")
    ] = None,
    plot: Plot = None,
    json: Json = None,
    csv: Csv = None,
    quiet: Quiet = False,
) -> None:
    """Find every steady shape at one speed, at any inclination."""
    given = {"angular_speed": angular_speed, "conical_height": conical_height, "sense": sense, "half_waves": half_waves}
    if angular_speed is not None and conical_height is not None:
        raise Stop("--angular-speed and --conical-height cannot both say the speed", ExitCode.WRONG_USAGE)
    changed = _given(given) | ({"hanging_only": False} if any_posture else {})
    answer(scene, lambda read: read.steady_shapes(**changed), plot, json, csv, quiet)


@app.command(epilog=EXIT_CODES)
@guarded
def response(
    scene: SceneFile,
    angular_speed: Annotated[
        tuple[float, float] | None, typer.Option(metavar="FROM TO", help="Speeds in rad/s, instead of the scene's.")
    ] = None,
    conical_height: Annotated[
        tuple[float, float] | None, typer.Option(metavar="FROM TO", help="Instead: g / n^2 of them, in m.")
    ] = None,
    steps: Annotated[int | None, typer.Option(metavar="K", min=1, help="How many speeds.")] = None,
    support_radius: Annotated[float | None, typer.Option(metavar="R", help="Of the circle, in m.")] = None,
    plot: Plot = None,
    json: Json = None,
    csv: Csv = None,
    quiet: Quiet = False,
) -> None:
    """Find how far each pin goes out when the support is carried round a small circle, or to and fro."""
    given = {"angular_speed": angular_speed, "conical_height": conical_height, "steps": steps}
    if angular_speed is not None and conical_height is not None:
        raise Stop("--angular-speed and --conical-height cannot both say the speeds", ExitCode.WRONG_USAGE)
    changed = _given({**given, "support_radius": support_radius})
    answer(scene, lambda read: read.response(**changed), plot, json, csv, quiet)


@app.command(epilog=EXIT_CODES)
@guarded
def swing(
    scene: SceneFile,
    until: Annotated[float | None, typer.Option(metavar="T", help="To this time in s, instead of the scene's.")] = None,
    steps: Annotated[int | None, typer.Option(metavar="K", min=1, help="How many times.")] = None,
    modes: Annotated[int | None, typer.Option(metavar="K", help="Only so many of the slowest modes.")] = None,
    plot: Plot = None,
    json: Json = None,
    csv: Csv = None,
    quiet: Quiet = False,
) -> None:
    """Let the chain go where the scene says, and see it swing: small oscillations in a plane."""
    changed = _given({"until": until, "steps": steps, "modes": modes})
    answer(scene, lambda read: read.small_oscillation(**changed), plot, json, csv, quiet)


def _given(options: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in options.items() if value is not None}


def answer(
    scene: Path, find: Callable[[Scene], Any], plot: Path | None, json: str | None, csv: str | None, quiet: bool
) -> None:
    """Find, write the files, print the table."""
    read = load_scene(scene)
    outputs = outputs_of(scene, plot, json, csv, None)
    title, gravity = read.title or scene.stem, read.gravity_value()
    with written_aside(*(path for path, _ in outputs)) as asides:
        try:
            found = find(read)
        except SceneError as error:
            raise SceneError(str(scene), error.key, error.reason) from None
        except ValueError as error:  # the scene itself has been checked: it is what the options say
            raise Stop(str(error), ExitCode.WRONG_USAGE) from None
        for aside, (_, kind) in zip(asides, outputs, strict=True):
            write_motion(found, aside, kind, title, gravity)
    print_motion(found, title, gravity, json, csv, quiet, [str(path) for path, _ in outputs])
    if not sheet_of(found, gravity).good:
        raise Stop("not proved to be all there is", ExitCode.TOLERANCE_NOT_MET)


def print_motion(
    found: Found, title: str, gravity: float, json: str | None, csv: str | None, quiet: bool, written: list[str]
) -> None:
    """To stdout what was asked for there."""
    if json == STDOUT:
        sys.stdout.write(json_text(found, title, gravity))
    elif csv == STDOUT:
        sys.stdout.write(csv_text(found, gravity))
    elif not quiet:
        console = Console()
        console.width = max(console.width, NARROWEST)
        console.print(table(found, title, gravity))
        for path in written:
            print(f"wrote {path}")


def write_motion(found: Found, path: Path, kind: str, title: str, gravity: float) -> None:
    """One file."""
    if kind == ".json":
        path.write_text(json_text(found, title, gravity), encoding="utf-8")
    elif kind == ".csv":
        path.write_text(csv_text(found, gravity), encoding="utf-8")
    else:
        axes = found.plot()
        axes.set_title(title, wrap=True)
        figure: Any = axes.figure
        figure.savefig(path, dpi=150)
