# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensitivity of speeds and shapes to the data of a system, and the uncertainty of speeds that follows from it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import suppress
from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..systems.chain import like
from ..systems.numbers import Floats, Whole, floats, real, refuse_where, shown
from ..systems.paths import link_in_path
from ..systems.units import unpacked, with_tolerance
from .base import Field, Result, UnavailableError
from .sheet import Column, Sheet
from .worst import Moved, WorstCase, worst_of_modes

if TYPE_CHECKING:
    from ..systems.datum import Datum
    from ..systems.rig import Rig
    from .modes import Modes

DATA = ("mass", *_core.DATA[1:])
OF_RIGS = ("momentum", "spin", "displaced_mass", "added_mass", "stiffness", "support_mass")
OF_CORDS = ("length", "mass", "tip_mass", "exponent", "tension", "masses")


class Sensitivity(Result):
    """Derivatives of some numbers with respect to data of a system, all other data constant.

    ``s.mass`` and ``s["mass"]`` are arrays by a datum of the links, shape (R, N), links lowest first, or by another datum,
    shape (R,), for R numbers: the conical heights of the modes of a chain or cord, the whirl speeds of those of a rig, or
    inclinations, offsets and tensions of a steady shape. For a system given by weight, data with "mass" in their names are
    weights. The derivatives of speeds follow from those of heights by ``-angular_speed / (2 * conical_height)``.

    Notes
    -----
    ==============================  =================================================================================
    datum                           with respect to what
    ==============================  =================================================================================
    ``mass``                        mass of a link; of a cord without its tip
    ``length``                      distance between the pins at constant centre of gravity and radius of gyration, so
                                    that a point mass becomes a body; of a cord, stretched with its density and
                                    masses
    ``centroid``                    distance of the centre of gravity below the upper pin
    ``radius_of_gyration``          radius of gyration
    ``length_in_proportion``        a length with which centroid and radius of gyration grow in proportion, as for the
                                    thread of a point mass or a rod
    ``momentum`` ``spin``           angular momentum and spin of a flywheel (0 by spin if given by momentum)
    ``axial_moment``                moment of inertia of the turning parts of a link about its axis
    ``displaced_mass``              mass of fluid that a link displaces
    ``added_mass``                  added mass of a link
    ``stiffness`` ``support_mass``  stiffness of the support, mass that moves with it; 0 if it is firm
    ``masses``                      point masses on a cord, shape (R, n), from the free end
    ``tip_mass`` ``exponent``       tip of a cord; exponent of its density at constant mass (NaN for a function)
    ``tension`` ``span``            tension at the upper end; distance of the ends. For a held shape the one that was not
                                    given is NaN
    ``angular_speed``               speed of a steady shape
    ``support_radius``              radius of the support of a steady shape
    ``lower_radius`` ...            radius, stiffness and mass of the lower and upper end of what is held
    ==============================  =================================================================================

    The position and size of the displaced fluid and the momentum of the flywheel are constant while a datum of a link
    changes.

    Method for modes: ``(y' dM y - height y' dK y) / (y' K y)`` in double-double, from the shape y alone, O(N) for each mode.
    Accuracy: of chains within `error_bound`, which is proved and in most cases 1 to 2 ulp; of rigs that of the shapes,
    1e-14 of the largest; of cords 1e-12 of the height divided by the datum. For shapes: implicit function theorem, O(N^3),
    20 ms for 200 links; 1e-12 of the largest of a kind, or 1e-13 times `SteadyShape.condition` if that is more.

    Examples
    --------
    >>> import revchain as rc
    >>> s = rc.modes(rc.Chain(mass=[1.0, 3.0], length=1.0)).sensitivity
    >>> s.mass
    array([[ 0.1875, -0.0625],
           [-0.1875,  0.0625]])
    >>> s.relative.length_in_proportion.sum(axis=1).round(12)
    array([1., 1.])

    A point mass with a flywheel, ``A n^2 - H n - W a = 0`` with ``A = W a^2 / g``:

    >>> wheels = rc.Flywheel(momentum=[0.0, 0.5])
    >>> m = rc.modes(rc.Rig(rc.Chain(weight=[1.0, 3.0], length=1.0), flywheels=wheels))
    >>> m.sensitivity.momentum[:, 1].round(3)
    array([0.55 , 0.26 , 0.746, 1.713])

    The change of speed of a skipping rope for 1 g more, in rad/s:

    >>> m = rc.modes(rc.Held(rc.Cord(2.0, mass=0.2), tension=10.0), 1)
    >>> (-m.angular_speed / (2 * m.conical_height) * m.sensitivity.mass * 0.001).round(6)
    array([-0.041553])

    The change of the offset of the free end of a steady shape for each rad/s more:

    >>> shape = rc.steady_shapes(rc.Chain(mass=[1.0, 3.0], length=1.0), angular_speed=4.0)[0]
    >>> round(float(shape.sensitivity.offset.angular_speed[0]), 4)
    0.1859
    """

    __slots__ = ()
    of: Field[str] = Field("The quantity that is differentiated, such as ``'conical_height'``.", fact=True)
    row: Field[str] = Field("What a row is: ``'mode'``, ``'link'`` or ``'pin'``.")
    number: Field[Whole] = Field("Mode number, or index of the link or pin, of each row.")
    direction: Field[Whole | None] = Field("Direction of each mode of a rig, 1 forward, -1 backward; else None.")
    value: Field[dict[str, Any]] = Field(
        "The arrays by datum. For a steady shape: a `Sensitivity` for each of ``inclination``, ``offset`` and ``tension``."
    )
    error_bound: Field[Sensitivity | None] = Field(
        "Proved bounds of the absolute errors of the derivatives for a chain, in the same form; else None."
    )
    relative: Field[Sensitivity | None] = Field(
        "Logarithmic derivatives ``(x / height) d(height)/dx`` for chains and cords, in the same form; those of the speeds "
        "are -1/2 times these. Else None."
    )

    @property
    def data(self) -> tuple[str, ...]:
        """The names of the data; for a steady shape those of the quantities."""
        return tuple(self.value)

    def __getitem__(self, datum: str) -> Any:
        if datum not in self.value:
            raise KeyError(f"quantity must be one of {', '.join(self.value)}, got {shown(datum)}")
        return self.value[datum]

    def __getattr__(self, name: str) -> Any:
        if name[0] == "_" or name in self._fields or name not in self.value:
            raise AttributeError(f"a sensitivity of {self.of} has no {name!r}; it has {', '.join(self.value)}")
        return self.value[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self.value)

    def __len__(self) -> int:
        return int(self.number.size)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self.value]

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [Column(self.row, self.number, self.row)]
        if self.direction is not None:
            columns.append(Column("direction", self.direction, "direction"))
        for name, value in self.value.items():
            if isinstance(value, Sensitivity):
                columns += _own(name, value, len(self))
            elif value.ndim == 2:
                columns.append(Column(name, value, f"{name} of the lowest link", axes=("link",), shown=value[:, 0]))
            else:
                columns.append(Column(name, value, name))
        return Sheet(self.row, f"Derivatives of {self.of}; of what there is for each link, the lowest is shown", columns)


def _own(name: str, part: Sensitivity, links: int) -> list[Column]:
    """Columns for a shape: by the speed and, for one pin, by each datum of the links."""
    columns = [Column(f"{name}_by_angular_speed", part.angular_speed[-links:], f"{name} by speed")]
    if name == "offset":
        pin = 0 if "support_radius" in part.value else links // 2  # both ends of what is held hardly move
        for datum, value in part.value.items():
            if value.ndim == 2:
                columns.append(Column(f"offset_by_{datum}", value[pin], f"offset of pin {pin} by its {datum}"))
    return columns


class Uncertainty(Result, row="mode", title="Standard deviations"):
    """Standard deviations of the conical heights and speeds of k modes, to first order.

    Examples
    --------
    >>> import revchain as rc
    >>> u = rc.modes(rc.Chain(mass=[1.0, 3.0], length=1.0)).uncertainty(mass=0.1, length_in_proportion=0.002)
    >>> u.largest
    ('links[0].mass', 'links[0].mass')
    >>> m = rc.modes(rc.Chain(weight=1.0, length=2.4525), gravity=9.81)
    >>> m.uncertainty(length_in_proportion=0.024525).angular_speed.round(12)
    array([0.01])
    >>> rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), support=rc.Support(stiffness=30.0))
    >>> share = rc.modes(rig, 1).uncertainty(stiffness="10 %", length_in_proportion="1 %").share
    >>> share.stiffness.round(3), share.length_in_proportion.round(3)
    (array([0.914]), array([[0.086]]))
    """

    __slots__ = ()
    number: Field[Whole] = Field(
        "Mode numbers, shape (k,), as in `Modes`.", heading="mode", column="mode"
    )
    direction: Field[Whole | None] = Field(
        "Direction of each mode of a rig, shape (k,): 1 forward, -1 backward; else None.", heading="direction"
    )
    conical_height: Field[Floats] = Field(
        "Standard deviation of each conical height, m, shape (k,).", heading="of the height", unit="m"
    )
    relative: Field[Floats] = Field(
        "Standard deviation of each height divided by the height, shape (k,); half as much for speeds.",
        heading="relative, of the height",
    )
    angular_speed: Field[Floats] = Field(
        "Standard deviation of each whirl speed, rad/s, shape (k,), for exact gravity.", heading="of the speed", unit="rad/s"
    )
    frequency: Field[Floats] = Field(
        "Standard deviation of each frequency, Hz, shape (k,).", lambda u: u.angular_speed / (2 * np.pi)
    )
    period: Field[Floats] = Field("Standard deviation of each period, s, shape (k,).", heading="of the period", unit="s")
    share: Field[Sensitivity] = Field(
        "Part of each variance that comes from each datum, in the form of a `Sensitivity`."
    )
    largest: Field[tuple[str, ...]] = Field(
        "For each mode the path of the datum that contributes most, such as ``'links[load].mass'``; empty if the mode is "
        "exact.",
    )
    _largest_part: Field[list[str]] = Field(
        "`largest`, or that there is nothing.",
        lambda u: [path or "nothing" for path in u.largest],
        heading="largest part from",
        column="largest",
        left=True,
    )
    worst: Field[WorstCase | None] = Field(
        "With ``worst=True``: bounds of the speeds over the box of tolerances; else None.", joined=True
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        return super()._sheet(brief) if self.worst is None or not brief else self.worst._sheet(brief)


def by_datum(of: str, modes: Any, value: dict[str, Any], **more: Any) -> Sensitivity:
    """Return a `Sensitivity` of modes from their derivatives by the name of the datum."""
    way = modes.direction if modes.system._kind == "rig" else None
    given = {"error_bound": None, "relative": None, **more}
    return Sensitivity._made(None, of=of, row="mode", number=modes.number, direction=way, value=value, **given)


def sensitivity_of_modes(modes: Modes) -> Sensitivity:
    """Return the derivatives of modes; described by `Modes.sensitivity`."""
    system, kind = modes.system, modes.system._kind
    if kind == "held chain":
        raise UnavailableError(
            "revchain.Modes.sensitivity: is for a Chain, a Rig or a Cord, got a chain held at both ends; change the datum and "
            "call modes again"
        )
    if kind == "rig":
        return by_datum("angular_speed", modes, rig_derivatives(system, modes.angular_speed, modes.shape, modes.gravity))
    heights, data = modes.conical_height.astype(np.float64), _data(system, modes.gravity)
    bounds = None
    if kind == "chain":
        first = int(modes.number[0]) if len(modes) else 1
        found, errors = _core.sensitivity(system._compiled, first, heights)
        values = dict(zip(DATA, found, strict=True))
        bounds = by_datum("conical_height", modes, dict(zip(DATA, errors, strict=True)))
    else:
        try:
            rates: Any = _core.cord_sensitivity(modes._found()) if len(modes) else [np.empty(0)] * len(OF_CORDS)
        except ValueError as error:  # a cord with a bob
            raise UnavailableError(str(error)) from None
        values = {name: rate for name, rate in zip(OF_CORDS, rates, strict=True) if name in data}
        values["tension"] = values["tension"] / system._force(modes.gravity)
    ratio = {name: x * (data[name] / (heights[:, None] if x.ndim == 2 else heights)) for name, x in values.items()}
    relative = by_datum("ln(conical_height) by ln(datum)", modes, ratio)
    return by_datum("conical_height", modes, values, error_bound=bounds, relative=relative)


def rig_derivatives(rig: Rig, speeds: Any, shapes: Any, gravity: float) -> dict[str, Floats]:
    """The derivatives of whirl speeds of a rig with given shapes."""
    under = rig._under(gravity)
    rows = [_core.rig_sensitivity(under, float(n), y, gravity) for n, y in zip(speeds, shapes, strict=True)]
    names = [name for name in (*DATA, *OF_RIGS) if name != "spin"]
    if rows:
        columns: list[Any] = [np.array(column) for column in zip(*rows, strict=True)]
    else:
        columns = [np.empty((0, rig.size))] * (len(names) - 2) + [np.empty(0)] * 2
    found = dict(zip(names, columns, strict=True))
    inertia = 0.0 if rig.flywheels is None else rig.flywheels._inertia
    per = rig._force(gravity)
    spin = found["momentum"] * (inertia / gravity)
    found |= {"spin": spin, "momentum": found["momentum"] / per, "stiffness": found["stiffness"] / per}
    return {name: found[name] for name in (*DATA, *OF_RIGS)}


def uncertainty_of_modes(
    modes: Modes, given: dict[str, Any], paths: Mapping[str, Any], worst: bool = False
) -> Uncertainty:
    """See `Modes.uncertainty`; `given` has the deviations by keyword, `paths` those by path."""
    caller, system, kind = "revchain.Modes.uncertainty", modes.system, modes.system._kind
    if kind == "held chain":
        raise ValueError(
            f"{caller}: is for a Chain, a Rig or a Cord, got a chain held at both ends; change the datum and call modes again"
        )
    sensitivity = modes.sensitivity
    given = _checked(caller, modes, given, sensitivity.data)
    data = _data(system, modes.gravity)
    parts: dict[str, Floats] = {}
    widths: dict[str, Floats] = {}
    for name, rates in sensitivity.value.items():
        spread = np.zeros(())
        if name in given:
            present = np.broadcast_to(data[name], rates.shape[1] if rates.ndim == 2 else 1)
            called = name if system.by_mass else name.replace("mass", "weight")
            spread = widths[name] = _deviations(caller, called, given[name], present)
        each = np.nan_to_num(rates if rates.ndim == 2 else rates[:, None])
        part = each * (each @ spread) if spread.ndim == 2 else (each * spread) ** 2
        parts[name] = part if rates.ndim == 2 else part[:, 0]
    by_path = _by_path(caller, modes, paths, given)
    for datum, spread_of in by_path.values():
        name, factor = _rate(datum)
        rates = np.nan_to_num(sensitivity[name])
        parts[datum.said] = ((rates @ factor if rates.ndim == 2 else rates * factor) * spread_of) ** 2
    table = np.column_stack([*parts.values()])
    variance = np.maximum(table.sum(axis=1), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = {name: np.nan_to_num((part.T / variance).T) for name, part in parts.items()}
    places = [(name, k) for name, part in parts.items() for k in range(part.shape[1] if part.ndim == 2 else 1)]
    deviation, height = np.sqrt(variance), modes.conical_height.astype(np.float64)
    speed = np.abs(modes.angular_speed.astype(np.float64))
    relative = 2 * deviation / speed if kind == "rig" else deviation / height
    return Uncertainty._made(
        None,
        number=modes.number,
        direction=modes.direction if kind == "rig" else None,
        conical_height=relative * height,
        relative=relative,
        angular_speed=0.5 * relative * speed,
        period=0.5 * relative * np.asarray(modes.period, np.float64),
        share=by_datum("part of the variance", modes, share),
        largest=tuple(_largest(system, by_path, places, row) for row in np.abs(table)),
        worst=worst_of_modes(caller, modes, widths, data, _moved(by_path)) if worst else None,
    )


def _moved(by_path: Mapping[str, tuple[Datum, float]]) -> dict[str, Moved]:
    """The data given by path, as `worst_of_modes` takes them."""
    return {path: Moved(*_rate(datum), datum.present, width) for path, (datum, width) in by_path.items()}


def _rate(datum: Datum) -> tuple[str, Any]:
    """Name of the derivative by a datum, and its factor for each link."""
    return datum.rate or (datum.path.replace("weight", "mass"), 1.0)


def _largest(system: Any, paths: Mapping[str, Any], places: list[tuple[str, int]], parts: Floats) -> str:
    """The path of the datum with the largest part of a variance; empty if all are 0."""
    name, link = places[most := int(parts.argmax())]
    return "" if not parts[most] else name if name in paths else _path(system, name, link)


def _by_path(
    caller: str, modes: Modes, paths: Mapping[str, Any], given: dict[str, Any]
) -> dict[str, tuple[Datum, float]]:
    """The data of a dictionary by path, with their standard deviations."""
    from ..systems.datum import datum_at

    if not isinstance(paths, Mapping):
        raise ValueError(f'{caller}: data must be a dictionary such as {{"links[load].mass": "5 %"}}, got {shown(paths)}')
    system: Any = modes.system
    deviations: dict[str, tuple[Datum, float]] = {}
    known: dict[str, str] = {}
    for path, value in paths.items():
        datum = datum_at(caller, system, path, modes.gravity, "data")
        if datum.path in known:
            both = f'"{known[datum.path]}" and "{datum.said}"'
            raise ValueError(f"{caller}: {both} are the same number; leave one of them out")
        known[datum.path] = datum.said
        name, _ = _rate(datum)
        if datum.rate is None and not system._is_cord:
            why = "no derivative of the speeds by it is computed; change the datum and call modes again"
            raise ValueError(f"{caller}: {datum.said}: {why}, got {shown(value)}")
        if twice := {name, datum.said} & given.keys():
            raise ValueError(f'{caller}: give either {min(twice)} or "{datum.said}", got both')
        if not np.isfinite(datum.present):
            raise ValueError(f"{caller}: {datum.said} is for a support on a spring, and this one is firm; leave it out")
        size = _spread(f"{caller}: {datum.quantity}", unpacked(value), datum.present)
        if isinstance(size, str) and size.strip().endswith("%"):
            size = _part(f"{caller}: {datum.said}", size) * abs(datum.present)
        size = real(caller, f"{datum.quantity} (deviation of {datum.said})", size)
        if not 0 <= size < np.inf:
            raise ValueError(f"{caller}: {datum.said}: the deviation must be finite and not negative, got {shown(value)}")
        deviations[datum.said] = datum, size
    return deviations


_OF_FITTINGS = {
    "momentum": "flywheels.momentum", "spin": "flywheels.spin", "displaced_mass": "displaced.mass",
    "added_mass": "displaced.added_mass", "stiffness": "support.stiffness", "support_mass": "support.mass",
}  # fmt: skip


def _path(system: Any, name: str, link: int) -> str:
    """The path of a datum of a link, of a fitting or of a cord, from its name in a `Sensitivity`."""
    where, _, name = _OF_FITTINGS.get(name, name if system._is_cord else f"links.{name}").rpartition(".")
    name = name if system.by_mass else name.replace("mass", "weight")
    if where in ("", "support"):
        return f"{where}.{name}".lstrip(".")
    number = link if system._listed.step == 1 else system._base.size - 1 - link
    return f"{link_in_path(where, number, system._listed_names)}.{name}"


def _checked(caller: str, modes: Modes, given: dict[str, Any], known: tuple[str, ...]) -> dict[str, Any]:
    """Return the deviations by the names of their data; a ValueError for a datum that the system lacks."""
    system, kind = modes.system, modes.system._kind
    given, heavy = dict(given), "mass" if system.by_mass else "weight"
    if kind in ("chain", "rig") and ("mass" in given or "weight" in given):
        given["mass"] = like(caller, _links(system), given.get("mass"), given.pop("weight", None))
    elif kind not in ("chain", "rig"):
        other = "weight" if system.by_mass else "mass"
        for name in [name for name in given if other in name]:
            wanted = name.replace(other, heavy)
            raise ValueError(f"{caller}: the cord was given by {heavy}: give {wanted}, not {name}, got {shown(given[name])}")
        given = {name.replace("weight", "mass"): value for name, value in given.items()}
        held = kind.startswith("held")
        for name in given:
            if name in (("tip_mass", "exponent") if held else ("tension",)):
                why = "is for a hanging cord" if held else "is for a cord held at both ends"
                called = name.replace("mass", heavy)
                raise ValueError(f"{caller}: {called} {why}; leave it out, got {shown(given[name])}")
        if "exponent" in given and not isinstance(system.density, float):
            why = "the density was given as a function and has no exponent"
            raise ValueError(f"{caller}: {why}, got {shown(given['exponent'])}")
    for name, value in given.items():
        if name not in known:
            raise ValueError(f"{caller}: a {kind} has no {name}; leave it out, got {shown(value)}")
    if "spin" in given and (system.flywheels is None or "spin" not in system.flywheels._given):
        raise ValueError(f"{caller}: spin is for flywheels that were given by spin; give momentum, got {shown(given['spin'])}")
    if "spin" in given and "momentum" in given:
        raise ValueError(f"{caller}: give either spin or momentum, got both")
    if "stiffness" in given and not np.isfinite(system.support.stiffness):
        why = "stiffness is for a support on a spring, and this one is firm; leave it out"
        raise ValueError(f"{caller}: {why}, got {shown(given['stiffness'])}")
    return given


def _links(system: Any) -> Any:
    return system.chain if system._kind == "rig" else system


def _data(system: Any, gravity: float) -> dict[str, Any]:
    """The data by name: a number, or one for each link."""
    if system._kind.endswith("cord"):
        held = system._kind == "held cord"
        cord = system.system if held else system
        exponent = cord.density if isinstance(cord.density, float) else np.nan
        weights = cord._compiled.weight, cord._compiled.tip_weight
        values = (cord.length, *weights, exponent, (held and system.tension) or 0.0)
        own = {"masses": np.array(list(cord._particles.values()))} if cord._particles else {}
        return dict(zip(OF_CORDS, values, strict=False)) | own
    chain = _links(system)
    found = {name: getattr(chain, name) for name in DATA[1:4]}
    found |= {"mass": chain.mass if chain.by_mass else chain.weight, "length_in_proportion": chain.length}
    if system._kind == "rig":
        wheels = {} if system.flywheels is None else system.flywheels._given
        fluid = {} if system.displaced is None else system.displaced._given
        found |= {
            "momentum": system._own_momentum(gravity),
            "spin": wheels.get("spin", 0.0),
            "displaced_mass": fluid.get("mass", fluid.get("weight", 0.0)),
            "added_mass": fluid.get("added_mass", fluid.get("added_weight", 0.0)),
            "stiffness": system.support.stiffness,
            "support_mass": system.support.carriage,
        }
    return found


def _deviations(caller: str, name: str, given: Any, data: Floats) -> Floats:
    """Standard deviations (a number, or one for each datum), or their covariance."""
    value, size = unpacked(given), data.size
    if isinstance(value, str):
        value = [value] * size
    if isinstance(value, np.ndarray) and value.dtype.kind == "U":
        value = value.tolist()
    if isinstance(value, list | tuple):
        value = _parts_of_data(f"{caller}: {name}", value, np.abs(data))
    array = floats(caller, name, value)
    if array.shape not in ((), (size,), (size, size)):
        raise ValueError(
            f"{caller}: {name} must be a number, one for each of the {size} links, or their covariance of shape "
            f"({size}, {size}), got shape {array.shape}"
        )
    if array.ndim < 2:
        refuse_where(~(np.isfinite(array) & (array >= 0)), array, f"{caller}: {name} must be finite and not negative")
    elif not (np.isfinite(array).all() and (array == array.T).all() and (array.diagonal() >= 0).all()):
        raise ValueError(f"{caller}: covariance of {name} must be finite, symmetric, and no variance negative")
    return array


def _parts_of_data(caller: str, value: Any, data: Floats) -> list[Any]:
    """Deviations; those given in percent are multiplied by the data."""
    of = [data[k] if k < len(data) else 1.0 for k in range(len(value))]
    spreads = [_spread(caller, one, float(datum)) for one, datum in zip(value, of, strict=True)]
    return [
        _part(caller, one) * float(datum) if isinstance(one, str) and one.strip().endswith("%") else one
        for one, datum in zip(spreads, of, strict=True)
    ]


def _spread(caller: str, given: Any, datum: float) -> Any:
    """The text after +- in text such as "38 m +- 0.5 m"; other values unchanged."""
    parts = with_tolerance(given) if isinstance(given, str) else None
    if parts is None:
        return given
    value, spread = parts
    if value and abs(float(floats(*_named(caller), value)) - datum) > 1e-6 * datum:
        name = _named(caller)[1]
        raise ValueError(
            f'{caller} of the system is {datum:.9g}, not "{value}": write "+- {spread}", or give the system that {name}'
        )
    return spread


def _named(caller: str) -> tuple[str, str]:
    function, _, name = caller.rpartition(": ")
    return function, name


def _part(caller: str, text: str) -> float:
    with suppress(ValueError):
        return float(text.strip().removesuffix("%")) / 100
    raise ValueError(f'{caller} must be a number, or a part of it such as "5 %", got {shown(text)}')
