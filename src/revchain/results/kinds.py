# SPDX-License-Identifier: GPL-3.0-or-later
"""The classes of results by name, for pickles and files."""

from __future__ import annotations

from typing import Any

KINDS: dict[str, Any] = {}  # each class enters itself when it is defined


def restored(kind: Any, state: dict[str, Any]) -> Any:
    """Return a result of a class from its state, as a pickle stores it."""
    return kind._made(None, **state)
