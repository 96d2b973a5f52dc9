# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths to the data of a system, such as ``links[0].mass``: the number there, and the system with another number."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import _core
from .chain import Chain, are_rods, checked, compiled
from .cord import Cord
from .held import Held
from .numbers import Floats, shown
from .paths import OF_LINKS, numbered, steps
from .rig import Rig

_MOST_NAMES = 12  # in a message
_LENGTHS = ("length", "centroid", "radius_of_gyration", "length_in_proportion")


@dataclass(frozen=True, slots=True)
class Datum:
    """One number of a system.

    Attributes
    ----------
    path : str
        Path of the number, with an index that counts links from 0 for the lowest.
    present : float
        Present value.
    change : callable
        Returns the system with another value; a ValueError if it cannot have that value.
    typical : float
        A value of ordinary size, positive.
    floor : float or None
        Lower limit of all values; None if they may have either sign.
    ceiling : float
        Upper end of the default range of a search; infinite if there is none.
    rate : (str, ndarray) or None
        Name of the field of the sensitivity, and a factor for each link: the derivative by this datum is the sum of field
        times factor. None if no field has it, and for a cord.
    link : int
        Index of the link, from 0 for the lowest; 0 if the number belongs to no link.
    one_way : bool
        Whether the speeds are known to be monotonic in the number.
    said : str
        Path as the caller writes it: with a name, or an index in the caller's order.
    """

    path: str
    present: float
    change: Callable[[float], Any]
    typical: float
    floor: float | None = 0.0
    ceiling: float = math.inf
    rate: tuple[str, Floats | float] | None = None
    link: int = 0
    one_way: bool = False
    said: str = ""

    @property
    def quantity(self) -> str:
        """The name of the quantity, which decides the unit of the datum."""
        return ("pin_" if self.path.startswith("pins[") else "") + self.path.rpartition(".")[2]

    @property
    def has_scale(self) -> bool:
        """Whether the present value sets the size of a search."""
        return self.floor is None or self.floor < self.present < math.inf


def datum_at(caller: str, system: Any, path: Any, gravity: float, argument: str = "vary") -> Datum:
    """Return the datum at a path of the system, with a link by name or by index in the caller's order; else a ValueError."""
    said, path = path, _counted(caller, system, path, argument)
    name, link = path, None
    if len(parts := steps(path)) == 3 and isinstance(parts[1], int):
        name, link = f"{parts[0]}[k].{parts[2]}", parts[1]
    heavy, other = ("mass", "weight") if system.by_mass else ("weight", "mass")
    known = _paths(system, heavy)
    if not isinstance(name, str) or name not in known:
        if isinstance(name, str) and name.replace(other, heavy) in known:
            hint = f"{str(said).rpartition('.')[0]}.{name.rpartition('.')[2].replace(other, heavy)}".lstrip(".")
            raise ValueError(f'{caller}: the {_kind(system)} was given by {heavy}: {argument} "{hint}", got {shown(said)}')
        if system._kind == "chain" and name == heavy:
            raise ValueError(
                f'{caller}: {argument} must not be "{heavy}" of a whole chain, whose speeds depend on ratios alone; vary '
                f'"links[k].{heavy}" of a link, got {shown(said)}'
            )
        if name == "support.radius":
            raise ValueError(
                f"{caller}: support.radius has no effect on the speeds of small oscillations, only on response and "
                f"steady_shapes; vary another datum, got {shown(said)}"
            )
        if isinstance(said, str) and re.match(r"(link|flywheel|pin)\[", said):
            raise ValueError(f'{caller}: {argument}: did you mean "{said.replace("[", "s[", 1)}"? got {shown(said)}')
        known += ["gravity"] * (argument == "vary")
        listed = ", ".join(f'"{one}"' for one in known)
        names = ", ".join(dict.fromkeys(filter(None, system._listed_names[:_MOST_NAMES])))
        by_name = f" (k: an index or a name, {names})" if names else ""
        raise ValueError(f"{caller}: {argument} must be one of {listed}{by_name} of a {_kind(system)}, got {shown(said)}")
    if link is not None and link >= system.size:
        what = name.partition("[")[0]
        raise ValueError(f"{caller}: {argument} names {what}[{link}], and the highest is {what}[{system.size - 1}]")
    datum = _READ[system._kind.partition(" ")[0]](caller, system, path, link, gravity)
    return replace(datum, link=link or 0, said=said)


def gravity_datum(system: Any, gravity: float) -> Datum:
    """Gravity as a datum: a change of it leaves the system as it is."""
    return Datum("gravity", gravity, lambda x: system, gravity, said="gravity")


def _counted(caller: str, system: Any, path: Any, argument: str) -> Any:
    """The path with the index of its link from the lowest one; anything else is returned unchanged."""
    if not isinstance(path, str) or not path.startswith(OF_LINKS) or system._is_cord:
        return path
    try:
        path = numbered(path, system._listed_names)
    except ValueError as error:
        raise ValueError(f"{caller}: {argument}: {error}") from None
    parts = steps(path)
    if system._listed.step == 1 or len(parts) != 3 or not isinstance(parts[1], int) or parts[1] >= system._base.size:
        return path
    return f"{parts[0]}[{system._base.size - 1 - parts[1]}].{parts[2]}"


def refuse_overlap(caller: str, data: Iterable[Datum]) -> None:
    """Raise a ValueError if two data are the same number, or one changes the other."""
    before: list[Datum] = []
    for one in data:
        for other in before:
            if one.path == other.path or any(_contains(*pair) for pair in ((one.path, other.path), (other.path, one.path))):
                both = f'"{other.said}" and "{one.said}"'
                raise ValueError(f"{caller}: vary has {both}, which change the same number; leave one of them out")
        before.append(one)


def _contains(one: str, other: str) -> bool:
    """Return whether a change of the datum `one` changes the datum `other`."""
    where, _, name = other.rpartition(".")
    if one in ("mass", "weight", "length"):
        return where.startswith("links") and (name == one or (one == "length" and name in _LENGTHS))
    if one.endswith(".length_in_proportion"):
        return where == one.rpartition(".")[0] and name in _LENGTHS
    return one.endswith("].momentum") and where.startswith("flywheels") and name not in ("momentum", "axial_moment")


def _kind(system: Any) -> str:
    return "chain" if system._kind == "chain" else type(system).__name__


def _paths(system: Any, heavy: str) -> list[str]:
    """The paths of a system, with k for the index of a link."""
    if system._kind == "cord":
        return ["length", heavy, f"tip_{heavy}"]
    own = [f"links[k].{name}" for name in (heavy, *_LENGTHS)]
    if system._kind == "chain":
        return ["length", *own]
    if system._is_held:
        ends = "tension" if system.span is None else "span"
        return ["length", heavy, *(() if system._is_cord else own), ends]
    paths = ["length", heavy, *own, "support.stiffness", f"support.{heavy}", "flywheels[k].momentum"]
    wheels = () if system.flywheels is None else system.flywheels._given
    fluid = () if system.displaced is None else system.displaced._given
    paths += [f"flywheels[k].{name}" for name in wheels if name not in ("momentum", "driven")]
    paths += ["links[k].drag"] * (system.drag is not None)
    pins = ("stiffness", "damping") if system.pins is not None else ()
    paths += [f"pins[k].{name}" for name in pins] + ["support.damping"] * (system.support.damping > 0)
    return paths + [f"displaced[k].{name}" for name in fluid]


def _of_chain(caller: str, chain: Chain, path: str, link: int | None, gravity: float) -> Datum:
    whole = compiled(caller, chain).total_weight
    if path in ("mass", "weight"):
        column = np.broadcast_to(chain._compiled.weight, chain.size)
        return Datum(path, whole, lambda x: _scaled(caller, chain, x / whole, 1.0), whole, rate=("mass", column / whole))
    long = chain.total_length
    if path == "length":
        share = chain.length / long
        return Datum(path, long, lambda x: _scaled(caller, chain, 1.0, x / long), long, rate=("length_in_proportion", share))
    assert link is not None
    name = path.rpartition(".")[2]
    own = float(chain.length[link])
    if name == "length" and _is_of_length_alone(chain, link):
        name, path = "length_in_proportion", f"{path}_in_proportion"
    rate = ("mass" if name == "weight" else name, (np.arange(chain.size) == link).astype(float))

    def change(x: float) -> Chain:
        return _with_link(caller, chain, link, name, x)

    if name in ("mass", "weight"):
        present = float(np.broadcast_to(chain._compiled.weight, chain.size)[link])
        return Datum(path, present, change, present or whole, rate=rate)
    present = own if name == "length_in_proportion" else float(getattr(chain, name)[link])
    floor = None if name == "centroid" else 0.0
    return Datum(path, present, change, own, floor, own if name in ("centroid", "radius_of_gyration") else math.inf, rate)


def _is_of_length_alone(chain: Chain, link: int) -> bool:
    """Return whether the length of a link sets its centroid and inertia: a point mass at its lower pin, or a rod."""
    long, centroid, radius = (float(column[link]) for column in (chain.length, chain.centroid, chain.radius_of_gyration))
    return bool(are_rods(long, centroid, radius)) or (radius == 0 and abs(centroid - long) <= 1e-12 * long)


def _scaled(caller: str, chain: Chain, heavier: float, longer: float) -> Chain:
    """The chain with all masses multiplied by one factor and all lengths by another."""
    size, heavy, length, centroid, *rest = chain._compiled.__getstate__()
    return _chain(caller, chain, (size, heavier * heavy, longer * length, longer * centroid, *rest))


def _with_link(caller: str, chain: Chain, link: int, name: str, value: float) -> Chain:
    size, *stored, form = chain._compiled.__getstate__()[:7]  # what follows is for chains that `tapered` made
    heavy, length, centroid, ratio, low = (np.array(np.broadcast_to(column, size)) for column in stored)
    if name in ("mass", "weight"):
        heavy[link] = value
    elif name == "centroid":
        centroid[link] = value
    elif name == "length_in_proportion":
        hangs_low = centroid[link] == length[link]  # a point mass stays one
        centroid[link] = value if hangs_low else centroid[link] * (value / length[link])
        length[link] = value
    else:
        radius = value if name == "radius_of_gyration" else chain.radius_of_gyration[link]
        length[link] = length[link] if name == "radius_of_gyration" else value
        numbers = {"weight": 1.0, "length": length[link], "centroid": length[link], "radius_of_gyration": radius}
        one = checked(caller, False, _core.Chain, **{key: np.asarray(number) for key, number in numbers.items()})
        ratio[link], low[link] = one.__getstate__()[4:6]
    return _chain(caller, chain, (size, heavy, length, centroid, ratio, low, form))


def _chain(caller: str, chain: Chain, state: tuple[Any, ...]) -> Chain:
    made: Chain = checked(caller, chain.by_mass, Chain._from_state, (state, chain.by_mass, chain.names, chain.order))
    return made


def _of_rig(caller: str, rig: Rig, path: str, link: int | None, gravity: float) -> Datum:
    chain, support, wheels, fluid, pins, *rest = rig._state()
    where, _, name = path.rpartition(".")

    def made(**new: Any) -> Rig:
        fittings = {"chain": chain, "support": support, "flywheels": wheels, "displaced": fluid, "pins": pins} | new
        return Rig._from_state((*fittings.values(), *rest))

    if name == "drag":
        assert link is not None and rig.drag is not None
        column = np.broadcast_to(rig.drag, rig.size)
        typical = rig._force(gravity) * chain._compiled.total_weight / math.sqrt(gravity * chain.total_length)

        def dragged(x: float) -> Rig:
            *kept, _ = rig._state()
            return Rig._from_state((*kept, np.where(np.arange(rig.size) == link, x, column)))

        return Datum(path, float(column[link]), dragged, typical)
    if where == "" or where.startswith("links"):
        own = _of_chain(caller, chain, path, link, gravity)
        follows = fluid is not None and name in _LENGTHS and own.path != f"{where}.length"  # the fluid may follow
        return replace(own, change=lambda x: made(chain=own.change(x)), rate=None if follows else own.rate)
    whole, long = chain._compiled.total_weight, chain.total_length
    if where == "support":
        present, typical = rig.support.carriage or 0.0, rig.support.carriage or whole
        rate = "support_mass"
        weight = rig._force(gravity) * whole
        if name == "stiffness":
            present, typical, rate = rig.support.stiffness, weight / long, "stiffness"
        if name == "damping":
            typical = weight / math.sqrt(gravity * long)
            return Datum(path, rig.support.damping, lambda x: made(support={**support, name: x}), typical)
        return Datum(path, present, lambda x: made(support={**support, name: x}), typical, rate=(rate, 1.0))
    assert link is not None
    here = np.arange(rig.size) == link
    part = here.astype(float)
    if name == "momentum":
        kept = rig._own_momentum(gravity)
        moment = rig._turning(gravity)[1]
        typical = rig._force(gravity) * whole * long * math.sqrt(long / gravity)

        def turning(x: float) -> Rig:
            return made(flywheels={"momentum": np.where(here, x, kept), "axial_moment": moment})

        return Datum(path, float(kept[link]), turning, typical, None, rate=("momentum", part))
    what = where.partition("[")[0]
    given = {"flywheels": wheels, "displaced": fluid, "pins": pins}[what]
    column = np.broadcast_to(given.get(name, 0.0), rig.size)
    present = float(column[link])

    def change(x: float) -> Rig:
        return made(**{what: {**given, name: np.where(here, x, column)}})

    if what == "pins":
        torque = rig._force(gravity) * whole * long
        return Datum(path, present, change, torque if name == "stiffness" else torque * math.sqrt(long / gravity))
    if name == "spin":
        return Datum(path, present, change, max(abs(present), math.sqrt(gravity / long)), None, rate=("spin", part))
    if name in ("centroid", "radius_of_gyration"):
        length = float(chain.length[link])
        return Datum(path, present, change, length, None if name == "centroid" else 0.0, length)
    field = "added_mass" if name.startswith("added") else "displaced_mass"
    typical = present or (whole * long**2 if name == "axial_moment" else whole)
    return Datum(path, present, change, typical, rate=(field, part) if what == "displaced" else None)


def _of_held(caller: str, held: Held, path: str, link: int | None, gravity: float) -> Datum:
    def made(system: Chain | Cord, tension: float | None = held.tension) -> Held:
        return held._between_its_ends(system, held.span, tension)

    if path == "span":
        assert held.span is not None
        apart = held.span
        return Datum(path, apart, lambda x: held._between_its_ends(held.system, x, None), apart, ceiling=held.length)
    if path == "tension":
        assert held.tension is not None
        least = 0.0 if held.weightless else held._force(gravity) * held._total
        return Datum(path, held.tension, lambda x: made(held.system, x), held.tension, floor=least, one_way=True)
    own = _READ[held.system._kind](caller, held.system, path, link, gravity)
    # More mass anywhere lowers the tension below it and adds inertia: all speeds fall.
    heavy = path.rpartition(".")[2] in ("mass", "weight")
    floor = held.span if path == "length" and held.span is not None else own.floor
    return replace(
        own, change=lambda x: made(own.change(x)), rate=None, one_way=heavy and held.span is None, floor=floor
    )


def _of_cord(caller: str, cord: Cord, path: str, link: int | None, gravity: float) -> Datum:
    data = cord._state()
    if path == "length":
        return Datum(path, data.length, lambda x: _longer(cord, x / data.length), data.length)
    if path.startswith("tip"):
        return Datum(path, data.tip, lambda x: Cord._from_state(data._replace(tip=x)), data.tip or data.weight)
    return Datum(path, data.weight, lambda x: Cord._from_state(data._replace(weight=x)), data.weight)


def _longer(cord: Cord, factor: float) -> Cord:
    data = cord._state()
    kept = data.density
    if not isinstance(kept, float):
        pieces = kept[1].copy()
        pieces[:, :2] *= factor
        pieces[:, 3:] /= factor
        kept = (factor * data.length, pieces)
    return Cord._from_state(
        data._replace(
            length=factor * data.length,
            density=kept,
            particles=tuple((factor * s, x) for s, x in data.particles),
            tip_centroid=factor * data.tip_centroid,
            tip_radius_of_gyration=factor * data.tip_radius_of_gyration,
        )
    )


_READ: dict[str, Callable[[str, Any, str, int | None, float], Datum]] = {
    "chain": _of_chain, "rig": _of_rig, "cord": _of_cord, "held": _of_held
}  # fmt: skip
