# SPDX-License-Identifier: GPL-3.0-or-later
"""A prescribed motion of the support in time, or a force on it."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .numbers import Floats, boolean, floats, read_only, refuse_where, shown
from .rig import _Fitting

KINDS = ("velocity", "acceleration", "offset", "force")
_CALLER = "revchain.SupportMotion"


class SupportMotion(_Fitting):
    """A motion of the support in time (a trolley that brakes, a ship that rolls, a shaker), or a force on it.

    Give the times and one of the next four. Velocities, accelerations and forces are joined by straight lines, offsets by
    a cubic spline. Before the first time and after the last there is no acceleration (or force); a support that still
    moves goes on at its velocity.

    Parameters
    ----------
    time : array_like, shape (K,)
        Times in s, not negative, ascending; at least two. Two equal times are a jump of acceleration or force.
    velocity : array_like, shape (K,), optional
        Velocities of the support, m/s. It is at 0 at the first time.
    acceleration : array_like, shape (K,), optional
        Accelerations of the support, m/s^2. It is at rest at 0 at the first time.
    offset : array_like, shape (K,), optional
        Offsets of the support, m.
    force : array_like, shape (K,), optional
        Forces on a support that yields, N, or in the unit of the weights.
    rests : bool
        With offsets: whether the support is at rest before the first time and after the last. If not, it goes on with the
        velocities of the spline at its ends.

    Raises
    ------
    ValueError
        If a number is out of its range, times do not ascend, or the arguments do not go together.
    TypeError
        If `rests` is not a bool.

    Notes
    -----
    A support with a spring is moved at the far end of the spring, any other is moved itself. Source: C. de Boor, A
    Practical Guide to Splines (1978), chapter IV: complete and not-a-knot splines.

    Examples
    --------
    >>> import revchain as rc
    >>> braking = rc.SupportMotion(time=[0.0, 1.5], velocity=[0.8, 0.0])
    >>> crane = rc.Chain(mass=1.0, length=2.0)
    >>> found = rc.swing(crane, [1.5, 3.0], support=braking, gravity=9.81)
    >>> found.offset.round(4)
    array([[0.8157, 0.6   ],
           [0.3913, 0.6   ]])
    >>> round(found.residual_sway, 4)
    0.2166
    """

    __slots__ = ()

    def __init__(
        self,
        time: ArrayLike,
        *,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
        offset: ArrayLike | None = None,
        force: ArrayLike | None = None,
        rests: bool = True,
    ) -> None:
        named = dict(zip(KINDS, (velocity, acceleration, offset, force), strict=True))
        given = {name: value for name, value in named.items() if value is not None}
        if len(given) != 1:
            raise ValueError(f"{_CALLER}: give one of {', '.join(KINDS)}, got {' and '.join(given) or 'none'}")
        (kind,) = given
        times, values = (_listed(name, value) for name, value in (("time", time), (kind, given[kind])))
        if times.size < 2 or times.size != values.size:
            raise ValueError(
                f"{_CALLER}: time and {kind} must be lists of one length, at least 2, got {times.size} and {values.size}"
            )
        refuse_where(times < 0, times, f"{_CALLER}: time must not be negative")
        back = np.diff(times) < 0
        refuse_where(np.append(False, back), times, f"{_CALLER}: time must ascend")
        if kind in ("velocity", "offset"):
            same = np.append(False, np.diff(times) == 0)
            refuse_where(same, times, f"{_CALLER}: times must differ, for a support cannot jump, nor its {kind}; time")
        made: dict[str, Any] = {"time": read_only(times), kind: read_only(values)}
        if not boolean(_CALLER, "rests", rests):
            if kind != "offset":
                raise ValueError(f"{_CALLER}: rests=False goes with offsets, got {kind}")
            made["rests"] = False
        object.__setattr__(self, "_given", made)

    @property
    def _what(self) -> str:
        """The quantity given: "velocity", "acceleration", "offset" or "force"."""
        return next(name for name in KINDS if name in self._given)


def _listed(name: str, value: ArrayLike) -> Floats:
    column = floats(_CALLER, name, value)
    if column.ndim != 1:
        raise ValueError(f"{_CALLER}: {name} must be a list of numbers, got {shown(value)}")
    refuse_where(~np.isfinite(column), column, f"{_CALLER}: {name} must be finite")
    return column
