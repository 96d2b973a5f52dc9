# SPDX-License-Identifier: GPL-3.0-or-later
# mypy: disable-error-code="empty-body"
# The decorator of table.py gives each function its body, a call of the compiled formula, and completes its docstring.
"""One point mass (the paper's plummet) on threads.

Tensions are divided by the weight; angles are in radians. Source: Greenhill (1908), section 1; numbers in brackets are
its equations.
"""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import Floats, numbers
from .table import FloatOrArray, closed_form

__all__ = [
    "HeldPlummet", "InclinedPendulum", "air_resistance", "carried_inclinations", "carried_response", "held_plummet",
    "inclined_pendulum", "whirling_thread",
]


class InclinedPendulum(NamedTuple):
    """A circling point mass: inclination to the vertical (0 to pi/2), radius, depth below the support, tension.

    Examples
    --------
    >>> import revchain as rc
    >>> float(rc.plummet.inclined_pendulum(length=2.0, height=1.0).depth)
    1.0
    """

    inclination: FloatOrArray
    radius: FloatOrArray
    depth: FloatOrArray
    tension: FloatOrArray


class HeldPlummet(NamedTuple):
    """A point mass on two threads tied to the axis: radius, depth below the upper tie, tensions, and which are taut.

    A slack thread has tension 0.

    Examples
    --------
    >>> import revchain as rc
    >>> held = rc.plummet.held_plummet(1.0, 1.0, distance=1.2, height=0.3)
    >>> round(float(held.depth), 6), round(float(held.upper_tension), 6), round(float(held.lower_tension), 6)
    (0.6, 2.5, 0.833333)
    """

    radius: FloatOrArray
    depth: FloatOrArray
    upper_tension: FloatOrArray
    lower_tension: FloatOrArray
    upper_taut: np.bool_ | np.ndarray[Any, np.dtype[np.bool_]]
    lower_taut: np.bool_ | np.ndarray[Any, np.dtype[np.bool_]]


def _held(found: tuple[Floats, ...]) -> HeldPlummet:
    radius, depth, upper, lower = numbers(found)
    return HeldPlummet(radius, depth, upper, lower, np.greater(upper, 0), np.greater(lower, 0))


def _inclinations(padded: tuple[Floats, ...]) -> Floats | list[Floats]:
    rows = np.stack(padded, axis=-1)
    found = [row[~np.isnan(row)] for row in rows.reshape(-1, 3)]
    return found if rows.ndim > 1 else found[0]


@closed_form(_core.inclined_pendulum, "3 ulp", "section 1 (1)")
def inclined_pendulum(length: ArrayLike, height: ArrayLike) -> InclinedPendulum:
    """Return the steady motion of a point mass on a thread at a given speed.

    returns: If `height` is less than `length`, the thread is inclined and `height` is the depth; else the thread hangs
        vertically.

    >>> swing = rc.plummet.inclined_pendulum(length=2.0, height=1.0)
    >>> round(float(swing.inclination), 6), float(swing.tension)
    (1.047198, 2.0)
    """


@closed_form(
    _core.held_plummet,
    "3 ulp; a depth or a tension that nearly vanishes is within 1e-29 of the larger of the two terms that it is the "
    "difference of",
    "section 1, polygon of forces",
    made=_held,
)
def held_plummet(
    upper_thread: ArrayLike, lower_thread: ArrayLike, distance: ArrayLike, height: ArrayLike
) -> HeldPlummet:
    """Return the steady motion of a point mass on two threads tied to the axis.

    returns: With D the depth at which both threads are straight, the lower thread is slack if ``height >= D``, and the
        upper one if ``height <= D - distance``.
    raises: If the three lengths do not form a triangle.

    >>> held = rc.plummet.held_plummet(1.0, 1.0, distance=1.2, height=0.3)
    >>> round(float(held.radius), 6), bool(held.lower_taut)
    (0.8, True)
    >>> slow = rc.plummet.held_plummet(1.0, 1.0, distance=1.2, height=0.8)  # the lower thread hangs in a bow
    >>> round(float(slow.radius), 6), float(slow.upper_tension), bool(slow.lower_taut)
    (0.6, 1.25, False)
    """


@closed_form(_core.air_resistance, "0.5 ulp", "section 1 (8)")
def air_resistance(arm: ArrayLike, height: ArrayLike) -> FloatOrArray:
    """Return the air resistance of a mass on a whirling machine divided by its weight, ``arm / height``.

    >>> float(rc.plummet.air_resistance(arm=0.1, height=0.5))
    0.2
    """


@closed_form(_core.whirling_thread, "2 ulp", "section 1, text after (8)")
def whirling_thread(arm: ArrayLike, height: ArrayLike, radius: ArrayLike) -> FloatOrArray:
    """Return the thread of a whirling machine whose arm is perpendicular to the plane of axis and mass.

    radius: Radius of the circle of the mass
    returns: ``sqrt(arm**2 + height**2 + radius**2)``.

    >>> float(rc.plummet.whirling_thread(arm=1.0, height=2.0, radius=2.0))
    3.0
    """


@closed_form(_core.carried_response, "1.1 ulp", "section 1 (9)")
def carried_response(length: ArrayLike, height: ArrayLike) -> FloatOrArray:
    """Return the offset of a point mass divided by that of its moving support (base excitation).

    The support moves in a circle or to and fro; `height` is the conical height of that motion.

    returns: ``height / (height - length)`` for small inclinations: infinite at resonance, negative (in antiphase) above.

    >>> rc.plummet.carried_response(1.0, [3.0, 1.5, 0.5])
    array([ 1.5,  3. , -1. ])
    """


@closed_form(
    _core.carried_inclinations,
    "4 ulp; where two roots nearly meet, times ``1 / |1 - (cos at which two meet / cos of the root)**3|``",
    "section 1",
    made=_inclinations,
)
def carried_inclinations(length: ArrayLike, height: ArrayLike, radius: ArrayLike) -> Floats | list[Floats]:
    """Return all steady inclinations of a point mass whose support is carried round a circle.

    radius: Radius of the circle of the support
    returns: For numbers an array; for arrays a list with one array for each element of the broadcast shape, in C order.
        The inclinations are the roots of ``height tan d = radius + length sin d``, rad, ascending from -pi/2 to pi/2,
        outwards positive. There is one, or three if ``radius**(2/3) < length**(2/3) - height**(2/3)``.

    >>> rc.plummet.carried_inclinations(1.0, height=0.25, radius=0.1).round(4)
    array([-1.288 , -0.1341,  1.3421])
    """
