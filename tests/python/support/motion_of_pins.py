# SPDX-License-Identifier: GPL-3.0-or-later
"""Motions of chains held at both ends, with nothing of the library's: pins in Cartesian coordinates in the frame that turns,
lengths of links as constraints with multipliers, integrated step by step."""

import math

import numpy as np
from ends import Pins
from scipy.integrate import DOP853, solve_ivp

TINY = 1e-30  # a complex step: derivatives without differences


def null_space(rows):
    """An orthonormal basis, by columns, of what all rows leave unchanged."""
    _, values, basis = np.linalg.svd(rows)
    return basis[(values > 1e-9 * values[0]).sum() :].T


class Motion:
    """Links with straight, thin bodies: their kinetic energy is quadratic in the velocities of their pins, with constant
    coefficients. `free`: pins move in space; `driven`: hinges keep them in the plane of the shape."""

    def __init__(self, held, offset, height, speed, frame):
        pins = Pins(held, speed)
        self.links, self.speed, self.length = pins.n, speed, np.array(pins.a)
        self.masses, self.weight, self.spring = np.array(pins.mass), np.array(pins.weight), np.array(pins.spring)
        self.radius, self.rest = np.array(pins.rest), np.column_stack([offset, 0 * offset, height])
        allowed = np.zeros((pins.n + 1, 3), bool)
        allowed[1:-1] = True
        allowed[pins.free_y, :2] = True
        allowed[:, 1] &= frame == "free"
        self.moves = np.flatnonzero(allowed)
        self.inertia = np.kron(self.masses, np.eye(3))[np.ix_(self.moves, self.moves)]
        self.inverse = np.linalg.inv(self.inertia)
        self.rotates = frame == "free" and held.lower.radius == held.upper.radius == 0
        self.start = np.concatenate([self.rest.ravel()[self.moves], np.zeros(self.moves.size)])
        self.basis = null_space(self.kept())

    def all_pins(self, moving, at_rest):
        """Vectors of all pins from the coordinates that move."""
        full = np.empty((*moving.shape[:-1], at_rest.size), moving.dtype)
        full[...] = at_rest.ravel()
        full[..., self.moves] = moving
        return full.reshape(*moving.shape[:-1], self.links + 1, 3)

    def slopes(self, place):
        """Derivatives of half the squares of the lengths by the coordinates that move."""
        step, link = np.diff(place, axis=-2), np.arange(self.links)
        rows = np.zeros((*step.shape[:-1], self.links + 1, 3), place.dtype)
        rows[..., link, link + 1, :], rows[..., link, link, :] = step, -step
        return rows.reshape(*step.shape[:-1], -1)[..., self.moves]

    def forces(self, place, velocity):
        """All but those of the constraints, on the coordinates that move: weight, springs, centrifugal, Coriolis."""
        apparent = self.speed**2 * place
        apparent[..., 0] += 2 * self.speed * velocity[..., 1]
        apparent[..., 1] -= 2 * self.speed * velocity[..., 0]
        apparent[..., 2] = 0
        force = self.masses @ apparent
        force[..., 0] -= self.spring * (place[..., 0] - self.radius)
        force[..., 1] -= self.spring * place[..., 1]
        force[..., 2] -= self.weight
        return force.reshape(*force.shape[:-2], -1)[..., self.moves]

    def rate(self, state):
        """Of places and velocities; the multipliers keep the lengths."""
        moving, speeds = np.split(state, 2, axis=-1)
        place, velocity = self.all_pins(moving, self.rest), self.all_pins(speeds, 0 * self.rest)
        force, rows = self.forces(place, velocity), self.slopes(place)
        weighed = rows @ self.inverse
        turning = (np.diff(velocity, axis=-2) ** 2).sum(axis=-1)
        wanted = -turning - (weighed @ force[..., None])[..., 0]
        pull = np.linalg.solve(weighed @ np.swapaxes(rows, -1, -2), wanted[..., None])
        whole = force + (pull[..., None, :, 0] @ rows)[..., 0, :]
        return np.concatenate([speeds, whole @ self.inverse], axis=-1)

    def kept(self):
        """Rows of what a small disturbance leaves as it is: lengths, and, about an axis with no arm, momentum and direction."""
        rows, size = self.slopes(self.rest), self.moves.size
        kept = [np.hstack([rows, 0 * rows]), np.hstack([0 * rows, rows])]
        if self.rotates:
            across = np.zeros_like(self.rest)
            across[:, 1] = self.rest[:, 0]
            inward = np.zeros_like(self.rest)
            inward[:, 0] = 2 * self.speed * self.masses @ self.rest[:, 0]
            turned = across.ravel()[self.moves]
            kept += [np.concatenate([turned, np.zeros(size)]), np.concatenate([inward.ravel()[self.moves], self.inertia @ turned])]
        return np.vstack(kept)

    def step(self, state, time):
        """One step of Dormand and Prince, of eighth order."""
        rates = []
        for row in DOP853.A[: DOP853.n_stages]:
            rates.append(self.rate(state + time * sum(a * each for a, each in zip(row, rates, strict=False) if a)))
        return state + time * sum(b * each for b, each in zip(DOP853.B, rates, strict=True))

    def linear(self, move):
        """The exact derivative of a map of states, at the shape, between disturbances of `basis`."""
        return self.basis.T @ move(self.start + TINY * 1j * self.basis.T).imag.T / TINY

    def one_step(self):
        """What one step does to disturbances, and its time: a tenth of the shortest period over 2 pi."""
        fastest = np.linalg.norm(np.linalg.matrix_power(self.linear(self.rate), 16), 2) ** (1 / 16)
        time = 0.1 / max(fastest, self.speed)
        return self.linear(lambda state: self.step(state, time)), time

    def growth(self, doublings=40):
        """Growth rate over the speed of the largest disturbance, from the last doubling of the time."""
        if not self.basis.shape[1]:
            return 0.0
        power, time = self.one_step()
        logarithm, before = 0.0, 0.0
        for _ in range(doublings):
            power = power @ power
            size = np.linalg.norm(power, 2)
            power /= size
            logarithm, before = 2 * logarithm + math.log(size), logarithm
        return (logarithm - before) / (2.0 ** (doublings - 1) * time * self.speed)
