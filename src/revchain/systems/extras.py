# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports of optional packages when they are first needed, with a message if one is missing."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def require(module: str, extra: str | None, purpose: str) -> Any:
    """Import `module`; if it is missing, raise an ImportError that names the extra or the package to install."""
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        package = module.partition(".")[0]
        if error.name is None or error.name.partition(".")[0] != package:
            raise
        install = package if extra is None else f'"revchain[{extra}]"'
        raise ModuleNotFoundError(f"{purpose} needs {package}: pip install {install}", name=error.name) from None
