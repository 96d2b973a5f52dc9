# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line: its exit codes, and the folder of the C++ headers. Its modules need typer, rich and msgspec."""

from __future__ import annotations

from enum import IntEnum
from pathlib import Path

import revchain


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
    ExitCode.TOLERANCE_NOT_MET: "an answer is incomplete, or not within its tolerance",
    ExitCode.WRONG_USAGE: "wrong usage, or a package is missing",
    ExitCode.SCENE_INVALID: "a scene or a model is invalid",
    ExitCode.OUTPUT_FAILED: "an output cannot be written",
    ExitCode.INTERRUPTED: "interrupted",
}


def cmake_prefix() -> str:
    """Folder of the C++ library in this package, for ``CMAKE_PREFIX_PATH``.

    The folder has the C++ headers, the CMake configuration and pkg-config files, and the static libraries
    ``revchain::compiled`` and ``revchain::compiled_analytic`` for ``double``.

    Returns
    -------
    str
        Absolute path of the folder that contains ``include`` and ``share/cmake/revchain``. The command
        ``python -m revchain --cmake-prefix`` prints it.

    Raises
    ------
    FileNotFoundError
        If this installation has no headers.

    Examples
    --------
    >>> import pathlib
    >>> import revchain as rc
    >>> (pathlib.Path(rc.cmake_prefix()) / "include/revchain/revchain.hpp").exists()
    True

    In a shell: ``cmake -S . -B build -DCMAKE_PREFIX_PATH=$(python -m revchain --cmake-prefix)``.
    """
    for folder in revchain.__path__:
        if (Path(folder) / "share" / "cmake" / "revchain").is_dir():
            return str(Path(folder).resolve())
    raise FileNotFoundError(
        f"revchain.cmake_prefix: no C++ headers in {', '.join(revchain.__path__)}; install a wheel of revchain, or the C++ "
        "library by CMake or by a package of your system, and give its folder to CMake"
    )
