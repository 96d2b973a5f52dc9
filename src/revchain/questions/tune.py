# SPDX-License-Identifier: GPL-3.0-or-later
"""Inverse questions: which value of a datum gives a mode the speed wanted."""

from __future__ import annotations

from typing import Any

from .. import _core
from ..results.tuned import Tuned
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, count, real, shown, word
from ..systems.rig import Rig


def tune(
    chain: Chain,
    *,
    mode: int = 1,
    link: int,
    quantity: str,
    conical_height: float | None = None,
    angular_speed: float | None = None,
    gravity: float = STANDARD_GRAVITY,
    between: tuple[float, float] | None = None,
) -> Tuned:
    """Find the value of one datum of a link that gives a mode the speed wanted.

    Parameters
    ----------
    chain : Chain
        The chain as it is.
    mode : int
        Number of the mode, from 1 for the slowest.
    link : int
        Number of the link, from 1 for the lowest.
    quantity : {"weight", "length", "centroid", "radius_of_gyration", "length_in_proportion"}
        What of it may change, all else held. With ``"length"`` centre of gravity and radius of gyration stay
        where they are; with ``"length_in_proportion"`` they grow with it, as of a plummet's thread.
    conical_height : float, optional
        The height wanted.
    angular_speed : float, optional
        Instead: the whirl speed wanted, rad/s.
    gravity : float, optional
        For `angular_speed`; standard gravity, in metres, if left out.
    between : (low, high), optional
        Where to look. Left out: from a thousandth to a thousand times the present weight (the whole
        chain's for a massless link) or length; for centroid and radius of gyration from 0 to the
        link's length or the present value.

    Returns
    -------
    Tuned
        With the new chain, and the bound of the value's error. Cost O(N) for each of some 10 to 60
        counts; of a weight some 10 to 100 modes.

    Raises
    ------
    ValueError
        Unless exactly one of height and speed is given; for numbers out of range, and a range in which the
        link would stand rather than hang.

    Notes
    -----
    At a given height the chain is a spring at each pin of the link. The values of a centroid or a length are
    then roots of a quadratic, those of a radius of gyration or a length in proportion of a linear
    equation, and proved counts say which are this mode's and how accurate they are. Heights rise with a
    length in proportion and a radius of gyration; with others they may turn. A weight bears on every
    link above; there the search moves in steps that can pass no value, since a height never changes faster
    than the weight, in ratio.

    Examples
    --------
    How heavy must the lower of two plummets be for their second whirl speed to be 4 rad/s?

    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[1.0, 3.0], length=1.0)
    >>> tuned = rc.tune(chain, mode=2, link=1, quantity="weight", angular_speed=4.0, gravity=9.81)
    >>> round(tuned.value, 12)
    0.528051454425
    >>> rc.modes(tuned.system, gravity=9.81).angular_speed.round(12)[1]
    np.float64(4.0)
    """
    place = "revchain.tune"
    core = compiled(place, chain)
    word(place, "quantity", quantity, _core.DATA)
    if (conical_height is None) == (angular_speed is None):
        raise ValueError(f"{place}: give either conical_height or angular_speed (not both)")
    low, high = (None, None) if between is None else _ends(place, between)
    status, present, value, bound, values, complete, low, high, lowest, highest, found = _core.tune(
        core,
        count(place, "mode", mode),
        count(place, "link", link),
        quantity,
        None if conical_height is None else real(place, "conical_height", conical_height),
        None if angular_speed is None else real(place, "angular_speed", angular_speed),
        real(place, "gravity", gravity),
        low,
        high,
    )
    return Tuned._made(
        None,
        status=status,
        system=None if found is None else Chain._wrap(found),
        value=None if found is None else value,
        error_bound=None if found is None else bound,
        values=values,
        complete=complete,
        present=present,
        between=(low, high),
        reachable=(lowest, highest) if status != "found" else None,
        datum=f"{quantity} of links[{link - 1}]",
    )


def _ends(place: str, between: Any) -> tuple[float, float]:
    try:
        low, high = between
    except (TypeError, ValueError):
        raise ValueError(f"{place}: between must be a pair (low, high), got {shown(between)}") from None
    return real(place, "between (each end)", low), real(place, "between (each end)", high)


def momentum_for_speed(rig: Rig, angular_speed: float, *, link: int, gravity: float = STANDARD_GRAVITY) -> float:
    """Return the momentum of one flywheel that makes a speed a whirl speed.

    Parameters
    ----------
    rig : Rig
        The rig of N links.
    angular_speed : float
        The speed wanted, rad/s, of either sign.
    link : int
        Number of the link with the flywheel, from 1 for the lowest.
    gravity : float, optional
        In the unit of length per s^2; standard gravity, in metres, if left out.

    Returns
    -------
    float
        The only one there is, of whichever mode.

    Raises
    ------
    ValueError
        If the speed is 0 or not finite, gravity not positive, or there is no such link; where no finite momentum of
        the link makes the speed a whirl speed.
    TypeError
        If `rig` is not a `Rig`.

    Examples
    --------
    A plummet alone whirls at sqrt(10) rad/s; at 5 rad/s with

    >>> import revchain as rc
    >>> rig = rc.Rig(rc.Chain(weight=10.0, length=1.0))
    >>> rc.momentum_for_speed(rig, 5.0, link=1, gravity=10.0)
    3.0
    """
    place = "revchain.momentum_for_speed"
    if not isinstance(rig, Rig):
        raise TypeError(f"{place}: rig must be a revchain.Rig, got {shown(rig)}")
    return _core.momentum_for_speed(
        rig._compiled,
        count(place, "link", link),
        real(place, "angular_speed", angular_speed),
        real(place, "gravity", gravity),
    )
