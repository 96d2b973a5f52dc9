# SPDX-License-Identifier: GPL-3.0-or-later
"""Many chains at once."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from .. import _core
from ..systems.numbers import Floats, integer, link_arrays, mass_or_weight
from ..systems.numbers import count as checked_count

_PLACE = "revchain.conical_heights"


def conical_heights(
    *,
    mass: ArrayLike | None = None,
    weight: ArrayLike | None = None,
    length: ArrayLike,
    centroid: ArrayLike | None = None,
    pendulum_length: ArrayLike | None = None,
    radius_of_gyration: ArrayLike | None = None,
    count: int | None = None,
    threads: int = 1,
) -> Floats:
    """Find the conical heights of many chains of equally many links.

    The arrays broadcast against each other as numpy has it: the last axis counts the links, lowest
    first, the others the chains. A number, or an array of shape (N,), serves all chains.

    Parameters
    ----------
    mass, weight : array_like, shape (..., N)
        Mass of each link, kg, or its weight, not negative; the lowest must be positive, 0 is a massless thread.
    length : array_like, shape (..., N)
        Distance between the pins of each link, m, positive.
    centroid : array_like, shape (..., N), optional
        Distance of the centre of gravity from the *upper* pin, positive downwards, of any sign.
        Left out: point masses, with all the weight at the lower pin.
    pendulum_length : array_like, shape (..., N), optional
        Length of the equivalent simple pendulum about the upper pin.
    radius_of_gyration : array_like, shape (..., N), optional
        Radius of gyration about the centre of gravity, not negative. With `centroid` give either
        this or `pendulum_length`.
    count : int, optional
        How many modes of each chain, slowest first; all if left out, which takes chains that have
        equally many (massless links may cost modes).
    threads : int, optional
        How many threads to use; 0 for all processors.

    Returns
    -------
    numpy.ndarray, shape (..., count)
        Heights ``g / n**2``, descending, in the unit of the lengths. Bitwise the same whatever the
        number of threads, and wherever a chain stands in the batch.

    Raises
    ------
    ValueError
        For anything but real finite numbers, shapes that do not go together, the first chain with a
        number that `Chain` refuses (the message names chain, link and number), a `centroid` without
        exactly one of the two arguments that go with it, a `count` beyond the modes of some chain,
        or a chain whose heights cannot be proved to half the digits.

    Notes
    -----
    Accuracy: 2.8 ulp (6e-16) for plummets and rods of up to 100 links, 5 ulp at worst where weights
    span 1e12; the number of each mode is verified by counts. Cost: 0.25 microseconds for ten
    plummets, 0.4 for ten rods, all modes. Chains with
    massless links or centroids at or above the pin are solved one by one, like `modes`, at 10 to
    100 times the cost. Other Python threads run on meanwhile.

    References
    ----------
    Greenhill (1908), section 8 (21).

    Examples
    --------
    Two point masses on a thread, the lower one heavier and heavier:

    >>> import revchain as rc
    >>> rc.conical_heights(mass=[[1.0, 3.0], [2.0, 2.0], [3.0, 1.0]], length=1.0).round(3)
    array([[1.5  , 0.5  ],
           [1.707, 0.293],
           [1.866, 0.134]])
    """
    _, heavy = mass_or_weight(_PLACE, mass, weight)
    arrays = link_arrays(
        _PLACE,
        weight=heavy,
        length=length,
        centroid=centroid,
        pendulum_length=pendulum_length,
        radius_of_gyration=radius_of_gyration,
    )
    try:
        shape = np.broadcast_shapes(*(array.shape for array in arrays.values())) or (1,)
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise ValueError(f"{_PLACE}: these shapes do not go together: {shapes}") from None
    *batch, size = shape
    return _core.conical_heights(
        batch,
        size,
        **{name: _table(array, tuple(batch)) for name, array in arrays.items()},
        count=None if count is None else checked_count(_PLACE, "count", count),
        threads=integer(_PLACE, "threads", threads),
    )


def _table(array: Floats, batch: tuple[int, ...]) -> Floats:
    """One row of numbers for each chain, or a single one for all; copied only where neither will do."""
    links = array.shape[-1:] or (1,)
    if math.prod(array.shape[:-1]) == 1:
        return array.reshape(1, *links)
    return np.broadcast_to(array, (*batch, *links)).reshape(math.prod(batch), *links)
