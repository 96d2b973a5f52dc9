# SPDX-License-Identifier: GPL-3.0-or-later
"""From the text of a scene file to checked data; everything that is wrong with it is found at once."""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from functools import cache
from pathlib import Path
from types import UnionType
from typing import Annotated, Any, Literal, TypeVar, Union, cast, get_args, get_origin

import msgspec

from ..systems.numbers import file_path
from ..systems.units import SI, si_value
from .error import Problem, SceneError
from .places import places_in
from .tables import SYSTEMS, fields_of

Kind = TypeVar("Kind")
MOST_DIGITS = 400  # more than the largest float has
MOST_REPAIRS = 50


def text_of(path: str | os.PathLike[str]) -> str:
    """The text of a file."""
    source = file_path("revchain", "the scene or study", path)
    try:
        return Path(source).read_text(encoding="utf-8-sig")
    except OSError as error:
        raise SceneError(source, "", f"cannot be read: {error.strerror}") from None
    except UnicodeDecodeError as error:
        raise SceneError(source, "", f"is not UTF-8 text (byte {error.start + 1})") from None


def read(path: str | os.PathLike[str], problems: list[Problem] | None = None) -> Any:
    """The raw content of a .toml or .json file.

    With `problems` the commonest errors of syntax are noted there and put right, so that what follows is read, too.
    """
    text, source = text_of(path), os.fspath(path)
    found: list[Problem] = []
    try:
        raw = json.loads(text, parse_int=_whole) if is_json(source) else _toml(text, source, found)
    except json.JSONDecodeError as error:
        raise SceneError(source, problems=[Problem(error.lineno, error.colno, "", error.msg)]) from None
    except (RecursionError, ValueError) as error:  # ValueError: an integer of thousands of digits
        raise error if isinstance(error, SceneError) else SceneError(source, "", f"cannot be read: {error}") from None
    if found and problems is None:
        raise SceneError(source, problems=found)
    if problems is not None:
        problems += found
    return raw


def is_json(source: str) -> bool:
    return source.lower().endswith(".json")


@contextmanager
def placed(path: str | os.PathLike[str]) -> Iterator[None]:
    """Give every problem that is found with this file its line and column."""
    try:
        yield
    except SceneError as error:
        if error.source != os.fspath(path) or error.reason.startswith(("cannot be read", "is not UTF-8")):
            raise
        raise error._placed(places_in(text_of(path), is_json(error.source))) from None


def _whole(text: str) -> int:
    """A whole number of a JSON file; Python needs minutes for one of a million digits."""
    if len(text) > MOST_DIGITS:
        raise ValueError(f"a whole number has {len(text):,} digits; at most {MOST_DIGITS} are allowed")
    return int(text)


def _toml(text: str, source: str, problems: list[Problem]) -> Any:
    """The content of a TOML file, and what had to be put right for it."""
    lines = text.split("\n")
    while True:
        try:
            return tomllib.loads("\n".join(lines))
        except tomllib.TOMLDecodeError as error:
            line, column, reason = _place_of_toml_error(str(error), lines)
            repaired = _repaired(lines[line - 1])
            if repaired is None or len(problems) >= MOST_REPAIRS:
                raise SceneError(source, problems=sorted([*problems, Problem(line, column, "", reason)])) from None
            lines[line - 1], at, reason = repaired
            problems.append(Problem(line, at, "", reason))


def _place_of_toml_error(message: str, lines: list[str]) -> tuple[int, int, str]:
    found = re.fullmatch(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", message, re.DOTALL)
    if found is None or not found[2]:
        return len(lines), len(lines[-1]) + 1, f"{found[1] if found else message} (the file ends)"
    reason = re.sub(r"^Cannot (overwrite a value|declare \(.*\) twice|redefine.*)$", "is there twice", found[1])
    double = re.match(r"\s*\[(links|link)\]", lines[int(found[2]) - 1])
    if reason == "is there twice" and double:
        reason = "[links] is there twice: write [[links]], with two brackets, above each link"
    return int(found[2]), int(found[3]), reason


_END = r"(?=\s*(?:#.*|[,}\]].*)?$)"
_REPAIRS = tuple(  # what is wrong behind "key =", what to write instead, and the sentence
    (re.compile(rf"(?P<key>[\w.-]+)(?P<sign>\s*=\s*)(?P<wrong>{pattern})"), instead, sentence)
    for pattern, instead, sentence in (
        (r"(?P<a>[+-]?\d+),(?P<b>\d+)(?=\s*(?:#.*)?$)", r"\g<a>.\g<b>", "the decimal mark is a point"),
        (
            r"(?P<a>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?) *(?P<b>[a-zA-Zµ°%][\w/^*µ°% -]*?)" + _END,
            r'"\g<a> \g<b>"',
            "a number with a unit is text, in quotes",
        ),
        (rf"True{_END}", "true", "true is written small"),
        (rf"False{_END}", "false", "false is written small"),
        (rf"(?P<a>\.\d+){_END}", r"0\g<a>", "a number has a digit before its point"),
        (rf"(?P<a>[+-]?\d+)\.{_END}", r"\g<a>.0", "a number has a digit after its point"),
        (rf"(?!true|false|inf|nan)(?P<a>[A-Za-z][\w -]*?){_END}", r'"\g<a>"', "text is in quotes"),
    )
)


def _repaired(line: str) -> tuple[str, int, str] | None:
    """The line without its error, the column of that, and the sentence; None for errors that are not common."""
    if colon := re.match(r"\s*([A-Za-z_]+)\s*:\s*(?=[\d\"'\[{+-])", line):
        right = f"{colon[1]} = {line[colon.end() :]}"
        return right, colon.start(1) + 1, f"an equals sign is missing: write {right}"
    for pattern, instead, sentence in _REPAIRS:
        if found := pattern.search(re.sub(r"\"[^\"]*\"|'[^']*'", lambda text: "\0" * len(text[0]), line)):
            right = found.expand(instead)
            reason = f"{sentence}: write {found['key']} = {right}, not {found['wrong']}"
            return line[: found.end("sign")] + right + line[found.end() :], found.start("key") + 1, reason
    return None


def convert(raw: Any, kind: type[Kind], source: str, problems: list[Problem] | None = None) -> Kind:
    """`raw` as `kind`, a msgspec Struct.

    A SceneError with all that does not fit; with `problems`, they are noted there and what is wrong is left out.
    """
    if isinstance(raw, dict) and "vary" in _known_keys(kind) and (scene := [key for key in SYSTEMS if key in raw]):
        raise SceneError(source, scene[0], f"is of a scene, not of a study: revchain run {source}")
    try:
        converted = msgspec.convert(raw, kind)
        msgspec.json.encode(converted)
        return converted
    except UnicodeEncodeError as error:
        reason = f"has text that is not Unicode: a lone surrogate in {written(error.object)}; remove it"
        raise SceneError(source, "", reason) from None
    except msgspec.ValidationError as error:
        found: list[Problem] = []
        right = _table(raw, kind, "", found)
        found = found or [Problem(0, 0, "", str(error))]
        if problems is None or right is msgspec.UNSET:
            raise SceneError(source, problems=found) from None
        problems += found
        return cast(Kind, right)
    except (RecursionError, OverflowError, ValueError) as error:
        raise SceneError(source, "", f"cannot be read: {error}") from None


def _known_keys(kind: type) -> list[str]:
    return [field.encode_name for field in fields_of(kind)]


def _table(raw: Any, kind: type, key: str, found: list[Problem]) -> Any:
    """A struct with what is right in `raw`; UNSET for what is no table."""

    def refuse(name: str, reason: str) -> None:
        found.append(Problem(0, 0, f"{key}.{name}".strip("."), reason))

    if not isinstance(raw, dict):
        refuse("", f"must be a table, got {written(raw)}")
        return msgspec.UNSET
    names = {field.encode_name: field for field in fields_of(kind)}
    values: dict[str, Any] = {}
    for name, value in raw.items():
        if not isinstance(name, str):
            refuse("", "every key must be text")
        elif name in names:
            values[names[name].name] = _value(value, names[name].type, f"{key}.{name}".strip("."), found)
        else:
            refuse(name, f"unknown key; {_instead(name, kind)}")
    for name, field in names.items():
        if name not in raw and field.required:
            values[field.name] = msgspec.UNSET
            refuse(name, "is missing")
    given = {names[each.encode_name].name: values[each.name] for each in names.values() if each.name in values}
    wrong = [name for name, value in given.items() if value is msgspec.UNSET]
    for name in wrong:
        if not next(field for field in names.values() if field.name == name).required:
            del given[name]
    return kind(**given)


def _value(raw: Any, annotation: Any, key: str, found: list[Problem]) -> Any:
    """A value of a table; UNSET where it does not fit."""
    structs = [part for part in _parts_of(annotation) if isinstance(part, type) and issubclass(part, msgspec.Struct)]
    lists = [part for part in _parts_of(annotation) if get_origin(part) is list and get_args(part)[0] in structs]
    if lists and isinstance(raw, list) and raw:
        items = [_table(item, structs[0], f"{key}[{k}]", found) for k, item in enumerate(raw)]
        return [item for item in items if item is not msgspec.UNSET] or msgspec.UNSET
    if any(get_origin(part) is dict for part in _parts_of(annotation)) and isinstance(raw, dict) and raw:
        return {name: _table(each, structs[0], f'{key}."{name}"', found) for name, each in raw.items()}
    if structs and not lists and isinstance(raw, dict):
        return _table(raw, structs[0], key, found)
    try:
        return msgspec.convert(raw, _set(annotation))
    except (msgspec.ValidationError, OverflowError) as error:
        sentence, _, path = str(error).partition(" - at `$")
        found.append(Problem(0, 0, key + path.rstrip("`"), _reason(sentence, key, raw, path.rstrip("`"), annotation)))
    except (RecursionError, ValueError) as error:
        found.append(Problem(0, 0, key, f"cannot be read: {error}"))
    return msgspec.UNSET


@cache
def _set(annotation: Any) -> Any:
    """The annotation without what stands for a missing key."""
    if msgspec.UnsetType not in _parts_of(annotation):
        return annotation
    if get_origin(annotation) is Annotated:
        return _set(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return Union[tuple(part for part in get_args(annotation) if part is not msgspec.UnsetType)]
    return annotation


INSTEAD = {
    "inertia": "give radius_of_gyration, the square root of inertia / mass, about the centre of gravity",
    "moment_of_inertia": "give radius_of_gyration, the square root of inertia / mass, about the centre of gravity",
    "rpm": 'write angular_speed = "60 rpm"',
    "frequency": 'write angular_speed = "1 Hz"',
    "speed": 'write angular_speed = "60 rpm"',
    "m": "write mass",
    "l": "write length",
    "density": "give the mass",
    "diameter": "give radius_of_gyration",
}
TABLES = {"links": "[[links]]"}


def _instead(name: str, kind: type) -> str:
    """What to write for an unknown key."""
    known = _known_keys(kind)
    near = get_close_matches(name, known, n=1)
    if not near and name.lower() in INSTEAD:
        return INSTEAD[name.lower()]
    return f"did you mean {TABLES.get(near[0], near[0])}?" if near else f"known keys: {', '.join(known)}"


def _reason(sentence: str, key: str, raw: Any, path: str, annotation: Any) -> str:
    """A sentence of msgspec in the words of a scene's author."""
    value = _at(raw, path)
    got = f", got {written(value)}"
    limit = re.fullmatch(r"Expected `\w+` (>|>=|<=) (\S+)", sentence)
    if limit:
        words = {">": "above", ">=": "at least", "<=": "at most"}[limit[1]] + " " + limit[2].removesuffix(".0")
        return "must " + {"above 0": "be positive", "at least 0": "not be negative"}.get(words, f"be {words}") + got
    parts = list(_parts_of(annotation))
    words_allowed = [str(word) for part in parts if get_origin(part) is Literal for word in get_args(part)]
    if words_allowed:
        return choice(words_allowed, int in parts, value)
    if "array` of length" in sentence:
        return f"must be a pair [low, high]{got}"
    structs = any(isinstance(part, type) and issubclass(part, msgspec.Struct) for part in parts)
    lists = any(get_origin(part) in (list, tuple) for part in parts)
    if isinstance(value, dict) and lists and structs and not path:
        return f"is a list of tables: write [[{key}]], with two brackets, above each of them"
    if isinstance(value, list) and value and structs and not lists:
        return f"is one table: write [{key}], with one pair of brackets"
    quantity = key.rpartition(".")[2]
    numbers = any(isinstance(part, msgspec.Meta) and part.pattern for part in parts)
    if numbers and (path or not lists or (isinstance(value, str) and _is_number(annotation))):
        if isinstance(value, str):
            try:
                si_value(value, quantity if quantity in SI else "length")
            except ValueError as error:
                return str(error)
        example = SI.get(quantity, SI["length"])[2]
        return f'must be a number, or a number and its unit such as "{example}"{got}'
    if any(get_origin(part) is tuple for part in parts) and not path:
        return f'must be a pair [low, high]{got}; either end may be 0 or inf'
    if lists and not path:
        return f"must be a {'number or a ' if _is_number(annotation) else ''}list of numbers{got}"
    names = {"object": "a table", "array": "a list", "float": "a number", "int": "a whole number", "str": "text"}
    expected = re.fullmatch(r"Expected `(\w+)(?: \| null)?`.*", sentence)
    return f"must be {names.get(expected[1], 'true or false') if expected else 'something else'}{got}"


def _is_number(annotation: Any) -> bool:
    """Whether a number may stand there, and not only inside a list."""
    arguments = get_args(annotation)
    inside = arguments[:1] if get_origin(annotation) is Annotated else arguments
    return annotation is float or (get_origin(annotation) not in (list, tuple) and any(map(_is_number, inside)))


def choice(words: list[str], or_number: bool, value: Any) -> str:
    """The sentence for a value that is not among the words allowed."""
    allowed = words[0] if len(words) == 1 else "one of " + ", ".join(words)
    near = get_close_matches(value, words, n=1) if isinstance(value, str) else []
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"must be {'a whole number or ' if or_number else ''}{allowed}, got {written(value)}{hint}"


def written(value: Any, width: int = 60) -> str:
    """A value as a scene file has it."""
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, list | tuple):
        text = f"[{', '.join(written(item) for item in value[:20])}]"
    elif isinstance(value, str):
        text = f'"{value}"'
    elif value is None or isinstance(value, bool):
        text = {None: "nothing", True: "true", False: "false"}[value]
    else:
        try:
            text = f"{value}"
        except ValueError:  # a whole number of more than 4300 digits
            text = "a number of thousands of digits"
    return text if len(text) <= width else text[: width - 3] + "..."


def _at(raw: Any, path: str) -> Any:
    """The item at a path such as ``[1]``."""
    for index in re.findall(r"\[(\d+)\]", path):
        raw = raw[int(index)]
    return raw


def _parts_of(annotation: Any) -> Iterator[Any]:
    """The annotation and everything inside it."""
    yield annotation
    if get_origin(annotation) is not Literal:
        for argument in get_args(annotation):
            yield from _parts_of(argument)


def _annotation_at(kind: type, key: str) -> Any:
    """What the value at a key path should be; None where there is no such key."""
    found: Any = kind
    for name in re.findall(r"[^.\[\]]+", re.sub(r"\[\d+\]", "", key)):
        structs = [part for part in _parts_of(found) if isinstance(part, type) and issubclass(part, msgspec.Struct)]
        fields = [field for struct in structs[:1] for field in fields_of(struct) if field.encode_name == name]
        found = fields[0].type if fields else None
    return found


def without_consequences(problems: Iterable[Problem]) -> list[Problem]:
    """Without what is wrong with a table only because a key of it is, or was not understood."""
    kept: list[Problem] = []
    for problem in problems:
        inside = [each for each in kept if problem.key and each.key.startswith((problem.key + ".", problem.key + "["))]
        because = any(
            each.reason.startswith("unknown key") or each.key.rpartition(".")[2] in problem.reason for each in inside
        )
        if not because and not any(each.key == problem.key != "" for each in kept):
            kept.append(problem)
    return kept
