# SPDX-License-Identifier: GPL-3.0-or-later
"""A bell and its clapper: when they swing as one piece, and what to change about it."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .. import _core
from ..results.base import Field, Result
from ..results.sheet import Column, Sheet, speed_columns
from ..systems.chain import Chain, compiled
from ..systems.extras import require
from ..systems.numbers import STANDARD_GRAVITY, Floats, one_positive, real, shown

if TYPE_CHECKING:
    from matplotlib.axes import Axes


class Strike(NamedTuple):
    """The first blow of a clapper in one swing of its bell; see `BellAndClapper.first_strike`.

    `strikes`: whether there is one. `side`: ``"leading"``, the side of the bell that goes ahead as the bell rises (it
    rings right, the clapper has flown ahead), or ``"trailing"`` (the clapper falls behind). `bell_angle`: how far the bell
    has risen past its lowest place, rad; `relative_speed`: of the clapper in the bell, rad/s, positive towards the leading
    side; `time`: after the start, s. All three are nan where there is no blow.
    """

    strikes: bool
    side: str
    bell_angle: float
    relative_speed: float
    time: float


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

    def strike_amplitude(self, clearance: float) -> float:
        """Return how far the bell must swing before the clapper reaches its side, where the swing is small.

        Parameters
        ----------
        clearance : float
            Angle in the bell from the clapper in the middle to where it touches, rad (or ``"25 deg"``), below pi/2.

        Returns
        -------
        float
            ``clearance / abs(inclination_ratio[0] - 1)``, rad: infinite where bell and clapper are one piece. Exact in
            the limit of small swings in the slower mode; from half a radian on ask `first_strike`.

        Raises
        ------
        ValueError
            For a clearance that is not between 0 and pi / 2.

        Examples
        --------
        >>> import revchain as rc
        >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> bell = rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.3]))
        >>> round(bell.strike_amplitude("3 deg"), 4)
        0.2226
        """
        gap = _clearance("revchain.BellAndClapper.strike_amplitude", clearance)
        apart = abs(float(self.inclination_ratio[0]) - 1)
        return gap / apart if apart else math.inf

    def first_strike(self, clearance: float, *, amplitude: float | None = None) -> Strike:
        """Return where in a swing the clapper first strikes the bell; needs SciPy.

        Parameters
        ----------
        clearance : float
            Angle in the bell from the clapper in the middle to where it touches, rad (or ``"25 deg"``), below pi/2.
        amplitude : float, optional
            Angle from which the bell falls, rad, up to pi: let go at rest, the clapper hanging free or resting on the
            lower side. Left out: full circle, as church bells are rung in England: it falls from the balance, mouth up,
            the clapper on the side that trails.

        Returns
        -------
        Strike
            Up to the next turn of the bell. Angles and speeds to 1e-8 of their size, by integration.

        Raises
        ------
        ValueError
            For a clearance that is not between 0 and pi / 2, and an amplitude that is not between 0 and pi.
        ImportError
            If SciPy is not installed; the message says how to install it.

        Notes
        -----
        Bell and clapper are a double pendulum in a plane, without friction, rope or stay; the headstock is stiff. The
        clapper rests on the side of the bell as long as that has to push, then flies free; what bounces do after the first
        blow is not followed, for it depends on the two metals. The same model, with the bell many times heavier than
        its clapper, is behind the design charts of Woodhouse et al. (2012), doi:10.1155/2012/681787: there two ratios of
        lengths decide, ``joint / l1`` and ``l2 / l1``. Where ``l2 = l1 + joint`` a clapper that hangs in the middle stays
        there; for any weights that is Greenhill (1908), section 8 (16): `mismatch` = 0.

        Examples
        --------
        >>> import revchain as rc
        >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> bell = rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.3]))
        >>> blow = bell.first_strike("27 deg")
        >>> blow.side, round(blow.bell_angle, 3), round(blow.relative_speed, 2)
        ('leading', 1.851, 2.52)
        """
        place = "revchain.BellAndClapper.first_strike"
        gap = _clearance(place, clearance)
        from_angle = None if amplitude is None else real(place, "amplitude", amplitude)
        if from_angle is not None and not 0 < from_angle <= math.pi:
            raise ValueError(f"{place}: amplitude must be between 0 and pi, got {shown(from_angle)}")
        require("scipy", "fit", "the first strike of a clapper")
        from .strike import first_strike

        return Strike(*first_strike(self.present, gap, from_angle, self.gravity))

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw bell, clapper and headstock at rest, true to scale; needs matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Where to draw; a new figure if left out.

        Returns
        -------
        matplotlib.axes.Axes
            The axle, the pin of the clapper, both centres of gravity, and the pendulum lengths beside them. The outline of
            the bell is a picture only: its data say nothing of its shape but the radius of gyration.

        Examples
        --------
        >>> import revchain as rc
        >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.05]}
        >>> rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.36])).plot().get_ylabel()
        'depth below axle (m)'
        """
        from ..plots.bell import plot_bell

        return plot_bell(self, ax)

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


def _clearance(place: str, clearance: float) -> float:
    angle = real(place, "clearance", clearance)
    if not 0 < angle < math.pi / 2:
        raise ValueError(f"{place}: clearance must be between 0 and pi / 2, got {shown(angle)}")
    return angle


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
