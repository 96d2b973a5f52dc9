# SPDX-License-Identifier: GPL-3.0-or-later
"""tools/release without the builds: the version in each file, the messages about CHANGELOG.md, the bill of materials."""

import importlib.util
import json
import os
import re
import shutil
import tarfile
import zipfile
from datetime import UTC, date, datetime

import pytest


@pytest.fixture(scope="module")
def release(repository):
    spec = importlib.util.spec_from_file_location("release", repository / "tools" / "release.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def tree(repository, tmp_path, release):
    """A copy of the files that state the version, as if it were 0.1.0, and a CHANGELOG ready for version 3.4.5."""
    for name, pattern in release.STATED.items():
        if (repository / name).exists():
            (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
            text = (repository / name).read_text(encoding="utf-8")
            (tmp_path / name).write_text(re.sub(pattern, r"\g<1>0.1.0", text), encoding="utf-8")
    (tmp_path / "CHANGELOG.md").write_text("# Changes\n\n## 3.4.5 (2027-01-31)\n\n- New.\n\n## 0.1.0 (unreleased)\n")
    return tmp_path


def test_bump_writes_one_version_everywhere(release, tree):
    def stated():
        return {name: (tree / name).read_text() for name in release.STATED if (tree / name).exists()}

    before = stated()
    assert list(release.problems(tree))
    release.bump(tree, "3.4.5")
    after = stated()
    assert list(release.problems(tree)) == [] and release.version_of(tree) == "3.4.5"
    for name in before.keys() - {"CITATION.cff", "debian/changelog"}:
        assert after[name] == before[name].replace("0.1.0", "3.4.5", 1)
    assert "date-released: 2027-01-31\n" in after["CITATION.cff"]
    release.bump(tree, "3.4.5")
    assert stated() == after  # a second time changes nothing
    (tree / "CMakeLists.txt").write_text(after["CMakeLists.txt"].replace("3.4.5", "3.4.6"))
    found = list(release.problems(tree))
    assert "CITATION.cff: the version must be 3.4.6, as in CMakeLists.txt, it is 3.4.5" in found[0]


def test_a_changelog_of_debian_gets_a_new_entry(release, tree):
    entry = "revchain (0.1.0) unstable; urgency=medium\n\n  * First.\n\n -- A B <a@b.invalid>  Wed, 25 Nov 2026 16:00:00 +0000\n"
    (tree / "debian").mkdir(exist_ok=True)
    (tree / "debian" / "changelog").write_text(entry)
    release.bump(tree, "3.4.5")
    text = (tree / "debian" / "changelog").read_text()
    assert text.startswith("revchain (3.4.5) unstable; urgency=medium\n\n  * ")
    assert " -- A B <a@b.invalid>  Sun, 31 Jan 2027 00:00:00 +0000\n\n" + entry in text


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("# Changes\n", r"must be that of version 3\.4\.5, it is missing\. Write: ## 3\.4\.5 \(YYYY-MM-DD\)"),
        ("# Changes\n\n## 0.1.0 (2026-01-01)\n\n- Old.\n", r"must be that of version 3\.4\.5, it is 0\.1\.0\. Write: "),
        ("## 3.4.5 (2027-01-31)\n\n## 0.1.0 (2026-01-01)\n\n- Old.\n", r"section of version 3\.4\.5 is empty"),
        ("## 3.4.5 (unreleased)\n\n- New.\n", r"must have a date, it has \(unreleased\)\. Write: ## 3\.4\.5 "),
        ("## 3.4.5\n\n- New.\n", r"must have a date, it has none"),
        ("## 3.4.5 (2027-02-31)\n\n- New.\n", r"must have a date, it has \(2027-02-31\)"),
    ],
)
def test_changelog_is_refused(release, tree, text, message):
    (tree / "CHANGELOG.md").write_text(text)
    before = (tree / "CMakeLists.txt").read_text()
    with pytest.raises(release.Refused, match=message):
        release.bump(tree, "3.4.5")
    assert (tree / "CMakeLists.txt").read_text() == before


def test_other_refusals(release, tree):
    assert release.release_date(tree, "3.4.5") == date(2027, 1, 31)
    with pytest.raises(release.Refused, match=r"three numbers such as 1\.2\.3, it is v3\.4"):
        release.bump(tree, "v3.4")
    (tree / "CMakeLists.txt").write_text("project(revchain)\n")
    with pytest.raises(release.Refused, match="CMakeLists.txt: has no version"):
        release.version_of(tree)


def test_bill_of_materials(release, repository):
    when = datetime(2027, 1, 31, tzinfo=UTC)
    text = release.sbom(repository, "2.8", when)  # follows the schema, or it would be refused
    assert text == release.sbom(repository, "2.8", when)
    bill = json.loads(text)
    assert bill["metadata"]["component"]["version"] == release.version_of(repository)
    parts = {part["name"]: part for part in bill["components"]}
    licences = {name: part["licenses"][0]["expression"] for name, part in parts.items() if "licenses" in part}
    assert licences == {"gsl": "GPL-3.0-or-later", "cmeel-eigen": "MPL-2.0", "pybind11": "BSD-3-Clause", "three": "MIT"}
    bundle = (repository / "src/revchain/motion/viewer.min.js").read_text(encoding="utf-8")
    assert f'"{parts["three"]["version"].split(".")[1]}"' in bundle  # three.REVISION
    scopes = [parts[name]["scope"] for name in ("numpy", "mujoco")]
    assert parts["gsl"]["version"] == "2.8" and scopes == ["required", "optional"]


def test_archive_depends_on_contents_alone(release, tmp_path):
    for number in range(2):
        site = tmp_path / str(number)
        for name in ("b", "a")[:: 1 - 2 * number]:  # written in the other order, and with another time, the second time
            (site / name).mkdir(parents=True)
            (site / name / "index.html").write_text(name)
            os.utime(site / name / "index.html", (number, number))
        (tmp_path / f"of{number}").mkdir()
        release.archive(site, tmp_path / f"of{number}" / "x-site.tar.gz", 1_800_000_000)
    assert list(release.differences(tmp_path / "of0", tmp_path / "of1")) == []
    with tarfile.open(tmp_path / "of0" / "x-site.tar.gz") as tar:
        assert tar.getnames() == ["x-site", "x-site/a", "x-site/a/index.html", "x-site/b", "x-site/b/index.html"]


def test_differences_of_two_builds(release, tmp_path):
    one, other = tmp_path / "one", tmp_path / "other"
    for folder in (one, other):
        folder.mkdir()
        (folder / "a.tar.gz").write_bytes(b"same")
        with zipfile.ZipFile(folder / "b.whl", "w") as wheel:
            wheel.writestr(zipfile.ZipInfo("equal"), "equal")
            wheel.writestr(zipfile.ZipInfo("module.so"), folder.name)
    (one / "c").write_text("")
    assert list(release.differences(one, other)) == ["b.whl differs", "  module.so", "c is in one build only"]
    (one / "c").unlink()
    shutil.copy(one / "b.whl", other)
    assert list(release.differences(one, other)) == []
