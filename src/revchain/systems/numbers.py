# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks of arguments, and conversion to the float64 arrays that the compiled module takes."""

from __future__ import annotations

import math
import operator
import os
import re
from collections.abc import Iterable, Iterator
from contextlib import suppress
from functools import cache
from numbers import Real
from typing import Any, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .. import _core
from . import units

Floats = NDArray[np.float64]
Numbers = NDArray[Any]  # float64 or longdouble, by the precision asked for
Whole = NDArray[np.int64]
Scalar = TypeVar("Scalar", bound=np.generic)

LARGEST = 2**63 - 1
_FLOAT64 = np.dtype(np.float64)
STANDARD_GRAVITY = 9.80665
"""Standard acceleration of gravity in m/s^2 (exact by definition, CGPM 1901)."""


def floats(caller: str, name: str, value: ArrayLike | None, quantity: str = "") -> Floats:
    """`value` as a float64 array, in SI if it has units; a ValueError if it is not of real numbers.

    `quantity` names the kind of unit, if the name does not.
    """
    if type(value) is np.ndarray and value.dtype is _FLOAT64 and value.flags.c_contiguous:
        return value
    if not isinstance(value, float) and units.has_units(value := units.unpacked(value)):
        value = units.in_si(caller, name, value, quantity)
    array = array_of(value)
    if array.dtype == object and all(isinstance(x, Real) and not isinstance(x, bool) for x in array.flat):
        with suppress(OverflowError):
            array = array.astype(np.float64)  # whole numbers beyond 64 bits, fractions
    if isinstance(value, (bytes, bytearray, memoryview)):
        array = np.asarray(None)
    if array.dtype.kind not in "iuf" or (array.size == 0 and array.ndim == 0):
        raise ValueError(f"{caller}: {name} must be a real number or an array of them, got {shown(value)}")
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ValueError(f"{caller}: {name} has masked entries")
    return array.astype(np.float64, order="C", copy=False)


def array_of(value: object) -> NDArray[Any]:
    """`value` as a numpy array; an array of None if numpy refuses it (a ragged list, for example)."""
    try:
        return np.asarray(value)
    except (TypeError, ValueError, OverflowError):
        return np.asarray(None)


def integer(caller: str, name: str, value: object) -> int:
    """`value` as an int that the compiled module can hold; a ValueError otherwise."""
    number = _whole(caller, name, value)
    if not -LARGEST <= number <= LARGEST:
        raise ValueError(f"{caller}: {name} must be a number of less than 64 bits, got {shown(number)}")
    return number


def place_of(caller: str, name: str, value: object, size: int) -> int:
    """`value` as a position in a list of that size, from 0; negative ones count from its end."""
    number = integer(caller, name, value)
    if not -size <= number < size:
        raise ValueError(f"{caller}: {name} must be from {-size} to {size - 1}, got {number}")
    return number % size


def count(caller: str, name: str, value: object, each: int = 0) -> int:
    """`value` as an int of at least 1; a ValueError if so many results of `each` bytes exceed the memory."""
    number = _whole(caller, name, value)
    if number < 1:
        raise ValueError(f"{caller}: {name} must be at least 1, got {shown(number)}")
    if number > LARGEST:
        raise ValueError(f"{caller}: {name} is too large, got {shown(number)}")
    refuse_beyond_memory(caller, name, number, each)
    return number


def without_function(error: object) -> str:
    """The sentence of an error without the name of a function."""
    return re.sub(r"^revchain(::|\.)[\w:.]+?: ", "", str(error))


def refuse_beyond_memory(caller: str, name: str, number: int, each: int) -> None:
    """Raise a ValueError if so many numbers of `each` bytes exceed the memory of this machine."""
    if number * each < 800_000:
        return
    if number * each > (memory := _memory()):
        needed, there = number * each / 2**30, memory / 2**30
        raise ValueError(
            f"{caller}: {name} is too large, got {number}: it would take {needed:.3g} GiB of memory, and this machine "
            f"has {there:.3g} GiB"
        )


@cache
def _memory() -> int:
    """Memory of this machine in bytes; if unknown, what a process can address."""
    with suppress(AttributeError, ValueError, OSError):
        return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    return 2**47


def limit(caller: str, name: str, value: object) -> int:
    """`value` as an int, at most the largest that the compiled module can hold."""
    return int(min(max(_whole(caller, name, value), -LARGEST), LARGEST))


def _whole(caller: str, name: str, value: object) -> int:
    if not isinstance(value, (bool, np.bool_)):
        with suppress(TypeError):
            return operator.index(value)  # type: ignore[arg-type]
    raise ValueError(f"{caller}: {name} must be a whole number, got {shown(value)}")


def listed(caller: str, name: str, value: object) -> list[Any]:
    """`value` as a list; a ValueError if it is not iterable."""
    try:
        return list(value)  # type: ignore[call-overload,no-any-return]
    except (TypeError, ValueError):
        raise ValueError(f"{caller}: {name} must be a list of whole numbers, got {shown(value)}") from None


def word(caller: str, name: str, value: object, words: Iterable[str], note: str = "") -> str:
    """`value` if it is one of the words; a ValueError, which ends with the note, otherwise."""
    if not isinstance(value, str) or value not in words:
        raise ValueError(f"{caller}: {name} must be one of {', '.join(words)}, got {shown(value)}{note}")
    return value


def text(caller: str, name: str, value: object) -> str:
    """Return `value` if it is text; raise a TypeError otherwise."""
    if not isinstance(value, str):
        raise TypeError(f"{caller}: {name} must be text, got {shown(value)}")
    return value


def file_path(caller: str, name: str, value: object) -> str:
    """`value` as the path of a file; a TypeError or a ValueError if it is not a path."""
    if not isinstance(value, str | os.PathLike) or not isinstance(path := os.fspath(value), str):
        raise TypeError(f"{caller}: {name} must be a path, that is text or a pathlib.Path, got {shown(value)}")
    if "\0" in path:
        raise ValueError(f"{caller}: {name} must have no null byte, got {shown(path)}")
    return path


def boolean(caller: str, name: str, value: object) -> bool:
    """`value` as a bool; a TypeError otherwise."""
    if not isinstance(value, (bool, np.bool_)):
        raise TypeError(f"{caller}: {name} must be True or False, got {shown(value)}")
    return bool(value)


def refuse_where(wrong: NDArray[np.bool_], array: Floats, message: str) -> None:
    """Raise a ValueError that shows the first wrong number, if there is one."""
    if wrong.any():
        raise ValueError(f"{message}, got {array[wrong].flat[0]:g}")


def real(caller: str, name: str, value: object) -> float:
    """`value` as a float, in SI if it has a unit; a ValueError if it is not a real number."""
    if isinstance(value, float):  # numpy's float64 is one, too
        return float(value)
    array = floats(caller, name, value)  # type: ignore[arg-type]
    if array.ndim != 0:
        raise ValueError(f"{caller}: {name} must be a single number, got an array of shape {array.shape}")
    return float(array)


def reals(caller: str, **given: object) -> dict[str, float]:
    """Single real numbers by name; the compiled module checks their ranges."""
    return {name: real(caller, name, value) for name, value in given.items()}


def positive(caller: str, name: str, value: ArrayLike) -> Floats:
    """`value` as a float64 array of positive finite numbers."""
    array = floats(caller, name, value)
    wrong = ~((array > 0) & (array < math.inf))
    if wrong.any() and units.has_units(value):
        raise ValueError(f"{caller}: {name} must be positive and finite, got {shown(value)}")
    refuse_where(wrong, array, f"{caller}: {name} must be positive and finite")
    return array


def one_positive(caller: str, name: str, value: object) -> float:
    """`value` as a positive finite float, in SI if it has a unit; a ValueError otherwise."""
    real(caller, name, value)
    return float(positive(caller, name, value))  # type: ignore[arg-type]


def exactly_one(caller: str, **given: float | None) -> tuple[str, float]:
    """Name and value of the only argument that is not None; the value must be positive and finite."""
    known = [name for name, value in given.items() if value is not None]
    if len(known) != 1:
        *others, last = given
        raise ValueError(
            f"{caller}: give exactly one of {', '.join(others)} and {last}, got {' and '.join(known) or 'none'}"
        )
    return known[0], one_positive(caller, known[0], given[known[0]])


def height_of(
    caller: str,
    conical_height: float | None,
    speed: float | None,
    gravity: float,
    height_name: str = "conical_height",
    speed_name: str = "angular_speed",
) -> float:
    """The given conical height, or the conical height of the given speed."""
    name, value = exactly_one(caller, **{height_name: conical_height, speed_name: speed})
    if name == height_name:
        return value
    g = one_positive(caller, "gravity", gravity)
    return one_positive(
        caller, f"gravity / {speed_name}**2", _core.conical_pendulum_height(np.asarray(value), np.asarray(g))
    )


def together(caller: str, **arrays: NDArray[np.generic]) -> list[NDArray[Any]]:
    """The arrays broadcast to one shape; a ValueError lists the shapes if they cannot be broadcast."""
    try:
        return list(np.broadcast_arrays(*arrays.values()))
    except ValueError:
        shapes = ", ".join(f"{name} {array.shape}" for name, array in arrays.items())
        raise ValueError(f"{caller}: these shapes do not go together: {shapes}") from None


def beside(caller: str, **arrays: NDArray[np.generic]) -> list[NDArray[Any]]:
    """The arrays broadcast to one shape; single numbers after the first stay single."""
    first, *others = together(caller, **arrays)
    given = list(arrays.values())[1:]
    return [first, *(one if one.ndim == 0 else many for one, many in zip(given, others, strict=True))]


def as_length(caller: str, name: str, value: Any) -> Any:
    """`value`, a force as a length of chain of that weight; a ValueError if it has a unit."""
    if units.has_units(value):
        why = "it is the length of chain or rope that weighs as much"
        raise ValueError(f"{caller}: {name} must be a number without a unit ({why}), got {shown(value)}")
    return value


def positives(caller: str, **given: ArrayLike) -> list[Floats]:
    """Positive finite numbers, broadcast as by `beside`."""
    return beside(caller, **{name: positive(caller, name, value) for name, value in given.items()})


def numbers(arrays: Iterable[NDArray[Any]]) -> Iterator[Any]:
    """Return the arrays, those without an axis as numbers."""
    return (array[()] for array in arrays)


def mass_or_weight(caller: str, mass: Any, weight: Any, of: str = "") -> tuple[bool, Any]:
    """Return whether the mass is given, and the value of mass or weight; a ValueError unless exactly one is given."""
    if (mass is None) == (weight is None):
        both = "both" if mass is not None else "neither"
        raise ValueError(f"{caller}: give either {of}mass, in kg, or {of}weight, in N, got {both}")
    return mass is not None, weight if mass is None else mass


def link_arrays(caller: str, **given: ArrayLike | None) -> dict[str, Floats]:
    """The data of links as arrays by name: mass or weight, length and, for bodies, centroid and inertia."""
    centroid, pendulum, radius = given["centroid"], given["pendulum_length"], given["radius_of_gyration"]
    if centroid is None and not (pendulum is None and radius is None):
        raise ValueError(f"{caller}: {'pendulum_length' if radius is None else 'radius_of_gyration'} needs centroid beside it")
    if centroid is not None and (pendulum is None) == (radius is None):
        raise ValueError(f"{caller}: centroid needs exactly one of pendulum_length and radius_of_gyration beside it")
    return {name: floats(caller, name, value) for name, value in given.items() if value is not None or name == "length"}


def shown(value: object, width: int = 60) -> str:
    """`value` as an error message shows it: its repr, shortened if it is long."""
    try:
        text = repr(value)
    except Exception:  # a whole number of more than 4300 digits, or any object of a caller
        text = f"{type(value).__name__} (it cannot be printed)"
    return text if len(text) <= width else text[: width - 3] + "..."


def read_only(array: NDArray[Scalar]) -> NDArray[Scalar]:
    """Return a view of `array` that cannot be written to."""
    view = array.view()
    view.flags.writeable = False
    return view
