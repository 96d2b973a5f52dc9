# SPDX-License-Identifier: GPL-3.0-or-later
"""Each claim with a number in README, docs, docstrings and public headers has a check, and what is quick to check holds."""

from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def project(repository, claims):
    return claims["Tree"](repository)


@pytest.fixture
def tree(tmp_path, claims):
    """A project of one page, one register and the given entries."""

    def make(page, register):
        (tmp_path / "docs").mkdir(exist_ok=True)
        (tmp_path / "tests/claims").mkdir(parents=True, exist_ok=True)
        (tmp_path / "docs/accuracy.md").touch()
        (tmp_path / "docs/page.md").write_text(page, encoding="utf-8")
        (tmp_path / "tests/claims/page.toml").write_text(register, encoding="utf-8")
        return claims["Tree"](tmp_path)

    return make


def test_each_claim_has_a_check(project, claims):
    missing, _ = claims["unmatched"](project)
    assert not [f"{each.file}:{each.line}: {each.text}" for each in missing], "tests/claims has no entry for these"
    assert not claims["gone"](project), "these sentences are no longer in their files"


def test_each_test_that_is_named_exists(project, repository, claims):
    for register in project.registers.values():
        for claim in register["claim"]:
            if "test" in claim:
                assert claims["check"](claim, {}, repository, False).good, claim


@pytest.mark.parametrize("name", sorted(path.stem for path in Path(__file__).parents[1].glob("claims/*.toml")))
def test_quick_checks_hold(project, repository, claims, name):
    register = project.registers[name]
    names, wrong = claims["names_of"](register), []
    for claim in register["claim"]:
        result = claims["check"](claim, names, repository, False)
        if not result.good:
            wrong.append((claim["file"], claim["text"], result.says))
    assert not wrong


# The tool ------------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("value", "written", "good"),
    [
        (2.557, "2.56 rad/s", True),
        (2.5549, "2.56", False),
        (1234.4, "1,234", True),
        (3.04e-29, "3e-29", True),
        (4e-29, "3e-29", False),
        (-0.2500004, "-0.25", True),
        (60.6, "60", False),
    ],
)
def test_a_value_rounds_to_what_is_written(claims, value, written, good):
    assert claims["rounds_to"](value, written) == good


def test_ranges_and_units_of_time(claims):
    assert claims["numbers_in"]("10 to 30 milliseconds") == pytest.approx((0.01, 0.03))
    assert claims["numbers_in"]("0.2 µs") == pytest.approx((2e-7, 2e-7))
    with pytest.raises(ValueError, match="no number"):
        claims["numbers_in"]("fast")


def test_a_sentence_without_a_check_is_found(claims, tree):
    project = tree("It takes 3 seconds. It has 7 links.\n\n```text\n5 seconds\n```\n", "")
    missing, rest = claims["unmatched"](project)
    assert [each.text for each in missing] == ["It takes 3 seconds."]
    assert [each.text for each in rest] == ["It has 7 links."]


def test_only_the_page_made_from_headers_is_left_out(claims, tree):
    project = tree("", "")
    for name in ("tutorial", "reference"):
        (project.root / "docs" / name).mkdir()
        (project.root / "docs" / name / "cpp.md").write_text(f"The {name} takes 3 seconds.\n", encoding="utf-8")
    missing, _ = claims["unmatched"](project)
    assert [each.text for each in missing] == ["The tutorial takes 3 seconds."]


def test_what_decorators_write_into_docstrings_is_found(claims):
    text = '@described("3 ulp", "section 1", "2 ms")\ndef f():\n    """Return."""\n\n@closed_form(g, "2 ulp", "x", cost="1 s")\ndef g(): ...\n'
    found = [(each.name, each.text) for each in claims["of_module"](Path("m.py"), text)]
    written = [("f", "Accuracy: 3 ulp."), ("f", "Cost: 2 ms."), ("g", "Accuracy: 2 ulp."), ("g", "Cost: 1 s.")]
    assert [each for each in found if each[1] and each[1] != "Return."] == written


def test_a_wrong_number_and_a_sentence_that_is_gone_are_found(claims, tree):
    entry = '[[claim]]\nfile = "docs/page.md"\ntext = "takes 3 seconds"\nequals = {"3" = "1 + 1"}\n'
    project = tree("It takes 3 seconds.\n", entry)
    assert claims["unmatched"](project)[0] == [] == claims["gone"](project)
    (register,) = project.registers.values()
    result = claims["check"](register["claim"][0], claims["names_of"](register), project.root, False)
    assert not result.good and result.says == "2"
    assert len(claims["gone"](tree("It is quick.\n", entry))) == 1


def test_times_that_a_command_prints(claims, tree):
    entry = '[[claim]]\nfile = "docs/page.md"\ntext = "takes 3 ms"\nmeasured = {"3 ms" = "one: call"}\n'
    for took, good in (("2000 µs", True), ("7 ms", False)):
        project = tree("It takes 3 ms.\n", f"measure = \"printf 'one: call\\t{took}\\n'\"\n" + entry)
        (register,) = project.registers.values()
        names = claims["names_of"](register)
        assert claims["check"](register["claim"][0], names, project.root, False).says == "by --run"
        assert claims["check"](register["claim"][0], names, project.root, True).good == good


def test_an_entry_with_two_checks_is_refused(claims, tree):
    project = tree("", '[[claim]]\nfile = "docs/page.md"\ntext = "x"\ntest = "a"\nsource = "b"\n')
    with pytest.raises(ValueError, match="one of equals, holds"):
        project.registers  # noqa: B018
