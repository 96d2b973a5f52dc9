# SPDX-License-Identifier: GPL-3.0-or-later
"""The table of closed forms. Its rows are in other modules: typed functions without a body, decorated by `closed_form`.

The decorator gets the compiled function of the formula, the accuracy and the source. The short docstring has a summary;
paragraphs; lines ``name: text`` for `returns`, `raises`, `notes` and for arguments that the vocabulary below does not
describe well enough (lines that continue a text are indented); examples. `closed_form` checks the arguments, calls the
formula and writes the docstring with its numpydoc sections. `described` writes only the docstring.
"""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from functools import partial, update_wrapper
from math import inf
from textwrap import fill
from types import FunctionType
from typing import Any, ParamSpec, TypeAlias, TypeVar

import numpy as np

from ..systems.numbers import Floats, as_length, beside, floats, numbers, positive, real, refuse_where

P = ParamSpec("P")
R = TypeVar("R")
Formula: TypeAlias = Callable[..., Any]
Thing = TypeVar("Thing", bound=Formula)
FloatOrArray: TypeAlias = np.float64 | Floats

POSITIVE = {
    "angular_speed": 'Speed in rad/s (or a text such as "30 rpm" or "0.5 Hz")',
    "arm": "Length of the arm that carries the thread, perpendicular to the plane of axis and mass",
    "bell_centroid": "Distance of the centre of gravity of the bell below its axle",
    "bell_weight": "Weight of the bell",
    "buffer_stiffness": "Stiffness of the spring of the buffer",
    "centroid": "Distance of the centre of gravity of the link below its upper pin",
    "clapper_centroid": "Distance of the centre of gravity of the clapper below its pin",
    "clapper_weight": "Weight of the clapper",
    "coupling_stiffness": "Stiffness of the coupling, which pulls and pushes",
    "deflection": "Sideways deflection of the support under the weight of the pendulum",
    "distance": "Distance along the axis from the tie of the upper thread down to that of the lower one",
    "front_mass": "Mass of the front carriage",
    "gravity": "Acceleration of gravity in the unit of length per s^2 (standard gravity in m/s^2 if left out)",
    "greatest_radius": "Largest distance of the rope from the axis",
    "half_length": "Half the total length of both threads",
    "height": "Conical height ``gravity / angular_speed**2``",
    "hung_weight": "Weight of the lower plummet",
    "length": "Length of the thread",
    "lower_centroid": "Distance of the centre of gravity of the lower link below the joint",
    "lower_thread": "Length of the lower thread",
    "lower_weight": "Weight of the lower plummet or link",
    "pendulum_length": "Length of the simple pendulum with the period of the link",
    "period": "Time of one turn in s",
    "pin": "Distance of the pin from the middle of the rod",
    "radius": "Radius of the circle",
    "rear_mass": "Mass of the rear carriage",
    "rod": "Length of the rod of the upper plummet",
    "sag": "Largest distance of the rope from the axis",
    "seconds_pendulum": "Length of the simple pendulum that beats seconds under this gravity",
    "slack": "Length of the rope less the span",
    "span": "Distance between the ends",
    "speed": "Speed along the rim",
    "standing_weight": "Weight of the upper plummet",
    "stiffness": "Stiffness of the spring, force per length",
    "tension": "Tension, as the length of chain or rope of equal weight",
    "thread": "Length of the thread",
    "upper_length": "Distance from the support to the joint",
    "upper_thread": "Length of the upper thread",
    "upper_weight": "Weight of the upper plummet or link",
    "weight": "Weight",
}
NOT_NEGATIVE = {
    "bell_radius_of_gyration": "Radius of gyration of the bell about its centre of gravity",
    "clapper_radius_of_gyration": "Radius of gyration of the clapper about its centre of gravity",
    "lower_radius_of_gyration": "Radius of gyration of the lower link about its centre of gravity",
    "radius_of_gyration": "Radius of gyration of the link about its centre of gravity (0 for a plummet)",
    "upper_radius_of_gyration": "Radius of gyration of the upper link about its centre of gravity",
}
ANY = {
    "amplitude": "Angle in rad",
    "angle": "Angle in rad to the downward vertical at time 0",
    "angle_rate": "Rate of the angle in rad/s at time 0",
    "axial_inertia": "Moment of inertia about the line of the link, divided by that about the hinge; 0 to 1",
    "clearance": 'Angle of the clapper in the bell from the middle to contact, below pi/2 rad, or a text such as "25 deg"',
    "complementary_modulus": "Complementary modulus ``sqrt(1 - modulus**2)``, from 0 to 1",
    "first_height": "Height of the first support",
    "half_waves": "Number of half waves between the ends",
    "last_height": "Height of the last support",
    "modulus": "Modulus, from 0 to 1",
    "momentum": "Constant angular momentum of each wheel (moment of inertia times spin), force times length times time",
    "time": "Times in s, finite, any shape",
    "u": "Argument, finite, any shape",
    "upper_centroid": "Distance of the centre of gravity of the upper link below the support",
    "weight_ratio": "Lower weight divided by upper weight",
    "x": "Distance",
}
PICTURES = {  # arguments of the methods that draw
    "ax": "Axes to draw in; a new figure if left out",
    "axes": "Axes to draw in; a new figure if left out",
    "speed": 'Unit of the speeds: ``"rad/s"``, ``"rpm"``, ``"Hz"`` (turns per second) or ``"s"`` (the period); if left out, '
    "that of the question.",
}
_RANGES = {", positive.": POSITIVE, ", not negative.": NOT_NEGATIVE, ".": ANY}
_TYPES = {
    "ArrayLike": "array_like",
    "Iterable[int]": "iterable of int",
    "Axes": "matplotlib.axes.Axes",
    "tuple[Axes, Axes]": "pair of matplotlib.axes.Axes",
    "FloatOrArray": "float or ndarray",
    "Floats": "ndarray, shape (..., 2)",
    "Floats | list[Floats]": "ndarray, or list of ndarray",
}
_DRAWN = {"Axes": "The drawing."}
_NEEDS_MATPLOTLIB = "ImportError\n    If matplotlib is not installed; the message says how to install it."
_SHAPE = "Arrays have the broadcast shape of the arguments."
_BROADCAST = ", or if the shapes do not broadcast"

FORMS: dict[str, Form] = {}
"""The rows by name, such as ``"hoop.tension"``."""


class Form:
    """A row of the table: the typed function, the formula, the arguments with defaults, and how the answer is made."""

    def __init__(self, function: Formula, formula: Formula, made: Formula | None) -> None:
        self.name = f"{function.__module__.rpartition('.')[2]}.{function.__name__}"
        self.caller = f"revchain.{self.name}"
        self.function, self.formula = function, formula
        self.signature = inspect.signature(function)
        self.single = any(each.annotation == "float" for each in self.signature.parameters.values())
        result = function.__globals__.get(self.signature.return_annotation)
        if result is Floats:  # the two numbers of a pair are beside each other
            made = partial(np.stack, axis=-1)
        columns = hasattr(result, "_fields")
        self.made = made or (lambda found: result(*numbers(found)) if columns else found)  # type: ignore[misc]
        self.defaults = {name: each.default for name, each in self.signature.parameters.items()}

    def answer(self, given: tuple[Any, ...], named: dict[str, Any]) -> Any:
        """The answer to a call of the function with these arguments."""
        self.function(*given, **named)  # Python's own errors for arguments that are missing or unknown
        values = self.defaults | dict(zip(self.defaults, given, strict=False)) | named
        arrays = {name: self._checked(name, value) for name, value in values.items()}
        return self.made(self.formula(*(map(float, arrays.values()) if self.single else beside(self.caller, **arrays))))

    def _checked(self, name: str, value: Any) -> Floats:
        if self.single:
            value = real(self.caller, name, value)
        elif name == "tension":
            value = as_length(self.caller, name, value)
        if name in POSITIVE:
            return positive(self.caller, name, value)
        array = floats(self.caller, name, value)
        if name in NOT_NEGATIVE:
            refuse_where(~((array >= 0) & (array < inf)), array, f"{self.caller}: {name} must be finite and not negative")
        return array


def closed_form(
    formula: Formula, accuracy: str, source: str, *, cost: str = "O(1) for each number", made: Formula | None = None
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Make a row of the table, by a decorator that checks the arguments, calls the formula and writes the docstring.

    `made` turns what the formula returns into the answer; if left out, the type of the answer says how.
    """

    def decorated(function: Callable[P, R]) -> Callable[P, R]:
        form = Form(function, formula, made)

        def call(*given: Any, **named: Any) -> Any:
            return form.answer(given, named)

        # with the names of its module: doctest passes over functions of other modules
        made_here: Any = FunctionType(call.__code__, function.__globals__, function.__name__, None, call.__closure__)
        update_wrapper(made_here, function)
        made_here.__signature__ = form.signature
        FORMS[form.name] = form
        return described(accuracy, source, cost, computed=True)(made_here)  # type: ignore[no-any-return]

    return decorated


def described(
    accuracy: str = "", source: str = "", cost: str = "", *, computed: bool = False, bound: bool = False
) -> Callable[[Thing], Thing]:
    """Write the docstring of a function or a class from its signature and its short docstring, by a decorator.

    With `bound` the function is a method that draws its first argument, which the docstring leaves out.
    """

    def decorated(thing: Thing) -> Thing:
        if thing.__doc__ is None:  # Python was started with -OO
            return thing
        parameters = dict(inspect.signature(thing).parameters)
        parameters.pop(next(iter(parameters), "") if bound else "self", None)
        summary, prose, texts, examples = _read(thing.__doc__, {*parameters, "returns", "raises", "notes"})
        sections = [summary, *prose]
        if parameters:
            known = PICTURES | texts if bound else texts
            each = [f"{name} : {_type(one)}\n    {_text(name, known)}" for name, one in parameters.items()]
            sections.append(_section("Parameters", "\n".join(each)))
        result = "None" if inspect.isclass(thing) else inspect.signature(thing).return_annotation
        if result != "None":
            said = [text] if (text := texts.get("returns", _DRAWN.get(result, ""))) else []
            said += [_SHAPE] if computed and result == "FloatOrArray" or not said else []
            sections.append(_section("Returns", f"{_type_name(result)}\n    {' '.join(said)}"))
        refused = [texts["raises"]] if "raises" in texts else []
        if computed:
            broadcast = any(one.annotation == "ArrayLike" for one in parameters.values())
            refused.insert(0, f"If a number is out of its range or not finite{_BROADCAST if broadcast else ''}.")
        if bound and "speed" in parameters:
            refused.append("If `speed` is not one of the units.")
        raises = "ValueError\n    " + "\n    ".join(refused) if refused else ""
        if bound:
            raises += "\n" * bool(refused) + _NEEDS_MATPLOTLIB
        if raises:
            sections.append(_section("Raises", raises))
        facts = {"Accuracy": accuracy, "Cost": cost, "Source": source and f"Greenhill (1908), {source}"}
        notes = [texts.get("notes", ""), *(f"{name}: {fact}." for name, fact in facts.items() if fact)]
        if any(notes):
            sections.append(_section("Notes", fill(" ".join(" ".join(notes).split()), 100, break_on_hyphens=False)))
        sections.append(_section("Examples", examples.replace(">>> ", ">>> import revchain as rc\n>>> ", 1)))
        thing.__doc__ = "\n\n".join(sections) + "\n"
        return thing

    return decorated


def _read(docstring: str, names: set[str]) -> tuple[str, list[str], dict[str, str], str]:
    """The parts of a short docstring: the summary, the paragraphs, the texts by name, the examples."""
    head, *blocks = inspect.cleandoc(docstring).split("\n\n")
    start = next(k for k, block in enumerate(blocks) if ">>> " in block or block.endswith(":"))
    prose: list[str] = []
    texts: dict[str, str] = {}
    for block in blocks[:start]:
        parts = re.split(r"^(\w+): ", block, flags=re.MULTILINE)
        if len(parts) == 1:
            prose.append(block)
            continue
        assert parts[0] == "" and names >= set(parts[1::2]), f"{head}: these names are unknown: {parts[1::2]}"
        texts.update(zip(parts[1::2], (text.rstrip("\n") for text in parts[2::2]), strict=True))
    return head, prose, texts, "\n\n".join(blocks[start:])


def _section(title: str, text: str) -> str:
    return f"{title}\n{'-' * len(title)}\n{text}"


def _text(name: str, texts: dict[str, str]) -> str:
    """The text on an argument, from the row or the vocabulary. Its range is added where the text lacks one."""
    ending, vocabulary = next((each for each in _RANGES.items() if name in each[1]), (".", {}))
    text = texts.get(name) or vocabulary[name]
    return text if text.endswith(".") else text + ending


def _type(parameter: inspect.Parameter) -> str:
    name, union, _ = str(parameter.annotation).partition(" | None")
    optional = ", optional" if union or parameter.default is not parameter.empty else ""
    return _TYPES.get(name, name) + optional


def _type_name(annotation: str) -> str:
    name = re.sub(r"^list\[(.*)\]$", r"list of \1", annotation).replace(" | None", " or None")
    return _TYPES.get(name, name)
