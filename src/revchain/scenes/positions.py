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
        self.rest = [(found[0], found.start()) for found in _TOKEN.finditer(text) if found[0][0] != "#"][::-1]
        self.positions: dict[str, int] = {}

    def next(self, skipped: str = "\n") -> tuple[str, int]:
        """The next token, which is not read yet; empty at the end."""
        while self.rest and self.rest[-1][0] in skipped:
            self.rest.pop()
        return self.rest[-1] if self.rest else ("", 0)

    def key(self, ends: str) -> list[str]:
        """Read a dotted key and the token after it; return the parts of the key."""
        parts: list[str] = []
        while (word := self.next()[0]) and self.rest.pop() and word not in ends:
            parts += [_unquoted(word)] if word[0] in "\"'" else [part for part in word.split(".") if part]
        return parts

    def entry(self, path: str, ends: str = ",]}") -> None:
        """Read a key and its value, and note where the key starts."""
        _, at = self.next()
        for part in self.key("=:"):
            path = joined(path, part)
            self.positions.setdefault(path, at)
        self.value(path, ends)

    def value(self, path: str, ends: str = ",]}") -> None:
        """Read the value of the key `path`, and note where each key and item inside it starts."""
        opens, number = self.next()[0], 0
        if opens not in ("[", "{"):
            while self.rest and self.rest[-1][0] not in ends + "\n":
                self.rest.pop()
            return
        self.rest.pop()
        while (token := self.next(",\n"))[0] not in ("]", "}", ""):
            if opens == "{":
                self.entry(path)
            else:
                self.positions[item := f"{path}[{number}]"] = token[1]
                self.value(item)
                number += 1
        del self.rest[-1:]

    def document(self) -> None:
        """Read a whole TOML file, table by table, and note where each key starts."""
        table, counts = "", dict[str, int]()
        while (opens := self.next())[0]:
            if opens[0] != "[":
                self.entry(table, "")
                continue
            self.rest.pop()
            if listed := self.rest[-1][0] == "[":
                self.rest.pop()
            table, parts = "", self.key("]")
            for nth, part in enumerate(parts, 1):
                table = joined(table, part)
                self.positions.setdefault(table, opens[1])
                if listed and nth == len(parts):
                    counts[table] = counts.get(table, 0) + 1
                if table in counts:
                    table += f"[{counts[table] - 1}]"
                self.positions.setdefault(table, opens[1])
            if listed:
                del self.rest[-1:]


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


def positions_in(text: str, json: bool) -> Callable[[str], tuple[int, int]]:
    """A function from a key path to its line and column; for a missing key those of its table."""
    scanner = _Scanner(text)
    try:
        scanner.value("") if json else scanner.document()
    except (RecursionError, IndexError):
        pass  # keys that could not be scanned get the positions of the tables around them
    positions = {key.removeprefix("."): at for key, at in scanner.positions.items()}
    starts = [0, *(match.end() for match in re.finditer("\n", text))]

    def position(key: str) -> tuple[int, int]:
        key = re.sub(r' \(".*"\)$', "", key)
        while key and key not in positions:
            shorter = _LAST.sub("", key)
            key = "" if shorter == key else shorter
        at = positions.get(key, 0)
        line = bisect_right(starts, at)
        return line, at - starts[line - 1] + 1

    return position
