# SPDX-License-Identifier: GPL-3.0-or-later
"""The system of a scene, built from its tables."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Sequence
from itertools import accumulate
from typing import Any

import numpy as np
from msgspec import UNSET, UnsetType, json

from ..closed_forms.governor import SleeveGovernor
from ..systems.chain import Chain, Order
from ..systems.cord import Cord
from ..systems.drag import Drag
from ..systems.held import Held
from ..systems.numbers import without_function
from ..systems.rig import Displaced, Flywheel, Pin, Rig, Support
from ..systems.units import SI, si_value, speed_unit
from . import tables
from .error import Problem, SceneError
from .parse import several, without_consequences, written
from .tables import MOST_LINKS, SYSTEMS, Link, Links, Spread, Table, Tables, number_fields

MOST = 1e100  # largest number of a scene, in SI units: products of a few numbers stay within the range of double
Whirling = Chain | Rig | Cord | Held
System = Whirling | SleeveGovernor
Given = dict[str, Any]


def option(key: str) -> str:
    """The option of a command that stands for a key of a question."""
    return f"--{key.replace('_', '-')}"


class Numbers:
    """Numbers of one table: text with units converted, ranges checked, errors noted with the key path.

    A wrong number is NaN; `done` raises one error for all of them.
    """

    def __init__(
        self, source: str, table: str = "", *, gravity: float = 1.0, by_mass: bool = True, options: bool = False
    ) -> None:
        self.source = source
        self.table = table
        self.problems: list[Problem] = []
        self.gravity = gravity
        self.by_mass = by_mass
        self.options = options  # whether a command asks, whose options stand for the keys of its table

    def of(self, table: str) -> Numbers:
        """The numbers of a table inside this one; errors are noted together."""
        name = f"{self.table}.{table}".lstrip(".")
        inside = Numbers(self.source, name, gravity=self.gravity, by_mass=self.by_mass, options=self.options)
        inside.problems = self.problems
        return inside

    @property
    def heavy(self) -> str:
        """The key of a weight: ``mass`` or ``weight``."""
        return "mass" if self.by_mass else "weight"

    def named(self, key: str, value: str = "") -> str:
        """A key as the user writes it, also with a value: the key of a file, or the option of a command."""
        name = option(key) if self.options else key
        return name + (f"{' ' if self.options else ' = '}{value}" if value else "")

    def refuse(self, key: str, reason: str) -> None:
        """Note an error of a key of this table."""
        self.problems.append(Problem(0, 0, f"{self.table}.{key}".strip("."), reason))

    def refuse_as(self, error: ValueError, names: Iterable[str]) -> None:
        """Note an error of a function: of the key among `names` with which its sentence begins, or else of this table."""
        reason = without_function(error)
        for name in names:
            for words in (f"{name} ", f"{name} ".replace("_", " ")):
                if reason.startswith(words):
                    return self.refuse(name, reason.removeprefix(words))
        self.refuse("", reason)

    def done(self) -> None:
        """Raise a SceneError if an error was noted."""
        if self.problems:
            raise SceneError(self.source, problems=without_consequences(self.problems))

    def value(self, key: str, given: object, quantity: str, sign: str, finite: bool = True) -> float:
        """Return a number, or a text with a unit, in the SI unit of the quantity; NaN if it is refused."""
        if given is UNSET:  # missing or of a wrong kind; the error is noted already
            return math.nan
        assert isinstance(given, float | int | str)
        try:
            number = si_value(given, quantity) if isinstance(given, str) else float(given)
        except ValueError as error:
            self.refuse(key, f"{error}{several(f'{self.table}.{key}', given)}")
            return math.nan
        if math.isnan(number) or (finite and math.isinf(number)):
            must = "be finite" if finite else "be a number"
        elif sign == "positive" and not number > 0:
            must = "be positive"
        elif sign == "not negative" and not number >= 0:
            must = "not be negative"
        elif finite and number and not 1 / MOST <= abs(number) <= MOST:
            must = f"be {'' if sign == 'positive' else '0 or '}from {1 / MOST:g} to {MOST:g} in size, in SI units"
        else:
            return number
        self.refuse(key, f"must {must}, got {written(given)}")
        return math.nan

    def values(self, key: str, given: Any, sign: str, ranges: bool = True) -> Any:
        """The value of a key that is named as its quantity: a number, a pair, or an array from a list or a range.

        `ranges` says whether a range is allowed.
        """
        if isinstance(given, tuple):
            pair = [self.value(f"{key}[{k}]", end, key, sign, finite=False) for k, end in enumerate(given)]
            return tuple(sorted(pair) if _are_periods(key, given) else pair)  # a long period is a low speed
        if isinstance(given, list):
            if not given:
                self.refuse(key, "is an empty list")
            return np.array([self.value(f"{key}[{k}]", each, key, sign) for k, each in enumerate(given)])
        if isinstance(given, Spread):
            ends = {"from": given.first, "to": given.last}
            first, last = [self.value(f"{key}.{name}", end, key, sign) for name, end in ends.items()]
            if given.log and first * last <= 0:
                self.refuse(f"{key}.log", "equal ratios need ends that are not 0 and have the same sign")
                return math.nan
            if _are_periods(key, (given.first, given.last)) and not given.log:  # even steps of the period
                return 1 / np.linspace(1 / first, 1 / last, given.steps)
            return (np.geomspace if given.log else np.linspace)(first, last, given.steps)
        if isinstance(given, str) and (words := re.fullmatch(r"(\S.*?)\s+to\s+(.+)", given)):
            to, _, steps = words[2].partition(" in ")
            said = [end if re.fullmatch(r"[+-]?[\d.]+", end) else f'"{end}"' for end in (_with_unit_of(words[1], to), to.strip())]
            count = f", steps = {steps.strip()}" if steps.strip().isdigit() else ""
            range_ = f"a range is written {{from = {said[0]}, to = {said[1]}{count}}}"
            self.refuse(key, f'{range_ if ranges else "must be one number, not a range"}, got "{given}"')
            return math.nan
        return self.value(key, given, key, sign)

    def read(self, table: Table | UnsetType, kind: str = "") -> Given:
        """The numbers of the table that may have a unit, by key.

        Weights become masses if `by_mass`, else masses become weights.

        `kind` comes before the key in the name of the quantity, as in "pin_stiffness".
        """
        found: Given = {}
        if isinstance(table, UnsetType):
            return found
        for name, sign, required in number_fields(type(table)):
            given = getattr(table, name)
            if given is not UNSET or required:
                found[name] = self.value(name, given, kind + name, sign)
        for prefix in ("", "tip_", "added_"):
            if hasattr(table, f"{prefix}mass"):
                self._weigh(table, prefix, found)
        return found

    def _weigh(self, table: Table, prefix: str, found: Given) -> None:
        """Replace mass and weight, the keys with a prefix, by one of them; by none where it may be left out."""
        given = {name: found.pop(name) for name in (f"{prefix}weight", f"{prefix}mass") if name in found}
        optional = prefix or isinstance(table, tables.Support)
        [key, *others] = given or [""]
        heavy = 0.0 if optional and not given else math.nan
        if others:
            self.refuse(key, f"is given beside {others[0]}: give one of them, not both")
        elif given:
            factor = 1.0 if key.endswith(self.heavy) else 1 / self.gravity if self.by_mass else self.gravity
            heavy = given[key] * factor
            if math.isinf(heavy):
                self.refuse(key, f"is too large, got {written(getattr(table, key))}")
        elif not optional:
            self.refuse("", "mass (kg) or weight (N) is missing")
        if heavy or not optional:
            found[prefix + self.heavy] = heavy


def _with_unit_of(number: str, other: str) -> str:
    """A plain number with the unit of another text, such as the 1 of "1 to 60 rpm"; any other text unchanged."""
    unit = re.sub(r"^[+-]?[\d.]+", "", other.strip()).strip()
    return f"{number} {unit}".strip() if re.fullmatch(r"[+-]?[\d.]+", number) else number


def _are_periods(key: str, given: Sequence[Any]) -> bool:
    """Return whether both ends of a range of speeds are given as periods."""
    return SI.get(key, ("", ""))[1] == "an angular speed" and all(speed_unit(end) == "s" for end in given)


def is_by_mass(scene: Tables) -> bool:
    """Return whether masses stay masses: the scene has no weight, or no gravity."""
    if isinstance(scene.held, tables.Held) and scene.held.weightless:
        return True
    return re.search(rb'weight":', json.encode(scene)) is None  # a key: quotes inside text have a backslash


def system_of(scene: Tables, source: str) -> tuple[System | None, float]:
    """The system of a scene and its gravity; None for the system if all its problems are known already.

    All other problems are raised as one error.
    """
    given = [name for name in SYSTEMS if getattr(scene, name) is not UNSET]
    if len(given) != 1:
        choice = "[[links]], [uniform_chain], [tapered_chain], [cord] or [governor]"
        raise SceneError(source, "", f"give one of {choice}, got {' and '.join(given) or 'none of them'}")
    numbers = Numbers(source, by_mass=is_by_mass(scene))
    numbers.gravity = numbers.value("gravity", scene.gravity, "gravity", "positive")
    if scene.links == []:
        raise SceneError(source, "links", "is an empty list: give at least one link")
    if not isinstance(scene.governor, UnsetType):
        governor = _governor(scene, scene.governor, numbers)
        numbers.done()
        return governor, numbers.gravity
    links = scene._links()
    made = _chain_of_links(links, scene.order, numbers) if links else _whole(getattr(scene, given[0]), numbers.of(given[0]))
    system: Whirling | None = made
    if scene.is_rigged and (scene.held is not UNSET or scene.cord is not UNSET):
        name = "cord" if scene.held is UNSET else "held"
        numbers.refuse(name, "does not go with a support, standing links, flywheels or a fluid")
    elif scene.is_rigged:
        assert not isinstance(made, Cord)
        system = _rig(made, scene, numbers)
    elif not isinstance(scene.held, UnsetType):
        system = _held(scene.held, made, numbers.of("held"))
    numbers.done()
    return system, numbers.gravity


def _governor(scene: Tables, table: tables.Governor, numbers: Numbers) -> SleeveGovernor | None:
    """The governor of a scene; None if a number is wrong, which is noted already."""
    for name in ("support", "fluid", "held", "order"):
        if getattr(scene, name) not in (UNSET, "still", "free end first"):
            numbers.refuse(name, "does not go with [governor]: remove it")
    given = numbers.of("governor").read(table)
    if numbers.problems:
        return None
    try:
        return SleeveGovernor(**given, balls=table.balls, gravity=numbers.gravity)
    except ValueError as error:
        numbers.of("governor").refuse_as(error, given)
        return None


def _whole(table: tables.Whole, numbers: Numbers) -> Chain | Cord | None:
    """The chain or cord of a table; None if a number is wrong, which is noted already."""
    given = numbers.read(table)
    particles: list[Given] = []
    if isinstance(table, tables.Cord) and table.masses is not UNSET:
        for k, each in enumerate(table.masses):
            inside = numbers.of(f"masses[{k}]")
            particles.append(inside.read(each))
            if particles[-1]["arc_length"] >= given["length"]:
                end = f"must be below the length of the cord, {given['length']:g}"
                inside.refuse("arc_length", f"{end}, got {written(each.arc_length)}")
    if numbers.problems or math.isnan(sum(given.values()) + sum(sum(each.values()) for each in particles)):
        return None
    try:
        if isinstance(table, tables.Cord):
            many: Given = {"masses" if numbers.by_mass else "weights": _by_place(particles, numbers.heavy)} if particles else {}
            return Cord(**given, density=table.density, **many)
        tip = given.pop(f"tip_{numbers.heavy}", 0.0)
        if isinstance(table, tables.TaperedChain):
            chain = Chain.tapered(table.count, **given, exponent=table.exponent)
        else:
            assert isinstance(table, tables.UniformChain)
            chain = (Chain.uniform_rods if table.kind == "rods" else Chain.uniform_plummets)(table.count, **given)
        return chain.with_body(**{numbers.heavy: tip}) if tip else chain
    except ValueError as error:
        numbers.refuse_as(error, given)
        return None


def _by_place(particles: list[Given], heavy: str) -> dict[float, float]:
    found: dict[float, float] = {}
    for each in particles:
        found[each["arc_length"]] = found.get(each["arc_length"], 0.0) + each[heavy]
    return found


def _chain_of_links(links: Links, order: Order, numbers: Numbers) -> Chain | None:
    """The chain that the links make; None if a number is wrong, which is noted already."""
    repeats = [link.repeat for _, link in links]
    if (count := sum(repeats)) > MOST_LINKS:
        more = "use fewer and longer links, or [cord]"
        numbers.refuse("links", f"must be at most {MOST_LINKS:,} together with their repeats, got {count:,}; {more}")
        return None
    bodies, tips = [], []
    for nth, (index, link) in enumerate(links):
        inside = numbers.of(f"links[{index}]")
        found = inside.read(link)
        tips.append(found.pop(f"tip_{numbers.heavy}", 0.0))
        bodies.append(_body(link, found, inside))
        _check_joints(link, tips[-1], [above for _, above in links[nth + 1 : nth + 2]], inside)
    if numbers.problems or math.isnan(sum(sum(body.values()) for body in bodies) + sum(tips)):
        return None
    given = _columns(bodies, repeats)
    if not given["radius_of_gyration"].any() and np.array_equal(given["centroid"], given["length"]):
        del given["centroid"], given["radius_of_gyration"]
    names = [link.name or f"links[{index}]" for index, link in links for _ in range(link.repeat)]
    try:
        chain = Chain(**given, names=names if any(link.name for _, link in links) else None)
        firsts = accumulate(repeats[:-1], initial=0)
        from_above = list(zip(firsts, tips, links, strict=True))[::-1]  # so that the numbers of lower pins stay valid
        for first, tip, (_, link) in from_above:
            if tip:
                chain = chain.with_body(**{numbers.heavy: tip}, pin=first)
            if link.clamped:
                chain = chain.clamped(first)
        return chain if order == chain.order else Chain._wrap(chain._compiled, chain.by_mass, chain.names, order)
    except ValueError as error:
        numbers.problems.append(problem_of(error, "links", links))
        return None


def _columns(rows: list[Given], repeats: list[int]) -> Given:
    """An array of each key of the rows, with each row repeated."""
    return {name: np.repeat([row[name] for row in rows], repeats) for name in rows[0]}


def _check_joints(link: Link, tip: float, above: list[Link], numbers: Numbers) -> None:
    """Note errors of a link with a weight at its lower pin, or clamped to the link above."""
    if tip and link.repeat > 1:
        numbers.refuse("repeat", f"must be 1 where a weight is fixed to the lower pin, got {link.repeat}")
    if not link.clamped:
        return
    if not above:
        numbers.refuse("clamped", "there is no link above")
    for name in ("standing", "flywheel", "displaced", "pin", "drag", "air_drag"):
        if getattr(link, name) not in (False, UNSET):
            numbers.refuse(name, "must be given for the link above, to which this one is clamped")
    if max(link.repeat, *(each.repeat for each in above), 1) > 1:
        numbers.refuse("clamped", "needs repeat = 1, here and in the link above")


def _body(link: Link, given: Given, numbers: Numbers) -> Given:
    """Mass or weight, length, centroid and radius of gyration of a link from the numbers given for it."""
    length = given["length"]
    body = {numbers.heavy: given[numbers.heavy], "length": length, "centroid": length, "radius_of_gyration": 0.0}
    if link.kind is not UNSET or link.centroid is UNSET:
        for key in ("centroid", "pendulum_length", "radius_of_gyration"):
            if key in given:
                reason = "needs centroid beside it" if link.kind is UNSET else f'does not go with kind = "{link.kind}"'
                numbers.refuse(key, reason)
        rod = {"centroid": length / 2, "radius_of_gyration": length / math.sqrt(12)}
        return body | (rod if link.kind == "rod" else {})
    centroid, radius = given["centroid"], given.get("radius_of_gyration", math.nan)
    if ("pendulum_length" in given) == ("radius_of_gyration" in given):
        numbers.refuse("centroid", "needs either pendulum_length or radius_of_gyration beside it")
    elif "pendulum_length" in given:
        squared = centroid * (given["pendulum_length"] - centroid)
        if centroid == 0:
            reason = "does not determine the inertia if centroid is 0; give radius_of_gyration"
            numbers.refuse("pendulum_length", reason)
        elif 0 <= squared < math.inf:
            radius = math.sqrt(squared)
        elif not math.isnan(squared):
            product = f"centroid (pendulum_length - centroid) is {squared:g}"
            numbers.refuse("pendulum_length", f"makes the radius of gyration imaginary: {product}")
    return body | {"centroid": centroid, "radius_of_gyration": radius}


def _rig(chain: Chain | None, scene: Tables, numbers: Numbers) -> Rig | None:
    """The rig of a chain. If the chain was refused (None), the errors of the other tables are noted, too."""
    links = scene._bodies()
    repeats = [link.repeat for _, link in links]
    support = _support(scene.support, numbers.of("support"))
    heavy, added = numbers.heavy, f"added_{numbers.heavy}"
    wheels, fluids, pins, drags = [], [], [], []
    for (index, link), first in zip(links, accumulate(repeats, initial=0), strict=False):
        inside = numbers.of(f"links[{index}]")
        wheel = {heavy: 0.0, "radius_of_gyration": 0.0, "spin": 0.0}
        wheels.append(wheel | _flywheel(link.flywheel, inside.of("flywheel")))
        fluid = {heavy: 0.0, added: 0.0}
        if chain is not None:
            fluid |= {name: getattr(chain, name)[first] for name in ("centroid", "radius_of_gyration")}
        fluids.append(fluid | inside.of("displaced").read(link.displaced))
        pins.append({"stiffness": 0.0, "damping": 0.0} | inside.of("pin").read(link.pin, "pin_"))
        drags.append(0.0 if link.drag is UNSET else inside.value("drag", link.drag, "drag", "not negative"))
        if scene.fluid == "turning" and fluids[-1][added] > 0:
            inside.refuse("displaced", f"must have no {added} in a fluid that turns with the chain")
    if numbers.problems or chain is None:
        return None
    given: Given = {"fluid": scene.fluid}
    try:
        if scene.support is not UNSET:
            given["support"] = Support(**support)
        if links:
            given["inverted"] = np.repeat([link.standing for _, link in links], repeats)
        if any(link.flywheel is not UNSET for _, link in links):
            driven = [link.flywheel is not UNSET and link.flywheel.driven for _, link in links]
            given["flywheels"] = Flywheel(**_columns(wheels, repeats), driven=np.repeat(driven, repeats))
        if displaced := [link.displaced for _, link in links if not isinstance(link.displaced, UnsetType)]:
            columns = _columns(fluids, repeats)
            if all(each.radius_of_gyration is UNSET for each in displaced):
                del columns["radius_of_gyration"]  # that of the links, with all stored digits
            given["displaced"] = Displaced(**columns)
        if any(link.drag is not UNSET for _, link in links):
            given["drag"] = np.repeat(drags, repeats)
        if any(link.pin is not UNSET for _, link in links):
            given["pins"] = Pin(**_columns(pins, repeats))
        return Rig(chain, **given)
    except ValueError as error:
        numbers.problems.append(problem_of(error, "links" if links else "support", links))
        return None


def has_air_drag(scene: Tables) -> bool:
    """Return whether a link of the scene has quadratic drag of air."""
    whole = scene.uniform_chain if scene.tapered_chain is UNSET else scene.tapered_chain
    if not isinstance(whole, UnsetType):
        return whole.air_drag is not UNSET
    for _, link in scene._bodies():
        if link.air_drag is not UNSET:
            return True
    return False


def air_drag(scene: Tables, density: float | None, numbers: Numbers) -> Drag | None:
    """The drag of air on the links of a scene; None if there is none, or if an error has been noted."""
    whole = scene.uniform_chain if scene.tapered_chain is UNSET else scene.tapered_chain
    if isinstance(whole, UnsetType):
        links = scene._bodies()
        rows = [(link.air_drag, numbers.of(f"links[{index}].air_drag")) for index, link in links]
        repeats = [link.repeat for _, link in links]
    else:
        kind = "uniform_chain" if scene.tapered_chain is UNSET else "tapered_chain"
        rows, repeats = [(whole.air_drag, numbers.of(f"{kind}.air_drag"))], [1]
    given: list[Given] = []
    for table, inside in rows:
        found = {"coefficient": 0.0, "diameter": 0.0, "area": 0.0} | inside.read(table)
        if not isinstance(table, UnsetType) and table.diameter is UNSET and table.area is UNSET:
            inside.refuse("", "give a diameter of the link, an area of a body at it, or both")
        given.append({"body_coefficient": found["coefficient"]} | found)
    if all(table is UNSET for table, _ in rows):
        numbers.refuse("ask.drag", 'no link has drag: write air_drag = {coefficient = 1.1, diameter = "5 mm"} in a link')
    if numbers.problems or math.isnan(sum(sum(row.values()) for row in given)):
        return None
    columns = {name: x if len(repeats) > 1 or repeats[0] > 1 else x[0] for name, x in _columns(given, repeats).items()}
    return Drag(**columns, **({} if density is None else {"density": density}))


def _support(table: tables.Support | UnsetType, numbers: Numbers) -> Given:
    """The arguments of a `Support`, from its table."""
    found = numbers.read(table)
    if found.get("damping", 0.0) > 0 and "stiffness" not in found and numbers.heavy not in found:
        numbers.refuse("damping", "does not go with a firm support: give stiffness (0 for a trolley that rolls freely)")
    return found


def _flywheel(table: tables.Flywheel | UnsetType, numbers: Numbers) -> Given:
    """The numbers of a `Flywheel`; empty if the link has none."""
    found = numbers.read(table)
    if not isinstance(table, UnsetType):
        heavy, radius, spin = (found[name] for name in (numbers.heavy, "radius_of_gyration", "spin"))
        if math.isinf(heavy * radius * radius * spin):
            numbers.refuse("spin", f"gives too large an angular momentum, got {table.spin}")
    return found


def _held(table: tables.Held, system: Chain | Cord | None, numbers: Numbers) -> Held | None:
    """The chain or cord held at both ends; None if it was refused, which is noted already."""
    if (table.span is UNSET) == (table.tension is UNSET):
        numbers.refuse("", "give either span or tension")
        return None
    given = numbers.read(table)
    supports = {end: getattr(table, end) for end in ("lower", "upper") if getattr(table, end) is not UNSET}
    ends = {end: _support(support, numbers.of(end)) for end, support in supports.items()}
    if numbers.problems or system is None:
        return None
    try:
        given |= {end: Support(**support) for end, support in ends.items()}
        return Held(system, **given, weightless=table.weightless)
    except ValueError as error:
        reason = without_function(error)
        key = next(filter(reason.startswith, ends), "span" if table.tension is UNSET else "tension")
        numbers.refuse(key, reason.removeprefix(f"{key} "))
        return None


def in_file(sentence: str, links: Links) -> str:
    """A sentence of the core with the link numbers of the file; the core counts links from the free end with repeats."""
    ends = np.cumsum([link.repeat for _, link in links])

    def there(found: re.Match[str]) -> str:
        index, link = links[int(np.searchsorted(ends, int(found[1]), side="right"))]
        return f"links[{index}]" + (f' ("{link.name}")' if link.name else "")

    return re.sub(r"links\[(\d+)\]", there, sentence) if links else sentence


def problem_of(error: ValueError, key: str, links: Sequence[tuple[int, Link]] = ()) -> Problem:
    """An error of the core as a problem of the file, with the key of the link that it names, or else with `key`."""
    sentence = in_file(without_function(error), list(links))
    if links and (said := re.match(r"(links\[\d+\](?: \(\".*?\"\))?): ", sentence)):
        key, sentence = said[1], sentence[said.end() :]
    return Problem(0, 0, key, sentence)
