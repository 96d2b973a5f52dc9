# SPDX-License-Identifier: GPL-3.0-or-later
"""Study files: a scene, and values for some of its numbers. They are read and validated by msgspec."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal, Self

from msgspec import UNSET, Meta, UnsetType, to_builtins

from ..closed_forms.governor import SleeveGovernor
from ..scenes import parse
from ..scenes.system import Numbers
from ..scenes.error import Problem, SceneError
from ..scenes.positions import joined
from ..scenes.scene import Scene, _named, json_schema, load_scene
from ..scenes.tables import Table, says
from ..systems.numbers import file_path, integer, text
from ..systems.paths import steps
from ..systems.units import SI, speed_unit
from .axes import LAWS, MAX_POINTS, Axis, Samples, Vary, axis_of, quantity_of, with_value
from .batch import links_of
from .plan import OUTPUTS, WAYS, Plan, answers, asked_of, columns_of, outputs_of
from .scatter import SPEEDS, Scatter, why_no_worst

__all__ = ["Study", "load_study"]

Finds = Annotated[
    list[
        Literal[
            "modes", "shapes", "response", "campbell", "drag", "equilibria", "angular_speed", "rpm", "frequency", "period"
        ]
    ],
    Meta(min_length=1),
]
MostShapes = Annotated[int, Meta(ge=1, le=1000)]


class Study(Table, frozen=True):
    """A study file: a scene, and values for some of its numbers.

    Attributes
    ----------
    scene : Scene or str
        The scene, or the path of its file, from the folder of the study.
    vary : dict of str to Vary
        Values by path into the scene, such as ``links[load].mass`` or ``links[0].mass``, with the name of a link or its
        index in the file. Grids are combined, each value with each; random numbers are drawn for each point.
    samples : int
        Number of points with random numbers at each point of the grids.
    seed : int
        Seed of the random numbers.
    find : list of {"modes", "shapes", "response", "campbell", "drag", "equilibria"}, optional
        Questions to answer; those of the scene if left out. ``"angular_speed"``, ``"rpm"``, ``"frequency"`` and ``"period"``
        store the speeds of modes in these units; with ``"modes"`` beside it also all else of modes.
    max_shapes : int
        Largest number of stored steady shapes, or equilibria of a governor, of each point.
    scatter : Scatter, optional
        With ``worst=True``: also find the proved lowest and highest speeds over intervals of uniform or log_uniform numbers.
    error_bounds : bool, optional
        Whether to store error bounds. If left out, batches have none (see `sweep`).
    title, description : str
        Texts for readers.
    schema_version : int
        Version of the format, 1.

    Examples
    --------
    >>> import revchain as rc
    >>> study = rc.Study.from_dict({
    ...     "scene": {"links": [{"mass": 1.0, "length": 0.5, "repeat": 2}]},
    ...     "vary": {"gravity": {"values": [1.62, 9.81]}, "links[0].length": {"from": 0.5, "to": 1.0, "steps": 3}},
    ... })
    >>> study.points
    6
    >>> rc.sweep(study)["angular_speed"].sel(mode=1).to_numpy().round(4)  # doctest: +SKIP
    array([[1.3777, 1.1249, 0.9742],
           [3.3902, 2.768 , 2.3972]])
    """

    scene: Annotated[Scene | str, says("The scene, or the path of its file, from the folder of this one.")]
    vary: Annotated[
        dict[str, Vary],
        Meta(description="Values by path into the scene, such as links[load].mass or links[0].mass.", min_length=1),
    ]
    schema_version: Annotated[Literal[1], says("Version of this format.")] = 1
    title: Annotated[str, says("Title in one line.")] = ""
    description: Annotated[str, says("Description of any length.")] = ""
    samples: Annotated[
        Samples | UnsetType, says("Number of points with random numbers at each point of the grids.")
    ] = UNSET
    seed: Annotated[Annotated[int, Meta(ge=0)], says("Seed of the random numbers.")] = 0
    find: Annotated[Finds | UnsetType, says('Questions to answer, or how to store speeds of modes, such as "period"; the questions of the scene if left out.')] = UNSET
    max_shapes: Annotated[MostShapes, says("Largest number of stored steady shapes or equilibria of each point.")] = 4
    error_bounds: Annotated[
        bool | UnsetType, says("Whether to store error bounds; if left out, batches have none.")
    ] = UNSET
    scatter: Annotated[Scatter, says("What to find for random numbers beside the results of each point.")] = Scatter()

    @classmethod
    def from_dict(cls, data: dict[str, Any], source: str = "study", folder: str | os.PathLike[str] = ".") -> Study:
        """Return a study from plain data, as in a TOML or JSON file.

        Parameters
        ----------
        data : dict
            Data with the keys of a study file.
        source : str
            Name to show in errors.
        folder : path-like
            Folder of the file of a scene that is given by name.

        Returns
        -------
        Study
            The study.

        Raises
        ------
        SceneError
            If the data are not a valid study (the error is a ValueError).

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 1.0}]}
        >>> rc.Study.from_dict({"scene": scene, "vary": {"links[0].mas": {"values": [1, 2]}}})
        Traceback (most recent call last):
        revchain.scenes.error.SceneError: study: vary."links[0].mas": unknown key; did you mean mass?
        """
        caller = "revchain.Study.from_dict"
        return cls._read(data, text(caller, "source", source), Path(file_path(caller, "folder", folder)), [])

    @classmethod
    def _read(cls, data: Any, source: str, folder: Path, problems: list[Problem]) -> Self:
        scene = data.get("scene") if isinstance(data, dict) else None
        if isinstance(scene, str):
            try:
                data = {**data, "scene": load_scene(folder / scene).to_dict()}
            except ValueError as error:  # a SceneError, or that the name has a null byte
                data = {**data, "scene": ""}  # so that the rest is read
                problems += [Problem(0, 0, "scene", sentence) for sentence in str(error).split("\n")]
        study = parse.convert(data, cls, source, problems)
        study._plan(source, problems)
        return study

    def to_dict(self) -> dict[str, Any]:
        """Return the study as plain data; keys at their default values may be left out.

        Returns
        -------
        dict
            The data, which `from_dict` reads.

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
        """Number of points."""
        return self._plan("study").points

    def scene_at(self, point: int) -> Scene:
        """Return the scene of one point.

        Parameters
        ----------
        point : int
            Number of the point from 0; the last grid varies faster than the others, and samples fastest.

        Returns
        -------
        Scene
            The scene with the numbers of the point.

        Raises
        ------
        IndexError
            If there is no such point.
        SceneError
            If the numbers of the point do not describe a possible system.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1.0, "length": 1.0}]}
        >>> study = rc.Study.from_dict({"scene": scene, "vary": {"links[0].length": {"values": ["1 m", "20 cm"]}}})
        >>> study.scene_at(1).system()
        Chain of 1 link, length 0.2, mass 1
        """
        plan, caller = self._plan("study"), "revchain.Study.scene_at"
        point = integer(caller, "point", point)
        if not 0 <= point < plan.points:
            raise IndexError(f"{caller}: there are {plan.points} points from 0 on, got {point}")
        return Scene.from_dict(plan.scene([column[point].item() for column in plan.values()]))

    def _speed_unit(self) -> str | None:
        """The unit of speeds in printed tables and pictures, from the scene or the study."""
        assert isinstance(self.scene, Scene)
        if not isinstance(self.scene.speed, UnsetType):
            return self.scene.speed
        speeds = [key for key in self.vary if SI[quantity_of(steps(key))][1] == "an angular speed" and key.startswith("ask.")]
        return speed_unit([to_builtins(self.vary[key]) for key in speeds]) or speed_unit(to_builtins(self.scene.ask))

    def _refusal(self, point: int) -> str:
        try:
            answers(self.scene_at(point), self._plan("study").find)
        except (ValueError, OverflowError) as error:
            return str(error).removeprefix("scene: ")
        return ""

    def _plan(self, source: str, known: Sequence[Problem] = ()) -> Plan:
        numbers, inside = Numbers(source), [one for one in known if one.key.startswith("scene.")]
        numbers.problems += [one for one in known if one not in inside]
        scene, base, find = self.scene, dict[str, Any](), tuple[str, ...]()
        vary = self.vary if isinstance(self.vary, dict) else {}
        names = [link.name for link in scene.links] if isinstance(scene, Scene) and isinstance(scene.links, list) else []
        each = [axis_of(key, table, Scene, names, numbers.of(joined("vary", key))) for key, table in vary.items()]
        axes = tuple(axis for axis in each if axis is not None)
        _refuse_twice(axes, numbers)
        random = any(getattr(table, law) is not UNSET for table in vary.values() for law in LAWS)
        if random != (self.samples is not UNSET) and not any(one.key.startswith("vary") for one in known):
            needs = "is missing: say how many points" if random else "is for random numbers, and none are varied"
            numbers.refuse("samples", needs)
        if isinstance(scene, Scene):
            inside = [one._replace(key=one.key.removeprefix("scene.")) for one in inside]
            base, wrong = scene.to_dict(), [_named(one, scene) for one in scene._problems(source, inside)]
            numbers.problems += [one._replace(key=f"scene.{one.key}".rstrip(".")) for one in wrong]
            if not wrong:
                find = asked_of(scene, self.find, numbers)
                for axis in axes:
                    _check(base, axis, numbers.of(joined("vary", axis.key)))
        elif not known:
            numbers.refuse("scene", "must be a table, or be read by load_study from its file")
        numbers.done()
        assert isinstance(scene, Scene)
        find_given = () if isinstance(self.find, UnsetType) else self.find
        batched = find == ("modes",) and self.error_bounds is not True
        _refuse_two_speeds(axes, find, numbers)
        samples = 1 if isinstance(self.samples, UnsetType) else self.samples
        grids = [axis.values.size for axis in axes if axis.values is not None]
        shape = (*grids, samples) if random else tuple(grids)
        links = links_of(scene, axes) if batched else None
        bounds = links is None if isinstance(self.error_bounds, UnsetType) else self.error_bounds
        of_top = ("centroid", "radius_of_gyration", "kind")
        varied = any(axis.path[0] == "support" or axis.path[-1] in of_top for axis in axes)
        outputs = outputs_of(scene, _largest(base, axes, source), find, self.max_shapes, bounds, varied)
        columns = {"point", "status", "sample", *(output.along for output in OUTPUTS.values()), *outputs}
        ways = tuple(name for name in WAYS if name in find_given)
        columns.update(*(columns_of(*output) for output in outputs.items()), ways)
        columns.update(SPEEDS * self.scatter.worst)
        for axis in axes:
            if axis.name in columns:
                numbers.of(joined("vary", axis.key)).refuse("name", f"{axis.name} is the name of a result")
        plan = Plan(base, axes, shape, self.seed, find, outputs, ways, links, not ways or "modes" in find_given)
        if self.scatter.worst and not numbers.problems and (reason := why_no_worst(plan)):
            numbers.refuse("scatter.worst", reason)
        if plan.points > MAX_POINTS:
            numbers.refuse("vary", f"makes {plan.points:,} points; at most {MAX_POINTS:,}")
        numbers.done()
        return plan


def load_study(path: str | os.PathLike[str]) -> Study:
    """Return a study from a TOML file, or from a JSON file if its name ends in ``.json``.

    Parameters
    ----------
    path : path-like
        Path of the file. A path of a scene in it counts from its folder.

    Returns
    -------
    Study
        The study, which `sweep` computes.

    Raises
    ------
    SceneError
        If the file cannot be read or is not a valid study (the error is a ValueError).

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
    with parse.opened(path) as (raw, problems, _):
        return Study._read(raw, os.fspath(path), Path(path).parent, problems)


def study_schema() -> dict[str, Any]:
    """The JSON Schema of study files, for editors."""
    return json_schema(Study, "revchain study")


def _refuse_twice(axes: tuple[Axis, ...], numbers: Numbers) -> None:
    """Note an error for a path or a name that is given twice."""
    for k, axis in enumerate(axes):
        caller = numbers.of(joined("vary", axis.key))
        for other in axes[:k]:
            if axis.name == other.name:
                caller.refuse("name", f"{axis.name} is the name of another, too")
            shorter = min(axis.path, other.path, key=len)
            if axis.path[: len(shorter)] == other.path[: len(shorter)]:
                caller.refuse("", f"is varied by {joined('vary', other.key)}, too")


def _refuse_two_speeds(axes: tuple[Axis, ...], find: tuple[str, ...], numbers: Numbers) -> None:
    """Note an error if one speed of [ask.shapes] and [ask.drag] is varied and the other is not."""
    names = ("angular_speed", "conical_height")
    speeds = {str(axis.path[1]): axis for axis in axes if axis.path[0] == "ask" and axis.path[-1] in names}
    varied = [question for question in ("shapes", "drag") if question in speeds]
    if len(varied) == 1 and {"shapes", "drag"} <= set(find):
        other = "drag" if varied[0] == "shapes" else "shapes"
        one = varied[0]
        why = f'leaves the speed of [ask.{other}] as it is: write find = ["{one}"], and a study of its own for "{other}"'
        numbers.of(joined("vary", speeds[varied[0]].key)).refuse("", why)


def _check(base: dict[str, Any], axis: Axis, numbers: Numbers) -> None:
    """Note the values of an axis that the scene refuses."""
    own = _kind(Scene.from_dict(base))
    for value in axis.examples():
        try:
            kind = _kind(Scene.from_dict(with_value(base, axis.path, value)))
        except SceneError as error:
            elsewhere = "" if error.key in ("", axis.key) else f"{error.key}: "
            return numbers.refuse("", f"{elsewhere}{error.reason}")
        except ValueError as error:
            return numbers.refuse("", str(error))
        if kind != own and not (kind == "a rig" and own.startswith("a rig")):  # wheels at rest have no backward modes
            alike = f"let the scene itself be {kind}, all points alike"
            return numbers.refuse("", f"makes {kind} of {own} at {value}: {alike}")
    return None


def _kind(scene: Scene) -> str:
    """The kind of the system, which decides the form of the results."""
    system = scene.system()
    if isinstance(system, SleeveGovernor):
        return "a governor"
    if system.has_momentum:
        return "a rig with flywheels that spin"
    return "a chain held at both ends" if scene.is_held else f"a {type(system).__name__.lower()}"


def _largest(base: dict[str, Any], axes: tuple[Axis, ...], source: str) -> Scene:
    """The scene with the most links."""
    for axis in axes:
        if not axis.is_number:
            each = [with_value(base, axis.path, value) for value in axis.examples()]
            base = max(each, key=lambda data: _links(Scene.from_dict(data, source)))
    return Scene.from_dict(base, source)


def _links(scene: Scene) -> int:
    return int(getattr(scene.system(), "size", 0))  # 0 of a governor
