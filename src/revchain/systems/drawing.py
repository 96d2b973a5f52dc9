# SPDX-License-Identifier: GPL-3.0-or-later
"""How a system or a result is drawn: by the function that `revchain.plots` names for its class."""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module
from types import MethodType
from typing import Any


class Plot:
    """The method `plot` of a class: the function for the class, with its own signature and docstring.

    It is imported on first use. A second one of a class has a `name`.
    """

    def __init__(self, name: str = "") -> None:
        self.name = name and f".{name}"

    def __get__(self, thing: Any, owner: type[Any]) -> Callable[..., Any]:
        names: dict[str, str] = import_module("revchain.plots").DRAWN_BY
        module, _, function = names.get(owner.__name__ + self.name, "").partition(".")
        if not function:
            raise AttributeError(f"a {owner.__name__} has no plot")
        draw: Callable[..., Any] = getattr(import_module(f"revchain.plots.{module}"), function)
        return draw if thing is None else MethodType(draw, thing)
