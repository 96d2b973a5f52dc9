# SPDX-License-Identifier: GPL-3.0-or-later
"""Files as version 1.0.0 writes them, and its public names: tests/data/1.0. Run once, with that release, and never again.

    python tests/data/make_1_0.py

Every later version reads these files and answers these questions (tests/python/test_files_of_1_0.py). A version that writes
other files gets a folder and a program of its own beside this one.

    written.tar.xz   results/*.npz and *.nc from `save`; results/*.json, the `to_dict()` of each; answers/SCENE/*.json from
                     `revchain run` of each scene, and first lines of *.csv; studies/*.nc from `revchain sweep`
    interface.json   names, parameters and attributes in Python, names in C++, options of the commands, exit codes, keys of
                     scenes and studies
    scenes, *.toml   written by hand: together they have every key of scene and study files
"""

from __future__ import annotations

import inspect
import json
import re
import sys
import tarfile
import tempfile
import tomllib
from collections.abc import Callable
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any

import revchain as rc
from revchain.cli import ExitCode
from revchain.scenes.scene import json_schema
from revchain.studies.study import study_schema

FOLDER = Path(__file__).resolve().parent / "1.0"
STUDIES = ("study.toml", "study_of_shapes.toml")

TWO = rc.Chain(mass=[1.0, 2.0], length=[0.5, 0.7], centroid=[0.4, 0.2], radius_of_gyration=0.1, names=["bob", "arm"])
WEIGHTS = rc.Chain(weight=[3.0, 1.0], length=1.0, order="support first")
RODS = rc.Chain.uniform_rods(3, length=1.0, mass=1.0)
WHEEL = rc.Rig(TWO, flywheels=rc.Flywheel(momentum=0.2, axial_moment=0.01), support=rc.Support(stiffness=50.0, mass=0.3))
JOINTS = rc.Pin(stiffness=[0.0, 2.0], damping=0.1)
DAMPED = rc.Rig(TWO, pins=JOINTS, support=rc.Support(stiffness=50.0, damping=1.0), drag=0.2)
ARM = rc.Rig(TWO, support=rc.Support(radius=0.4))
FLOAT = rc.Rig(WEIGHTS, displaced=rc.Displaced(weight=[1.0, 0.4], centroid=0.9, added_weight=0.1))
TURNING = rc.Rig(WEIGHTS, displaced=rc.Displaced(weight=[1.0, 0.4]), fluid="turning", support=rc.Support(stiffness=5.0))
SPUN = rc.Flywheel(mass=0.5, radius_of_gyration=0.1, spin=500.0)
STANDING = rc.Rig(rc.Chain(mass=[1.0, 1.0], length=0.5), inverted=[True, False], flywheels=SPUN)
CORD = rc.Cord(1.0, mass=2.0, tip_mass=0.1)
CLASP = rc.Cord(1.0, mass=1.0, masses={0.5: 0.2}, tip_mass=0.1, tip_centroid=0.02, tip_radius_of_gyration=0.01)
SPAN = rc.Held(RODS, span=0.7, lower=rc.Support(radius=0.1), upper=rc.Support(stiffness=400.0, mass=0.1))
TAUT = rc.Held(TWO, tension=60.0)
ROPE = rc.Held(rc.Cord(1.0, mass=1.0), span=0.7)
STRING = rc.Held(rc.Cord(1.0, mass=1.0), tension=20.0, weightless=True)
BELL = rc.Chain(mass=[18.0, 500.0], length=[0.65, 0.15], centroid=0.3, radius_of_gyration=0.1)
GOVERNOR = rc.SleeveGovernor(
    ball_mass=1.5, arm=0.12, pivot_offset=0.12, sleeve_arm=0.06, sleeve_mass=2.0, spring_stiffness=5000.0,
    spring_force=150.0, lowest_inclination=-0.2, highest_inclination=0.3,
)  # fmt: skip
MEASURED = {1: (3.3, "2 %"), 2: (8.4, "2 %")}


@cache
def asked(name: str) -> Any:
    """The answer to a question of the list below."""
    return QUESTIONS[name]()


QUESTIONS: dict[str, Callable[[], Any]] = {
    "modes": lambda: rc.modes(TWO, certify=True),
    "modes_certificate": lambda: asked("modes").certificate,
    "modes_sensitivity": lambda: asked("modes").sensitivity,
    "modes_uncertainty": lambda: asked("modes").uncertainty(mass="3 %", worst=True),
    "modes_worst_case": lambda: asked("modes_uncertainty").worst,
    "modes_by_weight": lambda: rc.modes(WEIGHTS, "all", gravity=1.62),
    "modes_double_double": lambda: rc.modes(WEIGHTS, precision="double-double"),
    "modes_of_none": lambda: rc.modes(TWO, conical_height=(50.0, 60.0)),
    "modes_of_wheels": lambda: rc.modes(WHEEL),
    "modes_of_wheels_sensitivity": lambda: asked("modes_of_wheels").sensitivity,
    "modes_standing": lambda: rc.modes(STANDING),
    "modes_standing_other": lambda: asked("modes_standing").other,
    "modes_damped": lambda: rc.modes(DAMPED),
    "modes_floating": lambda: rc.modes(FLOAT),
    "modes_in_turning_fluid": lambda: rc.modes(TURNING),
    "modes_of_cord": lambda: rc.modes(CORD, 2),
    "modes_of_cord_with_clasp": lambda: rc.modes(CLASP, 1),
    "modes_taut": lambda: rc.modes(TAUT),
    "modes_of_string": lambda: rc.modes(STRING, 2),
    "shapes": lambda: rc.steady_shapes(TWO, angular_speed=5.0),
    "shape": lambda: asked("shapes")[0],
    "shape_sensitivity": lambda: asked("shape").sensitivity,
    "shape_stability": lambda: asked("shape").stability(),
    "shape_force_diagram": lambda: asked("shape").force_diagram(),
    "shapes_on_arm": lambda: rc.steady_shapes(ARM, angular_speed=3.0),
    "shapes_held": lambda: rc.steady_shapes(SPAN, angular_speed=12.0),
    "shape_held": lambda: asked("shapes_held")[0],
    "shape_of_cord": lambda: rc.steady_shape(CORD, mode=1, lowest_inclination=0.5),
    "shape_of_rope": lambda: rc.steady_shapes(ROPE, angular_speed=9.0)[0],
    "branches": lambda: rc.branches(TWO, max_angular_speed=5.0),
    "branch": lambda: asked("branches")[0],
    "branches_stability_windows": lambda: asked("branches").stability_windows(),
    "branches_on_arm": lambda: rc.branches(ARM, max_angular_speed=1.5),
    "branch_of_cord": lambda: rc.branch(CORD, 1, max_angular_speed=4.3),
    "response": lambda: rc.response(TWO, angular_speed=[2.0, 5.0]),
    "response_damped": lambda: rc.response(DAMPED, angular_speed=[2.0, 5.0]),
    "swing": lambda: rc.swing(TWO, [0.0, 1.0], offset=[0.1, 0.05]),
    "swing_of_wheels": lambda: rc.swing(WHEEL, [0.0, 1.0], offset=[0.1 + 0.05j, 0.05, 0.0]),
    "swing_of_cord": lambda: rc.swing(CORD, [0.0, 1.0], offset=[0.1, 0.0], count=4),
    "swing_under_moved_support": lambda: rc.swing(DAMPED, [0.0, 1.0], support=rc.SupportMotion([0, 1], force=[1.0, 0.0])),
    "campbell": lambda: rc.campbell(ARM, [1.0, 2.0, 3.0]),
    "drag_shape": lambda: rc.drag_shape(ARM, rc.Drag(coefficient=1.0, diameter=0.05), angular_speed=3.0),
    "tuned": lambda: rc.tune(TWO, vary="links[bob].mass", angular_speed=3.4),
    "fitted": lambda: rc.fit(TWO, MEASURED, vary=["links[0].mass"]),
    "explanation": lambda: rc.explain(rc.Chain.uniform_rods(5000), 2, rtol=1e-3),
    "buffer_impact": lambda: rc.BufferImpact(front_mass=1, rear_mass=3, buffer_stiffness=10, coupling_stiffness=1, speed=2),
    "governor_motion": lambda: rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=1.5),
    "governor_equilibria": lambda: GOVERNOR.equilibria(angular_speed=30.0),
    "skipping_rope": lambda: rc.SkippingRope(span=2.0, length=3.0, angular_speed=12.0, half_waves=2),
    "tortuous_rope": lambda: rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=5.0, tension=2.0),
    "funicular_polygon": lambda: rc.funicular_polygon([1.0, 2.0], [0.0, 1.0, 2.0, 3.0], 1.0),
    "transverse_modes": lambda: rc.transverse_modes([1.0, 2.0], [0.0, 1.0, 2.0, 3.0], 1.0),
    "bell_and_clapper": lambda: rc.bell_and_clapper(BELL),
    "pair_shape": lambda: rc.two_links.link_on_thread_shapes(2.0, 1.0, 1.0, height=0.5)[0],
}
NETCDF = ("modes_damped", "shapes_held")  # also saved as .nc


def run(*arguments: object) -> int:
    """Run a command line; its exit code."""
    from revchain.cli.app import run as command

    return command([str(argument) for argument in arguments])


def scenes() -> list[Path]:
    return sorted((FOLDER / "scenes").glob("*.toml"))


def parameters(thing: Any) -> list[str] | None:
    """Names of the parameters in order, with "*" before those by keyword alone, and "=" and the default if there is one."""
    try:
        given = inspect.signature(thing).parameters.values()
    except (TypeError, ValueError):
        return None
    kinds = inspect.Parameter
    keyword = {kinds.KEYWORD_ONLY: "*", kinds.VAR_KEYWORD: "**", kinds.VAR_POSITIONAL: "*"}

    def default(value: Any) -> str:
        if value is inspect.Parameter.empty:
            return ""
        return f"={value!r}" if value is None or isinstance(value, bool | int | float | str) else "="

    return [f"{keyword.get(each.kind, '')}{each.name}{default(each.default)}" for each in given]


def described(thing: Any) -> Any:
    """A public name: parameters of a function, attributes of a class with those of its methods, names of a module."""
    if isinstance(thing, ModuleType):
        return {name: described(getattr(thing, name)) for name in thing.__all__}
    if not isinstance(thing, type):
        return parameters(thing)
    found = {"": parameters(thing)} if thing.__init__ is not object.__init__ else {}
    for name in dir(thing):
        if name[0] != "_" and not hasattr(BaseException, name):
            value = inspect.getattr_static(thing, name)
            value = value.__func__ if isinstance(value, classmethod | staticmethod) else value
            found[name] = parameters(value) if inspect.isfunction(value) else None
    return found


def keys(schema: dict[str, Any]) -> dict[str, list[str]]:
    """The keys of each table of a schema."""
    return {name: sorted(table["properties"]) for name, table in schema["$defs"].items() if "properties" in table}


def names_in_headers() -> dict[str, list[str]]:
    """The public names of each C++ header, from the index of the reference."""
    found: dict[str, list[str]] = {}
    text = (FOLDER.parents[2] / "docs" / "reference" / "cpp.md").read_text(encoding="utf-8")
    for name, header in re.findall(r"(?m)^\| `([\w:~]+)` \| \[(\w+\.hpp)\]", text):
        found.setdefault(header, []).append(name)
    return found


def interface() -> dict[str, Any]:
    """The public names of the installed version."""
    from typer.main import get_command

    from revchain.cli.app import app

    commands = get_command(app).commands  # type: ignore[attr-defined]
    return {
        "c++": names_in_headers(),
        "python": {name: described(getattr(rc, name)) for name in sorted({*dir(rc), *rc._RECEIVED} - {"__version__"})},
        "command_line": {
            name: sorted(option for each in command.params for option in each.opts + each.secondary_opts)
            for name, command in sorted(commands.items())
        },
        "exit_codes": {code.name: code.value for code in ExitCode},
        "scene": keys(json_schema()),
        "study": keys(study_schema()),
    }


def tables_written() -> dict[str, set[str]]:
    """The keys that the scenes and studies of the folder give, by table."""
    found: dict[str, set[str]] = {}

    def see(value: Any, raw: Any) -> None:
        if isinstance(raw, list) and isinstance(value, list | tuple):
            for pair in zip(value, raw, strict=True):
                see(*pair)
        elif isinstance(raw, dict) and isinstance(value, dict):
            for key in raw:
                see(value[key], raw[key])
        elif isinstance(raw, dict):
            found.setdefault(type(value).__name__, set()).update(raw)
            names = dict(zip(value.__struct_encode_fields__, value.__struct_fields__, strict=True))
            for key in raw:
                see(getattr(value, names[key]), raw[key])

    for path in scenes():
        see(rc.load_scene(path), tomllib.loads(path.read_text()))
    for name in STUDIES:
        see(rc.load_study(FOLDER / name), tomllib.loads((FOLDER / name).read_text()))
    return found


def plain(member: tarfile.TarInfo) -> tarfile.TarInfo:
    member.mtime, member.uid, member.gid, member.uname, member.gname = 0, 0, 0, "", ""
    return member


def main() -> None:
    if rc.__version__ != "1.0.0":
        sys.exit(f"these are the files of version 1.0.0, and this is {rc.__version__}")
    written = tables_written()
    if missing := {
        name: left
        for name, all_keys in (keys(json_schema()) | keys(study_schema())).items()
        if (left := set(all_keys) - written.get(name, set()))
    }:
        sys.exit(f"no scene or study gives {missing}")
    with tempfile.TemporaryDirectory() as work:
        results, answers, studies = (Path(work) / name for name in ("results", "answers", "studies"))
        results.mkdir()
        studies.mkdir()
        for name in QUESTIONS:
            found = asked(name)
            data = found.to_dict()  # before it is saved: fields that were computed are saved, too
            (results / f"{name}.json").write_text(json.dumps(data))
            found.save(results / f"{name}.npz")
            if name in NETCDF:
                found.save(results / f"{name}.nc")
        for path in scenes():
            if code := run("run", path, "--out", answers / path.stem):
                sys.exit(f"{path} ends with {code}")
        for name in STUDIES:
            run("sweep", FOLDER / name, "--out", studies / Path(name).with_suffix(".nc"))
        (FOLDER / "interface.json").write_text(json.dumps(interface(), indent=0, separators=(",", ":")) + "\n")
        with tarfile.open(FOLDER / "written.tar.xz", "w:xz", preset=9) as archive:
            for path in sorted(Path(work).rglob("*.*"), key=lambda path: (path.suffix, path)):
                if path.suffix == ".csv":
                    path.write_text(path.read_text().partition("\n")[0] + "\n")
                if path.suffix in (".json", ".csv", ".npz", ".nc"):
                    archive.add(path, path.relative_to(work).as_posix(), filter=plain)


if __name__ == "__main__":
    main()
