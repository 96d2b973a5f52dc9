# SPDX-License-Identifier: GPL-3.0-or-later
"""The plane motion of a bell and its clapper up to the first blow, integrated by SciPy."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from ..systems.numbers import Floats

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
        """Angular acceleration of both as one body."""
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
        return float(brentq(lambda theta: self.moment(angle, theta), math.pi / 2, 3 * math.pi / 2, xtol=1e-15))


def _event(function: Callable[..., float], direction: float) -> Any:
    """An event that ends the integration when the function passes 0 in the given direction."""
    event: Any = function
    event.terminal, event.direction = True, direction
    return event


def first_strike(
    data: dict[str, float], clearance: float, amplitude: float | None, gravity: float
) -> tuple[bool, str, float, float, float]:
    """The fields of `Strike` for `BellAndClapper.first_strike`; the bell falls from a positive angle."""
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
        return True, "leading" if struck < 0 else "trailing", -float(state[0]), float(speed), float(time / per_second)
    return False, "", math.nan, math.nan, math.nan
