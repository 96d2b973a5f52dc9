# SPDX-License-Identifier: GPL-3.0-or-later
"""Jacobi's elliptic functions near modulus 1, where ``scipy.special.ellipj`` loses all digits.

Near ``modulus = 1`` give ``complementary_modulus = sqrt(1 - modulus**2)``: it cannot be computed accurately from a
rounded modulus. `scipy.special.ellipj` takes the parameter ``m = modulus**2``. Within a period, its errors are below
1e-14 for complementary moduli above 0.1; at 1e-3 they reach 1e-11; below 1e-6 no digit of cn and dn is correct beyond
half the period.

SciPy has the elliptic integrals. With ``c`` the complementary modulus, write ``ellipkm1(c**2)`` for the complete
integral K, ``ellipe((1 - c) * (1 + c))`` for E, and the forms of Carlson (`elliprf`, `elliprd`, `elliprj`; DLMF 19.25)
for incomplete integrals and those of the third kind, whose characteristic far below 0 must first be changed (DLMF
19.7(iii)).
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
    """Jacobi's functions of ``u``: `amplitude` am u, `sn`, `cn`, `dn`, and `epsilon`, the integral of dn**2 to u.

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
    """Return Jacobi's elliptic functions for one modulus; give exactly one of the modulus and its complement.

    returns: Arrays with the shape of `u`.
    raises: If a number is out of its range, or not exactly one of the moduli is given.
    notes: Method: theta series of the smaller nome, DLMF 20.2, 22.2.

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
