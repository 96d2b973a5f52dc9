# SPDX-License-Identifier: GPL-3.0-or-later
"""The obstacles in a model, the parts left out because the caller says so, and the remarks."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any, NamedTuple, NoReturn

from ..systems.numbers import shown

_ALL = "the file without them"
_SOME = "some of these reasons; the others need a change of the model"

WORDS = {
    "actuator": "motors that exert a force without a signal",
    "armature": "inertia of rotors that is not of the carriage or, in a plane, of the uppermost hinge",
    "damping": "all dashpots",
    "equality": "constraints between joints or bodies",
    "fluid": "forces of the medium (density, viscosity)",
    "friction": "dry friction of joints (frictionloss)",
    "gravcomp": "forces against gravity on single bodies",
    "plugin": "plugins of the engine",
    "range": "limits of joints",
    "stiffness": "springs that are not relaxed in the straight chain, or differ in the hinges of one pin",
    "tendon": "tendons that exert a force",
    "visual": "included files and meshes that are missing",
}
"""The words of the argument `ignore`."""

_OTHER_WORDS = {  # attributes of MuJoCo that mean a word
    "frictionloss": "friction", "limited": "range", "limit": "range", "spring": "stiffness", "springref": "stiffness",
    "density": "fluid", "viscosity": "fluid", "motor": "actuator", "position": "actuator", "damper": "damping",
    "mesh": "visual",
}  # fmt: skip


class ModelWarning(UserWarning):
    """A warning that lists what `from_mjcf` or `from_urdf` left out of a model or changed.

    Attributes
    ----------
    gravity : float
        Acceleration of gravity to give to questions about the system, m/s^2.
    left_out : tuple of str
        Sentences on what `ignore` or `links` left out.
    remarks : tuple of str
        Sentences on what else was changed, guessed or not read.

    Examples
    --------
    >>> import warnings
    >>> import revchain as rc
    >>> text = rc.to_mjcf(rc.Chain(mass=1.0, length=2.0), gravity=9.81)
    >>> with warnings.catch_warnings(record=True) as said:
    ...     warnings.simplefilter("always")
    ...     chain = rc.from_mjcf(text)
    >>> rc.modes(chain, gravity=said[0].message.gravity).angular_speed.round(5)
    array([2.21472])
    """

    def __init__(self, message: str, gravity: float, left_out: tuple[str, ...], remarks: tuple[str, ...]) -> None:
        super().__init__(message)
        self.gravity, self.left_out, self.remarks = gravity, left_out, remarks

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.gravity, self.left_out, self.remarks)


class Blocked(ValueError):
    """A model cannot be read; the message says why."""


class Sentence(NamedTuple):
    """A sentence about an element of the file, with its place: file and line."""

    place: tuple[str, int]
    text: str

    def __str__(self) -> str:
        file, line = self.place
        where = f"{file}, line {line}" if file else f"line {line}"
        return f"{where}: {self.text}" if line else self.text


class Findings:
    """The obstacles, what was left out and the remarks about one model; `ignore` are the words of the caller."""

    def __init__(self, function: str, ignore: frozenset[str]) -> None:
        self.function, self.ignore = function, ignore
        self.obstacles: list[Sentence] = []
        self.words: list[str] = []  # that would help, one for each obstacle; "" if none does
        self.links: list[str] = []  # the argument that would help, one for each obstacle; "" if it does not
        self.left_out: list[Sentence] = []
        self.remarks: list[Sentence] = []

    def obstacle(self, place: tuple[str, int], what: str, instead: str, word: str = "", *, links: str = "") -> None:
        """Note what cannot be read, with what to write instead; or what is left out, if the caller ignores its word.

        `links`, such as ``links="a b"``, is an argument that would help.
        """
        if word in self.ignore:
            self.left_out.append(Sentence(place, what))
            return
        self.obstacles.append(Sentence(place, f"{what}; {instead}" + (f', or ignore="{word}"' if word else "")))
        self.words.append(word)
        self.links.append(links)

    def leave_out(self, place: tuple[str, int], what: str) -> None:
        """Note what is left out."""
        self.left_out.append(Sentence(place, what))

    def remark(self, place: tuple[str, int], what: str) -> None:
        """Note what was changed, guessed or not read."""
        self.remarks.append(Sentence(place, what))

    def stop(self) -> NoReturn:
        """Raise an error with all obstacles."""
        lines = list(dict.fromkeys(map(str, sorted(self.obstacles))))
        words = " ".join(sorted({*self.words, *self.ignore} - {""}))
        if (count := len(lines)) == 1:
            raise Blocked(f"{self.function}: {lines[0]}".replace(f'ignore="{self.words[0]}"', f'ignore="{words}"'))
        helps = [f'ignore="{words}"'] * any(self.words) + [next(filter(None, self.links), "")] * any(self.links)
        if helps:
            is_all = all(word or links for word, links in zip(self.words, self.links, strict=True))
            verb = ("read" if is_all else "remove") + "s" * (len(helps) == 1)
            lines.append(f"{' and '.join(helps)} {verb} {_ALL if is_all else _SOME}")
        head = f"{self.function}: the model is no hanging chain, for {count} reasons:"
        raise Blocked("\n  ".join([head, *lines]))

    def check(self) -> None:
        """Raise an error with all obstacles if there are any."""
        if self.obstacles:
            self.stop()


def listed_words(function: str, name: str, value: object) -> tuple[str, ...]:
    """Words given as a tuple, list or set, or as one text with commas or, if it has none, with blanks."""
    if isinstance(value, str):
        words = value.split("," if "," in value else None)
        return tuple(word.strip() for word in words if word.strip())
    if isinstance(value, tuple | list | set | frozenset) and all(isinstance(word, str) for word in value):
        return tuple(value)
    raise TypeError(f"{function}: {name} must be text or a tuple of texts, got {shown(value)}")


def ignored(function: str, value: object) -> frozenset[str]:
    """The words of the argument `ignore`, also as MuJoCo has them; a ValueError lists all words if one is unknown."""
    words = [_OTHER_WORDS.get(word, word) for word in listed_words(function, "ignore", value)]
    for word in words:
        if word != "all" and word not in WORDS:
            known = ", ".join(WORDS)
            near = get_close_matches(word, [*WORDS, "all"], n=1)
            hint = f"; did you mean {near[0]}?" if near else ""
            raise ValueError(f'{function}: ignore must have words of {known}, or be "all", got {shown(word)}{hint}')
    return frozenset(WORDS if "all" in words else words)
