# SPDX-License-Identifier: GPL-3.0-or-later
"""Every public thing is described, in numpydoc form, with an example that runs."""

import doctest
import importlib
import inspect
import pkgutil

import pytest

import revchain as rc
from revchain.results.base import Field

MODULES = [
    importlib.import_module(module.name)
    for module in pkgutil.walk_packages(rc.__path__, "revchain.")
    if not module.name.endswith(("._core", ".__main__"))
]


def public():
    """(name, object) of every public function, class and method."""
    for module in (rc, *(each for each in MODULES if hasattr(each, "__all__"))):
        for name in [*dir(rc), *rc._RECEIVED] if module is rc else module.__all__:
            thing = getattr(module, name)
            if inspect.isfunction(thing) or inspect.isclass(thing):
                yield f"{module.__name__}.{name}", thing
            for method, member in vars(thing).items() if inspect.isclass(thing) else ():
                member = getattr(member, "__func__", member)
                if not method.startswith("_") and inspect.isfunction(member):
                    yield f"{module.__name__}.{name}.{method}", member


PUBLIC = dict(public())


def test_there_is_enough():
    finder = doctest.DocTestFinder()
    assert len(PUBLIC) > 150 and len(ATTRIBUTES) > 300
    assert sum(len(each.examples) for module in MODULES for each in finder.find(module)) > 80


@pytest.mark.parametrize("name", PUBLIC)
def test_described(name):
    thing = PUBLIC[name]
    text = inspect.getdoc(thing)
    lines = text.splitlines()
    assert lines[0].endswith(".")
    if inspect.isfunction(thing):
        sections = {line for line, under in zip(lines, lines[1:], strict=False) if under.startswith("---")}
        assert ">>> " in text and "Examples" in sections
        parameters = [each for each in inspect.signature(thing).parameters if each not in ("self", "cls")]
        assert ("Parameters" in sections) == bool(parameters)
        for parameter in parameters:
            assert parameter in text.partition("Parameters")[2].partition("Returns")[0], parameter
        assert "Returns" in sections or inspect.signature(thing).return_annotation in (None, "None")


def attributes():
    """(name, object) of every field and property of public classes, also of those that they inherit."""
    for name, kind in PUBLIC.items():
        for attribute in dir(kind) if inspect.isclass(kind) else ():
            member = inspect.getattr_static(kind, attribute)
            if attribute[0] != "_" and isinstance(member, Field | property):
                yield f"{name}.{attribute}", member


ATTRIBUTES = dict(attributes())


@pytest.mark.parametrize("name", ATTRIBUTES)
def test_attributes_are_described(name):
    assert inspect.cleandoc(ATTRIBUTES[name].__doc__).endswith(".")


@pytest.mark.parametrize("module", [rc, *MODULES], ids=lambda module: module.__name__)
def test_examples_run(module, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = doctest.testmod(module)
    assert result.failed == 0
