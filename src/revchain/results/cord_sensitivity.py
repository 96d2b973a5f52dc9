# SPDX-License-Identifier: GPL-3.0-or-later
"""Sensitivity and uncertainty of the conical heights and speeds of a cord."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from .. import _core
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import Floats, shown
from .base import Field
from .sensitivity import Uncertainty, _ByDatum, _deviations, _refuse_no_deviations, shared_out
from .sheet import Sheet

if TYPE_CHECKING:
    from .modes import Modes

CORD_DATA = ("length", "mass", "tip_mass", "exponent", "tension")


class CordDerivatives(_ByDatum):
    """Numbers for each mode and datum of a cord.

    Examples
    --------
    >>> import revchain as rc
    >>> relative = rc.modes(rc.Cord(2.0, mass=0.5, tip_mass=0.1), 1).sensitivity.relative
    >>> relative.length.round(12), (relative.mass + relative.tip_mass).round(12) + 0.0
    (array([1.]), array([0.]))
    """

    __slots__ = ()
    _known = CORD_DATA
    length: Field[Floats] = Field("Numbers for the length, shape (k,); see `CordSensitivity.length`.")
    mass: Field[Floats] = Field("Numbers for the mass, shape (k,); see `CordSensitivity.mass`.")
    tip_mass: Field[Floats] = Field("Numbers for the tip, shape (k,); see `CordSensitivity.tip_mass`.")
    exponent: Field[Floats] = Field("Numbers for the exponent, shape (k,); see `CordSensitivity.exponent`.")
    tension: Field[Floats] = Field("Numbers for the tension, shape (k,); see `CordSensitivity.tension`.")

    def _sheet(self, brief: bool = False) -> Sheet:
        return Sheet("mode", "Values by datum", self._columns())


class CordSensitivity(_ByDatum):
    """Derivatives of the conical heights of k modes with respect to the data of a cord, hanging or held at both ends.

    All other data are constant. The derivatives of the speeds are these times ``-angular_speed / (2 * conical_height)``.

    Notes
    -----
    Method: from the shape alone. A change dV of the weight below a place (tip included) changes the height by
    ``-integral(dV y' (2 y + height y')) / integral(V y'**2)``. Accuracy: 1e-12 of the height divided by the datum. Heights
    are proportional to the length and depend on ratios of weights and tension: the relative derivatives of a mode by masses
    and tension add up to 0, also without gravity. Cost: about 800 places for each mode at 1 to 15 microseconds each; for a
    cord held at both ends 100 places.

    Examples
    --------
    The change of speed of a skipping rope for 1 g more, in rad/s:

    >>> import revchain as rc
    >>> m = rc.modes(rc.Held(rc.Cord(2.0, mass=0.2), tension=10.0), 1)
    >>> (-m.angular_speed / (2 * m.conical_height) * m.sensitivity.mass * 0.001).round(6)
    array([-0.041553])
    """

    __slots__ = ()
    _known = CORD_DATA
    length: Field[Floats] = Field(
        "d(conical height)/d(length), shape (k,); the density keeps its proportions along the cord."
    )
    mass: Field[Floats] = Field(
        "Derivative with respect to the mass of the cord without its tip, m/kg, shape (k,); for a cord given by weight, with "
        "respect to its weight.",
    )
    tip_mass: Field[Floats] = Field(
        "Derivative with respect to the mass of the tip; 0 for a cord held at both ends."
    )
    exponent: Field[Floats] = Field(
        "Derivative with respect to the exponent of the density at constant mass; NaN for a density function, 0 for a cord "
        "held at both ends.",
    )
    tension: Field[Floats] = Field(
        "Derivative with respect to the tension at the upper end; 0 for a hanging cord."
    )
    relative: Field[CordDerivatives] = Field(
        "Logarithmic derivatives ``(x / height) d(height)/dx``. Those of the speeds are -1/2 times these."
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        return Sheet("mode", "Derivatives of the conical heights", self._columns())


class CordUncertainty(Uncertainty):
    """Standard deviations of the conical heights and speeds of k modes of a cord, to first order.

    Examples
    --------
    >>> import revchain as rc
    >>> u = rc.modes(rc.Held(rc.Cord(2.0, mass=0.2), tension=10.0), 1).uncertainty(mass="1 %", tension=0.5)
    >>> u.largest, u.relative.round(4)
    ((('tension', 0),), array([0.0569]))
    """

    __slots__ = ()
    share: Field[CordDerivatives] = Field(  # type: ignore[assignment]
        "Part of each variance that comes from each datum; the parts of a mode add up to 1."
    )
    largest: Field[tuple[tuple[str, int], ...]] = Field(
        "For each mode the datum that contributes most, and 0 in place of a link."
    )

    def _most(self, row: int) -> str:
        return self.largest[row][0] if self.relative[row] else "nothing"


def _values(system: Cord | Held) -> dict[str, float]:
    """The data of the cord by name."""
    cord = system.system if isinstance(system, Held) else system
    assert isinstance(cord, Cord)
    exponent = cord.density if isinstance(cord.density, float) else np.nan
    tension = system.tension if isinstance(system, Held) else None
    tip = cord._compiled.tip_weight
    return dict(zip(CORD_DATA, (cord.length, cord._compiled.weight, tip, exponent, tension or 0.0), strict=True))


def of_cord(modes: Modes) -> CordSensitivity:
    """`Modes.sensitivity`."""
    found: Any = _core.cord_sensitivity(modes._found()) if len(modes) else [np.empty(0)] * len(CORD_DATA)
    rates = dict(zip(CORD_DATA, found, strict=True))
    if isinstance(modes.system, Held):
        rates["tension"] = rates["tension"] / modes.system._force(modes.gravity)
    values = _values(modes.system)
    relative = {name: rate * (values[name] / modes.conical_height) for name, rate in rates.items()}
    return CordSensitivity._made(
        None, number=modes.number, **rates, relative=CordDerivatives._made(None, number=modes.number, **relative)
    )


def cord_uncertainty(modes: Modes, given: dict[str, Any]) -> CordUncertainty:
    """`Modes.uncertainty`; `given` by the names of the arguments."""
    place = "revchain.Modes.uncertainty"
    system, values = modes.system, _values(modes.system)
    heavy, other = ("mass", "weight") if system.by_mass else ("weight", "mass")
    for name in (other, f"tip_{other}"):
        if given[name] is not None:
            wanted = name.replace(other, heavy)
            raise ValueError(f"{place}: the cord was given by {heavy}: give {wanted}, not {name}, got {shown(given[name])}")
    held = isinstance(system, Held)
    for name in (f"tip_{heavy}", "exponent") if held else ("tension",):
        if given[name] is not None:
            why = "is for a hanging cord" if held else "is for a cord held at both ends"
            raise ValueError(f"{place}: {name} {why}; leave it out, got {shown(given[name])}")
    if given["exponent"] is not None and np.isnan(values["exponent"]):
        raise ValueError(f"{place}: the density was given as a function and has no exponent, got {shown(given['exponent'])}")
    sensitivity, parts = modes.sensitivity, {}
    for name in CORD_DATA:
        called = name.replace("mass", heavy)
        spread = np.zeros(())
        if given[called] is not None:
            spread = _deviations(place, called, given[called], np.array([values[name]]))
            _refuse_no_deviations(place, called, spread)
        parts[name] = (np.nan_to_num(sensitivity[name]) * spread.reshape(-1)[:1]) ** 2
    table, variance, share = shared_out(parts)
    height = np.sqrt(variance)
    relative = height / modes.conical_height
    return CordUncertainty._made(
        None,
        number=modes.number,
        names=None,
        conical_height=height,
        relative=relative,
        angular_speed=0.5 * relative * modes.angular_speed,
        period=0.5 * relative * modes.period,
        share=CordDerivatives._made(None, number=modes.number, **share),
        largest=tuple((CORD_DATA[k], 0) for k in table.argmax(axis=1)),
    )
