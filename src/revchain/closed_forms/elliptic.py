# SPDX-License-Identifier: GPL-3.0-or-later
"""Elliptic integrals and functions that take the modulus or its complement, whichever is known.

Next to ``modulus = 1`` everything depends on ``complementary_modulus = sqrt(1 - modulus**2)``, which
cannot be had from the modulus. The argument here is the modulus, not the parameter ``m = modulus**2``
of scipy. All functions broadcast, `jacobi` over ``u`` for one modulus; numbers in give numbers out.
"""

from __future__ import annotations

from math import nan
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import Floats, floats, numbers, real, refuse_where, together

__all__ = [
    "Complete",
    "Incomplete",
    "Jacobi",
    "complete",
    "complete_pi",
    "incomplete",
    "incomplete_pi",
    "jacobi",
]


class Jacobi(NamedTuple):
    """Jacobi's functions of one argument ``u``.

    Attributes
    ----------
    amplitude : float or ndarray
        am u.
    sn : float or ndarray
    cn : float or ndarray
    dn : float or ndarray
    epsilon : float or ndarray
        The integral of dn**2 from 0 to u, E(am u).
    """

    amplitude: Any
    sn: Any
    cn: Any
    dn: Any
    epsilon: Any


class Complete(NamedTuple):
    """The complete integrals, over a quarter turn, ``Delta = sqrt(1 - modulus**2 sin**2)``.

    Attributes
    ----------
    K : float or ndarray
        Of 1 / Delta.
    E : float or ndarray
        Of Delta.
    D : float or ndarray
        Of sin**2 / Delta.
    B : float or ndarray
        Of cos**2 / Delta.
    """

    K: Any
    E: Any
    D: Any
    B: Any


class Incomplete(NamedTuple):
    """Legendre's integrals up to an amplitude.

    Attributes
    ----------
    F : float or ndarray
        Of 1 / Delta.
    E : float or ndarray
        Of Delta.
    D : float or ndarray
        Of sin**2 / Delta.
    """

    F: Any
    E: Any
    D: Any


def _modulus(place: str, modulus: Any, complementary_modulus: Any) -> dict[str, Floats]:
    """Both as arrays, nan for the one not given."""
    if (modulus is None) == (complementary_modulus is None):
        raise ValueError(f"{place}: give exactly one of modulus and complementary_modulus")
    result = {}
    for name, value in (("modulus", modulus), ("complementary_modulus", complementary_modulus)):
        array = np.asarray(nan)
        if value is not None:
            array = floats(place, name, value)
            refuse_where(~((array >= 0) & (array <= 1)), array, f"{place}: {name} must lie between 0 and 1")
        result[name] = array
    return result


def _finite(place: str, name: str, value: ArrayLike) -> Floats:
    array = floats(place, name, value)
    refuse_where(~np.isfinite(array), array, f"{place}: {name} must be finite")
    return array


def _characteristic(place: str, value: ArrayLike) -> Floats:
    array = floats(place, "characteristic", value)
    refuse_where(~(array < 1), array, f"{place}: characteristic must be less than 1")
    return array


def jacobi(u: ArrayLike, *, modulus: float | None = None, complementary_modulus: float | None = None) -> Jacobi:
    """Return Jacobi's elliptic functions.

    Parameters
    ----------
    u : array_like
        Argument, any shape.
    modulus, complementary_modulus : float
        One of them, 0 to 1.

    Returns
    -------
    Jacobi
        Each of the shape of `u`, with an error of at most ``1e-15 * (|f| + |u df/du|)``, for
        complementary moduli from 1e-150 to 1. Where ``abs(u)`` exceeds 1e15 this leaves no digit of sn, cn and dn:
        they are those of some argument. Cost 0.1 microseconds a number.

    Raises
    ------
    ValueError
        If `u` is not finite, or not exactly one modulus is given, from 0 to 1.

    Notes
    -----
    Theta series of the smaller nome; DLMF 20.2, 22.2.

    Examples
    --------
    >>> import revchain as rc
    >>> f = rc.elliptic.jacobi(1.0, modulus=0.6)
    >>> round(float(f.sn), 12), round(float(f.cn**2 + f.sn**2), 12)
    (0.81409141238, 1.0)
    """
    place = "revchain.elliptic.jacobi"
    given = _modulus(place, modulus, complementary_modulus)
    moduli = [real(place, name, value) for name, value in given.items()]
    return Jacobi(*numbers(_core.elliptic_jacobi(_finite(place, "u", u), *moduli)))


def complete(*, modulus: ArrayLike | None = None, complementary_modulus: ArrayLike | None = None) -> Complete:
    """Return the complete elliptic integrals.

    Parameters
    ----------
    modulus, complementary_modulus : array_like
        One of them, 0 to 1.

    Returns
    -------
    Complete
        Each of the shape given, within 1.5e-15 relative; `K` and `D` infinite for modulus 1. Cost 0.2
        microseconds a number.

    Raises
    ------
    ValueError
        If not exactly one is given, from 0 to 1.

    Notes
    -----
    Bulirsch's cel, doi:10.1007/BF02165405. ``D = (K - E) / modulus**2`` and ``B = K - D`` without the
    difference.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.complete(complementary_modulus=1e-100).K), 10)
    231.6448036605
    """
    place = "revchain.elliptic.complete"
    arrays = together(place, **_modulus(place, modulus, complementary_modulus))
    return Complete(*numbers(_core.elliptic_complete(*arrays)))


def incomplete(
    amplitude: ArrayLike, *, modulus: ArrayLike | None = None, complementary_modulus: ArrayLike | None = None
) -> Incomplete:
    """Return Legendre's elliptic integrals up to an amplitude.

    Parameters
    ----------
    amplitude : array_like
        In rad.
    modulus, complementary_modulus : array_like
        One of them, 0 to 1.

    Returns
    -------
    Incomplete
        Each of the broadcast shape, within 2e-15 relative. Cost 0.5 microseconds a number.

    Raises
    ------
    ValueError
        If `amplitude` is not finite, or not exactly one modulus is given, from 0 to 1.

    Notes
    -----
    Carlson's forms, doi:10.1007/BF02198293; DLMF 19.25.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.incomplete(1.0, modulus=0.6).F), 12)
    1.056273109822
    """
    place = "revchain.elliptic.incomplete"
    given = _modulus(place, modulus, complementary_modulus)
    arrays = together(place, amplitude=_finite(place, "amplitude", amplitude), **given)
    return Incomplete(*numbers(_core.elliptic_incomplete(*arrays)))


def complete_pi(
    characteristic: ArrayLike, *, modulus: ArrayLike | None = None, complementary_modulus: ArrayLike | None = None
) -> Any:
    """Return the complete integral of the third kind, of ``1 / ((1 - characteristic sin**2) Delta)``.

    Parameters
    ----------
    characteristic : array_like
        Less than 1, of either sign; its sign as in DLMF 19.2.7.
    modulus, complementary_modulus : array_like
        One of them, 0 to 1.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 1.5e-15 relative; infinite for modulus 1. Cost 0.1 microseconds a number.

    Raises
    ------
    ValueError
        If `characteristic` is not less than 1, or not exactly one modulus is given, from 0 to 1.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.complete_pi(-2.0, modulus=0.0)), 12)
    0.906899682117
    """
    place = "revchain.elliptic.complete_pi"
    given = _modulus(place, modulus, complementary_modulus)
    arrays = together(place, characteristic=_characteristic(place, characteristic), **given)
    return _core.elliptic_complete_pi(*arrays)


def incomplete_pi(
    characteristic: ArrayLike,
    amplitude: ArrayLike,
    *,
    modulus: ArrayLike | None = None,
    complementary_modulus: ArrayLike | None = None,
) -> Any:
    """Return the integral of the third kind up to an amplitude.

    Parameters
    ----------
    characteristic : array_like
        As in `complete_pi`.
    amplitude : array_like
        In rad.
    modulus, complementary_modulus : array_like
        One of them, 0 to 1.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 3e-15 relative. Cost 0.7 microseconds a number.

    Raises
    ------
    ValueError
        If `characteristic` is not less than 1, `amplitude` not finite, or not exactly one modulus is
        given, from 0 to 1.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.incomplete_pi(0.5, 1.0, modulus=0.6)), 12)
    1.253085614008
    """
    place = "revchain.elliptic.incomplete_pi"
    given = _modulus(place, modulus, complementary_modulus)
    arrays = together(
        place,
        characteristic=_characteristic(place, characteristic),
        amplitude=_finite(place, "amplitude", amplitude),
        **given,
    )
    return _core.elliptic_incomplete_pi(*arrays)
