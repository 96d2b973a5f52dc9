# SPDX-License-Identifier: GPL-3.0-or-later
"""docs/reference/cpp.md is made from the public headers, and says something about each of them."""

import re
import runpy

import pytest


@pytest.fixture
def reference(repository):
    return runpy.run_path(str(repository / "docs/site/cpp_reference.py"))


def test_the_list_of_headers_is_that_of_the_headers(repository, reference):
    text = (repository / "docs/reference/cpp.md").read_text("utf-8")
    assert text == reference["kept_page"](), "run: python docs/site/cpp_reference.py --write"
    listed, _, index = text.partition("## Index of symbols")
    headers = {path.name for path in (repository / "include/revchain").glob("*.hpp")}
    rows = re.findall(r"^\| \[(\w+\.hpp)\]\(\.\./\.\./include/revchain/\1\)(?: \(GSL\))? \| (.{20,}\.) \|$", listed, re.MULTILINE)
    assert len(headers) == len(rows) and headers == {name for name, _ in rows}
    names = re.findall(r"^\| `([\w:]+)` \|", index, re.MULTILINE)
    assert len(names) == len(set(names)) > 200
    assert {"Chain", "modes", "plummet", "Held", "InvalidArgument", "conical_pendulum::angular_speed", "hoop::tension"} <= set(names)


def test_each_name_has_a_section_on_the_page_of_its_header(reference):
    pages = reference["pages"]()
    labels = {label for text in pages.values() for label in re.findall(r"^\((cpp-[\w-]+)\)=$", text, re.MULTILINE)}
    linked = re.findall(r"\]\(#(cpp-[\w-]+)\)", reference["with_pages"](reference["kept_page"]()))
    assert len(linked) > 200 and set(linked) == labels


def test_a_new_header_is_missed(repository, reference, tmp_path):
    (tmp_path / "include/revchain").mkdir(parents=True)
    reference["kept_page"].__globals__["HEADERS"] = tmp_path / "include/revchain"
    for path in (repository / "include/revchain").glob("*.hpp"):
        (tmp_path / "include/revchain" / path.name).write_text(path.read_text("utf-8"), "utf-8")
    (tmp_path / "include/revchain/novel.hpp").write_text("// SPDX-License-Identifier: MPL-2.0\n#pragma once\n", "utf-8")
    with pytest.raises(ValueError, match="GROUPS must name each public header once: novel"):
        reference["kept_page"]()


def test_walks_through_the_code_lead_on(repository):
    """Each table of docs/design.md has at most eight files; each file has the functions named and is called above."""
    text = (repository / "docs/design.md").read_text("utf-8").split("### Two walks through the code")[1].split("\n#")[0]
    tables = text.strip().split("\n\n")[1:]
    assert len(tables) == 2
    for table in tables:
        rows = [re.findall(r"`([\w./]+)`", row) for row in table.splitlines()[2:]]
        assert 1 < len(rows) <= 8, table
        before = ""
        for file, *functions in rows:
            code = (repository / "include/revchain" / file).read_text("utf-8")
            assert functions and all(re.search(rf"\b{name}(<[^()]*>)?\(", code) for name in functions), file
            assert not before or any(re.search(rf"\b{name}\b", before) for name in functions), file
            before = code
