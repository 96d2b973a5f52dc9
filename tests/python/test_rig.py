# SPDX-License-Identifier: GPL-3.0-or-later
"""`revchain.Rig` and what goes into it: what they keep, what they refuse."""

import numpy as np
import pytest

import revchain as rc

CHAIN = rc.Chain(weight=[1.0, 3.0], length=0.5)


def full(**other):
    given = dict(
        support=rc.Support(stiffness=20.0, weight=2.0, radius=0.1),
        flywheels=rc.Flywheel(momentum=[0.5, 0.0], axial_moment=0.25),
        displaced=rc.Displaced(weight=[0.1, 0.2], centroid=0.3, radius_of_gyration=0.05, added_weight=0.125),
        inverted=[True, False],
    )
    return rc.Rig(CHAIN, **{**given, **other})


def test_a_rig_keeps_what_it_is_given():
    rig = full()
    assert (rig.support.stiffness, rig.support.carriage, rig.support.radius, rig.fluid) == (20.0, 2.0, 0.1, "still")
    assert rig.support.weight == 2.0 and rig.support.mass is None
    assert rig.inverted.tolist() == [True, False] and rig.has_momentum
    assert rig.flywheels.momentum.tolist() == [0.5, 0.0] and rig.flywheels.axial_moment == 0.25
    assert rig.displaced.weight.tolist() == [0.1, 0.2]
    assert (rig.displaced.centroid, rig.displaced.radius_of_gyration, rig.displaced.added_weight) == (0.3, 0.05, 0.125)
    assert rig.chain is CHAIN and rig.size == len(rig) == 2
    assert repr(rig) == (
        "Rig of a chain of 2 links: support of stiffness 20, carriage of weight 2, carried round at radius 0.1, "
        "1 link inverted, 1 link with momentum, 2 links in still fluid"
    )


def test_what_is_left_out_is_the_chains_own_or_nothing():
    rig = rc.Rig(rc.Chain.uniform_rods(3, length=3.0))
    assert rig.support == rc.Support() and rig.support.stiffness == np.inf
    assert not rig.inverted.any() and not rig.has_momentum
    assert repr(rig) == "Rig of a chain of 3 links: nothing added"
    assert rig == rc.Rig(rig.chain, inverted=np.zeros(3, bool))
    own = rc.Displaced(weight=0.25, centroid=rig.chain.centroid, radius_of_gyration=rig.chain.radius_of_gyration)
    heights = [rc.modes(rc.Rig(rig.chain, displaced=each)).conical_height for each in (rc.Displaced(weight=0.25), own)]
    assert np.array_equal(*heights)


def test_rigs_are_values():
    """Copies and pickles: test_interface.py."""
    rig = full()
    parts = {"support": None, "flywheels": None, "displaced": rc.Displaced(weight=0.1), "inverted": True}
    assert all(rig != full(**{name: value}) for name, value in parts.items())
    assert full(displaced=None) != full(displaced=None, fluid="turning") and rig != CHAIN
    for thing, name in ((rig, "support"), (rig.support, "stiffness"), (rig.flywheels, "momentum")):
        with pytest.raises(AttributeError, match="cannot be changed"):
            setattr(thing, name, 0.0)
    for array in (rig.flywheels.momentum, rig.displaced.weight, rig.inverted):
        with pytest.raises(ValueError):
            array[0] = 1


def test_rigs_of_equal_numbers_are_equal():
    assert rc.Rig(CHAIN) == rc.Rig(CHAIN, flywheels=rc.Flywheel(momentum=[0.0, 0.0]), inverted=np.zeros(2, bool))
    assert full() == full(flywheels=rc.Flywheel(momentum=[0.5, 0.0], axial_moment=[0.25, 0.25]))
    one, other = rc.Flywheel(momentum=0.0), rc.Flywheel(momentum=-0.0)
    assert one != other or hash(one) == hash(other)


@pytest.mark.parametrize(
    ("make", "name", "values"),
    [
        (rc.Support, "stiffness", (-3.5, np.nan, -np.inf)),
        (rc.Support, "damping", (-1.5, np.inf, np.nan)),
        (rc.Pin, "damping", ([0.0, -2.0], np.inf)),
        (rc.Pin, "stiffness", (-1.0, np.nan)),
        (rc.Support, "weight", (-1.25, np.inf, np.nan)),
        (rc.Support, "radius", (np.inf, np.nan)),
        (rc.Flywheel, "momentum", ([0.0, np.inf], np.nan)),
        (rc.Flywheel, "axial_moment", ([-2.5, 0.0], np.inf)),
        (rc.Displaced, "weight", ([0.0, -7.5], np.nan)),
        (rc.Displaced, "centroid", (np.nan,)),
        (rc.Displaced, "radius_of_gyration", (-0.25,)),
        (rc.Displaced, "added_weight", (-0.75,)),
    ],
)
def test_wrong_parts_are_refused(make, name, values):
    says = "(be finite|be finite and not negative|not be negative)"
    more = {"weight": 0.0} if make is rc.Displaced else {}
    for value in values:
        wrong = min(np.ravel(value), key=lambda x: (bool(np.isfinite(x)), x))
        with pytest.raises(ValueError, match=rf"revchain\.{make.__name__}: {name} must {says}, got {wrong:g}$"):
            make(**{**more, name: value})
    with pytest.raises(ValueError, match=rf"revchain\.{make.__name__}: {name} must be a number.*, got .fast"):
        make(**{**more, name: "fast"})


@pytest.mark.parametrize(
    ("given", "says"),
    [
        ({"flywheels": rc.Flywheel(momentum=[1.0, 2.0, 3.0])}, r"momentum .* each of the 2 links, got shape \(3,\)"),
        ({"flywheels": rc.Flywheel(momentum=[[1.0, 2.0]])}, r"momentum .* got shape \(1, 2\)"),
        ({"displaced": rc.Displaced(weight=[1.0] * 4)}, r"displaced weight .* got shape \(4,\)"),
        ({"displaced": rc.Displaced(weight=1.0, added_weight=0.5), "fluid": "turning"}, "no added mass, got 0.5"),
        ({"displaced": rc.Displaced(mass=1.0)}, "displaced"),
        ({"support": rc.Support(stiffness=1.0, mass=1.0)}, "support"),
        ({"support": rc.Support(radius=-0.5)}, "support radius must not be negative, got -0.5"),
        ({"inverted": [1, 0]}, r"inverted must be True, False or an array of them"),
        ({"inverted": [True]}, r"one for each of the 2 links, got \[True\]"),
        ({"fluid": "air"}, r"fluid must be one of still, turning, got 'air'"),
    ],
)
def test_wrong_rigs_are_refused(given, says):
    with pytest.raises(ValueError, match=r"revchain\.Rig: .*" + says):
        rc.Rig(CHAIN, **given)


def test_a_rig_is_of_a_chain():
    for wrong in ("chain", None, rc.Rig(CHAIN)):
        with pytest.raises(TypeError, match=r"revchain\.Rig: chain must be a revchain\.Chain, got"):
            rc.Rig(wrong)
    with pytest.raises(TypeError, match=r"support must be a revchain\.Support, got 3"):
        rc.Rig(CHAIN, support=3.0)


def test_a_rig_by_mass_is_that_of_its_weights_under_any_gravity():
    """A spring bears against weights that grow with gravity; the rig was made under another one."""
    chain = rc.Chain(mass=[1.0, 3.0], length=0.5)
    moved = rc.Rig(chain, support=rc.Support(stiffness=20.0, mass=2.0))
    rc.modes(moved)
    for g in (1.62, 24.79):
        weights = rc.Rig(rc.Chain(weight=chain.mass * g, length=0.5), support=rc.Support(stiffness=20.0, weight=2.0 * g))
        there = rc.modes(weights, gravity=g)
        np.testing.assert_allclose(rc.modes(moved, gravity=g).conical_height, there.conical_height, rtol=1e-14)


def test_flywheels():
    free = rc.Rig(CHAIN, flywheels=rc.Flywheel(weight=[9.80665, 0.0], radius_of_gyration=0.3, spin=100.0))
    assert free._momentum(9.80665) == pytest.approx([9.0, 0.0], rel=1e-15)
    driven = rc.Flywheel(weight=2.0, radius_of_gyration=[0.5, 1.0], spin=-3.0, driven=True)
    same = rc.Rig(CHAIN, flywheels=rc.Flywheel(momentum=[-1.5, -6.0], axial_moment=[0.5, 2.0]))
    assert rc.Rig(CHAIN, flywheels=driven)._momentum(1.0).tolist() == [-1.5, -6.0]
    speeds = [rc.modes(rig, gravity=1.0).angular_speed for rig in (rc.Rig(CHAIN, flywheels=driven), same)]
    assert np.array_equal(*speeds)
    wheel = {"weight": 1.0, "radius_of_gyration": 1.0, "spin": 1.0}
    for name, value in {"weight": -1.0, "radius_of_gyration": np.nan, "spin": np.inf}.items():
        with pytest.raises(ValueError, match=name):
            rc.Flywheel(**{**wheel, name: value})
    for huge in ({"weight": 1e200, "radius_of_gyration": 1e100, "spin": 0.0}, {"spin": 1e300, "weight": 1e20}):
        with pytest.raises(ValueError, match="too large a momentum with radius_of_gyration, got"):
            rc.Rig(CHAIN, flywheels=rc.Flywheel(**{**wheel, **huge}))


@pytest.mark.parametrize(
    ("vary", "speed", "says"),
    [
        ("flywheels[0].momentum", 0.0, "angular_speed must"),
        ("flywheels[3].momentum", 1.0, r"flywheels\[3\]"),
    ],
)
def test_wrong_questions_of_tune(vary, speed, says):
    with pytest.raises(ValueError, match=rf"revchain.*{says}"):
        rc.tune(rc.Rig(CHAIN), vary=vary, angular_speed=speed)
    with pytest.raises(ValueError, match="vary must be"):
        rc.tune(CHAIN, vary="flywheels[0].momentum", angular_speed=1.0)


# ---- in scene files


@pytest.mark.parametrize(
    ("entries", "place"),
    [
        ("flywheel = {mass = 1, radius_of_gyration = -0.2, spin = 3}", "flywheel"),
        ("displaced = {mass = -0.4}", "displaced"),
        ("displaced = {mass = 0.4, colour = 1}", "colour"),
        ("[support]\nstiffness = 1\nmass = -0.3", "support"),
        ("[support]\nstiffness = -1", "stiffness"),
    ],
)
def test_scenes_that_cannot_be_name_the_key(tmp_path, entries, place):
    path = tmp_path / "bad.toml"
    path.write_text(f"[[links]]\nmass = 1\nlength = 1\n{entries}\n")
    with pytest.raises(rc.SceneError, match=rf"bad\.toml.*{place}"):
        rc.load_scene(path).modes()


def test_scene_without_modes_still_answers(python, tmp_path):
    path = tmp_path / "float.toml"
    path.write_text("[[links]]\nmass = 1\nlength = 1\ndisplaced = {mass = 3}\n")
    assert "Traceback" not in python("-m", "revchain", "modes", path).stderr
    assert len(rc.load_scene(path).modes()) == 0


def test_new_scene_names_every_feature(python, tmp_path):
    """The program is started three times."""
    path = tmp_path / "scene.toml"
    assert python("-m", "revchain", "new", path).returncode == 0
    text = path.read_text()
    for word in ("stiffness", "radius", "flywheel", "driven", "displaced", "fluid", "standing", "added_mass"):
        assert word in text
    # what is said in comments of a rig can be said
    said = {line[2:].split(" = ")[0]: line[2:] for line in text.splitlines() if line.startswith("# ") and " = " in line}
    links = "\n".join(said[k] for k in ("standing", "displaced", "flywheel"))
    support = "\n".join(["[support]", said["stiffness"], said["radius"]])
    full = text.replace("centroid = 0.1 ", links + "\ncentroid = 0.1 ").replace("\n[ask.modes]", "\n" + support + "\n[ask.modes]")
    for written in (text, full.replace("# fluid", "fluid")):
        path.write_text(written)
        assert python("-m", "revchain", "validate", path).returncode == 0
    rig = rc.load_scene(path).system()
    assert rig.inverted.any()
    assert rig.has_momentum
    assert np.any(rig.displaced.mass)
    assert rig.support.stiffness == 200.0
    assert rig.fluid == "turning"


def test_a_mass_at_the_support_rolls_freely_without_a_spring():
    assert rc.Support(mass=1000.0).stiffness == rc.Support(weight=2.5).stiffness == 0.0
    with pytest.raises(ValueError, match="revchain.Support: mass does not go with a firm support"):
        rc.Support(mass=1.0, stiffness=np.inf)
    assert rc.Support(mass=0.0) == rc.Support(weight=0.0) == rc.Support()
