# SPDX-License-Identifier: GPL-3.0-or-later
"""Two links, or one with something that yields: closed forms of Greenhill (1908), sections 2, 6 and 8.

Conical heights are the roots of a quadratic, taken without a difference of like numbers; the figures
at any inclination are all there are. Lengths are in one unit of the user's, heights in the same; of
weights the ratio alone matters. A *link* is given by its `centroid`, the distance of its centre of
gravity from the pin it hangs by, and its `radius_of_gyration` about the centroid. What returns heights
broadcasts; numbers in give numbers out.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from .._core import PairShape
from ..systems.numbers import Floats, floats, numbers, positive, positives, real, refuse_where, together

__all__ = [
    "PairShape",
    "SwungLink",
    "joint_without_bending",
    "jointed_links",
    "jointed_links_shapes",
    "link_on_spring",
    "link_on_thread",
    "link_on_thread_shapes",
    "pendulum_length",
    "pin_of_silent_clapper",
    "seconds_lost_per_day",
    "share_at_centre_of_oscillation",
    "spring_deflection",
    "standing_link",
    "standing_link_shape",
    "standing_plummet",
    "standing_plummet_shape",
    "swung_link",
    "thread_of_standing_link",
    "two_plummets",
    "two_plummets_from_the_middle",
    "two_plummets_shapes",
]


class SwungLink(NamedTuple):
    """A link that swings round, hung from an axle on the axis.

    Attributes
    ----------
    inclination : float or ndarray
        To the vertical, rad.
    reaction : float or ndarray
        At the axle, over the weight.
    reaction_inclination : float or ndarray
        Of its line, rad.
    condition : float or ndarray
        Relative change of `inclination` over the largest relative change of the data; 0 for a vertical link.
    """

    inclination: Any
    reaction: Any
    reaction_inclination: Any
    condition: Any


def _link(place: str, centroid: ArrayLike, radius_of_gyration: ArrayLike, **given: ArrayLike) -> list[Floats]:
    """`given`, positive, then the link's numbers, all of one shape."""
    arrays = {name: positive(place, name, value) for name, value in given.items()}
    arrays["centroid"] = positive(place, "centroid", centroid)
    radius = arrays["radius_of_gyration"] = floats(place, "radius_of_gyration", radius_of_gyration)
    refuse_where(
        ~((radius >= 0) & (radius < inf)), radius, f"{place}: radius_of_gyration must not be negative, and finite"
    )
    return together(place, **arrays)


def _reals(place: str, **given: object) -> list[float]:
    """Single numbers, whose ranges are left to the compiled module."""
    return [real(place, name, value) for name, value in given.items()]


def two_plummets(
    *, lower_weight: ArrayLike, lower_thread: ArrayLike, upper_weight: ArrayLike, upper_thread: ArrayLike
) -> Floats:
    """Return both conical heights of two plummets, one hung from the other.

    Parameters
    ----------
    lower_weight, lower_thread, upper_weight, upper_thread : array_like
        Weights and lengths, positive.

    Returns
    -------
    ndarray, shape (..., 2)
        The larger (slower) first, within 3 ulp. Cost O(1) a pair.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Lagrange's ``(x - l1)(x - l2) = W1 l1 l2 / (W1 + W2)``, Greenhill (1908) section 2 (5). Springs of
    stiffness ``W1 / l1`` between two weights and ``(W1 + W2) / l2`` above do the same.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.two_plummets(lower_weight=1, lower_thread=1, upper_weight=3, upper_thread=1)
    array([1.5, 0.5])
    """
    place = "revchain.two_links.two_plummets"
    given = positives(
        place,
        lower_weight=lower_weight,
        lower_thread=lower_thread,
        upper_weight=upper_weight,
        upper_thread=upper_thread,
    )
    return np.stack(_core.two_plummets(*given), axis=-1)


def two_plummets_from_the_middle(half_length: ArrayLike, x: ArrayLike, weight_ratio: ArrayLike) -> Floats:
    """Return both conical heights from where the upper plummet sits on the thread.

    Parameters
    ----------
    half_length : array_like
        Half of both threads together, positive.
    x : array_like
        Distance of the upper plummet from the middle, on either side, less than `half_length`.
    weight_ratio : array_like
        Lower weight over upper weight, greater than -1. Negative: the lower one floats in a fluid
        that turns with it.

    Returns
    -------
    ndarray, shape (..., 2)
        The larger first, within 4 ulp. Cost O(1) a pair.

    Raises
    ------
    ValueError
        If a number is out of its range, or ``abs(x) < half_length * sqrt(-weight_ratio)``: the
        heights of a float are then complex, and it has no steady motion.

    Notes
    -----
    Greenhill (1908) section 2 (6), with Stokes's float.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.two_plummets_from_the_middle(1.0, 0.5, weight_ratio=0.5).round(6)
    array([1.707107, 0.292893])
    """
    place = "revchain.two_links.two_plummets_from_the_middle"
    half, at, ratio = together(
        place,
        half_length=positive(place, "half_length", half_length),
        x=floats(place, "x", x),
        weight_ratio=floats(place, "weight_ratio", weight_ratio),
    )
    return np.stack(_core.two_plummets_from_the_middle(half, at, ratio), axis=-1)


def pendulum_length(centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the length of the simple pendulum that swings as a link does.

    Parameters
    ----------
    centroid, radius_of_gyration : array_like
        Of the link: positive, and not negative (0 is a plummet).

    Returns
    -------
    float or ndarray
        ``centroid + radius_of_gyration**2 / centroid``, within 1.5 ulp: the distance of the centre of
        oscillation, from which the link swings in the same time.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Greenhill (1908) section 6 (6).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.two_links.pendulum_length(2.0, 1.0))
    2.5
    """
    return _core.pendulum_length(*_link("revchain.two_links.pendulum_length", centroid, radius_of_gyration))


def share_at_centre_of_oscillation(centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the share of a link's weight that belongs at its centre of oscillation, the rest at its pin.

    Parameters
    ----------
    centroid, radius_of_gyration : array_like
        Of the link: positive, and not negative (0 is a plummet).

    Returns
    -------
    float or ndarray
        ``centroid / pendulum_length``, within 2 ulp.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Maxwell's two particles; Greenhill (1908) section 6.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.two_links.share_at_centre_of_oscillation(2.0, 1.0))
    0.8
    """
    place = "revchain.two_links.share_at_centre_of_oscillation"
    return _core.share_at_centre_of_oscillation(*_link(place, centroid, radius_of_gyration))


def swung_link(centroid: ArrayLike, radius_of_gyration: ArrayLike, height: ArrayLike) -> SwungLink:
    """Return how a link swings round that hangs from an axle on the axis.

    Parameters
    ----------
    centroid, radius_of_gyration : array_like
        Of the link: positive, and not negative (0 is a plummet).
    height : array_like
        Conical height of the speed, positive.

    Returns
    -------
    SwungLink
        Of the broadcast shape; vertical unless `height` is less than its pendulum length ``l``. Within 4 ulp for the
        data as given, however near `height` is to ``l``. Data that are themselves rounded change the inclination
        ``d`` by up to `SwungLink.condition` times their relative error,
        ``cot(d) / d * (1 + (abs(h - b) + 2 b) / l)`` with ``h`` the centroid and ``b = radius_of_gyration**2 / h``.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Greenhill (1908) section 6 (1), (2).

    Examples
    --------
    >>> import revchain as rc
    >>> swing = rc.two_links.swung_link(2.0, 1.0, height=1.25)
    >>> round(float(swing.inclination), 6), round(float(swing.reaction), 6)
    (1.047198, 1.708801)
    """
    place = "revchain.two_links.swung_link"
    lambda_, h, k = _link(place, centroid, radius_of_gyration, height=height)
    return SwungLink(*numbers(_core.swung_link(h, k, lambda_)))


def link_on_thread(thread: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Floats:
    """Return both conical heights of a link hung by a thread: a boat from its davits, a bag in the hand.

    Parameters
    ----------
    thread : array_like
        Its length, positive.
    centroid, radius_of_gyration : array_like
        Of the link: positive, and not negative (0 is a plummet).

    Returns
    -------
    ndarray, shape (..., 2)
        The larger (slower) first, within 4 ulp; the second is 0 for a plummet. Cost O(1) a pair.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    ``(x - l)(x - thread) = thread * centroid``, Greenhill (1908) section 6 (11).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.link_on_thread(2.0, centroid=1.0, radius_of_gyration=1.0).round(6)
    array([3.414214, 0.585786])
    """
    place = "revchain.two_links.link_on_thread"
    return np.stack(_core.link_on_thread(*_link(place, centroid, radius_of_gyration, thread=thread)), axis=-1)


def standing_link(thread: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the conical height of a link that stands on its lowest point above a thread or a moving hand.

    Parameters
    ----------
    thread : array_like
        Its length, positive; a hand has to move as the end of that thread would.
    centroid, radius_of_gyration : array_like
        Of the link, the centroid above its lowest point: positive, and not negative.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 5 ulp; there always is one.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    ``(l + x)(thread - x) = thread * centroid``, Greenhill (1908) section 6 (12).

    Examples
    --------
    A broomstick of 1.2 m on a hand that moves like the end of a thread of 1 m:

    >>> import revchain as rc
    >>> round(float(rc.two_links.standing_link(1.0, centroid=0.6, radius_of_gyration=0.6 / 3**0.5)), 6)
    0.558258
    """
    place = "revchain.two_links.standing_link"
    return _core.standing_link(*_link(place, centroid, radius_of_gyration, thread=thread))


def thread_of_standing_link(height: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the thread on which a link stands at a given conical height: the inverse of `standing_link`.

    Parameters
    ----------
    height : array_like
        Conical height, positive.
    centroid, radius_of_gyration : array_like
        Of the link: positive, and not negative (0 is a plummet).

    Returns
    -------
    float or ndarray
        Broadcast shape, within 3 ulp.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Greenhill (1908) section 6 (13).

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.two_links.thread_of_standing_link(1.0, centroid=0.75, radius_of_gyration=0.75 / 3**0.5)), 6)
    1.6
    """
    place = "revchain.two_links.thread_of_standing_link"
    return _core.thread_of_standing_link(*_link(place, centroid, radius_of_gyration, height=height))


def standing_plummet(
    *, standing_weight: ArrayLike, rod: ArrayLike, hung_weight: ArrayLike, thread: ArrayLike
) -> Any:
    """Return the conical height of a plummet that stands above another on a stiff weightless rod.

    Parameters
    ----------
    standing_weight, rod : array_like
        Of the upper plummet, positive.
    hung_weight, thread : array_like
        Of the one below it, and of the thread it hangs by; positive.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 4 ulp; there always is one.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 2 (8).

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.two_links.standing_plummet(standing_weight=1, rod=1, hung_weight=3, thread=2)), 6)
    1.822876
    """
    place = "revchain.two_links.standing_plummet"
    return _core.standing_plummet(
        *positives(place, standing_weight=standing_weight, rod=rod, hung_weight=hung_weight, thread=thread)
    )


def spring_deflection(weight: ArrayLike, stiffness: ArrayLike) -> Any:
    """Return what a spring yields to the weight hung from it: it moves as a thread of that length.

    Parameters
    ----------
    weight, stiffness : array_like
        Force, and force per length; positive.

    Returns
    -------
    float or ndarray
        ``weight / stiffness``, broadcast shape.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 2 (7).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.two_links.spring_deflection(10.0, 400.0))
    0.025
    """
    return _core.spring_deflection(
        *positives("revchain.two_links.spring_deflection", weight=weight, stiffness=stiffness)
    )


def link_on_spring(deflection: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Floats:
    """Return both conical heights of a link whose support yields sideways.

    Parameters
    ----------
    deflection : array_like
        What the support would yield to the link's weight, positive: `spring_deflection`.
    centroid, radius_of_gyration : array_like
        Of the link: positive, and not negative (0 is a plummet).

    Returns
    -------
    ndarray, shape (..., 2)
        As `link_on_thread`, which it is.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Greenhill (1908) section 2, text after (7), says that the pendulum length grows by the deflection:
    exact for a plummet alone.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.link_on_spring(0.25, centroid=1.0, radius_of_gyration=0.0)
    array([1.25, 0.  ])
    """
    place = "revchain.two_links.link_on_spring"
    return np.stack(_core.link_on_thread(*_link(place, centroid, radius_of_gyration, deflection=deflection)), axis=-1)


def seconds_lost_per_day(deflection: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return by how much a clock is slow whose pendulum hangs from a support that yields.

    Parameters
    ----------
    deflection : array_like
        What the support yields sideways to the pendulum's weight, positive.
    centroid, radius_of_gyration : array_like
        Of the pendulum: positive, and not negative.

    Returns
    -------
    float or ndarray
        Seconds a day, of a clock that is right on a firm support; within 8 ulp for the data as given, however
        small. Data that are themselves rounded change it by up to ``1 + sqrt(l / centroid)`` times as much where
        deflection and pendulum length ``l`` nearly agree.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Greenhill (1908) section 2, text after (7).

    Examples
    --------
    A seconds pendulum on a bracket that yields a thousandth of a millimetre:

    >>> import revchain as rc
    >>> round(float(rc.two_links.seconds_lost_per_day(1e-6, centroid=0.994, radius_of_gyration=0.0)), 4)
    0.0435
    """
    place = "revchain.two_links.seconds_lost_per_day"
    return _core.seconds_lost_per_day(*_link(place, centroid, radius_of_gyration, deflection=deflection))


def two_plummets_shapes(
    *, lower_weight: float, lower_thread: float, upper_weight: float, upper_thread: float, height: float
) -> list[PairShape]:
    """Return all hanging figures of two plummets at a given speed, at any inclination.

    Parameters
    ----------
    lower_weight, lower_thread, upper_weight, upper_thread : float
        Weights and lengths, positive.
    height : float
        Conical height of the speed, positive.

    Returns
    -------
    list of PairShape
        By half waves, then inclination of the lower thread; of two mirror images the one with the lower
        plummet at a positive offset. Proved complete: at most one with both plummets on one side, where
        `height` lies below the first of `two_plummets`, and one or three with the plummets on two
        sides where it lies below the second. Inclinations within 4 ulp for the data as given, next to a fold
        and next to the vertical too. Data that are themselves rounded change the tangents by up to
        ``x / (x - height)`` times their relative error, `x` the conical height at which the figure leaves the
        vertical, and by its square root where two figures meet. Cost 10 microseconds a figure.

    Raises
    ------
    ValueError
        If a number is not positive and finite, or the lengths over `height` exceed 1e101.

    Notes
    -----
    Greenhill (1908) section 2 (4).

    Examples
    --------
    >>> import revchain as rc
    >>> pair = dict(lower_weight=1, lower_thread=2, upper_weight=3, upper_thread=1)
    >>> for shape in rc.two_links.two_plummets_shapes(**pair, height=1 / 64):
    ...     print(shape.half_waves, shape.inclination.round(3))
    1 [1.566 1.56 ]
    2 [ 0.529 -1.55 ]
    2 [ 1.555 -1.54 ]
    2 [ 1.56  -0.534]
    """
    place = "revchain.two_links.two_plummets_shapes"
    return _core.two_plummets_shapes(
        *_reals(
            place,
            lower_weight=lower_weight,
            lower_thread=lower_thread,
            upper_weight=upper_weight,
            upper_thread=upper_thread,
            height=height,
        )
    )


def link_on_thread_shapes(
    thread: float, centroid: float, radius_of_gyration: float, height: float
) -> list[PairShape]:
    """Return all hanging figures of a link on a thread at a given speed, at any inclination.

    Parameters
    ----------
    thread, centroid, radius_of_gyration : float
        As in `link_on_thread`.
    height : float
        Conical height of the speed, positive.

    Returns
    -------
    list of PairShape
        As `two_plummets_shapes`; the first offset is that of the centre of oscillation.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Greenhill (1908) section 6 (10).

    Examples
    --------
    >>> import revchain as rc
    >>> len(rc.two_links.link_on_thread_shapes(2.0, centroid=1.0, radius_of_gyration=1.0, height=0.5))
    2
    """
    place = "revchain.two_links.link_on_thread_shapes"
    return _core.link_on_thread_shapes(
        *_reals(place, thread=thread, centroid=centroid, radius_of_gyration=radius_of_gyration, height=height)
    )


def standing_plummet_shape(
    *, standing_weight: float, rod: float, hung_weight: float, thread: float, height: float
) -> PairShape | None:
    """Return the figure in which a plummet stands above another, at any inclination.

    Parameters
    ----------
    standing_weight, rod, hung_weight, thread : float
        As in `standing_plummet`.
    height : float
        Conical height of the speed, positive.

    Returns
    -------
    PairShape or None
        The only one; none unless `height` is less than `standing_plummet`. The first inclination is
        the rod's to the upward vertical, the first tension its thrust, negative.

    Raises
    ------
    ValueError
        If a number is not positive and finite.

    Notes
    -----
    Greenhill (1908) section 2 (8).

    Examples
    --------
    >>> import revchain as rc
    >>> pair = dict(standing_weight=1, rod=1, hung_weight=3, thread=2)
    >>> rc.two_links.standing_plummet_shape(**pair, height=0.9).inclination.round(4)
    array([0.8321, 1.0427])
    >>> rc.two_links.standing_plummet_shape(**pair, height=1.9) is None
    True
    """
    place = "revchain.two_links.standing_plummet_shape"
    return _core.standing_plummet_shape(
        *_reals(
            place, standing_weight=standing_weight, rod=rod, hung_weight=hung_weight, thread=thread, height=height
        )
    )


def standing_link_shape(
    thread: float, centroid: float, radius_of_gyration: float, height: float
) -> PairShape | None:
    """Return the figure in which a link stands on its lowest point, at any inclination.

    Parameters
    ----------
    thread, centroid, radius_of_gyration : float
        As in `standing_link`.
    height : float
        Conical height of the speed, positive.

    Returns
    -------
    PairShape or None
        The only one; none unless `height` is less than `standing_link`. The first inclination is the
        link's to the upward vertical, both tensions are that of the thread or hand.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    Greenhill (1908) section 6 (12), with the secants of (10).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.standing_link_shape(1.0, centroid=0.6, radius_of_gyration=0.35, height=0.5).half_waves
    1
    """
    place = "revchain.two_links.standing_link_shape"
    return _core.standing_link_shape(
        *_reals(place, thread=thread, centroid=centroid, radius_of_gyration=radius_of_gyration, height=height)
    )


def jointed_links(
    *,
    lower_weight: ArrayLike,
    lower_centroid: ArrayLike,
    lower_radius_of_gyration: ArrayLike,
    upper_weight: ArrayLike,
    upper_length: ArrayLike,
    upper_centroid: ArrayLike,
    upper_radius_of_gyration: ArrayLike,
) -> Floats:
    """Return both conical heights of any two links jointed together, a bell and its clapper among them.

    Parameters
    ----------
    lower_weight, upper_weight : array_like
        Positive.
    lower_centroid, lower_radius_of_gyration : array_like
        Of the lower link, from the joint: positive, and not negative (0 is a plummet).
    upper_length : array_like
        From the support to the joint, positive.
    upper_centroid, upper_radius_of_gyration : array_like
        Of the upper link, from the support: of any sign as long as the link hangs, and not negative.

    Returns
    -------
    ndarray, shape (..., 2)
        The larger (slower) first, within 3 ulp. Cost O(1) a pair.

    Raises
    ------
    ValueError
        If a number is out of its range, or the upper link would stand.

    Notes
    -----
    ``a2 h1 / (x - l1) = (m + 1)(x - l2) + l2 - a2``, ``m = W2 h2 / (W1 a2)``, Greenhill (1908) section 8
    (14); where l2 = a2, (15).

    Examples
    --------
    >>> import revchain as rc
    >>> clapper = dict(lower_weight=1.0, lower_centroid=0.75, lower_radius_of_gyration=0.1875**0.5)
    >>> bell = dict(upper_weight=1.0, upper_length=0.25, upper_centroid=0.125, upper_radius_of_gyration=0.203125**0.5)
    >>> rc.two_links.jointed_links(**clapper, **bell).round(6)
    array([1.25, 0.5 ])
    """
    place = "revchain.two_links.jointed_links"
    arrays = together(
        place,
        lower_weight=positive(place, "lower_weight", lower_weight),
        lower_centroid=positive(place, "lower_centroid", lower_centroid),
        lower_radius_of_gyration=floats(place, "lower_radius_of_gyration", lower_radius_of_gyration),
        upper_weight=positive(place, "upper_weight", upper_weight),
        upper_length=positive(place, "upper_length", upper_length),
        upper_centroid=floats(place, "upper_centroid", upper_centroid),
        upper_radius_of_gyration=floats(place, "upper_radius_of_gyration", upper_radius_of_gyration),
    )
    return np.stack(_core.jointed_links(*arrays), axis=-1)


def jointed_links_shapes(
    *,
    lower_weight: float,
    lower_centroid: float,
    lower_radius_of_gyration: float,
    upper_weight: float,
    upper_length: float,
    upper_centroid: float,
    upper_radius_of_gyration: float,
    height: float,
) -> list[PairShape]:
    """Return all hanging figures of two jointed links at a given speed, at any inclination.

    Parameters
    ----------
    lower_weight, lower_centroid, lower_radius_of_gyration : float
        As in `jointed_links`.
    upper_weight, upper_length, upper_centroid, upper_radius_of_gyration : float
        As in `jointed_links`.
    height : float
        Conical height of the speed, positive.

    Returns
    -------
    list of PairShape
        By half waves, then inclination of the lower link: all there are, four at the most, for any
        pendulum lengths. The first offset is that of the lower link's centre of oscillation; tensions
        are the sizes of the reactions at the upper pins over the whole weight.

    Raises
    ------
    ValueError
        If a number is out of its range, or the upper link would stand.

    Notes
    -----
    Greenhill (1908) section 8 (14) with its secants.

    Examples
    --------
    >>> import revchain as rc
    >>> clapper = dict(lower_weight=1.0, lower_centroid=0.75, lower_radius_of_gyration=0.1875**0.5)
    >>> bell = dict(upper_weight=1.0, upper_length=0.25, upper_centroid=0.125, upper_radius_of_gyration=0.203125**0.5)
    >>> rc.two_links.jointed_links_shapes(**clapper, **bell, height=1.0)[0].inclination.round(6)
    array([0.643501, 0.643501])
    """
    place = "revchain.two_links.jointed_links_shapes"
    return _core.jointed_links_shapes(
        *_reals(
            place,
            lower_weight=lower_weight,
            lower_centroid=lower_centroid,
            lower_radius_of_gyration=lower_radius_of_gyration,
            upper_weight=upper_weight,
            upper_length=upper_length,
            upper_centroid=upper_centroid,
            upper_radius_of_gyration=upper_radius_of_gyration,
            height=height,
        )
    )


def pin_of_silent_clapper(
    *,
    bell_weight: ArrayLike,
    bell_centroid: ArrayLike,
    bell_radius_of_gyration: ArrayLike,
    clapper_weight: ArrayLike,
    clapper_centroid: ArrayLike,
    clapper_radius_of_gyration: ArrayLike,
) -> Any:
    """Return how far below its support a bell must carry its clapper's pin to stay silent.

    Parameters
    ----------
    bell_weight, clapper_weight : array_like
        Positive.
    bell_centroid, bell_radius_of_gyration : array_like
        Of the bell, from its support: positive, and not negative.
    clapper_centroid, clapper_radius_of_gyration : array_like
        Of the clapper, from its pin: positive, and not negative.

    Returns
    -------
    float or ndarray
        The distance at which both swing, or whirl at any inclination, in one line as if clamped. The
        conical height of that motion is the distance and the clapper's `pendulum_length`. Within 4 ulp for the data
        as given. Data that are themselves rounded change it by up to ``3 (l1 + l2) / (l2 - l1) + 6`` times their
        relative error, l1 and l2 the pendulum lengths of clapper and bell.

    Raises
    ------
    ValueError
        If a number is out of its range, or the clapper's pendulum length is not less than the bell's:
        then the bell rings wherever its pin is.

    Notes
    -----
    ``h1 = (m + 1) l1 + m (a2 - l2)``, Greenhill (1908) section 8 (16), solved for a2.

    Examples
    --------
    >>> import revchain as rc
    >>> bell = dict(bell_weight=1.0, bell_centroid=0.125, bell_radius_of_gyration=0.203125**0.5)
    >>> clapper = dict(clapper_weight=1.0, clapper_centroid=0.75, clapper_radius_of_gyration=0.1875**0.5)
    >>> round(float(rc.two_links.pin_of_silent_clapper(**bell, **clapper)), 12)
    0.25
    """
    place = "revchain.two_links.pin_of_silent_clapper"
    return _core.pin_of_silent_clapper(
        *together(
            place,
            bell_weight=positive(place, "bell_weight", bell_weight),
            bell_centroid=positive(place, "bell_centroid", bell_centroid),
            bell_radius_of_gyration=floats(place, "bell_radius_of_gyration", bell_radius_of_gyration),
            clapper_weight=positive(place, "clapper_weight", clapper_weight),
            clapper_centroid=positive(place, "clapper_centroid", clapper_centroid),
            clapper_radius_of_gyration=floats(place, "clapper_radius_of_gyration", clapper_radius_of_gyration),
        )
    )


def joint_without_bending(length: ArrayLike, pin: ArrayLike) -> Any:
    """Return where a uniform rod, hung off its middle, may be jointed and still swing as one straight rod.

    Parameters
    ----------
    length : array_like
        Of the rod, positive.
    pin : array_like
        Distance of the pin from the middle of the rod: more than a sixth of the length, less than half.

    Returns
    -------
    float or ndarray
        Distance of the joint below the pin: there the rod, swinging or whirling at any inclination, does
        not bend. Within 2.5 ulp for pins up to 0.49 of the length.

    Raises
    ------
    ValueError
        If a number is out of its range.

    Notes
    -----
    CG.CD = CA^2, Greenhill (1908) section 8 (17): C the pin, G the middle, D the joint, A the end above.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.two_links.joint_without_bending(2.0, 0.5))
    0.5
    """
    place = "revchain.two_links.joint_without_bending"
    return _core.joint_without_bending(*positives(place, length=length, pin=pin))
