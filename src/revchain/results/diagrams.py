# SPDX-License-Identifier: GPL-3.0-or-later
"""`ForceDiagram`: the force diagram and the funicular polygon of a steady shape."""

from __future__ import annotations


import numpy as np

from ..systems.numbers import Floats, Whole
from .base import Field, Result


def _component(name: str, k: int) -> Field[Floats]:
    """Return the field with one component of all vectors of the diagram."""

    def compute(diagram: ForceDiagram) -> Floats:
        vectors: Floats = getattr(diagram, name)
        return vectors[:, k]

    return Field(f"Component {'xz'[k]} of `{name}`.", compute, heading=f"{name} {'xz'[k]}")


class ForceDiagram(Result, row="link", title="ForceDiagram: {_links} links, conical height {_height}"):
    """The graphical construction of a steady shape as data: links lowest first, pins free end first.

    `SteadyShape.force_diagram` returns it. Points are rows ``(x from the axis, z upwards)``. In the force diagram the ray
    ``OQ_m`` from the pole O is parallel to link m; for point masses its length is the pull in the link.

    Examples
    --------
    >>> import revchain as rc
    >>> shape = rc.steady_shapes(rc.Chain(weight=1.0, length=2.0), conical_height=1.0)[0]
    >>> shape.force_diagram().ray.round(6)
    array([[-1.732051,  1.      ]])
    """

    __slots__ = ()
    link: Field[Whole] = Field("Numbers of the links.", lambda d: np.arange(len(d.ray)), heading="link")
    pin: Field[Floats] = Field(
        "Vertices of the funicular polygon, shape (N + 1, 2); the support, at (0, 0), is the last.", fact=True
    )
    load: Field[Floats] = Field(
        "Load on each pin without the support, shape (N, 2): centrifugal force outwards, weight (negative)."
    )
    ray: Field[Floats] = Field("Vector from the pole to ``Q_m``, shape (N, 2), parallel to link m.")
    reaction: Field[Floats] = Field(
        "Reaction at the upper pin of each link on the chain below, shape (N, 2); for point masses the ray."
    )
    load_x, load_z = _component("load", 0), _component("load", 1)
    ray_x, ray_z = _component("ray", 0), _component("ray", 1)
    reaction_x, reaction_z = _component("reaction", 0), _component("reaction", 1)
    lifted: Field[Floats] = Field(
        "Place where the line of each load from the pole meets the horizontal line ``conical_height`` below it, shape "
        "(N,); for point masses their offsets.",
        heading="lifted",
    )
    centre_of_gravity: Field[Floats] = Field(
        "Centre of gravity ``G_m`` of link m and all links below, shape (N, 2). ``K_m`` lies on the axis, "
        "``conical_height`` higher; ``G_m K_m`` is parallel to the reaction.",
        fact=True,
    )
    crossing: Field[Floats] = Field(
        "Height of ``C_m``, at which the line of link m meets the axis, shape (N,); infinite if they are parallel.",
        heading="crossing",
    )
    conical_height: Field[float] = Field("Conical height of the speed, m.", fact=True)

    @property
    def _links(self) -> int:
        return len(self.ray)

    @property
    def _height(self) -> str:
        return f"{self.conical_height:.6g}"
