# SPDX-License-Identifier: GPL-3.0-or-later
"""The error for a scene that cannot be read or answered."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple


class Problem(NamedTuple):
    """One error of a scene: line, column, key and reason."""

    line: int
    column: int
    key: str
    reason: str


class SceneError(ValueError):
    """The ValueError for a scene or study that cannot be read or answered; it lists the problems and where they are.

    Attributes
    ----------
    source : str
        Name of the file; without one ``"scene"`` or ``"study"``.
    problems : tuple of (line, column, key, reason)
        The problems found. Lines and columns count from 1, or are 0 if unknown. A key is a path such as
        ``links[2].length``, with tables counted from 0; it is empty for the whole file.
    key, reason : str
        Key and reason of the first problem.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.Scene.from_dict({"links": [{"mass": 2.0, "length": -0.5}]})
    Traceback (most recent call last):
    revchain.scenes.error.SceneError: scene: links[0].length: must be positive, got -0.5
    """

    def __init__(self, source: str, key: str = "", reason: str = "", problems: Iterable[Problem] = ()) -> None:
        self.source = source
        self.problems = tuple(problems) or (Problem(0, 0, key, reason),)
        self.key, self.reason = self.problems[0][2:]
        super().__init__("\n".join(_line(source, problem) for problem in self.problems))

    def _located(self, position: Callable[[str], tuple[int, int]]) -> SceneError:
        """The error with the line and column of each key from the function `position`."""
        syntax = {each[:2] for each in self.problems if each.line}
        found = [each if each.line else Problem(*position(each.key), *each[2:]) for each in self.problems]
        right = [each for one, each in zip(self.problems, found, strict=True) if one.line or each[:2] not in syntax]
        return SceneError(self.source, problems=sorted(right))  # without what follows from a mark that is put right

    def __reduce__(self) -> tuple[Any, ...]:
        return SceneError, (self.source, "", "", self.problems)


def _line(source: str, problem: Problem) -> str:
    position = f"line {problem.line}, column {problem.column}" if problem.line else ""
    return ": ".join(part for part in (source, position, problem.key, problem.reason) if part)
