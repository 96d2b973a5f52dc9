# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line, and its exit codes. All modules but `headers` need typer, rich and msgspec."""

from __future__ import annotations

from enum import IntEnum


class ExitCode(IntEnum):
    """Exit codes of the command ``revchain``."""

    OK = 0
    TOLERANCE_NOT_MET = 1
    WRONG_USAGE = 2
    SCENE_INVALID = 3
    OUTPUT_FAILED = 4
    INTERRUPTED = 130


MEANING = {
    ExitCode.OK: "success",
    ExitCode.TOLERANCE_NOT_MET: "the answer does not meet the requested tolerance",
    ExitCode.WRONG_USAGE: "wrong usage, or a package is missing",
    ExitCode.SCENE_INVALID: "a scene is invalid",
    ExitCode.OUTPUT_FAILED: "an output cannot be written",
    ExitCode.INTERRUPTED: "interrupted",
}
