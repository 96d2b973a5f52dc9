# SPDX-License-Identifier: GPL-3.0-or-later
"""Small motions of a cord after release."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from ..systems.cord import Cord
from ..systems.numbers import Floats
from .base import Field, Result
from .motions import energy_words
from .moving import Moving
from .sheet import Column, Sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes

CORD_SWING = (
    "offset",
    "velocity",
    "angular_frequency",
    "energy",
    "shape",
    "cosine",
    "sine",
    "energy_left_out",
    "error_estimate",
)


class CordSwing(Result, Moving):
    """Free motion of a cord in a plane after release, as a sum of its modes; returned by `swing`.

    Examples
    --------
    >>> import revchain as rc
    >>> found = rc.swing(rc.Cord(1.0), lambda s: 0.1 * (1 - s), None, [0.0, 0.5])
    >>> found.offset.shape, round(float(found.offset[1, 50]), 4)
    ((2, 101), -0.0149)
    """

    __slots__ = ()
    system: Field[Cord] = Field("The cord.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.")
    time: Field[Floats] = Field("Times, s, shape (T,).")
    arc_length: Field[Floats] = Field("Distance of each place from the free end, m, shape (n,).")
    offset: Field[Floats] = Field("Offsets of the places, m, shape (T, n): sums of the k modes used.")
    velocity: Field[Floats] = Field("Velocities of the places, m/s, shape (T, n).")
    angular_frequency: Field[Floats] = Field(
        "Natural angular frequency of each mode, rad/s, shape (k,), ascending: the whirl speeds of `modes`."
    )
    energy: Field[Floats] = Field(
        "Energy of each mode, J (weight times length), shape (k,); it is constant."
    )
    shape: Field[Floats] = Field("Shape of each mode, shape (k, n), 1 at the free end.")
    cosine: Field[Floats] = Field(
        "Coefficients, shape (k,), in offset = sum of ``shape * (cosine * cos(angular_frequency t) + sine * sin(...))``.",
    )
    sine: Field[Floats] = Field("Coefficients of the sines, shape (k,), see `cosine`.")
    energy_left_out: Field[float] = Field("Energy of the start that is not in the modes used.")
    error_estimate: Field[Floats] = Field(
        "Estimate of the error of each offset at any time, m, shape (n,): largest effect of modes k + 1 to 2 k, and of higher "
        "ones by extrapolation.",
    )

    def plot(self, ax: Axes | None = None, *, kind: str = "shapes", places: Iterable[int] = (0,)) -> Axes:
        """Draw the cord at the given times, or offsets of places against time.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw in; a new figure if left out.
        kind : {"shapes", "time"}
            ``"shapes"``: shapes from dark (early) to light (late), with enlarged offsets. ``"time"``: offsets against time.
        places : iterable of int
            For ``"time"``: indices of places in `arc_length`, 0 for the lowest.

        Returns
        -------
        matplotlib.axes.Axes
            The drawing.

        Raises
        ------
        ValueError
            If `kind` is another word, or there is no such place.
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import numpy as np
        >>> import revchain as rc
        >>> found = rc.swing(rc.Cord(1.0), lambda s: 0.1 * (1 - s), None, np.linspace(0, 2, 50))
        >>> found.plot(kind="time", places=[0, 50]).get_xlabel()
        'time (s)'
        """
        from ..plots.response import plot_cord_swing

        return plot_cord_swing(self, ax, kind, places)

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("time", self.time, "time (s)"),
            Column("lowest_offset", self.offset[:, 0], "lowest point (m)"),
            Column("lowest_velocity", self.velocity[:, 0], "lowest point (m/s)"),
            Column("largest_offset", np.abs(self.offset).max(axis=1), "farthest point (m)"),
            Column("offset", self.offset, axes=("place",)),
            Column("velocity", self.velocity, axes=("place",)),
        ]
        names: tuple[str, ...] = ("gravity", "arc_length", "angular_frequency", "energy", "cosine", "sine")
        names += ("energy_left_out", "error_estimate")
        return Sheet(
            "time",
            energy_words(self.energy),
            columns,
            {name: getattr(self, name) for name in names},
            [f"error: {self.error_estimate.max():.2g} m at most, estimated from the modes left out"],
            spread=True,
        )
