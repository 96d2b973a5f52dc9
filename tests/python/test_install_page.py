# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/install.md: the table has the rows of tools/matrix, the packages to install are those of tools/setup.sh."""

import runpy
import subprocess
import tomllib


def test_table_of_versions(repository):
    matrix = runpy.run_path(str(repository / "tools/matrix"))
    page = (repository / "docs/install.md").read_text("utf-8")
    lines = page[page.index("| row |") :].partition("\n\n")[0].splitlines()
    headings, _, *body = [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]
    assert tuple(headings) == matrix["HEADINGS"]
    assert [cells[0] for cells in body] == [row.name for row in matrix["rows"]()]
    for row, cells in zip(matrix["rows"](), body, strict=True):
        found = dict(zip(headings, cells, strict=True))
        wanted = {"compiler": row.compiler.replace("-", " "), "CMake": row.cmake, "Eigen": row.eigen}
        wanted |= {"Catch2": row.catch2} if "passed" in found["C++ tests"] else {}
        wanted |= {"Python": row.python, "numpy": row.numpy} if "passed" in found["Python tests"] else {}
        for heading, version in wanted.items():
            assert matrix["matches"](version, found[heading]), (row.name, heading, found[heading])
        run = [part for part, heading in matrix["PARTS"].items() if found[heading]]
        assert run == row.parts.split(","), row.name


def test_packages_to_install(repository):
    page = (repository / "docs/install.md").read_text("utf-8")
    for manager in ("apt-get", "brew", "dnf", "conda"):
        command = f". tools/setup.sh; install_line {manager} compiler python gsl"
        line = subprocess.run(["sh", "-c", command], cwd=repository, env={"root": str(repository), "PATH": "/usr/bin:/bin"},
                              capture_output=True, text=True, check=True).stdout  # fmt: skip
        assert line in page


def test_extras(repository):
    page = (repository / "docs/install.md").read_text("utf-8")
    extras = tomllib.loads((repository / "pyproject.toml").read_text("utf-8"))["project"]["optional-dependencies"]
    table = page[page.index("| extra |") :].partition("\n\n")[0]
    assert {line.split("`")[1] for line in table.splitlines() if "`" in line} == set(extras) - {"test", "docs"}
