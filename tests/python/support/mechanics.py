# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains to try, and their mechanics written out here with nothing of the library's."""

import math

import mpmath as mp
import numpy as np
from hypothesis import strategies as st

import revchain as rc

KINDS = ("plummets", "rods", "massless", "long pendulums")


def random_chain(kind, count, seed):
    """Links of one of `KINDS`; the last hang by pins near their centres of gravity, above them or below."""
    rng = np.random.default_rng(seed)
    w, a = np.exp(rng.normal(0, 1, count)), np.exp(rng.normal(0, 0.6, count))
    if kind == "plummets":
        return rc.Chain(weight=w, length=a)
    if kind == "rods":
        return rc.Chain(weight=w, length=a, centroid=a / 2, radius_of_gyration=a / 12**0.5)
    if kind == "massless":
        w[1::2] = 0
        return rc.Chain(weight=w, length=a)
    return rc.Chain(weight=w, length=a, centroid=a * rng.uniform(0.2, 1.5, count),
                    radius_of_gyration=a * rng.uniform(0.2, 1.5, count))


@st.composite
def chains(draw, most=7, wild=True):
    """Chains of all kinds: plummets, rods, bodies; if wild, also with centres of gravity above or almost in the pin."""
    n = draw(st.integers(1, most))
    numbers = lambda low, high: st.lists(st.floats(low, high), min_size=n, max_size=n)  # noqa: E731
    weight = np.exp2(draw(numbers(-20.0, 20.0)))
    length = np.exp2(draw(numbers(-5.0, 5.0)))
    kind = draw(st.sampled_from(["plummets", "radius", "pendulum"]))
    if kind == "plummets":
        return rc.Chain(weight=weight, length=length)
    if not wild:
        centroid, radius = (length * np.array(draw(numbers(0.01, 1.5))) for _ in range(2))
        return rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=radius)
    below = np.concatenate([[0.0], np.cumsum(weight)[:-1]])
    highest = -0.5 * length * below / weight  # half way to standing
    share = np.array(draw(numbers(0.001, 1.5)))
    centroid = highest + share * (length - highest)
    ratio = np.array(draw(numbers(0.0, 2.0)))
    ratio[ratio < 1e-6] = 0.0  # smaller lengths than 1e-77 of the largest are refused
    if kind == "radius":
        return rc.Chain(weight=weight, length=length, centroid=centroid, radius_of_gyration=ratio * length)
    centroid = np.where(np.abs(centroid) < 1e-6 * length, 0.1 * length, centroid)
    return rc.Chain(weight=weight, length=length, centroid=centroid, pendulum_length=centroid * (1 + ratio))


def fourth_order(function, step):
    """The derivative at 0, by differences of fourth order."""
    far_below, below, above, far_above = (function(k * step) for k in (-2, -1, 1, 2))
    return (far_below - 8 * below + 8 * above - far_above) / (12 * step)


def plummets(count):
    """On threads of 1."""
    return rc.Chain.uniform_plummets(count, length=float(count))


def rods(count):
    """Of length 1."""
    return rc.Chain.uniform_rods(count, length=float(count))


def parts(chain, number=float):
    """Weights, lengths, centroids and radii of gyration."""
    columns = (chain.weight, chain.length, chain.centroid, chain.radius_of_gyration)
    return [np.array([number(float(x)) for x in column]) for column in columns]


def inertia(chain, number=float):
    """Inertia matrix A over the links' unit vectors, and first moments kappa."""
    w, a, h, rho = parts(chain, number)
    c = np.array([[number(0)] * w.size] * w.size)
    for r in range(w.size):
        c[r, r] = h[r]
        c[r, r + 1 :] = a[r + 1 :]
    return c.T @ (w[:, None] * c) + np.diag(w * rho**2), w @ c


def disturbed(chain, shape, number=float):
    """M, G and K of small disturbances of thin links in the frame that turns (in the plane, then across), times the
    square of the speed; and the second variation of the energy, with the angular momentum kept (in the plane)."""
    inert, kappa = inertia(chain, number)
    b, angle = inert / number(float(shape.conical_height)), [number(float(x)) for x in shape.inclination]
    functions = (math.sin, math.cos) if number is float else (mp.sin, mp.cos)
    s, c = (np.array([function(x) for x in angle]) for function in functions)
    diag, zero, gyro = np.diag(s * (b @ s) + kappa * c), 0 * b, 2 * c[:, None] * b
    plane, across = diag - b * np.outer(c, c), diag - b
    mass = np.block([[b * (np.outer(c, c) + np.outer(s, s)), zero], [zero, b]])
    turn = 2 * c * (b @ s)
    inside = plane + np.outer(turn, turn) / (s @ b @ s)
    return mass, np.block([[zero, -gyro], [gyro.T, zero]]), np.block([[plane, zero], [zero, across]]), inside


def scan(chain, height, hanging, starts=3000, seed=3):
    """All shapes that Newton's method finds from many random places; a lower bound on what there is."""
    inert, kappa = inertia(chain)
    count = kappa.size
    rng = np.random.default_rng(seed)
    reach = np.pi / 2 if hanging else np.pi
    d = rng.uniform(-reach, reach, (starts, count))
    half = starts // 2
    d[:half] = rng.choice([-1, 1], (half, count)) * (np.pi / 2) * (1 - rng.uniform(0, 1, (half, count)) ** 4)
    scale = np.abs(kappa) + np.abs(inert).sum(1) / height
    i = np.arange(count)
    step = residual = None
    for _ in range(50):
        s, c = np.sin(d), np.cos(d)
        force = s @ inert / height
        residual = kappa * s - c * force
        jac = -inert / height * c[:, :, None] * c[:, None, :]
        jac[:, i, i] += kappa * c + s * force + 1e-300
        step = np.clip(np.linalg.solve(jac, residual[:, :, None])[:, :, 0], -0.5, 0.5)
        d = d - step
    good = (np.abs(residual / scale).max(1) < 1e-11) & (np.abs(step).max(1) < 1e-9)
    d = (d[good] + np.pi) % (2 * np.pi) - np.pi
    d = d[np.abs(np.sin(d)).max(1) > 1e-6]
    if hanging:
        d = d[(np.abs(d) < np.pi / 2).all(1)]
    d = d * np.where(np.sin(d) @ parts(chain)[1] < 0, -1, 1)[:, None]
    return d[np.unique(d.round(6), axis=0, return_index=True)[1]]


def turned(a, b):
    """The largest angle by which inclinations differ, whole turns left out."""
    return np.abs(np.angle(np.exp(1j * (a - b)))).max(axis=-1)


def moments(chain, shape):
    """The largest moment of all that hangs below a pin, about it, over weights times lengths, from places alone; with
    the pull of a lower end that is held. Lengths of links and places of pins have to agree, too."""
    pin = np.stack([shape.offset, shape.height], axis=1)
    down = pin[:-1] - pin[1:]
    assert np.abs(np.hypot(*down.T) - chain.length).max() <= 4e-16 * chain.total_length
    down /= chain.length[:, None]
    centre = pin[1:] + chain.centroid[:, None] * down
    force = np.stack([chain.weight * centre[:, 0] / shape.conical_height, -chain.weight], axis=1)
    couple = chain.weight * chain.radius_of_gyration**2 * down[:, 0] * down[:, 1] / shape.conical_height
    held = -np.asarray(getattr(shape, "lower_pull", (0.0, 0.0)))
    whole = chain.weight.sum() * chain.total_length * (1 + chain.total_length / shape.conical_height)
    worst = 0.0
    for m in range(len(chain)):
        arm = np.vstack([pin[:1], centre[: m + 1]]) - pin[m + 1]
        pull = np.vstack([held, force[: m + 1]])
        moment = arm[:, 1] * pull[:, 0] - arm[:, 0] * pull[:, 1]
        worst = max(worst, abs(moment.sum() + couple[: m + 1].sum()) / whole)
    return worst
