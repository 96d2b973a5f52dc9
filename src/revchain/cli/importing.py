# SPDX-License-Identifier: GPL-3.0-or-later
"""The command that writes a model of a multibody engine as a scene."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Annotated

import typer

from ..exchange.findings import Blocked
from ..exchange.read import read_model
from ..results.files import written_aside
from ..scenes.parse import is_json
from ..scenes.write import scene_text
from . import ExitCode
from .frame import STDOUT, Stop, app, epilog, guarded


@app.command("import", epilog=epilog("import"))
@guarded
def import_model(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Model of MuJoCo (MJCF) or robot description (URDF).")],
    out: Annotated[
        str | None,
        typer.Option("--out", "-o", metavar="SCENE|-", help="Scene to write; FILE.toml here if left out; - is stdout."),
    ] = None,
    ignore: Annotated[
        list[str] | None,
        typer.Option(metavar='"WORD ..."|all', help="What to leave out; the list of obstacles names the words that help."),
    ] = None,
    links: Annotated[
        list[str] | None, typer.Option(metavar='"BODY ..."', help="The bodies that are the links, if the model branches.")
    ] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing scene.")] = False,
) -> None:
    """Write a model of a multibody engine (MJCF, URDF) as a scene, and list what was left out."""
    scene = Path(f"{file.stem}.toml" if out is None else out)
    if is_json(str(scene)):
        raise Stop(f"--out: the scene is TOML: its name must not end in .json, got {scene}", ExitCode.WRONG_USAGE)
    try:
        chosen = links[0] if links and len(links) == 1 else links  # each option may be given once for each word
        model = read_model(str(file), file, "", " ".join(ignore or []), chosen)
    except OSError as error:
        raise Stop(f"{file}: cannot be read: {error.strerror or error}", ExitCode.SCENE_INVALID) from None
    except Blocked as error:
        raise Stop(_as_options(str(error)).replace("\n", "\nrevchain: "), ExitCode.SCENE_INVALID) from None
    except ValueError as error:
        message = str(error).removeprefix(f"{file}: ")
        raise Stop(f"--{_as_options(message)}", ExitCode.WRONG_USAGE) from None
    if scene.resolve() == file.resolve():
        raise Stop(f"{file}: the model itself would be overwritten", ExitCode.WRONG_USAGE)
    gravity = f"gravity {model.gravity:.9g} m/s^2" + ("" if model.has_gravity else ", that of MuJoCo, as URDF has none")
    said = [
        f"{model.system.describe()}; {gravity}",
        *(line for title, each in model.said() for line in (title, *(f"  {sentence}" for sentence in each))),
    ]
    source = f"Read from {file.name}."
    missing = f"{source} Left out: {'; '.join(map(str, model.left_out))}." if model.left_out else ""  # reports show it
    text = scene_text(model.system, model.gravity, model.title or file.stem, [source, *said], missing)
    if str(scene) == STDOUT:
        sys.stdout.write(text)
        return
    if scene.exists() and not force:
        raise Stop(f"{scene}: exists already; --force overwrites it", ExitCode.OUTPUT_FAILED)
    with written_aside(scene) as [aside]:
        aside.write_text(text, encoding="utf-8")
    print("\n".join(said))
    print(f"wrote {scene}; now: revchain run {scene}")


def _as_options(message: str) -> str:
    """A message with the arguments of functions as options."""
    return re.sub(r'\b(ignore|links)=(".*?")', r"--\1 \2", message)
