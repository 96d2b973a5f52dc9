# SPDX-License-Identifier: GPL-3.0-or-later
"""What is raised for a scene that cannot be read."""

from __future__ import annotations


class SceneError(ValueError):
    """A scene file says something that cannot be: names the file, the key and what is wrong.

    Attributes
    ----------
    source : str
        The file, or ``"scene"`` where there is none.
    key : str
        Where in it, such as ``links[2].length``, tables counted from 0; empty for the whole file.
    reason : str
        The sentence.

    Examples
    --------
    >>> import revchain as rc
    >>> rc.Scene.from_dict({"links": [{"mass": 2.0, "length": -0.5}]})
    Traceback (most recent call last):
    revchain.scenes.error.SceneError: scene: links[0].length: must be positive, got -0.5
    """

    def __init__(self, source: str, key: str, reason: str) -> None:
        super().__init__(": ".join(part for part in (source, key, reason) if part))
        self.source = source
        self.key = key
        self.reason = reason

    def __reduce__(self) -> tuple[type[SceneError], tuple[str, str, str]]:
        return SceneError, (self.source, self.key, self.reason)
