# SPDX-License-Identifier: GPL-3.0-or-later
"""Each claim with a number in README, docs, docstrings and public headers has a check, and what is quick to check holds."""

import runpy
from pathlib import Path

import pytest


@pytest.fixture(scope="module")
def claims(repository):
    return runpy.run_path(str(repository / "tools/claims.py"))


@pytest.fixture
def tree(tmp_path, claims):
    """A project of one page, one register and the given entries."""
    claims["accuracy_rows"].cache_clear()

    def make(page, register):
        (tmp_path / "docs").mkdir(exist_ok=True)
        (tmp_path / "tests/claims").mkdir(parents=True, exist_ok=True)
        (tmp_path / "docs/accuracy.md").touch()
        (tmp_path / "docs/page.md").write_text(page, encoding="utf-8")
        (tmp_path / "tests/claims/page.toml").write_text(register, encoding="utf-8")
        return tmp_path

    yield make
    claims["accuracy_rows"].cache_clear()


def test_each_claim_has_a_check(repository, claims):
    missing, _ = claims["unmatched"](repository)
    assert not [f"{each.file}:{each.line}: {each.text}" for each in missing], "tests/claims has no entry for these"
    assert not claims["gone"](repository), "these sentences are no longer in their files"


def test_each_test_that_is_named_exists(repository, claims):
    for _, register in claims["registers"](repository):
        for claim in register.get("claim", []):
            if "test" in claim:
                assert claims["check"](claim, {}, repository, False).good, claim


@pytest.mark.parametrize("name", sorted(path.stem for path in Path(__file__).parents[1].glob("claims/*.toml")))
def test_quick_checks_hold(repository, claims, name):
    (register,) = (register for path, register in claims["registers"](repository) if path.stem == name)
    names, wrong = claims["names_of"](register), []
    for claim in register.get("claim", []):
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
    root = tree("It takes 3 seconds. It has 7 links.\n\n```text\n5 seconds\n```\n", "")
    missing, rest = claims["unmatched"](root)
    assert [each.text for each in missing] == ["It takes 3 seconds."]
    assert [each.text for each in rest] == ["It has 7 links."]


def test_only_the_page_made_from_headers_is_left_out(claims, tree):
    root = tree("", "")
    for name in ("tutorial", "reference"):
        (root / "docs" / name).mkdir()
        (root / "docs" / name / "cpp.md").write_text(f"The {name} takes 3 seconds.\n", encoding="utf-8")
    missing, _ = claims["unmatched"](root)
    assert [each.text for each in missing] == ["The tutorial takes 3 seconds."]


def test_a_wrong_number_and_a_sentence_that_is_gone_are_found(claims, tree):
    entry = '[[claim]]\nfile = "docs/page.md"\ntext = "takes 3 seconds"\nequals = {"3" = "1 + 1"}\n'
    root = tree("It takes 3 seconds.\n", entry)
    assert claims["unmatched"](root)[0] == [] == claims["gone"](root)
    (_, register), = claims["registers"](root)
    result = claims["check"](register["claim"][0], claims["names_of"](register), root, False)
    assert not result.good and result.says == "2"
    assert len(claims["gone"](tree("It is quick.\n", entry))) == 1


def test_an_entry_with_two_checks_is_refused(claims, tree):
    root = tree("", '[[claim]]\nfile = "docs/page.md"\ntext = "x"\ntest = "a"\nsource = "b"\n')
    with pytest.raises(ValueError, match="one of equals, holds"):
        claims["registers"](root)
