# SPDX-License-Identifier: GPL-3.0-or-later
"""Elliptic integrals and functions of the modulus or of the complementary modulus.

Every function takes exactly one of ``modulus`` and ``complementary_modulus = sqrt(1 - modulus**2)``, from 0 to 1. Near
``modulus = 1`` give the complementary modulus: it cannot be computed accurately from a rounded modulus. Note that scipy
takes the parameter ``m = modulus**2`` instead. Below, ``Delta = sqrt(1 - modulus**2 sin**2)``. All functions broadcast,
`jacobi` over ``u`` for one modulus; single numbers give single numbers. A number out of its range raises a ValueError.
"""

from __future__ import annotations

from math import nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import Floats, beside, floats, numbers, real, refuse_where

__all__ = ["Complete", "Incomplete", "Jacobi", "complete", "complete_pi", "incomplete", "incomplete_pi", "jacobi"]

MODULI = ("modulus", "complementary_modulus")


class Jacobi(NamedTuple):
    """Jacobi's functions of ``u``: `amplitude` am u, `sn`, `cn`, `dn`, and `epsilon`, the integral of dn**2 from 0 to u.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.jacobi(1.0, modulus=0.6).amplitude), 12)
    0.951162931829
    """

    amplitude: Any
    sn: Any
    cn: Any
    dn: Any
    epsilon: Any


class Complete(NamedTuple):
    """The integrals over a quarter turn of 1 / Delta (K), Delta (E), sin**2 / Delta (D) and cos**2 / Delta (B).

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.complete(modulus=0.6).E), 12)
    1.418083394449
    """

    K: Any
    E: Any
    D: Any
    B: Any


class Incomplete(NamedTuple):
    """Legendre's integrals from 0 to an amplitude of 1 / Delta (F), Delta (E) and sin**2 / Delta (D).

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.incomplete(1.0, modulus=0.6).E), 12)
    0.948689940604
    """

    F: Any
    E: Any
    D: Any


def _checked(function: str, given: dict[str, Any]) -> list[Floats]:
    """All arguments of a function of this module, broadcast to one shape; NaN for the modulus not given."""
    place = f"revchain.elliptic.{function}"
    absent = [name for name in MODULI if given[name] is None]
    if len(absent) != 1:
        raise ValueError(f"{place}: give exactly one of modulus and complementary_modulus")
    result = {name: floats(place, name, nan if name in absent else value) for name, value in given.items()}
    for name, array in result.items():
        if name in MODULI:
            wrong = ~((array >= 0) & (array <= 1)) & (name not in absent)
            refuse_where(wrong, array, f"{place}: {name} must lie between 0 and 1")
        elif name == "characteristic":
            refuse_where(~(array < 1), array, f"{place}: characteristic must be less than 1")
        else:
            refuse_where(~np.isfinite(array), array, f"{place}: {name} must be finite")
    return beside(place, **result)


def jacobi(u: ArrayLike, *, modulus: float | None = None, complementary_modulus: float | None = None) -> Jacobi:
    """Return Jacobi's elliptic functions.

    Parameters
    ----------
    u : array_like
        Argument, finite, any shape.
    modulus, complementary_modulus : float
        Exactly one of the two.

    Returns
    -------
    Jacobi
        Arrays with the shape of `u`. For complementary moduli from 1e-150 to 1 the error is at most
        ``1e-15 * (|f| + |u df/du|)``. If ``abs(u)`` exceeds 1e15, no digit of sn, cn and dn is correct. Method: theta
        series of the smaller nome, DLMF 20.2, 22.2. Cost: 0.1 microseconds for each number.

    Examples
    --------
    >>> import revchain as rc
    >>> f = rc.elliptic.jacobi(1.0, modulus=0.6)
    >>> round(float(f.sn), 12), round(float(f.cn**2 + f.sn**2), 12)
    (0.81409141238, 1.0)
    """
    for name, value in (("modulus", modulus), ("complementary_modulus", complementary_modulus)):
        real("revchain.elliptic.jacobi", name, 0 if value is None else value)
    argument, *both = _checked("jacobi", {"u": u, "modulus": modulus, "complementary_modulus": complementary_modulus})
    return Jacobi(*numbers(_core.elliptic_jacobi(argument, *map(float, both))))


def complete(*, modulus: ArrayLike | None = None, complementary_modulus: ArrayLike | None = None) -> Complete:
    """Return the complete elliptic integrals.

    Parameters
    ----------
    modulus, complementary_modulus : array_like
        Exactly one of the two.

    Returns
    -------
    Complete
        Arrays with the shape given, within 1.5e-15 relative; `K` and `D` are infinite for modulus 1.
        ``D = (K - E) / modulus**2`` and ``B = K - D`` are computed without these differences. Method: Bulirsch's cel,
        doi:10.1007/BF02165405. Cost: 0.2 microseconds for each number.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.complete(complementary_modulus=1e-100).K), 10)
    231.6448036605
    """
    return Complete(*numbers(_core.elliptic_complete(*_checked("complete", locals()))))


def incomplete(
    amplitude: ArrayLike, *, modulus: ArrayLike | None = None, complementary_modulus: ArrayLike | None = None
) -> Incomplete:
    """Return Legendre's elliptic integrals up to an amplitude.

    Parameters
    ----------
    amplitude : array_like
        Upper limit of the integrals, rad, finite.
    modulus, complementary_modulus : array_like
        Exactly one of the two.

    Returns
    -------
    Incomplete
        Arrays with the broadcast shape, within 2e-15 relative. Method: Carlson's forms, doi:10.1007/BF02198293;
        DLMF 19.25. Cost: 0.5 microseconds for each number.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.incomplete(1.0, modulus=0.6).F), 12)
    1.056273109822
    """
    return Incomplete(*numbers(_core.elliptic_incomplete(*_checked("incomplete", locals()))))


def complete_pi(
    characteristic: ArrayLike, *, modulus: ArrayLike | None = None, complementary_modulus: ArrayLike | None = None
) -> Any:
    """Return the complete elliptic integral of the third kind, of ``1 / ((1 - characteristic sin**2) Delta)``.

    Parameters
    ----------
    characteristic : array_like
        Less than 1, positive or negative, with the sign convention of DLMF 19.2.7.
    modulus, complementary_modulus : array_like
        Exactly one of the two.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 1.5e-15 relative; infinite for modulus 1. Cost: 0.1 microseconds for each number.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.complete_pi(-2.0, modulus=0.0)), 12)
    0.906899682117
    """
    return _core.elliptic_complete_pi(*_checked("complete_pi", locals()))


def incomplete_pi(
    characteristic: ArrayLike, amplitude: ArrayLike, *, modulus: ArrayLike | None = None,
    complementary_modulus: ArrayLike | None = None,
) -> Any:
    """Return the elliptic integral of the third kind from 0 to an amplitude.

    Parameters
    ----------
    characteristic, amplitude : array_like
        Characteristic as in `complete_pi`; amplitude in rad, finite.
    modulus, complementary_modulus : array_like
        Exactly one of the two.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 3e-15 relative. Cost: 0.7 microseconds for each number.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.incomplete_pi(0.5, 1.0, modulus=0.6)), 12)
    1.253085614008
    """
    return _core.elliptic_incomplete_pi(*_checked("incomplete_pi", locals()))
