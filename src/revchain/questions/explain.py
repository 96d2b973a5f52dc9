# SPDX-License-Identifier: GPL-3.0-or-later
"""Ask for an accuracy, get the cheapest model that has it; and why."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .. import _core
from ..results.explanation import Explanation, Solution
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, integer, one_positive, positive, real, shown, word
from ..systems.numbers import count as checked_count
from ..systems.rig import Rig, base_chain
from .modes import modes

if TYPE_CHECKING:
    from ..scenes.scene import Scene

RIG_MODEL = "rig, by counts or discs"


def solve(
    what: Scene | Chain | Rig,
    count: int | None = None,
    *,
    first: int | None = None,
    rtol: float | None = None,
    inclination: float = 0.0,
    time_budget: float | None = None,
    model: str | None = None,
    gravity: float | None = None,
) -> Solution:
    """Find conical heights to a tolerance, by the cheapest model that keeps it.

    Parameters
    ----------
    what : Scene, Chain or Rig
        The chain of N links. A scene says with ``[ask]`` what is left out here.
    count : int, optional
        How many modes; of a chain 1 if left out.
    first : int, optional
        Number of the slowest mode wanted, 1 if left out.
    rtol : float, optional
        Relative tolerance of the heights; as accurate as there is in double (2 ulp) if left out.
    inclination : float, optional
        Of the lowest link, rad, below a right angle: of the shape that grows out of the mode. 0: small.
    time_budget : float, optional
        In seconds, positive and finite: the most accurate model that is expected to need no more, where none keeps the
        tolerance. Where none needs as little the cheapest answers, and ``status`` says so.
    model : str, optional
        Ask this one and no other, by its name as `explain` lists it.
    gravity : float, optional
        For speeds; the scene's, or standard gravity in metres.

    Returns
    -------
    Solution
        ``status`` is ``"tolerance_not_met"`` where no model keeps the tolerance (within the budget); no heights where
        the model named does not apply.

    Raises
    ------
    TypeError
        If `what` is none of these.
    ValueError
        For modes that are not there, a tolerance that is negative or NaN, a budget that is not positive, an
        inclination that is negative or a right angle, a name that no model has, a scene that holds both ends.

    Notes
    -----
    Choosing takes 0.1 microseconds, with this call some 10. A model that finds that its bound is larger than foreseen
    is left out and the next one asked: the bound returned always holds.

    Examples
    --------
    >>> import revchain as rc
    >>> rods = rc.Chain.uniform_rods(100_000, length=0.36)
    >>> rc.solve(rods, 3, rtol=0.01).model
    'continuous chain'
    >>> rc.solve(rods, 3).model
    'condensed'
    >>> [rc.solve(rc.Chain.uniform_rods(9), rtol=r, inclination=0.2).model for r in (0.1, 1e-3)]
    ['continuous chain', 'finite amplitude']
    """
    place = "revchain.solve"
    hung, k, n, tolerance, lean, budget, g = _asked(place, what, count, first, rtol, inclination, time_budget, gravity)
    if isinstance(hung, Rig):
        if model is not None and model != RIG_MODEL:
            raise ValueError(f"{place}: model must be {RIG_MODEL!r} for a Rig, got {shown(model)}")
        found = modes(hung, n, first=k, gravity=g)
        if len(found.conical_height) < n and (count is not None or first is not None):
            there = k - 1 + len(found.conical_height)
            raise ValueError(f"{place}: there are no {n} modes from number {k} on, got {there or 'none'} in all")
        met = tolerance == 0 or bool(np.all(found.error_bound <= tolerance))
        status = found.status if found.status != "success" or met else "tolerance_not_met"
        return _solution((found.conical_height, found.error_bound, None, RIG_MODEL, status), tolerance, k, g)
    core = compiled(place, hung, link_by_link=tolerance == 0)
    if model is None:
        answer = _core.solve(core, k, n, tolerance, lean, budget)
    else:
        answer = _core.solve_by(core, k, n, tolerance, lean, word(place, "model", model, _core.MODELS))
    return _solution(answer, tolerance, k, g)


def _solution(answer: tuple[Any, ...], rtol: float, first: int, gravity: float) -> Solution:
    names = ("conical_height", "error_bound", "conical_height_low", "model", "status")
    return Solution._made(None, **dict(zip(names, answer, strict=True)), rtol=rtol, first=first, gravity=gravity)


def explain(
    what: Scene | Chain | Rig,
    count: int | None = None,
    *,
    first: int | None = None,
    rtol: float | None = None,
    inclination: float = 0.0,
    time_budget: float | None = None,
) -> Explanation:
    """Say which model `solve` would take for the same question, and what the others would cost.

    Parameters
    ----------
    what : Scene, Chain or Rig
        As for `solve`, like the rest.
    count, first : int, optional
    rtol, inclination, time_budget : float, optional

    Returns
    -------
    Explanation
        Nothing is solved for it.

    Raises
    ------
    TypeError, ValueError
        As `solve`.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.explain(rc.Chain(weight=[1.0, 3.0, 2.0], length=1.0), rtol=1e-3).chosen.name
    'aberth'
    """
    place = "revchain.explain"
    hung, k, n, tolerance, lean, budget, _ = _asked(place, what, count, first, rtol, inclination, time_budget, None)
    if isinstance(hung, Rig):
        spinning = bool(np.any(hung.momentum))
        bound = 2.0**-50 if spinning else 2.0**-51  # foreseen: measured 3.5 ulp and 2
        row = (RIG_MODEL, True, "", bound, 2.5e-5 + 1e-6 * hung.size * n * (1 + spinning), True)
        return Explanation._made(None, estimates=(row,), meets_tolerance=tolerance == 0 or tolerance >= bound, rtol=tolerance)
    rows, chosen, met = _core.select(compiled(place, hung, link_by_link=False), k, n, tolerance, lean, budget)
    estimates = tuple(
        (name, reason is None, reason or "", bound, cost, i == chosen and reason is None)
        for i, (name, reason, bound, cost) in enumerate(rows)
    )
    return Explanation._made(None, estimates=estimates, meets_tolerance=met, rtol=tolerance)


class _Asked(NamedTuple):
    """What `solve` and `explain` were given, checked."""

    hung: Chain | Rig
    first: int
    how_many: int
    rtol: float
    inclination: float
    time_budget: float | None
    gravity: float


def _asked(
    place: str,
    what: Any,
    count: int | None,
    first: int | None,
    rtol: float | None,
    inclination: float,
    time_budget: float | None,
    gravity: float | None,
) -> _Asked:
    scene: Any = None
    if isinstance(what, Chain | Rig):
        hung = what
    elif hasattr(what, "gravity_value") and hasattr(what, "ask"):
        scene = what
        hung = scene._hung("scene")
    else:
        raise TypeError(f"{place}: what must be a revchain.Scene, Chain or Rig, got {shown(what)}")
    n = 1 if count is None else checked_count(place, "count", count)
    k = 1 if first is None else checked_count(place, "first", integer(place, "first", first))
    tolerance = 0.0 if rtol is None else real(place, "rtol", rtol)
    g = STANDARD_GRAVITY
    if scene is not None:
        said = scene.asked(base_chain(hung))
        for name in ("conical_height", "angular_speed", "certify", "precision", "method"):
            if name in said:
                raise ValueError(
                    f"{place}: ask.{name} of the scene is for revchain.modes: take count and first, got {said[name]}"
                )
        if count is None and first is None:
            k = said.get("first", 1)
            left = max(1, _available(hung) - k + 1)
            n = left if said["count"] == "all" else min(said["count"], left)
        if rtol is None:
            tolerance = float(said.get("rtol", 0.0))
        g = scene.gravity_value()
    if isinstance(hung, Chain) and k - 1 + n > hung.mode_count:
        raise ValueError(f"{place}: there are {hung.mode_count} modes, got first = {k} and count = {n}")
    if gravity is not None:
        g = float(positive(place, "gravity", real(place, "gravity", gravity)))
    if not tolerance >= 0:
        raise ValueError(f"{place}: rtol must not be negative or NaN, got {tolerance}")
    budget = None if time_budget is None else one_positive(place, "time_budget", time_budget)
    lean = real(place, "inclination", inclination)
    if isinstance(hung, Rig) and lean != 0:
        raise ValueError(f"{place}: inclination is for a chain alone, got a Rig")
    return _Asked(hung, k, n, tolerance, lean, budget, g)


def _available(hung: Chain | Rig) -> int:
    return hung.mode_count if isinstance(hung, Chain) else hung.size + 1
