# SPDX-License-Identifier: GPL-3.0-or-later
"""Force diagrams of steady shapes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..systems.numbers import Floats
from .base import Field, Result
from .sheet import Column, Sheet

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class ForceDiagram(Result):
    """The graphical construction of a steady shape as data; links lowest first, pins free end first.

    Returned by `SteadyShape.force_diagram`. Points are rows ``(x from the axis, z upwards)``. The vertices of the
    funicular polygon are the pins, its sides the links, its loads `load`. In the diagram of force the line of load goes
    up from the pole O, and the ray ``OQ_m`` is parallel to link m and as long as what pulls along it.
    """

    __slots__ = ()
    pin: Field[Floats] = Field("Vertices of the funicular polygon, shape (N + 1, 2); the support's 0, 0 last.", part=True)
    load: Field[Floats] = Field(
        "On every pin but the support, shape (N, 2): centrifugal force outwards, weight downwards (negative).", part=True
    )
    ray: Field[Floats] = Field(
        "``Q_m`` from the pole, shape (N, 2): parallel to link m, the side between pins m - 1 and m.", part=True
    )
    reaction: Field[Floats] = Field(
        "At each link's upper pin, on what hangs below it, shape (N, 2); for point masses the ray.", part=True
    )
    lifted: Field[Floats] = Field(
        "Where each load's line from the pole meets the horizontal line ``conical_height`` below it, shape (N,). For point "
        "masses their own offsets: P lifted vertically onto that line.",
        part=True,
    )
    centre_of_gravity: Field[Floats] = Field(
        "``G_m`` of link m and all below, shape (N, 2). With ``K_m`` on the axis, ``conical_height`` above its level, "
        "``G_m K_m`` is parallel to the reaction, and so to the thread above a point mass.",
        part=True,
    )
    crossing: Field[Floats] = Field(
        "Height of ``C_m``, where the line of link m meets the axis, shape (N,); infinite where it never does.", part=True
    )
    conical_height: Field[float] = Field("Conical height of the speed: ON, HK.", part=True)

    def plot(self, axes: tuple[Axes, Axes] | None = None) -> tuple[Axes, Axes]:
        """Draw the figure and its diagram of force side by side, lettered as in Fig. 3 of the paper.

        Parameters
        ----------
        axes : pair of matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.

        Returns
        -------
        pair of matplotlib.axes.Axes
            Of the figure and of the forces. The weights lifted onto the line through N are drawn to the
            scale on which ON is the mean weight.

        Raises
        ------
        ImportError
            If matplotlib is not installed; the message says how to install it.

        Examples
        --------
        >>> import revchain as rc
        >>> shape = rc.steady_shapes(rc.Chain.uniform_plummets(3, length=3.0), conical_height=0.5)[0]
        >>> figure, forces = shape.force_diagram().plot()
        >>> forces.get_title()
        'diagram of force'
        """
        from ..plots.closed_forms import plot_force_diagram

        return plot_force_diagram(self, axes)

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [Column("link", np.arange(len(self.ray)), "link")]
        for name in ("load", "ray", "reaction"):
            values = getattr(self, name)
            columns += [Column(f"{name}_{axis}", values[:, k], f"{name} {axis}") for k, axis in enumerate("xz")]
        columns += [Column("lifted", self.lifted, "lifted"), Column("crossing", self.crossing, "crossing")]
        facts = {"conical_height": self.conical_height, "pin": self.pin, "centre_of_gravity": self.centre_of_gravity}
        return Sheet("link", f"ForceDiagram: {len(self.ray)} links, conical height {self.conical_height:.6g}", columns, facts)
