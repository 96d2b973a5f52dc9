# SPDX-License-Identifier: GPL-3.0-or-later
"""`explain`: the method that `modes` takes for an accuracy, and the cost of the other methods."""

from __future__ import annotations

from typing import Any, Literal

from .. import _core
from ..results.explanation import Explanation
from ..systems.chain import Chain, compiled
from ..systems.cord import Cord
from ..systems.held import Held
from ..systems.numbers import STANDARD_GRAVITY, real
from ..systems.numbers import count as checked_count
from ..systems.rig import Rig
from ..systems.system import System
from .modes import count_of, how_many, modes, straight
from .refuse import no_system


def explain(
    system: Chain | Rig | Cord | Held,
    count: int | Literal["all"] | None = None,
    *,
    first: int = 1,
    rtol: float | None = None,
) -> Explanation:
    """Return the method that `modes` tries first for these arguments, and the cost of the others.

    Parameters
    ----------
    system : Chain, Rig, Cord or Held
        The system, as in `modes`. Rigs, cords and held systems have one method each.
    count, first : int, optional
        Number of modes and number of the first one, as in `modes`.
    rtol : float, optional
        Relative tolerance of the conical heights; full accuracy if left out.

    Returns
    -------
    Explanation
        Each method with the bound of its relative error and its time, or the reason why it does not apply. Predicted times
        were mostly within a factor of 3 of measured times.

    Raises
    ------
    TypeError
        If `system` is not a `Chain`, a `Rig`, a `Cord` or a `Held`.
    ValueError
        If a number is out of its range, or a held system has no modes.

    Notes
    -----
    If the chosen method cannot prove its bound, as happens for links that differ by large factors, `modes` takes the next
    one. ``Modes.method`` names the method that was used. Cost: 20 microseconds. For a cord one mode is computed.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.explain(rc.Chain(weight=[1.0, 3.0, 2.0], length=1.0), rtol=1e-3).chosen.name
    'aberth'
    """
    caller = "revchain.explain"
    start = checked_count(caller, "first", first)
    tolerance = 0.0 if rtol is None else real(caller, "rtol", rtol)
    if not tolerance >= 0:
        raise ValueError(f"{caller}: rtol must not be negative or NaN, got {tolerance}")
    of: Any = system
    if getattr(system, "_kind", "") == "chain":
        core = compiled(caller, of, link_by_link=False)
        n = _how_many(caller, count, start, core.mode_count)
        rows, chosen, met = _core.select(core, start, n, tolerance, 0.0, None)
        estimates = tuple(
            (name, reason is None, reason or "", bound, cost, i == chosen and reason is None)
            for i, (name, reason, bound, cost) in enumerate(rows)
            if name != "finite amplitude"  # steady_shape answers at an inclination
        )
        return Explanation._made(None, estimates=estimates, meets_tolerance=met, rtol=tolerance)
    if not isinstance(system, System):
        raise no_system(caller, system)
    if system._kind == "rig":
        n = min(count_of(caller, count, 10) or 2 * system.size, 2 * system.size)
    else:
        if system._is_held:
            straight(caller, of, STANDARD_GRAVITY)
        n = _how_many(caller, count, start, system.mode_count)
    return _only(*_method(caller, system, start, n), tolerance)


def _how_many(caller: str, count: Any, first: int, most: int | None) -> int:
    """The number of modes asked for; `most` exist, or infinitely many if it is None."""
    if most is None:
        if isinstance(count, str) and count == "all":
            raise ValueError(f"{caller}: a cord has infinitely many modes; give count")
        return count_of(caller, count, 10) or 10
    n = how_many(caller, count, first, most)
    if first - 1 + n > most:
        raise ValueError(f"{caller}: there {'is 1 mode' if most == 1 else f'are {most} modes'}, got first = {first} and count = {n}")
    return n


def _method(caller: str, system: Any, first: int, count: int) -> tuple[str, float, float]:
    """The only method, its error bound as measured, and its time."""
    if system._kind == "rig":
        spinning = system.has_momentum
        if system.is_damped:
            return "rig, by exponents", 2.0**-50, 5e-5 + 5e-8 * system.size**3
        return "rig, by counts or discs", 2.0**-50 if spinning else 2.0**-51, 2.5e-5 + 1e-6 * system.size * count * (1 + spinning)
    if system._is_cord:
        one = modes(system, 1)
        return one.method, float(one.error_bound[0]), (1e-3 * (first + count) if one.method == "power series" else 1e-5 * count)
    return "bisection", 2.0**-52, 6e-6 * system.size * count


def _only(name: str, bound: float, cost: float, rtol: float) -> Explanation:
    row = (name, True, "", bound, cost, True)
    return Explanation._made(None, estimates=(row,), meets_tolerance=rtol == 0 or rtol >= bound, rtol=rtol)
