# SPDX-License-Identifier: GPL-3.0-or-later
"""The commands for shapes and motions: what a scene asks under `[ask.shapes]`, `[ask.response]`, `[ask.swing]`."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any

import typer
from rich.console import RenderableType

from ..results.sheet import Sheet
from ..scenes.scene import Scene, load_scene
from .exit_codes import ExitCode
from .frame import EXIT_CODES, Stop, Wanted, answered, app, guarded
from .report import csv_text, json_text, table
from .report_motion import sheet_of

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

    def find(read: Scene) -> Any:
        of_others = {"sense": sense, "any_posture": any_posture or None} if read.is_held else {"half_waves": half_waves}
        refuse_any(of_others, "a chain held at both ends" if read.is_held else "a chain that hangs")
        return read.steady_shapes(**changed)

    answer(scene, find, Wanted(plot, json, csv, quiet))


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
    answer(scene, lambda read: read.response(**changed), Wanted(plot, json, csv, quiet))


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
    answer(scene, lambda read: read.small_oscillation(**changed), Wanted(plot, json, csv, quiet))


def refuse_any(options: dict[str, Any], hung: str) -> None:
    """Options that were given and say nothing of what the scene holds."""
    for name in _given(options):
        raise Stop(f"--{name.replace('_', '-')} is not for {hung}", ExitCode.WRONG_USAGE)


def _given(options: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in options.items() if value is not None}


@dataclass(frozen=True)
class _Motion:
    """Shapes or a motion, or modes between two held ends, as the commands show them."""

    found: Any
    title: str
    gravity: float

    @cached_property
    def sheet(self) -> Sheet:
        """All that is shown and written."""
        return sheet_of(self.found, self.gravity)

    def json(self) -> str:
        return json_text(self.sheet, self.title)

    def csv(self) -> str:
        return csv_text(self.sheet)

    def table(self) -> RenderableType:
        return table(self.sheet, self.title)

    def plot(self) -> Any:
        return self.found.plot()

    def save(self, path: Path) -> None:
        raise NotImplementedError  # no command that finds them has --out


def answer(scene: Path, find: Callable[[Scene], Any], wanted: Wanted) -> None:
    """Find it in the scene, write the files, print the table."""
    read = load_scene(scene)
    title, gravity = read.title or scene.stem, read.gravity_value()
    motion = answered(scene, lambda: _Motion(find(read), title, gravity), wanted)
    if not motion.sheet.good:
        raise Stop("not proved to be all there is", ExitCode.TOLERANCE_NOT_MET)
