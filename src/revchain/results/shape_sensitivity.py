# SPDX-License-Identifier: GPL-3.0-or-later
"""How a steady shape changes with the speed and with the data of its links."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ..systems.numbers import Floats, refuse_beyond_memory
from ..systems.rig import Rig, Support
from .base import Field, Result
from .sensitivity import DATA, datum_columns
from .sheet import Column, Sheet

if TYPE_CHECKING:
    from .shapes import SteadyShape


class ShapeDerivatives(Result):
    """Derivatives of some numbers of a shape, one row for each; see `ShapeSensitivity`."""

    __slots__ = ()
    angular_speed: Field[Floats] = Field("With respect to the speed, per rad/s, shape (M,).", part=True)
    mass: Field[Floats] = Field(
        "With respect to the mass of each link, per kg, shape (M, N); of a chain given by weight, to its weight.", part=True
    )
    length: Field[Floats] = Field(
        "With respect to the distance between its pins: centre of gravity and radius of gyration stay where they are.",
        part=True,
    )
    centroid: Field[Floats] = Field("With respect to its centre of gravity, from the upper pin.", part=True)
    radius_of_gyration: Field[Floats] = Field("With respect to its radius of gyration.", part=True)
    length_in_proportion: Field[Floats] = Field(
        "With respect to length, centroid and radius of gyration growing in proportion: a point mass's thread.", part=True
    )
    support_radius: Field[Floats] = Field("With respect to the radius in which a support is carried, (M,).", part=True)

    def _sheet(self, brief: bool = False) -> Sheet:
        rows = Column("index", np.arange(len(self.angular_speed)), "index")
        columns = datum_columns(self, ("angular_speed", "support_radius", *DATA))
        return Sheet("index", "Derivatives by datum; those for the lowest link are shown", [rows, *columns])


class ShapeSensitivity(Result):
    """Derivatives of a steady shape with respect to the speed and to the data of N links.

    While one datum changes, all others are held. At a fold of a branch they are infinite: there is no shape beyond.

    Notes
    -----
    The moments about the pins stay 0: a linear equation for the change of the inclinations, with the second derivatives
    of the effective energy as its matrix (implicit function theorem). Relative to the largest of their kind, derivatives
    are good to 1e-12, or to 1e-13 times `SteadyShape.condition` where that is more. Cost O(N^3), 20 ms for 200 links, and
    memory for some ten N-by-N arrays.

    Examples
    --------
    How much farther out does the mass at the tip fly for each rad/s more? And the seat of a carousel for each metre of its
    arm?

    >>> import revchain as rc
    >>> shape = rc.steady_shapes(rc.Chain(mass=[1.0, 3.0], length=1.0), angular_speed=4.0)[0]
    >>> round(float(shape.sensitivity.offset.angular_speed[0]), 4)
    0.1859
    >>> seat = rc.Rig(rc.Chain(mass=80.0, length=5.0), support=rc.Support(radius=4.0))
    >>> out = rc.steady_shapes(seat, angular_speed="8 rpm")[0]
    >>> round(float(out.sensitivity.offset.support_radius[0]), 4)
    1.3859
    """

    __slots__ = ()
    inclination: Field[ShapeDerivatives] = Field("Of the inclination of each link, rad; M = N.", part=True)
    offset: Field[ShapeDerivatives] = Field(
        "Of the distance of each pin from the axis, m; row 0: the tip. M = N + 1.", part=True
    )
    tension: Field[ShapeDerivatives] = Field(
        "Of the reaction at the upper pin of each link, N or in the unit of the weights; M = N.", part=True
    )

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [Column("link", np.arange(len(self.inclination.angular_speed)), "link")]
        for name, unit in (("inclination", "rad"), ("tension", "N")):
            by_speed = getattr(self, name).angular_speed
            columns.append(Column(f"{name}_by_angular_speed", by_speed, f"{name} by speed ({unit} s/rad)"))
        for name in DATA:
            columns.append(Column(f"tip_by_{name}", getattr(self.offset, name)[0], f"tip radius by its {name}"))
        return Sheet("link", "ShapeSensitivity: derivatives of a steady shape; .offset, .inclination, .tension", columns)


def shape_sensitivity(shape: SteadyShape) -> ShapeSensitivity:
    """See `SteadyShape.sensitivity`."""
    system = shape.system
    if isinstance(system, Rig):
        is_firm = system.support == Support(radius=system.support.radius)
        if not is_firm or system.flywheels is not None or system.displaced is not None or system.inverted.any():
            raise ValueError(
                "revchain.SteadyShape.sensitivity: is for shapes of a Chain, or of a Rig with a firm support; "
                "ask steady_shapes of the changed rig"
            )
    chain = system.chain if isinstance(system, Rig) else system
    n = chain.size
    refuse_beyond_memory("revchain.SteadyShape.sensitivity", "the number of links", n, 80 * n)
    W, a, h, rho = (
        np.broadcast_to(x, n).astype(float)
        for x in (chain.mass if chain.by_mass else chain.weight, chain.length, chain.centroid, chain.radius_of_gyration)
    )
    height, radius, per = shape.conical_height, float(shape.offset[-1]), shape._per
    sine, cosine = np.sin(shape.inclination), np.cos(shape.inclination)
    below = np.cumsum(W) - W
    # Distances of the centroids from the axis: radius + C sin d. G: moments of what turns.
    C = np.triu(np.broadcast_to(a, (n, n)), 1) + np.diag(h)
    G = C.T @ (W[:, None] * C) + np.diag(W * rho**2)
    kappa = W @ C
    out = radius + C @ sine
    turning = C.T @ (W * out) + W * rho**2 * sine
    # The moments kappa sin d - cos d turning / height, and their derivatives by the inclinations
    slope = np.diag(kappa * cosine + sine * turning / height) - np.outer(cosine, cosine) * G / height

    carried = np.cumsum(W * out) - W * out  # of the links below
    lower = np.triu(np.ones((n, n)), 1)  # [i, m]: link i hangs below link m
    by_datum = {  # derivatives of kappa and of turning at constant inclinations: (N, N) arrays, a column for each link
        "mass": (C.T, C.T * out + np.diag(rho**2 * sine)),
        "length": (np.diag(below), np.diag(carried) + C.T @ (W[:, None] * lower * sine)),
        "centroid": (np.diag(W), np.diag(W * out) + C.T * (W * sine)),
        "radius_of_gyration": (np.zeros((n, n)), np.diag(2 * W * rho * sine)),
    }
    loads = [sine[:, None] * k - cosine[:, None] * t / height for k, t in by_datum.values()]
    loads.append((cosine * turning / height**2)[:, None])  # by the height
    loads.append((-cosine * kappa / height)[:, None])  # by the radius
    moved = -np.linalg.solve(slope, np.concatenate(loads, axis=1))
    *of_links, by_height, by_radius = np.split(moved, [n * k for k in range(1, 5)] + [4 * n + 1], axis=1)

    reach = np.triu(np.broadcast_to(a, (n, n)))  # offsets of the pins: radius + reach sin d
    pull, weight = np.cumsum(W * out) / height, np.cumsum(W)
    tension = np.hypot(pull, weight)
    sums = np.tril(np.ones((n, n)))

    def through(turned: Floats, off: Floats, far: Floats, heavier: Floats, direct: Floats) -> list[Floats]:
        """Inclinations, offsets and tensions, from the change of the inclinations and what else changes."""
        swung = cosine[:, None] * turned
        offset = np.concatenate([off + reach @ swung, np.broadcast_to(far, (1, swung.shape[1]))])
        rise = sums @ (W[:, None] * (C @ swung + far)) / height + direct
        return [turned, offset, per * (pull[:, None] * rise + weight[:, None] * heavier) / tension[:, None]]

    none = np.zeros((n, n))
    own = np.diag(sine)
    parts = {
        "mass": through(of_links[0], none, np.zeros(n), sums, sums * out / height),
        "length": through(of_links[1], lower * sine + own, np.zeros(n), none, sums @ (W[:, None] * lower * sine) / height),
        "centroid": through(of_links[2], none, np.zeros(n), none, sums * (W * sine) / height),
        "radius_of_gyration": through(of_links[3], none, np.zeros(n), none, none),
    }
    nil = np.zeros((n, 1))
    steeper = through(by_height, nil, np.zeros(1), nil, -(pull / height)[:, None])
    speed = [-2 * height / shape.angular_speed * x[:, 0] for x in steeper]
    wider = [x[:, 0] for x in through(by_radius, nil + 1, np.ones(1), nil, nil)]
    results = []
    for which in range(3):
        given = {name: values[which] for name, values in parts.items()}
        share = (given["length"] * a + given["centroid"] * h + given["radius_of_gyration"] * rho) / a
        results.append(
            ShapeDerivatives._made(
                None, **given, length_in_proportion=share, angular_speed=speed[which], support_radius=wider[which]
            )
        )
    return ShapeSensitivity._made(None, inclination=results[0], offset=results[1], tension=results[2])
