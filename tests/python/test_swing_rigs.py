# SPDX-License-Identifier: GPL-3.0-or-later
"""Rigs that swing after release, against the matrix exponential of their first-order system in 40 digits."""

import mpmath as mp
import numpy as np
import pytest
import rigs
from rigs import G, random_chain, rigged

import revchain as rc

KINDS = {
    "spring": {"stiffness": 9.0, "carriage": 0.7},
    "fluid": {"displaced": True, "added": True},
    "spring in a fluid": {"stiffness": 20.0, "carriage": 2.0, "displaced": True, "added": True},
    "wheels": {"momentum": True, "axial_moment": True},
    "wheels on a spring in a fluid": {"stiffness": 9.0, "carriage": 0.4, "momentum": True, "displaced": True, "added": True},
}


def random_rig(rng, size, kind):
    chain = random_chain(rng, size, spread=0.7)
    given = dict(KINDS[kind])
    for name, most in (("displaced", 0.7), ("added", 1.0), ("momentum", 0.5), ("axial_moment", 0.1)):
        if name in given:
            given[name] = chain.weight * rng.uniform(0, most, size)
    return rigged(chain, **given)


def exactly(rig, offset, velocity, times):
    """Offsets, velocities and the energy: M u'' / g - i P u' + K u = 0; wheels do not turn with their links."""
    with mp.workdps(40):
        plain = rc.Rig(rig.chain, support=rig.support, displaced=rig.displaced, fluid=rig.fluid, inverted=rig.inverted)
        stiff, _, mass = (mp.matrix(x) for x in rigs.pencil(plain))
        spin = mp.matrix(rigs.pencil(rig)[1])
        n, g = stiff.rows, mp.mpf(G)
        inverse = mass**-1
        big = mp.zeros(2 * n)
        below, right = -g * inverse * stiff, g * inverse * spin
        for i in range(n):
            big[i, n + i] = 1
            for j in range(n):
                big[n + i, j], big[n + i, n + j] = below[i, j], mp.mpc(0, right[i, j])
        start = mp.matrix([mp.mpc(complex(x)) for x in [*offset[:n], *velocity[:n]]])
        found = []
        for t in times:
            state = mp.expm(big * mp.mpf(t)) * start
            found.append([complex(x) for x in state])
        u, v = start[:n], start[n:]
        energy = (v.H * mass * v / g + u.H * stiff * u)[0] / 2
    return np.array(found)[:, :n], np.array(found)[:, n:], float(mp.re(energy))


@pytest.mark.parametrize("kind", KINDS)
def test_against_the_matrix_exponential(kind):
    rng, times = np.random.default_rng(len(kind)), [0.0, 0.4, -1.3, 3.0]
    for size in (1, 2, 3):
        rig = random_rig(rng, size, kind)
        moving = size + ("spring" in kind)
        offset, velocity = np.zeros((2, size + 1), dtype=complex if "wheels" in kind else float)
        for start in (offset, velocity):
            start[:moving] = rng.uniform(-0.1, 0.1, moving)
            if "wheels" in kind:
                start[:moving] += 1j * rng.uniform(-0.1, 0.1, moving)
        found = rc.swing(rig, times, offset=offset, velocity=velocity)
        assert type(found) is rc.Swing and (found.offset.dtype.kind == "c") == ("wheels" in kind)
        y, v, energy = exactly(rig, offset, velocity, times)
        np.testing.assert_allclose(found.energy.sum(), energy, rtol=1e-13)
        assert found.energy_left_out < 1e-25 * energy
        bound = found.error_bound[:, None] + found.truncation_error
        assert np.all(np.abs(found.offset[:, :moving] - y) <= bound[:, :moving])
        assert bound.max() < 1e-13
        np.testing.assert_allclose(found.velocity[:, :moving], v, atol=1e-14 * np.abs(v).max())
        assert np.all(found.offset[:, moving:] == 0)


def test_whirls_are_the_modes():
    rng = np.random.default_rng(5)
    rig = random_rig(rng, 3, "wheels")
    plain = rc.Rig(rig.chain, flywheels=rc.Flywheel(momentum=rig.flywheels.momentum))
    found, modes = rc.swing(rig, 1.0, offset=[0.1, 0.0, 0.1]), rc.modes(plain, "all")
    np.testing.assert_allclose(np.sort(found.angular_frequency), np.sort(modes.angular_speed), rtol=1e-15)
    few = rc.swing(rig, 1.0, offset=[0.1, 0.0, 0.1], count=2)
    np.testing.assert_array_equal(few.angular_frequency, found.angular_frequency[:2])
    assert np.all(np.abs(few.offset - found.offset)[0] <= few.truncation_error + few.error_bound[0] + found.error_bound[0])


def test_by_mass_and_by_weight():
    mass, g = np.array([1.0, 2.0]), 3.7
    given = dict(length=[0.5, 0.7], centroid=[0.3, 0.4], radius_of_gyration=[0.1, 0.2])
    one = rc.Rig(rc.Chain(mass=mass, **given), support=rc.Support(stiffness=50.0, mass=0.3),
                 flywheels=rc.Flywheel(mass=0.5, radius_of_gyration=0.2, spin=30.0, driven=True))  # fmt: skip
    two = rc.Rig(rc.Chain(weight=g * mass, **given), support=rc.Support(stiffness=50.0, weight=0.3 * g),
                 flywheels=rc.Flywheel(weight=0.5 * g, radius_of_gyration=0.2, spin=30.0, driven=True))  # fmt: skip
    a, b = (rc.swing(rig, [0.0, 2.0], offset=[0.1, 0.05j, 0.02], velocity=[0.0, 1.0], gravity=g) for rig in (one, two))
    np.testing.assert_allclose(a.offset, b.offset, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(a.energy, b.energy, rtol=1e-12)


def test_pictures():
    pytest.importorskip("matplotlib")
    rig = random_rig(np.random.default_rng(2), 2, "wheels")
    found = rc.swing(rig, np.linspace(0, 3, 50), offset=[0.1, 0.0])
    assert found.plot().get_xlabel() == "x (m)"
    assert len(found.plot(kind="time", pins=[0, 1]).lines) == 4
    with pytest.raises(ValueError, match="kind"):
        found.plot(kind="shapes")
    with pytest.raises(ValueError, match="pins must be numbers from 0 to 2, got 3"):
        found.plot(pins=[3])
    spring = rc.swing(rc.Rig(rig.chain, support=rc.Support(stiffness=9.0)), [0.0, 1.0], offset=[0.1, 0.0])
    assert spring.plot().get_ylabel() == "depth below the support (m)"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"radius": 0.1}, "use response, got 0.1"),
        ({"displaced": 0.1, "fluid": "turning"}, 'rest: write "still", got 0.1'),
        ({"inverted": [False, True]}, "growth rate of small offsets from the straight rig must be 0"),
        ({"displaced": [5.0, 0.0]}, "growth rate of small offsets"),
    ],
)
def test_refusals(given, message):
    with pytest.raises(ValueError, match=message) as error:
        rc.swing(rigged(rc.Chain(weight=1.0, length=[0.5, 0.7]), **given), 1.0, offset=[0.1, 0.0])
    assert str(error.value).startswith("revchain.swing: ")


def test_complex_starts_need_momentum():
    for system in (rc.Chain(weight=1.0, length=[0.5, 0.7]), rigged(rc.Chain(weight=1.0, length=[0.5, 0.7]), stiffness=3.0)):
        with pytest.raises(ValueError, match="offset must be real: without momentum"):
            rc.swing(system, 1.0, offset=[0.1, 0.1j])
    plummets = rigged(rc.Chain(weight=1.0, length=[0.5, 0.7]), stiffness=3.0, momentum=0.1)
    with pytest.raises(ValueError, match="pins without inertia beside flywheels"):
        rc.swing(plummets, 1.0, offset=[0.1, 0.1])
