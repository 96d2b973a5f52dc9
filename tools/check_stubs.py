#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Compares src/revchain/_core.pyi with what the installed module gives today; --write writes it anew.

Run with the Python in which revchain is installed: .venv/bin/python tools/check_stubs.py [--write]
"""

import difflib
import subprocess
import sys
import tempfile
from pathlib import Path

STUB = Path(__file__).resolve().parent.parent / "src" / "revchain" / "_core.pyi"
HEAD = "# SPDX-License-Identifier: GPL-3.0-or-later\n# Written by tools/check_stubs.py --write.\n"


def generated() -> str:
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "pybind11_stubgen", "--exit-code", "--output-dir", folder, "revchain._core"]
        subprocess.run(command, check=True)
        found = Path(folder, "revchain", "_core.pyi")
        return HEAD + found.read_text(encoding="utf-8")


def main() -> int:
    new = generated()
    if "--write" in sys.argv[1:]:
        STUB.write_text(new, encoding="utf-8")
        return 0
    old = STUB.read_text(encoding="utf-8") if STUB.exists() else ""
    difference = list(difflib.unified_diff(old.splitlines(), new.splitlines(), str(STUB), "the module", lineterm=""))
    print(*difference, sep="\n", end="\n" if difference else "")
    print("check_stubs: checked,", "run it with --write" if difference else "up to date")
    return 1 if difference else 0


if __name__ == "__main__":
    sys.exit(main())
