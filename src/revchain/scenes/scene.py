# SPDX-License-Identifier: GPL-3.0-or-later
"""Scene files: what hangs, and what is asked of it. Read and validated by msgspec."""

from __future__ import annotations

import os
from typing import Annotated, Any, Literal

from msgspec import UNSET, Meta, UnsetType, json, to_builtins

from ..questions.held import HeldShape, HeldShapes, TautModes
from ..questions.modes import modes
from ..results.modes import Modes, RigModes
from ..results.motions import Response, SmallOscillation
from ..results.shapes import SteadyShapes
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, text
from ..systems.rig import Rig, base_chain
from . import parse
from .ask import asked, asked_of_held
from .ask_tables import Ask, AskResponse, AskShapes, AskSwing, Held
from .chain import Numbers, chain_of_links, tapered_chain, uniform_chain
from .error import SceneError
from .motion import ends_of, response_of, shapes_of, start_of, swing_of, taut_modes_of, the_speed, the_speeds
from .rig import is_rigged, radius_of, rig_of
from .tables import Displaced, Flywheel, Link, Positive, Support, Table, TaperedChain, UniformChain

__all__ = [
    "Ask",
    "AskResponse",
    "AskShapes",
    "AskSwing",
    "Displaced",
    "Flywheel",
    "Held",
    "Link",
    "Scene",
    "Support",
    "TaperedChain",
    "UniformChain",
    "json_schema",
    "load_scene",
]

_WEIGHT = ("weight", "mass")  # one of the two


class Scene(Table, frozen=True):
    """What hangs, under which gravity, and what is asked.

    Attributes
    ----------
    links : list of Link
        The links, lowest first; or
    uniform_chain : UniformChain
        a chain of equal ones; or
    tapered_chain : TaperedChain
        one cut from a cord that tapers by a power law.
    gravity : float or str
        In m/s^2, or text with a unit.
    support : Support, optional
        What the chain hangs from, if not a firm point on the axis.
    fluid : {"still", "turning"}
        The fluid that links displace.
    held : Held, optional
        Where the lower end is held, too.
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
    tapered_chain: Annotated[
        TaperedChain | UnsetType, Meta(description="Links cut from a cord that tapers, instead of links.")
    ] = UNSET
    support: Annotated[
        Support | UnsetType, Meta(description="What the chain hangs from, if not a firm point on the axis.")
    ] = UNSET
    fluid: Annotated[
        Literal["still", "turning"],
        Meta(description="The fluid that links displace: at rest, or turning with the chain."),
    ] = "still"
    held: Annotated[Held | UnsetType, Meta(description="Where the lower end is held on the axis, too.")] = UNSET
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
        source = text("revchain.Scene.from_dict", "source", source)
        scene = parse.convert(data, cls, source)
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
        return self._gravity("scene")

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

    def rig(self) -> Rig:
        """Build the chain with what it is rigged with.

        Returns
        -------
        Rig
            With nothing added where the scene says nothing of the kind.

        Raises
        ------
        SceneError
            If the numbers describe no chain, or nothing it can be rigged with.

        Examples
        --------
        >>> import revchain as rc
        >>> wheel = {"mass": 1.5, "radius_of_gyration": 0.29, "spin": 40.0}
        >>> rc.Scene.from_dict({"links": [{"mass": 2.0, "length": 0.4, "flywheel": wheel}]}).rig()
        Rig of a chain of 1 link: 1 link with momentum
        """
        return self._rig("scene")

    @property
    def is_rigged(self) -> bool:
        """Whether anything in the scene goes beyond a chain that hangs from a firm point on the axis."""
        return is_rigged(self._links(), self.support)

    @property
    def is_carried(self) -> bool:
        """Whether the support is carried round a circle, and one speed of that is asked about."""
        if isinstance(self.support, UnsetType) or isinstance(self.ask.response, UnsetType):
            return False
        return len(self.ask.response.ends) == 1 and radius_of(self.support, "scene") > 0

    @property
    def is_held(self) -> bool:
        """Whether the lower end is held on the axis, too."""
        return self.held is not UNSET

    def asked(self, chain: Chain) -> dict[str, Any]:
        """Return what is asked as keyword arguments of `revchain.modes`.

        Parameters
        ----------
        chain : Chain
            The one of this scene.

        Returns
        -------
        dict

        Raises
        ------
        SceneError
            If the modes asked for are not there, or cannot be meant, or the scene holds both ends.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 1, "repeat": 30}], "ask": {"first": 25}})
        >>> scene.asked(scene.chain())
        {'gravity': 9.80665, 'first': 25, 'count': 6}
        """
        compiled("revchain.Scene.asked", chain, link_by_link=False)
        if self.is_held:
            raise SceneError(
                "scene", "held", "is for shapes and modes: there is one model of it, `revchain.taut_modes`"
            )
        return asked(self.ask, chain, self.gravity_value(), "scene", self.is_rigged)

    def modes(self) -> Modes | RigModes | TautModes:
        """Solve the scene.

        Returns
        -------
        Modes, RigModes or TautModes
            As `revchain.modes` does for the chain, or the rig, and what is asked, or `revchain.taut_modes` where both
            ends are held; with the gravity of the scene.

        Raises
        ------
        SceneError
            If the numbers describe no hanging chain, or a chain held at both ends that is slack.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 1.5, "kind": "rod"}]})
        >>> scene.modes().conical_height.round(6)
        array([1.])

        The same rod on a carriage that slides on a spring:

        >>> support = {"stiffness": "50 N/m", "mass": 0.2}
        >>> scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 1.5, "kind": "rod"}], "support": support})
        >>> scene.modes().angular_speed.round(4)
        array([ 2.9086, 11.3491])
        """
        hung = self._hung("scene")
        if self.held is not UNSET and isinstance(hung, Chain):
            return taut_modes_of(self.held, hung, asked_of_held(self.ask, hung, "scene"), "scene")
        return modes(hung, **self.asked(base_chain(hung)))

    def steady_shapes(self, **changed: Any) -> SteadyShapes | HeldShapes[HeldShape]:
        """Find the steady shapes that ``[ask.shapes]`` asks for, at any inclination.

        Parameters
        ----------
        **changed
            Instead of what the scene says: `angular_speed` (rad/s) or `conical_height` (m), `sense`, `hanging_only`,
            `budget` as of `revchain.steady_shapes`, or `half_waves` where both ends are held.

        Returns
        -------
        SteadyShapes or HeldShapes

        Raises
        ------
        SceneError
            If the scene says no speed, and none is given.
        ValueError
            As `revchain.steady_shapes` and `revchain.held_shapes`.

        Examples
        --------
        >>> import revchain as rc
        >>> chair = {"mass": 80, "length": 4.0}
        >>> scene = rc.Scene.from_dict({"links": [chair], "support": {"radius": "1 m"}})
        >>> shapes = scene.steady_shapes(angular_speed=3.0)
        >>> len(shapes), shapes.complete
        (3, True)
        """
        return shapes_of(self._hung("scene"), self.held, self.ask.shapes, changed, self.gravity_value(), "scene")

    def response(self, **changed: Any) -> Response:
        """Find the small motions that ``[ask.response]`` asks for, of a support carried round.

        Parameters
        ----------
        **changed
            Instead of what the scene says: `angular_speed` or `conical_height`, a list of one (results are then not
            arrays of speeds) or the two ends of a range, `steps`, `support_radius`, `pins` as of `revchain.response`.

        Returns
        -------
        Response

        Raises
        ------
        SceneError
            If the scene says no speed, and none is given, or holds both ends.
        ValueError
            As `revchain.response`.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = rc.Scene.from_dict({"links": [{"mass": 1, "length": 1}], "support": {"radius": 0.02}})
        >>> scene.response(conical_height=[4.0]).offset.round(4)
        array([0.0267, 0.02  ])
        """
        if self.held is not UNSET:
            raise SceneError("scene", "held", "is for shapes and modes: no response is known of it")
        return response_of(self._hung("scene"), self.ask.response, changed, self.gravity_value(), "scene")

    def small_oscillation(self, **changed: Any) -> SmallOscillation:
        """See the chain swing that ``[ask.swing]`` lets go.

        Parameters
        ----------
        **changed
            Instead of what the scene says: `until` (s), `steps`, `modes` as of `revchain.small_oscillation`.

        Returns
        -------
        SmallOscillation

        Raises
        ------
        SceneError
            If the scene lets nothing go, or is more than a chain that hangs from a firm point.
        ValueError
            As `revchain.small_oscillation`.

        Examples
        --------
        >>> import revchain as rc
        >>> scene = {"links": [{"mass": 1, "length": 1}], "ask": {"swing": {"offset": ["5 cm"]}}}
        >>> rc.Scene.from_dict(scene).small_oscillation(until=1.0, steps=1).offset[:, 0].round(4)
        array([ 0.05, -0.05])
        """
        if self.is_rigged or self.held is not UNSET:
            raise SceneError("scene", "ask.swing", "is for a chain that hangs from a firm point, with nothing else")
        return swing_of(self.chain(), self.ask.swing, changed, self.gravity_value(), "scene")

    def _check(self, source: str) -> None:
        """Whatever the other methods would refuse of the scene, said with the name of the file."""
        hung = self._hung(source)
        chain = base_chain(hung)
        if self.held is UNSET:
            asked(self.ask, chain, self._gravity(source), source, self.is_rigged)
        elif self.is_rigged:
            raise SceneError(source, "held", "does not go with a support, standing links, flywheels or a fluid")
        else:
            ends_of(self.held, chain, source)
            asked_of_held(self.ask, chain, source)
        the_speed(self.ask.shapes, source)
        the_speeds(self.ask.response, hung, source)
        if self.ask.swing is not UNSET:
            start_of(self.ask.swing, chain, source)

    def _links(self) -> list[Link]:
        return [] if self.links is UNSET else self.links

    def _gravity(self, source: str) -> float:
        return Numbers(source, "").value("gravity", self.gravity, "gravity", "positive")

    def _hung(self, source: str) -> Chain | Rig:
        """What hangs; a rig where the scene says more than a chain."""
        return self._rig(source) if self.is_rigged else self._chain(source)

    def _rig(self, source: str) -> Rig:
        chain = self._chain(source)
        return rig_of(chain, self._links(), self.support, self.fluid, self._gravity(source), source)

    def _chain(self, source: str) -> Chain:
        gravity = self._gravity(source)
        if sum(given is not UNSET for given in (self.links, self.uniform_chain, self.tapered_chain)) != 1:
            raise SceneError(source, "", "give either [[links]] or [uniform_chain] or [tapered_chain]")
        if self.uniform_chain is not UNSET:
            return uniform_chain(self.uniform_chain, gravity, source)
        if self.tapered_chain is not UNSET:
            return tapered_chain(self.tapered_chain, gravity, source)
        assert self.links is not UNSET
        return chain_of_links(self.links, gravity, source)


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
    return Scene.from_dict(parse.read(path), os.fspath(path))


def json_schema() -> dict[str, Any]:
    """Return the JSON Schema of scene files, for editors.

    Returns
    -------
    dict

    Examples
    --------
    >>> from revchain.scenes.scene import json_schema
    >>> json_schema()["title"]
    'revchain scene'
    """
    schema: dict[str, Any] = json.schema(Scene)
    for table in schema["$defs"].values():
        if "description" in table:
            table["description"] = table["description"].partition("\n")[0]
    weighed = ("Link", "UniformChain", "TaperedChain", "Flywheel", "Displaced")
    for name, pair in (("Scene", ("links", "uniform_chain", "tapered_chain")), *((name, _WEIGHT) for name in weighed)):
        schema["$defs"][name]["oneOf"] = [{"required": [key]} for key in pair]
    return {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "revchain scene", **schema}
