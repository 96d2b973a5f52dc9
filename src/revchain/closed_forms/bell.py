# SPDX-License-Identifier: GPL-3.0-or-later
"""A bell and its clapper: when they swing as one piece, and which data to change."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from ..results.base import Field, Result
from ..systems.chain import Chain, checked, compiled
from ..systems.numbers import STANDARD_GRAVITY, Floats, Whole, one_positive, read_only, real, shown
from ..systems.rig import _flags
from .table import described


class Strike(NamedTuple):
    """The first blow of a clapper in one swing of its bell; see `BellAndClapper.first_strike`.

    `side`: ``"leading"`` if the clapper has flown ahead of the bell, ``"trailing"`` if it has fallen behind. `bell_angle`:
    angle of the bell past its lowest position, rad. `relative_speed`: speed of the clapper in the bell, rad/s, positive
    towards the leading side. `time`: time after the start, s. The three numbers are NaN if the clapper does not strike.
    `status`: ``"strikes"``; ``"turns"`` if the bell comes to rest first; ``"at_rest"`` if both start in balance;
    ``"too_long"`` if neither happens in hundreds of swings. `error_estimate`: of `bell_angle` in rad, and of
    `relative_speed` and `time` relative to their size; infinite if rounding decides whether or where it strikes.

    Examples
    --------
    >>> import revchain as rc
    >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
    >>> blow = rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.3])).first_strike("27 deg")
    >>> blow.strikes, blow.side, round(blow.time, 1), blow.error_estimate < 1e-12
    (True, 'leading', 3.0, True)
    """

    strikes: bool
    side: str
    bell_angle: float
    relative_speed: float
    time: float
    status: str
    error_estimate: float


class BellAndClapper(
    Result, row="mode", title="BellAndClapper: one piece where mismatch is 0, here {mismatch:.4g}"
):
    """The two modes of a bell and its clapper; returned by `bell_and_clapper`.

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
    system: Field[Chain] = Field("Two links: the clapper, and above it the bell.")
    gravity: Field[float] = Field("Acceleration of gravity, m/s^2.", fact=True)
    mode: Field[Whole] = Field(
        "Numbers of the modes: 1 for the slower one. A mode that falls comes last.",
        lambda b: 1 + np.argsort(np.argsort(np.where(np.isnan(b.angular_speed), np.inf, b.angular_speed))),
        heading="mode",
    )
    angular_speed: Field[Floats] = Field(
        "Speed of each mode, rad/s, shape (2,); NaN if it falls.",
        lambda b: _speeds(np.asarray(b.conical_height), b.gravity),
        heading="speed",
        unit="rad/s",
    )
    rpm: Field[Floats] = Field(
        "Revolutions per minute, shape (2,).", lambda b: b.angular_speed * (30 / math.pi), heading="speed", unit="rpm"
    )
    conical_height: Field[Floats] = Field(
        "Conical height of each mode, m, shape (2,); negative if it does not swing but falls. If one mode falls, it is the "
        "second. Else the bodies lean the same way in the first mode, and opposite ways in the second.",
        heading="height",
        unit="m",
    )
    inclination_ratio: Field[Floats] = Field(
        "Inclination of the clapper divided by that of the bell in each mode, shape (2,). If the first is 1, both swing "
        "as one piece and the bell is silent.",
        heading="inclination: clapper / bell",
    )
    silent_height: Field[float] = Field(
        "Conical height of the first mode if both swing as one piece, m: the pendulum length of the clapper plus the "
        "joint, each negative for an inverted body.",
        fact=True,
    )
    mismatch: Field[float] = Field(
        "0 if both swing as one piece, in metres: ``h1 - (m + 1) l1 - m (a2 - l2)``, or ``+ m`` if one is inverted. "
        "`bell_and_clapper` explains the letters.",
        fact=True,
    )
    present: Field[dict[str, float]] = Field(
        "The data: ``clapper_weight``, ``clapper_centroid``, ``clapper_radius_of_gyration``, ``bell_weight``, "
        "``joint``, ``bell_centroid``, ``bell_radius_of_gyration``.",
        fact=True,
    )
    inverted: Field[NDArray[np.bool_]] = Field(
        "Whether clapper and bell stand on their upper pins in the position of rest, shape (2,).", fact=True
    )
    derivative: Field[dict[str, float]] = Field(
        "Derivative of the first inclination ratio with respect to each datum, the others constant.", fact=True
    )

    @described()
    def with_ratio(self, ratio: float) -> dict[str, float]:
        """Return the value of each datum that gives the first mode a wanted ratio of inclinations.

        ratio: Inclination of the clapper divided by that of the bell, positive. With 1 the bell is silent.
        returns: The values nearest to the present ones, each with the other data constant; NaN if no value gives the
            ratio and keeps the pin on its side of the axle and the stability of the position of rest.
        raises: If `ratio` is not positive and finite, or the pin of the clapper is in the axle.

        How far below the axle must the pin of the clapper be, so that the clapper swings 1.5 times as far as the bell?

        >>> links = {"weight": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> chain = rc.Chain(**links, radius_of_gyration=[0.08, 0.3])
        >>> round(rc.bell_and_clapper(chain).with_ratio(1.5)["joint"], 4)
        0.1928
        """
        caller = "revchain.BellAndClapper.with_ratio"
        given = real(caller, "ratio", ratio), self.present["joint"], self.inverted.tolist()
        values = checked(caller, False, _core.bell_and_clapper_with_ratio, self.system._compiled, *given)
        return dict(zip(_core.BELL_DATA, values, strict=True))

    @described()
    def strike_amplitude(self, clearance: float) -> float:
        """Return the smallest amplitude of the bell at which the clapper reaches its side, for small swings.

        returns: ``clearance / abs(inclination_ratio[0] - 1)``, rad, the limit for small swings in the first mode; infinite
            if both swing as one piece.
        raises: If the clearance is not between 0 and pi / 2.

        >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> bell = rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.3]))
        >>> round(bell.strike_amplitude("3 deg"), 4)
        0.2226
        """
        gap = _clearance("revchain.BellAndClapper.strike_amplitude", clearance)
        apart = abs(float(self.inclination_ratio[0]) - 1)
        return gap / apart if apart else math.inf

    @described("within `error_estimate`, below 1e-11 for 99 of 100 random bells", "", "0.25 ms")
    def first_strike(
        self, clearance: float, *, amplitude: float | None = None, clapper_angle: float | None = None
    ) -> Strike:
        """Return the first blow of the clapper in a swing of the bell.

        amplitude: Angle from its lowest position from which the bell is released at rest, rad, 0 to pi. If left out,
            the bell is rung full circle: it falls from the balance, mouth up, and is followed from 1e-4 rad beside it.
        clapper_angle: Angle of the clapper from the middle of the bell at the start, towards the lower side, rad, from
            ``-clearance`` to ``clearance``. If left out, it hangs free or rests on the lower side; in a full circle it
            rests on the trailing side. Without `amplitude` it must be one of the two ends.
        returns: The first blow up to the next turn of the bell, or the status if there is none.
        raises: If an angle is out of its range, or if one of bell and clapper is inverted and there is no amplitude.
        notes: Bell and clapper are a double pendulum in a plane, without friction, rope or stay. The clapper rests on the
            side of the bell while the bell pushes it, then flies free. Angles of the bell count from its lowest position,
            also if it is inverted: a bell with its centre of gravity above the axle is mouth down at the angle pi.
            The design charts of Woodhouse et al. (2012), doi:10.1155/2012/681787, use the same model for a bell much
            heavier than its clapper.

        >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> bell = rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.3]))
        >>> blow = bell.first_strike("27 deg")
        >>> blow.side, round(blow.bell_angle, 3), round(blow.relative_speed, 2)
        ('leading', 1.851, 2.52)

        Exactly in balance, mouth up, neither body moves:

        >>> bell.first_strike("27 deg", amplitude="180 deg", clapper_angle=0.0).status
        'at_rest'
        """
        caller = "revchain.BellAndClapper.first_strike"
        gap = _clearance(caller, clearance)
        from_angle = None if amplitude is None else real(caller, "amplitude", amplitude)
        of_clapper = None if clapper_angle is None else real(caller, "clapper_angle", clapper_angle)
        if from_angle is not None and not 0 <= from_angle <= math.pi:
            raise ValueError(f"{caller}: amplitude must be between 0 and pi, got {shown(from_angle)}")
        if of_clapper is not None and not -gap <= of_clapper <= gap:
            raise ValueError(f"{caller}: clapper_angle must be between -clearance and clearance, got {shown(of_clapper)}")
        if from_angle is None and of_clapper is not None and abs(of_clapper) != gap:
            found = shown(of_clapper)
            raise ValueError(f"{caller}: without amplitude clapper_angle must be clearance or -clearance, got {found}")
        if from_angle is None and self.inverted[0] != self.inverted[1]:
            stand = self.inverted.tolist()
            raise ValueError(f"{caller}: give amplitude if one of clapper and bell is inverted, got inverted={stand}")
        status, leading, angle, speed, time, error = _core.first_strike(
            list(self.present.values()), self.inverted.tolist(), gap, from_angle, of_clapper, self.gravity
        )
        struck = status == "strikes"
        side = ("leading" if leading else "trailing") if struck else ""
        return Strike(struck, side, angle, speed, time, status, error)


def _speeds(height: Floats, gravity: float) -> Floats:
    speed = np.full(height.shape, np.nan)
    swings = height > 0
    speed[swings] = _core.conical_pendulum_angular_speed(height[swings], np.asarray(gravity))
    return speed


def _clearance(caller: str, clearance: float) -> float:
    angle = real(caller, "clearance", clearance)
    if not 0 < angle < math.pi / 2:
        raise ValueError(f"{caller}: clearance must be between 0 and pi / 2, got {shown(angle)}")
    return angle


@described("2 ulp of heights and ratios; derivatives 1e-15 of the largest", "section 8 (14)-(16)", "O(1)")
def bell_and_clapper(
    chain: Chain, *, joint: float | None = None, inverted: ArrayLike = False, gravity: float = STANDARD_GRAVITY
) -> BellAndClapper:
    """Return the modes of a bell and its clapper, and how far they are from swinging as one piece.

    chain: Two links with weight: the clapper, and above it the bell. The length of the bell is the distance from its axle
        to the pin of the clapper; the length of the clapper has no effect.
    joint: Distance of the clapper's pin below the axle, m, instead of the length of the bell; negative above the axle.
    inverted: Whether clapper and bell stand on their upper pins in the position of rest, one for both or one for each.
        A bell with its centre of gravity 5 cm above the axle is inverted, with ``centroid`` 0.05 and the opposite sign
        of `joint`.
    returns: Heights, ratios of inclinations, and how they change with the data.
    raises: If the chain does not have two links with weight, or an argument is out of its range.
    notes: The ratio r of the inclination of the clapper to that of the bell is a root of
        ``h1 r^2 - ((m + 1) l1 - m l2 - a2) r - (m + 1) a2 = 0``, or, if one of the two is inverted, of
        ``h1 r^2 - (m + 1) l1 r - (m l2 + a2) r + (m + 1) a2 = 0``. The clapper has the centroid h1 and the pendulum length
        l1, the bell h2 and l2. The joint is a2, and m = W2 h2 / (W1 a2), with the weights W1 and W2. The conical height is
        ``l1 + a2 / r``; an inverted clapper changes the sign of l1, an inverted bell that of a2. This holds for small
        inclinations, and for any inclination if both swing as one piece.

    For this bell the ratio grows with the distance of its centre of gravity below the axle:

    >>> chain = rc.Chain(weight=[18, 500], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    >>> rc.bell_and_clapper(chain).derivative["bell_centroid"] > 0
    True

    A pin 3 cm above the axle:

    >>> rc.bell_and_clapper(chain, joint=-0.03).angular_speed.round(5)
    array([4.29499, 3.87118])

    The centre of gravity of the bell 20 cm above its axle, the clapper's pin 15 cm below it: the bell falls.

    >>> rc.bell_and_clapper(chain, joint=-0.15, inverted=[False, True]).angular_speed.round(5)
    array([4.29946,     nan])
    """
    caller = "revchain.bell_and_clapper"
    under, stands = compiled(caller, chain), _flags(caller, inverted, 2)
    stand = np.zeros(2, bool) if stands is None else stands
    height, ratio, silent, mismatch, present, derivative = _core.bell_and_clapper(
        under, None if joint is None else real(caller, "joint", joint), stand.tolist()
    )
    found = {"conical_height": np.asarray(height), "inclination_ratio": np.asarray(ratio), "silent_height": silent}
    found |= {"mismatch": mismatch, "present": dict(zip(_core.BELL_DATA, present, strict=True))}
    found["derivative"] = dict(zip(_core.BELL_DATA, derivative, strict=True))
    found["inverted"] = read_only(stand)
    return BellAndClapper._made(None, system=chain, gravity=one_positive(caller, "gravity", gravity), **found)

