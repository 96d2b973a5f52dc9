# SPDX-License-Identifier: MPL-2.0
"""Claims with a number in README, docs, docstrings and public headers, each with what shows it (see tools/claims).

A claim is a piece of a sentence and one check. The files of checks, tests/claims/*.toml, are lists of

    [[claim]]
    file = "docs/howto/precision.md"
    text = "3e-29 for one, 1e-27 for 30"    # as it is written there, line breaks as spaces
    equals = {"3e-29" = "bound(1)", "1e-27" = "bound(30)"}

with one of these checks:

equals    number as written: Python expression, which must round to the number at the digits written
holds     a Python expression that must be true; what it compared is printed
cost      time as written: Python statement, which must take that time within a factor of 2 (or that range)
measured  time as written: name of a line that the command `measure` of the file prints, with the same tolerance
test      tests that show it: "tests/cpp/bell.cpp: first blows" or "tests/python/test_fit.py: test_name"
run, says a command, and a regular expression that must be found in what it prints
source    where a fact from elsewhere is stated

Expressions see revchain as `rc`, `np`, `mp`, what `math` has, `g` (9.80665), and what `setup` of their file defines.
`long = true`: evaluated by --run alone. A test that is named must exist; `./test --all` shows that it passes. These claims
need no entry: rows of docs/accuracy.md and docs/paper.md, which name their tests; accuracy that a docstring repeats from
there; tables made from results of benchmarks; output of code on pages, which the tests run.
"""

import argparse
import ast
import math
import os
import re
import subprocess
import sys
import textwrap
import time
import tomllib
from functools import cache, cached_property
from pathlib import Path
from typing import Any, NamedTuple

ROOT = Path(__file__).resolve().parent.parent
CHECKS = "equals", "holds", "cost", "measured", "test", "run", "source"
QUANTITIES = (
    r"ulp|%|per ?cent|(?:micro|milli|nano)?seconds?\b|[µmn]s\b|min(?:utes)?\b|hours?\b|[KMG]B\b|bytes\b|times\b|random\b"
    r"|cases\b|lines\b|digits\b"
)
WORDS = "two|three|four|five|six|eight|ten|twenty|fifty|half|third|quarter|tenth|hundred|thousand|million"
NUMBER = rf"(?:\d[\d.,]*(?:e[+-]?\d+)?|\b(?:{WORDS})\b)"
# What a sentence must contain to be a claim that needs a check: a small power of ten, or a number of one of the quantities.
CLAIM = re.compile(rf"\de-\d|10\^\{{?-\d|{NUMBER}( (to|or) {NUMBER})?[ -]?({QUANTITIES})|\bfactor of \d")
# Arguments of decorators that add a sentence to a docstring (closed_forms/table.py).
FACTS = {"described": ("accuracy", "source", "cost"), "closed_form": ("formula", "accuracy", "source", "cost")}
SHORT, LONG = ("ns", "µs", "ms", "s", "min"), ("nanosecond", "microsecond", "millisecond", "second", "minute")
SECONDS = {unit: size for units in (SHORT, LONG) for unit, size in zip(units, (1e-9, 1e-6, 1e-3, 1, 60), strict=True)}


class Sentence(NamedTuple):
    """A sentence, row or list item of `file`, the first line of its paragraph, and the name whose docstring it is in."""

    file: str
    line: int
    text: str
    name: str = ""


# Sentences -----------------------------------------------------------------------------------------------------------


def sentences_of(paragraph: str) -> list[str]:
    return re.split(r"(?<=[.!?])\s+(?=[A-Z`*\"\[(])", " ".join(paragraph.split()))


def of_page(path: Path, text: str) -> list[Sentence]:
    """Sentences of a Markdown page. Code and its output, and tables made from results, are left out."""
    found = []
    blank = lambda match: "\n" * match.group().count("\n")  # noqa: E731
    text = re.sub(r"^( *)(```|~~~).*?^\1\2\s*$", blank, text, flags=re.S | re.M)
    text = re.sub(r"<!-- results: .*?<!-- end -->", blank, text, flags=re.S)
    for match in re.finditer(r"(?:^(?!\s*$).*\n?)+", text, re.M):
        line = 1 + text[: match.start()].count("\n")
        for block in re.split(r"\n(?=\s*(?:\||[-*] |\d+\. |#))", match.group()):
            found += [Sentence(str(path), line, each) for each in sentences_of(block)]
            line += 1 + block.count("\n")
    return found


def of_module(path: Path, text: str) -> list[Sentence]:
    """Sentences of the public docstrings of a module and of its fields; examples, which the tests run, are left out."""
    found = []

    def visit(node: Any, prefix: str) -> None:
        docstring = re.sub(r"^ *>>>.*(\n *\S.*)*", "", ast.get_docstring(node) or "", flags=re.M)
        paragraphs = re.split(r"\n\s*\n", docstring)
        if isinstance(node, ast.ClassDef):
            for child in node.body:
                if isinstance(child, ast.AnnAssign) and isinstance(child.value, ast.Call) and child.value.args:
                    paragraphs.append(str(getattr(child.value.args[0], "value", "")))
        for decorator in getattr(node, "decorator_list", ()):  # of closed forms: accuracy, source, cost
            if isinstance(decorator, ast.Call) and getattr(decorator.func, "id", "") in FACTS:
                given = dict(zip(FACTS[decorator.func.id], decorator.args, strict=False))
                given |= {each.arg: each.value for each in decorator.keywords}
                said = {name: ast.literal_eval(given[name]) for name in ("accuracy", "cost") if name in given}
                paragraphs += [f"{name.title()}: {text}." for name, text in said.items() if text]
        line = node.body[0].lineno if node.body else 1
        found.extend(Sentence(str(path), line, each, prefix) for part in paragraphs for each in sentences_of(part))
        for child in ast.iter_child_nodes(node):
            if isinstance(child, (ast.FunctionDef, ast.ClassDef)) and not child.name.startswith("_"):
                visit(child, f"{prefix}.{child.name}".lstrip("."))

    visit(ast.parse(text), "")
    return found


def of_header(path: Path, text: str) -> list[Sentence]:
    """Sentences of the comments of a public header."""
    found = []
    for match in re.finditer(r"(?:^ *//.*\n)+", text, re.M):
        line = 1 + text[: match.start()].count("\n")
        comment = re.sub(r"^ *///? ?(    .*)?", "", match.group(), flags=re.M)  # without examples, which the tests run
        below = re.sub(r"\[\[\w+\]\]|template <[^{;(]*?>\n|requires .*\n", "", text[match.end() :].partition("\n\n")[0])
        named = re.search(r"\b(?:struct|class) (\w+)|\b(\w+)\(|(\w+) = ", below)
        name = f"{path.stem}.{next(filter(None, named.groups()))}" if named else path.stem
        paragraphs = re.split(r"\n\s*\n", comment)
        found += [Sentence(str(path), line, each, name) for part in paragraphs for each in sentences_of(part)]
    for match in re.finditer(r"///< (.*)", text):
        found.append(Sentence(str(path), 1 + text[: match.start()].count("\n"), match[1].strip(), path.stem))
    return found


def bare(text: str) -> str:
    """The sentence without code, mathematics and addresses of links."""
    return re.sub(r"`[^`]*`|\$[^$]*\$|\]\([^)]*\)", " ", text)


class Tree:
    """A tree of sources: its sentences, the list of docs/accuracy.md, and the files of checks, each read once."""

    def __init__(self, root: Path = ROOT) -> None:
        self.root = root

    @cached_property
    def sentences(self) -> list[Sentence]:
        root = self.root
        pages = [*root.glob("*.md"), *sorted((root / "docs").rglob("*.md")), *root.glob("paper/*.md")]
        pages = [page for page in pages if page != root / "docs/reference/cpp.md"]  # made from the headers
        modules, headers = sorted((root / "src").rglob("*.py")), sorted((root / "include/revchain").glob("*.hpp"))
        readers = ((pages, of_page), (modules, of_module), (headers, of_header))
        texts = [(read, path.relative_to(root), path.read_text("utf-8")) for files, read in readers for path in files]
        return [each for read, path, text in texts for each in read(path, text)]

    @cached_property
    def accuracy_rows(self) -> list[tuple[str, list[str]]]:
        """First cell and tests of each row of the list in docs/accuracy.md."""
        page = (self.root / "docs/accuracy.md").read_text("utf-8")
        section = page.partition("## Claims and their tests\n")[2].partition("\n## ")[0]
        rows = [line.strip("| ").split(" | ") for line in section.splitlines() if line.startswith("| `")]
        folder, named = {"cpp": "cpp", "py": "python"}, re.compile(r"`([\w/]+\.(cpp|py))`: ([^`]+)")

        def tests(cell: str) -> list[str]:
            files = [(f"tests/{folder[end]}/{file}", names) for file, end, names in named.findall(cell)]
            return [f"{file}: {name.strip()}" for file, names in files for name in names.rstrip("; ").split(";")]

        return [(row[0], tests(row[-1])) for row in rows]

    @cached_property
    def registers(self) -> dict[str, dict[str, Any]]:
        """The files of checks by name."""
        found = {}
        for path in sorted((self.root / "tests/claims").glob("*.toml")):
            register = tomllib.loads(path.read_text("utf-8"))
            for claim in register.setdefault("claim", []):
                known = {*CHECKS, "file", "text", "says", "given", "long"}
                if len(claim.keys() & {*CHECKS}) != 1 or not {"file", "text"} <= claim.keys() <= known:
                    kinds = ", ".join(CHECKS)
                    raise ValueError(f"{path.name}: a claim has file, text and one of {kinds}; this one is {claim}")
            found[path.stem] = register
        return found


# What needs no entry -------------------------------------------------------------------------------------------------


def tests_named(tree: Tree, sentence: Sentence) -> list[str]:
    """The tests of a sentence that names them itself, or repeats a promise of the list in docs/accuracy.md."""
    if sentence.file == "docs/accuracy.md" and sentence.text.startswith("| `"):
        return next((tests for first, tests in tree.accuracy_rows if sentence.text.startswith(f"| {first} |")), [])
    if sentence.file == "docs/paper.md" and sentence.text.startswith("|"):
        return [f"tests/cpp/paper/{file}" for file in re.findall(r"`(section_\d\.cpp)`", sentence.text)]
    if named := re.findall(r"`(tests/(?:cpp|python)/[\w/]+\.(?:cpp|py))`", sentence.text):
        return named
    if sentence.name and re.search(r"\bulps?\b|e-\d", sentence.text) and "Cost" not in sentence.text:
        first, last = sentence.name.split(".")[0], sentence.name.split(".")[-1]
        names = {sentence.name, first, last, f"{Path(sentence.file).stem}.{sentence.name}"}
        ending = sentence.file.endswith(".hpp")
        return [
            test
            for cell, tests in tree.accuracy_rows
            if names & {each.split(".")[-1] if ending else each for each in re.findall(r"`([\w.]+)`", cell)}
            for test in tests
        ]
    return []


# Checks --------------------------------------------------------------------------------------------------------------


def numbers_in(written: str) -> tuple[float, float]:
    """Lower and upper end of a number or range as written, with its unit of time if it has one, in seconds."""
    unit = re.search(r"([µa-z]+)$", written.strip())
    scale = SECONDS.get(unit[1] if unit[1] in SECONDS else unit[1].rstrip("s"), 1) if unit else 1
    found = [float(each.replace(",", "").rstrip(".")) * scale for each in re.findall(r"-?\d[\d,.]*(?:e[+-]?\d+)?", written)]
    if not found:
        raise ValueError(f"no number in {written!r}")
    return found[0], found[-1]


def rounds_to(value: float, written: str) -> bool:
    """Whether the value is the number as written, when rounded to as many digits."""
    number = re.search(r"-?\d[\d,]*(?:\.(\d+))?(?:e([+-]?\d+))?", written)
    if not number:
        raise ValueError(f"no number in {written!r}")
    last = 10.0 ** (int(number[2] or 0) - len(number[1] or ""))
    if not number[1] and not number[2]:  # 3000 may be rounded to hundreds, which the writer says by `holds`
        last = 1.0
    exact = float(number[0].replace(",", ""))
    return abs(float(value) - exact) <= 0.5000001 * last * (1 + 1e-9)


def seconds_of(statement: str, names: dict[str, Any]) -> float:
    """The shortest time of a few calls, after one that imports what is imported when it is first used."""
    code, best = compile(statement, "<cost>", "exec"), math.inf
    exec(code, names)
    start = time.perf_counter()
    while time.perf_counter() - start < 0.5 or best == math.inf:
        count, begun = 0, time.process_time()
        while time.process_time() - begun < 0.02 or not count:
            exec(code, names)
            count += 1
        best = min(best, (time.process_time() - begun) / count)
    return best


@cache
def measured(root: Path, command: str) -> dict[str, float]:
    """Seconds by name: the lines NAME, tab, TIME that a command prints, which is run once."""
    done = subprocess.run(command, shell=True, cwd=root, capture_output=True, text=True, check=True)
    lines = (line.rpartition("\t") for line in done.stdout.splitlines())
    return {name: numbers_in(took)[0] for name, tab, took in lines if tab}


def as_long(written: str, took: float) -> bool:
    """Whether a time is the one written, or in the range written, within a factor of 2."""
    low, high = numbers_in(written)
    return low / 2 <= took <= high * 2


def test_exists(root: Path, test: str) -> bool:
    file, _, name = test.partition(": ")
    path = root / file
    text = path.read_text("utf-8") if path.is_file() else ""
    return bool(text) and (not name or (f"def {name}(" if file.endswith(".py") else f'TEST_CASE("{name}') in text)


class Result(NamedTuple):
    good: bool
    says: str


def shown(value: Any) -> str:
    is_number = isinstance(value, (int, float)) or hasattr(value, "__float__")
    return f"{float(value):.6g}" if is_number else textwrap.shorten(str(value), 100)


def check(claim: dict[str, Any], names: dict[str, Any], root: Path, run: bool) -> Result:
    """Whether the claim is reproduced, and what was found. Without `run`, what takes long is not evaluated."""
    if "test" in claim:
        tests = [claim["test"]] if isinstance(claim["test"], str) else claim["test"]
        missing = [test for test in tests if not test_exists(root, test)]
        return Result(not missing, f"no such test: {', '.join(missing)}" if missing else "test")
    if "source" in claim:
        return Result(True, claim["source"])
    if not run and (claim.get("long") or {"cost", "measured", "run"} & claim.keys()):
        return Result(True, "by --run")
    names = dict(names)
    if "given" in claim:
        exec(claim["given"], names)
    if "equals" in claim:
        found = {written: eval(code, names) for written, code in claim["equals"].items()}
        good = all(rounds_to(value, written) for written, value in found.items())
        return Result(good, ", ".join(map(shown, found.values())))
    if "holds" in claim:
        tree = ast.parse(claim["holds"], mode="eval").body
        parts = [tree.left, *tree.comparators] if isinstance(tree, ast.Compare) else [tree]
        says = " ".join(shown(eval(ast.unparse(part), names)) for part in parts if not isinstance(part, ast.Constant))
        return Result(bool(eval(claim["holds"], names)), says)
    if "cost" in claim or "measured" in claim:
        if "cost" in claim:
            took = [(written, seconds_of(code, names)) for written, code in claim["cost"].items()]
        else:
            found = measured(root, names["measure"])
            took = [(written, found[name]) for written, name in claim["measured"].items()]
        return Result(all(as_long(*each) for each in took), ", ".join(f"{value:.2g} s" for _, value in took))
    paths = os.pathsep.join([str(Path(sys.executable).parent), os.environ.get("PATH", "")])  # of this Python first
    done = subprocess.run(
        claim["run"], shell=True, cwd=root, capture_output=True, text=True, env={**os.environ, "PATH": paths}
    )
    match = re.search(claim["says"], done.stdout + done.stderr, re.S)
    return Result(bool(match), " ".join(match[0].split()) if match else "not printed: " + claim["says"])


def written_check(claim: dict[str, Any]) -> str:
    kind = next(each for each in CHECKS if each in claim)
    value = claim[kind].values() if isinstance(claim[kind], dict) else claim[kind]
    return f"{kind}: {value if isinstance(value, str) else '; '.join(value)}"


def names_of(register: dict[str, Any]) -> dict[str, Any]:
    """What the expressions of a register see."""
    import mpmath
    import numpy

    import revchain

    names: dict[str, Any] = {name: getattr(math, name) for name in dir(math) if not name.startswith("_")}
    names |= {"rc": revchain, "np": numpy, "mp": mpmath, "g": 9.80665, "ROOT": ROOT, "measure": register.get("measure")}
    exec(register.get("setup", ""), names)
    return names


def unmatched(tree: Tree) -> tuple[list[Sentence], list[Sentence]]:
    """Claims without a check, and other sentences with a number that no entry names."""
    texts: dict[str, list[str]] = {}
    for register in tree.registers.values():
        for claim in register["claim"]:
            texts.setdefault(claim["file"], []).append(claim["text"])
    open_claims, rest = [], []
    for each in tree.sentences:
        said = bare(each.text)
        if re.search(r"\d", said) or CLAIM.search(said):
            if any(text in each.text or each.text in text for text in texts.get(each.file, ())) or tests_named(tree, each):
                continue
            (open_claims if CLAIM.search(said) else rest).append(each)
    return open_claims, rest


def gone(tree: Tree) -> list[str]:
    """Entries whose sentence is no longer in its file."""
    found: dict[str, str] = {}
    for each in tree.sentences:
        found[each.file] = found.get(each.file, "") + " " + each.text
    return [
        f"{name}.toml: {claim['file']}: {claim['text']}"
        for name, register in tree.registers.items()
        for claim in register["claim"]
        if claim["text"] not in found.get(claim["file"], "")
    ]


def main() -> int:
    parser = argparse.ArgumentParser(prog="tools/claims", description="Claims with a number and what shows them.")
    parser.add_argument("--run", action="store_true", help="measure times and run commands, too")
    parser.add_argument("--rest", action="store_true", help="list sentences with a number that no check names")
    parser.add_argument("parts", nargs="*", metavar="PART", help="claims whose file or sentence contains a PART")
    given = parser.parse_args()
    wanted = lambda file, text: not given.parts or any(part in f"{file} {text}" for part in given.parts)  # noqa: E731
    tree = Tree()
    open_claims, rest = unmatched(tree)
    if given.rest:
        for each in rest:
            if wanted(each.file, each.text):
                print(f"{each.file}:{each.line}: {each.text}")
        return 0
    counts, bad = dict.fromkeys([*CHECKS, "named"], 0), 0
    for each in tree.sentences:
        if CLAIM.search(bare(each.text)) and (tests := tests_named(tree, each)) and wanted(each.file, each.text):
            counts["named"] += 1
            good = all(test_exists(ROOT, test) for test in tests)
            bad += not good
            print(f"{'ok' if good else 'NOT'}\t{each.file}:{each.line}\t{each.text}\t{'; '.join(tests)}\ttest")
    for register in tree.registers.values():
        names = names_of(register)
        for claim in register["claim"]:
            if not wanted(claim["file"], claim["text"]):
                continue
            try:
                result = check(claim, names, ROOT, given.run)
            except Exception as error:
                result = Result(False, f"{type(error).__name__}: {error}")
            counts[next(kind for kind in CHECKS if kind in claim)] += 1
            bad += not result.good
            row = "ok" if result.good else "NOT", claim["file"], claim["text"], written_check(claim), result.says
            print(*row, sep="\t", flush=True)
    for each in (each for each in open_claims if wanted(each.file, each.text)):
        bad += 1
        print(f"OPEN\t{each.file}:{each.line}\t{each.text}\t\tno check")
    for each in gone(tree):
        bad += 1
        print(f"GONE\t{each}\t\tthe sentence is not there")
    by_kind = ", ".join(f"{count} {kind}" for kind, count in counts.items() if count)
    print(f"{sum(counts.values())} claims ({by_kind}), {bad} to mend", file=sys.stderr)
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
