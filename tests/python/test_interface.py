# SPDX-License-Identifier: GPL-3.0-or-later
"""The interface as a whole: systems, the table of systems and questions, mass and weight, gravity, units, names."""

import copy
import importlib
import inspect
import json
import math
import pickle
import pkgutil
import pydoc
import time
from typing import Any

import numpy as np
import pytest

import revchain as rc
from revchain import results
from revchain.results.base import Result
from revchain.results.kinds import KINDS as CLASSES

BODIES = {"length": [0.7, 0.15], "centroid": [0.55, 0.05], "radius_of_gyration": [0.2, 0.36]}
MASS = np.array([180.0, 5000.0])
BELL = rc.Chain(mass=MASS, **BODIES)
RODS = rc.Chain.uniform_rods(3, length=1.5, mass=3.0)
POINTS = rc.Chain(mass=[1.0, 3.0], length=1.0, names=["load", "hook block"])
SYSTEMS = {
    "chain": POINTS,
    "bodies": BELL,
    "tapered": rc.Chain.tapered(4, exponent=0.7, weight=2.0),
    "rods": RODS,
    "rig": rc.Rig(
        RODS,
        support=rc.Support(stiffness=20.0, mass=0.5, radius=0.1),
        flywheels=rc.Flywheel(mass=0.2, radius_of_gyration=0.1, spin=[30.0, 0.0, -3.0], driven=[True, False, False]),
        displaced=rc.Displaced(mass=0.1, added_mass=0.05),
        inverted=[False, True, False],
    ),
    "rig by momentum": rc.Rig(rc.Chain(weight=2.0, length=1.0), flywheels=rc.Flywheel(momentum=0.3), fluid="turning"),
    "cord": rc.Cord(0.36, mass=0.2, tip_mass=0.01),
    "cord of a density": rc.Cord(2.0, density=lambda s: 1 + s if s < 1 else 3.0, tip_weight=0.1),
    "held chain": rc.Held(RODS, span=0.9),
    "held cord": rc.Held(rc.Cord(1.0), tension=30.0, weightless=True),
    "held by arms": rc.Held(
        RODS, span=0.9, lower=rc.Support(stiffness=90.0, mass=0.2), upper=rc.Support(radius=-0.4), weightless=True
    ),
}


# ---- systems are values


@pytest.mark.parametrize("system", SYSTEMS.values(), ids=SYSTEMS.keys())
def test_systems_are_values(system):
    twins = [pickle.loads(pickle.dumps(system, protocol)) for protocol in range(pickle.HIGHEST_PROTOCOL + 1)]
    twins += [copy.copy(system), copy.deepcopy(system), type(system).from_dict(json.loads(json.dumps(system.to_dict())))]
    for twin in twins:
        assert type(twin) is type(system) and twin == system and hash(twin) == hash(system)
        assert repr(twin) == repr(system) and twin.describe() == system.describe()
        assert twin._repr_html_() == system._repr_html_()
    assert system != "text" and all((other == system) == (other is system) for other in SYSTEMS.values())
    for name in ("by_mass", "anything"):
        with pytest.raises(AttributeError):
            setattr(system, name, 1)
    assert "<table>" in system._repr_html_()
    with pytest.raises(ValueError, match=r'must have "system"'):
        type(system).from_dict({})
    with pytest.raises(ValueError, match="not data of a"):
        type(system).from_dict({"system": type(system).__name__, "colour": 1})


@pytest.mark.parametrize("system", SYSTEMS.values(), ids=SYSTEMS.keys())
def test_systems_are_drawn_at_rest(system):
    pytest.importorskip("matplotlib")
    ax = system.plot()
    assert ax.get_ylabel().endswith("(m)")
    if getattr(system, "names", None):
        assert [text.get_text() for text in ax.texts] == ["load", "hook block"]


def test_words_from_the_support_down():
    assert POINTS.describe() == "support: firm; hook block: 3 kg on 1 m; load: 1 kg on 1 m"
    assert rc.Chain.uniform_rods(120, length=0.36, weight=1.0).describe() == (
        "support: firm; 120 times rod, 0.00833333 N, 0.003 m"
    )
    many = rc.Chain(weight=np.arange(1.0, 101.0), length=1.0).describe()
    assert many == "support: firm; 100 N on 1 m; 99 N on 1 m; 98 N on 1 m; 95 more links; 2 N on 1 m; 1 N on 1 m"
    data = np.random.default_rng(1).uniform(1.0, 2.0, (4, 30_000))
    unlike = rc.Chain(mass=data[0], length=data[1], centroid=data[2], radius_of_gyration=data[3])
    began = time.process_time()
    assert " m; 29,995 more links; body, " in unlike.describe()
    assert time.process_time() - began < 2  # the time grows as the number of links
    assert SYSTEMS["rig"].describe() == (
        "support: on a spring of 20 N/m with 0.5 kg, carried round at 0.1 m; 3 times rod, 1 kg, 0.5 m; 1 link inverted; "
        "2 links with momentum; 3 links in still fluid"
    )
    assert SYSTEMS["held by arms"].describe() == (
        "both ends held, 0.9 m apart, without gravity; upper end: firm, carried round at -0.4 m; 3 times rod, 1 kg, 0.5 m; "
        "lower end: on a spring of 90 N/m with 0.2 kg"
    )
    assert SYSTEMS["held chain"].describe().startswith("both ends held on the axis, 0.9 m apart; 3 times rod")
    assert SYSTEMS["cord"].describe() == "support: firm; uniform cord: 0.2 kg, 0.36 m; tip: 0.01 kg"


# ---- the table of systems and questions

HELD = rc.Held(RODS, tension=80.0)
SPAN = rc.Held(RODS, span=0.9)
CORD = rc.Cord(1.5, mass=3.0)
CORD_HELD = rc.Held(rc.Cord(1.0, mass=1.0), span=0.5)
CORD_TAUT = rc.Held(rc.Cord(1.0, mass=1.0), tension=15.0)
RIG = rc.Rig(RODS, support=rc.Support(stiffness=200.0, mass=0.5))
CARRIED = rc.Rig(RODS, support=rc.Support(stiffness=200.0, mass=0.5, radius=0.3))
QUESTIONS = {
    "modes": lambda system: rc.modes(system, 2),
    "count_modes": lambda system: rc.count_modes(system, angular_speed=9.0),
    "steady_shapes": lambda system: rc.steady_shapes(system, angular_speed=9.0),
    "steady_shape": lambda system: rc.steady_shape(system, mode=1, angular_speed=7.0),
    "branches": lambda system: rc.branches(system, max_angular_speed=9.0),
    "branch": lambda system: rc.branch(system, 1, max_angular_speed=9.0),
    "response": lambda system: rc.response(system, angular_speed=9.0),
    "swing": lambda system: rc.swing(system, [0.0, 1.0], offset=[0.1, 0.1, 0.1, 0.0]),
    "campbell": lambda system: rc.campbell(system, [5.0, 6.0]),
    "drag_shape": lambda system: rc.drag_shape(
        CARRIED if system is RIG else system, rc.Drag(1.0, diameter=0.01), angular_speed=3.0
    ),
    "tune": lambda system: rc.tune(system, angular_speed=9.0),
    "fit": lambda system: rc.fit(system, {1: (9.0, 0.1)}, vary="length"),
    "explain": lambda system: rc.explain(system, 1),
    "stability": lambda system: rc.steady_shapes(system, angular_speed=9.0)[0].stability(),
    "shape.sensitivity": lambda system: rc.steady_shapes(system, angular_speed=9.0)[0].sensitivity,
    "sensitivity": lambda system: rc.modes(system, 2).sensitivity,
    "uncertainty": lambda system: rc.modes(system, 2).uncertainty(mass=0.05),
    "uncertainty(worst=True)": lambda system: rc.modes(system, 2).uncertainty(mass=0.05, worst=True),
}
BENT = {name: "is bent.*use steady_shapes" for name in ("held, span", "held cord, span")}
TAUT = {name: "use steady_shapes" for name in ("held", "held cord")}
CELLS = {  # question: system: None for an answer, or words of the reason and of what to ask instead
    "modes": BENT,
    "count_modes": BENT,
    "steady_shapes": {},
    "steady_shape": TAUT,
    "branches": TAUT,
    "branch": TAUT,
    "response": {"cord": "use its chain: cord.chain", "held": "use steady_shapes"},
    "swing": {"held": "use its modes"},
    "campbell": {"cord": "use its chain: cord.chain", "held": "use steady_shapes and stability"},
    "drag_shape": {
        "chain": "on the axis a chain with drag has no steady whirl.*give the support a radius",
        "cord": "use its chain", "held": "use steady_shapes, without drag",
    },
    "tune": dict.fromkeys(BENT, "is bent.*give top_tension"),
    "fit": dict.fromkeys(BENT, "is bent.*tune with top_tension"),
    "explain": BENT,
    "stability": {},
    "shape.sensitivity": {"cord": r"cut the cord into links: cord\.chain\(100\)", "held cord, span": "cut the cord into links"},
    "sensitivity": {"held": "is for a Chain, a Rig or a Cord", **BENT},
    "uncertainty": {"held": "is for a Chain, a Rig or a Cord", **BENT},
    "uncertainty(worst=True)": {"held": "is for a Chain, a Rig or a Cord", **BENT},
}
KINDS = {"chain": RODS, "rig": RIG, "cord": CORD, "held": HELD, "held, span": SPAN}
KINDS |= {"held cord": CORD_TAUT, "held cord, span": CORD_HELD}
WHOLLY_HELD = {"response", "swing", "campbell", "drag_shape"}  # refuse all that is held alike


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("question", QUESTIONS)
def test_cells(question, kind):
    refusals = CELLS[question]
    reason = refusals.get(kind, refusals.get("held") if question in WHOLLY_HELD and "held" in kind else None)
    if kind in TAUT and question in ("stability", "shape.sensitivity"):
        pytest.skip("no shape at this tension and speed")
    if reason is None:
        answer = QUESTIONS[question](KINDS[kind])
        assert answer is not None
        return
    with pytest.raises(ValueError, match=reason) as error:
        QUESTIONS[question](KINDS[kind])
    assert str(error.value).startswith("revchain.")


def test_a_rig_is_tuned_by_its_spring_and_its_wheels():
    for vary, speed in (("support.stiffness", 2.0), ("flywheels[1].momentum", -3.0)):
        tuned = rc.tune(RIG, vary=vary, angular_speed=speed)
        assert np.abs(rc.modes(tuned.system).angular_speed - speed).min() < 1e-13 * abs(speed)
        assert rc.tune(RIG, vary=vary, mode=3, angular_speed=speed).status == "no_value"
    assert rc.tune(RIG, vary="support.stiffness", angular_speed=4.0).status == "no_value"  # it would have to push


@pytest.mark.parametrize("system", [RODS, BELL, CORD, SYSTEMS["cord of a density"]], ids=repr)
def test_the_length_that_gives_a_speed(system):
    tuned = rc.tune(system, mode=2, angular_speed=12.0)
    again = rc.modes(tuned.system, 1, first=2)
    assert math.isclose(again.angular_speed[0], 12.0, rel_tol=4e-15)
    assert type(tuned.system) is type(system) and tuned.complete
    assert rc.tune(tuned.system, mode=2, angular_speed=12.0).value == pytest.approx(tuned.value, rel=1e-14)


def test_what_is_no_system():
    for ask in QUESTIONS.values():
        with pytest.raises(TypeError, match="system must be a revchain"):
            ask("chain")


# ---- mass, weight, gravity, order, names


def test_forces_come_out_in_newtons_of_masses():
    g = 1.62
    bells = BELL, rc.Chain(weight=MASS * g, **BODIES)
    ropes = [rc.Held(rc.Chain.uniform_rods(9, **heavy), span=0.5) for heavy in ({"mass": 2.0}, {"weight": 2.0 * g})]
    cords = rc.Cord(1.0, mass=2.0, tip_mass=0.3), rc.Cord(1.0, weight=2.0 * g, tip_weight=0.3 * g)
    shape = lambda system: rc.steady_shapes(system, angular_speed=9.0, gravity=g)[0]  # noqa: E731
    for ask in (
        lambda c: shape(c).tension,
        lambda c: shape(c).angular_momentum,
        lambda c: shape(c).effective_energy,
        lambda c: shape(c).force_diagram().load,
        lambda c: rc.branch(c, 1, max_angular_speed=9.0, gravity=g).top_tension,
        lambda c: rc.response(c, angular_speed=4.0, gravity=g).support_force,
        lambda c: rc.swing(c, 1.0, offset=[0.01, 0.0], gravity=g).energy,
        lambda c: rc.modes(rc.Held(c, tension=2e5), gravity=g).angular_speed,
        lambda c: rc.steady_shape(c, mode=1, top_tension=1.5 * MASS.sum() * g, gravity=g).angular_speed,
    ):
        np.testing.assert_allclose(*map(ask, bells), rtol=2e-13, atol=1e-13)
    for pair in (ropes, cords):
        np.testing.assert_allclose(*(shape(each).tension for each in pair), rtol=1e-13)


@pytest.mark.parametrize("name", ["effective_energy", "moment_of_inertia"])
def test_a_number_that_shapes_of_cords_do_not_have(name):
    shape = rc.steady_shapes(rc.Cord(1.0), angular_speed=9.0)[0]
    with pytest.raises(AttributeError, match=f"revchain.SteadyShape.{name}: this Cord does not have it"):
        getattr(shape, name)


@pytest.mark.parametrize("g", [9.80665, 1.62, 24.8])
def test_rigs_by_mass_and_by_weight(g):
    def rig(name, unit):
        chain = rc.Chain(**{name: unit * np.array([1.0, 2.0])}, length=0.5, centroid=0.2, radius_of_gyration=0.1)
        return rc.Rig(
            chain,
            support=rc.Support(**{name: unit * 0.3}, stiffness=40.0),
            flywheels=rc.Flywheel(**{name: unit * 0.4}, radius_of_gyration=0.1, spin=[50.0, -9.0], driven=[True, False]),
            displaced=rc.Displaced(**{name: unit * 0.1, f"added_{name}": unit * 0.05}),
        )

    rigs = rig("mass", 1.0), rig("weight", g)
    one, other = (rc.modes(each, gravity=g) for each in rigs)
    np.testing.assert_allclose(one.angular_speed, other.angular_speed, rtol=1e-13)
    for name, factor in {"stiffness": 1.0, "momentum": 1.0, "mass": g}.items():
        np.testing.assert_allclose(one.sensitivity[name], factor * other.sensitivity[name], rtol=1e-9, atol=1e-12)
    driven = (rc.response(each, angular_speed=3.0, gravity=g, support_radius=0.1).support_force for each in rigs)
    np.testing.assert_allclose(*driven, rtol=1e-13)
    shapes = (rc.steady_shapes(each, angular_speed=9.0, gravity=g) for each in rigs)
    np.testing.assert_allclose(*(sum(shape.angular_momentum for shape in found) for found in shapes), rtol=1e-11)


def test_what_a_chain_was_given_by():
    for chain, given, other in ((BELL, "mass", "weight"), (rc.Chain(weight=1.0, length=1.0), "weight", "mass")):
        assert np.array_equal(getattr(chain, given), np.broadcast_to(getattr(chain, given), chain.size))
        assert getattr(chain, f"total_{given}") == getattr(chain, given).sum()
        for name in (other, f"total_{other}"):
            with pytest.raises(AttributeError, match=f"was given by {given}: it has no {name}"):
                getattr(chain, name)
        for call, words in (
            (lambda: chain.with_body(**{other: 1.0}), f"given by {given}: give {given}, not {other}"),
            (lambda: rc.Rig(chain, support=rc.Support(**{other: 1.0}, stiffness=1.0)), f"given by {given}"),
            (lambda: rc.tune(chain, vary=f"links[0].{other}", angular_speed=1.0), f"given by {given}"),
        ):
            with pytest.raises(ValueError, match=words):
                call()
    for both in ({"mass": 1.0, "weight": 1.0}, {}):
        with pytest.raises(ValueError, match="give either mass, in kg, or weight, in N"):
            rc.Chain(length=1.0, **both)
    assert BELL != rc.Chain(weight=MASS, **BODIES)


def test_order_of_the_links():
    turned = {name: values[::-1] for name, values in BODIES.items()}
    assert rc.Chain(mass=MASS[::-1], **turned, order="support first") == BELL
    named = rc.Chain(mass=[3.0, 1.0], length=1.0, names=["hook block", "load"], order="support first")
    assert named == POINTS and named.names == ("load", "hook block")
    kept = rc.Chain.from_dict({"system": "Chain", "mass": [1.0, 2.0], "length": 1.0, "order": "support first"})
    assert kept.mass.tolist() == [2.0, 1.0]
    with pytest.raises(ValueError, match="order must be one of free end first, support first, got 'top first'"):
        rc.Chain(mass=1.0, length=1.0, order="top first")
    for names in ("ab", ["a"], ["a", 2]):
        with pytest.raises(ValueError, match="names must"):
            rc.Chain(mass=[3.0, 1.0], length=1.0, names=names)


def test_gravity_is_kept_in_the_result():
    m = rc.modes(POINTS, gravity=1.62)
    assert m.gravity == 1.62 and m.with_gravity("9.81 m/s^2").gravity == 9.81
    assert np.array_equal(m.with_gravity(9.81).angular_speed, rc.modes(POINTS, gravity=9.81).angular_speed)
    assert rc.steady_shapes(POINTS, angular_speed=3.0, gravity=1.62)[0].gravity == 1.62
    held, by_weight = (rc.Held(rc.Chain.uniform_rods(5, length=1.0, **{by: 1.0}), tension=30.0) for by in ("mass", "weight"))
    with pytest.raises(ValueError, match="tension in newtons.*call revchain.modes again"):
        rc.modes(held).with_gravity(1.62)
    moon = rc.modes(by_weight, gravity=1.62)
    assert np.array_equal(rc.modes(by_weight).with_gravity(1.62).angular_speed, moon.angular_speed)


# ---- units


def test_numbers_with_units():
    pint = pytest.importorskip("pint")
    unit = pint.UnitRegistry()
    inch = rc.Chain(mass=["1 lb", 0.5], length=39 * unit.inch)
    assert inch.length == pytest.approx([0.9906] * 2, rel=1e-15) and inch.mass[0] == pytest.approx(0.45359237)
    assert rc.Chain(mass=[1.0, 2.0] * unit.gram, length=[10, 20] * unit.cm).length.tolist() == [0.1, 0.2]
    m = rc.modes(POINTS, angular_speed=("10 rpm", 3 * unit.rad / unit.s), gravity="981 cm/s^2", rtol="1 %")
    assert len(m) == 1 and m.gravity == 9.81 and m.rtol == 0.01
    assert rc.count_modes(POINTS, angular_speed=["1 rpm", "200 rpm"]).tolist() == [0, 2]
    assert rc.steady_shape(POINTS, lowest_inclination="20 deg").inclination[0] == pytest.approx(math.radians(20))
    assert rc.Held(rc.Cord("1 m"), span="50 cm").span == 0.5
    assert rc.Flywheel(mass="200 g", radius_of_gyration="5 cm", spin="3000 rpm").spin == pytest.approx(100 * math.pi)
    turns = [rc.steady_shapes(POINTS, angular_speed=speed).angular_speed for speed in ("2 Hz", "2 rev/s", 2 * unit.Hz, "120 RPM")]
    assert turns == pytest.approx([4 * math.pi] * 4, rel=1e-15)  # a frequency is in turns
    by_parts = rc.modes(POINTS).uncertainty(mass=["5 %", 0])
    assert by_parts == rc.modes(POINTS).uncertainty(mass=[0.05 * 1.0, 0.0])
    assert by_parts == rc.modes(POINTS).uncertainty(mass=np.array(["5 %", "0 kg"]))
    assert rc.modes(POINTS).uncertainty(length="1 %") == rc.modes(POINTS).uncertainty(length=["1 %", "1 cm"])
    for array in (np.array(["5 %", 0]), np.array(["5 %", "0"]), np.array(["5 %", 0], dtype=object)):
        assert rc.modes(POINTS).uncertainty(mass=array) == by_parts
    assert rc.Chain(mass=np.array(["1 kg", "300 g"]), length=[np.array("1 m"), 2]) == rc.Chain(mass=[1, 0.3], length=[1.0, 2.0])
    assert rc.response(POINTS, angular_speed=np.array([["30 rpm"], ["60 rpm"]])).angular_speed.shape == (2, 1)
    assert rc.response(POINTS, angular_speed="30 rpm", support_radius="1 cm").support_radius == 0.01
    assert rc.swing(POINTS, "2 min", offset=["1 cm", 0.0]).time.tolist() == [120.0]


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: rc.Chain(mass="2 m", length=1.0), r'mass must be a mass such as "2 kg", got "2 m"'),
        (lambda: rc.Chain(mass="20 N", length=1.0), r'mass must be a mass .*; give it as weight'),
        (lambda: rc.Chain(weight="2 kg", length=1.0), r'weight must be a force .*; give it as mass'),
        (lambda: rc.Chain(mass=1.0, length="2,5 m"), 'the decimal mark is a point: write "2.5 m"'),
        (lambda: rc.Chain(mass=np.array(["1 kg", "2 m"]), length=1.0), r'mass must be a mass such as "2 kg", got "2 m"'),
        (lambda: rc.Chain(mass=1.0, length="2 parsnips"), r"length has a unit that is not known"),
        (lambda: rc.modes(POINTS, gravity="9.81 m/s"), r"gravity must be an acceleration"),
        (lambda: rc.modes(POINTS, "3 m"), r"count must be a number or \"all\""),
        (lambda: rc.steady_shapes(POINTS, angular_speed="3 Hz m"), r"angular_speed must be an angular speed"),
        (lambda: rc.Cord("2 kg"), r"length must be a length"),
    ],
)
def test_wrong_units(ask, message):
    pytest.importorskip("pint")
    with pytest.raises(ValueError, match=message):
        ask()


# ---- names and speed


def test_results_are_not_made_by_hand():
    kinds = [kind for name in dir(rc) if isinstance(kind := getattr(rc, name), type) and issubclass(kind, Result)]
    assert len(kinds) > 15
    for kind in kinds:
        if "__init__" not in vars(kind):
            with pytest.raises(TypeError, match=rf"^revchain.{kind.__name__}: is what a question returns"):
                kind()


def test_hasattr_of_every_attribute():
    """An attribute is there, or it is not; other errors than AttributeError would end `hasattr` and completion."""
    things = [*SYSTEMS.values(), rc.Support(), rc.Flywheel(momentum=1.0), rc.Displaced(weight=0.1)]
    things += [rc.modes(each) for each in SYSTEMS.values() if not isinstance(each, rc.Held) or each.span is None]
    things += [rc.modes(rc.Held(POINTS, tension=60.0)), rc.modes(rc.Held(rc.Cord(1.0), tension=19.0))]
    bent = [POINTS, SYSTEMS["rig"], rc.Cord(1.0), rc.Held(RODS, span=0.9), rc.Held(rc.Cord(1.0), span=0.6)]
    for system in bent:
        found = rc.steady_shapes(system, angular_speed=12.0)
        things += [found, found[0], rc.branches(system, max_angular_speed=12.0)]
    things += [rc.tune(POINTS, angular_speed=3.0), rc.explain(POINTS), rc.swing(POINTS, [0.0, 1.0], offset=[0.1, 0.05, 0.0])]
    missing = {f"{type(thing).__name__}.{name}" for thing in things for name in dir(thing) if not hasattr(thing, name)}
    assert {"SteadyShape.sensitivity", "SteadyShape.arc_length", "Branches.complete", "Modes.sensitivity", "Chain.weight"} <= missing
    with pytest.raises(ValueError, match="cut the cord into links"):  # which it was and stays, too
        things[things.index(found[0])].sensitivity  # noqa: B018


def test_public_names():
    shown = [name for name in dir(rc) if not name.startswith("_")]
    assert len(shown) <= 71 and not {"annotations", "questions", "systems", "np", "Any"} & set(shown)
    assert all(name in rc.__doc__ for name in shown)
    words = pydoc.render_doc(rc, renderer=pydoc.plaintext)
    assert len(words.splitlines()) < 10 * 60


def test_what_is_good_does_not_depend_on_what_was_read():
    """A table is marked where something was not found or not proved, whichever fields were read before."""
    one = rc.branches(rc.Chain.uniform_plummets(3, length=3.0), min_conical_height=0.04, budget=10)
    assert not one.complete and not one._is_good() and not pickle.loads(pickle.dumps(one))._is_good()
    assert rc.branches(SPAN, max_angular_speed=9.0)._is_good()
    tuned = rc.tune(RIG, vary="links[0].mass", angular_speed=2.0)
    assert tuned.status == "found" and not tuned.complete and tuned._is_good()
    assert not rc.tune(POINTS, vary="links[0].mass", conical_height=2.5)._is_good()
    assert rc.modes(RODS)._is_good() and not rc.modes(RODS, rtol=1e-40)._is_good()


def test_classes_of_results_can_be_imported(repository):
    """A class of which a program receives an object is in the package, for isinstance and annotations."""
    for module in pkgutil.iter_modules(results.__path__, "revchain.results."):
        importlib.import_module(module.name)
    received = {name for name in CLASSES if name[0] != "_"} - {"Results", "Solved", "PairShape"}
    assert len(received) <= 30 and all(getattr(rc, name) is CLASSES[name] for name in received), sorted(received)
    reference = (repository / "docs/reference/python.rst").read_text(encoding="utf-8").split()
    assert received <= set(reference) and set(dir(rc)) - {"__version__"} <= set(reference)


@pytest.mark.parametrize(
    ("ask", "message"),
    [
        (lambda: rc.modes(rc.Held(POINTS, tension=5.0)), "must exceed the weight 39.2266, .*, got 5$"),
        (lambda: rc.steady_shape(POINTS, top_tension=20.0), "more than the weight 39.2266 of the chain, got 20$"),
        (lambda: rc.Flywheel(momentum=1.0, driven=True), "driven goes with mass"),
        (lambda: rc.tune(RIG, vary="support.stiffness", mode=99, angular_speed=2.0), "mode must be from 1 to 4, got 99"),
        (lambda: rc.Chain.from_dict({**POINTS.to_dict(), "lenght": 3}), "there is no lenght"),
        (lambda: rc.count_modes(POINTS, conical_height=1.0, gravity=-1), "gravity must be positive"),
        (lambda: rc.Chain(mass=[-1.0], length=1.0), r"^revchain.Chain: links\[0\]: mass must be finite and not negative, got -1$"),
        (lambda: rc.Chain.uniform_rods(5, mass=-1.0), "^revchain.Chain.uniform_rods: mass must be positive"),
        (lambda: POINTS.with_body(mass=-1.0), "^revchain.Chain.with_body: mass must be positive"),
        (lambda: rc.modes(POINTS).uncertainty(mass=-1.0), "^revchain.Modes.uncertainty: mass must be finite"),
        (lambda: rc.modes(POINTS, 3), "^revchain.modes: count must not exceed the 2 modes"),
        (lambda: rc.explain(CORD, "all"), "infinitely many modes"),
        (lambda: rc.explain(POINTS, 3), "there are 2 modes, got first = 1 and count = 3"),
        (lambda: rc.explain(rc.Held(CORD, tension=9.0)), "must exceed the weight 29.42"),
        (lambda: rc.modes(rc.Held(CORD, tension=90.0), "all"), "a cord has infinitely many modes"),
        (lambda: rc.modes(CORD, angular_speed=(0, np.inf)), "at a height above 0, or at a finite speed; its lowest height is 0$"),
        (lambda: rc.modes(rc.Rig(rc.Chain.uniform_rods(1001), pins=rc.Pin(damping=1.0))), "^revchain.modes: .* 1000 links, got 1001$"),
        (lambda: rc.modes(CORD, 10**12), r"^revchain.modes: count is too large, got 1000000000000: it would take .* GiB"),
        (lambda: rc.modes(POINTS).uncertainty(mass="abc %"), r'mass must be a number, or a part of it such as "5 %"'),
    ],
)
def test_messages(ask, message):
    with pytest.raises(ValueError, match=message):
        ask()


def test_all_modes_below_two_ulp():
    every = rc.modes(POINTS, "all", rtol=1e-20)
    assert every.method == rc.modes(POINTS, 2, method="double-double").method and every.status == "success"
    assert rc.explain(POINTS, "all").meets_tolerance


def public_functions():
    for name in dir(rc):
        thing = getattr(rc, name)
        if inspect.isfunction(thing):
            yield name, thing
        for method, member in vars(thing).items() if inspect.isclass(thing) or inspect.ismodule(thing) else ():
            member = getattr(member, "__func__", member)
            ours = inspect.isfunction(member) and member.__module__.startswith("revchain")
            if ours and not method.startswith("_"):
                yield f"{name}.{method}", member


def test_public_functions_say_what_they_return():
    returned = {name: inspect.signature(function).return_annotation for name, function in public_functions()}
    assert len(returned) > 100
    assert [name for name, kind in returned.items() if kind in ("Any", Any, inspect.Signature.empty)] == []
