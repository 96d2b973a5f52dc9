# SPDX-License-Identifier: GPL-3.0-or-later
"""Checked data from the text of a scene or study file, and its errors."""

from __future__ import annotations

import json
import os
import re
import tomllib
from collections import defaultdict
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from difflib import get_close_matches
from typing import Annotated, Any, Literal, TypeVar, get_args, get_origin

import msgspec

from ..systems.numbers import file_path
from ..systems.units import NUMBER, SI, si_value
from .error import Problem, SceneError
from .positions import joined, positions_in
from .tables import BESIDE, QUESTIONS, SYSTEMS, Link, fields_of

Kind = TypeVar("Kind")
MOST_DIGITS = 400  # more than those of the largest float
MOST_REPAIRS, MOST_COLUMNS = 50, 1000  # repairs in a file, columns of a line to repair
MOST_BYTES = 16 * 2**20  # of a file
MOST_LEVELS = 32  # of tables and lists inside one another
TOO_DEEP = f"tables and lists lie more than {MOST_LEVELS} levels deep; remove brackets or dots: a scene needs at most 8"


def text_of(path: str | os.PathLike[str]) -> str:
    """Read the text of a file; line ends become newlines."""
    source = file_path("revchain", "the scene or study", path)
    try:
        with open(source, "rb") as file:
            data = file.read(MOST_BYTES + 1)
    except OSError as error:
        raise SceneError(source, "", f"cannot be read: {error.strerror}") from None
    except ValueError:
        raise SceneError(ascii(source), "", "is no name of a file: it has a lone surrogate") from None
    if len(data) > MOST_BYTES:
        size = f"has more than {MOST_BYTES:,} bytes, the limit for a file"
        raise SceneError(source, "", f"{size}; write equal links once, with repeat, or make the system in Python")
    try:
        return data.decode("utf-8-sig").replace("\r\n", "\n").replace("\r", "\n")
    except UnicodeDecodeError as error:
        raise SceneError(source, "", f"is not UTF-8 text (byte {error.start + 1})") from None


@contextmanager
def opened(path: str | os.PathLike[str]) -> Iterator[tuple[Any, list[Problem], str]]:
    """The raw content of a .toml or .json file, its common errors of syntax, which are repaired, and its text.

    Problems found in this file inside the with statement get their lines and columns.
    """
    text = text_of(path)
    lines, problems = text.split("\n"), list[Problem]()
    source = os.fspath(path)
    try:
        raw, moved = (_json if is_json(source) else _toml)(lines, problems)
        if _levels(raw) > MOST_LEVELS + 1:
            raise RecursionError
    except (RecursionError, ValueError) as error:  # ValueError: an integer of thousands of digits
        reason = Problem(0, 0, "", TOO_DEEP if isinstance(error, RecursionError) else f"cannot be read: {error}")
        raise SceneError(source, problems=sorted(problems) or [reason]) from None
    try:
        yield raw, problems, text
    except SceneError as error:
        if error.source != source:
            raise
        position = positions_in("\n".join(lines), is_json(source))

        def in_file(key: str) -> tuple[int, int]:
            line, column = position(key)
            for at, start, more in reversed(moved):
                column -= more if at == line and column > start + 1 else 0
            return line, column

        raise error._located(in_file) from None


def _levels(raw: Any) -> int:
    """Number of levels of tables and lists inside one another, with that of their numbers."""
    levels, level = 0, [raw]
    while level:
        levels, inside = levels + 1, list[Any]()
        for each in level:
            inside += each.values() if isinstance(each, dict) else each if isinstance(each, list) else ()
        level = inside
    return levels


def is_json(source: str) -> bool:
    return source.lower().endswith(".json")


def _whole(text: str) -> int:
    """A whole number of a JSON file with few digits; Python needs minutes for a million digits."""
    if len(text) > MOST_DIGITS:
        raise ValueError(f"a whole number has {len(text):,} digits; at most {MOST_DIGITS} are allowed")
    return int(text)


Moved = list[tuple[int, int, int]]  # repaired lines: line, the column from which it is longer, and by how much


def _json(lines: list[str], problems: list[Problem]) -> tuple[Any, Moved]:
    """The content of a JSON file; its errors are not repaired."""
    try:
        return json.loads("\n".join(lines), parse_int=_whole), []
    except json.JSONDecodeError as error:
        problems.append(Problem(error.lineno, error.colno, "", error.msg))
        raise


def _toml(lines: list[str], problems: list[Problem]) -> tuple[Any, Moved]:
    """The content of a TOML file with repaired lines; a ValueError if a line cannot be repaired."""
    moved: Moved = []
    while True:
        try:
            return tomllib.loads("\n".join(lines)), moved
        except tomllib.TOMLDecodeError as error:
            line, column, reason = _read_toml_error(str(error), lines)
        right, wrong = lines.copy(), lines[line - 1]
        if reason == LINKS_TWICE:
            right = [re.sub(r"^(\s*)\[\[?links\]+", r"\1[[links]]", each) for each in lines]
        elif len(wrong) <= MOST_COLUMNS and (repaired := _repaired(wrong)):
            right[line - 1], column, reason = repaired
            moved.append((line, len(os.path.commonprefix([wrong, repaired[0]])), len(repaired[0]) - len(wrong)))
        problems.append(Problem(line, column, "", reason))
        if len(problems) > MOST_REPAIRS or right == lines:
            raise ValueError(reason)
        lines[:] = right


_IN_PLAIN_WORDS = {
    "Invalid value": "a value is missing here, or is none: write a number, or text in quotes",
    "Invalid statement": "neither key = value nor [table]",
    "Invalid initial character for a key part": "no key begins here: an inline table {...} has one line",
    "Expected '=' after a key in a key/value pair": "an equals sign is missing",
    "Expected newline or end of document after a statement": "the line should end here: each key has a line of its own",
    "Unclosed array": "a comma or the closing bracket ] is missing",
    "Unclosed inline table": "a comma or the closing brace } is missing",
    "Unterminated string": "the closing quotes are missing",
    "Expected \"'\"": "the closing quotes are missing",
    "Expected \"'''\"": "the closing quotes are missing",
    "Expected ']' at the end of a table declaration": "the closing bracket ] is missing",
    "Expected ']]' at the end of an array declaration": "the closing brackets ]] are missing",
}
LINKS_TWICE = "[links] is there twice: write [[links]], with two brackets, above each link"


def _read_toml_error(message: str, lines: list[str]) -> tuple[int, int, str]:
    found = re.fullmatch(r"(.*) \(at (?:line (\d+), column (\d+)|end of document)\)", message, re.DOTALL)
    reason = message if found is None else _IN_PLAIN_WORDS.get(found[1], found[1])
    if found is None or not found[2]:
        return len(lines), len(lines[-1]) + 1, f"{reason} (the file ends)"
    if (found[2], found[3], lines[0][:1]) == ("1", "1", "{"):
        reason = "is JSON: give the file a name that ends in .json"
    if (found[2], lines[0].lstrip()[:1]) == ("1", "<"):
        reason = "is XML, not a scene: revchain import FILE.xml writes a model of a multibody engine (MJCF, URDF) as a scene"
    reason = re.sub(r"^Cannot (overwrite a value|declare \(.*\) twice|redefine.*)$", "is there twice", reason)
    if reason == "is there twice" and re.match(r"\s*\[\[?links\]", lines[int(found[2]) - 1]):
        reason = LINKS_TWICE
    return int(found[2]), int(found[3]), reason


_LINE = r"(?=\s*(?:#.*)?$)"  # the line ends there
_END = r"(?=\s*(?:#.*|[,}\]].*)?$)"  # or what is inside brackets
_KEY = r"(?P<key>[\w.-]+)\s*=\s*"
_ITEM = rf"(?:{_KEY}|[\[,]\s*|^\s*)"
_WHOLE = rf"^\s*{_KEY}"
_UNIT = r"[a-zA-Zµ°%][\w/^*µ°% -]*?"
_COMMA = r"(?P<a>[+-]?\d+),(?P<b>\d+)"
_NEXT = r"[-+.\d\0][^,=\[\]{}#\"']*?"  # of a list
_WORD = r"(?!true|false|inf|nan)(?P<a>[A-Za-z]"
_QUOTES = "“”„‟«»‘’"
_REPAIRS = tuple(  # what stands before what is wrong, that itself, what to write instead, and the sentence
    (re.compile(rf"{before}(?P<wrong>{pattern})"), instead, sentence)
    for before, pattern, instead, sentence in (
        (_KEY, rf"{_COMMA}(?={_LINE}|\s*\}}|\s*,\s*[\w.-]+\s*=)", "{a}.{b}", "the decimal mark is a point"),
        (_KEY, rf"{_COMMA} *(?P<c>{_UNIT}){_END}", '"{a}.{b} {c}"', "the decimal mark is a point"),
        (_WHOLE, rf"(?P<a>{_NEXT}(?:,\s*{_NEXT})+){_LINE}", "[{a}]", "a list is in brackets"),
        (
            _ITEM,
            rf"(?P<a>[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?) *(?P<b>{_UNIT}){_END}",
            '"{a} {b}"',
            "a number with a unit is text, in quotes",
        ),
        (_ITEM, rf"True{_END}", "true", "true is written small"),
        (_ITEM, rf"False{_END}", "false", "false is written small"),
        (_ITEM, rf"(?P<a>\.\d+){_END}", "0{a}", "a number has a digit before its point"),
        (_ITEM, rf"(?P<a>[+-]?\d+)\.{_END}", "{a}.0", "a number has a digit after its point"),
        (_WHOLE, rf"{_WORD}[^\"'\0#=\[\]{{}}]*?){_LINE}", '"{a}"', "text is in quotes"),
        (_KEY, rf"{_WORD}[\w -]*?){_END}", '"{a}"', "text is in quotes"),
        (_KEY, rf"[{_QUOTES}](?P<a>[^{_QUOTES}]*)[{_QUOTES}]", '"{a}"', "quotes are straight"),
        (_WHOLE, rf"(?P<q>[\"'])(?P<a>(?:(?!(?P=q))[^\0#])*?)[\"']?{_LINE}", '"{a}"', "a quote is missing"),
        (_ITEM, rf"[\"'](?P<a>[^\"'\0#,}}\]]*?){_END}", '"{a}"', "a quote is missing"),
        (_KEY, rf"(?P<a>[^\"'\0\s=,\[{{][^\"'\0=]*?)[\"']{_END}", '"{a}"', "a quote is missing"),
        (_WHOLE, rf"(?P<a>[^,;#\[{{]+?)\s*[,;]{_LINE}", "{a}", "a line ends without comma and semicolon"),
        (_KEY, r"(?P<a>\d{1,3})[ '](?P<b>\d{3})(?:[ '](?P<c>\d{3}))?(?!\d)", "{a}{b}{c}", "digits are not grouped"),
        (_WHOLE, r"(?P<a>[^#]*?)\s*//(?P<b>.*)", "{a} #{b}", "a comment begins with #"),
        (r"^\s*", r"//(?P<a>.*)", "#{a}", "a comment begins with #"),
    )
)
_PATHS = re.compile(r"(\s*\[?(?:vary\.)?)(\w+\[[^\[\]=#\"']+\](?:\.\w+(?:\[\d+\])?)*)(\s*=.*|\]\s*(?:#.*)?)")


def _repaired(line: str) -> tuple[str, int, str] | None:
    """The repaired line, the column of the error, and the sentence; None for an error that is not common."""
    if sign := re.match(r"\s*\"?([A-Za-z_]+)\"?(?:\s*(?::=?|==)\s*|\s+)(?=[\d\"'\[{+-])", line):
        right = f"{sign[1]} = {line[sign.end() :]}"
        return right, sign.start(1) + 1, f"an equals sign is missing: write {right}"
    if (head := re.match(r"\s*(\[+)([\w.]+)(\]+)", line)) and (len(head[1]), len(head[3])) not in ((1, 1), (2, 2)):
        right = f"[[{head[2]}]]" if head[2] == "links" else f"[{head[2]}]"
        return right, head.start(3) + 1, f"brackets go in pairs: write {right}, not {head[0].strip()}"
    if path := _PATHS.fullmatch(line):
        right = f'{path[1]}"{path[2]}"{path[3]}'
        return right, path.start(2) + 1, f'a path is in quotes: write "{path[2]}", not {path[2]}'
    masked = re.sub(r"\"[^\"]*\"|'[^']*'", lambda text: "\0" * len(text[0]), line)
    for pattern, instead, sentence in _REPAIRS:
        if found := pattern.search(masked):
            parts = {name: line[slice(*found.span(name))] for name in found.groupdict()}
            right, key = instead.format(**parts), parts.get("key", "")
            reason = f"{sentence}: write {key and f'{key} = '}{right}, not {parts['wrong']}"
            at = found.start("key" if key else "wrong") + 1
            return line[: found.start("wrong")] + right + line[found.end("wrong") :], at, reason
    return None


def convert(raw: Any, kind: type[Kind], source: str, problems: list[Problem]) -> Kind:
    """`raw` as `kind`, a msgspec Struct. Errors are noted in `problems`, and the wrong values are left out.

    Raises a SceneError if `raw` is not a table or cannot be read.
    """
    if isinstance(raw, dict) and "vary" in _known_keys(kind) and (scene := [key for key in SYSTEMS if key in raw]):
        raise SceneError(source, scene[0], f"is of a scene, not of a study: revchain run {source}")
    found: list[Problem] = []
    try:
        try:
            converted = msgspec.convert(raw, kind)
        except (msgspec.ValidationError, LookupError) as error:  # an array, asked for a key, raises an IndexError
            converted = _table(raw, kind, "", found)
            found = found or [Problem(0, 0, "", str(error))]
            if converted is msgspec.UNSET:
                raise SceneError(source, problems=found) from None
        msgspec.json.encode(converted)
    except UnicodeEncodeError as error:
        reason = f"has text that is not Unicode: a lone surrogate in {written(error.object)}; remove it"
        raise SceneError(source, problems=[*found, Problem(0, 0, "", reason)]) from None
    except SceneError:
        raise
    except (RecursionError, OverflowError, ValueError) as error:
        raise SceneError(source, "", f"cannot be read: {error}") from None
    problems += found
    return converted


def _known_keys(kind: type) -> list[str]:
    return [field.encode_name for field in fields_of(kind)]


def _table(raw: Any, kind: type, key: str, found: list[Problem]) -> Any:
    """A struct with the correct values of `raw`; UNSET if `raw` is not a table."""
    if not isinstance(raw, dict):
        found.append(Problem(0, 0, key, f"must be a table, got {written(raw)}"))
        return msgspec.UNSET
    names = {field.encode_name: field for field in fields_of(kind)}
    values = {field.name: msgspec.UNSET for field in names.values() if field.required}
    for name, value in raw.items():
        if not isinstance(name, str):
            found.append(Problem(0, 0, key, "every key must be text"))
        elif name not in names:
            found.append(Problem(0, 0, joined(key, name), f"unknown key; {_instead(name, kind)}"))
        elif (right := _value(value, names[name].type, joined(key, name), found)) is not msgspec.UNSET:
            values[names[name].name] = right
    missing = [name for name, field in names.items() if field.required and name not in raw]
    found += [Problem(0, 0, joined(key, name), "is missing") for name in missing]
    return kind(**values)


def _value(raw: Any, annotation: Any, key: str, found: list[Problem]) -> Any:
    """The checked value of a key of a table; UNSET if it does not fit its type."""
    kind, form = _table_in(annotation)
    if form is list and isinstance(raw, list) and raw:
        nothing = kind(**{field.name: msgspec.UNSET for field in fields_of(kind) if field.required})
        items = [_table(item, kind, f"{key}[{k}]", found) for k, item in enumerate(raw)]
        return [nothing if item is msgspec.UNSET else item for item in items]  # the others have their indices
    if form is dict and isinstance(raw, dict) and raw:
        tables = {name: _table(each, kind, joined(key, name), found) for name, each in raw.items()}
        return {name: table for name, table in tables.items() if table is not msgspec.UNSET}
    if kind and form not in (list, dict) and isinstance(raw, dict):
        return _table(raw, kind, key, found)
    try:
        return msgspec.convert(raw, annotation)
    except (msgspec.ValidationError, OverflowError) as error:
        sentence, _, path = str(error).partition(" - at `$")
        found.append(Problem(0, 0, key + path.rstrip("`"), _reason(sentence, key, raw, path.rstrip("`"), annotation)))
    except (RecursionError, ValueError) as error:
        found.append(Problem(0, 0, key, f"cannot be read: {error}"))
    except LookupError:  # as in `convert`
        return _table(raw, kind, key, found)
    return msgspec.UNSET


def _table_in(annotation: Any) -> tuple[Any, Any]:
    """The kind of table inside an annotation, or None; then `list` or `dict` if it is for several tables, or None."""
    parts = list(_parts_of(annotation))
    kind = next((part for part in parts if isinstance(part, type) and issubclass(part, msgspec.Struct)), None)
    forms = [get_origin(part) for part in parts if kind and kind in get_args(part)]
    return kind, next((form for form in forms if form in (list, dict)), None)


_GYRATION = "give radius_of_gyration, the square root of inertia / mass, about the centre of gravity"
INSTEAD = {
    "inertia": _GYRATION,
    "moment_of_inertia": _GYRATION,
    "rpm": 'write {speed} = "60 rpm"',
    "frequency": 'write {speed} = "1 Hz"',
    "speed": 'write {speed} = "60 rpm"',
    "m": "write mass",
    "l": "write length",
    "g": "write gravity",
    "n": "write count",
    "k": "write stiffness",
    "spring": "write stiffness",
    "angle": "write offset, a list of lengths",
    "units": 'numbers are in SI units, or text such as "20 mm"',
    "samples": "belongs at the top of the study",
    "min": "write from",
    "max": "write to",
    "num": "write steps",
    "gaussian": "write normal",
    "density": "give the mass",
    "diameter": "give radius_of_gyration",
    "length_in_proportion": "write length: centroid and radius of gyration follow unless they are given",
    "fit": "fits are made in Python, by revchain.fit",
    "trolley": "write [support] and below it mass, without stiffness: a trolley that rolls freely",
}
OF_A_LINK = {"rope": 'write length, and name = "rope"', "load": 'write mass, and name = "load"'}


def _instead(name: str, kind: type) -> str:
    """The end of the message for an unknown key: what to write instead."""
    known = _known_keys(kind)
    if name in QUESTIONS and "ask" in known:
        return f"write [ask.{name}]"
    if kind is Link and name.lower() in OF_A_LINK:
        return OF_A_LINK[name.lower()]
    if name == "diameter" and "radius" in known:
        return "write radius, half of the diameter"
    if name.lower() in INSTEAD:
        return INSTEAD[name.lower()].format(speed="spin" if "spin" in known else "angular_speed")
    if near := get_close_matches(name, known, n=1):
        return f"did you mean {'[[links]]' if near[0] == 'links' else near[0]}?"
    if name in BESIDE:
        return "belongs in [scene]" if "scene" in known else "belongs at the top of the file, above the first table"
    if name in _known_keys(Link):
        return "belongs in [[links]], to one of the links"
    return f"known keys: {', '.join(known)}"


def _reason(sentence: str, key: str, raw: Any, path: str, annotation: Any) -> str:
    """An error message of msgspec in the words of a scene file."""
    value = _at(raw, path)
    got = f", got {written(value)}"
    limit = re.fullmatch(r"Expected `\w+` (>|>=|<=) (\S+)", sentence)
    if limit:
        words = {">": "above", ">=": "at least", "<=": "at most"}[limit[1]] + " " + limit[2].removesuffix(".0")
        return "must " + {"above 0": "be positive", "at least 0": "not be negative"}.get(words, f"be {words}") + got
    parts = list(_parts_of(annotation))
    words_allowed = [str(word) for part in parts if get_origin(part) is Literal for word in get_args(part)]
    if words_allowed and value in words_allowed:
        is_list = any(get_origin(part) is list for part in parts)
        as_number = f"must be a number{got}; write {value} without quotes"
        return f"must be a list: write [{written(value)}]" if is_list else as_number
    if words_allowed:
        return choice(words_allowed, int in parts, value)
    if "array` of length" in sentence:
        return f"must be a pair {'[mean, deviation]' if key.endswith('normal') else '[low, high]'}{got}"
    structs = _table_in(annotation)[0] is not None
    lists = any(get_origin(part) in (list, tuple) for part in parts)
    if not isinstance(value, list) and _table_in(annotation)[1] is list and not path:
        if isinstance(value, dict):
            return f"is a list of tables: write [[{key}]], with two brackets, above each of them"
        where = "arc_length" if key == "cord.masses" else "length"
        return f"must be tables{got}: write [[{key}]] above each of them, and below it mass = 1.0 and {where} = 0.5"
    if sentence.endswith(" of length >= 1"):
        example = 'say what varies, such as vary."links[0].mass" = {values = [1, 2]}'
        return f"is empty: {example if key == 'vary' else 'give at least one'}"
    if isinstance(value, list) and value and structs and not lists:
        return f"is one table: write [{key}], with one pair of brackets"
    steps = re.findall(r"[a-z_]+", key)
    quantity = next((step for step in reversed(steps) if step in SI), "length")
    numbers = any(isinstance(part, msgspec.Meta) and part.pattern for part in parts)
    if numbers and (path or not lists or (isinstance(value, str) and _is_number(annotation))):
        if isinstance(value, str):
            try:
                si_value(value, quantity)
            except ValueError as error:
                return f"{error}{several(key, value)}"
        return f'must be a number, or a number and its unit such as "{SI[quantity][2]}"{got}{several(key, value)}'
    if any(get_origin(part) is tuple for part in parts) and not path:
        return f'must be a pair [low, high]{got}; either end may be 0 or inf'
    if lists and not path:
        if key.startswith("ask.swing.support_"):
            return f'must be a list of two or more numbers{got}: write {_EXAMPLES.get(key.rpartition("_")[2], "[0, 1]")}'
        one = isinstance(value, int | float | str) and not (isinstance(value, bool) or _is_number(annotation))
        write = f": write [{written(value)}]" if one else ""
        return f"must be a {'number or a ' if _is_number(annotation) else ''}list of numbers{got}{write}"
    names = {"bool": "true or false", "int": "a whole number", "float": "a number", "str": "text", "array": "a list", "object": "a table"}
    expected = re.match(r"Expected `([^`]+)`", sentence)
    kinds = set(expected[1].split(" | ")) if expected else set()
    names = {kind: words for kind, words in names.items() if kind in kinds and not (kind == "int" and "float" in kinds)}
    *some, last = names.values() or ("something else",)
    return f"must be {', '.join(some)}{' or ' if some else ''}{last}{got}"


_EXAMPLES = {"time": '["0 s", "2 s"]', "velocity": '["0 m/s", "1 m/s"]', "offset": '["0 m", "1 m"]', "force": '["0 N", "1 N"]'}


def several(key: str, value: Any) -> str:
    """The end of a message about several speeds where one is wanted: how a study answers for each; else empty."""
    parts = re.split(r"\s*[;,]\s*", value) if isinstance(value, str) else value
    one = ("ask.shapes.angular_speed", "ask.drag.angular_speed", "ask.equilibria.angular_speed")
    if key not in one or not isinstance(parts, list) or len(parts) < 2:
        return ""
    if isinstance(value, str):
        is_decimal = re.fullmatch(rf"\s*[+-]?\d+,\d+([eE][+-]?\d+)?\s*[A-Za-z/]*\s*", value)  # the mark, as the message says
        if is_decimal or not all(re.fullmatch(rf"{NUMBER}\s*[A-Za-z/]*", part) for part in parts):
            return ""
    values = f"[{', '.join(map(written, parts))}]"
    return f'; for several speeds write a study with [vary."{key}"] and values = {values}: revchain sweep STUDY'


def _is_number(annotation: Any) -> bool:
    """Return whether the value may be a number outside a list."""
    arguments = get_args(annotation)
    inside = arguments[:1] if get_origin(annotation) is Annotated else arguments
    return annotation is float or (get_origin(annotation) not in (list, tuple) and any(map(_is_number, inside)))


def choice(words: list[str], or_number: bool, value: Any) -> str:
    """The sentence for a value that is not one of the allowed words."""
    allowed = words[0] if len(words) == 1 else "one of " + ", ".join(words)
    near = get_close_matches(value, words, n=1) if isinstance(value, str) else []
    hint = f"; did you mean {near[0]}?" if near else ""
    return f"must be {'a whole number or ' if or_number else ''}{allowed}, got {written(value)}{hint}"


def written(value: Any, width: int = 60) -> str:
    """A value as it is written in a scene file."""
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
    """The item of a list at a path such as ``[1]``."""
    for index in re.findall(r"\[(\d+)\]", path):
        raw = raw[int(index)]
    return raw


def _parts_of(annotation: Any) -> Iterator[Any]:
    """The annotation itself, and each type inside it."""
    yield annotation
    if get_origin(annotation) is not Literal:
        for argument in get_args(annotation):
            yield from _parts_of(argument)


def _annotation_at(kind: type, key: str) -> Any:
    """The type of the value at a key path; None if there is no such key."""
    found: Any = kind
    for name in re.findall(r"[^.\[\]]+", re.sub(r"\[\d+\]", "", key)):
        kind = _table_in(found)[0]
        found = next((field.type for field in fields_of(kind) if field.encode_name == name), None) if kind else None
    return found


def without_consequences(problems: Iterable[Problem]) -> list[Problem]:
    """The problems without those of a table that follow from a problem of one of its keys."""
    remaining: list[Problem] = []
    inside = defaultdict[str, list[tuple[str, str]]](list)  # by table: last part of the key and reason of its problems
    known: set[str] = set()
    for problem in problems:
        key = problem.key
        because = any(reason.startswith("unknown key") or name in problem.reason for name, reason in inside[key])
        beside = inside[key.rpartition(".")[0]]
        because = because or any(problem.reason.startswith(f"needs {name} beside it") for name, _ in beside)
        if because or key in known:
            continue
        remaining.append(problem)
        for mark in re.finditer(r"[.\[]", key):
            inside[key[: mark.start()]].append((key.rpartition(".")[2].partition("[")[0], problem.reason))
        if key and ": line " not in problem.reason:  # what is wrong with another file has one key
            known.add(key)
    return remaining
