#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""Compares src/revchain/_core.pyi with what pybind11-stubgen reads from the installed module; --print shows the latter.

Run with the Python in which revchain is installed: .venv/bin/python tools/check_stubs.py

Classes, functions, parameters and defaults have to agree. The types in the stub are written by hand: they say more than
a generated ArrayLike or ndarray, which differ besides from one version of pybind11 to the next. mypy checks their use.
"""

import ast
import difflib
import subprocess
import sys
import tempfile
from pathlib import Path

STUB = Path(__file__).resolve().parent.parent / "src" / "revchain" / "_core.pyi"


def generated() -> str:
    with tempfile.TemporaryDirectory() as folder:
        command = [sys.executable, "-m", "pybind11_stubgen", "--exit-code", "--output-dir", folder, "revchain._core"]
        subprocess.run(command, check=True)
        return Path(folder, "revchain", "_core.pyi").read_text(encoding="utf-8")


def entries(body: list[ast.stmt], prefix: str = "") -> list[str]:
    """What a stub declares, a line each, without types; the special methods but for __init__ are left out."""
    found = []
    for item in body:
        match item:
            case ast.FunctionDef(name=name) if not name.startswith("_") or name == "__init__":
                for argument in ast.walk(item.args):
                    if isinstance(argument, ast.arg):
                        argument.annotation = None
                decorators = [f"@{ast.unparse(decorator)} " for decorator in item.decorator_list]
                found.append(f"{''.join(decorators)}{prefix}{name}({ast.unparse(item.args)})")
            case ast.ClassDef(name=name):
                bases = ", ".join(ast.unparse(base) for base in item.bases)
                found += [f"class {prefix}{name}({bases})", *entries(item.body, f"{prefix}{name}.")]
            case ast.AnnAssign(target=ast.Name(id=name)) if not name.startswith("_"):
                found.append(prefix + name)
    return sorted(found)


def main() -> int:
    module = generated()
    if "--print" in sys.argv[1:]:
        print(module)
        return 0
    stub, actual = (entries(ast.parse(text).body) for text in (STUB.read_text(encoding="utf-8"), module))
    difference = list(difflib.unified_diff(stub, actual, str(STUB), "the module", n=0, lineterm=""))
    print(*difference, sep="\n", end="\n" if difference else "")
    print(f"check_stubs: {len(actual)} names checked,", "the stub differs" if difference else "the stub agrees")
    return 1 if difference else 0


if __name__ == "__main__":
    sys.exit(main())
