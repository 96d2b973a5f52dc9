# SPDX-License-Identifier: GPL-3.0-or-later
"""Pickles: with every protocol each object either comes back equal or raises TypeError; none ends the process."""

import copy
import pickle

import pytest

import revchain as rc
from revchain import _core

CHAIN = rc.Chain(weight=[1.0, 2.0], length=[1.0, 0.5])
PROTOCOLS = range(pickle.HIGHEST_PROTOCOL + 1)


def compiled():
    """One object of each compiled class that results hold."""
    wheel = rc.Rig(CHAIN, flywheels=rc.Flywheel(momentum=1.0))
    shapes = _core.steady_shapes(CHAIN._compiled, 0.3, None, 9.8, 1, True, 1, True, 10_000, 1)
    yield from (CHAIN._compiled, shapes, shapes.shapes[0], _core.Progress(), wheel._under(9.8))
    yield _core.stability(CHAIN._compiled, shapes.shapes[0], False, 1, 9.8)
    yield from (rc.modes(system)._found() for system in (CHAIN, wheel))


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_compiled_objects(protocol):
    for found in compiled():
        if type(found) is _core.Chain:
            assert pickle.loads(pickle.dumps(found, protocol)) == found
        else:
            with pytest.raises(TypeError, match=f"cannot pickle 'revchain._core.{type(found).__name__}' object"):
                pickle.dumps(found, protocol)


def test_every_compiled_class_refuses_the_old_protocols():
    base = next(kind for kind in _core.Chain.__mro__ if kind.__name__ == "pybind11_object")
    kinds = [kind for kind in base.__subclasses__() if kind.__module__ == "revchain._core"]
    assert len(kinds) > 20
    for kind in kinds:
        assert "__reduce_ex__" in vars(kind), kind


@pytest.mark.parametrize("protocol", PROTOCOLS)
def test_scenes_and_studies(protocol, repository):
    pytest.importorskip("msgspec")
    given = [rc.load_scene(path) for path in (repository / "examples/scenes").glob("*.toml")]
    given += [rc.load_study(path) for path in (repository / "examples/studies").glob("*.toml")]
    given.append(rc.Scene.from_dict({"gravity": 9.80665, "links": [{"mass": 1, "length": 1}], "ask": {"modes": {"precision": "double"}}}))
    assert len(given) > 15
    for one in given:
        for again in (pickle.loads(pickle.dumps(one, protocol)), copy.deepcopy(one)):
            assert again == one and again.to_dict() == one.to_dict()
