# SPDX-License-Identifier: GPL-3.0-or-later
"""Line and column of each key of a TOML or JSON file."""

from __future__ import annotations

import re
from bisect import bisect_right
from collections.abc import Callable
from json import dumps, loads

_TOKEN = re.compile(
    r'"""(?:\\.|[^\\])*?"""|\'\'\'.*?\'\'\'|"(?:\\.|[^"\\\n])*"|\'[^\'\n]*\'|#[^\n]*|[\[\]{},=:\n]|[^\s\[\]{},=:#"\']+',
    re.DOTALL,
)


class _Scanner:
    """A reader of valid text that notes where each key and each item of a list starts."""

    def __init__(self, text: str) -> None:
        found = (match for match in _TOKEN.finditer(text) if not match.group().startswith("#"))
        self.tokens = [(match.group(), match.start()) for match in found]
        self.next = 0
        self.places: dict[str, int] = {}

    def token(self, skip_lines: bool = True) -> tuple[str, int]:
        """The next token; empty at the end."""
        while self.next < len(self.tokens):
            self.next += 1
            if not (skip_lines and self.tokens[self.next - 1][0] == "\n"):
                return self.tokens[self.next - 1]
        return "", 0

    def key(self, ends: str) -> list[str]:
        """The parts of a dotted key; the token after it is read, too."""
        parts: list[str] = []
        while (word := self.token()[0]) and word not in ends:
            parts += [_unquoted(word)] if word[0] in "\"'" else [part for part in word.split(".") if part]
        return parts

    def value(self, path: str, ends: str = ",]}") -> None:
        """A value at `path`, and all inside it."""
        word, _ = self.token()
        if word == "[":
            number = 0
            while (opens := self.token())[0] not in ("]", ""):
                if opens[0] != ",":
                    self.next -= 1
                    self.places[f"{path}[{number}]"] = opens[1]
                    self.value(f"{path}[{number}]")
                    number += 1
        elif word == "{":
            while (opens := self.token())[0] not in ("}", ""):
                if opens[0] != ",":
                    self.next -= 1
                    self.entry(path, opens[1])
        else:
            while self.next < len(self.tokens) and self.tokens[self.next][0] not in ends + "\n":
                self.next += 1

    def entry(self, path: str, at: int, ends: str = ",]}") -> None:
        """A key and its value."""
        for part in self.key("=:"):
            path = joined(path, part)
            self.places.setdefault(path, at)
        self.value(path, ends)

    def document(self) -> None:
        """A whole TOML file."""
        table, counts = "", dict[str, int]()
        while (opens := self.token())[0]:
            if opens[0] != "[":
                self.next -= 1
                self.entry(table, opens[1], "")
                continue
            listed = self.tokens[self.next][0] == "["
            self.next += listed
            table = ""
            parts = self.key("]")
            for nth, part in enumerate(parts, 1):
                table = joined(table, part)
                self.places.setdefault(table, opens[1])
                if listed and nth == len(parts):
                    counts[table] = counts.get(table, 0) + 1
                if table in counts:
                    table += f"[{counts[table] - 1}]"
                self.places.setdefault(table, opens[1])
            self.next += listed


def joined(path: str, part: str) -> str:
    """A key path with one more key, in quotes unless it is a bare key of TOML."""
    part = part if re.fullmatch(r"[A-Za-z0-9_-]+", part) else dumps(part, ensure_ascii=False)
    return f"{path}.{part}" if path else part


def _unquoted(word: str) -> str:
    try:
        return str(loads(word))
    except ValueError:  # 'text', or an escape that JSON does not have
        return word[1:-1]


_LAST = re.compile(r"""(^|\.)("(\\.|[^"\\])*"|[^."[]*)$|\[\d+\]$""")


def places_in(text: str, json: bool) -> Callable[[str], tuple[int, int]]:
    """A function from a key path to its line and column; for a missing key those of its table."""
    scanner = _Scanner(text)
    try:
        scanner.value("") if json else scanner.document()
    except (RecursionError, IndexError):
        pass  # keys that could not be scanned get the places of the tables around them
    places = {key.removeprefix("."): at for key, at in scanner.places.items()}
    starts = [0, *(match.end() for match in re.finditer("\n", text))]

    def place(key: str) -> tuple[int, int]:
        key = re.sub(r' \(".*"\)$', "", key)
        while key and key not in places:
            shorter = _LAST.sub("", key)
            key = "" if shorter == key else shorter
        at = places.get(key, 0)
        line = bisect_right(starts, at)
        return line, at - starts[line - 1] + 1

    return place
