#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Checks wheels: size, contents, and that GSL is inside the module with its symbols hidden.

check_wheel.py WHEEL_OR_FOLDER...: prints wheel: what is wrong, and ends with 1 when something is.
"""

import subprocess
import sys
import tempfile
from collections.abc import Iterator
from email.parser import Parser
from pathlib import Path
from zipfile import ZipFile

MOST_BYTES = 12 * 10**6
FILES = (
    "revchain/__init__.py",
    "revchain/_core.pyi",
    "revchain/py.typed",
    "revchain/include/revchain/revchain.hpp",
    "revchain/include/revchain/analytic.hpp",
    "revchain/share/cmake/revchain/revchain-config.cmake",
    "revchain/share/cmake/revchain/revchain-compiled-targets.cmake",
    "revchain/share/cmake/revchain/revchain-compiled_analytic-targets.cmake",
)
LICENCES = {"MPL-2.0.txt", "GPL-3.0-or-later.txt"}


def problems(wheel: Path) -> Iterator[str]:
    if (size := wheel.stat().st_size) > MOST_BYTES:
        yield f"has {size:,} bytes, at most {MOST_BYTES:,} are allowed"
    with ZipFile(wheel) as kept, tempfile.TemporaryDirectory() as folder:
        names = kept.namelist()
        yield from (f"{name} is missing" for name in FILES if name not in names)
        if absent := LICENCES - {name.rpartition("/")[2] for name in names if ".dist-info/licenses/" in name}:
            yield f"the licences {', '.join(sorted(absent))} are missing"
        metadata = next(name for name in names if name.endswith(".dist-info/METADATA"))
        about = Parser().parsestr(kept.read(metadata).decode())
        if about["License-Expression"] != "GPL-3.0-or-later":
            yield f"its metadata state the licence {about['License-Expression']}, must be GPL-3.0-or-later"
        yield from (f"{name} is a GSL beside the module" for name in names if "libgsl" in name.rpartition("/")[2])
        modules = [name for name in names if name.startswith("revchain/_core.") and not name.endswith(".pyi")]
        if len(modules) != 1:
            yield f"must have one compiled module, has {len(modules)}"
        elif sys.platform.startswith("linux"):
            yield from _linked(Path(kept.extract(modules[0], folder)))


def _linked(module: Path) -> Iterator[str]:
    dynamic = subprocess.run(["readelf", "-dW", module], capture_output=True, text=True, check=True).stdout
    if "libgsl" in dynamic:
        yield "the module loads a GSL from elsewhere; link libgsl.a"
    symbols = subprocess.run(["nm", "-D", "--defined-only", module], capture_output=True, text=True, check=True).stdout
    shown = [line.split()[-1] for line in symbols.splitlines() if line.split()[-1].startswith(("gsl_", "cblas_"))]
    if shown:
        yield f"the module shows {len(shown)} symbols of GSL, such as {shown[0]}"


def main(arguments: list[str]) -> int:
    paths = map(Path, arguments)
    wheels = [wheel for path in paths for wheel in (sorted(path.glob("*.whl")) if path.is_dir() else [path])]
    found = [f"{wheel}: {problem}" for wheel in wheels for problem in problems(wheel)]
    print(*found, f"check_wheel: {len(wheels)} wheels checked, {len(found)} problems", sep="\n")
    return int(bool(found) or not wheels)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
