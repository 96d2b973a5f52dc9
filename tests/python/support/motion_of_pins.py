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

    def drawn(self, place, pull):
        """Forces of the links on the coordinates that move; `pull` is that over the length."""
        along, force = pull[..., None] * np.diff(place, axis=-2), np.zeros_like(place)
        force[..., :-1, :] += along
        force[..., 1:, :] -= along
        return force.reshape(*force.shape[:-2], -1)[..., self.moves]

    def rate(self, state):
        """Of places and velocities; the links' pulls keep their lengths."""
        moving, speeds = np.split(state, 2, axis=-1)
        place, velocity = self.all_pins(moving, self.rest), self.all_pins(speeds, 0 * self.rest)
        force, rows = self.forces(place, velocity), self.slopes(place)
        weighed = rows @ self.inverse
        turning = (np.diff(velocity, axis=-2) ** 2).sum(axis=-1)
        wanted = turning + (weighed @ force[..., None])[..., 0]
        pull = np.linalg.solve(weighed @ np.swapaxes(rows, -1, -2), wanted[..., None])[..., 0]
        return np.concatenate([speeds, (force + self.drawn(place, pull)) @ self.inverse], axis=-1)

    def turned(self):
        """What a turn about the axis does to places, and how places alone change the angular momentum."""
        across, inward = np.zeros_like(self.rest), np.zeros_like(self.rest)
        across[:, 1] = self.rest[:, 0]
        inward[:, 0] = 2 * self.speed * self.masses @ self.rest[:, 0]
        return across.ravel()[self.moves], inward.ravel()[self.moves]

    def kept(self):
        """Rows of what a small disturbance leaves as it is: lengths, and, about an axis with no arm, momentum and direction."""
        rows = self.slopes(self.rest)
        kept = [np.hstack([rows, 0 * rows]), np.hstack([0 * rows, rows])]
        if self.rotates:
            across, inward = self.turned()
            kept += [np.concatenate([across, 0 * across]), np.concatenate([inward, self.inertia @ across])]
        return np.vstack(kept)

    # ---- small disturbances

    def stiffness(self):
        """Second derivatives of the energy in the frame that turns, lengths kept: between all coordinates that move."""
        still = 0 * self.rest
        pull = np.linalg.lstsq(self.slopes(self.rest).T, self.forces(self.rest, still), rcond=None)[0]
        size = self.moves.size
        place = self.all_pins(self.start[:size] + TINY * 1j * np.eye(size), self.rest)
        return -(self.forces(place, 0 * place) + self.drawn(place, pull)).imag / TINY

    def negative_directions(self):
        """Of the energy; about an axis with no arm at the same angular momentum."""
        stiff, rows = self.stiffness(), self.slopes(self.rest)
        if self.rotates:
            across, inward = self.turned()
            stiff += np.outer(inward, inward) / (across @ self.inertia @ across)
            rows = np.vstack([rows, across])
        basis = null_space(rows)
        return int((np.linalg.eigvalsh(basis.T @ stiff @ basis) < 0).sum())

    def first_order(self):
        """Rates of the disturbances of `basis` without integration, for many links."""
        size = self.moves.size
        tangent = null_space(self.slopes(self.rest))
        follow = tangent @ np.linalg.solve(tangent.T @ self.inertia @ tangent, tangent.T)
        velocity = self.all_pins(TINY * 1j * np.eye(size), 0 * self.rest)
        coriolis = self.forces(0 * velocity, velocity).imag / TINY
        rates = np.zeros((2 * size, 2 * size))
        rates[:size, size:] = np.eye(size)
        rates[size:, :size] = -follow @ self.stiffness()
        rates[size:, size:] = follow @ coriolis.T
        return self.basis.T @ rates @ self.basis

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
        """What one step does to disturbances, and its time: a tenth over the fastest of them."""
        time = 0.1 / fastest_of(self.linear(self.rate))
        return self.linear(lambda state: self.step(state, time)), time

    def growth_rate(self):
        """Of the disturbance that grows most, and how fast the fastest goes; both over the speed."""
        power, time = self.one_step()
        return growth_rate(power, time) / self.speed, 0.1 / (time * self.speed)

    # ---- disturbances that are not small

    def on_lengths(self, state):
        """The nearest state with the lengths of the links."""
        moving, speeds = np.split(state, 2)
        for _ in range(3):
            place = self.all_pins(moving, self.rest)
            rows, off = self.slopes(place), ((np.diff(place, axis=0) ** 2).sum(axis=1) - self.length**2) / 2
            moving = moving - np.linalg.lstsq(rows, off, rcond=None)[0]
        rows = self.slopes(self.all_pins(moving, self.rest))
        return np.concatenate([moving, speeds - np.linalg.lstsq(rows, rows @ speeds, rcond=None)[0]])

    def after(self, disturbance, times):
        """Disturbances at equally spaced times, from one at 0: the motion itself, brought back to the lengths each time."""
        state, found = self.on_lengths(self.start + self.basis @ disturbance), []
        for pause in np.diff(times, prepend=0.0):
            done = solve_ivp(lambda _, y: self.rate(y), (0.0, pause), state, "DOP853", rtol=1e-12, atol=1e-15)
            state = self.on_lengths(done.y[:, -1])
            found.append(self.basis.T @ (state - self.start))
        return np.array(found)


def fastest_of(rates):
    """The size of the largest exponent, a little too large."""
    return np.linalg.norm(np.linalg.matrix_power(rates, 16)) ** (1 / 16)


def growth_rate(power, time, doublings=40):
    """What the largest disturbance grows by in a unit of time, from one step: its time is doubled over and over, and the
    last doubling tells."""
    logarithm, before = 0.0, 0.0
    for _ in range(doublings):
        power = power @ power
        size = np.linalg.norm(power)
        power /= size
        logarithm, before = 2 * logarithm + math.log(size), logarithm
    return (logarithm - before) / (2.0 ** (doublings - 1) * time)
