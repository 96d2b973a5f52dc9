# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="empty-body"
# The decorator of table.py gives each function its body, a call of the compiled formula, and completes its docstring.
"""Closed forms for two links (the double pendulum), or for one link on a support that yields.

For small inclinations the conical heights are the roots of a quadratic, computed without cancellation. Functions named
``..._shapes`` return steady shapes (relative equilibria) at any inclination. Of two weights only the ratio matters. A
plummet is a point mass on a massless thread. A *link* is a rigid body with a `centroid`, the distance of its centre of
gravity below its upper pin, and a `radius_of_gyration` about the centre of gravity. Source: Greenhill (1908), sections 2,
6 and 8.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..results.base import Field, Result
from ..systems.numbers import Floats, Whole
from .table import FloatOrArray, closed_form

__all__ = [
    "PairShape", "SwungLink", "joint_without_bending", "jointed_links", "jointed_links_shapes", "link_on_thread",
    "link_on_thread_shapes", "pendulum_length", "pin_of_silent_clapper", "seconds_lost_per_day",
    "share_at_centre_of_oscillation", "spring_deflection", "standing_link", "standing_link_shape", "standing_plummet",
    "standing_plummet_shape", "swung_link", "thread_of_standing_link", "two_plummets", "two_plummets_from_the_middle",
    "two_plummets_shapes",
]


class PairShape(Result, row="link", title="PairShape: {_waves}"):
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
    link: Field[Whole] = Field("Numbers of the links, the lower one first.", lambda s: np.arange(2), heading="link")
    inclination: Field[Floats] = Field(
        "Inclination of each link to the vertical, rad, shape (2,).", heading="inclination", unit="rad"
    )
    offset: Field[Floats] = Field(
        "Distance from the axis of the lower plummet (for a link, its centre of oscillation) and the joint, shape (2,).",
        heading="from the axis",
    )
    tension: Field[Floats] = Field(
        "Tension above each link, divided by the whole weight, shape (2,).", heading="tension"
    )
    half_waves: Field[int] = Field("Sign changes of the offsets, plus one.", fact=True)

    @property
    def _waves(self) -> str:
        return f"{self.half_waves} half wave{'s' * (self.half_waves != 1)}"


class SwungLink(NamedTuple):
    """A link that circles below a pin on the axis; angles in rad.

    `inclination`: of the link to the vertical. `reaction`: force at the pin divided by the weight.
    `reaction_inclination`: of that force to the vertical. `condition`: relative change of `inclination` divided by the
    relative change of the data.

    Examples
    --------
    >>> import revchain as rc
    >>> swing = rc.two_links.swung_link(2.0, 1.0, height=1.25)
    >>> round(float(swing.reaction_inclination), 6), round(float(swing.condition), 3)
    (0.945663, 1.103)
    """

    inclination: FloatOrArray
    reaction: FloatOrArray
    reaction_inclination: FloatOrArray
    condition: FloatOrArray


def _shapes(found: Sequence[Any]) -> list[PairShape]:
    return [PairShape._made(each) for each in found]


def _only_shape(found: Any) -> PairShape | None:
    return None if found is None else PairShape._made(found)


@closed_form(_core.two_plummets, "3 ulp", "section 2 (5)")
def two_plummets(
    *, lower_weight: ArrayLike, lower_thread: ArrayLike, upper_weight: ArrayLike, upper_thread: ArrayLike
) -> Floats:
    """Return both conical heights of the double pendulum: two plummets, one hung from the other.

    returns: The larger (slower) first: Lagrange's ``(x - l1)(x - l2) = W1 l1 l2 / (W1 + W2)``.

    >>> rc.two_links.two_plummets(lower_weight=1, lower_thread=1, upper_weight=3, upper_thread=1)
    array([1.5, 0.5])
    """


@closed_form(_core.two_plummets_from_the_middle, "4 ulp", "section 2 (6)")
def two_plummets_from_the_middle(half_length: ArrayLike, x: ArrayLike, weight_ratio: ArrayLike) -> Floats:
    """Return both conical heights of two plummets, given the position of the upper one on the thread.

    x: Distance of the upper plummet from the middle, on either side, less than `half_length`
    weight_ratio: Lower weight divided by upper weight, greater than -1; negative for a body that floats in a fluid that
        turns with it (Stokes's float).
    returns: The larger (slower) first.
    raises: If ``abs(x) < half_length * sqrt(-weight_ratio)``: the heights of a float are then complex.

    >>> rc.two_links.two_plummets_from_the_middle(1.0, 0.5, weight_ratio=0.5).round(6)
    array([1.707107, 0.292893])
    """


@closed_form(_core.pendulum_length, "1.5 ulp", "section 6 (6)")
def pendulum_length(centroid: ArrayLike, radius_of_gyration: ArrayLike) -> FloatOrArray:
    """Return the length of the simple pendulum with the period of a link.

    returns: ``centroid + radius_of_gyration**2 / centroid``, the distance of the centre of oscillation.

    >>> float(rc.two_links.pendulum_length(2.0, 1.0))
    2.5
    """


@closed_form(_core.share_at_centre_of_oscillation, "2 ulp", "section 6")
def share_at_centre_of_oscillation(centroid: ArrayLike, radius_of_gyration: ArrayLike) -> FloatOrArray:
    """Return the part of the weight of a link at its centre of oscillation, ``centroid / pendulum_length``.

    >>> float(rc.two_links.share_at_centre_of_oscillation(2.0, 1.0))
    0.8
    """


@closed_form(
    _core.swung_link,
    "4 ulp for the data as given (`condition`: 1e-13), also where `height` is close to ``l``",
    "section 6 (1), (2)",
)
def swung_link(centroid: ArrayLike, radius_of_gyration: ArrayLike, height: ArrayLike) -> SwungLink:
    """Return the steady motion of a link below a pin on the axis (the compound conical pendulum).

    returns: The link is vertical unless `height` is less than its pendulum length ``l``.
    notes: A relative error of the data changes the inclination ``d`` by up to `SwungLink.condition` times as much:
        ``cot(d) / d * (1 + (abs(h - b) + 2 b) / l)`` with ``h`` the centroid and ``b = radius_of_gyration**2 / h``.

    >>> swing = rc.two_links.swung_link(2.0, 1.0, height=1.25)
    >>> round(float(swing.inclination), 6), round(float(swing.reaction), 6)
    (1.047198, 1.708801)
    """


@closed_form(_core.link_on_thread, "4 ulp", "section 6 (11)")
def link_on_thread(thread: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> Floats:
    """Return both conical heights of a link on a thread (a boat on its davits) or on a support that yields.

    thread: Length of the thread, positive. For a support that yields sideways it is the deflection under the weight,
        see `spring_deflection`.
    returns: The larger (slower) first; the second is 0 for a plummet: ``(x - l)(x - thread) = thread * centroid``.

    >>> rc.two_links.link_on_thread(2.0, centroid=1.0, radius_of_gyration=1.0).round(6)
    array([3.414214, 0.585786])
    """


@closed_form(_core.standing_link, "5 ulp", "section 6 (12)")
def standing_link(thread: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> FloatOrArray:
    """Return the conical height of an inverted link that stands on the end of a thread or on a moving hand.

    thread: Length of the thread, or of one whose end moves as the hand does
    centroid: Distance of the centre of gravity of the link above its lowest point
    returns: ``x`` in ``(l + x)(thread - x) = thread * centroid``; 0 if there is no such motion.

    A broomstick of 1.2 m on a hand that moves like the end of a thread of 1 m:

    >>> round(float(rc.two_links.standing_link(1.0, centroid=0.6, radius_of_gyration=0.6 / 3**0.5)), 6)
    0.558258
    """


@closed_form(_core.thread_of_standing_link, "3 ulp", "section 6 (13)")
def thread_of_standing_link(height: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> FloatOrArray:
    """Return the length of the thread on which a link stands at a conical height, the inverse of `standing_link`.

    centroid: Distance of the centre of gravity of the link above its lowest point

    >>> round(float(rc.two_links.thread_of_standing_link(1.0, centroid=0.75, radius_of_gyration=0.75 / 3**0.5)), 6)
    1.6
    """


@closed_form(_core.standing_plummet, "4 ulp", "section 2 (8)")
def standing_plummet(
    *, standing_weight: ArrayLike, rod: ArrayLike, hung_weight: ArrayLike, thread: ArrayLike
) -> FloatOrArray:
    """Return the conical height of an inverted plummet that stands above a hanging one on a rigid massless rod.

    >>> round(float(rc.two_links.standing_plummet(standing_weight=1, rod=1, hung_weight=3, thread=2)), 6)
    1.822876
    """


@closed_form(_core.spring_deflection, "0.5 ulp", "section 2 (7)")
def spring_deflection(weight: ArrayLike, stiffness: ArrayLike) -> FloatOrArray:
    """Return the deflection of a spring under a weight, ``weight / stiffness``.

    >>> float(rc.two_links.spring_deflection(10.0, 400.0))
    0.025
    """


@closed_form(
    _core.seconds_lost_per_day, "8 ulp for the data as given, also for small losses", "section 2, text after (7)"
)
def seconds_lost_per_day(deflection: ArrayLike, centroid: ArrayLike, radius_of_gyration: ArrayLike) -> FloatOrArray:
    """Return the seconds that a pendulum clock on a yielding support loses in a day.

    notes: A relative error of the data changes the result by up to ``3 + 2 sqrt(l / centroid)`` times as much, with
        ``l`` the pendulum length.

    A seconds pendulum on a bracket that yields by a thousandth of a millimetre:

    >>> round(float(rc.two_links.seconds_lost_per_day(1e-6, centroid=0.994, radius_of_gyration=0.0)), 4)
    0.0435
    """


@closed_form(
    _core.two_plummets_shapes,
    "inclinations 4 ulp for the data as given, also close to a fold and to the vertical",
    "section 2 (4)",
    cost="10 microseconds for each shape",
    made=_shapes,
)
def two_plummets_shapes(
    *, lower_weight: float, lower_thread: float, upper_weight: float, upper_thread: float, height: float
) -> list[PairShape]:
    """Return all hanging steady shapes of two plummets at a speed, at any inclination.

    returns: All shapes, ordered by half waves, then by the inclination of the lower thread; of two mirror images the
        one with the lower plummet at a positive offset. The list is proved complete.
    raises: If a length divided by `height` exceeds 1.1e102.
    notes: Near the vertical a relative error of the data changes the tangents by up to about ``2 x / (x - height)``
        times as much, where the shape leaves the vertical at the height `x`. Where two shapes meet, an error e of the data
        changes them by about sqrt(e).

    >>> pair = dict(lower_weight=1, lower_thread=2, upper_weight=3, upper_thread=1)
    >>> for shape in rc.two_links.two_plummets_shapes(**pair, height=1 / 64):
    ...     print(shape.half_waves, shape.inclination.round(3))
    1 [1.566 1.56 ]
    2 [ 0.529 -1.55 ]
    2 [ 1.555 -1.54 ]
    2 [ 1.56  -0.534]
    """


@closed_form(
    _core.link_on_thread_shapes, "that of `two_plummets_shapes`", "section 6 (10)",
    cost="O(1)", made=_shapes,
)
def link_on_thread_shapes(thread: float, centroid: float, radius_of_gyration: float, height: float) -> list[PairShape]:
    """Return all hanging steady shapes of a link on a thread at a speed, at any inclination.

    returns: All shapes, in the order of `two_plummets_shapes`.

    >>> len(rc.two_links.link_on_thread_shapes(2.0, centroid=1.0, radius_of_gyration=1.0, height=0.5))
    2
    """


@closed_form(
    _core.standing_plummet_shape, "that of `two_plummets_shapes`", "section 2 (8)",
    cost="O(1)", made=_only_shape,
)
def standing_plummet_shape(
    *, standing_weight: float, rod: float, hung_weight: float, thread: float, height: float
) -> PairShape | None:
    """Return the steady shape in which a plummet stands above a hanging one, at any inclination.

    returns: The shape; None unless `height` is less than `standing_plummet`. The first inclination is that of the rod to
        the upward vertical; the first tension is negative, the thrust in the rod.

    >>> pair = dict(standing_weight=1, rod=1, hung_weight=3, thread=2)
    >>> rc.two_links.standing_plummet_shape(**pair, height=0.9).inclination.round(4)
    array([0.8321, 1.0427])
    >>> rc.two_links.standing_plummet_shape(**pair, height=1.9) is None
    True
    """


@closed_form(
    _core.standing_link_shape, "that of `two_plummets_shapes`", "section 6 (12), with the secants of (10)",
    cost="O(1)", made=_only_shape,
)
def standing_link_shape(thread: float, centroid: float, radius_of_gyration: float, height: float) -> PairShape | None:
    """Return the steady shape in which a link stands on its lowest point, at any inclination.

    thread: Length of the thread, or of one whose end moves as the hand does
    centroid: Distance of the centre of gravity of the link above its lowest point
    returns: The shape; None unless `height` is less than `standing_link`. The first inclination is that of the link to
        the upward vertical; both tensions are that of the thread or hand.

    >>> rc.two_links.standing_link_shape(1.0, centroid=0.6, radius_of_gyration=0.35, height=0.5).half_waves
    1
    """


@closed_form(_core.jointed_links, "3 ulp", "section 8 (14), or (15) if l2 = a2")
def jointed_links(
    *, lower_weight: ArrayLike, lower_centroid: ArrayLike, lower_radius_of_gyration: ArrayLike,
    upper_weight: ArrayLike, upper_length: ArrayLike, upper_centroid: ArrayLike, upper_radius_of_gyration: ArrayLike,
) -> Floats:
    """Return both conical heights of two jointed links, such as a bell and its clapper.

    upper_centroid: Distance of the centre of gravity of the upper link below the support; may be negative.
    returns: The larger (slower) first: ``a2 h1 / (x - l1) = (m + 1)(x - l2) + l2 - a2``, ``m = W2 h2 / (W1 a2)``.
    raises: If the upper link would stand.

    >>> clapper = dict(lower_weight=1.0, lower_centroid=0.75, lower_radius_of_gyration=0.1875**0.5)
    >>> bell = dict(upper_weight=1.0, upper_length=0.25, upper_centroid=0.125, upper_radius_of_gyration=0.203125**0.5)
    >>> rc.two_links.jointed_links(**clapper, **bell).round(6)
    array([1.25, 0.5 ])
    """


@closed_form(
    _core.jointed_links_shapes,
    "inclinations 8 ulp where no two shapes meet, tensions 4 ulp of the sizes of their terms", "section 8 (14) with its secants",
    cost="O(1)", made=_shapes,
)
def jointed_links_shapes(
    *, lower_weight: float, lower_centroid: float, lower_radius_of_gyration: float, upper_weight: float,
    upper_length: float, upper_centroid: float, upper_radius_of_gyration: float, height: float,
) -> list[PairShape]:
    """Return all hanging steady shapes of two jointed links at a speed, at any inclination.

    returns: All shapes, ordered by half waves, then by the inclination of the lower link. Tensions are the sizes of the
        reactions at the upper pins.

    >>> clapper = dict(lower_weight=1.0, lower_centroid=0.75, lower_radius_of_gyration=0.1875**0.5)
    >>> bell = dict(upper_weight=1.0, upper_length=0.25, upper_centroid=0.125, upper_radius_of_gyration=0.203125**0.5)
    >>> rc.two_links.jointed_links_shapes(**clapper, **bell, height=1.0)[0].inclination.round(6)
    array([0.643501, 0.643501])
    """


@closed_form(_core.pin_of_silent_clapper, "4 ulp for the data as given", "section 8 (16), solved for a2")
def pin_of_silent_clapper(
    *, bell_weight: ArrayLike, bell_centroid: ArrayLike, bell_radius_of_gyration: ArrayLike,
    clapper_weight: ArrayLike, clapper_centroid: ArrayLike, clapper_radius_of_gyration: ArrayLike,
) -> FloatOrArray:
    """Return the distance of the pin of the clapper below the support of the bell at which the bell is silent.

    returns: The distance ``a2`` at which both swing or whirl in one line: ``h1 = (m + 1) l1 + m (a2 - l2)``. The conical
        height of that motion is the distance plus the `pendulum_length` of the clapper.
    raises: If the pendulum length of the clapper is not less than that of the bell.
    notes: A relative error of the data changes the result by up to ``3 (l1 + l2) / (l2 - l1) + 6`` times as much,
        with l1 and l2 the pendulum lengths of clapper and bell.

    >>> bell = dict(bell_weight=1.0, bell_centroid=0.125, bell_radius_of_gyration=0.203125**0.5)
    >>> clapper = dict(clapper_weight=1.0, clapper_centroid=0.75, clapper_radius_of_gyration=0.1875**0.5)
    >>> round(float(rc.two_links.pin_of_silent_clapper(**bell, **clapper)), 12)
    0.25
    """


@closed_form(_core.joint_without_bending, "2.5 ulp for pins up to 0.49 of the length", "section 8 (17)")
def joint_without_bending(length: ArrayLike, pin: ArrayLike) -> FloatOrArray:
    """Return the distance of a joint below the pin of a hanging uniform rod at which the rod still swings straight.

    It follows from CG.CD = CA^2, with C the pin, G the middle, D the joint, A the upper end.

    length: Length of the rod
    pin: Distance of the pin from the middle of the rod: more than a sixth of the length, less than half.

    >>> float(rc.two_links.joint_without_bending(2.0, 0.5))
    0.5
    """
