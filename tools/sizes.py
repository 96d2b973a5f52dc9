#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""sizes.py PARTS.tsv quick|all: the size of the project and the time of its tests, an earlier commit's and the aim (sizes.toml).

sizes.py compile: measures the compile times alone, which is done again only when a header has changed, for the table.
`./test` prints it at its end. It is for people to see, and fails nothing.
"""

import csv
import hashlib
import subprocess
import sys
import tomllib
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TREES = {"include": (".hpp",), "src/revchain": (".py",), "bindings": (".cpp", ".hpp"), "tests": (".cpp", ".hpp", ".py")}
PROGRAMS = ("modes of ten links", "README program", "revchain.hpp")


def sizes(root=ROOT):
    """Lines and files of each tree that belong to the project, and the lengths of two pages."""
    command = ["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard", *TREES]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    files = [file for name in listed.splitlines() if (file := Path(root, name)).exists()]
    for tree, ends in TREES.items():
        own = [file for file in files if file.is_relative_to(Path(root, tree)) and file.suffix in ends]
        lines = [line for file in own for line in file.read_text("utf-8").splitlines()]
        yield f"{tree}: lines", len(lines)
        yield f"{tree}: files", len(own)
        yield f"{tree}: lines over 100 columns, %", round(100 * sum(len(line) > 100 for line in lines) / max(1, len(lines)), 1)
    yield "docs/accuracy.md: words", len(Path(root, "docs/accuracy.md").read_text("utf-8").split())
    yield "CHANGELOG.md: lines", len(Path(root, "CHANGELOG.md").read_text("utf-8").splitlines())


def compile_times(root=ROOT):
    """CPU time to compile each program over that of <Eigen/Dense>, measured again when a header has changed."""
    headers = sorted(Path(root, "include").rglob("*.hpp"))
    key = hashlib.sha1(b"".join(file.read_bytes() for file in headers)).hexdigest()
    kept = ROOT / "build" / f"compile_times_{key}.csv"
    if not kept.exists():
        part = kept.with_suffix(".part")
        command = [ROOT / "bench/compile_times", "--repeat", "1", "--include", Path(root, "include"), "--csv", part]
        subprocess.run([sys.executable, *command, "--no-link", "--only", *PROGRAMS], capture_output=True, check=True)
        part.rename(kept)
    with kept.open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    yardstick = float(rows[0]["CPU s"])
    for row in rows[1:]:
        if row["unit"] in PROGRAMS:
            compiled = ", compiled" if row["way"] == "revchain::compiled" else ""
            yield row["unit"] + compiled, float(row["x Eigen/Dense"])
    if steps := module_steps():
        yield "Python module, all files", round(steps / yardstick)


def module_steps(folder=ROOT / "build/dev"):
    """Seconds of the steps that compiled the Python module, as ninja noted them: few if a compiler cache had the files."""
    log = folder / ".ninja_log"
    steps = [line.split("\t") for line in log.read_text("utf-8").splitlines()[1:]] if log.exists() else []
    last = {name: int(end) - int(start) for start, end, _, name, *_ in steps}
    own = ("CMakeFiles/revchain_objects.dir/", "CMakeFiles/revchain_analytic_objects.dir/", "bindings/CMakeFiles/")
    return sum(took for name, took in last.items() if name.startswith(own)) / 1000


def main(parts, tier):
    with open(ROOT / "tools/sizes.toml", "rb") as file:
        before = tomllib.load(file)
    took = [line.split("\t")[:2] for line in Path(parts).read_text(encoding="utf-8").splitlines()]
    rows = [(f"seconds: {name}", int(now), before["seconds"].get(name, ""), "") for name, now in took]
    rows.append(("seconds: all of these", sum(int(now) for _, now in took), *before["all_seconds"][tier]))
    for label, table, now in (("", "sizes", dict(sizes())), ("compile, over Eigen/Dense: ", "compile", dict(compile_times()))):
        rows += [(f"{label}{name}", now.get(name, ""), *then) for name, then in before[table].items()]
    print(f"\n{'':60} {'now':>8}  {before['commit']:>8}  {'aim':>6}")
    for name, value, then, aim in rows:
        print(f"{name:60} {value:8}  {then:8}  {aim:6}")


if __name__ == "__main__":
    list(compile_times()) if sys.argv[1] == "compile" else main(*sys.argv[1:])
