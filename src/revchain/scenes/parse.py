# SPDX-License-Identifier: GPL-3.0-or-later
"""From the text of a scene file to checked data, and errors that say where."""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections.abc import Iterator
from difflib import get_close_matches
from pathlib import Path
from typing import Any, Literal, TypeVar, get_args, get_origin

import msgspec

from ..systems.numbers import file_path, shown
from ..systems.units import SI
from .error import SceneError
from .tables import fields_of

Kind = TypeVar("Kind")
MOST_DIGITS = 400  # more than the largest float has


def read(path: str | os.PathLike[str]) -> Any:
    """The raw content of a .toml or .json file."""
    source = file_path("revchain", "the scene or study", path)
    try:
        text = Path(source).read_text(encoding="utf-8-sig")
    except OSError as error:
        raise SceneError(source, "", f"cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise SceneError(source, "", f"is not UTF-8 text (byte {error.start + 1})") from None
    try:
        return json.loads(text, parse_int=_whole) if source.lower().endswith(".json") else tomllib.loads(text)
    except json.JSONDecodeError as error:
        raise SceneError(source, f"line {error.lineno}, column {error.colno}", error.msg) from None
    except tomllib.TOMLDecodeError as error:
        reason, where = _place_of_toml_error(str(error), text)
        raise SceneError(source, where, reason) from None
    except (RecursionError, ValueError) as error:  # ValueError: an integer of thousands of digits
        raise SceneError(source, "", f"cannot be read: {error}") from None


def _whole(text: str) -> int:
    """A whole number of a JSON file; Python needs minutes for one of a million digits."""
    if len(text) > MOST_DIGITS:
        raise ValueError(f"a whole number has {len(text):,} digits; at most {MOST_DIGITS} are allowed")
    return int(text)


def convert(raw: Any, kind: type[Kind], source: str) -> Kind:
    """`raw` as `kind`, a msgspec Struct; a SceneError where it does not fit."""
    try:
        converted = msgspec.convert(raw, kind)
        msgspec.json.encode(converted)
        return converted
    except UnicodeEncodeError as error:
        reason = f"has text that is not Unicode: a lone surrogate in {shown(error.object)}; remove it"
        raise SceneError(source, "", reason) from None
    except msgspec.ValidationError as error:
        key, reason = _explained(str(error), raw, kind)
        raise SceneError(source, key, reason) from None
    except (RecursionError, OverflowError, ValueError) as error:
        raise SceneError(source, "", f"cannot be read: {error}") from None


def _place_of_toml_error(message: str, text: str) -> tuple[str, str]:
    found = re.fullmatch(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", message, re.DOTALL)
    if found is None:
        return message, ""
    if found[2]:
        return found[1], f"line {found[2]}, column {found[3]}"
    lines = text.splitlines() or [""]
    return f"{found[1]} (the file ends)", f"line {len(lines)}, column {len(lines[-1]) + 1}"


def _explained(message: str, raw: Any, kind: type) -> tuple[str, str]:
    """The key path and the sentence for a message such as ``Expected `int`, got `str` - at `$.ask.modes```."""
    sentence, _, path = message.rpartition(" - at `") if " - at `" in message else (message, "", "")
    if path.startswith("key` in"):
        return "", "every key must be text"
    key = path.rstrip("`").removeprefix("$").lstrip(".")
    unknown = re.fullmatch(r"Object contains unknown field `(.*)`", sentence, re.DOTALL)
    if unknown:
        known = _known_keys(kind, key)
        near = get_close_matches(unknown[1], known, n=1)
        hint = f"did you mean {near[0]}?" if near else f"known keys: {', '.join(known)}"
        return f"{key}.{unknown[1]}".lstrip("."), f"unknown key; {hint}"
    missing = re.fullmatch(r"Object missing required field `(.*)`", sentence)
    if missing:
        return f"{key}.{missing[1]}".lstrip("."), "is missing"
    value = _value_at(raw, key)
    parts = list(_parts_of(_annotation_at(kind, key)))
    words = [str(word) for part in parts if get_origin(part) is Literal for word in get_args(part)]
    out_of_range = re.fullmatch(r"Expected `\w+` (>|>=|<=) (\S+)", sentence)
    if words and not out_of_range:
        return key, _choice(words, int in parts, value)
    if any(isinstance(part, msgspec.Meta) and part.pattern for part in parts) and not out_of_range:
        example = SI.get(key.rpartition(".")[2], SI["length"])[2]
        return key, f'must be a number, or a number and its unit such as "{example}", got {shown(value)}'
    return key, _sentence(sentence, value)


def _choice(words: list[str], or_number: bool, value: Any) -> str:
    """The sentence for a value that is not among the words allowed."""
    allowed = words[0] if len(words) == 1 else "one of " + ", ".join(words)
    near = get_close_matches(shown(value).strip("'"), words, n=1)
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"must be {'a whole number or ' if or_number else ''}{allowed}, got {shown(value)}{hint}"


def _sentence(sentence: str, value: Any) -> str:
    """A sentence of msgspec in the words of a scene's author."""
    got = f", got {shown(value)}"
    limit = re.fullmatch(r"Expected `\w+` (>|>=|<=) (\S+)", sentence)
    if limit:
        words = {">": "above", ">=": "at least", "<=": "at most"}[limit[1]] + " " + limit[2].removesuffix(".0")
        return "must " + {"above 0": "be positive", "at least 0": "not be negative"}.get(words, f"be {words}") + got
    expected = re.fullmatch(r"Expected `(.*)`, got `(.*)`", sentence)
    if expected:
        names = {"object": "a table", "array": "a list of tables", "float": "a number", "int": "a whole number"}
        return f"must be {names.get(expected[1], 'text')}{got}"
    return f"{sentence[0].lower()}{sentence[1:]}{got}"


def _value_at(raw: Any, key: str) -> Any:
    for name, index in re.findall(r"([^.\[\]]+)|\[(\d+)\]", key):
        try:
            raw = raw[int(index)] if index else raw[name]
        except (KeyError, IndexError, TypeError):
            return raw
    return raw


def _known_keys(kind: type, key: str) -> list[str]:
    """The keys that the table at `key` may have."""
    return [field.encode_name for field in _fields_at(kind, key)]


def _fields_at(kind: type, key: str) -> tuple[Any, ...]:
    """The fields of the table at `key`, found by walking the structs along the path."""
    for name in re.findall(r"[^.\[\]]+", re.sub(r"\[\d+\]", "", key)):
        for field in fields_of(kind):
            if field.encode_name == name:
                structs = (part for part in _parts_of(field.type) if isinstance(part, type))
                kind = next((part for part in structs if issubclass(part, msgspec.Struct)), kind)
    return fields_of(kind)


def _annotation_at(kind: type, key: str) -> Any:
    """What the value at `key` should be; None where that is a table itself."""
    table, _, name = key.rpartition(".")
    return next((field.type for field in _fields_at(kind, table) if field.encode_name == name), None)


def _parts_of(annotation: Any) -> Iterator[Any]:
    """The annotation and everything inside it."""
    yield annotation
    if get_origin(annotation) is not Literal:
        for argument in get_args(annotation):
            yield from _parts_of(argument)
