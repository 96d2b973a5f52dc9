# SPDX-License-Identifier: GPL-3.0-or-later
"""The results of the benchmarks and the pages that quote them: bench/run, bench/pages.py, bench/results."""

import importlib.util
import json
import re
import sys

import pytest


@pytest.fixture(scope="module")
def tools(repository):
    """The modules bench/pages.py and bench/measure.py."""
    found = []
    for name in ("pages", "measure"):
        spec = importlib.util.spec_from_file_location(f"bench_{name}", repository / "bench" / f"{name}.py")
        module = importlib.util.module_from_spec(spec)
        sys.modules[spec.name] = module
        spec.loader.exec_module(module)
        found.append(module)
    return found


def test_a_part_that_is_not_there(python, repository):
    done = python(repository / "bench/measure.py", "--only", "nothing of the kind")
    assert done.returncode == 2 and "there is no part 'nothing of the kind'" in done.stderr


def test_a_task_that_is_not_there(python, repository):
    done = python(repository / "bench/heights.py", "--csv", "x.csv", "--tasks", "nothing of the kind")
    assert done.returncode == 2 and "no description contains 'nothing of the kind'" in done.stderr


def test_pages_are_as_the_results(tools, repository):
    results = tools[0].Results()
    texts, complaints, missing = tools[0].pages(results)
    assert not complaints, "\n".join(complaints)
    stale = [page for page, text in texts.items() if text != (repository / page).read_text(encoding="utf-8")]
    assert not stale, "run bench/pages.py"
    assert not missing, "\n".join(missing)
    assert list(results.about["parts"]) == [part.name for part in tools[1].PARTS]


def test_a_result_that_changes_makes_a_page_stale(tools, tmp_path):
    for file in tools[0].RESULTS.iterdir():
        text = file.read_text(encoding="utf-8")
        if file.name == "continuous.csv":
            text = re.sub(r"(?m)^revchain,[\d.]+", "revchain,980000", text)
        (tmp_path / file.name).write_text(text, encoding="utf-8")
    texts, complaints, _ = tools[0].pages(tools[0].Results(tmp_path))
    assert "| 980,000 |" in texts["docs/benchmarks.md"]
    assert [line for line in complaints if "length/height 500 take 1.8 ms" in line]


def test_every_result_is_read(tools, repository):
    """By a table, a sentence or a picture of a page, or it is linked there."""
    results = tools[0].Results()
    tools[0].pages(results)
    texts = [repository / "README.md", *repository.glob("docs/**/*.md")]
    quoted = "".join(path.read_text(encoding="utf-8") for path in texts)
    drawn = {f"{part.name}.csv" for part in tools[1].PARTS if part.picture}
    read = results.opened | drawn | {"about.json"} | set(re.findall(r"bench/results/([\w.-]+)", quoted))
    assert {file.name for file in results.folder.iterdir()} <= read
    assert not {name for name in re.findall(r"bench/results/([\w-]+\.\w+)", quoted) if not (results.folder / name).exists()}


def test_no_name_of_the_machine(tools):
    found = tools[1].machine()
    assert set(found) <= {"processor", "cores", "vectors", "L1d cache", "L2 cache", "L3 cache"}
    assert found["cores"] >= 1 and found["processor"]


def test_numbers_of_tables(tools):
    digits = tools[0].digits
    assert [digits(x) for x in (0.0684, 1.05, 17.4, 275.2, 18_800.0, 3.12e12, 5e-7)] == \
        ["0.068", "1.1", "17", "280", "19,000", "3.1e12", "5e-7"]


def test_what_programs_say_is_found(tools, tmp_path):
    said = ["16749 answers asked; 0 errors above their bound, 0 tolerances not kept, 0 times too short",
            "5157 choices, 5128 (99.4 %) within a factor of 2 of the cheapest; 3 times another had to be asked"]
    parts = {"tradeoff": {"said": said}, "models": {"said": ["1 of 4721 predictions beyond a factor of 3"]},
             "choices": {"said": ["7992 of 8000 (99.9 %) within a factor of 2 of the cheapest; 0 bounds violated"]}}
    (tmp_path / "about.json").write_text(json.dumps({"parts": parts}), encoding="utf-8")
    made = tools[0].choices(tools[0].Results(tmp_path))
    assert "| 4,721 predicted times | 1 wrong by more than a factor of 3 |" in made and "| 5,157 choices | 99.4 %" in made
