# SPDX-License-Identifier: GPL-3.0-or-later
"""A bell and its clapper: when they swing as one piece, and which data to change."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from .. import _core
from ..results.base import Field, Result
from ..systems.chain import Chain, compiled
from ..systems.extras import require
from ..systems.numbers import STANDARD_GRAVITY, Floats, Whole, one_positive, real, shown
from .table import described


class Strike(NamedTuple):
    """The first blow of a clapper in one swing of its bell; see `BellAndClapper.first_strike`.

    `strikes`: whether the clapper strikes. `side`: ``"leading"`` if the clapper has flown ahead of the rising bell
    (the bell rings right), ``"trailing"`` if it has fallen behind. `bell_angle`: angle of the bell past its lowest
    position, rad. `relative_speed`: speed of the clapper in the bell, rad/s, positive towards the leading side. `time`:
    time after the start, s. The three numbers are NaN if the clapper does not strike.

    Examples
    --------
    >>> import revchain as rc
    >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
    >>> blow = rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.3])).first_strike("27 deg")
    >>> blow.strikes, blow.side, round(blow.time, 1)
    (True, 'leading', 3.0)
    """

    strikes: bool
    side: str
    bell_angle: float
    relative_speed: float
    time: float


class BellAndClapper(
    Result, row="mode", title="BellAndClapper: one piece where mismatch is 0, here {mismatch:.4g}"
):
    """The two modes of a bell and its clapper, and how far they are from swinging as one piece; see `bell_and_clapper`.

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
        "Numbers of the modes, 1 for the slower one: [2, 1] if the pin of the clapper is above the axle.",
        lambda b: 1 + np.argsort(-np.asarray(b.conical_height)),
        heading="mode",
    )
    angular_speed: Field[Floats] = Field(
        "Speed of each mode, rad/s, shape (2,).",
        lambda b: _core.conical_pendulum_angular_speed(np.asarray(b.conical_height), np.asarray(b.gravity)),
        heading="speed",
        unit="rad/s",
    )
    rpm: Field[Floats] = Field(
        "Revolutions per minute, shape (2,).", lambda b: b.angular_speed * (30 / math.pi), heading="speed", unit="rpm"
    )
    conical_height: Field[Floats] = Field(
        "Conical height of the mode in which both lean the same way, and of that in which they lean opposite ways, m, shape "
        "(2,). The first is the slower one, unless the pin of the clapper is above the axle.",
        heading="height",
        unit="m",
    )
    inclination_ratio: Field[Floats] = Field(
        "Inclination of the clapper divided by that of the bell in each mode, shape (2,). If the first is 1, both swing "
        "as one piece in this mode and the bell is silent. In the other mode they never swing as one piece.",
        heading="inclination: clapper / bell",
    )
    silent_height: Field[float] = Field(
        "Conical height of the slower mode if both swing as one piece, m: the pendulum length of the clapper plus the "
        "joint.",
        fact=True,
    )
    mismatch: Field[float] = Field(
        "``h1 - (m + 1) l1 - m (a2 - l2)``, m: 0 if both swing as one piece.", fact=True
    )
    present: Field[dict[str, float]] = Field(
        "The data: ``clapper_weight``, ``clapper_centroid``, ``clapper_radius_of_gyration``, ``bell_weight``, "
        "``joint`` (from the axle of the bell to the pin of the clapper), ``bell_centroid``, "
        "``bell_radius_of_gyration``.",
        fact=True,
    )
    derivative: Field[dict[str, float]] = Field(
        "Derivative of the first inclination ratio with respect to each datum, the others constant.", fact=True
    )

    @described()
    def with_ratio(self, ratio: float) -> dict[str, float]:
        """Return the value of each datum that gives the slower mode a wanted ratio of inclinations.

        ratio: Inclination of the clapper divided by that of the bell, positive. With 1 the bell is silent. To keep it
            ringing, choose a ratio far enough from 1.
        returns: The values nearest to the present ones, each with the other data constant; NaN if no value gives the
            ratio.
        raises: If `ratio` is not positive and finite.

        How far below the axle must the pin of the clapper be, so that the clapper swings 1.5 times as far as the bell?

        >>> links = {"weight": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> chain = rc.Chain(**links, radius_of_gyration=[0.08, 0.3])
        >>> round(rc.bell_and_clapper(chain).with_ratio(1.5)["joint"], 4)
        0.1928
        """
        wanted = real("revchain.BellAndClapper.with_ratio", "ratio", ratio)
        values = _core.bell_and_clapper_with_ratio(self.system._compiled, wanted, self.present["joint"])
        return dict(zip(_core.BELL_DATA, values, strict=True))

    @described()
    def strike_amplitude(self, clearance: float) -> float:
        """Return the smallest amplitude of the bell at which the clapper reaches its side, for small swings.

        returns: ``clearance / abs(inclination_ratio[0] - 1)``, rad: infinite if both swing as one piece. It is exact
            in the limit of small swings in the slower mode; above half a radian use `first_strike`.
        raises: If the clearance is not between 0 and pi / 2.

        >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> bell = rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.3]))
        >>> round(bell.strike_amplitude("3 deg"), 4)
        0.2226
        """
        gap = _clearance("revchain.BellAndClapper.strike_amplitude", clearance)
        apart = abs(float(self.inclination_ratio[0]) - 1)
        return gap / apart if apart else math.inf

    @described("angles and speeds to 1e-8 of their size, by integration")
    def first_strike(self, clearance: float, *, amplitude: float | None = None) -> Strike:
        """Return the first blow of the clapper in a swing of the bell; needs SciPy.

        amplitude: Angle from which the bell is released at rest, rad, up to pi; the clapper hangs free or rests on
            the lower side. If left out, the bell is rung full circle, as in English towers: it falls from the
            balance, mouth up, with the clapper on the trailing side.
        returns: The first blow up to the next turn of the bell.
        raises: If the clearance is not between 0 and pi / 2, or the amplitude not between 0 and pi.
        notes: Bell and clapper are a double pendulum in a plane, without friction, rope or stay; the headstock is
            stiff. The clapper rests on the side of the bell while the bell pushes it, then flies free. Bounces after
            the first blow are not computed, because they depend on the metals. The design charts of Woodhouse et al.
            (2012), doi:10.1155/2012/681787, use the same model for a bell much heavier than its clapper: the result
            then depends on ``joint / l1`` and ``l2 / l1`` only. If ``l2 = l1 + joint``, a clapper that hangs in the
            middle stays there. For any weights that condition is `mismatch` = 0, Greenhill (1908), section 8 (16).
            Without SciPy an ImportError says how to install it.

        >>> links = {"mass": [18, 500], "length": [0.65, 0.15], "centroid": [0.52, 0.2]}
        >>> bell = rc.bell_and_clapper(rc.Chain(**links, radius_of_gyration=[0.08, 0.3]))
        >>> blow = bell.first_strike("27 deg")
        >>> blow.side, round(blow.bell_angle, 3), round(blow.relative_speed, 2)
        ('leading', 1.851, 2.52)
        """
        caller = "revchain.BellAndClapper.first_strike"
        gap = _clearance(caller, clearance)
        from_angle = None if amplitude is None else real(caller, "amplitude", amplitude)
        if from_angle is not None and not 0 < from_angle <= math.pi:
            raise ValueError(f"{caller}: amplitude must be between 0 and pi, got {shown(from_angle)}")
        require("scipy", "fit", "the first strike of a clapper")
        return _first_strike(self.present, gap, from_angle, self.gravity)


def _clearance(caller: str, clearance: float) -> float:
    angle = real(caller, "clearance", clearance)
    if not 0 < angle < math.pi / 2:
        raise ValueError(f"{caller}: clearance must be between 0 and pi / 2, got {shown(angle)}")
    return angle


@described("2 ulp of heights and ratios; derivatives 1e-15 of the largest", "section 8 (14)-(16)", "O(1)")
def bell_and_clapper(chain: Chain, *, joint: float | None = None, gravity: float = STANDARD_GRAVITY) -> BellAndClapper:
    """Return the modes of a bell and its clapper, and how far they are from swinging as one piece.

    chain: Two links, both with weight: the clapper, and above it the bell. The length of the bell is the distance
        from its axle to the pin of the clapper; the length of the clapper has no effect.
    joint: Distance of the clapper's pin below the axle, m, instead of the length of the bell; negative above the axle, 0 in
        it: then each swings alone
    returns: Heights, ratios of inclinations, and how they change with the data.
    raises: If the chain does not have two links with weight, or `gravity` is not positive. A TypeError if `chain` is
        not a `Chain`.
    notes: The ratio r of the inclination of the clapper to that of the bell is a root of
        ``h1 r^2 - ((m + 1) l1 - m l2 - a2) r - (m + 1) a2 = 0``, one positive and one negative. The conical height is
        ``l1 + a2 / r``. This holds for small inclinations, and for any inclination if both swing as one piece.

    The ratio grows with the distance of the centre of gravity of the bell below the axle:

    >>> chain = rc.Chain(weight=[18, 500], length=[0.65, 0.15], centroid=[0.52, 0.2], radius_of_gyration=[0.08, 0.3])
    >>> rc.bell_and_clapper(chain).derivative["bell_centroid"] > 0
    True

    A pin 3 cm above the axle:

    >>> rc.bell_and_clapper(chain, joint=-0.03).angular_speed.round(5)
    array([4.29499, 3.87118])
    """
    caller = "revchain.bell_and_clapper"
    height, ratio, silent, mismatch, present, derivative = _core.bell_and_clapper(
        compiled(caller, chain), None if joint is None else real(caller, "joint", joint)
    )
    found = {"conical_height": np.asarray(height), "inclination_ratio": np.asarray(ratio), "silent_height": silent}
    found |= {"mismatch": mismatch, "present": dict(zip(_core.BELL_DATA, present, strict=True))}
    found["derivative"] = dict(zip(_core.BELL_DATA, derivative, strict=True))
    return BellAndClapper._made(None, system=chain, gravity=one_positive(caller, "gravity", gravity), **found)


# ---- the plane motion up to the first blow, integrated by SciPy

_NEAR = 1e-4  # rad: distance from the balance at which a full circle begins


class _Pair:
    """Bell and clapper: angles theta and psi to the downward vertical; forces in weights, times in sqrt(m)."""

    def __init__(self, data: dict[str, float]) -> None:
        clapper, bell, self.joint = data["clapper_weight"], data["bell_weight"], data["joint"]
        h1, h2 = data["clapper_centroid"], data["bell_centroid"]
        self.clapper_inertia = clapper * (h1 * h1 + data["clapper_radius_of_gyration"] ** 2)
        self.bell_inertia = bell * (h2 * h2 + data["bell_radius_of_gyration"] ** 2) + clapper * self.joint**2
        self.coupling = clapper * self.joint * h1
        self.clapper_moment, self.bell_moment = clapper * h1, bell * h2 + clapper * self.joint

    def free(self, _: float, state: Floats) -> Floats:
        """Rates of theta, psi and their speeds by Lagrange's equations, for a clapper in free flight."""
        theta, psi, spin, swing = state
        cosine, sine = self.coupling * math.cos(psi - theta), self.coupling * math.sin(psi - theta)
        of_bell = sine * swing * swing - self.bell_moment * math.sin(theta)
        of_clapper = -sine * spin * spin - self.clapper_moment * math.sin(psi)
        determinant = self.bell_inertia * self.clapper_inertia - cosine * cosine
        return np.array([
            spin,
            swing,
            (self.clapper_inertia * of_bell - cosine * of_clapper) / determinant,
            (self.bell_inertia * of_clapper - cosine * of_bell) / determinant,
        ])

    def resting(self, angle: float) -> Callable[[float, Floats], Floats]:
        """Rates while the clapper rests at this angle in the bell."""

        def rates(_: float, state: Floats) -> Floats:
            turn = self.together(angle, state)
            return np.array([state[2], state[3], turn, turn])

        return rates

    def inertia(self, angle: float) -> float:
        """Moment of inertia of both about the axle while the clapper rests at this angle in the bell."""
        return self.bell_inertia + self.clapper_inertia + 2 * self.coupling * math.cos(angle)

    def together(self, angle: float, state: Floats) -> float:
        """Return the angular acceleration of bell and clapper as one body."""
        return -self.moment(angle, float(state[0])) / self.inertia(angle)

    def moment(self, angle: float, theta: float) -> float:
        """Moment of gravity about the axle on both as one body; positive if it drives the bell to smaller angles."""
        return self.bell_moment * math.sin(theta) + self.clapper_moment * math.sin(theta + angle)

    def push(self, angle: float, state: Floats) -> float:
        """Moment of the side of the bell on a clapper that rests on it; positive towards larger angles."""
        turn, (theta, _, spin, _) = self.together(angle, state), state
        inertia = self.clapper_inertia + self.coupling * math.cos(angle)
        weight = self.clapper_moment * math.sin(theta + angle)
        return float(inertia * turn + self.coupling * math.sin(angle) * spin**2 + weight)

    def balance(self, angle: float) -> float:
        """Angle of the bell, mouth up, at which both as one body are in balance."""
        from scipy.optimize import brentq

        return float(brentq(lambda theta: self.moment(angle, theta), math.pi / 2, 3 * math.pi / 2, xtol=1e-15))


def _event(function: Callable[..., float], direction: float) -> Any:
    """An event that ends the integration when the function passes 0 in the given direction."""
    event: Any = function
    event.terminal, event.direction = True, direction
    return event


def _first_strike(data: dict[str, float], clearance: float, amplitude: float | None, gravity: float) -> Strike:
    """Integrate the motion up to the first blow; the bell falls from a positive angle."""
    from scipy.integrate import solve_ivp

    pair = _Pair(data)
    side = 1.0 if amplitude is None else -1.0  # where the clapper rests at first, in units of the clearance
    if amplitude is None:
        theta = pair.balance(clearance) - _NEAR
        slope = -(pair.bell_moment * math.cos(theta) + pair.clapper_moment * math.cos(theta + clearance))
        spin = -_NEAR * math.sqrt(slope / pair.inertia(clearance))
        state = np.array([theta, theta + clearance, spin, spin])
    elif amplitude > clearance:
        state = np.array([amplitude, amplitude - clearance, 0.0, 0.0])
    else:
        side, state = 0.0, np.array([amplitude, 0.0, 0.0, 0.0])
    precise: dict[str, Any] = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-12, "max_step": 0.2}
    end, time = 1e3, 0.0

    turns = _event(lambda at, state: state[2] if at > 1e-3 else -1.0, 1.0)  # the bell, after it has fallen
    while True:
        if side:
            angle = side * clearance
            lifts = _event(lambda _, state, angle=angle: math.copysign(1, angle) * pair.push(angle, state), 1.0)
            if lifts(0.0, state) < 0:
                found = solve_ivp(pair.resting(angle), (time, end), state, events=[lifts, turns], **precise)
                time, state = found.t[-1], found.y[:, -1]
                if not found.t_events[0].size:
                    break
        touch = [_event(lambda _, state, at=at: state[1] - state[0] - at * clearance, at) for at in (-1.0, 1.0)]
        found = solve_ivp(pair.free, (time, end), state, events=[*touch, turns], **precise)
        time, state = found.t[-1], found.y[:, -1]
        struck = -1.0 if found.t_events[0].size else 1.0 if found.t_events[1].size else 0.0
        if not struck:
            break
        per_second = math.sqrt(gravity)
        speed = -(state[3] - state[2]) * per_second
        if struck == side and abs(speed) < 1e-6 * per_second:
            continue
        side_struck = "leading" if struck < 0 else "trailing"
        return Strike(True, side_struck, -float(state[0]), float(speed), float(time / per_second))
    return Strike(False, "", math.nan, math.nan, math.nan)
