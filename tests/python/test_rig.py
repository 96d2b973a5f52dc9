# SPDX-License-Identifier: GPL-3.0-or-later
"""`revchain.Rig`: what it keeps, what it refuses."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest
import revchain as rc

CHAIN = rc.Chain(weight=[1.0, 3.0], length=0.5)


def test_a_rig_keeps_what_it_is_given():
    rig = rc.Rig(
        CHAIN,
        stiffness=20.0,
        carriage_weight=2.0,
        support_radius=0.1,
        standing=[True, False],
        momentum=[0.5, 0.0],
        axial_moment=0.25,
        displaced_weight=[0.1, 0.2],
        displaced_centroid=0.3,
        displaced_radius_of_gyration=0.05,
        added_weight=0.125,
        fluid="still",
    )
    assert (rig.stiffness, rig.carriage_weight, rig.support_radius, rig.fluid) == (20.0, 2.0, 0.1, "still")
    assert rig.standing.tolist() == [True, False]
    assert rig.momentum.tolist() == [0.5, 0.0]
    assert rig.axial_moment.tolist() == [0.25, 0.25]
    assert rig.displaced_weight.tolist() == [0.1, 0.2]
    assert rig.displaced_centroid.tolist() == [0.3, 0.3]
    assert rig.displaced_radius_of_gyration.tolist() == [0.05, 0.05]
    assert rig.added_weight.tolist() == [0.125, 0.125]
    assert rig.chain is CHAIN
    assert rig.size == len(rig) == 2
    assert repr(rig) == (
        "Rig of a chain of 2 links: support of stiffness 20, carriage of weight 2, carried round at radius 0.1, "
        "1 link standing, 1 link with momentum, 2 links in still fluid"
    )


def test_what_is_left_out_is_the_chains_own_or_nothing():
    rig = rc.Rig(rc.Chain.uniform_rods(3, length=3.0))
    assert rig.stiffness == np.inf
    assert not rig.standing.any()
    assert rig.displaced_centroid.tolist() == rig.chain.centroid.tolist()
    assert rig.displaced_radius_of_gyration.tolist() == rig.chain.radius_of_gyration.tolist()
    assert repr(rig) == "Rig of a chain of 3 links: nothing added"
    assert rig == rc.Rig(rig.chain, momentum=[0, 0, 0], standing=np.zeros(3, bool))


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda rig: pickle.loads(pickle.dumps(rig))])
def test_rigs_are_values(copied):
    rig = rc.Rig(CHAIN, momentum=[0.5, -1.0], displaced_weight=0.25, standing=[False, True], fluid="turning")
    other = copied(rig)
    assert other == rig and hash(other) == hash(rig)
    assert rig != rc.Rig(CHAIN, momentum=[0.5, -1.0], displaced_weight=0.25, standing=[False, True])
    assert rig != CHAIN
    with pytest.raises(AttributeError, match="cannot be changed"):
        rig.momentum = 0.0
    with pytest.raises(ValueError):
        rig.momentum[0] = 1.0
    with pytest.raises(ValueError):
        rig.standing[0] = True


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"stiffness": 0.0}, r"stiffness of the support must be positive, got 0$"),
        ({"stiffness": np.nan}, r"stiffness of the support must be positive, got nan"),
        ({"carriage_weight": -1.0}, r"carriage weight must be finite and not negative, got -1"),
        ({"support_radius": np.inf}, r"radius of the support must be finite and not negative, got inf"),
        ({"momentum": [0.0, np.inf]}, r"link 2: momentum must be finite, got inf"),
        ({"momentum": [1.0, 2.0, 3.0]}, r"revchain\.Rig: momentum .* each of the 2 links, got shape \(3,\)"),
        ({"momentum": [[1.0, 2.0]]}, r"momentum .* got shape \(1, 2\)"),
        ({"momentum": "fast"}, r"momentum must be a real number"),
        ({"axial_moment": [-1.0, 0.0]}, r"link 1: axial moment must be finite and not negative, got -1"),
        ({"displaced_weight": -0.5}, r"link 1: weight displaced must be finite and not negative, got -0.5"),
        ({"displaced_weight": 1.0, "displaced_centroid": np.nan}, r"centre of buoyancy must be finite"),
        (
            {"displaced_weight": 1.0, "displaced_radius_of_gyration": -1.0},
            r"link 1: radius of gyration must be finite and not negative, got -1",
        ),
        ({"added_weight": -1.0}, r"added weight must be finite and not negative, got -1"),
        ({"standing": [1, 0]}, r"standing must be True, False or an array of them"),
        ({"standing": [True]}, r"one for each of the 2 links, got \[True\]"),
        ({"fluid": "air"}, r"fluid must be one of still, turning, got 'air'"),
    ],
)
def test_wrong_rigs_are_refused(given, says):
    with pytest.raises(ValueError, match=says):
        rc.Rig(CHAIN, **given)


def test_a_rig_is_of_a_chain():
    with pytest.raises(TypeError, match=r"revchain\.Rig: chain must be a revchain\.Chain, got 'chain'"):
        rc.Rig("chain")


def test_flywheels():
    free = rc.free_flywheel(weight=[9.80665, 0.0], radius_of_gyration=0.3, spin=100.0)
    assert free["momentum"] == pytest.approx([9.0, 0.0], rel=1e-15)
    assert set(free) == {"momentum"}
    driven = rc.driven_flywheel(weight=2.0, radius_of_gyration=[0.5, 1.0], spin=-3.0, gravity=1.0)
    assert driven["momentum"].tolist() == [-1.5, -6.0]
    assert driven["axial_moment"].tolist() == [0.5, 2.0]
    assert rc.Rig(CHAIN, **driven).axial_moment.tolist() == [0.5, 2.0]
    for name, value in {"weight": -1.0, "radius_of_gyration": np.nan, "spin": np.inf, "gravity": 0.0}.items():
        wheel = {"weight": 1.0, "radius_of_gyration": 1.0, "spin": 1.0, name: value}
        for make in (rc.free_flywheel, rc.driven_flywheel):
            with pytest.raises(ValueError, match=name):
                make(**wheel)
    for make in (rc.free_flywheel, rc.driven_flywheel):
        for huge in ({"weight": 1e200, "radius_of_gyration": 1e100, "spin": 0.0}, {"spin": 1e300, "weight": 1e20}):
            with pytest.raises(ValueError, match="must be finite, give a smaller radius_of_gyration, got"):
                make(**{"radius_of_gyration": 1.0, **huge})
