# SPDX-License-Identifier: GPL-3.0-or-later
"""A bell and its clapper: when they swing as one piece, and what to change about it."""

from __future__ import annotations

from dataclasses import dataclass

from .. import _core
from ..systems.chain import Chain, compiled
from ..systems.numbers import real


@dataclass(frozen=True, slots=True)
class BellAndClapper:
    """Both modes of a bell and its clapper, and how far they are from swinging as one piece.

    What the two are is named ``clapper_weight``, ``clapper_centroid``, ``clapper_radius_of_gyration``,
    ``bell_weight``, ``joint`` (from the bell's axle to the clapper's pin), ``bell_centroid`` and
    ``bell_radius_of_gyration``.

    Attributes
    ----------
    chain : Chain
        Two links: the clapper, and above it the bell.
    conical_height : (float, float)
        Of the slower mode, in which they lean the same way, and of the faster one, in which they lean
        opposite ways.
    inclination_ratio : (float, float)
        The clapper's inclination over the bell's. They are one piece where the first is 1, and the bell is
        then silent in that mode; in the faster mode they never are.
    silent_height : float
        Conical height of the slower mode where they are one piece: the clapper's pendulum length and the
        joint's.
    mismatch : float
        ``h1 - (m + 1) l1 - m (a2 - l2)``, a length: 0 where they are one piece.
    derivative : dict
        d(first inclination ratio)/d(each datum), the others held.

    Notes
    -----
    Greenhill (1908) section 8 (14)-(16). Small inclinations; where they are one piece, at any.

    Examples
    --------
    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[18, 500], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    >>> bell = rc.bell_and_clapper(chain)
    >>> round(bell.inclination_ratio[0], 4)
    1.2352
    >>> {name: round(value, 4) for name, value in bell.with_ratio(1.0).items() if name in ("joint", "bell_centroid")}
    {'joint': 0.1174, 'bell_centroid': 0.1785}
    """

    chain: Chain
    conical_height: tuple[float, float]
    inclination_ratio: tuple[float, float]
    silent_height: float
    mismatch: float
    present: dict[str, float]
    derivative: dict[str, float]

    def with_ratio(self, ratio: float) -> dict[str, float]:
        """Return for each datum the value that gives the slower mode another ratio of inclinations.

        Parameters
        ----------
        ratio : float
            The clapper's inclination over the bell's, positive. With 1 the bell is silent; to keep it from
            that, ask for a ratio as far from 1 as it takes.

        Returns
        -------
        dict
            The values nearest to the present ones, each with the other data held; NaN where none does.

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
        values = _core.bell_and_clapper_with_ratio(self.chain._compiled, wanted)
        return dict(zip(_core.BELL_DATA, values, strict=True))


def bell_and_clapper(chain: Chain) -> BellAndClapper:
    """Tell how far a bell and its clapper are from swinging as one piece.

    Parameters
    ----------
    chain : Chain
        Two links, both with weight: the clapper, and above it the bell, whose length is the distance from its
        axle to the clapper's pin. The clapper's own length matters to nothing.

    Returns
    -------
    BellAndClapper
        Heights and ratios to 2 ulp. Cost O(1).

    Raises
    ------
    ValueError
        Unless there are two links with weight.
    TypeError
        If `chain` is not a `Chain`.

    Notes
    -----
    With r the clapper's inclination over the bell's, ``h1 r^2 - ((m + 1) l1 - m l2 - a2) r - (m + 1) a2 = 0``
    and the conical height ``l1 + a2 / r``: one positive root, one negative.

    References
    ----------
    Greenhill (1908), section 8 (14)-(16).

    Examples
    --------
    Which way the ratio goes when the bell is hung higher, so that its centre of gravity lies deeper:

    >>> import revchain as rc
    >>> chain = rc.Chain(weight=[18, 500], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    >>> rc.bell_and_clapper(chain).derivative["bell_centroid"] > 0
    True
    """
    height, ratio, silent, mismatch, present, derivative = _core.bell_and_clapper(
        compiled("revchain.bell_and_clapper", chain)
    )
    names = _core.BELL_DATA
    return BellAndClapper(
        chain,
        (height[0], height[1]),
        (ratio[0], ratio[1]),
        silent,
        mismatch,
        dict(zip(names, present, strict=True)),
        dict(zip(names, derivative, strict=True)),
    )
