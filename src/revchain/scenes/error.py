# SPDX-License-Identifier: GPL-3.0-or-later
"""What is raised for a scene that cannot be read or answered."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, NamedTuple


class Problem(NamedTuple):
    """One error of a scene: where it is and what is wrong; line 0 where there is no file."""

    line: int
    column: int
    key: str
    reason: str


class SceneError(ValueError):
    """A scene or study that cannot be read or answered: every error found in it, each with its place in the file.

    Attributes
    ----------
    source : str
        The file, or ``"scene"`` where there is none.
    problems : tuple of (line, column, key, reason)
        In the order of the file. Lines and columns count from 1; both are 0 where there is no file. Keys are paths
        such as ``links[2].length``, tables counted from 0; empty for the whole file.
    key, reason : str
        Of the first of them.

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

    def _placed(self, place: Callable[[str], tuple[int, int]]) -> SceneError:
        """The same error with the line and column of each key, as `place` tells them."""
        syntax = {each[:2] for each in self.problems if each.line}
        found = [each if each.line else Problem(*place(each.key), *each[2:]) for each in self.problems]
        right = [each for one, each in zip(self.problems, found, strict=True) if one.line or each[:2] not in syntax]
        return SceneError(self.source, problems=sorted(right))  # without what follows from a mark that is put right

    def __reduce__(self) -> tuple[Any, ...]:
        return SceneError, (self.source, "", "", self.problems)


def _line(source: str, problem: Problem) -> str:
    place = f"line {problem.line}, column {problem.column}" if problem.line else ""
    return ": ".join(part for part in (source, place, problem.key, problem.reason) if part)
