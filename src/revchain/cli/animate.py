# SPDX-License-Identifier: GPL-3.0-or-later
"""The command that writes the answer of a scene as a film, a page or a 3D model."""

from __future__ import annotations

import math
import re
from contextlib import ExitStack
from pathlib import Path
from typing import Annotated

import typer

from ..motion.write import METHODS, require_for
from ..results.files import written_aside
from ..scenes.system import option
from ..scenes.tables import QUESTIONS
from ..systems.numbers import without_function
from .ask import Gravity, Quiet, SceneFile, answer_of, read_scene
from . import ExitCode
from .frame import Stop, app, epilog, guarded
from .progress import counted
from .report import Report


MOVING = [question for question in QUESTIONS if question not in ("campbell", "drag", "equilibria")]


@app.command(epilog=epilog("animate"))
@guarded
def animate(
    scene: SceneFile,
    out: Annotated[
        Path, typer.Option("--out", "-o", metavar="FILE", help="Film (.gif, .mp4), page (.html) or 3D model (.glb).")
    ],
    question: Annotated[
        str | None,
        typer.Option(
            "--ask", metavar="|".join(MOVING), help="Question to show; the first one of the scene if left out."
        ),
    ] = None,
    figures: Annotated[
        str | None,
        typer.Option(
            metavar='"1; 3"', help="Modes by number; shapes and branches by index, from 0. The first six if left out."
        ),
    ] = None,
    time_scale: Annotated[
        float | None, typer.Option(metavar="X", help="Seconds of motion in one second of film; 1 is real time.")
    ] = None,
    duration: Annotated[float | None, typer.Option(metavar="S", help="Length of the film in seconds.")] = None,
    frames_per_second: Annotated[
        float | None, typer.Option(metavar="K", help="Frames in a second of film; 25 if left out. Not for .html and .glb.")
    ] = None,
    gravity: Gravity = None,
    quiet: Quiet = False,
) -> None:
    """Show the motion: write a film, a page that plays it, or a 3D model (glTF)."""
    ending = out.suffix.lower()
    if ending not in METHODS:
        raise Stop(f"--out: {out} must end in {', '.join(METHODS)}", ExitCode.WRONG_USAGE)
    require_for(ending)
    if scene.resolve() == out.resolve():
        raise Stop(f"--out: {scene}: the scene itself would be overwritten", ExitCode.WRONG_USAGE)
    numbers = {"time_scale": time_scale, "duration": duration, "frames_per_second": frames_per_second}
    given = {name: value for name, value in numbers.items() if value is not None}
    for name, value in given.items():
        if not 0 < value < math.inf:
            raise Stop(f"{option(name)}: must be positive and finite, got {value:g}", ExitCode.WRONG_USAGE)
    if frames_per_second is not None and ending in (".html", ".glb"):
        raise Stop(f"--frames-per-second: a {ending} file has no frames; leave it out", ExitCode.WRONG_USAGE)
    which = None if figures is None else _numbers(figures)
    read = read_scene(scene, gravity, "deg")
    shown = question or next(iter(each for each in read.asks if each in MOVING), "modes")
    if shown not in MOVING:
        raise Stop(f"--ask: must be one of {', '.join(MOVING)}, got {shown}", ExitCode.WRONG_USAGE)
    with written_aside(out) as [aside], ExitStack() as stack:
        found = answer_of(scene, read, shown, None, quiet)
        try:
            getattr(found, METHODS[ending])(aside, figures=which, progress=counted(stack, "frames", quiet), **given)
        except OSError as error:  # names the file of the user, not the temporary one
            raise OSError(error.errno, error.strerror or str(error), str(out)) from None
        except ValueError as error:
            words = without_function(error)
            for name in numbers:
                words = re.sub(rf"\b{name}\b", option(name), words)
            about = "" if "--" in words else "--figures: " if which else f"{shown}: "
            raise Stop(f"{scene}: {about}{words}", ExitCode.WRONG_USAGE) from None
    if not quiet:
        print(f"wrote {out}")
    Report(read, scene.stem, shown, found, "deg").check(scene)


def _numbers(text: str) -> list[int]:
    try:
        return [int(part) for part in text.split(";")]
    except ValueError:
        raise Stop(
            f'--figures: must be whole numbers with semicolons between them, such as "1; 3", got {text}',
            ExitCode.WRONG_USAGE,
        ) from None
