# SPDX-License-Identifier: GPL-3.0-or-later
"""Packages that are not always there, imported when first needed."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def require(module: str, extra: str, purpose: str) -> Any:
    """Import `module`; where it is missing, say which extra of revchain brings it."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        if error.name is None or error.name.partition(".")[0] != package:
            raise
        raise ModuleNotFoundError(
            f'{purpose} needs {package}: pip install "revchain[{extra}]"', name=error.name
        ) from None
