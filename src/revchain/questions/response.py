# SPDX-License-Identifier: GPL-3.0-or-later
"""A chain whose support is carried round, and a chain swinging by itself: small amplitudes."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..results.base import Record
from ..systems.chain import Chain, compiled
from ..systems.numbers import (
    STANDARD_GRAVITY,
    Floats,
    Whole,
    array_of,
    boolean,
    floats,
    integer,
    limit,
    positive,
    real,
    refuse_where,
    shown,
)
from ..systems.rig import Rig
from .modes import count_modes, modes

if TYPE_CHECKING:
    from matplotlib.axes import Axes

Flags = NDArray[np.bool_]


MOST_RESONANCES = 60  # marked in a plot: more would blacken it


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class Response(Record):
    """What a chain does whose support is carried round a circle, at one speed or many; returned by `response`.

    Arrays have the shape of the speeds asked, ``(...)``, those of pins one axis more. Carried to and fro
    along a line instead, the numbers are the same as amplitudes, everything in phase or against.

    Attributes
    ----------
    chain : Chain or Rig
        What was asked.
    conical_height : ndarray, shape (...)
        Of the speeds: ``gravity / angular_speed**2``.
    angular_speed : ndarray, shape (...)
        In rad/s.
    support_radius : float
        Of the circle.
    pins : ndarray of int64, shape (P,)
        Which pins, from 0 for the free end; of shape () where one was asked for by its number, and `offset` then
        has no axis for it.
    offset : ndarray, shape (..., P)
        Of the pins from the axis, positive on the side on which the support is. NaN at a resonance.
    error_bound : ndarray, shape (...)
        Proved bound of the error of every offset of the chain, over the largest of them: half an ulp but next
        to a resonance, infinite at one.
    modes_below : ndarray of int64, shape (...)
        How many whirl speeds of the chain, with its support held, the speed has passed. A resonance that
        the speed cannot be told from is not counted.
    reversed : ndarray of bool, shape (...)
        Whether the free end is on the side opposite to the support.
    resonant : ndarray of bool, shape (...)
        Whether the speed cannot be told from a resonance.
    support_force : ndarray, shape (...)
        Horizontal pull of the chain on what carries its support, outwards, in the unit of the weights.
    support_force_error : ndarray, shape (...)
        Proved bound of its error, in the same unit.

    Examples
    --------
    >>> import revchain as rc
    >>> found = rc.response(rc.Chain(weight=[1.0, 3.0], length=1.0), conical_height=[3.0, 1.0, 0.1])
    >>> found.offset
    array([[ 2.4       ,  1.6       ,  1.        ],
           [-4.        ,  0.        ,  1.        ],
           [ 0.01785714, -0.16071429,  1.        ]])
    >>> found.modes_below
    array([0, 1, 2])
    """

    chain: Chain | Rig
    conical_height: Floats
    angular_speed: Floats
    support_radius: float
    pins: Whole
    offset: Floats
    error_bound: Floats
    modes_below: Whole
    reversed: Flags
    resonant: Flags
    support_force: Floats
    support_force_error: Floats

    @property
    def amplification(self) -> Floats:
        """Offsets over the radius of the support's circle, shape (..., P)."""
        return self.offset / self.support_radius

    def plot(self, ax: Axes | None = None, pins: Iterable[int] | None = None, *, resonances: bool = True) -> Axes:
        """Draw how far chosen pins are from the axis against the speed, the largest scale logarithmic.

        Dashed where a pin is on the side opposite to the support; vertical lines mark the resonances.
        A response at one speed is drawn as a shape: the offsets of the pins against their depths.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        pins : iterable of int, optional
            Which pins of this result. If left out: the lowest and up to three others, evenly spaced; at one
            speed all.
        resonances : bool
            Whether to mark the whirl speeds in the range of the plot; never done for a `Rig`.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If `pins` names one that is not in this result, or the result has no speed.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import numpy as np
        >>> import revchain as rc
        >>> chain = rc.Chain.uniform_rods(20, length=0.36)
        >>> ax = rc.response(chain, angular_speed=np.linspace(1.0, 30.0, 400)).plot()
        >>> ax.get_xlabel()
        'angular speed (rad/s)'
        """
        from ..plots.response import plot_response

        marked = boolean("Response.plot", "resonances", resonances) and isinstance(self.chain, Chain)
        return plot_response(self, ax, pins, _resonances(self) if marked else [])

    def __repr__(self) -> str:
        speeds = "1 speed" if self.error_bound.size == 1 else f"{self.error_bound.size:,} speeds"
        return f"Response at {speeds}: {self.pins.size:,} pins, {np.count_nonzero(self.resonant):,} at a resonance"


def response(
    chain: Chain | Rig,
    *,
    conical_height: ArrayLike | None = None,
    angular_speed: ArrayLike | None = None,
    gravity: float = STANDARD_GRAVITY,
    support_radius: float | None = None,
    pins: ArrayLike | None = None,
) -> Response:
    """Find the steady motion of a chain whose support is carried round a small circle, or to and fro.

    Parameters
    ----------
    chain : Chain or Rig
        The chain of N links, or one rigged with a spring at its support (the spring's place of rest is then
        carried round), flywheels, standing links, a fluid.
    conical_height : array_like, optional
        Heights ``gravity / angular_speed**2``, in the unit of the chain's lengths, of any shape.
    angular_speed : array_like, optional
        Instead: speeds in rad/s, positive; negative, too, of a rig whose flywheels tell one sense
        from the other.
    gravity : float, optional
        For `angular_speed`, and for flywheels; standard gravity, in metres, if left out.
    support_radius : float, optional
        Radius of the circle, or amplitude to and fro, positive. Left out: the rig's own, or 1 where it
        has none: offsets are then over those of the support.
    pins : int or array_like of int, optional
        Only these pins, 0 the free end, N (or -1) the support; all N + 1 if left out. Long sweeps of
        long chains need less memory.

    Returns
    -------
    Response
        Proved `error_bound` and counts. At a resonance, or nearer to one than 30 digits can tell, offsets
        are NaN and `resonant` says so.

    Raises
    ------
    TypeError
        If `chain` is neither a Chain nor a Rig.
    ValueError
        If not exactly one of `conical_height` and `angular_speed` is given, for numbers that are not positive
        and finite or out of all proportion to the chain (1e75), and for pins there are not.

    Notes
    -----
    ``K y = M y / conical_height`` with the support's offset given; of small amplitude, as everything in
    this theory: where offsets are no longer small beside the links, multiply by a smaller radius.
    A chain slower than its first whirl speed goes out with its support. Past each whirl speed its motion is turned
    round; between two there is a speed at which a pin stays on the axis.
    Lowest links that weigh nothing in a fluid that turns with them hang along with the link above.

    Method: dynamic stiffness carried up in words of two doubles, several speeds to a pass, with a running bound.
    Accuracy: half an ulp of each offset until the speed is within 1e-12 or so of a resonance. Cost: about
    0.03 microseconds for each link and speed. Other Python threads run on meanwhile.

    References
    ----------
    Greenhill (1908), section 1 (9): one plummet, ``support_radius * height / (height - length)``.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.response(rc.Chain(weight=1.0, length=1.0), conical_height=[4.0, 0.5]).offset[:, 0]
    array([ 1.33333333, -1.        ])
    >>> hand = rc.response(rc.Chain.uniform_rods(120, length=0.36), angular_speed=6.0, support_radius=0.01, pins=0)
    >>> round(float(hand.offset), 4), int(hand.modes_below)
    (0.1786, 0)
    """
    place = "revchain.response"
    either_sense, own = False, 1.0
    if isinstance(chain, Rig):
        either_sense, own = bool(np.any(chain.momentum)), chain.support_radius or 1.0
    elif not isinstance(chain, Chain):
        raise TypeError(f"{place}: chain must be a revchain.Chain or a revchain.Rig, got {shown(chain)}")
    if (conical_height is None) == (angular_speed is None):
        raise ValueError(f"{place}: give either conical_height or angular_speed")
    g = float(positive(place, "gravity", real(place, "gravity", gravity)))
    radius = own
    if support_radius is not None:
        radius = float(positive(place, "support_radius", real(place, "support_radius", support_radius)))
    if angular_speed is None:
        assert conical_height is not None
        given = positive(place, "conical_height", conical_height)
        height, speed = given, np.asarray(_core.conical_pendulum_angular_speed(given, np.full(given.shape, g)))
    else:
        given = floats(place, "angular_speed", angular_speed)
        if either_sense:
            wrong = ~((given != 0) & np.isfinite(given))
            refuse_where(wrong, given, f"{place}: angular_speed must be finite and not 0")
        else:
            positive(place, "angular_speed", given)
        height, speed = np.asarray(_core.conical_pendulum_height(np.abs(given), np.full(given.shape, g))), given
    which, axis = _pins(place, pins, chain.size)
    asked = (given.reshape(-1), angular_speed is not None, radius, which.reshape(-1), g)
    if isinstance(chain, Rig):
        found = _core.rig_response(chain._compiled, *asked)
    else:
        found = _core.response(compiled(place, chain), *asked)
    offset, bound, below, against, resonant, force, force_error = found
    shape = given.shape
    return Response(
        chain,
        height,
        speed,
        radius,
        which,
        offset.reshape(shape + axis),
        bound.reshape(shape),
        below.reshape(shape),
        against.reshape(shape),
        resonant.reshape(shape),
        force.reshape(shape),
        force_error.reshape(shape),
    )


def _pins(place: str, pins: ArrayLike | None, size: int) -> tuple[Whole, tuple[int, ...]]:
    """Numbers of the pins asked for, and the axis they make."""
    if pins is None:
        return np.arange(size + 1), (size + 1,)
    asked = array_of(pins)
    if asked.dtype.kind not in "iu" and asked.size:
        raise ValueError(f"{place}: pins must be whole numbers, got {shown(pins)}")
    if asked.ndim > 1:
        raise ValueError(f"{place}: pins must be one number or a list of them, got an array of shape {asked.shape}")
    asked = asked.astype(np.int64)
    wrong = (asked < -(size + 1)) | (asked > size)
    if wrong.any():
        raise ValueError(f"{place}: pins must be numbers from 0 to {size}, got {asked[wrong].flat[0]}")
    return np.where(asked < 0, asked + size + 1, asked), asked.shape


@dataclass(frozen=True, slots=True, eq=False, repr=False)
class SmallOscillation(Record):
    """A hanging chain swinging in a plane, as the sum of its modes; returned by `small_oscillation`.

    Attributes
    ----------
    chain : Chain
        The chain of N links.
    time : ndarray, shape (T,)
        Times asked, in s.
    offset, velocity : ndarray, shape (T, N + 1)
        Of the pins, free end first, the support's 0 last. Sums of the k modes kept.
    angular_frequency : ndarray, shape (k,)
        Of each mode, ``sqrt(gravity / conical_height)``, ascending: the whirl speeds of `modes`.
    energy : ndarray, shape (k,)
        Of each mode, in weight times length; no mode gives any to another.
    shape : ndarray, shape (k, N + 1)
        Of each mode, the largest offset 1.
    cosine, sine : ndarray, shape (k,)
        Offsets are the sum of ``shape * (cosine * cos(angular_frequency t) + sine * sin(...))``.
    start : ndarray, shape (N + 1,)
        Offsets from which the chain starts: those given, but that pins without inertia are where the
        pull of their neighbours has them at once.
    projected : bool
        Whether that is elsewhere than given.
    energy_left_out : float
        Of all that the start has beside the modes kept; an upper bound.
    truncation_error : ndarray, shape (N + 1,)
        Proved bound of what that may do to each offset, at any time.
    error_bound : ndarray, shape (T,)
        Proved bound of the error of every offset as a sum of the modes kept: rounding. It grows with time
        only after some 1e9 swings.

    Examples
    --------
    >>> import revchain as rc
    >>> swing = rc.small_oscillation(rc.Chain(weight=1.0, length=9.80665), [0.1, 0.0], None, [0.0, 3.0])
    >>> swing.offset.round(4)
    array([[ 0.1  ,  0.   ],
           [-0.099,  0.   ]])
    """

    chain: Chain
    time: Floats
    offset: Floats
    velocity: Floats
    angular_frequency: Floats
    energy: Floats
    shape: Floats
    cosine: Floats
    sine: Floats
    start: Floats
    projected: bool
    energy_left_out: float
    truncation_error: Floats
    error_bound: Floats

    def plot(
        self, ax: Axes | None = None, *, kind: str = "shapes", pins: Iterable[int] = (0,), length_unit: str = "m"
    ) -> Axes:
        """Draw the chain at the times asked, or offsets of pins against time.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.
        kind : {"shapes", "time"}
            Shapes from dark (early) to light, offsets stretched; or offsets against time.
        pins : iterable of int
            For ``"time"``: which pins, 0 the free end.
        length_unit : str
            What to write on the axes.

        Returns
        -------
        matplotlib.axes.Axes

        Raises
        ------
        ValueError
            If `kind` is neither, or for pins there are not.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import numpy as np
        >>> import revchain as rc
        >>> chain = rc.Chain.uniform_plummets(10, length=1.0)
        >>> plucked = np.interp(np.arange(11), [0, 5, 10], [0.0, 0.05, 0.0])
        >>> ax = rc.small_oscillation(chain, plucked, None, np.linspace(0, 4, 300)).plot(kind="time", pins=[0, 5])
        >>> ax.get_xlabel()
        'time (s)'
        """
        from ..plots.response import plot_small_oscillation

        return plot_small_oscillation(self, ax, kind, pins, length_unit=length_unit)

    def __repr__(self) -> str:
        times = "1 time" if self.time.size == 1 else f"{self.time.size:,} times"
        return f"SmallOscillation at {times}: {self.energy.size:,} of {self.chain.mode_count:,} modes"


def small_oscillation(
    chain: Chain,
    offsets: ArrayLike,
    velocities: ArrayLike | None,
    t: ArrayLike,
    *,
    modes: int | None = None,
    gravity: float = STANDARD_GRAVITY,
) -> SmallOscillation:
    """Start a hanging chain anywhere and see it swing, by superposing its modes.

    Small oscillations in one plane. For motions in both directions call it for each: they do not know
    of each other.

    Parameters
    ----------
    chain : Chain
        The chain of N links.
    offsets : array_like, shape (N + 1,) or (N,)
        Of the pins at time 0, free end first; that of the support, 0, last or left out.
    velocities : array_like, shape (N + 1,) or (N,), or None
        Likewise; None: at rest.
    t : array_like
        Times in s, of either sign, a number or one axis.
    modes : int, optional
        Only so many of the slowest; all if left out.
    gravity : float, optional
        Standard gravity, in metres, if left out.

    Returns
    -------
    SmallOscillation
        The offset of pin m at time i is within ``error_bound[i] + truncation_error[m]`` of the exact one.

    Raises
    ------
    TypeError
        If `chain` is not a Chain.
    ValueError
        For numbers that are not finite, starts of another length, a support that would move, more modes than there
        are, and weights more than 1e123 apart.

    Notes
    -----
    Pins that have no inertia, between massless threads, cannot be anywhere: offsets given for them are
    replaced by those to which their neighbours pull them, and velocities likewise, as a light thread snaps
    straight. `SmallOscillation.projected` says that it was done.

    Method: heights and shapes as of `modes`, once more in words of two doubles, with angles in two words: beats of
    many years keep their phase. Accuracy: 1e-15 of the amplitudes. Cost: 2 microseconds for each link
    and mode, 2 ns for each link, mode and time.

    References
    ----------
    Greenhill (1908), sections 2 and 8.

    Examples
    --------
    A light plummet below a heavy one: they take turns.

    >>> import numpy as np
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[0.01, 1.0], length=1.0)
    >>> beat = rc.small_oscillation(chain, [0.01, 0.01, 0.0], None, np.linspace(0.0, 20.0, 2001))
    >>> round(float(abs(beat.offset[:, 0]).max()), 4), round(float(abs(beat.offset[:, 1]).max()), 4)
    (0.1002, 0.01)
    """
    place = "revchain.small_oscillation"
    core = compiled(place, chain)
    start = _start(place, "offsets", offsets, chain.size)
    speed = _start(place, "velocities", np.zeros(chain.size) if velocities is None else velocities, chain.size)
    time = floats(place, "t", t)
    if time.ndim > 1:
        raise ValueError(f"{place}: t must be a number or have one axis, got an array of shape {time.shape}")
    refuse_where(~np.isfinite(time), time, f"{place}: t must be finite")
    count = None if modes is None else limit(place, "modes", integer(place, "modes", modes))
    g = float(positive(place, "gravity", real(place, "gravity", gravity)))
    time = np.atleast_1d(time)
    return SmallOscillation(chain, time, *_core.small_oscillation(core, start, speed, time, count, g))


def _start(place: str, name: str, value: ArrayLike, size: int) -> Floats:
    array = floats(place, name, value)
    if array.shape not in ((size,), (size + 1,)):
        raise ValueError(
            f"{place}: {name} must have shape ({size + 1},), a number for each pin, or ({size},), the support's 0 "
            f"left out, got {array.shape}"
        )
    refuse_where(~np.isfinite(array), array, f"{place}: {name} must be finite")
    return array


def _resonances(found: Response) -> list[float]:
    """Whirl speeds between the least and the largest speed."""
    speed = found.angular_speed.reshape(-1)
    if speed.size == 0 or not isinstance(found.chain, Chain):
        return []
    chain, least, most = found.chain, float(speed.min()), float(speed.max())
    height = found.conical_height.reshape(-1)
    gravity = float(height[0] * found.angular_speed.reshape(-1)[0] ** 2)
    if not 0 < least < most:
        return []
    below = count_modes(chain, angular_speed=np.array([least, most]), gravity=gravity)
    count = int(below[1] - below[0])
    if not 0 < count <= MOST_RESONANCES:
        return []
    return list(modes(chain, count, first=int(below[0]) + 1, gravity=gravity).angular_speed)
