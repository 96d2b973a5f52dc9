# SPDX-License-Identifier: GPL-3.0-or-later
"""The command ``revchain``, also ``python -m revchain``."""

from __future__ import annotations

import sys

from .cli.exit_codes import ExitCode

NEEDED = ("typer", "rich", "msgspec")


def main() -> int:
    """Run the command line; the exit code is returned."""
    try:
        from .cli.app import run
    except ModuleNotFoundError as error:
        if error.name not in NEEDED:
            raise
        print(f'The command line needs {error.name}: pip install "revchain[cli]"', file=sys.stderr)
        return ExitCode.WRONG_USAGE
    return run()


if __name__ == "__main__":
    sys.exit(main())
