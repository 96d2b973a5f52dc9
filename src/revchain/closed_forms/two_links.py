# SPDX-License-Identifier: GPL-3.0-or-later
"""Closed forms for two links (the double pendulum), or for one link on a support that yields.

For small inclinations the conical heights are the roots of a quadratic, computed without cancellation. At any inclination
all steady shapes (relative equilibria) are found. Lengths and heights are in one unit; only the ratio of weights matters.
A plummet is a point mass on a massless thread. A *link* is a rigid body with a `centroid`, the distance of its centre of
gravity below its upper pin (positive), and a `radius_of_gyration` about the centre of gravity (not negative; 0 is a
plummet). `height` is the conical height ``gravity / angular_speed**2`` of a speed. Functions that return heights
broadcast, at cost O(1) for each number; single numbers give single numbers. A number out of its range raises a
ValueError. Source: Greenhill (1908), sections 2, 6 and 8.
"""

from __future__ import annotations

from math import inf
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Field, Result
from ..results.sheet import Column, Sheet
from ..systems.numbers import Floats, beside, floats, numbers, positive, reals, refuse_where

__all__ = [
    "PairShape", "SwungLink", "joint_without_bending", "jointed_links", "jointed_links_shapes", "link_on_thread",
    "link_on_thread_shapes", "pendulum_length", "pin_of_silent_clapper", "seconds_lost_per_day",
    "share_at_centre_of_oscillation", "spring_deflection", "standing_link", "standing_link_shape", "standing_plummet",
    "standing_plummet_shape", "swung_link", "thread_of_standing_link", "two_plummets", "two_plummets_from_the_middle",
    "two_plummets_shapes",
]

SIGNED = ("x", "weight_ratio", "upper_centroid")  # arguments that may be negative


class PairShape(Result):
    """A steady shape of two links, the lower one first; returned by the functions of this module.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.link_on_thread_shapes(2.0, centroid=1.0, radius_of_gyration=1.0, height=0.5)[0]
    PairShape: 1 half wave
    link  inclination (°)  from the axis  tension
       0          82.7972        3.95636  6.01225
       1          80.4257        1.97214  6.01225
    """

    __slots__ = ()
    inclination: Field[Floats] = Field("Inclination of each link to the vertical, rad, shape (2,).")
    offset: Field[Floats] = Field(
        "Distance from the axis of the lower plummet (for a link, its centre of oscillation) and of the joint, shape (2,).",
    )
    tension: Field[Floats] = Field("Tension above each link, divided by the whole weight, shape (2,).")
    half_waves: Field[int] = Field("Sign changes of the offsets, plus one.")

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("link", np.arange(2), "link"),
            Column("inclination", self.inclination, "inclination (°)", shown=np.degrees(self.inclination)),
            Column("offset", self.offset, "from the axis"),
            Column("tension", self.tension, "tension"),
        ]
        heading = f"PairShape: {self.half_waves} half wave{'s' * (self.half_waves != 1)}"
        return Sheet("link", heading, columns, {"half_waves": self.half_waves})


class SwungLink(NamedTuple):
    """A link that circles below a pin on the axis; angles in rad.

    `inclination`: inclination of the link to the vertical. `reaction`: force at the pin divided by the weight.
    `reaction_inclination`: inclination of that force. `condition`: relative change of `inclination` divided by the largest
    relative change of the data, 0 for a vertical link.

    Examples
    --------
    >>> import revchain as rc
    >>> swing = rc.two_links.swung_link(2.0, 1.0, height=1.25)
    >>> round(float(swing.reaction_inclination), 6), round(float(swing.condition), 3)
    (0.945663, 1.103)
    """

    inclination: Any
    reaction: Any
    reaction_inclination: Any
    condition: Any


def _checked(function: str, given: dict[str, Any]) -> list[Floats]:
    """All arguments of a function of this module as arrays, broadcast; positive unless listed in `SIGNED`."""
    place, arrays = f"revchain.two_links.{function}", {}
    for name, value in given.items():
        array = arrays[name] = floats(place, name, value)
        if name.endswith("radius_of_gyration"):
            wrong = ~((array >= 0) & (array < inf))
            refuse_where(wrong, array, f"{place}: {name} must be finite and not negative")
        elif name not in SIGNED:
            positive(place, name, array)
    return beside(place, **arrays)


def _shapes(function: str, given: dict[str, Any]) -> list[PairShape]:
    """The steady shapes that the compiled function of that name returns."""
    checked = reals(f"revchain.two_links.{function}", **given)
    _checked(function, checked)
    found = getattr(_core, function)(**checked)
    return [PairShape._made(each) for each in (found if isinstance(found, list) else [found]) if each is not None]


def two_plummets(
    *, lower_weight: ArrayLike, lower_thread: ArrayLike, upper_weight: ArrayLike, upper_thread: ArrayLike
) -> Floats:
    """Return both conical heights of the double pendulum: two plummets, one hung from the other.

    Parameters
    ----------
    lower_weight, lower_thread, upper_weight, upper_thread : array_like
        Weights and lengths, positive.

    Returns
    -------
    ndarray, shape (..., 2)
        The larger (slower) first, within 3 ulp: Lagrange's ``(x - l1)(x - l2) = W1 l1 l2 / (W1 + W2)``, section 2 (5).
        Two weights on springs, of stiffness ``W1 / l1`` between them and ``(W1 + W2) / l2`` above, move alike.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.two_plummets(lower_weight=1, lower_thread=1, upper_weight=3, upper_thread=1)
    array([1.5, 0.5])
    """
    return np.stack(_core.two_plummets(*_checked("two_plummets", locals())), axis=-1)


def two_plummets_from_the_middle(half_length: ArrayLike, x: ArrayLike, weight_ratio: ArrayLike) -> Floats:
    """Return both conical heights of two plummets, given the place of the upper one on the thread.

    Parameters
    ----------
    half_length : array_like
        Half the total length of both threads, positive.
    x : array_like
        Distance of the upper plummet from the middle, on either side, less than `half_length`.
    weight_ratio : array_like
        Lower weight divided by upper weight, greater than -1. If negative, the lower body floats in a fluid that turns
        with it (Stokes's float).

    Returns
    -------
    ndarray, shape (..., 2)
        The larger first, within 4 ulp: section 2 (6).

    Raises
    ------
    ValueError
        If ``abs(x) < half_length * sqrt(-weight_ratio)``: the heights of a float are then complex, and it has no steady
        motion.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.two_plummets_from_the_middle(1.0, 0.5, weight_ratio=0.5).round(6)
    array([1.707107, 0.292893])
    """
    return np.stack(_core.two_plummets_from_the_middle(*_checked("two_plummets_from_the_middle", locals())), axis=-1)


def pendulum_length(centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the length of the simple pendulum with the period of a link.

    Parameters
    ----------
    centroid, radius_of_gyration : array_like
        Data of the link.

    Returns
    -------
    float or ndarray
        ``centroid + radius_of_gyration**2 / centroid``, within 1.5 ulp. This is the distance of the centre of
        oscillation; a pin there gives the same period. Section 6 (6).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.two_links.pendulum_length(2.0, 1.0))
    2.5
    """
    return _core.pendulum_length(*_checked("pendulum_length", locals()))


def share_at_centre_of_oscillation(centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the part of the weight of a link at its centre of oscillation; the rest is at its pin (Maxwell's particles).

    Parameters
    ----------
    centroid, radius_of_gyration : array_like
        Data of the link.

    Returns
    -------
    float or ndarray
        ``centroid / pendulum_length``, within 2 ulp. Section 6.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.two_links.share_at_centre_of_oscillation(2.0, 1.0))
    0.8
    """
    return _core.share_at_centre_of_oscillation(*_checked("share_at_centre_of_oscillation", locals()))


def swung_link(centroid: ArrayLike, radius_of_gyration: ArrayLike, height: ArrayLike) -> SwungLink:
    """Return the steady motion of a link below a pin on the axis (the compound conical pendulum).

    Parameters
    ----------
    centroid, radius_of_gyration, height : array_like
        Data of the link, and conical height, positive.

    Returns
    -------
    SwungLink
        Broadcast shape; the link is vertical unless `height` is less than its pendulum length ``l``. Accuracy: 4 ulp for
        the data as given, also where `height` is close to ``l``. A relative error of the data changes the inclination
        ``d`` by up to `SwungLink.condition` times as much:
        ``cot(d) / d * (1 + (abs(h - b) + 2 b) / l)`` with ``h`` the centroid and ``b = radius_of_gyration**2 / h``.
        Section 6 (1), (2).

    Examples
    --------
    >>> import revchain as rc
    >>> swing = rc.two_links.swung_link(2.0, 1.0, height=1.25)
    >>> round(float(swing.inclination), 6), round(float(swing.reaction), 6)
    (1.047198, 1.708801)
    """
    return SwungLink(*numbers(_core.swung_link(*_checked("swung_link", locals()))))


def link_on_thread(thread: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Floats:
    """Return both conical heights of a link on a thread (a boat on its davits) or on a support that yields.

    Parameters
    ----------
    thread : array_like
        Length of the thread, positive. For a support that yields sideways it is the deflection under the weight, see
        `spring_deflection`.
    centroid, radius_of_gyration : array_like
        Data of the link.

    Returns
    -------
    ndarray, shape (..., 2)
        The larger (slower) first, within 4 ulp; the second is 0 for a plummet:
        ``(x - l)(x - thread) = thread * centroid``, section 6 (11). Section 2 adds the deflection of the support to the
        pendulum length; that is exact only for a plummet.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.link_on_thread(2.0, centroid=1.0, radius_of_gyration=1.0).round(6)
    array([3.414214, 0.585786])
    """
    return np.stack(_core.link_on_thread(*_checked("link_on_thread", locals())), axis=-1)


def standing_link(thread: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the conical height of an inverted link that stands on the end of a thread or on a moving hand.

    Parameters
    ----------
    thread : array_like
        Length of the thread, positive. A hand must move as the end of such a thread does.
    centroid, radius_of_gyration : array_like
        Data of the link; the centroid is the distance above its lowest point.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 5 ulp: ``(l + x)(thread - x) = thread * centroid``, section 6 (12). It is 0, and there is no
        such motion, for a link without radius of gyration whose centroid is at the thread's length or above.

    Examples
    --------
    A broomstick of 1.2 m on a hand that moves like the end of a thread of 1 m:

    >>> import revchain as rc
    >>> round(float(rc.two_links.standing_link(1.0, centroid=0.6, radius_of_gyration=0.6 / 3**0.5)), 6)
    0.558258
    """
    return _core.standing_link(*_checked("standing_link", locals()))


def thread_of_standing_link(height: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the length of the thread on which a link stands at a conical height: the inverse of `standing_link`.

    Parameters
    ----------
    height, centroid, radius_of_gyration : array_like
        Conical height, positive, and data of the link.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 3 ulp. Section 6 (13).

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.two_links.thread_of_standing_link(1.0, centroid=0.75, radius_of_gyration=0.75 / 3**0.5)), 6)
    1.6
    """
    return _core.thread_of_standing_link(*_checked("thread_of_standing_link", locals()))


def standing_plummet(*, standing_weight: ArrayLike, rod: ArrayLike, hung_weight: ArrayLike, thread: ArrayLike) -> Any:
    """Return the conical height of an inverted plummet that stands above a hanging one on a rigid massless rod.

    Parameters
    ----------
    standing_weight, rod, hung_weight, thread : array_like
        Weight of the upper plummet, length of its rod, weight of the lower plummet, length of its thread; positive.

    Returns
    -------
    float or ndarray
        Broadcast shape, within 4 ulp. The height always exists. Section 2 (8).

    Examples
    --------
    >>> import revchain as rc
    >>> round(float(rc.two_links.standing_plummet(standing_weight=1, rod=1, hung_weight=3, thread=2)), 6)
    1.822876
    """
    return _core.standing_plummet(*_checked("standing_plummet", locals()))


def spring_deflection(weight: ArrayLike, stiffness: ArrayLike) -> Any:
    """Return the deflection of a spring under a weight, the length of the thread that moves as the support does.

    Parameters
    ----------
    weight, stiffness : array_like
        Force, and force per length; positive.

    Returns
    -------
    float or ndarray
        ``weight / stiffness``, broadcast shape. Section 2 (7).

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.two_links.spring_deflection(10.0, 400.0))
    0.025
    """
    return _core.spring_deflection(*_checked("spring_deflection", locals()))


def seconds_lost_per_day(deflection: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Any:
    """Return the time that a pendulum clock on a yielding support loses in a day.

    Parameters
    ----------
    deflection : array_like
        Sideways deflection of the support under the weight of the pendulum, positive.
    centroid, radius_of_gyration : array_like
        Data of the pendulum.

    Returns
    -------
    float or ndarray
        Seconds lost per day by a clock that is right on a firm support. Accuracy: 8 ulp for the data as given, also for
        small losses. A relative error of the data changes the result by up to ``1 + sqrt(l / centroid)`` times as much
        if the deflection nearly equals the pendulum length ``l``. Section 2, text after (7).

    Examples
    --------
    A seconds pendulum on a bracket that yields by a thousandth of a millimetre:

    >>> import revchain as rc
    >>> round(float(rc.two_links.seconds_lost_per_day(1e-6, centroid=0.994, radius_of_gyration=0.0)), 4)
    0.0435
    """
    return _core.seconds_lost_per_day(*_checked("seconds_lost_per_day", locals()))


def two_plummets_shapes(
    *, lower_weight: float, lower_thread: float, upper_weight: float, upper_thread: float, height: float
) -> list[PairShape]:
    """Return all hanging steady shapes of two plummets at a speed, at any inclination.

    Parameters
    ----------
    lower_weight, lower_thread, upper_weight, upper_thread, height : float
        Weights, lengths and conical height, positive.

    Returns
    -------
    list of PairShape
        All shapes, ordered by half waves, then by the inclination of the lower thread; of two mirror images the one with
        the lower plummet at a positive offset. The list is proved complete. One shape has both plummets on one side, if
        `height` is below the first of `two_plummets`; one or three have them on opposite sides, if it is below the second.
        Accuracy: inclinations 4 ulp for the data as given, also close to a fold and to the vertical. A relative error of
        the data changes the tangents by up to ``x / (x - height)`` times as much, where `x` is the conical height at which
        the shape leaves the vertical; where two shapes meet, by its square root. Cost: 10 microseconds for each shape.
        Section 2 (4).

    Raises
    ------
    ValueError
        If a length divided by `height` exceeds 1e101.

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
    return _shapes("two_plummets_shapes", locals())


def link_on_thread_shapes(thread: float, centroid: float, radius_of_gyration: float, height: float) -> list[PairShape]:
    """Return all hanging steady shapes of a link on a thread at a speed, at any inclination.

    Parameters
    ----------
    thread, centroid, radius_of_gyration, height : float
        Data as in `link_on_thread`, and conical height, positive.

    Returns
    -------
    list of PairShape
        All shapes, in the order and with the accuracy of `two_plummets_shapes`. Section 6 (10).

    Examples
    --------
    >>> import revchain as rc
    >>> len(rc.two_links.link_on_thread_shapes(2.0, centroid=1.0, radius_of_gyration=1.0, height=0.5))
    2
    """
    return _shapes("link_on_thread_shapes", locals())


def standing_plummet_shape(
    *, standing_weight: float, rod: float, hung_weight: float, thread: float, height: float
) -> PairShape | None:
    """Return the steady shape in which a plummet stands above a hanging one, at any inclination.

    Parameters
    ----------
    standing_weight, rod, hung_weight, thread, height : float
        Data as in `standing_plummet`, and conical height, positive.

    Returns
    -------
    PairShape or None
        The only shape; None unless `height` is less than `standing_plummet`. The first inclination is that of the rod to
        the upward vertical; the first tension is negative, the thrust in the rod. Section 2 (8).

    Examples
    --------
    >>> import revchain as rc
    >>> pair = dict(standing_weight=1, rod=1, hung_weight=3, thread=2)
    >>> rc.two_links.standing_plummet_shape(**pair, height=0.9).inclination.round(4)
    array([0.8321, 1.0427])
    >>> rc.two_links.standing_plummet_shape(**pair, height=1.9) is None
    True
    """
    return next(iter(_shapes("standing_plummet_shape", locals())), None)


def standing_link_shape(thread: float, centroid: float, radius_of_gyration: float, height: float) -> PairShape | None:
    """Return the steady shape in which a link stands on its lowest point, at any inclination.

    Parameters
    ----------
    thread, centroid, radius_of_gyration, height : float
        Data as in `standing_link`, and conical height, positive.

    Returns
    -------
    PairShape or None
        The only shape; None unless `height` is less than `standing_link`. The first inclination is that of the link to
        the upward vertical; both tensions are that of the thread or hand. Section 6 (12), with the secants of (10).

    Examples
    --------
    >>> import revchain as rc
    >>> rc.two_links.standing_link_shape(1.0, centroid=0.6, radius_of_gyration=0.35, height=0.5).half_waves
    1
    """
    return next(iter(_shapes("standing_link_shape", locals())), None)


def jointed_links(
    *, lower_weight: ArrayLike, lower_centroid: ArrayLike, lower_radius_of_gyration: ArrayLike,
    upper_weight: ArrayLike, upper_length: ArrayLike, upper_centroid: ArrayLike, upper_radius_of_gyration: ArrayLike,
) -> Floats:
    """Return both conical heights of two jointed links, such as a bell and its clapper.

    Parameters
    ----------
    lower_weight, upper_weight : array_like
        Weights of the links, positive.
    lower_centroid, lower_radius_of_gyration : array_like
        Data of the lower link; the centroid is the distance below the joint.
    upper_length : array_like
        Distance from the support to the joint, positive.
    upper_centroid, upper_radius_of_gyration : array_like
        Data of the upper link; the centroid is the distance below the support. It may be negative if the link still
        hangs; a link that would stand raises a ValueError.

    Returns
    -------
    ndarray, shape (..., 2)
        The larger (slower) first, within 3 ulp: ``a2 h1 / (x - l1) = (m + 1)(x - l2) + l2 - a2``,
        ``m = W2 h2 / (W1 a2)``, section 8 (14), or (15) if l2 = a2.

    Examples
    --------
    >>> import revchain as rc
    >>> clapper = dict(lower_weight=1.0, lower_centroid=0.75, lower_radius_of_gyration=0.1875**0.5)
    >>> bell = dict(upper_weight=1.0, upper_length=0.25, upper_centroid=0.125, upper_radius_of_gyration=0.203125**0.5)
    >>> rc.two_links.jointed_links(**clapper, **bell).round(6)
    array([1.25, 0.5 ])
    """
    return np.stack(_core.jointed_links(*_checked("jointed_links", locals())), axis=-1)


def jointed_links_shapes(
    *, lower_weight: float, lower_centroid: float, lower_radius_of_gyration: float, upper_weight: float,
    upper_length: float, upper_centroid: float, upper_radius_of_gyration: float, height: float,
) -> list[PairShape]:
    """Return all hanging steady shapes of two jointed links at a speed, at any inclination.

    Parameters
    ----------
    lower_weight, lower_centroid, lower_radius_of_gyration : float
        Data of the lower link as in `jointed_links`.
    upper_weight, upper_length, upper_centroid, upper_radius_of_gyration, height : float
        Data of the upper link as in `jointed_links`, and conical height, positive.

    Returns
    -------
    list of PairShape
        All shapes, at most four, ordered by half waves, then by the inclination of the lower link; pendulum lengths may
        have any value. Tensions are the sizes of the reactions at the upper pins. Section 8 (14) with its secants.

    Examples
    --------
    >>> import revchain as rc
    >>> clapper = dict(lower_weight=1.0, lower_centroid=0.75, lower_radius_of_gyration=0.1875**0.5)
    >>> bell = dict(upper_weight=1.0, upper_length=0.25, upper_centroid=0.125, upper_radius_of_gyration=0.203125**0.5)
    >>> rc.two_links.jointed_links_shapes(**clapper, **bell, height=1.0)[0].inclination.round(6)
    array([0.643501, 0.643501])
    """
    return _shapes("jointed_links_shapes", locals())


def pin_of_silent_clapper(
    *, bell_weight: ArrayLike, bell_centroid: ArrayLike, bell_radius_of_gyration: ArrayLike,
    clapper_weight: ArrayLike, clapper_centroid: ArrayLike, clapper_radius_of_gyration: ArrayLike,
) -> Any:
    """Return the distance of the pin of the clapper below the support of the bell at which the bell is silent.

    Parameters
    ----------
    bell_weight, clapper_weight : array_like
        Weights, positive.
    bell_centroid, bell_radius_of_gyration : array_like
        Data of the bell; the centroid is the distance below its support, positive.
    clapper_centroid, clapper_radius_of_gyration : array_like
        Data of the clapper; the centroid is the distance below its pin, positive.

    Returns
    -------
    float or ndarray
        The distance ``a2`` at which both swing, or whirl at any inclination, in one line as if clamped:
        ``h1 = (m + 1) l1 + m (a2 - l2)``, section 8 (16), solved for a2. The conical height of that motion is the
        distance plus the `pendulum_length` of the clapper. Accuracy: 4 ulp for the data as given. A relative error of the
        data changes the result by up to ``3 (l1 + l2) / (l2 - l1) + 6`` times as much, with l1 and l2 the pendulum
        lengths of clapper and bell.

    Raises
    ------
    ValueError
        If the pendulum length of the clapper is not less than that of the bell: the bell then rings for any place of the
        pin.

    Examples
    --------
    >>> import revchain as rc
    >>> bell = dict(bell_weight=1.0, bell_centroid=0.125, bell_radius_of_gyration=0.203125**0.5)
    >>> clapper = dict(clapper_weight=1.0, clapper_centroid=0.75, clapper_radius_of_gyration=0.1875**0.5)
    >>> round(float(rc.two_links.pin_of_silent_clapper(**bell, **clapper)), 12)
    0.25
    """
    return _core.pin_of_silent_clapper(*_checked("pin_of_silent_clapper", locals()))


def joint_without_bending(length: ArrayLike, pin: ArrayLike) -> Any:
    """Return the place of a joint in a hanging uniform rod at which the rod still swings straight.

    Parameters
    ----------
    length : array_like
        Length of the rod, positive.
    pin : array_like
        Distance of the pin from the middle of the rod: more than a sixth of the length, less than half.

    Returns
    -------
    float or ndarray
        Distance of the joint below the pin. With a joint there, the rod does not bend when it swings, or whirls at any
        inclination. Accuracy: 2.5 ulp for pins up to 0.49 of the length. Section 8 (17): CG.CD = CA^2, with C the pin, G
        the middle, D the joint, A the upper end.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.two_links.joint_without_bending(2.0, 0.5))
    0.5
    """
    return _core.joint_without_bending(*_checked("joint_without_bending", locals()))
