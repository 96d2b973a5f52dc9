# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: what hangs, and what is asked of it. Read and validated by msgspec."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable
from typing import Annotated, Any, Literal, Self

import numpy as np
from msgspec import UNSET, UnsetType, json, to_builtins

from .. import _core
from ..systems.chain import Chain
from ..systems.cord import Cord as CordSystem
from ..systems.held import Held as HeldSystem
from ..systems.numbers import STANDARD_GRAVITY, text
from ..systems.rig import Rig
from ..systems.rig import Support as EndSupport
from . import parse
from .answer import SPEEDS, answered, arguments
from .ask import QUESTIONS, TABLES, Ask, AskExplain, AskModes
from .chain import Links, Numbers, chain_of_links, of_file, whole, without_place
from .error import Problem, SceneError
from .rig import is_rigged, rig_of, support_numbers
from .tables import (
    BESIDE,
    SYSTEMS,
    Cord,
    Held,
    Link,
    Positive,
    Support,
    Table,
    TaperedChain,
    UniformChain,
    fields_of,
    says,
)
from .upgrade import old_keys

__all__ = ["Scene", "load_scene"]

System = Chain | Rig | CordSystem | HeldSystem
EXCLUSIVE = (*SPEEDS, "count", "first")


def _asking(question: str, what: str, result: str, example: str) -> Callable[..., Any]:
    """The method that asks one question."""

    def ask(self: Scene, **changed: Any) -> Any:
        return self._answer(question, changed)

    indented = example.replace("\n", "\n        ")
    ask.__doc__ = f"""Find the {what} that ``[ask.{question}]`` asks for, with the gravity of the scene.

        Parameters
        ----------
        **changed
            Keys of that table that take the place of the scene's.

        Returns
        -------
        {result}

        Raises
        ------
        SceneError
            (a ValueError) If neither the scene nor `changed` says what the question needs, and for all that the
            function of that name refuses, such as a system that has no answer. Links are those of the scene's tables.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = rc.Scene.from_dict({{"links": [{{"mass": 0.1, "length": 0.5}}, {{"mass": 0.3, "length": 0.5}}]}})
        {indented}
        """
    return ask


class Scene(Table, frozen=True):
    """What hangs, under which gravity, and what is asked: a scene file.

    Notes
    -----
    Its attributes are the tables of the file (`revchain schema` describes every key). Plain numbers are SI; text such
    as ``"39.1396 inch"`` is converted through pint. `modes`, `steady_shapes`, `response`, `swing` and `branches` ask
    the function of that name, with the system, the gravity and the arguments of the scene; arguments given to them take
    the place of the scene's.

    Examples
    --------
    >>> import revchain as rc
    >>> scene = rc.Scene.from_dict({
    ...     "title": "Two plummets",
    ...     "links": [{"mass": 0.1, "length": 0.5}, {"mass": 0.3, "length": 0.5}],
    ... })
    >>> scene.system()
    Chain of 2 links, length 1, mass 0.4
    >>> scene.modes().conical_height.round(6)
    array([0.75, 0.25])
    >>> shapes = scene.steady_shapes(angular_speed="60 rpm")
    >>> len(shapes), shapes.complete
    (2, True)
    """

    schema_version: Annotated[Literal[2], says("Version of this format.")] = 2
    title: Annotated[str, says("One line.")] = ""
    description: Annotated[str, says("As long as you like.")] = ""
    gravity: Annotated[Positive, says("In m/s^2.")] = STANDARD_GRAVITY
    order: Annotated[Literal["free end first", "support first"], says("Of the links.")] = "free end first"
    links: Annotated[list[Link] | UnsetType, says("The links, the free end first.")] = UNSET
    uniform_chain: Annotated[UniformChain | UnsetType, says("Equal links, instead of links.")] = UNSET
    tapered_chain: Annotated[
        TaperedChain | UnsetType, says("Links cut from a tapering cord, instead of links.")
    ] = UNSET
    cord: Annotated[Cord | UnsetType, says("A flexible cord, instead of links.")] = UNSET
    support: Annotated[Support | UnsetType, says("What the chain hangs from, if not a firm point on the axis.")] = UNSET
    fluid: Annotated[Literal["still", "turning"], says("At rest, or turning with the chain.")] = "still"
    held: Annotated[Held | UnsetType, says("Where the lower end is held on the axis, too.")] = UNSET
    ask: Annotated[Ask, says("What is asked.")] = Ask()

    @classmethod
    def from_dict(cls, data: dict[str, Any], source: str = "scene") -> Scene:
        """Make a scene from plain data, as a TOML or JSON file holds it.

        Parameters
        ----------
        data : dict
            Keys as in a scene file.
        source : str
            What errors name.

        Returns
        -------
        Scene

        Raises
        ------
        SceneError
            A ValueError that names the source, and of every error the key and what is wrong there.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Scene.from_dict({"uniform_chain": {"kind": "rods", "count": 5, "length": 1, "weight": 1}}).system()
        Chain of 5 links, length 1, weight 1
        """
        return cls._read(data, text("revchain.Scene.from_dict", "source", source), [])

    @classmethod
    def _read(cls, data: Any, source: str, problems: list[Problem], in_doubt: bool = False) -> Self:
        """The scene; one error for all problems, those of its syntax included."""
        if isinstance(data, dict):
            if "vary" in data:
                raise SceneError(source, "vary", f"is of a study, not of a scene: revchain sweep {source}")
            if old := old_keys(data, in_doubt):
                raise SceneError(source, problems=[*problems, *(Problem(0, 0, *each) for each in old)])
        scene = parse.convert(data, cls, source, problems)
        if found := scene._problems(source, problems):
            raise SceneError(source, problems=[_named(each, scene) for each in found])
        return scene

    def to_dict(self) -> dict[str, Any]:
        """Return the scene as plain data; what has its default is left out.

        Returns
        -------
        dict

        Examples
        --------
        >>> import revchain as rc
        >>> data = {"links": [{"mass": 0.1, "length": "20 inch"}]}
        >>> rc.Scene.from_dict(data).to_dict() == data
        True
        """
        data: dict[str, Any] = to_builtins(self)
        return {"schema_version": 2, **data} if old_keys(data) else data

    def gravity_value(self) -> float:
        """Return gravity in m/s^2.

        Returns
        -------
        float

        Raises
        ------
        SceneError
            If it is no positive acceleration.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Scene.from_dict({"gravity": "981 cm/s^2", "links": [{"mass": 1, "length": 1}]}).gravity_value()
        9.81
        """
        numbers = Numbers("scene")
        gravity = numbers.value("gravity", self.gravity, "gravity", "positive")
        numbers.done()
        return gravity

    def system(self) -> System:
        """Build what hangs, in SI units: by mass, or by weight if any weight is said.

        Returns
        -------
        Chain, Rig, Cord or Held
            A rig where anything goes beyond a chain that hangs from a firm point on the axis.

        Raises
        ------
        SceneError
            If the numbers describe nothing that hangs.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Scene.from_dict({"links": [{"weight": 2, "length": 0.5, "repeat": 3}]}).system()
        Chain of 3 links, length 1.5, weight 6
        >>> wheel = {"mass": 1.5, "radius_of_gyration": 0.29, "spin": 40.0}
        >>> rc.Scene.from_dict({"links": [{"mass": 2.0, "length": 0.4, "flywheel": wheel}]}).system()
        Rig of a chain of 1 link: 1 link with momentum
        """
        system = self._system("scene")
        assert system is not None  # else it has been raised why
        return system

    @property
    def asks(self) -> tuple[str, ...]:
        """The questions that the scene has a table for: modes, shapes, response, swing, branches."""
        return tuple(name for name in QUESTIONS if getattr(self.ask, name) is not UNSET)

    modes = _asking("modes", "modes", "Modes", ">>> scene.modes(first=2).conical_height.round(6)\narray([0.25])")
    steady_shapes = _asking(
        "shapes", "steady shapes", "SteadyShapes", '>>> len(scene.steady_shapes(angular_speed="60 rpm"))\n2'
    )
    response = _asking(
        "response", "forced motion", "Response", ">>> scene.response(angular_speed=2.0).modes_below\narray(0)"
    )
    swing = _asking(
        "swing", "swing after release", "Swing", '>>> scene.swing(offset=["5 cm", 0], time=[0, 1]).offset.shape\n(2, 3)'
    )
    branches = _asking("branches", "branches", "Branches", ">>> len(scene.branches(max_angular_speed=5.0))\n1")

    def answers(self) -> dict[str, Any]:
        """Answer all that the scene asks.

        Returns
        -------
        dict
            The result of each question of `asks`; of a scene that asks nothing, its modes.

        Raises
        ------
        ValueError
            As the functions.

        Examples
        --------
        >>> import revchain as rc
        >>> link = {"mass": 1, "length": 1}
        >>> ask = {"response": {"conical_height": 4.0}, "shapes": {"angular_speed": "60 rpm"}}
        >>> list(rc.Scene.from_dict({"links": [link], "ask": ask}).answers())
        ['shapes', 'response']
        """
        return {question: self._answer(question, {}) for question in self.asks or ("modes",)}

    def _answer(self, question: str, changed: dict[str, Any], progress: _core.Progress | None = None) -> Any:
        """Answer one question; `changed` are keys of its table that take the place of the scene's."""
        numbers = Numbers("scene")
        table, gravity, system = self._table(question, changed), self.gravity_value(), self.system()
        given = arguments(question, table, system, numbers.of("ask"))
        numbers.done()
        try:
            return answered(question, system, given, gravity, progress)
        except ValueError as error:
            raise of_file(error, "scene", "", self._bodies()) from None

    def _table(self, question: str, changed: dict[str, Any]) -> Table:
        """What the scene says of a question, with other values in place of its own."""
        said = getattr(self.ask, "modes" if question == "explain" else question)
        if question == "explain" and isinstance(said, AskModes):
            said = AskExplain(count=said.count, first=said.first, rtol=said.rtol)
        if not changed and said is not UNSET:
            return said  # type: ignore[no-any-return]
        data = {} if said is UNSET else to_builtins(said)
        if question != "swing" and any(name in changed for name in EXCLUSIVE):  # another choice than that of the scene
            data = {name: value for name, value in data.items() if name not in EXCLUSIVE}
        data |= {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in changed.items()}
        problems: list[Problem] = []
        table = parse.convert(data, TABLES[question], "scene", problems)
        if problems:
            where = f"ask.{question}."
            raise SceneError("scene", problems=[each._replace(key=where + each.key) for each in problems])
        return table

    def _problems(self, source: str, known: list[Problem]) -> list[Problem]:
        """All that is wrong with the scene, of which some is known."""
        numbers, system = Numbers(source), None
        given = [name for name in SYSTEMS if getattr(self, name) is not UNSET]
        if given or all(re.split(r"[.\[]", problem.key)[0] in ("", *BESIDE) for problem in known):
            try:
                system = self._system(source)
            except SceneError as error:
                numbers.problems[:] = error.problems
        for question in self.asks:
            arguments(question, getattr(self.ask, question), system, numbers.of("ask"))
        return parse.without_consequences([*known, *numbers.problems])

    def _system(self, source: str) -> System | None:
        """What hangs. All that is wrong with it is raised as one error; None where only what is known is wrong."""
        numbers = Numbers(source)
        given = [name for name in SYSTEMS if getattr(self, name) is not UNSET]
        if len(given) != 1:
            tables = "[[links]], [uniform_chain], [tapered_chain] or [cord]"
            raise SceneError(source, "", f"give one of {tables}, got {' and '.join(given) or 'none of them'}")
        numbers.gravity = numbers.value("gravity", self.gravity, "gravity", "positive")
        numbers.by_mass = is_by_mass(self)
        if self.links == []:
            raise SceneError(source, "links", "is an empty list: give at least one link")
        made: Chain | CordSystem | None = None
        try:
            if links := self._links():
                made = chain_of_links(links, numbers)
            else:
                made = whole(getattr(self, given[0]), numbers.of(given[0]))
        except SceneError as error:
            numbers.problems[:] = error.problems
        if self.is_rigged and (self.held is not UNSET or self.cord is not UNSET):
            name = "cord" if self.held is UNSET else "held"
            numbers.refuse(name, "does not go with a support, standing links, flywheels or a fluid")
        elif self.is_rigged:
            assert not isinstance(made, CordSystem)
            return rig_of(made, self._bodies(), self.support, self.fluid, numbers)
        held = None if isinstance(self.held, UnsetType) else _held(self.held, made, numbers.of("held"))
        numbers.done()
        return held or made

    def _links(self) -> Links:
        """The tables of the links, lowest first, with their numbers in the file."""
        links = [] if isinstance(self.links, UnsetType) else list(enumerate(self.links))
        return links[::-1] if self.order == "support first" else links

    def _bodies(self) -> Links:
        """Those that are links of the system: a clamped one is part of the link above."""
        return [(index, link) for index, link in self._links() if not link.clamped]

    @property
    def is_rigged(self) -> bool:
        """Whether anything in the scene goes beyond a chain that hangs from a firm point on the axis."""
        return is_rigged([] if isinstance(self.links, UnsetType) else self.links, self.support)

    @property
    def is_held(self) -> bool:
        """Whether the lower end is held on the axis, too."""
        return self.held is not UNSET


def is_by_mass(scene: Scene) -> bool:
    """Whether masses stay masses: no weight is said, or gravity plays no part."""
    return _is_by_mass(scene) or (isinstance(scene.held, Held) and scene.held.weightless)


def _is_by_mass(table: Any) -> bool:
    """Whether no weight is said in a table, nor in those inside it."""
    if isinstance(table, list):
        return all(map(_is_by_mass, table))
    if not isinstance(table, Table):
        return True
    values = {field.name: getattr(table, field.name) for field in fields_of(type(table)) if field.name != "ask"}
    weights = [name for name, value in values.items() if name.endswith("weight") and value is not UNSET]
    return not weights and all(map(_is_by_mass, values.values()))


def _held(table: Held, system: Chain | CordSystem | None, numbers: Numbers) -> HeldSystem | None:
    """The chain or cord held at both ends."""
    if (table.span is UNSET) == (table.tension is UNSET):
        numbers.refuse("", "give either span or tension")
        return None
    name = "span" if table.tension is UNSET else "tension"
    value = numbers.value(name, getattr(table, name), name, "positive")
    given: dict[str, Any] = {name: value, "weightless": table.weightless}
    for end in ("lower", "upper"):
        held_by = getattr(table, end)
        if held_by is not UNSET:
            given[end] = EndSupport(**support_numbers(held_by, numbers.of(end), "any"))
    numbers.done()
    if system is None or math.isnan(value):
        return None
    try:
        return HeldSystem(system, **given)
    except ValueError as error:
        reason = without_place(error)
        ends = [end for end in ("lower", "upper") if reason.startswith(end)]
        key = ends[0] if ends else name
        raise SceneError(numbers.source, f"held.{key}", reason.removeprefix(f"{key} ")) from None


def _named(problem: Problem, scene: Scene) -> Problem:
    """With the name of the link in which it is."""
    found = re.match(r"links\[(\d+)\]\S*$", problem.key)
    if found is None or isinstance(scene.links, UnsetType) or int(found[1]) >= len(scene.links):
        return problem
    name = scene.links[int(found[1])].name
    return problem._replace(key=f'{problem.key} ("{name}")') if name else problem


def load_scene(path: str | os.PathLike[str]) -> Scene:
    """Read a scene from a TOML file, or from a JSON file if its name ends in ``.json``.

    Parameters
    ----------
    path : path-like
        The file.

    Returns
    -------
    Scene

    Raises
    ------
    SceneError
        A ValueError that names the file, and of every error the line, the column, the key and what is wrong there.

    Examples
    --------
    >>> import revchain as rc, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "scene.toml"
    >>> _ = path.write_text("[uniform_chain]\\nkind='rods'\\ncount=120\\nlength=0.36\\nmass=0.03\\n")
    >>> rc.load_scene(path).system().size
    120
    """
    with parse.opened(path) as (raw, problems):
        return Scene._read(raw, os.fspath(path), problems, in_doubt=True)


def json_schema(kind: type[Table] = Scene, title: str = "revchain scene") -> dict[str, Any]:
    """The JSON Schema of scene files, or of files of another kind, for editors."""
    schema: dict[str, Any] = json.schema(kind)
    weighed = ("Link", "UniformChain", "TaperedChain", "Flywheel", "Displaced")
    for name, table in schema["$defs"].items():
        if "description" in table:
            table["description"] = table["description"].partition("\n")[0]
        if name == "Scene" or name in weighed:
            table["oneOf"] = [{"required": [key]} for key in (SYSTEMS if name == "Scene" else ("weight", "mass"))]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": title, **schema}
