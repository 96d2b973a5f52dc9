# SPDX-License-Identifier: GPL-3.0-or-later
"""The classes of results by name, for pickles and files."""

from __future__ import annotations

from typing import Any

KINDS: dict[str, Any] = {}


def restored(kind: Any, state: dict[str, Any]) -> Any:
    """The result of a class from its state."""
    return kind._made(None, **state)
