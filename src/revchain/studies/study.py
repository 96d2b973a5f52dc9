# SPDX-License-Identifier: GPL-3.0-or-later
"""Study files: a scene, and which of its numbers take which values. Read and validated by msgspec."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Annotated, Any, Literal, get_args

import numpy as np
from msgspec import UNSET, Meta, UnsetType, json, to_builtins

from ..scenes import parse
from ..scenes.ask import DEFAULT_MODES
from ..scenes.error import SceneError
from ..scenes.scene import Scene
from ..scenes.tables import Table
from ..systems.numbers import file_path, integer, text
from .axes import Axis, axis_of
from .batch import goes_in_batches
from .find import Block, mode_blocks, response_blocks, shape_blocks
from .paths import Path as Steps
from .paths import with_value
from .plan import Plan
from .tables import MOST_POINTS, Samples, Vary

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
    most_shapes : int
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
    most_shapes: Annotated[
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
        >>> study.scene_at(1).chain()
        Chain of 1 link, length 0.2, weight 9.80665
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
        find = self._find(scene, source)
        _distinct(axes, source)
        for axis in axes:
            _check(base, axis, source)
        batched = find == ("modes",) and goes_in_batches(scene, [axis.path for axis in axes])
        batched = batched and self.error_bounds is not True
        bounds = not batched if isinstance(self.error_bounds, UnsetType) else self.error_bounds
        blocks: list[Block] = []
        if "modes" in find:
            blocks += mode_blocks(scene, _most_modes(scene, base, axes, source), bounds)
        if "shapes" in find:
            blocks += shape_blocks(self.most_shapes, bounds)
        if "response" in find:
            asked = scene.ask.response
            assert not isinstance(asked, UnsetType)  # else it would not be found
            blocks += response_blocks(1 if len(asked.ends) == 1 else asked.steps, bounds)
        columns = {column for block in blocks for column in block.columns} | {"point", "status"}
        columns |= {block.name for block in blocks} | {"mode", "shape", "speed", "sample"}
        for axis in axes:
            if axis.name in columns:
                raise SceneError(source, f'vary."{axis.key}".name', f"{axis.name} is the name of a result")
        plan = Plan(base, axes, samples, self.seed, find, tuple(blocks), batched)
        if plan.points > MOST_POINTS:
            raise SceneError(source, "vary", f"makes {plan.points:,} points; at most {MOST_POINTS:,}")
        return plan

    def _find(self, scene: Scene, source: str) -> tuple[str, ...]:
        """What is computed, in the order of the columns."""
        ask = scene.ask
        asked: list[str] = [name for name in ("shapes", "response") if getattr(ask, name) is not UNSET]
        if isinstance(self.find, UnsetType):
            if not asked or ask.modes is not UNSET or ask.first is not UNSET:
                asked.insert(0, "modes")
        else:
            for k, wanted in enumerate(self.find):
                if wanted not in ("modes", *asked):
                    raise SceneError(source, f"find[{k}]", f"the scene does not say at which speed: [ask.{wanted}]")
            asked = [name for name in ("modes", "shapes", "response") if name in self.find]
        for name in ("conical_height", "angular_speed"):
            if "modes" in asked and getattr(ask, name) is not UNSET:
                reason = "finds not as many modes everywhere; give modes and first"
                raise SceneError(source, f"scene.ask.{name}", reason)
        if ask.swing is not UNSET and isinstance(self.find, UnsetType):
            raise SceneError(source, "scene.ask.swing", 'is not for studies; say what is: find = ["modes"]')
        if "response" in asked and scene.is_held:
            raise SceneError(source, "scene.ask.response", "does not go with held")
        if "modes" in asked and scene.held is not UNSET and scene.held.span is not UNSET:
            raise SceneError(source, "scene.held.span", 'leaves the chain slack, without modes: find = ["shapes"]')
        return tuple(asked)


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
        A ValueError that names the file, the key and what is wrong there; for errors of syntax the
        line and the column.

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
        found["scene"] = Scene.from_dict(parse.read(named), os.fspath(named)).to_dict()
    elif isinstance(scene, dict):
        try:
            found["scene"] = Scene.from_dict(scene, source).to_dict()
        except SceneError as error:
            raise SceneError(source, ".".join(part for part in ("scene", error.key) if part), error.reason) from None
    if isinstance(find := data.get("find"), list):
        words = list(get_args(Find))
        for k, name in enumerate(find):
            if name not in words:
                raise SceneError(source, f"find[{k}]", parse._choice(words, False, name))
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


def _distinct(axes: tuple[Axis, ...], source: str) -> None:
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
    for value in _ends(axis):
        try:
            Scene.from_dict(with_value(base, axis.path, value, refuse), source)
        except SceneError as error:
            if error.key == refuse.key:
                raise
            elsewhere = "" if error.key in ("", axis.key) else f"{error.key}: "
            raise SceneError(source, refuse.key, f"{elsewhere}{error.reason}") from None


def _ends(axis: Axis) -> list[Any]:
    if axis.values is None:
        one, two = axis.law_numbers
        return [one if axis.law == "normal" else one + (two - one) / 2]
    if axis.values.dtype.kind in "fi":
        return [axis.values.min().item(), axis.values.max().item()]
    return np.unique(axis.values).tolist()  # type: ignore[no-any-return]


def _most_modes(scene: Scene, base: dict[str, Any], axes: tuple[Axis, ...], source: str) -> int:
    """For how many modes there are columns: as many as are asked, or as any point has."""
    asked = scene.ask.modes
    if isinstance(asked, int):
        return asked
    first = 1 if isinstance(scene.ask.first, UnsetType) else scene.ask.first
    for axis in axes:
        if axis.values is not None and axis.values.dtype.kind == "i":
            base = with_value(base, axis.path, axis.values.max().item(), SceneError(source, "vary", ""))
    largest = Scene.from_dict(base, source)
    there = 2 * (largest.chain().size + 1) if largest.is_rigged else largest.chain().size  # of each sense
    there = max(there - first + 1, 1)
    return there if asked == "all" else min(DEFAULT_MODES, there)
