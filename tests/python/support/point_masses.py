# SPDX-License-Identifier: GPL-3.0-or-later
"""Small motions about steady shapes in 55 digits, with nothing of the library's: each link as one or two point masses, a
support on the axis, on an arm, on a spring or both. Shapes are refined to all digits. Times in 1/n, gravity is the height."""

import mpmath as mp
import numpy as np

import revchain as rc


def random_system(rng, spread, rigged):
    """A chain of 1 to 4 links, masses 10^U(-spread, spread), perhaps on an arm or a spring; and a height for it."""
    size = int(rng.integers(1, 5))
    mass, length = 10 ** rng.uniform(-spread, spread, size), 10 ** rng.uniform(-1, 1, size)
    bodies = rng.random() < 0.6
    share, turn = rng.uniform(0.05, 1.5, size), rng.uniform(0.01, 1.0, size)
    chain = rc.Chain(weight=mass, length=length, centroid=length * share if bodies else None,
                     radius_of_gyration=length * turn if bodies else None)  # fmt: skip
    kind = int(rng.integers(0, 3)) if rigged else -1
    radius = float(length.sum() * rng.uniform(0, 1)) if kind in (0, 2) else 0.0
    spring = {}
    if kind > 0:
        spring = {"stiffness": float(mass.sum() / length.sum() * 10 ** rng.uniform(-3, 3)),
                  "weight": float(10 ** rng.uniform(-spread, spread))}  # fmt: skip
    top = rc.modes(chain).conical_height
    height = float(top[rng.integers(0, top.size)] * 10 ** rng.uniform(-1.5, -0.05))
    return rc.Rig(chain, support=rc.Support(radius=radius, **spring)), height


def points_of(chain):
    """Weights of points, and how far each moves with a unit vector along each link."""
    found = []
    for m in range(len(chain)):
        spread = float(chain.radius_of_gyration[m])
        for sign in (1, -1) if spread else (0,):
            arm = [mp.mpf(float(x)) * (k > m) for k, x in enumerate(chain.length)]
            arm[m] = mp.mpf(float(chain.centroid[m])) + sign * mp.mpf(spread)
            found.append((mp.mpf(float(chain.weight[m])) / (2 if sign else 1), arm))
    return found


def scaled_signs(stiffness, inertia):
    unit = [1 / mp.sqrt(abs(stiffness[i, i]) + inertia[i, i]) for i in range(stiffness.rows)]
    each = [[stiffness[i, j] * unit[i] * unit[j] for j in range(stiffness.rows)] for i in range(stiffness.rows)]
    return mp.eigsy(mp.matrix(each), eigvals_only=True)


def small_motions(rig, shape, frame):
    """The exponents, without those of a rotation, and the number of negative directions."""
    with mp.workdps(55):
        size, height = len(rig), mp.mpf(float(shape.conical_height))
        points, support = points_of(rig.chain), rig.support
        slides, arm = bool(np.isfinite(support.stiffness)), mp.mpf(float(support.radius))
        stiff, carriage = (mp.mpf(float(support.stiffness)) * height, mp.mpf(float(support.weight))) if slides else (0, 0)
        count = size + slides
        x = [mp.mpf(float(t)) for t in shape.inclination] + [mp.mpf(float(shape.offset[-1]))] * slides
        for _ in range(12):
            s, c, top = [mp.sin(t) for t in x[:size]], [mp.cos(t) for t in x[:size]], x[size] if slides else arm
            left, slope = [mp.mpf(0)] * count, mp.zeros(count)
            for weight, d in points:
                y = top + mp.fsum(d[k] * s[k] for k in range(size))
                along = [d[k] * c[k] for k in range(size)] + [mp.mpf(1)] * slides
                for m in range(size):
                    left[m] += weight * d[m] * (y * c[m] - height * s[m])
                    slope[m, m] -= weight * d[m] * (y * s[m] + height * c[m])
                if slides:
                    left[size] += weight * y
                for m in range(count):
                    for k in range(count):
                        slope[m, k] += weight * along[m] * along[k]
            if slides:
                left[size] += carriage * x[size] - stiff * (x[size] - arm)
                slope[size, size] += carriage - stiff
            change = mp.lu_solve(slope, mp.matrix(left))
            x = [x[i] - change[i] for i in range(count)]
            if max(map(abs, change)) < mp.mpf(10) ** -48:
                break
        assert max(abs(float(t) - u) for t, u in zip(x, shape.inclination, strict=False)) < 1e-12
        assert not slides or abs(float(x[size]) - shape.offset[-1]) <= 1e-14 * max(abs(shape.offset))

        s, c, top = [mp.sin(t) for t in x[:size]], [mp.cos(t) for t in x[:size]], x[size] if slides else arm
        A, B, M, K, C = (mp.zeros(count) for _ in range(5))
        for weight, d in points:
            y = top + mp.fsum(d[k] * s[k] for k in range(size))
            across = [d[k] * c[k] for k in range(size)] + [mp.mpf(1)] * slides
            up = [d[k] * s[k] for k in range(size)] + [mp.mpf(0)] * slides
            out = [*d, mp.mpf(1)] if slides else d
            for i in range(count):
                for j in range(count):
                    A[i, j] += weight * (across[i] * across[j] + up[i] * up[j])
                    B[i, j] += weight * across[i] * out[j]
                    M[i, j] += weight * out[i] * out[j]
                    K[i, j] -= weight * across[i] * across[j]
                    C[i, j] -= weight * out[i] * out[j]
            for m in range(size):
                pull = weight * d[m] * (y * s[m] + height * c[m])
                K[m, m] += pull
                C[m, m] += pull
        if slides:
            for form, value in ((A, carriage), (B, carriage), (M, carriage), (K, stiff - carriage), (C, stiff - carriage)):
                form[size, size] += value
        if frame == "driven":
            squares = mp.eig(-(A**-1) * K, left=False, right=False)
            negative = sum(t < 0 for t in scaled_signs(K, A))
        else:
            rotates = support.radius == 0
            inside = K
            if rotates:
                whole = mp.matrix(s + [top] * slides)
                moved = B * whole
                inside = K + 4 * moved * moved.T / (whole.T * M * whole)[0]
            negative = sum(t < 0 for t in scaled_signs(inside, A))
            negative += sum(t < -mp.mpf(10) ** -40 for t in scaled_signs(C, M))
            # x and r = M y' + 2 B'x:  x'' = A^-1 (2 B M^-1 (r - 2 B'x) - K x),  r'' = -C M^-1 (r - 2 B'x)
            ways, matrix = B * M**-1, mp.zeros(2 * count)
            matrix[:count, :count] = -(A**-1) * (K + 4 * ways * B.T)
            matrix[:count, count:] = 2 * A**-1 * ways
            matrix[count:, :count] = 2 * C * ways.T
            matrix[count:, count:] = -C * M**-1
            squares = sorted(mp.eig(matrix, left=False, right=False), key=abs)[rotates:]
        roots = [mp.sqrt(t) for t in squares]
        return roots + [-t for t in roots], int(negative)
