# SPDX-License-Identifier: GPL-3.0-or-later
"""The recipes in packaging/ and debian/ agree with CMakeLists.txt, pyproject.toml and the licences of the files."""

import json
import re
import subprocess
import sys
import tomllib
from fnmatch import fnmatchcase

import pytest
import yaml
from typer.main import get_command

DEBIAN_NAMES = {"GPL-3.0-or-later": "GPL-3+", "MPL-2.0": "MPL-2.0", "GPL-3.0-or-later AND MIT": "GPL-3+ and Expat"}


@pytest.fixture(scope="module")
def recipes(repository):
    """The text of each recipe."""
    names = [
        "debian/changelog", "debian/control", "packaging/conan/conanfile.py", "packaging/conda/recipe.yaml",
        "packaging/vcpkg/revchain/vcpkg.json",
    ]  # fmt: skip
    return {name.rsplit("/", 1)[1]: (repository / name).read_text(encoding="utf-8") for name in names}


@pytest.fixture(scope="module")
def cmake(repository):
    return (repository / "CMakeLists.txt").read_text(encoding="utf-8")


@pytest.fixture(scope="module")
def project(repository):
    return tomllib.loads((repository / "pyproject.toml").read_text(encoding="utf-8"))


@pytest.mark.slow
def test_every_file_has_a_licence(repository):
    done = subprocess.run([sys.executable, "-m", "reuse", "lint"], cwd=repository, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr


def test_versions_are_that_of_cmake(recipes, cmake):
    pattern = re.search(r're\.search\(r"(.*?)",', recipes["conanfile.py"])[1]
    found = {
        "debian/changelog": re.match(r"revchain \((.*)\)", recipes["changelog"])[1],
        "vcpkg.json": json.loads(recipes["vcpkg.json"])["version"],
        "recipe.yaml": yaml.safe_load(recipes["recipe.yaml"])["context"]["version"],
        "conanfile.py, which reads it": re.search(pattern, cmake)[1],
    }
    version = re.search(r"project\(revchain VERSION (\S+)", cmake)[1]
    assert found == dict.fromkeys(found, version)


def test_bounds_of_c_plus_plus_dependencies_are_those_of_cmake(recipes, cmake):
    low, below = re.search(r"Eigen3_VERSION VERSION_LESS (\S+) OR NOT Eigen3_VERSION VERSION_LESS (\d+)", cmake).groups()
    tool = re.search(r"cmake_minimum_required\(VERSION (\d+\.\d+)", cmake)[1]
    eigen = json.loads(recipes["vcpkg.json"])["dependencies"][0]
    assert (eigen["name"], eigen["version>="]) == ("eigen3", f"{low}.0")
    assert f'"eigen/[>={low} <{below}]"' in recipes["conanfile.py"]
    assert recipes["control"].count(f" libeigen3-dev (>= {low}),") == 2
    assert f" cmake (>= {tool})," in recipes["control"]
    for output in yaml.safe_load(recipes["recipe.yaml"])["outputs"]:
        assert f"eigen >={low},<{below}" in output["requirements"]["host"]
        assert f"cmake >={tool}" in output["requirements"]["build"]


def test_bounds_of_python_dependencies_are_those_of_pyproject(recipes, project):
    cpp, python = yaml.safe_load(recipes["recipe.yaml"])["outputs"]
    assert (cpp["package"]["name"], python["package"]["name"]) == ("revchain-cpp", "revchain")
    needed = project["project"]["dependencies"]
    assert python["requirements"]["run"] == ["python", *(line.replace(">=", " >=") for line in needed)]
    build = dict(line.split(">=") for line in project["build-system"]["requires"] if "eigen" not in line)
    assert {f"{name} >={bound}" for name, bound in build.items()} < set(python["requirements"]["host"])
    debian = {"pybind11": "pybind11-dev", "scikit-build-core": "python3-scikit-build-core"}
    del build["pybind11-stubgen"], build["numpy"]  # for _core.pyi, which the Debian package does not have
    for name, bound in build.items():
        assert f" {debian[name]} (>= {bound})," in recipes["control"]


def test_extras_that_debian_suggests_exist(repository, project):
    rules = (repository / "debian/rules").read_text(encoding="utf-8")
    sections = re.findall(r"--suggests-section=(\w+)", rules)
    assert sections
    assert set(sections) <= set(project["project"]["optional-dependencies"])


def test_files_that_the_recipes_name_exist(repository, recipes):
    for name in ("librevchain-dev.examples", "python3-revchain.examples", "python3-revchain.manpages"):
        for pattern in (repository / "debian" / name).read_text(encoding="utf-8").split():
            assert list(repository.glob(pattern)), f"debian/{name}: no file {pattern}"
    for output in yaml.safe_load(recipes["recipe.yaml"])["outputs"]:
        files = [name for test in output["tests"] for name in test.get("files", {}).get("source", [])]
        for pattern in [*files, *output["about"]["license_file"]]:
            assert list(repository.glob(pattern)), f"recipe.yaml: no file {pattern}"
    exported = re.search(r"for pattern in \((.*)\)", recipes["conanfile.py"])[1]
    for pattern in re.findall(r'"(.*?)"', exported):
        assert list(repository.glob(pattern)), f"conanfile.py: no file {pattern}"


def test_debian_copyright_names_the_licence_of_each_file(repository):
    stanzas = []
    for stanza in (repository / "debian/copyright").read_text(encoding="utf-8").split("\n\n"):
        if match := re.match(r"Files:((?:.|\n )*)\n", stanza):
            stanzas.append((match[1].split(), re.search(r"^License: (.*)", stanza, re.M)[1]))
    checked = 0
    for folder in ("bindings", "include", "src"):
        for path in sorted(p for p in (repository / folder).rglob("*") if p.is_file() and "__pycache__" not in p.parts):
            head = path.read_bytes()[:200].decode("utf-8", "replace")
            name = path.relative_to(repository).as_posix()
            if match := re.search(r"SPDX-License-Identifier: ([\w.-]+(?: AND [\w.-]+)?)", head):
                said = [licence for patterns, licence in stanzas if any(fnmatchcase(name, p) for p in patterns)][-1]
                assert said == DEBIAN_NAMES[match[1]], f"debian/copyright: {name} is under {match[1]}"
                checked += 1
    assert checked > 300


def test_manual_page_has_every_command_and_option(repository):
    from revchain.cli.app import app

    page = (repository / "debian/revchain.1").read_text(encoding="utf-8").replace("\\-", "-")
    command = get_command(app)
    assert set(re.findall(r"^\.B (\w+)$", page.split(".SH COMMANDS")[1], re.M)) == set(command.commands)
    options = {name for parameter in command.params for name in parameter.opts if "completion" not in name}
    assert options <= set(re.findall(r"^\.B (--\S+)$", page, re.M))
