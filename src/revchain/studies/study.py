# SPDX-License-Identifier: GPL-3.0-or-later
"""Study files: a scene, and which of its numbers take which values. Read and validated by msgspec."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

from msgspec import UNSET, Meta, UnsetType, json, to_builtins

from ..scenes import parse
from ..scenes.error import SceneError
from ..scenes.scene import Scene, load_scene
from ..scenes.tables import Table
from ..systems.cord import Cord
from ..systems.numbers import file_path, integer, text
from ..systems.rig import Rig
from .axes import MAX_POINTS, Axis, Samples, Vary, axis_of, with_value
from .axes import Path as Steps
from .plan import Plan
from .points import asked_of, blocks_of, derives_speeds, goes_in_batches

__all__ = ["Study", "Vary", "load_study", "study_schema"]

Find = Literal["modes", "shapes", "response"]


class Study(Table, frozen=True):
    """A scene, and which of its numbers take which values.

    Attributes
    ----------
    scene : Scene or str
        The scene, or the name of its file, beside the study's.
    vary : dict of str to Vary
        By path into the scene, such as ``links[0].mass``. Grids are combined, each value with each; random
        numbers are drawn anew at each point.
    samples : int
        How many points with random numbers, at each point of the grids.
    seed : int
        Of the random numbers.
    find : list of {"modes", "shapes", "response"}, optional
        What is computed; what the scene asks if left out: its shapes and response, and its modes if it asks
        for nothing else, or says which.
    max_shapes : int
        How many steady shapes are kept of each point.
    error_bounds : bool, optional
        Whether to give bounds of the errors. If left out, they are given but for plain chains of up to 100
        links, whose heights come in batches (`revchain.conical_heights`, accurate to 5 ulp) without them.
    title, description : str
        For people.
    schema_version : int
        1.

    Examples
    --------
    >>> import revchain as rc
    >>> study = rc.Study.from_dict({
    ...     "scene": {"links": [{"mass": 1.0, "length": 0.5, "repeat": 2}]},
    ...     "vary": {"gravity": {"values": [1.62, 9.81]}, "links[0].length": {"from": 0.5, "to": 1.0, "steps": 3}},
    ... })
    >>> study.points
    6
    >>> rc.sweep(study)["angular_speed"][:, 0].round(4)
    array([1.3777, 1.1249, 0.9742, 3.3902, 2.768 , 2.3972])
    """

    scene: Annotated[Scene | str, Meta(description="The scene, or the name of its file, beside this one.")]
    vary: Annotated[dict[str, Vary], Meta(description="By path into the scene, such as links[0].mass.", min_length=1)]
    schema_version: Annotated[Literal[1], Meta(description="Version of this format.")] = 1
    title: Annotated[str, Meta(description="One line.")] = ""
    description: Annotated[str, Meta(description="As long as you like.")] = ""
    samples: Annotated[
        Samples | UnsetType, Meta(description="How many points with random numbers, at each point of the grids.")
    ] = UNSET
    seed: Annotated[Annotated[int, Meta(ge=0)], Meta(description="Of the random numbers.")] = 0
    find: Annotated[
        Annotated[list[Find], Meta(min_length=1)] | UnsetType,
        Meta(description="What is computed; what the scene asks if left out."),
    ] = UNSET
    max_shapes: Annotated[
        Annotated[int, Meta(ge=1, le=1000)], Meta(description="How many steady shapes are kept of each point.")
    ] = 4
    error_bounds: Annotated[
        bool | UnsetType, Meta(description="Whether to give bounds of errors; batches do not if left out.")
    ] = UNSET

    @classmethod
    def from_dict(cls, data: dict[str, Any], source: str = "study", folder: str | os.PathLike[str] = ".") -> Study:
        """Make a study from plain data, as a TOML or JSON file holds it.

        Parameters
        ----------
        data : dict
            Keys as in a study file.
        source : str
            What errors name.
        folder : path-like
            Where the file of a scene given by name is looked for.

        Returns
        -------
        Study

        Raises
        ------
        SceneError
            A ValueError that names the source, the key and what is wrong there.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 1.0}]}
        >>> rc.Study.from_dict({"scene": scene, "vary": {"links[0].mas": {"values": [1, 2]}}})
        Traceback (most recent call last):
        revchain.scenes.error.SceneError: study: vary."links[0].mas": unknown key; did you mean mass?
        """
        source = text("revchain.Study.from_dict", "source", source)
        if isinstance(data, dict):
            folder = Path(file_path("revchain.Study.from_dict", "folder", folder))
            data = {**data, **_tables(data, source, folder)}
        study = parse.convert(data, cls, source)
        study._plan(source)
        return study

    def to_dict(self) -> dict[str, Any]:
        """Return the study as plain data; what has its default is left out.

        Returns
        -------
        dict

        Examples
        --------
        >>> import revchain as rc
        >>> data = {"scene": {"links": [{"mass": 1, "length": 1}]}, "vary": {"gravity": {"values": [1, 2]}}}
        >>> rc.Study.from_dict(data).to_dict() == data
        True
        """
        data: dict[str, Any] = to_builtins(self)
        return data

    @property
    def points(self) -> int:
        """How many points there are."""
        return self._plan("study").points

    def scene_at(self, point: int) -> Scene:
        """Build the scene of one point.

        Parameters
        ----------
        point : int
            From 0; grids count with the last fastest, samples faster still.

        Returns
        -------
        Scene

        Raises
        ------
        IndexError
            If there is no such point.
        SceneError
            If the numbers of the point describe nothing that hangs.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 1.0}]}
        >>> study = rc.Study.from_dict({"scene": scene, "vary": {"links[0].length": {"values": ["1 m", "20 cm"]}}})
        >>> study.scene_at(1).system()
        Chain of 1 link, length 0.2, mass 1
        """
        plan, place = self._plan("study"), "revchain.Study.scene_at"
        point = integer(place, "point", point)
        if not 0 <= point < plan.points:
            raise IndexError(f"{place}: there are {plan.points} points from 0 on, got {point}")
        values = [column.tolist()[0] for column in plan.values(point, point + 1)]
        return Scene.from_dict(plan.scene_data(values))

    def _plan(self, source: str) -> Plan:
        """All of it checked and made ready."""
        if not isinstance(self.scene, Scene):
            raise SceneError(source, "scene", "must be a table, or be read by load_study from its file")
        scene, base = self.scene, self.scene.to_dict()
        scene._check(source)
        axes = tuple(axis_of(key, table, Scene, source) for key, table in self.vary.items())
        random = [axis for axis in axes if axis.law]
        if bool(random) != (self.samples is not UNSET):
            needs = "is missing: say how many points" if random else "is for random numbers, and none are varied"
            raise SceneError(source, "samples", needs)
        samples = 1 if isinstance(self.samples, UnsetType) else self.samples
        find = asked_of(scene, self.find, source)
        _refuse_twice(axes, source)
        for axis in axes:
            _check(base, axis, source)
        batched = find == ("modes",) and goes_in_batches(scene, [axis.path for axis in axes])
        batched = batched and self.error_bounds is not True
        bounds = not batched if isinstance(self.error_bounds, UnsetType) else self.error_bounds
        blocks = blocks_of(scene, _largest(base, axes, source), find, self.max_shapes, bounds)
        columns = {column for block in blocks for column in block.columns} | {"point", "status"}
        columns |= {block.name for block in blocks} | {"mode", "shape", "speed", "sample"}
        for axis in axes:
            if axis.name in columns:
                raise SceneError(source, f'vary."{axis.key}".name', f"{axis.name} is the name of a result")
        plan = Plan(base, axes, samples, self.seed, find, blocks, batched, derives_speeds(scene))
        if plan.points > MAX_POINTS:
            raise SceneError(source, "vary", f"makes {plan.points:,} points; at most {MAX_POINTS:,}")
        return plan


def load_study(path: str | os.PathLike[str]) -> Study:
    """Read a study from a TOML file, or from a JSON file if its name ends in ``.json``.

    Parameters
    ----------
    path : path-like
        The file. The file of a scene that it names is looked for in the same folder.

    Returns
    -------
    Study

    Raises
    ------
    SceneError
        A ValueError that names the file, and of every error the line, the column, the key and what is wrong there.

    Examples
    --------
    >>> import revchain as rc, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "study.toml"
    >>> _ = path.write_text('''
    ... scene = {links = [{mass = 1, length = 1}]}
    ... vary."links[0].length" = {from = "1 m", to = "2 m", steps = 11}
    ... ''')
    >>> rc.load_study(path).points
    11
    """
    with parse.placed(path):
        return Study.from_dict(parse.read(path), os.fspath(path), Path(path).parent)


def study_schema() -> dict[str, Any]:
    """Return the JSON Schema of study files, for editors.

    Returns
    -------
    dict

    Examples
    --------
    >>> from revchain.studies.study import study_schema
    >>> study_schema()["title"]
    'revchain study'
    """
    from ..scenes.scene import json_schema

    schema: dict[str, Any] = json.schema(Study)
    scenes = json_schema()["$defs"]
    for name, table in schema["$defs"].items():
        if name in scenes:
            schema["$defs"][name] = scenes[name]
        elif "description" in table:
            table["description"] = table["description"].partition("\n")[0]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "revchain study", **schema}


def _tables(data: dict[str, Any], source: str, folder: Path) -> dict[str, Any]:
    """The scene and the table [vary], each part checked by itself, so that errors have its key."""
    found: dict[str, Any] = {}
    scene = data.get("scene")
    if isinstance(scene, str):
        named = folder / scene
        found["scene"] = load_scene(named).to_dict()
    elif isinstance(scene, dict):
        try:
            found["scene"] = Scene.from_dict(scene, source).to_dict()
        except SceneError as error:
            within = [one._replace(key=".".join(part for part in ("scene", one.key) if part)) for one in error.problems]
            raise SceneError(source, problems=within) from None
    if isinstance(find := data.get("find"), list):
        words = list(get_args(Find))
        for k, name in enumerate(find):
            if name not in words:
                raise SceneError(source, f"find[{k}]", parse.choice(words, False, name))
    if isinstance(vary := data.get("vary"), dict):
        for key, table in vary.items():
            try:
                parse.convert(table, Vary, source)
            except SceneError as error:
                place = f'vary."{key}"' + (f".{error.key}" if error.key else "")
                raise SceneError(source, place, error.reason) from None
        if not vary:
            raise SceneError(
                source, "vary", 'is empty: say what varies, such as vary."links[0].mass" = {values = [1, 2]}'
            )
    return found


def _refuse_twice(axes: tuple[Axis, ...], source: str) -> None:
    """No path twice or inside another, no name twice."""
    for k, axis in enumerate(axes):
        for other in axes[:k]:
            if axis.name == other.name:
                raise SceneError(source, f'vary."{axis.key}".name', f"{axis.name} is the name of another, too")
            shorter: Steps = min(axis.path, other.path, key=len)
            if axis.path[: len(shorter)] == other.path[: len(shorter)]:
                raise SceneError(source, f'vary."{axis.key}"', f'is varied by vary."{other.key}", too')


def _check(base: dict[str, Any], axis: Axis, source: str) -> None:
    """Refuse what the scene would refuse of its ends, of a grid, or of a number in the middle, of random ones."""
    refuse = SceneError(source, f'vary."{axis.key}"', "")
    own = _kind(Scene.from_dict(base, source))
    for value in axis.examples():
        try:
            kind = _kind(Scene.from_dict(with_value(base, axis.path, value, refuse), source))
            if kind != own and not (kind == "a rig" and own.startswith("a rig")):  # wheels at rest have no backward modes
                raise SceneError(
                    source, refuse.key, f"makes {kind} of {own} at {value}: let the scene itself be {kind}, all points alike"
                )
        except SceneError as error:
            if error.key == refuse.key:
                raise
            elsewhere = "" if error.key in ("", axis.key) else f"{error.key}: "
            raise SceneError(source, refuse.key, f"{elsewhere}{error.reason}") from None


def _kind(scene: Scene) -> str:
    """What its results look like."""
    system = scene.system()
    if isinstance(system, Rig):
        return "a rig with flywheels that spin" if system.has_momentum else "a rig"
    return f"a {type(system).__name__.lower()}"


def _largest(base: dict[str, Any], axes: tuple[Axis, ...], source: str) -> Scene:
    """The scene with the largest of all whole numbers, and those words, that has most links."""
    for axis in axes:
        if not axis.is_number:
            refuse = SceneError(source, "vary", "")
            words = [with_value(base, axis.path, word, refuse) for word in axis.examples()]
            base = max(words, key=lambda data: _links(Scene.from_dict(data, source)))
        elif axis.values is not None and axis.values.dtype.kind == "i":
            base = with_value(base, axis.path, axis.values.max().item(), SceneError(source, "vary", ""))
    return Scene.from_dict(base, source)


def _links(scene: Scene) -> int:
    system = scene.system()
    return 0 if isinstance(system, Cord) else system.size
