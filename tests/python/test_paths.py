# SPDX-License-Identifier: GPL-3.0-or-later
"""Paths by the names of links and in the caller's order: in `tune`, `fit`, `uncertainty`, scenes and studies."""

import copy
import pickle
import re

import numpy as np
import pytest
from rigs import random_chain
from tier import by_tier

import revchain as rc
from revchain.cli import app as _cli
from revchain.systems.datum import datum_at
from revchain.systems.paths import link_in_path, numbered, steps

G = 9.80665
UP = rc.Chain(mass=[2500.0, 400.0], length=[6.0, 24.0], names=["load", "hook block"])
DOWN = rc.Chain(mass=[400.0, 2500.0], length=[24.0, 6.0], names=["hook block", "load"], order="support first")
RIG = {"support": rc.Support(stiffness="200 kN/m", mass=300.0), "flywheels": rc.Flywheel(mass=2.0, radius_of_gyration=0.1, spin=[3.0, 5.0])}
TIMED = {1: ("10.91 s", "0.02 s"), 2: ("1.61 s", "0.01 s")}


# ---- grammar


def test_grammar():
    names = ["load", "hook block", "a.b", "x]y", "7", "it's", "", "rod", "rod"]
    for path, want in {
        "links[load].mass": "links[0].mass",
        "links[hook block].length": "links[1].length",
        'links["hook block"].length': "links[1].length",
        "links['hook block'].flywheel.spin": "links[1].flywheel.spin",
        "links[a.b].mass": "links[2].mass",
        'links["x]y"].mass': "links[3].mass",
        'links["7"].mass': "links[4].mass",
        "links[it's].mass": "links[5].mass",
        "pins[load].stiffness": "pins[0].stiffness",
        "links[load]": "links[0]",
        # what names no link stays as it is
        "links[7].mass": "links[7].mass",
        "support.stiffness": "support.stiffness",
        "cord.masses[0].mass": "cord.masses[0].mass",
        "masses[load].mass": "masses[load].mass",
        "length": "length",
        "": "",
    }.items():
        assert numbered(path, names) == want
    assert steps("links[load].mass") == () and steps("links[2].mass") == ("links", 2, "mass")
    for path, message in {
        "links[laod].mass": 'links[laod]: no link is named "laod"; did you mean "load"? the names are "load", "hook block", "a.b", ',
        "links[Hook Block].mass": 'no link is named "Hook Block"; did you mean "hook block"?',
        "links[hook].mass": 'did you mean "hook block"?',
        "links[].mass": 'links[]: no link is named ""; the names are',
        "links[zz].mass": 'links[zz]: no link is named "zz"; the names are',
        "links[rod].mass": 'links[rod]: 2 links are named "rod"; write an index: links[7], links[8]',
    }.items():
        with pytest.raises(ValueError, match=re.escape(message)):
            numbered(path, names)
    with pytest.raises(ValueError, match=re.escape("links[load]: no link has a name; write an index such as links[0]")):
        numbered("links[load].mass", [])
    with pytest.raises(ValueError, match=re.escape('write an index: links[0], links[1], links[2] ...')):
        numbered("links[a].mass", ["a"] * 9)
    assert [link_in_path("links", k, names) for k in range(9)] == [
        "links[load]", "links[hook block]", "links[a.b]", "links[3]", "links[4]", "links[it's]", "links[6]", "links[7]", "links[8]",
    ]  # fmt: skip
    assert link_in_path("links", 2, []) == "links[2]"


# ---- systems in Python


@pytest.mark.parametrize("chain", [UP, DOWN], ids=["free end first", "support first"])
def test_a_name_is_the_link_of_that_name(chain):
    for system in (chain, rc.Rig(chain, **RIG), rc.Held(chain, tension=60e3)):
        assert datum_at("", system, "links[load].mass", G).present == 2500
        assert datum_at("", system, "links[hook block].length", G).present == 24
        assert datum_at("", system, 'links["hook block"].mass', G).said == 'links["hook block"].mass'
        changed = datum_at("", system, "links[load].mass", G).change(1234.0)
        assert changed._base.mass.tolist() == [1234.0, 400.0] and changed._base.names == chain.names
        assert changed._base.order == chain.order
    assert datum_at("", rc.Rig(chain, **RIG), "flywheels[load].spin", G).present == 3
    tuned = rc.tune(chain, vary="links[load].mass", angular_speed="5.5 rpm")
    assert tuned.vary == "links[load].mass" and tuned == rc.tune(chain, vary="links[load].mass", angular_speed="5.5 rpm")
    assert tuned.value == rc.tune(UP, vary="links[0].mass", angular_speed="5.5 rpm").value
    assert tuned.system.order == chain.order and tuned.system.names == chain.names
    found = rc.fit(chain, TIMED, vary=["links[load].mass", "links[hook block].length_in_proportion"])
    want = rc.fit(UP, TIMED, vary=["links[0].mass", "links[1].length_in_proportion"])
    np.testing.assert_array_equal(found.value, want.value)
    assert found["links[load].mass"] == want["links[0].mass"] and "links[hook block].length_in_proportion" in repr(found)


def test_indices_count_as_the_chain_was_listed():
    assert datum_at("", UP, "links[0].mass", G).present == 2500 == datum_at("", DOWN, "links[1].mass", G).present
    assert datum_at("", DOWN, "links[0].length", G).present == 24
    tuned = rc.tune(DOWN, vary="links[0].mass", angular_speed="5.5 rpm")
    assert tuned.present == 400 and tuned.value == rc.tune(UP, vary="links[1].mass", angular_speed="5.5 rpm").value
    assert rc.fit(DOWN, TIMED, vary={"links[1].mass": 2000.0}).present.tolist() == [2500.0]
    rig = rc.Rig(DOWN, **RIG)
    assert datum_at("", rig, "flywheels[0].spin", G).present == 5  # of the hook block; the array begins at the free end
    with pytest.raises(ValueError, match=r"names links\[2\], and the highest is links\[1\]"):
        rc.tune(DOWN, vary="links[2].mass", angular_speed=1.0)
    shape = rc.steady_shapes(rc.Chain(mass=[1.0, 2.0], length=1.0, order="support first"), angular_speed=4.0)[0]
    assert shape.to_dataframe().index.tolist() == [1, 0]
    arm = rc.Rig(rc.Chain(mass=[1.0, 2.0], length=1.0, order="support first"), support=rc.Support(radius=1.0))
    assert rc.drag_shape(arm, rc.Drag(1.0, area=0.1), angular_speed=1.0).link.tolist() == [1, 0]
    wheel = rc.Flywheel(mass=1.0, radius_of_gyration=1.0, spin=[-G, 0.0, 0.0])
    for order, link in (("free end first", 0), ("support first", 2)):
        spun = rc.Rig(rc.Chain(mass=[1.0] * 3, length=1.0, order=order), flywheels=wheel)
        assert f"links[{link}] goes slack" in repr(rc.modes(spun))


def test_the_order_stays_with_the_chain():
    long = rc.Chain(mass=[1.0, 2.0, 3.0], length=1.0, names=["a", "b", "c"], order="support first")
    assert long.mass.tolist() == [3.0, 2.0, 1.0] and long.names == ("c", "b", "a") and long.order == "support first"
    for chain in (pickle.loads(pickle.dumps(long)), copy.copy(long), rc.Chain.from_dict(long.to_dict())):
        assert chain == long and chain.order == long.order and chain.mass.tolist() == [3.0, 2.0, 1.0]
    data = long.to_dict()
    assert data["order"] == "support first" and data["mass"] == [1.0, 2.0, 3.0] and data["names"] == ["a", "b", "c"]
    assert "order" not in UP.to_dict() and rc.Chain(mass=1.0, length=1.0).order == "free end first"
    with pytest.raises(ValueError, match="order must be one of"):
        rc.Chain.from_dict(data | {"order": "top first"})
    for changed in (long.with_body(mass=1.0), long.with_thread(0.5, pin=1), long.clamped(0)):
        assert changed.order == long.order
    assert rc.Rig.from_dict(rc.Rig(long).to_dict()).chain.order == long.order
    turned = rc.Chain(mass=[3.0, 2.0, 1.0], length=1.0, names=["c", "b", "a"])
    assert turned == long and hash(turned) == hash(long)  # the order is how it was written, not what it is


def test_errors_of_a_chain_count_as_it_was_listed():
    for order, link in (("free end first", 1), ("support first", 1)):
        with pytest.raises(ValueError, match=rf"^revchain.Chain: links\[{link}\]"):
            rc.Chain(mass=1.0, length=[1.0, -1.0, 1.0, 1.0], order=order)
    with pytest.raises(ValueError, match=r"^revchain.Chain: links\[3\].*lowest link must have mass"):
        rc.Chain(mass=[1.0, 1.0, 1.0, 0.0], length=1.0, order="support first")


def test_random_paths_in_both_orders():
    """Each path, by name and by index in the caller's order, gives the number that the caller listed there."""
    rng = np.random.default_rng(4)
    for _ in range(by_tier(20, 200)):
        size = int(rng.integers(1, 9))
        given = {name: np.exp(rng.uniform(-1, 1, size)) for name in ("mass", "length", "centroid", "radius_of_gyration")}
        names = [f"link {k}, {'abc'[k % 3]}" for k in rng.permutation(size)]
        order = str(rng.choice(["free end first", "support first"]))
        system = rc.Chain(**given, names=names, order=order)
        if rng.integers(2):
            system = rc.Rig(system, support=rc.Support(stiffness=50.0))
        for name, column in given.items():
            k = int(rng.integers(size))
            for where in (k, names[k], f'"{names[k]}"'):
                path = f"links[{where}].{name}"
                datum = datum_at("", system, path, G)
                assert datum.present == pytest.approx(column[k], rel=1e-15) and datum.said == path
                again = datum_at("", datum.change(1.25 * column[k]), path, G)
                assert again.present == pytest.approx(1.25 * column[k], rel=1e-12)


REFUSED = [
    (UP, "links[laod].mass", r'vary: links\[laod\]: no link is named "laod"; did you mean "load"\?'),
    (UP, "links[load].weight", r'was given by mass: vary "links\[load\].mass"'),
    (UP, "links[load].mas", r"\(k: an index or a name, load, hook block\) of a chain, got 'links\[load\].mas'"),
    (rc.Chain(mass=[1.0, 2.0], length=1.0), "links[load].mass", "no link has a name; write an index such as links"),
    (rc.Chain(mass=[1.0, 2.0], length=1.0, names=["a", "a"]), "links[a].mass", r'2 links are named "a"; write an index: links\[0\]'),
    (rc.Cord(1.0, mass=1.0), "links[load].mass", 'vary must be one of "length", "mass", "tip_mass"'),
    (rc.Rig(UP), "flywheels[lod].momentum", 'no link is named "lod"; did you mean "load"'),
    (UP, "links[-1].mass", 'indices start at 0'),
]


@pytest.mark.parametrize(("system", "path", "message"), REFUSED)
def test_wrong_names(system, path, message):
    with pytest.raises(ValueError, match=f"^revchain.tune: {message}|^revchain.tune: .*{message}"):
        rc.tune(system, vary=path, angular_speed=1.0)
    with pytest.raises(ValueError, match=f"^revchain.fit: .*{message}"):
        rc.fit(system, {1: 2.0}, vary=path)


def test_a_number_by_name_and_by_index_is_the_same():
    for chain, paths in ((UP, ["links[load].mass", "links[0].mass"]), (DOWN, ["links[1].mass", "links[load].mass"])):
        with pytest.raises(ValueError, match="which change the same number; leave one of them out"):
            rc.fit(chain, TIMED, vary=paths)
    with pytest.raises(ValueError, match=r'vary has "length" and "links\[load\].length", which change the same number'):
        rc.fit(DOWN, TIMED, vary=["length", "links[load].length"])


# ---- uncertainty


@pytest.mark.parametrize("order", ["free end first", "support first"])
def test_uncertainties_by_path_are_those_by_keyword(order):
    rng = np.random.default_rng(11)
    for _ in range(by_tier(5, 40)):
        size = int(rng.integers(2, 6))
        drawn = random_chain(rng, size)
        columns = {name: getattr(drawn, name)[:: 1 if order[0] == "f" else -1] for name in ("weight", "length", "centroid", "radius_of_gyration")}
        chain = rc.Chain(**columns, names=[f"link {k}" for k in range(size)], order=order)
        rig = rc.Rig(chain, support=rc.Support(stiffness=30.0, weight=0.5), flywheels=rc.Flywheel(momentum=rng.uniform(0, 0.2, size)))
        for system in (chain, rig):
            found = rc.modes(system)
            k = int(rng.integers(size))
            here = size - 1 - k if order[0] == "s" else k  # from the lowest
            one = np.arange(size) == here
            by_path = {f"links[link {k}].weight": "5 %", f"links[{k}].length_in_proportion": 0.01, f"links[{k}].centroid": "2 mm"}
            spread = 0.05 * chain.weight
            by_key = {"weight": one * spread, "length_in_proportion": 0.01 * one, "centroid": 0.002 * one}
            if system is rig:
                by_path |= {"support.stiffness": "10 %", "support.weight": 0.1, f"flywheels[link {k}].momentum": 0.03}
                by_key |= {"stiffness": 3.0, "support_mass": 0.1, "momentum": 0.03 * one}
            got, want = found.uncertainty(by_path), found.uncertainty(**by_key)
            np.testing.assert_allclose(got.angular_speed, want.angular_speed, rtol=1e-13)
            np.testing.assert_allclose(got.share[f"links[link {k}].weight"], want.share.mass[:, here], rtol=1e-12, atol=1e-15)
            both = found.uncertainty({f"links[{k}].centroid": "2 mm"}, **{name: x for name, x in by_key.items() if name != "centroid"})
            np.testing.assert_allclose(both.angular_speed, want.angular_speed, rtol=1e-13)
            shares = sum(part.sum(axis=1) if part.ndim == 2 else part for part in got.share.value.values())
            np.testing.assert_allclose(shares, 1.0, rtol=1e-12)
            at = {datum_at("", system, path, G).path for path in got.largest}
            assert at == {datum_at("", system, path, G).path for path in want.largest}  # both are paths of the system
            assert all(f"link {k}" in path or path.startswith("support.") for path in want.largest)


def test_whole_systems_by_path():
    """A datum in proportion: its deviation is that of the keyword, or the root of the sum for links that move together."""
    found = rc.modes(UP)
    np.testing.assert_allclose(found.uncertainty({"length": "1 %"}).relative, 0.01, rtol=1e-13)
    assert found.uncertainty({"length": "1 %"}).largest == ("length", "length")
    cord = rc.modes(rc.Cord(2.0, mass=1.0, tip_mass=0.3), 3)
    paths, keys = {"length": 0.01, "mass": "3 %", "tip_mass": 0.02}, {"length": 0.01, "mass": 0.03, "tip_mass": 0.02}
    np.testing.assert_array_equal(cord.uncertainty(paths).angular_speed, cord.uncertainty(**keys).angular_speed)
    assert set(cord.uncertainty(paths).largest) <= set(paths) and cord.uncertainty(**keys).largest == cord.uncertainty(paths).largest
    by_weight = rc.modes(rc.Cord(2.0, weight=1.0, tip_weight=0.3), 2)
    assert by_weight.uncertainty({"tip_weight": "5 %"}) .largest == by_weight.uncertainty(tip_weight="5 %").largest == ("tip_weight",) * 2
    held = rc.modes(rc.Held(rc.Cord(1.0, mass=2.0), tension=150.0), 2)
    assert held.uncertainty({"tension": "1 %"}).angular_speed == pytest.approx(held.uncertainty(tension="1 %").angular_speed)
    rig = rc.modes(rc.Rig(UP, **RIG), 1)
    whole = rig.uncertainty({"mass": "1 %"}).angular_speed  # all masses by one factor: a covariance
    np.testing.assert_allclose(whole, rig.uncertainty(mass=1e-4 * np.outer(UP.mass, UP.mass)).angular_speed, rtol=1e-10)


def test_the_largest_part_is_a_path():
    rig = rc.modes(rc.Rig(DOWN, **RIG), 2)
    for given, want in (
        ({"mass": ["5 %", 0]}, "links[load].mass"),
        ({"stiffness": "5 %"}, "support.stiffness"),
        ({"support_mass": 1.0}, "support.mass"),
        ({"spin": [0.0, 1.0]}, "flywheels[hook block].spin"),
        ({"momentum": [1.0, 0.0]}, "flywheels[load].momentum"),
        ({"displaced_mass": [1.0, 0.0]}, "displaced[load].mass"),
        ({"added_mass": [0.0, 1.0]}, "displaced[hook block].added_mass"),
        ({}, ""),
    ):
        found = rig.uncertainty(**given)
        assert found.largest == (want,) * len(rig) and (want or "nothing") in repr(found)
    unnamed = rc.modes(rc.Chain(mass=[400.0, 2500.0], length=[24.0, 6.0], order="support first"))
    assert unnamed.uncertainty(mass=["5 %", 0]).largest == ("links[1].mass",) * 2
    tuned = rc.tune(DOWN, vary=rc.modes(DOWN).uncertainty(mass="5 %").largest[0], angular_speed="5.5 rpm")
    assert tuned.status == "found"


def test_wrong_uncertainties_by_path():
    found = rc.modes(rc.Rig(DOWN, **RIG))
    for data, message in [
        (5, r'data must be a dictionary such as \{"links\[load\].mass": "5 %"\}, got 5'),
        ({"links[laod].mass": 1}, 'data: links.laod.: no link is named "laod"; did you mean "load"'),
        ({"links[load].mass": "-5 %"}, r"links\[load\].mass: the deviation must be finite and not negative, got '-5 %'"),
        ({"links[load].mass": float("nan")}, "the deviation must be finite and not negative, got nan"),
        ({"links[load].mass": "5 m"}, r'mass \(deviation of links\[load\].mass\) must be a mass such as'),
        ({"links[load].mass": "x %"}, r'links\[load\].mass must be a number, or a part of it such as "5 %"'),
        ({"links[load].mass": [1, 2]}, "must be a single number"),
        ({"links[load].mass": 1, "links[1].mass": 1}, r'"links.load..mass" and "links.1..mass" are the same number; leave one of them out'),
        ({"flywheels[load].mass": 1}, "no derivative of the speeds by it is computed; change the datum and call modes again"),
        ({"gravity": 0.1}, 'data must be one of "length"'),
        ({3: 0.1}, "data must be one of .*, got 3"),
    ]:
        with pytest.raises(ValueError, match=f"^revchain.Modes.uncertainty: .*{message}"):
            found.uncertainty(data)
    with pytest.raises(ValueError, match=r'give either mass or "links\[load\].mass", got both'):
        found.uncertainty({"links[load].mass": 1}, mass=1)
    with pytest.raises(ValueError, match="support.stiffness is for a support on a spring, and this one is firm"):
        rc.modes(rc.Rig(DOWN)).uncertainty({"support.stiffness": "5 %"})
    with pytest.raises(ValueError, match="is for a Chain, a Rig or a Cord, got a chain held at both ends"):
        rc.modes(rc.Held(UP, tension=60e3)).uncertainty({"tension": "5 %"})


# ---- scenes and studies

LINKS = [{"name": "hook block", "mass": 400.0, "length": 24.0}, {"name": "load", "mass": 2500.0, "length": 6.0}]
SCENES = {
    "support first": {"order": "support first", "links": LINKS},
    "free end first": {"links": LINKS[::-1]},
}


@pytest.mark.parametrize("order", SCENES)
def test_one_index_and_one_name_in_scene_study_and_python(order):
    data = SCENES[order]
    scene = rc.Scene.from_dict(data)
    system = scene.system()
    assert system.order == order and system == (DOWN if order == "support first" else UP)
    for k, link in enumerate(data["links"]):
        for where in (k, link["name"]):
            path = f"links[{where}].mass"
            assert datum_at("", system, path, G).present == link["mass"]
            study = rc.Study.from_dict({"scene": data, "vary": {path: {"values": [link["mass"], 111.0]}}})
            assert sorted(study.scene_at(1).system().mass) == sorted([111.0, *(one["mass"] for one in data["links"] if one is not link)])
            np.testing.assert_array_equal(rc.sweep(study)[path], [link["mass"], 111.0])
            assert rc.sweep(study)[path].attrs["path"] == path


def test_random_numbers_of_a_study_do_not_depend_on_how_a_link_is_called():
    found = [
        rc.sweep({"scene": SCENES["support first"], "vary": {path: {"uniform": [1000, 3000], "name": "m"}}, "samples": 5})
        for path in ("links[1].mass", "links[load].mass", 'links["load"].mass')
    ]
    for other in found[1:]:
        for name in ("m", "angular_speed"):
            np.testing.assert_array_equal(found[0][name], other[name])


def test_wrong_names_in_a_study(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)

    def refused(vary, **scene):
        with pytest.raises(rc.SceneError) as caught:
            rc.Study.from_dict({"scene": {**SCENES["free end first"], **scene}, "vary": vary})
        return str(caught.value)

    one = {"values": [1.0, 2.0]}
    assert refused({"links[laod].mass": one}) == (
        'study: vary."links[laod].mass": links[laod]: no link is named "laod"; did you mean "load"? the names are "load", "hook block"'
    )
    twice = [{**LINKS[0]}, {**LINKS[0]}]
    assert '2 links are named "hook block"; write an index: links[0], links[1]' in refused({"links[hook block].mass": one}, links=twice)
    bare = [{"mass": 1.0, "length": 1.0}]
    assert "no link has a name; write an index such as links[0]" in refused({"links[load].mass": one}, links=bare)
    assert 'is varied by vary."links[load].mass", too' in refused({"links[load].mass": one, "links[0].mass": {**one, "name": "x"}})
    assert "unknown key; did you mean mass?" in refused({"links[load].mas": one})
    text = 'scene.order = "support first"\n[[scene.links]]\nname = "a b"\nmass = 1\nlength = 1\n'
    (tmp_path / "s.toml").write_text(text + "[vary.links[a b].mass]\nvalues = [1, 2]\n")
    assert _cli.run(["sweep", "s.toml", "--check"]) != 0
    assert 's.toml: line 6, column 7: a path is in quotes: write "links[a b].mass", not links[a b].mass' in capsys.readouterr().err
    (tmp_path / "s.toml").write_text(text + '[vary."links[a b].mass"]\nvalues = [1, 2]\n')
    assert _cli.run(["sweep", "s.toml", "--check"]) == 0 and "links[a b].mass: 2 values, 1 to 2" in capsys.readouterr().out
    (tmp_path / "s.toml").write_text(text + '[vary."links[ab].mass"]\nvalues = [1, 2]\n')
    assert _cli.run(["sweep", "s.toml", "--check"]) != 0
    assert 's.toml: line 6, column 1: vary."links[ab].mass": links[ab]: no link is named "ab"; did you mean "a b"?' in capsys.readouterr().err


def test_a_swing_starts_in_the_order_of_the_scene():
    ask = {"swing": {"offset": [0.02, 0.1], "velocity": [0.3, 0.0], "time": [0.0, 0.5]}}
    down = rc.Scene.from_dict({**SCENES["support first"], "ask": ask}).swing()
    up = {name: value[::-1] if name != "time" else value for name, value in ask["swing"].items()}
    other = rc.Scene.from_dict({**SCENES["free end first"], "ask": {"swing": up}}).swing()
    np.testing.assert_array_equal(down.offset, other.offset)
    assert down.offset[0, 0] == pytest.approx(0.1)  # results begin at the free end
    scene = rc.Scene.from_dict(SCENES["support first"])
    np.testing.assert_array_equal(scene.swing(**ask["swing"]).offset, down.offset)
    with pytest.raises(rc.SceneError, match="a number for each of the 2 pins that move, support first, got 3"):
        scene.swing(offset=[1, 2, 3])


def test_unnamed_links_of_a_scene_are_called_by_their_index_in_the_file():
    links = [{"mass": 3.0, "length": 1.0}, {"mass": 2.0, "length": 0.5, "repeat": 2}, {"mass": 1.0, "length": 1.0, "name": "load"}]
    down = rc.Scene.from_dict({"order": "support first", "links": links}).system()
    assert down.names == ("load", "links[1]", "links[1]", "links[0]")
    up = rc.Scene.from_dict({"links": links[::-1]}).system()
    assert up.names == ("load", "links[1]", "links[1]", "links[2]")
    found = rc.modes(down).uncertainty(mass=[0, 0, 0, 0.1]).largest
    assert set(found) == {"links[0].mass"} and datum_at("", down, "links[0].mass", G).present == 3


# ---- the length of a link means the same everywhere


MIXED = rc.Chain(mass=[2.0, 1.0, 3.0], length=[0.5, 0.6, 0.7], centroid=[0.5, 0.3, 0.2], radius_of_gyration=[0.0, 0.6 / 12**0.5, 0.1])


@pytest.mark.parametrize(("k", "follows"), [(0, True), (1, True), (2, False)])
def test_the_length_of_a_link_moves_what_follows_from_it(k, follows):
    """Point masses at their lower pins and uniform rods keep their form; of other bodies only the lower pin moves."""
    datum, factor = datum_at("here", MIXED, f"links[{k}].length", 9.81), 1.1
    changed = datum.change(factor * MIXED.length[k])
    assert changed.length[k] == pytest.approx(factor * MIXED.length[k], rel=1e-15) and datum.said == f"links[{k}].length"
    for name in ("centroid", "radius_of_gyration"):
        now, before = getattr(changed, name), getattr(MIXED, name)
        assert now[k] == pytest.approx(before[k] * (factor if follows else 1.0), rel=1e-15)
        np.testing.assert_array_equal(np.delete(now, k), np.delete(before, k))
    modes = rc.modes(MIXED)
    by_path = modes.uncertainty({f"links[{k}].length": 0.01})
    spread = np.where(np.arange(3) == k, 0.01, 0.0)
    want = modes.uncertainty(**{"length_in_proportion" if follows else "length": spread})
    np.testing.assert_allclose(by_path.angular_speed, want.angular_speed, rtol=1e-13)


def test_the_length_of_a_point_mass_in_tune_fit_and_the_worst_case():
    tuned = rc.tune(rc.Chain(mass=1, length=1.0), vary="links[0].length", mode=1, angular_speed=2.0)
    assert tuned.value == pytest.approx(9.80665 / 4, rel=1e-14)
    crane = rc.Chain(mass=[2500.0, 400.0], length=[6.0, 24.0])
    worst = rc.modes(crane).uncertainty({"links[1].length": 1.0}, worst=True).worst
    for upper in np.linspace(23.0, 25.0, 11):
        speed = rc.modes(rc.Chain(mass=[2500.0, 400.0], length=[6.0, upper])).angular_speed
        assert (worst.lowest_angular_speed <= speed).all() and (speed <= worst.highest_angular_speed).all()
    there = rc.Chain(mass=[2500.0, 400.0], length=[6.0, 24.7])
    measured = dict(enumerate(rc.modes(there).angular_speed.tolist(), 1))
    assert rc.fit(crane, measured, vary="links[1].length").system.centroid[1] == pytest.approx(24.7, rel=1e-9)
    with pytest.raises(ValueError, match="are the same number"):
        rc.modes(crane).uncertainty({"links[1].length": 1.0, "links[1].length_in_proportion": 1.0})
    with pytest.raises(ValueError, match='have "links|has "links|change the same number'):
        rc.fit(crane, measured, vary=["links[1].length", "links[1].centroid"])


def test_a_scene_and_a_study_have_one_word_for_the_length():
    hint = "write length: centroid and radius of gyration follow unless they are given"
    links = [{"mass": 1.0, "length": 1.0}]
    with pytest.raises(rc.SceneError, match=hint):
        rc.Scene.from_dict({"links": [{"mass": 1.0, "length_in_proportion": 1.0}]})
    with pytest.raises(rc.SceneError, match=hint):
        rc.Study.from_dict({"scene": {"links": links}, "vary": {"links[0].length_in_proportion": {"values": [1, 2]}}})


@pytest.mark.parametrize(
    ("path", "message"),
    [
        ("links[-1].mass", r"links\[-1\]: indices start at 0"), ("links[*].mass", "there is no wildcard; write a path for each link"),
        ("link[b].mass", r'did you mean "links\[b\].mass"'), ("flywheel[0].momentum", r'did you mean "flywheels\[0\].momentum"'),
    ],
)  # fmt: skip
@pytest.mark.parametrize("system", [UP, DOWN, rc.Chain(mass=[1.0, 2.0], length=1.0), rc.Rig(UP, **RIG)])
def test_almost_a_path(path, message, system):
    for call in (lambda: rc.tune(system, vary=path, angular_speed=1.0), lambda: rc.fit(system, {1: 1.0}, vary=path),
                 lambda: rc.modes(system).uncertainty({path: 1.0})):  # fmt: skip
        with pytest.raises(ValueError, match=message):
            call()
    if "links" in path:
        with pytest.raises(rc.SceneError, match=message):
            rc.Study.from_dict({"scene": {"links": [{"mass": 1, "length": 1}]}, "vary": {path: {"values": [1, 2]}}})


def test_the_list_of_paths_has_gravity():
    for call in (lambda: rc.tune(UP, vary="g", angular_speed=1.0), lambda: rc.fit(UP, {1: 1.0}, vary="g")):
        with pytest.raises(ValueError, match='"gravity"'):
            call()
    with pytest.raises(ValueError, match="data must be one of (?!.*gravity)"):
        rc.modes(UP).uncertainty({"g": 1.0})
