# SPDX-License-Identifier: GPL-3.0-or-later
"""Plummets held at both ends, as points in space, with nothing of the library's: shooting from the lower end.

Each thread points along its tension, so that every shape that is found is in tension. Three numbers at the lower end are
unknown: the tension of the lowest thread or, on a spring, the place of the end across the axis and the tension along it.
"""

import math

import numpy as np


class Shooting:
    """A chain of plummets given by mass, at a speed. States are arrays of shape (k, 3): k shots at once."""

    def __init__(self, held, speed, gravity):
        self.mass, self.length = held.system.mass, held.system.length
        self.square, self.gravity = speed**2, 0.0 if held.weightless else gravity
        self.lower, self.upper, self.span = held.lower, held.upper, held.span
        self.whole = self.length.sum()
        self.force = self.mass.sum() * (self.square * self.whole + self.gravity)

    def starts(self, rng, count):
        """Random shots: tensions of any direction and of sizes over three decades."""
        way = rng.normal(size=(count, 3))
        way /= np.linalg.norm(way, axis=1)[:, None]
        shot = way * self.force * 10 ** rng.uniform(-2.5, 0.5, (count, 1))
        if self.lower.stiffness < math.inf:
            shot[:, :2] = [self.lower.radius, 0] + self.whole * rng.normal(0, 0.5, (count, 2))
        return shot

    def __call__(self, shot):
        """Places of all pins, (k, N + 1, 3); what the upper end misses, (k, 3), and its derivatives, (k, 3, 3)."""
        k, flat = len(shot), np.diag([1.0, 1.0, 0.0])
        place, place_change = np.zeros((k, 3)), np.zeros((k, 3, 3))
        pull, pull_change = shot.copy(), np.tile(np.eye(3), (k, 1, 1))
        place[:, 0] = self.lower.radius
        if self.lower.stiffness < math.inf:  # forces across the axis balance at the end
            hold = self.lower.stiffness - (self.lower.carriage + self.mass[0]) * self.square
            place[:, :2] = shot[:, :2]
            pull[:, :2] = hold * shot[:, :2] - self.lower.stiffness * np.array([self.lower.radius, 0.0])
            place_change[:], pull_change[:] = flat, np.diag([hold, hold, 1.0])
        places = [place]
        for m in range(self.mass.size):
            if m:
                pull = pull - self.mass[m] * (self.square * place @ flat - [0, 0, self.gravity])
                pull_change = pull_change - self.mass[m] * self.square * flat @ place_change
            size = np.linalg.norm(pull, axis=1)[:, None]
            way = pull / size
            turn = (np.eye(3) - way[:, :, None] * way[:, None, :]) / size[:, :, None]
            place = place + self.length[m] * way
            place_change = place_change + self.length[m] * turn @ pull_change
            places.append(place)
        miss, change = place - [self.upper.radius, 0, self.span], place_change.copy()
        if self.upper.stiffness < math.inf:
            hold = self.upper.stiffness - self.upper.carriage * self.square
            miss[:, :2] = (hold * place[:, :2] + pull[:, :2]) / self.upper.stiffness - [self.upper.radius, 0]
            change[:, :2] = (hold * place_change[:, :2] + pull_change[:, :2]) / self.upper.stiffness
        return np.stack(places, axis=1), miss, change

    def shapes(self, rng, count, rounds=60):
        """Newton's method from random starts: the different shapes that were found, places (N + 1, 3) of the pins."""
        shot, found = self.starts(rng, count), []
        with np.errstate(all="ignore"):
            for _ in range(rounds):
                places, miss, change = self(shot)
                gap = np.linalg.norm(miss, axis=1)
                for place in places[gap < 1e-12 * self.whole]:
                    place = self.turned(place)
                    if not any(np.abs(place - other).max() < 1e-6 * self.whole for other in found):
                        found.append(place)
                shot, miss, change, gap = (each[gap >= 1e-12 * self.whole] for each in (shot, miss, change, gap))
                if not len(shot):
                    break
                across = change.transpose(0, 2, 1)
                square = across @ change  # singular where a shape between ends on the axis can be turned
                square += 1e-13 * np.trace(square, axis1=1, axis2=2)[:, None, None] * np.eye(3)
                step = -np.linalg.solve(square, across @ miss[:, :, None])[:, :, 0]
                part = np.ones(len(shot))
                for _ in range(8):
                    worse = ~(np.linalg.norm(self(shot + part[:, None] * step)[1], axis=1) < gap)
                    part[worse] /= 4
                    if not worse.any():
                        break
                shot = shot + part[:, None] * step
                lost = ~np.isfinite(shot).all(axis=1) | (part < 1e-4)
                shot[lost] = self.starts(rng, lost.sum())
        return found

    def turned(self, place):
        """The same shape in a standard position: turned about the axis where the ends allow that."""
        if self.lower.radius or self.upper.radius:
            return place
        across = place[:, 0] + 1j * place[:, 1]
        farthest = across[np.abs(across).argmax()]
        if abs(farthest) > 1e-9 * self.whole:
            across = across * abs(farthest) / farthest
        first = across[1] - across[0]
        across = across if first.real >= 0 else -across  # the lowest link leads outwards
        return np.column_stack([across.real, across.imag, place[:, 2]])
