# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: what hangs, and what is asked of it. Read and validated by msgspec."""

from __future__ import annotations

import math
import os
import re
from typing import Annotated, Any, Literal

import numpy as np
from msgspec import UNSET, Meta, Struct, UnsetType, json, to_builtins

from . import _scene_file
from ._arguments import STANDARD_GRAVITY, Floats
from ._chain import Chain
from ._modes import Modes
from ._scene_error import SceneError
from ._solve import modes
from ._units import PATTERN, si_value

__all__ = ["Ask", "Link", "Scene", "UniformChain", "json_schema", "load_scene"]

MOST_LINKS = 10_000_000
DEFAULT_MODES = 10
_WEIGHT = ("weight", "mass")  # one of the two

_WithUnit = Annotated[str, Meta(pattern=PATTERN, description='A number and its unit, such as "39.1396 inch".')]
Positive = Annotated[float, Meta(gt=0)] | _WithUnit
NotNegative = Annotated[float, Meta(ge=0)] | _WithUnit
AnySign = float | _WithUnit
Count = Annotated[int, Meta(ge=1, le=MOST_LINKS)]


class _Table(Struct, frozen=True, forbid_unknown_fields=True, omit_defaults=True, repr_omit_defaults=True, kw_only=True):
    """What all tables of a scene share: fixed keys, no positional arguments."""


class Link(_Table, frozen=True):
    """One link, or several equal ones. Numbers are SI (m, kg, N) or text with a unit.

    Attributes
    ----------
    length : float or str
        From pin to pin.
    weight, mass : float or str
        One of the two; a mass is multiplied by the scene's gravity. 0 is a massless thread.
    kind : {"plummet", "rod"}, optional
        A plummet (all weight at the lower pin) if nothing else is said, or a uniform rod.
    centroid : float or str, optional
        From the upper pin to the centre of gravity, positive downwards.
    pendulum_length, radius_of_gyration : float or str, optional
        One of the two goes with `centroid`.
    repeat : int
        How many such links follow one another.
    """

    length: Annotated[Positive, Meta(description="From pin to pin.")]
    weight: Annotated[NotNegative | UnsetType, Meta(description="Weight (N); or give mass.")] = UNSET
    mass: Annotated[NotNegative | UnsetType, Meta(description="Mass (kg); or give weight.")] = UNSET
    kind: Annotated[
        Literal["plummet", "rod"] | UnsetType,
        Meta(description="plummet (default): all weight at the lower pin; rod: uniform between its pins."),
    ] = UNSET
    centroid: Annotated[
        AnySign | UnsetType, Meta(description="From the upper pin down to the centre of gravity; any sign.")
    ] = UNSET
    pendulum_length: Annotated[
        AnySign | UnsetType, Meta(description="Of the equivalent simple pendulum about the upper pin.")
    ] = UNSET
    radius_of_gyration: Annotated[
        NotNegative | UnsetType, Meta(description="About the centre of gravity; or give pendulum_length.")
    ] = UNSET
    repeat: Annotated[Count, Meta(description="How many equal links follow one another.")] = 1


class UniformChain(_Table, frozen=True):
    """A chain of equal links. Numbers are SI (m, kg, N) or text with a unit.

    Attributes
    ----------
    kind : {"plummets", "rods"}
        What the links are.
    count : int
        How many.
    length, weight, mass : float or str
        Of the WHOLE chain; one of weight and mass.
    """

    kind: Annotated[Literal["plummets", "rods"], Meta(description="What the links are.")]
    count: Annotated[Count, Meta(description="How many links.")]
    length: Annotated[Positive, Meta(description="Of the whole chain.")]
    weight: Annotated[Positive | UnsetType, Meta(description="Of the whole chain (N); or give mass.")] = UNSET
    mass: Annotated[Positive | UnsetType, Meta(description="Of the whole chain (kg); or give weight.")] = UNSET


class Ask(_Table, frozen=True):
    """What is asked.

    Attributes
    ----------
    modes : int or "all"
        How many modes, slowest first; 10, or as many as there are, if left out.
    rtol : float, optional
        Relative tolerance of the conical heights; as accurate as possible if left out.
    method : str
        As for `revchain.modes`.
    """

    modes: Annotated[
        Count | Literal["all"] | UnsetType,
        Meta(description="How many modes, slowest first; 10, or as many as there are, if left out."),
    ] = UNSET
    rtol: Annotated[
        Annotated[float, Meta(ge=0)] | UnsetType,
        Meta(description="Relative tolerance of the heights; as accurate as possible if left out."),
    ] = UNSET
    method: Annotated[
        Literal["auto", "bisection", "dense", "recurrence"], Meta(description="How to compute.")
    ] = "auto"


class Scene(_Table, frozen=True):
    """What hangs, under which gravity, and what is asked.

    Attributes
    ----------
    links : list of Link
        The links, lowest first; or
    uniform_chain : UniformChain
        a chain of equal ones.
    gravity : float or str
        In m/s^2, or text with a unit.
    ask : Ask
        What is asked.
    title, description : str
        For people.
    schema_version : int
        1.

    Notes
    -----
    Plain numbers are SI; text such as ``"39.1396 inch"`` is converted through pint.

    Examples
    --------
    >>> import revchain as rc
    >>> scene = rc.Scene.from_dict({
    ...     "title": "Two plummets",
    ...     "links": [{"mass": 0.1, "length": 0.5}, {"mass": 0.3, "length": 0.5}],
    ... })
    >>> scene.chain()
    Chain of 2 links, length 1, weight 3.92266
    >>> scene.modes().conical_height.round(6)
    array([0.75, 0.25])
    """

    schema_version: Annotated[Literal[1], Meta(description="Version of this format.")] = 1
    title: Annotated[str, Meta(description="One line.")] = ""
    description: Annotated[str, Meta(description="As long as you like.")] = ""
    gravity: Annotated[Positive, Meta(description="In m/s^2.")] = STANDARD_GRAVITY
    links: Annotated[list[Link] | UnsetType, Meta(description="The links, lowest first.")] = UNSET
    uniform_chain: Annotated[UniformChain | UnsetType, Meta(description="Equal links, instead of links.")] = UNSET
    ask: Annotated[Ask, Meta(description="What is asked.")] = Ask()

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
            A ValueError that names the source, the key and what is wrong there.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Scene.from_dict({"uniform_chain": {"kind": "rods", "count": 5, "length": 1, "weight": 1}}).chain()
        Chain of 5 links, length 1, weight 1
        """
        scene = _scene_file.convert(data, cls, source)
        scene._check(source)
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
        return data

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
        return _Numbers("scene", "").value("gravity", self.gravity, "gravity", "positive")

    def chain(self) -> Chain:
        """Build the chain, with lengths in m and weights in N.

        Returns
        -------
        Chain

        Raises
        ------
        SceneError
            If the numbers describe no hanging chain.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.Scene.from_dict({"links": [{"weight": 2, "length": 0.5, "repeat": 3}]}).chain()
        Chain of 3 links, length 1.5, weight 6
        """
        return self._chain("scene")

    def count(self, chain: Chain) -> int | None:
        """Return how many modes of `chain` are asked for; None for all.

        Parameters
        ----------
        chain : Chain
            The one of this scene.

        Returns
        -------
        int or None

        Examples
        --------
        >>> import revchain as rc
        >>> scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 1, "repeat": 30}]})
        >>> scene.count(scene.chain())
        10
        """
        if self.ask.modes == "all":
            return None
        return min(DEFAULT_MODES, chain.mode_count) if self.ask.modes is UNSET else self.ask.modes

    def modes(self) -> Modes:
        """Solve the scene.

        Returns
        -------
        Modes
            As `revchain.modes` does for the chain and what is asked. Speeds need the scene's
            gravity: ``scene.modes().angular_speed(scene.gravity_value())``.

        Raises
        ------
        SceneError
            If the numbers describe no hanging chain.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 1.5, "kind": "rod"}]})
        >>> scene.modes().conical_height.round(6)
        array([1.])
        """
        chain = self.chain()
        return modes(chain, self.count(chain), None if self.ask.rtol is UNSET else self.ask.rtol, self.ask.method)

    def _check(self, source: str) -> None:
        """Whatever `chain`, `modes` and `gravity_value` would refuse, said with the name of the file."""
        chain = self._chain(source)
        asked = self.ask.modes
        if isinstance(asked, int) and asked > chain.mode_count:
            raise SceneError(source, "ask.modes", f"must be at most {chain.mode_count}, got {asked}")
        if self.ask.rtol is not UNSET and not math.isfinite(self.ask.rtol):
            raise SceneError(source, "ask.rtol", f"must be finite, got {self.ask.rtol}")

    def _chain(self, source: str) -> Chain:
        gravity = _Numbers(source, "").value("gravity", self.gravity, "gravity", "positive")
        if (self.links is UNSET) == (self.uniform_chain is UNSET):
            raise SceneError(source, "", "give either [[links]] or [uniform_chain]")
        if self.uniform_chain is not UNSET:
            return _uniform_chain(self.uniform_chain, gravity, source)
        assert self.links is not UNSET
        return _chain_of_links(self.links, gravity, source)


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
        A ValueError that names the file, the key and what is wrong there; for errors of syntax the
        line and the column.

    Examples
    --------
    >>> import revchain as rc, tempfile, pathlib
    >>> path = pathlib.Path(tempfile.mkdtemp()) / "scene.toml"
    >>> _ = path.write_text("[uniform_chain]\\nkind='rods'\\ncount=120\\nlength=0.36\\nmass=0.03\\n")
    >>> rc.load_scene(path).chain().size
    120
    """
    return Scene.from_dict(_scene_file.read(path), os.fspath(path))


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of scene files, for editors.

    Returns
    -------
    dict

    Examples
    --------
    >>> from revchain.scene import json_schema
    >>> json_schema()["title"]
    'revchain scene'
    """
    schema: dict[str, Any] = json.schema(Scene)
    for name, pair in (("Scene", ("links", "uniform_chain")), ("Link", _WEIGHT), ("UniformChain", _WEIGHT)):
        table = schema["$defs"][name]
        table["description"] = table["description"].partition("\n")[0]
        table["oneOf"] = [{"required": [key]} for key in pair]
    schema["$defs"]["Ask"]["description"] = "What is asked."
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "revchain scene", **schema}


class _Numbers:
    """Numbers of one table: text with units converted, ranges checked, errors with the key path."""

    def __init__(self, source: str, table: str) -> None:
        self.source = source
        self.table = table

    def refuse(self, key: str, reason: str) -> SceneError:
        return SceneError(self.source, ".".join(part for part in (self.table, key) if part), reason)

    def value(self, key: str, given: float | str, quantity: str, sign: str) -> float:
        try:
            number = si_value(given, quantity) if isinstance(given, str) else float(given)
        except ValueError as error:
            raise self.refuse(key, str(error)) from None
        shown = f'"{given}"' if isinstance(given, str) else f"{given}"
        if not math.isfinite(number):
            raise self.refuse(key, f"must be finite, got {shown}")
        if sign == "positive" and not number > 0:
            raise self.refuse(key, f"must be positive, got {shown}")
        if sign == "not negative" and not number >= 0:
            raise self.refuse(key, f"must not be negative, got {shown}")
        return number

    def weight(self, table: Link | UniformChain, gravity: float, sign: str) -> float:
        if (table.weight is UNSET) == (table.mass is UNSET):
            raise self.refuse("", "give either weight or mass")
        if table.weight is not UNSET:
            return self.value("weight", table.weight, "weight", sign)
        assert table.mass is not UNSET
        weight = self.value("mass", table.mass, "mass", sign) * gravity
        if not math.isfinite(weight):
            raise self.refuse("mass", f"is too large, got {table.mass}")
        return weight


def _uniform_chain(table: UniformChain, gravity: float, source: str) -> Chain:
    numbers = _Numbers(source, "uniform_chain")
    make = Chain.uniform_rods if table.kind == "rods" else Chain.uniform_plummets
    length = numbers.value("length", table.length, "length", "positive")
    weight = numbers.weight(table, gravity, "positive")
    try:
        return make(table.count, length, weight)
    except ValueError as error:
        raise numbers.refuse("", _without_place(str(error))) from None


def _chain_of_links(links: list[Link], gravity: float, source: str) -> Chain:
    if sum(link.repeat for link in links) > MOST_LINKS:
        raise SceneError(source, "links", f"must be at most {MOST_LINKS:,} together with their repeats")
    bodies = [_body(link, gravity, _Numbers(source, f"links[{index}]")) for index, link in enumerate(links)]
    repeats = [link.repeat for link in links]
    columns: list[Floats] = [np.repeat(np.array(column, dtype=float), repeats) for column in zip(*bodies, strict=True)]
    weight, length, centroid, radius = columns or [np.empty(0)] * 4
    try:
        if np.array_equal(centroid, length) and not radius.any():
            return Chain(weight=weight, length=length)
        return Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=radius)
    except ValueError as error:
        reason = _without_place(str(error))
        found = re.match(r"link (\d+): ", reason)
        if found is None:
            raise SceneError(source, "links", reason) from None
        index = int(np.searchsorted(np.cumsum(repeats), int(found[1])))
        raise SceneError(source, f"links[{index}]", reason[found.end() :]) from None


def _body(link: Link, gravity: float, numbers: _Numbers) -> tuple[float, float, float, float]:
    """Weight, length, centroid and radius of gyration of a link."""
    length = numbers.value("length", link.length, "length", "positive")
    weight = numbers.weight(link, gravity, "not negative")
    others = (link.pendulum_length, link.radius_of_gyration)
    if link.kind is not UNSET or link.centroid is UNSET:
        for key in ("centroid", "pendulum_length", "radius_of_gyration"):
            if getattr(link, key) is not UNSET:
                reason = "needs centroid beside it" if link.kind is UNSET else f'does not go with kind = "{link.kind}"'
                raise numbers.refuse(key, reason)
        return (weight, length, length / 2, length / math.sqrt(12)) if link.kind == "rod" else (weight, length, length, 0)
    centroid = numbers.value("centroid", link.centroid, "length", "any")
    if (others[0] is UNSET) == (others[1] is UNSET):
        raise numbers.refuse("centroid", "needs either pendulum_length or radius_of_gyration beside it")
    if link.radius_of_gyration is not UNSET:
        radius = numbers.value("radius_of_gyration", link.radius_of_gyration, "length", "not negative")
        return weight, length, centroid, radius
    assert link.pendulum_length is not UNSET
    pendulum = numbers.value("pendulum_length", link.pendulum_length, "length", "any")
    squared = centroid * (pendulum - centroid)
    if not 0 <= squared < math.inf or centroid == 0:
        reason = f"makes the radius of gyration imaginary: centroid (pendulum_length - centroid) is {squared:g}"
        if centroid == 0:
            reason = "says nothing where centroid is 0; give radius_of_gyration"
        raise numbers.refuse("pendulum_length", reason)
    return weight, length, centroid, math.sqrt(squared)


def _without_place(message: str) -> str:
    return re.sub(r"^revchain(::|\.)[\w:.]+?: ", "", message)


