# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public callable with wrong arguments: only ValueError and TypeError come out, in sentences of this package."""

import importlib
import inspect
import pkgutil
import re
import sys
import types

import numpy as np
import pytest

import revchain as rc

WRONG = {
    "None": None,
    "text": "x",
    "null byte": "a\0b",
    "bytes": b"x",
    "ragged": [[1, [2]]],
    "empty": [],
    "dict": {"a": 1},
    "nan": float("nan"),
    "inf": float("inf"),
    "complex": 1j,
    "minus one": -1,
    "-1.5": -1.5,
    "zero": 0,
    "4e18": 4 * 10**18,
    "1e30": 10**30,
    "1e5000": 10**5000,
    "1e300": 1e300,
    "1e-300": 1e-300,
    "masked": np.ma.masked,
    "object": object(),
    "function": lambda *_: "x",
    "words": ["a", "b"],
    "three axes": np.ones((2, 3, 2)),
    "nans": [float("nan"), 1.0],
}
FOREIGN = re.compile(
    r"incompatible (function|constructor) arguments|setting an array element|truth value|vector::|embedded null"
    r"|bad_alloc|unable to cast|must be real number, not|object of type|unsupported operand|not supported between|cannot convert"
    r"|could not convert|only (0-dimensional|length-1|integer)|inhomogeneous|cannot unpack|not enough values"
    r"|too many values|invalid literal|has no attribute|int too large|out of bounds|broadcast together|slice indices|is not iterable"
    r"|not callable|exceeds the limit|cannot be interpreted|not subscriptable|array is too big|maximum allowed"
    r"|too many indices|ufunc|is not in (list|tuple)|iteration over|does not support|unhashable|expected str",
    re.IGNORECASE,
)

CHAIN = rc.Chain(weight=[1.0, 2.0], length=[1.0, 0.5])
RIG = rc.Rig(rc.Chain.uniform_rods(3, length=2.0, weight=3.0), support=rc.Support(stiffness=5.0))
CARRIED = rc.Rig(CHAIN, support=rc.Support(radius=0.5))
CORD, HELD = rc.Cord(1.0), rc.Held(CHAIN, span=1.0)
ASK = {"shapes": {"conical_height": 0.4}, "response": {"conical_height": [0.4]}, "swing": {"offset": [0.1, 0.1, 0.1]}}
SCENE = {"links": [{"mass": 1, "length": 1, "repeat": 3}], "ask": ASK}
STUDY = {"find": ["modes"], "scene": SCENE, "vary": {"gravity": {"values": [9.0, 10.0]}}}
# What a parameter of that name is given where it must be given; by function where another is needed or one of several.
GIVEN = {
    "chain": CHAIN,
    "system": CHAIN,
    "mode": 1,
    "count": 2,
    "data": SCENE,
    "study": STUDY,
    "path": "missing.npz",
    "link": 0,
    "velocity": None,
    "time": [0.0, 1.0],
    "point": 0,
    "status": "success",
    "ratio": 0.5,
    "exponent": 0.5,
    "measured": {1: 3.0},
    "vary": "length",
    "tip": 0.5,
    "x": 0.5,
    "pin": 1,
    "span": 0.4,
    "modulus": 0.5,
    "characteristic": 0.3,
    "least_radius": 0.5,
    "greatest_radius": 1.0,
    "angle": 0.3,
    "first": 1,
    "offset": [0.1, 0.05, 0.0],
}
ONE_OF = {
    "Branch.shape": {"point": 3},
    "branch": {"min_conical_height": 0.4},
    "branches": {"max_angular_speed": 30.0},
    "Chain": {"weight": 1.0, "length": 1.0},
    "Chain.with_body": {"weight": 1.0},
    "Chain.from_dict": {"data": CHAIN.to_dict()},
    "Rig.from_dict": {"data": RIG.to_dict()},
    "Cord.from_dict": {"data": CORD.to_dict()},
    "Held.from_dict": {"data": HELD.to_dict()},
    "Held": {"span": 0.5},
    "Flywheel": {"momentum": 0.1},
    "campbell": {"angular_speed": [6.0, 8.0]},
    "Drag": {"diameter": 0.1},
    "drag_shape": {"system": CARRIED, "drag": rc.Drag(1.0, diameter=0.1), "angular_speed": 2.0},
    "SupportMotion": {"time": [0.0, 1.0], "velocity": [1.0, 0.0]},
    "Displaced": {"weight": 0.1},
    "count_modes": {"conical_height": 0.4},
    "steady_shapes": {"conical_height": 0.4},
    "steady_shape": {"conical_height": 0.4},
    "response": {"conical_height": 0.4},
    "tune": {"conical_height": 0.5},
    "SkippingRope": {"span": 1.0, "length": 1.5},
    "Branch.at": {"conical_height": 0.4},
    "conical_heights": {"weight": [1.0, 1.0]},
    "funicular_polygon": {"weight": [1.0, 1.0], "position": [0.0, 1.0, 2.0, 3.0]},
    "transverse_modes": {"weight": [1.0, 1.0], "position": [0.0, 1.0, 2.0, 3.0]},
    "two_links.joint_without_bending": {"length": 1.0, "pin": 0.3},
    "two_links.pin_of_silent_clapper": {},
    "from_mjcf": {"source": rc.to_mjcf(CHAIN)},
    "from_urdf": {"source": rc.to_urdf(CHAIN)},
    "Scene.branches": {"max_angular_speed": 5.0},
    "Scene.campbell": {"angular_speed": [5.0, 6.0]},
    "Study.from_dict": {"data": STUDY},
}
WRITTEN = {  # by method: a film of a few frames
    "animate": {"path": "film.html", "duration": 0.2},
    "to_excel": {"path": "result.xlsx"},
    "report": {"path": "report.html"},
    "to_glb": {"path": "solid.glb", "duration": 0.2},
}
# Some are loaded when first asked for: all of them here, so that the list does not depend on which tests came before.
FILES = [
    importlib.import_module(one.name)
    for one in pkgutil.walk_packages(rc.__path__, "revchain.")
    if not one.name.endswith("._core") and "cli" not in one.name and "__main__" not in one.name
]
MODULES = [rc, *(one for one in FILES if hasattr(one, "__all__"))]


def objects():
    """Something of every class that has methods with parameters."""
    found = [CHAIN, RIG, rc.modes(RIG), rc.modes(CHAIN), rc.explain(CHAIN), rc.bell_and_clapper(CHAIN)]
    found += [rc.modes(RIG).uncertainty(weight=0.1), rc.modes(CHAIN).uncertainty(weight=0.1), rc.modes(CHAIN).sensitivity, rc.modes(RIG).sensitivity]
    found += [CORD, HELD, rc.modes(CORD)]
    shapes = rc.steady_shapes(CHAIN, conical_height=0.4)
    branches = rc.branches(CHAIN, max_angular_speed=30.0)
    found.append(rc.drag_shape(CARRIED, rc.Drag(1.0, diameter=0.1), angular_speed=2.0))
    found += [shapes, shapes[0], shapes[0].force_diagram(), branches, branches[0]]
    held = rc.steady_shapes(HELD, conical_height=0.1)
    cord = rc.steady_shapes(rc.Held(CORD, span=0.6), conical_height=0.1)
    found += [held[0], cord[0], rc.steady_shapes(CORD, conical_height=0.2)[0]]
    found += [rc.response(CHAIN, conical_height=[0.4, 0.5]), rc.swing(CHAIN, [0.0, 1.0], offset=[0.1, 0.05, 0.0])]
    found.append(rc.BufferImpact(front_mass=1.0, rear_mass=2.0, buffer_stiffness=3.0, coupling_stiffness=4.0, speed=1.0))
    found.append(rc.GovernorMotion(angular_speed=5.0, pendulum_length=1.0, angle=0.3))
    found.append(rc.GyrostaticString(weight=1.0, length=1.0, tension=9.0, momentum=1.0))
    found.append(rc.SkippingRope(span=1.0, length=1.5, angular_speed=20.0))
    found.append(rc.TortuousRope(least_radius=0.5, greatest_radius=1.0, angular_speed=2.0, tension=9.0))
    polygon = rc.funicular_polygon([1.0, 1.0], [0.0, 1.0, 2.0, 3.0], 1.0)
    found += [polygon, polygon.transverse_modes(), rc.Scene.from_dict(SCENE), rc.Study.from_dict(STUDY)]
    return found


def callables():
    """By name: functions, constructors that check what they are given, methods of classes and of objects."""
    found = {}
    for module in MODULES:
        for name, value in ((name, getattr(module, name)) for name in (dir(rc) if module is rc else module.__all__)):
            if not getattr(value, "__module__", "").startswith("revchain") or not callable(value):
                continue
            kind = isinstance(value, type)
            if module is not rc and getattr(rc, name, None) is value:
                continue  # found already
            label = name if module is rc else f"{module.__name__.rpartition('.')[2]}.{name}"
            if not kind or "__init__" in vars(value) and not hasattr(value, "__dataclass_fields__"):
                if not kind or not issubclass(value, BaseException):
                    found[label] = value
            if kind:
                for method, held in vars(value).items():
                    if method[0] != "_" and isinstance(held, (classmethod, staticmethod)):
                        found[f"{label}.{method}"] = getattr(value, method)
    for thing in objects():
        for name in dir(type(thing)):
            value = inspect.getattr_static(type(thing), name)
            if isinstance(value, types.FunctionType) and name[0] != "_":
                of = getattr(thing, "system", None)  # shapes of all systems are of one class
                label = f"{type(thing).__name__}{f' of a {type(of).__name__}' if isinstance(of, rc.Cord | rc.Held) else ''}"
                found[f"{label}.{name}"] = getattr(thing, name)
    found["GyrostaticString"] = rc.GyrostaticString
    bent = [f"SteadyShape of a {kind}.{name}" for kind in ("Cord", "Held") for name in ("force_diagram", "transferred_to_axis")]
    for refused in ("Modes.along", "Modes.slope", "SteadyShape.along", *bent):
        del found[refused]  # refuse whatever they are given: test_interface.py
    return found


CALLABLES = callables()


def baseline(name, function):
    """Arguments that are right, and the names of all parameters."""
    parameters = inspect.signature(function).parameters.values()
    named = [one.name for one in parameters if one.kind not in (one.VAR_KEYWORD, one.VAR_POSITIONAL)]
    needed = [one.name for one in parameters if one.default is one.empty and one.name in named]
    extra = ONE_OF.get(name, {})
    known = {**{one: GIVEN.get(one, 1.0) for one in needed}, **WRITTEN.get(name.rpartition(".")[2], {}), **extra}
    if name == "elliptic.jacobi":
        known["modulus"] = 0.5
    return known, named


# What is right, however much work it is: a step for each of a million places, a blow for each ratio of the masses.
WORK = {("Branch.stability_windows", "samples"), ("Branches.stability_windows", "samples"), ("BufferImpact", "rear_mass")}


def complaint(function, arguments):
    """What is wrong with how the call ends, or nothing."""
    try:
        with np.errstate(all="ignore"):
            function(**arguments)
    except (ValueError, TypeError) as error:
        sentence = str(error)
        return f"{type(error).__name__}: {sentence}" if not sentence.strip() or FOREIGN.search(sentence) else ""
    except IndexError as error:
        return "" if str(error).startswith("revchain.") else f"IndexError: {error}"
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return ""


@pytest.mark.parametrize("name", CALLABLES)
def test_one_argument_is_wrong(name, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    function = CALLABLES[name]
    known, named = baseline(name, function)
    found = {}
    for parameter in named:
        for label, wrong in WRONG.items():
            heavy = (name, parameter) in WORK and label in ("4e18", "1e30", "1e300")
            if heavy or (label == "1e5000" and parameter.endswith("_unit")):
                continue
            alone = {other: value for other, value in known.items() if other not in ONE_OF.get(name, {})}
            for given in (known, alone):  # beside what is given, and instead of it
                if sentence := complaint(function, {**given, parameter: wrong}):
                    found[parameter, label] = sentence[:300]
            if pyplot := sys.modules.get("matplotlib.pyplot"):
                pyplot.close("all")
    assert found == {}


def test_the_calls_without_a_wrong_argument_are_right(tmp_path, monkeypatch):
    """Else the arguments beside the wrong one would hide it."""
    pytest.importorskip("pyarrow")  # the calls save tables
    monkeypatch.chdir(tmp_path)
    files = ("load", "load_scene", "load_study")
    elsewhere = ("Scene.drag_shape", "Scene.equilibria")  # need an arm, or a governor: tests/python/test_examples.py
    for name, function in CALLABLES.items():
        if name not in files + elsewhere and not name.endswith((".index", "pin_of_silent_clapper")):
            function(**baseline(name, function)[0])
        if pyplot := sys.modules.get("matplotlib.pyplot"):
            pyplot.close("all")


@pytest.mark.parametrize("count", [4 * 10**18, 10**18])
def test_what_does_not_fit_in_the_memory_says_how_much_it_would_take(count):
    words = rf"too large, got {count}: it would take \d.*e\+\d+ GiB of memory, and this machine has \d+.* GiB"
    for call in (
        lambda: rc.modes(rc.Cord(1.0), count),
        lambda: rc.modes(rc.Cord(1.0), 1, first=count).nodes,
        lambda: rc.modes(rc.Cord(1.0), 1, first=count).vertical_points,
        lambda: rc.modes(rc.Cord(1.0, tip_mass=0.5), count),
        lambda: rc.modes(rc.Cord(1.0, density=0.5), count),
        lambda: rc.Chain.tapered(count, exponent=0.5),
        lambda: rc.modes(rc.Chain.uniform_rods(count), count=1),
        lambda: rc.count_modes(rc.Chain.uniform_rods(count), conical_height=0.1),
        lambda: rc.steady_shapes(rc.Chain.uniform_plummets(count), conical_height=0.1),
        lambda: rc.Chain.uniform_rods(count).weight,
        lambda: rc.Chain.uniform_rods(count).with_body(weight=1.0),
    ):
        with pytest.raises(ValueError, match=words):
            call()
    assert rc.explain(rc.Chain.uniform_rods(count), 1, rtol=1e-3).chosen is not None


def test_what_rigs_do_not_have():
    modes = rc.modes(RIG)
    with pytest.raises(ValueError, match="another gravity; call revchain.modes again"):
        modes.with_gravity(1.62)
    for name, value in {"method": "dense", "precision": "extended"}.items():
        with pytest.raises(ValueError, match=f"revchain.modes: {name} is for a Chain"):
            rc.modes(RIG, **{name: value})


def test_lists_of_results():
    shapes = rc.steady_shapes(CHAIN, conical_height=0.2)
    for place, shape in enumerate(shapes):
        assert shapes.index(shape) == place and shapes.count(shape) == 1 and shape in shapes
        assert shapes.index(shape, -len(shapes), len(shapes)) == place
    with pytest.raises(ValueError, match="index: none of the"):
        shapes.index(shapes[0], 1)
    assert np.ones(3) not in shapes and shapes.count(np.ones(3)) == 0
