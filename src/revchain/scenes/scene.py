# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: a system and questions about it."""

import os
import re
import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Self, TypeVar

import numpy as np
from msgspec import UNSET, UnsetType, json, to_builtins

from .. import _core
from ..results.base import asked_in
from ..results.files import naming, written_aside
from ..systems.numbers import text
from ..systems.units import speed_unit
from . import parse
from .answer import MOVES, SPEEDS, answered, arguments, notes_on
from .error import Problem, SceneError
from .positions import positions_in
from .system import Numbers, System, air_drag, problem_of, system_of
from .tables import BESIDE, QUESTIONS, SYSTEMS, TABLES, AskExplain, AskModes, Table, Tables, fields_of

if TYPE_CHECKING:
    from ..closed_forms.governor import GovernorEquilibria, SleeveGovernor
    from ..results.branches import Branches
    from ..results.campbell import Campbell
    from ..results.drag import DragShape
    from ..results.modes import Modes
    from ..results.motions import Response, Swing
    from ..results.shapes import SteadyShapes

__all__ = ["Scene", "load_scene"]

Answer = TypeVar("Answer")

EXCLUSIVE = (*SPEEDS["shapes"], *SPEEDS["branches"], "count", "first")
DRIVES = ("support_radius", "acceleration", "force")
# By the id of each living scene. A struct with `dict=True` could hold this, but msgspec before 0.21 crashes with it on
# Python 3.13; a frozen struct with lists has no hash, so that it is no key of a WeakKeyDictionary.
_MADE: dict[int, tuple["weakref.ref[Scene]", dict[str, Any]]] = {}


_LINKS = '{"links": [{"mass": 0.1, "length": 0.5}, {"mass": 0.3, "length": 0.5}]}'


def _asking(
    question: str, what: str, result: str, example: str, kind: Callable[[], type[Answer]], of: str = _LINKS
) -> Callable[..., Answer]:
    """The method of `Scene` that answers one question; `kind` tells type checkers what it returns."""

    def ask(self: Any, **changed: Any) -> Answer:
        return self._answer(question, changed)  # type: ignore[no-any-return]

    indented = example.replace("\n", "\n        ")
    ask.__doc__ = f"""Return the {what} for the table ``[ask.{question}]``, with the gravity of the scene.

        Parameters
        ----------
        **changed
            Keys of that table with other values than those of the scene.

        Returns
        -------
        {result}
            The answer.

        Raises
        ------
        SceneError
            If a key that the question needs is missing, or a value is refused.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = rc.Scene.from_dict({of})
        {indented}
        """
    return ask


class Scene(Tables, frozen=True, weakref=True):
    """A scene file: a system, its gravity and questions about it.

    Notes
    -----
    The attributes are the keys of the file (`revchain schema` describes each). Plain numbers are in SI units;
    text such as ``"39.1396 inch"`` is converted. Methods such as `modes` answer the questions of the scene; arguments
    given to them replace those of the scene.

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

    @classmethod
    def from_dict(cls, data: dict[str, Any], source: str = "scene") -> Self:
        """Return a scene from plain data, as in a TOML or JSON file.

        Parameters
        ----------
        data : dict
            Data with the keys of a scene file.
        source : str
            Name to show in errors.

        Returns
        -------
        Scene
            The scene.

        Raises
        ------
        SceneError
            If the data are not a valid scene.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Scene.from_dict({"uniform_chain": {"kind": "rods", "count": 5, "length": 1, "weight": 1}}).system()
        Chain of 5 links, length 1, weight 1
        """
        return cls._read(data, text("revchain.Scene.from_dict", "source", source), [])

    @classmethod
    def _read(cls, data: Any, source: str, problems: list[Problem]) -> Self:
        """The scene; one error for its problems and those of its syntax."""
        if isinstance(data, dict) and "vary" in data:
            raise SceneError(source, "vary", f"is of a study, not of a scene: revchain sweep {source}")
        scene = parse.convert(data, cls, source, problems)
        if found := scene._problems(source, problems):
            raise SceneError(source, problems=[_named(each, scene) for each in found])
        return scene

    def to_dict(self) -> dict[str, Any]:
        """Return the scene as plain data; keys at their default values may be left out.

        Returns
        -------
        dict
            The data, which `from_dict` reads.

        Examples
        --------
        >>> import revchain as rc
        >>> data = {"links": [{"mass": 0.1, "length": "20 inch"}]}
        >>> rc.Scene.from_dict(data).to_dict() == data
        True
        """
        data: dict[str, Any] = to_builtins(self)
        return data

    def gravity_value(self) -> float:
        """Return the acceleration of gravity in m/s^2.

        Returns
        -------
        float
            The acceleration.

        Raises
        ------
        SceneError
            If the numbers do not describe a possible system.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Scene.from_dict({"gravity": "981 cm/s^2", "links": [{"mass": 1, "length": 1}]}).gravity_value()
        9.81
        """
        return self._built()[1]

    def system(self) -> System:
        """Return the system of the scene, in SI units.

        Returns
        -------
        Chain, Rig, Cord, Held or SleeveGovernor
            The system.

        Raises
        ------
        SceneError
            If the numbers do not describe a possible system.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Scene.from_dict({"links": [{"weight": 2, "length": 0.5, "repeat": 3}]}).system()
        Chain of 3 links, length 1.5, weight 6
        >>> wheel = {"mass": 1.5, "radius_of_gyration": 0.29, "spin": 40.0}
        >>> rc.Scene.from_dict({"links": [{"mass": 2.0, "length": 0.4, "flywheel": wheel}]}).system()
        Rig of a chain of 1 link: 1 link with momentum
        """
        return self._built()[0]

    @property
    def asks(self) -> tuple[str, ...]:
        """Names of the questions for which the scene has a table, such as ``"modes"``."""
        return tuple([name for name in QUESTIONS if getattr(self.ask, name) is not UNSET])

    @property
    def _questions(self) -> tuple[str, ...]:
        """The questions to answer: those asked, or else the modes, of a governor its equilibria."""
        return self.asks or (("modes",) if self.governor is UNSET else ("equilibria",))

    modes = _asking(
        "modes", "modes", "Modes", ">>> scene.modes(first=2).conical_height.round(6)\narray([0.25])", lambda: Modes
    )
    steady_shapes = _asking(
        "shapes", "steady shapes", "SteadyShapes", '>>> len(scene.steady_shapes(angular_speed="60 rpm"))\n2',
        lambda: SteadyShapes,
    )
    response = _asking(
        "response", "forced motion", "Response", ">>> scene.response(angular_speed=2.0).modes_below\narray(0)",
        lambda: Response,
    )
    swing = _asking(
        "swing", "swing after release", "Swing", '>>> scene.swing(offset=["5 cm", 0], time=[0, 1]).offset.shape\n(2, 3)',
        lambda: Swing,
    )
    branches = _asking(
        "branches", "branches", "Branches", ">>> len(scene.branches(max_angular_speed=5.0))\n1", lambda: Branches
    )
    campbell = _asking(
        "campbell", "Campbell diagram", "Campbell", ">>> scene.campbell(angular_speed=[5.0, 6.0]).frequency.shape\n(2, 3)",
        lambda: Campbell,
    )
    drag_shape = _asking(
        "drag", "shape of a carried chain in air", "DragShape",
        '>>> scene.drag_shape(angular_speed="12 rpm").status\n\'success\'', lambda: DragShape,
        '{"links": [{"mass": 80, "length": 4, "air_drag": {"coefficient": 1, "area": 0.6}}], "support": {"radius": 3}}',
    )
    equilibria = _asking(
        "equilibria", "equilibria of a governor at a speed, or without one the governor",
        "GovernorEquilibria or SleeveGovernor",
        '>>> len(scene.equilibria(angular_speed="60 rpm"))\n2', lambda: GovernorEquilibria,
        '{"governor": {"ball_mass": 1.0, "arm": 0.5}}',
    )

    def answers(self) -> dict[str, Any]:
        """Return the answers to all questions of the scene.

        Returns
        -------
        dict
            The result of each question of `asks`; if there is none, the modes, or the equilibria of a governor.

        Raises
        ------
        SceneError
            If a function refuses the system or its arguments.

        Examples
        --------
        >>> import revchain as rc
        >>> link = {"mass": 1, "length": 1}
        >>> ask = {"response": {"conical_height": 4.0}, "shapes": {"angular_speed": "60 rpm"}}
        >>> list(rc.Scene.from_dict({"links": [link], "ask": ask}).answers())
        ['shapes', 'response']
        """
        return {question: self._answer(question, {}) for question in self._questions}

    def report(self, path: str | os.PathLike[str]) -> None:
        """Answer all questions of the scene and write a report.

        The report is one HTML file that needs no other file and no network: the system in words and in a drawing, the
        answers with tables, bounds and pictures, the text of the scene, and how to repeat it.

        Parameters
        ----------
        path : path-like
            Path that ends in ``.html``.

        Raises
        ------
        ValueError
            If the path ends neither in ``.html`` nor in ``.htm``.
        SceneError
            If a function refuses the system or its arguments.
        ImportError
            If matplotlib is not installed.
        OSError
            If the file cannot be written (the error is also a ValueError).

        Notes
        -----
        Cost: that of the answers and their pictures.

        Examples
        --------
        >>> import revchain as rc, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "report.html"
        >>> scene = {"title": "Double pendulum", "links": [{"mass": 1, "length": 0.5, "repeat": 2}]}
        >>> rc.Scene.from_dict(scene).report(path)
        >>> "<h1>Double pendulum</h1>" in path.read_text(encoding="utf-8")
        True
        """
        from .report import check_path, page_of

        check_path("revchain.Scene.report: path", path)
        with naming(path), written_aside(path) as [aside]:
            aside.write_text(page_of(self, self.answers()), encoding="utf-8")

    def _file(self) -> tuple[str, str]:
        """The name and the text of the file of the scene; of one from a dictionary, its data as JSON."""
        made = self._made()
        return os.path.basename(made.get("file", "scene.json")), made.get("text") or json.format(json.encode(self.to_dict()), indent=2).decode() + "\n"

    def _answer(
        self, question: str, changed: dict[str, Any], progress: _core.Progress | None = None, *, options: bool = False
    ) -> Any:
        """The answer to one question; `changed` are keys of its table with other values than those of the scene.

        With `options`, errors name keys as options of a command.
        """
        (system, gravity), given = self._built(), None if changed else self._made().get(question)
        table = self._table(question, changed)
        asked = getattr(table, "angular_speed", getattr(table, "max_angular_speed", UNSET))
        unit: str | None = None if isinstance(self.speed, UnsetType) else self.speed
        if unit is None and asked is not UNSET:
            unit = speed_unit(to_builtins(asked))  # in which the speed of the question was written
        try:
            if given is None:
                numbers = Numbers("scene", options=options)
                given = self._arguments(question, table, system, numbers)
                numbers.done()
            notes = () if question == "explain" else notes_on(self, question, table, system, given, options)
            found = answered(question, system, given, gravity, progress)
            return asked_in(unit, found, notes) if unit is not None or notes else found
        except ValueError as error:
            if not isinstance(error, SceneError):
                error = SceneError("scene", problems=[self._problem_of(error, question, self._table(question, changed))])
            raise self._in_file(error, question, changed) from None

    def _problem_of(self, error: ValueError, question: str, table: Table) -> Problem:
        """An error of the function of a question as a problem of the key that it names, or of the question's table."""
        found = problem_of(error, "", self._bodies())
        if found.key:
            return found
        for words, key in self._without_answer().items():
            if words in found.reason:
                return found._replace(key=key)
        fields = [each for each in fields_of(type(table)) if getattr(table, each.name) not in (UNSET, each.default)]
        given = [each.encode_name for each in fields]
        for key in sorted(given, key=len, reverse=True):
            if said := re.match(rf"{key}(\[\d+\])? (?=must|needs|has|is )", found.reason):
                return Problem(0, 0, f"ask.{question}.{key}{said[1] or ''}", found.reason[said.end() :])
        named = next((key for key in given if re.search(rf"\b{key.replace('_', '[ _]')}\b", found.reason)), "")
        return found._replace(key=f"ask.{question}.{named}".rstrip("."))

    def _without_answer(self) -> dict[str, str]:
        """By words in the sentence with which a question refuses a rig: the key of the first datum that is the reason."""
        found = {"a trolley": "support", "carried round": "support.radius", "with dashpots": "support.damping"}
        found |= {"a fluid that turns": "fluid", "the cord's own": "cord"}
        for index, link in reversed(self._bodies()):
            found |= {"linear drag": f"links[{index}].drag"} if link.drag is not UNSET else {}
            found |= {"springs at pins": f"links[{index}].pin"} if link.pin is not UNSET else {}
        return found

    def _in_file(self, error: SceneError, question: str, changed: dict[str, Any]) -> SceneError:
        """The error with line and column of each key in the file of the scene; unchanged if the file is gone."""
        source = self._made().get("file")
        if source is None:
            return error
        try:
            position = positions_in(parse.text_of(source), parse.is_json(source))
        except SceneError:
            return error
        of_table = f"ask.{question}"

        def in_file(key: str) -> tuple[int, int]:
            name = re.split(r"[.\[]", key.removeprefix(f"{of_table}."))[0]
            asked = getattr(self.ask, question, UNSET) is not UNSET
            elsewhere = key.startswith(of_table) and (name in changed or not asked)
            return (0, 0) if elsewhere or not key else position(key)

        return SceneError(source, problems=[Problem(*in_file(each.key), *each[2:]) for each in error.problems])

    def _arguments(self, question: str, table: Table, system: System | None, numbers: Numbers) -> dict[str, Any]:
        """The arguments of a question, from its table and, of drag, from the links."""
        given = arguments(question, table, system, numbers)
        if question == "drag":
            given["drag"] = air_drag(self, given.pop("air_density", None), numbers)
        return given

    def _table(self, question: str, changed: dict[str, Any]) -> Table:
        """The table of a question, with the values of `changed`."""
        said = getattr(self.ask, "modes" if question == "explain" else question)
        if question == "explain" and isinstance(said, AskModes):
            said = AskExplain(count=said.count, first=said.first, rtol=said.rtol)
        if not changed and said is not UNSET:
            return said  # type: ignore[no-any-return]
        data = {} if said is UNSET else to_builtins(said)
        if question != "swing" and any(name in changed for name in EXCLUSIVE):  # another choice than that of the scene
            data = {name: value for name, value in data.items() if name not in EXCLUSIVE}
        for choices in (DRIVES, MOVES):
            if any(name in changed for name in choices):
                data = {name: value for name, value in data.items() if name not in choices}
        data |= {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in changed.items()}
        problems: list[Problem] = []
        table = parse.convert(data, TABLES[question], "scene", problems)
        if problems:
            where = f"ask.{question}."
            raise SceneError("scene", problems=[
                each._replace(key=where + each.key, reason=each.reason + parse.several(where + each.key, data.get(each.key)))
                for each in problems
            ])  # fmt: skip
        return table

    def _made(self) -> dict[str, Any]:
        """The cache of the scene: its system with the gravity, and the arguments of each question."""
        key = id(self)
        if key not in _MADE:
            _MADE[key] = weakref.ref(self, lambda _, made=_MADE: made.pop(key, None)), {}  # type: ignore[misc]
        return _MADE[key][1]

    def _built(self, source: str = "scene") -> tuple[System, float]:
        """The system and the gravity, made once. All problems are raised as one error."""
        made = self._made()
        if "system" not in made:
            made["system"] = system_of(self, source)
        built: tuple[System, float] = made["system"]
        return built

    def _problems(self, source: str, known: list[Problem]) -> list[Problem]:
        """All problems of the scene, with those already known; if there are none, its cache is full."""
        numbers, system = Numbers(source), None
        given = [name for name in SYSTEMS if getattr(self, name) is not UNSET]
        if given or all(re.split(r"[.\[]", problem.key)[0] in ("", *BESIDE) for problem in known):
            try:
                system, _ = self._built(source)
            except SceneError as error:
                numbers.problems[:] = error.problems
        found = {name: self._arguments(name, getattr(self.ask, name), system, numbers) for name in self.asks}
        if not numbers.problems:
            self._made().update(found)
        return parse.without_consequences([*known, *numbers.problems])


def _named(problem: Problem, scene: Scene) -> Problem:
    """The problem with the name of its link added to the key."""
    found = re.match(r"links\[(\d+)\]\S*$", problem.key)
    if found is None or isinstance(scene.links, UnsetType) or int(found[1]) >= len(scene.links):
        return problem
    name = scene.links[int(found[1])].name
    return problem._replace(key=f'{problem.key} ("{name}")') if name else problem


def load_scene(path: str | os.PathLike[str]) -> Scene:
    """Return a scene from a TOML file, or from a JSON file if its name ends in ``.json``.

    Parameters
    ----------
    path : path-like
        Path of the file.

    Returns
    -------
    Scene
        The scene.

    Raises
    ------
    SceneError
        If the file cannot be read or is not a valid scene.

    Examples
    --------
    >>> import revchain as rc, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "scene.toml"
    >>> _ = path.write_text("[uniform_chain]\\nkind='rods'\\ncount=120\\nlength=0.36\\nmass=0.03\\n")
    >>> rc.load_scene(path).system().size
    120
    """
    return read(path, {})


def read(path: str | os.PathLike[str], changed: dict[str, Any]) -> Scene:
    """Read the scene of a file, with other values of some of its keys."""
    with parse.opened(path) as (raw, problems, text):
        scene = Scene._read(raw | changed if isinstance(raw, dict) else raw, os.fspath(path), problems)
    _MADE[id(scene)][1].update(file=os.fspath(path), text=text)
    return scene


def json_schema(kind: type[Table] = Scene, title: str = "revchain scene") -> dict[str, Any]:
    """The JSON Schema of scene files (or files of another kind), for editors."""
    schema: dict[str, Any] = json.schema(kind)
    weighed = ("Link", "UniformChain", "TaperedChain", "Flywheel", "Displaced")
    for name, table in schema["$defs"].items():
        if "description" in table:
            table["description"] = table["description"].partition("\n")[0]
        if name == "Scene" or name in weighed:
            table["oneOf"] = [{"required": [key]} for key in (SYSTEMS if name == "Scene" else ("weight", "mass"))]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": title, **schema}
