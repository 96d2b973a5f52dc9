# SPDX-License-Identifier: GPL-3.0-or-later
"""A bell and its clapper: when they swing as one piece, and what to change about it."""

from __future__ import annotations

import numpy as np

from .. import _core
from ..results.base import Field, Result
from ..results.sheet import Column, Sheet, speed_columns
from ..systems.chain import Chain, compiled
from ..systems.numbers import STANDARD_GRAVITY, Floats, one_positive, real


class BellAndClapper(Result):
    """Both modes of a bell and its clapper, and how far they are from swinging as one piece; see `bell_and_clapper`.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[18, 500], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    >>> rc.bell_and_clapper(chain)
    BellAndClapper: one piece where mismatch is 0, here -1.209
    mode  speed (rad/s)  speed (rpm)  height (m)  inclination: clapper / bell
       1        3.87309      36.9853    0.653742                      1.23524
       2        4.36194      41.6534    0.515421                     -8.88267
    """

    __slots__ = ()
    system: Field[Chain] = Field("Two links: the clapper, and above it the bell.", part=True)
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", part=True)
    angular_speed: Field[Floats] = Field(
        "Speed of each mode, rad/s, shape (2,).",
        lambda b: _core.conical_pendulum_angular_speed(np.asarray(b.conical_height), np.asarray(b.gravity)),
    )
    conical_height: Field[Floats] = Field(
        "Of the slower mode, in which they lean the same way, and of the faster one, in which they lean opposite ways, "
        "m, shape (2,).",
        part=True,
    )
    inclination_ratio: Field[Floats] = Field(
        "Inclination of the clapper over that of the bell in each mode, shape (2,). They are one piece, and the bell "
        "is silent, in the slower mode where the first is 1; in the faster mode they never are.",
        part=True,
    )
    silent_height: Field[float] = Field(
        "Conical height of the slower mode where they are one piece, m: the sum of the pendulum length of the clapper "
        "and the joint.",
        part=True,
    )
    mismatch: Field[float] = Field("``h1 - (m + 1) l1 - m (a2 - l2)``, m: 0 where they are one piece.", part=True)
    present: Field[dict[str, float]] = Field(
        "The data: ``clapper_weight``, ``clapper_centroid``, ``clapper_radius_of_gyration``, ``bell_weight``, "
        "``joint`` (from the axle of the bell to the pin of the clapper), ``bell_centroid``, ``bell_radius_of_gyration``.",
        part=True,
    )
    derivative: Field[dict[str, float]] = Field(
        "Derivative of the first inclination ratio by each of the data, the others constant.", part=True
    )

    def with_ratio(self, ratio: float) -> dict[str, float]:
        """Return for each datum the value that gives the slower mode another ratio of inclinations.

        Parameters
        ----------
        ratio : float
            Inclination of the clapper over that of the bell, positive. With 1 the bell is silent; to keep it ringing,
            ask for a ratio far enough from 1.

        Returns
        -------
        dict
            The values nearest to the present ones, each with the other data constant; NaN where there is none.

        Raises
        ------
        ValueError
            If `ratio` is not positive and finite.

        Examples
        --------
        How far below the axle must the clapper be hung to swing half as far again as its bell?

        >>> import revchain as rc
        >>> links = {"weight": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> chain = rc.Chain(**links, radius_of_gyration=[0.08, 0.3])
        >>> round(rc.bell_and_clapper(chain).with_ratio(1.5)["joint"], 4)
        0.1928
        """
        wanted = real("revchain.BellAndClapper.with_ratio", "ratio", ratio)
        values = _core.bell_and_clapper_with_ratio(self.system._compiled, wanted)
        return dict(zip(_core.BELL_DATA, values, strict=True))

    def _sheet(self, brief: bool = False) -> Sheet:
        columns = [
            Column("mode", np.arange(1, 3), "mode"),
            *speed_columns(self.angular_speed),
            Column("conical_height", self.conical_height, "height (m)"),
            Column("inclination_ratio", self.inclination_ratio, "inclination: clapper / bell"),
        ]
        names = ("gravity", "silent_height", "mismatch", "present", "derivative")
        heading = f"BellAndClapper: one piece where mismatch is 0, here {self.mismatch:.4g}"
        return Sheet("mode", heading, columns, {name: getattr(self, name) for name in names})


def bell_and_clapper(chain: Chain, *, gravity: float = STANDARD_GRAVITY) -> BellAndClapper:
    """Return how far a bell and its clapper are from swinging as one piece.

    Parameters
    ----------
    chain : Chain
        Two links, both with weight: the clapper, and above it the bell, whose length is the distance from its axle to
        the pin of the clapper. The length of the clapper does not matter.
    gravity : float, optional
        Positive; standard gravity in m/s^2 if left out.

    Returns
    -------
    BellAndClapper
        Heights and ratios to 2 ulp. Cost O(1).

    Raises
    ------
    ValueError
        Unless there are two links with weight, and `gravity` is positive.
    TypeError
        If `chain` is not a `Chain`.

    Notes
    -----
    With r the inclination of the clapper over that of the bell,
    ``h1 r^2 - ((m + 1) l1 - m l2 - a2) r - (m + 1) a2 = 0`` and the conical height ``l1 + a2 / r``: one positive root,
    one negative. Small inclinations; where they are one piece, at any. Greenhill (1908), section 8 (14)-(16).

    Examples
    --------
    The ratio grows where the bell is hung higher above its centre of gravity:

    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[18, 500], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    >>> rc.bell_and_clapper(chain).derivative["bell_centroid"] > 0
    True
    """
    place = "revchain.bell_and_clapper"
    height, ratio, silent, mismatch, present, derivative = _core.bell_and_clapper(compiled(place, chain))
    found = {"conical_height": np.asarray(height), "inclination_ratio": np.asarray(ratio), "silent_height": silent}
    found |= {"mismatch": mismatch, "present": dict(zip(_core.BELL_DATA, present, strict=True))}
    found["derivative"] = dict(zip(_core.BELL_DATA, derivative, strict=True))
    return BellAndClapper._made(None, system=chain, gravity=one_positive(place, "gravity", gravity), **found)
