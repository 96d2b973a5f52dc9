# SPDX-License-Identifier: GPL-3.0-or-later
"""How conical heights and speeds move with the data of a chain, and how uncertain they are."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import STANDARD_GRAVITY, Floats, count, floats, positive, read_only, real, shown, together
from ..systems.rig import Rig
from .base import Record

if TYPE_CHECKING:
    from .modes import Modes


@dataclass(frozen=True, slots=True, eq=False)
class Derivatives(Record):
    """One number for each mode and link, by the datum of the link that it belongs to.

    Attributes
    ----------
    weight, length, centroid, radius_of_gyration, length_in_proportion : ndarray, shape (k, N)
        As `Sensitivity` says of its own; links lowest first.

    Examples
    --------
    >>> import revchain as rc
    >>> relative = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).sensitivity.relative
    >>> relative.length_in_proportion.sum(axis=1).round(12)
    array([1., 1.])
    """

    weight: Floats
    length: Floats
    centroid: Floats
    radius_of_gyration: Floats
    length_in_proportion: Floats

    def __getitem__(self, quantity: str) -> Floats:
        """The array of a quantity by its name."""
        if quantity not in _core.DATA:
            raise KeyError(f"quantity must be one of {', '.join(_core.DATA)}, got {shown(quantity)}")
        return getattr(self, quantity)  # type: ignore[no-any-return]


@dataclass(frozen=True, slots=True, eq=False)
class Sensitivity(Record):
    """Derivatives of the conical heights of k modes with respect to the data of N links.

    While one datum changes, all the others are held: of this link and of all.

    Attributes
    ----------
    weight : ndarray, shape (k, N)
        d(conical height)/d(weight), unit of length over unit of weight.
    length : ndarray, shape (k, N)
        With respect to the distance between the pins: the lower pin moves, centre of gravity and radius of
        gyration stay where they are. 0 for the lowest link. A plummet does not stay one.
    centroid : ndarray, shape (k, N)
        With respect to the distance of the centre of gravity from the upper pin.
    radius_of_gyration : ndarray, shape (k, N)
        Never negative; 0 where the radius is.
    length_in_proportion : ndarray, shape (k, N)
        With respect to the length, centroid and radius of gyration growing in proportion: a plummet's
        thread, a rod's length. Never negative.
    error_bound : Derivatives
        Bound of the error of each, absolute and proved: in most cases half an ulp.
    relative : Derivatives
        Logarithmic derivatives ``(x / height) d(height)/dx``. Those of the speeds are -1/2 of it.

    Notes
    -----
    From the shape alone, in two words: ``(y' dM y - height y' dK y) / (y' K y)``, O(N) a mode. Weights act by
    their ratios: relative weights of a mode add up to 0. Relative lengths, centroids and radii of gyration add
    up to 1, and so do relative lengths in proportion, each a link's share of the potential energy.

    Examples
    --------
    >>> import revchain as rc
    >>> s = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).sensitivity
    >>> s.weight
    array([[ 0.1875, -0.0625],
           [-0.1875,  0.0625]])
    >>> s.length_in_proportion
    array([[0.75, 0.75],
           [0.25, 0.25]])
    """

    weight: Floats
    length: Floats
    centroid: Floats
    radius_of_gyration: Floats
    length_in_proportion: Floats
    error_bound: Derivatives
    relative: Derivatives

    def __getitem__(self, quantity: str) -> Floats:
        """The array of a quantity by its name."""
        if quantity not in _core.DATA:
            raise KeyError(f"quantity must be one of {', '.join(_core.DATA)}, got {shown(quantity)}")
        return getattr(self, quantity)  # type: ignore[no-any-return]


@dataclass(frozen=True, slots=True, eq=False)
class Uncertainty(Record):
    """Standard deviations of the conical heights of k modes, to first order.

    Attributes
    ----------
    conical_height : ndarray, shape (k,)
        In the unit of the heights.
    relative : ndarray, shape (k,)
        Over the heights. Of speeds, periods and turns in a second half as much.
    share : Derivatives
        What part of each variance comes from which datum of which link; those of a mode add up to 1. With a
        covariance a part may be negative.
    largest : tuple of k (str, int)
        The datum that contributes most to each, and its link, counted from 0.

    Examples
    --------
    >>> import revchain as rc
    >>> u = rc.modes(rc.Chain(weight=[1.0, 3.0], length=1.0)).uncertainty(weight=0.1, length_in_proportion=0.002)
    >>> u.largest
    (('weight', 0), ('weight', 0))
    """

    conical_height: Floats
    relative: Floats
    share: Derivatives
    largest: tuple[tuple[str, int], ...]
    _height: Floats

    def angular_speed(self, gravity: ArrayLike = STANDARD_GRAVITY) -> Floats:
        """Return the standard deviation of each whirl speed, rad/s.

        Parameters
        ----------
        gravity : array_like, optional
            In the unit of length per s^2, exactly known; standard gravity, in metres, if left out.

        Returns
        -------
        ndarray, shape (k,)

        Raises
        ------
        ValueError
            If gravity is not positive and finite.

        Examples
        --------
        >>> import revchain as rc
        >>> rc.modes(rc.Chain(weight=1.0, length=2.4525)).uncertainty(
        ...     length_in_proportion=0.024525).angular_speed(gravity=9.81).round(12)
        array([0.01])
        """
        place = "revchain.Uncertainty.angular_speed"
        g = positive(place, "gravity", gravity)
        relative, height, g = together(place, relative=self.relative, height=self._height, gravity=g)
        return np.asarray(0.5 * relative * np.sqrt(g) / np.sqrt(height))


def of_modes(modes: Modes) -> Sensitivity:
    """`Modes.sensitivity`."""
    chain = modes.chain
    first = int(modes.number[0]) if len(modes) else 1
    heights = modes.conical_height.astype(np.float64)
    values, bounds = _core.sensitivity(chain._compiled, first, heights)
    data = {
        "weight": chain.weight,
        "length": chain.length,
        "centroid": chain.centroid,
        "radius_of_gyration": chain.radius_of_gyration,
        "length_in_proportion": chain.length,
    }
    relative = [
        read_only(value * (data[name] / heights[:, None])) for name, value in zip(_core.DATA, values, strict=True)
    ]
    named = dict(zip(_core.DATA, values, strict=True))
    return Sensitivity(**named, error_bound=Derivatives(*bounds), relative=Derivatives(*relative))


def uncertainty(modes: Modes, given: dict[str, ArrayLike | None]) -> Uncertainty:
    """`Modes.uncertainty`."""
    place = "revchain.Modes.uncertainty"
    size = modes.chain.size
    deviations: list[Any] = []
    for name in _core.DATA:
        value = given[name]
        array = None if value is None else floats(place, name, value)
        if array is not None and array.shape not in ((), (size,), (size, size)):
            raise ValueError(
                f"{place}: {name} must be a number, one for each of the {size} links, or their covariance of shape "
                f"({size}, {size}), got shape {array.shape}"
            )
        deviations.append(array)
    sensitivity = modes.sensitivity
    heights = modes.conical_height.astype(np.float64)
    height, relative, share, datum, link = _core.uncertainty(
        heights, [sensitivity[name] for name in _core.DATA], deviations
    )
    return Uncertainty(height, relative, Derivatives(*share), tuple(zip(datum, link, strict=True)), heights)


@dataclass(frozen=True, slots=True, eq=False)
class RigSensitivity(Record):
    """Derivatives of whirl speeds of a rig with respect to every datum of it; all else held.

    Shapes are those of one speed; of k speeds every array has k rows, and the last two are of shape (k,).

    Attributes
    ----------
    weight, length, centroid, radius_of_gyration : ndarray, shape (N,)
        With respect to the links' own data. `length` moves the lower pin; flywheels keep their momentum, what is
        displaced its place and size.
    length_in_proportion : ndarray, shape (N,)
        With respect to a length that takes centroid and radius of gyration with it.
    momentum : ndarray, shape (N,)
        With respect to the angular momentum of each link's flywheel.
    displaced_weight, added_weight : ndarray, shape (N,)
        With respect to the weight of fluid that each link displaces, and that has to move with it.
    stiffness, carriage_weight : float or ndarray
        Of the support; 0 where it is firm.

    Examples
    --------
    See `rig_sensitivity`.
    """

    weight: Floats
    length: Floats
    centroid: Floats
    radius_of_gyration: Floats
    length_in_proportion: Floats
    momentum: Floats
    displaced_weight: Floats
    added_weight: Floats
    stiffness: float | Floats
    carriage_weight: float | Floats


def rig_sensitivity(
    rig: Rig, angular_speed: ArrayLike, offset: ArrayLike, *, gravity: float = STANDARD_GRAVITY
) -> RigSensitivity:
    """Differentiate whirl speeds of a rigged chain with respect to all data of its links and of what it is rigged with.

    Parameters
    ----------
    rig : Rig
        A chain of N links and what it is rigged with; a `Chain` is refused.
    angular_speed : float or array_like, shape (k,)
        Whirl speeds of it, rad/s, of either sign.
    offset : array_like, shape (N + 1,) or (k, N + 1)
        Offsets of its pins in that mode, free end first, the pin of the support last.
    gravity : float, optional
        In the unit of length per s^2; standard gravity, in metres, if left out.

    Returns
    -------
    RigSensitivity
        As accurate as the offsets: the speed is stationary in the shape of the mode itself, its derivatives
        are not; 1e-14 of the largest with the shapes of `modes`, which `RigModes.sensitivity` takes. Cost O(N) each.

    Raises
    ------
    ValueError
        If a speed is 0 or not finite, gravity not positive, or there are not N + 1 finite offsets for each speed;
        where the offsets move no weight and tilt no flywheel.
    TypeError
        If `rig` is not a `Rig`.

    Notes
    -----
    From ``y' (K + n G - n^2 M / g) y = 0``, stationary in y. Of the conical height ``lambda = gravity / n**2``:
    ``d lambda = -2 * lambda / n * dn``.

    Examples
    --------
    A plummet with a flywheel, ``A n^2 - H n - W a = 0`` with ``A = W a^2 / g``:

    >>> import revchain as rc
    >>> rig = rc.Rig(rc.Chain(weight=10.0, length=1.0), momentum=3.0)
    >>> float(rc.rig_sensitivity(rig, 5.0, [1.0, 0.0], gravity=10.0).momentum[0].round(12))
    0.714285714286
    """
    place = "revchain.rig_sensitivity"
    if not isinstance(rig, Rig):
        raise TypeError(f"{place}: rig must be a revchain.Rig, got {shown(rig)}")
    g = real(place, "gravity", gravity)
    speeds, offsets = floats(place, "angular_speed", angular_speed), floats(place, "offset", offset)
    if speeds.ndim == 0:
        return RigSensitivity(*_core.rig_sensitivity(rig._compiled, float(speeds), offsets, g))
    if speeds.ndim != 1 or offsets.shape != (speeds.size, rig.chain.size + 1):
        raise ValueError(
            f"{place}: offset must have a row of {rig.chain.size + 1} offsets for each of the {speeds.size} speeds, "
            f"got shape {offsets.shape}"
        )
    rows = [_core.rig_sensitivity(rig._compiled, float(n), y, g) for n, y in zip(speeds, offsets, strict=True)]
    if not rows:
        return RigSensitivity(*(np.empty((0, rig.chain.size) if k < 8 else 0) for k in range(10)))
    return RigSensitivity(*(np.array(column) for column in zip(*rows, strict=True)))


def momentum_for_speed(rig: Rig, angular_speed: float, *, link: int, gravity: float = STANDARD_GRAVITY) -> float:
    """Return the momentum of one flywheel that makes a speed a whirl speed.

    Parameters
    ----------
    rig : Rig
        A chain of N links and what it is rigged with.
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
