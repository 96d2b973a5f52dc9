# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensitivity and uncertainty of the conical heights and speeds of a chain or a rig."""

from __future__ import annotations

from contextlib import suppress
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.chain import checked, like
from ..systems.numbers import Floats, Whole, floats, refuse_where, shown
from ..systems.units import unpacked
from .base import Field, Result, UnavailableError
from .sheet import Column, Sheet

if TYPE_CHECKING:
    from ..systems.rig import Rig
    from .modes import Modes


DATA = ("mass", *_core.DATA[1:])


class _ByDatum(Result):
    """One array for each datum of a link."""

    __slots__ = ()
    _known: ClassVar[tuple[str, ...]] = DATA
    number: Field[Whole] = Field("Mode numbers, shape (k,).")

    def __getitem__(self, quantity: str) -> Floats:
        """The array of a quantity by its name."""
        if quantity not in self._known:
            raise KeyError(f"quantity must be one of {', '.join(self._known)}, got {shown(quantity)}")
        return getattr(self, quantity)  # type: ignore[no-any-return]

    def _columns(self) -> list[Column]:
        return [Column("mode", self.number, "mode"), *datum_columns(self, self._known)]


def datum_columns(result: Result, names: tuple[str, ...]) -> list[Column]:
    """A column for each field; a field with a number for each link shows that of the lowest link."""
    columns = []
    for name in names:
        values = getattr(result, name)
        of_links = {"axes": ("link",), "shown": values[:, 0]} if values.ndim == 2 else {}
        columns.append(Column(name, values, f"{name} of links[0]" if of_links else name, **of_links))
    return columns


class Derivatives(_ByDatum):
    """Numbers for each mode, link and datum of the link.

    Examples
    --------
    >>> import revchain as rc
    >>> relative = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).sensitivity.relative
    >>> relative.length_in_proportion.sum(axis=1).round(12)
    array([1., 1.])
    """

    __slots__ = ()
    mass: Field[Floats] = Field("Numbers for the masses, shape (k, N), links lowest first; see `Sensitivity.mass`.")
    length: Field[Floats] = Field("Numbers for the lengths, shape (k, N); see `Sensitivity.length`.")
    centroid: Field[Floats] = Field("Numbers for the centroids, shape (k, N); see `Sensitivity.centroid`.")
    radius_of_gyration: Field[Floats] = Field(
        "Numbers for the radii of gyration, shape (k, N); see `Sensitivity.radius_of_gyration`."
    )
    length_in_proportion: Field[Floats] = Field(
        "Numbers for lengths in proportion, shape (k, N); see `Sensitivity.length_in_proportion`."
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        return Sheet("mode", "Values by datum; the lowest link is shown", self._columns())


class Sensitivity(_ByDatum):
    """Derivatives of the conical heights of k modes with respect to the data of N links.

    All other data are constant.

    Notes
    -----
    Method: ``(y' dM y - height y' dK y) / (y' K y)`` in double-double, from the shape y alone. Heights depend on ratios of
    masses: the relative derivatives of a mode by masses add up to 0. Those by lengths, centroids and radii of gyration add
    up to 1. Those by lengths in proportion also add up to 1; each is the link's share of the potential energy. Cost: O(N)
    for each mode.

    Examples
    --------
    >>> import revchain as rc
    >>> s = rc.modes(rc.Chain(mass=[1.0, 3.0], length=1.0)).sensitivity
    >>> s.mass
    array([[ 0.1875, -0.0625],
           [-0.1875,  0.0625]])
    >>> s.length_in_proportion
    array([[0.75, 0.75],
           [0.25, 0.25]])
    """

    __slots__ = ()
    mass: Field[Floats] = Field(
        "d(conical height)/d(mass), m/kg, shape (k, N), links lowest first; for a chain given by weight, with respect to its "
        "weights.",
    )
    length: Field[Floats] = Field(
        "Derivative with respect to the distance between the pins, at constant centre of gravity and radius of gyration: only "
        "the lower pin moves. 0 for the lowest link. A point mass becomes a body.",
    )
    centroid: Field[Floats] = Field(
        "Derivative with respect to the distance of the centre of gravity below the upper pin."
    )
    radius_of_gyration: Field[Floats] = Field(
        "Derivative with respect to the radius of gyration: never negative, 0 if the radius is 0."
    )
    length_in_proportion: Field[Floats] = Field(
        "Derivative with respect to a length with which centroid and radius of gyration grow in proportion, as for the thread "
        "of a point mass or a rod. Never negative.",
    )
    error_bound: Field[Derivatives] = Field(
        "Proved bound of the absolute error of each derivative: in most cases half an ulp."
    )
    relative: Field[Derivatives] = Field(
        "Logarithmic derivatives ``(x / height) d(height)/dx``. Those of the speeds are -1/2 times these."
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        return Sheet("mode", "Derivatives of the conical heights; those for the lowest link are shown", self._columns())


class Uncertainty(Result):
    """Standard deviations of the conical heights and speeds of k modes, to first order.

    Examples
    --------
    >>> import revchain as rc
    >>> u = rc.modes(rc.Chain(mass=[1.0, 3.0], length=1.0)).uncertainty(mass=0.1, length_in_proportion=0.002)
    >>> u.largest
    (('mass', 0), ('mass', 0))
    >>> m = rc.modes(rc.Chain(weight=1.0, length=2.4525), gravity=9.81)
    >>> m.uncertainty(length_in_proportion=0.024525).angular_speed.round(12)
    array([0.01])
    """

    __slots__ = ()
    number: Field[Whole] = Field("Mode numbers, shape (k,).")
    conical_height: Field[Floats] = Field("Standard deviation of each conical height, m, shape (k,).")
    relative: Field[Floats] = Field(
        "Standard deviation of each height divided by the height, shape (k,). For speeds, periods and frequencies it is half "
        "as much.",
    )
    angular_speed: Field[Floats] = Field(
        "Standard deviation of each whirl speed, rad/s, shape (k,), for exact gravity."
    )
    frequency: Field[Floats] = Field(
        "Standard deviation of each frequency, Hz, shape (k,).", lambda u: u.angular_speed / (2 * np.pi)
    )
    period: Field[Floats] = Field("Standard deviation of each period, s, shape (k,).")
    share: Field[Derivatives] = Field(
        "Part of each variance that comes from each datum of each link; the parts of a mode add up to 1. With a covariance a "
        "part may be negative.",
    )
    largest: Field[tuple[tuple[str, int], ...]] = Field(
        "For each mode the datum that contributes most, and its link, counted from 0."
    )

    names: Field[tuple[str, ...] | None] = Field("Names of the links; None if no names were given.")

    def _most(self, row: int) -> str:
        datum, link = self.largest[row]
        if not self.relative[row]:
            return "nothing"
        return f"{datum} of {self.names[link] if self.names else f'links[{link}]'}"

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("mode", self.number, "mode"),
            Column("conical_height", self.conical_height, "of the height (m)"),
            Column("relative", self.relative, "relative, of the height"),
            Column("angular_speed", self.angular_speed, "of the speed (rad/s)"),
            Column("period", self.period, "of the period (s)"),
            Column("largest", [self._most(row) for row in range(len(self.largest))], "largest part from"),
        ]
        return Sheet("mode", "Standard deviations", columns)


def _data(chain: Any) -> dict[str, Floats]:
    return {
        "mass": chain.mass if chain.by_mass else chain.weight,
        "length": chain.length,
        "centroid": chain.centroid,
        "radius_of_gyration": chain.radius_of_gyration,
        "length_in_proportion": chain.length,
    }


def _part(place: str, text: str) -> float:
    with suppress(ValueError):
        return float(text.strip().removesuffix("%")) / 100
    raise ValueError(f'{place} must be a number, or a part of it such as "5 %", got {shown(text)}')


def _parts_of_data(place: str, value: Any, data: Floats) -> list[Any]:
    """Deviations; those given in percent are multiplied by the data."""
    of = [data[k] if k < len(data) else 1.0 for k in range(len(value))]
    return [
        _part(place, one) * float(datum) if isinstance(one, str) and one.strip().endswith("%") else one
        for one, datum in zip(value, of, strict=True)
    ]


def of_modes(modes: Modes) -> Sensitivity:
    """`Modes.sensitivity`."""
    chain = modes.system
    first = int(modes.number[0]) if len(modes) else 1
    heights = modes.conical_height.astype(np.float64)
    values, bounds = _core.sensitivity(chain._compiled, first, heights)
    data = _data(chain)
    named = dict(zip(DATA, values, strict=True))
    relative = {name: value * (data[name] / heights[:, None]) for name, value in named.items()}
    return Sensitivity._made(
        None,
        number=modes.number,
        **named,
        error_bound=_derivatives(modes, bounds),
        relative=_derivatives(modes, relative.values()),
    )


def _derivatives(modes: Modes, values: Any) -> Derivatives:
    return Derivatives._made(None, number=modes.number, **dict(zip(DATA, values, strict=True)))


def uncertainty(modes: Modes, given: dict[str, ArrayLike | None]) -> Uncertainty:
    """`Modes.uncertainty`."""
    place = "revchain.Modes.uncertainty"
    if given["mass"] is not None or given["weight"] is not None:
        given["mass"] = like(place, modes.system, given["mass"], given["weight"])
    data = _data(modes.system)
    deviations = [None if given[name] is None else _deviations(place, name, given[name], data[name]) for name in DATA]
    sensitivity: Any = modes.sensitivity
    heights = modes.conical_height.astype(np.float64)
    of = [sensitivity[name] for name in DATA]
    found = checked(place, modes.system.by_mass, _core.uncertainty, heights, of, deviations)
    height, relative, share, datum, link = found
    return Uncertainty._made(
        None,
        number=modes.number,
        names=modes.system.names,
        conical_height=height,
        relative=relative,
        angular_speed=0.5 * relative * np.asarray(modes.angular_speed, np.float64),
        period=0.5 * relative * np.asarray(modes.period, np.float64),
        share=_derivatives(modes, share),
        largest=tuple((each.replace("weight", "mass"), k) for each, k in zip(datum, link, strict=True)),
    )


class _ByRigDatum(_ByDatum):
    """One array for each datum of the links of a rig, and of its support."""

    __slots__ = ()
    _known = (*DATA, "momentum", "spin", "displaced_mass", "added_mass", "stiffness", "support_mass")
    number: Field[Whole] = Field("Number of each mode among those of its direction, shape (k,).")
    direction: Field[Whole] = Field("Direction of each mode, shape (k,): 1 forward, -1 backward.")

    def _columns(self) -> list[Column]:
        mode, *columns = super()._columns()
        return [mode, Column("direction", self.direction, "direction"), *columns]


class RigDerivatives(_ByRigDatum):
    """Numbers for each mode, link and datum of a rig.

    Examples
    --------
    >>> import revchain as rc
    >>> rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), support=rc.Support(stiffness=30.0))
    >>> share = rc.modes(rig, 1).uncertainty(stiffness="10 %", length_in_proportion="1 %").share
    >>> share.stiffness.round(3), share.length_in_proportion.round(3)
    (array([0.914]), array([[0.086]]))
    """

    __slots__ = ()
    mass: Field[Floats] = Field("Numbers for the masses, shape (k, N), links lowest first; see `RigSensitivity`.")
    length: Field[Floats] = Field("Numbers for the lengths, shape (k, N).")
    centroid: Field[Floats] = Field("Numbers for the centroids, shape (k, N).")
    radius_of_gyration: Field[Floats] = Field("Numbers for the radii of gyration, shape (k, N).")
    length_in_proportion: Field[Floats] = Field("Numbers for lengths in proportion, shape (k, N).")
    momentum: Field[Floats] = Field("Numbers for the momenta of flywheels, shape (k, N).")
    spin: Field[Floats] = Field("Numbers for the spins of flywheels, shape (k, N).")
    displaced_mass: Field[Floats] = Field("Numbers for the displaced masses, shape (k, N).")
    added_mass: Field[Floats] = Field("Numbers for the added masses, shape (k, N).")
    stiffness: Field[Floats] = Field("Numbers for the stiffness of the support, shape (k,).")
    support_mass: Field[Floats] = Field("Numbers for the mass that moves with the support, shape (k,).")

    def _sheet(self, brief: bool = False) -> Sheet:
        return Sheet("mode", "Values by datum; the lowest link is shown", self._columns())


class RigSensitivity(_ByRigDatum):
    """Derivatives of the whirl speeds of k modes of a rig with respect to each of its data; all other data are constant.

    The derivatives of the conical height ``lambda = gravity / n**2`` follow from ``d lambda = -2 * lambda / n * dn``. The
    radius of the support has no effect on the speeds of small oscillations.

    Notes
    -----
    Method: ``y' (K + n G - n^2 M / g) y = 0`` is stationary in the shape y. Accuracy: that of the shapes, 1e-14 of the
    largest. Cost: O(N) for each mode.

    Examples
    --------
    A point mass with a flywheel, ``A n^2 - H n - W a = 0`` with ``A = W a^2 / g``:

    >>> import revchain as rc
    >>> wheels = rc.Flywheel(momentum=[0.0, 0.5])
    >>> m = rc.modes(rc.Rig(rc.Chain(weight=[1.0, 3.0], length=1.0), flywheels=wheels))
    >>> m.angular_speed.round(3)
    array([-2.315,  2.722, -3.939,  5.166])
    >>> m.sensitivity.momentum[:, 1].round(3)
    array([0.55 , 0.26 , 0.746, 1.713])
    """

    __slots__ = ()
    mass: Field[Floats] = Field(
        "Derivative with respect to the mass of each link, shape (k, N). For a chain given by weight, masses here and below are "
        "weights.",
    )
    length: Field[Floats] = Field(
        "Derivative with respect to the distance between the pins of each link, shape (k, N): only the lower pin moves; the "
        "momentum of the flywheel and the place and size of the displaced fluid are constant.",
    )
    centroid: Field[Floats] = Field(
        "Derivative with respect to the distance of the centre of gravity below the upper pin, shape (k, N)."
    )
    radius_of_gyration: Field[Floats] = Field(
        "Derivative with respect to the radius of gyration of each link, shape (k, N)."
    )
    length_in_proportion: Field[Floats] = Field(
        "Derivative with respect to a length with which centroid and radius of gyration grow in proportion, shape (k, N).",
    )
    momentum: Field[Floats] = Field(
        "Derivative with respect to the angular momentum of each flywheel, shape (k, N)."
    )
    spin: Field[Floats] = Field(
        "Derivative with respect to the spin of each flywheel, shape (k, N); 0 if flywheels were given by momentum."
    )
    displaced_mass: Field[Floats] = Field(
        "Derivative with respect to the mass of fluid that each link displaces, shape (k, N)."
    )
    added_mass: Field[Floats] = Field("Derivative with respect to the added mass of each link, shape (k, N).")
    stiffness: Field[Floats] = Field(
        "Derivative with respect to the stiffness of the support, shape (k,); 0 if it is firm."
    )
    support_mass: Field[Floats] = Field(
        "Derivative with respect to the mass that moves with the support, shape (k,); 0 if it is firm."
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        return Sheet("mode", "Derivatives of the whirl speeds; those for the lowest link are shown", self._columns())


class RigUncertainty(Uncertainty):
    """Standard deviations of the conical heights and speeds of k modes of a rig, to first order.

    Examples
    --------
    >>> import revchain as rc
    >>> rig = rc.Rig(rc.Chain(mass=1.0, length=1.0), support=rc.Support(stiffness=30.0))
    >>> u = rc.modes(rig, 1).uncertainty(stiffness="10 %", length_in_proportion="1 %")
    >>> u.largest
    (('stiffness', 0),)
    """

    __slots__ = ()
    number: Field[Whole] = Field("Number of each mode among those of its direction, shape (k,).")
    direction: Field[Whole] = Field("Direction of each mode, shape (k,): 1 forward, -1 backward.")
    share: Field[RigDerivatives] = Field(  # type: ignore[assignment]
        "Part of each variance that comes from each datum; the parts of a mode add up to 1. With a covariance a part may be "
        "negative.",
    )
    largest: Field[tuple[tuple[str, int], ...]] = Field(
        "For each mode the datum that contributes most, and its link, counted from 0 (0 for the support)."
    )

    def _most(self, row: int) -> str:
        datum = self.largest[row][0]
        named = {"stiffness": "stiffness of the support", "support_mass": "mass of the support"}
        return named.get(datum, super()._most(row)) if self.relative[row] else "nothing"

    def _sheet(self, brief: bool = False) -> Sheet:
        sheet = super()._sheet(brief)
        sheet.columns.insert(1, Column("direction", self.direction, "direction"))
        return sheet


def of_rig(modes: Modes) -> RigSensitivity:
    """`Modes.sensitivity`."""
    found = rig_derivatives(modes.system, modes.angular_speed, modes.shape, modes.gravity)
    return RigSensitivity._made(None, number=modes.number, direction=modes.direction, **found)


def rig_derivatives(rig: Rig, speeds: Any, shapes: Any, gravity: float) -> dict[str, Floats]:
    """The derivatives of `RigSensitivity` for modes with given speeds and shapes."""
    under = rig._under(gravity)
    rows = [_core.rig_sensitivity(under, float(n), y, gravity) for n, y in zip(speeds, shapes, strict=True)]
    names = [name for name in _ByRigDatum._known if name != "spin"]
    if rows:
        columns: list[Any] = [np.array(column) for column in zip(*rows, strict=True)]
    else:
        columns = [np.empty((0, rig.size))] * (len(names) - 2) + [np.empty(0)] * 2
    found = dict(zip(names, columns, strict=True))
    inertia = 0.0 if rig.flywheels is None else rig.flywheels._inertia
    per = rig._force(gravity)
    spin = found["momentum"] * (inertia / gravity)
    return found | {"spin": spin, "momentum": found["momentum"] / per, "stiffness": found["stiffness"] / per}


def shared_out(parts: dict[str, Floats]) -> tuple[Floats, Floats, dict[str, Floats]]:
    """The parts of the variance of each mode side by side, their sum, and the share of each datum in it."""
    table = np.column_stack([*parts.values()])
    variance = np.maximum(table.sum(axis=1), 0.0)
    with np.errstate(divide="ignore", invalid="ignore"):
        share = {n: np.nan_to_num(p / (variance[:, None] if p.ndim == 2 else variance)) for n, p in parts.items()}
    return table, variance, share


def rig_uncertainty(modes: Modes, given: dict[str, ArrayLike | None]) -> RigUncertainty:
    """`Modes.uncertainty`."""
    place, rig = "revchain.Modes.uncertainty", modes.system
    if given["mass"] is not None or given["weight"] is not None:
        given["mass"] = like(place, rig.chain, given["mass"], given["weight"])
    wheels = {} if rig.flywheels is None else rig.flywheels._given
    if given["spin"] is not None and "spin" not in wheels:
        raise ValueError(f"{place}: spin is for flywheels that were given by spin; give momentum, got {shown(given['spin'])}")
    if given["spin"] is not None and given["momentum"] is not None:
        raise ValueError(f"{place}: give either spin or momentum, got both")
    if given["stiffness"] is not None and not np.isfinite(rig.support.stiffness):
        why = "stiffness is for a support on a spring, and this one is firm; leave it out"
        raise ValueError(f"{place}: {why}, got {shown(given['stiffness'])}")
    sensitivity: Any = modes.sensitivity
    parts: dict[str, Floats] = {}
    for name in _ByRigDatum._known:
        rates = sensitivity[name]
        of_links = rates.ndim == 2
        spread = np.zeros(())
        if given[name] is not None:
            data = np.broadcast_to(_rig_data(rig, name, modes.gravity), rig.size if of_links else 1)
            called = name if rig.by_mass else name.replace("mass", "weight")
            spread = _deviations(place, called, given[name], data)
            _refuse_no_deviations(place, called, spread)
        rates = rates if of_links else rates[:, None]
        part = rates * (rates @ spread) if spread.ndim == 2 else (rates * spread) ** 2
        parts[name] = part if of_links else part[:, 0]
    table, variance, share = shared_out(parts)
    speed = np.sqrt(variance)
    places = [(name, k) for name, part in parts.items() for k in range(part.shape[1] if part.ndim == 2 else 1)]
    relative = 2 * speed / np.abs(modes.angular_speed)
    return RigUncertainty._made(
        None,
        number=modes.number,
        direction=modes.direction,
        names=rig.chain.names,
        conical_height=relative * modes.conical_height,
        relative=relative,
        angular_speed=speed,
        period=0.5 * relative * modes.period,
        share=RigDerivatives._made(None, number=modes.number, direction=modes.direction, **share),
        largest=tuple(places[k] for k in np.abs(table).argmax(axis=1)),
    )


def _rig_data(rig: Rig, name: str, gravity: float) -> Any:
    """The data of a rig by name, a number or one for each link."""
    if name in DATA:
        return _data(rig.chain)[name]
    if name == "momentum":
        return rig._own_momentum(gravity)
    if name in ("stiffness", "support_mass"):
        return rig.support.stiffness if name == "stiffness" else rig.support.carriage
    given = (rig.flywheels if name == "spin" else rig.displaced) or rig.support
    named = {"displaced_mass": ("mass", "weight"), "added_mass": ("added_mass", "added_weight"), "spin": ("spin",)}
    return next((given._given[key] for key in named[name] if key in given._given and given is not rig.support), 0.0)


def _deviations(place: str, name: str, given: Any, data: Floats) -> Floats:
    """Standard deviations (a number, or one for each datum), or their covariance."""
    value, size = unpacked(given), data.size
    if isinstance(value, str):
        value = [value] * size
    if isinstance(value, np.ndarray) and value.dtype.kind == "U":
        value = value.tolist()
    if isinstance(value, list | tuple):
        value = _parts_of_data(f"{place}: {name}", value, np.abs(data))
    array = floats(place, name, value)
    if array.shape not in ((), (size,), (size, size)):
        raise ValueError(
            f"{place}: {name} must be a number, one for each of the {size} links, or their covariance of shape "
            f"({size}, {size}), got shape {array.shape}"
        )
    return array


def _refuse_no_deviations(place: str, name: str, array: Floats) -> None:
    """Raise a ValueError if the numbers are neither deviations nor a covariance."""
    if array.ndim < 2:
        refuse_where(~(np.isfinite(array) & (array >= 0)), array, f"{place}: {name} must be finite and not negative")
    elif not (np.isfinite(array).all() and (array == array.T).all() and (array.diagonal() >= 0).all()):
        raise ValueError(f"{place}: covariance of {name} must be finite, symmetric, and no variance negative")


def sensitivity_of_modes(modes: Modes) -> Any:
    """`Modes.sensitivity`."""
    from .cord_sensitivity import of_cord

    kind = modes.system._kind
    if kind == "held chain":
        raise UnavailableError(
            "revchain.Modes.sensitivity: is for a Chain, a Rig or a Cord, got a chain held at both ends; change the datum and "
            "call modes again"
        )
    return of_modes(modes) if kind == "chain" else of_rig(modes) if kind == "rig" else of_cord(modes)


def uncertainty_of_modes(modes: Modes, given: dict[str, Any]) -> Any:
    """`Modes.uncertainty`."""
    from .cord_sensitivity import CORD_DATA, cord_uncertainty

    place, kind = "revchain.Modes.uncertainty", modes.system._kind
    if kind == "held chain":
        raise ValueError(
            f"{place}: is for a Chain, a Rig or a Cord, got a chain held at both ends; change the datum and call modes again"
        )
    known = {"chain": DATA, "rig": _ByRigDatum._known}.get(kind, (*CORD_DATA, "tip_weight"))
    for name, value in given.items():
        if name not in (*known, "weight"):
            raise ValueError(f"{place}: a {kind} has no {name}; leave it out, got {shown(value)}")
    every = dict.fromkeys((*known, "mass", "weight")) | given
    return {"chain": uncertainty, "rig": rig_uncertainty}.get(kind, cord_uncertainty)(modes, every)
