# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the C++ headers of the installed package are."""

from __future__ import annotations

from pathlib import Path

import revchain


def cmake_prefix() -> str:
    """Folder of the C++ library in this package, for ``CMAKE_PREFIX_PATH``.

    The package contains the C++ headers, the CMake configuration and the pkg-config files of the same version, and the
    static libraries ``revchain::compiled`` and ``revchain::compiled_analytic`` for ``double``.

    Returns
    -------
    str
        Absolute path of the folder that contains ``include`` and ``share/cmake/revchain``. The command
        ``python -m revchain --cmake-prefix`` prints it.

    Raises
    ------
    FileNotFoundError
        This installation has no headers, for example because they are in a package of their own.

    Notes
    -----
    Accuracy: not applicable. Cost: 20 microseconds.

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
