#!/usr/bin/env python3
# SPDX-License-Identifier: MPL-2.0
"""sizes.py PARTS.tsv: how large the project is and how long its tests took, beside the figures in sizes.toml.

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
PROGRAMS = ("count_modes", "modes of ten links", "steady_shapes")


def sizes(root=ROOT):
    """Files and lines of each tree that belong to the project."""
    command = ["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard", *TREES]
    listed = subprocess.run(command, capture_output=True, text=True, check=True).stdout
    files = [file for name in listed.splitlines() if (file := Path(root, name)).exists()]
    for tree, ends in TREES.items():
        own = [file for file in files if file.is_relative_to(Path(root, tree)) and file.suffix in ends]
        yield f"{tree}: files", len(own)
        yield f"{tree}: lines", sum(file.read_bytes().count(b"\n") for file in own)


def compile_times(root=ROOT):
    """CPU time to compile each program over that of <Eigen/Dense>, measured again when a header has changed."""
    headers = sorted(Path(root, "include").rglob("*.hpp"))
    key = hashlib.sha1(b"".join(file.read_bytes() for file in headers)).hexdigest()
    kept = ROOT / "build" / f"compile_times_{key}.csv"
    if not kept.exists():
        part = kept.with_suffix(".part")
        command = [ROOT / "bench/compile_times", "--repeat", "1", "--include", Path(root, "include"), "--csv", part]
        subprocess.run([sys.executable, *command, "--only", *PROGRAMS], capture_output=True, check=True)
        part.rename(kept)
    with kept.open(encoding="utf-8") as file:
        times = {row["unit"]: float(row["x Eigen/Dense"]) for row in csv.DictReader(file)}
    return [(f"compile, over Eigen/Dense: {name}", times[name]) for name in PROGRAMS]


def main(parts):
    with open(ROOT / "tools/sizes.toml", "rb") as file:
        before = tomllib.load(file)
    took = [line.split("\t")[:2] for line in Path(parts).read_text(encoding="utf-8").splitlines()]
    seconds = [(name, int(now), before["seconds"].get(name, 0)) for name, now in took]
    rows = [(f"seconds: {name}", now, then) for name, now, then in seconds]
    rows.append(("seconds: all of these", *(sum(column) for column in list(zip(*seconds, strict=True))[1:])))
    rows += [(name, now, before["sizes"].get(name, "")) for name, now in [*sizes(), *compile_times()]]
    print(f"\n{'':50} {'now':>8}  {before['commit']:>8}")
    for name, now, then in rows:
        print(f"{name:50} {now:8}  {then:8}")


if __name__ == "__main__":
    compile_times() if sys.argv[1] == "compile" else main(sys.argv[1])
