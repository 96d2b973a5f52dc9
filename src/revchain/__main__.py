# SPDX-License-Identifier: GPL-3.0-or-later
"""The command ``revchain``, also ``python -m revchain``."""

from __future__ import annotations

import sys

from .cli import ExitCode, cmake_prefix

NEEDED = ("typer", "rich", "msgspec")


def _print_cmake_prefix() -> int:
    try:
        print(cmake_prefix())
    except FileNotFoundError as error:
        print(error, file=sys.stderr)
        return ExitCode.WRONG_USAGE
    return ExitCode.OK


def main() -> int:
    """Run the command line; the exit code is returned."""
    if sys.argv[1:] == ["--cmake-prefix"]:  # builds of C++ ask for it where typer need not be installed
        return _print_cmake_prefix()
    try:
        from .cli.app import run
    except ModuleNotFoundError as error:
        if error.name not in NEEDED:
            raise
        print(f"The command line needs {error.name}: pip install {error.name}", file=sys.stderr)
        return ExitCode.WRONG_USAGE
    return run()


if __name__ == "__main__":
    sys.exit(main())
