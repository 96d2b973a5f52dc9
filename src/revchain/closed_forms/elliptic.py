# SPDX-License-Identifier: GPL-3.0-or-later
"""Jacobi's elliptic functions, accurate also near modulus 1.

Near ``modulus = 1`` give ``complementary_modulus = sqrt(1 - modulus**2)``: a rounded modulus does not determine it well.
`scipy.special.ellipj` takes the parameter ``m = modulus**2``. SciPy has the elliptic integrals: with ``c`` the
complementary modulus, ``ellipkm1(c**2)`` is the complete integral K and ``ellipe((1 - c) * (1 + c))`` is E.
"""

from __future__ import annotations

from math import nan
from typing import NamedTuple

from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import floats, numbers, real, refuse_where
from .table import FloatOrArray, described

__all__ = ["Jacobi", "jacobi"]


class Jacobi(NamedTuple):
    """Jacobi's functions of ``u``: `amplitude` am u, `sn`, `cn`, `dn`, and `epsilon`, the integral of dn**2 from 0 to u.

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.elliptic.jacobi(1.0, modulus=0.6).amplitude), 12)
    0.951162931829
    """

    amplitude: FloatOrArray
    sn: FloatOrArray
    cn: FloatOrArray
    dn: FloatOrArray
    epsilon: FloatOrArray


@described(
    "``1e-15 * (|f| + |u df/du|)`` for complementary moduli from 1e-150 to 1; if ``abs(u)`` exceeds 1e15, sn, cn and dn "
    "can be wrong in every digit",
    cost="0.07 microseconds for each number",
)
def jacobi(u: ArrayLike, *, modulus: float | None = None, complementary_modulus: float | None = None) -> Jacobi:
    """Return Jacobi's elliptic functions for one modulus, or one complementary modulus.

    returns: Arrays with the shape of `u`.
    raises: If a number is out of its range, or both or none of the moduli are given.
    notes: Method: theta series, DLMF 20.2, 22.2.

    >>> f = rc.elliptic.jacobi(1.0, modulus=0.6)
    >>> round(float(f.sn), 12), round(float(f.cn**2 + f.sn**2), 12)
    (0.81409141238, 1.0)
    """
    caller = "revchain.elliptic.jacobi"
    moduli = {"modulus": modulus, "complementary_modulus": complementary_modulus}
    if (modulus is None) == (complementary_modulus is None):
        raise ValueError(f"{caller}: give exactly one of modulus and complementary_modulus")
    checked = {name: nan if value is None else real(caller, name, value) for name, value in moduli.items()}
    for name, value in checked.items():
        if moduli[name] is not None and not 0 <= value <= 1:
            raise ValueError(f"{caller}: {name} must lie between 0 and 1, got {value:g}")
    argument = floats(caller, "u", u)
    refuse_where(~(abs(argument) < float("inf")), argument, f"{caller}: u must be finite")
    return Jacobi(*numbers(_core.elliptic_jacobi(argument, *checked.values())))
