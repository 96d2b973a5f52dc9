# SPDX-License-Identifier: GPL-3.0-or-later
"""Chains cut from a cord of power-law density: what they remember, their cheap model, scenes and studies."""

import copy
import math
import pickle

import numpy as np
import pytest

import revchain as rc
from revchain.cli import app as _cli
from revchain.scenes.scene import SceneError

ULP = 2.0**-52


def test_no_taper_is_rods():
    chain = rc.Chain.tapered(30, 2.0, 3.0, exponent=0)
    assert chain == rc.Chain.uniform_rods(30, 2.0, 3.0) and chain.taper == 0.0
    assert rc.Chain.uniform_rods(30).taper is None


def test_the_exponent_is_remembered_and_forgotten(tmp_path):
    chain = rc.Chain.tapered(40, 2.0, exponent=1.5)
    for twin in (pickle.loads(pickle.dumps(chain)), copy.copy(chain), copy.deepcopy(chain)):
        assert twin == chain and twin.taper == 1.5
    for name in ("found.npz", "found.nc"):
        rc.modes(chain, 2).save(tmp_path / name)
        assert rc.load(tmp_path / name).system.taper == 1.5
    for other in (chain.with_body(weight=1.0), chain.with_thread(1.0, pin=40), chain.clamped(3)):
        assert other.taper is None
    told = rc.Chain(
        weight=chain.weight, length=chain.length, centroid=chain.centroid, radius_of_gyration=chain.radius_of_gyration
    )
    assert told.taper is None
    state = chain._compiled.__getstate__()
    assert len(state) == 8 and len(told._compiled.__getstate__()) == 7
    for wrong, says in ((-1.0, "exponent must be above -1"), (7.0, r"links\[0\] is not as Chain::tapered makes it")):
        with pytest.raises(ValueError, match=says):
            rc.Chain._from_state(((*state[:7], wrong), False, None, "free end first"))


@pytest.mark.parametrize("exponent", [-0.95, -0.3, 0.5, 1.0, 6.0, 30.0])
def test_heights_from_bessel_zeros(exponent):
    for count in (4, 25, 300):
        chain = rc.Chain.tapered(count, 3.0, exponent=exponent)
        exact = rc.modes(chain, count // 2).conical_height
        found = rc.modes(chain, count // 2, rtol=1.0, method="tapered chain")
        assert found.status == "success" or found.error_bound.max() > 1
        assert np.all(np.abs(found.conical_height / exact - 1) <= found.error_bound + ULP / 2)
        cord = rc.modes(rc.Cord(3.0, density=exponent), count // 2).conical_height
        assert np.all(exact < cord)  # links held straight
    row = next(row for row in rc.explain(chain, 3, rtol=1e-3).rows if row.name == "tapered chain")
    assert row.applies and row.error_bound >= found.error_bound[:3].max()


def test_chosen_where_it_is_cheapest():
    chain = rc.Chain.tapered(20_000, exponent=1.0)
    found = rc.modes(chain, 3, rtol=1e-12)
    assert found.method == "tapered chain" and found.status == "success"
    exact = rc.modes(chain, 3).conical_height
    assert np.all(np.abs(found.conical_height / exact - 1) <= 4 * ULP)
    reasons = {
        "not cut from a cord": rc.Chain.uniform_plummets(9),
        "equal rods": rc.Chain.tapered(9, exponent=0.0),
        "more than half": rc.Chain.tapered(1, exponent=1.0),
        "an exponent below": rc.Chain.tapered(9, exponent=150.0),
    }
    for reason, other in reasons.items():
        row = next(row for row in rc.explain(other).rows if row.name == "tapered chain")
        assert not row.applies and row.reason.startswith(reason)


def test_scene():
    table = {"count": 50, "exponent": 0.5, "length": "2 m", "mass": 3.0}
    scene = rc.Scene.from_dict({"tapered_chain": table})
    chain = scene.system()
    assert chain == rc.Chain.tapered(50, 2.0, mass=3.0, exponent=0.5) and chain.taper == 0.5
    assert scene.modes(count=2, rtol="0.1 %").method == "tapered chain"
    tipped = rc.Scene.from_dict({"tapered_chain": {**table, "tip_mass": 1.0}}).system()
    assert tipped == chain.with_body(mass=1.0)
    assert rc.Scene.from_dict(scene.to_dict()) == scene
    for wrong, words in (
        ({**table, "exponent": -1.0}, "tapered_chain.exponent"),
        ({**table, "exponent": 1000.5}, "tapered_chain.exponent"),
        ({**table, "exponent": 900.0}, "tapered_chain: the mass of the lowest link is too small"),
        ({**table, "count": 0}, "tapered_chain.count"),
        ({**table, "kind": "rods"}, "kind"),
        ({key: value for key, value in table.items() if key != "exponent"}, "exponent"),
        ({**table, "weight": 1.0}, "tapered_chain.weight: is given beside mass"),
    ):
        with pytest.raises(SceneError, match=words):
            rc.Scene.from_dict({"tapered_chain": wrong})
    with pytest.raises(SceneError, match="give one of"):
        rc.Scene.from_dict({"tapered_chain": table, "links": [{"mass": 1, "length": 1}]})


def test_study():
    pytest.importorskip("xarray")
    scene = {"tapered_chain": {"count": 12, "exponent": 1.0, "length": 1.0, "mass": 1.0}, "ask": {"modes": {"count": 2}}}
    found = rc.sweep({"scene": scene, "vary": {"tapered_chain.exponent": {"values": [-0.5, 0.0, 2.0]}}})
    for row, exponent in zip(found["conical_height"], (-0.5, 0.0, 2.0), strict=True):
        assert np.array_equal(row, rc.modes(rc.Chain.tapered(12, 1.0, mass=1.0, exponent=exponent), 2).conical_height)
    found = rc.sweep({"scene": scene, "vary": {"gravity": {"values": [1.0, 2.0]}}})
    assert len(found["conical_height"]) == 2


def test_the_command(capsys, tmp_path):
    path = tmp_path / "whip.toml"
    path.write_text("[tapered_chain]\ncount = 4000\nexponent = 2.0\nlength = 3.0\nmass = 0.4\n[ask.modes]\ncount = 3\n")
    assert _cli.run(["explain", str(path), "--rtol", "1e-6"]) == 0
    assert "-> tapered chain" in capsys.readouterr().out


@pytest.mark.parametrize("exponent", [-1.0, -3.0, 1000.1, math.nan, math.inf])
def test_wrong_exponents(exponent):
    with pytest.raises(ValueError, match=r"exponent must be above -1 and at most 1000|exponent"):
        rc.Chain.tapered(3, exponent=exponent)


def test_wrong_numbers():
    with pytest.raises(ValueError, match="count must be at least 1"):
        rc.Chain.tapered(0, exponent=1.0)
    with pytest.raises(ValueError, match="length"):
        rc.Chain.tapered(3, -1.0, exponent=1.0)
    with pytest.raises(ValueError, match="the weight of the lowest link is too small"):
        rc.Chain.tapered(1_000_000, exponent=100.0)
    with pytest.raises(ValueError, match="exponent must be a number"):
        rc.Chain.tapered(3, exponent="steep")
